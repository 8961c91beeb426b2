//! Numbers as written.

use crate::expression::Expression;

/// Number as written: a value, or an expression over parameters.
#[derive(Clone, Debug)]
pub struct NumberDraft {
    /// Value, SI; ignored if an expression defines it.
    pub value: f64,
    /// Expression that defines the number.
    pub expression: Option<Expression>,
    /// Number of units of the text per SI unit.
    pub per_unit: f64,
}

impl From<f64> for NumberDraft {
    fn from(value: f64) -> Self {
        Self { value, expression: None, per_unit: 1.0 }
    }
}

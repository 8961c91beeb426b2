//! Numbers as written.

use crate::expression::Expression;

/// Number as written: a value, or an expression over parameters.
#[derive(Clone, Debug)]
pub struct NumberDraft {
    /// Value, SI; ignored if an expression defines it.
    pub value: f64,
    /// Expression that defines the number.
    pub expression: Option<Expression>,
    /// Number of units of the text per SI unit; negative if the number in the model has the opposite sign.
    pub per_unit: f64,
}

impl From<f64> for NumberDraft {
    fn from(value: f64) -> Self {
        Self { value, expression: None, per_unit: 1.0 }
    }
}

/// A point of a force table as written.
#[derive(Clone, Debug)]
pub struct TablePointDraft {
    /// Deflection, m, or angle, rad: the same in every design.
    pub deflection: f64,
    /// Force, N, or moment, N m.
    pub force: NumberDraft,
}

impl From<[f64; 2]> for TablePointDraft {
    fn from([deflection, force]: [f64; 2]) -> Self {
        Self { deflection, force: force.into() }
    }
}

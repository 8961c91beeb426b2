//! Parameters and formulas as written.

use crate::expression::Expression;
use crate::joint::Quantity;

/// A named number.
#[derive(Clone, Debug)]
pub struct ParameterDraft {
    /// Name.
    pub name: String,
    /// Value: m, rad or a plain number. Ignored if a formula defines it.
    pub value: f64,
    /// Quantity of the value.
    pub quantity: Quantity,
}

/// Number of the model that is defined by an expression.
#[derive(Clone, Debug)]
pub struct FormulaDraft {
    /// Number that the formula defines.
    pub of: FormulaOf,
    /// Expression that defines it.
    pub expression: Expression,
}

/// Number that a formula can define; it overrides the number in the draft.
#[derive(Clone, Debug, PartialEq)]
pub enum FormulaOf {
    /// The value of a parameter.
    Parameter(String),
    /// A coordinate of a named hardpoint: 0 for x, 1 for y, 2 for z.
    Coordinate(String, usize),
    /// The length of a rod.
    Length(String),
    /// Parameter of a driver's law, by the names of driver and parameter: a plain number in the units of the law's
    /// text.
    Law(String, String),
    /// Parameter of the law that a case gives a driver, by the names of case, driver and parameter.
    CaseLaw(String, String, String),
}

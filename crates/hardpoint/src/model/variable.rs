//! Design variables.

use super::change::Change;
use crate::joint::Quantity;

/// One scalar b (the paper's tau) that the design depends on; nominal value 0.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignVariable {
    /// Name.
    pub name: String,
    /// Quantity of b: m, rad, or a plain number.
    pub quantity: Quantity,
    /// Changes of the design per unit of b.
    pub changes: Vec<Change>,
    /// True if rods keep their lengths while it moves their ends.
    pub fixed_length: bool,
    /// Between which values b may lie, in the unit of b; 0 lies between them.
    pub bounds: Option<[f64; 2]>,
    /// Typical size of a change of b, in its unit; positive.
    pub typical: Option<f64>,
    /// Symmetric manufacturing tolerance of b, in its unit; positive.
    pub tolerance: Option<f64>,
}

//! Design variables as written.

use super::ChangeDraft;

/// A design variable.
#[derive(Clone, Debug, Default)]
pub struct VariableDraft {
    /// Name.
    pub name: String,
    /// Changes of the design per unit of the variable.
    pub changes: Vec<ChangeDraft>,
    /// True if the lengths of rods stay constant.
    pub fixed_length: bool,
    /// Lower and upper bound, m, rad or a plain number; the variable is 0 in the nominal design.
    pub bounds: Option<[f64; 2]>,
    /// Typical size of a change, used to compare variables, in the unit of the variable.
    pub typical: Option<f64>,
    /// Tolerance: half width of the deviations, in the unit of the variable.
    pub tolerance: Option<f64>,
}

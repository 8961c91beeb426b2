//! Plots and designs that the file keeps for comparison and display. They do not influence any result.

use super::{OutputSource, VariableId};

/// A plot that a page opens with.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Outputs on the ordinate, of one dimension; at least one.
    pub y: Vec<OutputSource>,
    /// Output on the abscissa; time by default.
    pub over: Option<OutputSource>,
}

/// A named design: changes of some variables; all others are nominal.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedDesign {
    /// Name.
    pub name: String,
    /// Variables with their changes from the nominal design, in their units (SI).
    pub changes: Vec<(VariableId, f64)>,
}

impl NamedDesign {
    /// Change of each of the first `count` variables.
    pub fn changes_of(&self, count: usize) -> Vec<f64> {
        let mut all = vec![0.0; count];
        self.changes.iter().for_each(|(variable, by)| all[variable.0] = *by);
        all
    }
}

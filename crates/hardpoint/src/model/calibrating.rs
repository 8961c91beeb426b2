//! Settings of a calibration: fitted variables, prior knowledge about them, and offsets of drivers and sensors.

use super::{Change, DesignVariable, DriverId, Model, OutputSource, VariableId, change};
use crate::joint::Quantity;

/// Settings of a calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrationSettings {
    /// Fitted variables.
    pub variables: Vec<VariableId>,
    /// Priors of variables.
    pub priors: Vec<VariablePrior>,
    /// True if the tolerances of variables are the priors of all others.
    pub tolerance_priors: bool,
    /// Groups of variables with a common deviation.
    pub groups: Vec<PriorGroup>,
    /// Fitted offsets.
    pub offsets: Vec<Offset>,
}

/// Gaussian prior of a design variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VariablePrior {
    /// The variable.
    pub variable: VariableId,
    /// Mean of its change from the nominal design, SI.
    pub mean: f64,
    /// Standard deviation, SI; positive.
    pub sigma: f64,
}

/// Group of variables whose deviations from the nominal design are nearly equal.
#[derive(Clone, Debug, PartialEq)]
pub struct PriorGroup {
    /// Name.
    pub name: String,
    /// Members: at least two, of one quantity.
    pub variables: Vec<VariableId>,
    /// Standard deviation of a member from the unknown common deviation, SI; positive.
    pub within: f64,
}

/// Unknown constant that is added to the position of a driver or to the readings of an output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    /// Driver or output that it is added to.
    pub of: OffsetSource,
    /// Standard deviation of its Gaussian prior about 0, SI; `None` without a prior.
    pub sigma: Option<f64>,
}

/// Driver or output with an offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OffsetSource {
    /// The real position of a driver is that of the table plus the offset.
    Driver(DriverId),
    /// The reading of an output is its value plus the offset.
    Output(OutputSource),
}

impl Model {
    /// Adds a design variable that increases a parameter of a driver's law by its own value.
    pub fn add_law_variable(&mut self, name: &str, driver: DriverId, parameter: usize) -> VariableId {
        let change = change::Law { driver, parameter, rate: 1.0 };
        self.variables.push(DesignVariable {
            name: name.into(),
            quantity: Quantity::Number,
            changes: vec![Change::from(change)],
            fixed_length: false,
            bounds: None,
            typical: None,
            tolerance: None,
        });
        VariableId(self.variables.len() - 1)
    }
}

//! Parameters of a fit.

use hardpoint::model::{DriverId, VariableId};

/// Parameter that is fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FittedParameter {
    /// A design variable.
    Variable(VariableId),
    /// Offset of a driver: its real position minus that of the table.
    Driver(DriverId),
    /// Offset of an output, by its column in [`outputs`](hardpoint::measure::outputs): reading minus value.
    Output(usize),
}

/// Bound that a variable is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoundSide {
    /// Lower bound.
    Lower,
    /// Upper bound.
    Upper,
}

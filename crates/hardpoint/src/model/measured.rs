//! Measurements of a real mechanism, which calibration fits a design to.

use super::ElementId;

/// Measured value of one output in a posture, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Index of the posture in [`Measurements::postures`].
    pub posture: usize,
    /// Column of [`outputs`](crate::measure::outputs).
    pub output: usize,
    /// Measured value.
    pub value: f64,
    /// Standard deviation; `None` if it is to be estimated from the residuals, the same for all.
    pub sigma: Option<f64>,
}

/// Measurements of a mechanism.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurements {
    /// Values of the drivers in each posture, in the coordinate of their laws, m or rad.
    pub postures: Vec<Vec<f64>>,
    /// Values of the laws of given forces in each posture; a force that a posture does not list keeps its own law. No
    /// posture lists any if this is empty.
    pub forces: Vec<Vec<(ElementId, f64)>>,
    /// Readings in the postures.
    pub readings: Vec<Reading>,
}

impl Measurements {
    /// Values of the laws of given forces in a posture.
    pub fn forces_in(&self, posture: usize) -> &[(ElementId, f64)] {
        self.forces.get(posture).map_or(&[], Vec::as_slice)
    }
}

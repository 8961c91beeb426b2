//! Limits of joints: ranges of their coordinates and articulation angles.

use super::{Dimension, JointId, Model, OutputSource};

/// Range that a coordinate or the articulation of a joint must not leave.
#[derive(Clone, Debug, PartialEq)]
pub struct JointLimit {
    /// Name: that of the joint and of its coordinate, `slide.displacement`. The measure has the same name.
    pub name: String,
    /// The joint.
    pub joint: JointId,
    /// Index of the coordinate in the joint's type; `None` for the articulation.
    pub coordinate: Option<usize>,
    /// Index of the measure of its value.
    pub measure: usize,
    /// Lower end, m or rad.
    pub min: Option<f64>,
    /// Upper end, m or rad.
    pub max: Option<f64>,
    /// True if the motion ends where the limit is reached.
    pub stop: bool,
}

/// End of a range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitEnd {
    /// The lower one.
    Min,
    /// The upper one.
    Max,
}

impl LimitEnd {
    /// Both ends.
    pub const ALL: [Self; 2] = [Self::Min, Self::Max];

    /// Sign of the direction that leads out of the range.
    pub const fn sign(self) -> f64 {
        match self {
            Self::Min => -1.0,
            Self::Max => 1.0,
        }
    }

    /// Noun of the end.
    pub const fn noun(self) -> &'static str {
        match self {
            Self::Min => "minimum",
            Self::Max => "maximum",
        }
    }
}

/// A value is beyond an end of its range if it exceeds it by this fraction of the mechanism's size, or of a radian: a
/// driver may lead exactly to the end, an optimum lies on it, and positions are solved to 1e-12 of the size.
const BEYOND: f64 = 1e-9;

impl JointLimit {
    /// Value of an end, m or rad.
    pub fn end(&self, end: LimitEnd) -> Option<f64> {
        match end {
            LimitEnd::Min => self.min,
            LimitEnd::Max => self.max,
        }
    }

    /// Distance of a value from an end, positive within the range, m or rad; 0 within round-off.
    pub fn margin(&self, model: &Model, end: LimitEnd, value: f64) -> Option<f64> {
        let margin = end.sign() * (self.end(end)? - value);
        Some(if margin.abs() <= self.tolerance(model) { 0.0 } else { margin })
    }

    /// Returns the end that a value is beyond, by more than round-off.
    pub fn exceeded(&self, model: &Model, value: f64) -> Option<LimitEnd> {
        LimitEnd::ALL
            .into_iter()
            .find(|end| self.margin(model, *end, value).is_some_and(|margin| margin < 0.0))
    }

    /// Round-off of a value at an end, m or rad.
    pub(crate) fn tolerance(&self, model: &Model) -> f64 {
        let is_length = model.dimension(OutputSource::Measure(self.measure)) == Dimension::LENGTH;
        BEYOND * if is_length { model.size() } else { 1.0 }
    }
}

impl Model {
    /// True if a limit of a joint ends the motion.
    pub fn stops_at_limits(&self) -> bool {
        self.joint_limits.iter().any(|limit| limit.stop)
    }
}

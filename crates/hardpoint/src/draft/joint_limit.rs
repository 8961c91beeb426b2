//! Limits of joints as written.

use super::{DirectionDraft, MeasureDraft, MeasureKindDraft};

/// A limit of a joint; see [`JointLimit`](crate::model::JointLimit). A measure has its name.
#[derive(Clone, Debug)]
pub struct JointLimitDraft {
    /// Name of the joint.
    pub joint: String,
    /// Name of its coordinate, or [`JointLimitDraft::ARTICULATION`].
    pub of: String,
    /// Lower end, m or rad.
    pub min: Option<f64>,
    /// Upper end, m or rad.
    pub max: Option<f64>,
    /// True if the motion ends where the limit is reached.
    pub stop: bool,
}

impl JointLimitDraft {
    /// Word for the articulation of a joint, in place of a coordinate.
    pub const ARTICULATION: &'static str = "articulation";

    /// Name of the limit, and of its measure.
    pub fn name(&self) -> String {
        format!("{}.{}", self.joint, self.of)
    }

    /// Measure of the limit; `axis` is that of an articulation.
    pub fn measure(&self, axis: Option<DirectionDraft>) -> MeasureDraft {
        let joint = self.joint.clone();
        let kind = match self.of == Self::ARTICULATION {
            true => MeasureKindDraft::Articulation { joint, axis },
            false => MeasureKindDraft::Coordinate { joint, coordinate: Some(self.of.clone()) },
        };
        MeasureDraft { name: self.name(), kind }
    }
}

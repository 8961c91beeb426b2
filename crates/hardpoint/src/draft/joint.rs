//! Joints as written.

use super::{DirectionDraft, LocationDraft};

/// A joint.
#[derive(Clone, Debug, Default)]
pub struct JointDraft {
    /// Name.
    pub name: String,
    /// The name of its type.
    pub kind: String,
    /// Names of bodies i and j.
    pub bodies: [String; 2],
    /// Location of the joint, or its two ends for a rod or leg. If it is empty and the axis passes through hardpoints,
    /// the first of them is used. A joint with one location may have two that do not coincide, on body i and on body j:
    /// the assembly closes the gap.
    pub at: Vec<LocationDraft>,
    /// Direction of the markers' z axis.
    pub axis: Option<DirectionDraft>,
    /// Direction of the markers' x axis.
    pub axis2: Option<DirectionDraft>,
    /// Global axis (0, 1 or 2) across which the joint is the mirror image of another one. Without `axis2`, the default
    /// x axis is the image of the other joint's default.
    pub mirror: Option<usize>,
    /// Length of a rod, or distance of a follower from its curve, m. If `None`, the value of the design configuration
    /// is used.
    pub length: Option<f64>,
    /// Advance of a screw, m per turn.
    pub lead: Option<f64>,
    /// Curve on body i that a point of body j follows.
    pub curve: Option<CurveDraft>,
    /// True if the joint must be a cut joint instead of a tree joint.
    pub cut: bool,
}

/// A smooth curve through points in the design configuration, in the plane perpendicular to its joint's axis.
#[derive(Clone, Debug, Default)]
pub struct CurveDraft {
    /// Points in order. The curve of a cam is closed and does not repeat its first point.
    pub points: Vec<LocationDraft>,
    /// True if the curve is closed.
    pub closed: bool,
}

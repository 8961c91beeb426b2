//! Bodies as written.

use crate::space::{Pose, Vec3};

use super::LocationDraft;

/// A body.
#[derive(Clone, Debug)]
pub struct BodyDraft {
    /// Name.
    pub name: String,
    /// Reference frame.
    pub frame: FrameDraft,
}

/// Definition of a body's reference frame.
#[derive(Clone, Debug, Default)]
pub enum FrameDraft {
    /// Origin at the mean of the body's joint hardpoints, axes parallel to the global ones.
    #[default]
    Default,
    /// Position and orientation.
    Pose(Pose),
    /// Origin, a point on the x axis, and a point in the xy plane on the side of +y.
    Points(LocationDraft, LocationDraft, LocationDraft),
}

/// Placement at which the assembly of a body starts.
#[derive(Clone, Debug, PartialEq)]
pub struct StartPlacementDraft {
    /// The body's name.
    pub body: String,
    /// Rotation vector of the displacement from the design configuration, about the global origin, rad.
    pub turn: Vec3,
    /// Translation after the rotation, m.
    pub shift: Vec3,
}

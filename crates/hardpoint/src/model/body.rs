//! Bodies, and points of the design configuration.

use super::id::{BodyId, HardpointId, JointId};
use crate::space::{Pose, Vec3};

/// A named point of the design configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Hardpoint {
    /// Name, or that of the joint or point that gave its coordinates.
    pub name: String,
    /// Global position in the design configuration, m.
    pub position: Vec3,
    /// True if coordinates were written where a hardpoint's name could stand.
    pub unnamed: bool,
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Name.
    pub name: String,
    /// Reference frame x'-y'-z' in the design configuration; a design change leaves it there.
    pub frame: Pose,
}

/// A point fixed in a body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyPoint {
    /// Name, or that of the driver, wheel or measure that it serves.
    pub name: String,
    /// The body that carries it.
    pub body: BodyId,
    /// Location in the design configuration; the point follows a named hardpoint.
    pub at: HardpointId,
    /// True if it was only written inside one of those.
    pub unnamed: bool,
}

/// A body, or two that slide on each other, that can spin about a line without moving anything else. The spin is held
/// at rest: one of its balls is treated as a universal joint.
#[derive(Clone, Debug, PartialEq)]
pub struct IdleRotation {
    /// The bodies that spin together.
    pub bodies: Vec<BodyId>,
    /// The spherical joint that holds the spin.
    pub joint: JointId,
    /// The line's direction in the design configuration.
    pub axis: Vec3,
}

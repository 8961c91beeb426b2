//! Joints between bodies.

use super::curve::Curve;
use super::id::{BodyId, HardpointId};
use crate::joint::{JointType, Need};
use crate::space::{Mat3, Vec3};

/// A joint between two bodies.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name.
    pub name: String,
    /// Type.
    pub kind: &'static JointType,
    /// The bodies i and j; coordinates are those of j relative to i.
    pub bodies: [BodyId; 2],
    /// The hardpoints of marker i and marker j (the same one unless the joint has two places).
    pub at: [HardpointId; 2],
    /// Direction of the markers' z axis, if the joint has one.
    pub axis: Option<Direction>,
    /// Direction of the markers' x axis, if the joint has one.
    pub axis2: Option<Direction>,
    /// Orientation of marker i and marker j in the world, in the design configuration; the same unless the joint type
    /// has its second axis on body j.
    pub frames: [Mat3; 2],
    /// Length of a rod, or a follower's distance from its curve, that is given by itself rather than by the hardpoints,
    /// m.
    pub length: Option<f64>,
    /// The curve that a point follows, in the frame of marker i.
    pub curve: Option<Curve>,
    /// True if the user asks for it to be cut.
    pub cut: bool,
    /// True if it only carries a driver on something that is no joint's coordinate; it has the driver's name.
    pub unnamed: bool,
}

impl Joint {
    /// The hardpoints that it follows: those that it is at, and those that its axes pass through.
    pub(crate) fn hardpoints(&self) -> impl Iterator<Item = HardpointId> {
        let axes = [self.axis, self.axis2].into_iter().flatten();
        self.at.into_iter().chain(axes.flat_map(|axis| axis.hardpoints().into_iter().flatten()))
    }

    /// The directions of z and x of marker e, as far as they are given.
    pub(crate) fn axes_of_marker(&self, e: usize) -> [Option<Direction>; 2] {
        match (self.kind.axis2, e) {
            (Need::OnBodyJ, 0) => [self.axis, None],
            (Need::OnBodyJ, _) => [self.axis2, None],
            _ => [self.axis, self.axis2],
        }
    }
}

/// Direction of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// A fixed direction, unit length.
    Along(Vec3),
    /// From one hardpoint to another; follows them when the design moves them.
    Through(HardpointId, HardpointId),
}

impl Direction {
    /// The hardpoints that it follows, from one to the other.
    pub fn hardpoints(self) -> Option<[HardpointId; 2]> {
        match self {
            Self::Along(_) => None,
            Self::Through(a, b) => Some([a, b]),
        }
    }
}

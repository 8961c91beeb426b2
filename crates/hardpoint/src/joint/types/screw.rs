//! Screw: a rotation that advances along its own axis.
//!
//! Coordinates: angle of j relative to i, about z_i, right-handed, rad; displacement along z_i, m.

use crate::constraint::{ON_LINE, PARALLEL_Z};

use super::{Freedom, JointType, Need, Slide, VectorKind, angle, displacement};

/// A cylindrical joint whose displacement is coupled to its angle by `lead`, the advance per turn: five constraints,
/// the last of which is a coupler ([`crate::model::Coupler`]).
pub static SCREW: JointType = JointType {
    name: "screw",
    aliases: &[],
    summary: "turns about `axis` and advances along it by `lead` per turn",
    places: 1,
    axis: Need::Required,
    axis2: Need::Orienting,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::None,
    freedoms: Some(&[Freedom::Turn(2), Freedom::Slide(2)]),
    tree_rows: &[],
    rows: &[PARALLEL_Z[0], PARALLEL_Z[1], ON_LINE[0], ON_LINE[1]],
    coordinates: &[angle(0), displacement(1)],
};

impl JointType {
    /// True if a `lead` couples its displacement to its angle.
    pub fn has_lead(&self) -> bool {
        std::ptr::eq(self, &SCREW)
    }
}

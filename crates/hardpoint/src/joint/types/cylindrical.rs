//! Cylindrical: a shaft that slides and rotates.
//!
//! Coordinates: displacement of j relative to i, along z_i, m; angle about z_i, right-handed, rad.

use crate::constraint::{ON_LINE, PARALLEL_Z};

use super::{Freedom, INLINE, JointType, Need, Slide, VectorKind, angle, displacement};

/// z_j parallel to z_i and d parallel to z_i: four constraints, one displacement and one angle.
pub static CYLINDRICAL: JointType = JointType {
    name: "cylindrical",
    aliases: &[],
    summary: "slides along its axis and turns about it",
    places: 1,
    axis: Need::Required,
    axis2: Need::Orienting,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[&INLINE],
    is_hinge: true,
    slide: Slide::Block,
    freedoms: Some(&[Freedom::Slide(2), Freedom::Turn(2)]),
    tree_rows: &[],
    rows: &[ON_LINE[0], ON_LINE[1], PARALLEL_Z[0], PARALLEL_Z[1]],
    coordinates: &[displacement(0), angle(1)],
};

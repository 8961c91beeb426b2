//! Translational: a slide without rotation.
//!
//! Coordinate: displacement of j relative to i, along z_i, m.

use crate::constraint::{ON_LINE, PARALLEL_FRAMES};

use super::{CYLINDRICAL, Freedom, INLINE, JointType, Need, Slide, VectorKind, displacement};

/// P_j on the line through P_i along z_i, and no relative rotation: five constraints, one displacement.
pub static TRANSLATIONAL: JointType = JointType {
    name: "translational",
    aliases: &[],
    summary: "a slide: moves along its axis and cannot turn",
    places: 1,
    axis: Need::Required,
    axis2: Need::Orienting,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[&CYLINDRICAL, &INLINE],
    is_hinge: false,
    slide: Slide::Block,
    freedoms: Some(&[Freedom::Slide(2)]),
    tree_rows: &[],
    rows: &[ON_LINE[0], ON_LINE[1], PARALLEL_FRAMES[0], PARALLEL_FRAMES[1], PARALLEL_FRAMES[2]],
    coordinates: &[displacement(0)],
};

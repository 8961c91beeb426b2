//! Revolute: a hinge.
//!
//! Coordinate: angle of j relative to i, about z_i, right-handed, rad.

use crate::constraint::{COINCIDE, PARALLEL_Z};

use super::{CYLINDRICAL, Freedom, INLINE, JointType, Need, SPHERICAL, Slide, VectorKind, angle};

/// d = 0 and z_j parallel to z_i: five constraints, one angle.
pub static REVOLUTE: JointType = JointType {
    name: "revolute",
    aliases: &[],
    summary: "a hinge: turns about its axis",
    places: 1,
    axis: Need::Required,
    axis2: Need::Orienting,
    vector_kinds: [VectorKind::Axial, VectorKind::Polar],
    normal_in_plane: true,
    relaxations: &[&CYLINDRICAL, &SPHERICAL, &INLINE],
    is_hinge: true,
    slide: Slide::None,
    freedoms: Some(&[Freedom::Turn(2)]),
    tree_rows: &[],
    rows: &[COINCIDE[0], COINCIDE[1], COINCIDE[2], PARALLEL_Z[0], PARALLEL_Z[1]],
    coordinates: &[angle(0)],
};

//! Universal: a cross between two yokes.
//!
//! Coordinates: angle about the pin of body i and angle2 about the pin of body j, right-handed, rad.

use crate::constraint::{COINCIDE, Row};

use super::{CoordinateType, Freedom, JointType, Need, Quantity, SPHERICAL, Slide, VectorKind, angle};

/// d = 0 and z_i perpendicular to x_j: four constraints. `axis` is the pin on body i (z_i), `axis2` that on body j
/// (x_j); `angle` is the rotation about the first, `angle2` about the second.
pub static UNIVERSAL: JointType = JointType {
    name: "universal",
    aliases: &[],
    summary: "a cross: its pin `axis` turns in body i, its pin `axis2` in body j",
    places: 1,
    axis: Need::Required,
    axis2: Need::Required,
    vector_kinds: [VectorKind::Axial; 2],
    normal_in_plane: false,
    relaxations: &[&SPHERICAL],
    is_hinge: false,
    slide: Slide::None,
    freedoms: Some(&[Freedom::Turn(2), Freedom::Turn(0)]),
    tree_rows: &[],
    rows: &[COINCIDE[0], COINCIDE[1], COINCIDE[2], Row::Dot1(2, 0)],
    coordinates: &[
        angle(0),
        CoordinateType { name: "angle2", quantity: Quantity::Angle, freedom: Some(1), row: Row::AngleOnJ },
    ],
};

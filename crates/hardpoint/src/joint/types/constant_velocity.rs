//! Constant velocity: two shafts that meet in a point and rotate at the same speed, at any angle between them.
//!
//! It has no coordinate.

use crate::constraint::{COINCIDE, Row};

use super::{Freedom, JointType, Need, SPHERICAL, Slide, VectorKind};

/// d = 0 and no relative rotation about the bisector of the shafts: four constraints. `axis` is the shaft on body i,
/// `axis2` the shaft on body j, both pointing in the same direction along the drive train.
pub static CONSTANT_VELOCITY: JointType = JointType {
    name: "constant_velocity",
    aliases: &["cv", "convel"],
    summary: "a homokinetic joint: shaft `axis` of body i and shaft `axis2` of body j turn alike",
    places: 1,
    axis: Need::Required,
    axis2: Need::OnBodyJ,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[&SPHERICAL],
    is_hinge: false,
    slide: Slide::None,
    freedoms: Some(&[Freedom::Ball]),
    tree_rows: &[Row::ConstantVelocity],
    rows: &[COINCIDE[0], COINCIDE[1], COINCIDE[2], Row::ConstantVelocity],
    coordinates: &[],
};

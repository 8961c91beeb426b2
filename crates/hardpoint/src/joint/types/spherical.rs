//! Spherical: a ball joint.
//!
//! It has no coordinate.

use crate::constraint::COINCIDE;

use super::{Freedom, JointType, Need, Slide, VectorKind};

/// d = 0: three constraints.
pub static SPHERICAL: JointType = JointType {
    name: "spherical",
    aliases: &[],
    summary: "a ball joint: turns every way about its point",
    places: 1,
    axis: Need::Orienting,
    axis2: Need::Orienting,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::None,
    freedoms: Some(&[Freedom::Ball]),
    tree_rows: &[],
    rows: &COINCIDE,
    coordinates: &[],
};

//! Spherical: a ball joint.

use crate::constraint::COINCIDE;

use super::{Freedom, JointType, Need};

/// d = 0: three constraints.
pub static SPHERICAL: JointType = JointType {
    name: "spherical",
    aliases: &[],
    summary: "a ball joint: turns every way about its point",
    places: 1,
    axis: Need::Unused,
    axis2: Need::Unused,
    freedoms: Some(&[Freedom::Ball]),
    tree_rows: &[],
    rows: &COINCIDE,
    coordinates: &[],
};

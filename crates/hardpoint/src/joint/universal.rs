//! Universal: a cross between two forks.

use super::{Freedom, JointType, Need};
use crate::constraint::{COINCIDE, Row};

/// d = 0 and z_i square to x_j: four constraints. `axis` is the pin on body i, `axis2` that on body j.
pub static UNIVERSAL: JointType = JointType {
    name: "universal",
    summary: "a cross: its pin `axis` turns in body i, its pin `axis2` in body j",
    places: 1,
    axis: Need::Required,
    axis2: Need::Required,
    freedoms: Some(&[Freedom::Turn(2), Freedom::Turn(0)]),
    rows: &[COINCIDE[0], COINCIDE[1], COINCIDE[2], Row::Dot1(2, 0)],
    coordinates: &[],
};

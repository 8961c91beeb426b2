//! Course: direction of an axis of body j, seen along an axis of body i.
//!
//! Coordinate: angle of j relative to i, about z_i, right-handed, rad.

use crate::constraint::Row;
use crate::joint::Quantity;

use super::{CoordinateType, JointType, Need, VectorKind};

/// No constraint of its own, and none of the [types of model files](super::ALL): the coordinate of a driver that
/// prescribes an angle that is measured, like a wheel's toe. The angle of `axis2` on body j is counted from its course
/// in the design configuration.
pub static COURSE: JointType = JointType {
    name: "course",
    aliases: &[],
    summary: "the angle of `axis2` on body j seen along `axis` on body i, that a driver prescribes",
    places: 0,
    axis: Need::Required,
    axis2: Need::OnBodyJ,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    freedoms: None,
    tree_rows: &[],
    rows: &[],
    coordinates: &[CoordinateType {
        name: "angle",
        quantity: Quantity::Angle,
        freedom: None,
        row: Row::Course,
    }],
};

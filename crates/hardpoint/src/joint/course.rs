//! Course: direction of an axis of body j, seen along an axis of body i.
//!
//! Coordinate: angle of j relative to i, about z_i, right-handed, rad.

use crate::constraint::Row;
use crate::joint::Quantity;

use super::{CoordinateType, JointType, Need, Slide, VectorKind};

/// No constraint, and not among the [types of model files](super::ALL): it carries the coordinate of a driver that
/// prescribes a measured angle, like the toe of a wheel. The angle is that of `axis2` on body j, relative to its
/// direction in the design configuration.
pub static COURSE: JointType = JointType {
    name: "course",
    aliases: &[],
    summary: "the angle of `axis2` on body j seen along `axis` on body i, that a driver prescribes",
    places: 0,
    axis: Need::Required,
    axis2: Need::OnBodyJ,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::None,
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

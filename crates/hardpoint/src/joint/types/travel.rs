//! Travel: displacement of a point of body j along an axis of body i.
//!
//! Coordinate: displacement of j relative to i, along z_i, m.

use crate::constraint::Row;
use crate::joint::Quantity;

use super::{CoordinateType, JointType, Need, Slide, VectorKind};

/// No constraint; a driver prescribes the displacement of the point (wheel travel), or a measure reads it.
pub static TRAVEL: JointType = JointType {
    name: "travel",
    aliases: &[],
    summary: "the way of a point of body j along `axis` on body i, that a driver prescribes or a measure reads",
    places: 1,
    axis: Need::Required,
    axis2: Need::Unused,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::None,
    freedoms: None,
    tree_rows: &[],
    rows: &[],
    coordinates: &[CoordinateType {
        name: "displacement",
        quantity: Quantity::Length,
        freedom: None,
        row: Row::Dot2(2),
    }],
};

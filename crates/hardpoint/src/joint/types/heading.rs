//! Heading: angle of an axis of body j, seen along an axis of body i.
//!
//! Coordinate: angle of j relative to i, about z_i, right-handed, rad.

use crate::constraint::Row;
use crate::joint::Quantity;

use super::{CoordinateType, JointType, Need, Slide, VectorKind};

/// No constraint; a driver prescribes the angle (a platform's roll), or a measure reads it. `axis2` is the direction on
/// body j whose angle it is.
pub static HEADING: JointType = JointType {
    name: "heading",
    aliases: &[],
    summary: "the angle of `axis2` on body j seen along `axis` on body i, that a driver prescribes or a measure reads",
    places: 0,
    axis: Need::Required,
    axis2: Need::Optional,
    vector_kinds: [VectorKind::Axial, VectorKind::Polar],
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
        row: Row::Heading,
    }],
};

//! Angle: the angle between an axis of body i and an axis of body j is constant.
//!
//! It has no coordinate.

use crate::constraint::Row;

use super::{JointType, Need, Slide, VectorKind};

/// z_i . z_j has its design value: one constraint.
pub static ANGLE: JointType = JointType {
    name: "angle",
    aliases: &[],
    summary: "the angle between `axis` on body i and `axis2` on body j stays what it is",
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
    rows: &[Row::Cosine],
    coordinates: &[],
};

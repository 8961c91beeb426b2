//! Dot-2: the line between two points stays perpendicular to an axis.
//!
//! It has no coordinate.

use crate::constraint::Row;

use super::{JointType, Need, Slide, VectorKind};

/// z_i . d = 0: one constraint (paper Eq. 4.4).
pub static DOT2: JointType = JointType {
    name: "dot2",
    aliases: &[],
    summary: "the line from the point on body i to the point on body j stays perpendicular to `axis` on body i",
    places: 2,
    axis: Need::Required,
    axis2: Need::Unused,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::None,
    freedoms: None,
    tree_rows: &[],
    rows: &[Row::Dot2(2)],
    coordinates: &[],
};

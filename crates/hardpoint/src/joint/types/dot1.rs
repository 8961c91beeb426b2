//! Dot-1: an axis of body i perpendicular to an axis of body j.
//!
//! It has no coordinate.

use crate::constraint::Row;

use super::{Freedom, JointType, Need, Slide, VectorKind};

/// z_i . x_j = 0: one constraint (paper Eq. 4.1).
pub static DOT1: JointType = JointType {
    name: "dot1",
    aliases: &["perpendicular", "perpendicular_axes"],
    summary: "perpendicular axes: `axis` on body i stays perpendicular to `axis2` on body j",
    places: 0,
    axis: Need::Required,
    axis2: Need::Required,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::None,
    freedoms: Some(&[
        Freedom::Slide(0),
        Freedom::Slide(1),
        Freedom::Slide(2),
        Freedom::Turn(2),
        Freedom::Turn(0),
    ]),
    tree_rows: &[],
    rows: &[Row::Dot1(2, 0)],
    coordinates: &[],
};

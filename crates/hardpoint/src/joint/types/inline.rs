//! In-line: a point on a line.
//!
//! Coordinate: displacement of j relative to i, along z_i, m.

use crate::constraint::ON_LINE;

use super::{Freedom, JointType, Need, Slide, VectorKind, displacement};

/// P_j on the line through P_i along z_i: two constraints.
pub static INLINE: JointType = JointType {
    name: "inline",
    aliases: &["point_on_line"],
    summary: "a point of body j stays on the line along `axis` on body i",
    places: 1,
    axis: Need::Required,
    axis2: Need::Orienting,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::Line(2),
    freedoms: Some(&[Freedom::Slide(2), Freedom::Ball]),
    tree_rows: &[],
    rows: &ON_LINE,
    coordinates: &[displacement(0)],
};

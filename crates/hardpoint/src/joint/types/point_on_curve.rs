//! Point on curve: a pin in a slot, or a roller on a cam.
//!
//! It has no coordinate.

use crate::constraint::Row;

use super::{JointType, Need, Slide, VectorKind};

/// Seen along z_i, P_j has a constant distance from a curve of body i: zero for a pin in a slot, the radius of the
/// roller for a cam. One constraint. The first location is that of the curve, the second is the point.
pub static POINT_ON_CURVE: JointType = JointType {
    name: "point_on_curve",
    aliases: &["cam", "slot"],
    summary: "a point of body j keeps its distance from a `curve` of body i, in the plane perpendicular to `axis`",
    places: 2,
    axis: Need::Required,
    axis2: Need::Unused,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: true,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::None,
    freedoms: None,
    tree_rows: &[],
    rows: &[Row::Contact],
    coordinates: &[],
};

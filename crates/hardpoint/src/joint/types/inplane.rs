//! In-plane: a point on a plane.
//!
//! Coordinates: displacements of j relative to i, along x_i and y_i, m.

use crate::constraint::Row;

use super::{Freedom, JointType, Need, Slide, VectorKind, displacement_along};

/// P_j on the plane through P_i normal to z_i: one constraint.
pub static INPLANE: JointType = JointType {
    name: "inplane",
    aliases: &["point_on_plane"],
    summary: "a point of body j stays on the plane normal to `axis` on body i",
    places: 1,
    axis: Need::Required,
    axis2: Need::Optional,
    vector_kinds: [VectorKind::Axial, VectorKind::Polar],
    normal_in_plane: false,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::Plane,
    freedoms: Some(&[Freedom::Slide(0), Freedom::Slide(1), Freedom::Ball]),
    tree_rows: &[],
    rows: &[Row::Dot2(2)],
    coordinates: &[displacement_along("x", 0, 0), displacement_along("y", 1, 1)],
};

//! Revolute-spherical rod: a massless link on a hinge of body i, with a ball joint on body j.
//!
//! Coordinate: length from P_i to P_j, m.

use crate::constraint::Row;

use super::{JointType, LENGTH, Need, Slide, VectorKind};

/// d| and z_i . d have their design values: P_j moves on a circle about the axis of the hinge. Two constraints.
pub static REVOLUTE_SPHERICAL: JointType = JointType {
    name: "revolute_spherical",
    aliases: &[],
    summary: "a massless link with a hinge about `axis` on body i and a ball on body j",
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
    rows: &[Row::Distance, Row::Offset],
    coordinates: &[LENGTH],
};

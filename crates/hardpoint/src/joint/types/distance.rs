//! Distance: a rod of constant length between two ball ends.
//!
//! Coordinate: length from P_i to P_j, m.

use crate::constraint::Row;

use super::{JointType, LENGTH, Need, Slide, VectorKind};

/// d| = design length: one constraint.
pub static DISTANCE: JointType = JointType {
    name: "distance",
    aliases: &["rod", "spherical_spherical", "universal_spherical"],
    summary: "a rod of constant length between two points",
    places: 2,
    axis: Need::Unused,
    axis2: Need::Unused,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::None,
    freedoms: None,
    tree_rows: &[],
    rows: &[Row::Distance],
    coordinates: &[LENGTH],
};

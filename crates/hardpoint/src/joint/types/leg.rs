//! Leg: an actuator or spring whose length a driver prescribes or a measure reads.
//!
//! Coordinate: length from P_i to P_j, m.

use super::{JointType, LENGTH, Need, Slide, VectorKind};

/// No constraint; the length is a coordinate.
pub static LEG: JointType = JointType {
    name: "leg",
    aliases: &[],
    summary: "a length between two points that a driver prescribes or a measure reads",
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
    rows: &[],
    coordinates: &[LENGTH],
};

//! Fixed: body j is rigidly attached to body i.
//!
//! It has no coordinate.

use crate::constraint::{COINCIDE, PARALLEL_FRAMES, Row};

use super::{JointType, Need, SPHERICAL, Slide, VectorKind};

/// d = 0 and no relative rotation: six constraints.
pub static FIXED: JointType = JointType {
    name: "fixed",
    aliases: &[],
    summary: "no relative motion",
    places: 1,
    axis: Need::Orienting,
    axis2: Need::Orienting,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[&SPHERICAL],
    is_hinge: false,
    slide: Slide::None,
    freedoms: Some(&[]),
    tree_rows: &[],
    rows: &{
        let [x, y, z] = COINCIDE;
        let [a, b, c] = PARALLEL_FRAMES;
        [x, y, z, a, b, c] as [Row; 6]
    },
    coordinates: &[],
};

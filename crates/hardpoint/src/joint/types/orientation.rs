//! Orientation: body j has the orientation of body i and translates freely.
//!
//! It has no coordinate.

use crate::constraint::PARALLEL_FRAMES;

use super::{Freedom, JointType, Need, Slide, VectorKind};

/// No relative rotation: three constraints.
pub static ORIENTATION: JointType = JointType {
    name: "orientation",
    aliases: &[],
    summary: "no relative rotation",
    places: 0,
    axis: Need::Orienting,
    axis2: Need::Orienting,
    vector_kinds: [VectorKind::Polar; 2],
    normal_in_plane: false,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::None,
    freedoms: Some(&[Freedom::Slide(0), Freedom::Slide(1), Freedom::Slide(2)]),
    tree_rows: &[],
    rows: &PARALLEL_FRAMES,
    coordinates: &[],
};

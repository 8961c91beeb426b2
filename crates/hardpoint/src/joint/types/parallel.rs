//! Parallel axes: body j rotates about an axis of fixed direction and translates freely.
//!
//! Coordinate: angle of j relative to i, about z_i, right-handed, rad.

use crate::constraint::PARALLEL_Z;

use super::{Freedom, JointType, Need, Slide, VectorKind, angle};

/// z_j parallel to z_i: two constraints.
pub static PARALLEL: JointType = JointType {
    name: "parallel",
    aliases: &["parallel_axes"],
    summary: "`axis` on body j stays parallel to `axis` on body i",
    places: 0,
    axis: Need::Required,
    axis2: Need::Orienting,
    vector_kinds: [VectorKind::Axial, VectorKind::Polar],
    normal_in_plane: false,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::None,
    freedoms: Some(&[Freedom::Slide(0), Freedom::Slide(1), Freedom::Slide(2), Freedom::Turn(2)]),
    tree_rows: &[],
    rows: &PARALLEL_Z,
    coordinates: &[angle(3)],
};

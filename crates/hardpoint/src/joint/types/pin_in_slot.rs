//! Pin in slot: a pin that slides along a straight slot and rotates in it.
//!
//! Coordinates: displacement of j relative to i, along x_i, m; angle about z_i, right-handed, rad.

use crate::constraint::{PARALLEL_Z, Row};

use super::{Freedom, JointType, Need, Slide, VectorKind, angle, displacement_along};

/// d along x_i, the slot, and z_j, the pin, parallel to z_i: four constraints, one displacement and one angle.
/// Equivalent to a revolute and a translational joint in series, without the intermediate block.
pub static PIN_IN_SLOT: JointType = JointType {
    name: "pin_in_slot",
    aliases: &["slotted_pin"],
    summary: "a pin of body j, along `axis`, slides along the straight slot `axis2` of body i and turns in it",
    places: 1,
    axis: Need::Required,
    axis2: Need::Required,
    vector_kinds: [VectorKind::Axial, VectorKind::Polar],
    normal_in_plane: true,
    relaxations: &[],
    is_hinge: false,
    slide: Slide::Line(0),
    freedoms: Some(&[Freedom::Slide(0), Freedom::Turn(2)]),
    tree_rows: &[],
    rows: &[PARALLEL_Z[0], PARALLEL_Z[1], Row::Dot2(1), Row::Dot2(2)],
    coordinates: &[displacement_along("displacement", 0, 0), angle(1)],
};

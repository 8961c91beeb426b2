//! Planar: body j slides and rotates on a plane.
//!
//! Coordinates: angle of j relative to i, about z_i, right-handed, rad; displacements along x_i and y_i, m.

use crate::constraint::{PARALLEL_Z, Row};

use super::{Freedom, INPLANE, JointType, Need, Slide, VectorKind, angle, displacement_along};

/// z_j parallel to z_i and P_j on the plane through P_i: three constraints. x_i is along `axis2`, y_i perpendicular to
/// it.
pub static PLANAR: JointType = JointType {
    name: "planar",
    aliases: &[],
    summary: "slides on the plane normal to `axis` and turns about it",
    places: 1,
    axis: Need::Required,
    axis2: Need::Optional,
    vector_kinds: [VectorKind::Axial, VectorKind::Polar],
    normal_in_plane: true,
    relaxations: &[&INPLANE],
    is_hinge: false,
    slide: Slide::None,
    freedoms: Some(&[Freedom::Slide(0), Freedom::Slide(1), Freedom::Turn(2)]),
    tree_rows: &[],
    rows: &[PARALLEL_Z[0], PARALLEL_Z[1], Row::Dot2(2)],
    coordinates: &[angle(2), displacement_along("x", 0, 0), displacement_along("y", 1, 1)],
};

//! Pad: height of the lowest point of a wheel on body j above body i, as the pad of a test rig prescribes it.
//!
//! Coordinate: displacement of that point along z_i from the design configuration, m.

use std::sync::{Mutex, PoisonError};

use crate::constraint::{Radius, Row};
use crate::joint::Quantity;

use super::{CoordinateType, JointType, Need, Slide, VectorKind};

/// Returns the type for a wheel of this radius, which spins about `axis2`: no constraint, and not among the
/// [types of model files](super::ALL). A driver prescribes its coordinate.
pub(crate) fn pad(radius: Radius) -> &'static JointType {
    // Types are compared by their place, so each is made once.
    static MADE: Mutex<Vec<(Radius, &'static JointType)>> = Mutex::new(Vec::new());
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, known)) = made.iter().find(|(of, _)| *of == radius) {
        return known;
    }
    let coordinates = vec![CoordinateType {
        name: "displacement",
        quantity: Quantity::Length,
        freedom: None,
        row: Row::LowestPoint(radius),
    }];
    let new: &JointType = Box::leak(Box::new(JointType {
        name: "pad",
        aliases: &[],
        summary: "the height along `axis` of the lowest point of a wheel about `axis2`, that a driver prescribes",
        places: 1,
        axis: Need::Required,
        axis2: Need::OnBodyJ,
        vector_kinds: [VectorKind::Polar; 2],
        normal_in_plane: false,
        relaxations: &[],
        is_hinge: false,
        slide: Slide::None,
        freedoms: None,
        tree_rows: &[],
        rows: &[],
        coordinates: coordinates.leak(),
    }));
    made.push((radius, new));
    new
}

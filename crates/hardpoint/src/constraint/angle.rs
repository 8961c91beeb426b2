//! Angle constraint: marker j is turned by f about z_i, where the joint keeps z_j parallel to z_i.

use super::{EndRates, Ends, axis, direction_rates};
use crate::space::{Real, Wrench};

/// `sin(angle - f)`, with tan(angle) = (y_i . x_j) / (x_i . x_j): zero and of unit slope at the root,
/// and free of branch cuts over any number of turns.
#[inline(always)]
pub(super) fn residual<T: Real>(ends: &Ends<T>, target: T) -> T {
    let x_j = axis(&ends.j.rot, 0);
    let (sin, cos) = target.sin_cos();
    axis(&ends.i.rot, 1).dot(x_j) * cos - axis(&ends.i.rot, 0).dot(x_j) * sin
}

/// The moment z_i.
#[inline(always)]
pub(super) fn wrench<T: Real>(ends: &Ends<T>) -> Wrench<T> {
    Wrench::moment(axis(&ends.i.rot, 2))
}

#[inline(always)]
pub(super) fn wrench_rates<T: Real>(ends: &Ends<T>, rates: &EndRates<T>) -> [Wrench<T>; 2] {
    let [_, z1, z2] = direction_rates(axis(&ends.i.rot, 2), rates.v_i, rates.a_i);
    [Wrench::moment(z1), Wrench::moment(z2)]
}

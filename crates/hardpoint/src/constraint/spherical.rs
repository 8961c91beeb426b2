//! Spherical constraint, one component: `e_k . (P_j - P_i) = 0` (paper Eq. 4.7).
//!
//! The e_k may turn: as P_j stays at P_i, that has no part in any rate.

use super::{EndRates, Ends, axis, point_rates};
use crate::space::{Real, Wrench};

#[inline(always)]
pub(super) fn residual<T: Real>(k: usize, ends: &Ends<T>) -> T {
    axis(&ends.axes, k).dot(ends.j.r - ends.i.r)
}

/// The force e_k through the common point.
#[inline(always)]
pub(super) fn wrench<T: Real>(k: usize, ends: &Ends<T>) -> Wrench<T> {
    Wrench::force(axis(&ends.axes, k), ends.j.r)
}

#[inline(always)]
pub(super) fn wrench_rates<T: Real>(k: usize, ends: &Ends<T>, rates: &EndRates<T>) -> [Wrench<T>; 2] {
    let e = axis(&ends.axes, k);
    let [_, velocity, acceleration] = point_rates(ends.j.r, rates.v_j, rates.a_j);
    [Wrench::moment(velocity.cross(e)), Wrench::moment(acceleration.cross(e))]
}

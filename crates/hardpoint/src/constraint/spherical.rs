//! Spherical constraint, one world component: `e_k . (P_j - P_i) = 0` (paper Eq. 4.7).

use super::{EndRates, Ends, force_rates, point_rates};
use crate::space::{Real, Vec3, Wrench};

#[inline(always)]
pub(super) fn residual<T: Real>(k: usize, ends: &Ends<T>) -> T {
    ends.j.r[k] - ends.i.r[k]
}

/// The force e_k through the common point.
#[inline(always)]
pub(super) fn wrench<T: Real>(k: usize, ends: &Ends<T>) -> Wrench<T> {
    Wrench::force(Vec3::AXES[k].spread(ends.j.r.x), ends.j.r)
}

#[inline(always)]
pub(super) fn wrench_rates<T: Real>(k: usize, ends: &Ends<T>, rates: &EndRates<T>) -> [Wrench<T>; 2] {
    let zero = Vec3::zero(ends.j.r.x);
    let force = [Vec3::AXES[k].spread(ends.j.r.x), zero, zero];
    force_rates(force, point_rates(ends.j.r, rates.v_j, rates.a_j))
}

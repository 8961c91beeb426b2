//! Dot-2 constraint: `a_i . d = f` with `d = P_j - P_i` (paper Eq. 4.4; f is the value of a driver, or 0).

use crate::space::{Real, Wrench};

use super::{MarkerPair, MarkerPairRates, axis, direction_rates, force_rates, point_rates};

#[inline(always)]
pub(super) fn residual<T: Real>(a: usize, ends: &MarkerPair<T>, target: T) -> T {
    axis(&ends.i.rot, a).dot(ends.j.r - ends.i.r) - target
}

/// Wrench of Dot-2: the force a_i through P_j.
#[inline(always)]
pub(super) fn wrench<T: Real>(a: usize, ends: &MarkerPair<T>) -> Wrench<T> {
    // d(a . d) = a . (v_j - v_i) at P_j:  a . (V_j at P_j - V_i at P_i) + (w_i x a) . (P_j - P_i)
    Wrench::force(axis(&ends.i.rot, a), ends.j.r)
}

#[inline(always)]
pub(super) fn wrench_rates<T: Real>(
    a: usize,
    ends: &MarkerPair<T>,
    rates: &MarkerPairRates<T>,
) -> [Wrench<T>; 2] {
    // l = [P_j x a_i; a_i]
    force_rates(
        direction_rates(axis(&ends.i.rot, a), rates.v_i, rates.a_i),
        point_rates(ends.j.r, rates.v_j, rates.a_j),
    )
}

//! Dot-1 constraint: `a_i . b_j = c` (paper Eq. 4.1, where c = 0; an angle joint has another cosine).

use crate::space::{Real, Wrench};

use super::{MarkerPair, MarkerPairRates, axis, cross_rates, direction_rates};

#[inline(always)]
pub(super) fn residual<T: Real>(a: usize, b: usize, ends: &MarkerPair<T>, target: T) -> T {
    axis(&ends.i.rot, a).dot(axis(&ends.j.rot, b)) - target
}

/// Wrench of Dot-1: the moment `b_j x a_i`.
#[inline(always)]
pub(super) fn wrench<T: Real>(a: usize, b: usize, ends: &MarkerPair<T>) -> Wrench<T> {
    // d(a . b) = a . (w_j x b) + (w_i x a) . b = (b x a) . (w_j - w_i)
    Wrench::moment(axis(&ends.j.rot, b).cross(axis(&ends.i.rot, a)))
}

#[inline(always)]
pub(super) fn wrench_rates<T: Real>(
    a: usize,
    b: usize,
    ends: &MarkerPair<T>,
    rates: &MarkerPairRates<T>,
) -> [Wrench<T>; 2] {
    let a = direction_rates(axis(&ends.i.rot, a), rates.v_i, rates.a_i);
    let b = direction_rates(axis(&ends.j.rot, b), rates.v_j, rates.a_j);
    // l = [b_j x a_i; 0]
    let [m1, m2] = cross_rates(b, a);
    [Wrench::moment(m1), Wrench::moment(m2)]
}

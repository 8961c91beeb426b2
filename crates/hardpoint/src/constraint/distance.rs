//! Distance constraint: `|d| = L` with `d = P_j - P_i` (paper Eq. 4.10, unsquared).

use crate::space::{Real, Wrench};

use super::{MarkerPair, MarkerPairRates, force_rates, point_rates};

#[inline(always)]
pub(super) fn residual<T: Real>(ends: &MarkerPair<T>, target: T) -> T {
    (ends.j.r - ends.i.r).norm() - target
}

/// Wrench of the distance: the unit force u = d / |d| along the rod.
#[inline(always)]
pub(super) fn wrench<T: Real>(ends: &MarkerPair<T>) -> Wrench<T> {
    // d abs(d) = u . (V_j at P_j - V_i at P_i) = u . (V_j at P_j - V_i at P_j), since u is along P_j - P_i
    let d = ends.j.r - ends.i.r;
    Wrench::force(d * (T::one() / d.norm()), ends.j.r)
}

#[inline(always)]
pub(super) fn wrench_rates<T: Real>(ends: &MarkerPair<T>, rates: &MarkerPairRates<T>) -> [Wrench<T>; 2] {
    let p_i = point_rates(ends.i.r, rates.v_i, rates.a_i);
    let p_j = point_rates(ends.j.r, rates.v_j, rates.a_j);
    let d = [p_j[0] - p_i[0], p_j[1] - p_i[1], p_j[2] - p_i[2]];
    let inverse = T::one() / d[0].norm();
    // u = d / L;  u. = (d. - u L.) / L;  u.. = (d.. - 2 u. L. - u L..) / L
    let u0 = d[0] * inverse;
    let l1 = u0.dot(d[1]);
    let u1 = (d[1] - u0 * l1) * inverse;
    let l2 = u1.dot(d[1]) + u0.dot(d[2]);
    let u2 = (d[2] - u1 * (l1 + l1) - u0 * l2) * inverse;
    force_rates([u0, u1, u2], p_j)
}

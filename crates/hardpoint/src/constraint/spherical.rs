//! Spherical constraint, one component: `e_k . (P_j - P_i) = 0` (paper Eq. 4.7), with e_k a world axis, or an axis of
//! the loop's base if that moves.

use crate::space::{Real, Vec3, Wrench};

use super::{MarkerPair, MarkerPairRates, axis, point_rates};

#[inline(always)]
pub(super) fn residual<T: Real>(k: usize, ends: &MarkerPair<T>) -> T {
    ends.j.r[k] - ends.i.r[k]
}

/// Wrench of the component: the force e_k through the common point.
#[inline(always)]
pub(super) fn wrench<T: Real>(k: usize, ends: &MarkerPair<T>) -> Wrench<T> {
    // l = [P x e_k; e_k], d(phi) = e_k . (V_j at P - V_i at P); away from the common point the error is (w_i x d) .
    // e_k, which vanishes as Newton converges
    Wrench { m: across(ends.j.r, k), f: Vec3::AXES[k].spread() }
}

#[inline(always)]
pub(super) fn wrench_rates<T: Real>(
    k: usize,
    ends: &MarkerPair<T>,
    rates: &MarkerPairRates<T>,
) -> [Wrench<T>; 2] {
    // l. = [P. x e_k; 0],    l.. = [P.. x e_k; 0]
    let [_, velocity, acceleration] = point_rates(ends.j.r, rates.v_j, rates.a_j);
    [Wrench::moment(across(velocity, k)), Wrench::moment(across(acceleration, k))]
}

#[inline(always)]
pub(super) fn residual_on_base<T: Real>(k: usize, ends: &MarkerPair<T>) -> T {
    axis(&ends.axes, k).dot(ends.j.r - ends.i.r)
}

#[inline(always)]
pub(super) fn wrench_on_base<T: Real>(k: usize, ends: &MarkerPair<T>) -> Wrench<T> {
    Wrench::force(axis(&ends.axes, k), ends.j.r)
}

/// Rates as for a base at rest: the relative velocity of the points is zero along every axis, so the rotation of the
/// axes does not contribute to any rate of the constraint.
#[inline(always)]
pub(super) fn wrench_rates_on_base<T: Real>(
    k: usize,
    ends: &MarkerPair<T>,
    rates: &MarkerPairRates<T>,
) -> [Wrench<T>; 2] {
    let e = axis(&ends.axes, k);
    let [_, velocity, acceleration] = point_rates(ends.j.r, rates.v_j, rates.a_j);
    [Wrench::moment(velocity.cross(e)), Wrench::moment(acceleration.cross(e))]
}

/// `p x e_k`.
#[inline(always)]
fn across<T: Real>(p: Vec3<T>, k: usize) -> Vec3<T> {
    let zero = T::zero();
    match k {
        0 => Vec3::new(zero, p.z, -p.y),
        1 => Vec3::new(-p.z, zero, p.x),
        _ => Vec3::new(p.y, -p.x, zero),
    }
}

//! Constant-velocity constraint: the rotation from marker i to marker j is about an axis perpendicular to both z_i and
//! z_j.
//!
//! A rotation by the angle t about an axis n has `R_21 - R_12 = 2 n_z sin t`. The two shafts therefore rotate equally
//! if and only if this difference of two Dot-1 products is zero, at any angle between them.

use crate::space::{Real, Wrench};

use super::{MarkerPair, dot1};

/// `y_i . x_j - x_i . y_j`.
#[inline(always)]
pub(super) fn residual<T: Real>(ends: &MarkerPair<T>, target: T) -> T {
    // R = A_i^T A_j:  R_21 = y_i . x_j,  R_12 = x_i . y_j
    dot1::residual(1, 0, ends, target) - dot1::residual(0, 1, ends, T::zero())
}

#[inline(always)]
pub(super) fn wrench<T: Real>(ends: &MarkerPair<T>) -> Wrench<T> {
    dot1::wrench(1, 0, ends) - dot1::wrench(0, 1, ends)
}

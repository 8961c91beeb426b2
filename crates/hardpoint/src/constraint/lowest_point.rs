//! Height of the lowest point of a wheel: `z_i . (C - P_i) = f`, with C the point of a disc about z_j through P_j that
//! is farthest against z_i.
//!
//! C moves over the disc, but always perpendicular to z_i: the height changes as that of the body's point at C.

use crate::space::{Real, Vec3, Wrench};

use super::{MarkerPair, axis};

/// Radius of a wheel, which is constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Radius(u64);

impl Radius {
    /// Radius, m.
    pub const fn of(metres: f64) -> Self {
        Self(metres.to_bits())
    }

    /// Returns the radius, m.
    pub const fn metres(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// Lowest point: `C = P_j - r (z_i - c z_j) / sqrt(1 - c^2)`, `c = z_i . z_j`.
#[inline(always)]
fn lowest<T: Real>(radius: Radius, ends: &MarkerPair<T>) -> Vec3<T> {
    let (up, spin) = (axis(&ends.i.rot, 2), axis(&ends.j.rot, 2));
    let c = up.dot(spin);
    let across = up - spin * c;
    ends.j.r - across * (T::constant(radius.metres()) / (T::one() - c * c).sqrt())
}

#[inline(always)]
pub(super) fn residual<T: Real>(radius: Radius, ends: &MarkerPair<T>, target: T) -> T {
    axis(&ends.i.rot, 2).dot(lowest(radius, ends) - ends.i.r) - target
}

/// Wrench: the force z_i through C.
#[inline(always)]
pub(super) fn wrench<T: Real>(radius: Radius, ends: &MarkerPair<T>) -> Wrench<T> {
    Wrench::force(axis(&ends.i.rot, 2), lowest(radius, ends))
}

//! Where a frame is and how it is turned.

use super::{Mat3, Real, Twist, Vec3, Wrench};

/// Position and orientation of a frame in another: `x_outer = r + rot * x_inner`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<T = f64> {
    /// Orientation of the inner frame.
    pub rot: Mat3<T>,
    /// Position of the inner frame's origin.
    pub r: Vec3<T>,
}

impl Pose<f64> {
    /// The frame itself.
    pub const IDENTITY: Self = Self { rot: Mat3::IDENTITY, r: Vec3::ZERO };

    /// The same pose in every lane of `witness`.
    #[inline(always)]
    pub fn spread<T: Real>(self, witness: T) -> Pose<T> {
        Pose { rot: self.rot.spread(witness), r: self.r.spread(witness) }
    }
}

impl<T: Real> Pose<T> {
    /// The pose of `inner`, given in this frame, in the outer frame.
    #[inline(always)]
    pub fn compose(self, inner: Self) -> Self {
        Self { rot: self.rot * inner.rot, r: self.point(inner.r) }
    }

    /// The outer frame seen from the inner one.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        let rot = self.rot.transpose();
        Self { rot, r: -(rot * self.r) }
    }

    /// A point of the inner frame, in the outer frame.
    #[inline(always)]
    pub fn point(self, s: Vec3<T>) -> Vec3<T> {
        self.rot.times_plus(s, self.r)
    }

    /// A twist of the inner frame carried into the outer one: `Ad(X) e` (`docs/theory.md` (2)).
    #[inline(always)]
    pub fn carry(self, e: Twist<T>) -> Twist<T> {
        let w = self.rot * e.w;
        Twist { w, v: self.r.cross_plus(w, self.rot * e.v) }
    }

    /// A wrench of the outer frame, seen from the inner one: `l . Ad(X) e = carry_back(l) . e`.
    #[inline(always)]
    pub fn carry_back(self, l: Wrench<T>) -> Wrench<T> {
        Wrench { m: self.rot.transpose_mul(l.m - self.r.cross(l.f)), f: self.rot.transpose_mul(l.f) }
    }

    /// The poses of all lanes, side by side.
    pub fn gather(witness: T, lane: impl Fn(usize) -> Pose) -> Self {
        let column = |c: usize| Vec3::gather(witness, |k| lane(k).rot.cols[c]);
        Self { rot: Mat3 { cols: [0, 1, 2].map(column) }, r: Vec3::gather(witness, |k| lane(k).r) }
    }

    /// The pose of lane `k`.
    #[inline(always)]
    pub fn lane(self, k: usize) -> Pose<f64> {
        Pose { rot: self.rot.lane(k), r: self.r.lane(k) }
    }
}

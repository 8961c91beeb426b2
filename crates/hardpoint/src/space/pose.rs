//! Position and orientation of a frame.

use crate::number::{Dual, Real};

use super::{Mat3, Twist, Vec3, Wrench};

/// Position and orientation of a frame in another: `x_outer = r + rot * x_inner`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<T = f64> {
    /// Orientation of the inner frame.
    pub rot: Mat3<T>,
    /// Position of the origin of the inner frame, m.
    pub r: Vec3<T>,
}

impl Pose<f64> {
    /// Identity: the two frames coincide.
    pub const IDENTITY: Self = Self { rot: Mat3::IDENTITY, r: Vec3::ZERO };

    /// This pose in another scalar type, as a constant.
    #[inline(always)]
    pub fn spread<T: Real>(self) -> Pose<T> {
        Pose { rot: self.rot.spread(), r: self.r.spread() }
    }
}

impl<T: Real> Pose<T> {
    /// Pose in the outer frame of `inner`, which is given in this frame.
    #[inline(always)]
    pub fn compose(self, inner: Self) -> Self {
        T::operation(
            #[inline(always)]
            || {
                // (A, r) (A', r') = (A A', r + A r')
                Self { rot: self.rot * inner.rot, r: self.point(inner.r) }
            },
        )
    }

    /// Inverse: the pose of the outer frame in the inner one.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        T::operation(|| {
            let rot = self.rot.transpose();
            // (A, r)^-1 = (A^T, -A^T r)
            Self { rot, r: -(rot * self.r) }
        })
    }

    /// Maps a point from the inner to the outer frame.
    #[inline(always)]
    pub fn point(self, s: Vec3<T>) -> Vec3<T> {
        self.rot.times_plus(s, self.r)
    }

    /// Maps a twist from the inner to the outer frame: `Ad(X) e` (`docs/theory.md` (2)).
    #[inline(always)]
    pub fn carry(self, e: Twist<T>) -> Twist<T> {
        T::operation(|| {
            // Ad(X) [w; v] = [A w;  A v + r x A w]                                                              (2)
            let w = self.rot * e.w;
            Twist { w, v: self.r.cross_plus(w, self.rot * e.v) }
        })
    }

    /// Maps a wrench from the outer to the inner frame: `l . Ad(X) e = carry_back(l) . e`.
    #[inline(always)]
    pub fn carry_back(self, l: Wrench<T>) -> Wrench<T> {
        T::operation(|| {
            // Ad(X)^T [m; f] = [A^T (m - r x f);  A^T f]
            Wrench { m: self.rot.transpose_mul(l.m - self.r.cross(l.f)), f: self.rot.transpose_mul(l.f) }
        })
    }

    /// This pose with its derivative along a twist in the outer frame: `A' = w x A`, `r' = v + w x r`.
    #[inline(always)]
    pub fn along(self, twist: Twist<T>) -> Pose<Dual<T>> {
        Pose { rot: self.rot.along(twist.w), r: self.r.with_derivative(twist.at(self.r)) }
    }

    /// This pose as plain numbers.
    #[inline(always)]
    pub fn value(self) -> Pose<f64> {
        Pose { rot: self.rot.value(), r: self.r.value() }
    }
}

impl<T: Real> Pose<Dual<Dual<T>>> {
    /// This pose with the outer derivative inside and the inner one outside.
    pub fn exchanged(self) -> Self {
        let exchange =
            |x: Dual<Dual<T>>| Dual { v: Dual { v: x.v.v, d: x.d.v }, d: Dual { v: x.v.d, d: x.d.d } };
        let [f, g, h] = self.rot.cols;
        Self {
            rot: Mat3 { cols: [f.map(exchange), g.map(exchange), h.map(exchange)] },
            r: self.r.map(exchange),
        }
    }
}

impl<T: Real> Pose<Dual<T>> {
    /// This pose without derivative.
    pub fn nominal(self) -> Pose<T> {
        let of = |c: Vec3<Dual<T>>| c.map(|x| x.v);
        let [f, g, h] = self.rot.cols;
        Pose { rot: Mat3 { cols: [of(f), of(g), of(h)] }, r: of(self.r) }
    }

    /// Splits a dual pose into the pose and its twist `[w; v]`, in components of the outer frame, with v at the outer
    /// frame's origin.
    pub fn split(self) -> (Pose<T>, Twist<T>) {
        let value = self.nominal();
        // The rate of every unit vector c is w x c; w is half the sum of c x c'.
        let turn = |k: usize| value.rot.cols[k].cross(self.rot.cols[k].map(|x| x.d));
        let w = (turn(0) + turn(1) + turn(2)) * T::constant(0.5);
        // r' = v + w x r
        (value, Twist { w, v: self.r.map(|x| x.d) - w.cross(value.r) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turning_pose_gives_its_twist() {
        let axis = Vec3::new(0.6, 0.0, 0.8);
        let b = Dual::variable(0.3);
        let rot = Mat3::about(axis, b);
        let r = rot * Vec3::new(1.0, 2.0, 3.0).spread();
        let (pose, twist) = Pose { rot, r }.split();
        assert!((twist.w - axis).norm() < 1e-15, "{twist:?}");
        assert!(twist.v.norm() < 1e-14, "a turn about the origin leaves it there: {twist:?}");
        assert!((pose.rot.cols[0] - Mat3::from_rotation_vector(axis * 0.3).cols[0]).norm() < 1e-15);
    }
}

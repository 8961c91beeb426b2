//! Twists and wrenches, all referred to the world origin, in world components.
//!
//! `docs/theory.md`, section 1: W = [w; v] and l = [m; f]. The body point at p moves with `v + w x p`. All wrenches
//! refer to the world origin, so sums over bodies and joints need no lever arms.

use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use crate::number::{Dual, Real};

use super::Vec3;

/// First-order motion of a body: angular velocity, and velocity of the body point at the world origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<T = f64> {
    /// Angular velocity, rad per unit of time or of the design variable.
    pub w: Vec3<T>,
    /// Velocity of the body point that coincides with the world origin, m per unit of time or of the design variable.
    pub v: Vec3<T>,
}

/// Wrench of a force or constraint: moment about the world origin, and force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench<T = f64> {
    /// Moment about the world origin, N m; for a constraint row, per unit of its multiplier.
    pub m: Vec3<T>,
    /// Force, N; for a constraint row, per unit of its multiplier.
    pub f: Vec3<T>,
}

impl Twist<f64> {
    /// No motion.
    pub const ZERO: Self = Self { w: Vec3::ZERO, v: Vec3::ZERO };

    /// Unit twists: rotations about x, y and z through the world origin, followed by translations.
    pub const UNITS: [Self; 6] = {
        let [x, y, z] = Vec3::AXES;
        let none = Vec3::ZERO;
        [
            Self { w: x, v: none },
            Self { w: y, v: none },
            Self { w: z, v: none },
            Self { w: none, v: x },
            Self { w: none, v: y },
            Self { w: none, v: z },
        ]
    };

    /// This twist in another scalar type, as a constant.
    #[inline(always)]
    pub fn spread<T: Real>(self) -> Twist<T> {
        Twist { w: self.w.spread(), v: self.v.spread() }
    }
}

impl<T: Real> Twist<T> {
    /// No motion.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { w: Vec3::zero(), v: Vec3::zero() }
    }

    /// Twist with these components along the unit twists.
    #[inline(always)]
    pub fn from_components([a, b, c, x, y, z]: [T; 6]) -> Self {
        Self { w: Vec3::new(a, b, c), v: Vec3::new(x, y, z) }
    }

    /// Components of w, then of v.
    #[inline(always)]
    pub fn components(self) -> [T; 6] {
        let Self { w, v } = self;
        [w.x, w.y, w.z, v.x, v.y, v.z]
    }

    /// This twist with the derivative `d`.
    #[inline(always)]
    pub fn with_derivative(self, d: Self) -> Twist<Dual<T>> {
        Twist { w: self.w.with_derivative(d.w), v: self.v.with_derivative(d.v) }
    }

    /// Rotation at unit rate about the line through `point` along the unit vector `axis`.
    #[inline(always)]
    pub fn turn(axis: Vec3<T>, point: Vec3<T>) -> Self {
        // x = [h; c x h]: points of the line are at rest, v + h x c = 0
        Self { w: axis, v: point.cross(axis) }
    }

    /// Translation at unit rate along the unit vector `axis`.
    #[inline(always)]
    pub fn slide(axis: Vec3<T>) -> Self {
        // x = [0; h]
        Self { w: Vec3::zero(), v: axis }
    }

    /// Rate of a twist `o` fixed in a body that moves with twist `self`: `ad(self) o` (`docs/theory.md` (3)).
    #[inline(always)]
    pub fn ad(self, o: Self) -> Self {
        T::operation(|| {
            // ad(V) x = [V_w x x_w;  V_w x x_v + V_v x x_w]                                                     (3)
            Self { w: self.w.cross(o.w), v: self.w.cross_plus(o.v, self.v.cross(o.w)) }
        })
    }

    /// Transpose of [`ad`](Self::ad): `l . ad(self) o = ad_transposed(l) . o`.
    #[inline(always)]
    pub fn ad_transposed(self, l: Wrench<T>) -> Wrench<T> {
        T::operation(|| {
            // ad(V)^T l = [m x V_w + f x V_v;  f x V_w], from  m . (V_w x x_w) + f . (V_w x x_v + V_v x x_w)
            Wrench { m: l.m.cross_plus(self.w, l.f.cross(self.v)), f: l.f.cross(self.w) }
        })
    }

    /// Velocity of the body point at `p`.
    #[inline(always)]
    pub fn at(self, p: Vec3<T>) -> Vec3<T> {
        // w x p + v
        self.w.cross_plus(p, self.v)
    }

    /// `self * k + addend`.
    #[inline(always)]
    pub fn times_plus(self, k: T, addend: Self) -> Self {
        T::operation(|| Self { w: self.w.times_plus(k, addend.w), v: self.v.times_plus(k, addend.v) })
    }

    /// This twist as plain numbers.
    #[inline(always)]
    pub fn value(self) -> Twist<f64> {
        Twist { w: self.w.value(), v: self.v.value() }
    }
}

impl Wrench<f64> {
    /// This wrench in another scalar type, as a constant.
    #[inline(always)]
    pub fn spread<T: Real>(self) -> Wrench<T> {
        Wrench { m: self.m.spread(), f: self.f.spread() }
    }
}

impl<T: Real> Wrench<T> {
    /// Zero wrench.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { m: Vec3::zero(), f: Vec3::zero() }
    }

    /// Wrench that does this work on each of the unit twists.
    #[inline(always)]
    pub fn from_work([a, b, c, x, y, z]: [T; 6]) -> Self {
        Self { m: Vec3::new(a, b, c), f: Vec3::new(x, y, z) }
    }

    /// Work on each of the unit twists.
    #[inline(always)]
    pub fn work(self) -> [T; 6] {
        [self.m.x, self.m.y, self.m.z, self.f.x, self.f.y, self.f.z]
    }

    /// This wrench without derivative.
    #[inline(always)]
    pub fn constant(self) -> Wrench<Dual<T>> {
        Wrench { m: self.m.map(Dual::constant), f: self.f.map(Dual::constant) }
    }

    /// `self * k + addend`.
    #[inline(always)]
    pub fn times_plus(self, k: T, addend: Self) -> Self {
        T::operation(|| Self { m: self.m.times_plus(k, addend.m), f: self.f.times_plus(k, addend.f) })
    }

    /// Wrench of the force `f` acting at `point`.
    #[inline(always)]
    pub fn force(f: Vec3<T>, point: Vec3<T>) -> Self {
        // l = [p x f; f]
        Self { m: point.cross(f), f }
    }

    /// Wrench of the pure moment `m`.
    #[inline(always)]
    pub fn moment(m: Vec3<T>) -> Self {
        Self { m, f: Vec3::zero() }
    }

    /// Power of this wrench on a twist: `m . w + f . v`.
    #[inline(always)]
    pub fn on(self, t: Twist<T>) -> T {
        T::operation(
            #[inline(always)]
            || {
                // l . W = m . w + f . v                                                                             (1)
                let (m, f, w, v) = (self.m, self.f, t.w, t.v);
                let moment = m.dot(w);
                f.z.times_plus(v.z, f.y.times_plus(v.y, f.x.times_plus(v.x, moment)))
            },
        )
    }
}

impl<T: Real> Wrench<Dual<T>> {
    /// Derivative of this wrench.
    #[inline(always)]
    pub fn derivative(self) -> Wrench<T> {
        Wrench { m: self.m.map(|x| x.d), f: self.f.map(|x| x.d) }
    }
}

impl<T: Real> Sub for Wrench<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        T::operation(|| Self { m: self.m - o.m, f: self.f - o.f })
    }
}

impl<T: Real> AddAssign for Wrench<T> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        T::operation(|| {
            self.m += o.m;
            self.f += o.f;
        })
    }
}

impl<T: Real> SubAssign for Wrench<T> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        T::operation(|| {
            self.m = self.m - o.m;
            self.f = self.f - o.f;
        })
    }
}

impl<T: Real> Add for Twist<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        T::operation(|| Self { w: self.w + o.w, v: self.v + o.v })
    }
}

impl<T: Real> Sub for Twist<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        T::operation(
            #[inline(always)]
            || Self { w: self.w - o.w, v: self.v - o.v },
        )
    }
}

impl<T: Real> Neg for Twist<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        T::operation(|| Self { w: -self.w, v: -self.v })
    }
}

impl<T: Real> Mul<T> for Twist<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: T) -> Self {
        T::operation(|| Self { w: self.w * k, v: self.v * k })
    }
}

impl<T: Real> AddAssign for Twist<T> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        T::operation(
            #[inline(always)]
            || {
                self.w += o.w;
                self.v += o.v;
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{Mat3, Pose};

    #[test]
    fn wrenches_go_back_the_way_that_twists_come() {
        let vector = |k: f64| Vec3::new(k.sin(), (2.0 * k).cos(), k - 1.3);
        let twist = |k: f64| Twist { w: vector(k), v: vector(k + 0.7) };
        let l = Wrench { m: vector(0.2), f: vector(2.1) };
        let (v, e) = (twist(0.4), twist(1.9));
        let pose = Pose { rot: Mat3::from_rotation_vector(vector(0.9)), r: vector(3.0) };
        assert!((v.ad_transposed(l).on(e) - l.on(v.ad(e))).abs() < 1e-14);
        assert!((pose.carry_back(l).on(e) - l.on(pose.carry(e))).abs() < 1e-14);
        assert!(l.on(pose.carry(e)).abs() > 0.1);
    }
}

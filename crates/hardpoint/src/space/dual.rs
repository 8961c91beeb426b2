//! A number with its derivative by one variable.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::real::Function;
use super::{Pose, Real, Twist};

/// A number and its derivative. What is written once over [`Real`] is differentiated by running it on these; a dual of
/// duals has second derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Dual<T = f64> {
    /// The value.
    pub v: T,
    /// Its derivative.
    pub d: T,
}

impl<T: Real> Dual<T> {
    /// What the derivative is taken by, at this value.
    #[inline(always)]
    pub fn variable(v: T) -> Self {
        Self { v, d: v.like(1.0) }
    }

    /// What does not depend on it.
    #[inline(always)]
    pub fn constant(v: T) -> Self {
        Self { v, d: v.zero() }
    }
}

impl<T: Real> Pose<Dual<T>> {
    /// The pose, and the twist at which it changes, fixed in the outer frame: `[w; v]` with v at the outer frame's origin.
    pub fn split(self) -> (Pose<T>, Twist<T>) {
        let value =
            Pose { rot: super::Mat3 { cols: self.rot.cols.map(|c| c.map(|x| x.v)) }, r: self.r.map(|x| x.v) };
        // The rate of every unit vector c is w x c: w is half the sum of c x c'.
        let turn = |k: usize| value.rot.cols[k].cross(self.rot.cols[k].map(|x| x.d));
        let w = (turn(0) + turn(1) + turn(2)) * value.r.x.like(0.5);
        (value, Twist { w, v: self.r.map(|x| x.d) - w.cross(value.r) })
    }
}

impl<T: Real> Add for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { v: self.v + o.v, d: self.d + o.d }
    }
}

impl<T: Real> Sub for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { v: self.v - o.v, d: self.d - o.d }
    }
}

impl<T: Real> Mul for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self { v: self.v * o.v, d: self.d * o.v + self.v * o.d }
    }
}

impl<T: Real> Div for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let v = self.v / o.v;
        Self { v, d: (self.d - v * o.d) / o.v }
    }
}

impl<T: Real> Neg for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { v: -self.v, d: -self.d }
    }
}

impl<T: Real> AddAssign for Dual<T> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<T: Real> SubAssign for Dual<T> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

/// Lanes, and whatever else only looks at a number, see the value.
impl<T: Real> Real for Dual<T> {
    const LANES: usize = T::LANES;
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        Self::constant(self.v.like(x))
    }
    #[inline(always)]
    fn like_lanes(self, lane: impl FnMut(usize) -> f64) -> Self {
        Self::constant(self.v.like_lanes(lane))
    }
    #[inline(always)]
    fn lane(self, k: usize) -> f64 {
        self.v.lane(k)
    }
    #[inline(always)]
    fn store(self, out: &mut [f64]) {
        self.v.store(out);
    }
    #[inline(always)]
    fn each_lane(components: &[Self; 8], out: impl FnMut(usize, &[f64; 8])) {
        T::each_lane(&components.map(|c| c.v), out);
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let v = self.v.sqrt();
        Self { v, d: self.d / (v + v) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let sign = self.v.like_lanes(|k| f64::signum(self.v.lane(k)));
        Self { v: self.v.abs(), d: self.d * sign }
    }
    #[inline(always)]
    fn round(self) -> Self {
        Self::constant(self.v.round())
    }
    #[inline(always)]
    fn within<R>(self, f: impl FnOnce() -> R) -> R {
        self.v.within(f)
    }
    #[inline(always)]
    fn larger(self, o: Self) -> Self {
        let v = self.v.larger(o.v);
        Self { v, d: self.d.select(o.d, |k| v.lane(k) == self.v.lane(k)) }
    }
    fn select(self, other: Self, first: impl Fn(usize) -> bool + Copy) -> Self {
        Self { v: self.v.select(other.v, first), d: self.d.select(other.d, first) }
    }
    fn map(self, function: Function) -> Self {
        let v = self.v.map(function);
        Self { v, d: self.d * function.slope(self.v, v) }
    }
    fn powf(self, exponent: f64) -> Self {
        let slope = self.v.powf(exponent - 1.0) * self.v.like(exponent);
        Self { v: self.v.powf(exponent), d: self.d * slope }
    }
    #[inline(always)]
    fn largest(self) -> f64 {
        self.v.largest()
    }
    #[inline(always)]
    fn rate(self) -> Self {
        Self { v: self.v.rate(), d: self.d.rate() }
    }
    #[inline(always)]
    fn vanishes(self) -> bool {
        self.v.vanishes() && self.d.vanishes()
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let square = self.v * self.v + x.v * x.v;
        Self { v: self.v.atan2(x.v), d: (self.d * x.v - self.v * x.d) / square }
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.v.sin_cos();
        (Self { v: sin, d: self.d * cos }, Self { v: cos, d: -(self.d * sin) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{Mat3, Vec3};

    #[test]
    fn derivatives_of_either_order_match_the_closed_form() {
        let f = |x: Dual<Dual>| {
            let (s, c) = x.sin_cos();
            (s * s + x.like(2.0)).sqrt() / (c + x * x)
        };
        let x = 0.7;
        let y = f(Dual { v: Dual::variable(x), d: Dual::constant(1.0) });
        let at = |x: f64| (x.sin() * x.sin() + 2.0).sqrt() / (x.cos() + x * x);
        let h = 1e-4;
        assert!((y.v.v - at(x)).abs() < 1e-15);
        assert!((y.d.v - (at(x + h) - at(x - h)) / (2.0 * h)).abs() < 1e-7);
        assert!((y.d.d - (at(x + h) - 2.0 * at(x) + at(x - h)) / (h * h)).abs() < 1e-6);
        assert_eq!(y.d.v, y.v.d);
    }

    #[test]
    fn every_function_has_its_first_two_derivatives() {
        type Case = (&'static str, fn(Dual<Dual>) -> Dual<Dual>, fn(f64) -> f64);
        let cases: [Case; 13] = [
            ("tan", |x| x.map(Function::Tan), f64::tan),
            ("asin", Real::asin, f64::asin),
            ("acos", |x| x.map(Function::Acos), f64::acos),
            ("atan", |x| x.map(Function::Atan), f64::atan),
            ("sinh", |x| x.map(Function::Sinh), f64::sinh),
            ("cosh", |x| x.map(Function::Cosh), f64::cosh),
            ("tanh", |x| x.map(Function::Tanh), f64::tanh),
            ("exp", |x| x.map(Function::Exp), f64::exp),
            ("ln", |x| x.map(Function::Ln), f64::ln),
            ("powf", |x| x.powf(2.7), |x| x.powf(2.7)),
            ("atan2", |x| x.atan2(x * x + x.like(0.5)), |x| x.atan2(x * x + 0.5)),
            ("larger", |x| (x * x * x).larger(x * x), |x| (x * x * x).max(x * x)),
            ("select", |x| (x * x).select(x.like(f64::NAN), |_| true), |x| x * x),
        ];
        for (name, f, at) in cases {
            for x in [0.2, 0.7] {
                let y = f(Dual { v: Dual::variable(x), d: Dual::constant(1.0) });
                let h = 1e-4;
                assert!((y.v.v - at(x)).abs() < 1e-15, "{name}");
                assert!((y.d.v - (at(x + h) - at(x - h)) / (2.0 * h)).abs() < 1e-5, "{name}");
                let second = (at(x + h) - 2.0 * at(x) + at(x - h)) / (h * h);
                assert!((y.d.d - second).abs() < 1e-4 * second.abs().max(1.0), "{name}: {} {second}", y.d.d);
                assert!(y.d.v != 0.0 && y.d.v == y.v.d, "{name}");
            }
        }
    }

    #[test]
    fn a_turning_pose_gives_its_twist() {
        let axis = Vec3::new(0.6, 0.0, 0.8);
        let b = Dual::variable(0.3);
        let rot = Mat3::about(axis, b);
        let r = rot * Vec3::new(1.0, 2.0, 3.0).spread(b);
        let (pose, twist) = Pose { rot, r }.split();
        assert!((twist.w - axis).norm() < 1e-15, "{twist:?}");
        assert!(twist.v.norm() < 1e-14, "a turn about the origin leaves it there: {twist:?}");
        assert!((pose.rot.cols[0] - Mat3::from_rotation_vector(axis * 0.3).cols[0]).norm() < 1e-15);
    }
}

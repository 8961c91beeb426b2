//! Dual numbers: a value with its derivative with respect to one variable.

use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::{Function, Real};

/// A value and its derivative. Code written over [`Real`] is differentiated by running it on duals; a dual of duals
/// carries second derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T = f64> {
    /// The value.
    pub v: T,
    /// Derivative of the value with respect to the variable.
    pub d: T,
}

impl<T: Real> Dual<T> {
    /// The variable of differentiation at this value.
    #[inline(always)]
    pub fn variable(v: T) -> Self {
        Self { v, d: T::one() }
    }

    /// A constant: its derivative is zero.
    #[inline(always)]
    pub fn constant(v: T) -> Self {
        Self { v, d: T::zero() }
    }

    /// The function value `v`, with its derivative computed from this number's derivative by `d`. A number that does
    /// not depend on the variable has a constant as its function value, even where the function has a vertical tangent.
    #[inline(always)]
    fn or_constant(self, v: T, d: impl FnOnce(T) -> T) -> Self {
        Self { v, d: if self.d.vanishes() { T::zero() } else { d(self.d) } }
    }
}

impl<T: Real> Add for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        T::operation(|| Self { v: self.v + o.v, d: self.d + o.d })
    }
}

impl<T: Real> Sub for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        T::operation(|| Self { v: self.v - o.v, d: self.d - o.d })
    }
}

impl<T: Real> Mul for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        T::operation(|| Self { v: self.v * o.v, d: self.d * o.v + self.v * o.d })
    }
}

impl<T: Real> Div for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        T::operation(|| {
            let v = self.v / o.v;
            Self { v, d: (self.d - v * o.d) / o.v }
        })
    }
}

impl<T: Real> Neg for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        T::operation(|| Self { v: -self.v, d: -self.d })
    }
}

impl<T: Real> Add<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: f64) -> Self {
        Self { v: self.v + o, ..self }
    }
}

impl<T: Real> Mul<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self { v: self.v * factor, d: self.d * factor }
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

/// Comparisons and tests use the value only.
impl<T: Real> Real for Dual<T> {
    #[inline(always)]
    fn operation<R>(operation: impl FnOnce() -> R) -> R {
        T::operation(operation)
    }
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::constant(T::constant(x))
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self.v.value()
    }
    #[inline(always)]
    fn decisive(self) -> f64 {
        self.v.decisive()
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        T::operation(|| {
            let v = self.v.sqrt();
            Self { v, d: self.d / (v + v) }
        })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self { v: self.v.abs(), d: self.d * self.v.sign() }
    }
    #[inline(always)]
    fn sign_or(self, next: Self) -> Self {
        Self::constant(self.v.sign_or(next.v))
    }
    #[inline(always)]
    fn exceeds(self, o: Self) -> bool {
        self.v.exceeds(o.v)
    }
    #[inline(always)]
    fn round(self) -> Self {
        Self::constant(self.v.round())
    }
    #[inline(always)]
    fn larger(self, o: Self) -> Self {
        let v = self.v.larger(o.v);
        Self { v, d: self.d.select(o.d, v.value() == self.v.value()) }
    }
    #[inline(always)]
    fn select(self, other: Self, first: bool) -> Self {
        Self { v: self.v.select(other.v, first), d: self.d.select(other.d, first) }
    }
    fn map(self, function: Function) -> Self {
        let v = self.v.map(function);
        self.or_constant(v, |d| d * function.derivatives(self.v, v)[0])
    }
    fn is_zero(self) -> bool {
        self.v.is_zero() && self.d.is_zero()
    }
    #[inline(always)]
    fn order(self, o: Self) -> Option<Ordering> {
        self.v.order(o.v)
    }
    #[inline(always)]
    fn held(self) -> Self {
        Self { v: self.v.held(), d: self.d.held() }
    }
    #[inline(always)]
    fn without_derivatives(self) -> Self {
        let stays = self.d.is_zero() && !self.v.value().is_nan();
        let d = if stays { self.d } else { T::constant(f64::NAN).without_derivatives() };
        Self { v: self.v.without_derivatives(), d }
    }
    fn pow(self, exponent: Self) -> Self {
        // d xᵖ = p x^(p-1) dx + xᵖ ln x dp; a zero factor takes precedence over an infinite one.
        let (x, p, zero) = (self.v, exponent.v, T::zero());
        let power = x.pow(p);
        let by_base = self.or_constant(power, |d| d * zero.select(p * x.pow(p + -1.0), p.is_zero()));
        let by_exponent =
            exponent.or_constant(power, |d| d * zero.select(power * x.map(Function::Ln), power.is_zero()));
        Self { v: power, d: by_base.d + by_exponent.d }
    }
    fn hypot(self, o: Self) -> Self {
        let v = self.v.hypot(o.v);
        let (by_x, by_y) = (self.or_constant(v, |d| d * (self.v / v)), o.or_constant(v, |d| d * (o.v / v)));
        Self { v, d: by_x.d + by_y.d }
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
        let v = self.v.atan2(x.v);
        if self.d.vanishes() && x.d.vanishes() {
            return Self::constant(v);
        }
        let square = self.v * self.v + x.v * x.v;
        Self { v, d: (self.d * x.v - self.v * x.d) / square }
    }
    #[inline(always)]
    fn angle_near(self, cos: Self, near: Self) -> Self {
        // Whole turns are constant.
        Self { v: self.v.angle_near(cos.v, near.v), ..self.atan2(cos) }
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        T::operation(|| {
            let (sin, cos) = self.v.sin_cos();
            (Self { v: sin, d: self.d * cos }, Self { v: cos, d: -(self.d * sin) })
        })
    }
    #[inline(always)]
    fn sin_cos_of_any(self) -> (Self, Self) {
        T::operation(|| {
            let (sin, cos) = self.v.sin_cos_of_any();
            (Self { v: sin, d: self.d * cos }, Self { v: cos, d: -(self.d * sin) })
        })
    }
}

#[cfg(test)]
mod tests {
    use num_dual::{Dual64, DualNum};

    use super::*;

    #[test]
    fn derivatives_of_either_order_match_the_closed_form() {
        let f = |x: Dual<Dual>| {
            let (s, c) = x.sin_cos();
            (s * s + 2.0).sqrt() / (c + x * x)
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
            ("atan2", |x| x.atan2(x * x + 0.5), |x| x.atan2(x * x + 0.5)),
            ("larger", |x| (x * x * x).larger(x * x), |x| (x * x * x).max(x * x)),
            ("select", |x| (x * x).select(Real::constant(f64::NAN), true), |x| x * x),
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
    fn functions_agree_with_num_dual() {
        type Case = (&'static str, fn(Dual) -> Dual, fn(Dual64) -> Dual64);
        let cases: [Case; 17] = [
            ("sin", |x| x.sin_cos().0, |x| x.sin()),
            ("cos", |x| x.sin_cos().1, |x| x.cos()),
            ("tan", |x| x.map(Function::Tan), |x| x.tan()),
            ("asin", |x| x.map(Function::Asin), |x| x.asin()),
            ("acos", |x| x.map(Function::Acos), |x| x.acos()),
            ("atan", |x| x.map(Function::Atan), |x| x.atan()),
            ("sinh", |x| x.map(Function::Sinh), |x| x.sinh()),
            ("cosh", |x| x.map(Function::Cosh), |x| x.cosh()),
            ("tanh", |x| x.map(Function::Tanh), |x| x.tanh()),
            ("exp", |x| x.map(Function::Exp), |x| x.exp()),
            ("ln", |x| x.map(Function::Ln), |x| x.ln()),
            ("log10", |x| x.map(Function::Log10), |x| x.log10()),
            ("sqrt", |x| x.map(Function::Sqrt), |x| x.sqrt()),
            ("powi", |x| x.powi(-3), |x| x.powi(-3)),
            ("powf", |x| x.pow(x * 2.0), |x| (x * 2.0 * x.ln()).exp()),
            ("atan2", |x| x.atan2(x * x + 0.5), |x| x.atan2(x * x + 0.5)),
            ("quotient", |x| (x - x * 3.0) / (-x * x + 5.0), |x| (x - x * 3.0) / (-x * x + 5.0)),
        ];
        for (name, ours, oracle) in cases {
            for value in [0.15, 0.4, 0.9] {
                let (ours, oracle) = (ours(Dual { v: value, d: -1.7 }), oracle(Dual64::new(value, -1.7)));
                assert!((ours.v - oracle.re).abs() <= 1e-14 * oracle.re.abs().max(1.0), "{name}");
                assert!((ours.d - oracle.eps).abs() <= 1e-13 * oracle.eps.abs().max(1.0), "{name}");
                assert!(ours.d != 0.0, "{name}");
            }
        }
        let length = Dual { v: 3.0, d: 1.0 }.hypot(Dual { v: 4.0, d: 2.0 });
        assert_eq!((length.v, length.d), (5.0, 2.2));
    }

    #[test]
    fn numbers_independent_of_the_parameter_have_derivative_zero_at_a_vertical_tangent() {
        let [zero, one] = [0.0, 1.0].map(Dual::constant);
        for root in [zero.map(Function::Sqrt), one.asin(), zero.powf(0.5)] {
            assert_eq!(root.d, 0.0);
        }
    }
}

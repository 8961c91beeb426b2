//! The numbers that laws are evaluated in: plain ones, or ones that carry the derivative by one parameter. What several
//! numbers side by side offer too is a trait of its own.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number with the operations of the commonest laws: a [`Scalar`], or several numbers
/// [side by side](super::lanes::Lanes).
///
/// Nothing here asks how large a number is, so nothing takes one lane's side for all of them.
pub trait Arithmetic:
    Copy
    + Debug
    + Add<Output = Self>
    + Add<f64, Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The number `x`, which depends on no parameter.
    fn like(self, x: f64) -> Self;
    /// The sine and the cosine.
    fn sin_cos(self) -> (Self, Self);
    /// The square root.
    fn sqrt(self) -> Self;
    /// The power with a whole exponent.
    fn powi(self, exponent: i32) -> Self;
}

/// A number in which any law can be evaluated: `f64`, or [`Dual`] for the derivative by a parameter.
pub trait Scalar: Arithmetic + PartialEq {
    /// The number zero.
    const ZERO: Self;
    /// The number one.
    const ONE: Self;

    /// A number that depends on no parameter.
    fn fixed(value: f64) -> Self {
        Self::varied(value, 0.0)
    }

    /// A number whose derivative by the parameter is `partial`; a plain number has no room for it.
    fn varied(value: f64, partial: f64) -> Self;

    /// The number without its derivative.
    fn value(self) -> f64;

    /// The tangent.
    fn tan(self) -> Self;
    /// The arc sine.
    fn asin(self) -> Self;
    /// The arc cosine.
    fn acos(self) -> Self;
    /// The arc tangent.
    fn atan(self) -> Self;
    /// The angle of the point (`x`, `self`).
    fn atan2(self, x: Self) -> Self;
    /// The hyperbolic sine.
    fn sinh(self) -> Self;
    /// The hyperbolic cosine.
    fn cosh(self) -> Self;
    /// The hyperbolic tangent.
    fn tanh(self) -> Self;
    /// The exponential function.
    fn exp(self) -> Self;
    /// The natural logarithm.
    fn ln(self) -> Self;
    /// The logarithm to base 10.
    fn log10(self) -> Self;
    /// The length of the vector (`self`, `other`).
    fn hypot(self, other: Self) -> Self;
    /// The power with any exponent.
    fn powf(self, exponent: Self) -> Self;
}

impl Arithmetic for f64 {
    #[inline]
    fn like(self, x: f64) -> Self {
        x
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        self.sin_cos()
    }

    #[inline]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline]
    fn powi(self, exponent: i32) -> Self {
        self.powi(exponent)
    }
}

impl Scalar for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    fn varied(value: f64, _: f64) -> Self {
        value
    }

    fn value(self) -> f64 {
        self
    }

    fn tan(self) -> Self {
        self.tan()
    }

    fn asin(self) -> Self {
        self.asin()
    }

    fn acos(self) -> Self {
        self.acos()
    }

    fn atan(self) -> Self {
        self.atan()
    }

    fn atan2(self, x: Self) -> Self {
        self.atan2(x)
    }

    fn sinh(self) -> Self {
        self.sinh()
    }

    fn cosh(self) -> Self {
        self.cosh()
    }

    fn tanh(self) -> Self {
        self.tanh()
    }

    fn exp(self) -> Self {
        self.exp()
    }

    fn ln(self) -> Self {
        self.ln()
    }

    fn log10(self) -> Self {
        self.log10()
    }

    fn hypot(self, other: Self) -> Self {
        self.hypot(other)
    }

    fn powf(self, exponent: Self) -> Self {
        self.powf(exponent)
    }
}

/// A number and its derivative by one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The number.
    pub value: f64,
    /// Its derivative.
    pub partial: f64,
}

impl Dual {
    /// g(self), from g and its derivative at the value.
    fn chain(self, g: f64, g_d: f64) -> Self {
        // What does not depend on the parameter does not, also where g has a vertical tangent.
        Self { value: g, partial: if self.partial == 0.0 { 0.0 } else { g_d * self.partial } }
    }
}

impl Arithmetic for Dual {
    fn like(self, x: f64) -> Self {
        Self::fixed(x)
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    fn sqrt(self) -> Self {
        self.chain(self.value.sqrt(), 0.5 / self.value.sqrt())
    }

    fn powi(self, exponent: i32) -> Self {
        let slope = match exponent {
            0 => 0.0,
            n => f64::from(n) * self.value.powi(n.saturating_sub(1)),
        };
        self.chain(self.value.powi(exponent), slope)
    }
}

impl Scalar for Dual {
    const ZERO: Self = Self { value: 0.0, partial: 0.0 };
    const ONE: Self = Self { value: 1.0, partial: 0.0 };

    fn varied(value: f64, partial: f64) -> Self {
        Self { value, partial }
    }

    fn value(self) -> f64 {
        self.value
    }

    fn tan(self) -> Self {
        let tan = self.value.tan();
        self.chain(tan, 1.0 + tan * tan)
    }

    fn asin(self) -> Self {
        self.chain(self.value.asin(), 1.0 / ((1.0 - self.value) * (1.0 + self.value)).sqrt())
    }

    fn acos(self) -> Self {
        self.chain(self.value.acos(), -1.0 / ((1.0 - self.value) * (1.0 + self.value)).sqrt())
    }

    fn atan(self) -> Self {
        self.chain(self.value.atan(), 1.0 / (1.0 + self.value * self.value))
    }

    fn atan2(self, x: Self) -> Self {
        let length = self.value.hypot(x.value);
        let (cos, sin) = (x.value / length, self.value / length);
        let by_y = self.chain(self.value.atan2(x.value), cos / length);
        let by_x = x.chain(0.0, -sin / length);
        Self { partial: by_y.partial + by_x.partial, ..by_y }
    }

    fn sinh(self) -> Self {
        self.chain(self.value.sinh(), self.value.cosh())
    }

    fn cosh(self) -> Self {
        self.chain(self.value.cosh(), self.value.sinh())
    }

    fn tanh(self) -> Self {
        self.chain(self.value.tanh(), self.value.cosh().powi(-2))
    }

    fn exp(self) -> Self {
        self.chain(self.value.exp(), self.value.exp())
    }

    fn ln(self) -> Self {
        self.chain(self.value.ln(), 1.0 / self.value)
    }

    fn log10(self) -> Self {
        self.chain(self.value.log10(), 1.0 / (self.value * std::f64::consts::LN_10))
    }

    fn hypot(self, other: Self) -> Self {
        let length = self.value.hypot(other.value);
        let (by_x, by_y) = (self.chain(length, self.value / length), other.chain(0.0, other.value / length));
        Self { partial: by_x.partial + by_y.partial, ..by_x }
    }

    fn powf(self, exponent: Self) -> Self {
        // d xᵖ = p x^(p-1) dx + xᵖ ln x dp
        let power = self.value.powf(exponent.value);
        let slope = match exponent.value {
            0.0 => 0.0,
            p => p * self.value.powf(p - 1.0),
        };
        let by_exponent = if power == 0.0 { 0.0 } else { power * self.value.ln() };
        let (by_x, by_p) = (self.chain(power, slope), exponent.chain(0.0, by_exponent));
        Self { partial: by_x.partial + by_p.partial, ..by_x }
    }
}

impl Add for Dual {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, partial: self.partial + other.partial }
    }
}

impl Add<f64> for Dual {
    type Output = Self;

    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl Sub for Dual {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, partial: self.partial - other.partial }
    }
}

impl Mul for Dual {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let partial = self.value * other.partial + self.partial * other.value;
        Self { value: self.value * other.value, partial }
    }
}

impl Mul<f64> for Dual {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self { value: self.value * factor, partial: self.partial * factor }
    }
}

impl Div for Dual {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        Self { value: quotient, partial: (self.partial - quotient * other.partial) / other.value }
    }
}

impl Neg for Dual {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, partial: -self.partial }
    }
}

#[cfg(test)]
mod tests {
    use num_dual::{Dual64, DualNum};

    use super::*;

    #[test]
    fn functions_agree_with_num_dual() {
        type Case = (&'static str, fn(Dual) -> Dual, fn(Dual64) -> Dual64);
        let cases: [Case; 17] = [
            ("sin", |x| x.sin_cos().0, |x| x.sin()),
            ("cos", |x| x.sin_cos().1, |x| x.cos()),
            ("tan", Scalar::tan, |x| x.tan()),
            ("asin", Scalar::asin, |x| x.asin()),
            ("acos", Scalar::acos, |x| x.acos()),
            ("atan", Scalar::atan, |x| x.atan()),
            ("sinh", Scalar::sinh, |x| x.sinh()),
            ("cosh", Scalar::cosh, |x| x.cosh()),
            ("tanh", Scalar::tanh, |x| x.tanh()),
            ("exp", Scalar::exp, |x| x.exp()),
            ("ln", Scalar::ln, |x| x.ln()),
            ("log10", Scalar::log10, |x| x.log10()),
            ("sqrt", Arithmetic::sqrt, |x| x.sqrt()),
            ("powi", |x| x.powi(-3), |x| x.powi(-3)),
            ("powf", |x| x.powf(x * 2.0), |x| (x * 2.0 * x.ln()).exp()),
            ("atan2", |x| x.atan2(x * x + 0.5), |x| x.atan2(x * x + 0.5)),
            ("quotient", |x| (x - x * 3.0) / (-x * x + 5.0), |x| (x - x * 3.0) / (-x * x + 5.0)),
        ];
        for (name, ours, oracle) in cases {
            for value in [0.15, 0.4, 0.9] {
                let (ours, oracle) = (ours(Dual { value, partial: -1.7 }), oracle(Dual64::new(value, -1.7)));
                assert!((ours.value - oracle.re).abs() <= 1e-14 * oracle.re.abs().max(1.0), "{name}");
                assert!((ours.partial - oracle.eps).abs() <= 1e-13 * oracle.eps.abs().max(1.0), "{name}");
                assert!(ours.partial != 0.0, "{name}");
            }
        }
        let length = Dual { value: 3.0, partial: 1.0 }.hypot(Dual { value: 4.0, partial: 2.0 });
        assert_eq!((length.value, length.partial), (5.0, 2.2));
    }

    #[test]
    fn what_does_not_depend_on_the_parameter_has_no_derivative_at_a_vertical_tangent() {
        for root in [Dual::ZERO.sqrt(), Dual::ONE.asin(), Dual::ZERO.powf(Dual::fixed(0.5))] {
            assert_eq!(root.partial, 0.0);
        }
    }
}

//! Formulas written once: for `f64`, for recording numbers, and for numbers with a round-off bound.

use std::ops::{Add, Div, Mul, Neg, Sub};

use hardpoint_tape::{Call, Number};

pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    fn constant(x: f64) -> Self;
    fn times_plus(self, factor: Self, addend: Self) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    fn round(self) -> Self;
    fn larger(self, o: Self) -> Self;
    fn call(self, function: Call, o: Self) -> Self;
}

impl Real for f64 {
    fn constant(x: f64) -> Self {
        x
    }
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    fn abs(self) -> Self {
        f64::abs(self)
    }
    fn round(self) -> Self {
        self.round_ties_even()
    }
    fn larger(self, o: Self) -> Self {
        if self.is_nan() || o.is_nan() { f64::NAN } else { self.max(o) }
    }
    fn call(self, function: Call, o: Self) -> Self {
        match function {
            Call::Tan => self.tan(),
            Call::Asin => self.asin(),
            Call::Acos => self.acos(),
            Call::Atan => self.atan(),
            Call::Sinh => self.sinh(),
            Call::Cosh => self.cosh(),
            Call::Tanh => self.tanh(),
            Call::Exp => self.exp(),
            Call::Ln => self.ln(),
            Call::Atan2 => self.atan2(o),
            Call::Pow => self.powf(o),
        }
    }
}

impl Real for Number {
    fn constant(x: f64) -> Self {
        Number::constant(x)
    }
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        Number::times_plus(self, factor, addend)
    }
    fn sqrt(self) -> Self {
        Number::sqrt(self)
    }
    fn abs(self) -> Self {
        Number::abs(self)
    }
    fn round(self) -> Self {
        Number::round(self)
    }
    fn larger(self, o: Self) -> Self {
        Number::larger(self, o)
    }
    fn call(self, function: Call, o: Self) -> Self {
        match function {
            Call::Atan2 => self.atan2(o),
            Call::Pow => self.powf(o),
            _ => Number::call(self, function),
        }
    }
}

/// Number with a bound of its round-off error for any order of rounding; infinite if there is no bound.
#[derive(Clone, Copy, Debug)]
pub struct BoundedNumber {
    pub x: f64,
    pub error: f64,
}

impl BoundedNumber {
    /// Rounded once or not at all, an error that comes from the operands added.
    fn rounded(x: f64, error: f64) -> Self {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        Self { x, error: 1.01 * (error + f64::EPSILON * x.abs()) + 1e-300 }
    }
}

impl Add for BoundedNumber {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::rounded(self.x + o.x, self.error + o.error)
    }
}
impl Sub for BoundedNumber {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::rounded(self.x - o.x, self.error + o.error)
    }
}
impl Mul for BoundedNumber {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let error = self.x.abs() * o.error + o.x.abs() * self.error + self.error * o.error;
        Self::rounded(self.x * o.x, error)
    }
}
impl Div for BoundedNumber {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let q = self.x / o.x;
        let room = o.x.abs() - o.error;
        let error = if room > 0.0 { (self.error + q.abs() * o.error) / room } else { f64::INFINITY };
        Self::rounded(q, error)
    }
}
impl Neg for BoundedNumber {
    type Output = Self;
    fn neg(self) -> Self {
        Self { x: -self.x, ..self }
    }
}
impl Real for BoundedNumber {
    fn constant(x: f64) -> Self {
        Self { x, error: 0.0 }
    }
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    fn sqrt(self) -> Self {
        let least = self.x - self.error;
        let error = if least > 0.0 { self.error / least.sqrt() } else { f64::INFINITY };
        Self::rounded(self.x.sqrt(), error)
    }
    fn abs(self) -> Self {
        Self { x: self.x.abs(), ..self }
    }
    fn round(self) -> Self {
        let x = self.x.round_ties_even();
        // Nearer to another integer, some other rounding may give that one.
        Self { x, error: if (self.x - x).abs() + self.error < 0.5 { 0.0 } else { f64::INFINITY } }
    }
    fn larger(self, o: Self) -> Self {
        Self { x: Real::larger(self.x, o.x), error: self.error.max(o.error) }
    }
    fn call(self, function: Call, o: Self) -> Self {
        // No bound is known, unless nothing has been rounded.
        let error = if self.error + o.error == 0.0 { 0.0 } else { f64::INFINITY };
        Self::rounded(self.x.call(function, o.x), error)
    }
}

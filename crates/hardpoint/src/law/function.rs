//! The functions of the language of laws, as data: named once, evaluated in any scalar.

use std::cmp::Ordering;

use super::jet::TimeJet;
use super::range::{Range, Stretch};
use super::scalar::Scalar;
use crate::space::{Function, Real};

/// A function of one quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unary {
    Neg,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Log10,
    Sqrt,
    Abs,
}

impl Unary {
    pub(super) fn apply<S: Scalar>(self, x: TimeJet<S>) -> TimeJet<S> {
        match self {
            Self::Neg => -x,
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tan => x.tan(),
            Self::Asin => x.asin(),
            Self::Acos => x.acos(),
            Self::Atan => x.atan(),
            Self::Sinh => x.sinh(),
            Self::Cosh => x.cosh(),
            Self::Tanh => x.tanh(),
            Self::Exp => x.exp(),
            Self::Ln => x.ln(),
            Self::Log10 => x.log10(),
            Self::Sqrt => x.sqrt(),
            Self::Abs => x.abs(),
        }
    }

    /// The same over a stretch of time.
    pub(super) fn over_stretch(self, x: Stretch) -> Stretch {
        match self {
            Self::Neg => -x,
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tan => x.tan(),
            Self::Asin => x.asin(),
            Self::Acos => x.acos(),
            Self::Atan => x.atan(),
            Self::Sinh => x.sinh(),
            Self::Cosh => x.cosh(),
            Self::Tanh => x.tanh(),
            Self::Exp => x.exp(),
            Self::Ln => x.ln(),
            Self::Log10 => x.log10(),
            Self::Sqrt => x.sqrt(),
            Self::Abs => x.abs(),
        }
    }

    /// The same over any scalar that is no function of the time.
    pub(super) fn over<R: Real>(self, x: R) -> R {
        match self {
            Self::Neg => -x,
            Self::Sin => x.sin_cos().0,
            Self::Cos => x.sin_cos().1,
            Self::Tan => x.map(Function::Tan),
            Self::Asin => x.map(Function::Asin),
            Self::Acos => x.map(Function::Acos),
            Self::Atan => x.map(Function::Atan),
            Self::Sinh => x.map(Function::Sinh),
            Self::Cosh => x.map(Function::Cosh),
            Self::Tanh => x.map(Function::Tanh),
            Self::Exp => x.map(Function::Exp),
            Self::Ln => x.map(Function::Ln),
            Self::Log10 => x.map(Function::Ln) / x.like(std::f64::consts::LN_10),
            Self::Sqrt => x.sqrt(),
            Self::Abs => x.abs(),
        }
    }
}

/// A function of two quantities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Atan2,
    Pow,
    Hypot,
    Min,
    Max,
}

impl Binary {
    pub(super) fn apply<S: Scalar>(self, x: TimeJet<S>, y: TimeJet<S>) -> TimeJet<S> {
        match self {
            Self::Add => x + y,
            Self::Sub => x - y,
            Self::Mul => x * y,
            Self::Div => x / y,
            Self::Atan2 => x.atan2(y),
            Self::Pow => x.pow(y),
            Self::Hypot => x.hypot(y),
            Self::Min => x.min(y),
            Self::Max => x.max(y),
        }
    }

    /// The same over a stretch of time.
    pub(super) fn over_stretch(self, x: Stretch, y: Stretch) -> Stretch {
        match self {
            Self::Add => x + y,
            Self::Sub => x - y,
            Self::Mul => x * y,
            Self::Div => x / y,
            Self::Atan2 => x.atan2(y),
            Self::Pow => x.pow(y),
            Self::Hypot => x.hypot(y),
            Self::Min => x.min(y),
            Self::Max => x.max(y),
        }
    }

    /// The same over any scalar that is no function of the time.
    pub(super) fn over<R: Real>(self, x: R, y: R) -> R {
        match self {
            Self::Add => x + y,
            Self::Sub => x - y,
            Self::Mul => x * y,
            Self::Div => x / y,
            Self::Atan2 => x.atan2(y),
            // Of a positive base: with any other, an exponent that varies leaves the real numbers.
            Self::Pow => (y * x.map(Function::Ln)).map(Function::Exp),
            Self::Hypot => (x * x + y * y).sqrt(),
            Self::Min => x.select(y, |k| x.lane(k) <= y.lane(k) || x.lane(k).is_nan()),
            Self::Max => x.select(y, |k| x.lane(k) >= y.lane(k) || x.lane(k).is_nan()),
        }
    }
}

/// A comparison of two values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Comparison {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

impl Comparison {
    /// Whether `a` compares with `b` in this way; `None` if either is not a number.
    pub(super) fn holds(self, a: f64, b: f64) -> Option<bool> {
        let order = a.partial_cmp(&b)?;
        Some(match self {
            Self::Less => order == Ordering::Less,
            Self::LessOrEqual => order != Ordering::Greater,
            Self::Greater => order == Ordering::Greater,
            Self::GreaterOrEqual => order != Ordering::Less,
        })
    }
    /// Whether it holds for all numbers of two ranges, or for none; `None` if that depends.
    pub(super) fn holds_between(self, a: Range, b: Range) -> Option<bool> {
        let corners = [(a.low, b.low), (a.low, b.high), (a.high, b.low), (a.high, b.high)];
        let first = self.holds(a.low, b.high)?;
        corners.iter().all(|&(a, b)| self.holds(a, b) == Some(first)).then_some(first)
    }
}

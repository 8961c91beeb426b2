//! What every kind of law offers; one file each.

use std::fmt;

use super::formula::Formula;
use super::harmonic::Harmonic;
use super::jumps::Break;
use super::parameter::{Parameter, ParameterKind, Seed};
use super::polynomial::Polynomial;
use super::range::Stretch;
use super::sequence::Sequence;
use super::smooth_step::SmoothStep;
use super::speed::ConstantSpeed;
use super::table::Spline;
use crate::number::{Jet, Real};

/// A kind of law.
///
/// The time is given as a jet. Where it runs backwards (its derivative is -1) a law takes the side that is active just
/// *before* the instant, so that one-sided limits need no code of their own.
pub(super) trait Shape: fmt::Display {
    /// f at a time, and its derivatives; with the derivative by one parameter if there is a seed.
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N>;

    /// All parameters, as written.
    fn parameters(&self) -> Vec<Parameter>;

    /// The number of parameters.
    fn parameter_count(&self) -> usize;

    /// What a parameter measures; equal to what [`parameters`](Self::parameters) says, without the list.
    fn parameter_kind(&self, parameter: usize) -> ParameterKind;

    /// Changes the value of a parameter, as written.
    fn set(&mut self, parameter: usize, value: f64);

    /// Bounds of f and of its rate from one time to another, both included; unbounded where it is undefined, or jumps, anywhere
    /// between them.
    fn over(&self, from: f64, to: f64) -> Stretch;

    /// Appends where the value or the first two derivatives may jump between `from` and `to`.
    fn find_breaks(&self, _from: f64, _to: f64, _breaks: &mut Vec<Break>) {}
}

/// The kinds there are.
#[derive(Clone, PartialEq)]
pub(super) enum Kind {
    Formula(Formula),
    Harmonic(Harmonic),
    ConstantSpeed(ConstantSpeed),
    Polynomial(Polynomial),
    SmoothStep(SmoothStep),
    Spline(Spline),
    Sequence(Sequence),
}

/// The same expression for whichever kind it is.
macro_rules! for_kind {
    ($kind:expr, $shape:ident => $body:expr) => {
        match $kind {
            Kind::Formula($shape) => $body,
            Kind::Harmonic($shape) => $body,
            Kind::ConstantSpeed($shape) => $body,
            Kind::Polynomial($shape) => $body,
            Kind::SmoothStep($shape) => $body,
            Kind::Spline($shape) => $body,
            Kind::Sequence($shape) => $body,
        }
    };
}

impl Shape for Kind {
    #[inline(always)]
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
        for_kind!(self, shape => shape.at(time, seed))
    }

    fn parameters(&self) -> Vec<Parameter> {
        for_kind!(self, shape => shape.parameters())
    }

    fn parameter_count(&self) -> usize {
        for_kind!(self, shape => shape.parameter_count())
    }

    fn parameter_kind(&self, parameter: usize) -> ParameterKind {
        for_kind!(self, shape => shape.parameter_kind(parameter))
    }

    fn set(&mut self, parameter: usize, value: f64) {
        for_kind!(self, shape => shape.set(parameter, value));
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        for_kind!(self, shape => shape.over(from, to))
    }

    fn find_breaks(&self, from: f64, to: f64, breaks: &mut Vec<Break>) {
        for_kind!(self, shape => shape.find_breaks(from, to, breaks));
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for_kind!(self, shape => shape.fmt(f))
    }
}

/// A sum as one writes it: signs between the terms, no term that is zero, `0` if none is left.
pub(super) fn write_sum(f: &mut fmt::Formatter<'_>, terms: &[(f64, &str)]) -> fmt::Result {
    let mut is_first = true;
    for &(factor, of) in terms.iter().filter(|(factor, _)| *factor != 0.0) {
        let sign = match (is_first, factor < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        let size = factor.abs();
        match of {
            "" => write!(f, "{sign}{size}")?,
            _ if size == 1.0 => write!(f, "{sign}{of}")?,
            _ => write!(f, "{sign}{size}*{of}")?,
        }
        is_first = false;
    }
    if is_first { f.write_str("0") } else { Ok(()) }
}

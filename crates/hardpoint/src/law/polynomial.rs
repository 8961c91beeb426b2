//! The law that is a polynomial of the time.

use std::fmt;

use super::error::{LawError, check_finite};
use super::jet::TimeJet;
use super::kind::{Shape, write_sum};
use super::lanes::Lanes;
use super::parameter::{Parameter, ParameterKind, Seed, parameter, seeded};
use super::range::Stretch;
use super::scalar::{Arithmetic, Scalar};
use crate::space::Real;

/// c0 + c1 t + c2 t² + ..., with the coefficients for parameters.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Polynomial {
    coefficients: Vec<f64>,
}

impl Polynomial {
    pub(super) fn new(coefficients: &[f64]) -> Result<Self, LawError> {
        if coefficients.is_empty() {
            return Err(LawError::new(
                "a polynomial has no coefficients",
                "give at least the constant one, c0",
            ));
        }
        check_finite(coefficients.iter().map(|&value| ("coefficient", value)))?;
        Ok(Self { coefficients: coefficients.to_vec() })
    }
}

impl Shape for Polynomial {
    fn at<S: Scalar>(&self, time: TimeJet<S>, seed: Option<Seed>) -> TimeJet<S> {
        let coefficients = self.coefficients.iter().enumerate();
        sum_of_powers(coefficients.map(|(k, &value)| seeded(value, k, seed)), time)
    }

    #[inline(always)]
    fn at_lanes<R: Real>(&self, times: Lanes<R>) -> TimeJet<Lanes<R>> {
        sum_of_powers_of_time(&self.coefficients, times, |coefficient| times.like(*coefficient))
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        Stretch::of_polynomial(&self.coefficients, from, to)
    }

    fn parameters(&self) -> Vec<Parameter> {
        let coefficients = self.coefficients.iter().enumerate();
        coefficients.map(|(k, &value)| parameter(format!("c{k}"), value, self.parameter_kind(k))).collect()
    }

    fn parameter_count(&self) -> usize {
        self.coefficients.len()
    }

    fn parameter_kind(&self, parameter: usize) -> ParameterKind {
        match parameter {
            0 => ParameterKind::Value,
            order => ParameterKind::ValueRate(order as u32),
        }
    }

    fn set(&mut self, parameter: usize, value: f64) {
        self.coefficients[parameter] = value;
    }
}

/// c0 + c1 x + c2 x² + ..., by Horner's rule.
#[inline(always)]
pub(super) fn sum_of_powers<S: Arithmetic>(
    coefficients: impl DoubleEndedIterator<Item = S>,
    x: TimeJet<S>,
) -> TimeJet<S> {
    let mut sum = TimeJet::constant(x.value().like(0.0));
    for coefficient in coefficients.rev() {
        sum = (sum * x).plus(coefficient);
    }
    sum
}

/// c0 + c1 t + c2 t² + ... and its derivatives, by Horner's rule: what [`sum_of_powers`] is of the time itself, without the
/// products with the ones and zeros that are the time's derivatives. The coefficients are what `number` makes of `from`.
#[inline(always)]
pub(super) fn sum_of_powers_of_time<S: Arithmetic, C>(
    from: &[C],
    t: S,
    number: impl Fn(&C) -> S,
) -> TimeJet<S> {
    // f <- f t + c, differentiated: d <- d t + f, dd <- dd t + 2 d, ddd <- ddd t + 3 dd
    let [mut f, mut d, mut dd, mut ddd] = [t.like(0.0); 4];
    for coefficient in from.iter().rev() {
        ddd = ddd * t + dd * 3.0;
        dd = dd * t + d * 2.0;
        d = d * t + f;
        f = f * t + number(coefficient);
    }
    TimeJet::from_derivatives([f, d, dd, ddd])
}

/// The expression that is this law.
impl fmt::Display for Polynomial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let power = |k: usize| match k {
            0 => String::new(),
            1 => "t".to_owned(),
            _ => format!("t^{k}"),
        };
        let powers: Vec<String> = (0..self.coefficients.len()).map(power).collect();
        let terms: Vec<_> =
            self.coefficients.iter().copied().zip(powers.iter().map(String::as_str)).collect();
        write_sum(f, &terms)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_needs_finite_coefficients() {
        let error = Polynomial::new(&[]).unwrap_err();
        assert_eq!(error.to_string(), "a polynomial has no coefficients");
        assert_eq!(error.help.as_deref(), Some("give at least the constant one, c0"));
        let error = Polynomial::new(&[1.0, f64::INFINITY]).unwrap_err();
        assert_eq!(error.to_string(), "the coefficient of a law must be a finite number, not inf");
    }
}

//! The law that is a polynomial of the time.

use std::fmt;

use super::error::{LawError, check_finite};
use super::jet::TimeJet;
use super::kind::{Shape, write_sum};
use super::parameter::{Parameter, ParameterKind, Seed, parameter, seeded};
use super::scalar::Scalar;

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
pub(super) fn sum_of_powers<S: Scalar>(
    coefficients: impl DoubleEndedIterator<Item = S>,
    x: TimeJet<S>,
) -> TimeJet<S> {
    coefficients.rev().fold(TimeJet::constant(S::ZERO), |sum, coefficient| (sum * x).plus(coefficient))
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

//! Law given by a polynomial in time.

use std::fmt;

use crate::expression::Stretch;
use crate::number::{Interval, Jet, Real};

use super::Law;
use super::error::{LawError, check_finite};
use super::kind::{LawKind, write_sum};
use super::parameter::{Parameter, ParameterKind, Seed, parameter, seeded};

/// c0 + c1 t + c2 t² + ..., with the coefficients as parameters.
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
        let polynomial = Self { coefficients: coefficients.to_vec() };
        check_finite(&polynomial)?;
        Ok(polynomial)
    }
}

impl Law {
    /// Creates the polynomial c0 + c1 t + c2 t² + ..., t in s. Coefficient k is in driver unit per s to the k, and is
    /// the parameter `ck`.
    ///
    /// ```
    /// use hardpoint::law::Law;
    ///
    /// let law = Law::polynomial(&[5.0, 0.0, 0.25])?;
    /// assert_eq!(law.at(2.0).derivatives(), [6.0, 1.0, 0.5, 0.0]);
    /// assert_eq!(law.to_string(), "5 + 0.25*t^2");
    /// # Ok::<(), hardpoint::law::LawError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if there is no coefficient, or one is not finite.
    pub fn polynomial(coefficients: &[f64]) -> Result<Self, LawError> {
        Polynomial::new(coefficients).map(Self::of)
    }
}

impl LawKind for Polynomial {
    #[inline(always)]
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
        sum_of_powers(time, self.coefficients.len(), |k| seeded(self.coefficients[k], k, seed))
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        Stretch::of_polynomial(&self.coefficients, from, to)
    }

    fn enclosure(&self, over: Interval) -> Jet<Interval, 4> {
        // Smooth everywhere.
        self.at(Jet::time(over), None)
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

/// c0 + c1 x + c2 x² + ... with this number of terms, by Horner's rule.
#[inline(always)]
pub(super) fn sum_of_powers<T: Real, const N: usize>(
    of: Jet<T, N>,
    terms: usize,
    coefficient: impl Fn(usize) -> T,
) -> Jet<T, N> {
    of.compose(polynomial(of.value(), terms, coefficient))
}

/// c0 + c1 x + c2 x² + ... with this number of terms, and its first three derivatives.
#[inline(always)]
pub(crate) fn polynomial<T: Real>(x: T, terms: usize, coefficient: impl Fn(usize) -> T) -> [T; 4] {
    // f <- f x + c, differentiated with respect to x: d <- d x + f, dd <- dd x + 2 d, ddd <- ddd x + 3 dd
    let [mut f, mut d, mut dd, mut ddd] = [T::zero(); 4];
    for k in (0..terms).rev() {
        ddd = ddd * x + dd * 3.0;
        dd = dd * x + d * 2.0;
        d = d * x + f;
        f = f * x + coefficient(k);
    }
    [f, d, dd, ddd]
}

/// Writes the law as an expression.
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
        assert_eq!(error.to_string(), "the `c1` of a law must be a finite number, not inf");
    }
}

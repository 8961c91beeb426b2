//! Law that changes smoothly from one value to another.

use std::fmt;

use crate::expression::Stretch;
use crate::number::{Interval, Jet, Real};

use super::Law;
use super::breaks::Break;
use super::error::{LawError, check_finite};
use super::kind::{LawKind, in_pieces, is_after, is_before, one_way, parameters};
use super::parameter::{Parameter, ParameterKind, Seed, parameter, seeded};
use super::polynomial::sum_of_powers;

/// A law that is `from` until `start`, `to` after `end`, and between them the polynomial from + (to - from) s(u) with u
/// = (t - start) / (end - start).
///
/// | degree | s(u) | at both ends |
/// |---|---|---|
/// | 3 | 3u² - 2u³ | the acceleration jumps by 6 (to - from) / (end - start)² |
/// | 5 | 10u³ - 15u⁴ + 6u⁵ | the acceleration is continuous, the jerk jumps |
/// | 7 | 35u⁴ - 84u⁵ + 70u⁶ - 20u⁷ | the jerk is continuous too |
///
/// Parameters, in this order: `from`, `to`, `start`, `end`. If `start` is changed to a time not before `end`, the law
/// has no finite value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothStep {
    /// Initial value, in the driver's unit.
    pub from: f64,
    /// Final value, in the driver's unit.
    pub to: f64,
    /// Start time, s.
    pub start: f64,
    /// End time, s; after `start`.
    pub end: f64,
    /// Degree of the polynomial: 3, 5 or 7.
    pub degree: u32,
}

impl SmoothStep {
    /// Default degree: the lowest with a continuous acceleration.
    pub const USUAL_DEGREE: u32 = 5;

    pub(super) fn check(&self) -> Result<(), LawError> {
        let Self { start, end, degree, .. } = *self;
        check_finite(self)?;
        if start >= end {
            let message =
                format!("a smooth step must start before it ends, but start = {start} s and end = {end} s");
            return Err(LawError::new(message, "swap `from` and `to` if the other direction is meant"));
        }
        if ![3, 5, 7].contains(&degree) {
            let message = format!("a smooth step has degree 3, 5 or 7, not {degree}");
            let help = "with 3 the acceleration jumps at both ends, with 5 the jerk, with 7 neither";
            return Err(LawError::new(message, help));
        }
        Ok(())
    }

    /// Normalised rise s(u).
    #[inline(always)]
    fn rise<T: Real, const N: usize>(&self, u: Jet<T, N>) -> Jet<T, N> {
        let (lowest, coefficients): (i32, &[f64]) = match self.degree {
            3 => (2, &[3.0, -2.0]),
            5 => (3, &[10.0, -15.0, 6.0]),
            _ => (4, &[35.0, -84.0, 70.0, -20.0]),
        };
        // s(u) = u^lowest (c0 + c1 u + ...)
        u.powi(lowest) * sum_of_powers(u, coefficients.len(), |k| T::constant(coefficients[k]))
    }
}

impl Law {
    /// Creates a law that changes smoothly from one value to another; see [`SmoothStep`].
    ///
    /// ```
    /// use hardpoint::law::{Law, SmoothStep};
    ///
    /// let law = Law::smooth_step(SmoothStep { from: 1.0, to: 5.0, start: 0.0, end: 2.0, degree: 5 })?;
    /// assert_eq!([0.0, 1.0, 7.0].map(|t| law.at(t).value()), [1.0, 3.0, 5.0]);
    /// assert_eq!(law.at(1.0).d(), 3.75); // 15/8 of the mean speed
    /// # Ok::<(), hardpoint::law::LawError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if a number is not finite, the end is not after the start, or the degree is not 3, 5 or 7.
    pub fn smooth_step(law: SmoothStep) -> Result<Self, LawError> {
        law.check()?;
        Ok(Self::of(law))
    }
}

impl LawKind for SmoothStep {
    #[inline(always)]
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
        let number = |value: f64, parameter: usize| seeded(value, parameter, seed);
        let [from, to] = [number(self.from, 0), number(self.to, 1)];
        let [start, end] = [number(self.start, 2), number(self.end, 3)];
        if !(self.start < self.end) {
            return Jet::undefined();
        }
        // NaN is neither before nor after, and propagates through the polynomial.
        if is_before(&time, self.start) {
            return Jet::constant(from);
        }
        if is_after(&time, self.end) {
            return Jet::constant(to);
        }
        // f = from + (to - from) s(u),    u = (t - start) / (end - start)
        let u = time.plus(-start).times(T::one() / (end - start));
        self.rise(u).times(to - from).plus(from)
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        one_way(self, 0.5 * (self.start + self.end), from, to)
    }

    fn enclosure(&self, over: Interval) -> Jet<Interval, 4> {
        let [from, to, start, end] = [self.from, self.to, self.start, self.end].map(Interval::constant);
        if !(self.start < self.end) {
            return Jet([Interval::ENTIRE; 4]);
        }
        in_pieces(over, &[self.start, self.end], |k, part| match k {
            0 => Jet::constant(from),
            1 => {
                let u = Jet::time(part).plus(-start).times(Interval::one() / (end - start));
                self.rise(u).times(to - from).plus(from)
            }
            _ => Jet::constant(to),
        })
    }

    parameters! {
        from: ParameterKind::Value,
        to: ParameterKind::Value,
        start: ParameterKind::Time,
        end: ParameterKind::Time,
    }

    fn find_breaks(&self, from: f64, to: f64, breaks: &mut Vec<Break>) {
        let ends = [self.start, self.end].into_iter().filter(|t| (from..=to).contains(t));
        breaks.extend(ends.map(Break::exactly));
    }
}

impl fmt::Display for SmoothStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { from, to, start, end, degree } = self;
        write!(f, "smooth step of degree {degree} from {from} at {start} s to {to} at {end} s")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_needs_finite_numbers_a_duration_and_a_known_degree() {
        let good = SmoothStep { from: 1.0, to: 0.0, start: 0.0, end: 2.0, degree: SmoothStep::USUAL_DEGREE };
        assert_eq!(good.check(), Ok(()));
        let cases = [
            (
                SmoothStep { start: 2.0, ..good },
                "a smooth step must start before it ends, but start = 2 s and end = 2 s",
                Some("swap `from` and `to` if the other direction is meant"),
            ),
            (
                SmoothStep { degree: 4, ..good },
                "a smooth step has degree 3, 5 or 7, not 4",
                Some("with 3 the acceleration jumps at both ends, with 5 the jerk, with 7 neither"),
            ),
            (SmoothStep { to: f64::NAN, ..good }, "the `to` of a law must be a finite number, not NaN", None),
        ];
        for (step, message, help) in cases {
            let error = step.check().unwrap_err();
            assert_eq!((error.message.as_str(), error.help.as_deref()), (message, help));
        }
    }

    #[test]
    fn the_degree_determines_the_number_of_derivatives_that_vanish_at_the_ends() {
        for (degree, vanishing) in [(3, 1), (5, 2), (7, 3)] {
            let step = SmoothStep { from: 1.0, to: 4.0, start: 1.0, end: 3.0, degree };
            for (time, value) in [(Jet::<f64>::time(1.0), 1.0), (-Jet::<f64>::time(-3.0), 4.0)] {
                let inside = step.at(time, None).derivatives();
                assert_eq!(inside[0], value, "{degree}");
                assert!(
                    inside[1..=vanishing].iter().all(|derivative| derivative.abs() < 1e-12),
                    "{inside:?}"
                );
                assert!(inside[vanishing + 1..].iter().all(|derivative| *derivative != 0.0), "{inside:?}");
            }
            assert_eq!(step.at(Jet::<f64>::time(2.0), None).value(), 2.5, "halfway");
        }
    }
}

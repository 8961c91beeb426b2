//! Law of constant speed.

use std::fmt;

use crate::expression::{Range, Stretch};
use crate::number::{Interval, Jet, Real};

use super::Law;
use super::error::{LawError, check_finite};
use super::kind::{LawKind, parameters, write_sum};
use super::parameter::{Parameter, ParameterKind, Seed, parameter, seeded};

/// A law of constant speed: offset + speed t, t in s.
///
/// Parameters, in this order: `speed`, `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantSpeed {
    /// Speed, in the driver's unit per s.
    pub speed: f64,
    /// Value at t = 0, in the driver's unit.
    pub offset: f64,
}

impl Law {
    /// Creates a law of constant speed: offset + speed t.
    ///
    /// ```
    /// use hardpoint::law::{ConstantSpeed, Law};
    ///
    /// let law = Law::constant_speed(ConstantSpeed { speed: 3.0, offset: 1.0 })?;
    /// assert_eq!(law.at(2.0).value(), 7.0);
    /// assert_eq!(law.to_string(), "1 + 3*t");
    /// # Ok::<(), hardpoint::law::LawError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if a number is not finite.
    pub fn constant_speed(law: ConstantSpeed) -> Result<Self, LawError> {
        check_finite(&law)?;
        Ok(Self::of(law))
    }
}

impl LawKind for ConstantSpeed {
    #[inline(always)]
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
        let number = |value: f64, parameter: usize| seeded(value, parameter, seed);
        // f = offset + speed t
        time.times(number(self.speed, 0)).plus(number(self.offset, 1))
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        let at = |t: f64| self.speed * t + self.offset;
        Stretch { value: Range::between(at(from), at(to)), rate: Range::exactly(self.speed) }
    }

    fn enclosure(&self, over: Interval) -> Jet<Interval, 4> {
        // Smooth everywhere.
        self.at(Jet::time(over), None)
    }

    parameters! {
        speed: ParameterKind::ValueRate(1), offset: ParameterKind::Value
    }
}

/// Writes the law as an expression.
impl fmt::Display for ConstantSpeed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_sum(f, &[(self.offset, ""), (self.speed, "t")])
    }
}

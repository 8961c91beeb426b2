//! The law of constant speed.

use std::fmt;

use super::error::{LawError, check_finite};
use super::kind::{Shape, write_sum};
use super::parameter::{Parameter, ParameterKind, Seed, parameter, seeded};
use super::range::{Range, Stretch};
use crate::number::{Jet, Real};

/// A law of constant speed: offset + speed t.
///
/// Its parameters, in this order: `speed`, `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantSpeed {
    /// The speed, in the driver's unit per s.
    pub speed: f64,
    /// The value at t = 0, in the driver's unit.
    pub offset: f64,
}

impl ConstantSpeed {
    pub(super) fn check(&self) -> Result<(), LawError> {
        check_finite([("speed", self.speed), ("offset", self.offset)])
    }
}

impl Shape for ConstantSpeed {
    #[inline(always)]
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
        let number = |value: f64, parameter: usize| seeded(value, parameter, seed);
        time.times(number(self.speed, 0)).plus(number(self.offset, 1))
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        let at = |t: f64| self.speed * t + self.offset;
        Stretch { value: Range::between(at(from), at(to)), rate: Range::exactly(self.speed) }
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![
            parameter("speed", self.speed, self.parameter_kind(0)),
            parameter("offset", self.offset, self.parameter_kind(1)),
        ]
    }

    fn parameter_count(&self) -> usize {
        2
    }

    fn parameter_kind(&self, parameter: usize) -> ParameterKind {
        if parameter == 0 { ParameterKind::ValueRate(1) } else { ParameterKind::Value }
    }

    fn set(&mut self, parameter: usize, value: f64) {
        *if parameter == 0 { &mut self.speed } else { &mut self.offset } = value;
    }
}

/// The expression that is this law.
impl fmt::Display for ConstantSpeed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_sum(f, &[(self.offset, ""), (self.speed, "t")])
    }
}

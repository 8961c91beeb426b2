//! The harmonic law.

use std::f64::consts::TAU;
use std::fmt;

use super::error::{LawError, check_finite};
use super::kind::{Shape, write_sum};
use super::parameter::{Parameter, ParameterKind, Seed, parameter, seeded};
use super::range::Stretch;
use super::term::Term;
use crate::number::{Function, Jet, Real};

/// A harmonic law: offset + amplitude sin(2π frequency t + phase).
///
/// Its parameters, in this order: `amplitude`, `frequency`, `phase`, `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// The amplitude, in the driver's unit.
    pub amplitude: f64,
    /// The frequency, in Hz.
    pub frequency: f64,
    /// The phase, in radians.
    pub phase: f64,
    /// The mean value, in the driver's unit.
    pub offset: f64,
}

impl Harmonic {
    pub(super) fn check(&self) -> Result<(), LawError> {
        let Self { amplitude, frequency, phase, offset } = *self;
        check_finite([
            ("amplitude", amplitude),
            ("frequency", frequency),
            ("phase", phase),
            ("offset", offset),
        ])
    }
}

impl Shape for Harmonic {
    #[inline(always)]
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
        let number = |value: f64, parameter: usize| seeded(value, parameter, seed);
        let turn = time.times(number(self.frequency, 1) * TAU).plus(number(self.phase, 2));
        turn.map(Function::Sin).times(number(self.amplitude, 0)).plus(number(self.offset, 3))
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        let of = Stretch::constant;
        (Stretch::time(from, to) * of(TAU * self.frequency) + of(self.phase)).function(Function::Sin)
            * of(self.amplitude)
            + of(self.offset)
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![
            parameter("amplitude", self.amplitude, ParameterKind::Value),
            parameter("frequency", self.frequency, ParameterKind::Frequency),
            parameter("phase", self.phase, ParameterKind::Angle),
            parameter("offset", self.offset, ParameterKind::Value),
        ]
    }

    fn parameter_count(&self) -> usize {
        4
    }

    fn parameter_kind(&self, parameter: usize) -> ParameterKind {
        match parameter {
            1 => ParameterKind::Frequency,
            2 => ParameterKind::Angle,
            _ => ParameterKind::Value,
        }
    }

    fn set(&mut self, parameter: usize, value: f64) {
        *match parameter {
            0 => &mut self.amplitude,
            1 => &mut self.frequency,
            2 => &mut self.phase,
            _ => &mut self.offset,
        } = value;
    }
}

/// The expression that is this law.
impl fmt::Display for Harmonic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let phase = match self.phase {
            0.0 => String::new(),
            phase if phase < 0.0 => format!(" - {}", -phase),
            phase => format!(" + {phase}"),
        };
        let sine = format!("sin(2*pi*{}*t{phase})", self.frequency);
        write_sum(f, &[(self.offset, ""), (self.amplitude, &sine)])
    }
}

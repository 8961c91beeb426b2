//! The harmonic law.

use std::f64::consts::TAU;
use std::fmt;

use super::error::{LawError, check_finite};
use super::jet::TimeJet;
use super::kind::{Shape, write_sum};
use super::lanes::Lanes;
use super::parameter::{Parameter, ParameterKind, Seed, parameter, seeded};
use super::range::Stretch;
use super::scalar::{Arithmetic, Scalar};
use crate::space::Real;

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
    fn at<S: Scalar>(&self, time: TimeJet<S>, seed: Option<Seed>) -> TimeJet<S> {
        let amplitude: S = seeded(self.amplitude, 0, seed);
        let frequency: S = seeded(self.frequency, 1, seed);
        let phase: S = seeded(self.phase, 2, seed);
        let offset: S = seeded(self.offset, 3, seed);
        curve(time, amplitude, frequency, phase, offset)
    }

    #[inline(always)]
    fn at_lanes<R: Real>(&self, times: Lanes<R>) -> TimeJet<Lanes<R>> {
        let [amplitude, frequency, phase, offset] = [self.amplitude, self.frequency, self.phase, self.offset]
            .map(
                #[inline(always)]
                |number| times.like(number),
            );
        curve(TimeJet::time(times), amplitude, frequency, phase, offset)
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        let of = Stretch::constant;
        (Stretch::time(from, to) * of(TAU * self.frequency) + of(self.phase)).sin() * of(self.amplitude)
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

/// offset + amplitude sin(2π frequency t + phase)
#[inline(always)]
fn curve<S: Arithmetic>(time: TimeJet<S>, amplitude: S, frequency: S, phase: S, offset: S) -> TimeJet<S> {
    time.times(frequency * TAU).plus(phase).sin().times(amplitude).plus(offset)
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

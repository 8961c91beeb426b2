//! Harmonic law.

use std::f64::consts::TAU;
use std::fmt;

use crate::expression::{ExpressionValue, Stretch};
use crate::number::{Function, Interval, Jet, Real};

use super::Law;
use super::error::{LawError, check_finite};
use super::kind::{LawKind, parameters, write_sum};
use super::parameter::{Parameter, ParameterKind, Seed, parameter, seeded};

/// A harmonic law: offset + amplitude sin(2π frequency t + phase), t in s.
///
/// Parameters, in this order: `amplitude`, `frequency`, `phase`, `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// Amplitude, in the driver's unit.
    pub amplitude: f64,
    /// Frequency, Hz.
    pub frequency: f64,
    /// Phase, rad.
    pub phase: f64,
    /// Mean value, in the driver's unit.
    pub offset: f64,
}

impl Law {
    /// Creates a harmonic law: offset + amplitude sin(2π frequency t + phase).
    ///
    /// ```
    /// use hardpoint::law::{Harmonic, Law};
    ///
    /// let law = Law::harmonic(Harmonic { amplitude: 25.0, frequency: 0.5, phase: 0.0, offset: 10.0 })?;
    /// assert_eq!(law.at(0.5).value(), 35.0); // a quarter of a period
    /// assert_eq!(law.to_string(), "10 + 25*sin(2*pi*0.5*t)");
    /// # Ok::<(), hardpoint::law::LawError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if a number is not finite.
    pub fn harmonic(law: Harmonic) -> Result<Self, LawError> {
        check_finite(&law)?;
        Ok(Self::of(law))
    }
}

impl LawKind for Harmonic {
    #[inline(always)]
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
        let number = |value: f64, parameter: usize| seeded(value, parameter, seed);
        // f = offset + amplitude sin(2 pi frequency t + phase), its rates by the chain rule of the jet
        let turn = time.times(number(self.frequency, 1) * TAU).plus(number(self.phase, 2));
        turn.map(Function::Sin).times(number(self.amplitude, 0)).plus(number(self.offset, 3))
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        let of = Stretch::constant;
        (Stretch::time(from, to) * of(TAU * self.frequency) + of(self.phase)).function(Function::Sin)
            * of(self.amplitude)
            + of(self.offset)
    }

    fn enclosure(&self, over: Interval) -> Jet<Interval, 4> {
        // Smooth everywhere.
        self.at(Jet::time(over), None)
    }

    parameters! {
        amplitude: ParameterKind::Value,
        frequency: ParameterKind::Frequency,
        phase: ParameterKind::Angle,
        offset: ParameterKind::Value,
    }
}

/// Writes the law as an expression.
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

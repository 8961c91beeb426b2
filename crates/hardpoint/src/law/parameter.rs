//! Parameters of laws.

use crate::number::Real;

/// A number in a law that can be varied, as a design variable is.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name, such as `amplitude`, `f[3]` or `piece[0].speed`.
    pub name: String,
    /// Value, in the unit given by [`kind`](Self::kind).
    pub value: f64,
    /// Kind of the parameter, and hence its unit.
    pub kind: ParameterKind,
}

/// Kind of a parameter of a law. `Value` and `ValueRate` are in the driver's unit and are scaled by
/// [`Law::scaled`](super::Law::scaled).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// A value of the driver, in the driver's unit.
    Value,
    /// A rate of the driver's value: driver unit per s to this power.
    ValueRate(u32),
    /// A plain number of an expression, in a unit that is not known.
    Number,
    /// A time or a duration, s.
    Time,
    /// A frequency, Hz.
    Frequency,
    /// An angle, rad.
    Angle,
}

impl ParameterKind {
    /// True if the parameter is in the driver's unit, so that a change of that unit changes its value.
    pub fn is_in_driver_unit(self) -> bool {
        matches!(self, Self::Value | Self::ValueRate(_))
    }
}

pub(super) fn parameter(name: impl Into<String>, value: f64, kind: ParameterKind) -> Parameter {
    Parameter { name: name.into(), value, kind }
}

/// Parameter with respect to which a law is differentiated, and the infinitesimal added to its value: zero, with a
/// derivative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seed<T> {
    pub parameter: usize,
    pub size: T,
}

/// Value of the parameter with this index, with a derivative if it is the varied one.
#[inline(always)]
pub(super) fn seeded<T: Real>(value: f64, parameter: usize, seed: Option<Seed<T>>) -> T {
    match seed {
        Some(seed) if seed.parameter == parameter => seed.size + value,
        _ => T::constant(value),
    }
}

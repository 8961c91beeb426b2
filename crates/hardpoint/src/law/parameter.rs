//! The numbers in a law that may be varied.

use crate::number::Real;

/// A number in a law that may be varied, as a design variable is.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name, such as `amplitude`, `f[3]` or `piece[0].speed`.
    pub name: String,
    /// Value in the unit that [`kind`](Self::kind) says.
    pub value: f64,
    /// Kind of the parameter, and hence its unit.
    pub kind: ParameterKind,
}

/// Kind of a law's parameter. The first two are in the driver's own unit and follow
/// [`Law::scaled`](super::Law::scaled).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// A value of the driver, in the driver's unit.
    Value,
    /// A rate of the driver's value: driver unit per s to this power.
    ValueRate(u32),
    /// A number of the author's own, in a unit that only the author knows.
    Number,
    /// An instant or a duration, in s.
    Time,
    /// A frequency, in Hz.
    Frequency,
    /// An angle, in radians.
    Angle,
}

impl ParameterKind {
    /// True if the parameter is measured in the driver's unit, so that a change of that unit changes its value.
    pub fn is_in_driver_unit(self) -> bool {
        matches!(self, Self::Value | Self::ValueRate(_))
    }
}

pub(super) fn parameter(name: impl Into<String>, value: f64, kind: ParameterKind) -> Parameter {
    Parameter { name: name.into(), value, kind }
}

/// The parameter by which derivatives are taken, and what to add to its number in the law: nothing, with a derivative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seed<T> {
    pub parameter: usize,
    pub size: T,
}

/// The number `value` of the parameter with this index, which carries a derivative if it is the one that is varied.
#[inline(always)]
pub(super) fn seeded<T: Real>(value: f64, parameter: usize, seed: Option<Seed<T>>) -> T {
    match seed {
        Some(seed) if seed.parameter == parameter => seed.size + value,
        _ => T::constant(value),
    }
}

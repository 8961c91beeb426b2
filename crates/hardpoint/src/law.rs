//! Laws of motion: prescribed values of drivers as functions of time, with exact time derivatives.
//!
//! Each kind of law has a constructor of [`Law`]. Expressions in `t` are created by [`Law::parse`], or with named
//! parameters by [`Law::parse_with`].
//!
//! [`crate::expression`] defines the language of expressions.
//!
//! Laws of all kinds are evaluated by [`Law::at`], have [parameters](Law::parameters) with respect to which they can be
//! [differentiated](Law::derivative), and report their [jumps](Law::jumps).
//!
//! Limitations: laws depend on time only. Corners of expressions without `abs`, `atan2`, `min`, `max`, `step` or `if`,
//! such as those of `asin(sin(t))` or `sqrt(t^2)`, are not among the [jumps](Law::jumps).

mod breaks;
mod error;
mod formula;
mod harmonic;
mod jumps;
mod kind;
mod parameter;
mod polynomial;
mod sequence;
mod smooth_step;
mod speed;
mod table;
mod trapezoid;

use std::fmt;

use breaks::Break;
pub use error::LawError;
pub use jumps::Jump;
use kind::{LawKind, kinds};
use parameter::Seed;
pub use parameter::{Parameter, ParameterKind};
pub(crate) use polynomial::polynomial;
pub use sequence::Piece;
pub use table::{SplineDegree, SplineEndRates, SplineEnds, Table};

use crate::expression::{self, ExpressionError, Range, Stretch};
use crate::number::{self, Dual, Interval, Jet, Real};
use crate::order::sort_by_number;

kinds! {
    formula: ExpressionLaw,
    harmonic: pub Harmonic,
    speed: pub ConstantSpeed,
    polynomial: Polynomial,
    smooth_step: pub SmoothStep,
    trapezoid: pub Trapezoid,
    table: Spline,
    sequence: Sequence,
}

/// The value of a law and its first three time derivatives at one instant.
///
/// ```
/// use hardpoint::law::TimeJet;
///
/// let t = TimeJet::time(3.0);
/// assert_eq!((t * t).derivatives(), [9.0, 6.0, 2.0, 0.0]);
/// ```
pub type TimeJet<T = f64> = Jet<T, 4>;

/// Law of motion of a driver, f(t), in the driver's unit, t in seconds.
///
/// Two laws are equal if they have the same text or numbers, the same scale and the same sense.
///
/// # Example
///
/// A cubic, whose derivatives at t = 2 s can be checked by hand:
///
/// ```
/// use hardpoint::law::Law;
///
/// let lift = Law::parse("5 + t^3/4")?;
/// let at = lift.at(2.0);
/// assert_eq!(at.value(), 7.0); // 5 + 8/4
/// assert_eq!(at.d(), 3.0); // 3 t²/4
/// assert_eq!(at.dd(), 3.0); // 6 t/4
/// assert_eq!(at.ddd(), 1.5); // 6/4
/// # Ok::<(), hardpoint::expression::ExpressionError>(())
/// ```
#[derive(Clone)]
pub struct Law {
    kind: AnyLaw,
    factor: f64,
    /// Value of the prescribed quantity in the design configuration, in the driver's unit, if the law counts from zero.
    design_value: Option<f64>,
    /// True if the change from the design configuration has the other sign.
    is_reversed: bool,
}

/// Name of the last parameter of a law that [counts from zero](Law::from_zero): the value of the prescribed quantity in
/// the design configuration.
const DESIGN_VALUE: &str = "as_drawn";

impl Law {
    /// Parses a law from `text`, in the unit that the text implies.
    ///
    /// # Errors
    ///
    /// Returns an error with its position and a correction if `text` is not an expression of the
    /// [language](crate::expression):
    ///
    /// ```
    /// use hardpoint::law::Law;
    ///
    /// let error = Law::parse("3*sinn(t)").unwrap_err();
    /// assert_eq!(error.span, 2..6);
    /// assert_eq!(error.message, "unknown name `sinn`");
    /// assert!(error.help.unwrap().starts_with("did you mean `sin`?"));
    /// ```
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        Self::parse_with(text, &[])
    }

    /// Parses a law from `text`, given the names and values of its parameters.
    ///
    /// ```
    /// use hardpoint::law::Law;
    ///
    /// let lift = Law::parse_with("amplitude*t^2", &[("amplitude", 25.0)])?;
    /// assert_eq!(lift.at(2.0).value(), 100.0);
    /// assert_eq!(lift.derivative(0, 2.0).value(), 4.0); // t²
    /// assert_eq!(lift.to_string(), "amplitude*t^2 with amplitude = 25");
    /// # Ok::<(), hardpoint::expression::ExpressionError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error as [`parse`](Self::parse) does; also if the name of a parameter is taken or invalid, its value
    /// is not finite, or it is not used. The span is then the whole text.
    pub fn parse_with(text: &str, parameters: &[(&str, f64)]) -> Result<Self, ExpressionError> {
        ExpressionLaw::parse(text, parameters).map(Self::of)
    }

    /// Names of the parameters in the text of a law, each once, in order of their first use.
    ///
    /// ```
    /// assert_eq!(hardpoint::law::Law::names("a*sin(w*t + a)"), ["a", "w"]);
    /// ```
    pub fn names(text: &str) -> Vec<&str> {
        expression::names(text)
    }

    /// Constant law, in the driver's unit.
    pub fn constant(value: f64) -> Self {
        Self::of(ExpressionLaw::constant(value))
    }

    fn of(kind: impl Into<AnyLaw>) -> Self {
        Self { kind: kind.into(), factor: 1.0, design_value: None, is_reversed: false }
    }

    /// This law times `factor`, for a change of unit. The text remains as written.
    ///
    /// ```
    /// use hardpoint::law::Law;
    ///
    /// let travel_mm = Law::parse("25*t")?;
    /// let travel = travel_mm.scaled(1e-3);
    /// assert_eq!(travel.at(2.0).value(), 0.05);
    /// assert_eq!(travel.to_string(), "25*t");
    /// # Ok::<(), hardpoint::expression::ExpressionError>(())
    /// ```
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.factor *= factor;
        self.design_value = self.design_value.map(|value| value * factor);
        self
    }

    /// This law for a quantity with the design value `design_value`, if the text gives the whole value: drivers
    /// prescribe the change from the design configuration. The design value becomes the last of the
    /// [parameters](Self::parameters).
    ///
    /// ```
    /// use hardpoint::law::Law;
    ///
    /// let length = Law::parse("0.5 + 0.1*t")?.from_zero(0.45);
    /// assert!((length.at(1.0).value() - 0.15).abs() < 1e-15);
    /// # Ok::<(), hardpoint::expression::ExpressionError>(())
    /// ```
    #[must_use]
    pub fn from_zero(mut self, design_value: f64) -> Self {
        self.design_value = Some(design_value);
        self
    }

    /// This law in the opposite sense: the change from the design configuration has the other sign. Text and parameters
    /// remain as written.
    ///
    /// ```
    /// use hardpoint::law::Law;
    ///
    /// let back = Law::parse("0.5 + 0.1*t")?.from_zero(0.45).reversed();
    /// assert!((back.at(1.0).value() + 0.15).abs() < 1e-15);
    /// # Ok::<(), hardpoint::expression::ExpressionError>(())
    /// ```
    #[must_use]
    pub fn reversed(mut self) -> Self {
        self.is_reversed = !self.is_reversed;
        self
    }

    /// This law in the unit of its text: without [scale](Self::scaled).
    pub(crate) fn as_written(&self) -> Self {
        let design_value = self.design_value.map(|value| value / self.factor);
        Self { factor: 1.0, design_value, ..self.clone() }
    }

    /// Index and value of the parameter with the design value of the prescribed quantity, if the law counts from zero.
    pub fn as_drawn(&self) -> Option<(usize, f64)> {
        self.design_value.map(|value| (self.kind.parameter_count(), value))
    }

    /// Value and first three time derivatives at time `t`, s: driver unit per s⁰, s, s², s³. Over any scalar type, such
    /// as one that carries derivatives.
    ///
    /// At a corner, the derivatives are those of the branch that is active just after `t`; an `if` uses the branch
    /// selected at `t`.
    ///
    /// If the law is not defined at `t` (`sqrt` of a negative number, a division by zero, outside of a table) the
    /// result is not finite; the caller, who knows the name of the driver, reports it.
    pub fn at<T: Real>(&self, t: T) -> TimeJet<T> {
        self.evaluate(Jet::time(t), None)
    }

    /// Value and N - 1 time derivatives at time `t`, s.
    pub(crate) fn to_order<T: Real, const N: usize>(&self, t: T) -> Jet<T, N> {
        self.evaluate(Jet::time(t), None)
    }

    /// Numbers in the law that can be varied, in the order documented for its kind. For an expression, these are the
    /// parameters given to [`parse_with`](Self::parse_with); for a sequence, those of its pieces, with names like
    /// `piece[0].amplitude`, and `piece[0].duration` first.
    ///
    /// ```
    /// use hardpoint::law::{ConstantSpeed, Law, ParameterKind};
    ///
    /// let in_mm = Law::constant_speed(ConstantSpeed { speed: 30.0, offset: 5.0 })?;
    /// let speed = &in_mm.scaled(1e-3).parameters()[0];
    /// assert_eq!((speed.name.as_str(), speed.value), ("speed", 0.03)); // m/s
    /// assert_eq!(speed.kind, ParameterKind::ValueRate(1));
    /// # Ok::<(), hardpoint::law::LawError>(())
    /// ```
    pub fn parameters(&self) -> Vec<Parameter> {
        let mut parameters = self.kind.parameters();
        for parameter in parameters.iter_mut().filter(|parameter| parameter.kind.is_in_driver_unit()) {
            parameter.value *= self.factor;
        }
        parameters.extend(
            self.design_value.map(|value| parameter::parameter(DESIGN_VALUE, value, ParameterKind::Value)),
        );
        parameters
    }

    /// Partial derivatives of f and of its first three time derivatives at time `t`, s, with respect to one of the
    /// [parameters](Self::parameters), in the driver's unit and that of the parameter. Exact up to rounding.
    ///
    /// At a corner, they are one-sided like those of [`at`](Self::at).
    ///
    /// ```
    /// use hardpoint::law::{Harmonic, Law};
    ///
    /// let law = Law::harmonic(Harmonic { amplitude: 5.0, frequency: 1.0, phase: 0.0, offset: 0.0 })?;
    /// let phase = law.parameters().iter().position(|parameter| parameter.name == "phase").unwrap();
    /// assert_eq!(law.derivative(phase, 0.0).value(), 5.0); // amplitude cos(0)
    /// # Ok::<(), hardpoint::law::LawError>(())
    /// ```
    ///
    /// # Panics
    ///
    /// Panics if there is no such parameter.
    pub fn derivative(&self, parameter: usize, t: f64) -> TimeJet {
        self.check_index(parameter);
        let seed = Seed { parameter, size: Dual::variable(0.0) };
        let f = self.evaluate(TimeJet::time(Dual::constant(t)), Some(seed));
        Jet(number::each(&f.derivatives(), |f| f.d))
    }

    /// This law with another value of one of its [parameters](Self::parameters).
    ///
    /// With an invalid value, such as the end of a step before its start, the law has no finite value; nor has one that
    /// was [scaled](Self::scaled) by zero, for a parameter in the driver's unit.
    ///
    /// ```
    /// use hardpoint::law::Law;
    ///
    /// let law = Law::parse_with("speed*t", &[("speed", 2.0)])?;
    /// assert_eq!(law.with_parameter(0, 3.0).at(5.0).value(), 15.0);
    /// # Ok::<(), hardpoint::expression::ExpressionError>(())
    /// ```
    ///
    /// # Panics
    ///
    /// Panics if there is no such parameter.
    #[must_use]
    pub fn with_parameter(&self, parameter: usize, value: f64) -> Self {
        self.check_index(parameter);
        if parameter == self.kind.parameter_count() {
            return self.clone().from_zero(value);
        }
        let is_in_driver_unit = self.kind.parameter_kind(parameter).is_in_driver_unit();
        let mut law = self.clone();
        law.kind.set(parameter, if is_in_driver_unit { value / self.factor } else { value });
        law
    }

    /// Bounds of value and rate over the closed interval between two times, in the driver's unit and per s. They are
    /// exact except for rounding; bounds of the value are wider than the law by about the square of the interval's
    /// length. Both are unbounded if the law is undefined anywhere in the interval; the rate is unbounded if the law
    /// jumps.
    ///
    /// ```
    /// use hardpoint::law::Law;
    ///
    /// let law = Law::parse("20*sin(pi*t)")?;
    /// let travel = law.over(0.25, 1.0).value;
    /// assert!(travel.high == 20.0 && travel.low.abs() < 1e-12);
    /// # Ok::<(), hardpoint::expression::ExpressionError>(())
    /// ```
    pub fn over(&self, from: f64, to: f64) -> Stretch {
        let over = self.kind.over(from, to);
        let over = if over.value.is_bounded() { over } else { self.over_sides(from, to).unwrap_or(over) };
        let over = over * Stretch::constant(self.factor);
        let over = over - Stretch::constant(self.design_value.unwrap_or(0.0));
        let over = if self.is_reversed { over * Stretch::constant(-1.0) } else { over };
        over.settled(self.at(0.5 * (from + to)).value(), to - from)
    }

    /// True if the value is bounded between two times, which is part of [`over`](Self::over).
    pub(crate) fn is_bounded(&self, from: f64, to: f64) -> bool {
        let bounded = |over: Stretch| over.value.is_bounded();
        bounded(self.kind.over(from, to)) || self.over_sides(from, to).is_some_and(bounded)
    }

    /// Range between the times at which branches of the law switch: a branch may be undefined over the whole interval,
    /// and defined where it counts, like `if(t < 1, 0, (t - 1)^1.5)`. The rate is unbounded, since the value may jump.
    fn over_sides(&self, from: f64, to: f64) -> Option<Stretch> {
        let mut breaks = Vec::new();
        self.kind.find_breaks(from, to, &mut breaks);
        let mut sides: Vec<[f64; 2]> = breaks.into_iter().map(Break::sides).collect();
        sort_by_number(&mut sides, |side| side[0]);
        let mut begins = from;
        let mut whole: Option<Stretch> = None;
        for [before, after] in sides.into_iter().chain([[to; 2]]) {
            if begins <= before {
                let side = self.kind.over(begins, before);
                whole = Some(whole.map_or(side, |whole| whole.or(side)));
            }
            begins = f64::max(begins, after);
        }
        whole.map(|whole| Stretch { rate: Range::UNBOUNDED, ..whole })
    }

    /// Bounds of f and of its first three rates over an interval of time, with outward rounding: in the driver's unit
    /// per s to the order. A rate is unbounded if one of a lower order jumps inside of the interval; all are if the law
    /// is undefined anywhere in it. Rates at the ends are those of the side inside.
    ///
    /// ```
    /// use hardpoint::{law::Law, number::Interval};
    ///
    /// let law = Law::parse("abs(t - 1)*t")?;
    /// let [value, rate, ..] = law.enclosure(Interval::between(1.0, 1.5)).derivatives();
    /// assert!(value.contains(0.75) && rate.contains(2.0) && rate.is_bounded());
    /// assert!(!law.enclosure(Interval::between(0.5, 1.5)).d().is_bounded()); // the rate jumps at 1
    /// # Ok::<(), hardpoint::expression::ExpressionError>(())
    /// ```
    pub fn enclosure(&self, over: Interval) -> TimeJet<Interval> {
        let value = self.kind.enclosure(over) * self.factor;
        let value = value - Jet::constant(Interval::constant(self.design_value.unwrap_or(0.0)));
        if self.is_reversed { value * -1.0 } else { value }
    }

    /// Times between `from` and `to` (excluded), in order, at which a rate of the law may jump: a jump lies at one of
    /// them, or between two that follow each other closely.
    pub(crate) fn cuts(&self, from: f64, to: f64) -> Vec<f64> {
        let mut breaks = Vec::new();
        self.kind.find_breaks(from, to, &mut breaks);
        let mut cuts: Vec<f64> = breaks.into_iter().flat_map(Break::bracket).collect();
        cuts.retain(|t| from < *t && *t < to);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    }

    /// Maximum magnitude of the rate between two times, per s.
    pub(crate) fn fastest(&self, from: f64, to: f64) -> f64 {
        self.kind.over(from, to).fastest() * self.factor.abs()
    }

    /// Times between `from` and `to` (both included) at which the value, the speed or the acceleration jumps, in order.
    /// A jump is reported if it exceeds 1e-9 of the largest such value, speed or acceleration there.
    ///
    /// For expressions, the interval is divided into 4096 parts: an `abs`, `atan2`, `min`, `max`, `step` or `if` that
    /// switches there and back within one of them may be missed. No jumps are reported where the law has no finite
    /// value.
    ///
    /// ```
    /// use hardpoint::law::{Jump, Law};
    ///
    /// let law = Law::parse("abs(t - 0.5) + if(t < 2, 0, 3)")?;
    /// assert_eq!(law.jumps(0.0, 1.0), [Jump { time: 0.5, order: 1, size: 2.0 }]); // from -1 to 1 per second
    /// assert_eq!(law.jumps(1.0, 5.0)[0].order, 0);
    /// # Ok::<(), hardpoint::expression::ExpressionError>(())
    /// ```
    pub fn jumps(&self, from: f64, to: f64) -> Vec<Jump> {
        jumps::jumps(self, from, to)
    }

    /// The law over a time that may run backwards, with the derivative with respect to a parameter if a seed is given.
    fn evaluate<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
        let own = self.kind.parameter_count();
        let as_written = seed.filter(|seed| seed.parameter < own);
        let as_written =
            as_written.map(|seed| match self.kind.parameter_kind(seed.parameter).is_in_driver_unit() {
                true => Seed { size: seed.size / T::constant(self.factor), ..seed },
                false => seed,
            });
        let value = self.kind.at(time, as_written) * self.factor;
        let change = match self.design_value {
            Some(design_value) => value - Jet::constant(parameter::seeded(design_value, own, seed)),
            None => value,
        };
        if self.is_reversed { change * -1.0 } else { change }
    }

    fn check_index(&self, parameter: usize) {
        let count = self.kind.parameter_count() + usize::from(self.design_value.is_some());
        assert!(parameter < count, "the law has {count} parameters, so none has the index {parameter}");
    }
}

/// Writes the text or the numbers of the law, without the factor of [`Law::scaled`]; of a reversed law the negative.
impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_reversed { write!(f, "-({})", self.kind) } else { self.kind.fmt(f) }
    }
}

impl fmt::Debug for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Programs and splines are long, and follow from the text.
        let text = self.to_string();
        f.debug_struct("Law").field("text", &text).field("factor", &self.factor).finish_non_exhaustive()
    }
}

impl PartialEq for Law {
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind
            && self.factor == other.factor
            && self.design_value == other.design_value
            && self.is_reversed == other.is_reversed
    }
}

#[cfg(test)]
mod battery;
#[cfg(test)]
mod tests;

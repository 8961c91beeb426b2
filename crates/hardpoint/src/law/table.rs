//! The law that is a smooth curve through given points.

use std::fmt;
use std::sync::Arc;

use super::error::LawError;
use super::jet::TimeJet;
use super::kind::Shape;
use super::parameter::{Parameter, ParameterKind, Seed, parameter};
use super::polynomial::sum_of_powers;
use super::scalar::Scalar;
use super::spline::{Basis, EndKind, Segment};

/// A table of points, and the spline to lay through them.
///
/// The parameters of its law are `f[0]`, `f[1]`, ... (in a periodic table without the last, which moves with `f[0]`), then, if
/// the ends are clamped, `start_speed`, `end_speed`, or for a quintic `start_speed`, `start_acceleration`, `end_speed`,
/// `end_acceleration`.
///
/// Before the first time and after the last the law has no finite value, unless the table is periodic.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The times of the points, in s, strictly increasing; two at least, three if the table is periodic, or natural and
    /// quintic.
    pub times: Vec<f64>,
    /// The values at these times, in the driver's unit.
    pub values: Vec<f64>,
    /// How smooth the curve is.
    pub degree: SplineDegree,
    /// What is known at the ends.
    pub ends: Ends,
}

/// How smooth the spline of a [`Table`] is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SplineDegree {
    /// Degree 3: the acceleration is continuous, and piecewise linear.
    #[default]
    Cubic,
    /// Degree 5: the jerk and its rate are continuous too.
    Quintic,
}

/// What is known at the ends of a [`Table`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// Nothing: the curve ends as a thin beam does. The acceleration of a cubic is zero there; of a quintic the jerk and its
    /// rate are.
    Natural,
    /// Speed and acceleration; a cubic takes the speed only.
    Clamped {
        /// At the first point.
        start: EndRates,
        /// At the last point.
        end: EndRates,
    },
    /// The last point is the first again: the curve repeats for ever, and is as smooth there as elsewhere. The two values
    /// must be equal.
    Periodic,
}

impl Default for Ends {
    /// Clamped, at rest.
    fn default() -> Self {
        Self::Clamped { start: EndRates::default(), end: EndRates::default() }
    }
}

/// Speed and acceleration at an end of a [`Table`]; zero by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndRates {
    /// In the driver's unit per s.
    pub speed: f64,
    /// In the driver's unit per s²; zero for a cubic, whose acceleration follows from the points.
    pub acceleration: f64,
}

/// A time this much outside of a range, relative to the range's own times, is meant to be its end: sums of output steps do
/// not meet the end of a table exactly.
pub(super) const ROUNDING_OF_TIME: f64 = 1e-12;

/// The law of a table.
#[derive(Clone)]
pub(super) struct Spline {
    times: Vec<f64>,
    is_periodic: bool,
    degree: SplineDegree,
    ends: EndKind,
    /// The values at the points, then those at the ends: the parameters.
    data: Vec<f64>,
    basis: Arc<Basis>,
    segments: Vec<Segment>,
}

impl Spline {
    pub(super) fn new(table: &Table) -> Result<Self, LawError> {
        table.check()?;
        let rates = if table.degree == SplineDegree::Cubic { 1 } else { 2 };
        let mut data = table.values.clone();
        let ends = match table.ends {
            Ends::Natural => EndKind::Natural,
            Ends::Clamped { start, end } => {
                data.extend(&[start.speed, start.acceleration][..rates]);
                data.extend(&[end.speed, end.acceleration][..rates]);
                EndKind::Clamped
            }
            Ends::Periodic => {
                data.pop();
                EndKind::Periodic
            }
        };
        let basis = Basis::new(&table.times, rates, ends);
        let segments = basis.segments(&data);
        let is_periodic = ends == EndKind::Periodic;
        let (times, degree) = (table.times.clone(), table.degree);
        Ok(Self { times, is_periodic, degree, ends, data, basis: Arc::new(basis), segments })
    }

    /// The number of values among the data.
    fn values(&self) -> usize {
        self.times.len() - usize::from(self.is_periodic)
    }

    /// The whole periods before time `t`, in s.
    fn periods_before(&self, t: f64, is_backwards: bool) -> f64 {
        if !self.is_periodic {
            return 0.0;
        }
        let period = self.times[self.times.len() - 1] - self.times[0];
        let periods = (t - self.times[0]) / period;
        period * if is_backwards { periods.ceil() - 1.0 } else { periods.floor() }
    }
}

impl Table {
    fn check(&self) -> Result<(), LawError> {
        let (points, values) = (self.times.len(), self.values.len());
        if points != values {
            let message = format!("a table has {points} times but {values} values");
            return Err(LawError::new(message, "give one value for every time"));
        }
        let (fewest, what) = match (self.ends, self.degree) {
            (Ends::Periodic, _) => (3, "a periodic table"),
            (Ends::Natural, SplineDegree::Quintic) => (3, "a quintic table with natural ends"),
            _ => (2, "a table"),
        };
        if points < fewest {
            let help = match self.ends {
                Ends::Periodic => "the last point counts: it repeats the first one period later",
                _ => "add points, or write the law as a polynomial",
            };
            return Err(LawError::new(format!("{what} needs at least {fewest} points, not {points}"), help));
        }
        for (what, numbers) in [("time", &self.times), ("value", &self.values)] {
            if let Some(k) = numbers.iter().position(|number| !number.is_finite()) {
                let message =
                    format!("the {what} of a table's point {k} is {}, not a finite number", numbers[k]);
                return Err(LawError::new(message, "points are counted from 0"));
            }
        }
        if let Some(k) = (1..points).find(|&k| self.times[k] <= self.times[k - 1]) {
            let (before, after) = (self.times[k - 1], self.times[k]);
            let message = format!(
                "the times of a table must increase, but {after} s follows {before} s (points {} and {k})",
                k - 1
            );
            let help =
                if before == after { "remove one of the two points" } else { "sort the points by time" };
            return Err(LawError::new(message, help));
        }
        match self.ends {
            Ends::Periodic if self.values[0] != self.values[points - 1] => {
                let (first, last) = (self.values[0], self.values[points - 1]);
                let message = format!(
                    "a periodic table must end with the value it begins with, but {last} is not {first}"
                );
                Err(LawError::new(
                    message,
                    "add a last point, one period after the first, with the first one's value",
                ))
            }
            Ends::Clamped { start, end } => {
                let rates = [start.speed, start.acceleration, end.speed, end.acceleration];
                if let Some(rate) = rates.iter().find(|rate| !rate.is_finite()) {
                    let message =
                        format!("speed and acceleration at the ends of a table must be finite, not {rate}");
                    Err(LawError::new(message, ""))
                } else if self.degree == SplineDegree::Cubic && (rates[1] != 0.0 || rates[3] != 0.0) {
                    let message = "the acceleration at the ends of a cubic table can not be chosen";
                    Err(LawError::new(message, "make the table quintic, or leave the acceleration out"))
                } else {
                    Ok(())
                }
            }
            _ => Ok(()),
        }
    }
}

impl Shape for Spline {
    fn at<S: Scalar>(&self, time: TimeJet<S>, seed: Option<Seed>) -> TimeJet<S> {
        let is_backwards = time.d().value() < 0.0;
        let time = time.plus(S::fixed(-self.periods_before(time.value().value(), is_backwards)));
        let t = time.value().value();
        let (first, last) = (self.times[0], self.times[self.times.len() - 1]);
        let slack = ROUNDING_OF_TIME * first.abs().max(last.abs());
        if !(t >= first - slack && t <= last + slack) {
            return TimeJet::undefined();
        }
        let knots = self.times.partition_point(|&knot| if is_backwards { knot < t } else { knot <= t });
        let k = knots.saturating_sub(1).min(self.segments.len() - 1);
        let order = if self.degree == SplineDegree::Cubic { 4 } else { 6 };
        let since = time.plus(S::fixed(-self.times[k]));
        let curve = |segment: &Segment| sum_of_powers(segment[..order].iter().map(|&c| S::fixed(c)), since);
        let f = curve(&self.segments[k]);
        match seed {
            None => f,
            Some(Seed { parameter, size }) => {
                f + curve(&self.basis.cardinal(parameter)[k]).times(S::varied(0.0, size))
            }
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        let rates: &[&str] = match self.degree {
            SplineDegree::Cubic => &["start_speed", "end_speed"],
            SplineDegree::Quintic => &["start_speed", "start_acceleration", "end_speed", "end_acceleration"],
        };
        let name = |k: usize| match k.checked_sub(self.values()) {
            None => format!("f[{k}]"),
            Some(rate) => rates[rate].to_owned(),
        };
        let data = self.data.iter().enumerate();
        data.map(|(k, &value)| parameter(name(k), value, self.parameter_kind(k))).collect()
    }

    fn parameter_count(&self) -> usize {
        self.data.len()
    }

    fn parameter_kind(&self, parameter: usize) -> ParameterKind {
        match (parameter.checked_sub(self.values()), self.degree) {
            (None, _) => ParameterKind::Value,
            (Some(_), SplineDegree::Cubic) => ParameterKind::ValueRate(1),
            (Some(rate), SplineDegree::Quintic) => ParameterKind::ValueRate(1 + rate as u32 % 2),
        }
    }

    fn set(&mut self, parameter: usize, value: f64) {
        self.data[parameter] = value;
        self.segments = self.basis.segments(&self.data);
    }
}

impl fmt::Display for Spline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let degree = if self.degree == SplineDegree::Cubic { "cubic" } else { "quintic" };
        let ends = match self.ends {
            EndKind::Natural => "natural ",
            EndKind::Clamped => "",
            EndKind::Periodic => "periodic ",
        };
        write!(f, "{ends}{degree} spline through {} points", self.times.len())
    }
}

impl PartialEq for Spline {
    fn eq(&self, other: &Self) -> bool {
        (&self.times, &self.data, self.degree, self.ends)
            == (&other.times, &other.data, other.degree, other.ends)
    }
}

//! Law given by a spline through points.

use std::fmt;
use std::sync::Arc;

use crate::expression::Stretch;
use crate::linalg::{Basis, EndKind, Segment};
use crate::number::{self, Interval, Jet, Real};

use super::Law;
use super::error::LawError;
use super::kind::{LawKind, either};
use super::parameter::{Parameter, ParameterKind, Seed, parameter};
use super::polynomial::sum_of_powers;

/// A table of points, and the kind of spline through them.
///
/// Parameters: `f[0]`, `f[1]`, ... (for a periodic table without the last, which follows `f[0]`), then, if the ends are
/// clamped, `start_speed`, `end_speed`, or for a quintic `start_speed`, `start_acceleration`, `end_speed`,
/// `end_acceleration`.
///
/// Before the first and after the last time the law has no finite value, unless the table is periodic.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Times of the points, s, strictly increasing: at least two, or three if the table is periodic, or natural and
    /// quintic.
    pub times: Vec<f64>,
    /// Values at these times, in the driver's unit.
    pub values: Vec<f64>,
    /// Degree of the spline.
    pub degree: SplineDegree,
    /// Boundary conditions at the ends.
    pub ends: SplineEnds,
}

/// Degree of the spline of a [`Table`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SplineDegree {
    /// Degree 3: the acceleration is continuous and piecewise linear.
    #[default]
    Cubic,
    /// Degree 5: the jerk and its rate are continuous as well.
    Quintic,
}

/// Boundary conditions at the ends of a [`Table`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SplineEnds {
    /// Free ends, like those of a thin beam: a cubic has zero acceleration there, a quintic zero jerk and zero rate of
    /// jerk.
    Natural,
    /// Given speed and acceleration; for a cubic, only the speed.
    Clamped {
        /// At the first point.
        start: SplineEndRates,
        /// At the last point.
        end: SplineEndRates,
    },
    /// The last point coincides with the first one, one period later: the curve repeats, and is as smooth there as
    /// elsewhere. The two values must be equal.
    Periodic,
}

impl Default for SplineEnds {
    /// Clamped, at rest.
    fn default() -> Self {
        Self::Clamped { start: SplineEndRates::default(), end: SplineEndRates::default() }
    }
}

/// Speed and acceleration at an end of a [`Table`]; zero by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SplineEndRates {
    /// Speed, in the driver's unit per s.
    pub speed: f64,
    /// Acceleration, in the driver's unit per s²; must be zero for a cubic, whose acceleration follows from the points.
    pub acceleration: f64,
}

/// Tolerance for times outside of a range, relative to the times of the range: sums of output steps do not match the
/// end of a table exactly.
pub(super) const ROUNDING_OF_TIME: f64 = 1e-12;

/// Law of a table.
#[derive(Clone)]
pub(super) struct Spline {
    times: Vec<f64>,
    is_periodic: bool,
    degree: SplineDegree,
    ends: EndKind,
    /// Parameters: values at the points, then the rates at the ends.
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
            SplineEnds::Natural => EndKind::Natural,
            SplineEnds::Clamped { start, end } => {
                data.extend(&[start.speed, start.acceleration][..rates]);
                data.extend(&[end.speed, end.acceleration][..rates]);
                EndKind::Clamped
            }
            SplineEnds::Periodic => {
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

    /// Number of point values among the data.
    fn values(&self) -> usize {
        self.times.len() - usize::from(self.is_periodic)
    }

    /// Number of coefficients of a segment that may be non-zero.
    fn order(&self) -> usize {
        if self.degree == SplineDegree::Cubic { 4 } else { 6 }
    }

    /// True if the time `t`, in the first period, is within the table.
    fn reaches(&self, t: f64) -> bool {
        let (first, last) = (self.times[0], self.times[self.times.len() - 1]);
        let slack = ROUNDING_OF_TIME * first.abs().max(last.abs());
        t >= first - slack && t <= last + slack
    }

    /// Segment of a time within the table.
    fn segment_at(&self, t: f64, is_backwards: bool) -> usize {
        let knots = self.times.partition_point(|&knot| if is_backwards { knot < t } else { knot <= t });
        knots.saturating_sub(1).min(self.segments.len() - 1)
    }

    /// Polynomial of one segment, at the time since its start.
    #[inline(always)]
    fn curve<T: Real, const N: usize>(&self, segment: &Segment, since: Jet<T, N>) -> Jet<T, N> {
        sum_of_powers(since, self.order(), |power| T::constant(segment[power]))
    }

    /// Duration of the whole periods before time `t`, s.
    fn periods_before(&self, t: f64, is_backwards: bool) -> f64 {
        if !self.is_periodic {
            return 0.0;
        }
        let period = self.times[self.times.len() - 1] - self.times[0];
        let periods = (t - self.times[0]) / period;
        period * if is_backwards { periods.ceil() - 1.0 } else { periods.floor() }
    }
}

/// Segment for times outside of the table.
const UNDEFINED: Segment = [f64::NAN; 6];

impl Table {
    fn check(&self) -> Result<(), LawError> {
        let (points, values) = (self.times.len(), self.values.len());
        if points != values {
            let message = format!("a table has {points} times but {values} values");
            return Err(LawError::new(message, "give one value for every time"));
        }
        let (fewest, what) = match (self.ends, self.degree) {
            (SplineEnds::Periodic, _) => (3, "a periodic table"),
            (SplineEnds::Natural, SplineDegree::Quintic) => (3, "a quintic table with natural ends"),
            _ => (2, "a table"),
        };
        if points < fewest {
            let help = match self.ends {
                SplineEnds::Periodic => "the last point counts: it repeats the first one period later",
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
            SplineEnds::Periodic if self.values[0] != self.values[points - 1] => {
                let (first, last) = (self.values[0], self.values[points - 1]);
                let message = format!(
                    "a periodic table must end with the value it begins with, but {last} is not {first}"
                );
                Err(LawError::new(
                    message,
                    "add a last point, one period after the first, with the first one's value",
                ))
            }
            SplineEnds::Clamped { start, end } => {
                let rates = [start.speed, start.acceleration, end.speed, end.acceleration];
                if let Some(rate) = rates.iter().find(|rate| !rate.is_finite()) {
                    let message =
                        format!("speed and acceleration at the ends of a table must be finite, not {rate}");
                    Err(LawError::new(message, ""))
                } else if self.degree == SplineDegree::Cubic && (rates[1] != 0.0 || rates[3] != 0.0) {
                    let message = "the acceleration at the ends of a cubic table cannot be chosen";
                    Err(LawError::new(message, "make the table quintic, or leave the acceleration out"))
                } else {
                    Ok(())
                }
            }
            _ => Ok(()),
        }
    }
}

impl Law {
    /// Creates the law of a spline through the points of a table.
    ///
    /// ```
    /// use hardpoint::law::{SplineEnds, Law, SplineDegree, Table};
    ///
    /// // From rest to rest.
    /// let (times, values) = (vec![0.0, 1.0, 2.0], vec![0.0, 4.0, 0.0]);
    /// let law = Law::table(&Table { times, values, degree: SplineDegree::Cubic, ends: SplineEnds::default() })?;
    /// assert_eq!(law.at(0.5).value(), 2.0); // by symmetry also at rest in the middle
    /// assert!(law.at(2.5).value().is_nan());
    /// assert_eq!(law.to_string(), "cubic spline through 3 points");
    /// # Ok::<(), hardpoint::law::LawError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if there are too few points, the numbers of times and values differ, a number is not finite,
    /// times do not increase, the last value of a periodic table differs from the first, or an acceleration is given
    /// for a cubic.
    pub fn table(table: &Table) -> Result<Self, LawError> {
        Spline::new(table).map(Self::of)
    }

    /// Polynomial pieces of a table as it was written, by powers of the time from the start of each; empty for other
    /// laws.
    pub(crate) fn segments(&self) -> &[Segment] {
        self.kind.segments()
    }
}

impl LawKind for Spline {
    #[inline(always)]
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
        let (now, is_backwards) = (time.value().value(), time.d().value() < 0.0);
        let before = self.periods_before(now, is_backwards);
        let k = self.reaches(now - before).then(|| self.segment_at(now - before, is_backwards));
        // Time since the start of the segment.
        let since = time.plus(-T::constant(before)).plus(-T::constant(k.map_or(0.0, |k| self.times[k])));
        let of = |all: &[Segment]| self.curve(k.map_or(&UNDEFINED, |k| &all[k]), since);
        let f = of(&self.segments);
        match seed {
            None => f,
            // A spline is linear in its data: f = sum_k data_k c_k(t), so df/d(data_k) is the cardinal spline c_k.
            Some(Seed { parameter, size }) => f + of(self.basis.cardinal(parameter)).times(size),
        }
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        let before = self.periods_before(from, false);
        let (mut from, mut to) = (from - before, to - before);
        let (first, last) = (self.times[0], self.times[self.times.len() - 1]);
        let mut over = None::<Stretch>;
        let mut add = |from: f64, to: f64| {
            let first = self.segment_at(from, false);
            for k in first..=usize::max(first, self.segment_at(to, true)) {
                let start = self.times[k];
                let (from, to) = (from.max(start) - start, to.min(self.times[k + 1]).max(start) - start);
                let segment = Stretch::of_polynomial(&self.segments[k][..self.order()], from, to);
                over = Some(over.map_or(segment, |all| all.or(segment)));
            }
        };
        if self.is_periodic && to > last {
            // Beyond the end it starts again.
            add(first, if to - from >= last - first { last } else { to - (last - first) });
            to = last;
        }
        if !(self.reaches(from) && self.reaches(to)) {
            return Stretch::UNBOUNDED;
        }
        (from, to) = (from.clamp(first, last), to.clamp(first, last));
        add(from, to);
        over.unwrap_or(Stretch::UNBOUNDED)
    }

    fn enclosure(&self, over: Interval) -> Jet<Interval, 4> {
        let unbounded = Jet([Interval::ENTIRE; 4]);
        let (first, last) = (self.times[0], self.times[self.times.len() - 1]);
        // Segment k, repeated after a time.
        let part = |k: usize, from: f64, to: f64, shift: f64| {
            let [low, high] = number::both([from, to], |t| t.clamp(over.low, over.high));
            let since =
                (Interval { low, high } - Interval::constant(shift)) - Interval::constant(self.times[k]);
            self.curve(&self.segments[k], Jet::time(since))
        };
        let mut all: Option<Jet<Interval, 4>> = None;
        let (mut shift, mut from) = (self.periods_before(over.low, false), over.low);
        if !(self.is_periodic || self.reaches(over.low) && self.reaches(over.high)) {
            return unbounded;
        }
        loop {
            let k = self.segment_at((from - shift).clamp(first, last), false);
            // The last segment reaches to the end of the table and what is as good as its end.
            let is_last = k + 1 == self.segments.len();
            let ends = if is_last && !self.is_periodic { f64::INFINITY } else { self.times[k + 1] + shift };
            let to = over.high.min(ends);
            if to > from || over.is_point() {
                let bounds = part(k, from, to, shift);
                all = Some(all.map_or(bounds, |all| either(all, bounds)));
            } else if !(is_last && self.is_periodic) {
                return unbounded;
            }
            if to >= over.high {
                return all.unwrap_or(unbounded);
            }
            if is_last {
                shift += last - first;
            }
            from = to;
        }
    }

    fn segments(&self) -> &[Segment] {
        &self.segments
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

#[cfg(test)]
mod tests {
    use crate::law::*;

    fn table(times: &[f64], values: &[f64], degree: SplineDegree, ends: SplineEnds) -> Law {
        Law::table(&Table { times: times.to_vec(), values: values.to_vec(), degree, ends }).unwrap()
    }

    #[test]
    fn splines_reproduce_polynomials_of_their_degree() {
        let times = [0.0, 0.3, 1.1, 1.6, 2.5, 2.6];
        let cubic = Law::polynomial(&[1.0, -2.0, 0.5, 0.7]).unwrap();
        let quintic = Law::polynomial(&[1.0, -2.0, 0.5, 0.7, -0.9, 0.2]).unwrap();
        let parabola = Law::polynomial(&[1.0, -2.0, 0.5]).unwrap();
        let line = Law::polynomial(&[1.0, -2.0]).unwrap();
        let rates = |law: &Law, t, is_quintic| {
            let at = law.at(t);
            SplineEndRates { speed: at.d(), acceleration: if is_quintic { at.dd() } else { 0.0 } }
        };
        let clamped = |law: &Law, is_quintic| SplineEnds::Clamped {
            start: rates(law, times[0], is_quintic),
            end: rates(law, times[5], is_quintic),
        };
        let cases = [
            (&cubic, SplineDegree::Cubic, clamped(&cubic, false)),
            (&quintic, SplineDegree::Quintic, clamped(&quintic, true)),
            (&line, SplineDegree::Cubic, SplineEnds::Natural),
            (&parabola, SplineDegree::Quintic, SplineEnds::Natural),
        ];
        for (law, degree, ends) in cases {
            let spline = table(&times, &times.map(|t| law.at(t).value()), degree, ends);
            for k in 0..=26 {
                let t = 0.1 * f64::from(k);
                let (ours, exact) = (spline.at(t).derivatives(), law.at(t).derivatives());
                for order in 0..4 {
                    assert!(
                        (ours[order] - exact[order]).abs() < 1e-9,
                        "{law} at {t}: {ours:?} is not {exact:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_periodic_spline_of_a_sine_is_smooth_over_its_seam_and_repeats() {
        let times: Vec<f64> = (0..=16).map(|k| f64::from(k) / 16.0 + 0.2).collect();
        let mut values: Vec<f64> = times.iter().map(|t| (std::f64::consts::TAU * t).sin()).collect();
        values[16] = values[0];
        for (degree, continuous, accuracy) in
            [(SplineDegree::Cubic, 2, 2e-4), (SplineDegree::Quintic, 3, 2e-6)]
        {
            let law = table(&times, &values, degree, SplineEnds::Periodic);
            let (before, after) = (law.at(1.2 - 1e-10).derivatives(), law.at(1.2 + 1e-10).derivatives());
            for order in 0..=continuous {
                assert!((after[order] - before[order]).abs() < 1e-4, "{law}, {order}: {before:?}, {after:?}");
            }
            for t in [-3.33, 0.21, 0.7, 1.19, 7.77] {
                assert!(
                    (law.at(t).value() - (std::f64::consts::TAU * t).sin()).abs() < accuracy,
                    "{law} at {t}"
                );
            }
        }
    }

    #[test]
    fn splines_of_many_points_stay_accurate() {
        let times: Vec<f64> = (0..=2000).map(|k| f64::from(k) * 1e-3 + 2e-4 * f64::from(k % 3)).collect();
        let values: Vec<f64> = times.iter().map(|t| t.sin()).collect();
        let end = times[2000];
        let rate = |t: f64| SplineEndRates { speed: t.cos(), acceleration: -t.sin() };
        let law = table(
            &times,
            &values,
            SplineDegree::Quintic,
            SplineEnds::Clamped { start: rate(0.0), end: rate(end) },
        );
        let at = law.at(1.23456);
        assert!((at.value() - 1.23456_f64.sin()).abs() < 1e-13);
        assert!((at.d() - 1.23456_f64.cos()).abs() < 1e-10);
        assert!((at.dd() + 1.23456_f64.sin()).abs() < 1e-6);
    }

    #[test]
    fn tables_are_refused_with_the_reason() {
        use SplineDegree::{Cubic, Quintic};
        let at_end = SplineEndRates { speed: 0.0, acceleration: 1.0 };
        let rising = SplineEnds::Clamped { start: SplineEndRates::default(), end: at_end };
        type Case<'a> = (&'a [f64], &'a [f64], SplineDegree, SplineEnds, &'a str, &'a str);
        let cases: [Case<'_>; 9] = [
            (
                &[0.0, 1.0],
                &[0.0],
                Cubic,
                SplineEnds::default(),
                "a table has 2 times but 1 values",
                "give one value for every time",
            ),
            (
                &[0.0],
                &[0.0],
                Cubic,
                SplineEnds::default(),
                "a table needs at least 2 points, not 1",
                "add points, or write the law as a polynomial",
            ),
            (
                &[0.0, 1.0],
                &[0.0, 0.0],
                Quintic,
                SplineEnds::Natural,
                "a quintic table with natural ends needs at least 3 points, not 2",
                "add points, or write the law as a polynomial",
            ),
            (
                &[0.0, 1.0],
                &[0.0, 0.0],
                Cubic,
                SplineEnds::Periodic,
                "a periodic table needs at least 3 points, not 2",
                "the last point counts: it repeats the first one period later",
            ),
            (
                &[0.0, 1.0],
                &[0.0, f64::NAN],
                Cubic,
                SplineEnds::default(),
                "the value of a table's point 1 is NaN, not a finite number",
                "points are counted from 0",
            ),
            (
                &[0.0, 2.0, 1.0],
                &[0.0; 3],
                Cubic,
                SplineEnds::default(),
                "the times of a table must increase, but 1 s follows 2 s (points 1 and 2)",
                "sort the points by time",
            ),
            (
                &[0.0, 2.0, 2.0],
                &[0.0; 3],
                Cubic,
                SplineEnds::default(),
                "the times of a table must increase, but 2 s follows 2 s (points 1 and 2)",
                "remove one of the two points",
            ),
            (
                &[0.0, 1.0, 2.0],
                &[0.0, 1.0, 2.0],
                Cubic,
                SplineEnds::Periodic,
                "a periodic table must end with the value it begins with, but 2 is not 0",
                "add a last point, one period after the first, with the first one's value",
            ),
            (
                &[0.0, 1.0],
                &[0.0; 2],
                Cubic,
                rising,
                "the acceleration at the ends of a cubic table cannot be chosen",
                "make the table quintic, or leave the acceleration out",
            ),
        ];
        for (times, values, degree, ends, message, help) in cases {
            let error =
                Law::table(&Table { times: times.into(), values: values.into(), degree, ends }).unwrap_err();
            assert_eq!((error.message.as_str(), error.help.as_deref()), (message, Some(help)));
        }
    }
}

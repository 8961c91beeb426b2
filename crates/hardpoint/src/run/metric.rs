//! Metrics of a solved motion, with their exact derivatives by the design variables.
//!
//! The code is generic over the number type; dual numbers give the derivatives. Between output times, curves are the
//! polynomials with the values, rates and accelerations at both ends.

use super::curve::{
    AT_CORNER, CornerEstimate, SampledCurve, THERE, Vertex, WidePolynomial, abscissa_at, along, apart,
    crossings, unknown_change,
};
use super::quadrature::{coarse_middles, path_error, path_nodes, travel};
use super::solution::Solution;
use crate::measure::{MeasureResults, Output};
use crate::model::{CurvePart, Metric, Model, OutputSource, Reduction, ReductionUnit, VariableId, on_target};
use crate::motion::{Stop, StopKind};
use crate::number::{Dual, Real};

/// The value of a metric.
#[derive(Clone, Debug, PartialEq)]
pub struct MetricValue {
    /// In SI; `None` where the motion does not reach the request.
    pub value: Option<f64>,
    /// Time at which it is taken, s; `None` if it belongs to the whole curve.
    pub time: Option<f64>,
    /// Estimate of the interpolation error between output times, in SI; `None` if the metric was solved at its own
    /// time, or if there are too few output times for an estimate.
    pub error: Option<f64>,
    /// Scale of the error, in SI: maximum minus minimum of the curve; for an integral, times the travel of its
    /// abscissa; for a slope, its magnitude.
    pub range: f64,
    /// Derivative by every design variable; NaN for those that are not admissible, and for all if no sensitivities were
    /// solved.
    pub d: Vec<f64>,
}

/// Values of all metrics of a model.
pub fn metrics(model: &Model, solution: &Solution) -> Vec<MetricValue> {
    model.metrics.iter().map(|metric| metric_value(model, solution, metric)).collect()
}

/// Metrics of another design, for comparison with today's. If its motion ends before today's, metrics of the whole
/// curve are `None`, because the rest of the curve is not known.
pub fn metrics_beside(model: &Model, today: &Solution, other: &Solution) -> Vec<Option<f64>> {
    let whole = other.motion.len() >= today.motion.len();
    let values = model.metrics.iter().zip(metric_numbers(model, other));
    let is_known = |metric: &Metric, value: f64| value.is_finite() && (whole || metric.take.is_local());
    values.map(|(metric, found)| found.filter(|value| is_known(metric, *value))).collect()
}

/// True if a metric is known of a solution: one of the whole curve is not if the motion ended early, unless an end stop
/// ended it.
fn is_known(metric: &Metric, solution: &Solution) -> bool {
    let is_ended = |stop: &Stop| !matches!(stop.kind, StopKind::JointLimit { .. });
    metric.take.is_local() || !solution.stop.as_ref().is_some_and(is_ended)
}

/// Returns the values of all metrics without derivatives, times and errors.
pub fn metric_numbers<'m>(
    model: &'m Model,
    solution: &'m Solution,
) -> impl Iterator<Item = Option<f64>> + 'm {
    model.metrics.iter().map(|metric| metric_number(metric, solution))
}

/// Returns the value of one metric; `None` where the motion does not reach the request.
pub fn metric_number(metric: &Metric, solution: &Solution) -> Option<f64> {
    let (y, x) = curves(solution, metric).filter(|_| is_known(metric, solution))?;
    take(metric, &y, &x).map(|(value, _)| value)
}

/// True if the least value of a curve may be this one or less.
pub(super) fn reaches(metric: &Metric, solution: &Solution, value: f64) -> bool {
    let Some((m, orders, _)) = column(&solution.measured, metric.of) else { return true };
    let times = &solution.motion.times;
    let length = |k: usize| times.get(k + 1).map_or(0.0, |after| after - times[k]);
    // Bernstein coefficients of the polynomials:  y,  y +- h y. / 5,  y +- 2 h y. / 5 + h^2 y.. / 20
    let is_above = |k: usize| {
        let h = f64::max(length(k), k.checked_sub(1).map_or(0.0, length));
        let [y, rate, acceleration] = solution.measured.value(k, m);
        y - h * (0.4 * rate.abs() + 0.05 * h * acceleration.abs()) > value
    };
    let is_surely_above = orders == 3 && (0..times.len()).all(is_above);
    !is_surely_above && metric_number(metric, solution).is_none_or(|least| least <= value)
}

/// Returns the index of a metric of the whole model among the metrics of one of its motions ([`Model::motions`]);
/// `None` if the metric is taken of another motion.
pub fn place_of(model: &Model, metric: usize, number: usize) -> Option<usize> {
    let counts =
        |m: &usize| model.metrics[*m].case.is_none_or(|case| model.cases.is_empty() || case.0 == number);
    counts(&metric).then(|| (0..metric).filter(counts).count())
}

fn metric_value(model: &Model, solution: &Solution, metric: &Metric) -> MetricValue {
    let none = MetricValue {
        value: None,
        time: None,
        error: None,
        range: 0.0,
        d: vec![f64::NAN; model.variables.len()],
    };
    let Some((y, x)) = curves(solution, metric).filter(|_| is_known(metric, solution)) else { return none };
    let Some((value, time)) = take(metric, &y, &x).filter(|(value, _)| value.is_finite()) else {
        return none;
    };
    let derivative = |v: usize| {
        let found = varied_curves(solution, metric, VariableId(v));
        found.and_then(|(y, x)| take(metric, &y, &x)).map_or(f64::NAN, |(value, _)| value.d)
    };
    // If the motion was solved between output times, the metric is taken at a solved time. Integrals are not, nor is an
    // extremum between times without rates.
    let is_located = is_among(&solution.located, metric);
    let hidden = match metric.take.part() {
        CurvePart::Path(_) => true,
        CurvePart::Extrema(_) => y.orders == 1 && !is_located,
        CurvePart::Ends | CurvePart::Place { .. } | CurvePart::Points(_) => false,
    };
    let resolved = !hidden
        && unresolved_extrema(solution_of(solution), metric).is_empty()
        && unresolved_corners(solution_of(solution), metric).is_empty()
        && (solution.between.is_some() || is_located)
        && unresolved_times(solution_of(solution), metric, true).is_empty();
    let range = match metric.take.unit() {
        ReductionUnit::Output => range_of(&y),
        ReductionUnit::OutputTimesAbscissa => range_of(&y) * travel(metric, &y, &x),
        ReductionUnit::OutputPerAbscissa => value.abs(),
    };
    let error = if resolved { None } else { interpolation_error(metric, &y, &x, value, time) };
    // Next to a kink that is not located, polynomials of several intervals are off by far more than the curve changes.
    let is_extremum = !metric.take.extrema().is_empty();
    let error = error.map(|error| if is_extremum { error.min(range) } else { error });
    // Where a curve changes by no more than the error of its range, round-off decides where its ends are.
    let is_round_off = metric.take.extrema().len() > 1 && error.is_some_and(|error| error >= range);
    MetricValue {
        value: Some(value),
        time,
        error,
        range,
        d: (0..model.variables.len()).map(|v| if is_round_off { f64::NAN } else { derivative(v) }).collect(),
    }
}

/// Fraction of the range within which two extrema are alike: either may be the larger, unless the curve was solved at
/// both.
const ALIKE: f64 = 1e-4;
/// Interpolation error, as a fraction of the curve's range, below which a curve is resolved if the motion was solved
/// between output times.
const RESOLVED: f64 = 1e-10;
/// The same for motions that were solved at the output times alone: metrics need few digits, and many designs are
/// solved for them.
const RESOLVED_BY_OUTPUTS: f64 = 1e-7;

/// Maximum minus minimum of a curve at its times.
fn range_of<T: Real>(y: &SampledCurve<'_, T>) -> f64 {
    let finite = || y.values.iter().map(|v| v[0].value()).filter(|x| x.is_finite());
    finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min)
}

/// Times at which a metric over time is taken, or at which its window ends.
pub(crate) fn window_times(metric: &Metric) -> Vec<f64> {
    if metric.over.is_some() {
        return Vec::new();
    }
    metric.window.into_iter().flatten().chain(metric.take.places()).collect()
}

/// Times that a metric needs in addition to those of a solution: times at which it is taken by inaccurate
/// interpolation; for an integral, midpoints of the inaccurate intervals. `finer` is true if the solution has times
/// between the output times.
pub(crate) fn unresolved_times(solution: &Solution, metric: &Metric, finer: bool) -> Vec<f64> {
    let Some((y, x)) = curves_at(solution, metric) else { return Vec::new() };
    let range = range_of(&y);
    let located: Vec<_> = match metric.take.part() {
        CurvePart::Extrema(signs) => {
            signs.iter().flat_map(|sign| far_out_times(metric, &y, &x, *sign, finer)).collect()
        }
        // It is taken at output times.
        CurvePart::Ends => return Vec::new(),
        CurvePart::Place { at, .. } => crossings(&y, &x, at).map(|(_, t)| t).take(1).collect(),
        CurvePart::Points(points) => {
            let counting = points.iter().filter(|p| within_window(metric, p[0]));
            counting.filter_map(|p| crossings(&y, &x, p[0]).next()).map(|(k, t)| y.within(k, t)).collect()
        }
        CurvePart::Path(_) => {
            return coarse_middles(metric, &y, &x, RESOLVED_BY_OUTPUTS * range);
        }
    };
    let part = if finer { RESOLVED } else { RESOLVED_BY_OUTPUTS };
    let is_at_abscissa = metric.take.is_local();
    let unresolved = |time: &f64| {
        if y.times.contains(time) {
            return false;
        }
        let k = y.interval(*time);
        // Where the abscissa turns, slopes are ratios of accelerations.
        if is_at_abscissa && x.as_ref().is_some_and(|x| x.order_of_rest(k, *time) != Some(0)) {
            return true;
        }
        // Without an estimate, the error may be large.
        let error = time_error(&y, &x, k, *time).unwrap_or(f64::INFINITY);
        !(error <= part * range)
    };
    // At an end of the window the abscissa is fixed, too.
    let ends = metric.window.into_iter().flatten().flat_map(|end| crossings(&y, &x, end));
    let ends: Vec<f64> = ends.map(|(k, t)| y.within(k, t)).collect();
    let with_slope = located.iter().filter(|t| is_at_abscissa || ends.contains(t));
    let beside = with_slope.flat_map(|t| beside(metric, &y, *t)).collect::<Vec<_>>();
    located.into_iter().filter(unresolved).chain(beside).collect()
}

/// Times that an extremum of a curve without rates needs in addition: at and beside those whose parabolas are
/// inaccurate.
pub(crate) fn unresolved_extrema(solution: &Solution, metric: &Metric) -> Vec<f64> {
    let signs = metric.take.extrema();
    let has_rates = column(&solution.measured, metric.of).is_some_and(|(_, orders, _)| orders > 1);
    if signs.is_empty() || has_rates {
        return Vec::new();
    }
    let Some((y, x)) = curves_at(solution, metric) else { return Vec::new() };
    let range = range_of(&y);
    signs.iter().flat_map(|sign| unresolved_vertices(metric, &y, &x, *sign, range)).collect()
}

/// Times that an extremum of a curve with rates needs in addition where it is a kink: times between which the kink is.
pub(crate) fn unresolved_corners(solution: &Solution, metric: &Metric) -> Vec<f64> {
    let signs = metric.take.extrema();
    let has_rates = column(&solution.measured, metric.of).is_some_and(|(_, orders, _)| orders > 1);
    if signs.is_empty() || !has_rates {
        return Vec::new();
    }
    let Some((y, x)) = curves_at(solution, metric).filter(|(y, _)| !y.is_located) else { return Vec::new() };
    signs.iter().flat_map(|sign| times_at_corners(metric, &y, &x, *sign)).collect()
}

fn times_at_corners(
    metric: &Metric,
    y: &SampledCurve<'_, f64>,
    x: &Option<SampledCurve<'_, f64>>,
    sign: f64,
) -> Vec<f64> {
    let intervals = 0..y.values.len().saturating_sub(1);
    let corners: Vec<usize> = intervals.filter(|k| y.has_corner(*k, sign) && !y.is_at_corner(*k)).collect();
    if corners.is_empty() {
        return Vec::new();
    }
    let counts = |k: &usize| within_window(metric, abscissa_at(y, x, *k));
    let solved = (0..y.values.len()).filter(counts).map(|k| sign * y.values[k][0]);
    let far_out = solved.fold(f64::NEG_INFINITY, f64::max) - ALIKE * range_of(y);
    let estimates = corners.into_iter().map(|k| (k, y.corner_estimate(k)));
    let is_extreme = |(k, at): &(usize, CornerEstimate)| {
        sign * at.value >= far_out && within_window(metric, along(x, *k, at.time))
    };
    estimates.filter(is_extreme).flat_map(|(_, at)| at.around).collect()
}

/// Part of the range of a curve without rates within which all of its extrema are located: in an optimum several are
/// often equal, and which of them is the largest changes from design to design.
const NEAR: f64 = 0.1;
/// Height that an extremum of a curve without rates may lack since its time is off, as a fraction of the range: the
/// time of an extremum of a sine is then known to `2e-7` of a radian, and its derivative by the design likewise.
const RESOLVED_HEIGHT: f64 = 1e-14;
/// Round-off of a value, relative to it.
const ROUND_OFF: f64 = 1e-13;
/// Distance of the times on both sides of a vertex, as a fraction of the interval of its parabola: beyond the error of
/// the vertex where drivers travel 0.15 rad between two times.
const BESIDE_VERTEX: f64 = 0.03;

/// Error of a vertex, as a fraction of the range, above which its interval is halved as well.
const COARSE: f64 = 1e-5;
/// Interval of a parabola, as a fraction of the run, that is not divided further: next to a kink none is accurate.
const NARROW: f64 = 1e-6;

/// Times at and beside the extrema (sign 1: maxima) of a curve without rates whose parabolas are inaccurate. Only of
/// those that may be the greatest one.
fn unresolved_vertices(
    metric: &Metric,
    y: &SampledCurve<'_, f64>,
    x: &Option<SampledCurve<'_, f64>>,
    sign: f64,
    range: f64,
) -> Vec<f64> {
    let Some((most, _)) = extreme(metric, y, x, sign) else { return Vec::new() };
    let is_near = |vertex: &Vertex<f64>| sign * vertex.value >= sign * most - NEAR * range;
    let is_unresolved = |vertex: &Vertex<f64>| {
        let round_off = ROUND_OFF * vertex.value.abs();
        !vertex.errors.is_some_and(|[value, height]| {
            value <= f64::max(RESOLVED * range, round_off) && height <= RESOLVED_HEIGHT * range
        })
    };
    let run = y.times[y.values.len() - 1] - y.times[0];
    let is_wide = |vertex: &Vertex<f64>| vertex.around[2] - vertex.around[0] > NARROW * run;
    let around = |vertex: Vertex<f64>| {
        let [first, middle, last] = vertex.around;
        let by = BESIDE_VERTEX * (last - first);
        let t = if (vertex.time - middle).abs() < 0.5 * by { middle } else { vertex.time };
        let is_coarse = !vertex.errors.is_some_and(|errors| errors.iter().sum::<f64>() <= COARSE * range);
        let halves = is_coarse.then_some([0.5 * (first + middle), 0.5 * (middle + last)]);
        [t - by, t, t + by].into_iter().chain(halves.into_iter().flatten())
    };
    vertices(metric, y, x, sign)
        .filter(is_near)
        .filter(is_unresolved)
        .filter(is_wide)
        .flat_map(around)
        .collect()
}

/// Extrema (sign 1: maxima) of a curve without rates within the window of a metric.
fn vertices<'c, T: Real>(
    metric: &'c Metric,
    y: &'c SampledCurve<'_, T>,
    x: &'c Option<SampledCurve<'_, T>>,
    sign: f64,
) -> impl Iterator<Item = Vertex<T>> + 'c {
    let found = y.vertices(0..y.values.len(), sign);
    found.filter(|vertex| within_window(metric, along(x, y.interval(vertex.time), vertex.time)))
}

/// Distance of the times beside one at which a slope over a measure without rates is taken, as a fraction of the run:
/// the errors of a central difference by round-off and by its curvature are alike.
const BESIDE: f64 = 1e-4;

/// Times beside one at which a metric is taken over a measure, if there are no rates: at an equilibrium. The derivative
/// at constant abscissa depends on the slope there.
fn beside(metric: &Metric, y: &SampledCurve<'_, f64>, t: f64) -> Vec<f64> {
    let is_slope = metric.take.unit() == ReductionUnit::OutputPerAbscissa;
    if y.orders > 1 || metric.over.is_none() || is_slope {
        return Vec::new();
    }
    let by = BESIDE * (y.times[y.times.len() - 1] - y.times[0]);
    let is_near = |range: [f64; 2]| y.times.iter().any(|time| range[0] < *time && *time < range[1]);
    let sides = [(t - by, [t - 2.0 * by, t]), (t + by, [t, t + 2.0 * by])];
    sides.into_iter().filter(|(_, range)| !is_near(*range)).map(|(time, _)| time).collect()
}

/// Time of the maximum (sign 1) or minimum (-1), unless it is the vertex of a parabola. If the motion is known at
/// `finer` times, also the times of all extrema and ends of the window with about the same value: in a periodic motion
/// any of them may be the largest.
fn far_out_times(
    metric: &Metric,
    y: &SampledCurve<'_, f64>,
    x: &Option<SampledCurve<'_, f64>>,
    sign: f64,
    finer: bool,
) -> Vec<f64> {
    if y.values.len() < 2 {
        return Vec::new();
    }
    let Some((value, time)) = extreme(metric, y, x, sign) else { return Vec::new() };
    let is_vertex = y.orders == 1
        && !y.times.contains(&time)
        && vertices(metric, y, x, sign).any(|vertex| vertex.time == time);
    let mut times: Vec<f64> = (!is_vertex).then_some(time).into_iter().collect();
    if finer {
        let far_out = sign * value - ALIKE * range_of(y);
        // Kinks are located by times on both sides.
        let is_smooth = |k: &usize| !y.has_corner(*k, sign);
        let near = (0..y.values.len() - 1).filter(|k| y.bound(*k, sign) >= far_out).filter(is_smooth);
        let turns = near.flat_map(|k| y.turns(k).into_iter().map(move |t| (k, t)));
        let turns = turns.filter(|(k, t)| within_window(metric, along(x, *k, *t)));
        let cuts = metric.window.into_iter().flatten().flat_map(|end| crossings(y, x, end));
        let alike = turns.chain(cuts).filter(|(k, t)| sign * y.number(*k, *t) >= far_out);
        times.extend(alike.map(|(_, t)| t));
    }
    times
}

/// Times of a solution, by number, whose derivatives those of a metric depend on; `None` if all of them may.
pub(super) fn derivative_times(solution: &Solution, metric: &Metric) -> Option<Vec<usize>> {
    // Those of an extremum: both ends of its interval, or of the two where it is at a time. Of a curve without rates
    // those of any parabola there.
    let of_extremum = |sign: f64| {
        let (y, x) = curves_at(solution, metric)?;
        let Some((_, time)) = extreme(metric, &y, &x, sign) else { return Some(Vec::new()) };
        let times = &y.times[..y.values.len()];
        let [first, after] = [times.partition_point(|t| *t < time), times.partition_point(|t| *t <= time)];
        let is_time = y.is_located || (y.orders == 1 && y.values.len() < 3);
        let last = y.values.len() - 1;
        let run = times[last] - times[0];
        // The derivative at a kink is that of both of its sides.
        let is_beside = |k: &usize| (times[*k] - time).abs() <= AT_CORNER * run;
        Some(if is_time && metric.window.is_none() {
            (first.saturating_sub(1)..=usize::min(after, last)).filter(is_beside).collect()
        } else if y.orders == 1 {
            (first.saturating_sub(2)..=usize::min(after + 1, last)).collect()
        } else {
            (first.saturating_sub(1)..=after).collect()
        })
    };
    match metric.take.part() {
        CurvePart::Ends => Some(vec![0, solution.motion.len().saturating_sub(1)]),
        CurvePart::Place { at, is_slope: false } if solution.motion.len() > 1 => {
            let crossing = curves_at(solution, metric).and_then(|(y, x)| crossings(&y, &x, at).next());
            Some(crossing.map_or(Vec::new(), |(k, _)| vec![k, k + 1]))
        }
        CurvePart::Extrema(signs) => {
            let times: Option<Vec<_>> = signs.iter().map(|sign| of_extremum(*sign)).collect();
            Some(times?.concat())
        }
        CurvePart::Place { .. } | CurvePart::Path(_) | CurvePart::Points(_) => None,
    }
}

/// Solution that metrics are taken of: that between output times, if there is one.
pub(super) fn solution_of(solution: &Solution) -> &Solution {
    solution.between.as_deref().unwrap_or(solution)
}

/// Curve of a metric, and its abscissa if that is not time.
type Curves<'t, T> = (SampledCurve<'t, T>, Option<SampledCurve<'t, T>>);

fn curves<'s>(solution: &'s Solution, metric: &Metric) -> Option<Curves<'s, f64>> {
    curves_at(solution_of(solution), metric)
}

/// True if a metric is the least of the solved times, since it is of one of these clearances, whose minima are located
/// among them.
pub(super) fn is_among(located: &[OutputSource], metric: &Metric) -> bool {
    metric.take == Reduction::Least && metric.window.is_none() && located.contains(&metric.of)
}

/// Curves at the times of the solution itself.
fn curves_at<'s>(solution: &'s Solution, metric: &Metric) -> Option<Curves<'s, f64>> {
    let measured = &solution.measured;
    let (times, rows) = times_and_rows(solution, metric);
    let now = |output: OutputSource| {
        let (m, orders, kinks) = column(measured, output)?;
        let values = rows.iter().map(|k| measured.value(*k, m)).collect();
        let is_located = is_among(&solution.located, metric);
        let orders = if is_located { 1 } else { orders };
        Some(SampledCurve { times, orders, kinks, is_located, values })
    };
    Some((now(metric.of)?, abscissa(metric, now)?))
}

/// Times of the curves of a metric, with their rows in the solution. An integral of straight lines depends on the times
/// between which they are drawn: it has those that do not move with the design, and are the same whatever other metrics
/// there are.
fn times_and_rows<'s>(solution: &'s Solution, metric: &Metric) -> (&'s [f64], Vec<usize>) {
    let Solution { motion, measured, unlocated, .. } = solution;
    let has_rates = |output| column(measured, output).is_none_or(|(_, orders, _)| orders > 1);
    let has_lines = [Some(metric.of), metric.over].into_iter().flatten().any(|output| !has_rates(output));
    if unlocated.is_empty() || !has_lines || metric.take.integral().is_none() {
        return (&motion.times, (0..measured.len()).collect());
    }
    let row = |time: &f64| motion.times.binary_search_by(|t| t.total_cmp(time)).ok();
    match unlocated.iter().map(row).collect() {
        Some(rows) => (unlocated, rows),
        None => (&motion.times, (0..measured.len()).collect()),
    }
}

/// Curves with their derivatives by a variable; `None` if it is not admissible, or if no sensitivities were solved.
fn varied_curves<'s>(
    solution: &'s Solution,
    metric: &Metric,
    variable: VariableId,
) -> Option<Curves<'s, Dual<f64>>> {
    let solution = solution_of(solution);
    let Solution { measured, sensitivities, .. } = solution;
    if sensitivities.variables == 0 {
        return None;
    }
    sensitivities.at(0, variable.0)?;
    let (times, rows) = times_and_rows(solution, metric);
    let varied = |output: OutputSource| {
        let (m, orders, kinks) = column(measured, output)?;
        let number = |k: usize| {
            let (x, d) = (measured.value(k, m), measured.d(k, variable, m));
            [0, 1, 2].map(|order| Dual { v: x[order], d: d[order] })
        };
        let values = rows.iter().copied().map(number).collect();
        let is_located = is_among(&solution.located, metric);
        let orders = if is_located { 1 } else { orders };
        Some(SampledCurve { times, orders, kinks, is_located, values })
    };
    Some((varied(metric.of)?, abscissa(metric, varied)?))
}

/// Parts of a metric with their derivatives: the same number for every design at the same output times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MetricParts {
    /// In SI.
    pub values: Vec<f64>,
    /// Derivatives by every design variable; NaN for those that are not admissible.
    pub d: Vec<Vec<f64>>,
}

impl MetricParts {
    fn of(
        model: &Model,
        solution: &Solution,
        metric: &Metric,
        plain: impl Fn(&Curves<'_, f64>) -> Vec<f64>,
        varied: impl Fn(&Curves<'_, Dual<f64>>) -> Vec<Dual<f64>>,
    ) -> Option<Self> {
        let values = plain(&curves(solution, metric)?);
        let mut d = vec![vec![f64::NAN; model.variables.len()]; values.len()];
        for v in 0..model.variables.len() {
            let found = varied_curves(solution, metric, VariableId(v)).map(|curves| varied(&curves));
            for (row, part) in d.iter_mut().zip(found.into_iter().flatten()) {
                row[v] = part.d;
            }
        }
        values.iter().all(|x| x.is_finite()).then_some(Self { values, d })
    }
}

/// Differences from the target of an `rms` metric, one part for each node of the integral or each point of the target,
/// weighted so that the sum of their squares is the square of the metric; `None` for other metrics, and if the metric
/// has no value.
///
/// ```text
/// r_g = sqrt(abs(dx_g) / sum abs(dx_g)) (y_g - target(x_g)),        r_p = sqrt(1 / points) (y(x_p) - y_p)
/// ```
pub fn misfits(model: &Model, solution: &Solution, metric: &Metric) -> Option<MetricParts> {
    let target = metric.take.target()?;
    curves(solution, metric).and_then(|(y, x)| take(metric, &y, &x))?;
    fn parts<T: Real>((y, x): &Curves<'_, T>, metric: &Metric, target: &[[f64; 2]]) -> Vec<T> {
        if metric.take.integral().is_some() {
            let travel = travel(metric, y, x);
            // The root has no derivative if the abscissa does not move.
            let moving = path_nodes(metric, y, x).filter(|node| node.dx.value() != 0.0);
            moving.map(|n| (n.dx.abs() / travel).sqrt() * (n.y - on_target(target, n.x))).collect()
        } else {
            let left = left_at_points(metric, target, y, x).unwrap_or_default();
            let weight = T::constant((left.len() as f64).sqrt().recip());
            left.into_iter().map(|left| weight * left).collect()
        }
    }
    let plain = |curves: &Curves<'_, f64>| parts(curves, metric, target);
    MetricParts::of(model, solution, metric, plain, |curves| parts(curves, metric, target))
}

/// Maximum (`sign` 1) or minimum (-1) of the curve of a metric in each interval between output times. Intervals beyond
/// its window have the opposite extremum of the whole curve, which cannot decide, with derivative zero.
pub fn peaks(model: &Model, solution: &Solution, metric: &Metric, sign: f64) -> Option<MetricParts> {
    fn parts<T: Real>((y, x): &Curves<'_, T>, ends: &[f64], metric: &Metric, sign: f64) -> Vec<T> {
        let values = y.values.iter().map(|v| v[0].value());
        let least = values.fold(f64::INFINITY, |least, v| least.min(sign * v));
        let inside = |k: usize| within_window(metric, abscissa_at(y, x, k).value());
        // Extremum of one interval between solved times
        let peak = |k: usize| {
            if !(inside(k) && inside(k + 1)) {
                return T::constant(sign * least);
            }
            let mut best = y.corner(k, sign).map_or(y.values[k][0], |(value, _)| value);
            let turns = if y.orders == 1 { Vec::new() } else { y.extrema(k, sign) };
            let turns = turns.into_iter().map(|(value, _)| value);
            let vertices = y.vertices(k..k + 2, sign);
            let vertices = vertices.filter(|v| y.times[k] <= v.time && v.time <= y.times[k + 1]);
            for other in turns.chain(vertices.map(|v| v.value)).chain([y.values[k + 1][0]]) {
                if sign * other.value() > sign * best.value() {
                    best = other;
                }
            }
            best
        };
        // The number of parts must not depend on the times between output times.
        let part = |ends: &[f64]| {
            let [first, last] = [ends[0], ends[1]].map(|end| y.times.partition_point(|t| *t < end));
            let peaks = (first..usize::min(last, y.values.len().saturating_sub(1))).map(peak);
            let higher =
                |best: T, other: T| if sign * other.value() > sign * best.value() { other } else { best };
            peaks.reduce(higher).unwrap_or_else(|| T::constant(sign * least))
        };
        ends.windows(2).map(part).collect()
    }
    let ends = &solution.motion.times[..];
    MetricParts::of(
        model,
        solution,
        metric,
        |curves| parts(curves, ends, metric, sign),
        |curves| parts(curves, ends, metric, sign),
    )
}

/// Column of an output, the number of its known orders, and the values at which it has kinks.
fn column(measured: &MeasureResults, output: OutputSource) -> Option<(usize, usize, &'static [f64])> {
    let m = measured.outputs.iter().position(|o| o.source == output)?;
    let Output { known, kinks, .. } = measured.outputs[m];
    Some((m, known.orders, kinks))
}

/// Abscissa of a metric; `Some(None)` is time.
fn abscissa<C>(metric: &Metric, curve: impl Fn(OutputSource) -> Option<C>) -> Option<Option<C>> {
    metric.over.map_or(Some(None), |over| curve(over).map(Some))
}

/// Estimate of the error of the value at a time of interval k that follows from the abscissa: an error of the abscissa
/// changes the time, and so the value.
fn time_error(y: &SampledCurve<'_, f64>, x: &Option<SampledCurve<'_, f64>>, k: usize, t: f64) -> Option<f64> {
    let early = apart(y, k, t)?[0].abs();
    // abs(dy) + abs(dx) abs(dy/dx)
    let Some(x) = x else { return Some(early) };
    let late = apart(x, k, t)?[0].abs();
    Some(if late == 0.0 { early } else { early + late * y.slope_over(x, k, t).abs() })
}

/// Estimates the interpolation error of the metric between output times. The reference curve consists of polynomials
/// through more output times ([`WidePolynomial`]).
fn interpolation_error(
    metric: &Metric,
    y: &SampledCurve<'_, f64>,
    x: &Option<SampledCurve<'_, f64>>,
    value: f64,
    time: Option<f64>,
) -> Option<f64> {
    let interval = |t: f64| (y.values.len() > 1).then(|| y.interval(t));
    let at_place = |t: f64| interval(t).map_or(Some(0.0), |k| time_error(y, x, k, t));
    match metric.take.part() {
        CurvePart::Place { is_slope: false, .. } => at_place(time?),
        CurvePart::Place { is_slope: true, .. } => {
            let Some(k) = interval(time?) else { return Some(0.0) };
            let time = time?;
            let order = x.as_ref().map_or(Some(0), |x| x.order_of_rest(k, time));
            if order != Some(0) {
                // A ratio of accelerations, which are solved at output times.
                let orders = x.as_ref().map_or(y.orders, |x| usize::min(x.orders, y.orders));
                let is_solved = order == Some(1) && orders > 2 && y.times.contains(&time);
                return is_solved.then_some(0.0);
            }
            let rate =
                |curve: &SampledCurve<'_, f64>| Some([curve.at(k, time)[1], apart(curve, k, time)?[1]]);
            let [dy, wide_dy] = rate(y)?;
            let [dx, wide_dx] = x.as_ref().map_or(Some([1.0, 0.0]), rate)?;
            Some(((dy + wide_dy) / (dx + wide_dx) - dy / dx).abs())
        }
        CurvePart::Extrema([sign]) => {
            let (sign, time) = (*sign, time?);
            let (inside, along) = (|at: f64| within_window(metric, at), |k, t| along(x, k, t));
            let cut = x.as_ref().is_some_and(|x| {
                let at = interval(time).map_or(f64::NAN, |k| x.number(k, time));
                metric
                    .window
                    .into_iter()
                    .flatten()
                    .any(|end| (at - end).abs() <= THERE * end.abs().max(THERE))
            });
            let vertex = vertices(metric, y, x, sign).find(|vertex| vertex.time == time);
            let here = match interval(time) {
                None => 0.0,
                Some(_) if vertex.is_some() => vertex?.errors?.iter().sum(),
                Some(_) if cut => at_place(time)?,
                Some(k) => apart(y, k, time)?[0].abs(),
            };
            // The curve may have a larger value elsewhere.
            let mut beyond: f64 = 0.0;
            for k in 0..y.values.len() - 1 {
                let Some(wide) = WidePolynomial::new(y, k) else { continue };
                let h = y.times[k + 1] - y.times[k];
                let places = (1..PLACES).map(|i| y.times[k] + h * f64::from(i) / f64::from(PLACES));
                for t in places.filter(|t| inside(along(k, *t))) {
                    beyond = beyond.max(sign * (wide.at(t)[0] - value));
                }
            }
            Some(here.max(beyond))
        }
        CurvePart::Extrema(signs) => {
            let of = |sign: &f64| {
                let take_end = if *sign > 0.0 { Reduction::Greatest } else { Reduction::Least };
                let end = Metric { take: take_end, ..metric.clone() };
                let (value, time) = take(&end, y, x)?;
                interpolation_error(&end, y, x, value, time)
            };
            signs.iter().map(of).sum()
        }
        CurvePart::Ends => Some(0.0),
        CurvePart::Path(_) => path_error(metric, y, x, value),
        CurvePart::Points(points) => {
            // The root mean square of the errors at the points
            let counting = points.iter().filter(|p| within_window(metric, p[0]));
            let errors = counting.map(|p| crossings(y, x, p[0]).next().and_then(|(_, t)| at_place(t)));
            let errors: Vec<f64> = errors.collect::<Option<_>>()?;
            Some((errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt())
        }
    }
}

/// Number of parts of an interval, at whose ends a curve between output times is evaluated.
const PLACES: u32 = 8;

/// Value of a metric's reduction, and its time.
fn take<T: Real>(
    metric: &Metric,
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
) -> Option<(T, Option<f64>)> {
    if y.values.is_empty() {
        return None;
    }
    if let ([_], CurvePart::Place { at, is_slope }) = (&y.values[..], metric.take.part()) {
        return take_at_single_time(at, is_slope, y, x).map(|value| (value, Some(y.times[0])));
    }
    match &metric.take {
        Reduction::Greatest => extreme(metric, y, x, 1.0).map(|(v, t)| (v, Some(t))),
        Reduction::Least => extreme(metric, y, x, -1.0).map(|(v, t)| (v, Some(t))),
        Reduction::Range => {
            let ends = extreme(metric, y, x, 1.0).zip(extreme(metric, y, x, -1.0));
            ends.map(|((most, _), (least, _))| (most - least, None))
        }
        Reduction::Change => {
            let [first, last] = [y.values.first()?, y.values.last()?];
            Some((last[0] - first[0], None))
        }
        Reduction::Value(at) => {
            let (k, t) = crossings(y, x, *at).next()?;
            Some((y.value_over(x.as_ref(), k, t, *at), Some(y.within(k, t))))
        }
        Reduction::Slope(at) => {
            let (k, t) = crossings(y, x, *at).next()?;
            Some((slope_at(y, x.as_ref(), k, t, *at), Some(y.within(k, t))))
        }
        Reduction::Mean | Reduction::Integral | Reduction::Rms(_) => {
            metric.take.integral()?.value(path_nodes(metric, y, x)).map(|value| (value, None))
        }
        Reduction::RmsAtPoints(points) => {
            let left = left_at_points(metric, points, y, x)?;
            let squares = left.iter().fold(T::zero(), |sum, left| sum + *left * *left);
            Some(((squares * T::constant((left.len() as f64).recip())).sqrt(), None))
        }
    }
}

/// Slope at a time of interval k at which the abscissa is `at`, with the derivative at constant abscissa.
fn slope_at<T: Real>(
    y: &SampledCurve<'_, T>,
    x: Option<&SampledCurve<'_, T>>,
    k: usize,
    t: f64,
    at: f64,
) -> T {
    let Some(x) = x else { return y.at(k, T::constant(t))[1] };
    let slope = y.slope_over(x, k, t);
    let [place, rate] = x.at(k, T::constant(t));
    let miss = T::constant(at) - place;
    if miss.vanishes() {
        return slope;
    }
    if x.order_of_rest(k, t) != Some(0) {
        // It would need derivatives of the fourth order.
        return slope + unknown_change(miss);
    }
    // dy/dx = y. / x.  at the time at which x = at
    let moved = T::constant(t) + miss / rate;
    y.at(k, moved)[1] / x.at(k, moved)[1]
}

/// Value or slope where the abscissa is `at`, of a motion with one output time: a curve that is one point with its
/// rates.
fn take_at_single_time<T: Real>(
    at: f64,
    is_slope: bool,
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
) -> Option<T> {
    let [value, rate, _] = y.values[0];
    let place = x.as_ref().map_or(T::constant(y.times[0]), |x| x.values[0][0]);
    if !((place.value() - at).abs() <= THERE * at.abs().max(1.0)) {
        return None;
    }
    // dy/dx = y. / x.
    let slope = |x: &SampledCurve<'_, T>| (x.orders > 1 && y.orders > 1).then(|| rate / x.values[0][1]);
    match x {
        Some(x) if is_slope => slope(x),
        None if is_slope => (y.orders > 1).then_some(rate),
        // The abscissa is fixed and the time varies:  y(x = at) = y + (at - x) y. / x.
        Some(x) if x.values[0][1].value() != 0.0 => {
            let moved = slope(x).map_or(T::constant(0.0), |slope| (T::constant(at) - place) * slope);
            Some(value + moved)
        }
        Some(_) | None => Some(value),
    }
}

/// Differences from a target at each of its points within the window, at the first time when the abscissa reaches it;
/// `None` if there is no such point, or if one is not reached.
fn left_at_points<T: Real>(
    metric: &Metric,
    points: &[[f64; 2]],
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
) -> Option<Vec<T>> {
    let left = |[at, target]: &[f64; 2]| {
        let (k, t) = crossings(y, x, *at).next()?;
        Some(y.value_over(x.as_ref(), k, t, *at) - T::constant(*target))
    };
    let counting = points.iter().filter(|p| within_window(metric, p[0]));
    counting.map(left).collect::<Option<Vec<T>>>().filter(|left| !left.is_empty())
}

/// True if this abscissa is within the window.
fn within_window(metric: &Metric, at: f64) -> bool {
    metric.window.is_none_or(|[low, high]| low <= at && at <= high)
}

/// Maximum (sign 1) or minimum (-1) while the abscissa is in the window, and its time.
fn extreme<T: Real>(
    metric: &Metric,
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
    sign: f64,
) -> Option<(T, f64)> {
    let inside = |at: f64| within_window(metric, at);
    let along = |k: usize, t: f64| along(x, k, t);
    let mut best: Option<(T, f64)> = None;
    let mut offer = |value: T, t: f64| {
        let better = best.is_none_or(|(most, _)| sign * value.value() > sign * most.value());
        if value.value().is_finite() && better {
            best = Some((value, t));
        }
    };
    let last = y.values.len() - 1;
    // Before the ends of their intervals, which have the derivative of one side.
    for (value, t) in (0..last).filter_map(|k| y.corner(k, sign)) {
        if inside(along(y.interval(t), t)) {
            offer(value, t);
        }
    }
    // Times at an end of the window are among the crossings: round-off does not decide between their derivatives.
    let abscissa = x.as_ref().filter(|_| last > 0);
    let ends =
        abscissa.into_iter().flat_map(|x| metric.window.into_iter().flatten().map(move |end| (x, end)));
    let ends: Vec<_> = ends.map(|(x, end)| (x, end, x.farthest(end))).collect();
    let is_at_end = |k: usize| ends.iter().any(|(x, end, farthest)| x.is_at(k, *end, *farthest));
    let counts = |k: usize| inside(abscissa_at(y, x, k).value()) && !is_at_end(k);
    let at_times = (0..=last).filter(|k| counts(*k)).map(|k| sign * y.values[k][0].value());
    let most = at_times.fold(f64::NEG_INFINITY, f64::max);
    for k in 0..=last {
        let t = y.times[k];
        if counts(k) {
            offer(y.values[k][0], t);
        }
        // If the bound of an interval is below the maximum so far, none of its extrema is the maximum.
        if k == last || y.orders == 1 || y.bound(k, sign) <= most {
            continue;
        }
        for (value, turn) in y.extrema(k, sign) {
            if inside(along(k, turn)) {
                offer(value, turn);
            }
        }
    }
    for vertex in vertices(metric, y, x, sign) {
        offer(vertex.value, vertex.time);
    }
    // At an end of the window the abscissa is fixed and the time varies.
    for end in metric.window.into_iter().flatten() {
        for (k, t) in crossings(y, x, end) {
            offer(y.value_over(x.as_ref(), k, t, end), y.within(k, t));
        }
    }
    best.map(|(value, t)| (at_kink(y, value).map_or(value, T::constant), t))
}

/// The kink from which this value of a curve without rates cannot be distinguished. There a magnitude has its
/// least value, which no change of the design makes less.
fn at_kink<T: Real>(y: &SampledCurve<'_, T>, value: T) -> Option<f64> {
    if y.orders > 1 || y.kinks.is_empty() {
        return None;
    }
    let near = RESOLVED * range_of(y);
    y.kinks.iter().copied().find(|kink| (value.value() - kink).abs() < near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_target_goes_on_in_straight_lines() {
        let target = [[0.0, 1.0], [1.0, 3.0], [2.0, 3.0]];
        for (at, expected) in [(-1.0, -1.0), (0.5, 2.0), (1.5, 3.0), (9.0, 3.0)] {
            assert_eq!(on_target(&target, at), expected);
        }
        assert_eq!(on_target(&[], 4.0), 0.0);
    }
}

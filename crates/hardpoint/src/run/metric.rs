//! Metrics of a solved motion, with their exact derivatives by the design variables.
//!
//! A metric is written once over any number; its derivatives are the same lines run on duals. Between output times, curves
//! are the polynomials that have their values, rates and accelerations at both ends.

use super::quadrature::{NODES, PathNode, Stretch, path_nodes, path_stretches};
use super::solution::Solution;
use crate::measure::Measured;
use crate::model::{Metric, Model, OutputSource, Reduction, VariableId, on_target};
use crate::number::{Dual, Real};

/// The value of a metric.
#[derive(Clone, Debug, PartialEq)]
pub struct MetricValue {
    /// In SI; `None` where the motion does not reach what is asked for.
    pub value: Option<f64>,
    /// When it is taken, s; `None` for what is taken of the whole curve.
    pub time: Option<f64>,
    /// How far interpolation between output times may be off, in SI; `None` where the metric was solved at its own time, and where there
    /// are not enough output times to estimate it.
    pub error: Option<f64>,
    /// Scale of the error, in SI: greatest less least value of the curve, for an integral times the travel of its abscissa, for a slope
    /// its own size.
    pub range: f64,
    /// Its derivative by every design variable; NaN for those that the mechanism cannot follow, and all of them where no
    /// sensitivities were solved.
    pub d: Vec<f64>,
}

/// The values of all metrics of a model.
pub fn metrics(model: &Model, solution: &Solution) -> Vec<MetricValue> {
    model.metrics.iter().map(|metric| metric_value(model, solution, metric)).collect()
}

/// The values of another design's metrics, to be compared with today's. Where its motion ends before today's, what a metric takes of the
/// whole curve is not known: a part of the curve says nothing of the rest.
pub fn metrics_beside(model: &Model, today: &Solution, other: &Solution) -> Vec<Option<f64>> {
    let whole = other.motion.len() >= today.motion.len();
    let known = |metric: &Metric| {
        whole || matches!(metric.take, Reduction::Value(_) | Reduction::Slope(_) | Reduction::RmsAtPoints(_))
    };
    let values = model.metrics.iter().zip(metrics(model, other));
    values.map(|(metric, found)| found.value.filter(|_| known(metric))).collect()
}

/// The same without derivatives, times and errors: what many designs are compared by.
pub fn metric_numbers<'m>(
    model: &'m Model,
    solution: &'m Solution,
) -> impl Iterator<Item = Option<f64>> + 'm {
    model.metrics.iter().map(|metric| metric_number(metric, solution))
}

/// The same of one metric.
pub(crate) fn metric_number(metric: &Metric, solution: &Solution) -> Option<f64> {
    let (y, x) = curves(solution, metric)?;
    take(metric, &y, &x).map(|(value, _)| value)
}

/// The place that a metric of the whole model has among those of the motion of a number, if it is taken of that.
pub(crate) fn place_of(model: &Model, metric: usize, number: usize) -> Option<usize> {
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
    let Some((y, x)) = curves(solution, metric) else { return none };
    let Some((value, time)) = take(metric, &y, &x).filter(|(value, _)| value.is_finite()) else {
        return none;
    };
    let derivative = |v: usize| {
        let found = varied_curves(solution, metric, VariableId(v));
        found.and_then(|(y, x)| take(metric, &y, &x)).map_or(f64::NAN, |(value, _)| value.d)
    };
    // Solved between output times, it is taken at times that were solved; no integral is, nor an extremum that lies between times for
    // which no rates are known.
    let hidden = match metric.take {
        Reduction::Mean | Reduction::Integral | Reduction::Rms(_) => true,
        Reduction::Least | Reduction::Greatest | Reduction::Range => y.orders == 1,
        Reduction::RmsAtPoints(_) | Reduction::Value(_) | Reduction::Slope(_) => false,
    };
    let resolved = !hidden
        && solution.between.is_some()
        && unresolved_times(solution_of(solution), metric, true).is_empty();
    let error = if resolved { None } else { interpolation_error(metric, &y, &x, value, time) };
    let range = match metric.take {
        Reduction::Slope(_) => value.abs(),
        Reduction::Integral => range_of(&y) * travel(metric, &y, &x),
        Reduction::Least
        | Reduction::Greatest
        | Reduction::Range
        | Reduction::Mean
        | Reduction::Rms(_)
        | Reduction::RmsAtPoints(_)
        | Reduction::Value(_) => range_of(&y),
    };
    MetricValue {
        value: Some(value),
        time,
        error,
        range,
        d: (0..model.variables.len()).map(derivative).collect(),
    }
}

/// A turn of a curve within this part of its range of the farthest one may be the farthest where the curve was not solved at either.
const ALIKE: f64 = 1e-4;
/// An interpolation error below this part of the curve's range counts for nothing where the motion was solved between output times ...
const RESOLVED: f64 = 1e-10;
/// ... and where the output times show the curve by themselves: metrics are read to some digits, and many designs are solved for them.
const RESOLVED_BY_OUTPUTS: f64 = 1e-7;

/// The greatest less the least value of a curve at its times.
fn range_of(y: &SampledCurve<'_, f64>) -> f64 {
    let finite = || y.values.iter().map(|v| v[0]).filter(|x| x.is_finite());
    finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min)
}

/// The times at which a metric over time is taken, or its window ends.
pub(crate) fn window_times(metric: &Metric) -> Vec<f64> {
    if metric.over.is_some() {
        return Vec::new();
    }
    let at = match &metric.take {
        Reduction::Value(at) | Reduction::Slope(at) => vec![*at],
        Reduction::RmsAtPoints(points) => points.iter().map(|p| p[0]).collect(),
        Reduction::Least
        | Reduction::Greatest
        | Reduction::Range
        | Reduction::Mean
        | Reduction::Integral
        | Reduction::Rms(_) => Vec::new(),
    };
    metric.window.into_iter().flatten().chain(at).collect()
}

/// The times between those of a solution that a metric needs: those that it is taken at by interpolation that may be off, and for an
/// integral those that halve the intervals where it is off; `finer` says that the solution has times between the output times.
pub(crate) fn unresolved_times(solution: &Solution, metric: &Metric, finer: bool) -> Vec<f64> {
    let Some((y, x)) = curves_at(solution, metric) else { return Vec::new() };
    let range = range_of(&y);
    let located = match &metric.take {
        Reduction::Greatest => far_out_times(metric, &y, &x, 1.0, finer),
        Reduction::Least => far_out_times(metric, &y, &x, -1.0, finer),
        Reduction::Range => [1.0, -1.0].map(|sign| far_out_times(metric, &y, &x, sign, finer)).concat(),
        Reduction::Value(at) | Reduction::Slope(at) => {
            crossings(&y, &x, *at).map(|(_, t)| t).take(1).collect()
        }
        Reduction::RmsAtPoints(points) => {
            let counting = points.iter().filter(|p| within_window(metric, p[0]));
            counting.filter_map(|p| crossings(&y, &x, p[0]).next()).map(|(k, t)| y.within(k, t)).collect()
        }
        Reduction::Mean | Reduction::Integral | Reduction::Rms(_) => {
            return coarse_middles(metric, &y, &x, RESOLVED_BY_OUTPUTS * range);
        }
    };
    let part = if finer { RESOLVED } else { RESOLVED_BY_OUTPUTS };
    let unresolved = |time: &f64| {
        if y.times.contains(time) {
            return false;
        }
        let k = y.interval(*time);
        // Where too little is known to say, it may be off.
        let error = time_error(&y, &x, k, *time).unwrap_or(f64::INFINITY);
        !(error <= part * range)
    };
    located.into_iter().filter(unresolved).collect()
}

/// The time of the greatest (sign 1) or the least value (-1); where the motion is known at `finer` times, those of all turns and ends of
/// the window that are about as far out, too: of a motion that repeats itself, any may be the one.
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
    let mut times = vec![time];
    if finer {
        let far_out = sign * value - ALIKE * range_of(y);
        let near = (0..y.values.len() - 1).filter(|k| y.bound(*k, sign) >= far_out);
        let turns = near.flat_map(|k| y.turns(k).into_iter().map(move |t| (k, t)));
        let turns = turns.filter(|(k, t)| within_window(metric, along(x, *k, *t)));
        let cuts = metric.window.into_iter().flatten().flat_map(|end| crossings(y, x, end));
        let alike = turns.chain(cuts).filter(|(k, t)| sign * y.number(*k, *t) >= far_out);
        times.extend(alike.map(|(_, t)| t));
    }
    times
}

/// The middles of those parts of the path that contribute most to the error of an integral, if that is more than `tolerance` (of `rms` and
/// `mean`; of `integral` as a part of the travel). None where rates are unknown: there the error falls with the square of the steps only.
fn coarse_middles(
    metric: &Metric,
    y: &SampledCurve<'_, f64>,
    x: &Option<SampledCurve<'_, f64>>,
    tolerance: f64,
) -> Vec<f64> {
    if y.orders == 1 {
        return Vec::new();
    }
    let stretches = path_stretches(metric, y, x);
    let Some(value) = integral(metric, stretches.iter().flat_map(|s| s.nodes(y, x))) else {
        return Vec::new();
    };
    // Most curves are resolved by far, and so are their polynomials of lower degree.
    let mut errors = Vec::new();
    for other in [lower, wide] {
        let found = integral_errors(metric, (y, x), &stretches, value, other);
        let scale = if metric.take == Reduction::Integral { found.travel } else { 1.0 };
        if integral_error(metric, value, &found.of, found.travel)
            .is_some_and(|error| error <= tolerance * scale)
        {
            return Vec::new();
        }
        errors = found.of;
    }
    // Where too little is known to say, it may be off.
    let size = |error: &Option<f64>| error.unwrap_or(f64::INFINITY);
    let most = errors.iter().map(|(_, error)| size(error)).fold(0.0, f64::max);
    let large = errors.iter().filter(|(_, error)| size(error) >= COARSE * most);
    large.map(|(stretch, _)| 0.5 * (y.times[stretch.k] + y.times[stretch.k + 1])).collect()
}

/// Parts of the path with at least this part of the largest contribution to the error of an integral are halved: of a smooth curve many,
/// of one with a kink the one where that is.
const COARSE: f64 = 1.0 / 64.0;

/// What parts of the path contribute to the error of an integral; `None` where too little is known.
struct IntegralErrors {
    of: Vec<(Stretch<f64>, Option<f64>)>,
    /// Of the abscissa within the window, to and fro.
    travel: f64,
}

/// A polynomial that says how far the one of an interval may be from the curve.
enum OtherPolynomial {
    Lower(Polynomial<f64>),
    Wide(WidePolynomial),
}

impl OtherPolynomial {
    /// Value and rate.
    fn at(&self, t: f64) -> [f64; 2] {
        match self {
            Self::Lower(polynomial) => polynomial.at(t),
            Self::Wide(polynomial) => polynomial.at(t),
        }
    }
}

/// The polynomial of interval k without the highest order that is known at its ends: farther from the curve than its own.
fn lower(curve: &SampledCurve<'_, f64>, k: usize) -> Option<OtherPolynomial> {
    let known = usize::min(curve.known(k), curve.known(k + 1));
    (known > 1).then(|| OtherPolynomial::Lower(curve.polynomial_of(k, known - 1)))
}

/// The polynomial through more times: nearer to the curve than the interval's own.
fn wide(curve: &SampledCurve<'_, f64>, k: usize) -> Option<OtherPolynomial> {
    WidePolynomial::new(curve, k).map(OtherPolynomial::Wide)
}

/// The contribution of each part of the path to the error of an integral: the difference between other polynomials ([`wide`] or
/// [`lower`]) and the interval's own.
fn integral_errors(
    metric: &Metric,
    (y, x): (&SampledCurve<'_, f64>, &Option<SampledCurve<'_, f64>>),
    stretches: &[Stretch<f64>],
    value: f64,
    other: fn(&SampledCurve<'_, f64>, usize) -> Option<OtherPolynomial>,
) -> IntegralErrors {
    // What is integrated, less its mean: an error of the travel counts for that much less.
    let integrand = |at: f64, y: f64| match &metric.take {
        Reduction::Mean => y - value,
        Reduction::Rms(target) => (y - on_target(target, at)).powi(2) - value * value,
        Reduction::Least
        | Reduction::Greatest
        | Reduction::Range
        | Reduction::Integral
        | Reduction::RmsAtPoints(_)
        | Reduction::Value(_)
        | Reduction::Slope(_) => y,
    };
    let mut travel = 0.0;
    let mut error = |stretch: &Stretch<f64>| {
        let k = stretch.k;
        let nodes: [PathNode<f64>; NODES] = stretch.nodes(y, x);
        travel += nodes.iter().map(|node| node.dx.abs()).sum::<f64>();
        let other_y = other(y, k)?;
        let other_x = x.as_ref().map_or(Some(None), |x| other(x, k).map(Some))?;
        let along = |t: f64| other_x.as_ref().map_or([t, 1.0], |x| x.at(t));
        let apart = nodes.iter().map(|node| {
            let [at, rate] = along(node.t);
            integrand(at, other_y.at(node.t)[0]) * rate * node.dt - integrand(node.x, node.y) * node.dx
        });
        // Where the window cuts the curve, an error of the abscissa moves the cut.
        let moved = [stretch.from, stretch.to].into_iter().filter(|t| !y.times.contains(t)).map(|t| {
            let own = x.as_ref().map_or(t, |x| x.number(k, t));
            (integrand(own, y.number(k, t)) * (along(t)[0] - own)).abs()
        });
        Some(apart.sum::<f64>().abs() + moved.sum::<f64>())
    };
    let of = stretches.iter().map(|stretch| (*stretch, error(stretch))).collect();
    IntegralErrors { of, travel }
}

/// The error of an integral over the path from the contributions to it.
fn integral_error(
    metric: &Metric,
    value: f64,
    errors: &[(Stretch<f64>, Option<f64>)],
    travel: f64,
) -> Option<f64> {
    let sum: f64 = errors.iter().map(|(_, error)| *error).sum::<Option<f64>>()?;
    let mean = sum / travel;
    Some(match metric.take {
        Reduction::Mean => mean,
        // sqrt(rms^2 + error of the mean square) - rms
        Reduction::Rms(_) => (value * value + mean).sqrt() - value,
        Reduction::Least
        | Reduction::Greatest
        | Reduction::Range
        | Reduction::Integral
        | Reduction::RmsAtPoints(_)
        | Reduction::Value(_)
        | Reduction::Slope(_) => sum,
    })
}

/// The travel of the abscissa within the window, to and fro.
fn travel<T: Real>(metric: &Metric, y: &SampledCurve<'_, T>, x: &Option<SampledCurve<'_, T>>) -> T {
    path_nodes(metric, y, x).fold(T::zero(), |sum, node| sum + node.dx.abs())
}

/// The solution that metrics are taken of: that between output times, where there is one.
fn solution_of(solution: &Solution) -> &Solution {
    solution.between.as_deref().unwrap_or(solution)
}

/// The curve that a metric is taken of, and the one that it goes over where that is not time.
type Curves<'t, T> = (SampledCurve<'t, T>, Option<SampledCurve<'t, T>>);

fn curves<'s>(solution: &'s Solution, metric: &Metric) -> Option<Curves<'s, f64>> {
    curves_at(solution_of(solution), metric)
}

/// The same at the times of a solution itself.
fn curves_at<'s>(solution: &'s Solution, metric: &Metric) -> Option<Curves<'s, f64>> {
    let (measured, times) = (&solution.measured, &solution.motion.times[..]);
    let now = |output: OutputSource| {
        let (m, orders) = column(measured, output)?;
        let values = (0..measured.len()).map(|k| measured.value(k, m)).collect();
        Some(SampledCurve { times, orders, values })
    };
    Some((now(metric.of)?, abscissa(metric, now)?))
}

/// The same with their derivatives by a variable; `None` where the mechanism cannot follow it or no sensitivities were solved.
fn varied_curves<'s>(
    solution: &'s Solution,
    metric: &Metric,
    variable: VariableId,
) -> Option<Curves<'s, Dual<f64>>> {
    let Solution { motion, measured, sensitivities, .. } = solution_of(solution);
    if sensitivities.variables == 0 {
        return None;
    }
    sensitivities.at(0, variable.0)?;
    let varied = |output: OutputSource| {
        let (m, orders) = column(measured, output)?;
        let number = |k: usize| {
            let (x, d) = (measured.value(k, m), measured.d(k, variable, m));
            [0, 1, 2].map(|order| Dual { v: x[order], d: d[order] })
        };
        let values = (0..measured.len()).map(number).collect();
        Some(SampledCurve { times: &motion.times[..], orders, values })
    };
    Some((varied(metric.of)?, abscissa(metric, varied)?))
}

/// What a metric is made of, each part with its derivatives: as many for every design at the same output times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MetricParts {
    /// In SI.
    pub values: Vec<f64>,
    /// By every design variable; NaN for those that the mechanism cannot follow.
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

/// What is left beyond the target of an `rms` metric, one part for each node of the integral or each point of the target, so weighted that
/// the sum of their squares is that of the metric; `None` for other metrics, and where the metric has no value.
///
/// ```text
/// r_g = sqrt(abs(dx_g) / sum abs(dx_g)) (y_g - target(x_g)),        r_p = sqrt(1 / points) (y(x_p) - y_p)
/// ```
pub fn misfits(model: &Model, solution: &Solution, metric: &Metric) -> Option<MetricParts> {
    metric.take.target()?;
    curves(solution, metric).and_then(|(y, x)| take(metric, &y, &x))?;
    fn parts<T: Real>((y, x): &Curves<'_, T>, metric: &Metric) -> Vec<T> {
        match &metric.take {
            Reduction::Rms(target) => {
                let travel = travel(metric, y, x);
                // The root has no derivative where the abscissa rests.
                let moving = path_nodes(metric, y, x).filter(|node| node.dx.value() != 0.0);
                moving.map(|n| (n.dx.abs() / travel).sqrt() * (n.y - on_target(target, n.x))).collect()
            }
            Reduction::RmsAtPoints(points) => {
                let left = left_at_points(metric, points, y, x).unwrap_or_default();
                let weight = T::constant((left.len() as f64).sqrt().recip());
                left.into_iter().map(|left| weight * left).collect()
            }
            Reduction::Least
            | Reduction::Greatest
            | Reduction::Range
            | Reduction::Mean
            | Reduction::Integral
            | Reduction::Value(_)
            | Reduction::Slope(_) => Vec::new(),
        }
    }
    MetricParts::of(model, solution, metric, |curves| parts(curves, metric), |curves| parts(curves, metric))
}

/// The greatest value (for `sign` 1) or the least (for -1) of the curve of a metric in each interval between output times; in those beyond
/// its window, the value of the metric's whole curve at the other end, which has no say, and no derivative.
pub fn peaks(model: &Model, solution: &Solution, metric: &Metric, sign: f64) -> Option<MetricParts> {
    fn parts<T: Real>((y, x): &Curves<'_, T>, ends: &[f64], metric: &Metric, sign: f64) -> Vec<T> {
        let values = y.values.iter().map(|v| v[0].value());
        let least = values.fold(f64::INFINITY, |least, v| least.min(sign * v));
        let inside = |k: usize| within_window(metric, abscissa_at(y, x, k).value());
        // Of one interval between the times that were solved
        let peak = |k: usize| {
            if !(inside(k) && inside(k + 1)) {
                return T::constant(sign * least);
            }
            let mut best = y.values[k][0];
            let turns = if y.orders == 1 { Vec::new() } else { y.turns(k) };
            let turns = turns.into_iter().map(|t| y.at(k, T::constant(t))[0]);
            for other in turns.chain([y.values[k + 1][0]]) {
                if sign * other.value() > sign * best.value() {
                    best = other;
                }
            }
            best
        };
        // As many parts for every design, at whatever times between the output times it was solved.
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

/// The column of an output, and how many orders of it are known.
fn column(measured: &Measured, output: OutputSource) -> Option<(usize, usize)> {
    let m = measured.outputs.iter().position(|o| o.source == output)?;
    Some((m, measured.outputs[m].known.orders))
}

/// The abscissa of a metric; `Some(None)` is time.
fn abscissa<C>(metric: &Metric, curve: impl Fn(OutputSource) -> Option<C>) -> Option<Option<C>> {
    metric.over.map_or(Some(None), |over| curve(over).map(Some))
}

/// A curve over time: at each time so many of its value, rate and acceleration.
pub(super) struct SampledCurve<'t, T> {
    pub(super) times: &'t [f64],
    orders: usize,
    pub(super) values: Vec<[T; 3]>,
}

/// The polynomial of a curve in one interval.
pub(super) struct Polynomial<T> {
    from: f64,
    length: f64,
    /// Coefficients in the part of the interval that has passed.
    c: [T; 6],
}

impl<T: Real> Polynomial<T> {
    /// Value and rate at a time.
    pub(super) fn at(&self, t: T) -> [T; 2] {
        let (c, h) = (T::constant, self.length);
        let s = (t - c(self.from)) / c(h);
        let [c0, c1, c2, c3, c4, c5] = self.c;
        let value = c0 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
        let slope = c1 + s * (c(2.0) * c2 + s * (c(3.0) * c3 + s * (c(4.0) * c4 + s * c(5.0) * c5)));
        [value, slope / c(h)]
    }
}

impl<T: Real> SampledCurve<'_, T> {
    /// The number of orders that are known at a time: at a kink the value alone.
    fn known(&self, k: usize) -> usize {
        self.values[k][..self.orders].iter().take_while(|x| x.value().is_finite()).count()
    }

    /// The interval of a time.
    fn interval(&self, t: f64) -> usize {
        let after = self.times[..self.values.len()].partition_point(|end| *end <= t);
        after.clamp(1, self.values.len() - 1) - 1
    }

    /// The polynomial of interval k with the values, rates and accelerations that are known at its ends.
    pub(super) fn polynomial(&self, k: usize) -> Polynomial<T> {
        self.polynomial_of(k, self.orders)
    }

    /// The polynomial with so many of them at most.
    fn polynomial_of(&self, k: usize, orders: usize) -> Polynomial<T> {
        let length = self.times[k + 1] - self.times[k];
        let known = [k, k + 1].map(|end| self.known(end).min(orders));
        Polynomial { from: self.times[k], length, c: self.coefficients(k, length, known) }
    }

    fn coefficients(&self, k: usize, h: f64, known: [usize; 2]) -> [T; 6] {
        let ([a, b], c) = ([&self.values[k], &self.values[k + 1]], T::constant);
        // p(s) = c0 + c1 s + ... + c5 s^5,  s = (t - t_k) / h,  with y, h y., h^2 y.. at s = 0 and s = 1
        let zero = c(0.0);
        // Newton's form on [0, 0, 0, 1, 1, 1], or with fewer ends of each.
        let [a0, a1, a2] = [a[0], a[1] * c(h), a[2] * c(0.5 * h * h)];
        let [b0, b1, b2] = [b[0], b[1] * c(h), b[2] * c(0.5 * h * h)];
        match known {
            [3, 3] => {
                // What is left of value, rate and half the acceleration at s = 1.
                let p = b0 - a0 - a1 - a2;
                let q = b1 - a1 - c(2.0) * a2;
                let r = b2 - a2;
                let c3 = c(10.0) * p - c(4.0) * q + r;
                let c4 = c(-15.0) * p + c(7.0) * q - c(2.0) * r;
                [a0, a1, a2, c3, c4, c(6.0) * p - c(3.0) * q + r]
            }
            [2 | 3, 2 | 3] => {
                let rise = b0 - a0;
                [a0, a1, c(3.0) * rise - c(2.0) * a1 - b1, a1 + b1 - c(2.0) * rise, zero, zero]
            }
            // A kink at one end: all that is known at the other.
            [3, _] => [a0, a1, a2, b0 - a0 - a1 - a2, zero, zero],
            [2, _] => [a0, a1, b0 - a0 - a1, zero, zero, zero],
            [_, 3] => {
                // b0 - b1 u + b2 u^2 + q u^3,  u = 1 - s
                let q = a0 - b0 + b1 - b2;
                [a0, b1 - c(2.0) * b2 - c(3.0) * q, b2 + c(3.0) * q, -q, zero, zero]
            }
            [_, 2] => {
                let q = a0 - b0 + b1;
                [a0, b1 - c(2.0) * q, q, zero, zero, zero]
            }
            [_, _] => [a0, b0 - a0, zero, zero, zero, zero],
        }
    }

    /// Value and rate at a time of interval k.
    fn at(&self, k: usize, t: T) -> [T; 2] {
        self.polynomial(k).at(t)
    }

    /// The parts of interval k in which the curve rises or falls all along.
    pub(super) fn monotone(
        times: &[f64],
        curve: Option<&Self>,
        k: usize,
    ) -> impl Iterator<Item = [f64; 2]> + use<T> {
        let turns = curve.map_or(Vec::new(), |curve| curve.turns(k));
        let mut from = times[k];
        turns.into_iter().chain([times[k + 1]]).map(move |to| [std::mem::replace(&mut from, to), to])
    }

    /// The times inside interval k where the curve turns.
    fn turns(&self, k: usize) -> Vec<f64> {
        // Where the coefficients in Bernstein's form rise or fall all along, so does the polynomial.
        let coefficients = self.bernstein(k);
        if coefficients.is_some_and(|b| b.is_sorted() || b.iter().rev().is_sorted()) {
            return Vec::new();
        }
        let Polynomial { from, length, c } = self.polynomial(k);
        let c = c.map(|c| c.value());
        let rate = [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 5.0 * c[5]];
        roots(&rate).into_iter().map(|s| from + s * length).collect()
    }

    /// What the polynomial of interval k nowhere exceeds, times `sign`: the greatest of its coefficients in Bernstein's form.
    fn bound(&self, k: usize, sign: f64) -> f64 {
        // Beside a kink or a gap nothing is said.
        let Some(coefficients) = self.bernstein(k) else { return f64::INFINITY };
        coefficients.into_iter().fold(f64::NEG_INFINITY, |most, c| most.max(sign * c))
    }

    /// The coefficients of the polynomial of interval k in Bernstein's form, of a cubic the inner ones twice; none beside a kink or a gap.
    fn bernstein(&self, k: usize) -> Option<[f64; 6]> {
        let h = self.times[k + 1] - self.times[k];
        let [a, b] = [k, k + 1].map(|k| self.values[k].map(|x| x.value()));
        Some(match [self.known(k), self.known(k + 1)] {
            [1, 1] => [a[0], a[0], a[0], b[0], b[0], b[0]],
            [2, 2] => {
                let [inner, outer] = [a[0] + h * a[1] / 3.0, b[0] - h * b[1] / 3.0];
                [a[0], inner, inner, outer, outer, b[0]]
            }
            [3, 3] => [
                a[0],
                a[0] + h * a[1] / 5.0,
                a[0] + h * (2.0 * a[1] / 5.0 + h * a[2] / 20.0),
                b[0] - h * (2.0 * b[1] / 5.0 - h * b[2] / 20.0),
                b[0] - h * b[1] / 5.0,
                b[0],
            ],
            [_, _] => return None,
        })
    }

    /// A time of interval k without its round-off.
    fn within(&self, k: usize, t: T) -> f64 {
        let (t, [low, high]) = (t.value(), [self.times[k], self.times[k + 1]]);
        let end = if t - low < high - t { low } else { high };
        if (t - end).abs() < THERE * (high - low) { end } else { t.clamp(low, high) }
    }

    /// A time of interval k at which the curve is `at`, with the derivative of one step of Newton's method.
    fn moved(&self, k: usize, t: f64, at: f64) -> T {
        let t = T::constant(t);
        let [value, rate] = self.at(k, t);
        // x(t, b) = at:  t_b = -x_b / x.,  which the dual of one Newton step t - (x - at) / x. carries
        t - (value - T::constant(at)) / rate
    }

    pub(super) fn number(&self, k: usize, t: f64) -> f64 {
        self.at(k, T::constant(t))[0].value()
    }
}

/// Binomial coefficients C(n, k).
const CHOOSE: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// Where a polynomial, of degree 4 at most, changes its sign between 0 and 1. Between the places where its derivative does, it
/// does so once at most.
fn roots(c: &[f64]) -> Vec<f64> {
    let value = |s: f64| c.iter().rev().fold(0.0, |sum, c| sum * s + c);
    // In Bernstein's form the coefficients enclose the polynomial.
    let n = c.len() - 1;
    // b_i = sum_{j<=i} C(i,j) / C(n,j) c_j                                                                (31)
    let enclosing = (0..=n).map(|i| (0..=i).map(|j| CHOOSE[i][j] / CHOOSE[n][j] * c[j]).sum::<f64>());
    let [low, high] = enclosing.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], b| [l.min(b), h.max(b)]);
    if n == 0 || !(low < 0.0 && high > 0.0) {
        return Vec::new();
    }
    let derivative: Vec<f64> = (1..=n).map(|k| k as f64 * c[k]).collect();
    let mut ends = vec![0.0];
    ends.extend(roots(&derivative));
    ends.push(1.0);
    let mut found = Vec::new();
    for pair in ends.windows(2) {
        let [mut low, mut high] = [pair[0], pair[1]];
        let rising = value(low) < 0.0;
        if rising == (value(high) < 0.0) {
            continue;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if (value(middle) < 0.0) == rising { low = middle } else { high = middle }
        }
        found.push(0.5 * (low + high));
    }
    found
}

/// The polynomial with what is known at the ends of an interval and at the next output time to either side, in Newton's form:
/// twice the degree of the interval's own. How far the two are apart is how far that may be from the curve.
struct WidePolynomial {
    /// How many numbers are known.
    count: usize,
    /// Each time as often as something is known there.
    nodes: [f64; MOST_KNOWN],
    /// Divided differences.
    c: [f64; MOST_KNOWN],
}

/// Value, rate and acceleration at four times.
const MOST_KNOWN: usize = 12;

impl WidePolynomial {
    /// `None` where nothing is known beside the interval.
    fn new(y: &SampledCurve<'_, f64>, k: usize) -> Option<Self> {
        let last = y.values.len() - 1;
        let h = y.times[k + 1] - y.times[k];
        // Beyond a kink or a jump (a pair of times) the curve is another.
        let smooth = |end: usize| y.known(end) == y.orders;
        let goes_on = |end: usize, other: usize| {
            smooth(end) && y.known(other) > 0 && (y.times[end] - y.times[other]).abs() > THERE * h
        };
        let before = k.checked_sub(1).filter(|other| goes_on(k, *other));
        let after = Some(k + 2).filter(|other| *other <= last && goes_on(k + 1, *other));
        if before.or(after).is_none() || !(y.known(k) > 0 && y.known(k + 1) > 0) {
            return None;
        }
        // The interval's own ends first.
        let (mut count, mut at) = (0, [0; MOST_KNOWN]);
        for i in [k, k + 1].into_iter().chain(before).chain(after) {
            let known = y.known(i);
            at[count..count + known].fill(i);
            count += known;
        }
        let (nodes, mut c) = (at.map(|i| y.times[i]), at.map(|i| y.values[i][0]));
        for order in 1..count {
            for i in (order..count).rev() {
                c[i] = if at[i - order] == at[i] {
                    // Half the acceleration, or the rate.
                    y.values[at[i]][order] / order as f64
                } else {
                    (c[i] - c[i - 1]) / (nodes[i] - nodes[i - order])
                };
            }
        }
        Some(Self { count, nodes, c })
    }

    /// Value and rate.
    fn at(&self, t: f64) -> [f64; 2] {
        let ends = self.nodes[..self.count].iter().zip(&self.c[..self.count]).rev();
        ends.fold([0.0; 2], |[value, rate], (node, c)| [value * (t - node) + c, rate * (t - node) + value])
    }
}

/// Value and rate of the polynomial through more times less those of the interval's own.
fn apart(curve: &SampledCurve<'_, f64>, k: usize, t: f64) -> Option<[f64; 2]> {
    let (own, wide) = (curve.at(k, t), WidePolynomial::new(curve, k)?.at(t));
    Some([wide[0] - own[0], wide[1] - own[1]])
}

/// How far the value may be off at a time of interval k that the abscissa decides about: its error moves the time, and that the value.
fn time_error(y: &SampledCurve<'_, f64>, x: &Option<SampledCurve<'_, f64>>, k: usize, t: f64) -> Option<f64> {
    let late = match x {
        Some(x) => (apart(x, k, t)?[0] / x.at(k, t)[1]).abs(),
        None => 0.0,
    };
    // abs(dy) + abs(dx / x.) abs(y.)
    Some(apart(y, k, t)?[0].abs() + late * y.at(k, t)[1].abs())
}

/// How far the metric may be from that of the curve itself, because that is interpolated between output times. The curve is taken
/// for what the polynomials through more output times ([`WidePolynomial`]) make of it.
fn interpolation_error(
    metric: &Metric,
    y: &SampledCurve<'_, f64>,
    x: &Option<SampledCurve<'_, f64>>,
    value: f64,
    time: Option<f64>,
) -> Option<f64> {
    let interval = |t: f64| (y.values.len() > 1).then(|| y.interval(t));
    let at_place = |t: f64| interval(t).map_or(Some(0.0), |k| time_error(y, x, k, t));
    match &metric.take {
        Reduction::Value(_) => at_place(time?),
        Reduction::Slope(_) => {
            let Some(k) = interval(time?) else { return Some(0.0) };
            let rate =
                |curve: &SampledCurve<'_, f64>| Some([curve.at(k, time?)[1], apart(curve, k, time?)?[1]]);
            let [dy, wide_dy] = rate(y)?;
            let [dx, wide_dx] = x.as_ref().map_or(Some([1.0, 0.0]), rate)?;
            Some(((dy + wide_dy) / (dx + wide_dx) - dy / dx).abs())
        }
        Reduction::Greatest | Reduction::Least => {
            let sign = if metric.take == Reduction::Greatest { 1.0 } else { -1.0 };
            let time = time?;
            let (inside, along) = (|at: f64| within_window(metric, at), |k, t| along(x, k, t));
            let cut = x.as_ref().is_some_and(|x| {
                let at = interval(time).map_or(f64::NAN, |k| x.number(k, time));
                metric
                    .window
                    .into_iter()
                    .flatten()
                    .any(|end| (at - end).abs() <= THERE * end.abs().max(THERE))
            });
            let here = match interval(time) {
                None => 0.0,
                Some(_) if cut => at_place(time)?,
                Some(k) => apart(y, k, time)?[0].abs(),
            };
            // Somewhere else the curve may go beyond.
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
        Reduction::Range => {
            let of = |end: Reduction| {
                let end = Metric { take: end, ..metric.clone() };
                let (value, time) = take(&end, y, x)?;
                interpolation_error(&end, y, x, value, time)
            };
            Some(of(Reduction::Greatest)? + of(Reduction::Least)?)
        }
        Reduction::Mean | Reduction::Integral | Reduction::Rms(_) => {
            let stretches = path_stretches(metric, y, x);
            let IntegralErrors { of, travel } = integral_errors(metric, (y, x), &stretches, value, wide);
            integral_error(metric, value, &of, travel)
        }
        Reduction::RmsAtPoints(points) => {
            // The root mean square of the errors at the points
            let counting = points.iter().filter(|p| within_window(metric, p[0]));
            let errors = counting.map(|p| crossings(y, x, p[0]).next().and_then(|(_, t)| at_place(t)));
            let errors: Vec<f64> = errors.collect::<Option<_>>()?;
            Some((errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt())
        }
    }
}

/// Parts of an interval at whose ends a curve between output times is looked at.
const PLACES: u32 = 8;

/// Bisections of an interval: to the last bit of a time.
const HALVINGS: usize = 60;

/// What a metric takes, and when.
fn take<T: Real>(
    metric: &Metric,
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
) -> Option<(T, Option<f64>)> {
    if y.values.is_empty() {
        return None;
    }
    if y.values.len() == 1 && matches!(metric.take, Reduction::Value(_) | Reduction::Slope(_)) {
        return take_at_single_time(metric, y, x);
    }
    match &metric.take {
        Reduction::Greatest => extreme(metric, y, x, 1.0).map(|(v, t)| (v, Some(t))),
        Reduction::Least => extreme(metric, y, x, -1.0).map(|(v, t)| (v, Some(t))),
        Reduction::Range => {
            let ends = extreme(metric, y, x, 1.0).zip(extreme(metric, y, x, -1.0));
            ends.map(|((most, _), (least, _))| (most - least, None))
        }
        Reduction::Value(at) => {
            let (k, t) = crossings(y, x, *at).next()?;
            Some((y.at(k, t)[0], Some(y.within(k, t))))
        }
        Reduction::Slope(at) => {
            let (k, t) = crossings(y, x, *at).next()?;
            // dy/dx = y. / x.
            let by = x.as_ref().map_or(T::one(), |x| x.at(k, t)[1]);
            Some((y.at(k, t)[1] / by, Some(y.within(k, t))))
        }
        Reduction::Mean | Reduction::Integral | Reduction::Rms(_) => {
            integral(metric, path_nodes(metric, y, x)).map(|value| (value, None))
        }
        Reduction::RmsAtPoints(points) => {
            let left = left_at_points(metric, points, y, x)?;
            let squares = left.iter().fold(T::zero(), |sum, left| sum + *left * *left);
            Some(((squares * T::constant((left.len() as f64).recip())).sqrt(), None))
        }
    }
}

/// Takes a metric of a motion with one output time: a curve that is one point with its rates.
fn take_at_single_time<T: Real>(
    metric: &Metric,
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
) -> Option<(T, Option<f64>)> {
    let (time, [value, rate, _]) = (y.times[0], y.values[0]);
    let place = x.as_ref().map_or(T::constant(time), |x| x.values[0][0]);
    let is_there = |at: f64| (place.value() - at).abs() <= THERE * at.abs().max(1.0);
    // dy/dx = y. / x.
    let slope = |x: &SampledCurve<'_, T>| (x.orders > 1 && y.orders > 1).then(|| rate / x.values[0][1]);
    match &metric.take {
        Reduction::Value(at) if is_there(*at) => match x {
            // The place stays and the time moves:  y(x = at) = y + (at - x) y. / x.
            Some(x) if x.values[0][1].value() != 0.0 => {
                let moved = slope(x).map_or(T::constant(0.0), |slope| (T::constant(*at) - place) * slope);
                Some((value + moved, Some(time)))
            }
            _ => Some((value, Some(time))),
        },
        Reduction::Slope(at) if is_there(*at) => {
            let slope = match x {
                Some(x) => slope(x)?,
                None => (y.orders > 1).then_some(rate)?,
            };
            Some((slope, Some(time)))
        }
        Reduction::Value(_)
        | Reduction::Slope(_)
        | Reduction::Greatest
        | Reduction::Least
        | Reduction::Range
        | Reduction::Mean
        | Reduction::Integral
        | Reduction::Rms(_)
        | Reduction::RmsAtPoints(_) => None,
    }
}

/// An abscissa this near, as a part of its span, is there: a motion that starts at the place must not be said to come by later,
/// for its last digit.
const THERE: f64 = 1e-9;

/// The intervals where the abscissa is `at`, in their order, and the time of each, which moves with the design.
fn crossings<'c, T: Real>(
    y: &'c SampledCurve<'_, T>,
    x: &'c Option<SampledCurve<'_, T>>,
    at: f64,
) -> impl Iterator<Item = (usize, T)> + 'c {
    let x = x.as_ref();
    let distances = x.into_iter().flat_map(|x| &x.values).map(move |x| (x[0].value() - at).abs());
    let near = THERE * distances.fold(0.0, f64::max);
    let intervals = 0..y.values.len().saturating_sub(1);
    intervals.flat_map(move |k| {
        let there = |end: usize| x.is_some_and(|x| (x.values[end][0].value() - at).abs() <= near);
        let located = |t: f64| x.map(|x| x.moved(k, t, at));
        if let Some(end) = [k, k + 1].into_iter().find(|end| there(*end)) {
            return Vec::from_iter(located(y.times[end]).map(|t| (k, t)));
        }
        let parts = SampledCurve::monotone(y.times, x, k);
        parts.filter_map(|part| Some((k, crossing(x, k, part, at)?))).collect()
    })
}

/// The time at which the abscissa is `at` in a part of interval k where it rises or falls all along, which moves with the design; none
/// where it is not.
pub(super) fn crossing<T: Real>(
    x: Option<&SampledCurve<'_, T>>,
    k: usize,
    [mut low, mut high]: [f64; 2],
    at: f64,
) -> Option<T> {
    let Some(x) = x else { return (low <= at && at <= high).then(|| T::constant(at)) };
    let miss = |t: f64| x.number(k, t) - at;
    if !(miss(low) * miss(high) <= 0.0) {
        return None;
    }
    let rising = miss(high) > miss(low);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if (miss(middle) < 0.0) == rising { low = middle } else { high = middle }
    }
    Some(x.moved(k, 0.5 * (low + high), at))
}

/// What is left beyond a target at each of its points within the window, where the abscissa first is there; `None` where there is no such
/// point, or one that is not reached.
fn left_at_points<T: Real>(
    metric: &Metric,
    points: &[[f64; 2]],
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
) -> Option<Vec<T>> {
    let left = |[at, target]: &[f64; 2]| {
        let (k, t) = crossings(y, x, *at).next()?;
        Some(y.at(k, t)[0] - T::constant(*target))
    };
    let counting = points.iter().filter(|p| within_window(metric, p[0]));
    counting.map(left).collect::<Option<Vec<T>>>().filter(|left| !left.is_empty())
}

/// Whether this part of the curve counts.
fn within_window(metric: &Metric, at: f64) -> bool {
    metric.window.is_none_or(|[low, high]| low <= at && at <= high)
}

/// The abscissa at a time of interval k.
fn along<T: Real>(x: &Option<SampledCurve<'_, T>>, k: usize, t: f64) -> f64 {
    x.as_ref().map_or(t, |x| x.number(k, t))
}

/// The greatest value (sign 1) or the least (-1) where the abscissa is in the window, and its time.
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
    let counts = |k: usize| inside(x.as_ref().map_or(y.times[k], |x| x.values[k][0].value()));
    let at_times = (0..=last).filter(|k| counts(*k)).map(|k| sign * y.values[k][0].value());
    let most = at_times.fold(f64::NEG_INFINITY, f64::max);
    for k in 0..=last {
        let t = y.times[k];
        if counts(k) {
            offer(y.values[k][0], t);
        }
        // Where a curve bends by less than it rises elsewhere, no turn of it is the greatest.
        if k == last || y.orders == 1 || y.bound(k, sign) <= most {
            continue;
        }
        for turn in y.turns(k) {
            if inside(along(k, turn)) {
                offer(y.at(k, T::constant(turn))[0], turn);
            }
        }
    }
    // Wherever the window cuts the curve, its end stays and the time moves.
    for (k, t) in metric.window.into_iter().flatten().flat_map(|end| crossings(y, x, end)) {
        offer(y.at(k, t)[0], t.value());
    }
    best
}

/// A metric that is an integral, from the nodes of its path.
fn integral<T: Real>(metric: &Metric, nodes: impl Iterator<Item = PathNode<T>>) -> Option<T> {
    match &metric.take {
        Reduction::Mean => mean(nodes, |_, value| value),
        // sum y_g dx_g;  what the abscissa goes back counts down
        Reduction::Integral => nodes.map(|node| node.y * node.dx).reduce(|sum, part| sum + part),
        Reduction::Rms(target) => {
            let square = |at: T, value: T| {
                let left = value - on_target(target, at);
                left * left
            };
            mean(nodes, square).map(T::sqrt)
        }
        Reduction::Least
        | Reduction::Greatest
        | Reduction::Range
        | Reduction::RmsAtPoints(_)
        | Reduction::Value(_)
        | Reduction::Slope(_) => None,
    }
}

/// The mean of a function of abscissa and value over the travel of the abscissa, to and fro.
fn mean<T: Real>(nodes: impl Iterator<Item = PathNode<T>>, of: impl Fn(T, T) -> T) -> Option<T> {
    // sum f_g abs(dx_g)  over  sum abs(dx_g)
    let add = |[sum, travel]: [T; 2], node: PathNode<T>| {
        let travelled = node.dx.abs();
        [sum + of(node.x, node.y) * travelled, travel + travelled]
    };
    let [sum, travel] = nodes.fold([T::zero(); 2], add);
    (travel.value() > 0.0).then(|| sum / travel)
}

/// The abscissa at an output time.
fn abscissa_at<T: Real>(y: &SampledCurve<'_, T>, x: &Option<SampledCurve<'_, T>>, k: usize) -> T {
    x.as_ref().map_or(T::constant(y.times[k]), |x| x.values[k][0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = sin t, y = t^5, at uneven times.
    fn curves(times: &[f64]) -> [SampledCurve<'_, f64>; 2] {
        let of = |f: fn(f64) -> [f64; 3]| SampledCurve {
            times,
            orders: 3,
            values: times.iter().map(|t| f(*t)).collect(),
        };
        [of(|t| [t.sin(), t.cos(), -t.sin()]), of(|t| [t.powi(5), 5.0 * t.powi(4), 20.0 * t.powi(3)])]
    }

    #[test]
    fn no_polynomial_exceeds_its_bound_and_bounds_are_near() {
        let times = [0.0, 0.3, 1.1, 1.4];
        for curve in curves(&times) {
            for orders in [2, 3] {
                let curve = SampledCurve { orders, times: &times, values: curve.values.clone() };
                for k in 0..3 {
                    for sign in [1.0, -1.0] {
                        let h = times[k + 1] - times[k];
                        let at = |j: u32| sign * curve.number(k, times[k] + h * f64::from(j) / 64.0);
                        let most = (0..=64).map(at).fold(f64::NEG_INFINITY, f64::max);
                        let bound = curve.bound(k, sign);
                        // The ends' rates and accelerations are what Bernstein's coefficients lie apart by.
                        let ends = [curve.values[k], curve.values[k + 1]];
                        let apart = ends.map(|[_, v, a]| h * v.abs() + h * h * a.abs() / 10.0);
                        assert!(
                            bound > most - 1e-14 && bound < most + apart[0].max(apart[1]) / 2.0,
                            "{orders} {k} {sign}: {bound} {most}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_polynomial_of_degree_five_is_its_own_interpolation() {
        let times = [0.0, 0.3, 1.1];
        let [x, y] = curves(&times);
        for t in [0.35_f64, 0.8, 1.05] {
            let [value, rate] = y.at(1, t);
            assert!((value - t.powi(5)).abs() < 1e-14 && (rate - 5.0 * t.powi(4)).abs() < 1e-13);
            assert!((x.at(1, t)[0] - t.sin()).abs() < 1e-5);
        }
    }

    #[test]
    fn the_target_goes_on_in_straight_lines() {
        let target = [[0.0, 1.0], [1.0, 3.0], [2.0, 3.0]];
        for (at, expected) in [(-1.0, -1.0), (0.5, 2.0), (1.5, 3.0), (9.0, 3.0)] {
            assert_eq!(on_target(&target, at), expected);
        }
        assert_eq!(on_target(&[], 4.0), 0.0);
    }
}

//! Metrics of a solved motion, with their exact derivatives by the design variables.
//!
//! A metric is written once over any number; its derivatives are the same lines run on duals. Between output times, curves
//! are the polynomials that have their values, rates and accelerations at both ends.

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
    /// How far interpolation between output times may be off, in SI; `None` for a mean, and where there are not enough output
    /// times to say.
    pub error: Option<f64>,
    /// What the error is to be compared with, in SI: greatest less least value of the curve, for a slope its own size.
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
    let known = |metric: &Metric| whole || matches!(metric.take, Reduction::Value(_) | Reduction::Slope(_));
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
    // Solved between output times, it is taken at a time that was solved.
    let resolved = solution.between.is_some()
        && unresolved_times(solution_of(solution, metric), metric, true).is_empty();
    let error = if resolved { None } else { interpolation_error(metric, &y, &x, value, time) };
    let finite = || y.values.iter().map(|v| v[0]).filter(|x| x.is_finite());
    let range = match metric.take {
        Reduction::Slope(_) => value.abs(),
        _ => finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min),
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

/// The times at which a window of a metric over time ends.
pub(crate) fn window_times(metric: &Metric) -> Vec<f64> {
    let at = match metric.take {
        Reduction::Value(at) | Reduction::Slope(at) => Some(at),
        Reduction::Least
        | Reduction::Greatest
        | Reduction::Range
        | Reduction::Mean
        | Reduction::Integral
        | Reduction::Rms(_) => None,
    };
    let ends = metric.window.into_iter().flatten().chain(at);
    if metric.over.is_none() { ends.collect() } else { Vec::new() }
}

/// The times between those of a solution at which a metric is taken by interpolation that may be off; `finer` says that these are times
/// between the output times.
pub(crate) fn unresolved_times(solution: &Solution, metric: &Metric, finer: bool) -> Vec<f64> {
    let Some((y, x)) = curves_at(solution, metric) else { return Vec::new() };
    let ends = match metric.take {
        Reduction::Range => vec![Reduction::Greatest, Reduction::Least],
        Reduction::Greatest | Reduction::Least | Reduction::Value(_) | Reduction::Slope(_) => {
            vec![metric.take.clone()]
        }
        Reduction::Mean | Reduction::Integral | Reduction::Rms(_) => Vec::new(),
    };
    let finite = || y.values.iter().map(|v| v[0]).filter(|x| x.is_finite());
    let range = finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min);
    let part = if finer { RESOLVED } else { RESOLVED_BY_OUTPUTS };
    let times_of = |end: Reduction| -> Vec<f64> {
        let sign = match end {
            Reduction::Greatest => 1.0,
            Reduction::Least => -1.0,
            Reduction::Range
            | Reduction::Value(_)
            | Reduction::Slope(_)
            | Reduction::Mean
            | Reduction::Integral
            | Reduction::Rms(_) => 0.0,
        };
        let found = take(&Metric { take: end, ..metric.clone() }, &y, &x);
        let Some((value, Some(time))) = found else { return Vec::new() };
        let mut times = vec![time];
        if sign != 0.0 && finer && y.orders > 1 {
            // Of turns and ends of the window that are about as far out as the farthest, as of a motion that repeats itself, any may be
            // the one.
            let far_out = sign * value - ALIKE * range;
            let near = (0..y.values.len() - 1).filter(|k| y.bound(*k, sign) >= far_out);
            let turns = near.flat_map(|k| y.turns(k).into_iter().map(move |t| (k, t)));
            let alike = turns.filter(|(k, t)| {
                sign * y.number(*k, *t) >= far_out && within_window(metric, along(&x, *k, *t))
            });
            times.extend(alike.map(|(_, t)| t));
            let cuts = metric.window.into_iter().flatten().flat_map(|end| crossings(&y, &x, end));
            times.extend(cuts.filter(|(k, t)| sign * y.number(*k, *t) >= far_out).map(|(_, t)| t));
        }
        times
    };
    let unresolved = |time: f64| {
        let time = Some(time).filter(|t| !y.times.contains(t))?;
        let k =
            y.times[..y.values.len()].partition_point(|end| *end <= time).clamp(1, y.values.len() - 1) - 1;
        let off = |curve: &SampledCurve<'_, f64>| {
            let wide = WidePolynomial::new(curve, k)?.at(time)[0];
            Some((wide - curve.at(k, time)[0]).abs())
        };
        // Where too little is known to say, it may be off.
        let late =
            x.as_ref().map_or(Some(0.0), |x| Some(off(x)? * (y.at(k, time)[1] / x.at(k, time)[1]).abs()));
        let error = off(&y).zip(late).map_or(f64::INFINITY, |(y, late)| y + late);
        (!(error <= part * range)).then_some(time)
    };
    ends.into_iter().flat_map(times_of).filter_map(unresolved).collect()
}

/// The solution that a metric is taken of: that between output times, where there is one, for what is taken at certain times.
fn solution_of<'s>(solution: &'s Solution, metric: &Metric) -> &'s Solution {
    match metric.take {
        Reduction::Least
        | Reduction::Greatest
        | Reduction::Range
        | Reduction::Value(_)
        | Reduction::Slope(_) => solution.between.as_deref().unwrap_or(solution),
        Reduction::Mean | Reduction::Integral | Reduction::Rms(_) => solution,
    }
}

/// The curve that a metric is taken of, and the one that it goes over where that is not time.
type Curves<'t, T> = (SampledCurve<'t, T>, Option<SampledCurve<'t, T>>);

fn curves<'s>(solution: &'s Solution, metric: &Metric) -> Option<Curves<'s, f64>> {
    curves_at(solution_of(solution, metric), metric)
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
    let Solution { motion, measured, sensitivities, .. } = solution_of(solution, metric);
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

/// What is left beyond the target of an `rms` metric, one part for each output time, so weighted that the sum of their squares is that of
/// the metric; `None` for other metrics, and where the metric has no value.
///
/// ```text
/// r_k = sqrt(w_k) (y_k - target(x_k)),    w_k = (abs(x_k - x_k-1) + abs(x_k+1 - x_k)) / 2 / sum abs(x_k - x_k-1)
/// ```
pub fn misfits(model: &Model, solution: &Solution, metric: &Metric) -> Option<MetricParts> {
    let Reduction::Rms(target) = &metric.take else { return None };
    curves(solution, metric).and_then(|(y, x)| take(metric, &y, &x))?;
    fn parts<T: Real>((y, x): &Curves<'_, T>, metric: &Metric, target: &[[f64; 2]]) -> Vec<T> {
        let (weights, way) = weights(metric, y, x);
        let part = |(k, weight): (usize, T)| {
            // The root has no derivative where there is no weight.
            if weight.value() <= 0.0 {
                return T::zero();
            }
            (weight / way).sqrt() * (y.values[k][0] - on_target(target, abscissa_at(y, x, k)))
        };
        weights.into_iter().enumerate().map(part).collect()
    }
    MetricParts::of(
        model,
        solution,
        metric,
        |curves| parts(curves, metric, target),
        |curves| parts(curves, metric, target),
    )
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
struct SampledCurve<'t, T> {
    times: &'t [f64],
    orders: usize,
    values: Vec<[T; 3]>,
}

impl<T: Real> SampledCurve<'_, T> {
    /// The polynomial of interval k with the values, rates and accelerations that are known at its ends: its coefficients in the
    /// part of the interval that has passed.
    fn coefficients(&self, k: usize) -> [T; 6] {
        let ([a, b], c) = ([&self.values[k], &self.values[k + 1]], T::constant);
        // p(s) = c0 + c1 s + ... + c5 s^5,  s = (t - t_k) / h,  with y, h y., h^2 y.. at s = 0 and s = 1
        let (h, zero) = (self.times[k + 1] - self.times[k], c(0.0));
        // Newton's form on [0, 0, 0, 1, 1, 1], or with fewer ends of each.
        let [a0, a1, a2] = [a[0], a[1] * c(h), a[2] * c(0.5 * h * h)];
        let [b0, b1, b2] = [b[0], b[1] * c(h), b[2] * c(0.5 * h * h)];
        match self.orders {
            1 => [a0, b0 - a0, zero, zero, zero, zero],
            2 => {
                let rise = b0 - a0;
                [a0, a1, c(3.0) * rise - c(2.0) * a1 - b1, a1 + b1 - c(2.0) * rise, zero, zero]
            }
            _ => {
                // What is left of value, rate and half the acceleration at s = 1.
                let p = b0 - a0 - a1 - a2;
                let q = b1 - a1 - c(2.0) * a2;
                let r = b2 - a2;
                let c3 = c(10.0) * p - c(4.0) * q + r;
                let c4 = c(-15.0) * p + c(7.0) * q - c(2.0) * r;
                [a0, a1, a2, c3, c4, c(6.0) * p - c(3.0) * q + r]
            }
        }
    }

    /// Value and rate at a time of interval k.
    fn at(&self, k: usize, t: T) -> [T; 2] {
        let c = T::constant;
        let h = self.times[k + 1] - self.times[k];
        let s = (t - c(self.times[k])) / c(h);
        let [c0, c1, c2, c3, c4, c5] = self.coefficients(k);
        let value = c0 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
        let slope = c1 + s * (c(2.0) * c2 + s * (c(3.0) * c3 + s * (c(4.0) * c4 + s * c(5.0) * c5)));
        [value, slope / c(h)]
    }

    /// The times inside interval k where the curve turns.
    fn turns(&self, k: usize) -> Vec<f64> {
        let c = self.coefficients(k).map(|c| c.value());
        let rate = [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 5.0 * c[5]];
        let (from, h) = (self.times[k], self.times[k + 1] - self.times[k]);
        roots(&rate).into_iter().map(|s| from + s * h).collect()
    }

    /// What the polynomial of interval k nowhere exceeds, times `sign`: the greatest of its coefficients in Bernstein's form.
    fn bound(&self, k: usize, sign: f64) -> f64 {
        let h = self.times[k + 1] - self.times[k];
        let [a, b] = [k, k + 1].map(|k| self.values[k].map(|x| x.value()));
        let coefficients = match self.orders {
            1 => [a[0], b[0], a[0], b[0], a[0], b[0]],
            2 => {
                let [inner, outer] = [a[0] + h * a[1] / 3.0, b[0] - h * b[1] / 3.0];
                [a[0], inner, inner, outer, outer, b[0]]
            }
            _ => [
                a[0],
                a[0] + h * a[1] / 5.0,
                a[0] + h * (2.0 * a[1] / 5.0 + h * a[2] / 20.0),
                b[0] - h * (2.0 * b[1] / 5.0 - h * b[2] / 20.0),
                b[0] - h * b[1] / 5.0,
                b[0],
            ],
        };
        coefficients.into_iter().fold(f64::NEG_INFINITY, |most, c| most.max(sign * c))
    }

    /// A time of interval k without its round-off.
    fn within(&self, k: usize, t: T) -> f64 {
        let (t, [low, high]) = (t.value(), [self.times[k], self.times[k + 1]]);
        let end = if t - low < high - t { low } else { high };
        if (t - end).abs() < THERE * (high - low) { end } else { t.clamp(low, high) }
    }

    fn number(&self, k: usize, t: f64) -> f64 {
        self.at(k, T::constant(t))[0].value()
    }
}

/// Where a polynomial, of degree 4 at most, changes its sign between 0 and 1. Between the places where its derivative does, it
/// does so once at most.
fn roots(c: &[f64]) -> Vec<f64> {
    let value = |s: f64| c.iter().rev().fold(0.0, |sum, c| sum * s + c);
    // In Bernstein's form the coefficients enclose the polynomial.
    let n = c.len() - 1;
    let choose = |n: usize, k: usize| (0..k).fold(1.0, |x, i| x * (n - i) as f64 / (i + 1) as f64);
    // b_i = sum_{j<=i} C(i,j) / C(n,j) c_j                                                                (31)
    let enclosing = (0..=n).map(|i| (0..=i).map(|j| choose(i, j) / choose(n, j) * c[j]).sum::<f64>());
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
    /// Each time as often as something is known there.
    nodes: Vec<f64>,
    /// Divided differences.
    c: Vec<f64>,
}

impl WidePolynomial {
    /// `None` where nothing is known beside the interval.
    fn new(y: &SampledCurve<'_, f64>, k: usize) -> Option<Self> {
        let known = |i: &usize| y.values[*i][..y.orders].iter().all(|x| x.is_finite());
        // The interval's own ends first.
        let beside = [k.checked_sub(1), Some(k + 2).filter(|i| *i < y.values.len())];
        let at: Vec<usize> =
            [k, k + 1].into_iter().chain(beside.into_iter().flatten().filter(known)).collect();
        if at.len() == 2 || !(known(&k) && known(&(k + 1))) {
            return None;
        }
        let nodes: Vec<usize> = at.iter().flat_map(|i| std::iter::repeat_n(*i, y.orders)).collect();
        let mut c: Vec<f64> = nodes.iter().map(|i| y.values[*i][0]).collect();
        for order in 1..c.len() {
            for i in (order..c.len()).rev() {
                let (from, to) = (nodes[i - order], nodes[i]);
                c[i] = if from == to {
                    // Half the acceleration, or the rate.
                    y.values[to][order] / order as f64
                } else {
                    (c[i] - c[i - 1]) / (y.times[to] - y.times[from])
                };
            }
        }
        Some(Self { nodes: nodes.into_iter().map(|i| y.times[i]).collect(), c })
    }

    /// Value and rate.
    fn at(&self, t: f64) -> [f64; 2] {
        let ends = self.nodes.iter().zip(&self.c).rev();
        ends.fold([0.0; 2], |[value, rate], (node, c)| [value * (t - node) + c, rate * (t - node) + value])
    }
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
    let interval = |t: f64| {
        let after = y.times[..y.values.len()].partition_point(|end| *end <= t);
        (y.values.len() > 1).then(|| after.clamp(1, y.values.len() - 1) - 1)
    };
    // Of value and rate at a time, by how much they differ.
    let apart = |curve: &SampledCurve<'_, f64>, k: usize, t: f64| {
        let (own, wide) = (curve.at(k, t), WidePolynomial::new(curve, k)?.at(t));
        Some([wide[0] - own[0], wide[1] - own[1]])
    };
    // Where the abscissa decides about the time, its error moves the time, and that the value.
    let at_place = |t: f64| {
        let Some(k) = interval(t) else { return Some(0.0) };
        let late = match x {
            Some(x) => (apart(x, k, t)?[0] / x.at(k, t)[1]).abs(),
            None => 0.0,
        };
        // abs(dy) + abs(dx / x.) abs(y.)
        Some(apart(y, k, t)?[0].abs() + late * y.at(k, t)[1].abs())
    };
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
        Reduction::Mean | Reduction::Integral | Reduction::Rms(_) => None,
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
        Reduction::Mean => mean(metric, y, x, |_, value| value).map(|value| (value, None)),
        Reduction::Integral => integral(metric, y, x).map(|value| (value, None)),
        Reduction::Rms(target) => {
            let square = |at: T, value: T| {
                let left = value - on_target(target, at);
                left * left
            };
            mean(metric, y, x, square).map(|value| (value.sqrt(), None))
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
        | Reduction::Rms(_) => None,
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
    let distances = x.iter().flat_map(|x| &x.values).map(move |x| (x[0].value() - at).abs());
    let span = distances.fold(0.0, f64::max);
    let intervals = 0..y.values.len().saturating_sub(1);
    intervals.filter_map(move |k| Some((k, crossing(y.times, x.as_ref(), k, at, THERE * span)?)))
}

/// The time at which the abscissa is `at` in interval k; none where it is not.
fn crossing<T: Real>(
    times: &[f64],
    x: Option<&SampledCurve<'_, T>>,
    k: usize,
    at: f64,
    near: f64,
) -> Option<T> {
    let Some(x) = x else {
        return (times[k] <= at && at <= times[k + 1]).then(|| T::constant(at));
    };
    let miss = |k: usize| x.values[k][0].value() - at;
    let there = |k: usize| miss(k).abs() <= near;
    if !(there(k) || there(k + 1) || miss(k) * miss(k + 1) <= 0.0) {
        return None;
    }
    let [mut low, mut high] = match [there(k), there(k + 1)] {
        [true, _] => [times[k]; 2],
        [false, true] => [times[k + 1]; 2],
        _ => [times[k], times[k + 1]],
    };
    let rising = miss(k + 1) > miss(k);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if (x.number(k, middle) < at) == rising { low = middle } else { high = middle }
    }
    // One step of Newton's method more gives the derivative of the time.
    let t = T::constant(0.5 * (low + high));
    let [value, rate] = x.at(k, t);
    // x(t, b) = at:  t_b = -x_b / x.,  which the dual of one Newton step t - (x - at) / x. carries
    Some(t - (value - T::constant(at)) / rate)
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

/// The mean of a function of abscissa and value over the output times in the window, by the trapezoidal rule: over time, or
/// over the way of the abscissa to and fro.
fn mean<T: Real>(
    metric: &Metric,
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
    of: impl Fn(T, T) -> T,
) -> Option<T> {
    // sum w_k f_k  over  sum abs(x_k - x_k-1)
    let (weights, way) = weights(metric, y, x);
    let mut sum = T::zero();
    for (k, weight) in weights.into_iter().enumerate() {
        if weight.value() > 0.0 {
            sum += of(abscissa_at(y, x, k), y.values[k][0]) * weight;
        }
    }
    (way.value() > 0.0).then(|| sum / way)
}

/// The integral over the output times in the window, by the trapezoidal rule; what the abscissa goes back counts down.
fn integral<T: Real>(metric: &Metric, y: &SampledCurve<'_, T>, x: &Option<SampledCurve<'_, T>>) -> Option<T> {
    let counts = |k: usize| within_window(metric, abscissa_at(y, x, k).value());
    let steps = (1..y.values.len()).filter(|&k| counts(k - 1) && counts(k));
    // (y_k + y_k-1) (x_k - x_k-1) / 2
    let part = |k: usize| {
        let step = abscissa_at(y, x, k) - abscissa_at(y, x, k - 1);
        (y.values[k][0] + y.values[k - 1][0]) * step * T::constant(0.5)
    };
    steps.map(part).reduce(|sum, part| sum + part)
}

/// The weight of each output time in a mean over the way of the abscissa, and the sum of all of them: half of the way on either side of it,
/// in the window.
fn weights<T: Real>(
    metric: &Metric,
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
) -> (Vec<T>, T) {
    let counts = |k: usize| within_window(metric, abscissa_at(y, x, k).value());
    let (mut weights, mut way) = (vec![T::zero(); y.values.len()], T::zero());
    for k in 1..y.values.len() {
        if counts(k - 1) && counts(k) {
            let step = (abscissa_at(y, x, k) - abscissa_at(y, x, k - 1)).abs();
            let half = step * T::constant(0.5);
            weights[k - 1] += half;
            weights[k] += half;
            way += step;
        }
    }
    (weights, way)
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

//! Metrics of a solved motion, with their exact derivatives by the design variables.
//!
//! A metric is written once over any number; its derivatives are the same lines run on duals. Between output times, curves
//! are the polynomials that have their values, rates and accelerations at both ends.

use crate::analysis::Solution;
use crate::measure::Measured;
use crate::model::{Metric, Model, OutputSource, Take, VariableId};
use crate::space::{Dual, Real};

/// The value of a metric.
#[derive(Clone, Debug, PartialEq)]
pub struct MetricValue {
    /// In SI; `None` where the motion does not reach what is asked for.
    pub value: Option<f64>,
    /// When it is taken, s; `None` for what is taken of the whole curve.
    pub time: Option<f64>,
    /// Its derivative by every design variable; NaN for those that the mechanism cannot follow, and all of them where no
    /// sensitivities were solved.
    pub d: Vec<f64>,
}

/// The values of all metrics of a model.
pub fn metrics(model: &Model, solution: &Solution) -> Vec<MetricValue> {
    model.metrics.iter().map(|metric| metric_value(model, solution, metric)).collect()
}

fn metric_value(model: &Model, solution: &Solution, metric: &Metric) -> MetricValue {
    let (measured, times) = (&solution.measured, &solution.motion.times[..]);
    let none = MetricValue { value: None, time: None, d: vec![f64::NAN; model.variables.len()] };
    let now = |output: OutputSource| {
        let (m, orders) = column(measured, output)?;
        let values = (0..measured.len()).map(|k| measured.value(k, m)).collect();
        Some(Curve { times, orders, values })
    };
    let curves = || Some((now(metric.of)?, abscissa(metric, now)?));
    let Some((y, x)) = curves() else { return none };
    let Some((value, time)) = take(metric, &y, &x) else { return none };
    let derivative = |v: usize| {
        if solution.sensitivities.variables == 0 || solution.sensitivities.at(0, v).is_none() {
            return f64::NAN;
        }
        let varied = |output: OutputSource| {
            let (m, orders) = column(measured, output)?;
            let number = |k: usize| {
                let (x, d) = (measured.value(k, m), measured.d(k, VariableId(v), m));
                [0, 1, 2].map(|order| Dual { v: x[order], d: d[order] })
            };
            Some(Curve { times, orders, values: (0..measured.len()).map(number).collect() })
        };
        let found = varied(metric.of).zip(abscissa(metric, varied));
        found.and_then(|(y, x)| take(metric, &y, &x)).map_or(f64::NAN, |(value, _)| value.d)
    };
    MetricValue { value: Some(value), time, d: (0..model.variables.len()).map(derivative).collect() }
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
struct Curve<'t, T> {
    times: &'t [f64],
    orders: usize,
    values: Vec<[T; 3]>,
}

impl<T: Real> Curve<'_, T> {
    /// Value and rate at a time of interval k: by the polynomial with the values, rates and accelerations that are known at
    /// its ends.
    fn at(&self, k: usize, t: T) -> [T; 2] {
        let like = |x: f64| t.like(x);
        let h = self.times[k + 1] - self.times[k];
        let s = (t - like(self.times[k])) / like(h);
        let ([a, b], zero) = ([&self.values[k], &self.values[k + 1]], t.zero());
        // Newton's form on [0, 0, 0, 1, 1, 1], or with fewer ends of each; coefficients in s.
        let [a0, a1, a2] = [a[0], a[1] * like(h), a[2] * like(0.5 * h * h)];
        let [b0, b1, b2] = [b[0], b[1] * like(h), b[2] * like(0.5 * h * h)];
        let [c0, c1, c2, c3, c4, c5] = match self.orders {
            1 => [a0, b0 - a0, zero, zero, zero, zero],
            2 => {
                let rise = b0 - a0;
                [a0, a1, like(3.0) * rise - like(2.0) * a1 - b1, a1 + b1 - like(2.0) * rise, zero, zero]
            }
            _ => {
                // What is left of value, rate and half the acceleration at s = 1.
                let p = b0 - a0 - a1 - a2;
                let q = b1 - a1 - like(2.0) * a2;
                let r = b2 - a2;
                let c3 = like(10.0) * p - like(4.0) * q + r;
                let c4 = like(-15.0) * p + like(7.0) * q - like(2.0) * r;
                [a0, a1, a2, c3, c4, like(6.0) * p - like(3.0) * q + r]
            }
        };
        let value = c0 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
        let slope =
            c1 + s * (like(2.0) * c2 + s * (like(3.0) * c3 + s * (like(4.0) * c4 + s * like(5.0) * c5)));
        [value, slope / like(h)]
    }

    /// A time of interval k without its round-off.
    fn within(&self, k: usize, t: T) -> f64 {
        let (t, [low, high]) = (t.lane(0), [self.times[k], self.times[k + 1]]);
        let end = if t - low < high - t { low } else { high };
        if (t - end).abs() < THERE * (high - low) { end } else { t.clamp(low, high) }
    }

    fn number(&self, k: usize, t: f64) -> f64 {
        self.at(k, self.values[k][0].like(t))[0].lane(0)
    }

    fn rate(&self, k: usize, t: f64) -> f64 {
        self.at(k, self.values[k][0].like(t))[1].lane(0)
    }
}

/// Bisections of an interval: to the last bit of a time.
const HALVINGS: usize = 60;

/// What a metric takes, and when.
fn take<T: Real>(metric: &Metric, y: &Curve<'_, T>, x: &Option<Curve<'_, T>>) -> Option<(T, Option<f64>)> {
    if y.values.is_empty() {
        return None;
    }
    match &metric.take {
        Take::Greatest => extreme(metric, y, x, 1.0).map(|(v, t)| (v, Some(t))),
        Take::Least => extreme(metric, y, x, -1.0).map(|(v, t)| (v, Some(t))),
        Take::Range => {
            let ends = extreme(metric, y, x, 1.0).zip(extreme(metric, y, x, -1.0));
            ends.map(|((most, _), (least, _))| (most - least, None))
        }
        Take::Value(at) => {
            let (k, t) = reach(y, x, *at)?;
            Some((y.at(k, t)[0], Some(y.within(k, t))))
        }
        Take::Slope(at) => {
            let (k, t) = reach(y, x, *at)?;
            let by = x.as_ref().map_or(t.like(1.0), |x| x.at(k, t)[1]);
            Some((y.at(k, t)[1] / by, Some(y.within(k, t))))
        }
        Take::Mean => mean(metric, y, x, |_, value| value).map(|value| (value, None)),
        Take::Rms(target) => {
            let square = |at: T, value: T| {
                let left = value - on_target(target, at);
                left * left
            };
            mean(metric, y, x, square).map(|value| (value.sqrt(), None))
        }
    }
}

/// An abscissa this near, as a part of its span, is there: a motion that starts at the place must not be said to come by later,
/// for its last digit.
const THERE: f64 = 1e-9;

/// The interval where the abscissa first is `at`, and the time of that, which moves with the design.
fn reach<T: Real>(y: &Curve<'_, T>, x: &Option<Curve<'_, T>>, at: f64) -> Option<(usize, T)> {
    let times = y.times;
    let witness = y.values[0][0];
    let last = y.values.len().checked_sub(2)?;
    let Some(x) = x else {
        let k = (0..=last).find(|&k| times[k] <= at && at <= times[k + 1])?;
        return Some((k, witness.like(at)));
    };
    let miss = |k: usize| x.values[k][0].lane(0) - at;
    let span = x.values.iter().map(|x| (x[0].lane(0) - at).abs()).fold(0.0, f64::max);
    let there = |k: usize| miss(k).abs() <= THERE * span;
    let k = (0..=last).find(|&k| there(k) || there(k + 1) || miss(k) * miss(k + 1) <= 0.0)?;
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
    let t = witness.like(0.5 * (low + high));
    let [value, rate] = x.at(k, t);
    Some((k, t - (value - witness.like(at)) / rate))
}

/// The greatest value (sign 1) or the least (-1) where the abscissa is in the window, and its time.
fn extreme<T: Real>(
    metric: &Metric,
    y: &Curve<'_, T>,
    x: &Option<Curve<'_, T>>,
    sign: f64,
) -> Option<(T, f64)> {
    let inside = |at: f64| metric.window.is_none_or(|[low, high]| low <= at && at <= high);
    let along = |k: usize, t: f64| x.as_ref().map_or(t, |x| x.number(k, t));
    let mut best: Option<(T, f64)> = None;
    let mut offer = |value: T, t: f64| {
        let better = best.is_none_or(|(most, _)| sign * value.lane(0) > sign * most.lane(0));
        if value.lane(0).is_finite() && better {
            best = Some((value, t));
        }
    };
    let last = y.values.len() - 1;
    for k in 0..=last {
        let t = y.times[k];
        if inside(x.as_ref().map_or(t, |x| x.values[k][0].lane(0))) {
            offer(y.values[k][0], t);
        }
        if k == last || y.orders == 1 {
            continue;
        }
        // Between output times, where the curve turns.
        let (from, to) = (y.values[k][1].lane(0), y.values[k + 1][1].lane(0));
        if sign * from > 0.0 && sign * to < 0.0 {
            let [mut low, mut high] = [t, y.times[k + 1]];
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if sign * y.rate(k, middle) > 0.0 { low = middle } else { high = middle }
            }
            let turn = 0.5 * (low + high);
            if inside(along(k, turn)) {
                offer(y.at(k, y.values[k][0].like(turn))[0], turn);
            }
        }
    }
    // Where the window cuts the curve, its end stays and the time moves.
    for end in metric.window.into_iter().flatten() {
        if let Some((k, t)) = reach(y, x, end) {
            offer(y.at(k, t)[0], t.lane(0));
        }
    }
    best
}

/// The mean of a function of abscissa and value over the output times in the window, by the trapezoidal rule: over time, or
/// over the way of the abscissa to and fro.
fn mean<T: Real>(
    metric: &Metric,
    y: &Curve<'_, T>,
    x: &Option<Curve<'_, T>>,
    of: impl Fn(T, T) -> T,
) -> Option<T> {
    let witness = y.values[0][0];
    let at = |k: usize| x.as_ref().map_or(witness.like(y.times[k]), |x| x.values[k][0]);
    let counts = |k: usize| {
        let x = at(k).lane(0);
        metric.window.is_none_or(|[low, high]| low <= x && x <= high)
    };
    let value = |k: usize| of(at(k), y.values[k][0]);
    let (mut sum, mut way) = (witness.zero(), witness.zero());
    for k in 1..y.values.len() {
        if counts(k - 1) && counts(k) {
            let step = (at(k) - at(k - 1)).abs();
            sum += (value(k - 1) + value(k)) * step * witness.like(0.5);
            way += step;
        }
    }
    (way.lane(0) > 0.0).then(|| sum / way)
}

/// The target at an abscissa.
fn on_target<T: Real>(target: &[[f64; 2]], at: T) -> T {
    match target {
        [] => at.zero(),
        [[_, only]] => at.like(*only),
        _ => {
            let k = target[1..target.len() - 1].iter().take_while(|p| p[0] < at.lane(0)).count();
            let ([x0, y0], [x1, y1]) = (target[k], target[k + 1]);
            at.like(y0) + (at - at.like(x0)) * at.like((y1 - y0) / (x1 - x0))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = sin t, y = t^5, at uneven times.
    fn curves(times: &[f64]) -> [Curve<'_, f64>; 2] {
        let of = |f: fn(f64) -> [f64; 3]| Curve {
            times,
            orders: 3,
            values: times.iter().map(|t| f(*t)).collect(),
        };
        [of(|t| [t.sin(), t.cos(), -t.sin()]), of(|t| [t.powi(5), 5.0 * t.powi(4), 20.0 * t.powi(3)])]
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

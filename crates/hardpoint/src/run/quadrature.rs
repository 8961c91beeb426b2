//! Integrals over the path of a curve: of its polynomials between solved times, over the travel of the abscissa.
//!
//! The path is cut at the ends of the window (these cuts depend on the design), at turns of the abscissa, and at
//! corners of the target of an `rms`. Between the cuts the integrand is smooth. Kinks and jumps of laws are solved
//! times (`between.rs`).

use super::curve::{Polynomial, SampledCurve, WidePolynomial, crossing};
use crate::model::{Metric, PathIntegral, on_target};
use crate::number::Real;

/// Rule by which the integrand is summed up over the path.
#[derive(Clone, Copy)]
enum PathRule {
    /// Over the abscissa, which counts down where it goes back.
    Sum,
    /// Mean over the travel.
    Mean,
    /// Root of that mean.
    RootOfMean,
}

impl PathIntegral<'_> {
    fn rule(self) -> PathRule {
        match self {
            Self::Integral => PathRule::Sum,
            Self::Mean => PathRule::Mean,
            Self::Rms(_) => PathRule::RootOfMean,
        }
    }

    /// Integrand as a function of abscissa and value.
    fn integrand<T: Real>(self, at: T, value: T) -> T {
        match self {
            Self::Mean | Self::Integral => value,
            Self::Rms(target) => {
                let left = value - on_target(target, at);
                left * left
            }
        }
    }

    /// Mean of the integrand over the travel, for metrics that are based on it.
    fn mean_of_integrand(self, value: f64) -> f64 {
        match self.rule() {
            PathRule::Sum => 0.0,
            PathRule::Mean => value,
            PathRule::RootOfMean => value * value,
        }
    }

    /// Value of the metric from the nodes of its path.
    pub(super) fn value<T: Real>(self, nodes: impl Iterator<Item = PathNode<T>>) -> Option<T> {
        let nodes = nodes.map(|node| (self.integrand(node.x, node.y), node.dx));
        match self.rule() {
            // sum f_g dx_g
            PathRule::Sum => nodes.map(|(f, dx)| f * dx).reduce(|sum, part| sum + part),
            PathRule::Mean => mean(nodes),
            PathRule::RootOfMean => mean(nodes).map(T::sqrt),
        }
    }

    /// Error of the metric from its contributions.
    fn error(self, value: f64, errors: &IntegralErrors) -> Option<f64> {
        let sum: f64 = errors.parts.iter().map(|(_, error)| *error).sum::<Option<f64>>()?;
        let mean = sum / errors.travel;
        Some(match self.rule() {
            PathRule::Sum => sum,
            PathRule::Mean => mean,
            // sqrt(rms^2 + error of the mean square) - rms
            PathRule::RootOfMean => (value * value + mean).sqrt() - value,
        })
    }
}

/// Mean of a function over the travel of the abscissa, in both directions, from values and steps of the abscissa.
fn mean<T: Real>(nodes: impl Iterator<Item = (T, T)>) -> Option<T> {
    // sum f_g abs(dx_g)  over  sum abs(dx_g)
    let add = |[sum, travel]: [T; 2], (f, dx): (T, T)| {
        let travelled = dx.abs();
        [sum + f * travelled, travel + travelled]
    };
    let [sum, travel] = nodes.fold([T::zero(); 2], add);
    (travel.value() > 0.0).then(|| sum / travel)
}

/// Nodes of [`GAUSS`].
const NODES: usize = 5;

/// Nodes and weights of Gauss's rule on [0, 1]: exact to degree 9, as is `y x.` of two polynomials of degree 5.
const GAUSS: [[f64; 2]; NODES] = [
    [0.046_910_077_030_668_004, 0.118_463_442_528_094_54],
    [0.230_765_344_947_158_45, 0.239_314_335_249_683_23],
    [0.5, 0.284_444_444_444_444_44],
    [0.769_234_655_052_841_6, 0.239_314_335_249_683_23],
    [0.953_089_922_969_332, 0.118_463_442_528_094_54],
];

/// A part of interval k within the window, over which the abscissa is monotone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch<T> {
    pub k: usize,
    pub from: T,
    pub to: T,
}

/// A node of Gauss's rule on the path.
pub(super) struct PathNode<T> {
    pub t: T,
    /// Weight over time.
    pub dt: T,
    /// Abscissa.
    pub x: T,
    /// Weight over the abscissa: negative for backward travel.
    pub dx: T,
    pub y: T,
}

impl<T: Real> Stretch<T> {
    /// Nodes of the stretch.
    pub(super) fn nodes(
        &self,
        y: &SampledCurve<'_, T>,
        x: &Option<SampledCurve<'_, T>>,
    ) -> [PathNode<T>; NODES] {
        let (y, x) = (y.polynomial(self.k), x.as_ref().map(|x| x.polynomial(self.k)));
        let (from, length) = (self.from, self.to - self.from);
        GAUSS.map(|[s, weight]| {
            let (t, dt) = (from + length * T::constant(s), length * T::constant(weight));
            // dx = x. dt
            let (at, dx) = x.as_ref().map_or((t, dt), |x| {
                let [at, rate] = x.at(t);
                (at, rate * dt)
            });
            PathNode { t, dt, x: at, dx, y: y.at(t)[0] }
        })
    }
}

/// Nodes of a metric's path.
pub(super) fn path_nodes<T: Real>(
    metric: &Metric,
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
) -> impl Iterator<Item = PathNode<T>> {
    path_stretches(metric, y, x).into_iter().flat_map(move |stretch| stretch.nodes(y, x))
}

/// Parts of a metric's path between its cuts.
pub(super) fn path_stretches<T: Real>(
    metric: &Metric,
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
) -> Vec<Stretch<T>> {
    let x = x.as_ref();
    let [low, high] = metric.window.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let corners = match metric.take.target_points() {
        Some([_, corners @ .., _]) => corners,
        Some(_) | None => &[],
    };
    let mut stretches = Vec::new();
    for k in 0..y.values.len().saturating_sub(1) {
        for part in SampledCurve::monotone(y.times, x, k) {
            let along = part.map(|t| x.map_or(t, |x| x.number(k, t)));
            let [least, most] = [along[0].min(along[1]), along[0].max(along[1])];
            // A NaN abscissa is in no window, but it is on the path of a metric without a window.
            if metric.window.is_some() && !(least < high && most > low) {
                continue;
            }
            // Ends of the part, or cuts of the window
            let [from, to] = [0, 1].map(|side| {
                let cut = [(along[side] < low, low), (along[side] > high, high)];
                let cut = cut.into_iter().find_map(|(beyond, end)| beyond.then_some(end));
                cut.and_then(|end| crossing(x, k, part, end)).unwrap_or(T::constant(part[side]))
            });
            // The integrand is continuous at a corner: a change of its time has no effect.
            let corner = |p: &[f64; 2]| Some(crossing(x, k, part, p[0])?.value());
            let mut cuts: Vec<f64> = corners.iter().filter_map(corner).collect();
            // The same at a kink, where a magnitude turns.
            if y.fold(k).is_some() {
                cuts.extend(y.turns(k));
            }
            cuts.retain(|t| from.value() < *t && *t < to.value());
            cuts.sort_by(f64::total_cmp);
            let mut begins = from;
            for ends in cuts.into_iter().map(T::constant).chain([to]) {
                stretches.push(Stretch { k, from: begins, to: ends });
                begins = ends;
            }
        }
    }
    stretches
}

/// Midpoints of the parts of the path with the largest contributions to the error of an integral, if the error is above
/// `tolerance` (for `rms` and `mean`; for `integral` per travel). Empty if rates are unknown, since the error then
/// decreases only with the square of the steps.
pub(super) fn coarse_middles(
    metric: &Metric,
    y: &SampledCurve<'_, f64>,
    x: &Option<SampledCurve<'_, f64>>,
    tolerance: f64,
) -> Vec<f64> {
    if y.orders == 1 {
        return Vec::new();
    }
    let Some(of) = metric.take.integral() else { return Vec::new() };
    let stretches = path_stretches(metric, y, x);
    let Some(value) = of.value(stretches.iter().flat_map(|s| s.nodes(y, x))) else { return Vec::new() };
    // For most curves the polynomials of lower degree are already accurate enough.
    let mut parts = Vec::new();
    for other in [lower, wide] {
        let errors = integral_errors(of, (y, x), &stretches, value, other);
        let scale = match of.rule() {
            PathRule::Sum => errors.travel,
            PathRule::Mean | PathRule::RootOfMean => 1.0,
        };
        if of.error(value, &errors).is_some_and(|error| error <= tolerance * scale) {
            return Vec::new();
        }
        parts = errors.parts;
    }
    // Without an estimate, the error may be large.
    let size = |error: &Option<f64>| error.unwrap_or(f64::INFINITY);
    let most = parts.iter().map(|(_, error)| size(error)).fold(0.0, f64::max);
    let large = parts.iter().filter(|(_, error)| size(error) >= COARSE * most);
    large.map(|(stretch, _)| 0.5 * (y.times[stretch.k] + y.times[stretch.k + 1])).collect()
}

/// Fraction of the largest error contribution above which a part of the path is halved: many parts of a smooth curve,
/// but only the part with the kink of a curve that has one.
const COARSE: f64 = 1.0 / 64.0;

/// Contributions of the parts of the path to the error of an integral; `None` if too little is known.
struct IntegralErrors {
    parts: Vec<(Stretch<f64>, Option<f64>)>,
    /// Travel of the abscissa within the window, in both directions.
    travel: f64,
}

/// A polynomial for estimating the error of an interval's own.
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

/// Polynomial of interval k without the highest order that is known at its ends: less accurate than its own.
fn lower(curve: &SampledCurve<'_, f64>, k: usize) -> Option<OtherPolynomial> {
    let known = usize::min(curve.known(k), curve.known(k + 1));
    (known > 1).then(|| OtherPolynomial::Lower(curve.polynomial_of(k, known - 1)))
}

/// Polynomial through more times: more accurate than the interval's own.
fn wide(curve: &SampledCurve<'_, f64>, k: usize) -> Option<OtherPolynomial> {
    WidePolynomial::new(curve, k).map(OtherPolynomial::Wide)
}

/// Contribution of each part of the path to the error of an integral: the difference between other polynomials
/// ([`wide`] or [`lower`]) and the interval's own.
fn integral_errors(
    of: PathIntegral<'_>,
    (y, x): (&SampledCurve<'_, f64>, &Option<SampledCurve<'_, f64>>),
    stretches: &[Stretch<f64>],
    value: f64,
    other: fn(&SampledCurve<'_, f64>, usize) -> Option<OtherPolynomial>,
) -> IntegralErrors {
    // The integrand minus its mean: an error of the travel changes numerator and denominator.
    let mean = of.mean_of_integrand(value);
    let integrand = |at: f64, y: f64| of.integrand(at, y) - mean;
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
        // At an end of the window, an error of the abscissa moves the cut.
        let moved = [stretch.from, stretch.to].into_iter().filter(|t| !y.times.contains(t)).map(|t| {
            let own = x.as_ref().map_or(t, |x| x.number(k, t));
            (integrand(own, y.number(k, t)) * (along(t)[0] - own)).abs()
        });
        Some(apart.sum::<f64>().abs() + moved.sum::<f64>())
    };
    let parts = stretches.iter().map(|stretch| (*stretch, error(stretch))).collect();
    IntegralErrors { parts, travel }
}

/// Travel of the abscissa within the window, in both directions.
pub(super) fn travel<T: Real>(
    metric: &Metric,
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
) -> T {
    path_nodes(metric, y, x).fold(T::zero(), |sum, node| sum + node.dx.abs())
}

/// Error estimate of an integral with this value, from polynomials through more times; `None` if too little is known.
pub(super) fn path_error(
    metric: &Metric,
    y: &SampledCurve<'_, f64>,
    x: &Option<SampledCurve<'_, f64>>,
    value: f64,
) -> Option<f64> {
    let of = metric.take.integral()?;
    of.error(value, &integral_errors(of, (y, x), &path_stretches(metric, y, x), value, wide))
}

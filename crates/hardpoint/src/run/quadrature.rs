//! Integrals over the path of a curve: of its polynomials between the times that were solved, over the way of the abscissa.
//!
//! The path is cut where the window ends (these cuts move with the design), where the abscissa turns, and where the target of an `rms` has
//! a corner; between the cuts all is smooth. Kinks and jumps of laws are times that were solved (`between.rs`).

use crate::model::{Metric, Reduction};
use crate::number::Real;

use super::metric::{SampledCurve, crossing};

/// How many nodes there are.
pub(super) const NODES: usize = 5;

/// Nodes and weights of Gauss's rule on [0, 1]: exact to degree 9, as is `y x.` of two polynomials of degree 5.
const GAUSS: [[f64; 2]; NODES] = [
    [0.046_910_077_030_668_004, 0.118_463_442_528_094_54],
    [0.230_765_344_947_158_45, 0.239_314_335_249_683_23],
    [0.5, 0.284_444_444_444_444_44],
    [0.769_234_655_052_841_6, 0.239_314_335_249_683_23],
    [0.953_089_922_969_332, 0.118_463_442_528_094_54],
];

/// A part of interval k over which the abscissa rises or falls all along, within the window.
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
    /// Weight over the abscissa: negative where that goes back.
    pub dx: T,
    pub y: T,
}

impl<T: Real> Stretch<T> {
    /// The nodes of the stretch.
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

/// The nodes of a metric's path.
pub(super) fn path_nodes<T: Real>(
    metric: &Metric,
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
) -> impl Iterator<Item = PathNode<T>> {
    path_stretches(metric, y, x).into_iter().flat_map(move |stretch| stretch.nodes(y, x))
}

/// The parts of a metric's path between its cuts.
pub(super) fn path_stretches<T: Real>(
    metric: &Metric,
    y: &SampledCurve<'_, T>,
    x: &Option<SampledCurve<'_, T>>,
) -> Vec<Stretch<T>> {
    let x = x.as_ref();
    let [low, high] = metric.window.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let corners = match &metric.take {
        Reduction::Rms(target) if target.len() > 2 => &target[1..target.len() - 1],
        Reduction::Rms(_)
        | Reduction::Least
        | Reduction::Greatest
        | Reduction::Range
        | Reduction::Mean
        | Reduction::Integral
        | Reduction::RmsAtPoints(_)
        | Reduction::Value(_)
        | Reduction::Slope(_) => &[],
    };
    let mut stretches = Vec::new();
    for k in 0..y.values.len().saturating_sub(1) {
        for part in SampledCurve::monotone(y.times, x, k) {
            let along = part.map(|t| x.map_or(t, |x| x.number(k, t)));
            let [least, most] = [along[0].min(along[1]), along[0].max(along[1])];
            // Written so that an abscissa without a value is in no window, but on the path of a metric without one.
            if metric.window.is_some() && !(least < high && most > low) {
                continue;
            }
            // Where the part begins or ends, or the window cuts it
            let [from, to] = [0, 1].map(|side| {
                let cut = [(along[side] < low, low), (along[side] > high, high)];
                let cut = cut.into_iter().find_map(|(beyond, end)| beyond.then_some(end));
                cut.and_then(|end| crossing(x, k, part, end)).unwrap_or(T::constant(part[side]))
            });
            // The integrand is continuous at a corner: that its time moves changes nothing.
            let corner = |p: &[f64; 2]| Some(crossing(x, k, part, p[0])?.value());
            let mut cuts: Vec<f64> = corners.iter().filter_map(corner).collect();
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

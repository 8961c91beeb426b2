//! First-order optimality of a design, and the multipliers of its active bounds and limits.
//!
//! ```text
//! grad f + sum of lambda_i grad c_i = 0,    lambda_i >= 0,    lambda_i c_i = 0                   (Karush, Kuhn and Tucker)
//! ```
//!
//! with goals on a maximum among the `c`: the weights of all points that attain it sum to one. The multipliers are
//! found by least squares over the active constraints, independent of the solver.

use hardpoint::linalg::least_squares;

use super::problem::{Point, Problem, Rows};

/// Distance from its end, as a fraction of its scale, below which a constraint is active.
pub(crate) const BINDS: f64 = 1e-7;
/// Misfits below this fraction of their change over the bounds of the most influential variable are round-off: motions
/// are solved to about 1e-14.
pub(crate) const MET: f64 = 1e-12;
/// Minimum scale of goals that are not squares, as a fraction of the gradient at the start, since their value may pass
/// through zero.
const LEAST_SCALE: f64 = 1e-6;

/// A constraint that prevents a better design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActiveConstraint {
    /// Lower bound of a searched variable, by its index in
    /// [`OptimizationSettings::variables`](hardpoint::model::OptimizationSettings::variables).
    Lower(usize),
    /// Upper bound of a searched variable, by the same index.
    Upper(usize),
    /// Lower end of a limit, by its index in
    /// [`OptimizationSettings::limits`](hardpoint::model::OptimizationSettings::limits), in a motion.
    Least(usize, Option<usize>),
    /// Upper end of a limit, by the same index, in a motion.
    Most(usize, Option<usize>),
}

/// Optimality of a design.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Optimality {
    /// Part of the gradient that no active constraint balances, relative to the scale of the goals: 0 at an optimum.
    ///
    /// The scale of squares `f = r^T r` is `2 max |J_v| |r|`, so that the residual is the cosine between the misfits
    /// and their derivatives. The scale of other goals is their value, but at least a fraction of the gradient at the
    /// start.
    pub residual: f64,
    /// Unbalanced gradient relative to the gradient at the start.
    pub left_of_start: f64,
    /// True if all goals are squares that vanish to round-off, so that no improvement is possible.
    pub met: bool,
    /// Active constraints, each with the decrease of the objective if it were relaxed by one SI unit (its Lagrange
    /// multiplier).
    pub binding: Vec<(ActiveConstraint, f64)>,
}

/// Row that may be active: its gradient by fractions of the bounds, and its constraint.
struct Row {
    d: Vec<f64>,
    /// Index of its group of peaks.
    peak: Option<usize>,
    equal: bool,
    /// Constraint, and the size of one of its SI units in the unit of its gradient.
    binding: Option<(ActiveConstraint, f64)>,
}

/// Derivatives of the rows that attain the maximum.
fn at_peak(rows: &Rows) -> Vec<&Vec<f64>> {
    let most = rows.greatest();
    let least = rows.values.iter().copied().fold(f64::INFINITY, f64::min);
    let all = rows.values.iter().zip(&rows.d);
    all.filter(|(value, _)| **value >= most - BINDS * (most - least)).map(|(_, d)| d).collect()
}

impl Optimality {
    pub(super) fn of(problem: &Problem<'_>, point: &Point, limit_scales: &[f64], steepest: f64) -> Self {
        let n = problem.bounds.len();
        let spans: Vec<f64> = problem.bounds.iter().map(|[low, high]| high - low).collect();
        let by_parts = |d: &[f64]| d.iter().zip(&spans).map(|(d, span)| d * span).collect::<Vec<f64>>();
        let smooth = Point { peaks: Vec::new(), ..point.clone() };
        let gradient = by_parts(&smooth.gradient(n));
        let peaks = point.peaks.len();
        let mut rows = Vec::new();
        for (v, part) in problem.parts(&point.design).into_iter().enumerate() {
            let unit = |sign: f64| (0..n).map(|i| if i == v { sign } else { 0.0 }).collect();
            let mut push = |d: Vec<f64>, binding: ActiveConstraint| {
                rows.push(Row { d, peak: None, equal: false, binding: Some((binding, spans[v])) });
            };
            if part < BINDS {
                push(unit(-1.0), ActiveConstraint::Lower(v));
            } else if part > 1.0 - BINDS {
                push(unit(1.0), ActiveConstraint::Upper(v));
            }
        }
        for row in &point.limits {
            let scale = limit_scales[row.of];
            if row.equal || row.exceeds > -BINDS * scale {
                let (limit, taken) = problem.limits[row.of];
                let motion = taken.map(|t| t.motion);
                let binding = if row.upper {
                    ActiveConstraint::Most(limit, motion)
                } else {
                    ActiveConstraint::Least(limit, motion)
                };
                let mut push = |d: &[f64]| {
                    let d = by_parts(d).iter().map(|d| d / scale).collect();
                    rows.push(Row { d, peak: None, equal: row.equal, binding: Some((binding, scale)) });
                };
                let spread = point.spreads.iter().find(|s| row.spread && s.of == row.of);
                // For a range, every pair of a maximum and a minimum.
                let [high, low] =
                    spread.map_or([Vec::new(), Vec::new()], |s| [&s.ends[0], &s.ends[1]].map(at_peak));
                for (a, b) in high.iter().flat_map(|a| low.iter().map(move |b| (a, b))) {
                    push(&a.iter().zip(*b).map(|(a, b)| a + b).collect::<Vec<_>>());
                }
                if spread.is_none() {
                    push(&row.d);
                }
            }
        }
        for (group, values) in point.peaks.iter().enumerate() {
            for d in at_peak(values) {
                rows.push(Row { d: by_parts(d), peak: Some(group), equal: false, binding: None });
            }
        }
        // Rows with negative multipliers are not active: the most negative one is released until none is left.
        let mut active: Vec<usize> = (0..rows.len()).collect();
        let weight = gradient.iter().fold(steepest, |most, g| most.max(g.abs())).max(f64::MIN_POSITIVE);
        let met = point.is_met(&spans);
        let scale = point.gradient_scale(&spans, steepest);
        let solve = |active: &[usize]| {
            let entry = |r: usize, c: usize| match (r < n, rows[active[c]].peak) {
                (true, _) => rows[active[c]].d[r],
                // The weights of the peaks of a group sum to one.
                (false, Some(group)) if group == r - n => weight,
                _ => 0.0,
            };
            let right = gradient.iter().map(|g| -g).chain((0..peaks).map(|_| weight)).collect();
            least_squares([n + peaks, active.len()], entry, &[right]).swap_remove(0)
        };
        let multipliers = loop {
            let multipliers = solve(&active);
            let worst = (0..active.len())
                .filter(|&c| !rows[active[c]].equal && multipliers[c] < 0.0)
                .min_by(|a, b| multipliers[*a].total_cmp(&multipliers[*b]));
            match worst {
                Some(c) => drop(active.remove(c)),
                None => break multipliers,
            }
        };
        let left = |i: usize| {
            let taken: f64 = active.iter().zip(&multipliers).map(|(row, m)| m * rows[*row].d[i]).sum();
            (gradient[i] + taken).abs()
        };
        let left = (0..n).map(left).fold(0.0, f64::max);
        let (residual, left_of_start) = if met { (0.0, 0.0) } else { (left / scale, left / weight) };
        let mut binding: Vec<(ActiveConstraint, f64)> = Vec::new();
        for (row, multiplier) in active.iter().zip(multipliers) {
            let Some((what, scale)) = rows[*row].binding else { continue };
            // One limit may be active at several times of a curve at once.
            match binding.iter_mut().find(|(known, _)| *known == what) {
                Some((_, worth)) => *worth += multiplier / scale,
                None => binding.push((what, multiplier / scale)),
            }
        }
        Self { residual, left_of_start, met, binding }
    }
}

impl Point {
    /// Largest norm of a column of the misfits' derivatives, by fractions of the bounds.
    pub(crate) fn strongest(&self, spans: &[f64]) -> f64 {
        let column = |(v, span): (usize, &f64)| {
            self.misfits.d.iter().map(|d| (d[v] * span).powi(2)).sum::<f64>().sqrt()
        };
        spans.iter().enumerate().map(column).fold(0.0, f64::max)
    }

    /// True if all goals are squares that vanish to round-off.
    pub(super) fn is_met(&self, spans: &[f64]) -> bool {
        self.has_only_squares() && self.misfit() <= MET * self.strongest(spans)
    }

    /// Scale of the gradient: its size if no terms cancelled.
    fn gradient_scale(&self, spans: &[f64], steepest: f64) -> f64 {
        let strongest = self.strongest(spans);
        let squares = 2.0 * strongest * self.misfit().max(MET * strongest);
        let others = if self.has_only_squares() {
            0.0
        } else {
            let peaks = self.peaks.iter().map(Rows::greatest);
            let value: f64 = self.plain.values.iter().copied().chain(peaks).map(f64::abs).sum();
            value.clamp(LEAST_SCALE * steepest, steepest)
        };
        (squares + others).max(f64::MIN_POSITIVE)
    }
}

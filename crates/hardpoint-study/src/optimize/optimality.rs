//! First-order optimality of a design, and the multipliers of its active bounds and limits.
//!
//! ```text
//! grad f + sum of lambda_i grad c_i = 0,    lambda_i >= 0,    lambda_i c_i = 0                   (Karush, Kuhn and Tucker)
//! ```
//!
//! with goals on a maximum among the `c`: the weights of all points that attain it sum to one. Those of the squared
//! distance `t` of an extremum from its target sum to `2 t`. The multipliers are
//! found by non-negative least squares over the active constraints, independent of the solver.

use super::problem::{LimitRow, MET, Point, Problem, Rows};
use hardpoint_search::quadratic::non_negative;

/// Distance from its end, as a fraction of its scale, below which a constraint is active.
pub(crate) const BINDS: f64 = 1e-7;
/// Goals that are not squares, of a value below [`MET`] of the gradient, vanish to round-off. Their minimum is there if
/// the gradient is below the square root of that: a step to zero gradient changes the value by round-off,
/// `f - f* = (grad f)^2 / 2 f''`, with a second derivative of the size of the gradient.
const FLAT: f64 = 1e-6;
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
    /// Part of the gradient that no active constraint balances, or what the maxima that balance it fall short of the
    /// greatest, relative to the scale of the goals: 0 at an optimum.
    ///
    /// The scale of squares `f = r^T r` is `2 max |J_v| |r|`, so that the residual is the cosine between the misfits
    /// and their derivatives. The scale of other goals is their value, but at least a fraction of the gradient at the
    /// start.
    pub residual: f64,
    /// Unbalanced gradient relative to the gradient at the start.
    pub left_of_start: f64,
    /// True if all goals are squares that vanish to round-off, so that no improvement is possible.
    pub met: bool,
    /// True if the gradient jumps at the design, and gradients beside it balance each other.
    pub is_corner: bool,
    /// True if goals that are not squares vanish to round-off, as far as their gradient at the start says what that is:
    /// an optimum if searches find nothing better from there.
    pub(super) vanishes: bool,
    /// Active constraints, each with the decrease of the objective if it were relaxed by one SI unit (its Lagrange
    /// multiplier).
    pub binding: Vec<(ActiveConstraint, f64)>,
    /// Decrease of the objective, SI, by exceeding all active limits by their scales.
    pub price: f64,
}

impl Rows {
    /// Rows that attain the maximum up to a fraction of their change over the bounds, each with the difference from it
    /// and its derivatives by fractions of the bounds.
    fn at_peak(&self, spans: &[f64]) -> Vec<(f64, Vec<f64>)> {
        let by_parts: Vec<Vec<f64>> = self.d.iter().map(|d| by_parts(d, spans)).collect();
        let steepest = by_parts.iter().flatten().fold(0.0, |most: f64, d| most.max(d.abs()));
        let (greatest, least) = (self.greatest(), BINDS * steepest);
        let short = self.values.iter().map(|value| greatest - value);
        short.zip(by_parts).filter(|(short, _)| *short <= least).collect()
    }
}

/// Derivatives by fractions of the bounds.
pub(super) fn by_parts(d: &[f64], spans: &[f64]) -> Vec<f64> {
    d.iter().zip(spans).map(|(d, span)| d * span).collect()
}

/// Active bounds and limits: gradient by fractions of the bounds, constraint, and size of one of its SI units in the
/// unit of that gradient.
pub(super) fn active_constraints(
    problem: &Problem<'_>,
    point: &Point,
    limit_scales: &[f64],
    spans: &[f64],
) -> Vec<(Vec<f64>, ActiveConstraint, f64)> {
    let mut active = Vec::new();
    for (v, part) in problem.parts(&point.design).into_iter().enumerate() {
        let mut push = |sign: f64, binding: ActiveConstraint| {
            let mut gradient = vec![0.0; spans.len()];
            gradient[v] = sign;
            active.push((gradient, binding, spans[v]));
        };
        if part < BINDS {
            push(-1.0, ActiveConstraint::Lower(v));
        } else if part > 1.0 - BINDS {
            push(1.0, ActiveConstraint::Upper(v));
        }
    }
    let is_active = |row: &&LimitRow| row.equal || row.exceeds > -BINDS * limit_scales[row.of];
    for row in point.limits.iter().filter(is_active) {
        let scale = limit_scales[row.of];
        let (limit, of) = problem.limits[row.of];
        let motion = of.motion();
        let binding = if row.upper {
            ActiveConstraint::Most(limit, motion)
        } else {
            ActiveConstraint::Least(limit, motion)
        };
        let mut push = |d: Vec<f64>| {
            for sign in if row.equal { [1.0, -1.0].as_slice() } else { &[1.0] } {
                active.push((d.iter().map(|d| sign * d / scale).collect(), binding, sign * scale));
            }
        };
        let spread = point.spreads.iter().find(|s| row.spread && s.of == row.of);
        // For a range, every pair of a maximum and a minimum.
        let [high, low] =
            spread.map_or([Vec::new(), Vec::new()], |s| [&s.ends[0], &s.ends[1]].map(|e| e.at_peak(spans)));
        for ((_, a), (_, b)) in high.iter().flat_map(|a| low.iter().map(move |b| (a, b))) {
            push(a.iter().zip(b).map(|(a, b)| a + b).collect());
        }
        if spread.is_none() {
            push(by_parts(&row.d, spans));
        }
    }
    active
}

/// Constraints with a multiplier, and the decrease of the objective by exceeding all limits by their scales.
fn binding(
    active: Vec<(Vec<f64>, ActiveConstraint, f64)>,
    multipliers: &[f64],
) -> (Vec<(ActiveConstraint, f64)>, f64) {
    let (mut binding, mut price) = (Vec::<(ActiveConstraint, f64)>::new(), 0.0);
    for ((_, what, scale), multiplier) in active.into_iter().zip(multipliers).filter(|(_, m)| **m != 0.0) {
        price += match what {
            ActiveConstraint::Least(..) | ActiveConstraint::Most(..) => multiplier.abs(),
            ActiveConstraint::Lower(_) | ActiveConstraint::Upper(_) => 0.0,
        };
        // One limit may be active at several times of a curve at once.
        match binding.iter_mut().find(|(known, _)| *known == what) {
            Some((_, worth)) => *worth += multiplier / scale,
            None => binding.push((what, multiplier / scale)),
        }
    }
    (binding, price)
}

impl Optimality {
    pub(super) fn of(problem: &Problem<'_>, point: &Point, limit_scales: &[f64], steepest: f64) -> Self {
        let n = problem.bounds.len();
        let spans = problem.spans();
        let gradient = by_parts(&point.smooth().gradient(n), &spans);
        // Groups of candidates, and the derivative of the objective by the maximum of each.
        let groups: Vec<(&Rows, f64)> = point
            .peaks
            .iter()
            .map(|rows| (rows, 1.0))
            .chain(point.extrema.iter().map(|e| (&e.rows, 2.0 * e.rows.greatest().max(0.0))))
            .collect();
        let size = n + groups.len();
        let weight = gradient.iter().fold(steepest, |most, g| most.max(g.abs())).max(f64::MIN_POSITIVE);
        let padded = |mut d: Vec<f64>| {
            d.resize(size, 0.0);
            d
        };
        // Columns: gradient by fractions of the bounds, and weight in the sum of each group of peaks.
        let active = active_constraints(problem, point, limit_scales, &spans);
        let mut columns: Vec<Vec<f64>> = active.iter().map(|(d, ..)| padded(d.clone())).collect();
        let first_peak = columns.len();
        let mut shortfalls: Vec<f64> = Vec::new();
        for (group, (rows, _)) in groups.iter().enumerate() {
            for (short, d) in rows.at_peak(&spans) {
                let mut column = padded(d);
                column[n + group] = weight;
                columns.push(column);
                shortfalls.push(short);
            }
        }
        let met = point.is_met(&spans, steepest);
        let scale = point.gradient_scale(&spans, steepest);
        // The weights of the candidates of a group sum to its derivative.
        let of_groups = groups.iter().map(|(_, derivative)| derivative * weight);
        let right: Vec<f64> = gradient.iter().map(|g| -g).chain(of_groups).collect();
        let multipliers = non_negative(&columns, &right);
        let left = |i: usize| {
            let balanced: f64 = columns.iter().zip(&multipliers).map(|(column, m)| m * column[i]).sum();
            (gradient[i] + balanced).abs()
        };
        // sum of l_i c_i: a goal can be better by this although the gradient is balanced.
        let gap: f64 = shortfalls.iter().zip(&multipliers[first_peak..]).map(|(short, m)| short * m).sum();
        let left = (0..n).map(left).fold(gap, f64::max);
        let vanishes =
            !point.has_only_squares() && point.goal_size() <= MET * weight && left <= FLAT * weight;
        let (residual, left_of_start) = if met { (0.0, 0.0) } else { (left / scale, left / weight) };
        let (binding, price) = binding(active, &multipliers);
        Self { residual, left_of_start, met, is_corner: false, vanishes, binding, price }
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

    /// True if all goals are squares that vanish to round-off. Near a singular position derivatives have no bound, and
    /// say nothing of round-off: the gradient at the start limits the squares as well, unless it is zero.
    pub(super) fn is_met(&self, spans: &[f64], steepest: f64) -> bool {
        let misfit = self.misfit();
        self.has_only_squares()
            && misfit <= MET * self.strongest(spans)
            && (steepest == 0.0 || misfit * misfit <= FLAT * steepest)
    }

    /// Sum of the magnitudes of goals that are not squares.
    fn goal_size(&self) -> f64 {
        let peaks = self.peaks.iter().map(Rows::greatest);
        self.plain.values.iter().copied().chain(peaks).map(f64::abs).sum()
    }

    /// Scale of the gradient: its size if no terms cancelled.
    pub(super) fn gradient_scale(&self, spans: &[f64], steepest: f64) -> f64 {
        let strongest = self.strongest(spans);
        let squares = 2.0 * strongest * self.misfit().max(MET * strongest);
        let others = if self.has_only_squares() {
            0.0
        } else {
            self.goal_size().clamp(LEAST_SCALE * steepest, steepest)
        };
        (squares + others).max(f64::MIN_POSITIVE)
    }
}

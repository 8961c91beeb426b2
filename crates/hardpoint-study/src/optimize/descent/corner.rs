//! Corners of the objective: optima at which its gradient jumps.
//!
//! The largest of two singular values has no gradient at a design at which they coincide, and no sequence of gradients
//! tends to zero. Such a design is an optimum to first order if gradients beside it balance each other:
//!
//! ```text
//! sum of w_k grad f(b_k) + sum of l_i grad c_i = 0,    w_k >= 0,    sum of w_k = 1,    l_i >= 0            (Clarke)
//! ```
//!
//! with designs `b_k` within a small radius, none of which is better.

use hardpoint_search::quadratic::non_negative;

use super::{Descent, OPTIMAL};
use crate::optimize::assessment::AS_GOOD;
use crate::optimize::optimality::{Optimality, active_constraints, by_parts};
use crate::optimize::starts::start;

/// Radii around a design, as fractions of the bounds: a search without gradients to follow ends at about such a
/// distance from the corner.
const RADII: [f64; 4] = [1e-7, 1e-6, 1e-5, 1e-4];
/// Maximum number of variables: each takes four designs per radius.
const MOST_VARIABLES: usize = 24;
/// Least ratio of the spread of gradients to that at ten times the radius: it is about 1 where they jump, and 0.1 where
/// they only change fast, as in a narrow valley.
const JUMPS: f64 = 0.5;

impl Descent<'_> {
    /// Optimality of the best design as a corner; `None` if gradients beside it do not balance each other.
    pub(super) fn at_corner(&self) -> Option<Optimality> {
        if self.at.len() > MOST_VARIABLES || self.best.has_only_squares() {
            return None;
        }
        let mut gradients = self.gradients_within(RADII[0])?;
        for radius in RADII {
            let farther = self.gradients_within(10.0 * radius);
            let jumps = farther.as_ref().is_some_and(|far| spread(&gradients) >= JUMPS * spread(far));
            if let Some(optimality) = jumps.then(|| self.balanced(&gradients)).flatten() {
                return Some(optimality);
            }
            gradients = farther?;
        }
        None
    }

    /// Gradients of the objective, by fractions of the bounds, at designs within a radius; `None` if one is better.
    fn gradients_within(&self, radius: f64) -> Option<Vec<Vec<f64>>> {
        let at = self.problem.parts(&self.best.design);
        let spans = self.problem.spans();
        let n = at.len();
        let along = (0..n).flat_map(|v| [-1.0, 1.0].map(|sign| (v, sign))).map(|(v, sign)| {
            let mut direction = vec![0.0; n];
            direction[v] = sign;
            direction
        });
        let across =
            (1..=2 * n).map(|k| start(self.problem, k).iter().map(|part| 2.0 * part - 1.0).collect());
        let best = self.best.objective();
        let mut gradients = Vec::new();
        for direction in along.chain(across) {
            if self.memory.interrupted() {
                return None;
            }
            let beside: Vec<f64> =
                at.iter().zip(direction).map(|(at, d)| (at + radius * d).clamp(0.0, 1.0)).collect();
            let found = self.memory.at(&beside, |found| found.as_ref().ok().cloned());
            let Some(point) = found else { continue };
            if point.objective() < best - AS_GOOD * best.abs() {
                return None;
            }
            gradients.push(by_parts(&point.gradient(n), &spans));
        }
        Some(gradients)
    }

    /// Optimality if gradients, with those of active constraints, balance each other.
    fn balanced(&self, gradients: &[Vec<f64>]) -> Option<Optimality> {
        let spans = self.problem.spans();
        let n = spans.len();
        let weight = gradients.iter().flatten().fold(self.steepest, |most, g| most.max(g.abs()));
        let active = active_constraints(self.problem, &self.best, &self.scales, &spans);
        let of_goals = gradients.iter().map(|d| (d.clone(), weight));
        // Columns: gradient by fractions of the bounds, and weight in the sum of the gradients.
        let columns: Vec<Vec<f64>> = of_goals
            .chain(active.into_iter().map(|(d, ..)| (d, 0.0)))
            .map(|(d, weight)| d.into_iter().chain([weight]).collect())
            .collect();
        let right: Vec<f64> = std::iter::repeat_n(0.0, n).chain([weight]).collect();
        let multipliers = non_negative(&columns, &right);
        let left = |i: usize| {
            let sum: f64 = columns.iter().zip(&multipliers).map(|(column, m)| m * column[i]).sum();
            (right[i] - sum).abs()
        };
        let left = (0..=n).map(left).fold(0.0, f64::max);
        let residual = left / self.best.gradient_scale(&spans, self.steepest);
        let left_of_start = left / weight.max(f64::MIN_POSITIVE);
        let here = self.optimality(&self.best);
        (residual <= OPTIMAL).then_some(Optimality { residual, left_of_start, is_corner: true, ..here })
    }
}

/// Largest difference of two gradients in one component.
fn spread(gradients: &[Vec<f64>]) -> f64 {
    let n = gradients.first().map_or(0, Vec::len);
    let of = |i: usize| {
        let all = || gradients.iter().map(|g| g[i]);
        all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
    };
    (0..n).map(of).fold(0.0, f64::max)
}

//! Nonlinear least squares within bounds, by a trust region in coordinates that shrink towards the bounds.
//!
//! ```text
//! min |r(x)|^2 / 2    so that    low <= x <= high                      g = J^T r
//!
//! min |J D z + r|^2 / 2 + z^T C z / 2    so that    |z| <= radius      x + D z: the next point
//! D_k^2: distance to the bound that the objective falls towards        C_k = |g_k|
//! ```
//!
//! Coleman and Li, *An interior trust region approach for nonlinear minimization subject to bounds*, SIAM J. Optim. 6
//! (1996). A step that leaves the bounds is shortened, reflected by the first bound, or replaced by one along the
//! gradient, whichever promises most (Branch, Coleman and Li, SIAM J. Sci. Comput. 21 (1999)).

use hardpoint::linalg::folded_rows;

use crate::singular::{Singular, singular};
use crate::vector::{dot, norm};

/// A point is stationary if its gradient, in the scale of the distances to the bounds, is below this.
const STATIONARY: f64 = 1e-13;
/// Minimum distance of the start from the bounds, as a fraction of their distance.
const START_INSIDE: f64 = 1e-10;
/// Fraction of the distance to a bound that a step covers at most; closer to the solution it covers more.
const MOST_OF_WAY: f64 = 0.995;
/// Maximum number of trials in one iteration.
const TRIALS: usize = 50;
/// The radius shrinks to this fraction of a step ...
const SHRINK: f64 = 0.25;
/// ... that achieves less than this fraction of its promise,
const POOR: f64 = 0.25;
/// and doubles after one that achieves more than this fraction ...
const GOOD: f64 = 0.75;
/// ... and has more than this fraction of the radius.
const FULL: f64 = 0.95;
/// A step may be longer than the radius by this fraction, before it is scaled.
const LONGER: f64 = 1e-2;
/// Maximum number of Newton steps for the damping of a step with the length of the radius.
const DAMPINGS: usize = 50;

/// Residuals at a point, of order one at the start; NaN if the point cannot be evaluated, so that the solver steps
/// back.
pub type Residuals<'p> = Box<dyn Fn(&[f64]) -> Vec<f64> + 'p>;
/// Derivatives of the residuals, one row per residual.
pub type Derivatives<'p> = Box<dyn Fn(&[f64]) -> Vec<Vec<f64>> + 'p>;

/// Solver between iterations.
pub struct LeastSquares<'p> {
    bounds: [f64; 2],
    residuals: Residuals<'p>,
    derivatives: Derivatives<'p>,
    x: Vec<f64>,
    r: Vec<f64>,
    rows: Vec<Vec<f64>>,
    radius: Option<f64>,
}

impl<'p> LeastSquares<'p> {
    /// Solver from a start, with the same bounds for every coordinate.
    pub fn new(
        start: &[f64],
        bounds: [f64; 2],
        residuals: Residuals<'p>,
        derivatives: Derivatives<'p>,
    ) -> Self {
        let x: Vec<f64> = start.iter().map(|x| inside(*x, bounds, START_INSIDE)).collect();
        let (r, rows) = (residuals(&x), derivatives(&x));
        Self { bounds, residuals, derivatives, x, r, rows, radius: None }
    }

    /// Performs one iteration and returns the new point; `None` at the end.
    pub fn step(&mut self) -> Option<Vec<f64>> {
        let model = Model::new(&self.x, self.bounds, &self.r, &self.rows)?;
        let mut radius = self.radius.unwrap_or_else(|| {
            let length = norm(&self.x.iter().zip(&model.d).map(|(x, d)| x / d).collect::<Vec<_>>());
            if length > 0.0 { length } else { 1.0 }
        });
        for _ in 0..TRIALS {
            let step = model.step_within(radius);
            let to = |k: usize| inside(self.x[k] + model.d[k] * step[k], self.bounds, f64::EPSILON);
            let next: Vec<f64> = (0..self.x.len()).map(to).collect();
            let step: Vec<f64> = (0..next.len()).map(|k| (next[k] - self.x[k]) / model.d[k]).collect();
            let (length, promise) = (norm(&step), -model.change(&step));
            if !(length > 0.0 && promise > 0.0) {
                return None;
            }
            let r = (self.residuals)(&next);
            let gain = 0.5 * (dot(&self.r, &self.r) - dot(&r, &r));
            if !(gain >= POOR * promise) {
                radius = SHRINK * length;
            } else if gain > GOOD * promise && length > FULL * radius {
                radius *= 2.0;
            }
            if gain > 0.0 {
                self.rows = (self.derivatives)(&next);
                (self.x, self.r, self.radius) = (next, r, Some(radius));
                return Some(self.x.clone());
            }
        }
        None
    }
}

/// Number that is inside bounds by at least a fraction of their distance.
fn inside(x: f64, [low, high]: [f64; 2], part: f64) -> f64 {
    let least = part * (high - low);
    x.clamp(low + least, high - least)
}

/// Quadratic model of the objective at a point, in the coordinates z.
struct Model<'a> {
    x: &'a [f64],
    bounds: [f64; 2],
    /// Diagonal of D.
    d: Vec<f64>,
    /// Gradient `D g`.
    g: Vec<f64>,
    /// Triangular factor of `[J D, r; C^1/2, 0]`: its columns but the last, and the last.
    rows: Vec<Vec<f64>>,
    right: Vec<f64>,
    singular: Singular,
    /// Fraction of the distance to a bound that a step covers at most.
    way: f64,
}

impl<'a> Model<'a> {
    /// Model at a point; `None` if the point is stationary or its derivatives are not finite.
    fn new(x: &'a [f64], bounds: [f64; 2], r: &[f64], rows: &[Vec<f64>]) -> Option<Self> {
        let n = x.len();
        let g: Vec<f64> = (0..n).map(|k| rows.iter().zip(r).map(|(row, r)| row[k] * r).sum()).collect();
        let distance = |k: usize| match g[k] {
            g if g < 0.0 => bounds[1] - x[k],
            g if g > 0.0 => x[k] - bounds[0],
            _ => 1.0,
        };
        let d: Vec<f64> = (0..n).map(|k| distance(k).sqrt()).collect();
        let gradient = (0..n).map(|k| d[k] * d[k] * g[k].abs()).fold(0.0, f64::max);
        if gradient <= STATIONARY || !g.iter().all(|g| g.is_finite()) {
            return None;
        }
        let column = |k: usize| {
            let mut column: Vec<f64> = rows.iter().map(|row| d[k] * row[k]).collect();
            column.extend((0..n).map(|i| if i == k { g[k].abs().sqrt() } else { 0.0 }));
            column
        };
        let mut columns: Vec<Vec<f64>> = (0..n).map(column).collect();
        columns.push(r.iter().copied().chain(std::iter::repeat_n(0.0, n)).collect());
        let mut rows = folded_rows(columns);
        let right = rows.iter_mut().filter_map(Vec::pop).collect();
        Some(Self {
            x,
            bounds,
            g: g.iter().zip(&d).map(|(g, d)| g * d).collect(),
            d,
            singular: singular(&rows, n),
            rows,
            right,
            way: MOST_OF_WAY.max(1.0 - gradient),
        })
    }

    fn product(&self, z: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| dot(row, z)).collect()
    }

    /// Change of the objective by a step.
    fn change(&self, z: &[f64]) -> f64 {
        let by_rows = self.product(z);
        dot(&self.g, z) + 0.5 * dot(&by_rows, &by_rows)
    }

    /// Step that minimises the model within a radius, without bounds.
    fn unbounded_step(&self, radius: f64) -> Vec<f64> {
        let Singular { values, directions, images } = &self.singular;
        let n = self.x.len();
        let least = f64::EPSILON * n as f64 * values[0];
        let rank = values.iter().take_while(|s| **s > least).count();
        let along: Vec<f64> = (0..rank).map(|j| dot(&images[j], &self.right) / values[j]).collect();
        let damped = |damping: f64| -> Vec<f64> {
            (0..rank).map(|j| -along[j] * values[j] / (values[j] * values[j] + damping)).collect()
        };
        let mut z = damped(0.0);
        // Newton's method for  1 / |z| = 1 / radius,  which converges from a damping that is too small.
        let mut damping = 0.0;
        for _ in 0..DAMPINGS {
            let length = norm(&z);
            if length <= (1.0 + LONGER) * radius {
                break;
            }
            let slope = (0..rank).map(|j| z[j] * z[j] / (values[j] * values[j] + damping)).sum::<f64>();
            damping += (length / radius - 1.0) * length * length / slope;
            z = damped(damping);
        }
        let scale = (radius / norm(&z)).min(1.0);
        let by = |k: usize| (0..rank).map(|j| directions[j][k] * z[j]).sum::<f64>();
        (0..n).map(|k| scale * by(k)).collect()
    }

    /// Largest multiple of a step from a point that is within the bounds.
    fn room(&self, from: &[f64], z: &[f64]) -> f64 {
        (0..z.len()).map(|k| self.room_of(from, z, k)).fold(f64::INFINITY, f64::min)
    }

    fn room_of(&self, from: &[f64], z: &[f64], k: usize) -> f64 {
        match self.d[k] * z[k] {
            by if by > 0.0 => (self.bounds[1] - from[k]) / by,
            by if by < 0.0 => (self.bounds[0] - from[k]) / by,
            _ => f64::INFINITY,
        }
    }

    /// Step that reduces the model within a radius and the bounds.
    fn step_within(&self, radius: f64) -> Vec<f64> {
        let p = self.unbounded_step(radius);
        let room = self.room(self.x, &p);
        if room >= 1.0 {
            return p;
        }
        let none = vec![0.0; p.len()];
        let to_bound: Vec<f64> = p.iter().map(|p| room * p).collect();
        let mut candidates = vec![to_bound.iter().map(|p| self.way * p).collect()];
        let turned = |k: usize| if self.room_of(self.x, &p, k) == room { -p[k] } else { p[k] };
        let reflected: Vec<f64> = (0..p.len()).map(turned).collect();
        let at_bound = |k: usize| (self.x[k] + self.d[k] * to_bound[k]).clamp(self.bounds[0], self.bounds[1]);
        let at_bound: Vec<f64> = (0..p.len()).map(at_bound).collect();
        let inside = self.room(&at_bound, &reflected);
        let within = room_in_ball(&to_bound, &reflected, radius);
        let longest = if inside <= within { self.way * inside } else { within };
        let shortest = (1.0 - self.way) * room / inside.min(within);
        if shortest <= longest {
            candidates.push(self.least_along(&to_bound, &reflected, [shortest, longest]));
        }
        let downhill: Vec<f64> = self.g.iter().map(|g| -g).collect();
        let longest = (radius / norm(&downhill)).min(self.way * self.room(self.x, &downhill));
        candidates.push(self.least_along(&none, &downhill, [0.0, longest]));
        let best = candidates.into_iter().min_by(|a, b| self.change(a).total_cmp(&self.change(b)));
        best.unwrap_or(none)
    }

    /// Point with the least value on a line: `from + t z` for t in a range.
    fn least_along(&self, from: &[f64], z: &[f64], [least, most]: [f64; 2]) -> Vec<f64> {
        let [a, b] = [from, z].map(|z| self.product(z));
        // d/dt of the model:  g z + (A from) (A z) + t |A z|^2
        let (slope, curvature) = (dot(&self.g, z) + dot(&a, &b), dot(&b, &b));
        let t = if curvature > 0.0 { -slope / curvature } else { most };
        let t = t.min(most).max(least);
        from.iter().zip(z).map(|(from, z)| from + t * z).collect()
    }
}

/// Largest t with `|from + t z| <= radius`, for a point within the radius.
fn room_in_ball(from: &[f64], z: &[f64], radius: f64) -> f64 {
    let length = norm(z);
    let along = dot(from, z) / length;
    let left = (radius * radius - dot(from, from)).max(0.0);
    let root = (along * along + left).sqrt();
    (if along > 0.0 { left / (along + root) } else { root - along }) / length
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Minimum from a start, with the number of evaluations of residuals.
    fn minimum(
        start: &[f64],
        bounds: [f64; 2],
        residuals: impl Fn(&[f64]) -> Vec<f64>,
        derivatives: impl Fn(&[f64]) -> Vec<Vec<f64>>,
    ) -> (Vec<f64>, usize) {
        let count = std::cell::Cell::new(0);
        let counted = |x: &[f64]| {
            count.set(count.get() + 1);
            residuals(x)
        };
        let mut solver = LeastSquares::new(start, bounds, Box::new(counted), Box::new(derivatives));
        let mut x = start.to_vec();
        while let Some(next) = solver.step() {
            x = next;
        }
        drop(solver);
        (x, count.get())
    }

    #[test]
    fn a_curved_valley_is_followed_to_its_end() {
        // Rosenbrock, in [-2, 2]: minimum 0 at (1, 1)
        let residuals = |x: &[f64]| vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]];
        let derivatives = |x: &[f64]| vec![vec![-20.0 * x[0], 10.0], vec![-1.0, 0.0]];
        let (x, count) = minimum(&[-1.2, 1.0], [-2.0, 2.0], residuals, derivatives);
        assert!(x.iter().all(|x| (x - 1.0).abs() < 1e-12), "{x:?}");
        assert!(count < 40, "{count} evaluations");
    }

    #[test]
    fn a_minimum_at_bounds_is_reached() {
        // min (x - 2)^2 + (x + y - 1)^2 + (y - z)^2 in [0, 1]: x = 1, y = z = 0
        let residuals = |x: &[f64]| vec![x[0] - 2.0, x[0] + x[1] - 1.0, x[1] - x[2]];
        let derivatives = |_: &[f64]| vec![vec![1.0, 0.0, 0.0], vec![1.0, 1.0, 0.0], vec![0.0, 1.0, -1.0]];
        let (x, count) = minimum(&[0.5, 0.5, 0.7], [0.0, 1.0], residuals, derivatives);
        let off = (1.0 - x[0]).abs() + x[1].abs() + x[2].abs();
        assert!(off < 1e-6, "{x:?}");
        assert!(count < 60, "{count} evaluations");
    }

    #[test]
    fn a_point_that_cannot_be_evaluated_is_avoided() {
        // ln x = -1, not defined below 0.2
        let residuals = |x: &[f64]| vec![if x[0] < 0.2 { f64::NAN } else { x[0].ln() + 1.0 }];
        let derivatives = |x: &[f64]| vec![vec![1.0 / x[0]]];
        let (x, _) = minimum(&[0.9], [0.0, 1.0], residuals, derivatives);
        assert!((x[0] - (-1.0_f64).exp()).abs() < 1e-13, "{x:?}");
    }

    #[test]
    fn a_column_without_effect_does_not_move() {
        let residuals = |x: &[f64]| vec![x[0] - 0.3, 1e-9 * (x[1] - 0.4)];
        let derivatives = |_: &[f64]| vec![vec![1.0, 0.0, 0.0], vec![0.0, 1e-9, 0.0]];
        let (x, _) = minimum(&[0.5, 0.5, 0.7], [0.0, 1.0], residuals, derivatives);
        assert!((x[0] - 0.3).abs() < 1e-13 && x[2] == 0.7, "{x:?}");
    }
}

//! Damped Gauss-Newton step for squared goals, with bounds and linearised limits.
//!
//! ```text
//! min  |r + J x|^2 + mu |x|^2    so that    0 <= at + x <= 1,    c + C x <= 0        J, C: by the parts of the bounds
//! ```
//!
//! An active-set method: constraints that a step would break are added, those with a negative multiplier are released.

use hardpoint::linalg::least_squares;

use super::problem::{LimitRow, Point, Problem};

/// Weight of an active limit, relative to the norm of the strongest column of the misfits.
const HEAVY: f64 = 1e4;
/// Linearised limits are satisfied if they are exceeded by less than this fraction of their scale.
const EXCEEDED: f64 = 1e-10;
/// Bounds are satisfied if they are exceeded by less than this fraction of their width.
const BEYOND: f64 = 1e-13;
/// A multiplier is negative if it is below minus this fraction of the largest possible gradient.
const NEGATIVE: f64 = 1e-12;
/// Maximum number of releases of one constraint, to break cycles.
const RELEASES: usize = 3;
/// Number of times of a curve at which its limit is expected to be active at once.
const ACTIVE_TIMES: usize = 4;

/// Step with its predicted effect.
pub(super) struct GaussNewton {
    /// Change of every searched variable, as a fraction of its bounds.
    pub step: Vec<f64>,
    /// Predicted decrease for linear misfits, as a fraction of the objective.
    pub promise: f64,
}

/// A constraint of the step.
#[derive(Clone, Copy)]
enum Constraint {
    /// Bound of a variable, by its index.
    Bound(usize),
    /// Limit, by the index of its row.
    Limit(usize),
}

impl GaussNewton {
    /// Computes the step; `damping` is mu as a fraction of the largest curvature.
    pub fn new(problem: &Problem<'_>, point: &Point, limit_scales: &[f64], damping: f64) -> Self {
        let mut set = ActiveSet::new(problem, point, limit_scales, damping);
        let mut step = set.solve();
        // Every bound, and every limit at some times, may be added once, and again after each release.
        for _ in 0..(RELEASES + 1) * (2 * set.at.len() + ACTIVE_TIMES * problem.limits.len() + 1) {
            let (beyond, exceeded) = (set.beyond(&step), set.exceeded(&step));
            if beyond.is_empty() && exceeded.is_empty() && !set.release(&step) {
                break;
            }
            for v in beyond {
                set.fixed[v] = Some((set.at[v] + step[v]).clamp(0.0, 1.0) - set.at[v]);
            }
            set.active.extend(exceeded);
            step = set.solve();
        }
        let before = point.misfit().powi(2);
        let after: f64 = set.misfits_after(&step).iter().map(|r| r * r).sum();
        Self { promise: if before > 0.0 { 1.0 - after / before } else { 0.0 }, step }
    }
}

/// Active constraints of a step, with the linear model of misfits and limits. Variables are fractions of their bounds.
struct ActiveSet<'a> {
    point: &'a Point,
    limit_scales: &'a [f64],
    spans: Vec<f64>,
    /// Variables at the point.
    at: Vec<f64>,
    strongest: f64,
    /// Square root of mu.
    root: f64,
    /// Steps of the variables at a bound.
    fixed: Vec<Option<f64>>,
    /// Rows of the active limits.
    active: Vec<usize>,
    releases_of_bounds: Vec<usize>,
    releases_of_limits: Vec<usize>,
}

impl<'a> ActiveSet<'a> {
    fn new(problem: &Problem<'_>, point: &'a Point, limit_scales: &'a [f64], damping: f64) -> Self {
        let spans = problem.spans();
        let (n, strongest) = (spans.len(), point.strongest(&spans));
        Self {
            point,
            limit_scales,
            spans,
            at: problem.parts(&point.design),
            strongest,
            root: damping.sqrt() * strongest,
            fixed: vec![None; n],
            active: (0..point.limits.len()).filter(|k| point.limits[*k].equal).collect(),
            releases_of_bounds: vec![0; n],
            releases_of_limits: vec![0; point.limits.len()],
        }
    }

    fn misfit(&self, k: usize, v: usize) -> f64 {
        self.point.misfits.d[k][v] * self.spans[v]
    }

    fn limit(&self, row: &LimitRow, v: usize) -> f64 {
        row.d[v] * self.spans[v] / self.limit_scales[row.of]
    }

    fn misfits_after(&self, x: &[f64]) -> Vec<f64> {
        let values = self.point.misfits.values.iter().enumerate();
        values.map(|(k, value)| value + along(|v| self.misfit(k, v), x)).collect()
    }

    fn exceeds_after(&self, row: &LimitRow, x: &[f64]) -> f64 {
        row.exceeds / self.limit_scales[row.of] + along(|v| self.limit(row, v), x)
    }

    /// Shortest step for the active constraints.
    fn solve(&self) -> Vec<f64> {
        let (rows, active) = (self.point.misfits.values.len(), &self.active);
        let mut x: Vec<f64> = self.fixed.iter().map(|x| x.unwrap_or(0.0)).collect();
        let free: Vec<usize> = (0..x.len()).filter(|v| self.fixed[*v].is_none()).collect();
        if free.is_empty() {
            return x;
        }
        let heavy = HEAVY * self.strongest;
        let entry = |row: usize, c: usize| {
            if row < rows {
                self.misfit(row, free[c])
            } else if row < rows + active.len() {
                heavy * self.limit(&self.point.limits[active[row - rows]], free[c])
            } else if row - rows - active.len() == c {
                self.root
            } else {
                0.0
            }
        };
        let limits = active.iter().map(|k| -heavy * self.exceeds_after(&self.point.limits[*k], &x));
        let right = self.misfits_after(&x).into_iter().map(|r| -r).chain(limits);
        let right = right.chain(free.iter().map(|_| 0.0)).collect();
        let count = rows + active.len() + free.len();
        let found = least_squares([count, free.len()], entry, &[right]).swap_remove(0);
        free.iter().zip(found).for_each(|(v, by)| x[*v] = if by.is_finite() { by } else { 0.0 });
        x
    }

    /// Free variables that the step moves beyond their bounds.
    fn beyond(&self, step: &[f64]) -> Vec<usize> {
        let is_beyond = |v: &usize| {
            self.fixed[*v].is_none() && !(-BEYOND..=1.0 + BEYOND).contains(&(self.at[*v] + step[*v]))
        };
        (0..step.len()).filter(is_beyond).collect()
    }

    /// Rows of limits that the step exceeds: one number of each limit, the one that exceeds it most, as its neighbours
    /// in time often follow.
    fn exceeded(&self, step: &[f64]) -> Vec<usize> {
        let limits = &self.point.limits;
        let is_exceeded =
            |k: &usize| !self.active.contains(k) && self.exceeds_after(&limits[*k], step) > EXCEEDED;
        let mut exceeded: Vec<(usize, f64)> = Vec::new();
        for k in (0..limits.len()).filter(is_exceeded) {
            let row = &limits[k];
            let by = self.exceeds_after(row, step);
            let is_same = |(known, _): &&mut (usize, f64)| {
                let known = &limits[*known];
                (known.of, known.upper) == (row.of, row.upper)
            };
            match exceeded.iter_mut().find(is_same) {
                Some(known) if by > known.1 => *known = (k, by),
                Some(_) => {}
                None => exceeded.push((k, by)),
            }
        }
        exceeded.into_iter().map(|(k, _)| k).collect()
    }

    /// Releases the constraint with the most negative multiplier. Returns false if there is none: the step is optimal.
    fn release(&mut self, step: &[f64]) -> bool {
        // J^T (r + J x) + mu x + N l = 0,   N: the outward normals of the active constraints
        let (n, point) = (step.len(), self.point);
        let after = self.misfits_after(step);
        let gradient = |v: usize| {
            (0..after.len()).map(|k| self.misfit(k, v) * after[k]).sum::<f64>()
                + self.root * self.root * step[v]
        };
        let gradient: Vec<f64> = (0..n).map(|v| -gradient(v)).collect();
        let bounds = (0..n).filter(|v| self.fixed[*v].is_some()).map(Constraint::Bound);
        let all: Vec<Constraint> = bounds.chain(self.active.iter().map(|k| Constraint::Limit(*k))).collect();
        if all.is_empty() {
            return false;
        }
        let normal = |v: usize, c: usize| match all[c] {
            Constraint::Bound(of) if of == v => {
                if self.at[v] + step[v] > 0.5 {
                    1.0
                } else {
                    -1.0
                }
            }
            Constraint::Bound(_) => 0.0,
            Constraint::Limit(k) => self.limit(&point.limits[k], v),
        };
        let multipliers = least_squares([n, all.len()], normal, &[gradient]).swap_remove(0);
        let least = -NEGATIVE * self.strongest * point.misfit();
        let is_free = |c: &usize| {
            let releases = match all[*c] {
                Constraint::Bound(v) => self.releases_of_bounds[v],
                Constraint::Limit(k) if point.limits[k].equal => RELEASES,
                Constraint::Limit(k) => self.releases_of_limits[k],
            };
            releases < RELEASES && multipliers[*c] < least
        };
        let free = (0..all.len()).filter(is_free);
        let Some(most) = free.min_by(|a, b| multipliers[*a].total_cmp(&multipliers[*b])) else {
            return false;
        };
        match all[most] {
            Constraint::Bound(v) => {
                self.fixed[v] = None;
                self.releases_of_bounds[v] += 1;
            }
            Constraint::Limit(k) => {
                self.active.retain(|known| *known != k);
                self.releases_of_limits[k] += 1;
            }
        }
        true
    }
}

/// Product of a row and a step.
fn along(row: impl Fn(usize) -> f64, x: &[f64]) -> f64 {
    (0..x.len()).map(|v| row(v) * x[v]).sum()
}

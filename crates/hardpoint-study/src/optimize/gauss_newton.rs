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
        let spans: Vec<f64> = problem.bounds.iter().map(|[low, high]| high - low).collect();
        let (n, at) = (spans.len(), problem.parts(&point.design));
        let (values, d) = (&point.misfits.values, &point.misfits.d);
        let rows = values.len();
        let strongest = point.strongest(&spans);
        let root = damping.sqrt() * strongest;
        let misfit = |k: usize, v: usize| d[k][v] * spans[v];
        let limit = |row: &LimitRow, v: usize| row.d[v] * spans[v] / limit_scales[row.of];
        let along = |row: &dyn Fn(usize) -> f64, x: &[f64]| (0..n).map(|v| row(v) * x[v]).sum::<f64>();
        let misfits_after =
            |x: &[f64]| -> Vec<f64> { (0..rows).map(|k| values[k] + along(&|v| misfit(k, v), x)).collect() };
        let exceeds_after =
            |row: &LimitRow, x: &[f64]| row.exceeds / limit_scales[row.of] + along(&|v| limit(row, v), x);
        // Steps of variables at a bound, and rows of the active limits.
        let mut fixed: Vec<Option<f64>> = vec![None; n];
        let mut active: Vec<usize> = (0..point.limits.len()).filter(|k| point.limits[*k].equal).collect();
        let (mut releases_of_bounds, mut releases_of_limits) = (vec![0; n], vec![0; point.limits.len()]);
        // Shortest step for the active constraints.
        let solve = |fixed: &[Option<f64>], active: &[usize]| -> Vec<f64> {
            let mut x: Vec<f64> = fixed.iter().map(|x| x.unwrap_or(0.0)).collect();
            let free: Vec<usize> = (0..n).filter(|v| fixed[*v].is_none()).collect();
            if free.is_empty() {
                return x;
            }
            let heavy = HEAVY * strongest;
            let entry = |row: usize, c: usize| {
                if row < rows {
                    misfit(row, free[c])
                } else if row < rows + active.len() {
                    heavy * limit(&point.limits[active[row - rows]], free[c])
                } else if row - rows - active.len() == c {
                    root
                } else {
                    0.0
                }
            };
            let limits = active.iter().map(|k| -heavy * exceeds_after(&point.limits[*k], &x));
            let right = misfits_after(&x).into_iter().map(|r| -r).chain(limits);
            let right = right.chain(free.iter().map(|_| 0.0)).collect();
            let count = rows + active.len() + free.len();
            let found = least_squares([count, free.len()], entry, &[right]).swap_remove(0);
            free.iter().zip(found).for_each(|(v, by)| x[*v] = if by.is_finite() { by } else { 0.0 });
            x
        };
        let mut step = solve(&fixed, &active);
        // Every bound, and every limit at some times, may be added once, and again after each release.
        for _ in 0..(RELEASES + 1) * (2 * n + ACTIVE_TIMES * problem.limits.len() + 1) {
            let is_beyond =
                |v: &usize| fixed[*v].is_none() && !(-BEYOND..=1.0 + BEYOND).contains(&(at[*v] + step[*v]));
            let beyond: Vec<usize> = (0..n).filter(is_beyond).collect();
            let is_exceeded =
                |k: &usize| !active.contains(k) && exceeds_after(&point.limits[*k], &step) > EXCEEDED;
            // One number of each limit, the one that exceeds it most: its neighbours in time often follow.
            let mut exceeded: Vec<(usize, f64)> = Vec::new();
            for k in (0..point.limits.len()).filter(is_exceeded) {
                let row = &point.limits[k];
                let by = exceeds_after(row, &step);
                let is_same = |(known, _): &&mut (usize, f64)| {
                    let known = &point.limits[*known];
                    (known.of, known.upper) == (row.of, row.upper)
                };
                match exceeded.iter_mut().find(is_same) {
                    Some(known) if by > known.1 => *known = (k, by),
                    Some(_) => {}
                    None => exceeded.push((k, by)),
                }
            }
            if beyond.is_empty() && exceeded.is_empty() {
                // J^T (r + J x) + mu x + N l = 0,   N: the outward normals of the active constraints
                let after = misfits_after(&step);
                let gradient = |v: usize| {
                    (0..rows).map(|k| misfit(k, v) * after[k]).sum::<f64>() + root * root * step[v]
                };
                let gradient: Vec<f64> = (0..n).map(|v| -gradient(v)).collect();
                let bounds = (0..n).filter(|v| fixed[*v].is_some()).map(Constraint::Bound);
                let all: Vec<Constraint> =
                    bounds.chain(active.iter().map(|k| Constraint::Limit(*k))).collect();
                let normal = |v: usize, c: usize| match all[c] {
                    Constraint::Bound(of) if of == v => {
                        if at[v] + step[v] > 0.5 {
                            1.0
                        } else {
                            -1.0
                        }
                    }
                    Constraint::Bound(_) => 0.0,
                    Constraint::Limit(k) => limit(&point.limits[k], v),
                };
                if all.is_empty() {
                    break;
                }
                let multipliers = least_squares([n, all.len()], normal, &[gradient]).swap_remove(0);
                let least = -NEGATIVE * strongest * point.misfit();
                let is_free = |c: &usize| {
                    let releases = match all[*c] {
                        Constraint::Bound(v) => releases_of_bounds[v],
                        Constraint::Limit(k) if point.limits[k].equal => RELEASES,
                        Constraint::Limit(k) => releases_of_limits[k],
                    };
                    releases < RELEASES && multipliers[*c] < least
                };
                let free = (0..all.len()).filter(is_free);
                let Some(most) = free.min_by(|a, b| multipliers[*a].total_cmp(&multipliers[*b])) else {
                    break;
                };
                match all[most] {
                    Constraint::Bound(v) => {
                        fixed[v] = None;
                        releases_of_bounds[v] += 1;
                    }
                    Constraint::Limit(k) => {
                        active.retain(|known| *known != k);
                        releases_of_limits[k] += 1;
                    }
                }
            }
            for v in beyond {
                fixed[v] = Some((at[v] + step[v]).clamp(0.0, 1.0) - at[v]);
            }
            active.extend(exceeded.into_iter().map(|(k, _)| k));
            step = solve(&fixed, &active);
        }
        let before = point.misfit().powi(2);
        let after: f64 = misfits_after(&step).iter().map(|r| r * r).sum();
        Self { promise: if before > 0.0 { 1.0 - after / before } else { 0.0 }, step }
    }
}

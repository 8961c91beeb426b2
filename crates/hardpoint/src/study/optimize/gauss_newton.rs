//! One damped Gauss-Newton step of goals that are squares, under bounds and linearised limits.
//!
//! ```text
//! min  |r + J x|^2 + mu |x|^2    so that    0 <= at + x <= 1,    c + C x <= 0        J, C: by the parts of the bounds
//! ```
//!
//! Active constraints are added one round after the other, never released: the next step begins anew.

use crate::linalg::least_squares;

use super::problem::{LimitRow, Point, Problem};

/// The weight of an active limit against the misfits, whose strongest column has the weight 1.
const HEAVY: f64 = 1e4;
/// Linearised limits that are exceeded by less than this part of their scale are kept.
const EXCEEDED: f64 = 1e-10;
/// Misfits up to this part of what the bounds of the strongest variable change them by may be on their way to zero.
const SMALL: f64 = 1e-3;

/// A step, and what it promises.
pub(super) struct GaussNewton {
    /// By the parts of the bounds.
    pub step: Vec<f64>,
    /// The part of the objective that it takes away if misfits are linear.
    pub promise: f64,
}

impl GaussNewton {
    /// `damped` is mu as a part of the largest curvature.
    pub fn new(problem: &Problem<'_>, point: &Point, limit_scales: &[f64], damped: f64) -> Self {
        let spans: Vec<f64> = problem.bounds.iter().map(|[low, high]| high - low).collect();
        let (n, at) = (spans.len(), problem.parts(&point.design));
        let (values, d) = (&point.misfits.values, &point.misfits.d);
        let rows = values.len();
        let strongest = point.strongest(&spans);
        let damping = damped.sqrt() * strongest;
        let limit = |row: &LimitRow, v: usize| row.d[v] * spans[v] / limit_scales[row.of];
        let mut step: Vec<Option<f64>> = vec![None; n];
        let mut active: Vec<&LimitRow> = point.limits.iter().filter(|row| row.equal).collect();
        loop {
            let free: Vec<usize> = (0..n).filter(|v| step[*v].is_none()).collect();
            let fixed = |row: &dyn Fn(usize) -> f64| -> f64 {
                step.iter().enumerate().filter_map(|(v, x)| Some(row(v) * (*x)?)).sum()
            };
            let entry = |row: usize, c: usize| {
                let v = free[c];
                match row {
                    _ if row < rows => d[row][v] * spans[v],
                    _ if row < rows + active.len() => HEAVY * strongest * limit(active[row - rows], v),
                    _ if row - rows - active.len() == c => damping,
                    _ => 0.0,
                }
            };
            let misfits = (0..rows).map(|k| -values[k] - fixed(&|v| d[k][v] * spans[v]));
            let limits = active.iter().map(|row| {
                let exceeds = row.exceeds / limit_scales[row.of] + fixed(&|v| limit(row, v));
                -HEAVY * strongest * exceeds
            });
            let right = misfits.chain(limits).chain(free.iter().map(|_| 0.0)).collect();
            let count = rows + active.len() + free.len();
            let x = match free.is_empty() {
                true => Vec::new(),
                false => least_squares([count, free.len()], entry, &[right]).swap_remove(0),
            };
            let mut full: Vec<f64> = step.iter().map(|x| x.unwrap_or(0.0)).collect();
            free.iter().zip(&x).for_each(|(v, x)| full[*v] = if x.is_finite() { *x } else { 0.0 });
            let beyond = |v: &usize| !(0.0..=1.0).contains(&(at[*v] + full[*v]));
            let stopped: Vec<usize> = free.iter().copied().filter(beyond).collect();
            let exceeded = |row: &&LimitRow| {
                let moved: f64 = (0..n).map(|v| limit(row, v) * full[v]).sum();
                !row.equal && row.exceeds / limit_scales[row.of] + moved > EXCEEDED
            };
            let is_new = |row: &&LimitRow| !active.iter().any(|known| std::ptr::eq(*known, *row));
            let added: Vec<&LimitRow> = point.limits.iter().filter(is_new).filter(exceeded).collect();
            if stopped.is_empty() && added.is_empty() {
                let left = |k: usize| {
                    (values[k] + (0..n).map(|v| d[k][v] * spans[v] * full[v]).sum::<f64>()).powi(2)
                };
                let misfit = point.misfit().powi(2);
                let promise =
                    if misfit > 0.0 { 1.0 - (0..rows).map(left).sum::<f64>() / misfit } else { 0.0 };
                return Self { step: full, promise };
            }
            for v in stopped {
                step[v] = Some((at[v] + full[v]).clamp(0.0, 1.0) - at[v]);
            }
            active.extend(added);
        }
    }
}

impl Point {
    /// Returns whether misfits are so small that they may be on their way to zero.
    pub fn is_small(&self, bounds: &[[f64; 2]]) -> bool {
        let spans: Vec<f64> = bounds.iter().map(|[low, high]| high - low).collect();
        self.misfit() <= SMALL * self.strongest(&spans)
    }
}

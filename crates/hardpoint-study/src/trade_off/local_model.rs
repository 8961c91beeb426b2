//! Model of all functions near a design: residuals are linear, other functions are their gradients, both with the
//! secants of what is left.
//!
//! ```text
//! norm of residuals:  sqrt(|r + J p|^2 + p^T S p)        any other function:  f + d^T p + p^T S p / 2
//! ```
//!
//! Norms are far from quadratic where they nearly vanish, and so are their limits; the model is not.

use super::functions::{Matrix, Residuals, Role, State};
use hardpoint_search::dot;

/// Minimum of the norm of residuals in the model, as a fraction of that at the design.
const LEAST: f64 = 1e-4;

/// Model of the functions near a design.
pub(super) struct LocalModel<'s> {
    pub base: &'s State,
    /// Secant of each block.
    pub secants: &'s [Matrix],
}

impl LocalModel<'_> {
    /// Functions of the model at a design, with their second derivatives.
    pub fn at(&self, x: &[f64]) -> State {
        let p: Vec<f64> = x.iter().zip(&self.base.x).map(|(a, b)| a - b).collect();
        let mut state = self.base.clone();
        state.x = x.to_vec();
        let bent: Vec<Vec<f64>> =
            self.secants.iter().map(|s| s.iter().map(|row| dot(row, &p)).collect()).collect();
        state.second = self.secants.to_vec();
        state.goals.fill(0.0);
        for f in &mut state.functions {
            let bent = &bent[f.block];
            match &mut f.residuals {
                Some(residuals) => {
                    let norm = residuals.norm();
                    let constant = norm - f.value;
                    let moved = residuals.values.iter().zip(&residuals.d).map(|(r, d)| r + dot(d, &p));
                    *residuals = Residuals { values: moved.collect(), d: residuals.d.clone() };
                    let (square, least) = (
                        dot(&residuals.values, &residuals.values) + dot(bent, &p),
                        residuals.least().max(LEAST * norm),
                    );
                    let value = square.max(least * least).sqrt();
                    f.d = residuals.slope().iter().zip(bent).map(|(a, b)| (a + b) / value).collect();
                    f.value = value - constant;
                    let products = residuals.products();
                    let second = &mut state.second[f.block];
                    for (i, row) in second.iter_mut().enumerate() {
                        for (j, entry) in row.iter_mut().enumerate() {
                            *entry = (products[i][j] + *entry - f.d[i] * f.d[j]) / value;
                        }
                    }
                }
                None => {
                    f.value += dot(&f.d, &p) + 0.5 * dot(bent, &p);
                    f.d.iter_mut().zip(bent).for_each(|(d, b)| *d += b);
                }
            }
            if let Role::Goal(goal) = f.role {
                state.goals[goal] += f.value;
            }
        }
        for group in 0..state.groups.len() {
            let greatest = state.greatest(Role::Peak(group));
            let (goal, value) = &mut state.groups[group];
            *value = greatest;
            state.goals[*goal] += greatest;
        }
        state
    }
}

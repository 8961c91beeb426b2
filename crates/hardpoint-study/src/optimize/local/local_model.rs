//! Model of all functions near a design: residuals are linear, other functions are their gradients, both with the
//! secants of what is left.
//!
//! ```text
//! norm of residuals:  sqrt(|r + J p|^2 + p^T S p)        any other function:  f + d^T p + p^T S p / 2
//! squares and others:  f + d^T p + |J p|^2 + p^T S p / 2
//! ```
//!
//! Norms are far from quadratic where they nearly vanish, and so are their limits; the model is not.

use super::functions::{Form, Matrix, Role, State};
use hardpoint_search::dot;

/// Minimum of the norm of residuals in the model, as a fraction of that at the design.
const LEAST: f64 = 1e-4;

/// Model of the functions near a design.
pub(crate) struct LocalModel<'s> {
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
            match &f.residuals {
                Some(residuals) => {
                    let slope = residuals.slope();
                    let moved = residuals.moved(&p);
                    let products = moved.products();
                    let second = &mut state.second[f.block];
                    let mut bend = |entry: &dyn Fn(usize, usize, f64) -> f64| {
                        for (i, row) in second.iter_mut().enumerate() {
                            row.iter_mut().enumerate().for_each(|(j, x)| *x = entry(i, j, *x));
                        }
                    };
                    match residuals.form {
                        Form::Norm => {
                            let norm = residuals.norm();
                            let constant = norm - f.value;
                            let square = dot(&moved.values, &moved.values) + dot(bent, &p);
                            let least = residuals.least().max(LEAST * norm);
                            let value = square.max(least * least).sqrt();
                            let d: Vec<f64> =
                                moved.slope().iter().zip(bent).map(|(a, b)| (a + b) / value).collect();
                            bend(&|i, j, x| (products[i][j] + x - d[i] * d[j]) / value);
                            (f.value, f.d) = (value - constant, d);
                        }
                        Form::Square => {
                            bend(&|i, j, x| 2.0 * products[i][j] + x);
                            let steps = moved.slope().into_iter().zip(slope).zip(bent);
                            let steps: Vec<f64> = steps.map(|((a, b), c)| 2.0 * (a - b) + c).collect();
                            f.value += dot(&f.d, &p) + 0.5 * dot(&steps, &p);
                            f.d.iter_mut().zip(steps).for_each(|(d, step)| *d += step);
                        }
                    }
                    f.residuals = Some(moved);
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

//! Gauss-Newton steps at the end of a search with squared goals.

use super::Descent;
use crate::optimize::assessment::LIMIT_KEPT;
use crate::optimize::gauss_newton::GaussNewton;
use crate::optimize::result::{Iteration, SearchResult};

/// Gauss-Newton steps with a smaller predicted decrease, as a fraction of the objective, are not made: the rest is
/// round-off.
const NO_PROMISE: f64 = 1e-14;
/// Initial damping of Gauss-Newton steps, as a fraction of the largest curvature.
const DAMPING: f64 = 1e-4;
/// Factor by which the damping changes after a step.
const DAMPED: f64 = 3.0;
/// Minimum damping: the square of the round-off in derivatives of motions.
const LEAST_DAMPING: f64 = 1e-22;
/// Maximum number of corrector steps that return to a valley or a limit ...
const CORRECTIONS: usize = 2;
/// ... and the factor of their damping.
const CORRECTING: f64 = 1e4;
/// A Gauss-Newton step is good if it achieves this fraction of its predicted decrease.
const GOOD: f64 = 0.25;
/// A step is idle if it achieves less than this fraction of the objective and less than predicted ...
const WEAK: f64 = 0.05;
/// ... and after this number of idle steps the misfits are too curved for Gauss-Newton steps: other solvers finish the
/// search.
const IDLE: usize = 4;
/// Gauss-Newton steps are then tried again only if they predict a decrease by this fraction of the objective.
const MUCH: f64 = 0.5;
/// Predicted decrease of the first step, as a fraction of that of the longest step.
const FAIR: f64 = 0.1;
/// A step that increases the objective by this factor is not corrected.
const ASTRAY: f64 = 1e4;

impl Descent<'_> {
    /// Damped Gauss-Newton steps under bounds and limits from the best design, as long as they make progress.
    ///
    /// Small misfits lie in narrow curved valleys and on curved limits, which a straight step leaves. Up to
    /// [`CORRECTIONS`] further steps with much greater damping return to the valley before the designs are compared.
    pub(super) fn polish(&mut self, search: &mut SearchResult, tell: &mut dyn FnMut(&Iteration)) {
        let n = self.at.len();
        let promise =
            |run: &Self, damping| GaussNewton::new(run.problem, &run.best, &run.scales, damping).promise;
        let (mut damping, mut failures, mut idle) = (DAMPING, 0, 0);
        let most = promise(self, LEAST_DAMPING);
        if self.is_curved && most < MUCH {
            return;
        }
        while damping > LEAST_DAMPING && promise(self, damping) < FAIR * most {
            damping = (damping / DAMPED).max(LEAST_DAMPING);
        }
        while idle < IDLE && self.best.has_only_squares() && self.violation(&self.best) <= LIMIT_KEPT {
            if self.is_sharp(&self.best) || self.optimality(&self.best).met {
                return;
            }
            self.return_to_best();
            let before = self.best.objective();
            let mut promised = 0.0;
            let mut gained = None;
            for correction in 0..=CORRECTIONS {
                if self.memory.interrupted() {
                    return;
                }
                if search.iterations.len() > self.problem.settings.iterations {
                    self.ran_out = true;
                    return;
                }
                let damping = if correction == 0 { damping } else { damping * CORRECTING };
                let GaussNewton { step, promise } =
                    GaussNewton::new(self.problem, &self.here, &self.scales, damping);
                if correction == 0 {
                    promised = promise;
                    if promised <= NO_PROMISE {
                        return;
                    }
                }
                let at: Vec<f64> = (0..n).map(|v| (self.at[v] + step[v]).clamp(0.0, 1.0)).collect();
                if at == self.at {
                    break;
                }
                let Some(point) = self.memory.at(&at, |found| found.as_ref().ok().cloned()) else { break };
                let from = (std::mem::replace(&mut self.at, at), std::mem::replace(&mut self.here, point));
                if self.is_better(&self.here, &self.best) {
                    self.best = self.here.clone();
                }
                self.note(search, Some(from), tell);
                let now = self.here.objective();
                if self.violation(&self.here) <= LIMIT_KEPT && now <= (1.0 - GOOD * promised) * before {
                    gained = Some(correction == 0);
                    break;
                }
                if now > ASTRAY * before {
                    break;
                }
            }
            let less = self.best.objective() < (1.0 - WEAK) * before;
            (damping, failures) = match gained {
                Some(true) => (damping / (DAMPED * DAMPED), 0),
                Some(false) => (damping / DAMPED, 0),
                None if less => (damping, 0),
                None => (damping * DAMPED.powi(failures + 1), failures + 1),
            };
            damping = damping.max(LEAST_DAMPING);
            idle = if less { 0 } else { idle + usize::from(gained != Some(true)) };
            self.is_curved |= idle == IDLE;
        }
    }
}

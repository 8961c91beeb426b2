//! Designs that are optimal to first order and greatest along a variable that no search moves.
//!
//! ```text
//! grad f = 0 along these variables,    u . H u < 0    with H their second derivatives, by differences of gradients
//! ```

use super::Descent;
use crate::optimize::optimality::BINDS;
use crate::optimize::problem::Point;
use crate::optimize::result::{Iteration, SearchResult};

/// Change, as a fraction of the bounds, below which a search has not moved a variable.
const UNMOVED: f64 = 1e-9;
/// Step of differences of exact gradients, as a fraction of the bounds.
const DIFFERENCE: f64 = 1e-4;
/// Negative curvature, as a fraction of the largest entry of H, that is more than the error of differences, which is of
/// the size of the step.
const CURVED: f64 = 1e-2;
/// Maximum number of variables that are examined, each at the cost of a design.
const MOST_EXAMINED: usize = 32;
/// Passes of the power method, which need only a direction that is roughly that of the most negative curvature.
const PASSES: usize = 60;
/// Steps along it that are tried, as fractions of the bounds.
const STEPS: [f64; 5] = [0.2, 0.05, 0.01, 2e-3, 4e-4];

impl Descent<'_> {
    /// Continues from a better design beside a saddle or a maximum, if the best one is such a design: one that is
    /// symmetric in a variable has no derivative by it, so that searches do not move it. Returns false otherwise.
    pub(super) fn leave_saddle(
        &mut self,
        search: &mut SearchResult,
        tell: &mut dyn FnMut(&Iteration),
    ) -> bool {
        let optimality = self.optimality(&self.best);
        if optimality.met || optimality.vanishes || self.has_no_effect || self.ran_out {
            return false;
        }
        let at = self.problem.parts(&self.best.design);
        let is_unmoved =
            |v: &usize| (at[*v] - self.start[*v]).abs() <= UNMOVED && at[*v] > BINDS && at[*v] < 1.0 - BINDS;
        let unmoved: Vec<usize> = (0..at.len()).filter(is_unmoved).take(MOST_EXAMINED).collect();
        let Some(direction) = self.most_negative(&at, &unmoved) else { return false };
        for step in STEPS {
            for signed in [step, -step] {
                let mut next = at.clone();
                for (v, u) in unmoved.iter().zip(&direction) {
                    next[*v] = (at[*v] + signed * u).clamp(0.0, 1.0);
                }
                if self.memory.interrupted() {
                    return false;
                }
                let Some(point) = self.memory.at(&next, |found| found.as_ref().ok().cloned()) else {
                    continue;
                };
                if self.is_better(&point, &self.best) {
                    self.return_to_best();
                    let before =
                        (std::mem::replace(&mut self.at, next), std::mem::replace(&mut self.here, point));
                    self.best = self.here.clone();
                    self.note(search, Some(before), tell);
                    return true;
                }
            }
        }
        false
    }

    /// Direction of negative curvature of the objective among these variables, with a largest component of 1.
    fn most_negative(&self, at: &[f64], variables: &[usize]) -> Option<Vec<f64>> {
        let gradient = |at: &[f64]| {
            let by_bounds = |(g, [low, high]): (f64, &[f64; 2])| g * (high - low);
            let of = |point: &Point| -> Vec<f64> {
                point.gradient(at.len()).into_iter().zip(&self.problem.bounds).map(by_bounds).collect()
            };
            self.memory.at(at, |found| found.as_ref().ok().map(of))
        };
        let here = gradient(at)?;
        let mut second = vec![vec![0.0; variables.len()]; variables.len()];
        for (k, v) in variables.iter().enumerate() {
            if self.memory.interrupted() {
                return None;
            }
            let step = if at[*v] < 0.5 { DIFFERENCE } else { -DIFFERENCE };
            let mut moved = at.to_vec();
            moved[*v] += step;
            let there = gradient(&moved)?;
            for (l, w) in variables.iter().enumerate() {
                let half = 0.5 * (there[*w] - here[*w]) / step;
                second[k][l] += half;
                second[l][k] += half;
            }
        }
        let times = |u: &[f64]| -> Vec<f64> {
            second.iter().map(|row| row.iter().zip(u).map(|(h, u)| h * u).sum()).collect()
        };
        let largest = second.iter().flatten().fold(0.0, |most: f64, h| most.max(h.abs()));
        // The power method on |H| I - H, from the variable of least curvature.
        let bound = second.iter().map(|row| row.iter().map(|h| h.abs()).sum()).fold(0.0, f64::max);
        let least = (0..variables.len()).min_by(|a, b| second[*a][*a].total_cmp(&second[*b][*b]))?;
        let mut u: Vec<f64> = (0..variables.len()).map(|k| if k == least { 1.0 } else { 0.1 }).collect();
        for _ in 0..PASSES {
            let next: Vec<f64> = u.iter().zip(times(&u)).map(|(u, hu)| bound * u - hu).collect();
            let size = next.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            if !(size > 0.0 && size.is_finite()) {
                return None;
            }
            u = next.into_iter().map(|x| x / size).collect();
        }
        let curvature: f64 = u.iter().zip(times(&u)).map(|(u, hu)| u * hu).sum();
        let square: f64 = u.iter().map(|u| u * u).sum();
        (curvature < -CURVED * largest * square).then_some(u)
    }
}

//! Steps to the optimum of the weighted sum of all goals.

use super::functions::{Scale, State};
use super::scalarization::{Curvatures, Minimization, SHARP, STEPS, Scalarization};
use crate::optimize::assessment::THE_SAME;
use crate::optimize::problem::Point;
use crate::optimize::solver::{Memory, Solver};

/// The first step has to achieve this part of its prediction: otherwise models do not describe the problem, and their
/// steps lead anywhere.
const FAITHFUL: f64 = 0.7;
/// A later one has to achieve this part ...
const FAIR: f64 = 0.1;
/// ... if it is predicted to gain more than this part of all steps before.
const MUCH: f64 = 0.1;

/// Solver by local models of the objective and all limits.
pub(crate) struct LocalSteps<'p> {
    scalarization: Scalarization<'p>,
    minimization: Minimization,
    has_ended: bool,
    /// Decrease of the objective so far.
    gained: f64,
    /// Decrease of the objective that is round-off.
    round_off: f64,
    is_unfit: bool,
}

impl<'p> LocalSteps<'p> {
    /// Solver from a start; `None` for goals without a local model and where the objective has no slope.
    pub fn new(memory: &'p Memory<'p>, start: &[f64], point: &Point, limit_scales: &[f64]) -> Option<Self> {
        if !point.extrema.is_empty() {
            return None;
        }
        let state = State::of_sum(memory.problem, limit_scales, start.to_vec(), point.clone());
        let steepest = state.steepest();
        if steepest[0] == 0.0 {
            return None;
        }
        let scale = Scale { zero: state.goals.clone(), range: steepest, steepest: vec![1.0] };
        let round_off = THE_SAME * scale.zero[0].abs() / scale.range[0];
        let curvatures = Curvatures::of_weights(&state, &scale, &[1.0], Curvatures::default());
        let scalarization = Scalarization {
            memory,
            state: State::of_sum,
            limit_scales: limit_scales.to_vec(),
            scale,
            reference: vec![Some([0.0, 1.0])],
            near: 1.0,
            sharp: SHARP,
            steps: STEPS,
        };
        let minimization = scalarization.minimization(state, curvatures);
        Some(Self { scalarization, minimization, has_ended: false, gained: 0.0, round_off, is_unfit: false })
    }
}

impl Solver for LocalSteps<'_> {
    fn step(&mut self) -> Option<Vec<f64>> {
        let before = self.minimization.here.x.clone();
        while !self.has_ended && self.minimization.here.x == before {
            self.has_ended = self.scalarization.memory.interrupted()
                || !self.scalarization.advance(&mut self.minimization, 0.0);
            let Some([predicted, achieved]) = self.minimization.outcome else {
                // The model is least where it begins.
                self.has_ended = true;
                break;
            };
            let least = if self.gained > 0.0 { FAIR } else { FAITHFUL };
            if predicted > MUCH * self.gained && achieved < least * predicted {
                self.is_unfit = predicted > self.round_off;
                self.has_ended = true;
                break;
            }
            self.gained += achieved.max(0.0);
        }
        (self.minimization.here.x != before).then(|| self.minimization.here.x.clone())
    }

    fn is_unfit(&self) -> bool {
        self.is_unfit
    }
}

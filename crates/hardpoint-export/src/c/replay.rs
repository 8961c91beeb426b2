//! Replay of a model's motion by the formulas, before they are written.

use hardpoint::model::Model;
use hardpoint::motion::{DrivenStep, MotionCheck};

/// A correction below this leaves round-off, as in `control.c`.
const QUADRATIC: f64 = 1e-8;
const MOST_CORRECTIONS: usize = 12;
const MOST_GROWTH: f64 = 1e4;
const LEAST_PIVOT: f64 = 1e-12;

/// First output time that the formulas do not reach; `None` if they reach all.
pub fn end(model: &Model, step: &DrivenStep) -> Option<f64> {
    let mut replay = Replay {
        step,
        inputs: step.coordinates.iter().map(|c| c.start).collect(),
        values: Vec::new(),
        found: vec![0.0; usize::max(step.motion.outputs.len(), step.path.outputs.len())],
    };
    replay.inputs.extend(step.drivers.iter().flat_map(|d| [d.start, 0.0, 0.0]));
    let mut reaches = |t: &f64| {
        let drivers: Vec<[f64; 3]> = model
            .drivers
            .iter()
            .map(|driver| {
                let [value, rate, acceleration, _] = driver.law.at(*t).derivatives();
                [value, rate, acceleration]
            })
            .collect();
        replay.reaches(&drivers)
    };
    model.times.iter().copied().find(|t| !reaches(t))
}

struct Replay<'a> {
    step: &'a DrivenStep,
    /// Coordinates, then value, rate and acceleration of every driver.
    inputs: Vec<f64>,
    values: Vec<f64>,
    found: Vec<f64>,
}

impl Replay<'_> {
    /// Moves straight to this motion of the drivers; returns true if all checks pass there.
    fn reaches(&mut self, drivers: &[[f64; 3]]) -> bool {
        let Self { step, inputs, values, found } = self;
        let n = step.coordinates.len();
        for (at, to) in inputs[n..].chunks_exact_mut(3).zip(drivers) {
            (at[1], at[2]) = (to[0] - at[0], 0.0);
        }
        step.path.evaluate(inputs, &[], values, found);
        for k in 0..n {
            inputs[k] += found[2 * k] + 0.5 * found[2 * k + 1];
        }
        for (at, to) in inputs[n..].chunks_exact_mut(3).zip(drivers) {
            at.copy_from_slice(to);
        }
        for _ in 0..MOST_CORRECTIONS {
            step.correction.evaluate(inputs, &[], values, found);
            inputs[..n].copy_from_slice(&found[..n]);
            if found[n] <= QUADRATIC {
                break;
            }
        }
        let is_solved = found[n] <= QUADRATIC;
        step.motion.evaluate(inputs, &[], values, found);
        let check = |which: MotionCheck| found[which as usize];
        // NaN fails.
        is_solved
            && check(MotionCheck::Limit) <= 0.0
            && check(MotionCheck::Branch) <= 0.0
            && check(MotionCheck::Growth) <= MOST_GROWTH
            && 1.0 / check(MotionCheck::Pivots) > LEAST_PIVOT
    }
}

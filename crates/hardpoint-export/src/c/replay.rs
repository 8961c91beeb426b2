//! Replay of a model's motion by the formulas, before they are written.

use hardpoint::measure::MeasureFormulas;
use hardpoint::model::{Driver, Model};
use hardpoint::motion::{DrivenStep, MotionCheck};

use super::emit::BODY;

/// A correction below this leaves round-off, as in `control.c`.
const QUADRATIC: f64 = 1e-8;
const MOST_CORRECTIONS: usize = 12;
const MOST_GROWTH: f64 = 1e4;
const LEAST_PIVOT: f64 = 1e-12;

/// Result of a replay.
pub struct ReplayResult {
    /// First output time that the formulas do not reach, if any.
    pub end: Option<f64>,
    /// Per output: output times at which its formula is undefined.
    pub undefined: Vec<Vec<usize>>,
    /// Largest residual of a constraint at the output times, rad or sizes of loops.
    pub residual: f64,
}

/// Inputs of the programs where the motion starts, at rest, with the nominal design.
pub fn start_inputs(step: &DrivenStep) -> Vec<f64> {
    let mut inputs: Vec<f64> = step.coordinates.iter().map(|c| c.start).collect();
    inputs.resize(step.position_inputs(), 0.0);
    step.place_pieces(&mut inputs);
    inputs.extend(step.drivers.iter().flat_map(|d| [d.start, 0.0, 0.0]));
    inputs.extend(step.design.iter().map(|_| 0.0));
    inputs
}

/// Replays the motion of the model.
pub fn replay(model: &Model, step: &DrivenStep, formulas: Option<&MeasureFormulas>) -> ReplayResult {
    let mut replay = Replay {
        step,
        inputs: start_inputs(step),
        values: Vec::new(),
        found: vec![0.0; usize::max(step.motion.outputs.len(), step.path.outputs.len())],
    };
    let outputs = formulas.map_or(0, |f| f.program.outputs.len());
    let mut undefined = vec![Vec::new(); outputs / 4];
    let mut residual: f64 = 0.0;
    let (mut inputs, mut found) = (Vec::new(), vec![0.0; outputs]);
    for (k, &t) in model.times.iter().enumerate() {
        let of = |driver: &Driver| {
            let [value, rate, acceleration, _] = driver.law.at(t).derivatives();
            [value, rate, acceleration]
        };
        let drivers: Vec<[f64; 3]> = model.drivers.iter().map(of).collect();
        if !replay.reaches(&drivers) {
            return ReplayResult { end: Some(t), undefined, residual };
        }
        residual = residual.max(replay.found[MotionCheck::Residual as usize]);
        let Some(formulas) = formulas else { continue };
        let bodies = &replay.found[step.motion.outputs.len() - BODY * (model.bodies.len() - 1)..];
        inputs.clear();
        formulas.bodies.iter().for_each(|b| inputs.extend(&bodies[BODY * (b - 1)..][..BODY]));
        inputs.resize(formulas.program.inputs, 0.0);
        formulas.program.evaluate(&inputs, &[], &mut replay.values, &mut found);
        for (times, guard) in undefined.iter_mut().zip(&found) {
            // NaN is undefined.
            if !(*guard <= 0.0) {
                times.push(k);
            }
        }
    }
    ReplayResult { end: None, undefined, residual }
}

struct Replay<'a> {
    step: &'a DrivenStep,
    /// Coordinates and pieces of the curves, then value, rate and acceleration of every driver.
    inputs: Vec<f64>,
    values: Vec<f64>,
    found: Vec<f64>,
}

impl Replay<'_> {
    /// Moves straight to this motion of the drivers; returns true if all checks pass there.
    fn reaches(&mut self, drivers: &[[f64; 3]]) -> bool {
        let Self { step, inputs, values, found } = self;
        let (n, drivers_at) = (step.coordinates.len(), step.position_inputs());
        for (at, to) in inputs[drivers_at..].chunks_exact_mut(3).zip(drivers) {
            (at[1], at[2]) = (to[0] - at[0], 0.0);
        }
        step.path.evaluate(inputs, &[], values, found);
        for k in 0..n {
            inputs[k] += found[2 * k] + 0.5 * found[2 * k + 1];
        }
        step.place_pieces(inputs);
        for (at, to) in inputs[drivers_at..].chunks_exact_mut(3).zip(drivers) {
            at.copy_from_slice(to);
        }
        for _ in 0..MOST_CORRECTIONS {
            step.correction.evaluate(inputs, &[], values, found);
            inputs[..n].copy_from_slice(&found[..n]);
            step.place_pieces(inputs);
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

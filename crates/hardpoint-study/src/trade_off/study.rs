//! Front of the goals of a request: the optimum of each goal, then the points between.

use std::sync::atomic::{AtomicBool, Ordering};

use hardpoint::model::{Model, OptimizationSettings};

use super::front::{Anchor, End, Front};
use super::request::Request;
use super::result::{Outcome, TradeOff};
use crate::evaluation::{Motions, StudyCost};
use crate::optimize::{
    self, BINDS, Curvatures, MET, Memory, Problem, Reference, SHARP, STEPS, Scalarization, Scale, Solved,
    State, Status, assess, failed_design, limit_scales,
};
use crate::progress::{Control, Progress, Step};

/// Change, as a fraction of the bounds, below which a search has not moved a variable.
const UNMOVED: f64 = 1e-9;

/// Computes the front of the goals of a request. Reports every point.
///
/// `motions` are those of the model ([`Model::motions`]), in order.
pub fn trade_off(model: &Model, motions: &Motions<'_>, request: &Request, control: Control<'_>) -> TradeOff {
    let Request { settings, points } = request;
    let Control { progress, more, threads } = control;
    let problem = Problem::new(model, motions, settings);
    let ended = AtomicBool::new(false);
    let go_on = || !ended.load(Ordering::Relaxed) && more();
    let memory = Memory::new(&problem, &go_on);
    let undesigned = vec![0.0; model.variables.len()];
    let mut result = TradeOff {
        nominal: None,
        nominal_failure: None,
        nominal_values: None,
        outcome: Outcome::Interrupted,
        points: Vec::new(),
        jumps: Vec::new(),
        failed: 0,
        dominated: 0,
        anchor_designs: 0,
        cost: StudyCost::default(),
    };
    let mut nominal = None;
    match problem.at(undesigned.clone(), &mut memory.cost.borrow_mut(), &go_on) {
        Ok(point) => {
            let scales = limit_scales(&problem, &point);
            result.nominal = Some(assess(&problem, &point, &scales));
            let state = State::new(&problem, &scales, problem.parts(&undesigned), point);
            result.nominal_values = Some(state.goals.clone());
            nominal = Some(state);
        }
        Err(refusal) => result.nominal_failure = Some(failed_design(undesigned, refusal)),
    }
    let mut report = |step: Progress<'_>| {
        progress(Progress { step: step.step, done: 0, total: *points, is_counted: false })
    };
    let control = Control { threads, progress: &mut report, more };
    let anchors = match anchors(&memory, nominal.as_ref(), control, &mut result) {
        Ok(anchors) => anchors,
        Err(outcome) => {
            result.cost += memory.cost.take();
            return TradeOff { outcome, ..result };
        }
    };
    let mut count = 0;
    let mut report = || {
        count += 1;
        let step = Progress { step: Step::FrontPoint, done: count, total: *points, is_counted: true };
        if progress(step).is_break() {
            ended.store(true, Ordering::Relaxed);
        }
    };
    match Front::new(&memory, anchors, nominal.as_ref()) {
        Ok(mut front) => {
            let end = front.fill(*points, &mut report);
            result.outcome = match end {
                _ if memory.interrupted() => Outcome::Interrupted,
                End::Filled => Outcome::Front,
                End::SinglePoint => Outcome::NoConflict,
            };
            front.into_result(&mut result);
        }
        Err(_) if memory.interrupted() => {}
        Err(goal) => result.outcome = Outcome::NoEnd(goal),
    }
    result.cost += memory.cost.take();
    result
}

/// Optimum of each goal alone, as fractions of the bounds, with the cost added to the result; the outcome of the
/// trade-off if one is not found.
fn anchors(
    memory: &Memory<'_>,
    nominal: Option<&State>,
    control: Control<'_>,
    result: &mut TradeOff,
) -> Result<Vec<Anchor>, Outcome> {
    let Control { threads, progress, more } = control;
    let problem = memory.problem;
    let (mut anchors, mut curvatures) = (Vec::new(), Curvatures::default());
    for (goal, alone) in problem.settings.goals.iter().enumerate() {
        let before = memory.cost.borrow().designs;
        let near = nominal.filter(|_| problem.settings.starts == 1);
        let near = near.and_then(|nominal| nearest_optimum(memory, nominal, goal, &mut curvatures));
        result.anchor_designs += memory.cost.borrow().designs - before;
        if let Some(x) = near {
            anchors.push(Anchor { x, curvatures: curvatures.clone() });
            continue;
        }
        let settings = OptimizationSettings { goals: vec![alone.clone()], ..problem.settings.clone() };
        let request = optimize::Request { settings, first: 0 };
        let control = Control { threads, progress: &mut *progress, more };
        let found = optimize::optimize(problem.model, problem.motions, &request, control);
        result.cost += found.cost;
        result.anchor_designs += found.cost.designs;
        let search = found.best.map(|k| &found.searches[k]);
        let status = search.or(found.searches.first()).map_or(Status::NoStart, |s| s.status);
        match search.and_then(|s| s.found.as_ref()).filter(|f| f.violation <= optimize::LIMIT_KEPT) {
            Some(found) if !matches!(status, Status::Interrupted | Status::NoEffect) => {
                let curvatures = Curvatures::default();
                anchors.push(Anchor { x: problem.parts(&found.design), curvatures });
            }
            _ if status == Status::Interrupted => return Err(Outcome::Interrupted),
            _ => return Err(Outcome::NoAnchor(goal, status)),
        }
    }
    Ok(anchors)
}

/// Optimum of a goal alone that the steps of a front lead to from the nominal design, as fractions of the bounds;
/// `None` if they do not, if the goal vanishes there, or if a variable within its bounds has not moved: the nominal
/// design may be symmetric in it, and a saddle.
fn nearest_optimum(
    memory: &Memory<'_>,
    nominal: &State,
    goal: usize,
    known: &mut Curvatures,
) -> Option<Vec<f64>> {
    let limit_scales = limit_scales(memory.problem, &nominal.point);
    let count = nominal.goals.len();
    let steepest = nominal.steepest();
    if steepest.contains(&0.0) {
        return None;
    }
    let scale = Scale { zero: nominal.goals.clone(), range: steepest, steepest: vec![1.0; count] };
    let mut reference: Reference = vec![None; count];
    reference[goal] = Some([0.0, 1.0]);
    let mut weights = vec![0.0; count];
    weights[goal] = 1.0;
    let curvatures = Curvatures::of_weights(nominal, &scale, &weights, known.clone());
    let is_met = |state: &State| state.squares[goal] && state.goals[goal] <= MET * scale.range[goal];
    let steps = STEPS.min(memory.problem.settings.iterations);
    let scalarization = Scalarization {
        memory,
        state: State::new,
        limit_scales,
        scale: scale.clone(),
        reference,
        near: 1.0,
        sharp: SHARP,
        steps,
    };
    let Solved { state, criticality, curvatures } = scalarization.solve(nominal.clone(), curvatures)?;
    *known = curvatures;
    let has_moved = |(x, from): (&f64, &f64)| (x - from).abs() > UNMOVED || *x < BINDS || *x > 1.0 - BINDS;
    let is_found =
        criticality.residual <= SHARP && !is_met(&state) && state.x.iter().zip(&nominal.x).all(has_moved);
    is_found.then_some(state.x)
}

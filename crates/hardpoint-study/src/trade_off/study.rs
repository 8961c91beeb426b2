//! Front of the goals of a request: the optimum of each goal, then the points between.

use std::sync::atomic::{AtomicBool, Ordering};

use hardpoint::model::{Model, OptimizationSettings};

use super::front::{End, Front};
use super::functions::State;
use super::request::Request;
use super::result::{Outcome, TradeOff};
use crate::evaluation::{Motions, StudyCost};
use crate::optimize::{self, Memory, Problem, Status, assess, failed_design, limit_scales};
use crate::progress::{Control, Progress, Step};

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
    let anchors = match anchors(&problem, Control { threads, progress: &mut report, more }, &mut result) {
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
    problem: &Problem<'_>,
    control: Control<'_>,
    result: &mut TradeOff,
) -> Result<Vec<Vec<f64>>, Outcome> {
    let Control { threads, progress, more } = control;
    let mut anchors = Vec::new();
    for (goal, alone) in problem.settings.goals.iter().enumerate() {
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
                anchors.push(problem.parts(&found.design));
            }
            _ if status == Status::Interrupted => return Err(Outcome::Interrupted),
            _ => return Err(Outcome::NoAnchor(goal, status)),
        }
    }
    Ok(anchors)
}

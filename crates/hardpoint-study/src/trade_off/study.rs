//! Front of the goals of a request: the optimum of each goal, then the points between.

use std::sync::atomic::{AtomicBool, Ordering};

use hardpoint::model::Model;

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
    // The optimum of each goal alone.
    let mut anchors = Vec::new();
    for goal in 0..settings.goals.len() {
        let mut alone = settings.clone();
        alone.goals = vec![settings.goals[goal].clone()];
        let alone = optimize::Request { settings: alone, first: 0 };
        let mut report = |step: Progress<'_>| {
            progress(Progress { step: step.step, done: 0, total: *points, is_counted: false })
        };
        let control = Control { threads, progress: &mut report, more };
        let found = optimize::optimize(model, motions, &alone, control);
        result.cost += found.cost;
        result.anchor_designs += found.cost.designs;
        let search = found.best.map(|k| &found.searches[k]);
        let status = search.or(found.searches.first()).map_or(Status::NoStart, |s| s.status);
        match search.and_then(|s| s.found.as_ref()).filter(|f| f.violation <= optimize::LIMIT_KEPT) {
            Some(found) if !matches!(status, Status::Interrupted | Status::NoEffect) => {
                anchors.push(problem.parts(&found.design));
            }
            _ => {
                result.cost += memory.cost.take();
                if status != Status::Interrupted {
                    result.outcome = Outcome::NoAnchor(goal, status);
                }
                return result;
            }
        }
    }
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

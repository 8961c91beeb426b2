//! Trade-off between goals: which designs are the best compromises, and what does one goal cost in the others?
//!
//! Input: a [`Request`] with two or three goals, bounds and limits. Output: a [`TradeOff`] with designs spread over the
//! front, none better than another in all goals, each with its residual of the first-order condition (theory (76)).
//!
//! ```text
//! optimum of each goal alone  ->  points between neighbours, in the widest gaps first  ->  points not dominated
//! ```
//!
//! Each point is the solution of a scalar problem ([`scalarization`]) that starts at a design interpolated between its
//! neighbours, with their multipliers and curvatures, and ends after a few steps. Goals are fractions of their ranges
//! over the anchors, so that results do not depend on units and weights. A front of three goals has the fronts of their
//! pairs as its sides, and its inside starts from a surface spanned between them.

mod front;
mod functions;
mod request;
mod scalarization;

use hardpoint::model::Model;

use crate::evaluation::{Motions, StudyCost};
use crate::optimize::{
    self, DesignAssessment, FailedDesign, Memory, Problem, Status, assess, failed_design, limit_scales,
};
use crate::progress::{Control, Progress, Step};
use front::{End, Front};
pub use request::{Overrides, Request};

/// Residual of the first-order condition of every point of a front.
pub const ON_FRONT: f64 = 1e-6;

/// Result of a trade-off.
#[derive(Clone, Debug)]
pub struct TradeOff {
    /// Nominal design; `None` if it cannot be evaluated.
    pub nominal: Option<DesignAssessment>,
    /// Reason why the nominal design cannot be evaluated.
    pub nominal_failure: Option<FailedDesign>,
    /// Goals of the nominal design, as [`FrontPoint::values`].
    pub nominal_values: Option<Vec<f64>>,
    /// Outcome.
    pub outcome: Outcome,
    /// Designs on the front, in ascending order of the first goal.
    pub points: Vec<FrontPoint>,
    /// Neighbours on a front of two goals between which it has a jump: no compromise is between them.
    pub jumps: Vec<[usize; 2]>,
    /// Number of points that were not found to the required residual.
    pub failed: usize,
    /// Number of points found that others dominate.
    pub dominated: usize,
    /// Number of designs evaluated for the optimum of each goal.
    pub anchor_designs: usize,
    /// Total cost.
    pub cost: StudyCost,
}

impl TradeOff {
    /// Index of the balanced compromise: the point with the smallest largest loss, where the loss in a goal is its
    /// distance from its minimum over the points, as a fraction of its range over them.
    pub fn balanced(&self) -> Option<usize> {
        let goals = 0..self.points.first()?.values.len();
        let range = |k: usize| {
            let values = self.points.iter().map(|p| p.values[k]);
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
        };
        let ranges: Vec<[f64; 2]> = goals.map(range).collect();
        let loss = |p: &FrontPoint| {
            let goals = p.values.iter().zip(&ranges).filter(|(_, [low, high])| low < high);
            goals.map(|(x, [low, high])| (x - low) / (high - low)).fold(0.0, f64::max)
        };
        (0..self.points.len()).min_by(|a, b| loss(&self.points[*a]).total_cmp(&loss(&self.points[*b])))
    }
}

/// Outcome of a trade-off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The front was found.
    Front,
    /// One design is the optimum of all goals: they do not conflict.
    NoConflict,
    /// The caller ended the study.
    Interrupted,
    /// The optimum of a goal, by its index, was not found, or the goal depends on no variable; the status of the
    /// search.
    NoAnchor(usize, Status),
    /// The optimum of a goal, by its index, was found, but another goal or a limit has no derivative there: the front
    /// has no end.
    NoEnd(usize),
}

/// Design on a front.
#[derive(Clone, Debug)]
pub struct FrontPoint {
    /// The design with all goals and limits.
    pub assessment: DesignAssessment,
    /// Traded goals, SI: the metric, its distance from the target, or for several cases their sum or the root of the
    /// sum of squares.
    pub values: Vec<f64>,
    /// Weights with which the sum of the goals, as fractions of their ranges, is stationary at this design; their sum
    /// is 1.
    pub weights: Vec<f64>,
    /// Change of each goal, in SI units, per SI unit of the first goal along the front, if all others are constant: the
    /// ratio of the weights. `None` if one of the two weights vanishes.
    pub rates: Vec<Option<f64>>,
    /// Residual of the first-order condition, theory (76).
    pub residual: f64,
    /// Index of the goal that has its optimum here.
    pub anchor: Option<usize>,
    /// Number of designs evaluated for this point, without those for the optimum of a single goal.
    pub designs: usize,
}

/// Computes the front of the goals of a request. Reports every point.
///
/// `motions` are those of the model ([`Model::motions`]), in order.
pub fn trade_off(model: &Model, motions: &Motions<'_>, request: &Request, control: Control<'_>) -> TradeOff {
    let Request { settings, points } = request;
    let Control { progress, more, threads } = control;
    let problem = Problem::new(model, motions, settings);
    let ended = std::sync::atomic::AtomicBool::new(false);
    let go_on = || !ended.load(std::sync::atomic::Ordering::Relaxed) && more();
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
            let state = functions::State::new(&problem, &scales, problem.parts(&undesigned), point);
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
            ended.store(true, std::sync::atomic::Ordering::Relaxed);
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

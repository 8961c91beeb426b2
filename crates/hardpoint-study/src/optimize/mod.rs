//! Optimisation: which design minimises weighted goals within bounds and limits?
//!
//! Input: a [`Request`] with bounded variables (m, rad or plain), goals and limits on metrics in SI. Output: an
//! [`Optimization`] with the best design of every start, its active constraints and multipliers.
//!
//! ```text
//! minimise sum of weight value, or (weight (value - target))^2,    subject to least <= limit <= most
//! ```
//!
//! Goals and limits are metrics of the motions, with exact derivatives. If all goals are squares (a curve fitted, a
//! target met) and only bounds limit the design, bounded least squares are used, otherwise sequential programming. For
//! goals on a maximum (`max` metrics) the search minimises `t` with every part of the curve below `t`, so minimax
//! problems need no reformulation. If the motion of a design does not assemble, locks, or reaches a singular position,
//! the step is rejected: the search steps back and continues.
//!
//! The searches may also start from the other assemblies of the mechanism and with its drivers in the opposite sense:
//! each [`Variant`] is a model of its own with the same variables, goals and limits.

mod corner;
mod gauss_newton;
mod optima;
mod optimality;
mod problem;
mod request;
mod saddle;
mod solver;
mod variants;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use sobol_burley::sample;

use hardpoint::model::{Model, OptimizationSettings, VariableId};

use super::evaluation::{Motions, StudyCost};
use super::progress::{Control, Progress, Step};
use gauss_newton::GaussNewton;
pub use optimality::{ActiveConstraint, Optimality};
pub(crate) use optimality::{BINDS, MET};
use problem::Limited;
pub(crate) use problem::{Extremum, Point, Problem, Refusal};
pub use request::{Overrides, Request, Selection};
pub(crate) use solver::Memory;
use solver::{ScaledSequential, Solver, least_squares};
pub use variants::Variant;

/// A limit is satisfied if it is exceeded by less than this fraction of its scale: the rest is round-off of the search.
pub const LIMIT_KEPT: f64 = 1e-8;
use LIMIT_KEPT as KEPT;
/// Optimality residual below which a design is an optimum.
const OPTIMAL: f64 = 1e-6;
/// A search that ends above this residual, relative to the scale of the goals or to the gradient at the start,
/// is restarted from its best design ...
const SHARP: f64 = 5e-9;
/// ... at most this number of times.
const AGAIN: usize = 3;
/// Relative change of the objective below which a search is at rest.
const NO_LESS: f64 = 1e-14;
/// A search is also at rest if its step is below this fraction of the bounds.
const RESTING: f64 = 1e-13;
/// Objectives with a relative difference below this are equal to round-off; the design with the smaller optimality
/// residual is then the better one.
const THE_SAME: f64 = 1e-12;
/// Change of a limit over the bounds of a variable, as a fraction of its scale, that is still round-off.
const LIMIT_ROUND_OFF: f64 = 1e-10;
/// Relative difference of objectives below which the search with the smallest optimality residual is the best one.
const AS_GOOD: f64 = 1e-9;
/// An optimum of another assembly or sense must be better than those of the model's own by this fraction.
const NO_WORSE: f64 = 1e-6;
/// A run that reduces the optimality residual to this fraction is progress, whatever its effect on the objective.
const NEARER: f64 = 0.5;
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
/// Squares under limits that do not halve within this number of iterations switch to Gauss-Newton steps ...
const PATIENCE: usize = 20;
/// ... which are preferred if they reduce the objective to this fraction.
const HALVED: f64 = 0.5;
/// Number of further iterations from goals that seem to vanish to round-off.
const CONFIRMING: usize = 30;
/// The first solver hands over if a step gains less than this fraction of the objective.
const HARDLY_LESS: f64 = 1e-6;
/// Maximum number of trials for a start that cannot be evaluated; each is half as far from the nominal design as the
/// one before.
const HALVINGS: i32 = 8;
/// Maximum dimension of the low-discrepancy points; further variables start at their nominal values.
const MOST_DIMENSIONS: usize = 256;

/// Result of an optimisation.
#[derive(Clone, Debug)]
pub struct Optimization {
    /// Nominal design; `None` if it cannot be evaluated.
    pub nominal: Option<DesignAssessment>,
    /// Reason why the nominal design cannot be evaluated.
    pub nominal_failure: Option<FailedDesign>,
    /// Assemblies and senses that were searched; the first is that of the model.
    pub variants: Vec<Variant>,
    /// Searches in the order of the variants, and for each in the order of their starts; number 0 starts from the
    /// nominal design.
    pub searches: Vec<SearchResult>,
    /// Index of the best search: the lowest objective among those that satisfy all limits, otherwise the smallest
    /// violation. `None` if none could start.
    pub best: Option<usize>,
    /// Total cost.
    pub cost: StudyCost,
}

/// Evaluated design with its goals and limits.
#[derive(Clone, Debug, Default)]
pub struct DesignAssessment {
    /// Values of all variables of the model, m, rad or plain.
    pub design: Vec<f64>,
    /// Objective: weighted sum of all goals, dimensionless.
    pub objective: f64,
    /// Largest violation of a limit, as a fraction of its scale; 0 if all are satisfied.
    pub violation: f64,
    /// Minimum margin to a singular position over all motions, 0 to 1, if known.
    pub margin: Option<f64>,
    /// Value of each goal in each of its motions: index of the goal, motion, SI value.
    pub goals: Vec<(usize, usize, f64)>,
    /// Value of each limit: index of the limit, motion if it is on a metric, SI value.
    pub limits: Vec<(usize, Option<usize>, f64)>,
}

/// Result of one search.
#[derive(Clone, Debug)]
pub struct SearchResult {
    /// Index of its assembly and sense in [`Optimization::variants`].
    pub variant: usize,
    /// Start values of all variables.
    pub start: Vec<f64>,
    /// Status at the end.
    pub status: Status,
    /// Best design; `None` if the search could not start.
    pub found: Option<DesignAssessment>,
    /// Optimality of the best design, with its active constraints.
    pub optimality: Optimality,
    /// Iterations, in order, the start first.
    pub iterations: Vec<Iteration>,
    /// Contribution of each searched variable to the change of the objective: the sum over all steps of mean gradient
    /// times step.
    pub work: Vec<f64>,
    /// True for each searched variable that changes no goal and no limit at any design of the search.
    pub idle: Vec<bool>,
    /// Designs that could not be evaluated.
    pub refused: Vec<FailedDesign>,
    /// Cost of the search.
    pub cost: StudyCost,
}

/// Status of a search at its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Converged to an optimum.
    Optimal,
    /// No goal depends on any of the searched variables.
    NoEffect,
    /// No step makes progress, although the conditions of an optimum are not satisfied.
    Stuck,
    /// Ended at the design with the smallest violation that was found: not all limits can be satisfied there.
    LimitsNotKept,
    /// The iteration limit was reached.
    IterationLimit,
    /// The caller ended the search.
    Interrupted,
    /// The search could not start: see [`SearchResult::refused`].
    NoStart,
}

/// One iteration of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Iteration {
    /// Number of the iteration; 0 is the start.
    pub number: usize,
    /// Objective at the current design.
    pub objective: f64,
    /// Violation at the current design, as [`DesignAssessment::violation`].
    pub violation: f64,
    /// Length of the step: the largest change of a variable as a fraction of its bounds.
    pub step: f64,
    /// Variable with that change, and the change in its unit.
    pub most: Option<(VariableId, f64)>,
    /// Number of designs evaluated so far in this search.
    pub designs: usize,
    /// Best design so far: values of all variables of the model, m, rad or plain.
    pub best: Vec<f64>,
}

/// Design that could not be evaluated.
#[derive(Clone, Debug)]
pub struct FailedDesign {
    /// Values of all variables, m, rad or plain.
    pub design: Vec<f64>,
    /// Index of the motion, if one failed.
    pub motion: Option<usize>,
    /// Reason.
    pub why: String,
}

/// Minimises the goals over the design variables. Reports every iteration and the end of every search; of several
/// searches their ends are counted, of a single one its iterations.
///
/// `motions` are those of the model ([`Model::motions`]), in order.
pub fn optimize(
    model: &Model,
    motions: &Motions<'_>,
    request: &Request,
    control: Control<'_>,
) -> Optimization {
    let Request { settings, first } = request;
    let problem = Problem::new(model, motions, settings);
    let Control { progress, more, threads } = control;
    let mut cost = StudyCost::default();
    let (nominal, nominal_failure) = match problem.at(vec![0.0; model.variables.len()], &mut cost, more) {
        Ok(point) => (Some(assess(&problem, &point, &limit_scales(&problem, &point))), None),
        Err(refusal) => (None, Some(failed_design(vec![0.0; model.variables.len()], refusal))),
    };
    let (mut variants, mut others) = (Vec::new(), Vec::new());
    for variant in Variant::all(model, motions, settings, &|| more()) {
        // The motions of the model itself are there already.
        if !variant.is_own() {
            let Some(motions) = variant.motions(model, motions) else { continue };
            others.push(motions);
        }
        variants.push(variant);
    }
    let problems: Vec<Problem<'_>> = std::iter::once(motions)
        .chain(&others)
        .map(|motions| Problem::new(model, motions, settings))
        .collect();
    let starts: Vec<(usize, Vec<f64>)> = (0..problems.len())
        .flat_map(|variant| (0..settings.starts).map(move |k| (variant, first + k)))
        .map(|(variant, k)| (variant, start(&problem, k)))
        .collect();
    let (next, ended) = (AtomicUsize::new(0), std::sync::atomic::AtomicBool::new(false));
    // Number of searches that have ended, or of iterations of the only one.
    let progress = Mutex::new((0, progress));
    let is_single = starts.len() == 1;
    let total = if is_single { settings.iterations } else { starts.len() };
    let searches = Mutex::new(starts.iter().map(|_| None).collect::<Vec<Option<SearchResult>>>());
    let more = || !ended.load(Ordering::Relaxed) && more();
    let work = || {
        while let Some(k) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|k| *k < starts.len()) {
            let report = |step: Step<'_>, is_counted: bool, counted: &dyn Fn(usize) -> usize| {
                let (done, progress) = &mut *progress.lock().expect("no report before has panicked");
                *done = if is_counted { counted(*done) } else { *done };
                if progress(Progress { step, done: *done, total, is_counted }).is_break() {
                    ended.store(true, Ordering::Relaxed);
                }
            };
            let mut iterated = |i: &Iteration| report(Step::Iteration(i), is_single, &|_| i.number);
            let (variant, start) = &starts[k];
            let search = search(&problems[*variant], *variant, start, &mut iterated, &more);
            report(Step::Search(k, &search), !is_single, &|done| done + 1);
            searches.lock().expect("no search before has panicked")[k] = Some(search);
        }
    };
    match threads.get().min(starts.len()) {
        1 => work(),
        n => std::thread::scope(|scope| (0..n).for_each(|_| drop(scope.spawn(work)))),
    }
    let searches = searches.into_inner().expect("no search has panicked");
    let searches: Vec<SearchResult> =
        searches.into_iter().map(|s| s.expect("every start was searched from")).collect();
    searches.iter().for_each(|s| cost += s.cost);
    Optimization { nominal, nominal_failure, variants, best: best(&searches), searches, cost }
}

/// Evaluates the goals and limits of one design, given by the values of all variables of the model.
///
/// # Errors
/// A [`FailedDesign`] if a motion stops or comes closer to a singular position than the limit on its margin, or if a
/// goal has no value.
pub fn judge(
    model: &Model,
    motions: &Motions<'_>,
    settings: &OptimizationSettings,
    design: &[f64],
) -> Result<DesignAssessment, FailedDesign> {
    let problem = Problem::new(model, motions, settings);
    let design = design.iter().copied().chain(std::iter::repeat(0.0)).take(model.variables.len()).collect();
    let point = problem.at(design, &mut StudyCost::default(), &|| true);
    let point = point.map_err(|refusal| failed_design(Vec::new(), refusal))?;
    for ((limit, of), value) in problem.limits.iter().zip(&point.limit_values) {
        if let (Limited::Margin(motion), Some(least)) = (of, settings.limits[*limit].least)
            && *value < least - KEPT
        {
            let why = format!("its margin to a singular position falls to {value:.3}, less than {least}");
            return Err(FailedDesign { design: Vec::new(), motion: Some(*motion), why });
        }
    }
    Ok(assess(&problem, &point, &limit_scales(&problem, &point)))
}

/// Start k, as fractions of the bounds: the nominal design, then low-discrepancy points.
fn start(problem: &Problem<'_>, k: usize) -> Vec<f64> {
    let nominal = problem.parts(&vec![0.0; problem.model.variables.len()]);
    let dimension = |(d, nominal): (usize, f64)| match k {
        0 => nominal,
        _ if d >= MOST_DIMENSIONS => nominal,
        _ => f64::from(sample(k as u32, d as u32, 0)),
    };
    nominal.into_iter().enumerate().map(dimension).collect()
}

/// Index of the best search.
fn best(searches: &[SearchResult]) -> Option<usize> {
    let found = |k: &usize| searches[*k].found.as_ref();
    let rank = |k: &usize| {
        let assessment = found(k).expect("only those that found something are ranked");
        let kept = assessment.violation <= KEPT;
        let objective = match searches[*k].status {
            // Objectives without effects differ by round-off.
            Status::NoEffect => 0.0,
            Status::Optimal
            | Status::Stuck
            | Status::LimitsNotKept
            | Status::IterationLimit
            | Status::Interrupted
            | Status::NoStart => assessment.objective,
        };
        (!kept, if kept { objective } else { assessment.violation })
    };
    let order = |a: &usize, b: &usize| {
        let ([a, b], [x, y]) = ([rank(a).0, rank(b).0], [rank(a).1, rank(b).1]);
        a.cmp(&b).then(x.total_cmp(&y))
    };
    let least = (0..searches.len()).filter(|k| found(k).is_some()).min_by(order)?;
    let (exceeds, value) = rank(&least);
    let as_good = |k: &usize| {
        let same = |(e, v): (bool, f64)| e == exceeds && v - value <= AS_GOOD * value.abs();
        found(k).is_some() && same(rank(k))
    };
    let residual = |k: &usize| searches[*k].optimality.residual;
    let best = (0..searches.len()).filter(as_good).min_by(|a, b| residual(a).total_cmp(&residual(b)))?;
    let own = (0..searches.len()).filter(|k| found(k).is_some_and(|f| f.violation <= KEPT));
    let own = own.filter(|k| is_as_good_in_own_assembly(searches, *k, best));
    Some(own.min_by(|a, b| residual(a).total_cmp(&residual(b))).unwrap_or(best))
}

/// True if a search in the model's own assembly and sense ended no worse than one elsewhere: a coupler that is turned
/// over, or a mirror image, often moves like another design of the model, and is then not worth another assembly.
fn is_as_good_in_own_assembly(searches: &[SearchResult], own: usize, other: usize) -> bool {
    let [own, other] = [own, other].map(|k| &searches[k]);
    let objective = |search: &SearchResult| search.found.as_ref().map_or(f64::INFINITY, |f| f.objective);
    let (a, b) = (objective(own), objective(other));
    let is_equal = own.optimality.met && other.optimality.met || a - b <= NO_WORSE * b.abs();
    own.variant == 0 && other.variant != 0 && own.status == other.status && is_equal
}

pub(crate) fn failed_design(design: Vec<f64>, Refusal { motion, why, .. }: Refusal) -> FailedDesign {
    FailedDesign { design, motion, why }
}

pub(crate) fn assess(problem: &Problem<'_>, point: &Point, scales: &[f64]) -> DesignAssessment {
    let goals = problem.goals.iter().zip(&point.goal_values).map(|(t, v)| (t.of, t.motion, *v));
    let limits = problem.limits.iter().zip(&point.limit_values);
    DesignAssessment {
        design: point.design.clone(),
        objective: point.objective(),
        violation: point.violation(|k| scales[k]),
        margin: point.margin,
        goals: goals.collect(),
        limits: limits.map(|((limit, of), v)| (*limit, of.motion(), *v)).collect(),
    }
}

/// Scale of every limit: the initial change by the most influential variable over its whole bounds.
pub(crate) fn limit_scales(problem: &Problem<'_>, point: &Point) -> Vec<f64> {
    let mut scales = vec![0.0_f64; problem.limits.len()];
    for row in &point.limits {
        for (d, [low, high]) in row.d.iter().zip(&problem.bounds) {
            scales[row.of] = scales[row.of].max((d * (high - low)).abs());
        }
    }
    scales.into_iter().map(|s| if s > 0.0 { s } else { 1.0 }).collect()
}

/// Runs one search from one start.
fn search(
    problem: &Problem<'_>,
    variant: usize,
    start: &[f64],
    tell: &mut dyn FnMut(&Iteration),
    more: &(dyn Fn() -> bool + Sync),
) -> SearchResult {
    let memory = Memory::new(problem, more);
    let n = start.len();
    // A start that cannot be evaluated is moved half of the way to the nominal design each time.
    let nominal = problem.parts(&vec![0.0; problem.model.variables.len()]);
    let nearer = |halvings: i32| -> Vec<f64> {
        let part = 0.5_f64.powi(halvings);
        nominal.iter().zip(start).map(|(nominal, start)| nominal + part * (start - nominal)).collect()
    };
    let tries = if start == nominal { 1 } else { HALVINGS };
    let starts = (0..tries).map(nearer).take_while(|_| !memory.interrupted());
    let judged_start =
        |start: Vec<f64>| memory.at(&start, |found| found.as_ref().ok().cloned()).map(|p| (start, p));
    let point = starts.into_iter().find_map(judged_start);
    let mut search = SearchResult {
        variant,
        start: problem.design(point.as_ref().map_or(start, |(start, _)| start)),
        status: if memory.interrupted() { Status::Interrupted } else { Status::NoStart },
        found: None,
        optimality: Optimality { residual: f64::INFINITY, ..Optimality::default() },
        iterations: Vec::new(),
        work: vec![0.0; n],
        idle: vec![true; n],
        refused: Vec::new(),
        cost: StudyCost::default(),
    };
    if let Some((start, point)) = point {
        let mut run = Descent::new(problem, &memory, &start, point);
        run.go(&mut search, tell);
        run.reset_idle();
        search.idle = run.idle();
        search.found = Some(assess(problem, &run.best, &run.scales));
        search.optimality = run.optimality(&run.best);
        if search.optimality.vanishes {
            search.optimality.residual = 0.0;
        }
        search.status = run.status(&search);
        if search.status == Status::Stuck
            && let Some(optimality) = run.at_corner()
        {
            search.optimality = optimality;
            search.status = Status::Optimal;
        }
    }
    search.refused =
        memory.refused.take().into_iter().map(|(design, why)| failed_design(design, why)).collect();
    search.cost = memory.cost.take();
    search
}

/// True if no goal depends on any variable: all derivatives are round-off, and not at the start only, which may be a
/// symmetric design.
fn has_no_effect(problem: &Problem<'_>, memory: &Memory<'_>, point: &Point) -> bool {
    if !point.is_constant(problem) {
        return false;
    }
    let here = problem.parts(&point.design);
    let Some(other) = [1, 2].map(|k| start(problem, k)).into_iter().find(|other| *other != here) else {
        return true;
    };
    let is_constant = |halvings: i32| {
        let parts = other.iter().zip(&here);
        let parts: Vec<f64> = parts.map(|(a, b)| b + 0.5_f64.powi(halvings) * (a - b)).collect();
        memory.at(&parts, |found| found.as_ref().ok().map(|point| point.is_constant(problem)))
    };
    (0..HALVINGS).find_map(is_constant).unwrap_or(false)
}

/// State of a search.
struct Descent<'p> {
    problem: &'p Problem<'p>,
    memory: &'p Memory<'p>,
    /// Scales of the limits, from the start.
    scales: Vec<f64>,
    steepest: f64,
    /// Start and current point, as fractions of the bounds.
    start: Vec<f64>,
    at: Vec<f64>,
    here: Point,
    best: Point,
    ran_out: bool,
    /// True if Gauss-Newton steps were idle.
    is_curved: bool,
    /// Number of iterations at which a search ends that only confirms its result.
    confirms_until: Option<usize>,
    /// True if no goal depends on any variable.
    has_no_effect: bool,
    /// Largest effect of every variable on goals and limits so far, as a multiple of round-off.
    effects: Vec<f64>,
}

impl<'p> Descent<'p> {
    fn new(problem: &'p Problem<'p>, memory: &'p Memory<'p>, start: &[f64], point: Point) -> Self {
        let gradient = point.gradient(start.len());
        let by_parts = gradient.iter().zip(&problem.bounds).map(|(g, [low, high])| (g * (high - low)).abs());
        Self {
            scales: limit_scales(problem, &point),
            steepest: by_parts.fold(0.0, f64::max),
            start: start.to_vec(),
            at: start.to_vec(),
            ran_out: false,
            is_curved: false,
            confirms_until: None,
            has_no_effect: has_no_effect(problem, memory, &point),
            effects: vec![0.0; start.len()],
            here: point.clone(),
            best: point,
            problem,
            memory,
        }
    }

    fn optimality(&self, point: &Point) -> Optimality {
        let optimality = Optimality::of(self.problem, point, &self.scales, self.steepest);
        if !self.has_no_effect {
            return optimality;
        }
        // The gradient and its balance are round-off.
        let met = optimality.met || point.is_round_off();
        Optimality { residual: 0.0, left_of_start: 0.0, met, binding: Vec::new(), ..optimality }
    }

    /// Variables without effect on goals and limits so far.
    fn idle(&self) -> Vec<bool> {
        self.effects.iter().map(|effect| *effect <= 1.0).collect()
    }

    /// Returns variables without effect to their nominal values, from which another start has moved them.
    fn reset_idle(&mut self) {
        let nominal = self.problem.parts(&vec![0.0; self.problem.model.variables.len()]);
        let mut parts = self.problem.parts(&self.best.design);
        let mut is_moved = false;
        for ((part, nominal), _) in parts.iter_mut().zip(nominal).zip(self.idle()).filter(|(_, idle)| *idle) {
            is_moved |= (*part - nominal).abs() > RESTING;
            *part = nominal;
        }
        if !is_moved {
            return;
        }
        let Some(point) = self.memory.at(&parts, |found| found.as_ref().ok().cloned()) else { return };
        let [reset, best] = [&point, &self.best].map(Point::objective);
        let is_as_good = reset - best <= AS_GOOD * best.abs() || self.optimality(&point).met;
        if is_as_good && self.violation(&point) <= self.violation(&self.best).max(KEPT) {
            self.best = point;
        }
    }

    /// True if a search can end at a point.
    fn is_sharp(&self, point: &Point) -> bool {
        let Optimality { residual, left_of_start, vanishes, .. } = self.optimality(point);
        let is_flat = residual < OPTIMAL && (residual < SHARP || left_of_start < SHARP);
        self.violation(point) <= KEPT && (is_flat || vanishes && self.confirms_until.is_none())
    }

    /// Effect of every variable on the limits, as [`Point::effects`] on the goals.
    fn limit_effects(&self, point: &Point) -> Vec<f64> {
        let rows = point.limits.iter().map(|row| (row.of, &row.d));
        let ends = point.spreads.iter().flat_map(|s| s.ends.iter().flat_map(|e| &e.d).map(|d| (s.of, d)));
        let mut effects = vec![0.0_f64; self.problem.bounds.len()];
        for (of, d) in rows.chain(ends) {
            for (effect, (d, [low, high])) in effects.iter_mut().zip(d.iter().zip(&self.problem.bounds)) {
                *effect = effect.max((d * (high - low)).abs() / (LIMIT_ROUND_OFF * self.scales[of]));
            }
        }
        effects
    }

    fn violation(&self, point: &Point) -> f64 {
        point.violation(|k| self.scales[k])
    }

    /// Objective of a design that keeps its limits, without what it gains by exceeding them within [`KEPT`]: a design
    /// far from the optimum by the root of that may otherwise have the lower objective.
    fn objective_within_limits(&self, point: &Point) -> f64 {
        let violation = self.violation(point);
        let gain = if violation > 0.0 { self.optimality(point).price * violation } else { 0.0 };
        point.objective() + gain
    }

    /// True if one design is better than another: it satisfies the limits, or has the lower objective.
    fn is_better(&self, one: &Point, other: &Point) -> bool {
        let [a, b] = [one, other].map(|p| self.violation(p));
        match [a <= KEPT, b <= KEPT] {
            [true, true] => {
                let [a, b] = [one, other].map(|p| self.objective_within_limits(p));
                if (a - b).abs() <= THE_SAME * b.abs() {
                    self.optimality(one).residual < self.optimality(other).residual
                } else {
                    a < b
                }
            }
            [false, false] => a < b,
            [kept, _] => kept,
        }
    }

    /// Solver for this kind of goals and limits, started at the current point. Least squares approach bounds slowly
    /// from within; sequential programming finishes such searches.
    fn solver(&self, squares: bool) -> Option<Box<dyn Solver + 'p>> {
        if squares {
            Some(Box::new(least_squares(self.memory, &self.at, &self.here)))
        } else {
            let found = ScaledSequential::new(self.memory, &self.at, &self.here, &self.scales);
            found.map(|s| Box::new(s) as Box<dyn Solver + 'p>)
        }
    }

    fn go(&mut self, search: &mut SearchResult, tell: &mut dyn FnMut(&Iteration)) {
        self.note(search, None, tell);
        if self.has_no_effect && self.violation(&self.here) <= KEPT {
            return;
        }
        loop {
            self.go_to_rest(search, tell);
            if !self.leave_saddle(search, tell) {
                return;
            }
        }
    }

    /// Runs the solvers until they find nothing better.
    fn go_to_rest(&mut self, search: &mut SearchResult, tell: &mut dyn FnMut(&Iteration)) {
        let squares = self.here.is_squares();
        let mut idle = 0;
        for run in 0..=AGAIN {
            let state = |run: &Self| {
                (run.best.objective(), run.violation(&run.best), run.optimality(&run.best).residual)
            };
            let before = state(self);
            self.descend(run, search, tell);
            if !self.ran_out {
                self.polish(search, tell);
            }
            let after = state(self);
            let less = before.0 - after.0 > THE_SAME * before.0.abs() || after.1 < before.1;
            let gained = run == 0 || less || after.2 < NEARER * before.2;
            let sharp = self.is_sharp(&self.best);
            if sharp && self.optimality(&self.best).vanishes {
                self.confirm(search, tell);
                return;
            }
            idle = if gained { 0 } else { idle + 1 };
            // If there are two solvers, the other one continues when one makes no progress.
            let at_rest = idle > usize::from(squares);
            if sharp || at_rest || self.ran_out || self.memory.interrupted() {
                return;
            }
            self.return_to_best();
        }
    }

    /// Continues from goals that seem to vanish to round-off: their gradient at the start says only roughly what that
    /// is.
    fn confirm(&mut self, search: &mut SearchResult, tell: &mut dyn FnMut(&Iteration)) {
        self.return_to_best();
        self.confirms_until = Some(search.iterations.len() + CONFIRMING);
        self.descend(1, search, tell);
    }

    /// Returns to the best design.
    fn return_to_best(&mut self) {
        self.here = self.best.clone();
        self.at = self.problem.parts(&self.here.design);
    }

    /// Damped Gauss-Newton steps under bounds and limits from the best design, as long as they make progress.
    ///
    /// Small misfits lie in narrow curved valleys and on curved limits, which a straight step leaves. Up to
    /// [`CORRECTIONS`] further steps with much greater damping return to the valley before the designs are compared.
    fn polish(&mut self, search: &mut SearchResult, tell: &mut dyn FnMut(&Iteration)) {
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
        while idle < IDLE && self.best.has_only_squares() && self.violation(&self.best) <= KEPT {
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
                if self.violation(&self.here) <= KEPT && now <= (1.0 - GOOD * promised) * before {
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

    /// Runs a solver to its end; in the first run, least squares end as soon as their progress is slow.
    fn descend(&mut self, run: usize, search: &mut SearchResult, tell: &mut dyn FnMut(&Iteration)) {
        let squares = run.is_multiple_of(2) && self.here.is_squares();
        let Some(mut solver) = self.solver(squares) else { return };
        let hands_over = self.here.has_only_squares();
        let (mut patience, mut since) = (PATIENCE, (search.iterations.len(), self.best.objective()));
        loop {
            if hands_over && search.iterations.len() >= since.0 + patience {
                if self.best.objective() > HALVED * since.1 {
                    let (slow, state) = (self.best.objective(), (self.at.clone(), self.here.clone()));
                    self.polish(search, tell);
                    if self.best.objective() <= HALVED * slow {
                        self.return_to_best();
                        match self.solver(squares) {
                            Some(next) => solver = next,
                            None => return,
                        }
                    } else {
                        (self.at, self.here) = state;
                        patience *= 2;
                    }
                }
                since = (search.iterations.len(), self.best.objective());
            }
            if search.iterations.len() > self.problem.settings.iterations {
                self.ran_out = true;
                return;
            }
            if self.memory.interrupted()
                || self.confirms_until.is_some_and(|end| search.iterations.len() >= end)
            {
                return;
            }
            let Some(at) = solver.step() else { return };
            if at == self.at {
                continue;
            }
            let Some(point) = self.memory.at(&at, |found| found.as_ref().ok().cloned()) else { return };
            let before = (std::mem::replace(&mut self.at, at), std::mem::replace(&mut self.here, point));
            if self.is_better(&self.here, &self.best) {
                self.best = self.here.clone();
            }
            self.note(search, Some(before), tell);
            let Some([former, last]) = search.iterations.last_chunk::<2>() else {
                continue;
            };
            let change = (former.objective - last.objective).abs();
            let still = change
                <= if squares && run == 0 { HARDLY_LESS } else { NO_LESS } * last.objective.abs()
                && last.violation <= KEPT;
            if last.step <= RESTING || still || self.is_sharp(&self.here) {
                return;
            }
        }
    }

    /// Records an iteration, given the previous point.
    fn note(
        &mut self,
        search: &mut SearchResult,
        before: Option<(Vec<f64>, Point)>,
        tell: &mut dyn FnMut(&Iteration),
    ) {
        let n = self.at.len();
        let effects = self.here.effects(self.problem).into_iter().zip(self.limit_effects(&self.here));
        let known = self.effects.iter_mut().zip(effects);
        known.for_each(|(known, (goals, limits))| *known = known.max(goals).max(limits));
        let mut step = 0.0;
        let mut most = None;
        if let Some((at, point)) = &before {
            let [g0, g1] = [point, &self.here].map(|p| p.gradient(n));
            for v in 0..n {
                let part = (self.at[v] - at[v]).abs();
                let variable = self.problem.settings.variables[v];
                let by = self.here.design[variable.0] - point.design[variable.0];
                // df = grad f . db,  by the trapezoidal rule
                search.work[v] += 0.5 * (g0[v] + g1[v]) * by;
                if part > step {
                    (step, most) = (part, Some((variable, by)));
                }
            }
        }
        let iteration = Iteration {
            number: search.iterations.len(),
            objective: self.here.objective(),
            violation: self.violation(&self.here),
            designs: self.memory.cost.borrow().designs,
            step,
            most,
            best: self.best.design.clone(),
        };
        tell(&iteration);
        search.iterations.push(iteration);
    }

    fn status(&self, search: &SearchResult) -> Status {
        let kept = self.violation(&self.best) <= KEPT;
        match () {
            () if self.memory.interrupted() => Status::Interrupted,
            () if kept && self.has_no_effect && !search.optimality.met => Status::NoEffect,
            () if kept && search.optimality.residual <= OPTIMAL => Status::Optimal,
            () if self.ran_out => Status::IterationLimit,
            () if kept => Status::Stuck,
            () => Status::LimitsNotKept,
        }
    }
}

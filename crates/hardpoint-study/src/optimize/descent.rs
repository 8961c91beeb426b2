//! State of a search, which several solvers lead to an optimum one after the other.

mod corner;
mod polish;
mod saddle;

use super::assessment::{AS_GOOD, LIMIT_KEPT, THE_SAME, assess, limit_scales};
use super::local::LocalSteps;
use super::optimality::Optimality;
use super::problem::{Point, Problem};
use super::result::{Iteration, SearchResult, Status};
use super::solver::{Memory, ScaledSequential, Solver, least_squares};
use super::starts::has_no_effect;

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
/// Change of a limit over the bounds of a variable, as a fraction of its scale, that is still round-off.
const LIMIT_ROUND_OFF: f64 = 1e-10;
/// A run that reduces the optimality residual to this fraction is progress, whatever its effect on the objective.
const NEARER: f64 = 0.5;
/// Squares under limits that do not halve within this number of iterations switch to Gauss-Newton steps ...
const PATIENCE: usize = 20;
/// ... which are preferred if they reduce the objective to this fraction.
const HALVED: f64 = 0.5;
/// Number of further iterations from goals that seem to vanish to round-off.
const CONFIRMING: usize = 30;
/// The first solver hands over if a step gains less than this fraction of the objective.
const HARDLY_LESS: f64 = 1e-6;

/// State of a search.
pub(super) struct Descent<'p> {
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
    /// True if local models do not describe the problem.
    is_unfit: bool,
    /// Number of iterations at which a search ends that only confirms its result.
    confirms_until: Option<usize>,
    /// True if no goal depends on any variable.
    has_no_effect: bool,
    /// Largest effect of every variable on goals and limits so far, as a multiple of round-off.
    effects: Vec<f64>,
}

impl<'p> Descent<'p> {
    pub(super) fn new(problem: &'p Problem<'p>, memory: &'p Memory<'p>, start: &[f64], point: Point) -> Self {
        let gradient = point.gradient(start.len());
        let by_parts = gradient.iter().zip(&problem.bounds).map(|(g, [low, high])| (g * (high - low)).abs());
        Self {
            scales: limit_scales(problem, &point),
            steepest: by_parts.fold(0.0, f64::max),
            start: start.to_vec(),
            at: start.to_vec(),
            ran_out: false,
            is_curved: false,
            is_unfit: false,
            confirms_until: None,
            has_no_effect: has_no_effect(problem, memory, &point),
            effects: vec![0.0; start.len()],
            here: point.clone(),
            best: point,
            problem,
            memory,
        }
    }

    /// Searches to the end, and records the result.
    pub(super) fn run(&mut self, search: &mut SearchResult, tell: &mut dyn FnMut(&Iteration)) {
        self.go(search, tell);
        self.reset_idle();
        search.idle = self.idle();
        search.found = Some(assess(self.problem, &self.best, &self.scales));
        search.optimality = self.optimality(&self.best);
        if search.optimality.vanishes {
            search.optimality.residual = 0.0;
        }
        search.status = self.status(search);
        if search.status == Status::Stuck
            && let Some(optimality) = self.at_corner()
        {
            search.optimality = optimality;
            search.status = Status::Optimal;
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
        if is_as_good && self.violation(&point) <= self.violation(&self.best).max(LIMIT_KEPT) {
            self.best = point;
        }
    }

    /// True if a search can end at a point.
    fn is_sharp(&self, point: &Point) -> bool {
        let Optimality { residual, left_of_start, vanishes, .. } = self.optimality(point);
        let is_flat = residual < OPTIMAL && (residual < SHARP || left_of_start < SHARP);
        self.violation(point) <= LIMIT_KEPT && (is_flat || vanishes && self.confirms_until.is_none())
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

    /// Objective of a design that keeps its limits, without what it gains by exceeding them within [`LIMIT_KEPT`]: a
    /// design far from the optimum by the root of that may otherwise have the lower objective.
    fn objective_within_limits(&self, point: &Point) -> f64 {
        let violation = self.violation(point);
        let gain = if violation > 0.0 { self.optimality(point).price * violation } else { 0.0 };
        point.objective() + gain
    }

    /// True if one design is better than another: it satisfies the limits, or has the lower objective.
    fn is_better(&self, one: &Point, other: &Point) -> bool {
        let [a, b] = [one, other].map(|p| self.violation(p));
        match [a <= LIMIT_KEPT, b <= LIMIT_KEPT] {
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
    /// from within; local models finish such searches, or sequential programming where these do not describe the
    /// problem.
    fn solver(&self, squares: bool) -> Option<Box<dyn Solver + 'p>> {
        let (memory, at, here, scales) = (self.memory, &self.at, &self.here, &self.scales);
        if squares {
            return Some(Box::new(least_squares(memory, at, here)));
        }
        let local = if self.is_unfit { None } else { LocalSteps::new(memory, at, here, scales) };
        match local {
            Some(local) => Some(Box::new(local)),
            None => {
                ScaledSequential::new(memory, at, here, scales).map(|s| Box::new(s) as Box<dyn Solver + 'p>)
            }
        }
    }

    fn go(&mut self, search: &mut SearchResult, tell: &mut dyn FnMut(&Iteration)) {
        self.note(search, None, tell);
        if self.has_no_effect && self.violation(&self.here) <= LIMIT_KEPT {
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

    /// Runs a solver to its end; in the first run, least squares end as soon as their progress is slow.
    fn descend(&mut self, run: usize, search: &mut SearchResult, tell: &mut dyn FnMut(&Iteration)) {
        let squares = run.is_multiple_of(2) && self.here.is_squares();
        let Some(mut solver) = self.solver(squares) else { return };
        let hands_over = self.here.has_only_squares();
        let begin = (self.at.clone(), self.here.clone(), self.best.clone(), search.work.clone());
        let listed = search.iterations.len();
        let (mut patience, mut since) = (PATIENCE, (search.iterations.len(), self.best.objective()));
        loop {
            if hands_over && search.iterations.len() >= since.0 + patience {
                if self.best.objective() > HALVED * since.1 {
                    let (slow, state) = (self.best.objective(), (self.at.clone(), self.here.clone()));
                    self.polish(search, tell);
                    if self.best.objective() <= HALVED * slow {
                        self.return_to_best();
                        self.is_unfit = true;
                        let Some(next) = self.solver(squares) else { return };
                        solver = next;
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
            let Some(at) = solver.step() else {
                if !solver.is_unfit() || self.memory.interrupted() {
                    return;
                }
                self.is_unfit = true;
                (self.at, self.here, self.best, search.work) = begin.clone();
                search.iterations.truncate(listed);
                let Some(next) = self.solver(squares) else { return };
                solver = next;
                since = (search.iterations.len(), self.best.objective());
                continue;
            };
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
                && last.violation <= LIMIT_KEPT;
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
        let kept = self.violation(&self.best) <= LIMIT_KEPT;
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

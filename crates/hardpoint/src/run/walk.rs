//! Solution of one design at all output times.

use std::ops::{ControlFlow, Range};
use std::sync::{Arc, OnceLock};

use hardpoint_tape::LANES;

use crate::design::{DesignVelocity, Geometry};
use crate::equilibrium::EquilibriumSolver;
use crate::law::Law;
use crate::load::LoadSolver;
use crate::measure::PathAngles;
use crate::model::BodyId;
use crate::motion::inner_step::advance_between;
use crate::motion::parts::PlanGeometry;
use crate::motion::step_program::Purpose;
use crate::motion::stepper::Stepper;
use crate::motion::tape::Tape;
use crate::motion::time_batch::TimeBatch;
use crate::motion::turns::TurnCounter;
use crate::motion::{BodyState, Motion, Stop, StopKind, advance, assembly};
use crate::sensitivity::{Admissibility, BodySensitivity, JointDefect, SensitivitySolver};

use super::analysis::Analysis;
use super::needed::NeededResults;
use super::request::{Progress, Scope};
use super::sink::{NullSink, Sink, hand_over};

/// Part of the way to an output time by which other openings must lead further than those before them: less is the
/// distance from an end of the motion at which each stops.
const FURTHER: f64 = 1e-6;

/// Part of the pivot ratio with other openings below which those at hand are worse.
const BETTER: f64 = 0.1;

/// A design that is prepared for solution.
pub(crate) struct PreparedDesign {
    pub values: Vec<f64>,
    pub geometry: Geometry,
    pub laws: Vec<Law>,
    /// First formula without a finite value, by its index in [`Model::formulas`](crate::model::Model::formulas).
    pub undefined: Option<usize>,
    /// Design velocities of the variables, if requested, and the joints that each opens in the nominal design.
    pub fields: Vec<DesignVelocity>,
    pub opens: Vec<Vec<JointDefect>>,
    pub scope: Scope,
    /// Results that count: all of them if `None`.
    pub needs: Option<Arc<NeededResults>>,
    /// The same design where its equilibria go on with other openings.
    pub continued: Continuations,
}

/// An analysis with the design that it solves.
#[derive(Clone, Copy)]
pub(crate) struct Plan<'a> {
    pub analysis: &'a Analysis<'a>,
    pub design: &'a PreparedDesign,
    /// Number of plans that were followed before.
    number: usize,
}

/// A workspace that belongs to a plan, and is made again for the next one.
pub(crate) struct PerPlan<W, F> {
    make: F,
    number: usize,
    made: W,
}

impl<'a, W, F: Fn(Plan<'a>) -> W> PerPlan<W, F> {
    pub fn new(analysis: &'a Analysis<'a>, design: &'a PreparedDesign, make: F) -> Self {
        Self { number: 0, made: make(Plan { analysis, design, number: 0 }), make }
    }

    /// The workspace of the first plan, before the walk begins.
    pub fn first(&self) -> &W {
        &self.made
    }

    /// The workspace of this plan.
    pub fn on(&mut self, plan: Plan<'a>) -> &mut W {
        if plan.number != self.number {
            (self.number, self.made) = (plan.number, (self.make)(plan));
        }
        &mut self.made
    }
}

/// Plans with other openings, in the order of their first use.
#[derive(Default)]
pub(crate) struct Continuations(OnceLock<Box<(Continuation, Continuations)>>);

/// A plan that continues another from any of its positions.
struct Continuation {
    analysis: Analysis<'static>,
    design: PreparedDesign,
}

impl Continuations {
    /// The plan with the openings of this analysis, which is added if it is new.
    fn with(
        &self,
        analysis: Analysis<'static>,
        prepare: impl Fn(&Analysis<'_>) -> PreparedDesign,
    ) -> &Continuation {
        let mut last = self;
        while let Some((plan, next)) = last.0.get().map(|found| &**found) {
            if plan.analysis.drives_the_same(&analysis) {
                return plan;
            }
            last = next;
        }
        let new = || {
            let design = prepare(&analysis);
            Box::new((Continuation { analysis, design }, Self::default()))
        };
        &last.0.get_or_init(new).0
    }
}

impl PreparedDesign {
    /// True if a measure is requested.
    pub fn needs_measure(&self, measure: usize) -> bool {
        self.needs.as_ref().is_none_or(|needs| needs.measure(measure))
    }
}

/// Solver of one design at all output times.
pub(crate) struct Walk<'a> {
    analysis: &'a Analysis<'a>,
    first: &'a PreparedDesign,
    /// The plan that is followed now.
    plan: Plan<'a>,
    pub one: Stepper<'a>,
    batch: TimeBatch<'a>,
    /// Motion of the design between whose times all others than the first are.
    known: Option<&'a Motion>,
    /// `None` if no sensitivities are requested.
    pub solver: Option<SensitivitySolver>,
    /// `None` if no loads are requested.
    loads: Option<LoadSolver<'a>>,
    /// Makes the solver of the loads.
    loads_of: Option<Box<dyn Fn(Plan<'a>) -> LoadSolver<'a> + 'a>>,
    /// `None` if all joints are rigid.
    pub equilibrium: Option<EquilibriumSolver<'a>>,
    /// Per body: true if its results are requested.
    wanted: Vec<bool>,
    /// Derivatives to solve; all of them if `None`.
    needs: Option<Arc<NeededResults>>,
    /// Stop at the limit of a joint, which ends the output times.
    at_limit: Option<Stop>,
    /// Formula without a finite value in this design.
    undefined: Option<usize>,
    /// Output times solved.
    pub done: usize,
}

/// Steps that were just solved: one output time, or several in these lanes of a program.
pub(crate) enum SolvedSteps<'w, 'a> {
    One(Plan<'a>, &'w mut Stepper<'a>, Option<&'w LoadSolver<'a>>, Option<&'w mut EquilibriumSolver<'a>>),
    Batch(&'w Tape, Range<usize>, Option<&'w TurnCounter<'a>>),
}

impl<'a> Walk<'a> {
    /// Solver that goes step by step.
    pub fn new(analysis: &'a Analysis<'a>, design: &'a PreparedDesign, wanted: Vec<bool>) -> Self {
        let (model, topology) = (analysis.solved_model(), analysis.topology());
        let PreparedDesign { geometry, laws, fields, .. } = design;
        let openings = analysis.openings();
        let equilibrium = openings.map(|openings| {
            let (design_map, user) = (analysis.design_map(), analysis.model());
            EquilibriumSolver::new(design_map, topology, &design.values, openings, fields, user)
        });
        // The openings follow the design as far as the equilibrium asks for it.
        let followed = openings.map(|(openings, _)| {
            fields.iter().map(|field| field.clone().with_openings(openings)).collect::<Vec<_>>()
        });
        let fields = followed.as_ref().unwrap_or(fields);
        let mut one = Stepper::new(model, topology, PlanGeometry::same(model, topology, geometry, laws));
        let angles = PathAngles::of(analysis.design_map(), topology, &design.values, design.scope.measures);
        one.turns = angles.map(|angles| TurnCounter::new(Box::new(angles)));
        let solver = || {
            let solver = SensitivitySolver::new(model, topology, fields, wanted.clone());
            if openings.is_some() { solver.at_rest() } else { solver }
        };
        Self {
            analysis,
            first: design,
            plan: Plan { analysis, design, number: 0 },
            one,
            batch: TimeBatch::new(None, &[], None),
            known: None,
            solver: (!fields.is_empty()).then(solver),
            loads: None,
            loads_of: None,
            equilibrium,
            wanted,
            needs: design.needs.clone(),
            at_limit: analysis.stop_at_limit(design),
            undefined: design.undefined,
            done: 0,
        }
    }

    /// The same solver with loads, by the solver that `of` makes for each plan.
    pub fn with_loads(self, of: impl Fn(Plan<'a>) -> LoadSolver<'a> + 'a) -> Self {
        Self { loads: Some(of(self.plan)), loads_of: Some(Box::new(of)), ..self }
    }

    /// The same solver for times between those of a motion of the same design.
    pub fn between(self, known: &'a Motion) -> Self {
        Self { known: Some(known), ..self }
    }

    /// Solver that uses programs, one output time per lane, if that is possible and saves time.
    pub fn by_programs(
        analysis: &'a Analysis<'a>,
        design: &'a PreparedDesign,
        wanted: Vec<bool>,
        (margins, slopes, loads): (bool, bool, bool),
    ) -> Self {
        let mut walk = Self::new(analysis, design, wanted);
        if analysis.programs_pay(design.scope.of_many) {
            let (sensitivities, any_design) =
                (walk.solver.is_some(), design.values.iter().any(|v| *v != 0.0));
            let moved: Vec<_> = walk.solver.iter().flat_map(SensitivitySolver::moved).collect();
            let program = move |corrections| {
                let purpose =
                    Purpose { times: true, any_design, corrections, sensitivities, margins, slopes, loads };
                analysis.program(purpose).filter(|program| program.moved == moved)
            };
            let laws = analysis.laws_program(&design.laws, loads);
            walk.batch = TimeBatch::new(Some(Box::new(program)), &design.values, laws);
        }
        walk
    }

    /// Solves up to the last output time or a stop. Calls `then` with the stepper at each output time; nothing is
    /// stored.
    pub fn each(&mut self, mut then: impl FnMut(&mut Stepper<'a>)) -> Option<Stop> {
        self.all(&mut NullSink, &mut |_| ControlFlow::Continue(()), |_, solved, _, _| {
            if let SolvedSteps::One(_, one, ..) = solved {
                then(one);
            }
        })
    }

    /// Solves up to the last output time or a stop. Calls `then` with the solved steps, the number of valid output
    /// times among them, and the sensitivity solver.
    pub fn all<S: Sink>(
        &mut self,
        sink: &mut S,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        mut then: impl FnMut(&mut S, SolvedSteps<'_, 'a>, usize, Option<&SensitivitySolver>),
    ) -> Option<Stop> {
        if let Some(formula) = self.undefined {
            return Some(self.analysis.stopped(StopKind::FormulaNotFinite { formula }, 0));
        }
        let times = self.times();
        let mut stop = None;
        while self.done < times.len() && stop.is_none() {
            let k = self.done;
            if self.analysis.is_ended() {
                return Some(self.interrupted(k));
            }
            let at_once = match k {
                0 => 0,
                _ => self.batch.advance(&mut self.one, k, times, || sink.room(k)),
            };
            let count;
            let solved = if at_once == 0 {
                if let Err(failed) = self.step(k) {
                    return Some(*failed);
                }
                (count, stop) = self.report(1, progress);
                self.give_one(k, sink);
                SolvedSteps::One(self.plan, &mut self.one, self.loads.as_ref(), self.equilibrium.as_mut())
            } else {
                (count, stop) = self.report(at_once, progress);
                let lanes = self.give_batch(k, count, sink);
                SolvedSteps::Batch(self.batch.solved(), lanes, self.one.turns.as_ref())
            };
            then(sink, solved, count, self.solver.as_ref());
            self.done += count;
        }
        stop.or_else(|| self.at_limit.clone())
    }

    /// Output times up to the limit of a joint that ends the motion.
    fn times(&self) -> &'a [f64] {
        let times = &self.analysis.model().times[..];
        match &self.at_limit {
            Some(Stop { last_time, .. }) => {
                &times[..times.partition_point(|t| last_time.is_some_and(|last| *t <= last))]
            }
            None => times,
        }
    }

    /// Solves output time k alone.
    fn step(&mut self, k: usize) -> Result<(), Box<Stop>> {
        let t = self.analysis.model().times[k];
        let step = match &mut self.equilibrium {
            Some(equilibrium) => {
                let begun = if k == 0 { advance::start_at_rest(&mut self.one, t) } else { Ok(()) };
                match begun {
                    Ok(()) => equilibrium.step(&mut self.one, t).or_else(|stop| self.go_on(t, stop)),
                    Err(stop) => Err(stop),
                }
            }
            None if k == 0 => advance::start(&mut self.one, t),
            None => match self.known {
                Some(known) => advance_between(&mut self.one, known, t),
                None => advance::advance(&mut self.one, t),
            },
        };
        step.map_err(|mut stop| {
            if let (StopKind::DoesNotAssemble, Some(block)) = (stop.kind, stop.block) {
                stop.remains = assembly::least_gaps(&mut self.one.mechanism, block);
            }
            stop
        })
    }

    /// Goes on to the equilibrium at time t where the openings at hand no longer describe the motion: with those that
    /// the constraints leave at the position accepted last. Returns the stop if it ends there with these as well.
    fn go_on(&mut self, t: f64, mut stop: Box<Stop>) -> Result<(), Box<Stop>> {
        loop {
            let takes_shortest_steps =
                self.equilibrium.as_ref().is_none_or(EquilibriumSolver::takes_shortest_steps);
            if takes_shortest_steps && !may_end_with_openings(&stop.kind) {
                return Err(stop);
            }
            let rows = self.one.mechanism.accepted_rows();
            let Some(([is_singular, is_singular_if_rigid], analysis)) =
                self.plan.analysis.examine_openings(&rows)
            else {
                return Err(stop);
            };
            let other = analysis.and_then(|analysis| self.in_openings_of(analysis));
            let worth = |other: &Walk<'_>| {
                takes_shortest_steps || self.one.least_pivot_ratio() < BETTER * other.one.least_pivot_ratio()
            };
            let taken = other.filter(worth).and_then(|mut other| {
                let equilibrium = other.equilibrium.as_mut()?;
                let from = equilibrium.reached();
                let step = equilibrium.step(&mut other.one, t);
                let goes_on = match (from, equilibrium.reached()) {
                    ((_, Some(from)), (_, Some(to))) => to - from > FURTHER * (t - from),
                    ((from, None), (to, None)) => to - from > FURTHER,
                    ((_, None), (_, Some(_))) | ((_, Some(_)), (_, None)) => true,
                };
                goes_on.then_some((other, step))
            });
            let step = match (taken, &mut self.equilibrium) {
                (Some((other, step)), _) => {
                    self.follow_plan(other);
                    step
                }
                (None, Some(equilibrium)) if !takes_shortest_steps => {
                    equilibrium.permit_shorter_steps();
                    equilibrium.step(&mut self.one, t)
                }
                (None, _) => {
                    // A limit load, at which the stiffness vanishes, may be next to a limit of the rigid mechanism.
                    if is_singular || is_singular_if_rigid && !stop.snaps_through {
                        stop.kind = StopKind::Limit;
                        stop.joints = self.one.joints_nearest_to_singular();
                    }
                    return Err(stop);
                }
            };
            match step {
                Ok(()) => return Ok(()),
                Err(next) => stop = next,
            }
        }
    }

    /// Solver of the same model with the openings of another analysis, at the position accepted last; `None` if it
    /// cannot continue there.
    fn in_openings_of(&self, analysis: Analysis<'static>) -> Option<Walk<'a>> {
        let first = self.first;
        let prepare = |analysis: &Analysis<'_>| PreparedDesign {
            opens: first.opens.clone(),
            needs: first.needs.clone(),
            ..analysis.prepare(&first.values, first.scope)
        };
        let Continuation { analysis, design } = first.continued.with(analysis, prepare);
        let mut other = Walk::new(analysis, design, self.wanted.clone());
        other.plan.number = self.plan.number + 1;
        other.one.continue_from(&self.one).ok()?;
        let (equilibrium, before) = (other.equilibrium.as_mut()?, self.equilibrium.as_ref()?);
        let is_continued = equilibrium.continue_from(before, &mut other.one);
        // Results have the bodies of the first plan that each variable moves.
        let moves_the_same = match (&mut other.solver, &self.solver) {
            (Some(solver), Some(before)) => {
                solver.continue_from(before);
                solver.moved().eq(before.moved())
            }
            (None, None) => true,
            (Some(_), None) | (None, Some(_)) => false,
        };
        (is_continued && moves_the_same).then_some(other)
    }

    /// Follows the plan of another solver.
    fn follow_plan(&mut self, other: Walk<'a>) {
        let Walk { plan, mut one, solver, equilibrium, .. } = other;
        one.assembly = self.one.assembly.take();
        self.loads = self.loads_of.as_ref().map(|of| of(plan));
        (self.plan, self.one, self.solver, self.equilibrium) = (plan, one, solver, equilibrium);
    }

    /// Stop of the caller after `done` output times.
    fn interrupted(&self, done: usize) -> Stop {
        let mut stop = self.analysis.stopped(StopKind::Interrupted, done);
        if done > 0 {
            self.one.write_released(self.analysis.model(), &mut stop.drivers);
        }
        stop
    }

    /// Reports progress for `solved` output times. Returns how many of them are valid, and the stop if the caller
    /// interrupts the run.
    fn report(
        &self,
        solved: usize,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> (usize, Option<Stop>) {
        let total = self.analysis.model().times.len();
        for count in 1..=solved {
            let done = self.done + count;
            if progress(Progress { done, total }).is_break() && done < total {
                return (count, Some(self.interrupted(done)));
            }
        }
        (solved, None)
    }

    /// Passes on output time k, the position of the stepper.
    #[inline(always)]
    fn give_one<S: Sink>(&mut self, k: usize, sink: &mut S) {
        for body in (1..self.wanted.len()).filter(|b| self.wanted[*b]) {
            sink.state(k, BodyId(body), &BodyState::of(&self.one.mechanism.state, body));
        }
        let (t, loads) = (self.analysis.model().times[k], &mut self.loads);
        let differentiates = self.needs.as_ref().is_none_or(|needs| needs.at(k));
        if let Some(loads) = loads {
            loads.step(&mut self.one, t, differentiates);
        }
        if !differentiates {
            let unknown = BodySensitivity::from(|_| f64::NAN);
            let moved = self.solver.iter().flat_map(SensitivitySolver::moved);
            for (variable, body) in moved.filter(|(_, body)| self.wanted[body.0]) {
                sink.sensitivity(k, variable, body, &unknown);
            }
            return;
        }
        if let (Some(equilibrium), Some(solver)) = (&mut self.equilibrium, &mut self.solver) {
            equilibrium.differentiate(&mut self.one, t, |v, rates| solver.set_openings(v, rates));
        }
        if let Some(solver) = &mut self.solver {
            let found = |variable, body, found: &_| sink.sensitivity(k, variable, body, found);
            solver.step(&mut self.one, t, found, |by| {
                if let Some(loads) = loads {
                    loads.differentiate(&by);
                }
            });
        }
    }

    /// Passes on `count` output times from k on, with the lanes of the program that solved them.
    #[inline(always)]
    fn give_batch<S: Sink>(&mut self, k: usize, count: usize, sink: &mut S) -> Range<usize> {
        let first = k % LANES;
        let lanes = first..first + count;
        if let Some(block) = self.batch.own_results() {
            let moved = self.solver.iter().flat_map(SensitivitySolver::moved);
            let of = |lane: usize| (0, k + lane - first);
            hand_over(&block, &self.wanted, moved, std::slice::from_mut(sink), lanes.clone(), of);
        }
        if let Some(solver) = &mut self.solver {
            let times = &self.analysis.model().times[k..k + count];
            solver.note(self.batch.solved(), &self.one.mechanism.topology, times, first);
        }
        lanes
    }

    /// Admissibility per variable, for the output times solved so far.
    pub fn admissibility(&self, opens: &[Vec<JointDefect>]) -> Vec<Admissibility> {
        self.solver.as_ref().map_or_else(Vec::new, |s| s.admissibility(opens, self.done))
    }
}

/// True if the equilibria along a motion may end for this reason because of the openings that describe it.
fn may_end_with_openings(kind: &StopKind) -> bool {
    match kind {
        StopKind::LimitLoad { .. }
        | StopKind::NoEquilibrium
        | StopKind::Unstable { .. }
        | StopKind::TooStiff { .. } => true,
        StopKind::Limit
        | StopKind::CurveEnd { .. }
        | StopKind::BranchChange
        | StopKind::DoesNotAssemble
        | StopKind::Locked { .. }
        | StopKind::LawNotFinite { .. }
        | StopKind::LoadNotFinite { .. }
        | StopKind::FormulaNotFinite { .. }
        | StopKind::TooFar { .. }
        | StopKind::JointLimit { .. }
        | StopKind::Interrupted
        | StopKind::NothingHolds { .. } => false,
    }
}

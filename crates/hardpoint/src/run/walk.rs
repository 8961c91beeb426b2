//! Solution of one design at all output times.

use std::ops::{ControlFlow, Range};
use std::sync::Arc;

use hardpoint_tape::LANES;

use crate::design::{DesignVelocity, Geometry};
use crate::equilibrium::EquilibriumSolver;
use crate::law::Law;
use crate::load::LoadSolver;
use crate::measure::PathAngles;
use crate::model::BodyId;
use crate::motion::parts::PlanGeometry;
use crate::motion::step_program::Purpose;
use crate::motion::stepper::Stepper;
use crate::motion::tape::Tape;
use crate::motion::time_batch::TimeBatch;
use crate::motion::turns::TurnCounter;
use crate::motion::{BodyState, Stop, StopKind, advance, assembly};
use crate::sensitivity::{Admissibility, BodySensitivity, JointDefect, SensitivitySolver};

use super::analysis::Analysis;
use super::needed::NeededResults;
use super::request::Progress;
use super::sink::{NullSink, Sink, hand_over};

/// Requested results of a design.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scope {
    pub sensitivities: bool,
    pub measures: bool,
    /// Total number of designs, this one included; it decides whether a program saves time.
    pub of_many: usize,
}

impl Scope {
    /// Scope of a single design.
    pub fn of_one(sensitivities: bool, measures: bool) -> Self {
        Self { sensitivities, measures, of_many: 1 }
    }
}

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
    pub one: Stepper<'a>,
    batch: TimeBatch<'a>,
    /// `None` if no sensitivities are requested.
    pub solver: Option<SensitivitySolver>,
    /// `None` if no loads are requested.
    pub loads: Option<LoadSolver<'a>>,
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
    One(&'w mut Stepper<'a>, Option<&'w LoadSolver<'a>>, Option<&'w mut EquilibriumSolver<'a>>),
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
            one,
            batch: TimeBatch::new(None, &[], None),
            solver: (!fields.is_empty()).then(solver),
            loads: None,
            equilibrium,
            wanted,
            needs: design.needs.clone(),
            at_limit: analysis.stop_at_limit(design),
            undefined: design.undefined,
            done: 0,
        }
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
            if let SolvedSteps::One(one, ..) = solved {
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
                SolvedSteps::One(&mut self.one, self.loads.as_ref(), self.equilibrium.as_mut())
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
                begun.and_then(|()| equilibrium.step(&mut self.one, t))
            }
            None if k == 0 => advance::start(&mut self.one, t),
            None => advance::advance(&mut self.one, t),
        };
        step.map_err(|mut stop| {
            if let (StopKind::DoesNotAssemble, Some(block)) = (stop.kind, stop.block) {
                stop.remains = assembly::least_gaps(&mut self.one.mechanism, block);
            }
            stop
        })
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

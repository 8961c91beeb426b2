//! The whole walk for one model: plan, motion, sensitivities, measures.

pub(crate) mod sink;
mod window;

pub use sink::Sink;
pub use window::{Footprint, Keep, Kept};

use std::num::NonZero;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use hardpoint_tape::{LANES, Number};
use sink::{Store, hand_over};

use crate::design::{Effects, Field, Geometry};
use crate::law::Law;
use crate::measure::{self, Before, Measured, SlopeValues};
use crate::model::{BodyId, Model};
use crate::motion::abreast::Abreast;
use crate::motion::designs::SideBySide;
use crate::motion::execution::Cache;
use crate::motion::kinematics::State;
use crate::motion::parts::Parts;
use crate::motion::step_program::{Programs, Purpose, Recorded, StepProgram};
use crate::motion::stepper::Stepper;
use crate::motion::tape::Tape;
use crate::motion::{BodyState, Effort, Execution, Motion, SolvedBy, Stop, StopKind};
use crate::number::record as recording;
use crate::sensitivity::{
    Admissibility, JointDefect, Resisting, Sensing, Sensitivities, admissibility, admissibility_at_design,
    along, note_defects, record_derivatives,
};
use crate::topology::{Formulation, Topology, TopologyFault};

/// A model with its plan of solution, ready to be run as often as needed.
///
/// ```
/// # use hardpoint::{draft::*, model::*}; use hardpoint::law::Law; use hardpoint::space::Vec3;
/// // A crank of 0.2 m that turns once per second.
/// let draft = Draft {
///     bodies: vec![BodyDraft { name: "crank".into(), frame: FrameDraft::Default }],
///     joints: vec![JointDraft {
///         name: "pivot".into(), kind: "revolute".into(), bodies: ["ground".into(), "crank".into()],
///         at: vec![Place::At(Vec3::ZERO)], axis: Some(Line::Along(Vec3::new(0.0, 0.0, 1.0))),
///         ..JointDraft::default()
///     }],
///     drivers: vec![DriverDraft {
///         name: "motor".into(),
///         drives: DrivenDraft::Coordinate { joint: "pivot".into(), coordinate: None },
///         law: Law::parse("2*pi*t").unwrap(),
///     }],
///     points: vec![PointDraft {
///         name: "tip".into(), body: "crank".into(), at: Place::At(Vec3::new(0.2, 0.0, 0.0)),
///     }],
///     times: vec![0.0, 0.25],
///     ..Draft::default()
/// };
/// let model = Model::from_draft(&draft).unwrap();
/// let solution = hardpoint::Analysis::new(&model).unwrap().run();
/// let tip_y = solution.measured.index("tip.y").unwrap();
/// let [y, speed, acceleration] = solution.measured.value(1, tip_y);
/// assert!((y - 0.2).abs() < 1e-12);
/// assert!(speed.abs() < 1e-12);
/// assert!((acceleration + 0.2 * (2.0 * std::f64::consts::PI).powi(2)).abs() < 1e-11);
/// ```
#[derive(Clone, Debug)]
pub struct Analysis<'m> {
    model: &'m Model,
    topology: Topology,
    effects: Effects<'m>,
    pub(crate) measures: bool,
    /// Per variable, the joints that it opens in the nominal design: worked out when first asked for.
    opens: OnceLock<Vec<Vec<JointDefect>>>,
    /// Steps as straight-line programs, recorded when they pay.
    programs: Arc<Programs>,
    /// The same of measures.
    formulas: Arc<Cache<measure::Asked, measure::Program>>,
}

/// One design, ready to be analysed.
pub(crate) struct Design {
    pub values: Vec<f64>,
    geometry: Geometry,
    pub laws: Vec<Law>,
    /// How the variables change it, if that is asked for, and the joints that each opens in the nominal design.
    fields: Vec<Field>,
    pub opens: Vec<Vec<JointDefect>>,
    /// How many designs are solved in all, itself included: what is worth a program for all of them.
    of_many: usize,
}

impl Design {
    /// Whether its sensitivities are asked for, and there are any.
    pub fn has_fields(&self) -> bool {
        !self.fields.is_empty()
    }
}

/// What a streamed run says at its end.
#[derive(Clone, Debug)]
pub struct Streamed {
    /// Output times solved.
    pub steps: usize,
    /// Per variable: whether and how the mechanism follows the change.
    pub admissibility: Vec<Admissibility>,
    /// What it took.
    pub effort: Effort,
    /// Why the run ended before the last output time, if it did.
    pub stop: Option<Stop>,
}

/// What a run found. Everything that was solved is here, also where something stopped it.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// The motion, up to the last output time that was solved.
    pub motion: Motion,
    /// Sensitivities of all bodies by all design variables.
    pub sensitivities: Sensitivities,
    /// Measures and points, with their sensitivities.
    pub measured: Measured,
    /// Why the run ended before the last output time, if it did.
    pub stop: Option<Stop>,
}

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Output times solved.
    pub done: usize,
    /// Output times in all.
    pub total: usize,
}

impl<'m> Analysis<'m> {
    /// Plans the solution of a model in relative coordinates.
    ///
    /// # Errors
    /// A [`TopologyFault`] where the drivers leave motions free or contradict the joints.
    pub fn new(model: &'m Model) -> Result<Self, TopologyFault> {
        Self::with(model, Formulation::Relative)
    }

    /// Plans the solution of a model in the formulation asked for.
    ///
    /// # Errors
    /// As [`Analysis::new`].
    pub fn with(model: &'m Model, formulation: Formulation) -> Result<Self, TopologyFault> {
        let topology = Topology::of(model, formulation)?;
        let programs = Arc::new(Programs::new(Execution::default()));
        Ok(Self {
            model,
            topology,
            effects: Effects::of(model),
            measures: true,
            opens: OnceLock::new(),
            programs,
            formulas: Arc::default(),
        })
    }

    /// The same analysis for callers that want the bodies only: [`Solution::measured`] stays empty.
    pub fn bodies_only(self) -> Self {
        Self { measures: false, ..self }
    }

    /// The same analysis, its steps solved in this way.
    pub fn executed(self, execution: Execution) -> Self {
        Self { programs: Arc::new(Programs::new(execution)), formulas: Arc::default(), ..self }
    }

    /// How the even steps of the nominal design's motion are solved.
    pub fn solved_by(&self) -> SolvedBy {
        let hindrance = StepProgram::hindrance(&self.topology, self.measures);
        match hindrance.or(self.goes_by_driver().then_some("measures go by a driver that moves alone")) {
            Some(why) => SolvedBy::Kernel(why.into()),
            None => self.programs.solved_by(self.model.times.len()),
        }
    }

    /// Whether measures that are asked for go by a driver that moves alone, and need more of a step than programs hand out.
    fn goes_by_driver(&self) -> bool {
        self.measures && (0..self.model.measures.len()).any(|k| self.model.goes_by_driver(k))
    }

    /// The plan.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    pub(crate) fn effects(&self) -> &Effects<'m> {
        &self.effects
    }

    /// Per variable, the joints that it opens in the nominal design.
    pub(crate) fn opens(&self) -> &[Vec<JointDefect>] {
        self.opens.get_or_init(|| {
            let nominal = self.effects.fields(&self.model.whole(&[]));
            nominal.iter().map(|field| admissibility_at_design(self.model, field)).collect()
        })
    }

    /// The model.
    pub fn model(&self) -> &'m Model {
        self.model
    }

    /// Solves motion, sensitivities by all design variables, and measures at all output times.
    pub fn run(&self) -> Solution {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// As [`Analysis::run`]; `progress` is called after every output time and may end the run.
    pub fn run_with(&self, mut progress: impl FnMut(Progress) -> ControlFlow<()>) -> Solution {
        let mut solution = Solution::default();
        self.solve(&self.design(&[], true), &mut progress, &mut solution);
        solution
    }

    /// As [`Analysis::run`], into the memory of a former solution.
    pub fn run_into(&self, solution: &mut Solution) {
        self.solve(&self.design(&[], true), &mut |_| ControlFlow::Continue(()), solution);
    }

    /// As [`Analysis::run`], for the changed design with variable k at `design[k]`: its motion, and its sensitivities there.
    ///
    /// Whether joints open under a further change is answered for the nominal design.
    pub fn run_at(&self, design: &[f64]) -> Solution {
        let mut solution = Solution::default();
        self.solve(&self.design(design, true), &mut |_| ControlFlow::Continue(()), &mut solution);
        solution
    }

    /// Solves the motion only, without any sensitivity.
    pub fn run_motion(&self) -> Solution {
        self.run_design(&[])
    }

    /// As [`Analysis::run_motion`], into the memory of a former solution.
    pub fn run_motion_into(&self, solution: &mut Solution) {
        self.solve(&self.design(&[], false), &mut |_| ControlFlow::Continue(()), solution);
    }

    /// Solves the motion of the changed design with variable k at `design[k]`, exactly.
    pub fn run_design(&self, design: &[f64]) -> Solution {
        let mut solution = Solution::default();
        self.solve(&self.design(design, false), &mut |_| ControlFlow::Continue(()), &mut solution);
        solution
    }

    pub(crate) fn design(&self, design: &[f64], sensitivities: bool) -> Design {
        let values = self.model.whole(design);
        Design {
            geometry: self.effects.geometry(&values),
            laws: self.effects.laws(&values),
            fields: if sensitivities { self.effects.fields(&values) } else { Vec::new() },
            opens: if sensitivities { self.opens().to_vec() } else { Vec::new() },
            of_many: 1,
            values,
        }
    }

    /// Whether and how the mechanism follows a change of the nominal design as a whole, in which variable k goes by `change[k]`:
    /// together, variables may be followed that are not one by one.
    pub fn admissibility_of(&self, change: &[f64]) -> Admissibility {
        let mut design = self.design(&[], false);
        let along = along(&self.model.whole(change));
        let field = self.effects.field_along(&along, &design.values);
        design.opens = vec![admissibility_at_design(self.model, &field)];
        design.fields = vec![field];
        let mut walk = Walk::new(self, &design, vec![false; self.model.bodies.len()]);
        walk.each(self, |_| ());
        let sensing = walk.sensing.expect("there is a field");
        sensing.admissibility(&design.opens, walk.done).pop().expect("that of the one field")
    }

    /// As [`Analysis::run`], but nothing is stored: the sink takes every result as it is found.
    ///
    /// What 10,000 loops and 1,000 variables give need not fit into memory; measures are not evaluated.
    pub fn stream(&self, sink: &mut impl Sink) -> Streamed {
        self.stream_at(&[], sink)
    }

    /// As [`Analysis::stream`], for a changed design.
    pub fn stream_at(&self, design: &[f64], sink: &mut impl Sink) -> Streamed {
        let design = self.design(design, true);
        let wanted = self.wanted(std::slice::from_ref(sink));
        let mut walk = Walk::by_programs(self, &design, wanted, false);
        let stop = walk.all(self, sink, &mut |_| ControlFlow::Continue(()), |_, _, _, _| ());
        let effort = walk.one.effort;
        let admissibility = walk.sensing.map_or_else(Vec::new, |s| s.admissibility(&design.opens, walk.done));
        Streamed { steps: walk.done, admissibility, effort, stop }
    }

    /// Per body, whether any sink wants its results.
    fn wanted<S: Sink>(&self, sinks: &[S]) -> Vec<bool> {
        (0..self.model.bodies.len()).map(|b| sinks.iter().any(|s| s.wants(BodyId(b)))).collect()
    }

    fn solve(
        &self,
        design: &Design,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
    ) {
        self.walk(design, self.model.times.len(), progress, solution, &mut |_, _| ());
    }

    /// The stop of a run that was told to end after time t.
    fn interrupted(&self, t: f64) -> Stop {
        Stop {
            kind: StopKind::Interrupted,
            last_time: Some(t),
            failed_time: t,
            drivers: self.model.drivers.iter().map(|d| d.law.at(t).value()).collect(),
            block: None,
            pivot_ratio: 1.0,
            joints: Vec::new(),
            remains: Vec::new(),
            closed: None,
        }
    }

    /// Empties a motion, with room for so many output times.
    pub(crate) fn make_room(&self, motion: &mut Motion, steps: usize) {
        motion.bodies = self.model.bodies.len();
        motion.states.shape(BodyState::NUMBERS * (motion.bodies - 1), steps);
        motion.coordinates.shape(self.topology.coordinates.len(), steps);
        motion.times.clear();
        motion.times.reserve(steps);
        motion.margins.clear();
        motion.assembly = None;
        motion.solved_by = None;
        motion.passed.clear();
        motion.beyond = None;
    }

    /// Evaluates the measures of a motion that goes on from what was `before`.
    pub(crate) fn measure(
        &self,
        design: &Design,
        slopes: &SlopeValues,
        before: Option<&Before>,
        solution: &mut Solution,
    ) {
        let Solution { motion, sensitivities, measured, .. } = solution;
        if !self.measures {
            *measured = Measured::default();
            return;
        }
        let Design { values, laws, of_many, .. } = design;
        let at = measure::At { model: self.model, effects: &self.effects, values, laws };
        let program = self.programs.pay(self.model.times.len() * of_many).then(|| {
            let asked = measure::Asked::of(self.model, values, sensitivities);
            let execution = self.programs.execution();
            self.formulas.get(asked, |asked| measure::Program::record(&self.effects, asked, execution))
        });
        let (program, solved) = (program.flatten(), (&*motion, &*sensitivities));
        measure::evaluate(&at, &self.topology, solved, slopes, before, program.as_deref(), measured);
    }

    /// Motions of many changed designs, in the order given.
    ///
    /// Where one of those that are solved side by side stops, each of them is solved again on its own, so that every
    /// design gets its own outcome. Lanes and single runs agree to round-off (`docs/performance.md`).
    pub fn run_designs(&self, designs: &[Vec<f64>]) -> Vec<Solution> {
        let mut solutions: Vec<Solution> = designs.iter().map(|_| Solution::default()).collect();
        let (many, mut beside) = (designs.len(), self.side_by_side(designs.len(), false));
        for (designs, solutions) in designs.chunks(LANES).zip(solutions.chunks_mut(LANES)) {
            self.solve_designs(&mut beside, designs, many, solutions);
        }
        solutions
    }

    /// As [`Analysis::run_designs`], for any number of designs in little memory: `visit` sees every design's number and its
    /// solution, which is overwritten later.
    pub fn for_each_design(&self, designs: &[Vec<f64>], mut visit: impl FnMut(usize, &Solution)) {
        let mut solutions: [Solution; LANES] = std::array::from_fn(|_| Solution::default());
        let (many, mut beside) = (designs.len(), self.side_by_side(designs.len(), false));
        for (group, designs) in designs.chunks(LANES).enumerate() {
            self.solve_designs(&mut beside, designs, many, &mut solutions[..designs.len()]);
            for (k, solution) in solutions[..designs.len()].iter().enumerate() {
                visit(group * LANES + k, solution);
            }
        }
    }

    /// As [`Analysis::for_each_design`], on so many threads, the designs in no certain order.
    ///
    /// The same designs share their lanes however many threads there are, so that every solution is the same to the last bit.
    ///
    /// # Panics
    /// If `visit` does.
    pub fn for_each_design_on(
        &self,
        threads: NonZero<usize>,
        designs: &[Vec<f64>],
        visit: impl Fn(usize, &Solution) + Sync,
    ) {
        let next = AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..threads.get() {
                scope.spawn(|| {
                    let mut solutions: [Solution; LANES] = std::array::from_fn(|_| Solution::default());
                    let mut beside = self.side_by_side(designs.len(), false);
                    let groups = || Some(next.fetch_add(1, Ordering::Relaxed));
                    for group in std::iter::from_fn(groups).take_while(|g| g * LANES < designs.len()) {
                        let first = group * LANES;
                        let some = &designs[first..usize::min(first + LANES, designs.len())];
                        self.solve_designs(&mut beside, some, designs.len(), &mut solutions[..some.len()]);
                        solutions[..some.len()].iter().enumerate().for_each(|(k, s)| visit(first + k, s));
                    }
                });
            }
        });
    }

    /// As [`Analysis::stream`], for any number of designs in the order given, eight at a time: every design's results, with
    /// its sensitivities, go to a sink of its own, which `sink` makes and `end` gets back.
    ///
    /// Results of up to eight designs come by turns. Where one of those that are solved side by side stops, each of them
    /// begins anew with a new sink, so that every design gets its own outcome.
    pub fn stream_designs<S: Sink>(
        &self,
        designs: &[Vec<f64>],
        mut sink: impl FnMut(usize) -> S,
        mut end: impl FnMut(usize, S, Streamed),
    ) {
        let mut beside = self.side_by_side(designs.len(), true);
        for (group, designs) in designs.chunks(LANES).enumerate() {
            let number = |k: usize| group * LANES + k;
            let mut sinks: Vec<S> = (0..designs.len()).map(|k| sink(number(k))).collect();
            match self.stream_side_by_side(&mut beside, designs, &mut sinks) {
                Some((effort, mut resisting)) => {
                    let (steps, variables) = (self.model.times.len(), self.model.variables.len());
                    for (k, sink) in sinks.into_iter().enumerate() {
                        let resisting = resisting.drain(..variables).collect();
                        let admissibility = admissibility(self.opens(), resisting, steps);
                        end(number(k), sink, Streamed { steps, admissibility, effort, stop: None });
                    }
                }
                None => {
                    for (k, design) in designs.iter().enumerate() {
                        let mut sink = sink(number(k));
                        let streamed = self.stream_at(design, &mut sink);
                        end(number(k), sink, streamed);
                    }
                }
            }
        }
    }

    /// The step of this plan as a program, recorded where the nominal motion begins.
    fn program(&self, purpose: Purpose) -> Option<Arc<StepProgram>> {
        if StepProgram::hindrance(&self.topology, purpose.margins).is_some() {
            return None;
        }
        self.programs.step(purpose, |execution| {
            let one = self.started()?;
            let besides = |plan: &Topology, state: &mut State<Number>, values: &[Number]| {
                if !purpose.sensitivities {
                    return Some(Recorded::default());
                }
                let fields = recording::strictly(|| self.effects.fields(values));
                record_derivatives(self.model, &fields, plan, state)
            };
            StepProgram::record(&one, &self.effects, purpose, besides, execution)
        })
    }

    /// The nominal design where its motion begins.
    fn started(&self) -> Option<Stepper<'m>> {
        let Design { geometry, laws, .. } = self.design(&[], false);
        let parts = Parts::same(self.model, &self.topology, &geometry, &laws);
        let mut one = Stepper::new(self.model, &self.topology, parts);
        one.start(*self.model.times.first()?).ok()?;
        Some(one)
    }

    /// What solves so many designs side by side, where that pays and can be done.
    pub(crate) fn side_by_side(&self, designs: usize, sensitivities: bool) -> Option<SideBySide<'_>> {
        let pays = designs > 1 && self.programs.pay(designs * self.model.times.len());
        // All designs must have the same laws.
        if !pays || self.goes_by_driver() || self.effects.laws_change() {
            return None;
        }
        let program = move |corrections| {
            let purpose =
                Purpose { times: false, any_design: true, corrections, sensitivities, margins: false };
            self.program(purpose)
        };
        SideBySide::new(self.started()?, Box::new(program), !sensitivities)
    }

    /// Motions of up to as many designs as there are lanes, side by side.
    pub(crate) fn solve_designs(
        &self,
        beside: &mut Option<SideBySide<'_>>,
        designs: &[Vec<f64>],
        of_many: usize,
        solutions: &mut [Solution],
    ) {
        for Solution { motion, .. } in solutions.iter_mut() {
            self.make_room(motion, 0);
        }
        let solved = beside.as_mut().filter(|_| designs.len() > 1).and_then(|beside| {
            let values: Vec<Vec<f64>> = designs.iter().map(|d| self.model.whole(d)).collect();
            let effort = beside.run(&values, |_, _| ())?;
            solutions.iter_mut().enumerate().for_each(|(lane, s)| beside.hand_over(lane, &mut s.motion));
            Some(effort)
        });
        for (design, solution) in designs.iter().zip(solutions) {
            let Some(effort) = solved else {
                let design = Design { of_many, ..self.design(design, false) };
                self.solve(&design, &mut |_| ControlFlow::Continue(()), solution);
                continue;
            };
            solution.motion.times.extend_from_slice(&self.model.times);
            solution.motion.effort = effort;
            solution.sensitivities = Sensitivities::default();
            solution.stop = None;
            if self.measures {
                let design = Design { of_many, ..self.design(design, false) };
                self.measure(&design, &SlopeValues::default(), None, solution);
            } else {
                solution.measured = Measured::default();
            }
        }
    }

    /// All designs to the end, or nothing where one of them does not go as expected.
    fn stream_side_by_side<S: Sink>(
        &self,
        beside: &mut Option<SideBySide<'_>>,
        designs: &[Vec<f64>],
        sinks: &mut [S],
    ) -> Option<(Effort, Vec<Resisting>)> {
        let beside = beside.as_mut().filter(|_| designs.len() > 1)?;
        let values: Vec<Vec<f64>> = designs.iter().map(|d| self.model.whole(d)).collect();
        let (wanted, moved) = (self.wanted(sinks), beside.moved());
        let variables = self.model.variables.len();
        let mut resisting = vec![(Vec::new(), 0.0); LANES * variables];
        let effort = beside.run(&values, |k, found| {
            let times = [self.model.times[k]; LANES];
            note_defects(
                found.tape,
                &self.topology,
                (&times[..designs.len()], 0),
                (&mut resisting, variables),
            );
            hand_over(&found.block, &wanted, moved.iter().copied(), sinks, 0..designs.len(), |lane| {
                (lane, k)
            });
        })?;
        Some((effort, resisting))
    }
}

/// The way through all output times.
pub(crate) struct Walk<'a> {
    pub one: Stepper<'a>,
    abreast: Abreast<'a>,
    /// `None` where no sensitivities are asked for.
    pub sensing: Option<Sensing>,
    /// Per body: whether its results are wanted.
    wanted: Vec<bool>,
    /// Output times solved.
    pub done: usize,
}

/// What has just been solved: one output time, or several by a program, in these of its lanes.
pub(crate) enum Solved<'w, 'a> {
    One(&'w mut Stepper<'a>),
    Abreast(&'w Tape, Range<usize>),
}

impl<'a> Walk<'a> {
    /// Step by step.
    pub fn new(analysis: &'a Analysis<'_>, design: &'a Design, wanted: Vec<bool>) -> Self {
        let (model, topology) = (analysis.model, &analysis.topology);
        let Design { geometry, laws, fields, .. } = design;
        Self {
            one: Stepper::new(model, topology, Parts::same(model, topology, geometry, laws)),
            abreast: Abreast::new(None, &[], None),
            sensing: (!fields.is_empty()).then(|| Sensing::new(model, topology, fields, wanted.clone())),
            wanted,
            done: 0,
        }
    }

    /// The same by programs, as many output times at once as there are lanes, where that can be done and pays.
    pub fn by_programs(
        analysis: &'a Analysis<'_>,
        design: &'a Design,
        wanted: Vec<bool>,
        margins: bool,
    ) -> Self {
        let mut walk = Self::new(analysis, design, wanted);
        if analysis.programs.pay(analysis.model.times.len() * design.of_many) {
            let (sensitivities, any_design) =
                (walk.sensing.is_some(), design.values.iter().any(|v| *v != 0.0));
            let moved: Vec<_> = walk.sensing.iter().flat_map(Sensing::moved).collect();
            let program = move |corrections| {
                let purpose = Purpose { times: true, any_design, corrections, sensitivities, margins };
                analysis.program(purpose).filter(|program| program.moved == moved)
            };
            let nominal = analysis.model.drivers.iter().zip(&design.laws).all(|(d, law)| d.law == *law);
            let laws = if nominal { analysis.programs.laws(analysis.model) } else { None };
            walk.abreast = Abreast::new(Some(Box::new(program)), &design.values, laws);
        }
        walk
    }

    /// To the last output time, or to what stops it, for those who take what they want from the stepper: nothing is stored.
    pub fn each(&mut self, analysis: &Analysis<'_>, mut then: impl FnMut(&mut Stepper<'a>)) -> Option<Stop> {
        let mut unused = Motion::default();
        let mut store = Store { motion: &mut unused, sensitivities: &mut Sensitivities::default() };
        self.all(analysis, &mut store, &mut |_| ControlFlow::Continue(()), |_, solved, _, _| {
            if let Solved::One(one) = solved {
                then(one);
            }
        })
    }

    /// To the last output time, or to what stops it. `then` sees what was solved, how many output times of it count, and what is known
    /// of the variables.
    pub fn all<S: Sink>(
        &mut self,
        analysis: &Analysis<'_>,
        sink: &mut S,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        mut then: impl FnMut(&mut S, Solved<'_, 'a>, usize, Option<&Sensing>),
    ) -> Option<Stop> {
        let times = &analysis.model.times;
        let total = times.len();
        let mut stop = None;
        while self.done < total && stop.is_none() {
            let k = self.done;
            let at_once = match k {
                0 => 0,
                _ => self.abreast.advance(&mut self.one, k, times, || sink.room(k)),
            };
            if at_once == 0 {
                let step = if k == 0 { self.one.start(times[k]) } else { self.one.advance(times[k]) };
                if let Err(mut s) = step {
                    if let (StopKind::DoesNotAssemble, Some(block)) = (s.kind, s.block) {
                        s.remains = self.one.least_gaps(block);
                    }
                    return Some(*s);
                }
            }
            let (mut count, solved) = (0, usize::max(at_once, 1));
            while count < solved && stop.is_none() {
                count += 1;
                let done = k + count;
                if progress(Progress { done, total }).is_break() && done < total {
                    stop = Some(analysis.interrupted(times[done - 1]));
                }
            }
            if at_once == 0 {
                let one = &mut self.one;
                for body in (1..self.wanted.len()).filter(|b| self.wanted[*b]) {
                    sink.state(k, BodyId(body), &BodyState::of(&one.state, body));
                }
                if let Some(sensing) = &mut self.sensing {
                    sensing.step(one, times[k], |variable, body, found| {
                        sink.sensitivity(k, variable, body, found)
                    });
                }
                then(sink, Solved::One(one), 1, self.sensing.as_ref());
            } else {
                let (tape, first) = (self.abreast.solved(), k % LANES);
                let lanes = first..first + count;
                if let Some(block) = self.abreast.own_results() {
                    let moved = self.sensing.iter().flat_map(Sensing::moved);
                    let sinks = std::slice::from_mut(sink);
                    hand_over(&block, &self.wanted, moved, sinks, lanes.clone(), |lane| {
                        (0, k + lane - lanes.start)
                    });
                }
                if let Some(sensing) = &mut self.sensing {
                    sensing.note(tape, &self.one.topology, &times[k..k + count], first);
                }
                then(sink, Solved::Abreast(tape, lanes), count, self.sensing.as_ref());
            }
            self.done += count;
        }
        stop
    }
}

/// Which body a name stands for, for callers that think in names.
impl Solution {
    /// State of a body at output time k.
    pub fn body(&self, k: usize, body: BodyId) -> BodyState {
        self.motion.at(k).body(body.0)
    }
}

//! The whole walk for one model: plan, motion, sensitivities, measures.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use fearless_simd::{Level, dispatch};

use crate::joint::Quantity;
use crate::law::Law;
use crate::measure::{self, Before, Measured, SlopeValues};
use crate::model::{BodyId, DesignVariable, Effects, Field, GROUND, Geometry, Model, VariableId};
use crate::motion::abreast::Abreast;
use crate::motion::parts::Parts;
use crate::motion::stepper::Stepper;
use crate::motion::tape::{ProgramOf, Programs, Purpose, StepProgram};
use crate::motion::{BodyState, Effort, Execution, Motion, Stop, StopKind};
use crate::sensitivity::{
    Admissibility, JointDefect, Sensing, SensingDesigns, Sensitivities, admissibility_at_design, along,
    record_derivatives,
};
use crate::sink::{Sink, Store};
use crate::space::{LANES, Real, lanes};
use crate::topology::{Formulation, Topology, TopologyFault};

/// A model with its plan of solution, ready to be run as often as needed.
///
/// ```
/// # use hardpoint::model::*; use hardpoint::law::Law; use hardpoint::space::Vec3;
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
}

/// Designs side by side are solved by the kernel up to this output time; then it is known how many passes they need.
const PROGRAM_FROM: usize = 4;

/// One design, ready to be analysed.
pub(crate) struct Design {
    pub values: Vec<f64>,
    geometry: Geometry,
    pub laws: Vec<Law>,
    /// How the variables change it, if that is asked for, and the joints that each opens in the nominal design.
    fields: Vec<Field>,
    pub opens: Vec<Vec<JointDefect>>,
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
        let programs = Arc::new(Programs::new(Execution::Fastest));
        Ok(Self {
            model,
            topology,
            effects: Effects::of(model),
            measures: true,
            opens: OnceLock::new(),
            programs,
        })
    }

    /// The same analysis for callers that want the bodies only: [`Solution::measured`] stays empty.
    pub fn bodies_only(self) -> Self {
        Self { measures: false, ..self }
    }

    /// The same analysis, its steps solved in this way.
    pub fn executed(self, execution: Execution) -> Self {
        Self { programs: Arc::new(Programs::new(execution)), ..self }
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
            let nominal = self.effects.fields(&self.model.whole(&[]), 0.0);
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
            geometry: self.effects.geometry(&values, 0.0),
            laws: self.effects.laws(&values),
            fields: if sensitivities { self.effects.fields(&values, 0.0) } else { Vec::new() },
            opens: if sensitivities { self.opens().to_vec() } else { Vec::new() },
            values,
        }
    }

    /// Whether and how the mechanism follows a change of the nominal design as a whole, in which variable k goes by `change[k]`:
    /// together, variables may be followed that are not one by one.
    pub fn admissibility_of(&self, change: &[f64]) -> Admissibility {
        let mut design = self.design(&[], false);
        let along = along(&self.model.whole(change));
        let field = self.effects.field_along(&along, &design.values, 0.0);
        design.opens = vec![admissibility_at_design(self.model, &field)];
        design.fields = vec![field];
        dispatch!(Level::new(), simd => {
            let mut walk = Walk::new(self, &design, vec![false; self.model.bodies.len()], lanes(simd));
            walk.each(self, |_, _| ());
            let sensing = walk.sensing.expect("there is a field");
            sensing.admissibility(&design.opens, walk.done).pop().expect("that of the one field")
        })
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
        dispatch!(Level::new(), simd => {
            let mut walk = Walk::new(self, &design, wanted, lanes(simd));
            let stop = walk.all(self, sink, &mut |_| ControlFlow::Continue(()), |_, _, _, _| ());
            let effort = walk.one.effort;
            let admissibility = walk.sensing.map_or_else(Vec::new, |s| s.admissibility(&design.opens, walk.done));
            Streamed { steps: walk.done, admissibility, effort, stop }
        })
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

    /// Empties a motion, with room for so many output times; its bodies' states are there to be overwritten.
    pub(crate) fn make_room(&self, motion: &mut Motion, steps: usize) {
        let bodies = self.model.bodies.len();
        if motion.bodies != bodies {
            motion.states.clear();
        }
        let ground = BodyState::at_design(self.model, GROUND);
        motion.states.resize(steps * bodies, ground);
        motion.bodies = bodies;
        motion.times.clear();
        motion.times.reserve(steps);
        motion.coordinates.clear();
        motion.coordinates.reserve(steps * self.topology.coordinates.len());
        motion.margins.clear();
        motion.assembly = None;
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
        solution.measured = Measured::default();
        if self.measures {
            let Design { values, laws, .. } = design;
            let at = measure::At { model: self.model, effects: &self.effects, values, laws };
            let Solution { motion, sensitivities, measured, .. } = solution;
            *measured = measure::evaluate(&at, &self.topology, motion, sensitivities, slopes, before);
        }
    }

    /// Motions of many changed designs, in the order given.
    ///
    /// Where one of those that are solved side by side stops, each of them is solved again on its own, so that every
    /// design gets its own outcome. Lanes and single runs agree to round-off (`docs/performance.md`).
    pub fn run_designs(&self, designs: &[Vec<f64>]) -> Vec<Solution> {
        let mut solutions: Vec<Solution> = designs.iter().map(|_| Solution::default()).collect();
        for (designs, solutions) in designs.chunks(LANES).zip(solutions.chunks_mut(LANES)) {
            self.solve_designs(designs, solutions);
        }
        solutions
    }

    /// As [`Analysis::run_designs`], for any number of designs in little memory: `visit` sees every design's number and its
    /// solution, which is overwritten later.
    pub fn for_each_design(&self, designs: &[Vec<f64>], mut visit: impl FnMut(usize, &Solution)) {
        let mut solutions: [Solution; LANES] = std::array::from_fn(|_| Solution::default());
        for (group, designs) in designs.chunks(LANES).enumerate() {
            self.solve_designs(designs, &mut solutions[..designs.len()]);
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
                    let groups = || Some(next.fetch_add(1, Ordering::Relaxed));
                    for group in std::iter::from_fn(groups).take_while(|g| g * LANES < designs.len()) {
                        let first = group * LANES;
                        let some = &designs[first..usize::min(first + LANES, designs.len())];
                        self.solve_designs(some, &mut solutions[..some.len()]);
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
        for (group, designs) in designs.chunks(LANES).enumerate() {
            let number = |k: usize| group * LANES + k;
            let mut sinks: Vec<S> = (0..designs.len()).map(|k| sink(number(k))).collect();
            // Output times fill the lanes of a single design.
            let solved = if designs.len() > 1 {
                dispatch!(Level::new(), simd => self.solve_designs_in(designs, &mut sinks, true, |_, _| (), lanes(simd)))
            } else {
                None
            };
            if let Some((effort, admissibility)) = solved {
                for (k, (sink, admissibility)) in sinks.into_iter().zip(admissibility).enumerate() {
                    let steps = self.model.times.len();
                    end(number(k), sink, Streamed { steps, admissibility, effort, stop: None });
                }
            } else {
                for (k, design) in designs.iter().enumerate() {
                    let mut sink = sink(number(k));
                    let streamed = self.stream_at(design, &mut sink);
                    end(number(k), sink, streamed);
                }
            }
        }
    }

    /// The step of this plan as a program with so many corrections, for any design; or with the sensitivities of the nominal one.
    fn program(&self, sensitivities: bool, corrections: usize) -> Option<Arc<StepProgram>> {
        let (model, topology) = (self.model, &self.topology);
        if !StepProgram::suits(topology) {
            return None;
        }
        self.programs.get(sensitivities, corrections, |execution| {
            let Design { geometry, laws, fields, .. } = self.design(&[], sensitivities);
            let mut one =
                Stepper::new(model, topology, Parts::same(model, topology, &geometry, &laws, 0.0), 0.0);
            one.start(*model.times.first()?).ok()?;
            let mut numbers: Vec<_> = one.parts.numbers(0.0).into_iter().map(Some).collect();
            // Lengths and parts of axes alike: a marker may be off by as much as its coordinates round.
            let same = f64::EPSILON * f64::min(model.size(), 1.0);
            if !sensitivities {
                // What other designs have otherwise is an input.
                for n in 0..OTHERS {
                    let other = self.effects.geometry(&model.whole(&elsewhere(model, n)), 0.0);
                    let other = Parts::same(model, topology, &other, &laws, 0.0).numbers(0.0);
                    for (number, other) in numbers.iter_mut().zip(other) {
                        *number = number.filter(|x| (x - other).abs() <= same);
                    }
                }
            }
            let purpose = Purpose { geometry: numbers, same, corrections };
            StepProgram::record(
                &one,
                purpose,
                |plan, state| record_derivatives(model, &fields, plan, state),
                execution,
            )
        })
    }

    /// Motions of up to as many designs as there are lanes, side by side.
    fn solve_designs(&self, designs: &[Vec<f64>], solutions: &mut [Solution]) {
        // What goes by a driver asks for more than positions, which only a single run keeps.
        let by_driver = self.measures && (0..self.model.measures.len()).any(|k| self.model.goes_by_driver(k));
        let side_by_side = designs.len() > 1
            && !by_driver
            && {
                let mut coordinates = Vec::with_capacity(designs.len());
                let mut stores = Vec::with_capacity(designs.len());
                for Solution { motion, .. } in solutions.iter_mut() {
                    self.make_room(motion, self.model.times.len());
                    coordinates.push(std::mem::take(&mut motion.coordinates));
                    stores.push(Store { motion, sensitivities: &mut [], variables: 0 });
                }
                let keep = |lane: usize, q: f64| {
                    if let Some(coordinates) = coordinates.get_mut(lane) {
                        coordinates.push(q);
                    }
                };
                let solved = dispatch!(Level::new(), simd => self.solve_designs_in(designs, &mut stores, false, keep, lanes(simd)));
                if let Some((effort, _)) = &solved {
                    for (solution, coordinates) in solutions.iter_mut().zip(coordinates) {
                        solution.motion.times.extend_from_slice(&self.model.times);
                        solution.motion.effort = *effort;
                        solution.motion.coordinates = coordinates;
                        solution.sensitivities = Sensitivities::default();
                        solution.stop = None;
                    }
                }
                solved.is_some()
            };
        for (design, solution) in designs.iter().zip(solutions) {
            if !side_by_side {
                self.solve(&self.design(design, false), &mut |_| ControlFlow::Continue(()), solution);
            } else if self.measures {
                self.measure(&self.design(design, false), &SlopeValues::default(), None, solution);
            } else {
                solution.measured = Measured::default();
            }
        }
    }

    /// All lanes to the end, or nothing where any of them stops. `coordinate` gets those of every step, lane by lane.
    fn solve_designs_in<T: Real, S: Sink>(
        &self,
        designs: &[Vec<f64>],
        sinks: &mut [S],
        sensitivities: bool,
        mut coordinate: impl FnMut(usize, f64),
        witness: T,
    ) -> Option<(Effort, Vec<Vec<Admissibility>>)> {
        let (model, last) = (self.model, designs.len() - 1);
        let values: Vec<Vec<f64>> = designs.iter().map(|d| model.whole(d)).collect();
        let geometries: Vec<Geometry> = values.iter().map(|d| self.effects.geometry(d, 0.0)).collect();
        let laws: Vec<Vec<Law>> = values.iter().map(|v| self.effects.laws(v)).collect();
        let parts = Parts::each(model, &self.topology, &geometries, &laws, witness);
        let mut stepper = Stepper::new(model, &self.topology, parts, witness);
        let wanted = self.wanted(sinks);
        let mut sensing = sensitivities.then(|| {
            let of_lane = |v: usize, k: usize| self.effects.field(VariableId(v), &values[k.min(last)], 0.0);
            let fields: Vec<Vec<Field>> =
                (0..model.variables.len()).map(|v| (0..LANES).map(|k| of_lane(v, k)).collect()).collect();
            SensingDesigns::new(model, &self.topology, &fields, wanted.clone(), witness)
        });
        let by_program = sensing.is_none() && self.programs.pay(designs.len() * model.times.len());
        for (k, &t) in model.times.iter().enumerate() {
            if k == 0 { stepper.start(t) } else { stepper.advance(t) }.ok()?;
            if by_program && (k == PROGRAM_FROM || stepper.tape_fails()) {
                stepper.use_program(stepper.corrections(), |corrections| self.program(false, corrections));
            }
            witness.within(
                #[inline(always)]
                || {
                    stepper.each_body(&wanted, |lane, body, s| {
                        if let Some(sink) = sinks.get_mut(lane) {
                            sink.state(k, body, &s);
                        }
                    });
                },
            );
            for lane in 0..designs.len() {
                stepper.state.q.iter().for_each(|q| coordinate(lane, q.lane(lane)));
            }
            if let Some(sensing) = &mut sensing {
                sensing.step(
                    &mut stepper,
                    t,
                    #[inline(always)]
                    |lane, variable, body, d| {
                        if let Some(sink) = sinks.get_mut(lane) {
                            sink.sensitivity(k, variable, body, d);
                        }
                    },
                );
            }
        }
        // Angles that only the path tells are counted by single runs.
        if self.measures && stepper.effort.substeps > 0 && !measure::watched(model, &self.topology).is_empty()
        {
            return None;
        }
        let admissibility =
            sensing.map_or_else(Vec::new, |s| s.admissibility(self.opens(), model.times.len()).collect());
        Some((stepper.effort, admissibility))
    }
}

/// So many other designs tell what depends on the design: one of them may have the same number by chance.
const OTHERS: usize = 4;

/// The n-th other design, in which every variable has changed, each by another part of what is small beside the mechanism: a number of
/// the geometry that is the same in all of them depends on none.
fn elsewhere(model: &Model, n: usize) -> Vec<f64> {
    const SMALL: f64 = 1e-3;
    let size = |v: &DesignVariable| if v.quantity == Quantity::Length { model.size() } else { 1.0 };
    // The golden ratio's multiples are spread evenly and never repeat.
    let part = |k: usize| 2.0 * ((k * OTHERS + n + 1) as f64 * 0.618_033_988_749_895).fract() - 1.0;
    model.variables.iter().enumerate().map(|(k, v)| SMALL * part(k) * size(v)).collect()
}

/// The way through all output times, where possible as many at once as there are lanes.
pub(crate) struct Walk<'a, T> {
    pub one: Stepper<'a, f64>,
    abreast: Abreast<'a, T>,
    /// `None` where no sensitivities are asked for.
    pub sensing: Option<Sensing<'a, T>>,
    /// Per body: whether its results are wanted.
    wanted: Vec<bool>,
    /// Output times solved.
    pub done: usize,
}

/// What has just been solved.
pub(crate) enum Solved<'w, 'a, T> {
    One(&'w mut Stepper<'a, f64>),
    Abreast(&'w mut Stepper<'a, T>),
}

impl<'a, T: Real> Walk<'a, T> {
    pub fn new(analysis: &'a Analysis<'_>, design: &'a Design, wanted: Vec<bool>, witness: T) -> Self {
        let (model, topology) = (analysis.model, &analysis.topology);
        let Design { geometry, laws, fields, .. } = design;
        let parts = Parts::same(model, topology, geometry, laws, witness);
        // Measures need more of a step than a program hands out; and only the nominal design has a program with sensitivities.
        let sensitive = !fields.is_empty();
        let fits = !analysis.measures && (!sensitive || design.values == model.whole(&[]));
        let programs = (fits && analysis.programs.pay(model.times.len()))
            .then(|| Box::new(move |corrections| analysis.program(sensitive, corrections)) as ProgramOf<'a>);
        Self {
            one: Stepper::new(model, topology, Parts::same(model, topology, geometry, laws, 0.0), 0.0),
            abreast: Abreast::new(model, topology, parts, programs, witness),
            sensing: (!fields.is_empty())
                .then(|| Sensing::new(model, topology, fields, wanted.clone(), witness)),
            wanted,
            done: 0,
        }
    }

    /// To the last output time, or to what stops it, for those who take what they want from the steppers: nothing is stored.
    pub fn each(
        &mut self,
        analysis: &Analysis<'_>,
        mut then: impl FnMut(Solved<'_, 'a, T>, usize),
    ) -> Option<Stop> {
        let mut unused = Motion::default();
        let mut store = Store { motion: &mut unused, sensitivities: &mut [], variables: 0 };
        self.all(analysis, &mut store, &mut |_| ControlFlow::Continue(()), |_, solved, count, _| {
            then(solved, count)
        })
    }

    /// To the last output time, or to what stops it. `then` sees what was solved, how many of it count, and what is known of
    /// the variables.
    pub fn all<S: Sink>(
        &mut self,
        analysis: &Analysis<'_>,
        sink: &mut S,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        mut then: impl FnMut(&mut S, Solved<'_, 'a, T>, usize, Option<&Sensing<'a, T>>),
    ) -> Option<Stop> {
        let (times, witness) = (&analysis.model.times, self.abreast.stepper.state.witness);
        let total = times.len();
        let mut stop = None;
        while self.done < total && stop.is_none() {
            let k = self.done;
            let at_once = if k == 0 { 0 } else { self.abreast.advance(&mut self.one, &times[k..]) };
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
                BodyState::each(&one.state, &self.wanted, |_, body, s| sink.state(k, body, &s));
                if let Some(sensing) = &mut self.sensing {
                    sensing.step(one, k, times[k], sink);
                }
                then(sink, Solved::One(one), 1, self.sensing.as_ref());
            } else {
                let all = &mut self.abreast.stepper;
                witness.within(
                    #[inline(always)]
                    || {
                        all.each_body(&self.wanted, |lane, body, s| {
                            if lane < count {
                                sink.state(k + lane, body, &s);
                            }
                        });
                    },
                );
                if let Some(sensing) = &mut self.sensing {
                    sensing.steps(all, k, &times[k..k + solved], count, sink);
                }
                then(sink, Solved::Abreast(all), count, self.sensing.as_ref());
            }
            self.done += count;
        }
        stop
    }
}

/// Which body a name stands for, for callers that think in names.
impl Solution {
    /// State of a body at output time k.
    pub fn body(&self, k: usize, body: BodyId) -> &BodyState {
        &self.motion.at(k)[body.0]
    }
}

//! The whole walk for one model: plan, motion, sensitivities, measures.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use fearless_simd::{Level, dispatch};

use crate::measure::{self, Measured};
use crate::model::{BodyId, Field, GROUND, Geometry, Model, VariableId};
use crate::motion::abreast::Abreast;
use crate::motion::margin::Margins;
use crate::motion::parts::Parts;
use crate::motion::stepper::Stepper;
use crate::motion::{BodyState, Effort, Motion, Stop, StopKind};
use crate::sensitivity::{Admissibility, Sensing, Sensitivities};
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
    measures: bool,
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
        Ok(Self { model, topology: Topology::of(model, formulation)?, measures: true })
    }

    /// The same analysis for callers that want the bodies only: [`Solution::measured`] stays empty.
    pub fn bodies_only(self) -> Self {
        Self { measures: false, ..self }
    }

    /// The plan.
    pub fn topology(&self) -> &Topology {
        &self.topology
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
        self.solve(&self.model.geometry(&[]), &self.all_fields(), &mut progress, &mut solution);
        solution
    }

    /// As [`Analysis::run`], into the memory of a former solution.
    pub fn run_into(&self, solution: &mut Solution) {
        self.solve(
            &self.model.geometry(&[]),
            &self.all_fields(),
            &mut |_| ControlFlow::Continue(()),
            solution,
        );
    }

    /// Solves the motion only, without any sensitivity.
    pub fn run_motion(&self) -> Solution {
        self.run_design(&[])
    }

    /// As [`Analysis::run_motion`], into the memory of a former solution.
    pub fn run_motion_into(&self, solution: &mut Solution) {
        self.solve(&self.model.geometry(&[]), &[], &mut |_| ControlFlow::Continue(()), solution);
    }

    /// Solves the motion of the changed design with variable k at `design[k]`, exactly.
    pub fn run_design(&self, design: &[f64]) -> Solution {
        let mut solution = Solution::default();
        self.solve(&self.model.geometry(design), &[], &mut |_| ControlFlow::Continue(()), &mut solution);
        solution
    }

    /// How all variables change the design.
    fn all_fields(&self) -> Vec<Field> {
        (0..self.model.variables.len()).map(|v| self.model.field(VariableId(v))).collect()
    }

    /// As [`Analysis::run`], but nothing is stored: the sink takes every result as it is found.
    ///
    /// What 10,000 loops and 1,000 variables give need not fit into memory; measures are not evaluated.
    pub fn stream(&self, sink: &mut impl Sink) -> Streamed {
        let (geometry, fields) = (self.model.geometry(&[]), self.all_fields());
        let wanted: Vec<bool> = (0..self.model.bodies.len()).map(|b| sink.wants(BodyId(b))).collect();
        dispatch!(Level::new(), simd => {
            let mut walk = Walk::new(self, &geometry, &fields, wanted, lanes(simd));
            let stop = walk.all(self, sink, &mut |_| ControlFlow::Continue(()), |_, _, _| ());
            let effort = walk.one.effort;
            let admissibility = walk.sensing.map_or_else(Vec::new, |s| s.admissibility(walk.done));
            Streamed { steps: walk.done, admissibility, effort, stop }
        })
    }

    fn solve(
        &self,
        geometry: &Geometry,
        fields: &[Field],
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
    ) {
        dispatch!(Level::new(), simd => self.solve_in(geometry, fields, progress, solution, lanes(simd)));
        solution.measured = self.measure(geometry, fields, &solution.motion, &solution.sensitivities);
    }

    fn solve_in<T: Real>(
        &self,
        geometry: &Geometry,
        fields: &[Field],
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
        witness: T,
    ) {
        let mut walk = Walk::new(self, geometry, fields, vec![true; self.model.bodies.len()], witness);
        let room = std::mem::take(&mut solution.sensitivities);
        let mut sensitivities = match &walk.sensing {
            Some(sensing) => sensing.room(self.model.times.len(), room),
            None => Sensitivities::default(),
        };
        self.make_room(&mut solution.motion);
        let variables = fields.len();
        let mut store =
            Store { motion: &mut solution.motion, sensitivities: &mut sensitivities.states, variables };
        let mut margins = (Margins::new(&self.topology, 0.0), Margins::new(&self.topology, witness));
        solution.stop = walk.all(self, &mut store, progress, |store, solved, count| match solved {
            Solved::One(one) => {
                store.motion.coordinates.extend(one.coordinates());
                if self.measures {
                    store.motion.margins.push(margins.0.at(&one.topology, &one.state)[0]);
                }
            }
            Solved::Abreast(all) => {
                for lane in 0..count {
                    store.motion.coordinates.extend(all.state.q.iter().map(|q| q.lane(lane)));
                }
                if self.measures {
                    let margins = margins.1.at(&all.topology, &all.state);
                    store.motion.margins.extend_from_slice(&margins[..count]);
                }
            }
        });
        let (steps, motion) = (walk.done, &mut solution.motion);
        motion.times.extend_from_slice(&self.model.times[..steps]);
        motion.states.truncate(steps * motion.bodies);
        motion.effort = walk.one.effort;
        motion.assembly = walk.one.assembly.take();
        sensitivities.states.truncate(steps * variables * motion.bodies);
        sensitivities.admissibility = walk.sensing.map_or_else(Vec::new, |s| s.admissibility(steps));
        solution.sensitivities = sensitivities;
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

    /// Empties a motion, with room for all output times; its bodies' states are there to be overwritten.
    fn make_room(&self, motion: &mut Motion) {
        let (steps, bodies) = (self.model.times.len(), self.model.bodies.len());
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
    }

    fn measure(
        &self,
        geometry: &Geometry,
        fields: &[Field],
        motion: &Motion,
        sensitivities: &Sensitivities,
    ) -> Measured {
        if !self.measures {
            return Measured::default();
        }
        measure::evaluate(self.model, &self.topology, geometry, fields, motion, sensitivities)
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

    /// Up to as many designs as there are lanes, side by side.
    fn solve_designs(&self, designs: &[Vec<f64>], solutions: &mut [Solution]) {
        let geometries: Vec<Geometry> = designs.iter().map(|d| self.model.geometry(d)).collect();
        // Output times fill the lanes of a single design.
        let solved = designs.len() > 1
            && dispatch!(Level::new(), simd => self.solve_designs_in(&geometries, solutions, lanes(simd)));
        for (geometry, solution) in geometries.iter().zip(solutions) {
            if solved {
                solution.sensitivities = Sensitivities::default();
                solution.measured = self.measure(geometry, &[], &solution.motion, &solution.sensitivities);
                solution.stop = None;
            } else {
                self.solve(geometry, &[], &mut |_| ControlFlow::Continue(()), solution);
            }
        }
    }

    /// All lanes to the end, or false where any of them stops.
    fn solve_designs_in<T: Real>(
        &self,
        geometries: &[Geometry],
        solutions: &mut [Solution],
        witness: T,
    ) -> bool {
        let model = self.model;
        let parts = Parts::new(model, &self.topology, geometries, witness);
        let mut stepper = Stepper::new(model, &self.topology, parts, witness);
        let bodies = model.bodies.len();
        let wanted = vec![true; bodies];
        for solution in solutions.iter_mut() {
            self.make_room(&mut solution.motion);
        }
        for (k, &t) in model.times.iter().enumerate() {
            if if k == 0 { stepper.start(t) } else { stepper.advance(t) }.is_err() {
                return false;
            }
            witness.within(
                #[inline(always)]
                || {
                    BodyState::each(&stepper.state, &wanted, |lane, body, s| {
                        if let Some(solution) = solutions.get_mut(lane) {
                            solution.motion.states[k * bodies + body.0] = s;
                        }
                    });
                },
            );
            for (lane, Solution { motion, .. }) in solutions.iter_mut().enumerate() {
                motion.times.push(t);
                motion.coordinates.extend(stepper.state.q.iter().map(|q| q.lane(lane)));
            }
        }
        for solution in solutions {
            solution.motion.effort = stepper.effort;
        }
        true
    }
}

/// The way through all output times, where possible as many at once as there are lanes.
struct Walk<'a, T> {
    one: Stepper<'a, f64>,
    abreast: Abreast<'a, T>,
    /// `None` where no sensitivities are asked for.
    sensing: Option<Sensing<'a, T>>,
    /// Per body: whether its results are wanted.
    wanted: Vec<bool>,
    /// Output times solved.
    done: usize,
}

/// What has just been solved.
enum Solved<'w, 'a, T> {
    One(&'w Stepper<'a, f64>),
    Abreast(&'w Stepper<'a, T>),
}

impl<'a, T: Real> Walk<'a, T> {
    fn new(
        analysis: &'a Analysis<'_>,
        geometry: &Geometry,
        fields: &'a [Field],
        wanted: Vec<bool>,
        witness: T,
    ) -> Self {
        let (model, topology) = (analysis.model, &analysis.topology);
        let designs = std::slice::from_ref(geometry);
        let parts = Parts::new(model, topology, designs, witness);
        Self {
            one: Stepper::new(model, topology, Parts::new(model, topology, designs, 0.0), 0.0),
            abreast: Abreast::new(model, topology, parts, witness),
            sensing: (!fields.is_empty())
                .then(|| Sensing::new(model, topology, fields, wanted.clone(), witness)),
            wanted,
            done: 0,
        }
    }

    /// To the last output time, or to what stops it. `then` sees what was solved, and how many of it count.
    fn all<S: Sink>(
        &mut self,
        analysis: &Analysis<'_>,
        sink: &mut S,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        mut then: impl FnMut(&mut S, Solved<'_, 'a, T>, usize),
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
                    sensing.step(&one.topology, &mut one.state, k, times[k], sink);
                }
                then(sink, Solved::One(one), 1);
            } else {
                let all = &mut self.abreast.stepper;
                witness.within(
                    #[inline(always)]
                    || {
                        BodyState::each(&all.state, &self.wanted, |lane, body, s| {
                            if lane < count {
                                sink.state(k + lane, body, &s);
                            }
                        });
                    },
                );
                if let Some(sensing) = &mut self.sensing {
                    sensing.steps(&all.topology, &mut all.state, k, &times[k..k + solved], count, sink);
                }
                then(sink, Solved::Abreast(all), count);
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

//! The whole walk for one model: plan, motion, sensitivities, measures.

use std::ops::ControlFlow;

use fearless_simd::{Level, dispatch};

use crate::measure::{self, Measured};
use crate::model::{BodyId, Field, GROUND, Geometry, Model, VariableId};
use crate::motion::abreast::Abreast;
use crate::motion::margin::Margins;
use crate::motion::parts::Parts;
use crate::motion::stepper::Stepper;
use crate::motion::{BodyState, Motion, Stop, StopKind};
use crate::sensitivity::{Sensing, Sensitivities};
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
    pub fn run_with(&self, progress: impl FnMut(Progress) -> ControlFlow<()>) -> Solution {
        let mut solution = Solution::default();
        self.solve(&self.model.geometry(&[]), &self.all_fields(), progress, &mut solution);
        solution
    }

    /// As [`Analysis::run`], into the memory of a former solution.
    pub fn run_into(&self, solution: &mut Solution) {
        self.solve(&self.model.geometry(&[]), &self.all_fields(), |_| ControlFlow::Continue(()), solution);
    }

    /// Solves the motion only, without any sensitivity.
    pub fn run_motion(&self) -> Solution {
        self.run_design(&[])
    }

    /// As [`Analysis::run_motion`], into the memory of a former solution.
    pub fn run_motion_into(&self, solution: &mut Solution) {
        self.solve(&self.model.geometry(&[]), &[], |_| ControlFlow::Continue(()), solution);
    }

    /// Solves the motion of the changed design with variable k at `design[k]`, exactly.
    pub fn run_design(&self, design: &[f64]) -> Solution {
        let mut solution = Solution::default();
        self.solve(&self.model.geometry(design), &[], |_| ControlFlow::Continue(()), &mut solution);
        solution
    }

    /// How all variables change the design.
    fn all_fields(&self) -> Vec<Field> {
        (0..self.model.variables.len()).map(|v| self.model.field(VariableId(v))).collect()
    }

    fn solve(
        &self,
        geometry: &Geometry,
        fields: &[Field],
        progress: impl FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
    ) {
        dispatch!(Level::new(), simd => self.solve_in(geometry, fields, progress, solution, lanes(simd)));
    }

    /// Walks through the output times, where possible as many at once as there are lanes.
    fn solve_in<T: Real>(
        &self,
        geometry: &Geometry,
        fields: &[Field],
        mut progress: impl FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
        witness: T,
    ) {
        let (model, times) = (self.model, &self.model.times);
        let (bodies, total) = (model.bodies.len(), times.len());
        let room = std::mem::take(&mut solution.sensitivities);
        let mut sensing = Sensing::new(model, &self.topology, fields, total, room, witness);
        let motion = &mut solution.motion;
        self.make_room(motion);
        let designs = std::slice::from_ref(geometry);
        let mut one =
            Stepper::new(model, &self.topology, Parts::new(model, &self.topology, designs, 0.0), 0.0);
        let parts = Parts::new(model, &self.topology, designs, witness);
        let mut abreast = Abreast::new(model, &self.topology, parts, witness);
        let mut margins = (Margins::new(&self.topology, 0.0), Margins::new(&self.topology, witness));
        let mut stop = None;
        let mut k = 0;
        while k < total && stop.is_none() {
            let at_once = if k == 0 { 0 } else { abreast.advance(&mut one, &times[k..]) };
            if at_once == 0 {
                let step = if k == 0 { one.start(times[k]) } else { one.advance(times[k]) };
                if let Err(mut s) = step {
                    if let (StopKind::DoesNotAssemble, Some(block)) = (s.kind, s.block) {
                        s.remains = one.least_gaps(block);
                    }
                    stop = Some(*s);
                    break;
                }
            }
            let (mut count, solved) = (0, usize::max(at_once, 1));
            while count < solved && stop.is_none() {
                count += 1;
                let done = k + count;
                if progress(Progress { done, total }).is_break() && done < total {
                    stop = Some(self.interrupted(times[done - 1]));
                }
            }
            let states = &mut motion.states[k * bodies..(k + count) * bodies];
            let to = |lane: usize, body: usize, s: BodyState| {
                if let Some(to) = states.get_mut(lane * bodies + body) {
                    *to = s;
                }
            };
            if at_once == 0 {
                BodyState::each(&one.state, to);
                motion.coordinates.extend(one.coordinates());
                if self.measures {
                    motion.margins.push(margins.0.at(&one.topology, &one.state)[0]);
                }
                sensing.step(&one.topology, &mut one.state, k, times[k]);
            } else {
                let all = &mut abreast.stepper;
                witness.within(
                    #[inline(always)]
                    || BodyState::each(&all.state, to),
                );
                for lane in 0..count {
                    motion.coordinates.extend(all.state.q.iter().map(|q| q.lane(lane)));
                }
                if self.measures {
                    let margins = margins.1.at(&all.topology, &all.state);
                    motion.margins.extend_from_slice(&margins[..count]);
                }
                sensing.steps(&all.topology, &mut all.state, k, &times[k..k + solved], count);
            }
            k += count;
        }
        motion.times.extend_from_slice(&times[..k]);
        motion.states.truncate(k * bodies);
        motion.effort = one.effort;
        motion.assembly = one.assembly;
        solution.sensitivities = sensing.finish(k);
        solution.measured = self.measure(geometry, fields, &solution.motion, &solution.sensitivities);
        solution.stop = stop;
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
                self.solve(geometry, &[], |_| ControlFlow::Continue(()), solution);
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
                    BodyState::each(&stepper.state, |lane, body, s| {
                        if let Some(solution) = solutions.get_mut(lane) {
                            solution.motion.states[k * bodies + body] = s;
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

/// Which body a name stands for, for callers that think in names.
impl Solution {
    /// State of a body at output time k.
    pub fn body(&self, k: usize, body: BodyId) -> &BodyState {
        &self.motion.at(k)[body.0]
    }
}

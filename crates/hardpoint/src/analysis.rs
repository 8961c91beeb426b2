//! The whole walk for one model: plan, motion, sensitivities, measures.

use std::ops::ControlFlow;

use fearless_simd::{Level, dispatch};

use crate::measure::{self, Measured};
use crate::model::{BodyId, Field, Geometry, Model, VariableId};
use crate::motion::margin::Margins;
use crate::motion::parts::Parts;
use crate::motion::stepper::Stepper;
use crate::motion::{BodyState, Effort, Motion, Stop, StopKind};
use crate::sensitivity::{Sensitivities, sensing};
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
#[derive(Clone, Debug)]
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
        let variables: Vec<VariableId> = (0..self.model.variables.len()).map(VariableId).collect();
        self.solve(&self.model.geometry(&[]), &variables, progress)
    }

    /// Solves the motion only, without any sensitivity.
    pub fn run_motion(&self) -> Solution {
        self.solve(&self.model.geometry(&[]), &[], |_| ControlFlow::Continue(()))
    }

    /// Solves the motion of the changed design with variable k at `design[k]`, exactly.
    pub fn run_design(&self, design: &[f64]) -> Solution {
        self.solve(&self.model.geometry(design), &[], |_| ControlFlow::Continue(()))
    }

    fn solve(
        &self,
        geometry: &Geometry,
        variables: &[VariableId],
        mut progress: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Solution {
        let (model, times) = (self.model, &self.model.times);
        let fields: Vec<Field> = variables.iter().map(|v| model.field(*v)).collect();
        let mut sensing = sensing(model, &self.topology, &fields, times.len());
        let mut motion = self.empty_motion();
        let parts = Parts::new(model, &self.topology, std::slice::from_ref(geometry), 0.0);
        let mut stepper = Stepper::new(model, &self.topology, parts, 0.0);
        let mut margins = Margins::new(&self.topology);
        let mut stop = None;
        for (k, &t) in times.iter().enumerate() {
            let step = if k == 0 { stepper.start(t) } else { stepper.advance(t) };
            if let Err(mut s) = step {
                if let (StopKind::DoesNotAssemble, Some(block)) = (s.kind, s.block) {
                    s.remains = stepper.least_gaps(block);
                }
                stop = Some(*s);
                break;
            }
            motion.times.push(t);
            for b in 0..motion.bodies {
                BodyState::each_lane(&stepper.state, b, 1, |_, s| motion.states.push(s));
            }
            motion.coordinates.extend(stepper.coordinates());
            if self.measures {
                motion.margins.push(margins.at(&stepper.topology, &stepper.state));
            }
            sensing.step(&stepper.topology, &mut stepper.state, t);
            if progress(Progress { done: k + 1, total: times.len() }).is_break() && k + 1 < times.len() {
                stop = Some(Stop {
                    kind: StopKind::Interrupted,
                    last_time: Some(t),
                    failed_time: t,
                    drivers: model.drivers.iter().map(|d| d.law.at(t).value()).collect(),
                    block: None,
                    pivot_ratio: 1.0,
                    joints: Vec::new(),
                    remains: Vec::new(),
                    closed: None,
                });
                break;
            }
        }
        motion.effort = stepper.effort;
        motion.assembly = stepper.assembly;
        let sensitivities = sensing.finish();
        let measured = self.measure(geometry, &fields, &motion, &sensitivities);
        Solution { motion, sensitivities, measured, stop }
    }

    /// A motion with room for all output times.
    fn empty_motion(&self) -> Motion {
        let (steps, bodies) = (self.model.times.len(), self.model.bodies.len());
        Motion {
            times: Vec::with_capacity(steps),
            states: Vec::with_capacity(steps * bodies),
            bodies,
            coordinates: Vec::with_capacity(steps * self.topology.coordinates.len()),
            margins: Vec::new(),
            assembly: None,
            effort: Effort::default(),
        }
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

    /// Motions of many changed designs, eight at a time in SIMD lanes, in the order given.
    ///
    /// Where one of eight stops, each of the eight is solved again on its own, so that every design gets
    /// its own outcome. Lanes and single runs agree to round-off (`docs/performance.md`).
    pub fn run_designs(&self, designs: &[Vec<f64>]) -> Vec<Solution> {
        let mut solutions = Vec::with_capacity(designs.len());
        for group in designs.chunks(LANES) {
            let geometries: Vec<Geometry> = group.iter().map(|d| self.model.geometry(d)).collect();
            let motions = if group.len() == 1 { None } else { self.motions_in_lanes(&geometries) };
            match motions {
                Some(motions) => {
                    for (motion, geometry) in motions.into_iter().zip(&geometries) {
                        let none = Sensitivities::default();
                        let measured = self.measure(geometry, &[], &motion, &none);
                        solutions.push(Solution { motion, sensitivities: none, measured, stop: None });
                    }
                }
                None => solutions
                    .extend(geometries.iter().map(|g| self.solve(g, &[], |_| ControlFlow::Continue(())))),
            }
        }
        solutions
    }

    /// All lanes to the end, or `None` where any of them stops.
    fn motions_in_lanes(&self, geometries: &[Geometry]) -> Option<Vec<Motion>> {
        dispatch!(Level::new(), simd => self.motions_of(geometries, lanes(simd)))
    }

    fn motions_of<T: Real>(&self, geometries: &[Geometry], witness: T) -> Option<Vec<Motion>> {
        let model = self.model;
        let parts = Parts::new(model, &self.topology, geometries, witness);
        let mut stepper = Stepper::new(model, &self.topology, parts, witness);
        let bodies = model.bodies.len();
        let mut motions: Vec<Motion> = geometries.iter().map(|_| self.empty_motion()).collect();
        for (k, &t) in model.times.iter().enumerate() {
            if k == 0 { stepper.start(t) } else { stepper.advance(t) }.ok()?;
            for b in 0..bodies {
                let states = &mut motions;
                BodyState::each_lane(&stepper.state, b, geometries.len(), |lane, s| {
                    states[lane].states.push(s)
                });
            }
            for (lane, motion) in motions.iter_mut().enumerate() {
                motion.times.push(t);
                motion.coordinates.extend(stepper.state.q.iter().map(|q| q.lane(lane)));
            }
        }
        for motion in &mut motions {
            motion.effort = stepper.effort;
        }
        Some(motions)
    }
}

/// Which body a name stands for, for callers that think in names.
impl Solution {
    /// State of a body at output time k.
    pub fn body(&self, k: usize, body: BodyId) -> &BodyState {
        &self.motion.at(k)[body.0]
    }
}

//! The whole walk for one model: plan, motion, sensitivities, measures.

use std::ops::ControlFlow;

use fearless_simd::{Level, dispatch};

use crate::measure::{self, Measured};
use crate::model::{BodyId, Field, Geometry, Model, VariableId};
use crate::motion::kinematics::State;
use crate::motion::parts::Parts;
use crate::motion::stepper::Stepper;
use crate::motion::{BodyState, Motion, Stop, StopKind};
use crate::sensitivity::{
    Admissibility, BodySensitivity, Direct, FieldParts, JointDefect, Sensitivities, admissibility_at_design,
};
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
///         axis2: None, cut: false,
///     }],
///     drivers: vec![DriverDraft {
///         name: "motor".into(), joint: "pivot".into(), coordinate: None, law: Law::parse("2*pi*t").unwrap(),
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
        let mut sensing = Sensing::new(model, &self.topology, &fields, times.len());
        let mut motion = Motion { bodies: model.bodies.len(), ..Motion::default() };
        motion.times.reserve_exact(times.len());
        motion.states.reserve_exact(times.len() * motion.bodies);
        motion.coordinates.reserve_exact(times.len() * self.topology.coordinates.len());
        let parts = Parts::new(model, &self.topology, std::slice::from_ref(geometry), 0.0);
        let mut stepper = Stepper::new(model, &self.topology, parts, 0.0);
        let mut stop = None;
        for (k, &t) in times.iter().enumerate() {
            let step = if k == 0 { stepper.start(t) } else { stepper.advance(t) };
            if let Err(s) = step {
                stop = Some(s);
                break;
            }
            motion.times.push(t);
            motion.states.extend((0..motion.bodies).map(|b| BodyState::of_lane(&stepper.state, b, 0)));
            motion.coordinates.extend(stepper.coordinates());
            sensing.step(&stepper.topology, &mut stepper.state, t);
            if progress(Progress { done: k + 1, total: times.len() }).is_break() && k + 1 < times.len() {
                stop = Some(Stop {
                    kind: StopKind::Interrupted,
                    last_time: Some(t),
                    failed_time: t,
                    drivers: model.drivers.iter().map(|d| d.law.at(t).value()).collect(),
                    pivot_ratio: 1.0,
                    joints: Vec::new(),
                });
                break;
            }
        }
        motion.effort = stepper.effort;
        let sensitivities = sensing.finish(motion.is_empty());
        let measured = self.measure(geometry, &fields, &motion, &sensitivities);
        Solution { motion, sensitivities, measured, stop }
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
        let empty = Motion { bodies, ..Motion::default() };
        let mut motions = vec![empty; geometries.len()];
        for (k, &t) in model.times.iter().enumerate() {
            if k == 0 { stepper.start(t) } else { stepper.advance(t) }.ok()?;
            for (lane, motion) in motions.iter_mut().enumerate() {
                motion.times.push(t);
                motion.states.extend((0..bodies).map(|b| BodyState::of_lane(&stepper.state, b, lane)));
                motion.coordinates.extend(stepper.state.q.iter().map(|q| q.lane(lane)));
            }
        }
        for motion in &mut motions {
            motion.effort = stepper.effort;
        }
        Some(motions)
    }
}

/// Sensitivities of all variables, step after step.
struct Sensing<'f> {
    fields: &'f [Field],
    parts: Vec<FieldParts>,
    direct: Direct<f64>,
    out: Sensitivities,
    /// Per variable: the joints that resist, and the time of the largest defect.
    resisting: Vec<(Vec<JointDefect>, f64)>,
    model: &'f Model,
}

impl<'f> Sensing<'f> {
    fn new(model: &'f Model, topology: &Topology, fields: &'f [Field], steps: usize) -> Self {
        let bodies = model.bodies.len();
        let mut out = Sensitivities { variables: fields.len(), bodies, ..Sensitivities::default() };
        out.states.reserve_exact(steps * fields.len() * bodies);
        Self {
            fields,
            parts: fields.iter().map(|f| FieldParts::new(model, topology, f)).collect(),
            direct: Direct::new(model, topology, 0.0),
            out,
            resisting: vec![(Vec::new(), 0.0); fields.len()],
            model,
        }
    }

    fn step(&mut self, topology: &Topology, state: &mut State<f64>, t: f64) {
        if self.fields.is_empty() {
            return;
        }
        state.finish_rates(topology);
        for b in 0..self.fields.len() {
            self.direct.solve(topology, state, &self.parts[b]);
            for body in 0..self.model.bodies.len() {
                let w = [0, 1, 2].map(|order| self.direct.w[order][body]);
                let s = BodySensitivity::from_twists(w, state.pose[body], state.v[body], state.a[body]);
                self.out.states.push(s);
            }
            if let Some(defect) = self.direct.worst_defect(topology, state, &self.parts[b]) {
                let place = topology.rows[defect.row];
                let closure = &topology.closures[place.closure];
                let (joints, time) = &mut self.resisting[b];
                // A periodic motion comes back to its largest defect: the first time counts, not round-off.
                if joints.iter().all(|j| defect.value > j.value * (1.0 + 1e-9)) {
                    *time = t;
                }
                match joints.iter_mut().find(|j| j.joint == closure.joint) {
                    Some(j) if defect.value > j.value => {
                        (j.row, j.value) = (closure.rows[place.index], defect.value);
                    }
                    Some(_) => {}
                    None => joints.push(JointDefect {
                        joint: closure.joint,
                        row: closure.rows[place.index],
                        value: defect.value,
                    }),
                }
            }
        }
    }

    fn finish(mut self, nothing_solved: bool) -> Sensitivities {
        self.out.admissibility = self
            .fields
            .iter()
            .zip(self.resisting)
            .map(|(field, (joints, time))| {
                let open = admissibility_at_design(self.model, field);
                if !joints.is_empty() {
                    Admissibility::CannotFollow { joints, time }
                } else if nothing_solved {
                    Admissibility::Unknown
                } else if open.is_empty() {
                    Admissibility::Admissible
                } else {
                    Admissibility::Reassembled { joints: open }
                }
            })
            .collect();
        self.out
    }
}

/// Which body a name stands for, for callers that think in names.
impl Solution {
    /// State of a body at output time k.
    pub fn body(&self, k: usize, body: BodyId) -> &BodyState {
        &self.motion.at(k)[body.0]
    }
}

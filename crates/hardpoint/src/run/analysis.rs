//! A model with its solution plan, and the methods that run it.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use crate::design::{DesignMap, DesignVelocity};
use crate::equilibrium::{OpenPosition, Released, release, release_at};
use crate::law::Law;
use crate::load::{self, RecordedLoads};
use crate::measure::{self, MeasureFormulas, MeasureResults, Slopes, StepValues};
use crate::model::{
    BodyId, ChangePointPolicy, Driver, DriverId, JointLimit, MeasureKind, Model, SharedModel, StartPlacement,
};
use crate::motion::advance;
use crate::motion::execution::{Cache, Runnable};
use crate::motion::parts::PlanGeometry;
use crate::motion::start;
use crate::motion::step_program::{Programs, Purpose, RecordedExtras, RecordedStep, StepProgram};
use crate::motion::stepper::Stepper;
use crate::motion::{BodyState, DrivenStep, Execution, Motion, StepMethod, Stop, StopKind};
use crate::number::record as recording;
use crate::sensitivity::{Admissibility, JointDefect, admissibility_at_design, along, record_derivatives};
use crate::topology::{Formulation, Topology, TopologyError, TreeRow};

use super::needed::NeededResults;
use super::request::{Run, Scope};
use super::sink::Sink;
use super::solution::{Solution, StreamSummary};
use super::walk::{Continuations, PreparedDesign, Walk};

/// Reason why steps at equilibrium are solved by the kernel.
const AT_EQUILIBRIUM: &str = "its elastic joints are in equilibrium";

/// A model with equilibrium, whose elastic joints are open in the model that is solved.
#[derive(Debug)]
struct OpenModel {
    user: Model,
    openings: Vec<DriverId>,
    /// Per opening: the force that it needs as a driver.
    kinds: Vec<MeasureKind>,
    /// The model with every opening driven, of which the constraints determine some.
    every_opening: Model,
}

impl OpenModel {
    fn new(user: &Model, openings: Vec<DriverId>, every_opening: Model) -> Self {
        let kinds = openings.iter().map(|d| MeasureKind::DriverForce { driver: *d }).collect();
        Self { user: user.clone(), openings, kinds, every_opening }
    }
}

/// A model with its solution plan, ready to be run any number of times.
///
/// ```
/// # use hardpoint::{Analysis, draft::Draft, law::Law, model::Model};
/// // A crank of 0.2 m that turns once per second.
/// let draft = Draft::new("crank")
///     .body("crank")
///     .revolute("pivot", ["ground", "crank"], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0])
///     .driver("motor", "pivot", Law::parse("2*pi*t").unwrap())
///     .point("tip", "crank", [0.2, 0.0, 0.0])
///     .times([0.0, 0.25]);
/// let model = Model::from_draft(&draft).unwrap();
/// let solution = Analysis::new(&model).unwrap().run();
/// let tip_y = solution.measured.index("tip.y").unwrap();
/// let [y, speed, acceleration] = solution.measured.value(1, tip_y);
/// assert!((y - 0.2).abs() < 1e-12);
/// assert!(speed.abs() < 1e-12);
/// assert!((acceleration + 0.2 * (2.0 * std::f64::consts::PI).powi(2)).abs() < 1e-11);
/// ```
#[derive(Clone, Debug)]
pub struct Analysis<'m> {
    topology: Topology,
    /// Geometry of the solved model as a function of the design; owns the model.
    design_map: DesignMap<'m>,
    /// The user's model and the openings of the solved one, if its elastic joints are open.
    equilibrium: Option<Arc<OpenModel>>,
    /// Per variable, the joints that it opens in the nominal design; computed on first use.
    opens: Arc<OnceLock<Vec<Vec<JointDefect>>>>,
    /// Output times, and the times between them that metrics need; computed on first use.
    pub(super) between: Arc<OnceLock<Vec<f64>>>,
    /// Programs of steps, recorded when this saves time.
    programs: Arc<Programs>,
    /// Programs of measures.
    formulas: Arc<Cache<measure::ProgramKey, measure::MeasureProgram>>,
    /// Reason why measures need the kernel, if they do; computed on first use.
    kernel: Arc<OnceLock<Option<&'static str>>>,
    /// Once set, all runs end at their next output time.
    end: Option<Arc<AtomicBool>>,
}

impl<'m> Analysis<'m> {
    /// Plans the solution of a model in relative coordinates.
    ///
    /// # Errors
    /// Returns a [`TopologyError`] if the drivers leave degrees of freedom or contradict the joints.
    pub fn new(model: impl Into<SharedModel<'m>>) -> Result<Self, TopologyError> {
        Self::with(model, Formulation::Relative)
    }

    /// Plans the solution of a model in the requested formulation.
    ///
    /// # Errors
    /// See [`Analysis::new`].
    pub fn with(model: impl Into<SharedModel<'m>>, formulation: Formulation) -> Result<Self, TopologyError> {
        let model = model.into();
        let (topology, design_map, equilibrium) = if model.equilibrium.is_some() {
            let (Released { model: open, openings, every_opening }, topology) = release(&model, formulation)?;
            let equilibrium = OpenModel::new(&model, openings, every_opening);
            (topology, DesignMap::of(Arc::new(open)), Some(Arc::new(equilibrium)))
        } else {
            (Topology::of(&model, formulation)?, DesignMap::of(model), None)
        };
        let start = start::start_coordinates(design_map.model(), &topology);
        let topology = Topology { start, ..topology };
        let programs = Arc::new(Programs::new(Execution::default()));
        Ok(Self {
            topology,
            design_map,
            equilibrium,
            opens: Arc::default(),
            between: Arc::default(),
            programs,
            formulas: Arc::default(),
            kernel: Arc::default(),
            end: None,
        })
    }

    /// Sets the execution of steps: by the kernel or by programs.
    pub fn executed(self, execution: Execution) -> Self {
        Self { programs: Arc::new(Programs::new(execution)), formulas: Arc::default(), ..self }
    }

    /// Makes the analysis interruptible: once the flag is set, every run on any thread ends at its next output time.
    /// Its stop is then [`Interrupted`](StopKind::Interrupted).
    pub fn ended_by(self, flag: Arc<AtomicBool>) -> Self {
        Self { end: Some(flag), ..self }
    }

    /// Returns whether the flag of [`Analysis::ended_by`] is set.
    pub fn is_ended(&self) -> bool {
        self.end.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// The model.
    pub fn model(&self) -> &Model {
        self.equilibrium.as_ref().map_or(self.design_map.model(), |open| &open.user)
    }

    /// The model that is solved: with equilibrium, its elastic joints are open, and the openings are further drivers.
    pub fn solved_model(&self) -> &Model {
        self.design_map.model()
    }

    /// The openings of the solved model and their forces as measures, if its elastic joints are open.
    pub(super) fn openings(&self) -> Option<(&[DriverId], &[MeasureKind])> {
        self.equilibrium.as_ref().map(|open| (&open.openings[..], &open.kinds[..]))
    }

    /// True if drivers and openings of the solved model are the same as those of another analysis of it.
    pub(super) fn drives_the_same(&self, other: &Analysis<'_>) -> bool {
        let [own, others] = [self.solved_model(), other.solved_model()].map(|model| &model.drivers);
        let same = |(a, b): (&Driver, &Driver)| (a.joint, a.coordinate) == (b.joint, b.coordinate);
        own.len() == others.len() && own.iter().zip(others).all(same)
    }

    /// The plan.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Placements of the bodies in the other assemblies of the nominal design with all drivers at zero, the nearest
    /// first: [`Model::starting_at`] makes the model of each. `more` is called before every search; if it returns
    /// false, the rest is not searched.
    ///
    /// Least squares from scattered positions find them, of which none is proven to be the last. Mechanisms with more
    /// than 150 unknowns are not searched.
    ///
    /// ```
    /// # use hardpoint::{Analysis, draft::Draft, law::Law, model::Model};
    /// # let z = [0.0, 0.0, 1.0];
    /// // A four-bar in its plane: its coupler and rocker can also lie below the line through their ends.
    /// let draft = Draft::new("four-bar")
    ///     .bodies(["crank", "coupler", "rocker"])
    ///     .revolute("a", ["ground", "crank"], [0.0, 0.0, 0.0], z)
    ///     .revolute("b", ["crank", "coupler"], [0.1, 0.0, 0.0], z)
    ///     .revolute("c", ["coupler", "rocker"], [0.4, 0.3, 0.0], z)
    ///     .revolute("d", ["ground", "rocker"], [0.5, 0.0, 0.0], z)
    ///     .driver("motor", "a", Law::parse("t").unwrap())
    ///     .point("knee", "rocker", [0.4, 0.3, 0.0])
    ///     .times([0.0, 0.5]);
    /// let model = Model::from_draft(&draft).unwrap();
    /// let others = Analysis::new(&model).unwrap().other_assemblies(&|| true);
    /// assert_eq!(others.len(), 1);
    /// let below = Analysis::new(std::sync::Arc::new(model.starting_at(&others[0]))).unwrap().run();
    /// let y = below.measured.index("knee.y").unwrap();
    /// assert!((below.measured.value(0, y)[0] + 0.3).abs() < 1e-12);
    /// ```
    pub fn other_assemblies(&self, more: &dyn Fn() -> bool) -> Vec<Vec<StartPlacement>> {
        start::other_assemblies(self.solved_model(), &self.topology, more)
    }

    /// Placements of the bodies of a design where its assembly ends, with all drivers at zero; `None` if it does not
    /// assemble. Bodies in their places in the design configuration are left out.
    pub fn start_placements(&self, design: &[f64]) -> Option<Vec<StartPlacement>> {
        let design = self.design(design);
        let (model, topology) = (self.solved_model(), &self.topology);
        let parts = PlanGeometry::same(model, topology, &design.geometry, &design.laws);
        start::placements_of(&mut Stepper::new(model, topology, parts))
    }

    /// Solves motion, sensitivities by all design variables, and measures at all output times, for the nominal design.
    pub fn run(&self) -> Solution {
        self.solve(Run::new())
    }

    /// Solves the request at all output times. If the run ends before the last one, [`Solution::stop`] has the reason,
    /// and the results up to there are complete.
    pub fn solve(&self, mut run: Run<'_>) -> Solution {
        let (mut design, mut solution) =
            (self.prepare(run.design, run.scope), std::mem::take(&mut run.memory));
        design.needs = run.outputs.map(|outputs| Arc::new(NeededResults::of_outputs(self.model(), outputs)));
        if let Some(uses) = run.metrics
            && self.equilibrium.is_some()
            && run.scope.sensitivities
            && run.scope.measures
        {
            self.solve_for_metrics(design, uses, &mut *run.progress, &mut solution);
            return solution;
        }
        self.walk(&design, self.model().times.len(), &mut *run.progress, &mut solution, &mut |_, _| ());
        self.solve_between(&design, &mut *run.progress, &mut solution);
        solution
    }

    /// Solves like [`Analysis::solve`], but passes every result to the sink instead of storing it.
    ///
    /// Results of 10,000 loops and 1,000 variables need not fit into memory. Measures are not evaluated.
    pub fn stream(&self, mut run: Run<'_>, sink: &mut impl Sink) -> StreamSummary {
        let design = self.prepare(run.design, run.scope);
        let wanted = self.wanted(std::slice::from_ref(sink));
        let mut walk = Walk::by_programs(self, &design, wanted, (false, false, false));
        let stop = walk.all(sink, &mut *run.progress, |_, _, _, _| ());
        let (steps, effort) = (walk.done, walk.one.effort);
        StreamSummary { steps, admissibility: walk.admissibility(&design.opens), effort, stop }
    }

    /// Admissibility of a combined change of the nominal design, in which variable k changes by `change[k]`. A
    /// combination may be admissible although its variables are not.
    pub fn admissibility_of(&self, change: &[f64]) -> Admissibility {
        let mut design = self.design(&[]);
        let along = along(&self.model().whole(change));
        let field = self.design_map.field_along(&along, &design.values);
        design.opens = vec![self.opens_along(&field)];
        design.fields = vec![field];
        let mut walk = Walk::new(self, &design, vec![false; self.model().bodies.len()]);
        walk.each(|_| ());
        walk.admissibility(&design.opens).pop().expect("that of the one field")
    }

    /// Solves a prepared design at all output times.
    pub(super) fn solve_prepared(&self, design: &PreparedDesign, solution: &mut Solution) {
        let progress = &mut |_| ControlFlow::Continue(());
        self.walk(design, self.model().times.len(), progress, solution, &mut |_, _| ());
        self.solve_between(design, progress, solution);
    }

    /// Prepares the design with variable k at `design[k]`, without sensitivities.
    pub(crate) fn design(&self, design: &[f64]) -> PreparedDesign {
        self.prepare(design, Scope::of_one(false, true))
    }

    /// Prepares the design with variable k at `design[k]`, for results of this scope.
    pub(super) fn prepare(&self, design: &[f64], scope: Scope) -> PreparedDesign {
        let values = self.model().whole(design);
        let sensitivities = scope.sensitivities;
        PreparedDesign {
            geometry: self.design_map.geometry(&values),
            laws: self.design_map.laws(&values),
            undefined: self.design_map.undefined_formula(&values),
            fields: if sensitivities { self.design_map.fields(&values) } else { Vec::new() },
            opens: if sensitivities { self.opens().to_vec() } else { Vec::new() },
            scope,
            values,
            needs: None,
            continued: Continuations::default(),
        }
    }

    /// Analysis of the same model at other output times, with the same first one. It shares the plan and the programs.
    pub(super) fn at_times(&self, times: Vec<f64>) -> Analysis<'static> {
        self.with_model(|model| Model { times: times.clone(), ..model.clone() })
    }

    /// Returns the same analysis at other output times, of a model without metrics.
    pub fn without_metrics(&self, times: Vec<f64>) -> Analysis<'static> {
        self.with_model(|model| Model { times: times.clone(), metrics: Vec::new(), ..model.clone() })
    }

    /// Analysis of the same model at other output times, without metrics, whose motion no limit of a joint ends.
    pub(super) fn without_stops(&self, times: Vec<f64>) -> Analysis<'static> {
        self.with_model(|model| {
            let joint_limits =
                model.joint_limits.iter().map(|limit| JointLimit { stop: false, ..limit.clone() });
            let joint_limits = joint_limits.collect();
            Model { times: times.clone(), metrics: Vec::new(), joint_limits, ..model.clone() }
        })
    }

    /// Analysis of a model that differs only in its output times, metrics and stops.
    fn with_model(&self, changed: impl Fn(&Model) -> Model) -> Analysis<'static> {
        let equilibrium = self.equilibrium.as_ref().map(|open| {
            let OpenModel { user, openings, every_opening, .. } = &**open;
            Arc::new(OpenModel::new(&changed(user), openings.clone(), changed(every_opening)))
        });
        Analysis {
            topology: self.topology.clone(),
            design_map: DesignMap::of(Arc::new(changed(self.solved_model()))),
            equilibrium,
            opens: self.opens.clone(),
            between: Arc::default(),
            programs: self.programs.clone(),
            formulas: self.formulas.clone(),
            kernel: self.kernel.clone(),
            end: self.end.clone(),
        }
    }

    /// Examines a position with these rows at an equilibrium; `None` without one. Returns whether the constraints are
    /// singular there, with all openings and without, and the analysis of the same model with the openings that they
    /// leave there, if they are others.
    pub(super) fn examine_openings(
        &self,
        rows: &[TreeRow],
    ) -> Option<([bool; 2], Option<Analysis<'static>>)> {
        let OpenModel { user, every_opening, .. } = &**self.equilibrium.as_ref()?;
        let before = (every_opening, self.solved_model());
        let OpenPosition { is_singular, is_singular_if_rigid, other } =
            release_at(user, before, rows, self.topology.formulation);
        let with = |(released, topology): (Released, Topology)| {
            let Released { model: open, openings, every_opening } = released;
            let start = start::start_coordinates(&open, &topology);
            Analysis {
                topology: Topology { start, ..topology },
                design_map: DesignMap::of(Arc::new(open)),
                equilibrium: Some(Arc::new(OpenModel::new(user, openings, every_opening))),
                opens: self.opens.clone(),
                between: Arc::default(),
                programs: self.programs.clone(),
                formulas: Arc::default(),
                kernel: Arc::default(),
                end: self.end.clone(),
            }
        };
        Some(([is_singular, is_singular_if_rigid], other.map(with)))
    }

    /// Returns the places, laws and design velocities of the model as functions of the design.
    pub fn design_map(&self) -> &DesignMap<'m> {
        &self.design_map
    }

    /// Per variable, the joints that it opens in the nominal design.
    pub(crate) fn opens(&self) -> &[Vec<JointDefect>] {
        self.opens.get_or_init(|| {
            let nominal = self.design_map.fields(&self.model().whole(&[]));
            nominal.iter().map(|field| self.opens_along(field)).collect()
        })
    }

    /// Joints of the model that a change of the nominal design opens if all bodies are fixed.
    pub fn opens_along(&self, field: &DesignVelocity) -> Vec<JointDefect> {
        let own = self.model().joints.len();
        let mut opened = admissibility_at_design(self.solved_model(), field);
        // What places a floating body is no joint of the user.
        opened.retain(|defect| defect.joint.0 < own);
        opened
    }

    /// Method that solves the smooth steps of the nominal motion, with or without measures.
    pub(super) fn solved_by(&self, measures: bool) -> StepMethod {
        if self.equilibrium.is_some() {
            return StepMethod::Kernel(AT_EQUILIBRIUM.into());
        }
        let of_measures = || if measures { self.needs_kernel() } else { None };
        match StepProgram::hindrance(&self.topology, measures).or_else(of_measures) {
            Some(why) => StepMethod::Kernel(why.into()),
            None => self.programs.solved_by(self.model().times.len()),
        }
    }

    /// True if measures need more of a step than the motion of its bodies.
    pub(super) fn depends_on_step(&self) -> bool {
        (0..self.model().measures.len()).any(|k| self.model().depends_on_step(k))
    }

    /// True if any load is requested.
    pub(super) fn asks_for_loads(&self) -> bool {
        self.model().measures.iter().any(|m| m.kind.is_load())
    }

    /// Reason why measures need the kernel instead of programs, if they do.
    pub(super) fn needs_kernel(&self) -> Option<&'static str> {
        *self.kernel.get_or_init(|| {
            if self.equilibrium.is_some() {
                return Some(AT_EQUILIBRIUM);
            }
            let model = self.model();
            if model.measures.iter().any(|m| matches!(m.kind, MeasureKind::Compliance { .. })) {
                return Some("there are measures of compliance");
            }
            let of_loads = || load::hindrance(model, &self.topology).filter(|_| self.asks_for_loads());
            measure::hindrance(&self.design_map).or_else(of_loads)
        })
    }

    /// Program that evaluates these laws at many times, if they are those of the nominal design and it saves time.
    pub(super) fn laws_program(&self, laws: &[Law], loads: bool) -> Option<Arc<Runnable>> {
        let nominal =
            self.model().drivers.iter().zip(laws).all(|(driver, law)| driver.coordinate_law() == *law);
        if nominal { self.programs.laws(self.model(), loads) } else { None }
    }

    /// True if a program saves time for the steps of this number of designs.
    pub(super) fn programs_pay(&self, designs: usize) -> bool {
        self.equilibrium.is_none() && self.programs.pay(designs * self.model().times.len())
    }

    /// Per body: true if any sink requests its results.
    pub(super) fn wanted<S: Sink>(&self, sinks: &[S]) -> Vec<bool> {
        (0..self.model().bodies.len()).map(|b| sinks.iter().any(|s| s.wants(BodyId(b)))).collect()
    }

    /// Stop of a run for a reason outside the solver, after `done` output times.
    pub(super) fn stopped(&self, kind: StopKind, done: usize) -> Stop {
        let last_time = done.checked_sub(1).map(|k| self.model().times[k]);
        let t = last_time.or(self.model().times.first().copied()).unwrap_or(0.0);
        Stop {
            kind,
            last_time,
            failed_time: t,
            drivers: self.model().drivers.iter().map(|d| d.law.at(t).value()).collect(),
            block: None,
            pivot_ratio: 1.0,
            joints: Vec::new(),
            remains: Vec::new(),
            closed: None,
            snaps_through: false,
        }
    }

    /// True if the positions of a motion of this design are recorded, since metrics may ask for times between them, and
    /// two positions determine those in between.
    pub(super) fn records_channels(&self, design: &PreparedDesign) -> bool {
        let (model, topology) = (self.solved_model(), &self.topology);
        design.scope.measures
            && design.needs.is_none()
            && self.equilibrium.is_none()
            && !model.metrics.is_empty()
            && model.at_change_points == ChangePointPolicy::Stop
            && topology.coupler_terms.is_empty()
            && topology.contacts().next().is_none()
    }

    /// Clears a motion and reserves memory for `steps` output times.
    pub(super) fn make_room(&self, motion: &mut Motion, steps: usize) {
        motion.bodies = self.model().bodies.len();
        motion.states.shape(BodyState::NUMBERS * (motion.bodies - 1), steps);
        motion.coordinates.shape(self.topology.coordinates.len(), steps);
        motion.channels = None;
        motion.times.clear();
        motion.times.reserve(steps);
        motion.margins.clear();
        motion.assembly = None;
        motion.solved_by = None;
        motion.counted.clear();
        motion.beyond = None;
    }

    /// Evaluates the measures of a motion.
    pub(super) fn measure(&self, design: &PreparedDesign, slopes: &StepValues, solution: &mut Solution) {
        let Solution { motion, sensitivities, measured, .. } = solution;
        if !design.scope.measures {
            *measured = MeasureResults::default();
            return;
        }
        let PreparedDesign { values, laws, scope: Scope { of_many, .. }, .. } = design;
        let at = measure::MeasuredDesign {
            model: self.solved_model(),
            design_map: &self.design_map,
            values,
            laws,
        };
        let program = self.programs_pay(*of_many).then(|| {
            let asked = measure::ProgramKey::of(self.model(), values, sensitivities);
            let execution = self.programs.execution();
            self.formulas
                .get(asked, |asked| measure::MeasureProgram::record(&self.design_map, asked, execution))
        });
        let (program, solved) = (program.flatten(), (&*motion, &*sensitivities));
        measure::evaluate(&at, &self.topology, solved, slopes, program.as_deref(), measured);
    }

    /// The step of this plan as a program, recorded where the nominal motion begins.
    pub(super) fn program(&self, purpose: Purpose) -> Option<Arc<StepProgram>> {
        if self.equilibrium.is_some() || StepProgram::hindrance(&self.topology, purpose.margins).is_some() {
            return None;
        }
        self.programs.step(purpose, |execution| {
            let one = self.started()?;
            let besides = |mut step: RecordedStep<'_>| {
                let wanted = purpose.sensitivities;
                let mut loads =
                    purpose.loads.then(|| RecordedLoads::new(&self.design_map, &mut step, wanted));
                let mut extras = if purpose.sensitivities {
                    let RecordedStep { topology, state, values, .. } = &mut step;
                    let fields = recording::strictly(|| self.design_map.fields(values));
                    record_derivatives(self.model(), &fields, topology, state, |by| {
                        if let Some(loads) = &mut loads {
                            loads.differentiate(&by);
                        }
                    })?
                } else {
                    RecordedExtras::default()
                };
                let mut measures = loads.map_or_else(Default::default, RecordedLoads::values);
                if purpose.slopes {
                    let (slopes, limits) = Slopes::record(&self.design_map, &mut step, wanted)?;
                    extras.limits.extend(limits);
                    measures = measures.and(slopes);
                }
                Some(RecordedExtras { measures: measures.numbers(), ..extras })
            };
            StepProgram::record(&one.mechanism, &self.design_map, purpose, besides, execution)
        })
    }

    /// Returns the step as straight-line programs of its drivers, recorded at the first output time of the nominal
    /// design. If `any_design` is true, the design variables are inputs of the programs.
    ///
    /// # Errors
    ///
    /// The reason why the step cannot be recorded.
    pub fn driven_step(&self, any_design: bool) -> Result<DrivenStep, String> {
        if self.equilibrium.is_some() {
            return Err(AT_EQUILIBRIUM.to_owned());
        }
        if let Some(why) = StepProgram::excess(&self.topology) {
            return Err(why.to_owned());
        }
        let Some(one) = self.started() else {
            return Err("the motion does not reach its first output time".to_owned());
        };
        let model = self.model();
        let are_recorded = measure::hindrance(&self.design_map).is_none();
        let slopes = (0..model.measures.len()).filter(|m| are_recorded && model.depends_on_driver(*m));
        let slopes: Vec<usize> = slopes.collect();
        let record = |measures: Vec<usize>| {
            let is_asked = !measures.is_empty();
            DrivenStep::record(&one.mechanism, (&self.design_map, any_design), measures, |step| {
                if !is_asked {
                    return Some(Default::default());
                }
                let (slopes, limits) = Slopes::record(&self.design_map, step, false)?;
                Some((slopes.numbers(), limits))
            })
        };
        // A measure that is not arithmetic leaves the motion as it is.
        let step = record(slopes).or_else(|| record(Vec::new()));
        step.ok_or_else(|| "a decision of the step depends on its position".to_owned())
    }

    /// Returns the measures as a straight-line program of the motion of the bodies; `None` if they cannot be recorded.
    /// If `any_design` is true, the design variables are inputs of the program.
    pub fn measure_formulas(&self, any_design: bool) -> Option<MeasureFormulas> {
        MeasureFormulas::record(&self.design_map, any_design)
    }

    /// The nominal design where its motion begins.
    pub(super) fn started(&self) -> Option<Stepper<'_>> {
        let mut one = self.nominal();
        advance::start(&mut one, *self.model().times.first()?).ok()?;
        Some(one)
    }

    /// Solver of the nominal design, which is not started.
    pub(super) fn nominal(&self) -> Stepper<'_> {
        let PreparedDesign { geometry, laws, .. } = self.design(&[]);
        let parts = PlanGeometry::same(self.solved_model(), &self.topology, &geometry, &laws);
        Stepper::new(self.solved_model(), &self.topology, parts)
    }
}

//! Gradients of chosen outputs by all design variables, by direct differentiation or the adjoint method, whichever is
//! cheaper.

use hardpoint_tape::LANES;

use super::{Analysis, PreparedDesign, Run, Solution, Walk};
use crate::design::{BodyFixed, DesignVelocity};
use crate::load::{LoadGradients, LoadSolver};
use crate::measure::{
    self, Context, Instant, Output, StepValues, bodies_asked_for, dependences, outputs, with_rates,
};
use crate::model::{GROUND, MeasureKind, Model, OutputSource, VariableId};
use crate::motion::kinematics::State;
use crate::motion::stepper::Stepper;
use crate::motion::{BodyState, Stop};
use crate::number::{Dual, Rates};
use crate::sensitivity::{Adjoint, Admissibility, DefectWatch, Load, Resistance, Support, admissibility};
use crate::space::{Pose, Twist, Vec3, Wrench};
use crate::topology::Topology;

/// Cost of an output by the adjoint method, relative to the solution for one variable by direct differentiation: its
/// adjoint load takes some evaluations of the measure besides three solutions. Measured: 1 to 3 in small mechanisms,
/// less in large ones (`docs/performance.md`).
const OUTPUT_COST: usize = 3;
/// Relative cost of a joint or driver load: its dependence on the motion of each body has to be found first.
const LOAD_COST: usize = 6;
/// Relative cost of a redundant constraint row, which has to be monitored: two solutions for the position alone.
const ROW_COST: usize = 1;

/// Method of gradients. All methods give the same values to round-off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GradientMethod {
    /// The method that is expected to be faster: adjoint if the number of variables exceeds the number of redundant
    /// rows plus three times the outputs plus six times the loads.
    #[default]
    Auto,
    /// Variable by variable: the cost grows with the number of variables and hardly with the outputs.
    Direct,
    /// Output by output: the cost grows with the number of outputs and hardly with the variables.
    Adjoint,
}

/// Gradients of outputs by all design variables over a motion.
#[derive(Clone, Debug, Default)]
pub struct Gradients {
    /// Output times that were solved, s.
    pub times: Vec<f64>,
    /// Requested outputs.
    pub outputs: Vec<Output>,
    /// Number of design variables.
    pub variables: usize,
    /// Method used: direct or adjoint.
    pub method: GradientMethod,
    /// Admissibility of each variable.
    pub admissibility: Vec<Admissibility>,
    /// Reason why the run ended before the last output time, if it did.
    pub stop: Option<Stop>,
    /// `d[(k * outputs + m) * variables + b]`.
    d: Vec<[f64; 3]>,
}

impl Gradients {
    /// Derivatives by every variable, at fixed t, of value, rate and acceleration of the m-th requested output at time
    /// k; in the output's unit, per s, per s^2, per unit of the variable.
    ///
    /// NaN for a variable that the mechanism cannot follow: see [`Gradients::admissibility`] for the reason.
    pub fn at(&self, k: usize, m: usize) -> &[[f64; 3]] {
        let first = (k * self.outputs.len() + m) * self.variables;
        &self.d[first..first + self.variables]
    }
}

impl Analysis<'_> {
    /// Gradients of some outputs, given by their indices in [`outputs`], by all variables at the design with variable k
    /// at `design[k]`.
    ///
    /// The adjoint method costs one transposed solution for each output and time, with its first two time derivatives,
    /// and a few products for each marker that a variable moves (`docs/theory.md`, section 8).
    ///
    /// Loads take one more solution. Velocities, slopes over a driver, compliances and formulas over other measures
    /// always use direct differentiation, and so does everything at an equilibrium: the adjoint method would need the
    /// same derivatives of the forces of all openings by every variable.
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn gradients(&self, design: &[f64], outputs_asked: &[usize], method: GradientMethod) -> Gradients {
        let all = outputs(self.model());
        let asked: Vec<Output> = outputs_asked.iter().map(|&m| all[m].clone()).collect();
        // Only smooth functions of positions, and loads, can be written as an adjoint load on the bodies.
        let is_plain = |o: &Output| {
            let formula = |k: usize| matches!(self.model().measures[k].kind, MeasureKind::Combination { .. });
            o.known.by_position && !matches!(o.source, OutputSource::Measure(k) if formula(k))
        };
        let is_load = |o: &Output| load_of(self.model(), o).is_some();
        // The openings of an equilibrium follow every variable by direct differentiation.
        if self.openings().is_some() || !asked.iter().all(|o| is_plain(o) || is_load(o)) {
            return self.gradients_of_run(design, outputs_asked, asked);
        }
        match self.method(asked.len(), asked.iter().filter(|o| is_load(o)).count(), method) {
            GradientMethod::Direct if asked.iter().any(is_load) => {
                self.gradients_of_run(design, outputs_asked, asked)
            }
            GradientMethod::Direct => self.gradients_direct(design, asked),
            _ => {
                let design = self.design(design);
                self.gradients_adjoint(&design, asked)
            }
        }
    }

    /// Chooses the method for a number of outputs, of which `loads` are loads.
    fn method(&self, outputs: usize, loads: usize, method: GradientMethod) -> GradientMethod {
        let adjoint = OUTPUT_COST * (outputs - loads)
            + LOAD_COST * loads
            + ROW_COST * self.topology().redundant().count();
        match method {
            GradientMethod::Auto if adjoint < self.model().variables.len() => GradientMethod::Adjoint,
            GradientMethod::Auto => GradientMethod::Direct,
            chosen => chosen,
        }
    }

    /// Gradients of outputs that are known only after a whole run.
    fn gradients_of_run(&self, design: &[f64], indices: &[usize], outputs: Vec<Output>) -> Gradients {
        let Solution { motion, sensitivities, measured, stop, .. } = self.solve(Run::new().at(design));
        let variables = self.model().variables.len();
        let of = |k: usize| {
            let measured = &measured;
            indices.iter().flat_map(move |&m| (0..variables).map(move |v| measured.d(k, VariableId(v), m)))
        };
        Gradients {
            d: (0..motion.len()).flat_map(of).collect(),
            times: motion.times,
            outputs,
            variables,
            method: GradientMethod::Direct,
            admissibility: sensitivities.admissibility,
            stop,
        }
    }

    fn gradients_direct(&self, design: &[f64], outputs: Vec<Output>) -> Gradients {
        let Solution { motion, sensitivities, stop, .. } =
            self.solve(Run::new().at(design).without_measures());
        let PreparedDesign { values, laws, .. } = &self.design(design);
        let at = measure::MeasuredDesign { model: self.model(), design_map: self.design_map(), values, laws };
        let more = Context { slopes: &StepValues::default(), whole_turns: &[], nearest: &[] };
        let (asked, variables) = (outputs.len(), self.model().variables.len());
        let mut d = vec![[f64::NAN; 3]; motion.len() * asked * variables];
        let blocks = (0..motion.len()).step_by(LANES);
        let all: Vec<_> = blocks.flat_map(|k| (0..asked).map(move |m| (k, m))).collect();
        let solved = (&motion, &sensitivities);
        measure::derivatives(&at, &outputs, &all, solved, &more, |k, b, m, numbers| {
            d[(k * asked + m) * variables + b] = numbers.map(measure::finite);
        });
        Gradients {
            times: motion.times,
            outputs,
            variables,
            method: GradientMethod::Direct,
            admissibility: sensitivities.admissibility,
            stop,
            d,
        }
    }

    fn gradients_adjoint(&self, design: &PreparedDesign, outputs: Vec<Output>) -> Gradients {
        let model = self.model();
        let (variables, asked) = (model.variables.len(), outputs.len());
        let fields = self.design_map().fields(&design.values);
        let mut result = Gradients {
            d: vec![[f64::NAN; 3]; model.times.len() * asked * variables],
            method: GradientMethod::Adjoint,
            variables,
            outputs,
            ..Gradients::default()
        };
        let mut tracing = AdjointSolver::new(self, design, &fields, &result.outputs);
        let mut resisting: Vec<Resistance> = vec![(Vec::new(), 0.0); variables];
        let mut walk = Walk::new(self, design, vec![false; model.bodies.len()]);
        let mut times = model.times.iter();
        result.stop = walk.each(|one| {
            if let Some(&t) = times.next() {
                tracing.add(one, t, &mut resisting, &mut result);
            }
        });
        result.d.truncate(result.times.len() * asked * variables);
        result.admissibility = admissibility(self.opens(), resisting, result.times.len());
        for (v, answer) in result.admissibility.iter().enumerate() {
            if matches!(answer, Admissibility::CannotFollow { .. }) {
                result.d.iter_mut().skip(v).step_by(variables).for_each(|d| *d = [f64::NAN; 3]);
            }
        }
        result
    }
}

/// Workspace of the adjoint method, in addition to a stepper.
struct AdjointSolver<'a> {
    analysis: &'a Analysis<'a>,
    adjoint: Adjoint,
    watch: DefectWatch,
    asked: Vec<Requested>,
    /// `None` if no load is requested.
    loads: Option<LoadGradients<'a>>,
    /// Bodies that outputs are measured on.
    bodies: Vec<usize>,
    poses: Vec<Pose<Dual<Rates>>>,
    /// Body-fixed data of measures, with their derivatives by each variable that affects them.
    fixed: BodyFixed<Dual<Rates>>,
    moved: Vec<Option<BodyFixed<Dual<Rates>>>>,
    gradient: Vec<[f64; 3]>,
}

/// Requested output, by kind.
enum Requested {
    /// A function of positions.
    Output(Box<RequestedOutput>),
    /// A load, by its index among the requested loads.
    Load(usize),
}

/// Index of the measure of an output that is a load; `None` otherwise.
fn load_of(model: &Model, output: &Output) -> Option<usize> {
    match output.source {
        OutputSource::Measure(m) => model.measures[m].kind.is_load().then_some(m),
        OutputSource::Point(..) => None,
    }
}

/// Requested output with its dependencies.
struct RequestedOutput {
    output: Output,
    /// Dependence on the twist of each body that it is measured on.
    loads: Vec<(usize, Load)>,
    support: Support,
    /// Variables that move body-fixed data of its measure.
    variables: Vec<usize>,
    /// Derivatives of value, rate and acceleration by the six unit twists of each of these bodies, then by each of
    /// these variables.
    derivatives: Vec<[f64; 3]>,
}

impl<'a> AdjointSolver<'a> {
    fn new(
        analysis: &'a Analysis<'_>,
        design: &PreparedDesign,
        fields: &[DesignVelocity],
        outputs: &[Output],
    ) -> Self {
        let (model, design_map) = (analysis.model(), analysis.design_map());
        let adjoint = Adjoint::new(model, analysis.topology(), fields);
        let bodies: Vec<usize> = bodies_asked_for(model).into_iter().filter(|b| *b != GROUND.0).collect();
        let of_positions: Vec<Output> =
            outputs.iter().filter(|o| load_of(model, o).is_none()).cloned().collect();
        let mut measures = Vec::new();
        let depends = dependences(design_map, &design.values, &bodies, &of_positions);
        let mut depends = of_positions.into_iter().zip(depends);
        let none = [Wrench::zero(); 3];
        let asked = outputs.iter().filter_map(|output| match load_of(model, output) {
            Some(m) => {
                measures.push(m);
                Some(Requested::Load(measures.len() - 1))
            }
            None => depends.next().map(|(output, [on, variables])| {
                Requested::Output(Box::new(RequestedOutput {
                    derivatives: vec![[0.0; 3]; 6 * on.len() + variables.len()],
                    output,
                    support: adjoint.support(analysis.topology(), &on),
                    loads: on.into_iter().map(|b| (b, none)).collect(),
                    variables,
                }))
            }),
        });
        let asked: Vec<Requested> = asked.collect();
        let loads = (!measures.is_empty()).then(|| {
            let solver = LoadSolver::new(design_map, analysis.topology(), &design.values, measures, true);
            LoadGradients::new(solver, analysis.topology(), &adjoint)
        });
        let mut values: Vec<Dual<Rates>> =
            design.values.iter().map(|v| Dual::constant(Rates::constant(*v))).collect();
        let mut moved: Vec<Option<BodyFixed<Dual<Rates>>>> = values.iter().map(|_| None).collect();
        let by_variables = asked.iter().filter_map(|a| match a {
            Requested::Output(output) => Some(&output.variables),
            Requested::Load(_) => None,
        });
        for &v in by_variables.flatten() {
            moved[v].get_or_insert_with(|| {
                let value = values[v];
                values[v] = Dual::variable(value.v);
                let fixed = design_map.fixed(&values);
                values[v] = value;
                fixed
            });
        }
        Self {
            watch: DefectWatch::new(model, fields.len()),
            poses: vec![Pose::IDENTITY.spread(); model.bodies.len()],
            fixed: design_map.fixed(&values),
            gradient: vec![[0.0; 3]; fields.len()],
            analysis,
            adjoint,
            asked,
            loads,
            bodies,
            moved,
        }
    }

    /// Appends the gradients at time t.
    fn add(
        &mut self,
        stepper: &mut Stepper<'_>,
        t: f64,
        resisting: &mut [Resistance],
        result: &mut Gradients,
    ) {
        self.adjoint.set_time(&stepper.mechanism, t);
        if let Some(loads) = &mut self.loads {
            loads.step(stepper, &self.adjoint, t);
        }
        let (topology, state) = (&stepper.mechanism.topology, &mut stepper.mechanism.state);
        state.finish_rates(topology);
        self.differentiate(state);
        let first = result.times.len() * self.asked.len();
        for m in 0..self.asked.len() {
            self.trace(topology, state, m);
            let at = (first + m) * result.variables;
            result.d[at..at + self.gradient.len()].copy_from_slice(&self.gradient);
        }
        self.watch.look(&mut self.adjoint, topology, state, t, resisting);
        result.times.push(t);
    }

    /// Gradient of output m: the work of its adjoint load on the design velocities, plus the direct contribution of the
    /// variables.
    fn trace(&mut self, topology: &Topology, state: &mut State<f64>, m: usize) {
        let RequestedOutput { loads, support, variables, derivatives, .. } = match &mut self.asked[m] {
            Requested::Output(output) => &mut **output,
            Requested::Load(m) => {
                if let Some(loads) = &mut self.loads {
                    loads.gradient(&mut self.adjoint, (topology, state), *m, &mut self.gradient);
                }
                return;
            }
        };
        let (by_twists, by_variables) = derivatives.split_at(6 * loads.len());
        for ((_, load), by) in loads.iter_mut().zip(by_twists.chunks_exact(6)) {
            for (order, load) in load.iter_mut().enumerate() {
                let part = |first: usize| Vec3::from([0, 1, 2].map(|k| by[first + k][order]));
                // F_i = (dy/d(turn about x, y, z), dy/d(slide along x, y, z)) of body i, and its rates             (17)
                *load = Wrench { m: part(0), f: part(3) };
            }
        }
        self.gradient.fill([0.0; 3]);
        self.adjoint.add_work(topology, state, support, loads, 3, &mut self.gradient);
        for (&v, by) in variables.iter().zip(by_variables) {
            // ... + dy/db with all bodies where they are                                                          (19), last term
            (0..3).for_each(|order| self.gradient[v][order] += by[order]);
        }
    }

    /// Derivatives of all outputs by the design twists of bodies (six unit twists each, constant in the global frame,
    /// so that their rates are those of the load) and by variables that change the data of the measures.
    fn differentiate(&mut self, state: &State<f64>) {
        let Self { analysis, asked, poses, fixed, moved, bodies, .. } = self;
        let model = analysis.model();
        for &b in bodies.iter() {
            poses[b] = with_rates(&BodyState::of(state, b)).along(Twist::zero());
        }
        let of_positions = asked.iter_mut().filter_map(|a| match a {
            Requested::Output(output) => Some(output),
            Requested::Load(_) => None,
        });
        for output in of_positions {
            let RequestedOutput { output, loads, variables, derivatives, .. } = &mut **output;
            let (by_twists, by_variables) = derivatives.split_at_mut(6 * loads.len());
            for ((b, _), by) in loads.iter().zip(by_twists.chunks_exact_mut(6)) {
                // The unit twist is in the world, so that its rates are zero.
                let nominal = poses[*b].nominal();
                for (unit, to) in Twist::UNITS.into_iter().zip(by) {
                    poses[*b] = nominal.along(unit.spread());
                    *to = Instant::new(model, fixed, poses).output(output.source).d.0;
                }
                poses[*b] = nominal.along(Twist::zero());
            }
            for (&v, to) in variables.iter().zip(by_variables) {
                let fixed = moved[v].as_ref().expect("laid out for every variable of an output");
                *to = Instant::new(model, fixed, poses).output(output.source).d.0;
            }
        }
    }
}

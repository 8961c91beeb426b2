//! Evaluation of all outputs over a motion: by a program where there is one, else by the formulas.

use std::ops::Range;

use hardpoint_tape::LANES;

use crate::clearance::{
    ChangingBodies, DistanceGradient, GradientBatch, MovingBodies, NearestPair, PlacedShapes,
    moves_points_only,
};
use crate::design::{BodyFixed, DesignMap};
use crate::law::Law;
use crate::model::{ClearanceId, Model, ShapeId, VariableId};
use crate::motion::{BodyState, Motion};
use crate::number::{Dual, Jet, Rates, Real};
use crate::sensitivity::{Admissibility, BodySensitivity, Sensitivities};
use crate::space::Pose;
use crate::topology::Topology;

use super::StepValues;
use super::bodies::{at_rest, with_rates, with_sensitivity};
use super::formulas::{Instant, bodies_asked_for, clearance_of, is_formula};
use super::program::{MeasureProgram, MeasureRun};
use super::storage::{MeasureResults, Output, dense, outputs};
use super::turns::{Turns, placed_turns, unwrap_angles};

/// The design whose motion is measured.
pub(crate) struct MeasuredDesign<'a> {
    pub model: &'a Model,
    pub design_map: &'a DesignMap<'a>,
    /// The variables' values.
    pub values: &'a [f64],
    /// The drivers' laws.
    pub laws: &'a [Law],
}

/// Evaluates all outputs over a motion, and their derivatives by the variables with sensitivities. A program computes
/// them, if there is one, except for outputs that it does not support.
pub(crate) fn evaluate(
    design: &MeasuredDesign<'_>,
    topology: &Topology,
    (motion, sensitivities): (&Motion, &Sensitivities),
    slopes: &StepValues,
    program: Option<&MeasureProgram>,
    measured: &mut MeasureResults,
) {
    let &MeasuredDesign { model, values, .. } = design;
    make_room(model, sensitivities, motion.len(), program, measured);
    let mut run = program.map(|program| MeasureRun::new(program, values));
    let mut formulas = FormulaEvaluator::new(design, topology, motion, slopes, measured);
    for first in (0..motion.len()).step_by(LANES) {
        let times = first..usize::min(first + LANES, motion.len());
        let asked = loop {
            if let Some(run) = &mut run {
                // Eight output times at once; outputs that the program does not support are listed, and evaluated by
                // their formulas one by one.
                run.at(first, motion, sensitivities, measured);
            }
            let asked = formulas.fill(times.clone(), run.as_ref(), measured);
            // The program went by the turns of the output time before.
            let turns = |m: usize, k: usize| formulas.counted[k * model.measures.len() + m];
            if !run.as_mut().is_some_and(|run| run.take_turns(times.clone(), turns)) {
                break asked;
            }
        };
        measured.by_formula += times.len() * asked;
        if let Some(run) = &mut run {
            run.turns().for_each(|(_, lanes)| *lanes = [lanes[LANES - 1]; LANES]);
        }
    }
    let FormulaEvaluator { left, counted, nearest, .. } = formulas;
    let more = Context { slopes, whole_turns: &counted, nearest: &nearest };
    let outputs = measured.outputs.clone();
    derivatives(design, &outputs, &left, (motion, sensitivities), &more, |k, b, m, numbers| {
        measured.set_d(k, VariableId(b), m, numbers);
    });
}

/// Room for all outputs of a motion of that many steps, as a program lays them out, if there is one.
fn make_room(
    model: &Model,
    sensitivities: &Sensitivities,
    steps: usize,
    program: Option<&MeasureProgram>,
    measured: &mut MeasureResults,
) {
    let outputs = outputs(model);
    let variables = sensitivities.variables;
    let layout = program.map_or_else(|| dense(outputs.len(), variables), MeasureProgram::layout);
    measured.shape(outputs, variables, layout, steps);
    let cannot_follow =
        |b: &usize| matches!(sensitivities.admissibility[*b], Admissibility::CannotFollow { .. });
    measured.forget((0..variables).filter(cannot_follow));
}

/// The formulas of the outputs, at work on one motion.
struct FormulaEvaluator<'a> {
    model: &'a Model,
    laws: &'a [Law],
    motion: &'a Motion,
    slopes: &'a StepValues,
    fixed: BodyFixed<Rates>,
    /// The bodies that measures name, and where they are.
    bodies: Vec<usize>,
    poses: Vec<Pose<Rates>>,
    /// Per output: what indicates its turns, if it is an angle that has any.
    turns: Vec<Option<Turns>>,
    /// True if any measure is a formula over angles that are counted through turns.
    counts: bool,
    /// Blocks of output times, and outputs there, that the formulas themselves are requested.
    left: Vec<(usize, usize)>,
    /// By time and measure, where any counts: the whole turns.
    counted: Vec<f64>,
    /// By time and clearance: the nearest pair, where formulas are evaluated.
    nearest: Vec<NearestPair>,
    /// Bodies that carry shapes, at one output time.
    carriers: MovingBodies,
    /// Room for the slopes and the whole turns of one output time.
    given: Vec<Rates>,
    whole_turns: Vec<Rates>,
}

impl<'a> FormulaEvaluator<'a> {
    fn new(
        design: &MeasuredDesign<'a>,
        topology: &Topology,
        motion: &'a Motion,
        slopes: &'a StepValues,
        measured: &MeasureResults,
    ) -> Self {
        let &MeasuredDesign { model, design_map, values, laws } = design;
        Self {
            model,
            laws,
            motion,
            slopes,
            // Body-fixed data have no rates: all rates are in the poses.
            fixed: design_map.fixed(values).map(Jet::constant),
            bodies: bodies_asked_for(model),
            poses: vec![Pose::IDENTITY.spread(); model.bodies.len()],
            turns: placed_turns(model, topology, motion, &measured.outputs),
            counts: (0..model.measures.len()).any(|m| is_formula(model, m)),
            left: Vec::new(),
            counted: Vec::new(),
            nearest: Vec::new(),
            carriers: MovingBodies::of(model),
            given: Vec::new(),
            whole_turns: Vec::new(),
        }
    }

    /// Evaluates the outputs that a program does not support at a block of eight output times, and counts all angles
    /// there; returns the number of these outputs.
    fn fill(
        &mut self,
        times: Range<usize>,
        run: Option<&MeasureRun<'_>>,
        measured: &mut MeasureResults,
    ) -> usize {
        let first = times.start;
        let begins = self.left.partition_point(|(block, _)| *block < first);
        self.left.truncate(begins);
        self.counted.truncate(first * self.model.measures.len());
        self.nearest.truncate(first * self.model.clearances.len());
        let fits = |m: &usize| run.is_some_and(|run| run.fits(*m, times.len()));
        let model = self.model;
        let is_given = |m: &usize| *m < model.measures.len() && model.depends_on_step(*m);
        self.left.extend((0..self.turns.len()).filter(|m| !is_given(m) && !fits(m)).map(|m| (first, m)));
        measured.take_given(first, self.slopes, run.is_some());
        times.for_each(|k| self.fill_one(k, begins, measured));
        self.left.len() - begins
    }

    /// The same at output time k, for the outputs that are left from `begins` on.
    fn fill_one(&mut self, k: usize, begins: usize, measured: &mut MeasureResults) {
        let Self { model, motion, fixed, bodies, poses, left, given, whole_turns, nearest, carriers, .. } =
            self;
        let left = &left[begins..];
        let place = |poses: &mut [Pose<Rates>]| {
            let states = motion.at(k);
            bodies.iter().for_each(|&b| poses[b] = with_rates(&states.body(b)));
        };
        if left.iter().any(|(_, m)| clearance_of(model, measured.outputs[*m].source).is_none()) {
            place(poses);
        }
        given.clear();
        if !left.is_empty() {
            given.extend(self.slopes.at(k).map(only));
        }
        // The features of a clearance are selected once, and serve its derivatives too.
        let begins = nearest.len();
        if !model.clearances.is_empty() {
            carriers.set(motion.at(k));
        }
        let shapes = PlacedShapes { model, fixed, bodies: carriers };
        if left.is_empty() {
            nearest.resize(begins + model.clearances.len(), None);
        } else {
            nearest.extend((0..model.clearances.len()).map(|c| shapes.nearest_pair(ClearanceId(c))));
        }
        let nearest = &nearest[begins..];
        let instant = Instant { slopes: given, nearest, ..Instant::new(model, fixed, poses) };
        for &(_, m) in left {
            let source = measured.outputs[m].source;
            let value = match clearance_of(model, source) {
                Some(of) => shapes.clearance(of, nearest),
                None => instant.output(source),
            };
            measured.set(k, m, value.0);
        }
        if whole_turns.len() != model.measures.len() {
            whole_turns.resize(model.measures.len(), Jet([0.0; 3]));
        }
        for turns in whole_turns.iter_mut() {
            *turns = Jet([0.0; 3]);
        }
        unwrap_angles(self.laws, motion, k, &self.turns, measured, |m, whole| {
            whole_turns[m].0[0] = whole;
        });
        if self.counts {
            // Formulas of measures use angles with their turns, so these are computed first.
            self.counted.extend(whole_turns.iter().map(|turns| turns.0[0]));
            let instant = Instant { whole_turns, ..instant };
            for &(_, m) in left.iter().filter(|(_, m)| is_formula(model, *m)) {
                measured.set(k, m, instant.measure(m).0);
            }
        }
    }
}

/// Inputs of outputs besides the motion.
pub(crate) struct Context<'a> {
    /// Values of the measures that depend on a driver.
    pub slopes: &'a StepValues,
    /// By time and measure: the whole turns of its angle, rad; empty if no formula uses them.
    pub whole_turns: &'a [f64],
    /// By time and clearance: the nearest pair; empty where these are not known.
    pub nearest: &'a [NearestPair],
}

/// A number whose rates are not known.
fn only(x: f64) -> Rates {
    Jet([x, f64::NAN, f64::NAN])
}

/// Derivatives of some outputs by the variables that the mechanism follows: of those that are listed, in the order of
/// blocks of eight output times that begin there. `out` is given output time, variable, output and the derivatives.
///
/// Evaluates variable by variable, so that body-fixed data are computed once for each.
pub(crate) fn derivatives(
    design: &MeasuredDesign<'_>,
    outputs: &[Output],
    listed: &[(usize, usize)],
    (motion, sensitivities): (&Motion, &Sensitivities),
    more: &Context<'_>,
    mut out: impl FnMut(usize, usize, usize, [f64; 3]),
) {
    let model = design.model;
    if model.equilibrium.is_some() && model.clearances.is_empty() {
        let bodies = bodies_asked_for(model);
        let run = (motion, sensitivities);
        return each_step(
            design,
            listed,
            run,
            &bodies,
            more,
            |instant: Option<&Instant<'_, Dual>>, _, k, b, listed| {
                let of = |m: usize| instant.map(|instant| instant.output(outputs[m].source).derivatives());
                listed.iter().for_each(|&(_, m)| out(k, b, m, of(m).unwrap_or([f64::NAN; 3])));
            },
        );
    }
    let run = (motion, sensitivities);
    let mut gradients = ClearanceGradients::of(design, outputs, listed, run, more.nearest);
    let listed = &gradients.write(design, outputs, listed, run, &mut out)[..];
    // Clearances need the points of shapes only, not all poses.
    let needs_poses = listed.iter().any(|(_, m)| clearance_of(model, outputs[*m].source).is_none());
    let bodies = if needs_poses { bodies_asked_for(model) } else { Vec::new() };
    let mut carriers = ChangingBodies::of(model);
    each_step(
        design,
        listed,
        run,
        &bodies,
        more,
        |instant: Option<&Instant<'_, Dual<Rates>>>, fixed, k, b, listed| {
            let Some(instant) = instant else { return };
            let states = motion.at(k);
            let mut placed = false;
            for &(_, m) in listed {
                let Some(of) = clearance_of(model, outputs[m].source) else {
                    out(k, b, m, instant.output(outputs[m].source).derivatives());
                    continue;
                };
                if gradients.serves(of, k, b) {
                    continue;
                }
                let Some(d) = sensitivities.at(k, b) else { continue };
                if !placed {
                    carriers.set(states, d);
                    placed = true;
                }
                let shapes = PlacedShapes { model, fixed, bodies: &carriers };
                out(k, b, m, shapes.clearance(of, instant.nearest).derivatives());
            }
        },
    );
}

/// ClearanceGradients of the distances of clearances at the listed times, and the variables that they serve.
struct ClearanceGradients {
    /// By block of eight output times and clearance; empty if no clearance is listed, or nothing is differentiated by.
    batches: Vec<Option<GradientBatch>>,
    /// Number of clearances.
    clearances: usize,
    /// By variable and shape: true if the variable moves the shape by its points only.
    by_points: Vec<Vec<bool>>,
}

impl ClearanceGradients {
    fn of(
        design: &MeasuredDesign<'_>,
        outputs: &[Output],
        listed: &[(usize, usize)],
        (motion, sensitivities): (&Motion, &Sensitivities),
        nearest: &[NearestPair],
    ) -> Self {
        let model = design.model;
        let clearances = model.clearances.len();
        let mut found = Self { batches: Vec::new(), clearances, by_points: Vec::new() };
        let asked = |m: usize| clearance_of(model, outputs[m].source);
        if sensitivities.variables == 0 || !listed.iter().any(|(_, m)| asked(*m).is_some()) {
            return found;
        }
        found.batches.resize_with(motion.len().div_ceil(LANES) * clearances, || None);
        let fixed = design.design_map.fixed(design.values).map(Jet::constant);
        let mut bodies = MovingBodies::of(model);
        for listed in listed.chunk_by(|a, b| a.0 == b.0) {
            let first = listed[0].0;
            let asked: Vec<ClearanceId> = listed.iter().filter_map(|(_, m)| asked(*m)).collect();
            let mut at: Vec<Vec<Option<DistanceGradient>>> = asked.iter().map(|_| Vec::new()).collect();
            for k in first..usize::min(first + LANES, motion.len()) {
                bodies.set(motion.at(k));
                let shapes = PlacedShapes { model, fixed: &fixed, bodies: &bodies };
                for (of, at) in asked.iter().zip(&mut at) {
                    let known = nearest.get(k * clearances + of.0).copied();
                    let pair = known.unwrap_or_else(|| shapes.nearest_pair(*of));
                    at.push(pair.and_then(|(n, near)| {
                        DistanceGradient::of(&shapes, model.clearances[of.0].pairs[n].shapes, &near)
                    }));
                }
            }
            for (of, at) in asked.iter().zip(at) {
                found.batches[first / LANES * clearances + of.0] = Some(GradientBatch::of(first, at));
            }
        }
        found
    }

    fn batch(&self, of: ClearanceId, k: usize) -> Option<&GradientBatch> {
        self.batches.get(k / LANES * self.clearances + of.0)?.as_ref()
    }

    /// True if the derivative of a clearance by a variable at output time k is that of the gradient.
    fn serves(&self, of: ClearanceId, k: usize, b: usize) -> bool {
        let shapes = self.batch(of, k).and_then(|batch| batch.shapes(k));
        shapes.is_some_and(|shapes| shapes.iter().all(|s| self.by_points[b][s.0]))
    }

    /// Writes the derivatives that gradients serve; returns what is listed and has others.
    fn write(
        &mut self,
        design: &MeasuredDesign<'_>,
        outputs: &[Output],
        listed: &[(usize, usize)],
        run: (&Motion, &Sensitivities),
        out: &mut impl FnMut(usize, usize, usize, [f64; 3]),
    ) -> Vec<(usize, usize)> {
        if self.batches.is_empty() {
            return listed.to_vec();
        }
        let &MeasuredDesign { model, design_map, values, .. } = design;
        let of = |m: usize| clearance_of(model, outputs[m].source);
        let mut has_others: Vec<bool> = listed.iter().map(|(_, m)| of(*m).is_none()).collect();
        let mut values: Vec<Dual> = values.iter().map(|v| Dual::constant(*v)).collect();
        let (motion, sensitivities) = run;
        for b in 0..sensitivities.variables {
            values[b] = Dual::variable(values[b].v);
            let fixed = design_map.fixed(&values);
            values[b] = Dual::constant(values[b].v);
            let by_points = (0..model.shapes.len()).map(|s| moves_points_only(model, &fixed, ShapeId(s)));
            self.by_points.push(by_points.collect());
            for (&(first, m), has_others) in listed.iter().zip(&mut has_others) {
                let served = of(m).and_then(|of| Some((of, self.batch(of, first)?)));
                let Some((of, batch)) = served.filter(|_| sensitivities.at(first, b).is_some()) else {
                    continue;
                };
                let [value, rate, acceleration] = batch.by(VariableId(b), run, &fixed);
                for (lane, k) in (first..usize::min(first + LANES, motion.len())).enumerate() {
                    if self.serves(of, k, b) {
                        out(k, b, m, [value[lane], rate[lane], acceleration[lane]]);
                    } else {
                        *has_others = true;
                    }
                }
            }
        }
        listed.iter().zip(has_others).filter(|(_, others)| *others).map(|(listed, _)| *listed).collect()
    }
}

/// Number that has the derivatives of an output by a variable.
trait OutputDerivatives: Real {
    /// True if positions are at rest, so that their derivatives have no rates. Output times whose derivatives nobody
    /// needs are left out then: their sensitivities are NaN.
    const AT_REST: bool;

    /// A number that is constant over time.
    fn over_time(x: Dual) -> Self;

    /// A measure by a driver, which has a value and its derivative, but no rates.
    fn of_step(x: f64, d: f64) -> Self;

    /// Pose of a body.
    fn pose(s: &BodyState, d: &BodySensitivity) -> Pose<Self>;

    /// Derivatives of the value, its rate and its acceleration; NaN where there are none.
    fn derivatives(self) -> [f64; 3];
}

impl OutputDerivatives for Dual {
    const AT_REST: bool = true;

    fn over_time(x: Dual) -> Self {
        x
    }

    fn of_step(v: f64, d: f64) -> Self {
        Dual { v, d }
    }

    fn pose(s: &BodyState, d: &BodySensitivity) -> Pose<Self> {
        at_rest(s, d)
    }

    fn derivatives(self) -> [f64; 3] {
        only(self.d).0
    }
}

impl OutputDerivatives for Dual<Rates> {
    const AT_REST: bool = false;

    #[inline(always)]
    fn over_time(x: Dual) -> Self {
        Dual { v: Jet::constant(x.v), d: Jet::constant(x.d) }
    }

    #[inline(always)]
    fn of_step(x: f64, d: f64) -> Self {
        Dual { v: only(x), d: only(d) }
    }

    #[inline(always)]
    fn pose(s: &BodyState, d: &BodySensitivity) -> Pose<Self> {
        with_sensitivity(s, d)
    }

    #[inline(always)]
    fn derivatives(self) -> [f64; 3] {
        self.d.0
    }
}

/// Calls `each` with the formulas at every output time that is listed, for every variable, and with the body-fixed
/// data, output time, variable and listed outputs; without formulas at output times that were left out. These bodies
/// are placed.
#[inline(always)]
fn each_step<T: OutputDerivatives>(
    design: &MeasuredDesign<'_>,
    listed: &[(usize, usize)],
    (motion, sensitivities): (&Motion, &Sensitivities),
    bodies: &[usize],
    more: &Context<'_>,
    mut each: impl FnMut(Option<&Instant<'_, T>>, &BodyFixed<T>, usize, usize, &[(usize, usize)]),
) {
    let &MeasuredDesign { model, design_map, values, .. } = design;
    let (measures, clearances) = (model.measures.len(), model.clearances.len());
    let mut poses = vec![Pose::IDENTITY.spread(); model.bodies.len()];
    let mut values: Vec<Dual> = values.iter().map(|v| Dual::constant(*v)).collect();
    let (mut given, mut whole_turns): (Vec<T>, Vec<T>) = (Vec::new(), Vec::new());
    for b in (0..sensitivities.variables).filter(|_| !listed.is_empty()) {
        // d/db of body-fixed data; the derivative of the poses is W at this time.
        values[b] = Dual::variable(values[b].v);
        let fixed = design_map.fixed(&values).map(T::over_time);
        values[b] = Dual::constant(values[b].v);
        for listed in listed.chunk_by(|a, b| a.0 == b.0) {
            let first = listed[0].0;
            for k in first..usize::min(first + LANES, motion.len()) {
                let Some(d) = sensitivities.at(k, b) else { break };
                let states = motion.at(k);
                if T::AT_REST && bodies.iter().any(|&b| d.body(b).dpi.x.is_nan()) {
                    each(None, &fixed, k, b, listed);
                    continue;
                }
                bodies.iter().for_each(|&b| poses[b] = T::pose(&states.body(b), &d.body(b)));
                given.clear();
                given.extend(more.slopes.at(k).zip(more.slopes.d(k, b)).map(|(x, d)| T::of_step(x, d)));
                let turns = more.whole_turns.get(k * measures..).unwrap_or_default();
                whole_turns.clear();
                whole_turns.extend(turns.iter().take(measures).map(|turns| T::constant(*turns)));
                let nearest = more.nearest.get(k * clearances..(k + 1) * clearances).unwrap_or_default();
                let instant = Instant {
                    slopes: &given,
                    whole_turns: &whole_turns,
                    nearest,
                    ..Instant::new(model, &fixed, &poses)
                };
                each(Some(&instant), &fixed, k, b, listed);
            }
        }
    }
}

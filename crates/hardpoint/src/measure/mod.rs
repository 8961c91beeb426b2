//! Measures and followed points, with rates and sensitivities.
//!
//! A measure is written once, over any [`Real`]; its rate, acceleration and the design derivatives of all three follow
//! by the product and chain rules where it runs on [`Rates`].
//!
//! Formulas, symbols and signs are those of `docs/measures.md`; a number represents value, rate and acceleration, and
//! for the derivative by a design variable of all three (`docs/theory.md`, section 9).

mod bodies;
mod program;
mod slope;
mod step_values;
mod turns;
mod wheel;

use std::collections::BTreeMap;
use std::ops::Range;

pub(crate) use bodies::with_rates;
use bodies::with_sensitivity;
use hardpoint_tape::{LANES, Lanes};
use program::MeasureRun;
pub(crate) use program::{MeasureProgram, ProgramKey, dependences};
pub(crate) use slope::{Slopes, hindrance};
pub(crate) use step_values::{RecordedValue, RecordedValues, StepValues};
use turns::{PathAngle, path_angles};
pub(crate) use turns::{PathAngles, is_counted_of_element};
pub(crate) use wheel::WheelAt;
use wheel::{camber, toe};

use crate::blocks::Blocks;
use crate::constraint::Row;
use crate::design::{BodyFixed, DesignMap};
use crate::law::Law;
use crate::model::{
    ArmPlane, AxleMeasure, BodyId, Dimension, DriverId, JointId, KnownOrders, MeasureKind, Model,
    OutputSource, PointId, Ray, VariableId, WheelId,
};
use crate::motion::Motion;
use crate::motion::turns::turned;
use crate::number::{Dual, Jet, Rates, Real};
use crate::sensitivity::{Admissibility, Sensitivities};
use crate::space::{Pose, Vec3};
use crate::topology::{CoordinateId, Topology};

/// A column of [`MeasureResults`].
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// `toe` for a measure, `wheel_centre.z` for a point's component.
    pub name: String,
    /// Dimension of the value.
    pub dimension: Dimension,
    /// Known time derivatives.
    pub known: KnownOrders,
    /// Source of the output.
    pub source: OutputSource,
}

impl Output {
    /// Name of the time derivative of order 0, 1 or 2: `toe`, `toe rate`, `toe acceleration`; for a point's component
    /// `tip.x`, `tip.vx`, `tip.ax`.
    pub fn order_name(&self, order: usize) -> String {
        match (self.source, self.name.rsplit_once('.')) {
            (_, _) if order == 0 => self.name.clone(),
            (OutputSource::Point(..), Some((point, axis))) => {
                format!("{point}.{}{axis}", ["", "v", "a"][order])
            }
            _ => format!("{} {}", self.name, ["", "rate", "acceleration"][order]),
        }
    }
}

/// Measures and point components over a motion, with their sensitivities.
#[derive(Clone, Debug, Default)]
pub struct MeasureResults {
    /// The columns: all measures, then x, y, z of all named points.
    pub outputs: Vec<Output>,
    /// Number of design variables.
    pub variables: usize,
    /// Output times.
    steps: usize,
    /// Per output, value, rate and acceleration; m or rad, per s, per s^2.
    values: Blocks,
    /// Derivatives of those by the variables at fixed t.
    d: Blocks,
    /// `places[b * outputs + m]`: index of the first derivative of output m by variable b; `None` if they are all zero.
    places: Vec<Option<usize>>,
    /// Variables that there are no derivatives by.
    unknown: Vec<bool>,
    by_formula: usize,
}

impl MeasureResults {
    /// The column of that name.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.outputs.iter().position(|o| o.name == name)
    }

    /// Value, rate and acceleration of output m at time k.
    ///
    /// Those beyond [`KnownOrders::orders`] are NaN, and so is what has no number at that time: the curvature of a path
    /// where its point rests, the instant centre of a body that does not turn.
    pub fn value(&self, k: usize, m: usize) -> [f64; 3] {
        let row = self.values.row(k);
        std::array::from_fn(|order| finite(row.get(3 * m + order)))
    }

    /// Derivatives by variable b; NaN if the variable is not admissible, see [`Sensitivities::admissibility`].
    pub fn d(&self, k: usize, b: VariableId, m: usize) -> [f64; 3] {
        if self.unknown[b.0] {
            return [f64::NAN; 3];
        }
        let Some(place) = self.places[b.0 * self.outputs.len() + m] else {
            let orders = self.outputs[m].known.orders;
            return std::array::from_fn(|order| if order < orders { 0.0 } else { f64::NAN });
        };
        let row = self.d.row(k);
        std::array::from_fn(|order| finite(row.get(place + order)))
    }

    /// One of them: of the value (`order` 0), the rate (1) or the acceleration (2).
    #[inline]
    pub fn derivative(&self, k: usize, b: VariableId, m: usize, order: usize) -> f64 {
        if self.unknown[b.0] {
            return f64::NAN;
        }
        match self.places[b.0 * self.outputs.len() + m] {
            Some(place) => finite(self.d.row(k).get(place + order)),
            None if order < self.outputs[m].known.orders => 0.0,
            None => f64::NAN,
        }
    }

    /// Number of output times.
    pub fn len(&self) -> usize {
        if self.outputs.is_empty() { 0 } else { self.steps }
    }

    /// True if there is nothing.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of values, over all outputs and output times, that formulas evaluated one by one and not a program:
    /// round-off apart, the numbers are the same.
    pub fn by_formula(&self) -> usize {
        self.by_formula
    }

    /// Resizes for these outputs at this number of times, within the memory at hand; `layout` gives the positions and
    /// the number of the derivatives.
    fn shape(
        &mut self,
        outputs: Vec<Output>,
        variables: usize,
        layout: (Vec<Option<usize>>, usize),
        steps: usize,
    ) {
        self.values.shape(3 * outputs.len(), steps);
        self.d.shape(layout.1, steps);
        (self.outputs, self.variables, self.places, self.steps) = (outputs, variables, layout.0, steps);
        self.by_formula = 0;
        self.unknown.clear();
        self.unknown.resize(variables, false);
    }

    fn set(&mut self, k: usize, m: usize, numbers: [f64; 3]) {
        self.values.set(k, 3 * m, numbers);
    }

    /// Stores derivatives, if they have a position.
    pub fn set_d(&mut self, k: usize, b: VariableId, m: usize, numbers: [f64; 3]) {
        if let Some(place) = self.places[b.0 * self.outputs.len() + m] {
            self.d.set(k, place, numbers);
        }
    }

    /// Copies measures that need more of a step than the motion of its bodies, at the eight output times from k on.
    /// Their rates are unknown; a program has stored them as such.
    fn take_given(&mut self, k: usize, given: &StepValues, by_program: bool) {
        let Some(block) = given.block(k) else { return };
        let outputs = self.outputs.len();
        let (values, derivatives) = (self.values.block_mut(k), self.d.block_mut(k));
        let enter = |to: &mut [Lanes], x: &Lanes| {
            to[0] = *x;
            if !by_program {
                to[1..3].fill([f64::NAN; LANES]);
            }
        };
        let (now, changes) = block.split_at(given.measures().len());
        for (&m, x) in given.measures().iter().zip(now) {
            enter(&mut values[3 * m..], x);
        }
        for (places, changes) in
            self.places.chunks_exact(outputs).zip(changes.chunks_exact(given.measures().len()))
        {
            for (&m, x) in given.measures().iter().zip(changes) {
                if let Some(place) = places[m] {
                    enter(&mut derivatives[place..], x);
                }
            }
        }
    }

    /// Appends output time k of another one, all outputs or those named.
    pub(crate) fn take_over(&mut self, from: &Self, k: usize, outputs: Option<&[OutputSource]>) {
        let wanted = |m: &usize| outputs.is_none_or(|list| list.contains(&from.outputs[*m].source));
        let columns: Vec<usize> = (0..from.outputs.len()).filter(wanted).collect();
        if self.outputs.is_empty() {
            let mut width = 0;
            let pairs =
                (0..from.variables).flat_map(|b| columns.iter().map(move |m| b * from.outputs.len() + m));
            let place = |pair: usize| {
                from.places[pair].map(|_| {
                    width += 3;
                    width - 3
                })
            };
            let places = pairs.map(place).collect();
            let outputs = columns.iter().map(|m| from.outputs[*m].clone()).collect();
            self.shape(outputs, from.variables, (places, width), 0);
        }
        let row = self.steps;
        self.steps += 1;
        for (m, &column) in columns.iter().enumerate() {
            self.set(row, m, from.value(k, column));
            for b in (0..from.variables).map(VariableId) {
                self.set_d(row, b, m, from.d(k, b, column));
            }
        }
    }

    /// Drops every second output time.
    pub(crate) fn thin(&mut self) {
        self.values.thin(self.steps);
        self.d.thin(self.steps);
        self.steps = self.steps.div_ceil(2);
    }

    /// There are no derivatives by these variables.
    pub(crate) fn forget(&mut self, variables: impl IntoIterator<Item = usize>) {
        self.unknown.resize(self.variables, false);
        variables.into_iter().for_each(|v| self.unknown[v] = true);
    }
}

/// Derivatives of that many outputs by that many variables, all of them.
fn dense(outputs: usize, variables: usize) -> (Vec<Option<usize>>, usize) {
    let all = outputs * variables;
    ((0..all).map(|n| Some(3 * n)).collect(), 3 * all)
}

/// The columns that a model's measures and points give.
pub fn outputs(model: &Model) -> Vec<Output> {
    let output = |source| Output {
        name: model.output_name(source),
        dimension: model.dimension(source),
        known: model.known(source),
        source,
    };
    let measures = (0..model.measures.len()).map(OutputSource::Measure);
    let points = (0..model.points.len()).filter(|k| !model.points[*k].unnamed);
    let components = points.flat_map(|k| (0..3).map(move |axis| OutputSource::Point(PointId(k), axis)));
    measures.chain(components).map(output).collect()
}

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
    let FormulaEvaluator { left, counted, .. } = formulas;
    let more = Context { slopes, whole_turns: &counted };
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
        let Self { model, motion, fixed, bodies, poses, left, given, whole_turns, .. } = self;
        let left = &left[begins..];
        let place = |poses: &mut [Pose<Rates>]| {
            let states = motion.at(k);
            bodies.iter().for_each(|&b| poses[b] = with_rates(&states.body(b)));
        };
        if !left.is_empty() {
            place(poses);
        }
        given.clear();
        if !left.is_empty() {
            given.extend(self.slopes.at(k).map(only));
        }
        let instant = Instant { slopes: given, ..Instant::new(model, fixed, poses) };
        for &(_, m) in left {
            measured.set(k, m, instant.output(measured.outputs[m].source).0);
        }
        whole_turns.clear();
        whole_turns.resize(model.measures.len(), Jet([0.0; 3]));
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
    let &MeasuredDesign { model, design_map, values, .. } = design;
    let bodies = bodies_asked_for(model);
    let mut poses = vec![Pose::IDENTITY.spread(); model.bodies.len()];
    let mut values: Vec<Dual> = values.iter().map(|v| Dual::constant(*v)).collect();
    let (mut given, mut whole_turns): (Vec<Dual<Rates>>, Vec<Dual<Rates>>) = (Vec::new(), Vec::new());
    for b in (0..sensitivities.variables).filter(|_| !listed.is_empty()) {
        // d/db of body-fixed data; the derivative of the poses is W at this time, by `with_sensitivity`.
        values[b] = Dual::variable(values[b].v);
        let fixed = design_map.fixed(&values);
        let fixed = fixed.map(|x| Dual { v: Jet::constant(x.v), d: Jet::constant(x.d) });
        values[b] = Dual::constant(values[b].v);
        for listed in listed.chunk_by(|a, b| a.0 == b.0) {
            let first = listed[0].0;
            for k in first..usize::min(first + LANES, motion.len()) {
                let Some(d) = sensitivities.at(k, b) else { break };
                let states = motion.at(k);
                bodies.iter().for_each(|&b| poses[b] = with_sensitivity(&states.body(b), &d.body(b)));
                given.clear();
                let both = more.slopes.at(k).zip(more.slopes.d(k, b));
                // A measure by a driver has a value and its derivative by b, but no rates.
                given.extend(both.map(|(x, d)| Dual { v: only(x), d: only(d) }));
                let turns = more.whole_turns.get(k * model.measures.len()..).unwrap_or_default();
                whole_turns.clear();
                whole_turns.extend(
                    turns
                        .iter()
                        .take(model.measures.len())
                        .map(|turns| Dual::constant(Rates::constant(*turns))),
                );
                let instant = Instant {
                    slopes: &given,
                    whole_turns: &whole_turns,
                    ..Instant::new(model, &fixed, &poses)
                };
                for &(_, m) in listed {
                    out(k, b, m, instant.output(outputs[m].source).d.0);
                }
            }
        }
    }
}

/// NaN at the pole of a formula; otherwise the number.
pub(crate) fn finite(x: f64) -> f64 {
    if x.is_finite() { x } else { f64::NAN }
}

/// Source of the number of whole turns of a joint's angle.
enum Turns {
    /// The driver's law.
    Driver(DriverId),
    /// The tree coordinate, which is the angle itself.
    Coordinate(CoordinateId),
    /// The path alone, for a cut joint or an angle between two directions about an axis.
    Path(PathTurns),
}

/// An angle whose turns are counted along the path.
#[derive(Clone, Copy)]
struct PathTurns {
    /// Place among the angles that were counted, where the path was followed.
    angle: Option<CountedPlace>,
    /// Value where the path begins; as it is measured, without a whole turn, where that is `None`.
    origin: Option<f64>,
}

/// A place among all counted angles.
#[derive(Clone, Copy)]
struct CountedPlace {
    place: usize,
    of: usize,
}

/// The outputs that are counted angles, and what indicates their turns.
fn turns(model: &Model, topology: &Topology, outputs: &[Output]) -> Vec<Option<Turns>> {
    let mut link_of = vec![None; model.joints.len()];
    for link in &topology.links {
        if let Some(j) = link.joint {
            link_of[j.0] = Some(link);
        }
    }
    let driver_of: BTreeMap<_, _> =
        model.drivers.iter().enumerate().map(|(k, d)| ((d.joint, d.coordinate), DriverId(k))).collect();
    let path = |origin| Turns::Path(PathTurns { angle: None, origin });
    let of_joint = |joint: JointId, coordinate: usize| {
        if let Some(&d) = driver_of.get(&(joint, coordinate)) {
            return Turns::Driver(d);
        }
        let freedom = model.joints[joint.0].kind.coordinates[coordinate].freedom;
        let Some((link, freedom)) = link_of[joint.0].zip(freedom) else { return path(Some(0.0)) };
        Turns::Coordinate(link.coordinate_of(freedom))
    };
    let of_output = |output: &Output| match output.source {
        OutputSource::Measure(m) if is_counted(model, output) => match model.measures[m].kind {
            MeasureKind::Coordinate { joint, coordinate } => Some(of_joint(joint, coordinate)),
            _ => Some(path(None)),
        },
        _ => None,
    };
    outputs.iter().map(of_output).collect()
}

/// The same, with the places of what was counted along the path of this motion.
fn placed_turns(
    model: &Model,
    topology: &Topology,
    motion: &Motion,
    outputs: &[Output],
) -> Vec<Option<Turns>> {
    let mut turns = turns(model, topology, outputs);
    if !motion.counted.is_empty() {
        let angles = path_angles(model, topology, true);
        for (place, angle) in angles.iter().enumerate() {
            if let PathAngle::Measure(m) = *angle
                && let Some(Turns::Path(path)) = &mut turns[m]
            {
                path.angle = Some(CountedPlace { place, of: angles.len() });
            }
        }
    }
    turns
}

/// True if an output is a formula over others, or the rate of one: what depends on angles with all their turns.
fn is_formula(model: &Model, output: usize) -> bool {
    match model.measures.get(output).map(|m| &m.kind) {
        Some(MeasureKind::Combination { .. }) => true,
        Some(MeasureKind::Rate { of: OutputSource::Measure(m) }) => is_formula(model, *m),
        _ => false,
    }
}

/// True if an output is an angle that is counted through turns.
fn is_counted(model: &Model, output: &Output) -> bool {
    let OutputSource::Measure(m) = output.source else { return false };
    match model.measures[m].kind {
        MeasureKind::Coordinate { .. } => output.dimension == Dimension::ANGLE,
        MeasureKind::Angle { about: Some(_), .. } => true,
        MeasureKind::Orientation { angle, .. } => angle.is_counted(),
        _ => false,
    }
}

/// Counts whole turns of angles.
fn unwrap_angles(
    laws: &[Law],
    motion: &Motion,
    k: usize,
    turns: &[Option<Turns>],
    measured: &mut MeasureResults,
    mut counted: impl FnMut(usize, f64),
) {
    for (m, turns_of) in turns.iter().enumerate() {
        let Some(turns_of) = turns_of else { continue };
        let [now, rate, acceleration] = measured.value(k, m);
        let near = match *turns_of {
            // Near f(t), q of the tree, or the angle that was counted along the path
            Turns::Driver(d) => laws[d.0].at(motion.times[k]).value(),
            Turns::Coordinate(q) => motion.coordinates.row(k).get(q.0),
            Turns::Path(PathTurns { angle: Some(at), .. }) => motion.counted[k * at.of + at.place],
            Turns::Path(PathTurns { angle: None, origin }) => match k {
                // Designs side by side begin in the design configuration.
                0 => origin.unwrap_or(now),
                _ => {
                    let [before, rate_before, _] = measured.value(k - 1, m);
                    // x + h (x. before + x. now) / 2: wrong by h^3 x... / 12, where anything below half a turn is right
                    before + 0.5 * (motion.times[k] - motion.times[k - 1]) * (rate_before + rate)
                }
            },
        };
        let value = turned(now, near);
        measured.set(k, m, [value, rate, acceleration]);
        counted(m, value - now);
    }
}

/// Input data of measures at one time, as numbers with the requested derivatives.
#[derive(Clone, Copy)]
pub(crate) struct Instant<'a, T> {
    model: &'a Model,
    fixed: &'a BodyFixed<T>,
    /// Per body: where it is. Only those that measures name count.
    poses: &'a [Pose<T>],
    /// Per measure: its value, where it depends on a driver; empty where these are not known.
    slopes: &'a [T],
    /// Per measure: the whole turns, rad, that its angle has made; empty where they are not counted.
    whole_turns: &'a [T],
}

impl<'a, T: Real> Instant<'a, T> {
    /// Outputs of bodies at these poses.
    pub fn new(model: &'a Model, fixed: &'a BodyFixed<T>, poses: &'a [Pose<T>]) -> Self {
        Self { model, fixed, poses, slopes: &[], whole_turns: &[] }
    }

    /// All outputs, in the order of [`outputs`].
    pub fn all(&self, mut out: impl FnMut(T)) {
        for k in 0..self.model.measures.len() {
            out(self.measure(k));
        }
        for (k, _) in self.model.points.iter().enumerate().filter(|(_, p)| !p.unnamed) {
            let p = self.point(PointId(k));
            out(p.x);
            out(p.y);
            out(p.z);
        }
    }

    /// One output.
    pub fn output(&self, output: OutputSource) -> T {
        match output {
            OutputSource::Measure(k) => self.measure(k),
            OutputSource::Point(p, axis) => {
                let Vec3 { x, y, z } = self.point(p);
                [x, y, z][axis]
            }
        }
    }

    fn point(&self, p: PointId) -> Vec3<T> {
        // P = r + A s
        self.poses[self.model.points[p.0].body.0].point(self.fixed.points[p.0])
    }

    /// Formulas and signs: `docs/measures.md`.
    fn measure(&self, k: usize) -> T {
        let unknown = || T::constant(f64::NAN);
        if self.model.depends_on_step(k) {
            return self.slopes.get(k).copied().unwrap_or_else(unknown);
        }
        match &self.model.measures[k].kind {
            MeasureKind::Coordinate { joint, coordinate } => {
                let wrapped = self.coordinate(k, *joint, *coordinate);
                self.whole_turns.get(k).map_or(wrapped, |turns| wrapped + *turns)
            }
            // abs(P_to - P_from)
            MeasureKind::Distance { from, to } => (self.point(*to) - self.point(*from)).norm(),
            MeasureKind::Coordinates { point, along } => {
                // n . P
                let p = self.point(*point);
                along.spread().dot(p)
            }
            MeasureKind::Angle { from, to, about } => {
                let [a, b] = self.rays(k, [from, to]);
                // atan2(abs(a x b), a . b); about n, for the projections along it:
                // atan2(n . (a x b), a . b - (n . a) (n . b))
                let (across, along) = (a.cross(b), a.dot(b));
                let within = match about {
                    None => across.norm().atan2(along),
                    Some(n) => {
                        let n = n.spread();
                        n.dot(across).atan2(along - n.dot(a) * n.dot(b))
                    }
                };
                self.whole_turns.get(k).map_or(within, |turns| within + *turns)
            }
            MeasureKind::Orientation { body, angle, relative_to } => {
                // A_j, or A_i^T A_j
                let rot = self.poses[body.0].rot;
                let rot = relative_to.map_or(rot, |i| self.poses[i.0].rot.transpose() * rot);
                let within = angle.angles.of(rot)[angle.place];
                self.whole_turns.get(k).map_or(within, |turns| within + *turns)
            }
            MeasureKind::TransmissionAngle { from, to } => {
                let [a, b] = self.rays(k, [from, to]);
                // atan2(abs(a x b), abs(a . b)): between lines, 0 to 90 deg
                a.cross(b).norm().atan2(a.dot(b).abs())
            }
            // n . v or abs(v),    n . omega or abs(omega),    n . a or abs(a)
            MeasureKind::Velocity { point, along } => component(self.point(*point).map(T::rate), *along),
            MeasureKind::AngularVelocity { body, along } => component(self.angular_velocity(*body), *along),
            MeasureKind::Acceleration { point, along } => {
                component(self.point(*point).map(T::rate).map(T::rate), *along)
            }
            MeasureKind::Curvature { point, about } => {
                let v = self.point(*point).map(T::rate);
                let a = v.map(T::rate);
                // n . (v x a) / abs(v)^3, or abs(v x a) / abs(v)^3; NaN if v^2 <= 1e-12 abs(a) size, for a point that
                // starts from rest
                let (turn, speed) = (v.cross(a), v.norm());
                let turn = about.map_or_else(|| turn.norm(), |about| about.spread().dot(turn));
                let (way, far) = (speed * speed, a.norm() * T::constant(RESTS * self.fixed.size));
                let way = if way.exceeds(far) { way } else { unknown() };
                turn / (way * speed)
            }
            MeasureKind::Rate { of } => self.output(*of).rate(),
            MeasureKind::Combination { expression } => expression.at(|source| self.output(source)),
            MeasureKind::Toe { body, spin_axis } => {
                // atan2(e_x, s e_y) and -asin(e_z)
                let side = self.model.side_of_axis(*spin_axis);
                toe(self.direction(k, 0, *body), T::constant(side.sign()))
            }
            MeasureKind::Camber { body, .. } => camber(self.direction(k, 0, *body)),
            MeasureKind::Wheel { wheel, what } => {
                let now = self.wheel(k, 0, *wheel);
                now.measure(*what, || self.wheel_as_drawn(k, 0, *wheel))
            }
            MeasureKind::Axle { axle, what } => self.axle(k, self.model.axles[axle.0].wheels, *what),
            // What depends on the step, above.
            MeasureKind::Slope { .. }
            | MeasureKind::DriverForce { .. }
            | MeasureKind::DriverPower { .. }
            | MeasureKind::Reaction { .. }
            | MeasureKind::SpringForce { .. }
            | MeasureKind::KineticEnergy { .. }
            | MeasureKind::ShakingForce { .. }
            | MeasureKind::ShakingMoment { .. }
            | MeasureKind::Compliance { .. } => unknown(),
        }
    }

    /// A body's angular velocity, global.
    fn angular_velocity(&self, body: BodyId) -> Vec3<T> {
        // a. = omega x a of each axis, so  sum a x a. = 3 omega - sum a (a . omega) = 2 omega
        let turns = self.poses[body.0].rot.cols.map(|a| a.cross(a.map(T::rate)));
        (turns[0] + turns[1] + turns[2]) * T::constant(0.5)
    }

    /// The directions of an angle, of any length.
    fn rays(&self, k: usize, rays: [&Ray; 2]) -> [Vec3<T>; 2] {
        [0, 1].map(|end| match *rays[end] {
            Ray::Between([from, to]) => self.point(to) - self.point(from),
            Ray::Fixed { body, .. } => self.direction(k, end, body),
        })
    }

    /// Formulas and signs: `docs/measures.md`.
    fn axle(&self, k: usize, wheels: [WheelId; 2], what: AxleMeasure) -> T {
        let [left, right] = [0, 1].map(|side| self.wheel(k, side, wheels[side]));
        let toe = |wheel: &WheelAt<T>| toe(wheel.spin_axis, wheel.side);
        let half = T::constant(0.5);
        let wheelbase = || T::constant(self.model.vehicle.wheelbase.unwrap_or(f64::NAN));
        let track = left.contact().y - right.contact().y;
        // Headings to the left are a = -toe_L and b = toe_R, with mean (a + b) / 2. In a turn of either direction the
        // heading of the inner wheel is i = (abs(a + b) + a - b) / 2, of the outer one o = (abs(a + b) - a + b) / 2.
        let turning = || {
            let (a, b) = (-toe(&left), toe(&right));
            let (sum, apart) = ((a + b).abs(), (a - b) * half);
            // Straight ahead inner and outer wheel change, which is a kink: derivatives by the design are the mean of
            // those of both sides, and while the axle steers through it there are no rates.
            let mean = if sum.exceeds(T::constant(KINK)) {
                sum * half
            } else if (a + b).rate().abs().exceeds(T::constant(KINK)) {
                T::zero().rate().rate()
            } else {
                T::zero()
            };
            (mean, mean + apart, mean - apart)
        };
        match what {
            AxleMeasure::Track => track,
            AxleMeasure::TotalToe => toe(&left) + toe(&right),
            AxleMeasure::AckermannError => {
                let (_, inner, outer) = turning();
                // o - r
                outer - outer_by_ackermann(inner, track / wheelbase())
            }
            AxleMeasure::Ackermann => {
                let (mean, inner, outer) = turning();
                // (i - o) / (i - r)
                let full = inner - outer_by_ackermann(inner, track / wheelbase());
                (inner - outer) / beyond(full, mean, STEERS)
            }
            AxleMeasure::TurningRadius => {
                let (_, inner, outer) = turning();
                // The outer wheel steers less, or against Ackermann the inner one.
                let least = -(-inner).larger(-outer);
                // wheelbase / sin(the lesser heading)
                wheelbase() / beyond(least.sin_cos().0, least, STRAIGHT)
            }
            AxleMeasure::RollCentreY | AxleMeasure::RollCentreHeight => T::constant(f64::NAN),
        }
    }

    /// The wheel whose spin axis is direction d of measure k.
    fn wheel(&self, k: usize, d: usize, wheel: WheelId) -> WheelAt<T> {
        self.wheel_at(k, d, wheel, |b| self.poses[b.0])
    }

    /// The same in the design configuration.
    fn wheel_as_drawn(&self, k: usize, d: usize, wheel: WheelId) -> WheelAt<T> {
        self.wheel_at(k, d, wheel, |b| self.model.bodies[b.0].frame.spread())
    }

    fn wheel_at(&self, k: usize, d: usize, wheel: WheelId, pose: impl Fn(BodyId) -> Pose<T>) -> WheelAt<T> {
        let wheel = &self.model.wheels[wheel.0];
        let point = |p: PointId| pose(self.model.points[p.0].body).point(self.fixed.points[p.0]);
        let centre = point(wheel.centre);
        WheelAt {
            centre,
            // e = A e', e' fixed in the knuckle
            spin_axis: pose(wheel.body).rot * self.fixed.directions[k][d].expect("a wheel has a spin axis"),
            radius: T::constant(wheel.radius),
            side: T::constant(wheel.side.sign()),
            kingpin: wheel.kingpin.map(|points| points.map(point)),
            planes: wheel.planes.map(|planes| {
                planes.map(|plane| match plane {
                    // (B - A) x (C - A),    B - A
                    ArmPlane::Through(points) => {
                        let [a, b, c] = points.map(point);
                        [(b - a).cross(c - a), a]
                    }
                    ArmPlane::Square(points) => {
                        let [a, b] = points.map(point);
                        [b - a, a]
                    }
                })
            }),
            // abs(P_2 - P_1)
            spring: wheel.spring.map(|ends| {
                let [a, b] = ends.map(point);
                (b - a).norm()
            }),
        }
    }

    /// Direction d of measure k, which is fixed in this body.
    fn direction(&self, k: usize, d: usize, body: BodyId) -> Vec3<T> {
        // a = A a'
        self.poses[body.0].rot * self.fixed.directions[k][d].expect("a measure with directions")
    }

    /// A joint's coordinate between its two markers, whether the joint is cut or not.
    fn coordinate(&self, k: usize, joint: JointId, coordinate: usize) -> T {
        let j = &self.model.joints[joint.0];
        let markers = self.fixed.markers[k].expect("a measure of a joint's coordinate");
        // Axes and origins of the joint's markers: A C e_k and r + A s
        let axis = |end: usize, k: usize| self.poses[j.bodies[end].0].rot * markers[end].rot.cols[k];
        let origin = |end: usize| self.poses[j.bodies[end].0].point(markers[end].r);
        match j.kind.coordinates[coordinate].row {
            // atan2(y_i . x_j, x_i . x_j)
            Row::Angle | Row::Heading => axis(0, 1).dot(axis(1, 0)).atan2(axis(0, 0).dot(axis(1, 0))),
            // atan2(z_i . y_j, z_i . z_j)
            Row::AngleOnJ => axis(0, 2).dot(axis(1, 1)).atan2(axis(0, 2).dot(axis(1, 2))),
            // atan2(y_i . z_j, x_i . z_j)
            Row::Course => axis(0, 1).dot(axis(1, 2)).atan2(axis(0, 0).dot(axis(1, 2))),
            // a_i . (P_j - P_i)
            Row::Dot2(k) => axis(0, k).dot(origin(1) - origin(0)),
            // abs(P_j - P_i)
            _ => (origin(1) - origin(0)).norm(),
        }
    }
}

/// The component of a vector along a unit vector, or its magnitude.
fn component<T: Real>(v: Vec3<T>, along: Option<Vec3>) -> T {
    along.map_or_else(|| v.norm(), |along| along.spread().dot(v))
}

/// A point that came from rest, at its acceleration, within this part of the mechanism's size rests: its speed is
/// round-off, and its path has no curvature there.
const RESTS: f64 = 1e-12;

/// A wheel that heads less into the turn than this, rad, drives straight ahead: the turning radius would be some 30 km.
const STRAIGHT: f64 = 1e-4;
/// A sum of headings below this is zero but for round-off, rad; and so is its rate, rad/s: of a symmetric axle in pure
/// bump.
const KINK: f64 = 1e-9;

/// An axle whose wheels head less aside than this in the mean, 1 degree in rad, is not steered: static toe and bump
/// steer are of that size, while Ackermann's difference of the two headings falls with the square of the angle (0.01
/// degrees here), so that its part would be a quotient of toe by next to nothing.
const STEERS: f64 = std::f64::consts::PI / 180.0;

/// A number for division; NaN where an angle does not exceed a limit.
fn beyond<T: Real>(x: T, angle: T, limit: f64) -> T {
    if angle.exceeds(T::constant(limit)) { x } else { T::constant(f64::NAN) }
}

/// The heading into the turn of the outer wheel that turns about the same point of the other axle's line as the inner
/// one with heading i: `cot r = cot i + track / wheelbase`, without the poles.
fn outer_by_ackermann<T: Real>(i: T, track_by_wheelbase: T) -> T {
    let (sin, cos) = i.sin_cos();
    // r = atan2(sin i, cos i + sin i track / wheelbase)
    sin.atan2(cos + sin * track_by_wheelbase)
}

/// The bodies that measures and named points are fixed in.
pub(crate) fn bodies_asked_for(model: &Model) -> Vec<usize> {
    let mut bodies: Vec<usize> = model.points.iter().map(|p| p.body.0).collect();
    bodies.extend(model.measures.iter().flat_map(|m| model.bodies_of(m)).map(|b| b.0));
    bodies.sort_unstable();
    bodies.dedup();
    bodies
}

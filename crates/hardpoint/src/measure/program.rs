//! Straight-line program of all outputs at eight output times, from the batched results of the motion to those of the
//! measures.
//!
//! The formulas are recorded once, independent of the motion. The derivatives of an output by the six degrees of
//! freedom of a body, with their first two time derivatives, are recorded once for each body that it depends on. The
//! derivative by a variable is then a sum of products with the sensitivities of these bodies. That is six evaluations
//! per body instead of one per variable, and only for the degrees of freedom that matter: three for a point, two or
//! three for a direction.
//!
//! Decisions that formulas make by values are recorded as limits. If a limit is violated, or a number is NaN, the
//! formulas themselves are evaluated again ([`MeasureRun::fits`]).
//!
//! With g_k the derivative of an output y by direction k of a body, and a_k the displacement of the body in this
//! direction per unit of a variable b,
//!
//! ```text
//! y_b    =  sum_k g_k a_k
//! (y.)_b   =  sum_k (g_k. a_k + g_k a_k.)
//! (y..)_b  =  sum_k (g_k.. a_k + 2 g_k. a_k. + g_k a_k..)
//! ```
//!
//! and a = (dr, pi') with their rates: translations of the frame's origin, rotations about it.

use std::ops::Range;

use hardpoint_tape::{LANES, Number, Options, Program, record};

use crate::blocks::{AlignedLanes, lanes_of};
use crate::design::{BodyFixed, DesignMap};
use crate::model::{BodyId, GROUND, MeasureKind, Model, OutputSource, VariableId};
use crate::motion::execution::{Execution, ProgramMemory, Runnable, Staged};
use crate::motion::{BodyState, Motion};
use crate::number::{self, Dual, Jet, Rates, record as recording};
use crate::sensitivity::{BodySensitivity, Sensitivities};
use crate::space::{Mat3, Pose, Vec3};

use super::bodies::moving;
use super::{Instant, MeasureResults, Output, bodies_asked_for};

/// Maximum number of sums of products, one for each combination of output, variable and body, for which a program is
/// recorded: a larger one would take more memory than its results.
const MOST_SUMS: usize = 20_000;

/// Ways in which a body can go: slides along x, y and z, then turns about them.
const WAYS: usize = 6;

/// A number while it is recorded, with its rates.
type RecordedRates = Rates<Number>;

/// Purpose of a program.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct ProgramKey {
    /// True if the design is an input; else it is the nominal one.
    any_design: bool,
    /// Derivatives by that many variables.
    variables: usize,
    /// Pairs of a variable and a body that it moves, among the bodies that outputs use.
    moved: Vec<(usize, usize)>,
}

impl ProgramKey {
    /// By the design with these values and the variables that there are sensitivities for.
    pub fn of(model: &Model, values: &[f64], sensitivities: &Sensitivities) -> Self {
        let bodies = moving_bodies(model);
        let pairs = (0..sensitivities.variables).flat_map(|v| bodies.iter().map(move |b| (v, *b)));
        Self {
            any_design: values.iter().any(|v| *v != 0.0),
            variables: sensitivities.variables,
            moved: pairs.filter(|(v, b)| sensitivities.moves(VariableId(*v), BodyId(*b))).collect(),
        }
    }
}

/// The program of all outputs.
#[derive(Debug)]
pub(crate) struct MeasureProgram {
    program: Staged,
    bodies: Vec<usize>,
    moved: Vec<(usize, usize)>,
    /// Measures whose whole turns are requested.
    turning: Vec<usize>,
    /// Index of the design values among the inputs.
    design_at: usize,
    outputs: usize,
    /// By variable and output: index of its first derivative; `None` if they are all zero.
    places: Vec<Option<usize>>,
    /// Number of values.
    derivatives: usize,
}

impl MeasureProgram {
    /// The request, if it can be recorded.
    pub fn record(design_map: &DesignMap<'_>, asked: &ProgramKey, execution: Execution) -> Option<Self> {
        let RecordedFormulas { program, bodies, turning, inputs, outputs, places, derivatives } =
            RecordedFormulas::of(design_map, asked)?;
        let (moved, design_at) = (asked.moved.clone(), inputs);
        let program = Staged::new(program, design_at, execution, |step| {
            Runnable::new(step, [outputs, 4 * outputs], execution)
        });
        Some(Self { program, bodies, moved, turning, design_at, outputs, places, derivatives })
    }

    /// By variable and output, where its derivatives begin, and how many numbers they are in all.
    pub(super) fn layout(&self) -> (Vec<Option<usize>>, usize) {
        (self.places.clone(), self.derivatives)
    }
}

/// The formulas of all outputs, recorded.
struct RecordedFormulas {
    program: Program,
    bodies: Vec<usize>,
    turning: Vec<usize>,
    /// Number of inputs before the design values.
    inputs: usize,
    outputs: usize,
    places: Vec<Option<usize>>,
    derivatives: usize,
}

impl RecordedFormulas {
    fn of(design_map: &DesignMap<'_>, asked: &ProgramKey) -> Option<Self> {
        let model = design_map.model();
        let (outputs, bodies) = (super::outputs(model), moving_bodies(model));
        let nominal = model.whole(&[]);
        let depends = dependences(design_map, &nominal, &bodies, &outputs);
        let sums = depends.iter().map(|[on, _]| asked.moved.iter().filter(|(_, b)| on.contains(b)).count());
        if sums.sum::<usize>() > MOST_SUMS {
            return None;
        }
        let turning = turning(model, &outputs);
        let (mut places, mut derivatives, mut inputs, mut fits) = (Vec::new(), 0, 0, true);
        recording::begin();
        let recorded = record(|| {
            let mut input = |x: f64| {
                inputs += 1;
                Number::input(x)
            };
            let zero = Number::constant(0.0);
            let mut poses = vec![Pose::IDENTITY.spread(); model.bodies.len()];
            let mut turns = vec![[Vec3::zero(); 2]; model.bodies.len()];
            for &b in &bodies {
                let numbers: Vec<Number> =
                    BodyState::at_design(model, BodyId(b)).numbers().map(&mut input).collect();
                // r, A, v, omega, a, alpha of every body: a pose with its rates, and its angular velocity and
                // acceleration
                let vectors = std::array::from_fn(|k| vector(&numbers[3 * k..]));
                (turns[b], poses[b]) = ([vectors[5], vectors[7]], moving(vectors));
            }
            let mut way = |&(_, b): &(usize, usize)| {
                let numbers: [Number; BodySensitivity::NUMBERS] = std::array::from_fn(|_| input(0.0));
                // dr, pi', dv, d(omega), da, d(alpha) of a body by a variable: how far it goes along each way
                ways_of(std::array::from_fn(|k| vector(&numbers[3 * k..])), turns[b])
            };
            let ways: Vec<_> = asked.moved.iter().map(&mut way).collect();
            let mut whole_turns = vec![Dual::constant(Jet::constant(zero)); model.measures.len()];
            turning.iter().for_each(|&m| whole_turns[m].v.0[0] = input(0.0));
            // An input, so that it is not folded: adding a multiple of it changes only NaN.
            let nothing = input(0.0);
            let number = if asked.any_design { Number::input } else { Number::constant };
            let values: Vec<Number> = nominal.iter().map(|v| number(*v)).collect();
            let geometry = RecordedGeometry::of(design_map, &values, asked.variables, &depends);
            let of_design = recording::limits();
            fits = recording::is_arithmetic();
            let recorder = Recorder { model, geometry, poses, whole_turns, ways, asked };
            places = vec![None; asked.variables * outputs.len()];
            let [mut guards, mut numbers, mut by_variables] = [const { Vec::new() }; 3];
            for (m, (output, depends)) in outputs.iter().zip(&depends).enumerate() {
                let given = recorder.output(output, depends);
                let found =
                    given.iter().flat_map(|g| [g.values].into_iter().chain(g.derivatives.iter().copied()));
                let check = found.flatten().filter(|x| !x.known().is_some_and(f64::is_nan));
                // 0 x + 0 y + ...: 0, or NaN where any of them is no number
                let check = check.fold(zero, |sum, x| x.times_plus(nothing, sum));
                let limits = given.iter().flat_map(|g| &g.limits).chain(&of_design);
                let guard = limits.fold(check, |most, limit| most.larger(*limit));
                guards.push(if given.is_some() { guard } else { Number::constant(1.0) });
                let nan = [Number::constant(f64::NAN); 3];
                numbers.extend(given.as_ref().map_or(nan, |g| g.values));
                for v in 0..asked.variables {
                    let d = given.as_ref().map_or(nan, |g| g.derivatives[v]);
                    if !d[..output.known.orders].iter().all(|x| x.known() == Some(0.0)) {
                        places[v * outputs.len() + m] = Some(by_variables.len());
                        by_variables.extend(d);
                    }
                }
            }
            derivatives = by_variables.len();
            [guards, numbers, by_variables].concat()
        });
        if !fits {
            return None;
        }
        let (program, _) = recorded.program(Options::default());
        Some(Self { program, bodies, turning, inputs, outputs: outputs.len(), places, derivatives })
    }
}

/// Measures and point components as a straight-line program of the motion of the bodies, and of the design if that was
/// requested, for generators of source code.
///
/// Inputs are 24 numbers of each of the [`bodies`](Self::bodies) (r, the columns of A, v, omega, a, alpha), the whole
/// turns of the measures of [`turning`](Self::turning), rad, a zero, and the design variables if requested. Outputs are
/// one guard for each of [`outputs`](super::outputs), then value, rate and acceleration of each. An output is undefined
/// if its guard is positive or NaN. A guard that is the constant one belongs to an output that is not arithmetic.
#[derive(Clone, Debug)]
pub struct MeasureFormulas {
    /// The program.
    pub program: Program,
    /// Indices of the bodies that are inputs.
    pub bodies: Vec<usize>,
    /// Indices of the measures whose whole turns are inputs.
    pub turning: Vec<usize>,
}

impl MeasureFormulas {
    /// Records the formulas; `None` if the body-fixed data are not arithmetic.
    pub(crate) fn record(design_map: &DesignMap<'_>, any_design: bool) -> Option<Self> {
        let asked = ProgramKey { any_design, variables: 0, moved: Vec::new() };
        let RecordedFormulas { program, bodies, turning, .. } = RecordedFormulas::of(design_map, &asked)?;
        Some(Self { program, bodies, turning })
    }
}

/// The bodies that outputs are measured on, but ground.
fn moving_bodies(model: &Model) -> Vec<usize> {
    bodies_asked_for(model).into_iter().filter(|b| *b != GROUND.0).collect()
}

/// Measures that formulas may use with all their turns.
fn turning(model: &Model, outputs: &[Output]) -> Vec<usize> {
    let formulas = model.measures.iter().filter(|m| matches!(m.kind, MeasureKind::Combination { .. }));
    let mut turning: Vec<usize> = formulas
        .flat_map(|formula| formula.kind.sources())
        .filter_map(|source| match source {
            OutputSource::Measure(m) => outputs[m].known.counted.then_some(m),
            OutputSource::Point(..) => None,
        })
        .collect();
    turning.sort_unstable();
    turning.dedup();
    turning
}

fn vector(numbers: &[Number]) -> Vec3<Number> {
    Vec3::new(numbers[0], numbers[1], numbers[2])
}

/// Derivative of a body's motion in each direction, with its first two time derivatives, from its sensitivity; the body
/// rotates with this velocity and acceleration.
fn ways_of(
    [dr, dpi, dv, domega, da, dalpha]: [Vec3<Number>; 6],
    [omega, alpha]: [Vec3<Number>; 2],
) -> [[Number; 3]; WAYS] {
    // Rotation vector pi':  (pi'). = d(omega)/db + omega x pi',
    // (pi').. = d(alpha)/db + alpha x pi' + omega x (pi').
    let first = omega.cross_plus(dpi, domega);
    let second = omega.cross_plus(first, alpha.cross_plus(dpi, dalpha));
    let way = |[x, y, z]: [Vec3<Number>; 3]| [[x.x, y.x, z.x], [x.y, y.y, z.y], [x.z, y.z, z.z]];
    let ([a, b, c], [d, e, f]) = (way([dr, dv, da]), way([dpi, first, second]));
    [a, b, c, d, e, f]
}

/// A pose that goes one way, and how much of the way that is.
fn gone(pose: Pose<RecordedRates>, way: usize, amount: RecordedRates) -> Pose<Dual<RecordedRates>> {
    // A slide: dr = e_k a;  a turn: d(column) = e_k x column a, with r at rest.
    let axis = Vec3::AXES[way % 3].map(|x| amount.times(Number::constant(x)));
    let (slide, turn) = if way < 3 { (axis, Vec3::zero()) } else { (Vec3::zero(), axis) };
    Pose { rot: pose.rot.along(turn), r: pose.r.with_derivative(slide) }
}

/// Body-fixed data, and their derivatives by each variable that changes some of them.
struct RecordedGeometry {
    still: BodyFixed<Dual<RecordedRates>>,
    moved: Vec<Option<BodyFixed<Dual<RecordedRates>>>>,
}

impl RecordedGeometry {
    fn of(
        design_map: &DesignMap<'_>,
        values: &[Number],
        variables: usize,
        depends: &[[Vec<usize>; 2]],
    ) -> Self {
        let still = recording::strictly(|| design_map.fixed(values));
        let moved = |v: usize| {
            depends.iter().any(|[_, moving]| moving.contains(&v)).then(|| {
                let mut duals: Vec<Dual<Number>> = values.iter().map(|x| Dual::constant(*x)).collect();
                duals[v] = Dual::variable(values[v]);
                let fixed = recording::strictly(|| design_map.fixed(&duals));
                fixed.map(|x| Dual { v: Jet::constant(x.v), d: Jet::constant(x.d) })
            })
        };
        Self {
            still: still.map(|x| Dual::constant(Jet::constant(x))),
            moved: (0..variables).map(moved).collect(),
        }
    }
}

/// Result of an output.
struct RecordedOutput {
    values: [Number; 3],
    /// By variable.
    derivatives: Vec<[Number; 3]>,
    /// Conditions: if any of these is positive, the result is invalid.
    limits: Vec<Number>,
}

/// Records outputs.
struct Recorder<'a> {
    model: &'a Model,
    geometry: RecordedGeometry,
    poses: Vec<Pose<RecordedRates>>,
    whole_turns: Vec<Dual<RecordedRates>>,
    /// Per variable and body that it moves.
    ways: Vec<[[Number; 3]; WAYS]>,
    asked: &'a ProgramKey,
}

impl Recorder<'_> {
    /// An output that depends on these bodies and depends on what these variables move within them; none that is no
    /// arithmetic.
    fn output(&self, output: &Output, [bodies, variables]: &[Vec<usize>; 2]) -> Option<RecordedOutput> {
        if depends_on_step(self.model, output.source) {
            return None;
        }
        recording::begin();
        let orders = output.known.orders;
        let is_formula =
            matches!(output.source, OutputSource::Measure(m) if super::formulas::is_formula(self.model, m));
        let whole_turns: &[_] = if is_formula { &self.whole_turns } else { &[] };
        let at = |fixed: &BodyFixed<Dual<RecordedRates>>, poses: &[Pose<Dual<RecordedRates>>]| {
            Instant { whole_turns, ..Instant::new(self.model, fixed, poses) }.output(output.source)
        };
        let still = |x: Vec3<RecordedRates>| x.map(Dual::constant);
        let stays =
            |p: &Pose<RecordedRates>| Pose { rot: Mat3 { cols: p.rot.cols.map(still) }, r: still(p.r) };
        let mut poses: Vec<_> = self.poses.iter().map(stays).collect();
        let mut values = at(&self.geometry.still, &poses).v.0;
        let zero = Number::constant(0.0);
        let mut derivatives = vec![[zero; 3]; self.asked.variables];
        for &b in bodies.iter().filter(|_| self.asked.variables > 0) {
            // How value, rate and acceleration go with each way, its rate and its acceleration.
            let slopes: [[[Number; 3]; 3]; WAYS] = std::array::from_fn(|way| {
                let mut along = |level: usize| {
                    let mut amount = Jet::constant(zero);
                    amount.0[level] = Number::constant(1.0);
                    poses[b] = gone(self.poses[b], way, amount);
                    at(&self.geometry.still, &poses).d.0
                };
                if output.known.by_position {
                    // Leibniz' rule, along a way that is at rest in the world.
                    let [g, rate, acceleration] = along(0);
                    // Rows: what multiplies a, a., a..; columns: of y, y., y..
                    [[g, rate, acceleration], [zero, g, rate * 2.0], [zero, zero, g]]
                } else {
                    std::array::from_fn(along)
                }
            });
            poses[b] = stays(&self.poses[b]);
            for (&(v, _), ways) in self.asked.moved.iter().zip(&self.ways).filter(|((_, body), _)| *body == b)
            {
                for (slopes, way) in slopes.iter().zip(ways) {
                    for (slopes, way) in slopes.iter().zip(way) {
                        for order in 0..orders {
                            let sum = &mut derivatives[v][order];
                            // y(order)_b += (slope by a(level)) a(level)
                            *sum = slopes[order].times_plus(*way, *sum);
                        }
                    }
                }
            }
        }
        for &v in variables.iter().filter(|v| **v < self.asked.variables) {
            let fixed = self.geometry.moved[v].as_ref().expect("laid out for every variable of an output");
            let d = at(fixed, &poses).d.0;
            // ... + dy/db at constant poses: body-fixed data change
            (0..3).for_each(|order| derivatives[v][order] += d[order]);
        }
        for numbers in derivatives.iter_mut().chain([&mut values]) {
            numbers[orders..].fill(Number::constant(f64::NAN));
        }
        // Folding with NaN may result in NaN.
        let is_none =
            |numbers: &[Number; 3]| numbers[..orders].iter().any(|x| x.known().is_some_and(f64::is_nan));
        let is_number = !derivatives.iter().chain([&values]).any(is_none);
        (is_number && recording::is_arithmetic()).then(|| RecordedOutput {
            values,
            derivatives,
            limits: recording::limits(),
        })
    }
}

/// True if an output, or one that it uses, depends on more of a step than the motion of its bodies.
fn depends_on_step(model: &Model, output: OutputSource) -> bool {
    let OutputSource::Measure(m) = output else { return false };
    // Others that are made of outputs depend on the step themselves.
    model.depends_on_step(m)
        || model.measures[m].kind.sources().into_iter().any(|source| depends_on_step(model, source))
}

/// Per output: the bodies that it depends on, and the variables that change its body-fixed data.
///
/// A derivative that is not a number makes one of everything that depends on it. A formula that took the larger of two
/// numbers would hide it: measures are smooth.
pub(crate) fn dependences(
    design_map: &DesignMap<'_>,
    values: &[f64],
    bodies: &[usize],
    outputs: &[Output],
) -> Vec<[Vec<usize>; 2]> {
    let model = design_map.model();
    let unknown = |x: Dual<Rates>| Dual { v: x.v, d: Jet([f64::NAN; 3]) };
    let mut values: Vec<Dual> = values.iter().map(|v| Dual::constant(*v)).collect();
    let mut poses: Vec<Pose<Dual<Rates>>> = model.bodies.iter().map(|b| b.frame.spread()).collect();
    let fixed = |values: &[Dual]| {
        let fixed = design_map.fixed(values);
        fixed.map(|x| Dual { v: Jet::constant(x.v), d: Jet::constant(x.d) })
    };
    let depend = |fixed: &BodyFixed<Dual<Rates>>, poses: &[Pose<Dual<Rates>>]| -> Vec<bool> {
        let of = |o: &Output| Instant::new(model, fixed, poses).output(o.source).d.0[0].is_nan();
        outputs.iter().map(of).collect()
    };
    let mut found = vec![[Vec::new(), Vec::new()]; outputs.len()];
    let mut note = |which: usize, what: usize, depends: Vec<bool>| {
        let depending = found.iter_mut().zip(depends).filter(|(_, depends)| *depends);
        depending.for_each(|(found, _)| found[which].push(what));
    };
    let as_drawn = fixed(&values);
    for &b in bodies {
        let pose = poses[b];
        poses[b] = Pose {
            rot: Mat3 { cols: number::each(&pose.rot.cols, |c| c.map(unknown)) },
            r: pose.r.map(unknown),
        };
        note(0, b, depend(&as_drawn, &poses));
        poses[b] = pose;
    }
    for v in 0..values.len() {
        let value = values[v];
        // NaN in place of db: what becomes NaN depends on b
        values[v].d = f64::NAN;
        note(1, v, depend(&fixed(&values), &poses));
        values[v] = value;
    }
    found
}

/// A program at work on one design.
pub(super) struct MeasureRun<'p> {
    program: &'p MeasureProgram,
    room: ProgramMemory,
    inputs: Vec<AlignedLanes>,
    guards: Vec<AlignedLanes>,
}

impl<'p> MeasureRun<'p> {
    /// On the design with these values.
    pub fn new(program: &'p MeasureProgram, values: &[f64]) -> Self {
        let mut inputs = vec![AlignedLanes::default(); program.program.step.inputs()];
        inputs[program.design_at..].iter_mut().zip(values).for_each(|(line, x)| line.0 = [*x; LANES]);
        program.program.take_design(&mut inputs);
        let guards = vec![AlignedLanes::default(); program.outputs];
        Self { program, room: ProgramMemory::default(), inputs, guards }
    }

    /// Evaluates all outputs at the eight output times that k is one of. The whole turns of measures that are requested
    /// are those that were [given](Self::turns).
    pub fn at(
        &mut self,
        k: usize,
        motion: &Motion,
        sensitivities: &Sensitivities,
        measured: &mut MeasureResults,
    ) {
        let MeasureProgram { program, bodies, moved, .. } = self.program;
        let (of_bodies, rest) =
            lanes_of(&mut self.inputs).split_at_mut(BodyState::NUMBERS * self.program.bodies.len());
        for (b, to) in bodies.iter().zip(of_bodies.chunks_exact_mut(BodyState::NUMBERS)) {
            motion.states.gather(k, BodyState::NUMBERS * (b - 1), to);
        }
        for (&(v, b), to) in moved.iter().zip(rest.chunks_exact_mut(BodySensitivity::NUMBERS)) {
            sensitivities.gather(k, v, b, to);
        }
        let guards = lanes_of(&mut self.guards);
        let results = [guards, measured.values.block_mut(k), measured.d.block_mut(k)];
        self.room.run(&program.step, bytemuck::cast_slice(&self.inputs), &[], results);
    }

    /// True if an output counts, in that many lanes.
    pub fn fits(&self, output: usize, lanes: usize) -> bool {
        // NaN does not fit.
        self.guards[output].0[..lanes].iter().all(|x| *x <= 0.0)
    }

    /// Takes the whole turns that `counted(measure, time)` gives at these output times; whether any differs from what
    /// they were.
    pub fn take_turns(&mut self, times: Range<usize>, counted: impl Fn(usize, usize) -> f64) -> bool {
        let mut differ = false;
        for (m, lanes) in self.turns() {
            for (lane, to) in lanes.iter_mut().enumerate() {
                let now = counted(m, usize::min(times.start + lane, times.end - 1));
                // Compared bit by bit, so that NaN equals NaN.
                differ |= now.to_bits() != to.to_bits();
                *to = now;
            }
        }
        differ
    }

    /// The whole turns, rad, of these measures, that formulas depend on.
    pub fn turns(&mut self) -> impl Iterator<Item = (usize, &mut [f64; LANES])> {
        let first = self.program.design_at - 1 - self.program.turning.len();
        let lines = lanes_of(&mut self.inputs)[first..].iter_mut();
        self.program.turning.iter().copied().zip(lines)
    }
}

//! One step of a plan as a straight-line program.
//!
//! [`State::solve`] computes the same operations at every output time and for every design, as long as Newton's method
//! takes the same number of corrections and the pivots keep their order. So they are recorded once, with the numbers of
//! the tape, together with the prediction before the step and the requested results after it. After constant folding
//! the program runs in eight lanes at a time. Every decision that was made during recording is checked in every run by
//! numbers that the tape evaluates ([`Tape::solve`](super::tape::Tape::solve)). If a decision differs, the results are
//! discarded, and the kernel solves the step.
//!
//! Not recorded are mechanisms with curves, and those with couplers, which count turns (of both a step of drivers is
//! recorded: [`super::driven_step`]); mechanisms so large that
//! a program would cost more than it saves; and margins of sparse blocks.

use std::sync::{Arc, OnceLock};

use hardpoint_code::{Code, UnsupportedProgram, Width};
use hardpoint_tape::{Number, Operand, Options, Program, record};

use crate::design::DesignMap;
use crate::joint::Freedom;
use crate::law::Law;
use crate::linalg::{LARGEST_DENSE, MOST_GROWTH};
use crate::model::{BodyId, Model, VariableId};
use crate::number::record as recording;
use crate::space::Vec3;
use crate::topology::{BlockId, CoordinateId, LinkStep, RowId, Topology};

use super::BodyState;
use super::execution::{Cache, Execution, Runnable, Staged, StepMethod};
use super::kinematics::{CORRECTIONS, QUADRATIC, ROUND_OFF, State};
use super::margin::Margins;
use super::mechanism::{AcceptedPosition, Mechanism};
use super::parts::PlanGeometry;
use super::predictor::{Channel, NODES, ORDERS};

/// Newton's first correction while recording, in units of each coordinate, for programs with one correction and with
/// two: the last of them leaves round-off.
pub(super) const OFFSET: [f64; MOST_CORRECTIONS] = [1e-9, 1e-5];
/// Maximum number of corrections of a program; if more are needed, it runs again from its result.
pub(super) const MOST_CORRECTIONS: usize = 2;
/// Maximum number of links of a recorded mechanism: each takes some kilobytes during recording.
const MOST_LINKS: usize = 4000;
/// Maximum number of multiplications of the sparse factors of a recorded mechanism.
const MOST_MULTIPLICATIONS: usize = 70_000;
/// Number of values that predict a channel.
pub(super) const CONDITIONS: usize = NODES * ORDERS;

/// Purpose of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Purpose {
    /// True if its lanes are output times, of one design; else they are designs, at one output time.
    pub times: bool,
    /// True if the design is an input; else it is the nominal one.
    pub any_design: bool,
    /// Newton's corrections in one run: one or two.
    pub corrections: usize,
    /// True if it computes the derivatives of all bodies by all variables.
    pub sensitivities: bool,
    /// True if it computes the margins.
    pub margins: bool,
    /// True if it computes the measures that depend on the motion of a single driver.
    pub slopes: bool,
    /// True if it computes the requested loads.
    pub loads: bool,
}

/// Results that were recorded besides the motion.
#[derive(Default)]
pub(crate) struct RecordedExtras {
    /// Conditions: if any of these is positive, the results are invalid.
    pub limits: Vec<Number>,
    pub results: Vec<Number>,
    /// Defect of each row that a variable could open, and the part of it that may be round-off.
    pub judged: Vec<Number>,
    /// Pairs of a variable and a body that it moves, in the order of the results.
    pub moved: Vec<(VariableId, BodyId)>,
    /// Pairs of a variable and a row that it could open.
    pub defects: Vec<(VariableId, RowId)>,
    /// Measures of loads and those that depend on a driver that moves alone, and their derivatives.
    pub measures: Vec<Number>,
}

/// A step while it is recorded, solved.
pub(crate) struct RecordedStep<'r> {
    pub topology: &'r Topology,
    pub state: &'r mut State<Number>,
    /// The values of the design's variables.
    pub values: &'r [Number],
    /// Value, speed and acceleration of every driver.
    pub drivers: &'r [[Number; 3]],
    /// Factors of forces that depend on laws, in the order of the elements, if loads are requested.
    pub laws: &'r [Number],
}

/// The program of a step.
#[derive(Debug)]
pub(crate) struct StepProgram {
    pub purpose: Purpose,
    pub program: Staged,
    pub channels: Vec<Channel>,
    pub unknowns: Vec<Unknown>,
    pub blocks: Vec<BlockProgram>,
    pub inputs: Inputs,
    pub outputs: Outputs,
    pub variables: usize,
    /// Pairs of a variable and a body that it moves, in the order of their derivatives.
    pub moved: Vec<(VariableId, BodyId)>,
    pub defects: Vec<(VariableId, RowId)>,
}

/// Recorded form of a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockProgram {
    /// The largest factor in the order of the pivots.
    growth: f64,
    /// True if the determinant is positive, and whether the product of the pivots is.
    pub positive: bool,
    positive_product: bool,
    /// Newton's passes.
    pub passes: usize,
    /// Index of the correction that proves convergence, and its bound.
    last: usize,
    limit: f64,
}

impl BlockProgram {
    /// Form of block b as it was just solved; `None` if it needed more corrections than are recorded separately.
    fn of(state: &State<Number>, b: usize) -> Option<Self> {
        let (watched, (corrections, passes)) = (&state.watched[b], &state.corrections[b]);
        let corrected = passes.checked_sub(2).and_then(|k| corrections.get(k));
        // Either the last that was applied leaves round-off, or the next one is round-off itself.
        let (last, limit) = match corrected {
            // dq_0 ... dq_passes-2 were applied. The last pass computed none, since the one before was at most 1e-8, or
            // one of at most 1e-14.
            Some(c) if c.value() <= QUADRATIC => (passes - 2, QUADRATIC),
            _ => (passes - 1, ROUND_OFF),
        };
        (last < CORRECTIONS).then_some(Self {
            growth: watched.growth.value(),
            positive: state.pivots[b].1,
            positive_product: watched.product.value() > 0.0,
            passes: *passes,
            last,
            limit,
        })
    }
}

/// An unknown coordinate, one of a ball's three included, and where its speed is among the outputs; its acceleration
/// comes next.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unknown {
    pub coordinate: CoordinateId,
    pub speed: usize,
}

/// Positions of a program's inputs: weights, node values of every channel, drivers and the laws of forces, time ahead
/// of the newest position, design variables, and what depends on these alone.
///
/// Known are, of designs, the last positions of every channel, the newest first; of output times these are uniforms,
/// and the input is what is added to the forecast: nothing, or all there is where the position was found by a run
/// before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inputs {
    /// Number of node values of each channel.
    pub known: usize,
    pub drivers: usize,
    pub ahead: usize,
    pub design: usize,
}

impl Inputs {
    fn of(channels: &[Channel], purpose: Purpose, drivers: usize, laws: usize) -> Self {
        let known = if purpose.times { 1 } else { CONDITIONS };
        let drivers_at = CONDITIONS + known * channels.len();
        let ahead = drivers_at + ORDERS * drivers + laws;
        Self { known, drivers: drivers_at, ahead, design: ahead + 1 }
    }
}

/// Positions of a program's outputs: value, first and second derivative of every channel, speeds and accelerations of
/// ball joints, and then these.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outputs {
    pub judged: usize,
    pub blocks: usize,
    pub margins: usize,
    pub defects: usize,
    pub measures: usize,
    pub states: usize,
    derivatives: usize,
}

impl Outputs {
    /// Positions of outputs that begin at these, the rest of them with these numbers of margins, defects, measures and
    /// numbers of bodies.
    fn after(judged: usize, blocks: usize, rest: usize, counts: [usize; 4]) -> Self {
        let [margins, judged_defects, measured, bodies] = counts;
        let defects = rest + margins;
        let measures = defects + judged_defects;
        let states = measures + measured;
        Self { judged, blocks, margins: rest, defects, measures, states, derivatives: states + bodies }
    }
}

/// Quantities that a run is checked by, in this order.
#[derive(Clone, Copy, Debug)]
pub(super) enum StepCheck {
    /// Positive if the pivots, or decisions made during recording, do not fit.
    Unfit,
    /// The largest first correction of all blocks, rad or sizes.
    First,
    /// Excess of the last correction over round-off; positive if another run is needed.
    Last,
    /// The largest residual, and the largest in sizes of loops.
    Residual,
    ScaledResidual,
    /// The largest pivot of a block over its smallest, of all blocks.
    Pivots,
    /// Largest difference between speeds and their prediction from the newest position, and the largest speed; rad, or
    /// sizes.
    Apart,
    Fastest,
}

/// Per block: its determinant, and the largest pivot over the smallest.
pub(super) const PER_BLOCK: usize = 2;

impl StepProgram {
    /// Reason why the steps of a plan cannot be recorded, with or without margins; `None` if they can.
    pub fn hindrance(topology: &Topology, margins: bool) -> Option<&'static str> {
        if !topology.coupled_rows.is_empty() {
            Some("couplers count angles by their predicted turns")
        } else if topology.closures.iter().any(|c| c.contact.is_some()) {
            Some("a point follows a curve")
        } else if margins && topology.blocks.iter().any(|b| b.unknowns.len() > LARGEST_DENSE) {
            Some("a block is so large that its margin takes longer than its motion")
        } else {
            Self::excess(topology)
        }
    }

    /// Reason why the programs of a plan would be too long; `None` if they are not.
    pub fn excess(topology: &Topology) -> Option<&'static str> {
        let multiplications = topology.blocks.iter().map(|b| b.multiplications).sum::<usize>();
        (topology.links.len() > MOST_LINKS || multiplications > MOST_MULTIPLICATIONS)
            .then_some("the program would be too long")
    }

    /// Records the step at the position of `one`, of the nominal design, and the results of `besides`; returns `None`
    /// if either cannot be recorded.
    pub fn record(
        one: &Mechanism<'_>,
        design_map: &DesignMap<'_>,
        purpose: Purpose,
        besides: impl FnOnce(RecordedStep<'_>) -> Option<RecordedExtras>,
        execution: Execution,
    ) -> Option<Self> {
        let (model, topology) = (one.model, &one.topology);
        let channels = Channel::all(topology);
        let unknowns = unknowns(topology, &channels);
        let (mut places, mut moved, mut defects) = (None, Vec::new(), Vec::new());
        let (mut fits, mut blocks) = (false, Vec::new());
        recording::begin();
        let recorded = record(|| {
            // The kernel itself, with numbers that record all operations.
            let mut state = State::new(model, topology);
            let offset = OFFSET[purpose.corrections - 1];
            let known = predict(topology, &channels, &one.saved, (offset, purpose.times), &mut state);
            let drivers: Vec<[Number; 3]> = one.saved.drivers.iter().map(|f| f.map(Number::input)).collect();
            let t = *model.times.first().unwrap_or(&0.0);
            let laws = model.laws_of_forces().filter(|_| purpose.loads);
            let laws: Vec<Number> = laws.map(|law| Number::input(law.at(t).value())).collect();
            let ahead = Number::input(0.0);
            let nominal = model.whole(&[]).into_iter();
            // b as an input makes the geometry a part of the program; as a constant it is folded.
            let number = if purpose.any_design { Number::input } else { Number::constant };
            let values: Vec<Number> = nominal.map(number).collect();
            let geometry = recording::strictly(|| design_map.geometry(&values));
            let parts = PlanGeometry::of(model, topology, &geometry);
            // (26), (9), (10): later runs have the number of corrections that is recorded here
            fits = state.solve(topology, &parts, &drivers, f64::INFINITY).is_ok();
            let recorded = (0..topology.blocks.len()).map_while(|b| BlockProgram::of(&state, b));
            blocks = recorded.collect::<Vec<_>>();
            fits &= blocks.len() == topology.blocks.len();

            // Outputs, in the order of `Outputs`: channels, what is judged, blocks, margins, defects, measures,
            // bodies, derivatives.
            let mut out = moves(topology, &channels, &state);
            let bodies = BodyState::all(&state);
            let (margins, mut limits) = match purpose.margins {
                true => Margins::new(model, topology, &geometry).record(topology, &state),
                false => Default::default(),
            };
            let step =
                RecordedStep { topology, state: &mut state, values: &values, drivers: &drivers, laws: &laws };
            let Some(more) = besides(step) else {
                fits = false;
                return out;
            };
            limits.extend(more.limits.into_iter().chain(recording::limits()));
            (moved, defects) = (more.moved, more.defects);
            let judged = out.len();
            let residuals = state.largest_residuals(topology, &parts, &drivers);
            let speeds = speeds(topology, &channels, &known, ahead, &state);
            out.extend(self::judged(one, &state, &blocks, limits));
            out.extend(residuals);
            out.push(match state.watched.is_empty() {
                true => Number::constant(1.0),
                false => largest_of(state.watched.iter().map(|w| w.most * w.least)),
            });
            out.extend(speeds);
            let first_block = out.len();
            let watched = state.watched.iter().zip(&state.determinants);
            // det J, and max / min of the pivots
            out.extend(watched.flat_map(|(w, determinant)| [*determinant, w.most * w.least]));
            let rest = [margins.len(), more.judged.len(), more.measures.len(), bodies.len()];
            places = Some(Outputs::after(judged, first_block, out.len(), rest));
            out.extend([margins, more.judged, more.measures, bodies, more.results].concat());
            out
        });
        let outputs = places.filter(|_| fits && recording::is_arithmetic())?;
        let variables = if purpose.any_design { model.variables.len() } else { 0 };
        let laws = if purpose.loads { model.laws_of_forces().count() } else { 0 };
        let inputs = Inputs::of(&channels, purpose, model.drivers.len(), laws);
        let pieces = pieces(topology, &channels);
        let piece_of = |operand| {
            channel_of(operand, inputs.known).and_then(|channel| pieces.get(channel)).copied().unwrap_or(0)
        };
        let (program, _) = recorded.program(Options::default());
        let program = Staged::new(program, inputs.design, execution, |step| {
            Runnable::in_pieces(step, [outputs.states, outputs.derivatives], execution, piece_of)
        });
        Some(Self {
            purpose,
            program,
            channels,
            unknowns,
            blocks,
            inputs,
            outputs,
            variables,
            moved,
            defects,
        })
    }
}

/// Number of the channel that an operand belongs to, with this number of known values per channel.
fn channel_of(operand: Operand, known: usize) -> Option<usize> {
    match operand {
        Operand::Uniform(k) => Some(k as usize / CONDITIONS),
        Operand::Input(k) => (k as usize).checked_sub(CONDITIONS).map(|k| k / known),
        Operand::Value(_) | Operand::Constant(_) => None,
    }
}

/// Index of the program piece of each channel: one piece per block.
fn pieces(topology: &Topology, channels: &[Channel]) -> Vec<usize> {
    let mut piece_of = vec![0; topology.coordinates.len()];
    for (b, block) in BlockId::each(&topology.blocks) {
        block.unknowns.iter().for_each(|c| piece_of[c.0] = b.0 + 1);
    }
    let coordinate = |channel: &Channel| match *channel {
        Channel::Coordinate(c) | Channel::Ball(c, _) => c,
    };
    channels.iter().map(|channel| piece_of[coordinate(channel).0]).collect()
}

/// All unknowns, balls' included.
fn unknowns(topology: &Topology, channels: &[Channel]) -> Vec<Unknown> {
    let mut unknowns = Vec::new();
    for (n, channel) in channels.iter().enumerate() {
        if let Channel::Coordinate(coordinate) = *channel {
            unknowns.push(Unknown { coordinate, speed: ORDERS * n + 1 });
        }
    }
    let mut speed = ORDERS * channels.len();
    for coordinate in of_balls(topology) {
        unknowns.push(Unknown { coordinate, speed });
        speed += 2;
    }
    unknowns
}

/// The coordinates of unknown balls.
fn of_balls(topology: &Topology) -> impl Iterator<Item = CoordinateId> {
    let steps = topology.links.iter().flat_map(|l| &l.steps);
    let balls = steps.filter(|s| s.freedom == Freedom::Ball && topology[s.first].is_unknown());
    balls.flat_map(LinkStep::coordinates)
}

/// Value, first and second derivative of every channel; speeds and accelerations of balls.
fn moves(topology: &Topology, channels: &[Channel], state: &State<Number>) -> Vec<Number> {
    let mut out: Vec<Number> = channels.iter().flat_map(|c| c.of(state)).collect();
    for c in of_balls(topology) {
        out.extend([state.motion.speeds[0][c.0], state.motion.speeds[1][c.0]]);
    }
    out
}

/// Quantities that the steps are checked by, up to [`StepCheck::Last`], for blocks that are recorded so; none of the
/// limits may be positive.
fn judged(
    one: &Mechanism<'_>,
    state: &State<Number>,
    blocks: &[BlockProgram],
    limits: Vec<Number>,
) -> [Number; 3] {
    let (mut unfit, mut first, mut last) = (limits, Vec::new(), Vec::new());
    for (b, block) in blocks.iter().enumerate() {
        let (w, (corrections, _)) = (&state.watched[b], &state.corrections[b]);
        // The determinant keeps its sign, ...
        let side = if block.positive_product { -1.0 } else { 1.0 };
        unfit.push(w.product * side);
        // ... the order of the pivots is stable, ...
        unfit.push(w.growth + -f64::max(MOST_GROWTH, 2.0 * block.growth));
        // ... and no other rows are better: 1 / (most least) is the pivot ratio.
        unfit.push(w.most * w.least * one.branch[b].try_others + -1.0);
        first.push(corrections[0]);
        last.push(corrections[block.last] + -block.limit);
    }
    [unfit, first, last].map(|x| largest_of(x.into_iter()))
}

/// Maximum of these numbers; NaN if one is NaN, and the smallest number if there are none.
pub(super) fn largest_of(numbers: impl Iterator<Item = Number>) -> Number {
    numbers.reduce(Number::larger).unwrap_or_else(|| Number::constant(f64::MIN))
}

/// Largest difference between the speeds and their prediction from the newest position, and the largest of both. In
/// rad, or sizes; those of a ball are twice those of its quaternion.
fn speeds(
    topology: &Topology,
    channels: &[Channel],
    known: &[[Number; CONDITIONS]],
    ahead: Number,
    state: &State<Number>,
) -> [Number; 2] {
    let (mut apart, mut fastest) = (Vec::new(), Vec::new());
    for (channel, known) in channels.iter().zip(known) {
        let per_unit = match *channel {
            Channel::Coordinate(c) => topology[c].per_unit,
            Channel::Ball(..) => 2.0,
        };
        let [_, speed, _] = channel.of(state);
        let [_, before, acceleration, ..] = *known;
        // q. at the newest position + q.. h
        let predicted = acceleration.times_plus(ahead, before);
        apart.push((speed - predicted).abs() * per_unit);
        fastest.push(speed.abs().larger(before.abs()) * per_unit);
    }
    [apart, fastest].map(|x| largest_of(x.into_iter()))
}

/// Makes inputs that predict the state, at `offset` from the position `at`; returns the node values of every channel,
/// which are common to all lanes of output times.
fn predict(
    topology: &Topology,
    channels: &[Channel],
    at: &AcceptedPosition,
    (offset, times): (f64, bool),
    state: &mut State<Number>,
) -> Vec<[Number; CONDITIONS]> {
    let first = |n: usize, x: f64| if n == 0 { x } else { 0.0 };
    let weights: [Number; CONDITIONS] = std::array::from_fn(|n| Number::input(first(n, 1.0)));
    let one = |channel: &Channel| {
        let beside = match *channel {
            Channel::Coordinate(c) => at.q[c.0] + offset * topology[c].unit,
            Channel::Ball(c, k) => at.balls[c.0].nudged(Vec3::new(offset, offset, offset)).component(k),
        };
        let of = if times { Number::uniform } else { Number::input };
        let known: [Number; CONDITIONS] = std::array::from_fn(|n| of(first(n, beside)));
        let begin = if times { Number::input(0.0) } else { Number::constant(0.0) };
        // Terms in order of increasing size.
        // q(t) = begin + sum_j weight_j(t) known_j: Hermite interpolation (27), with the same weights for all channels
        let terms = weights.into_iter().zip(known).rev();
        channel.put(terms.fold(begin, |sum, (w, x)| w.times_plus(x, sum)), state);
        known
    };
    channels.iter().map(one).collect()
}

/// Number of steps from which recording saves time: it costs about a few hundred steps of the kernel, but only once.
const PAYS: usize = 100;

/// Programs of a plan, each recorded on first use.
///
/// They are recorded for the nominal design at the first position, so that they do not depend on the first request.
#[derive(Debug)]
pub(crate) struct Programs {
    execution: Execution,
    steps: Cache<Purpose, StepProgram>,
    laws: Cache<bool, Runnable>,
    /// Register width of machine code, or the reason why there is none.
    machine: OnceLock<Result<Width, UnsupportedProgram>>,
}

impl Programs {
    /// An empty set of programs.
    pub fn new(execution: Execution) -> Self {
        Self { execution, steps: Cache::default(), laws: Cache::default(), machine: OnceLock::new() }
    }

    /// Execution of the programs.
    pub fn execution(&self) -> Execution {
        self.execution
    }

    /// Method for this number of steps, if they can be recorded.
    pub fn solved_by(&self, steps: usize) -> StepMethod {
        let asked = || "it was requested".to_owned();
        match self.execution {
            Execution::Kernel => StepMethod::Kernel(asked()),
            _ if !self.pay(steps) => {
                StepMethod::Kernel(format!("recording pays from {PAYS} output times on"))
            }
            Execution::Interpreted => StepMethod::Interpreter(asked()),
            // If the empty program compiles, all programs do.
            _ => match self.machine.get_or_init(|| Code::new(&Program::default()).map(|code| code.width())) {
                Ok(width) => StepMethod::Code(*width),
                Err(why) => StepMethod::Interpreter(why.to_string()),
            },
        }
    }

    /// True if a program saves time for this number of steps.
    pub fn pay(&self, steps: usize) -> bool {
        match self.execution {
            Execution::Fastest => steps >= PAYS,
            Execution::Kernel => false,
            Execution::Interpreted | Execution::Compiled => true,
        }
    }

    /// Returns the program for this purpose; `record` makes it on first use.
    pub fn step(
        &self,
        purpose: Purpose,
        record: impl FnOnce(Execution) -> Option<StepProgram>,
    ) -> Option<Arc<StepProgram>> {
        self.steps.get(purpose, |_| record(self.execution))
    }

    /// Program of the laws of the nominal design at eight times. The first part has value, speed and acceleration of
    /// each driver and, if loads are requested, the values of the laws of forces; the second has the limits that must
    /// not be positive. `None` if a law is not a plain formula.
    pub fn laws(&self, model: &Model, loads: bool) -> Option<Arc<Runnable>> {
        self.laws.get(loads, |_| {
            recording::begin();
            let recorded = record(|| {
                let t = Number::input(*model.times.first().unwrap_or(&0.0));
                let of = |law: &Law| law.to_order::<_, 3>(t).derivatives();
                let of_drivers = model.drivers.iter().flat_map(|d| of(&d.coordinate_law()));
                let of_forces = model.laws_of_forces().filter(|_| loads).map(|law| of(law)[0]);
                let laws: Vec<Number> = of_drivers.chain(of_forces).collect();
                [laws, recording::limits()].concat()
            });
            let fits = recording::is_arithmetic();
            let program = recorded.program(Options::default()).0;
            let all = program.outputs.len();
            let laws = ORDERS * model.drivers.len() + model.laws_of_forces().filter(|_| loads).count();
            fits.then(|| Runnable::new(program, [laws, all], self.execution))
        })
    }
}

//! One step of a plan as a straight-line program.
//!
//! What [`State::solve`] computes is the same at every output time and for every design, as long as Newton's method takes as many
//! corrections and the pivots keep their order. So it is recorded once, with a number of the tape in place of each number, together
//! with the forecast before it and whatever is asked of the bodies after it; and what is left of it after folding is run eight lanes
//! at a time. What was decided while recording is asked for again after every run ([`Tape::judge`]); where the answer is another,
//! nothing has happened, and the kernel itself solves the step.
//!
//! Not recorded are mechanisms with curves, and with couplers, whose angles go by the turn that is expected; those that are so large that a
//! program each would cost more than it saves; and margins of sparse blocks.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex, OnceLock};

use hardpoint_code::{Code, PARTS, Scratch, Unsupported, Width};
use hardpoint_tape::{
    Interpreter, LANES, Lanes, Number, Operand, Options, Pieces, PiecesRoom, Program, Shape, record,
};

use crate::blocks::{Line, lanes_of};
use crate::joint::Freedom;
use crate::law::Law;
use crate::model::{BodyId, Effects, Model, VariableId};
use crate::number::record as recording;
use crate::space::{LARGEST_DENSE, MOST_GROWTH, Vec3};
use crate::topology::{Source, Topology};

use super::BodyState;
use super::forecast::{Channel, NODES, ORDERS};
use super::kinematics::{CORRECTIONS, QUADRATIC, ROUND_OFF, Residuals, State};
use super::margin::Margins;
use super::parts::Parts;
use super::stepper::{LOCKED, Saved, Stepper, smooth};

/// Newton's first correction while recording, in units of each coordinate, for programs with one correction and with two: the last
/// of them leaves round-off.
const OFFSET: [f64; MOST_CORRECTIONS] = [1e-9, 1e-5];
/// What needs more corrections is solved by running a program again from where it came to.
pub(super) const MOST_CORRECTIONS: usize = 2;
/// What is not solved after so many runs is left to the kernel.
const MOST_RUNS: usize = 4;
/// From one run to the next the first correction must become smaller by this factor, as Newton's corrections must.
const CONTRACTS: f64 = 0.5;
/// A program of so many instructions does not stay in the fast memory of a core: where its pieces are alike, they share their code ...
const LONG: usize = 10_000;
/// ... if that makes it shorter by this factor.
const SHORTER: usize = 2;
/// Mechanisms with more links than this are not recorded: the program would no longer stay in the fast memory of a core.
const MOST_LINKS: usize = 4000;
/// Nor are those whose sparse factors take more multiplications together.
const MOST_MULTIPLICATIONS: usize = 70_000;
/// What a channel is foreseen by.
const CONDITIONS: usize = NODES * ORDERS;

/// What a program is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Purpose {
    /// Whether its lanes are output times, of one design; else they are designs, at one output time.
    pub times: bool,
    /// Whether the design is an input; else it is the nominal one.
    pub any_design: bool,
    /// Newton's corrections in one run: one or two.
    pub corrections: usize,
    /// Whether it works out the derivatives of all bodies by all variables.
    pub sensitivities: bool,
    /// Whether it works out how far from a singular position the mechanism is.
    pub margins: bool,
}

/// What was recorded besides the motion.
#[derive(Default)]
pub(crate) struct Recorded {
    /// Where any of these is positive, the results do not count.
    pub limits: Vec<Number>,
    pub results: Vec<Number>,
    /// Of each row that a variable could fail: the size of the defect, and what of it may be round-off.
    pub judged: Vec<Number>,
    /// Which variable moves which body, in the order of the results.
    pub moved: Vec<(VariableId, BodyId)>,
    /// Which variable could fail which row of the constraints.
    pub defects: Vec<(VariableId, usize)>,
}

/// The program of a step.
#[derive(Debug)]
pub(crate) struct StepProgram {
    purpose: Purpose,
    /// What depends on the design alone, and what does not.
    design: Runnable,
    step: Runnable,
    channels: Vec<Channel>,
    unknowns: Vec<Unknown>,
    blocks: Vec<BlockProgram>,
    inputs: Inputs,
    outputs: Outputs,
    variables: usize,
    moved: Vec<(VariableId, BodyId)>,
    defects: Vec<(VariableId, usize)>,
}

/// A program, as machine code where there is any; a long one in pieces that share their code.
#[derive(Debug)]
pub(crate) struct Runnable {
    inputs: usize,
    sizes: [usize; PARTS],
    form: Form,
}

#[derive(Debug)]
enum Form {
    Whole(Executable),
    Pieces(Pieces, Vec<Executable>),
}

/// A program that is run as it is, with outputs in parts.
#[derive(Debug)]
struct Executable {
    program: Program,
    code: Option<Code>,
}

impl Executable {
    fn new(program: Program, ends: [usize; PARTS - 1], execution: Execution) -> Self {
        let code =
            if execution == Execution::Interpreted { None } else { Code::in_parts(&program, ends).ok() };
        Self { program, code }
    }

    #[inline(always)]
    fn run(
        &self,
        (scratch, interpreter): (&mut Scratch, &mut Option<Interpreter>),
        found: &mut Vec<Lanes>,
        inputs: &[Lanes],
        uniforms: &[f64],
        outputs: [&mut [Lanes]; PARTS],
    ) {
        match &self.code {
            Some(code) => code.run_in_parts(scratch, inputs, uniforms, outputs),
            None => {
                let interpreter = interpreter.get_or_insert_with(|| Interpreter::new(&self.program));
                found.resize(self.program.outputs.len(), [0.0; LANES]);
                interpreter.run(inputs, uniforms, found);
                let mut rest = &found[..];
                for to in outputs {
                    let (part, others) = rest.split_at(to.len());
                    to.copy_from_slice(part);
                    rest = others;
                }
            }
        }
    }
}

impl Runnable {
    /// Its outputs in parts that end there.
    pub fn new(program: Program, ends: [usize; PARTS - 1], execution: Execution) -> Self {
        Self::in_pieces(program, ends, execution, |_| 0)
    }

    /// The same; `piece_of` says which piece of a long program an input or uniform belongs to.
    fn in_pieces(
        program: Program,
        ends @ [first, second]: [usize; PARTS - 1],
        execution: Execution,
        piece_of: impl Fn(Operand) -> usize,
    ) -> Self {
        let (inputs, long) = (program.inputs, program.instructions.len());
        let sizes = [first, second - first, program.outputs.len() - second];
        let pieces = (long > LONG).then(|| program.in_pieces(piece_of, ends));
        let form = match pieces.filter(|pieces| SHORTER * pieces.instructions() <= long) {
            Some(pieces) => {
                let executable =
                    |shape: &Shape| Executable::new(shape.program.clone(), shape.ends, execution);
                let shapes = pieces.shapes.iter().map(executable).collect();
                Form::Pieces(pieces, shapes)
            }
            None => Form::Whole(Executable::new(program, ends, execution)),
        };
        Self { inputs, sizes, form }
    }

    /// How many numbers it is given.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// How many numbers it gives, in every part.
    pub fn sizes(&self) -> [usize; PARTS] {
        self.sizes
    }
}

/// What a program works in.
#[derive(Debug, Default)]
pub(crate) struct Room {
    scratch: Scratch,
    /// One for every program.
    interpreters: Vec<Option<Interpreter>>,
    /// What they give.
    outputs: Vec<Lanes>,
    pieces: PiecesRoom,
}

impl Room {
    #[inline(always)]
    pub fn run(
        &mut self,
        runnable: &Runnable,
        inputs: &[Lanes],
        uniforms: &[f64],
        outputs: [&mut [Lanes]; PARTS],
    ) {
        let Self { scratch, interpreters, outputs: found, pieces: room } = self;
        match &runnable.form {
            Form::Whole(executable) => {
                interpreters.resize(1, None);
                executable.run((scratch, &mut interpreters[0]), found, inputs, uniforms, outputs);
            }
            Form::Pieces(pieces, shapes) => {
                interpreters.resize(shapes.len(), None);
                pieces.run(room, inputs, uniforms, outputs, |shape, inputs, uniforms, outputs| {
                    let with = (&mut *scratch, &mut interpreters[shape]);
                    shapes[shape].run(with, found, inputs, uniforms, outputs);
                });
            }
        }
    }
}

/// How a block was recorded.
#[derive(Clone, Copy, Debug)]
struct BlockProgram {
    /// The largest factor in the order of the pivots.
    growth: f64,
    /// Whether the determinant is positive, and whether it is where the product of the pivots is.
    positive: bool,
    is_even: bool,
    /// Newton's passes.
    passes: usize,
    /// Which correction says that it has converged, and how small it is then.
    last: usize,
    limit: f64,
}

impl BlockProgram {
    /// Of block b, as it was just solved; none where more corrections were needed than are told apart.
    fn of(state: &State<Number>, b: usize) -> Option<Self> {
        let (watched, (corrections, passes)) = (&state.watched[b], &state.corrections[b]);
        let corrected = passes.checked_sub(2).and_then(|k| corrections.get(k));
        // Either the last that was applied leaves round-off, or the next one is round-off itself.
        let (last, limit) = match corrected {
            Some(c) if c.value() <= QUADRATIC => (passes - 2, QUADRATIC),
            _ => (passes - 1, ROUND_OFF),
        };
        let positive = watched.product.value() > 0.0;
        (last < CORRECTIONS).then_some(Self {
            growth: watched.growth.value(),
            positive: state.pivots[b].1,
            is_even: state.pivots[b].1 == positive,
            passes: *passes,
            last,
            limit,
        })
    }
}

/// An unknown coordinate, one of a ball's three included, and where its speed is among the outputs; its acceleration comes next.
#[derive(Clone, Copy, Debug)]
struct Unknown {
    coordinate: usize,
    speed: usize,
}

/// Where the inputs of a program begin: weights, what is known of every channel, drivers, how far ahead of the newest position it is,
/// variables of the design, and what depends on them alone.
///
/// Known are, of designs, the last positions of every channel, the newest first; of output times these are uniforms, and the input is
/// what is added to the forecast: nothing, or all there is where the position was found by a run before.
#[derive(Clone, Copy, Debug)]
struct Inputs {
    known: usize,
    drivers: usize,
    ahead: usize,
    design: usize,
    of_design: usize,
}

impl Inputs {
    fn of(channels: &[Channel], purpose: Purpose, drivers: usize, variables: usize) -> Self {
        let known = if purpose.times { 1 } else { CONDITIONS };
        let drivers_at = CONDITIONS + known * channels.len();
        let ahead = drivers_at + ORDERS * drivers;
        let design = ahead + 1;
        Self { known, drivers: drivers_at, ahead, design, of_design: design + variables }
    }
}

/// Where the outputs of a program begin: value, first and second derivative of every channel, speeds and accelerations of balls,
/// and then these.
#[derive(Clone, Copy, Debug)]
struct Outputs {
    judged: usize,
    blocks: usize,
    margins: usize,
    defects: usize,
    states: usize,
    derivatives: usize,
}

/// What a run is judged by, in this order.
#[derive(Clone, Copy, Debug)]
enum Judged {
    /// Positive where the pivots, or what was decided while recording, do not fit.
    Unfit,
    /// The largest first correction of all blocks, rad or sizes.
    First,
    /// By how much the last correction is more than round-off; positive where another run is needed.
    Last,
    /// The largest residual, and the largest in sizes of loops.
    Residual,
    ScaledResidual,
    /// The largest pivot of a block over its smallest, of all blocks.
    Pivots,
    /// By how much speeds differ at most from those foreseen by the newest position, and the largest of all speeds; rad, or sizes.
    Apart,
    Fastest,
}

/// Per block: its determinant without its sign, and the largest pivot over the smallest.
const PER_BLOCK: usize = 2;

impl StepProgram {
    /// Why the steps of a plan are not recorded, with margins or without, if they are not.
    pub fn hindrance(topology: &Topology, margins: bool) -> Option<&'static str> {
        if !topology.coupled_rows.is_empty() {
            Some("couplers count angles by the turn that is expected")
        } else if topology.closures.iter().any(|c| c.contact.is_some()) {
            Some("a point follows a curve")
        } else if margins && topology.blocks.iter().any(|b| b.unknowns.len() > LARGEST_DENSE) {
            Some("a block is so large that its margin takes longer than its motion")
        } else if topology.links.len() > MOST_LINKS
            || topology.blocks.iter().map(|b| b.multiplications).sum::<usize>() > MOST_MULTIPLICATIONS
        {
            Some("the program would be too long")
        } else {
            None
        }
    }

    /// Records the step that is solved where `one`, of the nominal design, stands, and what `besides` makes of it and of the values
    /// of the design's variables; none where either cannot be recorded.
    pub fn record(
        one: &Stepper<'_>,
        effects: &Effects<'_>,
        purpose: Purpose,
        besides: impl FnOnce(&Topology, &mut State<Number>, &[Number]) -> Option<Recorded>,
        execution: Execution,
    ) -> Option<Self> {
        let (model, topology) = (one.model, &one.topology);
        let channels = Channel::all(topology);
        let unknowns = unknowns(topology, &channels);
        let (mut places, mut moved, mut defects) = (None, Vec::new(), Vec::new());
        let (mut fits, mut blocks) = (false, Vec::new());
        recording::begin();
        let recorded = record(|| {
            let mut state = State::new(model, topology);
            let offset = OFFSET[purpose.corrections - 1];
            let known = foresee(topology, &channels, &one.saved, (offset, purpose.times), &mut state);
            let drivers: Vec<[Number; 3]> = one.saved.drivers.iter().map(|f| f.map(Number::input)).collect();
            let ahead = Number::input(0.0);
            let nominal = model.whole(&[]).into_iter();
            let number = if purpose.any_design { Number::input } else { Number::constant };
            let values: Vec<Number> = nominal.map(number).collect();
            let geometry = recording::strictly(|| effects.geometry(&values));
            let parts = Parts::of(model, topology, &geometry);
            fits = state.solve(topology, &parts, &drivers, f64::INFINITY).is_ok();
            let recorded = (0..topology.blocks.len()).map_while(|b| BlockProgram::of(&state, b));
            blocks = recorded.collect::<Vec<_>>();
            fits &= blocks.len() == topology.blocks.len();

            let mut out = moves(topology, &channels, &state);
            let bodies = BodyState::all(&state);
            let (margins, mut limits) = match purpose.margins {
                true => Margins::new(topology).record(topology, &state),
                false => Default::default(),
            };
            let Some(more) = besides(topology, &mut state, &values) else {
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
            let blocks_at = out.len();
            let watched = state.watched.iter().zip(&state.determinants);
            out.extend(watched.flat_map(|(w, determinant)| [*determinant, w.most * w.least]));
            let margins_at = out.len();
            let defects_at = margins_at + margins.len();
            let states = defects_at + more.judged.len();
            places = Some(Outputs {
                judged,
                blocks: blocks_at,
                margins: margins_at,
                defects: defects_at,
                states,
                derivatives: states + bodies.len(),
            });
            out.extend([margins, more.judged, bodies, more.results].concat());
            out
        });
        let outputs = places.filter(|_| fits && recording::is_arithmetic())?;
        let variables = if purpose.any_design { model.variables.len() } else { 0 };
        let inputs = Inputs::of(&channels, purpose, model.drivers.len(), variables);
        let (program, _) = recorded.program(Options::default());
        let (design, step) = program.staged(|operand| match operand {
            Operand::Input(k) => k as usize >= inputs.design,
            _ => false,
        });
        let all = design.outputs.len();
        let design = Runnable::new(design, [all; PARTS - 1], execution);
        let ends = [outputs.states, outputs.derivatives];
        let pieces = pieces(topology, &channels);
        let step = Runnable::in_pieces(step, ends, execution, |operand| {
            let channel = match operand {
                Operand::Uniform(k) => Some(k as usize / CONDITIONS),
                Operand::Input(k) => (k as usize).checked_sub(CONDITIONS).map(|k| k / inputs.known),
                Operand::Value(_) | Operand::Constant(_) => None,
            };
            channel.and_then(|channel| pieces.get(channel)).copied().unwrap_or(0)
        });
        Some(Self {
            purpose,
            design,
            step,
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

    /// Which variable moves which body, in the order of their derivatives.
    pub fn moved(&self) -> &[(VariableId, BodyId)] {
        &self.moved
    }
}

/// Which piece of a program a channel belongs to: one for every block.
fn pieces(topology: &Topology, channels: &[Channel]) -> Vec<usize> {
    let mut piece_of = vec![0; topology.coordinates.len()];
    for (b, block) in topology.blocks.iter().enumerate() {
        block.unknowns.iter().for_each(|c| piece_of[*c] = b + 1);
    }
    let coordinate = |channel: &Channel| match *channel {
        Channel::Coordinate(c) | Channel::Ball(c, _) => c,
    };
    channels.iter().map(|channel| piece_of[coordinate(channel)]).collect()
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
    for first in balls(topology) {
        for axis in 0..3 {
            unknowns.push(Unknown { coordinate: first + axis, speed });
            speed += 2;
        }
    }
    unknowns
}

/// The first coordinates of unknown balls.
fn balls(topology: &Topology) -> impl Iterator<Item = usize> {
    let steps = topology.links.iter().flat_map(|l| &l.steps);
    let balls = steps.filter(|s| s.freedom == Freedom::Ball).map(|s| s.first);
    balls.filter(|first| matches!(topology.coordinates[*first].source, Source::Unknown { .. }))
}

/// Value, first and second derivative of every channel; speeds and accelerations of balls.
fn moves(topology: &Topology, channels: &[Channel], state: &State<Number>) -> Vec<Number> {
    let mut out: Vec<Number> = channels.iter().flat_map(|c| c.of(state)).collect();
    for c in balls(topology).flat_map(|first| first..first + 3) {
        out.extend([state.motion.speeds[0][c], state.motion.speeds[1][c]]);
    }
    out
}

/// What the steps are judged by, up to [`Judged::Last`], in blocks that are recorded so; none of the limits may be positive.
fn judged(
    one: &Stepper<'_>,
    state: &State<Number>,
    blocks: &[BlockProgram],
    limits: Vec<Number>,
) -> [Number; 3] {
    let (mut unfit, mut first, mut last) = (limits, Vec::new(), Vec::new());
    for (b, block) in blocks.iter().enumerate() {
        let (w, (corrections, _)) = (&state.watched[b], &state.corrections[b]);
        // The determinant keeps its sign, ...
        let side = if block.positive == block.is_even { -1.0 } else { 1.0 };
        unfit.push(w.product * side);
        // ... the order of the pivots serves, ...
        unfit.push(w.growth + -f64::max(MOST_GROWTH, 2.0 * block.growth));
        // ... and no other rows are better: 1 / (most least) is the pivot ratio.
        unfit.push(w.most * w.least * one.try_others[b] + -1.0);
        first.push(corrections[0]);
        last.push(corrections[block.last] + -block.limit);
    }
    [unfit, first, last].map(|x| largest_of(x.into_iter()))
}

/// The largest of these; NaN where one is, and of none at all the least number.
fn largest_of(numbers: impl Iterator<Item = Number>) -> Number {
    numbers.reduce(Number::larger).unwrap_or_else(|| Number::constant(f64::MIN))
}

/// By how much the speeds differ at most from those that speed and acceleration at the newest position foresee, so long ahead; and the
/// fastest of both. In rad, or sizes; a ball's are twice those of its quaternion.
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
            Channel::Coordinate(c) => topology.coordinates[c].per_unit,
            Channel::Ball(..) => 2.0,
        };
        let [_, speed, _] = channel.of(state);
        let [_, before, acceleration] = [known[0], known[1], known[2]];
        let foreseen = acceleration.times_plus(ahead, before);
        apart.push((speed - foreseen).abs() * per_unit);
        fastest.push(speed.abs().larger(before.abs()) * per_unit);
    }
    [apart, fastest].map(|x| largest_of(x.into_iter()))
}

/// Makes inputs of what foresees the state, `offset` beside where `at` is; returns what is known of every channel, which is the same at
/// all of several output times.
fn foresee(
    topology: &Topology,
    channels: &[Channel],
    at: &Saved,
    (offset, times): (f64, bool),
    state: &mut State<Number>,
) -> Vec<[Number; CONDITIONS]> {
    let first = |n: usize, x: f64| if n == 0 { x } else { 0.0 };
    let weights: [Number; CONDITIONS] = std::array::from_fn(|n| Number::input(first(n, 1.0)));
    let one = |channel: &Channel| {
        let beside = match *channel {
            Channel::Coordinate(c) => at.q[c] + offset * topology.coordinates[c].unit,
            Channel::Ball(c, k) => at.balls[c].nudged(Vec3::new(offset, offset, offset)).component(k),
        };
        let of = if times { Number::uniform } else { Number::input };
        let known: [Number; CONDITIONS] = std::array::from_fn(|n| of(first(n, beside)));
        let begin = if times { Number::input(0.0) } else { Number::constant(0.0) };
        // What counts least comes first.
        let terms = weights.into_iter().zip(known).rev();
        channel.put(terms.fold(begin, |sum, (w, x)| w.times_plus(x, sum)), state);
        known
    };
    channels.iter().map(one).collect()
}

/// Recording pays from so many steps on: it costs about as much as a few hundred of the kernel's, once, and later runs have it for
/// nothing.
const PAYS: usize = 100;
/// After so many groups of steps, a program that was refused in more than a quarter of them is given up.
const TRIAL: usize = 8;

/// What even steps are solved by: the kernel, which walks the plan, or a straight-line program that was recorded of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Execution {
    /// By what pays: programs where there are steps enough, as machine code where there can be any.
    #[default]
    Fastest,
    /// By the kernel alone.
    Kernel,
    /// By programs that are interpreted, from the first step on.
    Interpreted,
    /// By programs as machine code, from the first step on; interpreted where there can be none.
    Compiled,
}

impl Execution {
    /// What `HARDPOINT_PATH` calls it: `scalar`, `tape` or `code`.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "scalar" => Some(Self::Kernel),
            "tape" => Some(Self::Interpreted),
            "code" => Some(Self::Compiled),
            _ => None,
        }
    }
}

/// How the even steps of a motion are solved, eight output times at once or one by one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SolvedBy {
    /// By programs as machine code.
    Code(Width),
    /// By programs that are interpreted, and why there is no machine code.
    Interpreter(String),
    /// By the kernel, one by one, and why.
    Kernel(String),
}

impl fmt::Display for SolvedBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Code(width) => write!(f, "machine code ({width}), eight output times at once"),
            Self::Interpreter(why) => write!(f, "an interpreted program, eight output times at once: {why}"),
            Self::Kernel(why) => write!(f, "the kernel, one by one: {why}"),
        }
    }
}

/// The programs of a plan, each recorded when it is first asked for.
///
/// They are recorded of the nominal design where its motion begins, so that they do not depend on who asks first.
#[derive(Debug)]
pub(crate) struct Programs {
    execution: Execution,
    steps: Mutex<BTreeMap<Purpose, Option<Arc<StepProgram>>>>,
    laws: Mutex<Option<Option<Arc<Runnable>>>>,
    /// The registers of machine code, or why there is none.
    machine: OnceLock<Result<Width, Unsupported>>,
}

impl Programs {
    /// None as yet.
    pub fn new(execution: Execution) -> Self {
        Self { execution, steps: Mutex::default(), laws: Mutex::default(), machine: OnceLock::new() }
    }

    /// What they are run by.
    pub fn execution(&self) -> Execution {
        self.execution
    }

    /// How so many steps are solved, if they can be recorded.
    pub fn solved_by(&self, steps: usize) -> SolvedBy {
        let asked = || "it was asked for".to_owned();
        match self.execution {
            Execution::Kernel => SolvedBy::Kernel(asked()),
            _ if !self.pay(steps) => SolvedBy::Kernel(format!("recording pays from {PAYS} output times on")),
            Execution::Interpreted => SolvedBy::Interpreter(asked()),
            // What can be made of nothing can be made of all.
            _ => match self.machine.get_or_init(|| Code::new(&Program::default()).map(|code| code.width())) {
                Ok(width) => SolvedBy::Code(*width),
                Err(why) => SolvedBy::Interpreter(why.to_string()),
            },
        }
    }

    /// Whether so many steps are worth a program.
    pub fn pay(&self, steps: usize) -> bool {
        match self.execution {
            Execution::Fastest => steps >= PAYS,
            Execution::Kernel => false,
            Execution::Interpreted | Execution::Compiled => true,
        }
    }

    /// The program for this purpose; `record` makes it for this execution, if it was not asked for before.
    pub fn step(
        &self,
        purpose: Purpose,
        record: impl FnOnce(Execution) -> Option<StepProgram>,
    ) -> Option<Arc<StepProgram>> {
        let mut steps = self.steps.lock().expect("no one panics while recording");
        steps.entry(purpose).or_insert_with(|| record(self.execution).map(Arc::new)).clone()
    }

    /// The drivers' laws of the nominal design at eight times: in one part value, speed and acceleration of each driver, in the next what
    /// must not be positive. None where a law is no plain formula.
    pub fn laws(&self, model: &Model) -> Option<Arc<Runnable>> {
        let mut laws = self.laws.lock().expect("no one panics while recording");
        laws.get_or_insert_with(|| {
            recording::begin();
            let recorded = record(|| {
                let t = Number::input(*model.times.first().unwrap_or(&0.0));
                let of = |law: &Law| law.to_order::<_, 3>(t).derivatives();
                let laws: Vec<Number> = model.drivers.iter().flat_map(|d| of(&d.law)).collect();
                [laws, recording::limits()].concat()
            });
            let fits = recording::is_arithmetic();
            let program = recorded.program(Options::default()).0;
            let all = program.outputs.len();
            let laws = ORDERS * model.drivers.len();
            fits.then(|| Arc::new(Runnable::new(program, [laws, all], self.execution)))
        })
        .clone()
    }
}

/// A step that the program does not fit: the kernel solves it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Refused;

/// A program at work, with what it works in: one design in all lanes, or one in each.
pub(crate) struct Tape {
    program: Arc<StepProgram>,
    room: Room,
    inputs: Vec<Line>,
    /// What is known of the channels, where lanes are output times.
    uniforms: Vec<f64>,
    outputs: Vec<Line>,
    /// Groups of steps that were tried, those that were refused, and those that took more than one run.
    tried: usize,
    refused: usize,
    repeated: usize,
    /// Of the last one: its runs, and the largest first correction of the first run, rad or sizes.
    runs: usize,
    missed: f64,
}

/// How well steps were solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solved {
    pub residuals: Residuals,
    /// The smallest pivot ratio of all blocks.
    pub pivot_ratio: f64,
}

impl Tape {
    pub fn new(program: Arc<StepProgram>) -> Self {
        let inputs = program.inputs.of_design + program.design.sizes()[0];
        let inputs = vec![Line::default(); usize::max(inputs, program.step.inputs)];
        let outputs = vec![Line::default(); program.outputs.states];
        let uniforms = if program.purpose.times { CONDITIONS * program.channels.len() } else { 0 };
        Self {
            room: Room::default(),
            inputs,
            uniforms: vec![0.0; uniforms],
            outputs,
            program,
            tried: 0,
            refused: 0,
            repeated: 0,
            runs: 0,
            missed: 0.0,
        }
    }

    /// Takes the designs whose values these are, one per lane; the last one in lanes beyond.
    pub fn set_designs(&mut self, designs: &[Vec<f64>]) {
        let StepProgram { design, inputs, variables, .. } = &*self.program;
        for v in 0..*variables {
            let of_lane = |k: usize| designs[usize::min(k, designs.len() - 1)][v];
            self.inputs[inputs.design + v] = Line(std::array::from_fn(of_lane));
        }
        let (given, found) = self.inputs.split_at_mut(inputs.of_design);
        let (given, found) = (&lanes_of(given)[..design.inputs], &mut lanes_of(found)[..design.sizes()[0]]);
        Room::default().run(design, given, &[], [found, &mut [], &mut []]);
    }

    /// Whether it is refused so often that the kernel alone is faster.
    pub fn is_of_no_use(&self) -> bool {
        self.tried >= TRIAL && 4 * self.refused > self.tried
    }

    /// Whether so many steps take more than one run that a program with more corrections would be faster.
    pub fn is_too_short(&self) -> bool {
        self.tried >= TRIAL && 4 * self.repeated > self.tried
    }

    /// Whether its determinants have the signs of these branches.
    pub fn is_on(&self, branch: &[(bool, f64)]) -> bool {
        self.program.blocks.iter().zip(branch).all(|(block, (positive, _))| block.positive == *positive)
    }

    /// Which variable moves which body, in the order of their derivatives.
    pub fn moved(&self) -> &[(VariableId, BodyId)] {
        &self.program.moved
    }

    /// The coordinates of the tree; 0 for those of balls.
    #[inline(always)]
    pub fn coordinates(&self, topology: &Topology, out: &mut [Lanes]) {
        for (coordinate, out) in topology.coordinates.iter().zip(&mut *out) {
            *out = match coordinate.source {
                Source::Driven(d) => *self.driver(d.0, 0),
                Source::Unknown { .. } => [0.0; LANES],
            };
        }
        for (n, channel) in self.program.channels.iter().enumerate() {
            if let Channel::Coordinate(c) = *channel {
                out[c] = *self.channel_lanes(n, 0);
            }
        }
    }

    /// What it is for.
    pub fn purpose(&self) -> Purpose {
        self.program.purpose
    }

    /// Foresees times so far ahead of the newest position by these weights: by position, the newest first, and order of its derivative;
    /// they may be the ones of last time.
    #[inline(always)]
    pub fn look_ahead(&mut self, weights: &[Lanes; CONDITIONS], are_new: bool, ahead: &Lanes) {
        let at = self.program.inputs.ahead;
        let inputs = lanes_of(&mut self.inputs);
        // Runs after the first went by others.
        if are_new || self.runs != 1 {
            inputs[..CONDITIONS].copy_from_slice(weights);
            if self.program.purpose.times {
                inputs[CONDITIONS..self.program.inputs.drivers].fill([0.0; LANES]);
            }
        }
        inputs[at] = *ahead;
    }

    /// What is known of a channel at one output time, design by design, ordered like the weights.
    #[inline(always)]
    pub fn known_mut(&mut self, channel: usize) -> &mut [Lanes] {
        &mut lanes_of(&mut self.inputs)[CONDITIONS * (1 + channel)..][..CONDITIONS]
    }

    /// What is known of every channel of one design, each ordered like the weights.
    #[inline(always)]
    pub fn known_of_times_mut(&mut self) -> &mut [[f64; CONDITIONS]] {
        self.uniforms.as_chunks_mut().0
    }

    /// Value, speed and acceleration of every driver.
    #[inline(always)]
    pub fn drivers_mut(&mut self) -> &mut [Lanes] {
        let Inputs { drivers, ahead, .. } = self.program.inputs;
        &mut lanes_of(&mut self.inputs)[drivers..ahead]
    }

    /// The same, read.
    #[inline(always)]
    pub fn driver(&self, d: usize, order: usize) -> &Lanes {
        &self.inputs[self.program.inputs.drivers + ORDERS * d + order].0
    }

    /// Solves the steps that were given, and judges each; `trust` bounds the first correction (rad, or sizes). The numbers of all
    /// bodies but ground and their derivatives go to the two lists, where they mean nothing if the steps are refused.
    #[inline(always)]
    pub fn solve(
        &mut self,
        mut trust: f64,
        [states, derivatives]: [&mut [Lanes]; 2],
    ) -> Result<Solved, Refused> {
        self.tried += 1;
        self.refused += 1;
        self.runs = 0;
        loop {
            let outputs = [lanes_of(&mut self.outputs), &mut *states, &mut *derivatives];
            let inputs = bytemuck::cast_slice(&self.inputs);
            self.room.run(&self.program.step, inputs, &self.uniforms, outputs);
            self.runs += 1;
            // All comparisons are written so that NaN is refused.
            if !all_within(self.judged(Judged::First), trust) {
                return Err(Refused);
            }
            if self.runs == 1 {
                self.missed = largest(self.judged(Judged::First));
            }
            if all_within(self.judged(Judged::Last), 0.0) {
                break;
            }
            if self.runs == MOST_RUNS {
                return Err(Refused);
            }
            trust = CONTRACTS * largest(self.judged(Judged::First));
            self.go_on_from_here();
        }
        let pivot_ratio = 1.0 / largest(self.judged(Judged::Pivots));
        let fits = all_within(self.judged(Judged::Unfit), 0.0)
            && all_within(self.judged(Judged::ScaledResidual), LOCKED)
            && pivot_ratio > 0.0;
        if !fits {
            return Err(Refused);
        }
        self.refused -= 1;
        self.repeated += usize::from(self.runs > 1);
        let residuals = [Judged::Residual, Judged::ScaledResidual].map(|which| largest(self.judged(which)));
        Ok(Solved { residuals: Residuals { largest: residuals[0], scaled: residuals[1] }, pivot_ratio })
    }

    /// Foresees the positions that were just found.
    #[cold]
    fn go_on_from_here(&mut self) {
        let (inputs, known) = (lanes_of(&mut self.inputs), self.program.inputs.known);
        inputs[..CONDITIONS].fill([0.0; LANES]);
        if !self.program.purpose.times {
            inputs[0] = [1.0; LANES];
        }
        let channels = inputs[CONDITIONS..self.program.inputs.drivers].chunks_mut(known);
        for (known, found) in channels.zip(self.outputs.chunks(ORDERS)) {
            known[0] = found[0].0;
        }
    }

    #[inline(always)]
    fn judged(&self, which: Judged) -> &Lanes {
        &self.outputs[self.program.outputs.judged + which as usize].0
    }

    /// Counts the steps that were just solved as refused: what came after them did not fit.
    pub fn refuse(&mut self) {
        self.refused += 1;
    }

    /// By how much the forecast missed at most, rad or sizes: the largest first correction of all blocks.
    pub fn missed(&self) -> f64 {
        self.missed
    }

    /// Newton's passes in all blocks.
    pub fn passes(&self) -> usize {
        self.runs * self.program.blocks.iter().map(|b| b.passes).sum::<usize>()
    }

    /// The pivot ratio of a block in one lane.
    pub fn pivot_ratio(&self, b: usize, lane: usize) -> f64 {
        1.0 / self.outputs[self.program.outputs.blocks + PER_BLOCK * b + 1].0[lane]
    }

    /// The determinant of a block, to be compared by [`Factors::ratio`](crate::space::Factors::ratio).
    #[inline(always)]
    pub fn determinant(&self, b: usize) -> Lanes {
        self.outputs[self.program.outputs.blocks + PER_BLOCK * b].0
    }

    /// Value, first and second derivative of a channel, in one lane.
    #[inline(always)]
    pub fn channel(&self, channel: usize, lane: usize) -> [f64; ORDERS] {
        std::array::from_fn(|order| self.outputs[ORDERS * channel + order].0[lane])
    }

    /// The same, in all lanes.
    #[inline(always)]
    pub fn channel_lanes(&self, channel: usize, order: usize) -> &Lanes {
        &self.outputs[ORDERS * channel + order].0
    }

    pub fn channels(&self) -> &[Channel] {
        &self.program.channels
    }

    /// Every unknown coordinate with its speed and acceleration.
    #[inline(always)]
    pub fn unknowns(&self) -> impl Iterator<Item = (usize, [&Lanes; 2])> {
        let at = |k: usize| &self.outputs[k].0;
        self.program.unknowns.iter().map(move |u| (u.coordinate, [at(u.speed), at(u.speed + 1)]))
    }

    /// Whether the speeds are those of the same branch as at the newest position, with so fast a driver.
    #[inline(always)]
    pub fn speeds_are_smooth(&self, fastest_driver: f64) -> bool {
        let [apart, fastest] = [Judged::Apart, Judged::Fastest].map(|which| self.judged(which));
        // NaN of any lane is refused.
        all_within(apart, f64::MAX) && smooth(largest(apart), largest(fastest), fastest_driver)
    }

    /// The margins of the blocks, if they are worked out.
    pub fn margins(&self) -> &[Line] {
        &self.outputs[self.program.outputs.margins..self.program.outputs.defects]
    }

    /// How many numbers all bodies but ground have, and how many their derivatives.
    pub fn sizes(&self) -> [usize; 2] {
        let Outputs { states, derivatives, .. } = self.program.outputs;
        [derivatives - states, self.program.step.sizes()[2]]
    }

    /// Which variable fails which row, by how much, and what of it may be round-off; variable by variable.
    pub fn defects(&self) -> impl Iterator<Item = (VariableId, usize, &[Lanes; 2])> {
        let found: &[Lanes] = bytemuck::cast_slice(&self.outputs[self.program.outputs.defects..]);
        let found = found.as_chunks().0;
        self.program.defects.iter().zip(found).map(|(&(variable, row), found)| (variable, row, found))
    }
}

/// Whether no lane is larger; NaN is.
#[inline(always)]
pub(super) fn all_within(lanes: &Lanes, limit: f64) -> bool {
    lanes.iter().fold(true, |all, x| all & (*x <= limit))
}

/// The largest lane, of numbers.
#[inline(always)]
pub(super) fn largest(lanes: &Lanes) -> f64 {
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let [a, b, c, d, e, f, g, h] = *lanes;
    larger(larger(larger(a, e), larger(b, f)), larger(larger(c, g), larger(d, h)))
}

//! One step of a plan as a straight-line program.
//!
//! What [`State::solve`] computes is the same at every output time and for every design, as long as Newton's method takes as many
//! corrections and the pivots keep their order. So it is recorded once, with a number of the tape in place of each number, and
//! what is left of it after folding is run eight lanes at a time. What was decided while recording is asked for again after
//! every run ([`Tape::solve`]); where the answer is another, nothing has happened, and the kernel itself solves the step.
//!
//! Not recorded are mechanisms with sparse blocks, with curves, and with couplers, whose angles go by the turn that is expected;
//! and those that are so large that a program each would cost more than it saves.

use std::sync::{Arc, OnceLock};

use hardpoint_code::{Code, Scratch};
use hardpoint_tape::{Interpreter, Lanes, Number, Options, Program, record};

use crate::joint::Freedom;
use crate::model::BodyId;
use crate::number::record as recording;
use crate::space::{LANES, LARGEST_DENSE, MOST_GROWTH, Quat, Real, Vec3, Watched};
use crate::topology::{Source, Topology};

use super::kinematics::{CORRECTIONS, QUADRATIC, ROUND_OFF, Residuals, State};
use super::parts::Parts;
use super::stepper::{LOCKED, Saved, Stepper};
use super::{BodyState, turn_over};

/// Newton's first correction while recording, in units of each coordinate, for a program with one correction and for one with two:
/// the one is followed by round-off, the other by what is accepted as the last.
const OFFSET: [f64; 2] = [1e-9, 1e-5];
/// Mechanisms with more links than this are not recorded: the program would no longer stay in the fast memory of a core.
const MOST_LINKS: usize = 200;

/// What a program is for.
#[derive(Clone, Debug)]
pub(crate) struct Purpose {
    /// Per number of the geometry, in the order of [`Parts::map`]: its value, or none where it is an input.
    pub geometry: Vec<Option<f64>>,
    /// Other designs have the same value if it differs by no more than this: their round-off.
    pub same: f64,
    /// Newton's corrections: one or two.
    pub corrections: usize,
}

/// What was recorded besides the motion.
#[derive(Default)]
pub(crate) struct Recorded {
    /// Where any of these is positive, the results do not count.
    pub limits: Vec<Number>,
    pub results: Vec<Number>,
}

/// The program of a step.
#[derive(Debug)]
pub(crate) struct StepProgram {
    purpose: Purpose,
    /// What depends on the design alone, and what does not.
    design: Runnable,
    step: Runnable,
    channels: Vec<Channel>,
    blocks: Vec<BlockProgram>,
    places: Outputs,
    /// How many bodies there are but ground.
    bodies: usize,
    /// How many results besides the motion must not be positive.
    limits: usize,
}

/// A program, as machine code where there is any.
#[derive(Debug)]
struct Runnable {
    program: Program,
    code: Option<Code>,
}

impl Runnable {
    fn new(program: Program, execution: Execution) -> Self {
        let code = if execution == Execution::Interpreted { None } else { Code::new(&program).ok() };
        Self { program, code }
    }
}

/// How a block was recorded.
#[derive(Clone, Copy, Debug)]
struct BlockProgram {
    /// The largest factor in the order of the pivots.
    growth: f64,
    /// Whether a positive product of the pivots is a positive determinant.
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
            is_even: state.pivots[b].1 == positive,
            passes: *passes,
            last,
            limit,
        })
    }
}

/// An unknown that a step is predicted by.
#[derive(Clone, Copy, Debug)]
enum Channel {
    Coordinate(usize),
    /// The ball that begins at a coordinate.
    Ball(usize),
}

/// Where the outputs of a program begin.
#[derive(Clone, Copy, Debug)]
struct Outputs {
    blocks: usize,
    residuals: usize,
    bodies: usize,
    limits: usize,
}

impl Outputs {
    fn of(channels: &[Channel], blocks: usize, bodies: usize) -> Self {
        let first = channels.iter().map(|c| c.counts().1).sum();
        let residuals = first + PER_BLOCK * blocks;
        let of_bodies = residuals + 2;
        Self { blocks: first, residuals, bodies: of_bodies, limits: of_bodies + PER_BODY * bodies }
    }
}

/// Per block: product, most, least and growth of its factors; the first correction, and the last.
const PER_BLOCK: usize = 6;
/// Per body: as in [`BodyState`].
const PER_BODY: usize = 24;

impl Channel {
    fn all(topology: &Topology) -> Vec<Self> {
        let mut out = Vec::new();
        for step in topology.links.iter().flat_map(|l| &l.steps) {
            match (topology.coordinates[step.first].source, step.freedom) {
                (Source::Driven(_), _) => {}
                (_, Freedom::Ball) => out.push(Self::Ball(step.first)),
                _ => out.push(Self::Coordinate(step.first)),
            }
        }
        out
    }

    /// How many numbers predict it, and how many say where it is and how it moves.
    fn counts(self) -> (usize, usize) {
        match self {
            Self::Coordinate(_) => (1, 3),
            Self::Ball(_) => (4, 10),
        }
    }
}

impl StepProgram {
    /// Whether the steps of a plan can be recorded, and are short enough for that.
    pub fn suits(topology: &Topology) -> bool {
        topology.links.len() <= MOST_LINKS
            && topology.blocks.iter().all(|b| b.unknowns.len() <= LARGEST_DENSE)
            && topology.coupled_rows.is_empty()
            && topology.closures.iter().all(|c| c.contact.is_none())
    }

    /// Records the step that is solved where `one` stands, and what `besides` makes of it; none where either cannot be recorded.
    pub fn record(
        one: &Stepper<'_, f64>,
        purpose: Purpose,
        besides: impl FnOnce(&Topology, &mut State<Number>) -> Option<Recorded>,
        execution: Execution,
    ) -> Option<Self> {
        let (model, topology) = (one.model, &one.topology);
        let channels = Channel::all(topology);
        let (mut fits, mut blocks, mut limits) = (false, Vec::new(), 0);
        recording::begin();
        let recorded = record(|| {
            let mut state = State::new(model, topology, Number::constant(0.0));
            predict(topology, &channels, &one.saved, OFFSET[purpose.corrections - 1], &mut state);
            let drivers: Vec<[Number; 3]> = one.saved.drivers.iter().map(|f| f.map(Number::input)).collect();
            let mut of_geometry = purpose.geometry.iter();
            let parts = one.parts.map(0.0, |x| match of_geometry.next() {
                Some(Some(x)) => Number::constant(*x),
                _ => Number::input(x),
            });
            fits = state.solve(topology, &parts, &drivers, f64::INFINITY).is_ok();
            let recorded = (0..topology.blocks.len()).map_while(|b| BlockProgram::of(&state, b));
            blocks = recorded.collect::<Vec<_>>();
            fits &= blocks.len() == topology.blocks.len();
            let mut out = outputs(topology, (&parts, &drivers), (&channels, &blocks), &state);
            match besides(topology, &mut state) {
                Some(found) => {
                    limits = found.limits.len();
                    out.extend(found.limits.into_iter().chain(found.results));
                }
                None => fits = false,
            }
            out
        });
        if !fits || !recording::is_arithmetic() {
            return None;
        }
        let (program, _) = recorded.program(Options::default());
        let first = inputs_before_geometry(&channels, model.drivers.len());
        let (design, step) = program.staged(|input| input as usize >= first);
        let [design, step] = [design, step].map(|program| Runnable::new(program, execution));
        // The interpreter is no faster than the kernel.
        if step.code.is_none() && execution == Execution::Fastest {
            return None;
        }
        let bodies = model.bodies.len() - 1;
        let places = Outputs::of(&channels, blocks.len(), bodies);
        Some(Self { purpose, design, step, channels, blocks, places, bodies, limits })
    }
}

fn inputs_before_geometry(channels: &[Channel], drivers: usize) -> usize {
    channels.iter().map(|c| c.counts().0).sum::<usize>() + 3 * drivers
}

/// Makes inputs of what predicts the state, `offset` beside where `at` is.
fn predict(
    topology: &Topology,
    channels: &[Channel],
    at: &Saved<f64>,
    offset: f64,
    state: &mut State<Number>,
) {
    for channel in channels {
        match *channel {
            Channel::Coordinate(c) => {
                state.q[c] = Number::input(at.q[c] + offset * topology.coordinates[c].unit);
            }
            Channel::Ball(c) => {
                let beside = at.balls[c].nudged(Vec3::new(offset, offset, offset));
                let component = |k: usize| Number::input(beside.component(k));
                let w = component(0);
                state.balls[c] = Quat { w, v: Vec3::new(component(1), component(2), component(3)) };
            }
        }
    }
}

/// What a step hands out, in order.
fn outputs(
    topology: &Topology,
    (parts, drivers): (&Parts<Number>, &[[Number; 3]]),
    (channels, blocks): (&[Channel], &[BlockProgram]),
    state: &State<Number>,
) -> Vec<Number> {
    let mut out = Vec::new();
    for channel in channels {
        match *channel {
            Channel::Coordinate(c) => out.extend([state.q[c], state.qd[c], state.qdd[c]]),
            Channel::Ball(c) => {
                out.extend((0..4).map(|k| state.balls[c].component(k)));
                out.extend_from_slice(&state.qd[c..c + 3]);
                out.extend_from_slice(&state.qdd[c..c + 3]);
            }
        }
    }
    for ((w, (corrections, _)), block) in state.watched.iter().zip(&state.corrections).zip(blocks) {
        out.extend([w.product, w.most, w.least, w.growth, corrections[0], corrections[block.last]]);
    }
    out.extend(state.residuals_in_lanes(topology, parts, drivers));
    for body in 1..state.pose.len() {
        out.extend(BodyState::components(state, body).into_iter().flatten());
    }
    out
}

/// Recording pays from so many steps on: it costs about as much as they do.
const PAYS: usize = 500;
/// After so many steps, a program that was refused in more than a quarter of them is given up.
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

/// The programs of a plan, with one correction and with two, each recorded when it is first asked for.
///
/// They are recorded of the nominal design where its motion begins, so that they do not depend on who asks first.
#[derive(Debug)]
pub(crate) struct Programs {
    execution: Execution,
    /// Of any design; and with the sensitivities of the nominal one.
    motion: [OnceLock<Option<Arc<StepProgram>>>; 2],
    sensitivities: [OnceLock<Option<Arc<StepProgram>>>; 2],
}

impl Programs {
    /// None as yet.
    pub fn new(execution: Execution) -> Self {
        Self { execution, motion: Default::default(), sensitivities: Default::default() }
    }

    /// Whether so many steps are worth a program.
    pub fn pay(&self, steps: usize) -> bool {
        match self.execution {
            Execution::Fastest => steps >= PAYS,
            Execution::Kernel => false,
            Execution::Interpreted | Execution::Compiled => true,
        }
    }

    /// The program with so many corrections; `record` makes it for this execution, if it was not asked for before.
    pub fn get(
        &self,
        sensitivities: bool,
        corrections: usize,
        record: impl FnOnce(Execution) -> Option<StepProgram>,
    ) -> Option<Arc<StepProgram>> {
        let kept = if sensitivities { &self.sensitivities } else { &self.motion };
        kept[corrections - 1].get_or_init(|| record(self.execution).map(Arc::new)).clone()
    }
}

/// Gives the program with so many corrections, if there is one.
pub(crate) type ProgramOf<'p> = Box<dyn Fn(usize) -> Option<Arc<StepProgram>> + 'p>;

/// A step that the program does not fit: the kernel solves it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Refused;

/// A program at work, with what it works in.
pub(crate) struct Tape {
    program: Arc<StepProgram>,
    interpreter: Option<Interpreter>,
    scratch: Scratch,
    inputs: Vec<Lanes>,
    outputs: Vec<Lanes>,
    /// Steps that were tried, and those that were refused.
    tried: usize,
    refused: usize,
}

impl Tape {
    /// Whether it is refused so often that the kernel alone is faster.
    pub fn is_of_no_use(&self) -> bool {
        self.tried >= TRIAL && 4 * self.refused > self.tried
    }

    /// How many corrections it makes.
    pub fn corrections(&self) -> usize {
        self.program.purpose.corrections
    }

    /// For the design in each lane of these parts; none where they differ from the program's in what is no input.
    pub fn new<T: Real>(program: Arc<StepProgram>, parts: &Parts<T>, witness: T) -> Option<Self> {
        let mut geometry = Vec::new();
        for (x, known) in parts.numbers(witness).into_iter().zip(&program.purpose.geometry) {
            let mut lanes = [x.lane(0); LANES];
            x.store(&mut lanes);
            match known {
                None => geometry.push(lanes),
                Some(known) if lanes.iter().all(|x| (x - known).abs() <= program.purpose.same) => {}
                Some(_) => return None,
            }
        }
        let StepProgram { design, step, .. } = &*program;
        let mut of_design = vec![[0.0; LANES]; design.program.outputs.len()];
        let first = step.program.inputs - of_design.len() - geometry.len();
        let mut inputs = vec![[0.0; LANES]; first];
        inputs.extend(geometry);
        let (mut scratch, given) = (Scratch::default(), &inputs[..design.program.inputs]);
        match &design.code {
            Some(code) => code.run(&mut scratch, given, &[], &mut of_design),
            None => Interpreter::new(&design.program).run(given, &[], &mut of_design),
        }
        inputs.extend(of_design);
        let outputs = vec![[0.0; LANES]; step.program.outputs.len()];
        let interpreter = step.code.is_none().then(|| Interpreter::new(&step.program));
        Some(Self { interpreter, scratch, inputs, outputs, program, tried: 0, refused: 0 })
    }

    /// Solves what stands in `state`, the prediction, for these drivers: coordinates with their rates, and what the blocks are judged by.
    /// `branch` says which sign of each determinant is expected, and `least` which pivot ratio at the least; `trust` bounds the first
    /// correction (rad, or sizes).
    #[inline(always)]
    pub fn solve<T: Real>(
        &mut self,
        state: &mut State<T>,
        drivers: &[[T; 3]],
        (branch, least): (&[(bool, f64)], &[f64]),
        trust: f64,
    ) -> Result<Residuals, Refused> {
        self.tried += 1;
        self.refused += 1;
        let (program, witness) = (&self.program, state.witness);
        let mut inputs = self.inputs.iter_mut();
        let mut give = |x: T| {
            if let Some(lanes) = inputs.next() {
                x.store(lanes);
            }
        };
        for channel in &program.channels {
            match *channel {
                Channel::Coordinate(c) => give(state.q[c]),
                Channel::Ball(c) => (0..4).for_each(|k| give(state.balls[c].component(k))),
            }
        }
        drivers.iter().flatten().for_each(|f| give(*f));
        match (&program.step.code, &mut self.interpreter) {
            (Some(code), _) => code.run(&mut self.scratch, &self.inputs, &[], &mut self.outputs),
            (None, Some(interpreter)) => interpreter.run(&self.inputs, &[], &mut self.outputs),
            (None, None) => return Err(Refused),
        }
        let (at, places) = (|k: usize| witness.gather(self.outputs[k]), program.places);
        // All comparisons are written so that NaN is refused.
        for (b, recorded) in program.blocks.iter().enumerate() {
            let k = places.blocks + PER_BLOCK * b;
            let [product, most, least_inverse, growth, first, last] = std::array::from_fn(|n| at(k + n));
            let watched = Watched { product, most, least: least_inverse, growth };
            if !(first.largest() <= trust && last.largest() <= recorded.limit) {
                return Err(Refused);
            }
            let (ratio, positive) = watched.verdict();
            let positive = positive == recorded.is_even;
            let grown = watched.growth.largest() <= f64::max(MOST_GROWTH, 2.0 * recorded.growth);
            if !(grown && positive == branch[b].0 && ratio > 0.0 && ratio >= least[b]) {
                return Err(Refused);
            }
            state.pivots[b] = (ratio, positive);
            state.determinants[b] = watched.product.abs();
        }
        let residuals =
            Residuals { largest: at(places.residuals).largest(), scaled: at(places.residuals + 1).largest() };
        let limits = &self.outputs[places.limits..places.limits + program.limits];
        if !(residuals.scaled <= LOCKED) || !limits.iter().all(|l| witness.gather(*l).largest() <= 0.0) {
            return Err(Refused);
        }
        let mut k = 0;
        for channel in &program.channels {
            match *channel {
                Channel::Coordinate(c) => {
                    (state.q[c], state.qd[c], state.qdd[c]) = (at(k), at(k + 1), at(k + 2));
                }
                Channel::Ball(c) => {
                    let v = Vec3::new(at(k + 1), at(k + 2), at(k + 3));
                    state.balls[c] = Quat { w: at(k), v };
                    for axis in 0..3 {
                        state.q[c + axis] = witness.zero();
                        (state.qd[c + axis], state.qdd[c + axis]) = (at(k + 4 + axis), at(k + 7 + axis));
                    }
                }
            }
            k += channel.counts().1;
        }
        state.iterations += program.blocks.iter().map(|b| b.passes).sum::<usize>();
        self.refused -= 1;
        Ok(residuals)
    }

    /// What the last step handed out besides the motion.
    pub fn besides(&self) -> &[Lanes] {
        &self.outputs[self.program.places.limits + self.program.limits..]
    }

    /// Gives the states of the wanted bodies but ground in every lane to `out(lane, body, state)`, as of the last step.
    #[inline(always)]
    pub fn each_body<T: Real>(
        &self,
        wanted: &[bool],
        witness: T,
        mut out: impl FnMut(usize, BodyId, BodyState),
    ) {
        let mut table = [[0.0; PER_BODY]; LANES];
        let first = self.program.places.bodies;
        for body in (1..=self.program.bodies).filter(|b| wanted[*b]) {
            let k = first + PER_BODY * (body - 1);
            let components: [[T; 8]; 3] =
                std::array::from_fn(|i| std::array::from_fn(|j| witness.gather(self.outputs[k + 8 * i + j])));
            turn_over(&components, &mut table);
            for (lane, x) in table[..T::LANES].iter().enumerate() {
                out(lane, BodyId(body), BodyState::from_components(x));
            }
        }
    }
}

//! Execution of a step's program: eight output times of one design, or eight designs at one output time, in a batch.

use std::sync::Arc;

use hardpoint_tape::{LANES, Lanes};

use crate::blocks::{AlignedLanes, lanes_of};
use crate::model::{BodyId, VariableId};
use crate::number;
use crate::topology::{CoordinateId, RowId, SetBy, Topology};

use super::execution::ProgramMemory;
use super::guard::StepGuard;
use super::kinematics::Residuals;
use super::mechanism::{Branch, LOCKED};
use super::predictor::{Channel, ORDERS};
use super::step::RoughStep;
use super::step_program::{CONDITIONS, Inputs, Outputs, PER_BLOCK, Purpose, StepCheck, StepProgram};

/// Maximum number of runs; the kernel solves steps that have not converged then.
const MOST_RUNS: usize = 4;
/// From one run to the next the first correction must become smaller by this factor, as Newton's corrections must.
const CONTRACTS: f64 = 0.5;
/// Number of groups of steps after which a program is given up if it was rejected in more than a quarter of them.
const TRIAL: usize = 8;

/// A program with its working memory: one design in all lanes, or one in each.
pub(crate) struct Tape {
    program: Arc<StepProgram>,
    room: ProgramMemory,
    inputs: Vec<AlignedLanes>,
    /// Node values of the channels, if lanes are output times.
    uniforms: Vec<f64>,
    outputs: Vec<AlignedLanes>,
    /// Groups of steps that were tried, those that were rejected, and those that took more than one run.
    tried: usize,
    refused: usize,
    repeated: usize,
    /// Number of runs of the last solution, and the largest first correction of its first run, rad or sizes.
    runs: usize,
    missed: f64,
}

/// Quality of a solution.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SolveQuality {
    pub residuals: Residuals,
    /// The smallest pivot ratio of all blocks.
    pub pivot_ratio: f64,
}

impl Tape {
    pub fn new(program: Arc<StepProgram>) -> Self {
        let inputs = vec![AlignedLanes::default(); program.program.step.inputs()];
        let outputs = vec![AlignedLanes::default(); program.outputs.states];
        let uniforms = if program.purpose.times { CONDITIONS * program.channels.len() } else { 0 };
        Self {
            room: ProgramMemory::default(),
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

    /// Sets the designs, one per lane; surplus lanes have the last one.
    pub fn set_designs(&mut self, designs: &[Vec<f64>]) {
        let StepProgram { program, inputs, variables, .. } = &*self.program;
        for v in 0..*variables {
            let of_lane = |k: usize| designs[usize::min(k, designs.len() - 1)][v];
            self.inputs[inputs.design + v] = AlignedLanes(std::array::from_fn(of_lane));
        }
        program.take_design(&mut self.inputs);
    }

    /// True if it is rejected so often that the kernel alone is faster.
    pub fn is_of_no_use(&self) -> bool {
        self.tried >= TRIAL && 4 * self.refused > self.tried
    }

    /// True if so often more than one run is needed that a program with more corrections would be faster.
    pub fn is_too_short(&self) -> bool {
        self.tried >= TRIAL && 4 * self.repeated > self.tried
    }

    /// True if its determinants have the signs of these branches.
    pub fn is_on(&self, branch: &[Branch]) -> bool {
        self.program.blocks.iter().zip(branch).all(|(block, branch)| block.positive == branch.positive)
    }

    /// Pairs of a variable and a body that it moves, in the order of their derivatives.
    pub fn moved(&self) -> &[(VariableId, BodyId)] {
        &self.program.moved
    }

    /// The coordinates of the tree; 0 for those of balls.
    #[inline(always)]
    pub fn coordinates(&self, topology: &Topology, out: &mut [Lanes]) {
        for (coordinate, out) in topology.coordinates.iter().zip(&mut *out) {
            *out = match coordinate.set_by {
                SetBy::Driver(d) => *self.driver(d.0, 0),
                SetBy::Block { .. } => [0.0; LANES],
            };
        }
        for (n, channel) in self.program.channels.iter().enumerate() {
            if let Channel::Coordinate(c) = *channel {
                out[c.0] = *self.channel_lanes(n, 0);
            }
        }
    }

    /// Writes value, first and second derivative of every channel in all lanes.
    pub fn write_channels(&self, out: &mut [Lanes]) {
        out.copy_from_slice(bytemuck::cast_slice(&self.outputs[..out.len()]));
    }

    /// Purpose of the program.
    pub fn purpose(&self) -> Purpose {
        self.program.purpose
    }

    /// Sets the times ahead of the newest position, and the weights of the prediction: by position, the newest first,
    /// and order of its derivative. `are_new` is false if the weights have not changed.
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

    /// Node values of a channel at one output time, per design, ordered like the weights.
    #[inline(always)]
    pub fn known_mut(&mut self, channel: usize) -> &mut [Lanes] {
        &mut lanes_of(&mut self.inputs)[CONDITIONS * (1 + channel)..][..CONDITIONS]
    }

    /// Node values of every channel of one design, ordered like the weights.
    #[inline(always)]
    pub fn known_of_times_mut(&mut self) -> &mut [[f64; CONDITIONS]] {
        self.uniforms.as_chunks_mut().0
    }

    /// Value, speed and acceleration of every driver, then the laws of forces where loads are requested.
    #[inline(always)]
    pub fn laws_mut(&mut self) -> &mut [Lanes] {
        let Inputs { drivers, ahead, .. } = self.program.inputs;
        &mut lanes_of(&mut self.inputs)[drivers..ahead]
    }

    /// Drivers and laws that were set.
    #[inline(always)]
    pub fn driver(&self, d: usize, order: usize) -> &Lanes {
        &self.inputs[self.program.inputs.drivers + ORDERS * d + order].0
    }

    /// Solves the given steps and checks each; `trust` bounds the first correction (rad, or sizes). The values of all
    /// bodies but ground and their derivatives are written to the two lists; they are invalid if the steps are
    /// rejected.
    #[inline(always)]
    pub fn solve(
        &mut self,
        mut trust: f64,
        [states, derivatives]: [&mut [Lanes]; 2],
    ) -> Result<SolveQuality, RoughStep> {
        self.tried += 1;
        self.refused += 1;
        self.runs = 0;
        loop {
            let outputs = [lanes_of(&mut self.outputs), &mut *states, &mut *derivatives];
            let inputs = bytemuck::cast_slice(&self.inputs);
            self.room.run(&self.program.program.step, inputs, &self.uniforms, outputs);
            self.runs += 1;
            // All comparisons reject NaN.
            if !all_within(self.judged(StepCheck::First), trust) {
                return Err(RoughStep);
            }
            if self.runs == 1 {
                self.missed = largest(self.judged(StepCheck::First));
            }
            if all_within(self.judged(StepCheck::Last), 0.0) {
                break;
            }
            if self.runs == MOST_RUNS {
                return Err(RoughStep);
            }
            // As in (26): the next first correction must be at most half of this one.
            trust = CONTRACTS * largest(self.judged(StepCheck::First));
            self.go_on_from_here();
        }
        // min / max of the pivots = 1 / (max abs(pivot) max abs(1 / pivot)), of the worst block and lane
        let pivot_ratio = 1.0 / largest(self.judged(StepCheck::Pivots));
        let fits = all_within(self.judged(StepCheck::Unfit), 0.0)
            && all_within(self.judged(StepCheck::ScaledResidual), LOCKED)
            && pivot_ratio > 0.0;
        if !fits {
            return Err(RoughStep);
        }
        self.refused -= 1;
        self.repeated += usize::from(self.runs > 1);
        let residuals = Residuals {
            largest: largest(self.judged(StepCheck::Residual)),
            scaled: largest(self.judged(StepCheck::ScaledResidual)),
        };
        Ok(SolveQuality { residuals, pivot_ratio })
    }

    /// Predicts the positions that were just found.
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
    fn judged(&self, which: StepCheck) -> &Lanes {
        &self.outputs[self.program.outputs.judged + which as usize].0
    }

    /// Counts the last steps as rejected, because a later check failed.
    pub fn refuse(&mut self) {
        self.refused += 1;
    }

    /// Largest error of the prediction, rad or sizes: the largest first correction of all blocks.
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

    /// The determinant of a block, to be compared by [`Factors::ratio`](crate::linalg::Factors::ratio).
    #[inline(always)]
    pub fn determinant(&self, b: usize) -> Lanes {
        self.outputs[self.program.outputs.blocks + PER_BLOCK * b].0
    }

    /// Value, first and second derivative of a channel, in one lane.
    #[inline(always)]
    pub fn channel(&self, channel: usize, lane: usize) -> [f64; ORDERS] {
        let at = |order: usize| self.outputs[ORDERS * channel + order].0[lane];
        [at(0), at(1), at(2)]
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
    pub fn unknowns(&self) -> impl Iterator<Item = (CoordinateId, [&Lanes; 2])> {
        let at = |k: usize| &self.outputs[k].0;
        self.program.unknowns.iter().map(move |u| (u.coordinate, [at(u.speed), at(u.speed + 1)]))
    }

    /// True if the guard trusts the speeds in all lanes.
    #[inline(always)]
    pub fn speeds_are_smooth<const N: usize>(&self, guard: &StepGuard<N>) -> bool {
        let [apart, fastest] =
            number::both([StepCheck::Apart, StepCheck::Fastest], |which| self.judged(which));
        // NaN in any lane is rejected.
        all_within(apart, f64::MAX) && guard.speeds_are_smooth(largest(apart), largest(fastest))
    }

    /// Margins of the blocks, if computed.
    pub fn margins(&self) -> &[AlignedLanes] {
        let Outputs { margins, defects, .. } = self.program.outputs;
        &self.outputs[margins..defects]
    }

    /// Measures that need more of a step than the motion of the bodies, with their derivatives, if computed.
    pub fn measures(&self) -> &[AlignedLanes] {
        let Outputs { measures, states, .. } = self.program.outputs;
        &self.outputs[measures..states]
    }

    /// Number of values of all bodies but ground, and of their derivatives.
    pub fn sizes(&self) -> [usize; 2] {
        let [_, states, derivatives] = self.program.program.step.sizes();
        [states, derivatives]
    }

    /// Defects of all pairs of a variable and a row, with the part that may be round-off; variable by variable.
    pub fn defects(&self) -> impl Iterator<Item = (VariableId, RowId, &[Lanes; 2])> {
        let Outputs { defects, measures, .. } = self.program.outputs;
        let found: &[Lanes] = bytemuck::cast_slice(&self.outputs[defects..measures]);
        let found = found.as_chunks().0;
        self.program.defects.iter().zip(found).map(|(&(variable, row), found)| (variable, row, found))
    }
}

/// True if no lane is larger; NaN counts as larger.
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

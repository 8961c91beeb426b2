//! Batch of eight output times of a single design, solved by a straight-line program.
//!
//! In a smooth motion the prediction of the next eight output times is so accurate that they can be corrected together.
//! Every check of a single step is made at each of them, and more strictly. If a check fails, the results are
//! discarded, and the steps are solved one by one.

use std::sync::Arc;

use hardpoint_tape::{LANES, Lanes};

use crate::blocks::{AlignedLanes, ResultBlock, lanes_of};

use super::execution::{ProgramMemory, Runnable};
use super::kinematics::QUADRATIC;
use super::margin::Margin;
use super::predictor::{NODES, ORDERS, Weights};
use super::step_program::{MOST_CORRECTIONS, StepProgram};
use super::stepper::{
    AcceptedPosition, EVEN, LONGEST, Lookahead, MILD, MILD_CHANGE, RESTS, Stepper, TRUST_FLOOR,
};
use super::tape::{SolveQuality, Tape, all_within, largest};
use super::turns::TurnCounter;
use super::walk::PART_OF_WAY;

/// Maximum first correction (rad, or sizes) after a prediction by all stored positions.
const FORECAST_TRUST: f64 = 1e-3;
/// Minimum and maximum number of steps that are solved one by one after a failure.
const PAUSE: [usize; 2] = [LANES, 64];
/// Interval over which the range of a law is evaluated, in lengths of a batch.
const CELL: f64 = 8.0;
/// Minimum number of steps of a batch.
const FEWEST: usize = 3;

/// Function that returns the program with this number of corrections, if there is one.
pub(crate) type ProgramOf<'p> = Box<dyn Fn(usize) -> Option<Arc<StepProgram>> + 'p>;

/// Solver of up to eight steps of a stepper at once.
pub(crate) struct TimeBatch<'p> {
    /// Source of programs.
    programs: Option<ProgramOf<'p>>,
    /// The values of the design's variables.
    design: Vec<f64>,
    tape: Option<Tape>,
    laws: Laws,
    weights: Weights,
    /// Number of single steps before the next try, and length of the next pause.
    wait: usize,
    pause: usize,
    /// Results that have no memory elsewhere; true if the last results are here.
    own: [Vec<AlignedLanes>; 2],
    is_own: bool,
}

/// The laws of drivers, and of forces, at eight times.
struct Laws {
    program: Option<Arc<Runnable>>,
    room: ProgramMemory,
    limits: Vec<AlignedLanes>,
}

impl<'p> TimeBatch<'p> {
    /// Solver by these programs, for a design with these values; `laws` is the program of its laws, if there is one.
    pub fn new(programs: Option<ProgramOf<'p>>, design: &[f64], laws: Option<Arc<Runnable>>) -> Self {
        let limits = vec![AlignedLanes::default(); laws.as_ref().map_or(0, |laws| laws.sizes()[1])];
        let laws = Laws { program: laws, room: ProgramMemory::default(), limits };
        Self {
            programs,
            design: design.to_vec(),
            tape: None,
            laws,
            weights: Weights::default(),
            wait: 0,
            pause: PAUSE[0],
            own: [Vec::new(), Vec::new()],
            is_own: false,
        }
    }

    /// Result of the last solution.
    ///
    /// # Panics
    /// Panics if nothing was solved.
    pub fn solved(&self) -> &Tape {
        self.tape.as_ref().expect("a tape has solved the steps")
    }

    /// Results that have no memory elsewhere.
    pub fn own_results(&self) -> Option<ResultBlock<'_>> {
        let [states, derivatives] = self.own.each_ref().map(|own| bytemuck::cast_slice(own));
        self.is_own.then_some(ResultBlock { states, derivatives })
    }

    /// Advances from the stepper's position by the largest number of output times, from output time k on, that a
    /// program can solve at once. Returns this number; 0 if the kernel has to solve them one by one. Output times 8n to
    /// 8n + 7 are stored together, so a batch ends with such a group; those of the group before k are solved again and
    /// ignored. Results go to `room` if there is one; otherwise they are stored here.
    #[inline]
    pub fn advance<'r>(
        &mut self,
        one: &mut Stepper<'_>,
        k: usize,
        times: &[f64],
        room: impl FnOnce() -> Option<[&'r mut [Lanes]; 2]>,
    ) -> usize {
        let (first, group) = (k % LANES, k - k % LANES);
        let last = usize::min(times.len() - group, LANES) - 1;
        let count = last + 1 - first;
        if self.programs.is_none() || count < FEWEST || one.ahead == Lookahead::Unknown {
            return 0;
        }
        if self.wait > 0 {
            self.wait -= 1;
            return 0;
        }
        let times: Lanes = std::array::from_fn(|lane| times[group + usize::min(lane, last)]);
        if one.forecast.known() == 0 || !self.choose_tape(one, [times[last], count as f64]) {
            return 0;
        }
        if self.try_to(one, &times, [first, last], room()).is_some() {
            self.pause = PAUSE[0];
            return count;
        }
        self.wait = self.pause;
        self.pause = usize::min(2 * self.pause, PAUSE[1]);
        0
    }

    /// Makes a tape if there is none, and replaces or drops one that does not fit; returns true if there is one. Up to
    /// `last` there are `count` steps.
    fn choose_tape(&mut self, one: &Stepper<'_>, [last, count]: [f64; 2]) -> bool {
        let corrections = match &self.tape {
            _ if one.selections > 0 => None,
            Some(tape) if tape.is_of_no_use() => None,
            Some(tape) if tape.is_too_short() && tape.purpose().corrections < MOST_CORRECTIONS => {
                Some(tape.purpose().corrections + 1)
            }
            Some(_) => return true,
            None if missed(one, last, count) <= QUADRATIC => Some(1),
            None => Some(MOST_CORRECTIONS),
        };
        let program = corrections.zip(self.programs.as_ref()).and_then(|(n, program)| program(n));
        self.tape = program.map(Tape::new).filter(|tape| tape.is_on(&one.branch));
        match &mut self.tape {
            Some(tape) => tape.set_designs(std::slice::from_ref(&self.design)),
            None => self.programs = None,
        }
        self.tape.is_some()
    }

    /// Tries these output times, of which those from lane `first` to lane `last` are new.
    #[inline(always)]
    fn try_to(
        &mut self,
        one: &mut Stepper<'_>,
        times: &Lanes,
        [first, last]: [usize; 2],
        room: Option<[&mut [Lanes]; 2]>,
    ) -> Option<()> {
        let tape = self.tape.as_mut()?;
        self.laws.at(one, times, tape.laws_mut())?;
        if !laws_are_even(tape, one, times, [first, last]) {
            return None;
        }
        one.fastest_driver = fastest_driver(tape, one);
        // t - z_0 of (27) in every lane, z_0 the stepper's own time
        let ahead = times.map(|t| t - one.time);
        let are_new = self.weights.set(one.forecast.nodes(ahead[last]), &ahead);
        tape.look_ahead(&self.weights.of, are_new, &ahead);
        for (channel, known) in tape.known_of_times_mut().iter_mut().enumerate() {
            known.copy_from_slice(one.forecast.known_of(channel).as_flattened());
        }
        // Earlier results are not overwritten, even if these steps are rejected.
        let room = room.filter(|room| first == 0 && room.each_ref().map(|part| part.len()) == tape.sizes());
        self.is_own = room.is_none();
        let [states, derivatives] = room.unwrap_or_else(|| {
            for (own, size) in self.own.iter_mut().zip(tape.sizes()) {
                own.resize(size, AlignedLanes::default());
            }
            self.own.each_mut().map(|own| lanes_of(own))
        });
        // The first steps of a motion have fewer nodes. With three nodes the error of the prediction is that of (27); a
        // first correction above 1e-3 means that the motion is not smooth enough.
        let trust = if one.forecast.known() < NODES { TRUST_FLOOR } else { FORECAST_TRUST };
        let solved = tape.solve(trust, [&mut *states, derivatives]).ok()?;
        let change_step = determinants_are_even(tape, one, times, [first, last]);
        let change_step = change_step.filter(|_| tape.speeds_are_smooth(one.fastest_driver));
        let moved = one.moves_ahead.iter().sum();
        let turns =
            |turns: &mut TurnCounter<'_>| turns.are_even(states, (times, one.time), [first, last], moved);
        match change_step.filter(|_| one.turns.as_mut().is_none_or(turns)) {
            Some(step) => {
                one.continue_from(tape, times, [first, last], solved, step);
                Some(())
            }
            None => {
                tape.refuse();
                None
            }
        }
    }
}

impl Laws {
    /// Value, speed and acceleration of every driver at these times, and the values of the laws of forces, if
    /// requested; `None` if one is not finite.
    #[inline(always)]
    fn at(&mut self, one: &Stepper<'_>, times: &Lanes, laws: &mut [Lanes]) -> Option<()> {
        let mut by_program = false;
        if let Some(program) = &self.program {
            let limits = lanes_of(&mut self.limits);
            self.room.run(program, std::slice::from_ref(times), &[], [&mut *laws, &mut *limits, &mut []]);
            by_program = limits.iter().all(|limit| all_within(limit, 0.0));
        }
        if !by_program {
            let (drivers, forces) = laws.split_at_mut(ORDERS * one.drivers.len());
            for (force, law) in forces.iter_mut().zip(one.model.laws_of_forces()) {
                *force = times.map(|t| law.at(t).value());
            }
            for (d, driver) in drivers.chunks_exact_mut(ORDERS).enumerate() {
                for lane in 0..LANES {
                    for (to, x) in driver.iter_mut().zip(one.parts.law_of(d).at(times[lane]).derivatives()) {
                        to[lane] = x;
                    }
                }
            }
        }
        let finite = laws.iter().all(|x| all_within(&x.map(f64::abs), f64::MAX));
        finite.then_some(())
    }
}

/// Estimated error of a prediction eight steps beyond three positions that are four steps apart, rad or sizes: the
/// remainder of the Hermite interpolation, `x^9 / 9!` times the ninth derivative, for a sinusoidal motion. The
/// frequency is that of the fastest driver's rotation, or of its law. Up to `last` there are `count` steps.
fn missed(one: &Stepper<'_>, last: f64, count: f64) -> f64 {
    let frequency = |d: usize| {
        let speed = one.parts.fastest(d, one.time, last);
        // omega = f. / unit: all bodies that a rotating driver moves follow sin(omega t). Or f itself follows
        // sin(omega t), and then f... = -omega^2 f.
        let [.., third] = one.parts.law_of(d).at(one.time).derivatives();
        let of_law = if speed > 0.0 { (third.abs() / speed).sqrt() } else { 0.0 };
        f64::max(speed / one.driver_units[d], of_law)
    };
    let step = (0..one.drivers.len()).map(frequency).fold(0.0, f64::max) * (last - one.time) / count;
    // abs(q - p) <= max abs(q(9)) / 9! prod (t - z_i), the z_i thrice 0, -4 and -8 steps h, t = 8 h: (8 12 16)^3 (omega
    // h)^9 / 9!
    let far = [8.0, 12.0, 16.0].iter().map(|x: &f64| x * step).product::<f64>().powi(3);
    far / (1..=9).map(f64::from).product::<f64>()
}

/// Speed of the fastest driver (rad, or sizes, per unit of the path's parameter), at any of these times or before.
#[inline(always)]
fn fastest_driver(tape: &Tape, one: &Stepper<'_>) -> f64 {
    let mut fastest = one.fastest_driver;
    for (d, unit) in one.driver_units.iter().enumerate() {
        fastest = fastest.max(largest(&tape.driver(d, 1).map(f64::abs)) / unit);
    }
    fastest
}

/// True if the output times resolve all laws between them and, at the first step, no singular position is known to be
/// near. Records the travel of the drivers from one output time to the next.
#[inline(always)]
fn laws_are_even(tape: &Tape, one: &mut Stepper<'_>, times: &Lanes, [first, last]: [usize; 2]) -> bool {
    let mut longest = times[first] - one.time;
    (first + 1..=last).for_each(|k| longest = longest.max(times[k] - times[k - 1]));
    for d in 0..one.drivers.len() {
        let unit = one.driver_units[d];
        let (mut before, mut moves) = (one.saved.drivers[d][0], 0.0_f64);
        for &value in &tape.driver(d, 0)[first..=last] {
            let moved = (value - before).abs();
            moves = if moved > moves { moved } else { moves };
            before = value;
        }
        // max over the new output times of abs(f_k - f_k-1)
        moves /= unit;
        let most = (EVEN * moves).clamp(RESTS, LONGEST);
        let [from, to] = [one.time, times[last]];
        // h max abs(f.) <= 2 max abs(f_k - f_k-1), h the longest of the new steps
        let stretch = [from, to, from + CELL * (to - from)];
        let travel =
            longest / unit * one.speed_bounds[d].fastest(&one.parts, d, stretch, most * unit / longest);
        if !(travel <= most) {
            return false;
        }
        // The examined range must extend to the last of these times.
        (one.moves_ahead[d], one.travel[d]) = (moves, travel * unit * ((to - from) / longest));
    }
    one.ahead == Lookahead::Even || one.around.part_of_way(&one.travel) <= PART_OF_WAY
}

/// True if the change of every determinant from one output time to the next is small and similar to that of the step
/// before. Records the last of these changes, and returns the length of its step.
#[inline(always)]
fn determinants_are_even(
    tape: &Tape,
    one: &mut Stepper<'_>,
    times: &Lanes,
    [first, last]: [usize; 2],
) -> Option<f64> {
    // Length of every step relative to the one before it; for the first step, relative to the last of the stepper.
    let (mut beside, mut step) = ([1.0; LANES], one.change_step);
    for k in first..=last {
        let next = if k == first { times[k] - one.time } else { times[k] - times[k - 1] };
        (beside[k], step) = (next / step, next);
    }
    // The first step of all has none before it.
    let compared = if one.ahead == Lookahead::Even { first } else { first + 1 };
    for b in 0..one.changes.len() {
        let determinants = tape.determinant(b);
        let (mut even, mut before) = (true, one.saved.determinants[b]);
        let mut change = one.changes[b];
        for k in first..=last {
            let ratio = one.state.factors[b].ratio(determinants[k], before);
            // r_k = det_k / det_k-1;  r_k in [0.78, 1.28],  abs((r_k - 1) - (r_k-1 - 1) h_k / h_k-1) <= 0.125     (28)
            let changed = ratio - 1.0;
            // NaN is not even.
            even &= (MILD[0]..=MILD[1]).contains(&ratio);
            even &= k < compared || (changed - change * beside[k]).abs() <= MILD_CHANGE;
            (change, before) = (changed, determinants[k]);
        }
        if !even {
            return None;
        }
        one.changes_ahead[b] = change;
    }
    Some(step)
}

impl Stepper<'_> {
    /// Moves the stepper to the position of the program in lane `last`, after all lanes from `first` on.
    #[inline(always)]
    fn continue_from(
        &mut self,
        tape: &Tape,
        times: &Lanes,
        [first, last]: [usize; 2],
        SolveQuality { residuals, pivot_ratio }: SolveQuality,
        change_step: f64,
    ) {
        // The next prediction uses the middle and the end of the batch.
        for lane in [usize::midpoint(first, last), last] {
            let channels = 0..tape.channels().len();
            self.forecast.learn_values(times[lane], channels.map(|c| tape.channel(c, lane)));
        }
        self.stand_in(tape, last);
        let saved = &mut self.saved;
        for (b, pivots) in saved.pivots.iter_mut().enumerate() {
            *pivots = (tape.pivot_ratio(b, last), self.branch[b].0);
            saved.determinants[b] = tape.determinant(b)[last];
        }
        saved.residual = residuals.scaled;
        self.changes.copy_from_slice(&self.changes_ahead);
        self.moves.copy_from_slice(&self.moves_ahead);
        self.change_step = change_step;
        self.ahead = Lookahead::Even;
        self.time = times[last];
        let effort = &mut self.effort;
        let count = last + 1 - first;
        self.state.iterations += tape.passes() * count;
        effort.steps += count;
        effort.by_program += count;
        effort.iterations = self.state.iterations;
        effort.worst_residual = effort.worst_residual.max(residuals.largest);
        effort.note_pivots([pivot_ratio].into_iter(), self.time);
    }

    /// Saves the position and the rates that a tape has found in one lane.
    #[inline(always)]
    fn stand_in(&mut self, tape: &Tape, lane: usize) {
        let AcceptedPosition { q, qd, qdd, balls, drivers, .. } = &mut self.saved;
        for (n, channel) in tape.channels().iter().enumerate() {
            channel.save(tape.channel(n, lane)[0], q, balls);
        }
        for (c, [speeds, accelerations]) in tape.unknowns() {
            (qd[c.0], qdd[c.0]) = (speeds[lane], accelerations[lane]);
        }
        for (d, driver) in drivers.iter_mut().enumerate() {
            *driver = std::array::from_fn(|order| tape.driver(d, order)[lane]);
        }
        for (c, d) in self.topology.driven_coordinates() {
            [q[c.0], qd[c.0], qdd[c.0]] = drivers[d.0];
        }
    }
}

impl Tape {
    /// The margin in one lane.
    pub fn margin(&self, lane: usize) -> Margin {
        Margin::least(self.margins().iter().map(|block| block.0[lane]))
    }
}

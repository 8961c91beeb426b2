//! Batch of eight output times of a single design, solved by a straight-line program.
//!
//! In a smooth motion the prediction of the next eight output times is so accurate that they can be corrected together.
//! Every check of a single step is made at each of them, and more strictly. If a check fails, the results are
//! discarded, and the steps are solved one by one.

use std::sync::Arc;

use hardpoint_tape::{LANES, Lanes};

use crate::blocks::{AlignedLanes, ResultBlock, lanes_of};
use crate::number::{array, each};

use super::execution::{ProgramMemory, Runnable};
use super::guard::Steps;
use super::kinematics::QUADRATIC;
use super::margin::Margin;
use super::mechanism::{AcceptedPosition, Mechanism};
use super::path_step::TRUST_FLOOR;
use super::predictor::{NODES, ORDERS, Weights};
use super::step::{RoughStep, Step, take};
use super::step_program::{MOST_CORRECTIONS, StepProgram};
use super::stepper::Stepper;
use super::tape::{SolveQuality, Tape, all_within, largest};

/// Maximum first correction (rad, or sizes) after a prediction by all stored positions.
pub(super) const FORECAST_TRUST: f64 = 1e-3;
/// Minimum and maximum number of steps that are solved one by one after a failure.
const PAUSE: [usize; 2] = [LANES, 64];
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
        let [states, derivatives] = &self.own;
        self.is_own.then(|| ResultBlock {
            states: bytemuck::cast_slice(states),
            derivatives: bytemuck::cast_slice(derivatives),
        })
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
        if self.programs.is_none() || count < FEWEST || !one.knows_the_path() {
            return 0;
        }
        if self.wait > 0 {
            self.wait -= 1;
            return 0;
        }
        let times: Lanes = array(|lane| times[group + usize::min(lane, last)]);
        if !self.choose_tape(&one.mechanism, [times[last], count as f64]) {
            return 0;
        }
        if self.step(one, &times, [first, last], room()).is_some_and(|step| take(step).is_ok()) {
            self.pause = PAUSE[0];
            return count;
        }
        self.wait = self.pause;
        self.pause = usize::min(2 * self.pause, PAUSE[1]);
        0
    }

    /// Makes a tape if there is none, and replaces or drops one that does not fit; returns true if there is one. Up to
    /// `last` there are `count` steps.
    fn choose_tape(&mut self, one: &Mechanism<'_>, [last, count]: [f64; 2]) -> bool {
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

    /// The step to these output times, of which those from lane `first` to lane `last` are new.
    #[inline(always)]
    fn step<'s, 'm>(
        &'s mut self,
        one: &'s mut Stepper<'m>,
        times: &'s Lanes,
        [first, last]: [usize; 2],
        room: Option<[&'s mut [Lanes]; 2]>,
    ) -> Option<TimeStep<'s, 'm>> {
        let Self { tape, laws, weights, own, is_own, .. } = self;
        let tape = tape.as_mut()?;
        // Earlier results are not overwritten, even if these steps are rejected.
        let room = room.filter(|room| first == 0 && [room[0].len(), room[1].len()] == tape.sizes());
        *is_own = room.is_none();
        let results = room.unwrap_or_else(|| {
            let ([states, derivatives], sizes) = (own, tape.sizes());
            states.resize(sizes[0], AlignedLanes::default());
            derivatives.resize(sizes[1], AlignedLanes::default());
            [lanes_of(states), lanes_of(derivatives)]
        });
        Some(TimeStep {
            one,
            tape,
            laws,
            weights,
            results,
            times,
            lanes: [first, last],
            solved: SolveQuality::default(),
        })
    }
}

/// The step over up to eight output times at once.
struct TimeStep<'s, 'm> {
    one: &'s mut Stepper<'m>,
    tape: &'s mut Tape,
    laws: &'s mut Laws,
    weights: &'s mut Weights,
    /// Numbers of all bodies, and their derivatives.
    results: [&'s mut [Lanes]; 2],
    times: &'s Lanes,
    /// First and last lane of the new output times.
    lanes: [usize; 2],
    solved: SolveQuality,
}

impl Step for TimeStep<'_, '_> {
    type Rejection = RoughStep;

    #[inline(always)]
    fn drive(&mut self) -> Result<(), RoughStep> {
        self.laws.at(&self.one.mechanism, self.times, self.tape.laws_mut()).ok_or(RoughStep)?;
        let [first, last] = self.lanes;
        let steps = Steps { from: self.one.mechanism.saved.time, ends: &self.times[first..=last] };
        let Stepper { mechanism, guard, lookahead, .. } = &mut *self.one;
        let tape = &*self.tape;
        let values = |d: usize| &tape.driver(d, 0)[first..=last];
        let speed = |d: usize| largest(&each(tape.driver(d, 1), f64::abs));
        RoughStep::unless(guard.laws_are_resolved((mechanism, lookahead), steps, values, speed))
    }

    #[inline(always)]
    fn predict(&mut self) -> f64 {
        let Stepper { mechanism, predictor, .. } = &*self.one;
        // t - z_0 of (27) in every lane, z_0 the stepper's own time
        let ahead = each(self.times, |t| t - mechanism.saved.time);
        let are_new = self.weights.set(predictor.nodes(ahead[self.lanes[1]]), &ahead);
        self.tape.look_ahead(&self.weights.of, are_new, &ahead);
        for (channel, known) in self.tape.known_of_times_mut().iter_mut().enumerate() {
            known.copy_from_slice(predictor.known_of(channel).as_flattened());
        }
        // The first steps of a motion have fewer nodes. With three nodes the error of the prediction is that of (27); a
        // first correction above 1e-3 means that the motion is not smooth enough.
        if predictor.known() < NODES { TRUST_FLOOR } else { FORECAST_TRUST }
    }

    #[inline(always)]
    fn correct(&mut self, trust: f64) -> Result<(), RoughStep> {
        let [states, derivatives] = &mut self.results;
        self.solved = self.tape.solve(trust, [&mut **states, &mut **derivatives])?;
        Ok(())
    }

    #[inline(always)]
    fn check(&mut self) -> Result<(), RoughStep> {
        let [first, last] = self.lanes;
        let steps = Steps { from: self.one.mechanism.saved.time, ends: &self.times[first..=last] };
        let Stepper { mechanism, guard, turns, .. } = &mut *self.one;
        let tape = &*self.tape;
        let determinant = |b: usize, k: usize| [tape.determinant(b)[first + k]];
        let is_smooth = guard.determinants_are_even(&mechanism.state.factors, steps, determinant)
            && tape.speeds_are_smooth(guard)
            && turns.as_mut().is_none_or(|turns| {
                let times = (self.times, mechanism.saved.time);
                turns.are_even(self.results[0], times, self.lanes, guard.moved())
            });
        if !is_smooth {
            self.tape.refuse();
        }
        RoughStep::unless(is_smooth)
    }

    /// Moves the stepper to the position in the last lane, after all new lanes.
    #[inline(always)]
    fn accept(&mut self) {
        let ([first, last], tape) = (self.lanes, &*self.tape);
        let Stepper { mechanism, predictor, guard, lookahead, effort, .. } = &mut *self.one;
        // The next prediction uses the middle and the end of the batch.
        for lane in [usize::midpoint(first, last), last] {
            let channels = 0..tape.channels().len();
            predictor.learn_values(self.times[lane], channels.map(|c| tape.channel(c, lane)));
        }
        save_lane(mechanism, tape, last);
        mechanism.saved.time = self.times[last];
        guard.accept();
        lookahead.is_known = false;
        let count = last + 1 - first;
        mechanism.state.iterations += tape.passes() * count;
        effort.steps += count;
        effort.by_program += count;
        effort.iterations = mechanism.state.iterations;
        let SolveQuality { residuals, pivot_ratio } = self.solved;
        mechanism.saved.residual = residuals.scaled;
        effort.worst_residual = effort.worst_residual.max(residuals.largest);
        effort.note_pivots([pivot_ratio].into_iter(), self.times[last]);
    }
}

impl Laws {
    /// Value, speed and acceleration of every driver at these times, and the values of the laws of forces, if
    /// requested; `None` if one is not finite.
    #[inline(always)]
    fn at(&mut self, one: &Mechanism<'_>, times: &Lanes, laws: &mut [Lanes]) -> Option<()> {
        let mut by_program = false;
        if let Some(program) = &self.program {
            let limits = lanes_of(&mut self.limits);
            self.room.run(program, std::slice::from_ref(times), &[], [&mut *laws, &mut *limits, &mut []]);
            by_program = limits.iter().all(|limit| all_within(limit, 0.0));
        }
        if !by_program {
            let (drivers, forces) = laws.split_at_mut(ORDERS * one.drivers.len());
            for (force, law) in forces.iter_mut().zip(one.model.laws_of_forces()) {
                *force = each(times, |t| law.at(t).value());
            }
            for d in 0..one.drivers.len() {
                for lane in 0..LANES {
                    let derivatives = one.parts.law_of(d).at(times[lane]).derivatives();
                    for order in 0..ORDERS {
                        drivers[ORDERS * d + order][lane] = derivatives[order];
                    }
                }
            }
        }
        for x in laws {
            if !all_within(&each(x, f64::abs), f64::MAX) {
                return None;
            }
        }
        Some(())
    }
}

/// Estimated error of a prediction eight steps beyond three positions that are four steps apart, rad or sizes: the
/// remainder of the Hermite interpolation, `x^9 / 9!` times the ninth derivative, for a sinusoidal motion. The
/// frequency is that of the fastest driver's rotation, or of its law. Up to `last` there are `count` steps.
fn missed(one: &Mechanism<'_>, last: f64, count: f64) -> f64 {
    let frequency = |d: usize| {
        let speed = one.parts.fastest(d, one.saved.time, last);
        // omega = f. / unit: all bodies that a rotating driver moves follow sin(omega t). Or f itself follows
        // sin(omega t), and then f... = -omega^2 f.
        let [.., third] = one.parts.law_of(d).at(one.saved.time).derivatives();
        let of_law = if speed > 0.0 { (third.abs() / speed).sqrt() } else { 0.0 };
        f64::max(speed / one.driver_units[d], of_law)
    };
    let step = (0..one.drivers.len()).map(frequency).fold(0.0, f64::max) * (last - one.saved.time) / count;
    // abs(q - p) <= max abs(q(9)) / 9! prod (t - z_i), the z_i thrice 0, -4 and -8 steps h, t = 8 h: (8 12 16)^3 (omega
    // h)^9 / 9!
    let far = [8.0, 12.0, 16.0].iter().map(|x: &f64| x * step).product::<f64>().powi(3);
    far / (1..=9).map(f64::from).product::<f64>()
}

/// Saves the position and the rates that a tape has found in one lane.
#[inline(always)]
fn save_lane(mechanism: &mut Mechanism<'_>, tape: &Tape, lane: usize) {
    let Mechanism { topology, saved, branch, .. } = mechanism;
    let AcceptedPosition { q, qd, qdd, balls, drivers, pivots, .. } = saved;
    for (n, channel) in tape.channels().iter().enumerate() {
        channel.save(tape.channel(n, lane)[0], q, balls);
    }
    for (c, [speeds, accelerations]) in tape.unknowns() {
        (qd[c.0], qdd[c.0]) = (speeds[lane], accelerations[lane]);
    }
    for (d, driver) in drivers.iter_mut().enumerate() {
        *driver = array(|order| tape.driver(d, order)[lane]);
    }
    for (c, d) in topology.driven_coordinates() {
        [q[c.0], qd[c.0], qdd[c.0]] = drivers[d.0];
    }
    for b in 0..pivots.len() {
        pivots[b] = (tape.pivot_ratio(b, lane), branch[b].positive);
    }
}

impl Tape {
    /// The margin in one lane.
    pub fn margin(&self, lane: usize) -> Margin {
        Margin::least(self.margins().iter().map(|block| block.0[lane]))
    }
}

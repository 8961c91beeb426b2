//! Eight output times at once: a single design's steps side by side in SIMD lanes.
//!
//! Where the motion is smooth, the positions of the next eight output times are foreseen so well that they can be corrected
//! together. Every check of a single step is made in every lane, and more strictly; where one fails, nothing has happened,
//! and the steps are walked one by one.

use crate::model::Model;
use crate::space::{LANES, Real};
use crate::topology::{Source, Topology};

use super::parts::Parts;
use super::stepper::{Ahead, EVEN, LONGEST, MILD, MILD_CHANGE, RESTS, Stepper};
use super::tape::ProgramOf;
use super::walk::PART_OF_WAY;

/// The first correction (rad, or sizes) must be within this: a forecast that fails by more is none.
const FORESEEN: f64 = 1e-3;
/// After a failure so many steps are walked one by one, at the least and at the most.
const PAUSE: [usize; 2] = [4, 64];
/// Laws are looked at over so many times the way of all lanes at once.
const CELL: f64 = 8.0;
/// Fewer steps than this are not worth it.
const FEWEST: usize = 3;

/// Takes up to eight steps of another stepper at once.
pub(crate) struct Abreast<'m, T> {
    /// Its state is that of the times of the last [`Abreast::advance`], one per lane.
    pub stepper: Stepper<'m, T>,
    /// Whether the mechanism can be solved so at all.
    suits: bool,
    /// Steps to walk before the next try, and how long the next pause is.
    wait: usize,
    pause: usize,
    /// How often the other stepper had chosen other rows when this one took them over.
    selections: usize,
    /// Where a tape may come from.
    programs: Option<ProgramOf<'m>>,
    /// Groups of steps that the kernel has solved, and how many corrections any of them needed.
    groups: usize,
    corrections: usize,
}

/// A tape is asked for after so many groups of steps, when it is known how many corrections they need.
const GROUPS: usize = 2;

impl<'m, T: Real> Abreast<'m, T> {
    /// With these programs, for who needs no more of a step than what they hand out.
    pub fn new(
        model: &'m Model,
        topology: &Topology,
        parts: Parts<T>,
        programs: Option<ProgramOf<'m>>,
        witness: T,
    ) -> Self {
        // A point on a curve is followed step by step, lest it jump to another stretch of it.
        let suits = T::LANES == LANES && parts.curves.is_empty();
        let stepper = Stepper::new(model, topology, parts, witness);
        Self { stepper, suits, wait: 0, pause: PAUSE[0], selections: 0, programs, groups: 0, corrections: 1 }
    }

    /// Moves on from where the other stepper stands to as many of the next output times as there are lanes; returns how many,
    /// 0 where they are to be walked.
    pub fn advance(&mut self, one: &mut Stepper<'m, f64>, next: &[f64]) -> usize {
        let count = usize::min(next.len(), T::LANES);
        if !self.suits || count < FEWEST || one.forecast.known() < 3 || one.ahead == Ahead::Unknown {
            return 0;
        }
        if self.wait > 0 {
            self.wait -= 1;
            return 0;
        }
        self.choose_tape(one);
        let witness = self.stepper.state.witness;
        let done = witness.within(
            #[inline(always)]
            || self.try_to(one, &next[..count]),
        );
        if done {
            self.pause = PAUSE[0];
            return count;
        }
        self.wait = self.pause;
        self.pause = usize::min(2 * self.pause, PAUSE[1]);
        0
    }

    /// Asks for a tape when it is time, and for another or none where it does not fit.
    fn choose_tape(&mut self, one: &Stepper<'m, f64>) {
        let all = &mut self.stepper;
        if self.selections != one.selections {
            (all.tape, self.programs) = (None, None);
        }
        if let Some(programs) = &self.programs
            && (all.tape_fails() || self.groups == GROUPS)
        {
            all.use_program(self.corrections, programs);
            self.groups += 1;
        }
    }

    #[inline(always)]
    fn try_to(&mut self, one: &mut Stepper<'m, f64>, next: &[f64]) -> bool {
        let last = next.len() - 1;
        let times: [f64; LANES] = std::array::from_fn(|k| next[k.min(last)]);
        self.adopt(one);
        let all = &mut self.stepper;
        let witness = all.state.witness;
        let t = witness.like_lanes(|k| times[k]);
        for d in 0..all.drivers.len() {
            all.drivers[d] = all.parts.law_at_times(d, t);
            if !all.drivers[d].iter().all(|x| x.abs().largest().is_finite()) {
                return false;
            }
        }
        if !laws_are_even(all, one, &times, last) {
            return false;
        }
        all.fastest_driver = one.fastest_driver;
        all.fastest_driver = all.driver_speed();
        let h = t - witness.like(one.time);
        all.foresee(one, t, h, times[last] - one.time);
        let before = all.state.iterations;
        if !all.solve_by_tape(Some(one), FORESEEN) {
            if all.tape.is_some() {
                all.foresee(one, t, h, times[last] - one.time);
            }
            if all.state.solve(&all.topology, &all.parts, &all.drivers, FORESEEN).is_err() {
                return false;
            }
            self.groups += 1;
            self.corrections = usize::max(self.corrections, all.corrections());
        }
        let same_branch = all
            .state
            .pivots
            .iter()
            .enumerate()
            .all(|(b, &(ratio, positive))| positive == one.branch[b].0 && ratio >= one.try_others[b]);
        if !same_branch || !determinants_are_even(all, one, &times, last) {
            return false;
        }
        if all.uncertain_turn().is_some() || !all.speeds_are_smooth(h) {
            return false;
        }
        if !all.by_tape {
            all.residuals = all.state.residuals(&all.topology, &all.parts, &all.drivers);
        }
        if !(all.residuals.scaled <= super::stepper::LOCKED) {
            return false;
        }
        one.continue_from(all, &times, last, all.state.iterations - before);
        true
    }

    /// Takes over from the other stepper what a step starts with.
    #[inline(always)]
    fn adopt(&mut self, one: &Stepper<'m, f64>) {
        let all = &mut self.stepper;
        let witness = all.state.witness;
        if self.selections != one.selections {
            all.topology = one.topology.clone();
            (0..all.topology.blocks.len()).for_each(|b| all.renew_factors(b));
            self.selections = one.selections;
        }
        let (to, from) = (&mut all.saved, &one.saved);
        for c in 0..from.q.len() {
            to.qd[c] = witness.like(from.qd[c]);
            to.qdd[c] = witness.like(from.qdd[c]);
        }
        for &r in &all.topology.coupled_rows {
            for (k, _) in all.topology.parts_of_row(r) {
                let [x, v, a] = from.coupled[k];
                to.coupled[k] = [witness.like(x), witness.like(v), witness.like(a)];
            }
        }
    }
}

/// Whether no law does anything between the output times that these would not show; and, where no step tells yet, no singular
/// position is known to be near. Notes how far the drivers go from one output time to the next.
#[inline(always)]
fn laws_are_even<T: Real>(
    all: &mut Stepper<'_, T>,
    one: &mut Stepper<'_, f64>,
    times: &[f64; LANES],
    last: usize,
) -> bool {
    let mut longest = times[0] - one.time;
    (1..=last).for_each(|k| longest = longest.max(times[k] - times[k - 1]));
    for d in 0..all.drivers.len() {
        let unit = one.driver_units[d];
        let (mut before, mut moves) = (one.saved.drivers[d][0], 0.0_f64);
        for k in 0..=last {
            let value = all.drivers[d][0].lane(k);
            moves = moves.max((value - before).abs() / unit);
            before = value;
        }
        let most = (EVEN * moves).clamp(RESTS, LONGEST);
        let [from, to] = [one.time, times[last]];
        let stretch = [from, to, from + CELL * (to - from)];
        let travel = longest / unit * one.calm[d].fastest(&one.parts, d, stretch, most * unit / longest);
        if !(travel <= most) {
            return false;
        }
        (all.moves[d], one.travel[d]) = (moves, travel * unit);
    }
    one.ahead == Ahead::Even || one.around.part_of_way(&one.travel) <= PART_OF_WAY
}

/// Whether every determinant changes by little from one output time to the next, and about as much as over the step before. Notes
/// the last of these changes.
#[inline(always)]
fn determinants_are_even<T: Real>(
    all: &mut Stepper<'_, T>,
    one: &Stepper<'_, f64>,
    times: &[f64; LANES],
    last: usize,
) -> bool {
    // How long every step is beside the one before it; the first beside the last of the other stepper's.
    let (mut beside, mut step) = ([1.0; LANES], one.change_step);
    for k in 0..=last {
        let next = if k == 0 { times[0] - one.time } else { times[k] - times[k - 1] };
        (beside[k], step) = (next / step, next);
    }
    let (mut at, mut change) = ([0.0; LANES + 1], [0.0; LANES + 1]);
    for b in 0..all.changes.len() {
        at[0] = one.saved.determinants[b];
        all.state.determinants[b].store(&mut at[1..]);
        let mut even = true;
        for k in 0..LANES {
            let ratio = all.state.factors[b].plain_ratio(at[k + 1], at[k]);
            // Written so that NaN is not even.
            even &= (MILD[0]..=MILD[1]).contains(&ratio);
            change[k + 1] = ratio - 1.0;
        }
        change[0] = if one.ahead == Ahead::Even { one.changes[b] } else { change[1] / beside[0] };
        for k in 0..=last {
            even &= (change[k + 1] - change[k] * beside[k]).abs() <= MILD_CHANGE;
        }
        if !even {
            return false;
        }
        all.changes[b] = all.state.witness.like(change[last + 1]);
    }
    all.change_step = step;
    true
}

impl<T: Real> Stepper<'_, T> {
    /// Foresees the positions at the times t, each h beyond where the other stepper stands, `farthest` at the most.
    #[inline(always)]
    fn foresee(&mut self, one: &mut Stepper<'_, f64>, t: T, h: T, farthest: f64) {
        let witness = self.state.witness;
        one.forecast.set(&mut self.state, t, farthest, |x| witness.like(x));
        self.expect_turns(h);
    }
}

impl Stepper<'_, f64> {
    /// Stands where another stepper's lane `last` does, having passed all before it.
    #[inline(always)]
    fn continue_from<T: Real>(
        &mut self,
        all: &Stepper<'_, T>,
        times: &[f64; LANES],
        last: usize,
        iterations: usize,
    ) {
        // The forecast goes by the middle and the end of the way.
        for lane in [last / 2, last] {
            self.forecast.learn(times[lane], &all.state, |x| x.lane(lane));
        }
        let (s, saved) = (&all.state, &mut self.saved);
        for c in 0..saved.q.len() {
            (saved.q[c], saved.qd[c], saved.qdd[c]) =
                (s.q[c].lane(last), s.qd[c].lane(last), s.qdd[c].lane(last));
        }
        for (c, coordinate) in self.topology.coordinates.iter().enumerate() {
            if let Source::Unknown { .. } = coordinate.source {
                saved.balls[c] = s.balls[c].lane(last);
            }
        }
        saved.pivots.copy_from_slice(&s.pivots);
        for (to, from) in saved.determinants.iter_mut().zip(&s.determinants) {
            *to = from.lane(last);
        }
        saved.residual = all.residuals.scaled;
        for (to, from) in self.changes.iter_mut().zip(&all.changes) {
            *to = from.lane(0);
        }
        self.change_step = all.change_step;
        self.moves.copy_from_slice(&all.moves);
        self.ahead = Ahead::Even;
        for (to, from) in saved.drivers.iter_mut().zip(&all.drivers) {
            *to = from.map(|x| x.lane(last));
        }
        for &r in &self.topology.coupled_rows {
            for (k, _) in self.topology.parts_of_row(r) {
                saved.coupled[k] = s.coordinate_of_row(&self.topology, k).map(|x| x.lane(last));
            }
        }
        self.time = times[last];
        self.fastest_driver = all.fastest_driver;
        self.effort.steps += last + 1;
        self.effort.by_program += if all.by_tape { last + 1 } else { 0 };
        self.state.iterations += iterations * (last + 1);
        self.effort.iterations = self.state.iterations;
        self.effort.worst_residual = self.effort.worst_residual.max(all.residuals.largest);
        for &(ratio, _) in &s.pivots {
            if ratio < self.effort.least_pivot_ratio {
                (self.effort.least_pivot_ratio, self.effort.least_pivot_time) = (ratio, self.time);
            }
        }
    }
}

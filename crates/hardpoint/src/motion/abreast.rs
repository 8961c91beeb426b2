//! Eight output times at once: a single design's steps side by side, by a straight-line program.
//!
//! Where the motion is smooth, the positions of the next eight output times are foreseen so well that they can be corrected
//! together. Every check of a single step is made at each of them, and more strictly; where one fails, nothing has happened,
//! and the steps are walked one by one.

use std::sync::Arc;

use hardpoint_tape::{LANES, Lanes};

use crate::blocks::{Line, lanes_of};
use crate::sink::Block;
use crate::topology::Source;

use super::forecast::{Forecast, NODES, ORDERS, Weights};
use super::kinematics::{QUADRATIC, Residuals};
use super::margin::Margin;
use super::stepper::{Ahead, EVEN, LONGEST, MILD, MILD_CHANGE, RESTS, Saved, Stepper};
use super::tape::{MOST_CORRECTIONS, Room, Runnable, StepProgram, Tape};
use super::walk::PART_OF_WAY;

/// The first correction (rad, or sizes) must be within this: a forecast that fails by more is none.
const FORESEEN: f64 = 1e-3;
/// After a failure so many steps are walked one by one, at the least and at the most.
const PAUSE: [usize; 2] = [LANES, 64];
/// Laws are looked at over so many times the way of all lanes at once.
const CELL: f64 = 8.0;
/// Fewer steps than this are not worth it.
const FEWEST: usize = 3;

/// Gives the program with so many corrections, if there is one.
pub(crate) type ProgramOf<'p> = Box<dyn Fn(usize) -> Option<Arc<StepProgram>> + 'p>;

/// Takes up to eight steps of a stepper at once.
pub(crate) struct Abreast<'p> {
    /// Where a tape may come from.
    programs: Option<ProgramOf<'p>>,
    /// The values of the design's variables.
    design: Vec<f64>,
    tape: Option<Tape>,
    laws: Laws,
    weights: Weights,
    /// One of before, until it is known how good it was.
    forecast: Option<Forecast>,
    /// Steps to walk before the next try, and how long the next pause is.
    wait: usize,
    pause: usize,
    ratios: Vec<f64>,
    /// Results, where nobody gives room for them; and whether they are here.
    own: [Vec<Line>; 2],
    is_own: bool,
}

/// The drivers' laws at eight times.
struct Laws {
    program: Option<Arc<Runnable>>,
    room: Room,
    outputs: Vec<Line>,
}

impl<'p> Abreast<'p> {
    /// By these programs, for a design with these values; `laws` are those of its drivers, if there is a program for them.
    pub fn new(programs: Option<ProgramOf<'p>>, design: &[f64], laws: Option<Arc<Runnable>>) -> Self {
        let outputs = vec![Line::default(); laws.as_ref().map_or(0, |laws| laws.outputs())];
        let laws = Laws { program: laws, room: Room::default(), outputs };
        Self {
            programs,
            design: design.to_vec(),
            tape: None,
            laws,
            weights: Weights::default(),
            forecast: None,
            wait: 0,
            pause: PAUSE[0],
            ratios: Vec::new(),
            own: [Vec::new(), Vec::new()],
            is_own: false,
        }
    }

    /// What was solved last.
    ///
    /// # Panics
    /// Where nothing was.
    pub fn solved(&self) -> &Tape {
        self.tape.as_ref().expect("a tape has solved the steps")
    }

    /// Its results, where there was no room for them elsewhere.
    pub fn own_results(&self) -> Option<Block<'_>> {
        let [states, derivatives] = self.own.each_ref().map(|own| bytemuck::cast_slice(own));
        self.is_own.then_some(Block { states, derivatives })
    }

    /// Output time k comes next: moves on from where the stepper stands to as many of the next output times as can be solved at once;
    /// returns how many, 0 where they are to be walked. Results go to the room that
    /// there is, or are kept here.
    #[inline]
    pub fn advance<'r>(
        &mut self,
        one: &mut Stepper<'_>,
        k: usize,
        next: &[f64],
        room: impl FnOnce() -> Option<[&'r mut [Lanes]; 2]>,
    ) -> usize {
        // Results of output times 8n to 8n + 7 lie side by side.
        let count = usize::min(next.len(), LANES);
        if self.programs.is_none()
            || !k.is_multiple_of(LANES)
            || count < FEWEST
            || one.ahead == Ahead::Unknown
        {
            self.look_ahead(one);
            return 0;
        }
        if self.wait > 0 {
            self.wait = self.wait.saturating_sub(LANES);
            return 0;
        }
        if one.forecast.known() < NODES || !self.choose_tape(one) {
            return 0;
        }
        if self.try_to(one, &next[..count], room()).is_some() {
            self.pause = PAUSE[0];
            return count;
        }
        self.wait = self.pause;
        self.pause = usize::min(2 * self.pause, PAUSE[1]);
        0
    }

    /// Keeps a forecast, to see later how good it was.
    fn look_ahead(&mut self, one: &Stepper<'_>) {
        if self.programs.is_some()
            && self.tape.is_none()
            && self.forecast.is_none()
            && one.forecast.known() == NODES
        {
            self.forecast = Some(one.forecast.clone());
        }
    }

    /// Makes a tape where there is none, and another or none where it does not fit; returns whether there is one.
    fn choose_tape(&mut self, one: &mut Stepper<'_>) -> bool {
        let before = match &self.tape {
            Some(tape) if !tape.is_of_no_use() && one.selections == 0 => return true,
            tape => tape.as_ref().map(|t| t.purpose().corrections),
        };
        let corrections = before.map_or_else(|| self.corrections(one), |before| before + 1);
        let program =
            self.programs.as_ref().filter(|_| corrections <= MOST_CORRECTIONS && one.selections == 0);
        self.tape = program.and_then(|program| program(corrections)).map(Tape::new);
        match &mut self.tape {
            Some(tape) => {
                tape.set_designs(std::slice::from_ref(&self.design));
                self.ratios.resize(one.topology.blocks.len(), 0.0);
                self.weights = Weights::default();
            }
            None => self.programs = None,
        }
        self.tape.is_some()
    }

    /// How many corrections eight output times at once will need, by how good a forecast has been.
    fn corrections(&self, one: &mut Stepper<'_>) -> usize {
        let Some(before) = &self.forecast else { return 1 };
        // Positions are then four steps apart, and the farthest output time is eight steps ahead.
        let far = [8.0, 12.0, 16.0_f64].map(|x| x.powi(3)).iter().product::<f64>();
        let (nodes, count) = before.nodes(0.0);
        let step = -nodes[1];
        let ahead = before.ahead_of(one.time);
        if !(count == NODES && step > 0.0 && ahead > 0.0) {
            return 1;
        }
        let near = nodes.map(|node| ((ahead - node) / step).powi(3)).iter().product::<f64>();
        let error = one.forecast_error(&mut before.clone());
        if error * (far / near) <= QUADRATIC { 1 } else { 2 }
    }

    #[inline(always)]
    fn try_to(&mut self, one: &mut Stepper<'_>, next: &[f64], room: Option<[&mut [Lanes]; 2]>) -> Option<()> {
        let last = next.len() - 1;
        let times: Lanes = std::array::from_fn(|k| next[k.min(last)]);
        let tape = self.tape.as_mut()?;
        self.laws.at(one, &times, tape.drivers_mut())?;
        if !laws_are_even(tape, one, &times, last) {
            return None;
        }
        one.fastest_driver = fastest_driver(tape, one);
        let ahead = times.map(|t| t - one.time);
        let nodes = one.forecast.nodes(ahead[last]);
        if self.weights.set(nodes, &ahead) {
            tape.weights_mut().copy_from_slice(&self.weights.of);
        }
        for channel in 0..tape.channels().len() {
            let known = one.forecast.known_of(channel);
            for (to, x) in tape.known_mut(channel).iter_mut().zip(known.as_flattened()) {
                *to = [*x; LANES];
            }
        }
        let room = room.filter(|room| room.each_ref().map(|part| part.len()) == tape.sizes());
        self.is_own = room.is_none();
        let results = room.unwrap_or_else(|| {
            for (own, size) in self.own.iter_mut().zip(tape.sizes()) {
                own.resize(size, Line::default());
            }
            self.own.each_mut().map(|own| lanes_of(own))
        });
        let residuals =
            tape.solve((&one.branch, &one.try_others), FORESEEN, &mut self.ratios, results).ok()?;
        let change_step = determinants_are_even(tape, one, &times, last);
        let before = |_, c: usize, _| [one.saved.qd[c], one.saved.qdd[c]];
        let fits = change_step.is_some()
            && tape.speeds_are_smooth(&one.topology, before, &ahead, one.fastest_driver);
        match change_step.filter(|_| fits) {
            Some(step) => {
                one.continue_from(tape, &times, last, (residuals, &self.ratios), step);
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
    /// Value, speed and acceleration of every driver at these times; none where one is not finite.
    #[inline(always)]
    fn at(&mut self, one: &Stepper<'_>, times: &Lanes, drivers: &mut [Lanes]) -> Option<()> {
        let mut by_program = false;
        if let Some(program) = &self.program {
            let found = lanes_of(&mut self.outputs);
            self.room.run(program, std::slice::from_ref(times), [found, &mut [], &mut []]);
            let (found, limits) = found.split_at(drivers.len());
            by_program = limits.iter().all(|l| l.iter().all(|x| *x <= 0.0));
            drivers.copy_from_slice(found);
        }
        if !by_program {
            for (d, driver) in drivers.chunks_exact_mut(ORDERS).enumerate() {
                for lane in 0..LANES {
                    for (to, x) in driver.iter_mut().zip(one.parts.law_of(d).at(times[lane]).derivatives()) {
                        to[lane] = x;
                    }
                }
            }
        }
        let finite = drivers.iter().all(|x| x.iter().all(|x| x.is_finite()));
        finite.then_some(())
    }
}

/// Speed of the fastest driver (rad, or sizes, per unit of the path's parameter), at any of these times or before.
#[inline(always)]
fn fastest_driver(tape: &Tape, one: &Stepper<'_>) -> f64 {
    let mut fastest = one.fastest_driver;
    for (d, unit) in one.driver_units.iter().enumerate() {
        fastest = tape.driver(d, 1).iter().fold(fastest, |most, x| most.max(x.abs() / unit));
    }
    fastest
}

/// Whether no law does anything between the output times that these would not show; and, where no step tells yet, no singular
/// position is known to be near. Notes how far the drivers go from one output time to the next.
#[inline(always)]
fn laws_are_even(tape: &Tape, one: &mut Stepper<'_>, times: &Lanes, last: usize) -> bool {
    let mut longest = times[0] - one.time;
    (1..=last).for_each(|k| longest = longest.max(times[k] - times[k - 1]));
    for d in 0..one.drivers.len() {
        let unit = one.driver_units[d];
        let (mut before, mut moves) = (one.saved.drivers[d][0], 0.0_f64);
        for &value in &tape.driver(d, 0)[..=last] {
            moves = moves.max((value - before).abs());
            before = value;
        }
        moves /= unit;
        let most = (EVEN * moves).clamp(RESTS, LONGEST);
        let [from, to] = [one.time, times[last]];
        let stretch = [from, to, from + CELL * (to - from)];
        let travel = longest / unit * one.calm[d].fastest(&one.parts, d, stretch, most * unit / longest);
        if !(travel <= most) {
            return false;
        }
        (one.moves_ahead[d], one.travel[d]) = (moves, travel * unit);
    }
    one.ahead == Ahead::Even || one.around.part_of_way(&one.travel) <= PART_OF_WAY
}

/// Whether every determinant changes by little from one output time to the next, and about as much as over the step before. Notes
/// the last of these changes, and gives the length of its step.
#[inline(always)]
fn determinants_are_even(tape: &Tape, one: &mut Stepper<'_>, times: &Lanes, last: usize) -> Option<f64> {
    // How long every step is beside the one before it; the first beside the last of the stepper's.
    let (mut beside, mut step) = ([1.0; LANES], one.change_step);
    for k in 0..=last {
        let next = if k == 0 { times[0] - one.time } else { times[k] - times[k - 1] };
        (beside[k], step) = (next / step, next);
    }
    for b in 0..one.changes.len() {
        let determinants = tape.determinant(b);
        let (mut even, mut change, mut before) = (true, [0.0; LANES + 1], one.saved.determinants[b]);
        for k in 0..=last {
            let ratio = determinants[k] / before;
            // Written so that NaN is not even.
            even &= (MILD[0]..=MILD[1]).contains(&ratio);
            (change[k + 1], before) = (ratio - 1.0, determinants[k]);
        }
        change[0] = if one.ahead == Ahead::Even { one.changes[b] } else { change[1] / beside[0] };
        for k in 0..=last {
            even &= (change[k + 1] - change[k] * beside[k]).abs() <= MILD_CHANGE;
        }
        if !even {
            return None;
        }
        one.changes_ahead[b] = change[last + 1];
    }
    Some(step)
}

impl Stepper<'_> {
    /// Stands where a tape has come to in lane `last`, having passed all before it.
    #[inline(always)]
    fn continue_from(
        &mut self,
        tape: &Tape,
        times: &Lanes,
        last: usize,
        (residuals, ratios): (Residuals, &[f64]),
        change_step: f64,
    ) {
        // The forecast goes by the middle and the end of the way.
        for lane in [last / 2, last] {
            let channels = 0..tape.channels().len();
            self.forecast.learn_values(times[lane], channels.map(|c| tape.channel(c, lane)));
        }
        self.stand_in(tape, last);
        let saved = &mut self.saved;
        for (b, ratio) in ratios.iter().enumerate() {
            saved.pivots[b] = (*ratio, self.branch[b].0);
            saved.determinants[b] = tape.determinant(b)[last];
        }
        saved.residual = residuals.scaled;
        self.changes.copy_from_slice(&self.changes_ahead);
        self.moves.copy_from_slice(&self.moves_ahead);
        self.change_step = change_step;
        self.ahead = Ahead::Even;
        self.time = times[last];
        let effort = &mut self.effort;
        self.state.iterations += tape.passes() * (last + 1);
        effort.steps += last + 1;
        effort.by_program += last + 1;
        effort.iterations = self.state.iterations;
        effort.worst_residual = effort.worst_residual.max(residuals.largest);
        effort.note_pivots(ratios.iter().copied(), self.time);
    }

    /// Saves the position and the rates that a tape has found in one lane.
    #[inline(always)]
    pub(super) fn stand_in(&mut self, tape: &Tape, lane: usize) {
        let Saved { q, qd, qdd, balls, drivers, .. } = &mut self.saved;
        for (n, channel) in tape.channels().iter().enumerate() {
            channel.save(tape.channel(n, lane)[0], q, balls);
        }
        for (c, [speeds, accelerations]) in tape.unknowns() {
            (qd[c], qdd[c]) = (speeds[lane], accelerations[lane]);
        }
        for (d, driver) in drivers.iter_mut().enumerate() {
            *driver = std::array::from_fn(|order| tape.driver(d, order)[lane]);
        }
        for (c, coordinate) in self.topology.coordinates.iter().enumerate() {
            if let Source::Driven(d) = coordinate.source {
                [q[c], qd[c], qdd[c]] = drivers[d.0];
            }
        }
    }
}

impl Tape {
    /// The margin in one lane.
    pub fn margin(&self, lane: usize) -> Margin {
        Margin::least(self.margins().iter().map(|block| block.0[lane]))
    }
}

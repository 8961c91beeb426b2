//! Batch of up to eight designs, solved from one output time to the next by a straight-line program.
//!
//! All designs start from the first position of the nominal design, and every check of a single design's step is made
//! in every lane. If a check fails, each design is solved alone.

use std::ops::{ControlFlow, Range};
use std::sync::Arc;

use hardpoint_tape::{LANES, Lanes};

use crate::blocks::{AlignedLanes, Blocks, ResultBlock, lanes_of};
use crate::model::{BodyId, VariableId};

use super::kinematics::QUADRATIC;
use super::predictor::{NODES, ORDERS, Weights};
use super::step_program::MOST_CORRECTIONS;
use super::stepper::{Lookahead, MILD, MILD_CHANGE, Stepper, TRUST_FLOOR};
use super::tape::{SolveQuality, Tape};
use super::time_batch::ProgramOf;
use super::walk::Path;
use super::{Motion, SolverStatistics};

/// Error of the last prediction below which one correction is enough at the next step.
const GOOD: f64 = 0.1 * QUADRATIC;

/// Values of the drivers up to an output time: the same for all designs.
#[derive(Clone, Debug)]
struct Drive {
    /// Since the output time before.
    h: f64,
    /// Speed of the fastest driver (rad, or sizes, per s), now or before.
    fastest: f64,
}

/// Solver of a batch of designs.
pub(crate) struct DesignBatch<'m> {
    /// Stepper of the nominal design, at the first output time.
    nominal: Stepper<'m>,
    /// Values of the drivers at every output time, up to the first interval in which they do not move smoothly.
    course: Vec<Drive>,
    drivers: Vec<[f64; ORDERS]>,
    /// Source of programs.
    programs: ProgramOf<'m>,
    /// Tapes with one and two corrections; true if the present designs are set.
    tapes: [Option<(Tape, bool)>; MOST_CORRECTIONS],
    /// Index of the program that solved the last step, and the error of its prediction.
    by: usize,
    missed: f64,
    designs: Vec<Vec<f64>>,
    weights: Weights,
    /// Per channel: its node values.
    known: Vec<[Lanes; NODES * ORDERS]>,
    /// Times of these positions, the newest first, and how many there are.
    times: [f64; NODES],
    count: usize,
    /// Per block: the last determinant, and its relative change.
    determinants: Vec<Lanes>,
    changes: Vec<Lanes>,
    /// Numbers of all bodies, and the coordinates of the tree, output time after output time, or of the last one; the
    /// bodies' derivatives at the last.
    states: Arc<Vec<AlignedLanes>>,
    coordinates: Arc<Vec<AlignedLanes>>,
    derivatives: Vec<AlignedLanes>,
    keeps: bool,
}

/// Results at an output time.
pub(crate) struct BatchResults<'f> {
    pub tape: &'f Tape,
    /// The numbers of all bodies but ground, and their derivatives.
    pub block: ResultBlock<'f>,
}

impl<'m> DesignBatch<'m> {
    /// Solver by these programs. Returns `None` if there is no program, or if the nominal design is not in the design
    /// configuration at its first output time (the position of `nominal`), because designs could have taken different
    /// branches before. If `keeps` is true, the results of all output times are stored.
    pub fn new(mut nominal: Stepper<'m>, programs: ProgramOf<'m>, keeps: bool) -> Option<Self> {
        if nominal.saved.drivers.iter().any(|f| f[0] != 0.0) {
            return None;
        }
        let blocks = nominal.topology.blocks.len();
        let first = Tape::new(programs(MOST_CORRECTIONS)?);
        if !first.is_on(&nominal.branch) {
            return None;
        }
        let channels = first.channels().len();
        let derivatives = vec![AlignedLanes::default(); first.sizes()[1]];
        let mut tapes = [const { None }; MOST_CORRECTIONS];
        tapes[MOST_CORRECTIONS - 1] = Some((first, false));
        let (course, drivers) = course(&mut nominal);
        Some(Self {
            nominal,
            course,
            drivers,
            programs,
            tapes,
            by: MOST_CORRECTIONS - 1,
            missed: 0.0,
            designs: Vec::new(),
            weights: Weights::default(),
            known: vec![[[0.0; LANES]; NODES * ORDERS]; channels],
            times: [0.0; NODES],
            count: 0,
            determinants: vec![[0.0; LANES]; blocks],
            changes: vec![[0.0; LANES]; blocks],
            states: Arc::default(),
            coordinates: Arc::default(),
            derivatives,
            keeps,
        })
    }

    /// Moves the results of one design to its motion.
    pub fn hand_over(&self, lane: usize, motion: &mut Motion) {
        let of_design =
            |lines: &Arc<Vec<AlignedLanes>>, width| Blocks::of_design(Arc::clone(lines), width, lane);
        motion.states = of_design(&self.states, self.tape().sizes()[0]);
        motion.coordinates = of_design(&self.coordinates, self.nominal.topology.coordinates.len());
    }

    /// Program that solved the last step.
    fn tape(&self) -> &Tape {
        let (tape, _) = self.tapes[self.by].as_ref().expect("the tape that is at work");
        tape
    }

    /// Pairs of a variable and a body that it moves, in the order of the derivatives.
    pub fn moved(&self) -> Vec<(VariableId, BodyId)> {
        self.tape().moved().to_vec()
    }

    /// Solves these designs at all output times, one per lane. Calls `each(k, ...)` with the results of output time k,
    /// which may end the run. Returns `None` if a step fails in some lane, or if `each` ends the run early.
    pub fn run(
        &mut self,
        designs: &[Vec<f64>],
        mut each: impl FnMut(usize, &BatchResults<'_>) -> ControlFlow<()>,
    ) -> Option<SolverStatistics> {
        let model = self.nominal.model;
        for (_, knows) in self.tapes.iter_mut().flatten() {
            *knows = false;
        }
        self.designs.clear();
        self.designs.extend_from_slice(designs);
        let steps = if self.keeps { model.times.len() } else { 1 };
        let widths = [self.tape().sizes()[0], self.nominal.topology.coordinates.len()];
        for (lines, width) in [&mut self.states, &mut self.coordinates].into_iter().zip(widths) {
            // Results of former designs that are still in use are not overwritten.
            if Arc::get_mut(lines).is_none_or(|lines| lines.len() != width * steps) {
                *lines = Arc::new(vec![AlignedLanes::default(); width * steps]);
            }
        }
        let mut effort = SolverStatistics { least_pivot_ratio: f64::INFINITY, ..SolverStatistics::default() };
        for (k, &t) in model.times.iter().enumerate() {
            let solved = if k == 0 { self.start(t)? } else { self.step(k, t)? };
            if self.keeps {
                let at = widths[1] * k..widths[1] * (k + 1);
                let Some((tape, _)) = &self.tapes[self.by] else { return None };
                let room = &mut Arc::get_mut(&mut self.coordinates)?[at];
                tape.coordinates(&self.nominal.topology, lanes_of(room));
            }
            let states = &self.states[self.states_at(k)];
            let [states, derivatives] = [states, &self.derivatives].map(bytemuck::cast_slice);
            let found = BatchResults { tape: self.tape(), block: ResultBlock { states, derivatives } };
            if each(k, &found).is_break() && k + 1 < model.times.len() {
                return None;
            }
            effort.steps += 1;
            effort.by_program += 1;
            effort.iterations += self.tape().passes();
            effort.worst_residual = effort.worst_residual.max(solved.residuals.largest);
            effort.note_pivots([solved.pivot_ratio].into_iter(), t);
        }
        Some(effort)
    }

    /// Range of the values of all bodies at output time k.
    fn states_at(&self, k: usize) -> Range<usize> {
        let width = self.tape().sizes()[0];
        let first = if self.keeps { width * k } else { 0 };
        first..first + width
    }

    /// Solves all designs at the first output time, from the position of the nominal one.
    fn start(&mut self, t: f64) -> Option<SolveQuality> {
        let saved = &self.nominal.saved;
        for n in 0..self.known.len() {
            let x = self.tape().channels()[n].saved(&saved.q, &saved.balls);
            self.known[n] = [[0.0; LANES]; NODES * ORDERS];
            // q of the nominal design, in every lane, which is also the prediction at distance 0
            self.known[n][0] = [x; LANES];
        }
        (self.times, self.count) = ([t; NODES], 1);
        let solved = self.solve(MOST_CORRECTIONS, 0, &[0.0; LANES])?;
        for b in 0..self.determinants.len() {
            // det of the design over det of the nominal one, as in (28) over a step: a design this near is on the same
            // branch.
            let (now, before) = (self.tape().determinant(b), self.nominal.saved.determinants[b]);
            let factors = &self.nominal.state.factors[b];
            if !now.iter().all(|x| (MILD[0]..=MILD[1]).contains(&factors.ratio(*x, before))) {
                return None;
            }
            self.determinants[b] = now;
        }
        self.count = 0;
        self.save(t);
        Some(solved)
    }

    /// Solves all designs at the next output time, k.
    fn step(&mut self, k: usize, t: f64) -> Option<SolveQuality> {
        let ahead = [self.course.get(k)?.h; LANES];
        // abs(dq_0) <= 1e-9 at the last step: by (26) one correction reaches round-off at the next, too.
        let is_good = self.count == NODES && self.missed <= GOOD;
        let solved = self.solve(if is_good { 1 } else { MOST_CORRECTIONS }, k, &ahead)?;
        if !self.tape().speeds_are_smooth(self.course[k].fastest) || !self.determinants_are_even(k) {
            return None;
        }
        self.save(t);
        Some(solved)
    }

    /// Tries the tape with this number of corrections at output time k, `ahead` of the newest position.
    fn solve(&mut self, corrections: usize, k: usize, ahead: &Lanes) -> Option<SolveQuality> {
        self.weights.set((self.times.map(|t| t - self.times[0]), self.count), ahead);
        let states_at = self.states_at(k);
        let kept = &mut self.tapes[corrections - 1];
        if kept.is_none() {
            *kept = Some((Tape::new((self.programs)(corrections)?), false));
        }
        let (tape, knows) = kept.as_mut()?;
        if !std::mem::replace(knows, true) {
            tape.set_designs(&self.designs);
        }
        let nominal = &self.nominal;
        tape.look_ahead(&self.weights.of, true, ahead);
        for (channel, known) in self.known.iter().enumerate() {
            tape.known_mut(channel).copy_from_slice(known);
        }
        let drivers = nominal.drivers.len();
        for (to, x) in tape.laws_mut().iter_mut().zip(self.drivers[k * drivers..].as_flattened()) {
            *to = [*x; LANES];
        }
        let states = &mut Arc::get_mut(&mut self.states)?[states_at];
        let results = [lanes_of(states), lanes_of(&mut self.derivatives)];
        let solved = tape.solve(TRUST_FLOOR, results).ok()?;
        (self.by, self.missed) = (corrections - 1, tape.missed());
        Some(solved)
    }

    /// True if the change of every determinant up to output time k is small and similar to that of the step before.
    fn determinants_are_even(&mut self, k: usize) -> bool {
        let beside = self.course[k].h / self.course[k - 1].h;
        let mut even = true;
        for b in 0..self.determinants.len() {
            let now = self.tape().determinant(b);
            for lane in 0..LANES {
                let factors = &self.nominal.state.factors[b];
                let ratio = factors.ratio(now[lane], self.determinants[b][lane]);
                let change = ratio - 1.0;
                // NaN is not even.
                even &= (MILD[0]..=MILD[1]).contains(&ratio);
                if k > 1 {
                    // (28) in every lane, h_k / h_k-1 being the same for all designs
                    even &= (change - self.changes[b][lane] * beside).abs() <= MILD_CHANGE;
                }
                (self.changes[b][lane], self.determinants[b][lane]) = (change, now[lane]);
            }
        }
        even
    }

    /// Accepts the positions of the designs at time t.
    fn save(&mut self, t: f64) {
        let Some((tape, _)) = &self.tapes[self.by] else { return };
        for (channel, known) in self.known.iter_mut().enumerate() {
            // Node n becomes node n + 1, and where the designs are now node 0 of (27).
            known.copy_within(..(NODES - 1) * ORDERS, ORDERS);
            for (order, to) in known[..ORDERS].iter_mut().enumerate() {
                *to = *tape.channel_lanes(channel, order);
            }
        }
        self.times.rotate_right(1);
        self.times[0] = t;
        self.count = usize::min(self.count + 1, NODES);
    }
}

/// Values of the drivers, up to the first interval that the output times do not resolve, and none if a singular
/// position is near the start; value, speed and acceleration of each driver at every output time.
fn course(nominal: &mut Stepper<'_>) -> (Vec<Drive>, Vec<[f64; ORDERS]>) {
    let (mut course, mut drivers) = (Vec::new(), Vec::new());
    for (k, &t) in nominal.model.times.iter().enumerate() {
        let h = t - nominal.time;
        if nominal.drive(Path::Laws, t).is_err() || k > 0 && !nominal.is_clear(t, h) {
            break;
        }
        nominal.fastest_driver = nominal.driver_speed();
        if k > 0 {
            nominal.note_moves();
            nominal.ahead = Lookahead::Even;
        }
        nominal.saved.drivers.copy_from_slice(&nominal.drivers);
        nominal.time = t;
        course.push(Drive { h, fastest: nominal.fastest_driver });
        drivers.extend_from_slice(&nominal.drivers);
    }
    (course, drivers)
}

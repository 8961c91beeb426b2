//! Batch of up to eight designs, solved from one output time to the next by a straight-line program.
//!
//! All designs start from the nominal design configuration, and go to the first output time as the nominal design does:
//! all drivers straight there together. Every check of a single design's step is made in every lane. If a check fails,
//! each design is solved alone.

use std::ops::{ControlFlow, Range};
use std::sync::Arc;

use hardpoint_tape::{LANES, Lanes};

use crate::blocks::{AlignedLanes, Blocks, ResultBlock, lanes_of, zeros};
use crate::model::{BodyId, VariableId};
use crate::number::each;

use super::advance::{laws_are_resolved, start_from_ramp, start_on_ramp};
use super::guard::{StepGuard, Steps};
use super::kinematics::QUADRATIC;
use super::lookahead::PART_OF_WAY;
use super::mechanism::{AcceptedPosition, Mechanism};
use super::path::Path;
use super::path_step::TRUST_FLOOR;
use super::predictor::{NODES, ORDERS, Weights};
use super::step::{RoughStep, Step, take};
use super::step_program::MOST_CORRECTIONS;
use super::stepper::Stepper;
use super::tape::{SolveQuality, Tape};
use super::time_batch::ProgramOf;
use super::{Motion, SolverStatistics};

/// Error of the last prediction below which one correction is enough at the next step.
const GOOD: f64 = 0.1 * QUADRATIC;

/// Number of steps of a ramp to the first output time per step that the nearest singular position allows where it
/// begins, and the least and greatest number: determinants vary little over each, so that the designs stay together.
const RAMP_STEPS: (f64, f64, f64) = (6.0, 8.0, 40.0);

/// Motion of the drivers to a position: the same for all designs.
#[derive(Clone, Debug)]
struct Drive {
    /// Time, or parameter of the ramp from the design configuration to the first output time, there and since the
    /// position before.
    t: f64,
    h: f64,
    /// Speed of the fastest driver (rad, or sizes, per s or per ramp), now or before.
    fastest: f64,
}

/// Solver of a batch of designs.
pub(crate) struct DesignBatch<'m> {
    /// The nominal design.
    nominal: Mechanism<'m>,
    /// Position of the nominal design in the design configuration, with the determinants there.
    start: AcceptedPosition,
    determinants: Vec<f64>,
    /// Motion of the drivers to each position: those of the ramp, of which there are this many, then the output times,
    /// up to the first interval in which the laws are not smooth.
    course: Vec<Drive>,
    on_ramp: usize,
    drivers: Vec<[f64; ORDERS]>,
    /// Source of programs.
    programs: ProgramOf<'m>,
    /// Tapes with one and two corrections; true if the present designs are set.
    tapes: Tapes,
    /// Index of the program of the present step, its solution, and the error of its prediction.
    by: usize,
    solved: SolveQuality,
    missed: f64,
    designs: Vec<Vec<f64>>,
    weights: Weights,
    /// Per channel: its node values.
    known: Vec<[Lanes; NODES * ORDERS]>,
    /// Times of these positions, the newest first, and how many there are.
    times: [f64; NODES],
    count: usize,
    /// Trust in steps of all designs, one per lane.
    guard: StepGuard<LANES>,
    /// Numbers of all bodies, and the coordinates of the tree, output time after output time, or of the last one; the
    /// bodies' derivatives at the last.
    states: Arc<Vec<AlignedLanes>>,
    coordinates: Arc<Vec<AlignedLanes>>,
    derivatives: Vec<AlignedLanes>,
    keeps: bool,
}

type Tapes = [Option<(Tape, bool)>; MOST_CORRECTIONS];

/// The tape of the present step; true if the present designs are set.
fn at_work(tapes: &mut Tapes, by: usize) -> &mut (Tape, bool) {
    tapes[by].as_mut().expect("the tape that is at work")
}

/// Results at an output time.
pub(crate) struct BatchResults<'f> {
    pub tape: &'f Tape,
    /// The numbers of all bodies but ground, and their derivatives.
    pub block: ResultBlock<'f>,
}

impl<'m> DesignBatch<'m> {
    /// Solver by these programs, of designs like the nominal one, which is not started yet. Returns `None` if there is
    /// no program, or if the nominal design has another branch at its first output time than in the design
    /// configuration. If `keeps` is true, the results of all output times are stored.
    pub fn new(mut nominal: Stepper<'m>, programs: ProgramOf<'m>, keeps: bool) -> Option<Self> {
        let t = *nominal.mechanism.model.times.first()?;
        let first = Tape::new(programs(MOST_CORRECTIONS)?);
        let path = start_on_ramp(&mut nominal, t).ok()?;
        let (mut course, mut drivers) = match path {
            Some(path) => ramp(&mut nominal, path),
            None => {
                start_from_ramp(&mut nominal, None, t).ok()?;
                Default::default()
            }
        };
        let start = nominal.mechanism.saved.clone();
        let determinants: Vec<f64> = nominal.guard.determinants().collect();
        let is_drawn_on_branch = first.is_on(&nominal.mechanism.branch);
        if path.is_some() {
            start_from_ramp(&mut nominal, path, t).ok()?;
        }
        if !(is_drawn_on_branch && first.is_on(&nominal.mechanism.branch)) {
            return None;
        }
        let on_ramp = course.len();
        let (on_laws, drivers_on_laws) = course_of_laws(&mut nominal);
        course.extend(on_laws);
        drivers.extend(drivers_on_laws);
        let channels = first.channels().len();
        let derivatives = vec![AlignedLanes::default(); first.sizes()[1]];
        let mut tapes = [const { None }; MOST_CORRECTIONS];
        tapes[MOST_CORRECTIONS - 1] = Some((first, false));
        let guard = StepGuard::new(determinants.len(), 0);
        Some(Self {
            nominal: nominal.mechanism,
            start,
            determinants,
            course,
            on_ramp,
            drivers,
            programs,
            tapes,
            by: MOST_CORRECTIONS - 1,
            solved: SolveQuality::default(),
            missed: 0.0,
            designs: Vec::new(),
            weights: Weights::default(),
            known: vec![[[0.0; LANES]; NODES * ORDERS]; channels],
            times: [0.0; NODES],
            count: 0,
            guard,
            states: Arc::default(),
            coordinates: Arc::default(),
            derivatives,
            keeps,
        })
    }

    /// True if the motion does not begin in the design configuration.
    pub fn begins_elsewhere(&self) -> bool {
        self.on_ramp > 0
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
                *lines = Arc::new(zeros(width * steps));
            }
        }
        let mut effort = SolverStatistics { least_pivot_ratio: f64::INFINITY, ..SolverStatistics::default() };
        for position in 0..self.on_ramp + model.times.len() {
            take(DesignStep { batch: self, k: position }).ok()?;
            let Some(k) = position.checked_sub(self.on_ramp) else { continue };
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
            effort.worst_residual = effort.worst_residual.max(self.solved.residuals.largest);
            effort.note_pivots([self.solved.pivot_ratio].into_iter(), model.times[k]);
        }
        Some(effort)
    }

    /// Range of the values of all bodies at output time k; those on the ramp are overwritten.
    fn states_at(&self, k: usize) -> Range<usize> {
        let width = self.tape().sizes()[0];
        let first = if self.keeps { width * k } else { 0 };
        first..first + width
    }

    /// Starts all designs in the configuration of the nominal one.
    fn start(&mut self) {
        for n in 0..self.known.len() {
            let x = self.tape().channels()[n].saved(&self.start.q, &self.start.balls);
            // q of the nominal design, in every lane
            self.known[n][0] = [x; LANES];
        }
        self.guard.start_at(self.determinants.iter().copied());
    }
}

/// The step of all designs to a position of the course.
///
/// Those to the first one, from the nominal design to each of them, and to the first on the laws, from the same place
/// at the end of the ramp, are no steps over time.
struct DesignStep<'s, 'm> {
    batch: &'s mut DesignBatch<'m>,
    k: usize,
}

impl DesignStep<'_, '_> {
    fn is_start(&self) -> bool {
        self.k == 0 || self.k == self.batch.on_ramp
    }
}

impl Step for DesignStep<'_, '_> {
    type Rejection = RoughStep;

    fn drive(&mut self) -> Result<(), RoughStep> {
        if self.k == 0 {
            self.batch.start();
        }
        let is_start = self.is_start();
        let DesignBatch {
            nominal,
            course,
            drivers,
            programs,
            tapes,
            by,
            missed,
            known,
            times,
            count,
            designs,
            guard,
            ..
        } = &mut *self.batch;
        // The laws of all designs are the same; `course` has checked them.
        let drive = course.get(self.k).ok_or(RoughStep)?;
        guard.fastest_driver = drive.fastest;
        if is_start {
            // The place alone is the prediction: rates are those of another path, or unknown.
            for known in known {
                known[1..].fill([0.0; LANES]);
            }
            (*times, *count) = ([drive.t; NODES], 1);
        }
        // abs(dq_0) <= 1e-9 at the last step: by (26) one correction reaches round-off at the next, too.
        let is_good = *count == NODES && *missed <= GOOD;
        let corrections = if is_good { 1 } else { MOST_CORRECTIONS };
        let made = &mut tapes[corrections - 1];
        if made.is_none() {
            *made = Some((Tape::new(programs(corrections).ok_or(RoughStep)?), false));
        }
        *by = corrections - 1;
        let (tape, knows) = at_work(tapes, *by);
        if !std::mem::replace(knows, true) {
            tape.set_designs(designs);
        }
        let first = self.k * nominal.drivers.len();
        for (to, x) in tape.laws_mut().iter_mut().zip(drivers[first..].as_flattened()) {
            *to = [*x; LANES];
        }
        Ok(())
    }

    fn predict(&mut self) -> f64 {
        let DesignBatch { course, tapes, by, weights, known, times, count, .. } = &mut *self.batch;
        let ahead = [course[self.k].h; LANES];
        weights.set((each(times, |t| t - times[0]), *count), &ahead);
        let (tape, _) = at_work(tapes, *by);
        tape.look_ahead(&weights.of, true, &ahead);
        for (channel, known) in known.iter().enumerate() {
            tape.known_mut(channel).copy_from_slice(known);
        }
        TRUST_FLOOR
    }

    fn correct(&mut self, trust: f64) -> Result<(), RoughStep> {
        let states_at = self.batch.states_at(self.k.saturating_sub(self.batch.on_ramp));
        let DesignBatch { tapes, by, missed, solved, states, derivatives, .. } = &mut *self.batch;
        let (tape, _) = at_work(tapes, *by);
        let states = &mut Arc::get_mut(states).ok_or(RoughStep)?[states_at];
        *solved = tape.solve(trust, [lanes_of(states), lanes_of(derivatives)])?;
        *missed = tape.missed();
        Ok(())
    }

    fn check(&mut self) -> Result<(), RoughStep> {
        let is_start = self.is_start();
        let DesignBatch { nominal, course, tapes, by, times, guard, .. } = &mut *self.batch;
        let (tape, _) = at_work(tapes, *by);
        RoughStep::unless(is_start || tape.speeds_are_smooth(guard))?;
        // In the design configuration a design with determinants near those of the nominal one is on the same branch.
        let steps = Steps { from: times[0], ends: &[course[self.k].t] };
        RoughStep::unless(
            guard.determinants_are_even(&nominal.state.factors, steps, |b, _| tape.determinant(b)),
        )
    }

    fn accept(&mut self) {
        let is_start = self.is_start();
        let DesignBatch { course, tapes, by, known, times, count, guard, .. } = &mut *self.batch;
        guard.accept();
        if is_start {
            // Neither a node, nor a change of a determinant over time.
            *count = 0;
            guard.forget();
        }
        let (tape, _) = at_work(tapes, *by);
        for (channel, known) in known.iter_mut().enumerate() {
            // Node n becomes node n + 1, and where the designs are now node 0 of (27).
            known.copy_within(..(NODES - 1) * ORDERS, ORDERS);
            for (order, to) in known[..ORDERS].iter_mut().enumerate() {
                *to = *tape.channel_lanes(channel, order);
            }
        }
        times.rotate_right(1);
        times[0] = course[self.k].t;
        *count = usize::min(*count + 1, NODES);
    }
}

/// Values of the drivers, up to the first interval that the output times do not resolve, and none if a singular
/// position is near the start; value, speed and acceleration of each driver at every output time.
fn course_of_laws(nominal: &mut Stepper<'_>) -> (Vec<Drive>, Vec<[f64; ORDERS]>) {
    let (mut course, mut drivers) = (Vec::new(), Vec::new());
    for (k, &t) in nominal.mechanism.model.times.iter().enumerate() {
        let h = t - nominal.mechanism.saved.time;
        if nominal.mechanism.drive(Path::Laws, t).is_err() || k > 0 && !laws_are_resolved(nominal, t) {
            break;
        }
        let Stepper { mechanism, guard, .. } = &mut *nominal;
        match k {
            0 => guard.note_driver_speeds(mechanism, |d| mechanism.drivers[d][1].abs()),
            _ => guard.accept_laws(h),
        }
        mechanism.saved.drivers.copy_from_slice(&mechanism.drivers);
        mechanism.saved.time = t;
        course.push(Drive { t, h, fastest: guard.fastest_driver });
        drivers.extend_from_slice(&mechanism.drivers);
    }
    (course, drivers)
}

/// The path of the nominal design from the design configuration, where it is, to the first output time: values of the
/// drivers in even steps, with their rates per ramp.
fn ramp(nominal: &mut Stepper<'_>, path: Path) -> (Vec<Drive>, Vec<[f64; ORDERS]>) {
    let (mut course, mut drivers) = (Vec::new(), Vec::new());
    nominal.examine(path);
    let Stepper { mechanism, lookahead, .. } = nominal;
    lookahead.measure_travel(mechanism, path, 1.0);
    let (per_step, least, most) = RAMP_STEPS;
    let steps = (per_step * lookahead.part_of_way() / PART_OF_WAY).ceil().clamp(least, most);
    let ends = mechanism.line.iter().map(|[_, to]| *to);
    let fastest =
        ends.clone().zip(&mechanism.driver_units).map(|(to, unit)| to.abs() / unit).fold(0.0, f64::max);
    for j in 0..=steps as usize {
        let part = j as f64 / steps;
        course.push(Drive { t: part, h: if j == 0 { 0.0 } else { 1.0 / steps }, fastest });
        drivers.extend(ends.clone().map(|to| [to * part, to, 0.0]));
    }
    (course, drivers)
}

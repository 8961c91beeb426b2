//! Advance from one output time to the next: predict, correct, and check the branch.
//!
//! Closely spaced output times are steps themselves ([`Stepper::glide`]): the determinants of the blocks show at no
//! cost that no singular position is near. Otherwise the solver chooses its own steps along the path ([`super::walk`]),
//! independent of the spacing of the output times.

use crate::joint::{Freedom, Quantity};
use crate::linalg::{FullPivot, LARGEST_DENSE};
use crate::model::{Contact, DriverId, Model};
use crate::space::{Quat, Real};
use crate::topology::{BlockId, RowId, SetBy, Topology};

use super::assembly::Assembly;
use super::change_point::Crossing;
use super::kinematics::{PositionFailure, Residuals, State, factors_of};
use super::parts::PlanGeometry;
use super::predictor::Predictor;
use super::singularity::{Surroundings, Workspace};
use super::turns::TurnCounter;
use super::walk::{MOST_BEND, PART_OF_WAY, Path};
use super::{SolverStatistics, Stop};

/// First correction (rad, or sizes) that is always accepted, whatever the length of the predicted move.
pub(super) const TRUST_FLOOR: f64 = 0.02;
/// Maximum first correction as a fraction of the predicted move; a larger one means that the prediction is wrong.
pub(super) const TRUST: f64 = 0.5;
/// Maximum difference between speeds after a step and their prediction, as a fraction of the fastest coordinate: for a
/// motion that the output times resolve, the difference vanishes with the step.
const SPEED_TRUST: f64 = 0.25;
/// Differences below this fraction of the fastest driver speed are ignored, for a start from rest.
const SPEED_FLOOR: f64 = 1e-3;
/// Maximum difference between coordinates of a coupler and their prediction, rad; otherwise the turn of an angle is
/// ambiguous.
const TURN_TRUST: f64 = 1.0;
/// Allowed ratio of a determinant to that at the output time before. A limit position nearer than 1.5 such steps, or a
/// change point nearer than 3.5, changes it by more (405 motions into such positions, in 20 to 500 output times).
pub(super) const MILD: [f64; 2] = [0.78, 1.28];
/// Allowed change of this ratio from one such step to the next.
pub(super) const MILD_CHANGE: f64 = 0.125;
/// Maximum speed of a law between output times, relative to its mean speeds over nearby steps: laws that rest and pulse
/// in between are followed in smaller steps.
pub(super) const EVEN: f64 = 2.0;
/// A driver that moves by less than this between output times, in rad or sizes, rests.
pub(super) const RESTS: f64 = 1e-12;
/// Number of output times over which the range of a law is evaluated at once.
const CELL: f64 = 64.0;
/// Maximum travel of a driver between output times, rad or sizes: whole turns would look like rest.
pub(super) const LONGEST: f64 = 1.0;
/// Residual of a redundant constraint, as a fraction of its loop's size (or, for a cosine, as it is), above which the
/// mechanism locks. Coordinates typed into a file have about six digits, and an axis through two of them is tilted by
/// some times that.
pub(crate) const LOCKED: f64 = 1e-5;
/// Other rows are tried when the pivot ratio has fallen to this fraction of its first value: redundant rows agree only
/// to the digits of the model file, and a weak selection magnifies the difference.
const RESELECT: f64 = 0.1;
/// If no other rows were better, they are tried again when the ratio has fallen by this factor once more.
const LOOK_AGAIN: f64 = 0.3;

/// Solver of a mechanism from one output time to the next.
pub(crate) struct Stepper<'m> {
    pub(super) model: &'m Model,
    /// Own copy, because the selection of independent rows may change along the path.
    pub topology: Topology,
    pub parts: PlanGeometry<f64>,
    pub state: State<f64>,
    /// Per driver: f, f., f.. by the parameter of the path; rad or m.
    pub drivers: Vec<[f64; 3]>,
    /// The last accepted position.
    pub(super) saved: AcceptedPosition,
    pub(super) forecast: Predictor,
    pub(super) time: f64,
    /// Start and end of each driver on a straight path.
    pub(super) line: Vec<[f64; 2]>,
    /// Per block: sign of the determinant on this branch, and the first pivot ratio.
    /// sign(det J): it keeps it as long as no singular position is passed.
    pub(super) branch: Vec<(bool, f64)>,
    /// Per block: the pivot ratio below which other rows are tried.
    pub(super) try_others: Vec<f64>,
    /// Per driver: 1 rad, or the size of its loop.
    pub(super) driver_units: Vec<f64>,
    /// Knowledge of the path ahead.
    pub(super) ahead: Lookahead,
    pub(super) around: Surroundings,
    pub(super) beyond: Surroundings,
    /// Made on first use; batches of steps do not need it.
    pub(super) workspace: Option<Box<Workspace>>,
    /// Per block: relative change of its determinant over the last step between output times, and the length of that
    /// step.
    /// `r_k - 1` of theory (28).
    pub(super) changes: Vec<f64>,
    pub(super) change_step: f64,
    /// Per driver: its travel over that step.
    /// `abs(f_k - f_k-1) / unit`.
    pub(super) moves: Vec<f64>,
    /// Per driver: its maximum speed over an interval of time.
    pub(super) speed_bounds: Vec<DriverSpeedBound>,
    /// Per direction: its maximum travel over the step considered; on a path other than the laws' in these units.
    /// Du of theory (22), m or rad.
    pub(super) travel: Vec<f64>,
    pub(super) travel_unit: f64,
    pub(super) on_laws: bool,
    /// Scratch of predictions.
    pub(super) predicted: Vec<f64>,
    /// Per curve: the predicted parameter, and its distance from the one before.
    pub(super) touching: Vec<[f64; 2]>,
    /// Fastest driver on the present path (rad, or sizes, per unit of its parameter).
    /// max abs(f.) / unit.
    pub(super) fastest_driver: f64,
    /// Largest residuals at the position tried last.
    pub(super) residuals: Residuals,
    pub effort: SolverStatistics,
    /// Number of times that other rows were selected.
    pub(super) selections: usize,
    /// Assembly of the mechanism, if it was open in the design configuration.
    pub assembly: Option<Assembly>,
    /// Counter of the angles whose turns are counted along the path; `None` if there are none.
    pub turns: Option<TurnCounter<'m>>,
    /// The change point that was crossed last.
    pub(super) crossing: Option<Box<Crossing>>,
    /// True at a change point, where J is singular and cannot be used.
    pub at_change_point: bool,
    /// Memory for the changes and moves over a batch of output times.
    pub(super) changes_ahead: Vec<f64>,
    pub(super) moves_ahead: Vec<f64>,
}

/// Maximum speed of a driver over an interval of time.
#[derive(Clone, Copy, Debug)]
pub(super) struct DriverSpeedBound {
    from: f64,
    to: f64,
    fastest: f64,
}

impl DriverSpeedBound {
    /// Maximum speed of driver d between two times: the bound known for a longer interval, up to `ahead`, if that is
    /// `enough`.
    #[inline(always)]
    pub fn fastest(
        &mut self,
        parts: &PlanGeometry<f64>,
        d: usize,
        [from, to, ahead]: [f64; 3],
        enough: f64,
    ) -> f64 {
        if !(self.from <= from && to <= self.to) {
            *self = Self { from, to: ahead, fastest: parts.fastest(d, from, ahead) };
        }
        if self.fastest <= enough { self.fastest } else { parts.fastest(d, from, to) }
    }
}

/// Knowledge of the path ahead of the saved position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lookahead {
    /// Nothing.
    Unknown,
    /// Distances of singular positions are known, in [`Stepper::around`].
    Examined,
    /// The last step was even.
    Even,
}

/// A position that was accepted.
#[derive(Clone)]
pub(super) struct AcceptedPosition {
    /// q, q., q.. of the tree, balls' quaternions apart.
    pub q: Vec<f64>,
    pub qd: Vec<f64>,
    pub qdd: Vec<f64>,
    pub balls: Vec<Quat<f64>>,
    pub pivots: Vec<(f64, bool)>,
    pub determinants: Vec<f64>,
    pub drivers: Vec<[f64; 3]>,
    /// Per row that is a term of a coupler: its coordinate, with speed and acceleration.
    pub coupled: Vec<[f64; 3]>,
    /// Per curve: its contact.
    pub contacts: Vec<Contact<f64>>,
    /// Largest residual there, sizes or rad.
    pub residual: f64,
}

/// Reason why a step was rejected.
pub(super) enum StepRejection {
    Position(PositionFailure),
    /// The determinant changed its sign, or a turn is ambiguous.
    Branch {
        block: BlockId,
    },
    Locked {
        row: RowId,
        residual: f64,
    },
    Law {
        driver: usize,
    },
    /// A driver goes too far between two output times.
    TooFar {
        driver: usize,
    },
    /// Seen from the far end, a singular position is too near for a step of this length.
    TooNear,
}

impl<'m> Stepper<'m> {
    pub fn new(model: &'m Model, topology: &Topology, parts: PlanGeometry<f64>) -> Self {
        let mut state = State::new(model, topology);
        state.contacts = parts.curves.iter().map(|c| Contact::at(c, c.start())).collect();
        let saved = AcceptedPosition {
            q: state.q.clone(),
            qd: state.motion.speeds[0].clone(),
            qdd: state.motion.speeds[1].clone(),
            balls: state.balls.clone(),
            pivots: state.pivots.clone(),
            determinants: state.determinants.clone(),
            drivers: vec![[0.0; 3]; model.drivers.len()],
            coupled: vec![[0.0; 3]; topology.rows.len()],
            contacts: state.contacts.clone(),
            residual: 0.0,
        };
        let (blocks, drivers) = (topology.blocks.len(), model.drivers.len());
        let directions = usize::max(drivers, 1);
        let around = Surroundings::unknown();
        Self {
            model,
            topology: topology.clone(),
            parts,
            state,
            line: vec![[0.0; 2]; drivers],
            forecast: Predictor::new(topology),
            time: 0.0,
            try_others: vec![0.0; blocks],
            branch: vec![(true, 0.0); blocks],
            driver_units: driver_units(model, topology),
            ahead: Lookahead::Unknown,
            beyond: around.clone(),
            around,
            workspace: None,
            changes: vec![0.0; blocks],
            change_step: 0.0,
            moves: vec![0.0; drivers],
            speed_bounds: vec![DriverSpeedBound { from: 0.0, to: f64::NEG_INFINITY, fastest: 0.0 }; drivers],
            travel: vec![0.0; directions],
            travel_unit: 1.0,
            on_laws: false,
            predicted: vec![0.0; topology.coordinates.len()],
            touching: vec![[0.0; 2]; saved.contacts.len()],
            fastest_driver: 0.0,
            residuals: Residuals::default(),
            effort: SolverStatistics { least_pivot_ratio: f64::INFINITY, ..SolverStatistics::default() },
            selections: 0,
            assembly: None,
            turns: None,
            crossing: None,
            at_change_point: false,
            changes_ahead: vec![0.0; blocks],
            moves_ahead: vec![0.0; drivers],
            drivers: saved.drivers.clone(),
            saved,
        }
    }

    /// Solves the design configuration, then moves on to the first output time.
    ///
    /// A changed design starts from the nominal design configuration and closes there first.
    pub fn start(&mut self, t: f64) -> Result<(), Box<Stop>> {
        (self.crossing, self.at_change_point) = (None, false);
        self.time = 0.0;
        self.assemble()?;
        if let Some(turns) = &mut self.turns {
            turns.begin(&self.state);
        }
        // From there, where all drivers are zero, to their values at the first output time.
        for d in 0..self.line.len() {
            self.line[d] = [0.0, self.parts.law(d, t)[0]];
        }
        // Where all drivers begin at 0 the design configuration is the first position.
        if self.line.iter().any(|[_, to]| to.abs() != 0.0) {
            // q(f = 0), which is drawn, to q(f(t_0)): all drivers straight there together
            let ramp = Path::Line { at: t };
            self.time = 0.0;
            self.attempt(ramp, 0.0).map_err(|r| self.stop(ramp, 0.0, r, false))?;
            self.save(0.0, 0.0);
            self.walk(ramp, 1.0)?;
        }
        // The rates left by the ramp are per unit of ramp; solve once more with the laws' own.
        self.time = t;
        self.attempt(Path::Laws, t).map_err(|r| self.stop(Path::Laws, t, r, false))?;
        self.save(t, 0.0);
        self.renew_turns();
        self.examine_here(Path::Laws);
        self.count();
        Ok(())
    }

    /// Moves on to the output time t.
    pub fn advance(&mut self, t: f64) -> Result<(), Box<Stop>> {
        self.at_change_point = false;
        match self.stand_within_crossing(t) {
            Some(stood) => stood?,
            None if self.glide(t) => {}
            None => self.walk(Path::Laws, t)?,
        }
        self.count();
        Ok(())
    }

    /// Continues counting angles from the accepted position, at which the state has the rates of another path.
    pub(super) fn renew_turns(&mut self) {
        if let Some(turns) = &mut self.turns {
            turns.renew(&self.state);
        }
    }

    fn count(&mut self) {
        self.effort.steps += 1;
        self.effort.iterations = self.state.iterations;
        self.effort.worst_residual = self.effort.worst_residual.max(self.residuals.largest);
        self.effort.note_pivots(self.state.pivots.iter().map(|p| p.0), self.time);
    }

    /// Advances to the output time t in one step, if the path there is known to be even; returns true if it did.
    fn glide(&mut self, t: f64) -> bool {
        let h = t - self.time;
        if self.forecast.known() == 0 || self.ahead == Lookahead::Unknown {
            return false;
        }
        if self.drive(Path::Laws, t).is_err() || !self.is_clear(t, h) {
            return false;
        }
        self.fastest_driver = self.driver_speed();
        let moved = self.predict_at(h);
        // abs(dq_0) <= max(half of the predicted move, 0.02): a larger correction may lead to another branch.
        let trust = (TRUST * moved).max(TRUST_FLOOR);
        let selections = self.selections;
        if self.state.solve(&self.topology, &self.parts, &self.drivers, trust).is_err()
            || !self.speeds_are_smooth(h)
            || !self.contacts_are_near()
            || self.examine_position().is_err()
        {
            return false;
        }
        // Determinants of different rows cannot be compared.
        let even = selections == self.selections && self.note_changes(h);
        if self.ahead == Lookahead::Even && !even {
            return false;
        }
        self.note_moves();
        if let Some(turns) = &mut self.turns {
            if !turns.is_even(&self.state, h, self.moves.iter().sum()) {
                return false;
            }
            turns.accept();
        }
        self.save(t, h);
        self.ahead = if even { Lookahead::Even } else { Lookahead::Unknown };
        true
    }

    /// Records the travel of each driver from the saved position.
    #[inline(always)]
    pub(super) fn note_moves(&mut self) {
        for (d, moved) in self.moves.iter_mut().enumerate() {
            *moved = (self.drivers[d][0] - self.saved.drivers[d][0]).abs() / self.driver_units[d];
        }
    }

    /// True if the two ends of the step to the output time t resolve the laws between them, and no singular position is
    /// known to be near. The drivers are at t already.
    #[inline(always)]
    pub(super) fn is_clear(&mut self, t: f64, h: f64) -> bool {
        for d in 0..self.drivers.len() {
            let unit = self.driver_units[d];
            let most = match self.ahead {
                Lookahead::Even => {
                    let moved = (self.drivers[d][0] - self.saved.drivers[d][0]).abs() / unit;
                    // Over the step h max abs(f.) <= 2 (larger of the last two moves) / h: the law is even in between.
                    (EVEN * self.moves[d].max(moved)).clamp(RESTS, LONGEST)
                }
                _ => LONGEST,
            };
            let stretch = [self.time, t, self.time + CELL * h];
            let travel = h / unit * self.speed_bounds[d].fastest(&self.parts, d, stretch, most * unit / h);
            if !(travel <= most) {
                return false;
            }
            self.travel[d] = travel * unit;
        }
        self.ahead == Lookahead::Even || self.around.part_of_way(&self.travel) <= PART_OF_WAY
    }

    /// Computes the relative change of each determinant since the saved position, a step h before; returns true if all
    /// changes are small and similar to those of the step before.
    #[inline(always)]
    fn note_changes(&mut self, h: f64) -> bool {
        const MIDDLE: f64 = 0.5 * (MILD[0] + MILD[1]);
        const REACH: f64 = 0.5 * (MILD[1] - MILD[0]);
        let scale = h / self.change_step;
        let mut most = 0.0;
        for (b, factors) in self.state.factors.iter().enumerate() {
            let ratio = factors.ratio(self.state.determinants[b], self.saved.determinants[b]);
            // r = det_k / det_k-1 in [0.78, 1.28],    abs((r_k - 1) - (r_k-1 - 1) h_k / h_k-1) <= 0.125           (28)
            let change = ratio - 1.0;
            most = most.larger((ratio - MIDDLE).abs() * (1.0 / REACH));
            if self.ahead == Lookahead::Even {
                let bend = (change - self.changes[b] * scale).abs();
                most = most.larger(bend * (1.0 / MILD_CHANGE));
            }
            self.changes[b] = change;
        }
        self.change_step = h;
        // NaN is not even.
        most <= 1.0
    }

    /// Sets the drivers for the path at t.
    #[inline(always)]
    pub(super) fn drive(&mut self, path: Path, t: f64) -> Result<(), StepRejection> {
        // phi = (1 - s) phi_0: the remaining fraction of every gap, and its rate by s
        self.state.gap_left = if path == Path::Assembly { [1.0 - t, -1.0] } else { [0.0; 2] };
        for k in 0..self.drivers.len() {
            let law = match path {
                Path::Assembly => [0.0; 3],
                Path::Laws => self.parts.law(k, t),
                Path::Line { .. } => {
                    let [from, to] = self.line[k];
                    // At the end exactly there.
                    let here = if t == 1.0 { to } else { from + (to - from) * t };
                    // f = f_0 + (f_1 - f_0) s,    df/ds = f_1 - f_0,    d2f/ds2 = 0
                    [here, to - from, 0.0]
                }
            };
            // An overflow of the sum is not finite either.
            if !(law[0].abs() + law[1].abs() + law[2].abs()).is_finite() {
                return Err(StepRejection::Law { driver: k });
            }
            self.drivers[k] = law;
        }
        Ok(())
    }

    /// Solves the position at t on a path, from the saved one, which is near.
    pub(super) fn attempt(&mut self, path: Path, t: f64) -> Result<(), StepRejection> {
        self.drive(path, t)?;
        self.restore();
        self.solve_within(f64::INFINITY)?;
        self.examine_position()
    }

    /// Solves from the prediction at hand; the first correction must be within `trust`.
    pub(super) fn solve_within(&mut self, trust: f64) -> Result<(), StepRejection> {
        self.state.solve(&self.topology, &self.parts, &self.drivers, trust).map_err(StepRejection::Position)
    }

    /// Sets the branch from the first position.
    pub(super) fn settle_branch(&mut self) {
        for (b, &(ratio, positive)) in self.state.pivots.iter().enumerate() {
            self.branch[b] = (positive, ratio);
            self.try_others[b] = RESELECT * ratio;
        }
    }

    /// True if the position just solved is on the branch, in the turn that was expected, and closed.
    pub(super) fn examine_position(&mut self) -> Result<(), StepRejection> {
        for (b, &(_, positive)) in BlockId::each(&self.state.pivots) {
            // sign(det J) is that of the branch: between two positions of opposite sign lies a singular one.
            if positive != self.branch[b.0].0 {
                return Err(StepRejection::Branch { block: b });
            }
        }
        if let Some(block) = self.uncertain_turn() {
            return Err(StepRejection::Branch { block });
        }
        self.residuals = self.state.residuals(&self.topology, &self.parts, &self.drivers);
        // During assembly, redundant constraints need not agree yet.
        let half_open = self.state.gap_left[0] > 0.0;
        // abs(phi) <= 1e-5 of the loop's size, redundant rows included: otherwise the constraints contradict each
        // other.
        if !half_open && !(self.residuals.scaled <= LOCKED) {
            let (row, residual) = self.state.worst_row(&self.topology, &self.parts, &self.drivers);
            return Err(StepRejection::Locked { row, residual });
        }
        self.reselect()
    }

    /// Predicts the position a step h beyond the saved one, from former positions; returns the largest move (rad, or
    /// sizes), to second order.
    #[inline(always)]
    fn predict_at(&mut self, h: f64) -> f64 {
        let t = self.time + h;
        self.state.contacts.copy_from_slice(&self.saved.contacts);
        self.forecast.set(&mut self.state, t, h);
        self.expect_turns(h);
        self.expected_move(h)
    }

    /// Largest move (rad, or sizes) over a step h, by speed and acceleration.
    #[inline(always)]
    fn expected_move(&self, h: f64) -> f64 {
        let (saved, half) = (&self.saved, 0.5 * h);
        let mut most = 0.0;
        for c in self.topology.unknown_coordinates() {
            // q. h + q.. h^2 / 2
            let step = (saved.qd[c.0] + saved.qdd[c.0] * half) * h;
            most = most.larger((step * self.topology[c].per_unit).abs());
        }
        most
    }

    /// Predicts the coordinates of couplers, a step h beyond the saved position.
    #[inline(always)]
    pub(super) fn expect_turns(&mut self, h: f64) {
        let half = 0.5 * h;
        for r in self.topology.coupler_terms() {
            let [x, v, a] = self.saved.coupled[r.0];
            // chi + chi. h + chi.. h^2 / 2
            self.state.near[r.0] = x + (v + a * half) * h;
        }
    }

    /// Speed of the fastest driver (rad, or sizes, per unit of the path's parameter), now or before.
    #[inline(always)]
    pub(super) fn driver_speed(&self) -> f64 {
        self.driver_units
            .iter()
            .zip(&self.drivers)
            // max abs(f.) / unit
            .fold(self.fastest_driver, |most, (unit, f)| most.max(f[1].abs() / unit))
    }

    /// Block of a coupler with an angle whose turn is ambiguous.
    #[inline(always)]
    pub(super) fn uncertain_turn(&self) -> Option<BlockId> {
        let (topology, s) = (&self.topology, &self.state);
        let uncertain = |r: &RowId| {
            let [value, ..] = s.coordinate_of_row(topology, *r);
            // NaN is uncertain.
            !topology.constraint(*r).is_length() && !((value - s.near[r.0]).abs() <= TURN_TRUST)
        };
        // All terms of a coupler are of its block.
        topology.coupler_terms().find(uncertain).and_then(|r| topology.closure_of(r).block)
    }

    /// True if the speeds are those of the same branch as before the step.
    pub(super) fn speeds_are_smooth(&self, h: f64) -> bool {
        let (s, saved) = (&self.state, &self.saved);
        let (mut fastest, mut difference) = (0.0_f64, 0.0_f64);
        for c in self.topology.unknown_coordinates() {
            let (now, per_unit) = (s.motion.speeds[0][c.0], self.topology[c].per_unit);
            // abs(q. - (q._0 + q.._0 h)) against the larger of the two speeds
            let predicted = saved.qd[c.0] + saved.qdd[c.0] * h;
            fastest = fastest.larger(now.abs().larger(saved.qd[c.0].abs()) * per_unit);
            difference = difference.larger((now - predicted).abs() * per_unit);
        }
        smooth(difference, fastest, self.fastest_driver)
    }

    /// Returns true if all curves are nearly straight from the former contact to the present one.
    fn contacts_are_near(&self) -> bool {
        let contacts = self.state.contacts.iter().zip(&self.saved.contacts);
        contacts
            .zip(&self.parts.curves)
            .all(|((now, before), curve)| curve.bend(before.u, now.u) <= MOST_BEND)
    }

    /// Accepts the position at t, a step h after the one before (0 at the start of a path). The path ahead is unknown
    /// then.
    pub(super) fn save(&mut self, t: f64, h: f64) {
        let (s, saved) = (&self.state, &mut self.saved);
        if h == 0.0 {
            self.forecast.forget();
        }
        self.forecast.learn(t, s);
        saved.q.copy_from_slice(&s.q);
        saved.qd.copy_from_slice(&s.motion.speeds[0]);
        saved.qdd.copy_from_slice(&s.motion.speeds[1]);
        saved.balls.copy_from_slice(&s.balls);
        saved.pivots.copy_from_slice(&s.pivots);
        saved.determinants.copy_from_slice(&s.determinants);
        saved.drivers.copy_from_slice(&self.drivers);
        saved.contacts.copy_from_slice(&s.contacts);
        saved.residual = self.residuals.scaled;
        for r in self.topology.coupler_terms() {
            saved.coupled[r.0] = s.coordinate_of_row(&self.topology, r);
        }
        self.time = t;
        self.ahead = Lookahead::Unknown;
    }

    /// Restores the coordinates of the saved position.
    pub(super) fn restore(&mut self) {
        let (s, saved) = (&mut self.state, &self.saved);
        s.q.copy_from_slice(&saved.q);
        s.balls.copy_from_slice(&saved.balls);
        s.contacts.copy_from_slice(&saved.contacts);
        for r in self.topology.coupler_terms() {
            s.near[r.0] = saved.coupled[r.0][0];
        }
    }

    /// Selects other independent rows for blocks whose present ones have become nearly dependent.
    pub(super) fn reselect(&mut self) -> Result<(), StepRejection> {
        for b in self.topology.block_ids() {
            let ratio = self.state.pivots[b.0].0;
            // min / max of the pivots, compared with a tenth of its value when these rows were selected
            if ratio >= self.try_others[b.0] {
                continue;
            }
            self.try_others[b.0] = LOOK_AGAIN * ratio;
            let rows = self.topology.rows_of_block(b);
            if rows.len() == self.topology[b].unknowns.len() {
                continue;
            }
            self.state.finish_wrenches(&self.topology);
            let (block, s) = (&self.topology[b], &self.state);
            let matrix = rows
                .iter()
                .map(|&r| {
                    let mut row = vec![0.0; block.unknowns.len()];
                    s.scaled_row(&self.topology, r, &mut row);
                    let entries = row.into_iter().enumerate();
                    entries.filter(|(_, x)| *x != 0.0).collect()
                })
                .collect();
            // From all rows of the block, redundant ones included, select those with the largest pivots.
            let pivots = FullPivot::of_sparse(matrix, block.unknowns.len(), f64::MIN_POSITIVE);
            let mut selected: Vec<RowId> = pivots.rows.iter().map(|&r| rows[r]).collect();
            selected.sort_unstable();
            if selected.len() < block.unknowns.len() || selected == block.selected {
                continue;
            }
            self.topology.select(b, selected);
            self.selections += 1;
            self.renew_factors(b);
            // Other rows at the same position: new factors, and a new sign of the determinant.
            self.state
                .solve(&self.topology, &self.parts, &self.drivers, f64::INFINITY)
                .map_err(StepRejection::Position)?;
            let (ratio, positive) = self.state.pivots[b.0];
            self.branch[b.0] = (positive, ratio);
            self.try_others[b.0] = RESELECT * ratio;
        }
        Ok(())
    }

    /// Replaces the factors of a block after a change of its rows, whose entries are elsewhere.
    pub(super) fn renew_factors(&mut self, b: BlockId) {
        let block = &self.topology[b];
        self.state.factors[b.0] = factors_of(&self.topology, block, LARGEST_DENSE);
    }

    /// Values of the tree coordinates; 0 for those of balls.
    pub fn coordinates(&self) -> impl Iterator<Item = f64> + '_ {
        let ball = self.topology.links.iter().flat_map(|l| &l.steps).filter(|s| s.freedom == Freedom::Ball);
        assert!(ball.map(|s| self.state.q[s.first.0]).all(|q| q == 0.0));
        self.state.q.iter().copied()
    }
}

/// True if this difference between speeds and their prediction belongs to the same branch, for these maximum speeds of
/// coordinates and drivers.
#[inline(always)]
pub(super) fn smooth(difference: f64, fastest: f64, fastest_driver: f64) -> bool {
    // NaN is rejected.
    // max abs(q. - predicted) <= max(0.25 max abs(q.), 1e-3 max abs(f.)): speeds on another branch differ by more
    difference <= f64::max(SPEED_TRUST * fastest, SPEED_FLOOR * fastest_driver)
}

/// Unit of travel per driver: 1 rad, or the size of the largest loop that it moves.
pub(crate) fn driver_units(model: &Model, topology: &Topology) -> Vec<f64> {
    let whole = model.size();
    // Du_d / unit is a number without dimension: rad, or a part of the loop.
    let unit = |(k, driver): (usize, &crate::model::Driver)| {
        if model.driven(driver).quantity != Quantity::Length {
            return 1.0;
        }
        let d = DriverId(k);
        let coordinate = topology.coordinates.iter().find(|c| c.set_by == SetBy::Driver(d));
        let closure = topology.closures.iter().find(|c| c.driver == Some(d));
        coordinate.map(|c| c.unit).or(closure.map(|c| c.size)).unwrap_or(whole)
    };
    model.drivers.iter().enumerate().map(unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::Law;
    use crate::space::Vec3;
    use crate::topology::Formulation;
    use crate::{draft::*, model::*};

    /// Nodes on two slides each, connected by rods to the two nodes before; a leg drives the last.
    fn truss(n: usize) -> Model {
        let place = |k: usize| [0.5 * k as f64, 0.8 * (k % 2) as f64, 0.0];
        let node = |k: usize| if k == 0 { "ground".to_owned() } else { format!("node{k}") };
        let [x, y, _] = Vec3::AXES;
        let mut draft = Draft::new("truss").times([0.0, 0.1, 0.2]);
        for k in 1..n {
            let slider = format!("slider{k}");
            draft = draft
                .bodies([slider.as_str(), &node(k)])
                .translational(format!("x{k}"), ["ground", &slider], place(k), x)
                .translational(format!("y{k}"), [&slider, &node(k)], place(k), y);
            for other in k.saturating_sub(2)..k {
                let ends = [node(other), node(k)];
                draft = draft.distance(format!("rod{other}_{k}"), ends, [place(other), place(k)]);
            }
        }
        let leg = JointDraft::new("push", "leg", ["ground", &node(n - 1)]);
        let draft = draft.joint(leg.at([0.5 * n as f64, -1.0, 0.3]).at(place(n - 1))).driver(
            "motor",
            "push",
            Law::parse("0.1*sin(2*pi*t)").unwrap(),
        );
        Model::from_draft(&draft).unwrap()
    }

    /// The states of all bodies at the last output time, with blocks up to this size factored densely.
    fn last(model: &Model, topology: &Topology, largest_dense: usize) -> (State<f64>, Vec<bool>) {
        let (design, laws) = (model.geometry(&[]), model.laws(&[]));
        let mut stepper = Stepper::new(model, topology, PlanGeometry::same(model, topology, &design, &laws));
        let blocks = topology.blocks.iter();
        stepper.state.factors = blocks.map(|b| factors_of(topology, b, largest_dense)).collect();
        stepper.start(model.times[0]).unwrap();
        model.times[1..].iter().for_each(|t| stepper.advance(*t).unwrap());
        let signs = stepper.state.pivots.iter().map(|p| p.1).collect();
        (stepper.state, signs)
    }

    #[test]
    fn sparse_and_dense_factors_give_the_same_motion() {
        for n in [5, 30] {
            let model = truss(n);
            let topology = Topology::of(&model, Formulation::Relative).unwrap();
            let size = model.size();
            let (dense, dense_signs) = last(&model, &topology, usize::MAX);
            let (sparse, sparse_signs) = last(&model, &topology, 0);
            assert_eq!(dense_signs, sparse_signs);
            let apart = |a: Vec3, b: Vec3| (a - b).norm();
            for b in 0..model.bodies.len() {
                assert!(apart(dense.pose[b].r, sparse.pose[b].r) < 1e-12 * size, "body {b} of {n}");
                assert!(
                    apart(dense.motion.twists[0][b].v, sparse.motion.twists[0][b].v) < 1e-11 * size,
                    "body {b} of {n}"
                );
            }
        }
    }
}

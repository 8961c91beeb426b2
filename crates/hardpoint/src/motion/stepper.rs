//! From one output time to the next: predict, correct, watch for limits and branches.

use crate::constraint::Row;
use crate::joint::Freedom;
use crate::model::{Contact, DriverId, Model};
use crate::space::{FullPivot, LARGEST_DENSE, Quat, Real};
use crate::topology::{Source, Topology};

use super::assembly::Assembly;
use super::forecast::Forecast;
use super::kinematics::{PositionFailure, Residuals, State, factors_of};
use super::parts::Parts;
use super::{Effort, Stop, StopKind};

/// A first correction (rad, or sizes) up to this is accepted whatever the prediction's own length is.
const TRUST_FLOOR: f64 = 0.02;
/// The first correction may be this part of the predicted move: more means a prediction gone wrong.
const TRUST: f64 = 0.5;
/// Speeds after a step may differ from the predicted ones by this part of the fastest coordinate. At a
/// dead point two branches meet with different speeds: a step onto the other one shows here however
/// short it is, while on a smooth motion the difference vanishes with the step.
const SPEED_TRUST: f64 = 0.25;
/// Differences below this part of the drivers' fastest speed do not count: a start from rest.
const SPEED_FLOOR: f64 = 1e-3;
/// The coordinates of a coupler must come within this of their prediction, rad: which turn an angle is in would
/// otherwise be a guess.
const TURN_TRUST: f64 = 1.0;
/// Within this part of an output step the speed of a smooth law hardly changes.
const SMOOTH_PART: f64 = 1e-3;
/// Coordinates this much faster than the fastest driver are on their way to a limit position.
const RUNAWAY: f64 = 1e3;
/// A pivot ratio that has fallen to this part of its first value is on its way to a singular position.
const NEARLY_SINGULAR: f64 = 1e-3;
/// A step is halved at most this often: 2^-40 of an output step decides nothing that a user could see.
const MAX_HALVINGS: u32 = 40;
/// A walk to the next output time gives up after this many steps: a path that bends so sharply all the way leads nowhere.
const MOST_STEPS: usize = 20_000;
/// A left-out constraint that fails by more than this part of the mechanism's size (or, for a cosine, by
/// more than this) is a contradiction: the mechanism locks. Typed coordinates have about six digits, and an
/// axis through two of them is tilted by some times that.
pub(crate) const LOCKED: f64 = 1e-5;
/// When the pivot ratio has fallen to this part of its first value, other rows may serve better: redundant ones agree to the
/// digits of the drawing only, and a weak selection magnifies what they lack.
const RESELECT: f64 = 0.1;
/// Where others did not serve better, they are tried again when the ratio has fallen by this factor once more.
const LOOK_AGAIN: f64 = 0.3;

/// A mechanism on its way through time, one design per lane.
pub(crate) struct Stepper<'m, T> {
    pub(super) model: &'m Model,
    /// Own copy: the selection of independent rows may change on the way.
    pub topology: Topology,
    pub parts: Parts<T>,
    pub state: State<T>,
    pub drivers: Vec<[T; 3]>,
    /// The last accepted position.
    pub(super) saved: Saved<T>,
    pub(super) forecast: Forecast<T>,
    pub(super) time: f64,
    /// Per block: sign of the determinant on this branch, and the first pivot ratio.
    pub(super) branch: Vec<(bool, f64)>,
    /// Per block: the pivot ratio below which other rows are tried.
    pub(super) try_others: Vec<f64>,
    /// Fastest driver on the present path (rad, or sizes, per unit of its parameter).
    pub(super) fastest_driver: f64,
    /// A law whose speed changes much within a step shorter than this has a jump there.
    shortest_smooth: f64,
    /// By how much the constraints fail at the position tried last.
    pub(super) residuals: Residuals,
    pub effort: Effort,
    /// How often other rows were chosen.
    pub(super) selections: usize,
    /// How the mechanism was closed, if it was open as drawn.
    pub assembly: Option<Assembly>,
}

/// A position that was accepted.
#[derive(Clone)]
pub(super) struct Saved<T> {
    pub q: Vec<T>,
    pub qd: Vec<T>,
    pub qdd: Vec<T>,
    pub balls: Vec<Quat<T>>,
    pub pivots: Vec<(f64, bool)>,
    pub drivers: Vec<[T; 3]>,
    /// Per row that is a term of a coupler: its coordinate, with speed and acceleration.
    pub coupled: Vec<[T; 3]>,
    /// Per curve: where it is touched.
    pub contacts: Vec<Contact<T>>,
}

/// What the drivers follow.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Path {
    /// From the configuration as drawn, where joints may be open, to the closed one, all drivers at zero; the
    /// parameter runs from 0 to 1 and is the part of every gap that is closed.
    Assembly,
    /// From the design configuration, where all drivers are zero, to their values at the start time;
    /// the parameter runs from 0 to 1.
    Ramp { start: f64 },
    /// Their laws, over time.
    Laws,
}

/// Why a step was refused.
pub(super) enum Refusal {
    Position(PositionFailure),
    Branch { block: usize },
    Locked { row: usize, residual: f64 },
    Law { driver: usize },
}

impl<'m, T: Real> Stepper<'m, T> {
    pub fn new(model: &'m Model, topology: &Topology, parts: Parts<T>, witness: T) -> Self {
        let mut state = State::new(model, topology, witness);
        state.contacts =
            parts.curves.iter().map(|c| Contact::at(c, witness, witness.like(c.start()))).collect();
        let saved = Saved {
            q: state.q.clone(),
            qd: state.qd.clone(),
            qdd: state.qdd.clone(),
            balls: state.balls.clone(),
            pivots: state.pivots.clone(),
            drivers: vec![[witness.zero(); 3]; model.drivers.len()],
            coupled: vec![[witness.zero(); 3]; topology.rows.len()],
            contacts: state.contacts.clone(),
        };
        let branch = vec![(true, 0.0); topology.blocks.len()];
        let drivers = saved.drivers.clone();
        let effort = Effort { least_pivot_ratio: f64::INFINITY, ..Effort::default() };
        Self {
            model,
            topology: topology.clone(),
            parts,
            state,
            drivers,
            forecast: Forecast::new(topology, witness),
            saved,
            time: 0.0,
            try_others: vec![0.0; branch.len()],
            branch,
            fastest_driver: 0.0,
            shortest_smooth: 0.0,
            residuals: Residuals::default(),
            effort,
            selections: 0,
            assembly: None,
        }
    }

    /// Solves the design configuration, then moves on to the first output time.
    ///
    /// A changed design starts from the nominal design configuration and closes there first.
    pub fn start(&mut self, t: f64) -> Result<(), Box<Stop>> {
        self.time = 0.0;
        self.assemble()?;
        let ramp = Path::Ramp { start: t };
        self.time = 0.0;
        self.attempt(ramp, 0.0, 0.0, false).map_err(|r| self.stop(ramp, 0.0, r, false))?;
        self.save(0.0, 0.0);
        self.walk(ramp, 1.0)?;
        // The rates left by the ramp are per unit of ramp; solve once more with the laws' own.
        self.fastest_driver = 0.0;
        self.time = t;
        self.attempt(Path::Laws, t, 0.0, false).map_err(|r| self.stop(Path::Laws, t, r, false))?;
        self.save(t, 0.0);
        self.count();
        Ok(())
    }

    /// Moves on to the output time t.
    pub fn advance(&mut self, t: f64) -> Result<(), Box<Stop>> {
        self.walk(Path::Laws, t)?;
        self.count();
        Ok(())
    }

    fn count(&mut self) {
        self.effort.steps += 1;
        self.effort.iterations = self.state.iterations;
        self.effort.worst_residual = self.effort.worst_residual.max(self.residuals.largest);
        for &(ratio, _) in &self.state.pivots {
            if ratio < self.effort.least_pivot_ratio {
                (self.effort.least_pivot_ratio, self.effort.least_pivot_time) = (ratio, self.time);
            }
        }
    }

    pub(super) fn walk(&mut self, path: Path, target: f64) -> Result<(), Box<Stop>> {
        let whole = target - self.time;
        let mut h = whole;
        self.shortest_smooth = SMOOTH_PART * whole;
        let shortest = whole * 0.5_f64.powi(MAX_HALVINGS as i32);
        let mut attempts = 0;
        loop {
            attempts += 1;
            let rest = target - self.time;
            let last = h >= rest;
            let step = if last { rest } else { h };
            let t = if last { target } else { self.time + step };
            match self.attempt(path, t, step, false) {
                Ok(()) => {
                    self.save(t, step);
                    if last {
                        return Ok(());
                    }
                    self.effort.substeps += 1;
                    h = 2.0 * step;
                }
                Err(refusal) => {
                    h = 0.5 * step;
                    let final_refusal = matches!(refusal, Refusal::Law { .. });
                    if h < shortest || final_refusal || attempts > MOST_STEPS || self.time + h == self.time {
                        return Err(self.stop(path, t, refusal, true));
                    }
                }
            }
        }
    }

    /// Sets the drivers for the path at t.
    fn drive(&mut self, path: Path, t: f64) -> Result<(), Refusal> {
        self.state.gap_left = if path == Path::Assembly { [1.0 - t, -1.0] } else { [0.0; 2] };
        let witness = self.state.witness;
        for k in 0..self.drivers.len() {
            let law = match path {
                Path::Assembly => [witness.zero(); 3],
                Path::Laws => self.parts.law(k, t, witness),
                Path::Ramp { start } => {
                    let [f, ..] = self.parts.law(k, start, witness);
                    [f * witness.like(t), f, witness.zero()]
                }
            };
            if !law.iter().all(|x| x.abs().largest().is_finite()) {
                return Err(Refusal::Law { driver: k });
            }
            self.drivers[k] = law;
        }
        Ok(())
    }

    /// Tries the position at t, a step h beyond the saved one. `first` sets the branch to stay on.
    pub(super) fn attempt(&mut self, path: Path, t: f64, h: f64, first: bool) -> Result<(), Refusal> {
        let witness = self.state.witness;
        witness.within(
            #[inline(always)]
            || self.attempting(path, t, h, first),
        )
    }

    #[inline(always)]
    fn attempting(&mut self, path: Path, t: f64, h: f64, first: bool) -> Result<(), Refusal> {
        self.drive(path, t)?;
        self.fastest_driver = match path {
            Path::Assembly => self.state.largest_gap(&self.topology),
            _ => self.driver_speed(),
        };
        let moved = self.predict(h);
        let trust = if first { f64::INFINITY } else { (TRUST * moved).max(TRUST_FLOOR) };
        self.state.solve(&self.topology, &self.parts, &self.drivers, trust).map_err(Refusal::Position)?;
        for (b, &(ratio, positive)) in self.state.pivots.iter().enumerate() {
            if first {
                self.branch[b] = (positive, ratio);
                self.try_others[b] = RESELECT * ratio;
            } else if positive != self.branch[b].0 {
                return Err(Refusal::Branch { block: b });
            }
        }
        if let Some(block) = self.uncertain_turn() {
            return Err(Refusal::Branch { block });
        }
        // Where a driver's own speed jumps (`abs`, `if`), those of the mechanism may: but only there.
        let jump = h < self.shortest_smooth && !self.drivers_are_smooth(h);
        if h != 0.0 && !jump && !self.speeds_are_smooth(self.state.witness.like(h)) {
            return Err(Refusal::Branch { block: self.least_regular_block() });
        }
        self.residuals = self.state.residuals(&self.topology, &self.parts, &self.drivers);
        // On the way to being closed, redundant constraints need not agree yet.
        let half_open = path == Path::Assembly && t < 1.0;
        if !half_open && !(self.residuals.scaled <= LOCKED) {
            let (row, residual) = self.state.worst_row(&self.topology, &self.parts, &self.drivers);
            return Err(Refusal::Locked { row, residual });
        }
        self.reselect()
    }

    /// Foresees the position a step h beyond the saved one; returns how far the largest move goes (rad, or sizes), to
    /// second order.
    fn predict(&mut self, h: f64) -> f64 {
        let witness = self.state.witness;
        witness.within(
            #[inline(always)]
            || {
                let t = witness.like(self.time + h);
                let (s, saved) = (&mut self.state, &self.saved);
                s.q.copy_from_slice(&saved.q);
                s.balls.copy_from_slice(&saved.balls);
                s.contacts.copy_from_slice(&saved.contacts);
                if h != 0.0 && self.forecast.known() > 0 {
                    self.forecast.set(s, t, h, |x| x);
                }
                self.expect_turns(witness.like(h));
                self.expected_move(witness.like(h)).largest()
            },
        )
    }

    /// The largest move (rad, or sizes) over a step h, by speed and acceleration.
    #[inline(always)]
    fn expected_move(&self, h: T) -> T {
        let (saved, per_size, half) = (&self.saved, h.like(1.0 / self.state.size), h.like(0.5) * h);
        let mut most = h.zero();
        for (c, coordinate) in self.topology.coordinates.iter().enumerate() {
            if let Source::Unknown { .. } = coordinate.source {
                let step = (saved.qd[c] + saved.qdd[c] * half) * h;
                most = most.larger(if coordinate.is_length { step * per_size } else { step }.abs());
            }
        }
        most
    }

    /// About what the coordinates of couplers are, a step h beyond the saved position.
    #[inline(always)]
    pub(super) fn expect_turns(&mut self, h: T) {
        let half = h.like(0.5) * h;
        for &r in &self.topology.coupled_rows {
            for (k, _) in self.topology.parts_of_row(r) {
                let [x, v, a] = self.saved.coupled[k];
                self.state.near[k] = x + (v + a * half) * h;
            }
        }
    }

    /// Speed of the fastest driver (rad, or sizes, per unit of the path's parameter), now or before.
    #[inline(always)]
    pub(super) fn driver_speed(&self) -> f64 {
        self.model.drivers.iter().zip(&self.drivers).fold(self.fastest_driver, |most, (d, f)| {
            let length = self.model.driven(d).quantity == crate::joint::Quantity::Length;
            most.max(f[1].abs().largest() / if length { self.state.size } else { 1.0 })
        })
    }

    /// The block of a coupler that counts an angle whose turn the prediction does not tell for sure.
    #[inline(always)]
    pub(super) fn uncertain_turn(&self) -> Option<usize> {
        let s = &self.state;
        let uncertain = |k: usize| {
            let [value, ..] = s.coordinate_of_row(&self.topology, k);
            let closure = &self.topology.closures[self.topology.rows[k].closure];
            let row = closure.rows[self.topology.rows[k].index];
            // Written so that NaN is uncertain.
            !row.is_length() && !((value - s.near[k]).abs().largest() <= TURN_TRUST)
        };
        let rows = self.topology.coupled_rows.iter();
        let found = rows.copied().find(|&r| self.topology.parts_of_row(r).any(|(k, _)| uncertain(k)));
        found.and_then(|r| self.topology.closures[self.topology.rows[r].closure].block)
    }

    /// Whether no driver's speed jumps within the step.
    fn drivers_are_smooth(&self, h: f64) -> bool {
        self.model.drivers.iter().zip(self.drivers.iter().zip(&self.saved.drivers)).all(
            |(d, (now, before))| {
                let length = self.model.driven(d).quantity == crate::joint::Quantity::Length;
                let size = if length { self.state.size } else { 1.0 };
                let jump = (now[1] - before[1] - before[2] * now[1].like(h)).abs().largest() / size;
                jump <= SPEED_FLOOR * self.fastest_driver
            },
        )
    }

    /// Whether the speeds are those of the same branch as before the step.
    pub(super) fn speeds_are_smooth(&self, h: T) -> bool {
        self.state.witness.within(
            #[inline(always)]
            || {
                let (s, saved) = (&self.state, &self.saved);
                let (zero, per_size) = (s.witness.zero(), s.witness.like(1.0 / s.size));
                let (mut fastest, mut difference) = (zero, zero);
                for (c, coordinate) in self.topology.coordinates.iter().enumerate() {
                    if let Source::Unknown { .. } = coordinate.source {
                        let predicted = saved.qd[c] + saved.qdd[c] * h;
                        let speed = s.qd[c].abs().larger(saved.qd[c].abs());
                        let apart = (s.qd[c] - predicted).abs();
                        let unit = if coordinate.is_length { per_size } else { zero.like(1.0) };
                        fastest = fastest.larger(speed * unit);
                        difference = difference.larger(apart * unit);
                    }
                }
                // Written so that NaN is refused.
                difference.largest()
                    <= f64::max(SPEED_TRUST * fastest.largest(), SPEED_FLOOR * self.fastest_driver)
            },
        )
    }

    /// Speed of the fastest unknown at the saved position.
    fn saved_speed(&self) -> f64 {
        self.topology.coordinates.iter().enumerate().fold(0.0, |most, (c, coordinate)| {
            let size = if coordinate.is_length { self.state.size } else { 1.0 };
            match coordinate.source {
                Source::Unknown { .. } => most.max(self.saved.qd[c].abs().largest() / size),
                Source::Driven(_) => most,
            }
        })
    }

    /// The block whose Jacobian is nearest to singular, compared with where it started.
    fn least_regular_block(&self) -> usize {
        let regularity = |b: &usize| self.state.pivots[*b].0 / self.branch[*b].1;
        (0..self.state.pivots.len()).min_by(|a, b| regularity(a).total_cmp(&regularity(b))).unwrap_or(0)
    }

    /// Accepts the position at t, a step h after the one before (0 at the start of a path).
    pub(super) fn save(&mut self, t: f64, h: f64) {
        let witness = self.state.witness;
        witness.within(
            #[inline(always)]
            || self.saving(t, h),
        );
    }

    #[inline(always)]
    fn saving(&mut self, t: f64, h: f64) {
        let (s, saved) = (&self.state, &mut self.saved);
        if h == 0.0 {
            self.forecast.forget();
        }
        self.forecast.learn(t, s, |x| x);
        saved.q.copy_from_slice(&s.q);
        saved.qd.copy_from_slice(&s.qd);
        saved.qdd.copy_from_slice(&s.qdd);
        saved.balls.copy_from_slice(&s.balls);
        saved.pivots.copy_from_slice(&s.pivots);
        saved.drivers.copy_from_slice(&self.drivers);
        saved.contacts.copy_from_slice(&s.contacts);
        for &r in &self.topology.coupled_rows {
            for (k, _) in self.topology.parts_of_row(r) {
                saved.coupled[k] = s.coordinate_of_row(&self.topology, k);
            }
        }
        self.time = t;
    }

    /// Goes back to the saved position.
    pub(super) fn restore(&mut self) {
        self.predict(0.0);
    }

    /// Chooses other independent rows for blocks whose present ones have become nearly dependent.
    fn reselect(&mut self) -> Result<(), Refusal> {
        for b in 0..self.topology.blocks.len() {
            let ratio = self.state.pivots[b].0;
            if ratio >= self.try_others[b] {
                continue;
            }
            self.try_others[b] = LOOK_AGAIN * ratio;
            let rows = self.topology.rows_of_block(b);
            if rows.len() == self.topology.blocks[b].unknowns.len() {
                continue;
            }
            self.state.finish_wrenches(&self.topology);
            let (block, s) = (&self.topology.blocks[b], &self.state);
            let matrix = rows
                .iter()
                .map(|&r| {
                    let mut row = vec![s.witness.zero(); block.unknowns.len()];
                    s.scaled_row(&self.topology, r, &mut row);
                    let entries = row.into_iter().map(|x| x.lane(0)).enumerate();
                    entries.filter(|(_, x)| *x != 0.0).collect()
                })
                .collect();
            let pivots = FullPivot::of_sparse(matrix, block.unknowns.len(), f64::MIN_POSITIVE);
            let mut selected: Vec<usize> = pivots.rows.iter().map(|&r| rows[r]).collect();
            selected.sort_unstable();
            if selected.len() < block.unknowns.len() || selected == block.selected {
                continue;
            }
            self.topology.select(b, selected);
            self.selections += 1;
            self.renew_factors(b);
            // The same position, seen through other rows: new factors, and a new sign to stay with.
            self.state
                .solve(&self.topology, &self.parts, &self.drivers, f64::INFINITY)
                .map_err(Refusal::Position)?;
            let (ratio, positive) = self.state.pivots[b];
            self.branch[b] = (positive, ratio);
            self.try_others[b] = RESELECT * ratio;
        }
        Ok(())
    }

    /// Room for the factors of a block that is solved with other rows from now on: they have entries in other places.
    pub(super) fn renew_factors(&mut self, b: usize) {
        let block = &self.topology.blocks[b];
        self.state.factors[b] = factors_of(&self.topology, block, LARGEST_DENSE, self.state.witness);
    }

    /// What kind of position a walk in ever smaller steps has come to.
    ///
    /// At a limit the speeds grow without bound; where branches cross they stay finite while the Jacobian
    /// becomes singular. Where neither is so, the drivers ask for something out of reach.
    fn obstacle(&self, block: usize, jumped: bool) -> StopKind {
        let singular = self.saved.pivots[block].0 < NEARLY_SINGULAR * self.branch[block].1;
        if self.saved_speed() <= RUNAWAY * self.fastest_driver && (jumped || singular) {
            StopKind::BranchChange
        } else {
            StopKind::Limit
        }
    }

    pub(super) fn stop(&self, path: Path, t: f64, refusal: Refusal, moved: bool) -> Box<Stop> {
        let (kind, block) = match refusal {
            Refusal::Position(
                PositionFailure::Singular { block } | PositionFailure::NoConvergence { block },
            ) => (self.obstacle(block, false), Some(block)),
            Refusal::Branch { block } => (self.obstacle(block, true), Some(block)),
            Refusal::Locked { row, residual } => {
                let place = &self.topology.rows[row];
                let closure = &self.topology.closures[place.closure];
                let row: Row = closure.rows[place.index];
                let kind = StopKind::Locked { joint: closure.joint, residual, is_length: row.is_length() };
                (kind, closure.block)
            }
            Refusal::Law { driver } => (StopKind::LawNotFinite { driver: DriverId(driver) }, None),
        };
        let ramp_start = match path {
            Path::Assembly => Some(0.0),
            Path::Ramp { start } => Some(start),
            Path::Laws => None,
        };
        Box::new(Stop {
            kind,
            last_time: (moved && ramp_start.is_none()).then_some(self.time),
            failed_time: ramp_start.unwrap_or(t),
            drivers: self
                .model
                .drivers
                .iter()
                .map(|d| match path {
                    Path::Assembly => 0.0,
                    Path::Ramp { start } => self.time * d.law.at(start).value(),
                    Path::Laws => d.law.at(self.time).value(),
                })
                .collect(),
            block,
            pivot_ratio: block.map_or(1.0, |b| self.saved.pivots[b].0),
            joints: block.map_or_else(Vec::new, |b| self.topology.joints_of_block(b)),
            remains: Vec::new(),
            closed: (path == Path::Assembly).then_some(self.time),
        })
    }

    /// Values of the tree coordinates, lane 0; 0 for those of balls.
    pub fn coordinates(&self) -> impl Iterator<Item = f64> + '_ {
        let ball = self.topology.links.iter().flat_map(|l| &l.steps).filter(|s| s.freedom == Freedom::Ball);
        debug_assert!(ball.map(|s| self.state.q[s.first].lane(0)).all(|q| q == 0.0));
        self.state.q.iter().map(|q| q.lane(0))
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};

    use super::*;
    use crate::law::Law;
    use crate::model::*;
    use crate::space::{Vec3, lanes};
    use crate::topology::Formulation;

    /// Nodes on two slides each, tied by rods to the two nodes before; a leg pushes at the last.
    fn truss(n: usize) -> Model {
        let place = |k: usize| Place::At(Vec3::new(0.5 * k as f64, 0.8 * (k % 2) as f64, 0.0));
        let node = |k: usize| if k == 0 { "ground".to_owned() } else { format!("node{k}") };
        let joint =
            |name: String, kind: &str, bodies: [String; 2], at: Vec<Place>, axis: Option<usize>| JointDraft {
                name,
                kind: kind.into(),
                bodies,
                at,
                axis: axis.map(|k| Line::Along(Vec3::AXES[k])),
                ..JointDraft::default()
            };
        let mut draft = Draft { times: vec![0.0, 0.1, 0.2], ..Draft::default() };
        for k in 1..n {
            let slider = format!("slider{k}");
            for name in [slider.clone(), node(k)] {
                draft.bodies.push(BodyDraft { name, frame: FrameDraft::Default });
            }
            let bodies = ["ground".into(), slider.clone()];
            draft.joints.push(joint(format!("x{k}"), "translational", bodies, vec![place(k)], Some(0)));
            let bodies = [slider, node(k)];
            draft.joints.push(joint(format!("y{k}"), "translational", bodies, vec![place(k)], Some(1)));
            for other in k.saturating_sub(2)..k {
                let (ends, at) = ([node(other), node(k)], vec![place(other), place(k)]);
                draft.joints.push(joint(format!("rod{other}_{k}"), "distance", ends, at, None));
            }
        }
        let at = vec![Place::At(Vec3::new(0.5 * n as f64, -1.0, 0.3)), place(n - 1)];
        draft.joints.push(joint("push".into(), "leg", ["ground".into(), node(n - 1)], at, None));
        draft.drivers.push(DriverDraft {
            name: "motor".into(),
            drives: DrivenDraft::Coordinate { joint: "push".into(), coordinate: None },
            law: Law::parse("0.1*sin(2*pi*t)").unwrap(),
        });
        Model::from_draft(&draft).unwrap()
    }

    /// The states of all bodies at the last output time, with blocks up to this size factored densely.
    fn last<T: Real>(
        model: &Model,
        topology: &Topology,
        largest_dense: usize,
        zero: T,
    ) -> (State<T>, Vec<bool>) {
        let (design, laws) = (model.geometry(&[]), model.laws(&[]));
        let mut stepper =
            Stepper::new(model, topology, Parts::same(model, topology, &design, &laws, zero), zero);
        let blocks = topology.blocks.iter();
        stepper.state.factors = blocks.map(|b| factors_of(topology, b, largest_dense, zero)).collect();
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
            let (dense, dense_signs) = last(&model, &topology, usize::MAX, 0.0);
            let (sparse, sparse_signs) = last(&model, &topology, 0, 0.0);
            assert_eq!(dense_signs, sparse_signs);
            let apart = |a: Vec3, b: Vec3| (a - b).norm();
            for b in 0..model.bodies.len() {
                assert!(apart(dense.pose[b].r, sparse.pose[b].r) < 1e-12 * size, "body {b} of {n}");
                assert!(apart(dense.v[b].v, sparse.v[b].v) < 1e-11 * size, "body {b} of {n}");
            }
            dispatch!(Level::new(), simd => {
                let (side_by_side, signs) = last(&model, &topology, 0, lanes(simd));
                assert_eq!(signs, sparse_signs);
                for b in 0..model.bodies.len() {
                    let r = side_by_side.pose[b].r;
                    let r = Vec3::new(r.x.lane(3), r.y.lane(3), r.z.lane(3));
                    assert!(apart(dense.pose[b].r, r) < 1e-12 * size, "body {b} of {n} in lanes");
                }
            });
        }
    }
}

//! The path between output times, followed in steps of its own.
//!
//! A step is as long as the nearest singular position allows ([`super::singularity`]), measured in what the drivers do
//! on the way and not in time: the range of each law over the step is known ([`crate::law::Law::over`]), so a law that
//! hurries, rests, turns round or pulses between two output times is followed all the same. The position is predicted
//! along the drivers, too, so kinks of laws need no care.

use crate::model::{Contact, DriverId};
use crate::space::Real;

use super::kinematics::PositionFailure;
use super::singularity::Workspace;
use super::stepper::{LOCKED, Lookahead, StepRejection, Stepper, TRUST, TRUST_FLOOR};
use super::turns::{FINEST, TURN_TRUST};
use super::{SingularPosition, Stop, StopKind};

/// Maximum step as a fraction of the estimated distance to the nearest singular position. The estimate is 0.94 to 2.17
/// times the true distance (`docs/theory.md`, section 4), so that no step passes it.
pub(super) const PART_OF_WAY: f64 = 0.4;
/// Maximum step as a fraction of the distance estimated at its far end: the step back would be 0.67 of it, and a near
/// singular position that symmetry hides from one end shows from the other.
const PART_FROM_FAR_END: f64 = 2.5 / (1.0 - PART_OF_WAY) * PART_OF_WAY;
/// Maximum travel of a driver in a step, rad or sizes of its loop: symmetry may hide a singular position entirely, and
/// in uniform rotation there is none.
const LONGEST: f64 = 1.0;
/// Maximum change of an unknown coordinate in a step; otherwise the turn of an angle is ambiguous.
const LONGEST_MOVE: f64 = 2.0;
/// Distance of a singular position, in rad or sizes of driver travel, at which the walk ends; round-off dominates
/// nearer to it.
const NEAREST: f64 = 1e-6;
/// Fraction of the distance to a singular position at which a law has reached it: the estimate of that distance, 2e-6
/// rad away, is accurate to about 1e-4 (`docs/theory.md`, section 4).
const REACHED: f64 = 0.99;
/// Maximum number of intervals for which the range of a law is computed, to find its first event.
const MOST_PARTS: usize = 2_000;
/// Minimum step, rad or sizes; if it is rejected, the path ends.
const SHORTEST: f64 = 1e-10;
/// Relative difference below which two times are equal; a law that changes between them jumps.
const ONE_TIME: f64 = 1e-14;
/// Fraction of the locking tolerance above which redundant constraints are also checked in the middle of a step.
const SUSPECT: f64 = 1e-2;
/// Power of the response below which a singular position is a limit: it is 1/2 at a limit, and 1 where two motions
/// meet.
const LIMIT: f64 = 0.75;
/// Maximum deviation of the power from 1/2 or 1 for which the kind of a singular position ahead is clear.
const CLEAR_POWER: f64 = 0.1;
/// Maximum number of steps during which no driver moves by a radian, or a size.
const MOST_STEPS: usize = 20_000;
/// Maximum travel of a driver between two output times, rad or sizes, so that a diverging law ends the run.
const FARTHEST: f64 = 1e5;
/// Maximum number of jumps of a law between two output times, since each jump is followed on its own.
const MOST_JUMPS: usize = 1_000;
/// Maximum number of jumps in a row: a law with more is faster than the resolution of times.
const MOST_IN_A_ROW: usize = 32;
/// A law has a pole if it is unbounded over this fraction of a walk, and has there this multiple of its values at the
/// ends.
const POLE: [f64; 2] = [1e-9, 1e3];

/// Difference between a contact and its prediction that is always accepted, in lengths between the points of the curve.
const CONTACT_FLOOR: f64 = 0.1;
/// Maximum bend of a curve over a step, rad: a groove that turns back within a step would be missed.
pub(super) const MOST_BEND: f64 = 0.4;

/// Path of the drivers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Path {
    /// From the design configuration, whose joints may be open, to the closed one, with all drivers at zero; the
    /// parameter runs from 0 to 1 and is the closed fraction of every gap.
    Assembly,
    /// All drivers straight from one value to another, [`Stepper::line`], at one time; the parameter runs from 0 to 1.
    /// It is used from the design configuration to the first output time, and over jumps of laws.
    Line {
        /// That time.
        at: f64,
    },
    /// Their laws, over time.
    Laws,
}

impl Path {
    /// Rate of the remaining fraction of every gap along the path.
    fn gap_rate(self) -> f64 {
        if self == Self::Assembly { -1.0 } else { 0.0 }
    }

    /// Travel of a direction over a step h, from the values of the drivers `before` to those `now`: that of the driver
    /// for a law, the step itself for a straight path.
    fn travel_of(self, direction: usize, h: f64, [before, now]: [&[[f64; 3]]; 2]) -> f64 {
        match self {
            Self::Laws => now[direction][0] - before[direction][0],
            Self::Assembly | Self::Line { .. } => h,
        }
    }
}

impl Stepper<'_> {
    /// Follows a path to where its parameter is `target`.
    pub(super) fn walk(&mut self, path: Path, target: f64) -> Result<(), Box<Stop>> {
        while self.time < target {
            let Err(stop) = self.walk_to(path, target) else { break };
            self.cross(path, stop)?;
        }
        // Returns to an output time that was passed while crossing a change point.
        self.stand_within_crossing(target).unwrap_or(Ok(()))
    }

    /// Follows a path up to its target or the first change point.
    fn walk_to(&mut self, path: Path, target: f64) -> Result<(), Box<Stop>> {
        let scale = f64::max(self.time.abs(), target.abs());
        let (mut steps, mut walked) = (0, 0.0);
        if self.ahead != Lookahead::Examined {
            self.stand(path).map_err(|r| self.stop(path, self.time, r, true))?;
            self.examine_here(path);
        }
        if path == Path::Laws {
            self.look_for_poles(target)?;
        }
        let mut far = 0.0;
        let (mut jumps, mut in_a_row) = (0, 0);
        while self.time < target {
            let rest = target - self.time;
            // The longest step with  sum over d of Du_d / rho_d <= 0.4  (22), Du_d the range of law d over [t, t + h]
            let mut h = self.stride(path, rest, ONE_TIME * scale);
            if path == Path::Laws && h <= ONE_TIME * scale && !(self.travelled() <= SHORTEST) {
                // A change of a law within the resolution of times is a jump, also at the end of the path.
                (jumps, in_a_row) = (jumps + 1, in_a_row + 1);
                far += self.travelled();
                if jumps > MOST_JUMPS || in_a_row > MOST_IN_A_ROW || !(far <= FARTHEST) {
                    return Err(self.stop(path, self.time, self.too_far(), true));
                }
                self.jump(if h < rest { self.time + h } else { target })?;
                continue;
            }
            in_a_row = 0;
            // The allowed travel, 0.4 of the distance, even if the step is shorter.
            let allowed = self.travelled() * PART_OF_WAY / self.around.part_of_way(&self.travel);
            // Below 1e-6 rad, or sizes, round-off dominates.
            if h < rest && allowed < NEAREST && self.is_singular_ahead(path) && self.reaches(path, target) {
                return Err(self.stop(path, self.time + h, StepRejection::TooNear, true));
            }
            loop {
                let last = h >= rest;
                let t = if last { target } else { self.time + h };
                match self.step_to(path, t, if last { rest } else { h }) {
                    Ok(()) => break,
                    Err(refusal) => {
                        // A step that Newton's method or the far end rejects may succeed in two halves.
                        h *= 0.5;
                        self.measure_travel(path, h);
                        steps += 1;
                        // At 1e-10 rad a step is round-off; `stop` determines the reason.
                        let too_short = self.travelled() < SHORTEST || h <= ONE_TIME * scale;
                        if too_short || steps > MOST_STEPS {
                            self.stand(path).map_err(|r| self.stop(path, t, r, true))?;
                            return Err(self.stop(path, t, refusal, true));
                        }
                    }
                }
            }
            (steps, walked) = (steps + 1, walked + self.travelled());
            far += self.travelled();
            if far > FARTHEST {
                return Err(self.stop(path, self.time, self.too_far(), true));
            } else if walked > LONGEST {
                (steps, walked) = (0, 0.0);
            } else if steps > MOST_STEPS {
                return Err(self.stop(path, self.time, StepRejection::TooNear, true));
            }
            if self.time < target {
                self.effort.substeps += 1;
            }
        }
        Ok(())
    }

    /// The driver that goes furthest.
    fn too_far(&self) -> StepRejection {
        let travel = |d: &usize| self.travel[*d] / self.driver_units[*d];
        let driver = (0..self.drivers.len()).max_by(|a, b| travel(a).total_cmp(&travel(b))).unwrap_or(0);
        StepRejection::TooFar { driver }
    }

    /// Ends the walk to an output time at once if a law has a pole on the way there.
    fn look_for_poles(&mut self, target: f64) -> Result<(), Box<Stop>> {
        let whole = target - self.time;
        for driver in 0..self.drivers.len() {
            let law = self.parts.law_of(driver);
            let bounded = |from: f64, to: f64| law.over(from, to).value.is_bounded();
            let (mut from, mut to) = (self.time, target);
            while !bounded(from, to) && to - from > POLE[0] * whole {
                let middle = 0.5 * (from + to);
                // Bisects towards the half without a bound by interval arithmetic. If the last interval is unbounded
                // and the law is large there, it is a pole, and not only a wide bound.
                (from, to) = if bounded(from, middle) { (middle, to) } else { (from, middle) };
            }
            if bounded(from, to) {
                continue;
            }
            let size = |t: f64| law.at(t).value().abs();
            let (near, usual) = (size(from).max(size(to)), size(self.time).max(size(target)));
            // NaN is a pole: the law is undefined there.
            if !(near <= POLE[1] * usual.max(self.driver_units[driver])) {
                return Err(self.stop(Path::Laws, to, StepRejection::Law { driver }, true));
            }
        }
        Ok(())
    }

    /// Solves the saved position again, so that factors and rates are available.
    fn stand(&mut self, path: Path) -> Result<(), StepRejection> {
        self.drive(path, self.time)?;
        self.restore();
        self.solve_within(f64::INFINITY)
    }

    /// Examines the distance of singular positions from the saved position, the position of the state.
    pub(super) fn examine_here(&mut self, path: Path) {
        self.examine(path);
        std::mem::swap(&mut self.around, &mut self.beyond);
        self.ahead = Lookahead::Examined;
    }

    /// Examines the distance of singular positions from the state: along each driver alone, or along the whole path if
    /// all move together.
    fn examine(&mut self, path: Path) {
        // On the laws' path one direction per driver, f_d' = 1: the distance does not depend on the speed of a driver.
        let Self { workspace, topology, parts, state, line, beyond, drivers, turns, .. } = self;
        let turns = turns.as_mut().filter(|_| path != Path::Assembly);
        let directions = if path == Path::Laws { drivers.len() } else { 1 };
        let workspace = workspace
            .get_or_insert_with(|| Box::new(Workspace::new(topology, state.pose.len(), drivers.len())));
        // df_d/du: 1 for the driver of the direction; f(1) - f(0) for all drivers on a line; 0 in an assembly, where
        // the gaps change
        let speed = |direction: usize, d: usize| match path {
            Path::Assembly => 0.0,
            Path::Line { .. } => line[d][1] - line[d][0],
            Path::Laws => {
                if d == direction {
                    1.0
                } else {
                    0.0
                }
            }
        };
        workspace.examine(topology, parts, state, path.gap_rate(), (directions, speed), turns, beyond);
    }

    /// Measures the maximum travel of each direction over a step h of the path.
    fn measure_travel(&mut self, path: Path, h: f64) {
        match path {
            Path::Assembly | Path::Line { .. } => self.travel[0] = h,
            Path::Laws => {
                for d in 0..self.drivers.len() {
                    let from = self.saved.drivers[d][0];
                    // Du_d = max over [t, t + h] of abs(f_d - f_d(t)), from above
                    self.travel[d] = self.parts.travel(d, self.time, self.time + h, from);
                }
            }
        }
        self.travel_unit = match path {
            // The parameter runs from 0 to 1; one unit of it corresponds to this travel, rad or sizes.
            Path::Assembly => self.state.largest_gap(&self.topology),
            Path::Line { .. } => {
                let of_driver = self.line.iter().zip(&self.driver_units);
                of_driver.map(|([from, to], unit)| (*to - *from).abs() / unit).fold(0.0, f64::max)
            }
            Path::Laws => 1.0,
        };
        self.on_laws = path == Path::Laws;
    }

    /// Measures the maximum travel of each direction over a stretch of a path, like
    /// [`measure_travel`](Self::measure_travel).
    pub(super) fn travel_over(&mut self, path: Path, from: f64, to: f64) {
        self.measure_travel(path, to - from);
        if path == Path::Laws {
            for d in 0..self.drivers.len() {
                let start = self.parts.law(d, from)[0];
                let travel = self.parts.travel(d, from, to, start);
                // A NaN travel counts as too far.
                self.travel[d] = if travel.is_nan() { f64::INFINITY } else { travel };
            }
        }
    }

    /// Parameter of the nearest singular position ahead of the saved one on a path.
    pub(super) fn nearest_ahead(&mut self, path: Path) -> Option<f64> {
        self.stand(path).ok()?;
        let ahead = self.ahead(path)?;
        (ahead.distance > 0.0).then_some(self.time + ahead.distance)
    }

    /// The largest travel measured last, rad or sizes.
    pub(super) fn travelled(&self) -> f64 {
        if !self.on_laws {
            return self.travel[0] * self.travel_unit;
        }
        self.travel.iter().zip(&self.driver_units).map(|(x, unit)| x / unit).fold(0.0, f64::max)
    }

    /// Longest step along a path, at most `rest`, that stays clear of singular positions, with its travel; `shortest`
    /// if there is none.
    fn stride(&mut self, path: Path, rest: f64, shortest: f64) -> f64 {
        let mut h = rest;
        loop {
            self.measure_travel(path, h);
            // sum Du_d / rho_d <= 0.4,    max over the unknowns of sum abs(q_d') Du_d <= 2,    Du_d <= 1
            let part = self.around.part_of_way(&self.travel) / PART_OF_WAY;
            let moved = self.around.move_of_fastest(&self.travel) / LONGEST_MOVE;
            let travelled = self.travelled();
            // max over the counted angles of sum abs(chi_d') Du_d <= 1
            let turned =
                if travelled > FINEST { self.around.turn_of_fastest(&self.travel) / TURN_TRUST } else { 0.0 };
            let much = part.max(moved).max(travelled / LONGEST).max(turned);
            if much <= 1.0 || h <= shortest {
                return h;
            }
            // If the travel is proportional to h, the first guess is right; ranges of laws over long steps may be
            // wider.
            h = (h * (0.95 / much).clamp(0.02, 0.9)).max(shortest);
        }
    }

    /// Takes a step h along a path, to t, if it is safe.
    fn step_to(&mut self, path: Path, t: f64, h: f64) -> Result<(), StepRejection> {
        // Redundant constraints that disagree in the middle of a step may agree again at its end.
        if self.saved.residual > SUSPECT * LOCKED && path == Path::Laws {
            self.solve_at(path, self.time + 0.5 * h, 0.5 * h)?;
        }
        self.measure_travel(path, h);
        let selections = self.selections;
        self.solve_at(path, t, h)?;
        self.examine(path);
        // sum Du_d / rho_d <= 1.67 with rho_d of the far end
        if selections == self.selections && !(self.beyond.part_of_way(&self.travel) <= PART_FROM_FAR_END) {
            return Err(StepRejection::TooNear);
        }
        if path != Path::Assembly && !self.follow_turns(path, h) {
            return Err(StepRejection::TooNear);
        }
        std::mem::swap(&mut self.around, &mut self.beyond);
        self.save(t, h);
        self.ahead = Lookahead::Examined;
        Ok(())
    }

    /// Counts angles over a step h to the present state; returns true if each is in the turn that is predicted along
    /// the drivers from both ends.
    fn follow_turns(&mut self, path: Path, h: f64) -> bool {
        let is_fine = self.travelled() <= FINEST;
        let Self { turns, around, beyond, drivers, saved, travel, state, .. } = self;
        let Some(turns) = turns else { return true };
        let directions = if path == Path::Laws { drivers.len() } else { 1 };
        let sure = turns.follow(state, |i| {
            let (mut ahead, mut back, mut far) = (0.0, 0.0, 0.0);
            for k in 0..directions {
                let du = path.travel_of(k, h, [&saved.drivers, drivers]);
                // chi_d' Du_d + chi_d'' Du_d^2 / 2 of this end,  chi_d' Du_d - chi_d'' Du_d^2 / 2 of the far one
                let half = 0.5 * du * du;
                let ([slope, bend], [slope_there, bend_there]) = (around.angles[k][i], beyond.angles[k][i]);
                ahead += slope * du + bend * half;
                back += slope_there * du - bend_there * half;
                far += (slope_there * travel[k]).abs();
            }
            [ahead, back, far]
        });
        if sure || is_fine {
            turns.accept();
        }
        sure || is_fine
    }

    /// Solves the position at t on a path, a step h beyond the saved one, from a prediction along the drivers.
    pub(super) fn solve_at(&mut self, path: Path, t: f64, h: f64) -> Result<(), StepRejection> {
        self.drive(path, t)?;
        let moved = self.predict_along(path, h);
        self.solve_within((TRUST * moved).max(TRUST_FLOOR))?;
        self.examine_contacts()?;
        self.examine_position()
    }

    /// Checks the distance between the contacts of curves and their prediction.
    fn examine_contacts(&self) -> Result<(), StepRejection> {
        for (c, k) in self.topology.contacts() {
            let ([predicted, moved], curve) = (self.touching[k], &self.parts.curves[k]);
            let (before, now) = (self.saved.contacts[k].u, self.state.contacts[k].u);
            // abs(u - predicted) <= max(half of the predicted move, a tenth of the length between two points of the
            // curve); NaN fails.
            let near = (now - predicted).abs() <= (TRUST * moved).max(CONTACT_FLOOR * curve.grain());
            if !(near && curve.bend(before, now) <= MOST_BEND)
                && let Some(block) = self.topology[c].block
            {
                return Err(StepRejection::Position(PositionFailure::NoConvergence { block }));
            }
        }
        Ok(())
    }

    /// Predicts the position for the present values of the drivers, `q + sum over the directions of q' du + q'' du^2 /
    /// 2`; returns the largest move, rad or sizes.
    pub(super) fn predict_along(&mut self, path: Path, h: f64) -> f64 {
        self.restore();
        let mut most = 0.0_f64;
        let directions = if path == Path::Laws { self.drivers.len() } else { 1 };
        let mut moves = std::mem::take(&mut self.predicted);
        moves.fill(0.0);
        for (touching, contact) in self.touching.iter_mut().zip(&self.state.contacts) {
            touching[0] = contact.u;
        }
        for k in 0..directions {
            let du = path.travel_of(k, h, [&self.saved.drivers, &self.drivers]);
            // q + sum over the drivers of (q_d' Du_d + q_d'' Du_d^2 / 2); mixed second derivatives are left to Newton's
            // method.
            let half = du * du * 0.5;
            let (slopes, bends) = (&self.around.slopes[k], &self.around.bends[k]);
            for (c, moved) in moves.iter_mut().enumerate() {
                *moved = bends[c].times_plus(half, slopes[c].times_plus(du, *moved));
            }
            for r in self.topology.coupler_terms() {
                let [slope, bend] = self.around.turning[k][r.0];
                self.state.near[r.0] += slope * du + bend * half;
            }
            // u + u' Du + u'' Du^2 / 2
            for ([u, _], [slope, bend]) in self.touching.iter_mut().zip(&self.around.sliding[k]) {
                *u += slope * du + bend * half;
            }
        }
        for (k, contact) in self.state.contacts.iter_mut().enumerate() {
            let [u, moved] = &mut self.touching[k];
            *moved = (*u - contact.u).abs();
            *contact = Contact::at(&self.parts.curves[k], *u);
        }
        for c in self.topology.unknown_coordinates() {
            self.state.q[c.0] += moves[c.0];
            most = most.max((moves[c.0] * self.topology[c].per_unit).abs());
        }
        self.predicted = moves;
        self.state.turn_balls(&self.topology, self.topology.link_ids());
        most
    }

    /// Moves the drivers over a jump of their laws, straight from their values before to those at t.
    fn jump(&mut self, t: f64) -> Result<(), Box<Stop>> {
        let before = self.time;
        for d in 0..self.line.len() {
            // From f(t-) to f(t+), at one time
            self.line[d] = [self.saved.drivers[d][0], self.parts.law(d, t)[0]];
        }
        let path = Path::Line { at: t };
        self.time = 0.0;
        let walked = self.attempt(path, 0.0).map_err(|r| self.stop(path, 0.0, r, false)).and_then(|()| {
            self.save(0.0, 0.0);
            self.walk(path, 1.0)
        });
        walked.map_err(|stop| Box::new(Stop { last_time: Some(before), failed_time: t, ..*stop }))?;
        self.time = t;
        self.attempt(Path::Laws, t).map_err(|r| self.stop(Path::Laws, t, r, true))?;
        self.save(t, 0.0);
        self.renew_turns();
        self.examine_here(Path::Laws);
        Ok(())
    }

    /// Singular position ahead on the path, seen from the saved position; the state must be there.
    fn ahead(&mut self, path: Path) -> Option<super::singularity::SingularityAhead> {
        let Self { workspace, topology, parts, state, drivers, .. } = self;
        let workspace = workspace.as_mut()?;
        workspace.ahead(topology, parts, state, path.gap_rate(), drivers)
    }

    /// Singular position that the motion would reach if it continued as at the last output time; `None` if none is near
    /// enough to be predicted.
    pub fn beyond(&mut self) -> Option<SingularPosition> {
        self.stand(Path::Laws).ok()?;
        let ahead = self.ahead(Path::Laws)?;
        // m of (23): 1/2 at a limit, 1 where two motions meet
        let limit = (ahead.power - 0.5).abs() < CLEAR_POWER;
        let meets = (ahead.power - 1.0).abs() < CLEAR_POWER;
        if !(ahead.distance > 0.0 && (limit || meets)) {
            return None;
        }
        let now = self.drivers.iter().map(|f| f[0]);
        let travel = now.enumerate().map(|(d, now)| {
            // f(t*) - f(t), t* = t + distance of (23)
            let then = self.parts.law_of(d).at(self.time + ahead.distance).value();
            // A law that is undefined there is extrapolated at its present speed.
            if then.is_finite() { then - now } else { self.drivers[d][1] * ahead.distance }
        });
        Some(SingularPosition {
            after: ahead.distance,
            travel: travel.collect(),
            kind: if limit { StopKind::Limit } else { StopKind::BranchChange },
            joints: self.topology.joints_of_block(ahead.block),
        })
    }

    /// True if the near singular position is ahead, not behind.
    fn is_singular_ahead(&mut self, path: Path) -> bool {
        if self.stand(path).is_err() {
            return true;
        }
        !self.ahead(path).is_some_and(|ahead| ahead.distance < 0.0)
    }

    /// Returns true if the laws reach the singular position ahead, before they move by the same distance in the
    /// opposite direction, up to `target`. If more than one driver moves there, they are assumed to reach it.
    fn reaches(&mut self, path: Path, target: f64) -> bool {
        let from = self.time;
        let moving = |d: &usize| !(self.parts.travel(*d, from, target, self.saved.drivers[*d][0]) <= 0.0);
        let mut movers = (0..self.drivers.len()).filter(moving);
        let (Path::Laws, Some(d), None) = (path, movers.next(), movers.next()) else { return true };
        // The distance as a travel of this driver, f' = 1
        let mut along = vec![[0.0; 3]; self.drivers.len()];
        along[d][1] = 1.0;
        let Self { workspace, topology, parts, state, .. } = self;
        let Some(workspace) = workspace.as_mut() else { return true };
        let Some(ahead) = workspace.ahead(topology, parts, state, 0.0, &along) else { return true };
        let law = parts.law_of(d);
        let (begin, side) = (law.at(from).value(), ahead.distance.signum());
        let distance = REACHED * ahead.distance.abs();
        // Intervals in the order of time, halved until the law stays within the distance or is beyond it.
        let (mut stretches, mut asked) = (vec![[from, target]], 0);
        while let Some([low, high]) = stretches.pop() {
            asked += 1;
            let range = law.over(low, high).value;
            if range.reach_from(begin) < distance {
                continue;
            }
            let middle = low + 0.5 * (high - low);
            if !(middle > low && middle < high) || asked > MOST_PARTS {
                // NaN reaches it.
                return !(side * (law.at(high).value() - begin) <= 0.0);
            }
            stretches.extend([[middle, high], [low, middle]]);
        }
        false
    }

    /// Reason why the path ends at the saved position; the step to t was rejected.
    pub(super) fn stop(&mut self, path: Path, t: f64, refusal: StepRejection, moved: bool) -> Box<Stop> {
        let mut failed = t;
        let (kind, block) = match refusal {
            StepRejection::Position(
                PositionFailure::Singular { block } | PositionFailure::NoConvergence { block },
            ) if !moved => (StopKind::Limit, Some(block)),
            StepRejection::Position(_) | StepRejection::Branch { .. } | StepRejection::TooNear => {
                let ahead = self.ahead(path);
                // The rejected step is short compared with the path.
                // (23) predicts a position only if its distance is comparable to the rejected step.
                let near = 1e3 * (t - self.time).abs().max(ONE_TIME * t.abs());
                match ahead.filter(|a| a.distance > 0.0 && a.distance <= near) {
                    Some(a) => {
                        // t* = t + m / (s'/s) of (23), m < 3/4 a limit
                        failed = self.time + a.distance;
                        let limit = a.power < LIMIT;
                        (if limit { StopKind::Limit } else { StopKind::BranchChange }, Some(a.block))
                    }
                    None => match refusal {
                        StepRejection::Position(
                            PositionFailure::Singular { block } | PositionFailure::NoConvergence { block },
                        ) => (StopKind::Limit, Some(block)),
                        StepRejection::Branch { block } => (StopKind::BranchChange, Some(block)),
                        _ => (StopKind::BranchChange, ahead.map(|a| a.block)),
                    },
                }
            }
            // Residual of a redundant row: the constraints agreed in the design configuration and do not agree here.
            StepRejection::Locked { row, residual } => {
                let closure = self.topology.closure_of(row);
                let quantity = self.topology.constraint(row).into();
                (StopKind::Locked { joint: closure.joint, residual, quantity }, closure.block)
            }
            StepRejection::Law { driver } => (StopKind::LawNotFinite { driver: DriverId(driver) }, None),
            StepRejection::TooFar { driver } => (StopKind::TooFar { driver: DriverId(driver) }, None),
        };
        let (last_time, failed_time) = match path {
            Path::Assembly => (None, 0.0),
            Path::Line { at } => (None, at),
            Path::Laws => (moved.then_some(self.time), failed),
        };
        Box::new(Stop {
            kind,
            last_time,
            failed_time,
            drivers: self.saved.drivers.iter().map(|f| f[0]).collect(),
            block,
            pivot_ratio: block.map_or(1.0, |b| self.saved.pivots[b.0].0),
            joints: block.map_or_else(Vec::new, |b| self.topology.joints_of_block(b)),
            remains: Vec::new(),
            closed: (path == Path::Assembly).then_some(self.time),
        })
    }
}

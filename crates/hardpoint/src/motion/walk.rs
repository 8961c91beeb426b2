//! The path between output times, followed in steps of its own.
//!
//! A step is as long as the nearest singular position allows ([`super::lookahead`]); one that is rejected is halved.

use super::Stop;
use super::change_point::{cross, stand_within_crossing};
use super::lookahead::{LONGEST, PART_OF_WAY};
use super::mechanism::{Mechanism, StepRejection};
use super::path::Path;
use super::path_step::PathStep;
use super::step::take;
use super::stepper::{ONE_TIME, Stepper};

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
/// Maximum number of steps during which no driver moves by a radian, or a size.
const MOST_STEPS: usize = 20_000;
/// Maximum travel of a driver between two output times, rad or sizes, so that a diverging law ends the run.
const FARTHEST: f64 = 1e5;
/// Maximum resolution of a line, rad or sizes.
const COARSEST: f64 = 1e-3;
/// Maximum number of jumps of a law between two output times, since each jump is followed on its own.
const MOST_JUMPS: usize = 1_000;
/// Maximum number of jumps in a row: a law with more is faster than the resolution of times.
const MOST_IN_A_ROW: usize = 32;
/// A law has a pole if it is unbounded over this fraction of a walk, and has there this multiple of its values at the
/// ends.
const POLE: [f64; 2] = [1e-9, 1e3];

/// Follows a path to where its parameter is `target`.
pub(super) fn walk(one: &mut Stepper<'_>, path: Path, target: f64) -> Result<(), Box<Stop>> {
    while one.mechanism.saved.time < target {
        let Err(stop) = Walk::new(one, path, target).follow() else { break };
        cross(one, path, stop)?;
    }
    // Returns to an output time that was passed while crossing a change point.
    stand_within_crossing(one, target).unwrap_or(Ok(()))
}

/// A walk along a path to its target, or to the first change point.
struct Walk<'s, 'm> {
    one: &'s mut Stepper<'m>,
    path: Path,
    target: f64,
    /// Shortest step: the resolution of the parameter.
    shortest: f64,
    /// Steps since a driver moved by a radian or a size, halvings included, and its travel over them.
    steps: usize,
    walked: f64,
    /// Travel of the whole walk.
    far: f64,
    /// Jumps of laws, and those in a row.
    jumps: usize,
    in_a_row: usize,
}

impl<'s, 'm> Walk<'s, 'm> {
    fn new(one: &'s mut Stepper<'m>, path: Path, target: f64) -> Self {
        let shortest = ONE_TIME * f64::max(one.mechanism.saved.time.abs(), target.abs());
        Self { one, path, target, shortest, steps: 0, walked: 0.0, far: 0.0, jumps: 0, in_a_row: 0 }
    }

    /// Follows the path.
    fn follow(mut self) -> Result<(), Box<Stop>> {
        self.look_around()?;
        while self.rest() > 0.0 {
            let h = self.longest_step();
            if self.is_jump(h) {
                self.jump(h)?;
            } else {
                self.check_singular_ahead(h)?;
                self.step_or_shorten(h)?;
                self.count()?;
            }
        }
        Ok(())
    }

    fn now(&self) -> f64 {
        self.one.mechanism.saved.time
    }

    fn rest(&self) -> f64 {
        self.target - self.now()
    }

    fn travelled(&self) -> f64 {
        self.one.travelled(self.path)
    }

    fn stop(&mut self, t: f64, rejection: StepRejection) -> Box<Stop> {
        self.one.stop(self.path, t, rejection, true)
    }

    /// Solves and examines the position at which the walk starts, and looks for poles of the laws up to its target.
    fn look_around(&mut self) -> Result<(), Box<Stop>> {
        if !self.one.lookahead.is_known {
            self.one.stand(self.path).map_err(|r| self.stop(self.now(), r))?;
            self.one.examine(self.path);
        }
        match self.path {
            Path::Laws => self.look_for_poles(),
            // The parameter of a line has no values for steps of the length that its start requires.
            Path::Line { .. } if !(self.shortest * self.one.mechanism.unit_of(self.path) <= COARSEST) => {
                Err(self.too_far())
            }
            Path::Assembly | Path::Line { .. } => Ok(()),
        }
    }

    /// Longest step with  sum over d of Du_d / rho_d <= 0.4  (22), Du_d the range of law d over [t, t + h].
    fn longest_step(&mut self) -> f64 {
        let (mechanism, limits) = (&self.one.mechanism, [self.shortest, self.rest()]);
        self.one.lookahead.longest_step(mechanism, self.path, limits)
    }

    /// True if laws change within the resolution of times: a jump, also at the end of the path.
    fn is_jump(&self, h: f64) -> bool {
        self.path == Path::Laws && h <= self.shortest && !(self.travelled() <= SHORTEST)
    }

    /// Moves the drivers over a jump of their laws, straight from their values before to those at its end.
    fn jump(&mut self, h: f64) -> Result<(), Box<Stop>> {
        (self.jumps, self.in_a_row) = (self.jumps + 1, self.in_a_row + 1);
        self.far += self.travelled();
        if self.jumps > MOST_JUMPS || self.in_a_row > MOST_IN_A_ROW || !(self.far <= FARTHEST) {
            return Err(self.too_far());
        }
        let before = self.now();
        let t = if h < self.rest() { before + h } else { self.target };
        let Mechanism { line, saved, parts, .. } = &mut self.one.mechanism;
        for (d, line) in line.iter_mut().enumerate() {
            // From f(t-) to f(t+), at one time
            *line = [saved.drivers[d][0], parts.law(d, t)[0]];
        }
        let path = Path::Line { at: t };
        let walked = self.one.start_on(path, 0.0, false).and_then(|()| walk(self.one, path, 1.0));
        walked.map_err(|stop| Box::new(Stop { last_time: Some(before), failed_time: t, ..*stop }))?;
        self.one.start_on_laws(t, true)
    }

    /// Ends the walk if a singular position is so near that round-off dominates, and the path reaches it.
    fn check_singular_ahead(&mut self, h: f64) -> Result<(), Box<Stop>> {
        // The allowed travel, 0.4 of the distance, even if the step is shorter.
        let allowed = self.travelled() * PART_OF_WAY / self.one.lookahead.part_of_way();
        // Below 1e-6 rad, or sizes, round-off dominates.
        if h < self.rest() && allowed < NEAREST && self.is_singular_ahead() && self.reaches() {
            return Err(self.stop(self.now() + h, StepRejection::TooNear));
        }
        Ok(())
    }

    /// Takes a step h, or the largest of its halves, quarters ... that is accepted.
    fn step_or_shorten(&mut self, mut h: f64) -> Result<(), Box<Stop>> {
        loop {
            let rest = self.rest();
            let (t, length) = if h >= rest { (self.target, rest) } else { (self.now() + h, h) };
            let Err(rejection) = take(PathStep::new(self.one, self.path, t, length)) else { return Ok(()) };
            // A step that Newton's method or the far end rejects may succeed in two halves.
            h *= 0.5;
            self.one.lookahead.measure_travel(&self.one.mechanism, self.path, h);
            self.steps += 1;
            // At 1e-10 rad a step is round-off; `stop` determines the reason.
            if self.travelled() < SHORTEST || h <= self.shortest || self.steps > MOST_STEPS {
                self.one.stand(self.path).map_err(|r| self.stop(t, r))?;
                return Err(self.stop(t, rejection));
            }
        }
    }

    /// Counts a step, and ends a walk that is too far or does not move.
    fn count(&mut self) -> Result<(), Box<Stop>> {
        let travelled = self.travelled();
        (self.steps, self.walked, self.in_a_row) = (self.steps + 1, self.walked + travelled, 0);
        self.far += travelled;
        if self.far > FARTHEST {
            return Err(self.too_far());
        } else if self.walked > LONGEST {
            (self.steps, self.walked) = (0, 0.0);
        } else if self.steps > MOST_STEPS {
            return Err(self.stop(self.now(), StepRejection::TooNear));
        }
        self.one.effort.substeps += usize::from(self.rest() > 0.0);
        Ok(())
    }

    /// Stop for the driver that goes furthest.
    fn too_far(&mut self) -> Box<Stop> {
        let Stepper { mechanism, lookahead, .. } = &*self.one;
        let of_driver = |d: usize| match self.path {
            // One parameter moves all drivers.
            Path::Assembly | Path::Line { .. } => mechanism.speed_along(self.path, 0, d).abs(),
            Path::Laws => lookahead.travel[d],
        };
        let travel = |d: &usize| of_driver(*d) / mechanism.driver_units[*d];
        let furthest = (0..mechanism.drivers.len()).max_by(|a, b| travel(a).total_cmp(&travel(b)));
        self.stop(self.now(), StepRejection::TooFar { driver: furthest.unwrap_or(0) })
    }

    /// True if the near singular position is ahead, not behind.
    fn is_singular_ahead(&mut self) -> bool {
        if self.one.stand(self.path).is_err() {
            return true;
        }
        let Stepper { mechanism, lookahead, .. } = &mut *self.one;
        !lookahead.singularity(mechanism, self.path, None).is_some_and(|ahead| ahead.distance < 0.0)
    }

    /// Ends the walk to an output time at once if a law has a pole on the way there.
    fn look_for_poles(&mut self) -> Result<(), Box<Stop>> {
        let (start, target, whole) = (self.now(), self.target, self.rest());
        for driver in 0..self.one.mechanism.drivers.len() {
            let Mechanism { parts, driver_units, .. } = &self.one.mechanism;
            let law = parts.law_of(driver);
            let bounded = |from: f64, to: f64| law.is_bounded(from, to);
            let (mut from, mut to) = (start, target);
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
            let (near, usual) = (size(from).max(size(to)), size(start).max(size(target)));
            // NaN is a pole: the law is undefined there.
            if !(near <= POLE[1] * usual.max(driver_units[driver])) {
                return Err(self.stop(to, StepRejection::Law { driver }));
            }
        }
        Ok(())
    }

    /// Returns true if the laws reach the singular position ahead, before they move by the same distance in the
    /// opposite direction. If more than one driver moves there, they are assumed to reach it.
    fn reaches(&mut self) -> bool {
        let (from, target) = (self.now(), self.target);
        let Stepper { mechanism, lookahead, .. } = &mut *self.one;
        let Mechanism { parts, saved, drivers, .. } = &*mechanism;
        let moving = |d: &usize| !(parts.travel(*d, from, target, saved.drivers[*d][0]) <= 0.0);
        let mut movers = (0..drivers.len()).filter(moving);
        let (Path::Laws, Some(d), None) = (self.path, movers.next(), movers.next()) else { return true };
        let Some(ahead) = lookahead.singularity(mechanism, self.path, Some(d)) else { return true };
        let law = mechanism.parts.law_of(d);
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
}

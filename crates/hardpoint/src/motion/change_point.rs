//! Crossing of a change point: the position in which two motions meet, such as a parallelogram with all bars in line.
//!
//! J is singular there, and both motions continue smoothly. With [`ChangePointPolicy::Continue`] the solver follows the
//! one that continues the path: from a position b before the change point, a position f behind it is predicted by q'
//! and q'', and accepted if its own q' agrees with the prediction. Positions between b and f are predicted by the
//! polynomials through both ends. At the change point itself position, velocity and acceleration are those of the
//! polynomials, and everything that is solved with J is NaN.

use crate::linalg::{hermite, segment_at};
use crate::model::ChangePointPolicy;
use crate::topology::BlockId;

use super::predictor::Channel;
use super::stepper::{AcceptedPosition, Lookahead, StepRejection, Stepper};
use super::walk::Path;
use super::{Stop, StopKind};

/// Half the length of the crossing, rad or sizes of driver travel: short enough that the predicted position is nearer
/// to its own motion than to the other, long enough that accelerations keep ten digits.
const REACH: f64 = 1e-2;
/// Maximum number of bisections of a stretch.
const HALVINGS: usize = 60;
/// Relative tolerance of the slopes q' behind the change point, compared with the predicted ones; on the other motion
/// the difference is 100 %.
const SAME_MOTION: f64 = 0.05;
/// Output times nearer to the change point than this fraction of the stretch use the polynomials, because solutions
/// lose more digits there.
const AT_IT: f64 = 0.2;

/// Minimum length of the first step back from the change point, as a fraction of the stretch.
const SHORTEST_BACK: f64 = 1e-6;

/// A stretch around a change point.
#[derive(Clone)]
pub(super) struct Crossing {
    /// First and last time of the stretch, and time of the change point.
    times: [f64; 2],
    at: f64,
    /// Path on which it was crossed.
    path: Path,
    /// The blocks that are singular there.
    blocks: Vec<BlockId>,
    /// Positions at both ends, and per channel their values and derivatives.
    ends: [AcceptedPosition; 2],
    values: [Vec<[f64; 3]>; 2],
}

impl Stepper<'_> {
    /// Crosses the change point that stopped the walk, if the model requests it and the motion continues smoothly; the
    /// stepper is behind it then. Otherwise returns the stop.
    pub(super) fn cross(&mut self, path: Path, stop: Box<Stop>) -> Result<(), Box<Stop>> {
        let asked = self.model.at_change_points == ChangePointPolicy::Continue && path != Path::Assembly;
        let (StopKind::BranchChange, true, Some(block)) = (stop.kind, asked, stop.block) else {
            return Err(stop);
        };
        let here = (self.saved.clone(), self.time, self.branch.clone());
        // On a straight path all positions have the same time; the parameter is that of the last position.
        let at =
            if path == Path::Laws { stop.failed_time } else { self.nearest_ahead(path).unwrap_or(self.time) };
        match self.cross_at(path, at, block) {
            Some(crossing) => {
                self.crossing = Some(Box::new(crossing));
                Ok(())
            }
            None => {
                (self.saved, self.time, self.branch) = here;
                self.ahead = Lookahead::Unknown;
                Err(stop)
            }
        }
    }

    fn cross_at(&mut self, path: Path, at: f64, block: BlockId) -> Option<Crossing> {
        let start = if path == Path::Laws { self.model.times[0] } else { 0.0 };
        let mut h = f64::max(at - self.time, 1e-3 * at.abs().max(1e-3)) * 1024.0;
        for _ in 0..HALVINGS {
            self.travel_over(path, at - h, at + h);
            if self.travelled() <= 2.0 * REACH && at - h >= start {
                break;
            }
            h *= 0.5;
        }
        let [from, to] = [at - h, at + h];
        if !(from < at && at < to) {
            return None;
        }
        // Back to b, then over to f. At a distance d, q' is known to round-off / d^2 and q'' to round-off / d^3: steps
        // double d.
        while self.time != from {
            let distance = f64::max(at - self.time, SHORTEST_BACK * h);
            let next = if distance < h { f64::max(from, self.time - distance) } else { from };
            self.solve_at(path, next, next - self.time).ok()?;
            self.polish().ok()?;
            self.save(next, 0.0);
            self.examine_here(path);
        }
        // The drivers move by a hundredth of a radian: an angle is in the nearest turn.
        self.renew_turns();
        self.examine_here(path);
        let before = self.end_of_stretch();
        let was = self.around.clone();
        self.drive(path, to).ok()?;
        let travel: Vec<f64> =
            self.drivers.iter().zip(&before.0.drivers).map(|(now, before)| now[0] - before[0]).collect();
        self.predict_along(path, 2.0 * h);
        self.solve_within(REACH).ok()?;
        self.polish().ok()?;
        let signs: Vec<bool> = self.branch.iter().map(|b| b.0).collect();
        for (b, branch) in self.branch.iter_mut().enumerate() {
            branch.0 = self.state.pivots[b].1;
        }
        // The determinants that change sign are zero at the change point; several loops may be in line at once.
        let mut blocks: Vec<BlockId> = self.topology.block_ids().collect();
        blocks.retain(|b| *b == block || signs[b.0] != self.branch[b.0].0);
        let selections = self.selections;
        if self.examine_position().is_err() || self.selections != selections {
            return None;
        }
        self.save(to, 0.0);
        self.renew_turns();
        self.examine_here(path);
        let directions = if path == Path::Laws { travel.len() } else { 1 };
        for d in 0..directions {
            let (travel, unit) = match path {
                Path::Laws => (travel[d], self.driver_units[d]),
                Path::Assembly | Path::Line { .. } => (2.0 * h, 1.0 / self.travel_unit),
            };
            let (mut fastest, mut difference) = (1.0_f64, 0.0_f64);
            for c in self.topology.unknown_coordinates() {
                let per_unit = self.topology[c].per_unit * unit;
                // q'_f against q'_b + sum of q''_b Du, of each driver alone
                let predicted = was.slopes[d][c.0] + was.bends[d][c.0] * travel;
                fastest = fastest.max(predicted.abs() * per_unit);
                difference = difference.max((self.around.slopes[d][c.0] - predicted).abs() * per_unit);
            }
            if !(difference <= SAME_MOTION * fastest) {
                return None;
            }
        }
        let after = self.end_of_stretch();
        let (ends, values) = ([before.0, after.0], [before.1, after.1]);
        Some(Crossing { times: [from, to], at, path, blocks, ends, values })
    }

    /// Solves the current position again: near a singular position the remainder of Newton's method, a square, is
    /// magnified.
    fn polish(&mut self) -> Result<(), StepRejection> {
        self.solve_within(f64::INFINITY)
    }

    fn end_of_stretch(&self) -> (AcceptedPosition, Vec<[f64; 3]>) {
        let channels = Channel::all(&self.topology);
        (self.saved.clone(), channels.iter().map(|c| c.of(&self.state)).collect())
    }

    /// Moves to an output time within the stretch that was crossed last, if it is there.
    pub(super) fn stand_within_crossing(&mut self, t: f64) -> Option<Result<(), Box<Stop>>> {
        let crossing = self.crossing.take()?;
        if !(t < crossing.times[1]) {
            return None;
        }
        let stood = self.stand_between(&crossing, t);
        // The walk goes on from behind it.
        self.saved.clone_from(&crossing.ends[1]);
        self.time = crossing.times[1];
        self.ahead = Lookahead::Unknown;
        self.forecast.forget();
        self.crossing = Some(crossing);
        let path = self.crossing.as_ref().map_or(Path::Laws, |c| c.path);
        Some(stood.map_err(|refusal| self.stop(path, t, refusal, true)))
    }

    fn stand_between(&mut self, crossing: &Crossing, t: f64) -> Result<(), StepRejection> {
        let [from, to] = crossing.times;
        self.drive(crossing.path, t)?;
        let h = to - from;
        let s = (t - from) / h;
        self.state.contacts.copy_from_slice(&crossing.ends[usize::from(s > 0.5)].contacts);
        let channels = Channel::all(&self.topology);
        for (k, channel) in channels.iter().enumerate() {
            let [a, b] = [crossing.values[0][k], crossing.values[1][k]];
            channel.put(between([a, b], h, s)[0], &mut self.state);
        }
        for r in self.topology.coupler_terms() {
            let [a, b] = [crossing.ends[0].coupled[r.0], crossing.ends[1].coupled[r.0]];
            self.state.near[r.0] = between([a, b], h, s)[0];
        }
        if (t - crossing.at).abs() > AT_IT * h {
            self.solve_within(f64::INFINITY)?;
            self.polish()?;
            self.residuals = self.state.residuals(&self.topology, &self.parts, &self.drivers);
            self.renew_turns();
            return Ok(());
        }
        for c in self.topology.unknown_coordinates() {
            let of = |end: &AcceptedPosition| [end.qd[c.0], end.qdd[c.0]];
            let [speed, acceleration, _] = between(crossing.ends.each_ref().map(of), h, s);
            self.state.motion.speeds[0][c.0] = speed;
            self.state.motion.speeds[1][c.0] = acceleration;
        }
        for (k, channel) in channels.iter().enumerate() {
            // Polynomials of degree five are more accurate; ball joints have none, since their speeds are not rates of
            // components.
            if let Channel::Coordinate(c) = channel {
                let [a, b] = [crossing.values[0][k], crossing.values[1][k]];
                let [_, speed, acceleration] = between([a, b], h, s);
                self.state.motion.speeds[0][c.0] = speed;
                self.state.motion.speeds[1][c.0] = acceleration;
            }
        }
        self.state.stand_with_rates(&self.topology, &self.parts, &self.drivers, &crossing.blocks);
        self.renew_turns();
        self.at_change_point = true;
        Ok(())
    }
}

/// Value and first two derivatives, at the fraction s of a stretch h, of the polynomial through the value and N - 1
/// derivatives at both ends.
fn between<const N: usize>(ends: [[f64; N]; 2], h: f64, s: f64) -> [f64; 3] {
    segment_at(&hermite(h, N - 1, |end, order| ends[end][order]), s * h)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_their_degree_are_reproduced() {
        let p = |t: f64| [t.powi(5) - 2.0 * t * t, 5.0 * t.powi(4) - 4.0 * t, 20.0 * t.powi(3) - 4.0];
        let q = |t: f64| [t.powi(3) - t, 3.0 * t * t - 1.0, 6.0 * t];
        for s in [0.0, 0.3, 0.5, 1.0] {
            let t = 0.4 + 0.7 * s;
            let found = between([p(0.4), p(1.1)], 0.7, s);
            assert!((0..3).all(|n| (found[n] - p(t)[n]).abs() < 1e-12), "{found:?}");
            let found = between([q(0.4), q(1.1)].map(|[value, first, _]| [value, first]), 0.7, s);
            assert!((found[0] - q(t)[0]).abs() < 1e-14 && (found[1] - q(t)[1]).abs() < 1e-13);
        }
    }
}

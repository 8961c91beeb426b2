//! Crossing of a change point: the position in which two motions meet, such as a parallelogram with all bars in line.
//!
//! J is singular there, and both motions continue smoothly. With [`ChangePointPolicy::Continue`] the solver follows the
//! one that continues the path: from a position b before the change point, a position f behind it is predicted by q'
//! and q'', and accepted if its own q' agrees with the prediction. The motion between b and f is that of [`Crossing`].

use crate::model::ChangePointPolicy;
use crate::topology::BlockId;

use super::crossing::{Crossing, End};
use super::path::Path;
use super::path_step::PathStep;
use super::stepper::Stepper;
use super::{Stop, StopKind};

/// Half the length of the crossing, rad or sizes of driver travel: short enough that the predicted position is nearer
/// to its own motion than to the other, long enough that accelerations keep ten digits.
const REACH: f64 = 1e-2;
/// Maximum number of bisections of a stretch.
const HALVINGS: usize = 60;
/// Relative tolerance of the slopes q' behind the change point, compared with the predicted ones; on the other motion
/// the difference is 100 %.
const SAME_MOTION: f64 = 0.05;
/// Minimum length of the first step back from the change point, as a fraction of the stretch.
const SHORTEST_BACK: f64 = 1e-6;

/// Crosses the change point that stopped a walk, if the model requests it and the motion continues smoothly; the
/// stepper is behind it then. Otherwise returns the stop.
pub(super) fn cross(one: &mut Stepper<'_>, path: Path, stop: Box<Stop>) -> Result<(), Box<Stop>> {
    let asked = one.mechanism.model.at_change_points == ChangePointPolicy::Continue && path != Path::Assembly;
    let (StopKind::BranchChange, true, Some(block)) = (stop.kind, asked, stop.block) else {
        return Err(stop);
    };
    let here = (one.mechanism.saved.clone(), one.mechanism.branch.clone());
    // On a straight path all positions have the same time; the parameter is that of the last position.
    let at = match path {
        Path::Laws => stop.failed_time,
        Path::Assembly | Path::Line { .. } => nearest_ahead(one, path).unwrap_or(here.0.time),
    };
    match cross_at(one, path, at, block) {
        Some(crossing) => {
            one.crossing = Some(Box::new(crossing));
            Ok(())
        }
        None => {
            (one.mechanism.saved, one.mechanism.branch) = here;
            one.lookahead.is_known = false;
            Err(stop)
        }
    }
}

/// Parameter of the nearest singular position ahead of the saved one on a path.
fn nearest_ahead(one: &mut Stepper<'_>, path: Path) -> Option<f64> {
    one.stand(path).ok()?;
    let ahead = one.lookahead.singularity(&mut one.mechanism, path, None)?;
    (ahead.distance > 0.0).then_some(one.mechanism.saved.time + ahead.distance)
}

fn cross_at(one: &mut Stepper<'_>, path: Path, at: f64, block: BlockId) -> Option<Crossing> {
    let h = reach(one, path, at)?;
    let [from, to] = [at - h, at + h];
    // Back to b, then over to f. At a distance d, q' is known to round-off / d^2 and q'' to round-off / d^3: steps
    // double d.
    while one.mechanism.saved.time != from {
        let now = one.mechanism.saved.time;
        let distance = f64::max(at - now, SHORTEST_BACK * h);
        let next = if distance < h { f64::max(from, now - distance) } else { from };
        PathStep::new(one, path, next, next - now).solve().ok()?;
        one.mechanism.polish().ok()?;
        one.start_at(next);
        one.examine(path);
    }
    // The drivers move by a hundredth of a radian: an angle is in the nearest turn.
    one.renew_turns();
    one.examine(path);
    let before = End::of(&one.mechanism);
    let was = one.lookahead.around().clone();
    let Stepper { mechanism, lookahead, .. } = &mut *one;
    mechanism.drive(path, to).ok()?;
    let drivers = mechanism.drivers.iter().zip(&before.position.drivers);
    let travel: Vec<f64> = drivers.map(|(now, before)| now[0] - before[0]).collect();
    lookahead.predict(mechanism, path, 2.0 * h);
    mechanism.solve_within(REACH).ok()?;
    mechanism.polish().ok()?;
    // The determinants that change sign are zero at the change point; several loops may be in line at once.
    let mut blocks = Vec::new();
    for (b, &(_, positive)) in BlockId::each(&mechanism.state.pivots) {
        let was = std::mem::replace(&mut mechanism.branch[b.0].positive, positive);
        if b == block || was != positive {
            blocks.push(b);
        }
    }
    let selections = mechanism.selections;
    if mechanism.examine_position().is_err() || mechanism.selections != selections {
        return None;
    }
    one.start_at(to);
    one.renew_turns();
    one.examine(path);
    let Stepper { mechanism, lookahead, .. } = &*one;
    for d in 0..path.directions(travel.len()) {
        let (travel, unit) = match path {
            Path::Laws => (travel[d], mechanism.driver_units[d]),
            Path::Assembly | Path::Line { .. } => (2.0 * h, 1.0 / mechanism.unit_of(path)),
        };
        let (mut fastest, mut difference) = (1.0_f64, 0.0_f64);
        for c in mechanism.topology.unknown_coordinates() {
            let per_unit = mechanism.topology[c].per_unit * unit;
            // q'_f against q'_b + sum of q''_b Du, of each driver alone
            let predicted = was.slopes[d][c.0] + was.bends[d][c.0] * travel;
            fastest = fastest.max(predicted.abs() * per_unit);
            difference = difference.max((lookahead.around().slopes[d][c.0] - predicted).abs() * per_unit);
        }
        if !(difference <= SAME_MOTION * fastest) {
            return None;
        }
    }
    Some(Crossing { at, path, blocks, ends: [before, End::of(mechanism)] })
}

/// Half the length of the stretch around a change point: about a hundredth of a radian of driver travel.
fn reach(one: &mut Stepper<'_>, path: Path, at: f64) -> Option<f64> {
    let start = if path == Path::Laws { one.mechanism.model.times[0] } else { 0.0 };
    let mut h = f64::max(at - one.mechanism.saved.time, 1e-3 * at.abs().max(1e-3)) * 1024.0;
    for _ in 0..HALVINGS {
        one.lookahead.measure_stretch(&one.mechanism, path, at - h, at + h);
        if one.travelled(path) <= 2.0 * REACH && at - h >= start {
            break;
        }
        h *= 0.5;
    }
    (at - h < at && at < at + h).then_some(h)
}

/// Moves to an output time within the stretch that was crossed last, if it is there.
pub(super) fn stand_within_crossing(one: &mut Stepper<'_>, t: f64) -> Option<Result<(), Box<Stop>>> {
    let crossing = one.crossing.take()?;
    if !(t < crossing.to()) {
        return None;
    }
    let stood = crossing.stand(&mut one.mechanism, t).map(|at_change_point| {
        one.renew_turns();
        one.at_change_point |= at_change_point;
    });
    // The walk goes on from behind it.
    one.mechanism.saved.clone_from(&crossing.ends[1].position);
    one.forget();
    let path = crossing.path;
    one.crossing = Some(crossing);
    Some(stood.map_err(|rejection| one.stop(path, t, rejection, true)))
}

//! Places of pins in their holes under the loads of the nominal motion.
//!
//! A pin lies on the side to which the force pushes it: with F the force on body j and c the play, the marker of
//! body j is off by `c F / abs(F)`, the part of F perpendicular to the axis for a pin.

use std::ops::ControlFlow;

use hardpoint::joint::Quantity;
use hardpoint::load::Loads;
use hardpoint::model::{Change, Dimension, JointId, Model, VariableId};
use hardpoint::space::Vec3;

use super::data::StudyData;
use super::deviations::{Block, Deviations};

/// Forces below this fraction of the largest one of the model push a pin to no side: round-off of reactions.
const NO_FORCE: f64 = 1e-9;
/// A force that turns by more than a right angle between two output times has vanished between them if it falls below
/// this fraction of its larger value there: a turn that fast is a jump of the pin.
const VANISHES: f64 = 1e-3;
/// Maximum number of times that the force is solved for between two output times. Each second one halves the interval:
/// a force that jumps to the other side is located to a thousandth of it.
const MOST_TRIALS: usize = 20;

/// Pin that changes its side in the hole.
#[derive(Clone, Debug, PartialEq)]
pub struct SideChange {
    /// Joint with the play.
    pub joint: JointId,
    /// Index of the motion among those studied.
    pub motion: usize,
    /// Times, s, at which the force reverses.
    pub times: Vec<f64>,
}

/// Directions of the pins of a motion.
pub(super) struct Pins {
    /// Per block of the deviations, if it is the play of a joint, and output time: unit vector along the block's
    /// variables; `None` where no force is known.
    directions: Vec<Option<Vec<Option<Vec<f64>>>>>,
    pub changes: Vec<SideChange>,
}

impl Pins {
    /// Places in the motions of a study, for joints with play whose forces are known; `None` if there are none.
    pub fn of(study: &StudyData<'_>, motion: usize) -> Option<Self> {
        let StudyData { settings, deviations, .. } = *study;
        let analysis = &study.motions.analyses()[motion];
        let model = analysis.model();
        if !model.has_loads() || settings.tolerances.iter().all(|t| t.play.is_none()) {
            return None;
        }
        let loads = analysis.loads(&[]);
        let joints = model.joints.len();
        let no_force = NO_FORCE * largest_force(model, &loads);
        let mut pins = Self { directions: Vec::new(), changes: Vec::new() };
        for block in &deviations.blocks {
            let tolerance = &settings.tolerances[block.tolerance];
            let along: Vec<Vec3> = deviations.variables[block.range()]
                .iter()
                .filter_map(|v| offset(model, v.variable))
                .collect();
            let Some(joint) = tolerance.play.filter(|_| along.len() == block.len) else {
                pins.directions.push(None);
                continue;
            };
            let forces_of = |loads: &Loads| -> Vec<PinForce> {
                (0..loads.times.len()).map(|k| force(loads, k * joints + joint.0, &along)).collect()
            };
            let forces = forces_of(&loads);
            let unit = |f: &PinForce| {
                let f = f.as_ref()?;
                let size = size(f);
                (size > no_force).then(|| f.iter().map(|x| x / size).collect::<Vec<f64>>())
            };
            let directions: Vec<Option<Vec<f64>>> = forces.iter().map(unit).collect();
            let between = |times: &[f64]| {
                let all = loads.times.iter().take(1).chain(times).copied().collect();
                let forces = forces_of(&analysis.without_metrics(all).loads(&[]));
                (0..times.len()).map(|k| forces.get(k + 1)?.clone()).collect()
            };
            let times = reversals(&loads.times, &forces, &directions, &between);
            if !times.is_empty() {
                pins.changes.push(SideChange { joint, motion, times });
            }
            pins.directions.push(Some(directions));
        }
        Some(pins)
    }

    /// Change of an output with these derivatives at output time k, if every pin lies where the loads press it; `None`
    /// if that is not known of a pin that the output depends on.
    pub fn shift(&self, deviations: &Deviations, k: usize, g: &[f64]) -> Option<f64> {
        let of_block = |(block, directions): (&Block, &Option<Vec<Option<Vec<f64>>>>)| {
            let g = &g[block.range()];
            let Some(directions) = directions.as_ref().filter(|_| g.iter().any(|g| *g != 0.0)) else {
                return Some(0.0);
            };
            let direction = directions.get(k)?.as_ref()?;
            Some(block.reach * g.iter().zip(direction).map(|(g, n)| g * n).sum::<f64>())
        };
        deviations.blocks.iter().zip(&self.directions).map(of_block).sum()
    }
}

/// Direction along which a variable moves marker j of a joint in the design configuration.
fn offset(model: &Model, variable: VariableId) -> Option<Vec3> {
    match &model.variables[variable.0].changes[..] {
        [Change::Marker(change)] => Some(change.position),
        _ => None,
    }
}

/// Force on body j along these directions, which turn with it; `None` if a component is not determined.
fn force(loads: &Loads, place: usize, along: &[Vec3]) -> PinForce {
    let load = loads.joints.get(place)?;
    let ([force, _], [known, _]) = (load.in_body, load.known_in_body);
    let determined = |n: &Vec3| (0..3).all(|axis| known[axis] || n[axis].abs() < 1e-12);
    along.iter().map(|n| determined(n).then(|| force.dot(*n))).collect()
}

/// Largest force of a model over its motion: weight, and those of joints, drivers and applied loads. A moment counts as
/// a force at the distance of the mechanism's size.
fn largest_force(model: &Model, loads: &Loads) -> f64 {
    let arm = model.size();
    let of_joints = loads.joints.iter().flat_map(|joint| [joint.force.norm(), joint.moment.norm() / arm]);
    let driver_arms: Vec<f64> = model
        .drivers
        .iter()
        .map(|driver| match model.driven(driver).quantity {
            Quantity::Angle => arm,
            Quantity::Length | Quantity::Number => 1.0,
        })
        .collect();
    let of_drivers = loads.drivers.iter().zip(driver_arms.iter().cycle()).map(|(d, arm)| d.force.abs() / arm);
    let of_points = loads.pushes.iter().map(|push| push.norm());
    let given = model.given_forces();
    let is_moment = given.iter().map(|element| {
        let force = model.elements[element.0].kind.force(model);
        force.is_some_and(|force| force.dimension == Dimension::MOMENT)
    });
    let given_arms: Vec<f64> = is_moment.map(|is_moment| if is_moment { arm } else { 1.0 }).collect();
    let of_given = loads.given.iter().zip(given_arms.iter().cycle()).map(|(force, arm)| force.abs() / arm);
    let weight = model.mass() * model.gravity.norm();
    of_joints.chain(of_drivers).chain(of_points).chain(of_given).fold(weight, f64::max)
}

fn size(force: &[f64]) -> f64 {
    force.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Force on a pin along its play; `None` where it is not known.
type PinForce = Option<Vec<f64>>;

/// Two times between which a force turns by more than a right angle.
struct Turn {
    times: [f64; 2],
    forces: [Vec<f64>; 2],
    /// A force as small as this has vanished.
    vanished: f64,
}

impl Turn {
    fn of(times: [f64; 2], forces: [&Vec<f64>; 2]) -> Option<Self> {
        let dot = forces[0].iter().zip(forces[1]).map(|(a, b)| a * b).sum::<f64>();
        let vanished = VANISHES * forces.iter().map(|f| size(f)).fold(0.0, f64::max);
        (dot < 0.0).then(|| Self { times, forces: forces.map(Clone::clone), vanished })
    }

    /// Time at which a force that reverses vanishes. Magnitudes are interpolated, so that bodies which turn differently
    /// have the same times.
    fn zero(&self) -> f64 {
        let ([start, end], [from, to]) = (self.times, self.forces.each_ref().map(|f| size(f)));
        start + (end - start) * from / (from + to)
    }

    /// Parts of the turn before and after a time at which the force is known, that are such turns themselves; or the
    /// time at which the force vanishes.
    fn parts(self, time: f64, force: &Vec<f64>) -> ControlFlow<f64, Vec<Self>> {
        let Self { times: [start, end], forces: [from, to], vanished } = &self;
        let parts = [([*start, time], [from, force]), ([time, *end], [force, to])];
        let parts: Vec<Self> = parts
            .into_iter()
            .filter_map(|(times, forces)| Some(Self { vanished: *vanished, ..Self::of(times, forces)? }))
            .collect();
        match size(force) > *vanished {
            true => ControlFlow::Continue(parts),
            false => ControlFlow::Break(parts.first().map_or(time, Self::zero)),
        }
    }
}

/// Times at which a force changes to the other side: where it vanishes. `between` returns the force at times between
/// the output times, where it is known: a force that turns without vanishing leads its pin around the hole.
fn reversals(
    times: &[f64],
    forces: &[PinForce],
    directions: &[Option<Vec<f64>>],
    between: &dyn Fn(&[f64]) -> Vec<PinForce>,
) -> Vec<f64> {
    let directed: Vec<usize> = (0..times.len()).filter(|k| directions[*k].is_some()).collect();
    let (mut found, mut turns) = (Vec::new(), Vec::new());
    for pair in directed.windows(2) {
        let [k, next] = [pair[0], pair[1]];
        let (Some(from), Some(to)) = (&forces[k], &forces[next]) else { continue };
        let Some(turn) = Turn::of([times[k], times[next]], [from, to]) else { continue };
        let mut without_force = (k + 1..next).filter(|between| forces[*between].is_some());
        match without_force.next() {
            Some(first) => {
                let last = without_force.next_back().unwrap_or(first);
                found.push(0.5 * (times[first] + times[last]));
            }
            None if size(from).min(size(to)) <= turn.vanished => found.push(turn.zero()),
            None => turns.push(turn),
        }
    }
    for trial in 0..MOST_TRIALS {
        if turns.is_empty() {
            break;
        }
        let middle = |[start, end]: [f64; 2]| start + 0.5 * (end - start);
        let at = |turn: &Turn| if trial % 2 == 0 { turn.zero() } else { middle(turn.times) };
        let trials: Vec<f64> = turns.iter().map(at).collect();
        let forces = between(&trials);
        let solved = trials.into_iter().zip(forces);
        for (turn, (time, force)) in std::mem::take(&mut turns).into_iter().zip(solved) {
            let Some(force) = force else {
                found.push(turn.zero());
                continue;
            };
            match turn.parts(time, &force) {
                ControlFlow::Continue(parts) => turns.extend(parts),
                ControlFlow::Break(time) => found.push(time),
            }
        }
    }
    found.extend(turns.iter().map(Turn::zero));
    found.sort_by(f64::total_cmp);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times at which a force of this size reverses, as seen by a body that turns by this angle per unit of time.
    fn seen(times: &[f64], force: impl Fn(f64) -> f64, turn: f64) -> Vec<f64> {
        let at = |t: &f64| Some(vec![force(*t) * (turn * t).cos(), force(*t) * (turn * t).sin()]);
        let forces: Vec<PinForce> = times.iter().map(at).collect();
        let unit = |f: &PinForce| {
            let f = f.as_ref()?;
            let size = size(f);
            (size > NO_FORCE).then(|| f.iter().map(|x| x / size).collect())
        };
        let directions: Vec<Option<Vec<f64>>> = forces.iter().map(unit).collect();
        reversals(times, &forces, &directions, &|times| times.iter().map(at).collect())
    }

    #[test]
    fn bodies_that_turn_differently_see_a_force_reverse_at_the_same_times() {
        let times: Vec<f64> = (0..=10).map(|k| f64::from(k) * 0.1).collect();
        // Reversal at 0.5, an output time but for round-off, and at 0.55.
        let near = |found: &[f64], expected: f64| found.len() == 1 && (found[0] - expected).abs() < 1e-12;
        for turn in [0.0, 1.0, -3.0] {
            assert!(near(&seen(&times, |t| 0.5 - t, turn), 0.5), "turn {turn}");
            assert!(near(&seen(&times, |t| t - 0.55, turn), 0.55), "turn {turn}");
            // A force that vanishes from 0.4 to 0.6, and one that does so without changing sides.
            let gap = |t: f64| if (t - 0.5).abs() < 0.11 { 0.0 } else { 0.5 - t };
            assert!(near(&seen(&times, gap, turn), 0.5), "turn {turn}");
            assert!(seen(&times, |t| gap(t).abs(), turn).is_empty(), "turn {turn}");
        }
    }

    #[test]
    fn a_force_that_turns_does_not_reverse() {
        let times = [0.0, 1.0, 2.0, 3.0];
        // Between output times a force of constant size turns by 120, 150 and 240 degrees.
        for turn in [120.0_f64, 150.0, 240.0] {
            assert!(seen(&times, |_| 1.0, turn.to_radians()).is_empty(), "turn {turn}");
        }
        // One that reverses does so where it vanishes, or where it jumps to the other side.
        let turn = 60.0_f64.to_radians();
        let found = seen(&times, |t| (t - 0.3) * (1.0 + t), turn);
        assert!(found.len() == 1 && (found[0] - 0.3).abs() < 1e-4, "{found:?}");
        let found = seen(&times, |t| if t < 1.3 { 1.0 } else { -1.0 }, 0.1);
        assert!(found.len() == 1 && (found[0] - 1.3).abs() < 1e-3, "{found:?}");
    }
}

//! Places of pins in their holes under the loads of the nominal motion.
//!
//! A pin lies on the side to which the force pushes it: with F the force on body j and c the play, the marker of
//! body j is off by `c F / abs(F)`, the part of F perpendicular to the axis for a pin.

use hardpoint::load::Loads;
use hardpoint::model::{Change, JointId, Model, VariableId};
use hardpoint::space::Vec3;

use super::Study;
use super::deviations::Deviations;

/// Forces below this fraction of the largest one of a joint push a pin to no side: round-off of reactions.
const NO_FORCE: f64 = 1e-9;

/// Pin that changes its side in the hole.
#[derive(Clone, Debug, PartialEq)]
pub struct SideChange {
    /// Joint with the play.
    pub joint: JointId,
    /// Index of the motion among those studied.
    pub motion: usize,
    /// Times, s, at which the force reverses: interpolated between output times.
    pub times: Vec<f64>,
}

/// Directions of the pins of a motion.
pub(super) struct Pins {
    /// Per block of the deviations and output time: unit vector along the block's variables; `None` where there is no
    /// play, or no force is known.
    directions: Vec<Vec<Option<Vec<f64>>>>,
    pub changes: Vec<SideChange>,
}

impl Pins {
    /// Places in the motions of a study, for joints with play whose forces are known; `None` if there are none.
    pub fn of(study: &Study<'_>, motion: usize) -> Option<Self> {
        let Study { settings, deviations, .. } = *study;
        let analysis = &study.motions.analyses()[motion];
        let model = analysis.model();
        if !model.has_loads() || settings.tolerances.iter().all(|t| t.play.is_none()) {
            return None;
        }
        let loads = analysis.loads(&[]);
        let joints = model.joints.len();
        let mut pins = Self { directions: Vec::new(), changes: Vec::new() };
        for block in &deviations.blocks {
            let tolerance = &settings.tolerances[block.tolerance];
            let along: Vec<Vec3> = deviations.variables[block.range()]
                .iter()
                .filter_map(|v| offset(model, v.variable))
                .collect();
            let Some(joint) = tolerance.play.filter(|_| along.len() == block.len) else {
                pins.directions.push(vec![None; loads.times.len()]);
                continue;
            };
            let forces: Vec<Option<Vec<f64>>> =
                (0..loads.times.len()).map(|k| force(&loads, k * joints + joint.0, &along)).collect();
            let size = |f: &[f64]| f.iter().map(|x| x * x).sum::<f64>().sqrt();
            let largest = forces.iter().flatten().map(|f| size(f)).fold(0.0, f64::max);
            let unit = |f: &Option<Vec<f64>>| {
                let f = f.as_ref()?;
                let size = size(f);
                (size > NO_FORCE * largest).then(|| f.iter().map(|x| x / size).collect::<Vec<f64>>())
            };
            let directions: Vec<Option<Vec<f64>>> = forces.iter().map(unit).collect();
            let times = reversals(&loads.times, &forces, &directions);
            if !times.is_empty() {
                pins.changes.push(SideChange { joint, motion, times });
            }
            pins.directions.push(directions);
        }
        Some(pins)
    }

    /// Change of an output with these derivatives at output time k, if every pin lies where the loads press it; `None`
    /// if that is not known of a pin that the output depends on.
    pub fn shift(&self, deviations: &Deviations, k: usize, g: &[f64]) -> Option<f64> {
        let of_block = |(block, directions): (&super::deviations::Block, &Vec<Option<Vec<f64>>>)| {
            let g = &g[block.range()];
            if g.iter().all(|g| *g == 0.0) {
                return Some(0.0);
            }
            let direction = directions.get(k)?.as_ref()?;
            Some(block.reach * g.iter().zip(direction).map(|(g, n)| g * n).sum::<f64>())
        };
        deviations
            .blocks
            .iter()
            .zip(&self.directions)
            .filter(|(_, d)| d.iter().any(Option::is_some))
            .map(of_block)
            .sum()
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
fn force(loads: &Loads, place: usize, along: &[Vec3]) -> Option<Vec<f64>> {
    let load = loads.joints.get(place)?;
    let ([force, _], [known, _]) = (load.in_body, load.known_in_body);
    let determined = |n: &Vec3| (0..3).all(|axis| known[axis] || n[axis].abs() < 1e-12);
    along.iter().map(|n| determined(n).then(|| force.dot(*n))).collect()
}

/// Times at which a force changes to the other side: where it vanishes, or interpolated between those at which it has
/// a direction. Magnitudes are interpolated, so that bodies which turn differently have the same times.
fn reversals(times: &[f64], forces: &[Option<Vec<f64>>], directions: &[Option<Vec<f64>>]) -> Vec<f64> {
    let directed: Vec<usize> = (0..times.len()).filter(|k| directions[*k].is_some()).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let at = |pair: &[usize]| {
        let [k, next] = [pair[0], pair[1]];
        if dot(directions[k].as_ref()?, directions[next].as_ref()?) >= 0.0 {
            return None;
        }
        let mut without_force = (k + 1..next).filter(|between| forces[*between].is_some());
        if let Some(first) = without_force.next() {
            return Some(0.5 * (times[first] + times[without_force.next_back().unwrap_or(first)]));
        }
        let [from, to] = [k, next].map(|k| forces[k].as_ref().map(|f| dot(f, f).sqrt()));
        let (from, to) = (from?, to?);
        // F = 0 between F_k and -F_next
        Some(times[k] + (times[next] - times[k]) * from / (from + to))
    };
    directed.windows(2).filter_map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times at which a force of this size reverses, as seen by a body that turns by this angle per unit of time.
    fn seen(times: &[f64], force: impl Fn(f64) -> f64, turn: f64) -> Vec<f64> {
        let forces: Vec<Option<Vec<f64>>> = times
            .iter()
            .map(|t| Some(vec![force(*t) * (turn * t).cos(), force(*t) * (turn * t).sin()]))
            .collect();
        let unit = |f: &Option<Vec<f64>>| {
            let f = f.as_ref()?;
            let size = f[0].hypot(f[1]);
            (size > NO_FORCE).then(|| f.iter().map(|x| x / size).collect())
        };
        let directions: Vec<Option<Vec<f64>>> = forces.iter().map(unit).collect();
        reversals(times, &forces, &directions)
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
}

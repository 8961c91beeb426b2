//! Proven bounds between two times contain all that is solved there, for every model of the gallery.

use std::path::Path;

use hardpoint::law::TimeJet;
use hardpoint::model::Model;
use hardpoint::motion::{BodyState, TubeFailure};
use hardpoint::number::Interval;
use hardpoint::space::{Pose, Vec3};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run};
use hardpoint_file::read;

/// Number of times inside of every interval.
const TIMES: usize = 50;
/// Error of a solved position, speed and acceleration, as a part of the largest of its kind in the interval, or of the
/// mechanism's size or a radian: residuals of 1e-14, magnified near singular positions.
const SOLVED: f64 = 1e-9;
/// Shortest interval, as a part of the motion, that must be proved wherever the motion is regular.
const SHORTEST: f64 = 1.0 / 4096.0;

/// Position, speed and acceleration of the numbers of a pose, from a solved state.
fn numbers(state: &BodyState) -> Vec<[f64; 3]> {
    let mut out = Vec::new();
    let mut add = |x: Vec3, d: Vec3, dd: Vec3| {
        out.extend([[x.x, d.x, dd.x], [x.y, d.y, dd.y], [x.z, d.z, dd.z]]);
    };
    add(state.r, state.v, state.a);
    for e in state.rotation.cols {
        let d = state.omega.cross(e);
        add(e, d, state.alpha.cross(e) + state.omega.cross(d));
    }
    out
}

fn bounds(pose: &Pose<TimeJet<Interval>>) -> Vec<[Interval; 4]> {
    let [f, g, h] = pose.rot.cols;
    [pose.r, f, g, h].into_iter().flat_map(|v| [v.x, v.y, v.z]).map(|x| x.0).collect()
}

/// Results over the intervals of a model.
#[derive(Default)]
struct Tally {
    intervals: usize,
    /// Largest width of bounds beyond the range that was sampled, over that range; per order.
    excess: [f64; 3],
    longest: f64,
}

/// Checks the bounds over one interval against solved positions in it; halves it until it is proved.
fn check(name: &str, model: &Model, analysis: &Analysis<'_>, tally: &mut Tally, from: f64, to: f64) {
    let (mut motion, _) = analysis.proven_motion(&[]).unwrap();
    let span = model.times[model.times.len() - 1] - model.times[0];
    let mut to = to;
    let found = loop {
        match motion.over(from, to) {
            Ok(found) => break found,
            Err(reason) => {
                assert!(reason.may_be_halved(), "{name}: {reason:?}");
                assert!(to - from > SHORTEST * span, "{name}: not proved from {from} to {to}: {reason:?}");
                to = from + 0.5 * (to - from);
            }
        }
    };
    let inside = (0..=TIMES).map(|k| from + (to - from) * (k as f64 / TIMES as f64));
    let mut times: Vec<f64> = vec![model.times[0]];
    times.extend(inside.filter(|t| *t > model.times[0]));
    let solution = analysis.without_metrics(times).solve(Run::new().without_sensitivities());
    assert!(solution.stop.is_none(), "{name}");
    let first = solution.motion.len() - TIMES;
    tally.intervals += 1;
    tally.longest = tally.longest.max((to - from) / span);
    for body in 1..model.bodies.len() {
        let found = bounds(&found[body]);
        let states: Vec<Vec<[f64; 3]>> =
            (first..solution.motion.len()).map(|k| numbers(&solution.motion.at(k).body(body))).collect();
        for (n, found) in found.iter().enumerate() {
            for order in 0..3 {
                let unit = if n < 3 { model.size() } else { 1.0 };
                let kind = if n < 3 { 0..3 } else { 3..12 };
                let largest = states.iter().flat_map(|s| kind.clone().map(move |m| s[m][order].abs()));
                let largest = largest.fold(unit, f64::max);
                let bounds = found[order];
                let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY];
                for (k, state) in states.iter().enumerate() {
                    let x = state[n][order];
                    // At the end, a law may have the rates of the side after it.
                    if order > 0 && k + 1 == states.len() {
                        continue;
                    }
                    (low, high) = (low.min(x), high.max(x));
                    let hair = SOLVED * largest;
                    assert!(
                        bounds.low - hair <= x && x <= bounds.high + hair,
                        "{name}: body {body}, number {n}, order {order}, {k} of {TIMES} between {from} and {to}: {x} is \
                         not in {bounds:?}"
                    );
                }
                let excess = (bounds.width() - (high - low)) / ((high - low) + 1e-3 * largest);
                tally.excess[order] = tally.excess[order].max(excess);
            }
        }
    }
}

/// Intervals of a model between output times that follow each other, some of them whole, some parts.
fn check_model(name: &str, model: &Model, formulation: Formulation) -> Option<Tally> {
    let model = Model { variables: Vec::new(), metrics: Vec::new(), measures: Vec::new(), ..model.clone() };
    let analysis = Analysis::with(&model, formulation).ok()?;
    let (motion, stop) = analysis.proven_motion(&[])?;
    let times: Vec<f64> = motion.times().collect();
    // Next to where a motion ends it is singular.
    let last = times.len() - 1 - if stop.is_some() { times.len() / 10 + 1 } else { 0 };
    let mut tally = Tally::default();
    for part in 0..6 {
        let k = part * (last - 1) / 5;
        let (from, to) = (times[k], times[k + 1]);
        let to = if part % 2 == 0 { to } else { from + 0.1 * (to - from) };
        check(name, &model, &analysis, &mut tally, from, to);
    }
    Some(tally)
}

fn model_of(path: &Path) -> Model {
    read(path).unwrap_or_else(|e| panic!("{e}")).model
}

#[test]
fn bounds_contain_positions_speeds_and_accelerations_of_every_model() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let mut checked = 0;
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    paths.sort();
    for path in paths.iter().filter(|p| p.extension().is_some_and(|e| e == "toml")) {
        let name = path.file_stem().unwrap().to_str().unwrap();
        let model = model_of(path);
        if model.joints.iter().any(|j| j.curve.is_some()) {
            let analysis = Analysis::new(&model).unwrap();
            let (mut motion, _) = analysis.proven_motion(&[]).unwrap();
            let times: Vec<f64> = motion.times().collect();
            let reason = motion.over(times[0], times[1]).unwrap_err();
            assert!(matches!(reason, TubeFailure::FollowsCurve { .. }), "{name}: {reason:?}");
            continue;
        }
        let Some(tally) = check_model(name, &model, Formulation::Relative) else { continue };
        println!(
            "{name}: {} intervals, excess {:.3?}, longest {:.4}",
            tally.intervals, tally.excess, tally.longest
        );
        checked += 1;
    }
    assert!(checked > 25, "{checked}");
}

#[test]
fn absolute_coordinates_have_the_same_bounds() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    for name in ["four_bar", "macpherson", "slider_crank", "rssr"] {
        let model = model_of(&folder.join(format!("{name}.toml")));
        let tally = check_model(name, &model, Formulation::Absolute).unwrap();
        println!(
            "{name}: {} intervals, excess {:.3?}, longest {:.4}",
            tally.intervals, tally.excess, tally.longest
        );
    }
}

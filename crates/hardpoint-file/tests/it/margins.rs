//! Derivatives of margins to singular positions, of all models of the gallery.

use std::path::Path;

use hardpoint::model::{Model, VariableId};
use hardpoint::sensitivity::Admissibility;
use hardpoint::{Analysis, Run};
use hardpoint_file::read;

use crate::equilibrium::wishbone_on_axes_through_hardpoints;

/// Step of the differences, in SI.
const STEP: f64 = 1e-6;
/// Distance of the design from the nominal one, in SI.
const BESIDE: f64 = 1e-4;
/// Differences of margins: round-off over the step, and the square of the step.
const AGREES: f64 = 1e-6;
/// Margins have corners, where two of the numbers that they are a maximum of are equal. At most this part of all
/// derivatives are at corners.
const CORNERS: f64 = 0.03;
/// Spherical linkages: where all axes meet, forces at their centre resist nothing, and count as soon as the axes do not
/// meet exactly. Their margin jumps.
const SPHERICAL: [&str; 1] = ["hooke.toml"];
/// Number of output times of a model.
const TIMES: usize = 7;

#[test]
fn margins_have_the_derivatives_of_differences() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let (mut models, mut checked, mut corners) = (0, 0, 0);
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") || SPHERICAL.iter().any(|name| path.ends_with(name)) {
            continue;
        }
        let file = read(&path).unwrap_or_else(|e| panic!("{e}"));
        let motion = file.model.motions().swap_remove(0);
        let every = motion.times.len().div_ceil(TIMES).max(1);
        let times = motion.times.iter().copied().step_by(every).collect();
        let model = Model { times, metrics: Vec::new(), ..motion };
        let [count, at_corners] = compare(&path.display().to_string(), &model);
        models += usize::from(count > 0);
        checked += count;
        corners += at_corners;
    }
    assert!(models > 30 && checked > 1500, "{checked} derivatives of {models} models");
    assert!(corners as f64 <= CORNERS * checked as f64, "{corners} of {checked} derivatives are at corners");
}

/// With loads, elastic joints open differently in each design.
#[test]
fn margins_at_equilibria_have_the_derivatives_of_differences() {
    let text = wishbone_on_axes_through_hardpoints(true);
    let model = hardpoint_file::parse(&text, "wishbone.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let [count, at_corners] = compare("wishbone", &model);
    assert!(count >= 10 && at_corners == 0, "{at_corners} of {count} derivatives are at corners");
}

/// Compares the derivatives of a model with differences. Returns how many were compared, and how many are at corners.
fn compare(name: &str, model: &Model) -> [usize; 2] {
    let analysis = Analysis::new(model).unwrap();
    let admissibility = analysis.run().sensitivities.admissibility;
    let variables: Vec<VariableId> = (0..model.variables.len())
        .filter(|v| matches!(admissibility.get(*v), Some(Admissibility::Admissible)))
        .map(VariableId)
        .collect();
    // In the nominal design, two sides or two numbers of a block are often equal. Redundant constraints may contradict
    // each other beside it.
    let is_movable =
        |v: usize| analysis.topology().redundant().next().is_none() && variables.contains(&VariableId(v));
    let beside = |v: usize| if is_movable(v) { BESIDE * (1.0 + 0.37 * v as f64) } else { 0.0 };
    let design: Vec<f64> = (0..model.variables.len()).map(beside).collect();
    let found = analysis.margin_derivatives(&design, &variables, f64::INFINITY);
    assert!(found.stop.is_none(), "{name}");
    let largest = found.d.iter().flatten().fold(1.0, |most: f64, d| most.max(d.abs()));
    let (mut corners, mut count) = (0, 0);
    for (column, v) in variables.iter().enumerate() {
        let margins = |step: f64| {
            let mut design = design.clone();
            design[v.0] += step;
            let solution = analysis.solve(Run::new().at(&design).without_sensitivities());
            assert!(solution.stop.is_none(), "{name}");
            solution.motion.margins
        };
        let (more, less) = (margins(STEP), margins(-STEP));
        for (k, here) in found.margins.iter().enumerate() {
            let [behind, ahead] = [here.value - less[k].value, more[k].value - here.value].map(|d| d / STEP);
            let d = found.d[k][column];
            let off = (d - 0.5 * (ahead + behind)).abs();
            count += 1;
            if off <= AGREES * largest {
                continue;
            }
            // At a corner it is the slope of one side, or of another of more sides that meet there.
            let slack = 0.1 * (ahead - behind).abs();
            let is_between = behind.min(ahead) - slack <= d && d <= behind.max(ahead) + slack;
            assert!(
                is_between,
                "{name} at {k} ({here:?}) by {}: {d}, {behind} {ahead}",
                model.variables[v.0].name
            );
            corners += 1;
        }
    }
    [count, corners]
}

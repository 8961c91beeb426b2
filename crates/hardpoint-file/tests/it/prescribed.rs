//! Drivers that prescribe the value of a measure, or count from zero.

use hardpoint::model::{Model, VariableId};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::parse;
use hardpoint_study::grid::GridMap;

use crate::diagnostics::{VALID, snapshot};

/// Prescribed values are met as the solver meets all others, m or rad.
const MET: f64 = 1e-12;
/// Prescribed values do not change with the design, per m or rad.
const STAYS: f64 = 1e-10;
/// Differences of two designs, 0.1 mm away on either side, against the sensitivity between them.
const DIFFERENCES: f64 = 2e-6;

/// The strut, driven by these two; more measures, and variables that move the points which they measure; `rest` ends
/// the file.
fn strut([bump, steering]: [&str; 2], rest: &str) -> Model {
    let text = std::fs::read_to_string("../../models/studies/strut_toe.toml").unwrap();
    let (above, _) = text.split_once("[drivers.rack_drive]").unwrap();
    let (_, below) = text.split_once("[design]").unwrap();
    let (below, _) = below.split_once("[metrics.toe_error]").unwrap();
    let text = format!(
        r#"{above}
[time]
end = 1
steps = 8

[drivers]
bump = {{ {bump} }}
steering = {{ {steering} }}

[measures]
ball_height = {{ type = "position", point = {{ body = "knuckle", at = "ball_joint" }}, along = [0, 0, 2] }}
spring = {{ type = "distance", from = {{ body = "ground", at = "strut_top" }}, to = {{ body = "knuckle", at = "ball_joint" }} }}
arm = {{ type = "angle", from = "y", to = [{{ body = "lca", at = "lca_rear" }}, {{ body = "lca", at = "ball_joint" }}], about = "x" }}
steer = {{ type = "steer_angle", wheel = "front_left" }}
wheel_toe = {{ type = "toe", wheel = "front_left" }}
travel = {{ type = "wheel_travel", wheel = "front_left" }}
recession = {{ type = "wheel_recession", wheel = "front_left" }}

[design]
ball_y = {{ move = "ball_joint", along = "y" }}
ball_z = {{ move = "ball_joint", along = "z" }}
top_x = {{ move = "strut_top", along = "x" }}
rear_z = {{ move = "lca_rear", along = "z" }}
{below}
{rest}"#
    );
    parse(&text, "strut.toml").unwrap_or_else(|e| panic!("{e}")).model
}

fn solved(model: &Model, design: &[f64]) -> Solution {
    let solution = Analysis::new(model).unwrap().solve(Run::new().at(design));
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    solution
}

fn output(solution: &Solution, name: &str) -> usize {
    solution.measured.outputs.iter().position(|o| o.name == name).unwrap()
}

/// A measure, and its law in SI over s.
type Prescribed<'a> = (&'a str, fn(f64) -> f64);

/// The measures stay at their laws in all designs, and all else changes as re-solving says.
fn holds(drivers: [&str; 2], laws: &[Prescribed<'_>]) {
    let model = strut(drivers, "");
    let nominal = solved(&model, &[]);
    let prescribed: Vec<usize> = laws.iter().map(|law| output(&nominal, law.0)).collect();
    let variables = model.variables.len();
    let mut moved = 0.0_f64;
    for v in 0..variables {
        let design = |b: f64| (0..variables).map(|k| if k == v { b } else { 0.0 }).collect::<Vec<_>>();
        let step = 1e-4;
        let [less, more] = [-step, step].map(|b| solved(&model, &design(b)));
        for (k, time) in model.times.iter().enumerate() {
            for (m, (name, law)) in prescribed.iter().zip(laws) {
                for solution in [&nominal, &less, &more] {
                    let off = solution.measured.value(k, *m)[0] - law(*time);
                    assert!(off.abs() < MET, "{name} at {time} s: {off:e}");
                }
                let d = nominal.measured.d(k, VariableId(v), *m)[0];
                assert!(d.abs() < STAYS, "{name} by {}: {d:e}", model.variables[v].name);
            }
            for m in 0..nominal.measured.outputs.len() {
                for order in 0..2 {
                    let number = |s: &Solution| s.measured.value(k, m)[order];
                    let (d, difference) = (
                        nominal.measured.d(k, VariableId(v), m)[order],
                        (number(&more) - number(&less)) / (2.0 * step),
                    );
                    let size = 1.0 + d.abs() + number(&nominal).abs();
                    let name = &nominal.measured.outputs[m].name;
                    assert!(
                        (d - difference).abs() < DIFFERENCES * size,
                        "{name} by {}, order {order}: {d} against {difference}",
                        model.variables[v].name
                    );
                    moved = moved.max(d.abs());
                }
            }
        }
    }
    assert!(moved > 0.1, "something follows the design");
}

#[test]
fn wheel_travel_and_toe_follow_their_laws_in_every_design() {
    let drivers =
        [r#"measure = "travel", law = "-30 + 60*t""#, r#"measure = "wheel_toe", law = "-4 + 8*t^2""#];
    holds(
        drivers,
        &[("travel", |t| (-30.0 + 60.0 * t) * 1e-3), ("wheel_toe", |t| (-4.0 + 8.0 * t * t).to_radians())],
    );
}

#[test]
fn a_height_and_a_steer_angle_follow_their_laws() {
    let drivers =
        [r#"measure = "ball_height", law = "-120 + 40*t""#, r#"measure = "steer", law = "-10 + 20*t""#];
    holds(
        drivers,
        &[("ball_height", |t| (-120.0 + 40.0 * t) * 1e-3), ("steer", |t| (-10.0 + 20.0 * t).to_radians())],
    );
}

#[test]
fn a_distance_and_a_coordinate_follow_their_laws() {
    let drivers = [r#"measure = "spring", law = "585 + 25*t""#, r#"measure = "rack", law = "10*sin(3*t)""#];
    holds(drivers, &[("spring", |t| (585.0 + 25.0 * t) * 1e-3), ("rack", |t| 10e-3 * (3.0 * t).sin())]);
}

#[test]
fn an_angle_between_points_and_a_toe_follow_their_laws() {
    let drivers = [r#"measure = "arm", law = "-3 + 10*t""#, r#"measure = "toe", law = "5*t""#];
    holds(drivers, &[("arm", |t| (-3.0 + 10.0 * t).to_radians()), ("toe", |t| (5.0 * t).to_radians())]);
}

#[test]
fn a_driver_that_counts_from_zero_is_the_measure_of_the_same() {
    let points =
        r#"from = { body = "ground", at = "strut_top" }, to = { body = "knuckle", at = "ball_joint" }"#;
    let spring = format!(r#"{points}, law = "585 + 25*t", counted_from = "zero""#);
    let position = r#"point = { body = "knuckle", at = "tie_rod_outer" }, along = { through = ["rack_centre", "tie_rod_outer"] }, law = "600", counted_from = "zero""#;
    holds([&spring, r#"measure = "rack", law = "0""#], &[("spring", |t| (585.0 + 25.0 * t) * 1e-3)]);
    // How far along the line through two hardpoints, one of which it is itself: where it is in the design
    // configuration, in every design.
    let model = strut([r#"measure = "travel", law = "10*t""#, position], "");
    let [p, rack] = ["tie_rod_outer", "rack_centre"]
        .map(|name| model.hardpoints.iter().find(|h| h.name == name).unwrap().position);
    let drawn = p.dot((p - rack).unit().unwrap());
    let driver = model.drivers.iter().find(|d| d.name == "steering").unwrap();
    assert!((driver.law.as_drawn().unwrap().1 - drawn).abs() < MET);
    assert!((driver.law.at(0.0).value() - (0.6 - drawn)).abs() < MET);
}

#[test]
fn a_grid_over_measures_has_their_values_in_every_design() {
    let rest = "[cases.map]\ngrid = { bump = { at = [-30, 0, 25] }, steering = { at = [-10, -2, 10] } }\n\
                [cases.bump]\nlaws = { bump = \"10*t\" }\n";
    let model = strut([r#"measure = "travel""#, r#"measure = "toe""#], rest);
    let grid = &model.grids[0];
    let mut design = vec![0.0; model.variables.len()];
    for shift in [0.0, 2e-3] {
        design.iter_mut().for_each(|b| *b = shift);
        let map = GridMap::solve(&model, grid, Formulation::Relative, &design, &|| true).unwrap();
        assert_eq!((map.solved(), map.stops.len()), (9, 0));
        for (name, along, per) in [("travel", 0, 1e-3), ("toe", 1, 1f64.to_radians())] {
            let m = map.outputs.iter().position(|o| o.name == name).unwrap();
            for place in map.places() {
                let position = map.grid.values[along][place[along]];
                let off = map.value(place, m).unwrap() - position;
                assert!(off.abs() < MET, "{name} at {place:?}: {off:e}");
                assert!(position == 0.0 || position.abs() > per, "places in their units");
                for v in (0..model.variables.len()).map(VariableId) {
                    let d = map.d(place, v, m).unwrap();
                    assert!(d.abs() < STAYS, "{name} by {}: {d:e}", model.variables[v.0].name);
                }
            }
        }
    }
}

#[test]
fn measures_that_no_driver_can_prescribe_are_reported() {
    let driven = |by: &str| VALID.replace("joint = \"J1\"\nlaw", &format!("{by}\nlaw"));
    for (name, by, measures) in [
        ("driver_of_no_measure", r#"measure = "heigth""#, ""),
        ("driver_of_a_rate", r#"measure = "speed""#, r#"speed = { type = "velocity", point = "P" }"#),
        (
            "driver_of_a_camber",
            r#"measure = "lean""#,
            r#"lean = { type = "camber", body = "crank", spin_axis = "y" }"#,
        ),
        (
            "driver_of_an_angle_between_bodies",
            r#"measure = "bend""#,
            r#"bend = { type = "angle", from = { body = "crank", axis = "x" }, to = { body = "rocker", axis = "x" }, about = "z" }"#,
        ),
        (
            "driver_of_an_angle_seen_end_on",
            r#"measure = "spin""#,
            r#"spin = { type = "angle", from = "x", to = { body = "crank", axis = "z" }, about = "z" }"#,
        ),
        (
            "driver_of_an_angle_from_the_line_of_sight",
            r#"measure = "spin""#,
            r#"spin = { type = "angle", from = "z", to = { body = "crank", axis = "x" }, about = "z" }"#,
        ),
        ("driver_of_a_measure_from_zero", "measure = \"height\"\ncounted_from = \"zero\"", ""),
        ("driver_without_a_zero", "joint = \"J1\"\ncounted_from = \"zero\"", ""),
        ("driver_counted_from_nothing", "joint = \"J1\"\ncounted_from = \"top\"", ""),
        ("driver_of_a_measure_and_a_joint", "joint = \"J1\"\nmeasure = \"height\"", ""),
    ] {
        let tables = if measures.is_empty() { String::new() } else { format!("\n[measures]\n{measures}\n") };
        snapshot(name, &format!("{}{tables}", driven(by)));
    }
}

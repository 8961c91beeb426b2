//! Parameters, expressions and mirrored variables, as files write them.

use std::ops::ControlFlow;

use hardpoint::Analysis;
use hardpoint::joint::Quantity;
use hardpoint::model::{Change, VariableId, change};
use hardpoint::space::Vec3;
use hardpoint_file::parse;
use hardpoint_study::verify::{self, verify};

/// Two swinging arms, left and right, and a screw; everything is given by parameters.
const MODEL: &str = r#"
name = "arms"
units = { length = "mm", angle = "deg" }

[parameters]
reach = { value = 200, unit = "length", bounds = [150, 300], typical = 5, tolerance = 0.3 }
droop = { value = 30, unit = "angle", bounds = [0, 60] }
swing = 20
half_track = { value = "3*reach", unit = "length" }
pitch = { value = 5, unit = "length", design = false }

[hardpoints]
inner_left = ["reach/10", "half_track - reach*cos(droop)", 300]
outer_left = [0, "half_track", "inner_left.z - reach*sin(droop)"]
inner_right = ["inner_left.x", "-inner_left.y", "inner_left.z"]
outer_right = ["outer_left.x", "-outer_left.y", "outer_left.z"]
top_left = [0, 500, 600]
top_right = [0, -500, 600]

[bodies]
left = { frame = { position = "outer_left", euler = [0, "pi/2", 0] } }
right = {}
nut = {}
damper = {}

[joints]
hinge_left = { type = "revolute", bodies = ["ground", "left"], at = "inner_left", axis = "x" }
hinge_right = { type = "revolute", bodies = ["ground", "right"], at = "inner_right", axis = "x" }
screw = { type = "screw", bodies = ["ground", "nut"], at = [0, "pitch*2", 0], axis = "z", lead = "-pitch" }
slide = { type = "translational", bodies = ["ground", "damper"], at = ["reach", "2*reach", "reach/4"], axis = "z" }
link = { type = "rod", bodies = ["left", "damper"], at = ["outer_left", ["reach", "half_track", 700]], length = "4*reach" }

[drivers]
left = { joint = "hinge_left", law = "swing*sin(2*pi*t)" }
right = { joint = "hinge_right", law = { type = "expression", law = "a*t + swing*t^2", parameters = { a = "reach/50" } } }
nut = { joint = "screw", coordinate = "angle", law = { type = "sequence", pieces = [{ law = "swing*t" }] } }

[design]
both_up = { move = "top_left", along = [0, 3, 4], mirror = "y", mirrored = "top_right", bounds = [-10, 10], typical = 2 }
left_up = { move = "top_left", along = [0, 3, 4] }
right_up = { move = "top_right", along = [0, -3, 4] }

[points]
outer_left = { body = "left", at = "outer_left" }
top_left = { body = "left", at = "top_left" }
top_right = { body = "right", at = "top_right" }

[measures]
across = { type = "distance", from = "top_left", to = "top_right" }
height = { type = "position", point = "outer_left", along = "z" }
damper = { type = "coordinate", joint = "slide" }

[time]
end = 0.2
steps = 8
"#;

#[test]
fn expressions_are_in_the_units_of_the_file() {
    let file = parse(MODEL, "arms.toml").unwrap_or_else(|e| panic!("{e}"));
    let m = &file.model;
    let at = |name: &str| m.hardpoints.iter().find(|h| h.name == name).unwrap().position;
    let (s, c) = 30f64.to_radians().sin_cos();
    for (found, expected) in [
        (at("inner_left"), Vec3::new(0.02, 0.6 - 0.2 * c, 0.3)),
        (at("outer_left"), Vec3::new(0.0, 0.6, 0.3 - 0.2 * s)),
        (at("inner_right"), Vec3::new(0.02, -0.6 + 0.2 * c, 0.3)),
        (at("screw"), Vec3::new(0.0, 0.01, 0.0)),
        (at("slide"), Vec3::new(0.2, 0.4, 0.05)),
    ] {
        assert!((found - expected).norm() < 1e-15, "{found:?} {expected:?}");
    }
    assert!((m.bodies[1].frame.r - at("outer_left")).norm() < 1e-15);
    assert!((m.bodies[1].frame.rot.cols[2] - Vec3::new(0.0, -1.0, 0.0)).norm() < 1e-15);
    let lead = m.couplers.iter().find(|c| c.name == "screw").unwrap().terms[1].coefficient;
    assert!((lead - 0.005 / std::f64::consts::TAU).abs() < 1e-15);
    let link = m.joints.iter().find(|j| j.name == "link").unwrap();
    assert!((link.length.unwrap() - 0.8).abs() < 1e-15);
    let values: Vec<f64> = m
        .drivers
        .iter()
        .flat_map(|d| d.law.parameters())
        .map(|p| p.value)
        .filter(|v| v.is_finite())
        .collect();
    assert_eq!(values, [20.0, 4.0, 20.0, 20.0]);
}

#[test]
fn parameters_are_design_variables_with_bounds_and_size() {
    let file = parse(MODEL, "arms.toml").unwrap();
    let m = &file.model;
    let names: Vec<&str> = m.variables.iter().map(|v| v.name.as_str()).collect();
    assert_eq!(names, ["reach", "droop", "swing", "both_up", "left_up", "right_up"]);
    let [reach, droop, swing, both] = [0, 1, 2, 3].map(|k| &m.variables[k]);
    assert_eq!(reach.quantity, Quantity::Length);
    let near =
        |a: Option<[f64; 2]>, b: [f64; 2]| a.unwrap().iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15);
    assert!(near(reach.bounds, [-0.05, 0.1]) && near(both.bounds, [-0.01, 0.01]));
    assert!(near(droop.bounds, [-30.0, 30.0].map(f64::to_radians)));
    assert_eq!((reach.typical, swing.bounds, both.typical), (Some(0.005), None, Some(0.002)));
    assert_eq!((reach.tolerance, both.tolerance), (Some(0.0003), None));
    assert!(matches!(reach.changes[..], [Change::Parameter(change::Parameter { rate: 1.0, .. })]));
    assert!(m.without_effect().is_empty());
    assert_eq!(file.place(hardpoint::draft::Section::Design, 1), Some((7, 1)));
}

#[test]
fn a_mirrored_variable_is_the_two_sides_added() {
    let file = parse(MODEL, "arms.toml").unwrap();
    let solution = Analysis::new(&file.model).unwrap().run();
    let across = solution.measured.index("across").unwrap();
    let by = |name: &str, k: usize| solution.measured.d(k, file.model.variable(name).unwrap(), across);
    for k in 0..solution.motion.len() {
        let (both, left, right) = (by("both_up", k), by("left_up", k), by("right_up", k));
        for n in 0..3 {
            assert!(
                (both[n] - left[n] - right[n]).abs() < 1e-11 * both[n].abs().max(1.0),
                "step {k}, order {n}"
            );
        }
    }
    // Along (0, 0.6, 0.8) on the left and (0, -0.6, 0.8) on the right.
    assert!((by("both_up", 0)[0] - 1.2).abs() < 1e-12);
}

#[test]
fn sensitivities_by_parameters_match_designs_that_are_solved_anew() {
    let file = parse(MODEL, "arms.toml").unwrap();
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    for measure in ["height", "damper"] {
        let measure = solution.measured.index(measure).unwrap();
        for v in 0..3 {
            let last = solution.motion.len() - 1;
            assert!(solution.measured.d(last, VariableId(v), measure)[0] != 0.0 || v == 1, "variable {v}");
        }
    }
    let checks = verify(&analysis, &solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
    assert!(checks.passed(), "{:?}", checks.checks);
}

#[test]
fn long_chains_and_many_expressions_are_read_in_time() {
    let text = MODEL.replace("[bodies]", "");
    let (head, tail) = text.split_at(text.find("left = { frame").unwrap());
    let mut chain = String::from("P0 = [\"reach\", 0, 1]\n");
    for k in 1..20_000 {
        chain += &format!("P{k} = [\"P{}.x + 1\", {k}, 2]\n", k - 1);
    }
    let file =
        parse(&format!("{head}{chain}[bodies]\n{tail}"), "arms.toml").unwrap_or_else(|e| panic!("{e}"));
    let last = file.model.hardpoints.iter().find(|h| h.name == "P19999").unwrap();
    assert!((last.position.x - (0.2 + 19.999)).abs() < 1e-9);
    let deep = format!("B = [\"{}1{}\", 0, 0]\n[bodies]\n", "(".repeat(5000), ")".repeat(5000));
    let text = format!("{head}{deep}{tail}");
    assert_eq!(parse(&text, "arms.toml").unwrap_err().list()[0].code, "HP0113");
}

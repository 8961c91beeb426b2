//! Measures of every kind on several mechanisms: rates against differences over time, sensitivities against designs that are
//! solved anew, and values by formulas.

use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::study::{VerifyOptions, verify};
use hardpoint::{Analysis, Solution};
use hardpoint_file::{ModelFile, parse};

const MEASURES: &str = r#"
[measures.mu]
type = "transmission_angle"
from = [{ body = "FRAMES0", at = "POINTS1" }, { body = "FRAMES0", at = "POINTS2" }]
to = [{ body = "FRAMES1", at = "POINTS3" }, { body = "FRAMES1", at = "POINTS2" }]

[measures.between]
type = "angle"
from = { body = "FRAMES0", axis = [1, 0.2, 0.1] }
to = [0.3, 1, 0]

[measures.about]
type = "angle"
from = { body = "FRAMES0", axis = [1, 0.2, 0.1] }
to = { body = "FRAMES1", axis = [0.1, 1, 0.3] }
about = [0.1, 0, 1]

[measures.v]
type = "velocity"
point = { body = "FRAMES0", at = "POINTS2" }
along = [1, 0.5, 0.2]

[measures.a]
type = "acceleration"
point = { body = "FRAMES0", at = "POINTS2" }
along = [1, 0.5, 0.2]

[measures.x]
type = "position"
point = { body = "FRAMES0", at = "POINTS2" }
along = [1, 0.5, 0.2]

[measures.xdot]
type = "rate"
of = "x"

[measures.turning]
type = "rate"
of = "about"

[measures.mixed]
type = "expression"
expression = "x*sin(about) + 2*x"

[measures.power]
type = "expression"
expression = "v*a"
"#;

/// Per model: a moving body and the next one, and three of its hardpoints: one end, the joint between them, the other end.
const MODELS: [(&str, [&str; 2], [&str; 3]); 4] = [
    ("watt_six_bar", ["coupler", "rocker"], ["crank_pin", "rocker_pin", "rocker_pivot"]),
    ("slider_crank", ["rod", "slider"], ["P2", "P3", "P4"]),
    ("double_wishbone", ["lca", "knuckle"], ["lca_rear", "lower_ball", "upper_ball"]),
    ("macpherson", ["lca", "knuckle"], ["lca_rear", "ball_joint", "strut_lower"]),
];

fn with_measures((name, bodies, points): &(&str, [&str; 2], [&str; 3])) -> ModelFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.toml"));
    let mut more = MEASURES.to_owned();
    for (k, body) in bodies.iter().enumerate() {
        more = more.replace(&format!("FRAMES{k}"), body);
    }
    for (k, point) in points.iter().enumerate() {
        more = more.replace(&format!("POINTS{}", k + 1), point);
    }
    // Names of their own.
    for measure in ["mu", "between", "about", "v", "a", "x", "xdot", "turning", "mixed", "power"] {
        more = more.replace(&format!("[measures.{measure}]"), &format!("[measures.own_{measure}]"));
        more = more.replace(&format!("of = \"{measure}\""), &format!("of = \"own_{measure}\""));
    }
    more = more.replace("x*sin(about) + 2*x", "own_x*sin(own_about) + 2*own_x").replace("v*a", "own_v*own_a");
    let text = std::fs::read_to_string(path).unwrap() + &more;
    parse(&text, "measures.toml").unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn solved(file: &ModelFile) -> Solution {
    let solution = Analysis::new(&file.model).unwrap().run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    solution
}

#[test]
fn every_kind_agrees_with_designs_that_are_solved_anew() {
    for model in &MODELS {
        let mut file = with_measures(model);
        let (first, last) = (file.model.times[0], *file.model.times.last().unwrap());
        file.model.times = (0..=12).map(|k| first + (last - first) * (f64::from(k) + 0.13) / 13.0).collect();
        let analysis = Analysis::new(&file.model).unwrap();
        let solution = analysis.run();
        let report = verify(&analysis, &solution, &VerifyOptions::default(), |_| ControlFlow::Continue(()));
        assert!(report.passed(), "{}: {:#?}", model.0, report.checks);
        assert!(report.checks.iter().filter_map(|c| c.worst()).any(|worst| worst.error > 0.0));
    }
}

#[test]
fn values_and_rates_are_those_of_what_they_are_made_of() {
    const H: f64 = 1e-4;
    for model in &MODELS {
        let mut file = with_measures(model);
        let last = *file.model.times.last().unwrap();
        let at: Vec<f64> = (1..9).map(|k| last * f64::from(k) / 9.0 + 0.0123).collect();
        file.model.times = at.iter().flat_map(|t| [t - H, *t, t + H]).collect();
        let solution = solved(&file);
        let index = |name: &str| solution.measured.index(&format!("own_{name}")).unwrap();
        let value = |name: &str, k: usize| solution.measured.value(k, index(name));
        for n in 0..at.len() {
            let k = 3 * n + 1;
            let close = |a: f64, b: f64, scale: f64, what: &str| {
                assert!((a - b).abs() < 1e-6 * (1.0 + scale.abs()), "{}: {what}: {a} {b}", model.0);
            };
            let [x, xdot, xddot] = value("x", k);
            close(value("v", k)[0], xdot, xdot, "velocity");
            close(value("v", k)[1], xddot, xddot, "its rate");
            close(value("a", k)[0], xddot, xddot, "acceleration");
            close(value("xdot", k)[0], xdot, xdot, "rate of a position");
            close(value("turning", k)[0], value("about", k)[1], value("about", k)[1], "rate of an angle");
            let about = value("about", k)[0];
            close(value("mixed", k)[0], x * about.sin() + 2.0 * x, x, "formula");
            for name in ["mu", "between", "about", "x", "mixed"] {
                let rate = (value(name, k + 1)[0] - value(name, k - 1)[0]) / (2.0 * H);
                close(value(name, k)[1], rate, value(name, k)[2], name);
            }
            assert!((0.0..=std::f64::consts::FRAC_PI_2).contains(&value("mu", k)[0]));
        }
        // A length by an angle's sine is a length; a velocity by an acceleration is neither.
        let dimension = |name: &str| solution.measured.outputs[index(name)].dimension;
        assert_eq!(dimension("mixed"), hardpoint::model::Dimension::LENGTH);
        assert_eq!((dimension("power").length, dimension("power").time), (2, -3));
        assert_eq!(solution.measured.outputs[index("power")].known.orders, 1);
    }
}

/// A circle's curvature is one by its radius, to the left where it is run through counter-clockwise.
#[test]
fn a_crank_pin_runs_on_a_circle() {
    let text = r#"
        name = "crank"
        units = { length = "mm", angle = "deg" }
        hardpoints = { O = [0, 0, 0], A = [0, 80, 0] }
        bodies = { crank = {} }
        joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
        drivers.motor = { joint = "pivot", law = "30*sin(t)" }
        design.A_y = { move = "A", along = "y" }
        points.A = { body = "crank", at = "A" }
        measures.k = { type = "curvature", point = "A" }
        measures.left = { type = "curvature", point = "A", about = "z" }
        time = { at = [0, 1, 1.5707963267948966, 2] }
    "#;
    let solution = solved(&parse(text, "crank.toml").unwrap());
    let value = |name: &str, k| solution.measured.value(k, solution.measured.index(name).unwrap())[0];
    for (k, left) in [(0, 12.5), (1, 12.5), (3, -12.5)] {
        assert!((value("k", k) - 12.5).abs() < 1e-9 && (value("left", k) - left).abs() < 1e-9, "{k}");
        let d =
            solution.measured.d(k, hardpoint::model::VariableId(0), solution.measured.index("k").unwrap())[0];
        assert!((d + 12.5 * 12.5).abs() < 1e-6, "{d}");
    }
    // Where it turns back it rests: its path has no curvature there, and none is made up.
    assert!(value("k", 2).is_nan() && value("left", 2).is_nan());
}

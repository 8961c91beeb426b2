//! Measures of every kind on several mechanisms: rates against differences over time, sensitivities against designs
//! that are solved anew, and values by formulas.

use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::model::{DriverId, Model, VariableId};
use hardpoint::motion::Execution;
use hardpoint::space::Vec3;
use hardpoint::{Analysis, Solution};
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::verify::{self, verify};

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

[measures.omega]
type = "angular_velocity"
body = "FRAMES1"
along = [0.1, 0.2, 1]

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

[forces.own_bush]
type = "bushing"
from = { body = "FRAMES0", at = "POINTS2" }
to = { body = "FRAMES1", at = "POINTS2" }
x = 1
y = 1
z = 1
about_z = 1

[measures.turn]
type = "deflection"
force = "own_bush"
direction = "about_z"
"#;

/// Per model: a moving body and the next one, and three of its hardpoints: one end, the joint between them, the other
/// end.
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
    for measure in
        ["mu", "between", "about", "v", "omega", "a", "x", "xdot", "turning", "mixed", "power", "turn"]
    {
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
        let report = verify(&analysis, &solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
        assert!(report.passed(), "{}: {:#?}", model.0, report.checks);
        assert!(report.checks.iter().filter_map(|c| c.worst()).any(|worst| worst.error > 0.0));
    }
}

#[test]
fn expressions_have_the_values_and_rates_of_their_operands() {
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
            let turning = solution.body(k, file.model.body(model.1[1]).unwrap());
            let n = Vec3::new(0.1, 0.2, 1.0).unit().unwrap();
            let [omega, alpha, _] = value("omega", k);
            close(omega, n.dot(turning.omega), omega, "angular velocity");
            close(alpha, n.dot(turning.alpha), alpha, "angular acceleration");
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
        let d = solution.measured.d(k, VariableId(0), solution.measured.index("k").unwrap())[0];
        assert!((d + 12.5 * 12.5).abs() < 1e-6, "{d}");
    }
    // Where it turns back it is at rest: the curvature of its path is undefined there, in every execution mode.
    assert!(value("k", 2).is_nan() && value("left", 2).is_nan());
    on_every_path("crank", &parse(text, "crank.toml").unwrap().model, 1e-9);
}

/// Holds the measures of two solutions against each other: the same numbers are none, and the others differ by less
/// than this part of the largest of their kind.
fn assert_same(name: &str, a: &Solution, b: &Solution, limit: f64) {
    let (a, b) = (&a.measured, &b.measured);
    assert_eq!((a.len(), a.outputs.len(), a.variables), (b.len(), b.outputs.len(), b.variables), "{name}");
    for m in 0..a.outputs.len() {
        for by in (0..=a.variables).map(|v| (v < a.variables).then_some(VariableId(v))) {
            let at =
                |s: &hardpoint::measure::MeasureResults, k: usize| by.map_or(s.value(k, m), |v| s.d(k, v, m));
            for order in 0..3 {
                let pairs = || (0..a.len()).map(|k| [at(a, k)[order], at(b, k)[order]]);
                let largest = pairs().fold(1e-3, |most: f64, [_, y]| most.max(y.abs()));
                for (k, [x, y]) in pairs().enumerate() {
                    let agrees = x.is_nan() && y.is_nan() || (x - y).abs() <= limit * largest;
                    let output = &a.outputs[m].name;
                    assert!(agrees, "{name}: {output}, order {order} by {by:?} at {k}: {x} {y}");
                }
            }
        }
    }
}

/// Compares all execution modes; returns the number of outputs and times at which formulas were evaluated singly by
/// code, and the total number.
fn on_every_path(name: &str, model: &Model, limit: f64) -> [usize; 2] {
    let solve = |execution| Analysis::new(model).unwrap().executed(execution).run();
    let right = solve(Execution::Kernel);
    let all = right.measured.len() * right.measured.outputs.len();
    assert_eq!(right.measured.by_formula(), all, "{name}");
    let [tape, code] = [Execution::Interpreted, Execution::Compiled].map(solve);
    assert_same(name, &tape, &right, limit);
    assert_same(name, &code, &right, limit);
    assert_eq!(tape.measured.by_formula(), code.measured.by_formula(), "{name}");
    [code.measured.by_formula(), all]
}

#[test]
fn every_kind_is_the_same_by_a_program() {
    for model in &MODELS {
        let mut file = with_measures(model);
        let last = *file.model.times.last().unwrap();
        file.model.times = (0..=211).map(|k| last * f64::from(k) / 211.0).collect();
        let [by_formula, all] = on_every_path(model.0, &file.model, 1e-9);
        // What depends on a driver that moves alone is left to the formulas.
        let slopes = file.model.measures.iter().filter(|m| m.name.starts_with("bump")).count();
        println!("{}: {by_formula} of {all}, {slopes}", model.0);
        assert!(by_formula * file.model.measures.len() <= all * file.model.measures.len() / 2, "{}", model.0);
    }
}

const CRANK: &str = r#"
    name = "crank"
    units = { length = "m", angle = "rad" }
    hardpoints = { O = [0, 0, 0], A = [1, 0, 0] }
    bodies = { crank = {} }
    joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
    points.A = { body = "crank", at = "A" }
"#;

/// Formulas over angles depend on their whole turns, and where there is no number, there is none on any path.
#[test]
fn turns_and_poles_are_the_same_by_a_program() {
    let text = CRANK.to_owned()
        + r#"
        drivers.motor = { joint = "pivot", law = "0.3*t + 6*sin(t)" }
        design.A_x = { move = "A", along = "x" }
        design.O_y = { move = "O", along = "y" }
        measures.angle = { type = "coordinate", joint = "pivot" }
        measures.square = { type = "expression", expression = "angle^2 + A.x" }
        measures.spiral = { type = "expression", expression = "sin(square/10) + angle" }
        measures.faster = { type = "rate", of = "square" }
        measures.off = { type = "distance", from = { body = "ground", at = [0, 1, 0] }, to = "A" }
        measures.less = { type = "expression", expression = "min(off, 1)" }
        measures.aside = { type = "expression", expression = "abs(A.y)" }
        measures.pole = { type = "expression", expression = "1/A.y" }
        measures.pace = { type = "velocity", point = "A" }
        measures.yaw = { type = "orientation", body = "crank", angle = "yaw" }
        measures.cardan = { type = "orientation", body = "ground", angle = "cardan_3", relative_to = "crank" }
        measures.pitch = { type = "orientation", body = "crank", angle = "pitch" }
        measures.euler = { type = "orientation", body = "crank", angle = "euler_1" }
        measures.lines = { type = "transmission_angle", from = { body = "crank", axis = [0, 1, 0] }, to = [1, 0, 0] }
        time = { end = 20, steps = 1000 }
    "#;
    let model = parse(&text, "crank.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let [by_formula, all] = on_every_path("crank", &model, 1e-9);
    let solution = Analysis::new(&model).unwrap().run();
    let value = |name: &str, k| solution.measured.value(k, solution.measured.index(name).unwrap());
    // The pin begins on the x axis, where aside of it has two sides; later it has made more than one turn.
    assert!(value("pole", 0)[0].is_nan() && value("pole", 1)[0].is_finite());
    assert!(value("aside", 0)[1] > 6.0, "{:?}", value("aside", 0));
    let turns = (0..=1000).map(|k| value("angle", k)[0]).fold(0.0, f64::max) / std::f64::consts::TAU;
    assert!(turns > 1.5, "{turns}");
    for k in 0..=1000 {
        let angle = value("angle", k)[0];
        assert!((value("square", k)[0] - angle * angle - angle.cos()).abs() < 1e-9, "{k}");
        assert!((value("faster", k)[0] - value("square", k)[1]).abs() < 1e-9, "{k}");
        // All turns are about z: a body against another one turns the other way, and Euler's first and last angle are
        // not distinguished.
        assert!(
            (value("yaw", k)[0] - angle).abs() < 1e-9 && (value("cardan", k)[0] + angle).abs() < 1e-9,
            "{k}"
        );
        assert!(value("pitch", k)[0].abs() < 1e-12 && value("euler", k)[0].is_nan(), "{k}");
    }
    // min, the poles and an angle that does not exist depend on formulas; all else does not.
    let outputs = solution.measured.outputs.len();
    let least = all / outputs;
    assert!((2 * least..3 * least).contains(&by_formula), "{by_formula} of {all}");
}

/// Variables and outputs without end would make a program without end; none at all make one with nothing to do.
#[test]
fn a_program_of_measures_is_bounded() {
    let crank = |variables: usize, points: usize, times: &str| {
        let mut text = CRANK.to_owned();
        text += "drivers.motor = { joint = \"pivot\", law = \"t\" }\n";
        (0..variables).for_each(|v| text += &format!("design.x{v} = {{ move = \"O\", along = \"x\" }}\n"));
        (0..points)
            .for_each(|p| text += &format!("points.p{p} = {{ body = \"crank\", at = [{p}, 1, 0] }}\n"));
        text += &format!("time = {{ {times} }}\n");
        parse(&text, "crank.toml").unwrap_or_else(|e| panic!("{e}")).model
    };
    for (variables, points) in [(0, 0), (0, 3), (3, 0), (5, 20)] {
        for times in ["at = [0]", "end = 1, steps = 100", "end = 1, steps = 104"] {
            let [by_formula, _] = on_every_path("crank", &crank(variables, points, times), 1e-11);
            assert_eq!(by_formula, 0, "{variables} {points} {times}");
        }
    }
    let [by_formula, all] = on_every_path("long", &crank(140, 49, "end = 1, steps = 100"), 1e-11);
    assert_eq!(by_formula, all);
}

/// Remainder of a rate without the contributions of the drivers, relative to the largest of all.
const PARTS_OF_A_RATE: f64 = 1e-9;

#[test]
fn slopes_by_single_drivers_add_up_to_the_rates() {
    for name in ["macpherson", "front_axle", "double_wishbone", "delta", "excavator", "gear_train"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.toml"));
        let file = parse(&std::fs::read_to_string(&path).unwrap(), name).unwrap();
        let model = &file.model;
        let analysis = Analysis::new(model).unwrap();
        let run = analysis.run();
        let drivers: Vec<DriverId> = (0..model.drivers.len()).map(DriverId).collect();
        let alone = analysis.driver_rates(&drivers);
        assert_eq!(alone.times, run.motion.times, "{name}");
        let mut compared = 0;
        for (m, output) in
            alone.outputs.iter().enumerate().filter(|(_, o)| o.known.by_position && o.known.orders > 1)
        {
            let rate = |k: usize| run.measured.value(k, m)[1];
            let largest = (0..run.motion.len()).map(|k| rate(k).abs()).fold(1e-3, f64::max);
            // The Ackermann ratio of wheels that stand straight ahead is none.
            for k in (0..run.motion.len()).filter(|k| rate(*k).is_finite()) {
                // y. = sum over the drivers of (dy/dq) q.
                let speed = |d: usize| model.drivers[d].law.at(alone.times[k]).d();
                let parts = (0..drivers.len()).map(|d| alone.value(k, d, m).unwrap() * speed(d));
                let left = (parts.sum::<f64>() - rate(k)).abs() / largest;
                assert!(
                    left < PARTS_OF_A_RATE,
                    "{name}: {:?} at t = {}: {left}",
                    output.source,
                    alone.times[k]
                );
                compared += 1;
            }
        }
        assert!(compared > run.motion.len(), "{name} has nothing to compare");
    }
}

/// Three pins through one point, each on the body before it: their angles are those of the last body.
fn gimbal([a, b, c]: [&str; 3], [one, two, three]: [&str; 3], frame: &str) -> ModelFile {
    parse(
        &format!(
            r#"
name = "gimbal"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ O = [10, 20, 30] }}
bodies = {{ outer = {{}}, middle = {{}}, inner = {{ {frame} }} }}
[joints]
one = {{ type = "revolute", bodies = ["ground", "outer"], at = "O", axis = "{a}" }}
two = {{ type = "revolute", bodies = ["outer", "middle"], at = "O", axis = "{b}" }}
three = {{ type = "revolute", bodies = ["middle", "inner"], at = "O", axis = "{c}" }}
[drivers]
one = {{ joint = "one", law = "{one}" }}
two = {{ joint = "two", law = "{two}" }}
three = {{ joint = "three", law = "{three}" }}
[measures]
euler_1 = {{ type = "orientation", body = "inner", angle = "euler_1" }}
euler_2 = {{ type = "orientation", body = "inner", angle = "euler_2" }}
euler_3 = {{ type = "orientation", body = "inner", angle = "euler_3" }}
cardan_1 = {{ type = "orientation", body = "inner", angle = "cardan_1" }}
cardan_2 = {{ type = "orientation", body = "inner", angle = "cardan_2" }}
cardan_3 = {{ type = "orientation", body = "inner", angle = "cardan_3" }}
roll = {{ type = "orientation", body = "inner", angle = "roll" }}
pitch = {{ type = "orientation", body = "inner", angle = "pitch" }}
yaw = {{ type = "orientation", body = "inner", angle = "yaw" }}
[time]
end = 1
steps = 40
"#
        ),
        "gimbal.toml",
    )
    .unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn angles_of_a_gimbal_are_those_of_its_pins() {
    for (axes, measures) in [
        (["z", "x", "z"], ["euler_1", "euler_2", "euler_3"]),
        (["x", "y", "z"], ["cardan_1", "cardan_2", "cardan_3"]),
        (["z", "y", "x"], ["yaw", "pitch", "roll"]),
    ] {
        let solution = solved(&gimbal(axes, ["20 + 400*t", "30 + 40*t", "-500*t^2"], ""));
        for k in 0..solution.motion.len() {
            let t = solution.motion.times[k];
            let laws = [
                [20.0 + 400.0 * t, 400.0, 0.0],
                [30.0 + 40.0 * t, 40.0, 0.0],
                [-500.0 * t * t, -1000.0 * t, -1000.0],
            ];
            for (name, law) in measures.iter().zip(laws) {
                let found = solution.measured.value(k, solution.measured.index(name).unwrap());
                for order in 0..3 {
                    let (x, y) = (found[order].to_degrees(), law[order]);
                    assert!((x - y).abs() < 1e-8, "{name} order {order} at {t}: {x} {y}");
                }
            }
        }
    }
}

#[test]
fn a_body_has_the_angles_that_its_frame_is_given_by() {
    for (key, measures) in [
        ("euler", ["euler_1", "euler_2", "euler_3"]),
        ("cardan", ["cardan_1", "cardan_2", "cardan_3"]),
        ("roll_pitch_yaw", ["roll", "pitch", "yaw"]),
    ] {
        let frame = format!("frame = {{ position = [0, 0, 0], {key} = [17, 41, -23] }}");
        let solution = solved(&gimbal(["z", "y", "x"], ["0"; 3], &frame));
        for (name, expected) in measures.iter().zip([17.0, 41.0, -23.0]) {
            let found = solution.measured.value(0, solution.measured.index(name).unwrap())[0].to_degrees();
            assert!((found - expected).abs() < 1e-10, "{name}: {found} {expected}");
        }
    }
}

#[test]
fn angles_of_orientations_agree_with_designs_that_are_solved_anew() {
    let all = ["euler_1", "euler_2", "euler_3", "cardan_1", "cardan_2", "cardan_3", "roll", "pitch", "yaw"];
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/macpherson.toml");
    let mut text = std::fs::read_to_string(path).unwrap();
    for (body, more) in [("lca", ""), ("strut", "relative_to = \"lca\"\n")] {
        for name in all {
            text += &format!(
                "[measures.own_{body}_{name}]\ntype = \"orientation\"\nbody = \"{body}\"\nangle = \"{name}\"\n{more}"
            );
        }
    }
    let mut file = parse(&text, "measures.toml").unwrap_or_else(|e| panic!("{e}"));
    let (first, last) = (file.model.times[0], *file.model.times.last().unwrap());
    file.model.times = (0..=12).map(|k| first + (last - first) * (f64::from(k) + 0.13) / 13.0).collect();
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let report = verify(&analysis, &solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
    assert!(report.passed(), "{:#?}", report.checks);
    for name in all.iter().flat_map(|name| [format!("own_lca_{name}"), format!("own_strut_{name}")]) {
        let m = solution.measured.index(&name).unwrap();
        let felt = |order: usize| {
            let d = |v| solution.measured.d(5, VariableId(v), m)[order].abs();
            (0..file.model.variables.len()).map(d).fold(0.0, f64::max)
        };
        assert!((0..3).all(|order| felt(order) > 1e-4), "{name} does not follow the design");
    }
}

/// A slide moves along (0.3, 0.7, 0.2), and a wheel on it does not rise.
#[test]
fn a_slope_over_a_measure_that_does_not_move_has_no_value() {
    for steps in [4, 200] {
        let text = format!(
            r#"
name = "slope"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [10, 20, 30], C = [0, 700, 300] }}
bodies = {{ s = {{}}, w = {{}} }}
points.P = {{ body = "s", at = [13, 24, 37] }}
time = {{ end = 1, steps = {steps} }}
design.lean = {{ tilt = "j", about = "z" }}
[joints]
j = {{ type = "translational", bodies = ["ground", "s"], at = "A", axis = [0.3, 0.7, 0.2] }}
k = {{ type = "translational", bodies = ["ground", "w"], at = "C", axis = [0.3, 0.7, 0] }}
[drivers]
d = {{ joint = "j", law = "10*t" }}
e = {{ joint = "k", law = "10*t" }}
[wheels.w]
body = "w"
centre = "C"
radius = 300
spin_axis = [0.1, 1, 0.2]
bump = "e"
[measures]
along = {{ type = "position", point = "P", along = [0.3, 0.7, 0.2] }}
x = {{ type = "position", point = "P", along = "x" }}
over = {{ type = "position", point = "P", along = [0.7, -0.3, 0] }}
over_2 = {{ type = "position", point = "P", along = [0.2, 0, -0.3] }}
over_3 = {{ type = "position", point = "P", along = [0.1, -0.1, 0.2] }}
moving = {{ type = "slope", of = "x", over = "along", driver = "d" }}
still = {{ type = "slope", of = "x", over = "over", driver = "d" }}
still_2 = {{ type = "slope", of = "x", over = "over_2", driver = "d" }}
still_3 = {{ type = "slope", of = "x", over = "over_3", driver = "d" }}
recession = {{ type = "bump_recession", wheel = "w" }}
"#
        );
        let file = parse(&text, "slope.toml").unwrap_or_else(|e| panic!("{e}"));
        let solution = Analysis::new(&file.model).unwrap().run();
        for (m, output) in solution.measured.outputs.iter().enumerate() {
            for k in 0..solution.motion.len() {
                let found = (solution.measured.value(k, m)[0], solution.measured.d(k, VariableId(0), m)[0]);
                match output.name.as_str() {
                    // x = 0.3 s / L,  along = s,  with L^2 = 0.62
                    "moving" => assert!((found.0 - 0.3 / 0.62_f64.sqrt()).abs() < 1e-12, "{found:?}"),
                    "recession" => assert!(found.0.is_nan() && found.1.is_nan(), "{found:?}"),
                    name if name.starts_with("still") => {
                        assert!(found.0.is_nan() && found.1.is_nan(), "{name}: {found:?}");
                    }
                    name => assert!(found.0.is_finite() && found.1.is_finite(), "{name}: {found:?}"),
                }
            }
        }
    }
}

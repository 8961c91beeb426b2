//! Design variables that change several things at once: shapes of bodies beside drivers, and turns of one joint.

use hardpoint::model::VariableId;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::{ModelFile, parse};

/// Values and derivatives against closed forms and other texts of the same model, relative: round-off of short motions.
const SAME: f64 = 1e-11;

fn read(text: &str) -> ModelFile {
    parse(text, "design.toml").unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn solved(file: &ModelFile, design: &[f64]) -> Solution {
    let solution = Analysis::new(&file.model).unwrap().solve(Run::new().at(design));
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    solution
}

fn value(solution: &Solution, k: usize, name: &str) -> f64 {
    solution.measured.value(k, solution.measured.index(name).unwrap())[0]
}

fn slope(solution: &Solution, k: usize, name: &str, variable: usize) -> f64 {
    solution.measured.d(k, VariableId(variable), solution.measured.index(name).unwrap())[0]
}

fn near(found: f64, expected: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(error <= SAME * (1.0 + expected.abs()), "{what}: {found} instead of {expected}");
}

/// An actuator from the frame pushes an arm of length r: `L^2 = r^2 + g^2 - 2 r g cos(angle - gamma)`.
#[test]
fn the_shape_of_an_arm_takes_the_end_of_its_actuator_along_and_leaves_the_other() {
    let file = read(
        r#"
name = "arm with an actuator"
units = { length = "mm", angle = "deg" }
hardpoints = { A = [0, 0, 0] }
bodies = { arm = {} }
time = { at = [0, 0.5, 1] }
[joints]
hinge = { type = "revolute", bodies = ["ground", "arm"], at = "A", axis = "z" }
[drivers.actuator]
from = { body = "ground", at = [100, -80, 0] }
to = { body = "arm", at = [100, 0, 0] }
counted_from = "zero"
law = "80 + 10*t"
[design]
longer = { shape = "arm", field = { scale = "A" } }
[measures]
angle = { type = "coordinate", joint = "hinge" }
stroke = { type = "distance", from = { body = "ground", at = [100, -80, 0] }, to = { body = "arm", at = [100, 0, 0] } }
"#,
    );
    let solution = solved(&file, &[]);
    let (r, g) = (0.1, f64::hypot(0.1, 0.08));
    for (k, t) in file.model.times.iter().enumerate() {
        let length = 0.08 + 0.01 * t;
        let u = (r * r + g * g - length * length) / (2.0 * r * g);
        let du = (r * r - g * g + length * length) / (2.0 * r * r * g);
        near(value(&solution, k, "angle"), u.acos() + f64::atan2(-0.08, 0.1), "angle");
        near(slope(&solution, k, "angle", 0), -r * du / (1.0 - u * u).sqrt(), "d angle / d longer");
        near(slope(&solution, k, "stroke", 0), 0.0, "d stroke / d longer");
    }
}

#[test]
fn the_shape_of_a_body_leaves_the_drivers_of_others_alone() {
    let text = |base: &str| {
        format!(
            r#"
name = "two arms that share nothing"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0], B = [300, 0, 0] }}
bodies = {{ one = {{}}, two = {{}} }}
time = {{ at = [0, 0.5, 1] }}
[joints]
a = {{ type = "revolute", bodies = ["ground", "one"], at = "A", axis = "z" }}
b = {{ type = "revolute", bodies = ["ground", "two"], at = "B", axis = "z" }}
[drivers]
first = {{ joint = "a", law = "10*t" }}
second = {{ body = "two", about = "z", relative_to = "{base}", law = "20*t" }}
[design]
shift = {{ shape = "one", field = {{ translate = "x" }} }}
[points]
tip = {{ body = "two", at = [300, 100, 0] }}
"#
        )
    };
    for base in ["one", "ground"] {
        let file = read(&text(base));
        let solution = solved(&file, &[]);
        for k in 0..3 {
            near(slope(&solution, k, "tip.x", 0), 0.0, base);
        }
    }
}

/// A rod's end follows the body that it is on.
#[test]
fn the_shape_of_a_body_moves_its_ends_of_rods_alone() {
    let file = read(
        r#"
name = "four-bar with a massless rod"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { A = [0, 0], B = [0, 40], C = [120, 70], D = [120, 0] }
bodies = { crank = ["A", "B"], rocker = ["C", "D"] }
time = { at = [0, 1] }
[joints]
A = { type = "revolute", bodies = ["ground", "crank"], at = "A" }
D = { type = "revolute", bodies = ["ground", "rocker"], at = "D" }
rod = { type = "distance", bodies = ["crank", "rocker"], at = ["B", "C"] }
[drivers]
m = { joint = "A", law = "20*t" }
[design]
longer = { shape = "crank", field = { scale = "A" } }
b = { move = "B", along = "y" }
[measures]
psi = { type = "coordinate", joint = "D" }
"#,
    );
    let solution = solved(&file, &[]);
    near(slope(&solution, 1, "psi", 0), 0.04 * slope(&solution, 1, "psi", 1), "B moves alone");
    assert!(slope(&solution, 1, "psi", 0).abs() > 1e-3);
}

#[test]
fn several_tilts_of_a_joint_do_not_depend_on_their_order() {
    let tilts = [
        r#"a = { tilt = "hinge", about = "x" }"#,
        r#"b = { tilt = "hinge", about = [1, 2, -1] }"#,
        r#"c = { tilt = "hinge", about = "z" }"#,
    ];
    let text = |order: [usize; 3]| {
        format!(
            r#"
name = "hinge"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0] }}
bodies = {{ arm = {{}} }}
time = {{ at = [0, 1] }}
joints.hinge = {{ type = "revolute", bodies = ["ground", "arm"], at = "A", axis = [1, 2, 3] }}
drivers.motor = {{ joint = "hinge", law = "70*t" }}
points.P = {{ body = "arm", at = [100, 20, -5] }}
[design]
{}
"#,
            order.map(|k| tilts[k]).join("\n")
        )
    };
    let by = [0.08, -0.05, 0.09];
    let found: Vec<[f64; 12]> = [[0, 1, 2], [2, 1, 0], [1, 0, 2]]
        .into_iter()
        .map(|order| {
            let solution = solved(&read(&text(order)), &order.map(|k| by[k]));
            let outputs = ["P.x", "P.y", "P.z"];
            let place = |k: usize| order.iter().position(|o| *o == k).unwrap();
            let values = outputs.map(|name| value(&solution, 1, name));
            let slopes = [0, 1, 2].map(|k| outputs.map(|name| slope(&solution, 1, name, place(k))));
            std::array::from_fn(|n| if n < 3 { values[n] } else { slopes[n / 3 - 1][n % 3] })
        })
        .collect();
    for other in &found[1..] {
        for (a, b) in found[0].iter().zip(other) {
            near(*b, *a, "another order");
        }
    }
}

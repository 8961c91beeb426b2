//! Angles of elastic joints: drivers, couplers and springs on a joint whose axis tilts, turns of more than half a turn,
//! prestress, and directions that nothing holds.

use hardpoint::model::Model;
use hardpoint::motion::StopKind;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Solution};
use hardpoint_file::parse;

use crate::equilibrium::verify_all;

/// Numbers of two ways to the same equilibrium, relative: Newton's method ends at round-off.
const SAME: f64 = 1e-9;

fn model(text: &str) -> Model {
    parse(text, "elastic.toml").unwrap_or_else(|e| panic!("{e}\n{text}")).model
}

fn solved_by(text: &str, formulation: Formulation) -> Solution {
    let solution = Analysis::with(&model(text), formulation).unwrap().run();
    assert!(solution.stop.is_none(), "{:?}\n{text}", solution.stop);
    solution
}

fn solved(text: &str) -> Solution {
    solved_by(text, Formulation::Relative)
}

fn value(solution: &Solution, k: usize, name: &str) -> f64 {
    let m = solution.measured.index(name).unwrap_or_else(|| panic!("{name}"));
    solution.measured.value(k, m)[0]
}

fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(error <= tolerance * (1.0 + expected.abs()), "{what}: {found} instead of {expected}");
}

/// An arm on two elastic joints, J and K, under a force and a moment that tilt J by some 5 deg, with these loads on J.
fn arm(cut: [bool; 2], joint: &str, acts: &str) -> String {
    let [j, k] = cut;
    format!(
        r#"
name = "arm"
units = {{ length = "mm", angle = "deg" }}
[hardpoints]
A = [10, 20, 30]
B = [310, 60, 90]
C = [300, -40, 200]
[bodies]
arm = {{}}
rotor = {{}}
[points]
b = {{ body = "arm", at = "B" }}
[equilibrium]
[time]
end = 1
steps = 4
[joints]
J = {{ {joint}, bodies = ["ground", "arm"], at = "A", cut = {j} }}
K = {{ type = "fixed", axis = "z", axis2 = "x", bodies = ["ground", "arm"], at = "C", cut = {k} }}
R = {{ type = "revolute", axis = "z", axis2 = "x", bodies = ["ground", "rotor"], at = [0, 0, 500] }}
[forces]
f = {{ type = "force", at = "b", force = 270, along = [1, 2, -3], law = "t" }}
g = {{ type = "moment", body = "arm", moment = 45, about = [1, -1, 0], law = "t" }}
e2 = {{ type = "elastic_joint", joint = "K", x = 80, y = 70, z = 50, about_x = 6, about_y = 7, about_z = 6 }}
{acts}
[measures]
angle = {{ type = "coordinate", joint = "J", coordinate = "angle" }}
x = {{ type = "reaction", joint = "J", part = "force_x" }}
moment = {{ type = "reaction", joint = "K", part = "moment_z" }}
load = {{ type = "driver_force", driver = "d" }}
[design]
A = {{ move = "A", along = "xyz" }}
B = {{ move = "B", along = "z" }}
axis = {{ tilt = "J", about = "x" }}
"#
    )
}

const HINGE: &str = r#"type = "revolute", axis = "z", axis2 = "x""#;
const GIVES: &str =
    r#"e = { type = "elastic_joint", joint = "J", x = 800, y = 700, z = 500, about_x = 16, about_y = 17 }"#;
const CROSS: &str = r#"type = "universal", axis = "z", axis2 = "x""#;
const CROSS_GIVES: &str =
    r#"e = { type = "elastic_joint", joint = "J", x = 800, y = 700, z = 500, about_y = 17 }"#;
const IDLE: &str = "r = { joint = \"R\", law = \"0\" }\n";

/// Drivers, couplers and springs on the angle of J.
fn actions() -> Vec<(&'static str, String)> {
    let drivers = |of: &str| format!("[drivers]\n{of}");
    let driven = drivers(&format!("d = {{ joint = \"J\", coordinate = \"angle\", law = \"5*t\" }}\n{IDLE}"));
    let second = driven.replace("\"angle\"", "\"angle2\"");
    let on_rotor = drivers("d = { joint = \"R\", law = \"-5*t\" }\n");
    let gear = r#"{ type = "gear", joints = ["J", "R"], teeth = [10, 20] }"#;
    let spring = "s = { type = \"torsion_spring\", joint = \"J\", stiffness = 30, equilibrium = 4 }\n";
    vec![
        (HINGE, format!("{GIVES}\n{driven}")),
        (HINGE, format!("{GIVES}\n{on_rotor}[couplers]\nc = {gear}\n")),
        (HINGE, format!("{GIVES}\n{spring}{on_rotor}")),
        (CROSS, format!("{CROSS_GIVES}\n{driven}")),
        (CROSS, format!("{CROSS_GIVES}\n{second}")),
        (CROSS, format!("{}, about_x = 16, about_z = 12 }}\n{on_rotor}", CROSS_GIVES.trim_end_matches(" }"))),
    ]
}

#[test]
fn a_driver_a_gear_or_a_spring_on_a_tilting_joint_is_the_same_whichever_joint_is_cut() {
    for (joint, acts) in actions() {
        let first = solved(&arm([false, true], joint, &acts));
        let others = [
            solved(&arm([true, false], joint, &acts)),
            solved_by(&arm([false, true], joint, &acts), Formulation::Absolute),
        ];
        for k in 0..5 {
            for name in ["b.x", "b.y", "b.z", "angle", "x", "moment", "load"] {
                let expected = value(&first, k, name);
                for other in &others {
                    near(value(other, k, name), expected, SAME, &format!("{name} of {joint} {acts}"));
                }
            }
        }
        if acts.contains("coordinate = \"angle\", law") {
            // The measure of a driven coordinate is its law.
            near(value(&first, 4, "angle"), 5_f64.to_radians(), 1e-12, "law");
        }
    }
}

#[test]
fn sensitivities_of_angles_of_tilting_joints_are_verified() {
    for (joint, acts) in actions() {
        for cut in [[false, true], [true, false]] {
            verify_all(&model(&arm(cut, joint, &acts)));
        }
    }
}

/// By an independent program: full coordinates with Lagrange multipliers, gradients by complex steps, the angle of the
/// elastic hinge as the last Cardan angle.
#[test]
fn moments_on_a_tilting_joint_are_those_of_an_independent_program() {
    let of = |k: usize, force: &str, moment: &str| {
        let (joint, acts) = actions().swap_remove(k);
        solved(&arm([true, false], joint, &acts).replace("force = 270", force).replace("moment = 45", moment))
    };
    let driven = of(0, "force = 270", "moment = 45");
    near(value(&driven, 4, "load"), 186.894_294_667_911, SAME, "driver");
    near(value(&driven, 4, "b.x"), 0.304_539_461_244_766, SAME, "driver");
    let geared = of(1, "force = 500", "moment = 60");
    near(value(&geared, 4, "load"), -812.966_800_332_185, SAME, "gear");
    near(value(&geared, 4, "b.z"), 0.108_810_846_381_940, SAME, "gear");
}

/// An arm on an elastic hinge that tilts, with a spring about its axis.
fn hinged(spring: &str) -> String {
    format!(
        r#"
name = "hinged"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0], B = [300, 60, 0], C = [200, -100, 50] }}
[bodies]
arm = {{}}
[joints]
J = {{ type = "revolute", bodies = ["ground", "arm"], at = "A", axis = "z", axis2 = "x" }}
[points]
b = {{ body = "arm", at = "B" }}
c = {{ body = "arm", at = "C" }}
[forces]
e = {{ type = "elastic_joint", joint = "J", x = 800, y = 800, z = 800, about_x = 30, about_y = 20 }}
s = {{ {spring} }}
f = {{ type = "force", at = "b", force = 800, along = [1, 2, -2], law = "t" }}
[equilibrium]
[measures]
bx = {{ type = "position", point = "b", along = "x" }}
cz = {{ type = "position", point = "c", along = "z" }}
c1 = {{ type = "compliance", of = "bx", at = "c", along = "z" }}
c2 = {{ type = "compliance", of = "cz", at = "b", along = "x" }}
angle = {{ type = "coordinate", joint = "J" }}
[time]
end = 1
steps = 4
"#
    )
}

#[test]
fn a_torsion_spring_on_a_tilting_joint_has_a_potential_and_is_the_elastic_joint_about_its_axis() {
    let spring = solved(&hinged(r#"type = "torsion_spring", joint = "J", stiffness = 15"#));
    let elastic = solved(&hinged(r#"type = "elastic_joint", joint = "J", about_z = 15"#));
    for k in 1..5 {
        // Maxwell and Betti: displacements by forces are symmetric.
        let [c1, c2] = ["c1", "c2"].map(|name| value(&spring, k, name));
        assert!((c1 - c2).abs() <= SAME * c1.abs() && c1.abs() > 1e-8, "{c1} {c2}");
        for name in ["b.x", "b.y", "b.z", "angle", "c1"] {
            near(value(&spring, k, name), value(&elastic, k, name), SAME, name);
        }
    }
}

/// A body on an elastic cross with pins along z and x.
fn on_cross(forces: &str) -> String {
    format!(
        r#"
name = "cross"
units = {{ length = "mm", angle = "deg" }}
bodies = {{ b = {{}} }}
joints = {{ u = {{ type = "universal", bodies = ["ground", "b"], at = [0, 0, 0], axis = "z", axis2 = "x" }} }}
points = {{ p = {{ body = "b", at = [200, 80, -50] }} }}
[equilibrium]
[measures]
a1 = {{ type = "coordinate", joint = "u", coordinate = "angle" }}
a2 = {{ type = "coordinate", joint = "u", coordinate = "angle2" }}
px = {{ type = "position", point = "p", along = "x" }}
[time]
at = [0, 0.5, 1]
[forces]
{forces}
"#
    )
}

#[test]
fn an_elastic_cross_deflects_about_its_pins() {
    let moment = r#"M = { type = "moment", body = "b", moment = 5, about = [3, 0, 4], law = "t" }"#;
    let elastic = |keys: &str| {
        let own =
            format!("e = {{ type = \"elastic_joint\", joint = \"u\", about_x = 0.2, about_z = 0.24{keys} }}");
        solved(&on_cross(&format!("{own}\n{moment}")))
    };
    let springs = solved(&on_cross(&format!(
        r#"
s = {{ type = "torsion_spring", joint = "u", coordinate = "angle2", stiffness = 0.2 }}
r = {{ type = "torsion_spring", joint = "u", coordinate = "angle", stiffness = 0.24 }}
{moment}
"#
    )));
    // M_z over the stiffness of the first pin; the part of M_x along the second pin, which it turns.
    let of = |about_x: f64, about_z: f64| {
        let first = (4.0 / about_z).to_radians();
        [first, (3.0 * first.cos() / about_x).to_radians()]
    };
    let [first, second] = of(0.2, 0.24);
    let rigid = elastic("");
    let stiff = elastic(", x = 1e7, y = 1e7, z = 1e7, about_y = 1e7");
    for (a, expected) in [("a1", first), ("a2", second)] {
        near(value(&rigid, 2, a), expected, SAME, a);
        near(value(&springs, 2, a), expected, SAME, a);
        // The turn between the pins is some 1e-7 deg.
        near(value(&stiff, 2, a), expected, 1e-7, a);
    }
    let half = r#"e = { type = "elastic_joint", joint = "u", about_x = 0.1, about_z = 0.12 }"#;
    let half = solved(&on_cross(&format!("{half}\n{moment}")));
    for (a, expected) in ["a1", "a2"].into_iter().zip(of(0.1, 0.12)) {
        near(value(&half, 2, a), expected, SAME, a);
    }
}

#[test]
fn an_elastic_cross_has_the_potential_of_its_own_angles() {
    let forces = r#"
e = { type = "elastic_joint", joint = "u", x = 50, y = 40, z = 60, about_x = 0.6, about_y = 0.9, about_z = 0.8, matrix = MATRIX }
f = { type = "force", at = "p", force = 100, along = [1, 2, -2], law = "t" }
"#;
    let zero = "[0, 0, 0, 0, 0, 0]";
    let matrix = format!("[{zero}, {zero}, {zero}, [0, 0, 0, 0, 0, 0.2], {zero}, [0, 0, 0, 0.2, 0, 0]]");
    let text = on_cross(&forces.replace("MATRIX", &matrix));
    // By an independent program, which minimises the energy over displacements and turns about z, y and x.
    let expected = [0.170_915_416_991_558, 0.111_050_175_332_088, -0.090_277_310_115_299];
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let solution = solved_by(&text, formulation);
        for (name, expected) in ["p.x", "p.y", "p.z"].into_iter().zip(expected) {
            near(value(&solution, 2, name), expected, SAME, name);
        }
        near(value(&solution, 2, "a1"), 10.957_793_156_944_75_f64.to_radians(), SAME, "a1");
        near(value(&solution, 2, "a2"), -5.312_173_963_718_845_f64.to_radians(), SAME, "a2");
    }
    let with_design = format!("{text}[design]\np = {{ move = \"p\", along = \"xyz\" }}\n").replace(
        "points = { p = { body = \"b\", at = [200, 80, -50] } }",
        "hardpoints = { p = [200, 80, -50] }\npoints = { p = { body = \"b\", at = \"p\" } }",
    );
    verify_all(&model(&with_design));
}

#[test]
fn the_pins_of_a_cross_are_rigid_where_nothing_gives_between_them() {
    let elastic = r#"e = { type = "elastic_joint", joint = "u", about_x = 0.2, about_z = 0.24 }"#;
    let drivers = r#"
[drivers]
d1 = { joint = "u", coordinate = "angle", law = "30" }
d2 = { joint = "u", coordinate = "angle2", law = "20" }
"#;
    let compliance = r#"c = { type = "compliance", of = "px", at = "p", along = "y" }"#;
    let text = on_cross(elastic)
        .replace("[equilibrium]", drivers)
        .replace("[measures]", &format!("[measures]\n{compliance}"));
    let solution = solved(&text);
    for k in 0..3 {
        assert_eq!(value(&solution, k, "c"), 0.0);
    }
}

#[test]
fn an_elastic_constant_velocity_joint_that_is_cut_keeps_its_constraint() {
    let joint = r#"type = "constant_velocity", axis = [1, 0.2, 0.1], axis2 = [1, -0.3, 0.2]"#;
    let acts = format!(
        "e = {{ type = \"elastic_joint\", joint = \"J\", x = 700, y = 700, z = 500, about_x = 7, about_y = 7 }}\n\
         [drivers]\n{}",
        IDLE.replace("r =", "d =")
    );
    let text = |cut: [bool; 2]| {
        let tilt = "axis = { tilt = \"J\", about = \"x\" }\n";
        arm(cut, joint, &acts)
            .replace(
                "\"coordinate\", joint = \"J\", coordinate = \"angle\"",
                "\"position\", point = \"b\", along = \"x\"",
            )
            .replace(tilt, "")
    };
    let texts = [text([false, true]), text([true, false])];
    let [first, second] = texts.each_ref().map(|text| solved(text));
    for k in 0..5 {
        for name in ["b.x", "b.y", "b.z", "x", "moment"] {
            near(value(&second, k, name), value(&first, k, name), SAME, name);
        }
    }
    verify_all(&model(&texts[0]));
}

#[test]
fn elastic_moments_count_whole_turns() {
    let text = |forces: &str, equilibrium: &str, more: &str| {
        format!(
            r#"
name = "turns"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0], B = [300, 0, 0] }}
bodies = {{ arm = {{}} }}
joints = {{ J = {{ type = "revolute", axis = "z", axis2 = "x", bodies = ["ground", "arm"], at = "A"{more} }} }}
points = {{ b = {{ body = "arm", at = "B" }} }}
drivers = {{ d = {{ joint = "J", law = "400*t" }} }}
time = {{ end = 1, steps = 8 }}
measures = {{ load = {{ type = "driver_force", driver = "d" }} }}
{equilibrium}
[forces]
{forces}
"#
        )
    };
    let elastic = r#"e = { type = "elastic_joint", joint = "J", x = 1000, y = 1000, about_z = 0.5 }"#;
    let rest = r#"e = { type = "elastic_joint", joint = "J", x = 1000, y = 1000 }"#;
    let bushing =
        r#"u = { type = "bushing", from = { body = "ground", at = "A" }, to = { body = "arm", at = "A" },
    x = 1, y = 1, z = 1, about_z = 0.5 }"#
            .replace('\n', "");
    let both = format!("{rest}\n{bushing}");
    let cross = text(elastic, "[equilibrium]", "")
        .replace("\"revolute\"", "\"universal\"")
        .replace("law =", "coordinate = \"angle\", law =");
    let held = "s = { type = \"torsion_spring\", joint = \"J\", coordinate = \"angle2\", stiffness = 1 }\n";
    let solution = solved(&format!("{cross}{held}"));
    for k in 0..=8 {
        near(value(&solution, k, "load"), 25.0 * k as f64, 1e-9, &format!("cross {k}"));
    }
    for (forces, equilibrium, more) in [
        (elastic, "[equilibrium]", ""),
        (&both, "[equilibrium]", ""),
        (&bushing, "", ""),
        (&bushing, "", ", cut = true"),
    ] {
        let solution = solved(&text(forces, equilibrium, more));
        for k in 0..=8 {
            // 0.5 N m/deg times the angle
            near(value(&solution, k, "load"), 25.0 * k as f64, 1e-9, &format!("{forces} {equilibrium} {k}"));
        }
    }
}

#[test]
fn what_nothing_holds_is_named_for_axes_of_any_direction() {
    let axes = [
        [2.12, -1.11, -0.38],
        [0.3, 0.4, 0.5],
        [-1.0, 2.0, 0.7],
        [1.0, 1.0, 1.0],
        [0.1, -0.9, 3.0],
        [5.0, 0.2, -0.3],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
    ];
    for [x, y, z] in axes {
        for law in ["0", "1", "t"] {
            let text = format!(
                r#"
name = "free"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [10.1, 20.2, 30.3], B = [310.7, 60.2, 90.3] }}
bodies = {{ arm = {{}} }}
points = {{ b = {{ body = "arm", at = "B" }} }}
time = {{ end = 1, steps = 2 }}
[joints]
J = {{ type = "revolute", axis = [{x}, {y}, {z}], axis2 = [{y}, {}, 0.0], bodies = ["ground", "arm"], at = "A" }}
[forces]
e = {{ type = "elastic_joint", joint = "J", x = 800, y = 800, z = 500 }}
f = {{ type = "force", at = "b", force = 900, along = [1, 2, -3], law = "{law}" }}
[equilibrium]
"#,
                -x - 0.01 * z
            );
            let model = model(&text);
            let stop = Analysis::new(&model).unwrap().run().stop.unwrap_or_else(|| panic!("{text}"));
            assert!(matches!(stop.kind, StopKind::NothingHolds { .. }), "{law} {stop:?}");
        }
    }
}

/// A strut whose coil pushes with 1000 N in the design configuration.
fn strut(coil: &str) -> String {
    format!(
        r#"
name = "strut"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0], B = [300, 0, 0], T = [250, 0, 300] }}
bodies = {{ arm = {{}} }}
joints = {{ J = {{ type = "revolute", axis = "y", axis2 = "x", bodies = ["ground", "arm"], at = "A" }} }}
points = {{ b = {{ body = "arm", at = "B" }} }}
time = {{ end = 1, steps = 1 }}
[forces]
e = {{ type = "elastic_joint", joint = "J", x = 1000, y = 1000, z = 1000, about_x = 5, about_y = 5, about_z = 5 }}
coil = {{ type = "spring", from = {{ body = "ground", at = "T" }}, to = {{ body = "arm", at = [250, 0, 0] }}, {coil} }}
[equilibrium]
"#
    )
}

#[test]
fn a_prestress_grows_with_the_loads_however_it_is_given() {
    // The height by an independent program, which minimises the energy.
    for coil in [
        "stiffness = 30, preload = -1000",
        "stiffness = 30, free_length = 333.3333333333333",
        "free_length = 300, compression = [[-300, -8000], [0, 1000], [300, 10000]]",
    ] {
        near(value(&solved(&strut(coil)), 0, "b.z"), -0.034_650_485, 1e-8, coil);
    }
}

#[test]
fn the_direction_that_becomes_unstable_is_the_one_whose_stiffness_vanishes() {
    let text = |about: f64| {
        format!(
            r#"
name = "column"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0], B = [300, 0, 0] }}
bodies = {{ arm = {{}} }}
joints = {{ J = {{ type = "fixed", bodies = ["ground", "arm"], at = "A", axis = "z", axis2 = "x" }} }}
points = {{ b = {{ body = "arm", at = "B" }} }}
time = {{ end = 1, steps = 2 }}
[forces]
e = {{ type = "elastic_joint", joint = "J", about_z = {about}, y = 100 }}
s = {{ type = "spring", from = {{ body = "ground", at = [-100, 0, 0] }}, to = {{ body = "arm", at = "A" }}, stiffness = 1, preload = -20000 }}
[equilibrium]
"#
        )
    };
    for about in [0.5, 5.0, 50.0] {
        let model = model(&text(about));
        let stop = Analysis::new(&model).unwrap().run().stop.unwrap();
        let headline = stop.headline(&model);
        assert!(headline.contains("along y") || headline.contains("along joint `J` along y"), "{headline}");
    }
}

/// A spring of 1 N m/deg winds up by 270 deg, an elastic joint by 800 deg, and a driver turns by 800 deg beside them.
const WINDING: &str = r#"
name = "winding"
units = { length = "mm", angle = "deg" }
bodies = { arm = {}, wheel = {}, post = {}, disc = {}, rotor = {} }
[joints]
hinge = { type = "revolute", bodies = ["ground", "arm"], at = [0, 0, 0], axis = "z" }
axle = { type = "revolute", bodies = ["ground", "wheel"], at = [300, 0, 0], axis = "z" }
mount = { type = "fixed", bodies = ["ground", "post"], at = [0, 500, 0], axis = "z", axis2 = "x" }
shaft = { type = "revolute", bodies = ["ground", "disc"], at = [0, 900, 0], axis = "z" }
pivot = { type = "revolute", bodies = ["disc", "rotor"], at = [0, 900, 0], axis = "z" }
[couplers]
gear = { type = "gear", joints = ["hinge", "axle"], teeth = [20, 40] }
[drivers]
motor = { joint = "shaft", law = "800*t" }
[forces]
spring = { type = "torsion_spring", joint = "hinge", stiffness = 1 }
torque = { type = "moment", body = "arm", moment = 270, about = "z", law = "t" }
elastic = { type = "elastic_joint", joint = "mount", about_z = 1 }
twist = { type = "moment", body = "post", moment = 800, about = "z", law = "t" }
coil = { type = "torsion_spring", joint = "pivot", stiffness = 1 }
[equilibrium]
[measures]
hinge = { type = "coordinate", joint = "hinge" }
axle = { type = "coordinate", joint = "axle" }
arm = { type = "angle", from = [1, 0, 0], to = { body = "arm", axis = "x" }, about = "z" }
force = { type = "spring_force", force = "spring" }
post = { type = "angle", from = [1, 0, 0], to = { body = "post", axis = "x" }, about = "z" }
shaft = { type = "coordinate", joint = "shaft" }
disc = { type = "angle", from = [1, 0, 0], to = { body = "disc", axis = "x" }, about = "z" }
[time]
"#;

#[test]
fn angles_in_equilibrium_are_counted_through_whole_turns_for_any_output_times() {
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        for times in
            ["at = [1]", "at = [0, 1]", "at = [0, 0.5, 1]", "end = 1\nsteps = 3", "end = 1\nsteps = 40"]
        {
            let solution = solved_by(&format!("{WINDING}{times}\n"), formulation);
            let last = solution.motion.len() - 1;
            for (name, degrees) in [
                ("hinge", 270.0),
                ("axle", -135.0),
                ("arm", 270.0),
                ("post", 800.0),
                ("shaft", 800.0),
                ("disc", 800.0),
            ] {
                let what = format!("{name} at {times}, {formulation:?}");
                near(value(&solution, last, name).to_degrees(), degrees, SAME, &what);
            }
            near(value(&solution, last, "force"), -270.0, SAME, times);
        }
    }
}

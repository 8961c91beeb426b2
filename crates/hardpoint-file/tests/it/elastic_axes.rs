//! Axes, reactions and slopes of elastic joints: what must not depend on how a model lies, balances of forces, and
//! differences of neighbouring output times.

use std::path::Path;

use hardpoint::joint::{self, JointType, Need};
use hardpoint::model::{Model, VariableId};
use hardpoint::space::{Mat3, Vec3};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Solution};
use hardpoint_file::parse;

use crate::bushings::snapshot_all;
use crate::equilibrium::verify_all;

/// Positions and forces of the same model in another place, relative to the largest.
const SAME: f64 = 1e-10;
/// The same where any x axis serves: with equal stiffnesses about x and y, moments differ by a part of the square of
/// the tilt, which is 0.1 rad here.
const SAME_BUT_TILT: f64 = 1e-4;
/// Round-off of the balance of a body's forces, relative to the largest.
const BALANCE: f64 = 1e-9;
/// Forces on joints of stiffness 1e7 N/mm instead of rigid ones, relative: the deflections are 2e-4 mm, by which the
/// spring's force changes by 1e-2 N of 2 kN.
const NEARLY_RIGID: f64 = 1e-5;
/// Error of the second order of central differences over 1/400 of the travel, relative to the slope.
const DIFFERENCES: f64 = 1e-4;

/// Components of a reaction.
const PARTS: [&str; 6] = ["force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"];

fn model_of(text: &str) -> Model {
    parse(text, "elastic.toml").unwrap_or_else(|e| panic!("{e}\n{text}")).model
}

fn solved_by(model: &Model, formulation: Formulation) -> Solution {
    let solution = Analysis::with(model, formulation).unwrap().run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    solution
}

fn solved(text: &str) -> Solution {
    solved_by(&model_of(text), Formulation::Relative)
}

fn value(solution: &Solution, k: usize, name: &str) -> f64 {
    let m = solution.measured.index(name).unwrap_or_else(|| panic!("{name}"));
    solution.measured.value(k, m)[0]
}

fn faults(text: &str) -> String {
    parse(text, "elastic.toml").err().map_or("none".into(), |e| e.to_string())
}

/// Joint types that an elastic joint can name.
fn elastic_types() -> impl Iterator<Item = &'static JointType> {
    joint::ALL.iter().copied().filter(|kind| kind.freedoms.is_some() && kind.places == 1)
}

/// A body on ground by an elastic joint of a type, the whole model turned by `rot`, under a force and a moment.
fn on_elastic_joint(kind: &JointType, rot: Mat3, has_axis2: bool) -> String {
    let vector = |x: f64, y: f64, z: f64| {
        let v = rot * Vec3::new(x, y, z);
        format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
    };
    let axis = match kind.axis {
        Need::Unused => String::new(),
        Need::Required | Need::Optional | Need::OnBodyJ | Need::Orienting => {
            format!(", axis = {}", vector(1.0, 0.501, 0.5))
        }
    };
    let axis2 = match kind.axis2 {
        Need::Unused => String::new(),
        Need::Required => format!(", axis2 = {}", vector(0.0, 0.5, -0.501)),
        Need::OnBodyJ => format!(", axis2 = {}", vector(1.0, 0.6, 0.4)),
        Need::Optional | Need::Orienting if !has_axis2 => String::new(),
        Need::Optional => format!(", axis2 = {}", vector(0.0, 0.5, -0.501)),
        Need::Orienting => format!(", axis2 = {}", vector(0.3, 0.9, -0.2)),
    };
    let lead = if kind.has_lead() { ", lead = 0.02" } else { "" };
    // The second shaft of a joint whose `axis2` is on body j leaves the x axis open.
    let (y, about_y) = if kind.axis2 == Need::OnBodyJ { (1000, 100) } else { (4000, 150) };
    // A screw moves along and about its axis by its lead, against a spring, and a constant-velocity joint has no twist.
    let (along, spring) = match (kind.has_lead(), kind.name) {
        (true, _) => (
            "",
            "coil = { type = \"torsion_spring\", joint = \"j\", coordinate = \"angle\", stiffness = 70 }",
        ),
        (false, "constant_velocity") => (", z = 2000", ""),
        (false, _) => (", z = 2000, about_z = 70", ""),
    };
    format!(
        r#"
name = "turned"
units = {{ length = "m", angle = "rad" }}
[hardpoints]
o = {o}
p = {p}
[bodies]
b = {{}}
[joints]
j = {{ type = "{kind}", bodies = ["ground", "b"], at = "o"{axis}{axis2}{lead} }}
[points]
p = {{ body = "b", at = "p" }}
[forces]
soft = {{ type = "elastic_joint", joint = "j", x = 1000, y = {y}, about_x = 100, about_y = {about_y}{along} }}
{spring}
push = {{ type = "force", at = "p", force = 30, along = {push} }}
twist = {{ type = "moment", body = "b", moment = 2, about = {twist} }}
[equilibrium]
[measures]
force = {{ type = "reaction", joint = "j", part = "force" }}
moment = {{ type = "reaction", joint = "j", part = "moment" }}
[time]
at = [0]
"#,
        o = vector(0.1, 0.2, 0.3),
        p = vector(0.5, 0.1, 0.25),
        kind = kind.name,
        push = vector(0.4, 1.0, -0.7),
        twist = vector(0.2, -0.5, 1.0),
    )
}

#[test]
fn the_whole_model_turned_gives_the_same_answer() {
    let turns = [
        Mat3::IDENTITY,
        Mat3::between(Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.6, 0.0, 0.8)),
        Mat3::between(Vec3::new(1.0, 0.0, 0.0), Vec3::new(-0.28, 0.96, 0.0)),
    ];
    let mut tested = 0;
    for kind in elastic_types() {
        let of = |rot: Mat3| {
            let solution = solved(&on_elastic_joint(kind, rot, true));
            let at = ["p.x", "p.y", "p.z"].map(|name| value(&solution, 0, name));
            let p = rot.transpose() * Vec3::new(at[0], at[1], at[2]);
            [p.x, p.y, p.z, value(&solution, 0, "force"), value(&solution, 0, "moment")]
        };
        let first = of(turns[0]);
        let same = if kind.axis2 == Need::OnBodyJ { SAME_BUT_TILT } else { SAME };
        let moved = (Vec3::new(first[0], first[1], first[2]) - Vec3::new(0.5, 0.1, 0.25)).norm();
        assert!(moved > 1e-3 && first[3] > 1.0, "{}: {first:?}", kind.name);
        for rot in &turns[1..] {
            let found = of(*rot);
            for (a, b) in first.iter().zip(found) {
                assert!((a - b).abs() <= same * (1.0 + a.abs()), "{}: {first:?} {found:?}", kind.name);
            }
        }
        tested += 1;
    }
    assert!(tested >= 10, "{tested}");
}

/// Directions of an elastic joint with a stiffness of each, N/mm and N m/deg.
const STIFFNESSES: [&str; 6] = ["x = 900", "y = 700", "z = 500", "about_x = 2", "about_y = 4", "about_z = 3"];

/// A body on ground by a joint of a type that is elastic in these directions, held where it moves freely.
fn held_freely(kind: &JointType, directions: &[usize], equilibrium: bool) -> String {
    let axis = match kind.axis {
        Need::Unused => "",
        Need::Required | Need::Optional | Need::OnBodyJ | Need::Orienting => ", axis = \"z\"",
    };
    let axis2 = match kind.axis2 {
        Need::Unused => "",
        Need::OnBodyJ => ", axis2 = \"z\"",
        Need::Required | Need::Optional | Need::Orienting => ", axis2 = \"x\"",
    };
    let lead = if kind.has_lead() { ", lead = 10" } else { "" };
    let mut drivers = String::new();
    for c in kind.coordinates {
        if !(kind.has_lead() && c.name == "displacement") {
            drivers += &format!("d_{0} = {{ joint = \"j\", coordinate = \"{0}\", law = 0 }}\n", c.name);
        }
    }
    let turns: &[&str] = match kind.name {
        "spherical" | "inline" | "inplane" => &["x", "y", "z"],
        "constant_velocity" => &["x", "y"],
        _ => &[],
    };
    for about in turns {
        drivers += &format!("t_{about} = {{ body = \"b\", about = \"{about}\", law = 0 }}\n");
    }
    let stiffnesses: Vec<&str> = directions.iter().map(|d| STIFFNESSES[*d]).collect();
    let mut measures = String::new();
    for of in ["x", "y", "z"] {
        for along in ["x", "y", "z"] {
            measures += &format!(
                "c_{of}{along} = {{ type = \"compliance\", of = \"p.{of}\", at = \"p\", along = \"{along}\" }}\n"
            );
        }
    }
    format!(
        r#"
name = "held"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ o = [0, 0, 0], p = [30, 40, 50] }}
bodies = {{ b = {{}} }}
joints.j = {{ type = "{kind}", bodies = ["ground", "b"], at = "o"{axis}{axis2}{lead} }}
points.p = {{ body = "b", at = "p" }}
design.p = {{ move = "p", along = "xyz" }}
time = {{ at = [0] }}
[drivers]
{drivers}[forces]
soft = {{ type = "elastic_joint", joint = "j", {stiffnesses} }}
[measures]
{measures}{equilibrium}"#,
        kind = kind.name,
        stiffnesses = stiffnesses.join(", "),
        equilibrium = if equilibrium { "[equilibrium]\n" } else { "" },
    )
}

#[test]
fn compliances_of_every_elastic_type_are_those_at_equilibrium() {
    let (mut compared, mut refused) = (0, 0);
    for kind in elastic_types().filter(|kind| kind.name != "fixed") {
        let even = kind.axis2 == Need::OnBodyJ;
        for directions in [&[0][..], &[1], &[2], &[3], &[4], &[5], &[0, 1, 2, 3, 4, 5]] {
            let at_equilibrium = held_freely(kind, directions, true);
            // The x axis of a joint whose second axis is on body j is open, as for any stiffness that differs about it.
            if even && directions.iter().any(|d| !matches!(d, 2 | 5)) {
                continue;
            }
            let text = faults(&at_equilibrium);
            if text.contains("HP0261") {
                assert!(kind.has_lead() || kind.name == "constant_velocity", "{}: {text}", kind.name);
                refused += 1;
                continue;
            }
            let [first, second] =
                [held_freely(kind, directions, false), at_equilibrium].map(|text| solved(&text));
            for m in 0..9 {
                let of = |solution: &Solution, k: usize| match k {
                    0 => solution.measured.value(0, m)[0],
                    k => solution.measured.derivative(0, VariableId(k - 1), m, 0),
                };
                for k in 0..4 {
                    let (a, b) = (of(&first, k), of(&second, k));
                    // Compliances are below 1e-3 m/N, and 1e-2 1/N per metre.
                    assert!((a - b).abs() <= SAME * 1e-3, "{} {directions:?} {m} {k}: {a} {b}", kind.name);
                }
            }
            compared += 1;
        }
    }
    assert!(compared > 60 && refused == 4, "{compared} {refused}");
}

/// With the arm's driver released.
const AT_EQUILIBRIUM: &str = "[equilibrium]\nreleased = [\"bump\"]\n";

#[test]
fn a_stiffness_against_the_motion_of_a_joint_is_that_of_a_spring() {
    let text = |forces: &str, equilibrium: &str| {
        let released = if equilibrium.is_empty() { ", released = \"bump\"" } else { "" };
        format!(
            r#"
name = "arm"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0], P = [0, 400, 0] }}
bodies = {{ arm = {{}} }}
joints.pivot = {{ type = "revolute", bodies = ["ground", "arm"], at = "A", axis = "x", axis2 = "y" }}
drivers.bump = {{ point = "wheel", along = "z", law = 0 }}
points.wheel = {{ body = "arm", at = "P" }}
design.P = {{ move = "P", along = "xyz" }}
time = {{ at = [0] }}
measures.rate = {{ type = "compliance", of = "wheel.z", at = "wheel", along = "z"{released} }}
[forces]
coil = {{ type = "spring", from = {{ body = "ground", at = [0, 400, 300] }}, to = {{ body = "arm", at = "P" }}, stiffness = 5 }}
{forces}
{equilibrium}"#
        )
    };
    let rate = |forces: &str, equilibrium: &str| {
        let solution = solved(&text(forces, equilibrium));
        std::array::from_fn(|k| match k {
            0 => value(&solution, 0, "rate"),
            k => solution.measured.derivative(
                0,
                VariableId(k - 1),
                solution.measured.index("rate").unwrap(),
                0,
            ),
        })
    };
    let same = |a: [f64; 4], b: [f64; 4], what: &str| {
        for (a, b) in a.into_iter().zip(b) {
            assert!((a - b).abs() <= 1e-9 * (1e-4 + a.abs()), "{what}: {a} {b}");
        }
    };
    let bush =
        "bush = { type = \"elastic_joint\", joint = \"pivot\", x = 3000, y = 3000, z = 3000, about_z = 20 }";
    let found = rate(bush, "");
    // The arm turns against the coil and 20 N m/deg on 400 mm, in series with 3000 N/mm.
    let torsional = 20.0 * 180.0 / std::f64::consts::PI * 1e3 / (400.0 * 400.0);
    let expected = 1e-3 / (5.0 + 1.0 / (1.0 / 3000.0 + 1.0 / torsional));
    assert!((found[0] - expected).abs() < 1e-9 * expected, "{found:?} {expected}");
    same(found, rate(bush, AT_EQUILIBRIUM), "equilibrium");
    let spring = bush.replace(", about_z = 20", "")
        + "\ncoil2 = { type = \"torsion_spring\", joint = \"pivot\", stiffness = 20 }";
    same(found, rate(&spring, ""), "spring");
    // An entry beside the diagonal, between turning and opening, N/rad.
    let coupled = bush.replace(
        ", about_z = 20",
        ", about_z = 20, matrix = [[0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0]]",
    );
    same(found, rate(&coupled, ""), "zeros");
    let entry = |v: &str| {
        let row = |k: usize| {
            let entry = |c: usize| if k.min(c) == 1 && k.max(c) == 5 { v } else { "0" };
            format!("[{}]", (0..6).map(entry).collect::<Vec<_>>().join(", "))
        };
        let rows: Vec<String> = (0..6).map(row).collect();
        bush.replace("about_z = 20", &format!("about_z = 20, matrix = [{}]", rows.join(", ")))
    };
    let coupled = rate(&entry("1000"), "");
    assert!((coupled[0] - found[0]).abs() > 1e-3 * found[0], "{coupled:?}");
    same(coupled, rate(&entry("1000"), AT_EQUILIBRIUM), "coupled");
}

#[test]
fn elastic_joints_rest_in_the_design_configuration_without_loads() {
    for kind in elastic_types() {
        let loaded = on_elastic_joint(kind, Mat3::IDENTITY, true);
        let is_load = |line: &&str| line.starts_with("push") || line.starts_with("twist");
        let text: String = loaded.lines().filter(|l| !is_load(l)).map(|l| format!("{l}\n")).collect();
        let model = model_of(&text);
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            let solution = solved_by(&model, formulation);
            for (name, at) in ["p.x", "p.y", "p.z"].into_iter().zip([0.5, 0.1, 0.25]) {
                let found = value(&solution, 0, name);
                assert!((found - at).abs() <= SAME, "{}: {name} {found}", kind.name);
            }
            for name in ["force", "moment"] {
                // Of stiffnesses of 1e3 N/m.
                assert!(value(&solution, 0, name).abs() <= 1e3 * SAME, "{}: {name}", kind.name);
            }
        }
    }
}

#[test]
fn axes_that_differ_need_their_directions() {
    for kind in elastic_types() {
        let text = on_elastic_joint(kind, Mat3::IDENTITY, false);
        let found = faults(&text);
        let is_free = [Need::Optional, Need::Orienting].contains(&kind.axis2);
        assert_eq!(found.contains("the x and y axes of `soft` differ"), is_free, "{}: {found}", kind.name);
        let even = text.replace("y = 4000", "y = 1000").replace("about_y = 150", "about_y = 100");
        assert_eq!(faults(&even), "none", "{}", kind.name);
    }
    let fixed = elastic_types().find(|kind| kind.name == "revolute").unwrap();
    let even = on_elastic_joint(fixed, Mat3::IDENTITY, false)
        .replace("y = 4000", "y = 1000")
        .replace("about_y = 150", "about_y = 100")
        .replace("[hardpoints]", "[parameters]\nk = 1000\n[hardpoints]");
    for change in [
        // The same number in this design, but not in others.
        ("x = 1000", "x = \"k\""),
        ("x = 1000", "x = 1000, cubic_x = 5, cubic_y = 5"),
        ("x = 1000", "x = 1000, preload_x = 5"),
        ("x = 1000", "x = 1000, curve_y = [[-1, -5], [1, 5]]"),
    ] {
        let found = faults(&even.replace(change.0, change.1));
        assert!(found.contains("the x and y axes of `soft` differ"), "{change:?}: {found}");
    }
    // Bushings at a distance along z: the same for every direction of x, until one entry has the other sign.
    let matrix = "[[0, 0, 0, 0, 90, 0], [0, 0, 0, -90, 0, 0], [0, 0, 0, 0, 0, 0], [0, -90, 0, 9, 0, 0], \
                  [90, 0, 0, 0, 9, 0], [0, 0, 0, 0, 0, 0]]";
    let round = even.replace("x = 1000", &format!("matrix = {matrix}, x = 1000"));
    assert_eq!(faults(&round), "none");
    let turned = round.replace("-90", "90");
    assert!(faults(&turned).contains("the x and y axes of `soft` differ"));
}

/// A body on an elastic joint with these stiffnesses.
fn held(kind: &str, keys: &str) -> String {
    format!(
        r#"
name = "held"
units = {{ length = "m", angle = "rad" }}
[hardpoints]
o = [0, 0, 0]
[bodies]
b = {{}}
[joints]
j = {{ type = "{kind}", bodies = ["ground", "b"], at = "o" }}
[points]
o = {{ body = "b", at = "o" }}
[forces]
soft = {{ type = "elastic_joint", joint = "j", {keys} }}
f = {{ type = "force", at = "o", force = 100, along = "x" }}
[equilibrium]
[time]
at = [0]
"#
    )
}

#[test]
fn forces_in_rigid_directions_are_reported() {
    let coupled = "[[100, 0, 0, 0, 3, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], \
                   [3, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0]]";
    let texts = [
        held("fixed", "y = 100, cubic_x = 100, preload_z = 50, preload_about_x = 3"),
        held("fixed", &format!("matrix = {coupled}")),
        held("fixed", "x = 0, curve_x = [[-1, -100], [1, 100]], y = 10"),
        held("fixed", "x = 0, y = 10"),
        held("revolute", "x = 100, y = 200")
            .replace("at = \"o\" }\n[points]", "at = \"o\", axis = \"z\" }\n[points]"),
        held("fixed", "x = 100").replace("at = \"o\" }\n[points]", "at = \"o\", axis2 = \"z\" }\n[points]"),
    ];
    let found: Vec<String> = texts.iter().map(|text| faults(text)).collect();
    snapshot_all("elastic_axes_faults", &found);
    // A preload about a free axis is a moment that acts.
    let free = held("revolute", "x = 100, y = 100, about_z = 20, preload_about_z = 3")
        .replace("at = \"o\" }\n[points]", "at = \"o\", axis = \"z\" }\n[points]");
    assert_eq!(faults(&free), "none");
}

#[test]
fn a_cubic_stiffness_beside_a_stiffness_has_its_closed_form() {
    // 100 e + 100 e^3 = 100
    let solution = solved(&held("fixed", "x = 100, cubic_x = 100"));
    let e = value(&solution, 0, "o.x");
    assert!((e + e * e * e - 1.0).abs() < 1e-12, "{e}");
}

/// A body under a moment of this size about an axis, held by `joints` and a force element.
fn turned(k: usize, moment: f64, joints: &str, element: &str) -> String {
    let (axis, at) = (["x", "y", "z"][k], ["[0, 1000, 0]", "[0, 0, 1000]", "[1000, 0, 0]"][k]);
    format!(
        r#"
name = "turned"
units = {{ length = "mm", angle = "deg" }}
parameters = {{ factor = 1.3, torque = 8 }}
bodies = {{ b = {{}} }}
{joints}
points = {{ p = {{ body = "b", at = {at} }} }}
[forces]
soft = {{ {element} }}
m = {{ type = "moment", body = "b", moment = {moment:?}, about = "{axis}" }}
[measures]
sine = {{ type = "position", point = "p", along = "{}" }}
[time]
at = [0]
"#,
        ["z", "x", "y"][k]
    )
}

#[test]
fn moments_over_an_angle_have_their_closed_form() {
    // 12 a + 0.03 a^3 + 1.3 C(a) = M, in N m and deg, with C(5) = 8: a point of the curve.
    let (a, of_curve) = (5.0, 8.0);
    let (stiffness, cubic, factor) = (12.0, 0.03, 1.3);
    let curve = "[[-10, -30], [0, 0], [5, \"torque\"], [12, \"6*torque + 2\"]]";
    // Fritsch and Butland: chords of 5 and 7 deg with slopes of 1.6 and 6.
    let slope = (19.0 + 17.0) / (19.0 / 1.6 + 17.0 / 6.0);
    for k in 0..3 {
        let axis = ["x", "y", "z"][k];
        let law = |others: f64| {
            let given = (0..3).filter(|other| *other != k);
            let given = given.map(|other| format!("about_{} = {others}, ", ["x", "y", "z"][other]));
            format!(
                "{}about_{axis} = 12, cubic_about_{axis} = 0.03, curve_about_{axis} = {curve}, scale_about_{axis} = \"factor\"",
                given.collect::<String>()
            )
        };
        let free = format!(
            "joints = {{ j = {{ type = \"revolute\", bodies = [\"ground\", \"b\"], at = [0, 0, 0], axis = \"{axis}\" }} }}\n\
             drivers = {{ d = {{ joint = \"j\", law = 0 }} }}\nequilibrium = {{ released = [\"d\"] }}"
        );
        let fixed = "joints = { j = { type = \"fixed\", bodies = [\"ground\", \"b\"], at = [0, 0, 0] } }\nequilibrium = {}";
        let ends = "from = { body = \"ground\", at = [0, 0, 0] }, to = { body = \"b\", at = [0, 0, 0] }";
        for (joints, element, cubic) in [
            (fixed, format!("type = \"elastic_joint\", joint = \"j\", {}", law(90.0)), cubic),
            (
                "equilibrium = {}",
                format!("type = \"bushing\", {ends}, x = 9, y = 9, z = 9, {}", law(90.0)),
                cubic,
            ),
            (
                free.as_str(),
                format!(
                    "type = \"torsion_spring\", joint = \"j\", stiffness = 12, curve = {curve}, scale = \"factor\""
                ),
                0.0,
            ),
        ] {
            let moment = stiffness * a + cubic * a * a * a + factor * of_curve;
            let model = model_of(&turned(k, moment, joints, &element));
            for formulation in [Formulation::Relative, Formulation::Absolute] {
                let solution = solved_by(&model, formulation);
                let sine = value(&solution, 0, "sine");
                assert!((sine - a.to_radians().sin()).abs() < 1e-12, "{element}: {sine}");
                // da/df = -C / (k + 3 k_3 a^2 + f C')
                // da/dC = -f / (k + 3 k_3 a^2 + f C')
                for (name, force) in [("factor", of_curve), ("torque", factor)] {
                    let turn = -force / (stiffness + 3.0 * cubic * a * a + factor * slope);
                    let expected = a.to_radians().cos() * turn.to_radians();
                    let m = solution.measured.index("sine").unwrap();
                    let found = solution.measured.d(0, model.variable(name).unwrap(), m)[0];
                    assert!(
                        (found - expected).abs() < 1e-10 * expected.abs(),
                        "{element}: {found} {expected}"
                    );
                }
            }
            verify_all(&model);
        }
    }
}

#[test]
fn curves_that_fall_are_reported_with_their_keys() {
    let remarks = |keys: &str| {
        let file = parse(&held("fixed", keys), "elastic.toml").unwrap_or_else(|e| panic!("{e}"));
        file.remarks.iter().map(|d| format!("{} {}", d.code, d.message)).collect::<Vec<_>>()
    };
    for (keys, expected) in [
        ("y = 10, curve_x = [[-1, 100], [1, -100]]", "`curve_x` of `soft` falls at zero deflection"),
        ("x = 90, curve_x = [[-1, 100], [1, -100]]", "`curve_x` of `soft` falls at zero deflection"),
        ("x = 90, curve_about_y = [[-1, 1], [1, -1]]", "`curve_about_y` of `soft` falls at zero deflection"),
        ("x = 90, scale_x = 2", "`soft` has a `scale_x`, but no `curve_x`"),
    ] {
        let found = faults(&held("fixed", keys));
        assert!(found.contains(expected), "{keys}: {found}");
    }
    assert!(remarks("x = 110, curve_x = [[-1, 100], [1, -100]]").is_empty());
    let beside = "curve_x = [[-2, -80], [-1, -100], [1, 100], [2, 80], [3, 60], [4, 70]]";
    assert_eq!(remarks(beside), ["HP0257 `curve_x` of `soft` falls with the deflection from -2 m to -1 m"]);
    assert!(remarks(&format!("x = 30, {beside}")).is_empty());
}

/// An arm on hinges `jf` and `jr`, elastic by these keys, with a spring and a load; `jr` is left out without keys.
fn arm([front, rear]: [&str; 2]) -> String {
    let joints: &[&str] = if rear.is_empty() { &["jf"] } else { &["jf", "jr"] };
    let (mut hinges, mut soft, mut measures) = (String::new(), String::new(), String::new());
    for (joint, keys) in joints.iter().zip([front, rear]) {
        hinges += &format!(
            "{joint} = {{ type = \"revolute\", bodies = [\"ground\", \"arm\"], at = \"{at}\", axis = {{ through = [\"f\", \"r\"] }}, axis2 = \"z\" }}\n",
            at = &joint[1..]
        );
        if !keys.is_empty() {
            soft += &format!("e{joint} = {{ type = \"elastic_joint\", joint = \"{joint}\", {keys} }}\n");
        }
        for part in PARTS {
            measures += &format!(
                "{joint}_{part} = {{ type = \"reaction\", joint = \"{joint}\", part = \"{part}\" }}\n"
            );
        }
    }
    format!(
        r#"
name = "arm"
units = {{ length = "mm", angle = "deg" }}
[parameters]
load = 2000
[hardpoints]
f = [150, 0, 0]
r = [-150, 0, 20]
t = [0, 350, -10]
s = [0, 200, 0]
u = [0, 180, 300]
[bodies]
arm = {{}}
[joints]
{hinges}[points]
t = {{ body = "arm", at = "t" }}
s = {{ body = "arm", at = "s" }}
f = {{ body = "arm", at = "f" }}
r = {{ body = "arm", at = "r" }}
[forces]
{soft}sp = {{ type = "spring", from = {{ body = "ground", at = "u" }}, to = "s", stiffness = 40 }}
l = {{ type = "force", at = "t", force = "load", along = [-1, 0.8, 0.6] }}
[equilibrium]
[design]
rear_y = {{ move = "r", along = "y" }}
tip_z = {{ move = "t", along = "z" }}
[measures]
{measures}sp = {{ type = "spring_force", force = "sp" }}
[time]
at = [0]
"#
    )
}

#[test]
fn reactions_of_elastic_joints_balance_the_body() {
    // One joint gives in all its directions; the other one is rigid along its axis, and about x and y.
    for soft in [
        [
            "x = 5000, y = 6000, z = 600, about_x = 900, about_y = 700, preload_z = 40, cubic_x = 3",
            "x = 5000, y = 6000, z = 600, about_x = 900, about_y = 800",
        ],
        ["x = 5000, y = 6000", "x = 5000, y = 6000, z = 600, about_x = 900, about_y = 800, about_z = 3"],
    ] {
        let model = model_of(&arm(soft));
        let found = solved_by(&model, Formulation::Relative);
        let vector = |names: [String; 3]| {
            let [x, y, z] = names.map(|name| value(&found, 0, &name));
            Vec3::new(x, y, z)
        };
        let at = |name: &str| vector(["x", "y", "z"].map(|axis| format!("{name}.{axis}")));
        let of =
            |joint: &str, what: &str| vector(["x", "y", "z"].map(|axis| format!("{joint}_{what}_{axis}")));
        let load = Vec3::new(-1.0, 0.8, 0.6).unit().unwrap() * 2000.0;
        let spring = (Vec3::new(0.0, 0.18, 0.3) - at("s")).unit().unwrap() * value(&found, 0, "sp");
        let [front, rear] = ["jf", "jr"].map(|joint| of(joint, "force"));
        assert!(front.norm() > 500.0 && rear.norm() > 500.0, "{front:?} {rear:?}");
        let sum = front + rear + load + spring;
        assert!(sum.norm() <= BALANCE * 2000.0, "{sum:?}");
        let mut about = of("jf", "moment") + of("jr", "moment");
        for (place, force) in [(at("f"), front), (at("r"), rear), (at("t"), load), (at("s"), spring)] {
            about += place.cross(force);
        }
        assert!(about.norm() <= BALANCE * 600.0, "{about:?}");
        assert_eq!(model.variables.len(), 3);
        verify_all(&model);
    }
}

#[test]
fn reactions_of_a_stiff_elastic_joint_are_those_of_a_rigid_one() {
    let rigid = solved(&arm(["", ""]));
    assert!(PARTS.iter().all(|part| value(&rigid, 0, &format!("jf_{part}")).abs() > 20.0));
    for soft in [
        "x = 1e7, y = 1.1e7, z = 1.2e7, about_x = 1e7, about_y = 1.1e7",
        "x = 1e7, y = 1.1e7",
        "about_x = 1e7",
    ] {
        let stiff = solved(&arm([soft, ""]));
        for part in PARTS {
            let [found, expected] = [&stiff, &rigid].map(|s| value(s, 0, &format!("jf_{part}")));
            assert!((found - expected).abs() <= NEARLY_RIGID * 2000.0, "{soft} {part}: {found} {expected}");
        }
    }
}

/// The template of a K&C rig with this many steps.
fn rig(steps: usize) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hardpoint-cli/templates/k-and-c.toml");
    std::fs::read_to_string(path).unwrap().replace("steps = 40", &format!("steps = {steps}"))
}

#[test]
fn slopes_of_drivers_that_move_together_are_differences_along_the_motion() {
    let model = model_of(&rig(400));
    let motions = model.motions();
    let mut found = Vec::new();
    for (case, measure) in
        [("parallel_travel", "left_steer_in_bump"), ("opposite_travel", "left_steer_in_roll")]
    {
        let number = model.cases.iter().position(|c| c.name == case).unwrap();
        let motion = Model { times: motions[number].times[195..=205].to_vec(), ..motions[number].clone() };
        let solution = solved_by(&motion, Formulation::Relative);
        let of = |k: usize, name: &str| value(&solution, k, name);
        for k in 1..10 {
            let change = |name: &str| of(k + 1, name) - of(k - 1, name);
            let slope = change("left.toe") / change("left.wheel_travel");
            let exact = of(k, measure);
            assert!((exact - slope).abs() <= DIFFERENCES * slope.abs(), "{case}: {exact} {slope}");
            // One wheel alone has another slope: the anti-roll bar couples both.
            assert!((of(k, "left.bump_steer") - slope).abs() > 0.01 * slope.abs(), "{case}");
            let mirrored = of(k, &measure.replace("left", "right"));
            let sign = if case == "parallel_travel" { 1.0 } else { 0.0 };
            assert!(
                sign * (mirrored - exact).abs() <= SAME * exact.abs().max(1.0),
                "{case}: {mirrored} {exact}"
            );
        }
        found.push(of(5, measure));
    }
    assert!((found[0] - found[1]).abs() > 0.1 * found[0].abs(), "{found:?}");
}

#[test]
fn slopes_of_drivers_that_move_together_have_exact_sensitivities() {
    let text = rig(2);
    let start = text.find("[cases.steer]").unwrap();
    let end = text.find("[design]").unwrap();
    let metrics = text.find("[metrics]").unwrap();
    let few = format!("{}{}", &text[..start], &text[end..metrics]);
    let model = model_of(&few);
    for motion in model.motions() {
        verify_all(&motion);
    }
    assert!(model.measures.iter().any(|m| m.name == "left_steer_in_roll"));
}

/// A point that turns and slides on a tube that swings: in the mirror the angle of a tube changes its sign, that of a
/// hinge does not.
const SWINGING: &str = r#"
name = "swinging"
units = { length = "m", angle = "rad" }
[mirror]
across = "y"
names = { left = "right" }
[hardpoints]
left_o = [0.1, 0.5, 0.2]
left_q = [0.4, 0.9, 0.3]
left_p = [0.6, 1.1, 0.7]
[bodies]
left_a = {}
left_b = {}
[joints]
left_hinge = { type = "revolute", bodies = ["ground", "left_a"], at = "left_o", axis = [0.3, 0.5, 0.8] }
left_tube = { type = "cylindrical", bodies = ["left_a", "left_b"], at = "left_q", axis = [0.2, 0.9, 0.4] }
[points]
left_p = { body = "left_b", at = "left_p" }
[drivers]
left_swing = { joint = "left_hinge", law = "0.2" }
left_turn = { joint = "left_tube", coordinate = "angle", law = "0.1" }
left_slide = { joint = "left_tube", coordinate = "displacement", law = "0.05" }
[measures]
left_both = { type = "slope", of = "left_p.z", over = "left_p.x", driver = "left_swing", together = ["left_turn"] }
left_against = { type = "slope", of = "left_p.z", over = "left_p.x", driver = "left_turn", opposed = ["left_swing"] }
[time]
at = [0]
"#;

#[test]
fn slopes_of_several_drivers_are_mirrored() {
    let solution = solved(SWINGING);
    for name in ["both", "against"] {
        let [left, right] = ["left", "right"].map(|side| value(&solution, 0, &format!("{side}_{name}")));
        assert!(left.abs() > 1e-3 && (left - right).abs() <= SAME * left.abs(), "{name}: {left} {right}");
    }
    let [both, against] = ["left_both", "left_against"].map(|name| value(&solution, 0, name));
    assert!((both - against).abs() > 1e-3, "{both} {against}");
}

#[test]
fn slopes_report_what_cannot_move_together() {
    let text = rig(2);
    let with = |from: &str, to: &str| faults(&text.replacen(from, to, 1));
    let texts = [
        with("together = [\"right_bump\"]", "together = [\"left_bump\"]"),
        with("together = [\"right_bump\"]", "together = [\"right_bum\"]"),
        with(
            "[metrics]",
            "[metrics]\nsteer = { case = \"parallel_travel\", of = \"left.toe\", over = \"left.wheel_travel\", take = \"slope\", at = 0 }",
        ),
    ];
    snapshot_all("slopes_together_faults", &texts);
}

#[test]
fn an_elastic_ball_of_a_rod_that_may_spin_gives_along_its_own_axes() {
    let text = |elastic: &str| {
        format!(
            r#"
name = "rod"
units = {{ length = "mm", angle = "deg" }}
bodies = {{ b = {{}}, rod = {{}} }}
[joints]
g = {{ type = "translational", bodies = ["ground", "b"], at = [0, 0, 0], axis = "x" }}
s1 = {{ type = "spherical", bodies = ["ground", "rod"], at = [-100, -100, -50] }}
s2 = {{ type = "spherical", bodies = ["b", "rod"], at = [0, 0, 0] }}
[points]
p = {{ body = "b", at = [0, 0, 0] }}
r = {{ body = "rod", at = [-100, -100, -50] }}
[forces]
e = {{ type = "elastic_joint", joint = "{elastic}", x = 100, y = 1000, z = 300 }}
f = {{ type = "force", at = "p", force = 1000, along = "x", law = "t" }}
[equilibrium]
[time]
at = [0, 1]
"#
        )
    };
    // The force along x is on the joint at either end of the rod: 1000 N over 100 N/mm.
    let first = solved(&text("s1"));
    assert!((value(&first, 1, "r.x") + 0.09).abs() <= SAME, "{}", value(&first, 1, "r.x"));
    // Up to the turning of the axes, both ends give alike.
    let second = solved(&text("s2"));
    let [a, b] = [&first, &second].map(|solution| value(solution, 1, "p.x"));
    assert!((a - b).abs() <= SAME && a > 0.01, "{a} {b}");
}

#[test]
fn a_rod_spins_as_its_elastic_ball_holds_it() {
    let text = r#"
name = "rod"
units = { length = "mm", angle = "deg" }
bodies = { b = {}, rod = {} }
[joints]
s1 = { type = "spherical", bodies = ["ground", "rod"], at = [0, 0, 0] }
g = { type = "revolute", bodies = ["ground", "b"], at = [100, 0, 0], axis = "x" }
s2 = { type = "spherical", bodies = ["b", "rod"], at = [100, 0, 0] }
[drivers]
d = { joint = "g", law = "30*t" }
[points]
p = { body = "rod", at = [50, 20, 0] }
[forces]
e = { type = "elastic_joint", joint = "s1", x = 100, y = 1000, z = 300, about_x = 5, about_y = 6, about_z = 7 }
[equilibrium]
[measures]
load = { type = "driver_force", driver = "d" }
[time]
at = [0, 1]
"#;
    let [s1, s2] = ["s1", "s2"].map(|name| text.lines().find(|line| line.starts_with(name)).unwrap());
    let swapped = text.replace(s1, "S1").replace(s2, s1).replace("S1", s2);
    for text in [text, &swapped] {
        let solution = solved(text);
        for (name, at) in [("p.x", 0.05), ("p.y", 0.02), ("p.z", 0.0), ("load", 0.0)] {
            let found = value(&solution, 1, name);
            assert!((found - at).abs() <= SAME, "{name}: {found}");
        }
    }
}

/// An element of every kind with a curve, through forces that parameters give, in inches and degrees.
const CURVES: &str = r#"
name = "curves"
units = { length = "in", angle = "deg" }
[parameters]
near = 35
far = 90
[hardpoints]
o = [0, 0, 0]
[bodies]
b = {}
slider = {}
arm = {}
[joints]
j = { type = "fixed", bodies = ["ground", "b"], at = "o" }
slide = { type = "translational", bodies = ["ground", "slider"], at = [0, 10, 0], axis = "x" }
hinge = { type = "revolute", bodies = ["ground", "arm"], at = [0, 20, 0], axis = "z" }
[drivers]
slides = { joint = "slide", law = 0 }
turns = { joint = "hinge", law = 0 }
[points]
p = { body = "b", at = [3, 1, 0.5] }
s = { body = "slider", at = [0, 10, 0] }
a = { body = "arm", at = [4, 20, 0] }
[forces.soft]
type = "elastic_joint"
joint = "j"
x = 10
y = 30
z = 25
about_x = 4
about_y = 5
about_z = 6
curve_x = [[-2, "-near"], [0, 0], [2, "near"], [3, "near + far"]]
curve_about_z = [[-9, "-near/5"], [0, 0], [4, "far/20"], [12, 40]]
[forces.bush]
type = "bushing"
from = { body = "ground", at = [1, 0, 0] }
to = { body = "b", at = [1, 0, 0] }
x = 2
y = 3
z = 4
curve_y = [[-3, "-far"], [0, 0], [1, "near/2"], [4, 150]]
curve_about_x = [[-10, "-near/9"], [0, 0], [10, "far/20"]]
[forces.coil]
type = "joint_spring"
joint = "slide"
stiffness = 3
curve = [[-4, "-far"], [0, 0], [1, 5], [3, "near"]]
[forces.stop]
type = "spring"
from = { body = "ground", at = [6, 10, 0] }
to = { body = "slider", at = [1, 10, 0] }
free_length = 5
compression = [[-1, 0], [0.5, 0], [1, "near/4"], [2, "far"]]
[forces.bar]
type = "torsion_spring"
joint = "hinge"
stiffness = 0.5
curve = [[-30, "-far/9"], [0, 0], [10, "near/7"], [25, "far/6"]]
[forces]
on_body = { type = "force", at = "p", force = 80, along = [1, 0.4, -0.2], law = "0.1 + t" }
on_slider = { type = "force", at = "s", force = 60, along = "x", law = "0.1 + t" }
on_arm = { type = "force", at = "a", force = 90, along = "y", law = "0.1 + t" }
[equilibrium]
released = ["slides", "turns"]
[measures]
give = { type = "compliance", of = "p.x", at = "p", along = "x" }
angle = { type = "coordinate", joint = "hinge" }
across = { type = "reaction", joint = "j", part = "force_y" }
stop = { type = "spring_force", force = "stop" }
[time]
end = 1
steps = 3
"#;

#[test]
fn forces_of_curve_points_are_design_variables() {
    let model = model_of(CURVES);
    verify_all(&model);
    let names = ["p.x", "p.y", "p.z", "s.x", "a.y", "give", "angle", "across", "stop"];
    let solution = solved(CURVES);
    let absolute = solved_by(&model, Formulation::Absolute);
    let directions = [vec![1.0, 0.0], vec![0.0, 1.0]];
    let pairs = [[0, 0], [0, 1], [1, 0], [1, 1]];
    let second = Analysis::new(&model).unwrap().second(&[], &directions, &pairs);
    for (v, (name, nominal)) in [("near", 35.0), ("far", 90.0)].into_iter().enumerate() {
        // The same design with another number in the text.
        let step = 1e-3 * nominal;
        let [above, below] = [step, -step].map(|h| {
            solved(&CURVES.replace(&format!("{name} = {nominal}"), &format!("{name} = {:?}", nominal + h)))
        });
        let variable = model.variable(name).unwrap();
        for what in names {
            let m = solution.measured.index(what).unwrap();
            let of = |s: &Solution, v: VariableId| -> Vec<f64> {
                (0..model.times.len()).map(|k| s.measured.d(k, v, m)[0]).collect()
            };
            let found = of(&solution, variable);
            let largest = found.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            assert!(largest > 0.0, "{what} by {name}");
            for (k, found) in found.iter().enumerate() {
                let expected = (value(&above, k, what) - value(&below, k, what)) / (2.0 * step);
                assert!(
                    (found - expected).abs() <= DIFFERENCES * largest,
                    "{what} by {name}: {found} {expected}"
                );
                let again = of(&absolute, variable)[k];
                assert!((found - again).abs() <= SAME * largest, "{what} by {name}: {found} {again}");
            }
            if !second.outputs[m].known.by_position {
                continue;
            }
            for (p, [first, along]) in pairs.into_iter().enumerate().filter(|(_, pair)| pair[1] == v) {
                let slopes = [&above, &below].map(|s| of(s, VariableId(first)));
                let expected = |k: usize| (slopes[0][k] - slopes[1][k]) / (2.0 * step);
                let most = (0..model.times.len()).fold(0.0_f64, |most, k| most.max(expected(k).abs()));
                for k in 0..model.times.len() {
                    let (found, expected) = (second.value(k, p, m), expected(k));
                    let what = format!("{what} by {first} and {along} at {k}: {found} {expected}");
                    assert!((found - expected).abs() <= DIFFERENCES * most, "{what}");
                }
            }
        }
    }
}

#[test]
fn curves_in_other_units_follow_the_same_forces() {
    // 10 N/in e + C(e) = 55 N with C(2 in) = 35 N, whatever the unit of length.
    let text = |unit: &str, scale: f64| {
        held(
            "fixed",
            &format!(
                "x = {:?}, curve_x = [[{:?}, \"-force\"], [0, 0], [{:?}, \"force\"]]",
                10.0 / scale,
                -2.0 * scale,
                2.0 * scale
            ),
        )
        .replace("length = \"m\"", &format!("length = \"{unit}\""))
        .replace("force = 100", "force = 55")
        .replace("[hardpoints]", "[parameters]\nforce = 35\n[hardpoints]")
    };
    let found = [("in", 1.0), ("mm", 25.4)].map(|(unit, scale)| {
        let model = model_of(&text(unit, scale));
        let solution = solved_by(&model, Formulation::Relative);
        let m = solution.measured.index("o.x").unwrap();
        (value(&solution, 0, "o.x"), solution.measured.d(0, model.variable("force").unwrap(), m)[0])
    });
    // The chords have one slope: 1/(10 + 17.5) in per N.
    for (x, by_force) in found {
        assert!((x - 2.0 * 0.0254).abs() < 1e-12, "{x}");
        assert!((by_force + 0.0254 / 27.5).abs() < 1e-12, "{by_force}");
    }
}

#[test]
fn forces_of_curve_points_that_are_equal_or_unknown_are_reported() {
    let with =
        |keys: &str| held("fixed", keys).replace("[hardpoints]", "[parameters]\nf = 10\nw = 1\n[hardpoints]");
    let remarks = |keys: &str| {
        let file = parse(&with(keys), "elastic.toml").unwrap_or_else(|e| panic!("{e}"));
        let found = file.remarks.iter().filter(|d| d.code == "HP0258");
        found.map(|d| d.message.clone()).collect::<Vec<_>>()
    };
    let kinked = "x = 10, curve_x = [[-1, \"-f\"], [0, 0], [1, \"f\"], [2, 10]]";
    assert_eq!(remarks(kinked), ["`curve_x` of `soft` has the same force at 1 m and 2 m"]);
    assert!(
        remarks("x = 10, curve_x = [[-1, \"-f\"], [0, 0], [1, \"f\"], [2, \"f\"], [3, 70], [4, 70]]")
            .is_empty()
    );
    for (keys, expected) in [
        ("x = 10, curve_x = [[-1, \"-g\"], [1, 4]]", "HP0204"),
        ("x = 10, curve_x = [[-1, -1], [\"w\", 4]]", "cannot follow parameter `w`"),
        ("x = 10, curve_x = [[-1, -1], [1, \"1/(f - 10)\"]]", "HP0228"),
        ("x = 10, curve_x = [[1, \"f\"], [-1, \"-f\"]]", "does not increase from point to point"),
        ("x = 10, curve_x = [[-1, \"-f\", 2], [1, \"f\"]]", "3 values instead of 2"),
    ] {
        let found = faults(&with(keys));
        assert!(found.contains(expected), "{keys}: {found}");
    }
}

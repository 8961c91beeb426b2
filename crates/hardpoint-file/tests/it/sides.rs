//! Every declared type on both sides of a mirror, in motion: images move as mirror images, with the same measures.
//!
//! The lists are those of the declarations, so that a new type fails here until it has a mechanism.

use hardpoint::draft::{ElementType, MeasureType};
use hardpoint::joint::{self, JointType, Need};
use hardpoint::model::{AxleMeasure, Model, WheelMeasure};
use hardpoint::space::{Mat3, Vec3};
use hardpoint::{Analysis, Solution};
use hardpoint_file::{parse, read};

/// Both sides solve the same equations with other signs: round-off only, relative to the largest of a kind.
const SAME: f64 = 1e-9;
/// Quotients of slopes have the round-off of both, next to positions where the lower one is small.
const SAME_SLOPES: f64 = 1e-7;
const AXES: [&str; 3] = ["x", "y", "z"];

/// The names of the types of a kind of thing, from the schema.
pub(crate) fn declared(of: &str) -> Vec<String> {
    let schema: serde_json::Value = serde_json::from_str(&hardpoint_file::schema()).unwrap();
    let of = &schema["$defs"][of];
    let types = of["oneOf"].as_array().or(of["anyOf"].as_array()).unwrap();
    let name = |t: &serde_json::Value| {
        let by_type = t["properties"]["type"]["const"].as_str();
        let by_reference = || t["$ref"].as_str().and_then(|r| r.rsplit('/').next());
        by_type.or_else(by_reference).unwrap_or_else(|| panic!("{t}")).to_owned()
    };
    types.iter().map(name).collect()
}

fn solved(what: &str, text: &str) -> (Model, Solution) {
    let model = parse(text, "sides.toml").unwrap_or_else(|e| panic!("{what}: {e}\n{text}")).model;
    let analysis = Analysis::new(&model).unwrap_or_else(|e| panic!("{what}: {e:?}\n{text}"));
    let solution = analysis.run();
    assert!(solution.stop.is_none(), "{what}: {:?}\n{text}", solution.stop);
    (model, solution)
}

fn mirrored(v: Vec3, across: usize) -> Vec3 {
    v - Vec3::AXES[across] * (2.0 * v.dot(Vec3::AXES[across]))
}

/// Solves a model and holds all bodies, and all measures but those with these words in their names, to their images:
/// these are opposite.
fn hold_both_sides(what: &str, text: &str, across: usize, opposite: &[&str]) {
    let what = format!("{what}, across {}", AXES[across]);
    let (model, solution) = solved(&what, text);
    let body = |name: &str| model.bodies.iter().position(|b| b.name == name).unwrap();
    let lefts: Vec<_> = model.bodies.iter().map(|b| &b.name).filter(|n| n.starts_with("left")).collect();
    assert!(!lefts.is_empty(), "{what}");
    let (mut moves, mut pairs) = (0.0_f64, Vec::new());
    let steps = 0..solution.motion.len();
    for left in lefts {
        let [l, r] = [left.clone(), left.replace("left", "right")].map(|n| body(&n));
        for k in steps.clone() {
            let (a, b) = (solution.motion.at(k).body(l), solution.motion.at(k).body(r));
            moves = moves.max(a.v.norm() + a.omega.norm());
            let image = Mat3 {
                cols: [0, 1, 2].map(|c| {
                    let sign = if c == across { -1.0 } else { 1.0 };
                    mirrored(a.rotation.cols[c], across) * sign
                }),
            };
            pairs.push(("place", mirrored(a.r, across), b.r));
            pairs.extend((0..3).map(|c| ("orientation", image.cols[c], b.rotation.cols[c])));
            pairs.push(("velocity", mirrored(a.v, across), b.v));
            pairs.push(("acceleration", mirrored(a.a, across), b.a));
            pairs.push(("angular velocity", -mirrored(a.omega, across), b.omega));
            pairs.push(("angular acceleration", -mirrored(a.alpha, across), b.alpha));
        }
    }
    assert!(moves > 1e-3, "{what}: nothing moves\n{text}");
    for kind in
        ["place", "orientation", "velocity", "acceleration", "angular velocity", "angular acceleration"]
    {
        let of = || pairs.iter().filter(|p| p.0 == kind);
        let size = of().fold(1e-3_f64, |s, p| s.max(p.1.norm()));
        for (_, a, b) in of() {
            assert!((*a - *b).norm() <= SAME * size, "{what}: {kind} {a:?} {b:?}\n{text}");
        }
    }
    let outputs = &solution.measured.outputs;
    for (m, left) in outputs.iter().enumerate() {
        // Coordinates of points are those of bodies.
        if !left.name.starts_with("left")
            || left.name.ends_with(".x")
            || left.name.ends_with(".y")
            || left.name.ends_with(".z")
        {
            continue;
        }
        let right = left.name.replace("left", "right");
        let n = outputs.iter().position(|o| o.name == right).unwrap_or_else(|| panic!("{what}: {right}"));
        let sign = if opposite.iter().any(|o| left.name.contains(o)) { -1.0 } else { 1.0 };
        let of = |m: usize| steps.clone().map(move |k| (k, m));
        let value = |(k, m): (usize, usize)| solution.measured.value(k, m)[0];
        // Moments of balls are round-off of the forces at them.
        let size = of(m).map(value).filter(|x| x.is_finite()).fold(1e-5_f64, |s, x| s.max(x.abs()));
        let tolerance = if what.starts_with("wheel") { SAME_SLOPES } else { SAME };
        for (l, r) in of(m).zip(of(n)) {
            let (a, b) = (value(l), value(r) * sign);
            let same = (a - b).abs() <= tolerance * size || a.is_nan() && b.is_nan();
            assert!(same, "{what}: `{}` is {a}, its image {b}, at step {}\n{text}", left.name, l.0);
        }
    }
}

/// Takes what a model is about, its text, across which axis it is mirrored, and parts of the names of measures that are
/// opposite.
pub(crate) type Hold<'h> = &'h mut dyn FnMut(&str, &str, usize, &[&str]);

fn model(across: usize, tables: &str) -> String {
    format!(
        "name = \"both sides\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\nmirror = {{ across = \"{}\" }}\n\
         {tables}\n[time]\nend = 1.0\nsteps = 6\n",
        AXES[across]
    )
}

/// Legs from ground to a body, of lengths that drivers change: each takes one of its freedoms.
fn legs(count: usize) -> String {
    let leg = |k: usize| {
        let Leg { base, on, law } = Leg::of(k);
        format!(
            "left_leg{k} = {{ from = {{ body = \"ground\", at = {base:?} }}, to = {{ body = \"left_b\", at = {on:?} }}, law = \"{law}\" }}\n"
        )
    };
    (0..count).map(leg).collect()
}

/// One of six legs that hold a body, in mm.
pub(crate) struct Leg {
    pub base: [f64; 3],
    pub on: [f64; 3],
    pub law: String,
}

impl Leg {
    pub fn of(k: usize) -> Self {
        let turn = |offset: f64| (60.0 * k as f64 + offset).to_radians().sin_cos();
        let side = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let ((s, c), (u, v)) = (turn(22.0 * side), turn(-17.0 * side));
        Self {
            base: [30.0 + 400.0 * c, 450.0 + 400.0 * s, -350.0],
            on: [30.0 + 150.0 * v, 450.0 + 150.0 * u, 40.0 + 10.0 * k as f64],
            law: format!("{}*sin({}*t)", 3 + k, 2.0 - 0.3 * k as f64),
        }
    }
}

/// Entries for the coordinates of a joint `j`; all names begin with `side`.
pub(crate) struct CoordinateEntries {
    /// Drivers of those that can be driven.
    pub drivers: String,
    /// Measures of all of them.
    pub measures: String,
    /// Number of freedoms between its bodies that remain.
    pub free: usize,
}

impl CoordinateEntries {
    pub fn of(kind: &JointType, side: &str) -> Self {
        let driven = kind
            .coordinates
            .iter()
            .filter(|c| !(kind.is_rod() && !kind.rows.is_empty() || kind.has_lead() && c.name != "angle"));
        let (mut drivers, mut measures) = (String::new(), String::new());
        let mut held = kind.rows.len() + usize::from(kind.has_lead());
        for c in driven {
            let law = if c.name.starts_with("angle") { "9*t - 4*t^2" } else { "11*t + 5*t^2" };
            let name = c.name;
            drivers += &format!(
                "{side}{name} = {{ joint = \"{side}j\", coordinate = \"{name}\", law = \"{law}\" }}\n"
            );
            held += 1;
        }
        for c in kind.coordinates {
            let name = c.name;
            measures += &format!(
                "{side}q_{name} = {{ type = \"coordinate\", joint = \"{side}j\", coordinate = \"{name}\" }}\n"
            );
        }
        Self { drivers, measures, free: 6 - held }
    }
}

/// A body on a carrier by a joint of this type; all coordinates that can be driven are, and legs do the rest.
fn with_joint(kind: &JointType, across: usize, with_axis2: bool) -> String {
    let mut keys = format!("type = \"{}\", bodies = [\"left_a\", \"left_b\"]", kind.name);
    keys += match kind.places {
        0 => "",
        1 => ", at = \"left_O\"",
        _ => ", at = [\"left_O\", \"left_P\"]",
    };
    keys += match kind.axis {
        Need::Unused => "",
        Need::Orienting if !with_axis2 => "",
        Need::Orienting | Need::Optional | Need::Required | Need::OnBodyJ => ", axis = [0.2, 0.9, 0.4]",
    };
    keys += match kind.axis2 {
        Need::Unused => "",
        Need::Optional | Need::Orienting if !with_axis2 => "",
        Need::Optional | Need::Orienting | Need::Required => ", axis2 = [0.9, -0.2, 0]",
        Need::OnBodyJ => ", axis2 = [0.4, 0.8, 0.5]",
    };
    if kind.has_lead() {
        keys += ", lead = 35";
    }
    if kind.follows_curve() {
        // In the plane perpendicular to the axis, along [0.9, -0.2, 0] and across.
        let point = |a: f64, b: f64| [10.0 + 0.9 * a + 0.08 * b, 400.0 - 0.2 * a + 0.36 * b, 20.0 - 0.85 * b];
        let points = [point(-80.0, 15.0), point(-20.0, 0.0), point(60.0, -5.0), point(140.0, 2.0)];
        keys += &format!(", curve = {{ points = {points:?} }}");
    }
    let CoordinateEntries { drivers, measures, free } = CoordinateEntries::of(kind, "left_");
    model(
        across,
        &format!(
            "[hardpoints]\nleft_O = [10, 400, 20]\nleft_P = [50, 430, -20]\nleft_H = [-200, 300, 100]\n\
             [bodies]\nleft_a = {{}}\nleft_b = {{}}\n\
             [joints]\nleft_hinge = {{ type = \"revolute\", bodies = [\"ground\", \"left_a\"], at = \"left_H\", axis = [0.3, 0.5, 0.8] }}\n\
             left_j = {{ {keys} }}\n\
             [drivers]\nleft_turn = {{ joint = \"left_hinge\", law = \"3*t\" }}\n{drivers}{}[measures]\n{measures}",
            legs(free)
        ),
    )
}

#[test]
fn every_joint_type() {
    joint_types(&mut hold_both_sides);
}

pub(crate) fn joint_types(hold: Hold<'_>) {
    for kind in joint::ALL {
        // What turns about the line that it slides along becomes left-handed.
        let opposite: &[&str] =
            if ["cylindrical", "screw"].contains(&kind.name) { &["q_angle"] } else { &[] };
        for across in 0..3 {
            for with_axis2 in [true, false] {
                if with_axis2 || [Need::Optional, Need::Orienting].contains(&kind.axis2) {
                    hold(kind.name, &with_joint(kind, across, with_axis2), across, opposite);
                }
            }
        }
    }
}

#[test]
fn every_law() {
    laws(&mut hold_both_sides);
}

pub(crate) fn laws(hold: Hold<'_>) {
    for name in declared("LawTable") {
        let law = match name.as_str() {
            "harmonic" => "amplitude = 12, frequency = 0.6, phase = 20, offset = 3",
            "constant_speed" => "speed = 14, offset = 2",
            "polynomial" => "coefficients = [1, 4, -6, 3]",
            "smooth_step" => "from = 2, to = 15, start = 0.1, end = 0.8",
            "trapezoid" => "from = 2, to = 15, start = 0.1, end = 0.8, ramp = 0.2",
            "table" => {
                "points = [[0, 1], [0.4, 7], [0.7, 3], [1, 5]], start_speed = 3, end_speed = -2, spline = \"quintic\", start_acceleration = 5, end_acceleration = 4"
            }
            "sequence" => {
                "pieces = [{ duration = 0.5, law = \"9*t\" }, { law = { type = \"polynomial\", coefficients = [0, 9, -5] } }]"
            }
            "expression" => "law = \"a*sin(w*t) + 1\", parameters = { a = 13, w = 2.5 }",
            other => panic!("no mechanism for law `{other}`"),
        };
        let law = format!("{{ type = \"{name}\", {law} }}");
        let text = with_joint(joint::named("cylindrical").unwrap(), 1, false)
            .replace("\"9*t - 4*t^2\"", &law)
            .replace("\"11*t + 5*t^2\"", &law);
        hold(&name, &text, 1, &["q_angle"]);
    }
}

#[test]
fn every_form_of_driver() {
    forms_of_drivers(&mut hold_both_sides);
}

pub(crate) fn forms_of_drivers(hold: Hold<'_>) {
    let point = "{ body = \"left_b\", at = [60, 500, 30] }";
    let measured = [
        "left_m = { type = \"position\", point = { body = \"left_b\", at = [60, 500, 30] }, along = [0.3, 0.2, 0.9] }",
        "left_m = { type = \"distance\", from = { body = \"left_b\", at = [60, 500, 30] }, to = { body = \"ground\", at = [0, 200, 600] } }",
        "left_m = { type = \"angle\", from = [1, 0, 0], to = { body = \"left_b\", axis = [0.9, 0.3, 0.1] }, about = [0.1, 0.2, 1] }",
        "left_m = { type = \"toe\", body = \"left_b\", spin_axis = [0.05, 1, 0.02] }",
        "left_m = { type = \"coordinate\", joint = \"left_j\", coordinate = \"angle\" }",
    ];
    let wheel = "[wheels.left]\nbody = \"left_b\"\ncentre = [0, 600, 0]\nspin_axis = [0.0035, 1, 0.0175]\nradius = 300\nmeasures = [\"toe\", \"steer_angle\", \"wheel_travel\", \"wheel_recession\"]\n";
    let none = |_: &str| String::new();
    for form in declared("Driver") {
        // The driver, measures, whether on a cylindrical joint, and what is opposite.
        let cases: Vec<(String, String, bool, &[&str])> = match form.as_str() {
            "DrivenCoordinate" => {
                vec![("joint = \"left_j\", coordinate = \"angle\"".into(), none(""), true, &["force"])]
            }
            "DrivenPosition" => {
                vec![(format!("point = {point}, along = [0.3, 0.2, 0.9]"), none(""), false, &[])]
            }
            "DrivenDistance" => vec![(
                format!("from = {point}, to = {{ body = \"ground\", at = [0, 200, 600] }}"),
                none(""),
                false,
                &[],
            )],
            "DrivenOrientation" => {
                let about = "body = \"left_b\", about = [0.2, 0.1, 1]";
                let with_x = format!("{about}, axis2 = [0.3, 1, 0.1]");
                vec![(about.into(), none(""), false, &[]), (with_x, none(""), false, &[])]
            }
            "DrivenContact" => {
                vec![("wheel = \"left\"".into(), wheel.to_owned(), false, &["steer_angle"])]
            }
            "DrivenMeasure" => {
                let mut all: Vec<(String, String, bool, &[&str])> = Vec::new();
                for m in measured {
                    let on_joint = m.contains("left_j");
                    let opposite: &[&str] = if on_joint { &["left_m", "force"] } else { &[] };
                    all.push(("measure = \"left_m\"".into(), m.to_owned(), on_joint, opposite));
                }
                for what in ["toe", "steer_angle", "wheel_travel", "wheel_recession"] {
                    let opposite: &[&str] =
                        if what == "steer_angle" { &["steer_angle", "force"] } else { &["steer_angle"] };
                    all.push((format!("measure = \"left.{what}\""), wheel.to_owned(), false, opposite));
                }
                all
            }
            other => panic!("no mechanism for `{other}`"),
        };
        for (driver, more, on_joint, opposite) in cases {
            let starts_at_zero = !driver.contains("measure")
                || driver.contains("left.wheel")
                || driver.contains("left.steer")
                || on_joint;
            for across in 0..3 {
                if across != 1 && (more.contains("wheels") || more.contains("\"toe\"")) {
                    continue;
                }
                let hinged = more.contains("toe\"");
                let (joints, free) = match (on_joint, hinged) {
                    (true, _) => (
                        "left_j = { type = \"cylindrical\", bodies = [\"ground\", \"left_b\"], at = [10, 400, 20], axis = [0.2, 0.9, 0.4] }",
                        1,
                    ),
                    // What a wheel's measure prescribes turns it about an oblique hinge.
                    (false, true) => (
                        "left_j = { type = \"revolute\", bodies = [\"ground\", \"left_b\"], at = [100, 300, -50], axis = [0.5, 0.3, 0.8] }",
                        0,
                    ),
                    (false, false) => (
                        "left_hold = { type = \"leg\", bodies = [\"ground\", \"left_b\"], at = [[0, 100, 0], [0, 450, 0]] }",
                        5,
                    ),
                };
                let tables = |start: &str| {
                    let (measures, wheels) = match more.contains("[wheels") {
                        true => ("", more.as_str()),
                        false => (more.as_str(), ""),
                    };
                    model(
                        across,
                        &format!(
                            "[bodies]\nleft_b = {{}}\n[joints]\n{joints}\n[drivers]\nleft_d = {{ {driver}, law = \"{start} + 4*t - t^2\" }}\n{}\
                         [masses]\nleft_mass = {{ type = \"rigid\", centre = {{ body = \"left_b\", at = [0, 450, 50] }}, mass = 3, ixx = 0.01, iyy = 0.02, izz = 0.025 }}\n\
                         [measures]\nleft_force = {{ type = \"driver_force\", driver = \"left_d\" }}\n{measures}\n{wheels}",
                            legs(free)
                        ),
                    )
                };
                // Laws of measures give their whole value: from what it is in the design configuration.
                let start = match starts_at_zero {
                    true => "0".to_owned(),
                    false => {
                        let of = if more.contains("[wheels") { "left.toe" } else { "left_m" };
                        let still = tables("0").replace(&format!("left_d = {{ {driver}, law"), "left_d = { point = { body = \"left_b\", at = [60, 500, 30] }, along = \"z\", law");
                        let (_, solution) = solved(&form, &still);
                        let m = solution.measured.outputs.iter().position(|o| o.name == of).unwrap();
                        let value = solution.measured.value(0, m)[0];
                        let is_length = more.contains("position") || more.contains("distance");
                        format!("{}", if is_length { value * 1e3 } else { value.to_degrees() })
                    }
                };
                hold(&format!("{form}, {driver} {more}"), &tables(&start), across, opposite);
            }
        }
    }
}

#[test]
fn every_coupler() {
    couplers(&mut hold_both_sides);
}

pub(crate) fn couplers(hold: Hold<'_>) {
    for name in declared("Coupler") {
        // On joints of one side, and on one of both sides: a shaft across the mirror, and a rack along it.
        let all: &[&str] = match name.as_str() {
            "gear" => &[
                "joints = [\"left_hinge\", \"left_tube\"], teeth = [20, 30]",
                "joints = [\"shaft\", \"left_tube\"], teeth = [20, 30], internal = true",
                "joints = [\"shaft\", \"left_hinge\"], teeth = [20, 30]",
            ],
            "bevel" => &[
                "joints = [\"left_hinge\", \"left_tube\"], teeth = [20, 30]",
                "joints = [\"shaft\", \"left_hinge\"], teeth = [20, 30]",
            ],
            "rack" | "rack_and_pinion" => &[
                "rack = \"left_tube\", pinion = \"left_hinge\", radius = 30",
                "rack = \"left_slide\", pinion = \"left_tube\", radius = 30",
                "rack = \"slide\", pinion = \"left_tube\", radius = 30",
                "rack = \"slide\", pinion = \"left_hinge\", radius = 30",
            ],
            "belt" => &[
                "joints = [\"left_hinge\", \"left_tube\"], radii = [20, 30]",
                "joints = [\"shaft\", \"left_tube\"], radii = [20, 30], crossed = true",
            ],
            "linear" => &[
                "terms = [{ joint = \"left_flat\", coordinate = \"y\", coefficient = 1 }, { joint = \"left_hinge\", coefficient = 2 }]",
                "terms = [{ joint = \"left_tube\", coordinate = \"angle\", coefficient = 1 }, { joint = \"left_cross\", coordinate = \"angle2\", coefficient = 2 }]",
                "terms = [{ joint = \"left_tube\", coordinate = \"angle\", coefficient = 1 }, { joint = \"slide\", coefficient = 2 }]",
                "terms = [{ joint = \"left_tube\", coordinate = \"displacement\", coefficient = 1 }, { joint = \"shaft\", coefficient = 2 }]",
                "terms = [{ joint = \"left_hinge\", coefficient = 1 }, { joint = \"table\", coordinate = \"x\", coefficient = 2 }]",
                "terms = [{ joint = \"left_tube\", coordinate = \"angle\", coefficient = 1 }, { joint = \"table\", coordinate = \"x\", coefficient = 2 }]",
            ],
            other => panic!("no mechanism for coupler `{other}`"),
        };
        let coordinates = [
            ("left_hinge", "angle"),
            ("left_tube", "angle"),
            ("left_tube", "displacement"),
            ("left_slide", "displacement"),
            ("left_flat", "x"),
            ("left_flat", "y"),
            ("left_flat", "angle"),
            ("left_cross", "angle"),
            ("left_cross", "angle2"),
        ];
        let shared = [
            ("shaft", "angle"),
            ("slide", "displacement"),
            ("table", "x"),
            ("table", "y"),
            ("table", "angle"),
        ];
        for keys in all {
            // The first thing coupled follows where a shared one is driven; else the second one does.
            let follows = coordinates.into_iter().find(|(joint, coordinate)| {
                let is_named = keys.contains(&format!("\"{joint}\""));
                let only_if = |word: &str| {
                    !keys.contains("coordinate = ")
                        || keys.contains(&format!("\"{joint}\", coordinate = \"{word}\""))
                        || *joint == "left_hinge"
                };
                let as_rack = !keys.contains(&format!("rack = \"{joint}\"")) || *coordinate == "displacement";
                let as_rest = keys.contains("terms")
                    || keys.contains(&format!("rack = \"{joint}\""))
                    || *coordinate == "angle";
                is_named && only_if(coordinate) && as_rack && as_rest
            });
            let follows = follows.unwrap();
            let mut drivers = String::new();
            for (k, (joint, coordinate)) in coordinates.into_iter().filter(|c| *c != follows).enumerate() {
                drivers += &format!(
                    "left_d{k} = {{ joint = \"{joint}\", coordinate = \"{coordinate}\", law = \"{}*t + 2*t^2\" }}\n",
                    3 + k
                );
            }
            for (joint, coordinate) in shared {
                // What both sides share moves as its own mirror image: the shaft turns, what slides in the mirror does.
                let law =
                    if matches!((joint, coordinate), ("table", "y" | "angle")) { "0" } else { "7*t - t^2" };
                drivers += &format!(
                    "d_{joint}_{coordinate} = {{ joint = \"{joint}\", coordinate = \"{coordinate}\", law = \"{law}\" }}\n"
                );
            }
            let text = model(
                1,
                &format!(
                    "[bodies]\nleft_a = {{}}\nleft_b = {{}}\nleft_c = {{}}\nleft_d = {{}}\nleft_e = {{}}\nwheel = {{}}\nrack = {{}}\nsheet = {{}}\n\
                 [joints]\n\
                 left_hinge = {{ type = \"revolute\", bodies = [\"ground\", \"left_a\"], at = [0, 300, 0], axis = [0.1, 0.9, 0.2] }}\n\
                 left_tube = {{ type = \"cylindrical\", bodies = [\"ground\", \"left_b\"], at = [100, 300, 0], axis = [1, 0.5, 0.3] }}\n\
                 left_slide = {{ type = \"translational\", bodies = [\"ground\", \"left_c\"], at = [200, 300, 0], axis = [0.3, 0.9, 0.3] }}\n\
                 left_flat = {{ type = \"planar\", bodies = [\"ground\", \"left_d\"], at = [300, 300, 0], axis = [0.4, 0.9, 0.3] }}\n\
                 left_cross = {{ type = \"universal\", bodies = [\"ground\", \"left_e\"], at = [400, 300, 0], axis = [0.4, 0.9, 0], axis2 = [0.9, -0.4, 0.1] }}\n\
                 shaft = {{ type = \"revolute\", bodies = [\"ground\", \"wheel\"], at = [0, 0, 0], axis = \"y\" }}\n\
                 slide = {{ type = \"translational\", bodies = [\"ground\", \"rack\"], at = [0, 0, 50], axis = [1, 0, 0.5] }}\n\
                 table = {{ type = \"planar\", bodies = [\"ground\", \"sheet\"], at = [0, 0, 90], axis = \"z\", axis2 = \"x\" }}\n\
                 [couplers]\nleft_coupler = {{ type = \"{name}\", {keys} }}\n[drivers]\n{drivers}"
                ),
            );
            hold(&format!("{name}, {keys}"), &text, 1, &[]);
        }
    }
}

/// A body that swings, and one that turns and slides on it, with all that the loads of one element need.
fn loaded(across: usize, tables: &str) -> String {
    let wheel = match across {
        1 => {
            "[wheels.left]\nbody = \"left_a\"\ncentre = [0, 600, 0]\nspin_axis = [0.0035, 1, 0.0175]\nradius = 300\n"
        }
        _ => "",
    };
    let gravity = if across == 2 { "" } else { "gravity = { along = \"-z\" }\n" };
    let mut measures = String::new();
    for joint in ["hinge", "tube", "ball", "rail"] {
        for part in ["force", "moment"].into_iter().flat_map(|p| AXES.map(|a| format!("{p}_{a}"))) {
            measures += &format!(
                "left_{joint}_{part} = {{ type = \"reaction\", joint = \"left_{joint}\", part = \"{part}\" }}\n"
            );
        }
    }
    model(
        across,
        &format!(
            "{gravity}[hardpoints]\nleft_H = [-200, 300, 100]\nleft_O = [10, 400, 20]\nleft_P = [50, 430, -20]\nleft_B = [150, 500, 60]\nleft_R = [300, 350, 40]\n\
         [bodies]\nleft_a = {{}}\nleft_b = {{}}\nleft_c = {{}}\nleft_e = {{}}\n\
         [joints]\n\
         left_hinge = {{ type = \"revolute\", bodies = [\"ground\", \"left_a\"], at = \"left_H\", axis = [0.3, 0.5, 0.8], axis2 = [1, 0.2, 0.1] }}\n\
         left_tube = {{ type = \"cylindrical\", bodies = [\"left_a\", \"left_b\"], at = \"left_O\", axis = [0.2, 0.9, 0.4] }}\n\
         left_ball = {{ type = \"spherical\", bodies = [\"left_a\", \"left_c\"], at = \"left_B\" }}\n\
         left_rail = {{ type = \"translational\", bodies = [\"ground\", \"left_e\"], at = \"left_R\", axis = [0.5, 0.5, 0.7] }}\n\
         [drivers]\n\
         left_swing = {{ joint = \"left_hinge\", law = \"14*t - 3*t^2\" }}\n\
         left_angle = {{ joint = \"left_tube\", coordinate = \"angle\", law = \"20*t + 4*t^2\" }}\n\
         left_way = {{ joint = \"left_tube\", coordinate = \"displacement\", law = \"25*t + 9*t^2\" }}\n\
         left_rail_way = {{ joint = \"left_rail\", law = \"12*t + 7*t^2\" }}\n\
         left_c1 = {{ body = \"left_c\", about = \"x\", law = \"5*t + t^2\" }}\n\
         left_c2 = {{ body = \"left_c\", about = \"y\", law = \"-4*t - t^2\" }}\n\
         left_c3 = {{ body = \"left_c\", about = \"z\", law = \"3*t + t^2\" }}\n\
         [points]\nleft_p = {{ body = \"left_b\", at = \"left_P\" }}\n\
         {wheel}[measures]\n\
         left_swing_moment = {{ type = \"driver_force\", driver = \"left_swing\" }}\n\
         left_turned_moment = {{ type = \"driver_force\", driver = \"left_angle\" }}\n\
         left_push = {{ type = \"driver_force\", driver = \"left_way\" }}\n\
         left_rail_push = {{ type = \"driver_force\", driver = \"left_rail_way\" }}\n\
         left_power = {{ type = \"driver_power\", driver = \"left_angle\" }}\n{measures}{tables}"
        ),
    )
}

/// Measures that are opposite on the other side: the moment about the cylindrical joint's angle, and components of
/// reactions.
fn opposite_loads(across: usize) -> Vec<String> {
    let force = |k: usize| format!("_force_{}", AXES[k]);
    let moment = |k: usize| format!("_moment_{}", AXES[k]);
    let mut all = vec!["turned_moment".to_owned(), force(across)];
    all.extend((0..3).filter(|k| *k != across).map(moment));
    all
}

#[test]
fn every_mass_and_force() {
    masses_and_forces(&mut hold_both_sides);
}

pub(crate) fn masses_and_forces(hold: Hold<'_>) {
    let folder = tempfile::tempdir().unwrap();
    let stl = "solid s\n".to_owned()
        + &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
            .map(|face| {
                let corner = |k: usize| [[0, 400, 0], [60, 410, 5], [0, 470, 0], [10, 420, 50]][k];
                let corners = face.map(|k| corner(k).map(|x| x.to_string()).join(" "));
                format!(
                    "facet normal 0 0 0\nouter loop\nvertex {}\nendloop\nendfacet\n",
                    corners.join("\nvertex ")
                )
            })
            .concat()
        + "endsolid s\n";
    std::fs::write(folder.path().join("s.stl"), stl).unwrap();
    for element in ElementType::ALL {
        let point = |body: &str, at: &str| format!("{{ body = \"{body}\", at = {at} }}");
        let keys: Vec<String> = match element.name {
            "rigid" => vec![
                format!("centre = {}, mass = 3, ixx = 0.02, iyy = 0.03, izz = 0.04, ixy = 0.004, iyz = 0.003, izx = -0.002", point("left_b", "[20, 450, 30]")),
                format!("centre = {}, mass = 2, ixx = 0.6, iyy = 0.3, izz = 0.6, ixy = 0.05, about = {}", point("left_b", "[20, 450, 30]"), point("left_b", "[10, 300, 20]")),
            ],
            "bar" => vec![format!("from = {}, to = {}, diameter = 30, bore = 10, density = 7850", point("left_b", "\"left_O\""), point("left_b", "\"left_P\""))],
            "block" => vec![format!("centre = {}, x = 30, y = 40, z = 70, density = 2700", point("left_b", "[20, 450, 30]"))],
            "mesh" => vec!["body = \"left_b\", mesh = \"s.stl\", density = 2700".into()],
            "spring" => vec![
                format!("from = {}, to = {}, stiffness = 20, cubic = 0.01, preload = 30, damping = 0.4", point("ground", "[0, 200, 300]"), point("left_b", "\"left_P\"")),
                format!("from = {}, to = {}, compression = [[0, 0], [20, \"3*10^2\"], [90, 2500]], free_length = 420, scale = 1.2", point("ground", "[0, 200, 300]"), point("left_b", "\"left_P\"")),
                format!("from = {}, to = {}, extension = [[0, 0], [20, 300], [900, 2500]], free_length = 300", point("ground", "[0, 200, 300]"), point("left_b", "\"left_P\"")),
            ],
            "joint_spring" => vec![
                "joint = \"left_tube\", coordinate = \"displacement\", stiffness = 12, equilibrium = 5, damping = 0.3".into(),
                "joint = \"left_tube\", coordinate = \"displacement\", stiffness = 12, curve = [[-9, \"-40/2\"], [0, 0], [5, \"15*2\"]]".into(),
            ],
            "torsion_spring" => vec![
                "joint = \"left_tube\", coordinate = \"angle\", stiffness = 0.3, equilibrium = 4, damping = 0.02".into(),
                "joint = \"left_hinge\", stiffness = 0.3, equilibrium = 4, damping = 0.02".into(),
                "joint = \"left_hinge\", stiffness = 0.3, equilibrium = 4, curve = [[-9, -2], [0, 0], [5, 3]], scale = 1.1".into(),
            ],
            "friction" => vec![
                "joint = \"left_hinge\", coefficient = 0.1, radius = 12, length = 40, viscous = 0.01".into(),
                "joint = \"left_tube\", coefficient = 0.1, radius = 12".into(),
                "joint = \"left_ball\", coefficient = 0.1, radius = 12".into(),
            ],
            "slide_friction" => vec![
                "joint = \"left_tube\", coefficient = 0.1, length = 60, viscous = 0.02".into(),
                "joint = \"left_rail\", coefficient = 0.1, ignored_direction = [0.5, -0.5, 0]".into(),
            ],
            "force" => ["global", "body"].map(|axes| format!("at = {}, force = 50, along = [0.4, 0.3, 0.8], axes = \"{axes}\", law = \"1 + t\"", point("left_b", "\"left_P\""))).into(),
            "wheel_force" => vec!["wheel = \"left\", outboard = 300, forward = -200, up = 2000, law = \"1 - 0.3*t\"".into()],
            "moment" => ["global", "body"].map(|axes| format!("body = \"left_b\", moment = 5, about = [0.4, 0.3, 0.8], axes = \"{axes}\", law = \"1 + t\"")).into(),
            "tyre" => vec!["wheel = \"left\", stiffness = 200, preload = 3000, height = 20, law = \"1 - 0.3*t\"".into()],
            "bushing" => vec![format!("from = {}, to = {}, x = 100, y = 200, z = 300, about_x = 0.5, about_y = 0.7, about_z = 0.9, damping = 0.1", point("left_a", "[60, 420, 10]"), point("left_c", "[60, 420, 10]"))]
                .into_iter()
                .chain(["", "axis = [0.3, 1, 0.2], axis2 = [1, 0.2, 0.1],", "axis = { through = [\"left_O\", \"left_P\"] }, axis2 = [1, 0, 0.1],"].map(|axes| {
                    format!("from = {}, to = {}, {axes} x = 0.05, y = 0.1, z = 0.15, about_x = 0.00025, curve_x = [[-5, \"-0.9/2\"], [0, 0], [3, 0.35]], curve_y = [[-4, -0.1], [0, 0], [3, 0.35]], curve_z = [[-5, -0.045], [0, 0], [4, 0.035]], curve_about_x = [[-9, -0.004], [0, 0], [7, 0.005]], curve_about_y = [[-8, -0.003], [0, 0], [9, 0.005]], curve_about_z = [[-6, -0.002], [0, 0], [8, 0.004]], cubic_about_z = 0.000001, scale_about_y = 0.8, scale_x = 1.2, preload_x = 0.015, preload_y = 0.025, preload_z = 0.035, preload_about_x = 0.001, preload_about_y = 0.0015, preload_about_z = 0.002, matrix = [[0.05, 0.01, 0.015, 0.005, 0.01, 0.015], [0.01, 0.05, 0.02, 0.015, 0.005, 0.01], [0.015, 0.02, 0, 0.01, 0.015, 0.005], [0.005, 0.015, 0.01, 0.0005, 0.0001, 0.00015], [0.01, 0.005, 0.015, 0.0001, 0.001, 5e-05], [0.015, 0.01, 0.005, 0.00015, 5e-05, 0.0005]]", point("left_a", "[60, 420, 10]"), point("left_c", "[60, 420, 10]"))
                }))
                .chain([format!("from = {}, to = {}, axis = [0.3, 1, 0.2], x = 1, y = 1, z = 3, about_z = 0.03, preload_z = 0.7, preload_about_z = 0.04", point("left_a", "[60, 420, 10]"), point("left_c", "[60, 420, 10]"))])
                .collect(),
            "elastic_joint" => vec!["joint = \"left_hinge\", x = 1000, y = 3000, z = 2000, about_x = 50, about_y = 20".into()],
            other => panic!("no mechanism for `{other}`"),
        };
        for keys in keys {
            for across in 0..3 {
                if ["wheel_force", "tyre"].contains(&element.name) && across != 1 {
                    continue;
                }
                let mass = "left_mass = { type = \"rigid\", centre = { body = \"left_b\", at = [10, 440, 10] }, mass = 4, ixx = 0.02, iyy = 0.03, izz = 0.04 }\n\
                            left_other = { type = \"rigid\", centre = { body = \"left_c\", at = [150, 540, 60] }, mass = 2, ixx = 0.02, iyy = 0.03, izz = 0.04 }\n\
                            left_third = { type = \"rigid\", centre = { body = \"left_e\", at = [320, 340, 60] }, mass = 2, ixx = 0.02, iyy = 0.03, izz = 0.04 }\n";
                let own = format!("left_element = {{ type = \"{}\", {keys} }}\n", element.name);
                let sections = match element.table {
                    "masses" => format!("[masses]\n{mass}{own}"),
                    _ => {
                        // A force with no number of its own is elastic or has friction.
                        let is_felt = if element.name == "elastic_joint" {
                            "left_give = { type = \"compliance\", of = \"left_height\", at = \"left_p\", along = [0.2, 0.1, 1] }\nleft_height = { type = \"position\", point = \"left_p\", along = [0.2, 0.1, 1] }\n"
                        } else {
                            ""
                        };
                        format!("{is_felt}[masses]\n{mass}[forces]\n{own}")
                    }
                };
                let text = loaded(across, &sections);
                let what = format!("{} {keys}", element.name);
                let opposite = opposite_loads(across);
                let opposite: Vec<&str> = opposite.iter().map(String::as_str).collect();
                if element.name == "mesh" {
                    // Its surface is in a file, so that the model is too.
                    let path = folder.path().join("sides.toml");
                    std::fs::write(&path, &text).unwrap();
                    let model = read(&path).unwrap_or_else(|e| panic!("{what}: {e}")).model;
                    let solution = Analysis::new(&model).unwrap().run();
                    let value = |name: &str| {
                        let m = model.measures.iter().position(|m| m.name == name).unwrap();
                        (0..solution.motion.len())
                            .map(|k| solution.measured.value(k, m)[0])
                            .collect::<Vec<_>>()
                    };
                    for (name, sign) in [("swing_moment", 1.0), ("turned_moment", -1.0), ("push", 1.0)] {
                        let [a, b] = ["left", "right"].map(|side| value(&format!("{side}_{name}")));
                        let size = a.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
                        assert!(
                            a.iter().zip(&b).all(|(a, b)| (a - sign * b).abs() <= SAME * size),
                            "{name} {a:?} {b:?}"
                        );
                    }
                } else {
                    hold(&what, &text, across, &opposite);
                }
            }
        }
    }
}

#[test]
fn every_measure() {
    measures(&mut hold_both_sides);
}

pub(crate) fn measures(hold: Hold<'_>) {
    for kind in MeasureType::ALL {
        // Shapes and clearances have a mirror of their own (`clearance.rs`).
        if kind.name == "clearance" {
            continue;
        }
        // The measure, and across which axes it is opposite; what counts along global axes is.
        let all: Vec<(&str, &[usize])> = match kind.name {
            "coordinate" => vec![
                ("joint = \"left_tube\", coordinate = \"angle\"", &[0, 1, 2]),
                ("joint = \"left_tube\", coordinate = \"displacement\"", &[]),
            ],
            "distance" => vec![("from = \"left_p\", to = { body = \"ground\", at = [0, 200, 300] }", &[])],
            "position" | "velocity" | "acceleration" => {
                vec![("point = \"left_p\", along = [0.3, 0.2, 0.9]", &[])]
            }
            "angle" => vec![
                ("from = [\"left_p\", { body = \"left_a\", at = \"left_H\" }], to = [0, 0.3, 1]", &[]),
                (
                    "from = [\"left_p\", { body = \"left_a\", at = \"left_H\" }], to = { body = \"left_b\", axis = [0.1, 0.3, 1] }, about = [1, 0.2, 0.3]",
                    &[],
                ),
            ],
            "orientation" => vec![
                ("body = \"left_b\", angle = \"cardan_1\"", &[1, 2]),
                ("body = \"left_b\", angle = \"cardan_2\"", &[0, 2]),
                ("body = \"left_b\", angle = \"yaw\"", &[0, 1]),
            ],
            "articulation" => vec![("joint = \"left_hinge\", axis = [0.3, 0.2, 0.9]", &[])],
            "transmission_angle" => {
                vec![("from = [\"left_p\", { body = \"left_a\", at = \"left_H\" }], to = [0, 0.3, 1]", &[])]
            }
            "angular_velocity" => {
                vec![("body = \"left_b\", along = [0.3, 0.2, 0.9]", &[]), ("body = \"left_b\"", &[])]
            }
            "curvature" => {
                vec![("point = \"left_p\", about = [0.3, 0.2, 0.9]", &[]), ("point = \"left_p\"", &[])]
            }
            "rate" => vec![("of = \"left_base\"", &[])],
            "slope" => vec![("of = \"left_base\", over = \"left_far\", driver = \"left_swing\"", &[])],
            "dexterity" => vec![(
                "points = [\"left_p\", { body = \"left_b\", at = \"left_H\" }], drivers = [\"left_swing\"], value = \"least_gain\"",
                &[],
            )],
            "expression" => vec![("expression = \"2*left_base + left_far^2/100\"", &[])],
            "toe" | "camber" => vec![("body = \"left_b\", spin_axis = [0.05, 1, 0.02]", &[])],
            "driver_force" | "driver_power" => {
                vec![("driver = \"left_swing\"", &[]), ("driver = \"left_way\"", &[])]
            }
            "reaction" => vec![
                ("joint = \"left_hinge\", part = \"force\"", &[]),
                ("joint = \"left_hinge\", part = \"radial\"", &[]),
                ("joint = \"left_hinge\", part = \"bending\"", &[]),
                // An axis to turn about is turned round, and so is the force along it; of a slide it is the moment.
                ("joint = \"left_hinge\", part = \"axial\"", &[0, 1, 2]),
                ("joint = \"left_hinge\", part = \"torque\"", &[]),
                ("joint = \"left_rail\", part = \"axial\"", &[]),
                ("joint = \"left_rail\", part = \"torque\"", &[0, 1, 2]),
            ],
            "spring_force" => vec![("force = \"left_spring\"", &[]), ("force = \"left_twist\"", &[0, 1, 2])],
            "deflection" => vec![
                ("force = \"left_soft\", direction = \"about_z\"", &[]),
                // Its axes are the global ones on both sides.
                ("force = \"left_bush\", direction = \"x\"", &[0]),
                ("force = \"left_bush\", direction = \"about_x\"", &[1, 2]),
            ],
            "kinetic_energy" => vec![("body = \"left_b\"", &[])],
            // What the whole mechanism puts on ground is that of both sides.
            "shaking_force" => vec![("along = [0.3, 0.2, 0.9]", &[])],
            "shaking_moment" => {
                vec![("about = { body = \"ground\", at = [10, 200, 30] }, along = [0.3, 0.2, 0.9]", &[])]
            }
            "compliance" => vec![("of = \"left_base\", at = \"left_p\", along = [0.2, 0.1, 1]", &[])],
            other => panic!("no mechanism for measure `{other}`"),
        };
        for (keys, opposite) in all {
            for across in 0..3 {
                // Toe counts from the vehicle's sides.
                if ["toe", "camber"].contains(&kind.name) && across != 1 {
                    continue;
                }
                let text = loaded(
                    across,
                    &format!(
                        "left_base = {{ type = \"position\", point = \"left_p\", along = [0.2, 0.7, 1] }}\n\
                     left_far = {{ type = \"distance\", from = \"left_p\", to = {{ body = \"ground\", at = [0, 200, 300] }} }}\n\
                     left_measured = {{ type = \"{}\", {keys} }}\n\
                     [masses]\nleft_mass = {{ type = \"rigid\", centre = {{ body = \"left_b\", at = [10, 440, 10] }}, mass = 4, ixx = 0.02, iyy = 0.03, izz = 0.04 }}\n\
                     [forces]\nleft_spring = {{ type = \"spring\", from = {{ body = \"ground\", at = [0, 200, 300] }}, to = \"left_p\", stiffness = 20 }}\n\
                     left_twist = {{ type = \"torsion_spring\", joint = \"left_tube\", coordinate = \"angle\", stiffness = 0.3, equilibrium = 4 }}\n\
                     left_soft = {{ type = \"elastic_joint\", joint = \"left_hinge\", x = 1000, y = 3000, z = 2000 }}\n\
                     left_bush = {{ type = \"bushing\", from = {{ body = \"left_a\", at = [60, 420, 10] }}, to = {{ body = \"left_c\", at = [60, 420, 10] }}, x = 2, y = 3, z = 4 }}\n",
                        kind.name
                    ),
                );
                let mut all = opposite_loads(across);
                if opposite.contains(&across) {
                    all.push("left_measured".into());
                }
                let all: Vec<&str> = all.iter().map(String::as_str).collect();
                hold(&format!("{} {keys}", kind.name), &text, across, &all);
            }
        }
    }
}

#[test]
fn every_measure_of_wheels_and_axles() {
    wheels_and_axles(&mut hold_both_sides);
}

pub(crate) fn wheels_and_axles(hold: Hold<'_>) {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("../../models/front_axle.toml")).unwrap();
    let list = text.split("measures = [").nth(1).and_then(|rest| rest.split(']').next()).unwrap();
    let symmetric = text
        .replace("right_bump = { law = \"60*sin(6*pi*t)\" }\n", "")
        .replace("15*sin(2*pi*t)", "0")
        .replace("steps = 200", "steps = 24")
        .replace("\n[wheels.right]\nmeasures = [\"toe\", \"camber\", \"steer_angle\", \"wheel_travel\", \"roll_centre_height\"]\n", "")
        .replace("bump = \"left_bump\"\n", "bump = \"left_bump\"\nsteer = \"steering\"\nspring = [{ body = \"ground\", at = \"left_damper_top\" }, { body = \"left_lca\", at = \"left_damper_foot\" }]\narm_planes = [{ body = \"left_lca\", at = [\"left_lca_front\", \"left_lca_rear\", \"left_lower_ball\"] }, { body = \"left_uca\", at = [\"left_uca_front\", \"left_uca_rear\", \"left_upper_ball\"] }]\n")
        .replace(&format!("measures = [{list}]"), "measures = \"all\"");
    let mut seen = Vec::new();
    for end in ["front", "rear"] {
        let text = symmetric.replace("end = \"front\"", &format!("end = \"{end}\""));
        let (model, solution) = solved("wheels", &text);
        // Counted along y, and about what is not across, on either side.
        let opposite =
            ["steer_angle", "contact_y", "instant_centre_front_y", "plane_centre_front_y", "instant_axis_y"];
        let wheels = |name: &str| {
            let what = name.strip_prefix("left.");
            what.is_some_and(|w| WheelMeasure::named(w).is_some())
        };
        seen.extend(model.measures.iter().filter_map(|m| m.name.strip_prefix("left.").map(str::to_owned)));
        assert!(model.measures.iter().any(|m| wheels(&m.name)));
        hold("wheel", &text, 1, &opposite);
        for what in AxleMeasure::ALL {
            let Some(m) = model.measures.iter().position(|m| m.name == format!("front.{}", what.name()))
            else {
                panic!("no axle has `{}`", what.name());
            };
            // In a motion that is its own image nothing of the axle is to one side.
            if *what == AxleMeasure::RollCentreY {
                for k in 0..solution.motion.len() {
                    let y = solution.measured.value(k, m)[0];
                    assert!(y.abs() < 1e-9 || y.is_nan(), "{y}");
                }
            }
        }
    }
    for what in WheelMeasure::ALL {
        assert!(seen.iter().any(|s| s == what.name()), "no wheel has `{}`", what.name());
    }
}

/// Names with words of both sides, as a prefix makes them: each has an image of its own.
#[test]
fn names_with_words_of_both_sides_have_images_of_their_own() {
    let text = |mirror: &str| {
        format!(
            "name = \"words\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\nmirror = {{ {mirror} }}\n[hardpoints]\nleft_pivot = [0, 500, 0]\nleft_tip = [0, 800, 0]\n\
             [bodies]\nleft_arm = {{}}\n[joints]\nleft_hinge = {{ type = \"revolute\", bodies = [\"ground\", \"left_arm\"], at = \"left_pivot\", axis = \"x\" }}\n\
             [drivers]\nleft_motor = {{ joint = \"left_hinge\", law = \"10*t\" }}\n[masses]\n\
             left_lug_left = {{ type = \"rigid\", centre = {{ body = \"left_arm\", at = \"left_tip\" }}, mass = 1 }}\n\
             left_lug_right = {{ type = \"rigid\", centre = {{ body = \"left_arm\", at = \"left_tip\" }}, mass = 3 }}\n\
             l_lug_left = {{ type = \"rigid\", centre = {{ body = \"left_arm\", at = \"left_tip\" }}, mass = 5 }}\n\
             [time]\nend = 1\nsteps = 1\n"
        )
    };
    let model = parse(&text(""), "words.toml").unwrap().model;
    let mass = |name: &str| {
        let element = model.elements.iter().find(|e| e.name == name).unwrap_or_else(|| panic!("{name}"));
        let hardpoint::model::ElementKind::Rigid(rigid) = &element.kind else { panic!("{name}") };
        model.numbers[rigid.mass.0.0].value
    };
    assert_eq!(model.elements.len(), 6);
    assert_eq!([mass("right_lug_right"), mass("right_lug_left"), mass("l_lug_right")], [1.0, 3.0, 5.0]);
    // Two words with one counterpart.
    let clash =
        parse(&text("names = { left = \"right\", l = \"right\" }"), "words.toml").unwrap_err().to_string();
    assert!(clash.contains("have the same image `right_lug_right`"), "{clash}");
}

//! Clearances: published data of a knee, shapes against samples, metamorphic checks.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use hardpoint::model::{Model, VariableId};
use hardpoint::motion::StopKind;
use hardpoint::run::{ClearanceProof, Clearances, MetricValue, MinimumPlace, PairClearance, ShapeDistance};
use hardpoint::{Analysis, Run};
use hardpoint_file::{parse, parse_with};
use serde_json::Value;

use crate::proof::numbers;

/// Round-off of distances in mm, and of times in s, at values of 10 to 100.
const EXACT: f64 = 1e-10;
/// Tolerance of the limits of an optimisation, m.
const LIMIT: f64 = 1e-8;

fn model_of(text: &str) -> Model {
    parse(text, "clearance.toml").unwrap_or_else(|e| panic!("{e}\n{text}")).model
}

fn number(value: &Value) -> f64 {
    value.as_str().map_or_else(|| value.as_f64().unwrap(), |text| text.parse().unwrap())
}

fn pair<'c>(model: &'c Model, found: &'c Clearances, clearance: &str) -> &'c PairClearance {
    let clearance = model.clearances.iter().find(|c| c.name == clearance).unwrap();
    found.of(clearance).next().unwrap().1
}

fn assert_near(found: f64, expected: f64, what: &str) {
    assert!(
        (found - expected).abs() <= EXACT * expected.abs().max(1.0),
        "{what}: {found} instead of {expected}"
    );
}

/// Four-bar with rods against screw heads: values at 50 digits, by other kinematics and by the formulas of
/// the design note.
const KNEE: &str = include_str!("knee.toml");

#[test]
fn minima_and_contacts_of_the_knee_are_those_of_the_published_data() {
    let data: Value = serde_json::from_str(include_str!("knee.json")).unwrap();
    let model = model_of(KNEE);
    let found = Analysis::new(&model).unwrap().clearances(&[]);
    let pairs = [("c1", "coupler-screw1"), ("c2", "coupler-screw2"), ("r1", "rocker-screw1")];
    let name = |v: &str| match v {
        "screw1_x" | "screw1_y" | "screw2_x" | "screw2_y" => v.replace('_', ".").replace('.', "_"),
        other => other.to_string(),
    };
    let derivatives = |d: &[f64], by: &Value, per: f64, what: &str| {
        for (v, expected) in by.as_object().unwrap() {
            let variable = model.variable(&name(v)).unwrap_or_else(|| panic!("{v} {:?}", model.variables));
            assert_near(d[variable.0] * per, number(expected), &format!("{what} by {v}"));
        }
    };
    for (clearance, key) in pairs {
        let expected = &data["pairs"][key];
        let pair = pair(&model, &found, clearance);
        for row in expected["curve"].as_array().unwrap() {
            let at = &pair.curve[row[0].as_u64().unwrap() as usize];
            for (order, x) in at.distance.iter().enumerate() {
                assert_near(
                    x * 1e3,
                    number(&row[order + 1]),
                    &format!("{key}, order {order} at {}", at.time),
                );
            }
        }
        let inside: Vec<_> = pair.minima.iter().filter(|m| m.place == MinimumPlace::Inside).collect();
        let minima = expected["minima"].as_array().unwrap();
        let minima: Vec<_> = minima
            .iter()
            .filter(|m| (0.0..1.0).contains(&number(&m["t"])) && number(&m["t"]) > 0.0)
            .collect();
        assert_eq!(inside.len(), minima.len(), "{key}");
        for (minimum, expected) in inside.iter().zip(minima) {
            assert_near(minimum.at.time, number(&expected["t"]), key);
            assert_near(minimum.at.distance[0] * 1e3, number(&expected["value"]), key);
            assert_near(minimum.at.distance[2] * 1e3, number(&expected["second_rate"]), key);
            derivatives(&minimum.d, &expected["by"], 1.0, key);
        }
        let contacts = expected["contacts"].as_array().unwrap();
        assert_eq!(pair.contacts.len(), contacts.len(), "{key}");
        for (contact, expected) in pair.contacts.iter().zip(contacts) {
            assert_near(contact.at.time, number(&expected["t"]), key);
            assert_eq!(contact.begins, expected["kind"] == "touches");
            assert_near(contact.at.distance[1] * 1e3, number(&expected["rate"]), key);
            derivatives(&contact.d, &expected["by"], 1e-3, key);
        }
    }
}

#[test]
fn the_least_of_several_pairs_is_a_metric() {
    let model = model_of(KNEE);
    let solution = Analysis::new(&model).unwrap().run();
    let values = hardpoint::run::metrics(&model, &solution);
    let of = |name: &str| {
        let k = model.metrics.iter().position(|m| m.name == name).unwrap();
        values[k].value.unwrap() * 1e3
    };
    assert_near(of("c1.min"), -0.2064275563667836, "c1");
    assert_near(of("c2.min"), 1.794967044519548, "c2");
    assert_near(of("r1.min"), 2.541030034433604, "r1");
    assert_near(of("all.min"), -0.2064275563667836, "all");
}

/// A knee whose coupler hits a screw, with the limits of the gallery's model.
const GALLERY: &str = include_str!("../../../../models/studies/knee.toml");

#[test]
fn a_limit_of_a_clearance_brings_shapes_apart() {
    let file = parse(GALLERY, "knee.toml").unwrap_or_else(|e| panic!("{e}"));
    let model = &file.model;
    let limits = &model.optimization.as_ref().unwrap().limits;
    assert_eq!((limits[0].least, limits[0].most), (Some(1.5e-3), None));
    let analysis = Analysis::new(model).unwrap();
    let touching = |c: &Clearances| c.pairs.iter().any(|pair| pair.least().unwrap().at.distance[0] < 0.0);
    assert!(touching(&analysis.clearances(&[])));
    let found = crate::searches::searched(&file, model.optimization.as_ref().unwrap());
    let best = crate::searches::best(&found).found.as_ref().unwrap();
    for pair in &analysis.clearances(&best.design).pairs {
        let least = pair.least().unwrap().at.distance[0];
        assert!(least > 1.5e-3 - LIMIT, "{:?}: {least}", pair.shapes);
    }
}

#[test]
fn an_interrupted_search_keeps_the_times_that_were_solved() {
    let model = model_of(&KNEE.replace("steps = 20", "steps = 20000"));
    let whole = Analysis::new(&model).unwrap().clearances(&[]);
    let search = |pause: Duration| {
        let flag = Arc::new(AtomicBool::new(pause.is_zero()));
        let analysis = Analysis::new(&model).unwrap().ended_by(Arc::clone(&flag));
        std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(pause);
                flag.store(true, Ordering::Relaxed);
            });
            analysis.clearances(&[])
        })
    };
    let none = search(Duration::ZERO);
    assert!(none.pairs.iter().all(|pair| pair.curve.is_empty() && pair.least().is_none()));
    // The duration of the search depends on the machine.
    let mut pause = Duration::from_millis(20);
    let found = loop {
        let found = search(pause);
        match &found.stop {
            None => pause /= 2,
            Some(_) if found.pairs[0].curve.is_empty() => pause *= 2,
            Some(_) => break found,
        }
    };
    let stop = found.stop.unwrap();
    assert_eq!(stop.kind, StopKind::Interrupted);
    for (part, whole) in found.pairs.iter().zip(&whole.pairs) {
        let solved = part.curve.len();
        assert_eq!(stop.last_time, part.curve.last().map(|at| at.time));
        let lowest = part.curve.iter().map(|at| at.distance[0]).fold(f64::INFINITY, f64::min);
        assert!(part.least().unwrap().at.distance[0] <= lowest + 1e-12);
        assert!(part.minima.iter().all(|minimum| minimum.d.len() == model.variables.len()));
        for (a, b) in part.curve.iter().zip(&whole.curve[..solved]) {
            assert!(a.time == b.time && (a.distance[0] - b.distance[0]).abs() < 1e-12);
        }
        // Both have the same contacts so far, at the nearest times that were solved.
        let contacts = |pair: &PairClearance| pair.contacts.iter().map(|c| c.begins).collect::<Vec<_>>();
        assert!(contacts(whole).starts_with(&contacts(part)));
    }
}

/// Distances of the same model that is described in other words.
#[test]
fn what_must_not_matter_does_not() {
    let reference = Analysis::new(&model_of(KNEE)).unwrap().clearances(&[]);
    let coarse = KNEE.replace("steps = 20", "steps = 3");
    let fine = KNEE.replace("steps = 20", "steps = 157");
    let metres = KNEE
        .replace("length = \"mm\"", "length = \"cm\"")
        .replace("[14, 25]", "[1.4, 2.5]")
        .replace("[78, 52]", "[7.8, 5.2]")
        .replace("[66, -6]", "[6.6, -0.6]")
        .replace("[22, 47.5, -2]", "[2.2, 4.75, -0.2]")
        .replace("[-2, 40, -2]", "[-0.2, 4.0, -0.2]")
        .replace(".y\", 7]", ".y\", 0.7]")
        .replace("value = 4,", "value = 0.4,")
        .replace("value = 3.5,", "value = 0.35,")
        .replace("min = 1.5", "min = 0.15");
    let swapped = KNEE.replace("[\"coupler_rod\", \"screw1\"]", "[\"screw1\", \"coupler_rod\"]");
    let reversed = KNEE.replace("capsule = [\"B\", \"C\"]", "capsule = [\"C\", \"B\"]");
    for (what, text) in
        [("coarse", coarse), ("fine", fine), ("cm", metres), ("swapped", swapped), ("reversed", reversed)]
    {
        let model = model_of(&text);
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        for (a, b) in reference.pairs.iter().zip(&found.pairs) {
            assert_eq!(a.minima.len(), b.minima.len(), "{what}");
            for (m, n) in a.minima.iter().zip(&b.minima) {
                assert_near(n.at.time, m.at.time, what);
                assert!((n.at.distance[0] - m.at.distance[0]).abs() < 1e-13, "{what}");
                for (x, y) in n.d.iter().zip(&m.d) {
                    assert_near(*x, *y, what);
                }
            }
            assert_eq!(a.contacts.len(), b.contacts.len(), "{what}");
            for (m, n) in a.contacts.iter().zip(&b.contacts) {
                assert_near(n.at.time, m.at.time, what);
            }
        }
    }
}

/// A cube of 12 triangles, sides of 40.
const CUBE: &str = "
v -20 -20 -20
v 20 -20 -20
v 20 20 -20
v -20 20 -20
v -20 -20 20
v 20 -20 20
v 20 20 20
v -20 20 20
f 1 3 2
f 1 4 3
f 5 6 7
f 5 7 8
f 1 2 6
f 1 6 5
f 2 3 7
f 2 7 6
f 3 4 8
f 3 8 7
f 4 1 5
f 4 5 8
";

/// A cube that turns about an axis through its centre, and a ball beside it.
fn cube(axis: &Value, design: &Value, shape: &str) -> String {
    let [x, y, z, r] = ["c_x", "c_y", "c_z", "r"].map(|key| number(&design[key]));
    format!(
        r#"
name = "cube"
units = {{ length = "mm", angle = "deg" }}
bodies = {{ cube = {{ frame = {{ position = [0, 0, 0] }} }} }}
parameters.r = {{ value = {r}, unit = "length" }}
hardpoints = {{ O = [0, 0, 0], c = [{x}, {y}, {z}] }}
joints.pivot = {{ type = "revolute", bodies = ["ground", "cube"], at = "O", axis = {axis} }}
drivers.motor = {{ joint = "pivot", law = "360*t" }}
shapes.ball = {{ body = "ground", sphere = "c", radius = "r" }}
shapes.cube = {{ body = "cube", {shape} }}
clearances.gap = {{ between = ["ball", "cube"] }}
design.c = {{ move = "c", along = "xyz" }}
time = {{ end = 1, steps = 40 }}
"#
    )
}

#[test]
fn a_ball_against_a_closed_mesh_a_box_and_a_hull_is_that_of_the_published_data() {
    let data: Value = serde_json::from_str(include_str!("cube.json")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    let corners: Vec<String> =
        (0..8).map(|k| format!("{:?}", [k & 1, k >> 1 & 1, k >> 2 & 1].map(|side| 40 * side - 20))).collect();
    let hull = format!("hull = [{}]", corners.join(", "));
    for (name, case) in data["cases"].as_object().unwrap() {
        for shape in ["mesh = \"cube.obj\"", "box = [40, 40, 40]", &hull] {
            let path = folder.path().join("cube.toml");
            std::fs::write(&path, cube(&case["axis"], &case["design"], shape)).unwrap();
            let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
            let found = Analysis::new(&model).unwrap().clearances(&[]);
            let pair = pair(&model, &found, "gap");
            let what = format!("{name}, {shape}");
            for row in case["curve"].as_array().unwrap() {
                let at = &pair.curve[row[0].as_u64().unwrap() as usize];
                assert_near(at.distance[0] * 1e3, number(&row[1]), &what);
            }
            let inside: Vec<_> = pair.minima.iter().filter(|m| m.place == MinimumPlace::Inside).collect();
            // Minima of the key are those within its band; all local minima are found.
            for expected in case["minima"].as_array().unwrap() {
                let time = number(&expected["t"]);
                let minimum = inside
                    .iter()
                    .min_by(|a, b| (a.at.time - time).abs().total_cmp(&(b.at.time - time).abs()))
                    .unwrap();
                assert_near(minimum.at.time, time, &what);
                assert_near(minimum.at.distance[0] * 1e3, number(&expected["value"]), &what);
                assert_eq!(minimum.is_kink, expected["kink"] == true, "{what}");
                for variable in ["c_x", "c_y", "c_z", "r"] {
                    let k = model.variable(variable).unwrap().0;
                    assert_near(
                        minimum.d[k],
                        number(&expected["by"][variable]),
                        &format!("{what} by {variable}"),
                    );
                }
            }
            let contacts = case["contacts"].as_array().unwrap();
            assert_eq!(pair.contacts.len(), contacts.len(), "{what}");
            for (contact, expected) in pair.contacts.iter().zip(contacts) {
                assert_near(contact.at.time, number(&expected["t"]), &what);
                for variable in ["c_x", "c_y", "c_z", "r"] {
                    let k = model.variable(variable).unwrap().0;
                    let expected = number(&expected["by"][variable]);
                    assert_near(contact.d[k] * 1e-3, expected, &format!("{what} by {variable}"));
                }
            }
        }
    }
}

#[test]
fn the_distance_of_a_ball_that_moves_over_the_middle_of_a_face_has_no_acceleration() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    for shape in ["mesh = \"cube.obj\"", "box = [40, 40, 40]"] {
        // At t = 0 over both diagonals of the face.
        for axis in ["[1, 1, 0]", "[1, -1, 0]", "[0, 1, 0]"] {
            let text = format!(
                r#"
name = "over"
units = {{ length = "mm", angle = "deg" }}
time = {{ start = -1, end = 1, steps = 2 }}
bodies = {{ slider = {{}} }}
joints.slide = {{ type = "translational", bodies = ["ground", "slider"], at = [0, 0, 40], axis = {axis} }}
drivers.push = {{ joint = "slide", law = "5*t" }}
shapes.block = {{ body = "ground", {shape} }}
shapes.ball = {{ body = "slider", sphere = [0, 0, 40], radius = 3 }}
clearances.gap = {{ between = ["ball", "block"] }}
"#
            );
            let path = folder.path().join("over.toml");
            std::fs::write(&path, text).unwrap();
            let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
            let found = Analysis::new(&model).unwrap().clearances(&[]);
            for at in &found.pairs[0].curve {
                let [distance, rate, acceleration] = at.distance.map(|x| x * 1e3);
                assert_near(distance, 17.0, shape);
                assert!(rate.abs() < EXACT && acceleration.abs() < EXACT, "{shape}, {axis}: {at:?}");
            }
        }
    }
}

/// Shapes of every kind on a body (`m_`), and of every kind on ground (`g_`).
const SHAPES: [(&str, &str, &str); 9] = [
    ("sphere", "sphere = \"p\", radius = \"r\"", "sphere = \"q\", radius = \"s\""),
    (
        "capsule",
        "capsule = [\"p\", \"p2\"], radius = \"r\"",
        "capsule = [\"q\", [70, 180, 95]], radius = \"s\"",
    ),
    (
        "ring",
        "ring = \"p\", axis = [1, 2, 3], radius = 30, round = \"r\"",
        "ring = \"q\", axis = [1, -2, 1], radius = \"w\", round = 3",
    ),
    (
        "cylinder",
        "cylinder = [\"p\", \"p2\"], radius = 25, round = 2",
        "cylinder = [\"q\", [70, 180, 95]], radius = \"w\", round = \"s\"",
    ),
    ("wheel", "wheel = \"m\", width = 24, round = \"r\"", "wheel = \"g\", width = \"w\", round = \"s\""),
    ("plane", "plane = \"p\", normal = [0.1, 1, 0.2]", "plane = [100, 400, 0], normal = [0.2, -1, 0.1]"),
    (
        "box",
        "box = [30, 20, 14], frame = { position = [100, 10, 5], cardan = [20, 30, 40] }",
        "box = [20, 40, 30], frame = { position = [93, 200, 50] }, round = \"s\"",
    ),
    (
        "hull",
        "hull = [\"p\", \"p2\", [90, -20, 10], [120, 15, -12]], round = 1",
        "hull = [\"q\", [70, 180, 95], [90, 230, 10], [120, 215, 32]]",
    ),
    (
        "mesh",
        "mesh = { file = \"cube.obj\", frame = \"body\", scale = 0.5 }",
        "mesh = { file = \"far.obj\" }, round = \"s\"",
    ),
];

/// A body that turns about two axes, with shapes of all kinds against those of ground.
fn battery() -> String {
    let mut text = String::from(
        r#"
name = "battery of shapes"
units = { length = "mm", angle = "deg" }
bodies = { mid = {}, arm = { frame = { position = [100, 0, 0] } } }
parameters.r = { value = 4, unit = "length" }
parameters.s = { value = 2.5, unit = "length" }
parameters.w = { value = 21, unit = "length" }
hardpoints = { O = [0, 0, 0], M = [40, 5, 3], p = [100, 10, -4], p2 = [125, 22, 17], q = [85, 190, 40] }
joints.one = { type = "revolute", bodies = ["ground", "mid"], at = "O", axis = [0.1, 0.2, 1] }
joints.two = { type = "revolute", bodies = ["mid", "arm"], at = "M", axis = [1, 0.3, -0.1] }
drivers.one = { joint = "one", law = "20*sin(2*t)" }
drivers.two = { joint = "two", law = "15*t + 10*t^2" }
wheels.m = { body = "arm", centre = "p", spin_axis = [0.3, 1, 0.2], radius = 33, side = "left" }
wheels.g = { body = "ground", centre = "q", spin_axis = [0.2, 1, -0.3], radius = 35, side = "left" }
design.O_x = { move = "O", along = "x" }
design.M_z = { move = "M", along = "z" }
design.p = { move = "p", along = "xyz" }
design.p2_y = { move = "p2", along = "y" }
design.q = { move = "q", along = "xyz" }
time = { end = 1, steps = 6 }
"#,
    );
    for (name, moving, fixed) in SHAPES {
        let body = |body: &str| if name == "wheel" { String::new() } else { format!("body = \"{body}\", ") };
        text += &format!("shapes.m_{name} = {{ {}{moving} }}\n", body("arm"));
        text += &format!("shapes.g_{name} = {{ {}{fixed} }}\n", body("ground"));
    }
    for (moving, ..) in SHAPES {
        for (fixed, ..) in SHAPES {
            if moving != "plane" || fixed != "plane" {
                text += &format!(
                    "clearances.{moving}_{fixed} = {{ between = [\"m_{moving}\", \"g_{fixed}\"] }}\n"
                );
            }
        }
    }
    text
}

/// A text without a folder has the triangles of its shapes, with their scale and mirror; a page has not.
#[test]
fn the_text_of_a_model_is_passed_with_the_triangles_of_its_shapes() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    let data: Value = serde_json::from_str(include_str!("cube.json")).unwrap();
    let case = data["cases"].as_object().unwrap().values().next().unwrap();
    let mesh = "mesh = { file = \"cube.obj\", scale = 0.7, mirror = \"y\" }";
    let text = cube(&case["axis"], &case["design"], mesh);
    let path = folder.path().join("cube.toml");
    std::fs::write(&path, &text).unwrap();
    let file = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}"));
    let passed = parse_with(&text, "cube.toml", &file.texts).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(passed.texts, file.texts);
    let distances = |model: &Model| {
        let found = Analysis::new(model).unwrap().clearances(&[]);
        pair(model, &found, "gap").curve.iter().map(|at| at.distance).collect::<Vec<_>>()
    };
    assert_eq!(distances(&passed.model), distances(&file.model));
    let found = parse_with(&text, "cube.toml", &file.page_texts()).unwrap_err();
    assert!(found.to_string().contains("the mesh `cube.obj` is not part of this model"), "{found}");
    let (name, triangles) = file.texts.first_key_value().unwrap();
    for wrong in [format!("{triangles} 99999 0 1"), format!("{triangles} 1"), "2 0 0".into(), String::new()] {
        let wrong = [(name.clone(), wrong)].into_iter().collect();
        assert!(parse_with(&text, "cube.toml", &wrong).is_err());
    }
}

#[test]
fn sensitivities_of_every_pair_of_shapes_are_verified() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    let far = CUBE.replace("v -20", "v 70").replace("v 20", "v 105");
    let far: String = far
        .lines()
        .map(|line| match line.strip_prefix("v ") {
            Some(at) => {
                let at: Vec<f64> = at.split(' ').map(|x| x.parse().unwrap()).collect();
                // A skewed block beside the arm.
                format!(
                    "v {} {} {}\n",
                    at[0] + 0.2 * at[1],
                    190.0 + at[1] + 0.1 * at[2],
                    40.0 + at[2] - 0.3 * at[1]
                )
            }
            None => format!("{line}\n"),
        })
        .collect();
    std::fs::write(folder.path().join("far.obj"), far).unwrap();
    let path = folder.path().join("battery.toml");
    std::fs::write(&path, battery()).unwrap();
    let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
    let solution = Analysis::new(&model).unwrap().run();
    for (m, measure) in model.measures.iter().enumerate() {
        for k in 0..solution.measured.len() {
            let [value, rate, _] = solution.measured.value(k, m);
            assert!(value > 0.02 && rate.is_finite(), "{}: {value} {rate} at {k}", measure.name);
        }
    }
    crate::equilibrium::verify_all(&model);
}

/// Distances by formulas and those of an image in a mirror, moved and turned, agree.
#[test]
fn a_mirror_has_the_same_clearances() {
    let text = r#"
name = "both sides"
units = { length = "mm", angle = "deg" }
bodies = { left_arm = {} }
hardpoints = { left_O = [0, 300, 0], left_p = [0, 500, 20], left_q = [50, 450, 200] }
joints.left_pivot = { type = "revolute", bodies = ["ground", "left_arm"], at = "left_O", axis = [1, 0.2, 0] }
drivers.left_motor = { joint = "left_pivot", law = "60*t" }
shapes.left_rod = { body = "left_arm", capsule = ["left_O", "left_p"], radius = 10 }
shapes.left_stop = { body = "ground", ring = "left_q", axis = [1, 0.3, 0.2], radius = 40, round = 4 }
shapes.left_block = { body = "ground", box = [30, 20, 60], frame = { position = [60, 430, 150], cardan = [10, 20, 30] } }
clearances.left_gap = { between = ["left_rod", "left_stop"], min = 2 }
clearances.left_room = { between = ["left_rod", "left_block"] }
mirror = { across = "y", names = { left = "right" } }
design.left_q = { move = "left_q", along = "y" }
time = { end = 1, steps = 20 }
"#;
    let model = model_of(text);
    let found = Analysis::new(&model).unwrap().clearances(&[]);
    for [left, right] in [["left_gap", "right_gap"], ["left_room", "right_room"]] {
        let [left, right] = [left, right].map(|name| pair(&model, &found, name));
        assert!(left.least().unwrap().at.distance[0].is_finite());
        for (a, b) in left.curve.iter().zip(&right.curve) {
            assert_near(a.distance[0] * 1e3, b.distance[0] * 1e3, "left and right");
        }
        assert_near(left.least().unwrap().at.time, right.least().unwrap().at.time, "left and right");
    }
}

/// The knee in the plane, and the same with joints in space.
#[test]
fn a_planar_model_has_the_clearances_of_its_long_form() {
    let flat = Analysis::new(&model_of(KNEE)).unwrap().clearances(&[]);
    let long = Analysis::new(&model_of(GALLERY)).unwrap().clearances(&[]);
    for pair in &flat.pairs {
        let same = long.pairs.iter().find(|other| other.shapes == pair.shapes).unwrap();
        let [a, b] = [pair, same].map(|pair| pair.least().unwrap().at);
        assert_near(a.time, b.time, "time");
        assert_near(a.distance[0] * 1e3, b.distance[0] * 1e3, "distance");
    }
}

/// A triangle across the path of a slider, and a plate.
const TRIANGLE: &str = "v 0 -100 -100\nv 0 100 -100\nv 0 0 150\nf 1 2 3\n";
const PLATE: &str = "\
v -2 -100 -100\nv 2 -100 -100\nv 2 100 -100\nv -2 100 -100\n\
v -2 -100 100\nv 2 -100 100\nv 2 100 100\nv -2 100 100\n\
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
/// Shapes that a slider pushes through each other: 40 mm of travel, ends that begin 20 mm before x = 0.
const PIERCING: &str = r#"
name = "piercing"
units = { length = "mm", angle = "deg" }
hardpoints = { origin = [-60, 10, 0], tip = [-20, 10, 0] }
bodies = { slider = {} }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = "origin", axis = "x" }
drivers.push = { joint = "slide", law = "40*t" }
time = { end = 1.0, steps = 4 }
[shapes]
rod = { body = "slider", capsule = ["origin", "tip"], radius = 1 }
bar = { body = "slider", cylinder = ["origin", "tip"], radius = 3 }
block = { body = "slider", box = [40, 6, 6], frame = { position = [-40, 10, 0] } }
triangle = { body = "ground", mesh = "triangle.obj" }
plate = { body = "ground", mesh = "plate.obj" }
box = { body = "ground", box = [4, 200, 200] }
disc = { body = "ground", cylinder = [[-2, 0, 0], [2, 0, 0]], radius = 100 }
[clearances.all]
between = [["rod", "bar", "block"], ["triangle", "plate", "box", "disc"]]
"#;

/// A shape that pierces another without an edge or rim of one near a face of the other overlaps it, from the time at
/// which it touches it to the end, at whatever depth.
#[test]
fn what_pierces_a_shape_overlaps_it() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("triangle.obj"), TRIANGLE).unwrap();
    std::fs::write(folder.path().join("plate.obj"), PLATE).unwrap();
    let path = folder.path().join("piercing.toml");
    for steps in [4, 7, 30] {
        std::fs::write(&path, PIERCING.replace("steps = 4", &format!("steps = {steps}"))).unwrap();
        let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        assert_eq!(found.pairs.len(), 12);
        for pair in &found.pairs {
            let [moving, fixed] = pair.shapes.map(|s| model.shapes[s.0].name.as_str());
            let thickness = if fixed == "triangle" { 0.0 } else { 2.0 };
            let radius = if moving == "rod" { 1.0 } else { 0.0 };
            let touches = (20.0 - thickness - radius) / 40.0;
            let name = format!("{moving} and {fixed}, {steps} steps");
            let [[from, to]] = pair.intervals()[..] else { panic!("{name}: {:?}", pair.intervals()) };
            assert_near(from, touches, &name);
            assert_eq!(to, 1.0, "{name}");
            assert!(pair.curve.iter().all(|s| s.time <= touches || s.distance[0] <= 0.0), "{name}");
            // The rod's end is rounded: the way out of a plate is known at every depth. A plate is left by its faces.
            let depth = match (moving, fixed) {
                ("rod", "triangle") => -1.0,
                ("rod", _) => -3.0,
                _ => pair.least().unwrap().at.distance[0] * 1e3,
            };
            let least = pair.least().unwrap().at;
            assert_near(least.distance[0] * 1e3, depth, &name);
            assert!(least.cores_meet || least.distance[0] < 0.0, "{name}");
        }
    }
}

/// A sheet of two triangles in the plane z = 0, turned up or down, and round shapes that a slider pushes through it.
const SHEET: &str = "v -50 -50 0\nv 50 -50 0\nv 50 50 0\nv -50 50 0\n";
const ROUND: &str = r#"
name = "sheet"
units = { length = "mm", angle = "deg" }
bodies = { slider = {} }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = [0, 0, 0], axis = "z" }
drivers.push = { joint = "slide", law = "-30 + 60*t" }
time = { end = 1.0, steps = 10 }
[shapes]
sheet = { body = "ground", mesh = "sheet.obj" }
ring = { body = "slider", ring = [1, 2, 0], axis = "x", radius = 10, round = 1 }
drum = { body = "slider", cylinder = [[1, 2, -2], [5, 4, 2]], radius = 5, round = 1 }
[clearances.all]
between = ["sheet", ["ring", "drum"]]
"#;

#[test]
fn a_ring_and_a_drum_are_as_near_to_a_sheet_from_either_side() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sheet.toml");
    // Half of what the cores extend along z. That of the drum is smaller by its rounding all around, and its axis has a
    // cosine of 2/3 with z.
    let extent = |shape: &str| match shape {
        "ring" => 10.0,
        _ => (3.0 - 1.0) * 2.0 / 3.0 + (5.0 - 1.0) * 5.0_f64.sqrt() / 3.0,
    };
    for (faces, steps) in [("f 1 2 3\nf 1 3 4\n", 10), ("f 1 3 2\nf 1 4 3\n", 10), ("f 1 2 3\nf 1 3 4\n", 11)]
    {
        std::fs::write(folder.path().join("sheet.obj"), format!("{SHEET}{faces}")).unwrap();
        std::fs::write(&path, ROUND.replace("steps = 10", &format!("steps = {steps}"))).unwrap();
        let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        for pair in &found.pairs {
            let name = model.shapes[pair.shapes[1].0].name.as_str();
            let what = format!("{name}, {steps} steps, {faces}");
            let reach = extent(name) + 1.0;
            let touches = [0.5 - reach / 60.0, 0.5 + reach / 60.0];
            for at in &pair.curve {
                let z = 60.0 * at.time - 30.0;
                let expected = if z.abs() > reach - 1.0 { z.abs() - reach } else { -1.0 };
                assert_near(at.distance[0] * 1e3, expected, &format!("{what}, at {}", at.time));
            }
            let [[from, to]] = pair.intervals()[..] else { panic!("{what}: {:?}", pair.intervals()) };
            assert_near(from, touches[0], &what);
            assert_near(to, touches[1], &what);
            assert_near(pair.least().unwrap().at.distance[0] * 1e3, -1.0, &what);
        }
    }
}

#[test]
fn a_cube_with_a_triangle_twice_has_an_inside_and_one_with_a_hole_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.toml");
    let text = PIERCING.replace("plate.obj", "cube.obj").replace(
        "between = [[\"rod\", \"bar\", \"block\"], [\"triangle\", \"plate\", \"box\", \"disc\"]]",
        "between = [\"rod\", \"plate\"]",
    );
    std::fs::write(folder.path().join("triangle.obj"), TRIANGLE).unwrap();
    std::fs::write(&path, text).unwrap();
    let of = |surface: &str| {
        std::fs::write(folder.path().join("cube.obj"), surface).unwrap();
        let file = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}"));
        let open = |name: &str| {
            let mut notes = file.remarks.iter().filter(|d| d.code == "HP0119");
            notes.find(|d| d.message.contains(name)).map(|d| d.notes[0].clone())
        };
        let least =
            Analysis::new(&file.model).unwrap().clearances(&[]).pairs[0].least().unwrap().at.distance[0];
        (least, open("`plate`"), open("`triangle`"))
    };
    let (depth, none, sheet) = of(PLATE);
    assert!(none.is_none() && sheet.unwrap().starts_with("at 3 edges of `triangle.obj`"));
    let (twice, none, _) = of(&format!("{PLATE}f 4 3 1\n"));
    assert!(none.is_none(), "{none:?}");
    assert_eq!(twice, depth);
    let (_, note, _) = of(&PLATE.replace("f 2 3 7 6\n", ""));
    assert!(note.as_ref().unwrap().starts_with("at 4 edges of `cube.obj`"), "{note:?}");
}

/// A bolt that is partly within a plate, both in one file, and beside it in another.
#[test]
fn closed_parts_of_a_mesh_that_overlap_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("parts.toml");
    std::fs::write(folder.path().join("triangle.obj"), TRIANGLE).unwrap();
    std::fs::write(&path, PIERCING).unwrap();
    // A cube with corners at x from `from` to `to`, after the eight corners of the plate.
    let bolt = |from: f64, to: f64| {
        let corners = PLATE.lines().filter_map(|line| line.strip_prefix("v "));
        let corners = corners.map(|line| {
            let [x, y, z] = [0, 1, 2].map(|k| line.split(' ').nth(k).unwrap().parse::<f64>().unwrap());
            format!("v {} {} {}\n", if x < 0.0 { from } else { to }, 0.1 * y, 0.1 * z)
        });
        let faces = PLATE.lines().filter_map(|line| line.strip_prefix("f "));
        let shifted = |line: &str| {
            let numbers: Vec<String> =
                line.split(' ').map(|k| (k.parse::<u32>().unwrap() + 8).to_string()).collect();
            format!("f {}\n", numbers.join(" "))
        };
        corners.chain(faces.map(shifted)).collect::<String>()
    };
    for (from, to, overlaps) in [(-1.0, 30.0, true), (3.0, 30.0, false)] {
        std::fs::write(folder.path().join("plate.obj"), format!("{PLATE}{}", bolt(from, to))).unwrap();
        let file = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}"));
        let note = file.remarks.iter().find(|d| d.code == "HP0120");
        assert_eq!(note.is_some(), overlaps, "{:?}", file.remarks);
        if let Some(note) = note {
            assert_eq!(note.message, "closed parts of shape `plate` overlap or touch");
            assert!(note.notes[0].starts_with("two parts of `plate.obj` meet at ("), "{:?}", note.notes);
        }
    }
}

/// A rod that turns within a solid at rest.
fn rod_in(solid: &str, [p, q]: [[f64; 3]; 2], steps: usize) -> String {
    format!(
        "name = \"c\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\ntime = {{ end = 1.0, steps = {steps} }}\n[bodies]\narm = {{}}\n\
         [joints.s]\ntype = \"revolute\"\nbodies = [\"ground\", \"arm\"]\naxis = [0.2, 0.3, 1]\nat = [-80, -90, 5]\n\
         [drivers]\nd = {{ joint = \"s\", law = \"8*t\" }}\n[hardpoints]\nP = {p:?}\nQ = {q:?}\n[shapes]\n\
         rod = {{ body = \"arm\", capsule = [\"P\", \"Q\"], radius = 4 }}\nsolid = {{ body = \"ground\", {solid} }}\n\
         [clearances.c]\nbetween = [\"rod\", \"solid\"]\n[design]\nP = {{ move = \"P\", along = \"xyz\" }}\n"
    )
}

/// Intervals of a curve in which the distance does not change by the integral of its rates, to fifth order: those in
/// which the features change.
fn rates_differ(curve: &[ShapeDistance]) -> usize {
    let size = curve.iter().map(|at| at.distance[0].abs()).fold(0.0, f64::max);
    let differs = |pair: &&[ShapeDistance]| {
        let [[d, v, a], [e, w, b]] = [0, 1].map(|k| pair[k].distance);
        let h = pair[1].time - pair[0].time;
        let change = 0.5 * h * (v + w) + h * h / 12.0 * (a - b);
        !((e - d - change).abs() <= 1e-8 * size)
    };
    curve.windows(2).filter(differs).count()
}

#[test]
fn the_deepest_point_between_two_faces_of_a_solid_moves_with_both() {
    // Rods whose deepest point is between two faces.
    let cases = [
        ("box = [60, 40, 100]", [[-60.0, 10.0, 3.0], [60.0, -30.0, -4.0]]),
        ("cylinder = [[0, 0, -30], [0, 0, 30]], radius = 30", [[-60.0, 10.0, 23.0], [60.0, -5.0, 4.0]]),
    ];
    for (solid, ends) in cases {
        let mut all: Vec<f64> = Vec::new();
        for steps in [7, 20, 400] {
            let model = model_of(&rod_in(solid, ends, steps));
            let found = Analysis::new(&model).unwrap().clearances(&[]);
            let pair = pair(&model, &found, "c");
            assert!(pair.curve.iter().all(|at| at.distance.iter().all(|x| x.is_finite())), "{solid}");
            assert!(pair.minima.len() < 5, "{solid}, {steps} steps: {} minima", pair.minima.len());
            let differ = rates_differ(&pair.curve);
            assert!(steps < 400 || differ < 5, "{solid}: {differ} intervals");
            all.push(1e3 * pair.least().unwrap().at.distance[0]);
        }
        assert!(all.iter().all(|x| (x - all[0]).abs() < 1e-9), "{solid}: {all:?}");
    }
}

#[test]
fn rods_that_pass_through_each_other_are_as_deep_as_their_radii_at_any_output_times() {
    for steps in [19, 20, 23, 40, 200] {
        let model = model_of(&format!(
            "name = \"c\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\ntime = {{ end = 1.0, steps = {steps} }}\n[bodies]\nslide = {{}}\n\
             [joints.s]\ntype = \"translational\"\nbodies = [\"ground\", \"slide\"]\naxis = \"z\"\nat = [0, 0, 0]\n\
             [drivers]\nd = {{ joint = \"s\", law = \"-20+40*t\" }}\n[hardpoints]\nP = [-50, 0, 0]\nQ = [50, 0, 0]\n\
             A = [0, -50, 3]\nB = [0, 50, 3]\n[shapes]\nrod = {{ body = \"slide\", capsule = [\"P\", \"Q\"], radius = 4 }}\n\
             bar = {{ body = \"ground\", capsule = [\"A\", \"B\"], radius = 5 }}\n\
             [clearances.c]\nbetween = [\"rod\", \"bar\"]\nmin = 1\n"
        ));
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        let pair = pair(&model, &found, "c");
        let least = pair.least().unwrap_or_else(|| panic!("{steps} steps: {:?}", pair.contacts));
        assert!(least.at.cores_meet, "{steps} steps: {least:?}");
        assert!((least.at.distance[0] + 9e-3).abs() < 1e-8, "{steps} steps: {least:?}");
        assert!((least.at.time - 0.575).abs() < 1e-6, "{steps} steps: {least:?}");
        let times: Vec<f64> = pair.contacts.iter().map(|c| c.at.time).collect();
        assert!(times.len() == 2, "{steps} steps: {times:?}");
        assert_near(times[0], 0.35, "begins");
        assert_near(times[1], 0.8, "ends");
    }
}

#[test]
fn a_motion_that_ends_early_has_the_same_clearances_up_to_its_end_at_any_output_times() {
    let text = |steps: usize| {
        format!(
            "name = \"c\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\ntime = {{ end = 1.0, steps = {steps} }}\nplanar = \"xy\"\n\
             hardpoints = {{ A = [0, 0], B = [60, 40], C = [140, 50], D = [100, 0], S = [43.1, 29.4] }}\n\
             bodies = {{ ground = [\"A\", \"D\"], crank = [\"A\", \"B\"], coupler = [\"B\", \"C\"], rocker = [\"C\", \"D\"] }}\n\
             drivers.motor = {{ joint = \"A\", law = \"360*t\" }}\n[shapes]\n\
             coupler = {{ body = \"coupler\", capsule = [\"B\", \"C\"], radius = 4 }}\n\
             stud = {{ body = \"ground\", sphere = \"S\", radius = 3 }}\n\
             [clearances.c]\nbetween = [\"coupler\", \"stud\"]\nmin = 1\n"
        )
    };
    let mut first: Option<(f64, Vec<f64>)> = None;
    for steps in [4, 5, 30, 173] {
        let model = model_of(&text(steps));
        let analysis = Analysis::new(&model).unwrap();
        let found = analysis.clearances(&[]);
        let end = found.stop.as_ref().and_then(|stop| stop.last_time).unwrap();
        let pair = pair(&model, &found, "c");
        let least = pair.least().unwrap().at;
        let contacts: Vec<f64> = pair.contacts.iter().map(|c| c.at.time).collect();
        let mut prover = analysis.clearance_prover(&[]).unwrap();
        // A claim above the least distance is refuted wherever that is.
        let refuted = prover.prove(pair.shapes, least.distance[0] + 1e-6);
        assert!(matches!(refuted, ClearanceProof::NotProved { .. }), "{steps} steps: {refuted:?}");
        let (distance, times) = first.get_or_insert((least.distance[0], contacts.clone()));
        // The end of the motion is a singular position: it is reached to the square root of round-off.
        assert!(
            (least.distance[0] - *distance).abs() < 1e-7,
            "{steps} steps: {least:?}, {distance}, end {end}"
        );
        assert!(contacts.len() == times.len(), "{steps} steps: {contacts:?} {times:?}");
        for (a, b) in contacts.iter().zip(times) {
            assert!((a - *b).abs() < 1e-8, "{steps} steps: {contacts:?}");
        }
    }
}

#[test]
fn a_motion_that_a_limit_stops_has_the_clearances_up_to_the_limit_at_any_output_times() {
    let text = |steps: usize| {
        format!(
            "name = \"c\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\ntime = {{ end = 1.0, steps = {steps} }}\n             bodies = {{ slider = {{}} }}\n             joints.s = {{ type = \"translational\", bodies = [\"ground\", \"slider\"], at = [0, 0, 0], axis = \"x\", limits.displacement = {{ max = 12.34, stop = true }} }}\n             drivers.d = {{ joint = \"s\", law = \"100*t\" }}\n[shapes]\n             ball = {{ body = \"slider\", sphere = [0, 0, 0], radius = 3 }}\n             stud = {{ body = \"ground\", sphere = [20, 0, 0], radius = 2 }}\n             [clearances.c]\nbetween = [\"ball\", \"stud\"]\n"
        )
    };
    for steps in [1, 3, 10, 100] {
        let model = model_of(&text(steps));
        let analysis = Analysis::new(&model).unwrap();
        let found = analysis.clearances(&[]);
        let pair = pair(&model, &found, "c");
        let least = pair.least().unwrap().at;
        assert_near(least.distance[0] * 1e3, 20.0 - 12.34 - 5.0, "least distance");
        assert_near(least.time, 0.1234, "its time");
        assert_near(found.stop.as_ref().and_then(|stop| stop.last_time).unwrap(), 0.1234, "the end");
        let mut prover = analysis.clearance_prover(&[]).unwrap();
        let mut claim = |above: f64| prover.prove(pair.shapes, least.distance[0] + above);
        assert!(matches!(claim(-1e-10), ClearanceProof::Proved { .. }), "{steps} steps: {:?}", claim(-1e-10));
        assert!(matches!(claim(1e-9), ClearanceProof::NotProved { .. }), "{steps} steps");
    }
}

#[test]
fn a_least_distance_where_a_limit_stops_the_motion_has_the_derivative_of_re_solved_designs() {
    // An arm turns to its stop in 0.25 s / w, while a slide goes 25 mm / w towards a stud.
    let slide = "name = \"c\"\nunits = { length = \"mm\", angle = \"deg\" }\ntime = { end = 1.0, steps = 7 }\n\
         parameters.w = 1\nhardpoints.S = [60, 0, 0]\nbodies = { arm = {}, slider = {} }\n[joints]\n\
         a = { type = \"revolute\", bodies = [\"ground\", \"arm\"], at = [0, 50, 0], axis = \"z\", limits.angle = { max = 90, stop = true } }\n\
         s = { type = \"translational\", bodies = [\"ground\", \"slider\"], at = [0, 0, 0], axis = \"x\" }\n\
         [drivers]\na = { joint = \"a\", law = \"360*w*t\" }\ns = { joint = \"s\", law = \"100*t\" }\n[shapes]\n\
         ball = { body = \"slider\", sphere = [0, 0, 0], radius = 3 }\nstud = { body = \"ground\", sphere = \"S\", radius = 2 }\n\
         [clearances.c]\nbetween = [\"ball\", \"stud\"]\n[design]\nS = { move = \"S\", along = \"x\" }\n";
    let model = model_of(slide);
    let found = Analysis::new(&model).unwrap().clearances(&[]);
    let least = pair(&model, &found, "c").least().unwrap();
    assert_eq!(least.place, MinimumPlace::End);
    assert_near(least.at.distance[0] * 1e3, 60.0 - 25.0 - 5.0, "distance");
    let by = |name: &str| least.d[model.variable(name).unwrap_or_else(|| panic!("{name}")).0];
    assert_near(by("w") * 1e3, 25.0, "by w");
    assert_near(by("S"), 1.0, "by S");

    // A spatial four-bar whose rocker reaches its stop: a ball on the rocker is where it is, the rod is not.
    let linkage = "name = \"c\"\nunits = { length = \"mm\", angle = \"deg\" }\ntime = { end = 1.0, steps = 60 }\n\
         [parameters]\nr = { value = 18, unit = \"length\" }\nspeed = 1\n\
         [hardpoints]\nO = [-220, 0, 0]\nA = [-190, 0, 50]\nB = [45, 40, 120]\nQ = [60, 50, 0]\nS = [35, 55, 80]\n\
         W1 = [-60, 20, 95]\nW2 = [-20, 90, 70]\n[bodies]\ncrank = {}\nrocker = {}\n[joints]\n\
         crank = { type = \"revolute\", bodies = [\"ground\", \"crank\"], at = \"O\", axis = \"y\" }\n\
         rod = { type = \"distance\", bodies = [\"crank\", \"rocker\"], at = [\"A\", \"B\"] }\n\
         rocker = { type = \"revolute\", bodies = [\"ground\", \"rocker\"], at = \"Q\", axis = [0.1, 1, 0.05], limits.angle = { min = -8, max = 12, stop = true } }\n\
         [drivers]\nmotor = { joint = \"crank\", law = \"360*speed*t + 20*sin(2*pi*t)\" }\n[shapes]\n\
         ball = { sphere = \"S\", body = \"rocker\", radius = \"r\" }\nrodc = { capsule = \"rod\", radius = 6 }\n\
         bar = { capsule = [\"W1\", \"W2\"], body = \"ground\", radius = 20 }\n\
         [clearances]\nhit = { between = [\"ball\", \"bar\"] }\nrb = { between = [\"rodc\", \"bar\"] }\n[design]\n\
         A = { move = \"A\", along = \"xyz\" }\nB = { move = \"B\", along = \"xyz\" }\nQ = { move = \"Q\", along = \"xyz\" }\n\
         S = { move = \"S\", along = \"xyz\" }\nW2 = { move = \"W2\", along = \"xyz\" }\ntilt = { tilt = \"rocker\", about = \"x\" }\n";
    let model = model_of(linkage);
    let analysis = Analysis::new(&model).unwrap();
    let ends = |design: &[f64]| {
        let found = analysis.clearances(design);
        let end = |name: &str| pair(&model, &found, name).minima.last().unwrap().clone();
        [end("hit"), end("rb")]
    };
    let nominal = ends(&[]);
    assert!(nominal.iter().all(|at| at.place == MinimumPlace::End));
    for v in 0..model.variables.len() {
        let h = 1e-5;
        let at = |h: f64| ends(&(0..=v).map(|k| if k == v { h } else { 0.0 }).collect::<Vec<_>>());
        let [after, before] = [at(h), at(-h)];
        for (k, end) in nominal.iter().enumerate() {
            let expected = (after[k].at.distance[0] - before[k].at.distance[0]) / (2.0 * h);
            let what = format!("{} of {k}: {} instead of {expected}", model.variables[v].name, end.d[v]);
            assert!((end.d[v] - expected).abs() < 1e-6, "{what}");
        }
    }
    // What moves the crank alone moves the time, not the rocker at its stop.
    for name in ["speed", "A_x", "A_y", "A_z"] {
        let v = model.variable(name).unwrap_or_else(|| panic!("{name} {:?}", model.variables)).0;
        assert!(nominal[0].d[v].abs() < 1e-12, "{name}: {}", nominal[0].d[v]);
    }
}

/// A motion that a limit position ends, or an equilibrium that a limit of a joint ends: the time of neither has known
/// derivatives, and so have the distances there.
#[test]
fn a_least_distance_at_an_end_of_unknown_time_has_no_derivative() {
    let blocked = "name = \"c\"\nunits = { length = \"mm\", angle = \"deg\" }\ntime = { end = 1.0, steps = 30 }\nplanar = \"xy\"\n\
         hardpoints = { A = [0, 0], B = [60, 40], C = [140, 50], D = [100, 0], S = [-200, -300] }\n\
         bodies = { ground = [\"A\", \"D\"], crank = [\"A\", \"B\"], coupler = [\"B\", \"C\"], rocker = [\"C\", \"D\"] }\n\
         drivers.motor = { joint = \"A\", law = \"360*t\" }\n[shapes]\n\
         stud = { body = \"ground\", sphere = \"S\", radius = 3 }\ntip = { body = \"crank\", sphere = \"B\", radius = 3 }\n\
         [clearances.c]\nbetween = [\"tip\", \"stud\"]\n[design]\nC = { move = \"C\", along = \"x\" }\n";
    let at_rest = "name = \"c\"\nunits = { length = \"mm\", angle = \"deg\" }\ntime = { end = 1.0, steps = 7 }\nparameters.k = 5\n\
         bodies = { ram = {} }\n[joints]\nslide = { type = \"translational\", bodies = [\"ground\", \"ram\"], at = [0, 0, 0], axis = \"x\", \
         limits = { displacement = { max = 8, stop = true } } }\n[forces]\n\
         spring = { type = \"joint_spring\", joint = \"slide\", stiffness = \"k\" }\n\
         load = { type = \"force\", at = { body = \"ram\", at = [0, 0, 0] }, force = 50, along = \"x\", law = \"t\" }\n\
         [shapes]\nball = { body = \"ram\", sphere = [0, 0, 0], radius = 3 }\n\
         stud = { body = \"ground\", sphere = [30, 0, 0], radius = 2 }\n[clearances.c]\nbetween = [\"ball\", \"stud\"]\n\
         [equilibrium]\n";
    for text in [blocked, at_rest] {
        let model = model_of(text);
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        assert!(found.stop.is_some());
        let end = pair(&model, &found, "c").minima.last().unwrap();
        assert_eq!(end.place, MinimumPlace::End);
        assert!(end.d[0].is_nan() && end.d.len() == 1, "{end:?}");
    }
}

#[test]
fn a_part_of_the_motion_in_which_the_distance_is_constant_and_greatest_has_no_minimum() {
    // While the arm points away from the wall, its fixed end is nearest: rates there are round-off of either sign. The
    // other pairs add times.
    let text = |steps: usize| {
        format!(
            r#"
name = "plateau"
units = {{ length = "mm", angle = "deg" }}
time = {{ end = 1.0, steps = {steps} }}
bodies = {{ crank = {{}}, rocker = {{}} }}
joints.R1 = {{ type = "revolute", bodies = ["ground", "crank"], at = "O1", axis = [0.1, -0.05, 1] }}
joints.c = {{ type = "distance", bodies = ["crank", "rocker"], at = ["A", "B"] }}
joints.R2 = {{ type = "revolute", bodies = ["ground", "rocker"], at = "O2", axis = [0.25, 1, -0.1] }}
drivers.d = {{ joint = "R1", law = "360*t" }}
[hardpoints]
O1 = [0, 0, 10]
A = [80, 60, 0.001]
B = [480, 260, 280]
O2 = [420, 150, 20]
P = [260, 70, 260]
Q = [300, 40, 150]
[shapes]
rod = {{ capsule = "c", radius = 6 }}
arm = {{ body = "crank", capsule = ["O1", "A"], radius = 6 }}
ring = {{ body = "ground", ring = "P", axis = [1, 0.2, 0.1], radius = 25, round = 8 }}
wall = {{ body = "ground", plane = "P", normal = {{ through = ["P", "Q"] }} }}
block = {{ body = "ground", hull = [[250, 90, 220], "Q", "P", [330, 120, 330]], round = 2 }}
[clearances.c]
between = [["rod", "arm"], ["ring", "wall", "block"]]
"#
        )
    };
    for steps in [7, 9, 11, 30] {
        let model = model_of(&text(steps));
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        let shape = |name: &str| model.shapes.iter().position(|s| s.name == name).unwrap();
        let of = |pair: &&PairClearance| pair.shapes.map(|s| s.0) == [shape("arm"), shape("wall")];
        let pair = found.pairs.iter().find(of).unwrap();
        let [only] = &pair.minima[..] else { panic!("{steps} steps: {:?}", pair.minima) };
        // Of the end of the arm, by its own rotation about the axis.
        let unit = |v: [f64; 3]| v.map(|x| x / v.iter().map(|x| x * x).sum::<f64>().sqrt());
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (axis, v) = (unit([0.1, -0.05, 1.0]), [80.0, 60.0, -9.999]);
        let normal = unit([40.0, -30.0, -110.0]);
        let along = dot(axis, v);
        let across = [
            axis[1] * v[2] - axis[2] * v[1],
            axis[2] * v[0] - axis[0] * v[2],
            axis[0] * v[1] - axis[1] * v[0],
        ];
        let (sin, cos) = (dot(normal, across), dot(normal, v) - along * dot(normal, axis));
        let height = dot(normal, [-260.0, -70.0, 10.0 - 260.0]) + along * dot(normal, axis);
        assert_near(only.at.distance[0] * 1e3, height - sin.hypot(cos) - 6.0, &format!("{steps} steps"));
    }
}

/// Two legs between the ground and a platform that turns about an inclined axis.
fn crossing_legs(steps: usize) -> String {
    format!(
        r#"
name = "legs"
units = {{ length = "mm", angle = "deg" }}
time = {{ end = 1, steps = {steps} }}
hardpoints = {{ b0 = [-20, 0, 0], b1 = [20, 3, 0], t0 = [20, 0, 50], t1 = [-20, -8, 50] }}
bodies = {{ platform = {{}} }}
[joints]
pivot = {{ type = "revolute", bodies = ["ground", "platform"], at = [30, 0, 0], axis = [0.2, 0.1, 1] }}
first = {{ type = "leg", bodies = ["ground", "platform"], at = ["b0", "t0"] }}
second = {{ type = "leg", bodies = ["platform", "ground"], at = ["t1", "b1"] }}
[drivers]
motor = {{ joint = "pivot", law = "-30*t" }}
[shapes]
first = {{ capsule = "first", radius = 1 }}
second = {{ capsule = "second", radius = 1 }}
[clearances]
c = {{ between = ["first", "second"] }}
[design]
b0 = {{ move = "b0", along = "y" }}
"#
    )
}

#[test]
fn legs_that_pass_through_each_other_are_as_deep_as_their_radii() {
    for steps in [7, 10, 23] {
        let model = model_of(&crossing_legs(steps));
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        let least = pair(&model, &found, "c").least().unwrap();
        assert!(least.at.cores_meet, "{steps} steps: {least:?}");
        assert!((least.at.distance[0] + 2e-3).abs() < 1e-8, "{steps} steps: {least:?}");
        // The root of (t1 - b0) . (e x f) along the rotation by the formula of Rodrigues, by bisection.
        assert!((least.at.time - 0.240_180_706_177).abs() < 1e-6, "{steps} steps: {least:?}");
        assert!(least.d.iter().all(|d| d.is_nan()), "{steps} steps: {least:?}");
    }
}

#[test]
fn rods_between_the_same_bodies_are_a_pair_in_any_order_of_their_bodies() {
    let text = |second: &str, between: &str| {
        format!(
            r#"
name = "legs"
units = {{ length = "mm", angle = "deg" }}
time = {{ end = 1, steps = 4 }}
hardpoints = {{ b0 = [0, 0, 0], b1 = [10, 20, 0], t0 = [30, 40, 50], t1 = [-5, 10, 60] }}
bodies = {{ platform = {{}} }}
[joints]
slide = {{ type = "translational", bodies = ["ground", "platform"], at = [0, 0, 0], axis = "z" }}
first = {{ type = "leg", bodies = ["ground", "platform"], at = ["b0", "t0"] }}
second = {{ type = "leg", {second} }}
[drivers]
lift = {{ joint = "slide", law = "20*t" }}
[shapes]
first = {{ capsule = "first", radius = 1 }}
tube = {{ capsule = "first", radius = 2 }}
second = {{ capsule = "second", radius = 1 }}
[clearances]
c = {{ between = {between} }}
"#
        )
    };
    let orders = [
        "bodies = [\"ground\", \"platform\"], at = [\"b1\", \"t1\"]",
        "bodies = [\"platform\", \"ground\"], at = [\"t1\", \"b1\"]",
    ];
    for order in orders {
        let model = model_of(&text(order, "[\"first\", \"second\"]"));
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        let least = pair(&model, &found, "c").least().unwrap();
        // The common perpendicular of the lines in the design configuration.
        assert!((least.at.distance[0] - 3.679_902_268_968_7e-3).abs() < 1e-12, "{least:?}");
        // A rod and a tube around it have the same ends, and do not move relative to each other.
        assert_eq!(
            model_of(&text(order, "[[\"first\", \"tube\", \"second\"], \"*\"]")).clearances[0].pairs.len(),
            2
        );
    }
}

/// A rod that moves up and down through a box: its deepest point is between two faces of it.
const TIED: &str = r#"
name = "tied"
units = { length = "mm", angle = "deg" }
time = { end = 1, steps = 10 }
bodies = { arm = {} }
hardpoints = { P = [60, 2, -30], Q = [63, 4, 30] }
[joints]
slide = { type = "translational", bodies = ["ground", "arm"], at = [0, 0, 0], axis = "z" }
[drivers]
lift = { joint = "slide", law = "5*sin(2*pi*t)" }
[shapes]
rod = { body = "arm", capsule = ["P", "Q"], radius = 3 }
block = { body = "ground", box = [30, 12, 20], frame = { position = [60, 0, 0] } }
[clearances]
gap = { between = ["rod", "block"] }
[design]
P_z = { move = "P", along = "z" }
"#;

#[test]
fn a_depth_between_two_faces_has_derivatives_where_neither_face_has_a_rate() {
    let text = TIED.replace("steps = 10", "steps = 100");
    let model = model_of(&text);
    let analysis = Analysis::new(&model).unwrap();
    let found = analysis.clearances(&[]);
    let of = pair(&model, &found, "gap");
    // Neither face along which the rod moves has a rate, and the depth changes.
    let depths: Vec<f64> = of.curve.iter().map(|at| at.distance[0]).collect();
    let range = depths.iter().fold(0.0, |most: f64, d| most.max((d - depths[0]).abs()));
    assert!(range > 1e-5, "{depths:?}");
    assert_eq!(rates_differ(&of.curve), 0);
    let least = of.least().unwrap();
    let moved = |by: f64| {
        let found = analysis.clearances(&[by]);
        pair(&model, &found, "gap").least().unwrap().at.distance[0]
    };
    let difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
    assert!((least.d[0] - difference).abs() < 1e-7 && difference.abs() > 1e-3, "{least:?} {difference}");
}

/// A rod that goes through solids of all kinds, so that its deepest point is between two of their faces, or a face and
/// a hollow edge, with bodies that turn about two axes.
const THROUGH: &str = r#"
name = "a rod through solids"
units = { length = "mm", angle = "deg" }
bodies = { mid = {}, arm = {} }
parameters.r = { value = 4, unit = "length" }
parameters.w = { value = 21, unit = "length" }
joints.one = { type = "revolute", bodies = ["ground", "mid"], at = "O", axis = [0.1, 0.2, 1] }
joints.two = { type = "revolute", bodies = ["mid", "arm"], at = "M", axis = [1, 0.3, -0.1] }
drivers.one = { joint = "one", law = "2*sin(2*t)" }
drivers.two = { joint = "two", law = "2*t + t^2" }
design.O_x = { move = "O", along = "x" }
design.M_z = { move = "M", along = "z" }
design.a = { move = "a", along = "xyz" }
design.b_y = { move = "b", along = "y" }
design.p = { move = "p", along = "xyz" }
design.q = { move = "q", along = "xyz" }
design.c_x = { move = "c", along = "x" }
time = { end = 1, steps = 5 }
shapes.rod = { body = "arm", capsule = ["a", "b"], radius = "r" }
shapes.block = { body = "ground", box = [40, 30, 36], frame = { position = "q", cardan = [10, 20, 30] }, round = 1 }
shapes.hull = { body = "ground", hull = ["p", [148, 12, -6], [118, 62, 4], [115, 18, 48]] }
shapes.mesh = { body = "ground", mesh = { file = "angle.obj" } }
shapes.drum = { body = "ground", cylinder = ["c", [124, 32, 5]], radius = "w", round = 2 }
clearances.block = { between = ["rod", "block"] }
clearances.hull = { between = ["hull", "rod"] }
clearances.mesh = { between = ["rod", "mesh"] }
clearances.drum = { between = ["drum", "rod"] }
[hardpoints]
O = [0, 0, 0]
M = [40, 5, 3]
a = [60, 3, -20]
b = [182, 41, 37]
p = [100, -4, 1]
q = [120, 20, 10]
c = [112, -10, 20]
"#;

/// An angle section along z, whose hollow edge is through (128, 27).
const ANGLE: &str = "v 108 7 -5\nv 148 7 -5\nv 148 27 -5\nv 128 27 -5\nv 128 47 -5\nv 108 47 -5\n\
    v 108 7 25\nv 148 7 25\nv 148 27 25\nv 128 27 25\nv 128 47 25\nv 108 47 25\n\
    f 4 3 2\nf 4 2 1\nf 4 1 6\nf 4 6 5\nf 10 8 9\nf 10 7 8\nf 10 12 7\nf 10 11 12\n\
    f 1 2 8\nf 1 8 7\nf 2 3 9\nf 2 9 8\nf 3 4 10\nf 3 10 9\nf 4 5 11\nf 4 11 10\nf 5 6 12\nf 5 12 11\n\
    f 6 1 7\nf 6 7 12\n";

#[test]
fn derivatives_of_the_depth_of_a_rod_between_two_faces_are_those_of_re_solved_designs() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("angle.obj"), ANGLE).unwrap();
    let path = folder.path().join("through.toml");
    std::fs::write(&path, THROUGH).unwrap();
    let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
    let analysis = Analysis::new(&model).unwrap();
    // Both ends of the rod are outside all solids.
    let found = analysis.clearances(&[]);
    for pair in &found.pairs {
        let name = &model.shapes[pair.shapes[1].0].name;
        for at in &pair.curve {
            assert!(
                at.distance[0] < -8e-3 && at.distance[1].is_finite() && !at.is_parallel,
                "{name}: {at:?}"
            );
        }
    }
    crate::equilibrium::verify_all(&model);
    // Second derivatives by two variables at a time, against differences of first ones.
    let n = model.variables.len();
    let unit = |v: usize| (0..n).map(|k| if k == v { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
    let directions: Vec<Vec<f64>> = (0..n).map(unit).collect();
    let pairs: Vec<[usize; 2]> = (0..n).map(|v| [v, (3 * v + 2) % n]).collect();
    let second = analysis.second(&[], &directions, &pairs);
    let step = 1e-5;
    let mut most: f64 = 0.0;
    for (p, [u, v]) in pairs.into_iter().enumerate() {
        let [a, b] = [step, -step].map(|h| {
            let design: Vec<f64> = unit(v).iter().map(|x| h * x).collect();
            analysis.solve(Run::new().at(&design))
        });
        for (m, measure) in model.measures.iter().enumerate() {
            for k in 0..model.times.len() {
                let [f, g] = [&a, &b].map(|run| run.measured.d(k, VariableId(u), m)[0]);
                let (found, expected) = (second.value(k, p, m), (f - g) / (2.0 * step));
                most = most.max(expected.abs());
                assert!(
                    (found - expected).abs() < 1e-5 * (1.0 + expected.abs()),
                    "{} {u} {v}: {found} {expected}",
                    measure.name
                );
            }
        }
    }
    assert!(most > 1.0, "{most}");
}

#[test]
fn derivatives_of_a_rod_that_stays_parallel_to_a_face_are_those_of_re_solved_designs() {
    // Beside the solid, and within it.
    for y in [26.0, 12.0] {
        let text = format!(
            "name = \"c\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\ntime = {{ end = 1, steps = 4 }}\nbodies.arm = {{}}\n\
             hardpoints = {{ P = [-10, {y}, 2], Q = [70, {y}, 2], S = [50, 0, 0] }}\n\
             joints.A = {{ type = \"translational\", bodies = [\"ground\", \"arm\"], at = \"P\", axis = [3, 1, 0.5] }}\n\
             drivers.m = {{ joint = \"A\", law = \"2*t + t^2\" }}\n\
             design.rod = {{ move = [\"P\", \"Q\"], along = \"xyz\" }}\ndesign.S = {{ move = \"S\", along = \"xyz\" }}\n\
             shapes.rod = {{ body = \"arm\", capsule = [\"P\", \"Q\"], radius = 4 }}\n\
             shapes.block = {{ body = \"ground\", box = [40, 30, 80], frame = {{ position = \"S\" }} }}\n\
             shapes.plate = {{ body = \"ground\", mesh = \"plate.obj\" }}\n\
             shapes.drum = {{ body = \"ground\", cylinder = [[40, 15, 0], [40, -15, 0]], radius = 18 }}\n\
             clearances.block = {{ between = [\"rod\", \"block\"] }}\nclearances.plate = {{ between = [\"plate\", \"rod\"] }}\n\
             clearances.drum = {{ between = [\"rod\", \"drum\"] }}\n"
        );
        let folder = tempfile::tempdir().unwrap();
        let plate = CUBE.replace("v -20 -20", "v 30 -15").replace("v -20 20", "v 30 15");
        let plate = plate.replace("v 20 -20", "v 65 -15").replace("v 20 20", "v 65 15");
        std::fs::write(folder.path().join("plate.obj"), plate).unwrap();
        let path = folder.path().join("c.toml");
        std::fs::write(&path, text).unwrap();
        let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        for pair in &found.pairs {
            assert!(
                pair.curve.iter().all(|at| at.is_parallel && at.distance[1] > 1e-4),
                "{y}: {:?}",
                pair.curve
            );
        }
        crate::equilibrium::verify_all(&model);
    }
}

#[test]
fn a_depth_between_two_faces_depends_neither_on_the_form_of_the_solid_nor_on_its_place() {
    let corner = |k: usize, [x, y, z]: [f64; 3]| {
        let side = |bit: usize, half: f64| if k >> bit & 1 == 1 { half } else { -half };
        format!("[{}, {}, {}]", x + side(0, 15.0), y + side(1, 6.0), z + side(2, 10.0))
    };
    let hull =
        |order: [usize; 8], at: [f64; 3]| format!("hull = [{}]", order.map(|k| corner(k, at)).join(", "));
    let solved = |solid: &str, [x, y, z]: [f64; 3], order: &str| {
        let text = TIED
            .replace("box = [30, 12, 20], frame = { position = [60, 0, 0] }", solid)
            .replace(
                "P = [60, 2, -30], Q = [63, 4, 30]",
                &format!(
                    "P = [{}, {}, {}], Q = [{}, {}, {}]",
                    60.0 + x,
                    2.0 + y,
                    z - 30.0,
                    63.0 + x,
                    4.0 + y,
                    z + 30.0
                ),
            )
            .replace("at = [0, 0, 0]", &format!("at = [{x}, {y}, {z}]"))
            .replace("[\"rod\", \"block\"]", order);
        let model = model_of(&text);
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        let of = &found.pairs[0];
        let least = of.least().unwrap();
        let mut numbers: Vec<f64> = of.curve.iter().flat_map(|at| at.distance).collect();
        numbers.extend([least.at.time, least.at.distance[0], least.d[0]]);
        numbers
    };
    let block = |[x, y, z]: [f64; 3]| {
        format!("box = [30, 12, 20], frame = {{ position = [{}, {y}, {z}] }}", 60.0 + x)
    };
    let expected = solved(&block([0.0; 3]), [0.0; 3], "[\"rod\", \"block\"]");
    for at in [[0.0; 3], [1000.0, -2000.0, 500.0]] {
        let middle = [60.0 + at[0], at[1], at[2]];
        let solids =
            [block(at), hull([0, 1, 2, 3, 4, 5, 6, 7], middle), hull([6, 3, 0, 5, 7, 2, 4, 1], middle)];
        for solid in &solids {
            for order in ["[\"rod\", \"block\"]", "[\"block\", \"rod\"]"] {
                let found = solved(solid, at, order);
                let differ = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-9 * (1.0 + b.abs());
                assert!(!found.iter().zip(&expected).any(differ), "{solid}, {order}: {found:?} {expected:?}");
            }
        }
    }
}

/// A rod beside a box, or within it, at the middle of a turn where it is parallel to a face: depth below the face, and
/// the rates that the ends of the common stretch have.
#[test]
fn a_rod_parallel_to_a_face_has_the_rate_of_the_middle_of_what_they_have_in_common() {
    let plate = "v 45 HIGH -5\nv 55 HIGH -5\nv 55 HIGH 5\nv 45 HIGH 5\nv 45 LOW -5\nv 55 LOW -5\nv 55 LOW 5\nv 45 LOW 5\n\
                 f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let folder = tempfile::tempdir().unwrap();
    for top in [2.0, -8.0] {
        let [high, low] = [top, top - 30.0].map(|x| x.to_string());
        let surface = plate.replace("HIGH", &high).replace("LOW", &low);
        std::fs::write(folder.path().join("cube.obj"), surface).unwrap();
        let solids = [
            (format!("box = [10, 30, 10], frame = {{ position = [50, {}, 0] }}", top - 15.0), 50.0),
            ("mesh = \"cube.obj\"".to_owned(), 50.0),
            (format!("cylinder = [[48, {top}, 0], [48, {low}, 0]], radius = 6"), 48.0),
        ];
        for (solid, middle) in solids {
            let text = format!(
                "name = \"c\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\ntime = {{ start = -1, end = 1, steps = 2 }}\n\
                 bodies.arm = {{}}\njoints.A = {{ type = \"revolute\", bodies = [\"ground\", \"arm\"], at = [0, 0, 0], axis = \"z\" }}\n\
                 drivers.m = {{ joint = \"A\", law = \"10*t\" }}\n[shapes]\n\
                 rod = {{ body = \"arm\", capsule = [[0, 0, 0], [80, 0, 0]], radius = 4 }}\n\
                 solid = {{ body = \"ground\", {solid} }}\n[clearances]\nc = {{ between = [\"rod\", \"solid\"] }}\n"
            );
            let path = folder.path().join("c.toml");
            std::fs::write(&path, text).unwrap();
            let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
            let found = Analysis::new(&model).unwrap().clearances(&[]);
            let at = pair(&model, &found, "c").curve[1];
            assert!(at.is_parallel, "{solid}: {at:?}");
            assert_near(at.distance[0] * 1e3, -top - 4.0, &solid);
            assert_near(at.distance[1] * 1e3, middle * 10.0_f64.to_radians(), &solid);
        }
    }
}

#[test]
fn a_smooth_minimum_is_exact_in_a_motion_that_leads_through_a_solid() {
    // Both turns of the arm lead through the block; between them the rod is nearest behind it.
    let text = |end: f64, steps: usize| {
        TIED.replace("type = \"translational\"", "type = \"cylindrical\"")
            .replace(
                "lift = { joint = \"slide\", law = \"5*sin(2*pi*t)\" }",
                "turn = { joint = \"slide\", coordinate = \"angle\", law = \"360*t\" }\n\
                 lift = { joint = \"slide\", coordinate = \"displacement\", law = \"50*t\" }\n",
            )
            .replace("end = 1, steps = 10", &format!("end = {end}, steps = {steps}"))
    };
    let model = model_of(&text(1.3, 13));
    let found = Analysis::new(&model).unwrap().clearances(&[]);
    let pair = pair(&model, &found, "gap");
    assert!(pair.curve.iter().any(|at| at.distance[0] < -3e-3), "{:?}", pair.curve);
    let smooth =
        pair.minima.iter().filter(|m| m.place == MinimumPlace::Inside && m.at.distance[1].is_finite());
    let mut count = 0;
    for minimum in smooth {
        let [_, rate, acceleration] = minimum.at.distance;
        assert!(acceleration > 0.0 && (rate / acceleration).abs() < 1e-10, "{minimum:?}");
        count += 1;
    }
    assert!(count > 0, "{:?}", pair.minima);
}

#[test]
fn a_box_at_a_hardpoint_follows_it() {
    let text = r#"
name = "box"
units = { length = "mm", angle = "deg" }
time = { end = 1, steps = 10 }
hardpoints = { O = [0, 0, 0], B = [50, 0, 0], "the corner" = [100, 0, 0] }
bodies = { arm = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "arm"], at = "O", axis = "z" }
drivers.motor = { joint = "pivot", law = "20*t" }
[shapes]
ball = { body = "arm", sphere = "B", radius = 5 }
block = { body = "ground", box = [20, 60, 20], frame = { position = "the corner", euler = [30, 0, 0] } }
[clearances]
gap = { between = ["ball", "block"] }
[design]
all_x = { move = ["O", "B", "the corner"], along = "x" }
corner_x = { move = "the corner", along = "x" }
"#;
    let model = model_of(text);
    let analysis = Analysis::new(&model).unwrap();
    let least = |design: &[f64]| pair(&model, &analysis.clearances(design), "gap").least().unwrap().clone();
    let nominal = least(&[0.0, 0.0]);
    assert!(nominal.d[0].abs() < 1e-12, "{nominal:?}");
    // All of it moved is the same mechanism elsewhere.
    assert!((least(&[0.01, 0.0]).at.distance[0] - nominal.at.distance[0]).abs() < 1e-12);
    let h = 1e-4;
    let difference = (least(&[0.0, h]).at.distance[0] - least(&[0.0, -h]).at.distance[0]) / (2.0 * h);
    assert!((difference - nominal.d[1]).abs() < 1e-6 && difference.abs() > 0.1, "{difference} {nominal:?}");
}

/// Laws that have no rate or acceleration at one moment between output times: the motion ends there, and so does all
/// that is said.
#[test]
fn a_law_without_rates_at_a_moment_ends_the_clearances_there() {
    for law in ["-25*sqrt(abs(t-0.3))", "-25*abs(t-0.3)^1.5"] {
        for steps in [7, 11] {
            let model = model_of(&format!(
                "name = \"c\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\ntime = {{ end = 1.0, steps = {steps} }}\n\
                 bodies = {{ s = {{}} }}\n\
                 joints.j = {{ type = \"translational\", bodies = [\"ground\", \"s\"], at = [0, 0, 0], axis = \"x\" }}\n\
                 drivers.d = {{ joint = \"j\", law = \"{law}\" }}\n[shapes]\n\
                 a = {{ body = \"ground\", sphere = [-30, 0, 0], radius = 5 }}\n\
                 b = {{ body = \"s\", sphere = [0, 0, 0], radius = 5 }}\n[clearances.c]\nbetween = [\"a\", \"b\"]\n"
            ));
            let analysis = Analysis::new(&model).unwrap();
            let found = analysis.clearances(&[]);
            let stop = found.stop.as_ref().unwrap_or_else(|| panic!("{law}, {steps} steps"));
            assert!(stop.last_time.is_some_and(|t| t <= 0.3), "{law}, {steps} steps: {stop:?}");
            let pair = pair(&model, &found, "c");
            assert!(pair.end <= 0.3 && pair.curve.iter().all(|at| at.time <= 0.3), "{law}: {}", pair.end);
            let mut prover = analysis.clearance_prover(&[]).unwrap();
            let claim = pair.least().unwrap().at.distance[0] - 1e-3;
            _ = prover.prove(pair.shapes, claim);
        }
    }
}

/// A slide with a cylinder along y on it, and a box on the ground.
fn tyre_and_wall(law: &str, steps: usize, shapes: &str) -> Model {
    model_of(&format!(
        "name = \"c\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\ntime = {{ end = 1.0, steps = {steps} }}\n\
         bodies = {{ m = {{}} }}\n\
         joints.s = {{ type = \"translational\", bodies = [\"ground\", \"m\"], at = [0, 0, 0], axis = \"x\" }}\n\
         drivers.d = {{ joint = \"s\", law = \"{law}\" }}\nparameters.r = {{ value = 30, unit = \"length\" }}\n\
         [shapes]\n{shapes}"
    ))
}

/// Distances of cylinders from boxes with edges parallel to their axes are those of rectangles in the plane.
#[test]
fn a_cylinder_beside_parallel_edges_of_a_box_has_the_distance_of_a_plane_figure() {
    let mut next = numbers(7);
    let mut shapes = String::new();
    let mut clearances = String::new();
    let mut expected = Vec::new();
    let mut whole = |low: f64, high: f64| (low + (high - low) * next()).round();
    for k in 0..200 {
        let size = [0; 3].map(|_| whole(5.0, 100.0));
        let [x, y, z] = [0; 3].map(|_| whole(-200.0, 200.0));
        let (half, radius) = (whole(3.0, 40.0), whole(5.0, 60.0));
        let beyond = |at: f64, size: f64| (at.abs() - 0.5 * size).max(0.0);
        let beside = (beyond(x, size[0]).hypot(beyond(z, size[2])) - radius).max(0.0);
        let distance = beside.hypot((beyond(y, size[1]) - half).max(0.0));
        expected.push(distance);
        let (from, to) = (y - half, y + half);
        shapes += &format!(
            "a{k} = {{ body = \"ground\", box = {size:?} }}\n\
             b{k} = {{ body = \"m\", cylinder = [[{x}, {from}, {z}], [{x}, {to}, {z}]], radius = {radius} }}\n"
        );
        clearances += &format!("[clearances.c{k}]\nbetween = [\"a{k}\", \"b{k}\"]\n");
    }
    // The wall of a landing gear's bay, and a tyre along all of it.
    shapes += "a200 = { body = \"ground\", box = [76, 54, 34] }\n\
               b200 = { body = \"m\", cylinder = [[-165, 6, 192], [-165, 14, 192]], radius = 36 }\n";
    clearances += "[clearances.c200]\nbetween = [\"a200\", \"b200\"]\n";
    expected.push(127f64.hypot(175.0) - 36.0);
    let model = tyre_and_wall("0*t", 1, &(shapes + &clearances));
    let found = Analysis::new(&model).unwrap().clearances(&[]);
    let mut apart = 0;
    for (clearance, expected) in model.clearances.iter().zip(expected) {
        let (_, pair) = found.of(clearance).next().unwrap();
        let least = pair.least().unwrap().at.distance[0] * 1e3;
        if expected > 0.0 {
            apart += 1;
            assert_near(least, expected, &clearance.name);
        } else {
            assert!(least <= EXACT, "{}: {least}", clearance.name);
        }
    }
    assert!(apart > 150, "{apart}");
}

#[test]
fn a_cylinder_that_slides_past_parallel_edges_has_rates_and_derivatives() {
    let shapes = r#"
box = { body = "ground", box = [4, 90, 30] }
drum = { body = "m", cylinder = [[100, -10, 100], [100, 10, 100]], radius = "r" }
other = { body = "m", box = [20, 30, 40], frame = { position = [112, 5, 120] } }
[clearances.of_drum]
between = ["drum", "box"]
[clearances.of_boxes]
between = ["other", "box"]
"#;
    let model = tyre_and_wall("20*t", 10, shapes);
    let found = Analysis::new(&model).unwrap().clearances(&[]);
    for (clearance, radius) in [("of_drum", 30.0), ("of_boxes", 0.0)] {
        let pair = pair(&model, &found, clearance);
        let (x, z) = if radius > 0.0 { (98.0, 85.0) } else { (100.0, 85.0) };
        for at in &pair.curve {
            let across: f64 = x + 20.0 * at.time;
            let apart = across.hypot(z);
            let rate = 20.0 * across / apart;
            let expected = [apart - radius, rate, (400.0 - rate * rate) / apart];
            for (found, expected) in at.distance.iter().zip(expected) {
                assert_near(found * 1e3, expected, &format!("{clearance} at {}", at.time));
            }
        }
        let [least] = &pair.minima[..] else { panic!("{:?}", pair.minima) };
        assert_eq!(least.place, MinimumPlace::Start);
        assert_near(least.at.distance[0] * 1e3, f64::hypot(x, z) - radius, clearance);
        let by_radius = least.d[model.variable("r").unwrap().0];
        assert_near(by_radius, if radius > 0.0 { -1.0 } else { 0.0 }, clearance);
    }
}

#[test]
fn shapes_that_touch_at_one_end_of_the_motion_only_are_listed_there() {
    for (law, time) in [("20*t", 0.0), ("20*(1 - t)", 1.0), ("20*(2*t - 1)^2", 0.5)] {
        let shapes = "a = { body = \"ground\", sphere = [0, 0, 0], radius = 5 }\n\
                      b = { body = \"m\", sphere = [10, 0, 0], radius = 5 }\n\
                      [clearances.c]\nbetween = [\"a\", \"b\"]\n";
        let model = tyre_and_wall(law, 10, shapes);
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        let touching = pair(&model, &found, "c").intervals();
        let [[from, to]] = touching[..] else { panic!("{law}: {touching:?}") };
        assert!((from - time).abs() <= 1e-8 && (to - time).abs() <= 1e-8, "{law}: {touching:?}");
    }
}

/// A strip with a spike on it, whose tip is at (31.1875, -1.875, 0) and passes rods along z at 0.311875 s.
const STRIP: &str = "v -500 -5 -20\nv 500 0 -20\nv 500 0 20\nv -500 -5 20\nv 31 -4 0\nv 31.375 -4 0\nv 31.1875 -1.875 0\n\
                     f 1 3 2\nf 1 4 3\nf 5 6 7\n";
const SPIKE: &str = r#"
name = "strip"
units = { length = "mm", angle = "deg" }
time = { end = 1.0, steps = 37 }
hardpoints = { P = [0, 0, -30], Q = [0, 0, 30] }
bodies = { table = {}, slide = {} }
[joints]
j = { type = "translational", bodies = ["ground", "table"], at = [0, 0, 0], axis = "x" }
s = { type = "translational", bodies = ["ground", "slide"], at = [0, 5, 100], axis = "z" }
leg = { type = "leg", bodies = ["ground", "slide"], at = ["P", "Q"] }
[drivers]
motor = { joint = "j", law = "-100*t" }
lift = { joint = "s", law = "5*t" }
[shapes]
spike = { mesh = "strip.obj", body = "table" }
rod = { capsule = "leg", radius = 1 }
bar = { capsule = ["P", "Q"], body = "ground", radius = 1 }
[clearances]
leg = { between = ["spike", "rod"] }
fixed = { between = ["spike", "bar"] }
[design]
rod_up = { move = ["P", "Q"], along = "y" }
"#;

/// A metric of a clearance that is solved at its own time, with the search's value.
fn assert_metric(model: &Model, name: &str, found: &PairClearance, what: &str) -> Vec<f64> {
    let solution = Analysis::new(model).unwrap().run();
    let values = hardpoint::run::metrics(model, &solution);
    let k = model.metrics.iter().position(|m| m.name == name).unwrap();
    let least = found.least().unwrap().at;
    let value = values[k].value.unwrap();
    assert!((value - least.distance[0]).abs() < 1e-9, "{what}: {value} instead of {least:?}");
    assert!(values[k].error.is_none_or(|error| error < 1e-9), "{what}: {:?}", values[k].error);
    values[k].d.clone()
}

#[test]
fn a_spike_that_passes_a_rod_between_two_times_is_nearest_there_and_its_metric_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("strip.toml");
    std::fs::write(folder.path().join("strip.obj"), STRIP).unwrap();
    for steps in [1, 3, 7, 9, 10, 37] {
        std::fs::write(&path, SPIKE.replace("steps = 37", &format!("steps = {steps}"))).unwrap();
        let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        for name in ["leg", "fixed"] {
            let (what, pair) = (format!("{name}, {steps} steps"), pair(&model, &found, name));
            let least = pair.least().unwrap().at;
            assert_near(least.distance[0] * 1e3, 1.875 - 1.0, &what);
            assert_near(least.time, 0.311_875, &what);
            let d = assert_metric(&model, &format!("{name}.min"), pair, &what);
            assert_near(d[model.variable("rod_up").unwrap().0], 1.0, &what);
        }
    }
}

#[test]
fn a_spike_on_a_strip_that_is_as_far_at_all_output_times_is_nearest_where_it_passes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("strip.toml");
    let flat = "v -500 0 -20\nv 500 0 -20\nv 500 0 20\nv -500 0 20\nv 31 0 0\nv 31.375 0 0\nv 31.1875 3 0\n\
                f 1 3 2\nf 1 4 3\nf 5 6 7\n";
    std::fs::write(folder.path().join("strip.obj"), flat).unwrap();
    let text = SPIKE.replace("[0, 0, -30]", "[0, 5, -30]").replace("[0, 0, 30]", "[0, 5, 30]");
    for steps in [1, 2, 3, 10] {
        std::fs::write(&path, text.replace("steps = 37", &format!("steps = {steps}"))).unwrap();
        let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        for name in ["leg", "fixed"] {
            let (what, pair) = (format!("{name}, {steps} steps"), pair(&model, &found, name));
            let least = pair.least().unwrap().at;
            assert!(!pair.is_constant, "{what}");
            assert_near(least.distance[0] * 1e3, 5.0 - 3.0 - 1.0, &what);
            assert_metric(&model, &format!("{name}.min"), pair, &what);
        }
    }
}

/// Two rods whose cores cross while one of them passes the other, and a ball on its way between two others.
const CROSSING: &str = r#"
name = "c"
units = { length = "mm", angle = "deg" }
time = { end = 1.0, steps = 100 }
hardpoints = { O = [0, 0, 0], E = [0, -30, 0], L = [-10, 3, 0], R = [23, 1, 0] }
bodies = { a = {}, b = {} }
[joints]
s = { type = "translational", bodies = ["ground", "a"], at = "O", axis = "x" }
t = { type = "translational", bodies = ["ground", "b"], at = "O", axis = "x" }
[drivers]
m = { joint = "s", law = "-20+50*t+8*sin(3*t)" }
n = { joint = "t", law = "12*sin(7*t)" }
[shapes]
rod = { body = "a", capsule = [[0, 0, -30], [0, 0, 30]], radius = 2 }
bar = { body = "ground", capsule = ["E", [0, 30, 0.5]], radius = 3 }
ball = { body = "b", sphere = "O", radius = 1 }
l = { body = "ground", sphere = "L", radius = 1 }
r = { body = "ground", sphere = "R", radius = 1 }
middle = { body = "ground", sphere = "O", radius = 1 }
[clearances]
c = { between = ["rod", "bar"] }
k = { between = ["ball", "middle"] }
g = { between = ["ball", ["l", "r"]] }
gl = { between = ["ball", "l"] }
gr = { between = ["ball", "r"] }
[measures]
x = { type = "coordinate", joint = "t" }
z = { type = "expression", expression = "-c" }
h = { type = "expression", expression = "min(gl, gr)" }
[metrics]
c_in = { of = "c", take = "min", window = [0.2, 0.5] }
z_max = { of = "z", take = "max" }
k_in = { of = "k", take = "min", window = [0.3, 0.6] }
g_max = { of = "g", take = "max" }
g_range = { of = "g", take = "range" }
g_in = { of = "g", take = "max", window = [0.05, 0.4] }
g_over = { of = "g", take = "max", over = "x", window = [3, 11] }
h_max = { of = "h", take = "max" }
[design]
E_x = { move = "E", along = "x" }
L_x = { move = "L", along = "x" }
"#;

fn crossing(steps: usize) -> (Model, Vec<MetricValue>) {
    let model = model_of(&CROSSING.replace("steps = 100", &format!("steps = {steps}")));
    let solution = Analysis::new(&model).unwrap().run();
    let values = hardpoint::run::metrics(&model, &solution);
    (model, values)
}

#[test]
fn metrics_where_cores_meet_are_those_of_the_cores_without_derivatives_at_any_output_times() {
    for steps in [1, 2, 3, 5, 7, 10, 37, 100] {
        let (model, values) = crossing(steps);
        let of = |name: &str| &values[model.metrics.iter().position(|m| m.name == name).unwrap()];
        let cases = [("c.min", -5.0), ("c_in", -5.0), ("z_max", 5.0), ("k.min", -2.0), ("k_in", -2.0)];
        for (name, expected) in cases {
            let found = of(name);
            let what = format!("{name}, {steps} steps: {found:?}");
            assert!((1e3 * found.value.unwrap() - expected).abs() < 1e-7, "{what}");
            assert!(found.error.is_none(), "{what}");
            // No variable moves the ball that passes through the middle.
            let d = found.d[model.variable("E_x").unwrap().0];
            assert!(d.is_nan() || name.starts_with('k'), "{what}");
        }
    }
}

#[test]
fn the_greatest_clearance_between_two_shapes_has_the_derivative_of_both_at_any_output_times() {
    // The ball is at x where it is as far from both: (x + 10)^2 + 9 = (23 - x)^2 + 1, and for a moved ball
    // 2 (x - L) (dx - dL) = -2 (23 - x) dx.
    let x = (23.0_f64.powi(2) + 1.0 - 109.0) / (2.0 * 33.0);
    let apart = (23.0 - x).hypot(1.0);
    let d = -(x + 10.0) * (23.0 - x) / (33.0 * apart);
    for steps in [1, 2, 3, 5, 10, 37, 2000] {
        let (model, values) = crossing(steps);
        let least = model.metrics.iter().position(|m| m.name == "g.min").unwrap();
        let [least, by_least] = [values[least].value.unwrap(), values[least].d[1]];
        for (metric, found) in model.metrics.iter().zip(&values) {
            let (value, by) = match metric.name.as_str() {
                "g_max" | "g_in" | "g_over" | "h_max" => (apart - 2.0, d),
                "g_range" => (apart - 2.0 - 1e3 * least, d - by_least),
                _ => continue,
            };
            let what = format!("{}, {steps} steps: {found:?}", metric.name);
            assert!((1e3 * found.value.unwrap() - value).abs() < 1e-8, "{what}, not {value}");
            assert!((found.d[1] - by).abs() < 1e-7, "{what}, not {by}");
            assert!(found.error.is_none(), "{what}");
        }
    }
}

#[test]
fn a_slot_that_passes_a_rod_between_two_times_is_where_the_rod_is_farthest() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("strip.toml");
    let slot = "v -500 -5 -40\nv 31 -5 -40\nv 31 -5 40\nv -500 -5 40\nv 33 -5 -40\nv 500 -5 -40\nv 500 -5 40\n\
                v 33 -5 40\nf 1 3 2\nf 1 4 3\nf 5 7 6\nf 5 8 7\n";
    std::fs::write(folder.path().join("strip.obj"), slot).unwrap();
    let metrics = "[metrics]\nmost = { of = \"fixed\", take = \"max\" }\nrange = { of = \"fixed\", take = \"range\" }\n\
                   inside = { of = \"fixed\", take = \"max\", window = [0.2, 0.5] }\n[design]";
    for steps in [1, 3, 7, 10, 37, 400] {
        let text = SPIKE.replace("steps = 37", &format!("steps = {steps}")).replace("[design]", metrics);
        std::fs::write(&path, text).unwrap();
        let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
        let values = hardpoint::run::metrics(&model, &Analysis::new(&model).unwrap().run());
        // Midway between both edges the rod is 5 mm above and 1 mm beside each.
        let most = 5.0_f64.hypot(1.0) - 1.0;
        for (metric, found) in model.metrics.iter().zip(&values) {
            let (value, by) = match metric.name.as_str() {
                "most" | "inside" => (most, 5.0 / (most + 1.0)),
                "range" => (most - 4.0, 5.0 / (most + 1.0) - 1.0),
                _ => continue,
            };
            let what = format!("{}, {steps} steps: {found:?}", metric.name);
            assert!((1e3 * found.value.unwrap() - value).abs() < 1e-7, "{what}, not {value}");
            assert!((found.d[0] - by).abs() < 1e-6, "{what}, not {by}");
            assert!(found.error.is_none_or(|error| error < 1e-9), "{what}");
        }
    }
}

/// A gear with 50 turns of its second shaft per turn of the first, and a screw with 40 turns over its way: an arm on
/// each passes through a pin once per turn.
#[test]
fn what_turns_faster_than_its_driver_passes_a_pin_in_each_turn() {
    let gear = r#"
name = "gear"
units = { length = "mm", angle = "deg" }
time = { end = 1.0, steps = 50 }
bodies = { slow = {}, fast = {} }
[joints]
a = { type = "revolute", bodies = ["ground", "slow"], at = [0, 0, 0], axis = "z" }
b = { type = "revolute", bodies = ["ground", "fast"], at = [100, 0, 0], axis = "z" }
[couplers]
g = { type = "gear", joints = ["a", "b"], teeth = [50, 1] }
[drivers]
motor = { joint = "a", law = "360*t" }
[shapes]
arm = { capsule = [[100, 0, 0], [150, 0, 0]], body = "fast", radius = 2 }
pin = { sphere = [60, 10, 0], body = "ground", radius = 3 }
[clearances.c]
between = ["arm", "pin"]
"#;
    let screw = r#"
name = "screw"
units = { length = "mm", angle = "deg" }
time = { end = 1.0, steps = 50 }
bodies = { spindle = {} }
[joints]
s = { type = "screw", bodies = ["ground", "spindle"], at = [0, 0, 0], axis = "z", lead = 5 }
[drivers]
feed = { joint = "s", coordinate = "displacement", law = "200*t" }
[shapes]
arm = { capsule = [[0, 0, 0], [50, 0, 0]], body = "spindle", radius = 2 }
pin = { capsule = [[-40, 15, -20], [-40, 15, 220]], body = "ground", radius = 3 }
[clearances.c]
between = ["arm", "pin"]
"#;
    for (text, turns) in [(gear, 50), (screw, 40)] {
        for steps in [1, 7, 39, 40, 50] {
            let model = model_of(&text.replace("steps = 50", &format!("steps = {steps}")));
            let found = Analysis::new(&model).unwrap().clearances(&[]);
            let (what, pair) = (format!("{}, {steps} steps", model.name), pair(&model, &found, "c"));
            assert_eq!(pair.intervals().len(), turns, "{what}");
            // The axes of both meet.
            let least = pair.least().unwrap().at;
            assert!((least.distance[0] + 5e-3).abs() < 1e-8, "{what}: {least:?}");
            assert_metric(&model, "c.min", pair, &what);
        }
    }
}

/// An arm on a crank whose elastic joints deflect under its weight, against a pin.
fn elastic_arm(steps: usize, shapes: [&str; 2]) -> String {
    let [ball, pin] = shapes;
    format!(
        r#"
name = "elastic"
units = {{ length = "mm", angle = "deg" }}
time = {{ end = 1.0, steps = {steps} }}
hardpoints = {{ O = [0, 0, 0], A = [40, 0, 0], B = [90, 20, 5], G = [70, 10, 0] }}
bodies = {{ crank = {{}}, arm = {{}} }}
[parameters]
r = {{ value = 3, unit = "length" }}
[joints]
jo = {{ type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z", axis2 = "x" }}
ja = {{ type = "revolute", bodies = ["crank", "arm"], at = "A", axis = "z", axis2 = "x" }}
[drivers]
m = {{ joint = "jo", law = "150*t" }}
n = {{ joint = "ja", law = "-30*t" }}
[forces]
e1 = {{ type = "elastic_joint", joint = "jo", x = 100, y = 150, about_x = 300, about_y = 400 }}
e2 = {{ type = "elastic_joint", joint = "ja", about_z = 50, about_x = 80, about_y = 80, x = 70, y = 70 }}
[gravity]
along = "-y"
[masses]
w = {{ type = "rigid", centre = {{ body = "arm", at = "G" }}, mass = 8 }}
[equilibrium]
[shapes]
ball = {{ body = "arm", {ball}, radius = "r" }}
pin = {{ body = "ground", {pin} }}
[clearances.c]
between = ["ball", "pin"]
"#
    )
}

#[test]
fn the_least_distance_at_an_equilibrium_is_a_metric_at_its_own_time() {
    for steps in [8, 50] {
        let pin = "capsule = [[60, 60, 3], [60, 60, -40]], radius = 2";
        let model = model_of(&elastic_arm(steps, ["sphere = \"B\"", pin]));
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        let (what, pair) = (format!("{steps} steps"), pair(&model, &found, "c"));
        // The same at output times 1e-5 s apart.
        assert!((pair.least().unwrap().at.distance[0] - 2.391_065_409e-3).abs() < 1e-11, "{what}");
        let d = assert_metric(&model, "c.min", pair, &what);
        assert_near(d[model.variable("r").unwrap().0], -1.0, &what);
    }
}

#[test]
fn a_contact_at_an_equilibrium_has_a_beginning_and_an_end_at_any_output_times() {
    for steps in [3, 10] {
        let pin = "capsule = [[60, 70, 3], [60, 70, -40]], radius = 2";
        let model = model_of(&elastic_arm(steps, ["capsule = [\"A\", \"B\"]", pin]));
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        let touching = pair(&model, &found, "c").intervals();
        let [[from, to]] = touching[..] else { panic!("{steps} steps: {touching:?}") };
        assert!((from - 0.261_556_6).abs() < 1e-7, "{steps} steps: {from}");
        assert!((to - 0.304_051_7).abs() < 1e-7, "{steps} steps: {to}");
    }
}

#[test]
fn a_least_distance_over_some_output_times_is_one_minimum() {
    let drum = "cylinder = [[60, 70, 3], [60, 70, -40]], round = 1, radius = 9";
    let model = model_of(&elastic_arm(400, ["sphere = \"B\"", drum]));
    let found = Analysis::new(&model).unwrap().clearances(&[]);
    let times: Vec<f64> = pair(&model, &found, "c").minima.iter().map(|m| m.at.time).collect();
    assert_eq!(times.len(), 1, "{times:?}");
}

#[test]
fn lengths_of_a_box_are_positive() {
    for sides in ["[-30, 12, 20]", "[30, 0, 20]", "[30, 12, -1e-9]"] {
        let error = parse(&TIED.replace("[30, 12, 20]", sides), "box.toml").unwrap_err();
        assert_eq!(error.list()[0].code, "HP0263", "{sides}: {error}");
        assert!(error.list()[0].message.ends_with("is not positive"), "{sides}: {error}");
    }
}

#[test]
fn solids_of_any_size_have_their_distances() {
    // A ball and three solids, all scaled together.
    let text = |scale: f64| {
        let list = |p: &[f64]| {
            format!("[{}]", p.iter().map(|x| (x * scale).to_string()).collect::<Vec<_>>().join(", "))
        };
        format!(
            "name = \"c\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\ntime = {{ end = 1, steps = 4 }}\nbodies.arm = {{}}\n\
             joints.A = {{ type = \"revolute\", bodies = [\"ground\", \"arm\"], at = [0, 0, 0], axis = [0.2, 0.1, 1] }}\n\
             drivers.m = {{ joint = \"A\", law = \"90*t\" }}\n[shapes]\n\
             rod = {{ body = \"arm\", capsule = [[0, 0, 0], {}], radius = {} }}\n\
             block = {{ body = \"ground\", box = {}, frame = {{ position = {} }} }}\n\
             wedge = {{ body = \"ground\", hull = [{}, {}, {}, {}] }}\n\
             [clearances]\nblock = {{ between = [\"rod\", \"block\"] }}\nwedge = {{ between = [\"rod\", \"wedge\"] }}\n",
            list(&[60.0, 0.0, 0.0]),
            4.0 * scale,
            list(&[10.0, 15.0, 20.0]),
            list(&[30.0, 40.0, 3.0]),
            list(&[10.0, 50.0, 0.0]),
            list(&[20.0, 55.0, 4.0]),
            list(&[12.0, 70.0, 30.0]),
            list(&[-5.0, 60.0, 8.0]),
        )
    };
    let depths = |scale: f64| {
        let model = model_of(&text(scale));
        let found = Analysis::new(&model).unwrap().clearances(&[]);
        let least = |name: &str| pair(&model, &found, name).least().unwrap().at.distance[0] * 1e3 / scale;
        [least("block"), least("wedge")]
    };
    let [block, wedge] = depths(1.0);
    assert!(block < -4.0 && wedge < -4.0, "{block} {wedge}");
    for scale in [1e-6, 1e3] {
        let [a, b] = depths(scale);
        assert!((a - block).abs() < 1e-6 && (b - wedge).abs() < 1e-6, "{scale}: {a} {block}, {b} {wedge}");
    }
}

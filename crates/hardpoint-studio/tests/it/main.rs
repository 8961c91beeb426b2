//! The replies to a page are the results of the command for the same text.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use hardpoint::Analysis;
use hardpoint_studio::Engine;
use hardpoint_study::{RequestError, optimize, request, tolerance};
use serde_json::{Value, json};

/// Relative tolerance: curves of the page are `f32`, and an optimised design is that of the edited text except for
/// rounded digits.
const SAME: f64 = 1e-5;
/// Fraction of the largest quantity below which values are round-off.
const NOTHING: f64 = 1e-9;

fn models() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    files.sort();
    files
}

fn model(path: &Path) -> Value {
    let file = hardpoint_file::read(path).unwrap();
    json!({ "file": path.file_name().unwrap().to_str(), "text": file.text(), "files": file.texts, "case": null, "shown": null })
}

fn named(name: &str) -> Value {
    model(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name))
}

/// Returns the reply to a request, with its curves in place of their indices.
fn ask(engine: &mut Engine, request: Value) -> Value {
    let block = engine.answer(&serde_json::to_vec(&request).unwrap(), &mut |_| ControlFlow::Continue(()));
    let length = u32::from_le_bytes(block[..4].try_into().unwrap()) as usize;
    let start = (4 + length).next_multiple_of(4);
    let numbers: Vec<f32> =
        block[start..].chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
    let mut answer: Value = serde_json::from_slice(&block[4..4 + length]).unwrap();
    if answer.get("design").is_some_and(|d| d.is_object()) {
        for quantity in answer["design"]["quantities"].as_array_mut().unwrap() {
            for order in ["value", "rate", "accel"] {
                let Some([first, count]) = quantity.get(order).and_then(place) else { continue };
                quantity[order] = json!(numbers[first..first + count]);
            }
        }
    }
    answer
}

fn place(curve: &Value) -> Option<[usize; 2]> {
    let list = curve.as_array()?;
    Some([list.first()?.as_u64()? as usize, list.get(1)?.as_u64()? as usize])
}

/// Maximum absolute value and values of each output of a text, computed by the core, in the units of the file.
fn solved(text: &str, model: &Value) -> Vec<(f64, Vec<f64>)> {
    let texts = serde_json::from_value(model["files"].clone()).unwrap();
    let mut file = hardpoint_file::parse_with(text, "model.toml", &texts).unwrap();
    if !file.model.cases.is_empty() {
        file = file.in_case(hardpoint::model::CaseId(0));
    }
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.solve(hardpoint::Run::new().without_sensitivities());
    let outputs = solution.measured.outputs.iter().enumerate();
    outputs
        .map(|(m, output)| {
            let of = |k: usize| file.units.from_si(output.dimension, solution.measured.value(k, m)[0]);
            let values: Vec<f64> = (0..solution.motion.len()).map(of).collect();
            (values.iter().fold(0.0_f64, |most, x| most.max(x.abs())), values)
        })
        .collect()
}

#[test]
fn changed_hardpoints_are_displayed_at_their_positions() {
    let (model, mut engine) = (named("macpherson.toml"), Engine::default());
    ask(&mut engine, json!({ "ask": "open", "model": model }));
    let change = json!([{ "name": "tie_rod_outer_z", "by": 20.0 }, { "name": "strut_top.x", "by": -8.0 }]);
    let design = ask(&mut engine, json!({ "ask": "design", "change": change, "from": null }));
    let text = ask(&mut engine, json!({ "ask": "text", "change": change }))["text"].clone();
    let mut edited = model.clone();
    edited["text"] = text;
    let [page, before] = [&edited, &model].map(|m| ask(&mut engine, json!({ "ask": "page", "model": m })));
    let skeletons = |bodies: &Value| -> Vec<Value> {
        bodies.as_array().unwrap().iter().map(|body| body["skeleton"].clone()).collect()
    };
    let found = design["design"]["skeletons"].as_array().unwrap();
    let expected = skeletons(&page["bodies"]);
    assert_ne!(expected, skeletons(&before["bodies"]));
    let numbers = |skeleton: &Value| -> Vec<f64> {
        let points = skeleton.as_array().unwrap().iter();
        points.flat_map(|p| p.as_array().unwrap()).map(|x| x.as_f64().unwrap()).collect()
    };
    for (found, expected) in found.iter().zip(&expected) {
        for (a, b) in numbers(found).into_iter().zip(numbers(expected)) {
            assert!((a - b).abs() < SAME * 1000.0, "{found} {expected}");
        }
    }
}

#[test]
fn a_design_is_that_of_the_text_with_its_changes() {
    let mut moved = 0;
    for path in models() {
        let (model, mut engine) = (model(&path), Engine::default());
        let opened = ask(&mut engine, json!({ "ask": "open", "model": model }));
        let grips = opened["grips"].as_array().unwrap_or_else(|| panic!("{}: {opened}", path.display()));
        // Every third hardpoint of every model, by a small amount.
        for grip in grips.iter().step_by(3) {
            let size = grips.iter().flat_map(|g| g["place"].as_array().unwrap()).filter_map(Value::as_f64);
            let by = 1e-3 * size.fold(0.0_f64, |most, x| most.max(x.abs()));
            for coordinate in grip["coordinates"].as_array().unwrap() {
                let change = json!([{ "name": coordinate["variable"], "by": by }]);
                let design = ask(&mut engine, json!({ "ask": "design", "change": change, "from": null }));
                let text = ask(&mut engine, json!({ "ask": "text", "change": change }));
                let (Some(text), true) = (text["text"].as_str(), design["why"].is_null()) else { continue };
                let expected = solved(text, &model);
                let steps = expected[0].1.len();
                let largest = expected.iter().map(|(most, _)| *most).fold(0.0, f64::max);
                for (quantity, (most, values)) in
                    design["design"]["quantities"].as_array().unwrap().iter().zip(&expected)
                {
                    let Some(curve) = quantity["value"].as_array() else { continue };
                    let stride = steps.div_ceil(curve.len());
                    for (k, found) in curve.iter().enumerate() {
                        let found = found.as_f64().unwrap_or(f64::NAN);
                        let wanted = values[k * stride];
                        let turns = ((found - wanted) / 360.0).round() * 360.0;
                        assert!(
                            (found - wanted - turns).abs() <= (SAME * most).max(NOTHING * largest)
                                || !wanted.is_finite(),
                            "{}: {change}: {found} for {wanted}",
                            path.display()
                        );
                    }
                }
                moved += 1;
            }
        }
    }
    assert!(moved > 100, "{moved}");
}

#[test]
fn a_drag_stops_where_the_mechanism_locks_and_says_why() {
    let mut engine = Engine::default();
    let opened = ask(&mut engine, json!({ "ask": "open", "model": named("rssr.toml") }));
    let variable = opened["grips"][0]["coordinates"][0]["variable"].clone();
    let far = json!([{ "name": variable, "by": 1e4 }]);
    let stopped = ask(&mut engine, json!({ "ask": "design", "change": far, "from": [] }));
    let part = stopped["part"].as_f64().unwrap();
    assert!(part < 1.0, "{}", stopped["part"]);
    assert!(stopped["why"]["code"].as_str().unwrap().starts_with("HP04"), "{}", stopped["why"]);
    // The design at that fraction can be reached, and agrees with that of its text.
    let reached = json!([{ "name": variable, "by": 1e4 * part }]);
    let again = ask(&mut engine, json!({ "ask": "design", "change": reached, "from": null }));
    assert!(again["why"].is_null() && again["part"] == 1.0);
    assert_eq!(again["design"]["quantities"], stopped["design"]["quantities"]);
}

#[test]
fn failed_requests_are_reported() {
    let mut engine = Engine::default();
    let strut = named("macpherson.toml");
    for (request, code) in [
        (json!({ "ask": "sing" }), "HP0701"),
        (json!({ "ask": "text", "change": [] }), "HP0702"),
        (
            json!({ "ask": "tolerance", "model": named("rssr.toml"), "asked": { "samples": 10, "seed": 1 } }),
            "HP0602",
        ),
        (json!({ "ask": "page", "model": { "file": "x", "text": "name = ", "files": {} } }), "HP0102"),
    ] {
        assert_eq!(ask(&mut engine, request.clone())["failed"][0]["code"], code, "{request}");
    }
    ask(&mut engine, json!({ "ask": "open", "model": strut }));
    let change = json!([{ "name": "nobody.x", "by": 1 }]);
    let answer = ask(&mut engine, json!({ "ask": "design", "change": change, "from": null }));
    assert_eq!(answer["failed"][0]["code"], "HP0704");
    let beside = ask(&mut engine, json!({ "ask": "beside", "model": named("rssr.toml") }));
    assert_eq!(beside["failed"][0]["code"], "HP0703");
}

/// The command and Python show the errors of the same requests.
#[test]
fn studies_that_cannot_be_requested_have_the_message_of_the_request() {
    let failed = |request: Value| ask(&mut Engine::default(), request)["failed"][0].clone();
    let expect = |found: &Value, error: &RequestError| {
        assert_eq!((&found["code"], &found["message"]), (&"HP0602".into(), &error.message.as_str().into()));
        assert_eq!(found["help"], error.help.as_str());
    };
    let strut = named("macpherson.toml");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/macpherson.toml");
    let file = hardpoint_file::read(&path).unwrap();
    let error = tolerance::Request::of(&file.model, &tolerance::Overrides::default()).unwrap_err();
    let asked = json!({ "samples": 10, "seed": 1 });
    expect(&failed(json!({ "ask": "tolerance", "model": strut, "asked": asked })), &error);

    let variable = json!({ "name": "ball_joint_z", "bounds": [-1, 1] });
    let goal = json!({ "metric": "range", "weight": 1, "target": null });
    let optimize = |variables: &[&Value], goals: &[&Value], starts: usize| {
        let asked = json!({ "variables": variables, "goals": goals, "starts": starts, "iterations": 5 });
        failed(json!({ "ask": "optimize", "model": strut, "asked": asked }))
    };
    let overrides = optimize::Overrides { selection: Some(Default::default()), ..Default::default() };
    expect(&optimize(&[], &[], 1), &optimize::Request::of(&file.model, overrides).unwrap_err());
    let unknown = json!({ "name": "ball_joint_q", "bounds": [-1, 1] });
    expect(&optimize(&[&unknown], &[], 1), &request::variable(&file.model, "ball_joint_q").unwrap_err());
    expect(
        &optimize(&[&variable], &[&goal], 1),
        &request::named("metric", "range", file.model.metrics.iter().map(|m| m.name.as_str())).unwrap_err(),
    );

    let tolerances =
        model(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/studies/strut_tolerances.toml"));
    let asked = json!({ "samples": 10_000_001, "seed": 1 });
    let found = failed(json!({ "ask": "tolerance", "model": tolerances, "asked": asked }));
    assert_eq!(found["message"], "10000001 samples are too many");
    let asked = json!({ "samples": 10, "seed": 1, "allocate": "worst" });
    let found = failed(json!({ "ask": "tolerance", "model": tolerances, "asked": asked }));
    assert_eq!(found["message"], "there is no allocation rule named `worst`");
}

/// The places of a joint's axis are written together, which a tilt changes in a way that no number of the text has.
#[test]
fn an_optimum_that_the_text_cannot_have_comes_with_its_tables_and_the_reason() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/studies/strut_toe.toml");
    let mut strut = model(&path);
    let tilt = "[design]\nlca_tilt = { tilt = \"lca_pivot\", about = \"y\", bounds = [-2, 2] }\n";
    strut["text"] = strut["text"].as_str().unwrap().replace("[design]\n", tilt).into();
    let metric = hardpoint_file::read(&path).unwrap().model.metrics[0].name.clone();
    let asked = json!({
        "variables": [{ "name": "lca_tilt", "bounds": [-2, 2] }],
        "goals": [{ "metric": metric, "weight": 1, "target": null }],
        "starts": 1,
        "iterations": 20,
    });
    let found = ask(&mut Engine::default(), json!({ "ask": "optimize", "model": strut, "asked": asked }));
    assert_eq!(found["text"], Value::Null, "{found}");
    assert_eq!(found["change"][0]["name"], "lca_tilt");
    assert!(!found["tables"].as_array().unwrap().is_empty());
    let message = found["message"].as_str().unwrap();
    assert!(message.contains("not saved: the change of `lca_tilt` cannot be saved: "), "{message}");
}

#[test]
fn messages_have_positions() {
    let mut strut = named("macpherson.toml");
    let text = strut["text"].as_str().unwrap().replace("type = \"spherical\"", "type = \"spherica\"");
    let line = 1 + text[..text.find("spherica\"").unwrap()].matches('\n').count();
    strut["text"] = json!(text);
    let checked = ask(&mut Engine::default(), json!({ "ask": "check", "model": strut }));
    let first = &checked["messages"][0];
    assert_eq!((first["line"].as_u64(), first["severity"].as_str()), (Some(line as u64), Some("error")));
    assert!(first["length"].as_u64() > Some(3), "{first}");
}

#[test]
fn another_design_is_compared() {
    let mut engine = Engine::default();
    let strut = named("macpherson.toml");
    ask(&mut engine, json!({ "ask": "open", "model": strut }));
    let change = json!([{ "name": "tie_rod_outer.z", "by": 2.0 }]);
    let text = ask(&mut engine, json!({ "ask": "text", "change": change }))["text"].clone();
    let mut other = strut.clone();
    other["text"] = text;
    let beside = ask(&mut engine, json!({ "ask": "beside", "model": other }));
    let design = ask(&mut engine, json!({ "ask": "design", "change": change, "from": null }));
    assert_eq!(beside["design"]["quantities"], design["design"]["quantities"]);
    assert_eq!(beside["design"]["values"], design["design"]["values"]);
}

/// A ball on a slider that passes a post; the post is moved towards its way.
const PASSING: &str = r#"
name = "passing"
units = { length = "mm", angle = "deg" }
hardpoints = { origin = [0, 0, 0], post = [45, 60, 0] }
bodies = { slider = {} }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = "origin", axis = "x" }
drivers.push = { joint = "slide", law = "90*t" }
time = { end = 1.0, steps = 10 }
[shapes]
ball = { body = "slider", sphere = "origin", radius = 15 }
head = { body = "ground", sphere = "post", radius = 10 }
[clearances.gap]
between = ["ball", "head"]
[design]
lower = { move = "post", along = "y" }
"#;

#[test]
fn a_drag_stops_where_shapes_touch_and_goes_on_where_they_touched_before() {
    let mut engine = Engine::default();
    let model = json!({ "file": "passing.toml", "text": PASSING, "case": null, "files": {}, "shown": null });
    ask(&mut engine, json!({ "ask": "open", "model": model }));
    let moved = |engine: &mut Engine, from: f64, by: f64, solid: bool| {
        let at = |by: f64| json!([{ "name": "lower", "by": by }]);
        ask(engine, json!({ "ask": "design", "change": at(by), "from": at(from), "solid": solid }))
    };
    let stopped = moved(&mut engine, 0.0, -50.0, true);
    // The sum of the radii is reached after 35 of 50 mm, known to a thousandth of the way.
    let part = stopped["part"].as_f64().unwrap();
    assert!((0.7 - 1.0 / 1024.0..=0.7).contains(&part), "{part}");
    assert_eq!(stopped["why"]["code"], "HP0705");
    let message = stopped["why"]["message"].as_str().unwrap();
    assert!(message.contains("`ball` touches `head` at t = 0.5 s"), "{message}");
    // Without shapes, and from a design in which they touch, nothing stops it.
    for (from, solid) in [(0.0, false), (-40.0, true)] {
        let free = moved(&mut engine, from, -50.0, solid);
        assert_eq!((&free["part"], &free["why"]), (&json!(1.0), &Value::Null));
    }
    let away = moved(&mut engine, 0.0, 50.0, true);
    assert_eq!((&away["part"], &away["why"]), (&json!(1.0), &Value::Null));
}

/// The same, with an arm whose rod of constant length drives the slider about an anchor that moves with the post: both
/// are in line, and lock, where the anchor is as far from the slider as the rod is longer than the arm.
const LOCKING: &str = r#"
lower = { move = ["post", "anchor", "tip"], along = "y", fixed_length = true }
[joints.hinge]
type = "revolute"
bodies = ["ground", "arm"]
at = "anchor"
axis = "z"
[joints.rod]
type = "distance"
bodies = ["arm", "slider"]
at = ["tip", "origin"]
"#;

#[test]
fn a_drag_stops_at_a_shape_that_its_end_is_beyond() {
    let locking = PASSING
        .replace("slider = {} }", "slider = {}, arm = {} }")
        .replace("60, 0] }", "60, 0], anchor = [45, 300, 0], tip = [295, 300, 0] }")
        .replace("lower = { move = \"post\", along = \"y\" }\n", LOCKING);
    // One event of 120 mm takes the post from 35 mm on one side of the ball to 35 mm on the other. After 200 mm
    // the mechanism locks, but not after half of them.
    for (text, by) in [(PASSING, -120.0), (&locking, -120.0), (&locking, -200.0)] {
        let mut engine = Engine::default();
        let model = json!({ "file": "passing.toml", "text": text, "case": null, "files": {}, "shown": null });
        ask(&mut engine, json!({ "ask": "open", "model": model }));
        let mut moved = |from: f64, by: f64, solid: bool| {
            let at = |by: f64| json!([{ "name": "lower", "by": by }]);
            ask(&mut engine, json!({ "ask": "design", "change": at(by), "from": at(from), "solid": solid }))
        };
        // Without shapes, nothing but the lock stops it: after 129.3 = 300 - (|(295, 300)| - 250) mm.
        let free = moved(0.0, by, false);
        let part = if by < -129.3 { 129.3 / -by } else { 1.0 };
        assert!((free["part"].as_f64().unwrap() - part).abs() < 2e-3, "{by}: {}", free["part"]);
        let stopped = moved(0.0, by, true);
        let part = stopped["part"].as_f64().unwrap();
        assert!((35.0 / -by - 1.0 / 1024.0..=35.0 / -by).contains(&part), "{by}: {part}");
        assert_eq!(stopped["why"]["code"], "HP0705", "{by}: {stopped}");
    }
}

#[test]
fn the_text_of_a_rod_that_keeps_its_length_has_that_length() {
    let text = r#"
name = "rod"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { A = [0, 0], B = [40, 200], C = [360, 600], D = [400, 0] }
bodies = { crank = ["A", "B"], rocker = ["C", "D"], ground = ["A", "D"] }
joints.rod = { type = "rod", bodies = ["crank", "rocker"], at = ["B", "C"] }
drivers.motor = { joint = "A", law = "20*sin(2*pi*t)" }
design.c_len = { move = "C", along = "x", fixed_length = true }
time = { end = 1, steps = 20 }
"#;
    let mut engine = Engine::default();
    let model = json!({ "file": "rod.toml", "text": text, "case": null, "files": {}, "shown": null });
    ask(&mut engine, json!({ "ask": "open", "model": model }));
    // Coordinates, which the page adds, are no variables that the rod would follow. Its lengths are the distances of
    // (360, 600) from (40, 200) and from (50, 200).
    for (change, length) in [
        (json!([{ "name": "c_len", "by": 2 }]), "length = 512.24993899"),
        (json!([{ "name": "c_len", "by": 2 }, { "name": "B.x", "by": 10 }]), "length = 506.06323715"),
    ] {
        let found = ask(&mut engine, json!({ "ask": "text", "change": change }))["text"].clone();
        let found = found.as_str().unwrap();
        assert!(found.contains("C = [362, 600]") && found.contains(length), "{found}");
    }
}

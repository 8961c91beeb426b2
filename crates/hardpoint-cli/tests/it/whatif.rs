//! `hardpoint whatif`: the tutorial, and rejected requests.

use std::path::Path;

use serde_json::{Value, json};

use crate::bench::Bench;

/// The strut of the tutorial: ride only.
fn ride(bench: &Bench) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/macpherson.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let held = text.replace("law = \"30*sin(2*pi*0.2*t)\"", "law = \"0\"");
    assert_ne!(held, text);
    bench.put("ride.toml", &held);
}

fn measure<'v>(document: &'v Value, name: &str) -> &'v Value {
    document["measures"].as_array().unwrap().iter().find(|m| m["measure"] == name).unwrap()
}

fn curve(measure: &Value, which: &str) -> Vec<f64> {
    measure[which].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

fn spread(curve: &[f64]) -> f64 {
    let least = curve.iter().copied().fold(f64::INFINITY, f64::min);
    curve.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least
}

#[test]
fn the_tutorial_takes_the_bump_steer_out() {
    let bench = Bench::with(&[]);
    ride(&bench);
    let ranked = bench.run(&["whatif", "ride.toml", "--measure", "toe"]);
    assert_eq!(ranked.status.code(), Some(0));
    let text = String::from_utf8(ranked.stdout).unwrap();
    assert!(text.contains("3      tie_rod_inner_z   -0.028603 deg/mm"), "{text}");

    let set =
        ["whatif", "ride.toml", "--set", "tie_rod_inner.z=+32mm", "-o", "out", "--over", "wheel_travel"];
    let output = bench.run(&set);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(bench.list("out"), ["whatif.csv", "whatif.html", "whatif.json"]);
    let document = bench.json("out/whatif.json");
    let toe = measure(&document, "toe");
    let [today, first, second, exact] = ["today", "first", "second", "exact"].map(|c| curve(toe, c));
    assert!((spread(&today) - 1.8146).abs() < 1e-3 && (spread(&exact) - 0.0688).abs() < 1e-3);
    let error =
        |prediction: &[f64]| prediction.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let (first, second) = (error(&first), error(&second));
    assert!(first < 0.02 && second < first / 20.0, "{first} {second}");
    assert!(document["follows"].as_str().unwrap().starts_with("admissible"));
    let page = bench.page("out/whatif.html");
    let quantities = page["quantities"].as_array().unwrap();
    let quantity = |name: &str| quantities.iter().position(|q| q["name"] == name).unwrap();
    assert_eq!(page["over"], quantity("wheel_travel"));
    let designs = page["designs"].as_array().unwrap();
    let kinds: Vec<&str> = designs.iter().map(|d| d["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["exact", "first_order", "second_order"]);
    let variables = page["variables"].as_array().unwrap();
    for design in designs {
        for (variable, by) in variables.iter().zip(design["change"].as_array().unwrap()) {
            let asked = if variable["name"] == "tie_rod_inner_z" { 32.0 } else { 0.0 };
            assert!((by.as_f64().unwrap() - asked).abs() < 1e-9, "{variable}");
        }
        // The tie rod does not affect the arm's angle: not a digit differs. It affects toe.
        let value = |name: &str| &design["quantities"][quantity(name)]["value"];
        assert_eq!(*value("lca_angle"), quantities[quantity("lca_angle")]["value"]);
        assert_ne!(*value("toe"), quantities[quantity("toe")]["value"]);
    }
    assert_eq!(page["study"]["tables"][1]["title"], "What if tie_rod_inner_z by 32 mm");
    let asked = bench.run(&["whatif", "ride.toml", "--measure", "camber", "-o", "today"]);
    assert_eq!(asked.status.code(), Some(0));
    let page = bench.page("today/whatif.html");
    assert_eq!(page["first"], quantity("camber"));
    assert!(page["designs"].as_array().unwrap().is_empty() && page["over"].is_null());
    assert_eq!(page["study"]["tables"][0]["title"], "Most influential variables of camber");
    assert_eq!(bench.text("out/whatif.csv").lines().count(), 502);

    // The same, written into the file, is the exact curve.
    let text = bench.text("ride.toml").replace("[-200, 200, -50]", "[-200, 200, -18]");
    bench.put("mended.toml", &text);
    let mended = bench.run(&["whatif", "mended.toml", "--set", "tie_rod_inner.z=0mm", "--json"]);
    let mended: Value = serde_json::from_slice(&mended.stdout).unwrap();
    let deviation = curve(measure(&mended, "toe"), "today");
    let deviation = deviation.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(deviation < 1e-9, "{deviation:e}");
}

#[test]
fn invalid_changes_and_measures_are_rejected_with_suggestions() {
    let bench = Bench::with(&[]);
    ride(&bench);
    for (arguments, expected) in [
        (["--set", "tie_rod_outr.z=2"], "did you mean `tie_rod_outer.z`?"),
        (["--set", "tie_rod_outer.z=2deg"], "it is a length, but deg is not a unit of length"),
        (["--set", "tie_rod_outer.z=2furlong"], "there is no unit `furlong`"),
        (["--set", "tie_rod_outer.z=1/0"], "is not finite"),
        (["--set", "tie_rod_outer.z"], "write NAME=CHANGE"),
        (["--set", "lca_pivot.tilt_y=1e400deg"], "is not finite"),
        (["--measure", "tow"], "did you mean `toe`?"),
        (["--over", "nonsense"], "there is no measure named `nonsense`"),
    ] {
        let output = bench.run(&[&["whatif", "ride.toml"][..], &arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty());
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains(expected) && text.contains("HP0602"), "{text}");
    }
}

#[test]
fn a_variable_and_its_coordinate_are_one() {
    let bench = Bench::with(&[]);
    ride(&bench);
    let ranked = |set: &str| {
        let output = bench.run(&["whatif", "ride.toml", "--set", set, "--json"]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(document["change"][0]["variable"], "tie_rod_inner_z");
        let of_toe = document["influence"].as_array().unwrap().iter().filter(|i| i["measure"] == "toe");
        of_toe.map(|i| i["variable"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    let names = ranked("tie_rod_inner.z=1mm");
    assert_eq!(names, ranked("tie_rod_inner_z=1mm"));
    assert!(names.iter().any(|n| n == "tie_rod_inner_z") && !names.iter().any(|n| n == "tie_rod_inner.z"));

    // A change under both names would be ambiguous.
    let twice = ["whatif", "ride.toml", "--set", "tie_rod_inner.z=1mm", "--set", "tie_rod_inner_z=2mm"];
    let output = bench.run(&twice);
    assert_eq!(output.status.code(), Some(2));
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(text.contains("`tie_rod_inner_z` is set already"), "{text}");

    // With a reversed axis it is the same coordinate.
    let text = bench.text("ride.toml") + "\n[design.down]\nmove = \"strut_top\"\nalong = \"-z\"\n";
    bench.put("down.toml", &text);
    let output = bench.run(&["whatif", "down.toml", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let names = document["influence"].as_array().unwrap().iter().map(|i| i["variable"].as_str().unwrap());
    let names: Vec<_> = names.collect();
    assert!(names.contains(&"down") && !names.contains(&"strut_top.z") && names.contains(&"ball_joint.x"));
}

#[test]
fn a_change_beyond_the_bounds_is_reported_and_solved() {
    let bench = Bench::with(&[]);
    ride(&bench);
    let text =
        bench.text("ride.toml") + "\n[design.up]\nmove = \"strut_top\"\nalong = \"z\"\nbounds = [-1, 2]\n";
    bench.put("ride.toml", &text);
    let changed = |by: &str| bench.run(&["whatif", "ride.toml", "--set", by, "--measure", "toe"]);
    let output = changed("up=3mm");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let warning = String::from_utf8(output.stderr).unwrap();
    assert!(
        warning.contains("warning[HP0504]: the change of `up` by 3 mm is outside its bounds"),
        "{warning}"
    );
    assert!(warning.contains("changes of -1 mm to 2 mm"), "{warning}");
    assert!(changed("up=2mm").stderr.is_empty());
    // The same under the name of the hardpoint.
    assert!(!changed("strut_top.z=-1.5mm").stderr.is_empty());
}

/// In a planar mechanism, tilting one joint out of the plane is inadmissible; tilting all four is admissible.
#[test]
fn an_inadmissible_change_is_reported_with_the_nearest_admissible_one() {
    let bench = Bench::with(&[]);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/slider_crank.toml");
    bench.put("slider_crank.toml", &std::fs::read_to_string(path).unwrap());
    let set = ["whatif", "slider_crank.toml", "--set", "J4.tilt_y=1deg"];
    let alone = bench.run(&[&set[..], &["--json"]].concat());
    let document: Value = serde_json::from_slice(&alone.stdout).unwrap();
    assert!(document["follows"].as_str().unwrap().contains("cannot follow"), "{}", document["follows"]);
    let names: Vec<&str> =
        document["nearest"].as_array().unwrap().iter().map(|c| c["variable"].as_str().unwrap()).collect();
    assert_eq!(names, ["J4.tilt_y", "J1.tilt_y", "J2.tilt_y", "J3.tilt_y"]);
    for change in document["nearest"].as_array().unwrap() {
        assert!((change["by"].as_f64().unwrap().to_degrees() - 1.0).abs() < 1e-6, "{change}");
    }
    let offer = String::from_utf8(bench.run(&set).stdout).unwrap();
    assert!(offer.contains("`--admissible` makes this change instead"), "{offer}");

    // With the admissible change, the whole motion is solved and predicted.
    let taken = bench.run(&[&set[..], &["--admissible", "--json"]].concat());
    assert_eq!(taken.status.code(), Some(0), "{}", String::from_utf8_lossy(&taken.stderr));
    let document: Value = serde_json::from_slice(&taken.stdout).unwrap();
    assert!(document["follows"].as_str().unwrap().starts_with("admissible"), "{}", document["follows"]);
    assert_eq!(document["change"].as_array().unwrap().len(), 4);
    assert!(document["nearest"].as_array().unwrap().is_empty());
    assert_eq!(document["times"].as_array().unwrap().len(), 401);
}

#[test]
fn a_named_design_is_compared_and_taken_by_its_name() {
    let bench = Bench::with(&[]);
    ride(&bench);
    let text = bench.text("ride.toml");
    bench
        .put("ride.toml", &format!("{text}\n[designs.higher]\ntie_rod_inner_z = 32\ntie_rod_outer_y = -1\n"));
    let succeeds = |words: &[&str]| {
        let output = bench.run(words);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    succeeds(&["whatif", "ride.toml", "--design", "higher", "-o", "named"]);
    let both = ["--set", "tie_rod_inner_z=32", "--set", "tie_rod_outer_y=-1"];
    succeeds(&[&["whatif", "ride.toml", "-o", "typed"], &both[..]].concat());
    let [named, typed] = ["named", "typed"].map(|folder| bench.json(&format!("{folder}/whatif.json")));
    assert_eq!(curve(measure(&named, "toe"), "exact"), curve(measure(&typed, "toe"), "exact"));
    // The page lists the design for its own comparison.
    let page = bench.page("named/whatif.html");
    assert_eq!(page["named_designs"][0]["name"], "higher");

    let shown = succeeds(&["compare", "ride.toml", "higher", "-o", "compared"]);
    assert!(shown.contains("tie_rod_inner.z") && shown.contains("higher"), "{shown}");
    let compared = bench.json("compared/compare.json");
    assert_eq!(compared["files"], serde_json::json!(["ride.toml", "higher"]));
    let second = measure(&compared, "toe")["curves"][1].as_array().unwrap().clone();
    for (a, b) in second.iter().zip(curve(measure(&typed, "toe"), "exact")) {
        assert!((a.as_f64().unwrap() - b).abs() < 1e-9, "{a} {b}");
    }
    let changed = succeeds(&["whatif", "ride.toml", "--design", "higher", "--set", "tie_rod_outer_z=1"]);
    assert!(changed.contains("tie_rod_outer_z") && changed.contains("tie_rod_inner_z"), "{changed}");
    for (words, why) in [
        (&["compare", "ride.toml", "hihger"][..], "did you mean `higher`?"),
        (&["whatif", "ride.toml", "--design", "lower"], "there is no design named `lower`"),
        (&["whatif", "ride.toml", "--design", "higher", "--set", "tie_rod_inner_z=1"], "is set already"),
        (&["compare", "ride.toml", "lower.toml"], "there is no file `lower.toml`"),
    ] {
        let output = bench.run(words);
        assert_ne!(output.status.code(), Some(0), "{words:?}");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(said.contains(why), "{said}");
    }
}

/// A ring in a box, whose deepest point is between two faces: the depth has a value and no derivative.
const DEEP: &str = r#"
name = "deep"
units = { length = "mm", angle = "deg" }
hardpoints = { A = [0, 0, 0], B = [100, 0, 0] }
bodies.arm = {}
joints.A = { type = "revolute", bodies = ["ground", "arm"], at = "A", axis = "z" }
drivers.motor = { joint = "A", law = "10*t" }
shapes.box = { body = "ground", box = [40, 60, 60], frame = { position = [80, 0, 0] }, round = 2 }
shapes.ring = { body = "arm", ring = "B", axis = "z", radius = 35, round = 5 }
clearances.gap = { between = ["ring", "box"] }
measures.lean = { type = "angle", from = "x", to = [{ body = "arm", at = "A" }, { body = "arm", at = "B" }] }
metrics.end = { of = "gap", take = "value", at = 1 }
design.B_x = { move = "B", along = "x", tolerance = 1 }
design.B_y = { move = "B", along = "y", tolerance = 1 }
tolerance.limits.end = { min = -30 }
time = { end = 1.0, steps = 10 }
"#;

#[test]
fn a_measure_without_derivatives_has_neither_influences_nor_predictions() {
    let bench = Bench::with(&[]);
    bench.put("deep.toml", DEEP);
    let shown = |arguments: &[&str]| {
        let text = bench.shown(arguments);
        assert!(text.contains("exit 0") && !text.to_lowercase().contains("moves it"), "{text}");
        text
    };
    let run = shown(&["run", "deep.toml", "-o", "run"]);
    assert!(run.contains("gap       no derivative by B_x, B_y"), "{run}");
    let summary = bench.json("run/summary.json");
    let mut rankings = summary["sensitivities"].as_array().unwrap().iter();
    let ranking = rankings.find(|ranking| ranking["measure"] == "gap").unwrap();
    assert_eq!((&ranking["largest"], &ranking["unknown"]), (&json!([]), &json!(["B_x", "B_y"])));

    let changed = shown(&["whatif", "deep.toml", "--set", "B_y=5", "-o", "out"]);
    assert!(changed.contains("No derivative by B_x, B_y, A.x, "), "{changed}");
    assert!(changed.contains("at 11 of 11 times"), "{changed}");
    let document = bench.json("out/whatif.json");
    let gap = measure(&document, "gap");
    assert_eq!((&gap["errors"], &gap["unpredicted"]), (&json!([null, null]), &json!(11)));
    assert_eq!((&gap["first"], &gap["second"]), (&json!([]), &json!([])));
    assert!((gap["change"].as_f64().unwrap() + 2.57).abs() < 0.01, "{gap}");
    assert_eq!(document["unknown"][0]["measure"], "gap");
    // The angle has a kink where it is 0, at the first output time. At the others the change is atan(d), which is d to
    // first order, with d = 5/100.
    let lean = measure(&document, "lean");
    assert_eq!(lean["unpredicted"], 1);
    let d: f64 = 0.05;
    let error = (d - d.atan()).to_degrees();
    assert!((lean["errors"][0].as_f64().unwrap() - error).abs() < 1e-9 * error.max(1.0), "{lean} {error}");

    let study = shown(&["tolerance", "deep.toml", "--samples", "100", "-o", "study"]);
    assert!(
        study.lines().any(|line| line.starts_with("  end") && line.trim_end().ends_with(" -")),
        "{study}"
    );
    let limit = &bench.json("study/summary.json")["limits"][0];
    assert_eq!((&limit["by_moments"], &limit["sampled"]), (&Value::Null, &json!(1.0)));
}

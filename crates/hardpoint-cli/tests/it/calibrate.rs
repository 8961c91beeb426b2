//! `hardpoint calibrate`.

use std::path::Path;

use crate::bench::Bench;

fn bench() -> Bench {
    let studies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/studies");
    let bench = Bench::with(&[]);
    for name in ["strut_calibrate.toml", "strut_measured.csv"] {
        bench.put(name, &std::fs::read_to_string(studies.join(name)).unwrap());
    }
    bench
}

/// Design behind the readings, mm: see `models/studies/strut_calibrate.toml`.
const HIDDEN: [(&str, f64); 6] = [
    ("strut_top_x", 1.4),
    ("strut_top_y", -0.9),
    ("ball_joint_z", 1.1),
    ("tie_rod_inner_z", -1.7),
    ("tie_rod_outer_z", 0.8),
    ("tie_rod_outer_y", -0.6),
];

#[test]
fn the_strut_that_was_measured_is_found_although_one_reading_is_a_slip() {
    let bench = bench();
    let output = bench.run(&[
        "calibrate",
        "strut_calibrate.toml",
        "strut_measured.csv",
        "--loss",
        "huber",
        "-o",
        "out",
        "--save",
        "as_built.toml",
    ]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{text}{}", String::from_utf8_lossy(&output.stderr));
    for words in [
        "the readings determine all 6 variables",
        "81 readings in 27 postures",
        "Proposed readings",
        "report: out/report.html",
        "written: out/residuals.csv, out/covariance.csv, out/summary.json",
        "saved: as_built.toml",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert_eq!(bench.list("out"), ["covariance.csv", "report.html", "residuals.csv", "summary.json"]);
    let summary = bench.json("out/summary.json");
    assert_eq!((&summary["study"], &summary["status"]), (&"calibrate".into(), &"found".into()));
    for (variable, (name, hidden)) in summary["variables"].as_array().unwrap().iter().zip(HIDDEN) {
        assert_eq!(variable["name"], name);
        let (end, sigma) = (variable["end"].as_f64().unwrap(), variable["sigma"].as_f64().unwrap());
        // Four standard deviations.
        assert!((end - hidden).abs() < 4.0 * sigma, "{name}: {end} ± {sigma}, hidden {hidden}");
    }
    let slip = &summary["far_off"][0];
    assert!(slip["line"] == 12 && slip["column"] == "half_track" && slip["weight"].as_f64().unwrap() < 0.1);
    assert_eq!(bench.text("out/residuals.csv").lines().count(), 82);
    assert_eq!(bench.text("out/covariance.csv").lines().count(), 7);
    let page = bench.page("out/report.html");
    assert_eq!((&page["sweep"]["what"], &page["designs"][0]["name"]), (&"posture".into(), &"found".into()));
    assert!(bench.text("as_built.toml").contains("# What may be off."));

    // The nominal design of the saved file fits the readings.
    let again = ["calibrate", "as_built.toml", "strut_measured.csv", "--loss", "huber", "--json"];
    let again: serde_json::Value = serde_json::from_slice(&bench.run(&again).stdout).unwrap();
    let [before, after] = [0, 1].map(|k| again["objective"][k].as_f64().unwrap());
    assert!((before - after).abs() < 1e-3 * before, "{before} {after}");
}

/// Fitted values and standard deviations of the strut without priors, mm: an undamped step from here is 1e-11 standard
/// deviations long. The version before there were priors ended 1.6e-6 of them beside it.
const WITHOUT_PRIORS: [(f64, f64); 6] = [
    (0.7613084641651571, 0.215406930133163),
    (0.2287046146545704, 0.513162235134965),
    (-0.11433994146081604, 0.13969655573647266),
    (-2.359643594530843, 0.563352752412889),
    (-1.2907028811688221, 0.6799404401902468),
    (-0.4195290544869919, 0.03365770593430863),
];
/// Round-off of a fit on other processors, in standard deviations.
const PROCESSORS: f64 = 1e-6;

#[test]
fn priors_change_nothing_but_what_they_are_about() {
    let bench = bench();
    let run = |arguments: &[&str]| -> serde_json::Value {
        let all: Vec<&str> = ["calibrate", "strut_calibrate.toml", "strut_measured.csv", "--json"]
            .into_iter()
            .chain(arguments.iter().copied())
            .collect();
        let output = bench.run(&all);
        serde_json::from_slice(&output.stdout)
            .unwrap_or_else(|e| panic!("{e}: {}", String::from_utf8_lossy(&output.stderr)))
    };
    let without = run(&[]);
    for (variable, (end, sigma)) in without["variables"].as_array().unwrap().iter().zip(WITHOUT_PRIORS) {
        let [e, s] = ["end", "sigma"].map(|key| variable[key].as_f64().unwrap());
        assert!((e - end).abs() < PROCESSORS * sigma && (s - sigma).abs() < PROCESSORS * sigma, "{variable}");
        assert_eq!(
            (&variable["source"], &variable["prior_sigma"]),
            (&"no prior".into(), &serde_json::Value::Null)
        );
    }
    // Half of the data are fitted with priors, and compared with the other half.
    let text = bench.text("strut_measured.csv");
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let half = |odd: usize| {
        let rows = lines[1..].iter().enumerate().filter(|(k, _)| k % 2 == odd).map(|(_, line)| *line);
        std::iter::once(lines[0]).chain(rows).collect::<Vec<_>>().join("\n")
    };
    bench.put("even.csv", &half(0));
    bench.put("odd.csv", &half(1));
    let arguments = [
        "calibrate",
        "strut_calibrate.toml",
        "even.csv",
        "--validate",
        "odd.csv",
        "--loss",
        "huber",
        "--prior",
        "strut_top_y=0.2",
        "--prior",
        "strut_top_x=2",
        "--offset",
        "half_track",
    ];
    let output = bench.run(&arguments);
    let printed = String::from_utf8(output.stdout).unwrap();
    for words in [
        "the readings and the priors determine all 7 parameters",
        "Prior and posterior",
        "still your prior",
        "learnt from data",
        "offset of half_track",
        "Validation",
    ] {
        assert!(printed.contains(words), "{words}: {printed}");
    }
    let facts: serde_json::Value =
        serde_json::from_slice(&bench.run(&[&arguments[..], &["--json"]].concat()).stdout).unwrap();
    let sources: Vec<&str> =
        facts["variables"].as_array().unwrap().iter().map(|v| v["source"].as_str().unwrap()).collect();
    assert_eq!(sources[..3], ["learnt from data", "still your prior", "no prior"]);
    // Tables show coordinates, `start` and `end` changes.
    let top = &facts["variables"][1];
    let [nominal, end] = ["nominal", "end"].map(|key| top[key].as_f64().unwrap());
    assert!((nominal - 541.02).abs() < 1e-9 && end.abs() < 5.0, "{top}");
    let mut rows = printed.lines().filter(|line| line.trim_start().starts_with("strut_top_y"));
    assert!(rows.any(|row| row.contains("541.02 mm")), "{printed}");
    assert_eq!((&facts["priors"], &facts["validation"]["data"]), (&2.into(), &"odd.csv".into()));
    assert!(facts["validation"]["measures"][0]["rms"].as_f64().unwrap() > 0.0);
}

#[test]
fn invalid_calibrations_are_rejected() {
    let bench = bench();
    let assert_rejected = |arguments: &[&str], code: i32, words: &str| {
        let all: Vec<&str> =
            ["calibrate", "strut_calibrate.toml"].into_iter().chain(arguments.iter().copied()).collect();
        let output = bench.run(&all);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{text}");
        assert!(text.contains(words), "{words}: {text}");
    };
    assert_rejected(&["nowhere.csv"], 3, "`nowhere.csv` cannot be read");
    assert_rejected(&["strut_measured.csv", "--variable", "strut_top"], 2, "did you mean `strut_top_x`?");
    assert_rejected(&["strut_measured.csv", "--sigma", "toe"], 2, "--sigma toe=0.02");
    assert_rejected(&["strut_measured.csv", "--prior", "strut_top_x"], 2, "--prior rod=0.5");
    assert_rejected(&["strut_measured.csv", "--prior", "strut_top_x=0"], 2, "give a number above zero");
    assert_rejected(&["strut_measured.csv", "--priors", "tolerance"], 2, "did you mean `tolerances`?");
    assert_rejected(&["strut_measured.csv", "--offset", "to"], 2, "driver, measure or point component");
    assert_rejected(&["strut_measured.csv", "--validate", "strut_measured.csv"], 2, "are the fitted data");
    bench.put("odd.csv", "strut_drive,tow\n0,0.2\n");
    assert_rejected(&["strut_measured.csv", "--validate", "odd.csv"], 3, "did you mean `toe`?");
    assert_rejected(&["strut_measured.csv", "--save", "strut_calibrate.toml"], 2, "the model file itself");
    bench.put("few.csv", "strut_drive,toe\n0,0.2\n10,0.1\n");
    assert_rejected(&["few.csv"], 2, "give standard deviations (`sigma`)");
    bench.put("far.csv", "strut_drive,toe\n4000,0.2\n");
    assert_rejected(&["far.csv", "--sigma", "toe=0.1"], 2, "no posture of the table can be reached");
}

#[test]
fn a_fit_that_better_designs_would_not_move_is_stuck() {
    // The readings are of another assembly: the best coupler is shorter than b = a + d - c = 80 mm, where Grashof's
    // condition ends and the crank cannot turn through the postures.
    let bench = Bench::with(&["four_bar_of_studies.toml"]);
    let readings = "motor,psi\n-150,217.6\n-106,202.1\n-62,178.6\n-18,168.7\n4,172.6\n26,180.1\n70,199.1\n\
                    114,215.4\n158,222.5\n";
    bench.put("measured.csv", readings);
    let arguments =
        ["calibrate", "four_bar_of_studies.toml", "measured.csv", "--sigma", "psi=0.1", "--variable", "b"];
    let output = bench.run(&[&arguments[..], &["--json"]].concat());
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((output.status.code(), &summary["status"]), (Some(1), &"stuck".into()), "{summary}");
    let fitted = &summary["variables"][0];
    assert!((fitted["end"].as_f64().unwrap() - 80.0).abs() < 0.1, "{fitted}");
    assert_eq!((&fitted["sigma"], &summary["next"]), (&serde_json::Value::Null, &serde_json::json!([])));
}

/// A lever on an actuator of 35.6 cm, which is at most 40.3 + 30 cm long.
const LEVER: &str = r#"
name = "lever"
units = { length = "cm", angle = "rad" }
parameters.e = { value = 30, unit = "length" }
parameters.beta = { value = 0.9, unit = "angle" }
hardpoints = { A = [0, 0, 0], G = [40, -5, 0], E = ["e*cos(beta)", "e*sin(beta)", 0], T = [50, 60, 0] }
bodies = { lever = {} }
joints.A = { type = "revolute", bodies = ["ground", "lever"], at = "A", axis = "z" }
points.T = { body = "lever", at = "T" }
drivers.act = { from = { body = "ground", at = "G" }, to = { body = "lever", at = "E" }, law = "2*t" }
design.Gx = { move = "G", along = "x", fixed_length = false }
measures.rot = { type = "coordinate", joint = "A" }
time = { end = 1, steps = 4 }
"#;

#[test]
fn a_posture_out_of_reach_is_reported_by_its_drivers() {
    let bench = Bench::with(&[]);
    bench.put("lever.toml", LEVER);
    bench.put("read.csv", "act,rot,#note\n0,0.0,first\n-2,0.07,\n50,0.3,out of reach\n4,-0.14,\n");
    let arguments =
        ["calibrate", "lever.toml", "read.csv", "--sigma", "rot=0.01", "--variable", "Gx", "--json"];
    let output = bench.run(&arguments);
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    // sqrt(40^2 + 5^2) + 30 - sqrt((40 - 30 cos 0.9)^2 + (5 + 30 sin 0.9)^2) = 34.70
    let why = "the mechanism reaches a limit position at act = 34.7 cm, on the path to act = 50 cm";
    assert_eq!(summary["not_reached"], serde_json::json!([{ "line": 4, "why": why }]), "{summary}");
}

#[test]
fn a_fit_that_runs_away_is_reported_as_such() {
    let bench = Bench::with(&[]);
    let priors = "design.Gy = { move = \"G\", along = \"y\", fixed_length = false }\n\
                  [calibrate]\noffsets = [{ of = \"rot\", sigma = 0.01 }]\n\
                  [calibrate.variables]\nbeta = { sigma = 0.02, mean = 0.88 }\ne = 0.5\n";
    let model = LEVER.replace("unit = \"length\" }", "unit = \"length\", bounds = [25, 35] }");
    bench.put("lever.toml", &format!("{model}{priors}"));
    // The lever turns in the other sense: only an actuator from infinitely far on the other side would do that.
    bench.put("read.csv", "act,rot,T.x\n0,0.0,50\n-2,0.04,48\n-4,0.09,45\n3,,\n4,-0.1,54\n");
    let arguments = ["calibrate", "lever.toml", "read.csv", "--sigma", "rot=0.01", "--sigma", "T.x=0.1"];
    let output = bench.run(&[&arguments[..], &["--json"]].concat());
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((output.status.code(), &summary["status"]), (Some(1), &"diverged".into()), "{summary}");
    assert!(summary["message"].as_str().unwrap().contains("do not determine them"), "{summary}");
    let fitted = summary["variables"].as_array().unwrap().iter().find(|v| v["name"] == "Gx").unwrap();
    assert_eq!((&fitted["sigma"], &fitted["source"]), (&serde_json::Value::Null, &"not fitted".into()));
}

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

    // What is saved explains the readings in the design configuration.
    let again = ["calibrate", "as_built.toml", "strut_measured.csv", "--loss", "huber", "--json"];
    let again: serde_json::Value = serde_json::from_slice(&bench.run(&again).stdout).unwrap();
    let [before, after] = [0, 1].map(|k| again["objective"][k].as_f64().unwrap());
    assert!((before - after).abs() < 1e-3 * before, "{before} {after}");
}

#[test]
fn what_cannot_be_calibrated_is_told() {
    let bench = bench();
    let told = |arguments: &[&str], code: i32, words: &str| {
        let all: Vec<&str> =
            ["calibrate", "strut_calibrate.toml"].into_iter().chain(arguments.iter().copied()).collect();
        let output = bench.run(&all);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{text}");
        assert!(text.contains(words), "{words}: {text}");
    };
    told(&["nowhere.csv"], 3, "`nowhere.csv` cannot be read");
    told(&["strut_measured.csv", "--variable", "strut_top"], 2, "did you mean `strut_top_x`?");
    told(&["strut_measured.csv", "--sigma", "toe"], 2, "--sigma toe=0.02");
    told(&["strut_measured.csv", "--save", "strut_calibrate.toml"], 2, "the model file itself");
    bench.put("few.csv", "strut_drive,toe\n0,0.2\n10,0.1\n");
    told(&["few.csv"], 2, "give standard deviations (`sigma`), fit fewer variables");
    bench.put("far.csv", "strut_drive,toe\n4000,0.2\n");
    told(&["far.csv", "--sigma", "toe=0.1"], 2, "no posture of the table can be compared");
}

//! The files that the commands leave, and what stops them.

use std::path::Path;

use serde_json::Value;

use crate::bench::Bench;

fn rows(csv: &str) -> usize {
    csv.lines().count() - 1
}

#[test]
fn json_of_a_run_is_its_summary_and_nothing_else() {
    let bench = Bench::with(&["slider.toml"]);
    let output = bench.run(&["run", "slider.toml", "-o", "out", "--json"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty());
    assert_eq!(String::from_utf8(output.stdout).unwrap(), bench.text("out/summary.json"));
    let summary = bench.json("out/summary.json");
    assert_eq!(summary["status"], "complete");
    assert_eq!(summary["diagnostics"][0]["code"], "HP0501");
    assert_eq!(summary["diagnostics"][0]["severity"], "warning");
    let named: Vec<&str> = summary["files"].as_array().unwrap().iter().map(|f| f.as_str().unwrap()).collect();
    assert!(named.iter().all(|f| bench.path(f).is_file()), "{named:?}");
}

#[test]
fn both_formulations_write_the_same_motion() {
    let bench = Bench::with(&["slider.toml"]);
    for (folder, extra) in [("relative", &[][..]), ("absolute", &["--absolute"])] {
        let output = bench.run(&[&["run", "slider.toml", "-o", folder], extra].concat());
        assert_eq!(output.status.code(), Some(0));
    }
    for name in ["motion.csv", "sensitivity.csv"] {
        let [a, b] = ["relative", "absolute"].map(|f| bench.text(&format!("{f}/{name}")));
        assert_eq!(rows(&a), rows(&b));
        for (p, q) in a.lines().zip(b.lines()).flat_map(|(p, q)| p.split(',').zip(q.split(','))) {
            match (p.parse::<f64>(), q.parse::<f64>()) {
                // The largest numbers are accelerations of 1e5 deg/s^2.
                (Ok(p), Ok(q)) => assert!((p - q).abs() <= 1e-9 * (1.0 + p.abs()), "{name}: {p} and {q}"),
                _ => assert_eq!(p, q, "{name}"),
            }
        }
    }
}

#[test]
fn a_motion_past_its_limit_leaves_the_part_that_was_solved() {
    let bench = Bench::with(&["short_rod.toml"]);
    let output = bench.run(&["run", "short_rod.toml", "-o", "out"]);
    assert_eq!(output.status.code(), Some(5));
    assert_eq!(bench.list("out"), ["motion.csv", "report.html", "sensitivity.csv", "summary.json"]);
    let summary = bench.json("out/summary.json");
    assert_eq!(summary["status"], "stopped");
    assert_eq!(summary["stop"]["code"], "HP0401");
    assert_eq!(summary["steps"]["solved"], 8);
    assert_eq!(rows(&bench.text("out/motion.csv")), 8);
    // Where the four-bar stretches: rod and rocker in line, 123.69 + 183.85 mm from pivot to pin.
    let motor = summary["stop"]["drivers"][0]["value"].as_f64().unwrap();
    let (rod, rocker) = (120.0_f64.hypot(30.0), 130.0_f64.hypot(130.0));
    let cosine = (100.0_f64.powi(2) + 250.0_f64.powi(2) - (rod + rocker).powi(2)) / (2.0 * 100.0 * 250.0);
    assert!((motor - (cosine.acos().to_degrees() - 90.0)).abs() < 1e-3, "{motor} deg");
    assert!(bench.text("out/report.html").contains("Solved 8 of 101 steps"));
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_the_part_that_was_solved() {
    use std::time::{Duration, Instant};
    let bench = Bench::with(&["slider.toml"]);
    let long =
        bench.text("slider.toml").replace("steps = 40", "steps = 1000000").replace("40*sin", "0.1*sin");
    bench.put("long.toml", &long);
    let mut command = bench.command(&["run", "long.toml", "-o", "out"]);
    command.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped());
    let child = command.spawn().unwrap();
    // The folder is made after the handler is set and before anything is solved.
    let started = Instant::now();
    while !bench.path("out").is_dir() && started.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(10));
    }
    std::thread::sleep(Duration::from_millis(300));
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(bench.list("out"), ["motion.csv", "report.html", "sensitivity.csv", "summary.json"]);
    let summary = bench.json("out/summary.json");
    assert_eq!(summary["status"], "interrupted");
    let solved = summary["steps"]["solved"].as_u64().unwrap() as usize;
    assert!(0 < solved && solved < 1_000_001, "{solved}");
    assert_eq!(rows(&bench.text("out/motion.csv")), solved);
    let shown = String::from_utf8(output.stdout).unwrap();
    assert!(shown.ends_with("report: out/report.html (partial)\n"), "{shown}");
    assert!(String::from_utf8(output.stderr).unwrap().contains("warning[HP0405]: interrupted"));
}

#[test]
fn verify_passes_on_the_best_steps_and_names_the_worst() {
    let bench = Bench::with(&["slider.toml"]);
    let output = bench.run(&["verify", "slider.toml", "--sweep", "-o", "out"]);
    let shown = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{shown}");
    assert!(
        shown.contains("worst of all: ")
            && shown.contains("passed: 2 of 3 variables agree, 1 cannot be followed"),
        "{shown}"
    );
    let verdict = bench.json("out/verify.json");
    assert_eq!(verdict["passed"], true);
    assert_eq!(verdict["checks"][2]["outcome"], "cannot_follow");
    // While truncation rules, the deviation falls by ten for each half decade of the step.
    for check in &verdict["checks"].as_array().unwrap()[..2] {
        let error = |k: usize| check["sweep"][k]["error"].as_f64().unwrap();
        assert!((8.0..12.0).contains(&(error(0) / error(1))), "{check}");
        assert!(check["worst"]["error"].as_f64().unwrap() < 1e-8, "{check}");
    }
    assert_eq!(verdict["differences"], "central");

    // One-sided, by ten for a whole decade, and not as far.
    for side in ["forward", "backward"] {
        let output = bench.run(&["verify", "slider.toml", "--differences", side, "--json"]);
        assert_eq!(output.status.code(), Some(0));
        let verdict: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(verdict["differences"], side);
        assert_eq!(verdict["tolerance"], 4e-4);
        for check in &verdict["checks"].as_array().unwrap()[..2] {
            let error = |k: usize| check["sweep"][k]["error"].as_f64().unwrap();
            assert!((8.0..12.0).contains(&(error(2) / error(4))), "{check}");
            let worst = check["worst"]["error"].as_f64().unwrap();
            assert!(1e-9 < worst && worst < 1e-5, "{check}");
        }
    }
}

/// The crank pin so far outboard, the rod is too short for the motion; inboard it is not.
#[test]
fn a_backward_difference_serves_where_the_other_side_cannot_be_assembled() {
    let bench = Bench::with(&["slider.toml"]);
    let solved = |differences: &str| {
        let output = bench.run(&[
            "verify",
            "slider.toml",
            "--steps",
            "0.6,1e-6",
            "--differences",
            differences,
            "--json",
        ]);
        assert_eq!(output.status.code(), Some(0));
        let verdict: Value = serde_json::from_slice(&output.stdout).unwrap();
        verdict["checks"][0]["sweep"].as_array().unwrap().len()
    };
    assert_eq!(["central", "forward", "backward"].map(solved), [1, 1, 2]);
}

#[test]
fn verify_fails_where_no_step_agrees() {
    let bench = Bench::with(&["slider.toml"]);
    // A single coarse step leaves its truncation error.
    let output = bench.run(&["verify", "slider.toml", "--steps", "0.1", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let verdict: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(verdict["passed"], false);
    assert!(verdict["worst"]["error"].as_f64().unwrap() > verdict["tolerance"].as_f64().unwrap());
}

#[test]
fn the_gallery_runs_and_its_reports_are_complete() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let bench = Bench::with(&[]);
    let mut seen = 0;
    for entry in std::fs::read_dir(models).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        seen += 1;
        let output = bench.run(&["run", path.to_str().unwrap(), "-o", "out", "--json"]);
        assert_eq!(output.status.code(), Some(0), "{}", path.display());
        let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
        let report = bench.text("out/report.html");
        assert!(report.len() < 10_000_000, "{}: {} bytes", path.display(), report.len());
        let all = ["bodies", "joints", "drivers", "measures", "variables"];
        for fact in all.iter().flat_map(|list| summary["model"][list].as_array().unwrap()) {
            let name = fact["name"].as_str().unwrap();
            assert!(report.contains(&format!("\"{name}\"")), "{}: no {name}", path.display());
        }
    }
    assert!(seen >= 5, "only {seen} models");
}

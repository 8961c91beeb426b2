//! `hardpoint synthesize`: files, exit codes, JSON.

#[cfg(unix)]
use std::{io::BufRead, process::Stdio};

use crate::bench::Bench;

const TASK: &str = "\
name = \"lid\"
units = { length = \"mm\", angle = \"deg\" }
poses = [[0, 0, 0], [10, 5, 20], [20, 6, 45], [28, 2, 70], [32, -6, 100]]
";

#[test]
fn answers_are_models_with_pages_and_earlier_ones_are_removed() {
    let bench = Bench::with(&[]);
    bench.put("lid.toml", TASK);
    let output = bench.run(&["synthesize", "lid.toml", "-o", "out"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("6 four-bars: 1 with a change of branch, 1 on separate circuits, 4 good"),
        "{text}"
    );
    assert_eq!(bench.list("out"), ["1", "2", "3", "4", "answers.csv", "index.html", "summary.json"]);
    assert_eq!(bench.list("out/1"), ["model.toml", "report.html"]);
    assert!(bench.text("out/1/report.html").contains("lid 1"));
    let index = bench.text("out/index.html");
    assert!(index.contains("href=\"1/report.html\"") && index.contains("<svg"), "{index}");
    let summary = bench.json("out/summary.json");
    assert_eq!(summary["answers"].as_array().unwrap().len(), 4);
    assert_eq!(summary["four_bars"]["good"], 4);
    // The model runs, and its targets are met.
    assert_eq!(bench.run(&["run", "out/2/model.toml", "-o", "run"]).status.code(), Some(0));
    let missed = bench.json("run/summary.json")["metrics"][0]["value"].as_f64().unwrap();
    assert!(missed.abs() < 1e-8, "{missed}");

    let output = bench.run(&["synthesize", "lid.toml", "-o", "out", "--answers", "1", "--json"]);
    assert_eq!(output.status.code(), Some(0));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["answers"].as_array().unwrap().len(), 1);
    assert!(bench.list("out/2").is_empty() && bench.list("out/1").len() == 2);
}

#[test]
fn without_a_folder_nothing_is_written_and_codes_tell_the_outcome() {
    let bench = Bench::with(&[]);
    bench.put("lid.toml", TASK);
    let before = bench.list(".");
    assert_eq!(bench.run(&["synthesize", "lid.toml"]).status.code(), Some(0));
    assert_eq!(bench.list("."), before);
    bench.put("none.toml", &format!("{TASK}full_turn = true\n"));
    let output = bench.run(&["synthesize", "none.toml"]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("allow cranks that rock"), "{text}");
    bench.put(
        "two.toml",
        "name = \"t\"\nunits = { length = \"mm\", angle = \"deg\" }\nposes = [[0, 0, 0], [1, 1, 1]]\n",
    );
    let output = bench.run(&["synthesize", "two.toml", "--json"]);
    assert_eq!(output.status.code(), Some(3));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["diagnostics"][0]["code"], "HP0901");
    assert_eq!(document["diagnostics"][0]["line"], 3);
    assert_eq!(bench.run(&["synthesize", "nowhere.toml"]).status.code(), Some(3));
}

#[test]
#[cfg(unix)]
fn an_interrupted_synthesis_reports_how_far_it_came() {
    let bench = Bench::with(&[]);
    // Seconds of searches: points that no four-bar meets, of both types.
    let points: Vec<String> = (0..60)
        .map(|k| f64::from(k) * std::f64::consts::TAU / 60.0)
        .map(|a| format!("[{:.3}, {:.3}]", 50.0 * a.cos() + 9.0 * (3.0 * a).cos(), 30.0 * a.sin()))
        .collect();
    bench.put(
        "long.toml",
        &format!(
            "name = \"long\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\nclosed = true\npoints = [{}]\n",
            points.join(", ")
        ),
    );
    let mut command = bench.command(&["synthesize", "long.toml", "-o", "out"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut out = std::io::BufReader::new(child.stdout.take().unwrap());
    let mut text = String::new();
    out.read_line(&mut text).unwrap();
    assert!(text.contains("long"), "{text}");
    let interrupted = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(interrupted.unwrap().success());
    std::io::Read::read_to_string(&mut out, &mut text).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{text}");
    assert!(text.contains("interrupted"), "{text}");
    assert!(!bench.list("out").contains(&"summary.json".to_owned()));
}

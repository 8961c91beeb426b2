//! `hardpoint sweep`.

use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::bench::Bench;

const STRUT: &str = "strut_sweep.toml";
/// Number of designs per block: a killed sweep keeps complete blocks.
const BLOCK: usize = 512;

fn bench() -> Bench {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/studies").join(STRUT);
    let bench = Bench::with(&[]);
    bench.put(STRUT, &std::fs::read_to_string(path).unwrap());
    bench
}

fn done(bench: &Bench, arguments: &[&str]) -> String {
    let output = bench.run(&[&["sweep", STRUT], arguments].concat());
    let [text, errors] = [output.stdout, output.stderr].map(|b| String::from_utf8(b).unwrap());
    assert_eq!(output.status.code(), Some(0), "{text}{errors}");
    text + &errors
}

/// All files of a folder without the durations, which differ between runs.
fn files(bench: &Bench, folder: &str) -> Vec<(String, Vec<u8>)> {
    let content = |name: String| {
        let mut bytes = std::fs::read(bench.path(&format!("{folder}/{name}"))).unwrap();
        if name == "summary.json" {
            let text = String::from_utf8(bytes).unwrap().replace(&format!("{folder}/"), "");
            bytes = text.lines().filter(|l| !l.contains("\"seconds\"")).collect::<Vec<_>>().join("\n").into();
        }
        (name, bytes)
    };
    bench.list(folder).into_iter().map(content).collect()
}

fn same(bench: &Bench, a: &str, b: &str) {
    let [a, b] = [a, b].map(|folder| files(bench, folder));
    let names = |of: &[(String, Vec<u8>)]| of.iter().map(|f| f.0.clone()).collect::<Vec<_>>();
    assert_eq!(names(&a), names(&b));
    a.iter().zip(&b).for_each(|(a, b)| assert!(a.1 == b.1, "{} differs", a.0));
}

#[test]
fn the_sweep_of_the_strut_is_printed_and_written() {
    let bench = bench();
    let text = done(&bench, &["--samples", "600", "-o", "out"]);
    for words in [
        "all 600 designs were solved",
        "sobol over 6 variables, seed 1",
        "Rank correlations",
        "tie_rod_outer_y",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert_eq!(bench.list("out"), ["designs.csv", "report-bump.html", "report-steer.html", "summary.json"]);
    let summary = bench.json("out/summary.json");
    assert_eq!((&summary["study"], &summary["status"]), (&"sweep".into(), &"complete".into()));
    assert_eq!(summary["evaluations"]["steps"], 600 * (81 + 61));
    // The extremes in the summary are those of the table.
    let mut table = csv::Reader::from_path(bench.path("out/designs.csv")).unwrap();
    let headers = table.headers().unwrap().clone();
    assert_eq!(headers.get(1), Some("lca_front_z [mm]"));
    let column = headers.iter().position(|h| h == "bump.toe_range [deg]").unwrap();
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let values: Vec<f64> = rows.iter().map(|r| r[column].parse().unwrap()).collect();
    let toe = summary["metrics"].as_array().unwrap().iter().find(|m| m["name"] == "toe_range").unwrap();
    let least = &toe["distribution"]["least"];
    let at = least["design"].as_u64().unwrap() as usize;
    assert_eq!((values[at], values.len()), (least["value"].as_f64().unwrap(), 600));
    assert!(values.iter().all(|x| *x >= values[at]));
    for (k, x) in least["variables"].as_array().unwrap().iter().enumerate() {
        assert_eq!(rows[at][k + 1].parse::<f64>().unwrap(), x.as_f64().unwrap());
    }
    assert_eq!(summary["variables"][0]["start"], 0.0);
}

#[test]
fn a_killed_and_resumed_sweep_equals_an_uninterrupted_one() {
    let bench = bench();
    for format in ["csv", "parquet"] {
        let common = ["--samples", "4000", "--curves", "toe", "--format", format];
        let whole = format!("whole_{format}");
        done(&bench, &[&common[..], &["-o", &whole, "--threads", "2"]].concat());
        let broken = format!("broken_{format}");
        let arguments = [&["sweep", STRUT], &common[..], &["-o", &broken, "--threads", "1"]].concat();
        // Killed three times at arbitrary moments and resumed on any number of threads.
        let journal = bench.path(&broken).join("sweep.partial");
        let length = || std::fs::metadata(&journal).map_or(0, |m| m.len());
        let mut before = 0;
        for kill in 0..3 {
            let mut command = bench.command(&arguments);
            let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
            let started = Instant::now();
            while length() <= before + 100_000 && child.try_wait().unwrap().is_none() {
                assert!(started.elapsed() < Duration::from_secs(120), "nothing is written");
                std::thread::sleep(Duration::from_millis(1));
            }
            child.kill().unwrap();
            child.wait().unwrap();
            before = length();
            assert!(before > 0, "ended before it was killed for time {kill}");
            assert_eq!(bench.list(&broken), ["sweep.partial"]);
        }
        let text = done(&bench, &[&common[..], &["-o", &broken]].concat());
        assert!(text.contains("note: resuming after "), "{text}");
        same(&bench, &whole, &broken);
    }
}

#[test]
fn wherever_a_journal_was_cut_the_rest_is_the_same() {
    let bench = bench();
    let common = ["--samples", "1500", "--method", "latin-hypercube", "--seed", "7"];
    done(&bench, &[&common[..], &["-o", "whole"]].concat());
    // A complete journal: the run fails to write the table.
    std::fs::create_dir_all(bench.path("full/designs.csv")).unwrap();
    let output = bench.run(&[&["sweep", STRUT], &common[..], &["-o", "full"]].concat());
    assert_eq!(output.status.code(), Some(6), "{}", String::from_utf8_lossy(&output.stderr));
    let journal = std::fs::read(bench.path("full/sweep.partial")).unwrap();
    for (k, part) in [0.0, 0.2, 0.5, 0.71, 1.0].into_iter().enumerate() {
        let folder = format!("cut_{k}");
        std::fs::create_dir(bench.path(&folder)).unwrap();
        let length = (part * journal.len() as f64) as usize;
        std::fs::write(bench.path(&folder).join("sweep.partial"), &journal[..length]).unwrap();
        let text = done(&bench, &[&common[..], &["-o", &folder]].concat());
        let kept = if part == 1.0 { 1500 } else { (part * 1500.0) as usize / BLOCK * BLOCK };
        let is_resumed = text.contains(&format!("resuming after {kept} designs"));
        assert_eq!(is_resumed, kept > 0, "{text}");
        same(&bench, "whole", &folder);
    }
}

#[test]
fn a_journal_of_another_sweep_is_not_lost_by_mistake() {
    let bench = bench();
    std::fs::create_dir_all(bench.path("out/designs.csv")).unwrap();
    let run = |arguments: &[&str]| {
        bench.run(&[&["sweep", STRUT, "--samples", "600", "-o", "out"], arguments].concat())
    };
    assert_eq!(run(&[]).status.code(), Some(6));
    let output = run(&["--seed", "2"]);
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{errors}");
    assert!(errors.contains("`out/sweep.partial` belongs to an unfinished sweep"), "{errors}");
    assert!(errors.contains("--restart"), "{errors}");
    std::fs::remove_dir(bench.path("out/designs.csv")).unwrap();
    assert_eq!(run(&["--seed", "2", "--restart"]).status.code(), Some(0));
    assert!(!bench.list("out").contains(&"sweep.partial".to_owned()));
}

#[test]
fn designs_that_fail_keep_their_rows_and_their_reasons() {
    let bench = bench();
    bench.put("designs.csv", "tie_rod_outer_z [mm], lca_front_z\n0, 0\n0, 5000\n-2, 1\n");
    let text = done(&bench, &["--designs", "designs.csv", "--curves", "camber", "-o", "out"]);
    assert!(text.contains("2 of 3 designs were solved"), "{text}");
    assert!(text.contains("1 do not reach the end of the motion"), "{text}");
    let table = bench.text("out/designs.csv");
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!(rows.len(), 4);
    assert!(
        rows[0].starts_with("design,tie_rod_outer_z [mm],lca_front_z [mm],bump.toe_in_bump [deg]"),
        "{table}"
    );
    assert!(rows[1].starts_with("0,0,0,-0.44") && rows[1].ends_with(','), "{table}");
    // It completes the steer case, but not the bump case.
    assert!(rows[2].starts_with("1,0,5000,,,,0.13") && rows[2].contains(",,,bump: the mechanism"), "{table}");
    // Curves of a complete design at every output time of both cases.
    let curves = bench.text("out/curves.csv");
    assert_eq!(curves.lines().next(), Some("design,case,time [s],camber [deg]"));
    assert_eq!(curves.lines().filter(|l| l.starts_with("2,steer,")).count(), 61);
    let summary = bench.json("out/summary.json");
    assert_eq!((&summary["failed"], &summary["failures"][0]["first"]), (&1.into(), &1.into()));
    assert_eq!((&summary["method"], &summary["metrics"][0]["known"]), (&"listed".into(), &2.into()));
}

/// Driven by its slider from 0.3 mm to 0.1 mm before crank and rod are in line.
const NEAR_DEAD_POINT: &str = r#"
name = "slider-crank"
units = { length = "mm", angle = "deg" }
parameters.rod = { value = 300, unit = "length", design = true }
hardpoints = { O = [0, 0, 0], A = [99.6249, 8.6547, 0], B = [399.5, 0, 0] }
bodies = { crank = {}, slider = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = "B", axis = "x" }
joints.rod = { type = "distance", bodies = ["crank", "slider"], at = ["A", "B"], length = "rod" }
drivers.motor = { joint = "slide", law = "0.2 + 0.2*t" }
measures.angle = { type = "coordinate", joint = "pivot" }
metrics.range = { of = "angle", take = "range" }
time = { end = 1.0, steps = 10 }
"#;

#[test]
fn failures_are_counted_by_the_reason_that_is_printed() {
    let bench = Bench::with(&[]);
    bench.put("near.toml", NEAR_DEAD_POINT);
    // Too short for the start, for the end, and again.
    bench.put("designs.csv", "rod [cm]\n30\n29.965\n29.98\n29.96\n29.985\n29.975\n");
    let output = bench.run(&["sweep", "near.toml", "--designs", "designs.csv", "--json"]);
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let failures = summary["failures"].as_array().unwrap();
    let count = |words: &str| {
        let of = failures.iter().filter(|f| f["why"].as_str().unwrap().contains(words));
        of.map(|f| f["count"].as_u64().unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(failures.len(), 2, "{summary}");
    assert_eq!(count("does not reach its start position"), [2], "{summary}");
    assert_eq!(count("cannot move beyond"), [3], "{summary}");
}

#[test]
fn factorials_and_sobol_indices_have_the_right_number_of_designs() {
    let bench = bench();
    let json = |arguments: &[&str]| -> serde_json::Value {
        let output = bench.run(&[&["sweep", STRUT, "--json"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    // Four variables of three values, two of five.
    let found = json(&["--method", "factorial"]);
    assert_eq!((&found["designs"], &found["seed"]), (&(81 * 25).into(), &serde_json::Value::Null));
    let found = json(&["--method", "sobol-indices", "--samples", "256"]);
    assert_eq!(found["designs"], 256 * 8);
    for metric in found["metrics"].as_array().unwrap() {
        let of = |key: &str| -> f64 {
            metric["influences"].as_array().unwrap().iter().map(|i| i[key].as_f64().unwrap()).sum()
        };
        // Nearly linear: first-order indices sum to just below one, total indices to just above.
        assert!((0.6..1.1).contains(&of("first")) && (0.9..1.6).contains(&of("total")), "{metric}");
    }
}

#[test]
fn invalid_sweeps_are_rejected_with_help() {
    let bench = bench();
    let refused = |arguments: &[&str], code: i32, words: &[&str]| {
        let output = bench.run(&[&["sweep", STRUT], arguments].concat());
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{errors}");
        words.iter().for_each(|w| assert!(errors.contains(w), "{w}: {errors}"));
    };
    refused(
        &["--range", "lca_fron_z=-5..5"],
        2,
        &["there is no design variable", "did you mean `lca_front_z`?"],
    );
    refused(&["--range", "lca_front_z=5..-5"], 2, &["not in ascending order", "give the lower end first"]);
    refused(&["--range", "lca_front_z=-5mm..5mm"], 2, &["without units"]);
    refused(&["--range", "lca_front_z"], 2, &["NAME=FROM..TO"]);
    refused(&["--curves", "tow"], 2, &["there is no measure named `tow`", "did you mean `toe`?"]);
    refused(&["--method", "factorial", "--levels", "1000"], 2, &["more than 1000000000 designs"]);
    refused(&["--designs", "none.csv"], 3, &["HP0111", "none.csv"]);
    let list = |text: &str, words: &[&str]| {
        bench.put("list.csv", text);
        refused(&["--designs", "list.csv"], 3, words);
    };
    list("", &["HP0112", "`list.csv` is empty"]);
    list("1,2\n3,4\n", &["line 1", "numbers in place of the names"]);
    list("lca_front_z,camber\n1,2\n", &["HP0247", "no design variable named `camber`", "column 2"]);
    list("lca_front_z,lca_front_z\n1,2\n", &["HP0247", "is the title of two columns"]);
    list("lca_front_z,lca_rear_z\n1,2\n3\n", &["line 3, column 2 (`lca_rear_z`) is missing"]);
    list("lca_front_z,lca_rear_z\n1,2\n3,x\n", &["line 3, column 2 (`lca_rear_z`): `x` is not a number"]);
    list("lca_front_z\n1,2\n", &["line 2 has 2 values for 1 variables"]);
    list("lca_front_z\n", &["has no designs"]);
}

#[test]
#[cfg(unix)]
fn an_interrupted_sweep_keeps_its_designs_and_resumes() {
    let bench = bench();
    let common = ["--samples", "10000", "--threads", "1"];
    let mut command = bench.command(&[&["sweep", STRUT], &common[..], &["-o", "out"]].concat());
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let journal = bench.path("out/sweep.partial");
    let started = Instant::now();
    while std::fs::metadata(&journal).map_or(0, |m| m.len()) < 100_000 {
        assert!(started.elapsed() < Duration::from_secs(120), "nothing is written");
        std::thread::sleep(Duration::from_millis(1));
    }
    let interrupted = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(interrupted.unwrap().success());
    let output = child.wait_with_output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(130), "{text}");
    assert!(text.contains("the same command resumes it"), "{text}");
    let summary = bench.json("out/summary.json");
    assert_eq!(summary["status"], "interrupted");
    let rows = bench.text("out/designs.csv").lines().count() - 1;
    assert_eq!(summary["designs"], rows);
    assert!(rows > 0 && rows < 10_000 && rows.is_multiple_of(BLOCK), "{rows}");
    done(&bench, &[&common[..], &["-o", "out"]].concat());
    assert_eq!(bench.text("out/designs.csv").lines().count(), 10_001);
    assert!(!journal.exists());
}

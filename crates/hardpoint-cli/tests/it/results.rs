//! Result files of the commands, and their stops.

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
fn files_of_cases_that_are_no_longer_in_the_model_are_removed() {
    let bench = Bench::with(&["slider.toml"]);
    let alone = bench.text("slider.toml");
    let cases = |names: &[&str]| {
        let cases = names.iter().map(|name| format!("\n[cases.{name}]\nother_drivers = \"as_in_model\"\n"));
        bench.put("slider.toml", &format!("{alone}{}", cases.collect::<String>()));
        assert_eq!(bench.run(&["run", "slider.toml", "-o", "out"]).status.code(), Some(0));
    };
    let has = |folder: &str| bench.path(&format!("out/{folder}")).exists();
    cases(&["one", "two", "kept"]);
    bench.put("out/kept/notes.txt", "of the user");
    // A run of one case has the summary of that case beside the folders.
    assert_eq!(bench.run(&["run", "slider.toml", "-o", "out", "--case", "two"]).status.code(), Some(0));
    assert!(bench.json("out/summary.json").get("cases").is_none());
    cases(&["one", "three"]);
    assert!(has("one/summary.json") && has("three/summary.json") && !has("two"));
    assert!(has("kept/notes.txt") && !has("kept/summary.json") && !has("kept/report.html"));
    cases(&[]);
    assert!(has("summary.json") && !has("one") && !has("three"));
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
fn largest_deflections_of_bushings_are_written() {
    let bench = Bench::with(&[]);
    bench.shown(&["new", "axle", "--template", "k-and-c"]);
    let output = bench.run(&["run", "axle.toml", "--case", "lateral_in_phase", "-o", "out"]);
    assert_eq!(output.status.code(), Some(0));
    let text = bench.text("out/deflections.csv");
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(
        header[..7],
        ["element", "direction", "deflection", "deflection unit", "force", "force unit", "t [s]"]
    );
    assert_eq!(header[7..11], ["d lca_rear_radial", "d lca_rear_axial", "d bar", "d lca_rear_x [per mm]"]);
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 48);
    let row = rows.iter().find(|row| row[..2] == ["left_lca_front", "along x"]).unwrap();
    let [deflection, force]: [f64; 2] = [row[2], row[4]].map(|x| x.parse().unwrap());
    // 9000 N/mm
    assert!((force + 9000.0 * deflection).abs() <= 1e-9 * force.abs(), "{row:?}");
    // Under its force a soft bushing deflects in inverse proportion to its stiffness; others take little of it.
    let row = rows.iter().find(|row| row[..2] == ["left_lca_rear", "along x"]).unwrap();
    let radial = header.iter().position(|h| h.starts_with("d lca_rear_radial")).unwrap();
    let [deflection, by_stiffness]: [f64; 2] = [row[2], row[radial]].map(|x| x.parse().unwrap());
    let part = by_stiffness * 3000.0 / deflection;
    assert!(-1.0 < part && part < -0.1, "{part} {row:?}");
    let summary = bench.json("out/summary.json");
    assert!(summary["files"].as_array().unwrap().iter().any(|f| f.as_str() == Some("out/deflections.csv")));
}

#[test]
fn metrics_of_all_cases_are_written_printed_and_first_on_a_page() {
    let bench = Bench::with(&[]);
    bench.shown(&["new", "axle", "--template", "k-and-c"]);
    let output = bench.run(&["run", "axle.toml", "-o", "out", "--no-compare"]);
    assert_eq!(output.status.code(), Some(0));
    let text = bench.text("out/metrics.csv");
    let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).unwrap_or_else(|| panic!("{header:?}"));
    let table = csv::Reader::from_reader(text.as_bytes()).into_records();
    let rows: Vec<csv::StringRecord> = table.map(Result::unwrap).collect();
    assert_eq!(rows.len(), 17);
    let row = |metric: &str| rows.iter().find(|row| &row[0] == metric).unwrap();
    let number = |row: &csv::StringRecord, name: &str| row[column(name)].parse::<f64>().ok();

    // The same numbers as in the summary of its case.
    let braking = row("braking_steer");
    assert_eq!((&braking[column("case")], &braking[column("unit")]), ("braking", "deg"));
    assert_eq!(&braking[column("positive")], "toe-in");
    assert_eq!(number(braking, "rigid"), None);
    let summary = bench.json("out/braking/summary.json");
    let fact = summary["metrics"].as_array().unwrap().iter().find(|m| m["name"] == "braking_steer").unwrap();
    assert_eq!(fact["value"].as_f64(), number(braking, "value"));
    assert!(fact["rigid"].is_null());
    let by_place = fact["sensitivities"].as_array().unwrap().iter().find(|s| s["variable"] == "lca_rear_x");
    assert_eq!(by_place.unwrap()["value"].as_f64(), number(braking, "d lca_rear_x [per mm]"));

    // Toe at both ends of the way from driving to braking is that of the two cases of one force each.
    for name in ["value", "d lca_rear_x [per mm]", "d lca_rear_radial"] {
        let of = |metric: &str| number(row(metric), name).unwrap();
        let (tracking, steer) = (of("compliance_steer_tracking"), of("braking_steer") - of("driving_steer"));
        assert!((tracking - steer).abs() <= 1e-9 * steer.abs(), "{name}: {tracking}, {steer}");
    }

    // A wheel that moves has a rigid value, near to the elastic one.
    let toe = row("toe_over_travel");
    let [elastic, rigid] = ["value", "rigid"].map(|name| number(toe, name).unwrap());
    assert!((elastic - rigid).abs() > 0.01 && (elastic - rigid).abs() < 0.1 * elastic, "{elastic}, {rigid}");

    let shown = String::from_utf8(output.stdout).unwrap();
    let (_, all) = shown.split_once("Metrics of all cases").unwrap();
    assert!(all.contains("braking_steer") && all.contains("report of all cases"));
    let page = bench.page("out/report.html");
    let metrics = &page["metrics"];
    assert_eq!(metrics["rows"].as_array().unwrap().len(), 17);
    assert_eq!(metrics["rows"][0][0], "toe_per_aligning_torque_in_phase", "the order of the file");
    let own = bench.page("out/braking/report.html");
    assert_eq!(own["metrics"]["rows"].as_array().unwrap().len(), 2);

    // The page shows the first case as it was solved: here without sensitivities.
    let output = bench.run(&["run", "axle.toml", "-o", "plain", "--no-compare", "--no-sensitivities"]);
    assert_eq!(output.status.code(), Some(0));
    let [all, first] = ["plain", "plain/parallel_travel"].map(|of| bench.page(&format!("{of}/report.html")));
    assert_eq!(all["quantities"], first["quantities"]);
    let derivatives = |page: &Value| {
        let values = page["values"].as_array().unwrap();
        let all = values.iter().flat_map(|of| of["sensitivities"].as_array().unwrap());
        all.filter(|derivative| !derivative.is_null()).count()
    };
    assert!(derivatives(&page) > 0, "{}", page["values"][0]);
    assert_eq!((derivatives(&all), derivatives(&first)), (0, 0));
}

#[test]
fn joint_loads_are_written_and_indeterminate_ones_are_empty() {
    let bench = Bench::with(&[]);
    let press = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/press.toml");
    let output = bench.run(&["run", press.to_str().unwrap(), "-o", "out"]);
    assert_eq!(output.status.code(), Some(0));
    let text = bench.text("out/loads.csv");
    let mut table = csv::Reader::from_reader(text.as_bytes());
    let header: Vec<String> = table.headers().unwrap().iter().map(str::to_owned).collect();
    let column =
        |name: &str| header.iter().position(|h| h == name).unwrap_or_else(|| panic!("{name}: {header:?}"));
    let columns = ["force.x [N]", "force.y [N]", "force in body.x [N]", "force in body.y [N]"].map(column);
    let motion = bench.text("out/motion.csv");
    let mut motion = csv::Reader::from_reader(motion.as_bytes());
    let pin = motion
        .headers()
        .unwrap()
        .iter()
        .position(|h| h == "crank_pin [N]")
        .expect("the press measures its pin");
    let pins: Vec<f64> = motion.records().map(|row| row.unwrap()[pin].parse().unwrap()).collect();
    let mut seen = 0;
    for row in table.records().map(Result::unwrap).filter(|row| &row[1] == "B") {
        let [x, y, u, v] = columns.map(|k| row[k].parse::<f64>().unwrap());
        let radial = pins[seen];
        assert!((x.hypot(y) - radial).abs() < 1e-9 * radial && (u.hypot(v) - radial).abs() < 1e-9 * radial);
        // Along the pin, the reactions of planar hinges are indeterminate.
        assert!(row[column("force.z [N]")].is_empty() && row[column("moment.x [N*m]")].is_empty());
        assert!(!row[column("moment.z [N*m]")].is_empty());
        seen += 1;
    }
    assert_eq!(seen, pins.len());
}

#[test]
fn drivers_are_written_with_their_power_and_the_work_that_they_did() {
    let bench = Bench::with(&[]);
    let press = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/press.toml");
    assert_eq!(bench.run(&["run", press.to_str().unwrap(), "-o", "out"]).status.code(), Some(0));
    let table = |name: &str| {
        let text = bench.text(name);
        let mut table = csv::Reader::from_reader(text.as_bytes());
        let header: Vec<String> = table.headers().unwrap().iter().map(str::to_owned).collect();
        let rows: Vec<Vec<f64>> =
            table.records().map(|row| row.unwrap().iter().map(|x| x.parse().unwrap()).collect()).collect();
        (header, rows)
    };
    let ((header, drivers), (of_motion, motion)) = (table("out/drivers.csv"), table("out/motion.csv"));
    let columns = ["t [s]", "motor moment [N*m]", "motor speed [deg/s]", "motor power [W]", "motor work [J]"];
    assert_eq!(header, columns);
    let torque = of_motion.iter().position(|h| h == "torque [N*m]").expect("the press measures its torque");
    let (mut sum, mut before) = (0.0, None);
    for (driver, motion) in drivers.iter().zip(&motion) {
        let [t, moment, speed, power, work] = driver[..] else { panic!("{driver:?}") };
        assert!((moment - motion[torque]).abs() < 1e-9 && (speed - 360.0).abs() < 1e-9, "{driver:?}");
        assert!((power - moment * speed.to_radians()).abs() < 1e-9 * moment.abs().max(1.0));
        if let Some((then, power_then)) = before {
            sum += 0.5 * (power + power_then) * (t - then);
        }
        assert!((work - sum).abs() < 1e-9);
        before = Some((t, power));
    }
    assert_eq!(drivers.len(), motion.len());
    // Over a turn the tool and the grease dissipate 9.1 J.
    assert!((sum - 9.1).abs() < 0.05, "{sum}");
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
    // The four-bar is stretched: rod and rocker in line, 123.69 + 183.85 mm from pivot to pin.
    let motor = summary["stop"]["drivers"][0]["value"].as_f64().unwrap();
    let (rod, rocker) = (120.0_f64.hypot(30.0), 130.0_f64.hypot(130.0));
    let cosine = (100.0_f64.powi(2) + 250.0_f64.powi(2) - (rod + rocker).powi(2)) / (2.0 * 100.0 * 250.0);
    assert!((motor - (cosine.acos().to_degrees() - 90.0)).abs() < 1e-3, "{motor} deg");
    let status = bench.page("out/report.html")["status"]["message"].to_string();
    assert!(status.contains("Solved 8 of 101 steps"), "{status}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_the_part_that_was_solved() {
    use std::process::{Command, Stdio};
    use std::time::Duration;
    let bench = Bench::with(&["slider.toml"]);
    let long =
        bench.text("slider.toml").replace("steps = 40", "steps = 1000000").replace("40*sin", "0.1*sin");
    bench.put("long.toml", &long);
    // The time at which a run is half finished depends on the machine, so it is searched for.
    let mut pause = Duration::from_millis(10);
    let output = loop {
        let mut command = bench.command(&["run", "long.toml", "-o", "out"]);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // The folder is created after the handler is set and before anything is solved.
        while !bench.path("out").is_dir() {
            assert_eq!(child.try_wait().unwrap(), None, "the run ended without its folder");
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(pause);
        let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        let output = child.wait_with_output().unwrap();
        match output.status.code() {
            Some(130) if !bench.list("out").is_empty() => {
                assert!(kill.success());
                break output;
            }
            // Before the first step.
            Some(130) => pause *= 2,
            // After the last one.
            Some(0) => pause /= 2,
            code => panic!("exit {code:?}: {}", String::from_utf8_lossy(&output.stderr)),
        }
        std::fs::remove_dir_all(bench.path("out")).unwrap();
    };
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

#[cfg(unix)]
#[test]
fn an_interrupted_search_of_clearances_keeps_the_times_that_were_solved() {
    use std::process::{Command, Stdio};
    use std::time::Duration;
    let bench = Bench::with(&[]);
    let knee = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hardpoint-file/tests/it/knee.toml");
    let knee = std::fs::read_to_string(knee).unwrap();
    bench.put("knee.toml", &knee.replace("steps = 20", "steps = 100000"));
    let mut pause = Duration::from_millis(100);
    let output = loop {
        let mut command = bench.command(&["clearance", "knee.toml", "-o", "out", "--json"]);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // The folder is created after the handler is set.
        while !bench.path("out").is_dir() {
            assert_eq!(child.try_wait().unwrap(), None, "it ended without its folder");
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(pause);
        let kill = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
        let output = child.wait_with_output().unwrap();
        match output.status.code() {
            Some(130) if rows(&bench.text("out/clearances.csv")) > 0 => {
                assert!(kill.success());
                break output;
            }
            // Before the first step.
            Some(130) => pause *= 2,
            // After the last proof, with pairs that are nearer than required.
            Some(0 | 1) => pause /= 2,
            code => panic!("exit {code:?}: {}", String::from_utf8_lossy(&output.stderr)),
        }
        std::fs::remove_dir_all(bench.path("out")).unwrap();
    };
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["interrupted"], true, "{document}");
    let pairs = document["pairs"].as_array().unwrap();
    assert!(!pairs.is_empty() && pairs.iter().all(|pair| pair["least"].is_f64()), "{document}");
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
    // While truncation dominates, the deviation decreases by ten per half decade of the step.
    for check in &verdict["checks"].as_array().unwrap()[..2] {
        let error = |k: usize| check["sweep"][k]["error"].as_f64().unwrap();
        assert!((8.0..12.0).contains(&(error(0) / error(1))), "{check}");
        assert!(check["worst"]["error"].as_f64().unwrap() < 1e-8, "{check}");
    }
    assert_eq!(verdict["differences"], "central");

    // One-sided differences: by ten per decade, to a larger minimum.
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

/// With the crank pin farther outboard, the rod is too short for the motion; farther inboard it is not.
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
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        let cases = document["cases"].as_array();
        let motions = match cases {
            Some(cases) => cases
                .iter()
                .map(|one| (format!("out/{}/report.html", one["case"].as_str().unwrap()), &one["result"]))
                .collect(),
            None => vec![("out/report.html".to_owned(), &document)],
        };
        for (page, summary) in motions {
            let size = bench.text(&page).len();
            assert!(size < 10_000_000, "{} {page}: {size} bytes", path.display());
            let report = bench.page(&page).to_string();
            let all = ["bodies", "joints", "drivers", "measures", "variables"];
            for fact in all.iter().flat_map(|list| summary["model"][list].as_array().unwrap()) {
                let name = fact["name"].as_str().unwrap();
                assert!(report.contains(&format!("\"{name}\"")), "{} {page}: no {name}", path.display());
            }
        }
    }
    assert!(seen >= 5, "only {seen} models");
}

#[test]
fn a_long_motion_is_thinned_for_the_page_and_whole_in_the_tables() {
    let bench = Bench::with(&["slider.toml"]);
    let long = bench.text("slider.toml").replace("steps = 40", "steps = 30000").replace("40*sin", "4*sin");
    bench.put("long.toml", &long);
    let output = bench.run(&["run", "long.toml", "-o", "out"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let summary = bench.json("out/summary.json");
    let every = summary["steps"]["kept_every"].as_u64().unwrap() as usize;
    assert!(every > 1);
    assert_eq!(summary["margin"]["series"].as_array().unwrap().len(), 30001_usize.div_ceil(every));
    let status = bench.page("out/report.html")["status"]["message"].to_string();
    assert!(status.contains("This page shows every "), "{status}");
    assert_eq!(rows(&bench.text("out/motion.csv")), 30001);
    // `guide_jam` is inadmissible, which is known only at the end.
    let sensitivities = bench.text("out/sensitivity.csv");
    assert_eq!(rows(&sensitivities), 2 * 30001);
    assert!(!sensitivities.contains("guide_jam"));
    // The same numbers as a motion with fewer output times.
    bench.put("short.toml", &long.replace("steps = 30000", "steps = 300"));
    bench.run(&["run", "short.toml", "-o", "short"]);
    let [long, short] = ["out", "short"].map(|f| bench.text(&format!("{f}/motion.csv")));
    for (k, (p, q)) in long.lines().skip(1).step_by(100).zip(short.lines().skip(1)).enumerate() {
        for (p, q) in p.split(',').zip(q.split(',')).map(|(p, q)| (p.parse::<f64>(), q.parse::<f64>())) {
            let (p, q) = (p.unwrap(), q.unwrap());
            assert!((p - q).abs() <= 1e-7 * (1.0 + p.abs()), "{k}: {p} and {q}");
        }
    }
}

#[test]
fn arrays_equal_the_tables() {
    let bench = Bench::with(&["slider.toml"]);
    assert!(bench.run(&["run", "slider.toml", "-o", "out", "--bodies"]).status.success());
    let [motion, sensitivity] = ["motion", "sensitivity"].map(|f| bench.text(&format!("out/{f}.csv")));
    assert!(bench.run(&["run", "slider.toml", "-o", "out", "--bodies", "--format", "npy"]).status.success());
    // The tables of the earlier run are removed.
    let files = ["columns.json", "motion.npy", "report.html", "sensitivity.npy", "summary.json"];
    assert_eq!(bench.list("out"), files);
    let columns = bench.json("out/columns.json");
    let names = |list: &Value| -> Vec<String> {
        let header = |c: &Value| match (c["name"].as_str().unwrap(), c["unit"].as_str().unwrap()) {
            (name, "1") => name.to_owned(),
            (name, unit) => format!("{name} [{unit}]"),
        };
        list.as_array().unwrap().iter().map(header).collect()
    };
    let array = |name: &str| -> Vec<f64> {
        let bytes = std::fs::read(bench.path(&format!("out/{name}.npy"))).unwrap();
        bytes[256..].chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
    };
    let header = names(&columns["motion"]);
    assert_eq!(motion.lines().next().unwrap(), header.join(","));
    let numbers = |line: &str, skip: usize| -> Vec<f64> {
        line.split(',').skip(skip).map(|x| x.parse().unwrap()).collect()
    };
    let written: Vec<f64> = motion.lines().skip(1).flat_map(|line| numbers(line, 0)).collect();
    assert_eq!(array("motion"), written);
    let header = names(&columns["sensitivity"]["columns"]);
    assert_eq!(sensitivity.lines().next().unwrap(), format!("t [s],variable,per,{}", header.join(",")));
    let written: Vec<f64> = sensitivity.lines().skip(1).flat_map(|line| numbers(line, 3)).collect();
    let array = array("sensitivity");
    assert_eq!(array.len(), 41 * 3 * header.len());
    let (known, unknown): (Vec<f64>, Vec<f64>) = array.into_iter().partition(|x| !x.is_nan());
    assert_eq!(known, written);
    assert_eq!(unknown.len(), 41 * header.len(), "one of three variables cannot be followed");
}

#[test]
fn parquet_equals_the_tables_and_has_units() {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    let bench = Bench::with(&["slider.toml"]);
    assert!(bench.run(&["run", "slider.toml", "-o", "out", "--bodies"]).status.success());
    let tables = ["motion", "sensitivity"].map(|name| (name, bench.text(&format!("out/{name}.csv"))));
    assert!(
        bench.run(&["run", "slider.toml", "-o", "out", "--bodies", "--format", "parquet"]).status.success()
    );
    assert_eq!(bench.list("out"), ["motion.parquet", "report.html", "sensitivity.parquet", "summary.json"]);
    for (name, csv) in tables {
        let file = std::fs::File::open(bench.path(&format!("out/{name}.parquet"))).unwrap();
        let reader = SerializedFileReader::new(file).unwrap();
        let facts = reader.metadata().file_metadata().key_value_metadata().unwrap().clone();
        let fact = |key: &str| facts.iter().find(|f| f.key == key).unwrap().value.clone().unwrap();
        assert_eq!(fact("model"), "slider-crank for tests");
        let units: Value = serde_json::from_str(&fact("units")).unwrap();
        let mut table = csv::Reader::from_reader(csv.as_bytes());
        let headers = table.headers().unwrap().clone();
        for header in headers.iter().filter(|h| !["variable", "per"].contains(h)) {
            let unit = header.rsplit_once(" [").map_or("1", |(_, unit)| unit.trim_end_matches(']'));
            assert_eq!(units[header], unit);
        }
        let mut count = 0;
        for (row, record) in reader.get_row_iter(None).unwrap().zip(table.records()) {
            let (row, record) = (row.unwrap(), record.unwrap());
            for ((column, field), (header, text)) in row.get_column_iter().zip(headers.iter().zip(&record)) {
                assert_eq!(column, header);
                match field {
                    Field::Double(x) => assert_eq!(*x, text.parse::<f64>().unwrap()),
                    Field::Str(x) => assert_eq!(x, text),
                    other => assert!(*other == Field::Null && text.is_empty(), "{header}: {other}, {text}"),
                }
            }
            count += 1;
        }
        assert_eq!((count, reader.metadata().file_metadata().num_rows()), (rows(&csv), rows(&csv) as i64));
    }
}

#[test]
fn only_requested_files_are_written() {
    let bench = Bench::with(&["slider.toml"]);
    let text = bench.text("slider.toml");
    let (before, after) = text.split_once("[design]").unwrap();
    let (_, after) = after.split_once("[points]").unwrap();
    bench.put("plain.toml", &format!("{before}[points]{after}"));
    // Files of an earlier run of the model with variables are removed.
    assert!(bench.run(&["run", "slider.toml", "-o", "out", "--jerk"]).status.success());
    assert!(bench.list("out").contains(&"jerk.csv".to_owned()));
    bench.put("out/notes.txt", "mine");
    assert!(bench.run(&["run", "plain.toml", "-o", "out"]).status.success());
    assert_eq!(bench.list("out"), ["motion.csv", "notes.txt", "report.html", "summary.json"]);
    assert!(bench.run(&["run", "slider.toml", "-o", "quick", "--no-sensitivities"]).status.success());
    assert_eq!(bench.list("quick"), ["motion.csv", "report.html", "summary.json"]);
    assert_eq!(bench.json("quick/summary.json")["sensitivities"], Value::Array(vec![]));
}

#[test]
fn names_that_spreadsheets_would_run_are_text() {
    let bench = Bench::with(&["slider.toml"]);
    let text = bench.text("slider.toml").replace("guide_turn =", "\"=1+1\" =").replace("tip =", "\"@tip\" =");
    bench.put("odd.toml", &text);
    let output = bench.run(&["run", "odd.toml", "-o", "out"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    for name in ["motion.csv", "sensitivity.csv"] {
        let mut reader = csv::Reader::from_path(bench.path(&format!("out/{name}"))).unwrap();
        let header = reader.headers().unwrap().clone();
        let cells = reader.records().flat_map(|r| r.unwrap().iter().map(String::from).collect::<Vec<_>>());
        for cell in header.iter().map(String::from).chain(cells) {
            let formula = cell.starts_with(['=', '+', '-', '@']) && cell.parse::<f64>().is_err();
            assert!(!formula, "{name}: {cell}");
        }
    }
    assert!(bench.text("out/motion.csv").contains(",'@tip.x [mm],"));
    assert!(bench.text("out/sensitivity.csv").contains(",'=1+1,deg,"));
}

#[test]
fn control_characters_are_never_printed() {
    let bench = Bench::with(&["slider.toml"]);
    let odd = "\"a\\u001b[2J\\u202eb\" =";
    bench.put("odd.toml", &bench.text("slider.toml").replace("guide_jam =", odd).replace("stroke =", odd));
    for command in [&["run", "odd.toml"][..], &["check", "odd.toml"], &["verify", "odd.toml", "--sweep"]] {
        let output = bench.run(command);
        for text in [output.stdout, output.stderr] {
            let text = String::from_utf8(text).unwrap();
            let bad = |c: &char| (c.is_control() && *c != '\n') || *c == '\u{202e}';
            assert_eq!(text.chars().find(bad), None, "{command:?}: {text}");
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_stdout_ends_with_6_and_a_closed_pipe_quietly() {
    use std::process::Stdio;
    let bench = Bench::with(&["slider.toml"]);
    for command in
        [&["run", "slider.toml", "--json"][..], &["check", "slider.toml"], &["schema"], &["--help"]]
    {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = bench.command(command).stdout(full).stderr(Stdio::piped()).output().unwrap();
        assert_eq!(output.status.code(), Some(6), "{command:?}");
        assert!(String::from_utf8(output.stderr).unwrap().contains("error[HP0601]"), "{command:?}");
        // The reader is closed.
        let mut child = bench.command(command).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        assert_eq!(child.wait_with_output().unwrap().status.code(), Some(0), "{command:?}");
    }
}

#[test]
fn files_of_a_killed_run_are_removed_by_the_next() {
    let bench = Bench::with(&["slider.toml"]);
    std::fs::create_dir(bench.path("out")).unwrap();
    bench.put("out/.motion.csv.aB3.part", "half");
    assert!(bench.run(&["run", "slider.toml", "-o", "out"]).status.success());
    assert_eq!(bench.list("out"), ["motion.csv", "report.html", "sensitivity.csv", "summary.json"]);
}

#[test]
fn a_run_that_exceeds_memory_is_rejected_at_once() {
    use std::fmt::Write;
    let bench = Bench::with(&["slider.toml"]);
    let mut text = bench.text("slider.toml");
    let (mut variables, mut bodies, mut joints) = (String::new(), String::new(), String::new());
    for k in 0..800 {
        writeln!(variables, "v{k} = {{ move = \"B\", along = \"x\" }}").unwrap();
        writeln!(bodies, "extra{k} = {{}}").unwrap();
        writeln!(joints, "weld{k} = {{ type = \"fixed\", bodies = [\"ground\", \"extra{k}\"], at = \"A\" }}")
            .unwrap();
    }
    text = text.replace("[design]\n", &format!("[design]\n{variables}"));
    text = text.replace("[bodies]\n", &format!("[bodies]\n{bodies}"));
    text = text.replace("[joints]\n", &format!("[joints]\n{joints}"));
    bench.put("wide.toml", &text);
    let output = bench.run(&["run", "wide.toml", "-o", "out", "--json"]);
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stdout));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let d = &document["diagnostics"][0];
    assert_eq!(d["code"], "HP0603");
    assert!(d["help"].as_str().unwrap().contains("--no-sensitivities"), "{d}");
    assert!(bench.list("out").is_empty());
}

//! `hardpoint tolerance`.

use std::path::Path;

use crate::bench::Bench;

/// Creates a folder with these files of `models`.
fn bench(names: &[&str]) -> Bench {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let bench = Bench::with(&[]);
    for name in names {
        let path = ["models", "models/studies"].map(|folder| root.join(folder).join(name));
        let text = path.iter().find_map(|path| std::fs::read_to_string(path).ok());
        bench.put(name, &text.unwrap_or_else(|| panic!("there is no {name}")));
    }
    bench
}

#[test]
fn the_tolerance_study_of_the_strut_is_printed_and_written() {
    let bench = bench(&["strut_tolerances.toml"]);
    let output = bench.run(&["tolerance", "strut_tolerances.toml", "--samples", "2000", "-o", "out"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{text}{}", String::from_utf8_lossy(&output.stderr));
    for words in [
        "yield",
        "2000 designs, seed 1",
        "Contributions to toe_in_bump (bump)",
        "the linear result is accurate",
        "report: out/report-bump.html",
        "out/bands.csv",
        "loosest",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let tables = ["bands.csv", "contributions.csv", "metrics.csv"];
    let mut files: Vec<&str> = tables.to_vec();
    files.extend(["report-bump.html", "report-steer.html", "samples.csv", "summary.json"]);
    assert_eq!(bench.list("out"), files);

    let summary = bench.json("out/summary.json");
    assert_eq!((&summary["study"], &summary["status"]), (&"tolerance".into(), &"complete".into()));
    assert_eq!(summary["samples"], 2000);
    // The tolerance of a point applies to each of its coordinates.
    let variables = summary["variables"].as_array().unwrap();
    assert_eq!((variables.len(), &variables[0]["name"]), (10, &"ball_joint_x".into()));
    assert_eq!((&variables[0]["tolerance"], &variables[0]["start"]), (&"ball_joint".into(), &0.3.into()));
    assert!(
        variables[3]["end"].as_f64().unwrap() < 0.5 && summary["allocation"]["kkt"].as_f64().unwrap() < 1e-6
    );
    assert!(
        summary["objective"]["after"].as_f64().unwrap() > summary["objective"]["before"].as_f64().unwrap()
    );
    let toe = &summary["metrics"][0];
    assert_eq!(
        (&toe["name"], &toe["case"], &toe["unit"]),
        (&"toe_in_bump".into(), &"bump".into(), &"deg".into())
    );
    let shares: f64 =
        toe["contributions"].as_array().unwrap().iter().map(|c| c["share"].as_f64().unwrap()).sum();
    assert!((shares - 1.0).abs() < 1e-9, "{shares}");

    // A row for each output time of each curve, and for each design.
    let rows = |name: &str| bench.text(&format!("out/{name}")).lines().count();
    assert_eq!((rows("samples.csv"), rows("metrics.csv"), rows("bands.csv")), (2001, 5, 1 + 2 * (81 + 61)));
    // The page opens on the curve of the limited metric, with both edges of its band.
    let page = bench.page("out/report-bump.html");
    let toe = page["quantities"].as_array().unwrap().iter().position(|q| q["name"] == "toe").unwrap();
    assert_eq!(page["first"], toe);
    let designs = page["designs"].as_array().unwrap();
    let names: Vec<&str> = designs.iter().map(|d| d["name"].as_str().unwrap()).collect();
    // Without play there is no curve of loaded pins.
    assert_eq!(names, ["mean - 3 sigma", "mean + 3 sigma", "worst-case minimum", "worst-case maximum"]);
    assert!(designs.iter().all(|d| !d["quantities"][toe].is_null()));
}

/// Slider-crank with play in the pin of its crank, and a force on its ram.
const LOOSE_CRANK: &str = r#"
name = "slider-crank with play"
units = { length = "mm", angle = "rad" }
planar = "xy"
hardpoints = { O = [0, 0], A = [80, 60], B = [370, 0] }
bodies = { crank = {}, rod = {}, ram = {} }
joints.main = { type = "revolute", bodies = ["ground", "crank"], at = "O" }
joints.pin = { type = "revolute", bodies = ["crank", "rod"], at = "A" }
joints.wrist = { type = "revolute", bodies = ["rod", "ram"], at = "B" }
joints.slide = { type = "translational", bodies = ["ground", "ram"], at = "B", axis = "x" }
drivers.motor = { joint = "main", law = "t" }
measures.stroke = { type = "coordinate", joint = "slide" }
metrics.most = { of = "stroke", take = "max" }
design.pin_play = { play = "pin", tolerance = 0.02 }
forces.push = { type = "force", at = { body = "ram", at = "B" }, force = 100, along = "-x" }
time = { end = 1, steps = 10 }
"#;

#[test]
fn the_page_of_play_under_load_has_the_curve_of_loaded_pins() {
    let (bench, model) = (Bench::with(&[]), "play.toml");
    bench.put(model, LOOSE_CRANK);
    let output = bench.run(&["tolerance", model, "--samples", "0", "-o", "out"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let page = bench.page("out/report.html");
    let edges = page["designs"].as_array().unwrap();
    assert_eq!(edges.last().unwrap()["name"], "loaded");
}

#[test]
fn one_case_another_seed_and_no_designs_are_done_as_asked() {
    let bench = bench(&["strut_tolerances.toml"]);
    let json = |arguments: &[&str]| -> serde_json::Value {
        let output = bench.run(&[&["tolerance", "strut_tolerances.toml", "--json"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let none = json(&["--case", "bump", "--samples", "0"]);
    assert_eq!((&none["samples"], none["metrics"].as_array().unwrap().len()), (&0.into(), 3));
    assert!(
        none["metrics"].as_array().unwrap().iter().all(|m| m["case"] == "bump" && m["sampled"].is_null())
    );
    let [one, same, other] = [("7", "1"), ("7", "3"), ("8", "1")].map(|(seed, threads)| {
        json(&[
            "--case",
            "bump",
            "--samples",
            "600",
            "--seed",
            seed,
            "--threads",
            threads,
            "--allocate",
            "worst-case",
        ])
    });
    assert_eq!(one["metrics"], same["metrics"]);
    assert_ne!(one["metrics"][0]["sampled"], other["metrics"][0]["sampled"]);
    assert_eq!(one["allocation"]["rule"], "worst_case");
}

#[test]
fn invalid_tolerance_studies_are_rejected() {
    let bench = bench(&["four_bar.toml", "strut_tolerances.toml"]);
    let refused = |arguments: &[&str], words: &[&str]| {
        let output = bench.run(arguments);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(words.iter().all(|w| text.contains(w)), "{text}");
    };
    let without = bench
        .text("four_bar.toml")
        .lines()
        .filter(|l| !l.contains("tolerance"))
        .collect::<Vec<_>>()
        .join("\n");
    bench.put("exact.toml", &without);
    refused(&["tolerance", "exact.toml"], &["`exact.toml`", "tolerance = 0.1"]);
    refused(&["tolerance", "strut_tolerances.toml", "--case", "bmp"], &["did you mean `bump`?"]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_study_keeps_the_designs_that_were_drawn() {
    use std::process::Stdio;
    use std::time::Duration;
    let bench = bench(&["strut_tolerances.toml"]);
    // The duration of the sampling depends on the machine, so it is searched for.
    let mut pause = Duration::from_millis(50);
    let output = loop {
        let arguments = ["tolerance", "strut_tolerances.toml", "--samples", "10000000", "-o", "out"];
        let mut command = bench.command(&arguments);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // The folder is created after the handler is set.
        while !bench.path("out").is_dir() {
            assert_eq!(child.try_wait().unwrap(), None, "it ended without its folder");
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(pause);
        let killed = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(killed.unwrap().success());
        let output = child.wait_with_output().unwrap();
        match output.status.code() {
            Some(130) if bench.path("out/samples.csv").is_file() => break output,
            // Before the first design.
            Some(130) => pause *= 2,
            // After the last one.
            Some(0) => pause /= 2,
            code => panic!("exit {code:?}: {}", String::from_utf8_lossy(&output.stderr)),
        }
        std::fs::remove_dir_all(bench.path("out")).unwrap();
    };
    let summary = bench.json("out/summary.json");
    assert_eq!(summary["status"], "interrupted");
    let drawn = summary["samples"].as_u64().unwrap() as usize;
    assert!(0 < drawn && drawn < 10_000_000, "{drawn}");
    assert_eq!(bench.text("out/samples.csv").lines().count(), drawn + 1);
    let shown = String::from_utf8(output.stdout).unwrap();
    assert!(shown.contains(&format!("interrupted after {drawn} of 10000000 designs")), "{shown}");
    assert!(!shown.contains("NaN") && !shown.contains("\u{2013} %"), "{shown}");
}

/// Runs a study of a model of these tests; returns the output and the summary.
fn studied(name: &str, samples: &str) -> (String, serde_json::Value) {
    let bench = Bench::with(&[]);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models").join(name);
    bench.put(name, &std::fs::read_to_string(path).unwrap());
    let output = bench.run(&["tolerance", name, "--samples", samples, "-o", "out"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    (String::from_utf8(output.stdout).unwrap(), bench.json("out/summary.json"))
}

/// Contribution of a variable.
fn share(metric: &serde_json::Value, variable: &str) -> f64 {
    let all = metric["contributions"].as_array().unwrap();
    all.iter().find(|c| c["variable"] == variable).unwrap()["share"].as_f64().unwrap()
}

#[test]
fn where_linear_statistics_fail_the_monte_carlo_results_come_first_with_the_reason() {
    let (text, json) = studied("tolerance_kink.toml", "3000");
    let [linear, span] = [&json["metrics"][0], &json["metrics"][2]];
    assert_eq!((&linear["told_by"], &linear["nonlinear"]), (&"linear".into(), &serde_json::Value::Null));
    assert_eq!(span["told_by"], "drawn");
    // Its nominal curve is zero: wherever it is largest, there is a kink.
    assert_eq!(span["nonlinear"], "it has no derivatives", "{span}");
    for words in ["skewness", "0.135 %", "median", "99.865 %", "use the sampled designs", "interactions"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    // Standard deviation and mean of the row are those of the Monte Carlo designs.
    let row = text.lines().find(|l| l.trim_start().starts_with("span")).unwrap();
    assert!(row.contains("drawn"), "{row}");
}

#[test]
fn contributions_come_from_the_model_of_the_spread() {
    // The stroke is linear in the crank and quadratic in the offset: 2 a + c e^2 with c = 4 a b/(b^2 - a^2)/(2 b) ...
    let (_, drawn) = studied("tolerance_curved.toml", "4000");
    let (_, derived) = studied("tolerance_curved.toml", "0");
    for (json, from) in [(&drawn, "drawn"), (&derived, "second_order")] {
        let stroke = &json["metrics"][0];
        assert_eq!(stroke["told_by"], from);
        // sigma of the linear part is 0.04 mm of 0.0511 mm: 61 % of the variance are the crank's, the rest the
        // offset's.
        let (a, e) = (share(stroke, "a"), share(stroke, "e"));
        assert!((a - 0.6125).abs() < 0.05 && (e - 0.3875).abs() < 0.05, "{from}: {a} {e}");
        assert_eq!(json["metrics"][1]["told_by"], "linear");
    }
}

#[test]
fn a_worst_case_that_does_not_assemble_is_reported() {
    let (text, json) = studied("tolerance_dead_point.toml", "1500");
    let phi = &json["metrics"][0];
    let stops = |end: &str| !phi[end]["why"].is_null();
    assert!(stops("greatest") || stops("least"), "{phi}");
    assert!(text.contains("worst case  does not move"), "{text}");
    assert!(text.contains("do not reach the end of the motion"), "{text}");
    assert!(phi["nonlinear"].as_str().unwrap().contains("do not reach the end"), "{phi}");
}

#[test]
fn costs_of_tolerances_count_in_the_units_of_their_variables() {
    let bench = Bench::with(&[]);
    let name = "slider_crank_of_studies.toml";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models").join(name);
    let tables = "\n[tolerance]\nallocate = \"rss\"\nrequired_sigmas = 3\n[tolerance.variables]\nr = { cost = 1 }\n\
                  ph = { cost = 1 }\n[tolerance.limits]\nx = { min = 169, max = 170.2 }\n";
    bench.put(name, &(std::fs::read_to_string(path).unwrap() + tables));
    let output = bench.run(&["tolerance", name, "--samples", "0", "--json"]);
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    // x = r cos p + sqrt(l^2 - (r sin p - e)^2), mm and deg. The least of 1 / t_r + 1 / t_p with
    // (g_r t_r)^2 + (g_p t_p)^2 = room^2 has t ~ g^(-2/3).
    let (r, l, e, p) = (50.0_f64, 160.0_f64, 20.0_f64, 0.7 + 0.2 * std::f64::consts::PI);
    let root = (l * l - (r * p.sin() - e).powi(2)).sqrt();
    let rod = (r * p.sin() - e) / root;
    let x = r * p.cos() + root;
    let g = [p.cos() - rod * p.sin(), (-r * p.sin() - rod * r * p.cos()).to_radians()];
    let shape = g.map(|g| g.abs().powf(-2.0 / 3.0));
    let used = g.iter().zip(shape).map(|(g, t)| (g * t).powi(2)).sum::<f64>().sqrt();
    let expected = shape.map(|t| t * (x - 169.0) / used);
    for (k, expected) in expected.into_iter().enumerate() {
        let end = summary["variables"][k]["end"].as_f64().unwrap();
        assert!((end / expected - 1.0).abs() < 1e-5, "{end} {expected}: {summary}");
        assert_eq!(summary["variables"][k]["cost"].as_f64().map(|cost| (cost * 1e9).round()), Some(1e9));
    }
    let cost = summary["allocation"]["cost"]["after"].as_f64().unwrap();
    assert!((cost / expected.iter().map(|t| 1.0 / t).sum::<f64>() - 1.0).abs() < 1e-5, "{cost}");
}

#[test]
fn a_few_designs_do_not_reject_the_linear_result() {
    for samples in ["2", "3", "5"] {
        let (text, summary) = studied("slider_crank_of_studies.toml", samples);
        assert_eq!(summary["status"], "complete", "{samples}: {text}");
        assert!(text.contains("too few to check sigma"), "{text}");
    }
}

#[test]
fn a_spread_without_a_first_order_part_is_not_unknown() {
    // The offset alone is a square in the stroke.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models/tolerance_curved.toml");
    let text = std::fs::read_to_string(path).unwrap().replace(", tolerance = 0.02", "");
    let bench = Bench::with(&[]);
    bench.put("square.toml", &text);
    let output = bench.run(&["tolerance", "square.toml", "--samples", "1000", "-o", "out"]);
    let text = String::from_utf8(output.stdout).unwrap();
    let json = bench.json("out/summary.json");
    let stroke = &json["metrics"][0];
    assert_eq!(
        (&stroke["rss"], &stroke["nonlinearity"]),
        (&0.0.into(), &serde_json::Value::Null),
        "{stroke}"
    );
    assert!(stroke["nonlinear"].as_str().unwrap().starts_with("sigma has no first-order part"), "{stroke}");
    let row = text.lines().find(|l| l.trim_start().starts_with("stroke")).unwrap();
    assert!(row.contains("no RSS") && !text.contains("not known"), "{text}");
    assert!(share(stroke, "e") > 0.999 && !text.contains("interactions"), "{text}");
}

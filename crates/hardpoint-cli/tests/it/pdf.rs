//! Texts and curves of `report.pdf`.

use serde_json::Value;

use crate::bench::Bench;

/// Blue, in which curves are drawn.
const CURVE: &str = "0.02 0.37 0.73 RG";
/// Tolerance of positions on paper: single precision at some 100 points.
const ON_PAPER: f64 = 1e-5;

fn document(bench: &Bench, name: &str) -> String {
    let bytes = std::fs::read(bench.path(name)).unwrap();
    assert!(bytes.starts_with(b"%PDF-1.") && bytes.trim_ascii_end().ends_with(b"%%EOF"));
    bytes.into_iter().map(char::from).collect()
}

/// All texts of the pages.
fn texts(document: &str) -> Vec<String> {
    let texts = document.lines().filter_map(|line| line.trim().strip_suffix(" Tj"));
    let text = |shown: &str| {
        shown.trim_start_matches('(').trim_end_matches(')').replace("\\(", "(").replace("\\)", ")")
    };
    texts.map(text).collect()
}

/// Points of each curve.
fn curves(document: &str) -> Vec<Vec<[f64; 2]>> {
    let drawn = document.split(CURVE).skip(1);
    let point = |line: &str| {
        let numbers = line.trim().strip_suffix(" l")?;
        let mut numbers = numbers.split(' ').map(|x| x.parse().unwrap());
        Some([numbers.next()?, numbers.next()?])
    };
    drawn.map(|path| path.lines().take_while(|line| line.trim() != "S").filter_map(point).collect()).collect()
}

/// Values scaled to the range from 0 to 1.
fn normalised(values: impl Iterator<Item = f64> + Clone) -> Vec<f64> {
    let (low, high) = (values.clone().fold(f64::MAX, f64::min), values.clone().fold(f64::MIN, f64::max));
    values.map(|v| (v - low) / (high - low)).collect()
}

#[test]
fn the_pages_describe_the_run_and_draw_every_measure() {
    let bench = Bench::with(&["slider.toml"]);
    let output = bench.run(&["run", "slider.toml", "-o", "out", "--pdf"]);
    assert!(output.status.success());
    let document = document(&bench, "out/report.pdf");
    let texts = texts(&document);
    let has = |text: &str| assert!(texts.iter().any(|s| s == text), "{text} is not among {texts:?}");
    let summary: Value = serde_json::from_str(&bench.text("out/summary.json")).unwrap();
    has(summary["model"]["name"].as_str().unwrap());
    has("mm, deg, s");
    for metric in summary["metrics"].as_array().unwrap() {
        has(metric["name"].as_str().unwrap());
    }
    for variable in summary["model"]["variables"].as_array().unwrap() {
        has(variable["name"].as_str().unwrap());
    }
    // The most influential variable of the first ranked measure, with its sensitivity.
    let mut rankings = summary["sensitivities"].as_array().unwrap().iter();
    let first = rankings
        .find(|r| r["order"] == "value" && r["largest"].as_array().is_some_and(|list| !list.is_empty()));
    let ranking = &first.unwrap()["largest"][0];
    let shown = hardpoint_report::figures::with_unit(
        ranking["value"].as_f64().unwrap(),
        ranking["unit"].as_str().unwrap(),
    );
    has(&shown);

    let mut table = csv::Reader::from_reader(bench.text("out/motion.csv").into_bytes().leak() as &[u8]);
    let headers = table.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let measures = summary["model"]["measures"].as_array().unwrap();
    let curves = curves(&document);
    assert_eq!(curves.len(), measures.len());
    for (measure, curve) in measures.iter().zip(&curves) {
        let name = measure["name"].as_str().unwrap();
        has(name);
        let column = headers.iter().position(|h| h == name || h.starts_with(&format!("{name} ["))).unwrap();
        // The unit is next to the axis.
        has(headers[column].strip_prefix(name).unwrap().trim());
        let number = |column: usize| rows.iter().map(move |row| row[column].parse::<f64>().unwrap());
        for (drawn, solved) in [
            (normalised(curve.iter().map(|p| p[0])), normalised(number(0))),
            (normalised(curve.iter().map(|p| p[1])), normalised(number(column))),
        ] {
            assert_eq!(drawn.len(), solved.len(), "{name}");
            assert!(
                drawn.iter().zip(&solved).all(|(a, b)| (a - b).abs() < ON_PAPER),
                "{name}: {drawn:?} {solved:?}"
            );
        }
    }
    // A run without the option removes the file of an earlier run.
    assert!(bench.run(&["run", "slider.toml", "-o", "out"]).status.success());
    assert!(!bench.list("out").contains(&"report.pdf".to_owned()));
}

#[test]
fn the_parts_that_are_chosen_are_written_with_the_named_designs() {
    let bench = Bench::with(&["slider.toml"]);
    let more =
        "[metrics]\nway = { of = \"stroke\", take = \"range\" }\n\n[designs.longer]\ncrank_pin_x = 2\n";
    bench.put("slider.toml", &format!("{}\n{more}", bench.text("slider.toml")));
    let parts = "metrics,hardpoints";
    assert!(bench.run(&["run", "slider.toml", "-o", "some", "--pdf-parts", parts]).status.success());
    let document = document(&bench, "some/report.pdf");
    let texts = texts(&document);
    let has = |text: &str| texts.iter().any(|s| s == text);
    assert!(has("Key figures by design") && has("Hardpoints of longer") && has("longer"), "{texts:?}");
    assert!(!has("Curves") && !has("Most influential variables") && !has("Design variables"));
    assert!(curves(&document).is_empty());
    // old, new and change of the moved coordinate
    let at = texts.iter().position(|s| s == "Hardpoints of longer").unwrap();
    let numbers: Vec<f64> = texts[at + 6..at + 9].iter().map(|s| s.parse().unwrap()).collect();
    assert!(
        (numbers[1] - numbers[0] - 2.0).abs() < ON_PAPER && (numbers[2] - 2.0).abs() < ON_PAPER,
        "{numbers:?}"
    );
    // The metrics of the design are those that the command compares.
    let whatif = ["whatif", "slider.toml", "--design", "longer", "--json"];
    let changed: Value = serde_json::from_slice(&bench.run(&whatif).stdout).unwrap();
    for metric in changed["metrics"].as_array().unwrap() {
        let (value, unit) = (metric["exact"].as_f64().unwrap(), metric["unit"].as_str().unwrap());
        let shown = hardpoint_report::figures::with_unit(value, unit);
        assert!(has(&shown), "{shown} is not among {texts:?}");
    }

    let wrong = bench.run(&["run", "slider.toml", "-o", "some", "--pdf-parts", "pictures"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&wrong.stderr).contains("`picture`"));
}

#[test]
fn letters_that_the_font_lacks_are_reported() {
    let bench = Bench::with(&["slider.toml"]);
    let text = bench.text("slider.toml");
    let name = text.lines().find(|line| line.starts_with("name = ")).unwrap();
    bench.put("slider.toml", &text.replace(name, "name = \"\u{447}\""));
    assert!(bench.run(&["run", "slider.toml", "-o", "out", "--pdf"]).status.success());
    let texts = texts(&document(&bench, "out/report.pdf"));
    assert!(texts.iter().any(|s| s.contains("? replaces letters that the font lacks")), "{texts:?}");
}

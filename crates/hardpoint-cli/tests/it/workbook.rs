//! `motion.xlsx` as a spreadsheet program opens it.

use std::io::Read;

use calamine::{Data, DataType, Range, Reader, Xlsx};

use crate::bench::Bench;

fn open(bench: &Bench, name: &str) -> Xlsx<std::io::BufReader<std::fs::File>> {
    calamine::open_workbook(bench.path(name)).unwrap()
}

fn sheet(bench: &Bench, name: &str, sheet: &str) -> Range<Data> {
    open(bench, name).worksheet_range(sheet).unwrap()
}

/// All cells of a sheet as text.
fn texts(sheet: &Range<Data>) -> String {
    sheet.rows().map(|row| row.iter().map(|c| format!("{c} ")).collect::<String>() + "\n").collect()
}

/// Column under a header; empty cells are NaN.
fn column(sheet: &Range<Data>, header: &str) -> Vec<f64> {
    let mut rows = sheet.rows();
    let headers = rows.next().unwrap();
    let at = headers.iter().position(|c| *c == Data::String(header.into()));
    let at = at.unwrap_or_else(|| panic!("{header} is not among {headers:?}"));
    rows.map(|row| if row[at].is_empty() { f64::NAN } else { row[at].as_f64().unwrap() }).collect()
}

/// Rows of a CSV file by header.
fn csv_columns(text: &str) -> Vec<(String, Vec<String>)> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let mut columns: Vec<(String, Vec<String>)> =
        reader.headers().unwrap().iter().map(|h| (h.to_owned(), Vec::new())).collect();
    for row in reader.records() {
        columns.iter_mut().zip(row.unwrap().iter()).for_each(|((_, list), cell)| list.push(cell.to_owned()));
    }
    columns
}

fn same(cells: &[f64], csv: &[String]) {
    assert_eq!(cells.len(), csv.len());
    for (x, text) in cells.iter().zip(csv) {
        assert!(if text.is_empty() { x.is_nan() } else { *x == text.parse::<f64>().unwrap() }, "{x} {text}");
    }
}

#[test]
fn a_workbook_holds_the_numbers_of_the_tables_to_the_last_digit() {
    let bench = Bench::with(&["slider.toml"]);
    let output = bench.run(&["run", "slider.toml", "-o", "out", "--workbook", "--bodies", "--json"]);
    assert!(output.status.success());
    let mut book = open(&bench, "out/motion.xlsx");
    let names = ["About", "Motion", "Charts", "Largest sensitivities", "Sensitivities", "Hardpoints"];
    assert_eq!(book.sheet_names(), names);
    let motion = book.worksheet_range("Motion").unwrap();
    let (mut compared, mut bodies) = (0, 0);
    for (header, cells) in csv_columns(&bench.text("out/motion.csv")) {
        if ["crank.", "rod.", "slider."].iter().any(|body| header.starts_with(body)) {
            bodies += 1;
            continue;
        }
        same(&column(&motion, &header), &cells);
        compared += 1;
    }
    assert_eq!((compared, motion.width(), bodies), (16, 16, 57));

    let table = csv_columns(&bench.text("out/sensitivity.csv"));
    let of = |header: &str| &table.iter().find(|(h, _)| h == header).unwrap().1;
    let sensitivities = book.worksheet_range("Sensitivities").unwrap();
    for (measure, unit) in [("angle", "deg"), ("stroke", "mm")] {
        for (variable, per) in [("crank_pin_x", "mm"), ("guide_turn", "deg")] {
            let rows = of("variable").iter().zip(of(&format!("d {measure} [{unit}]")));
            let cells: Vec<String> =
                rows.filter(|(v, _)| *v == variable).map(|(_, cell)| cell.clone()).collect();
            same(&column(&sensitivities, &format!("d {measure} / d {variable} [{unit}/{per}]")), &cells);
        }
    }
    // The inadmissible variable has no columns.
    assert_eq!(sensitivities.width(), 5);

    // The largest sensitivities are those of the summary.
    let summary = bench.json("out/summary.json");
    let largest = book.worksheet_range("Largest sensitivities").unwrap();
    let first = &summary["sensitivities"]
        .as_array()
        .unwrap()
        .iter()
        .find(|r| !r["largest"].as_array().unwrap().is_empty());
    let first = first.unwrap();
    assert_eq!(largest.get((1, 0)).unwrap().to_string(), first["measure"].as_str().unwrap());
    assert_eq!(
        largest.get((1, 3)).unwrap().as_f64().unwrap(),
        first["largest"][0]["value"].as_f64().unwrap()
    );
    let hardpoints = book.worksheet_range("Hardpoints").unwrap();
    assert_eq!(column(&hardpoints, "x [mm]"), [0.0, 30.0, 150.0]);
    let about = texts(&book.worksheet_range("About").unwrap());
    for fact in [
        "slider-crank for tests",
        "mm, deg, s",
        "41 of 41, t = 0 to 1 s",
        "crank_pin_x 0 mm",
        "cannot follow",
    ] {
        assert!(about.contains(fact), "{fact}: {about}");
    }
    let files = summary["files"].as_array().unwrap();
    assert!(files.iter().any(|f| f.as_str().unwrap().ends_with("motion.xlsx")), "{files:?}");
    // Files that the next run does not write are removed.
    assert!(bench.run(&["run", "slider.toml", "-o", "out"]).status.success());
    assert!(!bench.list("out").contains(&"motion.xlsx".into()));
}

#[test]
fn every_measure_has_a_chart_of_its_column() {
    let bench = Bench::with(&["slider.toml"]);
    assert!(bench.run(&["run", "slider.toml", "-o", "out", "--workbook"]).status.success());
    let mut zip = zip::ZipArchive::new(std::fs::File::open(bench.path("out/motion.xlsx")).unwrap()).unwrap();
    for (chart, column) in [("chart1", "B"), ("chart2", "E")] {
        let mut text = String::new();
        zip.by_name(&format!("xl/charts/{chart}.xml")).unwrap().read_to_string(&mut text).unwrap();
        assert!(text.contains("<c:f>Motion!$A$2:$A$42</c:f>"), "{text}");
        assert!(text.contains(&format!("<c:f>Motion!${column}$2:${column}$42</c:f>")), "{text}");
    }
    assert!(zip.by_name("xl/charts/chart3.xml").is_err());
    let mut text = String::new();
    zip.by_name("xl/worksheets/sheet2.xml").unwrap().read_to_string(&mut text).unwrap();
    assert!(text.contains(r#"state="frozen""#), "the header stays");
}

#[test]
fn the_workbook_of_a_stopped_motion_has_the_reason() {
    let bench = Bench::with(&["short_rod.toml"]);
    let output = bench.run(&["run", "short_rod.toml", "-o", "out", "--workbook"]);
    assert_eq!(output.status.code(), Some(5));
    let about = texts(&sheet(&bench, "out/motion.xlsx", "About"));
    assert!(about.contains("8 of 101") && about.contains("early, HP0401: "), "{about}");
    assert_eq!(sheet(&bench, "out/motion.xlsx", "Motion").height(), 9);
}

#[test]
fn a_workbook_without_measures_has_the_bodies_and_names_are_no_formulas() {
    let bench = Bench::with(&["slider.toml"]);
    let text = bench.text("slider.toml").replace("rod = {}", "\"=1+1\" = {}").replace("\"rod\"", "\"=1+1\"");
    let (before, _) = text.split_once("[points]").unwrap();
    let (_, after) = text.split_once("[time]").unwrap();
    bench.put("bare.toml", &format!("{before}[time]{after}"));
    let output = bench.run(&["run", "bare.toml", "-o", "out", "--workbook", "--no-sensitivities"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(open(&bench, "out/motion.xlsx").sheet_names(), ["About", "Motion", "Charts", "Hardpoints"]);
    let motion = sheet(&bench, "out/motion.xlsx", "Motion");
    assert_eq!(motion.width(), 1 + 3 * 19);
    assert_eq!(column(&motion, "=1+1.x [mm]").len(), 41);
}

#[test]
fn data_that_do_not_fit_into_a_workbook_are_listed() {
    const STEPS: usize = 70_000;
    let bench = Bench::with(&["slider.toml"]);
    bench.put("long.toml", &bench.text("slider.toml").replace("steps = 40", &format!("steps = {STEPS}")));
    let asked = [
        "run",
        "long.toml",
        "-o",
        "out",
        "--workbook",
        "--format",
        "npy",
        "--no-sensitivities",
        "--no-compare",
    ];
    assert!(bench.run(&asked).status.success());
    let times = column(&sheet(&bench, "out/motion.xlsx", "Motion"), "t [s]");
    let every = STEPS.div_ceil(times.len() - 1);
    assert!(every > 1);
    assert_eq!(times[1], every as f64 / STEPS as f64);
    let note = format!("sheet `Motion`: only one output time in {every} is here; `motion.npy` has all");
    let about = texts(&sheet(&bench, "out/motion.xlsx", "About"));
    assert!(about.contains(&note), "{about}");
    let left_out = bench.json("out/summary.json")["left_out"].to_string();
    assert!(left_out.contains(&note), "{left_out}");
}

#[test]
fn every_case_has_a_workbook() {
    let bench = Bench::with(&["slider.toml"]);
    let cases = "\n[cases.slow]\nlaws = { motor = \"10*sin(2*pi*t)\" }\n[cases.fast]\nlaws = { motor = \"20*sin(2*pi*t)\" }\n";
    bench.put("cases.toml", &(bench.text("slider.toml") + cases));
    let output = bench.run(&["run", "cases.toml", "-o", "out", "--workbook"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for case in ["slow", "fast"] {
        let about = texts(&sheet(&bench, &format!("out/{case}/motion.xlsx"), "About"));
        assert!(about.contains(&format!("case {case}")), "{about}");
    }
}

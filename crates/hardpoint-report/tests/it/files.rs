//! Written files agree with the solution, number by number, through units converted by hand.

use std::f64::consts::PI;

use hardpoint::model::{BodyId, VariableId};
use hardpoint::sensitivity::BodySensitivity;
use hardpoint::space::Angles;
use hardpoint::{Analysis, Solution};
use hardpoint_file::ModelFile;
use hardpoint_report::columns::Columns;
use hardpoint_report::course::Course;
use hardpoint_report::facts::{Facts, VariableAdmissibility};
use hardpoint_report::page;
use hardpoint_report::payload::{Request, payload};
use hardpoint_report::results::{MotionCsv, SensitivityCsv};
use hardpoint_report::summary::Summary;
use hardpoint_study::difference::{DifferenceScheme, finite_differences};
use serde_json::Value;

const SLIDER: &str = include_str!("../../../hardpoint-cli/tests/models/slider.toml");
const DEGREES: f64 = 180.0 / PI;

fn file() -> ModelFile {
    hardpoint_file::parse(SLIDER, "models/slider.toml").unwrap()
}

fn all(file: &ModelFile) -> Columns<'_> {
    Columns { model: &file.model, units: file.units, bodies: true, angles: None }
}

struct Csv {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Csv {
    fn read(bytes: &[u8]) -> Self {
        let mut reader = csv::Reader::from_reader(bytes);
        let text = |r: &csv::StringRecord| r.iter().map(String::from).collect::<Vec<_>>();
        let header = text(reader.headers().unwrap());
        Self { header, rows: reader.records().map(|r| text(&r.unwrap())).collect() }
    }

    fn text(&self, row: usize, column: &str) -> &str {
        let c = self.header.iter().position(|h| h == column);
        &self.rows[row][c.unwrap_or_else(|| panic!("no column {column:?} in {:?}", self.header))]
    }

    fn number(&self, row: usize, column: &str) -> f64 {
        self.text(row, column).parse().unwrap()
    }
}

#[track_caller]
fn assert_same(found: f64, expected: f64) {
    // One rounding per conversion.
    assert!((found - expected).abs() <= 4.0 * f64::EPSILON * expected.abs(), "{found:e} is not {expected:e}");
}

#[test]
fn motion_file_holds_every_number_in_the_units_of_its_header() {
    let file = file();
    let solution = Analysis::new(&file.model).unwrap().run();
    let mut table = MotionCsv::new(all(&file), Vec::new()).unwrap();
    table.add(&solution).unwrap();
    let bytes = table.end().unwrap();
    let csv = Csv::read(&bytes);
    let outputs = solution.measured.outputs.len();
    assert_eq!(csv.rows.len(), 41);
    assert_eq!(csv.header.len(), 1 + 3 * 19 + 3 * outputs);
    let rod = file.model.body("rod").unwrap();
    let (stroke, angle) =
        (solution.measured.index("stroke").unwrap(), solution.measured.index("angle").unwrap());
    let tip_y = solution.measured.index("tip.y").unwrap();
    for k in 0..41 {
        let s = solution.body(k, rod);
        assert_same(csv.number(k, "t [s]"), solution.motion.times[k]);
        assert_same(csv.number(k, "rod.x [mm]"), s.r.x * 1e3);
        assert_same(csv.number(k, "rod.qz"), s.quaternion()[3]);
        assert_same(csv.number(k, "rod.vy [mm/s]"), s.v.y * 1e3);
        assert_same(csv.number(k, "rod.omega_z [deg/s]"), s.omega.z * DEGREES);
        assert_same(csv.number(k, "rod.ax [mm/s^2]"), s.a.x * 1e3);
        assert_same(csv.number(k, "rod.alpha_z [deg/s^2]"), s.alpha.z * DEGREES);
        assert_same(csv.number(k, "stroke rate [mm/s]"), solution.measured.value(k, stroke)[1] * 1e3);
        assert_same(csv.number(k, "tip.vy [mm/s]"), solution.measured.value(k, tip_y)[1] * 1e3);
        assert_same(csv.number(k, "tip.ay [mm/s^2]"), solution.measured.value(k, tip_y)[2] * 1e3);
        assert_same(csv.number(k, "angle [deg]"), solution.measured.value(k, angle)[0] * DEGREES);
        let law = 40.0 * (2.0 * PI * solution.motion.times[k]).sin();
        assert!((csv.number(k, "angle [deg]") - law).abs() < 1e-12);
    }
}

#[test]
fn angles_beside_the_quaternions_turn_every_body_to_where_it_is() {
    let file = hardpoint_file::parse(include_str!("../../../../models/hooke.toml"), "hooke.toml").unwrap();
    let solution = Analysis::new(&file.model).unwrap().run();
    for (kind, names) in [
        (Angles::Euler, ["euler_1", "euler_2", "euler_3"]),
        (Angles::Cardan, ["cardan_1", "cardan_2", "cardan_3"]),
        (Angles::RollPitchYaw, ["roll", "pitch", "yaw"]),
    ] {
        let mut table = MotionCsv::new(Columns { angles: Some(kind), ..all(&file) }, Vec::new()).unwrap();
        table.add(&solution).unwrap();
        let csv = Csv::read(&table.end().unwrap());
        let mut known = 0;
        for (b, body) in file.model.bodies.iter().enumerate().skip(1) {
            for k in 0..csv.rows.len() {
                let columns = names.map(|name| format!("{}.{name} [deg]", body.name));
                let rotation = solution.body(k, BodyId(b)).rotation;
                // At gimbal lock there is no value.
                if kind.of(rotation)[0].is_nan() {
                    assert!(columns.iter().all(|c| csv.text(k, c).is_empty()), "{kind:?} {}", body.name);
                    continue;
                }
                known += 1;
                let found = kind.rotation(columns.map(|c| csv.number(k, &c) / DEGREES));
                for axis in 0..3 {
                    assert!(
                        (found.cols[axis] - rotation.cols[axis]).norm() < 1e-12,
                        "{kind:?} {}",
                        body.name
                    );
                }
            }
        }
        assert!(known > csv.rows.len(), "{kind:?}: {known}");
    }
}

#[test]
fn sensitivity_file_converts_numerator_and_denominator() {
    let file = file();
    let solution = Analysis::new(&file.model).unwrap().run();
    let mut table = SensitivityCsv::new(all(&file), Vec::new()).unwrap();
    table.add(&solution).unwrap();
    let bytes = table.end().unwrap();
    let csv = Csv::read(&bytes);
    let slider = file.model.body("slider").unwrap();
    let stroke = solution.measured.index("stroke").unwrap();
    // `guide_jam` cannot be followed and has no rows.
    assert_eq!(csv.rows.len(), 41 * 2);
    for (row, _) in csv.rows.iter().enumerate() {
        let (k, b) = (row / 2, row % 2);
        let d: &BodySensitivity = &solution.sensitivities.at(k, b).unwrap().body(slider.0);
        let output = solution.measured.d(k, VariableId(b), stroke);
        assert_eq!(csv.text(row, "variable"), ["crank_pin_x", "guide_turn"][b]);
        assert_eq!(csv.text(row, "per"), ["mm", "deg"][b]);
        // Per mm: lengths as they are, angles in deg/mm. Per deg: lengths in mm/deg, angles as they are.
        let (length, angle) = [(1.0, DEGREES / 1e3), (1e3 / DEGREES, 1.0)][b];
        assert_same(csv.number(row, "d slider.x [mm]"), d.dr.x * length);
        assert_same(csv.number(row, "d slider.pi_z [deg]"), d.dpi.z * angle);
        assert_same(csv.number(row, "d slider.vx [mm/s]"), d.dv.x * length);
        assert_same(csv.number(row, "d slider.omega_z [deg/s]"), d.domega.z * angle);
        assert_same(csv.number(row, "d slider.ax [mm/s^2]"), d.da.x * length);
        assert_same(csv.number(row, "d stroke acceleration [mm/s^2]"), output[2] * length);
    }
    assert!(csv.number(2 * 10, "d stroke [mm]").abs() > 0.1, "the comparison is not of zeros");
}

fn solved(file: &ModelFile) -> (Analysis<'_>, Solution, Summary) {
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let summary = Summary::new(file, &analysis, &Course::of(&file.model, &solution));
    (analysis, solution, summary)
}

#[test]
fn facts_tell_the_three_answers_apart() {
    let file = file();
    let (_, _, summary) = solved(&file);
    let facts = &summary.model;
    let admissibility: Vec<VariableAdmissibility> = facts.variables.iter().map(|v| v.answer).collect();
    assert_eq!(
        admissibility,
        [
            VariableAdmissibility::Admissible,
            VariableAdmissibility::Admissible,
            VariableAdmissibility::CannotFollow
        ]
    );
    let jam = &facts.variables[2];
    assert!(jam.opens_at_design.is_empty(), "it closes at the design configuration, and nowhere else");
    assert_eq!((jam.resists[0].joint.as_str(), jam.resists[0].unit.as_str()), ("wrist", "mm/deg"));
    assert_eq!(facts.counts.redundant_constraints, 3);
    // Without a solution nothing is claimed about the motion.
    let analysis = Analysis::new(&file.model).unwrap();
    let unsolved = Facts::new(&file, &analysis, None);
    assert_eq!(unsolved.count_admissibility(VariableAdmissibility::Unknown), 3);
}

#[test]
fn a_rod_that_keeps_its_length_is_reassembled() {
    let text = include_str!("../../../../models/rssr.toml");
    let file = hardpoint_file::parse(text, "rssr.toml").unwrap();
    let (_, _, summary) = solved(&file);
    let of = |name: &str| summary.model.variables.iter().find(|v| v.name == name).unwrap();
    assert_eq!(of("A_x").answer, VariableAdmissibility::Admissible);
    let kept = of("A_x_fixed_length");
    assert_eq!(kept.answer, VariableAdmissibility::Reassembled);
    assert_eq!(kept.opens_at_design[0].joint, "coupler");
    assert_eq!(kept.opens_at_design[0].unit, "mm/mm");
    assert!(kept.change.ends_with("rods keep their lengths"));
}

#[test]
fn summary_ranks_by_magnitude_and_leaves_out_round_off() {
    let file = file();
    let (_, solution, summary) = solved(&file);
    let json: Value = serde_json::to_value(&summary).unwrap();
    assert_eq!(json["status"], "complete");
    assert_eq!(json["model"]["units"]["length"], "mm");
    assert_eq!(json["steps"]["solved"], 41);
    let of = |measure: &str| {
        let list = json["sensitivities"].as_array().unwrap();
        list.iter().find(|r| r["measure"] == measure && r["order"] == "value").unwrap()["largest"].clone()
    };
    // The shaft is driven: no design moves its angle.
    assert_eq!(of("angle"), Value::Array(vec![]));
    let stroke = of("stroke");
    let m = solution.measured.index("stroke").unwrap();
    let largest =
        (0..41).map(|k| solution.measured.d(k, VariableId(1), m)[0]).fold(0.0_f64, |a, d| a.max(d.abs()));
    assert_eq!(
        (&stroke[1]["variable"], &stroke[1]["unit"]),
        (&Value::from("guide_turn"), &Value::from("mm/deg"))
    );
    assert_same(stroke[1]["value"].as_f64().unwrap().abs(), largest * 1e3 / DEGREES);
}

#[test]
fn page_holds_all_quantities_and_their_comparison() {
    let file = file();
    let (analysis, solution, summary) = solved(&file);
    let steps: Vec<(VariableId, f64)> =
        [0, 1].map(|b| (VariableId(b), 1e-4 * file.model.natural_step(VariableId(b)))).to_vec();
    let mut differences: Vec<_> = finite_differences(&analysis, &solution, DifferenceScheme::Central, &steps)
        .into_iter()
        .map(Result::ok)
        .collect();
    differences.push(None);
    let course = Course::of(&file.model, &solution);
    let payload =
        payload(&Request { differences: &differences, ..Request::of(&file, &analysis, &course, &summary) });
    // 2 measures, 1 point, 3 bodies.
    assert_eq!(payload.quantities.len(), 2 + 3 + 9);
    assert_eq!(payload.file, "slider.toml", "no folders of this machine");
    let [x, _, jam] = &payload.variables[..] else { panic!("three variables") };
    assert_eq!((x.sensitivities.len(), jam.sensitivities.len()), (14, 0));
    assert!(jam.note.contains("`wrist`"), "{}", jam.note);
    for s in &x.sensitivities {
        let fd = s.fd.as_ref().unwrap();
        assert!(
            fd.worst.iter().all(|w| *w < 1e-5),
            "{}: {:?}",
            payload.quantities[s.quantity].name,
            fd.worst
        );
        assert_eq!(fd.step_unit, "mm");
    }
    // Both markers of the pin move along x by 1 mm per mm.
    assert_eq!(x.arrows.len(), 2);
    assert!(x.arrows.iter().all(|a| (a.v[0] - 1.0).abs() < 1e-12 && a.turn == [0.0; 3]));
    assert_eq!(payload.bodies[2].labels, ["B", "C", "tip"]);
    assert!(page::html(&payload).unwrap().contains("slider-crank for tests"));
}

/// The columns that `docs/results.md` lists for a file, with their units, names filled in.
fn documented(file: &ModelFile, table: &str) -> Vec<(String, String)> {
    let text = include_str!("../../../../docs/results.md");
    let (_, after) =
        text.split_once(&format!("<!-- columns of {table} -->\n\n")).expect("a table in the page");
    let rows = after.lines().take_while(|line| line.starts_with('|')).skip(2);
    let mut groups: Vec<(&str, Vec<(String, String)>)> = Vec::new();
    for row in rows {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let names: Vec<&str> = cells[0].split(", ").map(|name| name.trim_matches('`')).collect();
        let units: Vec<&str> = cells[2].split(", ").collect();
        let kind =
            ["BODY", "MEASURE", "POINT"].into_iter().find(|kind| names[0].contains(kind)).unwrap_or("");
        if groups.last().is_none_or(|(last, _)| *last != kind) {
            groups.push((kind, Vec::new()));
        }
        let columns =
            names.iter().enumerate().map(|(k, n)| (n.to_string(), units[k.min(units.len() - 1)].into()));
        groups.last_mut().unwrap().1.extend(columns);
    }
    let (model, mut columns) = (&file.model, Vec::new());
    for (kind, list) in groups {
        let names: Vec<&str> = match kind {
            "BODY" => model.bodies[1..].iter().map(|b| b.name.as_str()).collect(),
            "MEASURE" => model.measures.iter().map(|m| m.name.as_str()).collect(),
            "POINT" => model.points.iter().map(|p| p.name.as_str()).collect(),
            _ => vec![""],
        };
        for (name, column) in names.iter().flat_map(|n| list.iter().map(move |c| (n, c))) {
            let own = if kind == "MEASURE" { [("stroke", "mm"), ("angle", "deg")] } else { [("", ""); 2] };
            let own = own.iter().find(|(n, _)| n == name).map_or("", |(_, unit)| unit);
            let unit = column.1.replace("length", "mm").replace("angle", "deg").replace("its own", own);
            columns
                .push((if kind.is_empty() { column.0.clone() } else { column.0.replace(kind, name) }, unit));
        }
    }
    columns
}

#[test]
fn every_column_is_documented_in_its_order() {
    let file = file();
    let all = all(&file);
    let tables = [
        ("motion.csv", 1, all.of_motion()),
        ("sensitivity.csv", 3, all.of_sensitivities()),
        ("jerk.csv", 1, all.of_jerk()),
    ];
    for (name, first, columns) in tables {
        let written: Vec<(String, String)> = columns.into_iter().map(|c| (c.name, c.unit)).collect();
        let documented = documented(&file, name);
        assert_eq!(written, documented[first..], "{name}");
    }
}

#[test]
fn every_key_of_the_summary_is_documented() {
    let file = file();
    let (_, _, summary) = solved(&file);
    let text = include_str!("../../../../docs/results.md");
    let (_, after) = text.split_once("## summary.json").unwrap();
    let (table, _) = after.split_once("## ").unwrap();
    let documented: Vec<&str> =
        table.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next()).collect();
    let Value::Object(json) = serde_json::to_value(&summary).unwrap() else { panic!("an object") };
    let mut written: Vec<&str> = json.keys().map(String::as_str).collect();
    let mut sorted = documented.clone();
    sorted.sort_unstable();
    written.sort_unstable();
    assert_eq!(written, sorted);
}

//! What is written agrees with what was solved, number by number, through units converted by hand.

use std::f64::consts::PI;

use hardpoint::model::VariableId;
use hardpoint::sensitivity::BodySensitivity;
use hardpoint::study::{Scheme, finite_differences, natural_step};
use hardpoint::{Analysis, Solution};
use hardpoint_file::ModelFile;
use hardpoint_report::facts::{Answer, Facts};
use hardpoint_report::payload::payload;
use hardpoint_report::summary::Summary;
use hardpoint_report::{csv as tables, page};
use serde_json::Value;

const SLIDER: &str = include_str!("../../hardpoint-cli/tests/models/slider.toml");
const DEGREES: f64 = 180.0 / PI;

fn file() -> ModelFile {
    hardpoint_file::parse(SLIDER, "models/slider.toml").unwrap()
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
    let mut bytes = Vec::new();
    tables::write_motion(&file.model, file.units, &solution, &mut bytes).unwrap();
    let csv = Csv::read(&bytes);
    let outputs = solution.measured.outputs.len();
    assert_eq!(csv.rows.len(), 41);
    assert_eq!(csv.header.len(), 1 + 3 * 19 + 3 * outputs);
    let rod = file.model.body("rod").unwrap();
    let (stroke, angle) =
        (solution.measured.index("stroke").unwrap(), solution.measured.index("angle").unwrap());
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
        assert_same(csv.number(k, "angle [deg]"), solution.measured.value(k, angle)[0] * DEGREES);
        let law = 40.0 * (2.0 * PI * solution.motion.times[k]).sin();
        assert!((csv.number(k, "angle [deg]") - law).abs() < 1e-12);
    }
}

#[test]
fn sensitivity_file_converts_numerator_and_denominator() {
    let file = file();
    let solution = Analysis::new(&file.model).unwrap().run();
    let mut bytes = Vec::new();
    tables::write_sensitivity(&file.model, file.units, &solution, &mut bytes).unwrap();
    let csv = Csv::read(&bytes);
    let slider = file.model.body("slider").unwrap();
    let stroke = solution.measured.index("stroke").unwrap();
    // `guide_jam` cannot be followed and has no rows.
    assert_eq!(csv.rows.len(), 41 * 2);
    for (row, _) in csv.rows.iter().enumerate() {
        let (k, b) = (row / 2, row % 2);
        let d: &BodySensitivity = &solution.sensitivities.at(k, b).unwrap()[slider.0];
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
    let facts = Facts::new(file, analysis.topology(), Some(&solution));
    let summary = Summary::new(file, analysis.topology(), facts, &solution);
    (analysis, solution, summary)
}

#[test]
fn facts_tell_the_three_answers_apart() {
    let file = file();
    let (_, _, summary) = solved(&file);
    let facts = &summary.model;
    let answers: Vec<Answer> = facts.variables.iter().map(|v| v.answer).collect();
    assert_eq!(answers, [Answer::Admissible, Answer::Admissible, Answer::CannotFollow]);
    let jam = &facts.variables[2];
    assert!(jam.opens_at_design.is_empty(), "it closes at the design configuration, and nowhere else");
    assert_eq!((jam.resists[0].joint.as_str(), jam.resists[0].unit.as_str()), ("wrist", "mm/deg"));
    assert_eq!(facts.counts.redundant_constraints, 3);
    // Without a solution nothing is claimed about the motion.
    let analysis = Analysis::new(&file.model).unwrap();
    let unsolved = Facts::new(&file, analysis.topology(), None);
    assert_eq!(unsolved.answers(Answer::Unknown), 3);
}

#[test]
fn a_rod_that_keeps_its_length_is_reassembled() {
    let text = include_str!("../../../models/rssr.toml");
    let file = hardpoint_file::parse(text, "rssr.toml").unwrap();
    let (_, _, summary) = solved(&file);
    let of = |name: &str| summary.model.variables.iter().find(|v| v.name == name).unwrap();
    assert_eq!(of("A_x").answer, Answer::Admissible);
    let kept = of("A_x_fixed_length");
    assert_eq!(kept.answer, Answer::Reassembled);
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
        [0, 1].map(|b| (VariableId(b), 1e-4 * natural_step(&file.model, VariableId(b)))).to_vec();
    let mut found: Vec<_> = finite_differences(&analysis, &solution, Scheme::Central, &steps)
        .into_iter()
        .map(Result::ok)
        .collect();
    found.push(None);
    let payload = payload(&file, &analysis, &solution, &found, &summary);
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

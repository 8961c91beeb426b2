//! Reversed drivers: everything that takes or reports values of drivers counts them like their laws, against closed
//! forms of the coordinates, which move in the opposite sense.

use hardpoint::Analysis;
use hardpoint::Run;
use hardpoint::model::{CaseId, Model};
use hardpoint::motion::StopKind;
use hardpoint::topology::Formulation;
use hardpoint_file::parse;
use hardpoint_study::grid::GridMap;
use hardpoint_study::map::{ErrorScope, Interpolation, Overrides, Request, solve};
use hardpoint_study::{calibrate, position_model};

use crate::calibrations::CRANK;

/// Round-off of a solved position, m, and of its derivatives, m per rad.
const EXACT: f64 = 1e-12;
/// Radius of the crank, m.
const RADIUS: f64 = 0.1;
/// Offset of the slide, m.
const OFFSET: f64 = 0.02;

fn model(text: &str) -> Model {
    parse(text, "reversed.toml").unwrap_or_else(|e| panic!("{e}")).model
}

/// The slider-crank with its motor reversed.
fn reversed() -> String {
    let text = CRANK.replace("law = \"20*t\"", "law = \"20*t\", reversed = true");
    assert_ne!(text, CRANK);
    text
}

/// Place of the slider, m, and its derivative by the driver's value, for values of the reversed motor, rad.
fn place(rod: f64, value: f64) -> [f64; 2] {
    let (sin, cos) = (40_f64.to_radians() - value).sin_cos();
    let across = RADIUS * sin - OFFSET;
    let along = (rod * rod - across * across).sqrt();
    // d/d value = -d/d angle
    [RADIUS * cos + along, RADIUS * sin + across * RADIUS * cos / along]
}

#[test]
fn a_position_and_its_derivative_by_a_reversed_driver_are_those_of_its_laws() {
    let model = model(&reversed());
    let position = position_model(&model, &[]);
    let analysis = Analysis::new(&position).unwrap();
    let motor = position.variable("motor").unwrap();
    for value in [0.3, -1.1, 2.0] {
        let mut design = vec![0.0; position.variables.len()];
        design[motor.0] = value;
        let found = analysis.solve(Run::new().at(&design));
        let (last, x) = (found.motion.len() - 1, found.measured.index("place").unwrap());
        let [expected, slope] = place(0.3, value);
        assert!((found.measured.value(last, x)[0] - expected).abs() < EXACT, "{value}");
        assert!((found.measured.d(last, motor, x)[0] - slope).abs() < EXACT, "{value}");
    }
    // The law has the same sense.
    let run = Analysis::new(&model).unwrap().run();
    let x = run.measured.index("place").unwrap();
    for (k, t) in run.motion.times.iter().enumerate() {
        let (speed, value) = (20_f64.to_radians(), 20_f64.to_radians() * t);
        let [expected, slope] = place(0.3, value);
        let [found, rate, ..] = run.measured.value(k, x);
        assert!((found - expected).abs() < EXACT && (rate - speed * slope).abs() < EXACT, "{t}");
    }
}

#[test]
fn a_table_over_a_reversed_driver_has_the_values_of_its_laws() {
    let model = model(&reversed());
    for interpolation in [Interpolation::Hermite, Interpolation::Linear] {
        let overrides = Overrides {
            over: vec![("motor".to_owned(), [-0.5, 2.0])],
            of: vec!["place".to_owned()],
            errors: vec![(ErrorScope::Output("place".to_owned()), 1e-6)],
            interpolation,
            intervals: None,
        };
        let request = Request::of(&model, overrides).unwrap();
        let table = solve(&model, Formulation::Relative, &request, &mut |_, _| true)
            .unwrap_or_else(|e| panic!("{e:?}"));
        for k in 0..=1000 {
            let value = -0.5 + 2.5 * f64::from(k) / 1000.0;
            let error = (table.value(0, &[value]) - place(0.3, value)[0]).abs();
            assert!(error <= table.columns[0].proved + EXACT, "{value}: {error:e}");
        }
    }
}

#[test]
fn readings_in_postures_of_a_reversed_driver_are_at_values_of_its_laws() {
    let model = model(&reversed());
    let values = [0.25, -0.8];
    let postures: Vec<Vec<f64>> = values.iter().map(|value| vec![*value]).collect();
    let found = calibrate::values_in_postures(&model, &[0.0; 3], &postures, Formulation::Relative).unwrap();
    for (value, found) in values.iter().zip(found) {
        let found = found.unwrap();
        assert!(found.iter().any(|x| (x - place(0.3, *value)[0]).abs() < EXACT), "{value}: {found:?}");
    }
}

#[test]
fn a_stop_reports_the_values_of_a_reversed_driver() {
    // With a rod of 110 mm, the crank stops at sin a = -0.9.
    let text = reversed().replace("value = 300", "value = 110").replace("20*t", "150*t");
    let model = model(&text);
    let limit = 40_f64.to_radians() - (-0.9_f64).asin();
    let run = Analysis::new(&model).unwrap().run();
    let stop = run.stop.unwrap();
    assert_eq!(stop.kind, StopKind::Limit);
    assert!((stop.drivers[0] - limit).abs() < 1e-3, "{stop:?}");
    // At a limit of the joint, which is that of its coordinate.
    let limited = "at = \"O\", axis = \"z\", limits = { angle = { min = -60, stop = true } }";
    let text = reversed().replace("20*t", "150*t").replace("at = \"O\", axis = \"z\"", limited);
    let run = Analysis::new(&self::model(&text)).unwrap().run();
    let stop = run.stop.unwrap();
    assert!(matches!(stop.kind, StopKind::JointLimit { .. }), "{stop:?}");
    assert!((stop.drivers[0] - 60_f64.to_radians()).abs() < 1e-9, "{stop:?}");
}

/// An arm whose fore part turns by the sum of both coordinates; the elbow is reversed.
const ARM: &str = r#"
name = "arm"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { O = [0, 0], E = [140, 0], T = [240, 0] }
bodies = { upper = {}, fore = {} }
joints.shoulder = { type = "revolute", bodies = ["ground", "upper"], at = "O" }
joints.elbow = { type = "revolute", bodies = ["upper", "fore"], at = "E" }
drivers.shoulder = { joint = "shoulder", law = "20*t" }
drivers.elbow = { joint = "elbow", law = "10*t", reversed = true }
measures.turn = { type = "angle", from = "x", to = [{ body = "fore", at = "E" }, { body = "fore", at = "T" }] }
measures.shoulder = { type = "coordinate", joint = "shoulder" }
measures.slope = { type = "slope", of = "turn", over = "shoulder", driver = "shoulder", together = ["elbow"] }
time = { end = 1, steps = 4 }
"#;

#[test]
fn a_grid_over_a_reversed_driver_is_at_the_values_of_its_laws() {
    let grid = "cases.grid.grid = { elbow = { at = [-20, 0, 15] }, shoulder = { at = [0, 40] } }\n";
    let model = model(&format!("{ARM}{grid}"));
    let found = GridMap::solve(&model, &model.grids[0], Formulation::Relative, &[], &|| true).unwrap();
    let at = |name: &str| found.outputs.iter().position(|o| o.name == name).unwrap();
    for (i, elbow) in [-20.0, 0.0, 15.0].into_iter().enumerate() {
        for (j, shoulder) in [0.0, 40.0_f64].into_iter().enumerate() {
            let turn = found.value([i, j], at("turn")).unwrap();
            assert!((turn - (shoulder - elbow).to_radians()).abs() < EXACT, "{elbow} {shoulder}: {turn}");
            // Both values grow by dq: the shoulder turns by dq, the elbow by -dq.
            let slope = found.value([i, j], at("slope")).unwrap();
            assert!(slope.abs() < EXACT, "{slope}");
        }
    }
}

#[test]
fn a_slope_of_a_case_that_holds_a_reversed_driver_has_its_sense() {
    let model = model(&format!("{ARM}cases.hold = {{ laws = {{ shoulder = \"30*t\" }} }}\n"));
    for model in [model.in_case(CaseId(0)), Model { cases: Vec::new(), ..model.clone() }] {
        let run = Analysis::new(&model).unwrap().run();
        let slope = run.measured.index("slope").unwrap();
        for k in 0..run.motion.len() {
            assert!(run.measured.value(k, slope)[0].abs() < EXACT, "{k}: {:?}", run.measured.value(k, slope));
        }
    }
}

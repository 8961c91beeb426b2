//! Couplers with a constant: the mechanism is assembled to it, and the sum stays constant.

use std::ops::ControlFlow;

use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run};
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::verify::{self, CheckOutcome, verify};

/// Residual that the solver leaves of a coordinate, deg or mm.
const SAME: f64 = 1e-8;

/// A four-bar whose rocker turns an arm, and by a rack a slide: 2 arm - 3 rocker = 50 deg, slide + 0.5 rocker = 12 mm.
const GEARED: &str = r#"
name = "geared"
units = { length = "mm", angle = "deg" }
hardpoints = { A = [0, 0, 0], B = [40, 0, 200], C = [360, 0, 600], D = [400, 0, 0], E = [600, 0, 50], F = [800, 0, 0] }
bodies = { crank = {}, coupler = {}, rocker = {}, arm = {}, slide = {} }
joints.A = { type = "revolute", bodies = ["ground", "crank"], at = "A", axis = "y" }
joints.B = { type = "revolute", bodies = ["crank", "coupler"], at = "B", axis = "y" }
joints.C = { type = "revolute", bodies = ["coupler", "rocker"], at = "C", axis = "y" }
joints.D = { type = "revolute", bodies = ["ground", "rocker"], at = "D", axis = "y" }
joints.E = { type = "revolute", bodies = ["ground", "arm"], at = "E", axis = "y" }
joints.F = { type = "translational", bodies = ["ground", "slide"], at = "F", axis = "z" }
drivers.motor = { joint = "A", law = "20*sin(2*pi*t)" }
time = { end = 1, steps = 20 }
[couplers.geared]
type = "linear"
terms = [{ joint = "E", coefficient = 2 }, { joint = "D", coefficient = -3 }]
constant = 50
[couplers.racked]
type = "linear"
terms = [{ joint = "F", coefficient = 1 }, { joint = "D", coefficient = 0.5 }]
constant = 12
[design]
B = { move = "B", along = "xyz" }
E_x = { move = "E", along = "x" }
[points]
tip = { body = "arm", at = [700, 0, 100] }
[measures]
rocker = { type = "coordinate", joint = "D" }
arm = { type = "coordinate", joint = "E" }
slide = { type = "coordinate", joint = "F" }
"#;

/// The coordinates that are measured, in the file's units, at all output times.
fn coordinates(file: &ModelFile, names: [&str; 3], formulation: Formulation) -> Vec<[f64; 3]> {
    let analysis = Analysis::with(&file.model, formulation).unwrap();
    let run = analysis.run();
    assert!(run.stop.is_none(), "{:?}", run.stop);
    let places = names.map(|name| run.measured.outputs.iter().position(|o| o.name == name).unwrap());
    let of = |k: usize| {
        let [rocker, arm, slide] = places.map(|m| run.measured.value(k, m)[0]);
        [rocker.to_degrees(), arm.to_degrees(), 1e3 * slide]
    };
    (0..run.motion.len()).map(of).collect()
}

fn read(text: &str) -> ModelFile {
    parse(text, "geared.toml").unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn the_sum_is_the_constant_at_all_times_in_both_formulations() {
    let file = read(GEARED);
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let found = coordinates(&file, ["rocker", "arm", "slide"], formulation);
        for [rocker, arm, slide] in &found {
            assert!((2.0 * arm - 3.0 * rocker - 50.0).abs() < SAME, "{rocker} {arm}");
            assert!((slide + 0.5 * rocker - 12.0).abs() < SAME, "{rocker} {slide}");
        }
        assert!(found.iter().any(|c| c[0].abs() > 5.0));
        // A constant moves nothing else.
        let plain = read(&GEARED.replace("constant = 50", "").replace("constant = 12", "constant = 0"));
        for ([a, ..], [b, ..]) in
            found.iter().zip(coordinates(&plain, ["rocker", "arm", "slide"], formulation))
        {
            assert!((a - b).abs() < SAME);
        }
    }
    // Through more than a turn.
    let far = read(&GEARED.replace("constant = 50", "constant = 1490"));
    for [rocker, arm, _] in coordinates(&far, ["rocker", "arm", "slide"], Formulation::Relative) {
        assert!((2.0 * arm - 3.0 * rocker - 1490.0).abs() < SAME, "{rocker} {arm}");
    }
}

#[test]
fn sensitivities_agree_with_moved_designs() {
    let file = read(GEARED);
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.solve(Run::new());
    let report = verify(&analysis, &solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
    assert_eq!(report.checks.len(), 4);
    assert!(report.checks.iter().all(|c| c.outcome == CheckOutcome::Passed), "{report:?}");
}

#[test]
fn a_mirrored_one_has_the_same_constant() {
    let left = GEARED
        .replace(
            "coupler = {}, rocker = {}, arm = {}, slide = {}",
            "coupler = {}, rocker = {}, left_arm = {}, left_slide = {}",
        )
        .replace("\"arm\"]", "\"left_arm\"]")
        .replace("\"slide\"]", "\"left_slide\"]")
        .replace("joints.E", "joints.left_E")
        .replace("joints.F", "joints.left_F")
        .replace("joint = \"E\"", "joint = \"left_E\"")
        .replace("joint = \"F\"", "joint = \"left_F\"")
        .replace("couplers.geared", "couplers.left_geared")
        .replace("couplers.racked", "couplers.left_racked")
        .replace("E = [600", "left_E = [600")
        .replace("at = \"E\"", "at = \"left_E\"")
        .replace("E_x = { move = \"E\", along = \"x\" }\n", "")
        .replace("body = \"arm\"", "body = \"left_arm\"")
        .replace("arm = { type = \"coordinate\"", "left_arm = { type = \"coordinate\"")
        .replace("slide = { type = \"coordinate\"", "left_slide = { type = \"coordinate\"");
    let file = read(&format!("{left}\n[mirror]\n"));
    let right = coordinates(&file, ["rocker", "right_arm", "right_slide"], Formulation::Relative);
    for ([rocker, arm, slide], [.., a, s]) in
        coordinates(&file, ["rocker", "left_arm", "left_slide"], Formulation::Relative).into_iter().zip(right)
    {
        assert!((2.0 * arm - 3.0 * rocker - 50.0).abs() < SAME, "{rocker} {arm}");
        assert!((arm - a).abs() < SAME && (slide - s).abs() < SAME, "{arm} {a} {slide} {s}");
    }
}

#[test]
fn a_constant_that_is_not_a_number_is_reported() {
    for (wrong, words) in [("nan", "HP"), ("inf", "HP"), ("\"much\"", "much"), ("[1]", "constant")] {
        let error = parse(&GEARED.replace("constant = 50", &format!("constant = {wrong}")), "geared.toml")
            .unwrap_err();
        assert!(error.to_string().contains(words), "{wrong}: {error}");
    }
    // Gears have none.
    let gear = GEARED.replace("type = \"linear\"\nterms = [{ joint = \"E\", coefficient = 2 }, { joint = \"D\", coefficient = -3 }]", "type = \"gear\"\njoints = [\"E\", \"D\"]\nteeth = [2, 3]");
    assert_ne!(gear, GEARED);
    let error = parse(&gear, "geared.toml").unwrap_err().to_string();
    assert!(error.contains("`constant`"), "{error}");
}

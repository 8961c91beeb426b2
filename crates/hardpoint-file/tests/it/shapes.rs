//! Bodies that change their shape: where their joints go, and that nothing has to be re-assembled.

use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::Analysis;
use hardpoint::model::VariableId;
use hardpoint::sensitivity::Admissibility;
use hardpoint::space::Vec3;
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::verify::{self, verify};

const SHAPES: &str = r#"
[design.translated]
shape = "left_uca"
field = { translate = [0, 0, 2] }

[design.turned]
shape = "left_lca"
field = { rotate = "z", at = "left_lca_rear" }

[design.wider]
shape = ["left_lca", "left_uca"]
field = { scale = "left_lca_rear", along = "y" }

[design.larger]
shape = "left_knuckle"
field = { scale = "left_lower_ball" }

[design.bent]
shape = "left_knuckle"
field = { bend = ["left_lower_ball", "left_upper_ball"], towards = "x" }

[design.shaped]
shape = "left_knuckle"
field = { through = [
    { at = "left_lower_ball" }, { at = "left_upper_ball", move = [0, 1, 0] }, { at = "left_tie_rod_outer", move = [0, 0.5, 0.2] },
    { at = "left_wheel_centre", move = [0, 1, 0.5] },
] }
"#;

fn file() -> ModelFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/front_axle.toml");
    let text = std::fs::read_to_string(path).unwrap() + SHAPES;
    let mut file = parse(&text, "shapes.toml").unwrap_or_else(|e| panic!("{e}"));
    // A few times are enough.
    file.model.times = (0..=20).map(|k| f64::from(k) / 20.0).collect();
    file
}

#[test]
fn joints_move_with_the_velocity_field() {
    let file = file();
    let model = &file.model;
    let place = |name: &str, variable: &str, by: f64| {
        let mut design = vec![0.0; model.variables.len()];
        design[model.variable(variable).unwrap().0] = by;
        let joint = model.joints.iter().position(|j| j.name == name).unwrap();
        let marker = model.geometry(&design).markers[joint][1];
        model.bodies[model.joints[joint].bodies[1].0].frame.point(marker.r)
    };
    let close = |found: Vec3, expected: [f64; 3]| {
        let expected = Vec3::from(expected) * 1e-3;
        assert!((found - expected).norm() < 1e-12, "{found:?} {expected:?}");
    };
    close(place("left_upper_ball", "translated", 0.003), [-28.28, 538.13, 83.0]);
    // Ten percent along y from the lower arm's rear hardpoint, which is at y = 240.
    close(place("left_lower_ball", "wider", 0.1), [12.46, 562.18 + 32.218, -60.0]);
    close(place("left_upper_ball", "wider", 0.1), [-28.28, 538.13 + 29.813, 80.0]);
    close(place("left_upper_ball", "larger", 0.1), [-28.28 - 4.074, 538.13 - 2.405, 94.0]);
    close(place("left_lower_ball", "larger", 0.1), [12.46, 562.18, -60.0]);
    // The tip goes aside by the variable, perpendicular to the beam.
    let (low, high) = (place("left_lower_ball", "bent", 0.001), place("left_upper_ball", "bent", 0.001));
    close(low, [12.46, 562.18, -60.0]);
    let was = Vec3::new(-0.02828, 0.53813, 0.08);
    assert!(((high - was).norm() - 1e-3).abs() < 1e-12 && (high - was).dot(was - low).abs() < 1e-15);
    close(place("left_upper_ball", "shaped", 0.001), [-28.28, 539.13, 80.0]);
    close(place("left_tie_rod", "shaped", 0.001), [-58.0, 527.25, 11.98]);
}

#[test]
fn a_body_that_changes_its_shape_opens_no_joint_and_its_sensitivities_are_exact() {
    let mut file = file();
    // Only the shapes.
    let first = file.model.variable("translated").unwrap().0;
    file.model.variables.drain(..first);
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    assert!(solution.stop.is_none());
    for (v, variable) in file.model.variables.iter().enumerate() {
        let answer = &solution.sensitivities.admissibility[v];
        assert_eq!(*answer, Admissibility::Admissible, "{}", variable.name);
        let toe = solution.measured.index("left.toe").unwrap();
        let most = (0..solution.motion.len()).map(|k| solution.measured.d(k, VariableId(v), toe)[0].abs());
        assert!(most.fold(0.0, f64::max) > 1e-3, "{}", variable.name);
    }
    let report = verify(&analysis, &solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
    assert!(report.passed(), "{:#?}", report.checks);
}

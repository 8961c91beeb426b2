//! Measures and loads at the edges of their domains: a correct value, or none.

use std::ops::ControlFlow;

use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::verify::{self, CheckOutcome, verify};

const BOTH: [Formulation; 2] = [Formulation::Relative, Formulation::Absolute];

fn file(text: &str) -> ModelFile {
    parse(text, "domain.toml").unwrap_or_else(|e| panic!("{e}"))
}

fn solved(text: &str, formulation: Formulation) -> Solution {
    let file = file(text);
    let solution = Analysis::with(&file.model, formulation).unwrap().run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    solution
}

fn values(solution: &Solution, name: &str) -> Vec<f64> {
    let m = solution.measured.index(name).unwrap_or_else(|| panic!("{name}"));
    (0..solution.motion.len()).map(|k| solution.measured.value(k, m)[0]).collect()
}

/// A double-wishbone front axle whose wheels and rack follow these laws.
fn steered_axle(bump: &str, steer: &str) -> String {
    let text = include_str!("../models/steered_axle.toml");
    let (model, _) = text.split_once("[cases.bump]").unwrap();
    let laws = [
        ("along = \"z\", law = \"-40 + 80*t\"", bump, "along = \"z\", "),
        ("\"rack_slide\", law = \"0\"", steer, "\"rack_slide\", "),
    ];
    let model = laws.into_iter().fold(model.to_owned(), |model, (old, law, kept)| {
        assert!(model.contains(old));
        model.replace(old, &format!("{kept}law = \"{law}\""))
    });
    let measures = "\"track\", \"ackermann_error\", \"turning_radius\"]";
    model.replace("\"track\"]", measures) + "[time]\nend = 1\nsteps = 16\n"
}

#[test]
fn a_symmetric_axle_reads_the_same_turning_left_and_right() {
    let solution = solved(&steered_axle("0", "-40 + 80*t"), Formulation::Relative);
    for name in ["front.ackermann", "front.ackermann_error", "front.turning_radius"] {
        let list = values(&solution, name);
        let known = list.iter().filter(|x| !x.is_nan()).count();
        assert!(known >= 16, "{name}: {list:?}");
        for (a, b) in list.iter().zip(list.iter().rev()) {
            assert!(a.is_nan() && b.is_nan() || (a - b).abs() < 1e-8 * a.abs().max(1e-3), "{name}: {list:?}");
        }
    }
    // Straight ahead the axle is not steered.
    assert!(values(&solution, "front.ackermann")[8].is_nan());
}

#[test]
fn an_axle_that_is_not_steered_has_no_ackermann() {
    let solution = solved(&steered_axle("-40 + 80*t", "0"), Formulation::Relative);
    for name in ["front.ackermann", "front.turning_radius"] {
        let list = values(&solution, name);
        assert!(list.iter().all(|x| x.is_nan()), "{name}: {list:?}");
    }
}

/// A planar four-bar of hinges: constraints along z are redundant.
fn four_bar(cut: &str, elastic: &[(&str, &str)]) -> String {
    let joints: String = [("O", "ground", "crank"), ("A", "crank", "coupler"), ("B", "coupler", "rocker"), ("D", "ground", "rocker")]
        .iter()
        .map(|(name, i, j)| {
            let cut = if *name == cut { ", cut = true" } else { "" };
            format!("{name} = {{ type = \"revolute\", bodies = [\"{i}\", \"{j}\"], at = \"{name}\", axis = \"z\", axis2 = \"x\"{cut} }}\n")
        })
        .collect();
    let elastic: String = elastic
        .iter()
        .map(|(joint, keys)| {
            format!("e_{joint} = {{ type = \"elastic_joint\", joint = \"{joint}\", {keys} }}\n")
        })
        .collect();
    format!(
        r#"
name = "four-bar"
units = {{ length = "mm", angle = "deg" }}
[hardpoints]
O = [0, 0, 0]
A = [60, 80, 0]
B = [260, 170, 0]
D = [200, 0, 0]
[bodies]
crank = {{}}
coupler = {{}}
rocker = {{}}
[joints]
{joints}
[drivers]
m = {{ joint = "O", law = "30*t" }}
[points]
Q = {{ body = "coupler", at = [150, 90, 0] }}
[forces]
{elastic}
[measures]
pz = {{ type = "position", point = "Q", along = [0, 0, 1] }}
py = {{ type = "position", point = "Q", along = [0, 1, 0] }}
across = {{ type = "compliance", of = "pz", at = "Q", along = [0, 0, 1] }}
within = {{ type = "compliance", of = "py", at = "Q", along = [0, 1, 0] }}
[time]
end = 1
steps = 1
"#
    )
}

#[test]
fn a_compliance_does_not_depend_on_the_joint_that_is_cut() {
    let mut within = Vec::new();
    for cut in ["A", "B", "D", "none"] {
        for formulation in BOTH {
            // The other hinges are rigid along z, so that this one gives nothing that the loop could follow.
            let along = solved(&four_bar(cut, &[("A", "x = 20, y = 30, z = 10, about_x = 5")]), formulation);
            assert_eq!(values(&along, "across"), [0.0, 0.0], "{cut} {formulation:?}");
            within.push(values(&along, "within"));
            // Two that may give together share a force by how stiff they are, and by what else the loop says.
            let both = solved(&four_bar(cut, &[("A", "z = 10"), ("B", "z = 10")]), formulation);
            assert!(values(&both, "across").iter().all(|x| x.is_nan()), "{cut} {formulation:?}");
        }
    }
    for list in &within {
        for (x, first) in list.iter().zip(&within[0]) {
            assert!(*x > 0.0 && (x - first).abs() < 1e-10 * first, "{within:?}");
        }
    }
}

#[test]
fn a_spring_whose_ends_meet_has_no_direction() {
    let text = r#"
name = "spring ends meet"
units = { length = "mm", angle = "deg" }
[hardpoints]
O = [0, 0, 0]
A = [22.945265618534656, 19.32653061713073, 0]
E = [-22.945265618534656, -19.32653061713073, 0]
[bodies]
crank = {}
[joints]
O = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
[drivers]
m = { joint = "O", law = "360*t" }
[forces]
s = { type = "spring", from = { body = "ground", at = "E" }, to = { body = "crank", at = "A" }, stiffness = 2.0, free_length = 50 }
[measures]
T = { type = "driver_force", driver = "m" }
[time]
at = [0.25, 0.499999, 0.5, 0.500001, 0.75]
"#;
    for formulation in BOTH {
        let torque = values(&solved(text, formulation), "T");
        assert!(torque[2].is_nan(), "{torque:?}");
        // Close by it pulls with 100 N along a line that is across the crank of 30 mm.
        assert!((torque[1] + torque[3]).abs() < 1e-6 && (torque[1].abs() - 3.0).abs() < 1e-3, "{torque:?}");
        assert!((torque[0] + torque[4]).abs() < 1e-9, "{torque:?}");
    }
}

#[test]
fn reactions_of_drive_and_brakes_follow_the_wheel() {
    let text = include_str!("../models/live_axle.toml");
    let with = |keys: &str| text.replace("end = \"rear\"", &format!("end = \"rear\"\n{keys}"));
    let [given, outboard, inboard] =
        [text.to_owned(), with("drive = \"outboard\""), with("drive = \"inboard\"\nbrakes = \"inboard\"")]
            .map(|text| solved(&text, Formulation::Relative));
    for wheel in ["w_left", "w_right"] {
        let of = |solution: &Solution, name: &str| values(solution, &format!("{wheel}.{name}"));
        // Lower links 40 in by 4 in, upper ones 30 in by 1 in: the lines meet, and the tyre pushes along the line from
        // the ground to there.
        let x = 9.0 / (4.0 / 40.0 - 1.0 / 30.0);
        let expected = (13.0 + x * 4.0 / 40.0) / x * 110.0 / 30.0;
        assert!((of(&given, "anti_squat")[0] - expected).abs() < 1e-9, "{expected}");
        assert_eq!(of(&given, "anti_squat"), of(&outboard, "anti_squat"));
        // At the wheel centre, 17.5 in up.
        let expected = (13.0 + x * 4.0 / 40.0 - 17.5) / x * 110.0 / 30.0;
        for name in ["anti_squat", "anti_lift"] {
            assert!((of(&inboard, name)[0] - expected).abs() < 1e-9, "{name} {expected}");
        }
        // Brakes are at the wheel by default.
        assert_eq!(of(&given, "anti_lift"), of(&outboard, "anti_squat"));
    }
}

#[test]
fn the_instant_axis_keeps_its_direction_within_a_motion() {
    let text = include_str!("../models/three_link.toml");
    let solution = solved(text, Formulation::Relative);
    let model = file(text).model;
    let steps = solution.motion.len();
    for axis in ["x", "y", "z"] {
        let name = format!("wheel.instant_axis_{axis}");
        let list = values(&solution, &name);
        // It rotates by at most a few degrees between two output times.
        assert!(list.windows(2).all(|w| (w[1] - w[0]).abs() < 0.05), "{name}: {list:?}");
        let m = solution.measured.index(&name).unwrap();
        for variable in 0..model.variables.len() {
            // Three times in the same position.
            let d = [0, steps / 2, steps - 1]
                .map(|k| solution.measured.d(k, hardpoint::model::VariableId(variable), m)[0]);
            for other in &d[1..] {
                assert!((d[0] - other).abs() < 1e-8, "{name} {variable}: {d:?}");
            }
        }
    }
}

/// A force that passes near zero, where its magnitude has a kink, is no error; derivatives of another design are.
#[test]
fn verify_accepts_kinks_and_rejects_wrong_derivatives() {
    let file = file(include_str!("../models/five_link_small_force.toml"));
    let analysis = Analysis::new(&file.model).unwrap();
    let right = analysis.run();
    let check = |solution: &Solution| {
        verify(&analysis, solution, &verify::Options::default(), |_| ControlFlow::Continue(()))
    };
    let report = check(&right);
    assert!(report.passed(), "{:#?}", report.checks.iter().map(|c| c.worst()).collect::<Vec<_>>());
    // 0.2 mm away: derivatives that are off by some thousandths.
    let mut design = vec![0.0; file.model.variables.len()];
    design[0] = 2e-4;
    let mut wrong = right.clone();
    wrong.measured = analysis.solve(Run::new().at(&design)).measured;
    let report = check(&wrong);
    let failed = report.checks.iter().filter(|c| c.outcome == CheckOutcome::Failed).count();
    assert!(failed >= 7, "{failed} of {}", report.checks.len());
}

/// A rod pushes a block along its guide at an angle: the normal force is the weight and the side thrust, which friction
/// itself makes larger. With `mu tan(angle)` above 1 friction has two solutions.
#[test]
fn friction_with_two_solutions_has_no_number() {
    for mu in [0.3, 1.0, 1.5, 2.5] {
        let text = format!(
            r#"
name = "crank pushes a rubbing block"
units = {{ length = "m", angle = "deg" }}
[hardpoints]
O = [0, 0, 0]
A = [0.2, 0, 0]
B = [0.45, 0, 0]
[bodies]
crank = {{}}
block = {{}}
[joints]
O = {{ type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }}
R = {{ type = "rod", bodies = ["crank", "block"], at = ["A", "B"] }}
G = {{ type = "translational", bodies = ["ground", "block"], at = "B", axis = "x" }}
[drivers]
m = {{ joint = "O", law = "10 + 60*t" }}
[gravity]
along = "-y"
[masses]
b = {{ type = "rigid", centre = {{ body = "block", at = "B" }}, mass = 10, ixx = 0.1, iyy = 0.1, izz = 0.1 }}
[forces]
f = {{ type = "slide_friction", joint = "G", coefficient = {mu} }}
[measures]
T = {{ type = "driver_force", driver = "m" }}
F = {{ type = "spring_force", force = "f" }}
[time]
end = 1
steps = 20
"#
        );
        let solution = solved(&text, Formulation::Relative);
        for (k, (torque, friction)) in
            values(&solution, "T").into_iter().zip(values(&solution, "F")).enumerate()
        {
            let crank = (10.0 + 3.0 * k as f64).to_radians();
            let rod = (0.2 / 0.25 * crank.sin()).asin();
            let has_one = mu * rod.tan() < 1.0;
            assert_eq!(torque.is_nan(), !has_one, "{mu} {k}");
            assert_eq!(friction.is_nan(), !has_one, "{mu} {k}");
        }
    }
}

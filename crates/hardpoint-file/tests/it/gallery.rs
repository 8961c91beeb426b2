//! The models of the gallery move as they should: against a high-precision solution of the same mechanisms,
//! whose accelerations and their sensitivities are central differences in 110 digits.

use std::path::Path;

use hardpoint::sensitivity::{Admissibility, BodySensitivity};
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Solution};
use hardpoint_file::{ModelFile, read};
use serde_json::Value;

fn solved(name: &str) -> (ModelFile, Solution) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    let file = read(&path).unwrap_or_else(|e| panic!("{e}"));
    let solution = Analysis::new(&file.model).unwrap_or_else(|e| panic!("{name}: {e:?}")).run();
    assert!(solution.stop.is_none(), "{name}: {:?}", solution.stop);
    assert_eq!(solution.motion.len(), file.model.times.len(), "{name}");
    (file, solution)
}

/// Holds a motion against `tests/reference.json`, in SI: of some measures at one output time value and acceleration,
/// and sensitivities of the acceleration. The package for Python is held against the same file.
fn compare(name: &str) {
    let reference: Value = serde_json::from_str(include_str!("../reference.json")).unwrap();
    let expected = &reference[name];
    let (file, solution) = solved(name);
    let t = expected["time"].as_f64().unwrap();
    let k = file.model.times.iter().position(|x| (x - t).abs() < 1e-12).unwrap();
    // The output time itself is off by rounding, and accelerations change with it.
    let near = |what: &str, found: f64, expected: &Value| {
        let expected = expected.as_f64().unwrap();
        assert!(
            (found - expected).abs() < 1e-9 * expected.abs().max(1.0),
            "{name} {what}: {found} {expected}"
        );
    };
    for (measure, expected) in expected["measures"].as_object().unwrap() {
        let m = solution.measured.index(measure).unwrap();
        let [v, _, a] = solution.measured.value(k, m);
        near(measure, v, &expected["value"]);
        near(measure, a, &expected["acceleration"]);
        for (variable, d) in expected["sensitivities"].as_object().unwrap() {
            let b = file.model.variable(variable).unwrap_or_else(|| panic!("{variable}"));
            near(&format!("{measure} by {variable}"), solution.measured.d(k, b, m)[2], d);
        }
    }
}

#[test]
fn macpherson_matches_the_reference() {
    compare("macpherson.toml");
}

#[test]
fn slider_crank_matches_the_reference() {
    compare("slider_crank.toml");
}

#[test]
fn rssr_matches_the_reference() {
    compare("rssr.toml");
}

#[test]
fn double_wishbone_matches_the_reference() {
    compare("double_wishbone.toml");
}

#[test]
fn hooke_joint_follows_its_formula() {
    let (file, solution) = solved("hooke.toml");
    let beta = 30f64.to_radians();
    let m = solution.measured.index("output_angle").unwrap();
    let b = file.model.variable("shaft_angle").unwrap();
    for (k, t) in file.model.times.iter().enumerate() {
        let q1 = std::f64::consts::TAU * t;
        // tan q2 = tan q1 / cos beta, on the branch of q1.
        let turns = (q1 / std::f64::consts::TAU).round() * std::f64::consts::TAU;
        let (y, x) = (q1.sin(), q1.cos() * beta.cos());
        let q2 = y.atan2(x) + turns;
        let found = solution.measured.value(k, m)[0];
        let apart = (found - q2 + 0.5 * std::f64::consts::TAU).rem_euclid(std::f64::consts::TAU);
        assert!((apart - 0.5 * std::f64::consts::TAU).abs() < 1e-11, "t = {t}: {found} {q2}");
        // d q2 / d beta = y x tan(beta) / (x^2 + y^2).
        let d = y * x * beta.tan() / (x * x + y * y);
        assert!((solution.measured.d(k, b, m)[0] - d).abs() < 1e-11, "t = {t}");
    }
}

#[test]
fn only_the_marked_variables_are_inadmissible() {
    for (name, refused) in [
        ("macpherson.toml", vec![]),
        ("slider_crank.toml", vec!["J4_ry"]),
        ("rssr.toml", vec![]),
        ("hooke.toml", vec!["in_bearing_y"]),
        ("double_wishbone.toml", vec![]),
    ] {
        let (file, solution) = solved(name);
        let found: Vec<&str> = file
            .model
            .variables
            .iter()
            .zip(&solution.sensitivities.admissibility)
            .filter(|(_, a)| matches!(a, Admissibility::CannotFollow { .. } | Admissibility::Unknown))
            .map(|(v, _)| v.name.as_str())
            .collect();
        assert_eq!(found, refused, "{name}");
    }
}

#[test]
fn both_formulations_agree_on_every_model_of_the_gallery() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let mut compared = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let (file, relative) = solved(&name);
        let absolute = Analysis::with(&file.model, Formulation::Absolute).unwrap().run();
        assert!(absolute.stop.is_none(), "{name}: {:?}", absolute.stop);
        // Every quantity against its own largest magnitude over the motion, at least 1 (SI).
        let steps = relative.motion.len();
        let mut agree = |what: String, a: &dyn Fn(usize) -> Vec3, b: &dyn Fn(usize) -> Vec3| {
            let scale = (0..steps).map(|k| a(k).norm()).fold(1.0, f64::max);
            for k in 0..steps {
                let apart = (a(k) - b(k)).norm() / scale;
                assert!(apart < 1e-10, "{name}: {what} at step {k}: {apart:e}");
            }
            compared += 1;
        };
        for i in 1..relative.motion.bodies {
            let body = &file.model.bodies[i].name;
            agree(format!("{body} acceleration"), &|k| relative.motion.at(k).body(i).a, &|k| {
                absolute.motion.at(k).body(i).a
            });
            agree(format!("{body} angular acceleration"), &|k| relative.motion.at(k).body(i).alpha, &|k| {
                absolute.motion.at(k).body(i).alpha
            });
            for (v, variable) in file.model.variables.iter().enumerate() {
                if relative.sensitivities.at(0, v).is_none() {
                    assert!(absolute.sensitivities.at(0, v).is_none(), "{name}: {}", variable.name);
                    continue;
                }
                let kinds: [fn(&BodySensitivity) -> Vec3; 3] = [|s| s.dr, |s| s.da, |s| s.dalpha];
                for of in kinds {
                    let [a, b] = [&relative, &absolute]
                        .map(|s| move |k: usize| of(&s.sensitivities.at(k, v).unwrap().body(i)));
                    agree(format!("{body} by {}", variable.name), &a, &b);
                }
            }
        }
    }
    assert!(compared > 200, "only {compared} quantities");
}

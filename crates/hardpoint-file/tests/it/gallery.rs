//! The models of the gallery move as they should: against a high-precision solution of the same mechanisms,
//! whose accelerations and their sensitivities are central differences in 110 digits.

use std::path::Path;

use hardpoint::sensitivity::{Admissibility, BodySensitivity};
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Solution};
use hardpoint_file::{ModelFile, read};

fn solved(name: &str) -> (ModelFile, Solution) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    let file = read(&path).unwrap_or_else(|e| panic!("{e}"));
    let solution = Analysis::new(&file.model).unwrap_or_else(|e| panic!("{name}: {e:?}")).run();
    assert!(solution.stop.is_none(), "{name}: {:?}", solution.stop);
    assert_eq!(solution.motion.len(), file.model.times.len(), "{name}");
    (file, solution)
}

/// A measure's value and acceleration at one output time, then sensitivities of the acceleration; SI.
type Expected<'a> = (&'a str, f64, f64, &'a [(&'a str, f64)]);

fn compare(name: &str, t: f64, expected: &[Expected<'_>]) {
    let (file, solution) = solved(name);
    let k = file.model.times.iter().position(|x| (x - t).abs() < 1e-12).unwrap();
    // The output time itself is off by rounding, and accelerations change with it.
    let near = |what: &str, found: f64, expected: f64| {
        assert!(
            (found - expected).abs() < 1e-9 * expected.abs().max(1.0),
            "{name} {what}: {found} {expected}"
        );
    };
    for (measure, value, acceleration, sensitivities) in expected {
        let m = solution.measured.index(measure).unwrap();
        let [v, _, a] = solution.measured.value(k, m);
        near(measure, v, *value);
        near(measure, a, *acceleration);
        for (variable, d) in *sensitivities {
            let b = file.model.variable(variable).unwrap_or_else(|| panic!("{variable}"));
            near(&format!("{measure} by {variable}"), solution.measured.d(k, b, m)[2], *d);
        }
    }
}

#[test]
fn macpherson_matches_the_reference() {
    compare(
        "macpherson.toml",
        3.6,
        &[
            (
                "toe",
                -0.12926759210190494,
                0.23376058641204503,
                &[
                    ("lca_location_y", -0.004180742381957907),
                    ("lca_rear_z", -0.22198230705830055),
                    ("lca_tilt", 0.01063730299718242),
                    ("ball_joint_z", 0.06736369804335368),
                    ("tie_rod_outer_y", -0.25829288865293315),
                    ("tie_rod_inner_z", 0.30466547789788395),
                    ("strut_top_y", 0.03987897164563081),
                ],
            ),
            ("camber", 0.02009482025400898, -0.05485809458233867, &[("strut_top_y", 0.08363404640400979)]),
            (
                "lca_angle",
                -0.10728546429701298,
                0.042071650017951254,
                &[("lca_location_y", 0.14161368852415968)],
            ),
            ("tie_rod_length", 0.3779582922235337, 0.0, &[("tie_rod_outer_y", 0.0)]),
        ],
    );
}

#[test]
fn slider_crank_matches_the_reference() {
    compare(
        "slider_crank.toml",
        0.6,
        &[
            (
                "stroke",
                0.0807464471189437,
                -8.377193321819098,
                &[("J1_x", 23.058879561508395), ("J2_y", -48.26292330535198), ("J4_rz", -1.2620209217513472)],
            ),
            ("rod_angle", 0.7793359636883906, -28.727477317653246, &[("J1_x", 64.9840675318813)]),
        ],
    );
}

#[test]
fn rssr_matches_the_reference() {
    compare(
        "rssr.toml",
        0.25,
        &[(
            "rocker_angle",
            -0.4764987579265554,
            0.7921057305883381,
            &[
                ("R1_z", -4.707715851452372),
                ("R2_rx", -5.464706969130416),
                ("B_y", -28.885258258956412),
                ("A_x_fixed_length", -12.706736993930404),
            ],
        )],
    );
}

#[test]
fn double_wishbone_matches_the_reference() {
    compare(
        "double_wishbone.toml",
        0.6,
        &[
            (
                "toe",
                -0.14515940530956828,
                1.2616744616800437,
                &[
                    ("lca_location_z", -14.971367960256098),
                    ("tie_rod_outer_y_fixed_length", 3.224620811861191),
                    ("pushrod_inner_z", -1.3569650889277571),
                    ("rocker_tilt", 0.02171044266740301),
                ],
            ),
            ("camber", -0.0082189990104213, 0.2444891032968953, &[("spring_chassis_y", 0.5559706813459198)]),
            (
                "rocker_angle",
                0.12771794533292505,
                -7.139794323932908,
                &[("spring_chassis_y", -8.692897504667828)],
            ),
            (
                "axle_to_rocker",
                0.44939033365503095,
                0.20666318749545137,
                &[("pushrod_inner_z", 4.634672638702812)],
            ),
        ],
    );
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
fn only_the_variables_that_say_so_cannot_be_followed() {
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

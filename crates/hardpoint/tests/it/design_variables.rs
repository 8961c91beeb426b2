//! Design variables as users write them, against the elementary marker changes that they stand for.

use std::ops::ControlFlow;

use hardpoint::Analysis;
use hardpoint::law::Law;
use hardpoint::sensitivity::Admissibility;
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint::{design::JointConstants, draft::*, model::*};
use hardpoint_study::verify::{self, verify};

use crate::workbench::*;

/// The strut with named hardpoints, axes through two of them, and one variable per change.
fn strut_with_hardpoints(design: Vec<VariableDraft>) -> Model {
    let mut d = reference_draft("macpherson");
    let pivots = [("lca_rear", [-0.04318, 0.37338, -0.12573]), ("lca_front", [0.27051, 0.34544, -0.05969])];
    d.hardpoints = pivots
        .into_iter()
        .chain([("ball", [0.02794, 0.66294, -0.10414]), ("tie_rod_outer", [-0.2, 0.574803759, -0.00127])])
        .map(|(name, p)| HardpointDraft::new(name, p))
        .collect();
    for j in &mut d.joints {
        match j.name.as_str() {
            "lca_pivot" => {
                j.at = Vec::new();
                j.axis = Some(DirectionDraft::Through("lca_rear".into(), "lca_front".into()));
            }
            "ball_B" => j.at = vec![LocationDraft::Hardpoint("ball".into())],
            "tie_rod" => j.at[0] = LocationDraft::Hardpoint("tie_rod_outer".into()),
            _ => {}
        }
    }
    d.design = design;
    Model::from_draft(&d).unwrap()
}

fn moves(name: &str, hardpoint: &str, velocity: Vec3) -> VariableDraft {
    VariableDraft::moving(name, hardpoint, velocity)
}

#[test]
fn moving_a_hardpoint_is_the_reference_change_of_every_marker_on_it() {
    let x = Vec3::AXES;
    let model = strut_with_hardpoints(vec![
        moves("lca_rear_pivot_x", "lca_rear", x[0]),
        moves("lca_rear_pivot_y", "lca_rear", x[1]),
        moves("lca_front_pivot_z", "lca_front", x[2]),
        moves("B_x", "ball", x[0]),
    ]);
    let reference = reference("macpherson");
    let (ours, theirs) = (Analysis::new(&model).unwrap().run(), Analysis::new(&reference).unwrap().run());
    let mut compared = 0;
    for (v, variable) in model.variables.iter().enumerate() {
        let Some(w) = reference.variable(&variable.name) else { continue };
        compared += 1;
        for k in 0..ours.motion.len() {
            for (a, b) in ours
                .sensitivities
                .at(k, v)
                .unwrap()
                .iter()
                .zip(theirs.sensitivities.at(k, w.0).unwrap().iter())
            {
                for (p, q) in [(a.dr, b.dr), (a.dpi, b.dpi), (a.da, b.da), (a.dalpha, b.dalpha)] {
                    assert!(apart(p, q) < 1e-11, "{}: {p:?} {q:?}", variable.name);
                }
            }
        }
    }
    assert!(compared >= 3, "only {compared} of the variables are in the reference");
}

#[test]
fn the_field_is_the_derivative_of_the_geometry_for_every_kind_of_change() {
    let joint = || "lca_pivot".to_string();
    let x = Vec3::AXES;
    let changes: Vec<(&str, ChangeDraft)> = vec![
        ("move an end of an axis", ChangeDraft::Move { hardpoint: "lca_front".into(), velocity: x[2] }),
        (
            "move a rod's end",
            ChangeDraft::Move { hardpoint: "tie_rod_outer".into(), velocity: Vec3::new(0.3, 1.0, 0.2) },
        ),
        ("play", ChangeDraft::Play { joint: joint(), along: 1 }),
        ("tilt", ChangeDraft::Tilt { joint: joint(), about: DirectionDraft::Along(x[1]) }),
        (
            "one marker",
            ChangeDraft::Marker {
                joint: "top_E".into(),
                end: End::J,
                position: x[0],
                rotation: Vec3::new(0.1, 0.0, 0.5),
            },
        ),
        (
            "the paper's V and U",
            ChangeDraft::Field {
                joint: joint(),
                body: "lca".into(),
                v: Vec3::new(0.1, 0.2, 0.3),
                u: Vec3::new(0.4, -0.7, 0.9),
            },
        ),
        (
            "V and U on the strut's slide",
            ChangeDraft::Field {
                joint: "strut_slide".into(),
                body: "knuckle".into(),
                v: x[1],
                u: Vec3::new(-0.2, 0.3, 0.5),
            },
        ),
    ];
    for (name, change) in changes {
        for fixed_length in [false, true] {
            let model = strut_with_hardpoints(vec![VariableDraft {
                name: name.into(),
                changes: vec![change.clone()],
                fixed_length,
                ..VariableDraft::default()
            }]);
            let error = |base: f64, h: f64| {
                let field = &model.fields(&[base])[0];
                let [p, m, nominal] = [base + h, base - h, base].map(|b| model.geometry(&[b]));
                let mut worst = 0.0_f64;
                for j in 0..model.joints.len() {
                    for end in 0..2 {
                        let (p, m, o) = (p.markers[j][end], m.markers[j][end], nominal.markers[j][end]);
                        let twist = field.markers.iter().find(|f| f.joint.0 == j && f.end == end);
                        let (w, v) = twist.map_or((Vec3::ZERO, Vec3::ZERO), |f| (f.twist.w, f.twist.at(o.r)));
                        worst = worst.max(((p.r - m.r) * (0.5 / h) - v).norm());
                        for c in 0..3 {
                            let d = (p.rot.cols[c] - m.rot.cols[c]) * (0.5 / h);
                            worst = worst.max((d - w.cross(o.rot.cols[c])).norm());
                        }
                    }
                    let rate = field
                        .kept
                        .iter()
                        .find(|(k, _)| k.0 == j)
                        .map_or(JointConstants::default(), |(_, kept)| *kept);
                    for (p, m, rate) in [
                        (p.kept[j].distance, m.kept[j].distance, rate.distance),
                        (p.kept[j].offset, m.kept[j].offset, rate.offset),
                        (p.kept[j].cosine, m.kept[j].cosine, rate.cosine),
                    ] {
                        worst = worst.max(((p - m) / (2.0 * h) - rate).abs());
                    }
                }
                worst
            };
            let field = model.field(VariableId(0));
            assert_eq!(field, model.fields(&[])[0]);
            assert!(
                field.markers.iter().any(|m| m.twist.w.norm() + m.twist.v.norm() > 0.1),
                "{name}: no field"
            );
            for base in [0.0, 0.04] {
                let (coarse, fine, best) = (error(base, 2e-2), error(base, 1e-2), error(base, 1e-6));
                assert!(best < 1e-9, "{name} at {base}: {best:e}");
                let fourfold = (3.5..4.5).contains(&(coarse / fine));
                assert!(coarse < 1e-10 || fourfold, "{name} at {base}: {coarse:e} {fine:e}");
            }
        }
    }
}

#[test]
fn a_rod_of_fixed_length_is_reassembled_and_one_that_follows_is_admissible() {
    let velocity = Vec3::AXES[1];
    let mut fixed = moves("fixed", "tie_rod_outer", velocity);
    fixed.fixed_length = true;
    let model = strut_with_hardpoints(vec![moves("follows", "tie_rod_outer", velocity), fixed]);
    let solution = Analysis::new(&model).unwrap().run();
    assert_eq!(solution.sensitivities.admissibility[0], Admissibility::Admissible);
    let Admissibility::Reassembled { joints } = &solution.sensitivities.admissibility[1] else {
        panic!("{:?}", solution.sensitivities.admissibility[1]);
    };
    assert_eq!(model.joints[joints[0].joint.0].name, "tie_rod");
    // Toe answers at once to a tie rod that keeps its length, and not at all at the design configuration to
    // one that follows.
    let toe = solution.measured.index("toe").unwrap();
    let d = [0, 1].map(|v| solution.measured.d(0, VariableId(v), toe)[0]);
    assert!(d[0].abs() < 1e-12 && d[1].abs() > 1.0, "{d:?}");
}

#[test]
fn a_point_on_a_hardpoint_follows_it_and_a_point_at_coordinates_stays_in_its_body() {
    let mut draft = reference_draft("slider_crank");
    draft.hardpoints = vec![HardpointDraft::new("P", Vec3::new(0.3, 0.2, 0.05))];
    draft.points =
        vec![PointDraft::new("on", "rod", "P"), PointDraft::new("off", "rod", Vec3::new(0.3, 0.2, 0.05))];
    draft.design = vec![moves("P_y", "P", Vec3::AXES[1])];
    let model = Model::from_draft(&draft).unwrap();
    let solution = Analysis::new(&model).unwrap().run();
    let column = |name: &str| solution.measured.index(name).unwrap();
    for k in 0..solution.motion.len() {
        let f =
            solution.motion.at(k).body(2).rotation * model.bodies[2].frame.rot.transpose_mul(Vec3::AXES[1]);
        assert!((solution.measured.d(k, VariableId(0), column("on.y"))[0] - f.y).abs() < 1e-13);
        assert_eq!(solution.measured.d(k, VariableId(0), column("off.y"))[0], 0.0);
    }
}

#[test]
fn a_redundant_mechanism_follows_every_change_of_its_law() {
    // Three redundant rows watch the planar four-bar; what round-off leaves in them is no defect.
    let mut draft = four_bar([[0.0, 0.0], [0.0, 0.1], [0.3, 0.25], [0.3, 0.0]], "t", &times(3.0, 30));
    draft.drivers[0].law = Law::parse_with("a*sin(w*t)", &[("a", 0.7), ("w", 3.0)]).unwrap();
    for parameter in ["a", "w"] {
        let change = ChangeDraft::Law { driver: "motor".into(), parameter: parameter.into(), rate: 1.0 };
        draft.design.push(VariableDraft::new(parameter, [change]));
    }
    let model = Model::from_draft(&draft).unwrap();
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let analysis = Analysis::with(&model, formulation).unwrap();
        let solution = analysis.run();
        for admissibility in &solution.sensitivities.admissibility {
            assert_eq!(*admissibility, Admissibility::Admissible, "{formulation:?}");
        }
        let checks = verify(&analysis, &solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
        assert!(checks.passed(), "{:?}", checks.checks);
    }
}

/// A planar four-bar with a variable that moves one marker alone, which no other variable here can make up for.
#[test]
fn the_nearest_admissible_change_keeps_what_it_can_and_never_more_defects() {
    use hardpoint::run::nearest_admissible;
    use hardpoint_study::whatif::{add_coordinates, add_tilts};
    let mut draft = four_bar([[0.0, 0.0], [0.0, 0.1], [0.3, 0.25], [0.3, 0.0]], "t", &times(0.5, 20));
    let marker = |joint: &str, position: [f64; 3], rotation: [f64; 3]| {
        VariableDraft::new(
            format!("{joint} alone"),
            [ChangeDraft::Marker {
                joint: joint.into(),
                end: End::I,
                position: position.into(),
                rotation: rotation.into(),
            }],
        )
    };
    draft.design = vec![marker("B", [0.0, 0.001, 0.0], [0.0; 3]), marker("C", [0.0; 3], [0.3, 0.0, 0.0])];
    let mut model = Model::from_draft(&draft).unwrap();
    add_coordinates(&mut model);
    add_tilts(&mut model);
    let analysis = Analysis::new(&model).unwrap();
    let unit = |name: &str, by: f64| {
        let mut change = vec![0.0; model.variables.len()];
        change[model.variable(name).unwrap().0] = by;
        change
    };
    // What is admissible already stays as it is.
    let whole = unit("D.tilt_z", 0.1);
    let nearest = nearest_admissible(&analysis, &whole);
    assert!(nearest.change.iter().zip(&whole).all(|(a, b)| (a - b).abs() < 1e-12), "{nearest:?}");
    // The tilt of one pivot, which nothing follows alone, is kept, and others join it so that all can follow.
    let alone = unit("D.tilt_x", 0.1);
    assert!(matches!(analysis.admissibility_of(&alone), Admissibility::CannotFollow { .. }));
    let nearest = nearest_admissible(&analysis, &alone);
    assert!(nearest.defects[0] > 1e-3 && nearest.defects[1] < 1e-12, "{nearest:?}");
    assert!((nearest.change[model.variable("D.tilt_x").unwrap().0] - 0.1).abs() < 1e-8, "{nearest:?}");
    assert_eq!(analysis.admissibility_of(&nearest.change), Admissibility::Admissible);
    // One marker cannot leave the other, whatever else moves: nothing of it remains.
    for name in ["B alone", "C alone"] {
        let nearest = nearest_admissible(&analysis, &unit(name, 1.0));
        assert!(nearest.change.iter().all(|x| x.abs() < 1e-6), "{name}: {nearest:?}");
        assert!(nearest.defects[1] < 1e-9, "{name}: {nearest:?}");
    }
}

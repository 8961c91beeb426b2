//! Under-driven, over-driven, locked, at a limit: each is distinguished, and names what it is about.

use hardpoint::motion::StopKind;
use hardpoint::space::Vec3;
use hardpoint::topology::{Formulation, TopologyError};
use hardpoint::{Analysis, Run, draft::*, model::*};

use crate::workbench::*;

const CRANK_ROCKER: [[f64; 2]; 4] = [[0.0, 0.0], [0.0, 0.1], [0.3, 0.25], [0.3, 0.0]];

fn fault(draft: &Draft, formulation: Formulation) -> TopologyError {
    Analysis::with(&Model::from_draft(draft).unwrap(), formulation).unwrap_err()
}

#[test]
fn a_mechanism_without_its_driver_is_under_driven_and_free_joints_are_reported() {
    let mut draft = four_bar(CRANK_ROCKER, "t", &[0.0]);
    draft.drivers.clear();
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let fault = fault(&draft, formulation);
        let TopologyError::UnderDriven { freedom, joint_names, bodies, .. } = &fault else {
            panic!("{fault:?}")
        };
        assert_eq!(*freedom, 1);
        for body in ["`crank`", "`coupler`", "`rocker`"] {
            assert!(bodies.iter().any(|b| b == body), "{bodies:?}");
        }
        assert!(joint_names.len() >= 3, "{joint_names:?}");
        assert_eq!(fault.code(), "HP0301");
    }
}

#[test]
fn a_second_motor_is_over_driven_and_names_both() {
    let mut draft = four_bar(CRANK_ROCKER, "t", &[0.0]);
    draft.drivers.push(driver("second", "D", "0.2*t"));
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let fault = fault(&draft, formulation);
        let TopologyError::OverDriven { driver_names, .. } = &fault else { panic!("{fault:?}") };
        assert_eq!(driver_names, &["`motor`", "`second`"], "{formulation:?}");
        assert_eq!(fault.code(), "HP0302");
        assert_eq!(
            fault.to_string(),
            "the mechanism is over-driven: 2 drivers prescribe 1 degree of freedom"
        );
        assert_eq!(fault.help(), "remove any one of these drivers, or use a joint with more freedom");
    }
}

#[test]
fn the_counts_of_an_over_driven_loop_leave_out_drivers_elsewhere() {
    // The four-bar has one degree of freedom and two motors; the sled beside it has a driver of its own.
    let mut draft = four_bar(CRANK_ROCKER, "t", &[0.0]);
    draft.bodies.push(body("sled"));
    draft.joints.push(joint(
        "rail",
        "translational",
        ["ground", "sled"],
        &[[0.0, 0.0, 1.0]],
        Some([1.0, 0.0, 0.0]),
    ));
    draft.drivers.extend([driver("second", "D", "0.2*t"), driver("pull", "rail", "0.1*t")]);
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let fault = fault(&draft, formulation);
        assert_eq!(
            fault.to_string(),
            "the mechanism is over-driven: 2 drivers prescribe 1 degree of freedom",
            "{formulation:?}"
        );
        assert_eq!(fault.help(), "remove any one of these drivers, or use a joint with more freedom");
    }
    // Of a structure beside the sled, the only driver is one too many.
    draft.drivers.retain(|d| d.name != "second");
    draft.joints.push(joint("lock", "spherical", ["ground", "coupler"], &[[0.1, 0.3, 0.0]], None));
    let fault = fault(&draft, Formulation::Relative);
    assert_eq!(fault.to_string(), "the mechanism is over-driven: 1 driver prescribes 0 degrees of freedom");
}

#[test]
fn a_driven_structure_cannot_move() {
    // A triangle of bars has no motion for its motor.
    let z = Some([0.0, 0.0, 1.0]);
    let draft = Draft {
        name: "triangle".into(),
        bodies: ["a", "b"].map(body).into(),
        joints: vec![
            joint("P", "revolute", ["ground", "a"], &[[0.0, 0.0, 0.0]], z),
            joint("Q", "revolute", ["a", "b"], &[[0.5, 0.8, 0.0]], z),
            joint("R", "revolute", ["b", "ground"], &[[1.0, 0.0, 0.0]], z),
        ],
        drivers: vec![driver("motor", "P", "t")],
        times: vec![0.0],
        ..Draft::default()
    };
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let fault = fault(&draft, formulation);
        let TopologyError::Immovable { joint_names, bodies, .. } = &fault else { panic!("{fault:?}") };
        assert_eq!(bodies, &["`a`", "`b`"]);
        assert!(!joint_names.is_empty());
        assert_eq!(fault.code(), "HP0303");
    }
}

#[test]
fn redundant_constraints_of_a_planar_mechanism_are_counted_and_named() {
    let model = Model::from_draft(&four_bar(CRANK_ROCKER, "t", &[0.0])).unwrap();
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let analysis = Analysis::with(&model, formulation).unwrap();
        assert_eq!(analysis.topology().redundant().count(), 3, "{formulation:?}");
        assert_eq!(analysis.topology().mobility, 1);
    }
}

#[test]
fn a_crank_that_cannot_turn_fully_stops_at_its_limit_and_keeps_its_results() {
    // Non-Grashof: the crank of 0.5 stalls where coupler and rocker (0.4 and 0.3) are stretched out.
    let points = [[0.0, 0.0], [0.3, 0.4], [0.5, 0.3], [0.6, 0.0]];
    let model = Model::from_draft(&four_bar(points, "2*pi*t", &times(1.0, 100))).unwrap();
    let (b, c, d) = (points[1], points[2], points[3]);
    let length = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
    let (a, reach, ground) = (length([0.0; 2], b), length(b, c) + length(c, d), length([0.0; 2], d));
    // At the limit the triangle A B D has the sides a, reach, ground.
    let cosine = (a * a + ground * ground - reach * reach) / (2.0 * a * ground);
    let limit = (cosine.acos() - f64::atan2(b[1], b[0])) / (2.0 * std::f64::consts::PI);
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let solution = Analysis::with(&model, formulation).unwrap().run();
        let stop = solution.stop.expect("the crank cannot turn fully");
        assert_eq!(stop.kind, StopKind::Limit, "{stop:?}");
        assert!((stop.failed_time - limit).abs() < 1e-6, "{} {limit}", stop.failed_time);
        assert_eq!(solution.motion.len(), (limit * 100.0) as usize + 1);
        assert!(stop.joints.len() >= 3);
        assert!(solution.motion.states().all(|s| s.r.is_finite() && s.a.is_finite()));
    }
}

#[test]
fn a_parallelogram_stops_at_its_change_point() {
    let model = Model::from_draft(&four_bar(
        [[0.0, 0.0], [0.0, 0.2], [0.5, 0.2], [0.5, 0.0]],
        "2*pi*t",
        &times(1.0, 90),
    ))
    .unwrap();
    let stop = Analysis::new(&model).unwrap().run().stop.expect("flat at a quarter turn");
    assert_eq!(stop.kind, StopKind::BranchChange);
    assert!((stop.failed_time - 0.25).abs() < 1e-4, "{stop:?}");
}

#[test]
fn a_rocker_driven_back_and_forth_stays_on_its_branch() {
    let model = Model::from_draft(&four_bar(CRANK_ROCKER, "2*pi*t", &times(3.0, 60))).unwrap();
    let solution = Analysis::new(&model).unwrap().run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    let rocker = solution.measured.index("rocker").unwrap();
    for k in 0..=20 {
        let [a, b, c] = [0, 20, 40].map(|turn| solution.measured.value(k + turn, rocker)[0]);
        assert!((a - b).abs() < 1e-11 && (a - c).abs() < 1e-11);
    }
}

#[test]
fn a_planar_linkage_with_a_tilted_pin_locks() {
    let mut draft = four_bar(CRANK_ROCKER, "2*pi*t", &times(1.0, 50));
    draft.joints[2].axis = Some(DirectionDraft::Along([0.0, 0.02, 1.0].into()));
    let model = Model::from_draft(&draft).unwrap();
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        // Tilted by a degree, it has no motion at all: found already at the design configuration.
        let fault = Analysis::with(&model, formulation).unwrap_err();
        assert!(matches!(fault, TopologyError::Immovable { .. }), "{fault:?}");
    }
}

#[test]
fn a_law_without_a_value_is_a_fault_of_the_model() {
    let faults = Model::from_draft(&four_bar(CRANK_ROCKER, "sqrt(t - 1)", &[0.0, 2.0])).unwrap_err();
    assert_eq!(faults[0].code, "HP0214");
    assert!(faults[0].message.contains("t = 0"), "{}", faults[0].message);
}

#[test]
fn a_law_that_jumps_between_two_output_times_ends_the_run_there() {
    // 1/(t - 0.5)^2 is finite at all output times, and asks for the impossible in between.
    let model = Model::from_draft(&four_bar(CRANK_ROCKER, "1e-3/(t - 0.505)^2", &times(1.0, 100))).unwrap();
    let solution = Analysis::new(&model).unwrap().run();
    if let Some(stop) = solution.stop {
        assert!(stop.failed_time > 0.45 && stop.failed_time < 0.56, "{stop:?}");
    }
    assert!(solution.motion.states().all(|s| s.a.is_finite()));
}

#[test]
fn an_interrupted_run_keeps_its_results() {
    let model = Model::from_draft(&four_bar(CRANK_ROCKER, "2*pi*t", &times(1.0, 100))).unwrap();
    let solution = Analysis::new(&model).unwrap().solve(Run::new().progress(|p| {
        if p.done == 10 { std::ops::ControlFlow::Break(()) } else { std::ops::ControlFlow::Continue(()) }
    }));
    assert_eq!(solution.motion.len(), 10);
    assert_eq!(solution.stop.unwrap().kind, StopKind::Interrupted);
}

#[test]
fn a_law_with_a_corner_is_followed_around_it() {
    // A triangle wave: the speed of the drive jumps twice, which no output time hits.
    for law in ["asin(sin(2*pi*t + 0.1)) - 0.1", "abs(t - 0.503)", "if(t < 0.4142, t, 0.8284 - t)"] {
        let model = Model::from_draft(&four_bar(CRANK_ROCKER, law, &times(1.0, 7))).unwrap();
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            let solution = Analysis::with(&model, formulation).unwrap().run();
            assert!(solution.stop.is_none(), "{law}: {:?}", solution.stop);
            assert!(solution.motion.effort.worst_residual < 1e-12);
        }
    }
}

#[test]
fn a_start_out_of_reach_is_reported() {
    let points = [[0.0, 0.0], [0.3, 0.4], [0.5, 0.3], [0.6, 0.0]];
    let model = Model::from_draft(&four_bar(points, "3 + t", &times(1.0, 10))).unwrap();
    let solution = Analysis::new(&model).unwrap().run();
    let stop = solution.stop.expect("3 rad are beyond the limit");
    assert!(solution.motion.is_empty() && stop.last_time.is_none());
    assert_eq!(stop.headline(&model), "the mechanism does not reach its start position at t = 0 s");
    assert!(stop.drivers[0] > 0.01 && stop.drivers[0] < 3.0, "{stop:?}");
}

/// A crank and a rocker in skew planes, tied by a rod that is a body between two balls.
fn rod_between_balls() -> Draft {
    Draft {
        name: "rod between balls".into(),
        bodies: ["crank", "rod", "rocker"].map(body).into(),
        joints: vec![
            joint("A", "revolute", ["ground", "crank"], &[[0.0; 3]], Some([0.0, 0.0, 1.0])),
            joint("B", "spherical", ["crank", "rod"], &[[0.0, 0.1, 0.0]], None),
            joint("C", "spherical", ["rod", "rocker"], &[[0.3, 0.2, 0.15]], None),
            joint("D", "revolute", ["ground", "rocker"], &[[0.3, 0.0, 0.0]], Some([1.0, 0.0, -0.5])),
        ],
        drivers: vec![driver("motor", "A", "0.5*sin(t)")],
        times: times(3.0, 30),
        ..Draft::default()
    }
}

#[test]
fn an_idle_rotation_of_a_rod_is_fixed_and_no_error() {
    let model = Model::from_draft(&rod_between_balls()).unwrap();
    let [idle] = &model.idle[..] else { panic!("{:?}", model.idle) };
    assert_eq!(idle.bodies, [model.body("rod").unwrap()]);
    assert_eq!(model.joints[idle.joint.0].name, "B");
    let along = Vec3::new(0.3, 0.1, 0.15).unit().unwrap();
    assert!(idle.axis.cross(along).norm() < 1e-12);
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let analysis = Analysis::with(&model, formulation).unwrap();
        assert_eq!((analysis.topology().mobility, analysis.topology().redundant().count()), (1, 0));
        let solution = analysis.run();
        assert!(solution.stop.is_none(), "{:?}", solution.stop);
        // The rod does all that it must: its ends are the balls. It spins no faster than its neighbours turn.
        let rod = idle.bodies[0];
        for k in 0..solution.motion.len() {
            let state = solution.body(k, rod);
            assert!(state.omega.norm() < 1.0, "{:?}", state.omega);
        }
    }
    // The same mechanism with the rod as a constraint moves alike.
    let mut massless = rod_between_balls();
    massless.bodies.remove(1);
    massless.joints.drain(1..3);
    let ends = [[0.0, 0.1, 0.0], [0.3, 0.2, 0.15]];
    massless.joints.push(joint("rod", "distance", ["crank", "rocker"], &ends, None));
    let massless = Model::from_draft(&massless).unwrap();
    assert!(massless.idle.is_empty());
    let (a, b) = (Analysis::new(&model).unwrap().run(), Analysis::new(&massless).unwrap().run());
    for k in 0..a.motion.len() {
        let [x, y] = [(&a, &model), (&b, &massless)].map(|(s, m)| s.body(k, m.body("rocker").unwrap()));
        assert!(apart(x.omega, y.omega) < 1e-11 && apart(x.alpha, y.alpha) < 1e-10);
    }
}

#[test]
fn redundant_constraints_are_reported_with_equivalent_ones() {
    let draft = four_bar([[0.0, 0.0], [0.0, 0.1], [0.3, 0.25], [0.3, 0.0]], "t", &times(1.0, 2));
    let model = Model::from_draft(&draft).unwrap();
    let analysis = Analysis::new(&model).unwrap();
    let redundancies = analysis.topology().redundancies(&model);
    assert_eq!(redundancies.len(), 3);
    for r in redundancies {
        // In a plane every hinge says that the others' axes are parallel and that nothing leaves the plane.
        assert!(analysis.topology().row_name(&model, r.row).starts_with('`'));
        for row in r.implied_by {
            assert!(analysis.topology()[row].selected);
        }
    }
}

#[test]
fn the_margin_of_a_slider_crank_driven_at_its_slide_is_the_sine_of_its_transmission_angle() {
    // A leg of constant direction pushes a bar about its pivot: one unknown, and the angle between bar and leg decides.
    let z = Some([0.0, 0.0, 1.0]);
    let draft = Draft {
        name: "flap".into(),
        bodies: vec![body("bar")],
        joints: vec![
            joint("pivot", "revolute", ["ground", "bar"], &[[0.0; 3]], z),
            joint("leg", "leg", ["ground", "bar"], &[[1.0, -1.0, 0.0], [1.0, 0.0, 0.0]], None),
        ],
        drivers: vec![driver("push", "leg", "0.1*t")],
        times: times(1.0, 10),
        ..Draft::default()
    };
    let model = Model::from_draft(&draft).unwrap();
    let solution = Analysis::new(&model).unwrap().run();
    for (k, margin) in solution.motion.margins.iter().enumerate() {
        let bar = solution.body(k, BodyId(1)).rotation.cols[0];
        let leg = (bar - Vec3::new(1.0, -1.0, 0.0)).unit().unwrap();
        assert!((margin.value - bar.cross(leg).norm()).abs() < 1e-12, "{margin:?}");
    }
}

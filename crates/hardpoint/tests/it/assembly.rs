//! Mechanisms that are open in the design configuration: closed along a path, or reported why not.

use hardpoint::motion::{Closing, StopKind};
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Solution};
use hardpoint::{draft::*, model::*};
use hardpoint_study::verify::{self, verify};

use crate::workbench::*;

/// A four-bar whose coupler is a rod of a given length; by its hardpoints it is sqrt(0.3^2 + 0.15^2) = 0.3354 long.
fn with_a_rod_of(length: f64) -> Draft {
    let z = Some([0.0, 0.0, 1.0]);
    let rod = joint("rod", "distance", ["crank", "rocker"], &[[0.0, 0.1, 0.0], [0.3, 0.25, 0.0]], None)
        .length(length);
    Draft {
        name: "four-bar with a rod".into(),
        bodies: ["crank", "rocker"].map(body).into(),
        joints: vec![
            joint("A", "revolute", ["ground", "crank"], &[[0.0; 3]], z),
            joint("D", "revolute", ["ground", "rocker"], &[[0.3, 0.0, 0.0]], z),
            rod,
        ],
        drivers: vec![driver("motor", "A", "0.5*sin(t)")],
        design: vec![VariableDraft::new("longer", [ChangeDraft::Length { joint: "rod".into(), rate: 1.0 }])],
        points: vec![PointDraft::new("C", "rocker", [0.3, 0.25, 0.0])],
        times: times(2.0, 20),
        ..Draft::default()
    }
}

fn run(draft: &Draft, formulation: Formulation) -> Solution {
    let model = Model::from_draft(draft).unwrap();
    Analysis::with(&model, formulation).unwrap().run()
}

fn point(solution: &Solution, k: usize, name: &str) -> Vec3 {
    let m = ["x", "y", "z"].map(|c| solution.measured.index(&format!("{name}.{c}")).unwrap());
    Vec3::from(m.map(|m| solution.measured.value(k, m)[0]))
}

#[test]
fn a_rod_that_is_too_long_turns_the_rocker_to_where_it_fits() {
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let model = Model::from_draft(&with_a_rod_of(0.4)).unwrap();
        let analysis = Analysis::with(&model, formulation).unwrap();
        let solution = analysis.run();
        assert!(solution.stop.is_none(), "{:?}", solution.stop);
        // At t = 0 the crank is in the design configuration: C is 0.4 from B = (0, 0.1) and 0.25 from D = (0.3, 0), on
        // the upper side.
        let c = point(&solution, 0, "C");
        assert!(((c - Vec3::new(0.0, 0.1, 0.0)).norm() - 0.4).abs() < 1e-12);
        assert!(((c - Vec3::new(0.3, 0.0, 0.0)).norm() - 0.25).abs() < 1e-12 && c.y > 0.2);
        let assembly = solution.motion.assembly.as_ref().unwrap();
        assert_eq!(assembly.gaps.len(), 1);
        assert!(matches!(assembly.gaps[0].of, Closing::Joint(JointId(2))));
        assert!((assembly.gaps[0].size - (0.4 - 0.1125_f64.sqrt())).abs() < 1e-12);
        let [moved] = &assembly.moved[..] else { panic!("{:?}", assembly.moved) };
        assert_eq!(model.bodies[moved.body.0].name, "rocker");
        let turned = (c - Vec3::new(0.3, 0.0, 0.0)).norm().recip() * (c.x - 0.3);
        assert!((moved.angle - turned.asin()).abs() < 1e-9, "{moved:?}");
        let checks =
            verify(
                &analysis,
                &solution,
                &verify::Options::default(),
                |_| std::ops::ControlFlow::Continue(()),
            );
        assert!(checks.checks[0].worst().unwrap().error < 1e-8);
    }
}

#[test]
fn assembling_an_assembled_mechanism_changes_nothing() {
    let drawn = run(&with_a_rod_of(0.1125_f64.sqrt()), Formulation::Relative);
    assert_eq!(drawn.motion.assembly, None);
    let mut measured = with_a_rod_of(1.0);
    measured.joints[2].length = None;
    measured.design.clear();
    let measured = run(&measured, Formulation::Relative);
    for k in 0..drawn.motion.len() {
        assert!(apart(point(&drawn, k, "C"), point(&measured, k, "C")) < 1e-13);
    }
    for name in REFERENCES {
        let solution = Analysis::new(&reference(name)).unwrap().run();
        assert_eq!(solution.motion.assembly, None, "{name}");
    }
}

#[test]
fn joints_open_in_the_design_configuration_are_closed() {
    let mut draft = four_bar([[0.0, 0.0], [0.0, 0.1], [0.3, 0.25], [0.3, 0.0]], "sin(t)", &times(1.0, 5));
    let c = draft.joints.iter_mut().find(|j| j.name == "C").unwrap();
    c.at.push(LocationDraft::At(Vec3::new(0.31, 0.27, 0.0)));
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let solution = run(&draft, formulation);
        assert!(solution.stop.is_none(), "{:?}", solution.stop);
        let assembly = solution.motion.assembly.unwrap();
        assert_eq!(assembly.moved.len(), 2, "the coupler and the rocker: {assembly:?}");
    }
}

#[test]
fn a_rod_that_cannot_reach_is_reported_with_its_gap() {
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let draft = with_a_rod_of(0.7);
        let solution = run(&draft, formulation);
        let stop = solution.stop.unwrap();
        assert_eq!(stop.kind, StopKind::DoesNotAssemble);
        assert_eq!(stop.code(), "HP0406");
        let closed = stop.closed.unwrap();
        assert!(closed > 0.1 && closed < 1.0, "{closed}");
        // The crank stays at its driver's zero, so the rod reaches from B = (0, 0.1) past D by the rocker's 0.25.
        let reach = 0.1_f64.sqrt() + 0.25;
        if formulation == Formulation::Relative {
            assert!((stop.remains[0].size - (0.7 - reach)).abs() < 1e-6, "{:?}", stop.remains);
            assert_eq!(stop.remains[0].of, Closing::Joint(JointId(2)));
        }
        assert!(!stop.remains.is_empty());
    }
}

/// Crank, rod and rocker drawn in one line, turned by an angle about z; the rod is given another length.
fn flat(angle: f64, off_line: f64) -> Draft {
    let z = Some([0.0, 0.0, 1.0]);
    let (sin, cos) = angle.sin_cos();
    let at = |x: f64, y: f64| [x * cos - y * sin, x * sin + y * cos, 0.0];
    let ends = [at(0.1, 0.0), at(0.25, off_line)];
    Draft {
        name: "flat four-bar".into(),
        bodies: ["crank", "rocker"].map(body).into(),
        joints: vec![
            joint("A", "revolute", ["ground", "crank"], &[[0.0; 3]], z),
            joint("D", "revolute", ["ground", "rocker"], &[at(0.3, 0.0)], z),
            joint("rod", "distance", ["crank", "rocker"], &ends, None).length(0.17),
        ],
        drivers: vec![driver("motor", "A", "0.2*t")],
        measures: vec![MeasureDraft::new("rocker", "D")],
        times: times(1.0, 2),
        ..Draft::default()
    }
}

#[test]
fn mirror_images_of_a_flat_drawing_are_counted_as_equally_near() {
    // The triangle of rod (0.17), rocker (0.05) and the line from the crank to D (0.2): the rocker turns by its angle.
    let angle = f64::acos((0.2_f64.powi(2) + 0.05_f64.powi(2) - 0.17_f64.powi(2)) / (2.0 * 0.2 * 0.05));
    for turned in [0.0, 1.0, 2.5, 4.0] {
        let solution = run(&flat(turned, 0.0), Formulation::Relative);
        let assembly = solution.motion.assembly.as_ref().unwrap();
        assert_eq!(assembly.equally_near, 2, "{turned}: {assembly:?}");
        let rocker = solution.measured.value(0, solution.measured.index("rocker").unwrap())[0];
        assert!((rocker.abs() - angle).abs() < 1e-9, "{turned}: {rocker}");
        // Drawn a little off the line, it is closed on that side.
        for off_line in [1e-3, -1e-3] {
            let solution = run(&flat(turned, off_line), Formulation::Relative);
            let assembly = solution.motion.assembly.as_ref().unwrap();
            assert!(assembly.equally_near < 2, "{turned}: {assembly:?}");
            let rocker = solution.measured.value(0, solution.measured.index("rocker").unwrap())[0];
            // The rocker points to -x, so that it turns the other way.
            assert!(rocker * off_line < 0.0, "{turned}, {off_line}: {rocker}");
        }
    }
}

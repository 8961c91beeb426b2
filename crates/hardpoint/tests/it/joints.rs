//! Every joint type in a whole mechanism, carried by the tree and cut, against re-solving.

use std::ops::ControlFlow;

use hardpoint::joint::ALL;
use hardpoint::motion::StopKind;
use hardpoint::topology::{Formulation, JointRole, TopologyError};
use hardpoint::{Analysis, Solution};
use hardpoint::{draft::*, model::*};
use hardpoint_study::verify::{self, verify};

use crate::workbench::*;

/// A spatial slider-crank: its slider may turn on its guide, its pin is a ball, and a plate rides on the rod.
fn slider_on_a_shaft() -> Draft {
    let z = Some([0.0, 0.0, 1.0]);
    Draft {
        name: "slider on a shaft".into(),
        bodies: ["crank", "rod", "slider", "plate"].map(body).into(),
        joints: vec![
            joint("J1", "revolute", ["ground", "crank"], &[[0.0, 0.0, 0.0]], z),
            joint("J2", "revolute", ["crank", "rod"], &[[0.12, 0.16, 0.0]], z),
            joint("J3", "spherical", ["rod", "slider"], &[[0.6, 0.05, 0.0]], None),
            joint("J4", "cylindrical", ["ground", "slider"], &[[0.6, 0.0, 0.0]], Some([1.0, 0.0, 0.0])),
            joint("weld", "fixed", ["rod", "plate"], &[[0.3, 0.2, 0.1]], None),
        ],
        drivers: vec![driver("motor", "J1", "sin(2*pi*t)")],
        design: vec![
            marker("J4_ry", "J4", [0.0; 3], [0.0, 1.0, 0.0]),
            marker("J1_rx", "J1", [0.0; 3], [1.0, 0.0, 0.0]),
            marker("J3_y", "J3", [0.0, 1.0, 0.0], [0.0; 3]),
            marker("weld_rz", "weld", [0.0; 3], [0.0, 0.0, 1.0]),
        ],
        points: vec![PointDraft::new("corner", "plate", [0.4, 0.3, 0.2])],
        measures: vec![MeasureDraft::new("spin", ["J4", "angle"])],
        times: times(1.0, 10),
        ..Draft::default()
    }
}

/// A train of shafts, a nut and what hangs on it: the joint types that are rare in linkages, exactly constrained.
fn shaft_train() -> Draft {
    let (s, c) = 30.0_f64.to_radians().sin_cos();
    let shaft = [c, s, 0.0];
    let on_shaft = |x: f64| [x * c, x * s, 0.0];
    let drives = |body: &str, about: [f64; 3]| DrivenDraft::Orientation {
        body: body.into(),
        relative_to: None,
        about: DirectionDraft::Along(about.into()),
        axis2: None,
    };
    let law = |text: &str| hardpoint::law::Law::parse(text).unwrap();
    Draft {
        name: "shaft train".into(),
        bodies: ["in", "out", "nut", "follower", "plate", "vane", "arm"].map(body).into(),
        joints: vec![
            joint("bearing", "revolute", ["ground", "in"], &[[-0.3, 0.0, 0.0]], Some([1.0, 0.0, 0.0])),
            joint("cv", "constant_velocity", ["in", "out"], &[[0.0; 3]], Some([1.0, 0.0, 0.0])).axis2(shaft),
            joint("steady", "inline", ["ground", "out"], &[on_shaft(0.4)], Some(shaft)),
            joint("screw", "screw", ["out", "nut"], &[on_shaft(0.2)], Some(shaft)).lead(0.02),
            joint("key", "dot1", ["ground", "nut"], &[], Some([0.0, 0.0, 1.0])).axis2([-s, c, 0.0]),
            joint("no_turn", "orientation", ["ground", "follower"], &[], None),
            joint(
                "link",
                "revolute_spherical",
                ["nut", "follower"],
                &[on_shaft(0.2), [0.3, 0.45, 0.15]],
                Some([0.1, 0.2, 1.0]),
            ),
            joint("stay", "distance", ["ground", "follower"], &[[0.1, 0.8, 0.1], [0.3, 0.45, 0.2]], None)
                .length((0.04_f64 + 0.1225 + 0.01).sqrt() + 0.01),
            joint("upright", "parallel", ["follower", "plate"], &[], Some([0.1, 0.0, 1.0])),
            joint("tie1", "distance", ["ground", "plate"], &[[0.0, 1.0, 0.0], [0.4, 0.6, 0.3]], None),
            joint("tie2", "distance", ["nut", "plate"], &[on_shaft(0.25), [0.5, 0.7, 0.25]], None),
            joint("socket", "spherical", ["ground", "vane"], &[[0.0, -0.3, 0.1]], None),
            joint("lean", "angle", ["in", "vane"], &[], Some([1.0, 0.3, 0.2])).axis2([0.2, 1.0, 0.4]),
            joint(
                "slab",
                "dot2",
                ["ground", "vane"],
                &[[0.3, -0.3, 0.1], [0.2, -0.2, 0.1]],
                Some([0.0, 0.0, 1.0]),
            ),
            joint("way", "travel", ["ground", "vane"], &[[0.1, -0.2, 0.3]], Some([0.3, 0.0, 1.0])),
            joint("course", "heading", ["nut", "plate"], &[], Some([0.3, 0.0, 1.0])),
            joint("cross", "universal", ["out", "arm"], &[on_shaft(0.4)], Some([0.0, 0.0, 1.0]))
                .axis2([-s, c, 0.0]),
        ],
        drivers: vec![
            driver("motor", "bearing", "1.5*pi*t"),
            DriverDraft::new("yaw", drives("plate", [0.2, 0.1, 1.0]), law("0.3*sin(3*t)")),
            DriverDraft::new("nod", drives("vane", [0.0, 0.1, 1.0]), law("0.2*sin(2*t)")),
            DriverDraft::new(
                "lift",
                DrivenDraft::Position {
                    point: PointRef::On {
                        body: "plate".into(),
                        at: LocationDraft::At([0.5, 0.6, 0.4].into()),
                    },
                    along: DirectionDraft::Along([0.0, 0.3, 1.0].into()),
                },
                law("0.02*sin(4*t)"),
            ),
            DriverDraft::new("pin1", ["cross", "angle"], law("0.4*sin(t)")),
            DriverDraft::new("pin2", ["cross", "angle2"], law("2.5*t")),
        ],
        design: vec![
            marker("cv_y", "cv", [0.0, 1.0, 0.0], [0.0; 3]),
            marker("cv_rz", "cv", [0.0; 3], [0.0, 0.0, 1.0]),
            marker("steady_ry", "steady", [0.0; 3], [0.2, 1.0, 0.0]),
            marker("screw_x", "screw", [1.0, 0.3, 0.0], [0.1, 0.0, 0.2]),
            marker("key_rx", "key", [0.0; 3], [1.0, 0.2, 0.3]),
            marker("no_turn_rx", "no_turn", [0.0; 3], [1.0, 0.2, 0.3]),
            marker("link_z", "link", [0.0, 0.2, 1.0], [0.3, 0.0, 0.0]),
            marker("upright_rx", "upright", [0.0; 3], [1.0, 0.2, 0.0]),
            marker("lean_rz", "lean", [0.0; 3], [0.0, 0.4, 1.0]),
            marker("slab_y", "slab", [0.0, 1.0, 0.3], [0.2, 0.0, 0.0]),
            marker("cross_rx", "cross", [0.0, 0.1, 0.0], [1.0, 0.0, 0.0]),
            VariableDraft::new("stay_longer", [ChangeDraft::Length { joint: "stay".into(), rate: 1.0 }]),
        ],
        points: ["nut", "plate", "vane", "arm"]
            .map(|name| PointDraft::new(format!("on {name}"), name, [0.1, 0.4, 0.3]))
            .into(),
        measures: vec![
            MeasureDraft::new("advance", ["screw", "displacement"]),
            MeasureDraft::new("turn", ["screw", "angle"]),
            MeasureDraft::new("way", "way"),
            MeasureDraft::new("course", "course"),
            MeasureDraft::new("pin2", ["cross", "angle2"]),
        ],
        times: times(1.0, 10),
        ..Draft::default()
    }
}

/// A cam that turns under a roller on a slide, whose arm carries a pin in a slot of a second body.
pub fn cam_and_slot() -> Draft {
    let circle = (0..48).map(|k| {
        let (s, c) = (2.0 * std::f64::consts::PI * k as f64 / 48.0).sin_cos();
        [0.01 + 0.03 * c, 0.03 * s, 0.0]
    });
    let slot = (0..7).map(|k| {
        let x = 0.02 + 0.02 * k as f64;
        [x, 0.15 + 0.2 * (x - 0.08) * (x - 0.08), 0.0]
    });
    let z = Some([0.0, 0.0, 1.0]);
    // The pitch curve of the roller's centre passes through its place in the design configuration: sqrt(0.04^2 -
    // 0.01^2) above the axis.
    let roller = [[0.0; 3], [0.0, 0.0015_f64.sqrt(), 0.01]];
    let cam = joint("cam", "point_on_curve", ["disc", "lifter"], &roller, z).curve(circle, true);
    let pin = joint("pin", "slot", ["lever", "lifter"], &[[0.0, 0.15, 0.0], [0.08, 0.15, 0.0]], z)
        .curve(slot, false);
    Draft {
        name: "cam and slot".into(),
        bodies: ["disc", "lifter", "lever"].map(body).into(),
        joints: vec![
            joint("shaft", "revolute", ["ground", "disc"], &[[0.0; 3]], z),
            joint("slide", "translational", ["ground", "lifter"], &[[0.0, 0.1, 0.0]], Some([0.0, 1.0, 0.0])),
            cam,
            joint("fulcrum", "revolute", ["ground", "lever"], &[[0.0, 0.15, 0.0]], z),
            pin,
        ],
        drivers: vec![DriverDraft::new(
            "motor",
            "shaft",
            hardpoint::law::Law::parse_with("speed*t + swing*sin(3*t)", &[("speed", 9.0), ("swing", 0.1)])
                .unwrap(),
        )],
        design: vec![
            marker("shaft_x", "shaft", [1.0, 0.2, 0.0], [0.0; 3]),
            marker("cam_y", "cam", [0.3, 1.0, 0.0], [0.0, 0.0, 0.5]),
            marker("slide_rz", "slide", [0.0; 3], [0.0, 0.0, 1.0]),
            marker("pin_x", "pin", [1.0, 0.0, 0.0], [0.0, 0.0, 0.3]),
            VariableDraft {
                fixed_length: true,
                ..marker("fulcrum_and_pin", "fulcrum", [0.5, 1.0, 0.0], [0.0; 3])
            },
            VariableDraft::new(
                "swing",
                [ChangeDraft::Law { driver: "motor".into(), parameter: "swing".into(), rate: 1.0 }],
            ),
            VariableDraft::new(
                "speed",
                [ChangeDraft::Law { driver: "motor".into(), parameter: "speed".into(), rate: 1.0 }],
            ),
        ],
        measures: ["slide", "fulcrum"].map(|name| MeasureDraft::new(name, name)).into(),
        times: times(0.9, 18),
        ..Draft::default()
    }
}

#[test]
fn a_cam_and_a_slot_move_as_they_must_and_match_resolved_designs() {
    let model = Model::from_draft(&cam_and_slot()).unwrap();
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let analysis = Analysis::with(&model, formulation).unwrap();
        let solution = analysis.run();
        assert!(solution.stop.is_none(), "{:?}", solution.stop);
        let report = verify(&analysis, &solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
        for check in report.checks.iter().filter(|c| c.worst().is_some()) {
            let worst = check.worst().unwrap();
            assert!(
                worst.error < AS_DIFFERENCES_SEE,
                "{}: {worst:?}",
                model.variables[check.variable.0].name
            );
        }
        assert!(report.checks.iter().filter(|c| c.worst().is_some()).count() >= 6);
        // An eccentric disc of radius 30 mm, 10 mm off its axis, under a roller of 10 mm.
        let [slide, lever] = ["slide", "fulcrum"].map(|m| solution.measured.index(m).unwrap());
        for k in 0..solution.motion.len() {
            let t = solution.motion.times[k];
            let (s, c) = (9.0 * t + 0.1 * (3.0 * t).sin()).sin_cos();
            let lift = 0.01 * s + (0.0016 - 1e-4 * c * c).sqrt() - 0.0015_f64.sqrt();
            assert!((solution.measured.value(k, slide)[0] - lift).abs() < 1e-8, "t = {t}");
            // The pin rises with the lifter; the lever turns until its slot, y = 0.2 (x - 0.08)^2 on it, passes through
            // it.
            let (sin, cos) = solution.measured.value(k, lever)[0].sin_cos();
            let (x, y) = (0.08 * cos + lift * sin, -0.08 * sin + lift * cos);
            assert!((y - 0.2 * (x - 0.08).powi(2)).abs() < 1e-7, "t = {t}");
        }
    }
}

#[test]
fn a_pin_that_reaches_the_end_of_its_slot_stops_there_and_keeps_its_results() {
    let mut draft = cam_and_slot();
    // The cam lifts the pin by some 20 mm; a lever that is driven by 60 deg would pull it out.
    draft.joints.retain(|j| j.name != "cam" && j.name != "shaft");
    draft.bodies.remove(0);
    draft.drivers = vec![driver("lever", "fulcrum", "t")];
    draft.design.clear();
    draft.times = times(1.2, 24);
    let model = Model::from_draft(&draft).unwrap();
    let solution = Analysis::new(&model).unwrap().run();
    let stop = solution.stop.unwrap();
    assert!(solution.motion.len() > 10 && solution.motion.len() < 25, "{}", solution.motion.len());
    assert_eq!(stop.kind, StopKind::CurveEnd { joint: joint_named(&model, "pin") });
}

fn joint_named(model: &Model, name: &str) -> JointId {
    JointId(model.joints.iter().position(|j| j.name == name).unwrap())
}

/// A point on a curve of ground, moved along x by a driver and free along y: `from` is its place.
fn point_on(curve: Vec<[f64; 3]>, closed: bool, from: [f64; 3], law: &str) -> Draft {
    let at = [[0.0; 3], from];
    let con =
        joint("con", "point_on_curve", ["ground", "lift"], &at, Some([0.0, 0.0, 1.0])).curve(curve, closed);
    Draft {
        name: "point on a curve".into(),
        bodies: ["cart", "lift"].map(body).into(),
        joints: vec![
            joint("x", "translational", ["ground", "cart"], &[[0.0; 3]], Some([1.0, 0.0, 0.0])),
            joint("y", "translational", ["cart", "lift"], &[[0.0; 3]], Some([0.0, 1.0, 0.0])),
            con,
        ],
        drivers: vec![driver("m", "x", law)],
        measures: vec![MeasureDraft::new("y", "y")],
        times: times(1.0, 5),
        ..Draft::default()
    }
}

fn circle(centre: f64, radius: f64) -> Vec<[f64; 3]> {
    let angle = |k: i32| 2.0 * std::f64::consts::PI * f64::from(k) / 48.0;
    (0..48).map(|k| [centre + radius * angle(k).cos(), radius * angle(k).sin(), 0.0]).collect()
}

#[test]
fn a_point_that_runs_off_an_open_curve_stops_at_its_end() {
    // y = 10 x^2 up to x = 0.05, from the vertex and from the very end.
    let parabola =
        || (-5..=5).map(|k| f64::from(k) * 0.01).map(|x| [x, 10.0 * x * x, 0.0]).collect::<Vec<_>>();
    for (from, law, end) in [
        ([0.0; 3], "0.052*t", 0.05 / 0.052),
        ([0.05, 0.025, 0.0], "1e-5*t", 0.0),
        ([0.0; 3], "-0.06*t", 5.0 / 6.0),
    ] {
        let model = Model::from_draft(&point_on(parabola(), false, from, law)).unwrap();
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            let stop = Analysis::with(&model, formulation).unwrap().run().stop.unwrap();
            assert_eq!(stop.kind, StopKind::CurveEnd { joint: joint_named(&model, "con") }, "{law}");
            assert!((stop.failed_time - end).abs() < 1e-5, "{law}: {}", stop.failed_time);
            assert_eq!(stop.code(), "HP0401");
        }
        let stop = Analysis::new(&model).unwrap().run().stop.unwrap();
        let text = stop.headline(&model);
        assert!(text.starts_with("the point of `con` reaches the end of its curve at t = "), "{text}");
    }
}

#[test]
fn a_dead_point_on_a_curve_is_singular_and_not_under_driven() {
    // At the outermost point of the circle the tangent is along y; a rod of the same radius is singular there, too.
    let on_curve = point_on(circle(0.0, 0.03), true, [0.03, 0.0, 0.0], "-0.005*t");
    let mut on_rod = on_curve.clone();
    on_rod.joints[2] = joint("con", "distance", ["ground", "lift"], &[[0.0; 3], [0.03, 0.0, 0.0]], None);
    for draft in [on_curve, on_rod] {
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            let model = Model::from_draft(&draft).unwrap();
            let fault = Analysis::with(&model, formulation).unwrap_err();
            assert!(
                matches!(fault, TopologyError::Singular { freedom: 1, .. }),
                "{formulation:?}: {fault:?}"
            );
        }
    }
    // Without its driver it is free anywhere.
    let mut free = point_on(circle(0.0, 0.03), true, [0.03 * 0.6, 0.03 * 0.8, 0.0], "t");
    free.drivers.clear();
    let fault = Analysis::new(&Model::from_draft(&free).unwrap()).unwrap_err();
    assert!(matches!(fault, TopologyError::UnderDriven { freedom: 1, .. }), "{fault:?}");
}

/// An eccentric disc of radius 30 mm under a roller of 10 mm on a swinging arm.
fn cam_and_arm(roller: [f64; 3]) -> Draft {
    let z = Some([0.0, 0.0, 1.0]);
    let cam = joint("cam", "point_on_curve", ["disc", "arm"], &[[0.0; 3], roller], z);
    Draft {
        name: "cam and arm".into(),
        bodies: ["disc", "arm"].map(body).into(),
        joints: vec![
            joint("shaft", "revolute", ["ground", "disc"], &[[0.0; 3]], z),
            joint("pivot", "revolute", ["ground", "arm"], &[ARM_PIVOT], z),
            cam.curve(circle(ECCENTRICITY, 0.03), true),
        ],
        drivers: vec![driver("motor", "shaft", "t")],
        measures: vec![MeasureDraft::new("pivot", "pivot")],
        times: times(6.0, 24),
        ..Draft::default()
    }
}

const ARM_PIVOT: [f64; 3] = [0.07, 0.01, 0.0];
const ECCENTRICITY: f64 = 0.01;
/// Length of the arm, m, of rollers that touch the disc.
const ARM: f64 = 0.06;

/// Direction of the arm at an angle of the shaft, rad, where the circles about the disc's centre and about the pivot
/// intersect, on either side of the line between them.
fn arm_at(shaft: f64, side: f64) -> f64 {
    let [x, y] = [ECCENTRICITY * shaft.cos() - ARM_PIVOT[0], ECCENTRICITY * shaft.sin() - ARM_PIVOT[1]];
    let d = x.hypot(y);
    // Cosine rule in the triangle of arm, centres and disc with roller (40 mm).
    y.atan2(x) + side * ((ARM * ARM + d * d - 0.04 * 0.04) / (2.0 * ARM * d)).acos()
}

#[test]
fn a_start_on_the_other_contact_of_a_cam_is_followed_there() {
    for drawn in [-1.0, 1.0] {
        let angle = arm_at(0.0, drawn);
        let [x, y, _] = ARM_PIVOT;
        let draft = cam_and_arm([x + ARM * angle.cos(), y + ARM * angle.sin(), 0.0]);
        let model = Model::from_draft(&draft).unwrap();
        let pivot = hardpoint::space::Vec3::from(ARM_PIVOT);
        // At the other contact, and some degrees beside it.
        for off in [0.0, 0.05, -0.05] {
            let turn = arm_at(0.0, -drawn) - angle + off;
            let turned =
                StartPlacement::new(BodyId(2), [0.0, 0.0, turn].into(), hardpoint::space::Vec3::ZERO);
            let shift = pivot - turned.displacement.point(pivot);
            let start = StartPlacement::new(BodyId(2), [0.0, 0.0, turn].into(), shift);
            for (model, side) in [(&model, drawn), (&model.starting_at(&[start]), -drawn)] {
                for formulation in [Formulation::Relative, Formulation::Absolute] {
                    let solution = Analysis::with(model, formulation).unwrap().run();
                    assert!(solution.stop.is_none(), "{drawn} {off} {formulation:?}: {:?}", solution.stop);
                    for (k, t) in draft.times.iter().enumerate() {
                        let found = solution.measured.value(k, solution.measured.index("pivot").unwrap())[0];
                        let error = (found + angle - arm_at(*t, side)).sin();
                        // The spline deviates from the circle by less than this.
                        assert!(error.abs() < 1e-6, "{drawn} {off} {formulation:?} at {t}: {found}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_length_of_a_point_on_its_curve_has_no_side() {
    let with_length = |place: f64| {
        let mut draft = cam_and_arm([ECCENTRICITY, place, 0.0]);
        draft.joints[2] = draft.joints[2].clone().length(0.01);
        Model::from_draft(&draft)
    };
    for on_curve in [0.03, 0.03 + 1e-9, 0.03 - 1e-9] {
        let faults = with_length(on_curve).unwrap_err();
        assert_eq!(faults.iter().map(|f| f.code).collect::<Vec<_>>(), ["HP0223"], "{faults:?}");
        assert!(faults[0].message.contains("`cam` has no side"), "{faults:?}");
    }
    // Drawn beside the curve, the roller is assembled on that side.
    for (place, radius) in [(0.031, 0.04), (0.029, 0.02)] {
        let model = with_length(place).unwrap();
        let solution = Analysis::new(&model).unwrap().run();
        let turned = solution.measured.value(0, solution.measured.index("pivot").unwrap())[0];
        let [x, y] = [ECCENTRICITY - ARM_PIVOT[0], place - ARM_PIVOT[1]];
        let angle = y.atan2(x) + turned;
        let [x, y] =
            [x.hypot(y) * angle.cos() + ARM_PIVOT[0] - ECCENTRICITY, x.hypot(y) * angle.sin() + ARM_PIVOT[1]];
        assert!((x.hypot(y) - radius).abs() < 1e-6, "{place}: {}", x.hypot(y));
    }
}

/// Positions hold to 1e-13; differences over the best step (1e-5) see that.
const AS_DIFFERENCES_SEE: f64 = 5e-8;

/// Every variable's sensitivities are those of designs that are solved anew, to this.
fn assert_as_resolved(analysis: &Analysis<'_>, solution: &Solution, within: f64) {
    let report = verify(analysis, solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
    for check in &report.checks {
        let worst = check.worst().unwrap();
        assert!(worst.error < within, "{}: {worst:?}", analysis.model().variables[check.variable.0].name);
    }
}

/// A Whitworth quick return: the pin of a crank of 60 mm slides in the slot of an arm whose bearing lies 30 mm below
/// the crank's.
fn quick_return() -> Draft {
    let z = [0.0, 0.0, 1.0];
    Draft::new("quick return")
        .hardpoint("O", [0.0, 0.03, 0.0])
        .hardpoint("A", [0.0, 0.0, 0.0])
        .hardpoint("P", [0.06, 0.03, 0.0])
        .bodies(["crank", "arm"])
        .revolute("O", ["ground", "crank"], "O", z)
        .revolute("A", ["ground", "arm"], "A", z)
        .joint(JointDraft::new("slot", "pin_in_slot", ["arm", "crank"]).at("P").axis(z).axis2(["A", "P"]))
        .driver("motor", "O", hardpoint::law::Law::parse("7*t").unwrap())
        .variable_moving("bearing_y", "O", [0.0, 1.0, 0.0])
        .variable_moving("pin_x", "P", [1.0, 0.0, 0.0])
        .variable_moving("arm_x", "A", [1.0, 0.3, 0.0])
        .variable(marker("slot_rz", "slot", [0.0; 3], z))
        .measure("arm", "A")
        .measure("slide", ["slot", "displacement"])
        .measure("pin", ["slot", "angle"])
        .times(times(1.3, 26))
}

#[test]
fn a_pin_in_a_slot_moves_as_it_must_and_matches_resolved_designs() {
    let model = Model::from_draft(&quick_return()).unwrap();
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let analysis = Analysis::with(&model, formulation).unwrap();
        let solution = analysis.run();
        assert!(solution.stop.is_none(), "{:?}", solution.stop);
        assert_as_resolved(&analysis, &solution, AS_DIFFERENCES_SEE);
        let [arm, slide, pin] = ["arm", "slide", "pin"].map(|m| solution.measured.index(m).unwrap());
        let place = |angle: f64| (0.06 * angle.cos(), 0.03 + 0.06 * angle.sin());
        let (far, heading) = (place(0.0).0.hypot(place(0.0).1), place(0.0).1.atan2(place(0.0).0));
        for k in 0..solution.motion.len() {
            let angle = 7.0 * solution.motion.times[k];
            let (x, y) = place(angle);
            let turned = solution.measured.value(k, arm)[0];
            // The slot points at the pin: of the arm's whole turns only the sine counts here.
            assert!((y.atan2(x) - heading - turned).sin().abs() < 1e-10, "t = {}", solution.motion.times[k]);
            assert!((solution.measured.value(k, slide)[0] - (x.hypot(y) - far)).abs() < 1e-12);
            assert!((solution.measured.value(k, pin)[0] - (angle - turned)).abs() < 1e-9);
        }
    }
}

#[test]
fn a_train_of_rare_joints_matches_resolved_designs_in_both_formulations() {
    let model = Model::from_draft(&shaft_train()).unwrap();
    let mut solutions = Vec::new();
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let analysis = Analysis::with(&model, formulation).unwrap();
        assert_eq!(analysis.topology().redundant().count(), 0);
        let solution = analysis.run();
        assert!(solution.stop.is_none(), "{:?}", solution.stop);
        assert_as_resolved(&analysis, &solution, AS_DIFFERENCES_SEE);
        // Homokinetic: the nut, kept from turning about the output shaft, sees the motor's own turns. A screw of 20 mm.
        let [turn, advance, pin2] = ["turn", "advance", "pin2"].map(|m| solution.measured.index(m).unwrap());
        for k in 0..solution.motion.len() {
            let [turn, turn_d, turn_dd] = solution.measured.value(k, turn);
            let t = solution.motion.times[k];
            assert!((turn + 1.5 * std::f64::consts::PI * t).abs() < 1e-9, "{turn}");
            assert!((turn_d + 1.5 * std::f64::consts::PI).abs() < 1e-9 && turn_dd.abs() < 1e-8);
            let [x, x_d, _] = solution.measured.value(k, advance);
            let per_turn = 0.02 / (2.0 * std::f64::consts::PI);
            assert!((x - per_turn * turn).abs() < 1e-12 && (x_d - per_turn * turn_d).abs() < 1e-12);
            assert!((solution.measured.value(k, pin2)[0] - 2.5 * t).abs() < 1e-9);
        }
        solutions.push(solution);
    }
    let d = largest_difference(&solutions[0], &solutions[1]);
    assert!(d < 1e-10, "{d:e}");
}

fn marker(name: &str, joint: &str, position: [f64; 3], rotation: [f64; 3]) -> VariableDraft {
    let change = ChangeDraft::Marker {
        joint: joint.into(),
        end: End::Both,
        position: position.into(),
        rotation: rotation.into(),
    };
    VariableDraft::new(name, [change])
}

pub fn mechanisms() -> Vec<Draft> {
    REFERENCES
        .iter()
        .map(|n| reference_draft(n))
        .chain([slider_on_a_shaft(), shaft_train(), cam_and_slot(), quick_return()])
        .collect()
}

#[test]
fn every_joint_type_is_in_a_mechanism_that_is_tested() {
    for t in ALL {
        assert!(
            mechanisms().iter().any(|m| m.joints.iter().any(|j| j.kind == t.name)),
            "add a mechanism with a {} joint to this battery",
            t.name
        );
    }
}

fn largest_difference(a: &Solution, b: &Solution) -> f64 {
    let mut worst = 0.0_f64;
    for k in 0..a.motion.len() {
        for (m, _) in a.measured.outputs.iter().enumerate() {
            let scale = 1.0 + a.measured.value(k, m)[2].abs();
            for o in 0..3 {
                worst = worst.max((a.measured.value(k, m)[o] - b.measured.value(k, m)[o]).abs() / scale);
            }
            for v in (0..a.sensitivities.variables).map(VariableId) {
                if a.sensitivities.at(k, v.0).is_some() {
                    let (x, y) = (a.measured.d(k, v, m), b.measured.d(k, v, m));
                    let scale = 1.0 + x[2].abs();
                    worst = (0..3).map(|o| (x[o] - y[o]).abs() / scale).fold(worst, f64::max);
                }
            }
        }
    }
    worst
}

#[test]
fn it_makes_no_difference_which_joint_is_cut() {
    for draft in mechanisms() {
        let nominal = Model::from_draft(&draft).unwrap();
        let want = Analysis::new(&nominal).unwrap().run();
        let mut tried = 0;
        for k in 0..draft.joints.len() {
            let mut other = draft.clone();
            other.joints[k].cut = true;
            let model = Model::from_draft(&other).unwrap();
            let analysis = Analysis::new(&model).unwrap();
            if analysis.topology().roles == Analysis::new(&nominal).unwrap().topology().roles {
                continue;
            }
            tried += 1;
            assert!(matches!(analysis.topology().roles[k], JointRole::Cut(_)));
            let got = analysis.run();
            let d = largest_difference(&want, &got);
            assert!(d < 1e-10, "{}: cut at `{}`: {d:e}", draft.name, draft.joints[k].name);
        }
        assert!(tried >= 1, "{}", draft.name);
    }
}

#[test]
fn a_spatial_slider_crank_matches_resolved_designs_in_both_formulations() {
    let model = Model::from_draft(&slider_on_a_shaft()).unwrap();
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let analysis = Analysis::with(&model, formulation).unwrap();
        assert_eq!(analysis.topology().redundant().count(), 0);
        let solution = analysis.run();
        assert!(solution.stop.is_none());
        assert_as_resolved(&analysis, &solution, 1e-8);
        // Turning the guide turns the slider on it: not a planar mechanism any more.
        let spin = solution.measured.index("spin").unwrap();
        let tilt = model.variable("J1_rx").unwrap();
        let most = (0..solution.motion.len())
            .map(|k| solution.measured.d(k, tilt, spin)[0].abs())
            .fold(0.0, f64::max);
        assert!(most > 0.1, "{most}");
    }
}

#[test]
fn angles_are_counted_through_whole_turns_in_the_tree_and_across_a_cut() {
    let mut draft = four_bar([[0.0, 0.0], [0.0, 0.1], [0.3, 0.25], [0.3, 0.0]], "2*pi*t", &times(3.0, 90));
    let measure = |name: &str| MeasureDraft::new(name, name);
    draft.measures = ["A", "B", "C", "D"].map(measure).into();
    let model = Model::from_draft(&draft).unwrap();
    let turn = 2.0 * std::f64::consts::PI;
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let solution = Analysis::with(&model, formulation).unwrap().run();
        let angle =
            |k: usize, name: &str| solution.measured.value(k, solution.measured.index(name).unwrap())[0];
        for (name, turns) in [("A", 3.0), ("B", -3.0), ("C", 0.0), ("D", 0.0)] {
            assert!(
                (angle(90, name) - turns * turn).abs() < 1e-9,
                "{formulation:?} {name}: {}",
                angle(90, name)
            );
        }
    }
}

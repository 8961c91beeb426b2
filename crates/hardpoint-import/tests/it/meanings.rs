//! Joints and motions compared with closed forms of their meaning in the source programs.

use hardpoint::model::BodyId;
use hardpoint::space::Vec3;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::ModelFile;

use crate::{folder, import, model};

/// Tolerance of sources with sixteen digits, in mm and rad.
const SAME: f64 = 1e-9;
/// Tolerance of a spline through two hundred points, in mm.
const SPLINED: f64 = 1e-5;
/// Minimum displacement for a test to be meaningful, in mm.
const MOVES: f64 = 1.0;

struct Moving {
    file: ModelFile,
    solution: Solution,
}

impl Moving {
    fn of(path: &str) -> Self {
        let imported = import(&folder().join(path)).unwrap_or_else(|e| panic!("{e}"));
        assert!(imported.fault.is_none(), "{path}: {}", imported.fault.unwrap());
        let file = model(&imported);
        let solution = Analysis::new(&file.model).unwrap().solve(Run::new().without_sensitivities());
        assert!(solution.stop.is_none(), "{path}: {:?}", solution.stop);
        Self { file, solution }
    }

    fn steps(&self) -> std::ops::Range<usize> {
        0..self.solution.motion.len()
    }

    fn body(&self, name: &str) -> BodyId {
        BodyId(self.file.model.bodies.iter().position(|b| b.name == name).unwrap())
    }

    /// Position of a point of a body's frame, in mm.
    fn place(&self, step: usize, body: &str, local: [f64; 3]) -> Vec3 {
        let state = self.solution.body(step, self.body(body));
        state.r * 1e3 + state.rotation * Vec3::from(local)
    }

    /// Rotation of a body about y, rad.
    fn about_y(&self, step: usize, body: &str) -> f64 {
        let x = self.solution.body(step, self.body(body)).rotation.cols[0];
        (-x.z).atan2(x.x)
    }
}

#[test]
fn ondsel_joints_hold_what_its_solver_holds() {
    let m = Moving::of("asmt/contacts.asmt");
    let mut moved = [0.0_f64; 4];
    for k in m.steps() {
        let angle = 0.3 * (std::f64::consts::TAU * m.file.model.times[k]).sin();
        let (s, c) = angle.sin_cos();
        assert!((m.about_y(k, "Plate") - angle).abs() < SAME, "the motion names markers, no joint");
        let origin = |name| m.place(k, name, [0.0; 3]);
        let expected = [
            // The tip is on the plane that turns with marker I, 5 mm from it:  x sin + z cos = 5.
            ("Plunger", origin("Plunger").z, (5.0 - 40.0 * s) / c),
            // 70 mm from axis to axis, from the pin (-20 cos, 20 sin) to one on z = 0.
            ("Cross", origin("Cross").x, -20.0 * c - (70.0_f64.powi(2) - (20.0 * s).powi(2)).sqrt()),
            // z of the plate relative to the nut is pitch * angle / 2 pi; the nut moves in the opposite direction.
            ("Nut", origin("Nut").y, 60.0 - 6.0 * angle / std::f64::consts::TAU),
            // The rack moves by radius * angle.
            ("Rack", origin("Rack").x, 15.0 * angle),
        ];
        // A path of all six coordinates: along the axes of marker I, then about its z and about the x that has turned
        // so far.
        let t = m.file.model.times[k];
        let wave = (std::f64::consts::TAU * t).sin();
        let tool = origin("Tool") - Vec3::from([90.0 + 10.0 * wave, 0.0, 20.0 * t]);
        let (a, b) = (0.2 * wave, 0.1 * t);
        let z = Vec3::from([a.sin() * b.sin(), -a.cos() * b.sin(), b.cos()]);
        let axes = m.solution.body(k, m.body("Tool")).rotation.cols;
        assert!(tool.norm() < SAME && (axes[2] - z).norm() < SAME, "step {k}: {tool:?}, {axes:?}");
        assert!((axes[0] - Vec3::from([a.cos(), a.sin(), 0.0])).norm() < SAME, "step {k}: {axes:?}");
        for (n, (name, is, should)) in expected.into_iter().enumerate() {
            assert!((is - should).abs() < SAME, "{name} at step {k}: {is}, not {should}");
            moved[n] = moved[n].max((origin(name) - m.place(0, name, [0.0; 3])).norm());
        }
    }
    assert!(moved[0] > MOVES && moved[1] > MOVES && moved[2] > 0.2 && moved[3] > MOVES, "{moved:?}");
}

#[test]
fn adams_motions_by_velocity_equal_their_integral() {
    // Each key on its own line, as in files of Adams/View.
    let m = Moving::of("adams/shaper.adm");
    let length = (360.0_f64.powi(2) + 20.0_f64.powi(2)).sqrt();
    for k in m.steps() {
        // The integral of h u^2 (3 - 2 u), u = t/w, is h w (u^3 - u^4/2).
        let (h, w, t) = (240_f64.to_radians(), 0.5, m.file.model.times[k]);
        let u = (t / w).min(1.0);
        let angle = h * w * (u.powi(3) - u.powi(4) / 2.0) + h * (t - w).max(0.0);
        let (s, c) = angle.sin_cos();
        let pin = [60.0 * c + 80.0 * s, 80.0 * c - 60.0 * s];
        let ram = pin[0] + (length.powi(2) - (60.0 - pin[1]).powi(2)).sqrt();
        let is = m.place(k, "ram", [0.0; 3]).x;
        assert!((is - ram).abs() < SPLINED, "at {t} s: {is}, not {ram}");
    }
    assert!((m.about_y(m.steps().end - 1, "rod")).abs() > 0.01);
}

#[test]
fn freecad_distances_are_inferred_from_the_design_configuration() {
    let m = Moving::of("freecad/gauge");
    let mut moved = 0.0_f64;
    for k in m.steps() {
        let shuttle = m.place(k, "shuttle", [0.0; 3]);
        // Bed and fence: it slides along x only.
        assert!((shuttle.y - 10.0).abs() < SAME && (shuttle.z - 12.0).abs() < SAME, "{shuttle:?}");
        // The tip of the rocker stays 8 mm in front of the end face.
        let tip = m.place(k, "rocker", [32.0, 5.0, -55.0]);
        assert!((shuttle.x - tip.x - 8.0).abs() < SAME, "at step {k}");
        // Two pins.
        let pins = m.place(k, "lever", [10.0, 5.0, -10.0]) - m.place(k, "shuttle", [70.0, 25.0, 0.0]);
        assert!((pins.x.hypot(pins.z) - 50.0).abs() < SAME, "at step {k}");
        moved = moved.max((shuttle.x - 100.0).abs());
    }
    assert!(moved > MOVES, "{moved}");
}

#[test]
fn joints_listed_twice_are_imported_once() {
    let imported = import(&folder().join("freecad/gauge")).unwrap_or_else(|e| panic!("{e}"));
    let bearings = imported.report.entries.iter().filter(|e| e.name == "Bearing").count();
    assert_eq!(bearings, 1, "{}", imported.report);
}

#[test]
fn open_parts_are_placed_at_the_start_of_the_stored_motion() {
    let path = folder().join("asmt/four_bar.asmt");
    let text = std::fs::read_to_string(&path).unwrap();
    // Position of the first part in the design configuration, moved by 1 mm.
    let head = text.find("\n\t\tPart\n").unwrap();
    let at = head + text[head..].find("Position3D\n\t\t\t\t").unwrap() + "Position3D\n\t\t\t\t".len();
    let end = at + text[at..].find('\n').unwrap();
    let drawn: Vec<f64> = text[at..end].split_whitespace().map(|w| w.parse().unwrap()).collect();
    let off = format!("{} {} {}", drawn[0] + 0.001, drawn[1], drawn[2]);
    let changed = format!("{}{off}{}", &text[..at], &text[end..]);
    let imported = hardpoint_import::import(changed.as_bytes(), "four_bar.asmt", &|_| None)
        .unwrap_or_else(|e| panic!("{e}"));
    assert!(
        imported.report.to_string().contains("1 of them are drawn where their joints do not close"),
        "{}",
        imported.report
    );
    let file = model(&imported);
    let solution = Analysis::new(&file.model).unwrap().solve(Run::new().without_sensitivities());
    let d = imported.series.unwrap().compare(&file, &solution);
    assert!(d.place < 1e-10 && d.turn < 1e-10, "{d:?}");
}

#[test]
fn a_chrono_suspension_defined_body_by_body_moves_like_its_template() {
    // The points of `chrono/generic.json` in the double wishbone template.
    let template = r#"{"Name": "Front", "Type": "Suspension", "Template": "DoubleWishbone",
        "Camber Angle (deg)": -0.5, "Toe Angle (deg)": 0.1,
        "Spindle": {"COM": [0.0, 0.78, 0.0]},
        "Upper Control Arm": {"Location Chassis Front": [0.1, 0.42, 0.17], "Location Chassis Back": [-0.1, 0.42, 0.17], "Location Upright": [-0.02, 0.69, 0.15]},
        "Lower Control Arm": {"Location Chassis Front": [0.1, 0.34, -0.10], "Location Chassis Back": [-0.1, 0.34, -0.10], "Location Upright": [0.01, 0.74, -0.13]},
        "Tierod": {"Location Chassis": [-0.16, 0.36, -0.04], "Location Upright": [-0.15, 0.71, -0.05]}}"#;
    let imported = hardpoint_import::import(template.as_bytes(), "front.json", &|_| None)
        .unwrap_or_else(|e| panic!("{e}"));
    let file = model(&imported);
    let solution = Analysis::new(&file.model).unwrap().solve(Run::new().without_sensitivities());
    let upright = BodyId(file.model.bodies.iter().position(|b| b.name == "upright").unwrap());
    let generic = Moving::of("chrono/generic.json");
    let own = generic.body("Upright");
    let mut most = 0.0_f64;
    for k in generic.steps() {
        let [a, b] = [solution.body(k, upright).rotation, generic.solution.body(k, own).rotation];
        assert!(a.angle_to(b) < SAME, "step {k}: {}", a.angle_to(b));
        most = most.max(a.angle_to(solution.body(0, upright).rotation));
    }
    assert!(most > 0.01, "{most}");
}

/// Joint between ground and a part whose marker is rotated about x by an angle, and more about z.
fn turned_joint(kind: &str, tilt: f64, about_z: f64) -> String {
    format!(
        "Adams View model name: turned\nUNITS/\n, FORCE = NEWTON\n, MASS = KILOGRAM\n, LENGTH = MILLIMETER\n, TIME = SECOND\n\
         PART/1\n, GROUND\nMARKER/1\n, PART = 1\n\
         PART/2\n, MASS = 1\n, CM = 3\nMARKER/2\n, PART = 2\n, REULER = {about_z}, {tilt}, 0\nMARKER/3\n, PART = 2\n, QP = 100, 50, 20\n\
         JOINT/1\n, {kind}\n, I = 2\n, J = 1\nEND\n"
    )
}

#[test]
fn markers_that_are_turned_against_each_other_are_assembled() {
    for kind in ["REVOLUTE", "TRANSLATIONAL", "CYLINDRICAL", "PLANAR", "SCREW\n, PITCH = 5", "HOOKE", "FIXED"]
    {
        for tilt in [0.01, 0.1, 0.3] {
            // The pins of a cross remain perpendicular for any tilt about one of them.
            let (tilt, about_z) = if kind == "HOOKE" { (0.0, tilt) } else { (tilt, 0.2) };
            let text = turned_joint(kind, tilt, about_z);
            let imported = hardpoint_import::import(text.as_bytes(), "turned.adm", &|_| None)
                .unwrap_or_else(|e| panic!("{e}"));
            assert!(imported.fault.is_none(), "{kind}: {}", imported.fault.unwrap());
            let report = imported.report.to_string();
            assert!(report.contains("assembled"), "{kind}: {report}");
            let file = model(&imported);
            let solution = Analysis::new(&file.model).unwrap().solve(Run::new().without_sensitivities());
            assert!(solution.stop.is_none(), "{kind}: {:?}", solution.stop);
            let body = file.model.bodies.iter().position(|b| b.name.to_lowercase() == "part_2").unwrap();
            let drawn = file.model.bodies[body].frame.rot;
            // The marker's axes as assembled at t = 0
            let turn = solution.body(0, BodyId(body)).rotation * drawn.transpose();
            let rotation = |z: f64, x: f64| {
                let ([sz, cz], [sx, cx]) = ([z.sin(), z.cos()], [x.sin(), x.cos()]);
                [[cz, sz, 0.0], [-cx * sz, cx * cz, sx], [sx * sz, -sx * cz, cx]].map(Vec3::from)
            };
            let [x, y, z] = rotation(about_z, tilt).map(|axis| turn * axis);
            let off = match kind {
                // The pins are along x of the first and y of the second marker.
                "HOOKE" => x.y.abs(),
                "FIXED" => (1.0 - x.x).abs() + (1.0 - y.y).abs(),
                _ => z.x.hypot(z.y),
            };
            assert!(off < 1e-9, "{kind} by {tilt}: {off}");
            if !["HOOKE", "FIXED"].contains(&kind) {
                // The angle about the axis is preserved: 0.2 rad.
                assert!((x.y.atan2(x.x) - 0.2).abs() < 1e-2, "{kind}: {x:?}");
            }
        }
    }
}

#[test]
fn limits_of_freecad_and_ondsel_become_limits_of_the_joints() {
    let limits = |name: &str| {
        let imported = import(&folder().join(name)).unwrap_or_else(|e| panic!("{e}"));
        let limits = model(&imported).model.joint_limits;
        limits.into_iter().map(|limit| (limit.name, limit.min, limit.max)).collect::<Vec<_>>()
    };
    // A length of 40 mm at most; the frames of the joint coincide in the design configuration.
    let [(name, min, max)] = &limits("freecad/vise")[..] else { panic!("one limit") };
    assert_eq!((name.as_str(), *min), ("Cylindrical.displacement", None));
    let reach = VISE_DEPTH - max.unwrap();
    assert!(reach.abs() < SAME, "{max:?}");
    // An angle of 1.57 at most, of which the parts have turned some already.
    let [(name, min, max)] = &limits("asmt/slider_crank.asmt")[..] else { panic!("one limit") };
    assert_eq!((name.as_str(), *min), ("Joint.angle", None));
    assert!(max.unwrap() <= 1.57, "{max:?}");
}

/// Greatest displacement of the vise's screw, m.
const VISE_DEPTH: f64 = 0.04;

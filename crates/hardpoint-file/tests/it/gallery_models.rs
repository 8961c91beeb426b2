//! Every model of `models/`: its freedoms, its redundant constraints, and one result of its motion compared with an
//! independent formula or a published number. A model without an entry in [`GALLERY`] fails.
//!
//! Formulas are in SI units and radians, and start from the dimensions of the file's comments, not from the solver.

use std::cell::Cell;
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::model::BodyId;
use hardpoint::motion::BodyState;
use hardpoint::sensitivity::Admissibility;
use hardpoint::space::{Mat3, Vec3};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::{ModelFile, read};
use hardpoint_study::verify::{self, verify};

/// Known facts of a model.
struct Entry {
    file: &'static str,
    mobility: usize,
    /// Constraint rows that the others imply.
    redundant: usize,
    /// Variables that are inadmissible on purpose.
    refused: &'static [&'static str],
    fact: fn(&Solved),
}

const fn entry(
    file: &'static str,
    mobility: usize,
    redundant: usize,
    refused: &'static [&'static str],
    fact: fn(&Solved),
) -> Entry {
    Entry { file, mobility, redundant, refused, fact }
}

const GALLERY: &[Entry] = &[
    entry("bennett", 1, 3, &["corner_A_x"], bennett_input_and_output_half_angles_have_a_constant_product),
    entry("bricard", 1, 1, &["skew"], bricard_hinges_alternate_and_close_by_their_equation),
    entry("cam", 1, 0, &[], cam_lifts_by_its_cycloids),
    entry("delta", 3, 0, &[], delta_tool_is_where_three_spheres_meet),
    entry("double_wishbone", 2, 0, &[], double_wishbone_rods_and_spring_have_their_lengths),
    entry("double_wishbone_4x4", 2, 0, &[], double_wishbone_4x4_has_the_published_static_values),
    entry("drive_shaft", 2, 0, &[], drive_shaft_turns_the_wheel_evenly),
    entry("dwell", 1, 6, &[], dwell_arm_rests_for_half_a_turn),
    entry("excavator", 3, 0, &[], excavator_cylinders_obey_the_law_of_cosines),
    entry("five_link", 1, 0, &[], five_link_rods_keep_their_lengths_to_second_order),
    entry("four_bar", 1, 0, &[], four_bar_obeys_freudenstein),
    entry("four_bar_by_lengths", 1, 0, &[], four_bar_by_lengths_obeys_the_law_of_cosines),
    entry("four_bar_inverse", 1, 0, &[], four_bar_inverse_carries_its_coupler_on_the_crank),
    entry("front_axle", 3, 0, &[], front_axle_is_steered_and_moves_as_its_wheels_do),
    entry("gear_train", 1, 0, &[], gear_train_keeps_its_ratios),
    entry("hooke", 1, 3, &["in_bearing_y"], hooke_tangents_are_in_proportion),
    entry("jansen", 1, 9, &[], jansen_foot_follows_from_the_holy_numbers),
    entry("klann", 1, 6, &[], klann_foot_follows_from_the_published_lengths),
    entry("macpherson", 2, 0, &[], macpherson_strut_and_tie_rod_have_their_lengths),
    entry("pantograph", 2, 6, &[], pantograph_copies_exactly),
    entry("peaucellier", 1, 9, &[], peaucellier_draws_a_straight_line),
    entry("press", 1, 3, &[], press_goes_by_its_crank_and_rod),
    entry("quick_return", 1, 3, &[], quick_return_rests_at_210_and_330_degrees),
    entry("rack_steering", 1, 0, &[], rack_steering_is_its_own_mirror_image),
    entry("rssr", 1, 0, &[], rssr_coupler_keeps_its_length),
    entry("sarrus", 1, 1, &["x_knee_slope"], sarrus_platform_rises_straight),
    entry("scissor_lift", 1, 12, &[], scissor_height_follows_from_the_cylinder),
    entry("slider_crank", 1, 3, &["J4_ry"], slider_crank_follows_its_formula),
    entry("solid_axle", 2, 0, &[], solid_axle_goes_aside_with_its_panhard_rod),
    entry("spatial_slider_crank", 1, 0, &[], spatial_slider_crank_follows_its_formula),
    entry("stewart", 6, 0, &[], stewart_legs_follow_their_laws),
    entry("three_rrr", 3, 6, &[], three_rrr_inverse_kinematics_give_the_laws),
    entry("watt_six_bar", 1, 6, &[], watt_six_bar_is_two_four_bars),
    entry("wheel_clearance", 2, 0, &[], wheel_clearance_has_its_rods_and_the_distances_of_its_shapes),
];

/// Agreement of the motion with a formula in the same units: round-off, grown by the gain of the mechanism.
const EXACT: f64 = 1e-11;
/// Agreement of accelerations, relative to the largest of the terms that must cancel.
const EXACT_RATES: f64 = 1e-10;

#[test]
fn every_model_of_the_gallery_is_listed() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let mut found: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .map(|p| p.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    found.sort();
    let listed: Vec<&str> = GALLERY.iter().map(|e| e.file).collect();
    assert_eq!(found, listed, "a model needs an entry with a fact about its motion");
}

#[test]
fn freedoms_and_redundant_constraints_are_as_counted_by_hand_in_both_formulations() {
    for e in GALLERY {
        let file = model(e.file);
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            let analysis = Analysis::with(&file.model, formulation).unwrap();
            let topology = analysis.topology();
            let found = (topology.mobility, topology.redundant().count());
            assert_eq!(found, (e.mobility, e.redundant), "{} {formulation:?}", e.file);
        }
    }
}

#[test]
fn every_model_runs_to_its_end_and_obeys_its_own_formula() {
    for e in GALLERY {
        let solved = Solved::new(e.file);
        (e.fact)(&solved);
        assert!(solved.compared.get() > 10, "{}: only {} comparisons", e.file, solved.compared.get());
        println!("{:<22} {:5} comparisons, worst {:.1e}", e.file, solved.compared.get(), solved.worst.get());
    }
}

/// Against the largest magnitude of the same quantity over the motion, at least 1 (SI).
#[test]
fn both_formulations_give_the_same_motion() {
    for e in GALLERY {
        let file = model(e.file);
        let [relative, absolute] = [Formulation::Relative, Formulation::Absolute].map(|formulation| {
            let solution =
                Analysis::with(&file.model, formulation).unwrap().solve(Run::new().without_sensitivities());
            assert!(solution.stop.is_none(), "{}: {:?}", e.file, solution.stop);
            solution.motion
        });
        let quantities =
            |s: &BodyState| [s.r, s.rotation.cols[0], s.rotation.cols[1], s.v, s.omega, s.a, s.alpha];
        let mut scale = [1.0_f64; 7];
        for state in relative.states() {
            for (k, q) in quantities(&state).iter().enumerate() {
                scale[k] = scale[k].max(q.norm());
            }
        }
        for (a, b) in relative.states().zip(absolute.states()) {
            for (k, (a, b)) in quantities(&a).into_iter().zip(quantities(&b)).enumerate() {
                let apart = (a - b).norm() / scale[k];
                assert!(apart < 1e-10, "{}: quantity {k} differs by {apart:e}", e.file);
            }
        }
    }
}

#[test]
fn admissibility_of_every_variable_is_that_of_its_file_and_verify_passes() {
    for e in GALLERY {
        let file = model(e.file);
        let analysis = Analysis::new(&file.model).unwrap();
        let solution = analysis.run();
        let refused: Vec<&str> = file
            .model
            .variables
            .iter()
            .zip(&solution.sensitivities.admissibility)
            .filter(|(_, a)| matches!(a, Admissibility::CannotFollow { .. } | Admissibility::Unknown))
            .map(|(v, _)| v.name.as_str())
            .collect();
        assert_eq!(refused, e.refused, "{}", e.file);
        let report = verify(&analysis, &solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
        assert!(report.passed(), "{}: {:?}", e.file, report.checks);
        assert_eq!(report.checks.len(), file.model.variables.len(), "{}", e.file);
    }
}

fn model(name: &str) -> ModelFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.toml"));
    read(&path).unwrap_or_else(|e| panic!("{e}"))
}

/// Motion of a model, and the results of comparisons so far.
struct Solved {
    file: ModelFile,
    solution: Solution,
    compared: Cell<usize>,
    worst: Cell<f64>,
}

impl Solved {
    fn new(name: &str) -> Self {
        let file = model(name);
        let solution = Analysis::new(&file.model).unwrap().solve(Run::new().without_sensitivities());
        assert!(solution.stop.is_none(), "{name}: {:?}", solution.stop);
        assert_eq!(solution.motion.len(), file.model.times.len(), "{name}");
        Self { file, solution, compared: Cell::new(0), worst: Cell::new(0.0) }
    }

    /// Every output step and its time.
    fn steps(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.file.model.times.iter().copied().enumerate()
    }

    /// Value, rate and acceleration of a measure.
    fn measure(&self, k: usize, name: &str) -> [f64; 3] {
        let m = self.solution.measured.index(name).unwrap_or_else(|| panic!("no measure {name}"));
        self.solution.measured.value(k, m)
    }

    fn value(&self, k: usize, name: &str) -> f64 {
        self.measure(k, name)[0]
    }

    fn hardpoint(&self, name: &str) -> Vec3 {
        self.file.model.hardpoints.iter().find(|h| h.name == name).unwrap().position
    }

    /// Place, velocity and acceleration at step k of a body's point that is at p in the design configuration.
    fn carried(&self, k: usize, body: BodyId, p: Vec3) -> [Vec3; 3] {
        if body.0 == 0 {
            return [p, Vec3::ZERO, Vec3::ZERO];
        }
        let s = self.solution.motion.at(k).body(body.0);
        let arm = s.rotation * self.file.model.bodies[body.0].frame.inverse().point(p);
        let turning = s.omega.cross(arm);
        [s.r + arm, s.v + turning, s.a + s.alpha.cross(arm) + s.omega.cross(turning)]
    }

    fn place(&self, k: usize, body: &str, hardpoint: &str) -> Vec3 {
        let body = self.file.model.body(body).unwrap();
        self.carried(k, body, self.hardpoint(hardpoint))[0]
    }

    fn close(&self, what: &str, found: f64, expected: f64, tolerance: f64) {
        let apart = (found - expected).abs();
        assert!(apart <= tolerance, "{}: {what}: {found} {expected}, apart {apart:e}", self.file.model.name);
        self.compared.set(self.compared.get() + 1);
        self.worst.set(self.worst.get().max(apart));
    }

    /// A rod's or leg's length is `l0 + law`, and so are its rate and acceleration:
    /// d.d = l^2, d.d' = l l', d.d'' + d'.d' = l l'' + l'^2, with d between its ends.
    fn rod(&self, name: &str, law: impl Fn(f64) -> [f64; 3]) {
        let joint = self.file.model.joints.iter().find(|j| j.name == name).unwrap();
        let ends = joint.at.map(|h| self.file.model.hardpoints[h.0].position);
        let l0 = (ends[1] - ends[0]).norm();
        for (k, t) in self.steps() {
            let [i, j] = [0, 1].map(|end| self.carried(k, joint.bodies[end], ends[end]));
            let [d, v, a] = [0, 1, 2].map(|order| j[order] - i[order]);
            let [f, fd, fdd] = law(t);
            let l = l0 + f;
            self.close(name, d.norm(), l, EXACT);
            self.close(name, d.dot(v), l * fd, EXACT_RATES * (1.0 + v.norm()));
            let scale = 1.0 + a.norm() + v.dot(v);
            self.close(name, d.dot(a) + v.dot(v), l * fdd + fd * fd, EXACT_RATES * scale);
        }
    }
}

/// f(t) = a sin(w t) with its two derivatives.
fn sine(a: f64, w: f64, t: f64) -> [f64; 3] {
    let (s, c) = (w * t).sin_cos();
    [a * s, a * w * c, -a * w * w * s]
}

/// f(t) = a (1 - cos(w t)) with its two derivatives.
fn swell(a: f64, w: f64, t: f64) -> [f64; 3] {
    let (s, c) = (w * t).sin_cos();
    [a * (1.0 - c), a * w * s, a * w * w * c]
}

fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn constant(_: f64) -> [f64; 3] {
    [0.0; 3]
}

/// Points of the plane, for closed forms of planar linkages.
type P = [f64; 2];

fn polar(from: P, radius: f64, angle: f64) -> P {
    [from[0] + radius * angle.cos(), from[1] + radius * angle.sin()]
}

/// The point at distance r from p and s from q, to the left of the way from p to q (`side` 1) or to the right (-1).
fn meet(p: P, r: f64, q: P, s: f64, side: f64) -> P {
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    let d = dx.hypot(dy);
    let along = (r * r - s * s + d * d) / (2.0 * d);
    let across = side * (r * r - along * along).sqrt();
    [p[0] + (dx * along - dy * across) / d, p[1] + (dy * along + dx * across) / d]
}

fn distance(p: P, q: P) -> f64 {
    (q[0] - p[0]).hypot(q[1] - p[1])
}

/// Angle at the corner between two sides of a triangle, by the law of cosines.
fn corner(side: f64, other: f64, opposite: f64) -> f64 {
    ((side * side + other * other - opposite * opposite) / (2.0 * side * other)).acos()
}

/// Freudenstein's equation of a four-bar with crank a, coupler b, rocker c and ground d, angles from the ground line:
/// (d/a) cos psi - (d/c) cos phi + (a^2 - b^2 + c^2 + d^2) / (2 a c) - cos(phi - psi) = 0.
fn freudenstein([a, b, c, d]: [f64; 4], phi: f64, psi: f64) -> f64 {
    d / a * psi.cos() - d / c * phi.cos() + (a * a - b * b + c * c + d * d) / (2.0 * a * c)
        - (phi - psi).cos()
}

// Facts, in the order of the table.

/// With the angles u and w at two neighbouring corners and the twists alpha and beta of the sides that meet there,
/// The pitch curve is given every 5 deg, so there the lift is the cycloid itself.
fn cam_lifts_by_its_cycloids(m: &Solved) {
    let cycloid = |u: f64| 0.02 * (u - (TAU * u).sin() / TAU);
    for (k, t) in m.steps().filter(|(k, _)| k % 2 == 0) {
        let angle = (360.0 * t) % 360.0;
        let lift = match angle {
            a if a < 120.0 => cycloid(a / 120.0),
            a if a < 180.0 => 0.02,
            a if a < 300.0 => 0.02 - cycloid((a - 180.0) / 120.0),
            _ => 0.0,
        };
        m.close("lift", m.value(k, "lift"), lift, EXACT);
        // The pin is 60 mm beside the fulcrum: the slot points at it.
        m.close("lever", m.value(k, "lever_angle").tan(), m.value(k, "lift") / 0.06, EXACT);
    }
}

/// Homokinetic joints: the wheel has the engine's angle, speed and acceleration at any travel; and Pythagoras.
fn drive_shaft_turns_the_wheel_evenly(m: &Solved) {
    let (inner, outer) = (m.hardpoint("inner_joint"), m.hardpoint("outer_joint"));
    for (k, t) in m.steps() {
        let [angle, speed, acceleration] = m.measure(k, "wheel_angle");
        m.close("angle", angle, 2.0 * TAU * t, EXACT * 100.0);
        m.close("speed", speed, 2.0 * TAU, EXACT * 100.0);
        m.close("acceleration", acceleration, 0.0, EXACT_RATES * 100.0);
        let travel = Vec3::new(0.0, 0.0, 0.08 * (0.5 * TAU * t).sin());
        let plunge = (outer + travel - inner).norm() - (outer - inner).norm();
        m.close("plunge", m.value(k, "plunge"), plunge, EXACT);
    }
}

/// Ten turns of the motor by 2/3, by -1/4 and -1/3 on to the rack and by 3 to the screw of 4 mm, counted through all
/// turns.
fn gear_train_keeps_its_ratios(m: &Solved) {
    for (k, t) in m.steps() {
        let u = t / 4.0;
        let motor = 10.0 * TAU * u.powi(3) * (10.0 - 15.0 * u + 6.0 * u * u);
        let cross = motor / 12.0;
        m.close("spindle", m.value(k, "spindle_angle"), motor * 2.0 / 3.0, EXACT * 100.0);
        m.close("feed", m.value(k, "feed"), 0.012 * cross, EXACT);
        m.close("stop", m.value(k, "stop_travel"), -0.004 * 3.0 * cross / TAU, EXACT);
    }
}

/// tan(u/2) tan(w/2) = cos((beta - alpha)/2) / cos((beta + alpha)/2) (Bennett 1903, axes outwards at every corner).
fn bennett_input_and_output_half_angles_have_a_constant_product(m: &Solved) {
    let [a, b, c, d] = ["A", "B", "C", "D"].map(|h| m.hardpoint(h));
    let axis = |before: Vec3, at: Vec3, after: Vec3| (before - at).cross(after - at).unit().unwrap();
    // The file's axes are perpendicular to the sides that meet there.
    let (axis_a, axis_b) = (axis(d, a, b), axis(a, b, c));
    m.close("axis A", axis_a.cross(Vec3::new(4.0, -3.0, 5.0).unit().unwrap()).norm(), 0.0, EXACT);
    m.close("axis B", axis_b.cross(Vec3::new(0.0, -2.0, 3.0).unit().unwrap()).norm(), 0.0, EXACT);
    let twist = |u: Vec3, w: Vec3, side: Vec3| {
        let side = side.unit().unwrap();
        u.cross(w).dot(side).atan2(u.dot(w))
    };
    let (alpha, beta) = (twist(axis_a, axis_b, b - a), twist(axis_b, axis(b, c, d), c - b));
    let lengths = ((b - a).norm(), (c - b).norm());
    m.close("Bennett's condition", alpha.sin().abs() / lengths.0, beta.sin().abs() / lengths.1, EXACT);
    let interior = |before: Vec3, at: Vec3, after: Vec3| {
        let (u, w) = ((before - at).unit().unwrap(), (after - at).unit().unwrap());
        u.dot(w).acos()
    };
    let (at_a, at_b) = (interior(d, a, b), interior(a, b, c));
    // Sense of the file's axes against those of the corners.
    let sense = |own: Vec3, of_file: [f64; 3]| own.dot(Vec3::from(of_file)).signum();
    let (sense_a, sense_b) = (sense(axis_a, [4.0, -3.0, 5.0]), sense(axis_b, [0.0, -2.0, 3.0]));
    let product = (at_a / 2.0).tan() * (at_b / 2.0).tan();
    let ratio = (0.5 * (beta - alpha)).cos() / (0.5 * (beta + alpha)).cos();
    m.close("its constant", product, ratio, EXACT);
    for (k, t) in m.steps() {
        let u = at_a + sense_a * m.value(k, "angle_A");
        let w = at_b + sense_b * m.value(k, "angle_B");
        // tan tan = product, without the poles.
        let (su, cu) = (0.5 * u).sin_cos();
        let (sw, cw) = (0.5 * w).sin_cos();
        m.close("half angles", su * sw, product * cu * cw, EXACT * (1.0 + product));
        // Differentiated twice in time: (su)' = cu u'/2 and so on.
        let [_, du, ddu] = sine(0.5 * sense_a * 75f64.to_radians(), TAU, t);
        let across = cu * sw + product * su * cw;
        let slope = su * cw + product * cu * sw;
        let dw = -across / slope * du;
        let ddw = -(2.0 * (cu * cw - product * su * sw) * du * dw + across * ddu) / slope;
        let [_, rate, acceleration] = m.measure(k, "angle_B");
        m.close("rate", 0.5 * sense_b * rate, dw, EXACT_RATES);
        m.close("acceleration", 0.5 * sense_b * acceleration, ddw, 10.0 * EXACT_RATES);
    }
}

/// Threefold-symmetric Bricard linkage with a twist of 90 deg (Chen, You, Tarnai, Int. J. Solids Struct. 42, 2005):
/// cos u + cos w + cos u cos w = 0; at the cube both are 90 deg. The middle axis turns the other way round.
fn bricard_hinges_alternate_and_close_by_their_equation(m: &Solved) {
    for (k, t) in m.steps() {
        let u = FRAC_90 + m.value(k, "angle_1");
        let w = FRAC_90 + m.value(k, "angle_2");
        m.close("driver", u, FRAC_90 + PI / 3.0 * ((TAU * t).cos() - 1.0), EXACT);
        m.close("closure", u.cos() + w.cos() + u.cos() * w.cos(), 0.0, EXACT);
        m.close("every other hinge", m.value(k, "angle_3"), m.value(k, "angle_1"), EXACT);
    }
}

const FRAC_90: f64 = std::f64::consts::FRAC_PI_2;

/// Spheres about the elbows, moved inwards by the platform's radius; the lower one of their two common points.
fn delta_tool_is_where_three_spheres_meet(m: &Solved) {
    let (shoulder, arm, platform, design) = (0.2, 0.25, 0.06, 0.6_f64.atan2(0.8));
    let rod = 0.34_f64.hypot(0.36);
    for (k, t) in m.steps() {
        let q = [
            20.0 * (TAU * t).sin(),
            20.0 * (TAU * t + TAU / 3.0).sin() - 5.0,
            20.0 * (TAU * t + 2.0 * TAU / 3.0).sin() + 5.0,
        ];
        let centres = [0, 1, 2].map(|i| {
            let down = design + q[i].to_radians();
            let radius = shoulder + arm * down.cos() - platform;
            let (s, c) = (TAU / 3.0 * i as f64).sin_cos();
            Vec3::new(radius * c, radius * s, -arm * down.sin())
        });
        // All three rods are alike, so the points lie on the axis of the centres' circle.
        let [a, b, c] = centres;
        let normal = (b - a).cross(c - a);
        let (ab, ac, n2) = (b - a, c - a, normal.dot(normal));
        let from_a = (normal.cross(ab) * ac.dot(ac) + ac.cross(normal) * ab.dot(ab)) * (0.5 / n2);
        let height = (rod * rod - from_a.dot(from_a)).sqrt();
        let up = normal.unit().unwrap();
        let tool = a + from_a - up * (height * up.z.signum());
        for (name, want) in [("x", tool.x), ("y", tool.y), ("z", tool.z)] {
            m.close(name, m.value(k, name), want, EXACT);
        }
        m.close("level", m.value(k, "edge_x_height"), tool.z, EXACT);
        m.close("level", m.value(k, "edge_y_height"), tool.z, EXACT);
    }
}

fn double_wishbone_rods_and_spring_have_their_lengths(m: &Solved) {
    m.rod("tie_rod", constant);
    m.rod("pushrod", constant);
    m.rod("spring", |t| sum([0.004, 0.0, 0.0], sine(0.02, TAU, t)));
}

/// The static report of Lotus Suspension Analysis v4.03 for 4x4V23.shk, to its last printed digit; then the same
/// quantities on the way, constructed from the places of the knuckle's hardpoints.
fn double_wishbone_4x4_has_the_published_static_values(m: &Solved) {
    let of = |k: usize, name: &str| m.value(k, &format!("front_left.{name}"));
    const PRINTED: f64 = 0.005;
    for (name, degrees) in [("caster", 16.22), ("kingpin_inclination", 9.75), ("toe", 0.0), ("camber", 0.0)] {
        m.close(name, of(0, name).to_degrees(), degrees, PRINTED);
    }
    for (name, mm) in [
        ("hub_trail", 5.00),
        ("caster_trail", 76.31),
        ("spindle_offset", 98.13),
        ("scrub_radius", 50.13),
        ("mechanical_trail", 73.27),
        ("half_track", 650.0),
        ("contact_z", -279.40),
    ] {
        m.close(name, of(0, name) * 1e3, mm, PRINTED);
    }
    // The published height of the roll centre above the ground is 293.64 mm, by finite steps; 293.583 is the
    // derivative: half the track times the lateral displacement of the contact point per rise.
    let rate = |name: &str| m.measure(0, &format!("front_left.{name}"))[1];
    let roll_centre = of(0, "half_track") * rate("contact_y") / rate("contact_z");
    m.close("roll centre", roll_centre * 1e3, 293.583, 5e-4);
    m.close("roll centre", of(0, "roll_centre_height"), roll_centre, EXACT);
    m.close("roll centre", of(0, "roll_centre_height") * 1e3, 293.64, 0.1);
    // Without camber the contact point is the carrier's lowest one, and both roll centres agree.
    m.close("roll centre", of(0, "roll_centre_height_geometric"), roll_centre, EXACT);

    m.rod("tie_rod", constant);
    for (k, t) in m.steps() {
        let [lower, upper, spindle, centre] =
            ["lower_ball", "upper_ball", "spindle", "wheel_centre"].map(|h| m.place(k, "knuckle", h));
        m.close("travel", of(k, "wheel_travel"), 0.08 * (TAU * t).sin(), EXACT);
        m.close("recession", of(k, "wheel_recession"), -centre.x, EXACT);
        let e = (centre - spindle).unit().unwrap();
        // The wheel's plane is perpendicular to e; its lowest point is straight below the centre in that plane.
        let down = e.cross(e.cross(Vec3::AXES[2])).unit().unwrap();
        let contact = centre + down * 0.2794;
        for (axis, name) in ["contact_x", "contact_y", "contact_z"].into_iter().enumerate() {
            m.close(name, of(k, name), contact[axis], EXACT);
        }
        m.close("half track", of(k, "half_track_change"), contact.y - 0.65, EXACT);
        let forward = e.cross(Vec3::AXES[2]).unit().unwrap();
        m.close("steer", of(k, "steer_angle"), forward.y.atan2(forward.x), EXACT);
        m.close("toe", of(k, "toe"), -forward.y.atan2(forward.x), EXACT);
        m.close("camber", of(k, "camber").sin(), -e.z, EXACT);
        let outboard = Vec3::AXES[2].cross(forward);
        let axis = (upper - lower).unit().unwrap();
        let at_height = |z: f64| lower + axis * ((z - lower.z) / axis.z);
        let (ground, hub) = (contact - at_height(contact.z), centre - at_height(centre.z));
        m.close("scrub radius", of(k, "scrub_radius"), ground.dot(outboard), EXACT);
        m.close("caster trail", of(k, "caster_trail"), -ground.dot(forward), EXACT);
        m.close("spindle offset", of(k, "spindle_offset"), hub.dot(outboard), EXACT);
        m.close("hub trail", of(k, "hub_trail"), hub.dot(forward), EXACT);
        m.close("caster", of(k, "caster").tan(), -axis.x / axis.z, EXACT);
        m.close("kingpin", of(k, "kingpin_inclination").tan(), -axis.y / axis.z, EXACT);
        // From the contact point perpendicular to the kingpin, both seen along the wheel's lateral direction.
        let seen = |v: Vec3| [v.dot(forward), v.z];
        let ([a, b], [p, q]) = (seen(axis), seen(contact - lower));
        m.close("mechanical trail", of(k, "mechanical_trail"), (a * q - b * p) / a.hypot(b), EXACT);
    }
}

/// Hoeken's proportions 1 : 2 : 2.5 : 2.5 : 5, unit 40 mm. The slot's arm is pivoted on the straight line.
fn dwell_arm_rests_for_half_a_turn(m: &Solved) {
    let unit = 0.04;
    let mut largest_at_rest = 0.0_f64;
    for (k, t) in m.steps() {
        let crank = PI + TAU * t;
        let pin = polar([0.0, 0.0], unit, crank);
        let joint = meet(pin, 2.5 * unit, [2.0 * unit, 0.0], 2.5 * unit, 1.0);
        let point = [2.0 * joint[0] - pin[0], 2.0 * joint[1] - pin[1]];
        m.close("path x", m.value(k, "path_x"), point[0], EXACT);
        m.close("path y", m.value(k, "path_y"), point[1], EXACT);
        let arm = (point[1] - 4.0 * unit).atan2(point[0] + 3.0 * unit);
        m.close("arm", m.value(k, "arm_angle"), arm, EXACT);
        if crank.cos() <= 0.0 {
            largest_at_rest = largest_at_rest.max(arm.abs());
        }
    }
    assert!(largest_at_rest < 0.15_f64.to_radians(), "{}", largest_at_rest.to_degrees());
}

/// Each cylinder is the side of a triangle that lies opposite to the joint that it turns.
fn excavator_cylinders_obey_the_law_of_cosines(m: &Solved) {
    let w = TAU / 12.0;
    // A longer cylinder lifts the boom, and pulls the stick in.
    for (part, sense, [swell, sine]) in [("boom", 1.0, [-0.17, 0.08]), ("stick", -1.0, [0.15, -0.2])] {
        let measure = &format!("{part}_angle");
        let [pivot, foot, head] =
            ["pivot", "cylinder_foot", "cylinder_head"].map(|h| m.hardpoint(&format!("{part}_{h}")));
        let (arm, lever, length) = ((foot - pivot).norm(), (head - pivot).norm(), (head - foot).norm());
        for (k, t) in m.steps() {
            let cylinder = length + swell * (1.0 - (w * t).cos()) + sine * (w * t).sin();
            let turned = corner(arm, lever, cylinder) - corner(arm, lever, length);
            m.close(measure, m.value(k, measure), sense * turned, EXACT);
        }
    }
    m.rod("bucket_link", constant);
    m.rod("bucket_cylinder", |t| sum(swell(0.1, w, t), sine(-0.12, w, t)));
}

fn five_link_rods_keep_their_lengths_to_second_order(m: &Solved) {
    for rod in ["camber_rod", "pulling_strut", "thrust_strut", "spring_link", "tie_rod"] {
        m.rod(rod, constant);
    }
    m.rod("spring_strut", |t| sine(0.055, TAU, t));
}

/// Joint measures of the wheels; their slopes are tested in `wheels.rs`.
fn front_axle_is_steered_and_moves_as_its_wheels_do(m: &Solved) {
    let of = |k: usize, name: &str| m.value(k, name);
    for side in ["left", "right"] {
        m.close(side, of(0, &format!("{side}.roll_centre_height")) * 1e3, 293.583, 5e-4);
    }
    m.close("axle", of(0, "front.axle_roll_centre_height"), of(0, "left.roll_centre_height"), EXACT);
    m.rod("left_tie_rod", constant);
    m.rod("right_tie_rod", constant);
    let mut steered = 0.0_f64;
    for (k, _) in m.steps() {
        let [left, right] = [-of(k, "left.toe"), of(k, "right.toe")];
        m.close("difference", of(k, "toe_difference"), -left - right, EXACT);
        m.close("total", of(k, "front.total_toe"), right - left, EXACT);
        let [l, r] = ["left", "right"].map(|side| {
            let centre = m.place(k, &format!("{side}_knuckle"), &format!("{side}_wheel_centre"));
            let hub = m.place(k, &format!("{side}_knuckle"), &format!("{side}_spindle"));
            let e = (centre - hub).unit().unwrap();
            centre + e.cross(e.cross(Vec3::AXES[2])).unit().unwrap() * 0.2794
        });
        m.close("track", of(k, "front.track"), l.y - r.y, EXACT);
        steered = steered.max(left.abs());
        if left.abs().min(right.abs()) < 0.05 {
            continue;
        }
        let cot = |x: f64| 1.0 / x.tan();
        // Into the turn: of a left one the left wheel is the inner one.
        let [inner, outer] = if left + right > 0.0 { [left, right] } else { [-right, -left] };
        let ideal = (1.0 / (cot(inner) + (l.y - r.y) / 2.7)).atan();
        m.close("error", of(k, "front.ackermann_error"), outer - ideal, EXACT);
        m.close("part", of(k, "front.ackermann"), (inner - outer) / (inner - ideal), 1e-9);
        let outer = if left.abs() < right.abs() { left } else { right };
        m.close("radius", of(k, "front.turning_radius"), 2.7 / outer.sin().abs(), 1e-9);
        let knuckle = m.file.model.body("left_knuckle").unwrap();
        let hop = m.carried(k, knuckle, m.hardpoint("left_wheel_centre"))[2].y;
        m.close("acceleration", of(k, "left_hop"), hop, EXACT_RATES * 100.0);
    }
    assert!(steered > 0.2, "{steered}");
}

fn four_bar_obeys_freudenstein(m: &Solved) {
    let (a, b) = (0.04_f64.hypot(0.2), 0.32_f64.hypot(0.4));
    let (c, d) = (0.04_f64.hypot(0.6), 0.4);
    let (crank, rocker) = (0.2_f64.atan2(0.04), 0.6_f64.atan2(-0.04));
    for (k, t) in m.steps() {
        let phi = crank + TAU * t;
        m.close("crank", m.value(k, "crank_angle"), TAU * t, EXACT);
        let psi = rocker + m.value(k, "rocker_angle");
        m.close("closure", freudenstein([a, b, c, d], phi, psi), 0.0, EXACT);
    }
}

/// Half of the coupler back from its midpoint is the pin of the crank.
fn four_bar_inverse_carries_its_coupler_on_the_crank(m: &Solved) {
    let (half, crank) = (0.5 * 0.235_f64.hypot(0.24), 0.11_f64.hypot(0.215));
    let start = 0.215_f64.atan2(0.11);
    for (k, t) in m.steps() {
        let (phi, theta) = (start + TAU * t, m.value(k, "coupler_angle"));
        m.close("x", m.value(k, "midpoint_x") - half * theta.cos(), -0.045 + crank * phi.cos(), EXACT);
        m.close("y", m.value(k, "midpoint_y") - half * theta.sin(), 0.045 + crank * phi.sin(), EXACT);
    }
}

/// The angle at C in the triangle B C D, and its derivative by each length: of the angle at the start too, from which
/// the joint's angle counts.
fn four_bar_by_lengths_obeys_the_law_of_cosines(m: &Solved) {
    let (g, a, b, c) = (0.4, 0.1, 0.35, 0.25);
    let at = |t: f64| {
        let phi = 40f64.to_radians() + TAU * t;
        let square = g * g + a * a - 2.0 * g * a * phi.cos();
        let cosine = (b * b + c * c - square) / (2.0 * b * c);
        let by_cosine = -1.0 / (1.0 - cosine * cosine).sqrt();
        let slopes = [
            -(g - a * phi.cos()) / (b * c),
            -(a - g * phi.cos()) / (b * c),
            1.0 / c - cosine / b,
            1.0 / b - cosine / c,
        ];
        // By the speed, in deg per s.
        let by_speed = -(g * a * phi.sin()) / (b * c) * t.to_radians();
        (cosine.acos(), slopes.map(|s| s * by_cosine), by_speed * by_cosine)
    };
    let (start, start_by, _) = at(0.0);
    let measured = Analysis::new(&m.file.model).unwrap().run().measured;
    let measure = measured.index("knee_angle").unwrap();
    for (k, t) in m.steps() {
        let (mu, by, by_speed) = at(t);
        m.close("angle", m.value(k, "knee_angle"), mu - start, EXACT);
        for (n, name) in ["ground", "crank", "coupler", "rocker"].into_iter().enumerate() {
            let variable = m.file.model.variable(name).unwrap();
            m.close(name, measured.d(k, variable, measure)[0], by[n] - start_by[n], EXACT_RATES);
        }
        let speed = m.file.model.variable("speed").unwrap();
        m.close("speed", measured.d(k, speed, measure)[0], by_speed, EXACT_RATES);
    }
}

/// tan q2 = tan q1 / cos(30 deg).
fn hooke_tangents_are_in_proportion(m: &Solved) {
    for (k, t) in m.steps() {
        let ((s1, c1), q2) = ((TAU * t).sin_cos(), m.value(k, "output_angle"));
        m.close("tangents", q2.sin() * c1 * 30f64.to_radians().cos(), s1 * q2.cos(), EXACT);
    }
}

/// The eleven rods of Theo Jansen, from pivot to foot, by meeting circles.
fn jansen_foot_follows_from_the_holy_numbers(m: &Solved) {
    let [a, b, c, d, e, f, g, h, i, j, k_, l, crank] =
        [38.0, 41.5, 39.3, 40.1, 55.8, 39.4, 36.7, 65.7, 49.0, 50.0, 61.9, 7.8, 15.0].map(|x| 1e-3 * x);
    let pivot = [-a, -l];
    for (k, t) in m.steps() {
        let pin = polar([0.0, 0.0], crank, 70f64.to_radians() + TAU * t);
        let upper = meet(pivot, b, pin, j, 1.0);
        let lower = meet(pivot, c, pin, k_, -1.0);
        let outer = meet(pivot, d, upper, e, 1.0);
        let knee = meet(outer, f, lower, g, -1.0);
        let foot = meet(knee, h, lower, i, -1.0);
        // The file has nine decimals of a millimetre; near the stretched knee they are multiplied.
        m.close("forward", m.value(k, "step_forward"), -foot[0], 1e-10);
        m.close("height", m.value(k, "step_height"), foot[1], 1e-10);
    }
}

/// Lengths of boim.com/Walkin8r/Klann.html; the file's points have six decimals of a millimetre.
fn klann_foot_follows_from_the_published_lengths(m: &Solved) {
    let [ac, bh, cf, ch, de, ef, eg, fg, fh] =
        [17.5, 23.7, 73.4, 38.8, 34.1, 57.7, 111.7, 59.0, 35.2].map(|x| 1e-3 * x);
    let (b, d) = ([-0.0388, -0.0125], [-0.0146, 0.0419]);
    let mut low = 0;
    for (k, t) in m.steps() {
        let c = polar([0.0, 0.0], ac, TAU * t);
        let elbow = meet(c, ch, b, bh, -1.0);
        let knee = meet(c, cf, elbow, fh, -1.0);
        let hip = meet(d, de, knee, ef, -1.0);
        let foot = meet(hip, eg, knee, fg, 1.0);
        m.close("forward", m.value(k, "foot_forward"), -foot[0], 1e-7);
        m.close("height", m.value(k, "foot_height"), foot[1], 1e-7);
        low += usize::from(foot[1] < -0.0427);
    }
    // It walks: within 3 mm of its lowest point for almost half of the turn.
    assert!(low > 80, "{low} of {} steps", m.file.model.times.len());
}

fn macpherson_strut_and_tie_rod_have_their_lengths(m: &Solved) {
    m.rod("tie_rod", constant);
    let l0 = (m.hardpoint("strut_top") - m.hardpoint("strut_lower")).norm();
    for (k, t) in m.steps() {
        let strut = (m.hardpoint("strut_top") - m.place(k, "knuckle", "strut_lower")).norm();
        m.close("strut", strut, l0 + 0.04 * (TAU * 0.1 * t).sin(), EXACT);
        let ball = m.place(k, "lca", "ball_joint");
        m.close("ball", (ball - m.place(k, "knuckle", "ball_joint")).norm(), 0.0, EXACT);
    }
}

/// The distance of the tie rod from the lip is the least over points of the rod.
fn wheel_clearance_has_its_rods_and_the_distances_of_its_shapes(m: &Solved) {
    m.rod("tie_rod", constant);
    let knuckle = m.file.model.body("knuckle").unwrap();
    let beside_lip = m.hardpoint("lip_centre") + Vec3::new(0.0, 1.0, 0.0);
    for (k, t) in m.steps() {
        let wheel = m.place(k, "knuckle", "wheel_centre");
        m.close("travel", wheel.z - m.hardpoint("wheel_centre").z, 0.03 * (2.0 * TAU * t).sin(), EXACT);
        let [inner, outer] = [("rack", "tie_rod_inner"), ("knuckle", "tie_rod_outer")]
            .map(|(body, point)| m.place(k, body, point));
        let centre = m.place(k, "knuckle", "lip_centre");
        let n = m.carried(k, knuckle, beside_lip)[0] - centre;
        let apart = |part: f64| {
            let v = inner + (outer - inner) * part - centre;
            n.dot(v).hypot(n.cross(v).norm() - 0.122)
        };
        // Between samples it is less by 0.1 mm at most: half a spacing, at a slope of less than one.
        let least = (0..=2000).map(|part| apart(f64::from(part) / 2000.0)).fold(f64::INFINITY, f64::min);
        m.close("rod_to_lip", m.value(k, "rod_to_lip"), least - 0.012, 1e-4);
    }
}

fn pantograph_copies_exactly(m: &Solved) {
    for (k, t) in m.steps() {
        let trace = [0.16 + 0.04 * (TAU * t).sin(), 0.025 * (2.0 * TAU * t).sin()];
        m.close("copy x", m.value(k, "copy_x"), 2.5 * trace[0], EXACT);
        m.close("copy y", m.value(k, "copy_y"), 2.5 * trace[1], EXACT);
    }
}

/// OP OQ = 450^2 - 200^2 mm^2 while P runs on a circle through O: Q stays at x = 162500 / 300 mm.
fn peaucellier_draws_a_straight_line(m: &Solved) {
    let straight = 1e-12;
    for (k, t) in m.steps() {
        m.close("line", m.value(k, "line"), 0.1625 / 0.3, straight);
        m.close("inversion", m.value(k, "OP") * m.value(k, "OQ"), 0.1625, straight);
        // P is at half the crank's angle from O.
        let half = 0.5 * 50f64.to_radians() * (TAU * t).sin();
        m.close("stroke", m.value(k, "stroke"), 0.1625 / 0.3 * half.tan(), straight);
    }
}

/// The pin is level with the arm's bearing where 30 + 60 sin(crank) = 0 mm. There the ram rests, 2 * 50 mm apart.
fn quick_return_rests_at_210_and_330_degrees(m: &Solved) {
    let step_of = |degrees: usize| degrees * 240 / 360;
    let (front, back) = (step_of(330), step_of(210));
    for k in [front, back] {
        m.close("rest", m.measure(k, "ram")[1], 0.0, EXACT);
    }
    let speeds: Vec<f64> = m.steps().map(|(k, _)| m.measure(k, "ram")[1]).collect();
    // 240 degrees out of 360 one way, 120 the other: a time ratio of 2.
    assert_eq!(speeds[1..].iter().filter(|v| **v < -EXACT).count(), 159);
    assert_eq!(speeds[1..].iter().filter(|v| **v > EXACT).count(), 79);
    m.close("stroke", m.value(front, "ram") - m.value(back, "ram"), 0.1, EXACT);
    for (k, t) in m.steps() {
        let pin = polar([0.0, 0.03], 0.06, TAU * t);
        let arm = pin[1].atan2(pin[0]);
        let found = m.value(k, "arm_angle") + 0.03_f64.atan2(0.06);
        m.close("arm", (found - arm).sin(), 0.0, EXACT);
        let ram = 0.05 * arm.cos() + (0.15_f64.powi(2) - (0.05 * arm.sin()).powi(2)).sqrt();
        let start = m.hardpoint("ram_pin").x;
        m.close("ram", start + m.value(k, "ram"), ram, 1e-10);
    }
}

/// The right wheel does to the right what the left one does to the left; and both tie rods close, by Rodrigues'
/// formula.
fn rack_steering_is_its_own_mirror_image(m: &Solved) {
    let last = m.file.model.times.len() - 1;
    for (k, t) in m.steps() {
        // The rack's law is odd about the middle of the run.
        m.close("mirror", m.value(k, "left_steer"), -m.value(last - k, "right_steer"), EXACT);
        for side in ["left", "right"] {
            let point = |name: &str| m.hardpoint(&format!("{side}_{name}"));
            let (lower, upper) = (point("kingpin_lower"), point("kingpin_upper"));
            let (inner, outer) = (point("tie_rod_inner"), point("tie_rod_outer"));
            let axis = (upper - lower).unit().unwrap();
            let turn = Mat3::from_rotation_vector(axis * m.value(k, &format!("{side}_steer")));
            let rack = Vec3::new(0.0, 0.075 * (TAU * t).sin(), 0.0);
            let rod = lower + turn * (outer - lower) - (inner + rack);
            m.close("tie rod", rod.norm(), (outer - inner).norm(), EXACT);
        }
    }
    // The rack fully to the right: both wheels turn left, and the left one, on the inside, turns further.
    let k = last * 3 / 4;
    let (inner, outer) = (m.value(k, "left_steer"), m.value(k, "right_steer"));
    assert!(inner > outer && outer > 0.5, "{inner} {outer}");
}

fn rssr_coupler_keeps_its_length(m: &Solved) {
    let [o1, a, b, o2] = ["O1", "A", "B", "O2"].map(|h| m.hardpoint(h));
    let axes = [Vec3::new(0.1, -0.05, 1.0), Vec3::new(0.25, 1.0, -0.1)].map(|v| v.unit().unwrap());
    for (k, t) in m.steps() {
        let crank = Mat3::from_rotation_vector(axes[0] * (TAU * t));
        let rocker = Mat3::from_rotation_vector(axes[1] * m.value(k, "rocker_angle"));
        let coupler = o2 + rocker * (b - o2) - (o1 + crank * (a - o1));
        m.close("coupler", coupler.norm(), (b - a).norm(), EXACT);
    }
}

/// Two plates of length l at the angle q stand 2 l sin q high.
fn sarrus_platform_rises_straight(m: &Solved) {
    let (plate, design) = (0.12_f64.hypot(0.1), 0.1_f64.atan2(0.12));
    for (k, t) in m.steps() {
        let q = design + 25f64.to_radians() * (TAU * t).sin();
        m.close("height", m.value(k, "height"), 2.0 * plate * q.sin(), EXACT);
        m.close("x", m.value(k, "centre.x"), 0.0, EXACT);
        m.close("y", m.value(k, "centre.y"), 0.0, EXACT);
    }
}

/// Height 3 L sin a, where the cylinder is L sqrt(0.01 + 2.24 sin^2 a) long; base n sqrt(L^2 - x^2) as a check.
fn scissor_height_follows_from_the_cylinder(m: &Solved) {
    let length = (0.01_f64 + 2.24 * 0.28 * 0.28).sqrt();
    for (k, t) in m.steps() {
        let cylinder = length + 0.175 * (1.0 - (TAU * t / 20.0).cos());
        m.close("cylinder", m.value(k, "cylinder_length"), cylinder, EXACT);
        let height = 3.0 * ((cylinder * cylinder - 0.01) / 2.24).sqrt();
        m.close("left", m.value(k, "height_left"), height, EXACT);
        m.close("right", m.value(k, "height_right"), height, EXACT);
        let base = 0.96 + m.value(k, "base_roller");
        m.close("base", 3.0 * (1.0 - base * base).sqrt(), height, EXACT);
    }
}

/// x = r cos q + sqrt(l^2 - (r sin q - h)^2), with the pin of the slider at the height h.
fn press_goes_by_its_crank_and_rod(m: &Solved) {
    let (r, l) = (0.06, 0.24_f64);
    for (k, t) in m.steps() {
        let (sin, cos) = (TAU * t).sin_cos();
        let y = r * cos - (l * l - (r * sin).powi(2)).sqrt();
        m.close("stroke", m.value(k, "stroke"), y + 0.18, EXACT);
    }
}

fn slider_crank_follows_its_formula(m: &Solved) {
    let (r, l, h) = (0.2, 0.48_f64.hypot(0.11), 0.05);
    for (k, t) in m.steps() {
        let q = 0.16_f64.atan2(0.12) + (TAU * t).sin();
        let x = r * q.cos() + (l * l - (r * q.sin() - h).powi(2)).sqrt();
        m.close("stroke", m.value(k, "stroke"), x - 0.6, EXACT);
    }
}

fn solid_axle_goes_aside_with_its_panhard_rod(m: &Solved) {
    for rod in ["left_link", "right_link", "upper_link", "panhard_rod"] {
        m.rod(rod, constant);
    }
    m.rod("left_spring", |t| sine(0.06, TAU, t));
    m.rod("right_spring", |t| sine(0.03, 2.0 * TAU, t));
    // The arc: aside by what the rod's rise takes from its length.
    let length = 0.95_f64.hypot(0.06);
    for (k, _) in m.steps() {
        let [x, y, z] = ["panhard_end.x", "panhard_end.y", "panhard_end.z"].map(|p| m.value(k, p));
        let arc = 0.48 - (length * length - (x + 0.12).powi(2) - (z - 0.39).powi(2)).sqrt();
        m.close("arc", y, arc, EXACT);
    }
}

/// The slider is where a rod of 0.3 m from the crank pin (0, 0.1 - 0.08 sin q, 0.12 + 0.08 cos q) meets the x axis.
fn spatial_slider_crank_follows_its_formula(m: &Solved) {
    for (k, t) in m.steps() {
        let (s, c) = (6.0 * t).sin_cos();
        let (y, z) = (0.1 - 0.08 * s, 0.12 + 0.08 * c);
        m.close("slider", m.value(k, "slider"), (0.09 - y * y - z * z).sqrt(), EXACT);
    }
}

fn stewart_legs_follow_their_laws(m: &Solved) {
    let one = |a: f64, t: f64| sine(a, TAU, t);
    let two = |a: f64, t: f64| sine(a, 2.0 * TAU, t);
    let bias = |a: f64, t: f64| swell(a, TAU, t);
    m.rod("leg_1", |t| one(0.06, t));
    m.rod("leg_2", |t| sum(one(0.06, t), two(0.025, t)));
    m.rod("leg_3", |t| sum(one(0.04, t), bias(-0.02, t)));
    m.rod("leg_4", |t| sum(one(0.04, t), bias(0.03, t)));
    m.rod("leg_5", |t| sum(one(0.05, t), two(-0.025, t)));
    m.rod("leg_6", |t| sum(one(0.05, t), two(0.02, t)));
}

/// From the platform's pose back to the motors: each elbow is where the circles about motor and corner meet.
fn three_rrr_inverse_kinematics_give_the_laws(m: &Solved) {
    let plane = |v: Vec3| [v.x, v.y];
    for (k, t) in m.steps() {
        let law = [
            20.0 * (TAU * t).sin(),
            20.0 * (TAU * t + TAU / 3.0).sin(),
            15.0 * (TAU * t + 2.0 * TAU / 3.0).sin() + 5.0,
        ];
        for n in 1..=3 {
            let at = |name: &str| plane(m.hardpoint(&format!("{name}_{n}")));
            let (motor, elbow, corner) = (at("motor"), at("elbow"), at("corner"));
            let (arm, forearm) = (distance(motor, elbow), distance(elbow, corner));
            let now = plane(m.place(k, "platform", &format!("corner_{n}")));
            // The side on which the elbow is in the design configuration.
            let side = ((corner[0] - motor[0]) * (elbow[1] - motor[1])
                - (corner[1] - motor[1]) * (elbow[0] - motor[0]))
                .signum();
            let bent = meet(motor, arm, now, forearm, side);
            let angle = |p: P| (p[1] - motor[1]).atan2(p[0] - motor[0]);
            let turned = angle(bent) - angle(elbow);
            m.close("motor", (turned - law[n - 1].to_radians()).sin(), 0.0, EXACT);
        }
    }
}

/// Freudenstein twice: the rocker is output of the first loop and input of the second.
fn watt_six_bar_is_two_four_bars(m: &Solved) {
    let plane = |name: &str| {
        let p = m.hardpoint(name);
        [p.x, p.y]
    };
    let angle = |from: P, to: P| (to[1] - from[1]).atan2(to[0] - from[0]);
    let (a, b, c, d) = (plane("crank_pivot"), plane("crank_pin"), plane("rocker_pin"), plane("rocker_pivot"));
    let (e, f, g) = (plane("bell_pin"), plane("lever_pin"), plane("lever_pivot"));
    let first = [distance(a, b), distance(b, c), distance(d, c), distance(a, d)];
    let second = [distance(d, e), distance(e, f), distance(g, f), distance(d, g)];
    let ground = angle(d, g);
    for (k, t) in m.steps() {
        let (rocker, lever) = (m.value(k, "rocker_angle"), m.value(k, "lever_angle"));
        m.close("first", freudenstein(first, angle(a, b) + TAU * t, angle(d, c) + rocker), 0.0, EXACT);
        let (phi, psi) = (angle(d, e) + rocker - ground, angle(g, f) + lever - ground);
        m.close("second", freudenstein(second, phi, psi), 0.0, EXACT);
    }
}

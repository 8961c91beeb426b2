//! Vehicles: masses in their frames, spring forces, live axles compared with closed forms and an independent solver,
//! both sides, vehicle parameters, cases, and complete reports.

use hardpoint::model::{BodyId, CaseId};
use hardpoint::space::{Mat3, Vec3};
use hardpoint::{Analysis, Run};
use hardpoint_file::ModelFile;
use hardpoint_import::{ElementOutcome, ImportedModel};
use toml_edit::DocumentMut;

use crate::{folder, import, model, sources};

/// Residual of both solvers, m.
const SOLVED: f64 = 1e-9;
/// Relative round-off of numbers that were written as text.
const WRITTEN: f64 = 1e-12;

fn read(name: &str, text: &str) -> (ImportedModel, ModelFile) {
    let imported =
        hardpoint_import::import(text.as_bytes(), name, &|_| None).unwrap_or_else(|e| panic!("{e}"));
    assert!(imported.fault.is_none(), "{}\n{}", imported.fault.unwrap(), imported.text);
    let file = hardpoint_file::parse(&imported.text, "model.toml")
        .unwrap_or_else(|e| panic!("{e}\n{}", imported.text));
    (imported, file)
}

fn source(path: &str) -> (ImportedModel, ModelFile) {
    let imported = import(&folder().join(path)).unwrap_or_else(|e| panic!("{e}"));
    let file = model(&imported);
    (imported, file)
}

/// Number of a table entry; zero if it is missing.
fn number(doc: &DocumentMut, path: &[&str]) -> f64 {
    let mut item = doc.as_item();
    for key in path {
        match item.get(*key) {
            Some(next) => item = next,
            None => return 0.0,
        }
    }
    item.as_float().or(item.as_integer().map(|i| i as f64)).unwrap_or_else(|| panic!("{path:?}: {item}"))
}

fn near(is: f64, should: f64, what: &str) {
    assert!((is - should).abs() <= WRITTEN * should.abs().max(1.0), "{what}: {is}, not {should}");
}

/// Double wishbone with an upper arm in a plane that is inclined by 45 degrees.
fn leaning(flag: &str, arm: &str, rest: &str) -> String {
    format!(
        r#"{{"Name": "n", "Type": "Suspension", "Template": "DoubleWishbone", {flag}
        "Spindle": {{"Mass": 10, "COM": [0, 0.8, 0.3], "Inertia": [0.1, 0.2, 0.1], "Radius": 0.1}},
        "Upright": {{"Mass": 20, "COM": [0.01, 0.75, 0.31], "Moments of Inertia": [0.3, 0.4, 0.5], "Products of Inertia": [0.01, 0.02, 0.03]}},
        "Upper Control Arm": {{"Mass": 6, "COM": [0, 0.5, 0.3], {arm} "Location Chassis Front": [0.1, 0.4, 0.2],
            "Location Chassis Back": [-0.1, 0.4, 0.2], "Location Upright": [0.0, 0.7, 0.5]}},
        "Lower Control Arm": {{"Location Chassis Front": [0.2, 0.35, 0.1], "Location Chassis Back": [-0.2, 0.35, 0.1], "Location Upright": [0.01, 0.75, 0.12]}},
        "Tierod": {{"Mass": 2, "COM": [-0.19, 0.45, 0.2], "Location Chassis": [-0.2, 0.35, 0.2], "Location Upright": [-0.16, 0.75, 0.2]}}
        {rest}}}"#
    )
}

#[test]
fn masses_of_chrono_parts_come_in_the_frames_that_chrono_gives_them() {
    let inertia = r#""Moments of Inertia": [0.2, 0.3, 0.4], "Products of Inertia": [0.05, 0, 0],"#;
    // x of the arm is that of the vehicle; y = (0, 1, 1)/sqrt 2, z = (0, -1, 1)/sqrt 2: Iyy = Izz = (0.3 + 0.4)/2, the
    // entry yz (0.3 - 0.4)/2, xy and xz 0.05/sqrt 2. Products in the model are their opposites.
    let product = -0.05 / 2_f64.sqrt();
    let own = [0.2, 0.35, 0.35, product, 0.05, product];
    // In the axes of the vehicle, the matrix of the arm is as written.
    let vehicle = [0.2, 0.3, 0.4, -0.05, 0.0, 0.0];
    for (flag, arm) in [("", own), (r#""Vehicle-Frame Inertia": true,"#, vehicle)] {
        let (imported, file) = read("front.json", &leaning(flag, inertia, ""));
        let doc: DocumentMut = imported.text.parse().unwrap();
        let is = |mass: &str, keys: [f64; 6]| {
            for (key, should) in ["ixx", "iyy", "izz", "ixy", "iyz", "izx"].into_iter().zip(keys) {
                near(number(&doc, &["masses", mass, key]), should, &format!("{mass} {key}"));
            }
        };
        is("upper_control_arm", arm);
        // The entries xy, xz, yz of the matrix
        is("upright", [0.3, 0.4, 0.5, -0.01, -0.03, -0.02]);
        is("spindle", [0.1, 0.2, 0.1, 0.0, 0.0, 0.0]);
        // A tie rod has no body: its 2 kg are divided between the rack and the upright.
        let along = Vec3::from([0.04, 0.4, 0.0]);
        let outer = Vec3::from([0.01, 0.1, 0.0]).dot(along) / along.dot(along);
        near(number(&doc, &["masses", "tierod_outer", "mass"]), 2.0 * outer, "outer");
        near(number(&doc, &["masses", "tierod_inner", "mass"]), 2.0 * (1.0 - outer), "inner");
        assert_eq!(file.model.elements.len(), 5, "{}", imported.text);
        let reported: Vec<_> =
            imported.report.of(ElementOutcome::Approximated).filter(|e| e.kind == "mass").collect();
        assert_eq!(reported.iter().map(|e| e.name.as_str()).collect::<Vec<_>>(), ["tierod"]);
        near(number(&doc, &["gravity", "acceleration"]), 9.80665, "gravity");
    }
}

#[test]
fn masses_of_generic_bodies_turn_with_their_rotation() {
    let path = folder().join("chrono/generic.json");
    let text = std::fs::read_to_string(path).unwrap();
    // A rotation by 45 degrees about x.
    let (s, c) = (std::f64::consts::FRAC_PI_8).sin_cos();
    let upright = "\"Name\": \"Upright\", \"Mirrored\": true, \"Position\": [ 0.0, 0.72, 0.0 ], \"Rotation\": [ 1, 0, 0, 0 ], \"Mass\": 18.0,\n      \"Moments of Inertia\": [ 0.1, 0.1, 0.1 ]";
    let turned = format!(
        "\"Name\": \"Upright\", \"Mirrored\": true, \"Position\": [ 0.0, 0.72, 0.0 ], \"Rotation\": [ {c}, {s}, 0, 0 ], \"Mass\": 18.0,\n      \"Moments of Inertia\": [ 0.3, 0.2, 0.4 ]"
    );
    assert!(text.contains(upright));
    let (imported, _) = read("g.json", &text.replace(upright, &turned));
    let doc: DocumentMut = imported.text.parse().unwrap();
    // y = (0, 1, 1)/sqrt 2, z = (0, -1, 1)/sqrt 2
    for (key, should) in
        [("ixx", 0.3), ("iyy", 0.3), ("izz", 0.3), ("iyz", 0.1), ("ixy", 0.0), ("mass", 18.0)]
    {
        near(number(&doc, &["masses", "Upright", key]), should, key);
    }
}

/// Bushing data of Chrono.
fn bushing(slide: f64, turn: f64, free: f64, damping: f64) -> String {
    format!(
        r#""Bushing Data": {{"Stiffness Linear": {slide}, "Stiffness Rotational": {turn}, "Damping Linear": {damping}, "Damping Rotational": 0,
        "DOF": {{"Stiffness Linear": 0, "Damping Linear": 0, "Stiffness Rotational": {free}, "Damping Rotational": 0}}}},"#
    )
}

#[test]
fn bushings_of_chrono_deflect_where_chrono_has_them() {
    let data = bushing(2e5, 900.0, 12.0, 0.0);
    let (imported, _) = read("front.json", &leaning("", &data, ""));
    let of = |fate| imported.report.of(fate).filter(|e| e.kind == "Bushing Data").count();
    assert_eq!(of(ElementOutcome::Taken), 1, "{}", imported.report);
    assert_eq!(imported.report.of(ElementOutcome::NotUnderstood).count(), 0, "{}", imported.report);
    // The same with a bushing instead of the hinge, halfway between its pivots and along its axis.
    let mut doc: DocumentMut = imported.text.parse().unwrap();
    let point = |body: &str| format!("{{ body = \"{body}\", at = [0.0, 0.4, 0.2] }}");
    let joints = doc["joints"].as_table_mut().unwrap();
    assert!(joints.remove("upper_arm_pivot").is_some());
    let forces = doc["forces"].as_table_mut().unwrap();
    assert!(forces.remove("upper_arm_pivot_bushing").is_some());
    doc["design"].as_table_mut().unwrap().clear();
    let per_degree = |x: f64| x.to_radians();
    let own = format!(
        "[forces.own]\ntype = \"bushing\"\nfrom = {}\nto = {}\naxis = \"x\"\naxis2 = \"z\"\nx = 2e5\ny = 2e5\nz = 2e5\n\
         about_x = {a}\nabout_y = {a}\nabout_z = {}\n",
        point("ground"),
        point("upper_arm"),
        per_degree(12.0),
        a = per_degree(900.0)
    );
    let load = "[forces.side]\ntype = \"wheel_force\"\nwheel = \"wheel\"\noutboard = 3\nforward = 2\nlaw = \"t\"\n\
        [equilibrium]\n[time]\nend = 1\nsteps = 4\n";
    let camber = |text: &str, further: &str| {
        // Without the weights, whose deflections are larger
        let text = text.replace("acceleration = 9.80665", "acceleration = 0");
        let text =
            text.split("[time]").next().unwrap_or_default().replace("law = \"0.06*sin(2*pi*t)\"", "law = 0");
        let text = text.split("[cases").next().unwrap_or_default().to_owned();
        measured(&text, &format!("{further}{load}"), "", &["wheel.camber", "wheel.toe"])
    };
    let [found, wanted] = [camber(&imported.text, ""), camber(&doc.to_string(), &own)];
    for k in 0..2 {
        let change = |of: &[Vec<f64>], n: usize| of[k][n] - of[k][0];
        assert!(change(&wanted, 4).abs() > 1e-7, "{wanted:?}");
        for n in 1..5 {
            let [a, b] = [change(&found, n), change(&wanted, n)];
            // Angles of the bushing are about 1e-5 rad, whose squares the matrix neglects.
            assert!((a - b).abs() < 1e-4 * b.abs(), "{k} {n}: {a} instead of {b}");
        }
    }
    // Damping is reported, and so are bushings that have no hinge or no stiffness.
    for (arm, fate) in [
        (bushing(2e5, 900.0, 12.0, 5.0), ElementOutcome::Approximated),
        (bushing(2e5, 0.0, 12.0, 0.0), ElementOutcome::Refused),
        (bushing(-2e5, 900.0, 12.0, 0.0), ElementOutcome::Refused),
    ] {
        let (imported, _) = read("front.json", &leaning("", &arm, ""));
        let entries: Vec<_> = imported.report.entries.iter().filter(|e| e.kind == "Bushing Data").collect();
        assert!(entries.len() == 1 && entries[0].fate == fate, "{}", imported.report);
    }
    let text = leaning("", "", "").replace("\"Tierod\": {", &format!("\"Tierod\": {{{data}"));
    let (imported, _) = read("front.json", &text);
    let refused: Vec<_> = imported.report.of(ElementOutcome::Refused).collect();
    assert!(refused.iter().any(|e| e.kind == "Bushing Data" && e.name == "Tierod"), "{}", imported.report);
}

#[test]
fn bushings_of_generic_joints_have_the_axes_of_the_joints() {
    let text = std::fs::read_to_string(folder().join("chrono/generic.json")).unwrap();
    let data = bushing(3e5, 700.0, 15.0, 0.0);
    let joint = |kind: &str| {
        text.replace(
            "\"Type\": \"Spherical\", \"Mirrored\": true, \"Body1\": \"Upper Arm\"",
            &format!("\"Type\": \"{kind}\", {data} \"Mirrored\": true, \"Body1\": \"Upper Arm\""),
        )
    };
    for (kind, turns) in [("Spherical", [15.0; 3]), ("Universal", [15.0, 700.0, 15.0])] {
        // A cross instead of the ball leaves no degree of freedom, which the check of the model reports.
        let imported = hardpoint_import::import(joint(kind).as_bytes(), "g.json", &|_| None).unwrap();
        let doc: DocumentMut = imported.text.parse().unwrap();
        let of = |key: &str| number(&doc, &["forces", "Upper Ball_bushing", key]);
        for (k, key) in ["x", "y", "z"].into_iter().enumerate() {
            near(of(key), 3e5, key);
            near(of(&format!("about_{key}")), f64::to_radians(turns[k]), key);
        }
    }
    let (imported, _) = read("g.json", &joint("Point Plane"));
    let refused: Vec<_> =
        imported.report.of(ElementOutcome::Refused).filter(|e| e.kind == "Bushing Data").collect();
    assert_eq!(refused.len(), 1, "{}", imported.report);
}

/// Values of measures at all output times of a case; `further` is appended to the text.
fn measured(text: &str, further: &str, case: &str, names: &[&str]) -> Vec<Vec<f64>> {
    let text = format!("{text}\n{further}");
    let file = hardpoint_file::parse(&text, "m.toml").unwrap_or_else(|e| panic!("{e}\n{text}"));
    let case = file.model.cases.iter().position(|c| c.name == case);
    let model = case.map_or(file.model.clone(), |k| file.in_case(CaseId(k)).model);
    let run = Analysis::new(&model).unwrap().run();
    let column = |name: &&str| {
        let k =
            run.measured.outputs.iter().position(|o| o.name == **name).unwrap_or_else(|| panic!("{name}"));
        (0..run.motion.len()).map(|step| run.measured.value(step, k)[0]).collect()
    };
    names.iter().map(column).collect()
}

#[test]
fn springs_and_dampers_of_chrono_have_its_forces() {
    let rest = r#", "Spring": {"Location Chassis": [0, 0.5, 0.7], "Location Arm": [0, 0.6, 0.12], "Spring Coefficient": 40000, "Free Length": 0.62, "Preload": 300},
        "Shock": {"Location Chassis": [0.05, 0.5, 0.7], "Location Arm": [0.05, 0.6, 0.12], "Damping Coefficient": 2500}"#;
    let (imported, _) = read("front.json", &leaning("", "", rest));
    let further = "[measures.spring]\ntype = \"spring_force\"\nforce = \"spring\"\n[measures.damper]\ntype = \"spring_force\"\nforce = \"damper\"\n\
        [measures.length]\ntype = \"coordinate\"\njoint = \"spring\"\n[measures.damper_length]\ntype = \"coordinate\"\njoint = \"damper\"\n\
        [measures.speed]\ntype = \"rate\"\nof = \"damper_length\"\n";
    let names = ["spring", "length", "damper", "speed"];
    let found = measured(&imported.text, further, "bump", &names);
    let largest = |k: usize| found[k].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(largest(0) > 1000.0 && largest(2) > 100.0, "{} {}", largest(0), largest(2));
    for step in 0..found[0].len() {
        // The compressive force is 300 - 40000 (L - 0.62), tension is its negative.
        let tension = 40_000.0 * (found[1][step] - 0.62) - 300.0;
        assert!((found[0][step] - tension).abs() < 1e-6, "{} {tension}", found[0][step]);
        assert!((found[2][step] - 2500.0 * found[3][step]).abs() < 1e-6, "{step}");
    }
    // A curve of deformation and force: the length in the design configuration is 0.58856..., so the table has a point
    // 0.05 m shorter than 0.63856...
    let length = 0.1_f64.hypot(0.58);
    let curve = format!(
        r#", "Spring": {{"Location Chassis": [0, 0.5, 0.7], "Location Arm": [0, 0.6, 0.12], "Free Length": {}, "Spring Curve Data": [[-0.1, -5200], [-0.05, -2000], [0, 0], [0.05, 1000]]}},
        "Shock": {{"Location Chassis": [0.05, 0.5, 0.7], "Location Arm": [0.05, 0.6, 0.12], "Damping Curve Data": [[-1, -500], [1, 900]], "Minimum Length": 0.4}}"#,
        length + 0.05
    );
    let (imported, _) = read("front.json", &leaning("", "", &curve));
    let found = measured(
        &imported.text,
        "[measures.spring]\ntype = \"spring_force\"\nforce = \"spring\"\n",
        "bump",
        &["spring"],
    );
    assert!((found[0][0] + 2000.0).abs() < 1e-6, "{}", found[0][0]);
    let refused: Vec<&str> = imported.report.of(ElementOutcome::Refused).map(|e| e.kind.as_str()).collect();
    assert_eq!(refused, ["Minimum Length", "Damping Curve Data"]);
    assert!(imported.report.of(ElementOutcome::Approximated).any(|e| e.kind == "Spring Curve Data"));
}

/// Applies a pose of six numbers, a displacement and a rotation vector about the origin, to a point.
fn placed(q: &[f64; 6], p: Vec3) -> Vec3 {
    let turn = Vec3::from([q[3], q[4], q[5]]);
    let rot = turn.unit().map_or(Mat3::IDENTITY, |axis| Mat3::about(axis, turn.norm()));
    Vec3::from([q[0], q[1], q[2]]) + rot * p
}

/// Solves six equations for a pose by Newton's method with finite differences.
fn solve(residual: &dyn Fn(&[f64; 6]) -> [f64; 6]) -> [f64; 6] {
    let mut q = [0.0; 6];
    for _ in 0..30 {
        let r = residual(&q);
        let mut a = [[0.0; 7]; 6];
        for k in 0..6 {
            let h = 1e-6;
            let [mut more, mut less] = [q, q];
            (more[k], less[k]) = (q[k] + h, q[k] - h);
            let (more, less) = (residual(&more), residual(&less));
            (0..6).for_each(|row| a[row][k] = (more[row] - less[row]) / (2.0 * h));
        }
        (0..6).for_each(|row| a[row][6] = r[row]);
        for k in 0..6 {
            let pivot = (k..6).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs())).unwrap();
            a.swap(k, pivot);
            for row in (0..6).filter(|row| *row != k) {
                let f = a[row][k] / a[k][k];
                (k..7).for_each(|c| a[row][c] -= f * a[k][c]);
            }
        }
        (0..6).for_each(|k| q[k] -= a[k][6] / a[k][k]);
    }
    q
}

/// Displacements of the points of a body in a case, from the design configuration, in the unit of the file.
fn moved(file: &ModelFile, case: &str, body: &str) -> Vec<impl Fn(Vec3) -> Vec3 + use<>> {
    let k = file.model.cases.iter().position(|c| c.name == case).unwrap();
    let model = file.in_case(CaseId(k)).model;
    let body = BodyId(model.bodies.iter().position(|b| b.name == body).unwrap());
    let drawn = model.bodies[body.0].frame;
    let solution = Analysis::new(&model).unwrap().solve(Run::new().without_sensitivities());
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    let states = (0..solution.motion.len()).map(|step| solution.body(step, body));
    states.map(move |s| move |p: Vec3| s.r + s.rotation * drawn.rot.transpose_mul(p - drawn.r)).collect()
}

#[test]
fn an_axle_on_a_panhard_rod_heaves_on_its_arc() {
    let (_, file) = source("chrono/panhard_axle.json");
    let [chassis, axle] = [[-0.11, 0.46, 0.1], [-0.11, -0.49, 0.03]].map(Vec3::from);
    let length = (chassis - axle).norm();
    let mut aside = 0.0_f64;
    for (step, place) in moved(&file, "heave", "axle").into_iter().enumerate() {
        let z = 0.06 * (std::f64::consts::TAU * step as f64 / 100.0).sin();
        // y = yC - sqrt(L^2 - (z - zC)^2), x and the axle's orientation stay.
        let y = chassis.y - (length.powi(2) - (axle.z + z - chassis.z).powi(2)).sqrt();
        let expected = Vec3::from([axle.x, y, axle.z + z]);
        assert!((place(axle) - expected).norm() < SOLVED, "step {step}: {:?} {expected:?}", place(axle));
        aside = aside.max((y - axle.y).abs());
    }
    assert!(aside > 1e-3, "{aside}");
}

#[test]
fn an_axle_on_a_triangle_and_two_links_moves_as_an_independent_solver_says_and_alike_to_both_sides() {
    let (_, file) = source("chrono/three_link_axle.json");
    let at = |v: [f64; 3], side: f64| Vec3::from([v[0], side * v[1], v[2]]);
    let (pivot, ball) = (Vec3::from([0.62, 0.0, 0.21]), Vec3::from([0.03, 0.0, 0.24]));
    let rods = [1.0, -1.0].map(|s| [at([0.71, 0.41, -0.06], s), at([0.02, 0.46, -0.11], s)]);
    let wheels = [1.0, -1.0].map(|s| at([0.0, 0.88, 0.0], s));
    for (case, travel) in [("heave", [0.06, 0.06]), ("roll", [0.04, -0.04])] {
        let poses = moved(&file, case, "axle");
        for (step, place) in poses.iter().enumerate() {
            let wave = (std::f64::consts::TAU * step as f64 / 100.0).sin();
            let q = solve(&|q| {
                let rod =
                    |k: usize| (placed(q, rods[k][1]) - rods[k][0]).norm() - (rods[k][1] - rods[k][0]).norm();
                let wheel = |k: usize| placed(q, wheels[k]).z - wheels[k].z - travel[k] * wave;
                let b = placed(q, ball);
                [b.y, (b - pivot).norm() - (ball - pivot).norm(), rod(0), rod(1), wheel(0), wheel(1)]
            });
            for p in [ball, rods[0][1], rods[1][1], wheels[0], wheels[1]] {
                let (is, should) = (place(p), placed(&q, p));
                assert!((is - should).norm() < SOLVED, "{case} {step}: {is:?} {should:?}");
            }
            // Half a period later, the roll position is the mirror image.
            if case == "roll" && step <= 50 {
                let (left, right) = (place(wheels[0]), poses[step + 50](wheels[1]));
                let image = Vec3::from([right.x, -right.y, right.z]);
                assert!((left - image).norm() < SOLVED, "{step}: {left:?} {right:?}");
            }
        }
    }
}

#[test]
fn a_live_axle_of_adams_car_is_recognised_by_its_names() {
    let (imported, file) = source("teimorbit/solid_axle.sub");
    // x forward and y left, in m.
    let at = |v: [f64; 3]| Vec3::from(v) * 1e-3;
    let rods = [
        [[550.0, 440.0, 280.0], [30.0, 490.0, 225.0]],
        [[550.0, -440.0, 280.0], [30.0, -490.0, 225.0]],
        [[440.0, -40.0, 490.0], [30.0, -50.0, 475.0]],
        [[-130.0, 470.0, 380.0], [-130.0, -460.0, 340.0]],
    ]
    .map(|rod| rod.map(at));
    let wheels = [[0.0, 730.0, 310.0], [0.0, -730.0, 310.0]].map(at);
    let mut most = 0.0_f64;
    for (case, travel) in [("heave", [0.06, 0.06]), ("roll", [0.04, -0.04])] {
        for (step, place) in moved(&file, case, "axle").into_iter().enumerate() {
            let wave = (std::f64::consts::TAU * step as f64 / 100.0).sin();
            let q = solve(&|q| {
                let rod =
                    |k: usize| (placed(q, rods[k][1]) - rods[k][0]).norm() - (rods[k][1] - rods[k][0]).norm();
                let wheel = |k: usize| placed(q, wheels[k]).z - wheels[k].z - travel[k] * wave;
                [rod(0), rod(1), rod(2), rod(3), wheel(0), wheel(1)]
            });
            for p in wheels {
                assert!((place(p) - placed(&q, p)).norm() < SOLVED, "{case} {step}");
                most = most.max((place(p) - p).y.abs());
            }
        }
    }
    assert!(most > 1e-3, "{most}");
    let doc: DocumentMut = imported.text.parse().unwrap();
    for (path, should) in [
        (["vehicle", "wheelbase", ""], 2870.0),
        (["vehicle", "cg_height", ""], 610.0),
        (["wheels", "wheel_left", "radius"], 305.0),
        (["masses", "rear_axle", "mass"], 92.0),
        (["masses", "rear_axle", "ixx"], 18.0),
        (["masses", "rear_axle", "iyy"], 1.5),
        // Half a turn about z changes the sign of the product of z and x.
        (["masses", "rear_axle", "izx"], -0.04),
    ] {
        let path: Vec<&str> = path.into_iter().filter(|key| !key.is_empty()).collect();
        near(number(&doc, &path), should, &path.join("."));
    }
    assert!(
        imported.text.contains("end = \"rear\"") && imported.text.contains("[mirror]"),
        "{}",
        imported.text
    );
    let report = imported.report.to_string();
    assert!(report.contains("NSPRING_ASSEMBLY `ride_spring`: its characteristic is in the property file `springs.tbl/rear.spr`"), "{report}");
    assert_eq!(imported.report.of(ElementOutcome::NotUnderstood).count(), 0, "{report}");
}

/// File of the axle with another set of hardpoints.
fn hardpoints(rows: &[(&str, &str, [f64; 3])]) -> String {
    let rows: String =
        rows.iter().map(|(name, side, [x, y, z])| format!("'{name}' '{side}' {x} {y} {z}\n")).collect();
    format!(
        "[UNITS]\nLENGTH = 'mm'\n[HARDPOINT]\n{{hardpoint_name symmetry x_value y_value z_value}}\n{rows}"
    )
}

const BOTH: &str = "left/right";
const WHEEL: (&str, &str, [f64; 3]) = ("wheel_center", BOTH, [0.0, -730.0, 310.0]);
const LOWER: [(&str, &str, [f64; 3]); 2] = [
    ("trailing_arm_front", BOTH, [-550.0, -440.0, 280.0]),
    ("trailing_arm_rear", BOTH, [-30.0, -490.0, 225.0]),
];

#[test]
fn a_watt_linkage_holds_its_pivot_nearly_on_a_line() {
    let rows = [
        WHEEL,
        LOWER[0],
        LOWER[1],
        ("upper_link_frame", "single", [-440.0, 40.0, 490.0]),
        ("upper_link_axle", "single", [-30.0, 50.0, 475.0]),
        ("watts_pivot", "single", [60.0, 0.0, 310.0]),
        ("watts_link_frame", "left", [60.0, -400.0, 370.0]),
        ("watts_link_lever", "left", [60.0, 0.0, 370.0]),
        ("watts_link_frame", "right", [60.0, 400.0, 250.0]),
        ("watts_link_lever", "right", [60.0, 0.0, 250.0]),
    ];
    let (imported, file) = read("watt.sub", &hardpoints(&rows));
    assert!(imported.text.contains("[joints.watt_pivot]"), "{}", imported.text);
    let pivot = Vec3::from([-0.06, 0.0, 0.31]);
    for (step, place) in moved(&file, "heave", "axle").into_iter().enumerate() {
        let p = place(pivot);
        // A Panhard rod of the length of one of its links would move 4.5 mm laterally.
        assert!(p.y.abs() < 2e-4, "{step}: {p:?}");
    }
}

#[test]
fn five_rods_leave_one_driver_and_unknown_names_are_reported() {
    let five = [
        WHEEL,
        LOWER[0],
        LOWER[1],
        ("upper_link_frame", BOTH, [-440.0, -300.0, 490.0]),
        ("upper_link_axle", BOTH, [-30.0, -350.0, 475.0]),
        ("track_bar_frame", "single", [130.0, -470.0, 380.0]),
        ("track_bar_axle", "single", [130.0, 460.0, 340.0]),
    ];
    let (imported, file) = read("five.sub", &hardpoints(&five));
    assert_eq!(file.model.named_joints().filter(|(_, j)| j.kind.name == "distance").count(), 5);
    let reported = imported.report.to_string();
    assert!(reported.contains("its five rods leave one degree of freedom"), "{reported}");
    assert_eq!(imported.text.matches("bump = \"bump\"").count(), 1, "{}", imported.text);
    let import = |rows: &[(&str, &str, [f64; 3])]| {
        let text = hardpoints(rows);
        hardpoint_import::import(text.as_bytes(), "a.sub", &|_| None).unwrap_or_else(|e| panic!("{e}"))
    };
    let leaf = [
        WHEEL,
        ("leaf_front_eye", BOTH, [-500.0, -400.0, 300.0]),
        ("panhard_frame", "single", [0.0, 1.0, 2.0]),
    ];
    let imported = import(&leaf);
    let fault = imported.fault.unwrap().to_string();
    assert!(fault.contains("HP0807") && fault.contains("`leaf_front_eye`, `panhard_frame`"), "{fault}");
    assert!(imported.report.to_string().contains("leaf springs guide the axle by bending"));
}

#[test]
fn figures_of_the_vehicle_come_from_suspension_explorer() {
    let path = folder().join("suspension-explorer/wishbone.yaml");
    let text = std::fs::read_to_string(path).unwrap();
    let (imported, _) = read("w.yaml", &text);
    let doc: DocumentMut = imported.text.parse().unwrap();
    near(number(&doc, &["vehicle", "wheelbase"]), 2500.0, "wheelbase");
    // Radius of the tyre: 0.5 x 200 mm and half of 15 inches.
    let radius = 0.5 * 200.0 + 15.0 * 25.4 / 2.0;
    near(number(&doc, &["wheels", "wheel", "radius"]), radius, "radius");
    // The road is below the wheel, with an axis that drops by 2 in 120.
    let road = 298.0 - radius * 120.0 / 2_f64.hypot(120.0);
    near(number(&doc, &["vehicle", "cg_height"]), 400.0 - road, "centre of gravity");
    assert!(imported.text.contains("steer = \"steering\""), "{}", imported.text);
    let more = text.replace(
        "wheelbase: 2500.0",
        "wheelbase: 2500.0\n  front_brake_bias: 0.6\n  driven_axle: rear\n  axle_position: rear\n  anti_roll: {type: t_bar}\n  colour: red",
    );
    let (imported, _) = read("w.yaml", &more);
    let doc: DocumentMut = imported.text.parse().unwrap();
    near(number(&doc, &["vehicle", "front_brake_share"]), 0.6, "brakes");
    assert!(imported.text.contains("front_drive_share = 0.0") && imported.text.contains("end = \"rear\""));
    let of = |fate| imported.report.of(fate).map(|e| e.kind.clone()).collect::<Vec<_>>();
    assert_eq!(of(ElementOutcome::NotUnderstood), ["colour"]);
    let refused = of(ElementOutcome::Refused);
    assert!(["spring", "damper", "anti_roll"].iter().all(|k| refused.iter().any(|r| r == k)), "{refused:?}");
    let (imported, _) =
        read("w.yaml", &text.replace("wheelbase: 2500.0", "wheelbase: -1\n  driven_axle: both"));
    let refused: Vec<&str> = imported.report.of(ElementOutcome::Refused).map(|e| e.kind.as_str()).collect();
    assert!(["wheelbase", "driven_axle"].iter().all(|k| refused.contains(k)), "{refused:?}");
    // The same file in metres.
    let metres =
        text.replace("units: millimeters", "units: meters").replace("wheelbase: 2500.0", "wheelbase: 2.5");
    let imported = hardpoint_import::import(metres.as_bytes(), "w.yaml", &|_| None).unwrap();
    let doc: DocumentMut = imported.text.parse().unwrap();
    near(number(&doc, &["vehicle", "wheelbase"]), 2.5, "wheelbase");
    near(number(&doc, &["wheels", "wheel", "radius"]), radius * 1e-3, "radius");
}

#[test]
fn the_right_side_is_left_to_a_mirror_where_it_is_the_image_of_the_left_one() {
    let mut mirrored = Vec::new();
    let formats = ["chrono", "lotus", "suspension-explorer", "teimorbit"];
    for (format, path) in sources().into_iter().filter(|(format, _)| formats.contains(&format.as_str())) {
        let imported = import(&path).unwrap();
        let text = &imported.text;
        let name = format!("{format}/{}", path.file_name().unwrap().to_string_lossy());
        if !text.contains("[mirror]") {
            continue;
        }
        let file = model(&imported);
        // Every imported element exists on both sides.
        let m = &file.model;
        let names: Vec<&str> = m
            .bodies
            .iter()
            .map(|b| b.name.as_str())
            .chain(m.named_joints().map(|(_, j)| j.name.as_str()))
            .chain(m.elements.iter().map(|x| x.name.as_str()))
            .chain(m.wheels.iter().map(|x| x.name.as_str()))
            .collect();
        let entries = imported
            .report
            .of(ElementOutcome::Taken)
            .filter(|e| ["link", "mass", "force", "wheel"].contains(&e.kind.as_str()));
        for entry in entries {
            assert!(names.contains(&entry.name.as_str()), "{name}: {} {}", entry.kind, entry.name);
        }
        // Hardpoints of both sides are mirror images.
        for h in m.hardpoints.iter().filter(|h| !h.unnamed) {
            if let Some(base) = h.name.strip_suffix("_left") {
                let twin = m.hardpoints.iter().find(|t| t.name == format!("{base}_right")).unwrap();
                let image = Vec3::from([h.position.x, -h.position.y, h.position.z]);
                assert!((twin.position - image).norm() < WRITTEN, "{name}: {}", h.name);
            }
        }
        assert!(m.cases.iter().any(|c| c.name == "roll"), "{name}");
        mirrored.push(name);
    }
    let expected = [
        "chrono/de_dion.json",
        "chrono/panhard_axle.json",
        "chrono/three_link_axle.json",
        "suspension-explorer/axle.yaml",
        "teimorbit/solid_axle.sub",
        "teimorbit/wishbone.sub",
    ];
    assert!(expected.iter().all(|e| mirrored.iter().any(|m| m == e)), "{mirrored:?}");
    // With the steering on one side, both sides are written, and one variable moves both.
    let (imported, file) = source("chrono/bellcrank_axle.json");
    assert!(imported.text.contains("steer = \"steering\""), "{}", imported.text);
    assert!(file.model.cases.iter().any(|c| c.name == "steer"));
    let uneven = std::fs::read_to_string(folder().join("teimorbit/wishbone.sub")).unwrap();
    let uneven = uneven.replace(
        "'lca_outer'                'left/right'        12.0000    -738.0000     148.0000",
        "'lca_outer' 'left' 12.0 -738.0 148.0\n 'lca_outer' 'right' 12.0 739.0 148.0",
    );
    let (imported, file) = read("uneven.sub", &uneven);
    assert!(!imported.text.contains("[mirror]"), "{}", imported.text);
    let both = "lca_front = { move = \"lca_front_left\", along = \"xyz\", mirror = \"y\", mirrored = \"lca_front_right\" }";
    assert!(imported.text.contains(both), "{}", imported.text);
    // Points without a mirror image have their own variables.
    let variables: Vec<&str> = file.model.variables.iter().map(|v| v.name.as_str()).collect();
    assert!(
        ["lca_outer_left_x", "lca_outer_right_y", "lca_front_y"].iter().all(|v| variables.contains(v)),
        "{variables:?}"
    );
}

#[test]
fn every_key_of_a_part_is_accounted_for() {
    let rest = r#", "Spring": {"Location Chassis": [0, 0.5, 0.7], "Location Arm": [0, 0.6, 0.12], "Spring Coefficient": 40000, "Colour": 3},
        "Axle": {"Inertia": 0.4}, "Turbo": {"Mass": 3}"#;
    let arm = r#""Bushing Data": {"Stiffness Linear": 7e7},"#;
    let (imported, _) = read("front.json", &leaning("", arm, rest));
    let of = |fate| imported.report.of(fate).map(|e| e.kind.clone()).collect::<Vec<_>>();
    assert_eq!(of(ElementOutcome::NotUnderstood), ["Colour", "Turbo"]);
    assert_eq!(of(ElementOutcome::Refused), ["Axle", "Bushing Data"]);
    assert_eq!(of(ElementOutcome::Ignored), ["Radius"]);
}

#[test]
fn travels_that_lock_the_mechanism_are_reduced_with_and_without_cases() {
    let yaml = "type: trailing_arm\nside: left\nname: short\nversion: 0.1.0\nunits: millimeters\nhardpoints:\n\
        \x20 trailing_arm_pivot_a: {x: 60, y: 500, z: 300}\n  trailing_arm_pivot_b: {x: 60, y: 700, z: 300}\n\
        \x20 axle_inboard: {x: 5, y: 800, z: 300}\n  axle_outboard: {x: 5, y: 1000, z: 300}\n\
        config:\n  steering:\n    type: none\n  wheel:\n    offset: 0\n    tire: {aspect_ratio: 0.55, section_width: 270, rim_diameter: 13}\n";
    let rows = [
        ("wheel_center", [0.0, -760.0, 310.0]),
        ("lca_front", [-140.0, -660.0, 180.0]),
        ("lca_rear", [150.0, -660.0, 180.0]),
        ("lca_outer", [0.0, -700.0, 170.0]),
        ("uca_front", [-110.0, -630.0, 470.0]),
        ("uca_rear", [130.0, -630.0, 470.0]),
        ("uca_outer", [15.0, -670.0, 480.0]),
        ("tierod_inner", [130.0, -330.0, 235.0]),
        ("tierod_outer", [140.0, -690.0, 230.0]),
    ];
    let axle = hardpoints(&rows.map(|(name, place)| (name, BOTH, place)));
    for (name, text, drivers) in
        [("short.yaml", yaml, &["bump"][..]), ("short.sub", &axle, &["bump_left", "bump_right"])]
    {
        let (imported, file) = read(name, text);
        let solution = Analysis::new(&file.model).unwrap().solve(Run::new().without_sensitivities());
        assert!(solution.stop.is_none(), "{:?}\n{}", solution.stop, imported.text);
        let doc: DocumentMut = imported.text.parse().unwrap();
        assert_eq!(doc["drivers"][drivers[0]]["law"].as_str(), Some("30*sin(2*pi*t)"));
        let reduced = imported.report.of(ElementOutcome::Approximated).filter(|e| e.why.contains("locks"));
        assert_eq!(reduced.map(|e| e.name.as_str()).collect::<Vec<_>>(), drivers, "{}", imported.report);
    }
}

#[test]
fn hardpoints_of_adams_car_without_a_role_are_reported() {
    let panhard = [
        WHEEL,
        ("lower_link_frame", BOTH, [-500.0, -450.0, 300.0]),
        ("lower_link_axle", BOTH, [-20.0, -500.0, 260.0]),
        ("upper_link_frame", BOTH, [-450.0, -300.0, 450.0]),
        ("upper_link_axle", BOTH, [-30.0, -320.0, 480.0]),
        ("panhard_frame", "single", [100.0, -480.0, 400.0]),
        ("panhard_axle", "single", [100.0, 470.0, 390.0]),
        ("damper_frame", BOTH, [50.0, -450.0, 700.0]),
        ("damper_axle", BOTH, [60.0, -500.0, 300.0]),
        ("subframe_front", BOTH, [-100.0, -300.0, 300.0]),
        ("sway_link_frame", BOTH, [-100.0, -300.0, 300.0]),
    ];
    let links = [
        WHEEL,
        ("tierod_inner", BOTH, [130.0, -330.0, 235.0]),
        ("tierod_outer", BOTH, [140.0, -690.0, 230.0]),
        ("front_lower_inner", BOTH, [-100.0, -350.0, 200.0]),
        ("front_lower_outer", BOTH, [-20.0, -680.0, 190.0]),
        ("rear_lower_inner", BOTH, [100.0, -350.0, 200.0]),
        ("rear_lower_outer", BOTH, [20.0, -690.0, 195.0]),
        ("front_upper_inner", BOTH, [-80.0, -400.0, 450.0]),
        ("front_upper_outer", BOTH, [-10.0, -660.0, 460.0]),
        ("rear_upper_inner", BOTH, [90.0, -410.0, 440.0]),
        ("rear_upper_outer", BOTH, [30.0, -650.0, 455.0]),
        ("subframe_front", BOTH, [-100.0, -300.0, 300.0]),
    ];
    for (rows, unused) in
        [(&panhard[..], &["subframe_front", "sway_link_frame"][..]), (&links, &["subframe_front"])]
    {
        let (imported, _) = read("a.sub", &hardpoints(rows));
        let listed: Vec<_> =
            imported.report.of(ElementOutcome::Approximated).filter(|e| e.kind == "hardpoint").collect();
        assert_eq!(listed.iter().map(|e| e.name.as_str()).collect::<Vec<_>>(), unused, "{}", imported.report);
        assert!(
            listed.iter().all(|e| e.why.contains("no member follows from its name") && e.place.is_some())
        );
        let taken = imported.report.of(ElementOutcome::Taken).filter(|e| e.kind == "hardpoint").count();
        assert_eq!(taken, rows.len() - unused.len());
    }
    let (imported, _) = read("a.sub", &hardpoints(&panhard));
    assert!(imported.text.contains("[joints.damper_left]"), "{}", imported.text);
}

//! Masses and forces in model files: units, parameters, mirrors, included files, planes, and invalid entries.

use std::path::Path;

use hardpoint::model::{CaseId, Dimension, Metric, Model, OutputSource, Reduction, VariableId};
use hardpoint::motion::BodyState;
use hardpoint::space::{Mat3, Vec3};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::{ModelFile, parse};
use toml_edit::{Array, DocumentMut, InlineTable, Table, Value};

use crate::diagnostics::snapshot;

/// The same numbers in other units, and from the other side: round-off only.
const SAME: f64 = 1e-11;

fn file(text: &str) -> ModelFile {
    parse(text, "loads.toml").unwrap_or_else(|e| panic!("{e}"))
}

pub fn solved(file: &ModelFile) -> Solution {
    let solution = Analysis::new(&file.model).unwrap().run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    solution
}

pub fn values(solution: &Solution, name: &str) -> Vec<f64> {
    let m = solution.measured.index(name).unwrap_or_else(|| panic!("{name}"));
    (0..solution.motion.len()).map(|k| solution.measured.value(k, m)[0]).collect()
}

/// A lever with everything that has a unit, its lengths in mm and angles in deg, or in m and rad.
fn lever(units: &str, lengths: f64, angles: f64) -> String {
    let l = |x: f64| x * lengths;
    let (k, c, cubic) = (30.0 / lengths, 0.4 / lengths, 5.0 / (lengths * lengths * lengths));
    let (about, twist) = (0.2 / angles, 0.01 / angles);
    format!(
        r#"
name = "lever"
units = {units}
[parameters]
load = 40
[hardpoints]
A = [0, 0, 0]
B = [{b}, {up}, 0]
C = [{b}, {c_up}, 0]
[bodies]
arm = {{}}
[joints]
A = {{ type = "revolute", bodies = ["ground", "arm"], at = "A", axis = "z" }}
[drivers]
motor = {{ joint = "A", law = "{swing}*sin(3*t)" }}
[gravity]
along = "-y"
[masses]
bar = {{ type = "bar", from = {{ body = "arm", at = "A" }}, to = {{ body = "arm", at = "B" }}, diameter = {diameter}, bore = {bore}, density = 7850 }}
block = {{ type = "block", centre = {{ body = "arm", at = "B" }}, x = {x}, y = {y}, z = {z}, density = 2700 }}
load = {{ type = "rigid", centre = {{ body = "arm", at = "B" }}, mass = "load/10", izz = 0.02 }}
[forces]
spring = {{ type = "spring", from = {{ body = "ground", at = "C" }}, to = {{ body = "arm", at = "B" }}, stiffness = {k}, cubic = {cubic}, damping = {c}, free_length = {free} }}
twist = {{ type = "torsion_spring", joint = "A", stiffness = {about}, damping = {twist}, equilibrium = {swing} }}
push = {{ type = "force", at = {{ body = "arm", at = "B" }}, force = "3*load", along = [1, 2, 0], axes = "body", law = "1 + t" }}
rub = {{ type = "friction", joint = "A", coefficient = 0.2, radius = {pin} }}
turn = {{ type = "moment", body = "arm", moment = 4, about = "z" }}
rubber = {{ type = "elastic_joint", joint = "A", x = {k}, y = {k}, about_z = {about} }}
[points]
tip = {{ body = "arm", at = "B" }}
[measures]
torque = {{ type = "driver_force" }}
power = {{ type = "driver_power" }}
pin = {{ type = "reaction", joint = "A", part = "radial" }}
spring = {{ type = "spring_force", force = "spring" }}
energy = {{ type = "kinetic_energy" }}
shaking = {{ type = "shaking_force", along = "y" }}
gives = {{ type = "compliance", of = "tip.y", at = "tip", along = "y" }}
both = {{ type = "expression", expression = "torque + 2*energy" }}
[metrics]
peak = {{ of = "torque", take = "max" }}
[time]
end = 1
steps = 8
"#,
        b = l(0.3),
        up = l(0.02),
        c_up = l(0.4),
        swing = 0.5 * angles,
        diameter = l(0.03),
        bore = l(0.01),
        x = l(0.05),
        y = l(0.06),
        z = l(0.07),
        free = l(0.35),
        pin = l(0.02),
    )
}

#[test]
fn loads_are_the_same_in_any_unit() {
    let metres = file(&lever("{ length = \"m\", angle = \"rad\" }", 1.0, 1.0));
    let millimetres =
        file(&lever("{ length = \"mm\", angle = \"deg\" }", 1000.0, 180.0 / std::f64::consts::PI));
    let [a, b] = [&metres, &millimetres].map(solved);
    for name in ["torque", "power", "pin", "spring", "energy", "shaking", "gives", "both"] {
        let (x, y) = (values(&a, name), values(&b, name));
        let scale = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(scale > 0.0, "{name}");
        x.iter().zip(&y).for_each(|(x, y)| assert!((x - y).abs() < SAME * scale, "{name}: {x} {y}"));
        let m = metres.model.measure(name).unwrap().0;
        let dimension = a.measured.outputs[m].dimension;
        // Moments, energies and powers are in N m, J and W for all units of length.
        let said = [&metres, &millimetres].map(|f| f.units.per_si(dimension));
        assert_eq!(said[0] == said[1], name != "gives", "{name}");
    }
}

#[test]
fn a_parameter_moves_masses_and_forces() {
    let file = file(&lever("{ length = \"mm\", angle = \"deg\" }", 1000.0, 180.0 / std::f64::consts::PI));
    let analysis = Analysis::new(&file.model).unwrap();
    let nominal = analysis.run();
    assert!(file.model.without_effect().is_empty());
    let at = |h: f64| analysis.solve(Run::new().at(&[h]).without_sensitivities());
    let h = 1e-3;
    let [below, above] = [-h, h].map(at);
    for name in ["torque", "pin", "energy", "shaking"] {
        let m = file.model.measure(name).unwrap().0;
        for k in 0..nominal.motion.len() {
            let exact = nominal.measured.d(k, VariableId(0), m)[0];
            let of = |s: &Solution| s.measured.value(k, m)[0];
            let difference = (of(&above) - of(&below)) / (2.0 * h);
            // Central differences: their error is the square of the step, and round-off over it.
            assert!(
                (exact - difference).abs() < 1e-7 * exact.abs().max(1.0),
                "{name} {k}: {exact} {difference}"
            );
        }
    }
}

const ARMS: &str = r#"
name = "arms"
units = { length = "mm", angle = "deg" }
[hardpoints]
left_A = [0, 200, 0]
left_B = [30, 500, 40]
left_S = [60, 300, 300]
[bodies]
left_arm = {}
[joints]
left_A = { type = "revolute", bodies = ["ground", "left_arm"], at = "left_A", axis = [1, 0.1, 0] }
[drivers]
left_motor = { joint = "left_A", law = "20*sin(2*t)" }
[gravity]
along = "-z"
[masses]
left_arm = { type = "rigid", centre = { body = "left_arm", at = "left_B" }, mass = 4, ixx = 0.2, iyy = 0.3, izz = 0.25, ixy = 0.04, iyz = -0.03, izx = 0.02 }
[forces]
left_spring = { type = "spring", from = { body = "ground", at = "left_S" }, to = { body = "left_arm", at = "left_B" }, stiffness = 5, preload = -300 }
left_push = { type = "force", at = { body = "left_arm", at = "left_B" }, force = 50, along = [0.2, 1, 0.3] }
left_turn = { type = "moment", body = "left_arm", moment = 6, about = [0.3, 0.5, 1] }
[measures]
left_torque = { type = "driver_force", driver = "left_motor" }
left_bending = { type = "reaction", joint = "left_A", part = "bending" }
left_spring = { type = "spring_force", force = "left_spring" }
[time]
end = 1
steps = 5
"#;

#[test]
fn the_other_side_carries_the_same() {
    let both = file(&format!("{ARMS}[mirror]\nacross = \"y\"\nnames = {{ left = \"right\" }}\n"));
    let solution = solved(&both);
    for what in ["torque", "bending", "spring"] {
        let [left, right] = ["left", "right"].map(|side| values(&solution, &format!("{side}_{what}")));
        let scale = left.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(scale > 1.0, "{what}");
        left.iter().zip(&right).for_each(|(l, r)| assert!((l - r).abs() < SAME * scale, "{what}: {l} {r}"));
    }
}

#[test]
fn a_planar_linkage_has_loads_in_its_plane() {
    let text = r#"
name = "lever"
planar = "xy"
units = { length = "mm", angle = "deg" }
[hardpoints]
A = [0, 0]
B = [300, 0]
[bodies]
ground = ["A"]
arm = ["A", "B"]
[drivers]
motor = { joint = "A", law = "30*t" }
[gravity]
along = "-y"
[masses]
tip = { type = "rigid", centre = { body = "arm", at = "B" }, mass = 2 }
[forces]
turn = { type = "moment", body = "arm", moment = 5 }
[measures]
torque = { type = "driver_force" }
rocking = { type = "shaking_moment", about = { body = "ground", at = "A" } }
"#;
    let solution = solved(&file(text));
    let torque = values(&solution, "torque");
    // Its weight on its arm, less the moment that helps.
    assert!((torque[0] - (2.0 * 9.80665 * 0.3 - 5.0)).abs() < 1e-12, "{}", torque[0]);
    // What turns the arm and is no driver's comes from elsewhere, and ground feels it.
    let rocking = values(&solution, "rocking");
    assert!((rocking[0] + 2.0 * 9.80665 * 0.3 - 5.0).abs() < 1e-12, "{}", rocking[0]);
}

/// A four-bar of revolutes, which holds itself in its plane more than once, with a spring; drawn turned by a rotation.
fn four_bar(turn: &Mat3) -> ModelFile {
    let at = |x: f64, y: f64, z: f64| {
        let [x, y, z] = (*turn * Vec3::new(x, y, z)).to_array();
        format!("[{x:.17}, {y:.17}, {z:.17}]")
    };
    let [a, b, c, d, e] =
        [[0.0, 0.0], [0.0, 60.0], [200.0, 120.0], [220.0, 0.0], [90.0, -150.0]].map(|[x, y]| at(x, y, 0.0));
    let (axis, down) = (at(0.0, 0.0, 1.0), at(0.0, -1.0, 0.0));
    let joint = |name: &str, i: &str, j: &str| {
        format!(r#"{name} = {{ type = "revolute", bodies = ["{i}", "{j}"], at = "{name}", axis = {axis} }}"#)
    };
    let joints = [
        joint("A", "ground", "crank"),
        joint("B", "crank", "rod"),
        joint("C", "rod", "rocker"),
        joint("D", "rocker", "ground"),
    ];
    let joints = joints.join("\n");
    file(&format!(
        r#"
name = "four-bar"
units = {{ length = "mm", angle = "deg" }}
time = {{ end = 1, steps = 8 }}
[hardpoints]
A = {a}
B = {b}
C = {c}
D = {d}
E = {e}
[bodies]
crank = {{}}
rod = {{}}
rocker = {{}}
[joints]
{joints}
[drivers]
motor = {{ joint = "A", law = "360*t" }}
[gravity]
along = {down}
[masses]
pin = {{ type = "rigid", centre = {{ body = "rod", at = "C" }}, mass = 3 }}
[forces]
pull = {{ type = "spring", from = {{ body = "ground", at = "E" }}, to = {{ body = "rod", at = "B" }}, stiffness = 2, preload = 40 }}
"#
    ))
}

#[test]
fn determined_components_do_not_depend_on_the_axes() {
    let turn = Mat3::from_rotation_vector(Vec3::new(0.7, -0.6, 1.1));
    let [flat, turned] = [Mat3::IDENTITY, turn].map(|by| {
        let file = four_bar(&by);
        let loads = Analysis::new(&file.model).unwrap().loads(&[]);
        assert!(loads.stop.is_none() && loads.times.len() == 9);
        loads
    });
    for k in 0..flat.times.len() {
        let scale = flat.joints_at(k).iter().map(|load| load.known_force.norm()).fold(1.0, f64::max);
        for (flat, turned) in flat.joints_at(k).iter().zip(turned.joints_at(k)) {
            // The force across the pin is determined, that along its axis is not.
            assert_eq!([flat.known_directions, turned.known_directions], [2, 2]);
            assert_eq!((flat.known[0], turned.known[0]), ([true, true, false], [false; 3]));
            let drawn = Vec3::new(flat.force.x, flat.force.y, 0.0);
            assert!((flat.known_force - drawn).norm() < SAME * scale);
            assert!((turned.known_force - turn * flat.known_force).norm() < SAME * scale);
        }
        let ([from, to], [turned_from, _]) = (flat.pushes_at(k), turned.pushes_at(k)) else {
            panic!("two ends")
        };
        assert!((*from + *to).norm() < SAME * from.norm() && from.norm() > 1.0);
        assert!((*turned_from - turn * *from).norm() < SAME * from.norm());
    }
}

#[test]
fn a_part_brings_its_masses_with_its_prefix() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arms.toml"), ARMS).unwrap();
    let whole = "name = \"two\"\nunits = { length = \"mm\", angle = \"deg\" }\ninclude = [{ file = \"arms.toml\", prefix = \"front_\" }]\ntime = { end = 1, steps = 5 }\n";
    let path = folder.path().join("two.toml");
    std::fs::write(&path, whole).unwrap();
    let two = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}"));
    let alone = solved(&file(ARMS));
    assert_eq!(values(&solved(&two), "front_left_torque"), values(&alone, "left_torque"));
}

#[test]
fn masses_and_forces_that_cannot_be() {
    snapshot("broken_loads", include_str!("../broken/loads.toml"));
}

#[test]
fn the_work_of_the_press_over_a_turn_is_that_of_tool_and_friction() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let press = hardpoint_file::read(&root.join("../../models/press.toml")).unwrap_or_else(|e| panic!("{e}"));
    let mut model = press.model;
    let steps = 720;
    model.times = (0..steps).map(|k| f64::from(k) / f64::from(steps)).collect();
    let solution = Analysis::new(&model).unwrap().run();
    let mean = |x: Vec<f64>| x.iter().sum::<f64>() / x.len() as f64;
    // Means over a whole turn of a smooth curve: their error falls faster than any power of the steps.
    let given = mean(values(&solution, "power"));
    let stroke = solution.measured.index("stroke").unwrap();
    let law = |t: f64| (-((t - 0.42) / 0.04_f64).powi(2)).exp();
    let speed = |k: usize| solution.measured.value(k, stroke)[1];
    let work: Vec<f64> =
        (0..solution.motion.len()).map(|k| -300.0 * law(model.times[k]) * speed(k)).collect();
    let turn = 2.0 * std::f64::consts::PI;
    let grease = 0.002 * turn * turn * (180.0 / std::f64::consts::PI);
    let taken = mean(work) + grease;
    assert!((given - taken).abs() < 1e-9 * taken, "{given} {taken}");

    // As metrics: the work over time is that over the angle that the motor turns, in J.
    model.times = (0..=steps).map(|k| f64::from(k) / f64::from(steps)).collect();
    let measures: Vec<String> = model.measures.iter().map(|m| m.name.clone()).collect();
    let output = |name: &str| OutputSource::Measure(measures.iter().position(|m| m == name).unwrap());
    let work = |name: &str, of: &str, over: Option<&str>| Metric {
        name: name.into(),
        of: output(of),
        over: over.map(output),
        take: Reduction::Integral,
        window: None,
        case: None,
    };
    model.metrics = vec![work("over_time", "power", None), work("over_angle", "torque", Some("angle"))];
    let solution = Analysis::new(&model).unwrap().run();
    for (metric, known) in model.metrics.iter().zip(hardpoint::run::metrics(&model, &solution)) {
        assert_eq!(model.metric_dimension(metric), Dimension::MOMENT);
        // Both are the same sum, but for round-off.
        assert!((known.value.unwrap() - given).abs() < 1e-9 * given, "{}: {:?}", metric.name, known.value);
    }
}

/// Masses on every moving body of a model, made up but each another one, off their places and unevenly spread; written
/// into the file.
fn make_heavy(path: &Path) -> ModelFile {
    let mut document: DocumentMut = std::fs::read_to_string(path).unwrap().parse().unwrap();
    if document.contains_key("masses") {
        // Its own masses and forces are the subject of another test.
        for key in ["masses", "forces", "gravity", "measures", "metrics", "optimize", "page"] {
            document.remove(key);
        }
        std::fs::write(path, document.to_string()).unwrap();
    }
    let bare = hardpoint_file::read(path).unwrap_or_else(|e| panic!("{e}"));
    let vector = |mut v: Vec<f64>| {
        bare.plane.map(|p| v.remove(3 - p.axes[0] - p.axes[1]));
        Array::from_iter(v)
    };
    let mut masses = Table::new();
    for (k, body) in bare.model.bodies.iter().enumerate().skip(1) {
        let (x, size) = (k as f64, 0.1 * bare.model.size());
        let off = Vec3::new(x.sin(), (2.0 * x).cos(), 0.3) * size;
        let centre = ((body.frame.r + off) * bare.units.length.per_metre()).to_array();
        let mut mass = InlineTable::new();
        mass.insert("type", "rigid".into());
        let place = [("body", Value::from(&body.name)), ("at", vector(centre.to_vec()).into())];
        mass.insert("centre", InlineTable::from_iter(place).into());
        for (key, number) in
            ["mass", "ixx", "iyy", "izz", "ixy", "iyz", "izx"].into_iter().zip(made_up(k, size))
        {
            mass.insert(key, number.into());
        }
        masses.insert(&body.name, mass.into());
    }
    document.insert("masses", masses.into());
    let along = [("along", vector(vec![0.4, -1.3, -9.7]))];
    document.insert("gravity", InlineTable::from_iter(along).into());
    std::fs::write(path, document.to_string()).unwrap();
    hardpoint_file::read(path).unwrap_or_else(|e| panic!("{e}"))
}

/// All models of the gallery with such masses, by name.
pub fn heavy_gallery() -> Vec<(String, ModelFile)> {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let folder = tempfile::tempdir().unwrap();
    for file in std::fs::read_dir(gallery).unwrap().map(|e| e.unwrap().path()).filter(|p| p.is_file()) {
        std::fs::copy(&file, folder.path().join(file.file_name().unwrap())).unwrap();
    }
    let mut paths: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    let name = |path: &Path| path.file_stem().unwrap().to_string_lossy().into_owned();
    paths.iter().map(|path| (name(path), make_heavy(path))).collect()
}

/// Mass, moments and products of inertia about the global axes in the design configuration, of body k.
fn made_up(k: usize, size: f64) -> [f64; 7] {
    let mass = 1.0 + 0.3 * (3.0 * k as f64).sin();
    let i = mass * size * size;
    [mass, 0.9 * i, 1.1 * i, 1.3 * i, 0.1 * i, -0.2 * i, 0.15 * i]
}

/// Force and moment that [`made_up`] requires, about its centre, by Newton and Euler; and the centre's position and
/// velocity.
fn newton_euler(model: &Model, k: usize, s: &BodyState) -> [Vec3; 4] {
    let (x, size) = (k as f64, 0.1 * model.size());
    let [mass, a, b, c, d, e, f] = made_up(k, size);
    let turn = s.rotation * model.bodies[k].frame.rot.transpose();
    let arm = turn * (Vec3::new(x.sin(), (2.0 * x).cos(), 0.3) * size);
    let inertia = |w: Vec3| {
        let w = turn.transpose() * w;
        turn * Vec3::new(
            a * w.x - d * w.y - f * w.z,
            b * w.y - d * w.x - e * w.z,
            c * w.z - e * w.y - f * w.x,
        )
    };
    let acceleration = s.a + s.alpha.cross(arm) + s.omega.cross(s.omega.cross(arm));
    let force = (acceleration - model.gravity) * mass;
    [force, inertia(s.alpha) + s.omega.cross(inertia(s.omega)), s.r + arm, s.v + s.omega.cross(arm)]
}

/// Wrenches on a body, and powers, balance to this part of the largest of them.
const BALANCED: f64 = 1e-12;

/// The joint alone carries the weight, by its thread or by its driver, and no moment about its axis remains.
#[test]
fn a_screw_carries_by_its_thread() {
    for coordinate in ["angle", "displacement"] {
        let text = format!(
            r#"
name = "a weight on a screw"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0] }}
bodies = {{ nut = {{}} }}
gravity = {{ along = "-z" }}
time = {{ at = [0, 1] }}
joints.s = {{ type = "screw", bodies = ["ground", "nut"], at = "A", axis = "z", lead = 10 }}
drivers.d = {{ joint = "s", coordinate = "{coordinate}", law = "90*t" }}
masses.w = {{ type = "rigid", centre = {{ body = "nut", at = "A" }}, mass = 10 }}
[measures]
axial = {{ type = "reaction", joint = "s", part = "axial" }}
z = {{ type = "reaction", joint = "s", part = "force_z" }}
torque = {{ type = "reaction", joint = "s", part = "torque" }}
"#
        );
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            let model = file(&text).model;
            let solution = Analysis::with(&model, formulation).unwrap().run();
            for k in 0..2 {
                let found =
                    |name: &str| solution.measured.value(k, solution.measured.index(name).unwrap())[0];
                for (name, expected) in [("axial", 98.0665), ("z", 98.0665), ("torque", 0.0)] {
                    let off = (found(name).abs() - expected).abs();
                    assert!(off < 1e-10, "{coordinate} {formulation:?}: {name} {}", found(name));
                }
            }
        }
    }
}

#[test]
fn every_model_of_the_gallery_balances_its_wrenches_and_its_power_in_both_formulations() {
    let mut seen = 0;
    for (name, file) in heavy_gallery() {
        seen += 1;
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            let mut model = file.model.clone();
            model.times = model.times.iter().copied().step_by(usize::max(model.times.len() / 8, 1)).collect();
            let analysis = Analysis::with(&model, formulation).unwrap();
            let (solution, loads) = (analysis.run(), analysis.loads(&[]));
            assert_eq!(loads.times.len(), model.times.len(), "{name} {formulation:?}");
            for k in 0..loads.times.len() {
                let at = solution.motion.at(k);
                let given: f64 = loads.drivers_at(k).iter().map(|d| d.force * d.speed).sum();
                let (mut taken, mut largest_power) = (0.0, 0.0_f64);
                for b in 1..model.bodies.len() {
                    let s = at.body(b);
                    let [force, moment, centre, velocity] = newton_euler(&model, b, &s);
                    let terms = [force.dot(velocity), moment.dot(s.omega)];
                    taken += terms[0] + terms[1];
                    largest_power = terms.iter().fold(largest_power, |most, x| most.max(x.abs()));
                    if !model.couplers.is_empty() {
                        // Their couples are not in the joints (docs/loads.md)
                        continue;
                    }
                    let (mut f, mut m) = (-force, -moment);
                    let mut largest = [force.norm(), moment.norm()];
                    for (joint, load) in model.joints.iter().zip(loads.joints_at(k)) {
                        for (body, sign) in joint.bodies.iter().zip([-1.0, 1.0]) {
                            if body.0 == b {
                                let about = load.moment + (load.place - centre).cross(load.force);
                                f += load.force * sign;
                                m += about * sign;
                                largest = [largest[0].max(load.force.norm()), largest[1].max(about.norm())];
                            }
                        }
                    }
                    let wrong = [f.norm() / largest[0], m.norm() / largest[1]];
                    assert!(
                        wrong.iter().all(|x| *x < BALANCED),
                        "{name} {formulation:?} {} {k}: {wrong:?}",
                        model.bodies[b].name
                    );
                }
                let wrong = (given - taken).abs();
                assert!(
                    wrong <= BALANCED * largest_power,
                    "{name} {formulation:?} {k}: {given} {taken} of {largest_power}"
                );
            }
        }
    }
    assert!(seen > 30);
}

/// A scissor lift (legs of 2 m at 30 deg, 1000 N on the platform, 200 N of legs): F = (W + Wa/2) / tan(phi), whatever
/// the law does.
#[test]
fn static_loads_have_no_inertia_in_either_formulation() {
    /// Relative error of forces of a kilonewton, over joints whose positions are solved to 1e-12.
    const SAME: f64 = 1e-9;
    let text = |law: &str, loads: &str| {
        format!(
            r#"
name = "scissor lift"
units = {{ length = "m", angle = "deg" }}
planar = "xy"
{loads}
[parameters]
leg = {{ value = 2, unit = "length" }}
phi = {{ value = 30, unit = "angle", design = false }}
[hardpoints]
O = [0, 0]
R = ["leg*cos(phi)", 0]
T1 = ["leg*cos(phi)", "leg*sin(phi)"]
T2 = [0, "leg*sin(phi)"]
M = ["leg*cos(phi)/2", "leg*sin(phi)/2"]
W = ["leg*cos(phi)/2", "leg*sin(phi)"]
[bodies]
leg1 = {{}}
leg2 = {{}}
platform = {{}}
[joints]
O = {{ type = "revolute", bodies = ["ground", "leg1"], at = "O" }}
R = {{ type = "pin_in_slot", bodies = ["ground", "leg2"], at = "R", axis2 = "x" }}
M = {{ type = "revolute", bodies = ["leg1", "leg2"], at = "M" }}
T2 = {{ type = "revolute", bodies = ["leg2", "platform"], at = "T2" }}
T1 = {{ type = "pin_in_slot", bodies = ["platform", "leg1"], at = "T1", axis2 = "x" }}
[drivers]
ram = {{ joint = "R", coordinate = "displacement", law = "{law}" }}
[gravity]
along = "-y"
[masses]
w1 = {{ type = "rigid", centre = {{ body = "leg1", at = "M" }}, mass = "100/9.80665", izz = 3 }}
w2 = {{ type = "rigid", centre = {{ body = "leg2", at = "M" }}, mass = "100/9.80665", izz = 3 }}
[forces]
load = {{ type = "force", at = {{ body = "platform", at = "W" }}, force = 1000, along = "-y" }}
[measures]
F = {{ type = "driver_force", driver = "ram" }}
h = {{ type = "position", point = {{ body = "platform", at = "W" }}, along = "y" }}
[time]
end = 1
steps = 200
"#
        )
    };
    let closed = |h: f64| -1100.0 / (h / 2.0).asin().tan();
    let file = parse(&text("-0.3*t", "loads = \"static\""), "lift.toml").unwrap_or_else(|e| panic!("{e}"));
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let solution = Analysis::with(&file.model, formulation).unwrap().run();
        assert!(solution.stop.is_none());
        let (force, height) = (values(&solution, "F"), values(&solution, "h"));
        for (f, h) in force.iter().zip(&height) {
            assert!((f - closed(*h)).abs() <= SAME * closed(*h).abs(), "{f} {}", closed(*h));
        }
        // By the length of the legs, against designs that are solved again.
        let variable = file.model.variables.iter().position(|v| v.name == "leg").unwrap();
        let m = solution.measured.index("F").unwrap();
        let d: Vec<f64> =
            (0..force.len()).map(|k| solution.measured.d(k, VariableId(variable), m)[0]).collect();
        let step = 1e-5;
        let moved = |by: f64| {
            let t =
                text("-0.3*t", "loads = \"static\"").replace("value = 2,", &format!("value = {},", 2.0 + by));
            let file = parse(&t, "lift.toml").unwrap_or_else(|e| panic!("{e}"));
            values(&Analysis::with(&file.model, formulation).unwrap().run(), "F")
        };
        let (up, down) = (moved(step), moved(-step));
        for k in (0..d.len()).step_by(50) {
            let difference = (up[k] - down[k]) / (2.0 * step);
            /// Central differences of 1e-5 m.
            const DIFFERENCE: f64 = 1e-6;
            assert!(
                (d[k] - difference).abs() <= DIFFERENCE * difference.abs().max(1.0),
                "{} {difference}",
                d[k]
            );
        }
    }
    // With inertia the same law needs other forces; a case may be static by itself.
    let dynamic = parse(&text("-0.3*t", ""), "lift.toml").unwrap_or_else(|e| panic!("{e}"));
    let first = values(&solved(&dynamic), "F")[0];
    assert!((first - closed(1.0)).abs() > 1.0, "{first}");
    let cases = text("-0.3*t", "")
        + "[cases.slow]\nloads = \"static\"\nother_drivers = \"as_in_model\"\n[cases.fast]\nother_drivers = \"as_in_model\"\n";
    let file = parse(&cases, "lift.toml").unwrap_or_else(|e| panic!("{e}"));
    let of = |case: usize| {
        let model = file.model.in_case(CaseId(case));
        let solution = Analysis::new(&model).unwrap().run();
        values(&solution, "F")[0]
    };
    assert!((of(0) - closed(1.0)).abs() <= SAME * closed(1.0).abs());
    assert!((of(1) - first).abs() <= SAME * first.abs());
}

/// A rod carries along its line, in whatever direction that is.
#[test]
fn the_axial_force_of_a_rod_is_along_its_line() {
    let text = r#"
name = "slider-crank with a rod"
units = { length = "mm", angle = "deg" }
hardpoints = { O = [0, 0, 0], A = [50, 0, 0], B = [200, 30, 0] }
bodies = { crank = {}, slider = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
joints.guide = { type = "translational", bodies = ["ground", "slider"], at = "B", axis = "x" }
joints.rod = { type = "rod", bodies = ["crank", "slider"], at = ["A", "B"] }
drivers.motor = { joint = "pivot", law = "40*t" }
forces.push = { type = "force", at = { body = "slider", at = "B" }, force = 100, along = "-x" }
points = { A = { body = "crank", at = "A" }, B = { body = "slider", at = "B" } }
time = { at = [0, 1, 2] }
[measures]
axial = { type = "reaction", joint = "rod", part = "axial" }
radial = { type = "reaction", joint = "rod", part = "radial" }
pulled = { type = "reaction", joint = "rod", part = "axial", on = "crank" }
"#;
    let model = file(text).model;
    let solution = Analysis::new(&model).unwrap().run();
    for k in 0..3 {
        let found = |name: &str| solution.measured.value(k, solution.measured.index(name).unwrap())[0];
        let [dx, dy] = ["x", "y"].map(|c| found(&format!("B.{c}")) - found(&format!("A.{c}")));
        // The rod pushes the slider against 100 N along x.
        let expected = 100.0 * dx.hypot(dy) / dx;
        assert!((found("axial") - expected).abs() < 1e-10, "{k}: {} {expected}", found("axial"));
        assert!((found("pulled") + expected).abs() < 1e-10, "{k}: {}", found("pulled"));
        assert!(found("radial").abs() < 1e-6, "{k}: {}", found("radial"));
    }
}

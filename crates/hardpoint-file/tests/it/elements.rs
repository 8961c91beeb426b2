//! Masses and forces in model files by type: tables, meshes, wheels, and their mirrored, included and planar forms.

use std::fmt::Write;
use std::path::Path;

use hardpoint::space::Vec3;
use hardpoint_file::{ModelFile, Severity, parse, parse_with, read};

use crate::loads::{solved, values};

/// Tolerance of two equivalent forms: round-off only.
const SAME: f64 = 1e-11;

fn same(a: &[f64], b: &[f64], what: &str) {
    let scale = a.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(scale > 0.0 && a.len() == b.len(), "{what}");
    a.iter().zip(b).for_each(|(a, b)| assert!((a - b).abs() < SAME * scale, "{what}: {a} {b}"));
}

/// A lever on a hinge; masses and forces are appended.
const LEVER: &str = r#"
name = "lever"
units = { length = "mm", angle = "deg" }
[hardpoints]
left_A = [0, 200, 0]
left_B = [30, 500, 40]
left_S = [60, 300, 300]
[joints]
left_A = { type = "revolute", bodies = ["ground", "left_arm"], at = "left_A", axis = [1, 0.1, 0] }
[drivers]
left_motor = { joint = "left_A", law = "20*sin(2*t)" }
[gravity]
along = "-z"
[measures]
left_torque = { type = "driver_force", driver = "left_motor" }
left_bending = { type = "reaction", joint = "left_A", part = "bending" }
[time]
end = 1
steps = 5
"#;

/// Triangles as an OBJ text. Readers keep seven digits of a coordinate: whole numbers are exact.
fn obj(triangles: &[[Vec3; 3]]) -> String {
    let mut text = String::new();
    for (k, corners) in triangles.iter().enumerate() {
        for p in corners {
            writeln!(text, "v {:e} {:e} {:e}", p.x, p.y, p.z).unwrap();
        }
        writeln!(text, "f {} {} {}", 3 * k + 1, 3 * k + 2, 3 * k + 3).unwrap();
    }
    text
}

/// A box by its centre and its edges.
fn brick(centre: [f64; 3], size: [f64; 3]) -> Vec<[Vec3; 3]> {
    let corner = |k: usize| {
        let at = |axis: usize| centre[axis] + size[axis] * if k >> axis & 1 == 0 { -0.5 } else { 0.5 };
        Vec3::new(at(0), at(1), at(2))
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    halves.map(|t| t.map(corner)).collect()
}

/// An octahedron, its faces parted into four again and again, its corners moved out to a sphere about the origin.
fn ball(radius: f64, parted: usize) -> Vec<[Vec3; 3]> {
    let mut triangles: Vec<[Vec3; 3]> = Vec::new();
    for k in 0..8 {
        let [x, y, z] = [0, 1, 2].map(|axis| Vec3::AXES[axis] * if k >> axis & 1 == 0 { 1.0 } else { -1.0 });
        triangles.push(if (k as u32).count_ones().is_multiple_of(2) { [x, y, z] } else { [x, z, y] });
    }
    for _ in 0..parted {
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let [d, e, f] = [(a, b), (b, c), (c, a)].map(|(p, q)| (p + q).unit().unwrap());
                [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
            })
            .collect();
    }
    triangles.iter().map(|t| t.map(|p| p * radius)).collect()
}

fn in_folder(files: &[(&str, &str)], model: &str) -> (tempfile::TempDir, Result<ModelFile, String>) {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let path = folder.path().join("model.toml");
    std::fs::write(&path, model).unwrap();
    let file = read(&path).map_err(|e| e.to_string());
    (folder, file)
}

#[test]
fn a_mesh_has_the_mass_of_its_block_in_every_notation() {
    let (centre, size) = ([35.0, 420.0, 60.0], [60.0, 90.0, 40.0]);
    let body = "[bodies]\nleft_arm = {}\n";
    let block = format!(
        "{LEVER}{body}[masses]\nleft_mass = {{ type = \"box\", centre = {{ body = \"left_arm\", at = {centre:?} }}, x = 60, y = 90, z = 40, density = 2700 }}\n"
    );
    let plain = solved(&parse(&block, "lever.toml").unwrap_or_else(|e| panic!("{e}")));
    // The file is in half millimetres, of a model in mm.
    let halves = brick(centre.map(|x| 2.0 * x), size.map(|x| 2.0 * x));
    // Its own key, the body's, and in the body's frame, which counts from there.
    let from_frame = brick([0, 1, 2].map(|k| centre[k] - [5.0, 10.0, 15.0][k]), size);
    let files = [("halves.obj", obj(&halves)), ("own.obj", obj(&from_frame))];
    let files = [(files[0].0, files[0].1.as_str()), (files[1].0, files[1].1.as_str())];
    let mass = |more: &str| {
        format!("[masses]\nleft_mass = {{ type = \"mesh\", body = \"left_arm\", density = 2700{more} }}\n")
    };
    let said = [
        format!("{LEVER}{body}{}", mass(", mesh = { file = \"halves.obj\", scale = 0.5 }")),
        format!(
            "{LEVER}[bodies]\nleft_arm = {{ mesh = {{ file = \"halves.obj\", scale = 0.5 }} }}\n{}",
            mass("")
        ),
        format!(
            "{LEVER}[bodies]\nleft_arm = {{ frame = {{ position = [5, 10, 15] }}, mesh = {{ file = \"own.obj\", frame = \"body\" }} }}\n{}",
            mass("")
        ),
    ];
    for text in said {
        // And what the mirror makes of it.
        let text = format!("{text}[mirror]\nacross = \"y\"\nnames = {{ left = \"right\" }}\n");
        let (_folder, file) = in_folder(&files, &text);
        let file = file.unwrap_or_else(|e| panic!("{e}"));
        let again = parse_with(&text, "model.toml", &file.texts).unwrap_or_else(|e| panic!("{e}"));
        for solution in [solved(&file), solved(&again)] {
            for what in ["torque", "bending"] {
                let expected = values(&plain, &format!("left_{what}"));
                for side in ["left", "right"] {
                    same(&expected, &values(&solution, &format!("{side}_{what}")), what);
                }
            }
        }
    }
}

#[test]
fn the_mass_of_a_triangulated_ball_converges_to_that_of_a_ball() {
    let radius = 80.0;
    let motion = |parted: usize| {
        let text = format!(
            "{LEVER}[bodies]\nleft_arm = {{}}\n[masses]\nball = {{ type = \"mesh\", body = \"left_arm\", mesh = \"ball.obj\", density = 7850 }}\n"
        );
        let (_folder, file) = in_folder(&[("ball.obj", &obj(&ball(radius, parted)))], &text);
        file.unwrap_or_else(|e| panic!("{e}")).model.mass()
    };
    let exact = 7850.0 * 4.0 / 3.0 * std::f64::consts::PI * (0.001 * radius).powi(3);
    let misses = [2, 3, 4].map(|parted| 1.0 - motion(parted) / exact);
    // Facets cut off so much, and a quarter of it when they are half as wide.
    assert!(misses[2] > 0.0 && misses[2] < 0.01, "{misses:?}");
    for pair in misses.windows(2) {
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.2, "{misses:?}");
    }
}

#[test]
fn surfaces_without_a_volume_are_reported() {
    let mut open = brick([0.0; 3], [1.0; 3]);
    open.pop();
    let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vec3::from);
    let [a, b, c] = flat;
    for (triangles, words) in [(open, "is not closed"), (vec![flat, [a, c, b]], "encloses no volume")] {
        let text = format!(
            "{LEVER}[bodies]\nleft_arm = {{ mesh = \"body.obj\" }}\n[masses]\nm = {{ type = \"mesh\", body = \"left_arm\", density = 1000 }}\n"
        );
        let (_folder, file) = in_folder(&[("body.obj", &obj(&triangles))], &text);
        let error = file.err().unwrap();
        assert!(error.contains("HP0118") && error.contains(words), "{error}");
    }
    // Drawn it may be all the same.
    let rigid = "m = { type = \"rigid\", centre = { body = \"left_arm\", at = \"left_B\" }, mass = 1 }";
    let text = format!("{LEVER}[bodies]\nleft_arm = {{ mesh = \"body.obj\" }}\n[masses]\n{rigid}\n");
    let (_folder, file) = in_folder(&[("body.obj", &obj(&[flat]))], &text);
    assert!(file.is_ok(), "{:?}", file.err());
}

#[test]
fn a_table_is_the_same_in_the_text_and_in_a_file_and_in_any_unit() {
    let spring = |table: &str| {
        format!(
            "{LEVER}[bodies]\nleft_arm = {{}}\n[forces]\nleft_spring = {{ type = \"spring\", from = {{ body = \"ground\", at = \"left_S\" }}, to = {{ body = \"left_arm\", at = \"left_B\" }}, free_length = 360, damping = 0.5, {table} }}\n"
        )
    };
    let csv = "way,force\n-20,0\n0,0\n30,200\n80,1500\n";
    let listed = spring("compression = [[-20, 0], [0, 0], [30, 200], [80, 1500]]");
    let filed = spring("compression = \"stop.csv\"");
    let named = spring("compression = { file = \"stop.csv\", columns = [\"way\", \"force\"] }");
    let pulled = spring("extension = [[-80, -1500], [-30, -200], [0, 0], [20, 0]]");
    let metres = |text: &str| {
        let text = text
            .replace("length = \"mm\"", "length = \"m\"")
            .replace("free_length = 360", "free_length = 0.36");
        let text = text.replace("damping = 0.5", "damping = 500");
        let text = text.replace(
            "[[-20, 0], [0, 0], [30, 200], [80, 1500]]",
            "[[-0.02, 0], [0, 0], [0.03, 200], [0.08, 1500]]",
        );
        text.replace("[0, 200, 0]", "[0, 0.2, 0]")
            .replace("[30, 500, 40]", "[0.03, 0.5, 0.04]")
            .replace("[60, 300, 300]", "[0.06, 0.3, 0.3]")
    };
    let expected = solved(&in_folder(&[], &listed).1.unwrap());
    for text in [filed, named, pulled, metres(&listed)] {
        let (_folder, file) = in_folder(&[("stop.csv", csv)], &text);
        let file = file.unwrap_or_else(|e| panic!("{e}"));
        for what in ["left_torque", "left_bending"] {
            same(&values(&expected, what), &values(&solved(&file), what), what);
        }
    }
    // Units of titles are those of the numbers below.
    let in_other_units = "way [cm],force [kN]\n-2,0\n0,0\n3,0.2\n8,1.5\n";
    let (_folder, file) = in_folder(&[("stop.csv", in_other_units)], &spring("compression = \"stop.csv\""));
    let file = file.unwrap_or_else(|e| panic!("{e}"));
    same(&values(&expected, "left_torque"), &values(&solved(&file), "left_torque"), "in kN over cm");
    for (title, words) in [
        ("way [cm],force [Nm]", "`force` of `stop.csv` is in `Nm`, and the model file has N"),
        ("way [deg],force", "`way` of `stop.csv` is in `deg`, and the model file has mm"),
        ("way,force [counts]", "`force` of `stop.csv` is in `counts`, which is not a known unit"),
    ] {
        let csv = in_other_units.replace("way [cm],force [kN]", title);
        let (_folder, file) = in_folder(&[("stop.csv", &csv)], &spring("compression = \"stop.csv\""));
        let error = file.unwrap_err().to_string();
        assert!(error.contains("HP0112") && error.contains(words), "{error}");
    }
    // The other side, and a part with a prefix that has the file in a folder of its own.
    let mirrored = format!(
        "{}[mirror]\nacross = \"y\"\nnames = {{ left = \"right\" }}\n",
        spring("compression = \"stop.csv\"")
    );
    let (folder, file) = in_folder(&[("stop.csv", csv)], &mirrored);
    same(&values(&expected, "left_torque"), &values(&solved(&file.unwrap()), "right_torque"), "mirrored");
    let parts = folder.path().join("parts");
    std::fs::create_dir(&parts).unwrap();
    std::fs::write(parts.join("stop.csv"), csv).unwrap();
    std::fs::write(parts.join("arm.toml"), spring("compression = \"stop.csv\"")).unwrap();
    let whole = "name = \"one\"\nunits = { length = \"mm\", angle = \"deg\" }\ninclude = [{ file = \"parts/arm.toml\", prefix = \"front_\" }]\ntime = { end = 1, steps = 5 }\n";
    let path = folder.path().join("whole.toml");
    std::fs::write(&path, whole).unwrap();
    let file = read(&path).unwrap_or_else(|e| panic!("{e}"));
    same(&values(&expected, "left_torque"), &values(&solved(&file), "front_left_torque"), "included");
}

#[test]
fn wheel_forces_follow_their_law() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/macpherson.toml");
    let text = std::fs::read_to_string(root).unwrap();
    let file = parse(&text, "macpherson.toml").unwrap_or_else(|e| panic!("{e}"));
    let Some(wheel) = file.model.wheels.first().map(|w| w.name.clone()) else {
        panic!("a strut has a wheel")
    };
    let driver = file.model.drivers[0].name.clone();
    let pushed = format!(
        "{text}\n[forces.road]\ntype = \"wheel_force\"\nwheel = \"{wheel}\"\nup = 4000\noutboard = -1000\nlaw = \"1 + t\"\n[measures.lift]\ntype = \"driver_force\"\ndriver = \"{driver}\"\n[measures.road]\ntype = \"spring_force\"\nforce = \"road\"\n"
    );
    let file = parse(&pushed, "macpherson.toml").unwrap_or_else(|e| panic!("{e}"));
    let solution = solved(&file);
    for (t, road) in solution.motion.times.iter().zip(values(&solution, "road")) {
        let expected = (1.0 + t) * 4000.0_f64.hypot(1000.0);
        assert!((road - expected).abs() < SAME * expected, "{road} {expected}");
    }
    assert!(values(&solution, "lift").iter().any(|x| x.abs() > 100.0));
    // It is positive in its direction at a law of 1.
    for (components, law, at_one) in [
        ("outboard = -1000", "1 + t", 1000.0),
        ("outboard = -1000", "-1 - t", -1000.0),
        ("up = 4000\noutboard = -1000", "-1 - t", -4000.0_f64.hypot(1000.0)),
        ("about_up = -70", "-1 - t", -70.0),
    ] {
        let pushed = pushed.replace("up = 4000\noutboard = -1000", components);
        let pushed = pushed.replace("law = \"1 + t\"", &format!("law = \"{law}\""));
        let file = parse(&pushed, "macpherson.toml").unwrap_or_else(|e| panic!("{e}\n{pushed}"));
        let solution = solved(&file);
        for (t, road) in solution.motion.times.iter().zip(values(&solution, "road")) {
            let expected = (1.0 + t) * at_one;
            assert!((road - expected).abs() < SAME * at_one.abs(), "{components} {law}: {road} {expected}");
        }
    }
}

#[test]
fn a_planar_slide_has_friction_from_forces_in_the_plane() {
    let text = r#"
name = "slider-crank"
planar = "xy"
units = { length = "mm", angle = "deg" }
[hardpoints]
A = [0, 0]
B = [60, 20]
C = [290, -10]
[bodies]
ground = ["A"]
crank = ["A", "B"]
rod = ["B", "C"]
ram = ["C"]
[joints]
guide = { type = "translational", bodies = ["ground", "ram"], at = "C", axis = "x" }
[drivers]
motor = { joint = "A", law = "200*t" }
[masses]
ram = { type = "rigid", centre = { body = "ram", at = "C" }, mass = 8 }
[forces]
rub = { type = "slide_friction", joint = "guide", coefficient = 0.1, length = 50 }
[measures]
torque = { type = "driver_force" }
thrust = { type = "reaction", joint = "guide", part = "force_y" }
rub = { type = "spring_force", force = "rub" }
"#;
    let file = parse(text, "slider.toml").unwrap_or_else(|e| panic!("{e}"));
    let solution = solved(&file);
    // The ram hangs on its pin at the guide's middle: only the side thrust is a normal force.
    for (rub, thrust) in values(&solution, "rub").iter().zip(values(&solution, "thrust")).skip(1) {
        assert!(rub.abs() <= 0.1 * thrust.abs() * (1.0 + SAME), "{rub} {thrust}");
    }
    assert!(values(&solution, "rub").iter().any(|x| x.abs() > 0.1));
    // Bodies without mass are reported, as a note.
    let [note] = &file.remarks[..] else { panic!("{:?}", file.remarks) };
    assert_eq!((note.code, note.severity), ("HP0253", Severity::Note));
    assert!(note.message.contains("`crank`, `rod`"), "{}", note.message);
    let nothing = text.replace(
        "[masses]\nram = { type = \"rigid\", centre = { body = \"ram\", at = \"C\" }, mass = 8 }",
        "[gravity]\nalong = \"-y\"",
    );
    let file = parse(&nothing, "slider.toml").unwrap_or_else(|e| panic!("{e}"));
    assert!(file.remarks[0].message.contains("gravity has no effect"), "{:?}", file.remarks);
}

/// The note about bodies without mass is at the first of them, wherever it is in the list.
#[test]
fn the_note_about_bodies_without_mass_is_at_the_first_of_them() {
    let text = |heavy: &str| {
        format!(
            r#"
name = "two arms"
units = {{ length = "m", angle = "deg" }}
planar = "xy"
hardpoints = {{ O = [0, 0], P = [1, 0], Q = [2, 0] }}
[bodies]
first = {{}}
second = {{}}
third = {{}}
[joints]
a = {{ type = "revolute", bodies = ["ground", "first"], at = "O" }}
b = {{ type = "revolute", bodies = ["first", "second"], at = "P" }}
c = {{ type = "revolute", bodies = ["second", "third"], at = "Q" }}
[drivers]
l = {{ joint = "a", law = "t" }}
m = {{ joint = "b", law = "t" }}
n = {{ joint = "c", law = "t" }}
[gravity]
along = "-y"
[masses]
m = {{ type = "rigid", centre = {{ body = "{heavy}", at = "O" }}, mass = 1 }}
[time]
at = [0]
"#
        )
    };
    for (heavy, light) in [("first", "second"), ("second", "first"), ("third", "first")] {
        let text = text(heavy);
        let file = parse(&text, "arms.toml").unwrap_or_else(|e| panic!("{e}"));
        let [note] = &file.remarks[..] else { panic!("{:?}", file.remarks) };
        let line = 1 + text.lines().position(|l| l.starts_with(&format!("{light} ="))).unwrap();
        assert_eq!((note.line, note.column), (Some(line), Some(1)), "{heavy}");
    }
}

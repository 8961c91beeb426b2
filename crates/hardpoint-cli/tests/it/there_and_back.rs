//! Import, export, import again: the same model.

use std::collections::BTreeMap;
use std::path::Path;

use hardpoint::load::{BodyMass, body_masses};
use hardpoint::space::Vec3;
use hardpoint_export::{FORMATS, Format};
use hardpoint_file::ModelFile;

use crate::bench::Bench;

fn source(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hardpoint-import/tests/models");
    let path = folder.join(name);
    let beside = path.parent().unwrap().to_owned();
    let bytes = std::fs::read(&path).unwrap();
    let imported = hardpoint_import::import(&bytes, name, &|p| std::fs::read(beside.join(p)).ok()).unwrap();
    imported.text
}

fn model(text: &str) -> ModelFile {
    // Shapes lie in files.
    let bare: String = text.lines().map(|l| format!("{}\n", without_mesh(l))).collect();
    hardpoint_file::parse(&bare, "model.toml").unwrap_or_else(|e| panic!("{e}"))
}

fn without_mesh(line: &str) -> String {
    match (line.find(", mesh = {"), line.rfind(" }")) {
        (Some(k), Some(_)) => format!("{} }}", &line[..k]),
        _ => line.to_owned(),
    }
}

/// Joints by name, type, bodies, position and axis.
fn joints(file: &ModelFile) -> Vec<(String, &'static str, [String; 2], Vec3, Vec3)> {
    let m = &file.model;
    let mut list: Vec<_> = m
        .named_joints()
        .map(|(_, j)| {
            let bodies = j.bodies.map(|b| m.bodies[b.0].name.clone());
            let axis = if j.axis.is_some() { j.frames[0].cols[2] } else { Vec3::zero() };
            (j.name.clone(), j.kind.name, bodies, m.hardpoints[j.at[0].0].position, axis)
        })
        .collect();
    list.sort_by(|a, b| a.0.cmp(&b.0));
    list
}

/// True if two models have the same joints between the same bodies at the same positions.
fn same(a: &ModelFile, b: &ModelFile) {
    /// Tolerance in metres: round-off of positions added along a tree.
    const ROUNDED: f64 = 1e-12;
    let (a, b) = (joints(a), joints(b));
    assert_eq!(a.len(), b.len(), "{a:#?}\n{b:#?}");
    for (a, b) in a.iter().zip(&b) {
        assert_eq!((&a.0, a.1, &a.2), (&b.0, b.1, &b.2));
        assert!((a.3 - b.3).norm() < ROUNDED && (a.4 - b.4).norm() < ROUNDED, "{a:?} {b:?}");
    }
}

/// Limits of joints to ten digits, in order of their names.
fn limits(file: &ModelFile) -> Vec<(String, [Option<String>; 2])> {
    let shown = |end: Option<f64>| end.map(|x| format!("{x:.10}"));
    let of = |limit: &hardpoint::model::JointLimit| (limit.name.clone(), [limit.min, limit.max].map(shown));
    let mut list: Vec<_> = file.model.joint_limits.iter().map(of).collect();
    list.sort();
    list
}

#[test]
fn limits_of_joints_come_back_and_those_that_do_not_are_listed() {
    let text = "name = \"arm\"\nunits = { length = \"mm\", angle = \"deg\" }\n\
        [hardpoints]\nA = [0, 0, 0]\nB = [0, 0, 100]\nC = [0, 0, 200]\nD = [0, 0, 300]\n\
        [bodies]\na = {}\nb = {}\nc = {}\nd = {}\n\
        [joints]\n\
        A = { type = \"revolute\", bodies = [\"ground\", \"a\"], at = \"A\", axis = \"y\", limits = { angle = { min = -30, max = 50 } } }\n\
        B = { type = \"translational\", bodies = [\"b\", \"a\"], at = \"B\", axis = \"z\", limits = { displacement = { max = 20 } } }\n\
        C = { type = \"spherical\", bodies = [\"b\", \"c\"], at = \"C\", limits = { articulation = { max = 40 } } }\n\
        D = { type = \"universal\", bodies = [\"c\", \"d\"], at = \"D\", axis = \"x\", axis2 = \"y\", limits = { articulation = { max = 30 } } }\n\
        [drivers]\nA = { joint = \"A\", law = 0 }\nB = { joint = \"B\", law = 0 }\n\
        x = { body = \"c\", relative_to = \"b\", about = \"x\", law = 0 }\n\
        y = { body = \"c\", relative_to = \"b\", about = \"y\", law = 0 }\n\
        z = { body = \"c\", relative_to = \"b\", about = \"z\", law = 0 }\n\
        one = { joint = \"D\", coordinate = \"angle\", law = 0 }\ntwo = { joint = \"D\", coordinate = \"angle2\", law = 0 }\n\
        [time]\nend = 1\nsteps = 2\n";
    let first = model(text);
    let all = limits(&first);
    for (format, file, lost) in [("mjcf", "again.xml", 1), ("urdf", "again.urdf", 2)] {
        let exported = Format::named(format).unwrap().export(&first, "model").unwrap();
        let listed: Vec<&str> =
            exported.unsupported.iter().filter(|u| u.kind == "limit").map(|u| u.name.as_str()).collect();
        assert_eq!(listed, &["C.articulation", "D.articulation"][2 - lost..], "{format}");
        let again = hardpoint_import::import(exported.text.as_bytes(), file, &|_| None);
        let again = limits(&model(&again.unwrap_or_else(|e| panic!("{e}")).text));
        let kept: Vec<_> = all.iter().filter(|limit| !listed.contains(&limit.0.as_str())).cloned().collect();
        assert_eq!(again, kept, "{format}");
    }
}

fn there_and_back(name: &str, format: &str, file: &str) {
    let first = model(&source(name));
    let exported = Format::named(format).unwrap().export(&first, "model").unwrap();
    let again =
        hardpoint_import::import(exported.text.as_bytes(), file, &|_| None).unwrap_or_else(|e| panic!("{e}"));
    let second = model(&again.text);
    same(&first, &second);
    assert_eq!(first.model.couplers.len(), second.model.couplers.len());
    assert_eq!(limits(&first), limits(&second), "{name}");
    // Only names that the format does not allow change on the first export.
    let names = |f: &ModelFile| {
        f.model.bodies.iter().map(|b| b.name.clone()).collect::<std::collections::BTreeSet<_>>()
    };
    assert_eq!(names(&first), names(&second), "{name}");
}

#[test]
fn robots_come_back_the_same() {
    there_and_back("urdf/gripper.urdf", "urdf", "again.urdf");
    there_and_back("urdf/four_bar.urdf", "urdf", "again.urdf");
    there_and_back("asmt/four_bar.asmt", "urdf", "again.urdf");
    there_and_back("mjcf/hand.xml", "mjcf", "again.xml");
    there_and_back("mjcf/four_bar.xml", "mjcf", "again.xml");
}

/// A model of the gallery, and its re-import from a format.
fn by_way_of(name: &str, format: &str) -> (ModelFile, ModelFile) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.toml"));
    let first = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}"));
    let format = Format::named(format).unwrap();
    let exported = format.export(&first, "model").unwrap();
    let file = format!("again.{}", format.endings[0]);
    let again = hardpoint_import::import(exported.text.as_bytes(), &file, &|_| None)
        .unwrap_or_else(|e| panic!("{name}: {e}\n{}", exported.text));
    assert!(again.fault.is_none(), "{name}: {}\n{}", again.fault.unwrap(), exported.text);
    (first, model(&again.text))
}

#[test]
fn hinges_rods_and_bodies_that_these_alone_hold_come_back_from_mjcf() {
    // Loops of hinges in the plane and in space, parallelograms of rods, a platform supported by rods only.
    for name in
        ["bennett", "bricard", "jansen", "watt_six_bar", "sarrus", "delta", "rssr", "double_wishbone_4x4"]
    {
        let (first, second) = by_way_of(name, "mjcf");
        same(&first, &second);
    }
    for name in ["bennett", "jansen", "sarrus"] {
        let (first, second) = by_way_of(name, "urdf");
        same(&first, &second);
    }
}

#[test]
fn joints_of_several_freedoms_are_written_as_a_chain() {
    let (first, second) = by_way_of("hooke", "mjcf");
    let kinds = |f: &ModelFile| {
        f.model
            .named_joints()
            .map(|(_, j)| format!("{} {}", j.name, j.kind.name))
            .collect::<std::collections::BTreeSet<_>>()
    };
    assert!(kinds(&first).contains("cross universal"));
    let (there, back) = (kinds(&first), kinds(&second));
    let new: Vec<&String> = back.difference(&there).collect();
    assert_eq!(new, ["cross_1 revolute", "cross_2 revolute"]);
}

#[test]
fn hardpoints_come_back_to_the_last_digit() {
    for name in ["teimorbit/wishbone.sub", "teimorbit/push_rod.sub"] {
        let first = model(&source(name));
        let exported = Format::named("teimorbit").unwrap().export(&first, "model").unwrap();
        let again = hardpoint_import::import(exported.text.as_bytes(), "again.sub", &|_| None).unwrap();
        let second = model(&again.text);
        let places = |f: &ModelFile| -> Vec<(String, [u64; 3])> {
            let own = f.model.hardpoints.iter().filter(|h| !h.unnamed);
            let mut list: Vec<_> =
                own.map(|h| (h.name.clone(), h.position.to_array().map(|x| (x + 0.0).to_bits()))).collect();
            list.sort();
            list
        };
        assert_eq!(places(&first), places(&second), "{name}");
        assert_eq!(joints(&first).len(), joints(&second).len(), "{name}");
    }
}

/// A double pendulum with all that a format may leave out: `link` has a full inertia and a turned frame, `bob` is a
/// point.
const LOADED: &str = r#"
name = "loaded"
units = { length = "mm", angle = "deg" }
[hardpoints]
A = [0, 0, 0]
B = [100, 50, 20]
C = [150, 90, 30]
[bodies]
link = { frame = { position = "B", euler = [10, 20, 30] } }
bob = {}
[joints]
A = { type = "revolute", bodies = ["ground", "link"], at = "A", axis = "z" }
B = { type = "revolute", bodies = ["bob", "link"], at = "B", axis = [1, 2, 3] }
[drivers]
A = { joint = "A", law = "30*t" }
B = { joint = "B", law = 0 }
[points]
p = { body = "bob", at = "C" }
[masses]
plate = { type = "rigid", centre = { body = "link", at = [60, 30, 10] }, mass = 2, ixx = 0.02, iyy = 0.03, izz = 0.04, ixy = 0.003, iyz = -0.002, izx = 0.001 }
bar = { type = "bar", from = { body = "link", at = "A" }, to = { body = "link", at = "B" }, diameter = 20, density = 7850 }
bob = { type = "rigid", centre = "p", mass = 3 }
[gravity]
along = "-y"
[forces]
s = { type = "spring", from = { body = "ground", at = [0, 200, 0] }, to = "p", stiffness = 5, free_length = 100 }
[shapes]
ball = { sphere = "C", body = "bob", radius = 10 }
[design]
Bx = { move = "B", along = "x" }
[measures]
angle = { type = "coordinate", joint = "A" }
[time]
end = 1
steps = 4
"#;

#[test]
fn masses_and_gravity_come_back() {
    let first = model(LOADED);
    let of = |f: &ModelFile| -> BTreeMap<String, BodyMass> {
        let named = f.model.bodies.iter().zip(body_masses(&f.model));
        named.filter_map(|(body, mass)| Some((body.name.clone(), mass?))).collect()
    };
    let masses = of(&first);
    assert_eq!(masses.len(), 2);
    for format in ["mjcf", "urdf"] {
        let exported = Format::named(format).unwrap().export(&first, "model").unwrap();
        let file = format!("again.{}", Format::named(format).unwrap().endings[0]);
        let again = hardpoint_import::import(exported.text.as_bytes(), &file, &|_| None);
        let again = model(&again.unwrap_or_else(|e| panic!("{e}")).text);
        for (body, found) in of(&again) {
            let BodyMass { mass, centre, inertia } = masses[&body];
            assert!((found.mass - mass).abs() < 1e-12, "{format} {body}: {found:?}");
            assert!((found.centre - centre).norm() < 1e-12, "{format} {body}: {found:?}");
            // MuJoCo requires moments of a point as well: a radius of gyration of a thousandth of the size.
            let ball = if format == "mjcf" && body == "bob" {
                mass * (1e-3 * first.model.size()).powi(2)
            } else {
                0.0
            };
            for ((a, b), axis) in inertia.cols.iter().zip(found.inertia.cols).zip(Vec3::AXES) {
                assert!((*a + axis * ball - b).norm() < 1e-15, "{format} {body}: {inertia:?} {found:?}");
            }
        }
        assert_eq!(of(&again).len(), 2, "{format}: {}", exported.text);
        // URDF has no gravity: the importer's is along -z.
        let gravity = if format == "mjcf" { first.model.gravity } else { Vec3::new(0.0, 0.0, -9.80665) };
        assert!((again.model.gravity - gravity).norm() < 1e-12, "{format}: {:?}", again.model.gravity);
    }
}

/// Without masses of its own, and with moments that are known about one axis only, as in a planar model.
#[test]
fn masses_that_a_format_requires_are_written_and_reported() {
    let changes = |text: &str, name: &str| {
        let exported = Format::named(name).unwrap().export(&model(text), "model").unwrap();
        let list = exported.unsupported.iter().filter(|u| u.kind.starts_with("mass"));
        (list.map(|u| (u.name.clone(), u.why.clone())).collect::<Vec<_>>(), exported.text)
    };
    let part = |text: &str, from: &str, to: &str| {
        let (before, rest) = text.split_once(from).unwrap();
        before.to_owned() + to + rest.split_once('\n').unwrap().1
    };
    let planar = part(
        &part(LOADED, "plate = ", ""),
        "bar = ",
        "plate = { type = \"rigid\", centre = { body = \"link\", at = [60, 30, 10] }, mass = 2, izz = 0.04 }\n",
    );
    let (list, text) = changes(&planar, "urdf");
    assert!(
        list[0].0 == "link" && list[0].1.contains("moments of inertia that the model leaves out"),
        "{list:?}"
    );
    assert_eq!(list.len(), 1);
    let again =
        hardpoint_import::import(text.as_bytes(), "again.urdf", &|_| None).unwrap_or_else(|e| panic!("{e}"));
    let again = model(&again.text);
    let link = again.model.bodies.iter().position(|b| b.name == "link").unwrap();
    // The plate of this moment about z with the smallest moments about x and y.
    let inertia = body_masses(&again.model)[link].unwrap().inertia;
    for (found, expected) in inertia.cols.iter().zip(Vec3::AXES.map(|axis| axis * (0.02 + 0.02 * axis.z))) {
        assert!((*found - expected).norm() < 1e-12, "{text}");
    }
    assert!(text.contains(r#"ixy="0" ixz="0""#), "{text}");
    let (list, _) = changes(LOADED, "mjcf");
    assert!(list.len() == 1 && list[0].0 == "bob" && list[0].1.contains("small positive ones"), "{list:?}");
    let without_bob = part(LOADED, "bob = { type", "");
    let (list, text) = changes(&without_bob, "mjcf");
    assert!(list.len() == 1 && list[0].0 == "bob" && list[0].1.contains("thousandth"), "{list:?}");
    assert!(text.contains("<option gravity=\"0 -9.80665 0\"/>"), "{text}");
    let (list, text) = changes(&part(&part(&without_bob, "plate = ", ""), "bar = ", ""), "mjcf");
    assert!(list.len() == 1 && list[0].1.contains("to be replaced"), "{list:?}");
    assert!(text.contains("mass=\"1\" fullinertia=\"1 1 1 0 0 0\""), "{text}");
}

/// Every format writes, or lists, all that a model has.
#[test]
fn what_a_format_leaves_out_is_listed_for_every_format() {
    let file = model(LOADED);
    for format in FORMATS {
        let exported = format.export(&file, "model").unwrap();
        let kinds: std::collections::BTreeSet<&str> = exported.unsupported.iter().map(|u| u.kind).collect();
        let expected: &[&str] = match format.name {
            "csv" | "teimorbit" => &[
                "bodies",
                "design variables",
                "driver",
                "force",
                "frames",
                "gravity",
                "joints",
                "masses",
                "measures",
                "points",
                "points of bodies",
                "shapes",
            ],
            "dxf" => &[
                "design variables",
                "driver",
                "force",
                "frames",
                "gravity",
                "joints",
                "masses",
                "measures",
                "points",
                "shapes",
            ],
            "urdf" => &[
                "design variables",
                "driver",
                "force",
                "frames",
                "gravity",
                "hardpoints",
                "measures",
                "points of bodies",
                "shapes",
            ],
            "mjcf" => &[
                "design variables",
                "driver",
                "force",
                "frames",
                "hardpoints",
                "mass",
                "measures",
                "points of bodies",
                "shapes",
            ],
            "c" => &["design variables", "force", "gravity", "masses", "shapes"],
            // The design is a parameter of the unit.
            "fmu" => &["force", "gravity", "masses", "shapes"],
            other => panic!("list what `{other}` leaves out"),
        };
        assert_eq!(kinds.into_iter().collect::<Vec<_>>(), expected, "{}", format.name);
        // No name twice.
        let all: std::collections::BTreeSet<_> =
            exported.unsupported.iter().map(|u| (u.kind, &u.name)).collect();
        assert_eq!(all.len(), exported.unsupported.len(), "{}: {:#?}", format.name, exported.unsupported);
    }
}

#[test]
fn unsupported_features_of_a_format_are_listed() {
    let file = model(&source("suspension-explorer/wishbone.yaml"));
    let lists: Vec<String> = ["csv", "urdf", "mjcf"]
        .iter()
        .map(|format| {
            let exported = Format::named(format).unwrap().export(&file, "model").unwrap();
            let list: Vec<String> = exported
                .unsupported
                .iter()
                .map(|u| format!("{} `{}`: {}\n", u.kind, u.name, u.why))
                .collect();
            format!("## {format}\n{}", list.concat())
        })
        .collect();
    insta::with_settings!({ prepend_module_to_snapshot => false, snapshot_path => "../snapshots" }, {
        insta::assert_snapshot!("export_unsaid", lists.join("\n"));
    });
}

/// Suspensions of the gallery: with one side, with both, on rods, on a strut.
#[test]
fn a_teimorbit_table_that_was_exported_is_a_suspension_again() {
    /// Round-off of millimetres converted to metres and back.
    const ROUNDED: f64 = 1e-9;
    for model in ["double_wishbone", "double_wishbone_4x4", "macpherson", "front_axle", "five_link"] {
        let bench = Bench::with(&[]);
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{model}.toml"));
        let run = |arguments: &[&str]| {
            let output = bench.run(arguments);
            assert!(output.status.success(), "{model}: {}", String::from_utf8_lossy(&output.stderr));
        };
        run(&["export", source.to_str().unwrap(), "-o", "table.sub"]);
        run(&["import", "table.sub", "-o", "again.toml"]);
        run(&["check", "again.toml"]);
        let places = |path: &Path| {
            let file = hardpoint_file::read(path).unwrap_or_else(|e| panic!("{model}: {e}"));
            let named = file.model.hardpoints.iter().filter(|h| !h.unnamed);
            // The side is a prefix there, and a suffix here.
            let bare = |name: &str| {
                let side = ["left", "right"].into_iter().find(|side| name.contains(side)).unwrap_or("");
                let short = name.replace(&format!("{side}_"), "").replace(&format!("_{side}"), "");
                format!("{short} {side}")
            };
            let at =
                |h: &hardpoint::model::Hardpoint| (bare(&h.name), h.position.to_array().map(|x| 1e3 * x));
            named.map(at).collect::<BTreeMap<_, _>>()
        };
        let (before, after) = (places(&source), places(&bench.path("again.toml")));
        assert!(before.len() >= 8, "{model}");
        for (name, at) in &before {
            let again = after.get(name).unwrap_or_else(|| panic!("{model}: {name} is not in {after:?}"));
            assert!(
                at.iter().zip(again).all(|(a, b)| (a - b).abs() <= ROUNDED),
                "{model} {name}: {at:?} {again:?}"
            );
        }
    }
}

/// A linkage with names that no other format allows: with a tab, a new line, a bell, and names that are equal without
/// them.
const NAMES: &str = r#"
name = "tab\there"
units = { length = "mm", angle = "deg" }
bodies = { "crank\u0007" = {}, crank_ = {}, "a<b>&\"c\"" = {} }
[joints."one\nline"]
type = "revolute"
bodies = ["ground", "crank\u0007"]
at = [0, 0, 0]
axis = "y"
[joints.one_line]
type = "revolute"
bodies = ["crank\u0007", "crank_"]
at = [100, 0, 0]
axis = "y"
[joints.third]
type = "revolute"
bodies = ["ground", "a<b>&\"c\""]
at = [300, 0, 0]
axis = "y"
[couplers."pair\u0001"]
type = "linear"
terms = [{ joint = "third", coefficient = 2 }, { joint = "one_line", coefficient = 3 }]
constant = 30
[drivers.motor]
joint = "one\nline"
law = "10*t"
[drivers.second]
joint = "one_line"
law = "0"
[time]
end = 1
steps = 10
"#;

#[test]
fn names_that_a_format_does_not_allow_are_changed_and_reported() {
    let file = hardpoint_file::parse(NAMES, "names.toml").unwrap_or_else(|e| panic!("{e}"));
    for (format, name) in
        [("urdf", "names.urdf"), ("mjcf", "names.xml"), ("dxf", "names.dxf"), ("teimorbit", "names.sub")]
    {
        let exported = Format::named(format).unwrap().export(&file, "model").unwrap();
        // DXF ends its lines as on Windows.
        let odd = exported.text.chars().find(|c| c.is_control() && !['\n', '\r'].contains(c));
        assert_eq!(odd, None, "{format}: {}", exported.text);
        let reported: Vec<&str> = exported.unsupported.iter().map(|u| u.name.as_str()).collect();
        for renamed in ["tab\\there", "crank\\u{7}", "one\\nline", "pair\\u{1}"] {
            assert!(reported.contains(&renamed), "{format}: {reported:?}");
        }
        if !["urdf", "mjcf"].contains(&format) {
            continue;
        }
        let again = hardpoint_import::import(exported.text.as_bytes(), name, &|_| None)
            .unwrap_or_else(|e| panic!("{e}"));
        let again = model(&again.text);
        let names: std::collections::BTreeSet<&str> =
            again.model.bodies.iter().map(|b| b.name.as_str()).collect();
        for body in ["crank_", "crank__2", "a<b>&\"c\""] {
            assert!(names.contains(body), "{format}: {names:?}");
        }
        let joints: Vec<&str> = again.model.named_joints().map(|(_, j)| j.name.as_str()).collect();
        assert!(joints.contains(&"one_line") && joints.contains(&"one_line_2"), "{format}: {joints:?}");
        // The constant of the coupler is preserved: 2 third + 3 one_line = 30 deg, so third = 15 deg at one_line = 0.
        let coupler = &again.model.couplers[0];
        if format == "mjcf" {
            let first = coupler.terms[0].coefficient;
            assert!((coupler.constant / first - 15.0_f64.to_radians()).abs() < 1e-12, "{coupler:?}");
        } else {
            // URDF has it at the offset.
            let third = again.model.bodies.iter().find(|b| b.name.starts_with("a<b>")).unwrap();
            assert!((third.frame.rot.cols[2].x - 15.0_f64.to_radians().sin()).abs() < 1e-12, "{third:?}");
        }
    }
}

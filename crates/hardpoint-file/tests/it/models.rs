//! The gallery of `models/`: every file is read, fits the schema, and has the numbers of its source.

use std::path::{Path, PathBuf};

use hardpoint::space::Vec3;
use hardpoint_file::{ModelFile, parse, read, schema};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models")
}

fn models() -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder())
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    assert!(files.len() >= 5, "{files:?}");
    files
}

fn model(name: &str) -> ModelFile {
    read(&folder().join(name)).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn every_model_is_read() {
    for path in models() {
        let file = read(&path).unwrap_or_else(|e| panic!("{e}"));
        assert!(!file.model.joints.is_empty() && !file.model.drivers.is_empty(), "{}", path.display());
        assert!(!file.model.variables.is_empty() && !file.model.measures.is_empty(), "{}", path.display());
    }
}

#[test]
fn every_model_names_its_schema_and_fits_it() {
    let validator = jsonschema::validator_for(&serde_json::from_str(&schema()).unwrap()).unwrap();
    for path in models() {
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("#:schema hardpoint.schema.json\n"), "{}", path.display());
        let value: serde_json::Value = toml::from_str(&text).unwrap();
        let errors: Vec<String> =
            validator.iter_errors(&value).map(|e| format!("{} at {}", e, e.instance_path())).collect();
        assert!(errors.is_empty(), "{}: {errors:#?}", path.display());
    }
}

/// Set `UPDATE_SCHEMA=1` to write the file anew.
#[test]
fn published_schema_is_the_schema() {
    let path = folder().join("hardpoint.schema.json");
    if std::env::var_os("UPDATE_SCHEMA").is_some() {
        std::fs::write(&path, schema()).unwrap();
    }
    let published = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        published == schema(),
        "run the tests with UPDATE_SCHEMA=1 and commit models/hardpoint.schema.json"
    );
}

#[test]
fn schema_lists_every_joint_type_and_unit() {
    let schema = schema();
    for t in hardpoint::joint::ALL {
        for name in std::iter::once(&t.name).chain(t.aliases) {
            assert!(schema.contains(&format!("\"const\": \"{name}\"")), "{name}");
        }
    }
    for unit in hardpoint_file::LengthUnit::ALL {
        assert!(schema.contains(&format!("\"{}\"", unit.symbol())), "{}", unit.symbol());
    }
}

/// Coordinates as the sources print them, in m.
#[test]
fn macpherson_has_the_published_hardpoints() {
    let file = model("macpherson.toml");
    let published = [
        ("lca_rear", [-0.04318, 0.37338, -0.12573]),
        ("lca_front", [0.27051, 0.34544, -0.05969]),
        ("ball_joint", [0.02794, 0.66294, -0.10414]),
        ("strut_lower", [-0.00508, 0.61976, -0.00127]),
        ("strut_top", [-0.08382, 0.54102, 0.46863]),
        ("tie_rod_outer", [-0.2, 0.574803759, -0.00127]),
        ("tie_rod_inner", [-0.2, 0.2, -0.05]),
        ("rack_centre", [-0.2, 0.0, -0.05]),
    ];
    for (name, position) in published {
        let h = file.model.hardpoints.iter().find(|h| h.name == name).unwrap();
        assert!((h.position - Vec3::from(position)).norm() < 1e-12, "{name}: {:?}", h.position);
    }
    let m = &file.model;
    assert_eq!(m.times.len(), 501);
    assert_eq!((m.times[0], m.times[500]), (0.0, 10.0));
    let names: Vec<&str> = m.variables.iter().map(|v| v.name.as_str()).collect();
    assert_eq!(names[..3], ["lca_location_x", "lca_location_y", "lca_location_z"]);
    let rack = &m.drivers[0].law;
    assert!((rack.at(1.25).value() - 0.03).abs() < 1e-15);
    let cut: Vec<&str> = m.joints.iter().filter(|j| j.cut).map(|j| j.name.as_str()).collect();
    assert_eq!(cut, ["top_E"]);
}

#[test]
fn a_model_is_the_same_in_every_unit() {
    let text = |k: f64, a: f64, length: &str, angle: &str| {
        format!(
            r#"
            name = "same"
            units = {{ length = "{length}", angle = "{angle}" }}
            [hardpoints]
            A = [{0}, {1}, {2}]
            B = [{1}, {2}, {0}]
            [bodies]
            a = {{ frame = {{ position = "A", euler = [{3}, {4}, {5}] }} }}
            b = {{}}
            [joints]
            J1 = {{ type = "cylindrical", bodies = ["ground", "a"], at = "A", axis = [3, 4, 5] }}
            J2 = {{ type = "distance", bodies = ["a", "b"], at = ["A", "B"] }}
            [drivers]
            turn = {{ joint = "J1", coordinate = "angle", law = "{5}*sin(t)" }}
            lift = {{ joint = "J1", coordinate = "displacement", law = "{0}*t" }}
            [design]
            m = {{ move = "A", along = [1, 1, 0] }}
            f = {{ fields = [{{ joint = "J1", body = "a", V = [{0}, 0, 0], U = [{3}, 0, 0] }}] }}
            k = {{ markers = [{{ joint = "J1", move = [{0}, 0, 0], turn = [{3}, 0, 0] }}] }}
            only_moves = {{ markers = [{{ joint = "J1", on = "j", move = [1, 0, 0] }}] }}
            only_turns = {{ markers = [{{ joint = "J1", on = "i", turn = [1, 0, 0] }}] }}
            [points]
            P = {{ body = "b", at = [{2}, {2}, {1}] }}
            [time]
            at = [0, 0.5]
            "#,
            100.0 * k,
            -250.0 * k,
            32.0 * k,
            30.0 * a,
            -45.0 * a,
            72.0 * a,
        )
    };
    let mm = parse(&text(1.0, 1.0, "mm", "deg"), "mm.toml").unwrap().model;
    let m = parse(&text(1e-3, std::f64::consts::PI / 180.0, "m", "rad"), "m.toml").unwrap().model;
    let near = |a: Vec3, b: Vec3| assert!((a - b).norm() < 1e-15, "{a:?} {b:?}");
    for (a, b) in mm.hardpoints.iter().zip(&m.hardpoints) {
        near(a.position, b.position);
    }
    for (a, b) in mm.bodies.iter().zip(&m.bodies) {
        near(a.frame.r, b.frame.r);
        for k in 0..3 {
            near(a.frame.rot.cols[k], b.frame.rot.cols[k]);
        }
    }
    for (a, b) in mm.drivers.iter().zip(&m.drivers) {
        assert!((a.law.at(0.7).value() - b.law.at(0.7).value()).abs() < 1e-15);
        assert!(a.law.at(0.7).value().abs() > 0.01);
    }
    use hardpoint::joint::Quantity::{Angle, Length, Number};
    use hardpoint::model::Change;
    let quantities: Vec<_> = mm.variables.iter().map(|v| v.quantity).collect();
    assert_eq!(quantities, [Length, Number, Number, Length, Angle]);
    for (a, b) in mm.variables.iter().zip(&m.variables) {
        match (&a.changes[0], &b.changes[0]) {
            (Change::Move(a), Change::Move(b)) => near(a.velocity, b.velocity),
            (Change::Field(a), Change::Field(b)) => {
                near(a.v, b.v);
                near(a.u, b.u);
            }
            (Change::Marker(a), Change::Marker(b)) => {
                near(a.position, b.position);
                near(a.rotation, b.rotation);
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn places_are_those_of_the_text() {
    use hardpoint::draft::Section;
    let file = model("slider_crank.toml");
    let line = |needle: &str| 1 + file.text().lines().position(|l| l.starts_with(needle)).unwrap();
    assert_eq!(file.place(Section::Joints, 1), Some((line("J2 ="), 1)));
    assert_eq!(file.place(Section::Bodies, 2), Some((line("rod ="), 1)));
    assert_eq!(file.place(Section::Bodies, 0), None);
    assert_eq!(file.place(Section::Measures, 2), Some((line("stroke ="), 1)));
    let rssr = model("rssr.toml");
    // One entry, three variables.
    assert_eq!(rssr.place(Section::Design, 0), rssr.place(Section::Design, 2));
    assert_ne!(rssr.place(Section::Design, 2), rssr.place(Section::Design, 3));
}

/// Diagnostics point at `place`: it must be the entry of that name for every list of the model that follows the file's.
#[test]
fn the_place_of_every_entry_has_its_name() {
    use hardpoint::draft::Section;
    for path in models() {
        let file = read(&path).unwrap_or_else(|e| panic!("{e}"));
        let m = &file.model;
        let bodies = m.bodies.iter().map(|x| &x.name).collect::<Vec<_>>();
        let lists: [(Section, Vec<&String>); 5] = [
            (Section::Bodies, bodies),
            (Section::Joints, m.joints.iter().map(|x| &x.name).collect()),
            (Section::Drivers, m.drivers.iter().map(|x| &x.name).collect()),
            (Section::Measures, m.measures.iter().map(|x| &x.name).collect()),
            (Section::Points, m.points.iter().map(|x| &x.name).collect()),
        ];
        let mut found = 0;
        for (section, names) in lists {
            // Measures of wheels, `front.toe`, are found in the list that asks for them.
            for (k, name) in names.into_iter().enumerate().filter(|(_, name)| !name.contains('.')) {
                let Some((line, column)) = file.place(section, k) else { continue };
                let text = file.text().lines().nth(line - 1).unwrap();
                let rest: String = text.chars().skip(column - 1).collect();
                // A mirrored entry is found where its original is.
                let twin = name.replace("right", "left");
                let fits = [name, &twin]
                    .iter()
                    .any(|n| rest.starts_with(n.as_str()) || rest.starts_with(&format!("\"{n}\"")));
                found += 1;
                assert!(fits, "{}: {section:?} {k} `{name}` is said to be at `{rest}`", path.display());
            }
        }
        assert!(found > 0 || !m.cases.is_empty(), "{}", path.display());
    }
}

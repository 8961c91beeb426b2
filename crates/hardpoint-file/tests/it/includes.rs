//! Included files: their entries and names, and diagnostics of their errors.

use std::path::Path;

use hardpoint::Analysis;
use hardpoint::model::{BodyId, Model};
use hardpoint_file::{ModelFile, parse, parse_in, parse_over, parse_with, read};

use crate::diagnostics::diagnosed;

const CORNER: &str = r#"
name = "a corner"
units = { length = "mm", angle = "deg" }

[parameters]
arm = { value = 300, unit = "length" }

[hardpoints]
pivot = [100, 200, 0]
bob = ["pivot.x", "pivot.y + arm", 0]
link_in = [100, 50, 80]

[bodies]
arm = {}
rack = {}

[joints]
hinge = { type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "x" }
slide = { type = "translational", bodies = ["ground", "rack"], at = "link_in", axis = "y" }

[drivers]
lift = { joint = "hinge", law = { type = "table", file = "lift.csv" } }
steer = { joint = "slide", law = 0 }

[design]
pivot = { move = "pivot", along = "z", bounds = [-5, 5] }

[points]
bob = { body = "arm", at = "bob" }

[measures]
height = { type = "position", point = "bob", along = "z" }
double = { type = "expression", expression = "2*height + bob.y" }

[time]
end = 1.0
steps = 10
"#;
const AXLE: &str = r#"
name = "an axle"
include = [{ file = "corner.toml", prefix = "left_", shared = ["rack", "slide", "steer"], parameters = { arm = 250 } }]
mirror = { variables = "independent" }

[hardpoints]
left_pivot = [110, 210, 0]

[drivers]
steer = { law = "3*t" }

[time]
end = 1.0
steps = 10
"#;
const VEHICLE: &str = r#"
name = "a vehicle"
include = [
    { file = "axles/axle.toml", prefix = "front_" },
    { file = "axles/axle.toml", prefix = "rear_", parameters = { left_arm = 400, right_arm = 400 } },
]

[time]
end = 1.0
steps = 4
"#;

/// A folder with these files.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

fn vehicle() -> tempfile::TempDir {
    folder(&[
        ("vehicle.toml", VEHICLE),
        ("axles/axle.toml", AXLE),
        ("axles/corner.toml", CORNER),
        ("axles/lift.csv", "0, 0\n0.5, 5\n1, 10\n"),
    ])
}

fn opened(folder: &Path, name: &str) -> ModelFile {
    read(&folder.join(name)).unwrap_or_else(|e| panic!("{e}"))
}

fn place(model: &Model, name: &str) -> [f64; 3] {
    let hardpoint = model.hardpoints.iter().find(|h| h.name == name).unwrap_or_else(|| panic!("{name}"));
    hardpoint.position.to_array().map(|x| (x * 1e6).round() / 1e3)
}

#[test]
fn a_vehicle_has_its_axles_and_these_their_corners() {
    let folder = vehicle();
    let axle = opened(&folder.path().join("axles"), "axle.toml").model;
    assert_eq!(axle.name, "an axle");
    assert_eq!(place(&axle, "left_bob"), [110.0, 460.0, 0.0]);
    assert_eq!(place(&axle, "right_bob"), [110.0, -460.0, 0.0]);
    let names = |list: Vec<&str>| list.iter().map(|n| (*n).to_owned()).collect::<Vec<String>>();
    assert_eq!(
        names(axle.bodies.iter().map(|b| b.name.as_str()).collect()),
        ["ground", "left_arm", "rack", "right_arm"]
    );
    assert_eq!(axle.drivers.iter().find(|d| d.name == "steer").unwrap().law.at(1.0).value(), 0.003);

    let vehicle = opened(folder.path(), "vehicle.toml");
    let model = &vehicle.model;
    assert_eq!((model.name.as_str(), model.times.len()), ("a vehicle", 5));
    assert_eq!(place(model, "front_left_bob"), [110.0, 460.0, 0.0]);
    assert_eq!(place(model, "rear_right_bob"), [110.0, -610.0, 0.0]);
    assert_eq!(model.bodies.len(), 1 + 6);
    let variables = names(model.variables.iter().map(|v| v.name.as_str()).collect());
    assert!(variables.contains(&"rear_left_pivot".to_owned()), "{variables:?}");
    let solution = Analysis::new(model).unwrap().run();
    let value = |name: &str| {
        let m = model.measures.iter().position(|m| m.name == name).unwrap();
        solution.measured.value(4, m)[0]
    };
    // 10 deg up: 250 mm sin(10 deg), and 400 mm.
    let sine = 10_f64.to_radians().sin();
    for (name, arm) in [("front_left_height", 0.25), ("rear_left_height", 0.4), ("rear_right_height", 0.4)] {
        assert!((value(name) - arm * sine).abs() < 1e-12, "{name}");
    }
    let expected = 2.0 * 0.4 * sine + 0.21 + 0.4 * 10_f64.to_radians().cos();
    assert!((value("rear_left_double") - expected).abs() < 1e-12);

    // A page holds the texts of all files, and reads the same from them.
    let known: Vec<&str> = vehicle.texts.keys().map(String::as_str).collect();
    assert_eq!(known, ["axles/axle.toml", "axles/corner.toml", "axles/lift.csv"]);
    let again = parse_with(VEHICLE, "vehicle.toml", &vehicle.texts).unwrap_or_else(|e| panic!("{e}")).model;
    assert_eq!(again.hardpoints, model.hardpoints);
}

#[test]
fn a_number_of_another_file_is_not_saved_in_this_one() {
    let folder = vehicle();
    let file = opened(&folder.path().join("axles"), "axle.toml");
    let design = |changes: &[(&str, f64)]| {
        let mut design = vec![0.0; file.model.variables.len()];
        for (name, by) in changes {
            design[file.model.variable(name).unwrap().0] = *by;
        }
        file.edit(&design)
    };
    let saved = design(&[("left_pivot", 0.001), ("right_pivot", 0.001)]).unwrap();
    assert_eq!(saved, AXLE.replace("[110, 210, 0]", "[110, 210, 1]"));
    let refused = design(&[("left_arm", 0.001), ("right_arm", 0.001)]).unwrap_err();
    assert!(refused.to_string().contains("`left_arm` is in the included file `corner.toml`"), "{refused}");
}

#[test]
fn a_case_that_a_metric_of_another_file_names_keeps_its_name() {
    // The corner has a driver of that name, which gets the prefix.
    let corner = format!("{CORNER}\n[metrics.most]\nof = \"height\"\ntake = \"max\"\ncase = \"lift\"\n");
    let axle = r#"
name = "an axle"
include = [{ file = "corner.toml", prefix = "left_" }]
[cases.lift]
laws = { left_lift = "10*t" }
time = { end = 1, steps = 4 }
"#;
    let folder = folder(&[("axle.toml", axle), ("corner.toml", &corner), ("lift.csv", "0, 0\n1, 10\n")]);
    let model = opened(folder.path(), "axle.toml").model;
    let metric = model.metrics.iter().find(|m| m.name == "left_most").unwrap();
    assert_eq!(metric.case.map(|case| model.cases[case.0].name.as_str()), Some("lift"));
}

#[test]
fn mistakes_in_included_files() {
    let corner = |from: &str, to: &str| {
        assert!(CORNER.contains(from), "{from}");
        CORNER.replace(from, to)
    };
    let axle = |from: &str, to: &str| {
        assert!(AXLE.contains(from), "{from}");
        AXLE.replace(from, to)
    };
    let lift = ("lift.csv", "0, 0\n1, 10\n".to_owned());
    let cases: [(&str, String, String); 12] = [
        ("included_misspelt_key", AXLE.into(), corner("axis = \"x\"", "axes = \"x\"")),
        ("included_unknown_hardpoint", AXLE.into(), corner("at = \"pivot\"", "at = \"pivet\"")),
        ("included_no_toml", AXLE.into(), corner("[bodies]", "[bodies")),
        (
            "included_in_other_units",
            "units = { length = \"m\", angle = \"deg\" }\n".to_owned() + AXLE,
            CORNER.into(),
        ),
        ("included_missing", axle("\"corner.toml\"", "\"korner.toml\""), CORNER.into()),
        ("included_from_above", axle("\"corner.toml\"", "\"../corner.toml\""), CORNER.into()),
        (
            "included_in_itself",
            AXLE.into(),
            corner("[bodies]", "[bodies]").replacen("name", "include = [\"axle.toml\"]\nname", 1),
        ),
        ("included_with_unknown_parameter", axle("arm = 250", "arn = 250"), CORNER.into()),
        ("included_with_unknown_shared", axle("\"slide\"", "\"slyde\""), CORNER.into()),
        ("included_as_a_text", axle("include = [", "include = \"corner.toml\" #"), CORNER.into()),
        ("included_with_misspelt_key", axle("prefix", "prefics"), CORNER.into()),
        ("included_with_hyphen", axle("prefix = \"left_\"", "prefix = \"left-\""), CORNER.into()),
    ];
    for (name, axle, corner) in cases {
        let folder = folder(&[("axle.toml", &axle), ("corner.toml", &corner), (lift.0, &lift.1)]);
        let error = read(&folder.path().join("axle.toml")).expect_err(name);
        let root = format!("{}/", folder.path().display());
        let shown = error.to_string().replace(&root, "").replace(root.trim_end_matches('/'), "FOLDER");
        diagnosed(name, error.diagnostics(), shown);
    }
    let error = parse(AXLE, "axle.toml").unwrap_err();
    assert_eq!(error.list()[0].code, "HP0111", "{error}");
}

/// Coordinates of a vehicle over its motion, from a file with this text.
fn heights(folder: &Path, text: &str) -> Vec<[f64; 3]> {
    std::fs::create_dir_all(folder).unwrap();
    std::fs::write(folder.join("saved.toml"), text).unwrap();
    let file = opened(folder, "saved.toml");
    let solution = Analysis::new(&file.model).unwrap().run();
    let bodies = 1..file.model.bodies.len();
    (0..solution.motion.len())
        .flat_map(|k| bodies.clone().map(move |b| (k, b)))
        .map(|(k, b)| solution.body(k, BodyId(b)).r.to_array())
        .collect()
}

#[test]
fn a_model_saved_in_another_folder_reads_the_same_files() {
    let folder = vehicle();
    let (models, axles) = (folder.path(), folder.path().join("axles"));
    let axle = opened(&axles, "axle.toml");
    let text = axle.text();
    let own = heights(&axles, text);
    // In the same folder, the text is the same, by any path of the folder.
    assert_eq!(axle.text_for(text, Some(&axles), &models.join("axles/../axles")).unwrap(), text);
    // Above it, names are longer; all else is unchanged.
    let above = axle.text_for(text, Some(&axles), models).unwrap();
    assert_eq!(above, text.replace("\"corner.toml\"", "\"axles/corner.toml\""));
    assert_eq!(heights(models, &above), own);
    // In a folder of its own, the files are missing, and then have other contents, and then are copies.
    let other = models.join("other");
    let refused = |why: &str| {
        let found = axle.text_for(text, Some(&axles), &other).unwrap_err();
        let [d] = found.list() else { panic!("{found}") };
        let all = format!("{} {}", d.message, d.notes.join(" "));
        assert!(d.code == "HP0505" && all.contains(why), "{all}");
        assert!(d.help.as_deref().is_some_and(|help| help.contains("copy `")), "{d:?}");
    };
    refused("it reads `corner.toml`, which is not there");
    std::fs::create_dir(&other).unwrap();
    std::fs::copy(axles.join("corner.toml"), other.join("corner.toml")).unwrap();
    refused("it reads `lift.csv`, which is not there");
    std::fs::write(other.join("lift.csv"), "0, 0\n1, 90\n").unwrap();
    refused("the `lift.csv` there has other contents");
    std::fs::copy(axles.join("lift.csv"), other.join("lift.csv")).unwrap();
    let copied = axle.text_for(text, Some(&axles), &other).unwrap();
    assert_eq!(copied, text);
    assert_eq!(heights(&other, &copied), own);
    // A copy does not overwrite what it reads, also what an included file reads.
    for name in ["corner.toml", "lift.csv"] {
        let found = axle.spares_its_files(&axles, &axles.join("../axles").join(name)).unwrap_err();
        let message = &found.list()[0].message;
        assert!(message.contains(&format!("cannot be saved as `{name}`: it reads this file")), "{message}");
    }
    assert!(axle.spares_its_files(&axles, &axles.join("axle.toml")).is_ok());
    assert!(axle.spares_its_files(&axles, &axles.join("new.toml")).is_ok());
    // A text without a folder has the texts of its files, but not the files.
    let sent = parse_with(text, "axle.toml", &axle.texts).unwrap();
    assert_eq!(sent.text_for(text, None, &other).unwrap(), text);
    let found = sent.text_for(text, None, models).unwrap_err();
    assert!(found.list()[0].message.contains("it reads `corner.toml`"), "{found}");
}

/// The composed table has the entries of included files and mirror images, and so have texts without a folder; files
/// that are given are not read from the folder.
#[test]
fn the_composed_table_has_included_and_mirrored_entries() {
    let corner = "name = \"corner\"\nunits = { length = \"mm\", angle = \"deg\" }\n\
        hardpoints = { left_A = [0, 300, 0], left_B = [0, 600, 0] }\nbodies.left_arm = {}\n\
        joints.left_hinge = { type = \"revolute\", bodies = [\"ground\", \"left_arm\"], at = \"left_A\", axis = \"x\" }\n\
        drivers.left_bump = { joint = \"left_hinge\", law = { type = \"table\", file = \"law.csv\", ends = \"natural\" } }\n\
        forces.left_load = { type = \"force\", at = { body = \"left_arm\", at = \"left_B\" }, force = 100, along = \"z\", law = \"t\" }\n\
        time = { end = 1, steps = 4 }\n";
    let text = "name = \"axle\"\ninclude = [\"corner.toml\"]\nmirror = {}\ntime = { end = 1, steps = 4 }\n\
        drivers.right_bump = { law = \"5*t\" }\n[cases.left_up]\nlaws = { left_bump = \"30*t\" }\n";
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("corner.toml", corner);
    write("law.csv", "0,0\n0.5,10\n1,20\n");
    write("axle.toml", text);
    let axle = read(&folder.path().join("axle.toml")).unwrap_or_else(|e| panic!("{e}"));
    let composed = axle.composed();
    assert_eq!(composed["drivers"]["right_bump"]["law"].as_str(), Some("5*t"));
    assert_eq!(composed["drivers"]["left_bump"]["law"]["file"].as_str(), Some("law.csv"));
    assert_eq!(composed["forces"]["right_load"]["law"].as_str(), Some("t"));
    assert_eq!(composed["cases"]["right_up"]["laws"]["right_bump"].as_str(), Some("30*t"));
    let passed = parse_with(text, "axle.toml", &axle.texts).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(passed.composed(), composed);
    std::fs::remove_file(folder.path().join("law.csv")).unwrap();
    std::fs::remove_file(folder.path().join("corner.toml")).unwrap();
    let again = parse_over(folder.path(), &axle.texts, text, "axle.toml").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(again.texts, axle.texts);
    assert!(parse_in(Some(folder.path()), text, "axle.toml").is_err());
}

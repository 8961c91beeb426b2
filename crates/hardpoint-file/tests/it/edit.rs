//! A changed design saved in its file: the same motion, and no other byte.

use std::path::{Path, PathBuf};

use hardpoint::law::ParameterKind;
use hardpoint::model::{Change, DesignVariable, Model, VariableId};
use hardpoint::run::metrics;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::{ModelFile, parse, read};
use hardpoint_study::whatif::add_coordinates;

/// Positions, rates and second rates of the saved file agree with those of the changed design to this part of the
/// largest of them (or of the mechanism's size, or 1): round-off of the closure, times how near to singular the models
/// come.
const SAME_MOTION: f64 = 1e-8;
/// Change of each variable relative to its natural step.
const PART: f64 = 0.01;

fn models() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let files = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let mut files: Vec<_> = files.filter(|p| p.extension().is_some_and(|e| e == "toml")).collect();
    files.sort();
    assert!(files.len() >= 30);
    files
}

fn solved(file: &ModelFile, design: &[f64]) -> Solution {
    let analysis = Analysis::new(&file.model).unwrap();
    analysis.solve(Run::new().at(design).without_sensitivities())
}

/// Sensitivities of the saved file agree with those of the changed design to this part of the largest of their output.
const SAME_SENSITIVITIES: f64 = 1e-6;

/// Compares the sensitivities of a changed design with those of its saved file. Returns the variables whose directions
/// follow from the nominal design, so that they change with it: shapes, tilts about lines through hardpoints.
fn compare_sensitivities(what: &str, file: &ModelFile, design: &[f64], again: &ModelFile) -> Vec<String> {
    let [a, b] = [(file, design), (again, &[][..])].map(|(file, design)| {
        let [first, .., last] = file.model.times[..] else { panic!("{what}: one output time") };
        let model = Model { times: vec![first, 0.4 * last + 0.6 * first], ..file.model.clone() };
        Analysis::new(&model).unwrap().solve(Run::new().at(design))
    });
    let mut redefined = Vec::new();
    for (v, (old, new)) in file.model.variables.iter().zip(&again.model.variables).enumerate() {
        assert_eq!(old.name, new.name, "{what}");
        if changes_of(file, &file.model, old) != changes_of(file, &again.model, new) {
            redefined.push(format!("{what}: {}", old.name));
            continue;
        }
        let step = file.model.natural_step(VariableId(v));
        for m in 0..a.measured.outputs.len() {
            for order in 0..3 {
                let both = |k: usize| [&a, &b].map(|s| step * s.measured.d(k, VariableId(v), m)[order]);
                let largest =
                    (0..a.motion.len()).map(|k| both(k)[0].abs()).fold(file.model.size().max(1.0), f64::max);
                for k in 0..a.motion.len() {
                    let [x, y] = both(k);
                    let output = &a.measured.outputs[m].name;
                    // Of a mechanism that a change jams, there are none.
                    assert!(
                        (x - y).abs() <= SAME_SENSITIVITIES * largest || x.is_nan() && y.is_nan(),
                        "{what}: d {output} / d {}, order {order}: {x} {y}",
                        old.name
                    );
                }
            }
        }
    }
    redefined
}

/// Changes of a variable of a model, without those of hardpoints that a file does not have: added ones move like the
/// ends of rods that they stand for.
fn changes_of(file: &ModelFile, model: &Model, variable: &DesignVariable) -> Vec<String> {
    let changes = variable.changes.iter().filter_map(|change| match change {
        Change::Move(c) => {
            let name = &model.hardpoints[c.hardpoint.0].name;
            let is_known = file.model.hardpoints.iter().any(|h| h.name == *name);
            is_known.then(|| format!("{name} {:.9?}", c.velocity))
        }
        change => Some(format!("{change:.9?}")),
    });
    changes.collect()
}

/// Relative difference of two motions; infinite if they are not of the same length.
fn apart(size: f64, a: &Solution, b: &Solution) -> f64 {
    if a.motion.len() != b.motion.len() {
        return f64::INFINITY;
    }
    let mut worst = 0.0_f64;
    for m in 0..a.measured.outputs.len() {
        for order in 0..3 {
            let both = |k: usize| [a, b].map(|s| s.measured.value(k, m)[order]);
            let largest = (0..a.motion.len()).map(|k| both(k)[0].abs()).fold(size.max(1.0), f64::max);
            let off = (0..a.motion.len()).map(|k| (both(k)[0] - both(k)[1]).abs()).fold(0.0, f64::max);
            worst = worst.max(off / largest);
        }
    }
    worst
}

/// The text as a file in a folder of its own, with the data files that lie beside the model.
fn read_again(path: &Path, text: &str) -> Result<ModelFile, hardpoint_file::ReadError> {
    let folder = tempfile::tempdir().unwrap();
    for entry in std::fs::read_dir(path.parent().unwrap()).unwrap() {
        let data = entry.unwrap().path();
        if data.extension().is_some_and(|e| e == "csv") {
            std::fs::copy(&data, folder.path().join(data.file_name().unwrap())).unwrap();
        }
    }
    let saved = folder.path().join("saved.toml");
    std::fs::write(&saved, text).unwrap();
    read(&saved)
}

fn refused(file: &ModelFile, design: &[f64]) -> Option<String> {
    file.edit(design).err().map(|d| d.list()[0].message.clone())
}

#[test]
fn a_saved_design_moves_as_the_changed_one_and_changes_no_other_line() {
    let (mut saved, mut messages) = (0, Vec::new());
    for path in models() {
        let file = read(&path).unwrap();
        let name = path.file_stem().unwrap().to_str().unwrap();
        for k in 0..file.model.variables.len() {
            let variable = VariableId(k);
            let mut design = vec![0.0; file.model.variables.len()];
            design[k] = PART * file.model.natural_step(variable);
            let what = format!("{name}: {}", file.model.variables[k].name);
            let text = match file.edit(&design) {
                Ok(text) => text,
                Err(why) => {
                    messages.push(format!("{what}: {}", why.list()[0].message));
                    continue;
                }
            };
            saved += 1;
            let again = read_again(&path, &text).unwrap_or_else(|e| panic!("{what}: {e}"));
            let before = solved(&file, &design);
            // If the changed design does not move, the saved one need not.
            if before.stop.is_some() {
                continue;
            }
            let after = solved(&again, &[]);
            let off = apart(file.model.size(), &before, &after);
            assert!(off < SAME_MOTION, "{what}: {off:e}");
            // A rod that keeps its length while its ends move gets a line for it, and one for a hardpoint; a joint that
            // turns, one for its x axis.
            let count = |text: &str, key: &str| text.lines().filter(|l| l.starts_with(key)).count();
            let has_new_axis = count(&text, "axis2") > count(file.text(), "axis2");
            let kept = |l: &&str| {
                let is_new = !file.text().lines().any(|old| old == *l);
                let key = l.split(" = ").next().unwrap();
                let added = key == "length" || key.contains("_of_");
                let is_axis = key == "axis2" && has_new_axis;
                !(is_new && (file.model.variables[k].fixed_length && added || is_axis))
            };
            let after: Vec<&str> = text.lines().filter(kept).collect();
            assert_eq!(file.text().lines().count(), after.len(), "{what}");
            let lines: Vec<_> = file.text().lines().zip(after).filter(|(a, b)| a != b).collect();
            assert_ne!(text, file.text(), "{what}");
            for (old, new) in lines {
                let comment = |l: &str| l.split_once('#').map(|(_, c)| c.to_owned());
                assert_eq!(comment(old), comment(new), "{what}");
                let words = |l: &str| l.split('=').next().unwrap().to_owned();
                assert_eq!(words(old), words(new), "{what}");
            }
            // A saved design has nothing left to save.
            assert_eq!(again.edit(&[]).unwrap(), text, "{what}");
        }
    }
    insta::assert_snapshot!(format!("{saved} saved\n{}", messages.join("\n")));
}

/// The default x axis follows the global axes, and jumps from one to another; that of the changed design has turned.
#[test]
fn a_joint_that_turns_keeps_its_default_x_axis_in_the_saved_file() {
    let text = |axis: &str| {
        format!(
            r#"
name = "plate"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0], B = [60, 61, 52] }}
bodies = {{ plate = {{}} }}
time = {{ at = [0, 1] }}
joints.t = {{ type = "inplane", bodies = ["ground", "plate"], at = "A", axis = {axis} }}
joints.hold = {{ type = "orientation", bodies = ["ground", "plate"] }}
drivers.dx = {{ joint = "t", coordinate = "x", law = "100*t" }}
drivers.dy = {{ joint = "t", coordinate = "y", law = "30*t" }}
points.P = {{ body = "plate", at = "A" }}
[design]
tilt_x = {{ tilt = "t", about = "x" }}
B_z = {{ move = "B", along = "z" }}
"#
        )
    };
    let numbers = "[0.60, 0.61, 0.52]";
    let through = r#"{ through = ["A", "B"] }"#;
    for (axis, design) in [
        (numbers, [("tilt_x", 2.0_f64.to_radians())]),
        (numbers, [("tilt_x", 8.0_f64.to_radians())]),
        (through, [("B_z", 0.012)]),
    ] {
        let text = text(axis);
        let file = parse(&text, "plate.toml").unwrap_or_else(|e| panic!("{e}"));
        let values = of(&file, &design);
        let saved = file.edit(&values).unwrap_or_else(|e| panic!("{e}"));
        let again = parse(&saved, "plate.toml").unwrap_or_else(|e| panic!("{e}\n{saved}"));
        assert!(saved.contains("axis2 = ["), "{saved}");
        let off = apart(file.model.size(), &solved(&file, &values), &solved(&again, &[]));
        assert!(off < SAME_MOTION, "{axis} {design:?}: {off:e}\n{saved}");
    }
}

const ROD: &str = "\
#:schema hardpoint.schema.json\r
name = \"all kinds\" # by hand\r
units = { length = \"mm\", angle = \"deg\" }\r
[parameters]\r
reach = { value = 300, unit = \"length\", bounds = [250, 350] }\r
[hardpoints]\r
A = [0, 0, 0]\r
B = [0, 100.0, 0]   # the crank's pin\r
C = [\"reach\", 250, 0]\r
D = [400, 0, 0]\r
[bodies]\r
crank = {}\r
rocker = {}\r
[joints]\r
bearing = { type = \"revolute\", bodies = [\"ground\", \"crank\"], at = \"A\", axis = \"z\" }\r
pivot = { type = \"revolute\", bodies = [\"ground\", \"rocker\"], at = \"D\", axis = [0, 0, 2] } # leans\r
rod = { type = \"distance\", bodies = [\"crank\", \"rocker\"], at = [\"B\", \"C\"] }\r
[drivers]\r
motor = { joint = \"bearing\", law = { type = \"harmonic\", amplitude = 10, frequency = 1 } }\r
[design]\r
B_y = { move = \"B\", along = \"y\", bounds = [-10, 5.5] } # room\r
B_kept = { move = \"B\", along = \"x\", fixed_length = true }\r
C_x = { move = \"C\", along = \"x\" }\r
lean = { tilt = \"pivot\", about = \"x\" }\r
swing = { driver = \"motor\", parameter = \"amplitude\" }\r
off = { markers = [{ joint = \"pivot\", on = \"j\", move = [0, 0, 1] }] }\r
[points]\r
C = { body = \"rocker\", at = \"C\" }\r
[measures]\r
angle = { type = \"coordinate\", joint = \"pivot\" }\r
[time]\r
end = 1\r
steps = 20\r
";

fn of(file: &ModelFile, changes: &[(&str, f64)]) -> Vec<f64> {
    let mut design = vec![0.0; file.model.variables.len()];
    changes.iter().for_each(|(name, by)| design[file.model.variable(name).unwrap().0] = *by);
    design
}

#[test]
fn numbers_are_those_that_a_person_would_write() {
    let file = parse(ROD, "rod.toml").unwrap_or_else(|e| panic!("{e}"));
    let design = of(&file, &[("B_y", 0.0052), ("reach", 0.0001), ("swing", 0.1_f64.to_radians())]);
    let saved = file.edit(&design).unwrap_or_else(|e| panic!("{e}"));
    let expected = ROD
        .replace("[0, 100.0, 0] ", "[0, 105.2, 0] ")
        .replace("value = 300,", "value = 300.1,")
        .replace("[-10, 5.5]", "[-15.2, 0.3]")
        .replace("amplitude = 10,", "amplitude = 10.1,");
    assert_eq!(saved, expected);
    let again = parse(&saved, "rod.toml").unwrap();
    assert!(apart(0.4, &solved(&file, &design), &solved(&again, &[])) < SAME_MOTION);
    let back =
        again.edit(&of(&again, &[("B_y", -0.0052), ("reach", -0.0001), ("swing", -0.1_f64.to_radians())]));
    // A number that had a point keeps it.
    let points = [
        ("value = 300,", "value = 300.0,"),
        ("amplitude = 10,", "amplitude = 10.0,"),
        ("[-10, 5.5]", "[-10.0, 5.5]"),
    ];
    assert_eq!(back.unwrap(), points.iter().fold(ROD.to_owned(), |text, (old, new)| text.replace(old, new)));
}

#[test]
fn a_value_of_a_table_law_is_saved_in_its_points() {
    let harmonic = "law = { type = \"harmonic\", amplitude = 10, frequency = 1 } }";
    let table = "law = { type = \"table\", points = [[0, 0], [0.5, 4], [1, 9]], ends = \"natural\" } }";
    let text = ROD.replace(harmonic, table).replace("parameter = \"amplitude\"", "parameter = \"f[1]\"");
    let file = parse(&text, "rod.toml").unwrap_or_else(|e| panic!("{e}"));
    let design = of(&file, &[("swing", 0.5_f64.to_radians())]);
    let saved = file.edit(&design).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(saved, text.replace("[0.5, 4]", "[0.5, 4.5]"));
}

#[test]
fn a_rod_that_is_not_made_anew_is_given_its_length() {
    let file = parse(ROD, "rod.toml").unwrap();
    let design = of(&file, &[("B_kept", 0.004)]);
    let saved = file.edit(&design).unwrap_or_else(|e| panic!("{e}"));
    // It still follows C, which is moved by other variables.
    assert!(saved.contains("length = \"sqrt(C.x^2 + (250 - B.y)^2)\""), "{saved}");
    let again = parse(&saved, "rod.toml").unwrap();
    assert!(apart(0.4, &solved(&file, &design), &solved(&again, &[])) < SAME_MOTION);
    let redefined = compare_sensitivities("rod", &file, &design, &again);
    assert!(redefined.is_empty(), "{redefined:?}");
    // Without others, it has a number.
    let alone = ROD
        .replace("C_x = { move = \"C\", along = \"x\" }\r\n", "")
        .replace("B_y = ", "D_y = ")
        .replace("move = \"B\", along = \"y\"", "move = \"D\", along = \"y\"")
        .replace("C = [\"reach\", 250, 0]", "C = [300, 250, 0]");
    let file = parse(&alone, "rod.toml").unwrap();
    let saved = file.edit(&of(&file, &[("B_kept", 0.004)])).unwrap_or_else(|e| panic!("{e}"));
    assert!(saved.contains("length = 335.41019662496"), "{saved}");
}

#[test]
fn coordinates_added_to_the_model_are_not_variables_that_a_rod_follows() {
    // A what-if and the page add a variable for each coordinate. The saved file does not have them.
    let alone = ROD
        .replace("B_y = { move = \"B\", along = \"y\", bounds = [-10, 5.5] } # room\r\n", "")
        .replace("C_x = { move = \"C\", along = \"x\" }\r\n", "")
        .replace("C = [\"reach\", 250, 0]", "C = [300, 250, 0]");
    for (text, expected) in [
        // The rod is as long as in the text: 335.4101966249685 = sqrt(300^2 + 150^2)
        (alone.as_str(), "length = 335.41019662496"),
        (ROD, "length = \"sqrt(C.x^2 + (250 - B.y)^2)\""),
    ] {
        let mut file = parse(text, "rod.toml").unwrap_or_else(|e| panic!("{e}"));
        let own = file.clone();
        add_coordinates(&mut file.model);
        assert!(file.model.variable("B.x").is_some());
        let change = [("B_kept", 0.004)];
        let saved = file.edit(&of(&file, &change)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(saved, own.edit(&of(&own, &change)).unwrap());
        assert!(saved.contains(expected), "{saved}");
        // Where such a coordinate moves the end as well, the length is that from (1, 100) to (300, 250).
        let design = of(&file, &[("B_kept", 0.004), ("B.x", 0.001)]);
        let saved = file.edit(&design).unwrap_or_else(|e| panic!("{e}"));
        assert!(saved.contains("B = [5, 100.0, 0]"), "{saved}");
        let again = parse(&saved, "rod.toml").unwrap_or_else(|e| panic!("{e}\n{saved}"));
        assert!(apart(0.4, &solved(&file, &design), &solved(&again, &[])) < SAME_MOTION);
    }
}

#[test]
fn changes_without_a_number_in_the_file_are_reported_before_writing() {
    let file = parse(ROD, "rod.toml").unwrap();
    let messages: Vec<String> =
        ["C_x", "off"].map(|v| refused(&file, &of(&file, &[(v, 0.001)])).unwrap()).into();
    insta::assert_snapshot!(messages.join("\n"));
    let beyond = refused(&file, &of(&file, &[("B_y", 0.006)])).unwrap();
    assert_eq!(beyond, "the change of `B_y` cannot be saved: the changed design is beyond its bounds");
}

#[test]
fn named_designs_stay_at_the_same_values() {
    let designs =
        "[designs.high]\r\nB_y = 2.5 # mm\r\nreach = 310\r\n[designs.other]\r\nC_x = 4\r\nB_y = 1\r\n";
    let file = parse(&format!("{ROD}{designs}"), "rod.toml").unwrap();
    let change = of(&file, &[("B_y", 0.001), ("reach", 0.005)]);
    let text = file.edit(&change).unwrap();
    let expected = designs.replace("2.5 # mm", "1.5 # mm").replace("B_y = 1\r", "B_y = 0\r");
    assert!(text.ends_with(&expected), "{text}");
    // The point is where it was in the design, and the design is nominal in what it does not name.
    let again = parse(&text, "rod.toml").unwrap();
    let places = |file: &ModelFile| {
        let named = file.model.designs.iter().find(|design| design.name == "high").unwrap();
        file.model.hardpoint_places(&named.changes_of(file.model.variables.len()))
    };
    for (before, after) in places(&file).into_iter().zip(places(&again)) {
        assert!((before - after).norm() < 1e-12, "{before:?} {after:?}");
    }
}

#[test]
fn a_rod_that_keeps_its_length_at_an_end_that_others_move_follows_an_added_hardpoint() {
    let both = "B_kept = { move = \"B\", along = \"x\", fixed_length = true }\r\n";
    let text = ROD.replace(both, &format!("{both}B_x = {{ move = \"B\", along = \"x\" }}\r\n"));
    let file = parse(&text, "rod.toml").unwrap_or_else(|e| panic!("{e}"));
    let design = of(&file, &[("B_kept", 0.004), ("B_x", 0.001), ("B_y", 0.002)]);
    let saved = file.edit(&design).unwrap_or_else(|e| panic!("{e}"));
    for line in [
        "B = [5, 102.0, 0]",
        "B_of_rod = [1, 102.0, 0]",
        "B_y = { move = [\"B\", \"B_of_rod\"], along = \"y\"",
        "B_x = { move = [\"B\", \"B_of_rod\"], along = \"x\"",
        "length = \"sqrt((C.x - B_of_rod.x)^2 + (250 - B_of_rod.y)^2)\"",
    ] {
        assert!(saved.contains(line), "{line}\n{saved}");
    }
    let again = parse(&saved, "rod.toml").unwrap_or_else(|e| panic!("{e}\n{saved}"));
    assert!(again.remarks.is_empty(), "{:?}", again.remarks);
    let redefined = compare_sensitivities("rod", &file, &design, &again);
    assert!(redefined.is_empty(), "{redefined:?}");
    // A shape does not move points by their names alone.
    let shape = "shape = [\"crank\"], field = { translate = \"x\" }";
    let text = text.replace("B_x = { move = \"B\", along = \"x\"", &format!("B_x = {{ {shape}"));
    let file = parse(&text, "rod.toml").unwrap_or_else(|e| panic!("{e}"));
    let why = refused(&file, &of(&file, &[("B_kept", 0.004)])).unwrap();
    let expected = "the change of `B_kept` cannot be saved: `rod` keeps its length under some variables that move `B`, \
                    and follows others";
    assert_eq!(why, expected);
}

#[test]
fn a_limit_on_a_rod_that_keeps_its_length_can_be_saved() {
    let text = "\
name = \"rod length limit\"
units = { length = \"mm\", angle = \"deg\" }
planar = \"xy\"
hardpoints = { A = [0, 0], B = [40, 20], C = [140, 60], D = [150, 0] }
bodies = { crank = [\"A\", \"B\"], rocker = [\"C\", \"D\"] }
time = { end = 1, steps = 10 }
[joints]
A = { type = \"revolute\", bodies = [\"ground\", \"crank\"], at = \"A\" }
D = { type = \"revolute\", bodies = [\"ground\", \"rocker\"], at = \"D\" }
rod = { type = \"distance\", bodies = [\"crank\", \"rocker\"], at = [\"B\", \"C\"] }
[drivers.m]
joint = \"A\"
law = \"30*t\"
[design]
c = { move = \"C\", along = \"x\", fixed_length = true, bounds = [-10, 10] }
b = { move = \"B\", along = \"x\", bounds = [-10, 10] }
[measures]
psi = { type = \"coordinate\", joint = \"D\" }
[metrics]
r = { of = \"psi\", take = \"change\" }
[optimize]
goals = { r = { target = 17 } }
limits = { l = { length = \"rod\", max = 112 } }
";
    let file = parse(text, "rod.toml").unwrap_or_else(|e| panic!("{e}"));
    let design = of(&file, &[("c", 0.01), ("b", -0.0046)]);
    let saved = file.edit(&design).unwrap_or_else(|e| panic!("{e}"));
    assert!(saved.contains("at = [\"B\", \"C\"], length = \"sqrt((140 - B.x)^2 + 40^2)\" }"), "{saved}");
    let again = parse(&saved, "rod.toml").unwrap_or_else(|e| panic!("{e}\n{saved}"));
    assert!(compare_sensitivities("rod", &file, &design, &again).is_empty());
    assert!(apart(0.1, &solved(&file, &design), &solved(&again, &[])) < SAME_MOTION);
    // The second save leaves the expression alone, and keeps the length.
    let back = again.edit(&of(&again, &[("c", -0.01), ("b", 0.0046)])).unwrap();
    assert!(back.contains("B = [40.0, 20], C = [140, 60]"), "{back}");
    assert!(apart(0.1, &solved(&file, &[]), &solved(&parse(&back, "rod.toml").unwrap(), &[])) < SAME_MOTION);
}

#[test]
fn a_text_that_becomes_invalid_is_reported_without_positions_in_it() {
    let text = ROD
        .replace("axis = [0, 0, 2] }", "axis = { through = [\"D\", \"E\"] } }")
        .replace("D = [400, 0, 0]\r\n", "D = [400, 0, 0]\r\nE = [400, 0, 10]\r\n")
        .replace("lean = { tilt = \"pivot\", about = \"x\" }", "lean = { move = \"E\", along = \"z\" }");
    let file = parse(&text, "rod.toml").unwrap_or_else(|e| panic!("{e}"));
    // Both points of the axis become one.
    let found = file.edit(&of(&file, &[("lean", -0.01)])).unwrap_err();
    let [d] = found.list() else { panic!("{found}") };
    assert!(d.code == "HP0505" && d.line.is_none(), "{found}");
    assert!(d.notes[0].starts_with("a file with its numbers is invalid: "), "{found}");
}

#[test]
fn elements_with_two_places_of_their_own_can_be_saved() {
    let text = "\
name = \"places\"
units = { length = \"mm\", angle = \"deg\" }
hardpoints = { A = [0, 0, 0], D = [300, 0, 0] }
parameters = { k = 40 }
bodies = { a = {}, c = {} }
time = { end = 1, steps = 2 }
drivers.d = { joint = \"J\", law = \"10*t\" }
design.A_y = { move = \"A\", along = \"y\" }
measures.apart = { type = \"distance\", from = { body = \"a\", at = [0, 0, 10] }, to = { body = \"c\", at = [300, 0, 15] } }
measures.df = { type = \"driver_force\", driver = \"d\" }
[joints]
J = { type = \"revolute\", bodies = [\"ground\", \"a\"], at = \"A\", axis = \"y\" }
K = { type = \"revolute\", bodies = [\"ground\", \"c\"], at = \"D\", axis = \"y\" }
rod = { type = \"distance\", bodies = [\"a\", \"c\"], at = [[0, 0, 100], [300, 0, 150]] }
[forces]
spring = { type = \"spring\", from = { body = \"ground\", at = [500, 0, 300] }, to = { body = \"a\", at = [550, 0, -80] }, stiffness = \"k\" }
bushing = { type = \"bushing\", from = { body = \"ground\", at = [100, 0, 1] }, to = { body = \"c\", at = [110, 0, 2] }, x = 1, y = 1, z = 1 }
[masses]
bar = { type = \"bar\", from = { body = \"a\", at = [0, 0, 1] }, to = { body = \"a\", at = [0, 0, 90] }, diameter = 9, density = 7850 }
";
    let file = parse(text, "places.toml").unwrap_or_else(|e| panic!("{e}"));
    let design = of(&file, &[("k", 5.0), ("A_y", 0.001)]);
    let saved = file.edit(&design).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(saved, text.replace("k = 40", "k = 45").replace("A = [0, 0, 0]", "A = [0, 1, 0]"));
}

/// Numbers by name.
type Numbers = &'static [(&'static str, f64)];

/// Laws with all their parameters: of a law, the text, and that with other numbers of the given parameters.
const LAWS: [(&str, Numbers, &str); 9] = [
    (
        "{ type = \"harmonic\", amplitude = 10, frequency = 1 }",
        &[("amplitude", 11.0), ("frequency", 1.5), ("phase", 3.0), ("offset", 2.0)],
        "{ type = \"harmonic\", amplitude = 11, frequency = 1.5, phase = 3, offset = 2 }",
    ),
    (
        "{ type = \"constant_speed\", speed = 10 }",
        &[("speed", 11.0), ("offset", 2.0)],
        "{ type = \"constant_speed\", speed = 11, offset = 2 }",
    ),
    (
        "{ type = \"polynomial\", coefficients = [0, 4, -3] }",
        &[("c0", 1.0), ("c1", 4.5), ("c2", -2.0)],
        "{ type = \"polynomial\", coefficients = [1, 4.5, -2] }",
    ),
    (
        "{ type = \"smooth_step\", to = 40, start = 0.5, end = 1 }",
        &[("from", 1.0), ("to", 41.0), ("start", 0.4), ("end", 0.9)],
        "{ type = \"smooth_step\", to = 41, start = 0.4, end = 0.9, from = 1 }",
    ),
    (
        "{ type = \"trapezoid\", from = 0, to = 40, start = 0.5, end = 1.5, ramp = 0.2 }",
        &[("from", 1.0), ("to", 41.0), ("start", 0.4), ("end", 1.6), ("ramp", 0.3)],
        "{ type = \"trapezoid\", from = 1, to = 41, start = 0.4, end = 1.6, ramp = 0.3 }",
    ),
    (
        "{ type = \"table\", points = [[0, 0], [0.5, 4], [1, 9]], spline = \"quintic\" }",
        &[("f[1]", 5.0), ("start_speed", 1.0), ("end_acceleration", 2.0)],
        "{ type = \"table\", points = [[0, 0], [0.5, 5], [1, 9]], spline = \"quintic\", \
         start_speed = 1, end_acceleration = 2 }",
    ),
    (
        "{ type = \"table\", points = [[0, 1], [0.5, 4], [0.7, -3], [1, 1]], ends = \"periodic\" }",
        &[("f[0]", 2.0), ("f[2]", -2.0)],
        "{ type = \"table\", points = [[0, 2], [0.5, 4], [0.7, -2], [1, 2]], ends = \"periodic\" }",
    ),
    (
        "{ type = \"expression\", law = \"a*sin(w*t)\", parameters = { a = 25, w = 6.28 } }",
        &[("a", 26.0), ("w", 6.5)],
        "{ type = \"expression\", law = \"a*sin(w*t)\", parameters = { a = 26, w = 6.5 } }",
    ),
    (
        "{ type = \"sequence\", pieces = [{ duration = 0.5, law = { type = \"polynomial\", coefficients = [0, 2] } }, \
         { law = { type = \"sequence\", pieces = [{ duration = 0.1, law = { type = \"constant_speed\", speed = 1 } }, \
         { law = 0 }] } }] }",
        &[
            ("piece[0].duration", 0.6),
            ("piece[0].c1", 3.0),
            ("piece[1].piece[0].duration", 0.2),
            ("piece[1].piece[0].speed", 5.0),
        ],
        "{ type = \"sequence\", pieces = [{ duration = 0.6, law = { type = \"polynomial\", coefficients = [0, 3] } }, \
         { law = { type = \"sequence\", pieces = [{ duration = 0.2, law = { type = \"constant_speed\", speed = 5 } }, \
         { law = 0 }] } }] }",
    ),
];

#[test]
fn every_parameter_of_every_law_is_saved() {
    let harmonic = "{ type = \"harmonic\", amplitude = 10, frequency = 1 }";
    let mut kinds: Vec<&str> = Vec::new();
    for (law, parameters, expected) in LAWS {
        let variable =
            |k: usize, name: &str| format!("law_{k} = {{ driver = \"motor\", parameter = \"{name}\" }}\r\n");
        let design: String = parameters.iter().enumerate().map(|(k, (name, _))| variable(k, name)).collect();
        let swing = "swing = { driver = \"motor\", parameter = \"amplitude\" }\r\n";
        let text = ROD.replace(swing, &design).replace(harmonic, law);
        let file = parse(&text, "rod.toml").unwrap_or_else(|e| panic!("{law}: {e}"));
        let model = &file.model;
        // Units of the file: deg of the driver, and of the phase.
        let written = model.drivers[0].law.parameters();
        let changes: Vec<(String, f64)> = (parameters.iter().enumerate())
            .map(|(k, (name, value))| {
                let old = written.iter().find(|p| p.name == *name).unwrap();
                let scale = if old.kind.is_in_driver_unit() || old.kind == ParameterKind::Angle {
                    1_f64.to_radians()
                } else {
                    1.0
                };
                let Change::Law(change) =
                    &model.variables[model.variable(&format!("law_{k}")).unwrap().0].changes[0]
                else {
                    panic!()
                };
                (format!("law_{k}"), (value * scale - old.value) / change.rate)
            })
            .collect();
        let changes: Vec<(&str, f64)> = changes.iter().map(|(name, by)| (name.as_str(), *by)).collect();
        let saved = file.edit(&of(&file, &changes)).unwrap_or_else(|e| panic!("{law}: {e}"));
        assert_eq!(saved, text.replace(law, expected));
        let kind = law.split('"').nth(1).unwrap();
        kinds.push(kind);
    }
    // Each type of the format.
    let schema: serde_json::Value = serde_json::from_str(&hardpoint_file::schema()).unwrap();
    let types = schema["$defs"]["LawTable"]["oneOf"].as_array().unwrap();
    kinds.dedup();
    assert_eq!(types.len(), kinds.len());
}

#[test]
fn points_of_a_curve_move_with_the_joint_that_carries_it() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/cam.toml");
    let text = std::fs::read_to_string(path).unwrap();
    // A distance that is kept has no place in a file where it was drawn.
    let file = parse(&text, "cam.toml").unwrap_or_else(|e| panic!("{e}"));
    assert!(refused(&file, &of(&file, &[("camshaft_x", 0.0005)])).is_some());
    let kept = "{ move = \"camshaft\", along = \"x\", fixed_length = true }";
    let text = text.replace(kept, "{ move = \"camshaft\", along = \"x\" }");
    let file = parse(&text, "cam.toml").unwrap_or_else(|e| panic!("{e}"));
    let design = of(&file, &[("camshaft_x", 0.0005)]);
    let saved = file.edit(&design).unwrap_or_else(|e| panic!("{e}"));
    assert!(saved.contains("[0.500000000, 45") || saved.contains("[0.5, 45.000000000, 0]"), "{saved}");
    let again = parse(&saved, "cam.toml").unwrap_or_else(|e| panic!("{e}"));
    assert!(apart(0.1, &solved(&file, &design), &solved(&again, &[])) < SAME_MOTION);
    assert!(compare_sensitivities("cam", &file, &design, &again).is_empty());
}

#[test]
fn ranges_of_a_sweep_and_means_of_priors_stay_at_the_same_values() {
    let studies = "[metrics]\r\nm = { of = \"angle\", take = \"max\" }\r\n\
                   [sweep.variables]\r\nB_y = { from = -2, to = 3 }\r\nC_x = [-3, 3] # mm\r\nreach = [290, 310]\r\n\
                   [calibrate.variables]\r\nB_y = { sigma = 1, mean = 2 }\r\nC_x = 1\r\n";
    let text = format!("{ROD}{studies}").replace("C = [\"reach\", 250, 0]", "C = [300, 250, 0]");
    let file = parse(&text, "rod.toml").unwrap_or_else(|e| panic!("{e}"));
    let change = of(&file, &[("B_y", 0.001), ("C_x", 0.002), ("reach", 0.005)]);
    let saved = file.edit(&change).unwrap_or_else(|e| panic!("{e}"));
    let expected = studies
        .replace("from = -2, to = 3", "from = -3, to = 2")
        .replace("[-3, 3] # mm", "[-5, 1] # mm")
        .replace("mean = 2", "mean = 1");
    assert!(saved.ends_with(&expected), "{saved}");
    let again = parse(&saved, "rod.toml").unwrap_or_else(|e| panic!("{e}\n{saved}"));
    let ends = |file: &ModelFile, k: usize| file.model.sweeping.as_ref().unwrap().ranges[k].low;
    for k in 0..3 {
        let variable = file.model.sweeping.as_ref().unwrap().ranges[k].variable;
        assert!((ends(&file, k) - change[variable.0] - ends(&again, k)).abs() < 1e-12);
    }
}

/// Metrics of the saved file are those of the changed design to this part of them, or of 1.
const SAME_METRIC: f64 = 1e-9;
/// Change of a variable relative to its bounds, or its natural step: small enough that every template still moves.
const ROOM: f64 = 0.02;

/// Metrics of all cases at a design.
fn metrics_of(file: &ModelFile, design: &[f64]) -> Vec<(String, f64)> {
    let values = |model: &Model| {
        let solution = Analysis::new(model).unwrap().solve(Run::new().at(design).without_sensitivities());
        assert!(solution.stop.is_none(), "{}: {:?}", model.name, solution.stop);
        let values = metrics(model, &solution).into_iter();
        let named = model.metrics.iter().zip(values);
        named.map(|(metric, value)| (metric.name.clone(), value.value.unwrap())).collect::<Vec<_>>()
    };
    file.model.motions().iter().flat_map(values).collect()
}

#[test]
fn templates_are_saved_with_every_variable_at_another_value() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hardpoint-cli/templates");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 9);
    let (mut split, mut expressions) = (0, Vec::new());
    for path in files {
        let file = read(&path).unwrap_or_else(|e| panic!("{e}"));
        let model = &file.model;
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let value = |k: usize| {
            let room = match model.variables[k].bounds {
                Some([low, high]) => high.min(-low),
                None => model.natural_step(VariableId(k)),
            };
            ROOM * room * (1.0 + 0.1 * k as f64)
        };
        let mut design: Vec<f64> = (0..model.variables.len()).map(value).collect();
        // A variable may move a point that follows from parameters: such a place has no number.
        for k in 0..design.len() {
            let alone: Vec<f64> = (0..design.len()).map(|n| if n == k { design[k] } else { 0.0 }).collect();
            if let Some(why) = refused(&file, &alone) {
                assert!(why.contains("given by an expression"), "{name}: {why}");
                expressions.push(format!("{name}: {}", model.variables[k].name));
                design[k] = 0.0;
            }
        }
        let text = file.edit(&design).unwrap_or_else(|e| panic!("{name}: {e}"));
        let again = parse(&text, &name).unwrap_or_else(|e| panic!("{name}: {e}\n{text}"));
        // The same variables, with the same effect, tolerance and bounds of the value.
        assert_eq!(model.variables.len(), again.model.variables.len(), "{name}");
        for ((old, new), value) in model.variables.iter().zip(&again.model.variables).zip(&design) {
            assert_eq!(old.name, new.name, "{name}");
            assert_eq!(changes_of(&file, model, old), changes_of(&file, &again.model, new), "{name}");
            assert_eq!(
                (old.tolerance, old.typical, old.fixed_length),
                (new.tolerance, new.typical, new.fixed_length),
                "{name}"
            );
            let shifted = old.bounds.map(|ends| ends.map(|x| x - value));
            let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < 1e-12;
            assert!(
                shifted.is_none() && new.bounds.is_none() || near(shifted.unwrap(), new.bounds.unwrap()),
                "{name}"
            );
        }
        let (before, after) = (metrics_of(&file, &design), metrics_of(&again, &[]));
        assert!(!before.is_empty(), "{name}");
        for ((metric, a), (_, b)) in before.iter().zip(&after) {
            assert!((a - b).abs() <= SAME_METRIC * a.abs().max(1.0), "{name}: {metric}: {a} {b}");
        }
        split += text.lines().count() - file.text().lines().count();
        // Comments stay, once.
        let comments = |text: &str| {
            text.lines().filter_map(|l| l.split_once('#')).map(|(_, c)| c.to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(comments(file.text()), comments(&text), "{name}");
        assert_eq!(again.edit(&[]).unwrap(), text, "{name}");
    }
    // B and C of the four-bar, and B of the slider-crank; the length of a leg, and a hardpoint for that of a rod.
    assert_eq!(split, 5);
    assert_eq!(expressions, ["delta.toml: rod_error"]);
}

#[test]
fn an_entry_of_several_variables_is_split_in_every_layout() {
    let head = "\
name = \"crank\"
units = { length = \"mm\", angle = \"deg\" }
planar = \"xy\"
hardpoints = { O = [0, 0], A = [20, 0] }
bodies = { ground = [\"O\"], crank = [\"O\", \"A\"] }
drivers.turn = { joint = \"O\", law = \"30*t\" }
points.A = { body = \"crank\", at = \"A\" }
time = { end = 1, steps = 4 }
";
    let layouts = [
        (
            "\n[design] # all\n# the pin\nA  = { move = \"A\", along = \"xy\", bounds = [-9, 9], tolerance = 0.1 } # mm\n# last\n",
            "\n[design] # all\n# the pin\nA_x  = { move = \"A\", along = \"x\", bounds = [-10, 8], tolerance = 0.1 } # mm\n\
             A_y  = { move = \"A\", along = \"y\", bounds = [-11, 7], tolerance = 0.1 }\n# last\n",
        ),
        (
            "design = { A = { move = \"A\", along = \"xyz\", bounds = [-9, 9] } }\n",
            "design = { A_x = { move = \"A\", along = \"x\", bounds = [-10, 8] }, \
             A_y = { move = \"A\", along = \"y\", bounds = [-11, 7] } }\n",
        ),
        (
            "# the pin\ndesign.A = { move = \"A\", along = \"xy\", bounds = [-9, 9] } # mm\n",
            "# the pin\ndesign.A_x = { move = \"A\", along = \"x\", bounds = [-10, 8] } # mm\n\
             design.A_y = { move = \"A\", along = \"y\", bounds = [-11, 7] }\n",
        ),
        (
            "\n# the pin\n[design.A] # one\nmove = \"A\" # moved\nalong = \"xy\"\n# both\nbounds = [-9, 9]\n\n# next\n[page]\n",
            "\n# the pin\n[design.A_x] # one\nmove = \"A\" # moved\nalong = \"x\"\n# both\nbounds = [-10, 8]\n\
             \n[design.A_y]\nmove = \"A\"\nalong = \"y\"\nbounds = [-11, 7]\n\n# next\n[page]\n",
        ),
        (
            "[design]\nA.move = \"A\" # moved\nA.along = \"xy\"\nA.bounds = [-9, 9]\n",
            "[design]\nA_x.move = \"A\" # moved\nA_x.along = \"x\"\nA_x.bounds = [-10, 8]\n\
             A_y.move = \"A\"\nA_y.along = \"y\"\nA_y.bounds = [-11, 7]\n",
        ),
    ];
    for (old, new) in layouts {
        let file = parse(&format!("{head}{old}"), "crank.toml").unwrap_or_else(|e| panic!("{e}"));
        let design = of(&file, &[("A_x", 0.001), ("A_y", 0.002)]);
        let text = file.edit(&design).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(text, format!("{}{new}", head.replace("A = [20, 0]", "A = [21, 2]")));
        // Variables that move alike stay together.
        let alike = file.edit(&of(&file, &[("A_x", 0.001), ("A_y", 0.001)])).unwrap();
        let both = old.replace("[-9, 9]", "[-10, 8]");
        assert_eq!(alike, format!("{}{both}", head.replace("A = [20, 0]", "A = [21, 1]")));
    }
    // The name of the point in tolerances is still that of both.
    let tolerance =
        "design.A = { move = \"A\", along = \"xy\", bounds = [-9, 9] }\ntolerance.variables.A = 0.1\n";
    let file = parse(&format!("{head}{tolerance}"), "crank.toml").unwrap_or_else(|e| panic!("{e}"));
    let text = file.edit(&of(&file, &[("A_x", 0.001)])).unwrap();
    let again = parse(&text, "crank.toml").unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!(again.model.tolerancing, file.model.tolerancing);
}

#[test]
fn mirrored_points_are_split_with_their_images() {
    let text = "\
name = \"two\"
units = { length = \"mm\", angle = \"deg\" }
mirror = { across = \"y\" }
hardpoints = { left_O = [0, 100, 0], left_A = [20, 100, 0] }
bodies.left_crank = {}
joints.left_pin = { type = \"revolute\", bodies = [\"ground\", \"left_crank\"], at = \"left_O\", axis = \"z\" }
drivers.left_turn = { joint = \"left_pin\", law = \"30*t\" }
design.left_A = { move = \"left_A\", along = \"xyz\", bounds = [-9, 9] }
points.left_A = { body = \"left_crank\", at = \"left_A\" }
time = { end = 1, steps = 4 }
";
    let file = parse(text, "two.toml").unwrap_or_else(|e| panic!("{e}"));
    let design = of(&file, &[("left_A_x", 0.001), ("left_A_y", 0.002)]);
    let saved = file.edit(&design).unwrap_or_else(|e| panic!("{e}"));
    let again = parse(&saved, "two.toml").unwrap_or_else(|e| panic!("{e}\n{saved}"));
    for (old, new) in file.model.variables.iter().zip(&again.model.variables) {
        assert_eq!((&old.name, &old.changes), (&new.name, &new.changes));
        assert!(old.changes.len() == 2);
    }
    assert_eq!(file.model.variables.len(), again.model.variables.len());
    assert!(apart(0.1, &solved(&file, &design), &solved(&again, &[])) < SAME_MOTION);
}

/// Step of central differences, m: their truncation is 1e-10 of third derivatives.
const STEP: f64 = 1e-5;

/// Two shafts in fixed bearings that a constant-velocity joint connects.
fn shafts(design: &str) -> String {
    format!(
        r#"
name = "shafts"
units = {{ length = "m", angle = "rad" }}
hardpoints = {{ P = [0, 0, 0], A = [-1, 0, 0], B = [1, 0.4, 0] }}
bodies = {{ one = {{}}, two = {{}} }}
drivers.turn = {{ joint = "a", law = "0.1 + 2*t" }}
points.tip = {{ body = "two", at = [0.9, 0.5, 0.3] }}
time = {{ at = [0, 0.3, 1] }}
[joints]
a = {{ type = "revolute", bodies = ["ground", "one"], axis = {{ through = ["A", "P"] }} }}
cv = {{ type = "constant_velocity", bodies = ["one", "two"], at = "P", axis = {{ through = ["A", "P"] }}, axis2 = {{ through = ["P", "B"] }} }}
b = {{ type = "cylindrical", bodies = ["ground", "two"], at = "P", axis = {{ through = ["P", "B"] }} }}
[measures]
out = {{ type = "coordinate", joint = "b", coordinate = "angle" }}
x = {{ type = "position", point = "tip", along = [1, 0.2, 0.3] }}
[design]
{design}
"#
    )
}

#[test]
fn shafts_of_a_constant_velocity_joint_rotate_equally_in_every_design() {
    let moves = "A_z = { move = \"A\", along = \"z\" }\nA_y = { move = \"A\", along = \"y\" }\n\
                 B = { move = \"B\", along = [0, -1, 1] }\n";
    let text = shafts(moves);
    let file = parse(&text, "shafts.toml").unwrap_or_else(|e| panic!("{e}"));
    let written = |design: &[f64]| {
        let saved = file.edit(design).unwrap_or_else(|e| panic!("{e}"));
        parse(&saved, "shafts.toml").unwrap_or_else(|e| panic!("{e}\n{saved}"))
    };
    let index = |solution: &Solution, name: &str| solution.measured.index(name).unwrap();
    for design in [[0.0; 3], [0.2, 0.0, 0.0], [0.15, -0.3, 0.25]] {
        let changed = Analysis::new(&file.model).unwrap().solve(Run::new().at(&design));
        assert!(apart(1.0, &changed, &solved(&written(&design), &[])) < 1e-12, "{design:?}");
        for k in 0..changed.motion.len() {
            let [out, rate, _] = changed.measured.value(k, index(&changed, "out"));
            let t = file.model.times[k];
            // The angle of the driven shaft is that of the driving one, whatever the angle between them.
            assert!(
                (out - 0.1 - 2.0 * t).abs() < 1e-12 && (rate - 2.0).abs() < 1e-12,
                "{design:?}: {out} {rate}"
            );
        }
        for v in 0..3 {
            let mut at = |by: f64| {
                let mut design = design;
                design[v] += by;
                solved(&written(&design), &[])
            };
            let [low, high] = [-STEP, STEP].map(&mut at);
            for k in 0..changed.motion.len() {
                for name in ["out", "x"] {
                    let m = index(&changed, name);
                    for order in 0..3 {
                        let found = changed.measured.d(k, VariableId(v), m)[order];
                        let difference = high.measured.value(k, m)[order] - low.measured.value(k, m)[order];
                        let error = (found - difference / (2.0 * STEP)).abs();
                        assert!(error < 1e-7, "{design:?}: d {name} / d {v}, order {order}: {error:e}");
                    }
                }
            }
        }
    }
    // A turn of one shaft's marker is an angle between the shafts, for which a file has no number.
    let turned = shafts("turn = { markers = [{ joint = \"cv\", on = \"j\", turn = [0.3, 0.2, 0.1] }] }");
    let turned = turned.replace("axis2 = { through = [\"P\", \"B\"] }", "axis2 = [1, 0.4, 0]");
    let file = parse(&turned, "shafts.toml").unwrap_or_else(|e| panic!("{e}"));
    let found = file.edit(&[0.1]).unwrap_err();
    let [d] = found.list() else { panic!("{found}") };
    assert!(
        d.code == "HP0505" && d.notes[0].ends_with("another relation of the shafts of joint `cv`"),
        "{found}"
    );
}

#[test]
fn the_angle_of_a_body_is_that_of_the_same_direction_in_the_saved_file() {
    let text = |axis2: &str| {
        format!(
            r#"
name = "head"
units = {{ length = "m", angle = "deg" }}
hardpoints = {{ O = [0, 0, 0], T = [0.3, -0.1, 1] }}
bodies = {{ b = {{}} }}
joints.u = {{ type = "universal", bodies = ["ground", "b"], at = "O", axis = [1, 0.2, 0], axis2 = [0.2, -1, -0.32] }}
time = {{ at = [0, 0.3, 0.7, 1.2] }}
[drivers]
a = {{ joint = "u", coordinate = "angle", law = "30*sin(t)" }}
h = {{ body = "b", about = {{ through = ["O", "T"] }}, law = "20*sin(2*t) + 5*t"{axis2} }}
[measures]
a2 = {{ type = "coordinate", joint = "u", coordinate = "angle2" }}
seen = {{ type = "angle", from = [1, 3, 0], to = {{ body = "b", axis = [1, 3, 0] }}, about = [0.3, -0.1, 1] }}
[design]
T_x = {{ move = "T", along = "x" }}
"#
        )
    };
    for axis2 in ["", ", axis2 = [1, 3, 0]", ", axis2 = [1, 3, 0.5]"] {
        let file = parse(&text(axis2), "head.toml").unwrap_or_else(|e| panic!("{e}"));
        let saved = file.edit(&[0.1]).unwrap_or_else(|e| panic!("{e}"));
        let again = parse(&saved, "head.toml").unwrap_or_else(|e| panic!("{e}\n{saved}"));
        let off = apart(1.0, &solved(&file, &[0.1]), &solved(&again, &[]));
        assert!(off < 1e-12, "{axis2}: {off:e}\n{saved}");
        assert!(saved.matches("axis2 = [").count() == 2, "{saved}");
        let solution = solved(&file, &[]);
        let law = |t: f64| 20.0 * (2.0 * t).sin() + 5.0 * t;
        let seen = (0..4).map(|k| {
            let found = solution.measured.value(k, solution.measured.index("seen").unwrap())[0];
            (found.to_degrees() - law(file.model.times[k])).abs()
        });
        let worst = seen.fold(0.0, f64::max);
        // The direction whose angle is measured is the one that is driven, or not.
        assert!(if axis2 == ", axis2 = [1, 3, 0]" { worst < 1e-10 } else { worst > 0.1 }, "{axis2}: {worst}");
    }
    let parallel = parse(&text(", axis2 = [0.6, -0.2, 2]"), "head.toml").unwrap_err();
    let [d] = parallel.list() else { panic!("{parallel}") };
    assert!(d.code == "HP0209" && d.message.contains("driver `h`"), "{parallel}");
}

//! A changed design saved in its file: the same motion, and no other byte.

use std::path::{Path, PathBuf};

use hardpoint::run::metrics;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::{ModelFile, parse, read};

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
            let variable = hardpoint::model::VariableId(k);
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
            // A rod that keeps its length while its ends move gets a line that says so.
            let kept = |l: &&str| {
                let added = l.starts_with("length = ") && !file.text().lines().any(|old| old == *l);
                !(file.model.variables[k].fixed_length && added)
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
    assert!(saved.contains("length = 335.41019662496"), "{saved}");
    let again = parse(&saved, "rod.toml").unwrap();
    assert!(apart(0.4, &solved(&file, &design), &solved(&again, &[])) < SAME_MOTION);
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

/// Metrics of the saved file are those of the changed design to this part of them, or of 1.
const SAME_METRIC: f64 = 1e-9;
/// Change of a variable relative to its bounds, or its natural step: small enough that every template still moves.
const ROOM: f64 = 0.02;

/// Metrics of all cases at a design.
fn metrics_of(file: &ModelFile, design: &[f64]) -> Vec<(String, f64)> {
    let values = |model: &hardpoint::model::Model| {
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
                None => model.natural_step(hardpoint::model::VariableId(k)),
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
            assert_eq!((&old.name, &old.changes), (&new.name, &new.changes), "{name}");
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
    // B and C of the four-bar, and B of the slider-crank.
    assert_eq!(split, 3);
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

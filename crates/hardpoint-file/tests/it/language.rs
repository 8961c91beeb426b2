//! Language features for editors: completion, meanings, references and renaming.

use std::path::{Path, PathBuf};

use hardpoint_file::{Completion, Document, read};

const STRUT: &str = r#"
name = "strut"
units = { length = "mm", angle = "deg" }

[parameters]
hub = { value = 60, unit = "length" }

[hardpoints]
A = [0, 0, 0]
"obere Öse" = [0, "hub + A.x", 300]
C = [100, 0, 0]

[bodies]
arm = {}

[joints.hinge]
type = "revolute"
bodies = ["ground", "arm"]
at = "A"
axis = { through = ["A", "obere Öse"] }

[drivers]
swing = { joint = "hinge", law = "30*sin(2*pi*t)" }

[points]
tip = { body = "arm", at = "C" }

[design.C]
move = "C"
along = "xyz"
bounds = [-5, 5]

[measures]
height = { type = "position", point = "tip", along = "z" }
twice = { type = "expression", expression = "2*height" }

[metrics]
peak = { of = "height", take = "max" }

[optimize]
variables = ["C_x", "C_z"]
goals = { peak = {} }

[time]
end = 1.0
steps = 10
"#;

/// Byte after the first occurrence of a text.
fn after(text: &str, needle: &str) -> usize {
    text.find(needle).unwrap_or_else(|| panic!("no {needle:?}")) + needle.len()
}

fn renamed(text: &str, at: usize, new: &str, folder: Option<&Path>) -> Result<String, String> {
    let edits = Document::new(text).rename(at, new, folder).map_err(|why| why.0)?;
    let mut text = text.to_owned();
    for (at, new) in edits.into_iter().rev() {
        text.replace_range(at, &new);
    }
    Ok(text)
}

fn labels(found: &[Completion]) -> Vec<&str> {
    found.iter().map(|c| c.label.as_str()).collect()
}

/// Completions at `|` in a text.
fn completed(text: &str) -> Vec<Completion> {
    let at = text.find('|').unwrap();
    Document::new(&text.replacen('|', "", 1)).completions(at, None)
}

/// Text after the first completion with a label.
fn inserted(text: &str, label: &str) -> String {
    let found = completed(text);
    let one = found.iter().find(|c| c.label == label);
    let one = one.unwrap_or_else(|| panic!("no {label} in {:?}", labels(&found)));
    let mut text = text.replacen('|', "", 1);
    text.replace_range(one.replaces.clone(), &one.insert);
    text
}

#[test]
fn names_are_found_wherever_they_are_used() {
    let document = Document::new(STRUT);
    let counts = [
        ("hub", "[parameters]\nhub", 2),
        ("A", "[hardpoints]\nA", 4),
        ("obere Öse", "\"obere Öse", 2),
        ("arm", "[bodies]\narm", 3),
        ("hinge", "[joints.hinge", 2),
        ("tip", "[points]\ntip", 2),
        ("height", "[measures]\nheight", 3),
        ("peak", "[metrics]\npeak", 2),
        // The variables of a point are its references.
        ("C", "[design.C", 3),
    ];
    for (name, needle, count) in counts {
        let found = document.name_at(after(STRUT, needle)).unwrap_or_else(|| panic!("{name}"));
        assert_eq!(found.name, name);
        let references = document.references(&found);
        assert_eq!(references.len(), count, "{name}: {references:?}");
        assert_eq!(references.iter().filter(|r| r.is_declaration).count(), 1);
        assert!(references.iter().all(|r| &STRUT[r.at.clone()] == name), "{references:?}");
    }
    // The hardpoint C is another entry than the variable.
    let point = document.name_at(after(STRUT, "at = \"C")).unwrap();
    assert_eq!((point.section, document.references(&point).len()), ("hardpoints", 3));
}

#[test]
fn entries_are_renamed_at_all_their_places() {
    for (needle, new) in [
        ("[parameters]\nhub", "overhang"),
        ("[hardpoints]\nA", "B"),
        ("\"obere Öse", "top"),
        ("[joints.hinge", "left hinge"),
        ("2*height", "level"),
        ("[design.C", "D"),
        ("goals = { peak", "summit"),
    ] {
        let text =
            renamed(STRUT, after(STRUT, needle), new, None).unwrap_or_else(|why| panic!("{new}: {why}"));
        hardpoint_file::parse(&text, "strut.toml").unwrap_or_else(|e| panic!("{new}: {e}"));
        assert_ne!(text, STRUT);
    }
    let text = renamed(STRUT, after(STRUT, "[joints.hinge"), "left hinge", None).unwrap();
    assert!(text.contains("[joints.\"left hinge\"]") && text.contains("joint = \"left hinge\""), "{text}");
    let text = renamed(STRUT, after(STRUT, "[design.C"), "D", None).unwrap();
    assert!(text.contains("[design.D]\nmove = \"C\"") && text.contains("[\"D_x\", \"D_z\"]"), "{text}");
}

#[test]
fn renaming_is_refused_where_it_would_change_the_model() {
    let refused =
        |text: &str, needle: &str, new: &str| renamed(text, after(text, needle), new, None).unwrap_err();
    assert_eq!(refused(STRUT, "[hardpoints]\nA", "C"), "`[hardpoints]` has an entry `C` already");
    assert_eq!(refused(STRUT, "\"ground", "earth"), "`ground` is the fixed body of every model");
    assert!(refused(STRUT, "[hardpoints]\nA", "a\"b").contains("no quotes"));
    // No expression could use such a name.
    let why = refused(STRUT, "[parameters]\nhub", "hub 2");
    assert!(why.starts_with("with the name `hub 2` the model has an error"), "{why}");
    // A name that another entry has in expressions.
    let why = refused(&STRUT.replace("2*height", "2*height + hub"), "[measures]\nheight", "hub");
    assert!(why.contains("hub"), "{why}");
    let why = refused(&STRUT.replace("at = \"A\"", "at = \"X\""), "[hardpoints]\nA", "B");
    assert!(why.starts_with("correct the errors of the file first"), "{why}");
    assert_eq!(refused(STRUT, "type = \"rev", "x"), "there is no name of an entry here");
}

#[test]
fn a_measure_does_not_become_a_constant_of_expressions() {
    for needle in ["[measures]\nheight", "2*height"] {
        let why = renamed(STRUT, after(STRUT, needle), "pi", None).unwrap_err();
        assert!(why.contains("no expression can use a measure named `pi`"), "{why}");
    }
    // Without a use in an expression, too; and in a file.
    let text = STRUT.replace("2*height", "2*tip.x");
    let why = renamed(&text, after(&text, "[measures]\nheight"), "pi", None).unwrap_err();
    assert!(why.contains("no expression can use a measure named `pi`"), "{why}");
    let error = hardpoint_file::parse(&text.replace("height", "pi"), "strut.toml").unwrap_err();
    let first = &error.list()[0];
    assert_eq!(
        (first.code, first.message.as_str()),
        ("HP0201", "no expression can use a measure named `pi`: it is a constant there")
    );
}

#[test]
fn a_measure_does_not_have_the_name_of_a_component_of_a_point() {
    let text = STRUT
        .replace("2*height", "2*tip.x")
        .replace("height =", "\"tip.x\" =")
        .replace("\"height", "\"tip.x");
    let error = hardpoint_file::parse(&text, "strut.toml").unwrap_err();
    let first = &error.list()[0];
    let message = "a component of a point has the name of measure `tip.x`";
    assert_eq!((first.code, first.message.as_str()), ("HP0201", message));
}

#[test]
fn entries_that_patterns_match_keep_matching_them() {
    let text = r#"
name = "pins"
units = { length = "mm", angle = "deg" }
bodies = { a = {} }
joints.h = { type = "revolute", bodies = ["ground", "a"], at = [0, 0, 0], axis = "z" }
drivers.m = { joint = "h", law = "10*t" }
time = { end = 1, steps = 1 }
[shapes]
pin_1 = { body = "a", sphere = [100, 0, 0], radius = 5 }
pin_2 = { body = "a", sphere = [0, 100, 0], radius = 5 }
cap = { body = "a", sphere = [0, 50, 0], radius = 5 }
wall = { body = "ground", sphere = [130, 0, 0], radius = 5 }
[clearances.k]
between = ["pin_*", "wall"]
min = { pin_2 = 30 }
"#;
    let named = |needle: &str, new: &str| renamed(text, after(text, needle), new, None);
    let why = named("[shapes]\npin_1", "bolt").unwrap_err();
    assert_eq!(why, "the pattern `pin_*` matches `pin_1` but not `bolt`");
    let why = named("\ncap", "pin_3").unwrap_err();
    assert_eq!(why, "the pattern `pin_*` matches `pin_3` but not `cap`");
    let other = named("[shapes]\npin_1", "pin_9").unwrap();
    assert!(other.contains("pin_9 = { body") && other.contains("[\"pin_*\", \"wall\"]"), "{other}");
    assert!(named("\nwall", "floor").unwrap().contains("\"floor\"]"));
}

#[test]
fn names_without_references_are_renamed_where_they_are_declared() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/studies");
    let text = std::fs::read_to_string(folder.join("strut_tolerances.toml")).unwrap();
    let groups = "\n[calibrate.groups]\nrods = { variables = [\"B_x\"], within = 0.1 }\n";
    assert_eq!(
        Document::new(groups).renameable_at(after(groups, "\nro")).unwrap().section,
        "calibrate.groups"
    );
    let at = after(&text, "[tolerance.correlations]\n");
    let found = Document::new(&text).renameable_at(at).unwrap();
    assert_eq!(found.section, "tolerance.correlations");
    let other = renamed(&text, at, "zz9", Some(&folder)).unwrap();
    assert!(other.contains("[tolerance.correlations]\nzz9 = "), "{other}");
}

#[test]
fn every_entry_of_every_model_can_be_renamed_and_back() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let mut files: Vec<PathBuf> = Vec::new();
    for folder in [models.clone(), models.join("studies")] {
        let entries = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
        files.extend(entries.filter(|p| p.extension().is_some_and(|e| e == "toml")));
    }
    files.sort();
    assert!(files.len() > 35, "only {} models", files.len());
    let (mut done, mut refused) = (0, Vec::new());
    for path in files {
        read(&path).unwrap_or_else(|e| panic!("{e}"));
        let text = std::fs::read_to_string(&path).unwrap();
        let document = Document::new(&text);
        let sections = document.symbols();
        // A few entries of each section: the test reads the model twice for each.
        const FEW: usize = 2;
        for entry in sections.iter().flat_map(|s| s.children.iter().take(FEW)) {
            let section = entry.section.unwrap();
            let Some(name) = document.name_at(entry.at.start + 1) else { continue };
            if name.section != section || name.name == "ground" {
                continue;
            }
            let new = if name.name.contains("left") { "left_zz9" } else { "zz9" };
            let folder = path.parent();
            match renamed(&text, name.at.start, new, folder) {
                Ok(other) => {
                    let place = Document::new(&other);
                    let (_, at) = place.declarations(new).into_iter().find(|d| d.0 == section).unwrap();
                    let back = renamed(&other, at.start, &name.name, folder);
                    assert_eq!(back.as_ref(), Ok(&text), "{}: {section}.{}", path.display(), name.name);
                    done += 1;
                }
                Err(why) => refused.push(format!("{}: {section}.{}: {why}", path.display(), name.name)),
            }
        }
    }
    assert!(done > 300, "only {done} entries were renamed: {refused:#?}");
    assert!(refused.len() * 50 < done, "{} of {done} are refused: {refused:#?}", refused.len());
}

#[test]
fn both_sides_of_a_mirror_follow() {
    let text = r#"
name = "two arms"
units = { length = "mm", angle = "deg" }
mirror = { across = "y", names = { left = "right" } }
hardpoints = { left_A = [0, 100, 0], left_B = [100, 100, 0] }
bodies = { left_arm = {} }
joints.left_hinge = { type = "revolute", bodies = ["ground", "left_arm"], at = "left_A", axis = "x" }
drivers.left_swing = { joint = "left_hinge", law = "10*t" }
points.left_tip = { body = "left_arm", at = "left_B" }
measures.gap = { type = "distance", from = "left_tip", to = "right_tip" }
time = { end = 1.0, steps = 2 }
"#;
    let other = renamed(text, after(text, "points.left_t"), "left_end", None).unwrap();
    assert!(other.contains("from = \"left_end\", to = \"right_end\""), "{other}");
    // The image has no entry of its own.
    let why = renamed(text, after(text, "\"right_t"), "right_end", None).unwrap_err();
    assert!(why.contains("mirror image of `left_tip`"), "{why}");
    let why = renamed(text, after(text, "points.left_t"), "end", None).unwrap_err();
    assert!(why.contains("no word of a side"), "{why}");
    // The text does not name these images.
    let why = renamed(text, after(text, "\"left_B"), "tip", None).unwrap_err();
    assert_eq!(why, "`tip` has no word of a side, so the mirror image `right_B` of `left_B` would be lost");
    let text = text.replace("left_B", "B").replace("to = \"right_tip\"", "to = \"P\"")
        + "points.P = { body = \"ground\", at = [0, 0, 50] }\n";
    let why = renamed(&text, after(&text, "[0, 100, 0], B"), "left_rack", None).unwrap_err();
    assert_eq!(why, "`left_rack` has a word of a side, so it would have a mirror image `right_rack`");
    // Another word of the same side.
    let other = renamed(&text, after(&text, "{ left_A"), "left-pin", None).unwrap();
    assert!(other.contains("at = \"left-pin\""), "{other}");
}

#[test]
fn names_of_planar_models_follow_their_hardpoints_and_bodies() {
    let text = r#"
name = "four-bar"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { A = [0, 0], B = [40, 200], C = [360, 600], D = [400, 0], "P" = [200, 400], Q = [300, 700] }
bodies = { ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C", "P"], rocker = ["C", "D"], arm = ["C", "Q"] }
drivers.motor = { joint = "A", law = "360*t" }
drivers.other = { joint = "C_arm", law = "0" }
[measures]
height = { type = "position", point = "P", along = "y" }
turn = { type = "coordinate", joint = "C_arm" }
half = { type = "expression", expression = "height/2" }
[metrics]
most = { of = "turn", take = "max" }
[design]
P = { move = "P", along = "xy", bounds = [-5, 5] }
[optimize]
variables = ["P_x", "P_y"]
goals = { most = {} }
"#;
    hardpoint_file::parse(text, "m.toml").unwrap_or_else(|e| panic!("{e}"));
    let document = Document::new(text);
    for (needle, section, count) in [
        ("point = \"P", "hardpoints", 4),
        ("move = \"P", "hardpoints", 4),
        ("[\"P", "design", 3),
        ("joint = \"C", "hardpoints", 6),
        ("\"C_arm", "bodies", 3),
    ] {
        let name = document.name_at(after(text, needle)).unwrap_or_else(|| panic!("{needle}"));
        assert_eq!((name.section, document.references(&name).len()), (section, count), "{needle}");
        for reference in document.references(&name) {
            let other =
                renamed(text, reference.at.end, "zz9", None).unwrap_or_else(|why| panic!("{needle}: {why}"));
            assert_eq!(other.matches("zz9").count(), count, "{other}");
        }
    }
    let points = completed(&text.replace("point = \"P\"", "point = \"|\""));
    assert_eq!(labels(&points), ["P", "Q"]);
    let joints = completed(&text.replace("joint = \"A\"", "joint = \"|\""));
    assert_eq!(labels(&joints), ["A", "B", "C", "D"]);
}

#[test]
fn keys_are_those_of_the_table_that_are_missing() {
    let found = completed("[joints.hinge]\ntype = \"revolute\"\n|\n\n[bodies]\narm = {}\n");
    let labels = labels(&found);
    assert!(
        labels.contains(&"bodies") && labels.contains(&"axis") && !labels.contains(&"type"),
        "{labels:?}"
    );
    assert_eq!(found.iter().find(|c| c.label == "bodies").unwrap().detail, "required");
    assert_eq!(inserted("[joints.hinge]\nbod|", "bodies"), "[joints.hinge]\nbodies = ");
    assert_eq!(inserted("[jo|", "joints"), "[joints");
    assert_eq!(
        inserted("x = 1\n[cases.bump]\nlaws = { | }\n[drivers]\nswing = {}\n", "swing")
            .lines()
            .nth(2)
            .unwrap(),
        "laws = { swing =  }"
    );
    // Keys of a kind follow its `type`.
    let found = completed("[measures]\nm = { type = \"distance\", | }");
    assert!(
        found.iter().any(|c| c.label == "from") && !found.iter().any(|c| c.label == "wheel"),
        "{found:?}"
    );
    assert!(completed("# a comment |").is_empty());
    assert!(completed("name = \"x\" |").is_empty());
}

#[test]
fn values_are_names_and_words() {
    let with =
        |line: &str| STRUT.replacen("[joints.hinge]", &format!("[joints.other]\n{line}\n[joints.hinge]"), 1);
    let found = completed(&with("bodies = [\"gr|"));
    assert_eq!(labels(&found), ["ground", "arm"]);
    assert!(inserted(&with("bodies = [\"ground\", |]"), "arm").contains("[\"ground\", \"arm\"]"));
    let found = completed(&with("at = |"));
    assert_eq!(labels(&found), ["A", "obere Öse", "C"]);
    let found = completed(&with("type = \"rev|"));
    let revolute = found.iter().find(|c| c.label == "revolute").unwrap();
    assert!(revolute.meaning.contains("Coordinate"), "{revolute:?}");
    assert!(
        labels(&completed("[drivers]\na = { joint = \"h\", cut = true }\n[joints]\nb = { cut = | }"))
            .contains(&"true")
    );
    let names = completed(&STRUT.replace("\"C_x\"", "\"|\""));
    assert_eq!(labels(&names), ["C_x", "C_y", "C_z", "hub"]);
    let terms = completed(&STRUT.replace("hub + A.x", "hub + A|"));
    assert!(labels(&terms).contains(&"A.x"), "{terms:?}");
    let terms = completed(&STRUT.replace("2*height", "2*he|"));
    assert!(labels(&terms).contains(&"height"), "{terms:?}");
}

#[test]
fn measures_of_wheels_are_names_too() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/front_axle.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let file = read(&path).unwrap();
    let wheel =
        hardpoint::measure::outputs(&file.model).into_iter().map(|o| o.name).find(|n| n.ends_with(".toe"));
    let measure = wheel.expect("the axle has wheels with toe");
    let text = format!("{text}\n[metrics.one]\nof = \"\"\n");
    let found = Document::new(&text).completions(text.len() - 2, Some(&file.model));
    assert!(found.iter().any(|c| c.label == measure), "{found:?}");
    // The name of the wheel is a part of that of its measure.
    let text = text.replacen("of = \"\"\n", &format!("of = \"{measure}\"\n"), 1);
    let document = Document::new(&text);
    let name = document.name_at(text.len() - 3).unwrap();
    assert_eq!(name.section, "wheels");
    assert_eq!(&text[name.at], measure.strip_suffix(".toe").unwrap());
}

#[test]
fn keys_and_words_have_meanings() {
    let document = Document::new(STRUT);
    let bodies = document.meaning_at(after(STRUT, "bodies = ") - 5).unwrap();
    assert!(
        bodies.is_required && bodies.meaning.contains("bodies i and j") && bodies.example.is_some(),
        "{bodies:?}"
    );
    let revolute = document.meaning_at(after(STRUT, "\"revolute") - 2).unwrap();
    assert_eq!(revolute.name, "revolute");
    let section = document.meaning_at(after(STRUT, "[hardpoints") - 2).unwrap();
    assert!(section.meaning.starts_with("Named points"), "{section:?}");
}

#[test]
fn broken_texts_have_a_language_too() {
    // Every prefix, and every text without one of its lines.
    for end in (0..=STRUT.len()).filter(|at| STRUT.is_char_boundary(*at)) {
        let document = Document::new(&STRUT[..end]);
        let _ = (
            document.completions(end, None),
            document.symbols(),
            document.name_at(end),
            document.meaning_at(end),
        );
    }
    let text =
        "[hardpoints]\nA = [0, 0\n\n[bodies]\narm = {\n[joints.hinge]\nbodies = [\"ground\", \"arm\"]\n";
    let document = Document::new(text);
    let names: Vec<String> = document.symbols().into_iter().map(|s| s.name).collect();
    assert_eq!(names, ["hardpoints", "bodies", "joints"]);
    let arm = document.name_at(after(text, "\"arm")).unwrap();
    assert_eq!(document.references(&arm).len(), 2);
    // Names that are written with escapes.
    let text = STRUT.replacen("at = \"A\"", "at = \"\\u0041\"", 1);
    assert!(hardpoint_file::parse(&text, "x.toml").is_ok());
    let why = renamed(&text, after(&text, "[hardpoints]\nA"), "B", None).unwrap_err();
    assert!(why.contains("escapes"), "{why}");
}

#[test]
fn tasks_have_their_own_keys() {
    let text = "name = \"gripper\"\nunits = { length = \"mm\", angle = \"deg\" }\nposes = [[0, 0, 0]]\n";
    let document = Document::new(text);
    assert!(document.is_task());
    let found = document.completions(text.len(), None);
    assert!(found.iter().any(|c| c.label == "fixed_region") && !found.iter().any(|c| c.label == "joints"));
    assert!(!Document::new(STRUT).is_task());
}

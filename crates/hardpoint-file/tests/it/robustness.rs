//! No text makes the reader panic or hang, every diagnostic can be shown, and twice the text takes twice the work.

use std::collections::BTreeSet;

use hardpoint_file::parse;
use proptest::prelude::*;
use toml::de::{DeTable, DeValue};

const MODELS: [&str; 8] = [
    include_str!("../../../../models/macpherson.toml"),
    include_str!("../../../../models/slider_crank.toml"),
    include_str!("../../../../models/rssr.toml"),
    include_str!("../../../../models/hooke.toml"),
    include_str!("../../../../models/double_wishbone.toml"),
    include_str!("../../../../models/double_wishbone_4x4.toml"),
    include_str!("../models/press.toml"),
    include_str!("../models/studies.toml"),
];

/// Pieces that make a broken file interesting.
const PIECES: [&str; 65] = [
    "[",
    "]",
    "{",
    "}",
    "=",
    ".",
    ",",
    "\"",
    "'",
    "\"\"\"",
    "\n",
    "#",
    "nan",
    "inf",
    "-1e308",
    "1e999",
    "0x7f",
    "true",
    "1979-05-27",
    "[[joints]]",
    "[design.x]",
    "type",
    "\"xyz\"",
    "{ through = [\"A\"] }",
    "ä",
    "\u{0}",
    "\u{feff}",
    "\r",
    "99999999999999999999",
    "at = []",
    "ground",
    "[joints.J1.axis]",
    "[couplers.c]",
    "[drivers.d.law]",
    "type = \"gear\"",
    "type = \"linear\"",
    "terms = [{ joint = \"J1\" }]",
    "teeth = [1, -1e300]",
    "type = \"table\"",
    "points = [[0, 0], [1e-300, 1e300]]",
    "file = \"../x\"",
    "pieces = [{ law = 1 }]",
    "parameters = { t = 1 }",
    "curve = { points = [] }",
    "kingpin = [\"P\", \"P\"]",
    "measures = \"all\"",
    "[cases.c]",
    "laws = { turn = \"t\" }",
    "other_drivers = \"as_in_model\"",
    "[optimize]",
    "[optimize.goals]",
    "limits = { l = { between = [\"A\", \"A\"], min = 2, max = 1 } }",
    "variables = [\"C_x\", \"C_x\"]",
    "[tolerance]",
    "[tolerance.variables]",
    "correlations = { c = { between = [\"C_x\", \"C_y\"], coefficient = 2 } }",
    "distribution = \"uniform\"",
    "[sweep]",
    "[sweep.variables]",
    "method = \"indices\"",
    "designs = \"../x.csv\"",
    "C_x = { from = 2, to = 1, levels = 1 }",
    "[designs.d]",
    "[page]",
    "plots = [{ y = [\"P.x\"], over = \"P.y\" }, 3]",
];

fn survives(text: &str) {
    match parse(text, "fuzz.toml") {
        Ok(file) => assert!(!file.model.times.is_empty()),
        Err(diagnostics) => {
            assert!(!diagnostics.list().is_empty());
            for d in diagnostics.list() {
                assert!(!d.message.is_empty() && !d.message.chars().any(char::is_control), "{:?}", d.message);
                if let Some(span) = &d.span {
                    assert!(text.get(span.clone()).is_some(), "{span:?}");
                }
            }
            assert!(!diagnostics.to_string().chars().any(|c| c.is_control() && c != '\n'), "{text:?}");
            diagnostics.render(true);
            serde_json::to_string(&diagnostics).unwrap();
        }
    }
}

#[derive(Clone, Debug)]
enum Edit {
    Delete(f64, usize),
    Duplicate(f64, usize, f64),
    Insert(f64, usize),
    SwapTokens(usize, usize),
    DeleteLine(usize),
    SwapLines(usize, usize),
}

fn edit() -> impl Strategy<Value = Edit> {
    prop_oneof![
        (0.0..1.0, 1usize..40).prop_map(|(a, n)| Edit::Delete(a, n)),
        (0.0..1.0, 1usize..80, 0.0..1.0).prop_map(|(a, n, b)| Edit::Duplicate(a, n, b)),
        (0.0..1.0, 0..PIECES.len()).prop_map(|(a, k)| Edit::Insert(a, k)),
        (0usize..2000, 0usize..2000).prop_map(|(a, b)| Edit::SwapTokens(a, b)),
        (0usize..500).prop_map(Edit::DeleteLine),
        (0usize..500, 0usize..500).prop_map(|(a, b)| Edit::SwapLines(a, b)),
    ]
}

fn apply(text: &str, edit: &Edit) -> String {
    let at = |part: f64| text.floor_char_boundary((part * text.len() as f64) as usize);
    let chunk = |start: usize, n: usize| start..text.floor_char_boundary((start + n).min(text.len()));
    let joined = |mut parts: Vec<&str>, a: usize, b: usize, by: &str| {
        let n = parts.len().max(1);
        if !parts.is_empty() {
            parts.swap(a % n, b % n);
        }
        parts.join(by)
    };
    match *edit {
        Edit::Delete(a, n) => {
            let cut = chunk(at(a), n);
            format!("{}{}", &text[..cut.start], &text[cut.end..])
        }
        Edit::Duplicate(a, n, b) => {
            let (copy, to) = (&text[chunk(at(a), n)], at(b));
            format!("{}{copy}{}", &text[..to], &text[to..])
        }
        Edit::Insert(a, k) => format!("{}{}{}", &text[..at(a)], PIECES[k], &text[at(a)..]),
        Edit::SwapTokens(a, b) => joined(text.split(' ').collect(), a, b, " "),
        Edit::DeleteLine(k) => {
            let count = text.lines().count().max(1);
            text.lines()
                .enumerate()
                .filter(|(i, _)| *i != k % count)
                .map(|l| l.1)
                .collect::<Vec<_>>()
                .join("\n")
        }
        Edit::SwapLines(a, b) => joined(text.lines().collect(), a, b, "\n"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,300}|[\\x00-\\x7f]{0,300}") {
        survives(&text);
    }

    #[test]
    fn any_mix_of_pieces_is_read_or_refused(pieces in prop::collection::vec(0..PIECES.len(), 0..60)) {
        survives(&pieces.into_iter().map(|k| PIECES[k]).collect::<String>());
    }

    #[test]
    fn mutated_models_are_read_or_refused(which in 0..MODELS.len(), edits in prop::collection::vec(edit(), 1..6)) {
        survives(&edits.iter().fold(MODELS[which].to_owned(), |text, e| apply(&text, e)));
    }
}

#[test]
fn every_prefix_of_a_model_is_read_or_refused() {
    let text = MODELS[1];
    for end in (0..text.len()).filter(|k| text.is_char_boundary(*k)) {
        survives(&text[..end]);
    }
}

#[test]
fn every_value_in_every_place_is_read_or_refused() {
    let values =
        ["3", "-1.5", "\"\"", "\"x\"", "true", "[]", "[1]", "[1,2,3]", "[\"A\",[1,2,3]]", "{}", "{ a = 1 }"];
    for text in MODELS {
        let lines: Vec<&str> = text.lines().collect();
        for (k, line) in lines.iter().enumerate() {
            let Some((key, _)) = line.split_once(" = ") else { continue };
            for value in values {
                let changed = format!("{key} = {value}");
                let mut lines = lines.clone();
                lines[k] = &changed;
                survives(&lines.join("\n"));
            }
        }
    }
}

/// Pieces of data files, good and bad.
const FIELDS: [&str; 16] = [
    "0", "1.5", "-2e3", "nan", "1e999", "", "time", "\"", "\"a\"", ",", ";", "\t", "\n", "\r\n", "#",
    "\u{feff}",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_data_file_is_read_or_refused(
        pieces in prop::collection::vec(0..FIELDS.len(), 0..40),
        columns in prop::sample::select(vec!["[1, 2]", "[2, 1]", "[\"time\", 2]", "[1, 999999]", "[1, 1]"]),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let data: String = pieces.into_iter().map(|k| FIELDS[k]).collect();
        std::fs::write(folder.path().join("travel.csv"), data).unwrap();
        let file = format!("file = \"travel.csv\", columns = {columns}");
        let table = ("points = [[0, 0], [1, 5], [3, 2]]", file.clone());
        let target = ("[[0, 150], [1, 160]]", format!("{{ {file} }}"));
        for (model, (points, file)) in [(MODELS[6], table), (MODELS[7], target)] {
            assert!(model.contains(points));
            let path = folder.path().join("model.toml");
            std::fs::write(&path, model.replace(points, &file)).unwrap();
            if let Err(error) = hardpoint_file::read(&path) {
                assert!(!error.diagnostics().list().is_empty());
                assert!(!error.to_string().chars().any(|c| c.is_control() && c != '\n'), "{error}");
            }
        }
    }
}

#[test]
fn deep_nesting_is_refused() {
    for open in ["[", "{a=", "a.", "[[", "{ through = "] {
        survives(&format!("name = {}", open.repeat(50_000)));
        survives(&open.repeat(50_000));
    }
    survives(&format!("name = {}{}", "[".repeat(70), "]".repeat(70)));
    survives(&format!("{}a = 1", "a.".repeat(70)));
    let law = format!("drivers.d.law = \"{}t{}\"", "(".repeat(100_000), ")".repeat(100_000));
    survives(&law);
    survives(&format!("drivers.d.law = \"{}\"", "t+".repeat(100_000)));
}

/// Number of allocations while a text is read and its diagnostics are shown, and their size.
fn work(text: &str) -> [u64; 2] {
    let used = allocation_counter::measure(|| survives(text));
    [used.count_total, used.bytes_total]
}

/// Twice the entries take twice the work, with a tenth to spare. (`bench/instructions` counts instructions, of which
/// nothing can hide.)
fn grows_in_proportion(of: impl Fn(usize) -> String) {
    let [few, many] = [1000, 2000].map(|n| work(&of(n)));
    for (few, many) in few.into_iter().zip(many) {
        assert!(
            many as f64 <= 2.2 * few as f64,
            "{few} and {many}: {:.60}",
            of(1000).lines().last().unwrap()
        );
    }
}

#[test]
fn large_files_take_no_more_work_than_they_must() {
    let header = "name = \"n\"\nunits = { length = \"mm\", angle = \"deg\" }\n";
    let many = |table: &str, entry: &str, n: usize| {
        let mut text = format!("{header}[{table}]\n");
        (0..n).for_each(|k| text.push_str(&format!("e{k} = {entry}\n")));
        text
    };
    for (table, entry) in [
        ("hardpoints", "[1, 2, 3]"),
        ("hardpoints", "\"?\""),
        ("bodies", "{}"),
        ("joints", "{ type = \"ball\", bodies = [\"a\", \"b\"], at = \"nowhere\" }"),
        ("nonsense", "1"),
        ("design", "{ move = \"A\", along = \"xyz\" }"),
        ("optimize.goals", "{ weight = 2 }"),
        ("tolerance.variables", "{ tolerance = 1, cost = 2 }"),
        ("tolerance.correlations", "{ between = [\"A_x\", \"A_y\"], coefficient = 0.5 }"),
        ("tolerance.limits", "{ metric = \"m\", max = 1 }"),
        ("sweep.variables", "{ from = -1, to = 1, levels = 3 }"),
        ("designs", "{ A_x = 1, A_y = 2 }"),
        ("designs.d", "1"),
        ("optimize.limits", "{ hardpoint = \"A\", x = [2, 1], z = { max = 1 } }"),
    ] {
        grows_in_proportion(|n| many(table, entry, n));
        survives(&many(table, entry, 8000));
    }
    let law = |of: &str| survives(&format!("{header}[drivers]\nd = {{ joint = \"J\", law = {{ {of} }} }}\n"));
    let many_of = |one: &str, n: usize| vec![one; n].join(", ");
    for n in [500, 10_000] {
        survives(&many("couplers", "{ type = \"gear\", joints = [\"a\", \"b\"], teeth = [1, 2] }", n));
        survives(&many(
            "drivers",
            "{ point = \"p\", along = \"z\", law = { type = \"polynomial\", coefficients = [1] } }",
            n,
        ));
        survives(&many("cases", "{ laws = { turn = \"t\" } }", n));
        let names: Vec<String> = (0..n).map(|k| format!("\"v{k}\"")).collect();
        survives(&format!("{header}[optimize]\nvariables = [{}]\n", names.join(", ")));
        survives(&many("design", "{ driver = \"d\", parameter = \"amplitude\" }", n));
        law(&format!("type = \"polynomial\", coefficients = [{}]", many_of("1", n)));
        law(&format!("type = \"sequence\", pieces = [{}]", many_of("{ duration = 1, law = \"t\" }", n)));
        let points: Vec<String> = (0..n).map(|k| format!("[{k}, 0]")).collect();
        law(&format!(
            "type = \"table\", spline = \"quintic\", ends = \"periodic\", points = [{}]",
            points.join(", ")
        ));
        let parameters: Vec<String> = (0..n).map(|k| format!("p{k} = 1")).collect();
        law(&format!("type = \"expression\", law = \"p1*t\", parameters = {{ {} }}", parameters.join(", ")));
    }
    let mut nested = "\"t\"".to_owned();
    for _ in 0..20 {
        nested = format!(
            "{{ type = \"sequence\", pieces = [{{ duration = 1, law = 1 }}, {{ duration = 1, law = {nested} }}] }}"
        );
    }
    survives(&format!("{header}[drivers]\nd = {{ joint = \"J\", law = {nested} }}\n"));
    let (mut names, mut points) = (String::new(), String::new());
    for k in 0..2000 {
        names.push_str(&format!("{}{k:05} = [{k}, 0, 0]\n", "a".repeat(90)));
        points.push_str(&format!("p{k} = {{ body = \"?\", at = \"{}{k:05}xx\" }}\n", "a".repeat(90)));
    }
    survives(&format!("{header}[hardpoints]\n{names}[points]\n{points}"));
    survives(&format!("{header}time = {{ end = 1, steps = 1000001 }}"));
    survives(&format!("{header}{} = 1", "k".repeat(5_000_000)));
    survives(&format!("{header}[hardpoints]\n\"{}\" = [0, 0, 0]", "k".repeat(5_000_000)));
    survives(&format!("{header}joints.J = {{ type = \"{}\" }}", "revolute".repeat(500_000)));
    survives(&(0..100_000).map(|k| format!("k{k} = 1\n")).collect::<String>());
}

/// The ranges of all values in a value; of a table that headers or dotted keys make, only those of what is in it.
fn ranges_of(text: &str, value: &DeValue<'_>, found: &mut Vec<std::ops::Range<usize>>) {
    let mut add = |value: &toml::Spanned<DeValue<'_>>| {
        if !value.get_ref().is_table() || text[value.span()].starts_with('{') {
            found.push(value.span());
        }
        ranges_of(text, value.get_ref(), found);
    };
    match value {
        DeValue::Table(table) => table.iter().for_each(|(_, value)| add(value)),
        DeValue::Array(list) => list.iter().for_each(add),
        _ => {}
    }
}

/// An entry that cannot be read is reported, and none of the consequences.
#[test]
fn a_value_that_cannot_be_read_is_one_mistake() {
    let wheels = include_str!("../../../../models/front_axle.toml");
    let (mut tried, mut more) = (0, Vec::new());
    for text in MODELS.into_iter().chain([wheels]) {
        let mut ranges = Vec::new();
        ranges_of(text, &DeValue::Table(DeTable::parse(text).unwrap().into_inner()), &mut ranges);
        for range in ranges {
            // No key takes a date.
            let broken = format!("{}1979-05-27{}", &text[..range.start], &text[range.end..]);
            let Err(found) = parse(&broken, "broken.toml") else { panic!("read: {}", &text[range]) };
            if found.list().len() != 1 {
                more.push(format!("in place of `{}`:\n{found}", &text[range]));
            }
            tried += 1;
        }
    }
    assert!(more.is_empty() && tried > 1000, "{} of {tried}:\n{}", more.len(), more.join("\n"));
}

/// A name that no entry has is reported where it is written, and none of the consequences.
#[test]
fn a_misspelt_name_is_one_mistake() {
    let models = [
        include_str!("../../../../models/front_axle.toml"),
        include_str!("../../../../models/stewart.toml"),
        include_str!("../../../../models/gear_train.toml"),
        include_str!("../../../hardpoint-cli/templates/k-and-c.toml"),
        include_str!("../../../hardpoint-cli/templates/delta.toml"),
        include_str!("../../../hardpoint-cli/templates/solid-axle.toml"),
        MEASURES_OF_DRIVERS,
    ];
    let (mut tried, mut more) = (0, Vec::new());
    for text in MODELS.into_iter().chain(models) {
        parse(text, "sound.toml").unwrap_or_else(|e| panic!("{e}"));
        let document = DeTable::parse(text).unwrap().into_inner();
        let tables = document.iter().filter_map(|(_, value)| value.get_ref().as_table());
        let names: BTreeSet<&str> =
            tables.flat_map(|table| table.keys()).map(|k| k.get_ref().as_ref()).collect();
        let mut ranges = Vec::new();
        ranges_of(text, &DeValue::Table(document.clone()), &mut ranges);
        for range in ranges {
            let name = text[range.clone()].trim_matches('"');
            // Other words of a mirror make other images.
            if text[..range.start].lines().last().is_some_and(|line| line.starts_with("names = {")) {
                continue;
            }
            let is_name = |name: &str| names.contains(name);
            let owner = name.rsplit_once('.').map(|(owner, _)| owner);
            if name.len() + 2 != range.len() || !is_name(name) && !owner.is_some_and(is_name) {
                continue;
            }
            let misspelt = match owner.filter(|owner| is_name(owner)) {
                Some(owner) => name.replacen(owner, &format!("{owner}q"), 1),
                None => format!("{name}q"),
            };
            let broken = format!("{}\"{misspelt}\"{}", &text[..range.start], &text[range.end..]);
            // The name of the model, or of a design, may be any.
            let Err(found) = parse(&broken, "broken.toml") else { continue };
            if found.list().len() != 1 {
                more.push(format!("`{misspelt}` in place of `{name}`:\n{found}"));
            }
            tried += 1;
        }
    }
    assert!(more.is_empty() && tried > 500, "{} of {tried}:\n{}", more.len(), more.join("\n"));
}

/// Whatever names drivers, or depends on the quantities of several.
const MEASURES_OF_DRIVERS: &str = r#"
name = "names of drivers"
units = { length = "mm", angle = "deg" }
gravity = { along = "-z" }
hardpoints = { O = [0, 0, 0] }
bodies = { b = {}, c = {}, d = {} }
masses.m = { type = "rigid", centre = "p", mass = 1 }
points.p = { body = "d", at = [10, 20, 30] }
[joints]
hinge = { type = "revolute", bodies = ["ground", "b"], at = "O", axis = "x" }
swivel = { type = "revolute", bodies = ["b", "c"], at = "O", axis = "z" }
slide = { type = "translational", bodies = ["c", "d"], at = "O", axis = "z" }
[drivers]
one = { joint = "hinge", law = "5*t" }
two = { joint = "swivel", law = { type = "harmonic", amplitude = 5, frequency = 1 } }
three = { joint = "slide", law = "0.1*t" }
[measures]
turn = { type = "coordinate", joint = "hinge" }
s = { type = "slope", of = "p.x", over = "p.y", driver = "one", together = ["two"] }
o = { type = "slope", of = "p.x", over = "turn", driver = "two", opposed = ["one"] }
per_s = { type = "expression", expression = "2*s + o" }
jacobian = { type = "dexterity", points = ["p"], drivers = ["one", "two"] }
all = { type = "expression", expression = "jacobian^2" }
force = { type = "driver_force", driver = "three" }
power = { type = "driver_power", driver = "two" }
work = { type = "expression", expression = "force*turn" }
[metrics]
end = { of = "per_s", over = "turn", take = "value", at = 1 }
most = { of = "work", over = "turn", take = "max" }
[design]
rate = { driver = "two", parameter = "amplitude" }
O_z = { move = "O", along = "z", bounds = [-1, 1] }
[cases]
up = { laws = { one = "t", three = "2*t" } }
still = { laws = { two = "3*t" }, other_drivers = "as_in_model" }
chart = { grid = { one = { from = -1, to = 1, steps = 2 }, two = { from = -1, to = 1, steps = 2 } } }
[page]
plots = [{ y = ["s", "jacobian"], over = "turn" }, { y = ["work"] }]
[optimize]
variables = ["O_z"]
goals = { end = { target = 1 } }
[time]
end = 1
steps = 4
"#;

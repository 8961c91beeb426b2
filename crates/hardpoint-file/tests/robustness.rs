//! No text makes the reader panic or hang, and every diagnostic can be shown.

use std::time::{Duration, Instant};

use hardpoint_file::parse;
use proptest::prelude::*;

const MODELS: [&str; 5] = [
    include_str!("../../../models/macpherson.toml"),
    include_str!("../../../models/slider_crank.toml"),
    include_str!("../../../models/rssr.toml"),
    include_str!("../../../models/hooke.toml"),
    include_str!("../../../models/double_wishbone.toml"),
];

/// Pieces that make a broken file interesting.
const PIECES: [&str; 32] = [
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
];

/// Far more than any of these texts needs, even on a slow and busy machine.
const LIMIT: Duration = Duration::from_secs(20);

fn survives(text: &str) {
    let start = Instant::now();
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
    assert!(start.elapsed() < LIMIT, "took {:?}", start.elapsed());
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

#[test]
fn large_files_take_no_longer_than_they_must() {
    let header = "name = \"n\"\nunits = { length = \"mm\", angle = \"deg\" }\n";
    let many = |table: &str, entry: &str, n: usize| {
        let mut text = format!("{header}[{table}]\n");
        (0..n).for_each(|k| text.push_str(&format!("e{k} = {entry}\n")));
        text
    };
    for n in [4000, 200_000] {
        survives(&many("hardpoints", "[1, 2, 3]", n));
        survives(&many("hardpoints", "\"?\"", n));
        survives(&many("bodies", "{}", n));
        survives(&many("joints", "{ type = \"ball\", bodies = [\"a\", \"b\"], at = \"nowhere\" }", n));
        survives(&many("nonsense", "1", n));
        survives(&many("design", "{ move = \"A\", along = \"xyz\" }", n));
    }
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

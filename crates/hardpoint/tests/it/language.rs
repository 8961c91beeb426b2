//! Language of the code and the documents: patterns that an engineer would not write, counted per room.
//!
//! The ceilings in `language.csv` only fall. After a change that lowers a count, `UPDATE_LANGUAGE=1 cargo test -p hardpoint language`
//! writes the new ceilings. This is a ratchet, not a grammar: a word of the list that is right in its sentence stays.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// First words of a doc comment that make it a clause instead of a noun phrase or a verb in the third person.
const BEGINNINGS: [&str; 9] = ["What", "How", "Whether", "Where", "Its", "Of", "So", "Which", "Why"];

/// Words of the former dialect, lower case. Their replacements are in `docs/glossary.md`.
const DIALECT: [&str; 26] = [
    "a design found",
    "abreast",
    "as drawn",
    "as many",
    "as much",
    "asked for",
    "cannot say",
    "come to",
    "comes to",
    "foresee",
    "foreseen",
    "foreseeing",
    "prediction_quality",
    "give way",
    "gives way",
    "go by",
    "goes by",
    "presses",
    "rubs",
    "so many",
    "square to",
    "stands",
    "tells",
    "that there is",
    "told",
    "what binds",
];

/// Names of types that are participles. All others that end so are nouns.
const PARTICIPLES: [&str; 10] =
    ["Drawn", "Found", "Given", "Held", "Kept", "Known", "Shown", "Taken", "Told", "Written"];
const NOUNS: [&str; 14] = [
    "Bearing",
    "Bushing",
    "Closing",
    "Drawing",
    "Gathering",
    "Heading",
    "Need",
    "Ranking",
    "Reading",
    "Recording",
    "Sampling",
    "Setting",
    "Sibling",
    "Spring",
];

/// Longest line of prose, in characters, and longest cell of a Markdown table.
const LINE: usize = 120;
const CELL: usize = 160;

#[derive(Clone, Copy, Default, PartialEq)]
struct Counts {
    comments: usize,
    beginnings: usize,
    dialect: usize,
    long: usize,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// Files with one of these endings below a folder; without what tools have written there.
fn files(folder: &Path, endings: &[&str], found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        // A link to a folder leads to files that are counted there.
        if path.is_dir() {
            if !path.is_symlink()
                && !["target", "node_modules", "dist", "page", "snapshots", "images"].contains(&name)
                && !name.starts_with('.')
            {
                files(&path, endings, found);
            }
        } else if endings.iter().any(|e| name.ends_with(e)) && !["payload.ts", "protocol.ts"].contains(&name)
        {
            found.push(path);
        }
    }
}

/// Rooms with their files: every folder of the core, every other crate, the Python package, the page, the documents.
fn rooms() -> BTreeMap<String, Vec<PathBuf>> {
    let root = root();
    let mut all = Vec::new();
    for folder in ["crates", "python", "web", "docs"] {
        files(&root.join(folder), &[".rs", ".py", ".ts", ".md"], &mut all);
    }
    for document in ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"] {
        all.push(root.join(document));
    }
    let mut rooms: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for path in all {
        let inside = path.strip_prefix(&root).unwrap();
        let parts: Vec<&str> = inside.iter().map(|p| p.to_str().unwrap()).collect();
        let room = match parts[..] {
            // This file lists the words.
            [.., "language.rs"] => continue,
            ["crates", "hardpoint", "src", room, _, ..] => format!("core/{room}"),
            ["crates", "hardpoint", "src", _] => "core".to_owned(),
            ["crates", name, "tests", ..] => format!("{name}/tests"),
            ["crates", name, ..] => name.to_owned(),
            [_] => "docs".to_owned(),
            [folder, ..] => folder.to_owned(),
            [] => unreachable!("a file has a name"),
        };
        rooms.entry(room).or_default().push(path);
    }
    rooms
}

fn is_letter(c: Option<char>) -> bool {
    c.is_some_and(char::is_alphanumeric)
}

/// Number of whole-word occurrences.
fn occurrences(line: &str, word: &str) -> usize {
    let is_whole = |at: usize| {
        !is_letter(line[..at].chars().next_back()) && !is_letter(line[at + word.len()..].chars().next())
    };
    line.match_indices(word).filter(|(at, _)| is_whole(*at)).count()
}

fn dialect(line: &str) -> usize {
    let lower = line.to_lowercase();
    DIALECT.iter().map(|word| occurrences(&lower, word)).sum()
}

fn count_document(text: &str) -> Counts {
    let (mut counts, mut in_code) = (Counts::default(), false);
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
        }
        if in_code {
            continue;
        }
        counts.comments += 1;
        counts.dialect += dialect(line);
        let is_too_long = if line.starts_with('|') {
            line.split(" | ").any(|cell| cell.chars().count() > CELL)
        } else {
            !line.starts_with("    ") && line.chars().count() > LINE
        };
        counts.long += usize::from(is_too_long);
    }
    counts
}

/// The text of a comment line, and whether it documents an item.
fn comment(line: &str) -> Option<(&str, bool)> {
    let line = line.trim_start();
    for (start, documents) in
        [("///", true), ("//!", true), ("/**", true), ("//", false), ("*", true), ("#", false)]
    {
        if let Some(text) = line.strip_prefix(start) {
            return Some((text.trim(), documents));
        }
    }
    None
}

/// Counts of a source. `rustfmt` breaks the code of Rust, but nothing breaks the texts of the page.
fn count_source(text: &str, is_page: bool) -> Counts {
    let (mut counts, mut before) = (Counts::default(), false);
    for line in text.lines() {
        counts.dialect += dialect(line);
        let comment = comment(line);
        counts.long += usize::from((is_page || comment.is_some()) && line.chars().count() > LINE);
        let Some((text, documents)) = comment else {
            before = false;
            continue;
        };
        if documents && !before && !text.is_empty() {
            counts.comments += 1;
            let first = text.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
            counts.beginnings += usize::from(BEGINNINGS.contains(&first));
        }
        before = documents && !text.is_empty();
    }
    counts
}

fn counted() -> BTreeMap<String, Counts> {
    let mut out = BTreeMap::new();
    for (room, files) in rooms() {
        let sum: &mut Counts = out.entry(room).or_default();
        for path in files {
            let text = std::fs::read_to_string(&path).unwrap();
            let is_document = path.extension().is_some_and(|e| e == "md");
            let is_page = path.starts_with(root().join("web/src"));
            let found = if is_document { count_document(&text) } else { count_source(&text, is_page) };
            sum.comments += found.comments;
            sum.beginnings += found.beginnings;
            sum.dialect += found.dialect;
            sum.long += found.long;
        }
    }
    out
}

const HEAD: &str =
    "room,clauses at the beginning of doc comments,words of the dialect,lines or cells that are too long";

#[test]
fn the_dialect_only_recedes() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/language.csv");
    let counted = counted();
    let row = |room: &str, c: &Counts| format!("{room},{},{},{}", c.beginnings, c.dialect, c.long);
    if std::env::var_os("UPDATE_LANGUAGE").is_some() {
        let rows: Vec<String> = counted.iter().map(|(room, c)| row(room, c)).collect();
        std::fs::write(&path, format!("{HEAD}\n{}\n", rows.join("\n"))).unwrap();
        return;
    }
    let ceilings = std::fs::read_to_string(&path).unwrap();
    let mut faults = Vec::new();
    for (room, c) in &counted {
        let ceiling = ceilings.lines().find_map(|l| l.strip_prefix(&format!("{room},")));
        let ceiling: Vec<usize> =
            ceiling.map_or(vec![0; 3], |l| l.split(',').map(|n| n.parse().unwrap()).collect());
        let found = [c.beginnings, c.dialect, c.long];
        for (k, name) in ["clauses", "words of the dialect", "long lines"].iter().enumerate() {
            if found[k] > ceiling[k] {
                faults.push(format!("{room}: {} {name}, at most {} are allowed", found[k], ceiling[k]));
            }
        }
    }
    assert!(faults.is_empty(), "write them as `docs/glossary.md` does:\n{}", faults.join("\n"));
    let all: usize = counted.values().map(|c| c.comments).sum();
    let clauses: usize = counted.values().map(|c| c.beginnings).sum();
    assert!(
        all > 5000 && 50 * clauses < all,
        "{clauses} of {all} doc comments begin with a clause: above 2 %"
    );
}

#[test]
fn no_public_type_is_named_by_a_participle() {
    let mut found = Vec::new();
    for path in rooms().into_values().flatten().filter(|p| p.extension().is_some_and(|e| e == "rs")) {
        let text = std::fs::read_to_string(&path).unwrap();
        for line in text.lines() {
            let words: Vec<&str> =
                line.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|w| !w.is_empty()).collect();
            let ["pub", "struct" | "enum" | "trait" | "type", name, ..] = words[..] else { continue };
            let is_one_word = name.chars().filter(|c| c.is_uppercase()).count() == 1;
            let is_participle = PARTICIPLES.contains(&name)
                || (name.ends_with("ed") || name.ends_with("ing")) && !NOUNS.contains(&name);
            if is_one_word && is_participle {
                found.push(format!("{name} in {}", path.display()));
            }
        }
    }
    assert!(found.is_empty(), "types are named by nouns: {found:?}");
}

//! Counts of production code that only fall, by room of the core or by crate.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::code::{Source, below, exports, indent, length_of_item, production, uses};

/// Counts, and advice where there is more.
const COUNTED: [(&str, &str); 6] = [
    ("functions of over 60 lines", "give the parts of the function names"),
    ("functions of over 100 lines", "give the parts of the function names"),
    ("modules in circles", "move what the modules share into one of its own"),
    ("lines of code in `mod.rs`", "write into a file of its own, and re-export"),
    ("patterns for some measures only", "use a property of the measures"),
    ("wildcards over closed enums", "name the types, or use a property of them"),
];

/// Ceilings of the first five counts; zero for rooms and counts that are not listed.
const CEILINGS: &[(&str, [usize; 5])] = &[
    ("clearance", [2, 0, 0, 0, 0]),
    ("draft", [11, 0, 0, 0, 5]),
    ("equilibrium", [1, 0, 0, 0, 0]),
    ("expression", [1, 0, 0, 0, 0]),
    ("hardpoint-cli", [14, 0, 14, 0, 0]),
    ("hardpoint-export", [4, 0, 0, 0, 0]),
    ("hardpoint-file", [11, 0, 0, 0, 0]),
    ("hardpoint-import", [34, 0, 10, 0, 0]),
    ("hardpoint-report", [10, 0, 5, 0, 3]),
    ("hardpoint-study", [13, 0, 2, 0, 0]),
    ("hardpoint-tape", [3, 0, 0, 0, 0]),
    ("joint", [1, 0, 0, 0, 0]),
    ("law", [1, 0, 0, 0, 0]),
    ("load", [0, 0, 0, 0, 6]),
    ("measure", [6, 0, 0, 0, 6]),
    ("model", [0, 0, 0, 0, 1]),
    ("motion", [7, 0, 0, 0, 0]),
    ("number", [0, 0, 2, 0, 0]),
    ("python", [1, 0, 2, 0, 0]),
    ("run", [9, 0, 2, 0, 2]),
    ("sensitivity", [1, 0, 0, 0, 0]),
    ("topology", [2, 0, 0, 0, 0]),
];

/// Enums whose matches name every variant.
const CLOSED: [&str; 7] = [
    "ElementKind",
    "ElementKindDraft",
    "MeasureKind",
    "MeasureKindDraft",
    "Reduction",
    "CurvePart",
    "StopKind",
];

/// Names that a count has found, with their shares of it.
type Found = Vec<(String, usize)>;

#[test]
fn counts_of_the_house_only_fall() {
    let mut faults = Vec::new();
    let rooms = rooms();
    assert!(rooms.len() > 30, "only {} rooms found", rooms.len());
    for (room, files) in &rooms {
        let ceilings =
            CEILINGS.iter().find(|(name, _)| name == room).map_or([0; 5], |(_, ceilings)| *ceilings);
        for (k, ((name, advice), found)) in COUNTED.iter().zip(counts(files)).enumerate() {
            let (count, ceiling) =
                (found.iter().map(|(_, share)| share).sum::<usize>(), ceilings.get(k).copied().unwrap_or(0));
            if count > ceiling {
                faults.push(format!("{room}: {count} {name}, at most {ceiling}: {advice}; found {found:?}"));
            } else if count < ceiling {
                faults.push(format!("{room}: {count} {name}: lower {ceiling} in CEILINGS to that"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Production code by room of the core, or by crate.
fn rooms() -> BTreeMap<String, Vec<Source>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let crates = std::fs::read_dir(root.join("crates")).unwrap().map(|entry| entry.unwrap().path());
    let mut rooms = BTreeMap::<String, Vec<Source>>::new();
    for folder in crates.chain([root.join("python")]) {
        let name = folder.file_name().unwrap().to_str().unwrap();
        for file in production(&folder.join("src")) {
            let first = file.module.split("::").next().unwrap();
            let room = if name == "hardpoint" && !first.is_empty() { first } else { name };
            rooms.entry(room.to_owned()).or_default().push(file);
        }
    }
    rooms
}

fn counts(files: &[Source]) -> [Found; COUNTED.len()] {
    let in_files = |count: &dyn Fn(&Source) -> usize| -> Found {
        files.iter().map(|file| (file.name.clone(), count(file))).filter(|(_, share)| *share > 0).collect()
    };
    [
        long_functions(files, 60),
        long_functions(files, 100),
        circles(files),
        in_files(&code_of_a_door),
        in_files(&|file| {
            wildcards(&file.code, "MeasureKind")[1] + wildcards(&file.code, "MeasureKindDraft")[1]
        }),
        in_files(&|file| {
            let elements = CLOSED[..2].iter().map(|of| wildcards(&file.code, of)[1]);
            CLOSED.iter().map(|of| wildcards(&file.code, of)[0]).chain(elements).sum()
        }),
    ]
}

fn long_functions(files: &[Source], limit: usize) -> Found {
    let words = ["const", "unsafe", "async", "extern", "\"C\""];
    let mut found = Vec::new();
    for file in files {
        let lines: Vec<&str> = file.code.lines().collect();
        for (k, line) in lines.iter().enumerate() {
            let Some((before, name)) = line.split_once("fn ") else { continue };
            if before.split_whitespace().all(|word| word.starts_with("pub") || words.contains(&word))
                && length_of_item(&lines[k..]) > limit
            {
                found.push((format!("{} {}", file.name, name.split(['(', '<']).next().unwrap()), 1));
            }
        }
    }
    found
}

/// Modules of one folder that use one another in the end. A folder is one module for its neighbours; its own `mod.rs`
/// is left out, and its re-exports are followed.
fn circles(files: &[Source]) -> Found {
    let parent = |path: &str| path.rsplit_once("::").map_or("", |(parent, _)| parent).to_owned();
    let folders: BTreeSet<String> = files
        .iter()
        .flat_map(|file| {
            std::iter::successors(Some(parent(&file.module)), |path| (!path.is_empty()).then(|| parent(path)))
        })
        .collect();
    let used: Vec<Vec<String>> = files.iter().map(uses).collect();
    let mut found = Vec::new();
    for folder in &folders {
        let child =
            |path| Some(below(path, folder)?.split("::").next().unwrap()).filter(|name| !name.is_empty());
        let mut graph: BTreeMap<&str, BTreeSet<&str>> =
            files.iter().filter_map(|file| Some((child(&file.module)?, BTreeSet::new()))).collect();
        let doors = files.iter().filter(|file| file.module == **folder);
        let exported: Vec<String> = doors.flat_map(exports).collect();
        let modules: Vec<&str> = graph.keys().copied().collect();
        let module = |name| {
            let of_export =
                || exported.iter().find(|path| path.ends_with(&format!("::{name}")))?.split("::").next();
            modules.iter().find(|m| **m == name).copied().or_else(of_export).filter(|m| modules.contains(m))
        };
        for (file, used) in files.iter().zip(&used) {
            let Some(user) = child(&file.module) else { continue };
            let used = used.iter().filter_map(|path| module(child(path)?)).filter(|used| *used != user);
            graph.get_mut(user).unwrap().extend(used);
        }
        found.extend(
            modules
                .iter()
                .filter(|m| reached(&graph, m).contains(*m))
                .map(|m| (format!("{folder}::{m}").trim_start_matches(':').to_owned(), 1)),
        );
    }
    found
}

/// All that a module uses, directly or through others.
fn reached<'t>(graph: &BTreeMap<&str, BTreeSet<&'t str>>, from: &'t str) -> BTreeSet<&'t str> {
    let (mut seen, mut next) = (BTreeSet::new(), vec![from]);
    while let Some(module) = next.pop() {
        next.extend(graph[module].iter().filter(|used| seen.insert(**used)));
    }
    seen
}

/// Lines of a `mod.rs` other than modules, uses and attributes.
fn code_of_a_door(file: &Source) -> usize {
    let lines: Vec<&str> = file.code.lines().filter(|line| !line.is_empty()).collect();
    let (mut count, mut k) = (0, 0);
    while k < lines.len() && file.name.ends_with("/mod.rs") {
        let mut words = lines[k].split(' ').filter(|word| !word.starts_with("pub"));
        let is_listing = words.next().is_some_and(|word| ["use", "mod"].contains(&word));
        let length = if is_listing { length_of_item(&lines[k..]) } else { 1 };
        count += usize::from(!is_listing && !lines[k].trim_start().starts_with('#'));
        k += length;
    }
    count
}

/// Wildcards over an enum: arms `_` of matches, and patterns for some variants only (`let`, `matches!`).
fn wildcards(code: &str, of: &str) -> [usize; 2] {
    let lines: Vec<&str> = code.lines().collect();
    let (mut is_own, mut arms, mut patterns) = (false, 0, 0);
    for (k, line) in lines.iter().enumerate() {
        if line.starts_with("impl") {
            is_own = line.trim_end_matches([' ', '{']).ends_with(&format!(" {of}"));
        }
        let names_variant =
            |pattern: &str| pattern.contains(&format!("{of}::")) || is_own && pattern.contains("Self::");
        if ["_ =>", "_ if "].iter().any(|arm| line.trim_start().starts_with(arm)) {
            // The other arms of this match have the same indentation, and its head less.
            let others = lines[..k].iter().rev().take_while(|l| l.is_empty() || indent(l) >= indent(line));
            let mut others = others.filter(|l| indent(l) == indent(line));
            arms += usize::from(others.any(|l| names_variant(l.split("=>").next().unwrap())));
        } else if let Some((_, pattern)) = line.split_once("matches!(") {
            let more = lines[k + 1..].iter().take_while(|l| pattern.is_empty() && indent(l) > indent(line));
            patterns += usize::from(names_variant(pattern) || more.into_iter().any(|l| names_variant(l)));
        } else if let Some((_, pattern)) = line.split_once("let ") {
            patterns += usize::from(names_variant(pattern.split(" = ").next().unwrap()));
        }
    }
    [arms, patterns]
}

#[test]
fn wildcards_over_types_are_counted() {
    let text = "impl Model {
    fn dimension(&self) {
        match kind {
            MeasureKind::Angle { .. } => 1,
            _ => 0,
        }
        let MeasureKind::Angle { .. } = kind else { return };
        matches!(
            kind,
            MeasureKind::Angle { .. }
        )
    }
}
";
    assert_eq!(wildcards(text, "MeasureKind"), [1, 2]);
    assert_eq!(wildcards(text, "ElementKind"), [0, 0]);
    assert_eq!(wildcards(&text.replace("            _ => 0,\n", ""), "MeasureKind"), [0, 2]);
    let own = text.replace("Model", "MeasureKind").replace("MeasureKind::", "Self::");
    assert_eq!(wildcards(&own, "MeasureKind"), [1, 2]);
}

#[test]
fn circles_are_found_through_folders_and_exports() {
    let source = |(module, code): (&str, &str)| Source {
        name: String::new(),
        module: module.into(),
        code: code.into(),
    };
    let files = [
        ("a", "mod b;\npub use b::B;\n"),
        ("a::b", "use super::{c::C};\n"),
        ("a::c", "use super::B;\nuse super::d::D;\n"),
        ("a::c::e", "use super::super::d::D;\nuse crate::f;\n"),
        ("a::d", ""),
        ("f", "use crate::{\n    a::{B, d},\n};\n"),
    ]
    .map(source);
    let names: Vec<String> = circles(&files).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["a", "f", "a::b", "a::c"]);
}

//! The directions that data and dependencies may flow in (`ARCHITECTURE.md`), checked in the sources.

use std::path::{Path, PathBuf};

/// The rooms of the core, in the order of the walk: each may use those before it only. What somebody wrote (`draft`)
/// knows the model that it means, and so comes after it; results are kept in `blocks`.
const ROOMS: [&str; 20] = [
    "number",
    "linalg",
    "space",
    "expression",
    "law",
    "constraint",
    "joint",
    "model",
    "design",
    "draft",
    "topology",
    "blocks",
    "motion",
    "sensitivity",
    "clearance",
    "measure",
    "load",
    "element",
    "equilibrium",
    "run",
];

/// The rooms of the crate that reads model files: values of a text, one table from several texts, its sections,
/// files written, and the language for editors.
const ROOMS_OF_FILES: [&str; 5] = ["values", "compose", "read", "write", "language"];

/// Crates with rooms, by the paths of their sources, and the minimum number of files there.
const HOUSES: [(&str, &[&str], usize); 2] =
    [("src", &ROOMS, 40), ("../hardpoint-file/src", &ROOMS_OF_FILES, 35)];

/// Own crates that each crate may depend on. Tests may use any.
const CRATES: &[(&str, &[&str])] = &[
    ("hardpoint-tape", &[]),
    ("hardpoint-code", &["hardpoint-tape"]),
    ("hardpoint", &["hardpoint-tape", "hardpoint-code"]),
    ("hardpoint-search", &["hardpoint"]),
    ("hardpoint-planar", &["hardpoint", "hardpoint-search"]),
    ("hardpoint-study", &["hardpoint", "hardpoint-planar", "hardpoint-search", "hardpoint-tape"]),
    ("hardpoint-table", &["hardpoint"]),
    ("hardpoint-file", &["hardpoint", "hardpoint-table"]),
    ("hardpoint-report", &["hardpoint", "hardpoint-file", "hardpoint-study", "hardpoint-table"]),
    ("hardpoint-import", &["hardpoint", "hardpoint-file"]),
    (
        "hardpoint-export",
        &["hardpoint", "hardpoint-file", "hardpoint-report", "hardpoint-table", "hardpoint-tape"],
    ),
    (
        "hardpoint-cli",
        &[
            "hardpoint",
            "hardpoint-file",
            "hardpoint-export",
            "hardpoint-import",
            "hardpoint-report",
            "hardpoint-study",
            "hardpoint-table",
        ],
    ),
    ("hardpoint-engine", &["hardpoint-studio"]),
    ("hardpoint-bench", &["hardpoint", "hardpoint-file"]),
    ("hardpoint-shared", &[]),
    (
        "hardpoint-python",
        &[
            "hardpoint",
            "hardpoint-cli",
            "hardpoint-file",
            "hardpoint-report",
            "hardpoint-shared",
            "hardpoint-study",
        ],
    ),
    ("hardpoint-studio", &["hardpoint", "hardpoint-file", "hardpoint-report", "hardpoint-study"]),
];

fn sources(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut out = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            out.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            out.push((path, text));
        }
    }
    out
}

/// True if a line names a room, in a path or in braces: `crate::{model::Model, run::Analysis}`.
fn mentions(line: &str, room: &str) -> bool {
    let braces = line.trim_start().starts_with("use crate::{") || line.contains(" use crate::{");
    line.contains(&format!("crate::{room}::"))
        || line.contains(&format!("crate::{room};"))
        || braces
            && [
                format!("{{{room}::"),
                format!(" {room}::"),
                format!("{{{room},"),
                format!(" {room},"),
                format!(" {room}}}"),
            ]
            .iter()
            .any(|w| line.contains(w.as_str()))
}

#[test]
fn no_room_uses_a_later_one() {
    for (src, rooms, minimum) in HOUSES {
        let src = Path::new(env!("CARGO_MANIFEST_DIR")).join(src);
        let mut looked_at = 0;
        for (path, text) in sources(&src) {
            let inside = path.strip_prefix(&src).unwrap();
            let first = inside.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs");
            if first == "lib" {
                continue;
            }
            let room = rooms.iter().position(|r| *r == first);
            let room =
                room.unwrap_or_else(|| panic!("{} is in no room: add it to its list", inside.display()));
            looked_at += 1;
            // Tests of a room may use all of the house.
            let (code, _) = text.split_once("#[cfg(test)]\nmod ").unwrap_or((&text, ""));
            let code = code.lines().filter(|l| !l.trim_start().starts_with("//"));
            for (later, name) in rooms.iter().enumerate().skip(room + 1) {
                let is_used = code.clone().any(|l| mentions(l, name));
                assert!(
                    !is_used,
                    "{} is in the room `{first}` and uses `{name}`, which comes later in the walk: {}",
                    inside.display(),
                    rooms[..=later].join(" -> ")
                );
            }
        }
        assert!(looked_at > minimum, "only {looked_at} files found under {}", src.display());
    }
}

/// Maximum number of patterns for some types of measures only (`let`, `matches!`), per room of the core or crate: they
/// only fall. There are none over the types of elements, and no arm `_` over either.
const MEASURE_WILDCARDS: &[(&str, usize)] = &[
    ("design", 1),
    ("draft", 6),
    ("hardpoint-report", 3),
    ("load", 7),
    ("measure", 6),
    ("model", 1),
    ("run", 2),
];

/// Number of wildcards over an enum: matches with an arm `_`, and patterns for some variants only (`let`, `matches!`).
fn wildcards(text: &str, of: &str) -> usize {
    let text = text.split("#[cfg(test)]\nmod ").next().unwrap();
    let lines: Vec<&str> = text.lines().filter(|l| !l.trim_start().starts_with("//")).collect();
    let indent = |line: &str| line.len() - line.trim_start().len();
    let (mut is_own, mut count) = (false, 0);
    for (k, line) in lines.iter().enumerate() {
        if line.starts_with("impl") {
            is_own = line.trim_end_matches([' ', '{']).ends_with(&format!(" {of}"));
        }
        let names_variant =
            |pattern: &str| pattern.contains(&format!("{of}::")) || is_own && pattern.contains("Self::");
        if ["_ =>", "_ if "].iter().any(|arm| line.trim_start().starts_with(arm)) {
            // The other arms of this match have the same indentation, and its head less.
            let arms = lines[..k].iter().rev().take_while(|l| l.is_empty() || indent(l) >= indent(line));
            let mut arms = arms.filter(|l| indent(l) == indent(line));
            count += usize::from(arms.any(|l| names_variant(l.split("=>").next().unwrap())));
        } else if let Some((_, pattern)) = line.split_once("matches!(") {
            let more = lines[k + 1..].iter().take_while(|l| pattern.is_empty() && indent(l) > indent(line));
            count += usize::from(names_variant(pattern) || more.into_iter().any(|l| names_variant(l)));
        } else if let Some((_, pattern)) = line.split_once("let ") {
            count += usize::from(names_variant(pattern.split(" = ").next().unwrap()));
        }
    }
    count
}

#[test]
fn matches_over_elements_and_measures_name_every_type() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let crates = std::fs::read_dir(root.join("crates")).unwrap().map(|entry| entry.unwrap().path());
    let mut found = std::collections::BTreeMap::<String, [usize; 2]>::new();
    for folder in crates.chain([root.join("python")]) {
        let (src, name) = (folder.join("src"), folder.file_name().unwrap().to_str().unwrap());
        for (path, text) in sources(&src) {
            let first = path.strip_prefix(&src).unwrap().iter().next().unwrap().to_str().unwrap();
            let room = if name == "hardpoint" { first.trim_end_matches(".rs") } else { name };
            let count = |of: [&str; 2]| of.map(|of| wildcards(&text, of)).iter().sum::<usize>();
            let [elements, measures] = found.entry(room.to_owned()).or_default();
            *elements += count(["ElementKind", "ElementKindDraft"]);
            *measures += count(["MeasureKind", "MeasureKindDraft"]);
        }
    }
    assert!(found.len() > 20, "only {} rooms found", found.len());
    for (room, [elements, measures]) in found {
        let most = MEASURE_WILDCARDS.iter().find(|(name, _)| *name == room).map_or(0, |(_, most)| *most);
        assert_eq!(elements, 0, "{room}: use a property of the types in place of a wildcard over elements");
        assert!(measures <= most, "{room}: {measures} wildcards over measures, at most {most} are allowed");
    }
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
    assert_eq!(wildcards(text, "MeasureKind"), 3);
    assert_eq!(wildcards(text, "ElementKind"), 0);
    assert_eq!(wildcards(&text.replace("            _ => 0,\n", ""), "MeasureKind"), 2);
    let own = text.replace("Model", "MeasureKind").replace("MeasureKind::", "Self::");
    assert_eq!(wildcards(&own, "MeasureKind"), 3);
}

/// Identifiers right after a prefix: `super::a` has one, `super::{a, b::C}` three.
fn names_after<'t>(text: &'t str, prefix: &str) -> Vec<&'t str> {
    let ends = |c: char| !c.is_alphanumeric() && c != '_';
    let each = text.split(prefix).skip(1).flat_map(|rest| match rest.strip_prefix('{') {
        Some(list) => list.split(['}', ';']).next().unwrap().split(ends).collect(),
        None => vec![rest.split(ends).next().unwrap()],
    });
    each.filter(|name| !name.is_empty()).collect()
}

/// Number of files of each room that are part of a circle: a file uses another one, which uses it again in the end.
/// Rooms without circles are not listed; the numbers only fall.
const IN_CIRCLES: [(&str, usize); 9] = [
    ("draft", 3),
    ("expression", 2),
    ("law", 6),
    ("load", 3),
    ("model", 3),
    ("number", 2),
    ("run", 3),
    ("sensitivity", 3),
    ("topology", 2),
];

#[test]
fn circles_inside_rooms_only_shrink() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    let rooms =
        HOUSES.into_iter().flat_map(|(src, rooms, _)| rooms.iter().map(move |room| (here.join(src), *room)));
    for (src, room) in rooms.filter(|(src, room)| src.join(room).is_dir()) {
        // A folder inside a room counts as one file, like the module that it is.
        let module = |path: &Path| {
            let first = path.strip_prefix(src.join(room)).unwrap().iter().next().unwrap();
            first.to_str().unwrap().trim_end_matches(".rs").to_owned()
        };
        let files: Vec<(String, String)> = sources(&src.join(room))
            .into_iter()
            .map(|(path, text)| {
                let code = text.split("#[cfg(test)]\nmod ").next().unwrap().lines();
                let code: Vec<&str> = code.filter(|l| !l.trim_start().starts_with("//")).collect();
                (module(&path), code.join("\n"))
            })
            .collect();
        let doors = files.iter().find(|(module, _)| module == "mod").map_or("", |(_, text)| text);
        // What `mod.rs` re-exports, with the module that has it.
        let exports: Vec<(&str, &str)> = doors
            .split(" use ")
            .skip(1)
            .filter_map(|line| line.split(';').next()?.split_once("::"))
            .flat_map(|(module, names)| names.split(|c: char| !c.is_alphanumeric()).map(move |n| (n, module)))
            .collect();
        let mut uses = petgraph::graph::DiGraph::<&str, ()>::new();
        let mut modules: Vec<&str> = files.iter().map(|(module, _)| module.as_str()).collect();
        modules.retain(|module| *module != "mod");
        modules.sort_unstable();
        modules.dedup();
        let nodes: Vec<_> = modules.iter().map(|module| uses.add_node(module)).collect();
        let node = |name: &str| Some(nodes[modules.iter().position(|module| *module == name)?]);
        for (module, text) in &files {
            let Some(user) = node(module) else { continue };
            let prefixes = ["super::".to_owned(), format!("crate::{room}::")];
            for name in prefixes.iter().flat_map(|prefix| names_after(text, prefix)) {
                let exported = exports.iter().find(|(n, _)| *n == name).and_then(|(_, module)| node(module));
                if let Some(used) = node(name).or(exported).filter(|used| *used != user) {
                    uses.update_edge(user, used, ());
                }
            }
        }
        let circles = petgraph::algo::tarjan_scc(&uses).into_iter().filter(|circle| circle.len() > 1);
        let count: usize = circles.map(|circle| circle.len()).sum();
        found.extend((count > 0).then_some((room, count)));
    }
    found.sort_unstable();
    assert_eq!(found, IN_CIRCLES, "fewer: write the new number; more: files use one another in a circle");
}

#[test]
fn the_core_does_no_input_or_output() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for (path, text) in sources(&src) {
        for word in ["std::fs", "std::io", "std::net", "std::env", "println!", "eprintln!"] {
            let code = text.lines().filter(|l| !l.trim_start().starts_with("//"));
            assert!(
                code.clone().all(|l| !l.contains(word)),
                "{} uses {word}: the core does no I/O",
                path.display()
            );
        }
    }
}

/// Manifests of all crates of the workspace, as `cargo metadata` lists them.
fn manifests() -> Vec<serde_json::Value> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
    let output = std::process::Command::new(cargo)
        .args(["metadata", "--no-deps", "--format-version", "1", "--offline"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo metadata runs");
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).expect("cargo metadata is JSON");
    metadata["packages"].as_array().unwrap().clone()
}

#[test]
fn crates_depend_towards_the_core_only() {
    let packages = manifests();
    for package in &packages {
        let name = package["name"].as_str().unwrap();
        let allowed = CRATES
            .iter()
            .find(|(c, _)| *c == name)
            .unwrap_or_else(|| panic!("crate `{name}` has no place in the house: add it to CRATES"))
            .1;
        let dependencies = package["dependencies"].as_array().unwrap();
        for d in dependencies.iter().filter(|d| d["kind"] != "dev") {
            let on = d["name"].as_str().unwrap();
            let ours = CRATES.iter().any(|(c, _)| *c == on);
            assert!(
                !ours || allowed.contains(&on),
                "`{name}` must not depend on `{on}`: shells use the core, not the reverse"
            );
        }
    }
    assert_eq!(packages.len(), CRATES.len());
}

/// Published crates have what a registry shows, depend on published crates only, and embed no file from outside their
/// folder.
#[test]
fn published_crates_are_complete() {
    let all = manifests();
    let is_published = |package: &serde_json::Value| package["publish"].is_null();
    let published: Vec<_> = all.iter().filter(|p| is_published(p)).collect();
    assert_eq!(published.len(), 12);
    for package in published {
        let name = package["name"].as_str().unwrap();
        let folder = Path::new(package["manifest_path"].as_str().unwrap()).parent().unwrap();
        for key in ["keywords", "categories"] {
            let count = package[key].as_array().unwrap().len();
            assert!((1..=5).contains(&count), "`{name}` has {count} {key}");
        }
        assert!(package["description"].is_string(), "`{name}` has no description");
        for file in ["README.md", "LICENSE-APACHE", "LICENSE-MIT"] {
            assert!(folder.join(file).is_file(), "`{name}` has no {file}");
        }
        for dependency in package["dependencies"].as_array().unwrap() {
            let on = all.iter().find(|p| p["name"] == dependency["name"]);
            assert!(on.is_none_or(is_published), "`{name}` depends on {}, not published", dependency["name"]);
        }
        for (path, text) in sources(&folder.join("src")) {
            let embedding = ["include_str!(\"", "include_bytes!(\""];
            for embedded in embedding.iter().flat_map(|call| text.split(call).skip(1)) {
                let Some((file, _)) = embedded.split_once("\")") else { continue };
                let Ok(file) = path.parent().unwrap().join(file).canonicalize() else { continue };
                assert!(
                    file.starts_with(folder.canonicalize().unwrap()),
                    "{} embeds {}",
                    path.display(),
                    file.display()
                );
            }
        }
    }
}

/// Every file that names the version of the next release names the same.
#[test]
fn the_version_is_the_same_everywhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let version = env!("CARGO_PKG_VERSION");
    for (file, line) in [
        ("web/engine/Cargo.toml", format!("version = \"{version}\"\n")),
        ("web/package.json", format!("\"version\": \"{version}\"")),
        ("CITATION.cff", format!("\nversion: {version}\n")),
        ("CHANGELOG.md", format!("\n## {version} (")),
    ] {
        let text = std::fs::read_to_string(root.join(file)).unwrap();
        assert!(text.contains(&line), "{file} has no version {version}");
    }
}

/// `docs/development.md` lists the direct dependencies.
#[test]
fn the_table_of_dependencies_is_complete() {
    let table = include_str!("../../../../docs/development.md");
    let table = table.split("## Direct dependencies").nth(1).unwrap().split("\n## ").next().unwrap();
    let first_cells = table.lines().filter(|l| l.starts_with("| `")).map(|l| l.split('|').nth(1).unwrap());
    let mut listed: Vec<&str> = first_cells.flat_map(|cell| cell.split('`').skip(1).step_by(2)).collect();
    let manifest = include_str!("../../../../Cargo.toml");
    let declared = manifest.split("[workspace.dependencies]").nth(1).unwrap().split("\n[").next().unwrap();
    let names = declared.lines().filter_map(|l| l.split_once(" = ")).map(|(name, _)| name);
    let mut declared: Vec<&str> = names.filter(|name| !name.starts_with("hardpoint")).collect();
    listed.sort_unstable();
    declared.sort_unstable();
    assert_eq!(listed, declared, "docs/development.md is not up to date");
}

/// The crate that may hold `unsafe`, and where in it (`docs/machine-code.md`). The page's engine only exports functions
/// by name.
#[test]
fn unsafe_code_is_only_in_the_documented_modules() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut with_lints_of_their_own = Vec::new();
    for entry in std::fs::read_dir(crates).unwrap() {
        let path = entry.unwrap().path();
        let manifest = std::fs::read_to_string(path.join("Cargo.toml")).unwrap();
        if !manifest.contains("[lints]\nworkspace = true") {
            with_lints_of_their_own.push(path.file_name().unwrap().to_str().unwrap().to_string());
        }
    }
    with_lints_of_their_own.sort();
    assert_eq!(
        with_lints_of_their_own,
        ["hardpoint-code"],
        "all others forbid `unsafe` as the workspace does"
    );

    let src = crates.join("hardpoint-code/src");
    let mut holding: Vec<String> = sources(&src)
        .into_iter()
        .filter(|(_, text)| text.lines().any(|l| l.contains("unsafe ") && !l.trim_start().starts_with("//")))
        .map(|(path, _)| path.strip_prefix(&src).unwrap().to_str().unwrap().to_string())
        .collect();
    holding.sort();
    assert_eq!(holding, ["x86_64/memory.rs", "x86_64/mod.rs"]);

    let wasm = std::fs::read_to_string(crates.join("../web/engine/src/lib.rs")).unwrap();
    assert!(!wasm.contains("unsafe {"), "the engine of the page has no block that is unsafe");
}

/// Package names and versions of a lock file.
fn locked(path: &Path) -> Vec<(String, String)> {
    let text = std::fs::read_to_string(path).unwrap();
    let value = |entry: &str, key: &str| {
        let line = entry.lines().find_map(|l| l.strip_prefix(key)).unwrap();
        line.trim_matches(['"', ' ', '=']).to_string()
    };
    text.split("[[package]]").skip(1).map(|entry| (value(entry, "name"), value(entry, "version"))).collect()
}

/// The page's engine has the dependencies of the command, so that both give the same results.
#[test]
fn the_engine_of_the_page_has_the_same_dependencies() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let all = locked(&root.join("Cargo.lock"));
    let engine = locked(&root.join("web/engine/Cargo.lock"));
    assert!(engine.len() > 50, "only {} packages in web/engine/Cargo.lock", engine.len());
    for (name, version) in engine.into_iter().filter(|(name, _)| name != "hardpoint-wasm") {
        let package = (name, version);
        assert!(
            all.contains(&package),
            "web/engine/Cargo.lock has {} {}, Cargo.lock has not: run `cp Cargo.lock web/engine/`, then `cargo metadata` in web/engine",
            package.0,
            package.1
        );
    }
}

/// Every CSV file is written by the one writer that marks texts which begin like a formula.
#[test]
fn one_writer_writes_all_csv_files() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut writing = Vec::new();
    for entry in std::fs::read_dir(crates).unwrap() {
        let folder = entry.unwrap().path().join("src");
        let files = sources(&folder).into_iter();
        let bare =
            files.filter(|(_, text)| text.contains("csv::Writer") || text.contains("WriterBuilder::new()"));
        writing.extend(bare.map(|(path, _)| path.strip_prefix(crates).unwrap().to_str().unwrap().to_owned()));
    }
    assert_eq!(writing, ["hardpoint-table/src/csv.rs"]);
}

/// The words of `docs/glossary.md` name types that there are.
#[test]
fn the_glossary_names_what_is_in_the_sources() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let glossary = std::fs::read_to_string(root.join("../../docs/glossary.md")).unwrap();
    let crates = ["src", "../hardpoint-planar/src", "../hardpoint-study/src"]
        .map(|folder| sources(&root.join(folder)));
    let all: String = crates.into_iter().flatten().map(|(_, text)| text).collect();
    let mut named = 0;
    for line in glossary.lines().filter(|l| l.starts_with("| ")) {
        let column = line.trim_end_matches([' ', '|']).rsplit('|').next().unwrap();
        for path in column.split('`').skip(1).step_by(2) {
            let name = path.rsplit("::").next().unwrap();
            let is_there = ["struct", "enum", "trait", "const", "mod"].iter().any(|word| {
                [" ", ":", "<", ";", "("].iter().any(|end| all.contains(&format!("{word} {name}{end}")))
            });
            let is_field = all.contains(&format!("    pub {name}: "));
            assert!(is_there || is_field, "docs/glossary.md names `{path}`, which is not in the sources");
            named += 1;
        }
    }
    assert!(named > 30, "only {named} types are named");
}

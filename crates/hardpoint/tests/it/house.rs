//! The directions that data and dependencies may flow in (`ARCHITECTURE.md`), checked in the sources.

mod code;
mod counts;

use std::path::{Path, PathBuf};

use self::code::{below, production, uses};

/// The rooms of the core, in the order of the walk: each may use those before it only. What somebody wrote (`draft`)
/// knows the model that it means, and so comes after it; results are kept in `blocks`.
const ROOMS: [&str; 21] = [
    "order",
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
    ("hardpoint-difference", &["hardpoint"]),
    ("hardpoint-search", &["hardpoint"]),
    ("hardpoint-planar", &["hardpoint", "hardpoint-search"]),
    (
        "hardpoint-study",
        &["hardpoint", "hardpoint-difference", "hardpoint-planar", "hardpoint-search", "hardpoint-tape"],
    ),
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
    ("hardpoint-unit", &[]),
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

#[test]
fn no_room_uses_a_later_one() {
    for (src, rooms, minimum) in HOUSES {
        let files = production(&Path::new(env!("CARGO_MANIFEST_DIR")).join(src));
        let mut looked_at = 0;
        for file in files.iter().filter(|file| !file.module.is_empty()) {
            let place = |path: &str| rooms.iter().position(|room| below(path, room).is_some());
            let name = &file.name;
            let room =
                place(&file.module).unwrap_or_else(|| panic!("{name} is in no room: add it to its list"));
            looked_at += 1;
            for path in uses(file) {
                let used = place(&path).unwrap_or(0);
                assert!(
                    used <= room,
                    "{name} is in the room `{}` and uses `{path}`, which comes later in the walk: {}",
                    rooms[room],
                    rooms[..=used].join(" -> ")
                );
            }
        }
        assert!(looked_at > minimum, "only {looked_at} files found under {src}");
    }
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
    assert_eq!(published.len(), 13);
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
    assert_eq!(holding, ["x86_64/machine.rs", "x86_64/memory.rs"]);

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

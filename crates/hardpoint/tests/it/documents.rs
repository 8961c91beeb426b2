//! Links, paths and types in the documents exist.

use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// Files of the repository, relative to its root; without what tools have written there.
fn files(folder: &Path, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        if path.is_dir() {
            if !["target", "node_modules", "results"].contains(&name) && name != ".git" {
                files(&path, found);
            }
        } else {
            found.push(path.strip_prefix(root()).unwrap().to_str().unwrap().to_owned());
        }
    }
}

fn documents(all: &[String]) -> Vec<(&String, String)> {
    let is_document = |name: &&String| {
        name.ends_with(".md")
            && (name.starts_with("docs/") || !name.contains('/') || name.ends_with("README.md"))
    };
    let read = |name| (name, std::fs::read_to_string(root().join(name)).unwrap());
    all.iter().filter(is_document).map(read).collect()
}

/// The anchor that Markdown renderers make of a heading.
fn anchor(heading: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || [' ', '-', '_'].contains(c);
    heading.to_lowercase().chars().filter(kept).map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[test]
fn links_lead_somewhere() {
    let mut all = Vec::new();
    files(&root(), &mut all);
    let (mut checked, mut dead) = (0, Vec::new());
    for (name, text) in documents(&all) {
        for target in
            text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target)
        {
            if target.contains("://") || target.starts_with("mailto:") || target.contains('`') {
                continue;
            }
            let (file, fragment) = target.split_once('#').unwrap_or((target, ""));
            let path = if file.is_empty() {
                root().join(name)
            } else {
                root().join(name).parent().unwrap().join(file)
            };
            checked += 1;
            if !path.exists() {
                dead.push(format!("{name}: {target}"));
            } else if !fragment.is_empty() && file.ends_with(".md") | file.is_empty() {
                let text = std::fs::read_to_string(&path).unwrap();
                let headings = text.lines().filter(|l| l.starts_with('#'));
                if !headings.map(|l| anchor(l.trim_start_matches('#').trim())).any(|a| a == fragment) {
                    dead.push(format!("{name}: {target}"));
                }
            }
        }
    }
    assert!(dead.is_empty(), "links that lead nowhere: {dead:#?}");
    assert!(checked > 100, "only {checked} links");
}

/// `crates/x/src/y.rs`, `motion/level.rs`, `docs/theory.md`: paths in code marks.
#[test]
fn paths_in_documents_exist() {
    let mut all = Vec::new();
    files(&root(), &mut all);
    let endings = [".rs", ".md", ".ts", ".py", ".svg", ".cff"];
    let (mut checked, mut stale) = (0, Vec::new());
    // The changelog names files of its time.
    for (name, text) in documents(&all).into_iter().filter(|(name, _)| *name != "CHANGELOG.md") {
        let mut in_code = false;
        for line in text.lines() {
            in_code ^= line.starts_with("```");
            for token in line.split('`').skip(1).step_by(2).filter(|_| !in_code) {
                let is_name = |c: char| c.is_alphanumeric() || "._-/".contains(c);
                let is_path = token.chars().all(is_name) && endings.iter().any(|e| token.ends_with(e));
                if !is_path || token.starts_with('.') || token.contains("NAME") {
                    continue;
                }
                checked += 1;
                if !all.iter().any(|file| file == token || file.ends_with(&format!("/{token}"))) {
                    stale.push(format!("{name}: {token}"));
                }
            }
        }
    }
    assert!(stale.is_empty(), "paths that do not exist: {stale:#?}");
    assert!(checked > 50, "only {checked} paths");
}

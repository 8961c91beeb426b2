//! Production code of a crate, as the tests of the house read it: without comments and tests, laid out by `rustfmt`.

use std::path::Path;

/// A source file. Lines of comments and of tests are empty.
pub(super) struct Source {
    /// Path inside `src`.
    pub name: String,
    /// Path of the module: `draft::check` for `draft/check.rs` and for `draft/check/mod.rs`, empty for `lib.rs`.
    pub module: String,
    pub code: String,
}

/// Every file of a folder `src` that is not a test as a whole.
pub(super) fn production(src: &Path) -> Vec<Source> {
    let mut tests = Vec::new();
    let mut files: Vec<Source> = super::sources(src)
        .into_iter()
        .map(|(path, text)| {
            let inside = path.strip_prefix(src).unwrap().with_extension("");
            let mut parts: Vec<&str> = inside.iter().map(|part| part.to_str().unwrap()).collect();
            let name = format!("{}.rs", parts.join("/"));
            parts.pop_if(|last| ["mod", "lib", "main"].contains(last));
            let (module, (code, own_tests)) = (parts.join("::"), without_tests(&text));
            tests.extend(own_tests.into_iter().map(|test| format!("{module}::{test}")));
            Source { name, module, code }
        })
        .collect();
    files.retain(|file| !tests.iter().any(|test| below(&file.module, test).is_some()));
    files
}

/// The rest of a path below a module, which is empty for the module itself.
pub(super) fn below<'t>(path: &'t str, module: &str) -> Option<&'t str> {
    match path.strip_prefix(module)? {
        rest if module.is_empty() || rest.is_empty() => Some(rest),
        rest => rest.strip_prefix("::"),
    }
}

pub(super) fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// Number of lines of the item that begins at the first line.
pub(super) fn length_of_item(lines: &[&str]) -> usize {
    let is_last = |line: &&str| indent(line) == indent(lines[0]) && line.ends_with(['}', ';']);
    lines.iter().position(is_last).map_or(lines.len(), |last| last + 1)
}

/// The code of a text, and the names of the modules of tests that are files of their own.
fn without_tests(text: &str) -> (String, Vec<String>) {
    let lines: Vec<&str> = text.lines().collect();
    let (mut code, mut files, mut first_after_test) = (String::new(), Vec::new(), 0);
    for (k, line) in lines.iter().enumerate() {
        if line.trim_start() == "#[cfg(test)]" && k >= first_after_test {
            let file = lines[k + 1].strip_suffix(';').and_then(|item| item.split_once("mod "));
            files.extend(file.map(|(_, name)| name.to_owned()));
            first_after_test = k + 1 + length_of_item(&lines[k + 1..]);
        }
        if k >= first_after_test && !line.trim_start().starts_with("//") {
            code += line;
        }
        code += "\n";
    }
    (code, files)
}

/// Paths from the root of the crate that a file names: `super::{a, b::C}` has two.
pub(super) fn uses(file: &Source) -> Vec<String> {
    let mut out = Vec::new();
    for (at, prefix) in file.code.match_indices("crate::") {
        leaves(&file.code[at + prefix.len()..], String::new(), &mut out);
    }
    for (at, word) in
        file.code.match_indices("super::").filter(|(at, word)| !file.code[..*at].ends_with(word))
    {
        let path = file.code[at..].trim_start_matches(word);
        let levels = (file.code.len() - at - path.len()) / word.len();
        let above = file.module.rsplitn(levels + 1, "::").nth(levels).unwrap_or_default();
        leaves(path, above.to_owned(), &mut out);
    }
    out
}

/// Names that a file re-exports, as paths below it.
pub(super) fn exports(file: &Source) -> Vec<String> {
    let mut out = Vec::new();
    for (at, word) in file.code.match_indices(" use ") {
        leaves(file.code[at + word.len()..].trim_start_matches("self::"), String::new(), &mut out);
    }
    out
}

/// Adds the paths of a tree: `a::b` and `a::c::D` of `a::{b, c::D as E}`. Returns the text after it.
fn leaves<'t>(tree: &'t str, path: String, out: &mut Vec<String>) -> &'t str {
    if let Some(mut list) = tree.strip_prefix('{') {
        loop {
            list = list.trim_start_matches(|c: char| c == ',' || c.is_whitespace());
            if list.is_empty() || list.starts_with('}') {
                return list.strip_prefix('}').unwrap_or(list);
            }
            list = leaves(list, path.clone(), out);
            list = &list[list.find([',', '}']).unwrap_or(list.len())..];
        }
    }
    let end = tree.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(tree.len());
    let path = if path.is_empty() { tree[..end].to_owned() } else { format!("{path}::{}", &tree[..end]) };
    match tree[end..].strip_prefix("::") {
        Some(rest) => leaves(rest, path, out),
        None => {
            out.push(path);
            &tree[end..]
        }
    }
}

#[test]
fn paths_are_read_through_braces_and_lines() {
    let text = "//! crate::no::Comment
use crate::{
    model::{Model, law as l},
    run,
};
use super::super::a::B;
#[cfg(test)]
mod tests {
    use crate::test;
}
pub use self::b::{C, d::E};
#[cfg(test)]
mod battery;
use super::F;
";
    let (code, files) = without_tests(text);
    assert_eq!(files, ["battery"]);
    let file = Source { name: String::new(), module: "x::y::z".into(), code };
    assert_eq!(uses(&file), ["model::Model", "model::law", "run", "x::a::B", "x::y::F"]);
    assert_eq!(exports(&file), ["b::C", "b::d::E"]);
    assert_eq!(["a::b", "a", "ab"].map(|path| below(path, "a")), [Some("b"), Some(""), None]);
}

//! Tree of a YAML or JSON text; every node has its position in the text.

use std::collections::HashSet;

use saphyr_parser::{Event, Parser, ScalarStyle};

use crate::report::{ImportLog, SourceSpan};

/// Maximum depth of nested maps and lists.
const DEEPEST: usize = 60;

/// Value with its position.
#[derive(Clone, Debug)]
pub struct Tree {
    /// Position.
    pub at: SourceSpan,
    /// Value.
    pub value: Value,
}

/// Value.
#[derive(Clone, Debug)]
pub enum Value {
    /// Keys, their positions, and values, in order.
    Map(Vec<(String, SourceSpan, Tree)>),
    /// Values of a list.
    List(Vec<Tree>),
    /// A text or number as written, and true if it is quoted.
    Scalar(String, bool),
}

impl Tree {
    /// Returns the value of a key, ignoring case.
    pub fn get(&self, key: &str) -> Option<&Self> {
        self.entries().iter().find(|(k, ..)| k.eq_ignore_ascii_case(key)).map(|(.., v)| v)
    }

    /// Returns the entries of a map; empty for other values.
    pub fn entries(&self) -> &[(String, SourceSpan, Self)] {
        if let Value::Map(entries) = &self.value { entries } else { &[] }
    }

    /// Returns the text of a scalar.
    pub fn text(&self) -> Option<&str> {
        if let Value::Scalar(text, _) = &self.value { Some(text) } else { None }
    }

    /// Returns the text of a key.
    pub fn text_of(&self, key: &str) -> Option<&str> {
        self.get(key)?.text()
    }

    /// Returns a finite number.
    pub fn number(&self) -> Option<f64> {
        match &self.value {
            Value::Scalar(text, false) => text.replace('_', "").parse().ok().filter(|x: &f64| x.is_finite()),
            _ => None,
        }
    }

    /// Returns three numbers from a list or from a map of x, y and z.
    pub fn vector(&self) -> Option<[f64; 3]> {
        match &self.value {
            Value::List(list) => {
                <[f64; 3]>::try_from(list.iter().map(Self::number).collect::<Option<Vec<f64>>>()?).ok()
            }
            Value::Map(_) => {
                let [x, y, z] = ["x", "y", "z"].map(|k| self.get(k).and_then(Self::number));
                Some([x?, y?, z?])
            }
            Value::Scalar(..) => None,
        }
    }
}

/// Parses a YAML text; errors are reported.
pub fn yaml(text: &str, notes: &mut ImportLog) -> Option<Tree> {
    parse(text, text, "YAML", notes)
}

/// Parses a JSON text, which may have comments: except for comments and tabs, JSON is YAML.
pub fn json(text: &str, notes: &mut ImportLog) -> Option<Tree> {
    parse(text, &blanked(text), "JSON", notes)
}

/// Replaces comments and tabs by the same number of blanks.
fn blanked(text: &str) -> String {
    let mut out: Vec<u8> = text.bytes().collect();
    let (mut k, mut quoted) = (0, false);
    while k < out.len() {
        match out[k] {
            b'\\' if quoted => k += 1,
            b'"' => quoted = !quoted,
            b'\t' if !quoted => out[k] = b' ',
            b'/' if !quoted && out.get(k + 1) == Some(&b'/') => {
                while k < out.len() && out[k] != b'\n' {
                    out[k] = b' ';
                    k += 1;
                }
            }
            b'/' if !quoted && out.get(k + 1) == Some(&b'*') => {
                while k < out.len() && !(out[k] == b'*' && out.get(k + 1) == Some(&b'/')) {
                    out[k] = if out[k] == b'\n' { b'\n' } else { b' ' };
                    k += 1;
                }
                let end = (k + 2).min(out.len());
                out[k..end].fill(b' ');
                k += 1;
            }
            _ => {}
        }
        k += 1;
    }
    String::from_utf8(out).unwrap_or_default()
}

/// Open container: a map with its pending key, or a list.
enum Open {
    Map(SourceSpan, Vec<(String, SourceSpan, Tree)>, Option<(String, SourceSpan)>, HashSet<String>),
    List(SourceSpan, Vec<Tree>),
}

fn parse(original: &str, text: &str, language: &str, notes: &mut ImportLog) -> Option<Tree> {
    // The parser counts characters.
    let bytes: Vec<usize> = original.char_indices().map(|(k, _)| k).chain([original.len()]).collect();
    let byte = |k: usize| bytes.get(k).copied().unwrap_or(original.len());
    let mut open: Vec<Open> = Vec::new();
    let mut root = None;
    for event in Parser::new_from_str(text) {
        let (event, span) = match event {
            Ok(event) => event,
            Err(e) => {
                let start = byte(e.marker().index());
                let at = SourceSpan { text: 0, start, end: start };
                let help =
                    "check the brackets, quotes, commas and the indentation at or before this position";
                notes.problem_with("HP0802", Some(at), format!("invalid {language}: {}", e.info()), help);
                return None;
            }
        };
        let at = SourceSpan { text: 0, start: byte(span.start.index()), end: byte(span.end.index()) };
        let done = match event {
            Event::MappingStart(..) => {
                open.push(Open::Map(at, Vec::new(), None, HashSet::new()));
                None
            }
            Event::SequenceStart(..) => {
                open.push(Open::List(at, Vec::new()));
                None
            }
            Event::MappingEnd | Event::SequenceEnd => match open.pop() {
                Some(Open::Map(start, entries, ..)) => Some(Tree { at: start, value: Value::Map(entries) }),
                Some(Open::List(start, list)) => Some(Tree { at: start, value: Value::List(list) }),
                None => None,
            },
            Event::Scalar(text, style, ..) => {
                let value = Value::Scalar(text.into_owned(), style != ScalarStyle::Plain);
                Some(Tree { at, value })
            }
            Event::Alias(_) => {
                let help = "write the value in place of the alias";
                notes.problem_with("HP0805", Some(at), "aliases are not supported", help);
                return None;
            }
            _ => None,
        };
        if open.len() > DEEPEST {
            notes.problem_with("HP0802", Some(at), "it is nested too deep", "reduce its levels to 60");
            return None;
        }
        let Some(tree) = done else { continue };
        match open.last_mut() {
            Some(Open::Map(_, entries, key, known)) => match key.take() {
                Some((name, at)) => {
                    if !known.insert(name.clone()) {
                        notes.problem_with(
                            "HP0803",
                            Some(at),
                            format!("`{name}` is defined twice"),
                            "remove one of them",
                        );
                    }
                    entries.push((name, at, tree));
                }
                None => *key = Some((tree.text().unwrap_or_default().to_owned(), tree.at)),
            },
            Some(Open::List(_, list)) => list.push(tree),
            None => root = root.or(Some(tree)),
        }
    }
    root
}

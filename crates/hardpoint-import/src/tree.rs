//! YAML and JSON as one tree whose every node knows its place in the text.

use std::collections::HashSet;

use saphyr_parser::{Event, Parser, ScalarStyle};

use crate::report::{ImportLog, SourceSpan};

/// Maps and lists are nested so deep at most.
const DEEPEST: usize = 60;

/// A value and where it is.
#[derive(Clone, Debug)]
pub struct Tree {
    /// Where.
    pub at: SourceSpan,
    /// What.
    pub value: Value,
}

/// A value.
#[derive(Clone, Debug)]
pub enum Value {
    /// Keys, where they stand, and values, in order.
    Map(Vec<(String, SourceSpan, Tree)>),
    /// Values.
    List(Vec<Tree>),
    /// A text or number as it is written, and whether it is in quotes.
    Scalar(String, bool),
}

impl Tree {
    /// The value of a key, whatever its case.
    pub fn get(&self, key: &str) -> Option<&Self> {
        self.entries().iter().find(|(k, ..)| k.eq_ignore_ascii_case(key)).map(|(.., v)| v)
    }

    /// The entries of a map; none of anything else.
    pub fn entries(&self) -> &[(String, SourceSpan, Self)] {
        if let Value::Map(entries) = &self.value { entries } else { &[] }
    }

    /// A text.
    pub fn text(&self) -> Option<&str> {
        if let Value::Scalar(text, _) = &self.value { Some(text) } else { None }
    }

    /// The text of a key.
    pub fn text_of(&self, key: &str) -> Option<&str> {
        self.get(key)?.text()
    }

    /// A finite number.
    pub fn number(&self) -> Option<f64> {
        match &self.value {
            Value::Scalar(text, false) => text.replace('_', "").parse().ok().filter(|x: &f64| x.is_finite()),
            _ => None,
        }
    }

    /// Three numbers: a list, or a map of x, y and z; none where it is something else.
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

/// The tree of a YAML text; what is wrong with it is reported.
pub fn yaml(text: &str, notes: &mut ImportLog) -> Option<Tree> {
    parse(text, text, "YAML", notes)
}

/// The tree of a JSON text, which may have comments: JSON is YAML, but for these and for tabs.
pub fn json(text: &str, notes: &mut ImportLog) -> Option<Tree> {
    parse(text, &blanked(text), "JSON", notes)
}

/// The text with blanks, as many bytes, in place of comments and tabs.
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

/// Open container while events arrive: a map with its next key, or a list.
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
                    "mostly a bracket, a quote or a comma, or the depth of a line, at or before this place";
                notes.problem_with(
                    "HP0802",
                    Some(at),
                    format!("this is not valid {language}: {}", e.info()),
                    help,
                );
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
                let help = "write the value out where the alias is";
                notes.problem_with("HP0805", Some(at), "aliases are not read here", help);
                return None;
            }
            _ => None,
        };
        if open.len() > DEEPEST {
            notes.problem_with(
                "HP0802",
                Some(at),
                "it is nested too deep",
                "no such file has that many levels",
            );
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
                            format!("`{name}` is there twice"),
                            "remove one of the two",
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

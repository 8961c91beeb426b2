//! Completions at a position: keys of the table, names of entries, words.

use std::ops::Range;

use hardpoint::model::Model;

use crate::values::{Key, Need, Shape, alternatives, key_list, noun};

use super::Document;
use super::names::{offered, words_of};
use super::syntax::{self, Cursor, CursorPlace, Member, Node};

/// A completion of the text at a position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Completion {
    /// The key, name or word.
    pub label: String,
    /// Text to insert.
    pub insert: String,
    /// Range that the text replaces.
    pub replaces: Range<usize>,
    /// Kind.
    pub kind: CompletionKind,
    /// Description in a word, such as `body` or `required`.
    pub detail: String,
    /// Meaning, in Markdown.
    pub meaning: String,
}

/// Kind of a completion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompletionKind {
    /// A table that a heading begins.
    Table,
    /// Key of a table.
    Key,
    /// Name of an entry.
    Name,
    /// One of several words.
    Word,
}

impl Document {
    /// Completions at a byte of the text. The model of an earlier state of the text has further names, such as the
    /// measures of wheels.
    pub fn completions(&self, at: usize, model: Option<&Model>) -> Vec<Completion> {
        let Some(cursor) = syntax::cursor(&self.text, at) else { return Vec::new() };
        let mut found = match cursor.place {
            CursorPlace::Heading => self.headings(&cursor),
            CursorPlace::Key => self.keys(&cursor),
            CursorPlace::Value(in_quotes) => self.values(&cursor, in_quotes, model),
        };
        for completion in &mut found {
            let begun = std::mem::replace(&mut completion.replaces, 0..0).end;
            completion.replaces = at - begun..at;
        }
        let mut seen: Vec<String> = Vec::new();
        found.retain(|c| {
            let is_new = !seen.contains(&c.label);
            seen.push(c.label.clone());
            is_new
        });
        found
    }

    /// Forms of the value at a path of keys.
    fn shapes_at(&self, path: &[String]) -> Vec<Shape> {
        let mut shapes = vec![Shape::Table(self.format)];
        let mut node = Some(&self.root);
        for part in path {
            let kind = node.and_then(|n| n.get("type")).and_then(Node::text);
            let all = flat(&shapes);
            let entries = all.iter().filter_map(|s| match s {
                Shape::Entries(_, of) => Some(**of),
                _ => None,
            });
            let keys = known_keys(&all, kind).into_iter().filter(|k| k.key == part).map(|k| k.shape);
            shapes = entries.chain(keys).collect();
            node = node.and_then(|n| n.get(part));
        }
        shapes
    }

    /// Table at a path of keys, unless it is in a list.
    fn node_at(&self, path: &[String]) -> Option<&Node> {
        path.iter().try_fold(&self.root, |node, part| node.get(part))
    }

    fn headings(&self, cursor: &Cursor) -> Vec<Completion> {
        let shapes = flat(&self.shapes_at(&cursor.path));
        let is_table = |key: &&Key| {
            let is = |s: &Shape| matches!(s, Shape::Entries(..) | Shape::Table(_) | Shape::Kinds(_));
            flat(&[key.shape]).iter().any(is)
        };
        let kind = self.node_at(&cursor.path).and_then(|n| n.get("type")).and_then(Node::text);
        let keys = known_keys(&shapes, kind).into_iter().filter(is_table);
        keys.map(|key| completion(key.key, key.key.to_owned(), cursor, CompletionKind::Table).with(key))
            .collect()
    }

    fn keys(&self, cursor: &Cursor) -> Vec<Completion> {
        let shapes = flat(&self.shapes_at(&cursor.path));
        let own = if cursor.in_list { None } else { self.node_at(&cursor.path) };
        let kind = cursor.kind.as_deref().or_else(|| own.and_then(|n| n.get("type")).and_then(Node::text));
        let is_there = |name: &str| {
            name != cursor.begun
                && (cursor.siblings.iter().any(|s| s == name) || own.is_some_and(|n| n.get(name).is_some()))
        };
        let mut found: Vec<Completion> = known_keys(&shapes, kind)
            .into_iter()
            .filter(|key| !is_there(key.key))
            .map(|key| completion(key.key, format!("{} = ", key.key), cursor, CompletionKind::Key).with(key))
            .collect();
        // Keys that are names of entries of another section. A section itself has new names.
        if cursor.path.len() > 1 {
            for shape in &shapes {
                let Shape::Entries(kind, _) = shape else { continue };
                let names = self.names(kind).into_iter().filter(|name| !is_there(&name.0));
                found.extend(names.map(|(name, detail)| {
                    let insert = format!("{} = ", quoted_key(&name));
                    Completion { detail, ..completion(&name, insert, cursor, CompletionKind::Name) }
                }));
            }
        }
        found
    }

    fn values(&self, cursor: &Cursor, in_quotes: bool, model: Option<&Model>) -> Vec<Completion> {
        let shapes = flat(&self.shapes_at(&cursor.path));
        let write = |value: &str| if in_quotes { value.to_owned() } else { format!("\"{value}\"") };
        let mut found = Vec::new();
        for shape in &shapes {
            match shape {
                Shape::Name(kind) => {
                    let names = self.names(kind).into_iter().chain(names_of(kind, model));
                    found.extend(names.map(|(name, detail)| {
                        let one = completion(&name, write(&name), cursor, CompletionKind::Name);
                        Completion { detail, ..one }
                    }));
                }
                Shape::Flag if !in_quotes => found.extend(
                    ["true", "false"]
                        .map(|word| completion(word, word.to_owned(), cursor, CompletionKind::Word)),
                ),
                Shape::Expression | Shape::Number(_) if in_quotes => {
                    found.extend(self.in_expression(cursor, model));
                }
                _ => found.extend(words_of(*shape).into_iter().map(|(word, meaning)| {
                    let one = completion(word, write(word), cursor, CompletionKind::Word);
                    Completion { meaning, ..one }
                })),
            }
        }
        // Types of a table, from its kinds.
        if let Some((key, above)) = cursor.path.split_last()
            && key == "type"
        {
            for shape in flat(&self.shapes_at(above)) {
                let Shape::Kinds(kinds) = shape else { continue };
                let tables = (kinds.tables)().into_iter().filter(|_| kinds.typed);
                found.extend(tables.map(|table| Completion {
                    meaning: table.doc.to_owned(),
                    ..completion(table.name, write(table.name), cursor, CompletionKind::Word)
                }));
            }
        }
        found
    }

    /// Names of a kind of entry, each with its description in a word.
    fn names(&self, kind: &str) -> Vec<(String, String)> {
        let mut names = Vec::new();
        if kind == "a body" {
            names.push(("ground".to_owned(), "body".to_owned()));
        }
        for (section, endings) in offered(kind) {
            let detail = match section {
                "points" => "point".to_owned(),
                "clearances" => "clearance".to_owned(),
                "parameters" => "parameter".to_owned(),
                "forces" => "force".to_owned(),
                _ => noun(kind).to_owned(),
            };
            let is_one = |name: &String| match (kind, section) {
                ("a joint", "hardpoints") => self.bodies_on(name).len() > 1,
                ("a point", "hardpoints") => matches!(self.bodies_on(name)[..], [body] if body != "ground"),
                _ => true,
            };
            for name in self.index.names_in(section).into_iter().filter(is_one) {
                names.extend(endings.iter().map(|ending| (format!("{name}{ending}"), detail.clone())));
            }
        }
        names
    }

    /// Bodies of a planar model that list a hardpoint.
    fn bodies_on(&self, hardpoint: &str) -> Vec<&str> {
        let bodies = self.root.get("bodies").map_or(&[][..], Node::members);
        let has = |body: &&Member| body.value.elements().iter().any(|n| n.text() == Some(hardpoint));
        bodies.iter().filter(has).map(|body| body.name.as_str()).collect()
    }

    /// Names for the word that was begun in an expression.
    fn in_expression(&self, cursor: &Cursor, model: Option<&Model>) -> Vec<Completion> {
        let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
        let start = cursor
            .begun
            .rfind(|c| !is_part(c))
            .map_or(0, |at| at + cursor.begun[at..].chars().next().map_or(0, char::len_utf8));
        let word = Cursor {
            place: cursor.place,
            path: Vec::new(),
            begun: cursor.begun[start..].to_owned(),
            kind: None,
            siblings: Vec::new(),
            in_list: cursor.in_list,
        };
        let of_measure = cursor.path.first().is_some_and(|section| section == "measures");
        let mut names = self.names("a parameter");
        if of_measure {
            names.extend(self.names("a measure").into_iter().chain(names_of("a measure", model)));
        } else {
            let coordinates = self.names("a hardpoint").into_iter().flat_map(|(name, detail)| {
                ["x", "y", "z"].map(|axis| (format!("{name}.{axis}"), detail.clone()))
            });
            names.extend(coordinates);
        }
        let one = |(name, detail): (String, String)| Completion {
            detail,
            ..completion(&name, name.clone(), &word, CompletionKind::Name)
        };
        names.into_iter().map(one).collect()
    }
}

/// Names of a model that its text need not have as entries: measures of wheels and limits, metrics of clearances.
fn names_of(kind: &str, model: Option<&Model>) -> Vec<(String, String)> {
    let Some(model) = model else { return Vec::new() };
    let names: Vec<String> = match kind {
        "a measure" => hardpoint::measure::outputs(model).into_iter().map(|o| o.name).collect(),
        "a metric" => model.metrics.iter().map(|m| m.name.clone()).collect(),
        _ => Vec::new(),
    };
    names.into_iter().map(|name| (name, noun(kind).to_owned())).collect()
}

/// A completion that replaces the word that was begun; the end of the range is the length of that word.
fn completion(label: &str, insert: String, cursor: &Cursor, kind: CompletionKind) -> Completion {
    let (label, replaces) = (label.to_owned(), 0..cursor.begun.len());
    Completion { label, insert, replaces, kind, detail: String::new(), meaning: String::new() }
}

impl Completion {
    /// Adds the description of a key.
    fn with(self, key: &Key) -> Self {
        let detail = match key.need {
            Need::Required => "required".to_owned(),
            Need::Optional => String::new(),
            Need::Else(default) => format!("default {}", default.strip_suffix(".0").unwrap_or(default)),
        };
        let meaning = format!("{}\n\nExample: `{} = {}`", key.doc, key.key, key.example);
        Self { detail, meaning, ..self }
    }
}

/// Alternatives of some forms, and those of the elements of lists.
fn flat(shapes: &[Shape]) -> Vec<Shape> {
    let mut all = Vec::new();
    for shape in shapes.iter().flat_map(|s| alternatives(*s)) {
        match shape {
            Shape::List(of, _) => all.extend(flat(&[*of])),
            shape => all.push(shape),
        }
    }
    all
}

/// Keys of a table with one of these forms: those of its `type`, or of all types.
fn known_keys(all: &[Shape], kind: Option<&str>) -> Vec<&'static Key> {
    // Of several tables, the `type` selects those that have it.
    let selected: Vec<Shape> =
        all.iter().copied().filter(|shape| kind.is_some_and(|k| has_type(*shape, k))).collect();
    let known = key_list(if selected.is_empty() { all } else { &selected }, kind);
    if !known.is_empty() {
        return known;
    }
    let typed = |shape: &Shape| match shape {
        Shape::Kinds(kinds) if kinds.typed => (kinds.tables)(),
        _ => Vec::new(),
    };
    let mut keys: Vec<&'static Key> = Vec::new();
    for key in all.iter().flat_map(typed).flat_map(|table| table.typed_keys()) {
        if !keys.iter().any(|k| k.key == key.key) {
            keys.push(key);
        }
    }
    keys
}

/// True if tables of this form may have this `type`.
fn has_type(shape: Shape, kind: &str) -> bool {
    match shape {
        Shape::Kinds(kinds) => kinds.typed && (kinds.tables)().iter().any(|table| table.name == kind),
        Shape::Table(table) => {
            let words = table.keys().filter(|key| key.key == "type").flat_map(|key| flat(&[key.shape]));
            words.flat_map(words_of).any(|(word, _)| word == kind)
        }
        _ => false,
    }
}

/// A name as a key is written: in quotes if necessary.
pub(super) fn quoted_key(name: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    if !name.is_empty() && name.chars().all(is_bare) { name.to_owned() } else { format!("\"{name}\"") }
}

//! A document with its syntax tree and its index of names.

use super::names::{Described, EntryName, Index, NameUse, Occurrence, Resolved};
use super::syntax::{self, Node, Tree};
use crate::read::{MODEL, TASK};
use crate::values::{Need, Table};
use std::ops::Range;

/// Maximum size of a text with language features, in bytes.
pub const LARGEST_DOCUMENT: usize = 1 << 20;

/// Text of a model file, or of a task of synthesis, in an editor.
///
/// ```
/// let text = "hardpoints = { A = [0, 0, 0] }\npoints.tip = { body = \"ground\", at = \"A\" }";
/// let document = hardpoint_file::Document::new(text);
/// let name = document.name_at(text.len() - 3).unwrap();
/// assert_eq!((name.section, name.name.as_str()), ("hardpoints", "A"));
/// assert_eq!(document.references(&name).len(), 2);
/// ```
#[derive(Debug)]
pub struct Document {
    pub(super) text: String,
    pub(super) root: Node,
    pub(super) format: &'static Table,
    pub(super) index: Index,
}

/// An entry, such as a joint, at a position of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NameAt {
    /// Section of the entry, such as `joints`.
    pub section: &'static str,
    /// Name of the entry.
    pub name: String,
    /// Range of the name at the position.
    pub at: Range<usize>,
}

/// Occurrence of a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reference {
    /// Range of the name, without quotes.
    pub at: Range<usize>,
    /// True if the entry is declared here.
    pub is_declaration: bool,
}

/// Meaning of a key or a word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyMeaning {
    /// Range of the key or word.
    pub at: Range<usize>,
    /// The key or word.
    pub name: String,
    /// Meaning, in Markdown.
    pub meaning: String,
    /// Default value as written, if the key has one.
    pub default: Option<String>,
    /// Example of a value.
    pub example: Option<String>,
    /// True if the key is required.
    pub is_required: bool,
}

/// Part of the outline of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Key or name.
    pub name: String,
    /// `type` of the entry, or its value in a few characters.
    pub detail: String,
    /// Section of an entry; `None` for a key of the model.
    pub section: Option<&'static str>,
    /// Range of the whole part.
    pub whole: Range<usize>,
    /// Range of the name.
    pub at: Range<usize>,
    /// Entries of a section.
    pub children: Vec<Symbol>,
}

/// A file that the text includes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IncludedFile {
    /// Name as written, relative to the folder of the text.
    pub file: String,
    /// Range of that name.
    pub at: Range<usize>,
    /// Prefix of the names of its entries.
    pub prefix: String,
    /// Names without the prefix.
    pub shared: Vec<String>,
}

impl Document {
    /// Reads a text, which need not be valid.
    pub fn new(text: &str) -> Self {
        let root = syntax::read(text);
        let has = |key: &str| root.get(key).is_some();
        let is_list = |key: &str| root.get(key).is_some_and(|n| !matches!(n.value, Tree::Table(_)));
        let is_task = !has("bodies") && !has("joints") && (has("poses") || is_list("points"));
        let format: &'static Table = if is_task { &TASK } else { &MODEL };
        let index = Index::of(text, &root, format);
        Self { text: text.to_owned(), root, format, index }
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// True for a task of `hardpoint synthesize` instead of a model.
    pub fn is_task(&self) -> bool {
        self.format.name == TASK.name
    }

    pub(super) fn occurrence(&self, at: usize) -> Option<&Occurrence> {
        self.index.names.iter().find(|o| o.at.start <= at && at <= o.at.end)
    }

    /// Entry that is named at a byte of the text.
    pub fn name_at(&self, at: usize) -> Option<NameAt> {
        let (occurrence, found) = self.resolved(at)?;
        let length = if occurrence.is_plain { found.length } else { occurrence.at.len() };
        let start = occurrence.at.start;
        Some(NameAt { section: found.entry.section, name: found.entry.name, at: start..start + length })
    }

    pub(super) fn resolved(&self, at: usize) -> Option<(&Occurrence, Resolved)> {
        let occurrence = self.occurrence(at)?;
        Some((occurrence, self.index.resolve(&occurrence.name, occurrence.of)?))
    }

    /// Name at a byte of the text whose entry is not declared in it, with its range; it may be that of an included
    /// file.
    pub fn foreign_name_at(&self, at: usize) -> Option<(&str, Range<usize>)> {
        let o = self.occurrence(at)?;
        let is_foreign = self.index.resolve(&o.name, o.of).is_none();
        is_foreign.then(|| (o.name.as_str(), o.at.clone()))
    }

    /// Occurrences of an entry's name, in the order of the text.
    pub fn references(&self, name: &NameAt) -> Vec<Reference> {
        let entry = EntryName { section: name.section, name: name.name.clone() };
        let found = self.index.occurrences(&entry).map(|(o, resolved)| Reference {
            at: if o.is_plain { o.at.start..o.at.start + resolved.length } else { o.at.clone() },
            is_declaration: matches!(o.of, NameUse::Declaration(_)),
        });
        let mut found: Vec<Reference> = found.collect();
        found.sort_by_key(|r| r.at.start);
        found
    }

    /// Declarations of a name in any section, with their sections.
    pub fn declarations(&self, name: &str) -> Vec<(&'static str, Range<usize>)> {
        let all = self.index.names.iter().filter(|o| o.name == name);
        all.filter_map(|o| match o.of {
            NameUse::Declaration(section) => Some((section, o.at.clone())),
            NameUse::Key(_) | NameUse::Value(_) | NameUse::Expression(_) => None,
        })
        .collect()
    }

    /// Meaning of the key or word at a byte of the text.
    pub fn meaning_at(&self, at: usize) -> Option<KeyMeaning> {
        let found = self.index.meanings.iter().find(|m| m.at.start <= at && at <= m.at.end)?;
        Some(match &found.of {
            Described::Key(key) => KeyMeaning {
                at: found.at.clone(),
                name: key.key.to_owned(),
                meaning: key.doc.to_owned(),
                default: match key.need {
                    Need::Else(default) => Some(default.strip_suffix(".0").unwrap_or(default).to_owned()),
                    Need::Required | Need::Optional => None,
                },
                example: Some(format!("{} = {}", key.key, key.example)),
                is_required: key.need == Need::Required,
            },
            Described::Word(word, doc) => KeyMeaning {
                at: found.at.clone(),
                name: (*word).to_owned(),
                meaning: doc.clone(),
                default: None,
                example: None,
                is_required: false,
            },
        })
    }

    /// Outline of the text: its keys, and the entries of its sections.
    pub fn symbols(&self) -> Vec<Symbol> {
        let symbol = |member: &syntax::Member, section: Option<&'static str>| Symbol {
            name: member.name.clone(),
            detail: detail(&self.text, &member.value),
            section,
            whole: member.whole.clone(),
            at: member.at.first().cloned().unwrap_or(member.whole.clone()),
            children: Vec::new(),
        };
        let of = |member: &syntax::Member| {
            let mut own = symbol(member, None);
            let key = self.format.keys().find(|k| k.key == member.name);
            if let (Some(key), Tree::Table(entries)) = (key, &member.value.value) {
                own.children = entries.iter().map(|entry| symbol(entry, Some(key.key))).collect();
                own.detail.clear();
            }
            own
        };
        self.root.members().iter().map(of).collect()
    }

    /// Files that the text includes.
    pub fn includes(&self) -> Vec<IncludedFile> {
        let list = self.root.get("include").map_or(&[][..], Node::elements);
        let texts = |node: Option<&Node>| -> Vec<String> {
            let list = node.map_or(&[][..], Node::elements);
            list.iter().filter_map(|n| n.text().map(str::to_owned)).collect()
        };
        let one = |node: &Node| {
            let file = node.get("file").unwrap_or(node);
            Some(IncludedFile {
                file: file.text()?.to_owned(),
                at: file.at.clone(),
                prefix: node.get("prefix").and_then(Node::text).unwrap_or_default().to_owned(),
                shared: texts(node.get("shared")),
            })
        };
        list.iter().filter_map(one).collect()
    }
}

/// Type of an entry, or its value on one line.
fn detail(text: &str, node: &Node) -> String {
    const LONGEST: usize = 40;
    if let Some(kind) = node.get("type").and_then(Node::text) {
        return kind.to_owned();
    }
    if matches!(node.value, Tree::Table(_)) {
        return String::new();
    }
    let line: String = text[node.at.clone()].split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line,
    }
}

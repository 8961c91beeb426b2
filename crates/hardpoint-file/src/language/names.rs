//! Declarations and references of a text, found by the declared forms of its values.

use std::collections::HashMap;
use std::ops::Range;

use crate::compose::side_names::{WORDS, exchanged};
use crate::values::{Key, Shape, Table, alternatives, key_list, list_form, names_in_expression};

use super::syntax::{Member, Node, Tree};

/// A place of a name.
#[derive(Clone, Debug)]
pub(super) struct Occurrence {
    /// Range of the name in the text, without quotes.
    pub at: Range<usize>,
    /// The name as written there; `None` if escapes in quotes separate both.
    pub is_plain: bool,
    pub name: String,
    pub of: NameUse,
}

/// Use of a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NameUse {
    /// Heading or key of an entry in this section.
    Declaration(&'static str),
    /// Key of a table of entries of another section, like "a joint".
    Key(&'static str),
    /// Text that names such an entry.
    Value(&'static str),
    /// Part of an expression; true in a measure, where names are those of measures first.
    Expression(bool),
}

/// A key or word with its meaning.
#[derive(Clone, Debug)]
pub(super) struct Meaning {
    pub at: Range<usize>,
    pub of: Described,
}

#[derive(Clone, Debug)]
pub(super) enum Described {
    Key(&'static Key),
    Word(&'static str, String),
}

/// An entry of the text: its section, and its name there.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct EntryName {
    pub section: &'static str,
    pub name: String,
}

/// Reference to an entry.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Resolved {
    pub entry: EntryName,
    /// Number of bytes of the name that belong to the entry: 1 in `A.x`.
    pub length: usize,
    /// True if the text names the mirror image of the entry.
    pub is_image: bool,
}

/// Names and meanings of a text.
#[derive(Debug, Default)]
pub(super) struct Index {
    pub names: Vec<Occurrence>,
    pub meanings: Vec<Meaning>,
    /// Sections of each declared name.
    declared: HashMap<String, Vec<&'static str>>,
    /// Words of a mirror, and their counterparts.
    words: Vec<(String, String)>,
}

/// Sections in which a name of a kind may be declared, in the order of precedence; true for those whose names may have
/// a component after a point.
fn sections_of(kind: &str) -> &'static [(&'static str, bool)] {
    match kind {
        "a parameter" => &[("parameters", false)],
        "a hardpoint" => &[("hardpoints", false)],
        "a body" => &[("bodies", false)],
        // Pins of a planar model have the names of their hardpoints.
        "a joint" => &[("joints", false), ("hardpoints", false)],
        "a coupler" => &[("couplers", false)],
        "a driver" => &[("drivers", false), ("forces", false)],
        "a design variable" => &[("design", false), ("parameters", false)],
        // A hardpoint on a single body of a planar model is a point of that body.
        "a point" => &[("points", false), ("hardpoints", false)],
        "a wheel" => &[("wheels", false)],
        "an axle" => &[("axles", false)],
        "a shape" => &[("shapes", false), ("bodies", false)],
        "a clearance" => &[("clearances", false)],
        "a mass" => &[("masses", false)],
        "a force" => &[("forces", false)],
        "a measure" => &[
            ("measures", false),
            ("clearances", false),
            ("points", true),
            ("wheels", true),
            ("axles", true),
            ("joints", true),
            ("hardpoints", true),
        ],
        "a metric" | "a goal" => {
            &[("metrics", false), ("clearances", true), ("joints", true), ("hardpoints", true)]
        }
        "a case" => &[("cases", false)],
        "a design" => &[("designs", false)],
        "a limit of a joint" => &[("joints", true), ("hardpoints", true)],
        "a thing" => &[
            ("hardpoints", false),
            ("bodies", false),
            ("joints", false),
            ("points", false),
            ("drivers", false),
            ("design", false),
            ("parameters", false),
            ("measures", false),
            ("metrics", false),
            ("forces", false),
            ("masses", false),
            ("couplers", false),
            ("wheels", false),
            ("axles", false),
            ("shapes", false),
            ("clearances", false),
        ],
        _ => &[],
    }
}

/// Section of entries that are declared inside of another section; nothing else refers to them.
fn nested_section(kind: &str) -> Option<&'static str> {
    match kind {
        "a correlation" => Some("tolerance.correlations"),
        "a group" => Some("calibrate.groups"),
        _ => None,
    }
}

/// Sections of names in expressions.
const IN_EXPRESSIONS: [(&str, bool); 7] = [
    ("parameters", false),
    ("hardpoints", true),
    ("measures", false),
    ("points", true),
    ("wheels", true),
    ("axles", true),
    ("clearances", false),
];

/// Kinds whose names complete a value of this kind, as the section and the suffixes of their names.
pub(super) fn offered(kind: &str) -> Vec<(&'static str, &'static [&'static str])> {
    const AXES: &[&str] = &[".x", ".y", ".z"];
    sections_of(kind)
        .iter()
        .filter_map(|(section, has_component)| match (*section, *has_component) {
            ("points", true) => Some(("points", AXES)),
            ("clearances", true) => Some(("clearances", &[".min"] as &[&str])),
            // The names of the coordinates are those of the joint's type.
            (_, true) => None,
            (section, false) => Some((section, &[""] as &[&str])),
        })
        .collect()
}

impl Index {
    /// Finds the names and meanings of a text with this format.
    pub fn of(text: &str, root: &Node, format: &'static Table) -> Self {
        let mut index = Self::default();
        if let Some(mirror) = root.get("mirror") {
            let words = mirror.get("names").map_or(&[][..], Node::members);
            index.words = words
                .iter()
                .filter_map(|word| Some((word.name.clone(), word.value.text()?.to_owned())))
                .collect();
            if index.words.is_empty() {
                index.words.push(WORDS.map(str::to_owned).into());
            }
        }
        for member in root.members() {
            let Some(key) = format.keys().find(|k| k.key == member.name) else { continue };
            index.describe(member, Described::Key(key));
            match key.shape {
                Shape::Entries(_, of) => {
                    for entry in member.value.members() {
                        index.declare(text, key.key, entry);
                        index.value(text, &[*of], &entry.value, key.key == "measures");
                    }
                }
                shape => {
                    let before = index.names.len();
                    index.value(text, &[shape], &member.value, false);
                    // Names of included files are not those of this one.
                    if key.key == "include" {
                        index.names.truncate(before);
                    }
                }
            }
        }
        if root.get("planar").is_some() {
            index.split_hinges();
        }
        index
    }

    /// Splits names of hinges that planar models make of a hardpoint and a body, such as `A_rocker`, into both.
    fn split_hinges(&mut self) {
        let split = |o: &Occurrence| {
            let may_be = match o.of {
                NameUse::Key(kind) | NameUse::Value(kind) => {
                    sections_of(kind).iter().any(|(section, _)| *section == "joints")
                }
                NameUse::Declaration(_) | NameUse::Expression(_) => false,
            };
            if !may_be || !o.is_plain || self.resolve(&o.name, o.of).is_some() {
                return None;
            }
            o.name.match_indices('_').find_map(|(at, _)| {
                let body = at + 1..o.name.len();
                self.entry("hardpoints", &o.name[..at]).and(self.entry("bodies", &o.name[body.clone()]))?;
                let part = |range: Range<usize>, kind| Occurrence {
                    at: o.at.start + range.start..o.at.start + range.end,
                    is_plain: true,
                    name: o.name[range].to_owned(),
                    of: NameUse::Value(kind),
                };
                Some([part(0..at, "a hardpoint"), part(body, "a body")])
            })
        };
        let names = self.names.iter().flat_map(|o| match split(o) {
            Some(parts) => parts.to_vec(),
            None => vec![o.clone()],
        });
        self.names = names.collect();
    }

    fn describe(&mut self, member: &Member, of: Described) {
        self.meanings.extend(member.at.iter().map(|at| Meaning { at: at.clone(), of: of.clone() }));
    }

    fn declare(&mut self, text: &str, section: &'static str, entry: &Member) {
        self.declared.entry(entry.name.clone()).or_default().push(section);
        for name in variables_of(section, entry) {
            self.declared.entry(name).or_default().push(section);
        }
        self.key(text, NameUse::Declaration(section), entry);
    }

    /// All places of a key that is a name.
    fn key(&mut self, text: &str, of: NameUse, member: &Member) {
        for at in &member.at {
            let name = member.name.clone();
            let (at, is_plain) = bare(text, at.clone(), &name);
            self.names.push(Occurrence { at, is_plain, name, of });
        }
    }

    fn value(&mut self, text: &str, shapes: &[Shape], node: &Node, of_measure: bool) {
        let all: Vec<Shape> = shapes.iter().flat_map(|s| alternatives(*s)).collect();
        match &node.value {
            Tree::Word => {}
            Tree::Text(written) => self.text(text, &all, node, written, of_measure),
            Tree::List(list) => {
                if let Some((of, _)) = list_form(&all, list.len()) {
                    list.iter().for_each(|node| self.value(text, &[*of], node, of_measure));
                }
            }
            Tree::Table(members) => {
                if let Some(Shape::Entries(kind, of)) = all.iter().find(|s| matches!(s, Shape::Entries(..))) {
                    for member in members {
                        if let Some(section) = nested_section(kind) {
                            self.key(text, NameUse::Declaration(section), member);
                        } else if is_reference(kind, member) {
                            self.key(text, NameUse::Key(kind), member);
                        }
                        self.value(text, &[**of], &member.value, of_measure);
                    }
                    return;
                }
                let kind = node.get("type").and_then(Node::text);
                let keys = key_list(&all, kind);
                for member in members {
                    if let Some(key) = keys.iter().find(|key| key.key == member.name) {
                        self.describe(member, Described::Key(key));
                        self.value(text, &[key.shape], &member.value, of_measure);
                    }
                }
                if let (Some(kind), Some(at)) = (kind, node.get("type").map(|n| n.at.clone())) {
                    self.kinds(&all, kind, at);
                }
            }
        }
    }

    /// Meaning of the `type` of a table.
    fn kinds(&mut self, all: &[Shape], kind: &str, at: Range<usize>) {
        for shape in all {
            let Shape::Kinds(kinds) = shape else { continue };
            if let Some(table) = (kinds.tables)().into_iter().find(|t| kinds.typed && t.name == kind) {
                let of = Described::Word(table.name, table.doc.to_owned());
                self.meanings.push(Meaning { at: at.clone(), of });
            }
        }
    }

    fn text(&mut self, text: &str, all: &[Shape], node: &Node, written: &str, of_measure: bool) {
        for (word, doc) in all.iter().flat_map(|s| words_of(*s)) {
            if word == written {
                let of = Described::Word(word, doc);
                self.meanings.push(Meaning { at: node.at.clone(), of });
                return;
            }
        }
        let (at, is_plain) = bare(text, node.at.clone(), written);
        let name = all.iter().find_map(|s| if let Shape::Name(kind) = s { Some(*kind) } else { None });
        if let Some(kind) = name {
            let of = NameUse::Value(kind);
            self.names.push(Occurrence { at, is_plain, name: written.to_owned(), of });
        } else if all.iter().any(|s| matches!(s, Shape::Expression | Shape::Number(_))) {
            for name in names_in_expression(written) {
                let place = if is_plain { at.start + name.start..at.start + name.end } else { at.clone() };
                self.names.push(Occurrence {
                    at: place,
                    is_plain,
                    name: written[name].to_owned(),
                    of: NameUse::Expression(of_measure),
                });
            }
        }
    }

    /// Entry that a name means; `None` if the text does not declare it.
    pub fn resolve(&self, name: &str, of: NameUse) -> Option<Resolved> {
        let expression;
        let sections: &[(&'static str, bool)] = match of {
            NameUse::Declaration(section) => {
                let entry = EntryName { section, name: name.to_owned() };
                return Some(Resolved { entry, length: name.len(), is_image: false });
            }
            NameUse::Key(kind) | NameUse::Value(kind) => sections_of(kind),
            NameUse::Expression(of_measure) => {
                let mut sections = IN_EXPRESSIONS;
                // In a measure, names are those of measures first.
                sections.sort_by_key(|(section, _)| of_measure && *section != "measures");
                expression = sections;
                &expression
            }
        };
        sections.iter().find_map(|(section, has_component)| {
            // Names may have points themselves: the longest one counts.
            let points = name.rmatch_indices('.').map(|(at, _)| at);
            let lengths = if *has_component { points.collect() } else { vec![name.len()] };
            lengths.into_iter().find_map(|length| self.resolve_in(section, &name[..length]))
        })
    }

    fn resolve_in(&self, section: &'static str, name: &str) -> Option<Resolved> {
        let (entry, is_image) = self.entry(section, name)?;
        let written = if is_image { exchanged(&entry.name, &self.words)?.len() } else { entry.name.len() };
        Some(Resolved { entry, length: written.min(name.len()), is_image })
    }

    /// Declared entry of a section with this name, or of which it is an image or a variable.
    fn entry(&self, section: &'static str, name: &str) -> Option<(EntryName, bool)> {
        let is_declared = |name: &str| self.declared.get(name).is_some_and(|s| s.contains(&section));
        let owner = |name: &str| {
            // Of a variable `P_x` of the point `P`, the entry is `P`.
            let has_entry = |name: &str| {
                let of = NameUse::Declaration(section);
                self.names.iter().any(|o| o.of == of && o.name == name)
            };
            let base = name.rsplit_once('_').map(|(base, _)| base);
            let base = base.filter(|base| section == "design" && !has_entry(name) && has_entry(base));
            EntryName { section, name: base.unwrap_or(name).to_owned() }
        };
        if is_declared(name) {
            return Some((owner(name), false));
        }
        let original = exchanged(name, &self.words).filter(|original| is_declared(original))?;
        Some((owner(&original), true))
    }

    /// Counterpart of a name on the other side of a mirror.
    pub fn image(&self, name: &str) -> Option<String> {
        exchanged(name, &self.words)
    }

    /// Names of a section, in the order of the text, with the variables of points in `design`.
    pub fn names_in(&self, section: &str) -> Vec<String> {
        let is_there = |o: &&Occurrence| matches!(o.of, NameUse::Declaration(s) if s == section);
        let mut names: Vec<String> = Vec::new();
        for name in self.names.iter().filter(is_there).map(|o| &o.name) {
            if names.contains(name) {
                continue;
            }
            let own = |variable: &&String| {
                section == "design"
                    && self.declared[*variable].contains(&section)
                    && variable.rsplit_once('_').is_some_and(|(base, _)| base == name)
            };
            let mut variables: Vec<&String> = self.declared.keys().filter(own).collect();
            variables.sort();
            if variables.is_empty() {
                names.push(name.clone());
            }
            names.extend(variables.into_iter().cloned());
        }
        names
    }

    /// Occurrences that mean this entry.
    pub fn occurrences(&self, entry: &EntryName) -> impl Iterator<Item = (&Occurrence, Resolved)> {
        self.names.iter().filter_map(move |o| {
            let resolved = self.resolve(&o.name, o.of).filter(|r| r.entry == *entry)?;
            Some((o, resolved))
        })
    }
}

/// Variables of an entry of `design` with other names than its own.
fn variables_of(section: &str, entry: &Member) -> Vec<String> {
    let along = entry.value.get("along").and_then(Node::text).unwrap_or_default();
    let axes = match along {
        _ if section != "design" => "",
        // In planar models, a plane has an axis for each of its letters.
        "xyz" | "xy" | "yz" | "zx" | "xz" => along,
        _ if entry.value.get("play").is_some() => "xyz",
        _ => "",
    };
    axes.chars().map(|axis| format!("{}_{axis}", entry.name)).collect()
}

/// True if a key of such a table names an entry of a section. Goals and limits have names of their own if they name
/// their metric.
fn is_reference(kind: &str, member: &Member) -> bool {
    const OF_LIMITS: [&str; 6] = ["metric", "hardpoint", "between", "length", "clearance", "joint"];
    let is_own = kind == "a metric" && OF_LIMITS.iter().any(|key| member.value.get(key).is_some());
    !is_own && !sections_of(kind).is_empty()
}

/// Range of a name without its quotes, and whether it is written there without escapes.
fn bare(text: &str, at: Range<usize>, name: &str) -> (Range<usize>, bool) {
    let written = &text[at.clone()];
    if written == name {
        return (at, true);
    }
    for quote in ["\"\"\"", "'''", "\"", "'"] {
        if written.strip_prefix(quote).and_then(|w| w.strip_suffix(quote)) == Some(name) {
            return (at.start + quote.len()..at.end - quote.len(), true);
        }
    }
    (at, false)
}

/// Words of a form, with their meanings.
pub(super) fn words_of(shape: Shape) -> Vec<(&'static str, String)> {
    match shape {
        Shape::Words(words) => words.iter().map(|(word, doc)| (*word, (*doc).to_owned())).collect(),
        Shape::Known(_, words) => words(),
        Shape::Text
        | Shape::File
        | Shape::Expression
        | Shape::Name(_)
        | Shape::Number(_)
        | Shape::Plain(_)
        | Shape::Count(_)
        | Shape::Flag
        | Shape::OneOf(_)
        | Shape::List(..)
        | Shape::Entries(..)
        | Shape::Table(_)
        | Shape::Kinds(_)
        | Shape::Any(..) => Vec::new(),
    }
}

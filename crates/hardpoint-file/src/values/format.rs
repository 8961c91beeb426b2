//! The format as data: tables of a model file, their keys, and the form of their values.
//!
//! Every table is declared once, next to the code that reads it. The declarations define the keys of the reader, its
//! defaults and examples, the JSON Schema (`write/schema.rs`), and the tables of `docs/file-format.md`
//! (`write/docs.rs`).

use std::collections::BTreeSet;

use hardpoint::joint::Quantity;

/// A key of a table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Key {
    pub key: &'static str,
    pub shape: Shape,
    pub need: Need,
    /// Example for messages about a missing or invalid value.
    pub example: &'static str,
    /// Meaning of the key.
    pub doc: &'static str,
}

/// Presence of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Need {
    Required,
    Optional,
    /// Default value, as if written.
    Else(&'static str),
}

/// Declares keys: meaning, presence, name, form of the value, and an example.
macro_rules! keys {
    (@ must) => { $crate::values::Need::Required };
    (@ may) => { $crate::values::Need::Optional };
    (@ or $default:literal) => { $crate::values::Need::Else($default) };
    ($($(#[doc = $doc:literal])+ $need:ident $(($default:literal))? $key:literal: $shape:expr, $example:literal;)*) => {
        &[$($crate::values::Key {
            key: $key,
            shape: $shape,
            need: $crate::values::keys!(@ $need $($default)?),
            example: $example,
            doc: concat!($($doc),+).trim_ascii(),
        }),*]
    };
}

/// Declares a table: description, name and keys.
macro_rules! table {
    ($(#[doc = $doc:literal])+ $name:literal, $keys:ident) => {
        $crate::values::Table::new($name, concat!($($doc),+).trim_ascii(), $keys)
    };
    ($(#[doc = $doc:literal])+ $name:literal: $($keys:tt)*) => {
        $crate::values::Table::new($name, concat!($($doc),+).trim_ascii(), $crate::values::keys! { $($keys)* })
    };
}
pub(crate) use {keys, table};

/// A table with keys of its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Table {
    /// Type of the table if `type` selects it; otherwise its name in the schema.
    pub name: &'static str,
    pub doc: &'static str,
    pub keys: &'static [Key],
    /// Keys shared with other tables.
    pub shared: &'static [Key],
    /// Alternative keys.
    pub instead: &'static [Key],
}

impl Table {
    pub const fn new(name: &'static str, doc: &'static str, keys: &'static [Key]) -> Self {
        Self { name, doc, keys, shared: &[], instead: &[] }
    }

    pub fn keys(&'static self) -> impl Iterator<Item = &'static Key> {
        self.keys.iter().chain(self.shared)
    }

    /// Form of a key's value; a text for an unknown key.
    pub fn shape_of(&'static self, key: &str) -> Shape {
        self.keys().find(|k| k.key == key).map_or(Shape::Text, |k| k.shape)
    }

    /// Form of the entries of a table of named entries.
    pub fn entries_of(&'static self, key: &str) -> Shape {
        match self.shape_of(key) {
            Shape::Entries(_, of) => *of,
            shape => shape,
        }
    }

    /// Sets the `type` that selects this table.
    pub fn typed_keys(&'static self) -> impl Iterator<Item = &'static Key> {
        TYPE.iter().chain(self.instead).chain(self.keys())
    }
}

/// A table that is one of several kinds.
#[derive(Debug)]
pub(crate) struct Kinds {
    pub name: &'static str,
    /// Meaning of the table; `{keys}` represents the first keys of its kinds.
    pub doc: &'static str,
    /// True if a key `type` selects the kind; otherwise the first key of a kind selects it.
    pub typed: bool,
    pub tables: fn() -> Vec<&'static Table>,
}

/// Key that selects the kind of a table.
const TYPE: &[Key] = keys! {
    /// Kind of the table.
    must "type": Shape::Text, "...";
};

impl Kinds {
    /// Documentation of the kinds.
    pub fn doc(&self) -> String {
        let tables = (self.tables)();
        let leads: Vec<String> = tables.iter().map(|t| format!("`{}`", t.keys[0].key)).collect();
        self.doc.replace("{keys}", &leads.join(", "))
    }

    /// Keys of all kinds, each once.
    pub fn keys(&self) -> Vec<&'static Key> {
        let tables = (self.tables)();
        let mut keys: Vec<&'static Key> = tables.iter().flat_map(|t| t.keys).collect();
        keys.extend(tables.first().into_iter().flat_map(|t| t.shared));
        let mut seen = BTreeSet::new();
        keys.retain(|key| seen.insert(key.key));
        keys
    }
}

/// Form of a value.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    Text,
    /// Name of a file in the model's folder or below it.
    File,
    /// An expression or a law as text, with names of parameters, coordinates or measures.
    Expression,
    /// Name of an entry, such as "a joint".
    Name(&'static str),
    /// A number, or an expression over parameters; in the file's unit of the quantity.
    Number(Quantity),
    /// A plain number, in the file's unit of the quantity.
    Plain(Quantity),
    /// A whole number from 1 to this.
    Count(u32),
    Flag,
    /// One of several words, with their meanings if necessary.
    Words(&'static [(&'static str, &'static str)]),
    /// One of the words defined by the core, with their name in messages and their meanings.
    Known(&'static str, fn() -> Vec<(&'static str, String)>),
    /// One of several whole numbers.
    OneOf(&'static [u32]),
    /// A list with a minimum and a maximum length.
    List(&'static Shape, [usize; 2]),
    /// A table with one entry per name of such an element, like "a joint".
    Entries(&'static str, &'static Shape),
    Table(&'static Table),
    Kinds(&'static Kinds),
    /// Any of these forms, with a name and a description in the schema.
    Any(&'static str, &'static str, &'static [Shape]),
}

impl Shape {
    /// A list of exactly `count` values of this form.
    pub const fn exactly(count: usize, of: &'static Shape) -> Self {
        Self::List(of, [count; 2])
    }

    pub const fn list(of: &'static Shape) -> Self {
        Self::List(of, [0, usize::MAX])
    }

    /// Name of the expected value in messages.
    pub fn noun(self) -> String {
        match self {
            Self::Name(one) => format!("the name of {one}"),
            Self::List(Self::Name(one), [2, 2]) => format!("the names of two {}", several(one)),
            Self::List(Self::Name(one), _) => format!("a list of names of {}", several(one)),
            Self::Known(noun, _) => noun.to_owned(),
            Self::Any(_, _, [one]) => one.noun(),
            Self::Words(_) => {
                let words: Vec<String> = self.words().iter().map(|w| format!("`\"{w}\"`")).collect();
                match words.split_last() {
                    Some((last, others)) if others.len() < 4 => format!("{} or {last}", others.join(", ")),
                    _ => "a word in quotes".into(),
                }
            }
            _ => "a text in quotes".into(),
        }
    }

    /// Possible words.
    pub fn words(self) -> Vec<&'static str> {
        match self {
            Self::Words(words) => words.iter().map(|w| w.0).collect(),
            Self::Known(_, words) => words().into_iter().map(|w| w.0).collect(),
            Self::Any(_, _, [one]) => one.words(),
            _ => Vec::new(),
        }
    }

    /// A list that is not empty.
    pub const fn some(of: &'static Shape) -> Self {
        Self::List(of, [1, usize::MAX])
    }
}

/// `body` of `a body`.
pub(crate) fn noun(one: &str) -> &str {
    one.split_once(' ').map_or(one, |(_, noun)| noun)
}

/// Plural: `a body`, `bodies`.
pub(crate) fn several(one: &str) -> String {
    let noun = noun(one);
    noun.strip_suffix('y').map_or_else(|| format!("{noun}s"), |stem| format!("{stem}ies"))
}

pub(crate) const NUMBER: Shape = Shape::Number(Quantity::Number);
pub(crate) const LENGTH: Shape = Shape::Number(Quantity::Length);
pub(crate) const ANGLE: Shape = Shape::Number(Quantity::Angle);
pub(crate) const TWO_NUMBERS: Shape = Shape::exactly(2, &NUMBER);
pub(crate) const THREE_NUMBERS: Shape = Shape::exactly(3, &NUMBER);
pub(crate) const BODY: Shape = Shape::Name("a body");
pub(crate) const CASE: Shape = Shape::Name("a case");
pub(crate) const DRIVER: Shape = Shape::Name("a driver");
pub(crate) const HARDPOINT: Shape = Shape::Name("a hardpoint");
pub(crate) const JOINT: Shape = Shape::Name("a joint");
pub(crate) const METRIC: Shape = Shape::Name("a metric");
pub(crate) const VARIABLE: Shape = Shape::Name("a design variable");
pub(crate) const OUTPUT: Shape = Shape::Name("a measure");

/// From one hardpoint to another.
pub(super) const THROUGH: Table = table! {
    /// From the first hardpoint to the second; it follows them when the design changes.
    "Through":
    /// Names of two hardpoints.
    must "through": Shape::exactly(2, &HARDPOINT), "[\"A\", \"B\"]";
};
pub(crate) const AXES: Shape = Shape::Any(
    "Axis",
    "A global axis.",
    &[Shape::Words(&[("x", ""), ("y", ""), ("z", ""), ("-x", ""), ("-y", ""), ("-z", "")])],
);
pub(crate) const DIRECTION: Shape = Shape::Any(
    "FixedDirection",
    "A fixed direction: a global axis or a vector of any length.",
    &[AXES, THREE_NUMBERS],
);
pub(crate) const LINE: Shape = Shape::Any(
    "Direction",
    "A direction: a global axis, a vector of any length, or through two hardpoints.",
    &[AXES, THREE_NUMBERS, Shape::Table(&THROUGH)],
);
pub(crate) const PLACE: Shape = Shape::Any(
    "Place",
    "A hardpoint's name, or global coordinates in the design configuration.",
    &[HARDPOINT, Shape::exactly(3, &LENGTH)],
);

//! Tables of a text with their known keys, and the names of values in messages.

use std::ops::Range;

use toml::Spanned;
use toml::de::DeValue;

use super::format::Key;

pub(crate) type Value<'a> = Spanned<DeValue<'a>>;

/// Maximum number of entries of a table or list, which bounds the run time of any text.
pub(super) const MOST_ENTRIES: usize = 200_000;

/// One `key = value` of a table.
#[derive(Clone, Copy)]
pub(crate) struct Field<'a> {
    pub key: &'static str,
    /// Position of the key.
    pub at: (usize, usize),
    pub value: &'a Value<'a>,
}

/// Known keys of one table of the file.
pub(crate) struct Fields<'a> {
    /// Name of the table in messages: "joint `J1`".
    pub what: String,
    /// Position of its name.
    pub at: Range<usize>,
    pub(super) keys: Vec<&'static Key>,
    pub(super) list: Vec<Field<'a>>,
    /// True if there is another value in place of the table, so that its keys are not reported as missing.
    pub lost: bool,
}

impl<'a> Fields<'a> {
    pub fn get(&self, key: &str) -> Option<Field<'a>> {
        self.list.iter().copied().find(|f| f.key == key)
    }

    pub fn iter(&self) -> impl Iterator<Item = Field<'a>> {
        self.list.iter().copied()
    }

    /// Declaration of a key.
    pub fn key(&self, key: &str) -> &'static Key {
        self.keys.iter().find(|k| k.key == key).expect("only declared keys are read")
    }

    pub fn example(&self, key: &str) -> String {
        format!("`{key} = {}`", self.key(key).example)
    }

    /// Name of a key's value in messages.
    pub fn subject(&self, key: &str) -> Subject {
        Subject {
            name: format!("`{key}` of {}", self.what),
            example: format!("for example {}", self.example(key)),
        }
    }
}

/// Name of a value in messages, and how to write it.
pub(crate) struct Subject {
    pub name: String,
    pub example: String,
}

impl Subject {
    /// Element of a list.
    pub fn item(&self, k: usize) -> Self {
        Self { name: format!("value {} of {}", k + 1, self.name), example: self.example.clone() }
    }
}

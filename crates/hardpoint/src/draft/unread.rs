//! Entries that could not be read.

use std::collections::BTreeMap;

use super::Section;

/// Entries of a draft that could not be read from its text. The check ignores the placeholders in the draft, with all
/// errors that would follow from them, and makes no model.
#[derive(Clone, Debug, Default)]
pub struct UnreadEntries(BTreeMap<(Section, usize), Vec<&'static str>>);

impl UnreadEntries {
    /// Marks a field of an entry as unread: by its name in model files, or an empty name for the whole entry. The
    /// fields of [`Section::Model`] are the tables of the file.
    pub fn note(&mut self, section: Section, index: usize, field: &'static str) {
        self.0.entry((section, index)).or_default().push(field);
    }

    /// True if a field of an entry could not be read.
    pub fn has(&self, section: Section, index: usize, field: &str) -> bool {
        self.0.get(&(section, index)).is_some_and(|fields| fields.iter().any(|f| *f == field || f.is_empty()))
    }

    /// True if any field of an entry could not be read.
    pub fn any(&self, section: Section, index: usize) -> bool {
        self.0.contains_key(&(section, index))
    }

    /// True if any field of any entry of a list could not be read.
    pub(crate) fn any_of(&self, section: Section) -> bool {
        self.0.range((section, 0)..=(section, usize::MAX)).next().is_some()
    }

    /// True if this field of any entry of a list could not be read.
    pub(crate) fn anywhere(&self, section: Section, field: &str) -> bool {
        self.0.iter().any(|((s, _), fields)| *s == section && fields.contains(&field))
    }

    /// True if all entries were read.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

//! Locations in the text of the entries of the model.

use std::ops::Range;

use hardpoint::draft::{DraftLocation, Section};

use super::fields::{Fields, Value};

/// Location of one entry of a list.
#[derive(Clone, Debug)]
pub(crate) struct EntryPlace {
    name: Range<usize>,
    keys: Vec<KeyPlace>,
}

/// Location of a key's value, and of its elements if it is a list.
#[derive(Clone, Debug)]
struct KeyPlace {
    key: &'static str,
    value: Range<usize>,
    items: Vec<Range<usize>>,
}

impl EntryPlace {
    pub fn at(name: Range<usize>) -> Self {
        Self { name, keys: Vec::new() }
    }

    /// Locations of a table's name and of all its values and their elements.
    pub fn of(fields: &Fields<'_>) -> Self {
        let mut place = Self::at(fields.at.clone());
        for f in fields.iter() {
            place.key(f.key, f.value);
        }
        place
    }

    pub fn key(&mut self, key: &'static str, value: &Value<'_>) {
        let items =
            value.get_ref().as_array().map_or(Vec::new(), |list| list.iter().map(|v| v.span()).collect());
        self.keys.push(KeyPlace { key, value: value.span(), items });
    }

    /// Locations of a field's elements if they differ from those of the list.
    pub fn items(&mut self, key: &'static str, items: Vec<Range<usize>>) {
        match self.keys.iter_mut().find(|k| k.key == key) {
            Some(k) => k.items = items,
            None => self.keys.push(KeyPlace { key, value: self.name.clone(), items }),
        }
    }

    /// Locations of a design variable's changes: those of a value, or of its elements.
    pub fn changes(&mut self, fields: &Fields<'_>, key: &str) {
        if let Some(f) = fields.get(key) {
            let list = f.value.get_ref().as_array();
            self.items(
                "changes",
                list.map_or(vec![f.value.span()], |l| l.iter().map(|v| v.span()).collect()),
            );
        }
    }

    pub fn find(&self, key: &str, item: Option<usize>) -> Range<usize> {
        match self.keys.iter().find(|k| k.key == key) {
            Some(k) => item.and_then(|i| k.items.get(i)).unwrap_or(&k.value).clone(),
            None => self.name.clone(),
        }
    }
}

/// Locations of all entries, by section and index in the draft's list.
#[derive(Clone, Debug, Default)]
pub(crate) struct Places(Vec<Vec<EntryPlace>>);

impl Places {
    pub fn list(&self, section: Section) -> &[EntryPlace] {
        self.0.get(section as usize).map_or(&[], Vec::as_slice)
    }

    pub fn push(&mut self, section: Section, place: EntryPlace) {
        let k = section as usize;
        if self.0.len() <= k {
            self.0.resize_with(k + 1, Vec::new);
        }
        self.0[k].push(place);
    }

    /// Range of the text for a location of the draft; `None` if the file has no such entry.
    pub fn find(&self, at: &DraftLocation) -> Option<Range<usize>> {
        Some(self.list(at.section).get(at.index)?.find(at.key, at.item))
    }
}

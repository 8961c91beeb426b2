//! The draft of a model while it is read, with the places of its entries.

use std::collections::HashMap;

use hardpoint::draft::{Draft, MeasureDraft, Section};
use hardpoint::joint::{self, JointType, Quantity};
use hardpoint::law::Law;

use crate::values::{EntryPlace, Places, Reader};

use super::data::{Title, Titles};
use super::drawing::Appearance;
use super::mesh::Meshes;

/// Contents of a file, as far as they could be read.
#[derive(Default)]
pub(crate) struct Raw {
    pub draft: Draft,
    pub description: Option<String>,
    pub drawing: Appearance,
    pub places: Places,
    /// Entries of the bodies' shapes, by name.
    pub meshes: Meshes,
    /// Index of each hardpoint and joint; of equal names, the first. Only used for lookups, never iterated.
    pub hardpoint_numbers: HashMap<String, usize>,
    pub joint_numbers: HashMap<String, usize>,
    /// Quantity that each driver of the draft prescribes.
    pub driven: Vec<Quantity>,
    /// Clearances that have a measure of their name by themselves.
    pub measured_clearances: Vec<String>,
    /// Measures of limits of joints, with their places, and true if the limit could not be read.
    pub limit_measures: Vec<(MeasureDraft, EntryPlace, bool)>,
    /// Drivers without a law of their own, whose laws are in the cases, by their indices in the draft.
    pub without_law: Vec<usize>,
    /// Titles of the columns of targets, after the index of their metric.
    pub target_titles: Vec<(usize, Titles)>,
    /// Titles of the columns of the list of designs.
    pub listed: Vec<Title>,
}

impl Raw {
    /// Law of a driver, and the prescribed quantity.
    pub fn driver(&self, name: &str) -> Option<(&Law, Quantity)> {
        let k = self.draft.drivers.iter().position(|d| d.name == name)?;
        Some((&self.draft.drivers[k].law, self.driven[k]))
    }

    /// Records the location of the next entry of a list of the draft, and its unread keys.
    pub fn push(&mut self, r: &mut Reader<'_>, section: Section, place: EntryPlace) {
        let index = self.places.list(section).len();
        r.unread.drain(..).for_each(|key| self.draft.unread.note(section, index, key));
        self.places.push(section, place);
    }

    /// Type of a joint if it is known; otherwise the core reports it.
    pub fn type_of(&self, joint: &str) -> Option<&'static JointType> {
        joint::named(&self.draft.joints[*self.joint_numbers.get(joint)?].kind)
    }
}

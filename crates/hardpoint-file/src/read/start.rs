//! Placements of bodies at which the assembly starts.

use hardpoint::draft::{Section, StartPlacementDraft};
use hardpoint::space::Vec3;

use crate::values::{ANGLE, EntryPlace, Fields, LENGTH, Reader, Shape, Table, table};

use super::raw::Raw;

pub(crate) const START: Table = table! {
    /// Displacement of a body from its place in the design configuration to the place at which the assembly starts. The
    /// mechanism is closed from there, with all drivers at zero, so that it is assembled on another branch than the one
    /// of the design configuration. Bodies without an entry start in their places in the design configuration.
    "Start":
    /// Rotation vector, global, about the global origin: its direction is the axis, its length the angle.
    or("[0, 0, 0]") "turn": Shape::exactly(3, &ANGLE), "[0, 0, -73.2]";
    /// Translation after the rotation, global.
    or("[0, 0, 0]") "shift": Shape::exactly(3, &LENGTH), "[12.5, 40, 0]";
};

pub(super) fn start(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "start", "body") {
        let fields = r.entry("start of body", &entry, START.keys());
        let place = EntryPlace::of(&fields);
        let turn = r.list_of::<3>(&fields, "turn", "three components of a rotation vector");
        let shift = r.list_of::<3>(&fields, "shift", "three components of a translation");
        raw.push(r, Section::Start, place);
        let [turn, shift] = [turn, shift].map(|v| v.map_or(Vec3::ZERO, |[x, y, z]| Vec3::new(x, y, z)));
        raw.draft.start.push(StartPlacementDraft { body: entry.0, turn, shift });
    }
}

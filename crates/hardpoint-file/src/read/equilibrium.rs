//! The equilibrium that elastic joints and released drivers find.

use hardpoint::draft::{EquilibriumDraft, Section};

use crate::values::{DRIVER, EntryPlace, Fields, Reader, Shape, Table, table};

use super::raw::Raw;

pub(crate) const EQUILIBRIUM: Table = table! {
    /// Static equilibrium at every output time. With this table the directions in which an `elastic_joint` has a
    /// stiffness open under load; all other directions stay rigid. The mechanism is at rest: masses count by their
    /// weight, and dampers do nothing. The solution is the one that the unloaded mechanism reaches as the loads of the
    /// first output time grow, and that continues it from there.
    "Equilibrium":
    /// Names of the drivers whose values springs and loads determine, whatever their laws are.
    or("[]") "released": Shape::list(&DRIVER), "[\"bump\"]";
};

pub(super) fn equilibrium(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    let Some(f) = model.get("equilibrium") else { return };
    let subject = model.subject("equilibrium");
    let Some(table) = r.table(f.value, &subject, "a table, which may be empty") else {
        raw.draft.unread.note(Section::Model, 0, "equilibrium");
        return;
    };
    let fields = r.fields("`equilibrium`", f.value.span(), table, EQUILIBRIUM.keys());
    let mut place = EntryPlace::of(&fields);
    let released = r.list_of_names(&fields, "released", "none").unwrap_or_default();
    let written = fields.get("released").and_then(|f| f.value.get_ref().as_array());
    place.items("released", written.into_iter().flatten().map(|v| v.span()).collect());
    raw.push(r, Section::Equilibrium, place);
    raw.draft.equilibrium = Some(EquilibriumDraft { released });
}

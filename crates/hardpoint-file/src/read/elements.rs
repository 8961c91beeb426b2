//! Sources of loads: masses, forces, gravity.

use std::sync::LazyLock;

use hardpoint::draft::{ElementDraft, ElementKindDraft, ElementType, Section};
use hardpoint::model::LoadMode;

use crate::values::{DIRECTION, EntryPlace, Fields, Key, Kinds, NUMBER, Reader, Shape, Table, table};

use super::declared::{self, key};
use super::raw::Raw;

/// Default acceleration of gravity, m/s^2 (CGPM 1901).
const STANDARD_GRAVITY: f64 = 9.80665;
pub(crate) const GRAVITY: Table = table! {
    /// Gravity.
    "Gravity":
    /// Direction of gravity.
    must "along": DIRECTION, "\"-z\"";
    /// Acceleration, in m/s^2 whatever the unit of length.
    or("9.80665") "acceleration": NUMBER, "9.81";
};
pub(crate) const MASS: Kinds = Kinds {
    name: "Mass",
    doc: "A mass on a body.",
    typed: true,
    tables: || TYPES.iter().filter(|t| t.1.table == "masses").map(|t| &t.0).collect(),
};
pub(crate) const FORCE: Kinds = Kinds {
    name: "Force",
    doc: "A force on bodies.",
    typed: true,
    tables: || TYPES.iter().filter(|t| t.1.table == "forces").map(|t| &t.0).collect(),
};
/// The values of `loads`, in the order of [`LOAD_MODES`].
pub(crate) const LOADS: Shape = Shape::Words(&[
    ("dynamic", "Masses need forces for their accelerations along the motion."),
    (
        "static",
        "At each output time the mechanism is in equilibrium at rest there: no inertia. Dampers and friction keep the speeds of the motion.",
    ),
]);
pub(crate) const LOAD_MODES: [LoadMode; 2] = [LoadMode::Dynamic, LoadMode::Static];
/// Other names of types of masses.
const ALIASES: [(&str, &str, &str); 3] = [
    ("cylinder", "bar", "Another name of `bar`."),
    ("tube", "bar", "Another name of `bar`, which is one with a `bore`."),
    ("box", "block", "Another name of `block`."),
];

/// Types of masses and forces, as declared in the core, with their aliases.
static TYPES: LazyLock<Vec<(Table, &'static ElementType)>> = LazyLock::new(|| {
    let tables = |own: &'static ElementType| {
        let keys: &'static [Key] = own.fields.iter().map(key).collect::<Vec<_>>().leak();
        let others = ALIASES.iter().filter(|(_, of, _)| *of == own.name);
        let others = others.map(|(name, _, summary)| (Table::new(name, summary, keys), own));
        [(Table::new(own.name, own.summary, keys), own)].into_iter().chain(others).collect::<Vec<_>>()
    };
    ElementType::ALL.iter().flat_map(tables).collect()
});

static MASSES: LazyLock<Vec<(Table, &'static ElementType)>> = LazyLock::new(|| of_table("masses"));

static FORCES: LazyLock<Vec<(Table, &'static ElementType)>> = LazyLock::new(|| of_table("forces"));

fn of_table(name: &str) -> Vec<(Table, &'static ElementType)> {
    TYPES.iter().filter(|t| t.1.table == name).copied().collect()
}

pub(super) fn gravity(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    let Some(f) = model.get("gravity") else { return };
    let subject = model.subject("gravity");
    let read = r.table(f.value, &subject, "a table with the direction of gravity").and_then(|table| {
        let fields = r.fields("`gravity`", f.value.span(), table, GRAVITY.keys());
        let along = r.vector_of(&fields, "along");
        let size = r.number_of(&fields, "acceleration").unwrap_or(STANDARD_GRAVITY);
        let along = along?;
        let unit = along.unit();
        if unit.is_none() {
            let at = fields.get("along").map_or(fields.at.clone(), |f| f.value.span());
            r.senseless(at, "the `along` of `gravity` has no direction").help =
                Some("give a non-zero vector, like [0, 0, -1]".into());
        }
        Some(unit? * size)
    });
    if read.is_none() {
        raw.draft.unread.note(Section::Model, 0, "gravity");
    }
    r.unread.clear();
    raw.draft.gravity = read.unwrap_or_default();
}

pub(super) fn masses(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    elements(r, model, ("masses", "mass"), &MASSES, Section::Masses, raw);
}

pub(super) fn forces(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    elements(r, model, ("forces", "force"), &FORCES, Section::Forces, raw);
}

fn elements(
    r: &mut Reader<'_>,
    model: &Fields<'_>,
    (table, one): (&'static str, &str),
    types: &'static [(Table, &'static ElementType)],
    section: Section,
    raw: &mut Raw,
) {
    for entry in r.entries(model, table, one) {
        let (place, kind) = match r.entry_type(one, &entry, types) {
            Some((table, own)) => {
                let fields = r.entry(one, &entry, table.typed_keys());
                let mut place = EntryPlace::of(&fields);
                let mut unread = false;
                let kind =
                    own.draft(|field| declared::own_field(r, raw, field, &fields, &mut place, &mut unread));
                (place, kind.filter(|_| !unread))
            }
            None => (EntryPlace::at(entry.1.clone()), None),
        };
        r.unread.clear();
        if kind.is_none() {
            r.unread.push("");
        }
        raw.push(r, section, place);
        let draft = ElementDraft::new(entry.0, kind.unwrap_or(ElementKindDraft::Unread));
        match section {
            Section::Masses => raw.draft.masses.push(draft),
            _ => raw.draft.forces.push(draft),
        }
    }
}

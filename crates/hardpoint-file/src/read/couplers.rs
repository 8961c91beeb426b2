//! Couplers: gears, racks, belts, and linear relations between joint coordinates.

use hardpoint::draft::{CouplerDraft, CouplerKindDraft, Section, TermDraft};
use hardpoint::joint::Quantity;
use hardpoint::model::Transmission;

use crate::values::{
    EntryPlace, Fields, JOINT, Key, Kinds, LENGTH, NUMBER, Reader, Shape, TWO_NUMBERS, Table, all_read, keys,
    table,
};

use super::joints::COORDINATE;
use super::raw::Raw;

pub(crate) const COUPLER: Kinds = Kinds {
    name: "Coupler",
    doc: "A coupler: it holds a linear relation between joint coordinates, each counted about or along its own joint's axis, of \
          body j relative to body i.",
    typed: true,
    tables: || TYPES.iter().map(|t| &t.0).collect(),
};
type Read = fn(&mut Reader<'_>, &Fields<'_>, &Raw, &mut EntryPlace) -> Option<CouplerKindDraft>;

static TYPES: [(Table, Read); 6] = [
    (
        table! {
            /// Two gears: `teeth[0] angle[0] + teeth[1] angle[1] = 0`, or minus for an internal gear.
            "gear", GEARS
        },
        |r, fields, _, _| gears(r, fields, false),
    ),
    (
        table! {
            /// Two bevel gears, with the same relation as `gear`.
            "bevel", GEARS
        },
        |r, fields, _, _| gears(r, fields, true),
    ),
    (
        table! {
            /// A rack and its pinion: `displacement = radius x angle`.
            "rack", RACK
        },
        |r, fields, _, place| rack(r, fields, place),
    ),
    (
        table! {
            /// Another name of `rack`.
            "rack_and_pinion", RACK
        },
        |r, fields, _, place| rack(r, fields, place),
    ),
    (
        table! {
            /// A belt or chain: `radii[0] angle[0] = radii[1] angle[1]`, or minus for a crossed one.
            "belt", BELT
        },
        |r, fields, _, _| belt(r, fields),
    ),
    (
        table! {
            /// Any linear relation: the sum of `coefficient x coordinate` is zero, or the given constant.
            "linear":
            /// Two terms or more.
            must "terms": Shape::list(&Shape::Table(&TERM)), "[{ joint = \"J1\", coefficient = 2 }, { joint = \"J2\", coefficient = -1 }]";
            /// Value of the sum, in the file's units of coefficient x coordinate. If it is not zero, the
            /// mechanism is assembled to it.
            or("0.0") "constant": NUMBER, "2.5";
        },
        |r, fields, raw, _| linear(r, fields, raw),
    ),
];
const GEARS: &[Key] = keys! {
    /// Names of the two joints that carry the gears; each has an `angle`.
    must "joints": TWO_JOINTS, "[\"J1\", \"J2\"]";
    /// Numbers of teeth, or any two numbers in their ratio.
    must "teeth": TWO_NUMBERS, "[20, 40]";
    /// True if one of them is an internal gear, so that both rotate in the same direction.
    or("false") "internal": Shape::Flag, "true";
};
const RACK: &[Key] = keys! {
    /// Name of the joint on which the rack slides; it has a `displacement`.
    must "rack": JOINT, "\"slide\"";
    /// Name of the joint on which the pinion turns; it has an `angle`.
    must "pinion": JOINT, "\"hinge\"";
    /// Pitch radius, in the length unit; negative if the rack is on the other side of the pinion.
    must "radius": LENGTH, "12.5";
};
const BELT: &[Key] = keys! {
    /// Names of the two joints that carry the pulleys; each has an `angle`.
    must "joints": TWO_JOINTS, "[\"J1\", \"J2\"]";
    /// Radii of the pulleys, in the length unit.
    must "radii": Shape::exactly(2, &LENGTH), "[20, 40]";
    /// True if the belt crosses between them.
    or("false") "crossed": Shape::Flag, "true";
};
const TWO_JOINTS: Shape = Shape::exactly(2, &JOINT);
pub(super) const TERM: Table = table! {
    /// A joint coordinate times a number.
    "Term":
    /// The joint's name.
    must "joint": JOINT, "\"J1\"";
    /// Coordinate of the joint; may be left out if it has only one.
    may "coordinate": COORDINATE, "\"angle\"";
    /// The factor, per unit of the coordinate in this file.
    must "coefficient": NUMBER, "2";
};

pub(super) fn couplers(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "couplers", "coupler") {
        let Some((table, read)) = r.entry_type("coupler", &entry, &TYPES) else { continue };
        let fields = r.entry("coupler", &entry, table.typed_keys());
        let mut place = EntryPlace::of(&fields);
        if let Some(kind) = read(r, &fields, raw, &mut place) {
            raw.push(r, Section::Couplers, place);
            let constant = match kind {
                CouplerKindDraft::Linear(_) => r.number_of(&fields, "constant").unwrap_or_default(),
                CouplerKindDraft::Pair { .. } => 0.0,
            };
            raw.draft.couplers.push(CouplerDraft { name: entry.0, kind, constant });
        }
    }
}

fn gears(r: &mut Reader<'_>, fields: &Fields<'_>, bevel: bool) -> Option<CouplerKindDraft> {
    let joints = r.names_of(fields, "joints");
    let teeth = r.list_of(fields, "teeth", "two numbers of teeth");
    let internal = r.flag_of(fields, "internal");
    let by = Transmission::Gears { teeth: teeth?, internal: internal?, bevel };
    Some(CouplerKindDraft::Pair { by, joints: joints? })
}

fn rack(r: &mut Reader<'_>, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<CouplerKindDraft> {
    let [rack, pinion] = ["rack", "pinion"].map(|key| r.name_of(fields, key));
    let radius = r.number_of(fields, "radius");
    let named = ["rack", "pinion"].iter().filter_map(|key| fields.get(key));
    place.items("joints", named.map(|f| f.value.span()).collect());
    let by = Transmission::Rack { radius: radius? };
    Some(CouplerKindDraft::Pair { by, joints: [rack?, pinion?] })
}

fn belt(r: &mut Reader<'_>, fields: &Fields<'_>) -> Option<CouplerKindDraft> {
    let joints = r.names_of(fields, "joints");
    let radii = r.list_of(fields, "radii", "two radii");
    let crossed = r.flag_of(fields, "crossed");
    let by = Transmission::Belt { radii: radii?, crossed: crossed? };
    Some(CouplerKindDraft::Pair { by, joints: joints? })
}

/// The file's sum of `coefficient x coordinate` is zero in the file's units; so it must be in SI.
fn linear(r: &mut Reader<'_>, fields: &Fields<'_>, raw: &Raw) -> Option<CouplerKindDraft> {
    let terms = r.tables(fields, "terms", &TERM)?;
    let terms = all_read(terms.iter().map(|term| {
        let joint = r.name_of(term, "joint");
        let coordinate = r.name_if(term, "coordinate");
        let coefficient = r.number_of(term, "coefficient");
        let (joint, coordinate) = (joint?, coordinate?);
        let quantity = raw.type_of(&joint).and_then(|kind| kind.quantity_of(coordinate.as_deref()));
        let per_si = r.units.of(quantity.unwrap_or(Quantity::Number)).1;
        Some(TermDraft { joint, coordinate, coefficient: coefficient? * per_si })
    }));
    terms.map(CouplerKindDraft::Linear)
}

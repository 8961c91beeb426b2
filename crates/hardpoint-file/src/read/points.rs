//! Points of bodies: those whose motion is computed, and references to them.

use hardpoint::draft::{LocationDraft, PointDraft, PointRef, Section};
use hardpoint::space::Vec3;

use crate::values::{
    BODY, EntryPlace, Field, Fields, PLACE, Reader, Shape, Subject, Table, Value, all_read, table,
};

use super::raw::Raw;

pub(super) const POINT: Table = table! {
    /// A point of a body.
    "BodyPoint":
    /// The body's name.
    must "body": BODY, "\"crank\"";
    /// Location in the design configuration: a hardpoint's name (the point then follows the hardpoint), or coordinates.
    must "at": PLACE, "\"A\"";
};
pub(super) const POINT_REF: Shape = Shape::Any(
    "Point",
    "A point: by name, or a place on a body.",
    &[Shape::Name("a point"), Shape::Table(&POINT)],
);

pub(super) fn points(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "points", "point") {
        let fields = r.entry("point", &entry, POINT.keys());
        let mut place = EntryPlace::of(&fields);
        let body = r.name_of(&fields, "body").unwrap_or_default();
        let at = r.place_of(&fields, "at");
        place.items("at", Vec::new());
        let at = at.unwrap_or(LocationDraft::At(Vec3::ZERO));
        raw.push(r, Section::Points, place);
        raw.draft.points.push(PointDraft { name: entry.0, body, at });
    }
}

/// A point that a key names.
pub(super) fn point_of(r: &mut Reader<'_>, fields: &Fields<'_>, key: &str) -> Option<PointRef> {
    r.given(fields, key, |r, f| point_ref(r, fields, f))
}

/// A list of points.
pub(super) fn points_of(r: &mut Reader<'_>, fields: &Fields<'_>, key: &str) -> Option<Vec<PointRef>> {
    let (subject, expected) = (fields.subject(key), fields.key(key).shape.noun());
    r.given(fields, key, |r, f| {
        let list = r.list(f.value, &subject, &expected)?;
        all_read(list.into_iter().map(|value| point(r, value, &subject)))
    })
}

pub(super) fn point_ref(r: &mut Reader<'_>, fields: &Fields<'_>, f: Field<'_>) -> Option<PointRef> {
    point(r, f.value, &fields.subject(f.key))
}

fn point(r: &mut Reader<'_>, value: &Value<'_>, subject: &Subject) -> Option<PointRef> {
    let Some(table) = value.get_ref().as_table() else {
        return r.name(value, subject, "a point's name or `{ body = ..., at = ... }`").map(PointRef::Named);
    };
    let fields = r.fields(subject.name.clone(), value.span(), table, POINT.keys());
    let body = r.name_of(&fields, "body");
    let at = r.place_of(&fields, "at");
    Some(PointRef::On { body: body?, at: at? })
}

//! Measures: numbers computed from the motion.

use std::sync::LazyLock;

use hardpoint::draft::{MeasureDraft, MeasureKindDraft, MeasureType, Section};
use hardpoint::model::{AxleMeasure, WheelMeasure, WheelRequirement};

use crate::values::{EntryPlace, Fields, Key, Kinds, Reader, Shape, Table, keys, table};

use super::declared::key;
use super::drawing::DRAW;
use super::raw::Raw;
use super::{declared, drawing};

pub(super) const MEASURE: Shape = Shape::Any(
    "Measure",
    "A measure.",
    &[Shape::Kinds(&OWN_MEASURE), Shape::Table(&OF_WHEEL), Shape::Table(&OF_AXLE)],
);
pub(super) const OWN_MEASURE: Kinds = Kinds {
    name: "OwnMeasure",
    doc: "A measure of anything else.",
    typed: true,
    tables: || MEASURES.iter().filter_map(|(table, kind)| kind.own().map(|_| table)).collect(),
};
const OF_WHEEL: Table = Table {
    shared: WHEEL,
    ..table! {
        /// A measure of a wheel.
        "MeasureOfWheel":
        /// Measured quantity.
        must "type": WHEEL_MEASURE, "\"caster\"";
    }
};
const OF_AXLE: Table = Table {
    shared: AXLE,
    ..table! {
        /// A measure of an axle.
        "MeasureOfAxle":
        /// Measured quantity.
        must "type": AXLE_MEASURE, "\"track\"";
    }
};
const WHEEL: &[Key] = keys! {
    /// The wheel's name.
    must "wheel": Shape::Name("a wheel"), "\"front_left\"";
};
const AXLE: &[Key] = keys! {
    /// The axle's name.
    must "axle": Shape::Name("an axle"), "\"front\"";
};
/// Measures with a shape in drawings.
const DISTANCE: &str = "distance";
const DRAWN: &[Key] = keys! {
    /// Shape in drawings, for springs and dampers as measured distances. It does not affect results.
    may "draw": DRAW, "\"coilover\"";
};
pub(super) const WHEEL_MEASURE: Shape = Shape::Any(
    "WheelMeasure",
    "",
    &[Shape::Known("the name of a measure", || {
        let needs = |m: &WheelMeasure| match m.needs() {
            WheelRequirement::Nothing => "",
            WheelRequirement::Kingpin => " Needs a kingpin.",
            WheelRequirement::Planes => " Needs `arm_planes`.",
            WheelRequirement::Bump => " Needs `bump`.",
            WheelRequirement::Spring => " Needs `bump` and `spring`.",
            WheelRequirement::Steer => " Needs `steer`.",
            WheelRequirement::Braking(_) => " Needs `bump`, and the vehicle's `front_brake_share`.",
            WheelRequirement::Driving(_) => " Needs `bump`, and the vehicle's `front_drive_share`.",
        };
        WheelMeasure::ALL.iter().map(|m| (m.name(), format!("{}{}", m.summary(), needs(m)))).collect()
    })],
);
pub(super) const AXLE_MEASURE: Shape = Shape::Any(
    "AxleMeasure",
    "",
    &[Shape::Known("the name of a measure", || {
        AxleMeasure::ALL.iter().map(|m| (m.name(), m.summary().to_owned())).collect()
    })],
);

/// Meaning of the `type` of a measure: `toe` applies to a wheel, or to a body with a spin axis.
#[derive(Clone, Copy)]
enum MeasureOf {
    Own(&'static MeasureType),
    Wheel(WheelMeasure),
    Axle(AxleMeasure),
    Either(&'static MeasureType, WheelMeasure),
}

impl MeasureOf {
    fn own(self) -> Option<&'static MeasureType> {
        if let Self::Own(own) | Self::Either(own, _) = self { Some(own) } else { None }
    }
}

/// The types of measures, as the core declares them.
static MEASURES: LazyLock<Vec<(Table, MeasureOf)>> = LazyLock::new(|| {
    let own = MeasureType::ALL.iter().map(|own| {
        let keys: Vec<Key> = own.fields.iter().map(key).collect();
        let shared = if own.name == DISTANCE { DRAWN } else { &[] };
        let table = Table { shared, ..Table::new(own.name, own.summary, keys.leak()) };
        match WheelMeasure::named(own.name) {
            Some(what) => (Table { instead: WHEEL, ..table }, MeasureOf::Either(own, what)),
            None => (table, MeasureOf::Own(own)),
        }
    });
    let has_own = |name: &str| MeasureType::ALL.iter().any(|own| own.name == name);
    let of_wheels = WheelMeasure::ALL.iter().filter(|what| !has_own(what.name()));
    let of_wheels =
        of_wheels.map(|what| (Table::new(what.name(), what.summary(), WHEEL), MeasureOf::Wheel(*what)));
    let of_axles = AxleMeasure::ALL
        .iter()
        .map(|what| (Table::new(what.name(), what.summary(), AXLE), MeasureOf::Axle(*what)));
    own.chain(of_wheels).chain(of_axles).collect()
});

pub(super) fn measures(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "measures", "measure") {
        let (place, kind) = match r.entry_type("measure", &entry, &MEASURES) {
            Some((table, of)) => {
                let fields = r.entry("measure", &entry, table.typed_keys());
                let mut place = EntryPlace::of(&fields);
                let kind = measure(r, raw, *of, &fields, &mut place);
                if table.name == DISTANCE
                    && let Some(form) = drawing::form_of(r, &fields)
                {
                    raw.drawing.measures.insert(raw.draft.measures.len(), form);
                }
                (place, kind)
            }
            None => (EntryPlace::at(entry.1.clone()), None),
        };
        r.unread.clear();
        if kind.is_none() {
            r.unread.push("");
        }
        raw.push(r, Section::Measures, place);
        let kind = kind.unwrap_or(MeasureKindDraft::Unread);
        raw.draft.measures.push(MeasureDraft { name: entry.0, kind });
    }
}

fn measure(
    r: &mut Reader<'_>,
    raw: &Raw,
    of: MeasureOf,
    fields: &Fields<'_>,
    place: &mut EntryPlace,
) -> Option<MeasureKindDraft> {
    match of {
        MeasureOf::Either(own, _) if own.fields.iter().any(|f| fields.get(f.key).is_some()) => {
            r.out_of_place(fields, "wheel", "`body` and `spin_axis` define the wheel already");
            own_measure(r, raw, own, fields, place)
        }
        MeasureOf::Own(own) => own_measure(r, raw, own, fields, place),
        MeasureOf::Wheel(what) | MeasureOf::Either(_, what) => {
            r.name_of(fields, "wheel").map(|wheel| MeasureKindDraft::Wheel { wheel, what })
        }
        MeasureOf::Axle(what) => r.name_of(fields, "axle").map(|axle| MeasureKindDraft::Axle { axle, what }),
    }
}

fn own_measure(
    r: &mut Reader<'_>,
    raw: &Raw,
    own: &MeasureType,
    fields: &Fields<'_>,
    place: &mut EntryPlace,
) -> Option<MeasureKindDraft> {
    let mut unread = false;
    let draft = own.draft(|field| declared::own_field(r, raw, field, fields, place, &mut unread));
    draft.filter(|_| !unread)
}

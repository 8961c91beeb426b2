//! Drivers: prescribed quantities and their laws.

use hardpoint::draft::{DrivenDraft, DriverDraft, FormulaDraft, FormulaOf, Section};
use hardpoint::joint::Quantity;
use hardpoint::law::Law;

use crate::values::{
    BODY, EntryPlace, Fields, JOINT, Kinds, LINE, OUTPUT, Reader, Shape, Table, keys, table,
};

use super::joints::COORDINATE;
use super::points::POINT_REF;
use super::raw::Raw;
use super::{law, points};

pub(crate) const DRIVER: Kinds = Kinds {
    name: "Driver",
    doc: "A driver: the prescribed quantity, and its law over time.",
    typed: false,
    tables: || FORMS.iter().map(|f| &f.0).collect(),
};
type Read = fn(&mut Reader<'_>, &Fields<'_>, &mut EntryPlace) -> Option<DrivenDraft>;

/// Driven quantity and its law over time.
macro_rules! driven {
    ($over_time:literal, $counted:literal; $($table:tt)*) => {
        Table {
            shared: keys! {
                #[doc = $over_time]
                #[doc = $counted]
                #[doc = " Optional if every case gives the driver a law or fixes it."]
                may "law": law::LAW, "\"30*sin(2*pi*t)\"";
                /// Origin of the values of this driver's laws.
                or("\"drawing\"") "counted_from": COUNTED, "\"zero\"";
                /// True if the driven quantity moves in the opposite sense of the driver's values.
                or("false") "reversed": Shape::Flag, "true";
            },
            ..table! { $($table)* }
        }
    };
}

const COUNTED: Shape = Shape::Words(&[
    ("drawing", "From the value in the design configuration."),
    ("zero", "From zero: laws give a whole distance, a position, the length of a rod."),
]);

static FORMS: &[(Table, Read)] = &[
    (
        driven! {
            "The coordinate over time, in the file's unit of it", ", counted from the design configuration.";
            /// A joint's coordinate.
            "DrivenCoordinate":
            /// The joint's name; not a rod, whose length is constant.
            must "joint": JOINT, "\"J1\"";
            /// Coordinate of the joint; may be left out if it has only one.
            may "coordinate": COORDINATE, "\"angle\"";
        },
        |r, fields, _| {
            let joint = r.name_of(fields, "joint");
            let coordinate = r.name_if(fields, "coordinate");
            Some(DrivenDraft::Coordinate { joint: joint?, coordinate: coordinate? })
        },
    ),
    (
        driven! {
            "The way over time, in the length unit", ", counted from the design configuration.";
            /// The displacement of a point along a global direction, like wheel travel.
            "DrivenPosition":
            /// The point.
            must "point": POINT_REF, "\"P\"";
            /// The direction, fixed in space.
            must "along": LINE, "\"z\"";
        },
        |r, fields, place| {
            let point = points::point_of(r, fields, "point");
            let along = r.line_of(fields, "along", place);
            Some(DrivenDraft::Position { point: point?, along: along? })
        },
    ),
    (
        driven! {
            "The change of their distance over time, in the length unit", ", counted from the design configuration.";
            /// The change of the distance between two points, like the stroke of an actuator.
            "DrivenDistance":
            /// From this point.
            must "from": POINT_REF, "\"P\"";
            /// To this one.
            must "to": POINT_REF, "\"Q\"";
        },
        |r, fields, _| {
            let [from, to] = ["from", "to"].map(|key| points::point_of(r, fields, key));
            Some(DrivenDraft::Distance { from: from?, to: to? })
        },
    ),
    (
        driven! {
            "The angle over time, in the angle unit", ", counted from the design configuration.";
            /// The rotation angle of a body about a direction.
            "DrivenOrientation":
            /// The body's name.
            must "body": BODY, "\"crank\"";
            /// The direction, fixed in the body `relative_to`.
            must "about": LINE, "\"z\"";
            /// The body that carries the direction. Default: `ground`.
            may "relative_to": BODY, "\"ground\"";
            /// Direction of the body whose angle is prescribed, or its part perpendicular to `about`. Default: from
            /// the global axis that is closest to perpendicular.
            may "axis2": LINE, "\"x\"";
        },
        |r, fields, place| {
            let body = r.name_of(fields, "body");
            let about = r.line_of(fields, "about", place);
            let relative_to = r.name_if(fields, "relative_to");
            let axis2 = fields.get("axis2").map(|_| r.line_of(fields, "axis2", place));
            let axis2 = axis2.map_or(Some(None), |line| line.map(Some));
            Some(DrivenDraft::Orientation {
                body: body?,
                relative_to: relative_to?,
                about: about?,
                axis2: axis2?,
            })
        },
    ),
    (
        driven! {
            "The way over time, in the length unit", ", counted from the design configuration.";
            /// The height of the contact point of a wheel, which the pad of a test rig prescribes.
            "DrivenContact":
            /// The wheel's name.
            must "wheel": Shape::Name("a wheel"), "\"front_left\"";
        },
        |r, fields, _| r.name_of(fields, "wheel").map(DrivenDraft::Contact),
    ),
    (
        driven! {
            "The measure's value over time, in its unit", ".";
            /// The value of a measure: `coordinate`, `position`, `distance`, `toe`, `angle` with `about`; of a wheel
            /// `toe`, `steer_angle`, `wheel_travel` or `wheel_recession`.
            "DrivenMeasure":
            /// The measure's name.
            must "measure": OUTPUT, "\"travel\"";
        },
        |r, fields, _| {
            r.out_of_place(fields, "counted_from", "the law of a measure is the measure's value");
            r.name_of(fields, "measure").map(DrivenDraft::Measure)
        },
    ),
];

pub(super) fn drivers(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "drivers", "driver") {
        let fields = r.entry("driver", &entry, DRIVER.keys());
        let mut place = EntryPlace::of(&fields);
        let words = ["prescribed quantity", "the prescribed quantity is given"];
        let form = r.led_by(&fields, FORMS, words);
        let drives = form.and_then(|(_, read)| read(r, &fields, &mut place));
        let from_zero = r.word_of(&fields, "counted_from") == Some(1);
        let reversed = r.flag_of(&fields, "reversed").unwrap_or(false);
        let law = r.given(&fields, "law", |r, f| law::law(r, &fields, f));
        if fields.get("law").is_none() {
            if model.get("cases").is_some() {
                raw.without_law.push(raw.draft.drivers.len());
            } else {
                r.need(&fields, "law");
                r.unread.push("law");
            }
        }
        let drives = drives.unwrap_or(DrivenDraft::Unread);
        // The core reports an unknown joint or coordinate.
        let quantity = drives.quantity(&raw.draft.measures, |joint| raw.type_of(joint));
        law::check_units(r, quantity);
        let quantity = quantity.unwrap_or(Quantity::Number);
        let law = law.unwrap_or_else(|| Law::constant(0.0)).scaled(r.units.to_si(quantity, 1.0));
        raw.push(r, Section::Drivers, place);
        raw.driven.push(quantity);
        for (parameter, expression) in r.law_formulas.drain(..) {
            raw.draft
                .formulas
                .push(FormulaDraft { of: FormulaOf::Law(entry.0.clone(), parameter), expression });
        }
        let (name, unit) = (entry.0, r.units.of(quantity).0);
        raw.draft.drivers.push(DriverDraft { name, drives, from_zero, reversed, law, unit });
    }
}

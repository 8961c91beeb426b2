//! Drivers: what they prescribe, and by which law.

use hardpoint::draft::{DrivenDraft, DriverDraft, FormulaDraft, FormulaOf, Section};
use hardpoint::joint::Quantity;
use hardpoint::law::Law;

use crate::format::{BODY, JOINT, Kinds, OUTPUT, Shape, Table, keys, table};
use crate::places::EntryPlace;
use crate::read::results::POINT_REF;
use crate::tree::{Fields, LINE, Reader};

use super::{COORDINATE, Raw, law, type_of};

pub(crate) const DRIVER: Kinds = Kinds {
    name: "Driver",
    doc: "A driver: what it prescribes, and its law over the time.",
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
                #[doc = " It may be left out where every case gives the driver a law or holds it."]
                may "law": law::LAW, "\"30*sin(2*pi*t)\"";
                /// Origin of the values of this driver's laws.
                or("\"drawing\"") "counted_from": COUNTED, "\"zero\"";
            },
            ..table! { $($table)* }
        }
    };
}

const COUNTED: Shape = Shape::Words(&[
    ("drawing", "From what it is in the design configuration."),
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
            /// The way of a point along a global direction, like wheel travel.
            "DrivenPosition":
            /// The point.
            must "point": POINT_REF, "\"P\"";
            /// The direction, fixed in space.
            must "along": LINE, "\"z\"";
        },
        |r, fields, place| {
            let point = r.point_of(fields, "point");
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
            let [from, to] = ["from", "to"].map(|key| r.point_of(fields, key));
            Some(DrivenDraft::Distance { from: from?, to: to? })
        },
    ),
    (
        driven! {
            "The angle over time, in the angle unit", ", counted from the design configuration.";
            /// The angle by which a body has turned, seen along a direction.
            "DrivenOrientation":
            /// The body's name.
            must "body": BODY, "\"crank\"";
            /// The direction, fixed in the body `relative_to`.
            must "about": LINE, "\"z\"";
            /// The body that carries the direction. Default: `ground`.
            may "relative_to": BODY, "\"ground\"";
        },
        |r, fields, place| {
            let body = r.name_of(fields, "body");
            let about = r.line_of(fields, "about", place);
            let relative_to = r.name_if(fields, "relative_to");
            Some(DrivenDraft::Orientation { body: body?, relative_to: relative_to?, about: about? })
        },
    ),
    (
        driven! {
            "The measure's value over time, in its unit", ".";
            /// The value of a measure, like wheel travel or a steer angle: a `coordinate`, `position`, `distance`,
            /// `toe` or `angle` seen along `about`; of a wheel its `toe`, `steer_angle`, `wheel_travel` or
            /// `wheel_recession`.
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

impl Reader<'_> {
    pub(super) fn drivers(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "drivers", "driver") {
            let fields = self.entry("driver", &entry, DRIVER.keys());
            let mut place = EntryPlace::of(&fields);
            let says = ["what it prescribes", "what this driver prescribes is given"];
            let form = self.led_by(&fields, FORMS, says);
            let drives = form.and_then(|(_, read)| read(self, &fields, &mut place));
            let from_zero = self.word_of(&fields, "counted_from") == Some(1);
            let law = self.given(&fields, "law", |r, f| r.law(&fields, f));
            if fields.get("law").is_none() {
                if model.get("cases").is_some() {
                    raw.without_law.push(raw.draft.drivers.len());
                } else {
                    self.need(&fields, "law");
                    self.unread.push("law");
                }
            }
            let drives = drives.unwrap_or(DrivenDraft::Unread);
            // The core says what is wrong with a joint or coordinate that is not known.
            let quantity = drives.quantity(&raw.draft.measures, |joint| type_of(raw, joint));
            let quantity = quantity.unwrap_or(Quantity::Number);
            let law = law.unwrap_or_else(|| Law::constant(0.0)).scaled(self.units.to_si(quantity, 1.0));
            self.push(raw, Section::Drivers, place);
            raw.driven.push(quantity);
            for (parameter, expression) in self.law_formulas.drain(..) {
                raw.draft
                    .formulas
                    .push(FormulaDraft { of: FormulaOf::Law(entry.0.clone(), parameter), expression });
            }
            raw.draft.drivers.push(DriverDraft { name: entry.0, drives, from_zero, law });
        }
    }
}

//! Road wheels, and the measures that they list.

use hardpoint::model::{
    Line, MeasureDraft, MeasureKindDraft, Place, PointRef, Section, Side, WheelDraft, WheelMeasure,
    WheelSpinDraft,
};
use hardpoint::space::Vec3;

use super::Raw;
use crate::places::EntryPlace;
use crate::tree::{Field, Fields, Key, Reader};

const WHEEL: &[Key] = &[
    ("body", "\"knuckle\""),
    ("centre", "\"wheel_centre\""),
    ("spin_axis", "[0, 1, 0]"),
    ("toe", "0.1"),
    ("camber", "-1"),
    ("radius", "310"),
    ("side", "\"left\""),
    ("kingpin", "[\"lower_ball\", { body = \"ground\", at = \"strut_top\" }]"),
    ("measures", "[\"toe\", \"camber\"]"),
];
const SIDES: [Side; 2] = [Side::Left, Side::Right];

impl Reader<'_> {
    /// Wheels, and their measures behind those of the model.
    pub(super) fn wheels(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "wheels", "wheel") {
            let fields = self.entry("wheel", &entry, WHEEL);
            let mut place = EntryPlace::of(&fields);
            let body = self.named(&fields, "body", "the name of a body", &mut place).unwrap_or_default();
            let centre = self.need(&fields, "centre");
            let centre = centre.and_then(|f| self.place(f.value, &fields.subject("centre")));
            place.items("centre", Vec::new());
            let spin = self.spin(&fields, &mut place);
            let radius = self.needed_number(&fields, "radius").map(|r| self.units.length.metres(r));
            let side = fields.get("side").map(|f| self.side(&fields, f));
            let kingpin = fields.get("kingpin").map(|f| self.kingpin(&fields, f));
            for (key, lost) in [
                ("centre", centre.is_none()),
                ("spin_axis", spin.is_none()),
                ("radius", radius.is_none()),
                ("side", side == Some(None)),
                ("kingpin", kingpin == Some(None)),
            ] {
                if lost {
                    place.unread(key);
                }
            }
            raw.places.push(Section::Wheels, place);
            self.measures_of(&entry.0, &fields, raw);
            raw.draft.wheels.push(WheelDraft {
                name: entry.0,
                body,
                centre: centre.unwrap_or(Place::At(Vec3::ZERO)),
                spin: spin.unwrap_or(WheelSpinDraft::Axis(Line::Along(Vec3::AXES[1]))),
                radius: radius.unwrap_or(1.0),
                side: side.flatten(),
                kingpin: kingpin.flatten(),
            });
        }
    }

    /// A spin axis, or the angles toe and camber.
    fn spin(&mut self, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<WheelSpinDraft> {
        if let Some(f) = fields.get("spin_axis") {
            for key in ["toe", "camber"] {
                self.out_of_place(
                    fields,
                    key,
                    "it follows from the `spin_axis`; give either that or the angles",
                );
            }
            return self.line_of(fields, f, place).map(WheelSpinDraft::Axis);
        }
        if fields.get("toe").is_none() && fields.get("camber").is_none() {
            let message = format!("{} has no `spin_axis`", fields.what);
            self.report("HP0104", fields.at.clone(), message).help = Some(
                "add it, for example `spin_axis = [0, 1, 0]` for a left wheel, or the angles `toe = 0` and `camber = 0`"
                    .into(),
            );
            return None;
        }
        let [toe, camber] = ["toe", "camber"]
            .map(|key| self.needed_number(fields, key).map(|angle| self.units.angle.radians(angle)));
        Some(WheelSpinDraft::Angles { toe: toe?, camber: camber? })
    }

    fn side(&mut self, fields: &Fields<'_>, f: Field<'_>) -> Option<Side> {
        let subject = fields.subject("side");
        let names = SIDES.map(Side::name);
        let word = self.name(f.value, &subject, "`\"left\"` or `\"right\"`")?;
        let found = SIDES.into_iter().find(|s| s.name() == word);
        if found.is_none() {
            self.unknown_word(f.value.span(), &subject, &word, &names);
        }
        found
    }

    fn kingpin(&mut self, fields: &Fields<'_>, f: Field<'_>) -> Option<[PointRef; 2]> {
        match f.value.get_ref().as_array() {
            Some(list) if list.len() == 2 => {
                let [lower, upper] = [0, 1].map(|k| self.point_ref(fields, Field { value: &list[k], ..f }));
                Some([lower?, upper?])
            }
            _ => {
                self.wrong(f.value, &fields.subject("kingpin"), "a list of a lower and an upper point");
                None
            }
        }
    }

    /// The measures that a wheel lists: `NAME.toe` and so on.
    fn measures_of(&mut self, wheel: &str, fields: &Fields<'_>, raw: &mut Raw) {
        let Some(f) = fields.get("measures") else { return };
        let mut add = |what: WheelMeasure, at| {
            raw.places.push(Section::Measures, EntryPlace::at(at));
            raw.draft.measures.push(MeasureDraft {
                name: format!("{wheel}.{}", what.name()),
                kind: MeasureKindDraft::Wheel { wheel: wheel.to_owned(), what },
            });
        };
        let subject = fields.subject("measures");
        if f.value.get_ref().as_str() == Some("all") {
            let steers = fields.get("kingpin").is_some();
            let possible = WheelMeasure::ALL.iter().filter(|m| steers || !m.needs_kingpin());
            possible.for_each(|m| add(*m, f.value.span()));
            return;
        }
        let expected = "`\"all\"` or a list of measures' names";
        let Some(list) = self.list(f.value, &subject, expected) else { return };
        for value in list {
            let Some(word) = self.name(value, &subject, "the name of a measure") else { continue };
            match WheelMeasure::named(&word) {
                Some(what) => add(what, value.span()),
                None => {
                    let names: Vec<_> = WheelMeasure::ALL.iter().map(|m| m.name()).collect();
                    self.unknown_word(value.span(), &subject, &word, &names);
                }
            }
        }
    }
}

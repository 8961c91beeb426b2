//! Drivers: what they prescribe, and by which law.

use hardpoint::joint::Quantity;
use hardpoint::law::{Law, ParameterKind};
use hardpoint::model::{DrivenDraft, DriverDraft, FormulaDraft, FormulaOf, Section};

use super::{Raw, coordinate_quantity};
use crate::places::EntryPlace;
use crate::tree::{Fields, Key, Reader};

const DRIVER: &[Key] = &[
    ("joint", "\"J1\""),
    ("coordinate", "\"angle\""),
    ("point", "\"P\""),
    ("along", "\"z\""),
    ("from", "\"P\""),
    ("to", "\"Q\""),
    ("body", "\"crank\""),
    ("about", "\"z\""),
    ("relative_to", "\"ground\""),
    ("law", "\"30*sin(2*pi*t)\""),
];
/// The keys of each form of driver.
const FORMS: [(&str, &[&str]); 4] = [
    ("joint", &["joint", "coordinate"]),
    ("point", &["point", "along"]),
    ("from", &["from", "to"]),
    ("body", &["body", "about", "relative_to"]),
];
const FORMS_HELP: &str = "give one of `joint` (a coordinate), `point` and `along` (the way of a point), \
                          `from` and `to` (a distance), `body` and `about` (an angle)";

impl Reader<'_> {
    pub(super) fn drivers(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "drivers", "driver") {
            let fields = self.entry("driver", &entry, DRIVER);
            let mut place = EntryPlace::of(&fields);
            let form = self.form(&fields);
            let drives = form.and_then(|form| self.driven(form, &fields, &mut place));
            let law = self.need(&fields, "law").and_then(|f| self.law(&fields, f));
            if law.is_none() {
                place.unread("law");
            }
            let drives = drives.unwrap_or_else(|| {
                place.unread("joint");
                place.unread("coordinate");
                DrivenDraft::Coordinate { joint: String::new(), coordinate: None }
            });
            let quantity = match &drives {
                DrivenDraft::Coordinate { joint, coordinate } => {
                    coordinate_quantity(raw, joint, coordinate.as_deref())
                }
                DrivenDraft::Position { .. } | DrivenDraft::Distance { .. } => Some(Quantity::Length),
                DrivenDraft::Orientation { .. } => Some(Quantity::Angle),
            };
            // The core says what is wrong with a joint or coordinate that is not known.
            let quantity = quantity.unwrap_or(Quantity::Number);
            let per_unit = self.units.to_si(quantity, 1.0);
            let law = law.unwrap_or_else(|| Law::constant(0.0)).scaled(per_unit);
            let parameters = law.parameters().into_iter();
            let rates = parameters.filter(|p| matches!(p.kind, ParameterKind::ValueRate(_))).map(|p| p.name);
            raw.places.push(Section::Drivers, place);
            raw.driver_rates.push((per_unit, rates.collect(), quantity));
            for (parameter, expression) in self.law_formulas.drain(..) {
                raw.draft
                    .formulas
                    .push(FormulaDraft { of: FormulaOf::Law(entry.0.clone(), parameter), expression });
            }
            raw.draft.drivers.push(DriverDraft { name: entry.0, drives, law });
        }
    }

    /// Which form of driver the keys mean; keys of another one are reported.
    fn form(&mut self, fields: &Fields<'_>) -> Option<&'static str> {
        let has = |key: &&str| fields.get(key).is_some();
        let led = FORMS.iter().find(|(lead, _)| has(lead));
        let Some((form, own)) = led.or_else(|| FORMS.iter().find(|(_, keys)| keys.iter().any(&has))) else {
            let message = format!("{} does not say what it prescribes", fields.what);
            self.report("HP0104", fields.at.clone(), message).help =
                Some(format!("{FORMS_HELP}; for example `joint = \"J1\"`"));
            return None;
        };
        let by = own.iter().find(|k| has(k)).unwrap_or(form);
        for (lead, keys) in FORMS.iter().filter(|f| f.0 != *form) {
            for key in keys.iter().filter(|k| has(k)) {
                let why = match fields.get(lead) {
                    Some(_) => format!("what this driver prescribes is given by `{by}` already"),
                    None => {
                        format!("`{key}` goes with `{lead}`; what this driver prescribes is given by `{by}`")
                    }
                };
                self.out_of_place(fields, key, why);
                if let Some(d) = self.found.last_mut() {
                    d.help = Some(FORMS_HELP.into());
                }
            }
        }
        Some(form)
    }

    fn driven(&mut self, form: &str, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<DrivenDraft> {
        Some(match form {
            "joint" => {
                let joint = self.named(fields, "joint", "the name of a joint", place);
                let coordinate = self.optional_name(fields, "coordinate", "the name of a coordinate", place);
                DrivenDraft::Coordinate { joint: joint?, coordinate }
            }
            "point" => {
                let point = self.need(fields, "point").and_then(|f| self.point_ref(fields, f));
                let along = self.need(fields, "along").and_then(|f| self.line_of(fields, f, place));
                DrivenDraft::Position { point: point?, along: along? }
            }
            "from" => {
                let [from, to] =
                    ["from", "to"].map(|key| self.need(fields, key).and_then(|f| self.point_ref(fields, f)));
                DrivenDraft::Distance { from: from?, to: to? }
            }
            _ => {
                let body = self.named(fields, "body", "the name of a body", place);
                let about = self.need(fields, "about").and_then(|f| self.line_of(fields, f, place));
                let relative_to = match fields.get("relative_to") {
                    Some(f) => {
                        Some(self.name(f.value, &fields.subject("relative_to"), "the name of a body")?)
                    }
                    None => None,
                };
                DrivenDraft::Orientation { body: body?, relative_to, about: about? }
            }
        })
    }
}

//! Parameters: named numbers for expressions, which are design variables unless they say otherwise.

use std::ops::Range;

use hardpoint::joint::Quantity;
use hardpoint::model::{ChangeDraft, FormulaDraft, FormulaOf, ParameterDraft, Section, VariableDraft};
use toml::de::DeValue;

use super::Raw;
use crate::diagnostic::shown;
use crate::places::EntryPlace;
use crate::tree::{Fields, Key, Reader, Subject, Value};

const PARAMETER: &[Key] = &[
    ("value", "60"),
    ("unit", "\"length\""),
    ("bounds", "[50, 70]"),
    ("typical", "2"),
    ("tolerance", "0.1"),
    ("design", "false"),
];
const UNITS: [(&str, Quantity); 3] =
    [("length", Quantity::Length), ("angle", Quantity::Angle), ("number", Quantity::Number)];

impl Reader<'_> {
    pub(super) fn parameters(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "parameters", "parameter") {
            let (name, at, value) = &entry;
            match value.get_ref() {
                DeValue::Table(_) => self.parameter_table(&entry, raw),
                _ => {
                    let subject = Subject {
                        name: format!("parameter `{}`", shown(name)),
                        example: format!("for example `{name} = {{ value = 60, unit = \"length\" }}`"),
                    };
                    let mut place = EntryPlace::at(at.clone());
                    place.key("value", value);
                    let parameter = Parameter { name, quantity: Quantity::Number, is_design: true };
                    self.parameter(&parameter, Some((value, subject)), None, place, raw);
                }
            }
        }
    }

    fn parameter_table(&mut self, entry: &(String, Range<usize>, &Value<'_>), raw: &mut Raw) {
        let fields = self.entry("parameter", entry, PARAMETER);
        let place = EntryPlace::of(&fields);
        let quantity = fields.get("unit").and_then(|f| {
            let subject = fields.subject("unit");
            let word = self.name(f.value, &subject, "`\"length\"`, `\"angle\"` or `\"number\"`")?;
            let found = UNITS.iter().find(|u| u.0 == word);
            if found.is_none() {
                self.unknown_word(f.value.span(), &subject, &word, &UNITS.map(|u| u.0));
            }
            found.map(|u| u.1)
        });
        let is_design = fields.get("design").and_then(|f| self.boolean(f.value, &fields.subject("design")));
        let value = self.need(&fields, "value").map(|f| (f.value, fields.subject("value")));
        let parameter = Parameter {
            name: &entry.0,
            quantity: quantity.unwrap_or(Quantity::Number),
            is_design: is_design.unwrap_or(true),
        };
        self.parameter(&parameter, value, Some(&fields), place, raw);
    }

    fn parameter(
        &mut self,
        p: &Parameter<'_>,
        value: Option<(&Value<'_>, Subject)>,
        fields: Option<&Fields<'_>>,
        mut place: EntryPlace,
        raw: &mut Raw,
    ) {
        let name = p.name.to_owned();
        let formula = value.as_ref().is_some_and(|(v, _)| v.get_ref().is_str());
        let number = value.and_then(|(v, subject)| {
            if !formula {
                return self.number(v, &subject).map(|x| self.units.to_si(p.quantity, x));
            }
            let expression = self.expression(v, &subject)?;
            raw.draft.formulas.push(FormulaDraft { of: FormulaOf::Parameter(name.clone()), expression });
            Some(0.0)
        });
        if number.is_none() {
            place.unread("value");
        }
        let number = number.unwrap_or(1.0);
        if let (Some(fields), true) = (fields, formula || !p.is_design) {
            let why = match formula {
                true => {
                    "a parameter that an expression gives follows others, and is no design variable of its own"
                }
                false => "with `design = false` it is no design variable",
            };
            let keys = ["bounds", "typical", "tolerance", "design"];
            let keys = if formula { &keys[..] } else { &keys[..3] };
            keys.iter().for_each(|key| self.out_of_place(fields, key, why));
        } else if p.is_design && !formula {
            let (bounds, [typical, tolerance]) = match fields {
                Some(fields) => self.range(fields, p.quantity, &mut place),
                None => (None, [None; 2]),
            };
            raw.places.push(Section::Design, place.clone());
            raw.draft.design.push(VariableDraft {
                name: name.clone(),
                changes: vec![ChangeDraft::Parameter { parameter: name.clone(), rate: 1.0 }],
                bounds: bounds.map(|b| b.map(|x| x - number)),
                typical,
                tolerance,
                ..VariableDraft::default()
            });
        }
        raw.places.push(Section::Parameters, place);
        raw.draft.parameters.push(ParameterDraft { name, value: number, quantity: p.quantity });
    }

    /// A number that may be left out; noted as unread where it is there and none.
    fn number_in(&mut self, fields: &Fields<'_>, key: &'static str, place: &mut EntryPlace) -> Option<f64> {
        let f = fields.get(key)?;
        let number = self.number(f.value, &fields.subject(key));
        if number.is_none() {
            place.unread(key);
        }
        number
    }

    /// The bounds, the typical size and the tolerance of a design variable that measures this, in SI.
    pub(super) fn range(
        &mut self,
        fields: &Fields<'_>,
        quantity: Quantity,
        place: &mut EntryPlace,
    ) -> (Option<[f64; 2]>, [Option<f64>; 2]) {
        let units = self.units;
        let bounds = fields.get("bounds").and_then(|f| {
            let bounds =
                self.numbers::<2>(f.value, &fields.subject("bounds"), "the lower and the upper bound");
            if bounds.is_none() {
                place.unread("bounds");
            }
            bounds.map(|b| b.map(|x| units.to_si(quantity, x)))
        });
        let sizes = ["typical", "tolerance"].map(|key| {
            let size = self.number_in(fields, key, place);
            size.map(|x| units.to_si(quantity, x))
        });
        (bounds, sizes)
    }

    /// An angle in rad: a number is in the file's unit, an expression gives radians.
    pub(super) fn angle_of(&self, value: &Value<'_>, x: f64) -> f64 {
        if value.get_ref().is_str() { x } else { self.units.angle.radians(x) }
    }
}

/// What is known of a parameter besides its value.
struct Parameter<'n> {
    name: &'n str,
    quantity: Quantity,
    is_design: bool,
}

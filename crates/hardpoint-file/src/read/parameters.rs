//! Parameters: named numbers for expressions, which are design variables by default.

use std::ops::Range;

use hardpoint::draft::{ChangeDraft, FormulaDraft, FormulaOf, ParameterDraft, Section, VariableDraft};
use hardpoint::joint::Quantity;
use toml::de::DeValue;

use crate::values::{
    EntryPlace, Fields, NUMBER, Reader, Shape, Subject, TWO_NUMBERS, Table, Value, shown, table,
};

use super::raw::Raw;

pub(crate) const PARAMETER: Shape = Shape::Any(
    "Parameter",
    "A plain number, or a table with its value and more.",
    &[NUMBER, Shape::Table(&PARAMETER_TABLE)],
);
pub(super) const PARAMETER_TABLE: Table = table! {
    /// A named number.
    "ParameterTable":
    /// Value; with an expression it depends on other parameters.
    must "value": NUMBER, "60";
    /// Quantity of the value, which defines its unit.
    or("\"number\"") "unit": UNIT, "\"length\"";
    /// Lower and upper bound.
    may "bounds": TWO_NUMBERS, "[50, 70]";
    /// Typical size of a change, used to compare variables.
    may "typical": NUMBER, "2";
    /// Manufacturing tolerance, plus or minus.
    may "tolerance": NUMBER, "0.1";
    /// True if it is a design variable.
    or("true") "design": Shape::Flag, "false";
};
const UNIT: Shape = Shape::Words(&[
    ("length", "In the file's unit of length."),
    ("angle", "In the file's unit of angle; in expressions in rad."),
    ("number", "A plain number."),
]);
const UNITS: [Quantity; 3] = [Quantity::Length, Quantity::Angle, Quantity::Number];

pub(super) fn parameters(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "parameters", "parameter") {
        let (name, at, value) = &entry;
        match value.get_ref() {
            DeValue::Table(_) => parameter_table(r, &entry, raw),
            _ => {
                let subject = Subject {
                    name: format!("parameter `{}`", shown(name)),
                    example: format!("for example `{name} = {{ value = 60, unit = \"length\" }}`"),
                };
                r.unread.clear();
                let mut place = EntryPlace::at(at.clone());
                place.key("value", value);
                let declared = Parameter { name, quantity: Quantity::Number, is_design: true };
                parameter(r, &declared, Some((value, subject)), None, place, raw);
            }
        }
    }
}

fn parameter_table(r: &mut Reader<'_>, entry: &(String, Range<usize>, &Value<'_>), raw: &mut Raw) {
    let fields = r.entry("parameter", entry, PARAMETER_TABLE.keys());
    let place = EntryPlace::of(&fields);
    let quantity = r.word_of(&fields, "unit").map(|k| UNITS[k]);
    let is_design = r.flag_of(&fields, "design");
    let value = r.need(&fields, "value").map(|f| (f.value, fields.subject("value")));
    let declared = Parameter {
        name: &entry.0,
        quantity: quantity.unwrap_or(Quantity::Number),
        is_design: is_design.unwrap_or(true),
    };
    parameter(r, &declared, value, Some(&fields), place, raw);
}

fn parameter(
    r: &mut Reader<'_>,
    p: &Parameter<'_>,
    value: Option<(&Value<'_>, Subject)>,
    fields: Option<&Fields<'_>>,
    place: EntryPlace,
    raw: &mut Raw,
) {
    let name = p.name.to_owned();
    let formula = value.as_ref().is_some_and(|(v, _)| v.get_ref().is_str());
    let number = value.and_then(|(v, subject)| {
        if !formula {
            return r.number(v, &subject).map(|x| r.units.to_si(p.quantity, x));
        }
        let expression = r.expression(v, &subject)?;
        raw.draft.formulas.push(FormulaDraft { of: FormulaOf::Parameter(name.clone()), expression });
        Some(0.0)
    });
    if number.is_none() {
        r.unread.push("value");
    }
    let number = number.unwrap_or(1.0);
    if let (Some(fields), true) = (fields, formula || !p.is_design) {
        let why = match formula {
            true => "a parameter with an expression depends on others, and is not a design variable",
            false => "with `design = false` it is not a design variable",
        };
        let keys = ["bounds", "typical", "tolerance", "design"];
        let keys = if formula { &keys[..] } else { &keys[..3] };
        keys.iter().for_each(|key| r.out_of_place(fields, key, why));
    } else if p.is_design && !formula {
        let (bounds, [typical, tolerance]) = match fields {
            Some(fields) => range(r, fields, p.quantity),
            None => (None, [None; 2]),
        };
        let unread = r.unread.clone();
        raw.push(r, Section::Design, place.clone());
        r.unread = unread;
        raw.draft.design.push(VariableDraft {
            name: name.clone(),
            changes: vec![ChangeDraft::Parameter { parameter: name.clone(), rate: 1.0 }],
            bounds: bounds.map(|b| b.map(|x| x - number)),
            typical,
            tolerance,
            ..VariableDraft::default()
        });
    }
    raw.push(r, Section::Parameters, place);
    raw.draft.parameters.push(ParameterDraft { name, value: number, quantity: p.quantity });
}

/// Bounds, typical size and tolerance of a design variable of this quantity, in SI.
pub(super) fn range(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    quantity: Quantity,
) -> (Option<[f64; 2]>, [Option<f64>; 2]) {
    let units = r.units;
    let bounds = r.list_of::<2>(fields, "bounds", "the lower and the upper bound");
    let bounds = bounds.map(|b| b.map(|x| units.to_si(quantity, x)));
    let sizes = ["typical", "tolerance"].map(|key| {
        let size = r.number_of(fields, key);
        size.map(|x| units.to_si(quantity, x))
    });
    (bounds, sizes)
}

/// Properties of a parameter besides its value.
struct Parameter<'n> {
    name: &'n str,
    quantity: Quantity,
    is_design: bool,
}

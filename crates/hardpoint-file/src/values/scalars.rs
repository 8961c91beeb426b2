//! Single values: names, numbers, expressions, locations and directions.

use std::ops::Range;

use hardpoint::draft::{ConstantError, LocationDraft};
use hardpoint::expression::Expression;
use hardpoint::joint::Quantity;
use hardpoint::space::Vec3;
use toml::de::{DeArray, DeValue};

use super::diagnostic::closest;
use super::fields::{Field, Fields, Subject, Value};
use super::format::{LENGTH, NUMBER, Shape};
use super::reader::Reader;

/// Maximum length of a name.
const LONGEST_NAME: usize = 100;
/// Alternative to coordinates.
const NAME_OR: &str = "a hardpoint's name or ";

impl Reader<'_> {
    /// A number, converted to SI if its form is a length or an angle; an expression returns radians.
    pub fn quantity(&mut self, value: &Value<'_>, subject: &Subject, shape: Shape) -> Option<f64> {
        let x = self.number(value, subject)?;
        Some(match shape {
            Shape::Number(Quantity::Angle) if value.get_ref().is_str() => x,
            Shape::Number(quantity) | Shape::Plain(quantity) => self.units.to_si(quantity, x),
            _ => x,
        })
    }

    pub fn boolean(&mut self, value: &Value<'_>, subject: &Subject) -> Option<bool> {
        let b = value.get_ref().as_bool();
        if b.is_none() {
            self.wrong(value, subject, "`true` or `false`");
        }
        b
    }

    /// A text that is a name.
    pub fn name(&mut self, value: &Value<'_>, subject: &Subject, expected: &str) -> Option<String> {
        match value.get_ref().as_str() {
            Some(s) => self.short(s, value.span(), &subject.name),
            None => {
                self.wrong(value, subject, expected);
                None
            }
        }
    }

    /// A name, unless it is too long to be one.
    pub fn short(&mut self, s: &str, at: Range<usize>, what: &str) -> Option<String> {
        let count = s.chars().count();
        if count > LONGEST_NAME {
            let message = format!("{what} is {count} characters long");
            self.senseless(at, message).notes.push(format!("names have at most {LONGEST_NAME} characters"));
            return None;
        }
        Some(s.to_owned())
    }

    /// An expression in quotes, whose lengths are in the file's unit.
    pub fn expression(&mut self, value: &Value<'_>, subject: &Subject) -> Option<Expression> {
        let text = value.get_ref().as_str()?;
        if is_number_with_unit(text) {
            let units = self.units;
            self.wrong(value, subject, "a number");
            if let Some(d) = self.found.last_mut() {
                d.help = Some(format!(
                    "write the number without quotes and unit; lengths of this file are in {}, angles in {}",
                    units.length.symbol(),
                    units.angle.symbol()
                ));
            }
            return None;
        }
        match Expression::parse(text) {
            Ok(expression) => Some(expression.with_unit(self.units.length.per_metre())),
            Err(error) => {
                let at = self.inside(value, text, error.span);
                let message = format!("{} cannot be read: {}", subject.name, error.message);
                self.report("HP0113", at, message).help = error.help;
                None
            }
        }
    }

    /// Value of an expression that must not depend on the design.
    fn constant(&mut self, value: &Value<'_>, subject: &Subject) -> Option<f64> {
        let expression = self.expression(value, subject)?;
        if !expression.names().is_empty() && self.nominal.names().next().is_none() {
            self.wrong(value, subject, "a number");
            return None;
        }
        match self.nominal.constant(&expression) {
            Ok(x) => Some(x),
            Err(why) => {
                self.no_constant(value, subject, why);
                None
            }
        }
    }

    /// HP0204, HP0230: an expression that has no value here.
    pub fn no_constant(&mut self, value: &Value<'_>, subject: &Subject, why: ConstantError) {
        let at = value.span();
        match why {
            ConstantError::Unknown(name) if name.contains('.') => {
                let message = format!("{} cannot use `{name}`, a coordinate of a hardpoint", subject.name);
                self.report("HP0230", at, message).help =
                    Some("coordinates can be used in places of hardpoints and joints, in lengths of rods, and in parameters".into());
            }
            ConstantError::Unknown(name) => {
                let close = closest(&name, self.nominal.names()).map(|c| format!("did you mean `{c}`?"));
                self.report("HP0204", at, format!("there is no parameter named `{name}`")).help = close;
            }
            ConstantError::Follows(name, what) => {
                let message = format!("{} cannot follow parameter `{name}`", subject.name);
                let d = self.report("HP0230", at, message);
                d.notes
                    .push(format!("{what} changes `{name}`, and what is here is the same in every design"));
                d.help =
                    Some("write `design = false` for the parameter that changes, or a number here".into());
            }
            ConstantError::NotFinite => {
                self.senseless(at, format!("{} is not a finite number", subject.name));
            }
            // Its own errors are reported at its location.
            ConstantError::Faulty => {}
        }
    }

    /// Position in the file of a part of a text; of the whole text if escapes make that unclear.
    pub fn inside(&self, value: &Value<'_>, text: &str, part: Range<usize>) -> Range<usize> {
        let whole = value.span();
        let written = self.source.text.get(whole.clone()).unwrap_or_default();
        for quote in ["\"\"\"", "'''", "\"", "'"] {
            let bare = written.strip_prefix(quote).and_then(|w| w.strip_suffix(quote));
            if bare == Some(text) {
                let start = whole.start + quote.len();
                return start + part.start..start + part.end;
            }
        }
        whole
    }

    /// A finite number as written, or an expression over parameters that do not depend on the design.
    pub fn number(&mut self, value: &Value<'_>, subject: &Subject) -> Option<f64> {
        let x = match value.get_ref() {
            DeValue::Integer(i) if i.radix() == 10 => i.as_str().parse().ok(),
            DeValue::Integer(i) => i64::from_str_radix(i.as_str(), i.radix()).ok().map(|i| i as f64),
            DeValue::Float(f) => f.as_str().parse::<f64>().ok(),
            DeValue::String(_) => return self.constant(value, subject),
            _ => {
                self.wrong(value, subject, "a number");
                return None;
            }
        };
        match x {
            Some(x) if x.is_finite() => Some(x),
            _ => {
                self.senseless(value.span(), format!("{} is not a finite number", subject.name));
                None
            }
        }
    }

    /// Exactly `N` numbers, as written; `expected` describes them.
    pub fn numbers<const N: usize>(
        &mut self,
        value: &Value<'_>,
        subject: &Subject,
        expected: &str,
    ) -> Option<[f64; N]> {
        self.quantities(value, subject, expected, NUMBER)
    }

    /// Exactly `N` numbers, converted to SI if their form is a length or an angle.
    pub fn quantities<const N: usize>(
        &mut self,
        value: &Value<'_>,
        subject: &Subject,
        expected: &str,
        shape: Shape,
    ) -> Option<[f64; N]> {
        self.quantities_of(value, subject, [expected, &N.to_string()], shape)
    }

    /// Exactly `N` numbers; `count` is the permitted number of them.
    fn quantities_of<const N: usize>(
        &mut self,
        value: &Value<'_>,
        subject: &Subject,
        [expected, count]: [&str; 2],
        shape: Shape,
    ) -> Option<[f64; N]> {
        let list = self.exactly(value, subject, [expected, count], N)?;
        let mut numbers = [0.0; N];
        let mut complete = true;
        for (k, v) in list.iter().enumerate() {
            match self.quantity(v, &subject.item(k), shape) {
                Some(x) => numbers[k] = x,
                None => complete = false,
            }
        }
        complete.then_some(numbers)
    }

    /// A list of `n` values; `count` is the permitted number of them.
    pub fn exactly<'v, 'a>(
        &mut self,
        value: &'v Value<'a>,
        subject: &Subject,
        [expected, count]: [&str; 2],
        n: usize,
    ) -> Option<&'v DeArray<'a>> {
        let list = value.get_ref().as_array();
        let found = list.filter(|list| list.len() == n);
        if found.is_none() {
            self.wrong(value, subject, expected);
            if let (Some(list), Some(d)) = (list, self.found.last_mut()) {
                let n = list.len();
                d.label = Some(format!("{n} value{} instead of {count}", if n == 1 { "" } else { "s" }));
            }
        }
        found
    }

    /// Global coordinates, in m. `or` describes what else is permitted.
    pub fn coordinates(&mut self, value: &Value<'_>, subject: &Subject, or: &str) -> Option<Vec3> {
        let [expected, count] = match self.plane.is_some() {
            // The third of two coordinates was added before.
            true => ["two or three coordinates", "2 or 3"],
            false => ["three coordinates", "3"],
        };
        self.quantities_of(value, subject, [&format!("{or}{expected}"), count], LENGTH).map(Vec3::from)
    }

    /// Name of a hardpoint, or coordinates.
    pub fn place(&mut self, value: &Value<'_>, subject: &Subject) -> Option<LocationDraft> {
        match value.get_ref() {
            DeValue::String(name) => {
                self.short(name, value.span(), &subject.name).map(LocationDraft::Hardpoint)
            }
            _ => self.written_place(value, subject, NAME_OR),
        }
    }

    /// Same as [`place`](Self::place), but independent of the design.
    pub fn fixed_place(&mut self, value: &Value<'_>, subject: &Subject) -> Option<LocationDraft> {
        match value.get_ref() {
            DeValue::String(_) => self.place(value, subject),
            _ => self.coordinates(value, subject, NAME_OR).map(LocationDraft::At),
        }
    }

    /// Global coordinates, each a number or an expression. `or` describes what else is permitted.
    pub fn written_place(&mut self, value: &Value<'_>, subject: &Subject, or: &str) -> Option<LocationDraft> {
        let list = value.get_ref().as_array().filter(|list| list.len() == 3);
        let Some(list) = list.filter(|list| list.iter().any(|v| v.get_ref().is_str())) else {
            return self.coordinates(value, subject, or).map(LocationDraft::At);
        };
        let per_metre = self.units.length.per_metre();
        let coordinates = [0, 1, 2].map(|k| {
            let (v, subject) = (&list[k], subject.item(k));
            match v.get_ref().is_str() {
                true => self.expression(v, &subject),
                false => self.number(v, &subject).map(|x| Expression::constant(x).with_unit(per_metre)),
            }
        });
        let [x, y, z] = coordinates;
        Some(LocationDraft::Formula(Box::new([x?, y?, z?])))
    }

    /// A direction by name or vector, of any length.
    pub fn vector(&mut self, value: &Value<'_>, subject: &Subject) -> Option<Vec3> {
        match value.get_ref() {
            DeValue::String(word) => {
                let v = axis_named(word);
                if v.is_none() {
                    self.unknown_word(value.span(), subject, word, &["x", "y", "z", "-x", "-y", "-z"]);
                }
                v
            }
            DeValue::Table(_) => {
                self.wrong(value, subject, "a fixed direction: `\"x\"`, `\"y\"`, `\"z\"` or three numbers");
                None
            }
            _ => self.numbers::<3>(value, subject, "a direction: `\"z\"` or three numbers").map(Vec3::from),
        }
    }

    pub fn text(&mut self, fields: &Fields<'_>, f: Field<'_>) -> Option<String> {
        let text = f.value.get_ref().as_str().map(str::to_owned);
        if text.is_none() {
            self.wrong(f.value, &fields.subject(f.key), "a text in quotes");
        }
        text
    }
}

/// True if a text is a plain number, or one with a unit, as in `100 mm`: probably a mistake.
fn is_number_with_unit(text: &str) -> bool {
    let text = text.trim();
    if text.parse::<f64>().is_ok() {
        return true;
    }
    let number = text.strip_prefix(['+', '-']).unwrap_or(text);
    let rest = number.trim_start_matches(|c: char| c.is_ascii_digit() || ".,".contains(c));
    // What begins with an `e` may be the exponent of a longer expression.
    let rest = rest.trim();
    rest.len() < number.len()
        && rest.chars().next().is_none_or(|c| (c.is_alphabetic() && !"eE".contains(c)) || c == '\u{b0}')
}

/// `"x"` to `"-z"`.
pub(crate) fn axis_named(word: &str) -> Option<Vec3> {
    let (sign, letter) = match word.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, word.strip_prefix('+').unwrap_or(word)),
    };
    let k = ["x", "y", "z"].iter().position(|l| *l == letter)?;
    Some(Vec3::AXES[k] * sign)
}

//! Reads typed values from a parsed TOML tree, with a diagnostic for each invalid one.
//!
//! Reading does not stop at the first problem: an invalid value is reported and left out.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use hardpoint::draft::{ConstantError, DirectionDraft, LocationDraft, Nominal};
use hardpoint::expression::Expression;
use hardpoint::joint::Quantity;
use hardpoint::space::Vec3;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::diagnostic::{Diagnostic, Severity, Source, closest, shown};
use crate::format::{HARDPOINT, Key, LENGTH, NUMBER, Need, Shape, THREE_NUMBERS, Table, table};
use crate::read::BodyMesh;
use crate::read::mirror::Origins;
use hardpoint_table::Units;

pub(crate) type Value<'a> = Spanned<DeValue<'a>>;

/// Maximum length of a name.
const LONGEST_NAME: usize = 100;
/// Maximum number of problems with a suggestion, and of names that it is chosen from.
const GUESSED_PROBLEMS: usize = 50;
const GUESSED_NAMES: usize = 5000;
/// Maximum number of entries of a table or list, which bounds the run time of any text.
pub(crate) const MOST_ENTRIES: usize = 200_000;

/// One `key = value` of a table.
#[derive(Clone, Copy)]
pub(crate) struct Field<'a> {
    pub key: &'static str,
    /// Position of the key.
    pub at: (usize, usize),
    pub value: &'a Value<'a>,
}

/// Known keys of one table of the file.
pub(crate) struct Fields<'a> {
    /// Name of the table in messages: "joint `J1`".
    pub what: String,
    /// Position of its name.
    pub at: Range<usize>,
    keys: Vec<&'static Key>,
    list: Vec<Field<'a>>,
    /// True if there is another value in place of the table, so that its keys are not reported as missing.
    pub lost: bool,
}

impl<'a> Fields<'a> {
    pub fn get(&self, key: &str) -> Option<Field<'a>> {
        self.list.iter().copied().find(|f| f.key == key)
    }

    pub fn iter(&self) -> impl Iterator<Item = Field<'a>> {
        self.list.iter().copied()
    }

    /// Declaration of a key.
    pub fn key(&self, key: &str) -> &'static Key {
        self.keys.iter().find(|k| k.key == key).expect("only declared keys are read")
    }

    pub fn example(&self, key: &str) -> String {
        format!("`{key} = {}`", self.key(key).example)
    }

    /// Name of a key's value in messages.
    pub fn subject(&self, key: &str) -> Subject {
        Subject {
            name: format!("`{key}` of {}", self.what),
            example: format!("for example {}", self.example(key)),
        }
    }
}

/// From one hardpoint to another.
const THROUGH: Table = table! {
    /// From the first hardpoint to the second; it follows them when the design changes.
    "Through":
    /// Names of two hardpoints.
    must "through": Shape::exactly(2, &HARDPOINT), "[\"A\", \"B\"]";
};
pub(crate) const AXES: Shape = Shape::Any(
    "Axis",
    "A global axis.",
    &[Shape::Words(&[("x", ""), ("y", ""), ("z", ""), ("-x", ""), ("-y", ""), ("-z", "")])],
);
pub(crate) const DIRECTION: Shape = Shape::Any(
    "FixedDirection",
    "A fixed direction: a global axis or a vector of any length.",
    &[AXES, THREE_NUMBERS],
);
pub(crate) const LINE: Shape = Shape::Any(
    "Direction",
    "A direction: a global axis, a vector of any length, or through two hardpoints.",
    &[AXES, THREE_NUMBERS, Shape::Table(&THROUGH)],
);
pub(crate) const PLACE: Shape = Shape::Any(
    "Place",
    "A hardpoint's name, or global coordinates in the design configuration.",
    &[HARDPOINT, Shape::exactly(3, &LENGTH)],
);

/// Name of a value in messages, and how to write it.
pub(crate) struct Subject {
    pub name: String,
    pub example: String,
}

impl Subject {
    /// Element of a list.
    pub fn item(&self, k: usize) -> Self {
        Self { name: format!("value {} of {}", k + 1, self.name), example: self.example.clone() }
    }
}

/// Texts of files, by their names in the model.
pub type Texts = BTreeMap<String, String>;

/// Source of the files that a model names.
#[derive(Clone, Copy)]
pub(crate) enum Folder<'f> {
    /// No files: the model is a text only.
    None,
    /// In this folder or below it.
    On(&'f Path),
    /// Files given with the text; for meshes their mass properties.
    Given(&'f Texts),
}

/// The text being read, and its diagnostics.
pub(crate) struct Reader<'s> {
    pub source: &'s Source,
    /// Source of the files that it names.
    pub folder: Folder<'s>,
    /// Texts of these files that were read, by their names in the model.
    pub texts: Texts,
    pub units: Units,
    /// Values of the file's parameters, once they are read.
    pub nominal: Nominal,
    /// Entries of the bodies' shapes, by name.
    pub meshes: BTreeMap<String, BodyMesh>,
    /// Size of all included files in bytes.
    pub included: u64,
    /// Mirror images, by name.
    pub origins: Origins,
    /// Parameters of the current law that are given by expressions, with these expressions.
    pub law_formulas: Vec<(String, Expression)>,
    pub found: Vec<Diagnostic>,
    /// Missing or invalid keys of the current entry.
    pub unread: Vec<&'static str>,
    /// Warnings and notes on a valid model.
    pub remarks: Vec<Diagnostic>,
}

impl<'s> Reader<'s> {
    pub fn new(source: &'s Source, folder: Folder<'s>) -> Self {
        let (units, nominal) = (Units::default(), Nominal::default());
        let (texts, meshes, origins, law_formulas, found, unread, remarks) = Default::default();
        Self {
            source,
            folder,
            texts,
            units,
            nominal,
            meshes,
            included: 0,
            origins,
            law_formulas,
            found,
            unread,
            remarks,
        }
    }
}

impl Reader<'_> {
    pub fn report(
        &mut self,
        code: &'static str,
        at: Range<usize>,
        message: impl Into<String>,
    ) -> &mut Diagnostic {
        // The model as a whole has no location of its own.
        let at = Some(at).filter(|at| *at != (0..0));
        self.found.push(self.source.diagnostic(Severity::Error, code, message, at));
        self.found.last_mut().expect("just pushed")
    }

    /// Adds a warning or note on a valid model.
    pub fn remark(
        &mut self,
        severity: Severity,
        code: &'static str,
        at: Range<usize>,
        message: impl Into<String>,
    ) -> &mut Diagnostic {
        self.remarks.push(self.source.diagnostic(severity, code, message, Some(at)));
        self.remarks.last_mut().expect("just pushed")
    }

    /// HP0105: a value of the wrong type or shape.
    pub fn wrong(&mut self, value: &Value<'_>, subject: &Subject, expected: &str) {
        let message = format!("{} must be {expected}", subject.name);
        let d = self.report("HP0105", value.span(), message);
        d.label = Some(format!("this is {}", kind(value.get_ref())));
        d.help = Some(subject.example.clone());
    }

    /// HP0106: an unknown word.
    pub fn unknown_word(&mut self, at: Range<usize>, subject: &Subject, word: &str, known: &[&str]) {
        let message = format!("{} cannot be `{}`", subject.name, shown(word));
        let close = closest(word, known.iter().copied());
        let d = self.report("HP0106", at, message);
        d.notes.push(format!("possible: {}", quoted(known)));
        d.help = close.map(|c| format!("did you mean `{c}`?"));
    }

    /// HP0109: an invalid value of the right type.
    pub fn senseless(&mut self, at: Range<usize>, message: impl Into<String>) -> &mut Diagnostic {
        self.report("HP0109", at, message)
    }

    /// Fields of a table; unknown keys are reported. A misspelt key is read as the intended one, so that it is reported
    /// once and not again as missing.
    pub fn fields<'a>(
        &mut self,
        what: impl Into<String>,
        at: Range<usize>,
        table: &'a DeTable<'a>,
        keys: impl IntoIterator<Item = &'static Key>,
    ) -> Fields<'a> {
        let keys: Vec<&'static Key> = keys.into_iter().collect();
        let mut fields = Fields { what: what.into(), at, keys: keys.clone(), list: Vec::new(), lost: false };
        let names = || keys.iter().map(|k| k.key);
        let known = |key: &str| names().find(|k| *k == key);
        for (key, value) in table.iter().take(MOST_ENTRIES) {
            let at = (key.span().start, key.span().end);
            if let Some(key) = known(key.get_ref()) {
                fields.list.push(Field { key, at, value });
            }
        }
        for (key, value) in table.iter().take(MOST_ENTRIES) {
            let name = key.get_ref();
            if known(name).is_some() {
                continue;
            }
            let missing: Vec<_> = names().filter(|k| fields.get(k).is_none()).collect();
            let close = closest(name, missing.iter().copied());
            let what = &fields.what;
            let message = match close {
                Some(close) => format!("unknown key `{}` in {what}; did you mean `{close}`?", shown(name)),
                None => format!("unknown key `{}` in {what}", shown(name)),
            };
            let list: Vec<_> = names().collect();
            let d = self.report("HP0103", key.span(), message);
            d.notes.push(format!("valid keys: {}", quoted(&list)));
            if close.is_none() {
                let remove = || format!("remove `{}`", shown(name));
                d.help = Some(above_tables(name).unwrap_or_else(remove));
            }
            let at = (key.span().start, key.span().end);
            if let Some(key) = missing.into_iter().find(|k| Some(*k) == close) {
                fields.list.push(Field { key, at, value });
            }
        }
        if table.len() > MOST_ENTRIES {
            let what = fields.what.clone();
            self.too_many(fields.at.clone(), &what, table.len());
        }
        fields
    }

    /// Reports a missing key (HP0104).
    pub fn need<'a>(&mut self, fields: &Fields<'a>, key: &str) -> Option<Field<'a>> {
        let field = fields.get(key);
        if field.is_none() && !fields.lost {
            let example = fields.example(key);
            self.report("HP0104", fields.at.clone(), format!("{} has no `{key}`", fields.what)).help =
                Some(format!("add it, for example {example}"));
        }
        field
    }

    /// Reports a key that contradicts the others (HP0107).
    pub fn out_of_place(&mut self, fields: &Fields<'_>, key: &str, why: impl Into<String>) {
        if let Some(field) = fields.get(key) {
            let message = format!("`{key}` has no meaning in {}", fields.what);
            self.report("HP0107", field.at.0..field.at.1, message).notes.push(why.into());
        }
    }

    /// Most similar name. After many problems, and among too many names, there is no suggestion, to save time.
    pub fn guess<'n>(&self, name: &str, names: impl Iterator<Item = &'n str> + Clone) -> Option<&'n str> {
        let worth = self.found.len() < GUESSED_PROBLEMS
            && names.clone().take(GUESSED_NAMES + 1).count() <= GUESSED_NAMES;
        if worth { closest(name, names) } else { None }
    }

    pub fn too_many(&mut self, at: Range<usize>, what: &str, count: usize) {
        self.senseless(at, format!("{what} has {count} entries"))
            .notes
            .push(format!("at most {MOST_ENTRIES} are read"));
    }

    pub fn table<'a>(
        &mut self,
        value: &'a Value<'a>,
        subject: &Subject,
        expected: &str,
    ) -> Option<&'a DeTable<'a>> {
        let table = value.get_ref().as_table();
        if table.is_none() {
            self.wrong(value, subject, expected);
        }
        table
    }

    pub fn list<'a>(
        &mut self,
        value: &'a Value<'a>,
        subject: &Subject,
        expected: &str,
    ) -> Option<Vec<&'a Value<'a>>> {
        let Some(list) = value.get_ref().as_array() else {
            self.wrong(value, subject, expected);
            return None;
        };
        if list.len() > MOST_ENTRIES {
            self.too_many(value.span(), &subject.name, list.len());
            return None;
        }
        Some(list.iter().collect())
    }

    /// Value of a key, if there is one. A missing or invalid value is recorded as unread.
    pub fn given<'a, T>(
        &mut self,
        fields: &Fields<'a>,
        key: &str,
        read: impl FnOnce(&mut Self, Field<'a>) -> Option<T>,
    ) -> Option<T> {
        let declared = fields.key(key);
        let value = match fields.get(key) {
            None if declared.need != Need::Required => return None,
            None => self.need(fields, key).and(None),
            Some(f) => read(self, f),
        };
        if value.is_none() {
            self.unread.push(declared.key);
        }
        value
    }

    /// Value of a key, or its declared default.
    fn declared<'a, T>(
        &mut self,
        fields: &Fields<'a>,
        key: &str,
        read: impl FnOnce(&mut Self, Field<'a>, Shape) -> Option<T>,
        default: impl FnOnce(&'static str) -> Option<T>,
    ) -> Option<T> {
        let Key { shape, need, .. } = *fields.key(key);
        match need {
            Need::Else(text) if fields.get(key).is_none() => default(text),
            _ => self.given(fields, key, |r, f| read(r, f, shape)),
        }
    }

    /// A number, converted to SI if it is declared as a length or an angle.
    pub fn number_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<f64> {
        self.declared(
            fields,
            key,
            |r, f, shape| r.quantity(f.value, &fields.subject(f.key), shape),
            |text| text.parse().ok(),
        )
    }

    pub fn numbers_of<const N: usize>(&mut self, fields: &Fields<'_>, keys: [&str; N]) -> Option<[f64; N]> {
        let found = keys.map(|key| self.number_of(fields, key));
        found.iter().all(Option::is_some).then(|| found.map(Option::unwrap_or_default))
    }

    /// A number, converted to SI if its form is a length or an angle; an expression returns radians.
    fn quantity(&mut self, value: &Value<'_>, subject: &Subject, shape: Shape) -> Option<f64> {
        let x = self.number(value, subject)?;
        Some(match shape {
            Shape::Number(Quantity::Angle) if value.get_ref().is_str() => x,
            Shape::Number(quantity) | Shape::Plain(quantity) => self.units.to_si(quantity, x),
            _ => x,
        })
    }

    /// `true` or `false`.
    pub fn flag_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<bool> {
        self.declared(
            fields,
            key,
            |r, f, _| r.boolean(f.value, &fields.subject(f.key)),
            |text| Some(text == "true"),
        )
    }

    /// A name.
    pub fn name_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<String> {
        self.declared(
            fields,
            key,
            |r, f, shape| r.name(f.value, &fields.subject(f.key), &shape.noun()),
            |text| serde_json::from_str(text).ok(),
        )
    }

    /// An optional name. `None` if it is invalid.
    pub fn name_if(&mut self, fields: &Fields<'_>, key: &str) -> Option<Option<String>> {
        let name = self.name_of(fields, key);
        (name.is_some() || fields.get(key).is_none()).then_some(name)
    }

    /// Names in a list of fixed length.
    pub fn names_of<const N: usize>(&mut self, fields: &Fields<'_>, key: &str) -> Option<[String; N]> {
        let (subject, expected) = (fields.subject(key), fields.key(key).shape.noun());
        self.given(fields, key, |r, f| match f.value.get_ref().as_array() {
            Some(list) if list.len() == N => {
                let names: Vec<_> = list.iter().map(|v| r.name(v, &subject, &expected)).collect();
                names.into_iter().collect::<Option<Vec<_>>>()?.try_into().ok()
            }
            _ => {
                r.wrong(f.value, &subject, &expected);
                None
            }
        })
    }

    /// A fixed number of numbers, converted to SI if they are declared as lengths or angles.
    pub fn list_of<const N: usize>(
        &mut self,
        fields: &Fields<'_>,
        key: &str,
        expected: &str,
    ) -> Option<[f64; N]> {
        let Shape::List(of, _) = fields.key(key).shape else { return None };
        self.given(fields, key, |r, f| r.quantities(f.value, &fields.subject(key), expected, *of))
    }

    /// Index of one of the possible words.
    pub fn word_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<usize> {
        let words = fields.key(key).shape.words();
        let place = |word: &str| words.iter().position(|w| *w == word);
        self.declared(
            fields,
            key,
            |r, f, shape| {
                let subject = fields.subject(f.key);
                let word = r.name(f.value, &subject, &shape.noun())?;
                let found = place(&word);
                if found.is_none() {
                    r.unknown_word(f.value.span(), &subject, &word, &words);
                }
                found
            },
            |text| place(text.trim_matches('"')),
        )
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
    fn quantities<const N: usize>(
        &mut self,
        value: &Value<'_>,
        subject: &Subject,
        expected: &str,
        shape: Shape,
    ) -> Option<[f64; N]> {
        let list = value.get_ref().as_array();
        let Some(list) = list.filter(|list| list.len() == N) else {
            self.wrong(value, subject, expected);
            if let (Some(list), Some(d)) = (list, self.found.last_mut()) {
                let n = list.len();
                d.label = Some(format!("{n} value{} instead of {N}", if n == 1 { "" } else { "s" }));
            }
            return None;
        };
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

    /// Global coordinates, in m.
    pub fn coordinates(&mut self, value: &Value<'_>, subject: &Subject, expected: &str) -> Option<Vec3> {
        self.quantities(value, subject, expected, LENGTH).map(Vec3::from)
    }

    /// Name of a hardpoint, or coordinates.
    pub fn place(&mut self, value: &Value<'_>, subject: &Subject) -> Option<LocationDraft> {
        let expected = "a hardpoint's name or three coordinates";
        match value.get_ref() {
            DeValue::String(name) => {
                self.short(name, value.span(), &subject.name).map(LocationDraft::Hardpoint)
            }
            _ => self.written_place(value, subject, expected),
        }
    }

    /// Same as [`place`](Self::place), but independent of the design.
    pub fn fixed_place(&mut self, value: &Value<'_>, subject: &Subject) -> Option<LocationDraft> {
        match value.get_ref() {
            DeValue::String(_) => self.place(value, subject),
            _ => self
                .coordinates(value, subject, "a hardpoint's name or three coordinates")
                .map(LocationDraft::At),
        }
    }

    /// Global coordinates, each a number or an expression.
    pub fn written_place(
        &mut self,
        value: &Value<'_>,
        subject: &Subject,
        expected: &str,
    ) -> Option<LocationDraft> {
        let list = value.get_ref().as_array().filter(|list| list.len() == 3);
        let Some(list) = list.filter(|list| list.iter().any(|v| v.get_ref().is_str())) else {
            return self.coordinates(value, subject, expected).map(LocationDraft::At);
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

    /// Direction under a key.
    pub fn vector_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<Vec3> {
        self.given(fields, key, |r, f| r.vector(f.value, &fields.subject(f.key)))
    }

    /// A direction, or `{ through = [...] }`, with the locations of the two hardpoints' names.
    pub fn line(
        &mut self,
        value: &Value<'_>,
        subject: &Subject,
    ) -> Option<(DirectionDraft, Vec<Range<usize>>)> {
        let Some(table) = value.get_ref().as_table() else {
            return self.vector(value, subject).map(|v| (DirectionDraft::Along(v), Vec::new()));
        };
        let fields = self.fields(subject.name.clone(), value.span(), table, THROUGH.keys());
        let [a, b] = self.names_of::<2>(&fields, "through")?;
        let items = fields.get("through").and_then(|f| f.value.get_ref().as_array());
        Some((DirectionDraft::Through(a, b), items.into_iter().flatten().map(Spanned::span).collect()))
    }
}

/// True if a text is a plain number, or one with a unit, as in `100 mm`: probably a mistake.
fn is_number_with_unit(text: &str) -> bool {
    let text = text.trim();
    if text.parse::<f64>().is_ok() {
        return true;
    }
    let number = text.trim_start_matches(['+', '-']);
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

/// Suggested fix for a key of the model that is below a `[table]` and so became a part of it.
pub(crate) fn above_tables(name: &str) -> Option<String> {
    ["name", "description", "units"]
        .contains(&name)
        .then(|| format!("`{name}` belongs to the model as a whole: write it above the first `[...]` line"))
}

pub(crate) fn quoted(words: &[&str]) -> String {
    words.iter().map(|w| format!("`{w}`")).collect::<Vec<_>>().join(", ")
}

/// Kind of a value, in words.
fn kind(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(s) if s.is_empty() => "an empty text".into(),
        DeValue::String(_) => "a text".into(),
        DeValue::Integer(_) | DeValue::Float(_) => "a number".into(),
        DeValue::Boolean(b) => format!("`{b}`"),
        DeValue::Datetime(_) => "a date or time".into(),
        DeValue::Array(list) => match list.len() {
            0 => "an empty list".into(),
            1 => "a list of one value".into(),
            n => format!("a list of {n} values"),
        },
        DeValue::Table(_) => "a table".into(),
    }
}

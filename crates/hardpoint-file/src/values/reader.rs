//! The reader of one model: its text, its units, and the diagnostics of the values that it reads.
//!
//! Reading does not stop at the first problem: an invalid value is reported and left out.

use std::ops::Range;

use hardpoint::draft::Nominal;
use hardpoint::expression::Expression;
use toml::de::DeValue;

use hardpoint_table::Units;

use super::diagnostic::{Diagnostic, Severity, Source, closest, shown};
use super::fields::{MOST_ENTRIES, Subject, Value};
use super::files::{DataError, Folder, Texts, Wanted, bytes_of, text_from};

/// Maximum number of problems with a suggestion, and of names that it is chosen from.
const GUESSED_PROBLEMS: usize = 50;
const GUESSED_NAMES: usize = 5000;

/// The text being read, and its diagnostics.
pub(crate) struct Reader<'s> {
    pub source: &'s Source,
    /// Source of the files that it names.
    pub folder: Folder<'s>,
    /// Texts of these files that were read, by their names in the model.
    pub texts: Texts,
    pub units: Units,
    /// Name of the plane of a model whose points may have two coordinates.
    pub plane: Option<&'static str>,
    /// Values of the file's parameters, once they are read.
    pub nominal: Nominal,
    /// Parameters of the current law that are given by expressions, with these expressions.
    pub law_formulas: Vec<(String, Expression)>,
    /// Columns of the tables of the current law, by name and unit, with the places of these tables.
    pub law_units: Vec<(Range<usize>, [String; 2])>,
    pub found: Vec<Diagnostic>,
    /// Missing or invalid keys of the current entry.
    pub unread: Vec<&'static str>,
    /// Warnings and notes on a valid model.
    pub remarks: Vec<Diagnostic>,
}

impl<'s> Reader<'s> {
    pub fn new(source: &'s Source, folder: Folder<'s>) -> Self {
        let (units, nominal) = (Units::default(), Nominal::default());
        let (texts, law_formulas, law_units, found, unread, remarks) = Default::default();
        let plane = None;
        Self { source, folder, texts, units, plane, nominal, law_formulas, law_units, found, unread, remarks }
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
    pub fn unknown_word(
        &mut self,
        at: Range<usize>,
        subject: &Subject,
        word: &str,
        known: &[&str],
    ) -> &mut Diagnostic {
        let message = format!("{} cannot be `{}`", subject.name, shown(word));
        let close = closest(word, known.iter().copied());
        let d = self.report("HP0106", at, message);
        d.notes.push(format!("possible: {}", quoted(known)));
        d.help = close.map(|c| format!("did you mean `{c}`?"));
        d
    }

    /// HP0109: an invalid value of the right type.
    pub fn senseless(&mut self, at: Range<usize>, message: impl Into<String>) -> &mut Diagnostic {
        self.report("HP0109", at, message)
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

    /// Reports an error of a data file, at the place that names the file.
    pub fn data_error(&mut self, at: Range<usize>, e: DataError) {
        let d = self.report(e.code, at, e.message);
        d.notes = e.notes;
        d.help = e.help;
    }

    /// Text of a file in the model's folder or below it; it is stored with the model.
    pub fn text_of_file(&mut self, name: &str, wanted: &Wanted<'_>) -> Result<&str, DataError> {
        let text = text_from(bytes_of(self.folder, name, wanted)?, name)?;
        Ok(self.texts.entry(name.to_owned()).insert_entry(text).into_mut())
    }
}

/// All values, if each could be read. Those after an invalid one are read too, so that their errors are reported.
pub(crate) fn all_read<T>(values: impl Iterator<Item = Option<T>>) -> Option<Vec<T>> {
    let values: Vec<Option<T>> = values.collect();
    values.into_iter().collect()
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

//! From the text of a file to a checked model, or to all diagnostics.

use std::ops::Range;
use std::path::Path;

use hardpoint::draft::{DraftError, Section};
use hardpoint::model::Model;
use serde::Deserialize;
use toml::Spanned;
use toml::de::DeTable;

use crate::compose::{
    Files, IncludeError, Part, Plane, deduplicated, opposites, parts_of, shifted, texts_of, whole,
};
use crate::values::{
    Diagnostic, Diagnostics, Folder, LARGEST_FILE, Places, Reader, Severity, Source, Texts, in_order,
    neighbours, shown,
};

use super::model::{MODEL, model};
use super::model_file::ModelFile;
use super::{metrics, sweep};

/// Maximum number of syntax errors that are shown: later ones usually follow from the first.
const SYNTAX_ERRORS: usize = 5;

/// Error of reading a model.
#[derive(Debug)]
pub enum ReadError {
    /// The file could not be opened or is not a text.
    Unreadable(Diagnostics),
    /// The text is not a valid model.
    Invalid(Diagnostics),
}

impl ReadError {
    /// Diagnostics to report.
    pub fn diagnostics(&self) -> &Diagnostics {
        match self {
            Self::Unreadable(d) | Self::Invalid(d) => d,
        }
    }
}

impl std::fmt::Display for ReadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.diagnostics().fmt(f)
    }
}

impl std::error::Error for ReadError {}

/// Reads and checks a model file.
///
/// # Errors
/// Returns the errors of the file or of its model.
pub fn read(path: &Path) -> Result<ModelFile, ReadError> {
    let (text, name) = text_of(path)?;
    parse_in(path.parent(), &text, &name).map_err(ReadError::Invalid)
}

/// Text of a file, and its name.
pub(super) fn text_of(path: &Path) -> Result<(String, String), ReadError> {
    let name = path.display().to_string();
    let bytes = bytes_of(path).map_err(|(message, note, help)| {
        let source = Source::new(&name, "");
        let mut d = source.diagnostic(Severity::Error, "HP0101", message, None);
        d = note.into_iter().fold(d, Diagnostic::note);
        d = help.into_iter().fold(d, Diagnostic::help);
        ReadError::Unreadable(Diagnostics::new(source, vec![d]))
    })?;
    match String::from_utf8(bytes) {
        Ok(text) => Ok((text, name)),
        Err(error) => {
            let valid = error.utf8_error().valid_up_to();
            let bytes = error.into_bytes();
            let line = 1 + bytes[..valid].iter().filter(|b| **b == b'\n').count();
            let source = Source::new(&name, "");
            let d = source
                .diagnostic(Severity::Error, "HP0101", "the file is not a text in UTF-8", None)
                .note(format!("byte {} (on line {line}) is {:#04x}", valid + 1, bytes[valid]))
                .help("save the model as UTF-8 text; Hardpoint reads TOML files");
            Err(ReadError::Unreadable(Diagnostics::new(source, vec![d])))
        }
    }
}

/// Bytes of the file, or message, note and help.
fn bytes_of(path: &Path) -> Result<Vec<u8>, (String, Option<String>, Option<String>)> {
    use std::io::Read;
    let shown = path.display();
    let io = |e: std::io::Error| match e.kind() {
        std::io::ErrorKind::NotFound => {
            let (note, help) = neighbours(path, "toml");
            (format!("there is no file `{shown}`"), note, help)
        }
        std::io::ErrorKind::PermissionDenied => {
            (format!("the file `{shown}` may not be read"), None, Some("check its permissions".into()))
        }
        _ => (format!("the file `{shown}` cannot be read"), Some(e.to_string()), None),
    };
    let meta = std::fs::metadata(path).map_err(io)?;
    if meta.is_dir() {
        let (note, _) = neighbours(&path.join("x"), "toml");
        return Err((format!("`{shown}` is a folder"), note, Some("name a model file".into())));
    }
    let too_large = |size: String| {
        let limit = LARGEST_FILE >> 20;
        let note = format!("it has {size}; at most {limit} MiB are read");
        (format!("the file `{shown}` is too large for a model"), Some(note), None)
    };
    if meta.len() > LARGEST_FILE {
        return Err(too_large(format!("{} MiB", meta.len() >> 20)));
    }
    // A pipe or device has no known length.
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(io)?;
    file.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(io)?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(too_large(format!("more than {} MiB", LARGEST_FILE >> 20)));
    }
    Ok(bytes)
}

/// Reads and checks the text of a model file; `file_name` is for the diagnostics only. A text has no folder, so
/// the laws and bodies in it may not name files; [`read`] reads those too.
///
/// # Errors
/// Returns all its errors, in the order of the text.
///
/// ```
/// let diagnostics = hardpoint_file::parse("nmae = \"x\"", "x.toml").unwrap_err();
/// let first = &diagnostics.list()[0];
/// assert_eq!((first.code, first.line), ("HP0104", None));
/// ```
pub fn parse(text: &str, file_name: &str) -> Result<ModelFile, Diagnostics> {
    parsed(Folder::None, text, file_name)
}

/// Parses a text with the files that it names ([`ModelFile::texts`]); drawings have no meshes.
///
/// # Errors
/// As [`parse`].
pub fn parse_with(text: &str, file_name: &str, files: &Texts) -> Result<ModelFile, Diagnostics> {
    parsed(Folder::Given(files), text, file_name)
}

/// Parses a text whose file is in `folder`, so that it may name files there.
///
/// # Errors
/// As [`parse`].
pub fn parse_in(folder: Option<&Path>, text: &str, file_name: &str) -> Result<ModelFile, Diagnostics> {
    parsed(folder.map_or(Folder::None, Folder::On), text, file_name)
}

/// Parses a text with the files that it names ([`ModelFile::texts`]); all others are read from `folder`.
///
/// # Errors
/// As [`parse`].
pub fn parse_over(
    folder: &Path,
    files: &Texts,
    text: &str,
    file_name: &str,
) -> Result<ModelFile, Diagnostics> {
    parsed(Folder::Over(folder, files), text, file_name)
}

pub(crate) fn parsed(folder: Folder<'_>, text: &str, file_name: &str) -> Result<ModelFile, Diagnostics> {
    let source = Source::new(file_name, text);
    if text.trim().is_empty() {
        let d = source
            .diagnostic(Severity::Error, "HP0104", "the file is empty", None)
            .help("a model has `name`, `units`, `[hardpoints]`, `[bodies]`, `[joints]` and `[time]`");
        return Err(Diagnostics::new(source, vec![d]));
    }
    let (parts, hindrances) = parts_of(folder, text);
    let beside = |name: &str| match Path::new(file_name).parent() {
        Some(folder) => folder.join(name).display().to_string(),
        None => name.to_owned(),
    };
    let others = parts.iter().map(|part| (beside(&part.name), part.text.as_str()));
    let source = Source::of_files(file_name, text, others);
    let mut list = Vec::new();
    for IncludeError { file, at, error } in hindrances {
        let start = source.range(file).start;
        let at = at.start + start..at.end + start;
        list.push(error.diagnostic(&source, Some(at)));
    }
    let tables = tables_of(&source, &parts, &mut list);
    if !list.is_empty() {
        drop(tables);
        return Err(Diagnostics::new(source, list));
    }
    let numbers = opposites(tables.iter().map(|file| &file.1));
    let sizes = (0..tables.len()).map(|file| source.range(file).len() as u64).collect();
    let files = Files { tables, numbers: &numbers, sizes };
    let mut reader = Reader::new(&source, folder);
    reader.texts = texts_of(&parts);
    let (whole, origins) = whole(&mut reader, &MODEL, files);
    if !reader.found.is_empty() {
        // References to its missing entries are not reported.
        let found = std::mem::take(&mut reader.found);
        let note = "correct this first; then the rest of the model is checked";
        let list = found.into_iter().map(|d| d.note(note)).collect();
        return Err(Diagnostics::new(source.clone(), list));
    }
    let plane = Plane::of(&whole.table);
    let raw = model(&mut reader, &whole.table, &whole.twins);
    let (units, texts) = (reader.units, reader.texts);
    let remarks = deduplicated(reader.remarks, &origins);
    let mut found = reader.found;
    let list = raw.draft.sweeping.as_ref().and_then(|sweeping| sweeping.designs.as_ref());
    let model = match Model::from_draft(&raw.draft) {
        Ok(model) => {
            let wrong = list.and_then(|list| sweep::wrong_unit(&model, units, list, &raw.listed));
            let wrong = wrong.into_iter().chain(metrics::wrong_units(&model, units, &raw.target_titles));
            found.extend(wrong.map(|fault| shown_fault(&source, &raw.places, fault)));
            Some(model)
        }
        Err(faults) => {
            found.extend(faults.into_iter().map(|f| shown_fault(&source, &raw.places, f)));
            None
        }
    };
    let found = deduplicated(found, &origins);
    match model {
        Some(model) if found.is_empty() => {
            let (description, drawing, places) = (raw.description, raw.drawing, raw.places);
            let mut file = ModelFile {
                plane,
                limits: ModelFile::limits_of(&model),
                model,
                units,
                description,
                drawing,
                remarks,
                texts,
                origins,
                case: None,
                source,
                places,
            };
            file.remarks.extend(file.weightless());
            file.remarks.extend(file.open_bushings());
            file.remarks.extend(file.falling_curves());
            file.remarks.extend(file.kinked_curves());
            file.remarks = in_order(file.remarks);
            Ok(file)
        }
        _ => Err(Diagnostics::new(source, found)),
    }
}

impl ModelFile {
    /// Contents of the model with those of its included files and its mirror images: the table that was read.
    pub fn composed(&self) -> toml::Table {
        let folder = Folder::Given(&self.texts);
        let (parts, _) = parts_of(folder, self.text());
        let tables = tables_of(&self.source, &parts, &mut Vec::new());
        let numbers = opposites(tables.iter().map(|file| &file.1));
        let sizes = (0..tables.len()).map(|file| self.source.range(file).len() as u64).collect();
        let files = Files { tables, numbers: &numbers, sizes };
        let (whole, _) = whole(&mut Reader::new(&self.source, folder), &MODEL, files);
        let whole = toml::de::Deserializer::from(Spanned::new(0..0, whole.table));
        toml::Table::deserialize(whole).expect("the file has been read")
    }
}

/// Tables of a model file and its included files, with their names.
fn tables_of<'s>(
    source: &'s Source,
    parts: &[Part],
    errors: &mut Vec<Diagnostic>,
) -> Vec<(String, DeTable<'s>)> {
    let table = |file: usize| {
        let range = source.range(file);
        let (document, found) = DeTable::parse_recoverable(&source.text[range.clone()]);
        errors.extend(syntax_errors(source, &found, &range));
        let mut table = document.into_inner();
        if file > 0 {
            shifted(&mut table, range.start);
        }
        (file.checked_sub(1).map_or(String::new(), |k| parts[k].name.clone()), table)
    };
    (0..=parts.len()).map(table).collect()
}

/// Reports the syntax errors of a TOML file.
pub(super) fn syntax_errors(
    source: &Source,
    errors: &[toml::de::Error],
    file: &Range<usize>,
) -> Vec<Diagnostic> {
    let mut list: Vec<Diagnostic> = Vec::new();
    let mut last = (0, "");
    for error in errors {
        let span = error.span().map_or(file.end..file.end, |s| s.start + file.start..s.end + file.start);
        let line = source.line_column(span.start).0;
        // The same error on this or the next lines follows from the first.
        let follows =
            list.iter().any(|d| d.line == Some(line)) || last.1 == error.message() && line <= last.0 + 2;
        last = (line, error.message());
        if follows {
            continue;
        }
        let (what, help) = match error.message() {
            "duplicate key" => {
                let key = source.text.get(span.clone()).unwrap_or_default();
                let what = format!("`{}` is already there in this table", shown(key));
                (what, Some("rename or remove one of the two; every name is used once in its table"))
            }
            m if m.starts_with("string values must be quoted") => {
                (m.to_owned(), Some("write texts in quotes, and numbers with a decimal point"))
            }
            m if m.starts_with("missing comma between array") => {
                (m.to_owned(), Some("close every `[` with `]`, and put `,` between the values"))
            }
            m if m.starts_with("invalid basic string") => {
                (m.to_owned(), Some("close the text on the same line"))
            }
            m if m.starts_with("key with no value") => (m.to_owned(), Some("write `key = value`")),
            m => (m.to_owned(), None),
        };
        let d = source.diagnostic(
            Severity::Error,
            "HP0102",
            format!("this is not valid TOML: {what}"),
            Some(span),
        );
        list.push(help.into_iter().fold(d, Diagnostic::help));
        // After an unclosed list, the rest of the file is invalid.
        if list.len() == SYNTAX_ERRORS || error.message().contains("array") {
            break;
        }
    }
    if let Some(last) = list.last_mut() {
        last.notes.push("correct the syntax first; then the rest of the model is checked".into());
    }
    list
}

fn shown_fault(source: &Source, places: &Places, fault: DraftError) -> Diagnostic {
    let DraftError { code, at, message, notes, help } = fault;
    let span = places.find(&at);
    let mut d = source.diagnostic(Severity::Error, code, message, span);
    d = notes.into_iter().fold(d, Diagnostic::note);
    if code == "HP0201" && at.section == Section::Design {
        d = d.help(
            "`along = \"xyz\"` makes three variables NAME_x, NAME_y and NAME_z, and a parameter is one of its own name; \
             rename one of the two",
        );
    }
    help.into_iter().fold(d, Diagnostic::help)
}

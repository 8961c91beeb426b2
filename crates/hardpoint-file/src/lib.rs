//! Model files of Hardpoint: from text to a checked [`Model`], or to all diagnostics.
//!
//! ```
//! let text = r#"
//! name = "pendulum"
//! units = { length = "mm", angle = "deg" }
//! hardpoints = { pivot = [0, 0, 500], bob = [0, 0, 200] }
//! bodies = { arm = {} }
//! joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "y" }
//! drivers.swing = { joint = "hinge", law = "30*sin(2*pi*t)" }
//! points.bob = { body = "arm", at = "bob" }
//! time = { end = 1.0, steps = 100 }
//! "#;
//! let file = hardpoint_file::parse(text, "pendulum.toml").unwrap();
//! assert_eq!(file.model.hardpoints[0].position.z, 0.5); // metres inside
//! assert_eq!(file.model.times.len(), 101);
//! ```
//!
//! Properties of the reader:
//!
//! - The format is TOML, described in `docs/file-format.md`; [`schema`] returns its JSON Schema for editors.
//! - Units are declared once per file. [`Units`] converts input and output; internal numbers are SI.
//! - This crate knows keys, types and units. [`Model::from_draft`] checks the mechanism; its errors are reported with
//!   their position in the text.
//! - All problems are reported at once, as [`Diagnostics`]. Only a file with invalid TOML is not read further.
//! - No text causes a panic or a long run time: names, tables and lists have limits far above any mechanism.
//! - A model may include other files of its folder and mirror one side to the other. Both are resolved on the values of
//!   the texts (`read/include.rs`, `read/mirror.rs`) before these are read.
//! - Tables of laws may be CSV files, and shapes of bodies files of triangles, in the model's folder. No other files
//!   are read.

mod diagnostic;
mod drawing;
mod edit;
mod format;
mod measured;
mod places;
mod read;
mod schema;
pub mod side_names;
mod tree;
mod walk;

use std::ops::Range;
use std::path::Path;

use hardpoint::{
    draft::{DraftError, Section},
    model::{CaseId, Model, SweepRange, SweepSettings, VariableId},
};
use toml::de::DeTable;

pub use diagnostic::{Diagnostic, Diagnostics, Severity, Source};
pub use drawing::{Appearance, Form, Mesh, MeshFrame};
pub use edit::{at_keys, hardpoint_in, hardpoints_in, placed, with_keys};
pub use hardpoint_table::{AngleUnit, LengthUnit, Units};
pub use measured::MeasuredData;
pub use read::planar::Plane;
pub use read::triangles;
pub use schema::schema;

use diagnostic::{closest, shown};
use places::Places;
use read::include::{self, Files, IncludeError, shifted};
use read::mirror::{Origins, deduplicated, opposites, with_origin};
pub use tree::Texts;
use tree::{Folder, Reader};

/// Maximum size of a file in bytes.
pub const LARGEST_FILE: u64 = 64 << 20;
/// Maximum number of syntax errors that are shown: later ones usually follow from the first.
const SYNTAX_ERRORS: usize = 5;
/// Maximum number of files of a folder that are listed if the requested one does not exist.
const LISTED_FILES: usize = 12;

/// A model with its text.
#[derive(Clone, Debug)]
pub struct ModelFile {
    /// Checked model, in SI units.
    pub model: Model,
    /// Units of the file, for output.
    pub units: Units,
    /// Description in the file.
    pub description: Option<String>,
    /// Appearance in drawings.
    pub drawing: Appearance,
    /// Warnings and notes of the reader, in the order of the text.
    pub remarks: Vec<Diagnostic>,
    /// Texts of the files that the model names: tables of laws, target curves, lists of designs.
    pub texts: Texts,
    /// Plane of a planar model.
    pub plane: Option<Plane>,
    /// Mirror images with their originals, by name.
    origins: Origins,
    /// Selected case, if the file has cases.
    pub case: Option<String>,
    source: Source,
    places: Places,
}

impl ModelFile {
    /// Returns the file with a single case as its motion.
    pub fn in_case(&self, case: CaseId) -> Self {
        let mut model = self.model.in_case(case);
        model.grids.clear();
        Self { model, case: Some(self.model.cases[case.0].name.clone()), ..self.clone() }
    }

    /// Value of a variable after a change in SI, in the file's units.
    pub fn value_of(&self, variable: VariableId, change: f64) -> f64 {
        let quantity = self.model.variables[variable.0].quantity;
        self.units.from_si(quantity, change + self.model.nominal_value(variable))
    }

    /// Change, in SI, that gives a variable a value in the file's units; exactly 0 for its nominal value.
    pub fn change_to(&self, variable: VariableId, value: f64) -> f64 {
        if value == self.value_of(variable, 0.0) {
            return 0.0;
        }
        let quantity = self.model.variables[variable.0].quantity;
        self.units.to_si(quantity, value) - self.model.nominal_value(variable)
    }

    /// Name of the file, as given.
    pub fn file_name(&self) -> &str {
        &self.source.file
    }

    /// Text of the file.
    pub fn text(&self) -> &str {
        &self.source.text[self.source.range(0)]
    }

    /// Line and column, from 1, of the name of an entry: `index` counts as in the lists of [`Model`].
    ///
    /// `None` for elements without an entry: ground, coordinates in place of a hardpoint's name.
    pub fn place(&self, section: Section, index: usize) -> Option<(usize, usize)> {
        self.span(section, index).map(|s| self.source.line_column(s.start))
    }

    fn span(&self, section: Section, index: usize) -> Option<Range<usize>> {
        // Ground is the model's first body and is not in the file.
        let index = if section == Section::Bodies { index.checked_sub(1)? } else { index };
        let at = hardpoint::draft::DraftLocation { section, index, key: "", item: None };
        self.places.find(&at)
    }

    /// Reads designs from a CSV file in any folder: its first line names design variables, each line below has their
    /// values in the file's units (values of parameters, changes for all others). The result has changes in SI, as in
    /// [`SweepSettings`].
    ///
    /// # Errors
    /// Returns the errors of the file.
    pub fn designs(&self, path: &Path) -> Result<(Vec<SweepRange>, Vec<Vec<f64>>), Diagnostics> {
        let name = path.display().to_string();
        let source = Source::new(&name, "");
        let refused = |code, message: String, notes: Vec<String>, help: Option<String>| {
            let d = source.diagnostic(Severity::Error, code, message, None);
            let d = notes.into_iter().fold(d, Diagnostic::note);
            Diagnostics::new(source.clone(), vec![help.into_iter().fold(d, Diagnostic::help)])
        };
        let (names, rows) =
            read::sweep::list_at(path).map_err(|e| refused(e.code, e.message, e.notes, e.help))?;
        let mut variables = Vec::new();
        for (column, wanted) in names.iter().enumerate() {
            let known = self.model.variables.iter().position(|v| v.name == *wanted);
            let Some(k) = known else {
                let all = self.model.variables.iter().map(|v| v.name.as_str());
                let help = closest(wanted, all).map(|c| format!("did you mean `{c}`?"));
                let message = format!("there is no design variable named `{}`", shown(wanted));
                let note = format!("it is the title of column {} of `{}`", column + 1, shown(&name));
                return Err(refused("HP0247", message, vec![note], help));
            };
            if variables.contains(&VariableId(k)) {
                let message =
                    format!("`{}` is the title of two columns of `{}`", shown(wanted), shown(&name));
                return Err(refused("HP0247", message, Vec::new(), Some("remove one of the two".into())));
            }
            variables.push(VariableId(k));
        }
        let in_si = |row: &Vec<f64>| variables.iter().zip(row).map(|(v, x)| self.change_to(*v, *x)).collect();
        let rows: Vec<Vec<f64>> = rows.iter().map(in_si).collect();
        Ok((SweepSettings::spanned(&variables, &rows), rows))
    }

    /// Creates a diagnostic of an entry of the model, or of the whole model, for [`render`](Self::render).
    ///
    /// ```
    /// # let text = r#"
    /// # name = "pendulum"
    /// # units = { length = "mm", angle = "deg" }
    /// # hardpoints = { pivot = [0, 0, 500] }
    /// # bodies = { arm = {} }
    /// # joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "y" }
    /// # time = { end = 1.0, steps = 100 }
    /// # "#;
    /// # let file = hardpoint_file::parse(text, "pendulum.toml").unwrap();
    /// use hardpoint::draft::Section;
    /// use hardpoint_file::Severity;
    ///
    /// let d = file
    ///     .diagnostic(Severity::Error, "HP0411", "the mechanism does not move", Some((Section::Joints, 0)))
    ///     .help("add a driver for `hinge`");
    /// assert!(file.render(&d, false).contains("pendulum.toml:6:8"));
    /// ```
    pub fn diagnostic(
        &self,
        severity: Severity,
        code: &'static str,
        message: impl Into<String>,
        about: Option<(Section, usize)>,
    ) -> Diagnostic {
        let span = about.and_then(|(section, index)| self.span(section, index));
        with_origin(self.source.diagnostic(severity, code, message, span), &self.origins)
    }

    /// Renders a diagnostic of this file for a terminal; with `color`, with ANSI escapes.
    pub fn render(&self, diagnostic: &Diagnostic, color: bool) -> String {
        self.source.render(diagnostic, color)
    }
}

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
    let name = path.display().to_string();
    let bytes = bytes_of(path).map_err(|(message, note, help)| {
        let source = Source::new(&name, "");
        let mut d = source.diagnostic(Severity::Error, "HP0101", message, None);
        d = note.into_iter().fold(d, Diagnostic::note);
        d = help.into_iter().fold(d, Diagnostic::help);
        ReadError::Unreadable(Diagnostics::new(source, vec![d]))
    })?;
    match String::from_utf8(bytes) {
        Ok(text) => parse_in(path.parent(), &text, &name).map_err(ReadError::Invalid),
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

/// Files of the same kind in the folder of a missing file, and the most similar one.
fn neighbours(path: &Path, extension: &str) -> (Option<String>, Option<String>) {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let ending = format!(".{extension}");
    let Ok(entries) = std::fs::read_dir(folder) else {
        return (Some(format!("there is no folder `{}`", folder.display())), None);
    };
    let mut names: Vec<String> = entries
        .flatten()
        .filter_map(|e| e.file_name().into_string().ok())
        .filter(|n| n.ends_with(&ending))
        .collect();
    names.sort();
    if names.is_empty() {
        return (Some(format!("the folder `{}` has no {ending} files", folder.display())), None);
    }
    let wanted = path.file_stem().and_then(|n| n.to_str()).unwrap_or_default();
    let stems = names.iter().filter_map(|n| n.strip_suffix(&ending));
    let help = closest(wanted, stems)
        .map(|stem| format!("did you mean `{}`?", folder.join(format!("{stem}{ending}")).display()));
    let names: Vec<String> = names.iter().map(|n| format!("`{}`", shown(n))).collect();
    let list = hardpoint::draft::some_of(&names, ", ", LISTED_FILES);
    (Some(format!("the {ending} files in `{}`: {list}", folder.display())), help)
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

/// Parses a text with the files that it names ([`ModelFile::texts`]); bodies have no meshes.
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

fn parsed(folder: Folder<'_>, text: &str, file_name: &str) -> Result<ModelFile, Diagnostics> {
    let source = Source::new(file_name, text);
    if text.trim().is_empty() {
        let d = source
            .diagnostic(Severity::Error, "HP0104", "the file is empty", None)
            .help("a model has `name`, `units`, `[hardpoints]`, `[bodies]`, `[joints]` and `[time]`");
        return Err(Diagnostics::new(source, vec![d]));
    }
    let (parts, hindrances) = include::parts(folder, text);
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
        let d = source.diagnostic(Severity::Error, error.code, error.message, Some(at));
        let d = error.notes.into_iter().fold(d, Diagnostic::note);
        list.push(error.help.into_iter().fold(d, Diagnostic::help));
    }
    let mut tables = Vec::new();
    for file in 0..=parts.len() {
        let range = source.range(file);
        let (document, errors) = DeTable::parse_recoverable(&source.text[range.clone()]);
        list.extend(syntax_errors(&source, &errors, &range));
        let mut table = document.into_inner();
        if file > 0 {
            shifted(&mut table, range.start);
        }
        tables.push((file.checked_sub(1).map_or(String::new(), |k| parts[k].name.clone()), table));
    }
    if !list.is_empty() {
        drop(tables);
        return Err(Diagnostics::new(source, list));
    }
    let numbers = opposites(tables.iter().map(|file| &file.1));
    let sizes = (0..tables.len()).map(|file| source.range(file).len() as u64).collect();
    let files = Files { tables, numbers: &numbers, sizes };
    let mut reader = Reader::new(&source, folder);
    reader.texts = include::texts(&parts);
    let whole = reader.whole(files);
    if !reader.found.is_empty() {
        // References to its missing entries are not reported.
        let found = std::mem::take(&mut reader.found);
        let note = "correct this first; then the rest of the model is checked";
        let list = found.into_iter().map(|d| d.note(note)).collect();
        return Err(Diagnostics::new(source.clone(), list));
    }
    let plane = Plane::of(&whole.table);
    let raw = reader.model(&whole.table, &whole.twins);
    let (units, texts, origins) = (reader.units, reader.texts, reader.origins);
    let remarks = deduplicated(reader.remarks, &origins);
    let mut found = reader.found;
    let model = match Model::from_draft(&raw.draft) {
        Ok(model) => Some(model),
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
            file.remarks.extend(read::weightless(&file));
            file.remarks = diagnostic::in_order(file.remarks);
            Ok(file)
        }
        _ => Err(Diagnostics::new(source, found)),
    }
}

/// Reports the syntax errors of a TOML file.
fn syntax_errors(source: &Source, errors: &[toml::de::Error], file: &Range<usize>) -> Vec<Diagnostic> {
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

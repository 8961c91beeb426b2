//! Import of mechanisms from other programs as Hardpoint model files.
//!
//! Each format is a module that converts a source to a [`Mechanism`] and records the outcome of each of its elements
//! ([`Report`]). One writer creates the model file. Motions that the source leaves undriven are fixed, or driven if
//! there is only one; the report lists them.
//!
//! ```
//! let urdf = r#"
//! <robot name="door">
//!   <link name="frame"/><link name="leaf"/>
//!   <joint name="hinge" type="revolute">
//!     <parent link="frame"/><child link="leaf"/><axis xyz="0 0 1"/>
//!     <limit lower="0" upper="1.5" effort="1" velocity="1"/>
//!   </joint>
//! </robot>"#;
//! let imported = hardpoint_import::import(urdf.as_bytes(), "door.urdf", &|_| None).unwrap();
//! let file = hardpoint_file::parse(&imported.text, "door.toml").unwrap();
//! assert_eq!(file.model.joints.len(), 2); // the hinge, and the frame that is on the ground
//! ```

mod adams;
mod adams_keys;
mod adams_statement;
mod asmt;
mod axle;
mod cases;
mod chain;
mod chrono;
mod chrono_axle;
mod chrono_generic;
mod chrono_part;
mod closing;
mod collada;
mod corner;
mod explorer;
mod finish;
mod freecad;
mod law;
mod live_axle;
mod lotus;
mod markers;
pub mod mechanism;
mod mjcf;
mod report;
mod robot;
mod sampled;
mod sdf;
mod series;
mod shapes;
mod siblings;
mod sides;
mod straighten;
mod teimorbit;
mod teimorbit_blocks;
mod tree;
mod turn;
mod urdf;
mod write;
mod xml;

use hardpoint_file::Diagnostic;

pub use closing::Closing;
pub use mechanism::Mechanism;
pub use report::{ElementOutcome, Entry, ImportErrors, ImportLog, Report, SourceLocation, SourceSpan};
pub use series::{Difference, Series, StoredPose};

/// Access to other files of a source: returns the bytes of a path that the source names, if it can be read.
pub type Resolve<'r> = &'r dyn Fn(&str) -> Option<Vec<u8>>;

/// Imported mechanism.
#[derive(Clone, Debug)]
pub struct ImportedModel {
    /// Text of the model file.
    pub text: String,
    /// Outcome of every element of the source.
    pub report: Report,
    /// Files that the model refers to, by their paths from its folder.
    pub files: Vec<(String, Vec<u8>)>,
    /// Motion stored in the source.
    pub series: Option<Series>,
    /// Reason why the model cannot be analysed, if any. The text is complete nevertheless, for the user to correct.
    pub fault: Option<ImportErrors>,
}

/// Source that is being imported.
pub struct Input<'s> {
    /// Bytes of the source.
    pub bytes: &'s [u8],
    /// Text of the source.
    pub text: &'s str,
    /// File name without folder and extension.
    pub stem: &'s str,
    /// Access to other files.
    pub resolve: Resolve<'s>,
    /// Shapes of bodies.
    pub(crate) shapes: shapes::Shapes,
    /// Motion stored in the source.
    pub series: Option<Series>,
}

/// Import format.
#[derive(Clone, Copy)]
pub struct Format {
    /// Name, as in `--format NAME`.
    pub name: &'static str,
    /// Description of the format.
    pub about: &'static str,
    /// File extensions, without the dot.
    pub endings: &'static [&'static str],
    /// Returns true if the beginning of a text looks like this format.
    recognises: fn(&str) -> bool,
    /// Reads a source into a mechanism; errors are added to the log.
    read: fn(&mut Input<'_>, &mut ImportLog) -> Option<Mechanism>,
    /// True for binary formats.
    binary: bool,
}

impl std::fmt::Debug for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

/// All import formats.
pub const FORMATS: &[Format] = &[
    asmt::FORMAT,
    adams::FORMAT,
    urdf::FORMAT,
    sdf::FORMAT,
    mjcf::FORMAT,
    explorer::FORMAT,
    chrono::FORMAT,
    lotus::FORMAT,
    teimorbit::FORMAT,
    freecad::FORMAT,
];

impl Format {
    /// Returns the format with a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        FORMATS.iter().find(|f| f.name == name)
    }

    /// Returns the format of a file from its content, or otherwise from its extension.
    pub fn of(bytes: &[u8], name: &str) -> Option<&'static Self> {
        let ending = name.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
        let by_name = |f: &&Self| f.endings.contains(&ending.as_str());
        if bytes.starts_with(b"PK") {
            return FORMATS.iter().find(|f| f.binary && !TABLES.contains(&ending.as_str()));
        }
        let head = decoded(&bytes[..bytes.len().min(LOOKED_AT)]);
        let alike: Vec<&Self> = FORMATS.iter().filter(|f| !f.binary && (f.recognises)(&head)).collect();
        let by_look = alike.iter().copied().find(by_name).or(alike.first().copied());
        by_look.or_else(|| FORMATS.iter().find(by_name))
    }
}

/// Robot formats, which define no points to observe.
const ROBOTS: [&str; 3] = ["urdf", "sdf", "mjcf"];
/// Extensions of tables, a frequent form of hardpoint lists.
const TABLES: [&str; 7] = ["csv", "tsv", "txt", "xlsx", "xlsm", "xls", "ods"];
/// Number of bytes of a file that are examined to identify its format.
const LOOKED_AT: usize = 1 << 16;
/// Relative accuracy of positions in robot files, as a fraction of the mechanism size.
const FEW_DIGITS: f64 = 1e-4;
/// Maximum size of a source, bytes.
pub const LARGEST: usize = 64 << 20;

/// Imports a source, whose format is detected. `resolve` returns the files that the source names: included files and
/// meshes.
///
/// # Errors
/// Returns all errors of the source.
pub fn import(bytes: &[u8], name: &str, resolve: Resolve<'_>) -> Result<ImportedModel, ImportErrors> {
    import_with(&Options::default(), bytes, name, resolve)
}

/// Options of an import.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Format; `None` to detect it.
    pub format: Option<Format>,
    /// Joints that close loops of the source.
    pub closings: Vec<Closing>,
    /// Folder of the shapes next to the model; `None` to name it after the source.
    pub shapes: Option<String>,
}

/// Imports a source with options.
///
/// # Errors
/// See [`import`].
pub fn import_with(
    options: &Options,
    bytes: &[u8],
    name: &str,
    resolve: Resolve<'_>,
) -> Result<ImportedModel, ImportErrors> {
    match options.format.as_ref().or_else(|| Format::of(bytes, name)) {
        Some(format) => read_as(format, options, bytes, name, resolve),
        None => {
            let notes = ImportLog::new(name, "");
            if let Some(sibling) = siblings::of(&decoded(&bytes[..bytes.len().min(LOOKED_AT)]), name) {
                return Err(is_sibling(&notes, sibling));
            }
            let message = notes.diagnostic("HP0801", None, "the format of the file is not recognised");
            let message = message.note(format!("the known formats are {}", known()));
            let message = message.help("if it is one of these, specify it, like `--format adams`");
            let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_lowercase();
            let table = TABLES.contains(&ending.as_str());
            let help = "to create a model from a template with a table of hardpoints, run \
                        `hardpoint new NAME --template TEMPLATE --hardpoints FILE`";
            Err(notes.single_error(if table { message.help(help) } else { message }))
        }
    }
}

/// Lists all formats with their descriptions.
fn known() -> String {
    let known: Vec<String> = FORMATS.iter().map(|f| format!("`{}` ({})", f.name, f.about)).collect();
    known.join(", ")
}

/// HP0801 for a file of a related but unsupported kind, with the file to export instead.
fn is_sibling(notes: &ImportLog, sibling: &siblings::Sibling) -> ImportErrors {
    let message = format!("unsupported file: {}", sibling.what);
    file_error(notes, "HP0801", message, sibling.help)
}

/// Imports a source of a known format.
///
/// # Errors
/// See [`import`].
pub fn import_as(
    format: &Format,
    bytes: &[u8],
    name: &str,
    resolve: Resolve<'_>,
) -> Result<ImportedModel, ImportErrors> {
    read_as(format, &Options::default(), bytes, name, resolve)
}

fn read_as(
    format: &Format,
    options: &Options,
    bytes: &[u8],
    name: &str,
    resolve: Resolve<'_>,
) -> Result<ImportedModel, ImportErrors> {
    let text = if format.binary { String::new() } else { decoded(bytes) };
    let mut notes = ImportLog::new(name, &text);
    check_source(format, bytes, &text, &notes)?;
    let base = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let stem = base.rsplit_once('.').map_or(base, |(stem, _)| stem);
    let stem = if stem.is_empty() { "model" } else { stem };
    let shapes = shapes::Shapes::default();
    let mut input = Input { bytes, text: &text, stem, resolve, shapes, series: None };
    notes.report.format = report::printable(&format!("{base}: {}", format.about));
    let is_robot = ROBOTS.contains(&format.name);
    let mut mechanism = (format.read)(&mut input, &mut notes);
    if let Some(m) = mechanism.as_mut().filter(|_| notes.problem_count() == 0) {
        if is_robot {
            closing::close_cut_by_exporters(m, &mut notes);
        }
        closing::close(m, &mut notes, &options.closings);
        closing::report_likely_pairs(m, &mut notes);
    }
    // If a file cannot be read, its kind is more informative than its errors as this format.
    let head = || decoded(&bytes[..bytes.len().min(LOOKED_AT)]);
    let is_like_it = format.binary || (format.recognises)(&head());
    let failed = notes.problem_count() > 0 || mechanism.is_none();
    if let (true, false, Some(sibling)) = (failed, is_like_it, siblings::of(&head(), name)) {
        return Err(is_sibling(&notes, sibling));
    }
    if let Some(problems) = notes.problems() {
        return Err(problems);
    }
    let Some(mut m) = mechanism else {
        return Err(no_mechanism(format, &head(), is_like_it, &notes));
    };
    check_mechanism(&m, &notes)?;
    let about = report::printable(&format!("Imported from {base} ({})", format.about));
    let fault = if m.bodies.len() > 1 {
        completed(&mut m, &mut notes, is_robot)
    } else {
        Some(not_recognised(&m, &notes))
    };
    let folder = options.shapes.clone().unwrap_or_else(|| format!("{stem}_meshes"));
    let files = input.shapes.files(&mut m, &shapes::file_name(&folder));
    let fault = fault.map(|diagnostic| notes.single_error(diagnostic));
    Ok(ImportedModel {
        text: write::text(&m, &about),
        report: notes.report,
        files,
        series: input.series,
        fault,
    })
}

/// HP0802: a source that is too large or empty.
fn check_source(format: &Format, bytes: &[u8], text: &str, notes: &ImportLog) -> Result<(), ImportErrors> {
    if bytes.len() > LARGEST {
        let message = format!(
            "the file is too large: {} MiB; at most {} MiB are read",
            bytes.len() >> 20,
            LARGEST >> 20
        );
        return Err(file_error(notes, "HP0802", message, "export the mechanism without results"));
    }
    if !format.binary && text.trim().is_empty() {
        return Err(file_error(notes, "HP0802", "the file is empty", "export the mechanism again"));
    }
    Ok(())
}

/// HP0806 for a file without a mechanism, with the format that its beginning resembles.
fn no_mechanism(format: &Format, head: &str, is_like_it: bool, notes: &ImportLog) -> ImportErrors {
    let message = format!("the file has no mechanism; it was read as {}", format.about);
    let other = FORMATS.iter().find(|f| f.name != format.name && !f.binary && (f.recognises)(head));
    match other {
        Some(other) => {
            let help = format!("import it with `--format {}`: it resembles {}", other.name, other.about);
            file_error(notes, "HP0806", message, &help)
        }
        None if is_like_it => {
            file_error(notes, "HP0806", message, "export the mechanism with its bodies and joints")
        }
        None => {
            let d = notes.diagnostic("HP0806", None, message);
            let d = d.note(format!("it resembles none of the known formats: {}", known()));
            notes.single_error(d.help("export the mechanism in one of these formats"))
        }
    }
}

/// HP0802: too many bodies or joints; HP0804: positions that are not finite.
fn check_mechanism(m: &Mechanism, notes: &ImportLog) -> Result<(), ImportErrors> {
    let count = m.bodies.len().max(m.joints.len() / 2);
    if count > robot::MOST_PARTS {
        let message = format!("the mechanism has {} bodies and {} joints", m.bodies.len(), m.joints.len());
        let help =
            format!("reduce it to at most {} bodies by removing parts that need not move", robot::MOST_PARTS);
        return Err(file_error(notes, "HP0802", message, &help));
    }
    let numbers = m.joints.iter().flat_map(|j| j.at.iter().chain(&j.axis).chain(&j.axis2));
    if !numbers.chain(m.hardpoints.iter().map(|h| &h.1)).all(|v| v.is_finite()) {
        let message = "positions of joints are not finite";
        return Err(file_error(notes, "HP0804", message, "correct the coordinates in the source"));
    }
    Ok(())
}

/// Completes a mechanism to a model that moves; returns the error if it does not.
fn completed(m: &mut Mechanism, notes: &mut ImportLog, is_robot: bool) -> Option<Diagnostic> {
    if is_robot {
        finish::end_point(m, notes);
    }
    // Robot files define which frames coincide: only gaps due to few digits are closed.
    let closed = if is_robot { FEW_DIGITS } else { f64::INFINITY };
    let fault = finish::finish(m, notes, closed);
    finish::remark_undriven(m, notes, is_robot);
    if fault.is_none() {
        cases::add_vehicle_cases(m, notes);
    }
    fault
}

/// HP0807: hardpoints without a known topology.
fn not_recognised(m: &Mechanism, notes: &ImportLog) -> Diagnostic {
    let message = "the topology is not recognised: only the hardpoints are written";
    let message = notes.diagnostic("HP0807", None, message);
    let message = match &m.unplaced {
        Some(names) if names.is_empty() => {
            message.note("all names are known, but a member or the wheel centre is missing")
        }
        Some(names) => {
            let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
            message.note(format!("names without a known member: {}", names.join(", ")))
        }
        None => message,
    };
    message.help("add bodies and joints as described in docs/file-format.md")
}

/// Error for the file as a whole.
fn file_error(notes: &ImportLog, code: &'static str, message: impl AsRef<str>, help: &str) -> ImportErrors {
    notes.single_error(notes.diagnostic(code, None, message).help(help))
}

/// Decodes the text of a file: UTF-8 or UTF-16, otherwise Latin-1, as older programs write it; without a byte order
/// mark.
fn decoded(bytes: &[u8]) -> String {
    let wide = |unit: fn([u8; 2]) -> u16| {
        let units = bytes.chunks_exact(2).map(|b| unit([b[0], b[1]]));
        char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
    };
    // Detected by the mark, or by an ASCII first character.
    let text = match bytes {
        [0xff, 0xfe, ..] | [b' '..=b'~', 0, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] | [0, b' '..=b'~', ..] => wide(u16::from_be_bytes),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => text.to_owned(),
            Err(_) => bytes.iter().map(|b| char::from(*b)).collect(),
        },
    };
    let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
    // Some old systems end lines with a carriage return alone.
    if text.contains('\n') { text } else { text.replace('\r', "\n") }
}

impl Input<'_> {
    /// Returns the bytes of a file that the source names: by the path as written, or without leading folders, which may
    /// exist on the author's machine only.
    fn file(&self, path: &str) -> Option<Vec<u8>> {
        let local =
            ["file://", "package://", "model://"].iter().find_map(|p| path.strip_prefix(p)).unwrap_or(path);
        let parts: Vec<&str> = local.split(['/', '\\']).filter(|p| !matches!(*p, "" | ".")).collect();
        let tails = (0..parts.len()).map(|k| parts[k..].join("/"));
        std::iter::once(local.to_owned()).chain(tails).find_map(|p| (self.resolve)(&p))
    }

    /// Returns the bytes of a file that the source names.
    ///
    /// # Errors
    /// Returns the reason why there are none.
    fn file_or_why(&self, path: &str) -> Result<Vec<u8>, String> {
        self.file(path).ok_or_else(|| "the file does not exist next to the source".into())
    }

    /// Adds a mesh that the source names, or reports why it is missing.
    #[expect(clippy::too_many_arguments, reason = "a mesh, its pose, and its position in the source")]
    fn mesh(
        &mut self,
        body: usize,
        place: hardpoint::space::Pose,
        linear: hardpoint::space::Mat3,
        path: &str,
        name: &str,
        at: Option<SourceSpan>,
        notes: &mut ImportLog,
    ) {
        let added =
            self.file_or_why(path).and_then(|bytes| self.shapes.file(body, place, linear, path, &bytes));
        match added {
            Ok(()) => notes.taken("mesh", name, at),
            Err(why) => shapes::report_missing_shape(notes, "mesh", name, at, &format!("`{path}`: {why}")),
        }
    }
}

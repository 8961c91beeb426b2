//! Export of Hardpoint models to files of other programs, with a list of the features that each format does not
//! support; runs as workbooks, PDF documents, animations and long tables; surfaces.
//!
//! ```
//! let text = r#"
//! name = "pendulum"
//! units = { length = "mm", angle = "deg" }
//! hardpoints = { pivot = [0, 0, 500] }
//! bodies = { arm = {} }
//! joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "y" }
//! drivers.swing = { joint = "hinge", law = "30*sin(2*pi*t)" }
//! time = { end = 1.0, steps = 100 }
//! "#;
//! let file = hardpoint_file::parse(text, "pendulum.toml").unwrap();
//! let urdf = hardpoint_export::Format::named("urdf").unwrap();
//! let exported = urdf.export(&file, "pendulum").unwrap();
//! assert!(exported.text.contains(r#"<origin xyz="0 0 0.5"/>"#));
//! assert!(exported.unsupported.iter().any(|u| u.name == "swing")); // URDF does not support motions
//! ```

mod animation;
mod archive;
mod c;
mod contents;
mod dxf;
mod fmu;
mod links;
pub mod long_table;
mod masses;
mod mjcf;
mod names;
mod pdf;
mod skeleton;
mod stl;
mod tables;
mod urdf;
mod workbook;
mod xml;

use hardpoint::topology::TopologyError;
use hardpoint_file::ModelFile;
use serde::Serialize;

pub use animation::animation;
pub use archive::{Archive, Library};
use contents::Target;
pub use pdf::{DesignResult, PdfContent, PdfPart};
pub use stl::write_stl;
pub use tables::hardpoints;
pub use workbook::RunDocument;

/// A model as a file of another program.
#[derive(Clone, Debug, Default)]
pub struct ExportedModel {
    /// Text of the file.
    pub text: String,
    /// Features that the format does not support, or supports only approximately.
    pub unsupported: Vec<UnsupportedFeature>,
    /// Second file, which belongs to the first.
    pub companion: Option<Companion>,
    /// Files that are packed as one, in place of the text.
    pub archive: Option<Archive>,
}

/// A file that belongs to an exported one and has the same name but for its extension.
#[derive(Clone, Debug)]
pub struct Companion {
    /// File extension, without the dot.
    pub ending: &'static str,
    /// Text of the file.
    pub text: String,
}

/// Reason why a model cannot be written in a format.
#[derive(Clone, Debug)]
pub enum ExportError {
    /// The mechanism cannot be driven as modelled.
    CannotBeDriven(TopologyError),
    /// The step of the mechanism has no formulas.
    NotRecorded {
        /// Reason.
        why: String,
    },
    /// The exported files cannot have this name.
    UnfitName {
        /// Reason.
        why: String,
        /// Suggested fix.
        help: String,
    },
}

/// Options of an export.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExportOptions {
    /// The design variables are arguments, with the derivatives by them: formats that contain the motion.
    pub design: bool,
}

/// Feature of a model that a format does not support.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnsupportedFeature {
    /// Kind in the model: `joint`, `driver`.
    pub kind: &'static str,
    /// Name in the model.
    pub name: String,
    /// Reason, or substitute that is written.
    pub why: String,
}

/// Export format.
#[derive(Clone, Copy)]
pub struct Format {
    /// Name, as in `--format NAME`.
    pub name: &'static str,
    /// Description of the format.
    pub about: &'static str,
    /// File extensions, without the dot.
    pub endings: &'static [&'static str],
    write: Writer,
}

/// Writer of a format.
#[derive(Clone, Copy)]
enum Writer {
    /// A description of the model, with the group of its contents.
    Described(Target, fn(&ModelFile, &mut ExportedModel)),
    /// The solved motion as formulas, in a file with this name without its extension.
    Recorded(fn(&ModelFile, &str, ExportOptions, &mut ExportedModel) -> Result<(), ExportError>),
}

impl std::fmt::Debug for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

/// All export formats.
pub const FORMATS: &[Format] =
    &[tables::CSV, tables::TEIMORBIT, urdf::FORMAT, mjcf::FORMAT, dxf::FORMAT, c::FORMAT, fmu::FORMAT];

/// Formats whose writers quote names, so that these may contain any character.
const QUOTES_NAMES: [&str; 1] = ["csv"];

impl Format {
    /// True if the design variables can be arguments in this format.
    pub fn has_design(&self) -> bool {
        match self.write {
            Writer::Described(..) => false,
            Writer::Recorded(_) => true,
        }
    }

    /// Returns the format with a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        FORMATS.iter().find(|f| f.name == name)
    }

    /// Returns the format of a file from its extension.
    pub fn of(name: &str) -> Option<&'static Self> {
        let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_lowercase();
        FORMATS.iter().find(|f| f.endings.contains(&ending.as_str()))
    }

    /// Exports a model to this format, as a file whose name without its extension is `stem`.
    ///
    /// # Errors
    ///
    /// Formats that contain the motion need a mechanism that can be driven and whose step has formulas, and a name that
    /// a C header can have.
    pub fn export(&self, file: &ModelFile, stem: &str) -> Result<ExportedModel, ExportError> {
        self.export_with(file, stem, ExportOptions::default())
    }

    /// Exports as [`export`](Self::export), with options.
    ///
    /// # Errors
    ///
    /// The same.
    pub fn export_with(
        &self,
        file: &ModelFile,
        stem: &str,
        options: ExportOptions,
    ) -> Result<ExportedModel, ExportError> {
        let mut out = ExportedModel::default();
        let renamed = if QUOTES_NAMES.contains(&self.name) {
            None
        } else {
            names::with_supported_names(file, &mut out)
        };
        let file = renamed.as_ref().unwrap_or(file);
        match self.write {
            Writer::Described(target, write) => {
                write(file, &mut out);
                out.report_contents(file, target);
            }
            Writer::Recorded(write) => {
                // An archive contains the list.
                out.report_contents(file, Target::Motion);
                write(file, stem, options, &mut out)?;
            }
        }
        Ok(out)
    }
}

impl ExportedModel {
    fn report_unsupported(&mut self, kind: &'static str, name: &str, why: impl Into<String>) {
        self.unsupported.push(UnsupportedFeature { kind, name: name.to_owned(), why: why.into() });
    }
}

/// Shortest text that reads back as the same number.
fn number(x: f64) -> String {
    // Zero is written without a sign.
    format!("{}", x + 0.0)
}

fn numbers(list: [f64; 3]) -> String {
    list.map(number).join(" ")
}

/// Escapes a text for an XML attribute. The text must not contain control characters.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

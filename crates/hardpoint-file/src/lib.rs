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
//! Data flows through five rooms, each of which uses those before it only:
//!
//! | room | contents |
//! |---|---|
//! | `values` | values of a text: numbers, names, tables with their places and diagnostics; the forms of the format |
//! | `compose` | one table from several texts: included files, planar shorthand, mirror images |
//! | `read` | the sections of a model, one file each: from its table to its part of the draft; [`ModelFile`] |
//! | `write` | edits for a changed design, JSON Schema, tables of the documentation |
//! | `language` | completion, meanings, references and renaming, for editors |
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
//!   the texts (`compose`) before these are read.
//! - Tables of laws may be CSV files, and shapes of bodies files of triangles, in the model's folder. No other files
//!   are read.

mod compose;
mod language;
mod read;
mod values;
mod write;

pub use compose::{Plane, side_names};
pub use hardpoint_table::{AngleUnit, LengthUnit, Units};
pub use language::{
    Completion, CompletionKind, Document, IncludedFile, KeyMeaning, LARGEST_DOCUMENT, NameAt, Reference,
    RenameError, Symbol,
};
pub use read::{
    Appearance, Form, MeasuredData, Mesh, MeshFrame, ModelFile, ReadError, TaskAim, TaskFile, TaskRegion,
    parse, parse_in, parse_over, parse_with, read, triangles,
};
pub use values::{Diagnostic, Diagnostics, LARGEST_FILE, Severity, Source, Texts};
pub use write::{Contents, at_keys, hardpoint_in, hardpoints_in, merged, placed, schema, with_keys};

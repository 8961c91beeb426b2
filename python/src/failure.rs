//! Errors, as exceptions of the package.

use hardpoint_file::{Diagnostic, Diagnostics, ModelFile};
use hardpoint_study::RequestError;
use hardpoint_study::request::Fault;
use pyo3::prelude::*;
use serde_json::{Value, json};

/// Classes of `hardpoint.errors`.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// The file or text is not a valid model.
    Model,
    /// The model cannot be driven.
    Topology,
    /// A motion ends before its last output time.
    Stopped,
    /// A study is impossible.
    Study,
    /// Invalid request.
    Usage,
}

/// An error.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Diagnostics, each as JSON.
    Found(Kind, Vec<Value>),
    /// Invalid request.
    Misunderstood(String),
    /// An exception of a callback, or an interruption.
    Raised(PyErr),
}

impl Failure {
    /// Error from the diagnostics of the file reader.
    pub fn of_text(found: &Diagnostics) -> Self {
        let rendered = found.render(false);
        let mut list: Vec<Value> = found.list().iter().map(|d| diagnostic(d, String::new())).collect();
        // All diagnostics are rendered together, with their positions in the text.
        if let Some(first) = list.first_mut() {
            first["rendered"] = rendered.into();
        }
        Self::Found(Kind::Model, list)
    }

    /// Error from a diagnostic of a model.
    pub fn of_model(kind: Kind, file: &ModelFile, found: &Diagnostic) -> Self {
        Self::Found(kind, vec![diagnostic_json(file, found)])
    }
}

impl From<RequestError> for Failure {
    fn from(error: RequestError) -> Self {
        let mut json = plain(&error.message, &format!("error: {error}"));
        json["help"] = Value::String(error.help);
        let kind = match error.fault {
            Fault::Model => Kind::Study,
            Fault::Override => Kind::Usage,
        };
        Self::Found(kind, vec![json])
    }
}

/// An error without a position in a file, in the form of a diagnostic.
fn plain(message: &str, rendered: &str) -> Value {
    json!({ "severity": "error", "code": null, "message": message, "file": null, "line": null, "column": null,
        "length": null, "element": null, "label": null, "notes": [], "help": null, "rendered": rendered })
}

/// JSON of a diagnostic of a model, with its rendered text.
pub(crate) fn diagnostic_json(file: &ModelFile, d: &Diagnostic) -> Value {
    diagnostic(d, file.render(d, false))
}

/// JSON of a diagnostic, with its rendered text.
fn diagnostic(d: &Diagnostic, rendered: String) -> Value {
    let mut json = serde_json::to_value(d).expect("a diagnostic is plain data");
    json["rendered"] = Value::String(rendered);
    json
}

impl From<PyErr> for Failure {
    fn from(error: PyErr) -> Self {
        Self::Raised(error)
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        let (class, text) = match failure {
            Failure::Raised(error) => return error,
            Failure::Misunderstood(message) => {
                ("UsageError", json!([plain(&message, &format!("error: {message}"))]))
            }
            Failure::Found(kind, list) => (
                match kind {
                    Kind::Model => "ModelError",
                    Kind::Topology => "TopologyError",
                    Kind::Stopped => "MotionStopped",
                    Kind::Study => "StudyError",
                    Kind::Usage => "UsageError",
                },
                Value::Array(list),
            ),
        };
        Python::attach(|py| {
            let made = py
                .import("hardpoint.errors")
                .and_then(|errors| errors.getattr(class)?.call_method1("of", (text.to_string(),)));
            made.map_or_else(|error| error, |made| PyErr::from_value(made))
        })
    }
}

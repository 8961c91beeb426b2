//! Files in the folder of the model file.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Component, Path};

use super::diagnostic::{Diagnostic, Severity, Source, closest, shown};

/// Maximum size of a file in bytes.
pub const LARGEST_FILE: u64 = 64 << 20;
/// Maximum number of files of a folder that are listed if the requested one does not exist.
const LISTED_FILES: usize = 12;

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
    /// Files given with the text, and all others in this folder or below it.
    Over(&'f Path, &'f Texts),
}

impl<'f> Folder<'f> {
    /// Given text by its name.
    pub fn given(self, name: &str) -> Option<&'f String> {
        match self {
            Self::Given(texts) | Self::Over(_, texts) => texts.get(name),
            Self::None | Self::On(_) => None,
        }
    }
}

/// Error in a data file.
pub(crate) struct DataError {
    pub code: &'static str,
    pub message: String,
    pub notes: Vec<String>,
    pub help: Option<String>,
    /// True if the selection of columns is invalid.
    pub of_columns: bool,
}

impl DataError {
    pub fn new(code: &'static str, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { code, message: message.into(), notes: Vec::new(), help: Some(help.into()), of_columns: false }
    }

    /// HP0111: the file cannot be read.
    pub fn unreadable(message: impl Into<String>, help: &str) -> Self {
        Self::new("HP0111", message, help)
    }

    /// HP0112: the file has no curve.
    pub fn content(message: impl Into<String>, help: &str) -> Self {
        Self::new("HP0112", message, help)
    }

    pub fn of_columns(self) -> Self {
        Self { of_columns: true, ..self }
    }

    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Diagnostic at a range of a text, or for the file as a whole.
    pub fn diagnostic(self, source: &Source, at: Option<Range<usize>>) -> Diagnostic {
        let d = source.diagnostic(Severity::Error, self.code, self.message, at);
        let d = self.notes.into_iter().fold(d, Diagnostic::note);
        self.help.into_iter().fold(d, Diagnostic::help)
    }
}

/// Descriptions of a requested file, for messages.
pub(crate) struct Wanted<'a> {
    /// Purpose of the file.
    pub purpose: &'a str,
    /// Kind of file, with its article.
    pub kind: &'a str,
    /// Ending of its name, to suggest other files in the folder.
    pub ending: &'a str,
    /// Example of a name.
    pub example: &'a str,
    /// Instruction if the model has no folder.
    pub without_folder: &'a str,
    /// Instruction if the file is too large.
    pub too_large: &'a str,
}

/// Text of a file.
pub(crate) fn text_from(bytes: Vec<u8>, name: &str) -> Result<String, DataError> {
    String::from_utf8(bytes).map_err(|_| {
        let message = format!("the file `{}` is not a text in UTF-8", shown(name));
        DataError::unreadable(message, "save it as UTF-8 text")
    })
}

/// Bytes of a file in the model's folder or below it.
pub(crate) fn bytes_of(folder: Folder<'_>, name: &str, wanted: &Wanted<'_>) -> Result<Vec<u8>, DataError> {
    let path = inside(name, wanted)?;
    let known = name;
    let name = shown(name);
    if let Some(text) = folder.given(known) {
        return Ok(text.clone().into_bytes());
    }
    let folder = match folder {
        Folder::On(folder) | Folder::Over(folder, _) => folder,
        Folder::Given(_) => {
            let message = format!("the file `{name}` is not part of this model");
            return Err(DataError::unreadable(message, wanted.without_folder));
        }
        Folder::None => {
            let message = format!("the file `{name}` cannot be read: this model is a text without a folder");
            return Err(DataError::unreadable(message, wanted.without_folder));
        }
    };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let failed = |e: std::io::Error| match e.kind() {
        std::io::ErrorKind::NotFound => {
            let message = format!("there is no file `{name}` next to the model file");
            let mut error =
                DataError::unreadable(message, "the path counts from the folder of the model file");
            let (note, close) = neighbours(&folder.join(path), wanted.ending);
            error.notes.extend(note);
            // The name in the model does not contain the reader's folder.
            let prefix = folder.join("").display().to_string();
            error.help = close.map(|c| c.replacen(&prefix, "", 1)).or(error.help);
            error
        }
        _ => DataError::unreadable(format!("the file `{name}` cannot be read"), "check its permissions")
            .note(e.to_string()),
    };
    let full = folder.join(path).canonicalize().map_err(failed)?;
    if !full.starts_with(folder.canonicalize().map_err(failed)?) {
        return Err(leaves(&name, wanted).note("it is a link to a place outside"));
    }
    let meta = std::fs::metadata(&full).map_err(failed)?;
    if !meta.is_file() {
        let message = format!("`{name}` is not a file");
        return Err(DataError::unreadable(message, &format!("name {} in the model's folder", wanted.kind)));
    }
    if meta.len() > LARGEST_FILE {
        let message = format!("the file `{name}` is too large for a {}", wanted.purpose);
        return Err(DataError::unreadable(message, wanted.too_large)
            .note(format!("at most {} MiB are read", LARGEST_FILE >> 20)));
    }
    std::fs::read(&full).map_err(failed)
}

/// Path of a file in the model's folder, valid on all systems; `None` for other paths.
fn inside<'n>(name: &'n str, wanted: &Wanted<'_>) -> Result<&'n Path, DataError> {
    let path = Path::new(name);
    if name.trim().is_empty() {
        let message = format!("the name of the {}'s file is empty", wanted.purpose);
        return Err(DataError::unreadable(message, &format!("name {}", wanted.kind)));
    }
    let is_absolute = path.has_root() || name.starts_with('\\') || name.as_bytes().get(1) == Some(&b':');
    if is_absolute || path.components().any(|c| c == Component::ParentDir) || name.contains("..\\") {
        return Err(leaves(&shown(name), wanted));
    }
    if name.contains('\\') {
        let message = format!("the path `{}` has a `\\`", shown(name));
        return Err(DataError::unreadable(message, "separate folders with `/`; that works on every system"));
    }
    Ok(path)
}

fn leaves(name: &str, wanted: &Wanted<'_>) -> DataError {
    let help = "put it into the folder of the model file, or a folder in it, and name it from there, like";
    DataError::unreadable(
        format!("the file `{name}` is not in the model's folder"),
        &format!("{help} `{}`", wanted.example),
    )
}

/// Files of the same kind in the folder of a missing file, and the most similar one.
pub(crate) fn neighbours(path: &Path, extension: &str) -> (Option<String>, Option<String>) {
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

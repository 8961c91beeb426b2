//! Model files of one folder: the only files that a page may read and write.

use std::collections::HashMap;
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use hardpoint_file::{Diagnostics, LARGEST_FILE, ModelFile, parse_in};
use serde::Serialize;

use crate::folder::Folder;
use crate::journal::checksum;

/// Ending of all model files.
const ENDING: &str = ".toml";
/// Maximum length of a file name.
const LONGEST_NAME: usize = 255;

/// A folder of models.
pub struct Models {
    /// Path as the user wrote it, for diagnostics; empty for the current folder.
    path: PathBuf,
    /// Canonical path.
    real: PathBuf,
    /// Last page that saved each file, with the saved revision; locked while a file is saved.
    saved: Mutex<HashMap<String, (Revision, String)>>,
}

/// A text on disk.
pub struct Text {
    pub text: String,
    pub revision: Revision,
}

/// Identity of a text: a checksum of its bytes.
pub type Revision = String;

/// Entry of a model in a list.
#[derive(Serialize)]
pub struct Entry {
    /// Name of the file.
    pub file: String,
    /// Name of the model; the file name if the model cannot be read.
    pub title: String,
    /// Description in the model.
    pub description: Option<String>,
    /// The names of its cases.
    pub cases: Vec<String>,
    /// Number of its problems.
    pub problems: usize,
    /// Time of the last change, in seconds since 1970.
    pub changed: Option<f64>,
}

/// Reason why a file was not read or written.
pub enum FileError {
    /// The name is not valid for a model file in this folder.
    Name,
    /// There is no file of that name.
    Absent,
    /// There is a file of that name already.
    Exists,
    /// The file has changed meanwhile.
    Changed(Text),
    /// The file is too large for a model.
    TooLarge,
    /// Another error, as a sentence.
    Failed(String),
}

impl Models {
    /// Models of this folder.
    pub fn of(path: &Path) -> io::Result<Self> {
        let current = path.as_os_str().is_empty();
        let real = if current { Path::new(".") } else { path }.canonicalize()?;
        Ok(Self { path: path.into(), real, saved: Mutex::default() })
    }

    /// Absolute path of the folder.
    pub fn whole_path(&self) -> &Path {
        &self.real
    }

    /// Path of a file with that name, existing or not.
    fn place(&self, name: &str) -> Result<PathBuf, FileError> {
        let odd = |c: char| c.is_control() || matches!(c, '/' | '\\' | ':' | '\u{fffd}');
        let plain = name.len() <= LONGEST_NAME && name.len() > ENDING.len() && !name.starts_with('.');
        if plain && name.ends_with(ENDING) && !name.contains(odd) {
            Ok(self.real.join(name))
        } else {
            Err(FileError::Name)
        }
    }

    /// True if the name is valid for a model in this folder.
    pub fn is_name(&self, name: &str) -> bool {
        self.place(name).is_ok()
    }

    /// Target of a file name after links are resolved; it must be in the folder.
    fn existing(&self, name: &str) -> Result<PathBuf, FileError> {
        let place = self.place(name)?;
        let real = place.canonicalize().map_err(FileError::of)?;
        // Reading from a pipe or a device would block.
        let is_file = real.metadata().map_err(FileError::of)?.is_file();
        if is_file && real.parent() == Some(&*self.real) { Ok(real) } else { Err(FileError::Name) }
    }

    /// The text of a model.
    pub fn read(&self, name: &str) -> Result<Text, FileError> {
        let file = std::fs::File::open(self.existing(name)?).map_err(FileError::of)?;
        let mut bytes = Vec::new();
        file.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(FileError::of)?;
        if bytes.len() as u64 > LARGEST_FILE {
            return Err(FileError::TooLarge);
        }
        let revision = revision(&bytes);
        let text = String::from_utf8(bytes);
        let text = text.map_err(|_| FileError::Failed(format!("`{name}` is not a text in UTF-8")))?;
        Ok(Text { text, revision })
    }

    /// Reads a text under that name.
    pub fn parse(&self, name: &str, text: &str) -> Result<ModelFile, Diagnostics> {
        parse_in(Some(&self.path), text, &self.path.join(name).display().to_string())
    }

    /// Replaces the text of that revision, whole or not at all, for the page `by`.
    pub fn save(&self, name: &str, text: &str, before: &str, by: &str) -> Result<Revision, FileError> {
        let mut saved = self.saved();
        let real = self.existing(name)?;
        let now = self.read(name)?;
        if now.revision != before {
            return Err(FileError::Changed(now));
        }
        let permissions = real.metadata().map_err(FileError::of)?.permissions();
        if permissions.readonly() {
            return Err(FileError::Failed(format!("`{name}` is read-only")));
        }
        // Links to the file remain valid.
        let own_name = real.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        self.written(&own_name, text, |folder| folder.commit(&[]))?;
        let _ = std::fs::set_permissions(&real, permissions);
        let revision = revision(text.as_bytes());
        saved.insert(name.into(), (revision.clone(), by.into()));
        Ok(revision)
    }

    /// Saves a text under a name that no file has.
    pub fn save_new(&self, name: &str, text: &str, by: &str) -> Result<Revision, FileError> {
        let mut saved = self.saved();
        self.place(name)?;
        self.written(name, text, Folder::commit_new)?;
        let revision = revision(text.as_bytes());
        saved.insert(name.into(), (revision.clone(), by.into()));
        Ok(revision)
    }

    fn written(
        &self,
        name: &str,
        text: &str,
        commit: impl FnOnce(Folder) -> Result<(), crate::folder::WriteError>,
    ) -> Result<(), FileError> {
        let written = Folder::open(&self.real).and_then(|mut folder| {
            folder.write(name, |out| out.write_all(text.as_bytes()))?;
            commit(folder)
        });
        written.map_err(|e| match e.error.kind() {
            ErrorKind::AlreadyExists => FileError::Exists,
            _ => FileError::Failed(format!("`{name}` cannot be written: {}", e.error)),
        })
    }

    /// True if this page saved the current text of the file.
    pub fn was_saved_by(&self, name: &str, revision: &str, by: &str) -> bool {
        self.saved().get(name).is_some_and(|(saved, page)| saved == revision && page == by)
    }

    fn saved(&self) -> MutexGuard<'_, HashMap<String, (Revision, String)>> {
        self.saved.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// All models, sorted by file name. Files that do not look like models are left out.
    pub fn list(&self) -> Vec<Entry> {
        let Ok(entries) = std::fs::read_dir(&self.real) else { return Vec::new() };
        let mut names: Vec<String> =
            entries.flatten().filter_map(|e| e.file_name().into_string().ok()).collect();
        names.sort();
        names.iter().filter_map(|name| self.entry(name)).collect()
    }

    fn entry(&self, name: &str) -> Option<Entry> {
        let text = self.read(name).ok()?.text;
        let read = self.parse(name, &text);
        let changed = self.existing(name).ok()?.metadata().ok()?.modified().ok();
        let since = changed.and_then(|at| at.duration_since(std::time::UNIX_EPOCH).ok());
        let file = name.to_owned();
        let changed = since.map(|s| s.as_secs_f64());
        match read {
            Ok(ModelFile { model, description, .. }) => {
                let cases = model.cases.iter().map(|c| c.name.clone()).collect();
                Some(Entry { file, title: model.name.clone(), description, cases, problems: 0, changed })
            }
            Err(found) => looks_like_a_model(&text).then(|| Entry {
                title: name.trim_end_matches(ENDING).into(),
                file,
                description: None,
                cases: Vec::new(),
                problems: found.list().len(),
                changed,
            }),
        }
    }
}

/// True if the text looks like a mechanism: there are many other TOML files.
fn looks_like_a_model(text: &str) -> bool {
    const TABLES: [&str; 3] = ["hardpoints", "bodies", "joints"];
    let heads = |line: &str| TABLES.iter().any(|t| line.trim_start_matches('[').starts_with(t));
    text.lines().any(|line| heads(line.trim_start()))
}

/// The revision of a text.
pub fn revision(bytes: &[u8]) -> Revision {
    format!("{:032x}", checksum(bytes))
}

impl FileError {
    fn of(error: io::Error) -> Self {
        match error.kind() {
            ErrorKind::NotFound => Self::Absent,
            ErrorKind::InvalidInput | ErrorKind::InvalidFilename => Self::Name,
            _ => Self::Failed(error.to_string()),
        }
    }
}

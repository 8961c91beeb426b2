//! Folders of results: files appear whole or not at all.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use tempfile::{NamedTempFile, TempPath};

/// Size of the write buffer in bytes.
const BUFFER: usize = 1 << 20;
/// Suffix of unfinished files; they are locked while they are written.
const SUFFIX: &str = ".part";

/// Unfinished files, to be removed if the program has to end at once.
static UNDER_WAY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A folder with files that are written but not yet in place.
pub struct Folder {
    path: PathBuf,
    pending: Vec<(NamedTempFile, PathBuf)>,
}

/// An unfinished file.
pub struct PendingFile {
    file: BufWriter<File>,
    beside: TempPath,
    path: PathBuf,
}

/// A file or folder that could not be written.
pub struct WriteError {
    /// Path of the file or folder.
    pub path: PathBuf,
    /// Cause.
    pub error: io::Error,
}

impl Folder {
    /// Opens the folder; creates it if it does not exist. Fails at once if it is not writable, so that a long run is
    /// not lost. Removes unfinished files of killed runs.
    pub fn open(path: &Path) -> Result<Self, WriteError> {
        let not_written = |error| WriteError { path: path.into(), error };
        std::fs::create_dir_all(path).map_err(not_written)?;
        tempfile::tempfile_in(path).map_err(not_written)?;
        remove_abandoned(path);
        Ok(Self { path: path.into(), pending: Vec::new() })
    }

    /// Creates a file under a temporary name next to its final place.
    pub fn begin(&self, name: &str) -> Result<PendingFile, WriteError> {
        let path = self.path.join(name);
        match temporary(&self.path, name) {
            Ok(file) => {
                let (file, beside) = file.into_parts();
                Ok(PendingFile { file: BufWriter::with_capacity(BUFFER, file), beside, path })
            }
            Err(error) => Err(WriteError { path, error }),
        }
    }

    /// Completes a file.
    pub fn end(&mut self, mut writing: PendingFile) -> Result<(), WriteError> {
        if let Err(error) = writing.flush() {
            return Err(writing.failed(error));
        }
        let PendingFile { file, beside, path } = writing;
        let file = file.into_inner().map_err(|e| WriteError { path: path.clone(), error: e.into_error() })?;
        self.pending.push((NamedTempFile::from_parts(file, beside), path));
        Ok(())
    }

    /// Writes a file under a temporary name and returns the result of `content`.
    pub fn write<T>(
        &mut self,
        name: &str,
        content: impl FnOnce(&mut PendingFile) -> io::Result<T>,
    ) -> Result<T, WriteError> {
        let mut writing = self.begin(name)?;
        let output = content(&mut writing).map_err(|error| writing.failed(error))?;
        self.end(writing).map(|()| output)
    }

    /// Renames all files to their final names, the last one last. Removes files of this family from earlier runs.
    pub fn commit(mut self, family: &[&str]) -> Result<(), WriteError> {
        let last = self.pending.last().map(|(_, path)| path.clone());
        for path in family.iter().map(|name| self.path.join(name)) {
            // The last file indicates that the results are complete; it is absent while the others are replaced.
            let stays = self.pending.iter().any(|(_, p)| *p == path) && Some(&path) != last.as_ref();
            if !stays {
                remove(path)?;
            }
        }
        for (file, path) in std::mem::take(&mut self.pending) {
            let beside = file.path().to_owned();
            file.persist(&path).map_err(|e| WriteError { path, error: e.error })?;
            under_way(|list| list.retain(|p| *p != beside));
        }
        Ok(())
    }

    /// Removes the files of a family from a folder of an earlier run, and the folder unless it holds anything else.
    pub fn clear(path: &Path, family: &[&str]) -> Result<(), WriteError> {
        family.iter().map(|name| path.join(name)).try_for_each(remove)?;
        // Whatever is left in it is not of this program.
        let _ = std::fs::remove_dir(path);
        Ok(())
    }

    /// Renames all files to their final names; fails if one exists.
    pub fn commit_new(mut self) -> Result<(), WriteError> {
        for (file, path) in std::mem::take(&mut self.pending) {
            file.persist_noclobber(&path).map_err(|e| WriteError { path, error: e.error })?;
        }
        Ok(())
    }

    /// Copies the contents of all files to a pipe or a device.
    fn copy_to(mut self, path: &Path) -> Result<(), WriteError> {
        let copy = |file: &NamedTempFile| {
            io::copy(&mut file.reopen()?, &mut File::options().write(true).open(path)?)
        };
        let mut files = std::mem::take(&mut self.pending).into_iter();
        files
            .try_for_each(|(file, _)| copy(&file).map(drop))
            .map_err(|error| WriteError { path: path.into(), error })
    }

    /// Path of a file.
    pub fn path_of(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }
}

/// Writes one file, whole or not at all. A link stays a link, and its file is written; a pipe or a device receives the
/// content once it is complete.
pub fn write_alone(
    to: &Path,
    content: impl FnOnce(&mut PendingFile) -> io::Result<()>,
) -> Result<(), WriteError> {
    let target = to.canonicalize().unwrap_or_else(|_| to.to_owned());
    let is_stream = target.metadata().is_ok_and(|of| !of.is_file() && !of.is_dir());
    let name = target.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let elsewhere = std::env::temp_dir();
    let mut folder = Folder::open(if is_stream { &elsewhere } else { folder_of(&target) })?;
    folder.write(&name, content)?;
    if is_stream { folder.copy_to(&target) } else { folder.commit(&[]) }
}

/// Writes one new file, whole or not at all; fails if it exists.
pub fn write_new(to: &Path, content: &[u8]) -> Result<(), WriteError> {
    let name = to.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let mut folder = Folder::open(folder_of(to))?;
    folder.write(&name, |out| out.write_all(content))?;
    folder.commit_new()
}

impl PendingFile {
    /// Error for a file that could not be written.
    pub fn failed(&self, error: impl Into<io::Error>) -> WriteError {
        WriteError { path: self.path.clone(), error: error.into() }
    }

    /// Opens the unfinished file for reading, from its beginning.
    pub fn reopen(&mut self) -> io::Result<File> {
        self.file.flush()?;
        File::open(&self.beside)
    }
}

impl Write for PendingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl io::Seek for PendingFile {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        under_way(Vec::clear);
    }
}

/// Removes a file, if it is there.
fn remove(path: PathBuf) -> Result<(), WriteError> {
    match std::fs::remove_file(&path) {
        Err(error) if !is_absent(&error) => Err(WriteError { path, error }),
        Ok(()) | Err(_) => Ok(()),
    }
}

fn is_absent(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::NotFound
}

/// Folder of a file.
pub fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Folder for the results of a case: a subfolder with its name.
pub fn of_case(whole: &Path, case: Option<&str>) -> PathBuf {
    let Some(case) = case else { return whole.to_owned() };
    whole.join(file_name(case))
}

/// Converts a name to a part of a file name: characters that some systems do not allow become `%` and their code, so
/// that different names stay different.
pub fn file_name(name: &str) -> String {
    let allowed = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '+');
    let part = |c: char| if allowed(c) { c.to_string() } else { format!("%{:02X}", u32::from(c)) };
    name.chars().map(part).collect()
}

/// Removes all unfinished files before the program ends at once.
pub fn abandon() {
    under_way(|list| {
        for path in list.drain(..) {
            let _ = std::fs::remove_file(path);
        }
    });
}

fn under_way<X>(what: impl FnOnce(&mut Vec<PathBuf>) -> X) -> X {
    what(&mut UNDER_WAY.lock().unwrap_or_else(std::sync::PoisonError::into_inner))
}

fn temporary(folder: &Path, name: &str) -> io::Result<NamedTempFile> {
    let prefix = format!(".{name}.");
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX);
    // Results have the permissions of ordinary files: the umask applies.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    loop {
        let file = builder.tempfile_in(folder)?;
        // On file systems without locks, no file counts as abandoned.
        let _ = file.as_file().try_lock();
        // Another run may have removed it before it was locked.
        if file.path().exists() {
            under_way(|list| list.push(file.path().to_owned()));
            return Ok(file);
        }
    }
}

/// Removes unfinished files that no program writes any more.
fn remove_abandoned(folder: &Path) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let is_ours = name.to_str().is_some_and(|n| n.starts_with('.') && n.ends_with(SUFFIX));
        let is_file = entry.file_type().is_ok_and(|t| t.is_file());
        if is_ours && is_file && File::open(entry.path()).is_ok_and(|f| f.try_lock().is_ok()) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(path: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            std::fs::read_dir(path).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn opened(path: &Path) -> Folder {
        Folder::open(path).unwrap_or_else(|e| panic!("{}", e.error))
    }

    #[test]
    fn abandoned_files_are_removed_and_locked_files_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let running = opened(folder.path());
        let mut writing = running.begin("motion.csv").unwrap_or_else(|e| panic!("{}", e.error));
        writing.write_all(b"some").unwrap();
        for name in [".motion.csv.Xy12.part", ".mine", "mine.part"] {
            std::fs::write(folder.path().join(name), "x").unwrap();
        }
        drop(opened(folder.path()));
        let left = names(folder.path());
        assert_eq!(left.len(), 3, "{left:?}");
        assert!(left.contains(&".mine".into()) && left.contains(&"mine.part".into()));
        drop(writing);
        assert_eq!(names(folder.path()), [".mine", "mine.part"]);
    }

    #[test]
    fn files_of_an_earlier_run_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a", "b", "c"] {
            std::fs::write(folder.path().join(name), "old").unwrap();
        }
        let mut again = opened(folder.path());
        again.write("a", |out| out.write_all(b"new")).unwrap_or_else(|e| panic!("{}", e.error));
        again.commit(&["a", "b"]).unwrap_or_else(|e| panic!("{}", e.error));
        assert_eq!(names(folder.path()), ["a", "c"]);
        assert_eq!(std::fs::read(folder.path().join("a")).unwrap(), b"new");
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_stay() {
        let folder = tempfile::tempdir().unwrap();
        let [file, link, device] = ["file", "link", "device"].map(|name| folder.path().join(name));
        std::fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink("file", &link).unwrap();
        std::os::unix::fs::symlink("/dev/null", &device).unwrap();
        for to in [&link, &device] {
            write_alone(to, |out| out.write_all(b"new")).unwrap_or_else(|e| panic!("{}", e.error));
            assert!(to.is_symlink(), "{}", to.display());
        }
        assert_eq!(std::fs::read(file).unwrap(), b"new");
        assert!(!Path::new("/dev/null").is_file() && device.exists());
        assert_eq!(names(folder.path()), ["device", "file", "link"]);
    }
}

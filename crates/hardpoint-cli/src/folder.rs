//! Results appear whole or not at all.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use tempfile::{NamedTempFile, TempPath};

/// Files of this size are written at once.
const BUFFER: usize = 1 << 20;
/// Files under way end so; they are locked as long as somebody writes them.
const SUFFIX: &str = ".part";

/// Files under way, for a program that has to end at once.
static UNDER_WAY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A folder, with files that are written but not yet in place.
pub struct Folder {
    path: PathBuf,
    pending: Vec<(NamedTempFile, PathBuf)>,
}

/// A file under way.
pub struct PendingFile {
    file: BufWriter<File>,
    beside: TempPath,
    path: PathBuf,
}

/// A file or folder that could not be written.
pub struct WriteError {
    /// Which.
    pub path: PathBuf,
    /// Why.
    pub error: io::Error,
}

impl Folder {
    /// The folder, made where it does not exist. Fails at once if nothing can be written there, so that a
    /// long run is not lost. What a killed run left under way is removed.
    pub fn open(path: &Path) -> Result<Self, WriteError> {
        let not_written = |error| WriteError { path: path.into(), error };
        std::fs::create_dir_all(path).map_err(not_written)?;
        tempfile::tempfile_in(path).map_err(not_written)?;
        remove_abandoned(path);
        Ok(Self { path: path.into(), pending: Vec::new() })
    }

    /// Begins a file beside its place.
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

    /// Ends a file.
    pub fn end(&mut self, mut writing: PendingFile) -> Result<(), WriteError> {
        if let Err(error) = writing.flush() {
            return Err(writing.failed(error));
        }
        let PendingFile { file, beside, path } = writing;
        let file = file.into_inner().map_err(|e| WriteError { path: path.clone(), error: e.into_error() })?;
        self.pending.push((NamedTempFile::from_parts(file, beside), path));
        Ok(())
    }

    /// Writes a file beside its place, and hands back what `content` indicates of it.
    pub fn write<T>(
        &mut self,
        name: &str,
        content: impl FnOnce(&mut PendingFile) -> io::Result<T>,
    ) -> Result<T, WriteError> {
        let mut writing = self.begin(name)?;
        let told = content(&mut writing).map_err(|error| writing.failed(error))?;
        self.end(writing).map(|()| told)
    }

    /// Puts all files in their places, the last one last; files of this family that were not written now are removed,
    /// so that nothing is next to them that is not of the same run.
    pub fn commit(mut self, family: &[&str]) -> Result<(), WriteError> {
        let last = self.pending.last().map(|(_, path)| path.clone());
        for path in family.iter().map(|name| self.path.join(name)) {
            // The last one vouches for the others: while they change places, there is none.
            let stays = self.pending.iter().any(|(_, p)| *p == path) && Some(&path) != last.as_ref();
            let removed = if stays { Ok(()) } else { std::fs::remove_file(&path) };
            if let Err(error) = removed.or_else(|e| if is_absent(&e) { Ok(()) } else { Err(e) }) {
                return Err(WriteError { path, error });
            }
        }
        for (file, path) in std::mem::take(&mut self.pending) {
            let beside = file.path().to_owned();
            file.persist(&path).map_err(|e| WriteError { path, error: e.error })?;
            under_way(|list| list.retain(|p| *p != beside));
        }
        Ok(())
    }

    /// Puts all files in their places, where there are none yet.
    pub fn commit_new(mut self) -> Result<(), WriteError> {
        for (file, path) in std::mem::take(&mut self.pending) {
            file.persist_noclobber(&path).map_err(|e| WriteError { path, error: e.error })?;
        }
        Ok(())
    }

    /// The place of a file.
    pub fn path_of(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }
}

impl PendingFile {
    /// Error for a file that could not be written.
    pub fn failed(&self, error: impl Into<io::Error>) -> WriteError {
        WriteError { path: self.path.clone(), error: error.into() }
    }

    /// Another view of what is written, from its beginning.
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

fn is_absent(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::NotFound
}

/// Folder of the results of a case: one with its own name.
pub fn of_case(whole: &Path, case: Option<&str>) -> PathBuf {
    let Some(case) = case else { return whole.to_owned() };
    whole.join(file_name(case))
}

/// A name as part of a file's name: what not every system allows there as `%` and its number, so that no two names
/// become one.
pub fn file_name(name: &str) -> String {
    let allowed = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '+');
    let part = |c: char| if allowed(c) { c.to_string() } else { format!("%{:02X}", u32::from(c)) };
    name.chars().map(part).collect()
}

/// Removes all files under way, for a program that has to end at once.
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
    // Results are no secret: like other files, they are readable as far as the umask says.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    loop {
        let file = builder.tempfile_in(folder)?;
        // On file systems without locks, nothing is ever taken for abandoned.
        let _ = file.as_file().try_lock();
        // Another run may have taken it for abandoned before it was locked.
        if file.path().exists() {
            under_way(|list| list.push(file.path().to_owned()));
            return Ok(file);
        }
    }
}

/// Removes files under way that nobody writes any more.
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
    fn what_was_left_under_way_is_removed_and_what_is_under_way_is_not() {
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
    fn files_of_an_earlier_run_do_not_stay_beside_the_new_ones() {
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
}

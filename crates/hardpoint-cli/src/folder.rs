//! Results appear whole or not at all.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// A folder, with files that are written but not yet in place.
pub struct Folder {
    path: PathBuf,
    pending: Vec<(NamedTempFile, PathBuf)>,
}

/// A file or folder that could not be written.
pub struct NotWritten {
    /// Which.
    pub path: PathBuf,
    /// Why.
    pub error: io::Error,
}

impl Folder {
    /// The folder, made where it does not exist. Fails at once if nothing can be written there, so that a
    /// long run is not lost.
    pub fn open(path: &Path) -> Result<Self, NotWritten> {
        let not_written = |error| NotWritten { path: path.into(), error };
        std::fs::create_dir_all(path).map_err(not_written)?;
        tempfile::tempfile_in(path).map_err(not_written)?;
        Ok(Self { path: path.into(), pending: Vec::new() })
    }

    /// Writes a file beside its place.
    pub fn write(
        &mut self,
        name: &str,
        content: impl FnOnce(&mut BufWriter<&mut NamedTempFile>) -> io::Result<()>,
    ) -> Result<(), NotWritten> {
        let path = self.path.join(name);
        let not_written = |error| NotWritten { path: path.clone(), error };
        let mut file = temporary(&self.path, name).map_err(not_written)?;
        let mut buffered = BufWriter::with_capacity(1 << 20, &mut file);
        content(&mut buffered).and_then(|()| buffered.flush()).map_err(not_written)?;
        drop(buffered);
        self.pending.push((file, path));
        Ok(())
    }

    /// Puts all files in their places.
    pub fn commit(self) -> Result<(), NotWritten> {
        for (file, path) in self.pending {
            file.persist(&path).map_err(|e| NotWritten { path, error: e.error })?;
        }
        Ok(())
    }

    /// The place of a file.
    pub fn path_of(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }
}

fn temporary(folder: &Path, name: &str) -> io::Result<NamedTempFile> {
    let prefix = format!(".{name}.");
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix);
    // Results are no secret: like other files, they are readable as far as the umask says.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

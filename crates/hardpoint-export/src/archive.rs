//! Archives of files: formats that consist of more than one file.

use std::io::{self, Seek, Write};

use zip::write::{SimpleFileOptions, ZipWriter};

/// Files of an exported model that are packed as one, with a library that is compiled of them.
#[derive(Clone, Debug, Default)]
pub struct Archive {
    /// Path within the archive and text of every file.
    pub files: Vec<(String, String)>,
    /// Folder of the sources, and the names of those that a compiler reads: C99.
    pub sources: (String, Vec<String>),
    /// Name of the shared library, without its extension.
    pub library: String,
}

/// Shared library that was compiled of the sources of an archive.
#[derive(Clone, Debug)]
pub struct Library {
    /// Name of the platform in the format, as in `x86_64-linux`.
    pub platform: &'static str,
    /// File extension, without the dot.
    pub ending: &'static str,
    /// Contents.
    pub bytes: Vec<u8>,
}

impl Archive {
    /// Writes the archive, with or without the library, and returns what it wrote to.
    ///
    /// # Errors
    ///
    /// The file cannot be written.
    pub fn write<W: Write + Seek>(&self, library: Option<&Library>, to: W) -> io::Result<W> {
        let mut zip = ZipWriter::new(to);
        // The time is the earliest that the format knows: the same model gives the same file.
        let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
        for (path, text) in &self.files {
            zip.start_file(path, options)?;
            zip.write_all(text.as_bytes())?;
        }
        if let Some(Library { platform, ending, bytes }) = library {
            zip.start_file(
                format!("binaries/{platform}/{}.{ending}", self.library),
                options.unix_permissions(0o755),
            )?;
            zip.write_all(bytes)?;
        }
        Ok(zip.finish()?)
    }
}

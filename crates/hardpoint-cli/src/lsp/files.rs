//! Files of an editor: addresses and paths, open texts, and the model that a file is a part of.

use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use hardpoint_file::{Document, LARGEST_DOCUMENT};

use super::position::Lines;

/// Maximum number of files of a folder that are searched for the one that includes a file.
const MOST_SEARCHED: usize = 100;

/// An open text.
#[derive(Debug)]
pub struct OpenText {
    /// Version of the editor.
    pub version: i64,
    /// Language of its text.
    pub document: Document,
    /// Lines of its text.
    pub lines: Lines,
}

impl OpenText {
    /// Opens a text.
    pub fn new(text: &str, version: i64) -> Self {
        Self { version, document: Document::new(text), lines: Lines::of(text) }
    }

    /// True if the text is too large for language features.
    pub fn is_too_large(text: &str) -> bool {
        text.len() > LARGEST_DOCUMENT
    }
}

/// Open texts by their addresses.
pub type OpenTexts = HashMap<String, Arc<OpenText>>;

/// Path of an address `file:///...`; `None` for a text that is in no file.
pub fn path_of(uri: &str) -> Option<PathBuf> {
    let rest = uri.strip_prefix("file://")?;
    // The host, if any, is this machine.
    let rest = &rest[rest.find('/')?..];
    let mut bytes = Vec::with_capacity(rest.len());
    let mut input = rest.bytes();
    while let Some(byte) = input.next() {
        if byte == b'%' {
            let digits = [input.next()?, input.next()?];
            bytes.push(u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?);
        } else {
            bytes.push(byte);
        }
    }
    let path = String::from_utf8(bytes).ok()?;
    // `/C:/models` is `C:/models`.
    let has_drive = path.as_bytes().get(2) == Some(&b':') && path.as_bytes()[1].is_ascii_alphabetic();
    Some(PathBuf::from(if has_drive { &path[1..] } else { &path }))
}

/// Address of a path.
pub fn uri_of(path: &Path) -> String {
    let path = path.display().to_string().replace('\\', "/");
    let mut uri = String::from(if path.starts_with('/') { "file://" } else { "file:///" });
    for byte in path.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' | b':' => {
                uri.push(char::from(byte));
            }
            _ => uri += &format!("%{byte:02X}"),
        }
    }
    uri
}

/// Text of a file: as it is open, or from the disk.
pub fn text_of(open: &OpenTexts, path: &Path) -> Option<String> {
    let is_same = |uri: &str| path_of(uri).is_some_and(|p| plain(&p) == plain(path));
    if let Some((_, text)) = open.iter().find(|(uri, _)| is_same(uri)) {
        return Some(text.document.text().to_owned());
    }
    let size = std::fs::metadata(path).ok()?.len();
    if size > LARGEST_DOCUMENT as u64 { None } else { std::fs::read_to_string(path).ok() }
}

/// Path without `.` and `..`.
pub fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            part => plain.push(part),
        }
    }
    plain
}

/// File that includes this one: an open one, or one of the same folder or the folder above it.
pub fn root_of(open: &OpenTexts, path: &Path) -> Option<PathBuf> {
    let wanted = plain(path);
    let includes = |root: &Path, document: &Document| {
        let folder = root.parent().unwrap_or(Path::new(""));
        plain(root) != wanted && document.includes().iter().any(|i| plain(&folder.join(&i.file)) == wanted)
    };
    let open_root = open.iter().filter_map(|(uri, text)| Some((path_of(uri)?, text)));
    if let Some((root, _)) = open_root.into_iter().find(|(root, text)| includes(root, &text.document)) {
        return Some(root);
    }
    let folders = [path.parent(), path.parent().and_then(Path::parent)];
    let mut searched = 0;
    for folder in folders.into_iter().flatten() {
        let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
            .into_iter()
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|file| file.extension().is_some_and(|e| e == "toml"))
            .collect();
        files.sort();
        for file in files {
            searched += 1;
            if searched > MOST_SEARCHED {
                return None;
            }
            let text = text_of(open, &file).filter(|text| text.contains("include"));
            if text.is_some_and(|text| includes(&file, &Document::new(&text))) {
                return Some(file);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_and_paths_agree() {
        for (path, uri) in [
            ("/home/a b/straße.toml", "file:///home/a%20b/stra%C3%9Fe.toml"),
            ("/x/100%.toml", "file:///x/100%25.toml"),
        ] {
            assert_eq!(uri_of(Path::new(path)), uri);
            assert_eq!(path_of(uri), Some(PathBuf::from(path)));
        }
        assert_eq!(path_of("file:///c%3A/models/x.toml"), Some(PathBuf::from("c:/models/x.toml")));
        for uri in ["untitled:Untitled-1", "file:///%zz", "file:///%4", "file://host"] {
            assert_eq!(path_of(uri), None, "{uri}");
        }
    }
}

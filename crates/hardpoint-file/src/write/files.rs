//! Text of a model for another folder: names of files count from the folder of the model file.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use toml::de::{DeTable, DeValue};
use toml_edit::Value as Written;

use crate::read::{MODEL, ModelFile};
use crate::values::{Diagnostic, Diagnostics, Leaf, Severity, Value, shown, walk};

use super::edit::CODE;

impl ModelFile {
    /// This file's text, or an edited one, for a model file in the folder `to`: the names of files that the model reads
    /// are relative to it. `from` is the folder of this file; `None` if it is a text without a folder. Comments and
    /// layout are preserved. A name is unchanged if `to` has a file of this name with the same contents.
    ///
    /// # Errors
    /// Lists the files that are not in `to` or below it, where a model cannot name them.
    pub fn text_for(&self, text: &str, from: Option<&Path>, to: &Path) -> Result<String, Diagnostics> {
        let to = real(to);
        let from = from.map(real);
        if from.as_ref() == Some(&to) {
            return Ok(text.to_owned());
        }
        let (mut faults, mut known): (Vec<Diagnostic>, BTreeSet<String>) = Default::default();
        let text = renamed(text, &mut |section, name| {
            let there = from.as_ref().and_then(|from| name_from(&to, &from.join(name)));
            if there.is_none() && known.insert(name.to_owned()) {
                faults.extend(self.missing(name, section == "include", from.as_deref(), &to));
            }
            there
        });
        if faults.is_empty() { Ok(text) } else { Err(Diagnostics::new(self.source.clone(), faults)) }
    }

    /// Names of all files that the model reads, relative to its folder: included files, data and shapes, also those
    /// that included files name.
    pub fn file_names(&self) -> BTreeSet<String> {
        let mut names = BTreeSet::new();
        let mut texts = vec![(String::new(), self.text())];
        while let Some((folder, text)) = texts.pop() {
            renamed(text, &mut |section, name| {
                let name = format!("{folder}{name}");
                let text = self.texts.get(&name).filter(|_| section == "include");
                if names.insert(name.clone())
                    && let Some(text) = text
                {
                    let end = name.rfind('/').map_or(0, |end| end + 1);
                    texts.push((name[..end].to_owned(), text));
                }
                None
            });
        }
        names
    }

    /// Checks that a copy of the model at `to` would not overwrite a file that the model reads. `from` is the folder of
    /// this file.
    ///
    /// # Errors
    /// Names the file if it would.
    pub fn spares_its_files(&self, from: &Path, to: &Path) -> Result<(), Diagnostics> {
        let Ok(to) = to.canonicalize() else { return Ok(()) };
        let is_target = |name: &String| from.join(name).canonicalize().is_ok_and(|file| file == to);
        let Some(name) = self.file_names().into_iter().find(is_target) else { return Ok(()) };
        let name = shown(&name);
        let message = format!("the model cannot be saved as `{name}`: it reads this file");
        let fault = self.diagnostic(Severity::Error, CODE, message, None).help("save it under another name");
        Err(Diagnostics::new(self.source.clone(), vec![fault]))
    }

    /// HP0505: a file that the folder of a copy of the model does not have, or an included file there that names one.
    fn missing(&self, name: &str, is_included: bool, from: Option<&Path>, to: &Path) -> Option<Diagnostic> {
        let own = match from {
            Some(from) => std::fs::read(from.join(name)).ok(),
            None => self.texts.get(name).map(|text| text.clone().into_bytes()),
        };
        let there = std::fs::read(to.join(name)).ok();
        // The contents of a mesh are not part of a text without a folder.
        let is_unknown = own.is_none() && from.is_none();
        if there.is_some() && (own == there || is_unknown) {
            // An included file names further files in its own folder.
            let text = String::from_utf8(own.unwrap_or_default()).unwrap_or_default();
            let mut found = None;
            if is_included {
                renamed(&text, &mut |section, further| {
                    let further =
                        name.rsplit_once('/').map_or(further.into(), |(at, _)| format!("{at}/{further}"));
                    // The file has been read, so no file includes itself.
                    found = found.take().or_else(|| self.missing(&further, section == "include", from, to));
                    None
                });
            }
            return found;
        }
        let (name, folder) = (shown(name), to.display());
        let message =
            format!("the model cannot be saved in `{folder}`: it reads `{name}`, which is not there");
        let d = self.diagnostic(Severity::Error, CODE, message, None);
        let d = match &there {
            Some(_) => d.note(format!("the `{name}` there has other contents")),
            None => d,
        };
        let d = d.note("a model reads files of its own folder, or below it, only");
        Some(match from {
            Some(from) => d.help(format!("save it in `{}`, or copy `{name}` first", from.display())),
            None => d.help(format!("copy `{name}` there first")),
        })
    }
}

/// Canonical path of a folder that may not exist yet.
fn real(folder: &Path) -> PathBuf {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    folder.canonicalize().unwrap_or_else(|_| match (folder.parent(), folder.file_name()) {
        (Some(parent), Some(name)) => real(parent).join(name),
        _ => folder.to_owned(),
    })
}

/// Name of a file in a folder or below it, as models write it.
fn name_from(folder: &Path, file: &Path) -> Option<String> {
    let parts = file.strip_prefix(folder).ok()?.components().map(|part| match part {
        Component::Normal(part) => part.to_str(),
        Component::Prefix(_) | Component::RootDir | Component::CurDir | Component::ParentDir => None,
    });
    Some(parts.collect::<Option<Vec<&str>>>()?.join("/"))
}

/// Text of a model with other names of files: `say` returns them by their section and present name.
fn renamed(text: &str, say: &mut dyn FnMut(&str, &str) -> Option<String>) -> String {
    let document = DeTable::parse_recoverable(text).0.into_inner();
    let mut edits = Vec::new();
    for (section, before) in &document {
        let section = section.get_ref();
        let mut after = before.clone();
        walk("", MODEL.shape_of(section), &mut after, &mut |_, leaf| {
            if let Leaf::File(name) = leaf
                && let Some(other) = say(section, name)
            {
                *name = Cow::Owned(other);
            }
        });
        differences(before, &after, &mut edits);
    }
    edits.sort_by_key(|(at, _)| at.start);
    let (mut out, mut end) = (String::with_capacity(text.len()), 0);
    for (at, name) in edits {
        out += &text[end..at.start];
        out += &Written::from(name).to_string();
        end = at.end;
    }
    out + &text[end..]
}

/// Texts of a value that are different after, with their places.
fn differences(before: &Value<'_>, after: &Value<'_>, edits: &mut Vec<(Range<usize>, String)>) {
    match (before.get_ref(), after.get_ref()) {
        (DeValue::String(old), DeValue::String(new)) if old != new => {
            edits.push((before.span(), new.to_string()));
        }
        (DeValue::Array(old), DeValue::Array(new)) => {
            old.iter().zip(new.iter()).for_each(|(old, new)| differences(old, new, edits));
        }
        (DeValue::Table(old), DeValue::Table(new)) => {
            let pairs = old.iter().filter_map(|(key, old)| Some((old, new.get(&**key.get_ref())?)));
            pairs.for_each(|(old, new)| differences(old, new, edits));
        }
        _ => {}
    }
}

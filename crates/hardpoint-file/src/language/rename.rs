//! A new name for an entry, at all its places.

use std::ops::Range;
use std::path::Path;

use crate::read::parse_in;
use crate::values::shown;

use super::complete::quoted_key;
use super::names::{EntryName, NameUse};
use super::{Document, NameAt};

/// Reason why an entry cannot be renamed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenameError(pub String);

impl std::fmt::Display for RenameError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for RenameError {}

impl Document {
    /// Entry at a byte of the text that can be renamed.
    ///
    /// # Errors
    /// Fails if there is no name of an entry, or if its entry is elsewhere.
    pub fn renameable_at(&self, at: usize) -> Result<NameAt, RenameError> {
        if let Some((name, _)) = self.foreign_name_at(at) {
            let why = match name {
                "ground" => "`ground` is the fixed body of every model".to_owned(),
                _ => format!("`{}` is not declared in this file", shown(name)),
            };
            return Err(RenameError(why));
        }
        let Some((_, found)) = self.resolved(at) else {
            return Err(RenameError("there is no name of an entry here".into()));
        };
        if found.is_image {
            let name = &found.entry.name;
            let why = format!("this is the mirror image of `{name}`; rename `{name}`, and its image follows");
            return Err(RenameError(why));
        }
        self.name_at(at).ok_or_else(|| RenameError("there is no name of an entry here".into()))
    }

    /// Edits that give the entry at a byte of the text another name, wherever the text names it. Mirror images, and
    /// the variables of a point, follow. The renamed text is read again: it must be a valid model with the same
    /// references. `folder` is the folder of the file, if it has one.
    ///
    /// # Errors
    /// Fails if the name cannot be changed without changing the model.
    pub fn rename(
        &self,
        at: usize,
        new: &str,
        folder: Option<&Path>,
    ) -> Result<Vec<(Range<usize>, String)>, RenameError> {
        let fail = |why: String| Err(RenameError(why));
        let NameAt { section, name, .. } = self.renameable_at(at)?;
        let new = new.trim();
        if new.is_empty() || new.chars().any(|c| c.is_control() || matches!(c, '"' | '\'' | '\\')) {
            return fail("a name has at least one character, and no quotes or backslashes".into());
        }
        if new == name {
            return Ok(Vec::new());
        }
        let has_new = |o: &super::Occurrence| o.name == new && o.of == NameUse::Declaration(section);
        if self.index.names.iter().any(has_new) {
            return fail(format!("`[{section}]` has an entry `{}` already", shown(new)));
        }
        let entry = EntryName { section, name: name.clone() };
        let mut edits = Vec::new();
        for (o, found) in self.index.occurrences(&entry) {
            if !o.is_plain {
                return fail(format!(
                    "`{}` is written with escapes; write it without them first",
                    shown(&name)
                ));
            }
            let range = o.at.start..o.at.start + found.length;
            let name = if found.is_image { self.index.image(new) } else { Some(new.to_owned()) };
            let Some(name) = name else {
                let why = "the text names its mirror image, and the new name has no word of a side";
                return fail(why.into());
            };
            let is_key = matches!(o.of, NameUse::Declaration(_) | NameUse::Key(_));
            let is_quoted = self.text[..range.start].ends_with(['"', '\'']);
            edits.push((range, if is_key && !is_quoted { quoted_key(&name) } else { name }));
        }
        edits.sort_by_key(|(at, _)| at.start);
        self.check(&entry, new, &edits, folder)?;
        Ok(edits)
    }

    /// Reads the text before and after the edits.
    fn check(
        &self,
        entry: &EntryName,
        new: &str,
        edits: &[(Range<usize>, String)],
        folder: Option<&Path>,
    ) -> Result<(), RenameError> {
        let file = parse_in(folder, &self.text, "model").map_err(|all| {
            let first = all.list().first().map_or("", |d| d.message.as_str());
            RenameError(format!("correct the errors of the file first: {first}"))
        })?;
        if let Some(included) = file.origins.included.get(&entry.name) {
            let why = format!("`{}` changes an entry of the included file `{included}`", shown(&entry.name));
            return Err(RenameError(why));
        }
        let mut text = self.text.clone();
        for (at, name) in edits.iter().rev() {
            text.replace_range(at.clone(), name);
        }
        parse_in(folder, &text, "model").map_err(|all| {
            let first = all.list().first().map_or("", |d| d.message.as_str());
            RenameError(format!("with the name `{}` the model has an error: {first}", shown(new)))
        })?;
        let renamed = Self::new(&text);
        let entry = EntryName { section: entry.section, name: new.to_owned() };
        if renamed.index.occurrences(&entry).count() != edits.len() {
            let why = format!("another entry is named `{}` where this one is used", shown(new));
            return Err(RenameError(why));
        }
        Ok(())
    }
}

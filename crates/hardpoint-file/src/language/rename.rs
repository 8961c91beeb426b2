//! A new name for an entry, at all its places.

use std::fmt::Write;
use std::hash::{DefaultHasher, Hasher};
use std::ops::Range;
use std::path::Path;

use hardpoint::draft::matches_pattern;
use hardpoint::model::Model;

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
    /// the variables of a point, follow. The renamed text is read again: it must be the same model except for names,
    /// and patterns must match the same entries. `folder` is the folder of the file, if it has one.
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
        let has_new = |o: &super::names::Occurrence| o.name == new && o.of == NameUse::Declaration(section);
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
        let before = parse_in(folder, &self.text, "model").map_err(|all| {
            let first = all.list().first().map_or("", |d| d.message.as_str());
            RenameError(format!("correct the errors of the file first: {first}"))
        })?;
        if let Some(included) = before.origins.included.get(&entry.name) {
            let why = format!("`{}` changes an entry of the included file `{included}`", shown(&entry.name));
            return Err(RenameError(why));
        }
        let (old, now) = (shown(&entry.name), shown(new));
        if let Some((pattern, is_matched)) = self.changed_pattern(&entry.name, new, entry.section) {
            let (yes, no) = if is_matched { (&old, &now) } else { (&now, &old) };
            let why = format!("the pattern `{}` matches `{yes}` but not `{no}`", shown(pattern));
            return Err(RenameError(why));
        }
        let mut text = self.text.clone();
        for (at, name) in edits.iter().rev() {
            text.replace_range(at.clone(), name);
        }
        let [image, image_now] = [entry.name.as_str(), new].map(|name| self.index.image(name));
        let lost =
            image.as_ref().filter(|image| image_now.is_none() && before.origins.names.contains_key(*image));
        let lost = lost.map(|image| {
            let image = shown(image);
            format!("`{now}` has no word of a side, so the mirror image `{image}` of `{old}` would be lost")
        });
        let after = parse_in(folder, &text, "model").map_err(|all| {
            let first = all.list().first().map_or("", |d| d.message.as_str());
            let why = || format!("with the name `{now}` the model has an error: {first}");
            RenameError(lost.clone().unwrap_or_else(why))
        })?;
        let renamed = Self::new(&text);
        let entry_now = EntryName { section: entry.section, name: new.to_owned() };
        if renamed.index.occurrences(&entry_now).count() != edits.len() {
            let why = format!("another entry is named `{now}` where this one is used");
            return Err(RenameError(why));
        }
        if structure(&before.model) == structure(&after.model) {
            return Ok(());
        }
        let gained = image_now.filter(|name| image.is_none() && after.origins.names.contains_key(name));
        let gained = gained.map(|image| {
            let image = shown(&image);
            format!("`{now}` has a word of a side, so it would have a mirror image `{image}`")
        });
        let other =
            || format!("the model depends on the name `{old}`: with `{now}` it would not be the same");
        Err(RenameError(lost.or(gained).unwrap_or_else(other)))
    }

    /// Pattern of shapes that matches only one of the names of a shape: the old one if true.
    fn changed_pattern(&self, old: &str, new: &str, section: &str) -> Option<(&str, bool)> {
        let is_pattern = |o: &&super::names::Occurrence| {
            matches!(o.of, NameUse::Key("a shape") | NameUse::Value("a shape")) && o.name.contains('*')
        };
        let patterns = self.index.names.iter().filter(is_pattern).map(|o| o.name.as_str());
        let mut patterns = patterns.filter(|_| section == "shapes");
        patterns.find_map(|pattern| {
            let is_matched = matches_pattern(pattern, old);
            (is_matched != matches_pattern(pattern, new)).then_some((pattern, is_matched))
        })
    }
}

/// Digest of everything in a model except texts, and so except names: its parts refer to each other by number.
fn structure(model: &Model) -> u64 {
    /// Writer that omits what is between quotes.
    #[derive(Default)]
    struct WithoutTexts {
        digest: DefaultHasher,
        in_text: bool,
        is_escaped: bool,
    }
    impl Write for WithoutTexts {
        fn write_str(&mut self, part: &str) -> std::fmt::Result {
            for byte in part.bytes() {
                if std::mem::take(&mut self.is_escaped) {
                    continue;
                }
                match byte {
                    b'"' => self.in_text = !self.in_text,
                    b'\\' if self.in_text => self.is_escaped = true,
                    _ if self.in_text => {}
                    byte => self.digest.write_u8(byte),
                }
            }
            Ok(())
        }
    }
    let mut writer = WithoutTexts::default();
    // This writer has no errors.
    let _ = write!(writer, "{model:?}");
    writer.digest.finish()
}

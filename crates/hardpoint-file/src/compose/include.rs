//! Included files: a corner in an axle, an axle in a vehicle.
//!
//! All files of a model are one [`Source`]; their values are merged before they are read and keep their locations.

use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::ops::Range;
use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::values::{
    DataError, Folder, LARGEST_FILE, Leaf, NUMBER, Reader, Shape, Table, Texts, Value, Wanted, bytes_of,
    in_expression, shown, table, table_of, text_from, walk,
};

use super::entries::{Both, SECTIONS, lay_under};
use super::mirror::{Opposites, Origins, both_sides};
use super::planar::planar;

pub(crate) const INCLUDE: Shape =
    Shape::list(&Shape::Any("Include", "", &[Shape::File, Shape::Table(&INCLUDE_TABLE)]));
pub(crate) const INCLUDE_TABLE: Table = table! {
    /// Another file, with a prefix for its names and values of its parameters.
    "IncludeTable":
    /// A model file in this one's folder or below it.
    must "file": Shape::File, "\"corner.toml\"";
    /// Prefix of all names that the file declares.
    or("\"\"") "prefix": Shape::Text, "\"left_\"";
    /// Names without the prefix: those that this file also has, or that several files share.
    may "shared": Shape::list(&Shape::Name("a thing")), "[\"rack\"]";
    /// Values that replace those of its parameters.
    may "parameters": Shape::Entries("a parameter", &NUMBER), "{ track = 1500 }";
};
/// Maximum number of files.
const MOST_FILES: usize = 100;
/// Minimum size in bytes by which each inclusion counts towards the total limit, so that repeated inclusions end.
const LEAST_BYTES: u64 = 64 << 10;
const WANTED: Wanted<'static> = Wanted {
    purpose: "model",
    kind: "a model file",
    ending: "toml",
    example: "corners/front.toml",
    without_folder: "put its tables into this file, or read the model from a file",
    too_large: "remove unused entries from it",
};

/// An included file of a model.
pub(crate) struct Part {
    /// Name relative to the first file.
    pub name: String,
    pub text: String,
}

/// Error of an included file, and its place: the file (0 is the first), and the range there.
pub(crate) struct IncludeError {
    pub file: usize,
    pub at: Range<usize>,
    pub error: DataError,
}

/// All files that a text includes directly or indirectly, each once.
pub(crate) fn parts_of(folder: Folder<'_>, text: &str) -> (Vec<Part>, Vec<IncludeError>) {
    let (mut parts, mut hindrances): (Vec<Part>, Vec<IncludeError>) = Default::default();
    let (mut file, mut bytes) = (0, text.len() as u64);
    while file <= parts.len() {
        let (name, text) = match file.checked_sub(1) {
            None => ("", text),
            Some(k) => (parts[k].name.as_str(), parts[k].text.as_str()),
        };
        let mut found = Vec::new();
        // Invalid TOML is reported when the file is read.
        if text.contains("include") {
            let document = DeTable::parse_recoverable(text).0;
            for (asked, at) in files_of(document.get_ref()) {
                found.push((beside(name, asked), at));
            }
        }
        for (name, at) in found {
            if parts.iter().any(|part| part.name == name) {
                continue;
            }
            let read = bytes_of(folder, &name, &WANTED).and_then(|bytes| text_from(bytes, &name));
            let error = match read {
                Ok(_) if parts.len() == MOST_FILES => DataError::unreadable(
                    format!("the model has more than {MOST_FILES} files"),
                    "combine some of them",
                ),
                Ok(text) if bytes + text.len() as u64 > LARGEST_FILE => {
                    let limit = LARGEST_FILE >> 20;
                    let message = format!("the files of the model have more than {limit} MiB together");
                    DataError::unreadable(message, WANTED.too_large)
                }
                Ok(text) => {
                    bytes += text.len() as u64;
                    parts.push(Part { name, text });
                    continue;
                }
                Err(error) => error,
            };
            hindrances.push(IncludeError { file, at, error });
        }
        file += 1;
    }
    (parts, hindrances)
}

/// Files that a table includes, with their locations.
fn files_of<'t>(table: &'t DeTable<'_>) -> Vec<(&'t str, Range<usize>)> {
    let list = table.get("include").and_then(|v| v.get_ref().as_array()).into_iter().flatten();
    let name = |value: &'t Value<'_>| {
        let value = match value.get_ref() {
            DeValue::Table(table) => table.get("file")?,
            _ => value,
        };
        Some((value.get_ref().as_str()?, value.span()))
    };
    list.filter_map(name).collect()
}

/// Path of a file named `asked` in another file, relative to the first file of the model.
fn beside(file: &str, asked: &str) -> String {
    match Path::new(file).parent().filter(|folder| !folder.as_os_str().is_empty()) {
        Some(folder) => format!("{}/{asked}", folder.display()),
        None => asked.to_owned(),
    }
}

/// Shifts the locations of a table.
pub(crate) fn shifted(table: &mut DeTable<'_>, by: usize) {
    for (key, mut value) in std::mem::take(table) {
        shift(&mut value, by);
        let at = key.span();
        table.insert(Spanned::new(at.start + by..at.end + by, key.into_inner()), value);
    }
}

fn shift(value: &mut Value<'_>, by: usize) {
    match value.get_mut() {
        DeValue::Array(list) => list.iter_mut().for_each(|value| shift(value, by)),
        DeValue::Table(table) => shifted(table, by),
        _ => {}
    }
    let at = value.span();
    let inner = std::mem::replace(value.get_mut(), DeValue::Boolean(false));
    *value = Spanned::new(at.start + by..at.end + by, inner);
}

/// Files of a model, as written.
pub(crate) struct Files<'a> {
    /// Tables with the names of their files; the first has none.
    pub tables: Vec<(String, DeTable<'a>)>,
    pub numbers: &'a Opposites,
    /// Sizes in bytes.
    pub sizes: Vec<u64>,
}

/// Merges a model with this format into one table: included files, the file itself, and the mirror images of both.
/// Errors are reported. Returns the origins of mirror images and of included entries as well.
pub(crate) fn whole<'a>(
    r: &mut Reader<'_>,
    format: &'static Table,
    mut files: Files<'a>,
) -> (Both<'a>, Origins) {
    let first = &mut files.tables[0].1;
    if !["include", "mirror", "planar"].iter().any(|key| first.contains_key(*key)) {
        return (Both { table: std::mem::take(first), twins: HashMap::new() }, Origins::default());
    }
    let mut composer = Composer { r, format, files: &files, included: 0, origins: Origins::default() };
    let both = composer.put_together(0, &mut vec![0]);
    (both, composer.origins)
}

/// The merge of the files of one model.
struct Composer<'c, 's, 'a> {
    r: &'c mut Reader<'s>,
    format: &'static Table,
    files: &'c Files<'a>,
    /// Size of all included files in bytes.
    included: u64,
    origins: Origins,
}

impl<'a> Composer<'_, '_, 'a> {
    fn put_together(&mut self, k: usize, above: &mut Vec<usize>) -> Both<'a> {
        let files = self.files;
        let (name, written) = &files.tables[k];
        let mut own = written.clone();
        if name.contains('/') {
            files_from_there(self.format, &mut own, name);
        }
        let mut both = Both { table: DeTable::new(), twins: HashMap::new() };
        for value in self.includes(written) {
            if let Some(part) = self.included(value, name, above) {
                self.units_of(&mut own, &part.table, value);
                merge(self.format, &mut both.table, part.table);
                both.twins.extend(part.twins);
            }
        }
        // Entries of this file take precedence; they come after those of the included files.
        let included = std::mem::take(&mut both.table);
        both.table = own;
        under(self.format, &mut both.table, included);
        planar(self.r, self.format, &mut both.table);
        if self.r.found.is_empty()
            && let Some(mirrored) =
                both_sides(self.r, self.format, &both.table, self.files.numbers, &mut self.origins)
        {
            both.table = mirrored.table;
            both.twins.extend(mirrored.twins);
        }
        both
    }

    /// Entries of `include`.
    fn includes<'t>(&mut self, table: &'t DeTable<'a>) -> Vec<&'t Value<'a>> {
        let Some(value) = table.get("include") else { return Vec::new() };
        match value.get_ref().as_array() {
            Some(list) => list.iter().collect(),
            None => {
                self.r.report("HP0105", value.span(), "`include` must be a list of files").help =
                    Some("for example `include = [\"corner.toml\"]`".into());
                Vec::new()
            }
        }
    }

    /// One included file, with prefixed names and new parameter values.
    fn included(&mut self, value: &Value<'a>, from: &str, above: &mut Vec<usize>) -> Option<Both<'a>> {
        let at = value.span();
        let (mut prefix, mut shared, mut parameters) = (String::new(), BTreeSet::new(), None);
        let asked = match value.get_ref() {
            DeValue::String(name) => name.to_string(),
            DeValue::Table(table) => {
                let fields = self.r.fields("an entry of `include`", at.clone(), table, INCLUDE_TABLE.keys());
                let file = self.r.name_of(&fields, "file")?;
                prefix = self.r.name_of(&fields, "prefix")?;
                if let Some(f) = fields.get("shared") {
                    let subject = fields.subject("shared");
                    for v in self.r.list(f.value, &subject, "a list of names").into_iter().flatten() {
                        shared.extend(self.r.name(v, &subject, "a name in quotes"));
                    }
                }
                if let Some(f) = fields.get("parameters") {
                    let subject = fields.subject("parameters");
                    self.r.table(f.value, &subject, "a table of parameters' names and values")?;
                }
                parameters = table.get("parameters").and_then(|v| v.get_ref().as_table());
                file
            }
            _ => {
                self.r.report("HP0105", at, "an entry of `include` must be a file's name or a table").help =
                    Some("for example `{ file = \"corner.toml\", prefix = \"left_\" }`".into());
                return None;
            }
        };
        let name = beside(from, &asked);
        // A file that could not be read has been reported.
        let k = self.files.tables.iter().skip(1).position(|file| file.0 == name)? + 1;
        if above.contains(&k) {
            let message = format!("the file `{}` includes itself", shown(&name));
            let way: Vec<String> =
                above.iter().skip(1).chain([&k]).map(|k| format!("`{}`", self.files.tables[*k].0)).collect();
            self.r.report("HP0117", at, message).notes.push(format!("by way of {}", way.join(", ")));
            return None;
        }
        self.included += self.files.sizes[k].max(LEAST_BYTES);
        if self.included > LARGEST_FILE {
            let message = "includes are nested too deeply".to_owned();
            self.r.report("HP0117", at, message).help =
                Some("include each of them only where it is needed".into());
            return None;
        }
        above.push(k);
        let mut part = self.put_together(k, above);
        above.pop();
        let all: BTreeSet<String> = declared(&part.table).into_iter().map(str::to_owned).collect();
        for name in shared.iter().filter(|name| !all.contains(*name)) {
            let close = self.r.guess(name, all.iter().map(String::as_str));
            let message = format!("`{}` has nothing named `{}`", shown(&asked), shown(name));
            self.r.report("HP0204", at.clone(), message).help = close.map(|c| format!("did you mean `{c}`?"));
        }
        let own: HashSet<String> = all.into_iter().filter(|name| !shared.contains(name)).collect();
        if !prefix.is_empty() {
            let in_expressions = renamed(self.format, &mut part, &prefix, &own);
            if in_expressions && !prefix.chars().all(|c| c.is_alphanumeric() || c == '_') {
                let message = format!(
                    "the prefix `{}` makes names that expressions cannot contain, as those of `{}` do",
                    shown(&prefix),
                    shown(&asked)
                );
                self.r.report("HP0117", at, message).help =
                    Some("write it with letters, digits and `_`, like `left_`".into());
                return None;
            }
            self.origins.renamed(&prefix, &own);
        }
        for name in declared(&part.table) {
            self.origins.included.insert(name.to_owned(), self.files.tables[k].0.clone());
        }
        for (name, value) in parameters.into_iter().flatten() {
            self.set_parameter(&mut part.table, (name, value), &prefix, &asked);
        }
        Some(part)
    }

    /// Gives a parameter of an included file a new value.
    fn set_parameter(
        &mut self,
        part: &mut DeTable<'a>,
        (name, value): (&Spanned<Cow<'a, str>>, &Value<'a>),
        prefix: &str,
        asked: &str,
    ) {
        let there = part.get_mut("parameters").and_then(table_of);
        let known = there.and_then(|t| t.get_mut(&*format!("{prefix}{}", name.get_ref())));
        match known {
            Some(there) => match there.get_mut() {
                DeValue::Table(table) => {
                    table.insert(Spanned::new(name.span(), Cow::Borrowed("value")), value.clone());
                }
                _ => *there = value.clone(),
            },
            None => {
                let entries = part.get("parameters").and_then(|v| v.get_ref().as_table());
                let names = entries
                    .into_iter()
                    .flat_map(DeTable::keys)
                    .map(|k| k.get_ref().strip_prefix(prefix).unwrap_or(k.get_ref()));
                let names: Vec<&str> = names.collect();
                let close = self.r.guess(name.get_ref(), names.into_iter());
                let message =
                    format!("`{}` has no parameter named `{}`", shown(asked), shown(name.get_ref()));
                self.r.report("HP0204", name.span(), message).help =
                    close.map(|c| format!("did you mean `{c}`?"));
            }
        }
    }

    /// Checks that units and gravity of all files are the same; a file without them has those of its included files.
    fn units_of(&mut self, own: &mut DeTable<'a>, part: &DeTable<'a>, value: &Value<'_>) {
        // Gravity of a part is that of the whole.
        if let (Some((key, gravity)), false) = (part.get_key_value("gravity"), own.contains_key("gravity")) {
            own.insert(key.clone(), gravity.clone());
        }
        let said =
            |table: &DeTable<'_>| -> Option<[String; 2]> {
                let units = table.get("units")?.get_ref().as_table()?;
                Some(["length", "angle"].map(|key| {
                    units.get(key).and_then(|v| v.get_ref().as_str()).unwrap_or_default().to_owned()
                }))
            };
        match (said(own), said(part)) {
            (Some(here), Some(there)) if here != there => {
                let message = format!(
                    "the included file is in {}, this one in {}",
                    there.join(" and "),
                    here.join(" and ")
                );
                self.r.report("HP0117", value.span(), message).help =
                    Some("write both in the same units".into());
            }
            (None, Some(_)) => {
                if let Some((key, units)) = part.get_key_value("units") {
                    own.insert(key.clone(), units.clone());
                }
            }
            _ => {}
        }
    }
}

/// Names that the tables of a model declare.
fn declared<'t>(table: &'t DeTable<'_>) -> Vec<&'t str> {
    let sections = SECTIONS.iter().filter_map(|s| table.get(*s)?.get_ref().as_table());
    sections.flat_map(DeTable::keys).map(|key| &**key.get_ref()).collect()
}

/// Makes file names relative to the folder of the first file.
fn files_from_there(format: &'static Table, table: &mut DeTable<'_>, from: &str) {
    for (section, value) in table.iter_mut() {
        walk("", format.shape_of(section.get_ref()), value, &mut |_, leaf| {
            if let Leaf::File(name) = leaf
                && &**section.get_ref() != "include"
            {
                *name = Cow::Owned(beside(from, name));
            }
        });
    }
}

/// Adds a prefix to all occurrences of these names. Returns true if there are some in expressions.
fn renamed(format: &'static Table, part: &mut Both<'_>, prefix: &str, own: &HashSet<String>) -> bool {
    let say = |name: &str| {
        let base = name.split('.').next().unwrap_or(name);
        own.contains(base).then(|| format!("{prefix}{name}"))
    };
    let mut in_expressions = false;
    let mut rename = |shape: Shape, value: &mut Value<'_>| {
        walk("", shape, value, &mut |_, leaf| match leaf {
            // Cases belong to the whole model, even if another entry of the file has such a name.
            Leaf::Name("a column" | "a parameter of the law" | "a case" | "a coordinate", _) => {}
            Leaf::Name(_, name) => *name = say(name).map_or(Cow::Owned(name.to_string()), Cow::Owned),
            Leaf::Expression(text) => {
                let before = text.len();
                in_expression(text, say);
                in_expressions |= text.len() != before;
            }
            _ => {}
        });
    };
    for section in SECTIONS {
        if let Some(value) = part.table.get_mut(section) {
            rename(format.shape_of(section), value);
        }
    }
    let variable = format.entries_of("design");
    let twins = std::mem::take(&mut part.twins).into_iter();
    part.twins = twins
        .map(|(name, mut value)| {
            rename(variable, &mut value);
            (say(&name).unwrap_or(name), value)
        })
        .collect();
    in_expressions
}

/// Adds the declarations of a file to those of others; existing ones take precedence.
fn merge<'a>(format: &'static Table, all: &mut DeTable<'a>, part: DeTable<'a>) {
    for (section, value) in part {
        if !SECTIONS.contains(&&**section.get_ref()) {
            continue;
        }
        match all.get_mut(&**section.get_ref()) {
            None => {
                all.insert(section, value);
            }
            Some(there) => {
                let shape = format.entries_of(section.get_ref());
                if let (Some(there), DeValue::Table(more)) = (table_of(there), value.into_inner()) {
                    for (name, value) in more {
                        lay_under(shape, there, name, value);
                    }
                }
            }
        }
    }
}

/// Puts included entries before those of the file itself.
fn under<'a>(format: &'static Table, own: &mut DeTable<'a>, included: DeTable<'a>) {
    for (section, value) in included {
        let DeValue::Table(mut entries) = value.get_ref().clone() else { continue };
        let Some(written) = own.get_mut(&**section.get_ref()) else {
            own.insert(section, value);
            continue;
        };
        let shape = format.entries_of(section.get_ref());
        let Some(table) = table_of(written) else { continue };
        for (name, hand) in std::mem::take(table) {
            // At the position of the included entry, with the contents written here.
            match entries.get_mut(&**name.get_ref()) {
                Some(there) => {
                    let mut one = DeTable::new();
                    let made = std::mem::replace(there, hand.clone());
                    one.insert(name.clone(), hand);
                    lay_under(shape, &mut one, name.clone(), made);
                    if let Some(both) = one.get(&**name.get_ref()) {
                        *there = both.clone();
                    }
                }
                None => {
                    entries.insert(name, hand);
                }
            }
        }
        *table = entries;
    }
}

/// Texts of included files, stored with the model.
pub(crate) fn texts_of(parts: &[Part]) -> Texts {
    parts.iter().map(|part| (part.name.clone(), part.text.clone())).collect()
}

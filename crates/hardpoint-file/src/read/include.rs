//! Files in files: a corner in an axle, an axle in a vehicle.
//!
//! All files of a model are one [`Source`], whose values are put together before they are read; each keeps its place
//! there.

use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::ops::Range;
use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::LARGEST_FILE;
use crate::diagnostic::shown;
use crate::format::{NUMBER, Shape, Table, table};
use crate::tree::{Folder, Reader, Texts, Value};
use crate::walk::{Leaf, in_expression, table_of, walk};

use super::MODEL;
use super::data::{DataError, Wanted, bytes_of, text_from};
use super::mirror::{Both, Opposites, SECTIONS};

pub(crate) const INCLUDE: Shape =
    Shape::list(&Shape::Any("Include", "", &[Shape::File, Shape::Table(&INCLUDE_TABLE)]));
pub(super) const INCLUDE_TABLE: Table = table! {
    /// Another file, with its names and parameters as they are wanted here.
    "IncludeTable":
    /// A model file in this one's folder or below it.
    must "file": Shape::File, "\"corner.toml\"";
    /// Prefix of all names that the file declares.
    or("\"\"") "prefix": Shape::Text, "\"left_\"";
    /// Names that get no prefix: what this file has as well, or several files share.
    may "shared": Shape::list(&Shape::Name("a thing")), "[\"rack\"]";
    /// Values of its parameters in place of those that it has.
    may "parameters": Shape::Entries("a parameter", &NUMBER), "{ track = 1500 }";
};
/// More files than this are surely a slip.
const MOST_FILES: usize = 100;
/// Each inclusion counts as that many bytes at least of what all files of a model may have together, so that files that
/// include others over and over end somewhere.
const LEAST_BYTES: u64 = 64 << 10;
const WANTED: Wanted<'static> = Wanted {
    purpose: "model",
    kind: "a model file",
    ending: "toml",
    example: "corners/front.toml",
    without_folder: "put its tables into this file, or read the model from a file",
    too_large: "leave out of it what is not needed",
};

/// A file of a model, beside the one that was requested.
pub(crate) struct Part {
    /// As the first file would name it.
    pub name: String,
    pub text: String,
}

/// Error of an included file, and its place: the file (0 is the first), and the range there.
pub(crate) struct IncludeError {
    pub file: usize,
    pub at: Range<usize>,
    pub error: DataError,
}

/// All files that a text includes, and those include, each once.
pub(crate) fn parts(folder: Folder<'_>, text: &str) -> (Vec<Part>, Vec<IncludeError>) {
    let (mut parts, mut hindrances): (Vec<Part>, Vec<IncludeError>) = Default::default();
    let (mut file, mut bytes) = (0, text.len() as u64);
    while file <= parts.len() {
        let (name, text) = match file.checked_sub(1) {
            None => ("", text),
            Some(k) => (parts[k].name.as_str(), parts[k].text.as_str()),
        };
        let mut found = Vec::new();
        // What is no TOML is reported when it is read.
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

/// The files that a table includes, and where it says so.
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

/// A table whose places count from elsewhere.
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

/// The files of a model, as they are written.
pub(crate) struct Files<'a> {
    /// Their tables, each with the name that it has; the first has none.
    pub tables: Vec<(String, DeTable<'a>)>,
    pub numbers: &'a Opposites,
    /// Number of bytes each has.
    pub sizes: Vec<u64>,
}

impl Reader<'_> {
    /// All of a model in one table: what the file includes, what it says itself, and what its mirror makes of both.
    /// Where that cannot be made, it is reported.
    pub fn whole<'a>(&mut self, mut files: Files<'a>) -> Both<'a> {
        let first = &mut files.tables[0].1;
        if !["include", "mirror", "planar"].iter().any(|key| first.contains_key(*key)) {
            return Both { table: std::mem::take(first), twins: HashMap::new() };
        }
        self.put_together(&files, 0, &mut vec![0])
    }

    fn put_together<'a>(&mut self, files: &Files<'a>, k: usize, above: &mut Vec<usize>) -> Both<'a> {
        let (name, written) = &files.tables[k];
        let mut own = written.clone();
        if name.contains('/') {
            files_from_there(&mut own, name);
        }
        let mut both = Both { table: DeTable::new(), twins: HashMap::new() };
        for value in self.includes(written) {
            if let Some(part) = self.included(files, value, name, above) {
                self.units_of(&mut own, &part.table, value);
                merge(&mut both.table, part.table);
                both.twins.extend(part.twins);
            }
        }
        // What is in this file counts more; it comes behind what it includes.
        let included = std::mem::take(&mut both.table);
        both.table = own;
        under(&mut both.table, included);
        self.planar(&mut both.table);
        if self.found.is_empty()
            && let Some(mirrored) = self.both_sides(&both.table, files.numbers)
        {
            both.table = mirrored.table;
            both.twins.extend(mirrored.twins);
        }
        both
    }

    /// The entries of `include`.
    fn includes<'t, 'a>(&mut self, table: &'t DeTable<'a>) -> Vec<&'t Value<'a>> {
        let Some(value) = table.get("include") else { return Vec::new() };
        match value.get_ref().as_array() {
            Some(list) => list.iter().collect(),
            None => {
                self.report("HP0105", value.span(), "`include` must be a list of files").help =
                    Some("for example `include = [\"corner.toml\"]`".into());
                Vec::new()
            }
        }
    }

    /// One included file, with the names and parameters that are wanted.
    fn included<'a>(
        &mut self,
        files: &Files<'a>,
        value: &Value<'a>,
        from: &str,
        above: &mut Vec<usize>,
    ) -> Option<Both<'a>> {
        let at = value.span();
        let (mut prefix, mut shared, mut parameters) = (String::new(), BTreeSet::new(), None);
        let asked = match value.get_ref() {
            DeValue::String(name) => name.to_string(),
            DeValue::Table(table) => {
                let fields = self.fields("an entry of `include`", at.clone(), table, INCLUDE_TABLE.keys());
                let file = self.name_of(&fields, "file")?;
                prefix = self.name_of(&fields, "prefix")?;
                if let Some(f) = fields.get("shared") {
                    let subject = fields.subject("shared");
                    for v in self.list(f.value, &subject, "a list of names").into_iter().flatten() {
                        shared.extend(self.name(v, &subject, "a name in quotes"));
                    }
                }
                if let Some(f) = fields.get("parameters") {
                    let subject = fields.subject("parameters");
                    self.table(f.value, &subject, "a table of parameters' names and values")?;
                }
                parameters = table.get("parameters").and_then(|v| v.get_ref().as_table());
                file
            }
            _ => {
                self.report("HP0105", at, "an entry of `include` must be a file's name or a table").help =
                    Some("for example `{ file = \"corner.toml\", prefix = \"left_\" }`".into());
                return None;
            }
        };
        let name = beside(from, &asked);
        // A file that could not be read has been reported of.
        let k = files.tables.iter().skip(1).position(|file| file.0 == name)? + 1;
        if above.contains(&k) {
            let message = format!("the file `{}` includes itself", shown(&name));
            let way: Vec<String> =
                above.iter().skip(1).chain([&k]).map(|k| format!("`{}`", files.tables[*k].0)).collect();
            self.report("HP0117", at, message).notes.push(format!("by way of {}", way.join(", ")));
            return None;
        }
        self.included += files.sizes[k].max(LEAST_BYTES);
        if self.included > LARGEST_FILE {
            let message = "includes are nested too deeply".to_owned();
            self.report("HP0117", at, message).help =
                Some("include each of them where it is needed only".into());
            return None;
        }
        above.push(k);
        let mut part = self.put_together(files, k, above);
        above.pop();
        let all: BTreeSet<String> = declared(&part.table).into_iter().map(str::to_owned).collect();
        for name in shared.iter().filter(|name| !all.contains(*name)) {
            let close = self.guess(name, all.iter().map(String::as_str));
            let message = format!("`{}` has nothing named `{}`", shown(&asked), shown(name));
            self.report("HP0204", at.clone(), message).help = close.map(|c| format!("did you mean `{c}`?"));
        }
        let own: HashSet<String> = all.into_iter().filter(|name| !shared.contains(name)).collect();
        if !prefix.is_empty() {
            renamed(&mut part, &prefix, &own);
            self.origins.renamed(&prefix, &own);
        }
        for name in declared(&part.table) {
            self.origins.included.insert(name.to_owned(), name_of(files, k));
        }
        for (name, value) in parameters.into_iter().flatten() {
            let there = part.table.get_mut("parameters").and_then(table_of);
            let known = there.and_then(|t| t.get_mut(&*format!("{prefix}{}", name.get_ref())));
            match known {
                Some(there) => match there.get_mut() {
                    DeValue::Table(table) => {
                        table.insert(Spanned::new(name.span(), Cow::Borrowed("value")), value.clone());
                    }
                    _ => *there = value.clone(),
                },
                None => {
                    let entries = part.table.get("parameters").and_then(|v| v.get_ref().as_table());
                    let names = entries
                        .into_iter()
                        .flat_map(DeTable::keys)
                        .map(|k| k.get_ref().strip_prefix(&*prefix).unwrap_or(k.get_ref()));
                    let names: Vec<&str> = names.collect();
                    let close = self.guess(name.get_ref(), names.into_iter());
                    let message =
                        format!("`{}` has no parameter named `{}`", shown(&asked), shown(name.get_ref()));
                    self.report("HP0204", name.span(), message).help =
                        close.map(|c| format!("did you mean `{c}`?"));
                }
            }
        }
        Some(part)
    }

    /// The units of all files are the same, and so is gravity; a file that says none has those of what it includes.
    fn units_of<'a>(&mut self, own: &mut DeTable<'a>, part: &DeTable<'a>, value: &Value<'_>) {
        // What falls in a part falls in the whole.
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
                self.report("HP0117", value.span(), message).help =
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

fn name_of(files: &Files<'_>, k: usize) -> String {
    files.tables[k].0.clone()
}

/// The names that a model's tables declare.
fn declared<'t>(table: &'t DeTable<'_>) -> Vec<&'t str> {
    let sections = SECTIONS.iter().filter_map(|s| table.get(*s)?.get_ref().as_table());
    sections.flat_map(DeTable::keys).map(|key| &**key.get_ref()).collect()
}

/// The shape of a section's entries.
fn entries_of(section: &str) -> Shape {
    MODEL.keys().find(|k| k.key == section).map_or(Shape::Text, |k| k.shape)
}

/// Files that are named in another folder, as they are named from the first file's.
fn files_from_there(table: &mut DeTable<'_>, from: &str) {
    for (section, value) in table.iter_mut() {
        walk("", entries_of(section.get_ref()), value, &mut |_, leaf| {
            if let Leaf::File(name) = leaf
                && &**section.get_ref() != "include"
            {
                *name = Cow::Owned(beside(from, name));
            }
        });
    }
}

/// Puts a prefix before these names wherever they stand.
fn renamed(part: &mut Both<'_>, prefix: &str, own: &HashSet<String>) {
    let say = |name: &str| {
        let base = name.split('.').next().unwrap_or(name);
        own.contains(base).then(|| format!("{prefix}{name}"))
    };
    let rename = |shape: Shape, value: &mut Value<'_>| {
        walk("", shape, value, &mut |_, leaf| match leaf {
            // Cases are those of the whole, whatever else of the file has such a name.
            Leaf::Name("a column" | "a parameter of the law" | "a case", _) => {}
            Leaf::Name(_, name) => *name = say(name).map_or(Cow::Owned(name.to_string()), Cow::Owned),
            Leaf::Expression(text) => in_expression(text, say),
            _ => {}
        });
    };
    for section in SECTIONS {
        if let Some(value) = part.table.get_mut(section) {
            rename(entries_of(section), value);
        }
    }
    let variable = Shape::Kinds(&super::design::VARIABLE);
    let twins = std::mem::take(&mut part.twins).into_iter();
    part.twins = twins
        .map(|(name, mut value)| {
            rename(variable, &mut value);
            (say(&name).unwrap_or(name), value)
        })
        .collect();
}

/// Adds what a file declares to what others do; what is there counts more.
fn merge<'a>(all: &mut DeTable<'a>, part: DeTable<'a>) {
    for (section, value) in part {
        if !SECTIONS.contains(&&**section.get_ref()) {
            continue;
        }
        match all.get_mut(&**section.get_ref()) {
            None => {
                all.insert(section, value);
            }
            Some(there) => {
                let shape = entries_of(section.get_ref());
                if let (Some(there), DeValue::Table(more)) = (table_of(there), value.into_inner()) {
                    for (name, value) in more {
                        lay_under(shape, there, name, value);
                    }
                }
            }
        }
    }
}

/// Puts what is included before what a file says itself.
fn under<'a>(own: &mut DeTable<'a>, included: DeTable<'a>) {
    for (section, value) in included {
        let DeValue::Table(mut entries) = value.get_ref().clone() else { continue };
        let Some(written) = own.get_mut(&**section.get_ref()) else {
            own.insert(section, value);
            continue;
        };
        let shape = entries_of(section.get_ref());
        let Some(table) = table_of(written) else { continue };
        for (name, hand) in std::mem::take(table) {
            // In the place of what is included, but as it is written here.
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

/// Adds an entry under what is written by hand, which counts more key by key.
pub(super) fn lay_under<'a>(
    shape: Shape,
    entries: &mut DeTable<'a>,
    name: Spanned<Cow<'a, str>>,
    made: Value<'a>,
) -> bool {
    let of = if let Shape::Entries(_, of) = shape { *of } else { shape };
    let Some(hand) = entries.get_mut(&**name.get_ref()) else {
        entries.insert(name, made);
        return true;
    };
    if table_of(hand).is_none_or(|hand| stands_alone(of, hand)) {
        return false;
    }
    if matches!(of, Shape::Kinds(_) | Shape::Table(_)) && !made.get_ref().is_table() {
        // A value that must be a table and is none has nothing to merge: the error is reported elsewhere.
        *hand = made;
        return true;
    }
    table_of(hand).is_some_and(|hand| fill(hand, made))
}

/// Adds the keys that are not there.
pub(super) fn fill<'a>(hand: &mut DeTable<'a>, made: Value<'a>) -> bool {
    let DeValue::Table(made) = made.into_inner() else { return false };
    for (key, value) in made {
        if !hand.contains_key(&**key.get_ref()) {
            hand.insert(key, value);
        }
    }
    true
}

/// True if what is written by hand says all of an entry: its `type`, or what leads one of its kinds.
fn stands_alone(shape: Shape, hand: &DeTable<'_>) -> bool {
    let leads = match shape {
        Shape::Kinds(kinds) if !kinds.typed => (kinds.tables)().iter().map(|t| t.keys[0].key).collect(),
        _ => vec!["type"],
    };
    leads.iter().any(|key| hand.contains_key(*key))
}

/// The texts of included files, which stay with the model.
pub(crate) fn texts(parts: &[Part]) -> Texts {
    parts.iter().map(|part| (part.name.clone(), part.text.clone())).collect()
}

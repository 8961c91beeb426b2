//! Tables: their keys with the declared forms and defaults, their entries, and the kinds of a table.

use std::collections::BTreeSet;
use std::ops::Range;

use hardpoint::draft::{DirectionDraft, LocationDraft};
use hardpoint::space::Vec3;
use toml::Spanned;
use toml::de::DeTable;

use super::diagnostic::{closest, shown};
use super::fields::{Field, Fields, MOST_ENTRIES, Subject, Value};
use super::format::{Key, Need, Shape, THROUGH, Table};
use super::places::EntryPlace;
use super::reader::{Reader, all_read, quoted};

/// Only key that has a name as its last word, such as `max_iterations` for `iterations`.
fn longer<'a>(name: &str, keys: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let mut found = keys.filter(|key| key.strip_suffix(name).is_some_and(|first| first.ends_with('_')));
    found.next().filter(|_| found.next().is_none())
}

/// Maximum number of names in a list.
const MOST_NAMES: usize = 10_000;

impl Reader<'_> {
    /// Fields of a table; unknown keys are reported. A misspelt key is read as the intended one, so that it is reported
    /// once and not again as missing. If the intended one is given too, only entries are read of both.
    pub fn fields<'a>(
        &mut self,
        what: impl Into<String>,
        at: Range<usize>,
        table: &'a DeTable<'a>,
        keys: impl IntoIterator<Item = &'static Key>,
    ) -> Fields<'a> {
        let keys: Vec<&'static Key> = keys.into_iter().collect();
        let mut fields = Fields { what: what.into(), at, keys: keys.clone(), list: Vec::new(), lost: false };
        let names = || keys.iter().map(|k| k.key);
        let known = |key: &str| names().find(|k| *k == key);
        for (key, value) in table.iter().take(MOST_ENTRIES) {
            let at = (key.span().start, key.span().end);
            if let Some(key) = known(key.get_ref()) {
                fields.list.push(Field { key, at, value });
            }
        }
        for (key, value) in table.iter().take(MOST_ENTRIES) {
            let name = key.get_ref();
            if known(name).is_some() {
                continue;
            }
            // Of equally close keys a missing one is meant.
            let (given, missing): (Vec<_>, Vec<_>) = names().partition(|k| fields.get(k).is_some());
            let close = closest(name, missing.into_iter().chain(given.iter().copied()));
            let close = close.or_else(|| longer(name, names()));
            let what = &fields.what;
            let message = match close {
                Some(close) => format!("unknown key `{}` in {what}; did you mean `{close}`?", shown(name)),
                None => format!("unknown key `{}` in {what}", shown(name)),
            };
            let list: Vec<_> = names().collect();
            let d = self.report("HP0103", key.span(), message);
            d.notes.push(format!("valid keys: {}", quoted(&list)));
            let given = close.filter(|close| given.contains(close));
            let has_entries = value.get_ref().is_table()
                && close.is_some_and(|close| matches!(fields.key(close).shape, Shape::Entries(..)));
            if let Some(given) = given {
                d.help = Some(match has_entries {
                    true => format!("move its entries to `{given}`"),
                    false => format!("`{given}` is given already: remove `{}`", shown(name)),
                });
            } else if close.is_none() {
                let remove = || format!("remove `{}`", shown(name));
                d.help = Some(above_tables(name).unwrap_or_else(remove));
            }
            let at = (key.span().start, key.span().end);
            if let Some(key) = names().find(|k| Some(*k) == close).filter(|_| given.is_none() || has_entries)
            {
                fields.list.push(Field { key, at, value });
            }
        }
        if table.len() > MOST_ENTRIES {
            let what = fields.what.clone();
            self.too_many(fields.at.clone(), &what, table.len());
        }
        fields
    }

    /// Reports a missing key (HP0104).
    pub fn need<'a>(&mut self, fields: &Fields<'a>, key: &str) -> Option<Field<'a>> {
        let field = fields.get(key);
        if field.is_none() && !fields.lost {
            let example = fields.example(key);
            self.report("HP0104", fields.at.clone(), format!("{} has no `{key}`", fields.what)).help =
                Some(format!("add it, for example {example}"));
        }
        field
    }

    /// Reports a key that contradicts the others (HP0107).
    pub fn out_of_place(&mut self, fields: &Fields<'_>, key: &str, why: impl Into<String>) {
        if let Some(field) = fields.get(key) {
            let message = format!("`{key}` has no meaning in {}", fields.what);
            self.report("HP0107", field.at.0..field.at.1, message).notes.push(why.into());
        }
    }

    pub fn table<'a>(
        &mut self,
        value: &'a Value<'a>,
        subject: &Subject,
        expected: &str,
    ) -> Option<&'a DeTable<'a>> {
        let table = value.get_ref().as_table();
        if table.is_none() {
            self.wrong(value, subject, expected);
        }
        table
    }

    /// A table of names, with a limited number of entries.
    pub fn table_of_names<'a>(
        &mut self,
        value: &'a Value<'a>,
        subject: &Subject,
        expected: &str,
    ) -> Option<&'a DeTable<'a>> {
        let table = self.table(value, subject, expected)?;
        if table.len() > MOST_ENTRIES {
            self.too_many(value.span(), &subject.name, table.len());
            return None;
        }
        Some(table)
    }

    pub fn list<'a>(
        &mut self,
        value: &'a Value<'a>,
        subject: &Subject,
        expected: &str,
    ) -> Option<Vec<&'a Value<'a>>> {
        let Some(list) = value.get_ref().as_array() else {
            self.wrong(value, subject, expected);
            return None;
        };
        if list.len() > MOST_ENTRIES {
            self.too_many(value.span(), &subject.name, list.len());
            return None;
        }
        Some(list.iter().collect())
    }

    /// Value of a key, if there is one. A missing or invalid value is recorded as unread.
    pub fn given<'a, T>(
        &mut self,
        fields: &Fields<'a>,
        key: &str,
        read: impl FnOnce(&mut Self, Field<'a>) -> Option<T>,
    ) -> Option<T> {
        let declared = fields.key(key);
        let value = match fields.get(key) {
            None if declared.need != Need::Required => return None,
            None => self.need(fields, key).and(None),
            Some(f) => read(self, f),
        };
        if value.is_none() {
            self.unread.push(declared.key);
        }
        value
    }

    /// Value of a key, or its declared default.
    fn declared<'a, T>(
        &mut self,
        fields: &Fields<'a>,
        key: &str,
        read: impl FnOnce(&mut Self, Field<'a>, Shape) -> Option<T>,
        default: impl FnOnce(&'static str) -> Option<T>,
    ) -> Option<T> {
        let Key { shape, need, .. } = *fields.key(key);
        match need {
            Need::Else(text) if fields.get(key).is_none() => default(text),
            _ => self.given(fields, key, |r, f| read(r, f, shape)),
        }
    }

    /// A number, converted to SI if it is declared as a length or an angle.
    pub fn number_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<f64> {
        self.declared(
            fields,
            key,
            |r, f, shape| r.quantity(f.value, &fields.subject(f.key), shape),
            |text| text.parse().ok(),
        )
    }

    pub fn numbers_of<const N: usize>(&mut self, fields: &Fields<'_>, keys: [&str; N]) -> Option<[f64; N]> {
        let found = keys.map(|key| self.number_of(fields, key));
        found.iter().all(Option::is_some).then(|| found.map(Option::unwrap_or_default))
    }

    /// `true` or `false`.
    pub fn flag_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<bool> {
        self.declared(
            fields,
            key,
            |r, f, _| r.boolean(f.value, &fields.subject(f.key)),
            |text| Some(text == "true"),
        )
    }

    /// A name.
    pub fn name_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<String> {
        self.declared(
            fields,
            key,
            |r, f, shape| r.name(f.value, &fields.subject(f.key), &shape.noun()),
            |text| serde_json::from_str(text).ok(),
        )
    }

    /// An optional name. `None` if it is invalid.
    pub fn name_if(&mut self, fields: &Fields<'_>, key: &str) -> Option<Option<String>> {
        let name = self.name_of(fields, key);
        (name.is_some() || fields.get(key).is_none()).then_some(name)
    }

    /// Names in a list of fixed length.
    pub fn names_of<const N: usize>(&mut self, fields: &Fields<'_>, key: &str) -> Option<[String; N]> {
        let (subject, expected) = (fields.subject(key), fields.key(key).shape.noun());
        self.given(fields, key, |r, f| match f.value.get_ref().as_array() {
            Some(list) if list.len() == N => {
                all_read(list.iter().map(|v| r.name(v, &subject, &expected)))?.try_into().ok()
            }
            _ => {
                r.wrong(f.value, &subject, &expected);
                None
            }
        })
    }

    /// A fixed number of numbers, converted to SI if they are declared as lengths or angles.
    pub fn list_of<const N: usize>(
        &mut self,
        fields: &Fields<'_>,
        key: &str,
        expected: &str,
    ) -> Option<[f64; N]> {
        let Shape::List(of, _) = fields.key(key).shape else { return None };
        self.given(fields, key, |r, f| r.quantities(f.value, &fields.subject(key), expected, *of))
    }

    /// Index of one of the possible words.
    pub fn word_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<usize> {
        let words = fields.key(key).shape.words();
        let place = |word: &str| words.iter().position(|w| *w == word);
        self.declared(
            fields,
            key,
            |r, f, shape| {
                let subject = fields.subject(f.key);
                let word = r.name(f.value, &subject, &shape.noun())?;
                let found = place(&word);
                if found.is_none() {
                    r.unknown_word(f.value.span(), &subject, &word, &words);
                }
                found
            },
            |text| place(text.trim_matches('"')),
        )
    }

    /// Direction under a key.
    pub fn vector_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<Vec3> {
        self.given(fields, key, |r, f| r.vector(f.value, &fields.subject(f.key)))
    }

    /// A direction, or `{ through = [...] }`, with the locations of the two hardpoints' names.
    pub fn line(
        &mut self,
        value: &Value<'_>,
        subject: &Subject,
    ) -> Option<(DirectionDraft, Vec<Range<usize>>)> {
        let Some(table) = value.get_ref().as_table() else {
            return self.vector(value, subject).map(|v| (DirectionDraft::Along(v), Vec::new()));
        };
        let fields = self.fields(subject.name.clone(), value.span(), table, THROUGH.keys());
        let [a, b] = self.names_of::<2>(&fields, "through")?;
        let items = fields.get("through").and_then(|f| f.value.get_ref().as_array());
        Some((DirectionDraft::Through(a, b), items.into_iter().flatten().map(Spanned::span).collect()))
    }

    /// Named entries of one of the model's tables.
    pub fn entries<'a>(
        &mut self,
        model: &Fields<'a>,
        key: &'static str,
        one: &str,
    ) -> Vec<(String, Range<usize>, &'a Value<'a>)> {
        self.entries_below(model, "", key, one)
    }

    /// Named entries of a table `below` another, like `optimize.`.
    pub fn entries_below<'a>(
        &mut self,
        table: &Fields<'a>,
        below: &str,
        key: &'static str,
        one: &str,
    ) -> Vec<(String, Range<usize>, &'a Value<'a>)> {
        let expected = format!("a table with one entry for each {one}");
        let mut subject = table.subject(key);
        subject.example = format!("write `[{below}{key}.NAME]` above the keys of a {one}");
        let mut entries: Vec<(String, Range<usize>, &'a Value<'a>)> = Vec::new();
        // A misspelt table may be beside the one that is meant; names that both have are of the latter.
        let mut names = BTreeSet::new();
        for f in table.iter().filter(|f| f.key == key) {
            let Some(table) = self.table(f.value, &subject, &expected) else { continue };
            if table.len() > MOST_ENTRIES {
                self.too_many(f.value.span(), &format!("`{key}`"), table.len());
                continue;
            }
            for (name, value) in table.iter().filter(|(name, _)| names.insert(name.get_ref())) {
                let what = format!("the name of a {one}");
                if let Some(short) = self.short(name.get_ref(), name.span(), &what) {
                    entries.push((short, name.span(), value));
                }
            }
        }
        entries
    }

    /// Fields of the settings of a study, a table of the model; `below` is the first table in it.
    pub fn study<'a>(
        &mut self,
        model: &Fields<'a>,
        key: &'static str,
        below: &str,
        of: &'static Table,
    ) -> Option<Fields<'a>> {
        let f = model.get(key)?;
        self.unread.clear();
        let mut subject = model.subject(key);
        subject.example = format!("write `[{key}]`, in single brackets, and `[{key}.{below}]` below it");
        let table = self.table(f.value, &subject, "one table")?;
        Some(self.fields(format!("`{key}`"), f.at.0..f.at.1, table, of.keys()))
    }

    /// Records keys of tables as unread whose values are no tables, or have too many entries.
    pub fn lost_tables(&mut self, fields: &Fields<'_>) {
        let is_table = |s: Shape| matches!(s, Shape::Table(_) | Shape::Kinds(_) | Shape::Entries(..));
        for f in fields.iter().filter(|f| is_table(fields.key(f.key).shape)) {
            if f.value.get_ref().as_table().is_none_or(|t| t.len() > MOST_ENTRIES) {
                self.unread.push(f.key);
            }
        }
    }

    /// Fields of a named entry, which must be a table.
    pub fn entry<'a>(
        &mut self,
        one: &str,
        (name, at, value): &(String, Range<usize>, &'a Value<'a>),
        keys: impl IntoIterator<Item = &'static Key>,
    ) -> Fields<'a> {
        self.unread.clear();
        let what = format!("{one} `{}`", shown(name));
        let mut keys = keys.into_iter().peekable();
        if let Some(table) = value.get_ref().as_table() {
            return self.fields(what, at.clone(), table, keys);
        }
        let first = keys.peek().map_or(String::new(), |k| format!("{} = {}", k.key, k.example));
        let example = format!("for example `{name} = {{ {first} }}`");
        self.wrong(value, &Subject { name: what.clone(), example }, "a table of keys");
        self.unread.push("");
        let mut fields = self.fields(what, at.clone(), EMPTY.get_or_init(DeTable::new), keys);
        fields.lost = true;
        fields
    }

    /// Kind of a named entry, from its `type`. Without a known type, the entry is not checked further.
    pub fn entry_type<T>(
        &mut self,
        one: &str,
        (name, at, value): &(String, Range<usize>, &Value<'_>),
        kinds: &'static [(Table, T)],
    ) -> Option<&'static (Table, T)> {
        let what = format!("{one} `{}`", shown(name));
        match value.get_ref().as_table() {
            Some(table) => self.kind_of(table, &what, at.clone(), &format!("a {one}"), kinds),
            None => {
                let example = format!("for example `{name} = {{ type = \"{}\" }}`", kinds[0].0.name);
                self.wrong(value, &Subject { name: what, example }, "a table of keys");
                None
            }
        }
    }

    /// Kind of a table by its `type`.
    pub fn kind_of<T>(
        &mut self,
        table: &DeTable<'_>,
        what: &str,
        at: Range<usize>,
        one: &str,
        kinds: &'static [(Table, T)],
    ) -> Option<&'static (Table, T)> {
        let types: Vec<&str> = kinds.iter().map(|k| k.0.name).collect();
        let Some(kind) = table.get("type") else {
            self.report("HP0104", at, format!("{what} has no `type`")).help =
                Some(format!("add it; possible: {}", quoted(&types)));
            return None;
        };
        let subject = Subject {
            name: format!("`type` of {what}"),
            example: format!("for example `type = \"{}\"`", types[0]),
        };
        let word = kind.get_ref().as_str();
        let known = kinds.iter().find(|k| word == Some(k.0.name));
        match (word, known) {
            (Some(word), None) => {
                self.unknown_word(kind.span(), &subject, word, &types);
            }
            (None, _) => self.wrong(kind, &subject, &format!("the name of {one} type")),
            _ => {}
        }
        known
    }

    /// Kind of a table by its keys: the kind that the first key selects, or else one that has some of them. Keys of
    /// other kinds are reported.
    pub fn led_by<T>(
        &mut self,
        fields: &Fields<'_>,
        kinds: &'static [(Table, T)],
        [missing, given]: [&str; 2],
    ) -> Option<&'static (Table, T)> {
        let has = |key: &Key| fields.get(key.key).is_some();
        let led = kinds.iter().find(|k| has(&k.0.keys[0]));
        let Some(kind) = led.or_else(|| kinds.iter().find(|k| k.0.keys.iter().any(has))) else {
            if fields.lost {
                return None;
            }
            let message = format!("{} has no {missing}", fields.what);
            let ways: Vec<String> = kinds.iter().map(|k| way(&k.0)).collect();
            self.report("HP0104", fields.at.clone(), message).help =
                Some(format!("give one of {}", ways.join(", ")));
            return None;
        };
        let by = kind.0.keys.iter().find(|k| has(k)).expect("just found").key;
        for (table, _) in kinds {
            let lead = &table.keys[0];
            for key in table.keys.iter().filter(|k| has(k) && !kind.0.keys.iter().any(|own| own.key == k.key))
            {
                let why = match has(lead) {
                    true => format!("{given} by `{by}` already"),
                    false => format!("`{}` goes with `{}`; {given} by `{by}`", key.key, lead.key),
                };
                self.out_of_place(fields, key.key, why);
                if let Some(d) = self.found.last_mut() {
                    d.help = Some(format!("give {} or {}", way(&kind.0), way(table)));
                }
            }
        }
        Some(kind)
    }

    /// Fields of each inline table in a list.
    pub fn tables<'a>(
        &mut self,
        fields: &Fields<'a>,
        key: &'static str,
        of: &'static Table,
    ) -> Option<Vec<Fields<'a>>> {
        self.given(fields, key, |r, f| {
            let subject = fields.subject(key);
            let list = r.list(f.value, &subject, "a list of tables")?;
            all_read((1..).zip(list).map(|(k, v)| {
                let table = r.table(v, &subject, "a list of tables")?;
                let what = format!("entry {k} of `{key}` in {}", fields.what);
                Some(r.fields(what, v.span(), table, of.keys()))
            }))
        })
    }

    /// Reads a direction; the names in `through` become the items of the key.
    pub fn line_of(
        &mut self,
        fields: &Fields<'_>,
        key: &str,
        place: &mut EntryPlace,
    ) -> Option<DirectionDraft> {
        self.given(fields, key, |r, f| {
            let (line, items) = r.line(f.value, &fields.subject(f.key))?;
            place.items(f.key, items);
            Some(line)
        })
    }

    /// Location under a key.
    pub fn place_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<LocationDraft> {
        self.given(fields, key, |r, f| r.place(f.value, &fields.subject(f.key)))
    }

    /// A whole number from 1.
    pub fn count_of(&mut self, fields: &Fields<'_>, key: &'static str, most: u32) -> Option<usize> {
        let number = self.number_of(fields, key)?;
        if number >= 1.0 && number <= f64::from(most) && number.fract() == 0.0 {
            return Some(number as usize);
        }
        let at = fields.get(key).map_or(fields.at.clone(), |f| f.value.span());
        let message = format!("{} cannot be {number}", fields.subject(key).name);
        self.senseless(at, message).help = Some(format!("give a whole number from 1 to {most}"));
        self.unread.push(key);
        None
    }

    /// Names in a list of any length; `all` describes the default in the help on a list that is too long.
    pub fn list_of_names(&mut self, fields: &Fields<'_>, key: &str, all: &str) -> Option<Vec<String>> {
        let (subject, expected) = (fields.subject(key), fields.key(key).shape.noun());
        self.given(fields, key, |r, f| {
            let list = r.list(f.value, &subject, &expected)?;
            if list.len() > MOST_NAMES {
                r.senseless(f.value.span(), format!("{} has {} entries", subject.name, list.len())).help =
                    Some(format!("name at most {MOST_NAMES}, or leave it out for {all}"));
                return None;
            }
            all_read(list.into_iter().map(|v| r.name(v, &subject, &expected)))
        })
    }
}

/// Example of a table of this kind, for help.
fn way(table: &Table) -> String {
    let needed = table.keys.iter().filter(|k| k.need == Need::Required);
    let needed: Vec<String> = needed.map(|k| format!("`{} = {}`", k.key, k.example)).collect();
    let what = table.doc.split([',', ';', ':', '.']).next().unwrap_or_default();
    format!("{} ({}{})", needed.join(" with "), what[..1].to_lowercase(), &what[1..])
}

static EMPTY: std::sync::OnceLock<DeTable<'static>> = std::sync::OnceLock::new();

/// Suggested fix for a key of the model that is below a `[table]` and so became a part of it.
pub(crate) fn above_tables(name: &str) -> Option<String> {
    ["name", "description", "units"]
        .contains(&name)
        .then(|| format!("`{name}` belongs to the model as a whole: write it above the first `[...]` line"))
}

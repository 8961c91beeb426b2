//! A model's text with other entries: a nested table is merged into it. Comments, order and layout of all else stay.

use std::fmt;

use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use toml_edit::{Array, DocumentMut, InlineTable, Item, Table, TableLike, Value};

use super::text::add;

/// Depth of tables with a header of their own: `[joints.hinge]`. Deeper ones are written inline.
const HEADERS: usize = 2;

/// Contents of an entry of a file, in the order in which they were given.
#[derive(Clone, Debug, PartialEq)]
pub enum Contents {
    /// Nothing: the entry is removed.
    None,
    /// True or false.
    Flag(bool),
    /// Whole number.
    Whole(i64),
    /// Number.
    Number(f64),
    /// Text.
    Text(String),
    /// List.
    List(Vec<Self>),
    /// Table.
    Table(Vec<(String, Self)>),
}

impl<'de> Deserialize<'de> for Contents {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ContentsVisitor)
    }
}

struct ContentsVisitor;

impl<'de> Visitor<'de> for ContentsVisitor {
    type Value = Contents;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, a text, a list or a table")
    }

    fn visit_unit<E>(self) -> Result<Contents, E> {
        Ok(Contents::None)
    }

    fn visit_bool<E>(self, flag: bool) -> Result<Contents, E> {
        Ok(Contents::Flag(flag))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Contents, E> {
        Ok(Contents::Whole(number))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Contents, E> {
        Ok(i64::try_from(number).map_or(Contents::Number(number as f64), Contents::Whole))
    }

    fn visit_f64<E>(self, number: f64) -> Result<Contents, E> {
        Ok(Contents::Number(number))
    }

    fn visit_str<E>(self, text: &str) -> Result<Contents, E> {
        Ok(Contents::Text(text.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Contents, A::Error> {
        let mut found = Vec::new();
        while let Some(one) = list.next_element()? {
            found.push(one);
        }
        Ok(Contents::List(found))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut table: A) -> Result<Contents, A::Error> {
        let mut found = Vec::new();
        while let Some(entry) = table.next_entry()? {
            found.push(entry);
        }
        Ok(Contents::Table(found))
    }
}

/// Text of a model with the entries of a nested table merged into it: tables are merged, [`Contents::None`] removes an
/// entry, all
/// else replaces it. Comments, order and layout of the entries that stay are preserved.
///
/// ```
/// let text = "name = \"x\"\n\n[hardpoints]\nA = [0, 0, 0] # as measured\nB = [1, 0, 0]\n";
/// let changes = r#"{ "hardpoints": { "A": [0, 0, 5], "B": null }, "bodies": { "arm": {} } }"#;
/// let changes = serde_json::from_str(changes).unwrap();
/// let merged = hardpoint_file::merged(text, &changes).unwrap();
/// assert_eq!(merged, "name = \"x\"\n\n[hardpoints]\nA = [0, 0, 5] # as measured\n\n[bodies.arm]\n");
/// ```
///
/// # Errors
/// The reason why the text is not TOML, or the entry that TOML cannot express.
pub fn merged(text: &str, changes: &Contents) -> Result<String, String> {
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| error.to_string())?;
    let Contents::Table(changes) = changes else { return Err("the changes of a model are a table".into()) };
    merge(document.as_table_mut(), changes, HEADERS, &mut Vec::new())?;
    let mut written = document.to_string();
    if text.contains("\r\n") {
        written = written.replace("\r\n", "\n").replace('\n', "\r\n");
    }
    Ok(if text.is_empty() { written.trim_start().to_owned() } else { written })
}

/// Merges changes into a table that may have `headers` more levels of tables with headers.
fn merge<'c>(
    table: &mut dyn TableLike,
    changes: &'c [(String, Contents)],
    headers: usize,
    path: &mut Vec<&'c str>,
) -> Result<(), String> {
    for (name, change) in changes {
        path.push(name);
        let old = table.get_mut(name).filter(|item| !item.is_none());
        match (change, old) {
            (Contents::None, _) => drop(table.remove(name)),
            (Contents::Table(changes), Some(old)) if old.is_table_like() => {
                // Below a dotted key, and within a table of one line, there are no headers.
                let is_open = matches!(old, Item::Table(table) if !table.is_dotted());
                let inner = old.as_table_like_mut().expect("it is a table");
                merge(inner, changes, if is_open { headers.saturating_sub(1) } else { 0 }, path)?;
            }
            (Contents::Table(fields), old) if headers > 0 => {
                let new = table_of(fields, headers - 1, path)?;
                match old {
                    Some(old) => *old = Item::Table(new),
                    None => drop(table.insert(name, Item::Table(new))),
                }
            }
            (_, Some(Item::Value(old))) => {
                let decor = old.decor().clone();
                *old = value_of(change, path)?;
                *old.decor_mut() = decor;
            }
            (_, Some(old)) => *old = Item::Value(value_of(change, path)?),
            (_, None) => add(table, name, value_of(change, path)?),
        }
        path.pop();
    }
    Ok(())
}

/// New table with a header.
fn table_of<'c>(
    fields: &'c [(String, Contents)],
    headers: usize,
    path: &mut Vec<&'c str>,
) -> Result<Table, String> {
    let mut table = Table::new();
    merge(&mut table, fields, headers, path)?;
    // `[joints]` alone is left out if all its entries have headers.
    table.set_implicit(!table.is_empty() && table.iter().all(|(_, item)| item.is_table()));
    Ok(table)
}

/// Value on one line.
fn value_of<'c>(contents: &'c Contents, path: &mut Vec<&'c str>) -> Result<Value, String> {
    Ok(match contents {
        Contents::None => return Err(format!("`{}` has an empty entry in a list", path.join("."))),
        Contents::Flag(flag) => Value::from(*flag),
        Contents::Whole(number) => Value::from(*number),
        Contents::Number(number) => Value::from(*number),
        Contents::Text(text) => Value::from(text.as_str()),
        Contents::List(list) => {
            let values: Result<Array, String> = list.iter().map(|one| value_of(one, path)).collect();
            Value::Array(values?)
        }
        Contents::Table(fields) => {
            let mut table = InlineTable::new();
            merge(&mut table, fields, 0, path)?;
            Value::InlineTable(table)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contents(json: &str) -> Contents {
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn entries_of_all_layouts_are_merged_and_comments_stay() {
        let text = "joints.a = { type = \"revolute\", at = \"A\" } # bearing\n\n\
            # the motor\n[drivers.motor]\nlaw = \"t\" # rad\njoint = \"a\"\n";
        let changes = contents(
            r#"{
                "joints": { "a": { "at": "B" }, "b": { "type": "spherical" } },
                "drivers": { "motor": { "law": { "type": "table", "points": [[0, 0], [1, 2.5]] } }, "old": null },
                "loads": "static"
            }"#,
        );
        let expected = "joints.a = { type = \"revolute\", at = \"B\" } # bearing\n\
            joints.b = { type = \"spherical\" }\n\
            loads = \"static\"\n\n\
            # the motor\n[drivers.motor]\n\
            law = { type = \"table\", points = [[0, 0], [1, 2.5]] } # rad\njoint = \"a\"\n";
        assert_eq!(merged(text, &changes).unwrap(), expected);
    }

    #[test]
    fn a_text_from_nothing_has_the_order_of_its_contents() {
        let sections = r#"{ "name": "x", "hardpoints": { "B": [0, 0.1, 2], "A": [true] }, "bodies": { "arm": {} },
            "time": { "steps": 2, "end": 1.0 } }"#;
        let expected = "name = \"x\"\n\n[hardpoints]\nB = [0, 0.1, 2]\nA = [true]\n\n[bodies.arm]\n\n\
            [time]\nsteps = 2\nend = 1.0\n";
        assert_eq!(merged("", &contents(sections)).unwrap(), expected);
    }

    #[test]
    fn what_toml_cannot_express_is_an_error_with_its_key() {
        let error = merged("", &contents(r#"{ "hardpoints": { "A": [0, null] } }"#)).unwrap_err();
        assert_eq!(error, "`hardpoints.A` has an empty entry in a list");
        assert!(merged("a = ", &contents("{}")).is_err() && merged("", &Contents::None).is_err());
    }
}

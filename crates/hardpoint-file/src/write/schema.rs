//! JSON Schema of model files, written from the declarations of the format.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};
use serde_json::{Value, json};

use crate::compose::SECTIONS;
use crate::read::MODEL;
use crate::values::{Key, Kinds, Need, Shape, Table};

/// JSON Schema of model files, the contents of `models/hardpoint.schema.json`.
///
/// ```
/// assert!(hardpoint_file::schema().contains("\"hardpoints\""));
/// ```
pub fn schema() -> String {
    let mut definitions = Definitions::default();
    let mut root = definitions.object(None, MODEL.keys());
    images(&mut root, &mut definitions);
    root["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    root["title"] = MODEL.name.into();
    root["description"] = MODEL.doc.into();
    root["$defs"] = definitions.0.into_iter().collect();
    let mut text = serde_json::to_string_pretty(&Ordered { value: &root, names: false })
        .expect("a schema is plain JSON");
    text.push('\n');
    text
}

/// In a file with a mirror or included files, an entry may have only the keys that differ from an image or from an
/// included entry.
fn images(root: &mut Value, definitions: &mut Definitions) {
    let different = json!({ "type": "object", "description": "Differences from the mirror image, or from the included entry." });
    definitions.0.insert("Different".to_owned(), different);
    let mut whole = BTreeMap::new();
    for section in SECTIONS.into_iter().filter(|s| !["parameters", "hardpoints"].contains(s)) {
        let entries = &mut root["properties"][section]["additionalProperties"];
        let entry = entries.take();
        *entries = json!({ "anyOf": [entry, { "$ref": "#/$defs/Different" }] });
        whole.insert(section, json!({ "additionalProperties": entry }));
    }
    root["if"] = json!({ "anyOf": [{ "required": ["mirror"] }, { "required": ["include"] }] });
    let required = root["required"].take();
    root["else"] = json!({ "properties": whole, "required": required });
    root["required"] = json!(["name"]);
}

/// Definitions of the schema with names of their own.
#[derive(Default)]
struct Definitions(BTreeMap<String, Value>);

impl Definitions {
    /// A table with these keys, and its `type` where that is fixed.
    fn object(&mut self, kind: Option<&str>, keys: impl Iterator<Item = &'static Key>) -> Value {
        let (mut properties, mut required) = (BTreeMap::new(), Vec::new());
        if let Some(kind) = kind {
            properties.insert("type", json!({ "type": "string", "const": kind }));
            required.push("type");
        }
        for key in keys {
            let mut value = self.shape(key.shape);
            value["description"] = key.doc.into();
            match key.need {
                Need::Required => required.push(key.key),
                Need::Optional => {}
                Need::Else(default) => {
                    value["default"] = serde_json::from_str(default).expect("defaults are JSON");
                }
            }
            properties.insert(key.key, value);
        }
        let mut object = json!({ "type": "object", "properties": properties, "additionalProperties": false });
        if !required.is_empty() {
            object["required"] = json!(required);
        }
        object
    }

    fn shape(&mut self, shape: Shape) -> Value {
        match shape {
            Shape::Text | Shape::File | Shape::Expression | Shape::Name(_) => json!({ "type": "string" }),
            Shape::Number(_) => self.named("Number", |_| {
                json!({
                    "type": ["number", "string"],
                    // Neither a plain number in quotes, nor one with its unit.
                    "pattern": r"^(?!\s*[-+]?[0-9.,]+([eE][-+]?[0-9]+)?\s*([A-DF-Za-df-z].*)?$)",
                    "description": "A number, or an expression over parameters, in quotes."
                })
            }),
            Shape::Plain(_) => json!({ "type": "number" }),
            Shape::Count(u32::MAX) => json!({ "type": "integer", "minimum": 1 }),
            Shape::Count(most) => json!({ "type": "integer", "minimum": 1, "maximum": most }),
            Shape::Flag => json!({ "type": "boolean" }),
            Shape::Words(words) => one_of(words.iter().map(|(word, doc)| (*word, (*doc).to_owned()))),
            Shape::Known(_, words) => one_of(words().into_iter()),
            Shape::OneOf(numbers) => json!({ "type": "integer", "enum": numbers }),
            Shape::List(of, [least, most]) => {
                let mut list = json!({ "type": "array", "items": self.shape(*of) });
                if least > 0 {
                    list["minItems"] = least.into();
                }
                if most < usize::MAX {
                    list["maxItems"] = most.into();
                }
                list
            }
            Shape::Entries(_, of) => json!({ "type": "object", "additionalProperties": self.shape(*of) }),
            Shape::Table(table) => self.table(table),
            Shape::Kinds(kinds) => self.named(kinds.name, |all| all.kinds(kinds)),
            Shape::Any(name, doc, shapes) => self.named(name, |all| {
                let any: Vec<Value> = shapes.iter().map(|s| all.shape(*s)).collect();
                described(json!({ "anyOf": any }), doc)
            }),
        }
    }

    fn table(&mut self, table: &'static Table) -> Value {
        self.named(table.name, |all| described(all.object(None, table.keys()), table.doc))
    }

    fn kinds(&mut self, kinds: &Kinds) -> Value {
        let tables = (kinds.tables)().into_iter();
        let of = match kinds.typed {
            true => {
                let one = |t: &'static Table| described(self.object(Some(t.name), t.keys()), t.doc);
                json!({ "oneOf": tables.map(one).collect::<Vec<_>>() })
            }
            false => json!({ "anyOf": tables.map(|t| self.table(t)).collect::<Vec<_>>() }),
        };
        described(of, &kinds.doc())
    }

    /// A reference to a definition, which is written when it is met first.
    fn named(&mut self, name: &str, write: impl FnOnce(&mut Self) -> Value) -> Value {
        if !self.0.contains_key(name) {
            // Laws hold laws.
            self.0.insert(name.to_owned(), Value::Null);
            let written = write(self);
            self.0.insert(name.to_owned(), written);
        }
        json!({ "$ref": format!("#/$defs/{name}") })
    }
}

fn described(mut value: Value, doc: &str) -> Value {
    if !doc.is_empty() {
        value["description"] = doc.into();
    }
    value
}

fn one_of(words: impl Iterator<Item = (&'static str, String)>) -> Value {
    let words: Vec<_> = words.collect();
    if words.iter().all(|(_, doc)| doc.is_empty()) {
        let words: Vec<_> = words.iter().map(|w| w.0).collect();
        return json!({ "type": "string", "enum": words });
    }
    let one = |(word, doc): (&str, String)| described(json!({ "type": "string", "const": word }), &doc);
    json!({ "oneOf": words.into_iter().map(one).collect::<Vec<_>>() })
}

/// JSON with the most important keys first.
struct Ordered<'a> {
    value: &'a Value,
    /// True if its keys are names that the schema gives, rather than words of JSON Schema.
    names: bool,
}

impl Serialize for Ordered<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        const FIRST: [&str; 5] = ["$schema", "title", "description", "type", "properties"];
        match self.value {
            Value::Object(map) => {
                let rank = |key: &str| match FIRST.iter().position(|k| *k == key) {
                    Some(k) => k,
                    None => FIRST.len() + usize::from(key == "$defs"),
                };
                let mut keys: Vec<&String> = map.keys().collect();
                if !self.names {
                    keys.sort_by_key(|key| rank(key));
                }
                let names = |key: &str| !self.names && ["properties", "$defs"].contains(&key);
                serializer
                    .collect_map(keys.into_iter().map(|k| (k, Ordered { value: &map[k], names: names(k) })))
            }
            Value::Array(list) => {
                serializer.collect_seq(list.iter().map(|value| Ordered { value, names: false }))
            }
            value => value.serialize(serializer),
        }
    }
}

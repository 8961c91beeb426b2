//! JSON Schemas of the tools' arguments and results.

use serde_json::{Map, Value, json};

/// A key with its schema.
pub struct Field {
    key: &'static str,
    schema: Value,
    is_required: bool,
}

/// Required key.
pub fn must(key: &'static str, schema: Value, about: &str) -> Field {
    Field { key, schema: described(schema, about), is_required: true }
}

/// Optional key.
pub fn may(key: &'static str, schema: Value, about: &str) -> Field {
    Field { key, schema: described(schema, about), is_required: false }
}

fn described(mut schema: Value, about: &str) -> Value {
    schema["description"] = about.into();
    schema
}

/// An object with these keys, and no others.
pub fn arguments(fields: Vec<Field>) -> Value {
    let mut schema = object(fields);
    schema["additionalProperties"] = false.into();
    schema
}

/// An object with at least the required ones of these keys.
pub fn object(fields: Vec<Field>) -> Value {
    let required: Vec<&str> = fields.iter().filter(|f| f.is_required).map(|f| f.key).collect();
    let properties: Map<String, Value> = fields.into_iter().map(|f| (f.key.to_owned(), f.schema)).collect();
    let mut schema = json!({ "type": "object", "properties": properties });
    if !required.is_empty() {
        schema["required"] = json!(required);
    }
    schema
}

/// A text.
pub fn text() -> Value {
    json!({ "type": "string" })
}

/// A whole number from `least`.
pub fn count(least: u32) -> Value {
    json!({ "type": "integer", "minimum": least })
}

/// `true` or `false`.
pub fn flag() -> Value {
    json!({ "type": "boolean" })
}

/// One of these words.
pub fn one_of(words: &[&str]) -> Value {
    json!({ "type": "string", "enum": words })
}

/// A list.
pub fn list(of: Value) -> Value {
    json!({ "type": "array", "items": of })
}

/// Any object.
pub fn any_object() -> Value {
    json!({ "type": "object" })
}

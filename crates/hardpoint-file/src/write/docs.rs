//! Tables of `docs/file-format.md`, written from the declarations.

use hardpoint::joint::Quantity;

use crate::read::{tables, task_tables};
use crate::values::{Key, Kinds, Need, Shape, noun, several};

/// Row of a key: name, form of the value, default, and meaning.
fn row(key: &Key) -> String {
    let default = match key.need {
        Need::Required => "required".to_owned(),
        Need::Optional => String::new(),
        Need::Else(value) => format!("`{}`", value.strip_suffix(".0").unwrap_or(value)),
    };
    format!("| `{}` | {} | {default} | {} |\n", key.key, words(key.shape), key.doc)
}

fn words(shape: Shape) -> String {
    let many = |of: Shape| {
        let one = words(of);
        if one.ends_with('s') { one } else { format!("{one}s") }
    };
    match shape {
        Shape::Text | Shape::File | Shape::Expression => "text".into(),
        Shape::Name(one) => format!("{}'s name", noun(one)),
        Shape::Number(Quantity::Length) => "length".into(),
        Shape::Number(Quantity::Angle) => "angle".into(),
        Shape::Number(Quantity::Number) | Shape::Plain(_) => "number".into(),
        Shape::Count(u32::MAX) => "whole number from 1".into(),
        Shape::Count(most) => format!("whole number, 1 to {most}"),
        Shape::Flag => "`true`, `false`".into(),
        Shape::Words(_) => shape.words().iter().map(|w| format!("`\"{w}\"`")).collect::<Vec<_>>().join(", "),
        Shape::Known(name, _) => name.strip_prefix("the ").unwrap_or(name).into(),
        Shape::OneOf(numbers) => numbers.iter().map(u32::to_string).collect::<Vec<_>>().join(", "),
        Shape::List(Shape::Name(one), [2, 2]) => format!("two {}' names", several(one)),
        Shape::List(Shape::Name(one), _) => format!("list of {}' names", several(one)),
        Shape::List(of, [2, 2]) => format!("two {}", many(*of)),
        Shape::List(of, [3, 3]) => format!("three {}", many(*of)),
        Shape::List(of, [4, 4]) => format!("four {}", many(*of)),
        Shape::List(Shape::List(of, [3, 3]), _) => format!("list of triples of {}", many(**of)),
        Shape::List(Shape::List(of, _), _) => format!("list of pairs of {}", many(**of)),
        Shape::List(of, _) => format!("list of {}", many(*of)),
        Shape::Entries(_, of) => format!("table of names and {}", many(*of)),
        Shape::Table(_) | Shape::Kinds(_) => "table".into(),
        Shape::Any(_, "", shapes) => shapes.iter().map(|s| words(*s)).collect::<Vec<_>>().join(" or "),
        // A word of the text.
        Shape::Any(name, _, _) => {
            let mut word = String::new();
            for c in name.chars() {
                if c.is_uppercase() && !word.is_empty() {
                    word.push(' ');
                }
                word.extend(c.to_lowercase());
            }
            word
        }
    }
}

fn keys<'k>(keys: impl IntoIterator<Item = &'k Key>) -> String {
    let rows = keys.into_iter().map(row);
    format!("| key | type | default | meaning |\n|---|---|---|---|\n{}", rows.collect::<String>())
}

/// Kinds of a table that are selected by their first key, with shared keys.
fn led(kinds: &Kinds) -> String {
    let mut text = "| given by | key | type | default | meaning |\n|---|---|---|---|---|\n".to_owned();
    let tables = (kinds.tables)();
    for t in &tables {
        text += &format!("| `{}` | | | | {} |\n", t.keys[0].key, t.doc);
        text.extend(t.keys.iter().map(|key| format!("| {}", row(key))));
    }
    if let [first, ..] = tables.as_slice() {
        text.extend(first.shared.iter().map(|key| format!("| any {}", row(key))));
    }
    text
}

/// Kinds of a table that are selected by `type`: descriptions, then the keys of each.
fn typed(kinds: &Kinds) -> String {
    let mut text = "| `type` | description |\n|---|---|\n".to_owned();
    let tables = (kinds.tables)();
    text.extend(tables.iter().map(|t| format!("| `\"{}\"` | {} |\n", t.name, t.doc)));
    text += "\n| of | key | type | default | meaning |\n|---|---|---|---|---|\n";
    let mut before: Vec<&[Key]> = Vec::new();
    for t in tables {
        // Aliases have the same keys.
        if before.iter().any(|keys| std::ptr::eq(*keys, t.keys)) {
            continue;
        }
        before.push(t.keys);
        let of = |k: usize| if k == 0 { format!("| {} ", t.name) } else { "| ".to_owned() };
        text.extend(t.keys().enumerate().map(|(k, key)| of(k) + &row(key)));
    }
    text
}

#[test]
fn the_tables_of_the_documents_are_those_that_are_declared() {
    declared_in("file-format.md", &tables());
    declared_in("synthesis.md", &task_tables());
}

/// Checks the tables of a document, or writes them.
#[cfg(test)]
fn declared_in(document: &str, tables: &[(&str, Shape)]) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(document);
    let text = std::fs::read_to_string(&path).unwrap();
    let mut expected = text.clone();
    for (name, of) in tables {
        let table = match of {
            Shape::Table(table) => keys(table.keys()),
            Shape::Kinds(kinds) if kinds.typed => typed(kinds),
            Shape::Kinds(kinds) => led(kinds),
            _ => unreachable!("tables are documented"),
        };
        let begin = format!("<!-- keys of {name}, declared in the source -->\n");
        let (before, rest) = expected.split_once(&begin).unwrap_or_else(|| panic!("no table `{name}`"));
        let (_, after) = rest.split_once("<!-- end -->").unwrap_or_else(|| panic!("`{name}` has no end"));
        expected = format!("{before}{begin}{table}<!-- end -->{after}");
    }
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, &expected).unwrap();
    }
    assert!(text == expected, "run the tests with UPDATE_DOCS=1 and commit docs/{document}");
}

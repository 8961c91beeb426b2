//! Traversal of a value by its declaration: its names, expressions and vectors, for rewriting.

use std::borrow::Cow;
use std::ops::Range;

use hardpoint::joint::Quantity;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::fields::Value;
use super::format::{Key, Shape};

/// Contents of a value at a place.
pub(crate) enum Leaf<'v, 'a> {
    /// Name of an entry, like "a joint".
    Name(&'static str, &'v mut Cow<'a, str>),
    /// Name of a file.
    File(&'v mut Cow<'a, str>),
    /// An expression in a text.
    Expression(&'v mut Cow<'a, str>),
    /// A global axis by its name, like `-x`.
    Axis(&'v mut Cow<'a, str>),
    /// Three numbers other than angles: a location or a direction.
    Vector(&'v mut DeArray<'a>),
    /// Two components of a vector with three.
    Pair(&'v mut DeArray<'a>),
    /// Three angles.
    Angles(&'v mut DeArray<'a>),
    /// The four numbers of a quaternion.
    Quaternion(&'v mut DeArray<'a>),
}

/// Receiver of all leaves, each with its key.
pub(crate) type Visit<'f, 'a> = dyn FnMut(&str, Leaf<'_, 'a>) + 'f;

/// Visits all leaves of a value that match this form.
pub(crate) fn walk<'a>(key: &str, shape: Shape, value: &mut Value<'a>, visit: &mut Visit<'_, 'a>) {
    let all = alternatives(shape);
    match value.get_mut() {
        DeValue::String(text) => {
            let name = all.iter().find_map(|s| if let Shape::Name(kind) = s { Some(*kind) } else { None });
            let is = |wanted: fn(&Shape) -> bool| all.iter().any(wanted);
            match name {
                Some(kind) => visit(key, Leaf::Name(kind, text)),
                None if is(|s| matches!(s, Shape::File)) => visit(key, Leaf::File(text)),
                None if is(|s| matches!(s, Shape::Expression | Shape::Number(_))) => {
                    visit(key, Leaf::Expression(text));
                }
                None if is(|s| matches!(s, Shape::Words(words) if words.iter().any(|w| w.0 == "-x"))) => {
                    visit(key, Leaf::Axis(text));
                }
                None => {}
            }
        }
        DeValue::Array(list) => {
            let is_vector = |s: &Shape| {
                let of = if let Shape::List(of, [3, 3]) = s { of } else { return false };
                matches!(of, Shape::Number(Quantity::Length | Quantity::Number) | Shape::Plain(_))
            };
            let is_number = |v: &Value<'_>| matches!(v.get_ref(), DeValue::Integer(_) | DeValue::Float(_));
            let pairs = all.iter().any(|s| matches!(s, Shape::List(_, [2, 2])));
            if list.len() == 2 && all.iter().any(is_vector) && (!pairs || list.iter().any(is_number)) {
                visit(key, Leaf::Pair(list));
            }
            let Some((of, [least, most])) = list_form(&all, list.len()) else { return };
            // Contents are visited before the whole value.
            list.iter_mut().for_each(|value| walk(key, *of, value, visit));
            match (of, least == most, list.len()) {
                (Shape::Number(Quantity::Angle), true, 3) => visit(key, Leaf::Angles(list)),
                (Shape::Number(_) | Shape::Plain(_), true, 3) => visit(key, Leaf::Vector(list)),
                (Shape::Number(_), true, 4) => visit(key, Leaf::Quaternion(list)),
                _ => {}
            }
        }
        DeValue::Table(table) => {
            if let Some(Shape::Entries(kind, of)) = all.iter().find(|s| matches!(s, Shape::Entries(..))) {
                entries(kind, **of, table, visit);
                return;
            }
            let kind = table.get("type").and_then(|v| v.get_ref().as_str());
            let keys = key_list(&all, kind);
            for (name, value) in table.iter_mut() {
                if let Some(key) = keys.iter().find(|key| key.key == name.get_ref()) {
                    walk(key.key, key.shape, value, visit);
                }
            }
        }
        _ => {}
    }
}

/// The value as a table.
pub(crate) fn table_of<'v, 'a>(value: &'v mut Value<'a>) -> Option<&'v mut DeTable<'a>> {
    if let DeValue::Table(table) = value.get_mut() { Some(table) } else { None }
}

/// The value as a list.
pub(crate) fn list_of<'v, 'a>(value: &'v mut Value<'a>) -> Option<&'v mut DeArray<'a>> {
    if let DeValue::Array(list) = value.get_mut() { Some(list) } else { None }
}

/// Entries of a table whose keys are names.
fn entries<'a>(kind: &'static str, of: Shape, table: &mut DeTable<'a>, visit: &mut Visit<'_, 'a>) {
    let before = std::mem::take(table);
    for (name, mut value) in before {
        let span = name.span();
        let mut name = name.into_inner();
        visit("", Leaf::Name(kind, &mut name));
        walk("", of, &mut value, visit);
        table.insert(Spanned::new(span, name), value);
    }
}

/// Form of the elements of a list of this length, and its limits. A list form with the right length takes precedence
/// over one of any length.
pub(crate) fn list_form(all: &[Shape], length: usize) -> Option<(&'static Shape, [usize; 2])> {
    let lists = all.iter().filter_map(|shape| match shape {
        Shape::List(of, [least, most]) if (*least..=*most).contains(&length) => Some((*of, [*least, *most])),
        _ => None,
    });
    lists.clone().find(|(_, [least, most])| least == most).or_else(|| lists.clone().next())
}

/// Alternatives of a form.
pub(crate) fn alternatives(shape: Shape) -> Vec<Shape> {
    match shape {
        Shape::Any(_, _, shapes) => shapes.iter().flat_map(|s| alternatives(*s)).collect(),
        shape => vec![shape],
    }
}

/// Keys of a table with one of these forms: those of its `type`, if it has one.
pub(crate) fn key_list(all: &[Shape], kind: Option<&str>) -> Vec<&'static Key> {
    let keys = |shape: &Shape| match shape {
        Shape::Table(table) => table.keys().collect::<Vec<_>>(),
        Shape::Kinds(kinds) if kinds.typed => {
            let tables = (kinds.tables)().into_iter().filter(|table| Some(table.name) == kind);
            tables.flat_map(|table| table.typed_keys()).collect()
        }
        Shape::Kinds(kinds) => kinds.keys(),
        _ => Vec::new(),
    };
    all.iter().flat_map(keys).collect()
}

/// Ranges of the names of numbers in an expression, with a coordinate after a point, like `A.x`.
pub(crate) fn names_in_expression(text: &str) -> Vec<Range<usize>> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    let (mut names, mut at) = (Vec::new(), 0);
    while let Some(first) = text[at..].chars().next() {
        // A number with its exponent is not a name.
        let is_name = first.is_alphabetic() || first == '_';
        let length = match is_part(first) {
            true => text[at..].find(|c| !is_part(c)).unwrap_or(text.len() - at),
            false => first.len_utf8(),
        };
        if is_name {
            names.push(at..at + length);
        }
        at += length;
    }
    names
}

/// Rewrites the names in an expression.
pub(crate) fn in_expression<'a>(text: &mut Cow<'a, str>, say: impl Fn(&str) -> Option<String>) {
    let (mut out, mut changed, mut end) = (String::with_capacity(text.len()), false, 0);
    for name in names_in_expression(text) {
        if let Some(said) = say(&text[name.clone()]) {
            out += &text[end..name.start];
            out += &said;
            (changed, end) = (true, name.end);
        }
    }
    if changed {
        out += &text[end..];
        *text = Cow::Owned(out);
    }
}

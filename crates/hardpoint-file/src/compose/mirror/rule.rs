//! The rule of a mirror: its axis, the words that it exchanges, and the images of names, numbers and vectors.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::compose::side_names::{WORDS, exchanged, is_original};
use crate::values::{Leaf, Shape, Value, axis_named, in_expression, walk};

/// Rule of the mirror: axis, names, exceptions.
pub(super) struct Rule<'n> {
    pub numbers: &'n Opposites,
    pub across: usize,
    pub words: Vec<(String, String)>,
    /// Names that are the same on both sides.
    pub kept: HashSet<String>,
    /// Parameters that are the same on both sides.
    pub shared: HashSet<String>,
}

impl<'n> Rule<'n> {
    /// Name with its words exchanged, if it has any of them.
    pub fn exchanged(&self, name: &str) -> Option<String> {
        exchanged(name, &self.words)
    }

    /// Name of the image of an entry with this name.
    pub fn twin(&self, name: &str) -> Option<String> {
        if self.kept.contains(name) { None } else { image(name, &self.words) }
    }

    /// Name on the other side of a name, or of a measure's name such as `left.toe`.
    pub fn said(&self, name: &str) -> Option<String> {
        let base = name.split('.').next().unwrap_or(name);
        if self.kept.contains(base) || self.kept.contains(name) { None } else { self.exchanged(name) }
    }

    /// Mirrors the names and vectors of a value; `turns` lists the keys whose vector is a rotation. Returns whether
    /// there was any name.
    pub fn mirror(&self, shape: Shape, value: &mut Value<'n>, turns: &dyn Fn(&str) -> bool) -> bool {
        let mut named = false;
        let axes = ["x", "y", "z"];
        walk("", shape, value, &mut |key, leaf| match leaf {
            Leaf::Name("a column" | "a parameter" | "a parameter of the law" | "a coordinate", _)
            | Leaf::File(_)
            | Leaf::Pair(_) => {}
            Leaf::Name(_, name) => {
                if let Some(said) = self.said(name) {
                    *name = Cow::Owned(said);
                    named = true;
                }
            }
            Leaf::Expression(text) => in_expression(text, |word| {
                if self.shared.contains(word) {
                    return None;
                }
                let said = self.said(word)?;
                let turned = said.split_once('.').is_some_and(|(_, c)| c == axes[self.across]);
                Some(if turned { format!("(-{said})") } else { said })
            }),
            Leaf::Axis(word) => {
                let letter = word.trim_start_matches(['+', '-']);
                if (letter == axes[self.across]) != turns(key) && axis_named(word).is_some() {
                    let minus = if word.starts_with('-') { "" } else { "-" };
                    *word = Cow::Owned(format!("{minus}{letter}"));
                }
            }
            // The lengths of a box have no direction.
            Leaf::Vector(_) if key == "box" => {}
            Leaf::Vector(list) => {
                let turned = turns(key);
                each(list, self.numbers, |k| (k == self.across) != turned);
            }
            // Turns one after the other, between two mirrors: those about the mirror's axis stay, all others go the
            // other way.
            Leaf::Angles(list) => each(list, self.numbers, |k| turned_about(key, k) != self.across),
            Leaf::Quaternion(list) => each(list, self.numbers, |k| k > 0 && k - 1 != self.across),
        });
        named
    }
}

/// The axis of the k-th angle under a key: Cardan angles are of x, y and z in their order, and so are roll, pitch and
/// yaw; 3-1-3 Euler angles are of z, x and z.
fn turned_about(key: &str, k: usize) -> usize {
    match (key, k) {
        ("cardan" | "roll_pitch_yaw", k) => k,
        (_, 1) => 0,
        _ => 2,
    }
}

/// Name of the image of an entry on the written side.
fn image(name: &str, words: &[(String, String)]) -> Option<String> {
    if is_original(name, words)? { exchanged(name, words) } else { None }
}

/// Names of the images, for entries that refer to them before they exist. Errors are reported when the mirror is made.
pub(crate) fn images(model: &DeTable<'_>) -> impl Fn(&str) -> Option<String> + use<> {
    let said = model.get("mirror").and_then(|v| v.get_ref().as_table());
    let text = |value: &Value<'_>| value.get_ref().as_str().map(str::to_owned);
    let words: Vec<(String, String)> = match (said, said.and_then(|t| t.get("names"))) {
        (None, _) => Vec::new(),
        (Some(_), None) => vec![WORDS.map(str::to_owned).into()],
        (Some(_), Some(names)) => {
            let names = names.get_ref().as_table().into_iter().flatten();
            names.filter_map(|(from, to)| Some((from.get_ref().to_string(), text(to)?))).collect()
        }
    };
    let except = said.and_then(|t| t.get("except")?.get_ref().as_array()).into_iter().flatten();
    let except: HashSet<String> = except.filter_map(text).collect();
    move |name| match except.contains(name) {
        true => None,
        false => image(name, &words),
    }
}

/// Changes the signs of some numbers in a list.
pub(super) fn each<'a>(list: &mut DeArray<'a>, numbers: &'a Opposites, turned: impl Fn(usize) -> bool) {
    list.iter_mut().enumerate().filter(|(k, _)| turned(*k)).for_each(|(_, value)| turn_sign(value, numbers));
}

/// Numbers as written, and with the opposite sign.
pub(crate) type Opposites = HashMap<String, String>;

/// Numbers of files of which one has a mirror, with the opposite sign.
pub(crate) fn opposites<'t>(files: impl Iterator<Item = &'t DeTable<'t>> + Clone) -> Opposites {
    let mut all = Opposites::new();
    if files.clone().any(|table| table.contains_key("mirror")) {
        files.flat_map(DeTable::values).for_each(|value| opposites_in(value, &mut all));
    }
    all
}

fn opposites_in(value: &Value<'_>, all: &mut Opposites) {
    let text = match value.get_ref() {
        DeValue::Array(list) => return list.iter().for_each(|value| opposites_in(value, all)),
        DeValue::Table(table) => return table.values().for_each(|value| opposites_in(value, all)),
        DeValue::Integer(i) if i.radix() == 10 => i.as_str(),
        DeValue::Float(f) => f.as_str(),
        _ => return,
    };
    let turned = match text.strip_prefix('-') {
        Some(rest) => rest.to_owned(),
        // No -0.
        None if text.parse() == Ok(0.0) => return,
        None => format!("-{}", text.trim_start_matches('+')),
    };
    all.insert(text.to_owned(), turned);
}

/// A number or an expression with the opposite sign.
pub(super) fn turn_sign<'a>(value: &mut Value<'a>, numbers: &'a Opposites) {
    let turned = match value.get_ref() {
        DeValue::String(text) => DeValue::String(Cow::Owned(format!("-({text})"))),
        DeValue::Integer(i) => match numbers.get(i.as_str()).map(|text| DeValue::parse(text)) {
            Some(Ok(turned)) => turned.into_inner(),
            _ => return,
        },
        DeValue::Float(f) => match numbers.get(f.as_str()).map(|text| DeValue::parse(text)) {
            Some(Ok(turned)) => turned.into_inner(),
            _ => return,
        },
        _ => return,
    };
    *value = Spanned::new(value.span(), turned);
}

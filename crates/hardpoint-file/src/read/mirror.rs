//! The other side of a symmetric mechanism, created from the written one.
//!
//! Images are created from the values of the text before they are read: they have names of their own, and the locations
//! of their originals. A mirror image has the same joint coordinates and measures as its original: directions of
//! translation are mirrored as vectors, and axes of rotation as pseudovectors.

mod origins;
mod side;

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::diagnostic::shown;
use crate::format::{Shape, Table, table};
use crate::side_names::{WORDS, exchanged, is_original};
use crate::tree::{Reader, Value, axis_named};
use crate::walk::{Leaf, in_expression, table_of, walk};

pub(crate) use origins::{Origins, deduplicated, with_origin};
use side::Side;

pub(crate) const MIRROR: Table = table! {
    /// Mirror: entries of one side apply to the other side as well.
    "Mirror":
    /// The global axis perpendicular to the mirror, a plane through the origin: `"y"` between left and right.
    or("\"y\"") "across": Shape::Words(&[("x", ""), ("y", ""), ("z", "")]), "\"y\"";
    /// Words in names, and their counterparts on the other side. A word ends at the end of the name, or at `_`, `-` or
    /// a blank.
    or("{ \"left\": \"right\" }") "names": Shape::Entries("a word", &Shape::Text), "{ left = \"right\" }";
    /// Design variables of mirrored entries.
    or("\"symmetric\"") "variables": VARIABLES, "\"independent\"";
    /// Names of entries that are on one side only.
    may "except": Shape::list(&Shape::Name("a thing")), "[\"left_damper\"]";
    /// Names of drivers that move oppositely on the other side, such as steering.
    may "antisymmetric": Shape::list(&crate::format::DRIVER), "[\"left_steer\"]";
};
const VARIABLES: Shape = Shape::Words(&[
    ("symmetric", "Each changes both sides alike."),
    ("independent", "Those with such a word in their names have one of their own on the other side."),
]);
/// Sections whose entries are mirrored; parameters and design variables only if each side has its own.
pub(crate) const SECTIONS: [&str; 14] = [
    "parameters",
    "hardpoints",
    "bodies",
    "joints",
    "couplers",
    "drivers",
    "design",
    "points",
    "wheels",
    "axles",
    "masses",
    "forces",
    "measures",
    "metrics",
];
/// Maximum number of words.
const MOST_WORDS: usize = 20;

/// Table of a model with both sides.
pub(crate) struct Both<'a> {
    pub table: DeTable<'a>,
    /// Further changes of design variables, by their names.
    pub twins: HashMap<String, Value<'a>>,
}

/// Rule of the mirror: axis, names, exceptions.
struct Rule<'n> {
    numbers: &'n Opposites,
    across: usize,
    words: Vec<(String, String)>,
    /// Names that are the same on both sides.
    kept: HashSet<String>,
    /// Parameters that are the same on both sides.
    shared: HashSet<String>,
}

impl<'n> Rule<'n> {
    /// Name with its words exchanged, if it has any of them.
    fn exchanged(&self, name: &str) -> Option<String> {
        exchanged(name, &self.words)
    }

    /// Name of the image of an entry with this name.
    fn twin(&self, name: &str) -> Option<String> {
        if self.kept.contains(name) { None } else { image(name, &self.words) }
    }

    /// Name on the other side of a name, or of a measure's name such as `left.toe`.
    fn said(&self, name: &str) -> Option<String> {
        let base = name.split('.').next().unwrap_or(name);
        if self.kept.contains(base) || self.kept.contains(name) { None } else { self.exchanged(name) }
    }

    /// Mirrors the names and vectors of a value; `turns` lists the keys whose vector is a rotation. Returns whether
    /// there was any name.
    fn mirror(&self, shape: Shape, value: &mut Value<'n>, turns: &dyn Fn(&str) -> bool) -> bool {
        let mut named = false;
        let axes = ["x", "y", "z"];
        walk("", shape, value, &mut |key, leaf| match leaf {
            Leaf::Name("a column" | "a parameter" | "a parameter of the law", _)
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
pub(super) fn images(model: &DeTable<'_>) -> impl Fn(&str) -> Option<String> + use<> {
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
fn each<'a>(list: &mut DeArray<'a>, numbers: &'a Opposites, turned: impl Fn(usize) -> bool) {
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
fn turn_sign<'a>(value: &mut Value<'a>, numbers: &'a Opposites) {
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

impl Reader<'_> {
    /// Table of the model with its mirror images; `None` without a mirror, or if it cannot be read, which is reported.
    pub fn both_sides<'a>(&mut self, model: &DeTable<'a>, numbers: &'a Opposites) -> Option<Both<'a>> {
        let value = model.get("mirror")?;
        let Some(said) = value.get_ref().as_table() else {
            let message = "`mirror` must be a table";
            self.report("HP0105", value.span(), message).help =
                Some("for example `mirror = { across = \"y\", names = { left = \"right\" } }`".into());
            return None;
        };
        let before = self.found.len();
        let fields = self.fields("`mirror`", value.span(), said, MIRROR.keys());
        let across = self.word_of(&fields, "across");
        let each_its_own = self.word_of(&fields, "variables") == Some(1);
        let words = match fields.get("names") {
            None => vec![WORDS.map(str::to_owned).into()],
            Some(f) => self.words_of(f.value),
        };
        let mut listed = |key: &str| -> Vec<(String, std::ops::Range<usize>)> {
            let subject = fields.subject(key);
            let Some(f) = fields.get(key) else { return Vec::new() };
            let list = self.list(f.value, &subject, "a list of names").into_iter().flatten();
            list.filter_map(|v| Some((self.name(v, &subject, "a name in quotes")?, v.span()))).collect()
        };
        let (except, opposite) = (listed("except"), listed("antisymmetric"));
        if self.found.len() > before {
            return None;
        }
        let mut rule = Rule { numbers, across: across?, words, kept: HashSet::new(), shared: HashSet::new() };
        let entries = |section: &str| model.get(section).and_then(|v| v.get_ref().as_table());
        let named = |name: &str| SECTIONS.iter().any(|s| entries(s).is_some_and(|t| t.contains_key(name)));
        let has_driver = |name: &str| entries("drivers").is_some_and(|t| t.contains_key(name));
        let all: Vec<&str> =
            SECTIONS.iter().filter_map(|s| entries(s)).flatten().map(|(k, _)| &**k.get_ref()).collect();
        for (name, at) in &except {
            if !named(name) {
                self.unknown(at.clone(), &format!("nothing is named `{}`", shown(name)), name, &all);
            }
        }
        for (name, at) in opposite.iter().filter(|(name, _)| !has_driver(name)) {
            self.unknown(at.clone(), &format!("there is no driver named `{}`", shown(name)), name, &all);
        }
        rule.kept.extend(except.into_iter().map(|e| e.0));
        // A parameter is the same on both sides, unless it has a counterpart there.
        if let (Some(parameters), false) = (entries("parameters"), each_its_own) {
            let alone = |name: &&str| rule.exchanged(name).is_none_or(|n| !parameters.contains_key(&*n));
            let names = parameters.iter().map(|(name, _)| &**name.get_ref());
            let kept: Vec<String> = names.filter(alone).map(str::to_owned).collect();
            rule.shared.extend(kept);
        }
        let opposite = opposite.into_iter().map(|o| o.0).collect();
        let mut side = Side { rule, model, opposite, made: HashMap::new(), refused: Vec::new() };
        let mut table = model.clone();
        for section in SECTIONS.into_iter().filter(|s| each_its_own || !["parameters", "design"].contains(s))
        {
            if let Some(entries) = table.get_mut(section).and_then(|v| table_of(v)) {
                side.add(section, entries);
            }
        }
        let cases = table.get_mut("cases").and_then(|v| table_of(v));
        cases.into_iter().for_each(|cases| side.cases(cases));
        let mut twins = HashMap::new();
        if let (false, Some(design)) = (each_its_own, table.get_mut("design").and_then(|v| table_of(v))) {
            side.design(design, &mut twins);
        }
        let Side { rule, made, refused, .. } = side;
        for (at, message, help) in refused {
            self.report("HP0116", at, message).help = Some(help);
        }
        if made.is_empty() {
            let words: Vec<String> = rule.words.iter().map(|w| format!("`{}`", w.0)).collect();
            let message =
                format!("the mirror has no effect: no name contains the word {}", words.join(" or "));
            self.report("HP0116", value.span(), message).help = Some(
                "give the word that identifies the side under `names`, like `names = { l = \"r\" }`; words are separated by `_`, `-` or blanks, as in `l_ball`"
                    .into(),
            );
        }
        self.origins.names.extend(made.into_iter().map(|((_, name), of)| (name, of)));
        self.origins.words.extend(rule.words);
        Some(Both { table, twins })
    }

    /// Words that are exchanged.
    fn words_of(&mut self, value: &Value<'_>) -> Vec<(String, String)> {
        let Some(table) = value.get_ref().as_table() else {
            self.report("HP0105", value.span(), "`names` of `mirror` must be a table of words").help =
                Some("for example `names = { left = \"right\" }`".into());
            return Vec::new();
        };
        if table.len() > MOST_WORDS {
            let message = format!("`names` of `mirror` has {} words", table.len());
            self.report("HP0116", value.span(), message).help = Some(format!("give at most {MOST_WORDS}"));
            return Vec::new();
        }
        let is_word = |w: &str| !w.is_empty() && w.chars().all(char::is_alphanumeric);
        let mut words: Vec<(String, String)> = Vec::new();
        for (from, to) in table {
            let at = from.span().start..to.span().end;
            let other = to.get_ref().as_str().filter(|to| is_word(to) && is_word(from.get_ref()));
            let Some(other) = other.filter(|to| *to != &**from.get_ref()) else {
                let message = format!("`{}` of `names` is not one word for another", shown(from.get_ref()));
                self.report("HP0116", at, message).help = Some(
                    "write words of letters and digits without separators, like `l = \"r\"` for `arm_l`"
                        .into(),
                );
                continue;
            };
            words.push((from.get_ref().to_string(), other.to_owned()));
        }
        words
    }

    fn unknown(&mut self, at: std::ops::Range<usize>, message: &str, name: &str, all: &[&str]) {
        let close = self.guess(name, all.iter().copied());
        self.report("HP0204", at, message).help = close.map(|c| format!("did you mean `{c}`?"));
    }
}

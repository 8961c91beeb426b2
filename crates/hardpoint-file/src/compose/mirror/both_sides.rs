//! Both sides of a mirrored model, from the tables of one.

use super::rule::Rule;
use super::side::Side;
use super::{Opposites, Origins};
use crate::compose::entries::{Both, SECTIONS};
use crate::compose::side_names::WORDS;
use crate::values::{DRIVER, Reader, Shape, Table, Value, shown, table, table_of};
use std::collections::{HashMap, HashSet};
use toml::de::DeTable;

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
    may "antisymmetric": Shape::list(&DRIVER), "[\"left_steer\"]";
};

const VARIABLES: Shape = Shape::Words(&[
    ("symmetric", "Each changes both sides alike."),
    ("independent", "Those with such a word in their names have one of their own on the other side."),
]);

/// Maximum number of words.
const MOST_WORDS: usize = 20;

/// Table of the model with its mirror images; `None` without a mirror, or if it cannot be read, which is reported.
pub(crate) fn both_sides<'a>(
    r: &mut Reader<'_>,
    format: &'static Table,
    model: &DeTable<'a>,
    numbers: &'a Opposites,
    origins: &mut Origins,
) -> Option<Both<'a>> {
    let value = model.get("mirror")?;
    let Some(said) = value.get_ref().as_table() else {
        let message = "`mirror` must be a table";
        r.report("HP0105", value.span(), message).help =
            Some("for example `mirror = { across = \"y\", names = { left = \"right\" } }`".into());
        return None;
    };
    let before = r.found.len();
    let fields = r.fields("`mirror`", value.span(), said, MIRROR.keys());
    let across = r.word_of(&fields, "across");
    let each_its_own = r.word_of(&fields, "variables") == Some(1);
    let words = match fields.get("names") {
        None => vec![WORDS.map(str::to_owned).into()],
        Some(f) => words_of(r, f.value),
    };
    let mut listed = |key: &str| -> Vec<(String, std::ops::Range<usize>)> {
        let subject = fields.subject(key);
        let Some(f) = fields.get(key) else { return Vec::new() };
        let list = r.list(f.value, &subject, "a list of names").into_iter().flatten();
        list.filter_map(|v| Some((r.name(v, &subject, "a name in quotes")?, v.span()))).collect()
    };
    let (except, opposite) = (listed("except"), listed("antisymmetric"));
    if r.found.len() > before {
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
            unknown(r, at.clone(), &format!("nothing is named `{}`", shown(name)), name, &all);
        }
    }
    for (name, at) in opposite.iter().filter(|(name, _)| !has_driver(name)) {
        unknown(r, at.clone(), &format!("there is no driver named `{}`", shown(name)), name, &all);
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
    let mut side = Side { rule, format, model, opposite, made: HashMap::new(), refused: Vec::new() };
    let mut table = model.clone();
    for section in SECTIONS.into_iter().filter(|s| each_its_own || !["parameters", "design"].contains(s)) {
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
        r.report("HP0116", at, message).help = Some(help);
    }
    if made.is_empty() {
        let words: Vec<String> = rule.words.iter().map(|w| format!("`{}`", w.0)).collect();
        let message = format!("the mirror has no effect: no name contains the word {}", words.join(" or "));
        r.report("HP0116", value.span(), message).help = Some(
            "give the word that identifies the side under `names`, like `names = { l = \"r\" }`; words are separated by `_`, `-` or blanks, as in `l_ball`"
                .into(),
        );
    }
    origins.names.extend(made.into_iter().map(|((_, name), of)| (name, of)));
    origins.words.extend(rule.words);
    Some(Both { table, twins })
}

/// Words that are exchanged.
fn words_of(r: &mut Reader<'_>, value: &Value<'_>) -> Vec<(String, String)> {
    let Some(table) = value.get_ref().as_table() else {
        r.report("HP0105", value.span(), "`names` of `mirror` must be a table of words").help =
            Some("for example `names = { left = \"right\" }`".into());
        return Vec::new();
    };
    if table.len() > MOST_WORDS {
        let message = format!("`names` of `mirror` has {} words", table.len());
        r.report("HP0116", value.span(), message).help = Some(format!("give at most {MOST_WORDS}"));
        return Vec::new();
    }
    let is_word = |w: &str| !w.is_empty() && w.chars().all(char::is_alphanumeric);
    let mut words: Vec<(String, String)> = Vec::new();
    for (from, to) in table {
        let at = from.span().start..to.span().end;
        let other = to.get_ref().as_str().filter(|to| is_word(to) && is_word(from.get_ref()));
        let Some(other) = other.filter(|to| *to != &**from.get_ref()) else {
            let message = format!("`{}` of `names` is not one word for another", shown(from.get_ref()));
            r.report("HP0116", at, message).help = Some(
                "write words of letters and digits without separators, like `l = \"r\"` for `arm_l`".into(),
            );
            continue;
        };
        words.push((from.get_ref().to_string(), other.to_owned()));
    }
    words
}

fn unknown(r: &mut Reader<'_>, at: std::ops::Range<usize>, message: &str, name: &str, all: &[&str]) {
    let close = r.guess(name, all.iter().copied());
    r.report("HP0204", at, message).help = close.map(|c| format!("did you mean `{c}`?"));
}

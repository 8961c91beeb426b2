//! Entries of a model's tables: those written by hand take precedence over made ones.

use std::borrow::Cow;
use std::collections::HashMap;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::values::{Shape, Value, table_of};

/// Sections whose entries are mirrored; parameters and design variables only if each side has its own.
pub(crate) const SECTIONS: [&str; 16] = [
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
    "shapes",
    "clearances",
    "masses",
    "forces",
    "measures",
    "metrics",
];
/// Table of a model with both sides.
pub(crate) struct Both<'a> {
    pub table: DeTable<'a>,
    /// Further changes of design variables, by their names.
    pub twins: HashMap<String, Value<'a>>,
}

/// Adds the keys of an entry to one written by hand, whose keys take precedence.
pub(super) fn lay_under<'a>(
    of: Shape,
    entries: &mut DeTable<'a>,
    name: Spanned<Cow<'a, str>>,
    made: Value<'a>,
) -> bool {
    let Some(hand) = entries.get_mut(&**name.get_ref()) else {
        entries.insert(name, made);
        return true;
    };
    if table_of(hand).is_none_or(|hand| is_complete(of, hand)) {
        return false;
    }
    if matches!(of, Shape::Kinds(_) | Shape::Table(_)) && !made.get_ref().is_table() {
        // A value that is not the required table has nothing to merge: the error is reported elsewhere.
        *hand = made;
        return true;
    }
    table_of(hand).is_some_and(|hand| fill(hand, made))
}

/// Adds missing keys.
pub(super) fn fill<'a>(hand: &mut DeTable<'a>, made: Value<'a>) -> bool {
    let DeValue::Table(made) = made.into_inner() else { return false };
    for (key, value) in made {
        if !hand.contains_key(&**key.get_ref()) {
            hand.insert(key, value);
        }
    }
    true
}

/// Returns whether an entry written by hand is complete: it has its `type`, or the first key of one of its kinds.
fn is_complete(shape: Shape, hand: &DeTable<'_>) -> bool {
    let leads = match shape {
        Shape::Kinds(kinds) if !kinds.typed => (kinds.tables)().iter().map(|t| t.keys[0].key).collect(),
        _ => vec!["type"],
    };
    leads.iter().any(|key| hand.contains_key(*key))
}

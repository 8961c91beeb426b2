//! Numbers in the text of a model: their places, and how they are written.

use toml_edit::{DocumentMut, Item, TableLike, Value};

/// Tolerance of written numbers in units of round-off, which covers the sums, products and roots between a number of
/// the file and of the changed design: 5.200000000000001 is written as 5.2.
pub(super) const ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// A step of a path to a value: a key of a table, or an index of a list.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step<'s> {
    Key(&'s str),
    At(usize),
}

use Step::{At, Key};

/// Value at a path.
pub(super) fn value_at<'d>(document: &'d mut DocumentMut, way: &[Step<'_>]) -> Option<&'d mut Value> {
    below(document.as_item_mut(), way)
}

fn below<'d>(item: &'d mut Item, way: &[Step<'_>]) -> Option<&'d mut Value> {
    match (item, way) {
        (Item::Value(value), way) => within(value, way),
        (Item::Table(table), [Key(key), rest @ ..]) => below(table.get_mut(key)?, rest),
        (Item::ArrayOfTables(list), [At(n), Key(key), rest @ ..]) => {
            below(list.get_mut(*n)?.get_mut(key)?, rest)
        }
        (Item::Table(_) | Item::ArrayOfTables(_) | Item::None, _) => None,
    }
}

fn within<'d>(value: &'d mut Value, way: &[Step<'_>]) -> Option<&'d mut Value> {
    match way {
        [] => Some(value),
        [Key(key), rest @ ..] => within(value.as_inline_table_mut()?.get_mut(key)?, rest),
        [At(n), rest @ ..] => within(value.as_array_mut()?.get_mut(*n)?, rest),
    }
}

/// Table at a path.
pub(super) fn table_at<'d>(document: &'d mut DocumentMut, way: &[Step<'_>]) -> Option<&'d mut dyn TableLike> {
    table_below(document.as_item_mut(), way)
}

fn table_below<'d>(item: &'d mut Item, way: &[Step<'_>]) -> Option<&'d mut dyn TableLike> {
    match (item, way) {
        (Item::Value(value), way) => Some(within(value, way)?.as_inline_table_mut()?),
        (Item::Table(table), []) => Some(table),
        (Item::Table(table), [Key(key), rest @ ..]) => table_below(table.get_mut(key)?, rest),
        (Item::ArrayOfTables(list), [At(n)]) => Some(list.get_mut(*n)?),
        (Item::ArrayOfTables(list), [At(n), Key(key), rest @ ..]) => {
            table_below(list.get_mut(*n)?.get_mut(key)?, rest)
        }
        (Item::Table(_) | Item::ArrayOfTables(_) | Item::None, _) => None,
    }
}

/// Adds a value as the last of a table.
pub(super) fn add(table: &mut dyn TableLike, key: &str, value: Value) {
    // `{ a = 1 }` ends in a space, which belongs before the brace.
    if let Some((_, Item::Value(last))) = table.iter_mut().last()
        && last.decor().suffix().and_then(|s| s.as_str()).is_some_and(|s| s.trim().is_empty())
    {
        last.decor_mut().set_suffix("");
    }
    drop(table.insert(key, Item::Value(value)));
}

/// Returns whether a number is written with a decimal point; `None` for other values.
pub(super) fn number_style(value: &Value) -> Option<bool> {
    match value {
        Value::Integer(_) => Some(false),
        Value::Float(f) => {
            Some(f.as_repr().and_then(|r| r.as_raw().as_str()).is_some_and(|t| t.contains('.')))
        }
        Value::String(_)
        | Value::Boolean(_)
        | Value::Datetime(_)
        | Value::Array(_)
        | Value::InlineTable(_) => None,
    }
}

/// Replaces a value and preserves the space and comments around it.
pub(super) fn replace(value: &mut Value, text: &str) {
    let decor = value.decor().clone();
    *value = text.parse().expect("a number or a list of numbers is TOML");
    *value.decor_mut() = decor;
}

/// Number with the fewest digits that is read as `target`, or within `near` of it; `exact` is the same in the unit of
/// the text.
pub(super) fn shortest(target: f64, near: f64, to_si: impl Fn(f64) -> f64, exact: f64) -> String {
    let tried = (0..17).map(|digits| format!("{exact:.digits$e}"));
    let found = tried
        .filter_map(|text| text.parse::<f64>().ok())
        .find(|x| (to_si(*x) - target).abs() <= near)
        .unwrap_or(exact);
    // No -0 in a file.
    format!("{}", if found == 0.0 { 0.0 } else { found })
}

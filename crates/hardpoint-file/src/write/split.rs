//! Design variables of one entry, `along = "xyz"`, written as an entry for each.

use toml_edit::{Decor, DocumentMut, InlineTable, Item, Key, Table, TableLike, Value};

/// Splits the entry of `[design]` that moves a point along several axes into one for each of `axes`, with all its
/// other keys: `B` becomes `B_x`, `B_y` and `B_z`, the names of its variables. Order, layout and comments stay.
/// Returns false, and changes nothing, if there is no such entry.
///
/// ```text
/// B = { move = "B", along = "xy", bounds = [-5, 5] }     # before
///
/// B_x = { move = "B", along = "x", bounds = [-5, 5] }    # after
/// B_y = { move = "B", along = "y", bounds = [-5, 5] }
/// ```
pub(super) fn split(document: &mut DocumentMut, entry: &str, axes: &[&str]) -> bool {
    let Some(design) = document.get_mut("design") else { return false };
    let along = design.get(entry).and_then(|item| item.get("along"));
    if !along.is_some_and(|along| along.is_str()) || axes.is_empty() {
        return false;
    }
    match design {
        Item::Table(table) => split_lines(table, entry, axes),
        Item::Value(Value::InlineTable(table)) => split_inline(table, entry, axes),
        Item::Value(_) | Item::ArrayOfTables(_) | Item::None => return false,
    }
    true
}

fn split_lines(table: &mut Table, entry: &str, axes: &[&str]) {
    let names: Vec<String> = table.iter().map(|(name, _)| name.to_owned()).collect();
    for (key, item) in names.iter().filter_map(|name| table.remove_entry(name)).collect::<Vec<_>>() {
        if key.get() != entry {
            table.insert_formatted(&key, item);
            continue;
        }
        for (k, axis) in axes.iter().enumerate() {
            let mut key = named(&key, axis);
            let mut item = item.clone();
            if k > 0 {
                // Comments stay with the first.
                without_comment(key.leaf_decor_mut());
                remove_comments(&mut item);
            }
            if let Some(one) = item.as_table_like_mut() {
                turn(one, axis);
            }
            table.insert_formatted(&key, item);
        }
    }
}

fn split_inline(table: &mut InlineTable, entry: &str, axes: &[&str]) {
    let names: Vec<String> = table.iter().map(|(name, _)| name.to_owned()).collect();
    for (key, value) in names.iter().filter_map(|name| table.remove_entry(name)).collect::<Vec<_>>() {
        if key.get() != entry {
            table.insert_formatted(&key, value);
            continue;
        }
        for (k, axis) in axes.iter().enumerate() {
            let mut value = value.clone();
            // `{ a = 1 }` ends in a space, which belongs before the brace.
            if k + 1 < axes.len() {
                value.decor_mut().set_suffix("");
            }
            if let Some(one) = value.as_inline_table_mut() {
                turn(one, axis);
            }
            table.insert_formatted(&named(&key, axis), value);
        }
    }
}

/// Key of the variable along an axis.
fn named(key: &Key, axis: &str) -> Key {
    Key::new(format!("{}_{axis}", key.get()))
        .with_leaf_decor(key.leaf_decor().clone())
        .with_dotted_decor(key.dotted_decor().clone())
}

/// Sets the direction of a variable.
fn turn(variable: &mut dyn TableLike, axis: &str) {
    if let Some(along) = variable.get_mut("along").and_then(Item::as_value_mut) {
        let decor = along.decor().clone();
        *along = axis.into();
        *along.decor_mut() = decor;
    }
}

/// Removes comments around the keys and values of lines.
fn remove_comments(item: &mut Item) {
    match item {
        Item::Table(table) => {
            if table.decor().prefix().is_some() {
                table.decor_mut().set_prefix("\n");
            }
            table.decor_mut().set_suffix("");
            for (mut key, inner) in table.iter_mut() {
                without_comment(key.leaf_decor_mut());
                remove_comments(inner);
            }
        }
        Item::Value(value) => value.decor_mut().set_suffix(""),
        Item::ArrayOfTables(_) | Item::None => {}
    }
}

/// Removes comments and empty lines before a key.
fn without_comment(decor: &mut Decor) {
    let before = decor.prefix().and_then(|text| text.as_str()).unwrap_or_default();
    let indent = before.rsplit('\n').next().unwrap_or_default().to_owned();
    decor.set_prefix(indent);
}

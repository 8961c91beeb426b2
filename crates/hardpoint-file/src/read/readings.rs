//! Measurements of a mechanism: a CSV file of readings in postures of the drivers.

use std::path::Path;

use crate::values::{DataError, shown};
use hardpoint_table::csv::original;

use super::data::{delimiter, no_csv, number, records_of, text_at, unquoted};
use super::sweep::bare;

/// Maximum number of rows: each is a posture that is solved separately.
const MOST_ROWS: usize = 100_000;

/// Column names and their units from the first line, and the numbers below; empty cells are `None`.
pub(crate) struct Readings {
    pub names: Vec<(String, Option<String>)>,
    /// With the line of each.
    pub rows: Vec<(u64, Vec<Option<f64>>)>,
}

/// Reads the table of a file in any folder.
pub(crate) fn readings_at(path: &Path) -> Result<Readings, DataError> {
    let (name, text) = text_at(path, "drivers and measured outputs")?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let name = shown(&name);
    let mut reader = records_of(text);
    let no_csv = |e: csv::Error| no_csv(&name, &e);
    let mut record = csv::StringRecord::new();
    let write = "write names on the first line, like `crank, slider.x, sigma slider.x`, and numbers on each line below";
    if !reader.read_record(&mut record).map_err(no_csv)? {
        return Err(DataError::content(format!("`{name}` is empty"), write));
    }
    let mut names: Vec<(String, Option<String>)> =
        record.iter().map(|field| named(original(unquoted(field)))).collect();
    if names.iter().all(|(n, _)| n.parse::<f64>().is_ok()) {
        let line = record.position().map_or(1, csv::Position::line);
        if let Some(above) = headed(text, names.len()) {
            let message = format!(
                "`{name}`, line {above} begins with `#`: the names of the columns are a comment there"
            );
            let help = "remove that `#`; to leave the first column out, put quotes round its name, like `\"#crank\"`";
            return Err(DataError::content(message, help));
        }
        let message = format!("`{name}`, line {line}: there are numbers in place of names");
        return Err(DataError::content(message, write));
    }
    let mut rows = Vec::new();
    let mut is_first = true;
    while reader.read_record(&mut record).map_err(no_csv)? {
        let line = record.position().map_or(0, csv::Position::line);
        if record.len() != names.len() {
            let cells = if record.len() == 1 { "cell" } else { "cells" };
            let message =
                format!("`{name}`, line {line} has {} {cells} for {} columns", record.len(), names.len());
            let help = "give one cell for each name of the first line; that of a missing reading is empty";
            return Err(DataError::content(message, help));
        }
        // Units may be on a line of their own, below the names.
        if std::mem::take(&mut is_first) && is_units(&record) {
            for (cell, (title, unit)) in record.iter().zip(&mut names) {
                let below = unquoted(cell).trim_matches(['[', ']', '(', ')', ' ']);
                let below = Some(below).filter(|u| u.chars().any(char::is_alphanumeric)).map(str::to_owned);
                if let (Some(own), Some(below)) = (&unit, &below)
                    && own != below
                {
                    let message = format!(
                        "`{name}`, line {line}: `{}` is in `{}` here, and in `{}` above",
                        shown(title),
                        shown(below),
                        shown(own)
                    );
                    return Err(DataError::content(message, "give one unit to each column"));
                }
                *unit = below.or_else(|| unit.take());
            }
            continue;
        }
        let cell = |(k, (title, _)): (usize, &(String, Option<String>))| {
            let text = record.get(k).map(unquoted).filter(|text| !text.is_empty());
            let here = format!("`{name}`, line {line}, column {} (`{}`)", k + 1, shown(title));
            text.map(|text| number(Some(text), &here, "")).transpose()
        };
        rows.push((line, names.iter().enumerate().map(cell).collect::<Result<_, _>>()?));
        if rows.len() > MOST_ROWS {
            let message = format!("`{name}` has more than {MOST_ROWS} rows");
            return Err(DataError::content(message, "keep those that were measured in different postures"));
        }
    }
    if rows.is_empty() {
        return Err(DataError::content(format!("`{name}` has no readings"), write));
    }
    Ok(Readings { names, rows })
}

/// Comment line (`#`) above the first row with the same number of cells: it is a header.
fn headed(text: &str, columns: usize) -> Option<usize> {
    let delimiter = char::from(delimiter(text));
    let above = text.lines().enumerate().take_while(|(_, l)| l.trim().is_empty() || l.starts_with('#'));
    let heads = |line: &str| line.starts_with('#') && line.split(delimiter).count() == columns;
    above.filter(|(_, l)| heads(l)).last().map(|(k, _)| k + 1)
}

/// Returns whether a line has at least one word and no number.
fn is_units(record: &csv::StringRecord) -> bool {
    let mut cells = record.iter().map(unquoted);
    cells.clone().any(|cell| cell.chars().any(char::is_alphabetic))
        && cells.all(|cell| cell.parse::<f64>().is_err() && !cell.starts_with(|c: char| c.is_ascii_digit()))
}

/// Splits a column title into name and unit: `toe [deg]`.
fn named(title: &str) -> (String, Option<String>) {
    let name = bare(title);
    let unit = title[name.len()..].trim().strip_prefix('[').and_then(|u| u.strip_suffix(']'));
    (name.to_owned(), unit.map(str::to_owned))
}

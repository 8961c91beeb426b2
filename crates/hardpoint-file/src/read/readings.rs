//! Measurements of a mechanism: a CSV file of readings in postures of the drivers.

use std::path::Path;

use crate::values::{DataError, shown};

use super::data::{Title, delimiter, no_csv, number, records_of, text_at, unit_in, unquoted};

/// Maximum number of rows: each is a posture that is solved separately.
const MOST_ROWS: usize = 100_000;

/// Titles of columns from the first line, and the numbers below; empty cells, and those of columns that are left out,
/// are `None`.
pub(crate) struct Readings {
    pub titles: Vec<Title>,
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
    let mut titles: Vec<Title> = record.iter().map(Title::of).collect();
    if titles.iter().all(|title| title.name.parse::<f64>().is_ok()) {
        let line = record.position().map_or(1, csv::Position::line);
        if let Some(above) = headed(text, titles.len()) {
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
        if record.len() != titles.len() {
            let cells = if record.len() == 1 { "cell" } else { "cells" };
            let message =
                format!("`{name}`, line {line} has {} {cells} for {} columns", record.len(), titles.len());
            let help = "give one cell for each name of the first line; that of a missing reading is empty";
            return Err(DataError::content(message, help));
        }
        // Units may be on a line of their own, below the names.
        if std::mem::take(&mut is_first) && is_units(&record, &titles) {
            for (cell, Title { name: title, unit }) in record.iter().zip(&mut titles) {
                let below = unit_in(unquoted(cell).trim_matches(['[', ']', '(', ')', ' ']));
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
        let cell = |(k, title): (usize, &Title)| {
            let text = record.get(k).map(unquoted).filter(|text| !text.is_empty() && !is_left_out(title));
            let here = format!("`{name}`, line {line}, column {} (`{}`)", k + 1, shown(&title.name));
            text.map(|text| number(Some(text), &here, "")).transpose()
        };
        rows.push((line, titles.iter().enumerate().map(cell).collect::<Result<_, _>>()?));
        if rows.len() > MOST_ROWS {
            let message = format!("`{name}` has more than {MOST_ROWS} rows");
            return Err(DataError::content(message, "keep those that were measured in different postures"));
        }
    }
    if rows.is_empty() {
        return Err(DataError::content(format!("`{name}` has no readings"), write));
    }
    Ok(Readings { titles, rows })
}

/// Comment line (`#`) above the first row with the same number of cells: it is a header.
fn headed(text: &str, columns: usize) -> Option<usize> {
    let delimiter = char::from(delimiter(text));
    let above = text.lines().enumerate().take_while(|(_, l)| l.trim().is_empty() || l.starts_with('#'));
    let heads = |line: &str| line.starts_with('#') && line.split(delimiter).count() == columns;
    above.filter(|(_, l)| heads(l)).last().map(|(k, _)| k + 1)
}

/// True if the name of a column begins with `#`: it may hold anything, and is ignored.
pub(super) fn is_left_out(title: &Title) -> bool {
    title.name.starts_with('#')
}

/// Returns whether a line has at least one word and no number.
fn is_units(record: &csv::StringRecord, titles: &[Title]) -> bool {
    let read = record.iter().zip(titles).filter(|(_, title)| !is_left_out(title));
    let mut cells = read.map(|(cell, _)| unquoted(cell));
    cells.clone().any(|cell| cell.chars().any(char::is_alphabetic))
        && cells.all(|cell| cell.parse::<f64>().is_err() && !cell.starts_with(|c: char| c.is_ascii_digit()))
}

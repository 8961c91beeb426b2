//! Facts of studies, each declared once: key, meaning, type and value in a record, and lists of columns for the tables
//! that show them.
//!
//! A record serialises as a JSON object with these keys; Python and the page read the same. [`Table::of`] makes a table
//! for the text and the page of such columns, [`write_rows`] a CSV file.

use std::io::Write;

use hardpoint_table::csv::CsvWriter;

use crate::page::Table;

/// Declares a record: a public struct that serialises with its fields as keys, and the function that makes it of parts
/// of the result.
///
/// ```text
/// record! {
///     /// Toleranced variable.
///     ToleratedFact::of(studied: &ToleranceInputs<'_>, k: usize) {
///         let variable = &studied.model().variables[k];     // for the values below
///     }
///     /// Standard deviation of the deviation.
///     sigma: f64 = shown(of.sigma);
/// }
/// ```
macro_rules! record {
    (
        $(#[$about:meta])*
        $visible:vis $name:ident::$make:ident($($part:ident: $of:ty),* $(,)?) { $($local:tt)* }
        $($(#[$meaning:meta])* $key:ident: $type:ty = $value:expr;)*
    ) => {
        $(#[$about])*
        #[derive(Clone, Debug, serde::Serialize)]
        pub struct $name {
            $($(#[$meaning])* pub $key: $type,)*
        }

        impl $name {
            /// Makes it of parts of the result.
            $visible fn $make($($part: $of),*) -> Self {
                $($local)*
                Self { $($key: $value),* }
            }
        }
    };
}
pub(crate) use record;

/// A column of a table: its heading, and the cell of a row.
pub type Column<'c, R> = (&'c str, &'c dyn Fn(&R) -> String);

impl Table {
    /// Table of rows by its columns.
    pub fn of<R>(
        title: impl Into<String>,
        note: impl Into<String>,
        columns: &[Column<'_, R>],
        rows: impl IntoIterator<Item = R>,
    ) -> Self {
        let cells = |row: R| columns.iter().map(|(_, cell)| cell(&row)).collect();
        Self {
            title: title.into(),
            note: note.into(),
            header: columns.iter().map(|(heading, _)| (*heading).to_owned()).collect(),
            rows: rows.into_iter().map(cells).collect(),
        }
    }

    /// Table of labelled lines.
    pub fn of_lines(title: &str, lines: Vec<(&'static str, String)>) -> Self {
        Self::of(title, "", &[("", &|l: &(&str, String)| l.0.to_owned()), ("is", &|l| l.1.clone())], lines)
    }

    /// The table, unless it has no rows.
    pub fn if_any(self) -> Option<Self> {
        Some(self).filter(|table| !table.rows.is_empty())
    }
}

/// Writes a CSV table of rows by its columns.
///
/// # Errors
/// If `out` cannot be written.
pub fn write_rows<R>(
    out: impl Write,
    columns: &[Column<'_, R>],
    rows: impl IntoIterator<Item = R>,
) -> csv::Result<()> {
    let mut csv = CsvWriter::new(out);
    csv.row(columns.iter().map(|(title, _)| *title))?;
    for row in rows {
        csv.row(columns.iter().map(|(_, cell)| cell(&row)))?;
    }
    csv.end()?;
    Ok(())
}

/// Writes a CSV table of curves by time: a row for each output time.
///
/// # Errors
/// If `out` cannot be written.
pub fn write_curves(out: impl Write, times: &[f64], curves: &[(String, &[f64])]) -> csv::Result<()> {
    let mut csv = CsvWriter::new(out);
    csv.row(std::iter::once("t [s]").chain(curves.iter().map(|(title, _)| title.as_str())))?;
    for (k, t) in times.iter().enumerate() {
        csv.numbers(std::iter::once(*t).chain(curves.iter().map(|(_, curve)| curve[k])))?;
        csv.end_row()?;
    }
    csv.end()?;
    Ok(())
}

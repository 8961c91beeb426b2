//! CSV tables whose cells spreadsheets never read as formulas: one writer for every file, and its inverse for every
//! reader.

use std::borrow::Cow;
use std::io::{self, Write};

/// Characters with which a formula begins in the common spreadsheet programs.
const FORMULA: [char; 6] = ['=', '+', '-', '@', '\t', '\r'];

/// Returns the cell that represents a text in a table: a text that begins like a formula gets an apostrophe before it,
/// which spreadsheets do not show. A number is itself, whatever its sign.
pub fn neutral(text: &str) -> Cow<'_, str> {
    if text.starts_with(FORMULA) && text.parse::<f64>().is_err() {
        format!("'{text}").into()
    } else {
        text.into()
    }
}

/// Returns the text that a cell represents: the inverse of [`neutral`].
pub fn original(cell: &str) -> &str {
    cell.strip_prefix('\'').filter(|text| text.starts_with(FORMULA)).unwrap_or(cell)
}

/// Writes the rows of a CSV table, header first.
pub struct CsvWriter<W: Write>(::csv::Writer<W>);

impl<W: Write> CsvWriter<W> {
    /// A writer of rows of any length.
    pub fn new(out: W) -> Self {
        Self(::csv::WriterBuilder::new().has_headers(false).flexible(true).from_writer(out))
    }

    /// Writes a row of texts and numbers, each cell [`neutral`].
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub fn row<C: AsRef<str>>(&mut self, cells: impl IntoIterator<Item = C>) -> ::csv::Result<()> {
        for cell in cells {
            self.text(cell.as_ref())?;
        }
        self.end_row()
    }

    /// Writes a text as the next cell of the row, [`neutral`].
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub fn text(&mut self, text: &str) -> ::csv::Result<()> {
        self.0.write_field(neutral(text).as_bytes())
    }

    /// Writes numbers as the next cells of the row: the shortest decimals that read back as the same double. A cell is
    /// empty where there is no number, as for the curvature of a path at rest.
    ///
    /// # Errors
    /// Fails if they cannot be written.
    pub fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) -> ::csv::Result<()> {
        let mut digits = zmij::Buffer::new();
        for x in numbers {
            self.0.write_field(if x.is_finite() { digits.format_finite(x) } else { "" })?;
        }
        Ok(())
    }

    /// Ends the row.
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub fn end_row(&mut self) -> ::csv::Result<()> {
        self.0.write_record(None::<&[u8]>)
    }

    /// Writes a row of another table unchanged.
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub fn copy(&mut self, row: &::csv::ByteRecord) -> ::csv::Result<()> {
        self.0.write_byte_record(row)
    }

    /// Returns the writer.
    ///
    /// # Errors
    /// Fails if the rest cannot be written.
    pub fn end(self) -> io::Result<W> {
        self.0.into_inner().map_err(|e| e.into_error())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_that_begin_like_a_formula_are_marked_and_read_back() {
        for text in ["=1+1", "+x", "-x", "@x", "\tx", "\rx", "-1+1", "="] {
            assert_eq!(neutral(text), format!("'{text}"));
            assert_eq!(original(&neutral(text)), text);
        }
        for text in ["x", "'x", "", "a=b", " =1", "-1.5", "+3e-4", "'"] {
            assert_eq!(neutral(text), text);
            assert_eq!(original(&neutral(text)), text);
        }
    }

    #[test]
    fn numbers_are_the_shortest_that_read_back_and_no_number_is_an_empty_cell() {
        let mut table = CsvWriter::new(Vec::new());
        table.text("-x").unwrap();
        table.numbers([1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.1, 1e-7, 2.5e20]).unwrap();
        table.end_row().unwrap();
        assert_eq!(String::from_utf8(table.end().unwrap()).unwrap(), "'-x,1.0,,,,-0.1,1e-7,2.5e+20\n");
    }

    #[test]
    fn a_row_quotes_what_it_must() {
        let mut table = CsvWriter::new(Vec::new());
        table.row(["name", "=a,b"]).unwrap();
        table.row([String::from("say \"so\""), (-0.5).to_string()]).unwrap();
        assert_eq!(table.end().unwrap(), b"name,\"'=a,b\"\n\"say \"\"so\"\"\",-0.5\n");
    }
}

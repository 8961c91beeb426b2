//! `motion.csv`, `sensitivity.csv` and `jerk.csv`: results in the user's units with full precision.
//!
//! Numbers are the shortest decimals that read back as the same double; a missing number is an empty field. The header
//! contains the unit of a column. In `sensitivity.csv` it is the unit of the numerator; column `per` contains the unit
//! of the denominator. See `docs/results.md` for all columns.

use std::borrow::Cow;
use std::io::{self, Read, Seek, SeekFrom, Write};

use ::csv::{ByteRecord, Reader};
use hardpoint::Solution;
use hardpoint::run::Jerks;

use crate::columns::{Column, Columns};
use crate::csv::{CsvWriter, neutral};
use crate::figures::variable_unit;

/// Writer of `motion.csv`, window by window.
pub struct MotionCsv<'m, W: Write> {
    columns: Columns<'m>,
    writer: CsvWriter<W>,
    row: Vec<f64>,
}

impl<'m, W: Write> MotionCsv<'m, W> {
    /// Starts the file with its header: time, state of every body except ground, then value, rate and acceleration of
    /// every output.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn new(columns: Columns<'m>, out: W) -> ::csv::Result<Self> {
        let writer = with_header(&["t [s]"], &columns.of_motion(), out)?;
        Ok(Self { columns, writer, row: Vec::new() })
    }

    /// Writes the rows of a window.
    ///
    /// # Errors
    /// If the rows cannot be written.
    pub fn add(&mut self, window: &Solution) -> ::csv::Result<()> {
        for (k, &t) in window.motion.times.iter().enumerate() {
            self.row.clear();
            self.row.push(t);
            self.columns.motion(window, k, &mut self.row);
            self.writer.numbers(self.row.iter().copied())?;
            self.writer.end_row()?;
        }
        Ok(())
    }

    /// Finishes the file and returns the underlying writer.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn end(self) -> io::Result<W> {
        self.writer.end()
    }
}

/// Writer of `sensitivity.csv`, window by window.
pub struct SensitivityCsv<'m, W: Write> {
    columns: Columns<'m>,
    /// Units of the variables.
    units: Vec<String>,
    writer: CsvWriter<W>,
    row: Vec<f64>,
}

impl<'m, W: Write> SensitivityCsv<'m, W> {
    /// Starts the file with its header. There is one row per output time and variable: derivatives of the columns of
    /// `motion.csv` by that variable, orientation as a rotation vector `pi`.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn new(columns: Columns<'m>, out: W) -> ::csv::Result<Self> {
        let writer = with_header(&["t [s]", "variable", "per"], &columns.of_sensitivities(), out)?;
        let variables = columns.model.variables.iter();
        let units = variables.map(|v| variable_unit(columns.model, columns.units, v)).collect();
        Ok(Self { columns, units, writer, row: Vec::new() })
    }

    /// Writes the rows of a window for the variables that have sensitivities.
    ///
    /// # Errors
    /// If the rows cannot be written.
    pub fn add(&mut self, window: &Solution) -> ::csv::Result<()> {
        for (k, &t) in window.motion.times.iter().enumerate() {
            for (b, variable) in self.columns.model.variables.iter().enumerate() {
                self.row.clear();
                if self.columns.sensitivities(window, k, b, &mut self.row).is_some() {
                    self.writer.numbers([t])?;
                    self.writer.text(&variable.name)?;
                    self.writer.text(&self.units[b])?;
                    self.writer.numbers(self.row.iter().copied())?;
                    self.writer.end_row()?;
                }
            }
        }
        Ok(())
    }

    /// Finishes the file and returns the underlying writer.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn end(self) -> io::Result<W> {
        self.writer.end()
    }
}

/// Copies a `sensitivity.csv` without the rows of variables that turned out later not to be followed by the mechanism.
/// These rows are among the first `rows`. Returns false if `more` ended the copy.
///
/// # Errors
/// If a file cannot be read or written.
pub fn without_variables(
    mut file: impl Read + Seek,
    names: &[&str],
    rows: u64,
    out: &mut impl Write,
    mut go_on: impl FnMut() -> bool,
) -> ::csv::Result<bool> {
    /// Number of rows, and number of bytes, between two calls of `more`.
    const ROWS: u64 = 1 << 16;
    const BYTES: u64 = 1 << 24;
    let mut reader = Reader::from_reader(&mut file);
    let mut writer = CsvWriter::new(&mut *out);
    writer.copy(reader.byte_headers()?)?;
    let names: Vec<_> = names.iter().map(|name| neutral(name)).collect();
    let mut record = ByteRecord::new();
    for row in 0..rows {
        if row % ROWS == 0 && !go_on() {
            return Ok(false);
        }
        reader.read_byte_record(&mut record)?;
        if !names.iter().any(|name| record.get(1) == Some(name.as_bytes())) {
            writer.copy(&record)?;
        }
    }
    writer.end()?;
    let rest = reader.position().byte();
    file.seek(SeekFrom::Start(rest))?;
    while go_on() {
        if io::copy(&mut (&mut file).take(BYTES), out)? == 0 {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Writer of `jerk.csv`, window by window.
pub struct JerkCsv<'m, W: Write> {
    columns: Columns<'m>,
    writer: CsvWriter<W>,
    row: Vec<f64>,
}

impl<'m, W: Write> JerkCsv<'m, W> {
    /// Starts the file with its header: time, and the third time derivatives of position and orientation of every body
    /// except ground.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn new(columns: Columns<'m>, out: W) -> ::csv::Result<Self> {
        let writer = with_header(&["t [s]"], &columns.of_jerk(), out)?;
        Ok(Self { columns, writer, row: Vec::new() })
    }

    /// Writes some rows.
    ///
    /// # Errors
    /// If the rows cannot be written.
    pub fn add(&mut self, jerks: &Jerks) -> ::csv::Result<()> {
        for (k, &t) in jerks.times.iter().enumerate() {
            self.row.clear();
            self.row.push(t);
            self.columns.jerk(jerks, k, &mut self.row);
            self.writer.numbers(self.row.iter().copied())?;
            self.writer.end_row()?;
        }
        Ok(())
    }

    /// Finishes the file and returns the underlying writer.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn end(self) -> io::Result<W> {
        self.writer.end()
    }
}

fn with_header<W: Write>(first: &[&str], columns: &[Column], out: W) -> ::csv::Result<CsvWriter<W>> {
    let mut writer = CsvWriter::new(out);
    let columns = columns.iter().map(|c| Cow::Owned(c.header()));
    writer.row(first.iter().copied().map(Cow::Borrowed).chain(columns))?;
    Ok(writer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_a_variable_are_taken_out() {
        let file = "t [s],variable,per,d x\n0,a,mm,1\n0,\"'=b,c\",mm,2\n1,a,mm,3\n1,\"'=b,c\",mm,4\n2,a,mm,5\n3,a,mm,6\n";
        // All rows after the removed ones stay unchanged.
        for rows in 4..=6 {
            let mut out = Vec::new();
            let whole = without_variables(io::Cursor::new(file), &["=b,c"], rows, &mut out, || true).unwrap();
            let left = String::from_utf8(out).unwrap();
            assert_eq!(left, "t [s],variable,per,d x\n0,a,mm,1\n1,a,mm,3\n2,a,mm,5\n3,a,mm,6\n");
            assert!(whole);
        }
        // The copy can be ended in either part.
        for patience in 0..3 {
            let (mut asked, mut out) = (0, Vec::new());
            let go_on = || {
                asked += 1;
                asked <= patience
            };
            assert!(!without_variables(io::Cursor::new(file), &["=b,c"], 4, &mut out, go_on).unwrap());
        }
    }
}

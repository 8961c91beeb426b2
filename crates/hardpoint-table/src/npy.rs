//! `motion.npy` and `sensitivity.npy`: NumPy arrays of doubles, half as large as CSV and much faster to read.
//!
//! `columns.json` next to them describes the columns. Missing numbers are NaN.

use std::io::{self, Seek, SeekFrom, Write};

use hardpoint::Solution;
use serde::Serialize;

use crate::columns::{Column, Columns};
use crate::figures::variable_unit;

/// Size of the header in bytes: enough for any shape.
const HEADER: usize = 256;

/// Array file that grows by rows.
pub struct Npy<W: Write + Seek> {
    out: W,
    rows: usize,
    /// Shape of a row.
    shape: Vec<usize>,
}

impl<W: Write + Seek> Npy<W> {
    /// Starts an array of rows of a shape.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn new(shape: &[usize], mut out: W) -> io::Result<Self> {
        out.write_all(&header(0, shape))?;
        Ok(Self { out, rows: 0, shape: shape.to_vec() })
    }

    /// Appends a row.
    ///
    /// # Errors
    /// If the row cannot be written.
    ///
    /// # Panics
    /// If the row does not have this array's shape.
    pub fn row(&mut self, numbers: &[f64]) -> io::Result<()> {
        assert_eq!(numbers.len(), self.shape.iter().product::<usize>(), "a row of this array");
        numbers.iter().try_for_each(|x| {
            let x = if x.is_finite() { *x } else { f64::NAN };
            self.out.write_all(&x.to_le_bytes())
        })?;
        self.rows += 1;
        Ok(())
    }

    /// Overwrites `count` numbers from `first` on by NaN in each of the first `rows`.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn forget(&mut self, rows: usize, first: usize, count: usize) -> io::Result<()> {
        let row: usize = self.shape.iter().product();
        let none: Vec<u8> = std::iter::repeat_n(f64::NAN.to_le_bytes(), count).flatten().collect();
        for k in 0..rows.min(self.rows) {
            self.out.seek(SeekFrom::Start((HEADER + 8 * (k * row + first)) as u64))?;
            self.out.write_all(&none)?;
        }
        Ok(())
    }

    /// Writes the number of rows and returns the underlying writer.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn end(mut self) -> io::Result<W> {
        self.out.seek(SeekFrom::Start(0))?;
        self.out.write_all(&header(self.rows, &self.shape))?;
        self.out.flush()?;
        Ok(self.out)
    }
}

/// Format version 1.0: magic, version, length of the text, text padded with blanks up to a newline.
fn header(rows: usize, shape: &[usize]) -> Vec<u8> {
    let shape: Vec<String> = std::iter::once(&rows).chain(shape).map(usize::to_string).collect();
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}), }}", shape.join(", "));
    let before = b"\x93NUMPY\x01\x00";
    let length = HEADER - before.len() - 2;
    let mut bytes = before.to_vec();
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(format!("{text:<width$}\n", width = length - 1).into_bytes());
    bytes
}

/// `columns.json`: description of the arrays.
#[derive(Clone, Debug, Serialize)]
pub struct Sidecar {
    /// Program and version.
    pub generator: &'static str,
    /// Columns of `motion.npy`, of shape `[output time, column]`; the first column is time.
    pub motion: Vec<Column>,
    /// Description of `sensitivity.npy`, if it was written.
    pub sensitivity: Option<SensitivitySidecar>,
}

/// Description of `sensitivity.npy`, of shape `[output time, variable, column]`, with the output times of `motion.npy`.
#[derive(Clone, Debug, Serialize)]
pub struct SensitivitySidecar {
    /// Variables with their units; values are NaN if the mechanism cannot follow the variable.
    pub variables: Vec<Column>,
    /// Columns with the units of their numerators.
    pub columns: Vec<Column>,
}

impl Sidecar {
    /// Description of the columns.
    pub fn new(motion: &Columns<'_>, sensitivities: Option<&Columns<'_>>) -> Self {
        let time = Column { name: "t".into(), unit: "s".into() };
        let sensitivity = |c: &Columns<'_>| {
            let variable = |v: &hardpoint::model::DesignVariable| Column {
                name: v.name.clone(),
                unit: variable_unit(c.model, c.units, v),
            };
            let variables = c.model.variables.iter().map(variable).collect();
            SensitivitySidecar { variables, columns: c.of_sensitivities() }
        };
        Self {
            generator: crate::GENERATOR,
            motion: std::iter::once(time).chain(motion.of_motion()).collect(),
            sensitivity: sensitivities.map(sensitivity),
        }
    }
}

/// Writes the motion of a window.
///
/// # Errors
/// If it cannot be written.
pub fn add_motion<W: Write + Seek>(
    npy: &mut Npy<W>,
    columns: &Columns<'_>,
    window: &Solution,
) -> io::Result<()> {
    let mut row = Vec::new();
    for (k, &t) in window.motion.times.iter().enumerate() {
        row.clear();
        row.push(t);
        columns.motion(window, k, &mut row);
        npy.row(&row)?;
    }
    Ok(())
}

/// Writes the sensitivities of a window; NaN for variables without any.
///
/// # Errors
/// If they cannot be written.
pub fn add_sensitivities<W: Write + Seek>(
    npy: &mut Npy<W>,
    columns: &Columns<'_>,
    window: &Solution,
) -> io::Result<()> {
    let width = npy.shape[1];
    let mut row = Vec::new();
    for k in 0..window.motion.len() {
        row.clear();
        for b in 0..columns.model.variables.len() {
            if columns.sensitivities(window, k, b, &mut row).is_none() {
                row.resize((b + 1) * width, f64::NAN);
            }
        }
        npy.row(&row)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    #[test]
    fn an_array_follows_the_format() {
        let mut npy = Npy::new(&[2, 2], Cursor::new(Vec::new())).unwrap();
        npy.row(&[1.0, 2.0, 3.0, 4.0]).unwrap();
        npy.row(&[5.0, f64::INFINITY, 7.0, 8.0]).unwrap();
        npy.forget(2, 2, 2).unwrap();
        let bytes = npy.end().unwrap().into_inner();
        assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
        let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
        assert_eq!((10 + length) % 64, 0, "numbers are aligned");
        let text = std::str::from_utf8(&bytes[10..10 + length]).unwrap();
        assert_eq!(text.trim_end(), "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 2, 2), }");
        assert!(text.ends_with('\n'));
        let numbers: Vec<f64> =
            bytes[10 + length..].chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
        let shown: Vec<String> = numbers.iter().map(f64::to_string).collect();
        assert_eq!(shown, ["1", "2", "NaN", "NaN", "5", "NaN", "NaN", "NaN"]);
    }
}

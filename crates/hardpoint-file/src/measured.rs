//! Measurements of a model: names of a table found among drivers and outputs, values in SI.

use std::path::Path;

use hardpoint::draft::some_of;
use hardpoint::measure::outputs;
use hardpoint::model::{Dimension, DriverId};
use hardpoint::study::{Measurements, Reading};

use crate::diagnostic::{Diagnostic, Diagnostics, Severity, Source, closest, shown};
use crate::read::measured::{Readings, readings_at};
use crate::{ModelFile, Units};

/// What a measured file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Postures and readings, in SI.
    pub measurements: Measurements,
    /// The line of the file that each posture is on.
    pub lines: Vec<u64>,
    /// Drivers that the file does not name, which stand as drawn.
    pub as_drawn: Vec<DriverId>,
}

/// What a column holds.
#[derive(Clone, Copy)]
enum Holds {
    Driver(usize),
    Output(usize),
    Sigma(usize),
    Nothing,
}

impl ModelFile {
    /// What was measured, from a CSV file wherever it lies: its first line names drivers, outputs (measures, and points as `P.x`) and
    /// standard deviations (`sigma toe`); each line below is a posture, in the units of the model file. `sigmas` are those of outputs whose
    /// cells have none, in their units. Empty cells were not measured.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn measured(&self, path: &Path, sigmas: &[(String, f64)]) -> Result<Measured, Diagnostics> {
        let name = path.display().to_string();
        let source = Source::new(&name, "");
        let of = |d: Refusal| {
            let mut found = source.diagnostic(Severity::Error, d.code, d.message, None);
            found = d.notes.into_iter().fold(found, Diagnostic::note);
            Diagnostics::new(source.clone(), vec![d.help.into_iter().fold(found, Diagnostic::help)])
        };
        let table = readings_at(path).map_err(|e| {
            of(Refusal { code: e.code, message: e.message, notes: e.notes, help: e.help })
        })?;
        self.read_off(&table, &shown(&name), sigmas).map_err(of)
    }

    fn read_off(&self, table: &Readings, file: &str, sigmas: &[(String, f64)]) -> Result<Measured, Refusal> {
        let outputs = outputs(&self.model);
        let holds = self.columns(table, file)?;
        let given = self.given(sigmas)?;
        let in_si = |m: usize, x: f64| x / self.units.from_si(outputs[m].dimension, 1.0);
        let mut found = Measured {
            measurements: Measurements::default(),
            lines: Vec::new(),
            as_drawn: (0..self.model.drivers.len())
                .filter(|d| !holds.iter().any(|h| matches!(h, Holds::Driver(k) if k == d)))
                .map(DriverId)
                .collect(),
        };
        for (line, cells) in &table.rows {
            let posture = found.lines.len();
            let mut stands: Vec<f64> =
                (0..self.model.drivers.len()).map(|d| self.model.as_drawn(DriverId(d))).collect();
            for (column, holds) in holds.iter().enumerate() {
                let here = || format!("`{file}`, line {line}, column {} (`{}`)", column + 1, shown(&table.names[column].0));
                match (*holds, cells[column]) {
                    (Holds::Driver(d), Some(x)) => {
                        let quantity = self.model.driven(&self.model.drivers[d]).quantity;
                        stands[d] = self.units.to_si(quantity, x);
                    }
                    (Holds::Driver(_), None) => {
                        return Err(Refusal::new("HP0112", format!("{} is missing", here()))
                            .help("say where every driver of the first line stood"));
                    }
                    (Holds::Output(m), Some(x)) => {
                        let own = holds_sigma(&holds_of(&holds_list(holds), m), m).map(|k| k);
                        let _ = own;
                        let sigma = self.sigma_of(&holds_list(holds), table, cells, m).or(given[m]);
                        found.measurements.readings.push(Reading {
                            posture,
                            output: m,
                            value: in_si(m, x),
                            sigma: sigma.map(|s| in_si(m, s)),
                        });
                    }
                    (Holds::Sigma(_), Some(x)) if !(x > 0.0 && x.is_finite()) => {
                        return Err(Refusal::new("HP0249", format!("{} cannot be {x}", here()))
                            .note("it is the standard deviation of a reading")
                            .help("give a number above zero, or leave the cell empty"));
                    }
                    _ => {}
                }
            }
            found.measurements.postures.push(stands);
            found.lines.push(*line);
        }
        Ok(found)
    }
}

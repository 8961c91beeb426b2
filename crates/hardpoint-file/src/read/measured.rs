//! Measurements of a model: columns of a table assigned to drivers and outputs, values in SI.

use std::path::Path;

use hardpoint::measure::{Output, outputs};
use hardpoint::model::{Dimension, DriverId, ElementId, Measurements, Reading};

use crate::values::{DataError, Diagnostics, Source, closest, shown};
use hardpoint_table::Units;
use hardpoint_table::figures::{unit as unit_of, with_unit};

use super::data::Title;
use super::model_file::ModelFile;
use super::readings::{Readings, is_left_out, readings_at};

/// Largest reading in standard deviations, or SI units without them: sums of squares remain numbers.
const MOST_SIGMAS: f64 = 1e100;

/// Contents of a measurement file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredData {
    /// Postures and readings, in SI.
    pub measurements: Measurements,
    /// Line of each posture in the file.
    pub lines: Vec<u64>,
    /// Drivers that the file does not name: they are in the design configuration.
    pub as_drawn: Vec<DriverId>,
}

/// Contents of a column.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Holds {
    /// Values of a driver.
    Driver(usize),
    /// Values of the law of a given force.
    Force(usize),
    /// Readings of an output.
    Output(usize),
    /// Standard deviations of an output's readings.
    Sigma(usize),
}

/// A column that is read: what it holds, and the units of its numbers.
#[derive(Clone, Copy)]
struct MeasuredColumn {
    holds: Holds,
    units: Units,
    /// Factor from the unit of the column to that of `units`; of a force to the value of its law.
    factor: f64,
}

impl MeasuredColumn {
    /// A number of the column in SI.
    fn in_si(self, of: Dimension, x: f64) -> f64 {
        self.factor * x / self.units.from_si(of, 1.0)
    }
}

/// Index of the column that holds something.
fn place_of(columns: &[Option<MeasuredColumn>], wanted: Holds) -> Option<usize> {
    columns.iter().position(|column| column.is_some_and(|column| column.holds == wanted))
}

impl ModelFile {
    /// Reads measurements from a CSV file at any place: the first line names drivers, given forces, outputs (measures,
    /// and points as `P.x`) and standard deviations (`sigma toe`); each line below is a posture, in the units of the
    /// model file.
    /// `sigmas` are those of outputs without a cell for it, in their units. Empty cells were not measured.
    ///
    /// # Errors
    /// Returns the errors of the file.
    pub fn measured(&self, path: &Path, sigmas: &[(String, f64)]) -> Result<MeasuredData, Diagnostics> {
        let name = path.display().to_string();
        let source = Source::new(&name, "");
        let rejected = |e: DataError| Diagnostics::new(source.clone(), vec![e.diagnostic(&source, None)]);
        let table = readings_at(path).map_err(rejected)?;
        self.measurements(&table, &shown(&name), sigmas).map_err(rejected)
    }

    fn measurements(
        &self,
        table: &Readings,
        file: &str,
        sigmas: &[(String, f64)],
    ) -> Result<MeasuredData, DataError> {
        let holds = self.columns(table, file)?;
        let given = self.sigmas_given(sigmas)?;
        let drivers = &self.model.drivers;
        let is_given = |d: &usize| place_of(&holds, Holds::Driver(*d)).is_some();
        let as_drawn = (0..drivers.len()).filter(|d| !is_given(d)).map(DriverId).collect();
        let mut found = MeasuredData { measurements: Measurements::default(), lines: Vec::new(), as_drawn };
        let drawn = (0..drivers.len()).map(|d| self.model.as_drawn(DriverId(d))).collect();
        let outputs = outputs(&self.model);
        let rows = MeasuredRows { of: self, table, file, holds, given, drawn, outputs };
        for (line, cells) in &table.rows {
            rows.add(*line, cells, &mut found)?;
        }
        if found.measurements.readings.is_empty() {
            let help = "write numbers below the names of measures and points";
            return Err(DataError::content(format!("`{file}` has no readings"), help));
        }
        self.can_be_compared(&found, file)?;
        Ok(found)
    }

    /// Contents of every column, and the units of its numbers; `None` for columns that are left out.
    fn columns(&self, table: &Readings, file: &str) -> Result<Vec<Option<MeasuredColumn>>, DataError> {
        let mut found = Vec::new();
        for (column, title) in table.titles.iter().enumerate() {
            let Title { name, .. } = title;
            let note = format!("it is the title of column {} of `{file}`", column + 1);
            if is_left_out(title) {
                found.push(None);
                continue;
            }
            let holds = self.held(name).map_err(|help| {
                let message = format!("`{}` is neither a driver, a force nor an output", shown(name));
                DataError::new("HP0248", message, help).note(note.clone())
            })?;
            let converted = match holds {
                Holds::Driver(d) => {
                    let of = self.model.driven(&self.model.drivers[d]).quantity.into();
                    title.conversion(self.units, of, "HP0248")
                }
                Holds::Force(e) => self.law_of(ElementId(e), title),
                Holds::Output(m) | Holds::Sigma(m) => {
                    title.conversion(self.units, outputs(&self.model)[m].dimension, "HP0248")
                }
            };
            let (units, factor) = converted.map_err(|error| error.note(note))?;
            if place_of(&found, holds).is_some() {
                let message = format!("`{}` is the title of two columns of `{file}`", shown(name));
                return Err(DataError::new("HP0248", message, "remove one of the two"));
            }
            found.push(Some(MeasuredColumn { holds, units, factor }));
        }
        if !found.iter().any(|h| matches!(h, Some(MeasuredColumn { holds: Holds::Output(_), .. }))) {
            let message = format!("`{file}` has no column of readings");
            let help =
                "add a column that is headed by a measure, or by a point's component, like `wheel_centre.z`";
            return Err(DataError::new("HP0248", message, help));
        }
        for (column, holds) in found.iter().enumerate() {
            if let Some(MeasuredColumn { holds: Holds::Sigma(m), .. }) = holds
                && place_of(&found, Holds::Output(*m)).is_none()
            {
                let message = format!("`{}` has no column of readings", shown(&table.titles[column].name));
                let help = "add the column of its readings, or remove this one";
                return Err(DataError::new("HP0248", message, help)
                    .note(format!("it is the title of column {}", column + 1)));
            }
        }
        Ok(found)
    }

    /// Contents that a name refers to; the error suggests similar names.
    fn held(&self, name: &str) -> Result<Holds, String> {
        let outputs = outputs(&self.model);
        let of = |name: &str| outputs.iter().position(|o| o.name == name);
        if let Some(m) = name.strip_prefix("sigma ").and_then(|name| of(name.trim())) {
            return Ok(Holds::Sigma(m));
        }
        // A name that both have is that of the driver: the reading is the value that it prescribes.
        if let Some(d) = self.model.drivers.iter().position(|d| d.name == name) {
            return Ok(Holds::Driver(d));
        }
        let elements = &self.model.elements;
        let force = || elements.iter().position(|e| e.name == name && e.kind.has_law()).map(Holds::Force);
        let all = self.model.drivers.iter().map(|d| d.name.as_str());
        let known = all.chain(outputs.iter().map(|o| o.name.as_str()));
        let known = known.chain(elements.iter().filter(|e| e.kind.has_law()).map(|e| e.name.as_str()));
        of(name).map(Holds::Output).or_else(force).ok_or_else(|| match closest(name, known) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "name a driver, a given force, a measure, a point's component like `P.x`, or a standard deviation like `sigma toe`; \
                     a name that begins with `#` leaves its column out"
                .into(),
        })
    }

    /// Factor from the numbers of a column to values of the law of a force. Forces with a unit are those in the nominal
    /// design, with the sign of the force of the model file; values of the law have the unit `1`. Without a unit both
    /// must be the same.
    fn law_of(&self, force: ElementId, title: &Title) -> Result<(Units, f64), DataError> {
        let (full, of) = self.model.at_unit_law(force);
        let (name, full) = (shown(&title.name), self.units.from_si(of, full));
        let own = unit_of(self.units, of);
        let rejected = |message: String, help: String| Err(DataError::new("HP0248", message, help));
        match title.unit.as_deref() {
            Some("1") => Ok((self.units, 1.0)),
            _ if full == 0.0 => rejected(
                format!("`{name}` is zero in the model file, and its law has no effect"),
                "give the force a magnitude other than zero, which the law multiplies".into(),
            ),
            // A magnitude of one that was converted there and back.
            None if (full - 1.0).abs() <= 1e-12 => Ok((self.units, 1.0)),
            None => rejected(
                format!("`{name}` has no unit, and its law multiplies {}", with_unit(full, &own)),
                format!("head the column `{name} [{own}]` for forces, or `{name} [1]` for values of the law"),
            ),
            Some(_) => {
                let (units, factor) = title.conversion(self.units, of, "HP0248")?;
                // A column in another unit of length is that of the road below a tyre.
                Ok((units, factor * self.units.per_si(of) / units.per_si(of) / full))
            }
        }
    }

    /// Standard deviation from the command line for each output, in its unit.
    fn sigmas_given(&self, sigmas: &[(String, f64)]) -> Result<Vec<Option<f64>>, DataError> {
        let outputs = outputs(&self.model);
        let mut given = vec![None; outputs.len()];
        for (name, sigma) in sigmas {
            let Some(m) = outputs.iter().position(|o| o.name == *name) else {
                let near = closest(name, outputs.iter().map(|o| o.name.as_str()));
                let help = near.map_or("name a measure, or a point's component like `P.x`".into(), |near| {
                    format!("did you mean `{near}`?")
                });
                let message =
                    format!("`--sigma` names `{}`, and nothing is measured by that name", shown(name));
                return Err(DataError::new("HP0249", message, help));
            };
            if !(*sigma > 0.0 && sigma.is_finite()) {
                let message = format!("the standard deviation of `{name}` cannot be {sigma}");
                return Err(DataError::new("HP0249", message, "give a number above zero"));
            }
            given[m] = Some(*sigma);
        }
        Ok(given)
    }

    /// HP0248, HP0249: readings of what is at rest, of finite squares, all with standard deviations or all alike.
    fn can_be_compared(&self, found: &MeasuredData, file: &str) -> Result<(), DataError> {
        let outputs = outputs(&self.model);
        let readings = &found.measurements.readings;
        let moving = readings.iter().map(|r| &outputs[r.output]);
        if let Some(output) = moving.clone().find(|o| !self.model.is_known_at_rest(o.source)) {
            let message =
                format!("`{}` cannot be compared: it does not follow from positions alone", output.name);
            return Err(DataError::new("HP0248", message, "remove its column, or begin its title with `#`")
                .note("every line is a posture with the positions of all drivers"));
        }
        // Without standard deviations the residuals are in SI units.
        let size = |r: &Reading| r.value.abs() / r.sigma.unwrap_or(1.0);
        if let Some(reading) = readings.iter().find(|r| !(size(r) <= MOST_SIGMAS)) {
            let (output, line) = (&outputs[reading.output], found.lines[reading.posture]);
            let message =
                format!("`{file}`, line {line}: the reading of `{}` is too large to be fitted", output.name);
            let most =
                format!("the maximum is {MOST_SIGMAS:e} standard deviations, or SI units without them");
            let help = "correct it, or leave its cell empty";
            return Err(DataError::new("HP0249", message, help).note(most));
        }
        let Some(without) = readings.iter().find(|r| r.sigma.is_none()) else { return Ok(()) };
        let (name, line) = (&outputs[without.output].name, found.lines[without.posture]);
        let like = format!("add a column `sigma {name}`, or `--sigma {name}=0.01`, in its unit");
        if readings.iter().any(|r| r.sigma.is_some()) {
            let message =
                format!("`{file}`, line {line}: `{name}` has no standard deviation, and others have one");
            return Err(DataError::new("HP0249", message, like));
        }
        if let Some(other) = moving.clone().find(|o| o.dimension != outputs[without.output].dimension) {
            let message = format!(
                "`{name}` and `{}` cannot be weighed against each other without standard deviations",
                other.name
            );
            return Err(DataError::new("HP0249", message, like).note(
                "they have different units; only readings with a single unit may have no standard deviations",
            ));
        }
        Ok(())
    }
}

/// Rows of readings, with what their columns hold.
struct MeasuredRows<'a> {
    of: &'a ModelFile,
    table: &'a Readings,
    file: &'a str,
    holds: Vec<Option<MeasuredColumn>>,
    /// Standard deviation of each output, where one is given for all its readings.
    given: Vec<Option<f64>>,
    /// Values of the drivers in the design configuration.
    drawn: Vec<f64>,
    outputs: Vec<Output>,
}

impl MeasuredRows<'_> {
    /// Adds the posture and the readings of a row.
    fn add(&self, line: u64, cells: &[Option<f64>], found: &mut MeasuredData) -> Result<(), DataError> {
        let Self { of: ModelFile { model, .. }, holds, .. } = self;
        let (mut positions, mut forces) = (self.drawn.clone(), Vec::new());
        let posture = found.lines.len();
        for (column, (held, cell)) in holds.iter().zip(cells).enumerate() {
            let Some(read) = *held else { continue };
            match (read.holds, cell) {
                (Holds::Driver(d), Some(x)) => {
                    let quantity = model.driven(&model.drivers[d]).quantity;
                    positions[d] = read.units.to_si(quantity, read.factor * x);
                }
                (Holds::Force(e), Some(x)) => forces.push((ElementId(e), read.factor * x)),
                (Holds::Driver(_) | Holds::Force(_), None) => {
                    let message = format!("{} is missing", self.place(line, column));
                    let help = "give the value of every driver and force of the first line";
                    return Err(DataError::new("HP0112", message, help));
                }
                (Holds::Sigma(_), Some(x)) if !(*x > 0.0) => {
                    let message = format!("{} cannot be {x}", self.place(line, column));
                    let help = "give a number above zero, or leave the cell empty";
                    let note = "it is the standard deviation of a reading";
                    return Err(DataError::new("HP0249", message, help).note(note));
                }
                (Holds::Output(m), Some(x)) => {
                    let value = read.in_si(self.outputs[m].dimension, *x);
                    let sigma = self.sigma(m, read, cells);
                    found.measurements.readings.push(Reading { posture, output: m, value, sigma });
                }
                (Holds::Sigma(_), _) | (Holds::Output(_), None) => {}
            }
        }
        found.measurements.postures.push(positions);
        if holds.iter().flatten().any(|column| matches!(column.holds, Holds::Force(_))) {
            found.measurements.forces.push(forces);
        }
        found.lines.push(line);
        Ok(())
    }

    /// Standard deviation of a reading of an output, SI.
    fn sigma(&self, output: usize, read: MeasuredColumn, cells: &[Option<f64>]) -> Option<f64> {
        let dimension = self.outputs[output].dimension;
        let own = place_of(&self.holds, Holds::Sigma(output)).and_then(|column| {
            // Without a unit of its own it has that of the reading.
            let own = self.table.titles[column].unit.as_ref().and(self.holds[column]);
            Some(own.unwrap_or(read).in_si(dimension, cells[column]?))
        });
        own.or_else(|| self.given[output].map(|sigma| sigma / self.of.units.from_si(dimension, 1.0)))
    }

    /// The place of a number, in words.
    fn place(&self, line: u64, column: usize) -> String {
        let title = shown(&self.table.titles[column].name);
        format!("`{}`, line {line}, column {} (`{title}`)", self.file, column + 1)
    }
}

//! Measurements of a model: columns of a table assigned to drivers and outputs, values in SI.

use std::path::Path;

use hardpoint::measure::outputs;
use hardpoint::model::{Dimension, DriverId, ElementId, Measurements, Reading};

use crate::values::{DataError, Diagnostics, Source, closest, shown};
use hardpoint_table::Units;
use hardpoint_table::figures::unit as unit_of;

use super::data::Title;
use super::model_file::ModelFile;
use super::readings::{Readings, is_left_out, readings_at};

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

/// Index of the column that holds something.
fn place_of(columns: &[Option<(Holds, Units)>], wanted: Holds) -> Option<usize> {
    columns.iter().position(|column| column.is_some_and(|(holds, _)| holds == wanted))
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
        let has = |wanted: Holds| place_of(&holds, wanted);
        let as_drawn =
            (0..drivers.len()).filter(|d| has(Holds::Driver(*d)).is_none()).map(DriverId).collect();
        let mut found = MeasuredData { measurements: Measurements::default(), lines: Vec::new(), as_drawn };
        let drawn: Vec<f64> = (0..drivers.len()).map(|d| self.model.as_drawn(DriverId(d))).collect();
        let outputs = outputs(&self.model);
        for (line, cells) in &table.rows {
            let here = |column: usize| {
                format!(
                    "`{file}`, line {line}, column {} (`{}`)",
                    column + 1,
                    shown(&table.titles[column].name)
                )
            };
            let mut positions = drawn.clone();
            let mut forces = Vec::new();
            let posture = found.lines.len();
            for (column, (held, cell)) in holds.iter().zip(cells).enumerate() {
                let Some((held, units)) = *held else { continue };
                match (held, cell) {
                    (Holds::Driver(d), Some(x)) => {
                        positions[d] = units.to_si(self.model.driven(&drivers[d]).quantity, *x);
                    }
                    (Holds::Force(e), Some(x)) => forces.push((ElementId(e), *x)),
                    (Holds::Driver(_) | Holds::Force(_), None) => {
                        let help = "give the value of every driver and force of the first line";
                        return Err(DataError::new("HP0112", format!("{} is missing", here(column)), help));
                    }
                    (Holds::Sigma(_), Some(x)) if !(*x > 0.0) => {
                        let help = "give a number above zero, or leave the cell empty";
                        return Err(DataError::new(
                            "HP0249",
                            format!("{} cannot be {x}", here(column)),
                            help,
                        )
                        .note("it is the standard deviation of a reading"));
                    }
                    (Holds::Output(m), Some(x)) => {
                        let in_si = |units: Units, x: f64| x / units.from_si(outputs[m].dimension, 1.0);
                        let own = has(Holds::Sigma(m)).and_then(|column| {
                            // Standard deviations without a unit of their own have that of their readings.
                            let own = table.titles[column].unit.as_ref().and(holds[column]);
                            Some(in_si(own.map_or(units, |(_, own)| own), cells[column]?))
                        });
                        let sigma = own.or(given[m].map(|sigma| in_si(self.units, sigma)));
                        let reading = Reading { posture, output: m, value: in_si(units, *x), sigma };
                        found.measurements.readings.push(reading);
                    }
                    (Holds::Sigma(_), _) | (Holds::Output(_), None) => {}
                }
            }
            found.measurements.postures.push(positions);
            if holds.iter().any(|h| matches!(h, Some((Holds::Force(_), _)))) {
                found.measurements.forces.push(forces);
            }
            found.lines.push(*line);
        }
        if found.measurements.readings.is_empty() {
            let help = "write numbers below the names of measures and points";
            return Err(DataError::content(format!("`{file}` has no readings"), help));
        }
        self.can_be_compared(&found, file)?;
        Ok(found)
    }

    /// Contents of every column, and the units of its numbers; `None` for columns that are left out.
    fn columns(&self, table: &Readings, file: &str) -> Result<Vec<Option<(Holds, Units)>>, DataError> {
        let mut found = Vec::new();
        for (column, title) in table.titles.iter().enumerate() {
            let Title { name, unit } = title;
            let note = format!("it is the title of column {} of `{file}`", column + 1);
            if is_left_out(title) {
                found.push(None);
                continue;
            }
            let holds = self.held(name).map_err(|help| {
                let message = format!("`{}` is neither a driver, a force nor an output", shown(name));
                DataError::new("HP0248", message, help).note(note.clone())
            })?;
            if let (Holds::Force(_), Some(unit)) = (holds, unit.as_deref()) {
                let message =
                    format!("`{}` is in `{}`, and the law of a force has no unit", shown(name), shown(unit));
                let help = format!(
                    "head the column `{}`, and give values of the law, which multiplies the force of the model file",
                    shown(name)
                );
                return Err(DataError::new("HP0248", message, help).note(note));
            }
            let of = self.dimension_of(holds);
            let units = title.units(self.units, of, &unit_of(self.units, of), "HP0248");
            let units = units.map_err(|error| error.note(note))?;
            if place_of(&found, holds).is_some() {
                let message = format!("`{}` is the title of two columns of `{file}`", shown(name));
                return Err(DataError::new("HP0248", message, "remove one of the two"));
            }
            found.push(Some((holds, units)));
        }
        if !found.iter().any(|h| matches!(h, Some((Holds::Output(_), _)))) {
            let message = format!("`{file}` has no column of readings");
            let help =
                "add a column that is headed by a measure, or by a point's component, like `wheel_centre.z`";
            return Err(DataError::new("HP0248", message, help));
        }
        for (column, holds) in found.iter().enumerate() {
            if let Some((Holds::Sigma(m), _)) = holds
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

    /// Dimension of the numbers of a column.
    fn dimension_of(&self, holds: Holds) -> Dimension {
        match holds {
            Holds::Driver(d) => self.model.driven(&self.model.drivers[d]).quantity.into(),
            Holds::Force(_) => Dimension::NUMBER,
            Holds::Output(m) | Holds::Sigma(m) => outputs(&self.model)[m].dimension,
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

    /// HP0248, HP0249: readings of what is at rest, all with standard deviations or all alike.
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

//! Maps: measures over a grid of two drivers, with sensitivities. `maps.csv`, `map_sensitivity.csv`, `maps.json`.

use std::io::Write;

use hardpoint::measure::Output;
use hardpoint::model::{Dimension, Model, OutputSource, VariableId};
use hardpoint_file::Units;
use hardpoint_study::grid::{GridMap, GridStop};
use hardpoint_table::csv::CsvWriter;
use serde::Serialize;

use crate::figures::{number, per, unit, variable_unit, with_unit};
use crate::page::{Curve, GridDriver, GridMap as GridPage, GridQuantity, GridSensitivity, Payload, Table};

/// Maximum number of derivatives of a map on a page: about 2 MB.
const MOST_NUMBERS: usize = 1_000_000;

/// Map as in `maps.json`. Values are in the model's units; a missing value is `null`.
#[derive(Clone, Debug, Serialize)]
pub struct MapFact {
    /// Name of the case.
    pub name: String,
    /// Drivers with their positions.
    pub drivers: [MapDriver; 2],
    /// Number of positions reached.
    pub solved: usize,
    /// Number of positions requested.
    pub asked: usize,
    /// True if the user ended the map early.
    pub interrupted: bool,
    /// Reasons for unreached positions, row by row.
    pub gaps: Vec<MapGap>,
    /// Index of the reason for each unreached position; `null` if it was reached or not tried.
    pub gap: Vec<Vec<Option<usize>>>,
    /// Measures that depend on positions, or on one driver; points if the model has no measures.
    pub measures: Vec<MapMeasure>,
}

/// Map in `summary.json`.
#[derive(Clone, Debug, Serialize)]
pub struct MapLine {
    /// Name of the case.
    pub name: String,
    /// Names of the two drivers.
    pub drivers: [String; 2],
    /// Number of positions reached.
    pub solved: usize,
    /// Number of positions requested.
    pub asked: usize,
    /// Reasons for unreached positions.
    pub gaps: Vec<String>,
}

/// Driver of a map.
#[derive(Clone, Debug, Serialize)]
pub struct MapDriver {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Positions of the driver, in the coordinate of its law.
    pub values: Vec<f64>,
}

/// End of a row of a map, with the reason.
#[derive(Clone, Debug, Serialize)]
pub struct MapGap {
    /// Positions of the two drivers where the mechanism stopped.
    pub drivers: [f64; 2],
    /// Diagnostic code.
    pub code: &'static str,
    /// Description of the stop.
    pub message: String,
}

/// Measure over a map. Tables have a row for each position of the second driver and a column for each position of the
/// first.
#[derive(Clone, Debug, Serialize)]
pub struct MapMeasure {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Values.
    pub values: Vec<Vec<Option<f64>>>,
    /// Derivatives by the design variables.
    pub sensitivities: Vec<MapSensitivity>,
}

/// Derivative of a measure by a design variable over a map.
#[derive(Clone, Debug, Serialize)]
pub struct MapSensitivity {
    /// Name of the variable.
    pub variable: String,
    /// Unit of the variable.
    pub per: String,
    /// Unit of the derivative.
    pub unit: String,
    /// Derivatives; `null` if the mechanism cannot follow the variable.
    pub values: Vec<Vec<Option<f64>>>,
}

impl MapFact {
    /// Facts of a solved grid.
    pub fn of(model: &Model, units: Units, map: &GridMap) -> Self {
        let drivers = [0, 1].map(|k| {
            let driver = &model.drivers[map.grid.drivers[k].0];
            let dimension = Dimension::from(model.driven(driver).quantity);
            MapDriver {
                name: driver.name.clone(),
                unit: unit(units, dimension),
                values: map.grid.values[k].iter().map(|v| units.from_si(dimension, *v)).collect(),
            }
        });
        let gap = |stop: &GridStop| MapGap {
            drivers: [0, 1].map(|k| {
                let driver = &model.drivers[map.grid.drivers[k].0];
                units.from_si(model.driven(driver).quantity, stop.drivers[k])
            }),
            code: stop.stop.code(),
            message: stop.stop.happened(model),
        };
        let measured = |o: &Output| model.measures.is_empty() || matches!(o.source, OutputSource::Measure(_));
        let outputs = map.outputs.iter().enumerate().filter(|(m, o)| measured(o) && map.has(*m));
        Self {
            name: map.grid.name.clone(),
            drivers,
            solved: map.solved(),
            asked: map.places().count(),
            interrupted: map.interrupted(),
            gaps: map.stops.iter().map(gap).collect(),
            gap: table_of(map, &|place| map.stop_index(place)),
            measures: outputs.map(|(m, o)| measure(model, units, map, m, o)).collect(),
        }
    }

    /// Entry of the map in `summary.json`.
    pub fn line(&self) -> MapLine {
        MapLine {
            name: self.name.clone(),
            drivers: [0, 1].map(|k| self.drivers[k].name.clone()),
            solved: self.solved,
            asked: self.asked,
            gaps: self.gaps.iter().map(|gap| self.gap_line(gap)).collect(),
        }
    }

    /// Table of the maps for the terminal.
    pub fn table(facts: &[Self]) -> Vec<Table> {
        facts.iter().map(Self::own_table).collect()
    }

    /// Adds the maps to a page.
    pub fn page(facts: &[Self], page: Payload) -> Payload {
        Payload { maps: facts.iter().map(Self::own_page).collect(), ..page }
    }

    fn own_page(&self) -> GridPage {
        let curve = |table: &[Vec<Option<f64>>]| -> Curve {
            table.iter().flatten().map(|x| x.unwrap_or(f64::NAN)).collect()
        };
        let variables = self.measures.first().map_or(0, |m| m.sensitivities.len());
        let fits = self.asked.saturating_mul(self.measures.len()).saturating_mul(variables) <= MOST_NUMBERS;
        let sensitivity = |s: &MapSensitivity| GridSensitivity {
            variable: s.variable.clone(),
            unit: s.unit.clone(),
            values: curve(&s.values),
        };
        let quantity = |m: &MapMeasure| GridQuantity {
            name: m.name.clone(),
            unit: m.unit.clone(),
            values: curve(&m.values),
            sensitivities: m.sensitivities.iter().filter(|_| fits).map(sensitivity).collect(),
        };
        let left_out = if fits {
            ""
        } else {
            "; the sensitivities are too many for a page and are in map_sensitivity.csv"
        };
        GridPage {
            name: self.name.clone(),
            drivers: [0, 1].map(|k| GridDriver {
                name: self.drivers[k].name.clone(),
                unit: self.drivers[k].unit.clone(),
                places: self.drivers[k].values.clone(),
            }),
            note: format!("{}{left_out}.", self.own_table().note),
            quantities: self.measures.iter().map(quantity).collect(),
        }
    }

    fn own_table(&self) -> Table {
        let [first, second] = &self.drivers;
        let at = |i: usize, j: usize| {
            format!(
                "{}, {}",
                with_unit(first.values[i], &first.unit),
                with_unit(second.values[j], &second.unit)
            )
        };
        let row = |m: &MapMeasure| {
            let places =
                m.values.iter().enumerate().flat_map(|(j, row)| {
                    row.iter().enumerate().filter_map(move |(i, x)| Some((i, j, (*x)?)))
                });
            let ends = [
                places.clone().min_by(|a, b| a.2.total_cmp(&b.2)),
                places.max_by(|a, b| a.2.total_cmp(&b.2)),
            ];
            let of = |end: Option<(usize, usize, f64)>| match end {
                Some((i, j, x)) => [with_unit(x, &m.unit), at(i, j)],
                None => ["-".into(), String::new()],
            };
            let [[least, least_at], [most, most_at]] = ends.map(of);
            vec![m.name.clone(), least, least_at, most, most_at]
        };
        let gaps: Vec<String> = self.gaps.iter().map(|gap| self.gap_line(gap)).collect();
        let some = match &gaps[..] {
            [] => String::new(),
            [one] => format!("; {one}"),
            [one, rest @ ..] => {
                format!("; {one}, and so in {} more", crate::figures::count(rest.len(), "row"))
            }
        };
        let ended = if self.interrupted { ", interrupted" } else { "" };
        Table {
            title: format!("Map `{}` over {} and {}", self.name, first.name, second.name),
            note: format!("{} of {} positions reached{ended}{some}", self.solved, self.asked),
            header: ["measure", "minimum", "at", "maximum", "at"].map(String::from).to_vec(),
            rows: self.measures.iter().map(row).collect(),
        }
    }

    fn gap_line(&self, gap: &MapGap) -> String {
        let [first, second] = [0, 1].map(|k| {
            let driver = &self.drivers[k];
            format!("{} = {} {}", driver.name, number(gap.drivers[k]), driver.unit)
        });
        format!("{} at {first}, {second}", gap.message)
    }
}

/// Values of all positions, row by row.
fn table_of<T>(map: &GridMap, of: &dyn Fn([usize; 2]) -> Option<T>) -> Vec<Vec<Option<T>>> {
    let [columns, rows] = [0, 1].map(|k| map.grid.values[k].len());
    (0..rows).map(|j| (0..columns).map(|i| of([i, j])).collect()).collect()
}

fn measure(model: &Model, units: Units, map: &GridMap, m: usize, output: &Output) -> MapMeasure {
    let own = unit(units, output.dimension);
    let sensitivity = |(b, variable): (usize, &hardpoint::model::DesignVariable)| {
        let by = variable_unit(model, units, variable);
        let from_si = |d: f64| units.derivative_from_si(output.dimension, variable.quantity, d);
        MapSensitivity {
            variable: variable.name.clone(),
            unit: per(&own, &by),
            per: by,
            values: table_of(map, &|place| map.d(place, VariableId(b), m).map(from_si)),
        }
    };
    MapMeasure {
        name: output.name.clone(),
        values: table_of(map, &|place| map.value(place, m).map(|x| units.from_si(output.dimension, x))),
        sensitivities: model.variables.iter().enumerate().map(sensitivity).collect(),
        unit: own,
    }
}

/// Writes `maps.csv`: one row per position of every map, with its measures. At an unreached position they are empty,
/// and `gap` contains the reason.
///
/// # Errors
/// If `out` cannot be written.
pub fn write_csv(facts: &[MapFact], out: impl Write) -> csv::Result<()> {
    let mut writer = CsvWriter::new(out);
    let Some(one) = facts.first() else { return Ok(()) };
    let mut header: Vec<String> = PLACES.map(String::from).to_vec();
    header.extend(one.measures.iter().map(|m| column(&m.name, &m.unit)));
    header.push("gap".into());
    writer.row(&header)?;
    for map in facts {
        for (j, i) in map.rows() {
            map.write_place(j, i, &mut writer)?;
            writer.numbers(map.measures.iter().map(|m| m.values[j][i].unwrap_or(f64::NAN)))?;
            writer.text(&map.why(j, i))?;
            writer.end_row()?;
        }
    }
    writer.end()?;
    Ok(())
}

/// Header of the column of a measure.
fn column(name: &str, unit: &str) -> String {
    if unit == "1" { name.into() } else { format!("{name} [{unit}]") }
}

/// Writes `map_sensitivity.csv`: one row per position and design variable, with the derivatives of the measures.
///
/// # Errors
/// If `out` cannot be written.
pub fn write_sensitivity_csv(facts: &[MapFact], out: impl Write) -> csv::Result<()> {
    let mut writer = CsvWriter::new(out);
    let Some(one) = facts.first() else { return Ok(()) };
    let mut header: Vec<String> = PLACES.map(String::from).to_vec();
    header.extend(["variable", "per"].map(String::from));
    header.extend(one.measures.iter().map(|m| column(&format!("d {}", m.name), &m.unit)));
    writer.row(&header)?;
    for map in facts {
        let Some(of) = map.measures.first() else { continue };
        for (j, i) in map.rows() {
            for (b, by) in of.sensitivities.iter().enumerate() {
                let row: Vec<f64> = map
                    .measures
                    .iter()
                    .map(|m| m.sensitivities[b].values[j][i].unwrap_or(f64::NAN))
                    .collect();
                if row.iter().any(|x| x.is_finite()) {
                    map.write_place(j, i, &mut writer)?;
                    writer.text(&by.variable)?;
                    writer.text(&by.per)?;
                    writer.numbers(row)?;
                    writer.end_row()?;
                }
            }
        }
    }
    writer.end()?;
    Ok(())
}

/// Columns that identify the position of a row.
const PLACES: [&str; 7] =
    ["case", "first driver", "first value", "first unit", "second driver", "second value", "second unit"];

impl MapFact {
    /// Row and column indices of all positions.
    fn rows(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let [columns, rows] = [0, 1].map(|k| self.drivers[k].values.len());
        (0..rows).flat_map(move |j| (0..columns).map(move |i| (j, i)))
    }

    /// Writes the columns that identify the position.
    fn write_place(&self, j: usize, i: usize, writer: &mut CsvWriter<impl Write>) -> csv::Result<()> {
        writer.text(&self.name)?;
        for (driver, k) in self.drivers.iter().zip([i, j]) {
            writer.text(&driver.name)?;
            writer.numbers([driver.values[k]])?;
            writer.text(&driver.unit)?;
        }
        Ok(())
    }

    /// Reason why a position was not reached.
    fn why(&self, j: usize, i: usize) -> String {
        self.gap[j][i].map_or(String::new(), |gap| self.gap_line(&self.gaps[gap]))
    }
}

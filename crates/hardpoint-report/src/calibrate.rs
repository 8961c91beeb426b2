//! Result of a calibration: the fitted geometry, its accuracy, and unidentifiable changes, in the model's units.

use std::io::Write;

use hardpoint::joint::Quantity;
use hardpoint::measure::Output;
use hardpoint::model::Reading;
use hardpoint::model::{DriverId, Model};
use hardpoint_file::{MeasuredData, ModelFile, Units};
use hardpoint_study::calibrate::{
    Calibration, FittedReading, Loss, NextReading, Status, UnidentifiableChange,
};
use hardpoint_table::csv::CsvWriter;
use serde::Serialize;

use crate::figures::variable_unit;
use crate::figures::{count, number, rounded, seconds, some_of, symbol, unit, with_unit};
use crate::optimize::{Evaluations, MovedHardpoint, moved};
use crate::page::{Curve, Fact, Payload, SweepAxis, SweepPlot, Table};

/// Residuals of more standard deviations than this are reported; about three of a thousand normal residuals are.
const FAR: f64 = 3.0;
/// Maximum number of listed residuals.
const LISTED: usize = 10;
/// Correlation above which two variables are reported as a pair.
const TOGETHER: f64 = 0.95;
/// Number of standard errors within which the scatter of residuals agrees with the given standard deviations.
const FITS: f64 = 4.0;
/// Components of an unidentifiable direction below this fraction are not shown.
const SLIGHT: f64 = 1e-4;

/// Result of a calibration, in the model's units. Serialised as `summary.json` of `hardpoint calibrate`.
#[derive(Clone, Debug, Serialize)]
pub struct CalibrateFacts {
    /// Program and version.
    pub generator: String,
    /// Kind of study.
    pub study: &'static str,
    /// Name of the model.
    pub model: String,
    /// Name of the model file.
    pub file: String,
    /// Name of the measurement file.
    pub data: String,
    /// Status at the end: `found`, `not_told` (found, but the readings do not determine all variables),
    /// `iteration_limit` or `interrupted`.
    pub status: &'static str,
    /// Status in words, with an instruction.
    pub message: String,
    /// Objective of the nominal and the fitted design: sum of squared residuals, or of the loss, in standard
    /// deviations.
    pub objective: [f64; 2],
    /// Cost of the search.
    pub evaluations: Evaluations,
    /// Number of compared readings.
    pub readings: usize,
    /// Number of postures of these readings.
    pub postures: usize,
    /// Degrees of freedom: readings minus determined directions.
    pub freedom: usize,
    /// Standard deviation of the residuals: relative to the given standard deviations, where 1 is expected, otherwise
    /// in `scatter_unit`.
    pub scatter: Option<f64>,
    /// Unit of `scatter`; empty if standard deviations are given.
    pub scatter_unit: String,
    /// Fitted variables.
    pub variables: Vec<CalibratedVariable>,
    /// Pairs of variables that the readings hardly distinguish, with their correlation.
    pub together: Vec<(String, String, f64)>,
    /// Changes that the readings do not determine.
    pub untold: Vec<UnidentifiableFact>,
    /// Variables that the mechanism cannot follow. They keep their design values.
    pub left_out: Vec<String>,
    /// Drivers without a column in the measurement file. They stay in the design configuration.
    pub as_drawn: Vec<String>,
    /// Hardpoints that the fitted design moves.
    pub hardpoints: Vec<MovedHardpoint>,
    /// Readings with large residuals, the largest first.
    pub far_off: Vec<LargeResidual>,
    /// Number of readings with large residuals.
    pub far_off_count: usize,
    /// Postures that the nominal design does not reach. Their readings are left out.
    pub not_reached: Vec<NotReachedFact>,
    /// Proposed further readings, the most informative first.
    pub next: Vec<NextFact>,
    /// Written files.
    pub files: Vec<String>,
    /// Duration, s.
    pub seconds: f64,
}

/// Fitted variable.
#[derive(Clone, Debug, Serialize)]
pub struct CalibratedVariable {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Nominal value: the value of a parameter, 0 for all other variables.
    pub start: f64,
    /// Fitted value: the value of a parameter, the change of all other variables.
    pub end: f64,
    /// Standard deviation; `null` if the readings do not determine it.
    pub sigma: Option<f64>,
}

/// A change that the readings do not determine.
#[derive(Clone, Debug, Serialize)]
pub struct UnidentifiableFact {
    /// Changed variables with their changes and units; the largest change is 1.
    pub variables: Vec<(String, f64, String)>,
    /// Standard deviation as a multiple of that change; `null` if the readings do not determine it at all.
    pub sigma: Option<f64>,
}

/// Reading with a large residual.
#[derive(Clone, Debug, Serialize)]
pub struct LargeResidual {
    /// Line of the measurement file.
    pub line: u64,
    /// Column of the reading.
    pub column: String,
    /// Measured and fitted value, in `unit`.
    pub values: [f64; 2],
    /// Unit of the values.
    pub unit: String,
    /// Fitted minus measured value, in standard deviations.
    pub residual: f64,
    /// Weight in the fit, from 0 to 1.
    pub weight: f64,
}

/// Posture that is not reached.
#[derive(Clone, Debug, Serialize)]
pub struct NotReachedFact {
    /// Line of the measurement file.
    pub line: u64,
    /// Description of the event.
    pub why: String,
}

/// Proposed reading.
#[derive(Clone, Debug, Serialize)]
pub struct NextFact {
    /// Reading to take.
    pub measure: String,
    /// Assumed standard deviation, in `unit`.
    pub sigma: f64,
    /// Unit of `sigma`.
    pub unit: String,
    /// Values of the drivers: name, value, unit.
    pub drivers: Vec<(String, f64, String)>,
    /// Number of the unidentifiable change, from 1, that the reading would determine.
    pub tells: Option<usize>,
    /// Variable whose standard deviation it reduces most.
    pub variable: Option<String>,
    /// Standard deviation of that variable without and with the reading, in `variable_unit`.
    pub sigmas: Option<[f64; 2]>,
    /// Unit of the variable.
    pub variable_unit: Option<String>,
}

/// Inputs of [`CalibrateFacts`].
#[derive(Clone, Copy, Debug)]
pub struct CalibrationInputs<'a> {
    /// Model file.
    pub file: &'a ModelFile,
    /// Measurements.
    pub measured: &'a MeasuredData,
    /// Name of the measurement file.
    pub data: &'a str,
    /// Loss function of the residuals.
    pub loss: Loss,
    /// Result of the calibration.
    pub found: &'a Calibration,
}

impl CalibrationInputs<'_> {
    fn model(&self) -> &Model {
        &self.file.model
    }

    fn units(&self) -> Units {
        self.file.units
    }

    fn output(&self, m: usize) -> &Output {
        &self.found.outputs[m]
    }

    fn unit_of(&self, m: usize) -> String {
        unit(self.units(), self.output(m).dimension)
    }

    fn shown(&self, m: usize, x: f64) -> f64 {
        self.units().from_si(self.output(m).dimension, x)
    }

    fn has_sigmas(&self) -> bool {
        self.measured.measurements.readings.iter().all(|r| r.sigma.is_some())
    }

    /// Compared readings with their fitted values.
    fn compared(&self) -> impl Iterator<Item = (&Reading, &FittedReading)> {
        let readings = &self.measured.measurements.readings;
        readings.iter().zip(&self.found.fitted).filter_map(|(r, f)| Some((r, f.as_ref()?)))
    }

    /// Values of the drivers in a posture: name, value, unit.
    fn driver_values(&self, places: &[f64]) -> Vec<(String, f64, String)> {
        let model = self.model();
        let of = |(driver, place): (&hardpoint::model::Driver, &f64)| {
            let quantity = model.driven(driver).quantity;
            let shown = self.units().from_si(quantity, *place);
            (driver.name.clone(), shown, symbol(self.units(), quantity).to_owned())
        };
        model.drivers.iter().zip(places).map(of).collect()
    }

    /// Plot of the residuals over the driver positions.
    pub fn plot(&self) -> SweepPlot {
        let (model, units) = (self.model(), self.units());
        let postures = &self.measured.measurements.postures;
        let mut axes = vec![SweepAxis {
            name: "line".into(),
            unit: "1".into(),
            metric: false,
            values: self.measured.lines.iter().map(|line| *line as f64).collect(),
        }];
        for (d, driver) in model.drivers.iter().enumerate() {
            if self.measured.as_drawn.contains(&DriverId(d)) {
                continue;
            }
            let quantity = model.driven(driver).quantity;
            let values: Curve = postures.iter().map(|p| units.from_si(quantity, p[d])).collect();
            axes.insert(
                axes.len() - 1,
                SweepAxis {
                    name: driver.name.clone(),
                    unit: symbol(units, quantity).into(),
                    metric: false,
                    values,
                },
            );
        }
        let mut outputs: Vec<usize> = self.compared().map(|(r, _)| r.output).collect();
        outputs.sort_unstable();
        outputs.dedup();
        for m in outputs {
            let mut values = vec![f64::NAN; postures.len()];
            for (reading, fitted) in self.compared().filter(|(r, _)| r.output == m) {
                values[reading.posture] = self.shown(m, fitted.value - reading.value);
            }
            axes.push(SweepAxis {
                name: format!("{} fitted minus measured", self.output(m).name),
                unit: self.unit_of(m),
                metric: true,
                values: values.into_iter().collect(),
            });
        }
        SweepPlot { what: "posture".into(), designs: postures.len(), step: 1, axes, indices: Vec::new() }
    }

    /// Writes a row for each reading: line, driver positions, measured and fitted value, residual, weight.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn write_residuals(&self, out: impl Write) -> csv::Result<()> {
        let drivers = &self.model().drivers;
        let mut header = vec!["line".to_owned(), "measurement".into()];
        header.extend(
            self.driver_values(&vec![0.0; drivers.len()]).into_iter().map(|(n, _, u)| format!("{n} [{u}]")),
        );
        header.extend(
            [
                "unit",
                "measured",
                "nominal",
                "found",
                "standard deviation",
                "residual [standard deviations]",
                "weight",
            ]
            .map(String::from),
        );
        let mut writer = CsvWriter::new(out);
        writer.row(&header)?;
        let readings = &self.measured.measurements.readings;
        for (reading, fitted) in readings.iter().zip(&self.found.fitted) {
            let m = reading.output;
            let text =
                |x: Option<f64>| x.filter(|x| x.is_finite()).map_or(String::new(), |x| format!("{x:?}"));
            let mut row = vec![self.measured.lines[reading.posture].to_string(), self.output(m).name.clone()];
            let places = &self.measured.measurements.postures[reading.posture];
            row.extend(self.driver_values(places).into_iter().map(|(_, place, _)| text(Some(place))));
            row.push(self.unit_of(m));
            row.push(text(Some(self.shown(m, reading.value))));
            row.push(text(fitted.map(|f| self.shown(m, f.before))));
            row.push(text(fitted.map(|f| self.shown(m, f.value))));
            row.push(text(reading.sigma.map(|s| self.shown(m, s))));
            row.push(text(fitted.map(|f| f.residual)));
            row.push(text(fitted.map(|f| f.weight)));
            writer.row(&row)?;
        }
        writer.end()?;
        Ok(())
    }

    /// Writes the covariance of the variables over the determined directions: a row and a column for each, in products
    /// of their units.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn write_covariance(&self, out: impl Write) -> csv::Result<()> {
        let (model, units) = (self.model(), self.units());
        let name = |v: &hardpoint::model::VariableId| {
            let variable = &model.variables[v.0];
            format!("{} [{}]", variable.name, variable_unit(model, units, variable))
        };
        let names: Vec<String> = self.found.variables.iter().map(name).collect();
        let mut writer = CsvWriter::new(out);
        let header = std::iter::once("covariance").chain(names.iter().map(String::as_str));
        writer.row(header)?;
        let scale = |k: usize| {
            let v = self.found.variables[k];
            units.from_si(model.variables[v.0].quantity, 1.0)
        };
        for (i, row) in self.found.certainty.covariance.iter().enumerate() {
            let row: Vec<f64> = row.iter().enumerate().map(|(j, c)| c * scale(i) * scale(j)).collect();
            let cells = row.iter().map(|x| format!("{x:?}"));
            writer.row(std::iter::once(names[i].clone()).chain(cells))?;
        }
        writer.end()?;
        Ok(())
    }
}

impl CalibrateFacts {
    /// Collects the facts of a calibration.
    pub fn of(of: &CalibrationInputs<'_>) -> Self {
        let (model, units, found) = (of.model(), of.units(), of.found);
        let certainty = &found.certainty;
        let variable = |k: usize| {
            let v = found.variables[k];
            let variable = &model.variables[v.0];
            let shown = |x: f64| units.from_si(variable.quantity, x);
            let start = model.nominal_value(v);
            CalibratedVariable {
                name: variable.name.clone(),
                unit: variable_unit(model, units, variable),
                start: shown(start),
                end: shown(start + found.design[v.0]),
                sigma: certainty.sigmas[k].map(shown),
            }
        };
        let variables: Vec<CalibratedVariable> = (0..found.variables.len()).map(variable).collect();
        let line = |posture: usize| of.measured.lines[posture];
        let mut far_off: Vec<LargeResidual> = of
            .compared()
            .filter(|(_, f)| f.residual.abs() > FAR)
            .map(|(r, f)| LargeResidual {
                line: line(r.posture),
                column: of.output(r.output).name.clone(),
                values: [r.value, f.value].map(|x| of.shown(r.output, x)),
                unit: of.unit_of(r.output),
                residual: f.residual,
                weight: f.weight,
            })
            .collect();
        far_off.sort_by(|a, b| b.residual.abs().total_cmp(&a.residual.abs()));
        let far_off_count = far_off.len();
        far_off.truncate(LISTED);
        let names = |list: &[hardpoint::model::VariableId]| {
            list.iter().map(|v| model.variables[v.0].name.clone()).collect::<Vec<_>>()
        };
        let readings = of.compared().count();
        let mut postures: Vec<usize> = of.compared().map(|(r, _)| r.posture).collect();
        postures.dedup();
        let scatter_of = of.compared().next().filter(|_| !of.has_sigmas()).map(|(r, _)| r.output);
        let mut facts = Self {
            generator: crate::GENERATOR.into(),
            study: "calibrate",
            model: model.name.clone(),
            file: of.file.file_name().into(),
            data: of.data.into(),
            status: match found.status {
                Status::Found if certainty.unidentifiable.is_empty() => "found",
                Status::Found => "not_told",
                Status::IterationLimit => "iteration_limit",
                Status::Interrupted => "interrupted",
            },
            message: String::new(),
            objective: found.objective,
            evaluations: Evaluations {
                designs: found.cost.designs,
                motions: found.cost.motions,
                steps: found.cost.steps,
            },
            readings,
            postures: postures.len(),
            freedom: certainty.freedom,
            scatter: certainty.scatter.map(|s| scatter_of.map_or(s, |m| of.shown(m, s))),
            scatter_unit: scatter_of.map_or(String::new(), |m| of.unit_of(m)),
            together: together(&certainty.covariance, &variables),
            untold: certainty.unidentifiable.iter().map(|u| untold(of, u)).collect(),
            left_out: names(&found.left_out),
            as_drawn: of.measured.as_drawn.iter().map(|d| model.drivers[d.0].name.clone()).collect(),
            hardpoints: moved(model, units, &found.design),
            far_off,
            far_off_count,
            not_reached: found
                .not_reached
                .iter()
                .map(|n| NotReachedFact { line: line(n.posture), why: n.why.clone() })
                .collect(),
            next: found.next.iter().map(|n| next(of, n, &variables)).collect(),
            variables,
            files: Vec::new(),
            seconds: 0.0,
        };
        facts.message = facts.sentence(of);
        facts
    }

    fn sentence(&self, of: &CalibrationInputs<'_>) -> String {
        let fit = match self.scatter.filter(|_| of.has_sigmas()) {
            // The standard deviation from a chi square of n degrees of freedom is 1 within 1 / sqrt(2 n).
            Some(s) if (s - 1.0).abs() * (2.0 * self.freedom as f64).sqrt() > FITS => {
                let than = if s > 1.0 {
                    "larger: the model is incomplete, or the measurements are less accurate"
                } else {
                    "smaller: the measurements are more accurate"
                };
                format!("; the residuals are {} times the given standard deviations, {than}", rounded(s, 3))
            }
            Some(_) => "; the residuals agree with the given standard deviations".into(),
            None => String::new(),
        };
        match self.status {
            "found" => {
                format!("found: the readings determine all {}{fit}", count(self.variables.len(), "variable"))
            }
            "not_told" => format!(
                "found, but {} of the design {} not determined by the readings{fit}",
                count(self.untold.len(), "direction"),
                if self.untold.len() == 1 { "is" } else { "are" }
            ),
            "interrupted" => "interrupted: the best design so far".into(),
            _ => "the iteration limit was reached before the best fit: increase `--iterations`".into(),
        }
    }

    /// Facts of the result, line by line.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let mut rows = vec![("result", self.message.clone())];
        let of = format!("{} in {}", count(self.readings, "reading"), count(self.postures, "posture"));
        rows.push(("compared", of));
        let [before, after] = self.objective.map(number);
        rows.push(("objective", format!("{before} nominal, {after} fitted")));
        if let Some(scatter) = self.scatter {
            let (unit, free) = (&self.scatter_unit, self.freedom);
            let said = if unit.is_empty() {
                format!("{} of the given standard deviations", rounded(scatter, 3))
            } else {
                with_unit(scatter, unit)
            };
            rows.push((
                "residuals",
                format!(
                    "{said}, from {}",
                    count(free, "degree of freedom").replace("degree of freedoms", "degrees of freedom")
                ),
            ));
        }
        if !self.left_out.is_empty() {
            let names = some_of(&self.left_out, ", ");
            rows.push(("left out", format!("{names}: the mechanism cannot follow")));
        }
        if !self.as_drawn.is_empty() {
            rows.push((
                "nominal",
                format!("{} were in the design configuration", some_of(&self.as_drawn, ", ")),
            ));
        }
        for n in self.not_reached.iter().take(LISTED) {
            rows.push(("not reached", format!("line {}: {}", n.line, n.why)));
        }
        rows.push((
            "evaluated",
            format!("{}, {} postures", count(self.evaluations.designs, "design"), self.evaluations.motions),
        ));
        rows.push(("time taken", seconds(self.seconds)));
        rows
    }

    /// Further tables: variables, unidentifiable changes, large residuals, proposed readings.
    pub fn tables(&self) -> Vec<Table> {
        let header = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>();
        let table = |title: &str, note: &str, names: &[&str], rows: Vec<Vec<String>>| {
            let (title, note) = (title.to_owned(), note.to_owned());
            (!rows.is_empty()).then(|| Table { title, note, header: header(names), rows })
        };
        let variable = |v: &CalibratedVariable| {
            let sigma = v.sigma.map_or("undetermined".into(), |s| format!("± {}", with_unit(s, &v.unit)));
            let change = v.end - v.start;
            let sure = v.sigma.filter(|s| *s > 0.0).map_or(String::new(), |s| rounded(change / s, 3));
            vec![v.name.clone(), with_unit(v.start, &v.unit), with_unit(v.end, &v.unit), sigma, sure]
        };
        let together = |(a, b, r): &(String, String, f64)| vec![a.clone(), b.clone(), rounded(*r, 4)];
        let untold = |(k, u): (usize, &UnidentifiableFact)| {
            let parts: Vec<String> =
                u.variables.iter().map(|(name, by, unit)| format!("{name} {}", signed(*by, unit))).collect();
            let sigma = u.sigma.map_or("none".into(), |s| format!("± {} times that", rounded(s, 3)));
            vec![(k + 1).to_string(), parts.join(", "), sigma]
        };
        let far = |f: &LargeResidual| {
            let [measured, found] = f.values.map(|x| with_unit(x, &f.unit));
            let weight = if f.weight < 1.0 { rounded(f.weight, 2) } else { "1".into() };
            vec![f.line.to_string(), f.column.clone(), measured, found, rounded(f.residual, 3), weight]
        };
        let next = |n: &NextFact| {
            let at: Vec<String> = n
                .drivers
                .iter()
                .map(|(name, place, unit)| format!("{name} {}", with_unit(*place, unit)))
                .collect();
            let does = match (n.tells, &n.variable, n.sigmas, &n.variable_unit) {
                (Some(k), ..) => format!("determines change {k}"),
                (None, Some(variable), Some([before, after]), Some(unit)) => {
                    format!("{variable}: from ± {} to ± {}", number(before), with_unit(after, unit))
                }
                _ => String::new(),
            };
            vec![n.measure.clone(), at.join(", "), format!("± {}", with_unit(n.sigma, &n.unit)), does]
        };
        let moved = |h: &MovedHardpoint| {
            let text = |p: [f64; 3]| p.map(number).join(", ");
            vec![h.name.clone(), text(h.before), text(h.after)]
        };
        [
            table(
                "Design",
                "",
                &["variable", "nominal", "fitted", "standard deviation", "change / sigma"],
                self.variables.iter().map(variable).collect(),
            ),
            table(
                "Hardly distinguishable",
                "Variables with correlated errors: their combination is determined better than each of them.",
                &["variable", "and", "correlation"],
                self.together.iter().map(together).collect(),
            ),
            table(
                "Not determined",
                "Changes of the design that affect no reading, or too little. The fitted design contains none of them.",
                &["", "change by", "standard deviation"],
                self.untold.iter().enumerate().map(untold).collect(),
            ),
            table("Moved hardpoints", "", &["hardpoint", "nominal", "fitted"], self.hardpoints.iter().map(moved).collect()),
            table(
                "Large residuals",
                "Residuals of more than three standard deviations.",
                &["line", "measurement", "measured", "fitted", "residual / sigma", "weight"],
                self.far_off.iter().map(far).collect(),
            ),
            table(
                "Proposed readings",
                "Most informative further reading of each measure.",
                &["measure", "where", "standard deviation", "effect"],
                self.next.iter().map(next).collect(),
            ),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// Turns the page of the fitted design into that of the calibration: residuals as points, and the result first
    /// among the checks.
    pub fn page(&self, of: &CalibrationInputs<'_>, mut page: Payload, outputs: &[Output]) -> Payload {
        let first = of.compared().next().map(|(r, _)| &of.output(r.output).name);
        page.first = first.and_then(|name| outputs.iter().position(|o| o.name == *name)).or(page.first);
        let fact = Fact { label: "readings".into(), value: self.readings.to_string() };
        page.summary.insert(0, fact);
        let rows = self.rows().into_iter().map(|(what, is)| vec![what.into(), is]).collect();
        let header = ["", "is"].map(String::from).to_vec();
        let mut checks = vec![Table { title: "Calibration".into(), note: String::new(), header, rows }];
        checks.extend(self.tables());
        checks.append(&mut page.checks);
        Payload { checks, sweep: Some(of.plot()), ..page }
    }
}

fn signed(by: f64, unit: &str) -> String {
    let sign = if by < 0.0 { "" } else { "+" };
    format!("{sign}{}", with_unit(by, unit))
}

fn together(covariance: &[Vec<f64>], variables: &[CalibratedVariable]) -> Vec<(String, String, f64)> {
    let mut found = Vec::new();
    for i in 0..variables.len() {
        for j in 0..i {
            let r = covariance[i][j] / (covariance[i][i] * covariance[j][j]).sqrt();
            if r.abs() > TOGETHER && variables[i].sigma.is_some() && variables[j].sigma.is_some() {
                found.push((variables[j].name.clone(), variables[i].name.clone(), r));
            }
        }
    }
    found.sort_by(|a, b| b.2.abs().total_cmp(&a.2.abs()));
    found.truncate(LISTED);
    found
}

fn untold(of: &CalibrationInputs<'_>, untold: &UnidentifiableChange) -> UnidentifiableFact {
    let (model, units) = (of.model(), of.units());
    let shown = |k: usize| {
        let variable = &model.variables[of.found.variables[k].0];
        (variable, units.from_si(variable.quantity, untold.direction[k]))
    };
    let all = 0..untold.direction.len();
    let most = all.clone().map(|k| shown(k).1.abs()).fold(0.0, f64::max);
    let part = |k: usize| {
        let (variable, by) = shown(k);
        (variable.name.clone(), by / most, variable_unit(model, units, variable))
    };
    let variables = all.map(part).filter(|(_, by, _)| by.abs() > SLIGHT).collect();
    UnidentifiableFact { variables, sigma: untold.sigma.map(|s| s * most) }
}

fn next(of: &CalibrationInputs<'_>, next: &NextReading, variables: &[CalibratedVariable]) -> NextFact {
    let improves = next.improves.as_ref();
    let variable = improves.map(|i| &variables[i.variable]);
    let in_units = |i: &hardpoint_study::calibrate::Improvement| {
        let quantity: Quantity = of.model().variables[of.found.variables[i.variable].0].quantity;
        [i.before, i.after].map(|s| of.units().from_si(quantity, s))
    };
    NextFact {
        measure: of.output(next.output).name.clone(),
        sigma: of.shown(next.output, next.sigma),
        unit: of.unit_of(next.output),
        drivers: of.driver_values(&next.drivers),
        tells: next.determines.map(|k| k + 1),
        variable: variable.map(|v| v.name.clone()),
        sigmas: improves.map(in_units),
        variable_unit: variable.map(|v| v.unit.clone()),
    }
}

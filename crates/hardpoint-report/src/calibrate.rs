//! Result of a calibration: the fitted geometry, its accuracy, and unidentifiable changes, in the model's units.

use std::io::Write;

use hardpoint::joint::Quantity;
use hardpoint::measure::Output;
use hardpoint::model::{DriverId, Model};
use hardpoint::study::{
    Calibration, FitStatus, FittedReading, Loss, NextReading, Reading, UnidentifiableChange,
};
use hardpoint_file::csv_table::CsvWriter;
use hardpoint_file::{MeasuredData, ModelFile, Units};
use serde::Serialize;

use crate::facts::variable_unit;
use crate::figures::{count, number, rounded, seconds, some_of, symbol, unit, with_unit};
use crate::optimize::{Evaluations, MovedHardpoint, moved};
use crate::page::{Curve, Fact, Payload, SweepAxis, SweepPlot, Table};

/// A residual of more standard deviations than this is reported: of a thousand normal ones three are.
const FAR: f64 = 3.0;
/// That many of them are listed.
const LISTED: usize = 10;
/// Variables that go together by more than this are reported as a pair.
const TOGETHER: f64 = 0.95;
/// The scatter of residuals fits what was given where it is within that many standard deviations of 1.
const FITS: f64 = 4.0;
/// A part of an untold direction that is less than this is not shown.
const SLIGHT: f64 = 1e-4;

/// A calibration, in the model's units. As JSON it is `summary.json` of `hardpoint calibrate`.
#[derive(Clone, Debug, Serialize)]
pub struct CalibrateFacts {
    /// Program and version.
    pub generator: String,
    /// The kind of study.
    pub study: &'static str,
    /// The model's name.
    pub model: String,
    /// The model file.
    pub file: String,
    /// The file of what was measured.
    pub data: String,
    /// Status at the end: `found`, `not_told` (found, but not all variables are determined), `iteration_limit` or
    /// `interrupted`.
    pub status: &'static str,
    /// The same in words, and what to do.
    pub message: String,
    /// The sum of squared residuals, or of the loss, in standard deviations: in the design configuration, and of the
    /// design found.
    pub objective: [f64; 2],
    /// Cost of the search.
    pub evaluations: Evaluations,
    /// Readings that were compared.
    pub readings: usize,
    /// Postures that they are of.
    pub postures: usize,
    /// Readings less what they tell.
    pub freedom: usize,
    /// Standard deviation of the residuals: in those that were given, 1 where all is as it says; else in
    /// `scatter_unit`.
    pub scatter: Option<f64>,
    /// The unit of that; empty where standard deviations were given.
    pub scatter_unit: String,
    /// The variables that were sought.
    pub variables: Vec<CalibratedVariable>,
    /// Pairs of variables that these readings hardly distinguishes, with their correlation.
    pub together: Vec<(String, String, f64)>,
    /// Changes that the readings do not determine.
    pub untold: Vec<UntoldFact>,
    /// Variables that the mechanism cannot follow, and that stay.
    pub left_out: Vec<String>,
    /// Drivers that the file does not name: they stand in the design configuration.
    pub as_drawn: Vec<String>,
    /// Hardpoints that the design found has elsewhere.
    pub hardpoints: Vec<MovedHardpoint>,
    /// Readings that are far off, the farthest first.
    pub far_off: Vec<FarOff>,
    /// Total number.
    pub far_off_count: usize,
    /// Postures that the mechanism in the design configuration does not reach: their readings are left out.
    pub not_reached: Vec<NotReachedFact>,
    /// Further readings with the most information, the best first.
    pub next: Vec<NextFact>,
    /// The files that were written.
    pub files: Vec<String>,
    /// Duration, s.
    pub seconds: f64,
}

/// A variable that was sought.
#[derive(Clone, Debug, Serialize)]
pub struct CalibratedVariable {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// In the design configuration; of a parameter its value, of all others the change, 0.
    pub start: f64,
    /// In the design found.
    pub end: f64,
    /// Standard deviation; `null` where the readings do not tell it.
    pub sigma: Option<f64>,
}

/// A change that the readings do not determine.
#[derive(Clone, Debug, Serialize)]
pub struct UntoldFact {
    /// The variables that go together, by how much, and their units: the largest part is 1.
    pub variables: Vec<(String, f64, String)>,
    /// The standard deviation of that, as a multiple; `null` where the readings tell nothing of it.
    pub sigma: Option<f64>,
}

/// A reading far from what the design found gives.
#[derive(Clone, Debug, Serialize)]
pub struct FarOff {
    /// The line of the file.
    pub line: u64,
    /// Column of the reading.
    pub column: String,
    /// That, and what the design found gives.
    pub values: [f64; 2],
    /// Their unit.
    pub unit: String,
    /// The difference in standard deviations.
    pub residual: f64,
    /// Weight in the fit, from 0 to 1.
    pub weight: f64,
}

/// A posture that is not reached.
#[derive(Clone, Debug, Serialize)]
pub struct NotReachedFact {
    /// The line of the file.
    pub line: u64,
    /// Description of the event.
    pub why: String,
}

/// A further reading.
#[derive(Clone, Debug, Serialize)]
pub struct NextFact {
    /// Reading to take.
    pub measure: String,
    /// The standard deviation that is assumed, with `unit`.
    pub sigma: f64,
    /// Unit.
    pub unit: String,
    /// Values of the drivers: name, value, unit.
    pub drivers: Vec<(String, f64, String)>,
    /// The number of what is not reported, from 1, that it would tell.
    pub tells: Option<usize>,
    /// The variable that it makes surest.
    pub variable: Option<String>,
    /// Standard deviation now, and with the reading.
    pub sigmas: Option<[f64; 2]>,
    /// The variable's unit.
    pub variable_unit: Option<String>,
}

/// Inputs of the facts.
#[derive(Clone, Copy, Debug)]
pub struct CalibrationInputs<'a> {
    /// The model file.
    pub file: &'a ModelFile,
    /// Measurements, and the name of their file.
    pub measured: &'a MeasuredData,
    /// The file of what was measured.
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

    /// Readings that were compared, with what they are beside.
    fn compared(&self) -> impl Iterator<Item = (&Reading, &FittedReading)> {
        let readings = &self.measured.measurements.readings;
        readings.iter().zip(&self.found.fitted).filter_map(|(r, f)| Some((r, f.as_ref()?)))
    }

    /// Values of the drivers in a posture: name, value, unit.
    fn stands(&self, places: &[f64]) -> Vec<(String, f64, String)> {
        let model = self.model();
        let of = |(driver, place): (&hardpoint::model::Driver, &f64)| {
            let quantity = model.driven(driver).quantity;
            let shown = self.units().from_si(quantity, *place);
            (driver.name.clone(), shown, symbol(self.units(), quantity).to_owned())
        };
        model.drivers.iter().zip(places).map(of).collect()
    }

    /// Residuals as points over where the drivers stood.
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
                name: format!("{} found less measured", self.output(m).name),
                unit: self.unit_of(m),
                metric: true,
                values: values.into_iter().collect(),
            });
        }
        SweepPlot { what: "posture".into(), designs: postures.len(), step: 1, axes, indices: Vec::new() }
    }

    /// A row for each reading: the line, where the drivers stood, what was read and found, the difference, its weight.
    ///
    /// # Errors
    /// Where `out` cannot be written.
    pub fn write_residuals(&self, out: impl Write) -> csv::Result<()> {
        let drivers = &self.model().drivers;
        let mut header = vec!["line".to_owned(), "measured what".into()];
        header
            .extend(self.stands(&vec![0.0; drivers.len()]).into_iter().map(|(n, _, u)| format!("{n} [{u}]")));
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
            row.extend(self.stands(places).into_iter().map(|(_, place, _)| text(Some(place))));
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

    /// The covariance of the variables, over what is reported: a row and a column for each, in products of their units.
    ///
    /// # Errors
    /// Where `out` cannot be written.
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
    /// Those of a calibration.
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
        let mut far_off: Vec<FarOff> = of
            .compared()
            .filter(|(_, f)| f.residual.abs() > FAR)
            .map(|(r, f)| FarOff {
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
                FitStatus::Found if certainty.untold.is_empty() => "found",
                FitStatus::Found => "not_told",
                FitStatus::IterationLimit => "iteration_limit",
                FitStatus::Interrupted => "interrupted",
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
            untold: certainty.untold.iter().map(|u| untold(of, u)).collect(),
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
            // A chi square of n degrees of freedom, as a standard deviation: 1 within 1 / sqrt(2 n).
            Some(s) if (s - 1.0).abs() * (2.0 * self.freedom as f64).sqrt() > FITS => {
                let than = if s > 1.0 {
                    "larger: something else is off, or they were measured less exactly"
                } else {
                    "smaller: they were measured more exactly"
                };
                format!(
                    "; the residuals are {} times what the standard deviations say, {than}",
                    rounded(s, 3)
                )
            }
            Some(_) => "; the residuals are as large as the standard deviations say".into(),
            None => String::new(),
        };
        match self.status {
            "found" => format!("found: all {} are reported{fit}", count(self.variables.len(), "variable")),
            "not_told" => format!(
                "found, but {} of the design {} not reported by these readings{fit}",
                count(self.untold.len(), "direction"),
                if self.untold.len() == 1 { "is" } else { "are" }
            ),
            "interrupted" => "interrupted: the best design so far".into(),
            _ => {
                "the iterations are used up before the best fit was reached: give more `--iterations`".into()
            }
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
                format!("{} of the standard deviations given", rounded(scatter, 3))
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
            "looked at",
            format!("{}, {} postures", count(self.evaluations.designs, "design"), self.evaluations.motions),
        ));
        rows.push(("time taken", seconds(self.seconds)));
        rows
    }

    /// Further tables: variables, unidentifiable changes, readings far off, readings to add.
    pub fn tables(&self) -> Vec<Table> {
        let header = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>();
        let table = |title: &str, note: &str, names: &[&str], rows: Vec<Vec<String>>| {
            let (title, note) = (title.to_owned(), note.to_owned());
            (!rows.is_empty()).then(|| Table { title, note, header: header(names), rows })
        };
        let variable = |v: &CalibratedVariable| {
            let sigma = v.sigma.map_or("not reported".into(), |s| format!("± {}", with_unit(s, &v.unit)));
            let change = v.end - v.start;
            let sure = v.sigma.filter(|s| *s > 0.0).map_or(String::new(), |s| rounded(change / s, 3));
            vec![v.name.clone(), with_unit(v.start, &v.unit), with_unit(v.end, &v.unit), sigma, sure]
        };
        let together = |(a, b, r): &(String, String, f64)| vec![a.clone(), b.clone(), rounded(*r, 4)];
        let untold = |(k, u): (usize, &UntoldFact)| {
            let parts: Vec<String> =
                u.variables.iter().map(|(name, by, unit)| format!("{name} {}", signed(*by, unit))).collect();
            let sigma = u.sigma.map_or("nothing".into(), |s| format!("± {} times that", rounded(s, 3)));
            vec![(k + 1).to_string(), parts.join(", "), sigma]
        };
        let far = |f: &FarOff| {
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
                (Some(k), ..) => format!("indicates {k}, which is not reported"),
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
                &["variable", "nominal", "found", "standard deviation", "change in these"],
                self.variables.iter().map(variable).collect(),
            ),
            table(
                "Hardly distinguished",
                "Variables whose errors go together; what they do together is reported better than each.",
                &["variable", "and", "correlation"],
                self.together.iter().map(together).collect(),
            ),
            table(
                "Not reported",
                "Changes of the design that change nothing that was read, or too little. The design found has none of them.",
                &["", "a change by", "information of the readings"],
                self.untold.iter().enumerate().map(untold).collect(),
            ),
            table("Hardpoints that move", "", &["hardpoint", "nominal", "optimised"], self.hardpoints.iter().map(moved).collect()),
            table(
                "Readings far off",
                "By more than three standard deviations.",
                &["line", "measured what", "measured", "found", "standard deviations", "counted"],
                self.far_off.iter().map(far).collect(),
            ),
            table(
                "What to measure next",
                "One more reading each, the best of its kind.",
                &["measure", "where", "read to", "what that does"],
                self.next.iter().map(next).collect(),
            ),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// The page of the design found becomes that of the calibration: residuals as points, and what is reported here
    /// first among its checks.
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

fn untold(of: &CalibrationInputs<'_>, untold: &UnidentifiableChange) -> UntoldFact {
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
    UntoldFact { variables, sigma: untold.sigma.map(|s| s * most) }
}

fn next(of: &CalibrationInputs<'_>, next: &NextReading, variables: &[CalibratedVariable]) -> NextFact {
    let improves = next.improves.as_ref();
    let variable = improves.map(|i| &variables[i.variable]);
    let in_units = |i: &hardpoint::study::Improvement| {
        let quantity: Quantity = of.model().variables[of.found.variables[i.variable].0].quantity;
        [i.before, i.after].map(|s| of.units().from_si(quantity, s))
    };
    NextFact {
        measure: of.output(next.output).name.clone(),
        sigma: of.shown(next.output, next.sigma),
        unit: of.unit_of(next.output),
        drivers: of.stands(&next.drivers),
        tells: next.tells.map(|k| k + 1),
        variable: variable.map(|v| v.name.clone()),
        sigmas: improves.map(in_units),
        variable_unit: variable.map(|v| v.unit.clone()),
    }
}

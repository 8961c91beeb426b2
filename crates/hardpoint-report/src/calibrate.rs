//! Result of a calibration: the fitted geometry, its accuracy, and unidentifiable changes, in the model's units.

use std::io::Write;

use hardpoint::measure::Output;
use hardpoint::model::{Dimension, DriverId, ElementId, Model, Reading};
use hardpoint_file::{MeasuredData, ModelFile, Units};
use hardpoint_study::calibrate::{
    BoundSide, Calibration, FittedParameter, FittedReading, Loss, NextReading, Status, UnidentifiableChange,
    UnreachedPosture, ValidatedReading, Validation,
};
use hardpoint_table::csv::CsvWriter;
use serde::Serialize;

use crate::figures::{count, number, rounded, seconds, some_of, symbol, unit, variable_unit, with_unit};
use crate::page::{Curve, Fact, Payload, SweepAxis, SweepPlot, Table};
use crate::record::{Column, record, write_rows};
use crate::study::{Evaluations, MovedHardpoint, VALUES, nominal_number, range, signed, value_of};

/// Residuals of more standard deviations than this are reported; about three of a thousand normal residuals are.
const FAR: f64 = 3.0;
/// Maximum number of listed residuals.
const LISTED: usize = 10;
/// Correlation above which two variables are reported as a pair.
const TOGETHER: f64 = 0.95;
/// Probability below which a scatter of residuals disagrees with the given standard deviations, on either side: that of
/// a normal deviation of more than four standard deviations.
const UNLIKELY: f64 = 3.17e-5;
/// Largest posterior standard deviation, as a fraction of the prior one, of a variable that is learnt from the data:
/// its variance is then at most half of the prior's, so that the data carry no less information than the prior.
const LEARNT: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Components of an unidentifiable direction below this fraction are not shown.
const SLIGHT: f64 = 1e-4;

/// Posture that is not reached.
#[derive(Clone, Debug, Serialize)]
pub struct NotReachedFact {
    /// Line of the measurement file.
    pub line: u64,
    /// Description of the event, with the positions of the drivers.
    pub why: String,
}

impl NotReachedFact {
    fn of(of: &CalibrationInputs<'_>, data: &MeasuredData, unreached: &UnreachedPosture) -> Self {
        let UnreachedPosture { posture, why, last } = unreached;
        let (model, target) = (of.model(), &data.measurements.postures[*posture]);
        // Drivers that stay in the design configuration are of no interest.
        let moved = |d: &usize| target[*d] != model.as_drawn(DriverId(*d));
        let moved: Vec<usize> = (0..target.len()).filter(moved).collect();
        let one = |d: usize, x: f64| {
            let (driver, units) = (&model.drivers[d], of.units());
            let quantity = model.driven(driver).quantity;
            let shown = with_unit(units.from_si(quantity, x), symbol(units, quantity));
            format!("{} = {shown}", driver.name)
        };
        let place = |at: &[f64]| moved.iter().map(|d| one(*d, at[*d])).collect::<Vec<_>>().join(", ");
        let why = match last {
            Some(last) if !moved.is_empty() => {
                format!("{why} at {}, on the path to {}", place(last), place(target))
            }
            Some(_) | None => why.clone(),
        };
        Self { line: data.lines[*posture], why }
    }
}

record! {
    /// Result of a calibration, in the model's units. Serialised as `summary.json` of `hardpoint calibrate`.
    CalibrateFacts::without_message(of: &CalibrationInputs<'_>) {
        let (model, units, found) = (of.model(), of.units(), of.found);
        let certainty = &found.certainty;
        let variables = (0..found.parameters.len()).map(|k| CalibratedVariable::of(of, k));
        let variables: Vec<CalibratedVariable> = variables.collect();
        let mut far_off: Vec<LargeResidual> = of
            .compared()
            .filter(|(_, f)| f.residual.abs() > FAR)
            .map(|(r, f)| LargeResidual::of(of, r, f))
            .collect();
        far_off.sort_by(|a, b| b.residual.abs().total_cmp(&a.residual.abs()));
        let far_off_count = far_off.len();
        far_off.truncate(LISTED);
        let names = |list: &[FittedParameter]| list.iter().map(|p| of.name_of(*p)).collect::<Vec<_>>();
        let readings = of.compared().count();
        let mut postures: Vec<usize> = of.compared().map(|(r, _)| r.posture).collect();
        postures.dedup();
        let scatter_of = of.compared().next().filter(|_| !of.has_sigmas()).map(|(r, _)| r.output);
        let not_reached = found.not_reached.iter().map(|n| NotReachedFact::of(of, of.measured, n));
        let status = match found.status {
            Status::Found if certainty.unidentifiable.is_empty() => "found",
            Status::Found => "not_told",
            Status::Stuck => "stuck",
            Status::Diverged => "diverged",
            Status::IterationLimit => "iteration_limit",
            Status::Interrupted => "interrupted",
        };
        let next = found.next.iter().map(|n| NextFact::of(of, n, &variables)).collect();
        let together = together(&certainty.covariance, &variables);
    }
    /// Program and version.
    generator: String = crate::GENERATOR.into();
    /// Kind of study.
    study: &'static str = "calibrate";
    /// Name of the model.
    model: String = model.name.clone();
    /// Name of the model file.
    file: String = of.file.file_name().into();
    /// Name of the measurement file.
    data: String = of.data.into();
    /// Status at the end: `found`, `not_told` (found, but the readings do not determine all variables),
    /// `stuck`, `diverged`, `iteration_limit` or `interrupted`.
    status: &'static str = status;
    /// Status in words, with an instruction.
    message: String = String::new();
    /// Objective of the nominal and the fitted design: sum of squared residuals, or of the loss, in standard
    /// deviations, with those of the priors.
    objective: [f64; 2] = found.objective;
    /// Cost of the search.
    evaluations: Evaluations = Evaluations::of(found.cost);
    /// Number of compared readings.
    readings: usize = readings;
    /// Number of postures of these readings.
    postures: usize = postures.len();
    /// Degrees of freedom: readings and priors minus determined directions.
    freedom: usize = certainty.freedom;
    /// Standard deviation of the residuals: relative to the given standard deviations, where 1 is expected, otherwise
    /// in `scatter_unit`.
    scatter: Option<f64> = certainty.scatter.map(|s| scatter_of.map_or(s, |m| of.shown(m, s)));
    /// Unit of `scatter`; empty if standard deviations are given.
    scatter_unit: String = scatter_of.map_or(String::new(), |m| of.unit_of(m));
    /// Fitted variables, then offsets.
    variables: Vec<CalibratedVariable> = variables;
    /// Number of fitted variables and offsets with a prior.
    priors: usize = certainty.prior_sigmas.iter().flatten().count();
    /// Pairs of variables that the readings hardly distinguish, with their correlation.
    together: Vec<(String, String, f64)> = together;
    /// Changes that the readings do not determine.
    untold: Vec<UnidentifiableFact> = certainty.unidentifiable.iter().map(|u| UnidentifiableFact::of(of, u)).collect();
    /// Changes that the priors determine rather than the readings.
    by_prior: Vec<UnidentifiableFact> = certainty.by_prior.iter().map(|u| UnidentifiableFact::of(of, u)).collect();
    /// Variables that the mechanism cannot follow. They keep their design values.
    left_out: Vec<String> = names(&found.left_out);
    /// Drivers without a column in the measurement file. They stay in the design configuration.
    as_drawn: Vec<String> = of.measured.as_drawn.iter().map(|d| model.drivers[d.0].name.clone()).collect();
    /// Hardpoints that the fitted design moves.
    hardpoints: Vec<MovedHardpoint> = MovedHardpoint::all(model, units, &found.design);
    /// Readings with large residuals, the largest first.
    far_off: Vec<LargeResidual> = far_off;
    /// Number of readings with large residuals.
    far_off_count: usize = far_off_count;
    /// Postures that the nominal design does not reach. Their readings are left out.
    not_reached: Vec<NotReachedFact> = not_reached.collect();
    /// Proposed further readings, the most informative first.
    next: Vec<NextFact> = next;
    /// Residuals of data that were not fitted; `null` without such data.
    validation: Option<ValidationFact> = of.validation.zip(found.validation.as_ref()).map(|(data, v)| ValidationFact::of(of, data, v));
    /// Written files.
    files: Vec<String> = Vec::new();
    /// Duration, s.
    seconds: f64 = 0.0;
}

record! {
    /// Fitted variable, or offset.
    CalibratedVariable::of(of: &CalibrationInputs<'_>, k: usize) {
        let (parameter, certainty) = (of.found.parameters[k], &of.found.certainty);
        let shown = |x: f64| of.units().from_si(of.dimension_of(parameter), x);
        let start = match parameter {
            FittedParameter::Variable(v) => of.model().nominal_value(v),
            FittedParameter::Driver(_) | FittedParameter::Output(_) => 0.0,
        };
        let nominal = match parameter {
            FittedParameter::Variable(v) => nominal_number(of.file, &of.model().variables[v.0]),
            FittedParameter::Driver(_) | FittedParameter::Output(_) => None,
        };
        let by = of.found.estimates[k];
        let prior = certainty.prior_sigmas[k];
        let ratio = certainty.sigmas[k].zip(prior).map(|(s, p)| s / p);
        let source = match (certainty.bounds[k], certainty.sigmas[k], ratio) {
            (None, ..) if matches!(of.found.status, Status::Stuck | Status::Diverged) => "not fitted",
            (Some(BoundSide::Lower), ..) => "at its lower bound",
            (Some(BoundSide::Upper), ..) => "at its upper bound",
            (None, None, _) => "undetermined",
            (None, Some(_), None) => "no prior",
            (None, Some(_), Some(ratio)) if ratio <= LEARNT => "learnt from data",
            (None, Some(_), Some(_)) => "still your prior",
        };
    }
    /// Name.
    name: String = of.name_of(parameter);
    /// Unit.
    unit: String = of.unit_of_parameter(parameter);
    /// Nominal value: the value of a parameter, 0 for all other variables and offsets.
    start: f64 = shown(start);
    /// Fitted value: the value of a parameter, the change of all other variables.
    end: f64 = shown(start + by);
    /// Nominal value of the number that the variable changes; `null` if it changes none or several.
    nominal: Option<f64> = nominal.map(shown);
    /// Bounds of the change that the fit keeps; `null` without bounds.
    bounds: Option<[f64; 2]> = of.found.bounds[k].map(|bounds| bounds.map(shown));
    /// Standard deviation; `null` if the readings and priors do not determine it, it is at a bound, or the search got
    /// stuck or diverged.
    sigma: Option<f64> = certainty.sigmas[k].map(shown);
    /// Mean of its prior; `null` without a prior of its own.
    prior_mean: Option<f64> = certainty.prior_means[k].map(|mean| shown(start + mean));
    /// Standard deviation by the priors alone; `null` without a prior.
    prior_sigma: Option<f64> = prior.map(shown);
    /// Fitted value minus mean of the prior, in standard deviations of the prior.
    pull: Option<f64> = certainty.prior_means[k].zip(prior).map(|(mean, p)| (by - mean) / p);
    /// Source of the result: `learnt from data`, `still your prior`, `no prior`, `undetermined`, `not fitted` (the
    /// search got stuck), `at its lower bound` or `at its upper bound`.
    source: &'static str = source;
}

record! {
    /// A change that the readings do not determine.
    UnidentifiableFact::of(of: &CalibrationInputs<'_>, untold: &UnidentifiableChange) {
        let shown = |k: usize| {
            let parameter = of.found.parameters[k];
            (parameter, of.units().from_si(of.dimension_of(parameter), untold.direction[k]))
        };
        let all = 0..untold.direction.len();
        let most = all.clone().map(|k| shown(k).1.abs()).fold(0.0, f64::max);
        let part = |k: usize| {
            let (parameter, by) = shown(k);
            (of.name_of(parameter), by / most, of.unit_of_parameter(parameter))
        };
        let variables = all.map(part).filter(|(_, by, _)| by.abs() > SLIGHT).collect();
    }
    /// Changed variables with their changes and units; the largest change is 1.
    variables: Vec<(String, f64, String)> = variables;
    /// Standard deviation as a multiple of that change; `null` if the readings do not determine it at all.
    sigma: Option<f64> = untold.sigma.map(|s| s * most);
}

record! {
    /// Reading with a large residual.
    LargeResidual::of(of: &CalibrationInputs<'_>, r: &Reading, f: &FittedReading) {}
    /// Line of the measurement file.
    line: u64 = of.measured.lines[r.posture];
    /// Column of the reading.
    column: String = of.output(r.output).name.clone();
    /// Measured and fitted value, in `unit`.
    values: [f64; 2] = [r.value, f.value].map(|x| of.shown(r.output, x));
    /// Unit of the values.
    unit: String = of.unit_of(r.output);
    /// Fitted minus measured value, in standard deviations.
    residual: f64 = f.residual;
    /// Weight in the fit, from 0 to 1.
    weight: f64 = f.weight;
}

record! {
    /// Proposed reading.
    NextFact::of(of: &CalibrationInputs<'_>, next: &NextReading, variables: &[CalibratedVariable]) {
        let improves = next.improves.as_ref();
        let variable = improves.map(|i| &variables[i.variable]);
        let in_units = |i: &hardpoint_study::calibrate::Improvement| {
            let dimension = of.dimension_of(of.found.parameters[i.variable]);
            [i.before, i.after].map(|s| of.units().from_si(dimension, s))
        };
    }
    /// Reading to take.
    measure: String = of.output(next.output).name.clone();
    /// Assumed standard deviation, in `unit`.
    sigma: f64 = of.shown(next.output, next.sigma);
    /// Unit of `sigma`.
    unit: String = of.unit_of(next.output);
    /// Values of the drivers, and of the laws of given forces: name, value, unit.
    drivers: Vec<(String, f64, String)> = of.place(&next.drivers, &next.forces);
    /// Number of the unidentifiable change, from 1, that the reading would determine.
    tells: Option<usize> = next.determines.map(|k| k + 1);
    /// Variable whose standard deviation it reduces most.
    variable: Option<String> = variable.map(|v| v.name.clone());
    /// Standard deviation of that variable without and with the reading, in `variable_unit`.
    sigmas: Option<[f64; 2]> = improves.map(in_units);
    /// Unit of the variable.
    variable_unit: Option<String> = variable.map(|v| v.unit.clone());
}

record! {
    /// Residuals of data that were not fitted.
    ValidationFact::of(of: &CalibrationInputs<'_>, data: (&MeasuredData, &str), found: &Validation) {
        let (data, name) = data;
        let compared: Vec<(&Reading, &ValidatedReading)> = data.measurements.readings.iter().zip(&found.readings)
            .filter_map(|(r, v)| Some((r, v.as_ref()?))).collect();
        let standard = |(r, v): &(&Reading, &ValidatedReading)| {
            Some((v.value - r.value) / v.sigma.filter(|s| *s > 0.0)?)
        };
        let standard: Vec<f64> = compared.iter().filter_map(standard).collect();
        let mut outputs: Vec<usize> = compared.iter().map(|(r, _)| r.output).collect();
        outputs.sort_unstable();
        outputs.dedup();
        let measures = outputs.into_iter().map(|m| {
            let of_output = compared.iter().filter(|(r, _)| r.output == m).copied().collect::<Vec<_>>();
            ValidatedMeasure::of(of, m, &of_output)
        });
        let not_reached = found.not_reached.iter().map(|n| NotReachedFact::of(of, data, n));
    }
    /// Name of the file.
    data: String = name.into();
    /// Number of compared readings.
    readings: usize = compared.len();
    /// Number of these without a predicted standard deviation, as they depend on changes that are not determined.
    unpredicted: usize = compared.iter().filter(|(_, v)| v.sigma.is_none()).count();
    /// Root mean square of the residuals, in predicted standard deviations, where 1 is expected; `null` if there are
    /// none.
    scatter: Option<f64> = root_mean_square(&standard);
    /// Residuals of each measure.
    measures: Vec<ValidatedMeasure> = measures.collect();
    /// Postures that the fitted design does not reach.
    not_reached: Vec<NotReachedFact> = not_reached.collect();
}

record! {
    /// Residuals of a measure in data that were not fitted, in its unit.
    ValidatedMeasure::of(of: &CalibrationInputs<'_>, m: usize, compared: &[(&Reading, &ValidatedReading)]) {
        let residuals: Vec<f64> = compared.iter().map(|(r, v)| of.shown(m, v.value - r.value)).collect();
        let sigmas: Option<Vec<f64>> = compared.iter().map(|(_, v)| Some(of.shown(m, v.sigma?))).collect();
    }
    /// Name.
    name: String = of.output(m).name.clone();
    /// Unit.
    unit: String = of.unit_of(m);
    /// Number of readings.
    readings: usize = residuals.len();
    /// Mean of fitted minus measured values.
    mean: f64 = residuals.iter().sum::<f64>() / residuals.len() as f64;
    /// Root mean square of the residuals.
    rms: f64 = root_mean_square(&residuals).unwrap_or_default();
    /// Residual of the largest magnitude.
    largest: f64 = residuals.iter().copied().fold(0.0, |most: f64, r| if r.abs() > most.abs() { r } else { most });
    /// Predicted root mean square: that of the readings and of the fitted variables; `null` if a reading depends on
    /// changes that are not determined.
    predicted: Option<f64> = sigmas.and_then(|sigmas| root_mean_square(&sigmas));
}

/// Returns true if a chi square of n degrees of freedom is hardly ever so small, or so large.
fn is_unlikely(chi_square: f64, freedom: usize) -> bool {
    let below = chi_square_probability(chi_square, freedom);
    below < UNLIKELY || 1.0 - below < UNLIKELY
}

/// Probability that a chi square of n degrees of freedom is at most `chi_square`: with a = n/2 and x = chi_square/2,
/// P(a, x) = x^a exp(-x) / Gamma(a + 1) (1 + x/(a + 1) + x^2/((a + 1)(a + 2)) + ...).
fn chi_square_probability(chi_square: f64, freedom: usize) -> f64 {
    let (a, x) = (0.5 * freedom as f64, 0.5 * chi_square);
    if !(x > 0.0) {
        return 0.0;
    }
    // Gamma(a + 1) = a (a - 1) ... Gamma(1) or Gamma(1/2), Gamma(1) = 1, Gamma(1/2) = sqrt(pi)
    let rest = if freedom.is_multiple_of(2) { 0.0 } else { 0.5 * std::f64::consts::PI.ln() };
    let log_gamma = rest + (0..freedom.div_ceil(2)).map(|k| (a - k as f64).ln()).sum::<f64>();
    let (mut term, mut sum, mut k) = (1.0, 1.0, a);
    // The terms grow up to k = x, then fall; their sum is below exp(x).
    while term > f64::EPSILON * sum && sum.is_finite() {
        k += 1.0;
        term *= x / k;
        sum += term;
    }
    let log = a * x.ln() - x - log_gamma + sum.ln();
    // A sum beyond the range of numbers is one of a very large chi square.
    if log.is_finite() { log.exp().min(1.0) } else { 1.0 }
}

fn root_mean_square(x: &[f64]) -> Option<f64> {
    (!x.is_empty()).then(|| (x.iter().map(|x| x * x).sum::<f64>() / x.len() as f64).sqrt())
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
    /// Measurements that were not fitted, with the name of their file.
    pub validation: Option<(&'a MeasuredData, &'a str)>,
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

    /// Name of a fitted parameter.
    fn name_of(&self, parameter: FittedParameter) -> String {
        match parameter {
            FittedParameter::Variable(v) => self.model().variables[v.0].name.clone(),
            FittedParameter::Driver(d) => format!("offset of {}", self.model().drivers[d.0].name),
            FittedParameter::Output(m) => format!("offset of {}", self.output(m).name),
        }
    }

    fn dimension_of(&self, parameter: FittedParameter) -> Dimension {
        let model = self.model();
        match parameter {
            FittedParameter::Variable(v) => model.variables[v.0].quantity.into(),
            FittedParameter::Driver(d) => model.driven(&model.drivers[d.0]).quantity.into(),
            FittedParameter::Output(m) => self.output(m).dimension,
        }
    }

    fn unit_of_parameter(&self, parameter: FittedParameter) -> String {
        let model = self.model();
        match parameter {
            FittedParameter::Variable(v) => variable_unit(model, self.units(), &model.variables[v.0]),
            FittedParameter::Driver(d) => {
                symbol(self.units(), model.driven(&model.drivers[d.0]).quantity).into()
            }
            FittedParameter::Output(m) => self.unit_of(m),
        }
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

    /// Values of the drivers, and of the laws of forces.
    fn place(&self, drivers: &[f64], forces: &[(ElementId, f64)]) -> Vec<(String, f64, String)> {
        let force =
            |(e, value): &(ElementId, f64)| (self.model().elements[e.0].name.clone(), *value, String::new());
        self.driver_values(drivers).into_iter().chain(forces.iter().map(force)).collect()
    }

    /// Plot of the residuals over the driver positions.
    pub fn plot(&self) -> SweepPlot {
        let (model, units) = (self.model(), self.units());
        let postures = &self.measured.measurements.postures;
        let mut axes = vec![SweepAxis {
            name: "line".into(),
            unit: "1".into(),
            metric: false,
            nominal: None,
            target: None,
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
                    nominal: None,
                    target: None,
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
                nominal: None,
                target: None,
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
        // The values of the drivers are those of the posture.
        type Row<'a> = (&'a Reading, &'a Option<FittedReading>, Vec<(String, f64, String)>);
        let text = |x: Option<f64>| x.filter(|x| x.is_finite()).map_or(String::new(), |x| format!("{x:?}"));
        let shown = |r: &Row<'_>, x: Option<f64>| text(x.map(|x| self.shown(r.0.output, x)));
        let drivers = self.driver_values(&vec![0.0; self.model().drivers.len()]).into_iter();
        let titles: Vec<String> = drivers.map(|(n, _, u)| format!("{n} [{u}]")).collect();
        let places: Vec<_> = (0..titles.len()).map(|d| move |r: &Row<'_>| text(Some(r.2[d].1))).collect();
        let before: [Column<'_, Row<'_>>; 2] = [
            ("line", &|r| self.measured.lines[r.0.posture].to_string()),
            ("measurement", &|r| self.output(r.0.output).name.clone()),
        ];
        let after: [Column<'_, Row<'_>>; 7] = [
            ("unit", &|r| self.unit_of(r.0.output)),
            ("measured", &|r| shown(r, Some(r.0.value))),
            ("nominal", &|r| shown(r, r.1.as_ref().map(|f| f.before))),
            ("found", &|r| shown(r, r.1.as_ref().map(|f| f.value))),
            ("standard deviation", &|r| shown(r, r.0.sigma)),
            ("residual [standard deviations]", &|r| text(r.1.as_ref().map(|f| f.residual))),
            ("weight", &|r| text(r.1.as_ref().map(|f| f.weight))),
        ];
        let places = titles.iter().zip(&places).map(|(title, place)| (title.as_str(), place as _));
        let columns: Vec<Column<'_, Row<'_>>> = before.into_iter().chain(places).chain(after).collect();
        let measurements = &self.measured.measurements;
        let places = |r: &Reading| self.driver_values(&measurements.postures[r.posture]);
        let rows = measurements.readings.iter().zip(&self.found.fitted).map(|(r, f)| (r, f, places(r)));
        write_rows(out, &columns, rows)
    }

    /// Writes the covariance of the variables over the directions with a standard deviation: a row and a column for
    /// each, in products of their units.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn write_covariance(&self, out: impl Write) -> csv::Result<()> {
        let name = |p: &FittedParameter| format!("{} [{}]", self.name_of(*p), self.unit_of_parameter(*p));
        let names: Vec<String> = self.found.parameters.iter().map(name).collect();
        let mut writer = CsvWriter::new(out);
        let header = std::iter::once("covariance").chain(names.iter().map(String::as_str));
        writer.row(header)?;
        let scale = |k: usize| self.units().from_si(self.dimension_of(self.found.parameters[k]), 1.0);
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
        let mut facts = Self::without_message(of);
        facts.message = facts.sentence(of);
        facts
    }

    fn sentence(&self, of: &CalibrationInputs<'_>) -> String {
        let fit = match self.scatter.filter(|_| of.has_sigmas()) {
            // n s^2 is a chi square of n degrees of freedom.
            Some(s) if is_unlikely(s * s * self.freedom as f64, self.freedom) => {
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
                let by = if self.priors > 0 { "readings and the priors" } else { "readings" };
                let has_offsets =
                    of.found.parameters.iter().any(|p| !matches!(p, FittedParameter::Variable(_)));
                let what = if has_offsets { "parameter" } else { "variable" };
                let of_priors = match self.by_prior.len() {
                    0 => String::new(),
                    1 => "; 1 direction is determined by the priors".into(),
                    n => format!("; {n} directions are determined by the priors"),
                };
                format!("found: the {by} determine all {}{of_priors}{fit}", count(self.variables.len(), what))
            }
            "not_told" => format!(
                "found, but {} of the design {} not determined by the readings{}{fit}",
                count(self.untold.len(), "direction"),
                if self.untold.len() == 1 { "is" } else { "are" },
                if self.priors > 0 { " and the priors" } else { "" }
            ),
            "stuck" => format!(
                "stuck, not at the best fit: better designs do not assemble, stop before a posture of the table, or \
                 cannot follow a fitted variable there; check the measurements, or fit other variables{fit}"
            ),
            "diverged" => "diverged: fitted values leave every sensible range, since the readings do not determine \
                           them or do not fit the mechanism; give `bounds` or priors, fit fewer variables, or check \
                           the readings"
                .into(),
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
        let at_bounds = self.variables.iter().filter(|v| v.source.starts_with("at its"));
        let at_bounds: Vec<String> = at_bounds.map(|v| format!("{} {}", v.name, v.source)).collect();
        if !at_bounds.is_empty() {
            rows.push(("bounds", format!("{}: the fit would leave its bounds", some_of(&at_bounds, ", "))));
        }
        if let Some(validation) = &self.validation {
            let scatter = validation.scatter.map_or(String::new(), |s| {
                format!(", residuals {} of the predicted standard deviations", rounded(s, 3))
            });
            let unpredicted = match validation.unpredicted {
                0 => String::new(),
                n if self.untold.is_empty() => {
                    format!(
                        ", {n} of them without a predicted standard deviation: the fit ended at no optimum"
                    )
                }
                n => format!(
                    ", {n} of them without a predicted standard deviation: they depend on changes that are not \
                     determined"
                ),
            };
            let readings = count(validation.readings, "reading");
            rows.push(("validated", format!("{readings}{unpredicted}{scatter}")));
            for n in validation.not_reached.iter().take(LISTED) {
                rows.push(("not reached", format!("validation data, line {}: {}", n.line, n.why)));
            }
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
        rows
    }

    /// Further tables: variables, unidentifiable changes, large residuals, proposed readings.
    pub fn tables(&self) -> Vec<Table> {
        let has_source = self.priors > 0 || self.variables.iter().any(|v| v.source.starts_with("at its"));
        let validated = self.validation.as_ref().and_then(|v| ValidatedMeasure::table(&v.measures));
        let by_prior = self.by_prior.iter().take(LISTED);
        let tables = [
            CalibratedVariable::design_table(&self.variables),
            CalibratedVariable::prior_table(&self.variables).filter(|_| has_source),
            UnidentifiableFact::table(
                "Determined by priors",
                "Changes of the design about which the priors contain more information than the readings.",
                by_prior,
            ),
            validated,
            correlation_table(&self.together),
            UnidentifiableFact::table(
                "Not determined",
                "Changes of the design that affect no reading, or too little. The fitted design contains none of them.",
                &self.untold,
            ),
            MovedHardpoint::table(&self.hardpoints, "fitted"),
            LargeResidual::table(&self.far_off),
            NextFact::table(&self.next),
        ];
        tables.into_iter().flatten().collect()
    }

    /// Turns the page of the fitted design into that of the calibration: residuals as points, and the result first
    /// among the checks.
    pub fn page(&self, of: &CalibrationInputs<'_>, mut page: Payload, outputs: &[Output]) -> Payload {
        let first = of.compared().next().map(|(r, _)| &of.output(r.output).name);
        page.first = first.and_then(|name| outputs.iter().position(|o| o.name == *name)).or(page.first);
        let fact = Fact { label: "readings".into(), value: self.readings.to_string() };
        page.summary.insert(0, fact);
        let duration = ("time taken", seconds(self.seconds));
        let lines = self.rows().into_iter().chain([duration]).collect();
        page.put_study("Calibration", lines, &["result", "residuals", "bounds"], self.tables());
        Payload { sweep: Some(of.plot()), ..page }
    }
}

impl CalibratedVariable {
    /// Fitted change.
    fn change(&self) -> f64 {
        self.end - self.start
    }

    /// Value after a change, or the change itself if there is no nominal value.
    fn value(&self, change: f64) -> f64 {
        value_of(self.nominal, change, self.bounds.unwrap_or_default())
    }

    /// Table of the variables before and after the readings, with their sources.
    fn prior_table(variables: &[Self]) -> Option<Table> {
        let columns: [Column<'_, &Self>; 6] = [
            ("variable", &|v| v.name.clone()),
            ("prior", &|v| match (v.prior_mean, v.prior_sigma) {
                (Some(mean), Some(sigma)) => {
                    format!("{} ± {}", number(v.value(mean - v.start)), with_unit(sigma, &v.unit))
                }
                (None, Some(sigma)) => format!("± {}", with_unit(sigma, &v.unit)),
                (_, None) => "none".into(),
            }),
            ("posterior", &|v| match v.sigma {
                Some(sigma) => format!("{} ± {}", number(v.value(v.change())), with_unit(sigma, &v.unit)),
                None => with_unit(v.value(v.change()), &v.unit),
            }),
            ("ratio", &|v| {
                let ratio = v.sigma.zip(v.prior_sigma).map(|(s, p)| s / p);
                ratio.map_or(String::new(), |ratio| rounded(ratio, 3))
            }),
            ("from prior / sigma", &|v| v.pull.map_or(String::new(), |p| rounded(p, 3))),
            ("source", &|v| v.source.into()),
        ];
        let note = "Learnt from data: the posterior standard deviation is at most 0.71 of the prior one.";
        Table::of("Prior and posterior", note, &columns, variables).if_any()
    }

    /// Table of the nominal and the fitted design.
    fn design_table(variables: &[Self]) -> Option<Table> {
        let columns: [Column<'_, &Self>; 7] = [
            ("variable", &|v| v.name.clone()),
            ("nominal", &|v| with_unit(v.value(0.0), &v.unit)),
            ("fitted", &|v| with_unit(v.value(v.change()), &v.unit)),
            ("standard deviation", &|v| {
                v.sigma.map_or(v.source.into(), |s| format!("± {}", with_unit(s, &v.unit)))
            }),
            ("change", &|v| signed(v.change(), &v.unit)),
            ("change / sigma", &|v| {
                let sigma = v.sigma.filter(|s| *s > 0.0);
                sigma.map_or(String::new(), |s| rounded(v.change() / s, 3))
            }),
            ("bounds", &|v| v.bounds.map_or(String::new(), |b| range(b.map(|b| v.value(b))))),
        ];
        Table::of("Design", VALUES, &columns, variables).if_any().map(Table::without_empty_columns)
    }
}

impl UnidentifiableFact {
    /// Table of changes of the design, numbered from 1, with their standard deviations.
    fn table<'a>(title: &str, note: &str, changes: impl IntoIterator<Item = &'a Self>) -> Option<Table> {
        let columns: [Column<'_, (usize, &Self)>; 3] = [
            ("", &|(k, _)| (k + 1).to_string()),
            ("change by", &|(_, u)| listed(&u.variables, signed)),
            ("standard deviation", &|(_, u)| {
                u.sigma.map_or("none".into(), |s| format!("± {} times that", rounded(s, 3)))
            }),
        ];
        Table::of(title, note, &columns, changes.into_iter().enumerate()).if_any()
    }
}

impl ValidatedMeasure {
    /// Table of the residuals of readings that were not fitted.
    fn table(measures: &[Self]) -> Option<Table> {
        let columns: [Column<'_, &Self>; 6] = [
            ("measurement", &|m| m.name.clone()),
            ("readings", &|m| m.readings.to_string()),
            ("mean", &|m| with_unit(m.mean, &m.unit)),
            ("root mean square", &|m| with_unit(m.rms, &m.unit)),
            ("predicted", &|m| m.predicted.map_or("not determined".into(), |p| with_unit(p, &m.unit))),
            ("largest", &|m| with_unit(m.largest, &m.unit)),
        ];
        let note = "Readings that were not fitted: fitted minus measured.";
        Table::of("Validation", note, &columns, measures).if_any()
    }
}

impl LargeResidual {
    /// Table of the largest residuals.
    fn table(residuals: &[Self]) -> Option<Table> {
        let columns: [Column<'_, &Self>; 6] = [
            ("line", &|f| f.line.to_string()),
            ("measurement", &|f| f.column.clone()),
            ("measured", &|f| with_unit(f.values[0], &f.unit)),
            ("fitted", &|f| with_unit(f.values[1], &f.unit)),
            ("residual / sigma", &|f| rounded(f.residual, 3)),
            ("weight", &|f| if f.weight < 1.0 { rounded(f.weight, 2) } else { "1".into() }),
        ];
        let note = "Residuals of more than three standard deviations.";
        Table::of("Large residuals", note, &columns, residuals).if_any()
    }
}

impl NextFact {
    /// Table of the proposed readings.
    fn table(readings: &[Self]) -> Option<Table> {
        let columns: [Column<'_, &Self>; 4] = [
            ("measure", &|n| n.measure.clone()),
            ("where", &|n| listed(&n.drivers, with_unit)),
            ("standard deviation", &|n| format!("± {}", with_unit(n.sigma, &n.unit))),
            ("effect", &|n| n.effect()),
        ];
        let note = "Most informative further reading of each measure.";
        Table::of("Proposed readings", note, &columns, readings).if_any()
    }

    /// Effect of the reading: the change that it determines, or the variable whose standard deviation it reduces most.
    fn effect(&self) -> String {
        match (self.tells, &self.variable, self.sigmas, &self.variable_unit) {
            (Some(k), ..) => format!("determines change {k}"),
            (None, Some(variable), Some([before, after]), Some(unit)) => {
                format!("{variable}: from ± {} to ± {}", number(before), with_unit(after, unit))
            }
            _ => String::new(),
        }
    }
}

/// Table of pairs of variables with correlated errors.
fn correlation_table(pairs: &[(String, String, f64)]) -> Option<Table> {
    let columns: [Column<'_, &(String, String, f64)>; 3] = [
        ("variable", &|(variable, ..)| variable.clone()),
        ("and", &|(_, other, _)| other.clone()),
        ("correlation", &|(.., correlation)| rounded(*correlation, 4)),
    ];
    let note = "Variables with correlated errors: their combination is determined better than each of them.";
    Table::of("Hardly distinguishable", note, &columns, pairs).if_any()
}

/// Names with their values and units.
fn listed(values: &[(String, f64, String)], shown: fn(f64, &str) -> String) -> String {
    let one = |(name, x, unit): &(String, f64, String)| format!("{name} {}", shown(*x, unit));
    values.iter().map(one).collect::<Vec<_>>().join(", ")
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

#[cfg(test)]
mod tests {
    use super::{chi_square_probability, is_unlikely};

    /// Tolerance of probabilities: tables have six digits.
    const TABLE: f64 = 1e-6;

    #[test]
    fn probabilities_of_chi_squares_are_those_of_tables() {
        // Two degrees of freedom: 1 - exp(-x/2). One: the normal distribution within one and two standard deviations.
        for x in [1e-9_f64, 0.1, 1.0, 5.0, 60.0] {
            let exact = -(-0.5 * x).exp_m1();
            assert!((chi_square_probability(x, 2) / exact - 1.0).abs() < 1e-12, "{x}");
        }
        let known = [
            (1.0, 1, 0.682_689),
            (4.0, 1, 0.954_500),
            (14.067_140, 7, 0.95),
            (18.307_038, 10, 0.95),
            (70.064_895, 100, 0.01),
            (1_074.679_449, 1000, 0.95),
        ];
        for (x, n, expected) in known {
            let found = chi_square_probability(x, n);
            assert!((found - expected).abs() < TABLE, "{x} {n}: {found}");
        }
        assert_eq!(chi_square_probability(1e6, 3), 1.0);
        assert_eq!(chi_square_probability(0.0, 3), 0.0);
    }

    #[test]
    fn residuals_can_be_too_small_at_any_number_of_degrees_of_freedom() {
        for n in [1, 2, 7, 8, 100, 100_000] {
            let of = |s: f64| is_unlikely(s * s * n as f64, n);
            let far = 6.0 / (2.0 * n as f64).sqrt();
            assert!(of(6.5e-13) && of(1.0 + far) && !of(1.0) && of(0.9) != (n < 1000), "{n}");
        }
    }
}

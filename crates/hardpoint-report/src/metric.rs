//! Metrics: values, sensitivities, and their changes in a changed design.

use std::io::Write;

use hardpoint::Solution;
use hardpoint::model::{DesignVariable, Dimension, Metric, Model};
use hardpoint::run::{MetricValue, metrics, metrics_beside};
use hardpoint_file::Units;
use hardpoint_study::whatif::WhatIf;
use hardpoint_table::csv::CsvWriter;

use crate::figures::{number, per, rounded, unit, variable_unit, with_unit};
use crate::page::{Payload, Table};
use crate::record::{Column, record};

/// Interpolation error, as a fraction of the curve's range (for a slope: of the slope), above which it is reported,
/// since metrics are read to three digits.
const COARSE: f64 = 1e-3;

record! {
    /// Value of a metric with its sensitivities, in the model's units.
    MetricFact::of(
        model: &Model, units: Units, metric: &Metric, found: &MetricValue, rigid: Option<f64>,
    ) {
        let dimension = model.metric_dimension(metric);
        let known = found.d.iter().zip(&model.variables).filter(|(d, _)| d.is_finite());
        let mut sensitivities: Vec<_> =
            known.map(|(d, variable)| MetricSensitivity::of(model, units, dimension, variable, *d)).collect();
        sensitivities.sort_by(|a, b| a.per.cmp(&b.per).then(b.value.abs().total_cmp(&a.value.abs())));
    }
    /// Name.
    name: String = metric.name.clone();
    /// Description in words.
    what: String = what(model, units, metric);
    /// Value; `null` if the motion does not reach the required position.
    value: Option<f64> = found.value.map(|x| units.from_si(dimension, x));
    /// Unit.
    unit: String = unit(units, dimension);
    /// Direction in which the value is positive, in words; empty for a size, and if the measure has no fixed one.
    positive: String = positive(model, metric);
    /// Value for the rigid mechanism: elastic joints closed, the same motion of the drivers; `null` without
    /// equilibrium, and where no driver moves.
    rigid: Option<f64> = rigid.map(|x| units.from_si(dimension, x));
    /// Time at which the metric is evaluated, s; `null` if it uses the whole curve.
    time: Option<f64> = found.time;
    /// Interpolation error between output times; `null` for a mean, and if there are too few output times to estimate
    /// it.
    interpolation_error: Option<f64> = found.error.map(|x| units.from_si(dimension, x));
    /// True if the interpolation error exceeds a thousandth of the curve's range.
    coarse: bool = found.error.is_some_and(|x| !(x <= COARSE * found.range));
    /// Sensitivities to every design variable that the mechanism can follow, the largest first within each unit of
    /// variables.
    sensitivities: Vec<MetricSensitivity> = sensitivities;
}

record! {
    /// Sensitivity of a metric to a design variable.
    pub(crate) MetricSensitivity::of(model: &Model, units: Units, of: Dimension, variable: &DesignVariable, d: f64) {
        let by = variable_unit(model, units, variable);
    }
    /// Name of the variable.
    variable: String = variable.name.clone();
    /// Unit of the variable.
    per: String = by.clone();
    /// Derivative.
    value: f64 = units.derivative_from_si(of, variable.quantity, d);
    /// Unit of the derivative.
    unit: String = per(&unit(units, of), &by);
}

record! {
    /// Metric of a changed design.
    MetricChange::of(
        model: &Model, units: Units, what_if: &WhatIf, metric: &Metric, today: &MetricValue, exact: Option<f64>,
    ) {
        let dimension = model.metric_dimension(metric);
        let shown = |x: Option<f64>| x.map(|x| units.from_si(dimension, x));
        let changed = what_if.change.iter().zip(&today.d).filter(|(by, _)| **by != 0.0);
        let first: f64 = changed.map(|(by, d)| by * d).sum();
    }
    /// Name.
    name: String = metric.name.clone();
    /// Unit.
    unit: String = unit(units, dimension);
    /// Nominal value.
    today: Option<f64> = shown(today.value);
    /// First-order prediction.
    first: Option<f64> = shown(today.value.map(|now| now + first).filter(|x| x.is_finite()));
    /// Exact value of the changed design.
    exact: Option<f64> = shown(exact);
}

/// Contents of a table of metrics.
#[derive(Clone, Copy, Debug)]
struct Shown {
    /// Definitions, or else the directions in which values are positive.
    definitions: bool,
    /// Number of most influential variables of each unit.
    variables: usize,
}

impl MetricFact {
    /// Metrics of a solution, with those of the rigid mechanism.
    pub fn all(model: &Model, units: Units, solution: &Solution, rigid: &[Option<f64>]) -> Vec<Self> {
        let values = metrics(model, solution).into_iter().zip(rigid);
        let of = |(metric, (value, rigid)): (_, (_, &_))| Self::of(model, units, metric, &value, *rigid);
        model.metrics.iter().zip(values).map(of).collect()
    }

    /// Table of the metrics with their most influential variables.
    pub fn table(facts: &[Self]) -> Option<Table> {
        let facts: Vec<(&str, &Self)> = facts.iter().map(|m| ("", m)).collect();
        Self::table_of("Metrics", &facts, Shown { definitions: true, variables: 3 })
    }

    /// Table for the page, whose cards have the definitions.
    pub(crate) fn page_table(facts: &[Self]) -> Option<Table> {
        let facts: Vec<(&str, &Self)> = facts.iter().map(|m| ("", m)).collect();
        Self::table_of("Metrics", &facts, Shown { definitions: false, variables: 5 })
    }

    /// Table of metrics with their cases.
    fn table_of(title: &str, facts: &[(&str, &Self)], shown: Shown) -> Option<Table> {
        let Shown { definitions, variables } = shown;
        let note = match facts.iter().any(|(_, m)| m.coarse) {
            true => {
                "Between output times these curves are interpolated; the error is an estimate, and more output times make it smaller."
            }
            false => "",
        };
        let error = |m: &Self| {
            let error = m.interpolation_error.filter(|_| m.coarse);
            error.map_or(String::new(), |x| format!("{} {}", rounded(x, 2), m.unit))
        };
        let columns: [Column<'_, &(&str, &Self)>; 9] = [
            ("metric", &|(_, m)| m.name.clone()),
            ("case", &|(case, _)| (*case).to_owned()),
            ("definition", &|(_, m)| if definitions { m.what.clone() } else { String::new() }),
            ("value", &|(_, m)| m.value.map_or("no value".into(), |x| with_unit(x, &m.unit))),
            ("rigid", &|(_, m)| m.rigid.map_or(String::new(), |x| with_unit(x, &m.unit))),
            ("positive", &|(_, m)| if definitions { String::new() } else { m.positive.clone() }),
            ("at t", &|(_, m)| m.time.map_or(String::new(), |t| format!("{} s", number(t)))),
            ("estimated error", &|(_, m)| error(m)),
            ("most influential variables", &|(_, m)| m.most_influential(variables)),
        ];
        Table::of(title, note, &columns, facts).if_any().map(Table::without_empty_columns)
    }

    /// This number of the most influential variables of each unit, with their sensitivities.
    fn most_influential(&self, shown: usize) -> String {
        let mut units: Vec<&str> = self.sensitivities.iter().map(|s| s.per.as_str()).collect();
        units.dedup();
        let of_unit =
            |by| self.sensitivities.iter().filter(move |s| s.per == by && s.value != 0.0).take(shown);
        let largest = units.into_iter().flat_map(of_unit);
        let text = largest.map(|s| format!("{} {} {}", s.variable, rounded(s.value, 3), s.unit));
        text.collect::<Vec<_>>().join("; ")
    }
}

/// Heading of the metrics of several cases.
const ALL: &str = "Metrics of all cases";

/// Metrics of a case of a model.
#[derive(Clone, Debug)]
pub struct CaseMetrics {
    /// Name of the case; empty for a model without cases.
    pub case: String,
    /// Metrics of its motion.
    pub metrics: Vec<MetricFact>,
}

impl CaseMetrics {
    /// Table of the metrics of all cases, with the most influential variable of each unit.
    pub fn table(cases: &[Self], model: &Model) -> Option<Table> {
        MetricFact::table_of(ALL, &Self::all(cases, model), Shown { definitions: false, variables: 1 })
    }

    /// Metrics of all cases in the order of the model file.
    fn all<'c>(cases: &'c [Self], model: &Model) -> Vec<(&'c str, &'c MetricFact)> {
        let of = |case: &'c Self| case.metrics.iter().map(|metric| (case.case.as_str(), metric));
        let mut all: Vec<_> = cases.iter().flat_map(of).collect();
        all.sort_by_key(|(_, metric)| model.metrics.iter().position(|m| m.name == metric.name));
        all
    }

    /// Page of one of the cases with the metrics of all, with the five most influential variables of each unit.
    pub fn page(cases: &[Self], model: &Model, page: Payload) -> Payload {
        let shown = Shown { definitions: false, variables: 5 };
        let table = MetricFact::table_of(ALL, &Self::all(cases, model), shown);
        Payload { metrics: table.or(page.metrics), ..page }
    }

    /// Writes `metrics.csv`: a row for each metric and case, with the derivative by every variable per unit of it.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn write(cases: &[Self], model: &Model, units: Units, out: impl Write) -> csv::Result<()> {
        let mut csv = CsvWriter::new(out);
        let names = ["metric", "case", "value", "unit", "positive", "rigid", "t [s]", "definition"];
        csv.row(names.map(String::from).into_iter().chain(derivative_headings(model, units)))?;
        let shown = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
        for (case, metric) in Self::all(cases, model) {
            let MetricFact { name, what, value, unit, positive, rigid, time, .. } = metric;
            let facts = [name, case, &shown(*value), unit, positive, &shown(*rigid), &shown(*time), what];
            csv.row(
                facts.map(String::from).into_iter().chain(derivative_cells(model, &metric.sensitivities)),
            )?;
        }
        csv.end()?;
        Ok(())
    }
}

/// Headings of the columns of derivatives by all variables, in the unit of their row per unit of the variable.
pub(crate) fn derivative_headings(model: &Model, units: Units) -> impl Iterator<Item = String> {
    model.variables.iter().map(move |variable| match variable_unit(model, units, variable) {
        unit if unit == "1" => format!("d {}", variable.name),
        unit => format!("d {} [per {unit}]", variable.name),
    })
}

/// Cells of these columns: empty where a derivative is not known.
pub(crate) fn derivative_cells(model: &Model, known: &[MetricSensitivity]) -> impl Iterator<Item = String> {
    model.variables.iter().map(|variable| {
        let found = known.iter().find(|sensitivity| sensitivity.variable == variable.name);
        found.map_or(String::new(), |sensitivity| sensitivity.value.to_string())
    })
}

impl MetricChange {
    /// Metrics of a changed design.
    pub fn all(model: &Model, units: Units, what_if: &WhatIf) -> Vec<Self> {
        let (now, other) = (&what_if.today, &what_if.exact);
        let (today, exact) = (metrics(model, now), metrics_beside(model, now, other));
        let values = model.metrics.iter().zip(today).zip(exact);
        values.map(|((metric, now), exact)| Self::of(model, units, what_if, metric, &now, exact)).collect()
    }

    /// Table of the changed metrics.
    pub fn table(changes: &[Self]) -> Option<Table> {
        let shown = |m: &Self, x: Option<f64>| x.map_or("-".into(), |x| with_unit(x, &m.unit));
        let columns: [Column<'_, &Self>; 5] = [
            ("metric", &|m| m.name.clone()),
            ("nominal", &|m| shown(m, m.today)),
            ("predicted, 1st order", &|m| shown(m, m.first)),
            ("changed", &|m| shown(m, m.exact)),
            ("change", &|m| shown(m, m.exact.zip(m.today).map(|(x, now)| x - now))),
        ];
        Table::of("Metrics", "", &columns, changes).if_any()
    }
}

/// Direction in which a metric is positive; of a slope that of its measure, and none of a size.
fn positive(model: &Model, metric: &Metric) -> String {
    if metric.take.is_directed() { model.positive(metric.of) } else { String::new() }
}

/// Description of a metric: `slope of toe over wheel_travel at 0 mm`.
pub(crate) fn what(model: &Model, units: Units, metric: &Metric) -> String {
    let x = model.abscissa(metric);
    let at = |at: f64| units.from_si(x, at);
    model.describe_metric(metric, &|place| number(at(place)), &|place| with_unit(at(place), &unit(units, x)))
}

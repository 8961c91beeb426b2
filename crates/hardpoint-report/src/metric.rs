//! Metrics: values, sensitivities, and their changes in a changed design.

use hardpoint::Solution;
use hardpoint::model::{Metric, Model, Reduction};
use hardpoint::run::{MetricValue, metrics, metrics_beside};
use hardpoint_file::Units;
use hardpoint_study::whatif::WhatIf;
use serde::Serialize;

use crate::figures::variable_unit;
use crate::figures::{number, per, rounded, unit, with_unit};
use crate::page::Table;

/// Interpolation error, as a fraction of the curve's range (for a slope: of the slope), above which it is reported,
/// since metrics are read to three digits.
const COARSE: f64 = 1e-3;

/// Value of a metric with its sensitivities, in the model's units.
#[derive(Clone, Debug, Serialize)]
pub struct MetricFact {
    /// Name.
    pub name: String,
    /// Description in words.
    pub what: String,
    /// Value; `null` if the motion does not reach the required position.
    pub value: Option<f64>,
    /// Unit.
    pub unit: String,
    /// Time at which the metric is evaluated, s; `null` if it uses the whole curve.
    pub time: Option<f64>,
    /// Interpolation error between output times; `null` for a mean, and if there are too few output times to estimate
    /// it.
    pub interpolation_error: Option<f64>,
    /// True if the interpolation error exceeds a thousandth of the curve's range.
    pub coarse: bool,
    /// Sensitivities to every design variable that the mechanism can follow, the largest first within each unit of
    /// variables.
    pub sensitivities: Vec<MetricSensitivity>,
}

/// Sensitivity of a metric to a design variable.
#[derive(Clone, Debug, Serialize)]
pub struct MetricSensitivity {
    /// Name of the variable.
    pub variable: String,
    /// Unit of the variable.
    pub per: String,
    /// Derivative.
    pub value: f64,
    /// Unit of the derivative.
    pub unit: String,
}

/// Metric of a changed design.
#[derive(Clone, Debug, Serialize)]
pub struct MetricChange {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Nominal value.
    pub today: Option<f64>,
    /// First-order prediction.
    pub first: Option<f64>,
    /// Exact value of the changed design.
    pub exact: Option<f64>,
}

impl MetricFact {
    /// Metrics of a solution.
    pub fn all(model: &Model, units: Units, solution: &Solution) -> Vec<Self> {
        let values = metrics(model, solution);
        model.metrics.iter().zip(values).map(|(m, value)| Self::new(model, units, m, value)).collect()
    }

    fn new(model: &Model, units: Units, metric: &Metric, found: MetricValue) -> Self {
        let dimension = model.metric_dimension(metric);
        let sensitivity = |(v, d): (usize, &f64)| {
            let variable = &model.variables[v];
            let by = variable_unit(model, units, variable);
            MetricSensitivity {
                variable: variable.name.clone(),
                value: units.derivative_from_si(dimension, variable.quantity, *d),
                unit: per(&unit(units, dimension), &by),
                per: by,
            }
        };
        let known = found.d.iter().enumerate().filter(|(_, d)| d.is_finite());
        let mut sensitivities: Vec<_> = known.map(sensitivity).collect();
        sensitivities.sort_by(|a, b| a.per.cmp(&b.per).then(b.value.abs().total_cmp(&a.value.abs())));
        Self {
            name: metric.name.clone(),
            what: what(model, units, metric),
            value: found.value.map(|x| units.from_si(dimension, x)),
            unit: unit(units, dimension),
            time: found.time,
            interpolation_error: found.error.map(|x| units.from_si(dimension, x)),
            coarse: found.error.is_some_and(|x| !(x <= COARSE * found.range)),
            sensitivities,
        }
    }

    /// Table of the metrics with their most influential variables.
    pub fn table(facts: &[Self]) -> Option<Table> {
        const SHOWN: usize = 3;
        let row = |m: &Self| {
            let mut strongest: Vec<String> = Vec::new();
            let mut units: Vec<&str> = m.sensitivities.iter().map(|s| s.per.as_str()).collect();
            units.dedup();
            for by in units {
                let of_unit = m.sensitivities.iter().filter(|s| s.per == by && s.value != 0.0).take(SHOWN);
                strongest
                    .extend(of_unit.map(|s| format!("{} {} {}", s.variable, rounded(s.value, 3), s.unit)));
            }
            vec![
                m.name.clone(),
                m.what.clone(),
                m.value.map_or("not reached".into(), |x| with_unit(x, &m.unit)),
                m.time.map_or(String::new(), |t| format!("{} s", number(t))),
                m.interpolation_error
                    .filter(|_| m.coarse)
                    .map_or(String::new(), |x| format!("{} {}", rounded(x, 2), m.unit)),
                strongest.join("; "),
            ]
        };
        (!facts.is_empty()).then(|| {
            Table {
                title: "Metrics".into(),
                note: match facts.iter().any(|m| m.coarse) {
                    true => "Between output times these curves are interpolated; the error is an estimate, and more output times make it smaller.".into(),
                    false => String::new(),
                },
                header: ["metric", "definition", "value", "at t", "estimated error", "most influential variables"].map(String::from).to_vec(),
                rows: facts.iter().map(row).collect(),
            }
            .without_empty_columns()
        })
    }
}

impl MetricChange {
    /// Metrics of a changed design.
    pub fn all(model: &Model, units: Units, what_if: &WhatIf) -> Vec<Self> {
        let (now, other) = (&what_if.today, &what_if.exact);
        let (today, exact) = (metrics(model, now), metrics_beside(model, now, other));
        let change = |(k, metric): (usize, &Metric)| {
            let dimension = model.metric_dimension(metric);
            let shown = |x: Option<f64>| x.map(|x| units.from_si(dimension, x));
            let changed = what_if.change.iter().zip(&today[k].d).filter(|(by, _)| **by != 0.0);
            let first: f64 = changed.map(|(by, d)| by * d).sum();
            Self {
                name: metric.name.clone(),
                unit: unit(units, dimension),
                today: shown(today[k].value),
                first: shown(today[k].value.map(|now| now + first).filter(|x| x.is_finite())),
                exact: shown(exact[k]),
            }
        };
        model.metrics.iter().enumerate().map(change).collect()
    }

    /// Table of the changed metrics.
    pub fn table(changes: &[Self]) -> Option<Table> {
        let row = |m: &Self| {
            let shown = |x: Option<f64>| x.map_or("-".into(), |x| with_unit(x, &m.unit));
            let change = m.exact.zip(m.today).map(|(x, now)| x - now);
            vec![m.name.clone(), shown(m.today), shown(m.first), shown(m.exact), shown(change)]
        };
        let header = ["metric", "nominal", "predicted, 1st order", "changed", "change"];
        (!changes.is_empty()).then(|| Table {
            title: "Metrics".into(),
            note: String::new(),
            header: header.map(String::from).to_vec(),
            rows: changes.iter().map(row).collect(),
        })
    }
}

/// Description of a metric: `slope of toe over wheel_travel at 0 mm`.
fn what(model: &Model, units: Units, metric: &Metric) -> String {
    let name = |output| model.output_name(output);
    let x = model.abscissa(metric);
    let place = |at: f64| with_unit(units.from_si(x, at), &unit(units, x));
    let over = metric.over.map_or("time".into(), name);
    let of = name(metric.of);
    let within = metric.window.map_or(String::new(), |[low, high]| {
        format!(" where {over} is {} to {}", number(units.from_si(x, low)), place(high))
    });
    let mean_over = if metric.over.is_some() { format!(" over {over}") } else { String::new() };
    match &metric.take {
        Reduction::Least => format!("least {of}{within}"),
        Reduction::Greatest => format!("greatest {of}{within}"),
        Reduction::Range => format!("range of {of} (max - min){within}"),
        Reduction::Integral => format!("integral of {of} over {over}{within}"),
        Reduction::Mean => format!("mean of {of}{mean_over}{within}"),
        Reduction::Rms(target) if target.is_empty() => format!("root mean square of {of}{mean_over}{within}"),
        Reduction::Rms(_) => format!("root mean square of {of} beyond its target{mean_over}{within}"),
        Reduction::RmsAtPoints(_) => {
            format!("root mean square of {of} beyond the points of its target{mean_over}{within}")
        }
        Reduction::Value(at) => format!("{of} where {over} is {}", place(*at)),
        Reduction::Slope(at) => format!("slope of {of} over {over} at {}", place(*at)),
    }
}

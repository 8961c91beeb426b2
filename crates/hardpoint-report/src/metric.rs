//! Metrics: values, sensitivities, and their changes in a changed design.

use hardpoint::Solution;
use hardpoint::model::{DesignVariable, Dimension, Metric, Model, Reduction};
use hardpoint::run::{MetricValue, metrics, metrics_beside};
use hardpoint_file::Units;
use hardpoint_study::whatif::WhatIf;

use crate::figures::{number, per, rounded, unit, variable_unit, with_unit};
use crate::page::Table;
use crate::record::{Column, record};

/// Interpolation error, as a fraction of the curve's range (for a slope: of the slope), above which it is reported,
/// since metrics are read to three digits.
const COARSE: f64 = 1e-3;

record! {
    /// Value of a metric with its sensitivities, in the model's units.
    MetricFact::of(model: &Model, units: Units, metric: &Metric, found: &MetricValue) {
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
    MetricSensitivity::of(model: &Model, units: Units, of: Dimension, variable: &DesignVariable, d: f64) {
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

impl MetricFact {
    /// Metrics of a solution.
    pub fn all(model: &Model, units: Units, solution: &Solution) -> Vec<Self> {
        let values = metrics(model, solution);
        model.metrics.iter().zip(values).map(|(m, value)| Self::of(model, units, m, &value)).collect()
    }

    /// Table of the metrics with their most influential variables.
    pub fn table(facts: &[Self]) -> Option<Table> {
        let note = match facts.iter().any(|m| m.coarse) {
            true => {
                "Between output times these curves are interpolated; the error is an estimate, and more output times make it smaller."
            }
            false => "",
        };
        let error = |m: &Self| {
            let error = m.interpolation_error.filter(|_| m.coarse);
            error.map_or(String::new(), |x| format!("{} {}", rounded(x, 2), m.unit))
        };
        let columns: [Column<'_, &Self>; 6] = [
            ("metric", &|m| m.name.clone()),
            ("definition", &|m| m.what.clone()),
            ("value", &|m| m.value.map_or("not reached".into(), |x| with_unit(x, &m.unit))),
            ("at t", &|m| m.time.map_or(String::new(), |t| format!("{} s", number(t)))),
            ("estimated error", &|m| error(m)),
            ("most influential variables", &|m| m.most_influential()),
        ];
        Table::of("Metrics", note, &columns, facts).if_any().map(Table::without_empty_columns)
    }

    /// The most influential variables of each unit, with their sensitivities.
    fn most_influential(&self) -> String {
        const SHOWN: usize = 3;
        let mut units: Vec<&str> = self.sensitivities.iter().map(|s| s.per.as_str()).collect();
        units.dedup();
        let of_unit =
            |by| self.sensitivities.iter().filter(move |s| s.per == by && s.value != 0.0).take(SHOWN);
        let largest = units.into_iter().flat_map(of_unit);
        let text = largest.map(|s| format!("{} {} {}", s.variable, rounded(s.value, 3), s.unit));
        text.collect::<Vec<_>>().join("; ")
    }
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
        Reduction::Change => format!("change of {of} from the first to the last output time"),
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

//! Single values that characterise a design.

use hardpoint::model::{CurvePart, Dimension, Driver, Metric, OutputSource, VariableId};
use hardpoint_table::series::settled;

use crate::facts::VariableAdmissibility;
use crate::figures::order_unit;
use crate::metric::MetricFact;
use crate::page::{Gate, Value};
use crate::summary::Summary;

use super::Compose;

/// A driver is in the design configuration if its distance from it is at most this fraction of the mechanism's size, or
/// of a radian.
const AT_DESIGN: f64 = 1e-9;

impl Compose<'_> {
    /// Metrics, then the values of all measures in the design configuration, or at the start if the motion does not
    /// pass it.
    pub(super) fn values(&self, summary: &Summary) -> Vec<Value> {
        let metrics = summary.metrics.iter().enumerate().map(|(k, fact)| self.metric_value(k, fact));
        let outputs = self.solution.measured.outputs.iter().enumerate();
        let measures = outputs.filter(|(_, o)| matches!(o.source, OutputSource::Measure(_))).map(|(m, _)| m);
        let at = self.design_step();
        let at_step = measures.filter_map(|m| Some(self.value_at_step(summary, m, at?)));
        metrics.chain(at_step).collect()
    }

    fn metric_value(&self, metric: usize, fact: &MetricFact) -> Value {
        let metric = &self.model.metrics[metric];
        let dimension = self.model.metric_dimension(metric);
        let by_variable = self.model.variables.iter().enumerate().map(|(b, variable)| {
            let found = fact.sensitivities.iter().find(|s| s.variable == variable.name)?.value;
            let least = self.round_off.of(b, dimension, 0);
            let least = self.units.derivative_from_si(dimension, variable.quantity, least);
            Some(settled(found, least))
        });
        let outputs = &self.solution.measured.outputs;
        let target = self
            .limits
            .get(&fact.name)
            .map(|ends| ends.map(|end| end.map(|x| self.units.from_si(dimension, x))));
        Value {
            name: fact.name.clone(),
            what: fact.what.clone(),
            unit: fact.unit.clone(),
            value: fact.value,
            time: fact.time,
            quantity: outputs.iter().position(|o| o.source == metric.of),
            gate: target.and_then(|target| gate(metric, target, fact.time)),
            target,
            sensitivities: by_variable.collect(),
        }
    }

    /// Step in the design configuration, otherwise the first one, with its description.
    fn design_step(&self) -> Option<(usize, &'static str)> {
        let times = &self.solution.motion.times;
        let size = self.model.size();
        let as_drawn = |driver: &Driver, t: f64| {
            let dimension = Dimension::from(self.model.driven(driver).quantity);
            driver.law.at(t).value().abs() <= AT_DESIGN * size.powi(dimension.length.into())
        };
        let drawn = times.iter().position(|&t| self.model.drivers.iter().all(|d| as_drawn(d, t)));
        match drawn {
            Some(step) => Some((step, "design configuration")),
            None => (!times.is_empty()).then_some((0, "at the start")),
        }
    }

    fn value_at_step(&self, summary: &Summary, m: usize, (step, what): (usize, &str)) -> Value {
        let measured = &self.solution.measured;
        let output = &measured.outputs[m];
        let value = settled(measured.value(step, m)[0], self.round_off.value(output.dimension, 0));
        let sensitivity = |b: usize| {
            let known = matches!(
                summary.model.variables[b].answer,
                VariableAdmissibility::Admissible | VariableAdmissibility::Reassembled
            );
            let d = known.then(|| measured.d(step, VariableId(b), m)[0]).filter(|d| d.is_finite())?;
            let d = settled(d, self.round_off.of(b, output.dimension, 0));
            Some(self.units.derivative_from_si(output.dimension, self.model.variables[b].quantity, d))
        };
        Value {
            name: output.name.clone(),
            what: what.into(),
            unit: order_unit(self.units, output.dimension, 0),
            value: value.is_finite().then(|| self.units.from_si(output.dimension, value)),
            time: Some(self.solution.motion.times[step]),
            quantity: Some(m),
            target: None,
            gate: None,
            sensitivities: (0..self.model.variables.len()).map(sensitivity).collect(),
        }
    }
}

/// Limits of a curve from the limits of its metric: a maximum limits the whole curve from above, a minimum from below,
/// and a value at a position limits it there. Other metrics, and those of a part of the curve, limit no point of it.
fn gate(metric: &Metric, [low, high]: [Option<f64>; 2], time: Option<f64>) -> Option<Gate> {
    let gate = match metric.take.part() {
        CurvePart::Extrema([1.0]) if metric.window.is_none() => Gate { low: None, high, at: None },
        CurvePart::Extrema([-1.0]) if metric.window.is_none() => Gate { low, high: None, at: None },
        CurvePart::Place { is_slope: false, .. } => Gate { low, high, at: Some(time?) },
        CurvePart::Extrema(_)
        | CurvePart::Ends
        | CurvePart::Path(_)
        | CurvePart::Place { .. }
        | CurvePart::Points(_) => return None,
    };
    (gate.low.is_some() || gate.high.is_some()).then_some(gate)
}

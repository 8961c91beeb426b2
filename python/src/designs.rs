//! Many designs in one call, as one array.

use std::num::NonZero;

use hardpoint::Run as Asked;
use hardpoint::Solution;
use hardpoint::measure::MeasureResults;
use hardpoint::model::Dimension;
use hardpoint::run::{GradientMethod, metric_numbers, metrics};
use hardpoint::sensitivity::Admissibility;
use hardpoint_report::diagnose;
use hardpoint_study::BLOCK;
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::{array, array1};
use crate::failure::{Failure, Kind, diagnostic_json};
use crate::model::Model;
use crate::run::derivatives;
use crate::watch::patiently;

/// Requested number of threads, or one for each core.
pub(crate) fn threads(asked: Option<usize>) -> NonZero<usize> {
    let asked = asked.and_then(NonZero::new);
    asked.or_else(|| std::thread::available_parallelism().ok()).unwrap_or(NonZero::<usize>::MIN)
}

/// Stored results of many designs.
struct Kept {
    outputs: Vec<usize>,
    order: usize,
    at: Vec<usize>,
    variables: usize,
    values: Vec<f64>,
    d: Vec<f64>,
    metrics: Vec<f64>,
    metrics_d: Vec<f64>,
    stops: Vec<(usize, String)>,
}

impl Kept {
    fn values_of(
        &mut self,
        n: usize,
        measured: &MeasureResults,
        of: impl Fn(usize) -> Dimension,
        per_si: impl Fn(Dimension) -> f64,
    ) {
        let (count, steps) = (self.outputs.len(), self.at.len());
        for (place, m) in self.outputs.iter().enumerate() {
            let factor = per_si(of(*m));
            let row = &mut self.values[(n * count + place) * steps..][..steps];
            for (cell, k) in row.iter_mut().zip(&self.at).filter(|(_, k)| **k < measured.len()) {
                *cell = measured.value(*k, *m)[self.order] * factor;
            }
        }
    }
}

#[pymethods]
impl Model {
    /// Solves many designs, one per row, in a case. Returns one order of some outputs at some output times (by index)
    /// `[design, output, time]`, their derivatives `[design, output, variable, time]`, all metrics `[design, metric]`
    /// and their derivatives `[design, metric, variable]`. Values are NaN after a stop and for inadmissible variables;
    /// `stops` lists the stopped designs.
    #[pyo3(signature = (case, designs, outputs, order, at, sensitivities, metrics, workers=None, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "a call of Python")]
    fn designs<'py>(
        &self,
        py: Python<'py>,
        case: usize,
        designs: PyReadonlyArray2<'py, f64>,
        outputs: Vec<usize>,
        order: usize,
        at: Vec<usize>,
        sensitivities: bool,
        metrics: bool,
        workers: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let file = &self.cases[case];
        let analysis = self.analysis(case)?;
        let asked: Result<Vec<Vec<f64>>, Failure> =
            designs.as_array().rows().into_iter().map(|row| self.changes(&row.to_vec())).collect();
        let asked = asked?;
        let (n, count, steps) = (designs.shape()[0], outputs.len(), at.len());
        let (variables, metric_count) =
            (file.model.variables.len(), if metrics { file.model.metrics.len() } else { 0 });
        let d_count = if sensitivities { variables } else { 0 };
        let room = |size: usize| vec![f64::NAN; size];
        let mut kept = Kept {
            outputs,
            order,
            at,
            variables,
            values: room(n * count * steps),
            d: room(n * count * d_count * steps),
            metrics: room(n * metric_count),
            metrics_d: room(n * metric_count * d_count),
            stops: Vec::new(),
        };
        let kept = patiently(py, progress, |watch| {
            let analysis = &watch.over(analysis);
            let mut done = 0;
            for (block, designs) in asked.chunks(BLOCK).enumerate() {
                let run = Asked::new().threads(threads(workers));
                let run = if sensitivities { run } else { run.without_sensitivities() };
                analysis.solve_designs(run, designs, |k, solution| {
                    keep(&mut kept, file, block * BLOCK + k, solution, metrics, sensitivities);
                });
                done += designs.len();
                if watch.tell(done, n).is_break() {
                    break;
                }
            }
            kept
        })?;
        let Kept { values, d, metrics, metrics_d, mut stops, .. } = kept;
        stops.sort_by_key(|(n, _)| *n);
        let found = PyDict::new(py);
        found.set_item("values", array(py, values, [n, count, steps])?)?;
        found.set_item("sensitivities", array(py, d, [n, count, d_count, steps])?)?;
        found.set_item("metrics", array(py, metrics, [n, metric_count])?)?;
        found.set_item("metric_sensitivities", array(py, metrics_d, [n, metric_count, d_count])?)?;
        found.set_item("stops", stops)?;
        Ok(found)
    }

    /// Gradients of some outputs over the motion, direct, adjoint, or the cheaper of both: times and
    /// `[time, output, variable, order]`.
    fn gradients<'py>(
        &self,
        py: Python<'py>,
        case: usize,
        design: Vec<f64>,
        outputs: Vec<usize>,
        method: &str,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (file, analysis, changes) = (&self.cases[case], self.analysis(case)?, self.changes(&design)?);
        let method = match method {
            "auto" => GradientMethod::Auto,
            "direct" => GradientMethod::Direct,
            "adjoint" => GradientMethod::Adjoint,
            _ => {
                return Err(Failure::Misunderstood(format!(
                    "unknown method `{method}`; there are auto, direct, adjoint"
                ))
                .into());
            }
        };
        let found = patiently(py, None, |watch| watch.over(analysis).gradients(&changes, &outputs, method))?;
        if let Some(stop) = &found.stop {
            let diagnostic = diagnose::stop(file, stop, found.times.len(), None);
            return Err(Failure::of_model(Kind::Stopped, file, &diagnostic).into());
        }
        let (steps, variables) = (found.times.len(), found.variables);
        let mut d = Vec::with_capacity(steps * outputs.len() * variables * 3);
        for k in 0..steps {
            for (m, output) in found.outputs.iter().enumerate() {
                for (by, orders) in file.model.variables.iter().zip(found.at(k, m)) {
                    let factor = file.units.derivative_from_si(output.dimension, by.quantity, 1.0);
                    d.extend(orders.map(|x| x * factor));
                }
            }
        }
        let followed = found.admissibility.iter().map(|a| !matches!(a, Admissibility::CannotFollow { .. }));
        let answer = PyDict::new(py);
        answer.set_item("times", array1(py, found.times))?;
        answer.set_item("gradients", array(py, d, [steps, outputs.len(), variables, 3])?)?;
        answer.set_item("followed", followed.collect::<Vec<bool>>())?;
        answer.set_item("method", format!("{:?}", found.method).to_lowercase())?;
        Ok(answer)
    }

    /// Second derivatives of the values of some outputs by some variables: `[time, output, variable, variable]`,
    /// NaN for inadmissible variables.
    fn second<'py>(
        &self,
        py: Python<'py>,
        case: usize,
        design: Vec<f64>,
        outputs: Vec<usize>,
        variables: Vec<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (file, analysis, changes) = (&self.cases[case], self.analysis(case)?, self.changes(&design)?);
        let model = &file.model;
        let direction = |b: &usize| {
            (0..model.variables.len()).map(|k| f64::from(u8::from(k == *b))).collect::<Vec<f64>>()
        };
        let directions: Vec<Vec<f64>> = variables.iter().map(direction).collect();
        let n = variables.len();
        let pairs: Vec<[usize; 2]> = (0..n).flat_map(|i| (0..=i).map(move |j| [i, j])).collect();
        // Second derivatives come without the admissibility of the variables, first ones with it.
        let (known, found) = patiently(py, None, |watch| {
            let analysis = &watch.over(analysis);
            let first = analysis.gradients(&changes, &outputs, GradientMethod::Auto);
            (first.admissibility, analysis.second(&changes, &directions, &pairs))
        })?;
        if let Some(stop) = &found.stop {
            let diagnostic = diagnose::stop(file, stop, found.times.len(), None);
            return Err(Failure::of_model(Kind::Stopped, file, &diagnostic).into());
        }
        let follows = |b: usize| !matches!(known[variables[b]], Admissibility::CannotFollow { .. });
        let (steps, count) = (found.times.len(), outputs.len());
        let mut all = vec![0.0; steps * count * n * n];
        let per = |b: usize| file.units.per_si(model.variables[variables[b]].quantity);
        for k in 0..steps {
            for (place, m) in outputs.iter().enumerate() {
                let of = file.units.per_si(found.outputs[*m].dimension);
                for (p, [i, j]) in pairs.iter().enumerate() {
                    let factor = if follows(*i) && follows(*j) { of / per(*i) / per(*j) } else { f64::NAN };
                    let value = found.value(k, p, *m) * factor;
                    let first = (k * count + place) * n * n;
                    all[first + i * n + j] = value;
                    all[first + j * n + i] = value;
                }
            }
        }
        array(py, all, [steps, count, n, n])
    }

    /// Third time derivatives of all bodies: times and `[time, body, 6]`.
    fn jerk<'py>(&self, py: Python<'py>, case: usize, design: Vec<f64>) -> PyResult<Bound<'py, PyDict>> {
        use hardpoint::joint::Quantity::{Angle, Length};
        let (file, analysis, changes) = (&self.cases[case], self.analysis(case)?, self.changes(&design)?);
        let found = patiently(py, None, |watch| watch.over(analysis).jerks(&changes))?;
        let (steps, bodies) = (found.times.len(), file.model.bodies.len() - 1);
        let mut numbers = Vec::with_capacity(steps * bodies * 6);
        for k in 0..steps {
            for body in &found.at(k)[1..] {
                numbers.extend(body.jerk.to_array().map(|x| file.units.from_si(Length, x)));
                numbers.extend(body.angular.to_array().map(|x| file.units.from_si(Angle, x)));
            }
        }
        let answer = PyDict::new(py);
        answer.set_item("times", array1(py, found.times))?;
        answer.set_item("jerk", array(py, numbers, [steps, bodies, 6])?)?;
        Ok(answer)
    }
}

/// Requested results of one design.
fn keep(
    kept: &mut Kept,
    file: &hardpoint_file::ModelFile,
    n: usize,
    solution: &Solution,
    with_metrics: bool,
    sensitivities: bool,
) {
    let (measured, model, units) = (&solution.measured, &file.model, file.units);
    let is_whole = solution.stop.is_none();
    if let Some(stop) = &solution.stop {
        let found = diagnose::stop_of_changed(file, stop, solution.motion.len());
        kept.stops.push((n, diagnostic_json(file, &found).to_string()));
    }
    kept.values_of(n, measured, |m| measured.outputs[m].dimension, |of| units.per_si(of));
    let (count, steps, variables) = (kept.outputs.len(), kept.at.len(), kept.variables);
    if sensitivities && is_whole {
        let known = &solution.sensitivities.admissibility;
        let follows = |b: usize| !matches!(known[b], Admissibility::CannotFollow { .. });
        for (place, m) in kept.outputs.iter().enumerate() {
            let rows = &mut kept.d[(n * count + place) * variables * steps..][..variables * steps];
            derivatives(measured, file, *m, kept.order, follows, kept.at.iter().copied(), rows);
        }
    }
    if !with_metrics || !is_whole {
        return;
    }
    let first = n * model.metrics.len();
    if !sensitivities {
        for ((cell, metric), value) in
            kept.metrics[first..].iter_mut().zip(&model.metrics).zip(metric_numbers(model, solution))
        {
            *cell = value.map_or(f64::NAN, |x| units.from_si(model.metric_dimension(metric), x));
        }
        return;
    }
    for (k, (metric, found)) in model.metrics.iter().zip(metrics(model, solution)).enumerate() {
        let of = model.metric_dimension(metric);
        kept.metrics[first + k] = found.value.map_or(f64::NAN, |x| units.from_si(of, x));
        let row = &mut kept.metrics_d[(first + k) * variables..][..variables];
        for ((cell, variable), x) in row.iter_mut().zip(&model.variables).zip(&found.d) {
            *cell = units.derivative_from_si(of, variable.quantity, *x);
        }
    }
}

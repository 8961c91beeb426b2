//! A solved motion.

use std::sync::Arc;

use hardpoint::joint::Quantity::{Angle, Length};
use hardpoint::measure::MeasureResults;
use hardpoint::model::{BodyId, VariableId};
use hardpoint::run::{MetricValue, metrics};
use hardpoint::sensitivity::Admissibility;
use hardpoint::space::Vec3;
use hardpoint::{Run as Asked, Solution};
use hardpoint_file::{ModelFile, Units};
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::facts::Facts;
use hardpoint_report::payload::{ChangedDesign, Request, report};
use hardpoint_report::summary::Summary;
use numpy::PyArray1;
use pyo3::prelude::*;
use serde_json::Value;

use crate::array::{array, array1};
use crate::failure::{Failure, Kind, diagnostic_json};
use crate::model::Model;
use crate::watch::Quick;

/// A solved motion.
#[pyclass(frozen, module = "hardpoint._native")]
pub(crate) struct Run {
    model: Py<Model>,
    case: usize,
    changes: Vec<f64>,
    solution: Arc<Solution>,
}

impl Model {
    /// The motion of one design in one case.
    fn solved(
        &self,
        py: Python<'_>,
        case: usize,
        changes: &[f64],
        sensitivities: bool,
    ) -> Result<Solution, Failure> {
        let analysis = self.analysis(case)?;
        let mut quick = Quick::new();
        let solution = py.detach(|| {
            let asked = Asked::new().at(changes).progress(|_| quick.go_on());
            analysis.solve(if sensitivities { asked } else { asked.without_sensitivities() })
        });
        quick.end()?;
        Ok(solution)
    }
}

#[pymethods]
impl Model {
    /// Solves the motion of a design in a case.
    #[pyo3(signature = (case, design, sensitivities=true))]
    fn run(this: Bound<'_, Self>, case: usize, design: Vec<f64>, sensitivities: bool) -> PyResult<Run> {
        let model = this.get();
        let changes = model.changes(&design)?;
        let solution = Arc::new(model.solved(this.py(), case, &changes, sensitivities)?);
        Ok(Run { model: this.unbind(), case, changes, solution })
    }
}

impl Run {
    fn file(&self) -> &ModelFile {
        &self.model.get().cases[self.case]
    }

    fn units(&self) -> Units {
        self.file().units
    }

    fn follows(&self, b: usize) -> bool {
        let known = self.solution.sensitivities.admissibility.get(b);
        known.is_some_and(|a| !matches!(a, Admissibility::CannotFollow { .. }))
    }

    fn metric_values(&self) -> Vec<MetricValue> {
        metrics(&self.file().model, &self.solution)
    }

    /// Motion in the form for pages and summaries.
    fn course(&self) -> Course {
        Course::of(&self.file().model, &self.solution)
    }
}

#[pymethods]
impl Run {
    /// Output times that were solved, s.
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array1(py, self.solution.motion.times.clone())
    }

    /// Values of all design variables.
    #[getter]
    fn design(&self) -> Vec<f64> {
        let file = self.file();
        (0..file.model.variables.len())
            .map(|k| file.value_of(VariableId(k), self.changes.get(k).copied().unwrap_or(0.0)))
            .collect()
    }

    /// Reason why the motion ended before its last output time, as the JSON of a diagnostic.
    #[getter]
    fn stop(&self) -> Option<String> {
        let (file, solution) = (self.file(), &self.solution);
        let stop = solution.stop.as_ref()?;
        let found = match self.changes.iter().any(|b| *b != 0.0) {
            true => diagnose::stop_of_changed(file, stop, solution.motion.len()),
            false => diagnose::stop(file, stop, solution.motion.len(), None),
        };
        Some(diagnostic_json(file, &found).to_string())
    }

    /// Values of all drivers at the last solved position of a motion that ended early, counted from the design
    /// configuration.
    #[getter]
    fn stopped_at(&self) -> Option<Vec<f64>> {
        let (stop, model) = (self.solution.stop.as_ref()?, &self.file().model);
        let shown = |(d, x): (_, &f64)| self.units().from_si(model.driven(d).quantity, *x);
        Some(model.drivers.iter().zip(&stop.drivers).map(shown).collect())
    }

    /// Admissibility of each variable: true, or the reason as the JSON of a diagnostic; `None` without sensitivities.
    #[getter]
    fn followed(&self) -> PyResult<Vec<(bool, Option<String>)>> {
        let (file, model) = (self.file(), self.model.get());
        if self.solution.sensitivities.variables == 0 {
            return Ok(Vec::new());
        }
        let facts = Facts::new(file, model.analysis(self.case)?, Some(&self.solution));
        let all = diagnose::variables(file, &facts);
        let why = |b: usize| {
            let name = format!("`{}`", file.model.variables[b].name);
            let found = all.iter().find(|d| d.code == "HP0501" && d.message.contains(&name))?;
            Some(diagnostic_json(file, found).to_string())
        };
        let variables = 0..file.model.variables.len();
        Ok(variables.map(|b| if self.follows(b) { (true, None) } else { (false, why(b)) }).collect())
    }

    /// All outputs: `[output, order, time]`, NaN if undefined.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (measured, units) = (&self.solution.measured, self.units());
        let (outputs, steps) = (measured.outputs.len(), measured.len());
        let mut numbers = vec![f64::NAN; outputs * 3 * steps];
        py.detach(|| {
            for (m, output) in measured.outputs.iter().enumerate() {
                let factor = units.per_si(output.dimension);
                let rows = &mut numbers[3 * m * steps..3 * (m + 1) * steps];
                for k in 0..steps {
                    let [x, v, a] = measured.value(k, m);
                    [rows[k], rows[steps + k], rows[2 * steps + k]] = [x, v, a].map(|x| x * factor);
                }
            }
        });
        array(py, numbers, [outputs, 3, steps])
    }

    /// Derivatives of one order of all outputs: `[output, variable, time]`; NaN for inadmissible variables.
    fn sensitivities<'py>(&self, py: Python<'py>, order: usize) -> PyResult<Bound<'py, PyAny>> {
        let measured = &self.solution.measured;
        let (outputs, steps, file) = (measured.outputs.len(), measured.len(), self.file());
        let variables = file.model.variables.len();
        let mut numbers = vec![f64::NAN; outputs * variables * steps];
        py.detach(|| {
            for m in 0..outputs {
                let rows = &mut numbers[m * variables * steps..(m + 1) * variables * steps];
                derivatives(measured, file, m, order, |b| self.follows(b), 0..steps, rows);
            }
        });
        array(py, numbers, [outputs, variables, steps])
    }

    /// The motion of a body: `[time, 19]`, position, quaternion, velocity, angular velocity, acceleration, angular
    /// acceleration.
    fn body<'py>(&self, py: Python<'py>, body: usize) -> PyResult<Bound<'py, PyAny>> {
        let (units, steps) = (self.units(), self.solution.motion.len());
        let mut numbers = Vec::with_capacity(19 * steps);
        let mut push = |of, v: Vec3| numbers.extend(v.to_array().map(|x| units.from_si(of, x)));
        let mut all = Vec::with_capacity(19 * steps);
        for k in 0..steps {
            let s = self.solution.body(k, BodyId(body));
            push(Length, s.r);
            push(Length, s.v);
            push(Angle, s.omega);
            push(Length, s.a);
            push(Angle, s.alpha);
            all.push(s.quaternion());
        }
        // Both signs are the same orientation: that nearer to the one before.
        for k in 1..all.len() {
            let [before, now]: [[f64; 4]; 2] = [all[k - 1], all[k]];
            if before.iter().zip(now).map(|(a, b)| a * b).sum::<f64>() < 0.0 {
                all[k] = now.map(|x| -x);
            }
        }
        let rows = numbers.chunks_exact(15).zip(all);
        let whole: Vec<f64> = rows.flat_map(|(n, q)| [&n[..3], &q[..], &n[3..]].concat()).collect();
        array(py, whole, [steps, 19])
    }

    /// Derivatives by a variable: `[time, 18]`, position, rotation vector, velocity, angular velocity, acceleration,
    /// angular acceleration.
    fn body_sensitivity<'py>(
        &self,
        py: Python<'py>,
        body: usize,
        variable: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (units, steps) = (self.units(), self.solution.motion.len());
        let by = self.file().model.variables[variable].quantity;
        let mut numbers = Vec::with_capacity(18 * steps);
        for k in 0..steps {
            let Some(all) = self.solution.sensitivities.at(k, variable) else { break };
            let d = all.body(body);
            let parts = [
                (Length, d.dr),
                (Angle, d.dpi),
                (Length, d.dv),
                (Angle, d.domega),
                (Length, d.da),
                (Angle, d.dalpha),
            ];
            for (of, v) in parts {
                numbers.extend(v.to_array().map(|x| units.derivative_from_si(of, by, x)));
            }
        }
        numbers.resize(18 * steps, f64::NAN);
        array(py, numbers, [steps, 18])
    }

    /// Metrics: value, time and error of each, NaN if undefined, and their derivatives `[metric, variable]`.
    fn metrics<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyAny>; 2]> {
        let (model, units) = (&self.file().model, self.units());
        let mut values = Vec::new();
        let mut d = Vec::new();
        let found = self.metric_values();
        for (metric, found) in model.metrics.iter().zip(&found) {
            let dimension = model.metric_dimension(metric);
            let shown = |x: Option<f64>| x.map_or(f64::NAN, |x| units.from_si(dimension, x));
            values.extend([shown(found.value), found.time.unwrap_or(f64::NAN), shown(found.error)]);
            let by = model.variables.iter().zip(&found.d);
            d.extend(by.map(|(v, x)| units.derivative_from_si(dimension, v.quantity, *x)));
        }
        let (metrics, variables) = (found.len(), model.variables.len());
        Ok([array(py, values, [metrics, 3])?, array(py, d, [metrics, variables])?])
    }

    /// Summary as written by the command line, as JSON.
    fn summary(&self) -> PyResult<String> {
        let (file, model) = (self.file(), self.model.get());
        let course = self.course();
        let mut summary = Summary::new(file, model.analysis(self.case)?, &course);
        summary.diagnostics = diagnose::all(file, &summary, &course, None);
        Ok(json(&summary))
    }

    /// Diagnostics of the motion, as JSON.
    fn diagnostics(&self) -> PyResult<String> {
        let (file, model) = (self.file(), self.model.get());
        let course = self.course();
        let summary = Summary::new(file, model.analysis(self.case)?, &course);
        let all = diagnose::all(file, &summary, &course, None);
        Ok(Value::Array(all.iter().map(|d| diagnostic_json(file, d)).collect()).to_string())
    }

    /// Page of the motion.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        let (file, model) = (self.file(), self.model.get());
        let analysis = model.analysis(self.case)?;
        let is_changed = self.changes.iter().any(|b| *b != 0.0);
        // The page is that of the nominal design, with the changed design alongside.
        let today = match is_changed {
            true => Arc::new(model.solved(py, self.case, &[], true)?),
            false => self.solution.clone(),
        };
        if let Some(stop) = today.stop.as_ref().filter(|_| today.motion.is_empty()) {
            return Err(Failure::of_model(Kind::Stopped, file, &diagnose::stop(file, stop, 0, None)).into());
        }
        Ok(py.detach(|| {
            let course = Course::of(&file.model, &today);
            let mut summary = Summary::new(file, analysis, &course);
            summary.diagnostics = diagnose::all(file, &summary, &course, None);
            let changed = is_changed.then(|| ChangedDesign {
                name: "changed".into(),
                note: "The design of this run.".into(),
                change: &self.changes,
                today: &today,
                exact: &self.solution,
                prediction: None,
            });
            let request = Request { changed, ..Request::of(file, analysis, &course, &summary) };
            report(&request, &|page| page).expect("a payload is plain data")
        }))
    }
}

/// Derivatives of one order of output m by all variables at some output times: `[variable, time]`.
pub(crate) fn derivatives(
    measured: &MeasureResults,
    file: &ModelFile,
    m: usize,
    order: usize,
    follows: impl Fn(usize) -> bool,
    times: impl ExactSizeIterator<Item = usize> + Clone,
    rows: &mut [f64],
) {
    let of = measured.outputs[m].dimension;
    for (b, variable) in file.model.variables.iter().enumerate().filter(|(b, _)| follows(*b)) {
        let factor = file.units.derivative_from_si(of, variable.quantity, 1.0);
        let row = &mut rows[b * times.len()..(b + 1) * times.len()];
        for (cell, k) in row.iter_mut().zip(times.clone()) {
            *cell = measured.d(k, VariableId(b), m)[order] * factor;
        }
    }
}

/// Converts facts to JSON.
pub(crate) fn json(facts: &impl serde::Serialize) -> String {
    serde_json::to_string(facts).expect("facts are plain data")
}

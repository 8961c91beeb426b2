//! Studies of a model; the result is the JSON that the command line writes, with its tables.

use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::Analysis;
use hardpoint::draft::did_you_mean;
use hardpoint::model::{AllocationRule, AllocationSettings, ToleranceSettings, VariableId};
use hardpoint::sensitivity::Admissibility;
use hardpoint::topology::Formulation;
use hardpoint_report::calibrate::{CalibrateFacts, CalibrationInputs};
use hardpoint_report::diagnose;
use hardpoint_report::maps::MapFact;
use hardpoint_report::optimize::{OptimizeFacts, rounded};
use hardpoint_report::page::Table;
use hardpoint_report::tolerance::{ToleranceFacts, ToleranceInputs};
use hardpoint_report::validity::ValidityFact;
use hardpoint_report::verdict::Verdict;
use hardpoint_report::whatif::WhatIfFacts;
use hardpoint_study::calibrate::{CalibrationError, CalibrationRequest, Loss, calibrate};
use hardpoint_study::difference::DifferenceScheme;
use hardpoint_study::grid::GridMap;
use hardpoint_study::optimize::{OptimizationRequest, SearchProgress, optimize};
use hardpoint_study::tolerance::{ToleranceError, ToleranceStage, tolerance, toleranced_designs};
use hardpoint_study::validity;
use hardpoint_study::verify::{VerifyOptions, verify};
use hardpoint_study::whatif::what_if;
use pyo3::prelude::*;
use serde::Serialize;
use serde_json::json;

use crate::array::array;
use crate::design::shown;
use crate::designs::{flow, threads};
use crate::failure::{Failure, Kind};
use crate::model::Model;
use crate::watch::patiently;

/// Result of a study.
fn outcome(facts: &impl Serialize, tables: &[Table]) -> String {
    json!({ "facts": facts, "tables": tables }).to_string()
}

/// Result of a search: the facts, the optimised design with rounded numbers, and the exact one.
type Searched = (String, Option<Vec<f64>>, Option<Vec<f64>>);

impl Model {
    /// Values of all variables of a design, in the units of the file.
    fn values_of(&self, changes: &[f64]) -> Vec<f64> {
        changes.iter().enumerate().map(|(k, b)| shown(&self.whole, VariableId(k), *b)).collect()
    }

    /// Variables with these names, or all.
    fn variables(&self, names: &[String]) -> Result<Vec<VariableId>, Failure> {
        let model = &self.whole.model;
        if names.is_empty() {
            return Ok((0..model.variables.len()).map(VariableId).collect());
        }
        let one = |name: &String| {
            model.variable(name).ok_or_else(|| {
                let near = did_you_mean(name, model.variables.iter().map(|v| v.name.as_str()));
                let help = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
                Failure::Misunderstood(format!("there is no design variable named `{name}`{help}"))
            })
        };
        names.iter().map(one).collect()
    }
}

#[pymethods]
impl Model {
    /// Optimises the design.
    #[pyo3(signature = (first=0, starts=None, iterations=None, workers=None, progress=None))]
    fn optimize(
        &self,
        py: Python<'_>,
        first: usize,
        starts: Option<usize>,
        iterations: Option<usize>,
        workers: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Searched> {
        let (file, motions) = (&self.whole, self.motions()?);
        let Some(asked) = &file.model.optimization else {
            return Err(Failure::of_study(
                "the model has no `[optimize]` table; add `[optimize.goals]` with the metrics to minimise, and `bounds` to \
                 the design variables that may change",
            )
            .into());
        };
        let mut asked = asked.clone();
        asked.starts = starts.unwrap_or(asked.starts).max(1);
        asked.iterations = iterations.unwrap_or(asked.iterations).max(1);
        let found = patiently(py, progress, |watch| {
            let mut ended = 0;
            let mut report = |_: usize, event: SearchProgress<'_>| match event {
                SearchProgress::Iteration(i) if asked.starts == 1 => watch.tell(i.number, asked.iterations),
                SearchProgress::End(_) if asked.starts > 1 => {
                    ended += 1;
                    watch.tell(ended, asked.starts)
                }
                _ => flow(watch.more()),
            };
            let searching = OptimizationRequest {
                progress: &mut report,
                more: &|| watch.more(),
                threads: threads(workers),
                first,
            };
            optimize(&file.model, motions, &asked, searching)
        })?;
        let facts = OptimizeFacts::of(file, &asked, &found);
        let best = found.best.and_then(|k| found.searches[k].found.as_ref());
        let exact = best.map(|best| self.values_of(&best.design));
        let design = best.map(|best| self.values_of(&rounded(file, &asked, &best.design)));
        Ok((outcome(&facts, &facts.tables()), design, exact))
    }

    /// Runs the tolerance study.
    #[pyo3(signature = (samples=None, seed=None, allocate=None, workers=None, progress=None))]
    fn tolerance(
        &self,
        py: Python<'_>,
        samples: Option<usize>,
        seed: Option<u64>,
        allocate: Option<&str>,
        workers: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<String> {
        let (file, motions) = (&self.whole, self.motions()?);
        let asked = file.model.tolerancing.clone().or_else(|| ToleranceSettings::of_variables(&file.model));
        let Some(mut asked) = asked else {
            return Err(Failure::of_study(
                "the design variables of the model have no tolerances; add `tolerance = 0.1` to those in `[design]` or \
                 `[parameters]`",
            )
            .into());
        };
        asked.samples = samples.unwrap_or(asked.samples);
        asked.seed = seed.unwrap_or(asked.seed);
        if let Some(rule) = allocate {
            let rule = match (rule, asked.allocation.map(|a| a.rule)) {
                ("rss", Some(rule @ AllocationRule::Rss { .. })) => rule,
                ("rss", _) => AllocationRule::Rss { sigmas: ToleranceSettings::SIGMAS },
                ("worst_case", _) => AllocationRule::Worst,
                _ => {
                    return Err(Failure::Misunderstood(format!(
                        "unknown rule `{rule}`; there are rss, worst_case"
                    ))
                    .into());
                }
            };
            asked.allocation = Some(AllocationSettings { rule });
        }
        let numbers: Vec<usize> = (0..motions.len()).collect();
        let found = patiently(py, progress, |watch| {
            let mut on = |stage: ToleranceStage| match stage {
                ToleranceStage::Derivatives(done, of) | ToleranceStage::Designs(done, of) => {
                    watch.tell(done, of)
                }
            };
            tolerance(&file.model, motions, &numbers, &asked, threads(workers), &mut on, &|| watch.more())
        })?;
        let found = found.map_err(|failure| match failure {
            ToleranceError::Nominal(rejection) => {
                let case = &self.cases[rejection.motion];
                Failure::of_model(Kind::Stopped, case, &diagnose::stop(case, &rejection.stop, 0, None))
            }
            ToleranceError::NothingVaries => Failure::of_study(
                "none of the variables with a tolerance is admissible; give tolerances to admissible variables",
            ),
        })?;
        let facts =
            ToleranceFacts::of(&ToleranceInputs { file, numbers: &numbers, asked: &asked, found: &found });
        Ok(outcome(&facts, &facts.tables()))
    }

    /// Monte Carlo designs of the tolerance study by number: `[design, variable]`.
    #[pyo3(signature = (numbers, seed=None))]
    fn drawn_designs<'py>(
        &self,
        py: Python<'py>,
        numbers: Vec<usize>,
        seed: Option<u64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (file, motions) = (&self.whole, self.motions()?);
        let asked = file.model.tolerancing.clone().or_else(|| ToleranceSettings::of_variables(&file.model));
        let Some(mut asked) = asked else {
            return Err(Failure::of_study("the model has no design variables with tolerances").into());
        };
        asked.seed = seed.unwrap_or(asked.seed);
        let left_out = py.detach(|| {
            let mut left_out = Vec::new();
            for analysis in motions.analyses() {
                let known = analysis.run().sensitivities.admissibility;
                let resists = |b: &usize| matches!(known.get(*b), Some(Admissibility::CannotFollow { .. }));
                left_out.extend((0..known.len()).filter(resists).map(VariableId));
            }
            left_out
        });
        let design = toleranced_designs(&file.model, &asked, &left_out);
        let rows: Vec<f64> = numbers.iter().flat_map(|n| self.values_of(&design(*n))).collect();
        array(py, rows, [numbers.len(), file.model.variables.len()])
    }

    /// Fits the design to measured data: the result, and the fitted design.
    #[pyo3(signature = (measured, sigmas, variables, loss, iterations, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "a call of Python")]
    fn calibrate(
        &self,
        py: Python<'_>,
        measured: &str,
        sigmas: Vec<(String, f64)>,
        variables: Vec<String>,
        loss: &str,
        iterations: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(String, Vec<f64>)> {
        let file = &self.whole;
        let variables = self.variables(&variables)?;
        let table = file.measured(Path::new(measured), &sigmas).map_err(|found| Failure::of_text(&found))?;
        let loss = match loss {
            "squares" => Loss::Squares,
            "huber" => Loss::Huber,
            "cauchy" => Loss::Cauchy,
            _ => {
                return Err(Failure::Misunderstood(format!(
                    "unknown loss `{loss}`; there are squares, huber, cauchy"
                ))
                .into());
            }
        };
        let asked = CalibrationRequest {
            measured: &table.measurements,
            variables: &variables,
            loss,
            formulation: Formulation::Relative,
            iterations,
        };
        let found = patiently(py, progress, |watch| {
            let mut report = |k: usize, _: f64| {
                let _ = watch.tell(k, iterations);
            };
            calibrate(&file.model, &asked, &mut report, &|| watch.more())
        })?;
        let found = found.map_err(|why| match why {
            CalibrationError::Topology(fault) => Failure::of_model(Kind::Topology, file, &diagnose::topology_fault(file, &fault)),
            CalibrationError::NothingReached(why) => {
                Failure::of_study(format!("no posture of the table can be reached; error on the path to the first: {why}"))
            }
            CalibrationError::NothingVaries => Failure::of_study("none of the variables to fit is admissible"),
            CalibrationError::TooFewReadings { readings, variables } => Failure::of_study(format!(
                "{readings} readings without standard deviations do not determine {variables} variables and their standard deviation; give `sigma`, \
                 seek fewer variables, or measure more"
            )),
        })?;
        let facts = CalibrateFacts::of(&CalibrationInputs {
            file,
            measured: &table,
            data: measured,
            loss,
            found: &found,
        });
        Ok((outcome(&facts, &facts.tables()), self.values_of(&found.design)))
    }

    /// Effect of a changed design, exact and predicted.
    fn what_if(&self, py: Python<'_>, case: usize, design: Vec<f64>) -> PyResult<String> {
        let (file, analysis, changes) = (&self.cases[case], self.analysis(case)?, self.changes(&design)?);
        let facts = patiently(py, None, |watch| {
            let analysis = &watch.over(analysis);
            let today = analysis.run();
            if let Some(stop) = &today.stop {
                return Err(Failure::of_model(
                    Kind::Stopped,
                    file,
                    &diagnose::stop(file, stop, today.motion.len(), None),
                ));
            }
            let facts = WhatIfFacts::of_today(file, analysis.topology(), &today);
            if changes.iter().all(|b| *b == 0.0) {
                return Ok(facts);
            }
            let changed = what_if(analysis, today, &changes);
            if let Some(stop) = &changed.exact.stop {
                let diagnostic = diagnose::stop_of_changed(file, stop, changed.exact.motion.len());
                return Err(Failure::of_model(Kind::Stopped, file, &diagnostic));
            }
            Ok(facts.changed(file, analysis.topology(), &changed))
        })??;
        let tables = [facts.table(&|_| true)];
        Ok(outcome(&facts, &tables))
    }

    /// Compares the sensitivities with finite differences of re-solved designs.
    #[pyo3(signature = (case, progress=None))]
    fn verify(&self, py: Python<'_>, case: usize, progress: Option<Py<PyAny>>) -> PyResult<String> {
        let (file, analysis) = (&self.cases[case], self.analysis(case)?);
        let found = patiently(py, progress, |watch| {
            let analysis = &watch.over(analysis);
            let solution = analysis.run();
            if let Some(stop) = &solution.stop {
                return Err(Failure::of_model(
                    Kind::Stopped,
                    file,
                    &diagnose::stop(file, stop, solution.motion.len(), None),
                ));
            }
            let tell = |done: usize| watch.tell(done, file.model.variables.len());
            Ok(verify(analysis, &solution, &VerifyOptions::new(DifferenceScheme::Central), tell))
        })??;
        let verdict = Verdict::new(file, analysis, &found, 0.0);
        Ok(outcome(&verdict, &[verdict.table()]))
    }

    /// Linear range of the sensitivities.
    fn validity(&self, py: Python<'_>, case: usize) -> PyResult<String> {
        let (file, analysis): (_, &Analysis<'_>) = (&self.cases[case], self.analysis(case)?);
        let found = patiently(py, None, |watch| {
            let analysis = &watch.over(analysis);
            let solution = analysis.run();
            if let Some(stop) = &solution.stop {
                return Err(Failure::of_model(
                    Kind::Stopped,
                    file,
                    &diagnose::stop(file, stop, solution.motion.len(), None),
                ));
            }
            let found = validity(analysis, &solution, |_| watch.more());
            Ok(ValidityFact::all(&file.model, file.units, &solution, &found))
        })??;
        Ok(json!(found).to_string())
    }

    /// Solves the cases that sweep two drivers over a grid.
    #[pyo3(signature = (progress=None))]
    fn maps(&self, py: Python<'_>, progress: Option<Py<PyAny>>) -> PyResult<String> {
        let file = &self.whole;
        let found = patiently(py, progress, |watch| {
            let mut maps = Vec::new();
            for (k, grid) in file.model.grids.iter().enumerate() {
                let more = || watch.more();
                let map = GridMap::solve(&file.model, grid, Formulation::Relative, &[], &more).map_err(
                    |fault| Failure::of_model(Kind::Topology, file, &diagnose::topology_fault(file, &fault)),
                )?;
                maps.push(MapFact::of(&file.model, file.units, &map));
                if let ControlFlow::Break(()) = watch.tell(k + 1, file.model.grids.len()) {
                    break;
                }
            }
            Ok::<_, Failure>(maps)
        })??;
        Ok(json!(found).to_string())
    }
}

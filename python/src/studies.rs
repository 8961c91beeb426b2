//! Studies of a model; the result is the JSON that the command line writes, with its tables.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use hardpoint::Analysis;
use hardpoint::model::{CaseId, PriorGroup, VariableId};
use hardpoint::sensitivity::Admissibility;
use hardpoint::topology::Formulation;
use hardpoint_file::{Diagnostics, ModelFile};
use hardpoint_report::calibrate::{CalibrateFacts, CalibrationInputs};
use hardpoint_report::diagnose;
use hardpoint_report::maps::MapFact;
use hardpoint_report::optimize::{OptimizeFacts, file_of_variant, placed, rounded};
use hardpoint_report::page::Table;
use hardpoint_report::tolerance::{ToleranceFacts, ToleranceInputs, nominal_stop};
use hardpoint_report::trade_off::{TradeOffFacts, TradeOffInputs};
use hardpoint_report::validity::ValidityFact;
use hardpoint_report::verdict::Verdict;
use hardpoint_report::whatif::WhatIfFacts;
use hardpoint_study::calibrate::{self, Loss, calibrate};
use hardpoint_study::difference::DifferenceScheme;
use hardpoint_study::grid::GridMap;
use hardpoint_study::optimize::{self, Variant, optimize};
use hardpoint_study::request::variable;
use hardpoint_study::tolerance::{self, tolerance, toleranced_designs};
use hardpoint_study::trade_off::{self, trade_off};
use hardpoint_study::verify::{self, verify};
use hardpoint_study::whatif::what_if;
use hardpoint_study::{Control, Motions, Progress, RequestError, validity};
use pyo3::prelude::*;
use serde::Serialize;
use serde_json::json;

use crate::array::array;
use crate::designs::threads;
use crate::failure::{Failure, Kind};
use crate::model::Model;
use crate::watch::patiently;

/// Runs a study that reports its progress and stops when it is interrupted.
fn controlled<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    threads: NonZero<usize>,
    study: impl FnOnce(Control<'_>) -> T + Send,
) -> Result<T, Failure> {
    patiently(py, progress, |watch| {
        let mut progress = |p: Progress<'_>| watch.tell(p.done, p.total);
        study(Control { threads, progress: &mut progress, more: &|| watch.more() })
    })
}

/// Result of a study.
fn outcome(facts: &impl Serialize, tables: &[Table]) -> String {
    json!({ "facts": facts, "tables": tables }).to_string()
}

/// Result of a search: the facts, the optimised design with rounded numbers, and the exact one.
type Searched = (String, Option<Vec<f64>>, Option<Vec<f64>>);
/// Group of variables with a common deviation: its name, its members, and the deviation of a member in their unit.
type Group = (String, Vec<String>, f64);

/// The group of a model.
fn prior_group(file: &ModelFile, (name, members, within): Group) -> Result<PriorGroup, RequestError> {
    let members = members.iter().map(|name| variable(&file.model, name));
    let variables = members.collect::<Result<Vec<VariableId>, RequestError>>()?;
    let quantity = variables.first().map(|v| file.model.variables[v.0].quantity);
    let within = quantity.map_or(within, |quantity| file.units.to_si(quantity, within));
    Ok(PriorGroup { name, variables, within })
}

impl Model {
    /// Values of all variables of a design, in the units of the file.
    fn values_of(&self, changes: &[f64]) -> Vec<f64> {
        changes.iter().enumerate().map(|(k, b)| self.whole.value_of(VariableId(k), *b)).collect()
    }

    /// Numbers and motions of a study over one case, or over all.
    pub fn motions_of(&self, case: Option<usize>) -> Result<(Vec<usize>, Motions<'static>), Failure> {
        let analyses = self.motions()?.analyses();
        let numbers = case.map_or_else(|| (0..analyses.len()).collect(), |k| vec![k]);
        let chosen: Vec<_> = numbers.iter().map(|k| analyses[*k].clone()).collect();
        Ok((numbers, chosen.into()))
    }

    /// File and motions of a search over one case, with its goals and limits, or over all.
    fn searched(&self, case: Option<usize>) -> Result<(ModelFile, Motions<'static>), Failure> {
        let mut file = self.whole.clone();
        let Some(case) = case else { return Ok((file, self.motions_of(None)?.1)) };
        file.model = file.model.with_case_only(CaseId(case));
        let motions = Motions::of(file.model.motions().into_iter().map(Arc::new), Formulation::Relative);
        let motions = motions.map_err(|(_, fault)| {
            Failure::of_model(Kind::Topology, &file, &diagnose::topology_fault(&file, &fault))
        })?;
        Ok((file, motions))
    }

    /// This model in the assembly and sense of a variant, with the placements of a design.
    fn in_variant(&self, variant: &Variant, design: &[f64]) -> Result<Self, Diagnostics> {
        let (file, motions) = file_of_variant(&self.whole, variant, Formulation::Relative)?;
        // Variables that `with_coordinates` has added come last, are not in the text, and do not change.
        let design = &design[..file.model.variables.len()];
        Ok(Self::new(placed(&file, &motions, design)?))
    }
}

#[pymethods]
impl Model {
    /// Optimises the design: the result, and the model in the assembly and sense of the optimum, if these are not its
    /// own.
    #[pyo3(signature = (
        case=None, first=0, starts=None, iterations=None, workers=None, progress=None,
        other_assemblies=Some(false), both_senses=Some(false)
    ))]
    #[expect(clippy::too_many_arguments, reason = "a call of Python")]
    fn optimize(
        &self,
        py: Python<'_>,
        case: Option<usize>,
        first: usize,
        starts: Option<usize>,
        iterations: Option<usize>,
        workers: Option<usize>,
        progress: Option<Py<PyAny>>,
        other_assemblies: Option<bool>,
        both_senses: Option<bool>,
    ) -> PyResult<(Searched, Option<Self>)> {
        let (file, motions) = &self.searched(case)?;
        let overrides = optimize::Overrides {
            starts,
            iterations,
            first,
            other_assemblies,
            both_senses,
            ..optimize::Overrides::default()
        };
        let request = optimize::Request::of(&file.model, overrides).map_err(Failure::from)?;
        let asked = &request.settings;
        let found = controlled(py, progress, threads(workers), |control| {
            optimize(&file.model, motions, &request, control)
        })?;
        let mut facts = OptimizeFacts::of(file, asked, &found);
        let best = found.best.and_then(|k| found.searches[k].found.as_ref());
        let exact = best.map(|best| self.values_of(&best.design));
        let mut saved = best.map(|best| rounded(file, asked, &best.design));
        let variant = found.best.map(|k| &found.variants[found.searches[k].variant]);
        let other = variant.filter(|variant| !variant.is_own()).zip(saved.as_ref());
        let other = match other.map(|(variant, design)| self.in_variant(variant, design)).transpose() {
            Ok(other) => other,
            Err(found) => {
                facts.not_saved(&found.list().first().map_or(String::new(), |d| d.message.clone()));
                saved = None;
                None
            }
        };
        let design = saved.map(|design| self.values_of(&design));
        Ok(((outcome(&facts, &facts.tables()), design, exact), other))
    }

    /// Trades goals against each other; the design is that of a point, by default of the balanced compromise.
    #[pyo3(signature = (
        goals, case=None, points=None, point=None, starts=None, iterations=None, workers=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "a call of Python")]
    fn trade_off(
        &self,
        py: Python<'_>,
        goals: Vec<String>,
        case: Option<usize>,
        points: Option<usize>,
        point: Option<usize>,
        starts: Option<usize>,
        iterations: Option<usize>,
        workers: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Searched> {
        let (file, motions) = &self.searched(case)?;
        let overrides = trade_off::Overrides { goals, points, starts, iterations };
        let request = trade_off::Request::of(&file.model, overrides).map_err(Failure::from)?;
        request.check_point(point).map_err(Failure::from)?;
        let found = controlled(py, progress, threads(workers), |control| {
            trade_off(&file.model, motions, &request, control)
        })?;
        let asked = &request.settings;
        let facts = TradeOffFacts::of(&TradeOffInputs { file, asked, found: &found });
        let chosen = point.or(facts.balanced).and_then(|k| found.points.get(k));
        let exact = chosen.map(|p| self.values_of(&p.assessment.design));
        let design = chosen.map(|p| self.values_of(&rounded(file, asked, &p.assessment.design)));
        Ok((outcome(&facts, &facts.tables()), design, exact))
    }

    /// Runs the tolerance study.
    #[pyo3(signature = (case=None, samples=None, seed=None, allocate=None, workers=None, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "a call of Python")]
    fn tolerance(
        &self,
        py: Python<'_>,
        case: Option<usize>,
        samples: Option<usize>,
        seed: Option<u64>,
        allocate: Option<String>,
        workers: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<String> {
        let (file, (numbers, motions)) = (&self.whole, &self.motions_of(case)?);
        let rule = allocate.as_deref().map(tolerance::allocation_rule);
        let allocate = rule.transpose().map_err(Failure::from)?;
        let overrides = tolerance::Overrides { samples, seed, allocate };
        let request = tolerance::Request::of(&file.model, &overrides).map_err(Failure::from)?;
        let found = controlled(py, progress, threads(workers), |control| {
            tolerance(&file.model, motions, numbers, &request, control)
        })?;
        let found = found.map_err(|error| match error {
            tolerance::Error::Nominal(stopped) => {
                let (of_motion, diagnostic) = nominal_stop(file, motions, numbers, &stopped);
                Failure::of_model(Kind::Stopped, &of_motion, &diagnostic)
            }
            tolerance::Error::Request(error) => error.into(),
        })?;
        let asked = &request.settings;
        let facts = ToleranceFacts::of(&ToleranceInputs { file, numbers, asked, found: &found });
        Ok(outcome(&facts, &facts.tables()))
    }

    /// Monte Carlo designs of the tolerance study by number: `[design, variable]`.
    #[pyo3(signature = (numbers, case=None, seed=None))]
    fn drawn_designs<'py>(
        &self,
        py: Python<'py>,
        numbers: Vec<usize>,
        case: Option<usize>,
        seed: Option<u64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (file, (_, motions)) = (&self.whole, &self.motions_of(case)?);
        let overrides = tolerance::Overrides { seed, ..Default::default() };
        let request = tolerance::Request::of(&file.model, &overrides).map_err(Failure::from)?;
        let left_out = py.detach(|| {
            let mut left_out = Vec::new();
            for analysis in motions.analyses() {
                let known = analysis.run().sensitivities.admissibility;
                let resists = |b: &usize| matches!(known.get(*b), Some(Admissibility::CannotFollow { .. }));
                left_out.extend((0..known.len()).filter(resists).map(VariableId));
            }
            left_out
        });
        let design = toleranced_designs(&file.model, &request.settings, &left_out);
        let rows: Vec<f64> = numbers.iter().flat_map(|n| self.values_of(&design(*n))).collect();
        array(py, rows, [numbers.len(), file.model.variables.len()])
    }

    /// Fits the design to measured data: the result, and the fitted design.
    #[pyo3(signature = (
        measured, sigmas, variables, loss, iterations, priors, priors_from, groups, offsets, validate, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "a call of Python")]
    fn calibrate(
        &self,
        py: Python<'_>,
        measured: &str,
        sigmas: Vec<(String, f64)>,
        variables: Vec<String>,
        loss: &str,
        iterations: Option<usize>,
        priors: Vec<(String, f64)>,
        priors_from: Option<String>,
        groups: Vec<Group>,
        offsets: Vec<String>,
        validate: Option<&str>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(String, Vec<f64>)> {
        let file = &self.whole;
        let table = file.measured(Path::new(measured), &sigmas).map_err(|found| Failure::of_text(&found))?;
        let loss = Loss::named(loss).map_err(Failure::from)?;
        let formulation = Formulation::Relative;
        let others = validate.map(|path| file.measured(Path::new(path), &sigmas)).transpose();
        let others = others.map_err(|found| Failure::of_text(&found))?;
        let prior = |(name, sigma): (String, f64)| {
            let variable = variable(&file.model, &name)?;
            Ok((variable, file.units.to_si(file.model.variables[variable.0].quantity, sigma)))
        };
        let priors = priors.into_iter().map(prior).collect::<Result<_, RequestError>>();
        let groups =
            groups.into_iter().map(|group| prior_group(file, group)).collect::<Result<_, RequestError>>();
        let overrides = calibrate::Overrides {
            variables,
            priors: priors.map_err(Failure::from)?,
            priors_from,
            groups: groups.map_err(Failure::from)?,
            offsets,
            validation: others.as_ref().map(|data| &data.measurements),
            loss,
            formulation,
            iterations,
        };
        let request =
            calibrate::Request::of(&file.model, &table.measurements, &overrides).map_err(Failure::from)?;
        let found = controlled(py, progress, NonZero::<usize>::MIN, |control| {
            calibrate(&file.model, &request, control)
        })?;
        let found = found.map_err(|error| match error {
            calibrate::Error::Topology(fault) => {
                Failure::of_model(Kind::Topology, file, &diagnose::topology_fault(file, &fault))
            }
            calibrate::Error::Request(error) => error.into(),
        })?;
        let facts = CalibrateFacts::of(&CalibrationInputs {
            file,
            measured: &table,
            data: measured,
            validation: others.as_ref().zip(validate),
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
            let tell = |p: Progress<'_>| watch.tell(p.done, p.total);
            Ok(verify(analysis, &solution, &verify::Options::new(DifferenceScheme::Central), tell))
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

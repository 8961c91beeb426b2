//! Sweeps over designs: in one call, or in parts on several workers.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::draft::did_you_mean;
use hardpoint::model::{SweepMethod, SweepRange, SweepSettings, VariableId};
use hardpoint_report::cells::Cells;
use hardpoint_report::sweep::{SweepInputs, Tally};
use hardpoint_study::BLOCK;
use hardpoint_study::sweep::{Sweep as Designs, SweepPlanError, SweptBlock};
use pyo3::prelude::*;
use pyo3::types::PyList;
use serde::Deserialize;
use serde_json::json;

use crate::array::array1;
use crate::design::drawn;
use crate::designs::threads;
use crate::failure::Failure;
use crate::model::Model;
use crate::watch::patiently;

/// Options that override the file.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Asked {
    method: Option<String>,
    samples: Option<usize>,
    seed: Option<u64>,
    levels: Option<usize>,
    ranges: BTreeMap<String, [f64; 2]>,
    curves: Vec<String>,
    designs: Option<String>,
    cases: Vec<usize>,
}

/// A sweep that can be solved in parts. A part is the same on every worker, to the last bit.
#[pyclass(frozen, module = "hardpoint._native")]
pub(crate) struct Sweep {
    model: Py<Model>,
    asked: SweepSettings,
    motions: hardpoint_study::Motions<'static>,
    numbers: Vec<usize>,
}

impl Model {
    fn sweeping(&self, asked: &Asked) -> Result<SweepSettings, Failure> {
        let model = &self.whole.model;
        let mut all = model.sweeping.clone().unwrap_or_else(|| SweepSettings::of_bounds(model));
        if let Some(path) = &asked.designs {
            let (ranges, listed) =
                self.whole.designs(Path::new(path)).map_err(|found| Failure::of_text(&found))?;
            all = SweepSettings { method: SweepMethod::Listed, ranges, listed, ..all };
        }
        let refused = |why: String| Err(Failure::Misunderstood(why));
        if let Some(name) = &asked.method {
            let Some(k) = SweepMethod::NAMES.iter().position(|known| known == name) else {
                return refused(format!(
                    "unknown method `{name}`; there are {}",
                    SweepMethod::NAMES.join(", ")
                ));
            };
            all.method = SweepMethod::NAMED[k];
        }
        all.samples = asked.samples.unwrap_or(all.samples);
        all.seed = asked.seed.unwrap_or(all.seed);
        if let Some(levels) = asked.levels {
            all.ranges.iter_mut().for_each(|range| range.levels = levels);
        }
        for (name, [from, to]) in &asked.ranges {
            let names = || model.variables.iter().map(|v| v.name.as_str());
            let Some(k) = names().position(|known| known == name) else {
                let near =
                    did_you_mean(name, names()).map_or(String::new(), |n| format!("; did you mean `{n}`?"));
                return refused(format!("there is no design variable named `{name}`{near}"));
            };
            if !(from < to) || !(to - from).is_finite() {
                return refused(format!(
                    "the range of `{name}` is not in ascending order; give the lower end first"
                ));
            }
            let variable = VariableId(k);
            let change = |x: f64| match x == drawn(&self.whole, variable) {
                true => 0.0,
                false => {
                    self.whole.units.to_si(model.variables[k].quantity, x) - model.nominal_value(variable)
                }
            };
            let levels = asked
                .levels
                .or_else(|| all.ranges.first().map(|r| r.levels))
                .unwrap_or(SweepSettings::LEVELS);
            let one = SweepRange { variable, low: change(*from), high: change(*to), levels };
            match all.ranges.iter_mut().find(|r| r.variable == variable) {
                Some(range) => *range = SweepRange { levels: range.levels, ..one },
                None => all.ranges.push(one),
            }
        }
        for name in &asked.curves {
            let names = || model.measures.iter().map(|m| m.name.as_str());
            let Some(k) = names().position(|known| known == name) else {
                let near =
                    did_you_mean(name, names()).map_or(String::new(), |n| format!("; did you mean `{n}`?"));
                return refused(format!("there is no measure named `{name}`{near}"));
            };
            if !all.curves.contains(&k) {
                all.curves.push(k);
            }
        }
        if all.metrics.is_empty() && all.curves.is_empty() {
            return refused("the model has no metrics to compare designs; name curves to store".into());
        }
        Ok(all)
    }
}

#[pymethods]
impl Model {
    /// Creates a sweep over designs; the options are JSON.
    fn sweep(this: Bound<'_, Self>, asked: &str) -> PyResult<Sweep> {
        let asked: Asked = serde_json::from_str(asked).map_err(|e| Failure::Misunderstood(e.to_string()))?;
        let model = this.get();
        let motions = model.motions()?;
        let numbers: Vec<usize> =
            if asked.cases.is_empty() { (0..motions.len()).collect() } else { asked.cases.clone() };
        let motions = hardpoint_study::Motions::from(
            numbers.iter().map(|k| motions.analyses()[*k].clone()).collect::<Vec<_>>(),
        );
        let asked = model.sweeping(&asked)?;
        let sweep = Sweep { model: this.unbind(), asked, motions, numbers };
        sweep.with(|_| ())?;
        Ok(sweep)
    }
}

impl Sweep {
    /// Plans the sweep and its tables.
    fn with<X>(&self, of: impl FnOnce(SweepInputs<'_>) -> X) -> Result<X, Failure> {
        let file = &self.model.get().whole;
        let designs = Designs::new(&file.model, &self.motions, &self.numbers, &self.asked).map_err(|why| {
            Failure::Misunderstood(match why {
                SweepPlanError::NoRanges => "the model has no ranges of design variables; give `ranges`".into(),
                SweepPlanError::NoDesigns => "there are no designs; give at least one sample".into(),
                SweepPlanError::TooMany => format!("the sweep has more than {} designs; give fewer levels or variables", SweepSettings::MOST),
                SweepPlanError::TooManyDimensions(most) => format!(
                    "Sobol's sequence is known for {most} variables, and for indices for {}; sweep over fewer, or by latin_hypercube",
                    most / 2
                ),
            })
        })?;
        Ok(of(SweepInputs {
            file,
            numbers: &self.numbers,
            asked: &self.asked,
            motions: &self.motions,
            sweep: &designs,
        }))
    }
}

/// Columns of a table: name, and cells as an array or a list of texts.
type Columns<'py> = Vec<(String, Bound<'py, PyAny>)>;

fn table<'py>(
    py: Python<'py>,
    columns: Vec<(String, Cells)>,
    blocks: Vec<Vec<Cells>>,
) -> PyResult<Columns<'py>> {
    let mut columns = columns;
    for block in blocks {
        columns.iter_mut().zip(block).for_each(|((_, cells), more)| cells.append(more));
    }
    let array = |(name, cells)| {
        let cells = match cells {
            Cells::Whole(cells) => array1(py, cells).into_any(),
            Cells::Numbers(cells) => array1(py, cells).into_any(),
            Cells::Texts(cells) => PyList::new(py, cells)?.into_any(),
        };
        Ok((name, cells))
    };
    columns.into_iter().map(array).collect()
}

#[pymethods]
impl Sweep {
    /// Number of designs.
    #[getter]
    fn count(&self) -> PyResult<usize> {
        Ok(self.with(|swept| swept.sweep.plan().count())?)
    }

    /// Number of designs per block; parts begin with a multiple of it.
    #[getter]
    fn block(&self) -> usize {
        BLOCK
    }

    /// Solves some designs; returns the tables of designs and of curves. `from` is a multiple of `block`; `to` is, too,
    /// or is the end.
    #[pyo3(signature = (from, to, workers=None, progress=None))]
    fn part<'py>(
        &self,
        py: Python<'py>,
        from: usize,
        to: usize,
        workers: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Columns<'py>, Columns<'py>)> {
        let (columns, rows, curve_columns, curves) = patiently(py, progress, |watch| {
            self.with(|swept| {
                let to = to.min(swept.sweep.plan().count());
                let (mut rows, mut curves) = (Vec::new(), Vec::new());
                let has_curves = !self.asked.curves.is_empty();
                let mut done = |block: SweptBlock| {
                    rows.push(swept.rows(&block));
                    if has_curves {
                        curves.push(swept.curve_rows(&block));
                    }
                    match watch.tell(block.numbers.end - from, to - from) {
                        ControlFlow::Continue(()) if block.numbers.end < to => ControlFlow::Continue(()),
                        _ => ControlFlow::Break(()),
                    }
                };
                if from < to {
                    // Other threads would start blocks beyond the end.
                    let threads = if to == swept.sweep.plan().count() {
                        threads(workers)
                    } else {
                        std::num::NonZero::<usize>::MIN
                    };
                    swept.sweep.run(from, threads, &|| watch.more(), &mut done);
                }
                (swept.columns(), rows, if has_curves { swept.curve_columns() } else { Vec::new() }, curves)
            })
        })??;
        Ok((table(py, columns, rows)?, table(py, curve_columns, curves)?))
    }

    /// Solves all designs; returns the tables of designs and of curves, and the summary.
    #[pyo3(signature = (workers=None, progress=None))]
    fn run<'py>(
        &self,
        py: Python<'py>,
        workers: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Columns<'py>, Columns<'py>, String)> {
        let found = patiently(py, progress, |watch| {
            self.with(|swept| {
                let count = swept.sweep.plan().count();
                let (mut rows, mut curves, mut tally) = (Vec::new(), Vec::new(), Tally::default());
                let mut metrics = vec![Vec::new(); swept.sweep.metrics().len()];
                let has_curves = !self.asked.curves.is_empty();
                let mut done = |block: SweptBlock| {
                    swept.tally(&mut tally, &block);
                    rows.push(swept.rows(&block));
                    if has_curves {
                        curves.push(swept.curve_rows(&block));
                    }
                    metrics.iter_mut().zip(&block.metrics).for_each(|(all, more)| all.extend(more));
                    watch.tell(block.numbers.end, count)
                };
                swept.sweep.run(0, threads(workers), &|| watch.more(), &mut done);
                let facts = swept.facts(&tally, |k| Ok(metrics[k].clone())).map(|(facts, _)| facts);
                let facts = facts.expect("columns in memory can be read");
                let tables = facts.tables();
                let json = json!({ "facts": facts, "tables": tables }).to_string();
                (
                    swept.columns(),
                    rows,
                    if has_curves { swept.curve_columns() } else { Vec::new() },
                    curves,
                    json,
                )
            })
        })??;
        let (columns, rows, curve_columns, curves, json) = found;
        Ok((table(py, columns, rows)?, table(py, curve_columns, curves)?, json))
    }
}

//! Sweeps over designs: in one call, or in parts on several workers.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

use hardpoint_report::cells::Cells;
use hardpoint_report::sweep::{SweepInputs, Tally};
use hardpoint_study::request::variable;
use hardpoint_study::sweep::{self, Overrides, Request, Sweep as Designs, method};
use hardpoint_study::{BLOCK, RequestError};
use pyo3::prelude::*;
use pyo3::types::PyList;
use serde::Deserialize;
use serde_json::json;

use crate::array::array1;
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
    case: Option<usize>,
}

/// A sweep that can be solved in parts. A part is the same on every worker, to the last bit.
#[pyclass(frozen, module = "hardpoint._native")]
pub(crate) struct Sweep {
    model: Py<Model>,
    asked: Request,
    motions: hardpoint_study::Motions<'static>,
    numbers: Vec<usize>,
}

impl Model {
    fn sweeping(&self, asked: Asked) -> Result<Request, Failure> {
        let file = &self.whole;
        let designs = asked.designs.map(|path| file.designs(Path::new(&path))).transpose();
        let range = |(name, ends): (String, [f64; 2])| {
            let variable = variable(&file.model, &name)?;
            Ok((variable, ends.map(|x| file.change_to(variable, x))))
        };
        let overrides = Overrides {
            designs: designs.map_err(|found| Failure::of_text(&found))?,
            method: asked.method.map(|name| method(&name)).transpose()?,
            samples: asked.samples,
            seed: asked.seed,
            levels: asked.levels,
            ranges: asked.ranges.into_iter().map(range).collect::<Result<_, RequestError>>()?,
            curves: asked.curves,
        };
        Ok(Request::of(&file.model, overrides)?)
    }
}

#[pymethods]
impl Model {
    /// Creates a sweep over designs; the options are JSON.
    fn sweep(this: Bound<'_, Self>, asked: &str) -> PyResult<Sweep> {
        let asked: Asked = serde_json::from_str(asked).map_err(|e| Failure::Misunderstood(e.to_string()))?;
        let model = this.get();
        let (numbers, motions) = model.motions_of(asked.case)?;
        let asked = model.sweeping(asked)?;
        let sweep = Sweep { model: this.unbind(), asked, motions, numbers };
        sweep.with(|_| ())?;
        Ok(sweep)
    }
}

impl Sweep {
    /// Plans the sweep and its tables.
    fn with<X>(&self, of: impl FnOnce(SweepInputs<'_>) -> X) -> Result<X, Failure> {
        let file = &self.model.get().whole;
        let designs = Designs::new(&file.model, &self.motions, &self.numbers, &self.asked)?;
        Ok(of(SweepInputs {
            file,
            numbers: &self.numbers,
            asked: &self.asked.settings,
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
                let has_curves = !self.asked.settings.curves.is_empty();
                let mut done = |block: sweep::Block| {
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
                let has_curves = !self.asked.settings.curves.is_empty();
                let mut done = |block: sweep::Block| {
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

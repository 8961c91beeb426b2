//! A model that has been read.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use hardpoint::Analysis;
use hardpoint::joint::Quantity::{Angle, Length};
use hardpoint::measure::outputs;
use hardpoint::model::{CaseId, Change, OutputSource, VariableId};
use hardpoint::topology::{Formulation, TopologyError};
use hardpoint_file::ModelFile;
use hardpoint_report::diagnose;
use hardpoint_report::figures::variable_unit;
use hardpoint_report::figures::{order_unit, symbol, unit};
use hardpoint_study::Motions;
use hardpoint_study::whatif::{add_coordinates, add_tilts};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::design::changes;
use crate::failure::{Failure, Kind, diagnostic_json};

/// A model with its plans, made once.
#[pyclass(frozen, module = "hardpoint._native")]
pub(crate) struct Model {
    /// The file with all its cases.
    pub whole: ModelFile,
    /// The file in each of its cases, or the file itself without cases.
    pub cases: Vec<ModelFile>,
    planned: OnceLock<Result<Motions<'static>, (usize, TopologyError)>>,
}

impl Model {
    fn new(whole: ModelFile) -> Self {
        let cases = match whole.model.cases.len() {
            0 => vec![whole.clone()],
            n => (0..n).map(|k| whole.in_case(CaseId(k))).collect(),
        };
        Self { whole, cases, planned: OnceLock::new() }
    }

    /// Plans of all motions.
    pub fn motions(&self) -> Result<&Motions<'static>, Failure> {
        let models = || self.cases.iter().map(|file| Arc::new(file.model.clone()));
        let planned = self.planned.get_or_init(|| Motions::of(models(), Formulation::Relative));
        planned.as_ref().map_err(|(k, fault)| {
            let file = &self.cases[*k];
            Failure::of_model(Kind::Topology, file, &diagnose::topology_fault(file, fault))
        })
    }

    /// Plan of one motion.
    pub fn analysis(&self, case: usize) -> Result<&Analysis<'static>, Failure> {
        Ok(&self.motions()?.analyses()[case])
    }

    /// Changes of a design.
    pub fn changes(&self, design: &[f64]) -> Result<Vec<f64>, Failure> {
        changes(&self.whole, design)
    }
}

/// Reads a model file.
#[pyfunction]
pub(crate) fn read(py: Python<'_>, path: &str) -> PyResult<Model> {
    let file = py.detach(|| hardpoint_file::read(Path::new(path)));
    let file = file.map_err(|error| Failure::of_text(error.diagnostics()))?;
    Ok(Model::new(file))
}

/// Reads the text of a model; files that it names are taken from the given texts, or else from a folder.
#[pyfunction]
#[pyo3(signature = (text, name, files=None, folder=None, is_json=false))]
pub(crate) fn parse(
    py: Python<'_>,
    text: &str,
    name: &str,
    files: Option<BTreeMap<String, String>>,
    folder: Option<&str>,
    is_json: bool,
) -> PyResult<Model> {
    let written;
    let text = if is_json {
        written = toml_of(text)?;
        &written
    } else {
        text
    };
    let file = py.detach(|| match files {
        Some(files) => hardpoint_file::parse_with(text, name, &files),
        None => hardpoint_file::parse_in(folder.map(Path::new), text, name),
    });
    Ok(Model::new(file.map_err(|found| Failure::of_text(&found))?))
}

/// Converts a model in JSON to the text of a file.
fn toml_of(json: &str) -> Result<String, Failure> {
    let refused = |why: String| Failure::Misunderstood(format!("the model cannot be written as TOML: {why}"));
    let value: toml::Value = serde_json::from_str(json).map_err(|error| refused(error.to_string()))?;
    toml::to_string(&value).map_err(|error| refused(error.to_string()))
}

#[pymethods]
impl Model {
    /// Text of the file.
    #[getter]
    fn text(&self) -> &str {
        self.whole.text()
    }

    /// Name of the file.
    #[getter]
    fn file(&self) -> &str {
        self.whole.file_name()
    }

    /// Texts of the files that it names.
    #[getter]
    fn files(&self) -> BTreeMap<String, String> {
        self.whole.texts.clone()
    }

    /// Returns the model with a design variable for every coordinate of its hardpoints, and every tilt of its axes.
    fn with_variables(&self, coordinates: bool, tilts: bool) -> Self {
        let mut whole = self.whole.clone();
        if coordinates {
            add_coordinates(&mut whole.model);
        }
        if tilts {
            add_tilts(&mut whole.model);
        }
        Self::new(whole)
    }

    /// Contents of the model, as JSON.
    fn info(&self) -> String {
        let (file, model, units) = (&self.whole, &self.whole.model, self.whole.units);
        let body = |b: hardpoint::model::BodyId| model.bodies[b.0].name.as_str();
        let variables = model.variables.iter().enumerate().map(|(k, v)| {
            let shown = |b: f64| file.value_of(VariableId(k), b);
            let is_parameter = v.changes.iter().any(|c| matches!(c, Change::Parameter(_)));
            json!({
                "name": v.name,
                "unit": variable_unit(model, units, v),
                "drawn": shown(0.0),
                "bounds": v.bounds.map(|b| b.map(shown)),
                "typical": v.typical.map(|x| units.from_si(v.quantity, x)),
                "tolerance": v.tolerance.map(|x| units.from_si(v.quantity, x)),
                "is_parameter": is_parameter,
            })
        });
        let shown = outputs(model);
        let outputs = shown.iter().map(|o| {
            json!({
                "name": o.name,
                "kind": if matches!(o.source, OutputSource::Measure(_)) { "measure" } else { "point" },
                "columns": (0..o.known.orders).map(|k| o.order_name(k)).collect::<Vec<_>>(),
                "units": (0..o.known.orders).map(|k| order_unit(units, o.dimension, k)).collect::<Vec<_>>(),
                "by_position": o.known.by_position,
            })
        });
        let motions = self.cases.iter().map(|case| {
            let metrics = case
                .model
                .metrics
                .iter()
                .map(|m| json!({ "name": m.name, "unit": unit(units, case.model.metric_dimension(m)) }));
            json!({ "case": case.case, "times": case.model.times, "metrics": metrics.collect::<Vec<_>>() })
        });
        let joints = model
            .named_joints()
            .map(|(_, j)| json!({ "name": j.name, "type": j.kind.name, "bodies": j.bodies.map(body) }));
        let drivers = model.drivers.iter().map(|d| {
            json!({ "name": d.name, "joint": model.joints[d.joint.0].name, "coordinate": model.driven(d).name })
        });
        let hardpoints = model.hardpoints.iter().filter(|h| !h.unnamed).map(|h| {
            let place = h.position.to_array().map(|x| units.from_si(Length, x));
            json!({ "name": h.name, "place": place })
        });
        json!({
            "name": model.name,
            "description": file.description,
            "length": symbol(units, Length),
            "angle": symbol(units, Angle),
            "bodies": model.bodies[1..].iter().map(|b| &b.name).collect::<Vec<_>>(),
            "joints": joints.collect::<Vec<_>>(),
            "drivers": drivers.collect::<Vec<_>>(),
            "hardpoints": hardpoints.collect::<Vec<_>>(),
            "variables": variables.collect::<Vec<_>>(),
            "outputs": outputs.collect::<Vec<_>>(),
            "motions": motions.collect::<Vec<_>>(),
            "grids": model.grids.iter().map(|g| &g.name).collect::<Vec<_>>(),
            "remarks": file.remarks.iter().map(|d| diagnostic_json(file, d)).collect::<Vec<Value>>(),
        })
        .to_string()
    }

    /// Raises an error if the mechanism cannot be driven.
    fn plan(&self) -> PyResult<()> {
        self.motions()?;
        Ok(())
    }

    /// Text of the file with a design written into it.
    fn edited(&self, design: Vec<f64>) -> PyResult<String> {
        let values = self.changes(&design)?;
        Ok(self.whole.edit(&values).map_err(|found| Failure::of_text(&found))?)
    }
}

//! A model that has been read.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use hardpoint::Analysis;
use hardpoint::joint::Quantity::{Angle, Length};
use hardpoint::measure::outputs;
use hardpoint::model::{
    BodyId, CaseId, Dimension, Direction, DriverId, ElasticDirection, ElementId, JointId, OutputSource,
    VariableId,
};
use hardpoint::space::Vec3;
use hardpoint::topology::{Formulation, TopologyError};
use hardpoint_file::{Contents, ModelFile};
use hardpoint_report::diagnose;
use hardpoint_report::figures::variable_unit;
use hardpoint_report::figures::{order_unit, symbol, unit};
use hardpoint_study::request::named;
use hardpoint_study::whatif::{add_coordinates, add_tilts, variable_named};
use hardpoint_study::{Motions, position_model};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::design::changes;
use crate::failure::{Failure, Kind, diagnostic_json};
use crate::run::json;

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
    pub fn new(whole: ModelFile) -> Self {
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

/// Reads the text of a model; files that it names are taken from the given texts, and all others from a folder.
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
    let folder = folder.map(Path::new);
    let file = py.detach(|| match (files, folder) {
        (Some(files), Some(folder)) => hardpoint_file::parse_over(folder, &files, text, name),
        (Some(files), None) => hardpoint_file::parse_with(text, name, &files),
        (None, _) => hardpoint_file::parse_in(folder, text, name),
    });
    Ok(Model::new(file.map_err(|found| Failure::of_text(&found))?))
}

/// Converts a model in JSON to the text of a file.
fn toml_of(json: &str) -> Result<String, Failure> {
    written("", json)
}

/// Text of a model with the entries of a nested table in JSON merged into it.
fn written(text: &str, changes: &str) -> Result<String, Failure> {
    let refused = |why: String| Failure::Misunderstood(format!("the model cannot be written as TOML: {why}"));
    let changes: Contents = serde_json::from_str(changes).map_err(|error| refused(error.to_string()))?;
    hardpoint_file::merged(text, &changes).map_err(refused)
}

/// Text of a file with contents in JSON.
#[pyfunction]
pub(crate) fn to_toml(contents: &str) -> PyResult<String> {
    Ok(toml_of(contents)?)
}

/// JSON Schema of model files.
#[pyfunction]
pub(crate) fn schema() -> String {
    hardpoint_file::schema()
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

    /// Names of all files that it reads, relative to its folder.
    #[getter]
    fn file_names(&self) -> Vec<String> {
        self.whole.file_names().into_iter().collect()
    }

    /// Contents of the file as JSON, with the names of the file.
    fn document(&self) -> PyResult<String> {
        let table: toml::Table = toml::from_str(self.whole.text())
            .map_err(|error| Failure::Misunderstood(format!("the text is not TOML: {error}")))?;
        // In the order of the file, which a value of JSON would not have.
        Ok(json(&table))
    }

    /// Contents as JSON with those of included files and mirror images.
    fn composed(&self) -> String {
        json(&self.whole.composed())
    }

    /// Text of the file with the entries of a nested table in JSON merged into it.
    fn merged(&self, changes: &str) -> PyResult<String> {
        Ok(written(self.whole.text(), changes)?)
    }

    /// Returns the model of a position at rest: its variables are those of this model, then the drivers. Forces whose
    /// laws change over time have the given values in the nominal design: N or N m, and for a tyre the height of the
    /// road in the file's unit.
    fn positioned(&self, forces: Vec<(String, f64)>) -> PyResult<Self> {
        let model = &self.whole.model;
        let known = model.given_forces();
        let name = |force: &ElementId| model.elements[force.0].name.as_str();
        let mut values = Vec::new();
        for (force, value) in forces {
            let k = named("force with a law", &force, known.iter().map(name)).map_err(Failure::from)?;
            let (full, dimension) = model.at_unit_law(known[k]);
            if full == 0.0 {
                let why = format!(
                    "force `{force}` is zero in the file, and its law has no effect; give it a magnitude other than zero"
                );
                return Err(Failure::Misunderstood(why).into());
            }
            // The law is a factor of the magnitude in the file.
            values.push((known[k], value / self.whole.units.from_si(dimension, full)));
        }
        let is_given = |force: &ElementId| values.iter().any(|(other, _)| other == force);
        if let Some(force) = known.iter().find(|force| model.varies(**force) && !is_given(force)) {
            let force = name(force);
            let why = format!(
                "force `{force}` changes over time, and a position has none; give its value: `forces={{\"{force}\": 100.0}}`"
            );
            return Err(Failure::Misunderstood(why).into());
        }
        let mut whole = self.whole.clone();
        whole.model = position_model(model, &values);
        Ok(Self::new(whole))
    }

    /// Points of every body in its frame, by joint, and the ends of rods: `[body, x, y, z]`, as JSON.
    fn skeleton(&self, case: usize, design: Vec<f64>) -> PyResult<String> {
        let (model, units) = (&self.cases[case].model, self.whole.units);
        let changes = self.changes(&design)?;
        let geometry = model.geometry(&changes);
        let place = |body: BodyId, at: Vec3| {
            let [x, y, z] = at.to_array().map(|x| units.from_si(Length, x));
            json!([body.0, x, y, z])
        };
        let ends = |id: JointId| {
            let bodies = model.joints[id.0].bodies;
            [0, 1].map(|end| place(bodies[end], geometry.markers[id.0][end].r))
        };
        let joints = model
            .named_joints()
            .map(|(id, j)| json!({ "name": j.name, "is_rod": j.kind.is_rod(), "ends": ends(id) }));
        // A bearing of each body at both hardpoints that define the axis of a hinge.
        let places = model.hardpoint_places(&changes);
        let bearings = model.named_joints().flat_map(|(_, joint)| {
            let ends = match joint.axis {
                Some(Direction::Through(a, b)) if joint.kind.is_hinge => vec![a, b],
                _ => Vec::new(),
            };
            let on_both = ends.into_iter().flat_map(|h| joint.bodies.map(|body| (body, places[h.0])));
            on_both.map(|(body, at)| {
                let local = model.bodies[body.0].frame.inverse().point(at);
                json!({ "name": joint.name, "at": place(body, local) })
            })
        });
        let points = model.points.iter().zip(&geometry.points).filter(|(point, _)| !point.unnamed);
        let points = points.map(|(point, at)| json!({ "name": point.name, "at": place(point.body, *at) }));
        let points = points.chain(bearings);
        Ok(json!({ "joints": joints.collect::<Vec<_>>(), "points": points.collect::<Vec<_>>() }).to_string())
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

    /// Index of a design variable, by its name or as the coordinate `A.x` that it is; `None` if there is none.
    fn variable(&self, name: &str) -> Option<usize> {
        // An unknown coordinate would be added.
        let mut model = self.whole.model.clone();
        variable_named(&mut model, name).map(|v| v.0).filter(|v| *v < self.whole.model.variables.len())
    }

    /// Contents of the model, as JSON.
    fn info(&self) -> String {
        let (file, model, units) = (&self.whole, &self.whole.model, self.whole.units);
        let body = |b: BodyId| model.bodies[b.0].name.as_str();
        let variables = model.variables.iter().enumerate().map(|(k, v)| {
            let shown = |b: f64| file.value_of(VariableId(k), b);
            let is_parameter = v.changes.iter().any(|c| c.parameter().is_some());
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
        // Loads of a position are those at rest.
        let is_load = |source| matches!(source, OutputSource::Measure(k) if model.measures[k].kind.is_load());
        let outputs = shown.iter().map(|o| {
            json!({
                "name": o.name,
                "kind": if matches!(o.source, OutputSource::Measure(_)) { "measure" } else { "point" },
                "columns": (0..o.known.orders).map(|k| o.order_name(k)).collect::<Vec<_>>(),
                "units": (0..o.known.orders).map(|k| order_unit(units, o.dimension, k)).collect::<Vec<_>>(),
                "by_position": o.known.by_position,
                "at_rest": model.is_known_at_rest(o.source) || is_load(o.source),
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
        let drivers = model.drivers.iter().enumerate().map(|(k, d)| {
            let quantity = model.driven(d).quantity;
            json!({
                "name": d.name,
                "joint": model.joints[d.joint.0].name,
                "coordinate": model.driven(d).name,
                "unit": symbol(units, quantity),
                "nominal": units.from_si(quantity, model.as_drawn(DriverId(k))),
                "force_unit": unit(units, model.force_on(d)),
            })
        });
        let deflections = model.elastic_directions().into_iter().map(|(element, k)| {
            let (direction, is_angle) = (ElasticDirection(k), k >= 3);
            json!({
                "force": model.elements[element.0].name,
                "direction": direction.name(),
                "unit": unit(units, direction.dimension()),
                "force_unit": unit(units, if is_angle { Dimension::MOMENT } else { Dimension::FORCE }),
            })
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
            "has_loads": model.has_loads(),
            "deflections": deflections.collect::<Vec<_>>(),
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

    /// Text of the file with a design written into it; for the folder `to`, data files are named from there.
    #[pyo3(signature = (design, from_folder=None, to=None))]
    fn edited(&self, design: Vec<f64>, from_folder: Option<&str>, to: Option<&str>) -> PyResult<String> {
        let values = self.changes(&design)?;
        let from = from_folder.map(Path::new);
        let text = self.whole.edit(&values).and_then(|text| match to {
            Some(to) => self.whole.text_for(&text, from, Path::new(to)),
            None => Ok(text),
        });
        Ok(text.map_err(|found| Failure::of_text(&found))?)
    }
}

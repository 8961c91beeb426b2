//! Request for an envelope.

use hardpoint::model::{BodyId, CaseId, GROUND, Grid, Model, ShapeId, ShapeKind};

use crate::request::{RequestError, named};

/// Motions of which an envelope is made.
#[derive(Clone, Debug, PartialEq)]
pub enum Sweep {
    /// The model's own motion, if it has no cases, or that of a case.
    Motion(Option<CaseId>),
    /// All positions of a grid.
    Grid(Grid),
}

/// Request for an envelope.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The shape.
    pub shape: ShapeId,
    /// The body from which it is seen.
    pub relative_to: BodyId,
    /// The motions.
    pub sweeps: Vec<Sweep>,
    /// Permitted error, m; `None` for 1/200 of the shape's extent.
    pub error: Option<f64>,
    /// Distance that is added around the shape, m.
    pub margin: f64,
}

/// Choices of the caller.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Name of the shape.
    pub shape: String,
    /// Name of the body from which it is seen; the ground if `None`.
    pub relative_to: Option<String>,
    /// Name of the case or grid; all of them if `None`.
    pub case: Option<String>,
    /// Permitted error, m.
    pub error: Option<f64>,
    /// Distance that is added around the shape, m.
    pub margin: Option<f64>,
}

impl Request {
    /// Request for an envelope of a shape of a model.
    ///
    /// # Errors
    /// A [`RequestError`] if there is no such shape, body or case, if the shape has no end or no inside, or if a length
    /// is invalid.
    pub fn of(model: &Model, overrides: Overrides) -> Result<Self, RequestError> {
        let Overrides { shape, relative_to, case, error, margin } = overrides;
        if model.shapes.is_empty() {
            return Err(RequestError::model(
                "the model has no shapes",
                "add `[shapes]`, for example `tyre = { wheel = \"NAME\", width = 190 }`",
            ));
        }
        let id = ShapeId(named("shape", &shape, model.shapes.iter().map(|s| s.name.as_str()))?);
        let margin = margin.unwrap_or(0.0);
        if !(margin >= 0.0 && margin.is_finite()) {
            return Err(RequestError::invalid("the margin is negative", "give a length from 0"));
        }
        if error.is_some_and(|error| !(error > 0.0 && error.is_finite())) {
            return Err(RequestError::invalid(
                "the permitted error is not positive",
                "give a length above 0",
            ));
        }
        match &model.shapes[id.0].kind {
            ShapeKind::Plane { .. } => {
                return Err(RequestError::invalid(
                    format!("`{shape}` is a plane, which has no end"),
                    "name another shape",
                ));
            }
            ShapeKind::Mesh { surface, .. } => {
                let is_thin = model.shapes[id.0].round.is_none() && margin <= 0.0;
                if !surface.is_closed() && is_thin {
                    return Err(RequestError::invalid(
                        format!("the mesh of `{shape}` is not closed, and has no inside"),
                        "close it, or add a distance around it (margin)",
                    ));
                }
            }
            ShapeKind::Sphere { .. } | ShapeKind::Capsule { .. } | ShapeKind::Ring { .. } => {
                let radius = model.shapes[id.0].round.map_or(0.0, |round| model.numbers[round.0.0].value);
                if radius <= 0.0 && margin <= 0.0 {
                    return Err(RequestError::invalid(
                        format!("`{shape}` has no thickness, and sweeps no volume"),
                        "give it a radius (`round` of a ring), or add a distance around it (margin)",
                    ));
                }
            }
            ShapeKind::Cylinder { .. } | ShapeKind::Tyre { .. } | ShapeKind::Hull { .. } => {}
        }
        let relative_to = match relative_to {
            None => GROUND,
            Some(name) => BodyId(named("body", &name, model.bodies.iter().map(|b| b.name.as_str()))?),
        };
        let sweeps = match case {
            Some(name) => vec![sweep_named(model, &name)?],
            None => {
                let own = model.cases.is_empty() && model.grids.is_empty();
                let motions = (0..model.cases.len()).map(|k| Sweep::Motion(Some(CaseId(k))));
                let grids = model.grids.iter().cloned().map(Sweep::Grid);
                own.then_some(Sweep::Motion(None)).into_iter().chain(motions).chain(grids).collect()
            }
        };
        Ok(Self { shape: id, relative_to, sweeps, error, margin })
    }
}

fn sweep_named(model: &Model, name: &str) -> Result<Sweep, RequestError> {
    let names = model.cases.iter().map(|c| &c.name).chain(model.grids.iter().map(|g| &g.name));
    let k = named("case", name, names.map(String::as_str))?;
    Ok(match k.checked_sub(model.cases.len()) {
        None => Sweep::Motion(Some(CaseId(k))),
        Some(grid) => Sweep::Grid(model.grids[grid].clone()),
    })
}

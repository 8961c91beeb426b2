//! Request for a calibration.

use hardpoint::model::{Measurements, Model, VariableId};
use hardpoint::topology::Formulation;

use super::Loss;
use crate::request::{RequestError, variable};

/// Request for a calibration.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// Measurements to fit.
    pub measured: &'a Measurements,
    /// Variables to fit.
    pub variables: Vec<VariableId>,
    /// Loss function of the residuals.
    pub loss: Loss,
    /// Formulation of the mechanism.
    pub formulation: Formulation,
    /// Maximum number of iterations.
    pub iterations: usize,
}

/// Options of a calibration.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Names of the variables to fit; empty for all. A repeated name counts once.
    pub variables: Vec<String>,
    /// Loss function of the residuals.
    pub loss: Loss,
    /// Formulation of the mechanism.
    pub formulation: Formulation,
    /// Maximum number of iterations.
    pub iterations: Option<usize>,
}

impl<'a> Request<'a> {
    /// Default maximum number of iterations.
    pub const ITERATIONS: usize = 100;
    /// Highest maximum number of iterations.
    pub const MOST: u32 = 100_000;

    /// Request for a fit of a model to measurements.
    ///
    /// # Errors
    /// A [`RequestError`] if the model has no variables, or an option is invalid.
    pub fn of(
        model: &Model,
        measured: &'a Measurements,
        overrides: &Overrides,
    ) -> Result<Self, RequestError> {
        if model.variables.is_empty() {
            return Err(RequestError::model(
                "the model has no design variables to fit",
                "add them in `[design]` or `[parameters]`",
            ));
        }
        let mut variables = Vec::new();
        for name in &overrides.variables {
            let found = variable(model, name)?;
            if !variables.contains(&found) {
                variables.push(found);
            }
        }
        if variables.is_empty() {
            variables.extend((0..model.variables.len()).map(VariableId));
        }
        let iterations = overrides.iterations.unwrap_or(Self::ITERATIONS);
        RequestError::unless_counted("iterations", iterations, Self::MOST)?;
        let Overrides { loss, formulation, .. } = *overrides;
        Ok(Self { measured, variables, loss, formulation, iterations })
    }
}

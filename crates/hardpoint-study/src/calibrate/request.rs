//! Request for a calibration.

use std::collections::BTreeSet;

use hardpoint::measure::outputs;
use hardpoint::model::{
    DriverId, Measurements, Model, Offset, OffsetSource, PriorGroup, VariableId, VariablePrior,
};
use hardpoint::topology::Formulation;

use super::loss::Loss;
use super::parameter::FittedParameter;
use super::prior::{Prior, parameters_of};
use crate::random::moments;
use crate::request::{RequestError, named, variable};

/// Request for a calibration.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// Measurements to fit.
    pub measured: &'a Measurements,
    /// Measurements that are not fitted but compared with the fitted design.
    pub validation: Option<&'a Measurements>,
    /// Variables to fit.
    pub variables: Vec<VariableId>,
    /// Prior knowledge, and offsets to fit.
    pub prior: Prior,
    /// True if the bounds of variables are kept.
    pub keep_bounds: bool,
    /// Loss function of the residuals.
    pub loss: Loss,
    /// Formulation of the mechanism.
    pub formulation: Formulation,
    /// Maximum number of iterations.
    pub iterations: usize,
}

/// Options of a calibration that override or complete those of the model file.
#[derive(Clone, Debug, Default)]
pub struct Overrides<'a> {
    /// Names of the variables to fit; if empty, those of the file, or all. A repeated name counts once.
    pub variables: Vec<String>,
    /// Standard deviations of variables about their nominal values, or about the means of the file, SI.
    pub priors: Vec<(VariableId, f64)>,
    /// Source of the priors of all other variables, of [`PRIORS`]; `None` for that of the file.
    pub priors_from: Option<String>,
    /// Groups of variables with a common deviation, in addition to those of the file; one of the same name replaces
    /// that of the file.
    pub groups: Vec<PriorGroup>,
    /// Names of drivers and outputs whose offsets are fitted in addition.
    pub offsets: Vec<String>,
    /// Measurements that are not fitted but compared with the fitted design.
    pub validation: Option<&'a Measurements>,
    /// Loss function of the residuals.
    pub loss: Loss,
    /// Formulation of the mechanism.
    pub formulation: Formulation,
    /// Maximum number of iterations.
    pub iterations: Option<usize>,
}

/// Sources of priors, by their names in model files.
pub const PRIORS: [&str; 1] = ["tolerances"];

impl<'a> Request<'a> {
    /// Default maximum number of iterations.
    pub const ITERATIONS: usize = 100;
    /// Highest maximum number of iterations.
    pub const MOST: u32 = 100_000;

    /// Request for a fit of a model to measurements: the settings of the file with the options of the caller. Bounds
    /// are kept if the file has settings or the caller gives priors.
    ///
    /// # Errors
    /// A [`RequestError`] if the model has no variables, or an option is invalid.
    pub fn of(
        model: &Model,
        measured: &'a Measurements,
        overrides: &Overrides<'a>,
    ) -> Result<Self, RequestError> {
        if model.variables.is_empty() {
            return Err(RequestError::model(
                "the model has no design variables to fit",
                "add them in `[design]` or `[parameters]`",
            ));
        }
        let settings = model.calibrating.as_ref();
        let mut variables = Vec::new();
        for name in &overrides.variables {
            let found = variable(model, name)?;
            if !variables.contains(&found) {
                variables.push(found);
            }
        }
        if variables.is_empty() {
            match settings {
                Some(settings) => variables.clone_from(&settings.variables),
                None => variables.extend((0..model.variables.len()).map(VariableId)),
            }
        }
        let iterations = overrides.iterations.unwrap_or(Self::ITERATIONS);
        RequestError::unless_counted("iterations", iterations, Self::MOST)?;
        if overrides.validation.is_some_and(|data| data == measured) {
            return Err(RequestError::invalid(
                "the validation data are the fitted data",
                "give readings that are not fitted: fit one part of the table, and validate with the other",
            ));
        }
        let from = overrides.priors_from.as_ref().map(|name| named("source of priors", name, PRIORS));
        let from_tolerances = from.transpose()?.is_some() || settings.is_some_and(|s| s.tolerance_priors);
        let mut prior = Prior {
            variables: priors(model, &variables, overrides)?,
            groups: groups(model, &variables, overrides)?,
            offsets: offsets(model, overrides)?,
        };
        if from_tolerances {
            add_tolerances(model, &variables, &mut prior)?;
        }
        // A variable that the caller does not fit is at its nominal value exactly.
        prior.variables.retain(|p| variables.contains(&p.variable));
        let keep_bounds = settings.is_some() || !prior.is_empty();
        let Overrides { loss, formulation, validation, .. } = *overrides;
        Ok(Self { measured, validation, variables, prior, keep_bounds, loss, formulation, iterations })
    }

    /// Mean of the own prior of a parameter; `None` without one.
    pub(super) fn prior_mean(&self, model: &Model, parameter: FittedParameter) -> Option<f64> {
        match parameter {
            FittedParameter::Variable(v) => {
                self.prior.variables.iter().find(|p| p.variable == v).map(|p| p.mean)
            }
            FittedParameter::Driver(_) | FittedParameter::Output(_) => {
                let of = |o: &&Offset| parameters_of(model, std::slice::from_ref(*o)).contains(&parameter);
                self.prior.offsets.iter().find(of).and_then(|o| o.sigma).map(|_| 0.0)
            }
        }
    }

    /// Drivers whose offsets are fitted.
    pub(super) fn offset_drivers(&self) -> Vec<DriverId> {
        let driver = |offset: &Offset| match offset.of {
            OffsetSource::Driver(driver) => Some(driver),
            OffsetSource::Output(_) => None,
        };
        self.prior.offsets.iter().filter_map(driver).collect()
    }
}

/// Priors of the file with those of the caller.
fn priors(
    model: &Model,
    variables: &[VariableId],
    overrides: &Overrides<'_>,
) -> Result<Vec<VariablePrior>, RequestError> {
    let mut found = model.calibrating.as_ref().map_or(Vec::new(), |s| s.priors.clone());
    for (variable, sigma) in &overrides.priors {
        let name = &model.variables[variable.0].name;
        if !(*sigma > 0.0 && sigma.is_finite()) {
            return Err(RequestError::invalid(
                format!("the standard deviation of the prior of `{name}` is not positive"),
                "give a number above zero; to fix the variable, do not fit it",
            ));
        }
        if !variables.contains(variable) {
            return Err(RequestError::invalid(
                format!("`{name}` has a prior but is not fitted"),
                "fit it too, or leave out its prior",
            ));
        }
        match found.iter_mut().find(|p| p.variable == *variable) {
            Some(prior) => prior.sigma = *sigma,
            None => found.push(VariablePrior { variable: *variable, mean: 0.0, sigma: *sigma }),
        }
    }
    Ok(found)
}

/// Groups of the file with those of the caller.
fn groups(
    model: &Model,
    variables: &[VariableId],
    overrides: &Overrides<'_>,
) -> Result<Vec<PriorGroup>, RequestError> {
    let mut found = model.calibrating.as_ref().map_or(Vec::new(), |s| s.groups.clone());
    for group in &overrides.groups {
        let PriorGroup { name, variables: members, within } = group;
        let of = |v: &VariableId| &model.variables[v.0];
        let different: BTreeSet<usize> = members.iter().map(|v| v.0).collect();
        if members.len() < 2 || different.len() < members.len() {
            return Err(RequestError::invalid(
                format!("group `{name}` has fewer than two different members, or one of them twice"),
                "name at least two design variables, each once",
            ));
        }
        if members.iter().any(|v| of(v).quantity != of(&members[0]).quantity) {
            return Err(RequestError::invalid(
                format!("the members of group `{name}` have different units"),
                "make a group of each quantity",
            ));
        }
        if let Some(other) = members.iter().find(|v| !variables.contains(v)) {
            return Err(RequestError::invalid(
                format!("`{}` of group `{name}` is not fitted", of(other).name),
                "fit it too, or remove it from the group",
            ));
        }
        if !(*within > 0.0 && within.is_finite()) {
            return Err(RequestError::invalid(
                format!("the standard deviation within group `{name}` is not positive"),
                "give a number above zero",
            ));
        }
        found.retain(|old| old.name != *name);
        found.push(group.clone());
    }
    Ok(found)
}

/// Adds the tolerances of all variables without a prior of their own.
fn add_tolerances(model: &Model, variables: &[VariableId], prior: &mut Prior) -> Result<(), RequestError> {
    let mut any = false;
    for tolerance in model.tolerance_settings().into_iter().flat_map(|s| s.tolerances) {
        let sigma = moments(tolerance.scatter, tolerance.variables.len(), tolerance.reach).sigma;
        for variable in tolerance.variables.iter().filter(|v| variables.contains(v)) {
            any = true;
            if prior.variables.iter().all(|p| p.variable != *variable) {
                prior.variables.push(VariablePrior { variable: *variable, mean: 0.0, sigma });
            }
        }
    }
    if any {
        return Ok(());
    }
    Err(RequestError::model(
        "no fitted variable has a tolerance to make a prior of",
        "add `tolerance = 0.1` to the variables, or give their standard deviations",
    ))
}

/// Offsets of the file and of the caller.
fn offsets(model: &Model, overrides: &Overrides<'_>) -> Result<Vec<Offset>, RequestError> {
    let mut found = model.calibrating.as_ref().map_or(Vec::new(), |s| s.offsets.clone());
    let outputs = outputs(model);
    for name in &overrides.offsets {
        // A name that both have is that of the driver, as in tables of measurements.
        let drivers = model.drivers.iter().map(|d| d.name.as_str());
        let names = drivers.chain(outputs.iter().map(|o| o.name.as_str()));
        let of = match named("driver, measure or point component", name, names)? {
            k if k < model.drivers.len() => OffsetSource::Driver(DriverId(k)),
            k => OffsetSource::Output(outputs[k - model.drivers.len()].source),
        };
        if let OffsetSource::Output(source) = of
            && !model.is_known_at_rest(source)
        {
            return Err(RequestError::invalid(
                format!("`{name}` can have no offset: it has no value at rest"),
                "name a measure that depends on positions only",
            ));
        }
        if found.iter().all(|o| o.of != of) {
            found.push(Offset { of, sigma: None });
        }
    }
    Ok(found)
}

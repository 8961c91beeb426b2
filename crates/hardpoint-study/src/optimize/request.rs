//! Request for an optimisation.

use hardpoint::model::{Goal, Model, OptimizationSettings, VariableId};

use crate::request::RequestError;

/// Request for an optimisation.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Variables, goals, limits and options of the search.
    pub settings: OptimizationSettings,
    /// Number of the first start: 0 is the nominal design. Starts can be distributed over several calls.
    pub first: usize,
}

/// Options that override those of the model file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Number of starts.
    pub starts: Option<usize>,
    /// True to start from the other assemblies of the mechanism too.
    pub other_assemblies: Option<bool>,
    /// True to start with all drivers in the opposite sense too.
    pub both_senses: Option<bool>,
    /// Maximum number of iterations of a search.
    pub iterations: Option<usize>,
    /// Number of the first start.
    pub first: usize,
    /// Variables and goals; the limits remain those of the model file.
    pub selection: Option<Selection>,
}

/// Variables and goals of an optimisation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// Variables that may change, each within its bounds in the model.
    pub variables: Vec<VariableId>,
    /// Goals, SI.
    pub goals: Vec<Goal>,
}

/// Bounds enclose the nominal design if it exceeds them by less than this fraction of their range: round-off of units.
const ROUND_OFF: f64 = 1e-9;

impl Request {
    /// Request for the optimisation of a model file, with overrides.
    ///
    /// # Errors
    /// A [`RequestError`] if there is nothing to optimise, or an override is invalid.
    pub fn of(model: &Model, overrides: Overrides) -> Result<Self, RequestError> {
        let mut settings = match (&model.optimization, &overrides.selection) {
            (Some(settings), _) => settings.clone(),
            (None, Some(_)) => OptimizationSettings::default(),
            (None, None) => {
                return Err(RequestError::model(
                    "the model has no `[optimize]` table",
                    "add `[optimize.goals]` with the metrics to minimise, and `bounds` to the design variables that may change \
                     (docs/optimisation.md)",
                ));
            }
        };
        if let Some(Selection { variables, goals }) = overrides.selection {
            if variables.is_empty() || goals.is_empty() {
                return Err(RequestError::invalid(
                    "an optimisation requires at least one variable and one goal",
                    "select variables with bounds, and metrics as goals",
                ));
            }
            variables.iter().try_for_each(|v| check_bounds(model, *v))?;
            goals.iter().try_for_each(|goal| check_goal(model, goal))?;
            (settings.variables, settings.goals) = (variables, goals);
        } else if settings.goals.is_empty() {
            return Err(RequestError::invalid(
                "`[optimize]` has no goal in this case",
                "choose another case, or optimise all of them",
            ));
        }
        settings.starts = overrides.starts.unwrap_or(settings.starts);
        settings.other_assemblies = overrides.other_assemblies.unwrap_or(settings.other_assemblies);
        settings.both_senses = overrides.both_senses.unwrap_or(settings.both_senses);
        settings.iterations = overrides.iterations.unwrap_or(settings.iterations);
        RequestError::unless_counted("starts", settings.starts, OptimizationSettings::MOST)?;
        RequestError::unless_counted("iterations", settings.iterations, OptimizationSettings::MOST)?;
        Ok(Self { settings, first: overrides.first })
    }
}

fn check_bounds(model: &Model, v: VariableId) -> Result<(), RequestError> {
    let variable = &model.variables[v.0];
    let fault = |what: &str, help: &str| {
        Err(RequestError::invalid(format!("the bounds of design variable `{}` {what}", variable.name), help))
    };
    match variable.bounds {
        Some([low, high]) if low < high && (high - low).is_finite() => {
            let slack = ROUND_OFF * (high - low);
            if low <= slack && high >= -slack {
                return Ok(());
            }
            fault("do not enclose the nominal design", "give bounds that enclose the nominal value")
        }
        Some(_) => fault("are not in ascending order", "give the lower bound first, then the upper"),
        None => fault("are missing", "give it bounds"),
    }
}

fn check_goal(model: &Model, goal: &Goal) -> Result<(), RequestError> {
    let name = &goal.name;
    if !Goal::is_weight(goal.weight) {
        return Err(RequestError::invalid(
            format!("invalid weight of goal `{name}`"),
            "give a positive number, from 1e-50 to 1e50, or remove the goal",
        ));
    }
    match goal.target {
        Some(target) if !target.is_finite() => Err(RequestError::invalid(
            format!("the target of goal `{name}` is not a finite number"),
            "give the target value of its metric",
        )),
        Some(_) if model.metrics[goal.metric].take.target().is_some() => Err(RequestError::invalid(
            format!("goal `{name}` cannot have a target: its metric is an `rms`"),
            "remove the target; the metric has a curve to follow",
        )),
        Some(_) | None => Ok(()),
    }
}

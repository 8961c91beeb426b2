//! Request for a sweep.

use hardpoint::model::{Model, SweepMethod, SweepRange, SweepSettings, VariableId};

use super::Plan;
use crate::request::{RequestError, named};

/// Request for a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Designs, and the results to store.
    pub settings: SweepSettings,
}

/// Options that override those of the model file.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// List of designs: the variables of its columns, and its rows, as in [`SweepSettings`].
    pub designs: Option<(Vec<SweepRange>, Vec<Vec<f64>>)>,
    /// Method that chooses the designs.
    pub method: Option<SweepMethod>,
    /// Number of designs; for Sobol indices of pairs of designs.
    pub samples: Option<usize>,
    /// Seed of the random numbers.
    pub seed: Option<u64>,
    /// Number of levels of every variable of a factorial.
    pub levels: Option<usize>,
    /// Ranges of variables: lowest and highest change, m, rad or plain.
    pub ranges: Vec<(VariableId, [f64; 2])>,
    /// Names of measures whose curves are stored in addition.
    pub curves: Vec<String>,
}

/// Method of a name, of [`SweepMethod::NAMES`].
///
/// # Errors
/// A [`RequestError`] if there is none.
pub fn method(name: &str) -> Result<SweepMethod, RequestError> {
    Ok(SweepMethod::NAMED[named("method", name, SweepMethod::NAMES)?])
}

impl Request {
    /// Request for the sweep of a model file, with overrides. Without a `[sweep]` table it is about all variables with
    /// bounds and all metrics.
    ///
    /// # Errors
    /// A [`RequestError`] if there are no designs or no results, or an override is invalid.
    pub fn of(model: &Model, overrides: Overrides) -> Result<Self, RequestError> {
        let mut settings = model.sweeping.clone().unwrap_or_else(|| SweepSettings::of_bounds(model));
        if let Some((ranges, listed)) = overrides.designs {
            settings = SweepSettings { method: SweepMethod::Listed, ranges, listed, ..settings };
        }
        let is_listed = settings.method == SweepMethod::Listed;
        for (is_given, what) in [
            (overrides.method.is_some(), "method"),
            (overrides.levels.is_some(), "number of levels"),
            (!overrides.ranges.is_empty(), "range"),
        ] {
            if is_listed && is_given {
                return Err(RequestError::invalid(
                    format!("a list of designs has no {what}"),
                    "leave out one of the two",
                ));
            }
        }
        settings.method = overrides.method.unwrap_or(settings.method);
        settings.samples = overrides.samples.unwrap_or(settings.samples);
        settings.seed = overrides.seed.unwrap_or(settings.seed);
        if let Some(levels) = overrides.levels {
            if levels < 2 {
                return Err(RequestError::invalid(
                    format!("{levels} levels are too few"),
                    "give a whole number from 2",
                ));
            }
            settings.ranges.iter_mut().for_each(|range| range.levels = levels);
        }
        let levels = overrides.levels.or(settings.ranges.first().map(|r| r.levels));
        let levels = levels.unwrap_or(SweepSettings::LEVELS);
        for (variable, [low, high]) in overrides.ranges {
            if !(low < high && (high - low).is_finite()) {
                return Err(RequestError::invalid(
                    format!("the range of `{}` is not in ascending order", model.variables[variable.0].name),
                    "give the lower end first",
                ));
            }
            match settings.ranges.iter_mut().find(|r| r.variable == variable) {
                Some(range) => (range.low, range.high) = (low, high),
                None => settings.ranges.push(SweepRange { variable, low, high, levels }),
            }
        }
        for name in &overrides.curves {
            let curve = named("measure", name, model.measures.iter().map(|m| m.name.as_str()))?;
            if !settings.curves.contains(&curve) {
                settings.curves.push(curve);
            }
        }
        if settings.metrics.is_empty() && settings.curves.is_empty() {
            return Err(RequestError::model(
                "the model has no metrics to compare designs by",
                "declare some in `[metrics]`, or store the curves of measures",
            ));
        }
        Plan::new(&settings, model)?;
        Ok(Self { settings })
    }
}

//! Request for a table.

use std::num::NonZero;

use hardpoint::measure::{clearances_of, outputs};
use hardpoint::model::{Dimension, DriverId, Model, OutputSource};

use super::Interpolation;
use crate::request::{RequestError, named};

/// Maximum number of drivers of a table.
const MOST_DRIVERS: usize = 3;
/// Permitted errors below this fraction of the mechanism's size, or rad, are not far enough above the round-off of the
/// numbers in the table.
const LEAST_ERROR: f64 = 1e-11;

/// Range of a driver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// The driver.
    pub driver: DriverId,
    /// Both ends, ascending, m or rad, measured like the values of its laws.
    pub range: [f64; 2],
}

/// Output of a table with its permitted error.
#[derive(Clone, Debug, PartialEq)]
pub struct MappedOutput {
    /// Name.
    pub name: String,
    /// The output.
    pub output: OutputSource,
    /// Dimension of its value.
    pub dimension: Dimension,
    /// Permitted error, in SI.
    pub error: f64,
}

/// Request for a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Drivers with their ranges; all others remain in the design configuration.
    pub axes: Vec<Axis>,
    /// Outputs.
    pub outputs: Vec<MappedOutput>,
    /// Interpolation.
    pub interpolation: Interpolation,
    /// Minimum number of intervals of each range.
    pub intervals: usize,
}

/// Choices of the caller.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Drivers with both ends of their ranges, m or rad.
    pub over: Vec<(String, [f64; 2])>,
    /// Names of outputs; all measures of positions if empty.
    pub of: Vec<String>,
    /// Permitted errors, in SI: for one output, or for all outputs of a dimension.
    pub errors: Vec<(ErrorScope, f64)>,
    /// Interpolation.
    pub interpolation: Interpolation,
    /// Minimum number of intervals of each range. Default: 1.
    pub intervals: Option<NonZero<usize>>,
}

/// Outputs for which a permitted error is given.
#[derive(Clone, Debug, PartialEq)]
pub enum ErrorScope {
    /// One output, by name.
    Output(String),
    /// All outputs of this dimension without an error of their own.
    Dimension(Dimension),
}

impl ErrorScope {
    /// Sentence about a map without such an output.
    pub fn describe_missing(&self) -> String {
        match self {
            Self::Output(name) => format!("`{name}` is not an output of the map"),
            Self::Dimension(_) => "no output of the map has the unit of a permitted error".to_owned(),
        }
    }
}

impl Request {
    /// Outputs of a model, by names: measures of positions, and coordinates of points; all such measures if there are
    /// no names.
    ///
    /// # Errors
    /// A [`RequestError`] if there is no such output, or if it does not depend on positions alone.
    pub fn outputs(
        model: &Model,
        names: &[String],
    ) -> Result<Vec<(String, OutputSource, Dimension)>, RequestError> {
        let all = outputs(model);
        let reason = |source: OutputSource| match source {
            OutputSource::Measure(m) if model.depends_on_driver(m) => {
                Some("is a derivative by a driver; the table of the value has its derivatives")
            }
            OutputSource::Measure(m) if model.depends_on_step(m) => Some("is a load"),
            _ if !clearances_of(model, source).is_empty() => Some("is a clearance, or computed from one"),
            _ if !model.known(source).by_position => Some("depends on the motion, not on the position alone"),
            _ => None,
        };
        let found = |o: &hardpoint::measure::Output| (o.name.clone(), o.source, o.dimension);
        if names.is_empty() {
            let of = all.iter().filter(|o| matches!(o.source, OutputSource::Measure(_)));
            let of: Vec<_> = of.filter(|o| reason(o.source).is_none()).map(found).collect();
            if of.is_empty() {
                return Err(RequestError::invalid(
                    "the model has no measures of positions",
                    "name coordinates of points, such as `wheel_centre.z`",
                ));
            }
            return Ok(of);
        }
        let known: Vec<&str> = all.iter().map(|o| o.name.as_str()).collect();
        let mut of = Vec::new();
        for name in names {
            let output = &all[named("output", name, known.iter().copied())?];
            if let Some(reason) = reason(output.source) {
                return Err(RequestError::invalid(
                    format!("`{name}` cannot be mapped: it {reason}"),
                    "name measures of positions, or coordinates of points",
                ));
            }
            if of.iter().any(|(_, source, _)| *source == output.source) {
                return Err(RequestError::invalid(format!("`{name}` is named twice"), "name it once"));
            }
            of.push(found(output));
        }
        Ok(of)
    }

    /// Driver of a model, by name.
    ///
    /// # Errors
    /// A [`RequestError`] if the model has no such driver.
    pub fn driver(model: &Model, name: &str) -> Result<DriverId, RequestError> {
        named("driver", name, model.drivers.iter().map(|d| d.name.as_str())).map(DriverId)
    }

    /// Request for a table of a model.
    ///
    /// # Errors
    /// A [`RequestError`] if a name is unknown, a range is empty, there are no or too many drivers, or an output has no
    /// permitted error.
    pub fn of(model: &Model, overrides: Overrides) -> Result<Self, RequestError> {
        let Overrides { over, of, errors, interpolation, intervals } = overrides;
        if over.is_empty() || over.len() > MOST_DRIVERS {
            return Err(RequestError::invalid(
                format!("a map over {} drivers", over.len()),
                "give the ranges of one, two or three drivers",
            ));
        }
        let mut axes: Vec<Axis> = Vec::new();
        for (name, [from, to]) in over {
            let driver = Self::driver(model, &name)?;
            if !(from < to && from.is_finite() && to.is_finite()) {
                return Err(RequestError::invalid(
                    format!("the range of `{name}` is empty"),
                    "give the lower end first, then a greater one",
                ));
            }
            if axes.iter().any(|axis| axis.driver == driver) {
                return Err(RequestError::invalid(format!("`{name}` has two ranges"), "give one range"));
            }
            axes.push(Axis { driver, range: [from, to] });
        }
        let known = Self::outputs(model, &of)?;
        let is_unused = |scope: &ErrorScope| match scope {
            ErrorScope::Output(name) => !known.iter().any(|(n, ..)| n == name),
            ErrorScope::Dimension(dimension) => !known.iter().any(|(.., d)| d == dimension),
        };
        if let Some((scope, _)) = errors.iter().find(|(scope, _)| is_unused(scope)) {
            return Err(RequestError::invalid(
                scope.describe_missing(),
                "name the output, or leave out the error",
            ));
        }
        let is_repeated = |k: usize| errors[..k].iter().any(|(scope, _)| *scope == errors[k].0);
        if let Some(k) = (0..errors.len()).find(|k| is_repeated(*k)) {
            let what = match &errors[k].0 {
                ErrorScope::Output(name) => format!("`{name}` has two permitted errors"),
                ErrorScope::Dimension(_) => "outputs of one unit have two permitted errors".to_owned(),
            };
            return Err(RequestError::invalid(what, "give one, or one for each output by its name"));
        }
        let mut outputs = Vec::new();
        for (name, output, dimension) in known {
            let own = errors.iter().find(|(scope, _)| *scope == ErrorScope::Output(name.clone()));
            let error =
                own.or_else(|| errors.iter().find(|(scope, _)| *scope == ErrorScope::Dimension(dimension)));
            let Some(&(_, error)) = error else {
                return Err(RequestError::invalid(
                    format!("`{name}` has no permitted error"),
                    format!("give one in its unit, or by its name, such as `--error {name}=0.001`"),
                ));
            };
            let least = LEAST_ERROR * model.size().powi(i32::from(dimension.length));
            if !(error >= least && error.is_finite()) {
                return Err(RequestError::invalid(
                    format!("the permitted error of `{name}` is not far above round-off"),
                    "give a greater number",
                ));
            }
            outputs.push(MappedOutput { name, output, dimension, error });
        }
        Ok(Self { axes, outputs, interpolation, intervals: intervals.map_or(1, NonZero::get) })
    }
}

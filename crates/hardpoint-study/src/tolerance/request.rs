//! Request for a tolerance study.

use hardpoint::draft::some_of;
use hardpoint::model::{AllocationRule, AllocationSettings, LimitTarget, Model, ToleranceSettings};

use crate::request::{RequestError, named};

/// Request for a tolerance study.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Tolerances, results and options.
    pub settings: ToleranceSettings,
}

/// Options that override those of the model file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Number of Monte Carlo designs; 0 for none.
    pub samples: Option<usize>,
    /// Seed of the random numbers.
    pub seed: Option<u64>,
    /// Rule of the allocation. A root sum of squares keeps the number of standard deviations of the model file, if that
    /// has one.
    pub allocate: Option<AllocationRule>,
}

/// Rule of a name, of [`AllocationRule::NAMES`], with the default number of standard deviations.
///
/// # Errors
/// A [`RequestError`] if there is none.
pub fn allocation_rule(name: &str) -> Result<AllocationRule, RequestError> {
    Ok(AllocationRule::NAMED[named("allocation rule", name, AllocationRule::NAMES)?])
}

/// Number of names in a message.
const LISTED: usize = 8;

impl Request {
    /// Request for the tolerance study of a model file, with overrides. Without a `[tolerance]` table it is about all
    /// variables with a tolerance, all metrics and all measures.
    ///
    /// # Errors
    /// A [`RequestError`] if no variable has a tolerance, there is no result that it could affect, or an override is
    /// invalid.
    pub fn of(model: &Model, overrides: &Overrides) -> Result<Self, RequestError> {
        let mut settings = model.tolerance_settings().ok_or_else(|| {
            RequestError::model(
                "no design variable has a tolerance",
                "add `tolerance = 0.1` to variables in `[design]` or `[parameters]` (docs/tolerance.md)",
            )
        })?;
        settings.samples = overrides.samples.unwrap_or(settings.samples);
        settings.seed = overrides.seed.unwrap_or(settings.seed);
        if settings.samples > 0 {
            RequestError::unless_counted("samples", settings.samples, ToleranceSettings::MOST)?;
        }
        if let Some(rule) = overrides.allocate {
            settings.allocation = match (rule, settings.allocation) {
                (
                    AllocationRule::Rss { .. },
                    given @ Some(AllocationSettings { rule: AllocationRule::Rss { .. } }),
                ) => given,
                (AllocationRule::Rss { .. } | AllocationRule::Worst, _) => Some(AllocationSettings { rule }),
            };
        }
        let has_metric_limits =
            settings.limits.iter().any(|limit| matches!(limit.of, LimitTarget::Metric(_)));
        if settings.metrics.is_empty() && settings.curves.is_empty() && !has_metric_limits {
            return Err(RequestError::model(
                "the model has no metrics or measures that tolerances could affect",
                "declare some in `[metrics]` or `[measures]`",
            ));
        }
        Ok(Self { settings })
    }

    /// Error of a study in which the mechanism can follow none of the variables.
    pub(super) fn nothing_varies(settings: &ToleranceSettings) -> RequestError {
        let names: Vec<&str> = settings.tolerances.iter().map(|t| t.name.as_str()).collect();
        RequestError::model(
            format!(
                "the mechanism can follow none of the variables with a tolerance: {}",
                some_of(&names, ", ", LISTED)
            ),
            "give tolerances to variables that it can follow",
        )
    }
}

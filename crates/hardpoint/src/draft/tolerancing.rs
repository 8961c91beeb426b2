//! Settings of a tolerance study as written.

use crate::model::{AllocationRule, ToleranceSettings};

use super::LimitDraft;

/// Settings of a tolerance study; see [`ToleranceSettings`].
#[derive(Clone, Debug)]
pub struct ToleranceSettingsDraft {
    /// Tolerances of single variables, by their names or by the name of the entry that defines them. All other
    /// variables with a [tolerance](super::VariableDraft::tolerance) are added.
    pub tolerances: Vec<ToleranceDraft>,
    /// Correlations of the variables.
    pub correlations: Vec<CorrelationDraft>,
    /// Limits of metrics.
    pub limits: Vec<LimitDraft>,
    /// Names of the metrics; all if `None`.
    pub metrics: Option<Vec<String>>,
    /// Names of the measures; all if `None`.
    pub curves: Option<Vec<String>>,
    /// Default distribution of deviations.
    pub scatter: ScatterDraft,
    /// Number of Monte Carlo designs.
    pub samples: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Rule of the tolerance allocation, if requested.
    pub allocation: Option<AllocationRule>,
}

impl Default for ToleranceSettingsDraft {
    fn default() -> Self {
        Self {
            tolerances: Vec::new(),
            correlations: Vec::new(),
            limits: Vec::new(),
            metrics: None,
            curves: None,
            scatter: ScatterDraft::default(),
            samples: ToleranceSettings::SAMPLES,
            seed: ToleranceSettings::SEED,
            allocation: None,
        }
    }
}

/// Distribution of deviations, as far as given; see [`Scatter`](crate::model::Scatter).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScatterDraft {
    /// Index in [`Scatter::NAMES`](crate::model::Scatter::NAMES).
    pub kind: Option<usize>,
    /// Number of standard deviations in the tolerance.
    pub sigmas: Option<f64>,
}

/// A tolerance; see [`Tolerance`](crate::model::Tolerance). Its reach is in user units.
#[derive(Clone, Debug)]
pub struct ToleranceDraft {
    /// Name of a design variable, or the common part of several before `_x`, `_y`, `_z`.
    pub name: String,
    /// Half width of the deviations; the variable's own tolerance if `None`.
    pub reach: Option<f64>,
    /// Distribution of the deviations.
    pub scatter: ScatterDraft,
    /// Relative cost of the tolerance.
    pub cost: Option<f64>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// A correlation; see [`Correlation`](crate::model::Correlation).
#[derive(Clone, Debug)]
pub struct CorrelationDraft {
    /// Name.
    pub name: String,
    /// The names of two design variables.
    pub between: [String; 2],
    /// Their coefficient.
    pub coefficient: f64,
}

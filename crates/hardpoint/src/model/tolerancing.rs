//! Settings of a tolerance study: deviations of the design, and limits that it must keep.

use super::{JointId, Limit, Model, VariableId};

/// Settings of a tolerance study.
#[derive(Clone, Debug, PartialEq)]
pub struct ToleranceSettings {
    /// Tolerances of the variables.
    pub tolerances: Vec<Tolerance>,
    /// Correlations of the variables.
    pub correlations: Vec<Correlation>,
    /// The metrics that are looked at, by their places in [`Model::metrics`]. One that names no case counts in each of
    /// them.
    pub metrics: Vec<usize>,
    /// The measures whose whole curves are looked at, by their places in [`Model::measures`].
    pub curves: Vec<usize>,
    /// Limits of metrics.
    pub limits: Vec<Limit>,
    /// Number of Monte Carlo designs that are solved exactly; 0 for none.
    pub samples: usize,
    /// Seed of the random numbers; the same seed gives the same designs.
    pub seed: u64,
    /// Settings of the allocation of the loosest tolerances, if requested.
    pub allocation: Option<AllocationSettings>,
}

/// Tolerance of one or several design variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerance {
    /// Name: that of the variable, or of the design entry whose coordinates they are.
    pub name: String,
    /// One variable, or the coordinates of one point, whose deviation as a whole stays within the reach: in a disc or a
    /// sphere.
    pub variables: Vec<VariableId>,
    /// Joint whose pin or ball it lets move in its hole, if it is a play.
    pub play: Option<JointId>,
    /// Half width of the tolerance, `±`, in the variables' unit; positive.
    pub reach: f64,
    /// Distribution of the deviations within it.
    pub scatter: Scatter,
    /// Relative cost of the tolerance, in the variables' SI unit: `cost / reach`. Tolerances without a cost are not
    /// changed.
    pub cost: Option<f64>,
}

/// Distribution of deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scatter {
    /// Evenly within the reach, and never beyond: all that is known of a part that passed its inspection.
    Uniform,
    /// By a normal distribution whose reach is that many standard deviations (of each coordinate); some go beyond it.
    Normal {
        /// Number of standard deviations within the tolerance.
        sigmas: f64,
    },
    /// By the same, without what goes beyond: an inspected process.
    Truncated {
        /// Number of standard deviations of the distribution before truncation.
        sigmas: f64,
    },
}

impl Scatter {
    /// The names of all of them, as model files write them.
    pub const NAMES: [&str; 3] = ["uniform", "normal", "truncated"];

    /// As model files write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => Self::NAMES[0],
            Self::Normal { .. } => Self::NAMES[1],
            Self::Truncated { .. } => Self::NAMES[2],
        }
    }
}

/// Correlation of two normally distributed variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlation {
    /// Name.
    pub name: String,
    /// The two.
    pub between: [VariableId; 2],
    /// Their coefficient of correlation, from -1 to 1.
    pub coefficient: f64,
}

/// Settings of the search for the loosest tolerances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllocationSettings {
    /// Deviations that must stay within the limits.
    pub rule: AllocationRule,
}

/// Rule for the deviations that must stay within the limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AllocationRule {
    /// A number of standard deviations, from the root sum of squares.
    Rss {
        /// Number of standard deviations.
        sigmas: f64,
    },
    /// All of them at once, each at its worst.
    Worst,
}

impl AllocationRule {
    /// The names of both, as model files write them.
    pub const NAMES: [&str; 2] = ["rss", "worst_case"];

    /// Those of these names, with the default number of standard deviations.
    pub const NAMED: [Self; 2] = [Self::Rss { sigmas: ToleranceSettings::SIGMAS }, Self::Worst];
}

impl Model {
    /// Settings of tolerance studies: those of the model, or else [`ToleranceSettings::of_variables`].
    pub fn tolerance_settings(&self) -> Option<ToleranceSettings> {
        self.tolerancing.clone().or_else(|| ToleranceSettings::of_variables(self))
    }
}

impl ToleranceSettings {
    /// Default number of designs: the standard deviation is then known to 1 %.
    pub const SAMPLES: usize = 10_000;
    /// Maximum number of designs: the metrics of more would not fit into memory.
    pub const MOST: u32 = 10_000_000;
    /// Default seed.
    pub const SEED: u64 = 1;
    /// A tolerance is that many standard deviations where nothing else is said: 0.27 % of the parts are beyond it.
    pub const SIGMAS: f64 = 3.0;

    /// Default settings if only variables have tolerances: normal distributions, every metric, every measure. `None` if
    /// no variable has one.
    pub fn of_variables(model: &Model) -> Option<Self> {
        let one = |(k, variable): (usize, &super::DesignVariable)| {
            Some(Tolerance {
                name: variable.name.clone(),
                variables: vec![VariableId(k)],
                play: None,
                reach: variable.tolerance?,
                scatter: Scatter::Normal { sigmas: Self::SIGMAS },
                cost: None,
            })
        };
        let tolerances: Vec<Tolerance> = model.variables.iter().enumerate().filter_map(one).collect();
        (!tolerances.is_empty()).then(|| Self {
            tolerances,
            correlations: Vec::new(),
            metrics: (0..model.metrics.len()).collect(),
            curves: (0..model.measures.len()).collect(),
            limits: Vec::new(),
            samples: Self::SAMPLES,
            seed: Self::SEED,
            allocation: None,
        })
    }
}

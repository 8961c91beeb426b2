//! How far off a design may be made, and what that must keep.

use super::{Limit, Model, VariableId};

/// What is asked of the tolerances of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct ToleranceSettings {
    /// What may be off, and by how much.
    pub tolerances: Vec<Tolerance>,
    /// Which of these go together.
    pub correlations: Vec<Correlation>,
    /// The metrics that are looked at, by their places in [`Model::metrics`]. One that names no case counts in each of them.
    pub metrics: Vec<usize>,
    /// The measures whose whole curves are looked at, by their places in [`Model::measures`].
    pub curves: Vec<usize>,
    /// What must hold of metrics.
    pub limits: Vec<Limit>,
    /// Number of designs are drawn and solved exactly; none where it is 0.
    pub samples: usize,
    /// What they are drawn from: the same number gives the same designs.
    pub seed: u64,
    /// How the loosest tolerances that keep the limits are sought, if they are.
    pub allocation: Option<AllocationSettings>,
}

/// By how much some design variables may be off together.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerance {
    /// Name: that of the variable, or of the design entry whose coordinates they are.
    pub name: String,
    /// One variable, or the coordinates of one point, whose deviation as a whole stays within the reach: in a disc or a sphere.
    pub variables: Vec<VariableId>,
    /// What is written after `±`, in the variables' unit; positive.
    pub reach: f64,
    /// How deviations scatter within it.
    pub scatter: Scatter,
    /// What it costs to hold it, relative to others: `cost / reach`. Those without a cost stay as they are.
    pub cost: Option<f64>,
}

/// How deviations scatter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scatter {
    /// Evenly within the reach, and never beyond: all that is known of a part that passed its inspection.
    Uniform,
    /// By a normal distribution whose reach is that many standard deviations (of each coordinate); some go beyond it.
    Normal {
        /// How many.
        sigmas: f64,
    },
    /// By the same, without what goes beyond: an inspected process.
    Truncated {
        /// Number of standard deviations of the distribution before it was cut off.
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

/// How two normally scattered variables go together.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlation {
    /// Name.
    pub name: String,
    /// The two.
    pub between: [VariableId; 2],
    /// Their coefficient of correlation, from -1 to 1.
    pub coefficient: f64,
}

/// How the loosest tolerances are sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllocationSettings {
    /// What is to stay within the limits.
    pub rule: AllocationRule,
}

/// What of the deviations has to stay within the limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AllocationRule {
    /// That many standard deviations, added by their squares.
    Rss {
        /// How many.
        sigmas: f64,
    },
    /// All of them at once, each at its worst.
    Worst,
}

impl AllocationRule {
    /// The names of both, as model files write them.
    pub const NAMES: [&str; 2] = ["rss", "worst_case"];
}

impl ToleranceSettings {
    /// Number of designs are drawn where nothing else is said: the standard deviation is then known to 1 %.
    pub const SAMPLES: usize = 10_000;
    /// What they are drawn from where nothing else is said.
    pub const SEED: u64 = 1;
    /// A tolerance is that many standard deviations where nothing else is said: 0.27 % of the parts are beyond it.
    pub const SIGMAS: f64 = 3.0;

    /// What is asked where only the variables say something: normal scatter of all that have a tolerance, every metric, every measure.
    /// `None` where no variable has one.
    pub fn of_variables(model: &Model) -> Option<Self> {
        let one = |(k, variable): (usize, &super::DesignVariable)| {
            Some(Tolerance {
                name: variable.name.clone(),
                variables: vec![VariableId(k)],
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

//! Settings of an optimisation: goals, limits and search options.

use super::{HardpointId, JointId, VariableId};

/// The search for the design that serves some goals best.
#[derive(Clone, Debug, PartialEq)]
pub struct OptimizationSettings {
    /// The variables that may change, each within its bounds.
    pub variables: Vec<VariableId>,
    /// Goals; their sum is minimised.
    pub goals: Vec<Goal>,
    /// Conditions that the design must satisfy.
    pub limits: Vec<Limit>,
    /// From how many designs the search starts: the one in the design configuration, and others spread within the
    /// bounds.
    pub starts: usize,
    /// True if the searches also start from the other assemblies of the mechanism, with this number of starts each.
    pub other_assemblies: bool,
    /// True if the searches also start with all drivers in the opposite sense, in every assembly.
    pub both_senses: bool,
    /// Maximum number of iterations of a search.
    pub iterations: usize,
    /// Names of the goals whose trade-off is of interest; empty for all of them.
    pub trade_off: Vec<String>,
}

impl OptimizationSettings {
    /// Maximum number of starts, and of iterations of a search.
    pub const MOST: u32 = 100_000;
    /// Default of the maximum number of iterations of a search.
    pub const ITERATIONS: usize = 1000;
}

impl Default for OptimizationSettings {
    /// No variables and no goals; one start.
    fn default() -> Self {
        Self {
            variables: Vec::new(),
            goals: Vec::new(),
            limits: Vec::new(),
            starts: 1,
            other_assemblies: false,
            both_senses: false,
            iterations: Self::ITERATIONS,
            trade_off: Vec::new(),
        }
    }
}

/// A metric that is made small, or brought to a target.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// Name.
    pub name: String,
    /// The metric, by its place in [`Model::metrics`](super::Model::metrics). One that names no case counts in each of
    /// them.
    pub metric: usize,
    /// Target value, in SI; `None` to minimise the metric.
    pub target: Option<f64>,
    /// Weight of one SI unit of the metric: the goal is `weight x value`, or `(weight x (value - target))^2`. The goal
    /// of an `rms` is squared as well, so that curves are fitted by least squares.
    pub weight: f64,
}

impl Goal {
    /// Smallest and largest weight: with them the squares of weighted goals, and products of these, are numbers of full
    /// accuracy.
    const WEIGHTS: [f64; 2] = [1e-50, 1e50];

    /// True if goals can have this weight.
    pub fn is_weight(weight: f64) -> bool {
        let [least, most] = Self::WEIGHTS;
        weight >= least && weight <= most
    }
}

/// A quantity that must stay between two values.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Name.
    pub name: String,
    /// Limited quantity.
    pub of: LimitTarget,
    /// It must not be less than this, m, rad or a plain number; equal to `most` where it must have one value.
    pub least: Option<f64>,
    /// It must not be more than this.
    pub most: Option<f64>,
}

/// Quantity that a limit applies to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitTarget {
    /// A metric, by its place in [`Model::metrics`](super::Model::metrics). One that names no case is limited in each
    /// of them.
    Metric(usize),
    /// A coordinate of a hardpoint in the design configuration: 0 for x, 1 for y, 2 for z.
    Coordinate(HardpointId, usize),
    /// The distance of two hardpoints in the design configuration.
    Distance(HardpointId, HardpointId),
    /// The length of a rod.
    Length(JointId),
    /// The minimum [`Margin`](crate::motion::Margin) of each motion to a singular position at its output times.
    Margin,
}

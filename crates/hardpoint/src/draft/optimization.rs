//! Settings of an optimisation as written.

use crate::model::OptimizationSettings;

/// Settings of an optimisation; see [`OptimizationSettings`](crate::model::OptimizationSettings).
#[derive(Clone, Debug)]
pub struct OptimizationSettingsDraft {
    /// Names of the optimised design variables; all that have bounds if `None`.
    pub variables: Option<Vec<String>>,
    /// Goals; their sum is minimised.
    pub goals: Vec<GoalDraft>,
    /// Conditions that the design must satisfy.
    pub limits: Vec<LimitDraft>,
    /// Minimum margin of every motion from singular positions, between 0 and 1.
    pub margin: Option<f64>,
    /// Number of starting designs.
    pub starts: usize,
    /// True if the searches also start from the other assemblies of the mechanism.
    pub other_assemblies: bool,
    /// True if the searches also start with all drivers in the opposite sense.
    pub both_senses: bool,
    /// Maximum number of iterations per start.
    pub iterations: usize,
    /// Names of the goals of a trade-off; empty for all of them.
    pub trade_off: Vec<String>,
}

impl Default for OptimizationSettingsDraft {
    fn default() -> Self {
        let (goals, limits, trade_off) = (Vec::new(), Vec::new(), Vec::new());
        Self {
            variables: None,
            goals,
            limits,
            margin: None,
            starts: 1,
            other_assemblies: false,
            both_senses: false,
            iterations: OptimizationSettings::ITERATIONS,
            trade_off,
        }
    }
}

/// A goal; see [`Goal`](crate::model::Goal). Its numbers are in user units, because their dimension follows from the
/// metric.
#[derive(Clone, Debug)]
pub struct GoalDraft {
    /// Name.
    pub name: String,
    /// The name of the metric.
    pub metric: String,
    /// Weight of one unit of the metric.
    pub weight: f64,
    /// Target value.
    pub target: Option<f64>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// A limit; see [`Limit`](crate::model::Limit). Its numbers are in user units.
#[derive(Clone, Debug)]
pub struct LimitDraft {
    /// Name.
    pub name: String,
    /// Limited quantity.
    pub of: LimitTargetDraft,
    /// Lower bound; equal to `most` for an equality.
    pub least: Option<f64>,
    /// Upper bound.
    pub most: Option<f64>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// Quantity that a limit applies to; see [`LimitTarget`](crate::model::LimitTarget). References are names.
#[derive(Clone, Debug, PartialEq)]
pub enum LimitTargetDraft {
    /// Entry that could not be read.
    Unread,
    /// A metric.
    Metric(String),
    /// A coordinate of a hardpoint: 0 for x, 1 for y, 2 for z.
    Coordinate(String, usize),
    /// The distance of two hardpoints.
    Distance([String; 2]),
    /// Length of a rod or leg: the given length, or the distance between its ends in the design configuration.
    Length(String),
}

//! Result of a trade-off.

use crate::evaluation::StudyCost;
use crate::optimize::{DesignAssessment, FailedDesign, Status};

/// Residual of the first-order condition of every point of a front.
pub const ON_FRONT: f64 = 1e-6;

/// Result of a trade-off.
#[derive(Clone, Debug)]
pub struct TradeOff {
    /// Nominal design; `None` if it cannot be evaluated.
    pub nominal: Option<DesignAssessment>,
    /// Reason why the nominal design cannot be evaluated.
    pub nominal_failure: Option<FailedDesign>,
    /// Goals of the nominal design, as [`FrontPoint::values`].
    pub nominal_values: Option<Vec<f64>>,
    /// Outcome.
    pub outcome: Outcome,
    /// Designs on the front, in ascending order of the first goal.
    pub points: Vec<FrontPoint>,
    /// Neighbours on a front of two goals between which it has a jump: no compromise is between them.
    pub jumps: Vec<[usize; 2]>,
    /// Number of points that were not found to the required residual.
    pub failed: usize,
    /// Number of points found that others dominate.
    pub dominated: usize,
    /// Number of designs evaluated for the optimum of each goal.
    pub anchor_designs: usize,
    /// Total cost.
    pub cost: StudyCost,
}

impl TradeOff {
    /// Index of the balanced compromise: the point with the smallest largest loss, where the loss in a goal is its
    /// distance from its minimum over the points, as a fraction of its range over them.
    pub fn balanced(&self) -> Option<usize> {
        let goals = 0..self.points.first()?.values.len();
        let range = |k: usize| {
            let values = self.points.iter().map(|p| p.values[k]);
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
        };
        let ranges: Vec<[f64; 2]> = goals.map(range).collect();
        let loss = |p: &FrontPoint| {
            let goals = p.values.iter().zip(&ranges).filter(|(_, [low, high])| low < high);
            goals.map(|(x, [low, high])| (x - low) / (high - low)).fold(0.0, f64::max)
        };
        (0..self.points.len()).min_by(|a, b| loss(&self.points[*a]).total_cmp(&loss(&self.points[*b])))
    }
}

/// Outcome of a trade-off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The front was found.
    Front,
    /// One design is the optimum of all goals: they do not conflict.
    NoConflict,
    /// The caller ended the study.
    Interrupted,
    /// The optimum of a goal, by its index, was not found, or the goal depends on no variable; the status of the
    /// search.
    NoAnchor(usize, Status),
    /// The optimum of a goal, by its index, was found, but another goal or a limit has no derivative there: the front
    /// has no end.
    NoEnd(usize),
}

/// Design on a front.
#[derive(Clone, Debug)]
pub struct FrontPoint {
    /// The design with all goals and limits.
    pub assessment: DesignAssessment,
    /// Traded goals, SI: the metric, its distance from the target, or for several cases their sum or the root of the
    /// sum of squares.
    pub values: Vec<f64>,
    /// Weights with which the sum of the goals, as fractions of their ranges, is stationary at this design; their sum
    /// is 1.
    pub weights: Vec<f64>,
    /// Change of each goal, in SI units, per SI unit of the first goal along the front, if all others are constant: the
    /// ratio of the weights. `None` if one of the two weights vanishes.
    pub rates: Vec<Option<f64>>,
    /// Residual of the first-order condition, theory (76).
    pub residual: f64,
    /// Index of the goal that has its optimum here.
    pub anchor: Option<usize>,
    /// Number of designs evaluated for this point, without those for the optimum of a single goal.
    pub designs: usize,
}

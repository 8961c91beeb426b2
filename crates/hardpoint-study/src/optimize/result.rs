//! Result of an optimisation.

use hardpoint::model::VariableId;

use super::assessment::{DesignAssessment, FailedDesign};
use super::optimality::Optimality;
use super::variants::Variant;
use crate::evaluation::StudyCost;

/// Result of an optimisation.
#[derive(Clone, Debug)]
pub struct Optimization {
    /// Nominal design; `None` if it cannot be evaluated.
    pub nominal: Option<DesignAssessment>,
    /// Reason why the nominal design cannot be evaluated.
    pub nominal_failure: Option<FailedDesign>,
    /// Assemblies and senses that were searched; the first is that of the model.
    pub variants: Vec<Variant>,
    /// Searches in the order of the variants, and for each in the order of their starts; number 0 starts from the
    /// nominal design.
    pub searches: Vec<SearchResult>,
    /// Index of the best search: the lowest objective among those that satisfy all limits, otherwise the smallest
    /// violation. `None` if none could start.
    pub best: Option<usize>,
    /// Total cost.
    pub cost: StudyCost,
}

/// Result of one search.
#[derive(Clone, Debug)]
pub struct SearchResult {
    /// Index of its assembly and sense in [`Optimization::variants`].
    pub variant: usize,
    /// Start values of all variables.
    pub start: Vec<f64>,
    /// Status at the end.
    pub status: Status,
    /// Best design; `None` if the search could not start.
    pub found: Option<DesignAssessment>,
    /// Optimality of the best design, with its active constraints.
    pub optimality: Optimality,
    /// Iterations, in order, the start first.
    pub iterations: Vec<Iteration>,
    /// Contribution of each searched variable to the change of the objective: the sum over all steps of mean gradient
    /// times step.
    pub work: Vec<f64>,
    /// True for each searched variable that changes no goal and no limit at any design of the search.
    pub idle: Vec<bool>,
    /// Designs that could not be evaluated.
    pub refused: Vec<FailedDesign>,
    /// Cost of the search.
    pub cost: StudyCost,
}

/// Status of a search at its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Converged to an optimum.
    Optimal,
    /// No goal depends on any of the searched variables.
    NoEffect,
    /// No step makes progress, although the conditions of an optimum are not satisfied.
    Stuck,
    /// Ended at the design with the smallest violation that was found: not all limits can be satisfied there.
    LimitsNotKept,
    /// The iteration limit was reached.
    IterationLimit,
    /// The caller ended the search.
    Interrupted,
    /// The search could not start: see [`SearchResult::refused`].
    NoStart,
}

/// One iteration of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Iteration {
    /// Number of the iteration; 0 is the start.
    pub number: usize,
    /// Objective at the current design.
    pub objective: f64,
    /// Violation at the current design, as [`DesignAssessment::violation`].
    pub violation: f64,
    /// Length of the step: the largest change of a variable as a fraction of its bounds.
    pub step: f64,
    /// Variable with that change, and the change in its unit.
    pub most: Option<(VariableId, f64)>,
    /// Number of designs evaluated so far in this search.
    pub designs: usize,
    /// Best design so far: values of all variables of the model, m, rad or plain.
    pub best: Vec<f64>,
}

//! Verification of analytic sensitivities against re-solved designs over a range of steps (section 6 of the paper), for
//! any model. The error must fall with the square of the step (central differences) or with the step itself (one-sided
//! differences), then rise by round-off.
//!
//! Input: a solution with sensitivities, and [`Options`] with steps as parts of natural steps. Output: a
//! [`Verification`] with relative errors per variable and quantity.

use std::ops::ControlFlow;

use hardpoint::model::VariableId;
use hardpoint::run::{Analysis, Solution};
use hardpoint::sensitivity::Admissibility;
use hardpoint_difference::{
    Comparison, DifferenceScheme, NonsmoothClearances, StepError, UndecidedOutputs, finite_differences,
};

use super::progress::{Progress, Step};

/// Options of a verification.
#[derive(Clone, Debug)]
pub struct Options {
    /// Scheme of the differences.
    pub scheme: DifferenceScheme,
    /// Steps as parts of [natural steps](hardpoint::model::Model::natural_step), from coarse to fine.
    pub steps: Vec<f64>,
}

impl Options {
    /// Options with half-decade steps from 1e-2 to where round-off dominates: 1e-6 for central differences, 1e-9 for
    /// one-sided ones.
    pub fn new(scheme: DifferenceScheme) -> Self {
        let finest = if scheme == DifferenceScheme::Central { 12 } else { 18 };
        Self { scheme, steps: (4..=finest).map(|k| 10.0_f64.powf(-0.5 * f64::from(k))).collect() }
    }
}

impl Default for Options {
    /// Central differences.
    fn default() -> Self {
        Self::new(DifferenceScheme::Central)
    }
}

/// Result of the verification of all design variables.
#[derive(Clone, Debug)]
pub struct Verification {
    /// Scheme of the differences.
    pub scheme: DifferenceScheme,
    /// Checks of the variables, in the model's order.
    pub checks: Vec<VariableCheck>,
    /// True if the sweep was ended before all variables were checked.
    pub interrupted: bool,
}

/// Result of the check of one design variable.
#[derive(Clone, Debug)]
pub struct VariableCheck {
    /// The variable.
    pub variable: VariableId,
    /// Outcome of the check.
    pub outcome: CheckOutcome,
    /// Every quantity at the step where it agrees best. Truncation and round-off differ between quantities, so no
    /// single step suits all of them.
    pub quantities: Comparison,
    /// Quantity with the largest error at every step that could be solved.
    pub sweep: Vec<StepError>,
}

/// Outcome of a check.
#[derive(Clone, Debug, PartialEq)]
pub enum CheckOutcome {
    /// Every quantity agrees to [`DifferenceScheme::tolerance`] at some step.
    Passed,
    /// Some quantity agrees at no step.
    Failed,
    /// The mechanism cannot follow the variable, so there is nothing to compare.
    CannotFollow,
    /// No moved design could be solved, or the nominal one was not.
    NotSolved,
}

impl VariableCheck {
    /// Quantity with the largest error at its own best step. It decides the outcome.
    pub fn worst(&self) -> Option<&StepError> {
        self.quantities.worst()
    }
}

impl Verification {
    /// True if every variable that has sensitivities passed.
    pub fn passed(&self) -> bool {
        !self.interrupted
            && self
                .checks
                .iter()
                .all(|c| matches!(c.outcome, CheckOutcome::Passed | CheckOutcome::CannotFollow))
    }
}

/// Compares the sensitivities of a complete solution with re-solved designs, variable by variable. `progress` is called
/// after every variable and may end the study. An analysis that is
/// [ended by its caller](Analysis::ended_by) also ends it within a variable, which is then left out.
pub fn verify(
    analysis: &Analysis<'_>,
    solution: &Solution,
    options: &Options,
    mut progress: impl FnMut(Progress<'_>) -> ControlFlow<()>,
) -> Verification {
    let mut checks = Vec::new();
    let mut interrupted = false;
    let variables = analysis.model().variables.len();
    let nonsmooth = NonsmoothClearances::of(analysis.model(), solution);
    for k in 0..variables {
        let variable = VariableId(k);
        let check = check_variable(analysis, (solution, &nonsmooth), options, variable);
        let is_whole = check.is_some();
        checks.extend(check);
        if !is_whole
            || progress(Progress::counted(Step::Variable, k + 1, variables)).is_break() && k + 1 < variables
        {
            interrupted = true;
            break;
        }
    }
    Verification { scheme: options.scheme, checks, interrupted }
}

/// Checks one variable; `None` if the analysis was ended meanwhile.
fn check_variable(
    analysis: &Analysis<'_>,
    (solution, nonsmooth): (&Solution, &NonsmoothClearances),
    options: &Options,
    variable: VariableId,
) -> Option<VariableCheck> {
    if matches!(solution.sensitivities.admissibility[variable.0], Admissibility::CannotFollow { .. }) {
        let (quantities, sweep) = Default::default();
        return Some(VariableCheck { variable, outcome: CheckOutcome::CannotFollow, quantities, sweep });
    }
    let natural = analysis.model().natural_step(variable);
    let steps: Vec<(VariableId, f64)> = options.steps.iter().map(|part| (variable, part * natural)).collect();
    let mut quantities = Comparison::default();
    let mut sweep = Vec::new();
    let (model, tolerance) = (analysis.model(), options.scheme.tolerance());
    let differences = finite_differences(analysis, solution, options.scheme, &steps);
    if analysis.is_ended() {
        return None;
    }
    let differences: Vec<_> = differences.into_iter().flatten().collect();
    let undecided = UndecidedOutputs::by(model, solution, nonsmooth, differences.last());
    for d in &differences {
        let comparison = Comparison::where_decided(model, solution, d, &undecided);
        sweep.push(comparison.worst().cloned().unwrap_or_else(|| StepError {
            step: d.step,
            error: 0.0,
            quantity: "nothing to compare".into(),
            time: 0.0,
        }));
        quantities.keep_better(comparison);
    }
    quantities.allow_for_spread(model, solution, &differences, &undecided, tolerance);
    let passed = quantities.errors().iter().all(|q| q.error <= tolerance);
    let outcome = match (sweep.is_empty() || solution.motion.is_empty(), passed) {
        (true, _) => CheckOutcome::NotSolved,
        (_, true) => CheckOutcome::Passed,
        (_, false) => CheckOutcome::Failed,
    };
    Some(VariableCheck { variable, outcome, quantities, sweep })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_models::crank_rocker;
    use hardpoint::model::Model;

    /// Relative error of a derivative that the check must detect.
    const WRONG: f64 = 1e-4;

    /// The spread of differences allows for truncation and round-off, which are far below this error on a crank-rocker.
    #[test]
    fn a_derivative_of_an_output_that_is_wrong_at_one_time_fails() {
        let draft = crank_rocker().times((0..=20).map(|k| 0.1 * f64::from(k))).variable_moving(
            "C",
            "C",
            [1.0, 0.3, 0.0],
        );
        let model = Model::from_draft(&draft).unwrap();
        let analysis = Analysis::new(&model).unwrap();
        let right = analysis.run();
        let outcome = |solution: &Solution| {
            let options = Options::new(DifferenceScheme::Central);
            let found = verify(&analysis, solution, &options, |_| ControlFlow::Continue(()));
            found.checks[0].outcome.clone()
        };
        assert_eq!(outcome(&right), CheckOutcome::Passed);
        let variable = VariableId(0);
        let m = right.measured.index("tip.x").unwrap();
        for order in 0..3 {
            let of = |k: usize| right.measured.d(k, variable, m)[order];
            let largest = (0..right.measured.len()).map(|k| of(k).abs()).fold(0.0, f64::max);
            for k in [3, 11] {
                let mut wrong = right.clone();
                let mut numbers = right.measured.d(k, variable, m);
                numbers[order] += WRONG * largest;
                wrong.measured.set_d(k, variable, m, numbers);
                assert_eq!(outcome(&wrong), CheckOutcome::Failed, "order {order} at time {k}");
            }
        }
    }
}

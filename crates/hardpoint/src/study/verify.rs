//! The paper's section 6 for any model: analytic sensitivities against re-solved designs, over a sweep of steps. The
//! error must fall with the square of the step (central differences) or with the step itself (one-sided ones), then
//! rise by round-off.

use std::ops::ControlFlow;

use crate::model::VariableId;
use crate::run::{Analysis, Solution};
use crate::sensitivity::Admissibility;

use super::comparison::{Comparison, StepError, UndecidedOutputs};
use super::difference::{DifferenceScheme, finite_differences};

/// A quantity passes if central differences agree to this at some step of the sweep, relative to the largest
/// sensitivity of its kind. The best that they can reach in a well-conditioned mechanism is about (machine
/// epsilon)^(2/3) = 4e-11; accelerations near a limit lose four digits of it. Where differences do not agree with one
/// another to this, because of truncation or round-off, by how much they do not is allowed besides.
pub const PASS: f64 = 1e-6;

/// The same for one-sided differences. Truncation grows with the step itself, so that they reach (machine
/// epsilon)^(1/2) = 1.5e-8 at best: 400 times more than central ones, and the tolerance is as many times larger.
pub const PASS_ONE_SIDED: f64 = 4e-4;

/// Options of a verification.
#[derive(Clone, Debug)]
pub struct VerifyOptions {
    /// Designs that are compared.
    pub scheme: DifferenceScheme,
    /// Steps as parts of [natural steps](crate::model::Model::natural_step), from coarse to fine.
    pub steps: Vec<f64>,
}

impl VerifyOptions {
    /// Half decades from 1e-2 to where round-off rules: 1e-6 for central differences, 1e-9 for one-sided ones.
    pub fn new(scheme: DifferenceScheme) -> Self {
        let finest = if scheme == DifferenceScheme::Central { 12 } else { 18 };
        Self { scheme, steps: (4..=finest).map(|k| 10.0_f64.powf(-0.5 * f64::from(k))).collect() }
    }
}

impl Default for VerifyOptions {
    /// Central differences.
    fn default() -> Self {
        Self::new(DifferenceScheme::Central)
    }
}

impl DifferenceScheme {
    /// Within what these differences must agree.
    pub fn tolerance(self) -> f64 {
        if self == Self::Central { PASS } else { PASS_ONE_SIDED }
    }
}

/// The check of all design variables.
#[derive(Clone, Debug)]
pub struct Verification {
    /// Designs that were compared.
    pub scheme: DifferenceScheme,
    /// One entry per variable, in the model's order.
    pub checks: Vec<VariableCheck>,
    /// True if the sweep was ended before all variables were checked.
    pub interrupted: bool,
}

/// The check of one design variable.
#[derive(Clone, Debug)]
pub struct VariableCheck {
    /// The variable.
    pub variable: VariableId,
    /// Outcome of the check.
    pub outcome: CheckOutcome,
    /// Every quantity at the step where it agrees best. Truncation and round-off are not the same for all of them, so
    /// that no one step suits all.
    pub quantities: Comparison,
    /// At every step that could be solved, the quantity that agrees worst there.
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
    /// The quantity that agrees worst at its own best step, which decides.
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

/// Compares the sensitivities of a complete solution with re-solved designs, variable by variable.
/// `progress` is called with the number of variables done, and may end the study; an analysis that is
/// [asked to end](Analysis::ended_by) ends it within a variable, which is then left out.
pub fn verify(
    analysis: &Analysis<'_>,
    solution: &Solution,
    options: &VerifyOptions,
    mut progress: impl FnMut(usize) -> ControlFlow<()>,
) -> Verification {
    let mut checks = Vec::new();
    let mut interrupted = false;
    let variables = analysis.model().variables.len();
    for k in 0..variables {
        let variable = VariableId(k);
        let check = check_variable(analysis, solution, options, variable);
        let is_whole = check.is_some();
        checks.extend(check);
        if !is_whole || progress(k + 1).is_break() && k + 1 < variables {
            interrupted = true;
            break;
        }
    }
    Verification { scheme: options.scheme, checks, interrupted }
}

/// The check of one variable; nothing where the analysis was asked to end meanwhile.
fn check_variable(
    analysis: &Analysis<'_>,
    solution: &Solution,
    options: &VerifyOptions,
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
    let undecided = UndecidedOutputs::by(model, solution, differences.last());
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
    use crate::model::Model;
    use crate::study::test_models::crank_rocker;

    /// A derivative of an output that is wrong by this part of the largest of its kind.
    const WRONG: f64 = 1e-4;

    /// The spread of differences allows for truncation and round-off, which are far less than this on a crank-rocker.
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
            let options = VerifyOptions::new(DifferenceScheme::Central);
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

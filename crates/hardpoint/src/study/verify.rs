//! The paper's section 6 for any model: analytic sensitivities against re-solved designs, over a sweep of
//! steps. The error must fall with the square of the step (central differences) or with the step itself (one-sided ones), then
//! rise by round-off.

use std::ops::ControlFlow;

use crate::model::{Dimension, VariableId};
use crate::run::{Analysis, Solution};
use crate::sensitivity::{Admissibility, BodySensitivity};
use crate::space::Vec3;

use super::difference::{Difference, Scheme, finite_differences, natural_step};

/// A quantity passes if central differences agree to this at some step of the sweep, relative to the largest sensitivity of its
/// kind. The best that they can reach in a well-conditioned mechanism is about (machine epsilon)^(2/3) = 4e-11;
/// accelerations near a limit lose four digits of it.
pub const PASS: f64 = 1e-6;

/// The same for one-sided differences. Truncation grows with the step itself, so that they reach
/// (machine epsilon)^(1/2) = 1.5e-8 at best: 400 times more than central ones, and the tolerance is as many times larger.
pub const PASS_ONE_SIDED: f64 = 4e-4;

/// What to sweep.
#[derive(Clone, Debug)]
pub struct VerifyOptions {
    /// Which designs are compared.
    pub scheme: Scheme,
    /// Steps as parts of [`natural_step`], from coarse to fine.
    pub steps: Vec<f64>,
}

impl VerifyOptions {
    /// Half decades from 1e-2 to where round-off rules: 1e-6 for central differences, 1e-9 for one-sided ones.
    pub fn new(scheme: Scheme) -> Self {
        let finest = if scheme == Scheme::Central { 12 } else { 18 };
        Self { scheme, steps: (4..=finest).map(|k| 10.0_f64.powf(-0.5 * f64::from(k))).collect() }
    }
}

impl Default for VerifyOptions {
    /// Central differences.
    fn default() -> Self {
        Self::new(Scheme::Central)
    }
}

impl Scheme {
    /// Within what these differences must agree.
    pub fn tolerance(self) -> f64 {
        if self == Self::Central { PASS } else { PASS_ONE_SIDED }
    }
}

/// The check of all design variables.
#[derive(Clone, Debug)]
pub struct Verification {
    /// Which designs were compared.
    pub scheme: Scheme,
    /// One entry per variable, in the model's order.
    pub checks: Vec<Check>,
    /// Whether the sweep was ended before all variables were checked.
    pub interrupted: bool,
}

/// The check of one design variable.
#[derive(Clone, Debug)]
pub struct Check {
    /// The variable.
    pub variable: VariableId,
    /// What came of it.
    pub outcome: CheckOutcome,
    /// Every quantity, in the order of [`compare_with_difference`], at the step where it agrees best. Truncation and round-off are
    /// not the same for all of them, so that no one step suits all.
    pub quantities: Vec<StepError>,
    /// At every step that could be solved, the quantity that agrees worst there.
    pub sweep: Vec<StepError>,
}

/// What came of a check.
#[derive(Clone, Debug, PartialEq)]
pub enum CheckOutcome {
    /// Every quantity agrees to [`Scheme::tolerance`] at some step.
    Passed,
    /// Some quantity agrees at no step.
    Failed,
    /// The mechanism cannot follow the variable, so there is nothing to compare.
    CannotFollow,
    /// No moved design could be solved, or the nominal one was not.
    NotSolved,
}

/// Analytic against finite difference of one quantity at one step.
#[derive(Clone, Debug, PartialEq)]
pub struct StepError {
    /// The step, m, rad, or units of tau.
    pub step: f64,
    /// Largest relative deviation over all times.
    pub error: f64,
    /// The quantity: `knuckle acceleration`, `toe rate`, ...
    pub quantity: String,
    /// The time where it is, s.
    pub time: f64,
}

impl Check {
    /// The quantity that agrees worst at its own best step, which decides.
    pub fn worst(&self) -> Option<&StepError> {
        worst_of(&self.quantities)
    }
}

impl Verification {
    /// Whether every variable that has sensitivities passed.
    pub fn passed(&self) -> bool {
        !self.interrupted
            && self
                .checks
                .iter()
                .all(|c| matches!(c.outcome, CheckOutcome::Passed | CheckOutcome::CannotFollow))
    }
}

/// Compares the sensitivities of a complete solution with re-solved designs, variable by variable.
/// `progress` is called with the number of variables done, and may end the study.
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
        checks.push(check_variable(analysis, solution, options, variable));
        if progress(k + 1).is_break() && k + 1 < variables {
            interrupted = true;
            break;
        }
    }
    Verification { scheme: options.scheme, checks, interrupted }
}

fn worst_of(errors: &[StepError]) -> Option<&StepError> {
    errors.iter().max_by(|a, b| a.error.total_cmp(&b.error))
}

fn check_variable(
    analysis: &Analysis<'_>,
    solution: &Solution,
    options: &VerifyOptions,
    variable: VariableId,
) -> Check {
    if matches!(solution.sensitivities.admissibility[variable.0], Admissibility::CannotFollow { .. }) {
        let (quantities, sweep) = Default::default();
        return Check { variable, outcome: CheckOutcome::CannotFollow, quantities, sweep };
    }
    let natural = natural_step(analysis.model(), variable);
    let steps: Vec<(VariableId, f64)> = options.steps.iter().map(|part| (variable, part * natural)).collect();
    let mut quantities: Vec<StepError> = Vec::new();
    let mut sweep = Vec::new();
    for d in finite_differences(analysis, solution, options.scheme, &steps).into_iter().flatten() {
        let errors = compare_with_difference(analysis, solution, &d);
        sweep.push(worst_of(&errors).cloned().unwrap_or_else(|| StepError {
            step: d.step,
            error: 0.0,
            quantity: "nothing to compare".into(),
            time: 0.0,
        }));
        if quantities.is_empty() {
            quantities = errors;
        } else {
            let better = quantities.iter_mut().zip(errors).filter(|(best, e)| e.error < best.error);
            better.for_each(|(best, e)| *best = e);
        }
    }
    let passed = quantities.iter().all(|q| q.error <= options.scheme.tolerance());
    let outcome = match (sweep.is_empty() || solution.motion.is_empty(), passed) {
        (true, _) => CheckOutcome::NotSolved,
        (_, true) => CheckOutcome::Passed,
        (_, false) => CheckOutcome::Failed,
    };
    Check { variable, outcome, quantities, sweep }
}

/// Largest relative deviation of every quantity, in this order: position, orientation, velocity, angular
/// velocity, acceleration, angular acceleration, each of all bodies but ground; then value, rate and
/// acceleration of every output.
///
/// A deviation is relative to the largest sensitivity of its kind over all bodies and times, or, where
/// the design hardly matters, to what one natural step would have to change for one part in a thousand of
/// the motion itself.
pub fn compare_with_difference(
    analysis: &Analysis<'_>,
    solution: &Solution,
    d: &Difference,
) -> Vec<StepError> {
    /// A sensitivity that moves a quantity by less than this part of it per natural step counts as zero.
    const NEGLIGIBLE: f64 = 1e-3;
    /// An order that changes the one before it by less than this part during the run is round-off.
    const STEADY: f64 = 1e-12;
    let model = analysis.model();
    let natural = natural_step(model, d.variable);
    let mut errors = Vec::new();
    let Some(times) = (!solution.motion.is_empty()).then_some(&solution.motion.times) else { return errors };
    let steps = times.len();
    let size = model.size();

    let mut push = |name: String, scale: f64, deviations: &mut dyn Iterator<Item = f64>| {
        let (k, most) = deviations.enumerate().fold((0, 0.0), |best, (k, x)| {
            // A NaN deviation must win.
            if !(x <= best.1) { (k, x) } else { best }
        });
        let error = if most == 0.0 { 0.0 } else { most / scale };
        let error = if error.is_nan() { f64::INFINITY } else { error };
        errors.push(StepError { step: d.step, error, quantity: name, time: times[k] });
    };

    // The motion's own magnitude at orders 0, 1, 2: lengths in sizes, angles in rad. Where a motion
    // stands still, or runs at a steady speed, the next order is round-off: it is judged as if it made up
    // the order before it once in the run.
    let span = if steps > 1 { times[steps - 1] - times[0] } else { 1.0 };
    let mut magnitude = solution.motion.states().fold([1.0_f64, 0.0, 0.0], |m, s| {
        [
            m[0],
            m[1].max(s.omega.norm()).max(s.v.norm() / size),
            m[2].max(s.alpha.norm()).max(s.a.norm() / size),
        ]
    });
    for order in 1..3 {
        if magnitude[order] * span < STEADY * magnitude[order - 1] {
            magnitude[order] = magnitude[order - 1] / span;
        }
    }
    let floor = |order: usize, of: Dimension| {
        let order = (order as i8 - of.time).clamp(0, 2) as usize;
        NEGLIGIBLE * magnitude[order] * size.powi(of.length.into()) / natural
    };

    type Of = fn(&BodySensitivity) -> Vec3;
    let (length, angle) = (Dimension::LENGTH, Dimension::ANGLE);
    let kinds: [(&str, Of, usize, Dimension); 6] = [
        ("position", |s| s.dr, 0, length),
        ("orientation", |s| s.dpi, 0, angle),
        ("velocity", |s| s.dv, 1, length),
        ("angular velocity", |s| s.domega, 1, angle),
        ("acceleration", |s| s.da, 2, length),
        ("angular acceleration", |s| s.dalpha, 2, angle),
    ];
    let n = solution.motion.bodies;
    // Time by time and body by body, like the difference; nothing where the mechanism cannot follow the variable.
    let exact = (0..steps).filter_map(|k| solution.sensitivities.at(k, d.variable.0));
    let exact: Vec<BodySensitivity> = exact.flat_map(|bodies| bodies.iter()).collect();
    for (kind, of, order, dimension) in kinds {
        let analytic = |k: usize, i: usize| exact.get(k * n + i).map(of);
        let largest = exact.iter().map(|s| of(s).norm()).fold(0.0, f64::max);
        let scale = largest.max(floor(order, dimension));
        for i in 1..n {
            let name = format!("{} {kind}", model.bodies[i].name);
            let mut deviations = (0..steps)
                .map(|k| analytic(k, i).map_or(f64::NAN, |a| (a - of(&d.bodies[k * n + i])).norm()));
            push(name, scale, &mut deviations);
        }
    }
    let measured = &solution.measured;
    let columns = measured.outputs.len();
    for (m, output) in measured.outputs.iter().enumerate() {
        for order in 0..output.known.orders {
            let analytic = |k: usize| measured.d(k, d.variable, m)[order];
            let largest = (0..steps).map(|k| analytic(k).abs()).fold(0.0, f64::max);
            let scale = largest.max(floor(order, output.dimension));
            // Next to a time without a number the neighbours' may be anything.
            let defined =
                |k: &usize| measured.value(*k, m)[..output.known.orders].iter().all(|x| x.is_finite());
            let deviation = |k: usize| (analytic(k) - d.outputs[k * columns + m][order]).abs();
            let mut deviations = (0..steps).map(|k| if defined(&k) { deviation(k) } else { 0.0 });
            let name = output.order_name(order);
            push(if order == 0 { format!("{name} value") } else { name }, scale, &mut deviations);
        }
    }
    errors
}

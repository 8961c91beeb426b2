//! The paper's section 6 for any model: analytic sensitivities against re-solved designs, over a sweep of
//! steps. The error must fall with the square of the step, then rise by round-off.

use std::ops::ControlFlow;

use crate::analysis::{Analysis, Solution};
use crate::model::{Dimension, VariableId};
use crate::sensitivity::Admissibility;
use crate::space::Vec3;

use super::difference::{Difference, central_differences, natural_step};

/// A variable passes if the best step of its sweep agrees to this, relative to the quantity's largest
/// sensitivity. The best that a central difference of a well-conditioned mechanism can reach is about
/// (machine epsilon)^(2/3) = 4e-11; accelerations near a limit lose four digits of it.
pub const PASS: f64 = 1e-6;

/// What to sweep.
#[derive(Clone, Debug)]
pub struct VerifyOptions {
    /// Steps as parts of [`natural_step`], from coarse to fine.
    pub steps: Vec<f64>,
}

impl Default for VerifyOptions {
    /// Half decades from 1e-2 to 1e-6.
    fn default() -> Self {
        Self { steps: (4..=12).map(|k| 10.0_f64.powf(-0.5 * f64::from(k))).collect() }
    }
}

/// The check of all design variables.
#[derive(Clone, Debug)]
pub struct Verification {
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
    /// The error at every step that could be solved.
    pub sweep: Vec<StepError>,
}

/// What came of a check.
#[derive(Clone, Debug, PartialEq)]
pub enum CheckOutcome {
    /// The best step agrees to [`PASS`].
    Passed,
    /// No step agrees.
    Failed,
    /// The mechanism cannot follow the variable, so there is nothing to compare.
    CannotFollow,
    /// No moved design could be solved.
    NotSolved,
}

/// Analytic against finite difference at one step.
#[derive(Clone, Debug, PartialEq)]
pub struct StepError {
    /// The step, m, rad, or units of tau.
    pub step: f64,
    /// Largest relative deviation over all times and quantities.
    pub error: f64,
    /// The quantity where it is: `knuckle acceleration`, `toe rate`, ...
    pub worst: String,
    /// The time where it is, s.
    pub time: f64,
}

impl Check {
    /// The step that agrees best.
    pub fn best(&self) -> Option<&StepError> {
        self.sweep.iter().min_by(|a, b| a.error.total_cmp(&b.error))
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
    Verification { checks, interrupted }
}

fn check_variable(
    analysis: &Analysis<'_>,
    solution: &Solution,
    options: &VerifyOptions,
    variable: VariableId,
) -> Check {
    if matches!(solution.sensitivities.admissibility[variable.0], Admissibility::CannotFollow { .. }) {
        return Check { variable, outcome: CheckOutcome::CannotFollow, sweep: Vec::new() };
    }
    let natural = natural_step(analysis.model(), variable);
    let steps: Vec<(VariableId, f64)> = options.steps.iter().map(|part| (variable, part * natural)).collect();
    let sweep: Vec<StepError> = central_differences(analysis, &steps)
        .into_iter()
        .flatten()
        .map(|d| {
            let worst = compare_with_difference(analysis, solution, &d)
                .into_iter()
                .max_by(|a, b| a.error.total_cmp(&b.error));
            worst.unwrap_or(StepError {
                step: d.step,
                error: 0.0,
                worst: "nothing to compare".into(),
                time: 0.0,
            })
        })
        .collect();
    let best = sweep.iter().map(|s| s.error).fold(f64::INFINITY, f64::min);
    let outcome = match (sweep.is_empty(), best <= PASS) {
        (true, _) => CheckOutcome::NotSolved,
        (_, true) => CheckOutcome::Passed,
        (_, false) => CheckOutcome::Failed,
    };
    Check { variable, outcome, sweep }
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
        errors.push(StepError { step: d.step, error, worst: name, time: times[k] });
    };

    // The motion's own magnitude at orders 0, 1, 2: lengths in sizes, angles in rad. Where a motion
    // stands still, or runs at a steady speed, the next order is round-off: it is judged as if it made up
    // the order before it once in the run.
    let span = if steps > 1 { times[steps - 1] - times[0] } else { 1.0 };
    let mut magnitude = solution.motion.states.iter().fold([1.0_f64, 0.0, 0.0], |m, s| {
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

    type Of = fn(&crate::sensitivity::BodySensitivity) -> Vec3;
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
    for (kind, of, order, dimension) in kinds {
        let analytic = |k: usize, i: usize| solution.sensitivities.at(k, d.variable.0).map(|s| of(&s[i]));
        let everywhere = (0..steps).flat_map(|k| (0..n).map(move |i| (k, i)));
        let largest = everywhere.filter_map(|(k, i)| analytic(k, i)).map(Vec3::norm).fold(0.0, f64::max);
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

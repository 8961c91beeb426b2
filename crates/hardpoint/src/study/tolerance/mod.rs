//! Tolerance study: effects of the tolerances of design variables on every metric and along whole curves.
//!
//! From exact derivatives, without sampling: worst case, root of the sum of squares, mean and variance to second order,
//! what each variable contributes, yield (`docs/theory.md`, section on tolerances). Beside it the same from designs
//! that are drawn and solved exactly, so that the error of the derivatives' answer is seen, and the loosest tolerances
//! that keep the limits.

mod allocation;
mod contributions;
mod curves;
mod deviations;
mod monte_carlo;
mod worst;

use std::num::NonZero;
use std::ops::ControlFlow;

use crate::model::{LimitTarget, Model, ToleranceSettings, VariableId};
use crate::number::Real;
use crate::run::Run;
use crate::sensitivity::Admissibility;

use super::evaluation::{DesignEvaluation, EvaluationError, Motions, StudyCost};
use super::magnitude::Magnitude;
use super::metric::{metric_numbers, place_of};
pub use allocation::{AllocatedTolerance, Allocation, AllocationError};
pub use contributions::{Contributions, SpreadModel};
pub use curves::{BandPoint, CurveBands};
use deviations::Deviations;
pub use monte_carlo::{FailureGroup, MonteCarlo, SampledCurve, SampledMetric, Yield};
pub use worst::Extreme;

/// Threshold for a warning about nonlinearity: the second-order part of a deviation, or the shift of its mean, relative
/// to the first-order standard deviation.
pub const NONLINEAR: f64 = 0.1;
/// Gradients are differenced over this part of a natural step to either side: the error of the difference, in h^2, and
/// round-off, in 1/h, are then some 1e-8 of the second derivative.
const STEP: f64 = 1e-4;

/// Result of a tolerance study.
#[derive(Clone, Debug)]
pub struct ToleranceResult {
    /// The variables that may be off, in the order of the tolerances.
    pub variables: Vec<TolerancedVariable>,
    /// Variables with a tolerance that the mechanism cannot follow: they stay in the design configuration.
    pub left_out: Vec<VariableId>,
    /// Per metric and motion.
    pub metrics: Vec<MetricSpread>,
    /// Per metric and motion, what each variable contributes to its variance.
    pub contributions: Vec<Contributions>,
    /// Metrics that have no value in the design configuration: the metric, and the motion.
    pub unknown: Vec<(usize, usize)>,
    /// Per measure and motion.
    pub curves: Vec<CurveBands>,
    /// Per limit, and per motion that its metric is taken of.
    pub limits: Vec<LimitYield>,
    /// The designs that were drawn, if any were requested.
    pub sampled: Option<MonteCarlo>,
    /// The loosest tolerances, if they were requested.
    pub allocation: Option<Allocation>,
    /// Cost of the study.
    pub cost: StudyCost,
    /// True if it was ended before all was done.
    pub interrupted: bool,
}

/// A variable that may be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TolerancedVariable {
    /// Which.
    pub variable: VariableId,
    /// By which of the tolerances.
    pub tolerance: usize,
    /// Standard deviation, m, rad or a plain number.
    pub sigma: f64,
    /// The kurtosis of its deviation: 3 where it is normal.
    pub kurtosis: f64,
}

/// Effect of tolerances on a metric in one motion, from derivatives. SI.
#[derive(Clone, Debug)]
pub struct MetricSpread {
    /// Place in [`Model::metrics`].
    pub metric: usize,
    /// The motion, by its place among those studied.
    pub motion: usize,
    /// In the design configuration.
    pub nominal: f64,
    /// Derivative by every variable that may be off.
    pub d: Vec<f64>,
    /// Standard deviation to first order: the root of the sum of squares.
    pub sigma: f64,
    /// The part of the first-order variance that each variable contributes; they add up to 1. With correlated variables
    /// one may be negative: it takes away from what another brings.
    pub shares: Vec<f64>,
    /// The same of the variance to second order, where that is known.
    pub second_shares: Option<Vec<f64>>,
    /// The least and the greatest value that the tolerances allow.
    pub worst: [Extreme; 2],
    /// Second-order moments; `None` if a moved design near the nominal one does not reach the end, so that the gradient
    /// has no difference there.
    pub second: Option<SecondOrder>,
    /// Threshold of a zero change.
    pub round_off: f64,
}

/// Moments to second order, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondOrder {
    /// By how much the mean is off the value in the design configuration.
    pub shift: f64,
    /// The standard deviation.
    pub sigma: f64,
    /// The standard deviation of the second-order part alone.
    pub bend: f64,
}

/// True if a limit will be kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitYield {
    /// Place in [`ToleranceSettings::limits`].
    pub limit: usize,
    /// The place of its metric and motion in [`ToleranceResult::metrics`].
    pub spread: usize,
    /// The part of all made that keeps it, if the metric is normal with the moments that derivatives give.
    pub by_moments: f64,
    /// The part of the designs drawn that keep it; those that do not move to the end do not.
    pub sampled: Option<Yield>,
}

impl ToleranceResult {
    /// The deviations of the variables that may be off in the sample of a number, for the tolerances that were asked.
    pub fn deviations(&self, model: &Model, asked: &ToleranceSettings) -> impl Fn(usize) -> Vec<f64> + use<> {
        let (deviations, seed) = (Deviations::new(model, asked, &self.left_out), asked.seed);
        move |number| deviations.drawn(seed, number)
    }
}

/// The designs that are drawn within tolerances, by their numbers: all variables, in SI. Those that are left out stay
/// in the design configuration.
pub fn toleranced_designs(
    model: &Model,
    asked: &ToleranceSettings,
    left_out: &[VariableId],
) -> impl Fn(usize) -> Vec<f64> + use<> {
    let (deviations, seed, variables) =
        (Deviations::new(model, asked, left_out), asked.seed, model.variables.len());
    move |number| deviations.design(variables, &deviations.drawn(seed, number))
}

/// Reason why there is no result.
#[derive(Clone, Debug)]
pub enum ToleranceError {
    /// The nominal design does not reach the end of some motion, or it was interrupted there.
    Drawn(EvaluationError),
    /// The mechanism can follow none of the variables with a tolerance.
    NothingVaries,
}

/// Progress reports of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToleranceStage {
    /// Number of these gradients that are differenced.
    Derivatives(usize, usize),
    /// Number of these designs that were solved.
    Designs(usize, usize),
}

impl MetricSpread {
    /// The mean to second order, or in the design configuration where that is not known.
    pub fn mean(&self) -> f64 {
        self.nominal + self.second.map_or(0.0, |s| s.shift)
    }

    /// The standard deviation to the highest order that is known.
    pub fn best_sigma(&self) -> f64 {
        self.second.map_or(self.sigma, |s| s.sigma)
    }

    /// Nonlinearity of the metric within the tolerances: the second-order part relative to the first-order standard
    /// deviation.
    pub fn nonlinearity(&self) -> Option<f64> {
        let s = self.second?;
        let part = s.bend.max(s.shift.abs());
        Some(if part <= self.round_off { 0.0 } else { part / self.sigma })
    }

    /// True if the linear answer is off, as reported by the second derivatives.
    pub fn is_nonlinear(&self) -> bool {
        self.nonlinearity().is_none_or(|part| !(part <= NONLINEAR))
    }
}

/// Studies the tolerances of a design in some motions of the mechanism, each of which is the model's own of that number
/// ([`Model::motions`]). `tell` is reported how far it is and may end it, `more` is asked at every output time of
/// single designs.
///
/// # Errors
/// A [`ToleranceError`] where there is nothing to depend on.
pub fn tolerance(
    model: &Model,
    motions: &Motions<'_>,
    numbers: &[usize],
    asked: &ToleranceSettings,
    threads: NonZero<usize>,
    tell: &mut (dyn FnMut(ToleranceStage) -> ControlFlow<()> + Send),
    more: &(dyn Fn() -> bool + Sync),
) -> Result<ToleranceResult, ToleranceError> {
    let mut cost = StudyCost::default();
    let drawn = motions.evaluate(&[], &mut cost, more).map_err(ToleranceError::Drawn)?;
    let (deviations, left_out) = deviations(model, &drawn, asked);
    if deviations.variables.is_empty() {
        return Err(ToleranceError::NothingVaries);
    }
    let study = Study { model, motions, numbers, asked, deviations: &deviations, drawn: &drawn };
    let (taken, unknown) = study.taken();
    let mut interrupted = false;
    let mut tell = |stage: ToleranceStage| {
        let told = tell(stage);
        interrupted |= told.is_break();
        told
    };
    let hessians = study.hessians(&taken, &mut cost, &mut tell, more);
    let metrics: Vec<MetricSpread> = taken
        .iter()
        .zip(hessians)
        .map(|(one, hessian)| study.spread(one, hessian.as_deref(), &mut cost))
        .collect();
    let curves = study.curves(more);
    let limits = study.limits(&metrics);
    let mut found = ToleranceResult {
        variables: deviations.variables.clone(),
        left_out,
        metrics,
        contributions: Vec::new(),
        unknown,
        curves,
        limits,
        sampled: None,
        allocation: None,
        cost,
        interrupted: false,
    };
    if asked.samples > 0 {
        let sampled = study.sample(&deviations, &found, threads, &mut tell, more);
        found.cost += sampled.cost;
        // Nothing can be said of none, where the time is up before the first of them.
        if sampled.samples > 0 {
            sampled.limits.iter().zip(&mut found.limits).for_each(|(y, limit)| limit.sampled = Some(*y));
            found.sampled = Some(sampled);
        }
    }
    if let Some(rule) = asked.allocation {
        let mut allocation = allocation::allocate(&study, rule, &found);
        if let Some(tolerances) = allocation
            .reaches_of(asked.tolerances.iter().map(|t| t.reach))
            .filter(|_| study.asked.samples > 0)
        {
            let loose = deviations.with_reaches(study.asked, &tolerances);
            let sampled = study.sample(&loose, &found, threads, &mut tell, more);
            found.cost += sampled.cost;
            allocation.sampled = Some(sampled).filter(|s| s.samples > 0);
        }
        found.allocation = Some(allocation);
    }
    found.add_contributions(model, asked);
    found.interrupted = interrupted || !more();
    Ok(found)
}

/// Tolerances of a design in some motions.
struct Study<'s> {
    model: &'s Model,
    motions: &'s Motions<'s>,
    /// Per motion, its number among those of the model.
    numbers: &'s [usize],
    asked: &'s ToleranceSettings,
    deviations: &'s Deviations,
    drawn: &'s DesignEvaluation,
}

/// A metric in one motion.
struct Taken {
    /// Place in [`Model::metrics`].
    metric: usize,
    motion: usize,
    /// Place in the metrics of the motion.
    place: usize,
}

/// The variables that may be off, and those of them that the mechanism cannot follow.
fn deviations(
    model: &Model,
    drawn: &DesignEvaluation,
    asked: &ToleranceSettings,
) -> (Deviations, Vec<VariableId>) {
    let cannot = |v: VariableId| {
        let known = |s: &crate::run::Solution| {
            matches!(s.sensitivities.admissibility.get(v.0), Some(Admissibility::CannotFollow { .. }))
        };
        drawn.solutions.iter().any(known)
    };
    let of_all = asked.tolerances.iter().flat_map(|t| t.variables.iter().copied());
    let left_out: Vec<VariableId> = of_all.filter(|v| cannot(*v)).collect();
    (Deviations::new(model, asked, &left_out), left_out)
}

impl Study<'_> {
    /// Metrics of each motion, and those without a value.
    fn taken(&self) -> (Vec<Taken>, Vec<(usize, usize)>) {
        let mut asked = self.asked.metrics.clone();
        let of_limit = |limit: &crate::model::Limit| match limit.of {
            LimitTarget::Metric(m) => Some(m),
            _ => None,
        };
        asked.extend(self.asked.limits.iter().filter_map(of_limit));
        asked.sort_unstable();
        asked.dedup();
        let (mut taken, mut unknown) = (Vec::new(), Vec::new());
        for metric in asked {
            for (motion, &number) in self.numbers.iter().enumerate() {
                let Some(place) = place_of(self.model, metric, number) else { continue };
                match self.drawn.metrics[motion][place].value {
                    Some(_) => taken.push(Taken { metric, motion, place }),
                    None => unknown.push((metric, motion)),
                }
            }
        }
        (taken, unknown)
    }

    /// The second derivatives of every metric by the variables that may be off: differences of exact gradients.
    fn hessians(
        &self,
        taken: &[Taken],
        cost: &mut StudyCost,
        tell: &mut dyn FnMut(ToleranceStage) -> ControlFlow<()>,
        more: &(dyn Fn() -> bool + Sync),
    ) -> Vec<Option<Vec<Vec<f64>>>> {
        let variables = &self.deviations.variables;
        let n = variables.len();
        let mut columns: Vec<Option<Vec<Vec<f64>>>> = taken.iter().map(|_| Some(Vec::new())).collect();
        for (j, tolerated) in variables.iter().enumerate() {
            let h = STEP * self.model.natural_step(tolerated.variable);
            let sides = [h, -h].map(|by| {
                if columns.iter().all(Option::is_none) || tell(ToleranceStage::Derivatives(j, n)).is_break() {
                    return None;
                }
                self.motions.evaluate(&self.model.alone(tolerated.variable, by), cost, more).ok()
            });
            for (one, columns) in taken.iter().zip(&mut columns) {
                let gradient = |side: &Option<DesignEvaluation>| {
                    let value = &side.as_ref()?.metrics[one.motion][one.place];
                    value.value.is_some().then(|| self.by_tolerated(&value.d))
                };
                // H e_j = (g(b + h e_j) - g(b - h e_j)) / 2 h
                let column = gradient(&sides[0]).zip(gradient(&sides[1])).map(|(up, down)| {
                    up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * h)).collect::<Vec<f64>>()
                });
                match (columns.as_mut(), column) {
                    (Some(all), Some(column)) if column.iter().all(|x| x.is_finite()) => all.push(column),
                    _ => *columns = None,
                }
            }
        }
        let symmetric = |h: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
            (0..n).map(|i| (0..n).map(|j| 0.5 * (h[i][j] + h[j][i])).collect()).collect()
        };
        columns.into_iter().map(|h| h.map(symmetric)).collect()
    }

    fn by_tolerated(&self, d: &[f64]) -> Vec<f64> {
        self.deviations.variables.iter().map(|v| d[v.variable.0]).collect()
    }

    fn spread(&self, one: &Taken, hessian: Option<&[Vec<f64>]>, cost: &mut StudyCost) -> MetricSpread {
        let value = &self.drawn.metrics[one.motion][one.place];
        let nominal = value.value.expect("only metrics with a value are taken");
        let d = self.by_tolerated(&value.d);
        let sigma = self.deviations.sigma(&d);
        let second = hessian.map(|h| self.deviations.second_order(&d, h));
        let worst = [-1.0, 1.0].map(|sign| {
            let mut extreme = worst::extreme(self.deviations, nominal, &d, hessian, sign);
            let design = self.deviations.design(self.model.variables.len(), &extreme.deviations);
            let analysis = &self.motions.analyses()[one.motion];
            let solution = analysis.solve(Run::new().at(&design).without_sensitivities());
            *cost += StudyCost { designs: 1, motions: 1, steps: solution.motion.len() };
            match &solution.stop {
                Some(stop) => extreme.why = Some(stop.headline(analysis.model())),
                None => extreme.exact = metric_numbers(analysis.model(), &solution).nth(one.place).flatten(),
            }
            extreme
        });
        let shares = self.deviations.shares(&d);
        let second_shares = hessian.map(|h| self.deviations.second_shares(&d, h));
        let motion = &self.drawn.solutions[one.motion].motion;
        let dimension = self.model.metric_dimension(&self.model.metrics[one.metric]);
        let round_off = Magnitude::of_motion(self.model, motion).round_off(dimension, 0);
        MetricSpread {
            metric: one.metric,
            motion: one.motion,
            nominal,
            d,
            sigma,
            shares,
            second_shares,
            worst,
            second,
            round_off,
        }
    }

    fn limits(&self, metrics: &[MetricSpread]) -> Vec<LimitYield> {
        let mut found = Vec::new();
        for (k, limit) in self.asked.limits.iter().enumerate() {
            for (spread, of) in
                metrics.iter().enumerate().filter(|(_, m)| limit.of == LimitTarget::Metric(m.metric))
            {
                let below = |x: f64| normal_below(x, of.mean(), of.best_sigma());
                let by_moments = limit.most.map_or(1.0, below) - limit.least.map_or(0.0, below);
                found.push(LimitYield { limit: k, spread, by_moments: by_moments.max(0.0), sampled: None });
            }
        }
        found
    }
}

/// The part of a normal distribution that is below x.
fn normal_below(x: f64, mean: f64, sigma: f64) -> f64 {
    if sigma == 0.0 {
        return if x >= mean { 1.0 } else { 0.0 };
    }
    0.5 * libm::erfc((mean - x) / (sigma * std::f64::consts::SQRT_2))
}

/// A dot product.
fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::zero(), |sum, (a, b)| sum + *a * *b)
}

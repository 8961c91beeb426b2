//! Tolerance study: effects of the tolerances of design variables on every metric and along whole curves.
//!
//! Input: a [`Request`] with tolerances (half widths in m, rad or plain), their distributions, and limits of metrics in
//! SI. Output: a [`ToleranceResult`] in SI, with yields from 0 to 1.
//!
//! Derivatives give, without sampling: worst case, root sum square, second-order mean (37) and variance (38),
//! contributions of the variables, and yield (`docs/theory.md`, section 12; Seber and Lee, *Linear Regression
//! Analysis*, theorems 1.5 and 1.6). Sampled designs that are solved exactly give the
//! same statistics and show the error of the derivatives. Allocation gives the loosest tolerances that satisfy the
//! limits.

mod allocation;
mod contributions;
mod curves;
mod deviations;
mod monte_carlo;
mod pins;
mod request;
mod worst;

use std::ops::ControlFlow;

use hardpoint::model::{LimitTarget, Model, ToleranceSettings, VariableId};
use hardpoint::run::Run;
use hardpoint::sensitivity::Admissibility;

use super::evaluation::{DesignEvaluation, EvaluationError, Motions, StudyCost};
use super::progress::{Control, Progress, Step};
use super::request::RequestError;
pub use allocation::{AllocatedTolerance, Allocation, AllocationError};
pub use contributions::{Contributions, SpreadModel};
pub use curves::{BandPoint, CurveBands};
use deviations::Deviations;
use hardpoint::run::{metrics, place_of};
use hardpoint_difference::Magnitude;
pub use monte_carlo::{FailureGroup, MonteCarlo, SampledCurve, SampledMetric, Yield};
pub use pins::SideChange;
pub use request::{Overrides, Request, allocation_rule};
pub use worst::Extreme;

/// Threshold for a warning about nonlinearity: second-order part of a deviation, or shift of its mean, relative to the
/// first-order standard deviation.
pub const NONLINEAR: f64 = 0.1;
/// Step of gradient differences to either side, as a fraction of a natural step: truncation, in h^2, and round-off, in
/// 1/h, are then about 1e-8 of the second derivative.
const STEP: f64 = 1e-4;
/// Maximum number of further designs that are solved for a worst case: the second one is seldom improved.
const MOST_FURTHER: usize = 3;
/// Predicted gain of a further design, as a fraction of the deviation of the metric, that is worth solving it.
const WORTHWHILE: f64 = 1e-3;

/// Result of a tolerance study.
#[derive(Clone, Debug)]
pub struct ToleranceResult {
    /// Toleranced variables, in the order of the tolerances.
    pub variables: Vec<TolerancedVariable>,
    /// Toleranced variables that the mechanism cannot follow. They keep their design values.
    pub left_out: Vec<VariableId>,
    /// Spread of each metric in each motion.
    pub metrics: Vec<MetricSpread>,
    /// Contributions of the variables to the variance, per metric and motion.
    pub contributions: Vec<Contributions>,
    /// Metrics without a nominal value: index of the metric and of the motion.
    pub unknown: Vec<(usize, usize)>,
    /// Bands of each measure in each motion.
    pub curves: Vec<CurveBands>,
    /// Pins with play that change sides under the loads of the nominal motions.
    pub side_changes: Vec<SideChange>,
    /// Yields per limit and motion of its metric.
    pub limits: Vec<LimitYield>,
    /// Monte Carlo results, if requested.
    pub sampled: Option<MonteCarlo>,
    /// Tolerance allocation, if requested.
    pub allocation: Option<Allocation>,
    /// Cost of the study.
    pub cost: StudyCost,
    /// True if the study was ended early.
    pub interrupted: bool,
}

/// Toleranced variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TolerancedVariable {
    /// The variable.
    pub variable: VariableId,
    /// Index of its tolerance.
    pub tolerance: usize,
    /// Standard deviation of its deviation, m, rad or a plain number.
    pub sigma: f64,
    /// Kurtosis of its deviation: 3 if it is normal.
    pub kurtosis: f64,
}

/// Effect of tolerances on a metric in one motion, from derivatives. SI.
#[derive(Clone, Debug)]
pub struct MetricSpread {
    /// Index in [`Model::metrics`].
    pub metric: usize,
    /// Index of the motion among those studied.
    pub motion: usize,
    /// Nominal value.
    pub nominal: f64,
    /// Derivative by every toleranced variable.
    pub d: Vec<f64>,
    /// First-order standard deviation: root sum square; 0 if it is round-off.
    pub sigma: f64,
    /// Contribution of each variable to the first-order variance; the sum is 1, or 0 without a variance. With
    /// correlated variables a contribution may be negative.
    pub shares: Vec<f64>,
    /// Contributions to the second-order variance, if it is known.
    pub second_shares: Option<Vec<f64>>,
    /// Minimum and maximum within the tolerances.
    pub worst: [Extreme; 2],
    /// Second-order moments; `None` if a design near the nominal one does not reach the end, so that the gradient
    /// cannot be differenced.
    pub second: Option<SecondOrder>,
    /// Threshold of a zero standard deviation.
    pub round_off: f64,
}

/// Moments to second order, in SI; 0 if they are round-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondOrder {
    /// Mean minus nominal value.
    pub shift: f64,
    /// Standard deviation.
    pub sigma: f64,
    /// Standard deviation of the second-order part alone.
    pub bend: f64,
}

/// Probability of keeping a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitYield {
    /// Index in [`ToleranceSettings::limits`].
    pub limit: usize,
    /// Index of its metric and motion in [`ToleranceResult::metrics`].
    pub spread: usize,
    /// Yield of a normal distribution with the moments from derivatives, 0 to 1; `None` if there are no derivatives.
    pub by_moments: Option<f64>,
    /// Yield of the sampled designs; designs that do not reach the end violate the limit.
    pub sampled: Option<Yield>,
}

impl ToleranceResult {
    /// Deviations of the toleranced variables in the sample with a number, for the requested tolerances.
    pub fn deviations(
        &self,
        model: &Model,
        settings: &ToleranceSettings,
    ) -> impl Fn(usize) -> Vec<f64> + use<> {
        let (deviations, seed) = (Deviations::new(model, settings, &self.left_out), settings.seed);
        move |number| deviations.sample(seed, number)
    }

    /// Square root R of the covariance matrix of the deviations, SI, for the requested tolerances: a row for each of
    /// [`variables`](Self::variables). A function with the derivatives g by these has the standard deviation |R^T g| to
    /// first order.
    pub fn covariance_root(&self, model: &Model, settings: &ToleranceSettings) -> Vec<Vec<f64>> {
        let deviations = Deviations::new(model, settings, &self.left_out);
        (0..deviations.variables.len()).map(|i| deviations.root_row(i)).collect()
    }
}

/// Sampled designs by number: all variables, SI. Variables that are left out keep their design values.
pub fn toleranced_designs(
    model: &Model,
    settings: &ToleranceSettings,
    left_out: &[VariableId],
) -> impl Fn(usize) -> Vec<f64> + use<> {
    let (deviations, seed, variables) =
        (Deviations::new(model, settings, left_out), settings.seed, model.variables.len());
    move |number| deviations.design(variables, &deviations.sample(seed, number))
}

/// Reason why a tolerance study has no result.
#[derive(Clone, Debug)]
pub enum Error {
    /// The nominal design does not reach the end of some motion, or the caller ended the study there.
    Nominal(EvaluationError),
    /// The mechanism can follow none of the variables with a tolerance.
    Request(RequestError),
}

impl MetricSpread {
    /// Second-order mean; the nominal value if it is unknown.
    pub fn mean(&self) -> f64 {
        self.nominal + self.second.map_or(0.0, |s| s.shift)
    }

    /// Standard deviation to the highest known order.
    pub fn best_sigma(&self) -> f64 {
        self.second.map_or(self.sigma, |s| s.sigma)
    }

    /// Nonlinearity of the metric within the tolerances: the second-order part relative to the first-order standard
    /// deviation, infinite if that is zero. `None` if it is unknown.
    pub fn nonlinearity(&self) -> Option<f64> {
        let s = self.second?;
        let part = s.bend.max(s.shift.abs());
        Some(if part == 0.0 { 0.0 } else { part / self.sigma })
    }

    /// True if the second derivatives indicate that the linear result is inaccurate.
    pub fn is_nonlinear(&self) -> bool {
        self.nonlinearity().is_none_or(|part| !(part <= NONLINEAR))
    }
}

/// Studies the tolerances of a design in some motions of the mechanism, given by their numbers in [`Model::motions`].
///
/// # Errors
/// A [`Error`] if there is nothing to study.
pub fn tolerance(
    model: &Model,
    motions: &Motions<'_>,
    numbers: &[usize],
    request: &Request,
    control: Control<'_>,
) -> Result<ToleranceResult, Error> {
    let Request { settings } = request;
    let Control { threads, progress, more } = control;
    let mut cost = StudyCost::default();
    let nominal = motions.evaluate(&[], &mut cost, more).map_err(Error::Nominal)?;
    let (deviations, left_out) = deviations(model, &nominal, settings);
    if deviations.variables.is_empty() {
        return Err(Error::Request(Request::nothing_varies(settings)));
    }
    let study = Study { model, motions, numbers, settings, deviations: &deviations, nominal: &nominal };
    let (studied, unknown) = study.studied();
    let mut interrupted = false;
    let mut tell = |progressed: Progress<'_>| {
        let flow = progress(progressed);
        interrupted |= flow.is_break();
        flow
    };
    let hessians = study.hessians(&studied, &mut cost, &mut tell, more);
    let metrics: Vec<MetricSpread> = studied
        .iter()
        .zip(hessians)
        .map(|(one, hessian)| study.spread(one, hessian.as_deref(), &mut cost))
        .collect();
    let (curves, side_changes) = study.curves(more);
    let limits = study.limits(&metrics);
    let mut found = ToleranceResult {
        variables: deviations.variables.clone(),
        left_out,
        metrics,
        contributions: Vec::new(),
        unknown,
        curves,
        side_changes,
        limits,
        sampled: None,
        allocation: None,
        cost,
        interrupted: false,
    };
    if settings.samples > 0 {
        let sampled = study.sample(&deviations, &found, threads, &mut tell, more);
        found.cost += sampled.cost;
        // Without samples there are no statistics.
        if sampled.samples > 0 {
            sampled.limits.iter().zip(&mut found.limits).for_each(|(y, limit)| limit.sampled = Some(*y));
            found.sampled = Some(sampled);
        }
    }
    if let Some(rule) = settings.allocation {
        let mut allocation = allocation::allocate(&study, rule, &found);
        if let Some(tolerances) = allocation
            .reaches_of(settings.tolerances.iter().map(|t| t.reach))
            .filter(|_| study.settings.samples > 0)
        {
            let loose = deviations.with_reaches(study.settings, &tolerances);
            let sampled = study.sample(&loose, &found, threads, &mut tell, more);
            found.cost += sampled.cost;
            allocation.sampled = Some(sampled).filter(|s| s.samples > 0);
        }
        found.allocation = Some(allocation);
    }
    found.add_contributions(model, settings);
    found.interrupted = interrupted || !more();
    Ok(found)
}

/// Data of a tolerance study.
struct Study<'s> {
    model: &'s Model,
    motions: &'s Motions<'s>,
    /// Number of each motion among those of the model.
    numbers: &'s [usize],
    settings: &'s ToleranceSettings,
    deviations: &'s Deviations,
    nominal: &'s DesignEvaluation,
}

/// A metric in one motion.
struct StudiedMetric {
    /// Index in [`Model::metrics`].
    metric: usize,
    motion: usize,
    /// Index among the metrics of the motion.
    place: usize,
}

/// Toleranced variables, and those of them that the mechanism cannot follow.
fn deviations(
    model: &Model,
    nominal: &DesignEvaluation,
    settings: &ToleranceSettings,
) -> (Deviations, Vec<VariableId>) {
    let cannot = |v: VariableId| {
        let known = |s: &hardpoint::run::Solution| {
            matches!(s.sensitivities.admissibility.get(v.0), Some(Admissibility::CannotFollow { .. }))
        };
        nominal.solutions.iter().any(known)
    };
    let of_all = settings.tolerances.iter().flat_map(|t| t.variables.iter().copied());
    let left_out: Vec<VariableId> = of_all.filter(|v| cannot(*v)).collect();
    (Deviations::new(model, settings, &left_out), left_out)
}

impl Study<'_> {
    /// Metrics of each motion, and those without a value.
    fn studied(&self) -> (Vec<StudiedMetric>, Vec<(usize, usize)>) {
        let mut settings = self.settings.metrics.clone();
        let of_limit = |limit: &hardpoint::model::Limit| match limit.of {
            LimitTarget::Metric(m) => Some(m),
            _ => None,
        };
        settings.extend(self.settings.limits.iter().filter_map(of_limit));
        settings.sort_unstable();
        settings.dedup();
        let (mut studied, mut unknown) = (Vec::new(), Vec::new());
        for metric in settings {
            for (motion, &number) in self.numbers.iter().enumerate() {
                let Some(place) = place_of(self.model, metric, number) else { continue };
                match self.nominal.metrics[motion][place].value {
                    Some(_) => studied.push(StudiedMetric { metric, motion, place }),
                    None => unknown.push((metric, motion)),
                }
            }
        }
        (studied, unknown)
    }

    /// Second derivatives of every metric by the toleranced variables, from differences of exact gradients.
    fn hessians(
        &self,
        studied: &[StudiedMetric],
        cost: &mut StudyCost,
        tell: &mut dyn FnMut(Progress<'_>) -> ControlFlow<()>,
        more: &(dyn Fn() -> bool + Sync),
    ) -> Vec<Option<Vec<Vec<f64>>>> {
        let variables = &self.deviations.variables;
        let n = variables.len();
        let mut columns: Vec<Option<Vec<Vec<f64>>>> = studied.iter().map(|_| Some(Vec::new())).collect();
        for (j, tolerated) in variables.iter().enumerate() {
            let h = STEP * self.model.natural_step(tolerated.variable);
            let sides = [h, -h].map(|by| {
                let is_known = columns.iter().any(Option::is_some);
                if !is_known || tell(Progress::counted(Step::Variable, j, n)).is_break() {
                    return None;
                }
                self.motions.evaluate(&self.model.alone(tolerated.variable, by), cost, more).ok()
            });
            for (one, columns) in studied.iter().zip(&mut columns) {
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

    fn spread(
        &self,
        one: &StudiedMetric,
        hessian: Option<&[Vec<f64>]>,
        cost: &mut StudyCost,
    ) -> MetricSpread {
        let value = &self.nominal.metrics[one.motion][one.place];
        let nominal = value.value.expect("only metrics with a value are taken");
        let d = self.by_tolerated(&value.d);
        let motion = &self.nominal.solutions[one.motion].motion;
        let metric = &self.model.metrics[one.metric];
        let magnitude = Magnitude::of_settled_motion(self.model, motion);
        let round_off = magnitude.metric_round_off(self.model, metric, Some(nominal));
        let settled = |x: f64| if x.abs() <= round_off { 0.0 } else { x };
        let sigma = settled(self.deviations.sigma(&d));
        let settled_moments = |SecondOrder { shift, sigma, bend }: SecondOrder| SecondOrder {
            shift: settled(shift),
            sigma: settled(sigma),
            bend: settled(bend),
        };
        let second = hessian.map(|h| settled_moments(self.deviations.second_order(&d, h)));
        let worst = [-1.0, 1.0].map(|sign| {
            let predicted = worst::extreme(self.deviations, nominal, &d, hessian, sign);
            self.solve_extreme(one, predicted, hessian, sign, round_off, cost)
        });
        let worst = worst::ordered(worst, nominal);
        // Round-off has no contributions.
        let shares_of = |sigma: f64, shares: Vec<f64>| if sigma == 0.0 { vec![0.0; d.len()] } else { shares };
        let shares = shares_of(sigma, self.deviations.shares(&d));
        let second_shares = hessian
            .zip(second)
            .map(|(h, moments)| shares_of(moments.sigma, self.deviations.second_shares(&d, h)));
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

    /// Solves the design at a predicted extreme, and goes on to designs that the exact gradient there predicts to be
    /// worse: derivatives at the nominal design do not show the sign of a cubic metric, for example.
    fn solve_extreme(
        &self,
        one: &StudiedMetric,
        mut extreme: Extreme,
        hessian: Option<&[Vec<f64>]>,
        sign: f64,
        round_off: f64,
        cost: &mut StudyCost,
    ) -> Extreme {
        // Without derivatives, as at a kink, the worst case is not known.
        if !extreme.first.is_finite() {
            return extreme;
        }
        let nominal = self.nominal.metrics[one.motion][one.place].value.unwrap_or_default();
        let mut solve = |deviations: &[f64]| {
            let design = self.deviations.design(self.model.variables.len(), deviations);
            let analysis = &self.motions.analyses()[one.motion];
            let solution = analysis.solve(Run::new().at(&design));
            *cost += StudyCost { designs: 1, motions: 1, steps: solution.motion.len() };
            match &solution.stop {
                Some(stop) => Err(stop.headline(analysis.model())),
                None => {
                    let found = metrics(analysis.model(), &solution).swap_remove(one.place);
                    Ok(found.value.map(|value| (value, self.by_tolerated(&found.d))))
                }
            }
        };
        let mut at = match solve(&extreme.deviations) {
            Ok(found) => found,
            Err(why) => return Extreme { why: Some(why), ..extreme },
        };
        extreme.exact = at.as_ref().map(|(value, _)| *value);
        for _ in 0..MOST_FURTHER {
            let Some((value, g)) = at.filter(|(_, g)| g.iter().all(|x| x.is_finite())) else { break };
            let next = worst::extreme_from(self.deviations, &extreme.deviations, (value, &g), hessian, sign);
            let gain = sign * (next.predicted() - value);
            if !(gain > round_off.max(WORTHWHILE * (value - nominal).abs())) {
                break;
            }
            at = solve(&next.deviations).ok().flatten().filter(|(next, _)| sign * (next - value) > 0.0);
            if let Some((value, _)) = &at {
                (extreme.exact, extreme.deviations) = (Some(*value), next.deviations);
            }
        }
        extreme
    }

    fn limits(&self, metrics: &[MetricSpread]) -> Vec<LimitYield> {
        let mut found = Vec::new();
        for (k, limit) in self.settings.limits.iter().enumerate() {
            for (spread, of) in
                metrics.iter().enumerate().filter(|(_, m)| limit.of == LimitTarget::Metric(m.metric))
            {
                let below = |x: f64| normal_below(x, of.mean(), of.best_sigma());
                let between = limit.most.map_or(1.0, below) - limit.least.map_or(0.0, below);
                let by_moments = (!between.is_nan()).then(|| between.max(0.0));
                found.push(LimitYield { limit: k, spread, by_moments, sampled: None });
            }
        }
        found
    }
}

/// Cumulative normal distribution at x.
fn normal_below(x: f64, mean: f64, sigma: f64) -> f64 {
    if sigma == 0.0 {
        return if x >= mean { 1.0 } else { 0.0 };
    }
    0.5 * libm::erfc((mean - x) / (sigma * std::f64::consts::SQRT_2))
}

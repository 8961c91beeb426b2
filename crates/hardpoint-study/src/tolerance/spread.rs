//! Spread of a metric, from its derivatives.

use std::ops::ControlFlow;

use hardpoint::model::{Limit, LimitTarget};
use hardpoint::run::{Run, metrics, place_of};
use hardpoint_difference::Magnitude;

use super::data::StudyData;
use super::deviations::SecondOrder;
use super::worst::{self, Extreme};
use crate::evaluation::{DesignEvaluation, StudyCost};
use crate::progress::{Progress, Step};

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

/// Effect of tolerances on a metric in one motion, from derivatives. SI.
#[derive(Clone, Debug)]
pub struct MetricSpread {
    /// Index in [`Model::metrics`](hardpoint::model::Model::metrics).
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

/// A metric in one motion.
pub(super) struct StudiedMetric {
    /// Index in [`Model::metrics`](hardpoint::model::Model::metrics).
    pub metric: usize,
    pub motion: usize,
    /// Index among the metrics of the motion.
    pub place: usize,
}

impl StudyData<'_> {
    /// Metrics of each motion, and those without a value.
    pub(super) fn studied(&self) -> (Vec<StudiedMetric>, Vec<(usize, usize)>) {
        let mut settings = self.settings.metrics.clone();
        let of_limit = |limit: &Limit| match limit.of {
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
    pub(super) fn hessians(
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

    pub(super) fn spread(
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
}

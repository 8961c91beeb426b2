//! Contribution of each variable to the variance of a metric, from the model of its spread.

use hardpoint::model::{Model, ToleranceSettings};

use super::{NONLINEAR, ToleranceResult};

/// Fraction of failed designs above which failures are a significant part of the spread.
const FAILING: f64 = 1e-3;
/// Minimum number of sampled designs for contributions: fewer have errors of whole percents.
const ENOUGH: usize = 1000;
/// Groups of sampled designs with about the same deviation of a variable: minimum number of designs in each, and
/// maximum number of groups.
const PER_GROUP: usize = 100;
const MOST_GROUPS: usize = 50;

/// Model of the spread of a metric.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SpreadModel {
    /// First derivatives.
    #[default]
    Linear,
    /// First and second derivatives.
    SecondOrder,
    /// Sampled designs.
    Sampled,
}

/// Contributions to the variance of a metric.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contributions {
    /// Model that they are computed from.
    pub model: SpreadModel,
    /// Contribution of each toleranced variable as a fraction of the variance. For sampled designs these are main
    /// effects: the variance of the mean at given deviations of the variable.
    pub shares: Vec<f64>,
    /// Fraction due to interactions of several variables; `None` if it is distributed among them.
    pub together: Option<f64>,
}

impl ToleranceResult {
    /// True if linear statistics of a metric are inaccurate, as indicated by second derivatives or by the sampled
    /// designs.
    pub fn is_nonlinear(&self, metric: usize) -> bool {
        self.metrics[metric].is_nonlinear() || self.differs_from_samples(metric) || self.fails_often()
    }

    /// True if the standard deviation of the sampled designs differs significantly from the linear one.
    pub fn differs_from_samples(&self, metric: usize) -> bool {
        let Some(samples) = self.sampled.as_ref().map(|s| &s.metrics[metric]) else { return false };
        let (linear, [sigma, _]) = (self.metrics[metric].sigma, samples.sigma);
        samples.differs_from(linear) && (linear - sigma).abs() > NONLINEAR * sigma
    }

    /// True if a significant part of the designs does not reach the end.
    pub fn fails_often(&self) -> bool {
        self.sampled.as_ref().is_some_and(|s| s.failed as f64 > FAILING * s.samples as f64)
    }

    pub(super) fn add_contributions(&mut self, model: &Model, settings: &ToleranceSettings) {
        let deviations: Option<Vec<Vec<f64>>> = self.sampled.as_ref().map(|sampled| {
            let deviation = self.deviations(model, settings);
            (0..sampled.samples).map(deviation).collect()
        });
        let correlated = !settings.correlations.is_empty();
        self.contributions = (0..self.metrics.len())
            .map(|k| {
                let of = &self.metrics[k];
                let samples = self.sampled.as_ref().map(|s| &s.metrics[k]).filter(|d| d.known >= ENOUGH);
                match (self.is_nonlinear(k), samples, &deviations, &of.second_shares) {
                    (true, Some(samples), Some(deviations), _) => {
                        let effect = |v: usize| main_effect(&samples.values, |n| deviations[n][v]);
                        let shares: Vec<f64> = (0..of.d.len()).map(effect).collect();
                        let rest = (1.0 - shares.iter().sum::<f64>()).max(0.0);
                        let together = (!correlated).then_some(rest);
                        Contributions { model: SpreadModel::Sampled, shares, together }
                    }
                    (true, _, _, Some(shares)) => {
                        let shares = shares.clone();
                        Contributions { model: SpreadModel::SecondOrder, shares, together: None }
                    }
                    _ => Contributions { shares: of.shares.clone(), ..Contributions::default() },
                }
            })
            .collect();
    }
}

/// Variance of the mean at given deviations of a variable, as a fraction of the total: from groups of about equal
/// deviations, corrected for the scatter of their means.
///
/// ```text
/// V_i = sum n_b (m_b - m)^2 / n - (B - 1) s^2 / n,    S_i = V_i / V        b = 1..B,  s^2 the mean variance within groups
/// ```
fn main_effect(values: &[f64], deviation: impl Fn(usize) -> f64) -> f64 {
    let mut known: Vec<(f64, f64)> = values
        .iter()
        .enumerate()
        .filter(|(_, x)| x.is_finite())
        .map(|(number, x)| (deviation(number), *x))
        .collect();
    known.sort_by(|a, b| a.0.total_cmp(&b.0));
    let n = known.len() as f64;
    let mean_of = |some: &[(f64, f64)]| some.iter().map(|(_, x)| x).sum::<f64>() / some.len() as f64;
    let squares = |some: &[(f64, f64)], m: f64| some.iter().map(|(_, x)| (x - m).powi(2)).sum::<f64>();
    let mean = mean_of(&known);
    let all = squares(&known, mean);
    let groups = (known.len() / PER_GROUP).clamp(2, MOST_GROUPS);
    let each = known.len().div_ceil(groups);
    let (mut between, mut within, mut count) = (0.0, 0.0, 0.0);
    for group in known.chunks(each) {
        let m = mean_of(group);
        between += group.len() as f64 * (m - mean).powi(2);
        within += squares(group, m);
        count += 1.0;
    }
    let by_chance = within / (n - count) * (count - 1.0);
    if all > 0.0 { ((between - by_chance) / all).clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::design_stream;

    /// Statistical error with 20,000 designs, as a fraction.
    const CHANCE: f64 = 0.02;

    #[test]
    fn main_effects_of_a_sum_of_squares_and_products_are_those_of_theory() {
        // y = 2 a + b^2 + c d of independent uniform deviations between -1 and 1: variances 4/3, 4/45 and 1/9. The last
        // is an interaction of c and d.
        let sample = |number: usize| {
            let mut stream = design_stream(5, number as u64);
            let mut d = [0.0; 4];
            d.iter_mut().for_each(|x| {
                let mut one = [0.0];
                crate::random::draw(hardpoint::model::Scatter::Uniform, 1.0, &mut stream, &mut one);
                *x = one[0];
            });
            d
        };
        let all: Vec<[f64; 4]> = (0..20_000).map(sample).collect();
        let values: Vec<f64> = all.iter().map(|[a, b, c, d]| 2.0 * a + b * b + c * d).collect();
        let total = 4.0 / 3.0 + 4.0 / 45.0 + 1.0 / 9.0;
        for (v, expected) in [4.0 / 3.0 / total, 4.0 / 45.0 / total, 0.0, 0.0].into_iter().enumerate() {
            let found = main_effect(&values, |n| all[n][v]);
            assert!((found - expected).abs() < CHANCE, "{v}: {found} {expected}");
        }
    }
}

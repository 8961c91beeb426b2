//! Yields: probabilities of keeping limits.

use hardpoint::model::LimitTarget;

use super::data::StudyData;
use super::spread::MetricSpread;

/// Probability of keeping a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitYield {
    /// Index in [`ToleranceSettings::limits`](hardpoint::model::ToleranceSettings::limits).
    pub limit: usize,
    /// Index of its metric and motion in [`ToleranceResult::metrics`](super::ToleranceResult::metrics).
    pub spread: usize,
    /// Yield of a normal distribution with the moments from derivatives, 0 to 1; `None` if there are no derivatives.
    pub by_moments: Option<f64>,
    /// Yield of the sampled designs; designs that do not reach the end violate the limit.
    pub sampled: Option<Yield>,
}

/// Yield: designs that satisfy a condition, of all.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Yield {
    /// Number of designs that satisfy it.
    pub kept: usize,
    /// Number of all designs.
    pub of: usize,
}

impl Yield {
    /// Yield as a fraction.
    pub fn part(self) -> f64 {
        self.kept as f64 / self.of as f64
    }

    /// Standard error, computed with one more success and one more failure, since 0 of n does not mean never.
    pub fn error(self) -> f64 {
        let n = self.of as f64 + 2.0;
        let part = (self.kept as f64 + 1.0) / n;
        (part * (1.0 - part) / n).sqrt()
    }
}

impl StudyData<'_> {
    /// Yields of all limits of studied metrics by their moments.
    pub(super) fn limits(&self, metrics: &[MetricSpread]) -> Vec<LimitYield> {
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

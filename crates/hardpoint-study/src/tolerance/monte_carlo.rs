//! Monte Carlo: designs sampled from the tolerances and solved exactly.

use std::num::NonZero;
use std::ops::ControlFlow;

use crate::evaluation::StudyCost;
use crate::progress::{Progress, Step};
use crate::samples::{SampleBlock, SampleRun, failure_reason};
use crate::sweep::quantile;
use crate::whatif::unwrapped_value;
use hardpoint::measure::Output;
use hardpoint::model::Dimension;
use hardpoint::run::Solution;
use hardpoint::run::{metric_numbers, place_of};

use super::curves::CurveBands;
use super::data::StudyData;
use super::deviations::Deviations;
use super::spread::MetricSpread;
use super::yields::{LimitYield, Yield};

/// Results of the Monte Carlo designs. SI.
#[derive(Clone, Debug, Default)]
pub struct MonteCarlo {
    /// Number of solved designs.
    pub samples: usize,
    /// Results of the metrics, in the order of [`ToleranceResult::metrics`](super::ToleranceResult::metrics).
    pub metrics: Vec<SampledMetric>,
    /// Results of the curves, in the order of [`ToleranceResult::curves`](super::ToleranceResult::curves).
    pub curves: Vec<SampledCurve>,
    /// Yields of the limits, in the order of [`ToleranceResult::limits`](super::ToleranceResult::limits).
    pub limits: Vec<Yield>,
    /// Yield of all limits together.
    pub all: Option<Yield>,
    /// Designs that do not reach the end of some motion, grouped by cause.
    pub failures: Vec<FailureGroup>,
    /// Number of failed designs.
    pub failed: usize,
    /// Cost of the designs.
    pub cost: StudyCost,
}

/// Statistics of a metric over the sampled designs that have it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SampledMetric {
    /// Values of each design, NaN if it has none.
    pub values: Vec<f64>,
    /// Number of designs with a value.
    pub known: usize,
    /// Mean, and its standard error.
    pub mean: [f64; 2],
    /// Standard deviation, and its standard error; 0 if it is round-off.
    pub sigma: [f64; 2],
    /// Skewness: 0 for a normal distribution.
    pub skewness: f64,
    /// Kurtosis: 3 for a normal distribution.
    pub kurtosis: f64,
    /// Minimum, 0.135 % quantile, median, 99.865 % quantile, maximum.
    pub quantiles: [f64; 5],
}

/// Statistics of a curve over the sampled designs that reach the end of its motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SampledCurve {
    /// Mean at each output time.
    pub mean: Vec<f64>,
    /// Standard deviation at each output time.
    pub sigma: Vec<f64>,
    /// Minimum at each output time.
    pub least: Vec<f64>,
    /// Maximum at each output time.
    pub greatest: Vec<f64>,
}

/// Designs that failed for the same reason.
#[derive(Clone, Debug, PartialEq)]
pub struct FailureGroup {
    /// Index of the motion among those studied.
    pub motion: usize,
    /// Description of the first failure.
    pub why: String,
    /// Number of the first failed design.
    pub first: usize,
    /// Number of designs.
    pub count: usize,
}

/// Metrics, curves and limits of the sampled designs.
#[derive(Clone, Copy)]
pub(super) struct SampledQuantities<'r> {
    pub metrics: &'r [MetricSpread],
    pub curves: &'r [CurveBands],
    pub limits: &'r [LimitYield],
}

/// Running mean and sum of squared deviations.
#[derive(Clone, Copy, Debug)]
struct Growing {
    n: f64,
    mean: f64,
    squares: f64,
    least: f64,
    greatest: f64,
}

impl Growing {
    const NONE: Self =
        Self { n: 0.0, mean: 0.0, squares: 0.0, least: f64::INFINITY, greatest: f64::NEG_INFINITY };

    fn add(&mut self, x: f64) {
        self.join(&Self { n: 1.0, mean: x, squares: 0.0, least: x, greatest: x });
    }

    fn join(&mut self, other: &Self) {
        let n = self.n + other.n;
        if other.n == 0.0 {
            return;
        }
        let apart = other.mean - self.mean;
        self.mean += apart * other.n / n;
        self.squares += other.squares + apart * apart * self.n * other.n / n;
        self.least = self.least.min(other.least);
        self.greatest = self.greatest.max(other.greatest);
        self.n = n;
    }
}

/// Results of a block of sampled designs.
#[derive(Default)]
struct Block {
    /// Values of each metric in each design.
    metrics: Vec<Vec<f64>>,
    /// Statistics of each curve at each output time.
    curves: Vec<Vec<Growing>>,
    /// Design, motion, reason and description of each failure.
    failures: Vec<(usize, usize, String, String)>,
    cost: StudyCost,
}

impl StudyData<'_> {
    /// Samples and solves the requested number of designs, or fewer if the caller ends the study.
    pub(super) fn sample(
        &self,
        deviations: &Deviations,
        of: SampledQuantities<'_>,
        threads: NonZero<usize>,
        tell: &mut (dyn FnMut(Progress<'_>) -> ControlFlow<()> + Send),
        more: &(dyn Fn() -> bool + Sync),
    ) -> MonteCarlo {
        let (seed, settings) = (self.settings.seed, self.settings.samples);
        let design =
            |number: usize| deviations.design(self.model.variables.len(), &deviations.sample(seed, number));
        let places: Vec<usize> = of.metrics.iter().map(|m| self.place(m)).collect();
        let see = |block: &mut Block, number: usize, motion: usize, solution: &Solution| {
            block.metrics.resize(of.metrics.len(), Vec::new());
            block.curves.resize(of.curves.len(), Vec::new());
            block.cost.motions += 1;
            block.cost.steps += solution.motion.len();
            let stop = solution.stop.as_ref();
            if let Some(stop) = stop {
                let model = self.motions.model(motion);
                block.failures.push((number, motion, failure_reason(stop, model), stop.headline(model)));
            }
            let numbers: Vec<Option<f64>> = match stop {
                None => metric_numbers(self.motions.model(motion), solution).collect(),
                Some(_) => Vec::new(),
            };
            for (k, _) in of.metrics.iter().enumerate().filter(|(_, spread)| spread.motion == motion) {
                let number = numbers.get(places[k]).copied().flatten();
                block.metrics[k].push(number.unwrap_or(f64::NAN));
            }
            if stop.is_none() {
                let of_motion = of.curves.iter().zip(&mut block.curves).filter(|(c, _)| c.motion == motion);
                of_motion.for_each(|(curve, to)| self.add_curve(curve, solution, to));
            }
        };
        let mut all = Block { metrics: vec![Vec::new(); places.len()], ..Block::default() };
        all.curves = of.curves.iter().map(|c| vec![Growing::NONE; c.bands.len()]).collect();
        let mut samples = 0;
        let mut done = |SampleBlock { numbers, found: block }: SampleBlock<Block>| {
            samples = numbers.end;
            all.cost += StudyCost { designs: numbers.len(), ..block.cost };
            all.failures.extend(block.failures);
            all.metrics.iter_mut().zip(block.metrics).for_each(|(all, some)| all.extend(some));
            for (all, some) in all.curves.iter_mut().zip(block.curves) {
                all.iter_mut().zip(some).for_each(|(all, some)| all.join(&some));
            }
            tell(Progress::counted(Step::Designs, samples, settings))
        };
        let run = SampleRun { numbers: 0..settings, design: &design, threads, more };
        self.motions.sample(&run, &see, &mut done);
        self.results(of, samples, all)
    }

    fn place(&self, of: &MetricSpread) -> usize {
        place_of(self.model, of.metric, self.numbers[of.motion])
            .expect("a metric that is taken of the motion")
    }

    fn add_curve(&self, curve: &CurveBands, solution: &Solution, to: &mut Vec<Growing>) {
        let (nominal, c) = (&self.nominal.solutions[curve.motion], curve.column);
        to.resize(curve.bands.len(), Growing::NONE);
        let Output { dimension, .. } = &nominal.measured.outputs[c];
        for (k, to) in to.iter_mut().enumerate().take(solution.measured.len()) {
            let x = match *dimension {
                Dimension::ANGLE => unwrapped_value(nominal, solution, k, c),
                _ => solution.measured.value(k, c)[0],
            };
            if x.is_finite() {
                to.add(x);
            }
        }
    }

    fn results(&self, of: SampledQuantities<'_>, samples: usize, all: Block) -> MonteCarlo {
        let metrics = all.metrics.into_iter().zip(of.metrics);
        let metrics: Vec<SampledMetric> =
            metrics.map(|(values, spread)| SampledMetric::of(values, spread.round_off)).collect();
        let curve = |points: Vec<Growing>| SampledCurve {
            mean: points.iter().map(|p| p.mean).collect(),
            sigma: points.iter().map(|p| (p.squares / (p.n - 1.0)).sqrt()).collect(),
            least: points.iter().map(|p| p.least).collect(),
            greatest: points.iter().map(|p| p.greatest).collect(),
        };
        // NaN satisfies no limit.
        let keeps = |limit: usize, x: f64| {
            let limit = &self.settings.limits[limit];
            limit.least.is_none_or(|least| x >= least)
                && limit.most.is_none_or(|most| x <= most)
                && !x.is_nan()
        };
        let limits = of.limits.iter().map(|limit| {
            let kept = metrics[limit.spread].values.iter().filter(|x| keeps(limit.limit, **x)).count();
            Yield { kept, of: samples }
        });
        let limits = limits.collect();
        let mut failed = vec![false; samples];
        let mut failures: Vec<(String, FailureGroup)> = Vec::new();
        for (number, motion, reason, why) in all.failures {
            failed[number] = true;
            match failures.iter_mut().find(|(r, f)| *r == reason && f.motion == motion) {
                Some((_, failure)) => failure.count += 1,
                None => failures.push((reason, FailureGroup { motion, why, first: number, count: 1 })),
            }
        }
        let whole =
            |k: &usize| !failed[*k] && of.limits.iter().all(|l| keeps(l.limit, metrics[l.spread].values[*k]));
        let all_kept =
            (!of.limits.is_empty()).then(|| Yield { kept: (0..samples).filter(whole).count(), of: samples });
        MonteCarlo {
            samples,
            curves: all.curves.into_iter().map(curve).collect(),
            limits,
            all: all_kept,
            failed: failed.iter().filter(|f| **f).count(),
            failures: failures.into_iter().map(|(_, f)| f).collect(),
            cost: all.cost,
            metrics,
        }
    }
}

impl SampledMetric {
    /// Statistics of values whose standard deviation is zero up to `round_off`.
    fn of(values: Vec<f64>, round_off: f64) -> Self {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
        if sorted.is_empty() {
            let none = [f64::NAN; 2];
            return Self { values, mean: none, sigma: none, quantiles: [f64::NAN; 5], ..Self::default() };
        }
        let n = sorted.len() as f64;
        let mean = sorted.iter().sum::<f64>() / n;
        let central = |p: i32| sorted.iter().map(|x| (x - mean).powi(p)).sum::<f64>() / n;
        let [second, third, fourth] = [2, 3, 4].map(central);
        let spread = second.sqrt() > round_off;
        let kurtosis = if spread { fourth / (second * second) } else { 3.0 };
        let skewness = if spread { third / second.powf(1.5) } else { 0.0 };
        let sigma = if spread { (second * n / (n - 1.0)).sqrt() } else { 0.0 };
        sorted.sort_by(f64::total_cmp);
        Self {
            known: sorted.len(),
            mean: [mean, sigma / n.sqrt()],
            sigma: [sigma, sigma / (2.0 * freedom(sorted.len(), kurtosis)).sqrt()],
            skewness,
            kurtosis,
            quantiles: [0.0, BEYOND, 0.5, 1.0 - BEYOND, 1.0].map(|part| quantile(&sorted, part)),
            values,
        }
    }
}

impl SampledMetric {
    /// Minimum number of designs whose standard deviation is compared with another: with fewer, chance changes it by
    /// half.
    pub const FEWEST: usize = 20;

    /// True if the standard deviation differs from that of a model by more than [`ERRORS`] standard errors, under the
    /// hypothesis that the model is right. The squares follow a chi-square distribution, whose cube root is about
    /// normal (Wilson and Hilferty 1931).
    ///
    /// ```text
    /// (s^2 / sigma^2)^1/3 ~ N(1 - 2 / 9 f, 2 / 9 f)        f: degrees of freedom
    /// ```
    pub fn differs_from(&self, sigma: f64) -> bool {
        let variance = 2.0 / (9.0 * freedom(self.known, self.kurtosis));
        let root = (self.sigma[0] / sigma).powi(2).cbrt();
        self.known >= Self::FEWEST && (root - (1.0 - variance)).abs() > ERRORS * variance.sqrt()
    }
}

/// Degrees of freedom of a variance: n - 1 for normal values, otherwise such that `var(s^2) = 2 s^4 / f`. Small samples
/// have a small kurtosis, whatever their distribution.
fn freedom(count: usize, kurtosis: f64) -> f64 {
    const NORMAL: f64 = 3.0;
    let kurtosis = if count < SampledMetric::FEWEST { kurtosis.max(NORMAL) } else { kurtosis };
    2.0 * (count as f64 - 1.0) / (kurtosis - 1.0)
}

/// Number of standard errors by which sampled designs disagree with a model.
const ERRORS: f64 = 3.0;
/// Fraction of a normal distribution beyond three standard deviations on one side.
const BEYOND: f64 = 0.001_349_898_031_630_094_6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sigma_differs_beyond_the_quantiles_of_chi_square() {
        // 0.135 % and 99.865 % quantiles of chi-square with 19 and 99 degrees of freedom (scipy 1.17, `chi2.ppf`).
        for (count, least, most) in [(20, 5.6412, 42.8712), (100, 62.0565, 146.5811)] {
            let freedom = f64::from(count - 1);
            for (square, differs) in
                [(least * 0.97, true), (least * 1.03, false), (most * 0.99, false), (most * 1.01, true)]
            {
                let sampled = SampledMetric {
                    known: count as usize,
                    sigma: [(square / freedom).sqrt(), 0.0],
                    kurtosis: 3.0,
                    ..SampledMetric::default()
                };
                assert_eq!(sampled.differs_from(1.0), differs, "{count} {square}");
            }
        }
    }

    #[test]
    fn a_few_designs_say_nothing_of_sigma() {
        for count in 2..SampledMetric::FEWEST {
            let values = (0..count).map(|k| 1e-3 * k as f64).collect();
            let sampled = SampledMetric::of(values, 0.0);
            assert!(!sampled.differs_from(1.0) && sampled.sigma[1] > 0.0, "{count}");
        }
        // sigma / sqrt(2 (n - 1)), as for normal values
        let [sigma, error] = SampledMetric::of(vec![0.0, 1.0], 0.0).sigma;
        assert!((error - sigma / 2_f64.sqrt()).abs() < 1e-15);
    }
}

//! Result of a tolerance study.

use hardpoint::model::{Model, ToleranceSettings, VariableId};

use super::allocation::Allocation;
use super::contributions::Contributions;
use super::curves::CurveBands;
use super::deviations::{Deviations, TolerancedVariable};
use super::monte_carlo::MonteCarlo;
use super::pins::SideChange;
use super::spread::{MetricSpread, NONLINEAR};
use super::yields::LimitYield;
use crate::evaluation::{EvaluationError, StudyCost};
use crate::request::RequestError;

/// Fraction of failed designs above which failures are a significant part of the spread.
const FAILING: f64 = 1e-3;

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

/// Reason why a tolerance study has no result.
#[derive(Clone, Debug)]
pub enum Error {
    /// The nominal design does not reach the end of some motion, or the caller ended the study there.
    Nominal(EvaluationError),
    /// The mechanism can follow none of the variables with a tolerance.
    Request(RequestError),
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

    /// Adds the contributions of the variables to the variance of every metric.
    pub(super) fn add_contributions(&mut self, model: &Model, settings: &ToleranceSettings) {
        let deviations: Option<Vec<Vec<f64>>> = self.sampled.as_ref().map(|sampled| {
            let deviation = self.deviations(model, settings);
            (0..sampled.samples).map(deviation).collect()
        });
        let is_correlated = !settings.correlations.is_empty();
        let contributions = |k: usize| {
            let samples = self.sampled.as_ref().map(|s| &s.metrics[k]);
            let samples = samples.zip(deviations.as_deref());
            Contributions::of(&self.metrics[k], self.is_nonlinear(k), is_correlated, samples)
        };
        self.contributions = (0..self.metrics.len()).map(contributions).collect();
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

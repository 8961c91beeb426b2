//! The results that metrics or single outputs depend on.
//!
//! A metric is taken at few times, and depends on few measures. At an equilibrium the kernel solves the sensitivities
//! of each output time by themselves, and those of measures along single forces and drivers one direction at a time, so
//! that a run for metrics leaves out the others.

use crate::measure::is_formula;
use crate::model::{CurvePart, Metric, Model, OutputSource};

use super::metric::{derivative_times, solution_of};
use super::solution::Solution;

/// Use of a metric by the caller of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MetricUse {
    /// Not used.
    Unused,
    /// The value and the derivative, and the misfits of the metric.
    Derivative,
    /// These, and, of a maximum, minimum or range, all candidates ([`peaks`](super::peaks)).
    Candidates,
}

/// Results that metrics or single outputs of a model depend on, at the times of a solution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct NeededResults {
    /// Per output time: true if sensitivities count.
    at: Vec<bool>,
    /// The same for measures along single forces and drivers.
    curved_at: Vec<bool>,
    /// Per measure: true if a metric that counts is taken of it or over it, or if it is an output that counts.
    measures: Vec<bool>,
}

impl NeededResults {
    /// Needs of metrics with these uses that depend on the output times alone; `None` if one depends on values.
    pub fn of_times(model: &Model, uses: &[MetricUse]) -> Option<Self> {
        let is_of_ends = |(metric, _): (&Metric, _)| metric.take.part() == CurvePart::Ends;
        let last = model.times.len().saturating_sub(1);
        let needs = || Self::of(model, uses, model.times.len(), |_, _| Some(vec![0, last]));
        used(model, uses).all(is_of_ends).then(needs)
    }

    /// Needs of metrics with these uses at the times of a solution, whose values are known.
    pub fn of_solution(model: &Model, uses: &[MetricUse], solution: &Solution) -> Self {
        let solution = solution_of(solution);
        Self::of(model, uses, solution.motion.len(), |metric, metric_use| {
            let of_all = !metric.take.extrema().is_empty() && metric_use == MetricUse::Candidates;
            if of_all { None } else { derivative_times(solution, metric) }
        })
    }

    /// Needs of the values of metrics with these uses, at all output times.
    pub fn of_values(model: &Model, uses: &[MetricUse]) -> Self {
        Self::of(model, uses, model.times.len(), |_, _| None)
    }

    /// Needs of some outputs at all output times.
    pub fn of_outputs(model: &Model, outputs: &[OutputSource]) -> Self {
        let mut needs = Self::none(model, model.times.len());
        let mut is_curved = false;
        outputs.iter().for_each(|output| is_curved |= needs.add(model, *output));
        needs.at.fill(true);
        needs.curved_at.fill(is_curved);
        needs
    }

    fn none(model: &Model, steps: usize) -> Self {
        Self {
            at: vec![false; steps],
            curved_at: vec![false; steps],
            measures: vec![false; model.measures.len()],
        }
    }

    /// Adds an output; returns true if it depends on single forces or drivers.
    fn add(&mut self, model: &Model, output: OutputSource) -> bool {
        let OutputSource::Measure(m) = output else { return false };
        self.measures[m] = true;
        if is_formula(model, m) {
            // A formula may use any measure.
            self.measures.fill(true);
            return true;
        }
        model.depends_on_step(m)
    }

    /// Needs at this number of times; `times` returns those of a metric, or `None` if all count.
    fn of(
        model: &Model,
        uses: &[MetricUse],
        steps: usize,
        times: impl Fn(&Metric, MetricUse) -> Option<Vec<usize>>,
    ) -> Self {
        let mut needs = Self::none(model, steps);
        for (metric, metric_use) in used(model, uses) {
            let mut is_curved = false;
            for output in [Some(metric.of), metric.over].into_iter().flatten() {
                is_curved |= needs.add(model, output);
            }
            let times = times(metric, metric_use).unwrap_or_else(|| (0..steps).collect());
            for k in times.into_iter().filter(|k| *k < steps) {
                needs.at[k] = true;
                needs.curved_at[k] |= is_curved;
            }
        }
        needs
    }

    /// True if no sensitivities count.
    pub fn is_of_values(&self) -> bool {
        !self.at.contains(&true)
    }

    /// True if sensitivities count at output time k.
    pub fn at(&self, k: usize) -> bool {
        self.at[k]
    }

    /// True if those of measures along single forces and drivers count at output time k.
    pub fn curved_at(&self, k: usize) -> bool {
        self.curved_at[k]
    }

    /// True if this measure counts.
    pub fn measure(&self, m: usize) -> bool {
        self.measures[m]
    }
}

/// Metrics of a model that count, with their uses.
fn used<'m>(model: &'m Model, uses: &'m [MetricUse]) -> impl Iterator<Item = (&'m Metric, MetricUse)> {
    let uses = uses.iter().copied().chain(std::iter::repeat(MetricUse::Derivative));
    model.metrics.iter().zip(uses).filter(|(_, metric_use)| *metric_use != MetricUse::Unused)
}

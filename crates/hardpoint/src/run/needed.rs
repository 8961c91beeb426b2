//! The results that metrics or single outputs depend on.
//!
//! A metric is taken at few times, and depends on few measures. At an equilibrium the kernel solves the sensitivities
//! of each output time by themselves, and those of measures along single forces and drivers one direction at a time, so
//! that a run for its metrics leaves out the others.

use crate::measure::is_formula;
use crate::model::{Metric, Model, OutputSource, Reduction};

use super::metric::{derivative_times, solution_of};
use super::solution::Solution;

/// Results that metrics or single outputs of a model depend on, at the times of a solution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct NeededResults {
    /// Per output time: true if sensitivities count.
    at: Vec<bool>,
    /// The same for measures along single forces and drivers.
    curved_at: Vec<bool>,
    /// Per measure: true if a metric is taken of it or over it, or if it is an output that counts.
    measures: Vec<bool>,
    /// True if the values of all measures count, and only the derivatives of some.
    all_values: bool,
}

impl NeededResults {
    /// Needs of metrics that depend on the output times alone; `None` if a metric depends on values.
    pub fn of_times(model: &Model) -> Option<Self> {
        let all_change = model.metrics.iter().all(|metric| matches!(metric.take, Reduction::Change));
        let last = model.times.len().saturating_sub(1);
        all_change.then(|| Self::of(model, model.times.len(), |_| Some(vec![0, last])))
    }

    /// Needs of all metrics at the times of a solution, whose values are known.
    pub fn of_solution(model: &Model, solution: &Solution) -> Self {
        let solution = solution_of(solution);
        Self::of(model, solution.motion.len(), |metric| derivative_times(solution, metric))
    }

    /// Needs of some outputs at all output times.
    pub fn of_outputs(model: &Model, outputs: &[OutputSource]) -> Self {
        let mut needs = Self { all_values: false, ..Self::none(model, model.times.len()) };
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
            all_values: true,
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
    fn of(model: &Model, steps: usize, times: impl Fn(&Metric) -> Option<Vec<usize>>) -> Self {
        let mut needs = Self::none(model, steps);
        for metric in &model.metrics {
            let mut is_curved = false;
            for output in [Some(metric.of), metric.over].into_iter().flatten() {
                is_curved |= needs.add(model, output);
            }
            let times = times(metric).unwrap_or_else(|| (0..steps).collect());
            for k in times.into_iter().filter(|k| *k < steps) {
                needs.at[k] = true;
                needs.curved_at[k] |= is_curved;
            }
        }
        needs
    }

    /// True if sensitivities count at output time k.
    pub fn at(&self, k: usize) -> bool {
        self.at[k]
    }

    /// True if those of measures along single forces and drivers count at output time k.
    pub fn curved_at(&self, k: usize) -> bool {
        self.curved_at[k]
    }

    /// True if the derivatives of this measure count.
    pub fn measure(&self, m: usize) -> bool {
        self.measures[m]
    }

    /// True if the value of this measure counts.
    pub fn value(&self, m: usize) -> bool {
        self.all_values || self.measures[m]
    }
}

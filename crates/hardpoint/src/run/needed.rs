//! The derivatives that metrics depend on.
//!
//! A metric is taken at few times, and depends on few measures. At an equilibrium the kernel solves the sensitivities of
//! each output time by themselves, and those of measures along single forces and drivers one direction at a time, so
//! that a run for its metrics leaves out the others.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::model::{MeasureKind, Metric, Model, OutputSource, Reduction};

use super::analysis::Analysis;
use super::metric::{derivative_times, solution_of};
use super::request::Progress;
use super::solution::Solution;
use super::walk::{PreparedDesign, Scope};

/// Derivatives that the metrics of a model depend on, at the times of a solution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct NeededDerivatives {
    /// Per output time: true if sensitivities count.
    at: Vec<bool>,
    /// The same for measures along single forces and drivers.
    curved_at: Vec<bool>,
    /// Per measure: true if a metric is taken of it or over it.
    measures: Vec<bool>,
}

impl NeededDerivatives {
    /// Needs of metrics that depend on the output times alone; `None` if a metric depends on values.
    fn of_times(model: &Model) -> Option<Self> {
        let all_change = model.metrics.iter().all(|metric| matches!(metric.take, Reduction::Change));
        let last = model.times.len().saturating_sub(1);
        all_change.then(|| Self::of(model, model.times.len(), |_| Some(vec![0, last])))
    }

    /// Needs of all metrics at the times of a solution, whose values are known.
    fn of_solution(model: &Model, solution: &Solution) -> Self {
        let solution = solution_of(solution);
        Self::of(model, solution.motion.len(), |metric| derivative_times(solution, metric))
    }

    /// Needs at this number of times; `times` returns those of a metric, or `None` if all count.
    fn of(model: &Model, steps: usize, times: impl Fn(&Metric) -> Option<Vec<usize>>) -> Self {
        let mut needs = Self {
            at: vec![false; steps],
            curved_at: vec![false; steps],
            measures: vec![false; model.measures.len()],
        };
        for metric in &model.metrics {
            let mut is_curved = false;
            for output in [Some(metric.of), metric.over].into_iter().flatten() {
                let OutputSource::Measure(m) = output else { continue };
                is_curved |= model.depends_on_step(m);
                needs.measures[m] = true;
                if let MeasureKind::Combination { .. } = model.measures[m].kind {
                    // A formula may use any measure.
                    needs.measures.fill(true);
                    is_curved = true;
                }
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

    /// True if a metric is taken of this measure or over it.
    pub fn measure(&self, m: usize) -> bool {
        self.measures[m]
    }
}

impl Analysis<'_> {
    /// Solves a prepared design for its metrics: values at all output times, and the derivatives that the metrics depend
    /// on.
    pub(super) fn solve_for_metrics(
        &self,
        design: PreparedDesign,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
    ) {
        let model = self.model();
        if let Some(needs) = NeededDerivatives::of_times(model) {
            let design = PreparedDesign { needs: Some(Arc::new(needs)), ..design };
            self.walk(&design, model.times.len(), progress, solution, &mut |_, _| ());
            return;
        }
        let values = self.prepare(&design.values, Scope { sensitivities: false, ..design.scope });
        self.walk(&values, model.times.len(), progress, solution, &mut |_, _| ());
        self.solve_between(&values, progress, solution);
        if solution.stop.is_some() {
            return;
        }
        // All output times have been reported as solved before.
        let end = Progress { done: model.times.len() - 1, total: model.times.len() };
        let mut go_on = |_: Progress| progress(end);
        let needs = Some(Arc::new(NeededDerivatives::of_solution(model, solution)));
        match &solution.between {
            None => {
                let design = PreparedDesign { needs, ..design };
                self.walk(&design, model.times.len(), &mut go_on, solution, &mut |_, _| ());
            }
            Some(between) => {
                let finer = self.at_times(between.motion.times.clone());
                let design = PreparedDesign { needs, ..finer.prepare(&design.values, design.scope) };
                let mut found = Solution::default();
                finer.walk(&design, between.motion.len(), &mut go_on, &mut found, &mut |_, _| ());
                solution.stop = found.stop.clone();
                solution.between = Some(Arc::new(found));
            }
        }
    }
}

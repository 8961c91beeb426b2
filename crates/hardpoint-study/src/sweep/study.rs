//! Sweep over the designs of a plan.

use std::num::NonZero;
use std::ops::ControlFlow;

use hardpoint::model::{Model, OutputSource, SweepSettings};
use hardpoint::run::{Run, Solution, metric_number, place_of};
use hardpoint_difference::Magnitude;

use super::plan::Plan;
use super::request::Request;
use super::result::{Block, Curves, Failure};
use crate::evaluation::{Motions, StudyCost};
use crate::request::RequestError;
use crate::samples::{SampleBlock, SampleRun, failure_reason};

/// Sweep that is ready to start from any block.
#[derive(Clone, Debug)]
pub struct Sweep<'a> {
    motions: &'a Motions<'a>,
    settings: &'a SweepSettings,
    plan: Plan<'a>,
    metrics: Vec<Metric>,
}

/// A metric in one of the motions: a column of the results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Metric {
    /// Index of the metric in [`Model::metrics`] of the whole model.
    pub metric: usize,
    /// Index of the motion among those studied.
    pub motion: usize,
    /// Index among the metrics of that motion.
    place: usize,
}

impl<'a> Sweep<'a> {
    /// Prepares the sweep over the designs of a model in some of its motions, given by `numbers`.
    ///
    /// # Errors
    /// A [`RequestError`] if the designs cannot be chosen.
    pub fn new(
        model: &Model,
        motions: &'a Motions<'a>,
        numbers: &[usize],
        request: &'a Request,
    ) -> Result<Self, RequestError> {
        let settings = &request.settings;
        let plan = Plan::new(settings, model)?;
        let of_motion = |(metric, (motion, number)): (usize, (usize, &usize))| {
            Some(Metric { metric, motion, place: place_of(model, metric, *number)? })
        };
        let pairs = settings.metrics.iter().flat_map(|m| numbers.iter().enumerate().map(|n| (*m, n)));
        Ok(Self { motions, settings, plan, metrics: pairs.filter_map(of_motion).collect() })
    }

    /// Designs of the sweep.
    pub fn plan(&self) -> &Plan<'a> {
        &self.plan
    }

    /// Columns of the results.
    pub fn metrics(&self) -> &[Metric] {
        &self.metrics
    }

    /// Results of the nominal design, as the only one of its block, and the largest spread of each metric that is still
    /// round-off.
    pub fn nominal(&self) -> (Block, Vec<f64>) {
        let mut block = Block { numbers: 0..1, ..Block::default() };
        let mut round_off = vec![0.0; self.metrics.len()];
        for (motion, analysis) in self.motions.analyses().iter().enumerate() {
            let solution = analysis.solve(Run::new().without_sensitivities());
            self.see(&mut block, 0, motion, &solution);
            let model = self.motions.model(motion);
            let magnitude = Magnitude::of_settled_motion(model, &solution.motion);
            for (k, of) in self.metrics.iter().enumerate().filter(|(_, of)| of.motion == motion) {
                let (metric, value) = (&model.metrics[of.place], block.metrics[k].first().copied());
                let value = value.filter(|x| x.is_finite());
                round_off[k] = magnitude.metric_round_off(model, metric, value);
            }
        }
        (block, round_off)
    }

    /// Solves all designs from a number on, which must be a multiple of [`BLOCK`](crate::BLOCK). `done` receives the
    /// blocks in order and may end the run. The run also ends if `more` returns false.
    pub fn run(
        &self,
        from: usize,
        threads: NonZero<usize>,
        more: &(dyn Fn() -> bool + Sync),
        done: &mut (dyn FnMut(Block) -> ControlFlow<()> + Send),
    ) {
        let design = |number: usize| self.plan.design(number);
        let see = |block: &mut Block, number: usize, motion: usize, solution: &Solution| {
            self.see(block, number, motion, solution);
        };
        let mut report = |SampleBlock { numbers, found }: SampleBlock<Block>| {
            let cost = StudyCost { designs: numbers.len(), ..found.cost };
            done(Block { numbers, cost, ..found })
        };
        let run = SampleRun { numbers: from..self.plan.count(), design: &design, threads, more };
        self.motions.sample(&run, &see, &mut report);
    }

    fn see(&self, block: &mut Block, number: usize, motion: usize, solution: &Solution) {
        let model = self.motions.model(motion);
        block.metrics.resize_with(self.metrics.len(), Vec::new);
        block.cost.motions += 1;
        block.cost.steps += solution.motion.len();
        if let Some(stop) = &solution.stop {
            let (reason, why) = (failure_reason(stop, model), stop.headline(model));
            block.failures.push(Failure { number, motion, reason, why });
        }
        for (k, of) in self.metrics.iter().enumerate().filter(|(_, of)| of.motion == motion) {
            // An incomplete motion has no metrics.
            let whole = solution.stop.is_none();
            let value = whole.then(|| metric_number(&model.metrics[of.place], solution)).flatten();
            block.metrics[k].push(value.unwrap_or(f64::NAN));
        }
        if self.settings.curves.is_empty() {
            return;
        }
        block.curves.resize_with(self.motions.len(), Curves::default);
        let curves = &mut block.curves[motion];
        let measured = &solution.measured;
        curves.steps.push(measured.len() as u32);
        let column = |m: &usize| {
            let source = OutputSource::Measure(*m);
            measured.outputs.iter().position(|o| o.source == source)
        };
        for k in 0..measured.len() {
            let values = self.settings.curves.iter().map(column);
            curves.values.extend(values.map(|c| c.map_or(f64::NAN, |c| measured.value(k, c)[0])));
        }
    }
}

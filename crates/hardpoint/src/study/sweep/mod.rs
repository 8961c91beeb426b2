//! Many designs over the whole of their ranges: the metrics of each, exactly.

mod indices;
mod plan;
mod sobol;
mod statistics;

use std::num::NonZero;
use std::ops::{ControlFlow, Range};

use crate::model::{Model, OutputSource, SweepSettings};
use crate::run::{Run, Solution};

use super::evaluation::{Motions, StudyCost};
use super::metric::{metric_number, place_of};
use super::samples::{SampleBlock, SampleRun};

pub use indices::{SobolIndex, sobol_indices};
pub use plan::{SweepPlan, SweepPlanError};
pub(super) use statistics::quantile;
pub use statistics::{Distribution, rank_correlation};

/// A metric in one of the motions: a column of what is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SweptMetric {
    /// The metric, by its place in [`Model::metrics`] of the whole model.
    pub metric: usize,
    /// In which motion, by its place among those studied.
    pub motion: usize,
    /// Place among the metrics of that motion.
    place: usize,
}

/// Results of consecutive designs. SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SweptBlock {
    /// Their numbers.
    pub numbers: Range<usize>,
    /// Per metric, its value in each design; NaN where it has none.
    pub metrics: Vec<Vec<f64>>,
    /// Per motion, its curves; empty where none are requested.
    pub curves: Vec<SweptCurves>,
    /// Designs that do not move to the end, motion by motion.
    pub failures: Vec<SweptFailure>,
    /// Cost of the designs.
    pub cost: StudyCost,
}

/// The curves of some designs in one motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SweptCurves {
    /// Per design, how many output times were solved.
    pub steps: Vec<u32>,
    /// Design by design, output time by output time, curve by curve.
    pub values: Vec<f64>,
}

/// A design that does not move to the end of a motion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SweptFailure {
    /// Number.
    pub number: usize,
    /// In which motion, by its place among those studied.
    pub motion: usize,
    /// Kind of failure: its code in `docs/diagnostics.md`.
    pub code: String,
    /// Description of the failure.
    pub why: String,
}

/// A sweep that is ready to be begun, at its beginning or wherever a former one ended.
#[derive(Clone, Debug)]
pub struct Sweep<'a> {
    motions: &'a Motions<'a>,
    asked: &'a SweepSettings,
    plan: SweepPlan<'a>,
    metrics: Vec<SweptMetric>,
}

impl<'a> Sweep<'a> {
    /// The sweep over the designs of a model in some of its motions; `numbers` says which these are.
    ///
    /// # Errors
    /// Where designs cannot be chosen so.
    pub fn new(
        model: &Model,
        motions: &'a Motions<'a>,
        numbers: &[usize],
        asked: &'a SweepSettings,
    ) -> Result<Self, SweepPlanError> {
        let plan = SweepPlan::new(asked, model)?;
        let of_motion = |(metric, (motion, number)): (usize, (usize, &usize))| {
            Some(SweptMetric { metric, motion, place: place_of(model, metric, *number)? })
        };
        let pairs = asked.metrics.iter().flat_map(|m| numbers.iter().enumerate().map(|n| (*m, n)));
        Ok(Self { motions, asked, plan, metrics: pairs.filter_map(of_motion).collect() })
    }

    /// Designs.
    pub fn plan(&self) -> &SweepPlan<'a> {
        &self.plan
    }

    /// The columns of what is found.
    pub fn metrics(&self) -> &[SweptMetric] {
        &self.metrics
    }

    /// The nominal design, as the only one of its block.
    pub fn drawn(&self) -> SweptBlock {
        let mut block = SweptBlock { numbers: 0..1, ..SweptBlock::default() };
        for (motion, analysis) in self.motions.analyses().iter().enumerate() {
            let solution = analysis.solve(Run::new().without_sensitivities());
            self.see(&mut block, 0, motion, &solution);
        }
        block
    }

    /// Solves all designs from a number on, a multiple of [`BLOCK`](super::BLOCK). `done` is given what is found block
    /// by block, in order, and may end the work; so may `more`.
    pub fn run(
        &self,
        from: usize,
        threads: NonZero<usize>,
        more: &(dyn Fn() -> bool + Sync),
        done: &mut (dyn FnMut(SweptBlock) -> ControlFlow<()> + Send),
    ) {
        let design = |number: usize| self.plan.design(number);
        let see = |block: &mut SweptBlock, number: usize, motion: usize, solution: &Solution| {
            self.see(block, number, motion, solution);
        };
        let mut told = |SampleBlock { numbers, found }: SampleBlock<SweptBlock>| {
            let cost = StudyCost { designs: numbers.len(), ..found.cost };
            done(SweptBlock { numbers, cost, ..found })
        };
        let run = SampleRun { numbers: from..self.plan.count(), design: &design, threads, more };
        self.motions.sample(&run, &see, &mut told);
    }

    fn see(&self, block: &mut SweptBlock, number: usize, motion: usize, solution: &Solution) {
        let model = self.motions.model(motion);
        block.metrics.resize_with(self.metrics.len(), Vec::new);
        block.cost.motions += 1;
        block.cost.steps += solution.motion.len();
        if let Some(stop) = &solution.stop {
            let (code, why) = (stop.code().to_owned(), stop.headline(model));
            block.failures.push(SweptFailure { number, motion, code, why });
        }
        for (k, of) in self.metrics.iter().enumerate().filter(|(_, of)| of.motion == motion) {
            // A part of a motion says nothing of the rest.
            let whole = solution.stop.is_none();
            let value = whole.then(|| metric_number(&model.metrics[of.place], solution)).flatten();
            block.metrics[k].push(value.unwrap_or(f64::NAN));
        }
        if self.asked.curves.is_empty() {
            return;
        }
        block.curves.resize_with(self.motions.len(), SweptCurves::default);
        let curves = &mut block.curves[motion];
        let measured = &solution.measured;
        curves.steps.push(measured.len() as u32);
        let column = |m: &usize| {
            let source = OutputSource::Measure(*m);
            measured.outputs.iter().position(|o| o.source == source)
        };
        for k in 0..measured.len() {
            let values = self.asked.curves.iter().map(column);
            curves.values.extend(values.map(|c| c.map_or(f64::NAN, |c| measured.value(k, c)[0])));
        }
    }
}

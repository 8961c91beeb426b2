//! Results of runs.

use std::sync::Arc;

use crate::blocks::merged_rows;
use crate::measure::MeasureResults;
use crate::model::{BodyId, OutputSource};
use crate::motion::{BodyState, Motion, SolverStatistics, Stop};
use crate::sensitivity::{Admissibility, Sensitivities};

/// Results of a run. If something stopped the run, the results up to there are complete.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// The motion, up to the last output time that was solved.
    pub motion: Motion,
    /// Sensitivities of all bodies by all design variables.
    pub sensitivities: Sensitivities,
    /// Measures and points, with their sensitivities.
    pub measured: MeasureResults,
    /// Reason why the run ended before the last output time, if it did.
    pub stop: Option<Stop>,
    /// The same motion at more times, if metrics need them.
    pub(crate) between: Option<Arc<Solution>>,
    /// Times of a motion at more times that no metric has located: they do not depend on the design. Empty if none is
    /// located.
    pub(crate) unlocated: Vec<f64>,
    /// Clearances, as outputs, whose minima are all among the times that are solved.
    pub(crate) located: Vec<OutputSource>,
}

impl Solution {
    /// Inserts output times of another solution of the same design.
    pub(crate) fn insert(&mut self, added: &Self) {
        let rows = merged_rows(&self.motion.times, &added.motion.times);
        self.motion.insert(&added.motion, &rows);
        self.sensitivities.derivatives.merge(&added.sensitivities.derivatives, &rows);
        self.measured.insert(&added.measured, &rows);
    }

    /// State of a body at output time k.
    pub fn body(&self, k: usize, body: BodyId) -> BodyState {
        self.motion.at(k).body(body.0)
    }
}

/// Summary at the end of a streamed run.
#[derive(Clone, Debug)]
pub struct StreamSummary {
    /// Output times solved.
    pub steps: usize,
    /// Admissibility per variable.
    pub admissibility: Vec<Admissibility>,
    /// Statistics of the solver.
    pub effort: SolverStatistics,
    /// Reason why the run ended before the last output time, if it did.
    pub stop: Option<Stop>,
}

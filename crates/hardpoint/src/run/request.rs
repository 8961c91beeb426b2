//! Requests of runs.

use std::fmt;
use std::num::NonZero;
use std::ops::ControlFlow;

use crate::model::OutputSource;

use super::needed::MetricUse;
use super::solution::Solution;

/// Request of a run: the design, and the results to compute.
///
/// By default it is everything, for the nominal design: the motion at all output times, its sensitivities by all design
/// variables, and measures. Options that a run mode does not use are ignored.
///
/// | | [`solve`] | [`solve_in_windows`] | [`solve_designs`] | [`stream`] | [`stream_designs`] |
/// |---|---|---|---|---|---|
/// | [`at`](Run::at) | yes | yes | | yes | |
/// | [`without_sensitivities`](Run::without_sensitivities) | yes | yes | yes | yes | yes |
/// | [`for_metrics`](Run::for_metrics) | yes | | | | |
/// | [`for_outputs`](Run::for_outputs) | yes | | | | |
/// | [`without_measures`](Run::without_measures) | yes | yes | yes | has none | has none |
/// | [`progress`](Run::progress) | yes | yes | | yes | |
/// | [`reusing`](Run::reusing) | yes | yes | by itself | stores nothing | stores nothing |
/// | [`threads`](Run::threads) | | | yes | | |
///
/// [`solve`]: crate::Analysis::solve
/// [`solve_in_windows`]: crate::Analysis::solve_in_windows
/// [`solve_designs`]: crate::Analysis::solve_designs
/// [`stream`]: crate::Analysis::stream
/// [`stream_designs`]: crate::Analysis::stream_designs
///
/// ```
/// # use hardpoint::{Analysis, Run, draft::*, law::Law, model::Model};
/// // A crank that turns by one radian per second, and a variable that moves its pivot along x.
/// let draft = Draft::new("crank")
///     .hardpoint("O", [0.0, 0.0, 0.0])
///     .body("crank")
///     .revolute("pivot", ["ground", "crank"], "O", [0.0, 0.0, 1.0])
///     .driver("motor", "pivot", Law::parse("t").unwrap())
///     .variable_moving("O along", "O", [1.0, 0.0, 0.0])
///     .point("tip", "crank", [0.2, 0.0, 0.0])
///     .times([0.0, 0.5]);
/// let model = Model::from_draft(&draft).unwrap();
/// let analysis = Analysis::new(&model).unwrap();
///
/// // The motion alone, of the design whose pivot is moved by 0.1 m: the distance of the tip is then 0.1 m.
/// let moved = analysis.solve(Run::new().at(&[0.1]).without_sensitivities());
/// let tip_y = moved.measured.index("tip.y").unwrap();
/// assert!((moved.measured.value(1, tip_y)[0] - 0.1 * 0.5_f64.sin()).abs() < 1e-12);
///
/// // Again with sensitivities, in the memory of the former results.
/// let again = analysis.solve(Run::new().at(&[0.1]).reusing(moved));
/// assert!((again.measured.d(1, model.variable("O along").unwrap(), tip_y)[0] + 0.5_f64.sin()).abs() < 1e-12);
/// ```
#[must_use = "a request is answered by an analysis"]
pub struct Run<'r> {
    pub(super) design: &'r [f64],
    pub(super) outputs: Option<&'r [OutputSource]>,
    pub(super) metrics: Option<&'r [MetricUse]>,
    pub(super) scope: Scope,
    pub(super) threads: NonZero<usize>,
    pub(super) progress: Box<dyn FnMut(Progress) -> ControlFlow<()> + 'r>,
    pub(super) memory: Solution,
}

impl<'r> Run<'r> {
    /// Requests all results of the nominal design.
    pub fn new() -> Self {
        Self {
            design: &[],
            outputs: None,
            metrics: None,
            scope: Scope::of_one(true, true),
            threads: NonZero::<usize>::MIN,
            progress: Box::new(|_| ControlFlow::Continue(())),
            memory: Solution::default(),
        }
    }

    /// Requests the design with variable k at `design[k]` (m, rad or a plain number; missing entries are 0, surplus
    /// ones are ignored): its motion, solved exactly, and its sensitivities.
    ///
    /// Joint defects are those of the nominal design.
    pub fn at(self, design: &'r [f64]) -> Self {
        Self { design, ..self }
    }

    /// Requests the motion without sensitivities.
    pub fn without_sensitivities(self) -> Self {
        Self { scope: Scope { sensitivities: false, ..self.scope }, ..self }
    }

    /// Requests the metrics with these uses; those without an entry are used with their derivative. With equilibrium
    /// the run leaves out measures and sensitivities that they do not depend on, which are NaN;
    /// [metrics](super::metrics), [misfits](super::misfits) and, of those whose candidates are used,
    /// [peaks](super::peaks) are the same.
    pub fn for_metrics(self, uses: &'r [MetricUse]) -> Self {
        Self { metrics: Some(uses), ..self }
    }

    /// Requests of the measures and points these alone. The run leaves out other measures that take more than the
    /// positions, such as roll centres and slopes; they are NaN.
    pub fn for_outputs(self, outputs: &'r [OutputSource]) -> Self {
        Self { outputs: Some(outputs), ..self }
    }

    /// Requests the motion without measures and points: [`Solution::measured`] stays empty.
    pub fn without_measures(self) -> Self {
        Self { scope: Scope { measures: false, ..self.scope }, ..self }
    }

    /// Calls this after every output time. `ControlFlow::Break` ends the run, whose stop is then
    /// [`Interrupted`](crate::motion::StopKind::Interrupted).
    pub fn progress(self, progress: impl FnMut(Progress) -> ControlFlow<()> + 'r) -> Self {
        Self { progress: Box::new(progress), ..self }
    }

    /// Writes the results into the memory of a former solution, of any model: allocating new memory takes as long as
    /// solving.
    pub fn reusing(self, memory: Solution) -> Self {
        Self { memory, ..self }
    }

    /// Solves designs on this number of threads. Batches do not depend on it, so that every solution is the same to the
    /// last bit.
    pub fn threads(self, threads: NonZero<usize>) -> Self {
        Self { threads, ..self }
    }
}

impl Default for Run<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Debug for Run<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { design, scope, threads, .. } = self;
        let mut out = f.debug_struct("Run");
        out.field("design", design).field("scope", scope).field("threads", threads).finish_non_exhaustive()
    }
}

/// Progress of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Output times solved.
    pub done: usize,
    /// Total number of output times.
    pub total: usize,
}

/// Requested results of a design.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scope {
    pub sensitivities: bool,
    pub measures: bool,
    /// Total number of designs, this one included; it decides whether a program saves time.
    pub of_many: usize,
}

impl Scope {
    /// Scope of a single design.
    pub fn of_one(sensitivities: bool, measures: bool) -> Self {
        Self { sensitivities, measures, of_many: 1 }
    }
}

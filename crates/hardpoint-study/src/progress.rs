//! Control of a study by its caller, and its progress.

use std::num::NonZero;
use std::ops::ControlFlow;

use super::optimize::{Iteration, SearchResult};

/// Control of a study: its threads, and callbacks that receive the progress or end it.
pub struct Control<'w> {
    /// Number of threads. The results do not depend on it.
    pub threads: NonZero<usize>,
    /// Receives the progress, and may end the study.
    pub progress: &'w mut (dyn FnMut(Progress<'_>) -> ControlFlow<()> + Send),
    /// Called at every output time of single designs; returns false to end the study.
    pub more: &'w (dyn Fn() -> bool + Sync),
}

/// Progress of a study.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'s> {
    /// Step that was completed.
    pub step: Step<'s>,
    /// Number of completed steps that are counted.
    pub done: usize,
    /// Total or maximum number of these steps.
    pub total: usize,
    /// True if `done` counts this step: of several searches it counts their ends, of a single one its iterations.
    pub is_counted: bool,
}

/// Step of a study.
#[derive(Clone, Copy, Debug)]
pub enum Step<'s> {
    /// The derivatives by a variable were differenced, or compared with differences.
    Variable,
    /// Sampled designs were solved.
    Designs,
    /// An iteration of a search was completed.
    Iteration(&'s Iteration),
    /// The search from the start of this number ended.
    Search(usize, &'s SearchResult),
    /// A point of a front was found.
    FrontPoint,
    /// An iteration of a fit was completed, with this objective.
    Fit(f64),
}

impl Progress<'_> {
    /// Progress by a counted step.
    pub(crate) fn counted(step: Step<'_>, done: usize, total: usize) -> Progress<'_> {
        Progress { step, done, total, is_counted: true }
    }
}

//! Synthesis of the linkages of a task.

use std::sync::atomic::{AtomicBool, Ordering};

use super::path::along_path;
use super::poses::through_poses;
use super::result::Synthesis;
use super::task::{Aim, Task, TaskError};

/// Finds the linkages of a task. `more` is called regularly; if it returns false, the study ends with those found so
/// far.
///
/// # Errors
/// A [`TaskError`].
pub fn synthesize(task: &Task, more: &(dyn Fn() -> bool + Sync)) -> Result<Synthesis, TaskError> {
    if !(task.four_bars || task.slider_cranks) {
        return Err(TaskError::NoType);
    }
    let ended = AtomicBool::new(false);
    let more = || {
        let goes_on = more();
        ended.fetch_or(!goes_on, Ordering::Relaxed);
        goes_on
    };
    let found = match &task.aim {
        Aim::Poses(poses) => through_poses(task, poses, &more),
        Aim::Path { points, is_closed, turns } => {
            along_path(task, points, *is_closed, turns.as_deref(), &more)
        }
    };
    found.map(|found| Synthesis { is_interrupted: ended.into_inner(), ..found })
}

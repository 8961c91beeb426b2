//! One iteration of any of basin's solvers.

use basin::{CountsMirror, Solver, State, StepOutcome, Stepper};

/// Performs one iteration and returns the new point, or `None` at the end. Internal steps that do not end an iteration
/// are skipped.
pub(crate) fn next<P, S, So>(stepper: &mut Stepper<P, S, So>) -> Option<Vec<f64>>
where
    S: State<Param = Vec<f64>, Float = f64> + CountsMirror,
    So: Solver<P, S>,
{
    let before = stepper.iter();
    loop {
        match stepper.step() {
            Ok(StepOutcome::Continue) if stepper.iter() == before => (),
            Ok(StepOutcome::Continue) => return Some(stepper.state().param().clone()),
            Ok(StepOutcome::Stopped(_)) if stepper.iter() > before => {
                return Some(stepper.state().param().clone());
            }
            _ => return None,
        }
    }
}

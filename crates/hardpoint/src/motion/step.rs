//! The step of the solver: drive, predict, correct, check, accept.
//!
//! Every step is taken by [`take`], whatever it advances and whoever computes it:
//!
//! | step | advances | prediction | correction |
//! |---|---|---|---|
//! | `OutputStep` | one design to the next output time | Hermite interpolation (27) | kernel |
//! | `InnerStep` | one design to a time between two that are solved | Hermite interpolation (27) | kernel |
//! | `PathStep` | one design along a path, between output times | series along the drivers (22) | kernel |
//! | `TimeStep` | one design over up to eight output times | Hermite interpolation (27) | program |
//! | `DesignStep` | eight designs to the next output time | Hermite interpolation (27) | program |
//!
//! A step that is rejected leaves the accepted position as it is. What follows is shorter: after a batch single output
//! times, after an output time a path, along a path half the step ([`super::walk`]).

/// A step of one design or of many.
pub(super) trait Step {
    /// Reason why a step is rejected.
    type Rejection;

    /// Sets the drivers at the end of the step.
    fn drive(&mut self) -> Result<(), Self::Rejection>;

    /// Predicts the position there. Returns the largest first correction that is trusted, rad or sizes.
    fn predict(&mut self) -> f64;

    /// Solves the position from the prediction by Newton's method, and velocity and acceleration with its factors.
    fn correct(&mut self, trust: f64) -> Result<(), Self::Rejection>;

    /// Checks that the solution continues the motion: on its branch, closed, and as smooth as the step requires.
    fn check(&mut self) -> Result<(), Self::Rejection>;

    /// Makes the solution the accepted position.
    fn accept(&mut self);
}

/// Takes a step, or rejects it.
#[inline(always)]
pub(super) fn take<S: Step>(mut step: S) -> Result<(), S::Rejection> {
    step.drive()?;
    let trust = step.predict();
    step.correct(trust)?;
    step.check()?;
    step.accept();
    Ok(())
}

/// Step over which the motion is too rough, or of which the program is not valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RoughStep;

impl RoughStep {
    /// Rejects a step unless it is smooth.
    #[inline(always)]
    pub fn unless(is_smooth: bool) -> Result<(), Self> {
        if is_smooth { Ok(()) } else { Err(Self) }
    }
}

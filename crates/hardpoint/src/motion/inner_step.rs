//! Step to a time between two solved output times.
//!
//! The positions on both sides determine the prediction so well that one correction is enough, and show the branch.

use super::Stop;
use super::advance::{advance, count};
use super::mechanism::Mechanism;
use super::path::Path;
use super::states::Motion;
use super::step::{RoughStep, Step, take};
use super::stepper::Stepper;
use super::time_batch::FORECAST_TRUST;

/// Moves on to a time between those of a motion of the same design. If the positions on both sides do not predict the
/// position there, it is reached from the one accepted last.
pub(crate) fn advance_between(one: &mut Stepper<'_>, known: &Motion, t: f64) -> Result<(), Box<Stop>> {
    one.at_change_point = false;
    if InnerStep::to(one, known, t).is_some_and(|step| take(step).is_ok()) {
        count(one);
        return Ok(());
    }
    one.forget();
    advance(one, t)
}

/// The step to a time t between output times k and k + 1 of a motion.
struct InnerStep<'s, 'm> {
    one: &'s mut Stepper<'m>,
    known: &'s Motion,
    k: usize,
    t: f64,
    /// Selections of rows before the step.
    selections: usize,
}

impl<'s, 'm> InnerStep<'s, 'm> {
    /// The step to t, if the motion has times before and after it.
    fn to(one: &'s mut Stepper<'m>, known: &'s Motion, t: f64) -> Option<Self> {
        let after = known.times.partition_point(|time| *time <= t);
        let selections = one.mechanism.selections;
        (0 < after && after < known.len()).then_some(Self { one, known, k: after - 1, t, selections })
    }
}

impl Step for InnerStep<'_, '_> {
    type Rejection = RoughStep;

    fn drive(&mut self) -> Result<(), RoughStep> {
        self.one.mechanism.drive(Path::Laws, self.t).map_err(|_| RoughStep)
    }

    fn predict(&mut self) -> f64 {
        let Self { known, k, t, .. } = *self;
        let Stepper { mechanism, predictor, .. } = &mut *self.one;
        let Some(channels) = &known.channels else { return 0.0 };
        predictor.forget();
        for end in [k, k + 1] {
            let row = channels.row(end);
            let count = predictor.len();
            predictor.learn_values(
                known.times[end],
                (0..count).map(|channel| [0, 1, 2].map(|order| row.get(3 * channel + order))),
            );
        }
        predictor.set(&mut mechanism.state, t, t - known.times[k + 1]);
        FORECAST_TRUST
    }

    fn correct(&mut self, trust: f64) -> Result<(), RoughStep> {
        self.one.mechanism.solve_within(trust).map_err(|_| RoughStep)
    }

    fn check(&mut self) -> Result<(), RoughStep> {
        let Self { known, k, .. } = *self;
        let Stepper { mechanism, turns, .. } = &mut *self.one;
        mechanism.examine_position().map_err(|_| RoughStep)?;
        let Mechanism { state, selections, .. } = mechanism;
        RoughStep::unless(*selections == self.selections)?;
        let counted = |k: usize| known.counted_at(k);
        RoughStep::unless(
            turns.as_mut().is_none_or(|turns| turns.is_between(state, [counted(k), counted(k + 1)])),
        )
    }

    fn accept(&mut self) {
        if let Some(turns) = &mut self.one.turns {
            turns.accept();
        }
        self.one.start_at(self.t);
    }
}

//! A step along a path, as long as the nearest singular position allows.

use super::kinematics::PositionFailure;
use super::mechanism::{LOCKED, Mechanism, StepRejection};
use super::path::Path;
use super::step::Step;
use super::stepper::Stepper;

/// First correction (rad, or sizes) that is always accepted, whatever the length of the predicted move.
pub(super) const TRUST_FLOOR: f64 = 0.02;
/// Maximum first correction as a fraction of the predicted move; a larger one means that the prediction is wrong.
const TRUST: f64 = 0.5;
/// Fraction of the locking tolerance above which redundant constraints are also checked in the middle of a step.
const SUSPECT: f64 = 1e-2;
/// Difference between a contact and its prediction that is always accepted, in lengths between the points of the curve.
const CONTACT_FLOOR: f64 = 0.1;
/// Maximum bend of a curve over a step, rad: a groove that turns back within a step would be missed.
pub(super) const MOST_BEND: f64 = 0.4;

/// Largest first correction that is trusted after a predicted move, rad or sizes: a larger one may lead to another
/// branch.
#[inline(always)]
pub(super) fn trust(moved: f64) -> f64 {
    // abs(dq_0) <= max(half of the predicted move, 0.02)
    (TRUST * moved).max(TRUST_FLOOR)
}

/// A step h along a path, to t.
pub(super) struct PathStep<'s, 'm> {
    one: &'s mut Stepper<'m>,
    path: Path,
    t: f64,
    h: f64,
    /// Selections of rows before the step.
    selections: usize,
}

impl<'s, 'm> PathStep<'s, 'm> {
    pub fn new(one: &'s mut Stepper<'m>, path: Path, t: f64, h: f64) -> Self {
        let selections = one.mechanism.selections;
        Self { one, path, t, h, selections }
    }

    /// Solves the position at the end of the step, without accepting it.
    pub fn solve(mut self) -> Result<(), StepRejection> {
        self.one.mechanism.drive(self.path, self.t)?;
        let trust = self.predict();
        self.correct(trust)
    }

    /// Checks the distance between the contacts of curves and their prediction.
    fn check_contacts(&self) -> Result<(), StepRejection> {
        let Mechanism { topology, parts, state, saved, .. } = &self.one.mechanism;
        for (c, k) in topology.contacts() {
            let ([predicted, moved], curve) = (self.one.lookahead.contacts[k], &parts.curves[k]);
            let (before, now) = (saved.contacts[k].u, state.contacts[k].u);
            // abs(u - predicted) <= max(half of the predicted move, a tenth of the length between two points of the
            // curve); NaN fails.
            let near = (now - predicted).abs() <= (TRUST * moved).max(CONTACT_FLOOR * curve.grain());
            if !(near && curve.bend(before, now) <= MOST_BEND)
                && let Some(block) = topology[c].block
            {
                return Err(StepRejection::Position(PositionFailure::NoConvergence { block }));
            }
        }
        Ok(())
    }
}

impl Step for PathStep<'_, '_> {
    type Rejection = StepRejection;

    fn drive(&mut self) -> Result<(), StepRejection> {
        // Redundant constraints that disagree in the middle of a step may agree again at its end.
        let Self { path, h, .. } = *self;
        let saved = &self.one.mechanism.saved;
        if saved.residual > SUSPECT * LOCKED && path == Path::Laws {
            let middle = saved.time + 0.5 * h;
            PathStep::new(self.one, path, middle, 0.5 * h).solve()?;
        }
        self.one.lookahead.measure_travel(&self.one.mechanism, path, h);
        self.selections = self.one.mechanism.selections;
        self.one.mechanism.drive(path, self.t)
    }

    fn predict(&mut self) -> f64 {
        trust(self.one.lookahead.predict(&mut self.one.mechanism, self.path, self.h))
    }

    fn correct(&mut self, trust: f64) -> Result<(), StepRejection> {
        self.one.mechanism.solve_within(trust)?;
        self.check_contacts()?;
        self.one.mechanism.examine_position()
    }

    fn check(&mut self) -> Result<(), StepRejection> {
        let Stepper { mechanism, lookahead, turns, .. } = &mut *self.one;
        lookahead.examine(mechanism, self.path, turns.as_mut());
        if mechanism.selections == self.selections && !lookahead.is_clear_beyond() {
            return Err(StepRejection::TooNear);
        }
        let mut turns = turns.as_mut().filter(|_| self.path != Path::Assembly);
        if let Some(turns) = &mut turns
            && !lookahead.follow_turns(mechanism, (self.path, self.h), turns)
        {
            return Err(StepRejection::TooNear);
        }
        Ok(())
    }

    fn accept(&mut self) {
        self.one.save(self.t);
        self.one.lookahead.accept();
    }
}

//! Where results go: into a [`Solution`](crate::Solution), or wherever a caller wants them.

use crate::model::{BodyId, VariableId};
use crate::motion::{BodyState, Motion};
use crate::sensitivity::BodySensitivity;

/// Takes the results of a run as they are found, so that nothing need be stored that is not wanted.
///
/// Results come in groups of up to eight output times; within a group the bodies' states come first, then variable by variable
/// the sensitivities of those bodies that the variable moves. All others are zero.
pub trait Sink {
    /// Whether this body's results are wanted: what is not is not even worked out.
    fn wants(&self, body: BodyId) -> bool {
        let _ = body;
        true
    }

    /// A body's state at output time k.
    fn state(&mut self, k: usize, body: BodyId, state: &BodyState);

    /// A body's sensitivity by one variable at output time k.
    ///
    /// By variables that turn out to be such as the mechanism cannot follow, numbers may come nevertheless: the
    /// [`Admissibility`](crate::sensitivity::Admissibility) at the end tells.
    fn sensitivity(&mut self, k: usize, variable: VariableId, body: BodyId, derivatives: &BodySensitivity);
}

/// Stores everything.
pub(crate) struct Store<'s> {
    pub motion: &'s mut Motion,
    pub sensitivities: &'s mut [BodySensitivity],
    pub variables: usize,
}

impl Sink for Store<'_> {
    #[inline(always)]
    fn state(&mut self, k: usize, body: BodyId, state: &BodyState) {
        self.motion.states[k * self.motion.bodies + body.0] = *state;
    }

    #[inline(always)]
    fn sensitivity(&mut self, k: usize, variable: VariableId, body: BodyId, derivatives: &BodySensitivity) {
        self.sensitivities[(k * self.variables + variable.0) * self.motion.bodies + body.0] = *derivatives;
    }
}

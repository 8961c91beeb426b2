//! Receivers of results: a [`Solution`](crate::Solution), or any other implementation.

use std::ops::Range;

use crate::blocks::ResultBlock;
use crate::model::{BodyId, VariableId};
use crate::motion::BodyState;
use crate::sensitivity::BodySensitivity;

/// Takes the results of a run as they are found, so that nothing need be stored that is not wanted.
///
/// Results come in groups of up to eight output times; within a group the bodies' states come first, then variable by
/// variable the sensitivities of those bodies that the variable moves. All others are zero.
pub trait Sink {
    /// True if this body's results are wanted: what is not is not even worked out.
    fn wants(&self, body: BodyId) -> bool {
        let _ = body;
        true
    }

    /// A body's state at output time k.
    fn state(&mut self, k: usize, body: BodyId, state: &BodyState);

    /// A body's sensitivity by one variable at output time k.
    ///
    /// By variables that turn out to be such as the mechanism cannot follow, numbers may come nevertheless: the
    /// [`Admissibility`](crate::sensitivity::Admissibility) at the end indicates.
    fn sensitivity(&mut self, k: usize, variable: VariableId, body: BodyId, derivatives: &BodySensitivity);

    /// Memory for eight output times, k to k + 7, that are found at once, those of every number side by side. First,
    /// per body but ground, position, columns of the rotation, velocity, angular velocity, acceleration, angular
    /// acceleration (24 numbers); second, per variable and body that it moves, a [`BodySensitivity`] in the order of
    /// its fields (18).
    ///
    /// What is written to it comes no other way, and means nothing beyond the last output time. Where there is none, as
    /// here, or of another size, results come one by one.
    fn room(&mut self, k: usize) -> Option<[&mut [[f64; 8]]; 2]> {
        let _ = k;
        None
    }
}

/// Gives the results of wanted bodies, lane by lane, to one of the sinks each, as those of an output time: `of(lane)`
/// says which sink, and which time. `moved` says which variable moves which body, in the order of the derivatives.
#[inline(always)]
pub(super) fn hand_over<S: Sink>(
    block: &ResultBlock<'_>,
    wanted: &[bool],
    moved: impl Iterator<Item = (VariableId, BodyId)>,
    sinks: &mut [S],
    lanes: Range<usize>,
    of: impl Fn(usize) -> (usize, usize),
) {
    let states = block.states.as_chunks::<{ BodyState::NUMBERS }>().0;
    for (numbers, body) in states.iter().zip(1..).filter(|(_, body)| wanted[*body]) {
        for lane in lanes.clone() {
            let (sink, k) = of(lane);
            sinks[sink].state(k, BodyId(body), &BodyState::from(|n| numbers[n][lane]));
        }
    }
    let derivatives = block.derivatives.as_chunks::<{ BodySensitivity::NUMBERS }>().0;
    for (numbers, (variable, body)) in derivatives.iter().zip(moved).filter(|(_, m)| wanted[m.1.0]) {
        for lane in lanes.clone() {
            let (sink, k) = of(lane);
            sinks[sink].sensitivity(k, variable, body, &BodySensitivity::from(|n| numbers[n][lane]));
        }
    }
}

/// Takes nothing.
pub(super) struct NullSink;

impl Sink for NullSink {
    fn state(&mut self, _: usize, _: BodyId, _: &BodyState) {}

    fn sensitivity(&mut self, _: usize, _: VariableId, _: BodyId, _: &BodySensitivity) {}
}

//! Receivers of results: a [`Solution`](crate::Solution), or any other implementation.

use std::ops::Range;

use crate::blocks::ResultBlock;
use crate::model::{BodyId, VariableId};
use crate::motion::BodyState;
use crate::sensitivity::BodySensitivity;

/// Receives the results of a run as they are computed, so that only requested results are stored.
///
/// Results come in groups of up to eight output times. Within a group the states of the bodies come first; then,
/// variable by variable, the sensitivities of the bodies that the variable moves. All other sensitivities are zero.
pub trait Sink {
    /// True if the results of this body are requested; others are not computed.
    fn wants(&self, body: BodyId) -> bool {
        let _ = body;
        true
    }

    /// Receives the state of a body at output time k.
    fn state(&mut self, k: usize, body: BodyId, state: &BodyState);

    /// Receives the sensitivity of a body by one variable at output time k.
    ///
    /// Numbers may also come for variables that prove not to be admissible; see the
    /// [`Admissibility`](crate::sensitivity::Admissibility) at the end.
    fn sensitivity(&mut self, k: usize, variable: VariableId, body: BodyId, derivatives: &BodySensitivity);

    /// Memory for a batch of eight output times, k to k + 7; the eight values of each number are adjacent. The first
    /// array has per body but ground: position, columns of the rotation, velocity, angular velocity, acceleration,
    /// angular acceleration (24 numbers). The second has per variable and body that it moves: a [`BodySensitivity`] in
    /// the order of its fields (18).
    ///
    /// Results that are written here are not passed to the other methods. Values beyond the last output time are
    /// undefined. With `None` (the default) or another size, results come one by one.
    fn room(&mut self, k: usize) -> Option<[&mut [[f64; 8]]; 2]> {
        let _ = k;
        None
    }
}

/// Passes the results of the requested bodies to sinks, lane by lane. `of(lane)` returns the sink and the output time
/// of a lane. `moved` has the pairs of a variable and a body that it moves, in the order of the derivatives.
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

/// Sink that requests no results.
pub(super) struct NullSink;

impl Sink for NullSink {
    fn state(&mut self, _: usize, _: BodyId, _: &BodyState) {}

    fn sensitivity(&mut self, _: usize, _: VariableId, _: BodyId, _: &BodySensitivity) {}
}

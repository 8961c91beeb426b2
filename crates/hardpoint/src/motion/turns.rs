//! Counting of whole turns along the path: for angles of measures, and for coordinates of cut joints that elements act
//! on.
//!
//! A position gives an angle within one turn only; the path determines the turn. Between output times an angle is
//! predicted along the drivers, like every unknown ([`super::walk`]), so that the result does not depend on the output
//! times or on the laws in between. From one output time to the next of an even motion an angle moves by less than a
//! radian; otherwise the step is rejected ([`TurnCounter::is_even`]).

use hardpoint_tape::Lanes;

use super::BodyState;
use super::kinematics::State;

/// Maximum difference between an angle and its prediction, rad; otherwise its turn is ambiguous. It is also the maximum
/// first-order change over one step, which is well below half a turn.
pub(super) const TURN_TRUST: f64 = 1.0;
/// Factor of this maximum for the change of an angle as computed from the far end of a step.
const FAR_END: f64 = 2.5;
/// Driver travel, rad or sizes, below which a step is not rejected because of an angle: an angle may jump where it is
/// undefined, such as where the two points of a direction coincide.
pub(super) const FINEST: f64 = 1e-6;

/// One turn, rad.
const TURN: f64 = 2.0 * std::f64::consts::PI;

/// Angle plus the whole number of turns that brings it nearest to another; unchanged if the other is NaN.
pub(crate) fn turned(angle: f64, near: f64) -> f64 {
    // angle + 2 pi k,  k the whole number nearest to (near - angle) / 2 pi
    let turns = ((near - angle) / TURN).round();
    if turns.is_nan() { angle } else { angle + TURN * turns }
}

/// Angle in the turn nearest to another; if it is NaN, the former angle, so that its turns are not lost.
fn counted(angle: f64, near: f64, before: f64) -> f64 {
    if angle.is_nan() { before } else { turned(angle, near) }
}

/// Angles whose turns are counted along the path.
pub(crate) trait CountedAngles {
    /// Bodies on which they are measured, without ground.
    fn bodies(&self) -> &[usize];

    /// Per angle: its value in the design configuration; `None` to start with the measured value, without whole turns.
    fn origins(&self) -> &[Option<f64>];

    /// Computes the value within a turn, and the first two derivatives, of every angle; `state` returns the state of
    /// each of the [`bodies`](Self::bodies).
    fn measure(&mut self, state: &dyn Fn(usize) -> BodyState, found: &mut [[f64; 3]]);
}

/// Counter of the angles that are counted along the path, at the accepted position.
pub(crate) struct TurnCounter<'m> {
    angles: Box<dyn CountedAngles + 'm>,
    /// Per angle: its value with all turns at the accepted position, rad.
    pub values: Vec<f64>,
    /// The same at the output times that were solved at once, lane by lane.
    pub lanes: Vec<f64>,
    /// Angular velocity of the fastest of the bodies at the accepted position, rad/s.
    spin: f64,
    /// The same at the end of a step.
    spin_ahead: f64,
    /// Per angle: its value at the end of a step, or at the position at rest that was solved last.
    pub ahead: Vec<f64>,
    /// Scratch.
    kept: Vec<f64>,
    found: Vec<[f64; 3]>,
}

impl<'m> TurnCounter<'m> {
    /// Makes a counter of these angles.
    pub fn new(angles: Box<dyn CountedAngles + 'm>) -> Self {
        let count = angles.origins().len();
        Self {
            values: vec![0.0; count],
            lanes: Vec::new(),
            spin: 0.0,
            spin_ahead: 0.0,
            ahead: vec![0.0; count],
            kept: vec![0.0; count],
            found: vec![[0.0; 3]; count],
            angles,
        }
    }

    /// Number of angles.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Starts at the design configuration, the position of the state.
    pub fn begin(&mut self, state: &State<f64>) {
        self.look(&|b| BodyState::of(state, b));
        for ((value, [now, ..]), origin) in self.values.iter_mut().zip(&self.found).zip(self.angles.origins())
        {
            *value = turned(*now, origin.unwrap_or(*now));
        }
        self.spin = self.spin_ahead;
        self.ahead.copy_from_slice(&self.values);
    }

    /// Counts at a position at rest that is near the one that was solved last, or near the accepted position.
    pub fn follow_at_rest(&mut self, state: &State<f64>, from_accepted: bool) {
        if from_accepted {
            self.ahead.copy_from_slice(&self.values);
        }
        self.look(&|b| BodyState::of(state, b));
        for (ahead, [now, ..]) in self.ahead.iter_mut().zip(&self.found) {
            *ahead = counted(*now, *ahead, *ahead);
        }
    }

    /// Accepts the position at rest that was solved last.
    pub fn accept_at_rest(&mut self, state: &State<f64>) {
        self.follow_at_rest(state, false);
        self.values.copy_from_slice(&self.ahead);
        self.spin = self.spin_ahead;
    }

    /// Updates the rates at the accepted position, for another path.
    pub fn renew(&mut self, state: &State<f64>) {
        self.look(&|b| BodyState::of(state, b));
        self.nearest();
        self.accept();
    }

    /// Derivatives of all angles along a direction that the bodies move in.
    pub fn slopes(&mut self, state: &State<f64>, out: &mut Vec<[f64; 2]>) {
        self.look(&|b| BodyState::of(state, b));
        out.clear();
        out.extend(self.found.iter().map(|[_, slope, bend]| [*slope, *bend]));
    }

    /// Returns true if each angle is in the predicted turn after a step. For an angle, `predict` returns its change
    /// computed from the accepted position, and from the new one, both to second order, and its maximum change computed
    /// from the new one to first order.
    pub fn follow(&mut self, state: &State<f64>, predict: impl Fn(usize) -> [f64; 3]) -> bool {
        self.look(&|b| BodyState::of(state, b));
        let mut sure = true;
        for (i, [now, ..]) in self.found.iter().enumerate() {
            let (before, [ahead, back, far]) = (self.values[i], predict(i));
            let near = before + if ahead.is_finite() { ahead } else { 0.0 };
            self.ahead[i] = counted(*now, near, before);
            let moved = self.ahead[i] - before;
            // A NaN angle is not checked.
            let doubtful = (self.ahead[i] - near).abs() > TURN_TRUST
                || (moved - back).abs() > FAR_END * TURN_TRUST
                || far > FAR_END * TURN_TRUST;
            sure &= now.is_nan() || !doubtful;
        }
        sure
    }

    /// Returns true if the turns of all angles are unambiguous after a step h from one output time to the next, over
    /// which the total travel of the drivers is `moved`.
    pub fn is_even(&mut self, state: &State<f64>, h: f64, moved: f64) -> bool {
        self.look(&|b| BodyState::of(state, b));
        self.nearest();
        self.is_slow(h, moved)
    }

    /// Returns true if the turns of all angles are unambiguous at a position between two others with these angles.
    pub fn is_between(&mut self, state: &State<f64>, ends: [&[f64]; 2]) -> bool {
        self.look(&|b| BodyState::of(state, b));
        let [before, after] = ends;
        if before.len() != self.len() || after.len() != self.len() {
            return false;
        }
        for ((ahead, before), [now, ..]) in self.ahead.iter_mut().zip(before).zip(&self.found) {
            *ahead = counted(*now, *before, *before);
        }
        let is_far =
            |end: &[f64]| self.ahead.iter().zip(end).any(|(now, end)| (now - end).abs() > TURN_TRUST);
        !is_far(before) && !is_far(after)
    }

    /// Checks all these output times at once, from the states of all bodies in lanes; `before` is the time of the
    /// accepted position.
    pub fn are_even(
        &mut self,
        states: &[Lanes],
        (times, before): (&Lanes, f64),
        [first, last]: [usize; 2],
        moved: f64,
    ) -> bool {
        self.kept.copy_from_slice(&self.values);
        let spin = self.spin;
        let count = self.len();
        self.lanes.resize(count * times.len(), 0.0);
        let mut before = before;
        for lane in first..=last {
            self.look(&|b| BodyState::from(|k| states[BodyState::NUMBERS * (b - 1) + k][lane]));
            self.nearest();
            if !self.is_slow(times[lane] - before, moved) {
                self.values.copy_from_slice(&self.kept);
                self.spin = spin;
                return false;
            }
            self.accept();
            self.lanes[lane * count..][..count].copy_from_slice(&self.values);
            before = times[lane];
        }
        true
    }

    /// Accepts the end of the last step.
    pub fn accept(&mut self) {
        std::mem::swap(&mut self.values, &mut self.ahead);
        self.spin = self.spin_ahead;
    }

    /// Measures all angles, and the spin of the bodies.
    fn look(&mut self, state: &dyn Fn(usize) -> BodyState) {
        self.angles.measure(state, &mut self.found);
        self.spin_ahead = self.angles.bodies().iter().map(|b| state(*b).omega.norm()).fold(0.0, f64::max);
    }

    /// Moves every angle to the turn nearest to the accepted position.
    fn nearest(&mut self) {
        for ((ahead, before), [now, ..]) in self.ahead.iter_mut().zip(&self.values).zip(&self.found) {
            *ahead = counted(*now, *before, *before);
        }
    }

    /// Returns true if nothing turns by more than a radian over a step h: neither the drivers together, nor a body, nor
    /// an angle.
    fn is_slow(&self, h: f64, moved: f64) -> bool {
        let mut angles = self.ahead.iter().zip(&self.values).map(|(ahead, before)| (ahead - before).abs());
        // A NaN motion is not slow; a NaN angle is not checked.
        moved <= TURN_TRUST
            && self.spin * h <= TURN_TRUST
            && self.spin_ahead * h <= TURN_TRUST
            && !angles.any(|moved| moved > TURN_TRUST)
    }
}

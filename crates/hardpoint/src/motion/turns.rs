//! Angles counted through whole turns along the path: of measures, and of the coordinates of cut joints that elements
//! act on.
//!
//! An angle is known within a turn only; the path indicates which turn it is in. Between output times an angle is
//! predicted along the drivers, as every unknown is ([`super::walk`]), so that neither the output times nor what the
//! laws do in between have a part in it. From one output time to the next of an even motion an angle moves by less than
//! a radian, or the step is refused ([`TurnCounter::is_even`]).

use hardpoint_tape::Lanes;

use super::BodyState;
use super::kinematics::State;

/// An angle must come within this of its prediction, rad: which turn it is in would otherwise be a guess. Over one step
/// it moves by no more than this to first order, so that half a turn is far away.
pub(super) const TURN_TRUST: f64 = 1.0;
/// Seen from its far end, a step may move an angle by this many times more.
const FAR_END: f64 = 2.5;
/// A step of the drivers below this, rad or sizes, is not refused for an angle: one that has no number on the way, as
/// where the points of a direction meet, jumps there.
pub(super) const FINEST: f64 = 1e-6;

/// One turn, rad.
const TURN: f64 = 2.0 * std::f64::consts::PI;

/// The angle nearest to another that is a whole number of turns from this one; this one, where the other has no number.
pub(crate) fn turned(angle: f64, near: f64) -> f64 {
    // angle + 2 pi k,  k the whole number nearest to (near - angle) / 2 pi
    let turns = ((near - angle) / TURN).round();
    if turns.is_nan() { angle } else { angle + TURN * turns }
}

/// The angle nearest to another; where it has no number, what it was before, so that its turns are not lost.
fn counted(angle: f64, near: f64, before: f64) -> f64 {
    if angle.is_nan() { before } else { turned(angle, near) }
}

/// Angles that only the path counts.
pub(crate) trait CountedAngles {
    /// The bodies that they are measured on, without ground.
    fn bodies(&self) -> &[usize];

    /// Per angle: its value in the design configuration; as it is measured, without a whole turn, where that is `None`.
    fn origins(&self) -> &[Option<f64>];

    /// Value, within a turn, and first two derivatives of every angle, where each of [`bodies`](Self::bodies) is as
    /// `state` says.
    fn measure(&mut self, state: &dyn Fn(usize) -> BodyState, found: &mut [[f64; 3]]);
}

/// The angles that are counted along the path, where the accepted position is.
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
    ahead: Vec<f64>,
    /// Scratch.
    kept: Vec<f64>,
    found: Vec<[f64; 3]>,
}

impl<'m> TurnCounter<'m> {
    /// A counter of these angles.
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

    /// Counts from the design configuration, where the state is.
    pub fn begin(&mut self, state: &State<f64>) {
        self.look(&|b| BodyState::of(state, b));
        for ((value, [now, ..]), origin) in self.values.iter_mut().zip(&self.found).zip(self.angles.origins())
        {
            *value = turned(*now, origin.unwrap_or(*now));
        }
        self.spin = self.spin_ahead;
    }

    /// The accepted position once more, with the rates that the bodies have on another path.
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

    /// Returns whether each angle, where the state is after a step, is in the turn that was predicted. `predict` is
    /// given an angle; of what it returns the first is by how much the angle moves as seen from the accepted position,
    /// the second as seen from the new one, both to second order, and the third the farthest that it gets as seen from
    /// there, to first order.
    pub fn follow(&mut self, state: &State<f64>, predict: impl Fn(usize) -> [f64; 3]) -> bool {
        self.look(&|b| BodyState::of(state, b));
        let mut sure = true;
        for (i, [now, ..]) in self.found.iter().enumerate() {
            let (before, [ahead, back, far]) = (self.values[i], predict(i));
            let near = before + if ahead.is_finite() { ahead } else { 0.0 };
            self.ahead[i] = counted(*now, near, before);
            let moved = self.ahead[i] - before;
            // Written so that an angle without a number is no matter of turns.
            let doubtful = (self.ahead[i] - near).abs() > TURN_TRUST
                || (moved - back).abs() > FAR_END * TURN_TRUST
                || far > FAR_END * TURN_TRUST;
            sure &= now.is_nan() || !doubtful;
        }
        sure
    }

    /// Returns whether a step h from one output time to the next, over which the drivers move by so much in all, leaves
    /// no doubt about the turns of any angle where the state is then.
    pub fn is_even(&mut self, state: &State<f64>, h: f64, moved: f64) -> bool {
        self.look(&|b| BodyState::of(state, b));
        self.nearest();
        self.is_slow(h, moved)
    }

    /// The same over all these output times at once, by the numbers of all bodies in lanes; `before` is the time of the
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

    /// Takes every angle in the turn that is nearest to the accepted position.
    fn nearest(&mut self) {
        for ((ahead, before), [now, ..]) in self.ahead.iter_mut().zip(&self.values).zip(&self.found) {
            *ahead = counted(*now, *before, *before);
        }
    }

    /// Returns whether over a step h nothing turns by more than a radian: neither the drivers together, nor a body, nor
    /// an angle.
    fn is_slow(&self, h: f64, moved: f64) -> bool {
        let mut angles = self.ahead.iter().zip(&self.values).map(|(ahead, before)| (ahead - before).abs());
        // Written so that NaN of the motion is not slow, and an angle without a number is no matter of turns.
        moved <= TURN_TRUST
            && self.spin * h <= TURN_TRUST
            && self.spin_ahead * h <= TURN_TRUST
            && !angles.any(|moved| moved > TURN_TRUST)
    }
}

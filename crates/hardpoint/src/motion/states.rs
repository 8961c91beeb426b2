//! Results of a motion: the states of the bodies at its output times, and the effort of the solver.

use super::execution::StepMethod;
use super::gap::Assembly;
use super::kinematics::State;
use super::margin::Margin;
use crate::blocks::{Blocks, MergedRow, ResultRow, merged};
use crate::model::{BodyId, JointId, Model};
use crate::space::{Mat3, Pose, Quat, Real, Vec3};

/// State of a body in global components; position, velocity and acceleration are those of the origin of its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Position, m.
    pub r: Vec3,
    /// Orientation A: body to global components.
    pub rotation: Mat3,
    /// Velocity, m/s.
    pub v: Vec3,
    /// Angular velocity, rad/s.
    pub omega: Vec3,
    /// Acceleration, m/s^2.
    pub a: Vec3,
    /// Angular acceleration, rad/s^2.
    pub alpha: Vec3,
}

impl BodyState {
    /// Ground.
    pub const GROUND: Self = Self {
        r: Vec3::ZERO,
        rotation: Mat3::IDENTITY,
        v: Vec3::ZERO,
        omega: Vec3::ZERO,
        a: Vec3::ZERO,
        alpha: Vec3::ZERO,
    };
    /// Number of values.
    pub(crate) const NUMBERS: usize = 24;
    /// Place of the angular velocity among these.
    const OMEGA: usize = 15;

    /// Position and orientation.
    #[inline]
    pub fn pose(&self) -> Pose {
        Pose { rot: self.rotation, r: self.r }
    }

    /// r, the columns of A, v, omega, a and alpha, one after the other.
    #[inline(always)]
    pub(crate) fn numbers(&self) -> impl Iterator<Item = f64> {
        let [x, y, z] = self.rotation.cols;
        let all = [self.r, x, y, z, self.v, self.omega, self.a, self.alpha];
        all.into_iter().flat_map(Vec3::to_array)
    }

    /// A body at rest in its design configuration.
    pub fn at_design(model: &Model, body: BodyId) -> Self {
        let frame = model.bodies[body.0].frame;
        let o = Vec3::ZERO;
        Self { r: frame.r, rotation: frame.rot, v: o, omega: o, a: o, alpha: o }
    }

    /// Orientation as a quaternion `[w, x, y, z]` with w >= 0.
    pub fn quaternion(&self) -> [f64; 4] {
        Quat::from_rotation(self.rotation).to_array()
    }

    /// State of body b.
    #[inline(always)]
    pub(crate) fn of<T: Real>(state: &State<T>, b: usize) -> Self {
        let numbers = Self::numbers_of(state, b);
        Self::from(|k| numbers[k].value())
    }

    /// From r, the columns of A, v, omega, a and alpha, one after the other.
    #[inline(always)]
    pub(crate) fn from(number: impl Fn(usize) -> f64) -> Self {
        let vector = |k: usize| Vec3::new(number(3 * k), number(3 * k + 1), number(3 * k + 2));
        let rotation = Mat3 { cols: [vector(1), vector(2), vector(3)] };
        Self { r: vector(0), rotation, v: vector(4), omega: vector(5), a: vector(6), alpha: vector(7) }
    }

    /// Values of all bodies but ground, number by number.
    pub(crate) fn all<T: Real>(state: &State<T>) -> Vec<T> {
        (1..state.pose.len()).flat_map(|b| Self::numbers_of(state, b)).collect()
    }

    /// Values of body b: r, the columns of A, v, omega, a and alpha, one after the other.
    #[inline(always)]
    fn numbers_of<T: Real>(state: &State<T>, b: usize) -> [T; Self::NUMBERS] {
        let [v, a, _] = &state.motion.twists;
        let (pose, v, a) = (&state.pose[b], v[b], a[b]);
        let (r, [f, g, h]) = (pose.r, pose.rot.cols);
        // r. = V at r = V_v + omega x r,    r.. = A at r + omega x r.
        let u = v.at(r);
        let n = a.at(r) + v.w.cross(u);
        let (o, e) = (v.w, a.w);
        [
            r.x, r.y, r.z, f.x, f.y, f.z, g.x, g.y, g.z, h.x, h.y, h.z, u.x, u.y, u.z, o.x, o.y, o.z, n.x,
            n.y, n.z, e.x, e.y, e.z,
        ]
    }
}

/// Motion at the output times; fewer of them if the run was stopped.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// Output times that were solved, s.
    pub times: Vec<f64>,
    /// Number of bodies, ground included.
    pub bodies: usize,
    /// States of all bodies but ground, one after the other.
    pub(crate) states: Blocks,
    /// Coordinates of the tree.
    pub(crate) coordinates: Blocks,
    /// Value and derivatives of every predicted quantity, from which positions between output times are predicted;
    /// `None` if they do not determine the path there, or if nothing is asked of it.
    pub(crate) channels: Option<Blocks>,
    /// Per output time: distance from a singular position; empty if only the bodies were requested.
    pub margins: Vec<Margin>,
    /// Assembly before the motion, if the mechanism was open in the design configuration.
    pub assembly: Option<Assembly>,
    /// Next singular position after its end, if one is near.
    pub beyond: Option<SingularPosition>,
    /// Per output time: the angles that are counted along the path, with all turns, rad; empty if the path was not
    /// followed.
    pub(crate) counted: Vec<f64>,
    /// Statistics of the solver.
    pub effort: SolverStatistics,
    /// Method that solved the smooth steps.
    pub solved_by: Option<StepMethod>,
}

/// States of all bodies at one output time.
#[derive(Clone, Copy, Debug)]
pub struct States<'m> {
    row: ResultRow<'m>,
    bodies: usize,
}

impl<'m> States<'m> {
    /// State of body b; body 0 is ground.
    ///
    /// # Panics
    /// Panics if there is no such body.
    #[inline]
    pub fn body(self, b: usize) -> BodyState {
        if b == 0 {
            return BodyState::GROUND;
        }
        BodyState::from(|k| self.row.get(BodyState::NUMBERS * (b - 1) + k))
    }

    /// Angular velocity of body b.
    #[inline]
    pub(crate) fn omega(self, b: usize) -> Vec3 {
        let Some(others) = b.checked_sub(1) else { return Vec3::ZERO };
        let first = BodyState::NUMBERS * others + BodyState::OMEGA;
        Vec3::new(self.row.get(first), self.row.get(first + 1), self.row.get(first + 2))
    }

    /// States, body by body.
    pub fn iter(self) -> impl Iterator<Item = BodyState> + 'm {
        (0..self.bodies).map(move |b| self.body(b))
    }
}

/// A singular position ahead of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct SingularPosition {
    /// Time after the last output time, s.
    pub after: f64,
    /// Travel of each driver until then, m or rad.
    pub travel: Vec<f64>,
    /// Kind of the position.
    pub kind: SingularityKind,
    /// The joints of the loop.
    pub joints: Vec<JointId>,
}

/// Kind of a singular position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SingularityKind {
    /// The loop cannot be closed any further.
    Limit,
    /// Two motions meet.
    TwoMotions,
}

/// Effort of a solution, and the residuals of the constraints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolverStatistics {
    /// Output steps solved.
    pub steps: usize,
    /// Steps between output times that the predictor needed.
    pub substeps: usize,
    /// Output steps that were solved by a program instead of the kernel.
    pub by_program: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Iterations on the openings of elastic joints.
    pub equilibrium_iterations: usize,
    /// First output time whose equilibrium is not certainly stable, s: some virtual motion releases work, but the
    /// forces have no potential, so that this proves nothing.
    pub uncertain_stability: Option<f64>,
    /// Largest residual of any constraint row at an output step, redundant rows included; m or rad.
    pub worst_residual: f64,
    /// Smallest ratio of smallest to largest pivot: 0 at a singular position.
    pub least_pivot_ratio: f64,
    /// Time of this pivot ratio.
    pub least_pivot_time: f64,
}

impl SolverStatistics {
    /// Updates the smallest pivot ratio so far.
    #[inline(always)]
    pub(crate) fn note_pivots(&mut self, ratios: impl Iterator<Item = f64>, t: f64) {
        for ratio in ratios {
            if ratio < self.least_pivot_ratio {
                (self.least_pivot_ratio, self.least_pivot_time) = (ratio, t);
            }
        }
    }
}

impl Motion {
    /// Minimum margin of the motion, and its output time.
    pub fn least_margin(&self) -> Option<(usize, Margin)> {
        self.margins.iter().copied().enumerate().min_by(|a, b| a.1.value.total_cmp(&b.1.value))
    }

    /// Greatest angular speed of a body at any output time, rad/s.
    pub(crate) fn fastest(&self, body: BodyId) -> f64 {
        let Some(others) = body.0.checked_sub(1) else { return 0.0 };
        self.states.largest_square(BodyState::NUMBERS * others + BodyState::OMEGA, self.len()).sqrt()
    }

    /// Angles counted along the path at output time k.
    pub(crate) fn counted_at(&self, k: usize) -> &[f64] {
        let width = self.counted.len() / self.len();
        &self.counted[k * width..][..width]
    }

    /// Inserts output times of another motion of the same design, in this order of rows.
    pub(crate) fn insert(&mut self, added: &Self, rows: &[MergedRow]) {
        self.states.merge(&added.states, rows);
        self.coordinates.merge(&added.coordinates, rows);
        match (&mut self.channels, &added.channels) {
            (Some(channels), Some(added)) => channels.merge(added, rows),
            (channels, _) => *channels = None,
        }
        let steps = self.len();
        self.margins = merged(&self.margins, &added.margins, self.margins.len() / steps, rows);
        self.counted = merged(&self.counted, &added.counted, self.counted.len() / steps, rows);
        self.times = merged(&self.times, &added.times, 1, rows);
    }

    /// States of all bodies at output time k.
    pub fn at(&self, k: usize) -> States<'_> {
        States { row: self.states.row(k), bodies: self.bodies }
    }

    /// States of all bodies at all output times that were solved, time by time.
    pub fn states(&self) -> impl Iterator<Item = BodyState> {
        (0..self.len()).flat_map(|k| self.at(k).iter())
    }

    /// Writes the state of a body but ground at output time k.
    #[inline(always)]
    pub fn set(&mut self, k: usize, body: BodyId, state: &BodyState) {
        self.states.set(k, BodyState::NUMBERS * (body.0 - 1), state.numbers());
    }

    /// The coordinates of the tree at output time k, m or rad, angles unwrapped; 0 for those of a ball.
    pub fn coordinates(&self, k: usize) -> impl Iterator<Item = f64> {
        self.coordinates.row(k).all()
    }

    /// Number of solved output times.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// True if not even the first output time was solved.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }
}

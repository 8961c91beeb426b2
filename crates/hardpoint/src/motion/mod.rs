//! Position, velocity and acceleration of every body over time.
//!
//! One step is: Newton on each block in turn, then velocity and acceleration from the same factors
//! ([`kinematics`]). Output times that follow each other closely are stepped through as they
//! are ([`stepper`], [`abreast`]); everywhere else the path is followed in steps of its own ([`walk`]).

pub(crate) mod abreast;
mod assembly;
mod forecast;
pub(crate) mod jerk;
pub(crate) mod kinematics;
pub(crate) mod margin;
pub(crate) mod parts;
mod singularity;
pub(crate) mod stepper;
mod stop;
pub(crate) mod tape;
mod walk;

pub use assembly::{Assembly, Closing, Gap, Moved};
pub use jerk::BodyJerk;
pub use margin::Margin;
pub use stop::{Stop, StopKind};
pub use tape::Execution;

use crate::model::{BodyId, JointId, Model};
use crate::space::{LANES, Mat3, Quat, Real, Vec3};

use kinematics::State;

/// How a body stands and moves, in global components; position, velocity and acceleration are those of
/// its frame's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)] // filled in the order of the fields
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

    /// Gives the states of the wanted bodies but ground in every lane to `out(lane, body, state)`.
    #[inline(always)]
    pub(crate) fn each<T: Real>(state: &State<T>, wanted: &[bool], mut out: impl FnMut(usize, BodyId, Self)) {
        let mut table = [[0.0; 24]; LANES];
        for b in 1..state.pose.len() {
            if !wanted[b] {
                continue;
            }
            let components = Self::components(state, b);
            turn_over(&components, &mut table);
            for (lane, x) in table[..T::LANES].iter().enumerate() {
                out(lane, BodyId(b), Self::from_components(x));
            }
        }
    }

    /// Of body b: r, the columns of A, v, omega, a and alpha, one after the other.
    #[inline(always)]
    fn components<T: Real>(state: &State<T>, b: usize) -> [[T; 8]; 3] {
        let (pose, v, a) = (&state.pose[b], state.v[b], state.a[b]);
        let (r, [f, g, h]) = (pose.r, pose.rot.cols);
        let u = v.at(r);
        let n = a.at(r) + v.w.cross(u);
        let (o, e) = (v.w, a.w);
        [
            [r.x, r.y, r.z, f.x, f.y, f.z, g.x, g.y],
            [g.z, h.x, h.y, h.z, u.x, u.y, u.z, o.x],
            [o.y, o.z, n.x, n.y, n.z, e.x, e.y, e.z],
        ]
    }

    /// From r, the columns of A, v, omega, a and alpha, one after the other.
    #[inline(always)]
    fn from_components(x: &[f64; 24]) -> Self {
        let vector = |k: usize| Vec3::new(x[3 * k], x[3 * k + 1], x[3 * k + 2]);
        let rotation = Mat3 { cols: [vector(1), vector(2), vector(3)] };
        Self { r: vector(0), rotation, v: vector(4), omega: vector(5), a: vector(6), alpha: vector(7) }
    }
}

/// From components side by side by lane to lanes side by side by component.
#[inline(always)]
pub(crate) fn turn_over<T: Real>(components: &[[T; 8]; 3], table: &mut [[f64; 24]; LANES]) {
    for (k, eight) in components.iter().enumerate() {
        T::each_lane(eight, |lane, x| table[lane][8 * k..8 * k + 8].copy_from_slice(x));
    }
}

/// A solved history. It may be shorter than the model's output times: then something stopped it.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// Output times that were solved, s.
    pub times: Vec<f64>,
    /// `states[k * bodies + b]` at time k of body b; body 0 is ground.
    pub states: Vec<BodyState>,
    /// How many bodies there are, ground included.
    pub bodies: usize,
    /// `coordinates[k * n + c]`: tree coordinates, m or rad, angles unwrapped; 0 for those of a ball.
    pub coordinates: Vec<f64>,
    /// Per output time, how far from a singular position; empty where only the bodies were asked for.
    pub margins: Vec<Margin>,
    /// How it was closed before it moved, if it was open as drawn.
    pub assembly: Option<Assembly>,
    /// The singular position next after its end, if one is near.
    pub beyond: Option<Singular>,
    /// Places that were passed on the way to an output time, by its number, of the bodies whose turns only the path tells.
    pub(crate) passed: Vec<(usize, Passed)>,
    /// What it took.
    pub effort: Effort,
}

/// A singular position ahead of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Singular {
    /// How long after the last output time, s.
    pub after: f64,
    /// How far each driver moves until then, m or rad.
    pub travel: Vec<f64>,
    /// [`StopKind::Limit`], or [`StopKind::BranchChange`] where two motions meet.
    pub kind: StopKind,
    /// The joints of the loop.
    pub joints: Vec<JointId>,
}

/// A place between output times.
#[derive(Clone, Debug)]
pub(crate) struct Passed {
    /// When, on the path that it belongs to: the time, or from 0 to 1 on a straight one.
    pub time: f64,
    /// Whether another path begins here.
    pub begins: bool,
    /// Where the bodies are that were asked for.
    pub states: Vec<(BodyId, BodyState)>,
}

/// What a solution took, and how well the constraints hold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    /// Output steps solved.
    pub steps: usize,
    /// Steps in between that the predictor needed.
    pub substeps: usize,
    /// Output steps that a straight-line program has solved in place of the kernel.
    pub by_program: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Largest residual of any constraint row at an output step, redundant rows included; m or rad.
    pub worst_residual: f64,
    /// Smallest ratio of smallest to largest pivot: 0 at a singular position.
    pub least_pivot_ratio: f64,
    /// Time of that.
    pub least_pivot_time: f64,
}

impl Motion {
    /// The least margin of the motion, and the output time that has it.
    pub fn least_margin(&self) -> Option<(usize, Margin)> {
        self.margins.iter().copied().enumerate().min_by(|a, b| a.1.value.total_cmp(&b.1.value))
    }

    /// States of all bodies at output time k.
    pub fn at(&self, k: usize) -> &[BodyState] {
        &self.states[k * self.bodies..(k + 1) * self.bodies]
    }

    /// How many output times were solved.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether not even the first output time was solved.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }
}

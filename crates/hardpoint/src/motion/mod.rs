//! Position, velocity and acceleration of every body over time.
//!
//! One step is: Newton on each block in turn, then velocity and acceleration from the same factors
//! ([`kinematics`]). The steps are joined by a second-order predictor that watches for limits and
//! branches ([`stepper`]).

mod assembly;
pub(crate) mod kinematics;
pub(crate) mod margin;
pub(crate) mod parts;
pub(crate) mod stepper;
mod stop;

pub use assembly::{Assembly, Closing, Gap, Moved};
pub use margin::Margin;
pub use stop::{Stop, StopKind};

use crate::model::{BodyId, Model};
use crate::space::{LANES, Mat3, Quat, Real, Vec3};

use kinematics::State;

/// How a body stands and moves, in global components; position, velocity and acceleration are those of
/// its frame's origin.
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

    /// Gives the state of body `b` in every lane to `out`, lane 0 first.
    pub(crate) fn each_lane<T: Real>(
        state: &State<T>,
        b: usize,
        lanes: usize,
        mut out: impl FnMut(usize, Self),
    ) {
        // Per component, all lanes: stored wide, read narrow.
        let mut table = [[0.0; LANES]; 24];
        state.witness.within(
            #[inline(always)]
            || {
                let (pose, v, a) = (state.pose[b], state.v[b], state.a[b]);
                let [f, g, h] = pose.rot.cols;
                let velocity = v.at(pose.r);
                let acceleration = a.at(pose.r) + v.w.cross(velocity);
                for (k, x) in [pose.r, f, g, h, velocity, v.w, acceleration, a.w].iter().enumerate() {
                    x.x.store(&mut table[3 * k]);
                    x.y.store(&mut table[3 * k + 1]);
                    x.z.store(&mut table[3 * k + 2]);
                }
            },
        );
        for lane in 0..lanes {
            let vector =
                |k: usize| Vec3::new(table[3 * k][lane], table[3 * k + 1][lane], table[3 * k + 2][lane]);
            let rotation = Mat3 { cols: [vector(1), vector(2), vector(3)] };
            let [r, v, omega, a, alpha] = [vector(0), vector(4), vector(5), vector(6), vector(7)];
            out(lane, Self { r, rotation, v, omega, a, alpha });
        }
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
    /// What it took.
    pub effort: Effort,
}

/// What a solution took, and how well the constraints hold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    /// Output steps solved.
    pub steps: usize,
    /// Steps in between that the predictor needed.
    pub substeps: usize,
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

    /// Where the motion would become singular beyond its end if the margin went on falling as it does over the last step, s
    /// after the last output time; `None` where it does not fall.
    pub fn singular_after(&self) -> Option<f64> {
        let n = self.margins.len();
        let (before, last) = (self.margins.get(n.checked_sub(2)?)?.value, self.margins[n - 1].value);
        let step = self.times[n - 1] - self.times[n - 2];
        (last < before).then(|| step * last / (before - last))
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

//! Stored motion of a source, for comparison.

use hardpoint::Solution;
use hardpoint::joint::Quantity;
use hardpoint::model::BodyId;
use hardpoint::space::{Pose, Vec3};
use hardpoint_file::ModelFile;

/// Tolerance of equal times, absolute (s) or relative: files have about ten digits.
const SAME_TIME: f64 = 1e-9;

/// Stored motion of a source's bodies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Output times, s.
    pub times: Vec<f64>,
    /// Poses at the output times by the name of the body in the model file; lengths in the unit of the file.
    pub bodies: Vec<(String, Vec<StoredPose>)>,
}

/// State of a body at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredPose {
    /// Pose of its frame.
    pub pose: Pose,
    /// Velocity of the frame's origin, angular velocity, acceleration and angular acceleration, as far as they are
    /// stored.
    pub rates: [Option<Vec3>; 4],
}

/// Maximum differences of a solution from the stored motion, over all bodies and times.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Difference {
    /// Number of compared times.
    pub times: usize,
    /// Difference of positions, in the unit of the file.
    pub place: f64,
    /// Difference of orientations, rad.
    pub turn: f64,
    /// Differences of velocities, angular velocities, accelerations and angular accelerations, in the file's unit of
    /// length, rad and s.
    pub rates: [f64; 4],
    /// Largest values of those.
    pub largest: [f64; 4],
}

impl Series {
    /// Compares a solution of the model with the stored motion at their common times.
    pub fn compare(&self, file: &ModelFile, solution: &Solution) -> Difference {
        let unit = file.units.of(Quantity::Length).1;
        let mut out = Difference::default();
        for step in 0..solution.motion.len() {
            let time = file.model.times[step];
            let same = |t: &f64| (t - time).abs() <= SAME_TIME * time.abs().max(1.0);
            let Some(k) = self.times.iter().position(same) else { continue };
            out.times += 1;
            for (name, stored) in &self.bodies {
                let body = file.model.bodies.iter().position(|b| b.name == *name);
                let (Some(body), Some(stored)) = (body, stored.get(k)) else { continue };
                let state = solution.body(step, BodyId(body));
                out.place = out.place.max((state.r * unit - stored.pose.r).norm());
                out.turn = out.turn.max(state.rotation.angle_to(stored.pose.rot));
                let ours = [state.v * unit, state.omega, state.a * unit, state.alpha];
                for (k, theirs) in stored.rates.iter().enumerate() {
                    let Some(theirs) = theirs else { continue };
                    out.rates[k] = out.rates[k].max((ours[k] - *theirs).norm());
                    out.largest[k] = out.largest[k].max(theirs.norm());
                }
            }
        }
        out
    }
}

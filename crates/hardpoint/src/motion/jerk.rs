//! Third time derivatives: the equation of order 2 with the factors that the acceleration leaves.

use crate::number;
use crate::space::Vec3;

use super::kinematics::State;
use super::mechanism::Mechanism;

/// Third time derivatives of one body's motion, global components.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyJerk {
    /// Jerk of its frame's origin, the rate of its acceleration, m/s^3.
    pub jerk: Vec3,
    /// Angular jerk, the rate of its angular acceleration, rad/s^3.
    pub angular: Vec3,
}

impl BodyJerk {
    /// Jerks of all bodies at the position of a mechanism, at time t.
    pub(crate) fn all(mechanism: &mut Mechanism<'_>, t: f64) -> impl Iterator<Item = Self> {
        let Mechanism { state, topology, parts, .. } = mechanism;
        state.jerk(topology, |d| parts.law_of(d.0).at(t).ddd());
        let state = &*state;
        (0..state.pose.len()).map(|body| Self::of(state, body))
    }

    /// `r... = B at r + 2 alpha x r. + omega x r..` (`docs/theory.md` (21)).
    fn of(state: &State<f64>, body: usize) -> Self {
        let [v, a, b] = number::each(&[0, 1, 2], |n| state.motion.twists[n][body]);
        let r = state.pose[body].r;
        // r.   = V at r,    r..  = A at r + omega x r.
        // The rate of r.., with B at r = B_v + B_w x r:
        // r... = B at r + 2 alpha x r. + omega x r..                                                              (21)
        let velocity = v.at(r);
        let acceleration = a.at(r) + v.w.cross(velocity);
        let jerk = b.at(r) + a.w.cross(velocity) * 2.0 + v.w.cross(acceleration);
        Self { jerk, angular: b.w }
    }
}

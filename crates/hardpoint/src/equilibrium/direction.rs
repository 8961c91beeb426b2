//! Names of the directions in which a mechanism deflects.

use crate::model::{BodyPoint, DriverId, HardpointId, JointId, Model};
use crate::motion::{AxisMotion, GivingDirection};
use crate::space::{Twist, Vec3};

/// Part of a motion, in rad and sizes of the mechanism, that is left out of its name: a rotation about an axis a
/// thousand sizes away is a translation, and an axis passes a point that is a thousandth of the size beside it.
const NEGLIGIBLE: f64 = 1e-3;
/// Part of the largest opening of a joint up to which its others are left out of the name of the motion.
const BESIDE: f64 = 0.1;
/// Difference of equal numbers, as a fraction of the larger one: the first of them is named.
const TIE: f64 = 1e-6;

/// Openings of a mechanism at a position.
pub(super) struct NamedOpenings<'a> {
    pub model: &'a Model,
    pub openings: &'a [DriverId],
    /// Number of the user's drivers, which come first.
    pub own_drivers: usize,
    /// Per driver: 1 rad, or the size of its loop.
    pub units: &'a [f64],
    /// Per point: global position, m.
    pub points: Vec<Vec3>,
    /// Size of the mechanism, m.
    pub size: f64,
}

impl NamedOpenings<'_> {
    /// Names a motion by the speeds of the openings and the twists of the bodies. If no force resists it (`is_free`)
    /// it is exactly that motion; a joint is otherwise named by its largest opening. `None` without openings.
    pub fn name(&self, speeds: &[f64], twists: &[Twist], is_free: bool) -> Option<GivingDirection> {
        let size = |k: usize| speeds[k].abs() / self.units[self.openings[k].0];
        let moves = |k: usize| match self.body_motion_of(k, twists) {
            Some((motion, place)) => self.extent(motion, place),
            None => size(k),
        };
        let k = first_largest((0..speeds.len()).map(moves))?;
        let driver = &self.model.drivers[self.openings[k].0];
        if self.openings[k].0 < self.own_drivers {
            return Some(GivingDirection::Driver(self.openings[k]));
        }
        let joint = &self.model.joints[driver.joint.0];
        if let Some((motion, place)) = self.body_motion_of(k, twists) {
            return Some(GivingDirection::Body(joint.bodies[1], self.axis_motion(motion, place)));
        }
        let others = (0..speeds.len()).filter(|o| *o != k && self.joint_of(*o) == Some(driver.joint));
        if is_free && others.map(size).any(|other| other > BESIDE * size(k)) {
            let motion = relative(twists, joint.bodies.map(|b| b.0));
            let motion = self.axis_motion(motion, joint.at[0]);
            return Some(GivingDirection::JointMotion(driver.joint, motion));
        }
        Some(GivingDirection::Joint(driver.joint, joint.kind.coordinates[driver.coordinate].name))
    }

    /// Joint of an opening; `None` for a released driver.
    fn joint_of(&self, k: usize) -> Option<JointId> {
        let driver = self.openings[k];
        (driver.0 >= self.own_drivers).then(|| self.model.drivers[driver.0].joint)
    }

    /// Twist of the body that an opening places relative to ground, if it belongs to no joint of the user, and a place
    /// of the body.
    fn body_motion_of(&self, k: usize, twists: &[Twist]) -> Option<(Twist, HardpointId)> {
        let joint = &self.model.joints[self.joint_of(k)?.0];
        joint.unnamed.then(|| (relative(twists, joint.bodies.map(|b| b.0)), joint.at[0]))
    }

    /// Direction of the axis of a rotation; `None` for a translation of this place of the mechanism.
    fn axis(&self, motion: Twist, place: HardpointId) -> Option<Vec3> {
        // abs(w) L <= 1e-3 abs(v): a translation
        let there = motion.at(self.model.position(place));
        motion.w.unit().filter(|_| motion.w.norm() * self.size > NEGLIGIBLE * there.norm())
    }

    /// Size of a motion, rad or sizes of the mechanism: of the rotation about its axis, and along the axis.
    fn extent(&self, motion: Twist, place: HardpointId) -> f64 {
        match self.axis(motion, place) {
            Some(axis) => f64::max(motion.w.norm(), motion.v.dot(axis).abs() / self.size),
            None => motion.at(self.model.position(place)).norm() / self.size,
        }
    }

    /// Motion of a place of the mechanism, by its axis.
    fn axis_motion(&self, motion: Twist, place: HardpointId) -> AxisMotion {
        let Some(axis) = self.axis(motion, place) else {
            let along = motion.at(self.model.position(place)).unit().unwrap_or(Vec3::ZERO);
            return AxisMotion { axis: along, rotates: false, slides: true, through: None };
        };
        let along = axis * motion.v.dot(axis);
        let near = NEGLIGIBLE * self.size * motion.w.norm();
        let is_on_axis = |(point, at): &(&BodyPoint, &Vec3)| {
            !self.model.hardpoints[point.at.0].unnamed && (motion.at(**at) - along).norm() <= near
        };
        let through = self.model.points.iter().zip(&self.points).find(is_on_axis).map(|(point, _)| point.at);
        AxisMotion { axis, rotates: true, slides: along.norm() > near, through }
    }
}

/// Twist of body j relative to body i.
fn relative(twists: &[Twist], [i, j]: [usize; 2]) -> Twist {
    twists[j] - twists[i]
}

/// Index of the largest number; of the first one if several are equal up to round-off. `None` if there are none.
pub(super) fn first_largest(numbers: impl Iterator<Item = f64>) -> Option<usize> {
    let larger = |best: (usize, f64), next: (usize, f64)| {
        if next.1 > (1.0 + TIE) * best.1 { next } else { best }
    };
    Some(numbers.enumerate().reduce(larger)?.0)
}

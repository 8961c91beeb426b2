//! Placements of bodies at which the assembly starts: those of another assembly of the same mechanism.

use crate::space::{Mat3, Pose, Quat, Vec3};

use super::{BodyId, Model};

/// Displacement of a body from its place in the design configuration to the place at which the assembly starts.
///
/// The mechanism is closed from there, with all drivers at zero, so that it is on another branch than the one of the
/// design configuration. A changed design starts with the same joint coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartPlacement {
    /// The body.
    pub body: BodyId,
    /// Rigid displacement of its points, global: `x -> R x + r`, m.
    pub displacement: Pose,
}

impl StartPlacement {
    /// Displacement by a rotation vector, rad, about the global origin, then by a translation, m.
    pub fn new(body: BodyId, turn: Vec3, shift: Vec3) -> Self {
        Self { body, displacement: Pose { rot: Mat3::from_rotation_vector(turn), r: shift } }
    }

    /// Displacement that brings a body from one pose to another.
    pub(crate) fn between(body: BodyId, from: Pose, to: Pose) -> Self {
        // X_1 = T X_0
        Self { body, displacement: to.compose(from.inverse()) }
    }

    /// Rotation vector of the displacement, rad, of length 0 to pi.
    pub fn turn(&self) -> Vec3 {
        Quat::from_rotation(self.displacement.rot).rotation_vector()
    }

    /// Translation after the rotation about the global origin, m.
    pub fn shift(&self) -> Vec3 {
        self.displacement.r
    }
}

impl Model {
    /// The same mechanism in another assembly: bodies without an entry start in their places in the design
    /// configuration.
    #[must_use]
    pub fn starting_at(&self, placements: &[StartPlacement]) -> Self {
        Self { start: placements.to_vec(), ..self.clone() }
    }

    /// The same mechanism with all drivers in the opposite sense, in all cases.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let mut model = self.clone();
        model.drivers.iter_mut().for_each(|driver| driver.is_reversed = !driver.is_reversed);
        model
    }

    /// Pose at which the assembly of a body starts.
    pub(crate) fn start_pose(&self, body: BodyId) -> Pose {
        let frame = self.bodies[body.0].frame;
        match self.start.iter().find(|start| start.body == body) {
            Some(start) => start.displacement.compose(frame),
            None => frame,
        }
    }
}

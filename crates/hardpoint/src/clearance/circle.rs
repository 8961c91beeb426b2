//! Circles.

use crate::space::{Real, Vec3};

/// A circle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circle<T = f64> {
    /// Centre.
    pub centre: Vec3<T>,
    /// Unit vector perpendicular to its plane.
    pub axis: Vec3<T>,
    /// Radius.
    pub radius: T,
}

impl<T: Real> Circle<T> {
    /// The circle, moved along its axis.
    pub fn moved(&self, by: T) -> Self {
        Self { centre: self.centre + self.axis * by, ..*self }
    }

    /// The plain numbers.
    pub fn value(&self) -> Circle {
        Circle { centre: self.centre.value(), axis: self.axis.value(), radius: self.radius.value() }
    }
}

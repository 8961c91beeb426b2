//! Extent of points, for tolerances that do not depend on the units of a model.

use crate::space::Vec3;

/// Joints nearer to each other than this part of the mechanism's size are at one place.
pub(super) const ONE_PLACE: f64 = 1e-12;

/// The box around some points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    low: Vec3,
    high: Vec3,
}

impl Extent {
    pub fn of(points: impl Iterator<Item = Vec3>) -> Self {
        let low = Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY);
        let mut extent = Self { low, high: -low };
        points.for_each(|p| extent.include(p));
        extent
    }

    pub fn include(&mut self, p: Vec3) {
        let (low, high) = (self.low, self.high);
        self.low = Vec3::new(low.x.min(p.x), low.y.min(p.y), low.z.min(p.z));
        self.high = Vec3::new(high.x.max(p.x), high.y.max(p.y), high.z.max(p.z));
    }

    /// Diagonal; 1 where that is no length to compare with.
    pub fn size(&self) -> f64 {
        let size = self.size_or_zero();
        if size > 0.0 { size } else { 1.0 }
    }

    /// Diagonal; 0 where there is no point, or none that is finite, or where they coincide up to round-off: their
    /// differences have no significant digits then.
    pub fn size_or_zero(&self) -> f64 {
        let size = (self.high - self.low).norm();
        let far = f64::max(self.low.norm(), self.high.norm());
        if size.is_finite() && self.low.x <= self.high.x && size > ONE_PLACE * far { size } else { 0.0 }
    }
}

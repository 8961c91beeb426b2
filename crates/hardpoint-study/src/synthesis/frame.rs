//! Coordinates in which a task has size 1 and its middle at 0.

use hardpoint_planar::linkage::Linkage;
use hardpoint_planar::plane::{Complex, Displacement};

/// Poses whose origins are nearer than this part of the size, and whose angles than this, rad, coincide.
pub(super) const COINCIDE: f64 = 1e-9;

/// A similarity between the task and its own coordinates, in which it has size 1 and its middle at 0.
pub(super) struct Frame {
    pub middle: Complex,
    pub size: f64,
    /// Direction of x of its own coordinates.
    pub x: Complex,
}

impl Frame {
    pub fn inward(&self, p: Complex) -> Complex {
        ((p - self.middle) * self.x.conjugate()).times(1.0 / self.size)
    }

    pub fn outward(&self, p: Complex) -> Complex {
        (p * self.x).times(self.size) + self.middle
    }

    /// The same displacement in coordinates of the task.
    pub fn displacement_outward(&self, of: Displacement) -> Displacement {
        let middle = self.inward(Complex::ZERO);
        Displacement { turn: of.turn, shift: self.outward(of.of(middle)) }
    }

    pub fn linkage_outward(&self, linkage: &Linkage) -> Linkage {
        linkage.moved(|p| self.outward(p), |n| n * self.x)
    }
}

/// Largest distance between two points.
pub(super) fn extent(points: &[Complex]) -> f64 {
    let from = |p: &Complex| points.iter().map(|q| (*p - *q).norm()).fold(0.0, f64::max);
    points.iter().map(from).fold(0.0, f64::max)
}

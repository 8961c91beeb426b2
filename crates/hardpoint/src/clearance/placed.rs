//! Shapes of a model at poses of its bodies, and the nearest pair of a clearance.

use crate::design::{BodyFixed, ShapeGeometry};
use crate::model::{BodyId, ClearanceId, Model, PointId, ShapeId, ShapeKind};
use crate::space::{Pose, Real, Vec3};

use super::core::{Circle, Core};
use super::nearest::{Nearest, nearest};

/// The shapes of a model where its bodies are.
#[derive(Clone, Copy)]
pub(crate) struct PlacedShapes<'a, T> {
    pub model: &'a Model,
    pub fixed: &'a BodyFixed<T>,
    /// Per body; those that carry shapes count.
    pub poses: &'a [Pose<T>],
}

impl<T: Real> PlacedShapes<'_, T> {
    fn point(&self, p: PointId) -> Vec3<T> {
        self.poses[self.model.points[p.0].body.0].point(self.fixed.points[p.0])
    }

    fn axis(&self, shape: ShapeId, body: BodyId) -> Vec3<T> {
        let axis = self.fixed.shapes[shape.0].axis.expect("a shape with an axis");
        self.poses[body.0].rot * axis
    }

    /// Core of a shape, in global coordinates.
    pub fn core(&self, shape: ShapeId) -> Core<T> {
        let ShapeGeometry { size, round, .. } = self.fixed.shapes[shape.0];
        let body = |p: PointId| self.model.points[p.0].body;
        match self.model.shapes[shape.0].kind {
            ShapeKind::Sphere { centre } => Core::Point(self.point(centre)),
            ShapeKind::Capsule { ends } => Core::Segment(ends.map(|p| self.point(p))),
            ShapeKind::Ring { centre, .. } => Core::Circle(Circle {
                centre: self.point(centre),
                axis: self.axis(shape, body(centre)),
                radius: size,
            }),
            ShapeKind::Cylinder { ends, .. } => {
                let [a, b] = ends.map(|p| self.point(p));
                let length = (b - a).norm();
                let middle = Circle {
                    centre: (a + b) * T::constant(0.5),
                    axis: (b - a) * (T::one() / length),
                    radius: size - round,
                };
                Core::Cylinder { middle, half_width: length * 0.5 - round }
            }
            ShapeKind::Tyre { wheel, .. } => {
                let wheel = &self.model.wheels[wheel.0];
                let middle = Circle {
                    centre: self.point(wheel.centre),
                    axis: self.axis(shape, wheel.body),
                    radius: T::constant(wheel.radius) - round,
                };
                Core::Cylinder { middle, half_width: size * 0.5 - round }
            }
            ShapeKind::Plane { point, .. } => {
                Core::HalfSpace { point: self.point(point), normal: self.axis(shape, body(point)) }
            }
        }
    }

    /// Radii around the cores of two shapes.
    pub fn rounds(&self, shapes: [ShapeId; 2]) -> T {
        let [a, b] = shapes.map(|s| self.fixed.shapes[s.0].round);
        a + b
    }

    /// Where two shapes are nearest, with the distance of the shapes.
    pub fn nearest(&self, shapes: [ShapeId; 2]) -> Nearest {
        let [a, b] = shapes.map(|s| self.core(s).value());
        let near = nearest(&a, &b);
        Nearest { distance: near.distance - self.rounds(shapes).value(), ..near }
    }

    /// Distance of two shapes between these features: that of their cores minus both radii.
    pub fn distance(&self, shapes: [ShapeId; 2], near: &Nearest) -> T {
        let [a, b] = shapes.map(|s| self.core(s));
        near.distance_of([&a, &b]) - self.rounds(shapes)
    }

    /// The pair of a clearance whose shapes are nearest, and where they are; `None` if it has no pairs.
    pub fn nearest_pair(&self, clearance: ClearanceId) -> Option<(usize, Nearest)> {
        let mut least: Option<(usize, Nearest)> = None;
        for (k, pair) in self.model.clearances[clearance.0].pairs.iter().enumerate() {
            // Farther apart than the nearest pair so far, by balls around both.
            if let Some((_, near)) = &least {
                let [(p, r), (q, s)] = pair.shapes.map(|shape| self.core(shape).value().ball());
                if (q - p).norm() - r - s - self.rounds(pair.shapes).value() > near.distance {
                    continue;
                }
            }
            let near = self.nearest(pair.shapes);
            if least.as_ref().is_none_or(|(_, found)| near.distance < found.distance) {
                least = Some((k, near));
            }
        }
        least
    }

    /// The least distance of the pairs of a clearance; NaN if it has none.
    pub fn clearance(&self, clearance: ClearanceId) -> T {
        let pairs = &self.model.clearances[clearance.0].pairs;
        self.nearest_pair(clearance)
            .map_or_else(|| T::constant(f64::NAN), |(k, near)| self.distance(pairs[k].shapes, &near))
    }
}

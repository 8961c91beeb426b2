//! Core of a shape: all points of the shape within its radius of the core.

use crate::space::{Real, Vec3};

use super::circle::Circle;
use super::feature::{Feature, Placed};

/// Core of a shape, in global coordinates, m.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Core<T = f64> {
    /// A point: of a sphere.
    Point(Vec3<T>),
    /// The points between two ends: of a capsule.
    Segment([Vec3<T>; 2]),
    /// A circle: of a ring.
    Circle(Circle<T>),
    /// A solid cylinder: of a wheel, a tyre or a drum.
    Cylinder {
        /// The circle halfway between its caps.
        middle: Circle<T>,
        /// Half the distance of its caps.
        half_width: T,
    },
    /// All points on one side of a plane: of a wall or a road.
    HalfSpace {
        /// A point of the plane.
        point: Vec3<T>,
        /// Unit normal, which points away from the half-space.
        normal: Vec3<T>,
    },
}

impl<T: Real> Core<T> {
    /// One of its features, and the distance by which the core extends beyond it: the radius of a cylinder beyond its
    /// axis, otherwise 0. What is no point, rim or cap is its line or circle.
    pub fn feature(&self, feature: Feature) -> (Placed<T>, T) {
        let zero = T::zero();
        match (self, feature) {
            (Self::Point(p), _) => (Placed::Point(*p), zero),
            (Self::Segment([a, b]), Feature::Point(at)) => {
                (Placed::Point((*b - *a).times_plus(T::constant(at), *a)), zero)
            }
            (Self::Segment([a, b]), _) => (Placed::Line { from: *a, along: *b - *a }, zero),
            (Self::Circle(circle), Feature::Point(_)) => (Placed::Point(circle.centre), zero),
            (Self::Circle(circle), _) => (Placed::Circle(*circle), zero),
            (Self::Cylinder { middle, half_width }, Feature::Point(at)) => {
                (Placed::Point(middle.moved(*half_width * at).centre), zero)
            }
            (Self::Cylinder { middle, half_width }, Feature::Circle(side)) => {
                (Placed::Circle(middle.moved(*half_width * side)), zero)
            }
            (Self::Cylinder { middle, half_width }, Feature::Face(side)) => {
                let point = middle.moved(*half_width * side).centre;
                (Placed::Face { point, normal: middle.axis * T::constant(side) }, zero)
            }
            (Self::Cylinder { middle, .. }, _) => {
                (Placed::Line { from: middle.centre, along: middle.axis }, middle.radius)
            }
            (Self::HalfSpace { point, normal }, _) => (Placed::Face { point: *point, normal: *normal }, zero),
        }
    }
}

impl Core {
    /// A ball that encloses it: centre and radius; infinite for a half-space.
    pub fn ball(&self) -> (Vec3, f64) {
        match self {
            Self::Point(p) => (*p, 0.0),
            Self::Segment([a, b]) => ((*a + *b) * 0.5, 0.5 * (*b - *a).norm()),
            Self::Circle(circle) => (circle.centre, circle.radius),
            Self::Cylinder { middle, half_width } => (middle.centre, middle.radius.hypot(*half_width)),
            Self::HalfSpace { point, .. } => (*point, f64::INFINITY),
        }
    }
}

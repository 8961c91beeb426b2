//! Shapes of bodies, and the clearances between them.

use std::sync::Arc;

use crate::space::Surface;

use super::{BodyId, Direction, Length, Model, PointId, ShapeId, WheelId};

/// A shape: all points within a radius of a core.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Name.
    pub name: String,
    /// Group that clearances may name, if it is in one.
    pub group: Option<String>,
    /// The core.
    pub kind: ShapeKind,
    /// The radius of a sphere or capsule, the radius of a ring's bar, the rounding of edges; 0 where there is none.
    pub round: Option<Length>,
}

/// Kind of a shape, with the numbers of its core.
#[derive(Clone, Debug, PartialEq)]
pub enum ShapeKind {
    /// A ball.
    Sphere {
        /// The centre.
        centre: PointId,
    },
    /// A rod with round ends.
    Capsule {
        /// Centres of its ends.
        ends: [PointId; 2],
    },
    /// A bar that is bent to a circle: the lip of a rim.
    Ring {
        /// The centre.
        centre: PointId,
        /// Direction perpendicular to its plane.
        axis: Direction,
        /// Radius of the circle in the middle of the bar.
        radius: Length,
    },
    /// A solid cylinder.
    Cylinder {
        /// Centres of its caps.
        ends: [PointId; 2],
        /// Radius, to the outside.
        radius: Length,
    },
    /// The tyre of a wheel: a cylinder of the wheel's radius.
    Tyre {
        /// The wheel.
        wheel: WheelId,
        /// Width, to the outside.
        width: Length,
    },
    /// The half-space behind a plane.
    Plane {
        /// A point of the plane.
        point: PointId,
        /// Normal, which points out of the half-space.
        normal: Direction,
    },
    /// The convex hull of points, such as a box.
    Hull {
        /// The points, on one body.
        points: Vec<PointId>,
        /// Triangles between them, in the design configuration, which face outward.
        facets: Vec<[u32; 3]>,
    },
    /// A surface of triangles, which does not change with the design.
    Mesh {
        /// The body that carries it.
        body: BodyId,
        /// The surface in the frame of that body, m.
        surface: Arc<Surface>,
    },
}

/// Pattern of the shapes that have a core and no vertices.
macro_rules! with_core {
    () => {
        ShapeKind::Sphere { .. }
            | ShapeKind::Capsule { .. }
            | ShapeKind::Ring { .. }
            | ShapeKind::Cylinder { .. }
            | ShapeKind::Tyre { .. }
            | ShapeKind::Plane { .. }
    };
}
pub(crate) use with_core;

impl Shape {
    /// The shape's kind, as model files name it.
    pub fn kind_name(&self) -> &'static str {
        match self.kind {
            ShapeKind::Sphere { .. } => "sphere",
            ShapeKind::Capsule { .. } => "capsule",
            ShapeKind::Ring { .. } => "ring",
            ShapeKind::Cylinder { .. } => "cylinder",
            ShapeKind::Tyre { .. } => "tyre",
            ShapeKind::Plane { .. } => "plane",
            ShapeKind::Hull { .. } => "hull",
            ShapeKind::Mesh { .. } => "mesh",
        }
    }

    /// The bodies that its points are fixed in: one, or of a rod that is only a joint those of both ends.
    pub fn bodies(&self, model: &Model) -> Vec<BodyId> {
        let body = |p: PointId| model.points[p.0].body;
        match &self.kind {
            ShapeKind::Sphere { centre: p }
            | ShapeKind::Ring { centre: p, .. }
            | ShapeKind::Plane { point: p, .. } => vec![body(*p)],
            ShapeKind::Tyre { wheel, .. } => vec![model.wheels[wheel.0].body],
            ShapeKind::Capsule { ends } | ShapeKind::Cylinder { ends, .. } => {
                let [a, b] = ends.map(body);
                if a == b { vec![a] } else { vec![a, b] }
            }
            ShapeKind::Hull { points, .. } => vec![body(points[0])],
            ShapeKind::Mesh { body, .. } => vec![*body],
        }
    }

    /// The direction of its axis or normal, and the body that carries it, if it has one that points do not give.
    pub(crate) fn axis(&self, model: &Model) -> Option<(BodyId, Direction)> {
        match self.kind {
            ShapeKind::Ring { centre: point, axis, .. } | ShapeKind::Plane { point, normal: axis } => {
                Some((model.points[point.0].body, axis))
            }
            ShapeKind::Tyre { wheel, .. } => {
                let wheel = &model.wheels[wheel.0];
                Some((wheel.body, wheel.spin_axis))
            }
            ShapeKind::Sphere { .. }
            | ShapeKind::Capsule { .. }
            | ShapeKind::Cylinder { .. }
            | ShapeKind::Hull { .. }
            | ShapeKind::Mesh { .. } => None,
        }
    }
}

/// Distances between shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct Clearance {
    /// Name.
    pub name: String,
    /// Pairs of shapes that are measured.
    pub pairs: Vec<ShapePair>,
    /// Distance above which pairs are not listed in results, m.
    pub beyond: Option<f64>,
}

/// A pair of shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapePair {
    /// The shapes.
    pub shapes: [ShapeId; 2],
    /// The least distance that is required, m.
    pub min: Option<f64>,
}

impl Model {
    /// Names of the shapes of a pair.
    pub fn pair_names(&self, pair: &ShapePair) -> [&str; 2] {
        pair.shapes.map(|s| self.shapes[s.0].name.as_str())
    }

    /// Pairs of shapes of all clearances, each once, in the order of the clearances.
    pub fn shape_pairs(&self) -> Vec<[ShapeId; 2]> {
        let mut pairs: Vec<[ShapeId; 2]> = Vec::new();
        for ShapePair { shapes, .. } in self.clearances.iter().flat_map(|c| &c.pairs) {
            if !pairs.contains(shapes) {
                pairs.push(*shapes);
            }
        }
        pairs
    }
}

//! Shapes and clearances as written.

use crate::space::Vec3;

use super::{DirectionDraft, NumberDraft, PointRef};

/// A shape; see [`Shape`](crate::model::Shape).
#[derive(Clone, Debug)]
pub struct BodyShapeDraft {
    /// Name.
    pub name: String,
    /// Group that clearances may name.
    pub group: Option<String>,
    /// Kind and core.
    pub kind: BodyShapeKindDraft,
    /// Radius of a sphere or capsule, radius of a ring's bar, rounding of edges.
    pub round: Option<NumberDraft>,
}

/// Kind of a shape as written; see [`ShapeKind`](crate::model::ShapeKind).
#[derive(Clone, Debug)]
pub enum BodyShapeKindDraft {
    /// Entry that could not be read.
    Unread,
    /// A ball.
    Sphere {
        /// The centre.
        centre: PointRef,
    },
    /// A rod with round ends.
    Capsule {
        /// Centres of its ends.
        ends: EndsDraft,
    },
    /// A bar that is bent to a circle.
    Ring {
        /// The centre.
        centre: PointRef,
        /// Direction perpendicular to its plane.
        axis: DirectionDraft,
        /// Radius of the circle in the middle of the bar.
        radius: NumberDraft,
    },
    /// A solid cylinder.
    Cylinder {
        /// Centres of its caps.
        ends: EndsDraft,
        /// Radius, to the outside.
        radius: NumberDraft,
    },
    /// The tyre of a wheel.
    Tyre {
        /// The wheel's name.
        wheel: String,
        /// Width, to the outside.
        width: NumberDraft,
    },
    /// The half-space behind a plane.
    Plane {
        /// A point of the plane.
        point: PointRef,
        /// Normal, which points out of the half-space.
        normal: DirectionDraft,
    },
    /// The convex hull of points.
    Hull {
        /// The points, on one body.
        points: Vec<PointRef>,
    },
    /// A surface of triangles.
    Mesh {
        /// The body's name.
        body: String,
        /// Corners, m.
        vertices: Vec<Vec3>,
        /// Triangles, by the numbers of their corners.
        triangles: Vec<[u32; 3]>,
        /// True if the corners are given in the body's frame, rather than global in the design configuration.
        in_body: bool,
    },
}

/// Ends of a capsule or cylinder.
#[derive(Clone, Debug)]
pub enum EndsDraft {
    /// Two points.
    Points([PointRef; 2]),
    /// The ends of a rod, a leg or a spring, by its name.
    Of(String),
}

/// A clearance; see [`Clearance`](crate::model::Clearance).
#[derive(Clone, Debug)]
pub struct ClearanceDraft {
    /// Name.
    pub name: String,
    /// Shapes between which it is measured.
    pub between: BetweenDraft,
    /// Pairs that are not measured, by names, patterns, bodies or groups.
    pub ignore: Vec<[String; 2]>,
    /// Distance above which pairs are not listed in results, m.
    pub beyond: Option<f64>,
    /// The least distance that is required, m.
    pub min: MinimumDraft,
}

/// Pairs of a clearance as written: names of shapes, patterns with `*`, names of bodies or of groups.
#[derive(Clone, Debug)]
pub enum BetweenDraft {
    /// All pairs of shapes that move relative to each other.
    All,
    /// Each shape of the first side with each of the second.
    Sides([Vec<String>; 2]),
}

/// Least distances that are required, m.
#[derive(Clone, Debug, Default)]
pub struct MinimumDraft {
    /// For all pairs without another one.
    pub default: Option<f64>,
    /// For pairs of which a shape has such a name, pattern, body or group; the largest counts.
    pub of: Vec<(String, f64)>,
}

/// True if a name has the form of a pattern of shapes, in which `*` represents any characters.
pub fn matches_pattern(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((start, rest)) => {
            name.starts_with(start)
                && (start.len()..=name.len())
                    .filter(|k| name.is_char_boundary(*k))
                    .any(|k| matches_pattern(rest, &name[k..]))
        }
    }
}

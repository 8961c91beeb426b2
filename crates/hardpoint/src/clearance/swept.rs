//! A shape at one pose, in the frame of another body: distances of points from it, and points of its surface.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::model::{ShapeId, ShapeKind, with_core};
use crate::number;
use crate::space::{Pose, Surface, Vec3};

use super::block::Block;
use super::core::Core;
use super::nearest::{Nearest, from_point};
use super::placed::PlacedShapes;
use super::surface::{View, moved};

/// Number of points of the rim of a cylinder's cap.
const RIM_POINTS: u32 = 24;
/// Number of triangles of a mesh from which the distance of a point is computed, about.
const TRIANGLES_OF_MESH: usize = 20;

/// A shape at one pose.
#[derive(Clone, Debug)]
pub(crate) struct ShapeAtPose {
    solid: Solid,
    /// Radius around the core, m.
    round: f64,
    /// Centre and radius of a ball around it.
    ball: (Vec3, f64),
}

#[derive(Clone, Debug)]
enum Solid {
    Core(Core),
    Hull {
        points: Vec<Vec3>,
        facets: Vec<[u32; 3]>,
        block: Option<Block>,
    },
    /// With the pose of the reference in the frame of the mesh.
    Mesh {
        surface: Arc<Surface>,
        inverse: Pose,
    },
}

impl ShapeAtPose {
    /// A shape where its body is, in the frame of a body with the pose `reference`.
    pub fn of(placed: &PlacedShapes<'_, f64>, shape: ShapeId, reference: Pose) -> Self {
        let into = reference.inverse();
        let solid = match &placed.model.shapes[shape.0].kind {
            ShapeKind::Hull { points, facets } => {
                let points: Vec<Vec3> = placed.points(points).into_iter().map(|p| into.point(p)).collect();
                Solid::Hull { block: Block::of(&points), points, facets: facets.clone() }
            }
            ShapeKind::Mesh { body, surface } => {
                let inverse = into.compose(placed.bodies[body.0]).inverse();
                Solid::Mesh { surface: Arc::clone(surface), inverse }
            }
            with_core!() => Solid::Core(moved(&placed.core(shape).expect("it is no surface"), into)),
        };
        let (centre, radius) = placed.ball(shape);
        Self { solid, round: placed.fixed.shapes[shape.0].round, ball: (into.point(centre), radius) }
    }

    /// Centre and radius of a ball around it.
    pub fn ball(&self) -> (Vec3, f64) {
        self.ball
    }

    /// Distance of a point, negative inside; it changes by no more than the point moves.
    pub fn distance_from(&self, p: Vec3) -> f64 {
        let of_core = match &self.solid {
            Solid::Core(core) => core.distance_from(p),
            Solid::Hull { points, facets, block } => {
                View::Hull { points, facets, block: *block }.distance_from(p)
            }
            Solid::Mesh { surface, inverse } => View::Mesh(surface).distance_from(inverse.point(p)),
        };
        of_core - self.round
    }

    /// Point of its surface, with a margin around it, that is nearest to a point.
    pub fn surface_point(&self, p: Vec3, margin: f64) -> Vec3 {
        let of = |near: &Nearest| near.points[1] + near.gradient() * (self.round + margin);
        match &self.solid {
            Solid::Core(core) => of(&from_point(p, core)),
            Solid::Hull { points, facets, block } => {
                of(&View::Hull { points, facets, block: *block }.nearest_to(p))
            }
            Solid::Mesh { surface, inverse } => {
                inverse.inverse().point(of(&View::Mesh(surface).nearest_to(inverse.point(p))))
            }
        }
    }

    /// Number of triangles from which the distance of a point is computed, about; 1 of other solids.
    pub fn triangles_per_distance(&self) -> usize {
        match &self.solid {
            Solid::Hull { facets, block: None, .. } => facets.len(),
            Solid::Mesh { .. } => TRIANGLES_OF_MESH,
            Solid::Core(_) | Solid::Hull { block: Some(_), .. } => 1,
        }
    }

    /// Radius around the core, m.
    pub fn round(&self) -> f64 {
        self.round
    }

    /// Corners of a hull or mesh, and points of the sharp edges of a cylinder: its thinnest parts end there.
    pub fn corners(&self) -> Vec<Vec3> {
        match &self.solid {
            Solid::Core(Core::Cylinder { middle, half_width }) if self.round == 0.0 => {
                let x = middle.axis.any_perpendicular();
                let y = middle.axis.cross(x);
                let out = |n: u32| {
                    let (sin, cos) = (f64::from(n) * TAU / f64::from(RIM_POINTS)).sin_cos();
                    (x * cos + y * sin) * middle.radius
                };
                let ends = number::both([-1.0, 1.0], |side| middle.moved(half_width * side).centre);
                ends.iter().flat_map(|end| (0..RIM_POINTS).map(move |n| *end + out(n))).collect()
            }
            Solid::Core(_) => Vec::new(),
            Solid::Hull { points, .. } => points.clone(),
            Solid::Mesh { surface, inverse } => {
                let place = inverse.inverse();
                surface.vertices().iter().map(|p| place.point(*p)).collect()
            }
        }
    }
}

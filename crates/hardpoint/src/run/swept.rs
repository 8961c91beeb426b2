//! A shape at the poses of a motion, in the frame of another body: the space that it sweeps there.

use crate::clearance::{PlacedShapes, ShapeAtPose};
use crate::design::BodyFixed;
use crate::model::{BodyId, ShapeId};
use crate::motion::Motion;
use crate::space::{Pose, Vec3};

use super::Analysis;

/// A shape at poses of motions, in the frame of a body.
#[derive(Clone, Debug)]
pub struct SweptShape {
    shape: ShapeId,
    relative_to: BodyId,
    poses: Vec<ShapeAtPose>,
}

impl SweptShape {
    /// A shape without poses, seen from a body.
    pub fn new(shape: ShapeId, relative_to: BodyId) -> Self {
        Self { shape, relative_to, poses: Vec::new() }
    }

    /// Adds the poses at these times of a solved motion of a design.
    pub fn add(
        &mut self,
        analysis: &Analysis<'_>,
        design: &[f64],
        motion: &Motion,
        steps: impl Iterator<Item = usize>,
    ) {
        let model = analysis.model();
        let fixed: BodyFixed<f64> = analysis.design_map().fixed(&model.whole(design));
        let mut bodies = model.shapes[self.shape.0].bodies(model);
        bodies.push(self.relative_to);
        let mut poses = vec![Pose::IDENTITY; model.bodies.len()];
        for k in steps {
            let states = motion.at(k);
            for b in &bodies {
                poses[b.0] = states.body(b.0).pose();
            }
            let placed = PlacedShapes { model, fixed: &fixed, bodies: &poses[..] };
            self.poses.push(ShapeAtPose::of(&placed, self.shape, poses[self.relative_to.0]));
        }
    }

    /// Number of poses.
    pub fn len(&self) -> usize {
        self.poses.len()
    }

    /// True if it has no poses.
    pub fn is_empty(&self) -> bool {
        self.poses.is_empty()
    }

    /// Distance of a point from the shape at a pose, m: negative inside. It changes by no more than the point moves.
    pub fn distance(&self, pose: usize, p: Vec3) -> f64 {
        self.poses[pose].distance_from(p)
    }

    /// Centre and radius of a ball around the shape at a pose; infinite for a plane.
    pub fn ball(&self, pose: usize) -> (Vec3, f64) {
        self.poses[pose].ball()
    }

    /// Point of the surface of the shape at a pose, with a margin around it, that is nearest to a point.
    pub fn surface_point(&self, pose: usize, p: Vec3, margin: f64) -> Vec3 {
        self.poses[pose].surface_point(p, margin)
    }

    /// Corners of a hull or mesh at a pose; none of another shape.
    pub fn corners(&self, pose: usize) -> Vec<Vec3> {
        self.poses[pose].corners()
    }
}

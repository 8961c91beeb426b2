//! A shape at the poses of a motion, in the frame of another body: the space that it sweeps there.

use std::collections::HashSet;

use crate::clearance::{PlacedShapes, ShapeAtPose};
use crate::design::BodyFixed;
use crate::model::{BodyId, ShapeId};
use crate::motion::{BodyState, Motion};
use crate::space::{Pose, Vec3};

use super::{Analysis, Run, Solution};

/// A shape at poses of motions, in the frame of a body.
#[derive(Clone, Debug)]
pub struct SweptShape {
    shape: ShapeId,
    relative_to: BodyId,
    poses: Vec<ShapeAtPose>,
    /// Places of the carriers at all poses, rounded.
    known: HashSet<Vec<i64>>,
}

/// Poses whose places and directions differ by less than this, as a fraction of the mechanism's size, are the same one:
/// a shape that only some of the drivers move has few.
const SAME_POSE: f64 = 1e-9;

impl SweptShape {
    /// A shape without poses, seen from a body.
    pub fn new(shape: ShapeId, relative_to: BodyId) -> Self {
        Self { shape, relative_to, poses: Vec::new(), known: HashSet::new() }
    }

    /// Adds the poses at these times of a solved motion of a design that are not known yet. Returns bounds of the
    /// speeds of the shape's points at all of them, seen from the body, m/s.
    pub fn add(
        &mut self,
        analysis: &Analysis<'_>,
        design: &[f64],
        motion: &Motion,
        steps: impl Iterator<Item = usize>,
    ) -> Vec<f64> {
        let model = analysis.model();
        let fixed: BodyFixed<f64> = analysis.design_map().fixed(&model.whole(design));
        let carriers = model.shapes[self.shape.0].bodies(model);
        let bodies: Vec<BodyId> = carriers.iter().copied().chain([self.relative_to]).collect();
        let mut poses = vec![Pose::IDENTITY; model.bodies.len()];
        let mut speeds = Vec::new();
        for k in steps {
            let states = motion.at(k);
            for b in &bodies {
                poses[b.0] = states.body(b.0).pose();
            }
            let placed = PlacedShapes { model, fixed: &fixed, bodies: &poses[..] };
            let (centre, radius) = placed.ball(self.shape);
            let reference = states.body(self.relative_to.0);
            let at_centre = |body: &BodyState| body.v + body.omega.cross(centre - body.r);
            // A rod between two bodies has an end on each.
            let of_carriers = carriers.iter().map(|b| states.body(b.0)).map(|body| {
                (at_centre(&body) - at_centre(&reference)).norm()
                    + (body.omega - reference.omega).norm() * radius
            });
            speeds.push(of_carriers.fold(0.0, f64::max));
            let into = poses[self.relative_to.0].inverse();
            let places = carriers.iter().flat_map(|b| {
                let Pose { r, rot } = into.compose(poses[b.0]);
                let directions = rot.cols.iter().flat_map(|c| c.to_array());
                let place = (r * (1.0 / model.size())).to_array();
                place.into_iter().chain(directions.collect::<Vec<f64>>())
            });
            if self.known.insert(places.map(|x| (x / SAME_POSE).round() as i64).collect()) {
                self.poses.push(ShapeAtPose::of(&placed, self.shape, poses[self.relative_to.0]));
            }
        }
        speeds
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

    /// Radius around the core, m.
    pub fn round(&self) -> f64 {
        self.poses.first().map_or(0.0, ShapeAtPose::round)
    }

    /// Number of triangles from which a distance is computed, about; 1 of other solids.
    pub fn triangles_per_distance(&self) -> usize {
        self.poses.first().map_or(1, ShapeAtPose::triangles_per_distance)
    }

    /// Number of corners at all poses.
    pub fn corner_count(&self) -> usize {
        self.poses.first().map_or(0, |pose| pose.corners().len()) * self.len()
    }

    /// Corners of a hull or mesh at a pose, and points of the sharp edges of a cylinder; none of another shape.
    pub fn corners(&self, pose: usize) -> Vec<Vec3> {
        self.poses[pose].corners()
    }
}

impl Analysis<'_> {
    /// Output times, and others between them so that no driver moves far between two of them: those at which a swept
    /// shape is taken first.
    pub fn swept_times(&self) -> Vec<f64> {
        self.times_within()
    }

    /// Motion of a design that ends between two output times, solved to its end: the last of its times is where a limit
    /// stops it, or that of the last position that is reached. `None` if `solution` is that motion already.
    pub fn motion_to_end(&self, design: &[f64], solution: &Solution) -> Option<Motion> {
        let end = solution.stop.as_ref()?.last_time?;
        let solved = &solution.motion.times;
        if *solved.last()? >= end {
            return None;
        }
        let times = solved.iter().copied().chain([end]).collect();
        let run = Run::new().at(design).without_measures().without_sensitivities();
        let Solution { motion, .. } = self.without_metrics(times).solve(run);
        (motion.times.last() == Some(&end)).then_some(motion)
    }
}

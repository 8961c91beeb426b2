//! Shapes of a design over its motion, and how they move relative to each other.

use crate::clearance::{MovingBodies, PlacedShapes};
use crate::design::BodyFixed;
use crate::model::{BodyId, Model, ShapeId, ShapeKind};
use crate::motion::{BodyState, Motion};
use crate::number::{Jet, Rates};
use crate::run::Analysis;
use crate::space::Vec3;

use super::{CONSTANT, ShapeDistance};

/// Angle by which two bodies may turn relative to each other between two times, rad: the error of a polynomial of
/// degree five for a sine is `0.5^6 / 46080 = 3e-7`, which hides no minimum.
const FAR: f64 = 0.5;
/// Maximum number of times that are added for bodies that turn far.
const MOST_TURNING: f64 = 20_000.0;

/// Shapes of a design over its motion.
pub(super) struct PosedMotion<'m> {
    pub model: &'m Model,
    pub motion: &'m Motion,
    pub fixed: BodyFixed<Rates>,
}

impl<'m> PosedMotion<'m> {
    pub fn of(analysis: &'m Analysis<'_>, design: &[f64], motion: &'m Motion) -> Self {
        let model = analysis.model();
        let fixed = analysis.design_map().fixed(&model.whole(design)).map(Jet::constant);
        Self { model, motion, fixed }
    }

    /// Calls `visit` with the shapes at each of these times.
    pub fn each(
        &self,
        steps: impl Iterator<Item = usize>,
        mut visit: impl FnMut(usize, PlacedShapes<'_, Rates, MovingBodies>),
    ) {
        let mut bodies = MovingBodies::of(self.model);
        for k in steps {
            bodies.set(self.motion.at(k));
            visit(k, PlacedShapes { model: self.model, fixed: &self.fixed, bodies: &bodies });
        }
    }

    /// Distances of pairs at these times.
    pub fn distances(
        &self,
        pairs: &[[ShapeId; 2]],
        steps: impl Iterator<Item = usize>,
    ) -> Vec<Vec<ShapeDistance>> {
        let mut samples: Vec<Vec<ShapeDistance>> = vec![Vec::new(); pairs.len()];
        self.each(steps, |k, placed| {
            for (p, shapes) in pairs.iter().enumerate() {
                let near = placed.nearest(*shapes);
                let Jet([value, rate, acceleration]) = placed.distance(*shapes, &near);
                // An equilibrium is at rest at each time, so that nothing has a rate.
                let at_rest = self.model.equilibrium.is_some();
                let rates = if at_rest { [f64::NAN; 2] } else { [rate, acceleration] };
                samples[p].push(ShapeDistance {
                    time: self.motion.times[k],
                    distance: [value, rates[0], rates[1]],
                    points: near.points,
                    is_parallel: near.is_parallel,
                    cores_meet: near.cores_meet(CONSTANT * self.model.size()),
                });
            }
        });
        samples
    }

    /// Relative motion of two shapes at time k; `None` for other than surfaces, since the distance of two convex cores
    /// has one pair of features at a time, and its rate is continuous.
    pub fn reach(&self, shapes: [ShapeId; 2], k: usize) -> Option<Reach> {
        let Self { model, motion, fixed } = self;
        if !has_surface(model, shapes) {
            return None;
        }
        let carried = |s: ShapeId| {
            let bodies = model.shapes[s.0].bodies(model);
            bodies.into_iter().map(|body| motion.at(k).body(body.0)).collect::<Vec<BodyState>>()
        };
        let mut bodies = MovingBodies::of(model);
        bodies.set(motion.at(k));
        let placed = PlacedShapes { model, fixed, bodies: &bodies };
        let balls = shapes.map(|s| placed.ball(s));
        let (centre, radius) = if balls[0].1 <= balls[1].1 { balls[0] } else { balls[1] };
        let at = |body: &BodyState, p: Vec3| body.v + body.omega.cross(p - body.r);
        let [first, second] = shapes.map(carried);
        let speed = match (&first[..], &second[..]) {
            ([first], [second]) => {
                let turning = (second.omega - first.omega).norm();
                (at(second, centre) - at(first, centre)).norm() + turning * radius
            }
            ([rigid], _) | (_, [rigid]) => {
                // A rod between two bodies: each of its points goes with the same fractions of its ends.
                let between = if first.len() == 1 { shapes[1] } else { shapes[0] };
                let (ShapeKind::Capsule { ends } | ShapeKind::Cylinder { ends, .. }) =
                    &model.shapes[between.0].kind
                else {
                    return None;
                };
                let [p, q] = ends.map(|p| {
                    let body = motion.at(k).body(model.points[p.0].body.0);
                    let place = body.r + body.rotation * fixed.points[p.0].value();
                    (place, at(&body, place) - at(rigid, place))
                });
                // Rims of a cylinder turn with its axis.
                let turning = (q.1 - p.1).norm() / (q.0 - p.0).norm();
                let rim = fixed.shapes[between.0].size.value().abs();
                p.1.norm().max(q.1.norm()) + if rim > 0.0 { turning * rim } else { 0.0 }
            }
            (_, _) => return None,
        };
        Some(Reach { speed, radius })
    }

    /// Times between those of the motion, between which the bodies of two shapes do not turn far.
    pub fn turning_times(&self, shapes: [ShapeId; 2]) -> Vec<f64> {
        let bodies = self.carriers(shapes);
        let longest = self.motion.times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        // Relative to the first one each turns by no more than both.
        let fastest = |body: &BodyId| self.motion.fastest(*body);
        let relative = bodies.first().map_or(0.0, |first| {
            bodies[1..].iter().map(|other| fastest(other) + fastest(first)).sum::<f64>()
        });
        if longest * relative <= FAR {
            return Vec::new();
        }
        let speeds: Vec<f64> = (0..self.motion.len()).map(|k| self.turning(&bodies, k)).collect();
        turning_times(&self.motion.times, &speeds)
    }

    /// Sum of the radii around the cores of two shapes, m.
    pub fn round(&self, shapes: [ShapeId; 2]) -> f64 {
        shapes.iter().map(|s| self.fixed.shapes[s.0].round.value()).sum()
    }

    /// Bodies that carry two shapes.
    pub fn carriers(&self, [a, b]: [ShapeId; 2]) -> Vec<BodyId> {
        let of = |s: ShapeId| self.model.shapes[s.0].bodies(self.model);
        of(a).into_iter().chain(of(b)).collect()
    }

    /// Angular speed of bodies relative to each other at time k, rad/s.
    pub fn turning(&self, bodies: &[BodyId], k: usize) -> f64 {
        let Some((first, others)) = bodies.split_first() else { return 0.0 };
        let states = self.motion.at(k);
        let spin = |body: &BodyId| states.omega(body.0);
        let first = spin(first);
        // Of two others at most the sum.
        others.iter().map(|other| (spin(other) - first).norm()).sum()
    }
}

/// True if one of two shapes is a surface or a ring, which may have several parts that are near the other shape.
pub(super) fn has_surface(model: &Model, shapes: [ShapeId; 2]) -> bool {
    let is_concave =
        |s: ShapeId| matches!(model.shapes[s.0].kind, ShapeKind::Mesh { .. } | ShapeKind::Ring { .. });
    shapes.into_iter().any(is_concave)
}

/// Motion of two surfaces relative to each other at one time.
#[derive(Clone, Copy)]
pub(super) struct Reach {
    /// Greatest rate of the distance between any of their points, m/s.
    pub speed: f64,
    /// Radius of the smaller ball around one of them, m.
    pub radius: f64,
}

/// Times within intervals in which a body with these speeds at their ends, rad/s, turns far.
pub(super) fn turning_times(times: &[f64], speeds: &[f64]) -> Vec<f64> {
    let angle = |k: usize| (times[k + 1] - times[k]) * speeds[k].max(speeds[k + 1]);
    let intervals = 0..times.len().saturating_sub(1);
    let most = FAR.max(intervals.clone().map(angle).sum::<f64>() / MOST_TURNING);
    let far = intervals.filter(|k| angle(*k) > most);
    let within = |k: usize| {
        let parts = (angle(k) / most).ceil();
        let at = move |n: u32| times[k] + (times[k + 1] - times[k]) * f64::from(n) / parts;
        (1..parts as u32).map(at)
    };
    far.flat_map(within).collect()
}

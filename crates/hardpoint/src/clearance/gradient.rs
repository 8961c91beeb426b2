//! Derivatives of a distance by the poses of bodies: a force along the nearest points, and its moments.
//!
//! Nearest points slide along their features without effect on the distance, since n, the unit vector along them, is
//! perpendicular to both. With a variation of the design, a body turns by pi' and its origin moves by r':
//!
//! ```text
//! D'  =  n . (Q' - P'),      P' = r' + pi' x (P - r)
//!     =  sum of  F . r' + M . pi'  over the bodies,      F = -n or n,  M = (P - r) x F
//! ```
//!
//! At all times, so that rates follow by the product rule. With `omega' = pi'. + pi' x omega`, and M., M.. the rates of
//! the moment, the factors are
//!
//! | | of pi' | of omega' | of alpha' |
//! |---|---|---|---|
//! | D' | `M` | | |
//! | D'. | `M. + M x omega` | `M` | |
//! | D'.. | `M.. + 2 M. x omega + M x alpha + (M x omega) x omega` | `2 M. + M x omega` | `M` |
//!
//! so that a distance takes 36 products per body and variable.

use crate::design::BodyFixed;
use crate::model::{BodyId, Model, PointId, ShapeId, ShapeKind};
use crate::motion::{BodyState, States};
use crate::number::{self, Dual, Rates};
use crate::sensitivity::{BodySensitivity, Derivatives};
use crate::space::{Real, Vec3};

use super::bodies::{MovingBodies, rates_of};
use super::feature::nearest_points;
use super::nearest::Nearest;
use super::placed::PlacedShapes;

/// Derivatives of the distance of two shapes at one time, by the poses of their bodies and by their points.
pub(crate) struct DistanceGradient {
    /// The shapes.
    pub shapes: [ShapeId; 2],
    /// One per shape, or those of both ends of a capsule.
    loads: [Option<EndLoad>; 4],
}

/// Force at a point of a body.
struct EndLoad {
    body: BodyId,
    /// The point that moves all of the shape, or the end of the capsule, if there is one.
    point: Option<PointId>,
    /// The force with its rates.
    force: [Vec3; 3],
    /// Factors of pi' in the distance, its rate and its acceleration.
    turn: [Vec3; 3],
    /// Factor of omega' in the acceleration.
    spin: Vec3,
}

impl EndLoad {
    /// Load of a force at a point of space, which acts on the point of the body that is there at each time.
    fn of(
        (body, state): (BodyId, &BodyState),
        point: Option<PointId>,
        at: Vec3<Rates>,
        force: Vec3<Rates>,
    ) -> Self {
        let origin = Vec3::of_rates([state.r, state.v, state.a]);
        let [m, md, mdd] = rates((at - origin).cross(force));
        let BodyState { omega, alpha, .. } = *state;
        let turned = m.cross(omega);
        let turn = [m, md + turned, mdd + md.cross(omega) * 2.0 + m.cross(alpha) + turned.cross(omega)];
        Self { body, point, force: rates(force), turn, spin: md * 2.0 + turned }
    }

    /// Distance, rate and acceleration by a variable with these derivatives of the body.
    fn by_body(&self, d: &BodySensitivity) -> [f64; 3] {
        let ([f, fd, fdd], [t, td, tdd]) = (self.force, self.turn);
        [
            f.dot(d.dr) + t.dot(d.dpi),
            fd.dot(d.dr) + f.dot(d.dv) + td.dot(d.dpi) + t.dot(d.domega),
            fdd.dot(d.dr)
                + fd.dot(d.dv) * 2.0
                + f.dot(d.da)
                + tdd.dot(d.dpi)
                + self.spin.dot(d.domega)
                + t.dot(d.dalpha),
        ]
    }

    /// The same by a change of the point within the body, in its frame.
    fn by_point(&self, state: &BodyState, change: Vec3) -> [f64; 3] {
        let [f, fd, fdd] = self.force;
        let [y, v, a] = rates_of(state, state.rotation * change);
        [f.dot(y), fd.dot(y) + f.dot(v), fdd.dot(y) + fd.dot(v) * 2.0 + f.dot(a)]
    }
}

/// Value, rate and acceleration of a vector.
fn rates(x: Vec3<Rates>) -> [Vec3; 3] {
    number::each(&[0, 1, 2], |n| x.map(|c| c.0[n]))
}

impl DistanceGradient {
    /// Gradient of the distance between the nearest features; `None` where they have no direction, or the ends of a
    /// cylinder are on two bodies.
    pub fn of(
        placed: &PlacedShapes<'_, Rates, MovingBodies<'_>>,
        shapes: [ShapeId; 2],
        near: &Nearest,
    ) -> Option<Self> {
        if !near.distance.is_finite() || near.is_tied || placed.is_without_direction(shapes, near) {
            return None;
        }
        let features = placed.features(shapes, near);
        let (points, n) =
            nearest_points(number::both(features.each_ref(), |(placed, _)| placed), near.points)?;
        let n = n * Rates::constant(near.sign);
        if near.sign == 0.0 || !rates(n)[0].is_finite() {
            return None;
        }
        let mut loads = [None, None, None, None];
        for (k, force) in [-n, n].into_iter().enumerate() {
            let [first, second] = loads_of(placed, shapes[k], points[k], force)?;
            (loads[2 * k], loads[2 * k + 1]) = (first, second);
        }
        Some(Self { shapes, loads })
    }

    /// Derivatives of distance, rate and acceleration by a variable. `fixed` has the derivatives of body-fixed data,
    /// which must move the shapes by their points only ([`moves_points_only`]).
    pub fn by(&self, states: States<'_>, d: Derivatives<'_>, fixed: &BodyFixed<Dual<Rates>>) -> [f64; 3] {
        let [a, b] = number::both(self.shapes, |s| fixed.shapes[s.0].round.d.0[0]);
        let mut sum = [-(a + b), 0.0, 0.0];
        for load in self.loads.iter().flatten() {
            let by = load.by_body(&d.body(load.body.0));
            (0..3).for_each(|n| sum[n] += by[n]);
            let change = load.point.map(|p| fixed.points[p.0].map(|x| x.d.0[0]));
            if let Some(change) = change.filter(|change| *change != Vec3::ZERO) {
                let by = load.by_point(&states.body(load.body.0), change);
                (0..3).for_each(|n| sum[n] += by[n]);
            }
        }
        sum
    }
}

/// Loads of a shape with a force at its nearest point.
fn loads_of(
    placed: &PlacedShapes<'_, Rates, MovingBodies<'_>>,
    shape: ShapeId,
    at: Vec3<Rates>,
    force: Vec3<Rates>,
) -> Option<[Option<EndLoad>; 2]> {
    let model = placed.model;
    let body_of = |p: PointId| model.points[p.0].body;
    let state = |body: BodyId| placed.bodies.0.body(body.0);
    let one = |body: BodyId, point| Some([Some(EndLoad::of((body, &state(body)), point, at, force)), None]);
    match &model.shapes[shape.0].kind {
        ShapeKind::Capsule { ends } => {
            let [a, b] = number::both(*ends, |p| placed.point(p));
            let along = b - a;
            let part = along.dot(at - a) / along.dot(along);
            // Each end has the part of the force that the lever leaves to it.
            let parts = [Rates::one() - part, part];
            let load = |k: usize| {
                let body = body_of(ends[k]);
                (parts[k].0 != [0.0; 3])
                    .then(|| EndLoad::of((body, &state(body)), Some(ends[k]), [a, b][k], force * parts[k]))
            };
            Some([load(0), load(1)])
        }
        ShapeKind::Sphere { centre: point }
        | ShapeKind::Ring { centre: point, .. }
        | ShapeKind::Plane { point, .. } => one(body_of(*point), Some(*point)),
        ShapeKind::Tyre { wheel, .. } => {
            let wheel = &model.wheels[wheel.0];
            one(wheel.body, Some(wheel.centre))
        }
        ShapeKind::Cylinder { ends: [a, b], .. } if body_of(*a) == body_of(*b) => one(body_of(*a), None),
        ShapeKind::Cylinder { .. } => None,
        ShapeKind::Hull { points, .. } => one(body_of(points[0]), None),
        ShapeKind::Mesh { body, .. } => one(*body, None),
    }
}

/// True if a variable changes a shape by points that move all of it, or the ends of a capsule, and by the radius around
/// its core: the force along its nearest points gives the derivative.
pub(crate) fn moves_points_only(model: &Model, fixed: &BodyFixed<Dual<Rates>>, shape: ShapeId) -> bool {
    let is_constant = |x: Dual<Rates>| x.d.0[0] == 0.0;
    let is_still = |v: Vec3<Dual<Rates>>| [v.x, v.y, v.z].into_iter().all(is_constant);
    let points_still = |points: &[PointId]| points.iter().all(|p| is_still(fixed.points[p.0]));
    let geometry = &fixed.shapes[shape.0];
    let size_still = geometry.axis.is_none_or(is_still) && is_constant(geometry.size);
    match &model.shapes[shape.0].kind {
        ShapeKind::Sphere { .. } | ShapeKind::Capsule { .. } | ShapeKind::Mesh { .. } => true,
        ShapeKind::Ring { .. } | ShapeKind::Plane { .. } => size_still,
        // Their cores depend on the rounding, too.
        ShapeKind::Tyre { .. } => size_still && is_constant(geometry.round),
        ShapeKind::Cylinder { ends, .. } => size_still && is_constant(geometry.round) && points_still(ends),
        ShapeKind::Hull { points, .. } => points_still(points),
    }
}

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

use hardpoint_tape::{LANES, Lanes};

use crate::design::BodyFixed;
use crate::model::{BodyId, GROUND, Model, PointId, ShapeId, ShapeKind, VariableId};
use crate::motion::{BodyState, Motion};
use crate::number::{self, Dual, Rates};
use crate::sensitivity::{BodySensitivity, Sensitivities};
use crate::space::{Real, Vec3};

use super::bodies::{MovingBodies, rates_of};
use super::feature::nearest_points;
use super::nearest::Nearest;
use super::placed::PlacedShapes;

/// Derivatives of the distance of two shapes at one time, by the poses of their bodies and by their points.
pub(crate) struct DistanceGradient {
    shapes: [ShapeId; 2],
    /// Loads of bodies that move: one per shape, or one per end of a capsule between two bodies.
    bodies: [Option<BodyLoad>; 4],
    /// Loads of points that move all of a shape, and of the ends of capsules.
    points: [Option<PointLoad>; 4],
}

/// Factors of the sensitivity of a body in the distance, its rate and its acceleration.
struct BodyLoad {
    body: BodyId,
    factors: [f64; FACTORS],
}

/// Number of factors of a body: `F, F., F.., 2 F.`, those of pi' in the distance, its rate and its acceleration, and
/// that of omega' in the acceleration.
const FACTORS: usize = 24;

/// Force at a point of a body, with its rates.
struct PointLoad {
    point: PointId,
    body: BodyId,
    force: [Vec3; 3],
}

impl BodyLoad {
    /// Load of a force at a point of space, which acts on the point of the body that is there at each time; none of
    /// ground.
    fn of(body: BodyId, state: &BodyState, at: Vec3<Rates>, force: Vec3<Rates>) -> Option<Self> {
        if body == GROUND {
            return None;
        }
        let origin = Vec3::of_rates([state.r, state.v, state.a]);
        let [m, md, mdd] = rates((at - origin).cross(force));
        let BodyState { omega, alpha, .. } = *state;
        let turned = m.cross(omega);
        let [f, fd, fdd] = rates(force);
        let acceleration = mdd + md.cross(omega) * 2.0 + m.cross(alpha) + turned.cross(omega);
        let vectors = [f, fd, fdd, fd * 2.0, m, md + turned, acceleration, md * 2.0 + turned];
        let mut factors = [0.0; FACTORS];
        factors.chunks_exact_mut(3).zip(vectors).for_each(|(to, v)| to.copy_from_slice(&v.to_array()));
        Some(Self { body, factors })
    }
}

impl PointLoad {
    /// Distance, rate and acceleration by a change of the point within its body, in the frame of the body.
    fn by(&self, state: &BodyState, change: Vec3) -> [f64; 3] {
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
        placed: &PlacedShapes<'_, Rates, MovingBodies>,
        shapes: [ShapeId; 2],
        near: &Nearest,
    ) -> Option<Self> {
        let has_no_direction = near.is_tied || near.between.is_some();
        if !near.distance.is_finite() || has_no_direction || placed.is_without_direction(shapes, near) {
            return None;
        }
        let features = placed.features(shapes, near);
        let (at, n) = nearest_points(number::both(features.each_ref(), |(placed, _)| placed), near.points)?;
        let n = n * Rates::constant(near.sign);
        if near.sign == 0.0 || !rates(n)[0].is_finite() {
            return None;
        }
        let mut gradient =
            Self { shapes, bodies: [None, None, None, None], points: [None, None, None, None] };
        for (k, force) in [-n, n].into_iter().enumerate() {
            gradient.add(k, placed, at[k], force)?;
        }
        Some(gradient)
    }

    /// Adds the loads of shape k with a force at its nearest point; `None` if its derivatives are not those of loads.
    fn add(
        &mut self,
        k: usize,
        placed: &PlacedShapes<'_, Rates, MovingBodies>,
        at: Vec3<Rates>,
        force: Vec3<Rates>,
    ) -> Option<()> {
        let model = placed.model;
        let body_of = |p: PointId| model.points[p.0].body;
        let load = |body: BodyId, at, force| BodyLoad::of(body, placed.bodies.state_of(body), at, force);
        let (body, point) = match &model.shapes[self.shapes[k].0].kind {
            ShapeKind::Capsule { ends } => {
                let [a, b] = number::both(*ends, |p| placed.point(p));
                let along = b - a;
                let part = along.dot(at - a) / along.dot(along);
                let carriers = number::both(*ends, body_of);
                // Each end has the part of the force that the lever leaves to it.
                for (end, part) in [Rates::one() - part, part].into_iter().enumerate() {
                    let (n, own) = (2 * k + end, force * part);
                    self.points[n] =
                        Some(PointLoad { point: ends[end], body: carriers[end], force: rates(own) });
                    if carriers[0] != carriers[1] {
                        self.bodies[n] = load(carriers[end], [a, b][end], own);
                    }
                }
                if carriers[0] == carriers[1] {
                    self.bodies[2 * k] = load(carriers[0], at, force);
                }
                return Some(());
            }
            ShapeKind::Sphere { centre: point }
            | ShapeKind::Ring { centre: point, .. }
            | ShapeKind::Plane { point, .. } => (body_of(*point), Some(*point)),
            ShapeKind::Tyre { wheel, .. } => {
                let wheel = &model.wheels[wheel.0];
                (wheel.body, Some(wheel.centre))
            }
            ShapeKind::Cylinder { ends: [a, b], .. } if body_of(*a) == body_of(*b) => (body_of(*a), None),
            ShapeKind::Cylinder { .. } => return None,
            ShapeKind::Hull { points, .. } => (body_of(points[0]), None),
            ShapeKind::Mesh { body, .. } => (*body, None),
        };
        self.bodies[2 * k] = load(body, at, force);
        self.points[2 * k] = point.map(|point| PointLoad { point, body, force: rates(force) });
        Some(())
    }
}

/// Gradients at eight output times, in lanes. Those of one time may belong to other shapes than those of the next.
pub(crate) struct GradientBatch {
    first: usize,
    at: Vec<Option<DistanceGradient>>,
    /// Per body: zero at times at which it has no load.
    bodies: Vec<(BodyId, [Lanes; FACTORS])>,
    /// Points that move some shape.
    points: Vec<PointId>,
}

impl GradientBatch {
    /// Gradients at up to eight output times, of which this is the first.
    pub fn of(first: usize, at: Vec<Option<DistanceGradient>>) -> Self {
        let mut bodies: Vec<(BodyId, [Lanes; FACTORS])> = Vec::new();
        for (lane, gradient) in at.iter().enumerate() {
            for load in gradient.iter().flat_map(|gradient| gradient.bodies.iter().flatten()) {
                let known = bodies.iter().position(|(body, _)| *body == load.body).unwrap_or_else(|| {
                    bodies.push((load.body, [[0.0; LANES]; FACTORS]));
                    bodies.len() - 1
                });
                let factors = bodies[known].1.iter_mut().zip(load.factors);
                factors.for_each(|(to, factor)| to[lane] += factor);
            }
        }
        let loads = at.iter().flatten().flat_map(|gradient| gradient.points.iter().flatten());
        let mut points: Vec<PointId> = loads.map(|load| load.point).collect();
        points.sort_unstable();
        points.dedup();
        Self { first, at, bodies, points }
    }

    /// The shapes whose distance has a gradient at output time k.
    pub fn shapes(&self, k: usize) -> Option<[ShapeId; 2]> {
        self.at.get(k - self.first)?.as_ref().map(|gradient| gradient.shapes)
    }

    /// Derivatives of distance, rate and acceleration by a variable, at times at which there is a gradient. `fixed` has
    /// the derivatives of body-fixed data, which must move the shapes by their points only ([`moves_points_only`]).
    pub fn by(
        &self,
        variable: VariableId,
        (motion, sensitivities): (&Motion, &Sensitivities),
        fixed: &BodyFixed<Dual>,
    ) -> [Lanes; 3] {
        let mut sum = [[0.0; LANES]; 3];
        let mut d = [[0.0; LANES]; BodySensitivity::NUMBERS];
        for (body, factors) in self.bodies.iter().filter(|(body, _)| sensitivities.moves(variable, *body)) {
            sensitivities.gather(self.first, variable.0, body.0, &mut d);
            add_products(&mut sum, factors, &d);
        }
        let change = |p: PointId| fixed.points[p.0].map(|x| x.d);
        let are_still = self.points.iter().all(|p| change(*p) == Vec3::ZERO);
        for (lane, gradient) in self.at.iter().enumerate() {
            let Some(DistanceGradient { shapes, points, .. }) = gradient else { continue };
            let [a, b] = number::both(*shapes, |s| fixed.shapes[s.0].round.d);
            sum[0][lane] -= a + b;
            for load in points.iter().flatten().filter(|_| !are_still) {
                let change = change(load.point);
                if change != Vec3::ZERO {
                    let by = load.by(&motion.at(self.first + lane).body(load.body.0), change);
                    (0..3).for_each(|n| sum[n][lane] += by[n]);
                }
            }
        }
        sum
    }
}

/// Adds the products of the factors of a body with its sensitivity.
fn add_products(sum: &mut [Lanes; 3], factors: &[Lanes; FACTORS], d: &[Lanes; BodySensitivity::NUMBERS]) {
    let (factors, d) = (factors.as_chunks::<3>().0, d.as_chunks::<3>().0);
    let ([f, fd, fdd, twice_fd, t, td, tdd, spin], [dr, dpi, dv, domega, da, dalpha]) =
        (factors.first_chunk().expect("eight vectors"), d.first_chunk().expect("six vectors"));
    add(&mut sum[0], [(f, dr), (t, dpi)]);
    add(&mut sum[1], [(fd, dr), (f, dv), (td, dpi), (t, domega)]);
    add(&mut sum[2], [(fdd, dr), (twice_fd, dv), (f, da), (tdd, dpi), (spin, domega), (t, dalpha)]);
}

/// Adds scalar products, lane by lane.
#[inline(always)]
fn add<const N: usize>(sum: &mut Lanes, products: [(&[Lanes; 3], &[Lanes; 3]); N]) {
    let mut total = *sum;
    for (a, b) in products {
        for n in 0..3 {
            for lane in 0..LANES {
                total[lane] += a[n][lane] * b[n][lane];
            }
        }
    }
    *sum = total;
}

/// True if a variable changes a shape by points that move all of it, or the ends of a capsule, and by the radius around
/// its core: the force along its nearest points gives the derivative.
pub(crate) fn moves_points_only(model: &Model, fixed: &BodyFixed<Dual>, shape: ShapeId) -> bool {
    let is_constant = |x: Dual| x.d == 0.0;
    let is_still = |v: Vec3<Dual>| [v.x, v.y, v.z].into_iter().all(is_constant);
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

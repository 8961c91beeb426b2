//! Formulas of measures, over any number type. Signs are in `docs/measures.md`; loads are in `load/measures.rs`.

use crate::clearance::{NearestPair, PlacedShapes};
use crate::constraint::Row;
use crate::design::BodyFixed;
use crate::joint::Need;
use crate::model::element::ActsOn;
use crate::model::{
    ArmPlane, AxleMeasure, BodyId, ClearanceId, ElasticDirection, ElementId, JointId, MeasureKind, Model,
    OutputSource, PointId, Ray, WheelId, loads,
};
use crate::number::{self, Real};
use crate::space::{Opening, Pose, Vec3};

use super::wheel::{WheelAt, camber, toe};

/// Input data of measures at one time, as numbers with the requested derivatives.
#[derive(Clone, Copy)]
pub(crate) struct Instant<'a, T> {
    pub(super) model: &'a Model,
    pub(super) fixed: &'a BodyFixed<T>,
    /// Per body: where it is. Only those that measures name count.
    pub(super) poses: &'a [Pose<T>],
    /// Per measure: its value, where it depends on a driver; empty where these are not known.
    pub(super) slopes: &'a [T],
    /// Per measure: the whole turns, rad, that its angle has made; empty where they are not counted.
    pub(super) whole_turns: &'a [T],
    /// Per clearance: its nearest pair; empty where these are not known.
    pub(super) nearest: &'a [NearestPair],
}

impl<'a, T: Real> Instant<'a, T> {
    /// Outputs of bodies at these poses.
    pub fn new(model: &'a Model, fixed: &'a BodyFixed<T>, poses: &'a [Pose<T>]) -> Self {
        Self { model, fixed, poses, slopes: &[], whole_turns: &[], nearest: &[] }
    }

    /// All outputs, in the order of [`outputs`].
    pub fn all(&self, mut out: impl FnMut(T)) {
        for k in 0..self.model.measures.len() {
            out(self.measure(k));
        }
        for (k, _) in self.model.points.iter().enumerate().filter(|(_, p)| !p.unnamed) {
            let p = self.point(PointId(k));
            out(p.x);
            out(p.y);
            out(p.z);
        }
    }

    /// One output.
    pub fn output(&self, output: OutputSource) -> T {
        match output {
            OutputSource::Measure(k) => self.measure(k),
            OutputSource::Point(p, axis) => {
                let Vec3 { x, y, z } = self.point(p);
                [x, y, z][axis]
            }
        }
    }

    pub(super) fn point(&self, p: PointId) -> Vec3<T> {
        // P = r + A s
        self.poses[self.model.points[p.0].body.0].point(self.fixed.points[p.0])
    }

    /// Formulas and signs: `docs/measures.md`.
    pub(super) fn measure(&self, k: usize) -> T {
        let unknown = || T::constant(f64::NAN);
        if self.model.depends_on_step(k) {
            return self.slopes.get(k).copied().unwrap_or_else(unknown);
        }
        match &self.model.measures[k].kind {
            MeasureKind::Coordinate { joint, coordinate } => {
                let wrapped = self.coordinate(k, *joint, *coordinate);
                self.whole_turns.get(k).map_or(wrapped, |turns| wrapped + *turns)
            }
            // abs(P_to - P_from)
            MeasureKind::Distance { from, to } => self.length(self.point(*to) - self.point(*from)),
            MeasureKind::Coordinates { point, along } => {
                // n . P
                let p = self.point(*point);
                along.spread().dot(p)
            }
            MeasureKind::Angle { from, to, about } => {
                let within = angle_about(self.rays(k, [from, to]), *about);
                self.whole_turns.get(k).map_or(within, |turns| within + *turns)
            }
            MeasureKind::Orientation { body, angle, relative_to } => {
                // A_j, or A_i^T A_j
                let rot = self.poses[body.0].rot;
                let rot = relative_to.map_or(rot, |i| self.poses[i.0].rot.transpose() * rot);
                let within = angle.angles.of(rot)[angle.place];
                self.whole_turns.get(k).map_or(within, |turns| within + *turns)
            }
            MeasureKind::TransmissionAngle { from, to } => {
                let [a, b] = self.rays(k, [from, to]);
                let (across, along) = (a.cross(b), a.dot(b));
                // atan2(abs(a x b), abs(a . b)): between lines, 0 to 90 deg, where it has a kink, too
                let angle = angle_between(across, along.abs());
                let least = across.dot(across) * T::constant(PARALLEL * PARALLEL);
                if (along * along).exceeds(least) { angle } else { angle.without_derivatives() }
            }
            // n . v or abs(v),    n . omega or abs(omega),    n . a or abs(a)
            MeasureKind::Velocity { point, along } => {
                let v = self.point(*point).map(T::rate);
                along.map_or_else(|| speed(v, self.fixed.size), |n| n.spread().dot(v))
            }
            MeasureKind::AngularVelocity { body, along } => {
                let omega = self.angular_velocity(*body);
                along.map_or_else(|| speed(omega, 1.0), |n| n.spread().dot(omega))
            }
            MeasureKind::Acceleration { point, along } => {
                component(self.point(*point).map(T::rate).map(T::rate), *along)
            }
            MeasureKind::Curvature { point, about } => {
                let v = self.point(*point).map(T::rate);
                let a = v.map(T::rate);
                // n . (v x a) / abs(v)^3, or abs(v x a) / abs(v)^3; NaN if v^2 <= 1e-12 abs(a) size, for a point that
                // starts from rest
                let (turn, speed) = (v.cross(a), v.norm());
                let turn = about.map_or_else(|| turn.norm(), |about| about.spread().dot(turn));
                let (way, far) = (speed * speed, a.norm() * T::constant(RESTS * self.fixed.size));
                let way = if way.exceeds(far) { way } else { unknown() };
                turn / (way * speed)
            }
            MeasureKind::Clearance { of } => {
                let Self { model, fixed, poses, .. } = *self;
                PlacedShapes { model, fixed, bodies: poses }.clearance(*of, self.nearest)
            }
            MeasureKind::Deflection { force, direction } => {
                let within = self.deflection(k, force.0, *direction);
                self.whole_turns.get(k).map_or(within, |turns| within + *turns)
            }
            MeasureKind::Articulation { joint, axis } => self.articulation(k, *joint, axis.is_some()),
            MeasureKind::Rate { of } => self.output(*of).rate(),
            MeasureKind::Combination { expression } => expression.at(|source| self.output(source)),
            MeasureKind::Toe { body, spin_axis } => {
                // atan2(e_x, s e_y) and -asin(e_z)
                let side = self.model.side_of_axis(*spin_axis);
                toe(self.direction(k, 0, *body), T::constant(side.sign()))
            }
            MeasureKind::Camber { body, .. } => camber(self.direction(k, 0, *body)),
            MeasureKind::Wheel { wheel, what } => {
                let now = self.wheel(k, 0, *wheel);
                now.measure(*what, || self.wheel_as_drawn(k, 0, *wheel))
            }
            MeasureKind::Axle { axle, what } => self.axle(k, self.model.axles[axle.0].wheels, *what),
            // What depends on the step, above.
            MeasureKind::Slope { .. }
            | MeasureKind::Dexterity { .. }
            | MeasureKind::Compliance { .. }
            | loads!() => unknown(),
        }
    }

    /// A body's angular velocity, global.
    fn angular_velocity(&self, body: BodyId) -> Vec3<T> {
        // a. = omega x a of each axis, so  sum a x a. = 3 omega - sum a (a . omega) = 2 omega
        let turns = number::each(&self.poses[body.0].rot.cols, |a| a.cross(a.map(T::rate)));
        (turns[0] + turns[1] + turns[2]) * T::constant(0.5)
    }

    /// The directions of an angle, of any length.
    fn rays(&self, k: usize, rays: [&Ray; 2]) -> [Vec3<T>; 2] {
        number::both([0, 1], |end| match *rays[end] {
            Ray::Between([from, to]) => self.point(to) - self.point(from),
            Ray::Fixed { body, .. } => self.direction(k, end, body),
        })
    }

    /// Formulas and signs: `docs/measures.md`.
    fn axle(&self, k: usize, wheels: [WheelId; 2], what: AxleMeasure) -> T {
        let [left, right] = number::both([0, 1], |side| self.wheel(k, side, wheels[side]));
        let toe = |wheel: &WheelAt<T>| toe(wheel.spin_axis, wheel.side);
        let half = T::constant(0.5);
        let wheelbase = || T::constant(self.model.vehicle.wheelbase.unwrap_or(f64::NAN));
        let track = left.contact().y - right.contact().y;
        // Headings to the left are a = -toe_L and b = toe_R, with mean (a + b) / 2. In a turn of either direction the
        // heading of the inner wheel is i = (abs(a + b) + a - b) / 2, of the outer one o = (abs(a + b) - a + b) / 2.
        let turning = || {
            let (a, b) = (-toe(&left), toe(&right));
            let (sum, apart) = ((a + b).abs(), (a - b) * half);
            // Straight ahead inner and outer wheel change, which is a kink: derivatives by the design are the mean of
            // those of both sides, and while the axle steers through it there are no rates.
            let mean = if sum.exceeds(T::constant(KINK)) {
                sum * half
            } else if (a + b).rate().abs().exceeds(T::constant(KINK)) {
                T::zero().rate().rate()
            } else {
                T::zero()
            };
            (mean, mean + apart, mean - apart)
        };
        match what {
            AxleMeasure::Track => track,
            AxleMeasure::TotalToe => toe(&left) + toe(&right),
            AxleMeasure::AckermannError => {
                let (_, inner, outer) = turning();
                // o - r
                outer - outer_by_ackermann(inner, track / wheelbase())
            }
            AxleMeasure::Ackermann => {
                let (mean, inner, outer) = turning();
                // (i - o) / (i - r)
                let full = inner - outer_by_ackermann(inner, track / wheelbase());
                (inner - outer) / beyond(full, mean, STEERS)
            }
            AxleMeasure::TurningRadius => {
                let (_, inner, outer) = turning();
                // The outer wheel steers less, or against Ackermann the inner one.
                let least = -(-inner).larger(-outer);
                // wheelbase / sin(the lesser heading)
                wheelbase() / beyond(least.sin_cos().0, least, STRAIGHT)
            }
            AxleMeasure::RollCentreY | AxleMeasure::RollCentreHeight => T::constant(f64::NAN),
        }
    }

    /// The wheel whose spin axis is direction d of measure k.
    pub(super) fn wheel(&self, k: usize, d: usize, wheel: WheelId) -> WheelAt<T> {
        self.wheel_at(k, d, wheel, &|b| self.poses[b.0])
    }

    /// The same in the design configuration.
    fn wheel_as_drawn(&self, k: usize, d: usize, wheel: WheelId) -> WheelAt<T> {
        self.wheel_at(k, d, wheel, &|b| self.model.bodies[b.0].frame.spread())
    }

    fn wheel_at(&self, k: usize, d: usize, wheel: WheelId, pose: &dyn Fn(BodyId) -> Pose<T>) -> WheelAt<T> {
        let wheel = &self.model.wheels[wheel.0];
        let point = |p: PointId| pose(self.model.points[p.0].body).point(self.fixed.points[p.0]);
        let centre = point(wheel.centre);
        WheelAt {
            centre,
            // e = A e', e' fixed in the knuckle
            spin_axis: pose(wheel.body).rot * self.fixed.directions[k][d].expect("a wheel has a spin axis"),
            radius: T::constant(wheel.radius),
            side: T::constant(wheel.side.sign()),
            kingpin: wheel.kingpin.map(|points| number::both(points, point)),
            planes: wheel.planes.map(|planes| {
                number::both(planes, |plane| match plane {
                    // (B - A) x (C - A),    B - A
                    ArmPlane::Through(points) => {
                        let [a, b, c] = number::each(&points, point);
                        [(b - a).cross(c - a), a]
                    }
                    ArmPlane::Square(points) => {
                        let [a, b] = number::both(points, point);
                        [b - a, a]
                    }
                })
            }),
            // abs(P_2 - P_1)
            spring: wheel.spring.map(|ends| {
                let [a, b] = number::both(ends, point);
                self.length(b - a)
            }),
        }
    }

    /// Direction d of measure k, which is fixed in this body.
    fn direction(&self, k: usize, d: usize, body: BodyId) -> Vec3<T> {
        // a = A a'
        self.poses[body.0].rot * self.fixed.directions[k][d].expect("a measure with directions")
    }

    /// Angle between both images of a direction that is fixed in the bodies of a joint.
    fn articulation(&self, k: usize, joint: JointId, by_axis: bool) -> T {
        let j = &self.model.joints[joint.0];
        // atan2(abs(a_i x a_j), a_i . a_j)
        let between = |[a, b]: [Vec3<T>; 2]| angle_between(a.cross(b), a.dot(b));
        if by_axis {
            return between(number::both([0, 1], |end| self.direction(k, end, j.bodies[end])));
        }
        let markers = self.fixed.markers[k].expect("a measure of a joint");
        let axis = |end: usize, c: usize| self.poses[j.bodies[end].0].rot * markers[end].rot.cols[c];
        if j.axis.is_some() && j.kind.axis != Need::Orienting {
            // The shafts of a cross are perpendicular to both pins.
            let along = if j.kind.is_cross() { 1 } else { 2 };
            return between(number::both([0, 1], |end| axis(end, along)));
        }
        // sum a_i x a_j = 2 sin(angle) n,   sum a_i . a_j = 1 + 2 cos(angle),   over x, y and z
        let pairs = number::each(&[0, 1, 2], |c| (axis(0, c), axis(1, c)));
        let [x, y, z] = number::each(&pairs, |(a, b)| (a.cross(b), a.dot(b)));
        angle_between(x.0 + y.0 + z.0, x.1 + y.1 + z.1 - T::constant(1.0))
    }

    /// Displacement between both markers of an elastic joint or bushing in one direction.
    fn deflection(&self, k: usize, element: ElementId, direction: ElasticDirection) -> T {
        let force = self.model.elements[element.0].kind.force(self.model);
        let acts_on = force.expect("an elastic joint or bushing").acts_on;
        let markers = self.fixed.markers[k].expect("a measure of a deflection");
        let bodies = acts_on.bodies(self.model);
        let [i, j] = number::both([0, 1], |end| self.poses[bodies[end].0].compose(markers[end]));
        let is_cross = matches!(acts_on, ActsOn::Joint(joint) if self.model.joints[joint.0].kind.is_cross());
        let between = if is_cross { Opening::of_cross } else { Opening::between };
        between(&i, &j, T::zero()).coordinates[direction.0]
    }

    /// Length of a vector; without derivatives where it is zero but for round-off.
    fn length(&self, v: Vec3<T>) -> T {
        let least = T::constant((MEETS * self.fixed.size).powi(2));
        if v.dot(v).exceeds(least) { v.norm() } else { v.norm().without_derivatives() }
    }

    /// A joint's coordinate between its two markers, whether the joint is cut or not.
    fn coordinate(&self, k: usize, joint: JointId, coordinate: usize) -> T {
        let j = &self.model.joints[joint.0];
        let markers = self.fixed.markers[k].expect("a measure of a joint's coordinate");
        // Axes and origins of the joint's markers: A C e_k and r + A s
        let axis = |end: usize, k: usize| self.poses[j.bodies[end].0].rot * markers[end].rot.cols[k];
        let origin = |end: usize| self.poses[j.bodies[end].0].point(markers[end].r);
        match j.kind.coordinates[coordinate].row {
            // atan2(y_i . x_j, x_i . x_j)
            Row::Angle | Row::Heading => axis(0, 1).dot(axis(1, 0)).atan2(axis(0, 0).dot(axis(1, 0))),
            // atan2(z_i . y_j, z_i . z_j)
            Row::AngleOnJ | Row::HeadingOnJ => axis(0, 2).dot(axis(1, 1)).atan2(axis(0, 2).dot(axis(1, 2))),
            // atan2(-x_i . y_j, x_i . x_j)
            Row::CardanAngle => (-axis(0, 0).dot(axis(1, 1))).atan2(axis(0, 0).dot(axis(1, 0))),
            // atan2(y_i . z_j, x_i . z_j)
            Row::Course => axis(0, 1).dot(axis(1, 2)).atan2(axis(0, 0).dot(axis(1, 2))),
            // a_i . (P_j - P_i)
            Row::Dot2(k) => axis(0, k).dot(origin(1) - origin(0)),
            // abs(P_j - P_i)
            Row::Distance
            | Row::Point(_)
            | Row::PointOnBase(_)
            | Row::Dot1(..)
            | Row::Cosine
            | Row::Offset
            | Row::Contact
            | Row::ConstantVelocity
            | Row::LowestPoint(_) => self.length(origin(1) - origin(0)),
        }
    }
}

/// True if an output is a formula over others, or the rate of one: what depends on angles with all their turns.
pub(crate) fn is_formula(model: &Model, output: usize) -> bool {
    let Some(measure) = model.measures.get(output) else { return false };
    if let MeasureKind::Rate { of: OutputSource::Measure(m) } = measure.kind {
        return is_formula(model, m);
    }
    matches!(measure.kind, MeasureKind::Combination { .. })
}

/// The component of a vector along a unit vector, or its magnitude.
fn component<T: Real>(v: Vec3<T>, along: Option<Vec3>) -> T {
    along.map_or_else(|| v.norm(), |along| along.spread().dot(v))
}

/// Angle from one direction to another, between them or about n.
fn angle_about<T: Real>([a, b]: [Vec3<T>; 2], about: Option<Vec3>) -> T {
    // atan2(abs(a x b), a . b); about n, for the projections along it:
    // atan2(n . (a x b), a . b - (n . a) (n . b))
    let (across, along) = (a.cross(b), a.dot(b));
    let Some(n) = about.map(Vec3::spread) else { return angle_between(across, along) };
    let (sin, cos) = (n.dot(across), along - n.dot(a) * n.dot(b));
    // A direction along n has no projection: NaN.
    let least = a.dot(a) * b.dot(b) * T::constant(PARALLEL * PARALLEL);
    let projected = sin * sin + cos * cos;
    if projected.exceeds(least) { sin.atan2(cos) } else { T::constant(f64::NAN).without_derivatives() }
}

/// Angle in [0, pi] from the magnitude of its sine and its cosine, times any positive number. Where it is 0 or pi but
/// for round-off, the magnitude has a kink, and the angle no derivatives; without any direction it is NaN.
fn angle_between<T: Real>(sine: Vec3<T>, cosine: T) -> T {
    let angle = sine.norm().atan2(cosine);
    if sine.dot(sine).exceeds(cosine * cosine * T::constant(PARALLEL * PARALLEL)) {
        angle
    } else if cosine.decisive() == 0.0 {
        T::constant(f64::NAN).without_derivatives()
    } else {
        angle.without_derivatives()
    }
}

/// Magnitude of a velocity of anything of this size; without derivatives at rest.
fn speed<T: Real>(v: Vec3<T>, size: f64) -> T {
    let (square, a) = (v.dot(v), v.map(T::rate));
    // v^2 <= 1e-12 abs(a) size
    if (square * square).exceeds(a.dot(a) * T::constant((RESTS * size).powi(2))) {
        v.norm()
    } else {
        v.norm().without_derivatives()
    }
}

/// Largest angle between two directions, rad, that are parallel (or of two lines that are perpendicular) but for
/// round-off. Their cross product has an error of some 1e-13, so that its direction is known to 1e-7 beyond. Rates of
/// the angle are those of the cross product along it: below, they would be round-off divided by round-off.
const PARALLEL: f64 = 1e-6;

/// Distance of two points that meet, as a fraction of the mechanism's size: a thousand times the error of a position.
const MEETS: f64 = 1e-9;

/// A point that came from rest, at its acceleration, within this part of the mechanism's size rests: its speed is
/// round-off, and its path has no curvature there.
const RESTS: f64 = 1e-12;

/// A wheel that heads less into the turn than this, rad, drives straight ahead: the turning radius would be some 30 km.
const STRAIGHT: f64 = 1e-4;
/// A sum of headings below this is zero but for round-off, rad; and so is its rate, rad/s: of a symmetric axle in pure
/// bump.
const KINK: f64 = 1e-9;

/// An axle whose wheels head less aside than this in the mean, 1 degree in rad, is not steered: static toe and bump
/// steer are of that size, while Ackermann's difference of the two headings falls with the square of the angle (0.01
/// degrees here), so that its part would be a quotient of toe by next to nothing.
const STEERS: f64 = std::f64::consts::PI / 180.0;

/// A number for division; NaN where an angle does not exceed a limit.
fn beyond<T: Real>(x: T, angle: T, limit: f64) -> T {
    if angle.exceeds(T::constant(limit)) { x } else { T::constant(f64::NAN) }
}

/// The heading into the turn of the outer wheel that turns about the same point of the other axle's line as the inner
/// one with heading i: `cot r = cot i + track / wheelbase`, without the poles.
fn outer_by_ackermann<T: Real>(i: T, track_by_wheelbase: T) -> T {
    let (sin, cos) = i.sin_cos();
    // r = atan2(sin i, cos i + sin i track / wheelbase)
    sin.atan2(cos + sin * track_by_wheelbase)
}

/// The clearance that an output is, if it is one.
pub(crate) fn clearance_of(model: &Model, output: OutputSource) -> Option<ClearanceId> {
    let OutputSource::Measure(k) = output else { return None };
    if let MeasureKind::Clearance { of } = model.measures[k].kind { Some(of) } else { None }
}

/// The clearances that an output is computed from.
pub fn clearances_of(model: &Model, output: OutputSource) -> Vec<ClearanceId> {
    let OutputSource::Measure(k) = output else { return Vec::new() };
    let sources = model.measures[k].kind.sources().into_iter();
    let of_sources = sources.flat_map(|source| clearances_of(model, source));
    clearance_of(model, output).into_iter().chain(of_sources).collect()
}

/// The bodies that measures and named points are fixed in.
pub(crate) fn bodies_asked_for(model: &Model) -> Vec<usize> {
    let mut bodies: Vec<usize> = model.points.iter().map(|p| p.body.0).collect();
    bodies.extend(model.measures.iter().flat_map(|m| model.bodies_of(m)).map(|b| b.0));
    bodies.sort_unstable();
    bodies.dedup();
    bodies
}

//! Applied loads on the bodies, and the wrenches that their motion requires: (43) and (44) of `docs/theory.md`, over
//! any number.
//!
//! Signs and formulas of the elements are those of `docs/loads.md`.

use crate::constraint::MarkerPair;
use crate::design::Geometry;
use crate::measure::WheelAt;
use crate::model::{
    Axes, BodyId, ENDS_MEET, ElementId, ElementKind, Inertia, Joint, JointId, Length, LoadMode, Model,
    NumberId, PointId, Stiffness, TorsionalStiffness, Wheel, WheelId, about_centre,
};
use crate::space::{Mat3, Pose, Real, Twist, Vec3, Wrench};

/// Pose, velocity and acceleration of a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MovingBody<T> {
    /// Pose of the body.
    pub pose: Pose<T>,
    /// Twist V.
    pub v: Twist<T>,
    /// Acceleration A = dV/dt.
    pub a: Twist<T>,
}

impl<T: Real> MovingBody<T> {
    /// A body at rest, at the identity pose.
    pub fn still() -> Self {
        Self { pose: Pose::IDENTITY.spread(), v: Twist::zero(), a: Twist::zero() }
    }

    /// Velocity of the body point at `p`.
    fn velocity(&self, p: Vec3<T>) -> Vec3<T> {
        self.v.at(p)
    }

    /// Acceleration of the body point at `p`: A at p + omega x v.
    fn acceleration(&self, p: Vec3<T>) -> Vec3<T> {
        self.v.w.cross_plus(self.v.at(p), self.a.at(p))
    }
}

/// Data of all applied loads at one time.
#[derive(Clone, Copy)]
pub(crate) struct AppliedLoads<'a, T> {
    pub model: &'a Model,
    pub geometry: &'a Geometry<T>,
    /// Per body.
    pub bodies: &'a [MovingBody<T>],
    /// Per element: the value of its law.
    pub laws: &'a [T],
    /// Per element: approximate value of the coordinate that it acts on, to count whole turns of angles.
    pub near: &'a [T],
    /// Per element: the moment or force of friction on its coordinate; for a ball joint, per unit of its rotation.
    pub friction: &'a [T],
}

/// Mass properties at the current pose.
pub(super) struct Solid<T> {
    pub body: BodyId,
    pub mass: T,
    pub centre: Vec3<T>,
    pub inertia: Spread<T>,
}

/// Moments of inertia about the centre.
pub(super) enum Spread<T> {
    /// Axes, and the matrix along them.
    Matrix(Mat3<T>, Mat3<T>),
    /// Rotationally symmetric: the line, the moment about it, and the moment about any perpendicular axis.
    Line(Vec3<T>, T, T),
}

impl<T: Real> Spread<T> {
    /// I w.
    pub fn on(&self, w: Vec3<T>) -> Vec3<T> {
        match self {
            Self::Matrix(axes, matrix) => *axes * (*matrix * axes.transpose_mul(w)),
            // I = I_t 1 + (I_a - I_t) u u^T
            Self::Line(u, axial, across) => u.times_plus((*axial - *across) * u.dot(w), w * *across),
        }
    }
}

impl<T: Real> AppliedLoads<'_, T> {
    /// Computes per body, ground included, F = f - g: the wrench that its joints must apply.
    pub fn needed(&self, out: &mut [Wrench<T>]) {
        out.fill(Wrench::zero());
        for k in 0..self.model.elements.len() {
            self.add(ElementId(k), out);
        }
    }

    fn number(&self, n: NumberId) -> T {
        self.geometry.numbers[n.0]
    }

    /// An optional number; zero by default.
    fn or_zero(&self, n: Option<NumberId>) -> T {
        n.map_or_else(T::zero, |n| self.number(n))
    }

    fn body(&self, point: PointId) -> usize {
        self.model.points[point.0].body.0
    }

    /// Position of a point: r + A s.
    pub fn point(&self, point: PointId) -> Vec3<T> {
        self.bodies[self.body(point)].pose.point(self.geometry.points[point.0])
    }

    /// Length at which the tension of a spring is its preload.
    fn free_length(&self, from: PointId, to: PointId, given: Option<Length>) -> T {
        match given {
            Some(free) => self.number(free.0),
            // L_o of the design configuration, which depends on the design
            None => (self.design_position(to) - self.design_position(from)).norm(),
        }
    }

    /// Distance between the ends of a spring; NaN if they coincide, since the direction is then undefined.
    fn apart(&self, d: Vec3<T>) -> T {
        let length = d.norm();
        let limit = T::constant(ENDS_MEET * self.geometry.size);
        if length.exceeds(limit) { length } else { T::constant(f64::NAN) }
    }

    /// Position of a point in the design configuration of this design.
    fn design_position(&self, point: PointId) -> Vec3<T> {
        let frame: Pose<T> = self.model.bodies[self.body(point)].frame.spread();
        frame.point(self.geometry.points[point.0])
    }

    /// Global axes of the design configuration, rotated with a body.
    pub fn turned(&self, body: usize) -> Mat3<T> {
        self.bodies[body].pose.rot * self.model.bodies[body].frame.rot.transpose().spread()
    }

    /// Mass properties of an element at the current pose.
    pub fn solid(&self, kind: &ElementKind) -> Option<Solid<T>> {
        let zero = T::zero();
        let body = kind.mass_on(self.model)?;
        Some(match kind {
            ElementKind::Rigid { centre, mass, ixx, iyy, izz, ixy, iyz, izx, about } => {
                let of = |n: &Option<Inertia>| n.map(|n| self.number(n.0));
                let given = [[ixx, iyy, izz].map(of), [ixy, iyz, izx].map(of)];
                let mass = self.number(mass.0);
                let [[a, b, c], [d, e, f]] = match about {
                    Some(about) => about_centre(
                        mass,
                        self.design_position(*centre) - self.design_position(*about),
                        given,
                    ),
                    None => given.map(|list| list.map(|n| n.unwrap_or(zero))),
                };
                let cols = [Vec3::new(a, -d, -f), Vec3::new(-d, b, -e), Vec3::new(-f, -e, c)];
                let inertia = Spread::Matrix(self.turned(body.0), Mat3 { cols });
                Solid { body, mass, centre: self.point(*centre), inertia }
            }
            ElementKind::Mesh { mesh, density, .. } => {
                let density = self.number(density.0);
                let (pose, frame) = (self.bodies[body.0].pose, self.model.bodies[body.0].frame);
                let place = if mesh.in_body { mesh.centre } else { frame.inverse().point(mesh.centre) };
                let axes = if mesh.in_body { pose.rot } else { self.turned(body.0) };
                let cols = mesh.inertia().map(|col| col.spread() * density);
                let inertia = Spread::Matrix(axes, Mat3 { cols });
                let centre = pose.point(place.spread());
                Solid { body, mass: density * T::constant(mesh.volume), centre, inertia }
            }
            ElementKind::Bar { from, to, diameter, bore, density } => {
                let [p, q] = [*from, *to].map(|p| self.point(p));
                let (outer, bore) = (self.number(diameter.0), self.or_zero(bore.map(|b| b.0)));
                let d = q - p;
                let length = d.norm();
                let (outer, bore) = (outer * outer, bore * bore);
                // m = rho pi/4 (D^2 - d^2) L,   I_a = m (D^2 + d^2)/8,   I_t = I_a/2 + m L^2/12
                let area = (outer - bore) * T::constant(std::f64::consts::FRAC_PI_4);
                let mass = self.number(density.0) * area * length;
                let axial = mass * (outer + bore) * T::constant(0.125);
                let across = axial * T::constant(0.5) + mass * length * length * T::constant(1.0 / 12.0);
                let inertia = Spread::Line(d * (T::one() / length), axial, across);
                Solid { body, mass, centre: (p + q) * T::constant(0.5), inertia }
            }
            ElementKind::Block { centre, x, y, z, density } => {
                let [x, y, z] = [x, y, z].map(|n| self.number(n.0));
                let mass = self.number(density.0) * x * y * z;
                let twelfth = mass * T::constant(1.0 / 12.0);
                let [a, b, c] = [y * y + z * z, z * z + x * x, x * x + y * y].map(|square| square * twelfth);
                let cols = [Vec3::new(a, zero, zero), Vec3::new(zero, b, zero), Vec3::new(zero, zero, c)];
                let inertia = Spread::Matrix(self.turned(body.0), Mat3 { cols });
                Solid { body, mass, centre: self.point(*centre), inertia }
            }
            _ => return None,
        })
    }

    /// Adds the contribution of an element to `f - g` of the bodies: its inertial wrench, or minus its applied wrench.
    pub fn add(&self, e: ElementId, out: &mut [Wrench<T>]) {
        let kind = &self.model.elements[e.0].kind;
        if let Some(Solid { body, mass, centre, inertia }) = self.solid(kind) {
            let moving = &self.bodies[body.0];
            let weight: Vec3<T> = self.model.gravity.spread();
            match self.model.load_mode {
                // f = m (a_c - g0) at c,   m = I alpha + omega x I omega                                        (43)
                LoadMode::Dynamic => {
                    let force = (moving.acceleration(centre) - weight) * mass;
                    let spin = moving.v.w.cross_plus(inertia.on(moving.v.w), inertia.on(moving.a.w));
                    out[body.0] += Wrench::force(force, centre);
                    out[body.0] += Wrench::moment(spin);
                }
                // f = -m g0 at c
                LoadMode::Static => out[body.0] += Wrench::force(-weight * mass, centre),
            }
            return;
        }
        match kind {
            ElementKind::Spring { from, to, .. } => {
                let (p, q) = (self.point(*from), self.point(*to));
                let d = q - p;
                // s pulls both ends along the line between them                                                 (44)
                let pull = d * (self.size(e) / self.apart(d));
                out[self.body(*to)] += Wrench::force(pull, q);
                out[self.body(*from)] -= Wrench::force(pull, q);
            }
            ElementKind::JointSpring { .. }
            | ElementKind::TorsionSpring { .. }
            | ElementKind::Friction { .. }
            | ElementKind::SlideFriction { .. } => {
                let Some((joint, l)) = self.unit(e) else { return };
                let tau = if kind.rubs() { self.friction[e.0] } else { self.size(e) };
                // g_j = tau l, g_i = -tau l: tau works on the coordinate                                        (44)
                let push = l.times_plus(tau, Wrench::zero());
                let [i, j] = self.model.joints[joint].bodies;
                out[j.0] -= push;
                out[i.0] += push;
            }
            ElementKind::PointForce { at, along, axes, .. } => {
                let body = self.body(*at);
                let push = self.along(*along, *axes, body) * self.size(e);
                out[body] -= Wrench::force(push, self.point(*at));
            }
            ElementKind::WheelForce { wheel, .. } => {
                let (contact, push) = self.road(e, *wheel);
                out[self.model.wheels[wheel.0].body.0] -= Wrench::force(push, contact);
            }
            ElementKind::BodyMoment { body, about, axes, .. } => {
                let turn = self.along(*about, *axes, body.0) * self.size(e);
                out[body.0] -= Wrench::moment(turn);
            }
            ElementKind::Bushing { from, to, .. } => {
                let push = self.bushing(kind);
                out[self.body(*to)] -= push;
                out[self.body(*from)] += push;
            }
            ElementKind::Rigid { .. }
            | ElementKind::Bar { .. }
            | ElementKind::Block { .. }
            | ElementKind::Mesh { .. }
            | ElementKind::ElasticJoint { .. } => {}
        }
    }

    /// A direction in global axes at the current pose.
    fn along(&self, direction: Vec3, axes: Option<Axes>, body: usize) -> Vec3<T> {
        match axes.unwrap_or_default() {
            Axes::Global | Axes::Joint => direction.spread(),
            Axes::Body => self.turned(body) * direction.spread(),
        }
    }

    /// The joint whose coordinate an element acts on, its markers, and the row that measures the coordinate.
    fn row_of(&self, kind: &ElementKind) -> Option<(usize, MarkerPair<T>, crate::constraint::Row)> {
        let (joint, coordinate) = kind.coordinate(self.model)?;
        let j = &self.model.joints[joint.0];
        let [m_i, m_j] = self.geometry.markers[joint.0];
        let [i, j_pose] = j.bodies.map(|b| self.bodies[b.0].pose);
        let axes = Mat3::IDENTITY.spread();
        let ends = MarkerPair { i: i.compose(m_i), j: j_pose.compose(m_j), axes };
        Some((joint.0, ends, j.kind.coordinates[coordinate].row))
    }

    /// Magnitude of a force: the tension of a spring, the generalised force of a joint spring, or the size of a given
    /// force.
    pub fn size(&self, e: ElementId) -> T {
        let kind = &self.model.elements[e.0].kind;
        match kind {
            ElementKind::Spring { from, to, preload, damping, .. } => {
                let (p, q) = (self.point(*from), self.point(*to));
                let d = q - p;
                // s = p + k (L - L_o) + k_3 (L - L_o)^3 + f T(L - L_o) + c L.
                let mut tension = self.pull(kind, d.norm())[0] + self.or_zero(preload.map(|n| n.0));
                if let Some(damping) = damping {
                    let velocity =
                        self.bodies[self.body(*to)].velocity(q) - self.bodies[self.body(*from)].velocity(p);
                    tension += self.number(damping.0) * (d.dot(velocity) / self.apart(d));
                }
                tension
            }
            ElementKind::JointSpring { stiffness, equilibrium, damping, .. } => {
                self.on_coordinate(e, stiffness.0, equilibrium.map(|n| n.0), damping.map(|n| n.0))
            }
            ElementKind::TorsionSpring { stiffness, equilibrium, damping, .. } => {
                self.on_coordinate(e, stiffness.0, equilibrium.map(|n| n.0), damping.map(|n| n.0))
            }
            ElementKind::Friction { .. } | ElementKind::SlideFriction { .. } => match self.ball(kind) {
                Some((_, turn)) => self.friction[e.0] * magnitude(self.heading(kind, turn), STILL),
                None => self.friction[e.0],
            },
            // A zero force has no derivative.
            ElementKind::WheelForce { wheel, .. } => self.road(e, *wheel).1.norm(),
            ElementKind::PointForce { force, .. } => self.number(force.0) * self.laws[e.0],
            ElementKind::BodyMoment { moment, .. } => self.number(moment.0) * self.laws[e.0],
            ElementKind::Bushing { .. } => self.bushing(kind).f.norm(),
            ElementKind::Rigid { .. }
            | ElementKind::Bar { .. }
            | ElementKind::Block { .. }
            | ElementKind::Mesh { .. }
            | ElementKind::ElasticJoint { .. } => T::zero(),
        }
    }

    /// Tension of a spring from its deflection, and its derivative by the length.
    fn pull(&self, kind: &ElementKind, length: T) -> [T; 2] {
        let ElementKind::Spring { from, to, stiffness, cubic, scale, free_length, .. } = kind else {
            return [T::zero(); 2];
        };
        let way = length - self.free_length(*from, *to, *free_length);
        let stiffness = self.or_zero(stiffness.map(|n| n.0));
        let (mut pull, mut slope) = (stiffness * way, stiffness);
        if let Some(cubic) = cubic {
            let cubic = self.number(cubic.0) * way * way;
            // ds/dL = k + 3 k_3 (L - L_o)^2 + f T'(L - L_o)
            (pull, slope) = (pull + cubic * way, slope + cubic * T::constant(3.0));
        }
        if let Some(table) = kind.table() {
            let scale = scale.map_or_else(T::one, |n| self.number(n.0));
            let [force, by_way] = table.at(way);
            (pull, slope) = (pull + scale * force, slope + scale * by_way);
        }
        [pull, slope]
    }

    /// Point at which the road acts on a wheel, and the force.
    fn road(&self, e: ElementId, wheel: WheelId) -> (Vec3<T>, Vec3<T>) {
        let ElementKind::WheelForce { outboard, forward, up, .. } = &self.model.elements[e.0].kind else {
            return (Vec3::zero(), Vec3::zero());
        };
        let now = self.wheel(wheel);
        let [o, f, z] = [outboard, forward, up].map(|n| self.or_zero(n.map(|n| n.0)));
        let push = now.outboard() * o + now.forward() * f + Vec3::AXES[2].spread() * z;
        (now.contact(), push * self.laws[e.0])
    }

    /// A wheel at the current pose.
    pub fn wheel(&self, wheel: WheelId) -> WheelAt<T> {
        let Wheel { body, centre, radius, side, .. } = &self.model.wheels[wheel.0];
        WheelAt {
            centre: self.point(*centre),
            // e = A e', e' fixed in the knuckle
            spin_axis: self.bodies[body.0].pose.rot * self.geometry.spin_axes[wheel.0],
            radius: T::constant(*radius),
            side: T::constant(side.sign()),
            kingpin: None,
            planes: None,
            spring: None,
        }
    }

    /// Joint of the friction in a ball joint, and the angular velocity of its second body relative to the first.
    fn ball(&self, kind: &ElementKind) -> Option<(JointId, Vec3<T>)> {
        let ElementKind::Friction { joint, .. } = kind else { return None };
        let Joint { kind: of, bodies, .. } = &self.model.joints[joint.0];
        let [i, j] = bodies.map(|b| self.bodies[b.0].v.w);
        of.coordinates.is_empty().then(|| (*joint, j - i))
    }

    /// Direction of rotation in a ball joint, regularised at low speed: `omega / sqrt(omega^2 + w_0^2)`.
    fn heading(&self, kind: &ElementKind, turn: Vec3<T>) -> Vec3<T> {
        turn * (T::one() / magnitude_with(turn, self.transition_velocity(kind)))
    }

    /// Unit wrench of an element, which does work on its coordinate or on the rotation of a ball joint; with its joint.
    pub fn unit(&self, e: ElementId) -> Option<(usize, Wrench<T>)> {
        let kind = &self.model.elements[e.0].kind;
        if let Some((joint, turn)) = self.ball(kind) {
            return Some((joint.0, Wrench::moment(self.heading(kind, turn))));
        }
        let (joint, ends, row) = self.row_of(kind)?;
        Some((joint, row.wrench(&ends)))
    }

    /// Transition velocity of a friction element, rad/s or m/s.
    fn transition_velocity(&self, kind: &ElementKind) -> T {
        let given = match kind {
            ElementKind::Friction { transition_velocity, .. } => {
                (transition_velocity.map(|n| n.0), TRANSITION_VELOCITY)
            }
            ElementKind::SlideFriction { transition_velocity, .. } => {
                (transition_velocity.map(|n| n.0), SLIDE_TRANSITION_VELOCITY)
            }
            _ => (None, TRANSITION_VELOCITY),
        };
        given.0.map_or_else(|| T::constant(given.1), |n| self.number(n))
    }

    /// Friction coefficient per normal force, against the motion, and the viscous part: `mu r s` and `c w` of a hinge,
    /// `mu s` and `c v` of a slide, with s from -1 to 1, 0 at rest; of a ball joint, whose unit vector contains s,
    /// `mu r` and `c sqrt(omega^2 + w_0^2)`.
    pub fn grip(&self, e: ElementId) -> [T; 2] {
        let kind = &self.model.elements[e.0].kind;
        let (coefficient, radius, viscous) = match kind {
            ElementKind::Friction { coefficient, radius, viscous, .. } => {
                (coefficient, Some(radius), viscous.map(|n| n.0))
            }
            ElementKind::SlideFriction { coefficient, viscous, .. } => {
                (coefficient, None, viscous.map(|n| n.0))
            }
            _ => return [T::zero(); 2],
        };
        let grip = self.number(coefficient.0);
        let grip = radius.map_or(grip, |radius| grip * self.number(radius.0));
        let (transition_velocity, viscous) = (self.transition_velocity(kind), self.or_zero(viscous));
        if let Some((_, turn)) = self.ball(kind) {
            return [grip, viscous * magnitude_with(turn, transition_velocity)];
        }
        let Some([_, rate]) = self.coordinate(e) else { return [T::zero(); 2] };
        // s = w / sqrt(w^2 + w_0^2)
        let s = rate / (rate * rate + transition_velocity * transition_velocity).sqrt();
        [grip * s, viscous * rate]
    }

    /// Normal forces at a friction element, from the reaction wrench of its joint on body j: the force across the axis,
    /// or the forces at both ends of a bearing with a length; the whole force for a ball joint. Returns them and their
    /// number.
    pub fn normal_forces(&self, e: ElementId, wrench: Wrench<T>) -> ([Vec3<T>; 2], usize) {
        let kind = &self.model.elements[e.0].kind;
        let (joint, length, normal) = match kind {
            ElementKind::Friction { joint, length, .. } => (*joint, length, None),
            ElementKind::SlideFriction { joint, length, ignored_direction, .. } => {
                (*joint, length, *ignored_direction)
            }
            _ => return ([Vec3::zero(); 2], 0),
        };
        if self.ball(kind).is_some() {
            return ([wrench.f, Vec3::zero()], 1);
        }
        let body = self.model.joints[joint.0].bodies[1];
        let marker = self.bodies[body.0].pose.compose(self.geometry.markers[joint.0][1]);
        let z = marker.rot.cols[2];
        let across = |v: Vec3<T>| match normal {
            None => v - z * z.dot(v),
            Some(normal) => {
                // Along p = n x z alone
                let p = (self.turned(body.0) * normal.spread()).cross(z);
                p * (p.dot(v) / p.dot(p))
            }
        };
        let force = across(wrench.f);
        let Some(length) = length else { return ([force, Vec3::zero()], 1) };
        // P = F/2 +- z x M / L, with M about the joint's location
        let moment = wrench.m - marker.r.cross(wrench.f);
        let couple = across(z.cross(moment)) * (T::one() / self.number(length.0));
        let half = force * T::constant(0.5);
        ([half + couple, half - couple], 2)
    }

    /// tau = -k (chi - chi_o) - c chi.,  chi measured from the design configuration.
    fn on_coordinate(
        &self,
        e: ElementId,
        stiffness: NumberId,
        equilibrium: Option<NumberId>,
        damping: Option<NumberId>,
    ) -> T {
        let Some([value, rate]) = self.coordinate(e) else { return T::zero() };
        let force = -(self.number(stiffness) * (value - self.or_zero(equilibrium)));
        damping.map_or(force, |damping| force - self.number(damping) * rate)
    }

    /// Calls `each` with the stiffness and the deflection of every compliant direction of an element; the derivatives
    /// of the poses give those of the deflections.
    pub fn deflections(&self, e: ElementId, mut each: impl FnMut(T, T)) {
        let kind = &self.model.elements[e.0].kind;
        match kind {
            ElementKind::Spring { from, to, .. } => {
                let length = self.apart(self.point(*to) - self.point(*from));
                each(length, self.pull(kind, length)[1]);
            }
            ElementKind::JointSpring { stiffness: Stiffness(n), .. }
            | ElementKind::TorsionSpring { stiffness: TorsionalStiffness(n), .. } => {
                if let Some([value, _]) = self.coordinate(e) {
                    each(value, self.number(*n));
                }
            }
            ElementKind::Bushing { from, to, x, y, z, about_x, about_y, about_z, .. } => {
                let (p, q) = (self.point(*from), self.point(*to));
                let axes = self.turned(self.body(*from));
                let way = axes.transpose_mul(q - p);
                let turn = rotation_vector(axes.transpose() * self.turned(self.body(*to)));
                let slides = [x, y, z].map(|n| self.number(n.0));
                let turns = [about_x, about_y, about_z].map(|n| self.or_zero(n.map(|n| n.0)));
                for k in 0..3 {
                    each(way[k], slides[k]);
                    each(turn[k], turns[k]);
                }
            }
            _ => {}
        }
    }

    /// Coordinate that an element acts on, measured from the design configuration, and its rate.
    pub fn coordinate(&self, e: ElementId) -> Option<[T; 2]> {
        let (joint, ends, row) = self.row_of(&self.model.elements[e.0].kind)?;
        let kept = self.geometry.kept[joint].by(row);
        let [i, j] = self.model.joints[joint].bodies.map(|b| self.bodies[b.0].v);
        let value = row.value(&ends, self.near[e.0] + kept) - kept;
        // chi. = l . (V_j - V_i)
        Some([value, row.wrench(&ends).on(j - i)])
    }

    /// Wrench of a bushing on body j.
    fn bushing(&self, kind: &ElementKind) -> Wrench<T> {
        let ElementKind::Bushing { from, to, x, y, z, about_x, about_y, about_z, damping } = kind else {
            return Wrench::zero();
        };
        let (i, j) = (self.body(*from), self.body(*to));
        let (p, q, axes) = (self.point(*from), self.point(*to), self.turned(i));
        let way = axes.transpose_mul(q - p);
        let [x, y, z] = [x, y, z].map(|n| self.number(n.0));
        // F = -Q K Q^T (P_j - P_i) - c v,  v of P_j as seen from i                                             (44)
        let mut force = -(axes * Vec3::new(x * way.x, y * way.y, z * way.z));
        if let Some(damping) = damping {
            let slip = self.bodies[j].velocity(q) - self.bodies[i].velocity(q);
            force -= slip * self.number(damping.0);
        }
        let mut push = Wrench::force(force, q);
        let about = [about_x, about_y, about_z];
        if about.iter().any(|n| n.is_some()) {
            let turned = rotation_vector(axes.transpose() * self.turned(j));
            let [x, y, z] = about.map(|n| self.or_zero(n.map(|n| n.0)));
            push += Wrench::moment(-(axes * Vec3::new(x * turned.x, y * turned.y, z * turned.z)));
        }
        push
    }

    /// Kinetic energy of a body, or of all.
    pub fn kinetic_energy(&self, of: Option<BodyId>) -> T {
        let half = T::constant(0.5);
        let mut sum = T::zero();
        for element in &self.model.elements {
            let Some(Solid { body, mass, centre, inertia }) = self.solid(&element.kind) else { continue };
            if of.is_none_or(|of| of == body) {
                let moving = &self.bodies[body.0];
                let (v, w) = (moving.velocity(centre), moving.v.w);
                // (m v^2 + omega . I omega) / 2
                sum += (mass * v.dot(v) + w.dot(inertia.on(w))) * half;
            }
        }
        sum
    }
}

/// Default transition velocity of friction, rad/s; of slides, m/s.
const TRANSITION_VELOCITY: f64 = 0.01;
const SLIDE_TRANSITION_VELOCITY: f64 = 0.001;

/// Regularisation of the size of a force, N, so that it has a derivative at zero.
const NO_FORCE: f64 = 1e-9;
/// Regularisation of the length of a direction.
const STILL: f64 = 1e-12;

/// Norm of a vector, regularised so that it has a derivative at zero.
pub(super) fn magnitude<T: Real>(v: Vec3<T>, none: f64) -> T {
    magnitude_with(v, T::constant(none))
}

/// `sqrt(v^2 + a^2)`.
fn magnitude_with<T: Real>(v: Vec3<T>, a: T) -> T {
    (v.dot(v) + a * a).sqrt()
}

/// Regularised size of a force.
pub(super) fn force_size<T: Real>(force: Vec3<T>) -> T {
    magnitude(force, NO_FORCE)
}

/// Square of the sine below which the series of the angle is accurate to round-off.
const SMALL: f64 = 1e-6;

/// Rotation vector of a rotation by less than half a turn: its axis times its angle, rad.
fn rotation_vector<T: Real>(rot: Mat3<T>) -> Vec3<T> {
    let [x, y, z] = rot.cols;
    let half = T::constant(0.5);
    // sin(theta) n and cos(theta)
    let sine = Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x) * half;
    let square = sine.dot(sine);
    if square.decisive() < SMALL {
        // theta / sin(theta) = 1 + s^2/6 + 3 s^4/40
        let more = square * T::constant(3.0 / 40.0) + T::constant(1.0 / 6.0);
        sine * (square * more + T::one())
    } else {
        let cosine = (x.x + y.y + z.z - T::one()) * half;
        let size = sine.norm();
        sine * (size.atan2(cosine) / size)
    }
}

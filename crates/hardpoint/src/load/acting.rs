//! What acts on the bodies, and what they need for their motion: (43) and (44) of `docs/theory.md`, over any number.
//!
//! Signs and formulas of the elements are those of `docs/loads.md`.

use crate::constraint::MarkerPair;
use crate::design::Geometry;
use crate::model::{
    Axes, BodyId, ElementId, ElementKind, Length, Model, NumberId, PointId, Stiffness, TorsionalStiffness,
};
use crate::space::{Mat3, Pose, Real, Twist, Vec3, Wrench};

/// A body as it moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moving<T> {
    /// Where it is.
    pub pose: Pose<T>,
    /// Its twist V.
    pub v: Twist<T>,
    /// And A = dV/dt.
    pub a: Twist<T>,
}

impl<T: Real> Moving<T> {
    /// One that stands.
    pub fn still() -> Self {
        Self { pose: Pose::IDENTITY.spread(), v: Twist::zero(), a: Twist::zero() }
    }

    /// Velocity of its point at `p`.
    fn velocity(&self, p: Vec3<T>) -> Vec3<T> {
        self.v.at(p)
    }

    /// Acceleration of its point at `p`: A at p + omega x v.
    fn acceleration(&self, p: Vec3<T>) -> Vec3<T> {
        self.v.w.cross_plus(self.v.at(p), self.a.at(p))
    }
}

/// All that acts at an instant.
#[derive(Clone, Copy)]
pub(crate) struct Acting<'a, T> {
    pub model: &'a Model,
    pub geometry: &'a Geometry<T>,
    /// Per body.
    pub bodies: &'a [Moving<T>],
    /// Per element: the value of its law.
    pub laws: &'a [T],
    /// Per element: about what the coordinate is that it acts on, to count angles through whole turns.
    pub near: &'a [T],
    /// Per element: the moment that friction exerts on its coordinate.
    pub friction: &'a [T],
}

/// A mass where it is.
pub(super) struct Solid<T> {
    pub body: BodyId,
    pub mass: T,
    pub centre: Vec3<T>,
    pub inertia: Spread<T>,
}

/// Moments of inertia about the centre.
pub(super) enum Spread<T> {
    /// A matrix along these axes.
    Matrix(Mat3<T>, Mat3<T>),
    /// Round about a line: about the line, and about any axis across.
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

impl<T: Real> Acting<'_, T> {
    /// Per body, ground included: F = f - g, what joints have to put on it.
    pub fn needed(&self, out: &mut [Wrench<T>]) {
        out.fill(Wrench::zero());
        for k in 0..self.model.elements.len() {
            self.add(ElementId(k), out);
        }
    }

    fn number(&self, n: NumberId) -> T {
        self.geometry.numbers[n.0]
    }

    /// A number that may be left out, for zero.
    fn or_zero(&self, n: Option<NumberId>) -> T {
        n.map_or_else(T::zero, |n| self.number(n))
    }

    fn body(&self, point: PointId) -> usize {
        self.model.points[point.0].body.0
    }

    /// Where a point is: r + A s.
    pub fn point(&self, point: PointId) -> Vec3<T> {
        self.bodies[self.body(point)].pose.point(self.geometry.points[point.0])
    }

    /// The length at which a spring pulls nothing but its preload.
    fn free_length(&self, from: PointId, to: PointId, given: Option<Length>) -> T {
        match given {
            Some(free) => self.number(free.0),
            // L_o of the drawing, which a change of the design makes another
            None => (self.as_drawn(to) - self.as_drawn(from)).norm(),
        }
    }

    /// Where it is drawn, in this design.
    fn as_drawn(&self, point: PointId) -> Vec3<T> {
        let frame: Pose<T> = self.model.bodies[self.body(point)].frame.spread();
        frame.point(self.geometry.points[point.0])
    }

    /// The global axes as drawn, as they have turned with a body.
    pub fn turned(&self, body: usize) -> Mat3<T> {
        self.bodies[body].pose.rot * self.model.bodies[body].frame.rot.transpose().spread()
    }

    /// A mass, where it is.
    pub fn solid(&self, kind: &ElementKind) -> Option<Solid<T>> {
        let zero = T::zero();
        let body = kind.mass_on(self.model)?;
        Some(match kind {
            ElementKind::Rigid { centre, mass, ixx, iyy, izz, ixy, iyz, izx } => {
                let of = |n: &Option<crate::model::Inertia>| self.or_zero(n.map(|n| n.0));
                let [a, b, c, d, e, f] = [ixx, iyy, izz, ixy, iyz, izx].map(of);
                let cols = [Vec3::new(a, -d, -f), Vec3::new(-d, b, -e), Vec3::new(-f, -e, c)];
                let inertia = Spread::Matrix(self.turned(body.0), Mat3 { cols });
                Solid { body, mass: self.number(mass.0), centre: self.point(*centre), inertia }
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

    /// Adds to `f - g` of the bodies what an element needs or does.
    pub fn add(&self, e: ElementId, out: &mut [Wrench<T>]) {
        let kind = &self.model.elements[e.0].kind;
        if let Some(Solid { body, mass, centre, inertia }) = self.solid(kind) {
            let moving = &self.bodies[body.0];
            let weight: Vec3<T> = self.model.gravity.spread();
            // f = m (a_c - g0) at c,   m = I alpha + omega x I omega                                            (43)
            let force = (moving.acceleration(centre) - weight) * mass;
            let spin = moving.v.w.cross_plus(inertia.on(moving.v.w), inertia.on(moving.a.w));
            out[body.0] += Wrench::force(force, centre);
            out[body.0] += Wrench::moment(spin);
            return;
        }
        match kind {
            ElementKind::Spring { from, to, .. } => {
                let (p, q) = (self.point(*from), self.point(*to));
                let d = q - p;
                // s pulls both ends along the line between them                                                 (44)
                let pull = d * (self.size(e) / d.norm());
                out[self.body(*to)] += Wrench::force(pull, q);
                out[self.body(*from)] -= Wrench::force(pull, q);
            }
            ElementKind::JointSpring { .. }
            | ElementKind::TorsionSpring { .. }
            | ElementKind::Friction { .. } => {
                let Some((joint, ends, row)) = self.row_of(kind) else { return };
                // g_j = tau l, g_i = -tau l: tau works on the coordinate                                        (44)
                let push = row.wrench(&ends).times_plus(self.size(e), Wrench::zero());
                let [i, j] = self.model.joints[joint].bodies;
                out[j.0] -= push;
                out[i.0] += push;
            }
            ElementKind::PointForce { at, along, axes, .. } => {
                let body = self.body(*at);
                let push = self.along(*along, *axes, body) * self.size(e);
                out[body] -= Wrench::force(push, self.point(*at));
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
            | ElementKind::ElasticJoint { .. } => {}
        }
    }

    /// A direction as it points now.
    fn along(&self, direction: Vec3, axes: Option<Axes>, body: usize) -> Vec3<T> {
        match axes.unwrap_or_default() {
            Axes::Global | Axes::Joint => direction.spread(),
            Axes::Body => self.turned(body) * direction.spread(),
        }
    }

    /// The joint whose coordinate an element acts on, its markers, and the row that measures the coordinate.
    fn row_of(&self, kind: &ElementKind) -> Option<(usize, MarkerPair<T>, crate::constraint::Row)> {
        let (joint, coordinate) = kind.coordinate()?;
        let j = &self.model.joints[joint.0];
        let [m_i, m_j] = self.geometry.markers[joint.0];
        let [i, j_pose] = j.bodies.map(|b| self.bodies[b.0].pose);
        let axes = Mat3::IDENTITY.spread();
        let ends = MarkerPair { i: i.compose(m_i), j: j_pose.compose(m_j), axes };
        Some((joint.0, ends, j.kind.coordinates[coordinate].row))
    }

    /// What a force is at this instant: the tension of a spring, the generalised force of one on a coordinate, the size of a given one.
    pub fn size(&self, e: ElementId) -> T {
        let kind = &self.model.elements[e.0].kind;
        match kind {
            ElementKind::Spring { from, to, stiffness, cubic, free_length, preload, damping } => {
                let (p, q) = (self.point(*from), self.point(*to));
                let d = q - p;
                let length = d.norm();
                let way = length - self.free_length(*from, *to, *free_length);
                let velocity =
                    self.bodies[self.body(*to)].velocity(q) - self.bodies[self.body(*from)].velocity(p);
                let rate = d.dot(velocity) / length;
                // s = p + k (L - L_o) + k_3 (L - L_o)^3 + c L.
                let mut tension = self.number(stiffness.0) * way + self.or_zero(preload.map(|n| n.0));
                if let Some(cubic) = cubic {
                    tension += self.number(cubic.0) * way * way * way;
                }
                if let Some(damping) = damping {
                    tension += self.number(damping.0) * rate;
                }
                tension
            }
            ElementKind::JointSpring { stiffness, free, damping, .. } => {
                self.on_coordinate(e, stiffness.0, free.map(|n| n.0), damping.map(|n| n.0))
            }
            ElementKind::TorsionSpring { stiffness, free, damping, .. } => {
                self.on_coordinate(e, stiffness.0, free.map(|n| n.0), damping.map(|n| n.0))
            }
            ElementKind::Friction { .. } => self.friction[e.0],
            ElementKind::PointForce { force, .. } => self.number(force.0) * self.laws[e.0],
            ElementKind::BodyMoment { moment, .. } => self.number(moment.0) * self.laws[e.0],
            ElementKind::Bushing { .. } => self.bushing(kind).f.norm(),
            ElementKind::Rigid { .. }
            | ElementKind::Bar { .. }
            | ElementKind::Block { .. }
            | ElementKind::ElasticJoint { .. } => T::zero(),
        }
    }

    /// The wrench that works on the coordinate that an element acts on, one unit of it.
    pub fn unit(&self, e: ElementId) -> Option<(usize, Wrench<T>)> {
        let (joint, ends, row) = self.row_of(&self.model.elements[e.0].kind)?;
        Some((joint, row.wrench(&ends)))
    }

    /// How much friction a hinge has per force across its axis, against its motion: `mu r s`, with s from -1 to 1, 0 at rest.
    pub fn grip(&self, e: ElementId) -> T {
        let ElementKind::Friction { coefficient, radius, fades, .. } = &self.model.elements[e.0].kind else {
            return T::zero();
        };
        let Some([_, rate]) = self.coordinate(e) else { return T::zero() };
        let fades = fades.map_or_else(|| T::constant(FADES), |n| self.number(n.0));
        // s = w / sqrt(w^2 + w_0^2)
        let s = rate / (rate * rate + fades * fades).sqrt();
        self.number(coefficient.0) * self.number(radius.0) * s
    }

    /// tau = -k (chi - chi_o) - c chi.,  chi counted from the drawing.
    fn on_coordinate(
        &self,
        e: ElementId,
        stiffness: NumberId,
        free: Option<NumberId>,
        damping: Option<NumberId>,
    ) -> T {
        let Some([value, rate]) = self.coordinate(e) else { return T::zero() };
        let force = -(self.number(stiffness) * (value - self.or_zero(free)));
        damping.map_or(force, |damping| force - self.number(damping) * rate)
    }

    /// What of an element gives, each with its stiffness: deflections that its poses' derivatives tell.
    pub fn deflections(&self, e: ElementId, mut each: impl FnMut(T, T)) {
        let kind = &self.model.elements[e.0].kind;
        match kind {
            ElementKind::Spring { from, to, stiffness, cubic, free_length, .. } => {
                let length = (self.point(*to) - self.point(*from)).norm();
                let mut slope = self.number(stiffness.0);
                if let Some(cubic) = cubic {
                    let way = length - self.free_length(*from, *to, *free_length);
                    // ds/dL = k + 3 k_3 (L - L_o)^2
                    slope += self.number(cubic.0) * way * way * T::constant(3.0);
                }
                each(length, slope);
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

    /// The coordinate that an element acts on, counted from the drawing, and its rate.
    pub fn coordinate(&self, e: ElementId) -> Option<[T; 2]> {
        let (joint, ends, row) = self.row_of(&self.model.elements[e.0].kind)?;
        let kept = self.geometry.kept[joint].by(row);
        let [i, j] = self.model.joints[joint].bodies.map(|b| self.bodies[b.0].v);
        let value = row.value(&ends, self.near[e.0] + kept) - kept;
        // chi. = l . (V_j - V_i)
        Some([value, row.wrench(&ends).on(j - i)])
    }

    /// What a bushing puts on its second body.
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
        let turned = rotation_vector(axes.transpose() * self.turned(j));
        let [x, y, z] = [about_x, about_y, about_z].map(|n| self.or_zero(n.map(|n| n.0)));
        let moment = -(axes * Vec3::new(x * turned.x, y * turned.y, z * turned.z));
        let mut push = Wrench::force(force, q);
        push += Wrench::moment(moment);
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

/// Below this speed, rad/s, friction fades unless something else is said.
const FADES: f64 = 0.01;

/// Below this square of its sine an angle is its sine and a third power, to round-off.
const SMALL: f64 = 1e-6;

/// The turn of a rotation: its axis, as long as its angle, rad, below half a turn.
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

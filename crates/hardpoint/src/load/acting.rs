//! Applied loads on the bodies, and the wrenches that their motion requires: (43) and (44) of `docs/theory.md`, over
//! any number.
//!
//! Signs and formulas of the elements are those of `docs/loads.md`.

use crate::constraint::{MarkerPair, Row};
use crate::design::Geometry;
use crate::measure::WheelAt;
use crate::model::element::{ActsOn, Compliance, ElasticLaw, Elasticity, JointFriction, StiffnessEntry};
use crate::model::{
    Axes, BodyId, ENDS_MEET, ElementId, ElementKind, JointId, LoadMode, Model, NumberId, PointId,
    SpringTable, UnitForce, Wheel, WheelId, elements, if_mass,
};
use crate::number::{Dual, each};
use crate::space::{Mat3, Opening, Pose, Real, Twist, Vec3, Wrench};

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
    pub fn at_rest() -> Self {
        Self { pose: Pose::IDENTITY.spread(), v: Twist::zero(), a: Twist::zero() }
    }

    /// This motion with its derivative, from its design twist W and the first two rates of it: `A' = W_w x A, r' = W at
    /// r` and (14) for V' and A'.
    pub fn along(&self, [w0, w1, w2]: [Twist<T>; 3]) -> MovingBody<Dual<T>> {
        let Self { pose, v, a } = *self;
        MovingBody {
            pose: pose.along(w0),
            v: v.with_derivative(w1 + w0.ad(v)),
            a: a.with_derivative(w2 + w1.ad(v) + w0.ad(a)),
        }
    }

    /// Velocity of the body point at `p`.
    pub fn velocity(&self, p: Vec3<T>) -> Vec3<T> {
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
    /// Part of weights and preloads that acts; 1 but on the way to an equilibrium.
    pub share: f64,
    /// Further force, and its size.
    pub further: Option<(UnitForce, T)>,
}

/// Mass properties at the current pose.
pub(crate) struct Solid<T> {
    pub body: BodyId,
    pub mass: T,
    pub centre: Vec3<T>,
    pub inertia: Spread<T>,
}

/// Moments of inertia about the centre.
pub(crate) enum Spread<T> {
    /// Axes, and the matrix along them.
    Matrix(Mat3<T>, Mat3<T>),
    /// Rotationally symmetric: the line, the moment about it, and the moment about any perpendicular axis.
    Line(Vec3<T>, T, T),
}

impl<T: Real> Spread<T> {
    /// I w.
    #[inline]
    pub fn on(&self, w: Vec3<T>) -> Vec3<T> {
        match self {
            Self::Matrix(axes, matrix) => *axes * (*matrix * axes.transpose_mul(w)),
            // I = I_t 1 + (I_a - I_t) u u^T
            Self::Line(u, axial, across) => u.times_plus((*axial - *across) * u.dot(w), w * *across),
        }
    }
}

/// Formula of a type of masses.
pub(crate) trait MassFormula {
    /// Returns the mass properties at the current pose.
    fn solid<T: Real>(&self, at: &AppliedLoads<'_, T>) -> Solid<T>;
}

/// Formulas of a type of forces; `e` is the element.
pub(crate) trait ForceFormula {
    /// Subtracts the wrenches that it applies from those of the bodies, ground included.
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]);

    /// Returns its magnitude: the tension of a spring, the generalised force of a joint spring, or the size of a given
    /// force.
    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> T;

    /// Calls `each` with every deflection of the element and the stiffness against it; the derivatives of the poses
    /// give those of the deflections.
    fn deflections<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, each: impl FnMut(T, T));

    /// Returns the deflection of the force's table; `None` if its type has none.
    fn table_deflection<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId) -> Option<T> {
        None
    }
}

macro_rules! in_loads {
    ($($(#[$doc:meta])* $variant:ident $name:literal $table:ident { $($fields:tt)* })*) => {
        #[allow(unused_variables, reason = "a question to masses does not look at forces, and vice versa")]
        impl<T: Real> AppliedLoads<'_, T> {
            /// Mass properties of an element at the current pose.
            #[inline]
            pub fn solid(&self, kind: &ElementKind) -> Option<Solid<T>> {
                match kind { $(ElementKind::$variant(it) => if_mass!($table, Some(it.solid(self)), None)),* }
            }

            /// Subtracts the wrenches that a force applies.
            fn apply(&self, e: ElementId, out: &mut [Wrench<T>]) {
                match &self.model.elements[e.0].kind {
                    $(ElementKind::$variant(it) => if_mass!($table, (), it.apply(self, e, out))),*
                }
            }

            /// Magnitude of a force.
            pub fn size(&self, e: ElementId) -> T {
                match &self.model.elements[e.0].kind {
                    $(ElementKind::$variant(it) => if_mass!($table, T::zero(), it.size(self, e))),*
                }
            }

            /// Calls `each` with every deflection of an element and the stiffness against it.
            pub fn deflections(&self, e: ElementId, each: impl FnMut(T, T)) {
                match &self.model.elements[e.0].kind {
                    $(ElementKind::$variant(it) => if_mass!($table, (), it.deflections(self, e, each))),*
                }
            }

            /// Deflection of the table of a force; `None` if its type has none.
            pub fn table_deflection(&self, e: ElementId) -> Option<T> {
                match &self.model.elements[e.0].kind {
                    $(ElementKind::$variant(it) => if_mass!($table, None, it.table_deflection(self, e))),*
                }
            }
        }
    };
}
elements!(in_loads);

impl<T: Real> AppliedLoads<'_, T> {
    /// Computes per body, ground included, F = f - g: the wrench that its joints must apply.
    pub fn required(&self, out: &mut [Wrench<T>]) {
        out.fill(Wrench::zero());
        for k in 0..self.model.elements.len() {
            self.add(ElementId(k), out);
        }
        self.add_further(out);
    }

    /// Subtracts the wrenches of the further force.
    pub fn add_further(&self, out: &mut [Wrench<T>]) {
        if let Some((force, size)) = self.further {
            self.unit_force(force, |body, wrench| out[body] = wrench.times_plus(-size, out[body]));
        }
    }

    /// Calls `each` with the bodies that a unit force acts on, and its wrenches.
    pub fn unit_force(&self, force: UnitForce, mut each: impl FnMut(usize, Wrench<T>)) {
        match force {
            UnitForce::Point(point, along) => {
                each(self.body(point), Wrench::force(along.spread(), self.point(point)));
            }
            UnitForce::Wheel(wheel, along) => {
                let body = self.model.wheels[wheel.0].body.0;
                each(body, Wrench::force(along.spread(), self.wheel(wheel).contact()));
            }
            UnitForce::Element(e) => {
                let mut laws = self.laws.to_vec();
                laws[e.0] = T::one();
                let full = AppliedLoads { laws: &laws, further: None, ..*self };
                let mut required = vec![Wrench::zero(); self.bodies.len()];
                full.add(e, &mut required);
                // Per unit of its size, opposite to the required wrenches.
                let per = -(T::one() / full.size(e));
                for (body, wrench) in required.into_iter().enumerate() {
                    each(body, wrench.times_plus(per, Wrench::zero()));
                }
            }
        }
    }

    pub fn number(&self, n: NumberId) -> T {
        self.geometry.numbers[n.0]
    }

    /// The part of a weight or preload that acts.
    pub fn part(&self, whole: T) -> T {
        if self.share == 1.0 { whole } else { whole * T::constant(self.share) }
    }

    /// A force on the way to an equilibrium, without the part of the one in the design configuration that does not act
    /// yet: a prestress grows like all loads.
    pub fn grown(&self, force: T, in_design: impl FnOnce() -> T) -> T {
        if self.share == 1.0 {
            return force;
        }
        let prestress = in_design();
        force - (prestress - self.part(prestress))
    }

    /// An optional preload; zero by default.
    pub fn preload(&self, n: Option<NumberId>) -> T {
        n.map_or_else(T::zero, |n| self.part(self.number(n)))
    }

    /// An optional number; zero by default.
    pub fn or_zero(&self, n: Option<NumberId>) -> T {
        n.map_or_else(T::zero, |n| self.number(n))
    }

    pub fn body(&self, point: PointId) -> usize {
        self.model.points[point.0].body.0
    }

    /// Position of a point: r + A s.
    #[inline]
    pub fn point(&self, point: PointId) -> Vec3<T> {
        self.bodies[self.body(point)].pose.point(self.geometry.points[point.0])
    }

    /// Distance between the ends of a spring; NaN if they coincide, since the direction is then undefined.
    pub fn apart(&self, d: Vec3<T>) -> T {
        let length = d.norm();
        let limit = T::constant(ENDS_MEET * self.geometry.size);
        if length.exceeds(limit) { length } else { T::constant(f64::NAN) }
    }

    /// Position of a point in the design configuration of this design.
    pub fn design_position(&self, point: PointId) -> Vec3<T> {
        let frame: Pose<T> = self.model.bodies[self.body(point)].frame.spread();
        frame.point(self.geometry.points[point.0])
    }

    /// Global axes of the design configuration, rotated with a body.
    pub fn turned(&self, body: usize) -> Mat3<T> {
        self.bodies[body].pose.rot * self.model.bodies[body].frame.rot.transpose().spread()
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
                LoadMode::Static => out[body.0] += Wrench::force(-weight * self.part(mass), centre),
            }
            return;
        }
        self.apply(e, out);
    }

    /// A direction in global axes at the current pose.
    pub fn along(&self, direction: Vec3, axes: Option<Axes>, body: usize) -> Vec3<T> {
        match axes.unwrap_or_default() {
            Axes::Global | Axes::Joint => direction.spread(),
            Axes::Body => self.turned(body) * direction.spread(),
        }
    }

    /// Markers of a joint, and the row that measures its coordinate.
    fn row_of(&self, (joint, coordinate): (JointId, usize)) -> (MarkerPair<T>, Row) {
        let j = &self.model.joints[joint.0];
        let [m_i, m_j] = self.geometry.markers[joint.0];
        let [i, j_pose] = each(&j.bodies, |b| self.bodies[b.0].pose);
        let axes = Mat3::IDENTITY.spread();
        let ends = MarkerPair { i: i.compose(m_i), j: j_pose.compose(m_j), axes };
        (ends, j.kind.coordinates[coordinate].row)
    }

    /// Opening of an elastic joint under the force of an element; `None` in a model without equilibrium, where elastic
    /// joints are rigid.
    pub fn opening(&self, e: ElementId, joint: JointId) -> Option<Opening<T>> {
        self.model.equilibrium.as_ref()?;
        Some(self.motion_of(e, joint))
    }

    /// Motion of a joint in all of its directions, as the opening of an element.
    pub fn motion_of(&self, e: ElementId, joint: JointId) -> Opening<T> {
        let [m_i, m_j] = self.geometry.elastic_markers(self.model, joint);
        let [i, j] = each(&self.model.joints[joint.0].bodies, |b| self.bodies[b.0].pose);
        let (i, j) = (i.compose(m_i), j.compose(m_j));
        let opening = match self.model.joints[joint.0].kind.is_cross() {
            true => Opening::of_cross,
            false => Opening::between,
        };
        opening(&i, &j, self.near[e.0])
    }

    /// Opening of an element between two points: of its markers there, which have the same axes in the design
    /// configuration, its own or the global ones.
    pub fn opening_between(&self, e: ElementId, [i, j]: [PointId; 2]) -> Opening<T> {
        let marker = |end: usize, point: PointId| {
            let body = self.body(point);
            let rot = match self.geometry.axes[e.0] {
                Some(axes) => self.bodies[body].pose.rot * axes[end],
                None => self.turned(body),
            };
            Pose { rot, r: self.point(point) }
        };
        let opening = Opening::between(&marker(0, i), &marker(1, j), self.near[e.0]);
        if self.share == 1.0 {
            return opening;
        }
        let apart = self.design_position(j) - self.design_position(i);
        let apart = match self.geometry.axes[e.0] {
            Some(axes) => {
                let frame: Mat3<T> = self.model.bodies[self.body(i)].frame.rot.spread();
                (frame * axes[0]).transpose_mul(apart)
            }
            None => apart,
        };
        let o = T::zero();
        Opening { in_design: [apart.x, apart.y, apart.z, o, o, o], ..opening }
    }

    /// Opening of an element that acts on a joint or between two points.
    pub fn opening_at(&self, e: ElementId) -> Option<Opening<T>> {
        match self.model.elements[e.0].kind.force(self.model)?.acts_on {
            ActsOn::Joint(joint) => self.opening(e, joint),
            ActsOn::Points(points) => Some(self.opening_between(e, points)),
            ActsOn::Line(_)
            | ActsOn::Point(_)
            | ActsOn::Wheel(_)
            | ActsOn::Body(_)
            | ActsOn::Coordinate(..) => None,
        }
    }

    /// Elastic resistance along a coordinate of an opening, `k e + k_3 e^3 + f C(e)`, and its derivative.
    pub fn elastic_resistance(&self, e: T, of: &Elasticity<'_>) -> [T; 2] {
        let stiffness = self.or_zero(of.stiffness);
        let (mut push, mut slope) = (stiffness * e, stiffness);
        if let Some(cubic) = of.cubic {
            let square = self.number(cubic) * e * e;
            (push, slope) = (push + square * e, slope + square * T::constant(3.0));
        }
        if let Some(curve) = of.curve {
            let [force, by_way] = self.scaled(curve, of.scale, e);
            (push, slope) = (push + force, slope + by_way);
        }
        [push, slope]
    }

    /// Force of a curve times its factor, and its derivative by the deflection.
    pub fn scaled(&self, curve: &SpringTable, scale: Option<NumberId>, deflection: T) -> [T; 2] {
        let [force, slope] = curve.at(deflection, |n| self.number(n));
        scale.map_or([force, slope], |scale| [force, slope].map(|x| x * self.number(scale)))
    }

    /// Elastic forces and moments of a law on body j along the coordinates of an opening.
    pub fn elastic_forces(&self, opening: &Opening<T>, law: &ElasticLaw<'_>) -> [T; 6] {
        let mut forces = self.elastic_forces_at(&opening.coordinates, law);
        if self.share != 1.0 {
            let prestress = self.elastic_forces_at(&opening.in_design, law);
            for (force, prestress) in forces.iter_mut().zip(prestress) {
                *force = self.grown(*force, || prestress);
            }
        }
        for (k, of) in law.directions.iter().enumerate().filter(|(_, of)| of.preload.is_some()) {
            forces[k] += self.preload(of.preload);
        }
        forces
    }

    /// Elastic forces and moments without preloads, `-(k e + k_3 e^3 + f C(e))` and those of the matrix.
    fn elastic_forces_at(&self, coordinates: &[T; 6], law: &ElasticLaw<'_>) -> [T; 6] {
        let mut forces = [T::zero(); 6];
        for (k, of) in law.directions.iter().enumerate().filter(|(_, of)| of.resists()) {
            let [push, _] = self.elastic_resistance(coordinates[k], of);
            forces[k] = -push;
        }
        for entry in law.coupled.iter().flat_map(|matrix| &matrix.entries) {
            let StiffnessEntry { row, column, value } = *entry;
            let stiffness = self.number(value);
            forces[row] -= stiffness * coordinates[column];
            if row != column {
                forces[column] -= stiffness * coordinates[row];
            }
        }
        forces
    }

    /// Elastic wrench of a law on body j of an opening; its opposite acts on body i.                            (51)
    pub fn elastic_wrench(&self, opening: &Opening<T>, law: &ElasticLaw<'_>) -> Wrench<T> {
        let forces = self.elastic_forces(opening, law);
        let mut sum = Wrench::zero();
        for (k, wrench) in opening.wrenches.iter().enumerate() {
            if !forces[k].vanishes() {
                sum = wrench.times_plus(forces[k], sum);
            }
        }
        sum
    }

    /// Sum of a wrench and the elastic wrenches on body j of a joint; the wrench itself in a model without equilibrium.
    pub fn elastic_wrench_of(&self, joint: JointId, rigid: Wrench<T>) -> Wrench<T> {
        let mut sum = rigid;
        if self.model.equilibrium.is_none() {
            return sum;
        }
        for (e, element) in self.model.elements.iter().enumerate() {
            if let Some(Compliance::Joint(elastic)) = element.kind.force(self.model).map(|f| f.compliance)
                && elastic.joint == joint
                && let Some(opening) = self.opening(ElementId(e), joint)
            {
                sum += self.elastic_wrench(&opening, &elastic.law());
            }
        }
        sum
    }

    /// Unit wrench on body j that does work on a coordinate.
    pub fn unit(&self, at: (JointId, usize)) -> Wrench<T> {
        let (ends, row) = self.row_of(at);
        row.wrench(&ends)
    }

    /// Adds tau times a unit wrench between the bodies of a joint: g_j = tau l, g_i = -tau l.                    (44)
    pub fn apply_between(&self, joint: JointId, l: Wrench<T>, tau: T, out: &mut [Wrench<T>]) {
        let push = l.times_plus(tau, Wrench::zero());
        let [i, j] = self.model.joints[joint.0].bodies;
        out[j.0] -= push;
        out[i.0] += push;
    }

    /// A wheel at the current pose.
    pub fn wheel(&self, wheel: WheelId) -> WheelAt<T> {
        let Wheel { body, centre, .. } = &self.model.wheels[wheel.0];
        // e = A e', e' fixed in the knuckle
        let spin_axis = self.bodies[body.0].pose.rot * self.geometry.spin_axes[wheel.0];
        self.wheel_at(wheel, self.point(*centre), spin_axis)
    }

    /// A wheel in the design configuration of this design.
    pub fn design_wheel(&self, wheel: WheelId) -> WheelAt<T> {
        let Wheel { body, centre, .. } = &self.model.wheels[wheel.0];
        let frame: Mat3<T> = self.model.bodies[body.0].frame.rot.spread();
        self.wheel_at(wheel, self.design_position(*centre), frame * self.geometry.spin_axes[wheel.0])
    }

    fn wheel_at(&self, wheel: WheelId, centre: Vec3<T>, spin_axis: Vec3<T>) -> WheelAt<T> {
        let Wheel { radius, side, .. } = &self.model.wheels[wheel.0];
        WheelAt {
            centre,
            spin_axis,
            radius: T::constant(*radius),
            side: T::constant(side.sign()),
            kingpin: None,
            planes: None,
            spring: None,
        }
    }

    /// Friction of a friction element.
    fn friction_of(&self, e: ElementId) -> Option<JointFriction> {
        self.model.elements[e.0].kind.friction(self.model)
    }

    /// Angular velocity of the second body of a joint relative to the first.
    fn turn(&self, joint: JointId) -> Vec3<T> {
        let [i, j] = each(&self.model.joints[joint.0].bodies, |b| self.bodies[b.0].v.w);
        j - i
    }

    /// Direction of rotation in a ball joint, regularised at low speed: `omega / sqrt(omega^2 + w_0^2)`.
    fn heading(&self, friction: &JointFriction) -> Vec3<T> {
        let turn = self.turn(friction.joint);
        turn * (T::one() / magnitude_with(turn, self.transition_velocity(friction)))
    }

    /// Unit wrench of friction, which does work on its coordinate or on the rotation of a ball joint; with its joint.
    pub fn friction_unit(&self, e: ElementId) -> Option<(JointId, Wrench<T>)> {
        let friction = self.friction_of(e)?;
        let unit = match friction.coordinate {
            Some(coordinate) => self.unit((friction.joint, coordinate)),
            None => Wrench::moment(self.heading(&friction)),
        };
        Some((friction.joint, unit))
    }

    /// Moment or force of a friction element.
    pub fn friction_size(&self, e: ElementId) -> T {
        match self.friction_of(e) {
            Some(friction) if friction.coordinate.is_none() => {
                self.friction[e.0] * magnitude(self.heading(&friction), STILL)
            }
            Some(_) | None => self.friction[e.0],
        }
    }

    /// Adds the friction of a friction element.
    pub fn apply_friction(&self, e: ElementId, out: &mut [Wrench<T>]) {
        if let Some((joint, l)) = self.friction_unit(e) {
            self.apply_between(joint, l, self.friction[e.0], out);
        }
    }

    /// Transition velocity of a friction element, rad/s or m/s.
    fn transition_velocity(&self, friction: &JointFriction) -> T {
        let default = T::constant(friction.default_transition_velocity);
        friction.transition_velocity.map_or(default, |n| self.number(n))
    }

    /// Friction coefficient per normal force, against the motion, and the viscous part: `mu r s` and `c w` of a hinge,
    /// `mu s` and `c v` of a slide, with s from -1 to 1, 0 at rest; of a ball joint, whose unit vector contains s,
    /// `mu r` and `c sqrt(omega^2 + w_0^2)`.
    pub fn friction_coefficients(&self, e: ElementId) -> [T; 2] {
        let Some(friction) = self.friction_of(e) else { return [T::zero(); 2] };
        let coulomb = self.number(friction.coefficient);
        let coulomb = friction.radius.map_or(coulomb, |radius| coulomb * self.number(radius));
        let transition_velocity = self.transition_velocity(&friction);
        let viscous = self.or_zero(friction.viscous);
        let Some(coordinate) = friction.coordinate else {
            return [coulomb, viscous * magnitude_with(self.turn(friction.joint), transition_velocity)];
        };
        let [_, rate] = self.coordinate(e, (friction.joint, coordinate));
        // s = w / sqrt(w^2 + w_0^2)
        let s = rate / (rate * rate + transition_velocity * transition_velocity).sqrt();
        [coulomb * s, viscous * rate]
    }

    /// Normal forces at a friction element, from the reaction wrench of its joint on body j: the force across the axis,
    /// or the forces at both ends of a bearing with a length; the whole force for a ball joint. Returns them and their
    /// number.
    pub fn normal_forces(&self, e: ElementId, wrench: Wrench<T>) -> ([Vec3<T>; 2], usize) {
        let Some(JointFriction { joint, coordinate, length, ignored_direction, .. }) = self.friction_of(e)
        else {
            return ([Vec3::zero(); 2], 0);
        };
        if coordinate.is_none() {
            return ([wrench.f, Vec3::zero()], 1);
        }
        let body = self.model.joints[joint.0].bodies[1];
        let marker = self.bodies[body.0].pose.compose(self.geometry.markers[joint.0][1]);
        let z = marker.rot.cols[2];
        let across = |v: Vec3<T>| match ignored_direction {
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
        let couple = across(z.cross(moment)) * (T::one() / self.number(length));
        let half = force * T::constant(0.5);
        ([half + couple, half - couple], 2)
    }

    /// tau = -k (chi - chi_o) - f C(chi - chi_o) - c chi.,  chi measured from the design configuration.
    pub fn on_coordinate(
        &self,
        [value, rate]: [T; 2],
        law: &Elasticity<'_>,
        equilibrium: Option<NumberId>,
        damping: Option<NumberId>,
    ) -> T {
        let equilibrium = self.or_zero(equilibrium);
        let force = |value: T| -self.elastic_resistance(value - equilibrium, law)[0];
        let force = self.grown(force(value), || force(T::zero()));
        damping.map_or(force, |damping| force - self.number(damping) * rate)
    }

    /// Coordinate that an element acts on, measured from the design configuration, and its rate.
    pub fn coordinate(&self, e: ElementId, at: (JointId, usize)) -> [T; 2] {
        let ((ends, row), joint) = (self.row_of(at), at.0.0);
        let kept = self.geometry.kept[joint].by(row);
        let [i, j] = each(&self.model.joints[joint].bodies, |b| self.bodies[b.0].v);
        let value = row.value(&ends, self.near[e.0] + kept) - kept;
        // chi. = l . (V_j - V_i)
        [value, row.wrench(&ends).on(j - i)]
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

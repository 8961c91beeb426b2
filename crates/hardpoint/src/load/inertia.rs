//! Wrench that the motion of a body's masses requires, as one matrix, and its derivatives by the motion.
//!
//! `f = M (A - [0; g0]) + ad*(V) M V` of `docs/theory.md` (43) in twists, M the spatial inertia in the world. Masses
//! fixed in their body move with it, `M' = ad*(W) M - M ad(W)`, so that their part of F' takes a few products per
//! body (49), independent of the number of masses.

use crate::design::Geometry;
use crate::model::element::ActsOn;
use crate::model::{ElementId, JointId, LoadMode, Model};
use crate::number::{self, Dual, Real};
use crate::space::{Mat3, Twist, Vec3, Wrench};

use super::acting::{AppliedLoads, MovingBody, Solid};

/// Spatial inertia M of a body: mass, and its first and second moments about the world origin.
#[derive(Clone, Copy)]
pub(super) struct SpatialInertia<T> {
    mass: T,
    /// h = m c.
    first: Vec3<T>,
    /// I about the origin.
    second: Mat3<T>,
}

/// Inertial load of a moving body.
#[derive(Clone, Copy)]
pub(super) struct InertialLoad<T> {
    v: Twist<T>,
    /// M V.
    momentum: Wrench<T>,
    /// f: the wrench that the motion requires.
    required: Wrench<T>,
}

impl<T: Real> SpatialInertia<T> {
    /// Zero inertia.
    pub fn zero() -> Self {
        Self { mass: T::zero(), first: Vec3::zero(), second: Mat3 { cols: [Vec3::zero(); 3] } }
    }

    /// Computes the inertias of all bodies at the current position.
    pub fn all(acting: &AppliedLoads<'_, T>, out: &mut [Self]) {
        out.fill(Self::zero());
        for element in &acting.model.elements {
            if let Some(mut solid) = acting.solid(&element.kind) {
                // Part of a weight is the weight of a part; statics have no other use of masses.
                solid.mass = acting.part(solid.mass);
                out[solid.body.0].add(&solid);
            }
        }
    }

    fn add(&mut self, Solid { mass, centre: c, inertia, .. }: &Solid<T>) {
        self.mass += *mass;
        self.first += *c * *mass;
        for k in 0..3 {
            // I + m (c^2 1 - c c^T)
            let axis = Vec3::AXES[k].spread();
            self.second.cols[k] += inertia.on(axis) + (axis * c.dot(*c) - *c * c.dot(axis)) * *mass;
        }
    }

    /// M x.
    fn on(&self, x: Twist<T>) -> Wrench<T> {
        // [I w + h x v;  m v - h x w]
        Wrench {
            m: self.first.cross_plus(x.v, self.second * x.w),
            f: x.w.cross_plus(self.first, x.v * self.mass),
        }
    }

    /// Coefficients of W, W. and W.. in `f' . Y` of a body with this Y, for masses that are fixed in their body:
    ///
    /// ```text
    /// f'  =  ad*(W) f  +  M (W.. + ad(W.) V + [0; W_w x g0])  +  ad*(W.) M V  +  ad*(V) M W.
    /// P2  =  M Y,    P1  =  ad(Y)^T M V - ad(V)^T M Y - M ad(V) Y,    P0  =  ad(Y)^T f + [g0 x (M Y)_f; 0]
    /// ```
    ///
    /// f' is the derivative in body axes, where V changes by W. and A by W.. + ad(W.) V, rotated with the body (14).
    /// Static loads have P0 only, with the weight alone as f.
    pub fn weights(&self, model: &Model, body: &InertialLoad<T>, y: Twist<T>) -> [Wrench<T>; 3] {
        let InertialLoad { v, momentum, required } = *body;
        let moved = self.on(y);
        let mut p0 = y.ad_transposed(required);
        p0 += Wrench::moment(model.gravity.spread().cross(moved.f));
        match model.load_mode {
            LoadMode::Static => [p0, Wrench::zero(), Wrench::zero()],
            LoadMode::Dynamic => {
                let p1 = y.ad_transposed(momentum) - v.ad_transposed(moved) - self.on(v.ad(y));
                [p0, p1, moved]
            }
        }
    }

    /// Inertial load of a moving body.
    pub fn load(&self, model: &Model, body: &MovingBody<T>) -> InertialLoad<T> {
        InertialLoad { v: body.v, momentum: self.on(body.v), required: self.required(model, body) }
    }

    /// f = M (A - [0; g0]) + ad*(V) M V,    ad*(X) l = -ad(X)^T l;    of static loads  f = -M [0; g0]
    #[inline]
    fn required(&self, model: &Model, MovingBody { v, a, .. }: &MovingBody<T>) -> Wrench<T> {
        let gravity: Vec3<T> = model.gravity.spread();
        match model.load_mode {
            LoadMode::Static => self.on(Twist { w: Vec3::zero(), v: -gravity }),
            LoadMode::Dynamic => self.on(Twist { w: a.w, v: a.v - gravity }) - v.ad_transposed(self.on(*v)),
        }
    }
}

/// Body-fixed data with the derivative by a variable.
pub(super) struct ChangedGeometry<T> {
    pub geometry: Geometry<Dual<T>>,
    /// Masses that depend on the variable, or move within their bodies.
    pub masses: Vec<ElementId>,
    /// Forces that depend on the variable while all bodies stay in place.
    pub forces: Vec<ElementId>,
}

/// True if the body-fixed data of a force depend on the variable.
fn is_explicit<T: Real>(model: &Model, e: ElementId, changed: &Geometry<Dual<T>>) -> bool {
    let element = &model.elements[e.0];
    let Some(force) = element.kind.force(model) else { return false };
    let moves = |v: &Vec3<Dual<T>>| [v.x, v.y, v.z].iter().any(|x| !x.d.vanishes());
    let turns = |rot: &Mat3<Dual<T>>| rot.cols.iter().any(moves);
    let in_joint = |joint: JointId| {
        changed.markers[joint.0].iter().any(|marker| moves(&marker.r) || turns(&marker.rot))
            || changed.kept[joint.0].numbers().iter().any(|x| !x.d.vanishes())
    };
    let at_points = force.acts_on.points(model).into_iter().flatten().any(|p| moves(&changed.points[p.0]));
    let elsewhere = match force.acts_on {
        ActsOn::Joint(joint) | ActsOn::Coordinate(joint, _) => in_joint(joint),
        ActsOn::Wheel(wheel) => moves(&changed.spin_axes[wheel.0]),
        ActsOn::Line(_) | ActsOn::Points(_) | ActsOn::Point(_) | ActsOn::Body(_) => false,
    };
    let numbers = model.numbers.iter().zip(&changed.numbers);
    at_points
        || elsewhere
        || changed.axes[e.0].iter().flatten().any(turns)
        || numbers.filter(|(of, _)| of.owner == element.name).any(|(_, x)| !x.d.vanishes())
}

impl<T: Real> ChangedGeometry<T> {
    pub fn new(model: &Model, geometry: Geometry<Dual<T>>) -> Self {
        let nominal =
            model.bodies.iter().map(|b| MovingBody { pose: b.frame.spread(), ..MovingBody::at_rest() });
        let bodies: Vec<MovingBody<Dual<T>>> = nominal.collect();
        let none: &[Dual<T>] = &[];
        let acting = AppliedLoads {
            model,
            geometry: &geometry,
            bodies: &bodies,
            laws: none,
            near: none,
            friction: none,
            share: 1.0,
            further: None,
        };
        let moves = |e: &ElementId| {
            let solid = acting.solid(&model.elements[e.0].kind);
            solid.is_some_and(|Solid { mass, centre, inertia, .. }| {
                let turning = number::each(&Vec3::AXES, |axis| inertia.on(axis.spread()));
                let vectors = turning.iter().chain([&centre]).flat_map(|v| [v.x, v.y, v.z]);
                !vectors.chain([mass]).all(|x| x.d.vanishes())
            })
        };
        let all = (0..model.elements.len()).map(ElementId);
        let masses = all.clone().filter(moves).collect();
        let forces = all.filter(|e| is_explicit(model, *e, &geometry)).collect();
        Self { geometry, masses, forces }
    }
}

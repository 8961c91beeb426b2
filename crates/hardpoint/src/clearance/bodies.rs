//! Bodies that carry shapes: their points and directions with the derivatives of a number type.

use crate::model::{BodyId, Model};
use crate::motion::{BodyState, States};
use crate::number::{Dual, Rates};
use crate::sensitivity::{BodySensitivity, Derivatives};
use crate::space::{Pose, Real, Vec3};

/// Bodies at one time.
pub(crate) trait Bodies<T> {
    /// Point of a body, in global coordinates.
    fn point(&self, body: BodyId, s: Vec3<T>) -> Vec3<T>;
    /// Direction that is fixed in a body, in global components.
    fn direction(&self, body: BodyId, e: Vec3<T>) -> Vec3<T>;
    /// The body's pose in plain numbers.
    fn pose(&self, body: BodyId) -> Pose;
    /// True if two bodies move relative to each other out of the plane through a point with this unit normal; false for
    /// bodies without rates.
    fn leave_plane(&self, bodies: [BodyId; 2], at: Vec3, normal: Vec3) -> bool;
    /// Point of a body in plain numbers.
    fn place(&self, body: BodyId, s: Vec3) -> Vec3 {
        let Pose { rot, r } = self.pose(body);
        r + rot * s
    }
    /// Direction that is fixed in a body in plain numbers.
    fn heading(&self, body: BodyId, e: Vec3) -> Vec3 {
        self.pose(body).rot * e
    }
}

impl<T: Real> Bodies<T> for [Pose<T>] {
    fn point(&self, body: BodyId, s: Vec3<T>) -> Vec3<T> {
        self[body.0].point(s)
    }

    fn direction(&self, body: BodyId, e: Vec3<T>) -> Vec3<T> {
        self[body.0].rot * e
    }

    fn pose(&self, body: BodyId) -> Pose {
        self[body.0].value()
    }

    fn leave_plane(&self, _: [BodyId; 2], _: Vec3, _: Vec3) -> bool {
        false
    }
}

/// Bodies of a motion, with rates. Body-fixed data are constant over time, so that points need a fraction of the
/// arithmetic of poses with rates.
pub(crate) struct MovingBodies<'m>(pub States<'m>);

impl Bodies<Rates> for MovingBodies<'_> {
    fn point(&self, body: BodyId, s: Vec3<Rates>) -> Vec3<Rates> {
        let state = self.0.body(body.0);
        let [y, v, a] = rates_of(&state, state.rotation * s.value());
        Vec3::of_rates([state.r + y, state.v + v, state.a + a])
    }

    fn direction(&self, body: BodyId, e: Vec3<Rates>) -> Vec3<Rates> {
        let state = self.0.body(body.0);
        Vec3::of_rates(rates_of(&state, state.rotation * e.value()))
    }

    // Inlined, so that of a state only the pose is gathered.
    #[inline(always)]
    fn pose(&self, body: BodyId) -> Pose {
        self.0.body(body.0).pose()
    }

    fn leave_plane(&self, bodies: [BodyId; 2], at: Vec3, normal: Vec3) -> bool {
        leave_plane(bodies.map(|body| self.0.body(body.0)), at, normal)
    }
}

/// The same with the derivatives by one design variable. Numbers of a body are gathered once for all of its points.
pub(crate) struct ChangingBodies {
    /// Bodies that carry shapes.
    carriers: Vec<usize>,
    /// Per body.
    at: Vec<(BodyState, BodySensitivity)>,
}

impl ChangingBodies {
    /// Bodies of a model, at rest in its origin.
    pub fn of(model: &Model) -> Self {
        let bodies = model.shapes.iter().flat_map(|shape| shape.bodies(model));
        let mut carriers: Vec<usize> = bodies.map(|b| b.0).collect();
        carriers.sort_unstable();
        carriers.dedup();
        Self { carriers, at: vec![(BodyState::GROUND, BodySensitivity::ZERO); model.bodies.len()] }
    }

    /// Moves those that carry shapes.
    pub fn set(&mut self, states: States<'_>, d: Derivatives<'_>) {
        self.carriers.iter().for_each(|&b| self.at[b] = (states.body(b), d.body(b)));
    }

    /// Vector from the origin of a body to a point, with rates, and the derivatives of all of it.
    fn vector(&self, body: BodyId, s: Vec3<Dual<Rates>>) -> [[Vec3; 3]; 2] {
        let (state, d) = &self.at[body.0];
        let y = state.rotation * s.map(|x| x.v.0[0]);
        let [_, v, a] = rates_of(state, y);
        // (A s)_b = A s_b + pi' x y,    v_b = omega_b x y + omega x y_b,
        // a_b = alpha_b x y + alpha x y_b + omega_b x v + omega x v_b
        let yb = state.rotation * s.map(|x| x.d.0[0]) + d.dpi.cross(y);
        let vb = d.domega.cross(y) + state.omega.cross(yb);
        let ab = d.dalpha.cross(y) + state.alpha.cross(yb) + d.domega.cross(v) + state.omega.cross(vb);
        [[y, v, a], [yb, vb, ab]]
    }
}

impl Bodies<Dual<Rates>> for ChangingBodies {
    fn point(&self, body: BodyId, s: Vec3<Dual<Rates>>) -> Vec3<Dual<Rates>> {
        let [[y, v, a], [yb, vb, ab]] = self.vector(body, s);
        let (state, d) = &self.at[body.0];
        Vec3::of_rates([state.r + y, state.v + v, state.a + a]).with_derivative(Vec3::of_rates([
            d.dr + yb,
            d.dv + vb,
            d.da + ab,
        ]))
    }

    fn direction(&self, body: BodyId, e: Vec3<Dual<Rates>>) -> Vec3<Dual<Rates>> {
        let [value, derivative] = self.vector(body, e);
        Vec3::of_rates(value).with_derivative(Vec3::of_rates(derivative))
    }

    fn pose(&self, body: BodyId) -> Pose {
        self.at[body.0].0.pose()
    }

    fn leave_plane(&self, bodies: [BodyId; 2], at: Vec3, normal: Vec3) -> bool {
        leave_plane(bodies.map(|body| self.at[body.0].0), at, normal)
    }
}

/// Part of a relative motion that is out of a plane above which it is no round-off.
const OUT_OF_PLANE: f64 = 1e-6;

/// True if two bodies move relative to each other out of the plane through a point with this unit normal.
fn leave_plane([a, b]: [BodyState; 2], at: Vec3, normal: Vec3) -> bool {
    let velocity = |body: &BodyState| body.v + body.omega.cross(at - body.r);
    let (slides, turns) = (velocity(&b) - velocity(&a), b.omega - a.omega);
    slides.dot(normal).abs() > OUT_OF_PLANE * slides.norm()
        || turns.cross(normal).norm() > OUT_OF_PLANE * turns.norm()
}

/// A vector that is fixed in a body, with its rates: `omega x y` and `alpha x y + omega x (omega x y)`.
pub(super) fn rates_of(state: &BodyState, y: Vec3) -> [Vec3; 3] {
    let v = state.omega.cross(y);
    [y, v, state.alpha.cross(y) + state.omega.cross(v)]
}

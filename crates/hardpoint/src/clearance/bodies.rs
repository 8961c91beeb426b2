//! Bodies that carry shapes: their points and directions with the derivatives of a number type.

use crate::model::{BodyId, Model};
use crate::motion::{BodyState, States};
use crate::number::{self, Dual, Rates};
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
    /// The body's state in plain numbers; `None` for bodies without rates.
    fn state(&self, body: BodyId) -> Option<BodyState>;
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

    fn state(&self, _: BodyId) -> Option<BodyState> {
        None
    }
}

/// Bodies of a motion, with rates. Body-fixed data are constant over time, so that points need a fraction of the
/// arithmetic of poses with rates. Numbers of a body are gathered once for all of its points.
pub(crate) struct MovingBodies {
    /// Bodies that carry shapes.
    carriers: Vec<usize>,
    /// Per body.
    at: Vec<BodyState>,
}

impl MovingBodies {
    /// Bodies of a model, at rest in its origin.
    pub fn of(model: &Model) -> Self {
        Self { carriers: carriers(model), at: vec![BodyState::GROUND; model.bodies.len()] }
    }

    /// Moves those that carry shapes.
    pub fn set(&mut self, states: States<'_>) {
        self.carriers.iter().for_each(|&b| self.at[b] = states.body(b));
    }

    /// State of a body that carries a shape.
    pub fn state_of(&self, body: BodyId) -> &BodyState {
        &self.at[body.0]
    }
}

impl Bodies<Rates> for MovingBodies {
    fn point(&self, body: BodyId, s: Vec3<Rates>) -> Vec3<Rates> {
        let state = &self.at[body.0];
        let [y, v, a] = rates_of(state, state.rotation * s.value());
        Vec3::of_rates([state.r + y, state.v + v, state.a + a])
    }

    fn direction(&self, body: BodyId, e: Vec3<Rates>) -> Vec3<Rates> {
        let state = &self.at[body.0];
        Vec3::of_rates(rates_of(state, state.rotation * e.value()))
    }

    fn pose(&self, body: BodyId) -> Pose {
        self.at[body.0].pose()
    }

    fn place(&self, body: BodyId, s: Vec3) -> Vec3 {
        let state = &self.at[body.0];
        state.r + state.rotation * s
    }

    fn heading(&self, body: BodyId, e: Vec3) -> Vec3 {
        self.at[body.0].rotation * e
    }

    fn state(&self, body: BodyId) -> Option<BodyState> {
        Some(self.at[body.0])
    }
}

/// Bodies of a model that carry shapes.
fn carriers(model: &Model) -> Vec<usize> {
    let bodies = model.shapes.iter().flat_map(|shape| shape.bodies(model));
    let mut carriers: Vec<usize> = bodies.map(|b| b.0).collect();
    carriers.sort_unstable();
    carriers.dedup();
    carriers
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
        Self {
            carriers: carriers(model),
            at: vec![(BodyState::GROUND, BodySensitivity::ZERO); model.bodies.len()],
        }
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

    fn state(&self, body: BodyId) -> Option<BodyState> {
        Some(self.at[body.0].0)
    }
}

/// Part of a relative motion that is out of a plane above which it is no round-off.
const OUT_OF_PLANE: f64 = 1e-6;
/// Part of a motion that relative motion must exceed: below it is the round-off of bodies that move as one.
const AT_REST: f64 = 1e-13;

/// A segment that moves: each end with the body that carries it.
pub(super) struct MovingSegment {
    /// Ends, global.
    pub ends: [Vec3; 2],
    /// The bodies that carry them.
    pub carriers: [BodyState; 2],
    /// True if one body carries both.
    pub is_rigid: bool,
}

impl MovingSegment {
    /// Velocities of its ends.
    fn velocities(&self) -> [Vec3; 2] {
        number::both([0, 1], |k| {
            let body = &self.carriers[k];
            body.v + body.omega.cross(self.ends[k] - body.r)
        })
    }
}

/// True if two segments that cross at a point leave their plane: there the lines move apart along its normal, or a body
/// that carries one of them turns out of it.
pub(super) fn leave_their_plane(segments: [&MovingSegment; 2], at: Vec3) -> bool {
    let [e, f] = number::both(segments, |s| s.ends[1] - s.ends[0]);
    let [u, v] = number::both([e, f], |e| e * (1.0 / e.norm()));
    let Some(normal) = u.cross(v).unit() else { return false };
    let velocities = segments.map(MovingSegment::velocities);
    // Velocities of the lines' own points at the crossing, and the ends' velocities relative to each other.
    let crossing = number::both([0, 1], |k| {
        let (from, along) = (segments[k].ends[0], [e, f][k]);
        let [v, w] = velocities[k];
        v + (w - v) * (along.dot(at - from) / along.dot(along))
    });
    let greatest = |all: &mut dyn Iterator<Item = Vec3>| all.map(|v| v.norm()).fold(0.0, f64::max);
    let fastest = greatest(&mut velocities.into_iter().flatten());
    let relative = greatest(&mut velocities[0].iter().flat_map(|v| number::both(velocities[1], |w| w - *v)));
    if (crossing[1] - crossing[0]).dot(normal).abs() > OUT_OF_PLANE * relative + AT_REST * fastest {
        return true;
    }
    // The plane of both lines turns with w: n . (w x e) is the rate at which the first one rises, and alike the second.
    let rises = number::both(velocities, |[v, w]| normal.dot(w - v));
    let turn = (f * rises[0] - e * rises[1]) * (1.0 / f.dot(e.cross(normal)));
    let size = e.norm().max(f.norm());
    segments.into_iter().filter(|s| s.is_rigid).any(|s| {
        let spin = s.carriers[0].omega;
        let within = OUT_OF_PLANE * (relative / size).max((spin - turn).norm());
        (spin - turn).cross(normal).norm() > within + AT_REST * (spin.norm() + fastest / size)
    })
}

/// A vector that is fixed in a body, with its rates: `omega x y` and `alpha x y + omega x (omega x y)`.
pub(super) fn rates_of(state: &BodyState, y: Vec3) -> [Vec3; 3] {
    let v = state.omega.cross(y);
    [y, v, state.alpha.cross(y) + state.omega.cross(v)]
}

//! Reactions of joints and driver loads at a position, and their derivatives by the design; over plain numbers, or
//! during recording.
//!
//! | here | theory | meaning |
//! |---|---|---|
//! | `needed` | F = f - g | required wrench of each body (43) minus its applied wrench (44) |
//! | `transmission` | T, mu | transmitted wrenches, and their derivative by a variable: (18) with F, and (45) |
//! | `x`, `l` | x', l' | derivatives of unit twists and wrenches by the design |

use crate::design::Geometry;
use crate::model::{DriverId, ElementId, JointId, MeasureKind, Model};
use crate::motion::kinematics::State;
use crate::motion::level::Flow;
use crate::number::{Dual, Real};
use crate::sensitivity::{Differentiated, PlanVelocity, Transmission, Transposed, Way};
use crate::space::{Mat3, Pose, Twist, Vec3, Wrench};
use crate::topology::{ClosureId, CoordinateId, LinkId, RowId, RowTerm, Topology};

use super::acting::{AppliedLoads, MovingBody};
use super::inertia::{Changed, SpatialInertia};
use super::measures::Instant;

/// Unknown of the plan that carries the force of a driver.
#[derive(Clone, Copy, Debug)]
pub(super) enum DriverAt {
    /// `nu = T_k . x_a` of a coordinate of the tree.
    Coordinate(CoordinateId),
    /// `nu = mu_r` of a row.
    Row(RowId),
}

/// Rows of the plan that carry the wrench of a joint on its body j.
#[derive(Clone, Debug, Default)]
pub(super) struct JointAt {
    /// The link of a tree joint; true if it runs from body i to body j.
    pub link: Option<(LinkId, bool)>,
    /// Rows of a cut joint, and of drivers across it.
    pub closures: Vec<ClosureId>,
}

/// Locations of the loads of joints and drivers in the plan.
pub(super) struct Places {
    pub drivers: Vec<Option<DriverAt>>,
    pub joints: Vec<JointAt>,
    way: Way,
}

/// Loads at a position: over plain numbers, or with the derivative by a variable.
#[derive(Clone, Debug)]
pub(crate) struct Carried<T> {
    /// Per joint: its reaction wrench on body j, about the world origin.
    pub joints: Vec<Wrench<T>>,
    /// Per driver: its force or moment.
    pub drivers: Vec<T>,
    /// Per driver: the speed that it prescribes.
    pub speeds: Vec<T>,
    /// Wrench of the mechanism on ground, about the world origin.
    pub shaking: Wrench<T>,
}

/// Self-stress: wrenches on the joints due to a unit force of a redundant constraint.
pub(super) struct Stress<T> {
    pub carried: Carried<T>,
    /// Largest joint reaction; moments are divided by the size of the mechanism.
    pub most: T,
}

/// A position with its applied loads and reactions, over plain numbers or with the derivative by a variable.
pub(super) struct LoadedPosition<T> {
    pub bodies: Vec<MovingBody<T>>,
    /// Per element: the value of its law.
    pub laws: Vec<T>,
    /// Per element: the coordinate that it acts on, with whole turns counted.
    pub near: Vec<T>,
    /// Per element: the moment of friction.
    pub friction: Vec<T>,
    pub needed: Vec<Wrench<T>>,
    pub found: Carried<T>,
}

impl<T: Real> LoadedPosition<T> {
    fn new(model: &Model) -> Self {
        let elements = model.elements.len();
        Self {
            bodies: vec![MovingBody::still(); model.bodies.len()],
            laws: vec![T::one(); elements],
            near: vec![T::zero(); elements],
            friction: vec![T::zero(); elements],
            needed: vec![Wrench::zero(); model.bodies.len()],
            found: Carried::new(model),
        }
    }

    pub fn acting<'s>(&'s self, model: &'s Model, geometry: &'s Geometry<T>) -> AppliedLoads<'s, T> {
        let Self { bodies, laws, near, friction, .. } = self;
        AppliedLoads { model, geometry, bodies, laws, near, friction }
    }
}

/// Equilibrium of all bodies at a position.
pub(super) struct Equilibrium<T> {
    pub places: Places,
    pub now: LoadedPosition<T>,
    pub along: LoadedPosition<Dual<T>>,
    pub transmission: Transmission<T>,
    /// Transmission of some wrenches alone.
    alone: Transmission<T>,
    x: Vec<Twist<T>>,
    l: Vec<Wrench<T>>,
    /// Per body: its spatial inertia, the inertial part of F', and its motion without derivative by the design.
    pub inertia: Vec<SpatialInertia<T>>,
    inertial: Vec<Wrench<T>>,
    pub still: Vec<MovingBody<Dual<T>>>,
}

impl<T: Real> Equilibrium<T> {
    pub fn new(model: &Model, topology: &Topology) -> Self {
        Self {
            places: Places {
                drivers: (0..model.drivers.len()).map(|d| driver_at(topology, DriverId(d))).collect(),
                joints: (0..model.joints.len()).map(|j| joint_at(topology, JointId(j))).collect(),
                way: Way::of_all(topology),
            },
            now: LoadedPosition::new(model),
            along: LoadedPosition::new(model),
            transmission: Transmission::new(model, topology),
            alone: Transmission::new(model, topology),
            x: vec![Twist::zero(); topology.coordinates.len()],
            l: vec![Wrench::zero(); topology.rows.len()],
            inertia: vec![SpatialInertia::zero(); model.bodies.len()],
            inertial: vec![Wrench::zero(); model.bodies.len()],
            still: vec![MovingBody::still(); model.bodies.len()],
        }
    }

    /// Sets the motion of the bodies and the speeds of the drivers.
    pub fn stand(&mut self, state: &State<T>, speed: impl Fn(usize) -> T) {
        let [v, a, _] = &state.motion.twists;
        for b in 1..self.now.bodies.len() {
            self.now.bodies[b] = MovingBody { pose: state.pose[b], v: v[b], a: a[b] };
        }
        self.now.found.speeds.iter_mut().enumerate().for_each(|(d, to)| *to = speed(d));
    }

    /// Solves for the reactions to the required wrenches: T and mu of (18) with F.
    pub fn carry(
        &mut self,
        topology: &Topology,
        state: &mut State<T>,
        (model, geometry): (&Model, &Geometry<T>),
    ) {
        let Self { places, now, transmission, .. } = self;
        let mut needed = std::mem::take(&mut now.needed);
        now.acting(model, geometry).needed(&mut needed);
        transmission.load[0].copy_from_slice(&needed);
        transmission.transmit(topology, Transposed::of(state), &places.way, 0);
        let of = Derived { x: &state.x[0], x_changed: &[], l: &state.l[0], l_changed: &[] };
        let found = &mut now.found;
        for (at, to) in places.joints.iter().zip(&mut found.joints) {
            *to = joint_wrench(at, topology, transmission, &of, |v, _| v);
        }
        for (at, to) in places.drivers.iter().zip(&mut found.drivers) {
            *to = at.map_or(T::constant(f64::NAN), |at| driver_force(at, topology, transmission, &of)[0]);
        }
        found.shaking = shaking(&needed);
        now.needed = needed;
    }

    /// Prepares the derivatives by variables; they are zero at first.
    pub fn begin_changes(&mut self, (model, geometry): (&Model, &Geometry<T>)) {
        let Self { now, along, inertia, still, .. } = self;
        SpatialInertia::all(&now.acting(model, geometry), inertia);
        for (still, body) in still.iter_mut().zip(&now.bodies) {
            *still = changed(body, [Twist::zero(); 3]);
        }
        let lists = [
            (&mut along.laws, &now.laws),
            (&mut along.near, &now.near),
            (&mut along.friction, &now.friction),
        ];
        for (to, from) in lists {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = Dual::constant(*from));
        }
        along.found.keep(&now.found);
    }

    /// Sets the derivative of the motion by a variable.
    pub fn go_along(&mut self, field: &PlanVelocity<T>, flow: &Flow<T>) {
        let Self { now, along, .. } = self;
        for b in 1..now.bodies.len() {
            along.bodies[b] = changed(&now.bodies[b], flow.twists.each_ref().map(|w| w[b]));
        }
        for (d, speed) in along.found.speeds.iter_mut().enumerate() {
            *speed = Dual { v: now.found.speeds[d], d: field.law_rate(DriverId(d), 1) };
        }
    }

    /// Sets the derivatives that reactions depend on; friction has none at first.
    pub fn change(&mut self, model: &Model, by: Differentiated<'_, T>) {
        let Differentiated { topology, state, field, flow, .. } = by;
        self.go_along(field, flow);
        let Self { now, along, x, l, inertia, inertial, .. } = self;
        for (to, from) in along.friction.iter_mut().zip(&now.friction) {
            *to = Dual::constant(*from);
        }
        for b in 1..now.bodies.len() {
            let twists = flow.twists.each_ref().map(|w| w[b]);
            inertial[b] = inertia[b].changed(model, &now.bodies[b], twists);
        }
        field.turn_axes(topology, state, flow, (x, l));
    }

    /// Computes the derivatives of applied loads along the direction that was set, and of masses that depend on it.
    pub fn act(&mut self, model: &Model, geometry: &Geometry<Dual<T>>, masses: &[ElementId]) {
        let Self { along, still, .. } = self;
        let mut needed = std::mem::take(&mut along.needed);
        needed.fill(Wrench::zero());
        let acting = along.acting(model, geometry);
        let forces = (0..model.elements.len()).filter(|e| !model.elements[*e].kind.has_mass());
        forces.for_each(|e| acting.add(ElementId(e), &mut needed));
        // Masses that depend on the variable act with the nominal motion; `inertial` has the derivative of the motion.
        let standing = AppliedLoads { bodies: still, ..acting };
        masses.iter().for_each(|e| standing.add(*e, &mut needed));
        along.needed = needed;
    }

    /// Computes T' and mu' along the direction that was set: the derivative (45) of the same equation, with x' and l'.
    pub fn carry_changed(
        &mut self,
        topology: &Topology,
        state: &mut State<T>,
        (model, Changed { geometry, masses }): (&Model, &Changed<T>),
    ) {
        self.act(model, geometry, masses);
        let Self { places, now, along, transmission, x, l, inertial, .. } = self;
        let mut needed = std::mem::take(&mut along.needed);
        for (b, load) in transmission.load[1].iter_mut().enumerate() {
            let part = &mut needed[b];
            let change = |whole: Vec3<T>, d: Vec3<Dual<T>>| whole + d.map(|x| x.d);
            *load = Wrench { m: change(inertial[b].m, part.m), f: change(inertial[b].f, part.f) };
            *part = Wrench { m: both(now.needed[b].m, load.m), f: both(now.needed[b].f, load.f) };
        }
        let State { x: x_now, l: l_now, factors, rhs, .. } = state;
        let (x_now, l_now) = (&x_now[0], &l_now[0]);
        let with = Transposed { x: [x_now, x, &[]], l: [l_now, l, &[]], factors, rhs };
        transmission.transmit(topology, with, &places.way, 1);
        let of = Derived { x: x_now, x_changed: x, l: l_now, l_changed: l };
        let found = &mut along.found;
        for (at, to) in places.joints.iter().zip(&mut found.joints) {
            *to = joint_wrench(at, topology, transmission, &of, |v, d| Dual { v, d });
        }
        for (at, to) in places.drivers.iter().zip(&mut found.drivers) {
            let unknown = [T::constant(f64::NAN); 2];
            let [v, d] = at.map_or(unknown, |at| driver_force(at, topology, transmission, &of));
            *to = Dual { v, d };
        }
        found.shaking = shaking(&needed);
        along.needed = needed;
    }

    /// Reactions of all joints to the applied wrenches alone; `applied` reduces the required wrenches.
    pub fn response(
        &mut self,
        topology: &Topology,
        state: &mut State<T>,
        applied: impl IntoIterator<Item = (usize, Wrench<T>)>,
    ) -> Vec<Wrench<T>> {
        let Self { places, alone, .. } = self;
        alone.load[0].fill(Wrench::zero());
        applied.into_iter().for_each(|(body, wrench)| alone.load[0][body] -= wrench);
        alone.transmit(topology, Transposed::of(state), &places.way, 0);
        let of = Derived { x: &state.x[0], x_changed: &[], l: &state.l[0], l_changed: &[] };
        places.joints.iter().map(|at| joint_wrench(at, topology, alone, &of, |v, _| v)).collect()
    }

    /// Self-stresses of the redundant constraints, one per redundant row.
    pub fn stresses(
        &mut self,
        topology: &Topology,
        state: &mut State<T>,
        (model, geometry): (&Model, &Geometry<T>),
    ) -> Vec<Stress<T>> {
        let mut stresses = Vec::new();
        for r in topology.redundant() {
            if stresses.is_empty() {
                state.finish_wrenches(topology);
            }
            // With mu_r = 1 row r applies l to body j, whose required wrench is reduced by it.
            let pull = |RowTerm { row, factor }| {
                (topology[row].closure, state.l[0][row.0].times_plus(T::constant(factor), Wrench::zero()))
            };
            let pulls: Vec<_> = topology.parts_of_row(r).map(pull).collect();
            let on_bodies = pulls.iter().flat_map(|(c, l)| {
                let [i, j] = topology[*c].bodies;
                [(j.0, *l), (i.0, Wrench::zero() - *l)]
            });
            let mut joints = self.response(topology, state, on_bodies);
            for (at, to) in self.places.joints.iter().zip(&mut joints) {
                pulls.iter().filter(|(c, _)| at.closures.contains(c)).for_each(|(_, l)| *to += *l);
            }
            let carried = Carried { joints, ..Carried::new(model) };
            let most = Instant { acting: &self.now.acting(model, geometry), carried: &carried }.most();
            stresses.push(Stress { carried, most });
        }
        stresses
    }
}

/// Largest contribution of self-stresses to a measure: if it is above zero, the measure is not determined. Only
/// reactions have one.
pub(super) fn excess<T: Real>(kind: &MeasureKind, acting: &AppliedLoads<'_, T>, stresses: &[Stress<T>]) -> T {
    let none = T::constant(-1.0);
    if !matches!(kind, MeasureKind::Reaction { .. }) {
        return none;
    }
    let of = |stress: &Stress<T>| Instant { acting, carried: &stress.carried }.excess(kind, stress.most);
    stresses.iter().fold(none, |most, stress| most.larger(of(stress)))
}

/// True if no self-stress contributes to the measure.
pub(super) fn is_known(kind: &MeasureKind, acting: &AppliedLoads<'_, f64>, stresses: &[Stress<f64>]) -> bool {
    // A NaN compares as undetermined.
    excess(kind, acting, stresses) <= 0.0
}

impl<T: Real> Carried<Dual<T>> {
    /// Copies the values of `now`, without derivatives.
    fn keep(&mut self, now: &Carried<T>) {
        let constant = |v: Vec3<T>| v.map(Dual::constant);
        let held = |l: &Wrench<T>| Wrench { m: constant(l.m), f: constant(l.f) };
        self.joints.iter_mut().zip(&now.joints).for_each(|(to, from)| *to = held(from));
        self.shaking = held(&now.shaking);
        for (to, from) in [(&mut self.drivers, &now.drivers), (&mut self.speeds, &now.speeds)] {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = Dual::constant(*from));
        }
    }
}

impl<T: Real> Carried<T> {
    pub fn new(model: &Model) -> Self {
        Self {
            joints: vec![Wrench::zero(); model.joints.len()],
            drivers: vec![T::zero(); model.drivers.len()],
            speeds: vec![T::zero(); model.drivers.len()],
            shaking: Wrench::zero(),
        }
    }
}

/// Unit twists and wrenches of a position, and their derivatives; empty if none are requested.
struct Derived<'s, T> {
    x: &'s [Twist<T>],
    x_changed: &'s [Twist<T>],
    l: &'s [Wrench<T>],
    l_changed: &'s [Wrench<T>],
}

/// Unknown that carries a driver's force.
fn driver_at(topology: &Topology, driver: DriverId) -> Option<DriverAt> {
    let coordinate = topology.driven_coordinates().find(|(_, d)| *d == driver);
    let closure = || topology.closures.iter().find(|c| c.driver == Some(driver));
    match coordinate {
        Some((c, _)) => Some(DriverAt::Coordinate(c)),
        None => closure().map(|closure| DriverAt::Row(closure.first_row)),
    }
}

/// Rows that carry a joint's wrench. The couples of couplers between its coordinates belong to the couplers.
fn joint_at(topology: &Topology, joint: JointId) -> JointAt {
    let link = LinkId::each(&topology.links).find(|(_, link)| link.joint == Some(joint));
    let closures =
        ClosureId::each(&topology.closures).filter(|(_, c)| c.joint == joint && c.coupler.is_none());
    JointAt {
        link: link.map(|(k, link)| (k, link.parent_end == 0)),
        closures: closures.map(|(c, _)| c).collect(),
    }
}

/// Reaction wrench of a joint on body j; `number` combines a value and its derivative.
fn joint_wrench<T: Real, N>(
    at: &JointAt,
    topology: &Topology,
    transmission: &Transmission<T>,
    of: &Derived<'_, T>,
    number: impl Fn(T, T) -> N,
) -> Wrench<N> {
    let Transmission { links, rows, .. } = transmission;
    let is_changed = !of.l_changed.is_empty() || !of.x_changed.is_empty();
    let (mut sum, mut change) = (Wrench::<T>::zero(), Wrench::<T>::zero());
    if let Some((k, forward)) = at.link {
        let sign = T::constant(if forward { 1.0 } else { -1.0 });
        // T_k is the wrench of the parent on the child.
        sum = links[0][k.0].times_plus(sign, sum);
        if is_changed {
            change = links[1][k.0].times_plus(sign, change);
        }
    }
    for &c in &at.closures {
        for r in topology[c].row_ids().filter(|&r| topology[r].has_wrench()) {
            // Row r applies mu_r l_r to body j; the derivative is mu' l + mu l'
            sum = of.l[r.0].times_plus(rows[0][r.0], sum);
            if is_changed {
                change = of.l[r.0].times_plus(rows[1][r.0], change);
                change = of.l_changed[r.0].times_plus(rows[0][r.0], change);
            }
        }
    }
    let vector = |v: Vec3<T>, d: Vec3<T>| Vec3::new(number(v.x, d.x), number(v.y, d.y), number(v.z, d.z));
    Wrench { m: vector(sum.m, change.m), f: vector(sum.f, change.f) }
}

/// Driver load and its derivative.
fn driver_force<T: Real>(
    at: DriverAt,
    topology: &Topology,
    transmission: &Transmission<T>,
    of: &Derived<'_, T>,
) -> [T; 2] {
    let Transmission { links, rows, .. } = transmission;
    match at {
        DriverAt::Coordinate(c) => {
            let k = topology[c].link.0;
            // nu = T . x,    nu' = T' . x + T . x'
            let change =
                of.x_changed.get(c.0).map_or(T::zero(), |x| links[1][k].on(of.x[c.0]) + links[0][k].on(*x));
            [links[0][k].on(of.x[c.0]), change]
        }
        DriverAt::Row(r) => [rows[0][r.0], rows[1][r.0]],
    }
}

/// Wrench of the mechanism on ground: minus all required wrenches, since internal forces cancel.
fn shaking<T: Real>(needed: &[Wrench<T>]) -> Wrench<T> {
    needed.iter().fold(Wrench::zero(), |sum, f| sum - *f)
}

/// A vector with its derivative.
fn both<T: Real>(v: Vec3<T>, d: Vec3<T>) -> Vec3<Dual<T>> {
    Vec3::new(Dual { v: v.x, d: d.x }, Dual { v: v.y, d: d.y }, Dual { v: v.z, d: d.z })
}

/// Motion of a body with its derivative, from its design twist and the first two rates of it:
/// `A' = W_w x A, r' = W at r` and (14) for V' and A'.
pub(super) fn changed<T: Real>(body: &MovingBody<T>, [w0, w1, w2]: [Twist<T>; 3]) -> MovingBody<Dual<T>> {
    let twist = |t: Twist<T>, d: Twist<T>| Twist { w: both(t.w, d.w), v: both(t.v, d.v) };
    let MovingBody { pose, v, a } = *body;
    let cols = pose.rot.cols.map(|c| both(c, w0.w.cross(c)));
    MovingBody {
        pose: Pose { rot: Mat3 { cols }, r: both(pose.r, w0.at(pose.r)) },
        v: twist(v, w1 + w0.ad(v)),
        a: twist(a, w2 + w1.ad(v) + w0.ad(a)),
    }
}

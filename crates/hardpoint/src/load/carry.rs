//! What joints and drivers put on the bodies, step after step, and how that changes with the design.
//!
//! | here | theory | what |
//! |---|---|---|
//! | `needed` | F = f - g | what each body needs besides what acts on it (43), (44) |
//! | `transmission` | T, mu | what joints transmit, and its derivative by a variable: (18) with F, and (45) |
//! | `x`, `l` | x', l' | how unit twists and wrenches turn with the design |

use crate::design::{DesignMap, Geometry};
use crate::measure::StepValues;
use crate::model::{
    Axes, DriverId, ElementId, JointId, MeasureKind, Model, PointId, ReactionPart, VariableId,
};
use crate::motion::kinematics::State;
use crate::motion::stepper::Stepper;
use crate::number::{Dual, Real};
use crate::sensitivity::{Differentiated, Transmission, Transposed, Way};
use crate::space::{Mat3, Pose, Twist, Vec3, Wrench};
use crate::topology::{ClosureId, CoordinateId, LinkId, RowId, Term, Topology};

use super::acting::{Acting, Moving};
use super::friction::Friction;
use super::measures::Instant;
use super::turns::Turns;

/// Where the force of a driver shows.
#[derive(Clone, Copy, Debug)]
pub(super) enum DriverAt {
    /// `nu = T_k . x_a` of a coordinate of the tree.
    Coordinate(CoordinateId),
    /// `nu = mu_r` of a row.
    Row(RowId),
}

/// Where the wrench of a joint shows: what it puts on its body j.
#[derive(Clone, Debug, Default)]
pub(super) struct JointAt {
    /// A link, and whether it runs from body i to body j.
    pub link: Option<(LinkId, bool)>,
    /// Rows of a cut joint, and of drivers across it.
    pub closures: Vec<ClosureId>,
}

/// What loads come to at a position: over plain numbers, or with the derivative by a variable.
#[derive(Clone, Debug)]
pub(crate) struct Carried<T> {
    /// Per joint: the wrench that it puts on its body j, about the world origin.
    pub joints: Vec<Wrench<T>>,
    /// Per driver: its force or moment.
    pub drivers: Vec<T>,
    /// Per driver: the speed that it prescribes.
    pub speeds: Vec<T>,
    /// What the mechanism puts on ground, about the world origin.
    pub shaking: Wrench<T>,
}

/// A position with all that acts there, over plain numbers or with the derivative by a variable.
pub(super) struct Scene<T> {
    pub bodies: Vec<Moving<T>>,
    /// Per element: the moment of friction.
    pub friction: Vec<T>,
    needed: Vec<Wrench<T>>,
    pub found: Carried<T>,
}

impl<T: Real> Scene<T> {
    fn new(model: &Model) -> Self {
        Self {
            bodies: vec![Moving::still(); model.bodies.len()],
            friction: vec![T::zero(); model.elements.len()],
            needed: vec![Wrench::zero(); model.bodies.len()],
            found: Carried::new(model),
        }
    }

    fn acting<'s>(
        &'s self,
        model: &'s Model,
        geometry: &'s Geometry<T>,
        laws: &'s [f64],
        near: &'s [f64],
    ) -> Acting<'s, T> {
        Acting { model, geometry, bodies: &self.bodies, laws, near, friction: &self.friction }
    }
}

/// Where joints and drivers show in the plan.
pub(super) struct Places {
    pub drivers: Vec<Option<DriverAt>>,
    pub joints: Vec<JointAt>,
    way: Way,
}

impl Places {
    /// T and mu of what the bodies need: (18) with F.
    fn carry(
        &self,
        topology: &Topology,
        state: &mut State<f64>,
        scene: &mut Scene<f64>,
        by: &mut Transmission,
    ) {
        by.load[0].copy_from_slice(&scene.needed);
        by.transmit(topology, Transposed::of(state), &self.way, 0);
        let of = Derived { x: &state.x[0], x_changed: &[], l: &state.l[0], l_changed: &[] };
        let found = &mut scene.found;
        for (at, to) in self.joints.iter().zip(&mut found.joints) {
            *to = joint_wrench(at, topology, by, &of, |v, _| v);
        }
        for (at, to) in self.drivers.iter().zip(&mut found.drivers) {
            *to = at.map_or(f64::NAN, |at| driver_force(at, topology, by, &of)[0]);
        }
        found.shaking = shaking(&scene.needed);
    }

    /// T' and mu', where T and mu stand: the same equation differentiated (45), with x' and l'.
    fn carry_changed(
        &self,
        topology: &Topology,
        state: &mut State<f64>,
        (x, l): (&[Twist], &[Wrench]),
        scene: &mut Scene<Dual>,
        by: &mut Transmission,
    ) {
        for (to, from) in by.load[1].iter_mut().zip(&scene.needed) {
            *to = Wrench { m: from.m.map(|x| x.d), f: from.f.map(|x| x.d) };
        }
        let State { x: x_now, l: l_now, factors, rhs, .. } = state;
        let (x_now, l_now) = (&x_now[0], &l_now[0]);
        let with = Transposed { x: [x_now, x, &[]], l: [l_now, l, &[]], factors, rhs };
        by.transmit(topology, with, &self.way, 1);
        let of = Derived { x: x_now, x_changed: x, l: l_now, l_changed: l };
        let found = &mut scene.found;
        for (at, to) in self.joints.iter().zip(&mut found.joints) {
            *to = joint_wrench(at, topology, by, &of, |v, d| Dual { v, d });
        }
        for (at, to) in self.drivers.iter().zip(&mut found.drivers) {
            let [v, d] = at.map_or([f64::NAN; 2], |at| driver_force(at, topology, by, &of));
            *to = Dual { v, d };
        }
        found.shaking = shaking(&scene.needed);
    }

    /// What all joints carry of wrenches that are applied to some bodies, alone: `applied` as what the bodies need less.
    fn response(
        &self,
        topology: &Topology,
        state: &mut State<f64>,
        applied: impl IntoIterator<Item = (usize, Wrench)>,
        by: &mut Transmission,
    ) -> Vec<Wrench> {
        by.load[0].fill(Wrench::zero());
        applied.into_iter().for_each(|(body, wrench)| by.load[0][body] -= wrench);
        by.transmit(topology, Transposed::of(state), &self.way, 0);
        let of = Derived { x: &state.x[0], x_changed: &[], l: &state.l[0], l_changed: &[] };
        self.joints.iter().map(|at| joint_wrench(at, topology, by, &of, |v, _| v)).collect()
    }
}

/// Evaluates loads where a stepper stands, in one design.
pub(crate) struct LoadSolver<'a> {
    pub(super) model: &'a Model,
    /// The measures of loads.
    asked: Vec<usize>,
    pub(super) places: Places,
    geometry: Geometry,
    /// The same as it goes with each variable, and with none.
    pub(super) changed: Vec<Geometry<Dual>>,
    pub(super) constant: Geometry<Dual>,
    pub(super) laws: Vec<f64>,
    /// Per element: the coordinate that it acts on, counted through its turns.
    pub near: Vec<f64>,
    turns: Vec<Turns>,
    pub(super) friction: Friction,
    pub(super) now: Scene<f64>,
    along: Scene<Dual>,
    pub(super) transmission: Transmission,
    /// What some wrenches alone make.
    alone: Transmission,
    x: Vec<Twist>,
    l: Vec<Wrench>,
    /// Whether reactions are to be judged: with redundant constraints not all are known.
    judges: bool,
    /// Per redundant row: what joints carry where that row pulls by itself.
    stresses: Vec<Carried<f64>>,
    /// Per measure: its value, and by variable and measure its derivative; NaN for those of no load.
    pub(super) values: Vec<f64>,
    derivatives: Vec<f64>,
}

impl<'a> LoadSolver<'a> {
    /// For the design with these values, with derivatives by the variables if they are wanted.
    pub fn new(
        design_map: &'a DesignMap<'a>,
        topology: &Topology,
        values: &[f64],
        sensitivities: bool,
    ) -> Self {
        let model = design_map.model();
        let variables = if sensitivities { model.variables.len() } else { 0 };
        let geometry_along = |v: Option<usize>| {
            let mut duals: Vec<Dual> = values.iter().map(|x| Dual::constant(*x)).collect();
            v.iter().for_each(|v| duals[*v] = Dual::variable(values[*v]));
            design_map.geometry(&duals)
        };
        let measures = model.measures.len();
        let is_reaction = |k: &MeasureKind| matches!(k, MeasureKind::Reaction { .. });
        Self {
            model,
            asked: (0..measures).filter(|m| model.measures[*m].kind.is_load()).collect(),
            places: Places {
                drivers: (0..model.drivers.len()).map(|d| driver_at(topology, DriverId(d))).collect(),
                joints: (0..model.joints.len()).map(|j| joint_at(topology, JointId(j))).collect(),
                way: Way::of_all(topology),
            },
            geometry: design_map.geometry(values),
            changed: (0..variables).map(|v| geometry_along(Some(v))).collect(),
            constant: geometry_along(None),
            laws: vec![1.0; model.elements.len()],
            near: vec![0.0; model.elements.len()],
            turns: (0..model.elements.len()).map(|e| Turns::of(model, topology, ElementId(e))).collect(),
            friction: Friction::new(model),
            now: Scene::new(model),
            along: Scene::new(model),
            transmission: Transmission::new(model, topology),
            alone: Transmission::new(model, topology),
            x: vec![Twist::zero(); topology.coordinates.len()],
            l: vec![Wrench::zero(); topology.rows.len()],
            judges: model.measures.iter().any(|m| is_reaction(&m.kind)),
            stresses: Vec::new(),
            values: vec![f64::NAN; measures],
            derivatives: vec![f64::NAN; measures * variables],
        }
    }

    /// The same for those who want all reactions, asked for or not.
    pub fn judging(self) -> Self {
        Self { judges: true, ..self }
    }

    /// Whether a model asks for any load.
    pub fn is_asked(model: &Model) -> bool {
        model.measures.iter().any(|m| m.kind.is_load())
    }

    /// What was found at the output time: joints and drivers.
    pub fn found(&self) -> &Carried<f64> {
        &self.now.found
    }

    /// Loads where a stepper stands at time t, with velocity and acceleration.
    pub fn step(&mut self, one: &mut Stepper<'_>, t: f64) {
        let (topology, state) = (&one.topology, &mut one.state);
        let model = self.model;
        for (law, element) in self.laws.iter_mut().zip(&model.elements) {
            *law = element.kind.law().map_or(1.0, |law| law.at(t).value());
        }
        for b in 1..self.now.bodies.len() {
            let [v, a, _] = &state.motion.twists;
            self.now.bodies[b] = Moving { pose: state.pose[b], v: v[b], a: a[b] };
        }
        for (d, to) in self.now.found.speeds.iter_mut().enumerate() {
            *to = one.parts.law_of(d).at(t).d();
        }
        self.follow_turns(&state.q, t);
        self.now.friction.fill(0.0);
        self.carry(topology, state);
        if self.judges || !self.friction.is_empty() {
            self.judge(topology, state);
        }
        if !self.friction.is_empty() {
            self.rub(topology, state);
        }
        let acting = self.now.acting(model, &self.geometry, &self.laws, &self.near);
        let instant = Instant { acting: &acting, carried: &self.now.found };
        for &m in &self.asked {
            let kind = &model.measures[m].kind;
            let known =
                !matches!(kind, MeasureKind::Reaction { .. }) || is_known(kind, &acting, &self.stresses);
            self.values[m] = if known { instant.measure(kind) } else { f64::NAN };
        }
    }

    /// What joints carry of what the bodies need now.
    fn carry(&mut self, topology: &Topology, state: &mut State<f64>) {
        let Self { model, geometry, laws, near, now, .. } = self;
        let mut needed = std::mem::take(&mut now.needed);
        now.acting(model, geometry, laws, near).needed(&mut needed);
        now.needed = needed;
        self.places.carry(topology, state, &mut self.now, &mut self.transmission);
    }

    /// What joints carry where redundant constraints pull by themselves.
    fn judge(&mut self, topology: &Topology, state: &mut State<f64>) {
        self.stresses.clear();
        for r in topology.redundant() {
            if self.stresses.is_empty() {
                state.finish_wrenches(topology);
            }
            let terms = || {
                topology.parts_of_row(r).map(|Term { row, factor }| {
                    // With mu_r = 1 row r puts l on body j, which needs so much less.
                    (topology[row].closure, state.l[0][row.0].times_plus(factor, Wrench::zero()))
                })
            };
            let pulls: Vec<_> = terms().collect();
            let on_bodies = pulls.iter().flat_map(|(c, l)| {
                let [i, j] = topology[*c].bodies;
                [(j.0, *l), (i.0, Wrench::zero() - *l)]
            });
            let mut joints = self.places.response(topology, state, on_bodies, &mut self.alone);
            for (at, to) in self.places.joints.iter().zip(&mut joints) {
                pulls.iter().filter(|(c, _)| at.closures.contains(c)).for_each(|(_, l)| *to += *l);
            }
            self.stresses.push(Carried { joints, ..Carried::new(self.model) });
        }
    }

    /// Lets friction act, from the forces that it makes itself.
    fn rub(&mut self, topology: &Topology, state: &mut State<f64>) {
        let Self { model, geometry, laws, near, now, places, friction, alone, stresses, .. } = self;
        {
            let acting = now.acting(model, geometry, laws, near);
            friction.set(&acting, &now.found, |e| {
                let Some((joint, l)) = acting.unit(e) else { return Vec::new() };
                let [i, j] = model.joints[joint].bodies;
                places.response(topology, state, [(j.0, l), (i.0, Wrench::zero() - l)], alone)
            });
            // Where constraints share the force across a pin nobody knows its friction.
            friction.solve(&acting, stresses);
        }
        friction.enter(&mut now.friction);
        self.carry(topology, state);
    }

    /// Where a joint is on its body j.
    pub fn place(&self, joint: JointId) -> Vec3 {
        let acting = self.now.acting(self.model, &self.geometry, &self.laws, &self.near);
        let [place, ..] = Instant { acting: &acting, carried: &self.now.found }.wrench(joint);
        place
    }

    /// The force and the moment that a joint puts on its body j, along these axes, the moment about its place there; and whether each
    /// component is known: where constraints say the same, some of what joints carry depends on how stiff they are.
    pub fn reaction(&self, joint: JointId, axes: Axes) -> [(Vec3, [bool; 3]); 2] {
        let acting = self.now.acting(self.model, &self.geometry, &self.laws, &self.near);
        let instant = Instant { acting: &acting, carried: &self.now.found };
        [ReactionPart::ForceAlong as fn(usize) -> _, ReactionPart::MomentAbout].map(|part| {
            let kinds =
                [0, 1, 2].map(|k| MeasureKind::Reaction { joint, part: part(k), on: None, axes: Some(axes) });
            let [x, y, z] = kinds.each_ref().map(|kind| instant.measure(kind));
            (Vec3::new(x, y, z), kinds.each_ref().map(|kind| is_known(kind, &acting, &self.stresses)))
        })
    }

    /// What is known of the force that a joint puts on its body j, global, and along how many directions it is: what redundant constraints
    /// that pull by themselves can change is left out.
    pub fn known_force(&self, joint: JointId) -> (Vec3, usize) {
        let acting = self.now.acting(self.model, &self.geometry, &self.laws, &self.near);
        let force_of = |carried| Instant { acting: &acting, carried }.wrench(joint)[1];
        // A basis of what they change: each less what is in those before it.
        let mut open: Vec<Vec3> = Vec::new();
        for carried in &self.stresses {
            let kind = MeasureKind::Reaction { joint, part: ReactionPart::Force, on: None, axes: None };
            if (Instant { acting: &acting, carried }).is_free_of(&kind) {
                continue;
            }
            let force = force_of(carried);
            let rest = across(force, &open);
            if rest.norm() > PARALLEL * force.norm() {
                open.push(rest * (1.0 / rest.norm()));
            }
        }
        (across(force_of(&self.now.found), &open), 3 - open.len())
    }

    /// What a force puts on the body of one of its points, global: what a spring, a bushing or a given force does there.
    pub fn push(&self, element: ElementId, at: PointId) -> Vec3 {
        let acting = self.now.acting(self.model, &self.geometry, &self.laws, &self.near);
        let mut needed = vec![Wrench::zero(); self.model.bodies.len()];
        acting.add(element, &mut needed);
        -needed[self.model.points[at.0].body.0].f
    }

    /// Lets the coordinates that elements act on count their turns.
    fn follow_turns(&mut self, q: &[f64], t: f64) {
        let Self { model, geometry, laws, near, turns, now, .. } = self;
        for (e, turns) in turns.iter_mut().enumerate() {
            let coordinate = |near: &[f64]| now.acting(model, geometry, laws, near).coordinate(ElementId(e));
            match turns {
                Turns::None => {}
                Turns::Coordinate(c) => near[e] = q[c.0],
                Turns::Path(before) => {
                    let Some([_, rate]) = coordinate(near) else { continue };
                    if let Some([then, rate_then]) = *before {
                        // As far as its mean rate takes it
                        near[e] += 0.5 * (rate + rate_then) * (t - then);
                    }
                    near[e] = coordinate(near).map_or(0.0, |now| now[0]);
                    *before = Some([t, rate]);
                }
            }
        }
    }

    /// Enters what was found among the measures of the output time.
    pub fn enter(&self, out: &mut StepValues) {
        let measures = self.values.len();
        for &m in &self.asked {
            out.set(m, self.values[m]);
            for (v, d) in self.derivatives.chunks_exact(measures).enumerate() {
                out.set_d(v, m, d[m]);
            }
        }
    }

    /// Their derivatives by a variable, for which the motion has been solved.
    pub fn differentiate(&mut self, by: Differentiated<'_>) {
        let Differentiated { variable: VariableId(v), topology, state, field, flow } = by;
        for b in 1..self.now.bodies.len() {
            self.along.bodies[b] = changed(&self.now.bodies[b], flow.twists.each_ref().map(|w| w[b]));
        }
        for (d, speed) in self.along.found.speeds.iter_mut().enumerate() {
            *speed = Dual { v: self.now.found.speeds[d], d: field.law_rate(DriverId(d), 1) };
        }
        // First as if friction stood.
        for (to, from) in self.along.friction.iter_mut().zip(&self.now.friction) {
            *to = Dual::constant(*from);
        }
        field.turn_axes(topology, state, flow, (&mut self.x, &mut self.l));
        self.carry_changed(v, topology, state);
        if !self.friction.is_empty() {
            let acting = self.along.acting(self.model, &self.changed[v], &self.laws, &self.near);
            self.friction.differentiate(&acting, &self.along.found);
            self.friction.enter_changed(&mut self.along.friction);
            self.carry_changed(v, topology, state);
        }
        let acting = self.along.acting(self.model, &self.changed[v], &self.laws, &self.near);
        let instant = Instant { acting: &acting, carried: &self.along.found };
        let measures = self.values.len();
        for &m in &self.asked {
            let d = instant.measure(&self.model.measures[m].kind).d;
            self.derivatives[v * measures + m] = if self.values[m].is_nan() { f64::NAN } else { d };
        }
    }

    fn carry_changed(&mut self, v: usize, topology: &Topology, state: &mut State<f64>) {
        let Self { model, changed, laws, near, along, x, l, .. } = self;
        let mut needed = std::mem::take(&mut along.needed);
        along.acting(model, &changed[v], laws, near).needed(&mut needed);
        along.needed = needed;
        self.places.carry_changed(topology, state, (x, l), along, &mut self.transmission);
    }
}

/// Whether redundant constraints that pull by themselves leave a reaction alone.
fn is_known(kind: &MeasureKind, acting: &Acting<'_, f64>, stresses: &[Carried<f64>]) -> bool {
    stresses.iter().all(|carried| Instant { acting, carried }.is_free_of(kind))
}

/// Two directions are one where no more than this part of one is across the other.
const PARALLEL: f64 = 1e-7;

/// What of a vector is across these unit vectors, which are across one another.
fn across(v: Vec3, directions: &[Vec3]) -> Vec3 {
    directions.iter().fold(v, |v, u| v - *u * u.dot(v))
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

/// Unit twists and wrenches of a position, and how they change; nothing where no change is asked for.
struct Derived<'s> {
    x: &'s [Twist],
    x_changed: &'s [Twist],
    l: &'s [Wrench],
    l_changed: &'s [Wrench],
}

/// Where a driver's force shows.
fn driver_at(topology: &Topology, driver: DriverId) -> Option<DriverAt> {
    let coordinate = topology.driven_coordinates().find(|(_, d)| *d == driver);
    let closure = || topology.closures.iter().find(|c| c.driver == Some(driver));
    match coordinate {
        Some((c, _)) => Some(DriverAt::Coordinate(c)),
        None => closure().map(|closure| DriverAt::Row(closure.first_row)),
    }
}

/// Where a joint's wrench shows. The couples of couplers between its coordinates are theirs.
fn joint_at(topology: &Topology, joint: JointId) -> JointAt {
    let link = LinkId::each(&topology.links).find(|(_, link)| link.joint == Some(joint));
    let closures =
        ClosureId::each(&topology.closures).filter(|(_, c)| c.joint == joint && c.coupler.is_none());
    JointAt {
        link: link.map(|(k, link)| (k, link.parent_end == 0)),
        closures: closures.map(|(c, _)| c).collect(),
    }
}

/// The wrench that a joint puts on its body j; `number` makes one of a value and its derivative.
fn joint_wrench<T: Real>(
    at: &JointAt,
    topology: &Topology,
    transmission: &Transmission,
    of: &Derived<'_>,
    number: impl Fn(f64, f64) -> T,
) -> Wrench<T> {
    let Transmission { links, rows, .. } = transmission;
    let is_changed = !of.l_changed.is_empty() || !of.x_changed.is_empty();
    let (mut sum, mut change) = (Wrench::<f64>::zero(), Wrench::<f64>::zero());
    if let Some((k, forward)) = at.link {
        let sign = if forward { 1.0 } else { -1.0 };
        // T_k is what the parent puts on the child.
        sum = links[0][k.0].times_plus(sign, sum);
        if is_changed {
            change = links[1][k.0].times_plus(sign, change);
        }
    }
    for &c in &at.closures {
        for r in topology[c].row_ids().filter(|&r| topology[r].drives()) {
            // mu_r l_r is what row r puts on body j; its derivative mu' l + mu l'
            sum = of.l[r.0].times_plus(rows[0][r.0], sum);
            if is_changed {
                change = of.l[r.0].times_plus(rows[1][r.0], change);
                change = of.l_changed[r.0].times_plus(rows[0][r.0], change);
            }
        }
    }
    let vector = |v: Vec3, d: Vec3| Vec3::new(number(v.x, d.x), number(v.y, d.y), number(v.z, d.z));
    Wrench { m: vector(sum.m, change.m), f: vector(sum.f, change.f) }
}

/// A driver's force or moment, and its derivative.
fn driver_force(
    at: DriverAt,
    topology: &Topology,
    transmission: &Transmission,
    of: &Derived<'_>,
) -> [f64; 2] {
    let Transmission { links, rows, .. } = transmission;
    match at {
        DriverAt::Coordinate(c) => {
            let k = topology[c].link.0;
            // nu = T . x,    nu' = T' . x + T . x'
            let change =
                of.x_changed.get(c.0).map_or(0.0, |x| links[1][k].on(of.x[c.0]) + links[0][k].on(*x));
            [links[0][k].on(of.x[c.0]), change]
        }
        DriverAt::Row(r) => [rows[0][r.0], rows[1][r.0]],
    }
}

/// What the mechanism puts on ground: minus all that the bodies need, the forces that it exerts within itself cancelling.
fn shaking<T: Real>(needed: &[Wrench<T>]) -> Wrench<T> {
    needed.iter().fold(Wrench::zero(), |sum, f| sum - *f)
}

/// A body's motion with its derivative, from its design twist and that's first two rates:
/// `A' = W_w x A, r' = W at r` and (14) for V' and A'.
pub(super) fn changed(body: &Moving<f64>, [w0, w1, w2]: [Twist; 3]) -> Moving<Dual> {
    let vector = |v: Vec3, d: Vec3| {
        Vec3::new(Dual { v: v.x, d: d.x }, Dual { v: v.y, d: d.y }, Dual { v: v.z, d: d.z })
    };
    let twist = |t: Twist, d: Twist| Twist { w: vector(t.w, d.w), v: vector(t.v, d.v) };
    let Moving { pose, v, a } = *body;
    let cols = pose.rot.cols.map(|c| vector(c, w0.w.cross(c)));
    Moving {
        pose: Pose { rot: Mat3 { cols }, r: vector(pose.r, w0.at(pose.r)) },
        v: twist(v, w1 + w0.ad(v)),
        a: twist(a, w2 + w1.ad(v) + w0.ad(a)),
    }
}

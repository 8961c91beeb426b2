//! Second design derivatives of positions: one more solution with the factors at hand for every pair of directions.
//!
//! The first-order condition of every row, `l . D_u = L_u`, also holds in designs along a second direction w.
//! Differentiated along w it is the equation of order 1, with w in place of time (`docs/theory.md` (15), (24)).
//!
//! | here | theory | meaning, per unit of a direction (or of both) |
//! |---|---|---|
//! | `FirstOrder::w()` | W_u | design twists of the bodies along one direction (11) |
//! | `FirstOrder::direct.flow.speeds[0]` | S_u | of the coordinates |
//! | `FirstOrder::links`, `closures` | z_u | of markers, in the world |
//! | `Pair::z` | z_u^w | how these change along the second direction |
//! | `Seconds::x`, `l` | x^w, l^w | unit twists and wrenches likewise, in place of their rates in time |
//! | `Pair::w`, `flow.speeds[1]` | W_uw, S_uw | derivative along w of W_u and S_u |

use hardpoint_tape::Number;

use crate::constraint::MarkerPairRates;
use crate::design::{DesignMap, DesignVelocity};
use crate::law::Law;
use crate::model::{DriverId, JointId, Model, VariableId};
use crate::motion::kinematics::State;
use crate::motion::level::turn_twists;
use crate::motion::mechanism::Mechanism;
use crate::number::{self, Dual, Real, record as recording};
use crate::space::{Pose, Twist, Vec3, Wrench};
use crate::topology::{ClosureId, LinkId, RowId, SetBy, Topology};

use super::direct::{DirectDifferentiation, LAW_STEP, MovingMarker, PlanVelocity};

/// Direction of differentiation.
#[derive(Clone, Debug, PartialEq)]
pub enum PairDirection {
    /// The design changes, with these rates of the variables.
    Design(Vec<f64>),
    /// One driver moves by one unit per unit; the design and the other drivers are fixed.
    Driver(DriverId),
    /// Marker i of a joint moves by this twist, along the joint's own axes, while the joint stays closed.
    Opening(JointId, Twist),
}

impl PairDirection {
    /// Rates of the design variables along the direction.
    fn speeds(&self) -> &[f64] {
        match self {
            Self::Design(speeds) => speeds,
            Self::Driver(_) | Self::Opening(..) => &[],
        }
    }

    /// Design velocity of the direction at the designs with these values.
    fn field<T: Real>(&self, design_map: &DesignMap<'_>, values: &[T]) -> DesignVelocity<T> {
        match self {
            Self::Design(speeds) => design_map.field_along(&along(speeds), values),
            Self::Driver(driver) => DesignVelocity::of_driver(*driver),
            Self::Opening(joint, twist) => design_map.opening(*joint, *twist, values),
        }
    }
}

/// Second derivatives of one body's position by two directions, global components, at fixed t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyCurvature {
    /// Second derivative of the position of the frame's origin.
    pub d2r: Vec3,
    /// Derivative along the second direction of dpi, the rotation vector rate along the first: not symmetric, since
    /// rotations do not commute.
    pub ddpi: Vec3,
}

impl BodyCurvature {
    /// Curvature of a body at r, by its design twists along both directions, and the derivative along the second of the
    /// first.
    pub(crate) fn of(r: Vec3, [u, w]: [Twist; 2], uw: Twist) -> Self {
        // r_uw = W_uw,v + W_uw,w x r + W_u,w x r_w                                                            (16)
        Self { d2r: uw.at(r) + u.w.cross(w.at(r)), ddpi: uw.w }
    }
}

/// First-order effect of one direction at one position.
struct FirstOrder<T> {
    field: PlanVelocity<T>,
    /// U = W_u, u = S_u, z = z_u, f = L_u.
    /// Order 0 is the direction; order 1 is its derivative along the second direction of a pair.
    direct: DirectDifferentiation<T>,
    /// Per link, the design twist of its parent's marker; per closure, those of markers i and j.
    links: Vec<Twist<T>>,
    closures: Vec<[Twist<T>; 2]>,
}

impl<T: Real> FirstOrder<T> {
    fn new(model: &Model, topology: &Topology, field: PlanVelocity<T>) -> Self {
        let mut direct = DirectDifferentiation::new(model, topology);
        // Along the design even the axes of joints on ground move: x^w = ad(z_w) x.
        direct.flow.ground_is_fixed = false;
        Self {
            field,
            direct,
            links: vec![Twist::zero(); topology.links.len()],
            closures: vec![[Twist::zero(); 2]; topology.closures.len()],
        }
    }

    /// Solves at a state. Bodies that the direction does not reach stay zero.
    fn solve(&mut self, topology: &Topology, state: &mut State<T>) {
        // W_u, S_u by (11), and z_u = Ad(X) e_u by (8)
        self.direct.solve_position(topology, state, &self.field);
        for m in self.field.links.iter().filter(|m| m.end == 0) {
            self.links[m.at.0] = state.pose[m.body].carry(m.e);
        }
        for m in &self.field.closures {
            self.closures[m.at.0][m.end] = state.pose[m.body].carry(m.e);
        }
    }

    /// The design twists of the bodies.
    fn w(&self) -> &[Twist<T>] {
        &self.direct.flow.twists[0]
    }

    /// The twist of the frame that the freedoms of link k start from.
    fn start(&self, topology: &Topology, k: LinkId) -> Twist<T> {
        self.w()[topology[k].parent.0] + self.links[k.0]
    }

    /// Rates of the markers of a closure.
    fn ends(&self, topology: &Topology, c: ClosureId) -> MarkerPairRates<T> {
        let ([i, j], [z_i, z_j], none) = (topology[c].bodies, self.closures[c.0], Twist::zero());
        // D_w = W_w + z_w, in place of V; second rates are not requested
        MarkerPairRates { v_i: self.w()[i.0] + z_i, v_j: self.w()[j.0] + z_j, a_i: none, a_j: none }
    }
}

/// Two directions, with the derivative along the second of the design velocity along the first.
#[derive(Clone, Debug)]
struct Pair<T> {
    of: [usize; 2],
    field: PlanVelocity<Dual<T>>,
    /// Per marker that the field moves at a link, then at a closure: its body-fixed twist, and the derivative of that.
    links: Vec<[Twist<T>; 2]>,
    closures: Vec<[Twist<T>; 2]>,
    /// Derivatives of these markers' design twists of the first direction along the second, links first.
    z: Vec<Twist<T>>,
    /// Per driver whose law changes along the first direction: its laws at small steps along the second, forward and
    /// back.
    laws: Vec<(DriverId, [Law; 2])>,
    /// Contribution to the driver's value, at the times set last.
    law_rates: Vec<(DriverId, f64)>,
    /// Derivatives along the second direction of the design twists along the first.
    w: Vec<Twist<T>>,
}

/// The variables' values, each with its rate along a direction.
fn along_direction<T: Real>(values: &[T], direction: &PairDirection) -> Vec<Dual<T>> {
    let speeds = direction.speeds().iter().copied().chain(std::iter::repeat(0.0));
    values.iter().zip(speeds).map(|(v, d)| Dual { v: *v, d: T::constant(d) }).collect()
}

/// Laws of all drivers at a small step along the direction of these values, forward and back.
pub(crate) fn laws_beside(design_map: &DesignMap<'_>, values: &[Dual]) -> [Vec<Law>; 2] {
    number::both([LAW_STEP, -LAW_STEP], |h| {
        // b + h w and b - h w
        let moved: Vec<f64> = values.iter().map(|x| x.v + h * x.d).collect();
        design_map.laws(&moved)
    })
}

/// Second derivatives by pairs of directions.
pub(crate) struct Seconds<T = f64> {
    firsts: Vec<FirstOrder<T>>,
    pairs: Vec<Pair<T>>,
    /// Per coordinate and row: the derivatives of unit twists and wrenches along a direction.
    x: Vec<Twist<T>>,
    l: Vec<Wrench<T>>,
}

impl Seconds {
    /// Second derivatives for these pairs of directions, at the design with these values. These openings follow the
    /// directions, if there are any.
    pub fn new(
        design_map: &DesignMap<'_>,
        topology: &Topology,
        values: &[f64],
        (directions, openings): (&[PairDirection], &[DriverId]),
        pairs: &[[usize; 2]],
    ) -> Self {
        let field =
            |d: &PairDirection| d.field(design_map, values).with_laws_in_order().with_openings(openings);
        let fields: Vec<DesignVelocity> = directions.iter().map(field).collect();
        let pair = |&[u, w]: &[usize; 2]| {
            // b + eps w with eps^2 = 0: e_u + eps de_u/dw, L_u + eps L_uw, and the same of the laws' parameters
            let moving = along_direction(values, &directions[w]);
            let field = directions[u].field(design_map, &moving);
            let laws = laws_beside(design_map, &moving);
            Pair::new(design_map.model(), topology, ([u, w], &field), Some(laws))
        };
        let pairs = pairs.iter().map(pair).collect();
        Self::of_fields(design_map.model(), topology, &fields, pairs)
    }

    /// Sets the rates of the openings along a direction.
    pub fn set_openings(&mut self, direction: usize, rates: &[f64]) {
        self.firsts[direction].field.set_last_shifts(rates);
    }

    /// Solves all pairs at the position of a mechanism and time t.
    pub fn solve(&mut self, mechanism: &mut Mechanism<'_>, t: f64) {
        let (topology, state, parts) = (&mechanism.topology, &mut mechanism.state, &mechanism.parts);
        self.firsts.iter_mut().for_each(|first| first.field.set_time(|d| parts.law_of(d.0), t));
        self.pairs.iter_mut().for_each(|pair| pair.set_time(t));
        self.solve_at(topology, state);
    }

    /// Defects of the redundant rows along a single direction, at the position of the last [`solve`](Self::solve);
    /// empty if the mechanism follows it.
    pub fn resistance(&self, mechanism: &Mechanism<'_>, direction: usize) -> Vec<(RowId, f64)> {
        let (topology, state) = (&mechanism.topology, &mechanism.state);
        let FirstOrder { field, direct, .. } = &self.firsts[direction];
        match direct.worst_defect(topology, state, field) {
            Some(_) => direct.defects(topology, state, field).collect(),
            None => Vec::new(),
        }
    }

    /// Second derivatives of a body's position by pair p.
    pub fn curvature(&self, state: &State<f64>, p: usize, body: usize) -> BodyCurvature {
        let pair = &self.pairs[p];
        BodyCurvature::of(
            state.pose[body].r,
            number::both(pair.of, |k| self.firsts[k].w()[body]),
            pair.w[body],
        )
    }
}

impl Seconds<Number> {
    /// Second derivatives for these pairs of directions, for recording; `None` if a law changes, because programs do
    /// not support that.
    pub fn recorded(
        design_map: &DesignMap<'_>,
        topology: &Topology,
        values: &[Number],
        directions: &[PairDirection],
        pairs: &[[usize; 2]],
    ) -> Option<Self> {
        let fields: Vec<_> =
            recording::strictly(|| directions.iter().map(|d| d.field(design_map, values)).collect());
        let pair = |&[u, w]: &[usize; 2]| {
            let moving = along_direction(values, &directions[w]);
            let field = recording::strictly(|| directions[u].field(design_map, &moving));
            Pair::new(design_map.model(), topology, ([u, w], &field), None)
        };
        let pairs = pairs.iter().map(pair).collect();
        let mut seconds = Self::of_fields(design_map.model(), topology, &fields, pairs);
        seconds.firsts.iter_mut().for_each(|first| first.field.set_shifts());
        seconds.firsts.iter().all(|first| first.field.is_constant()).then_some(seconds)
    }
}

/// Adds the unit directions of the first `variables` design variables; returns the pairs of each of the directions
/// before with each of these.
pub(crate) fn pair_with_variables(
    model: &Model,
    directions: &mut Vec<PairDirection>,
    variables: usize,
) -> Vec<[usize; 2]> {
    let first = directions.len();
    let variables = (0..variables).map(VariableId);
    directions.extend(variables.clone().map(|v| PairDirection::Design(model.alone(v, 1.0))));
    variables.flat_map(|v| (0..first).map(move |d| [d, first + v.0])).collect()
}

/// Design values with the derivative by variable `by`, if there is one, in `v.d`.
pub(crate) fn values_along_variable<T: Real>(values: &[T], by: usize) -> Vec<Dual<Dual<T>>> {
    let along = |k: usize| if k == by { T::one() } else { T::zero() };
    values.iter().enumerate().map(|(k, v)| Dual::constant(Dual { v: *v, d: along(k) })).collect()
}

impl<T: Real> Seconds<T> {
    /// Sets the poses of these bodies per direction, with their derivatives along it and by variable `by`, if there is
    /// one; the pairs are those of [`pair_with_variables`].
    pub fn set_poses(
        &self,
        state: &State<T>,
        by: usize,
        bodies: &[usize],
        poses: &mut [Vec<Pose<Dual<Dual<T>>>>],
    ) {
        let directions = poses.len();
        for (direction, poses) in poses.iter_mut().enumerate() {
            let pair = by * directions + direction;
            for &body in bodies {
                // X + eps_q X_q + eps_b X_b + eps_q eps_b X_qb
                poses[body] = if pair < self.pairs.len() {
                    self.pose(state, pair, body)
                } else {
                    self.pose_along(state, direction, body)
                };
            }
        }
    }

    fn of_fields(
        model: &Model,
        topology: &Topology,
        fields: &[DesignVelocity<T>],
        pairs: Vec<Pair<T>>,
    ) -> Self {
        let first = |field| FirstOrder::new(model, topology, PlanVelocity::new(topology, field));
        Self {
            firsts: fields.iter().map(first).collect(),
            pairs,
            x: vec![Twist::zero(); topology.coordinates.len()],
            l: vec![Wrench::zero(); topology.rows.len()],
        }
    }

    /// Solves all pairs at a state; the contributions of laws must be set.
    pub fn solve_at(&mut self, topology: &Topology, state: &mut State<T>) {
        for first in &mut self.firsts {
            // Every direction by itself (11); then every pair with the results of its directions (15).
            first.solve(topology, state);
        }
        // Derivatives along a direction, in the place of those along the time.
        std::mem::swap(&mut self.x, &mut state.x[1]);
        std::mem::swap(&mut self.l, &mut state.l[1]);
        for pair in &mut self.pairs {
            pair.solve(topology, state, &mut self.firsts);
        }
        std::mem::swap(&mut self.x, &mut state.x[1]);
        std::mem::swap(&mut self.l, &mut state.l[1]);
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// A body's pose, and its derivatives along the directions of pair p: `v.d` along the second, `d.v` along
    /// the first, `d.d` along both.
    pub fn pose(&self, state: &State<T>, p: usize, body: usize) -> Pose<Dual<Dual<T>>> {
        let pair = &self.pairs[p];
        let [u, w] = number::both(pair.of, |k| self.firsts[k].w()[body]);
        // X_w = W_w X,  X_u = W_u X,  X_uw = W_uw X + W_u X_w: the twist along u changes along w by W_uw        (16)
        state.pose[body].along(w).along(u.with_derivative(pair.w[body]))
    }

    /// Pose of a body with its derivative along one direction in `d.v`.
    pub fn pose_along(&self, state: &State<T>, direction: usize, body: usize) -> Pose<Dual<Dual<T>>> {
        let u = self.firsts[direction].w()[body];
        state.pose[body].along(Twist::zero()).along(u.with_derivative(Twist::zero()))
    }
}

/// Body-fixed twist of a moving marker, and its derivative.
fn parts<T: Real, At>(m: &MovingMarker<Dual<T>, At>) -> [Twist<T>; 2] {
    let part = |part: fn(Dual<T>) -> T| Twist { w: m.e.w.map(part), v: m.e.v.map(part) };
    [part(|x| x.v), part(|x| x.d)]
}

/// Returns the variables with a nonzero entry in a direction of the design space, with that entry.
pub(crate) fn along(direction: &[f64]) -> Vec<(VariableId, f64)> {
    let all = direction.iter().enumerate().map(|(k, d)| (VariableId(k), *d));
    all.filter(|(_, d)| *d != 0.0).collect()
}

impl<T: Real> Pair<T> {
    /// Pair of two directions, with the field of the first along the second. `laws` are those of all drivers at small
    /// steps along the second, forward and back, if any may change.
    fn new(
        model: &Model,
        topology: &Topology,
        (of, field): ([usize; 2], &DesignVelocity<Dual<T>>),
        laws: Option<[Vec<Law>; 2]>,
    ) -> Self {
        let field = PlanVelocity::new(topology, field);
        let drivers: Vec<DriverId> = field.drivers().collect();
        Self {
            of,
            links: field.links.iter().map(parts).collect(),
            closures: field.closures.iter().map(parts).collect(),
            z: Vec::with_capacity(field.links.len() + field.closures.len()),
            laws: laws.map_or_else(Vec::new, |laws| {
                let of_driver = |d: &DriverId| (*d, number::both([0, 1], |way| laws[way][d.0].clone()));
                drivers.iter().map(of_driver).collect()
            }),
            law_rates: drivers.iter().map(|d| (*d, 0.0)).collect(),
            field,
            w: vec![Twist::zero(); model.bodies.len()],
        }
    }

    /// Sets the second derivatives of the laws at time t.
    fn set_time(&mut self, t: f64) {
        let Self { field, laws, law_rates, .. } = self;
        for ((driver, [ahead, behind]), (_, out)) in laws.iter().zip(law_rates) {
            *out = field.law_curvature(*driver, [ahead, behind], t);
        }
    }

    fn law_rate(&self, driver: DriverId) -> T {
        let of_driver = self.law_rates.iter().find(|(d, _)| *d == driver);
        of_driver.map_or(T::zero(), |(_, rate)| T::constant(*rate))
    }

    /// Solves (24) of `docs/theory.md` with n = 1, but differentiated along w: the results along u are known; the
    /// unknowns are `W_uw` and `S_uw` (15).
    fn solve(&mut self, topology: &Topology, state: &mut State<T>, firsts: &mut [FirstOrder<T>]) {
        let ([u, w], reach) = (self.of, &self.field.reach);
        let first = &firsts[w];
        let in_blocks = reach.blocks.iter().flat_map(|&b| topology[b].link_ids());
        let links = reach.driven_links.iter().copied().chain(in_blocks);
        // x^w = ad(W_w + z_w + sum over the freedoms before) x, and l^w for markers that move with D_w
        for k in links.clone() {
            let v = [first.start(topology, k)];
            turn_twists(&topology[k], v, &mut state.x, &first.direct.flow.speeds);
        }
        for &c in &reach.closures {
            let (closure, mut rates) = (&topology[c], first.ends(topology, c));
            if let Some(k) = closure.contact {
                rates = state.walk(c, k, &rates);
            }
            for (r, row) in closure.numbered_rows() {
                [state.l[1][r.0], _] = row.wrench_rates(&state.ends[c.0], &rates);
            }
        }
        // z_u^w = ad(W_w) z_u + Ad(X) de_u/dw
        let carried = |body: usize, [e, de]: [Twist<T>; 2]| {
            let pose = state.pose[body];
            first.w()[body].ad(pose.carry(e)) + pose.carry(de)
        };
        self.z.clear();
        self.z.extend(self.field.links.iter().zip(&self.links).map(|(m, e)| carried(m.body, *e)));
        self.z.extend(self.field.closures.iter().zip(&self.closures).map(|(m, e)| carried(m.body, *e)));
        let (z_links, z_closures) = self.z.split_at(self.links.len());
        let flow = &mut firsts[u].direct.flow;
        for k in links {
            flow.moves[1][k.0] = Twist::zero();
            for c in topology[k].coordinates() {
                if let SetBy::Driver(d) = topology[c].set_by {
                    // S_uw of a driven coordinate
                    flow.speeds[1][c.0] = self.law_rate(d);
                }
            }
        }
        for (m, &z) in self.field.links.iter().zip(z_links) {
            flow.move_link(1, (m.at, m.end), z);
        }
        for &c in &reach.closures {
            // rhs = L_uw - l^w . (D_u,j - D_u,i) - l . (z_u,j^w - z_u,i^w), the middle by `Flow::solve`            (15)
            flow.ask(topology, c, topology[c].driver.map_or(T::zero(), |d| self.law_rate(d)));
        }
        for (m, &z) in self.field.closures.iter().zip(z_closures) {
            flow.move_end(topology, (m.at, m.end), z, &state.l[0]);
        }
        for &(row, rate) in &self.field.kept {
            // L_uw
            flow.demand[row.0] += rate.d;
        }
        flow.follow::<1>(topology, reach.driven_links.iter().copied(), &state.x);
        for &b in &reach.blocks {
            flow.solve::<1>(topology, b, state.linear());
        }
        reach.bodies.iter().for_each(|&b| self.w[b] = flow.twists[1][b]);
    }
}

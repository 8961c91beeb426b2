//! Second design derivatives of positions: one more solution with the factors at hand for every pair of directions.
//!
//! The first-order condition of every row, `l . D_u = L_u`, holds in the design that a second direction w leads to as well;
//! differentiated along w it is a level like all others (`docs/theory.md` (15)).

use crate::constraint::EndRates;
use crate::law::Law;
use crate::model::{DriverId, Effects, Field, Model};
use crate::motion::kinematics::{State, carry, level, sum_couplers};
use crate::motion::stepper::Stepper;
use crate::number::{Dual, Real};
use crate::space::{Mat3, Pose, Twist, Vec3};
use crate::topology::{Source, Topology};

use super::direct::{Direct, FieldParts, Moving};

/// A way to go.
#[derive(Clone, Debug, PartialEq)]
pub enum Way {
    /// The design changes: how fast each variable goes.
    Design(Vec<f64>),
    /// The design stays, and one driver moves by one unit per unit while the others stand.
    Driver(DriverId),
}

impl Way {
    /// How fast the design variables go.
    fn speeds(&self) -> &[f64] {
        match self {
            Self::Design(speeds) => speeds,
            Self::Driver(_) => &[],
        }
    }

    /// What it changes at the designs with these values.
    fn field<T: Real>(&self, effects: &Effects<'_>, values: &[T]) -> Field<T> {
        match self {
            Self::Design(speeds) => effects.field_along(&along(speeds), values),
            Self::Driver(driver) => Field::of_driver(*driver),
        }
    }
}

/// Second derivatives of one body's position by two directions, global components, at fixed t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyCurvature {
    /// Of the position of its frame's origin.
    pub d2r: Vec3,
    /// Derivative along the second direction of dpi, the rotation vector rate along the first: not symmetric, since
    /// rotations do not commute.
    pub ddpi: Vec3,
}

/// What one direction does at one position, to first order.
#[derive(Clone, Debug)]
struct First {
    field: FieldParts<f64>,
    /// Design twists of the bodies.
    w: Vec<Twist>,
    /// Speeds of the coordinates.
    s: Vec<f64>,
    /// Per link, the design twists of its markers, the parent's first; per closure, those of markers i and j.
    links: Vec<[Twist; 2]>,
    closures: Vec<[Twist; 2]>,
}

impl First {
    fn new(model: &Model, topology: &Topology, field: FieldParts<f64>) -> Self {
        let none = Twist::zero();
        Self {
            field,
            w: vec![none; model.bodies.len()],
            s: vec![0.0; topology.coordinates.len()],
            links: vec![[none; 2]; topology.links.len()],
            closures: vec![[none; 2]; topology.closures.len()],
        }
    }

    /// Takes over what was just solved. What the direction does not reach stays zero.
    fn keep(&mut self, direct: &Direct<f64>, topology: &Topology, state: &State<f64>) {
        let reach = &self.field.reach;
        reach.bodies.iter().for_each(|&b| self.w[b] = direct.w[0][b]);
        let links = reach.blocks.iter().flat_map(|&b| topology.blocks[b].links.clone());
        for c in links.chain(reach.driven_links.iter().copied()).flat_map(|k| topology.links[k].coordinates())
        {
            self.s[c] = direct.s[0][c];
        }
        for m in &self.field.links {
            self.links[m.at][m.end] = state.pose[m.body].carry(m.e);
        }
        for m in &self.field.closures {
            self.closures[m.at][m.end] = state.pose[m.body].carry(m.e);
        }
    }

    /// The design twists of the markers of a closure.
    fn ends(&self, topology: &Topology, c: usize) -> [Twist; 2] {
        let ([i, j], [z_i, z_j]) = (topology.closures[c].bodies, self.closures[c]);
        [self.w[i.0] + z_i, self.w[j.0] + z_j]
    }
}

/// Two directions, and how the design changes along the first while it goes along the second.
#[derive(Clone, Debug)]
struct Pair {
    of: [usize; 2],
    field: FieldParts<Dual>,
    /// Per marker that the field moves at a link, then at a closure: its body-fixed twist, and the derivative of that.
    links: Vec<[Twist; 2]>,
    closures: Vec<[Twist; 2]>,
    /// By driver whose law changes along the first direction: its laws a little along the second, and back.
    laws: Vec<(DriverId, [Law; 2])>,
    /// What that makes of the driver's value, at the times set last.
    law_rates: Vec<(DriverId, f64)>,
    /// Derivatives along the second direction of the design twists along the first.
    w: Vec<Twist>,
}

/// Laws know their derivatives by a parameter exactly; second derivatives are differences of these over this part of a
/// parameter's unit, whose error is its square.
const LAW_STEP: f64 = 1e-4;

/// Second derivatives by pairs of directions.
pub(crate) struct Seconds {
    firsts: Vec<First>,
    pairs: Vec<Pair>,
    direct: Direct<f64>,
    s: Vec<f64>,
    bias: Vec<Twist>,
    row_rhs: Vec<f64>,
}

impl Seconds {
    /// For these pairs of directions at the design with these values.
    pub fn new(
        effects: &Effects<'_>,
        topology: &Topology,
        values: &[f64],
        directions: &[Way],
        pairs: &[[usize; 2]],
    ) -> Self {
        let model = effects.model;
        let firsts = directions.iter().map(|d| {
            let field = d.field(effects, values);
            First::new(model, topology, FieldParts::new(topology, &field.with_laws_in_order()))
        });
        let pair = |&[u, w]: &[usize; 2]| {
            let speeds = directions[w].speeds().iter().copied().chain(std::iter::repeat(0.0));
            let moving: Vec<Dual> = values.iter().zip(speeds).map(|(v, d)| Dual { v: *v, d }).collect();
            let field = directions[u].field(effects, &moving);
            let field = FieldParts::new(topology, &field);
            let twists = |of: &[Moving<Dual>]| {
                let part =
                    |e: Twist<Dual>, part: fn(Dual) -> f64| Twist { w: e.w.map(part), v: e.v.map(part) };
                of.iter().map(|m| [part(m.e, |x| x.v), part(m.e, |x| x.d)]).collect()
            };
            let laws = [LAW_STEP, -LAW_STEP].map(|h| {
                let moved: Vec<f64> = moving.iter().map(|x| x.v + h * x.d).collect();
                effects.laws(&moved)
            });
            let of_driver = |d: &DriverId| (*d, [laws[0][d.0].clone(), laws[1][d.0].clone()]);
            let drivers: Vec<DriverId> = field.drivers().collect();
            Pair {
                of: [u, w],
                links: twists(&field.links),
                closures: twists(&field.closures),
                laws: drivers.iter().map(of_driver).collect(),
                law_rates: drivers.iter().map(|d| (*d, 0.0)).collect(),
                field,
                w: vec![Twist::zero(); model.bodies.len()],
            }
        };
        Self {
            firsts: firsts.collect(),
            pairs: pairs.iter().map(pair).collect(),
            direct: Direct::new(model, topology),
            s: vec![0.0; topology.coordinates.len()],
            bias: vec![Twist::zero(); topology.links.len()],
            row_rhs: vec![0.0; topology.rows.len()],
        }
    }

    /// Solves all pairs where a stepper stands, at time t.
    pub fn solve(&mut self, stepper: &mut Stepper<'_>, t: f64) {
        let (topology, state, parts) = (&stepper.topology, &mut stepper.state, &stepper.parts);
        for first in &mut self.firsts {
            first.field.set_time(|d| parts.law_of(d.0), t);
            self.direct.solve_position(topology, state, &first.field);
            first.keep(&self.direct, topology, state);
        }
        for pair in &mut self.pairs {
            pair.set_time(t);
            let [u, w] = pair.of.map(|k| &self.firsts[k]);
            let scratch = (&mut self.s, &mut self.bias, &mut self.row_rhs);
            solve_pair(topology, state, pair, u, w, scratch);
        }
    }

    /// How many pairs there are.
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// A body's pose, and its derivatives along the directions of pair p: `v.d` along the second, `d.v` along
    /// the first, `d.d` along both.
    pub fn pose(&self, state: &State<f64>, p: usize, body: usize) -> Pose<Dual<Dual>> {
        let pair = &self.pairs[p];
        let [u, w] = pair.of.map(|k| self.firsts[k].w[body]);
        with_twists(state.pose[body], u, w, pair.w[body])
    }

    /// The same for one direction alone: `d.v` along it, and nothing along a second.
    pub fn pose_along(&self, state: &State<f64>, direction: usize, body: usize) -> Pose<Dual<Dual>> {
        let u = self.firsts[direction].w[body];
        with_twists(state.pose[body], u, Twist::ZERO, Twist::ZERO)
    }

    /// Second derivatives of a body's position by pair p.
    pub fn curvature(&self, state: &State<f64>, p: usize, body: usize) -> BodyCurvature {
        let pair = &self.pairs[p];
        let [u, w] = pair.of.map(|k| self.firsts[k].w[body]);
        let (r, uw) = (state.pose[body].r, pair.w[body]);
        BodyCurvature { d2r: uw.at(r) + u.w.cross(w.at(r)), ddpi: uw.w }
    }
}

/// The variables that a direction changes, and how fast.
pub(crate) fn along(direction: &[f64]) -> Vec<(crate::model::VariableId, f64)> {
    let all = direction.iter().enumerate().map(|(k, d)| (crate::model::VariableId(k), *d));
    all.filter(|(_, d)| *d != 0.0).collect()
}

/// A pose with its derivatives: by the twists along u, along w, and the derivative along w of that along u.
fn with_twists(Pose { rot, r }: Pose, u: Twist, w: Twist, uw: Twist) -> Pose<Dual<Dual>> {
    let (r_u, r_w) = (u.at(r), w.at(r));
    let column = |e: Vec3| {
        let (e_u, e_w) = (u.w.cross(e), w.w.cross(e));
        number([e, e_u, e_w, uw.w.cross(e) + u.w.cross(e_w)])
    };
    Pose { rot: Mat3 { cols: rot.cols.map(column) }, r: number([r, r_u, r_w, uw.at(r) + u.w.cross(r_w)]) }
}

/// A vector with its derivatives along u, along w, and along both.
fn number([v, u, w, uw]: [Vec3; 4]) -> Vec3<Dual<Dual>> {
    let component = |v, u, w, uw| Dual { v: Dual { v, d: w }, d: Dual { v: u, d: uw } };
    Vec3::new(component(v.x, u.x, w.x, uw.x), component(v.y, u.y, w.y, uw.y), component(v.z, u.z, w.z, uw.z))
}

impl Pair {
    /// Differences of the laws' exact derivatives.
    fn set_time(&mut self, t: f64) {
        let Self { field, laws, law_rates, .. } = self;
        for ((driver, [ahead, behind]), (_, out)) in laws.iter().zip(law_rates) {
            let rate = |law: &Law| field.law_speed(*driver, law, t);
            *out = (rate(ahead) - rate(behind)) / (2.0 * LAW_STEP);
        }
    }

    fn law_rate(&self, driver: DriverId, zero: f64) -> f64 {
        self.law_rates.iter().find(|(d, _)| *d == driver).map_or(zero, |(_, rate)| *rate)
    }
}

/// `docs/theory.md` (15).
fn solve_pair(
    topology: &Topology,
    state: &mut State<f64>,
    pair: &mut Pair,
    u: &First,
    w: &First,
    (s, bias, row_rhs): (&mut Vec<f64>, &mut Vec<Twist>, &mut Vec<f64>),
) {
    let (none, zero) = (Twist::zero(), 0.0);
    // A marker's design twist along u, carried along w by its body, and changed by the design itself.
    let carried = |state: &State<f64>, body: usize, [e, de]: [Twist; 2]| {
        let pose = state.pose[body];
        w.w[body].ad(pose.carry(e)) + pose.carry(de)
    };
    let reach = &pair.field.reach;
    let in_blocks = reach.blocks.iter().flat_map(|&b| topology.blocks[b].links.clone());
    for k in reach.driven_links.iter().copied().chain(in_blocks) {
        let link = &topology.links[k];
        let mut sum = none;
        let mut carrier = w.w[link.parent.0] + w.links[k][0];
        for step in &link.steps {
            let coordinates = step.first..step.first + step.freedom.coordinates();
            for c in coordinates.clone() {
                sum = carrier.ad(state.x[c]).times_plus(u.s[c], sum);
            }
            for c in coordinates {
                carrier = state.x[c].times_plus(w.s[c], carrier);
                if let Source::Driven(d) = topology.coordinates[c].source {
                    s[c] = pair.law_rate(d, zero);
                }
            }
        }
        bias[k] = sum;
    }
    for (m, e) in pair.field.links.iter().zip(&pair.links) {
        let z = carried(state, m.body, *e);
        bias[m.at] += if m.end == 0 { z } else { -z };
    }
    for &c in &reach.closures {
        let closure = &topology.closures[c];
        let ([u_i, u_j], [w_i, w_j]) = (u.ends(topology, c), w.ends(topology, c));
        let mut rates = EndRates { v_i: w_i, v_j: w_j, a_i: none, a_j: none };
        if let Some(k) = closure.contact {
            rates = state.walk(c, k, &rates);
        }
        let driven = closure.driver.map_or(zero, |d| pair.law_rate(d, zero));
        for (n, row) in closure.rows.iter().enumerate() {
            let r = closure.first_row + n;
            if topology.rows[r].drives() {
                let [l_w, _] = row.wrench_rates(&state.ends[c], &rates);
                row_rhs[r] = driven - l_w.on(u_j - u_i);
            }
        }
    }
    for (m, e) in pair.field.closures.iter().zip(&pair.closures) {
        let z = carried(state, m.body, *e);
        let closure = &topology.closures[m.at];
        for r in closure.first_row..closure.first_row + closure.rows.len() {
            if topology.rows[r].drives() {
                row_rhs[r] += state.l[r].on(if m.end == 1 { -z } else { z });
            }
        }
    }
    for &(row, rate) in &pair.field.kept {
        row_rhs[row] += rate.d;
    }
    reach.blocks.iter().for_each(|&b| sum_couplers(topology, b, row_rhs));
    let (x, out, bias) = (&state.x, &mut pair.w, Some(&bias[..]));
    carry(topology, reach.driven_links.iter().copied(), x, bias, s, out, |_| true);
    for &b in &reach.blocks {
        level(topology, b, &mut state.factors, x, &state.l, bias, row_rhs, s, out, &mut state.rhs);
    }
}

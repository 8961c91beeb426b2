//! Adjoint method, for sensitivities of a few outputs by many variables: one transposed solution per output instead of
//! one per variable.
//!
//! The derivatives of an output by the design twists of the bodies are loads on them, a wrench each. Propagated to
//! ground like loads in statics, they give the wrench that every joint transmits. Its work on the design twists of the
//! joint's markers is the derivative of the output. Transmitted wrenches do not depend on the variables
//! (`docs/theory.md` (17) to (20)).
//!
//! | here | theory | meaning |
//! |---|---|---|
//! | `transmission` | F, T, mu and their rates | propagation to ground: `transmission.rs` |
//! | `seen` | t, t., t.. | T in body components of a marker's body (20) |
//! | `gradient[v][n]` | dy/db, d(y.)/db, d(y..)/db | (19) and its time derivatives |

use crate::design::DesignVelocity;
use crate::model::{DriverId, GROUND, Model};
use crate::motion::kinematics::State;
use crate::motion::level::BINOMIAL;
use crate::motion::mechanism::{LOCKED, Mechanism};
use crate::order::sort_by_index;
use crate::space::{Real, Twist, Wrench};
use crate::topology::{BlockId, ClosureId, CoordinateId, LinkId, RowId, RowTerm, Topology};

use super::direct::{DEFECT_FLOOR, Defect, PlanVelocity};
use super::solver::{Resistance, note};
use super::transmission::{Transmission, Transposed, Way};
use super::turning::Turning;

/// A wrench with its first two time derivatives, about the world origin.
pub(crate) type Load = [Wrench; 3];

/// Support of loads on some bodies: the bodies from there to ground, and the variables that change something between
/// them.
#[derive(Clone, Debug)]
pub(crate) struct Support {
    /// Bodies that the load reaches.
    bodies: Vec<usize>,
    /// Path from the load to ground.
    way: Way,
    /// Markers that some variable moves.
    places: Vec<MarkerPlace>,
    /// Per variable and marker that it moves: place, and body-fixed twist with the sign of that end.
    moves: Vec<(usize, usize, Twist)>,
    /// Per variable and joint constant that it changes: row and rate.
    keeps: Vec<(usize, RowId, f64)>,
    /// Per variable and law that it changes: the driver, and the unknown that it prescribes.
    laws: Vec<(usize, DriverId, Follower)>,
}

/// A marker on a body.
#[derive(Clone, Copy, Debug)]
struct MarkerPlace {
    /// Number in [`Adjoint::seen`].
    index: usize,
    joint: Transmitter,
    body: usize,
}

/// A joint that transmits a wrench.
#[derive(Clone, Copy, Debug)]
enum Transmitter {
    Link(LinkId),
    Closure(ClosureId),
}

/// The unknown that a driver prescribes.
#[derive(Clone, Copy, Debug)]
enum Follower {
    Coordinate(CoordinateId),
    Row(RowId),
}

impl Support {
    /// Support of loads on these bodies; `fields` are those of all variables.
    fn new(topology: &Topology, fields: &[PlanVelocity<f64>], loaded: &[usize]) -> Self {
        let mut pushed = vec![false; 1 + topology.links.iter().map(|l| l.child.0).max().unwrap_or(0)];
        loaded.iter().for_each(|&b| pushed[b] = true);
        // From the last block to the first: a load on a child is transmitted by its link to the parent, and by the
        // block's closures to all bodies that they connect.
        let (mut blocks, mut driven_links) = (Vec::new(), Vec::new());
        let mut feels = (vec![false; topology.links.len()], vec![false; topology.closures.len()]);
        for (b, block) in BlockId::each(&topology.blocks).rev() {
            if block.link_ids().any(|k| pushed[topology[k].child.0]) {
                blocks.push(b);
                for &c in &block.closures {
                    feels.1[c.0] = true;
                    // +- T_c on both of its bodies
                    topology[c].bodies.iter().for_each(|b| pushed[b.0] = true);
                }
                for k in block.link_ids().rev() {
                    feels.0[k.0] = true;
                    // T_k goes on to the parent
                    pushed[topology[k].child.0] = true;
                    pushed[topology[k].parent.0] = true;
                }
            }
        }
        for k in topology.driven_links().rev() {
            if pushed[topology[k].child.0] {
                feels.0[k.0] = true;
                driven_links.push(k);
                pushed[topology[k].parent.0] = true;
            }
        }
        let bodies = (0..pushed.len()).filter(|&b| pushed[b]).collect();
        let (places, moves, keeps, laws) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut support = Self { bodies, way: Way { blocks, driven_links }, places, moves, keeps, laws };
        for (v, field) in fields.iter().enumerate() {
            support.add(topology, &feels, v, field);
        }
        sort_by_index(&mut support.places, |p| p.index);
        support.places.dedup_by_key(|p| p.index);
        support
    }

    /// Adds the changes by variable v at links and closures that transmit the load.
    fn add(
        &mut self,
        topology: &Topology,
        (links, closures): &(Vec<bool>, Vec<bool>),
        v: usize,
        field: &PlanVelocity<f64>,
    ) {
        // The wrench of a link acts on its child and does work on z_p - z_c; that of a closure acts on j and does work
        // on z_j - z_i.
        for m in field.links.iter().filter(|m| links[m.at.0]) {
            let index = 2 * m.at.0 + m.end;
            self.places.push(MarkerPlace { index, joint: Transmitter::Link(m.at), body: m.body });
            self.moves.push((v, index, if m.end == 0 { m.e } else { -m.e }));
        }
        for m in field.closures.iter().filter(|m| closures[m.at.0]) {
            let index = 2 * (links.len() + m.at.0) + m.end;
            self.places.push(MarkerPlace { index, joint: Transmitter::Closure(m.at), body: m.body });
            self.moves.push((v, index, if m.end == 1 { m.e } else { -m.e }));
        }
        let kept = field.kept.iter().filter(|(row, _)| closures[topology[*row].closure.0]);
        self.keeps.extend(kept.map(|&(row, rate)| (v, row, rate)));
        for driver in field.drivers() {
            for (c, _) in topology.driven_coordinates().filter(|(_, d)| *d == driver) {
                if links[topology[c].link.0] {
                    // nu_d = T_k . x_a
                    self.laws.push((v, driver, Follower::Coordinate(c)));
                }
            }
            for (c, closure) in ClosureId::each(&topology.closures) {
                if closure.driver == Some(driver) && closures[c.0] {
                    // nu_d = mu_r
                    self.laws.push((v, driver, Follower::Row(closure.first_row)));
                }
            }
        }
    }
}

/// Propagates loads to ground; a step allocates no memory.
pub(crate) struct Adjoint {
    /// Design velocity of each variable.
    fields: Vec<PlanVelocity<f64>>,
    /// Wrenches that are transmitted to ground.
    transmission: Transmission,
    /// Per marker, parent's and child's of the links and then i and j of the closures: the wrench seen from its body.
    seen: Vec<Load>,
}

impl Adjoint {
    /// Adjoint solver for the variables with these fields.
    pub fn new(model: &Model, topology: &Topology, fields: &[DesignVelocity]) -> Self {
        let none = Wrench::zero();
        let parts = |f: &DesignVelocity| PlanVelocity::new(topology, &f.clone().with_laws_in_order());
        Self {
            fields: fields.iter().map(parts).collect(),
            transmission: Transmission::new(model, topology),
            seen: vec![[none; 3]; 2 * (topology.links.len() + topology.closures.len())],
        }
    }

    /// Support of loads on these bodies.
    pub fn support(&self, topology: &Topology, loaded: &[usize]) -> Support {
        Support::new(topology, &self.fields, loaded)
    }

    /// Sets the contributions of laws that depend on variables, at the position of a mechanism and time t.
    pub fn set_time(&mut self, mechanism: &Mechanism<'_>, t: f64) {
        let law = |d: DriverId| mechanism.parts.law_of(d.0);
        self.fields.iter_mut().for_each(|field| field.set_time(law, t));
    }

    /// Adds to `gradient`, per variable, the work of loads on bodies and its time derivatives, `orders` in all. `state`
    /// has all of its rates.
    pub fn add_work(
        &mut self,
        topology: &Topology,
        state: &mut State<f64>,
        support: &Support,
        loads: &[(usize, Load)],
        orders: usize,
        gradient: &mut [[f64; 3]],
    ) {
        for n in 0..orders {
            let load = &mut self.transmission.load[n];
            support.bodies.iter().for_each(|&b| load[b] = Wrench::zero());
            loads.iter().for_each(|(b, load_on)| load[*b] += load_on[n]);
            self.transmission.transmit(topology, Transposed::of(state), &support.way, n);
        }
        self.see(state, support, orders);
        self.work(topology, state, support, orders, gradient);
    }

    /// Adds the functional `sum F . W.. + 2 F. . W. + F.. . W`, whose wrenches need not be rates of each other, with
    /// loads on frames and coordinates, to the third number of each variable in `gradient`.
    pub fn add_turning_work(
        &mut self,
        topology: &Topology,
        state: &mut State<f64>,
        (support, loads): (&Support, &[(usize, Load)]),
        turning: &Turning,
        gradient: &mut [[f64; 3]],
    ) {
        self.transmission.pulls[2].copy_from_slice(&turning.pulls);
        self.add_work(topology, state, support, loads, 3, gradient);
        self.transmission.pulls[2].fill(0.0);
        for (field, gradient) in self.fields.iter().zip(gradient) {
            gradient[2] += field.turning_work(state, turning);
        }
    }

    /// Derivative of a driver's value, speed or acceleration by variable v, at the time that was set.
    pub fn law_rate(&self, v: usize, driver: DriverId, order: usize) -> f64 {
        self.fields[v].law_rate(driver, order)
    }

    /// Computes the wrenches on the markers that variables move, in body components: the twists of the markers are
    /// constant there, and time derivatives are those of the components (`docs/theory.md` (20)).
    fn see(&mut self, state: &State<f64>, support: &Support, orders: usize) {
        let [v, a, _] = &state.motion.twists;
        for place in &support.places {
            let (pose, v, a) = (&state.pose[place.body], v[place.body], a[place.body]);
            let of = |n: usize| match place.joint {
                Transmitter::Link(k) => self.transmission.links[n][k.0],
                Transmitter::Closure(c) => self.transmission.closures[n][c.0],
            };
            let seen = &mut self.seen[place.index];
            // t   = Ad(X)^T T                                                                                     (20)
            seen[0] = pose.carry_back(of(0));
            if orders > 1 {
                // t.  = Ad(X)^T (T. + ad(V)^T T)
                let mut turned = v.ad_transposed(of(0));
                let mut first = of(1);
                first += turned;
                seen[1] = pose.carry_back(first);
                // t.. = Ad(X)^T (T.. + ad(V)^T (2 T. + ad(V)^T T) + ad(A)^T T)
                turned += of(1);
                turned += of(1);
                let mut second = v.ad_transposed(turned);
                second += of(2);
                second += a.ad_transposed(of(0));
                seen[2] = pose.carry_back(second);
            }
        }
    }

    /// Adds the work on design twists: `docs/theory.md` (19).
    fn work(
        &self,
        topology: &Topology,
        state: &State<f64>,
        support: &Support,
        orders: usize,
        gradient: &mut [[f64; 3]],
    ) {
        let Transmission { rows, links, pulls, .. } = &self.transmission;
        // T_k . (z_p - z_c) + T_c . (z_j - z_i): at order n it is t(n) . e, since e is constant
        for &(v, place, e) in &support.moves {
            for n in 0..orders {
                gradient[v][n] += self.seen[place][n].on(e);
            }
        }
        for &(v, row, rate) in &support.keeps {
            for n in 0..orders {
                // mu_r(n) L'_r
                gradient[v][n] += rows[n][row.0] * rate;
            }
        }
        let x = &state.x;
        for &(v, driver, follower) in &support.laws {
            let part = |n: usize| match follower {
                Follower::Row(r) => rows[n][r.0],
                Follower::Coordinate(c) => {
                    let k = topology[c].link;
                    // nu_d(n) = sum_m C(n,m) T_k(m) . x_a(n-m)
                    let term = |m: usize| links[m][k.0].on(x[n - m][c.0]) * BINOMIAL[n][m];
                    (0..=n).map(term).fold(pulls[n][c.0], |sum, x| sum + x)
                }
            };
            for n in 0..orders {
                for m in 0..=n {
                    // (nu_d df_d/dp)(n) = sum_m C(n,m) nu_d(m) df_d(n-m)/dp
                    let rate = self.fields[v].law_rate(driver, n - m);
                    gradient[v][n] += part(m) * rate * BINOMIAL[n][m];
                }
            }
        }
    }
}

/// Monitors the redundant rows, like
/// [`DirectDifferentiation::worst_defect`](super::DirectDifferentiation::worst_defect): each side of each row is a load
/// of its own.
pub(crate) struct DefectWatch {
    /// Per body with such a row: support of loads on it.
    supports: Vec<Option<Support>>,
    /// Per variable: the work on one side, the sum of all terms, and the largest of them.
    side: Vec<[f64; 3]>,
    sum: Vec<f64>,
    most: Vec<f64>,
    /// Per variable: the row with the largest defect.
    worst: Vec<Option<Defect>>,
}

impl DefectWatch {
    pub fn new(model: &Model, variables: usize) -> Self {
        let zero = 0.0;
        Self {
            supports: (0..model.bodies.len()).map(|_| None).collect(),
            side: vec![[zero; 3]; variables],
            sum: vec![zero; variables],
            most: vec![zero; variables],
            worst: vec![None; variables],
        }
    }

    /// Records the joints that resist variables, at the position of a mechanism and time t.
    pub fn look(
        &mut self,
        adjoint: &mut Adjoint,
        topology: &Topology,
        state: &mut State<f64>,
        t: f64,
        resisting: &mut [Resistance],
    ) {
        self.worst.fill(None);
        for r in topology.redundant() {
            self.row(adjoint, topology, state, r);
        }
        for (worst, resisting) in self.worst.iter().zip(resisting) {
            if let Some(defect) = *worst {
                note(resisting, topology, defect, t);
            }
        }
    }

    /// Updates the largest defect with row r.
    fn row(&mut self, adjoint: &mut Adjoint, topology: &Topology, state: &mut State<f64>, r: RowId) {
        let (zero, none) = (0.0, Wrench::zero());
        self.sum.fill(zero);
        self.most.fill(zero);
        for RowTerm { row, factor } in topology.parts_of_row(r) {
            let closure = topology.closure_of(row);
            for (body, sign) in closure.bodies.into_iter().zip([-factor, factor]) {
                if body == GROUND {
                    continue;
                }
                let support =
                    self.supports[body.0].get_or_insert_with(|| adjoint.support(topology, &[body.0]));
                self.side.fill([zero; 3]);
                // l . W_i and l . W_j as outputs: the load F = l on that one body                                  (17)
                let load = [(body.0, [state.l[0][row.0], none, none])];
                adjoint.add_work(topology, state, support, &load, 1, &mut self.side);
                for (v, [term, ..]) in self.side.iter().enumerate() {
                    enter(&mut self.sum[v], &mut self.most[v], *term * sign);
                }
            }
            for (v, field) in adjoint.fields.iter().enumerate() {
                let (sum, most) = (&mut self.sum[v], &mut self.most[v]);
                for m in field.closures.iter().filter(|m| m.at == topology[row].closure) {
                    // l . (z_j - z_i),    z = Ad(X) e                                                               (8)
                    let z = state.l[0][row.0].on(state.pose[m.body].carry(m.e));
                    enter(sum, most, if m.end == 1 { z * factor } else { z * -factor });
                }
                // - (L' + df/dp): the sum of all is the defect of the row in (11)
                let driven = closure.driver.map_or(zero, |d| field.law_rate(d, 0));
                enter(sum, most, -(field.kept_rate(row) + driven) * factor);
            }
        }
        for (v, field) in adjoint.fields.iter().enumerate() {
            let sum = self.sum[v].abs();
            // (30), as in direct differentiation
            let limit = (self.most[v] * LOCKED).larger(field.scale * DEFECT_FLOOR);
            Defect::enter(&mut self.worst[v], r, sum, limit);
        }
    }
}

#[inline(always)]
fn enter(sum: &mut f64, most: &mut f64, term: f64) {
    *sum += term;
    *most = most.larger(term.abs());
}

//! The three levels of one design variable at one step.
//!
//! Names here and in theory (`docs/theory.md`, sections 5 and 6; the paper's sections 3 and 5):
//!
//! | here | theory | paper | what, per unit of the variable b |
//! |---|---|---|---|
//! | `MovingMarker::e` | e | V and R U (3.2, 3.3, 3.10), in `dD/dtau` (5.5) | body-fixed twist of a marker, rad and m |
//! | `z` | z, z., z.. | | the same in the world, with its rates (8) |
//! | `flow.twists[n]` | W, W., W.. | Y (5.3c): `dr/dtau = W_v + W_w x r`, `dpi/dtau = W_w` | design twist of a body |
//! | `flow.speeds[n]` | S, S., S.. | | of each coordinate of the tree |
//! | `flow.apart[n]` | `D_j - D_i`, D = W + z | | between the markers of each closure |
//! | `state.l[n]` | l, l., l.. | a row of `phi_z` (5.3a) and of `phi_D` (5.3b) | wrench of each row |
//! | `kept`, `law_rates` | L', df/dp | in `phi_D dD/dtau` | what a row keeps, and what a driver asks for, change |
//!
//! To a row it is the same whether a body takes its marker along or the marker moves in its body, so one wrench is the
//! row of `phi_z` and of `phi_D`, and the paper's `phi_z Y = -phi_D dD/dtau` (5.6) reads
//!
//! ```text
//! l . (W_j - W_i)  =  L' - l . (z_j - z_i)                                                     docs/theory.md (11)
//! ```

use crate::design::DesignVelocity;
use crate::law::Law;
use crate::model::{DriverId, Model};
use crate::motion::kinematics::State;
use crate::motion::level::{Flow, carried, of_body};
use crate::motion::mechanism::LOCKED;
use crate::number::{self, Dual};
use crate::space::{Real, Twist, Wrench};
use crate::topology::{BlockId, ClosureId, LinkId, RowId, RowTerm, Topology};

use super::turning::Turning;

/// Step of the difference quotients for second derivatives of laws by parameters, in the parameter's unit; first
/// derivatives are exact. The error is proportional to its square.
pub(crate) const LAW_STEP: f64 = 1e-4;

/// Design velocities of one variable laid out for the plan: body-fixed marker twists by link and
/// by closure.
#[derive(Clone, Debug)]
pub(crate) struct PlanVelocity<T> {
    /// e of the markers that move, by link: they shift and turn what the freedoms start from or end in.
    pub(super) links: Vec<MovingMarker<T, LinkId>>,
    /// e of the markers that move, by closure: they open its rows.
    pub(super) closures: Vec<MovingMarker<T, ClosureId>>,
    /// Rows whose kept values change, and their rates.
    /// L', ascending by row: m or a cosine per unit of b.
    pub(super) kept: Vec<(RowId, T)>,
    /// Parameters of drivers' laws that change, and their rates.
    /// dp/db, with driver and parameter.
    laws: Vec<(DriverId, usize, T)>,
    /// Drivers whose values shift, and how fast.
    /// df/db, the same at all times: m or rad per unit of b.
    shifts: Vec<(DriverId, T)>,
    /// Contribution to the driver's value, speed and acceleration at the time that was set last. At orders n = 0, 1, 2:
    /// `sum over p of df(n)/dp dp/db`.
    law_rates: Vec<(DriverId, [T; 3])>,
    /// Largest speed in the field, the reference for round-off of a defect.
    pub(super) scale: T,
    /// Reach of the change.
    pub reach: Influence,
}

/// Reach of a design change: everything else is constant and is not evaluated.
#[derive(Clone, Debug, Default)]
pub(crate) struct Influence {
    /// Links placed by drivers alone, whose children move.
    pub driven_links: Vec<LinkId>,
    /// Blocks with a nonzero right-hand side.
    pub blocks: Vec<BlockId>,
    /// Closures of these blocks, and those between driven bodies.
    pub closures: Vec<ClosureId>,
    /// Bodies that move.
    pub bodies: Vec<usize>,
}

impl Influence {
    /// Reach of changes at these links and closures, and of these drivers.
    fn new(topology: &Topology, links: &[LinkId], closures: &[ClosureId], drivers: &[DriverId]) -> Self {
        let bodies = 1 + topology.links.iter().map(|l| l.child.0).max().unwrap_or(0);
        // A change propagates like motion: a body moves if its parent, its link's marker or its driver does, or if its
        // block has a changed closure. Later blocks in the order of solution have no effect on earlier ones.
        let (mut moves, mut reach) = (vec![false; bodies], Self::default());
        let mut driven = vec![false; topology.links.len()];
        for (c, d) in topology.driven_coordinates() {
            driven[topology[c].link.0] |= drivers.contains(&d);
        }
        let starts = |k: LinkId| links.binary_search(&k).is_ok() || driven[k.0];
        for k in topology.driven_links() {
            let link = &topology[k];
            // W_c = W_p + z_p - z_c + x S, with S = df/dp: anything of it
            if moves[link.parent.0] || starts(k) {
                moves[link.child.0] = true;
                reach.driven_links.push(k);
            }
        }
        let changed = |c: ClosureId, moves: &[bool]| {
            let closure = &topology[c];
            closures.binary_search(&c).is_ok()
                || closure.bodies.iter().any(|b| moves[b.0])
                || closure.driver.is_some_and(|d| drivers.contains(&d))
        };
        for (b, block) in BlockId::each(&topology.blocks) {
            // With any nonzero right-hand side of the block, all of its S may differ from 0.
            let felt = block.closures.iter().any(|&c| changed(c, &moves))
                || block.link_ids().any(|k| moves[topology[k].parent.0] || starts(k));
            if felt {
                reach.blocks.push(b);
                reach.closures.extend(&block.closures);
                block.link_ids().for_each(|k| moves[topology[k].child.0] = true);
            }
        }
        for (c, closure) in ClosureId::each(&topology.closures) {
            if closure.block.is_none() && changed(c, &moves) {
                reach.closures.push(c);
            }
        }
        reach.bodies = (1..bodies).filter(|&b| moves[b]).collect();
        reach
    }
}

/// A marker that some design velocity moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingMarker<T, At> {
    /// Link or closure of the marker.
    pub at: At,
    /// Index of the marker: 0 for the parent's of a link or i of a closure, 1 for the child's or j.
    pub end: usize,
    /// The body that carries it.
    pub body: usize,
    /// Body-fixed twist.
    pub e: Twist<T>,
}

impl<T: Real, At: Copy> MovingMarker<T, At> {
    /// `z = Ad(X) e`, carried by its body: `z. = ad(V) z, z.. = ad(A) z + ad(V) z.` (`docs/theory.md` (8)).
    #[inline(always)]
    fn carried(&self, state: &State<T>) -> [Twist<T>; 3] {
        let [v, a, _] = &state.motion.twists;
        let (v, a) = (v[self.body], a[self.body]);
        // z = Ad(X) e,    z. = ad(V) z,    z.. = ad(A) z + ad(V) z.              (8), with e fixed in the body
        let z0 = state.pose[self.body].carry(self.e);
        let z1 = carried([z0], [v]);
        [z0, z1, carried([z0, z1], [v, a])]
    }
}

impl<T: Real> PlanVelocity<T> {
    pub fn new(topology: &Topology, field: &DesignVelocity<T>) -> Self {
        let (mut links, mut closures, mut kept) = (Vec::new(), Vec::new(), Vec::new());
        for (at, link) in LinkId::each(&topology.links) {
            let Some(joint) = link.joint else { continue };
            for (end, body) in [(0, link.parent.0), (1, link.child.0)] {
                let marker = if end == 0 { link.parent_end } else { 1 - link.parent_end };
                // The link runs from its parent's marker to its child's, whichever of them is the joint's i.
                if let Some(e) = field.twist_of(joint, marker) {
                    links.push(MovingMarker { at, end, body, e });
                }
            }
        }
        for (at, closure) in ClosureId::each(&topology.closures) {
            for (end, body) in closure.bodies.into_iter().enumerate() {
                if let Some(e) = field.twist_of(closure.joint, end) {
                    closures.push(MovingMarker { at, end, body: body.0, e });
                }
            }
            let Some(rates) = field.kept_rate(closure.joint) else { continue };
            for (r, row) in closure.numbered_rows() {
                // L' of this row: `u . (V_j - V_i)` of a rod, or the rate of another constant; 0 for a row without one.
                let rate = rates.by(row);
                // A rate that is zero may have a derivative.
                if !rate.vanishes() {
                    kept.push((r, rate));
                }
            }
        }
        // Rates of markers, joint constants and laws per unit of the variable. Defects of this variable are compared
        // with their maximum, whatever its unit.
        let markers = field.markers.iter().map(|m| m.twist.w.norm().larger(m.twist.v.norm()));
        let kept_rates = field.kept.iter().map(|(_, k)| k.size());
        let laws = field.laws.iter().map(|(.., rate)| rate.abs());
        let shifts = field.shifts.iter().map(|(_, rate)| rate.abs());
        // For a driver it is a single number, so that no comparison is recorded.
        let scale =
            markers.chain(kept_rates).chain(laws).chain(shifts).reduce(T::larger).unwrap_or(T::zero());
        let mut drivers: Vec<DriverId> = field.laws.iter().map(|(d, ..)| *d).collect();
        drivers.extend(field.shifts.iter().map(|(d, _)| *d));
        drivers.sort_unstable();
        drivers.dedup();
        let law_rates = drivers.iter().map(|&d| (d, [T::zero(); 3])).collect();
        let moved: Vec<LinkId> = links.iter().map(|m| m.at).collect();
        let mut changed: Vec<ClosureId> = closures.iter().map(|m| m.at).collect();
        changed.extend(kept.iter().map(|&(row, _)| topology[row].closure));
        changed.sort_unstable();
        let reach = Influence::new(topology, &moved, &changed, &drivers);
        let (laws, shifts) = (field.laws.clone(), field.shifts.clone());
        Self { links, closures, kept, laws, shifts, law_rates, scale, reach }
    }

    /// True if it is the same at all times: no parameter of a law changes.
    pub fn is_constant(&self) -> bool {
        self.laws.is_empty()
    }

    /// Drivers whose laws change.
    pub fn drivers(&self) -> impl Iterator<Item = DriverId> {
        self.law_rates.iter().map(|(d, _)| *d)
    }

    /// Sets the contributions of laws at time t; `law` returns the law of a driver.
    pub fn set_time<'l>(&mut self, law: impl Fn(DriverId) -> &'l Law, t: f64) {
        for (driver, rates) in &mut self.law_rates {
            let mut sums = [0.0; 3];
            for (_, parameter, rate) in self.laws.iter().filter(|(d, ..)| d == driver) {
                let rate = rate.value();
                if rate != 0.0 {
                    let derivatives = law(*driver).derivative(*parameter, t).derivatives();
                    sums.iter_mut().zip(derivatives).for_each(|(sum, d)| *sum += rate * d);
                }
            }
            // df(n)/db = sum over the parameters p of df(n)/dp dp/db, n = 0, 1, 2; a shift has no rates of its own.
            *rates = number::each(&sums, |sum| T::constant(sum));
            for (_, rate) in self.shifts.iter().filter(|(d, _)| d == driver) {
                rates[0] += *rate;
            }
        }
    }

    /// Sets the rates of the drivers that shift last.
    pub fn set_last_shifts(&mut self, rates: &[T]) {
        let first = self.shifts.len() - rates.len();
        self.shifts[first..].iter_mut().zip(rates).for_each(|(shift, rate)| shift.1 = *rate);
    }

    /// Sets the contributions if no law changes: shifts of drivers alone.
    pub fn set_shifts(&mut self) {
        for (driver, rates) in &mut self.law_rates {
            let of_driver = self.shifts.iter().filter(|(d, _)| d == driver);
            rates[0] = of_driver.fold(T::zero(), |sum, (_, rate)| sum + *rate);
        }
    }

    /// Rate of the constant of a row.
    #[inline(always)]
    pub(super) fn kept_rate(&self, row: RowId) -> T {
        let found = self.kept.binary_search_by_key(&row, |kept| kept.0);
        found.map_or(T::zero(), |n| self.kept[n].1)
    }

    /// Work of loads on the frames that unit twists and wrenches rotate with, on the markers that move within their
    /// bodies.
    pub(super) fn turning_work(&self, state: &State<T>, turning: &Turning<T>) -> T {
        let starts = self.links.iter().filter(|m| m.end == 0).map(|m| (turning.starts[m.at.0], m.body, m.e));
        let ends = self.closures.iter().map(|m| (turning.ends[m.at.0][m.end], m.body, m.e));
        starts.chain(ends).fold(T::zero(), |sum, (load, body, e)| sum + load.on(state.pose[body].carry(e)))
    }

    /// Adds the work of loads on the motion in `flow` for this change to `sums`. The loads are on bodies, `[b][n]` on
    /// W, W. and W.., and on frames and coordinates.
    pub fn add_work<'l>(
        &self,
        at: (&Topology, &State<T>),
        flow: &Flow<T>,
        loads: impl Iterator<Item = (&'l [[Wrench<T>; 3]], &'l Turning<T>)> + Clone,
        sums: &mut [T],
    ) {
        self.add_work_on_frames(at, flow, loads.clone().map(|(_, turning)| turning), sums);
        for &body in &self.reach.bodies {
            let [w0, w1, w2] = of_body(&flow.twists, body);
            add_each(sums, &loads, |(by_twists, _)| {
                let [p0, p1, p2] = &by_twists[body];
                p0.on(w0) + p1.on(w1) + p2.on(w2)
            });
        }
    }

    /// The same at rest, where W alone counts.
    pub fn add_work_at_rest<'l>(
        &self,
        at: (&Topology, &State<T>),
        flow: &Flow<T>,
        loads: impl Iterator<Item = (&'l [[Wrench<T>; 3]], &'l Turning<T>)> + Clone,
        sums: &mut [T],
    ) {
        self.add_work_on_frames(at, flow, loads.clone().map(|(_, turning)| turning), sums);
        for &body in &self.reach.bodies {
            let w = flow.twists[0][body];
            add_each(sums, &loads, |(by_twists, _)| by_twists[body][0].on(w));
        }
    }

    /// Adds the work of loads on frames and coordinates.
    #[inline(always)]
    fn add_work_on_frames<'l>(
        &self,
        (topology, state): (&Topology, &State<T>),
        flow: &Flow<T>,
        loads: impl Iterator<Item = &'l Turning<T>> + Clone,
        sums: &mut [T],
    ) {
        for m in self.links.iter().filter(|m| m.end == 0) {
            let z = state.pose[m.body].carry(m.e);
            add_each(sums, &loads, |turning| turning.starts[m.at.0].on(z));
        }
        for m in &self.closures {
            let z = state.pose[m.body].carry(m.e);
            add_each(sums, &loads, |turning| turning.ends[m.at.0][m.end].on(z));
        }
        let in_blocks = self.reach.blocks.iter().flat_map(|&b| topology[b].link_ids());
        for k in self.reach.driven_links.iter().copied().chain(in_blocks) {
            for step in topology[k].steps.iter().filter(|step| flow.drives || !step.is_driven) {
                for c in step.coordinates() {
                    add_each(sums, &loads, |turning| turning.pulls[c.0] * flow.speeds[0][c.0]);
                }
            }
        }
    }

    /// Redundant rows that the change may open.
    #[inline(always)]
    fn left_out(&self, topology: &Topology) -> impl Iterator<Item = RowId> {
        let rows = self.reach.closures.iter().flat_map(|&c| topology[c].row_ids());
        rows.filter(|&r| topology[r].is_redundant())
    }

    /// Contribution of a change of its law to a driver's value, speed or acceleration.
    #[inline(always)]
    pub fn law_rate(&self, driver: DriverId, order: usize) -> T {
        let of_driver = self.law_rates.iter().find(|(d, _)| *d == driver);
        of_driver.map_or(T::zero(), |(_, rates)| rates[order])
    }
}

impl<T: Real> PlanVelocity<Dual<T>> {
    /// Second derivative of the value of a driver, along the field and along the direction of the duals, by its laws at
    /// a small step along the latter, forward and back.
    pub fn law_curvature(&self, driver: DriverId, laws: [&Law; 2], t: f64) -> f64 {
        let of_driver = self.laws.iter().filter(|(d, ..)| *d == driver);
        let along = |(_, parameter, rate): &(DriverId, usize, Dual<T>)| {
            let [ahead, behind] = number::both(laws, |law| law.derivative(*parameter, t).value());
            // d/dw (df/dp dp/du) = d(df/dp)/dw dp/du + df/dp d2p/du dw
            rate.v.value() * (ahead - behind) / (2.0 * LAW_STEP) + rate.d.value() * (ahead + behind) / 2.0
        };
        of_driver.map(along).sum()
    }

    /// Adds these second derivatives to the contributions that were set last.
    pub fn add_law_curvature(&mut self, [ahead, behind]: [&[Law]; 2], t: f64) {
        for k in 0..self.law_rates.len() {
            let d = self.law_rates[k].0;
            let curvature = self.law_curvature(d, [&ahead[d.0], &behind[d.0]], t);
            self.law_rates[k].1[0].d += T::constant(curvature);
        }
    }
}

/// Solver of derivatives of the motion, one design variable at a time; a step allocates no memory.
pub(crate) struct DirectDifferentiation<T> {
    /// Unknowns of orders 0, 1, 2: design twists W of the bodies and speeds S of the coordinates, and their time
    /// derivatives.
    pub flow: Flow<T>,
    /// Design twists and their rates, per marker that the field moves at a closure.
    z: Vec<[Twist<T>; 3]>,
    /// Bodies that the last variable moved.
    moved: Vec<usize>,
}

/// Defect of a redundant row per unit of a variable, above round-off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Defect {
    /// The row.
    pub row: RowId,
    /// The defect, in the row's unit per unit of the variable.
    pub value: f64,
}

impl Defect {
    /// Updates the largest defect with that of a row, if it is above round-off.
    #[inline(always)]
    pub(super) fn enter<T: Real>(worst: &mut Option<Self>, row: RowId, sum: T, limit: T) {
        let (value, limit) = (sum.value(), limit.value());
        // NaN is a defect.
        if !(value <= limit) && worst.is_none_or(|w| value > w.value) {
            *worst = Some(Self { row, value });
        }
    }
}

/// Defects below this fraction of the field's speed are zero, even if the row has no other terms.
pub(super) const DEFECT_FLOOR: f64 = 1e-9;

impl<T: Real> DirectDifferentiation<T> {
    pub fn new(model: &Model, topology: &Topology) -> Self {
        Self {
            flow: Flow::new(topology, model.bodies.len(), false).with_moves(),
            z: Vec::with_capacity(2 * topology.closures.len()),
            moved: Vec::with_capacity(model.bodies.len()),
        }
    }

    /// Solves W, W. and W.. of all bodies for one variable; `state` has all of its rates.
    pub fn solve(&mut self, topology: &Topology, state: &mut State<T>, field: &PlanVelocity<T>) {
        self.set_field(topology, state, field);
        self.solve_order::<0>(topology, state, field);
        self.solve_order::<1>(topology, state, field);
        self.solve_order::<2>(topology, state, field);
    }

    /// Solves W alone; `state` needs no rates.
    pub fn solve_position(&mut self, topology: &Topology, state: &mut State<T>, field: &PlanVelocity<T>) {
        self.set_field(topology, state, field);
        self.solve_order::<0>(topology, state, field);
    }

    /// Sets the design twists of every marker of the field, and zero for bodies out of its reach.
    #[inline(always)]
    fn set_field(&mut self, topology: &Topology, state: &State<T>, field: &PlanVelocity<T>) {
        let (none, Self { flow, z, moved }) = (Twist::zero(), self);
        // W = W. = W.. = 0 of all bodies that this variable does not reach.
        if *moved != field.reach.bodies {
            for twists in &mut flow.twists {
                for &b in &*moved {
                    twists[b] = none;
                }
            }
            moved.clear();
            moved.extend_from_slice(&field.reach.bodies);
        }
        flow.drives |= !field.law_rates.is_empty();
        let [m0, m1, m2] = &mut flow.moves;
        let mut rest = |k: LinkId| (m0[k.0], m1[k.0], m2[k.0]) = (none, none, none);
        for &k in &field.reach.driven_links {
            rest(k);
        }
        for &b in &field.reach.blocks {
            for k in topology[b].link_ids() {
                rest(k);
            }
        }
        // moves(n) = z_p(n) - z_c(n): the first term of (11), (12), (13) on the right
        for m in &field.links {
            for (n, z) in m.carried(state).into_iter().enumerate() {
                flow.move_link(n, (m.at, m.end), z);
            }
        }
        z.clear();
        for m in &field.closures {
            z.push(m.carried(state));
        }
    }

    /// Solves (24) of `docs/theory.md` with U = W, u = S, z the design twists of the markers, and f = L': (11), (12) or
    /// (13).
    #[inline(always)]
    fn solve_order<const N: usize>(
        &mut self,
        topology: &Topology,
        state: &mut State<T>,
        field: &PlanVelocity<T>,
    ) {
        let (reach, Self { flow, z, .. }) = (&field.reach, self);
        // demand = L' + df(n)/dp - l . (z_j(n) - z_i(n)); L' is constant over time, so it is part of order 0 alone.
        // The other terms of (12) and (13), -sum_{m=1..n} C(n,m) l(m) . (D_j(n-m) - D_i(n-m)), are added by
        // `Flow::solve`.
        for &c in &reach.closures {
            flow.ask(topology, c, T::zero());
        }
        for (k, m) in field.closures.iter().enumerate() {
            flow.move_end(topology, (m.at, m.end), z[k][N], &state.l[0]);
        }
        for &(row, rate) in field.kept.iter().filter(|_| N == 0) {
            flow.demand[row.0] += rate;
        }
        if flow.drives {
            follow_laws(topology, field, N, flow);
        }
        // W(n) of links without unknowns, from ground on; then S(n) and W(n) block by block:
        //     J S(n) = demand - l . (W_j - W_i)   with W as if the unknown S(n) were 0
        flow.follow::<N>(topology, reach.driven_links.iter().copied(), &state.x);
        for &b in &reach.blocks {
            flow.solve::<N>(topology, b, state.linear());
        }
        if let Some(apart) = flow.apart.get_mut(N) {
            for (k, m) in field.closures.iter().enumerate() {
                if topology[m.at].block.is_some() {
                    // D_j - D_i = (W_j - W_i) + (z_j - z_i), for the orders above; the first part is there already.
                    apart[m.at.0] += if m.end == 1 { z[k][N] } else { -z[k][N] };
                }
            }
        }
    }

    /// Redundant row with the largest defect under the change that was solved last, if any is above round-off.
    pub fn worst_defect(
        &self,
        topology: &Topology,
        state: &State<T>,
        field: &PlanVelocity<T>,
    ) -> Option<Defect> {
        let mut worst = None;
        for &c in &field.reach.closures {
            for row in topology[c].row_ids() {
                if topology[row].is_redundant() {
                    let (_, defect, limit) = self.judged_defect(topology, state, field, row);
                    Defect::enter(&mut worst, row, defect, limit);
                }
            }
        }
        worst
    }

    /// Redundant rows under the change that was solved last: each with the size of its defect and its round-off limit.
    pub fn judged_defects(
        &self,
        topology: &Topology,
        state: &State<T>,
        field: &PlanVelocity<T>,
    ) -> impl Iterator<Item = (RowId, T, T)> {
        field.left_out(topology).map(|r| self.judged_defect(topology, state, field, r))
    }

    /// Row r with the size of its defect and its round-off limit.
    #[inline(always)]
    fn judged_defect(
        &self,
        topology: &Topology,
        state: &State<T>,
        field: &PlanVelocity<T>,
        r: RowId,
    ) -> (RowId, T, T) {
        let (sum, most) = self.row_defect(topology, state, field, r);
        // The tolerance for coordinates in the file is the same as in the motion.
        // abs(sum) <= max(1e-5 of the largest term, 1e-9 of the field's largest speed)                         (30)
        let limit = most * T::constant(LOCKED);
        (r, sum.abs(), limit.larger(field.scale * T::constant(DEFECT_FLOOR)))
    }

    /// Signed defects of the redundant rows under the change that was solved last.
    pub fn defects(
        &self,
        topology: &Topology,
        state: &State<T>,
        field: &PlanVelocity<T>,
    ) -> impl Iterator<Item = (RowId, T)> {
        field.left_out(topology).map(|r| (r, self.row_defect(topology, state, field, r).0))
    }

    /// Defect of row r, and the largest of its terms.
    #[inline(always)]
    fn row_defect(&self, topology: &Topology, state: &State<T>, field: &PlanVelocity<T>, r: RowId) -> (T, T) {
        let zero = T::zero();
        // l . (W_j - W_i) + l . (z_j - z_i) - (L' + df/dp), summed over a coupler's terms: (11) of a redundant row
        let (mut sum, mut most) = (zero, zero);
        for RowTerm { row, factor } in topology.parts_of_row(r) {
            let closure = topology.closure_of(row);
            let [i, j] = closure.bodies;
            let (l, w, factor) = (state.l[0][row.0], &self.flow.twists[0], T::constant(factor));
            let mut add = |term: T| {
                sum += term * factor;
                most = most.larger((term * factor).abs());
            };
            add(l.on(w[j.0]));
            add(-l.on(w[i.0]));
            for (m, z) in field.closures.iter().zip(&self.z).filter(|(m, _)| m.at == topology[row].closure) {
                add(if m.end == 1 { l.on(z[0]) } else { -l.on(z[0]) });
            }
            let driven = closure.driver.map_or(zero, |d| field.law_rate(d, 0));
            add(-(field.kept_rate(row) + driven));
        }
        (sum, most)
    }
}

/// Adds the work of each of these loads to its sum.
#[inline(always)]
fn add_each<T: Real, L>(sums: &mut [T], loads: &(impl Iterator<Item = L> + Clone), work: impl Fn(L) -> T) {
    for (k, load) in loads.clone().enumerate() {
        sums[k] += work(load);
    }
}

/// Driven coordinates, in the tree and across cuts, follow the change of their laws.
fn follow_laws<T: Real>(topology: &Topology, field: &PlanVelocity<T>, order: usize, flow: &mut Flow<T>) {
    for (c, d) in topology.driven_coordinates() {
        // S(n) = df(n)/dp of a driven coordinate of the tree: it is q = f(t, p) itself.
        flow.speeds[order][c.0] = field.law_rate(d, order);
    }
    for closure in &topology.closures {
        if let Some(d) = closure.driver {
            // The same of a driver across a cut joint, in its own row.
            flow.demand[closure.first_row.0] += field.law_rate(d, order);
        }
    }
}

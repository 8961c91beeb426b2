//! The three levels of one design variable at one step.

use crate::model::{DriverId, Field, JointId, Model};
use crate::motion::kinematics::{State, level, sum_couplers};
use crate::motion::stepper::LOCKED;
use crate::space::{LANES, Real, Twist};
use crate::topology::{Source, Topology};

/// Design velocities laid out for the plan, one variable per lane: body-fixed marker twists by link and
/// by closure. Lanes without a variable stay at rest.
#[derive(Clone, Debug)]
pub(crate) struct FieldParts<T> {
    links: Vec<Moving<T>>,
    closures: Vec<Moving<T>>,
    /// Rows whose kept values change, and their rates.
    kept: Vec<(usize, T)>,
    /// Drivers whose laws change, and what changes in every lane.
    laws: Vec<(DriverId, Vec<LawChange>)>,
    /// What that adds to the driver's value, speed and acceleration at the time that was set last.
    law_rates: Vec<(DriverId, [T; 3])>,
    /// Largest speed in each field: what round-off of a defect is compared with.
    scale: T,
}

/// The parameters of a law that change, and their rates.
type LawChange = Vec<(usize, f64)>;

/// A marker that some design velocity moves.
#[derive(Clone, Copy, Debug)]
struct Moving<T> {
    /// Which link or closure.
    at: usize,
    /// Which marker: 0 is the parent's of a link or i of a closure, 1 the child's or j.
    end: usize,
    /// The body that carries it.
    body: usize,
    /// Body-fixed twist.
    e: Twist<T>,
}

impl<T: Real> Moving<T> {
    /// z = Ad(X) e, z. = ad(V) z, z.. = ad(A) z + ad(V) z. (`docs/theory.md` (8)).
    #[inline(always)]
    fn carried(&self, state: &State<T>) -> [Twist<T>; 3] {
        let (v, a) = (&state.v[self.body], &state.a[self.body]);
        let z0 = state.pose[self.body].carry(self.e);
        let z1 = v.ad(z0);
        [z0, z1, a.ad(z0) + v.ad(z1)]
    }
}

impl<T: Real> FieldParts<T> {
    /// Lane k takes `fields[k]`; there must be no more fields than lanes.
    pub fn new(topology: &Topology, fields: &[&Field], witness: T) -> Self {
        let twist_in = |k: usize, joint, end| fields.get(k).and_then(|f| f.twist_of(joint, end));
        let twist_of = |joint: JointId, end: usize| {
            Twist::gather(witness, |k| twist_in(k, joint, end).unwrap_or(Twist::ZERO))
        };
        let moves = |joint: JointId, end: usize| (0..fields.len()).any(|k| twist_in(k, joint, end).is_some());
        let (mut links, mut closures, mut kept) = (Vec::new(), Vec::new(), Vec::new());
        for (at, link) in topology.links.iter().enumerate() {
            let Some(joint) = link.joint else { continue };
            for (end, body) in [(0, link.parent.0), (1, link.child.0)] {
                let marker = if end == 0 { link.parent_end } else { 1 - link.parent_end };
                if moves(joint, marker) {
                    links.push(Moving { at, end, body, e: twist_of(joint, marker) });
                }
            }
        }
        for (at, closure) in topology.closures.iter().enumerate() {
            for end in (0..2).filter(|&end| moves(closure.joint, end)) {
                let body = closure.bodies[end].0;
                closures.push(Moving { at, end, body, e: twist_of(closure.joint, end) });
            }
            for (k, row) in closure.rows.iter().enumerate() {
                let rate = |f: &Field| f.kept_rate(closure.joint).by(*row);
                let rate = witness.like_lanes(|lane| fields.get(lane).map_or(0.0, |f| rate(f)));
                if rate.abs().largest() > 0.0 {
                    kept.push((closure.first_row + k, rate));
                }
            }
        }
        // Per unit of a variable: how fast markers move and turn, kept values change, laws change.
        let speed = |f: &Field| {
            let markers = f.markers.iter().map(|m| m.twist.w.norm().max(m.twist.v.norm()));
            let kept = f
                .kept
                .iter()
                .map(|(_, k)| k.distance.abs().max(k.offset.abs()).max(k.cosine.abs()).max(k.contact.abs()));
            let laws = f.laws.iter().map(|(_, _, rate)| rate.abs());
            markers.chain(kept).chain(laws).fold(0.0, f64::max)
        };
        let scale = witness.like_lanes(|k| fields.get(k).map_or(0.0, |f| speed(f)));
        let mut drivers: Vec<DriverId> = fields.iter().flat_map(|f| &f.laws).map(|(d, ..)| *d).collect();
        drivers.sort_unstable();
        drivers.dedup();
        let of_lane = |d: DriverId, f: &Field| -> LawChange {
            f.laws.iter().filter(|(k, ..)| *k == d).map(|(_, parameter, rate)| (*parameter, *rate)).collect()
        };
        let laws: Vec<_> =
            drivers.iter().map(|&d| (d, fields.iter().map(|f| of_lane(d, f)).collect())).collect();
        let law_rates = drivers.iter().map(|&d| (d, [witness.zero(); 3])).collect();
        Self { links, closures, kept, laws, law_rates, scale }
    }

    /// Sets what changing laws do, at one time per lane.
    pub fn set_times(&mut self, model: &Model, times: &[f64; LANES]) {
        for ((d, lanes), (_, rates)) in self.laws.iter().zip(&mut self.law_rates) {
            let law = &model.drivers[d.0].law;
            let mut of_lanes = [[0.0; 3]; LANES];
            for (k, (out, parameters)) in of_lanes.iter_mut().zip(lanes).enumerate() {
                for (parameter, rate) in parameters {
                    let derivatives = law.derivative(*parameter, times[k]).derivatives();
                    for order in 0..3 {
                        out[order] += rate * derivatives[order];
                    }
                }
            }
            for order in 0..3 {
                rates[order] = self.scale.like_lanes(|k| of_lanes[k][order]);
            }
        }
    }

    /// What a change of its law adds to a driver's value, speed or acceleration.
    #[inline(always)]
    fn law_rate(&self, driver: DriverId, order: usize) -> T {
        let of_driver = self.law_rates.iter().find(|(d, _)| *d == driver);
        of_driver.map_or(self.scale.zero(), |(_, rates)| rates[order])
    }
}

/// Scratch of the sensitivity levels; nothing is allocated per step.
pub(crate) struct Direct<T> {
    /// Per order (0, 1, 2): speeds of the coordinates, S.
    s: [Vec<T>; 3],
    /// Per order: design twists of the bodies, W.
    pub w: [Vec<Twist<T>>; 3],
    /// Per order: `z_parent - z_child` of the links.
    z_link: [Vec<Twist<T>>; 3],
    /// Per order: z of both markers of the closures.
    z_end: [Vec<[Twist<T>; 2]>; 3],
    bias: Vec<Twist<T>>,
    row_rhs: Vec<T>,
    /// Whether some variable has changed a law, so that the driven coordinates' speeds are no longer all zero.
    laws_change: bool,
}

/// By how much a left-out row fails per unit of a variable, against what could be round-off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Defect {
    /// The row.
    pub row: usize,
    /// The defect, in the row's unit per unit of the variable.
    pub value: f64,
}

/// A defect below this part of the field's own speed is zero, even if nothing else stands in the row.
const DEFECT_FLOOR: f64 = 1e-9;

impl<T: Real> Direct<T> {
    pub fn new(model: &Model, topology: &Topology, witness: T) -> Self {
        let none = Twist::zero(witness);
        let three = |n: usize| std::array::from_fn(|_| vec![none; n]);
        Self {
            s: std::array::from_fn(|_| vec![witness.zero(); topology.coordinates.len()]),
            w: three(model.bodies.len()),
            z_link: three(topology.links.len()),
            z_end: std::array::from_fn(|_| vec![[none; 2]; topology.closures.len()]),
            bias: vec![none; topology.links.len()],
            row_rhs: vec![witness.zero(); topology.rows.len()],
            laws_change: false,
        }
    }

    /// W, W. and W.. of all bodies for one variable, where `state` stands with all of its rates.
    pub fn solve(&mut self, topology: &Topology, state: &mut State<T>, field: &FieldParts<T>) {
        let witness = state.witness;
        witness.within(
            #[inline(always)]
            || {
                self.set_field(state, field);
                for order in 0..3 {
                    self.solve_order(topology, state, field, order);
                }
            },
        );
    }

    /// The design twists of every marker of the field.
    #[inline(always)]
    fn set_field(&mut self, state: &State<T>, field: &FieldParts<T>) {
        let none = Twist::zero(state.witness);
        for order in 0..3 {
            self.z_link[order].fill(none);
            self.z_end[order].fill([none; 2]);
        }
        for m in &field.links {
            let z = m.carried(state);
            for order in 0..3 {
                self.z_link[order][m.at] += if m.end == 0 { z[order] } else { -z[order] };
            }
        }
        for m in &field.closures {
            let z = m.carried(state);
            for order in 0..3 {
                self.z_end[order][m.at][m.end] = z[order];
            }
        }
    }

    /// `W_Mj - W_Mi` of a closure's markers at a finished order.
    #[inline(always)]
    fn marker_difference(&self, topology: &Topology, closure: usize, order: usize) -> Twist<T> {
        let [i, j] = topology.closures[closure].bodies;
        let [z_i, z_j] = self.z_end[order][closure];
        self.w[order][j.0] + z_j - self.w[order][i.0] - z_i
    }

    /// `docs/theory.md` (11), (12) or (13).
    #[inline(always)]
    fn solve_order(
        &mut self,
        topology: &Topology,
        state: &mut State<T>,
        field: &FieldParts<T>,
        order: usize,
    ) {
        let two = state.witness.like(2.0);
        for (k, link) in topology.links.iter().enumerate() {
            let mut bias = self.z_link[order][k];
            match order {
                0 => {}
                1 => bias += state.sum_over_link(link, &state.xd, &self.s[0]),
                _ => {
                    bias += state.sum_over_link(link, &state.xd, &self.s[1]) * two;
                    bias += state.sum_over_link(link, &state.xdd, &self.s[0]);
                }
            }
            self.bias[k] = bias;
        }
        for (c, closure) in topology.closures.iter().enumerate() {
            let [z_i, z_j] = self.z_end[order][c];
            let dz = z_j - z_i;
            let before = if order > 0 { self.marker_difference(topology, c, order - 1) } else { dz };
            let first = if order > 1 { self.marker_difference(topology, c, 0) } else { dz };
            for r in closure.first_row..closure.first_row + closure.rows.len() {
                let mut rhs = -state.l[r].on(dz);
                match order {
                    0 => {}
                    1 => rhs -= state.ld[r].on(before),
                    _ => rhs -= state.ldd[r].on(first) + two * state.ld[r].on(before),
                }
                self.row_rhs[r] = rhs;
            }
        }
        if order == 0 {
            for &(row, rate) in &field.kept {
                self.row_rhs[row] += rate;
            }
        }
        sum_couplers(topology, &mut self.row_rhs);
        self.laws_change |= !field.law_rates.is_empty();
        if self.laws_change {
            self.follow_laws(topology, field, order);
        }
        level(
            topology,
            &mut state.factors,
            &state.x,
            &state.l,
            Some(&self.bias),
            &self.row_rhs,
            &mut self.s[order],
            &mut self.w[order],
            &mut state.rhs,
        );
    }

    /// Driven coordinates, in the tree and across cuts, follow the change of their laws.
    fn follow_laws(&mut self, topology: &Topology, field: &FieldParts<T>, order: usize) {
        for (c, coordinate) in topology.coordinates.iter().enumerate() {
            if let Source::Driven(d) = coordinate.source {
                self.s[order][c] = field.law_rate(d, order);
            }
        }
        for closure in &topology.closures {
            if let Some(d) = closure.driver {
                self.row_rhs[closure.first_row] += field.law_rate(d, order);
            }
        }
    }

    /// Per lane, the left-out row that fails most under its change, if any does by more than round-off.
    ///
    /// Speaks of the variables that were solved last.
    pub fn worst_defects(
        &self,
        topology: &Topology,
        state: &State<T>,
        field: &FieldParts<T>,
        worst: &mut [Option<Defect>],
    ) {
        worst.fill(None);
        let zero = state.witness.zero();
        for (r, _) in topology.rows.iter().enumerate().filter(|(_, p)| !p.selected && !p.is_term) {
            // Per lane: the sum of all terms, and the largest of them.
            let mut sums = [(0.0, 0.0_f64); LANES];
            for (k, factor) in topology.parts_of_row(r) {
                let closure = topology.rows[k].closure;
                let [i, j] = topology.closures[closure].bodies;
                let [z_i, z_j] = self.z_end[0][closure];
                let rate = field.kept.binary_search_by_key(&k, |l| l.0).map_or(zero, |n| field.kept[n].1);
                let driven = topology.closures[closure].driver.map_or(zero, |d| field.law_rate(d, 0));
                let rate = rate + driven;
                let (l, w, factor) = (state.l[k], &self.w[0], zero.like(factor));
                let terms = state.witness.within(
                    #[inline(always)]
                    || [l.on(w[j.0]), l.on(z_j), -l.on(w[i.0]), -l.on(z_i), -rate].map(|x| x * factor),
                );
                for (lane, (sum, most)) in sums[..T::LANES].iter_mut().enumerate() {
                    for term in &terms {
                        *sum += term.lane(lane);
                        *most = most.max(term.lane(lane).abs());
                    }
                }
            }
            for (lane, worst) in worst.iter_mut().enumerate() {
                let (defect, size): (f64, f64) = sums[lane];
                // What typed coordinates may be off by in the motion, they may be off by in the design's terms.
                let is_defect =
                    !(defect.abs() <= LOCKED * size) && defect.abs() > DEFECT_FLOOR * field.scale.lane(lane);
                if is_defect && worst.is_none_or(|w| defect.abs() > w.value) {
                    *worst = Some(Defect { row: r, value: defect.abs() });
                }
            }
        }
    }
}

//! The three levels of one design variable at one step.

use crate::constraint::Row;
use crate::model::{Field, Model};
use crate::motion::kinematics::{State, level};
use crate::motion::stepper::LOCKED;
use crate::space::{Real, Twist};
use crate::topology::{Closure, Topology};

/// A design velocity laid out for the plan: body-fixed marker twists by link and by closure.
#[derive(Clone, Debug)]
pub(crate) struct FieldParts {
    /// Link, +1 for the parent's marker or -1 for the child's, body, body-fixed twist.
    links: Vec<(usize, f64, usize, Twist)>,
    /// Closure, end (0 is i, 1 is j), body, body-fixed twist.
    closures: Vec<(usize, usize, usize, Twist)>,
    /// Distance rows whose design length changes, and its rate.
    lengths: Vec<(usize, f64)>,
    /// Largest speed in the field: what round-off of a defect is compared with.
    scale: f64,
}

impl FieldParts {
    pub fn new(model: &Model, topology: &Topology, field: &Field) -> Self {
        let mut parts = Self { links: Vec::new(), closures: Vec::new(), lengths: Vec::new(), scale: 0.0 };
        for m in &field.markers {
            let body = model.joints[m.joint.0].bodies[m.end].0;
            parts.scale = parts.scale.max(m.twist.w.norm()).max(m.twist.v.norm());
            for (k, link) in topology.links.iter().enumerate().filter(|(_, l)| l.joint == Some(m.joint)) {
                parts.links.push((k, if link.parent_end == m.end { 1.0 } else { -1.0 }, body, m.twist));
            }
            for (k, _) in topology.closures.iter().enumerate().filter(|(_, c)| c.joint == m.joint) {
                parts.closures.push((k, m.end, body, m.twist));
            }
        }
        for &(joint, rate) in &field.lengths {
            for c in topology.closures.iter().filter(|c: &&Closure| c.joint == joint) {
                for (k, row) in c.rows.iter().enumerate() {
                    if *row == Row::Distance {
                        parts.lengths.push((c.first_row + k, rate));
                    }
                }
            }
        }
        parts
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
        }
    }

    /// W, W. and W.. of all bodies for one variable, where `state` stands with all of its rates.
    pub fn solve(&mut self, topology: &Topology, state: &mut State<T>, field: &FieldParts) {
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

    /// z = Ad(X) e, z. = ad(V) z, z.. = ad(A) z + ad(V) z. of every marker of the field.
    #[inline(always)]
    fn set_field(&mut self, state: &State<T>, field: &FieldParts) {
        let none = Twist::zero(state.witness);
        let z = |body: usize, e: Twist| {
            let (v, a) = (state.v[body], state.a[body]);
            let z0 = state.pose[body].carry(e.spread(state.witness));
            let z1 = v.ad(z0);
            [z0, z1, a.ad(z0) + v.ad(z1)]
        };
        for order in 0..3 {
            self.z_link[order].fill(none);
            self.z_end[order].fill([none; 2]);
        }
        for &(link, sign, body, e) in &field.links {
            for (order, z) in z(body, e).into_iter().enumerate() {
                self.z_link[order][link] += z * state.witness.like(sign);
            }
        }
        for &(closure, end, body, e) in &field.closures {
            for (order, z) in z(body, e).into_iter().enumerate() {
                self.z_end[order][closure][end] = z;
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
    fn solve_order(&mut self, topology: &Topology, state: &mut State<T>, field: &FieldParts, order: usize) {
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
            for &(row, rate) in &field.lengths {
                self.row_rhs[row] += state.witness.like(rate);
            }
        }
        level(
            topology,
            &mut state.factors,
            &state.x,
            &state.l,
            &self.bias,
            &self.row_rhs,
            &mut self.s[order],
            &mut self.w[order],
            &mut state.rhs,
        );
    }

    /// The left-out row that fails most under the change, if any does by more than round-off.
    ///
    /// Speaks of position level, and so must be asked before another variable is solved.
    pub fn worst_defect(&self, topology: &Topology, state: &State<T>, field: &FieldParts) -> Option<Defect> {
        let mut worst: Option<Defect> = None;
        for (r, place) in topology.rows.iter().enumerate().filter(|(_, p)| !p.selected) {
            let [i, j] = topology.closures[place.closure].bodies;
            let [z_i, z_j] = self.z_end[0][place.closure];
            let length = field.lengths.iter().filter(|(row, _)| *row == r).map(|(_, l)| *l).sum::<f64>();
            let terms = [self.w[0][j.0], z_j, -self.w[0][i.0], -z_i].map(|w| state.l[r].on(w).lane(0));
            let defect = terms.iter().sum::<f64>() - length;
            let size = terms.iter().fold(length.abs(), |m, x| m.max(x.abs()));
            // What typed coordinates may be off by in the motion, they may be off by in the design's terms.
            let is_defect = !(defect.abs() <= LOCKED * size) && defect.abs() > DEFECT_FLOOR * field.scale;
            if is_defect && worst.is_none_or(|w| defect.abs() > w.value) {
                worst = Some(Defect { row: r, value: defect.abs() });
            }
        }
        worst
    }
}

//! Propagation of loads to ground: the equation of order n, transposed.
//!
//! | here | theory | meaning |
//! |---|---|---|
//! | `load[n]` | F, F., F.. | load on each body; during propagation, the accumulated load |
//! | `links[n]` | T_k, T_k., T_k.. | wrench that a link transmits to its parent (18) |
//! | `closures[n]` | T_c, T_c., T_c.. | wrench of a closure's rows on body j; the opposite acts on body i |
//! | `rows[n]` | mu, mu., mu.. | `T_c = - sum mu_r l_r` |

use crate::linalg::Factors;
use crate::model::Model;
use crate::motion::kinematics::State;
use crate::motion::level::BINOMIAL;
use crate::space::{Real, Twist, Wrench};
use crate::topology::{BlockId, LinkId, RowTerm, Topology};

/// Path of some loads to ground.
#[derive(Clone, Debug)]
pub(crate) struct Way {
    /// Blocks, from the load to ground.
    pub blocks: Vec<BlockId>,
    /// Links placed by drivers alone, likewise.
    pub driven_links: Vec<LinkId>,
}

impl Way {
    /// Path of loads on any body.
    pub fn of_all(topology: &Topology) -> Self {
        Self {
            blocks: topology.block_ids().rev().collect(),
            driven_links: topology.driven_links().rev().collect(),
        }
    }
}

/// Transposed equations of a position: unit twists and wrenches with their derivatives, order by order, and factors.
pub(crate) struct Transposed<'s, T = f64> {
    /// Per order and coordinate: x.
    pub x: [&'s [Twist<T>]; 3],
    /// Per order and row: l.
    pub l: [&'s [Wrench<T>]; 3],
    /// Factors of the Jacobian per block.
    pub factors: &'s mut [Factors<T>],
    /// Room for the right-hand side of a block.
    pub rhs: &'s mut [T],
}

impl<'s, T: Real> Transposed<'s, T> {
    /// Transposed equations of a state, with its time derivatives.
    pub fn of(state: &'s mut State<T>) -> Self {
        let State { x, l, factors, rhs, .. } = state;
        let ([x0, x1, x2], [l0, l1, l2]) = (x, l);
        Self { x: [x0, x1, x2], l: [l0, l1, l2], factors, rhs }
    }
}

/// Transmitted wrenches and their first two derivatives; a step allocates no memory.
pub(crate) struct Transmission<T = f64> {
    /// Per order and body: the load that is still to be transmitted.
    pub load: [Vec<Wrench<T>>; 3],
    /// Per order and link, or closure: the wrench that it transmits.
    pub links: [Vec<Wrench<T>>; 3],
    pub closures: [Vec<Wrench<T>>; 3],
    /// Per order and row: multiplier mu of its wrench, with the sign of a gradient.
    pub rows: [Vec<T>; 3],
    /// Per order and coordinate: additional generalised force.
    pub pulls: [Vec<T>; 3],
    /// Per body of a block: the load on it and on its children.
    below: Vec<Wrench<T>>,
}

impl<T: Real> Transmission<T> {
    /// Transmission without loads.
    pub fn new(model: &Model, topology: &Topology) -> Self {
        let (zero, none) = (T::zero(), Wrench::zero());
        let three = |n: usize| std::array::from_fn(|_| vec![none; n]);
        Self {
            load: three(model.bodies.len()),
            links: three(topology.links.len()),
            closures: three(topology.closures.len()),
            rows: std::array::from_fn(|_| vec![zero; topology.rows.len()]),
            pulls: std::array::from_fn(|_| vec![zero; topology.coordinates.len()]),
            below: vec![none; model.bodies.len()],
        }
    }

    /// Solves for wrenches of links, closures and rows to order n: the equation of order n, transposed
    /// (`docs/theory.md` (18), (25)),
    ///
    /// ```text
    /// sum_{m=0..n} C(n,m) T_k(m) . x_a(n-m) = 0                     for every unknown coordinate a of link k,
    /// T_c(n) = - sum_r sum_{m=0..n} C(n,m) mu_r(m) l_r(n-m)         for every closure.
    /// ```
    pub fn transmit(&mut self, topology: &Topology, with: Transposed<'_, T>, way: &Way, n: usize) {
        let Self { load, links, closures, rows, pulls, below } = self;
        let (zero, none) = (T::zero(), Wrench::zero());
        let Transposed { x, l, factors, rhs } = with;
        let load = &mut load[n];
        for &b in &way.blocks {
            let block = &topology[b];
            // Known parts: lower orders, on wrenches that turn.
            for &c in &block.closures {
                let closure = &topology[c];
                let mut known = none;
                for r in closure.row_ids() {
                    rows[n][r.0] = zero;
                    for m in (0..n).filter(|_| topology[r].has_wrench()) {
                        // - C(n,m) mu_r(m) l_r(n-m) for m < n, of (25), second line
                        known = l[n - m][r.0].times_plus(rows[m][r.0] * -BINOMIAL[n][m], known);
                    }
                }
                closures[n][c.0] = known;
                load[closure.bodies[1].0] += known;
                load[closure.bodies[0].0] -= known;
            }
            // First without closures: the generalised forces on the unknowns are the right-hand side for the closures.
            for k in block.link_ids() {
                let child = topology[k].child.0;
                below[child] = load[child];
            }
            // Parents outside of the block also accumulate loads, which are not used.
            for k in block.link_ids().rev() {
                let link = &topology[k];
                // below(p) = F_p + sum of below(c) over its children: T_k as far as it is known
                let carried = below[link.child.0];
                below[link.parent.0] += carried;
            }
            for (column, &a) in block.unknowns.iter().enumerate() {
                let k = topology[a].link;
                let mut works = below[topology[k].child.0].on(x[0][a.0]) + pulls[n][a.0];
                for m in 0..n {
                    // below . x_a + sum_{m<n} C(n,m) T_k(m) . x_a(n-m): the third line of (25) as long as mu(n) = 0
                    works += links[m][k.0].on(x[n - m][a.0]) * BINOMIAL[n][m];
                }
                rhs[column] = works;
            }
            // J^T mu(n) = works
            factors[b.0].solve_transposed(rhs);
            for (k, &r) in block.selected.iter().enumerate() {
                for RowTerm { row, factor } in topology.parts_of_row(r) {
                    // mu of a coupler's terms: c_k mu
                    rows[n][row.0] = rhs[k] * factor;
                }
            }
            for &c in &block.closures {
                let closure = &topology[c];
                let mut taken = none;
                for r in closure.row_ids() {
                    if topology[r].has_wrench() {
                        // T_c(n) = known - sum mu_r(n) l_r
                        taken = l[0][r.0].times_plus(-rows[n][r.0], taken);
                    }
                }
                closures[n][c.0] += taken;
                load[closure.bodies[1].0] += taken;
                load[closure.bodies[0].0] -= taken;
            }
            for k in block.link_ids().rev() {
                pass_on(topology, k, load, &mut links[n]);
            }
        }
        for &k in &way.driven_links {
            pass_on(topology, k, load, &mut links[n]);
        }
    }
}

/// A link transmits the wrench on its child to its parent.
#[inline(always)]
fn pass_on<T: Real>(topology: &Topology, k: LinkId, load: &mut [Wrench<T>], links: &mut [Wrench<T>]) {
    let link = &topology[k];
    // T_k = load on the child and its children; F_p <- F_p + T_k                              (18), first line
    let carried = load[link.child.0];
    links[k.0] = carried;
    load[link.parent.0] += carried;
}

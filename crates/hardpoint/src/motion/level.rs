//! The equation of order n, which covers all linear problems at a position, solved with one set of factors.
//!
//! A motion and its rates, and their derivatives by the design, obey the same two equations, differentiated n times by
//! time (`docs/theory.md`, section 4, "The equation of order n"):
//!
//! ```text
//! U_c(n) = U_p(n) + z_p(n) - z_c(n) + sum_{m=0..n} C(n,m) sum_a x_a(m) u_a(n-m)          for every link,
//! sum_{m=0..n} C(n,m) l(m) . (D_j(n-m) - D_i(n-m)) = f(n),     D = U + z                for every row.        (24)
//! ```
//!
//! The unknowns are U(n) of the bodies and u(n) of the coordinates; all lower orders are known. The transposed equation
//! propagates loads to ground (`sensitivity/adjoint.rs`).

use crate::linalg::Factors;
use crate::number::array;
use crate::space::{Real, Twist, Wrench};
use crate::topology::{BlockId, ClosureId, Link, LinkId, LinkStep, RowId, RowTerm, Topology};

/// Binomial coefficient `C(n, m)`: the factor of the product of an m-th and an (n - m)-th derivative in the n-th
/// derivative of a product.
pub(crate) const BINOMIAL: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 2.0, 1.0]];

/// Linear equations of a position, common to all quantities that are solved for: unit twists, wrenches, factors.
pub(crate) struct Linear<'s, T> {
    /// Per order and coordinate: world unit twists x and their time derivatives.
    pub x: &'s [Vec<Twist<T>>; 3],
    /// Per order and row: wrenches l and their time derivatives.
    pub l: &'s [Vec<Wrench<T>>; 3],
    /// Factors of the Jacobian per block.
    pub factors: &'s mut [Factors<T>],
    /// Room for the right-hand side of a block.
    pub rhs: &'s mut [T],
}

/// Unknowns of the equation of order n: a motion, or its derivative by a design variable.
#[derive(Clone, Debug)]
pub(crate) struct Flow<T> {
    /// Per order and coordinate: u. Those of driven coordinates are given.
    ///
    /// `[n][a]`, n = 0, 1, 2: u(n) is q.(n) of a motion, S(n) along the design, n! c_n of a response; rad or m per
    /// unit.
    pub speeds: [Vec<T>; 3],
    /// Per order and body: U.
    ///
    /// `[n][body]`: V, A, B of a motion; W, W., W.. along the design. Body 0 is ground.
    pub twists: [Vec<Twist<T>>; 3],
    /// Per order and closure, as needed by higher orders: `D_j - D_i`.
    pub apart: [Vec<Twist<T>>; 2],
    /// Per order and link: `z_p - z_c`; empty where no marker moves in its body.
    pub moves: [Vec<Twist<T>>; 3],
    /// Per row, of the order to be solved: `f - l . (z_j - z_i)`.
    pub demand: Vec<T>,
    /// True if driven coordinates have speeds; otherwise they are zero and are skipped.
    pub drives: bool,
    /// True if single axes on ground are fixed: over time they are; along the design they may move.
    pub ground_is_fixed: bool,
    /// Per link: its twist apart from the speeds of this order.
    /// `z_p(n) - z_c(n) + sum_{m=1..n} C(n,m) sum_a x_a(m) u_a(n-m)`.
    bias: Vec<Twist<T>>,
}

/// Twists of one body, of three orders. An index per order is inlined everywhere, `map` over the array is not.
#[inline(always)]
pub(crate) fn of_body<T: Copy>(twists: &[Vec<T>; 3], body: usize) -> [T; 3] {
    [twists[0][body], twists[1][body], twists[2][body]]
}

impl<T: Real> Flow<T> {
    /// Zero flow of this number of bodies.
    pub fn new(topology: &Topology, bodies: usize, drives: bool) -> Self {
        let none = Twist::zero();
        Self {
            speeds: std::array::from_fn(|_| vec![T::zero(); topology.coordinates.len()]),
            twists: std::array::from_fn(|_| vec![none; bodies]),
            apart: std::array::from_fn(|_| vec![none; topology.closures.len()]),
            moves: std::array::from_fn(|_| Vec::new()),
            demand: vec![T::zero(); topology.rows.len()],
            drives,
            ground_is_fixed: true,
            bias: vec![none; topology.links.len()],
        }
    }

    /// Adds memory for markers that move in their bodies.
    pub fn with_moves(mut self) -> Self {
        self.moves = std::array::from_fn(|_| vec![Twist::zero(); self.bias.len()]);
        self
    }

    /// Sets the demand f of all rows of closure c.
    #[inline(always)]
    pub fn ask(&mut self, topology: &Topology, c: ClosureId, f: T) {
        for r in topology[c].row_ids() {
            self.demand[r.0] = f;
        }
    }

    /// Adds the twist, at order n, of the parent's (0) or the child's (1) marker of link k in its body: `z_p - z_c`.
    #[inline(always)]
    pub fn move_link(&mut self, n: usize, (k, end): (LinkId, usize), z: Twist<T>) {
        self.moves[n][k.0] += if end == 0 { z } else { -z };
    }

    /// Adds the twist of marker i (0) or j (1) of closure c in its body: subtracts `l . (z_j - z_i)` from the demand of
    /// its rows.
    #[inline(always)]
    pub fn move_end(
        &mut self,
        topology: &Topology,
        (c, end): (ClosureId, usize),
        z: Twist<T>,
        l: &[Wrench<T>],
    ) {
        let z = if end == 1 { -z } else { z };
        for r in topology[c].row_ids().filter(|&r| topology[r].has_wrench()) {
            self.demand[r.0] += l[r.0].on(z);
        }
    }

    /// Adds the lower-order terms of these links: `z_p(n) - z_c(n) + sum_{m=1..n} C(n,m) sum_a x_a(m) u_a(n-m)`.
    #[inline(always)]
    fn turn_axes<const N: usize>(
        &mut self,
        topology: &Topology,
        links: impl Iterator<Item = LinkId>,
        x: &[Vec<Twist<T>>; 3],
    ) {
        if N == 0 {
            return;
        }
        for k in links {
            let link = &topology[k];
            // bias = z_p(n) - z_c(n) ...
            let mut bias = if self.moves[N].is_empty() { Twist::zero() } else { self.moves[N][k.0] };
            if !(self.ground_is_fixed && link.has_constant_twist()) {
                for step in link.steps.iter().filter(|s| self.drives || !s.is_driven) {
                    for c in step.coordinates() {
                        // ... + C(n,m) x_a(m) u_a(n-m): the lower orders of u in (24), first line
                        for m in 1..=N {
                            bias = x[m][c.0].times_plus(self.speeds[N - m][c.0] * BINOMIAL[N][m], bias);
                        }
                    }
                }
            }
            self.bias[k.0] = bias;
        }
    }

    /// Adds the lower-order terms of the rows of block b:
    /// `f(n) - sum_{m=1..n} C(n,m) l(m) . (D_j(n-m) - D_i(n-m)) - l . (z_j(n) - z_i(n))`, summed over the terms of
    /// couplers.
    #[inline(always)]
    fn turn_wrenches<const N: usize>(&mut self, topology: &Topology, b: BlockId, l: &[Vec<Wrench<T>>; 3]) {
        for &c in topology[b].closures.iter().filter(|_| N > 0) {
            for r in topology[c].row_ids() {
                if topology[r].has_wrench() {
                    for m in 1..=N {
                        // demand = f(n) - l . (z_j(n) - z_i(n)) - C(n,m) l(m) . (D_j(n-m) - D_i(n-m)): (24), second
                        // line, likewise
                        self.demand[r.0] -= l[m][r.0].on(self.apart[N - m][c.0]) * BINOMIAL[N][m];
                    }
                }
            }
        }
        for &r in &topology[b].coupled {
            for term in &topology[r].terms {
                // For a coupler it is the sum over its terms with factors c_k; the first term, with factor 1, is in its
                // row.
                let x = self.demand[term.row.0];
                self.demand[r.0] += x * T::constant(term.factor);
            }
        }
    }

    /// Propagates `U_c = U_p + bias + sum x_a u_a` along these links, over the selected freedoms.
    #[inline(always)]
    fn carry<const N: usize>(
        &mut self,
        topology: &Topology,
        links: impl Iterator<Item = LinkId>,
        x: &[Twist<T>],
        counts: impl Fn(&LinkStep) -> bool,
    ) {
        let bias = if N > 0 { &self.bias } else { &self.moves[0] };
        let (speeds, twists) = (&self.speeds[N], &mut self.twists[N]);
        for k in links {
            let link = &topology[k];
            // U_c = U_p + bias + sum x_a u_a                                                          (7), first line
            let mut twist = twists[link.parent.0];
            if let Some(bias) = bias.get(k.0) {
                twist += *bias;
            }
            for step in link.steps.iter().filter(|s| counts(s)) {
                for c in step.coordinates() {
                    twist = x[c.0].times_plus(speeds[c.0], twist);
                }
            }
            twists[link.child.0] = twist;
        }
    }

    /// Solves order n of links whose coordinates are all given: (24), first line.
    #[inline(always)]
    pub fn follow<const N: usize>(
        &mut self,
        topology: &Topology,
        links: impl Iterator<Item = LinkId> + Clone,
        x: &[Vec<Twist<T>>; 3],
    ) {
        self.turn_axes::<N>(topology, links.clone(), x);
        self.carry::<N>(topology, links, &x[0], |_| true);
    }

    /// Solves the equation of order n in block b: (24), with the right-hand sides in `demand` and `moves`. With the
    /// lower orders known it is one linear problem, `J u(n) = rhs`.
    #[inline(always)]
    pub fn solve<const N: usize>(&mut self, topology: &Topology, b: BlockId, linear: Linear<'_, T>) {
        let (block, Linear { x, l, factors, rhs }) = (&topology[b], linear);
        self.turn_axes::<N>(topology, block.link_ids(), x);
        self.turn_wrenches::<N>(topology, b, l);
        // First with zero unknowns: the residuals of the rows are the right-hand side.
        self.carry::<N>(topology, block.link_ids(), &x[0], |step| step.is_driven);
        // J u(n) = rhs,    J_ra = +- l_r . x_a (6),    rhs_r = demand_r - l_r . (U_j - U_i)  with the U of that pass
        for (k, &r) in block.selected.iter().enumerate() {
            rhs[k] = self.demand[r.0] - along(topology, &l[0], &self.twists[N], r);
        }
        factors[b.0].solve(rhs);
        for (k, &c) in block.unknowns.iter().enumerate() {
            self.speeds[N][c.0] = rhs[k];
        }
        // With u(n) the same pass gives U(n), on which all selected rows of the block agree.
        self.carry::<N>(topology, block.link_ids(), &x[0], |_| true);
        // D_j - D_i = U_j - U_i where no marker moves in its body; `DirectDifferentiation` adds z_j - z_i.
        if let Some(apart) = self.apart.get_mut(N) {
            for &c in &block.closures {
                let [i, j] = topology[c].bodies;
                apart[c.0] = self.twists[N][j.0] - self.twists[N][i.0];
            }
        }
    }
}

/// The n-th rate of a twist fixed in a body, from the lower rates and the twist V of the body with its rates:
/// `x(n) = sum_{m<n} C(n-1,m) ad(V(m)) x(n-1-m)`, (3) differentiated.
#[inline(always)]
pub(crate) fn carried<T: Real, const N: usize>(x: [Twist<T>; N], v: [Twist<T>; N]) -> Twist<T> {
    // C(n-1,0) ad(V) x(n-1) + C(n-1,1) ad(V.) x(n-2) + ...
    let mut rate = v[0].ad(x[N - 1]);
    for m in 1..N {
        rate += v[m].ad(x[N - 1 - m]) * T::constant(BINOMIAL[N - 1][m]);
    }
    rate
}

/// The n-th rates of a link's unit twists, each fixed in the frame before its freedom. `v` are the twist of the first
/// frame and its rates; those of the next frame are `V(m) + sum_{k=0..m} C(m,k) x(k) u(m-k)`.
#[inline(always)]
pub(crate) fn turn_twists<T: Real, const N: usize>(
    link: &Link,
    mut v: [Twist<T>; N],
    x: &mut [Vec<Twist<T>>; 3],
    speeds: &[Vec<T>; 3],
) {
    for (n, step) in link.steps.iter().enumerate() {
        for c in step.coordinates() {
            // For a single freedom the frame behind it gives the same result, since ad(x u) x = 0; the axes of a ball
            // are those of the frame before it.
            x[N][c.0] = carried(array(|m| x[m][c.0]), v);
        }
        if n + 1 == link.steps.len() {
            break;
        }
        for c in step.coordinates() {
            for m in 0..N {
                for k in (0..=m).rev() {
                    // V(m) behind the freedom = V(m) before it + (x u)(m),   (x u)(m) = sum_{k=0..m} C(m,k) x(k) u(m-k)
                    v[m] = x[k][c.0].times_plus(speeds[m - k][c.0] * BINOMIAL[m][k], v[m]);
                }
            }
        }
    }
}

/// `l_r . (U_j - U_i)`, summed over a coupler's terms.
#[inline(always)]
fn along<T: Real>(topology: &Topology, l: &[Wrench<T>], motion: &[Twist<T>], r: RowId) -> T {
    let mut sum = along_term(topology, l, motion, r);
    for &RowTerm { row, factor } in &topology[r].terms {
        sum += along_term(topology, l, motion, row) * T::constant(factor);
    }
    sum
}

/// The same of one term.
#[inline(always)]
fn along_term<T: Real>(topology: &Topology, l: &[Wrench<T>], motion: &[Twist<T>], r: RowId) -> T {
    let [i, j] = topology.closure_of(r).bodies;
    l[r.0].on(motion[j.0] - motion[i.0])
}

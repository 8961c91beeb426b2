//! One step: position by Newton's method, then velocity and acceleration from the same factors.
//!
//! This is the hot path. It is generic over its scalar, allocates nothing, and traverses the lists of [`Topology`]; the
//! sensitivities solve the same equation ([`Flow`]) with the same factors.
//!
//! Written in the symbols of `docs/theory.md`, a step for drivers at f, f., f.. is
//!
//! ```text
//! X_j = X_i M_i J(q) M_j^-1,    J dq = -phi  until phi = 0                                      (4), (6)
//! J q.  = f. in the rows of drivers, else 0                                                     (9)
//! J q.. = f.. - l. . (V_j - V_i) - l . (A_j - A_i  as if q.. were 0)                            (10)
//! ```
//!
//! This is the paper's `phi(Z, D, t) = 0` (5.1) at one time, with D fixed, and its first two time derivatives. The
//! paper's Z, poses of bodies, are `pose`; q are the coordinates of the tree, all six of every body in the absolute
//! formulation.

use crate::constraint::{MarkerPair, MarkerPairRates};
use crate::joint::Freedom;
use crate::linalg::{Factors, LARGEST_DENSE, Watched};
use crate::model::{Contact, CurvePiece, DriverId, GROUND, Model};
use crate::number::array;
use crate::space::{Pose, Quat, Real, Twist, Vec3, Wrench};
use crate::topology::{Block, BlockId, Closure, ClosureColumn, ClosureId, LinkId, RowId, RowTerm, Topology};

use super::level::{Flow, Linear, turn_twists};
use super::parts::PlanGeometry;

/// A correction below this (rad, or sizes) leaves an error of its square, which is round-off.
pub(super) const QUADRATIC: f64 = 1e-8;
/// A correction below this is round-off itself: nothing is applied.
pub(super) const ROUND_OFF: f64 = 1e-14;
/// Maximum number of Newton iterations; from a good prediction 1 to 3 are enough.
const MAX_ITERATIONS: usize = 12;
/// A pivot ratio below this is a singular position: velocities would lose all their digits.
const SINGULAR: f64 = 1e-12;

/// Results of one step.
#[derive(Clone, Debug)]
pub(crate) struct State<T> {
    /// Per coordinate: value (unused for balls).
    /// q of the theory: rad or m, from 0 in the design configuration; of j relative to i, whichever way the link runs.
    pub q: Vec<T>,
    /// Per coordinate that begins a ball: its rotation.
    /// J(q) of theory (4) as a unit quaternion, from the parent's marker to the child's.
    pub balls: Vec<Quat<T>>,
    /// Per body: the marker that places it, in the world.
    /// `X_p M_p J(q)` of its link; the paper's x"-y"-z" frame on the child.
    pub frame: Vec<Pose<T>>,
    /// Per body: pose.
    /// X = (A, r), the paper's x'-y'-z' frame: `X_p M_p J(q) M_c^-1` (4).
    pub pose: Vec<Pose<T>>,
    /// Motion at orders 0, 1, 2: speeds of the coordinates and twists V of the bodies, their accelerations, and their
    /// jerks. In theory q' and V, q'' and A = dV/dt, q''' and B = dA/dt: (9), (10), (21).
    pub motion: Flow<T>,
    /// Per order and coordinate: world unit twist x, and its first two time derivatives.
    /// `[n][a]`: x_a(n), a column of the Jacobian; rad, and m at the world origin, per unit of the coordinate.
    pub x: [Vec<Twist<T>>; 3],
    /// Per order and row: wrench l, and its first two time derivatives.
    /// `[n][r]`: l_r(n), a row of it; the rate of the row per unit twist of its body j.
    pub l: [Vec<Wrench<T>>; 3],
    /// Per closure: its markers in the world.
    /// `X_i M_i` and `X_j M_j`: P_i, a_i and P_j, b_j of the table in theory, section 2.
    pub ends: Vec<MarkerPair<T>>,
    /// Per block: `P J = L U`, J with rows `selected` and columns `unknowns`, where the position was solved last.
    pub factors: Vec<Factors<T>>,
    /// Right-hand side of a block.
    /// Before a solution the right-hand side, after it the unknowns: dq, q.(n), S(n).
    pub rhs: Vec<T>,
    /// Per row: residual at the last position at which the Jacobian was formed.
    /// phi, m or rad; (5) says how it changes.
    pub residual: Vec<T>,
    /// Per row of a coupler's term: approximate value of its coordinate, to count whole turns of angles.
    pub near: Vec<T>,
    /// Per row: residual phi_0 in the design configuration. Its remaining fraction 1 - s, with its rate by s: an
    /// assembly solves `phi - (1 - s) phi_0 = 0` from s = 0 to 1.
    pub gap: Vec<T>,
    pub gap_left: [f64; 2],
    /// Per curve: contact of its follower.
    /// u, and C with its derivatives by u.
    pub contacts: Vec<Contact<T>>,
    /// Per curve: its piece at the contact, if the parameter is an unknown that is corrected with the coordinates: a
    /// recording cannot search for the contact. Empty otherwise.
    pub pieces: Vec<CurvePiece<T>>,
    /// Per block: smallest over largest pivot, and the sign of the determinant.
    pub pivots: Vec<(f64, bool)>,
    /// Per block: its determinant, to be compared by [`Factors::ratio`].
    /// abs(det J), or its logarithm where the factors are sparse.
    pub determinants: Vec<T>,
    /// Per block: monitored quantities of its factors.
    pub watched: Vec<Watched<T>>,
    /// Per block: its first, second and last correction, rad or sizes, and the number of passes.
    pub corrections: Vec<([T; CORRECTIONS], usize)>,
    pub iterations: usize,
}

/// Number of corrections whose sizes are recorded separately.
pub(super) const CORRECTIONS: usize = 3;

/// Largest residuals of the constraints.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Residuals {
    /// Largest residual, m or rad.
    pub largest: f64,
    /// Largest residual, sizes or rad.
    pub scaled: f64,
}

/// Reason why a position was not found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PositionFailure {
    /// The Jacobian of this block is singular.
    Singular { block: BlockId },
    /// Newton's method did not converge, or its first correction exceeds the trusted range of the prediction.
    NoConvergence { block: BlockId },
}

impl State<f64> {
    /// Places the bodies, and every contact where it is at these coordinates, anywhere on its curve; `closed` is the
    /// largest residual, in sizes, of a contact that is closed.
    pub fn find_contacts(&mut self, topology: &Topology, parts: &PlanGeometry<f64>, closed: f64) {
        self.place(topology, parts, topology.link_ids());
        let contact = |(c, k): (ClosureId, usize)| {
            let [i, j] = topology[c].bodies;
            let carrier = self.frame[i.0].compose(parts.ends[0][c.0]);
            let p = carrier.inverse().point(self.frame[j.0].point(parts.ends[1][c.0].r));
            // The one row of such a joint keeps the distance from the curve.
            let (curve, r) = (&parts.curves[k], topology[c].first_row);
            Contact::at(curve, curve.contact([p.x, p.y], parts.kept[r.0], closed * topology[r].unit))
        };
        self.contacts = topology.contacts().map(contact).collect();
    }
}

impl<T: Real> State<T> {
    /// State in the design configuration.
    pub fn new(model: &Model, topology: &Topology) -> Self {
        let (n, o) = (topology.coordinates.len(), T::zero());
        let frame = Pose::IDENTITY.spread();
        let rows = topology.rows.len();
        let bodies = model.bodies.len();
        let widest = topology.blocks.iter().map(|b| b.unknowns.len()).max().unwrap_or(0);
        Self {
            q: vec![o; n],
            balls: vec![Quat::IDENTITY.spread(); n],
            frame: vec![frame; bodies],
            pose: vec![frame; bodies],
            motion: Flow::new(topology, bodies, true),
            x: std::array::from_fn(|_| vec![Twist::zero(); n]),
            l: std::array::from_fn(|_| vec![Wrench::zero(); rows]),
            ends: vec![MarkerPair { i: frame, j: frame, axes: frame.rot }; topology.closures.len()],
            factors: topology.blocks.iter().map(|b| factors_of(topology, b, LARGEST_DENSE)).collect(),
            rhs: vec![o; widest],
            residual: vec![o; rows],
            near: vec![o; rows],
            gap: vec![o; rows],
            gap_left: [0.0; 2],
            contacts: Vec::new(),
            pieces: Vec::new(),
            pivots: vec![(1.0, true); topology.blocks.len()],
            determinants: vec![o; topology.blocks.len()],
            watched: vec![Watched::zero(); topology.blocks.len()],
            corrections: vec![([o; CORRECTIONS], 0); topology.blocks.len()],
            iterations: 0,
        }
    }

    /// Places the children of these links and their unit twists (`docs/theory.md` (4)).
    #[inline(always)]
    pub(super) fn place(
        &mut self,
        topology: &Topology,
        parts: &PlanGeometry<T>,
        links: impl Iterator<Item = LinkId>,
    ) {
        for k in links {
            let link = &topology[k];
            let marker = parts.parent_marker[k.0];
            let on_ground = link.parent == GROUND;
            let mut frame = if on_ground { marker } else { self.frame[link.parent.0].compose(marker) };
            for step in &link.steps {
                // x = [h; c x h] of a turn about h through c, [0; h] of a slide along h, times -1 where the link runs
                // from j to i
                for (n, c) in step.coordinates().enumerate() {
                    self.x[0][c.0] = step.twist(n, &frame.rot, frame.r);
                }
                let q = self.q[step.first.0] * T::constant(step.sign);
                // J(q): a turn about its own axis, R <- R Rot(axis, q); a slide, r <- r + q h; a ball, R <- R
                // A(quaternion)
                match step.freedom {
                    Freedom::Turn(axis) => {
                        let (sin, cos) = q.sin_cos();
                        frame.rot = frame.rot.turned(axis, sin, cos);
                    }
                    Freedom::Slide(axis) => frame.r = frame.rot.cols[axis].times_plus(q, frame.r),
                    Freedom::Ball => frame.rot = frame.rot * self.balls[step.first.0].rotation(),
                }
            }
            self.frame[link.child.0] = frame;
        }
    }

    /// Poses of the bodies, from the markers that place them.
    #[inline(always)]
    pub(super) fn place_bodies(
        &mut self,
        topology: &Topology,
        parts: &PlanGeometry<T>,
        links: impl Iterator<Item = LinkId>,
    ) {
        for k in links {
            let child = topology[k].child.0;
            // X_c = (X_p M_p J(q)) M_c^-1                                                                         (4)
            self.pose[child] = self.frame[child].compose(parts.child_from_marker[k.0]);
        }
    }

    /// Markers of a closure in the world.
    #[inline(always)]
    pub(super) fn place_ends(&mut self, topology: &Topology, parts: &PlanGeometry<T>, c: ClosureId) {
        let [i, j] = topology[c].bodies;
        let (m_i, m_j) = (parts.ends[0][c.0], parts.ends[1][c.0]);
        let ends = &mut self.ends[c.0];
        // P_i, P_j and the axes a_i, b_j of the rows: X_i M_i and X_j M_j, seen from the markers that place the bodies
        (ends.i, ends.j) = (self.frame[i.0].compose(m_i), self.frame[j.0].compose(m_j));
        self.turn_base(topology, parts, c);
        if let Some(k) = topology[c].contact {
            self.touch(parts, c, k);
        }
    }

    /// Updates the points of a closure's markers alone.
    #[inline(always)]
    fn place_end_points(&mut self, topology: &Topology, parts: &PlanGeometry<T>, c: ClosureId) {
        let [i, j] = topology[c].bodies;
        let (m_i, m_j) = (parts.ends[0][c.0], parts.ends[1][c.0]);
        let ends = &mut self.ends[c.0];
        (ends.i.r, ends.j.r) = (self.frame[i.0].point(m_i.r), self.frame[j.0].point(m_j.r));
        self.turn_base(topology, parts, c);
    }

    /// Updates the axes of the base body of a closure's loop.
    #[inline(always)]
    fn turn_base(&mut self, topology: &Topology, parts: &PlanGeometry<T>, c: ClosureId) {
        let Closure { base, base_link, .. } = topology[c];
        if base != GROUND {
            self.ends[c.0].axes = match base_link {
                // Its pose is that of the last step until the block is solved: wrenches along those axes would not
                // match their rates.
                Some(k) => self.frame[base.0].rot * parts.child_from_marker[k.0].rot,
                None => self.pose[base.0].rot,
            };
        }
    }

    /// Moves marker i of a closure along its curve to the point nearest to marker j.
    #[inline(never)]
    fn touch(&mut self, parts: &PlanGeometry<T>, c: ClosureId, k: usize) {
        let MarkerPair { i, j, .. } = self.ends[c.0];
        // p = P_j in axes of marker i; u is the foot of the perpendicular on the curve, (p - C(u)) . C'(u) = 0. Marker
        // i moves there, with x along C'.
        let p = i.inverse().point(j.r);
        self.contacts[k] = match self.pieces.get(k) {
            Some(piece) => self.contacts[k].corrected(piece, p),
            None => Contact::follow(&parts.curves[k], p, self.contacts[k].u),
        };
        self.ends[c.0].i = i.compose(self.contacts[k].frame());
    }

    /// Rates of a marker i that moves along its curve: those of its body plus its own rotation.
    #[inline(never)]
    pub fn walk(&self, c: ClosureId, k: usize, rates: &MarkerPairRates<T>) -> MarkerPairRates<T> {
        let (v, (z, p)) = (rates.v_i, self.follower(c, k, rates));
        let [turn, turn_rate] = self.contacts[k].turning(p);
        // omega of the moving marker = omega_i + (k u.) z,    its rate = alpha_i + (k u.). z + omega_i x z (k u.).
        // The row is a Dot-2 and uses only an axis of marker i, so the angular parts are enough.
        let mut walking = *rates;
        walking.v_i.w += z * turn;
        walking.a_i.w += z * turn_rate + v.w.cross(z) * turn;
        walking
    }

    /// z axis of the marker that carries curve k, and its follower relative to that marker, with first two rates.
    #[inline(always)]
    fn follower(&self, c: ClosureId, k: usize, rates: &MarkerPairRates<T>) -> (Vec3<T>, [Vec3<T>; 3]) {
        let MarkerPair { i: foot, j, .. } = &self.ends[c.0];
        let (v, a, contact) = (rates.v_i, rates.a_i, &self.contacts[k]);
        // The marker that carries the curve, and the motion of the follower relative to it.
        let i = foot.compose(contact.frame().inverse());
        // p.  = A_i^T (v_j - v_i),    p.. = A_i^T (a_j - a_i - 2 omega_i x (v_j - v_i)),  with A_i the axes of that
        // marker, and v and a of the points of both bodies at P_j:  v = V at P_j,  a = V. at P_j + omega x v
        let relative = rates.v_j.at(j.r) - v.at(j.r);
        let acceleration = |v: Twist<T>, a: Twist<T>| a.at(j.r) + v.w.cross(v.at(j.r));
        let coriolis = v.w.cross(relative) * T::constant(2.0);
        let second = acceleration(rates.v_j, rates.a_j) - acceleration(v, a) - coriolis;
        let p = [i.inverse().point(j.r), i.rot.transpose_mul(relative), i.rot.transpose_mul(second)];
        (i.rot.cols[2], p)
    }

    /// First two rates of the parameter of curve k, which closure c follows.
    pub(super) fn sliding(&self, topology: &Topology, c: ClosureId, k: usize) -> [T; 2] {
        let ([v, a, _], [i, j]) = (&self.motion.twists, topology[c].bodies);
        let rates = MarkerPairRates { v_i: v[i.0], v_j: v[j.0], a_i: a[i.0], a_j: a[j.0] };
        self.contacts[k].sliding(self.follower(c, k, &rates).1)
    }

    /// Residual of constraint row r.
    #[inline(always)]
    pub(super) fn residual(
        &self,
        topology: &Topology,
        parts: &PlanGeometry<T>,
        drivers: &[[T; 3]],
        r: RowId,
    ) -> T {
        let place = &topology[r];
        let closure = &topology[place.closure];
        let (row, ends) = (closure.rows[place.index], &self.ends[place.closure.0]);
        let gap = self.gap[r.0] * T::constant(self.gap_left[0]);
        if place.terms.is_empty() {
            let driven = closure.driver.map_or(T::zero(), |d| drivers[d.0][0]);
            // phi = measured value - constant - f - (1 - s) phi_0
            row.residual(ends, parts.kept[r.0] + driven) - gap
        } else {
            self.coupled(topology, parts, r) - gap
        }
    }

    /// Updates all poses from the coordinates and the values of the drivers.
    #[inline(never)]
    pub fn stand(&mut self, topology: &Topology, parts: &PlanGeometry<T>) {
        self.place(topology, parts, topology.link_ids());
        self.place_bodies(topology, parts, topology.link_ids());
        for c in topology.closure_ids() {
            self.place_ends(topology, parts, c);
        }
    }

    /// [`State::residual`] for callers that are not time-critical.
    #[inline(never)]
    pub fn residual_of(
        &self,
        topology: &Topology,
        parts: &PlanGeometry<T>,
        drivers: &[[T; 3]],
        r: RowId,
    ) -> T {
        self.residual(topology, parts, drivers, r)
    }

    /// Residual of a coupler: the sum of its terms. It is not inlined, because other rows are far more frequent.
    #[inline(never)]
    fn coupled(&self, topology: &Topology, parts: &PlanGeometry<T>, r: RowId) -> T {
        let mut sum = T::zero();
        for RowTerm { row, factor } in topology.parts_of_row(r) {
            // phi = sum c_k chi_k, each chi_k measured from its design value
            let value = self.value(topology, row) - parts.kept[row.0];
            sum += value * T::constant(factor);
        }
        sum
    }

    /// Value of the coordinate that a row constrains.
    #[inline(always)]
    fn value(&self, topology: &Topology, r: RowId) -> T {
        topology.constraint(r).value(&self.ends[topology[r].closure.0], self.near[r.0])
    }

    /// Fills row k of the block's Jacobian with a coupler, row r, the sum of its terms.
    #[inline(never)]
    fn enter_coupler(&mut self, topology: &Topology, b: BlockId, k: usize, r: RowId) {
        let place = &topology[r];
        for term in &place.terms {
            self.l[0][term.row.0] = self.wrench_of(topology, term.row);
        }
        let (l, x, zero) = (&self.l[0], &self.x[0], T::zero());
        let entries = place.columns.iter().map(|c| {
            let mut sum = zero;
            // J_ra = sum over the terms of +- c_k l_k . x_a                                                       (6)
            for &RowTerm { row, factor } in &c.parts {
                sum += l[row.0].on(x[c.coordinate.0]) * T::constant(factor);
            }
            (c.column, sum)
        });
        self.factors[b.0].set_row(k, entries, zero);
    }

    /// Wrench of a row at the current position of its markers.
    #[inline(never)]
    pub(super) fn wrench_of(&self, topology: &Topology, r: RowId) -> Wrench<T> {
        topology.constraint(r).wrench(&self.ends[topology[r].closure.0])
    }

    /// Computes residuals, wrenches and factors of block b at the current position.
    #[inline(always)]
    pub(super) fn linearise(
        &mut self,
        topology: &Topology,
        parts: &PlanGeometry<T>,
        drivers: &[[T; 3]],
        b: BlockId,
    ) {
        let block: &Block = &topology[b];
        for &c in &block.closures {
            if topology[c].solved_by_points {
                self.place_end_points(topology, parts, c);
            } else {
                self.place_ends(topology, parts, c);
            }
        }
        let zero = T::zero();
        for (k, &r) in block.selected.iter().enumerate() {
            let residual = self.residual(topology, parts, drivers, r);
            // J dq = -phi
            (self.residual[r.0], self.rhs[k]) = (residual, -residual);
            let place = &topology[r];
            let closure = &topology[place.closure];
            let wrench = closure.rows[place.index].wrench(&self.ends[place.closure.0]);
            self.l[0][r.0] = wrench;
            if place.terms.is_empty() {
                // J_ra = +- l_r . x_a, by the side of the loop on which a is                                        (6)
                let x = &self.x[0];
                let entries = closure.entries.iter().map(
                    #[inline(always)]
                    |e: &ClosureColumn| (e.column, wrench.on(x[e.coordinate.0]) * T::constant(e.side)),
                );
                self.factors[b.0].set_row(k, entries, zero);
            } else {
                self.enter_coupler(topology, b, k, r);
            }
        }
        let found = self.factors[b.0].factor();
        self.pivots[b.0] = (found.pivot_ratio, found.positive);
        self.determinants[b.0] = found.determinant;
        self.watched[b.0] = found.watched;
    }

    /// Solves position, velocity and acceleration of all bodies for the drivers' values and their derivatives, from the
    /// prediction in `q` and `balls`; block by block, so that the data of a block are still in the cache for its rates.
    ///
    /// `trust` bounds the first correction (rad, or sizes): a longer one may land on another branch.
    pub fn solve(
        &mut self,
        topology: &Topology,
        parts: &PlanGeometry<T>,
        drivers: &[[T; 3]],
        trust: f64,
    ) -> Result<(), PositionFailure> {
        for (c, d) in topology.driven_coordinates() {
            // q, q., q.. = f, f., f.. of driven coordinates in the tree
            [self.q[c.0], self.motion.speeds[0][c.0], self.motion.speeds[1][c.0]] = drivers[d.0];
        }
        self.place(topology, parts, topology.driven_links());
        self.place_bodies(topology, parts, topology.driven_links());
        self.rates_of_driven(topology);
        for b in topology.block_ids() {
            // Block after block: J is block lower triangular, so the bodies that a block depends on are solved.
            self.newton(topology, parts, drivers, b, trust)?;
            self.place_bodies(topology, parts, topology[b].link_ids());
            self.rates_of_block(topology, parts, drivers, b);
        }
        for (c, closure) in ClosureId::each(&topology.closures) {
            // Closures between bodies that drivers alone place: no unknown moves them, and their rows are monitored.
            if closure.block.is_none() {
                self.place_ends(topology, parts, c);
                self.finish_closure(topology, c);
                self.rates_of_wrenches(topology, c, 1);
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn newton(
        &mut self,
        topology: &Topology,
        parts: &PlanGeometry<T>,
        drivers: &[[T; 3]],
        b: BlockId,
        trust: f64,
    ) -> Result<(), PositionFailure> {
        let links = topology[b].link_ids();
        let mut before = trust;
        for pass in 0..MAX_ITERATIONS {
            self.place(topology, parts, links.clone());
            self.linearise(topology, parts, drivers, b);
            self.iterations += 1;
            self.corrections[b.0].1 = pass + 1;
            if !(self.pivots[b.0].0 > SINGULAR) {
                return Err(PositionFailure::Singular { block: b });
            }
            if before <= QUADRATIC {
                return Ok(());
            }
            // dq = -J^-1 phi; every further one is about the square of the one before (theory (26)).
            self.factors[b.0].solve(&mut self.rhs);
            let corrections = self.correction(topology, b);
            self.corrections[b.0].0[pass.min(CORRECTIONS - 1)] = corrections;
            let correction = corrections.decisive();
            // abs(dq) <= 1e-14: q is solved, and the factors are those of q.
            if correction <= ROUND_OFF {
                return Ok(());
            }
            // NaN fails. The corrections must contract; the first must be within trust.
            if !(correction <= before) {
                return Err(PositionFailure::NoConvergence { block: b });
            }
            self.apply(topology, b);
            // abs(dq_k+1) <= abs(dq_k) / 2. After abs(dq) <= 1e-8 the error, its square, is round-off: one more pass is
            // only for the factors.
            before = if correction <= QUADRATIC { correction } else { 0.5 * correction };
        }
        Err(PositionFailure::NoConvergence { block: b })
    }

    /// Largest component of the correction in `rhs`, lengths in sizes of their loops.
    #[inline(always)]
    fn correction(&self, topology: &Topology, b: BlockId) -> T {
        let mut most = T::zero();
        for (k, &c) in topology[b].unknowns.iter().enumerate() {
            // max abs(dq_a) / unit_a
            most = most.larger((self.rhs[k] * T::constant(topology[c].per_unit)).abs());
        }
        most
    }

    /// Adds the correction in `rhs` to the unknowns of block b.
    #[inline(always)]
    pub(super) fn apply(&mut self, topology: &Topology, b: BlockId) {
        for (k, &c) in topology[b].unknowns.iter().enumerate() {
            // q <- q + dq, of a ball dq about the axes of its parent's marker
            self.q[c.0] += self.rhs[k];
        }
        self.turn_balls(topology, topology[b].link_ids());
    }

    /// Applies the increments in the `q` of balls to their rotations.
    #[inline(always)]
    pub fn turn_balls(&mut self, topology: &Topology, links: impl Iterator<Item = LinkId>) {
        let zero = T::zero();
        for link in links {
            for step in topology[link].steps.iter().filter(|s| s.freedom == Freedom::Ball) {
                let k = step.first.0;
                let d = Vec3::new(self.q[k], self.q[k + 1], self.q[k + 2]);
                // quaternion <- (1, d/2) quaternion, normalised
                self.balls[k] = self.balls[k].nudged(d);
                self.q[k..k + 3].fill(zero);
            }
        }
    }

    /// Solves velocity and acceleration of the bodies that drivers alone place.
    #[inline(always)]
    fn rates_of_driven(&mut self, topology: &Topology) {
        // q, q., q.. = f, f., f..:  V_c = V_p + sum x q.,  then x. and  A_c = A_p + sum (x q.. + x. q.)       (9), (10)
        let links = topology.driven_links();
        self.motion.follow::<0>(topology, links.clone(), &self.x);
        self.rates_of_twists::<1>(topology, links.clone());
        self.motion.follow::<1>(topology, links, &self.x);
    }

    /// Solves velocity and acceleration of the bodies of block b, with the factors of its position (`docs/theory.md`
    /// (9), (10)).
    #[inline(always)]
    fn rates_of_block(
        &mut self,
        topology: &Topology,
        parts: &PlanGeometry<T>,
        drivers: &[[T; 3]],
        b: BlockId,
    ) {
        let block = &topology[b];
        for &c in &block.closures {
            let closure = &topology[c];
            if closure.solved_by_points && closure.has_axes {
                self.place_ends(topology, parts, c);
            }
            self.finish_closure(topology, c);
        }
        // J q. = f.                                                                                           (9)
        self.solve_order::<0>(topology, b, |d| drivers[d.0][1]);
        self.rates_of_twists::<1>(topology, block.link_ids());
        for &c in &block.closures {
            self.rates_of_wrenches(topology, c, 1);
        }
        // J q.. = f.. - l. . (V_j - V_i) - l . (A_j - A_i as if q.. were 0), with the x. and l. of this V        (10)
        self.solve_order::<1>(topology, b, |d| drivers[d.0][2]);
    }

    /// Solves velocity, acceleration or jerk of the bodies of block b: (24) of `docs/theory.md` with U = V, u = q. and
    /// z = 0. In the row of a driver f is its speed, and `demand` its n-th rate; in all other rows f is the rate of the
    /// gap while an assembly closes it.
    #[inline(always)]
    fn solve_order<const N: usize>(
        &mut self,
        topology: &Topology,
        b: BlockId,
        demand: impl Fn(DriverId) -> T,
    ) {
        let Self { x, l, factors, rhs, motion, gap, gap_left, .. } = self;
        for &c in &topology[b].closures {
            let closure = &topology[c];
            motion.ask(topology, c, closure.driver.map_or(T::zero(), &demand));
            for r in closure.row_ids().filter(|_| N == 0) {
                // phi - (1 - s) phi_0 = 0 along s: l . (V_j - V_i) = -phi_0, with gap_left[1] = d(1 - s)/ds = -1; no
                // higher order
                motion.demand[r.0] += gap[r.0] * T::constant(gap_left[1]);
            }
        }
        motion.solve::<N>(topology, b, Linear { x, l, factors, rhs });
    }

    /// Solves velocity and acceleration of all bodies at the current position, and first and second rates of all twists
    /// and wrenches, for driver speeds other than those that the position was solved with. The speeds of driven
    /// coordinates are in `motion`.
    #[inline(never)]
    pub(super) fn all_rates(&mut self, topology: &Topology, parts: &PlanGeometry<T>, drivers: &[[T; 3]]) {
        self.rates_of_driven(topology);
        for b in topology.block_ids() {
            self.rates_of_block(topology, parts, drivers, b);
        }
        self.rates_of_twists::<2>(topology, topology.link_ids());
        for &c in topology.blocks.iter().flat_map(|b| &b.closures) {
            self.rates_of_wrenches(topology, c, 2);
        }
    }

    /// Sets position, velocity and acceleration from given coordinates, speeds and accelerations, at a change point.
    /// Results that use the factors of singular blocks are NaN there.
    pub(super) fn stand_with_rates(
        &mut self,
        topology: &Topology,
        parts: &PlanGeometry<T>,
        drivers: &[[T; 3]],
        singular: &[BlockId],
    ) {
        for (c, d) in topology.driven_coordinates() {
            [self.q[c.0], self.motion.speeds[0][c.0], self.motion.speeds[1][c.0]] = drivers[d.0];
        }
        self.stand_with_factors(topology, parts, drivers);
        self.rates_of_driven(topology);
        for b in topology.block_ids() {
            let links = topology[b].link_ids();
            self.motion.follow::<0>(topology, links.clone(), &self.x);
            self.rates_of_twists::<1>(topology, links.clone());
            for &c in &topology[b].closures {
                self.rates_of_wrenches(topology, c, 1);
            }
            self.motion.follow::<1>(topology, links, &self.x);
        }
        let nan = T::constant(f64::NAN);
        for &r in singular.iter().flat_map(|b| &topology[*b].selected) {
            let none = Vec3::new(nan, nan, nan);
            self.l[0][r.0] = Wrench { m: none, f: none };
        }
    }

    /// Sets the bodies from given coordinates, with the wrenches of all rows and the factors of all blocks there.
    pub fn stand_with_factors(&mut self, topology: &Topology, parts: &PlanGeometry<T>, drivers: &[[T; 3]]) {
        self.stand(topology, parts);
        for r in RowId::all(0..topology.rows.len()) {
            self.l[0][r.0] = self.wrench_of(topology, r);
        }
        for b in topology.block_ids() {
            self.linearise(topology, parts, drivers, b);
        }
    }

    /// Solves the jerks of all bodies at the current position, velocity and acceleration, for those of the drivers.
    pub(super) fn jerk(&mut self, topology: &Topology, demand: impl Fn(DriverId) -> T) {
        self.finish_rates(topology);
        for (c, d) in topology.driven_coordinates() {
            self.motion.speeds[2][c.0] = demand(d);
        }
        self.motion.follow::<2>(topology, topology.driven_links(), &self.x);
        for b in topology.block_ids() {
            self.solve_order::<2>(topology, b, &demand);
        }
    }

    /// Linear equations of this position.
    #[inline(always)]
    pub fn linear(&mut self) -> Linear<'_, T> {
        let Self { x, l, factors, rhs, .. } = self;
        Linear { x, l, factors, rhs }
    }

    /// Computes the data for sensitivities: second derivatives of twists and wrenches, and the rates of all redundant
    /// rows.
    pub fn finish_rates(&mut self, topology: &Topology) {
        self.finish_wrenches(topology);
        self.rates_of_twists::<2>(topology, topology.link_ids());
        for c in topology.closure_ids() {
            self.rates_of_wrenches(topology, c, 2);
        }
    }

    /// Computes the wrenches of the redundant rows.
    pub fn finish_wrenches(&mut self, topology: &Topology) {
        for (r, _) in RowId::each(&topology.rows).filter(|(_, p)| !p.has_wrench()) {
            self.l[0][r.0] = self.wrench_of(topology, r);
        }
    }

    /// Wrenches of the rows of a closure that are terms of couplers.
    #[inline(always)]
    fn finish_closure(&mut self, topology: &Topology, c: ClosureId) {
        for (r, row) in topology[c].numbered_rows() {
            if topology[r].has_wrench() && !topology[r].selected {
                self.l[0][r.0] = row.wrench(&self.ends[c.0]);
            }
        }
    }

    /// Largest residuals over all rows, redundant ones included.
    pub fn residuals(&self, topology: &Topology, parts: &PlanGeometry<T>, drivers: &[[T; 3]]) -> Residuals {
        let [largest, scaled] = self.largest_residuals(topology, parts, drivers);
        Residuals { largest: largest.decisive(), scaled: scaled.decisive() }
    }

    /// Largest residuals in m or rad, and in sizes or rad.
    pub fn largest_residuals(
        &self,
        topology: &Topology,
        parts: &PlanGeometry<T>,
        drivers: &[[T; 3]],
    ) -> [T; 2] {
        let zero = T::zero();
        let (mut largest, mut scaled) = (zero, zero);
        for (r, place) in RowId::each(&topology.rows) {
            if place.is_term {
                continue;
            }
            let residual = if place.selected {
                self.residual[r.0].abs()
            } else {
                self.residual_of(topology, parts, drivers, r).abs()
            };
            largest = largest.larger(residual);
            scaled = scaled.larger(residual * T::constant(1.0 / place.unit));
        }
        [largest, scaled]
    }

    /// Row with the largest residual, and that residual.
    pub fn worst_row(
        &self,
        topology: &Topology,
        parts: &PlanGeometry<T>,
        drivers: &[[T; 3]],
    ) -> (RowId, f64) {
        let mut worst = (RowId(0), 0.0, 0.0);
        for (r, place) in RowId::each(&topology.rows).filter(|(_, p)| !p.is_term) {
            let residual = self.residual_of(topology, parts, drivers, r).abs().decisive();
            let scaled = residual / place.unit;
            // NaN counts as the largest.
            if !(scaled <= worst.1) {
                worst = (r, scaled, residual);
            }
        }
        (worst.0, worst.2)
    }

    /// The coordinate that a coupler's term counts, with its speed and acceleration.
    pub fn coordinate_of_row(&self, topology: &Topology, r: RowId) -> [T; 3] {
        let [i, j] = topology.closure_of(r).bodies;
        // chi. = l . (V_j - V_i),    chi.. = l . (A_j - A_i) + l. . (V_j - V_i)
        let apart = |n: usize| self.motion.twists[n][j.0] - self.motion.twists[n][i.0];
        let (v, a) = (apart(0), apart(1));
        let (l, l_rate) = (self.l[0][r.0], self.l[1][r.0]);
        [self.value(topology, r), l.on(v), l.on(a) + l_rate.on(v)]
    }

    /// Constraint row r of the Jacobian, by column of its block, lengths in sizes.
    #[inline(always)]
    pub fn scaled_row(&self, topology: &Topology, r: RowId, out: &mut [T]) {
        let scale = 1.0 / topology[r].unit;
        let zero = T::zero();
        out.fill(zero);
        for RowTerm { row, factor } in topology.parts_of_row(r) {
            for &ClosureColumn { column, coordinate: c, side } in &topology.closure_of(row).entries {
                let unit = topology[c].unit;
                out[column] +=
                    // (6), dimensionless: row and coordinate divided by their units
                    self.l[0][row.0].on(self.x[0][c.0]) * T::constant(scale * unit * side * factor);
            }
        }
    }

    /// The n-th time derivatives of the unit twists of these links.
    #[inline(always)]
    fn rates_of_twists<const N: usize>(&mut self, topology: &Topology, links: impl Iterator<Item = LinkId>) {
        let Flow { speeds, twists, .. } = &self.motion;
        for k in links {
            let link = &topology[k];
            if !link.has_constant_twist() {
                // x(n) = sum_{m<n} C(n-1,m) ad(V(m)) x(n-1-m), V of the parent first
                let v: [Twist<T>; N] = array(|n| twists[n][link.parent.0]);
                turn_twists(link, v, &mut self.x, speeds);
            }
        }
    }

    /// First time derivative of the wrenches that the motion needs, or all derivatives that sensitivities need.
    #[inline(always)]
    fn rates_of_wrenches(&mut self, topology: &Topology, c: ClosureId, order: usize) {
        let closure = &topology[c];
        let ([v, a, _], [i, j]) = (&self.motion.twists, closure.bodies);
        let mut rates = MarkerPairRates { v_i: v[i.0], v_j: v[j.0], a_i: a[i.0], a_j: a[j.0] };
        if let Some(k) = closure.contact {
            rates = self.walk(c, k, &rates);
        }
        for (r, row) in closure.numbered_rows() {
            // l., l.. by the product rule from the markers' first two rates, (3) for their axes and v = V at P for
            // their points
            if order > 1 {
                [self.l[1][r.0], self.l[2][r.0]] = row.wrench_rates(&self.ends[c.0], &rates);
            } else if topology[r].has_wrench() {
                [self.l[1][r.0], _] = row.wrench_rates(&self.ends[c.0], &rates);
            }
        }
    }
}

/// Memory for the factors of a block with its selected rows.
pub(crate) fn factors_of<T: Real>(topology: &Topology, block: &Block, largest_dense: usize) -> Factors<T> {
    let columns = |k: usize| {
        let place = &topology[block.selected[k]];
        if place.terms.is_empty() {
            topology[place.closure].entries.iter().map(|e| e.column).collect()
        } else {
            place.columns.iter().map(|c| c.column).collect()
        }
    };
    Factors::new(block.selected.len(), columns, largest_dense)
}

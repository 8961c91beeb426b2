//! Proven bounds of a motion between two times.
//!
//! Over an interval of time T, X is a box of the unknown coordinates of a block, m its middle, and Y about the inverse
//! of the Jacobian there. If
//!
//! ```text
//! K(X) = m - Y phi(m, T) + (I - Y J(X)) (X - m)
//! ```
//!
//! in interval arithmetic is inside of X, then exactly one position in X belongs to each time of T, and K(X) contains
//! it (Krawczyk). `phi(m, T)` is bounded by `phi(m, t) + phi_t(m, T) (T - t)`, too, with t the middle of T. The rates
//! follow from the rates of the rows: with `k = |I - Y J(X)| < 1`,
//!
//! ```text
//! J(X) q. in -phi_t(X, T):    |q.| <= |Y phi_t| / (1 - k),    then    q. := -Y phi_t + (I - Y J(X)) q.
//! ```
//!
//! and q.. and q... likewise. No equation is written for this: residuals and poses are those of `kinematics.rs`, over
//! intervals, over duals of them (a column of J for each unknown), and over jets of them (phi_t, and the rates of all
//! bodies). The coordinates of a ball are those of its correction in Newton's method, from its rotation at the middle
//! of T.
//!
//! The excess of these bounds is of first order in the length of T. By Taylor's theorem,
//! `f(T) in f(t) + f.(t) (T - t) + f..(T) (T - t)^2 / 2` with the narrow bounds at the middle t of T: that of positions
//! is then of third order. With the jerk, likewise, that of speeds is of third and that of accelerations of second.
//!
//! The proof holds for the mechanism whose geometry is that of the solver, to the last bit, and whose laws are the
//! formulas of their numbers. Rows that are redundant and not selected have no part in it.

use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

use crate::law::TimeJet;
use crate::linalg::LARGEST_DENSE;
use crate::model::{DriverId, JointId, Model};
use crate::number::{self, Interval, Jet};
use crate::space::{Mat3, Pose, Quat, Real, Vec3};
use crate::topology::{BlockId, CoordinateId, Topology};

use super::advance::expected_move;
use super::contraction::{
    BlockSolver, CONTRACTION, Contracted, Contraction, LEAST_BOX, SLACK, inverse_of, is_within,
};
use super::mechanism::{AcceptedPosition, Mechanism};
use super::parts::PlanGeometry;
use super::path::Path;
use super::path_step::trust;

/// Maximum number of halvings of a step from one position to another: a 64th is far shorter than any step of a motion.
const MOST_STEP_HALVINGS: u32 = 6;
/// Number of times that an interval is halved, and the bounds of its parts are joined, where it is too long for one
/// box: eight parts have the cost of eight intervals, but their bounds serve as those of one.
const MOST_HALVINGS: usize = 3;
/// Number of passes that narrow boxes and rates with each other, at most.
const MOST_PASSES: usize = 8;
/// A pass that leaves more than this part of the width of the accelerations is the last one.
const WORTHWHILE: f64 = 0.7;

/// Reason why nothing is proved of a motion over an interval of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TubeFailure {
    /// The joint follows a curve, which is not a formula over intervals.
    FollowsCurve {
        /// The joint.
        joint: JointId,
    },
    /// The block has too many unknowns for dense matrices of intervals.
    TooLarge {
        /// The block.
        block: BlockId,
    },
    /// The law of the driver is undefined in the interval.
    Law {
        /// The driver.
        driver: DriverId,
    },
    /// No box contracts: the interval is too long, or a singular position is too near.
    NoContraction {
        /// The block.
        block: BlockId,
    },
    /// No position was found at a time within the interval.
    NotSolved {
        /// The time, s.
        time: f64,
    },
    /// The position at an end of the interval is not in the box: it belongs to another branch.
    OtherBranch {
        /// The time of that end, s.
        time: f64,
    },
}

impl TubeFailure {
    /// True if a shorter interval may succeed.
    pub fn may_be_halved(self) -> bool {
        match self {
            Self::FollowsCurve { .. } | Self::TooLarge { .. } => false,
            Self::Law { .. }
            | Self::NoContraction { .. }
            | Self::NotSolved { .. }
            | Self::OtherBranch { .. } => true,
        }
    }
}

/// Bounds of a motion over an interval of time, or at one time.
#[derive(Clone, Debug)]
pub(crate) struct Enclosure {
    /// The interval of time.
    pub over: Interval,
    /// Per body: bounds of its pose and of its first three rates. Rates are unbounded if those of a law are.
    pub poses: Vec<Pose<TimeJet<Interval>>>,
    /// The time at which the coordinates of balls are zero.
    pub middle: f64,
    /// Per coordinate that begins a ball: its rotation at that time, nearly.
    centres: Rc<Vec<Quat>>,
    /// Per coordinate: box in which exactly one position belongs to each time; those of a ball count from its centre.
    unique: Vec<Interval>,
    /// Per block: its residuals at the middle of its coordinates.
    residuals: Vec<Vec<Interval>>,
    /// Per coordinate: bounds with rates.
    coordinates: Vec<TimeJet<Interval>>,
}

/// Computes enclosures of one mechanism.
pub(crate) struct TubeSolver(BlockSolver<TimeJet<Interval>>);

impl TubeSolver {
    pub fn new(model: &Model, topology: &Topology, parts: &PlanGeometry<f64>) -> Self {
        Self(BlockSolver::new(model, topology, parts, TimeJet::value))
    }

    /// Bounds over an interval of time. `at` is the solved position in the middle of it, and `narrow` its enclosure, if
    /// it is known.
    pub fn enclose(
        &mut self,
        topology: &Topology,
        laws: &[TimeJet<Interval>],
        over: Interval,
        at: &AcceptedPosition,
        narrow: Option<&Enclosure>,
    ) -> Result<Enclosure, TubeFailure> {
        if let Some((c, _)) = topology.contacts().next() {
            return Err(TubeFailure::FollowsCurve { joint: topology[c].joint });
        }
        if let Some(d) = laws.iter().position(|law| !law.value().is_bounded()) {
            return Err(TubeFailure::Law { driver: DriverId(d) });
        }
        self.0.drive(topology, laws, at);
        let centres = narrow.map_or_else(|| Rc::new(at.balls.clone()), |narrow| narrow.centres.clone());
        let o = topology.coordinates.len();
        let mut found = Enclosure {
            over,
            poses: Vec::new(),
            middle: at.time,
            centres,
            unique: vec![Interval::zero(); o],
            residuals: Vec::new(),
            coordinates: vec![TimeJet::zero(); o],
        };
        for (c, d) in topology.driven_coordinates() {
            let law = laws[d.0];
            (found.coordinates[c.0], found.unique[c.0]) = (law, law.value());
        }
        for b in topology.block_ids() {
            self.enclose_block(topology, b, at, narrow, &mut found)?;
        }
        found.poses = self.0.series.state.pose.clone();
        if let Some(narrow) = narrow {
            let since = over - Interval::constant(at.time);
            for (pose, narrow) in found.poses.iter_mut().zip(&narrow.poses) {
                pose.r = narrowed_vector(pose.r, narrow.r, since);
                for (col, narrow) in pose.rot.cols.iter_mut().zip(narrow.rot.cols) {
                    *col = narrowed_vector(*col, narrow, since);
                }
            }
        }
        Ok(found)
    }

    /// Finds the box of one block, and the bounds of its rates.
    fn enclose_block(
        &mut self,
        topology: &Topology,
        b: BlockId,
        at: &AcceptedPosition,
        narrow: Option<&Enclosure>,
        found: &mut Enclosure,
    ) -> Result<(), TubeFailure> {
        let unknowns = &topology[b].unknowns;
        let n = unknowns.len();
        if n > LARGEST_DENSE {
            return Err(TubeFailure::TooLarge { block: b });
        }
        let failed = TubeFailure::NoContraction { block: b };
        let unit = |c: &CoordinateId| topology[*c].unit;
        // The coordinates of a ball are zero at the middle: its rotation is there.
        let middle: Vec<f64> = unknowns.iter().map(|c| at.q[c.0]).collect();
        let half = 0.5 * found.over.width();
        let predicted = |c: &CoordinateId| {
            (at.qd[c.0].abs() + 0.5 * half * at.qdd[c.0].abs()) * half * SLACK + LEAST_BOX * unit(c)
        };
        let radius: Vec<f64> = unknowns.iter().map(predicted).collect();
        let points: Vec<Interval> = middle.iter().map(|m| Interval::constant(*m)).collect();
        let residual = self.0.values.rows(topology, b, &|k| points[k], &found.centres);
        let since = found.over - Interval::constant(found.middle);
        // phi(m, T) in phi(m, t) + phi_t(m, T) (T - t)
        let moved = narrow.map(|narrow| {
            for (c, m) in unknowns.iter().zip(&points) {
                found.coordinates[c.0] = Jet::constant(*m);
            }
            (&narrow.residuals[b.0], self.rates_of_rows(topology, b, 1, found))
        });
        let newton = |step: &Contraction| {
            let mut newton = step.precondition(&residual);
            if let Some((start, rate)) = &moved {
                let (start, rate) = (step.precondition(start), step.precondition(rate));
                for (k, x) in newton.iter_mut().enumerate() {
                    if rate[k].is_bounded() {
                        *x = x.and(start[k] - rate[k] * since);
                    }
                }
            }
            newton
        };
        let Contracted { unique, bounds } =
            self.0.contract(topology, b, (&points, radius), &found.centres, &newton).ok_or(failed)?;
        for (k, c) in unknowns.iter().enumerate() {
            found.unique[c.0] = unique[k];
            found.coordinates[c.0] = Jet([bounds[k], Interval::ENTIRE, Interval::ENTIRE, Interval::ENTIRE]);
        }
        found.residuals.push(residual);
        let mut inverse = None;
        let mut width = f64::INFINITY;
        for _ in 0..MOST_PASSES {
            let boxed: Vec<Interval> = unknowns.iter().map(|c| found.coordinates[c.0].value()).collect();
            let jacobian = self.0.jacobian(topology, b, &boxed, &found.centres);
            if inverse.is_none() {
                inverse = Some(inverse_of(&jacobian, n).ok_or(failed)?);
            }
            let step = Contraction::of(inverse.clone().unwrap_or_default(), &jacobian, n);
            if !(step.norm() <= CONTRACTION) {
                return Err(failed);
            }
            for order in 1..4 {
                // The rates of the rows as if the rate of this order were zero.
                let demand = self.rates_of_rows(topology, b, order, found);
                let known: Vec<Interval> = unknowns.iter().map(|c| found.coordinates[c.0].0[order]).collect();
                let rate = step.solve(&demand, &known);
                for (c, rate) in unknowns.iter().zip(rate) {
                    found.coordinates[c.0].0[order] = rate;
                }
            }
            let Some(narrow) = narrow else { break };
            for c in unknowns {
                let x = &mut found.coordinates[c.0];
                *x = x.narrowed(narrow.coordinates[c.0], since);
            }
            let widths = unknowns.iter().map(|c| found.coordinates[c.0].dd().width() / unit(c));
            let now = widths.fold(0.0, f64::max);
            if !(now < WORTHWHILE * width) {
                break;
            }
            width = now;
        }
        let all: Vec<TimeJet<Interval>> = unknowns.iter().map(|c| found.coordinates[c.0]).collect();
        self.0.place(topology, b, &all, &found.centres);
        Ok(())
    }

    /// The rates of an order of the selected rows, with a minus, if those of the unknowns were zero at this order.
    fn rates_of_rows(
        &mut self,
        topology: &Topology,
        b: BlockId,
        order: usize,
        found: &Enclosure,
    ) -> Vec<Interval> {
        let unknowns = &topology[b].unknowns;
        let lower = |k: usize| {
            let mut x = found.coordinates[unknowns[k].0];
            x.0[order..].fill(Interval::zero());
            x
        };
        let found = self.0.series.rows(topology, b, &lower, &found.centres);
        found.into_iter().map(|x| -x.0[order]).collect()
    }
}

fn narrowed_vector(
    x: Vec3<TimeJet<Interval>>,
    narrow: Vec3<TimeJet<Interval>>,
    since: Interval,
) -> Vec3<TimeJet<Interval>> {
    Vec3::new(x.x.narrowed(narrow.x, since), x.y.narrowed(narrow.y, since), x.z.narrowed(narrow.z, since))
}

/// A motion, with proven bounds of its parts.
///
/// The motion is that which passes through the position at the first output time; every enclosure belongs to it,
/// because neighbouring ones have a position in common in which both are unique.
pub struct ProvenMotion<'m> {
    mechanism: Mechanism<'m>,
    solver: TubeSolver,
    /// Positions at output times, and at others between them.
    positions: Vec<SolvedPosition>,
    /// Plans with the different selections of independent rows along the motion.
    plans: Vec<Topology>,
    /// Enclosures at single times, with their positions, by plan and time.
    instants: BTreeMap<(usize, u64), Result<Rc<Instant>, TubeFailure>>,
    slabs: HashMap<[u64; 2], Result<Rc<Slab>, TubeFailure>>,
    /// Number of enclosures over intervals that were computed.
    computed: usize,
}

/// A position of the motion.
pub(crate) struct SolvedPosition {
    pub at: AcceptedPosition,
    /// Index of the plan by which it goes on from there.
    pub plan: usize,
    /// True at an output time, and at the end.
    pub is_output: bool,
}

/// One time of a motion.
pub(crate) struct Instant {
    at: AcceptedPosition,
    /// Narrow bounds.
    pub enclosure: Enclosure,
}

impl Instant {
    /// The time, s.
    pub fn time(&self) -> f64 {
        self.enclosure.middle
    }
}

/// Part of a motion.
pub(crate) struct Slab {
    /// The interval of time.
    pub over: Interval,
    /// Per body: bounds over the whole part.
    pub poses: Vec<Pose<TimeJet<Interval>>>,
    /// The start, middle and end.
    pub instants: [Rc<Instant>; 3],
}

impl<'m> ProvenMotion<'m> {
    /// Motion through these positions of a mechanism.
    pub(crate) fn new(
        mechanism: Mechanism<'m>,
        positions: Vec<SolvedPosition>,
        plans: Vec<Topology>,
    ) -> Self {
        let solver = TubeSolver::new(mechanism.model, &mechanism.topology, &mechanism.parts);
        let (instants, slabs) = (BTreeMap::new(), HashMap::new());
        Self { mechanism, solver, positions, plans, instants, slabs, computed: 0 }
    }

    /// The model of the mechanism.
    pub fn model(&self) -> &'m Model {
        self.mechanism.model
    }

    /// Output times that the motion reaches.
    pub fn times(&self) -> impl Iterator<Item = f64> + '_ {
        self.positions.iter().filter(|position| position.is_output).map(|output| output.at.time)
    }

    /// Number of enclosures over intervals of time that were computed: the effort.
    pub fn computed(&self) -> usize {
        self.computed
    }

    /// Bounds of the pose of every body, and of its first three rates, over the part of the motion between two times,
    /// which are output times or between two that follow each other.
    ///
    /// # Errors
    /// The reason why nothing is proved over this interval. A shorter one may be, if [`TubeFailure::may_be_halved`].
    pub fn over(&mut self, from: f64, to: f64) -> Result<Vec<Pose<TimeJet<Interval>>>, TubeFailure> {
        self.slab(from, to).map(|slab| slab.poses.clone())
    }

    /// Bounds of the pose of every body at a time, and of its first three rates.
    ///
    /// # Errors
    /// The reason why nothing is proved at this time.
    pub fn at(&mut self, t: f64) -> Result<Vec<Pose<TimeJet<Interval>>>, TubeFailure> {
        let plan = self.plan_after(t);
        self.instant(plan, t).map(|instant| instant.enclosure.poses.clone())
    }

    /// Times between two others at which rates of laws may jump, or the plan changes.
    pub fn cuts(&self, from: f64, to: f64) -> Vec<f64> {
        let drivers = 0..self.mechanism.model.drivers.len();
        let mut cuts: Vec<f64> =
            drivers.flat_map(|d| self.mechanism.parts.law_of(d).cuts(from, to)).collect();
        let pairs = self.positions.windows(2).filter(|pair| pair[0].plan != pair[1].plan);
        cuts.extend(pairs.map(|pair| pair[1].at.time).filter(|t| from < *t && *t < to));
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    }

    /// Plan by which the motion goes on from a time.
    fn plan_after(&self, t: f64) -> usize {
        let begun = self.positions.partition_point(|position| position.at.time <= t);
        self.positions.get(begun.saturating_sub(1)).map_or(0, |position| position.plan)
    }

    /// Narrow bounds at a time, by a plan.
    fn instant(&mut self, plan: usize, t: f64) -> Result<Rc<Instant>, TubeFailure> {
        let key = (plan, t.to_bits());
        if let Some(known) = self.instants.get(&key) {
            return known.clone();
        }
        let found = self.solve_instant(plan, t);
        self.instants.insert(key, found.clone());
        found
    }

    /// Narrow bounds at a time within the part of the motion that starts at another time.
    pub(crate) fn instant_within(&mut self, from: f64, t: f64) -> Result<Rc<Instant>, TubeFailure> {
        let plan = self.plan_after(from);
        self.instant(plan, t)
    }

    fn solve_instant(&mut self, plan: usize, t: f64) -> Result<Rc<Instant>, TubeFailure> {
        let at = self.solve(plan, t)?;
        let (laws, over) = (&self.mechanism.parts, Interval::constant(t));
        let drivers = self.mechanism.model.drivers.len();
        let laws: Vec<_> = (0..drivers).map(|d| laws.law_of(d).enclosure(over)).collect();
        let enclosure = self.solver.enclose(&self.plans[plan], &laws, over, &at, None)?;
        Ok(Rc::new(Instant { at, enclosure }))
    }

    /// Position at a time, from the nearest one that is known, in steps that are halved where one is not solved.
    fn solve(&mut self, plan: usize, t: f64) -> Result<AcceptedPosition, TubeFailure> {
        let failed = TubeFailure::NotSolved { time: t };
        let instants = self.instants.iter();
        let known = instants.filter_map(|((plan, _), known)| Some((*plan, &known.as_ref().ok()?.at)));
        let positions = self.positions.iter().map(|position| (position.plan, &position.at));
        let near = positions.chain(known).min_by(|(_, a), (_, b)| {
            let away = |at: &AcceptedPosition| (at.time - t).abs();
            away(a).total_cmp(&away(b))
        });
        let (of_plan, mut from) = near.map(|(of_plan, at)| (of_plan, at.clone())).ok_or(failed)?;
        let mut has_same_rows = of_plan == plan;
        let (mut h, mut halvings) = (t - from.time, 0);
        while from.time != t {
            let to = if h.abs() >= (t - from.time).abs() { t } else { from.time + h };
            match self.step((plan, has_same_rows), &from, to) {
                // A half of the shortest step leads nowhere.
                Some(next) if next.time != from.time => (from, has_same_rows) = (next, true),
                Some(_) => return Err(failed),
                None if halvings < MOST_STEP_HALVINGS => {
                    (h, halvings) = (0.5 * (to - from.time), halvings + 1)
                }
                None => return Err(failed),
            }
        }
        Ok(from)
    }

    /// Position at a time from another one, which may be of the same plan; `None` if it is not found, or is that of
    /// another branch.
    fn step(
        &mut self,
        (plan, has_same_rows): (usize, bool),
        from: &AcceptedPosition,
        t: f64,
    ) -> Option<AcceptedPosition> {
        let (mechanism, h) = (&mut self.mechanism, t - from.time);
        mechanism.saved = from.clone();
        mechanism.topology.clone_from(&self.plans[plan]);
        mechanism.restore();
        mechanism.expect_turns(h);
        for c in mechanism.topology.unknown_coordinates() {
            // q + q. h + q.. h^2 / 2; of a ball, its correction
            let saved = &mechanism.saved;
            mechanism.state.q[c.0] += (saved.qd[c.0] + 0.5 * h * saved.qdd[c.0]) * h;
        }
        mechanism.state.turn_balls(&mechanism.topology, mechanism.topology.link_ids());
        let trusted = trust(expected_move(mechanism, h));
        mechanism.drive(Path::Laws, t).and_then(|()| mechanism.solve_within(trusted)).ok()?;
        // sign(det J) is that of the branch; those of other rows cannot be compared.
        let mut signs = mechanism.state.pivots.iter().zip(&from.pivots).map(|(now, then)| now.1 == then.1);
        if has_same_rows && !signs.all(|same| same) {
            return None;
        }
        mechanism.save(t);
        Some(mechanism.saved.clone())
    }

    /// Bounds over the part of the motion between two times.
    pub(crate) fn slab(&mut self, from: f64, to: f64) -> Result<Rc<Slab>, TubeFailure> {
        self.slab_in_parts(from, to, MOST_HALVINGS)
    }

    /// Bounds over the part of the motion between two times; if the box does not contract, those of its halves
    /// together.
    fn slab_in_parts(&mut self, from: f64, to: f64, halvings: usize) -> Result<Rc<Slab>, TubeFailure> {
        let key = [from, to].map(f64::to_bits);
        if let Some(known) = self.slabs.get(&key) {
            return known.clone();
        }
        let found = match self.solve_slab(from, to) {
            Err(TubeFailure::NoContraction { .. }) if halvings > 0 => {
                self.join_halves(from, to, halvings - 1)
            }
            found => found,
        };
        // With more halvings, a failure may be none.
        if found.is_ok() || halvings == MOST_HALVINGS {
            self.slabs.insert(key, found.clone());
        }
        found
    }

    fn solve_slab(&mut self, from: f64, to: f64) -> Result<Rc<Slab>, TubeFailure> {
        self.computed += 1;
        let (over, plan) = (Interval::between(from, to), self.plan_after(from));
        let (start, end) = (self.instant(plan, from)?, self.instant(plan, to)?);
        let middle = self.instant(plan, over.middle())?;
        let laws = &self.mechanism.parts;
        let drivers = self.mechanism.model.drivers.len();
        let laws: Vec<_> = (0..drivers).map(|d| laws.law_of(d).enclosure(over)).collect();
        let topology = &self.plans[plan];
        let enclosure = self.solver.enclose(topology, &laws, over, &middle.at, Some(&middle.enclosure))?;
        for (instant, time) in [(&start, from), (&end, to)] {
            let narrow = &instant.enclosure;
            let at = (&narrow.centres[..], |k: usize| narrow.coordinates[k].value());
            if !is_within(topology, at, (&enclosure.centres, &enclosure.unique)) {
                return Err(TubeFailure::OtherBranch { time });
            }
        }
        Ok(Rc::new(Slab { poses: enclosure.poses, over, instants: [start, middle, end] }))
    }

    /// Bounds that contain those of both halves.
    fn join_halves(&mut self, from: f64, to: f64, halvings: usize) -> Result<Rc<Slab>, TubeFailure> {
        let over = Interval::between(from, to);
        let time = over.middle();
        let first = self.slab_in_parts(from, time, halvings)?;
        let second = self.slab_in_parts(time, to, halvings)?;
        let [start, _, middle] = first.instants.clone();
        let end = second.instants[2].clone();
        // A rate that jumps from one half to the other has no bounds over both.
        let laws =
            (0..self.mechanism.model.drivers.len()).map(|d| self.mechanism.parts.law_of(d).enclosure(over));
        let mut is_bounded = [true; 4];
        for law in laws {
            for (known, rate) in is_bounded.iter_mut().zip(law.0) {
                *known &= rate.is_bounded();
            }
        }
        let since = over - Interval::constant(time);
        let either = |a: TimeJet<Interval>, b: TimeJet<Interval>, narrow: TimeJet<Interval>| {
            let hull = |n: usize| if is_bounded[n] { a.0[n].or(b.0[n]) } else { Interval::ENTIRE };
            Jet(std::array::from_fn(hull)).narrowed(narrow, since)
        };
        let vector = |a: Vec3<TimeJet<Interval>>, b: Vec3<TimeJet<Interval>>, c: Vec3<TimeJet<Interval>>| {
            Vec3::new(either(a.x, b.x, c.x), either(a.y, b.y, c.y), either(a.z, b.z, c.z))
        };
        let poses =
            first.poses.iter().zip(&second.poses).zip(&middle.enclosure.poses).map(|((a, b), c)| Pose {
                rot: Mat3 {
                    cols: number::each(&[0, 1, 2], |k| vector(a.rot.cols[k], b.rot.cols[k], c.rot.cols[k])),
                },
                r: vector(a.r, b.r, c.r),
            });
        Ok(Rc::new(Slab { poses: poses.collect(), over, instants: [start, middle, end] }))
    }
}

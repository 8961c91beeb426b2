//! The loosest tolerances that keep the limits, at given relative costs.
//!
//! ```text
//! minimise  sum c_a / t_a     subject to  k^2 t' Q_j t <= r_j^2  (squares)  or  w_j . t <= r_j  (worst case)
//! ```
//!
//! with `t_a` the reaches, `r_j` the room between the value in the design configuration and a limit,
//! `Q_ab = sum over variables i of a, l of b of g_i g_l rho_il (s_i / t_a) (s_l / t_b)` and
//! `w_a = |gradient by the variables of a|`. All of it is convex, so that what fulfils the conditions of optimality is
//! the optimum. It is found by a barrier and Newton's method.

use crate::linalg::semidefinite;
use crate::model::{AllocationRule, AllocationSettings};

use super::monte_carlo::MonteCarlo;
use super::{Study, ToleranceResult, dot};

/// No tolerance is made looser than that many times what it is: beyond that no limit has a say in it, and no derivative
/// either.
const MOST: f64 = 1000.0;
/// The barrier deflects by this factor ...
const HARDER: f64 = 10.0;
/// ... until what it costs is less than this part of the costs. Newton's equations are then of a condition near its
/// inverse.
const SHARP: f64 = 1e-8;
/// Newton's method ends where the cost would fall by less than this part, and after that many steps at the latest.
const STILL: f64 = 1e-18;
/// Relative distance from the end below which a whole step is right, and the barrier's own value is round-off.
const NEAR: f64 = 1e-4;
const STEPS: usize = 100;
/// A step that leaves what is allowed, or gains nothing, is halved that many times.
const HALVINGS: usize = 60;

/// The loosest tolerances.
#[derive(Clone, Debug)]
pub struct Allocation {
    /// Rule that kept the limits.
    pub rule: AllocationRule,
    /// Per tolerance that has a cost.
    pub tolerances: Vec<AllocatedTolerance>,
    /// Per limit, in the order of [`ToleranceResult::limits`]: what it is worth, as the cost that would be saved if its
    /// room grew by one SI unit; 0 where it does not bind.
    pub worth: Vec<f64>,
    /// The sum of `cost / reach` before and after.
    pub cost: [f64; 2],
    /// Remaining gradient of the costs that the limits do not balance, relative to the whole gradient.
    pub residual: f64,
    /// Reason why there is none: a limit that no tolerances keep.
    pub impossible: Option<AllocationError>,
    /// Designs drawn from these tolerances.
    pub sampled: Option<MonteCarlo>,
}

/// A tolerance that was sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllocatedTolerance {
    /// Index of the tolerance.
    pub tolerance: usize,
    /// Reach before.
    pub before: f64,
    /// The loosest; `None` where no limit has a say in it.
    pub after: Option<f64>,
}

/// Reason why no tolerances keep the limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AllocationError {
    /// Nothing has a cost.
    NoCosts,
    /// There is no limit.
    NoLimits,
    /// This limit (in the order of [`ToleranceResult::limits`]) is not kept by the nominal design.
    AsDrawn(usize),
    /// Tolerances without a cost use up the room of this one.
    Fixed(usize),
}

/// Room of one limit for deviations.
struct Room {
    limit: usize,
    /// Room, in SI.
    room: f64,
    /// By squares: `k^2 t' Q t`, in parts of the tolerances as they are.
    q: Vec<Vec<f64>>,
    /// At worst: `w . t`.
    w: Vec<f64>,
}

/// Seeks them.
pub(super) fn allocate(study: &Study<'_>, asked: AllocationSettings, found: &ToleranceResult) -> Allocation {
    let tolerances = &study.asked.tolerances;
    let blocks = &study.deviations.blocks;
    let free: Vec<usize> =
        (0..blocks.len()).filter(|b| tolerances[blocks[*b].tolerance].cost.is_some()).collect();
    let costs: Vec<f64> = free
        .iter()
        .map(|b| {
            let of = &tolerances[blocks[*b].tolerance];
            of.cost.expect("only those with a cost are free") / of.reach
        })
        .collect();
    let mut allocation = Allocation {
        rule: asked.rule,
        tolerances: Vec::new(),
        worth: vec![0.0; found.limits.len()],
        cost: [costs.iter().sum(), 0.0],
        residual: f64::NAN,
        impossible: None,
        sampled: None,
    };
    let rooms = rooms(study, asked.rule, found);
    let problem =
        Problem { costs: &costs, free: &free, rooms: &rooms, blocks: blocks.len(), rule: asked.rule };
    allocation.impossible = match () {
        () if free.is_empty() => Some(AllocationError::NoCosts),
        () if rooms.is_empty() => Some(AllocationError::NoLimits),
        () => {
            let missed = rooms.iter().find(|r| !(r.room > 0.0)).map(|r| AllocationError::AsDrawn(r.limit));
            let nothing = problem.whole(&vec![0.0; free.len()]);
            let used = |r: &&Room| !(problem.slack(r, &nothing) > 0.0);
            missed.or_else(|| rooms.iter().find(used).map(|r| AllocationError::Fixed(r.limit)))
        }
    };
    if allocation.impossible.is_some() {
        return allocation;
    }
    let (x, multipliers, residual) = problem.solve();
    allocation.cost[1] = costs.iter().zip(&x).map(|(c, x)| c / x).sum();
    allocation.residual = residual;
    for (room, m) in rooms.iter().zip(&multipliers) {
        allocation.worth[room.limit] += m * problem.by_room(room);
    }
    let reach = |(b, x): (&usize, &f64)| {
        let (tolerance, before) = (blocks[*b].tolerance, blocks[*b].reach);
        AllocatedTolerance { tolerance, before, after: (*x < 0.999 * MOST).then_some(before * x) }
    };
    allocation.tolerances = free.iter().zip(&x).map(reach).collect();
    allocation
}

impl Allocation {
    /// The reaches of all tolerances, those that no limit has a say in as they were; `None` where there are none.
    pub(super) fn reaches_of(&self, before: impl Iterator<Item = f64>) -> Option<Vec<f64>> {
        let mut reaches: Vec<f64> = before.collect();
        for one in &self.tolerances {
            reaches[one.tolerance] = one.after.unwrap_or(one.before);
        }
        self.impossible.is_none().then_some(reaches)
    }
}

/// Room of every limit: for a limit with two ends, the nearer one.
fn rooms(study: &Study<'_>, rule: AllocationRule, found: &ToleranceResult) -> Vec<Room> {
    let deviations = study.deviations;
    let room = |(k, limit): (usize, &super::LimitYield)| {
        let (asked, of) = (&study.asked.limits[limit.limit], &found.metrics[limit.spread]);
        let above = asked.most.map_or(f64::INFINITY, |most| most - of.nominal);
        let below = asked.least.map_or(f64::INFINITY, |least| of.nominal - least);
        let part = |b: &super::deviations::Block| {
            let mut g = vec![0.0; of.d.len()];
            g[b.range()].copy_from_slice(&of.d[b.range()]);
            deviations.whitened(&g)
        };
        let (mut q, mut w) = (Vec::new(), Vec::new());
        match rule {
            AllocationRule::Rss { sigmas } => {
                let parts: Vec<Vec<f64>> = deviations.blocks.iter().map(part).collect();
                let entry = |a: &[f64], b: &[f64]| sigmas * sigmas * dot(a, b);
                q = parts.iter().map(|a| parts.iter().map(|b| entry(a, b)).collect()).collect();
            }
            AllocationRule::Worst => {
                let norm = |b: &super::deviations::Block| dot(&of.d[b.range()], &of.d[b.range()]).sqrt();
                w = deviations.blocks.iter().map(|b| b.reach * norm(b)).collect();
            }
        }
        Room { limit: k, room: above.min(below), q, w }
    };
    found.limits.iter().enumerate().map(room).collect()
}

/// `minimise sum c / x` over the free tolerances, as parts x of what they are.
struct Problem<'a> {
    costs: &'a [f64],
    free: &'a [usize],
    rooms: &'a [Room],
    blocks: usize,
    rule: AllocationRule,
}

impl Problem<'_> {
    /// All tolerances: those that are free as given, the others as they are.
    fn whole(&self, x: &[f64]) -> Vec<f64> {
        let mut t = vec![1.0; self.blocks];
        self.free.iter().zip(x).for_each(|(b, x)| t[*b] = *x);
        t
    }

    /// Unused part of a room, relative to it (by squares: of its square).
    fn slack(&self, room: &Room, t: &[f64]) -> f64 {
        match self.rule {
            AllocationRule::Rss { .. } => {
                let used: f64 = room.q.iter().zip(t).map(|(row, a)| a * dot(row, t)).sum();
                1.0 - used / (room.room * room.room)
            }
            AllocationRule::Worst => 1.0 - dot(&room.w, t) / room.room,
        }
    }

    /// Derivatives of the unused part by the free tolerances.
    fn use_of(&self, room: &Room, t: &[f64]) -> Vec<f64> {
        let one = |b: &usize| match self.rule {
            AllocationRule::Rss { .. } => 2.0 * dot(&room.q[*b], t) / (room.room * room.room),
            AllocationRule::Worst => room.w[*b] / room.room,
        };
        self.free.iter().map(one).collect()
    }

    /// The second derivative of the same.
    fn bend(&self, room: &Room, i: usize, j: usize) -> f64 {
        match self.rule {
            AllocationRule::Rss { .. } => 2.0 * room.q[self.free[i]][self.free[j]] / (room.room * room.room),
            AllocationRule::Worst => 0.0,
        }
    }

    /// Derivative of the used part by the size of the room, if all of it is used.
    fn by_room(&self, room: &Room) -> f64 {
        match self.rule {
            AllocationRule::Rss { .. } => 2.0 / room.room,
            AllocationRule::Worst => 1.0 / room.room,
        }
    }

    /// `h sum c / x - sum log slack - sum log (MOST - x)`, infinite outside.
    fn barrier(&self, x: &[f64], h: f64) -> f64 {
        if x.iter().any(|x| !(*x > 0.0 && *x < MOST)) {
            return f64::INFINITY;
        }
        let t = self.whole(x);
        let slacks = self.rooms.iter().map(|r| self.slack(r, &t));
        let walls = slacks.chain(x.iter().map(|x| 1.0 - x / MOST));
        let logs: f64 = walls.map(|s| if s > 0.0 { s.ln() } else { f64::NEG_INFINITY }).sum();
        h * self.costs.iter().zip(x).map(|(c, x)| c / x).sum::<f64>() - logs
    }

    /// The tolerances, the multipliers of the rooms, and what is left of the gradient.
    fn solve(&self) -> (Vec<f64>, Vec<f64>, f64) {
        let n = self.free.len();
        let mut x = vec![1.0; n];
        while !self.barrier(&x, 0.0).is_finite() {
            x.iter_mut().for_each(|x| *x *= 0.5);
        }
        let cost = |x: &[f64]| self.costs.iter().zip(x).map(|(c, x)| c / x).sum::<f64>();
        let walls = (self.rooms.len() + n) as f64;
        let mut h = walls / cost(&x);
        loop {
            self.descend(&mut x, h);
            if walls / h <= SHARP * cost(&x) {
                break;
            }
            h *= HARDER;
        }
        let t = self.whole(&x);
        let multipliers: Vec<f64> = self.rooms.iter().map(|r| 1.0 / (h * self.slack(r, &t))).collect();
        let uses: Vec<Vec<f64>> = self.rooms.iter().map(|r| self.use_of(r, &t)).collect();
        // -c / x^2 + sum lambda dg/dx = 0; what is at the wall is held by it.
        let (mut left, mut whole) = (0.0, 0.0);
        for i in (0..n).filter(|i| x[*i] < 0.999 * MOST) {
            let slope = self.costs[i] / (x[i] * x[i]);
            let held: f64 = uses.iter().zip(&multipliers).map(|(u, m)| u[i] * m).sum();
            left += ((held - slope) * x[i]).powi(2);
            whole += (slope * x[i]).powi(2);
        }
        let residual = if whole > 0.0 { (left / whole).sqrt() } else { 0.0 };
        (x, multipliers, residual)
    }

    /// Newton's method on the barrier.
    fn descend(&self, x: &mut Vec<f64>, h: f64) {
        let n = x.len();
        for _ in 0..STEPS {
            let t = self.whole(x);
            let mut g: Vec<f64> =
                (0..n).map(|i| -h * self.costs[i] / x[i].powi(2) + 1.0 / (MOST - x[i])).collect();
            let mut hessian = vec![vec![0.0; n]; n];
            for i in 0..n {
                hessian[i][i] = 2.0 * h * self.costs[i] / x[i].powi(3) + (MOST - x[i]).powi(-2);
            }
            for room in self.rooms {
                let (slack, by) = (self.slack(room, &t), self.use_of(room, &t));
                for i in 0..n {
                    g[i] += by[i] / slack;
                    for j in 0..n {
                        hessian[i][j] += by[i] * by[j] / (slack * slack) + self.bend(room, i, j) / slack;
                    }
                }
            }
            // Scaled by x, since tolerances may differ by orders.
            let scaled: Vec<Vec<f64>> =
                (0..n).map(|i| (0..n).map(|j| hessian[i][j] * x[i] * x[j]).collect()).collect();
            let Some(root) = semidefinite::root(&scaled).filter(|root| (0..n).all(|i| root[i][i] > 0.0))
            else {
                return;
            };
            let mut step: Vec<f64> = g.iter().zip(x.iter()).map(|(g, x)| -g * x).collect();
            semidefinite::solve(&root, &mut step);
            let by: Vec<f64> = step.iter().zip(x.iter()).map(|(s, x)| s * x).collect();
            let fall = -dot(&g, &by);
            if !(fall > STILL) {
                return;
            }
            let (before, mut part) = (self.barrier(x, h), 1.0);
            let mut moved = None;
            for _ in 0..HALVINGS {
                let there: Vec<f64> = x.iter().zip(&by).map(|(x, by)| x + part * by).collect();
                let value = self.barrier(&there, h);
                if value <= before || (fall < NEAR && value.is_finite()) {
                    moved = Some(there);
                    break;
                }
                part *= 0.5;
            }
            match moved {
                Some(there) if there != *x => *x = there,
                _ => return,
            }
        }
    }
}

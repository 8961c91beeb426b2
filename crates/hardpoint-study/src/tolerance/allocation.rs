//! Tolerance allocation: the loosest tolerances that satisfy the limits, at given relative costs.
//!
//! ```text
//! minimise  sum c_a / t_a     subject to  k^2 t' Q_j t <= r_j^2  (squares)  or  w_j . t <= r_j  (worst case)
//! ```
//!
//! with `t_a` the reaches, `r_j` the room between the nominal value and a limit,
//! `Q_ab = sum over variables i of a, l of b of g_i g_l rho_il (s_i / t_a) (s_l / t_b)` and
//! `w_a = |gradient by the variables of a|`. The problem is convex, so a point that satisfies the optimality conditions
//! is the optimum. It is found by a barrier method with Newton steps.

use hardpoint::linalg::semidefinite;
use hardpoint::model::{AllocationRule, AllocationSettings};

use super::data::StudyData;
use super::deviations::Block;
use super::monte_carlo::MonteCarlo;
use super::spread::MetricSpread;
use super::yields::LimitYield;
use hardpoint_search::dot;

/// Maximum factor by which a tolerance is loosened: beyond it no limit constrains the tolerance, and the derivatives
/// are not valid.
const MAX_FACTOR: f64 = 1000.0;
/// Factor by which the barrier is weakened in each round ...
const HARDER: f64 = 10.0;
/// ... until its cost is below this fraction of the total cost. The condition number of Newton's equations is then near
/// the inverse.
const SHARP: f64 = 1e-8;
/// Newton's method ends if the expected decrease is below this fraction of the cost, or after this number of steps.
const STILL: f64 = 1e-18;
/// Relative distance from the optimum below which a full step is correct, and the barrier's own value is round-off.
const NEAR: f64 = 1e-4;
const STEPS: usize = 100;
/// Maximum number of halvings of a step that leaves the feasible region or gains nothing.
const HALVINGS: usize = 60;

/// Result of a tolerance allocation.
#[derive(Clone, Debug)]
pub struct Allocation {
    /// Rule by which the limits are checked.
    pub rule: AllocationRule,
    /// Results of the tolerances that have a cost.
    pub tolerances: Vec<AllocatedTolerance>,
    /// Lagrange multiplier of each limit, in the order of
    /// [`ToleranceResult::limits`](super::ToleranceResult::limits): the cost saved per SI unit of additional room; 0 if
    /// the limit is inactive.
    pub worth: Vec<f64>,
    /// Sum of `cost / reach` before and after.
    pub cost: [f64; 2],
    /// Part of the cost gradient that the active limits do not balance, relative to the whole gradient.
    pub residual: f64,
    /// Reason why the allocation is infeasible, if it is.
    pub error: Option<AllocationError>,
    /// Monte Carlo results with the allocated tolerances.
    pub sampled: Option<MonteCarlo>,
}

/// Allocated tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllocatedTolerance {
    /// Index of the tolerance.
    pub tolerance: usize,
    /// Original reach, in the unit of the tolerance.
    pub before: f64,
    /// Loosest reach; `None` if no limit constrains it.
    pub after: Option<f64>,
}

/// Reason why a tolerance allocation is infeasible or cannot start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AllocationError {
    /// No tolerance has a cost.
    NoCosts,
    /// No limits are given.
    NoLimits,
    /// The nominal design violates this limit (index in [`ToleranceResult::limits`](super::ToleranceResult::limits)).
    NominalExceeds(usize),
    /// The metric of this limit (index in [`ToleranceResult::limits`](super::ToleranceResult::limits)) has no
    /// derivatives.
    NoDerivatives(usize),
    /// Tolerances without a cost exhaust the room of this limit (index in
    /// [`ToleranceResult::limits`](super::ToleranceResult::limits)).
    Fixed(usize),
}

/// Room for deviations at one limit.
struct Room {
    limit: usize,
    /// Distance from the nominal value to the limit, SI.
    room: f64,
    /// Root-sum-square rule: `k^2 t' Q t`, with tolerances as fractions of their original reach.
    q: Vec<Vec<f64>>,
    /// Worst-case rule: `w . t`.
    w: Vec<f64>,
}

/// Allocates the tolerances.
pub(super) fn allocate(
    study: &StudyData<'_>,
    settings: AllocationSettings,
    metrics: &[MetricSpread],
    limits: &[LimitYield],
) -> Allocation {
    let tolerances = &study.settings.tolerances;
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
        rule: settings.rule,
        tolerances: Vec::new(),
        worth: vec![0.0; limits.len()],
        cost: [costs.iter().sum(), 0.0],
        residual: f64::NAN,
        error: None,
        sampled: None,
    };
    let rooms = rooms(study, settings.rule, metrics, limits);
    let problem =
        Problem { costs: &costs, free: &free, rooms: &rooms, blocks: blocks.len(), rule: settings.rule };
    allocation.error = match () {
        () if free.is_empty() => Some(AllocationError::NoCosts),
        () if rooms.is_empty() => Some(AllocationError::NoLimits),
        () => {
            let missed =
                rooms.iter().find(|r| !(r.room > 0.0)).map(|r| AllocationError::NominalExceeds(r.limit));
            let nothing = problem.whole(&vec![0.0; free.len()]);
            let used = |r: &&Room| !(problem.slack(r, &nothing) > 0.0);
            let is_unknown = |r: &&Room| problem.slack(r, &nothing).is_nan();
            let unknown = || rooms.iter().find(is_unknown).map(|r| AllocationError::NoDerivatives(r.limit));
            let fixed = || rooms.iter().find(used).map(|r| AllocationError::Fixed(r.limit));
            missed.or_else(unknown).or_else(fixed)
        }
    };
    if allocation.error.is_some() {
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
        AllocatedTolerance { tolerance, before, after: (*x < 0.999 * MAX_FACTOR).then_some(before * x) }
    };
    allocation.tolerances = free.iter().zip(&x).map(reach).collect();
    allocation
}

impl Allocation {
    /// Reaches of all tolerances after allocation; unconstrained tolerances keep theirs. `None` if the allocation is
    /// infeasible.
    pub(super) fn reaches_of(&self, before: impl Iterator<Item = f64>) -> Option<Vec<f64>> {
        let mut reaches: Vec<f64> = before.collect();
        for one in &self.tolerances {
            reaches[one.tolerance] = one.after.unwrap_or(one.before);
        }
        self.error.is_none().then_some(reaches)
    }
}

/// Room of every limit; a limit with two ends uses the nearer one.
fn rooms(
    study: &StudyData<'_>,
    rule: AllocationRule,
    metrics: &[MetricSpread],
    limits: &[LimitYield],
) -> Vec<Room> {
    let deviations = study.deviations;
    let room = |(k, limit): (usize, &LimitYield)| {
        let (settings, of) = (&study.settings.limits[limit.limit], &metrics[limit.spread]);
        let above = settings.most.map_or(f64::INFINITY, |most| most - of.nominal);
        let below = settings.least.map_or(f64::INFINITY, |least| of.nominal - least);
        let part = |b: &Block| {
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
                let norm = |b: &Block| dot(&of.d[b.range()], &of.d[b.range()]).sqrt();
                w = deviations.blocks.iter().map(|b| b.reach * norm(b)).collect();
            }
        }
        Room { limit: k, room: above.min(below), q, w }
    };
    limits.iter().enumerate().map(room).collect()
}

/// `minimise sum c / x` over the free tolerances x, as fractions of their original reach.
struct Problem<'a> {
    costs: &'a [f64],
    free: &'a [usize],
    rooms: &'a [Room],
    blocks: usize,
    rule: AllocationRule,
}

impl Problem<'_> {
    /// All tolerances: free ones from `x`, the others unchanged.
    fn whole(&self, x: &[f64]) -> Vec<f64> {
        let mut t = vec![1.0; self.blocks];
        self.free.iter().zip(x).for_each(|(b, x)| t[*b] = *x);
        t
    }

    /// Unused fraction of a room (for the root-sum-square rule: of its square).
    fn slack(&self, room: &Room, t: &[f64]) -> f64 {
        match self.rule {
            AllocationRule::Rss { .. } => {
                let used: f64 = room.q.iter().zip(t).map(|(row, a)| a * dot(row, t)).sum();
                1.0 - used / (room.room * room.room)
            }
            AllocationRule::Worst => 1.0 - dot(&room.w, t) / room.room,
        }
    }

    /// Derivatives of the used fraction by the free tolerances.
    fn use_of(&self, room: &Room, t: &[f64]) -> Vec<f64> {
        let one = |b: &usize| match self.rule {
            AllocationRule::Rss { .. } => 2.0 * dot(&room.q[*b], t) / (room.room * room.room),
            AllocationRule::Worst => room.w[*b] / room.room,
        };
        self.free.iter().map(one).collect()
    }

    /// Second derivative of the used fraction.
    fn bend(&self, room: &Room, i: usize, j: usize) -> f64 {
        match self.rule {
            AllocationRule::Rss { .. } => 2.0 * room.q[self.free[i]][self.free[j]] / (room.room * room.room),
            AllocationRule::Worst => 0.0,
        }
    }

    /// Derivative of the used fraction by the size of the room, if the room is used up.
    fn by_room(&self, room: &Room) -> f64 {
        match self.rule {
            AllocationRule::Rss { .. } => 2.0 / room.room,
            AllocationRule::Worst => 1.0 / room.room,
        }
    }

    /// `h sum c / x - sum log slack - sum log (MAX_FACTOR - x)`, infinite outside the feasible region.
    fn barrier(&self, x: &[f64], h: f64) -> f64 {
        if x.iter().any(|x| !(*x > 0.0 && *x < MAX_FACTOR)) {
            return f64::INFINITY;
        }
        let t = self.whole(x);
        let slacks = self.rooms.iter().map(|r| self.slack(r, &t));
        let walls = slacks.chain(x.iter().map(|x| 1.0 - x / MAX_FACTOR));
        let logs: f64 = walls.map(|s| if s > 0.0 { s.ln() } else { f64::NEG_INFINITY }).sum();
        h * self.costs.iter().zip(x).map(|(c, x)| c / x).sum::<f64>() - logs
    }

    /// Optimal tolerances, multipliers of the rooms, and residual of the gradient.
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
        // -c / x^2 + sum lambda dg/dx = 0; variables at the wall are left out.
        let (mut left, mut whole) = (0.0, 0.0);
        for i in (0..n).filter(|i| x[*i] < 0.999 * MAX_FACTOR) {
            let slope = self.costs[i] / (x[i] * x[i]);
            let held: f64 = uses.iter().zip(&multipliers).map(|(u, m)| u[i] * m).sum();
            left += ((held - slope) * x[i]).powi(2);
            whole += (slope * x[i]).powi(2);
        }
        let residual = if whole > 0.0 { (left / whole).sqrt() } else { 0.0 };
        (x, multipliers, residual)
    }

    /// Newton's method on the barrier function.
    fn descend(&self, x: &mut Vec<f64>, h: f64) {
        let n = x.len();
        for _ in 0..STEPS {
            let t = self.whole(x);
            let mut g: Vec<f64> =
                (0..n).map(|i| -h * self.costs[i] / x[i].powi(2) + 1.0 / (MAX_FACTOR - x[i])).collect();
            let mut hessian = vec![vec![0.0; n]; n];
            for i in 0..n {
                hessian[i][i] = 2.0 * h * self.costs[i] / x[i].powi(3) + (MAX_FACTOR - x[i]).powi(-2);
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
            // Scaled by x, since tolerances may differ by orders of magnitude.
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

//! One point of a front: the design nearest to a reference point, along a direction of improvement (Pascoletti and
//! Serafini; with the normal of the front's chord, the normal boundary intersection of Das and Dennis).
//!
//! ```text
//! min t    so that    f_i(x) <= a_i + d_i t,    c(x) <= 0,    0 <= x <= 1       f: goals as fractions of their ranges
//! ```
//!
//! Each step leads to the minimum of a model of all functions within a trust region, from the design between two
//! neighbours on the front. The model ([`LocalModel`]) costs no design: norms are those of linear residuals, and
//! the rest of each function is a symmetric rank-one secant, which neighbouring points of the front inherit. Its
//! minimum is found by sequential quadratic programming.

use super::functions::{Criticality, Form, Matrix, Residuals, Role, Scale, State};
use super::local_model::LocalModel;
use crate::optimize::assessment::LIMIT_KEPT;
use crate::optimize::optimality::BINDS;
use crate::optimize::problem::{Point, Problem};
use crate::optimize::solver::Memory;
use hardpoint::linalg::semidefinite;
use hardpoint_search::quadratic::{Linear, Minimum, minimize};
use hardpoint_search::{Singular, dot, norm, singular};

/// Residual at which an end of a front is found: a tenth of what is promised, since the ranges of the goals change ...
pub(crate) const SHARP: f64 = 1e-7;
/// ... and that of the points between them.
pub(crate) const SHARP_BETWEEN: f64 = 5e-7;
/// Maximum number of steps to a point.
pub(crate) const STEPS: usize = 40;
/// Radius of the first trust region, as a fraction of the bounds.
const RADIUS: f64 = 0.2;
/// Smallest trust region.
const LEAST_RADIUS: f64 = 1e-11;
/// Factor by which a trust region shrinks after a step without progress.
const SHRINK: f64 = 0.3;
/// A step achieves progress if it gains this part of its prediction.
const GAIN: f64 = 0.05;
/// A step is also accepted if it reduces the residual to this part.
const NEARER: f64 = 0.5;
/// Number of recent values that a step is compared with: curved constraints make single good steps look bad.
const MEMORY: usize = 3;
/// Curvature of auxiliary unknowns, whose values the constraints determine.
const SLIGHT: f64 = 1e-3;
/// Minimum curvature in any direction, as a fraction of the largest.
const FLAT: f64 = 1e-6;
/// Minimum of the largest curvature: goals change by about one over the bounds.
const LEAST_CURVATURE: f64 = 1e-2;
/// Multiples of the largest curvature that are tried along the gradients of active functions.
const AUGMENTATIONS: [f64; 5] = [0.0, 0.1, 1.0, 10.0, 100.0];
/// Weight of the violation of limits at the start, which change by one over the bounds, relative to the goals.
const PENALTY: f64 = 10.0;
/// Largest such weight: limits that still are exceeded cannot be kept.
const MOST_PENALTY: f64 = 1e8;
/// Maximum number of steps to the minimum of the model of all functions, which cost no design ...
const MODEL_STEPS: usize = 100;
/// ... and the step at which it is found, as a fraction of the trust region.
const MODEL_SHARP: f64 = 1e-9;
/// Part of its prediction with which a step to the minimum of the model widens the region of the next.
const FAIR: f64 = 0.2;
/// Largest factor of the weight of the violation in one step to a point: a limit that is out of reach of the trust
/// region is not a reason for more.
const MORE_PENALTY: f64 = 10.0;
/// Secants whose denominator is below this fraction of its factors are not used.
const SECANT: f64 = 1e-6;

/// Reference point and direction of the goals as fractions of their ranges; `None` for a goal that is not traded. A
/// goal with direction 0 is a limit.
pub(crate) type Reference = Vec<Option<[f64; 2]>>;

/// Second derivatives of all functions beyond those of linear residuals, and the weights of the goals.
#[derive(Clone, Debug, Default)]
pub(crate) struct Curvatures {
    /// Secant of each block of functions.
    secants: Vec<Matrix>,
    /// Multiplier of each function.
    multipliers: Vec<f64>,
}

/// Design on the front.
#[derive(Clone, Debug)]
pub(crate) struct Solved {
    pub state: State,
    pub criticality: Criticality,
    pub curvatures: Curvatures,
}

/// Goals and limits of a design as functions, given the scales of limits and the design as fractions of the bounds.
type StateOf = fn(&Problem<'_>, &[f64], Vec<f64>, Point) -> State;

/// Evaluates designs of one front.
pub(crate) struct Scalarization<'p> {
    pub memory: &'p Memory<'p>,
    pub state: StateOf,
    pub limit_scales: Vec<f64>,
    pub scale: Scale,
    pub reference: Reference,
    /// Distance between the goals and the line of the reference that is near enough.
    pub near: f64,
    /// Residual that is small enough.
    pub sharp: f64,
    /// Maximum number of steps.
    pub steps: usize,
}

/// Progress of a search for the minimum of a scalarization.
pub(crate) struct Minimization {
    pub here: State,
    pub criticality: Criticality,
    curvatures: Curvatures,
    radius: f64,
    penalty: f64,
    /// Values of the objective at former designs, with this penalty.
    recent: Vec<f64>,
    /// Predicted and achieved decrease of the objective by the last design, in units of the scale; an infinite loss
    /// where it could not be evaluated.
    pub outcome: Option<[f64; 2]>,
}

/// Minimum of the model of all functions.
struct ModelMinimum {
    x: Vec<f64>,
    /// Objective with the penalty.
    value: f64,
    penalty: f64,
}

/// Step of the quadratic program.
struct Step {
    p: Vec<f64>,
    /// Predicted decrease of the merit.
    gain: f64,
    multipliers: Vec<f64>,
    /// Sum of the multipliers of limits and of goals that are limits.
    forces: f64,
}

impl Scalarization<'_> {
    /// Evaluates a design; `None` if it cannot be evaluated.
    pub fn evaluate(&self, x: &[f64]) -> Option<State> {
        let point: Point = self.memory.at(x, |found| found.as_ref().ok().cloned())?;
        Some((self.state)(self.memory.problem, &self.limit_scales, x.to_vec(), point))
    }

    /// Indices of the traded goals, and of those that are limits.
    fn traded(&self) -> [Vec<usize>; 2] {
        let goals = |is_free: bool| {
            let has = |k: &usize| self.reference[*k].is_some_and(|[_, d]| (d > 0.0) == is_free);
            (0..self.reference.len()).filter(has).collect()
        };
        [true, false].map(goals)
    }

    /// Distance of a design from the first-order condition. A goal that is a limit counts where it is active.
    fn criticality(&self, state: &State) -> Criticality {
        let [traded, mut fixed] = self.traded();
        let scaled = state.scaled(&self.scale);
        fixed.retain(|goal| self.reference[*goal].is_some_and(|[a, _]| scaled[*goal] > a - BINDS));
        state.criticality(&self.scale, &traded, &fixed)
    }

    /// Position `t` of each goal along the direction.
    fn positions(&self, state: &State) -> Vec<f64> {
        let goals = state.scaled(&self.scale).into_iter().zip(&self.reference);
        goals.filter_map(|(f, r)| r.filter(|[_, d]| *d > 0.0).map(|[a, d]| (f - a) / d)).collect()
    }

    /// Value of t and the largest violation of limits at a design.
    fn merit(&self, state: &State) -> (f64, f64) {
        let greatest = |all: Vec<f64>| all.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let fixed = state.scaled(&self.scale).into_iter().zip(&self.reference);
        let fixed = fixed.filter_map(|(f, r)| r.filter(|[_, d]| *d == 0.0).map(|[a, _]| f - a));
        (greatest(self.positions(state)), greatest(fixed.collect()).max(state.violation()))
    }

    /// Searches from a design that can be evaluated. Returns the design with the smallest residual.
    pub fn solve(&self, start: State, curvatures: Curvatures) -> Option<Solved> {
        let mut minimization = self.minimization(start, curvatures);
        let mut best: Option<(State, Criticality)> = None;
        for _ in 0..self.steps {
            let Minimization { here, criticality, .. } = &minimization;
            let (t, violation) = self.merit(here);
            let apart = self.positions(here).iter().map(|p| t - p).fold(0.0, f64::max);
            let is_kept = violation <= LIMIT_KEPT;
            if is_kept && best.as_ref().is_none_or(|(_, c)| criticality.residual < c.residual) {
                best = Some((here.clone(), criticality.clone()));
            }
            let is_sharp = is_kept && criticality.residual <= self.sharp;
            if is_sharp && apart <= self.near {
                break;
            }
            if self.memory.interrupted() {
                return None;
            }
            let shortest = if is_sharp { self.near.min(RADIUS) * SHARP.sqrt() } else { 0.0 };
            if !self.advance(&mut minimization, shortest) {
                break;
            }
        }
        best.map(|(state, criticality)| Solved { state, criticality, curvatures: minimization.curvatures })
    }

    /// Search from a design that can be evaluated, before its first step.
    pub fn minimization(&self, here: State, mut curvatures: Curvatures) -> Minimization {
        curvatures.fit(&here);
        let (radius, penalty, recent) = (RADIUS, PENALTY, Vec::new());
        let criticality = self.criticality(&here);
        Minimization { here, criticality, curvatures, radius, penalty, recent, outcome: None }
    }

    /// Tries one step, which is made if it is good, or else shortens the next. Returns false at the end: the step is
    /// not longer than `shortest`.
    pub fn advance(&self, minimization: &mut Minimization, shortest: f64) -> bool {
        let Minimization { here, criticality, curvatures, radius, penalty, recent, outcome } = minimization;
        *outcome = None;
        let Some(minimum) = self.minimize_model(here, curvatures, *radius, *penalty) else {
            *radius *= SHRINK;
            return *radius >= LEAST_RADIUS;
        };
        if minimum.penalty > *penalty {
            *penalty = minimum.penalty;
            recent.clear();
        }
        let x = minimum.x;
        let length = here.x.iter().zip(&x).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        if length <= shortest || length < LEAST_RADIUS {
            return false;
        }
        let now = self.value(here, *penalty);
        let gain = now - minimum.value;
        let Some(next) = self.evaluate(&x) else {
            *outcome = Some([gain, f64::NEG_INFINITY]);
            *radius = SHRINK * length;
            return true;
        };
        curvatures.learn(here, &next);
        let criticality_next = self.criticality(&next);
        let then = self.value(&next, *penalty);
        *outcome = Some([gain, now - then]);
        recent.push(now);
        let from = recent.iter().rev().take(MEMORY).fold(f64::NEG_INFINITY, |a, b| a.max(*b));
        let is_nearer = criticality_next.residual <= NEARER * criticality.residual
            && self.merit(&next).1 <= self.merit(here).1.max(LIMIT_KEPT);
        let is_down = then <= from - GAIN * gain;
        if is_down || is_nearer {
            if then <= now - 0.5 * gain && length >= 0.9 * *radius {
                *radius = (2.0 * *radius).min(1.0);
            }
            (*here, *criticality) = (next, criticality_next);
        } else {
            *radius = SHRINK * length;
        }
        *radius >= LEAST_RADIUS
    }

    /// Objective t with the penalty on the violation of limits.
    fn value(&self, state: &State, penalty: f64) -> f64 {
        let (t, violation) = self.merit(state);
        t + penalty * violation.max(0.0)
    }

    /// Minimises the model of all functions near a design, within a radius. Its multipliers enter the curvatures.
    fn minimize_model(
        &self,
        base: &State,
        curvatures: &mut Curvatures,
        radius: f64,
        mut penalty: f64,
    ) -> Option<ModelMinimum> {
        let Curvatures { secants, multipliers } = curvatures;
        let model = LocalModel { base, secants };
        let region: Vec<[f64; 2]> =
            base.x.iter().map(|x| [(x - radius).max(0.0), (x + radius).min(1.0)]).collect();
        let mut here = model.at(&base.x);
        let most_penalty = (MORE_PENALTY * penalty).min(MOST_PENALTY);
        let mut best: Option<(Vec<f64>, f64)> = None;
        let (mut within, mut recent) = (radius, Vec::<f64>::new());
        for k in 0..MODEL_STEPS {
            // The first multipliers are those of another design.
            let passes = if k == 0 { 2 } else { 1 };
            let Some(mut step) = self.step(&here, multipliers, (&region, within), penalty, passes) else {
                break;
            };
            if step.forces > 0.5 * penalty && penalty < most_penalty {
                penalty *= MORE_PENALTY;
                recent.clear();
                best = None;
                match self.step(&here, multipliers, (&region, within), penalty, 1) {
                    Some(next) => step = next,
                    None => break,
                }
            }
            let now = self.value(&here, penalty);
            if best.as_ref().is_none_or(|(_, value)| now < *value) {
                best = Some((here.x.clone(), now));
            }
            let length = step.p.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
            if length <= MODEL_SHARP * radius {
                break;
            }
            let x = here.x.iter().zip(&step.p).zip(&region);
            let x: Vec<f64> = x.map(|((x, p), [low, high])| (x + p).clamp(*low, *high)).collect();
            let next = model.at(&x);
            let then = self.value(&next, penalty);
            recent.push(now);
            let from = recent.iter().rev().take(MEMORY).fold(f64::NEG_INFINITY, |a, b| a.max(*b));
            if then <= from - GAIN * step.gain {
                if then <= now - FAIR * step.gain && length >= 0.9 * within {
                    within = (2.0 * within).min(radius);
                }
                here = next;
            } else {
                within = SHRINK * length;
            }
        }
        let now = self.value(&here, penalty);
        let (x, value) = best.filter(|(_, value)| *value < now).unwrap_or((here.x, now));
        (x != base.x).then_some(ModelMinimum { x, value, penalty })
    }

    /// Step of a quadratic program at a design of the model, within a region and a radius. Its multipliers replace
    /// the given ones.
    fn step(
        &self,
        state: &State,
        by_function: &mut Vec<f64>,
        region: (&[[f64; 2]], f64),
        penalty: f64,
        passes: usize,
    ) -> Option<Step> {
        let mut found = None;
        // The multipliers of the first solution correct the second derivatives of the second.
        for _ in 0..passes {
            let (constraints, owners, aux) = self.constraints(state, region);
            let n = state.x.len();
            let matrix = hessian(state, by_function);
            let mut h = vec![vec![0.0; n + aux]; n + aux];
            (0..n).for_each(|i| h[i][..n].copy_from_slice(&matrix[i]));
            (n..n + aux).for_each(|k| h[k][k] = SLIGHT);
            h[n + 1][n + 1] *= penalty * penalty;
            let mut g = vec![0.0; n + aux];
            (g[n], g[n + 1]) = (1.0, penalty);
            let Minimum { p, multipliers } = minimize(&h, &g, &constraints)?;
            let mut new = vec![0.0; state.functions.len()];
            let mut forces = 0.0;
            for (owner, m) in owners.iter().zip(&multipliers) {
                let Owner::Function { of, sign, factor } = *owner else { continue };
                new[of] += sign * factor * m;
                if matches!(state.functions[of].role, Role::Limit | Role::Equal | Role::End(_)) {
                    forces += m;
                }
            }
            // The smooth part of a goal has the multiplier of its goal.
            for (owner, m) in owners.iter().zip(&multipliers) {
                let Owner::Goal(goal) = *owner else { continue };
                if self.reference[goal].is_some_and(|[_, direction]| direction == 0.0) {
                    forces += m;
                }
                if let Some(k) = state.functions.iter().position(|f| f.role == Role::Goal(goal)) {
                    new[k] += m / self.scale.range[goal];
                }
            }
            *by_function = new;
            let gain = -(p[n] + penalty * p[n + 1]);
            found = Some(Step { p: p[..n].to_vec(), gain, multipliers, forces });
        }
        let step = found?;
        (step.gain.is_finite() && step.multipliers.iter().all(|m| m.is_finite())).then_some(step)
    }

    /// Linear constraints of a step, with the owner of each, and the number of auxiliary unknowns: t, the violation of
    /// limits, the maximum of each group of peaks, and both ends of each limited range.
    fn constraints(
        &self,
        state: &State,
        (region, radius): (&[[f64; 2]], f64),
    ) -> (Vec<Linear>, Vec<Owner>, usize) {
        let n = state.x.len();
        let (groups, ends) = (state.groups.len(), 2 * state.ranges.len());
        let aux = 2 + groups + ends;
        let (t, e, u, w) = (n, n + 1, n + 2, n + 2 + groups);
        let (t0, violation) = self.merit(state);
        let e0 = violation.max(0.0);
        let mut rows = Vec::new();
        let mut owners = Vec::new();
        let mut push = |d: &[f64], factor: f64, with: &[(usize, f64)], b: f64, owner: Owner| {
            let mut a = vec![0.0; n + aux];
            a.iter_mut().zip(d).for_each(|(a, d)| *a = factor * d);
            with.iter().for_each(|(k, by)| a[*k] = *by);
            rows.push(Linear { a, b });
            owners.push(owner);
        };
        let values = state.scaled(&self.scale);
        for (goal, reference) in self.reference.iter().enumerate() {
            let Some([a, direction]) = *reference else { continue };
            let per_range = 1.0 / self.scale.range[goal];
            let smooth = state.of_role(Role::Goal(goal)).next();
            let mut with: Vec<(usize, f64)> =
                (0..groups).filter(|g| state.groups[*g].0 == goal).map(|g| (u + g, 1.0)).collect();
            let free = if direction > 0.0 {
                with.push((t, -direction));
                a + direction * t0
            } else {
                with.push((e, -1.0));
                a + e0
            };
            let d = smooth.map_or(&[][..], |f| &f.d);
            push(d, per_range, &with, free - values[goal], Owner::Goal(goal));
        }
        for (of, f) in state.functions.iter().enumerate() {
            let mut own = |sign: f64, factor: f64, with: (usize, f64), b: f64| {
                push(&f.d, sign * factor, &[with], b, Owner::Function { of, sign, factor });
            };
            match f.role {
                Role::Goal(_) => {}
                Role::Peak(group) => {
                    let (goal, most) = state.groups[group];
                    if self.reference[goal].is_some() {
                        let per_range = 1.0 / self.scale.range[goal];
                        own(1.0, per_range, (u + group, -1.0), per_range * (most - f.value));
                    }
                }
                Role::Limit => own(1.0, 1.0, (e, -1.0), e0 - f.value),
                Role::Equal => {
                    own(1.0, 1.0, (e, -1.0), e0 - f.value);
                    own(-1.0, 1.0, (e, -1.0), e0 + f.value);
                }
                Role::End(end) => {
                    own(1.0, 1.0, (w + end, -1.0), state.greatest(Role::End(end)) - f.value);
                }
            }
        }
        for (k, most) in state.ranges.iter().enumerate() {
            let now: f64 = [0, 1].iter().map(|end| state.greatest(Role::End(2 * k + end))).sum();
            let with = [(w + 2 * k, 1.0), (w + 2 * k + 1, 1.0), (e, -1.0)];
            push(&[], 1.0, &with, most + e0 - now, Owner::Other);
        }
        push(&[], 1.0, &[(e, -1.0)], e0, Owner::Other);
        for (v, (x, [low, high])) in state.x.iter().zip(region).enumerate() {
            push(&[], 1.0, &[(v, 1.0)], radius.min(high - x), Owner::Other);
            push(&[], 1.0, &[(v, -1.0)], radius.min(x - low), Owner::Other);
        }
        (rows, owners, aux)
    }
}

/// Second derivatives of the Lagrangian, made positive definite.
///
/// ```text
/// H = sum m_k (second derivatives)_k + s sum of c c^T        c: unit gradients of the active functions
/// ```
///
/// The last sum does not act on the directions in which the active functions stay the same. It has the smallest
/// factor s that makes H positive definite; where none does, curvatures are replaced by their sizes, (H^2)^1/2.
fn hessian(state: &State, multipliers: &[f64]) -> Matrix {
    let n = state.x.len();
    let mut h = vec![vec![0.0; n]; n];
    let weighted = || state.functions.iter().zip(multipliers).filter(|(_, m)| **m != 0.0);
    for (f, m) in weighted() {
        for (row, other) in h.iter_mut().zip(&state.second[f.block]) {
            row.iter_mut().zip(other).for_each(|(x, y)| *x += m * y);
        }
    }
    let largest = (0..n).map(|k| h[k][k].abs()).fold(LEAST_CURVATURE, f64::max);
    let active = weighted().filter(|(f, _)| norm(&f.d) > 0.0);
    let mut active: Vec<Vec<f64>> =
        active.map(|(f, _)| f.d.iter().map(|d| d / norm(&f.d)).collect()).collect();
    for v in (0..n).filter(|v| state.x[*v] <= 0.0 || state.x[*v] >= 1.0) {
        active.push((0..n).map(|i| f64::from(u8::from(i == v))).collect());
    }
    let with = |by: f64, shift: f64| -> Matrix {
        let mut h = h.clone();
        for i in 0..n {
            for j in 0..n {
                h[i][j] += by * active.iter().map(|c| c[i] * c[j]).sum::<f64>();
            }
            h[i][i] += shift;
        }
        h
    };
    let mut augmented = AUGMENTATIONS.into_iter().map(|s| with(s * largest, FLAT * largest));
    augmented.find(|h| semidefinite::is_definite(h)).unwrap_or_else(|| sizes_of(&h, FLAT * largest))
}

/// The matrix `V |L| V^T` of a symmetric matrix `V L V^T`, with sizes of at least `least`.
fn sizes_of(h: &Matrix, least: f64) -> Matrix {
    let n = h.len();
    let Singular { values, directions, .. } = singular(h, n);
    let entry = |i: usize, j: usize| {
        values.iter().zip(&directions).map(|(s, v)| s.max(least) * v[i] * v[j]).sum::<f64>()
    };
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

/// Function or goal that a linear constraint belongs to.
#[derive(Clone, Copy, Debug)]
enum Owner {
    Goal(usize),
    Function { of: usize, sign: f64, factor: f64 },
    Other,
}

impl Curvatures {
    /// Adapts the sizes to the functions of a design.
    fn fit(&mut self, state: &State) {
        let n = state.x.len();
        self.secants.resize(state.blocks, vec![vec![0.0; n]; n]);
        if self.multipliers.len() != state.functions.len() {
            self.multipliers = vec![0.0; state.functions.len()];
        }
    }

    /// Mean of the multipliers of two neighbours, with the secants of the first.
    pub fn between(a: &Self, b: &Self) -> Self {
        let mut mean = a.clone();
        if a.multipliers.len() == b.multipliers.len() {
            mean.multipliers.iter_mut().zip(&b.multipliers).for_each(|(a, b)| *a = 0.5 * (*a + b));
        }
        mean
    }

    /// Multipliers of the goals alone, with known secants.
    pub fn of_weights(state: &State, scale: &Scale, weights: &[f64], known: Self) -> Self {
        let mut new = Self { multipliers: Vec::new(), ..known };
        new.fit(state);
        for (f, m) in state.functions.iter().zip(&mut new.multipliers) {
            if let Role::Goal(goal) = f.role {
                *m = weights[goal] / scale.range[goal];
            }
        }
        new
    }

    /// Symmetric rank-one update of each block by the change of its gradient.
    ///
    /// ```text
    /// S += r r^T / r^T s,    r = y - S s,    y = grad f(x + s) - grad f(x) - (linear residuals) s
    /// ```
    fn learn(&mut self, from: &State, to: &State) {
        if from.functions.len() != to.functions.len() || self.multipliers.len() != from.functions.len() {
            self.fit(to);
            return;
        }
        let s: Vec<f64> = to.x.iter().zip(&from.x).map(|(a, b)| a - b).collect();
        for block in 0..from.blocks {
            let members: Vec<usize> =
                (0..from.functions.len()).filter(|k| from.functions[*k].block == block).collect();
            let sum: f64 = members.iter().map(|k| self.multipliers[*k]).sum();
            let weight = |k: usize| match members.len() {
                1 => 1.0,
                _ if sum != 0.0 => self.multipliers[k] / sum,
                _ => 0.0,
            };
            if members.iter().all(|k| weight(*k) == 0.0) {
                continue;
            }
            let mut y = vec![0.0; s.len()];
            for k in &members {
                for (state, sign) in [(from, -1.0), (to, 1.0)] {
                    let f = &state.functions[*k];
                    match &f.residuals {
                        Some(residuals) => {
                            let linear = residuals.products();
                            // The gradient of half the square of a norm.
                            let (d, factor) = match residuals.form {
                                Form::Norm => (&residuals.slope(), 0.5),
                                Form::Square => (&f.d, 1.0),
                            };
                            for ((y, d), row) in y.iter_mut().zip(d).zip(&linear) {
                                *y += sign * d - factor * dot(row, &s);
                            }
                        }
                        None => y.iter_mut().zip(&f.d).for_each(|(y, d)| *y += sign * weight(*k) * d),
                    }
                }
            }
            let secant = &mut self.secants[block];
            // What is left of residuals is proportional to them, and falls with them.
            let is_norm = |residuals: &Residuals| residuals.form == Form::Norm;
            if members.iter().any(|k| from.functions[*k].residuals.as_ref().is_some_and(is_norm)) {
                let bent: f64 = secant.iter().zip(&s).map(|(row, x)| dot(row, &s) * x).sum();
                let size = (dot(&y, &s) / bent).abs();
                if size < 1.0 {
                    secant.iter_mut().flatten().for_each(|x| *x *= size);
                }
            }
            let r: Vec<f64> = y.iter().zip(secant.iter()).map(|(y, row)| y - dot(row, &s)).collect();
            let along = dot(&r, &s);
            if along.abs() > SECANT * norm(&r) * norm(&s) {
                for (row, a) in secant.iter_mut().zip(&r) {
                    row.iter_mut().zip(&r).for_each(|(x, b)| *x += a * b / along);
                }
            }
        }
    }
}

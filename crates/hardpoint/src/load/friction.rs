//! Coulomb friction in joints: from the forces that press there, which it changes itself; (46) of `docs/theory.md`.
//!
//! With M the friction moments of hinges and friction forces of slides, the joints carry `T(M) = T_0 + B M`, since
//! loads superpose. Each satisfies `M = -c N(T(M)) - d`, with N the normal force, c the friction coefficient (`mu r s`
//! of a hinge) and d the viscous part. These equations, one per joint with friction, are solved by Newton's method.

use crate::linalg::Elimination;
use crate::model::{ElementId, ElementKind, JointId, Model};
use crate::number::Dual;
use crate::space::{Real, Vec3, Wrench};

use super::acting::{AppliedLoads, pressing};
use super::carry::{Carried, Stress};
use super::measures::Instant;
use super::solver::LoadSolver;

/// Newton from no friction takes 3 to 7 steps where there is a solution; joints that have none after that many jam.
const MOST_STEPS: usize = 40;
/// Moments and forces are solved to this part of the largest term.
const SOLVED: f64 = 1e-13;
/// Other solutions are looked for from this many times the largest friction without the forces that friction itself
/// makes.
const FAR: f64 = 1e3;
/// Solutions that differ by more than this part of the friction are two: the same one is found to 1e-13.
const ANOTHER: f64 = 1e-6;

/// The joints that rub.
pub(super) struct Friction {
    rubs: Vec<FrictionElement>,
    /// `1 + diag(c) dN/dM` where it was solved.
    matrix: Elimination<f64>,
    /// Per joint that has friction: the moment or force, and its derivative by a variable.
    moments: Vec<f64>,
    changes: Vec<f64>,
}

struct FrictionElement {
    element: ElementId,
    joint: JointId,
    /// Friction coefficient c, viscous part d, and normal forces without friction.
    grip: f64,
    viscous: f64,
    presses: ([Vec3; 2], usize),
    /// Normal forces here per unit friction moment of every joint with friction.
    per_moment: Vec<[Vec3; 2]>,
    /// True if redundant constraints share the normal force.
    is_shared: bool,
    /// True if the friction has another solution besides the one that was found.
    is_ambiguous: bool,
}

impl FrictionElement {
    fn of(model: &Model, element: ElementId) -> Option<Self> {
        let (ElementKind::Friction { joint, .. } | ElementKind::SlideFriction { joint, .. }) =
            model.elements[element.0].kind
        else {
            return None;
        };
        let (presses, per_moment) = (([Vec3::ZERO; 2], 0), Vec::new());
        Some(Self {
            element,
            joint,
            grip: 0.0,
            viscous: 0.0,
            presses,
            per_moment,
            is_shared: false,
            is_ambiguous: false,
        })
    }
}

impl Friction {
    pub fn new(model: &Model) -> Self {
        let elements = (0..model.elements.len()).map(ElementId);
        let rubs: Vec<FrictionElement> = elements.filter_map(|e| FrictionElement::of(model, e)).collect();
        let n = rubs.len();
        Self { rubs, matrix: Elimination::new(n), moments: vec![0.0; n], changes: vec![0.0; n] }
    }

    pub fn is_empty(&self) -> bool {
        self.rubs.is_empty()
    }

    /// Takes what joints carry without friction; `responses` say what all of them carry of a unit moment in each that
    /// has friction.
    pub fn set(&mut self, acting: &AppliedLoads<'_, f64>, carried: &Carried<f64>, responses: &[Vec<Wrench>]) {
        for rub in &mut self.rubs {
            [rub.grip, rub.viscous] = acting.grip(rub.element);
            rub.presses = acting.presses(rub.element, carried.joints[rub.joint.0]);
            // Normal forces are linear in the joint's wrench.
            let per = |all: &Vec<Wrench>| acting.presses(rub.element, all[rub.joint.0]).0;
            rub.per_moment = responses.iter().map(per).collect();
        }
    }

    /// Solves for the friction moments. They are NaN if joints jam, or if self-stresses of redundant constraints change
    /// the normal forces.
    pub fn solve(&mut self, acting: &AppliedLoads<'_, f64>, stresses: &[Stress<f64>]) {
        self.moments.fill(0.0);
        for rub in &mut self.rubs {
            let leaves = |Stress { carried, most }: &Stress<f64>| {
                Instant { acting, carried }.presses_nothing(rub.element, rub.joint, *most)
            };
            rub.is_shared = !stresses.iter().all(leaves);
        }
        let known = self.shared().next().is_none();
        self.rubs.iter_mut().for_each(|rub| rub.is_ambiguous = false);
        let solved = known && (0..MOST_STEPS).any(|_| self.newton());
        if !solved || self.look_for_others() {
            self.moments.fill(f64::NAN);
        }
    }

    /// Searches for other solutions, and notes which friction differs between them.
    ///
    /// `M -> -c N(T_0 + B M) - d` contracts where the sum of `abs(c B)` is below 1 in every row, and has one solution
    /// then. Elsewhere Newton starts far out, where normal forces are as large as friction alone makes them.
    fn look_for_others(&mut self) -> bool {
        let gain = |rub: &FrictionElement| {
            let (_, count) = rub.presses;
            let all = rub.per_moment.iter().map(|b| b.iter().take(count).map(|f| f.norm()).sum::<f64>());
            rub.grip.abs() * all.sum::<f64>()
        };
        if self.rubs.iter().all(|rub| gain(rub) < 1.0) {
            return false;
        }
        let (found, n) = (self.moments.clone(), self.rubs.len());
        let size =
            |rub: &FrictionElement| rub.presses.0.iter().map(|f| f.norm()).sum::<f64>() * rub.grip.abs();
        let scale = self.rubs.iter().map(size).chain(found.iter().map(|m| m.abs())).fold(0.0, f64::max);
        let (mut others, far) = (false, FAR * scale);
        // One far out either way, the others as they are; then all.
        for (one, sign) in (0..=n).flat_map(|one| [(one, 1.0), (one, -1.0)]) {
            self.moments.copy_from_slice(&found);
            for (k, m) in self.moments.iter_mut().enumerate().filter(|(k, _)| one == n || *k == one) {
                *m = sign * far * if self.rubs[k].grip < 0.0 { -1.0 } else { 1.0 };
            }
            if !(0..MOST_STEPS).any(|_| self.newton()) {
                continue;
            }
            for ((m, first), rub) in self.moments.iter().zip(&found).zip(&mut self.rubs) {
                if (m - first).abs() > ANOTHER * scale {
                    (rub.is_ambiguous, others) = (true, true);
                }
            }
        }
        // The matrix of the one that was found.
        self.moments.copy_from_slice(&found);
        self.newton();
        others
    }

    /// One step; whether the moments were solved before it.
    fn newton(&mut self) -> bool {
        let n = self.rubs.len();
        let mut rhs = vec![0.0; n];
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for (k, rub) in self.rubs.iter().enumerate() {
            let (presses, count) = rub.presses;
            let row = self.matrix.row_mut(k);
            row.iter_mut().enumerate().for_each(|(c, entry)| *entry = f64::from(u8::from(c == k)));
            let mut size = 0.0;
            for (end, force) in presses.into_iter().enumerate().take(count) {
                let here = rub.per_moment.iter().map(|b| b[end]);
                let force = here.clone().zip(&self.moments).fold(force, |f, (b, m)| f + b * *m);
                let pressed = pressing(force);
                size += pressed;
                for (entry, b) in row.iter_mut().zip(here) {
                    *entry += rub.grip * force.dot(b) / pressed;
                }
            }
            // M + c N + d = 0
            rhs[k] = -(self.moments[k] + rub.grip * size + rub.viscous);
            worst = worst.max(rhs[k].abs());
            largest = largest.max(self.moments[k].abs()).max((rub.grip * size).abs()).max(rub.viscous.abs());
        }
        self.matrix.factor();
        if worst <= SOLVED * largest {
            return true;
        }
        self.matrix.solve(&mut rhs);
        self.moments.iter_mut().zip(rhs).for_each(|(m, step)| *m += step);
        false
    }

    /// Derivatives of the friction moments, from the joint wrenches at constant moments.
    pub fn differentiate(&mut self, acting: &AppliedLoads<'_, Dual>, carried: &Carried<Dual>) {
        for (change, rub) in self.changes.iter_mut().zip(&self.rubs) {
            // (1 + diag(c) dN/dM) M' = -(c' N + c N' + d')
            *change = -resistance(acting, rub, carried).d;
        }
        self.matrix.solve(&mut self.changes);
    }

    /// Elements whose friction is not determined, because redundant constraints share the normal force.
    pub fn shared(&self) -> impl Iterator<Item = ElementId> {
        self.rubs.iter().filter(|rub| rub.is_shared).map(|rub| rub.element)
    }

    /// Those that have more than one solution: grip so high that the friction itself makes the forces that it needs.
    pub fn ambiguous(&self) -> impl Iterator<Item = ElementId> {
        self.rubs.iter().filter(|rub| rub.is_ambiguous).map(|rub| rub.element)
    }

    /// The elements that rub, and their joints.
    pub fn elements(&self) -> impl Iterator<Item = ElementId> {
        self.rubs.iter().map(|h| h.element)
    }

    pub fn joints(&self) -> impl Iterator<Item = JointId> {
        self.rubs.iter().map(|h| h.joint)
    }

    /// By how much each equation `M + c N + d = 0` counts for a load with these derivatives by the moments:
    /// `E_M^T lambda = -y_M`.
    pub fn multipliers(&self, by_moments: Vec<f64>) -> Vec<f64> {
        let mut lambda: Vec<f64> = by_moments.iter().map(|x| -x).collect();
        self.matrix.clone().solve_transposed(&mut lambda);
        lambda
    }

    /// By how much the equations miss, each as much as it counts.
    pub fn misses(&self, acting: &AppliedLoads<'_, Dual>, carried: &Carried<Dual>, counts: &[f64]) -> Dual {
        let of = |(rub, counts): (&FrictionElement, &f64)| {
            // M + c N + d
            (acting.friction[rub.element.0] + resistance(acting, rub, carried)) * *counts
        };
        self.rubs.iter().zip(counts).map(of).fold(Dual::zero(), |sum, x| sum + x)
    }

    /// Enters the moments by element.
    pub fn enter(&self, out: &mut [f64]) {
        self.rubs.iter().zip(&self.moments).for_each(|(rub, m)| out[rub.element.0] = *m);
    }

    /// The same with their derivatives.
    pub fn enter_changed(&self, out: &mut [Dual]) {
        let both = self.moments.iter().zip(&self.changes);
        self.rubs.iter().zip(both).for_each(|(rub, (v, d))| out[rub.element.0] = Dual { v: *v, d: *d });
    }
}

impl LoadSolver<'_> {
    /// Friction that is not determined at the step that was solved, because redundant constraints share the normal
    /// force.
    pub fn shared_friction(&self) -> impl Iterator<Item = ElementId> {
        self.friction.shared()
    }

    /// Friction that has more than one solution at the step that was solved.
    pub fn ambiguous_friction(&self) -> impl Iterator<Item = ElementId> {
        self.friction.ambiguous()
    }
}

/// `c N + d`.
fn resistance<T: Real>(acting: &AppliedLoads<'_, T>, rub: &FrictionElement, carried: &Carried<T>) -> T {
    let [grip, viscous] = acting.grip(rub.element);
    let (presses, count) = acting.presses(rub.element, carried.joints[rub.joint.0]);
    presses.into_iter().take(count).fold(viscous, |sum, force| sum + grip * pressing(force))
}

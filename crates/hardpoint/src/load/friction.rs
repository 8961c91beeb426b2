//! Coulomb friction in joints, from normal forces that depend on the friction itself; (46) of `docs/theory.md`.
//!
//! With M the friction moments of hinges and friction forces of slides, the joint wrenches are `T(M) = T_0 + B M`,
//! since loads superpose. Each satisfies `M = -c N(T(M)) - d`, with N the normal force, c the friction coefficient
//! (`mu r s` of a hinge) and d the viscous part. Newton's method solves these equations, one per friction element.

use crate::linalg::Elimination;
use crate::model::{ElementId, JointId, Model};
use crate::space::{Real, Vec3, Wrench};

use super::acting::{AppliedLoads, force_size};
use super::measures::LoadMeasures;
use super::transmitted::{SelfStress, TransmittedLoads};

/// Maximum number of Newton iterations. Newton's method from zero friction takes 3 to 7 of them if there is a solution;
/// otherwise the joints jam.
const MOST_STEPS: usize = 40;
/// Relative tolerance of friction moments and forces, per largest term.
const SOLVED: f64 = 1e-13;
/// Starting point of the search for other solutions, as a multiple of the largest friction that the normal forces
/// without friction cause.
const FAR: f64 = 1e3;
/// Two solutions are different if they differ by more than this fraction of the friction; a solution is found to 1e-13.
const ANOTHER: f64 = 1e-6;

/// Friction elements of a model, with their equations.
pub(super) struct Friction {
    elements: Vec<FrictionElement>,
    /// `1 + diag(c) dN/dM` at the solution.
    matrix: Elimination<f64>,
    /// Per friction element: the moment or force.
    moments: Vec<f64>,
}

struct FrictionElement {
    element: ElementId,
    joint: JointId,
    /// Friction coefficient c, viscous part d, and normal forces without friction.
    coulomb: f64,
    viscous: f64,
    normal_forces: ([Vec3; 2], usize),
    /// Normal forces of this element per unit friction moment of every friction element.
    per_moment: Vec<[Vec3; 2]>,
    /// True if redundant constraints share the normal force.
    is_shared: bool,
    /// True if the friction has more than one solution.
    is_ambiguous: bool,
}

impl FrictionElement {
    fn of(model: &Model, element: ElementId) -> Option<Self> {
        let joint = model.elements[element.0].kind.friction(model)?.joint;
        let (normal_forces, per_moment) = (([Vec3::ZERO; 2], 0), Vec::new());
        Some(Self {
            element,
            joint,
            coulomb: 0.0,
            viscous: 0.0,
            normal_forces,
            per_moment,
            is_shared: false,
            is_ambiguous: false,
        })
    }
}

impl Friction {
    pub fn new(model: &Model) -> Self {
        let elements = (0..model.elements.len()).map(ElementId);
        let elements: Vec<FrictionElement> = elements.filter_map(|e| FrictionElement::of(model, e)).collect();
        let n = elements.len();
        Self { elements, matrix: Elimination::new(n), moments: vec![0.0; n] }
    }

    pub fn is_empty(&self) -> bool {
        self.elements.is_empty()
    }

    /// Sets the joint wrenches without friction; `responses` are the wrenches of all joints due to a unit moment of
    /// each friction element.
    pub fn set(
        &mut self,
        applied: &AppliedLoads<'_, f64>,
        transmitted: &TransmittedLoads<f64>,
        responses: &[Vec<Wrench>],
    ) {
        for friction in &mut self.elements {
            [friction.coulomb, friction.viscous] = applied.friction_coefficients(friction.element);
            friction.normal_forces =
                applied.normal_forces(friction.element, transmitted.joints[friction.joint.0]);
            // Normal forces are linear in the joint's wrench.
            let per = |all: &Vec<Wrench>| applied.normal_forces(friction.element, all[friction.joint.0]).0;
            friction.per_moment = responses.iter().map(per).collect();
        }
    }

    /// Solves for the friction moments. They are NaN if joints jam, or if self-stresses of redundant constraints change
    /// the normal forces.
    pub fn solve(&mut self, applied: &AppliedLoads<'_, f64>, stresses: &[SelfStress<f64>]) {
        self.moments.fill(0.0);
        for friction in &mut self.elements {
            let is_independent = |SelfStress { loads, largest }: &SelfStress<f64>| {
                LoadMeasures::of_stress(applied, loads).has_no_normal_force(
                    friction.element,
                    friction.joint,
                    *largest,
                )
            };
            friction.is_shared = !stresses.iter().all(is_independent);
        }
        let known = self.shared().next().is_none();
        self.elements.iter_mut().for_each(|friction| friction.is_ambiguous = false);
        let solved = known && (0..MOST_STEPS).any(|_| self.newton());
        if !solved || self.look_for_others() {
            self.moments.fill(f64::NAN);
        }
    }

    /// Searches for other solutions, and marks the elements whose friction differs between them.
    ///
    /// If the sum of `abs(c B)` is below 1 in every row, `M -> -c N(T_0 + B M) - d` is a contraction with one solution.
    /// Otherwise Newton's method starts far out, where friction alone determines the normal forces.
    fn look_for_others(&mut self) -> bool {
        let gain = |friction: &FrictionElement| {
            let (_, count) = friction.normal_forces;
            let all = friction.per_moment.iter().map(|b| b.iter().take(count).map(|f| f.norm()).sum::<f64>());
            friction.coulomb.abs() * all.sum::<f64>()
        };
        if self.elements.iter().all(|friction| gain(friction) < 1.0) {
            return false;
        }
        let (found, n) = (self.moments.clone(), self.elements.len());
        let size = |friction: &FrictionElement| {
            friction.normal_forces.0.iter().map(|f| f.norm()).sum::<f64>() * friction.coulomb.abs()
        };
        let scale = self.elements.iter().map(size).chain(found.iter().map(|m| m.abs())).fold(0.0, f64::max);
        let (mut others, far) = (false, FAR * scale);
        // First each moment alone is far out, in either direction; then all.
        for (one, sign) in (0..=n).flat_map(|one| [(one, 1.0), (one, -1.0)]) {
            self.moments.copy_from_slice(&found);
            for (k, m) in self.moments.iter_mut().enumerate().filter(|(k, _)| one == n || *k == one) {
                *m = sign * far * if self.elements[k].coulomb < 0.0 { -1.0 } else { 1.0 };
            }
            if !(0..MOST_STEPS).any(|_| self.newton()) {
                continue;
            }
            for ((m, first), friction) in self.moments.iter().zip(&found).zip(&mut self.elements) {
                if (m - first).abs() > ANOTHER * scale {
                    (friction.is_ambiguous, others) = (true, true);
                }
            }
        }
        // Restores the matrix of the first solution.
        self.moments.copy_from_slice(&found);
        self.newton();
        others
    }

    /// One Newton iteration; returns true if the moments were solved before it.
    fn newton(&mut self) -> bool {
        let n = self.elements.len();
        let mut rhs = vec![0.0; n];
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for (k, friction) in self.elements.iter().enumerate() {
            let (normal_forces, count) = friction.normal_forces;
            let row = self.matrix.row_mut(k);
            row.iter_mut().enumerate().for_each(|(c, entry)| *entry = f64::from(u8::from(c == k)));
            let mut size = 0.0;
            for (end, force) in normal_forces.into_iter().enumerate().take(count) {
                let here = friction.per_moment.iter().map(|b| b[end]);
                let force = here.clone().zip(&self.moments).fold(force, |f, (b, m)| f + b * *m);
                let normal = force_size(force);
                size += normal;
                for (entry, b) in row.iter_mut().zip(here) {
                    *entry += friction.coulomb * force.dot(b) / normal;
                }
            }
            // M + c N + d = 0
            rhs[k] = -(self.moments[k] + friction.coulomb * size + friction.viscous);
            worst = worst.max(rhs[k].abs());
            largest = largest
                .max(self.moments[k].abs())
                .max((friction.coulomb * size).abs())
                .max(friction.viscous.abs());
        }
        self.matrix.factor();
        if worst <= SOLVED * largest {
            return true;
        }
        self.matrix.solve(&mut rhs);
        self.moments.iter_mut().zip(rhs).for_each(|(m, step)| *m += step);
        false
    }

    /// True if the friction of all elements is determined.
    pub fn is_known(&self) -> bool {
        self.moments.iter().all(|m| m.is_finite())
    }

    /// Elements whose friction is not determined, because redundant constraints share the normal force.
    pub fn shared(&self) -> impl Iterator<Item = ElementId> {
        self.elements.iter().filter(|friction| friction.is_shared).map(|friction| friction.element)
    }

    /// Elements whose friction has more than one solution: the friction coefficient is so high that friction causes its
    /// own normal forces.
    pub fn ambiguous(&self) -> impl Iterator<Item = ElementId> {
        self.elements.iter().filter(|friction| friction.is_ambiguous).map(|friction| friction.element)
    }

    /// Friction elements.
    pub fn elements(&self) -> impl Iterator<Item = ElementId> {
        self.elements.iter().map(|h| h.element)
    }

    /// Joints of the friction elements.
    pub fn joints(&self) -> impl Iterator<Item = JointId> {
        self.elements.iter().map(|h| h.joint)
    }

    /// Solves for the Lagrange multipliers of the equations `M + c N + d = 0` of a load, given its derivatives by the
    /// moments: `E_M^T lambda = -y_M`.
    pub fn solve_multipliers(&self, by_moments: &mut [f64]) {
        by_moments.iter_mut().for_each(|x| *x = -*x);
        self.matrix.clone().solve_transposed(by_moments);
    }

    /// Residual of equation k.
    pub fn residual<T: Real>(
        &self,
        k: usize,
        applied: &AppliedLoads<'_, T>,
        transmitted: &TransmittedLoads<T>,
    ) -> T {
        let FrictionElement { element, joint, .. } = self.elements[k];
        let [coulomb, viscous] = applied.friction_coefficients(element);
        let (normal_forces, count) = applied.normal_forces(element, transmitted.joints[joint.0]);
        // M + c N + d
        let resistance = |sum: T, force| sum + coulomb * force_size(force);
        applied.friction[element.0] + normal_forces.into_iter().take(count).fold(viscous, resistance)
    }

    /// Writes the moments by element.
    pub fn write_moments(&self, out: &mut [f64]) {
        self.elements.iter().zip(&self.moments).for_each(|(friction, m)| out[friction.element.0] = *m);
    }
}

//! Coulomb friction in hinges: from the force across the pin, which it changes itself; (46) of `docs/theory.md`.
//!
//! With M the moments of all hinges that rub, what joints carry is `T(M) = T_0 + B M`, since loads superpose; each moment is to be
//! `M = -c N(T(M))`, with N the force across its pin and `c = mu r s` its grip. That is as many equations as hinges, solved by Newton.

use crate::linalg::Elimination;
use crate::model::{ElementId, ElementKind, JointId, MeasureKind, Model, ReactionPart};
use crate::number::Dual;
use crate::space::{Real, Vec3, Wrench};

use super::acting::Acting;
use super::carry::Carried;

/// Newton from no friction takes 3 to 7 steps where there is a solution; hinges that have none after so many jam.
const MOST_STEPS: usize = 40;
/// Moments are solved to this part of the largest term.
const SOLVED: f64 = 1e-13;
/// Forces below this, N, press no pin: the size of a force has a derivative at zero.
const PRESSES: f64 = 1e-9;

/// The hinges that rub.
pub(super) struct Friction {
    hinges: Vec<Hinge>,
    /// `1 + diag(c) dN/dM` where it was solved.
    matrix: Elimination<f64>,
    /// Per hinge: the moment, and its derivative by a variable.
    moments: Vec<f64>,
    changes: Vec<f64>,
}

struct Hinge {
    element: ElementId,
    joint: JointId,
    /// Its grip c, and the force across its pin without friction.
    grip: f64,
    across: Vec3,
    /// Per hinge: that force per unit moment there.
    per_moment: Vec<Vec3>,
}

impl Friction {
    pub fn new(model: &Model) -> Self {
        let hinge = |(e, element): (usize, &crate::model::Element)| match element.kind {
            ElementKind::Friction { joint, .. } => Some(Hinge {
                element: ElementId(e),
                joint,
                grip: 0.0,
                across: Vec3::ZERO,
                per_moment: Vec::new(),
            }),
            _ => None,
        };
        let hinges: Vec<Hinge> = model.elements.iter().enumerate().filter_map(hinge).collect();
        let n = hinges.len();
        Self { hinges, matrix: Elimination::new(n), moments: vec![0.0; n], changes: vec![0.0; n] }
    }

    pub fn is_empty(&self) -> bool {
        self.hinges.is_empty()
    }

    /// Takes what pins carry without friction; `responses` say what all joints carry of a unit moment in each hinge.
    pub fn set(&mut self, acting: &Acting<'_, f64>, carried: &Carried<f64>, responses: Vec<Vec<Wrench>>) {
        for hinge in &mut self.hinges {
            hinge.grip = acting.grip(hinge.element);
            hinge.across = across(acting, hinge.joint, carried.joints[hinge.joint.0]);
            let per = |all: &Vec<Wrench>| across(acting, hinge.joint, all[hinge.joint.0]);
            hinge.per_moment = responses.iter().map(per).collect();
        }
    }

    /// Finds the moments; they are no numbers where hinges jam, or where `is_known` says that a pin shares its force with others.
    pub fn solve(&mut self, is_known: impl Fn(&MeasureKind) -> bool) {
        self.moments.fill(0.0);
        let radial =
            |joint| MeasureKind::Reaction { joint, part: ReactionPart::Radial, on: None, axes: None };
        let known = self.hinges.iter().all(|h| is_known(&radial(h.joint)));
        if !(known && (0..MOST_STEPS).any(|_| self.newton())) {
            self.moments.fill(f64::NAN);
        }
    }

    /// One step; whether the moments were solved before it.
    fn newton(&mut self) -> bool {
        let n = self.hinges.len();
        let mut rhs = vec![0.0; n];
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for (k, hinge) in self.hinges.iter().enumerate() {
            let force =
                hinge.per_moment.iter().zip(&self.moments).fold(hinge.across, |f, (b, m)| f + *b * *m);
            let size = pressing(force);
            // M + c N = 0
            rhs[k] = -(self.moments[k] + hinge.grip * size);
            worst = worst.max(rhs[k].abs());
            largest = largest.max(self.moments[k].abs()).max((hinge.grip * size).abs());
            for (c, entry) in self.matrix.row_mut(k).iter_mut().enumerate() {
                *entry = f64::from(u8::from(c == k)) + hinge.grip * force.dot(hinge.per_moment[c]) / size;
            }
        }
        self.matrix.factor();
        if worst <= SOLVED * largest {
            return true;
        }
        self.matrix.solve(&mut rhs);
        self.moments.iter_mut().zip(rhs).for_each(|(m, step)| *m += step);
        false
    }

    /// How the moments change, from what pins carry while these stand.
    pub fn differentiate(&mut self, acting: &Acting<'_, Dual>, carried: &Carried<Dual>) {
        for (change, hinge) in self.changes.iter_mut().zip(&self.hinges) {
            let force = across(acting, hinge.joint, carried.joints[hinge.joint.0]);
            // (1 + diag(c) dN/dM) M' = -(c' N + c N')
            *change = -(acting.grip(hinge.element) * pressing(force)).d;
        }
        self.matrix.solve(&mut self.changes);
    }

    /// The elements that rub, and their joints.
    pub fn elements(&self) -> impl Iterator<Item = ElementId> {
        self.hinges.iter().map(|h| h.element)
    }

    pub fn joints(&self) -> impl Iterator<Item = JointId> {
        self.hinges.iter().map(|h| h.joint)
    }

    /// By how much each equation `M + c N = 0` counts for a load with these derivatives by the moments: `E_M^T lambda = -y_M`.
    pub fn multipliers(&self, by_moments: Vec<f64>) -> Vec<f64> {
        let mut lambda: Vec<f64> = by_moments.iter().map(|x| -x).collect();
        self.matrix.clone().solve_transposed(&mut lambda);
        lambda
    }

    /// By how much the equations miss, each as much as it counts.
    pub fn misses(&self, acting: &Acting<'_, Dual>, carried: &Carried<Dual>, counts: &[f64]) -> Dual {
        let of = |(hinge, counts): (&Hinge, &f64)| {
            let force = across(acting, hinge.joint, carried.joints[hinge.joint.0]);
            // M + c N
            (acting.friction[hinge.element.0] + acting.grip(hinge.element) * pressing(force)) * *counts
        };
        self.hinges.iter().zip(counts).map(of).fold(Dual::zero(), |sum, x| sum + x)
    }

    /// Enters the moments by element.
    pub fn enter(&self, out: &mut [f64]) {
        self.hinges.iter().zip(&self.moments).for_each(|(hinge, m)| out[hinge.element.0] = *m);
    }

    /// The same with their derivatives.
    pub fn enter_changed(&self, out: &mut [Dual]) {
        let both = self.moments.iter().zip(&self.changes);
        self.hinges.iter().zip(both).for_each(|(hinge, (v, d))| out[hinge.element.0] = Dual { v: *v, d: *d });
    }
}

/// The force across a hinge's axis.
fn across<T: Real>(acting: &Acting<'_, T>, joint: JointId, wrench: Wrench<T>) -> Vec3<T> {
    let body = acting.model.joints[joint.0].bodies[1];
    let z = acting.bodies[body.0].pose.rot * acting.geometry.markers[joint.0][1].rot.cols[2];
    wrench.f - z * z.dot(wrench.f)
}

/// Its size.
fn pressing<T: Real>(force: Vec3<T>) -> T {
    (force.dot(force) + T::constant(PRESSES * PRESSES)).sqrt()
}

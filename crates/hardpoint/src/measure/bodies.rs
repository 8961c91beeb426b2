//! Poses of bodies as numbers with derivatives.

use crate::motion::BodyState;
use crate::number::{Dual, Rates, Real};
use crate::sensitivity::BodySensitivity;
use crate::space::{Mat3, Pose, Vec3};

/// A body's pose with its rates.
pub(crate) fn with_rates(s: &BodyState) -> Pose<Rates> {
    let [x, y, z] = s.rotation.cols;
    moving([s.r, x, y, z, s.v, s.omega, s.a, s.alpha])
}

/// The same from r, the columns of A, v, omega, a and alpha.
pub(super) fn moving<T: Real>([r, x, y, z, v, omega, a, alpha]: [Vec3<T>; 8]) -> Pose<Rates<T>> {
    let column = |e: Vec3<T>| {
        // e. = omega x e,    e.. = alpha x e + omega x e.
        let e1 = omega.cross(e);
        let e2 = alpha.cross(e) + omega.cross(e1);
        Vec3::of_rates([e, e1, e2])
    };
    // r, r. = v, r.. = a of the frame's origin are known as they are.
    Pose { rot: Mat3 { cols: [column(x), column(y), column(z)] }, r: Vec3::of_rates([r, v, a]) }
}

/// A body's pose with its derivatives by one design variable, at rest.
pub(super) fn at_rest(s: &BodyState, d: &BodySensitivity) -> Pose<Dual> {
    // e_b = pi' x e
    let column = |e: Vec3| e.with_derivative(d.dpi.cross(e));
    Pose { rot: Mat3 { cols: s.rotation.cols.map(column) }, r: s.r.with_derivative(d.dr) }
}

/// The same, with the derivatives of all of it by one design variable.
pub(crate) fn with_sensitivity(s: &BodyState, d: &BodySensitivity) -> Pose<Dual<Rates>> {
    let Pose { rot, r } = with_rates(s);
    let column = |k: usize| {
        // With b = d/db:  e_b = pi' x e,    (e.)_b = omega_b x e + omega x e_b,
        //                 (e..)_b = alpha_b x e + alpha x e_b + omega_b x e. + omega x (e.)_b
        let e0 = s.rotation.cols[k];
        let e1 = s.omega.cross(e0);
        let b0 = d.dpi.cross(e0);
        let b1 = d.domega.cross(e0) + s.omega.cross(b0);
        let b2 = d.dalpha.cross(e0) + s.alpha.cross(b0) + d.domega.cross(e1) + s.omega.cross(b1);
        rot.cols[k].with_derivative(Vec3::of_rates([b0, b1, b2]))
    };
    Pose {
        rot: Mat3 { cols: [column(0), column(1), column(2)] },
        r: r.with_derivative(Vec3::of_rates([d.dr, d.dv, d.da])),
    }
}

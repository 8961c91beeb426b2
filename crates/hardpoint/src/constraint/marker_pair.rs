//! Pairs of markers, and the time derivatives of what is fixed in bodies.

use crate::number::{self, Jet, Rates};
use crate::space::{Mat3, Pose, Real, Twist, Vec3, Wrench};

/// The two markers of a joint, in world components.
#[derive(Clone, Copy, Debug)]
pub struct MarkerPair<T> {
    /// Pose of marker i.
    pub i: Pose<T>,
    /// Pose of marker j.
    pub j: Pose<T>,
    /// Axes of the loop's base, along which points are compared if the base moves. As the points coincide, the rotation
    /// of these axes has no effect.
    pub axes: Mat3<T>,
}

/// Twists of the two bodies, and the time derivatives of those twists.
#[derive(Clone, Copy, Debug)]
pub struct MarkerPairRates<T> {
    /// Twist V of body i.
    pub v_i: Twist<T>,
    /// Twist V of body j.
    pub v_j: Twist<T>,
    /// Rate of the twist, dV/dt, of body i.
    pub a_i: Twist<T>,
    /// Rate of the twist, dV/dt, of body j.
    pub a_j: Twist<T>,
}

impl<T: Real> MarkerPair<T> {
    /// This pair with the first two time derivatives of the markers.
    pub(super) fn moving(&self, rates: &MarkerPairRates<T>) -> MarkerPair<Rates<T>> {
        let vector = |[e, d, dd]: [Vec3<T>; 3]| {
            Vec3::new(Jet([e.x, d.x, dd.x]), Jet([e.y, d.y, dd.y]), Jet([e.z, d.z, dd.z]))
        };
        let marker = |Pose { rot, r }: Pose<T>, v, a| Pose {
            rot: Mat3 { cols: number::each(&rot.cols, |e| vector(direction_rates(e, v, a))) },
            r: vector(point_rates(r, v, a)),
        };
        MarkerPair {
            i: marker(self.i, rates.v_i, rates.a_i),
            j: marker(self.j, rates.v_j, rates.a_j),
            axes: Mat3 { cols: number::each(&self.axes.cols, |e| e.map(Jet::constant)) },
        }
    }
}

/// A direction fixed in a body with twist `v` and twist rate `a`, and its first two time derivatives.
#[inline(always)]
pub(super) fn direction_rates<T: Real>(e: Vec3<T>, v: Twist<T>, a: Twist<T>) -> [Vec3<T>; 3] {
    // e. = omega x e,    e.. = alpha x e + omega x e.                                                     (3)
    let d = v.w.cross(e);
    [e, d, a.w.cross(e) + v.w.cross(d)]
}

/// A point fixed in a body with twist `v` and twist rate `a`, and its first two time derivatives.
#[inline(always)]
pub(super) fn point_rates<T: Real>(p: Vec3<T>, v: Twist<T>, a: Twist<T>) -> [Vec3<T>; 3] {
    // p. = V at p,    p.. = V. at p + omega x p.
    let d = v.at(p);
    [p, d, a.at(p) + v.w.cross(d)]
}

/// First and second derivatives of the cross product of two vectors with known derivatives.
#[inline(always)]
pub(super) fn cross_rates<T: Real>(a: [Vec3<T>; 3], b: [Vec3<T>; 3]) -> [Vec3<T>; 2] {
    let two = T::constant(2.0);
    // (a x b). = a. x b + a x b.,    (a x b).. = a.. x b + 2 a. x b. + a x b..
    [a[1].cross(b[0]) + a[0].cross(b[1]), a[2].cross(b[0]) + a[1].cross(b[1]) * two + a[0].cross(b[2])]
}

/// First two time derivatives of the wrench of a force `f` through a moving point `p`.
#[inline(always)]
pub(super) fn force_rates<T: Real>(f: [Vec3<T>; 3], p: [Vec3<T>; 3]) -> [Wrench<T>; 2] {
    // l = [p x f; f]
    let [m1, m2] = cross_rates(p, f);
    [Wrench { m: m1, f: f[1] }, Wrench { m: m2, f: f[2] }]
}

/// Unit vector along axis k of a marker.
#[inline(always)]
pub(super) fn axis<T: Real>(frame: &Mat3<T>, k: usize) -> Vec3<T> {
    frame.cols[k]
}

//! Angles of marker j relative to marker i: about z_i, about x_j, about z_j, or seen along z_i.
//!
//! All are `atan2(s, c)` of two Dot-1 products. As a constraint, the residual is `sin(angle - f)`: it is zero with unit
//! slope at the solution, and has no branch cuts over any number of turns.

use crate::space::{Real, Vec3, Wrench};

use super::{MarkerPair, MarkerPairRates, axis, direction_rates};

/// s and c of the angle about z_i: tan(angle) = (y_i . x_j) / (x_i . x_j).
#[inline(always)]
fn about_z_i<T: Real>(ends: &MarkerPair<T>) -> [T; 2] {
    let x_j = axis(&ends.j.rot, 0);
    [axis(&ends.i.rot, 1).dot(x_j), axis(&ends.i.rot, 0).dot(x_j)]
}

/// s and c of the angle about x_j: tan(angle) = (z_i . y_j) / (z_i . z_j).
#[inline(always)]
fn about_x_j<T: Real>(ends: &MarkerPair<T>) -> [T; 2] {
    let z_i = axis(&ends.i.rot, 2);
    [z_i.dot(axis(&ends.j.rot, 1)), z_i.dot(axis(&ends.j.rot, 2))]
}

#[inline(always)]
fn sine_of_difference<T: Real>([s, c]: [T; 2], target: T) -> T {
    let (sin, cos) = target.sin_cos();
    // sin(angle - f) = sin(angle) cos f - cos(angle) sin f.  Its rate at the root is that of the angle itself.
    s * cos - c * sin
}

/// Angle with this sine and cosine (up to a common factor) that is nearest to `near`, rad.
#[inline(never)]
fn unwrapped<T: Real>([s, c]: [T; 2], near: T) -> T {
    s.angle_near(c, near)
}

/// Angle about z_i nearest to `near`, rad.
#[inline(always)]
pub(super) fn value<T: Real>(ends: &MarkerPair<T>, near: T) -> T {
    unwrapped(about_z_i(ends), near)
}

/// Angle about x_j nearest to `near`, rad.
#[inline(always)]
pub(super) fn value_on_j<T: Real>(ends: &MarkerPair<T>, near: T) -> T {
    unwrapped(about_x_j(ends), near)
}

#[inline(always)]
pub(super) fn residual<T: Real>(ends: &MarkerPair<T>, target: T) -> T {
    sine_of_difference(about_z_i(ends), target)
}

/// Wrench of the angle about z_i: the moment z_i.
#[inline(always)]
pub(super) fn wrench<T: Real>(ends: &MarkerPair<T>) -> Wrench<T> {
    Wrench::moment(axis(&ends.i.rot, 2))
}

#[inline(always)]
pub(super) fn wrench_rates<T: Real>(ends: &MarkerPair<T>, rates: &MarkerPairRates<T>) -> [Wrench<T>; 2] {
    // l = [z_i; 0]
    let [_, z1, z2] = direction_rates(axis(&ends.i.rot, 2), rates.v_i, rates.a_i);
    [Wrench::moment(z1), Wrench::moment(z2)]
}

#[inline(always)]
pub(super) fn residual_on_j<T: Real>(ends: &MarkerPair<T>, target: T) -> T {
    sine_of_difference(about_x_j(ends), target)
}

/// Wrench of the angle about x_j: the moment x_j.
#[inline(always)]
pub(super) fn wrench_on_j<T: Real>(ends: &MarkerPair<T>) -> Wrench<T> {
    Wrench::moment(axis(&ends.j.rot, 0))
}

/// `sin(angle - f)` for the angle of x_j seen along z_i: the products are divided by the length of x_j in this view.
#[inline(always)]
pub(super) fn heading_residual<T: Real>(ends: &MarkerPair<T>, target: T) -> T {
    residual_seen(about_z_i(ends), target)
}

/// Wrench of the angle of x_j seen along z_i.
#[inline(always)]
pub(super) fn heading_wrench<T: Real>(ends: &MarkerPair<T>) -> Wrench<T> {
    wrench_seen(ends, axis(&ends.j.rot, 0), about_z_i(ends))
}

/// `sin(angle - f)` for the angle about x_j where z_i is not perpendicular to it.
#[inline(always)]
pub(super) fn heading_on_j_residual<T: Real>(ends: &MarkerPair<T>, target: T) -> T {
    residual_seen(about_x_j(ends), target)
}

/// Wrench of that angle: the moment `(c y_j - s z_j) x z_i / (s^2 + c^2)`.
#[inline(always)]
pub(super) fn heading_on_j_wrench<T: Real>(ends: &MarkerPair<T>) -> Wrench<T> {
    // ds = (y_j x z_i) . (w_j - w_i),  dc = (z_j x z_i) . (w_j - w_i)
    let [s, c] = about_x_j(ends);
    let g = axis(&ends.j.rot, 1) * c - axis(&ends.j.rot, 2) * s;
    Wrench::moment(g.cross(axis(&ends.i.rot, 2)) * (T::one() / (s * s + c * c)))
}

/// s and c of the last Cardan angle, gamma of `Rx(alpha) Ry(beta) Rz(gamma)`: tan(gamma) = -(x_i . y_j) / (x_i . x_j).
#[inline(always)]
fn about_z_j<T: Real>(ends: &MarkerPair<T>) -> [T; 2] {
    let x_i = axis(&ends.i.rot, 0);
    [-x_i.dot(axis(&ends.j.rot, 1)), x_i.dot(axis(&ends.j.rot, 0))]
}

/// Last Cardan angle nearest to `near`, rad.
#[inline(always)]
pub(super) fn cardan<T: Real>(ends: &MarkerPair<T>, near: T) -> T {
    unwrapped(about_z_j(ends), near)
}

/// `sin(angle - f)` for the last Cardan angle.
#[inline(always)]
pub(super) fn cardan_residual<T: Real>(ends: &MarkerPair<T>, target: T) -> T {
    residual_seen(about_z_j(ends), target)
}

/// Wrench of the last Cardan angle: the moment `x_i x (c y_j + s x_j) / (s^2 + c^2)`, which is z_j if the z axes are
/// parallel.
#[inline(always)]
pub(super) fn cardan_wrench<T: Real>(ends: &MarkerPair<T>) -> Wrench<T> {
    // ds = -(y_j x x_i) . (w_j - w_i),  dc = (x_j x x_i) . (w_j - w_i)
    let [s, c] = about_z_j(ends);
    let g = axis(&ends.j.rot, 1) * c + axis(&ends.j.rot, 0) * s;
    Wrench::moment(axis(&ends.i.rot, 0).cross(g) * (T::one() / (s * s + c * c)))
}

/// s and c of the angle of z_j about z_i: tan(angle) = (y_i . z_j) / (x_i . z_j).
#[inline(always)]
fn course_about_z_i<T: Real>(ends: &MarkerPair<T>) -> [T; 2] {
    let z_j = axis(&ends.j.rot, 2);
    [axis(&ends.i.rot, 1).dot(z_j), axis(&ends.i.rot, 0).dot(z_j)]
}

/// Angle of z_j about z_i nearest to `near`, rad.
#[inline(always)]
pub(super) fn course<T: Real>(ends: &MarkerPair<T>, near: T) -> T {
    unwrapped(course_about_z_i(ends), near)
}

/// `sin(angle - f)` for the angle of z_j seen along z_i.
#[inline(always)]
pub(super) fn course_residual<T: Real>(ends: &MarkerPair<T>, target: T) -> T {
    residual_seen(course_about_z_i(ends), target)
}

/// Wrench of the angle of z_j seen along z_i.
#[inline(always)]
pub(super) fn course_wrench<T: Real>(ends: &MarkerPair<T>) -> Wrench<T> {
    wrench_seen(ends, axis(&ends.j.rot, 2), course_about_z_i(ends))
}

/// `sin(angle - f)` for an axis of any direction: the products are divided by its length seen along z_i.
#[inline(always)]
fn residual_seen<T: Real>([s, c]: [T; 2], target: T) -> T {
    sine_of_difference([s, c], target) / (s * s + c * c).sqrt()
}

/// The moment `a_j x (c y_i - s x_i) / (s^2 + c^2)`, the gradient of atan2(s, c) for axis a of marker j.
#[inline(always)]
fn wrench_seen<T: Real>(ends: &MarkerPair<T>, a_j: Vec3<T>, [s, c]: [T; 2]) -> Wrench<T> {
    // d atan2(s, c) = (c ds - s dc) / (s^2 + c^2),  ds = (a_j x y_i) . (w_j - w_i),  dc = (a_j x x_i) . (w_j - w_i)
    let g = axis(&ends.i.rot, 1) * c - axis(&ends.i.rot, 0) * s;
    Wrench::moment(a_j.cross(g) * (T::one() / (s * s + c * c)))
}

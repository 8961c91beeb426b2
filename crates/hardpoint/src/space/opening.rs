//! Displacement of one marker relative to another along six coordinates, and the unit wrench of each.
//!
//! The coordinates are those of the chain `S(x, y, z) Rx(alpha) Ry(beta) Rz(gamma)` from marker i to marker j: the
//! displacement along the axes of marker i, then Cardan angles. Those of a cross of two pins are those of
//! `S(x, y, z) Rz(gamma) Ry(beta) Rx(alpha)`: the angles about its pins, and the turn between them. A force that works
//! on them has a potential if its stiffnesses are symmetric. Turns about z may have any size, and are counted; alpha
//! and beta stay below 90 deg, alpha of a cross below 180 deg.

use super::{Pose, Real, Vec3, Wrench};

/// Coordinates of marker j relative to marker i: x, y, z, m; alpha, beta, gamma, rad.
pub(crate) struct Opening<T> {
    pub coordinates: [T; 6],
    /// Coordinates in the design configuration; known only while loads grow, and zero for joints.
    pub in_design: [T; 6],
    /// Per coordinate: the unit wrench on body j that does work on it, about the world origin.
    pub wrenches: [Wrench<T>; 6],
}

impl<T: Real> Opening<T> {
    /// Opening between two markers, global, with gamma within half a turn of `near`.
    pub fn between(i: &Pose<T>, j: &Pose<T>, near: T) -> Self {
        let [x_i, y_i, z_i] = i.rot.cols;
        let [x_j, y_j, z_j] = j.rot.cols;
        // M = A_i^T A_j = Rx(alpha) Ry(beta) Rz(gamma)
        let [m11, m12, m13] = [x_i.dot(x_j), x_i.dot(y_j), x_i.dot(z_j)];
        let [m23, m33] = [y_i.dot(z_j), z_i.dot(z_j)];
        // cos(beta) sin(alpha) = -M23, cos(beta) cos(alpha) = M33
        let cosine = (m23 * m23 + m33 * m33).sqrt();
        let per = T::one() / cosine;
        let alpha = (-m23).atan2(m33);
        let beta = m13.atan2(cosine);
        let gamma = (-m12).angle_near(m11, near);
        // l_alpha = a2 x a3 / D, l_beta = a3 x a1 / D, l_gamma = a1 x a2 / D, of the axes a1 = x_i,
        // a2 = y_i cos(alpha) + z_i sin(alpha), a3 = z_j, with D = a1 . (a2 x a3) = cos(beta)
        let a2 = y_i * (m33 * per) - z_i * (m23 * per);
        Self::of_chain(i, j, [alpha, beta, gamma], [a2.cross(z_j), z_j.cross(x_i), x_i.cross(a2)], per)
    }

    /// Opening of a cross whose pins are along z_i and x_j, with gamma, the angle about z_i, within half a turn of
    /// `near`.
    pub fn of_cross(i: &Pose<T>, j: &Pose<T>, near: T) -> Self {
        let [x_i, y_i, z_i] = i.rot.cols;
        let [x_j, y_j, z_j] = j.rot.cols;
        // M = A_i^T A_j = Rz(gamma) Ry(beta) Rx(alpha)
        let [m11, m21, m31] = [x_i.dot(x_j), y_i.dot(x_j), z_i.dot(x_j)];
        let [m32, m33] = [z_i.dot(y_j), z_i.dot(z_j)];
        // cos(beta) cos(gamma) = M11, cos(beta) sin(gamma) = M21
        let cosine = (m11 * m11 + m21 * m21).sqrt();
        let per = T::one() / cosine;
        let alpha = m32.atan2(m33);
        let beta = (-m31).atan2(cosine);
        let gamma = m21.angle_near(m11, near);
        // l_alpha = a2 x a1 / D, l_beta = a1 x a3 / D, l_gamma = a3 x a2 / D, of the axes a1 = z_i,
        // a2 = y_i cos(gamma) - x_i sin(gamma), a3 = x_j, with D = a3 . (a2 x a1) = cos(beta)
        let a2 = y_i * (m11 * per) - x_i * (m21 * per);
        Self::of_chain(i, j, [alpha, beta, gamma], [a2.cross(z_i), z_i.cross(x_j), x_j.cross(a2)], per)
    }

    /// Opening with these angles; the moment of each is its direction times `per`.
    #[inline(always)]
    fn of_chain(
        i: &Pose<T>,
        j: &Pose<T>,
        [alpha, beta, gamma]: [T; 3],
        [about_x, about_y, about_z]: [Vec3<T>; 3],
        per: T,
    ) -> Self {
        let [x_i, y_i, z_i] = i.rot.cols;
        let d = i.rot.transpose_mul(j.r - i.r);
        let turn = |l: Vec3<T>| Wrench::moment(l * per);
        let slide = |axis: Vec3<T>| Wrench::force(axis, j.r);
        // Without `map`, which the compiler does not inline for arrays of this size.
        let wrenches = [slide(x_i), slide(y_i), slide(z_i), turn(about_x), turn(about_y), turn(about_z)];
        Self { coordinates: [d.x, d.y, d.z, alpha, beta, gamma], in_design: [T::zero(); 6], wrenches }
    }
}

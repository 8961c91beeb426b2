//! Rotation matrices.

use std::ops::Mul;

use crate::number::{Dual, Real};

use super::Vec3;

/// Terms of the series of a half angle: the next one is below round-off up to two turns.
const HALF_ANGLE_TERMS: u32 = 24;

/// Rotation matrix, stored as the unit vectors of the rotated frame: `A = [f g h]` (paper Eq. 2.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mat3<T = f64> {
    /// Columns f, g, h: the x, y and z axes of the rotated frame.
    pub cols: [Vec3<T>; 3],
}

impl Mat3<f64> {
    /// No rotation.
    pub const IDENTITY: Self = Self { cols: Vec3::AXES };

    /// This rotation in another scalar type, as a constant.
    #[inline(always)]
    pub fn spread<T: Real>(self) -> Mat3<T> {
        let [f, g, h] = self.cols;
        Mat3 { cols: [f.spread(), g.spread(), h.spread()] }
    }

    /// Rotation by the rotation vector `v` (its length is the angle, rad; its direction is the axis).
    pub fn from_rotation_vector(v: Vec3) -> Self {
        let angle = v.norm();
        if angle == 0.0 {
            return Self::IDENTITY;
        }
        Self::about(v * (1.0 / angle), angle)
    }

    /// True if this linear map, not necessarily a rotation, mirrors: its determinant is negative. The orientation of
    /// triangles is then reversed.
    pub fn is_mirror(self) -> bool {
        let [f, g, h] = self.cols;
        f.cross(g).dot(h) < 0.0
    }

    /// Angle of the rotation from this orientation to another, rad, 0 to pi.
    pub fn angle_to(self, o: Self) -> f64 {
        let d = self.transpose() * o;
        let [f, g, h] = d.cols;
        // Half the antisymmetric part is the axis times the sine; it is accurate for small angles, the trace is not.
        let sine = 0.5 * Vec3::new(g.z - h.y, h.x - f.z, f.y - g.x).norm();
        sine.atan2(0.5 * (f.x + g.y + h.z - 1.0))
    }
}

impl<T: Real> Mat3<T> {
    /// This rotation with its derivative along the angular velocity `w` of the rotated frame: `A' = w x A`.
    #[inline(always)]
    pub fn along(self, w: Vec3<T>) -> Mat3<Dual<T>> {
        T::operation(|| {
            let of = |c: Vec3<T>| c.with_derivative(w.cross(c));
            let [f, g, h] = self.cols;
            Mat3 { cols: [of(f), of(g), of(h)] }
        })
    }

    /// Rotation by `angle`, rad, about a unit vector.
    pub fn about(axis: Vec3, angle: T) -> Self {
        let (s, c) = angle.sin_cos();
        let one = T::one();
        let turn = |e: Vec3| {
            let along = (axis * axis.dot(e)).spread();
            // Rodrigues: e cos + (n x e) sin + n (n . e) (1 - cos)
            e.spread() * c + axis.cross(e).spread() * s + along * (one - c)
        };
        let [x, y, z] = Vec3::AXES;
        Self { cols: [turn(x), turn(y), turn(z)] }
    }

    /// Rotation by a rotation vector, rad: smooth at zero, and exact to round-off up to two turns.
    pub fn about_vector(v: Vec3<T>) -> Self {
        let one = T::one();
        let half = v * T::constant(0.5);
        let s = half.dot(half);
        // cos sqrt(s) and sin sqrt(s) / sqrt(s), by their series
        let (mut c, mut k) = (one, one);
        for n in (1..=HALF_ANGLE_TERMS).rev() {
            let n = 2.0 * f64::from(n);
            c = one - s * c * T::constant(1.0 / ((n - 1.0) * n));
            k = one - s * k * T::constant(1.0 / (n * (n + 1.0)));
        }
        let (half, two) = (half * k, T::constant(2.0));
        let turn = |e: Vec3| {
            // e + 2 c (h x e) + 2 h x (h x e), of the unit quaternion (c, h)
            let turned = half.cross(e.spread());
            e.spread() + (turned * c + half.cross(turned)) * two
        };
        let [x, y, z] = Vec3::AXES;
        Self { cols: [turn(x), turn(y), turn(z)] }
    }

    /// Smallest rotation that maps unit vector `a` to unit vector `b`, which must not be opposite.
    pub fn between(a: Vec3<T>, b: Vec3<T>) -> Self {
        let v = a.cross(b);
        let one = T::one();
        // e + v x e + v x (v x e) / (1 + a . b),  v = a x b = n sin: Rodrigues with (1 - cos) / sin^2 = 1 / (1 + cos)
        let k = one / (one + a.dot(b));
        let turn = |e: Vec3| {
            let turned = v.cross(e.spread());
            e.spread() + turned + v.cross(turned) * k
        };
        let [x, y, z] = Vec3::AXES;
        Self { cols: [turn(x), turn(y), turn(z)] }
    }

    /// Transpose, which is the inverse rotation.
    #[inline(always)]
    pub fn transpose(self) -> Self {
        let [f, g, h] = self.cols;
        Self { cols: [Vec3::new(f.x, g.x, h.x), Vec3::new(f.y, g.y, h.y), Vec3::new(f.z, g.z, h.z)] }
    }

    /// Transpose times a vector: maps world components to components in the rotated frame.
    #[inline(always)]
    pub fn transpose_mul(self, v: Vec3<T>) -> Vec3<T> {
        T::operation(|| Vec3::new(self.cols[0].dot(v), self.cols[1].dot(v), self.cols[2].dot(v)))
    }

    /// This orientation rotated about its own axis `k` by the angle with this sine and cosine.
    #[inline(always)]
    pub fn turned(self, k: usize, sin: T, cos: T) -> Self {
        T::operation(|| {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            let mut cols = self.cols;
            // a <- a cos + b sin,    b <- b cos - a sin;  a, b the axes after k
            cols[a] = self.cols[b].times_plus(sin, self.cols[a] * cos);
            cols[b] = self.cols[a].times_plus(-sin, self.cols[b] * cos);
            Self { cols }
        })
    }

    /// This matrix times a vector, plus another vector.
    #[inline(always)]
    pub fn times_plus(self, v: Vec3<T>, addend: Vec3<T>) -> Vec3<T> {
        T::operation(|| {
            let [f, g, h] = self.cols;
            h.times_plus(v.z, g.times_plus(v.y, f.times_plus(v.x, addend)))
        })
    }

    /// This rotation as plain numbers.
    #[inline(always)]
    pub fn value(self) -> Mat3<f64> {
        let [f, g, h] = &self.cols;
        Mat3 { cols: [f.value(), g.value(), h.value()] }
    }
}

impl<T: Real> Mul<Vec3<T>> for Mat3<T> {
    type Output = Vec3<T>;
    #[inline(always)]
    fn mul(self, v: Vec3<T>) -> Vec3<T> {
        T::operation(|| {
            let [f, g, h] = self.cols;
            h.times_plus(v.z, g.times_plus(v.y, f * v.x))
        })
    }
}

impl<T: Real> Mul for Mat3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        T::operation(|| {
            let [f, g, h] = o.cols;
            Self { cols: [self * f, self * g, self * h] }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_vector_is_smooth_at_zero_and_exact_up_to_two_turns() {
        for angle in [0.0, 1e-9, 0.3, 2.0, 3.2, 6.5, 12.5] {
            let v = Vec3::new(2.0, -1.0, 2.0) * (angle / 3.0);
            let off = Mat3::about_vector(v).cols.map(|c| c.to_array()).as_flattened().to_vec();
            let known = Mat3::from_rotation_vector(v).cols.map(|c| c.to_array()).as_flattened().to_vec();
            assert!(off.iter().zip(&known).all(|(a, b)| (a - b).abs() < 1e-13), "{angle}: {off:?} {known:?}");
        }
        // d exp(b u) / db = u x at zero
        let u = Vec3::new(0.3, -0.8, 0.5);
        let turned = Mat3::about_vector(u.spread::<Dual>() * Dual::variable(0.0));
        for (column, e) in turned.cols.iter().zip(Vec3::AXES) {
            assert_eq!([column.x.d, column.y.d, column.z.d], u.cross(e).to_array());
        }
    }
}

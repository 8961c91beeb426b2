//! Unit quaternions: the rotation of a spherical joint, stored without singularities.

use crate::number::{self, Real};

use super::{Mat3, Vec3};

/// A rotation as a unit quaternion `w + x i + y j + z k`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quat<T = f64> {
    /// Scalar part.
    pub w: T,
    /// Vector part.
    pub v: Vec3<T>,
}

impl Quat<f64> {
    /// No rotation.
    pub const IDENTITY: Self = Self { w: 1.0, v: Vec3::ZERO };

    /// This rotation in another scalar type, as a constant.
    #[inline(always)]
    pub fn spread<T: Real>(self) -> Quat<T> {
        Quat { w: T::constant(self.w), v: self.v.spread() }
    }

    /// Normalised quaternion `[w, x, y, z]`; `None` if it is zero or not finite.
    pub fn from_array(q: [f64; 4]) -> Option<Self> {
        let n = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        let [w, x, y, z] = number::each(&q, |c| c / n);
        (n > 1e-12 && n.is_finite()).then_some(Self { w, v: Vec3::new(x, y, z) })
    }

    /// Components `[w, x, y, z]` with w >= 0.
    pub fn to_array(self) -> [f64; 4] {
        let s = if self.w < 0.0 { -1.0 } else { 1.0 };
        [s * self.w, s * self.v.x, s * self.v.y, s * self.v.z]
    }

    /// Rotation vector of this rotation: the axis times the angle, rad, 0 to pi.
    pub fn rotation_vector(self) -> Vec3 {
        let [w, x, y, z] = self.to_array();
        let v = Vec3::new(x, y, z);
        let sine = v.norm();
        // angle = 2 atan2(abs(v), w); for a small rotation the vector is 2 v
        let per_sine = if sine > 0.0 { 2.0 * sine.atan2(w) / sine } else { 2.0 };
        v * per_sine
    }

    /// Quaternion of a rotation matrix, computed from its largest component (Shepperd).
    pub fn from_rotation(a: Mat3) -> Self {
        let [f, g, h] = a.cols;
        // 1 + sizes = 4 w^2, 4 x^2, 4 y^2, 4 z^2; the largest is at least 1, so that no divisor is small.
        let sizes = [f.x + g.y + h.z, f.x - g.y - h.z, g.y - f.x - h.z, h.z - f.x - g.y];
        let k = (0..4).fold(0, |best, k| if sizes[k] > sizes[best] { k } else { best });
        let s = 0.5 / (1.0 + sizes[k]).sqrt();
        let big = 0.25 / s;
        let (w, v) = match k {
            0 => (big, Vec3::new(g.z - h.y, h.x - f.z, f.y - g.x) * s),
            1 => ((g.z - h.y) * s, Vec3::new(big, (f.y + g.x) * s, (h.x + f.z) * s)),
            2 => ((h.x - f.z) * s, Vec3::new((f.y + g.x) * s, big, (g.z + h.y) * s)),
            _ => ((f.y - g.x) * s, Vec3::new((h.x + f.z) * s, (g.z + h.y) * s, big)),
        };
        Self { w, v }
    }
}

impl<T: Real> Quat<T> {
    /// This rotation followed by the small rotation `d` about the *fixed* axes, rad; normalised.
    ///
    /// The increment is Cayley's `(1, d/2)`, whose angle is |d| up to |d|^3 / 12. This is sufficient for a Newton
    /// update (only the fixed point matters) and for a second-order predictor.
    #[inline(always)]
    pub fn nudged(self, d: Vec3<T>) -> Self {
        let h = d * T::constant(0.5);
        // (1, d/2) q = (q_w - d/2 . q_v,  q_v + q_w d/2 + d/2 x q_v)
        let w = self.w - h.dot(self.v);
        let v = self.v + h * self.w + h.cross(self.v);
        Self { w, v }.normalised()
    }

    /// This rotation as plain numbers.
    #[inline(always)]
    pub fn value(self) -> Quat<f64> {
        Quat { w: self.w.value(), v: self.v.value() }
    }

    /// This quaternion scaled to unit length.
    #[inline(always)]
    pub fn normalised(self) -> Self {
        let k = T::one() / (self.w * self.w + self.v.dot(self.v)).sqrt();
        Self { w: self.w * k, v: self.v * k }
    }

    /// Time derivative if the frame rotates with angular velocity `w` in *fixed* axes: `(0, w) q / 2`.
    #[inline(always)]
    pub(crate) fn rate(self, w: Vec3<T>) -> Self {
        // (0, w/2) q
        let h = w * T::constant(0.5);
        Self { w: -h.dot(self.v), v: h * self.w + h.cross(self.v) }
    }

    /// Componentwise sum; not a rotation.
    #[inline(always)]
    pub(crate) fn plus(self, o: Self) -> Self {
        Self { w: self.w + o.w, v: self.v + o.v }
    }

    /// Component 0 (scalar part) to 3.
    #[inline(always)]
    pub(crate) fn component(self, k: usize) -> T {
        if k == 0 { self.w } else { self.v[k - 1] }
    }

    /// Rotation matrix of this quaternion.
    #[inline(always)]
    pub fn rotation(self) -> Mat3<T> {
        let two = T::constant(2.0);
        let one = T::one();
        let (w, x, y, z) = (self.w, self.v.x, self.v.y, self.v.z);
        Mat3 {
            cols: [
                Vec3::new(one - two * (y * y + z * z), two * (x * y + w * z), two * (x * z - w * y)),
                Vec3::new(two * (x * y - w * z), one - two * (x * x + z * z), two * (y * z + w * x)),
                Vec3::new(two * (x * z + w * y), two * (y * z - w * x), one - two * (x * x + y * y)),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quaternion_and_matrix_are_the_same_rotation() {
        for v in [[0.1, 0.2, -0.3], [3.0, 0.1, 0.0], [0.0, 3.1, 0.2], [0.1, 0.0, 3.13], [0.0; 3]] {
            let a = Mat3::from_rotation_vector(v.into());
            let b = Quat::from_rotation(a).rotation();
            for k in 0..3 {
                assert!((a.cols[k] - b.cols[k]).norm() < 1e-14, "{v:?}");
            }
        }
    }

    #[test]
    fn nudge_turns_about_fixed_axes() {
        let q = Quat::from_rotation(Mat3::from_rotation_vector(Vec3::new(0.3, -0.8, 0.5)));
        let d = Vec3::new(1e-4, 2e-4, -1e-4);
        let a = q.nudged(d).rotation();
        let b = Mat3::from_rotation_vector(d) * q.rotation();
        for k in 0..3 {
            // Cayley's increment is too small by |d|^3 / 12.
            assert!((a.cols[k] - b.cols[k]).norm() < 2e-12);
        }
    }
}

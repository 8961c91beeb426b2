//! 3-1-3 Euler angles, for input and output only: stored orientations have no singularity.

use crate::number::Real;

use super::{Mat3, Vec3};

/// The rotation with 3-1-3 Euler angles `theta` in rad: `C = Rz(t1) Rx(t2) Rz(t3)`.
///
/// Paper Eq. 2.2; its first element is misprinted there, `c1 c3 - s1 c2 s3` is right.
pub fn rotation_from_euler_313<T: Real>(theta: [T; 3]) -> Mat3<T> {
    // Columns of Rz(t1) Rx(t2) Rz(t3)                                                                      (paper 2.2)
    let [(s1, c1), (s2, c2), (s3, c3)] = theta.map(T::sin_cos);
    Mat3 {
        cols: [
            Vec3::new(c1 * c3 - s1 * c2 * s3, s1 * c3 + c1 * c2 * s3, s2 * s3),
            Vec3::new(-(c1 * s3) - s1 * c2 * c3, c1 * c2 * c3 - s1 * s3, s2 * c3),
            Vec3::new(s1 * s2, -(c1 * s2), c2),
        ],
    }
}

/// 3-1-3 Euler angles of a rotation, rad, with t2 in `[0, pi]`.
///
/// Where t2 is 0 or pi only t1 +- t3 is defined; t3 is then 0.
pub fn euler_313_from_rotation(c: Mat3) -> [f64; 3] {
    let [f, g, h] = c.cols;
    // h = (s1 s2, -c1 s2, c2),    (f_z, g_z) = (s2 s3, s2 c3)
    let s2 = h.x.hypot(h.y);
    if s2 < 1e-12 {
        return [f.y.atan2(f.x), s2.atan2(h.z), 0.0];
    }
    [h.x.atan2(-h.y), s2.atan2(h.z), f.z.atan2(g.z)]
}

/// The rotation vector rate `R(theta) U` of the Euler angle rates `u` (paper Eqs. 3.7 to 3.10).
///
/// The second column of the paper's Eq. 3.8 is misprinted; `(c1, s1, 0)` is right. R is singular
/// at t2 = 0 and is therefore only ever multiplied by, never inverted.
pub fn euler_rates(theta: [f64; 3], u: Vec3) -> Vec3 {
    // R U = U_1 (0, 0, 1) + U_2 (c1, s1, 0) + U_3 (s1 s2, -c1 s2, c2)                                      (paper 3.8)
    let (s1, c1) = theta[0].sin_cos();
    let (s2, c2) = theta[1].sin_cos();
    Vec3::new(c1 * u.y + s1 * s2 * u.z, s1 * u.y - c1 * s2 * u.z, u.x + c2 * u.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ANGLES: [[f64; 3]; 5] =
        [[0.3, 0.7, -1.1], [2.9, 1.5, 0.2], [-0.4, 3.0, 2.0], [0.6, 0.0, 0.0], [0.0, 1e-3, 0.0]];

    #[test]
    fn euler_angles_round_trip() {
        for theta in ANGLES {
            let c = rotation_from_euler_313(theta);
            let back = rotation_from_euler_313(euler_313_from_rotation(c));
            for k in 0..3 {
                assert!((c.cols[k] - back.cols[k]).norm() < 1e-12, "{theta:?}");
            }
        }
    }

    #[test]
    fn euler_rates_match_differences_of_the_rotation() {
        let h = 1e-6;
        for theta in ANGLES {
            for k in 0..3 {
                let mut u = [0.0; 3];
                u[k] = 1.0;
                let at = |s: f64| rotation_from_euler_313(std::array::from_fn(|j| theta[j] + s * u[j]));
                let w = euler_rates(theta, u.into());
                let (plus, minus, c) = (at(h), at(-h), at(0.0));
                for j in 0..3 {
                    let d = (plus.cols[j] - minus.cols[j]) * (0.5 / h);
                    assert!((d - w.cross(c.cols[j])).norm() < 1e-9, "{theta:?} {k}");
                }
            }
        }
    }
}

//! Orientations as three angles, for input and output only: stored orientations are free of singularities.

use crate::number::Real;

use super::{Mat3, Vec3};

/// Rotation with 3-1-3 Euler angles `theta`, rad: `C = Rz(t1) Rx(t2) Rz(t3)`.
///
/// Paper Eq. 2.2; its first element is misprinted there and should read `c1 c3 - s1 c2 s3`.
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
/// If t2 is 0 or pi, only t1 +- t3 is defined; t3 is then 0.
pub fn euler_313_from_rotation(c: Mat3) -> [f64; 3] {
    let [f, g, h] = c.cols;
    // h = (s1 s2, -c1 s2, c2),    (f_z, g_z) = (s2 s3, s2 c3)
    let s2 = h.x.hypot(h.y);
    if s2 < 1e-12 {
        return [f.y.atan2(f.x), s2.atan2(h.z), 0.0];
    }
    [h.x.atan2(-h.y), s2.atan2(h.z), f.z.atan2(g.z)]
}

/// Three successive rotations, each about an axis of the frame rotated by the previous ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Angles {
    /// 3-1-3 Euler angles: about z, the new x, the new z.
    Euler,
    /// Cardan angles: about x, the new y, the new z.
    Cardan,
    /// Roll, pitch and yaw, in reverse order of rotation: yaw about z, then pitch about the new y, then roll about the
    /// new x.
    RollPitchYaw,
}

/// Sine of the smallest angle between the first and the last rotation axis for which both angles are defined. Below it
/// only their sum or difference is: a thousandth of a degree would change them by a whole turn.
const SAME_AXIS: f64 = 1e-6;

impl Angles {
    /// Rotation matrix of these angles, rad.
    pub fn rotation<T: Real>(self, angles: [T; 3]) -> Mat3<T> {
        let [x, y, z] = Vec3::AXES;
        let [a, b, c] = angles;
        match self {
            // Rz(t1) Rx(t2) Rz(t3)                                                                          (paper 2.2)
            Self::Euler => rotation_from_euler_313(angles),
            // Rx(a) Ry(b) Rz(c)
            Self::Cardan => Mat3::about(x, a) * Mat3::about(y, b) * Mat3::about(z, c),
            // Rz(yaw) Ry(pitch) Rx(roll)
            Self::RollPitchYaw => Mat3::about(z, c) * Mat3::about(y, b) * Mat3::about(x, a),
        }
    }

    /// The angles of a rotation, rad. The first and the last are in (-pi, pi], the middle one in [0, pi] for Euler
    /// angles and in [-pi/2, pi/2] otherwise. NaN if only the sum or difference of the first and the last is defined.
    pub fn of<T: Real>(self, rotation: Mat3<T>) -> [T; 3] {
        let [f, g, h] = rotation.cols;
        let length = |a: T, b: T| (a * a + b * b).sqrt();
        let (angles, apart) = match self {
            // h = (s1 s2, -c1 s2, c2),    (f_z, g_z) = (s2 s3, s2 c3)
            Self::Euler => {
                let s2 = length(h.x, h.y);
                ([h.x.atan2(-h.y), s2.atan2(h.z), f.z.atan2(g.z)], s2)
            }
            // (f_x, g_x, h_x) = (cb cc, -cb sc, sb),    (h_y, h_z) = (-sa cb, ca cb)
            Self::Cardan => {
                let cb = length(f.x, g.x);
                ([(-h.y).atan2(h.z), h.x.atan2(cb), (-g.x).atan2(f.x)], cb)
            }
            // f = (cy cp, sy cp, -sp),    (g_z, h_z) = (cp sr, cp cr)
            Self::RollPitchYaw => {
                let cp = length(f.x, f.y);
                ([g.z.atan2(h.z), (-f.z).atan2(cp), f.y.atan2(f.x)], cp)
            }
        };
        if apart.exceeds(T::constant(SAME_AXIS)) { angles } else { [T::constant(f64::NAN); 3] }
    }
}

/// Angular velocity `R(theta) U` of the Euler angle rates `u`, rad per unit (paper Eqs. 3.7 to 3.10).
///
/// The second column of the paper's Eq. 3.8 is misprinted and should read `(c1, s1, 0)`. R is singular at t2 = 0, so it
/// is only used as a factor, never inverted.
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
    fn all_angles_round_trip() {
        for all in [Angles::Euler, Angles::Cardan, Angles::RollPitchYaw] {
            for angles in [[0.3, 0.7, -1.1], [2.9, 1.5, 0.2], [-3.0, 0.1, 2.0]] {
                let back = all.of(all.rotation(angles));
                for k in 0..3 {
                    assert!((angles[k] - back[k]).abs() < 1e-12, "{all:?} {angles:?} {back:?}");
                }
            }
            // The angles are undefined where two rotation axes coincide.
            let locked = if all == Angles::Euler { 0.0 } else { std::f64::consts::FRAC_PI_2 };
            assert!(all.of(all.rotation([0.3, locked, -1.1])).iter().all(|x| x.is_nan()), "{all:?}");
        }
    }

    #[test]
    fn each_angle_turns_about_its_axis() {
        // A car that heads 30 deg to the left, then pitches nose-down by 20 deg: its own x axis shows both.
        let (yaw, pitch) = (30f64.to_radians(), 20f64.to_radians());
        let x = Angles::RollPitchYaw.rotation([0.4, pitch, yaw]).cols[0];
        let expected = Vec3::new(pitch.cos() * yaw.cos(), pitch.cos() * yaw.sin(), -pitch.sin());
        assert!((x - expected).norm() < 1e-15);
        // For a universal joint with its input along x and its pins along y and z, these are Cardan angles: the first
        // two determine the direction of z.
        let z = Angles::Cardan.rotation([yaw, pitch, 0.4]).cols[2];
        let expected = Vec3::new(pitch.sin(), -yaw.sin() * pitch.cos(), yaw.cos() * pitch.cos());
        assert!((z - expected).norm() < 1e-15);
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

//! Design velocity fields over a whole body: V(s), and the local rotation rate, at every point s (paper, section 3: one
//! parameter tau, many points).

use crate::linalg::least_squares;
use crate::space::Vec3;

/// Velocity field of a body's points per unit of a design variable.
#[derive(Clone, Debug)]
pub(crate) enum ShapeField {
    /// Translation of all points: m per m.
    Translate(Vec3),
    /// Rotation about a line through a point: per rad.
    Rotate { axis: Vec3, through: Vec3 },
    /// Scaling away from a point, or from the plane through it perpendicular to a direction: per unit; 1 doubles the
    /// size.
    Scale { from: Vec3, along: Option<Vec3> },
    /// Deflection of a cantilever beam, clamped at the first point and loaded sideways at the second: m per m at the
    /// second.
    Bend { from: Vec3, to: Vec3, towards: Vec3 },
    /// Interpolation of given velocities of points.
    Through(Interpolation),
}

impl ShapeField {
    /// Returns the velocity of the point at s, m per unit, and the local rotation rate, rad per unit: half the curl of
    /// the velocity.
    pub fn at(&self, s: Vec3) -> [Vec3; 2] {
        match self {
            // V(s), and w(s) = rot V / 2; for a beam this holds on its axis
            Self::Translate(v) => [*v, Vec3::ZERO],
            // V = h x (s - c),  w = h
            Self::Rotate { axis, through } => [axis.cross(s - *through), *axis],
            // V = s - c, or u u . (s - c); both are gradients, so w = 0
            Self::Scale { from, along: None } => [s - *from, Vec3::ZERO],
            Self::Scale { from, along: Some(u) } => [*u * u.dot(s - *from), Vec3::ZERO],
            Self::Bend { from, to, towards } => {
                let length = (*to - *from).norm();
                let e = (*to - *from) * (1.0 / length);
                let along = e.dot(s - *from);
                // With x = e . (s - from) / L:  V = n y(x) + w x (s - from - e x L),  w = e x n y'(x) / L
                let (deflection, slope) = cantilever(along / length);
                // Sections remain plane and perpendicular to the bent axis.
                let turn = e.cross(*towards) * (slope / length);
                [*towards * deflection + turn.cross(s - *from - e * along), turn]
            }
            Self::Through(interpolation) => interpolation.at(s),
        }
    }
}

/// Returns the deflection and slope at x of a beam of unit length that is clamped at 0 and deflected by 1 at 1. It is
/// straight beyond its ends.
fn cantilever(x: f64) -> (f64, f64) {
    match x {
        x if x <= 0.0 => (0.0, 0.0),
        // y = x^2 (3 - x) / 2, y' = 3 x (2 - x) / 2: y''(1) = 0, y''' constant: a force at the free end, no moment
        // there
        x if x < 1.0 => (0.5 * x * x * (3.0 - x), 1.5 * x * (2.0 - x)),
        x => (1.0 + 1.5 * (x - 1.0), 1.5),
    }
}

/// Interpolation by radial basis functions `r^3` at given points plus a linear function: the smoothest field through
/// their velocities. Rigid motions and uniform stretching are reproduced exactly.
#[derive(Clone, Debug)]
pub(crate) struct Interpolation {
    centre: Vec3,
    scale: f64,
    points: Vec<Vec3>,
    /// Coefficient of each point, in the scaled unit of length.
    weights: Vec<Vec3>,
    /// Linear function: value at the centre, then derivatives by x, y and z.
    linear: [Vec3; 4],
}

/// Tolerance of given velocities, relative to the largest.
const INTERPOLATION_TOLERANCE: f64 = 1e-9;

impl Interpolation {
    /// Returns the interpolation of velocities at points; `None` if points that coincide have different velocities.
    pub fn new(points: &[Vec3], velocities: &[Vec3]) -> Option<Self> {
        let n = points.len();
        let centre = points.iter().fold(Vec3::ZERO, |sum, p| sum + *p) * (1.0 / n as f64);
        let radius = points.iter().map(|p| (*p - centre).norm()).fold(0.0, f64::max);
        let scale = if radius > 0.0 { radius } else { 1.0 };
        let scaled: Vec<Vec3> = points.iter().map(|p| (*p - centre) * (1.0 / scale)).collect();
        let linear = |p: Vec3, k: usize| [1.0, p.x, p.y, p.z][k];
        let entry = |i: usize, j: usize| match (i < n, j < n) {
            // (K   P) (w)   (v)       K_ij = abs(s_i - s_j)^3,  P_i = (1, x_i, y_i, z_i)
            // (P^T 0) (c) = (0)       P^T w = 0: the r^3 part has no linear component
            (true, true) => (scaled[i] - scaled[j]).norm().powi(3),
            (true, false) => linear(scaled[i], j - n),
            (false, true) => linear(scaled[j], i - n),
            (false, false) => 0.0,
        };
        let along = |axis: usize| velocities.iter().map(|v| v[axis]).chain([0.0; 4]).collect();
        // Few points, or points in a plane, do not determine the linear function: the minimum-norm solution is used.
        let found = least_squares([n + 4; 2], entry, &[along(0), along(1), along(2)]);
        let row = |i: usize| Vec3::new(found[0][i], found[1][i], found[2][i]);
        let this = Self {
            centre,
            scale,
            points: scaled,
            weights: (0..n).map(row).collect(),
            linear: std::array::from_fn(|k| row(n + k)),
        };
        let largest = velocities.iter().map(|v| v.norm()).fold(0.0, f64::max);
        let interpolates =
            |(p, v): (&Vec3, &Vec3)| (this.at(*p)[0] - *v).norm() <= INTERPOLATION_TOLERANCE * largest;
        points.iter().zip(velocities).all(interpolates).then_some(this)
    }

    fn at(&self, s: Vec3) -> [Vec3; 2] {
        let s = (s - self.centre) * (1.0 / self.scale);
        let [value, dx, dy, dz] = self.linear;
        // V(s) = c_0 + c_x x + c_y y + c_z z + sum_i w_i abs(s - s_i)^3
        let mut v = value + dx * s.x + dy * s.y + dz * s.z;
        // w(s) = rot V / 2,    grad abs(s - s_i)^3 = 3 abs(s - s_i) (s - s_i)
        // curl(f w) = grad f x w
        let [x, y, z] = Vec3::AXES;
        let mut curl = x.cross(dx) + y.cross(dy) + z.cross(dz);
        for (p, w) in self.points.iter().zip(&self.weights) {
            let offset = s - *p;
            let r = offset.norm();
            v += *w * (r * r * r);
            curl += (offset * (3.0 * r)).cross(*w);
        }
        // s is in units of `scale`; the angle is per true length.
        [v, curl * (0.5 / self.scale)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> Vec<ShapeField> {
        let [x, y, z] = Vec3::AXES;
        let points = [Vec3::ZERO, x, y * 0.7, z * 1.2, Vec3::new(0.4, 0.6, 0.3)];
        let velocities = [Vec3::ZERO, z, y * 0.2, x * -0.4, Vec3::new(0.1, -0.2, 0.5)];
        vec![
            ShapeField::Translate(Vec3::new(0.2, 1.0, -0.3)),
            ShapeField::Rotate { axis: Vec3::new(0.6, 0.0, 0.8), through: Vec3::new(0.1, 0.2, 0.3) },
            ShapeField::Scale { from: Vec3::new(0.5, 0.1, 0.0), along: None },
            ShapeField::Scale { from: Vec3::ZERO, along: Some(Vec3::new(0.0, 0.6, 0.8)) },
            ShapeField::Bend { from: Vec3::ZERO, to: x * 2.0, towards: z },
            ShapeField::Through(Interpolation::new(&points, &velocities).unwrap()),
        ]
    }

    #[test]
    fn rotation_rate_is_half_the_curl() {
        let h = 1e-5;
        for field in all() {
            for s in [Vec3::new(0.31, 0.24, -0.4), Vec3::new(1.3, -0.2, 0.5), Vec3::new(-0.5, 0.3, 0.2)] {
                let d = |k: usize| {
                    let step = Vec3::AXES[k] * h;
                    (field.at(s + step)[0] - field.at(s - step)[0]) * (0.5 / h)
                };
                let [dx, dy, dz] = [d(0), d(1), d(2)];
                let half = Vec3::new(dy.z - dz.y, dz.x - dx.z, dx.y - dy.x) * 0.5;
                let found = field.at(s)[1];
                // Off the axis, sections of a bent beam also shear as the curvature changes.
                let off = if matches!(field, ShapeField::Bend { .. }) { 1.0 } else { 1e-8 };
                assert!((half - found).norm() < off, "{field:?} at {s:?}: {found:?} {half:?}");
            }
        }
        let bend = &all()[4];
        let [v, turn] = bend.at(Vec3::new(2.0, 0.0, 0.0));
        assert!((v - Vec3::AXES[2]).norm() < 1e-15 && (turn - Vec3::new(0.0, -0.75, 0.0)).norm() < 1e-15);
        assert_eq!(bend.at(Vec3::new(-1.0, 0.3, 0.0)), [Vec3::ZERO; 2]);
    }

    #[test]
    fn interpolation_passes_through_its_points_and_reproduces_rigid_motion() {
        let [x, y, z] = Vec3::AXES;
        let turn = Vec3::new(0.3, -0.5, 0.2);
        let rigid = |p: Vec3| Vec3::new(1.0, 2.0, 3.0) + turn.cross(p);
        let points = [Vec3::ZERO, x, y, z, x + y * 2.0];
        let field = Interpolation::new(&points, &points.map(rigid)).unwrap();
        for p in [Vec3::new(4.0, -2.0, 1.0), Vec3::new(0.3, 0.3, 0.3)] {
            let [v, w] = field.at(p);
            assert!((v - rigid(p)).norm() < 1e-12 && (w - turn).norm() < 1e-12, "{v:?} {w:?}");
        }
        // Two points, or three on a line, do not determine the field, but it still interpolates them.
        let field = Interpolation::new(&[Vec3::ZERO, x, x * 2.0], &[Vec3::ZERO, z, Vec3::ZERO]).unwrap();
        assert!((field.at(x)[0] - z).norm() < 1e-9 && field.at(x * 2.0)[0].norm() < 1e-9);
        assert!(Interpolation::new(&[x, x], &[z, y]).is_none());
    }
}

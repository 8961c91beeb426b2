//! Volume, centre and moments of closed surfaces, and moments about other points.

use crate::number::Real;
use crate::space::{Vec3, distinct, open_edges};

/// Mass properties of a homogeneous body, per unit of density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Volume, m^3.
    pub volume: f64,
    /// Centre, m.
    pub centre: Vec3,
    /// The integrals of x x, y y, z z, x y, y z and z x about its centre, m^5.
    pub second: [f64; 6],
    /// True if centre and axes are those of the body's frame, rather than global in the design configuration.
    pub in_body: bool,
}

/// Reason why a surface does not enclose a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OpenSurface {
    /// Number of edges with triangles on one side only or with opposite orientations, and the ends of one of them.
    Edges(usize, [Vec3; 2]),
    /// It encloses nothing.
    Flat,
}

/// A volume below this part of the cube of its extent is round-off: the thinnest sheet that anybody draws has more.
const NOTHING: f64 = 1e-12;

impl Solid {
    /// Checks that a surface is closed: at every edge the number of triangles in both directions is the same. Outward
    /// or inward orientation does not matter; a shell within another one with the opposite orientation is a cavity.
    ///
    /// # Errors
    /// Reason why it encloses no volume.
    pub fn of(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, OpenSurface> {
        let open = open_edges(triangles);
        if let Some(first) = open.first() {
            let ends = first.map(|k| vertices[k as usize]);
            return Err(OpenSurface::Edges(open.len(), ends));
        }
        let triangles = distinct(triangles.to_vec());
        let Some(origin) = triangles.first().map(|t| vertices[t[0] as usize]) else {
            return Err(OpenSurface::Flat);
        };
        let (mut volume, mut first, mut second) = (0.0, Vec3::ZERO, [0.0; 6]);
        let mut extent = 0.0_f64;
        for corners in &triangles {
            // Relative to a corner of the surface, to keep the digits of small solids.
            let [a, b, c] = corners.map(|k| vertices[k as usize] - origin);
            // A tetrahedron with the origin: V = a . (b x c) / 6,  sum V (a + b + c) / 4,
            // integral of x y = V/20 (sum x_i y_i + (sum x_i) (sum y_i))
            let v = a.dot(b.cross(c)) / 6.0;
            let sum = a + b + c;
            volume += v;
            first += sum * (v / 4.0);
            for (entry, (i, k)) in second.iter_mut().zip(PAIRS) {
                *entry += v / 20.0 * (a[i] * a[k] + b[i] * b[k] + c[i] * c[k] + sum[i] * sum[k]);
            }
            extent = [a, b, c].iter().fold(extent, |most, p| most.max(p.norm()));
        }
        if !(volume.abs() > NOTHING * extent.powi(3)) {
            return Err(OpenSurface::Flat);
        }
        let way = first * (1.0 / volume);
        for (entry, (i, k)) in second.iter_mut().zip(PAIRS) {
            // About the centre, and of a positive volume
            *entry = (*entry - volume * way[i] * way[k]) * volume.signum();
        }
        Ok(Self { volume: volume.abs(), centre: origin + way, second, in_body: false })
    }

    /// The same in another unit of length.
    #[must_use]
    pub fn scaled(self, by: f64) -> Self {
        Self {
            volume: self.volume * by.powi(3),
            centre: self.centre * by,
            second: self.second.map(|x| x * by.powi(5)),
            ..self
        }
    }

    /// The same seen in a mirror perpendicular to this axis, 0 to 2.
    #[must_use]
    pub fn mirrored(self, axis: usize) -> Self {
        let mut second = self.second;
        for (entry, (i, k)) in second.iter_mut().zip(PAIRS) {
            if (i == axis) != (k == axis) {
                *entry = -*entry;
            }
        }
        Self { centre: self.centre.mirrored(Vec3::AXES[axis]), second, ..self }
    }

    /// Moments of inertia per density about its centre, as columns of their matrix.
    pub(crate) fn inertia(&self) -> [Vec3; 3] {
        let [xx, yy, zz, xy, yz, zx] = self.second;
        [Vec3::new(yy + zz, -xy, -zx), Vec3::new(-xy, zz + xx, -yz), Vec3::new(-zx, -yz, xx + yy)]
    }
}

/// Moments and products of inertia about the centre, from those about a point, with the displacement d from the point
/// to the centre: `I - m (d^2 1 - d d^T)`. If a moment is left out, as in a planar model, all entries that are left out
/// are zero about the centre; otherwise products that are left out are zero about the point.
pub(crate) fn about_centre<T: Real>(
    mass: T,
    way: Vec3<T>,
    [moments, products]: [[Option<T>; 3]; 2],
) -> [[T; 3]; 2] {
    let all = moments.iter().all(Option::is_some);
    let less = |given: Option<T>, by: T| match given {
        Some(given) => given - mass * by,
        None if all => -(mass * by),
        None => T::zero(),
    };
    let Vec3 { x, y, z } = way;
    let ([a, b, c], [d, e, f]) = (moments, products);
    [
        [less(a, y * y + z * z), less(b, z * z + x * x), less(c, x * x + y * y)],
        [less(d, x * y), less(e, y * z), less(f, z * x)],
    ]
}

/// The axes of the second moments.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of a few triangles are exact to this part.
    const EXACT: f64 = 1e-13;

    fn close(a: f64, b: f64, scale: f64) {
        assert!((a - b).abs() <= EXACT * scale, "{a} {b}");
    }

    #[test]
    fn a_tetrahedron_has_a_sixth_of_its_box() {
        // At a corner of axes: V = abc/6, centre (a, b, c)/4, integral of x x about the corner a^3 b c / 60, of x y a^2
        // b^2 c / 120
        let (a, b, c) = (0.3, 0.5, 0.7);
        let at = Vec3::new(10.0, -20.0, 5.0);
        let corners = [Vec3::ZERO, Vec3::new(a, 0.0, 0.0), Vec3::new(0.0, b, 0.0), Vec3::new(0.0, 0.0, c)];
        let vertices = corners.map(|p| p + at);
        let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let solid = Solid::of(&vertices, &triangles).unwrap();
        let v = a * b * c / 6.0;
        // Far from the origin the corners have lost some digits.
        let lost = 1e3;
        close(solid.volume, v, lost * v);
        let centre = Vec3::new(a, b, c) * 0.25;
        close((solid.centre - at - centre).norm(), 0.0, lost);
        close(solid.second[0], a * a * a * b * c / 60.0 - v * centre.x * centre.x, lost * v);
        close(solid.second[3], a * a * b * b * c / 120.0 - v * centre.x * centre.y, lost * v);
        // Inside out it is the same, and mirrored its image.
        let inward = triangles.map(|[a, b, c]| [a, c, b]);
        let again = Solid::of(&vertices, &inward).unwrap();
        assert!(again.volume == solid.volume && again.second == solid.second);
        let image = Solid::of(&vertices.map(|p| p.mirrored(Vec3::AXES[1])), &triangles).unwrap();
        let mirrored = solid.mirrored(1);
        close((image.centre - mirrored.centre).norm(), 0.0, lost);
        (0..6).for_each(|k| close(image.second[k], mirrored.second[k], lost * v));
    }

    #[test]
    fn surfaces_that_are_not_closed_are_rejected() {
        let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3::from);
        let open = Solid::of(&vertices, &[[0, 2, 1], [0, 1, 3], [0, 3, 2]]);
        assert!(matches!(open, Err(OpenSurface::Edges(3, _))), "{open:?}");
        // One triangle goes round the other way.
        let twisted = Solid::of(&vertices, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 3, 2]]);
        assert!(matches!(twisted, Err(OpenSurface::Edges(3, _))), "{twisted:?}");
        assert_eq!(Solid::of(&vertices, &[[0, 1, 2], [0, 2, 1]]), Err(OpenSurface::Flat));
    }
}

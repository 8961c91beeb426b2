//! A hull of eight corners that is a box: the distance of a point has a closed form.

use crate::number;
use crate::space::Vec3;

use super::feature::Feature;
use super::nearest::{Nearest, found};

/// Difference of a corner from that of a box, as a fraction of the size of the coordinates: round-off.
const SAME: f64 = 1e-12;

/// A box. The corner with bit k of its number set is on the positive side of axis k.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    centre: Vec3,
    axes: [Vec3; 3],
    half: [f64; 3],
    is_right_handed: bool,
}

impl Block {
    /// The box with these corners, if they are one.
    pub fn of(points: &[Vec3]) -> Option<Self> {
        let corners: &[Vec3; 8] = points.try_into().ok()?;
        let first = corners[0];
        let edges = [1, 2, 4].map(|k: usize| corners[k] - first);
        let lengths = edges.map(|e| e.norm());
        let within = SAME * (first.norm() + lengths.iter().sum::<f64>());
        let at = |k: usize| (0..3).filter(|n| k >> n & 1 == 1).fold(first, |sum, n| sum + edges[n]);
        let is_square =
            |[m, n]: [usize; 2]| edges[m].dot(edges[n]).abs() <= within * lengths[m].min(lengths[n]);
        let is_box = lengths.iter().all(|length| *length > within)
            && [[0, 1], [1, 2], [2, 0]].into_iter().all(is_square)
            && (3..8).all(|k| (corners[k] - at(k)).norm() <= within);
        is_box.then(|| Self {
            centre: (first + corners[7]) * 0.5,
            axes: number::each(&[0, 1, 2], |k| edges[k] * (1.0 / lengths[k])),
            half: lengths.map(|length| 0.5 * length),
            is_right_handed: edges[0].cross(edges[1]).dot(edges[2]) > 0.0,
        })
    }

    /// Coordinates of a point from the centre, and how far each is beyond the faces; negative between them.
    fn beyond(&self, p: Vec3) -> ([f64; 3], [f64; 3]) {
        let v = p - self.centre;
        let at = self.axes.map(|axis| axis.dot(v));
        (at, [0, 1, 2].map(|k| at[k].abs() - self.half[k]))
    }

    /// Distance of a point, negative inside.
    pub fn distance(&self, p: Vec3) -> f64 {
        let (_, beyond) = self.beyond(p);
        let most = beyond[0].max(beyond[1]).max(beyond[2]);
        if most <= 0.0 {
            return most;
        }
        beyond.iter().map(|x| x.max(0.0)).map(|x| x * x).sum::<f64>().sqrt()
    }

    /// The nearest point to a point.
    pub fn nearest_to(&self, p: Vec3) -> Nearest {
        let (at, beyond) = self.beyond(p);
        let deepest = (1..3).fold(0, |best, k| if beyond[k] > beyond[best] { k } else { best });
        let is_outside = |k: &usize| beyond[*k] > 0.0 || *k == deepest;
        let mut q = p;
        for k in (0..3).filter(is_outside) {
            q -= self.axes[k] * if at[k] > 0.0 { beyond[k] } else { -beyond[k] };
        }
        let corner = (0..3).fold(0, |bits, k| bits | u32::from(at[k] > 0.0) << k);
        let feature = match (0..3).filter(is_outside).count() {
            1 => {
                // Of the two triangles of the face at this corner, the one that the nearest point is in.
                let [u, v] = [1, 2].map(|n| corner ^ 1 << ((deepest + n) % 3));
                let is_in_order = (corner.count_ones() % 2 == 1) == self.is_right_handed;
                Feature::Facet(if is_in_order { [corner, u, v] } else { [corner, v, u] })
            }
            2 => {
                let along = (0..3).find(|k| !is_outside(k)).unwrap_or(deepest);
                Feature::Edge([corner, corner ^ 1 << along])
            }
            _ => Feature::Vertex(corner),
        };
        found([Feature::Point(0.0), feature], [p, q], self.distance(p))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::surface::View;
    use super::*;
    use crate::space::{Mat3, hull};

    /// Round-off of distances of about 1.
    const EXACT: f64 = 1e-13;

    /// Corners of a box; of a mirrored one if it is turned inside out, and oblique by this part.
    fn corners([x, y, z, angle, u, v, w, _]: [f64; 8], is_mirrored: bool, oblique: f64) -> Vec<Vec3> {
        let axis = Vec3::new(x, y, z + 2.0).unit().unwrap();
        let rot: Mat3<f64> = Mat3::about(axis, 3.0 * angle);
        let half = [u, v, w].map(|x| 0.6 + 0.5 * x);
        let side =
            |k: u32, bit: u32| if k >> bit & 1 == 1 { half[bit as usize] } else { -half[bit as usize] };
        let mirrored = if is_mirrored { -1.0 } else { 1.0 };
        let corner = |k: u32| {
            let [a, b, c] = [0, 1, 2].map(|bit| side(k, bit));
            rot * Vec3::new(a + oblique * b, b, mirrored * c) + Vec3::new(y, z, x)
        };
        (0..8).map(corner).collect()
    }

    fn numbers() -> impl Strategy<Value = [f64; 8]> {
        prop::array::uniform8(-1.0..1.0)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn a_box_is_as_far_as_the_hull_of_its_corners(
            at in numbers(), p in prop::array::uniform3(-3.0..3.0), is_mirrored in any::<bool>(),
        ) {
            let points = corners(at, is_mirrored, 0.0);
            let facets = hull(&points).unwrap();
            let p = Vec3::from(p);
            let block = Block::of(&points).unwrap();
            let expected = View::Hull { points: &points, facets: &facets, block: None }.nearest_to(p);
            let near = View::hull(&points, &facets).nearest_to(p);
            prop_assert!((near.distance - expected.distance).abs() < EXACT, "{near:?} {expected:?}");
            prop_assert!((block.distance(p) - near.distance).abs() < EXACT);
            let apart = (near.points[1] - p).norm();
            prop_assert!((apart - near.distance.abs()).abs() < EXACT, "{near:?}");
            if near.distance > 0.0 {
                prop_assert!((near.points[1] - expected.points[1]).norm() < EXACT, "{near:?} {expected:?}");
            }
            let q = near.points[1];
            match near.features[1] {
                Feature::Facet(ids) => {
                    let [a, b, c] = ids.map(|k| points[k as usize]);
                    let normal = (b - a).cross(c - a).unit().unwrap();
                    prop_assert!((normal.dot(p - a) - near.distance).abs() < EXACT, "{near:?}");
                    let is_inside = |u: Vec3, v: Vec3| normal.dot((v - u).cross(q - u)) > -EXACT;
                    prop_assert!(is_inside(a, b) && is_inside(b, c) && is_inside(c, a), "{near:?}");
                }
                Feature::Edge(ids) => {
                    let [a, b] = ids.map(|k| points[k as usize]);
                    prop_assert!(((b - a).norm() - (q - a).norm() - (b - q).norm()).abs() < EXACT, "{near:?}");
                }
                Feature::Vertex(k) => prop_assert!((points[k as usize] - q).norm() < EXACT, "{near:?}"),
                other => prop_assert!(false, "{other:?}"),
            }
        }

        #[test]
        fn oblique_corners_are_no_box(at in numbers(), is_mirrored in any::<bool>()) {
            prop_assert!(Block::of(&corners(at, is_mirrored, 1e-9)).is_none());
            prop_assert!(Block::of(&corners(at, is_mirrored, 0.3)[..7]).is_none());
        }
    }

    #[test]
    fn over_the_middle_of_a_face_the_face_is_nearest_and_no_diagonal() {
        let points = corners([0.0; 8], false, 0.0);
        let facets = hull(&points).unwrap();
        let near = View::hull(&points, &facets).nearest_to(Vec3::new(0.0, 0.0, 1.0));
        assert!(matches!(near.features[1], Feature::Facet(_)), "{near:?}");
        assert!((near.distance - 0.4).abs() < EXACT, "{near:?}");
    }
}

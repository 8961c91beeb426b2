//! Surfaces of triangles, with a tree of balls for distances.

use std::collections::{BTreeMap, BTreeSet};

use super::Vec3;
use crate::number;

/// Triangles per leaf of the tree.
const LEAF: usize = 2;

/// A surface of triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    vertices: Vec<Vec3>,
    /// In the order of the leaves.
    triangles: Vec<[u32; 3]>,
    nodes: Vec<Node>,
    is_closed: bool,
    /// Sums of the normals of the triangles at each vertex, weighted by their angles, and at each edge; empty for an
    /// open surface.
    vertex_normals: Vec<Vec3>,
    edge_normals: BTreeMap<[u32; 2], Vec3>,
}

/// A ball around some triangles.
#[derive(Clone, Debug, PartialEq)]
struct Node {
    centre: Vec3,
    radius: f64,
    /// Triangles below it.
    triangles: [usize; 2],
    /// Both halves; `None` for a leaf.
    halves: Option<[usize; 2]>,
}

/// Part of a triangle: a corner, an edge between two of them, or the inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrianglePart {
    /// The vertex of this number.
    Vertex(u32),
    /// The edge between two vertices.
    Edge([u32; 2]),
    /// The face of three vertices.
    Face([u32; 3]),
}

impl Surface {
    /// Surface of triangles between vertices. It is closed if the triangles at every edge are the same number in both
    /// directions; then its triangles are turned outward. Repeated triangles count once.
    pub fn new(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        let mut triangles = distinct(triangles);
        let is_closed = !triangles.is_empty() && open_edges(&triangles).is_empty();
        if is_closed && volume(&vertices, &triangles) < 0.0 {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        let mut nodes = Vec::new();
        let count = triangles.len();
        if count > 0 {
            grow(&vertices, &mut triangles, 0, &mut nodes);
        }
        let mut surface = Self {
            vertices,
            triangles,
            nodes,
            is_closed,
            vertex_normals: Vec::new(),
            edge_normals: BTreeMap::new(),
        };
        if is_closed {
            surface.add_normals();
        }
        surface
    }

    /// Corners of the triangles.
    pub fn vertices(&self) -> &[Vec3] {
        &self.vertices
    }

    /// The triangles, by the numbers of their vertices.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// True if it encloses a volume.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// A ball around it.
    pub fn ball(&self) -> (Vec3, f64) {
        self.nodes.first().map_or((Vec3::ZERO, 0.0), |node| (node.centre, node.radius))
    }

    /// Corners of a triangle.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        number::each(&self.triangles[triangle], |k| self.vertices[k as usize])
    }

    /// Visits the triangles that may be nearer to something than `least`, or than the nearest one so far. `apart` is
    /// the distance of that thing from a point; `each` is given a triangle, and returns its distance.
    pub fn search(&self, mut least: f64, apart: &dyn Fn(Vec3) -> f64, each: &mut dyn FnMut(usize) -> f64) {
        let bound = |k: usize| apart(self.nodes[k].centre) - self.nodes[k].radius;
        let mut open: Vec<(f64, usize)> = Vec::with_capacity(64);
        open.extend((!self.nodes.is_empty()).then(|| (bound(0), 0)));
        while let Some((at_least, k)) = open.pop() {
            if at_least > least {
                continue;
            }
            let node = &self.nodes[k];
            match node.halves {
                None => (node.triangles[0]..node.triangles[1]).for_each(|t| least = least.min(each(t))),
                Some(halves) => {
                    let mut bounds = number::both(halves, |half| (bound(half), half));
                    if bounds[0].0 < bounds[1].0 {
                        bounds.swap(0, 1);
                    }
                    for half in bounds {
                        if half.0 <= least {
                            open.push(half);
                        }
                    }
                }
            }
        }
    }

    /// Visits the pairs of triangles of this and another surface that may be nearer than the nearest ones so far;
    /// `place` moves points of the other one here.
    pub fn search_pairs(
        &self,
        other: &Self,
        place: &dyn Fn(Vec3) -> Vec3,
        each: &mut dyn FnMut(usize, usize) -> f64,
    ) {
        if self.nodes.is_empty() || other.nodes.is_empty() {
            return;
        }
        let bound = |a: usize, b: usize, centre: Vec3| {
            (centre - self.nodes[a].centre).norm() - self.nodes[a].radius - other.nodes[b].radius
        };
        let mut least = f64::INFINITY;
        // Pairs of balls with a bound of their distance, and the centre of the second one, placed here.
        let centre = place(other.nodes[0].centre);
        let mut open = vec![(bound(0, 0, centre), 0, 0, centre)];
        while let Some((at_least, a, b, centre)) = open.pop() {
            if at_least > least {
                continue;
            }
            let (p, q) = (&self.nodes[a], &other.nodes[b]);
            // The larger one is divided.
            let divided = match (p.halves, q.halves) {
                (Some(halves), _) if q.halves.is_none() || p.radius >= q.radius => {
                    number::both(halves, |half| (half, b, centre))
                }
                (_, Some(halves)) => number::both(halves, |half| (a, half, place(other.nodes[half].centre))),
                (Some(halves), None) => number::both(halves, |half| (half, b, centre)),
                (None, None) => {
                    for s in p.triangles[0]..p.triangles[1] {
                        for t in q.triangles[0]..q.triangles[1] {
                            least = least.min(each(s, t));
                        }
                    }
                    continue;
                }
            };
            let mut bounds = number::both(divided, |(a, b, centre)| (bound(a, b, centre), a, b, centre));
            if bounds[0].0 < bounds[1].0 {
                bounds.swap(0, 1);
            }
            for pair in bounds {
                if pair.0 <= least {
                    open.push(pair);
                }
            }
        }
    }

    /// True if a point that is nearest to this part of a closed surface is inside.
    pub fn is_inside(&self, p: Vec3, part: TrianglePart, nearest: Vec3) -> bool {
        let normal = match part {
            TrianglePart::Vertex(k) => self.vertex_normals.get(k as usize).copied(),
            TrianglePart::Edge([a, b]) => self.edge_normals.get(&[a.min(b), a.max(b)]).copied(),
            TrianglePart::Face([a, b, c]) => {
                let [a, b, c] = number::each(&[a, b, c], |k| self.vertices[k as usize]);
                Some((b - a).cross(c - a))
            }
        };
        self.is_closed && normal.is_some_and(|n| n.dot(p - nearest) < 0.0)
    }

    /// A place at which two closed surfaces go through each other, or at which one is within the other.
    fn meets(&self, other: &Self) -> Option<Vec3> {
        let ([(p, r), (q, s)], mut found) = ([self.ball(), other.ball()], None);
        if (q - p).norm() > r + s {
            return None;
        }
        self.search_pairs(other, &|p| p, &mut |s, t| {
            let pair = [self.corners(s), other.corners(t)];
            for (edges, triangle) in [(pair[0], pair[1]), (pair[1], pair[0])] {
                let through = (0..3).find(|k| is_pierced([edges[*k], edges[(k + 1) % 3]], triangle));
                found = found.or(through.map(|k| edges[k]));
            }
            // Pairs whose balls are apart are left out.
            0.0
        });
        let within =
            |part: &Self, whole: &Self| part.vertices.first().copied().filter(|p| whole.contains(*p));
        found.or_else(|| within(self, other)).or_else(|| within(other, self))
    }

    /// Distance of a point from the nearest triangle, the nearest point, and the part of the triangle that it lies on;
    /// `None` without triangles.
    pub(crate) fn nearest_to(&self, p: Vec3) -> Option<(f64, Vec3, TrianglePart)> {
        let mut best = NearestTriangle::to(p);
        let each = &mut |t: usize| best.visit(self.corners(t), self.triangles[t]);
        self.search(f64::INFINITY, &|q| (q - p).norm(), each);
        best.found
    }

    /// True if a point is inside.
    fn contains(&self, p: Vec3) -> bool {
        self.nearest_to(p).is_some_and(|(_, q, part)| self.is_inside(p, part, q))
    }

    fn add_normals(&mut self) {
        self.vertex_normals = vec![Vec3::ZERO; self.vertices.len()];
        for corners in &self.triangles {
            let [a, b, c] = number::each(corners, |k| self.vertices[k as usize]);
            let Some(normal) = normal_of([a, b, c]) else { continue };
            for k in 0..3 {
                let (here, next, other) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
                let [at, p, q] = number::each(&[here, next, other], |k| self.vertices[k as usize]);
                let (u, v) = (p - at, q - at);
                let angle = u.cross(v).norm().atan2(u.dot(v));
                self.vertex_normals[here as usize] += normal * angle;
                *self.edge_normals.entry([here.min(next), here.max(next)]).or_insert(Vec3::ZERO) += normal;
            }
        }
    }
}

/// A place at which closed parts of a surface overlap or touch; `None` if the inside of each is apart from those of the
/// others, or is a hollow of one. Faces of a part within another one are no surface of both together.
pub fn overlap_of_parts(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Option<Vec3> {
    let sense = volume(vertices, triangles);
    // A hollow has the opposite sense.
    let solids =
        parts(&distinct(triangles.to_vec())).into_iter().filter(|part| volume(vertices, part) * sense > 0.0);
    let solids: Vec<Surface> = solids.map(|part| surface_of_part(vertices, &part)).collect();
    let pairs = (0..solids.len()).flat_map(|k| (0..k).map(move |n| [n, k]));
    pairs.map(|pair| pair.map(|k| &solids[k])).find_map(|[a, b]| a.meets(b))
}

/// Triangles that are connected by their edges.
fn parts(triangles: &[[u32; 3]]) -> Vec<Vec<[u32; 3]>> {
    let mut beside: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    let edges = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]);
    for (k, triangle) in triangles.iter().enumerate() {
        edges(*triangle).into_iter().for_each(|edge| beside.entry(edge).or_default().push(k));
    }
    let mut seen = vec![false; triangles.len()];
    let mut found = Vec::new();
    for first in 0..triangles.len() {
        let (mut part, mut open) = (Vec::new(), vec![first]);
        while let Some(k) = open.pop() {
            if !std::mem::replace(&mut seen[k], true) {
                part.push(triangles[k]);
                open.extend(edges(triangles[k]).iter().flat_map(|edge| &beside[edge]).filter(|k| !seen[**k]));
            }
        }
        found.extend((!part.is_empty()).then_some(part));
    }
    found
}

/// A part of a surface with its own vertices.
fn surface_of_part(vertices: &[Vec3], part: &[[u32; 3]]) -> Surface {
    let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
    let mut own = Vec::new();
    let mut number = |k: u32| {
        *numbers.entry(k).or_insert_with(|| {
            own.push(vertices[k as usize]);
            own.len() as u32 - 1
        })
    };
    let triangles = part.iter().map(|t| t.map(&mut number)).collect();
    Surface::new(own, triangles)
}

/// True if a segment goes through a triangle.
pub(crate) fn is_pierced([p, q]: [Vec3; 2], [a, b, c]: [Vec3; 3]) -> bool {
    let normal = (b - a).cross(c - a);
    let (from, to) = (normal.dot(p - a), normal.dot(q - a));
    if from * to > 0.0 || from == to {
        return false;
    }
    let x = p + (q - p) * (from / (from - to));
    let inside = |u: Vec3, v: Vec3| normal.dot((v - u).cross(x - u)) >= 0.0;
    inside(a, b) && inside(b, c) && inside(c, a)
}

/// Triangles without repetitions: programs export some twice.
pub(crate) fn distinct(mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    let mut known = BTreeSet::new();
    triangles.retain(|[a, b, c]| {
        let turns = [[*a, *b, *c], [*b, *c, *a], [*c, *a, *b]];
        known.insert(turns.into_iter().fold(turns[0], Ord::min))
    });
    triangles
}

/// Edges at which the triangles are not the same number in both directions, of which the surface of a solid has none.
/// Repeated triangles count once.
pub fn open_edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let mut edges: BTreeMap<[u32; 2], i32> = BTreeMap::new();
    for [a, b, c] in distinct(triangles.to_vec()) {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *edges.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
        }
    }
    edges.into_iter().filter(|(_, way)| *way != 0).map(|(edge, _)| edge).collect()
}

fn volume(vertices: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
    let corner = |k: u32| vertices[k as usize] - vertices[triangles[0][0] as usize];
    triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2])))).sum()
}

/// Adds the node of triangles that begin with number `first`, and those below it; returns its index.
fn grow(vertices: &[Vec3], triangles: &mut [[u32; 3]], first: usize, nodes: &mut Vec<Node>) -> usize {
    let corners = || triangles.iter().flatten().map(|k| vertices[*k as usize]);
    let (mut low, mut high) =
        (Vec3::ZERO + Vec3::new(1.0, 1.0, 1.0) * f64::INFINITY, Vec3::new(1.0, 1.0, 1.0) * f64::NEG_INFINITY);
    for p in corners() {
        low = Vec3::new(low.x.min(p.x), low.y.min(p.y), low.z.min(p.z));
        high = Vec3::new(high.x.max(p.x), high.y.max(p.y), high.z.max(p.z));
    }
    let centre = (low + high) * 0.5;
    let radius = corners().map(|p| (p - centre).norm()).fold(0.0, f64::max);
    let (k, count) = (nodes.len(), triangles.len());
    nodes.push(Node { centre, radius, triangles: [first, first + count], halves: None });
    if count > LEAF {
        let extent = high - low;
        let axis = (0..3).max_by(|a, b| extent[*a].total_cmp(&extent[*b])).unwrap_or(0);
        let middle = |t: &[u32; 3]| t.iter().map(|k| vertices[*k as usize][axis]).sum::<f64>();
        triangles.select_nth_unstable_by(count / 2, |a, b| middle(a).total_cmp(&middle(b)));
        let (left, right) = triangles.split_at_mut(count / 2);
        let left = grow(vertices, left, first, nodes);
        let right = grow(vertices, right, first + count / 2, nodes);
        nodes[k].halves = Some([left, right]);
    }
    k
}

/// True if all corners of a triangle are at least this far from some points along n, whose length is that distance: the
/// triangle is no nearer.
pub(crate) fn is_behind(points: &[Vec3], corners: [Vec3; 3], n: Vec3, distance: f64) -> bool {
    let lowest = points.iter().map(|p| n.dot(*p)).fold(f64::INFINITY, f64::min);
    let highest = corners.iter().map(|v| n.dot(*v)).fold(f64::NEG_INFINITY, f64::max);
    distance > 0.0 && lowest - highest >= distance * distance
}

/// The nearest of the triangles that were visited to a point.
pub(crate) struct NearestTriangle {
    p: Vec3,
    /// Distance, the nearest point, and the part of its triangle that it lies on.
    pub found: Option<(f64, Vec3, TrianglePart)>,
}

impl NearestTriangle {
    pub fn to(p: Vec3) -> Self {
        Self { p, found: None }
    }

    /// Visits a triangle; returns its distance, or one that it is not below if that of another triangle is less.
    pub fn visit(&mut self, corners: [Vec3; 3], ids: [u32; 3]) -> f64 {
        let p = self.p;
        if let Some((apart, ..)) = self.found.filter(|(apart, q, _)| is_behind(&[p], corners, p - *q, *apart))
        {
            return apart;
        }
        let (q, part) = nearest_of_triangle(p, corners, ids);
        let apart = (q - p).norm();
        if self.found.is_none_or(|found| apart < found.0) {
            self.found = Some((apart, q, part));
        }
        apart
    }
}

/// Sine of the angle from an edge, seen along the normal, below which a point is over the edge: round-off. Such points
/// are nearest to the face, which may go on beyond the edge.
const OVER_EDGE: f64 = 1e-13;

/// The nearest point of a triangle to a point, and the part that it lies on.
pub fn nearest_of_triangle(p: Vec3, [a, b, c]: [Vec3; 3], [i, j, k]: [u32; 3]) -> (Vec3, TrianglePart) {
    let edge = |from: Vec3, to: Vec3, ends: [u32; 2]| {
        let e = to - from;
        let t = (e.dot(p - from) / e.dot(e)).clamp(0.0, 1.0);
        let part = if t <= 0.0 {
            TrianglePart::Vertex(ends[0])
        } else if t >= 1.0 {
            TrianglePart::Vertex(ends[1])
        } else {
            TrianglePart::Edge(ends)
        };
        (from + e * t, part)
    };
    let normal = (b - a).cross(c - a);
    // Inside all three edges, seen along the normal.
    let inside = |from: Vec3, to: Vec3| {
        let (e, v) = (to - from, p - from);
        let beyond = -normal.dot(e.cross(v));
        let square = |v: Vec3| v.dot(v);
        beyond < 0.0 || beyond * beyond <= OVER_EDGE * OVER_EDGE * square(normal) * square(e) * square(v)
    };
    if inside(a, b) && inside(b, c) && inside(c, a) && normal.dot(normal) > 0.0 {
        let height = normal.dot(p - a) / normal.dot(normal);
        return (p - normal * height, TrianglePart::Face([i, j, k]));
    }
    let edges = [edge(a, b, [i, j]), edge(b, c, [j, k]), edge(c, a, [k, i])];
    let apart = |found: &(Vec3, TrianglePart)| (found.0 - p).norm();
    edges.into_iter().reduce(|a, b| if apart(&b) < apart(&a) { b } else { a }).expect("three edges")
}

/// Unit normal of a triangle of any size; `None` if its corners are on one line.
fn normal_of([a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    let [u, v] = number::both([b - a, c - a], |e| e * (1.0 / e.norm()));
    u.cross(v).unit()
}

/// Facets of the convex hull of points, as triangles that face outward; `None` if the points lie in one plane. Several
/// triangles may cover the same facet of more than three points.
pub fn hull(points: &[Vec3]) -> Option<Vec<[u32; 3]>> {
    let size = points.iter().map(|p| (*p - points[0]).norm()).fold(0.0, f64::max);
    let within = FLAT * size;
    let mut found = Vec::new();
    let count = points.len() as u32;
    for i in 0..count {
        for j in i + 1..count {
            for k in j + 1..count {
                let [a, b, c] = number::each(&[i, j, k], |n| points[n as usize]);
                let Some(normal) = normal_of([a, b, c]) else { continue };
                let heights = || points.iter().map(|p| normal.dot(*p - a));
                let (most, least) = (heights().fold(0.0, f64::max), heights().fold(0.0, f64::min));
                if most <= within && least < -within {
                    found.push([i, j, k]);
                } else if least >= -within && most > within {
                    found.push([i, k, j]);
                }
            }
        }
    }
    (!found.is_empty()).then_some(found)
}

/// Distance from a plane, as a fraction of the extent of points, below which they lie in it.
const FLAT: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Surface {
        let at = |k: u32| Vec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2 & 1)) * 2.0;
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Surface::new((0..8).map(at).collect(), triangles)
    }

    /// Several cubes in one surface: corner, size, and true for a hollow.
    fn cubes(all: &[([f64; 3], f64, bool)]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for &(corner, size, is_hollow) in all {
            let (cube, first) = (cube(), vertices.len() as u32);
            vertices.extend(cube.vertices.iter().map(|v| *v * (size * 0.5) + Vec3::from(corner)));
            let turned = |[a, b, c]: [u32; 3]| if is_hollow { [a, c, b] } else { [a, b, c] };
            triangles.extend(cube.triangles.iter().map(|t| turned(t.map(|k| k + first))));
        }
        (vertices, triangles)
    }

    #[test]
    fn closed_parts_that_overlap_are_found_and_hollows_are_none() {
        let block = ([0.0; 3], 10.0, false);
        for (other, overlaps) in [
            (([12.0, 0.0, 0.0], 3.0, false), false),
            (([3.0, 3.0, 3.0], 2.0, true), false),
            (([3.0, 3.0, 3.0], 2.0, false), true),
            (([8.0, 4.0, 4.0], 3.0, false), true),
            (([10.0, 4.0, 4.0], 3.0, false), true),
            (([-3.0, 4.0, 9.0], 3.0001, false), true),
        ] {
            for order in [[block, other], [other, block]] {
                let (vertices, mut triangles) = cubes(&order);
                assert_eq!(overlap_of_parts(&vertices, &triangles).is_some(), overlaps, "{order:?}");
                // The same in the opposite sense.
                triangles.iter_mut().for_each(|t| t.swap(1, 2));
                assert_eq!(overlap_of_parts(&vertices, &triangles).is_some(), overlaps, "{order:?}");
            }
        }
    }

    #[test]
    fn a_cube_is_closed_and_its_points_are_inside() {
        let cube = cube();
        assert!(cube.is_closed());
        for (p, expected) in [
            (Vec3::new(1.0, 1.0, 0.3), -0.3),
            (Vec3::new(1.0, 1.0, 2.5), 0.5),
            (Vec3::new(3.0, 3.0, 1.0), 2.0_f64.sqrt()),
            (Vec3::new(-1.0, -1.0, -1.0), 3.0_f64.sqrt()),
        ] {
            let best = cube.nearest_to(p).unwrap();
            let sign = if cube.is_inside(p, best.2, best.1) { -1.0 } else { 1.0 };
            assert!((sign * best.0 - expected).abs() < 1e-14, "{p:?}: {best:?}");
        }
    }

    #[test]
    fn the_hull_of_a_cube_has_its_faces() {
        let cube = cube();
        let inner = Vec3::new(0.7, 1.1, 0.9);
        let points: Vec<Vec3> = cube.vertices().iter().copied().chain([inner]).collect();
        let facets = hull(&points).unwrap();
        assert!(facets.iter().flatten().all(|k| *k < 8));
        for [a, b, c] in facets.iter().map(|f| f.map(|k| points[k as usize])) {
            assert!((b - a).cross(c - a).dot(inner - a) < 0.0);
        }
        // Four triangles of each face.
        assert_eq!(facets.len(), 24);
        assert_eq!(hull(&points[..4]), None);
    }
}

//! Nearest points of a surface of triangles and another core or surface, for plain numbers.
//!
//! The surface of a closed mesh and of a convex hull has an inside: points there have negative distances, and the
//! distance of a core is that of its deepest point.

use std::ops::Range;

use crate::number;
use crate::space::{
    NearestTriangle, Pose, Real, Surface, TrianglePart, Vec3, is_behind, is_pierced, nearest_of_triangle,
};

use super::block::Block;
use super::circle::Circle;
use super::core::Core;
use super::feature::{Feature, PARALLEL};
use super::least::{Part, Path, SHORTEST_LEVEL, Surroundings, least_along, middle_of_level};
use super::nearest::{
    Nearest, along_circle, around_drum, found, from_point, nearer, segment_and_circle, segment_and_cylinder,
    segment_and_edge,
};

/// Distance of a point from a surface that is none, as a fraction of a segment along it.
const ON_SURFACE: f64 = 1e-9;

/// A surface in the frame in which its points are given.
#[derive(Clone, Copy)]
pub(super) enum View<'a> {
    /// A mesh, with a tree.
    Mesh(&'a Surface),
    /// A convex hull with few facets.
    Hull { points: &'a [Vec3], facets: &'a [[u32; 3]], block: Option<Block> },
    /// One triangle of a mesh.
    Facet { surface: &'a Surface, triangle: usize },
}

impl<'a> View<'a> {
    /// A convex hull.
    pub fn hull(points: &'a [Vec3], facets: &'a [[u32; 3]]) -> Self {
        Self::Hull { points, facets, block: Block::of(points) }
    }
}

impl View<'_> {
    fn triangle(&self, t: usize) -> ([Vec3; 3], [u32; 3]) {
        match self {
            Self::Mesh(surface) | Self::Facet { surface, .. } => (surface.corners(t), surface.triangles()[t]),
            Self::Hull { points, facets, .. } => {
                (number::each(&facets[t], |k| points[k as usize]), facets[t])
            }
        }
    }

    /// Numbers of its triangles.
    fn triangles(&self) -> Range<usize> {
        match self {
            Self::Mesh(surface) => 0..surface.triangles().len(),
            Self::Hull { facets, .. } => 0..facets.len(),
            Self::Facet { triangle, .. } => *triangle..*triangle + 1,
        }
    }

    /// Corners of triangles, by their numbers.
    fn points(&self) -> &[Vec3] {
        match self {
            Self::Mesh(surface) | Self::Facet { surface, .. } => surface.vertices(),
            Self::Hull { points, .. } => points,
        }
    }

    /// Corners of its own triangles, with their numbers.
    fn corners(&self) -> impl Iterator<Item = (u32, Vec3)> {
        let (some, all) = match self {
            Self::Mesh(_) | Self::Hull { .. } => (&[][..], self.points().len() as u32),
            Self::Facet { surface, triangle } => (&surface.triangles()[*triangle][..], 0),
        };
        some.iter().copied().chain(0..all).map(|k| (k, self.points()[k as usize]))
    }

    /// True if it has an inside.
    fn is_closed(&self) -> bool {
        match self {
            Self::Facet { .. } => false,
            Self::Mesh(surface) => surface.is_closed(),
            Self::Hull { .. } => true,
        }
    }

    /// A ball around it.
    pub fn ball(&self) -> (Vec3, f64) {
        match self {
            Self::Mesh(surface) | Self::Facet { surface, .. } => surface.ball(),
            Self::Hull { points, .. } => {
                let centre = points.iter().fold(Vec3::ZERO, |sum, p| sum + *p) * (1.0 / points.len() as f64);
                (centre, points.iter().map(|p| (*p - centre).norm()).fold(0.0, f64::max))
            }
        }
    }

    /// Visits the triangles that may be nearer than `least`; `each` returns their distances.
    fn search(&self, least: f64, apart: &dyn Fn(Vec3) -> f64, each: &mut dyn FnMut(usize) -> f64) {
        match self {
            Self::Mesh(surface) => surface.search(least, apart, each),
            Self::Hull { .. } | Self::Facet { .. } => {
                for t in self.triangles() {
                    each(t);
                }
            }
        }
    }

    /// Distance of a point, negative inside.
    pub fn distance_from(&self, p: Vec3) -> f64 {
        match self {
            Self::Hull { block: Some(block), .. } => block.distance(p),
            Self::Hull { block: None, .. } | Self::Mesh(_) | Self::Facet { .. } => {
                self.nearest_to(p).distance
            }
        }
    }

    /// The nearest point to a point; its distance is negative inside.
    pub fn nearest_to(&self, p: Vec3) -> Nearest {
        let own = Feature::Point(0.0);
        let best = match self {
            Self::Mesh(surface) => surface.nearest_to(p),
            Self::Hull { block: Some(block), .. } => return block.nearest_to(p),
            Self::Hull { points, facets, block: None } => {
                // Inside a convex hull the nearest facet is the one whose plane is nearest.
                let height = |f: &[u32; 3]| {
                    let [a, b, c] = number::each(f, |k| points[k as usize]);
                    let normal = (b - a).cross(c - a);
                    let length = normal.norm();
                    (normal.dot(p - a) / length, normal * (1.0 / length), *f)
                };
                let most = facets.iter().map(height).reduce(|a, b| if b.0 > a.0 { b } else { a });
                if let Some((height, normal, facet)) = most.filter(|most| most.0 <= 0.0) {
                    return found([own, Feature::Facet(facet)], [p, p - normal * height], height);
                }
                self.nearest_of_all(p)
            }
            Self::Facet { .. } => self.nearest_of_all(p),
        };
        let Some((apart, q, part)) = best else {
            // The page has no meshes: nothing is known there.
            return found([own, Feature::Vertex(0)], [p, p], f64::NAN);
        };
        let inside = matches!(self, Self::Mesh(surface) if surface.is_inside(p, part, q));
        found([own, of_part(part)], [p, q], if inside { -apart } else { apart })
    }

    /// True if it goes on along a segment, or against it, from the point q that is nearest to a point p of the segment.
    fn goes_on(&self, [p, q]: [Vec3; 2], e: Vec3) -> bool {
        let (n, within) = (p - q, ON_SURFACE * e.norm());
        let is_on = |p: Vec3| {
            let mut found = false;
            self.search(within, &|centre| (centre - p).norm(), &mut |t| {
                let (corners, ids) = self.triangle(t);
                let distance = (nearest_of_triangle(p, corners, ids).0 - p).norm();
                found |= distance <= within;
                distance
            });
            found
        };
        n.dot(e).abs() <= PARALLEL * n.norm() * e.norm()
            && [-0.5, 0.5].into_iter().any(|by| is_on(q + e * (by * SHORTEST_LEVEL)))
    }

    /// The nearest of all triangles, without a search.
    fn nearest_of_all(&self, p: Vec3) -> Option<(f64, Vec3, TrianglePart)> {
        let mut best = NearestTriangle::to(p);
        for t in self.triangles() {
            let (corners, ids) = self.triangle(t);
            best.visit(corners, ids);
        }
        best.found
    }

    /// The nearest points of a triangle's edges and a core; `core_and_edge` is given both ends of an edge.
    fn edges(&self, t: usize, each: impl Fn([Vec3; 2]) -> Nearest) -> Nearest {
        let (corners, ids) = self.triangle(t);
        nearer(number::each(&[0, 1, 2], |k| {
            let next = (k + 1) % 3;
            let near = each([corners[k], corners[next]]);
            Nearest { features: [near.features[0], of_edge(near.features[1], [ids[k], ids[next]])], ..near }
        }))
    }
}

/// A surface around a path that is inside in parts.
struct Within<'a>(View<'a>);

impl Surroundings for Within<'_> {
    const IS_PLAIN: bool = false;

    fn distance(&self, p: Vec3) -> (f64, Vec3) {
        let near = self.0.nearest_to(p);
        (near.distance, near.gradient())
    }

    /// The depth is at most the distance from any part of the surface, which is convex: a corner is the deepest.
    fn bounded(&self, part: &Part) -> [f64; 2] {
        let near = self.0.nearest_to(part.middle);
        if !(near.distance < 0.0) {
            return [near.distance, f64::NEG_INFINITY];
        }
        let points = self.0.points();
        let bound = match near.features[1] {
            Feature::Facet(ids) => {
                let corners = number::each(&ids, |k| points[k as usize]);
                part.lowest_corner(|p| -(nearest_of_triangle(p, corners, ids).0 - p).norm())
            }
            Feature::Edge(ids) => {
                let edge = Core::Segment(number::both(ids, |k| points[k as usize]));
                part.lowest_corner(|p| -from_point(p, &edge).distance)
            }
            Feature::Vertex(_)
            | Feature::EdgePoint(..)
            | Feature::Point(_)
            | Feature::Line
            | Feature::Circle(_)
            | Feature::Face(_) => part.lowest_corner(|p| -(p - near.points[1]).norm()),
        };
        [near.distance, bound]
    }
}

/// Feature of a surface, by the part of a triangle.
fn of_part(part: TrianglePart) -> Feature {
    match part {
        TrianglePart::Vertex(k) => Feature::Vertex(k),
        TrianglePart::Edge(ends) => Feature::Edge(ends),
        TrianglePart::Face(corners) => Feature::Facet(corners),
    }
}

/// True if two triangles are at least this far apart along the line between their centroids.
fn is_beyond(p: [Vec3; 3], q: [Vec3; 3], distance: f64) -> bool {
    let between = (p[0] + p[1] + p[2] - q[0] - q[1] - q[2]) * (1.0 / 3.0);
    let length = between.norm();
    length > 0.0 && distance.is_finite() && is_behind(&p, q, between * (distance / length), distance)
}

/// Feature of a surface, by that of one of its edges as a segment.
fn of_edge(feature: Feature, ends: [u32; 2]) -> Feature {
    match feature {
        Feature::Point(at) if at <= 0.0 => Feature::Vertex(ends[0]),
        Feature::Point(at) if at >= 1.0 => Feature::Vertex(ends[1]),
        // Where both are parallel: two lines have no distance then.
        Feature::Point(at) => Feature::EdgePoint(ends, at),
        Feature::Line => Feature::Edge(ends),
        other @ (Feature::Circle(_)
        | Feature::Face(_)
        | Feature::Vertex(_)
        | Feature::Edge(_)
        | Feature::EdgePoint(..)
        | Feature::Facet(_)) => other,
    }
}

/// The nearest points of a core and a surface, both in the frame of the surface.
pub(super) fn core_and_surface(core: &Core, view: View<'_>) -> Nearest {
    match core {
        Core::Point(p) => view.nearest_to(*p),
        Core::Segment(ends) => segment_and_surface(*ends, view),
        Core::Circle(circle) => circle_and_surface(circle, Feature::Circle(0.0), view),
        Core::Cylinder { middle, half_width } => {
            let rims = number::both([-1.0, 1.0], |side| {
                circle_and_surface(&middle.moved(half_width * side), Feature::Circle(side), view)
            });
            let drum = around_drum(middle, *half_width);
            let mut best = nearer(rims);
            if best.sign == 0.0 {
                return best;
            }
            view.search(best.distance, &|q| drum.distance(q), &mut |t| {
                let near = view.edges(t, |edge| segment_and_cylinder(edge, &drum).reversed());
                if near.distance < best.distance {
                    best = near;
                }
                near.distance
            });
            if best.distance <= 0.0 {
                return best;
            }
            // A cylinder that a triangle covers within its rims is pierced along its axis.
            let axis = segment_and_surface(drum.axis(), view);
            if axis.distance <= 0.0 { best.overlapping(axis.points[0]) } else { best }
        }
        Core::HalfSpace { point, normal } => {
            let lowest = view.corners().map(|(k, p)| (normal.dot(p - *point), k, p));
            match lowest.reduce(|a, b| if b.0 < a.0 { b } else { a }) {
                Some((height, k, p)) => {
                    let features = [Feature::Face(1.0), Feature::Vertex(k)];
                    found(features, [p - *normal * height, p], height)
                }
                None => found([Feature::Face(1.0), Feature::Vertex(0)], [*point; 2], f64::NAN),
            }
        }
    }
}

/// The nearest points of a circle, which is this feature of its shape, and a surface; of one that is partly inside, its
/// deepest point. One that goes through an open surface overlaps with it.
fn circle_and_surface(circle: &Circle, itself: Feature, view: View<'_>) -> Nearest {
    let reach = Core::Circle(*circle);
    let mut through = None;
    let mut best = found([itself, Feature::Vertex(0)], [circle.centre; 2], f64::INFINITY);
    view.search(f64::INFINITY, &|q| reach.distance_from(q), &mut |t| {
        if through.is_some() {
            return 0.0;
        }
        let (corners, ids) = view.triangle(t);
        let centre = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
        let radius = corners.iter().map(|p| (*p - centre).norm()).fold(0.0, f64::max);
        if reach.distance_from(centre) - radius >= best.distance {
            return best.distance;
        }
        through = crossing(circle, corners);
        if through.is_some() {
            return 0.0;
        }
        let near = circle_and_triangle(circle, itself, corners, ids, best.distance);
        if near.distance < best.distance {
            best = near;
        }
        near.distance
    });
    if through.is_none() && best.distance.is_infinite() {
        // The page has no meshes: nothing is known there.
        return Nearest { distance: f64::NAN, ..best };
    }
    let is_within = || view.is_closed() && view.nearest_to(best.points[0]).distance < 0.0;
    match through {
        Some(at) if !view.is_closed() => best.overlapping(at),
        None if !is_within() => {
            let path = Path::around(circle);
            let apart = |turn: f64| view.distance_from(path.at(turn)).abs();
            let is_level =
                |k: u8| (apart(f64::from(k) * 0.25) - best.distance).abs() <= PARALLEL * circle.radius;
            Nearest { is_parallel: (0..4).all(is_level), ..best }
        }
        Some(_) | None => along_circle(circle, itself, &Within(view), |p| view.nearest_to(p)),
    }
}

/// The nearest points of a circle and a triangle that it does not go through; edges farther than `least` are left out.
fn circle_and_triangle(
    circle: &Circle,
    itself: Feature,
    corners: [Vec3; 3],
    ids: [u32; 3],
    least: f64,
) -> Nearest {
    // Over the face the lowest or highest point of the circle is nearest, or all of it.
    let up = Slope::over(circle, corners).up.unwrap_or_else(|| circle.axis.any_perpendicular());
    let over_face = number::both([-1.0, 1.0], |side| {
        let p = circle.centre + up * (circle.radius * side);
        let (q, part) = nearest_of_triangle(p, corners, ids);
        found([itself, of_part(part)], [p, q], (q - p).norm())
    });
    let reach = Core::Circle(*circle);
    let mut best = nearer(over_face);
    for k in 0..3 {
        let next = (k + 1) % 3;
        let [a, b] = [corners[k], corners[next]];
        if reach.distance_from((a + b) * 0.5) - 0.5 * (b - a).norm() >= least.min(best.distance) {
            continue;
        }
        let near = segment_and_circle([a, b], circle).reversed();
        if near.distance < best.distance {
            best = Nearest { features: [itself, of_edge(near.features[1], [ids[k], ids[next]])], ..near };
        }
    }
    best
}

/// Heights of a circle over the plane of a triangle: `height + radius w cos(angle)`, the angle counted from `up`, w the
/// length of the plane's normal within the plane of the circle.
struct Slope {
    normal: Vec3,
    height: f64,
    /// Unit vector in the plane of the circle; `None` where that is parallel to the triangle.
    up: Option<Vec3>,
    w: f64,
}

impl Slope {
    fn over(circle: &Circle, [a, b, c]: [Vec3; 3]) -> Self {
        let across = (b - a).cross(c - a);
        let normal = across * (1.0 / across.norm());
        let steepest = normal - circle.axis * circle.axis.dot(normal);
        let height = normal.dot(circle.centre - a);
        Self { normal, height, up: steepest.unit(), w: steepest.norm() }
    }
}

/// Point at which a circle goes through a triangle.
fn crossing(circle: &Circle, corners: [Vec3; 3]) -> Option<Vec3> {
    let Slope { normal, height, up, w } = Slope::over(circle, corners);
    let ([a, b, c], Circle { centre, axis, radius }) = (corners, *circle);
    let up = up?;
    let cos = -height / (radius * w);
    let sin = (1.0 - cos * cos).sqrt();
    let inside =
        |p: &Vec3| [[a, b], [b, c], [c, a]].iter().all(|[u, v]| normal.dot((*v - *u).cross(*p - *u)) >= 0.0);
    // NaN where the circle is above or below the plane, or the triangle has no area.
    let places = number::both([sin, -sin], |sin| centre + (up * cos + axis.cross(up) * sin) * radius);
    places.into_iter().find(inside)
}

/// The nearest points of a segment and a surface; of one that is partly inside, its deepest point.
fn segment_and_surface([a, b]: [Vec3; 2], view: View<'_>) -> Nearest {
    let first = view.nearest_to(a);
    if !first.distance.is_finite() {
        return first;
    }
    let mut pierces = view.is_closed() && first.distance < 0.0;
    let mut best = first;
    if !pierces {
        let reach = Core::Segment([a, b]);
        view.search(best.distance, &|q| reach.distance_from(q), &mut |t| {
            let (corners, ids) = view.triangle(t);
            let [p, q] = best.points;
            if is_behind(&[a, b], corners, p - q, best.distance) {
                return best.distance;
            }
            if is_pierced([a, b], corners) {
                pierces = true;
                return 0.0;
            }
            let (q, part) = nearest_of_triangle(b, corners, ids);
            let end = found([Feature::Point(1.0), of_part(part)], [b, q], (q - b).norm());
            let near = nearer([end, view.edges(t, |edge| segment_and_edge([a, b], edge))]);
            if near.distance < best.distance {
                best = near;
            }
            near.distance
        });
    }
    if pierces && !view.is_closed() {
        return best.overlapping(best.points[0]);
    }
    let e = b - a;
    let from = |t: f64| {
        let near = view.nearest_to(a + e * t);
        Nearest { features: [Feature::Point(t), near.features[1]], ..near }
    };
    let t = match pierces {
        true => least_along(&Path::Segment([a, b]), &Within(view)),
        false => e.dot(best.points[0] - a) / e.dot(e),
    };
    // Of places that are as near, along a face that the segment is parallel to, the middle.
    if (pierces || view.goes_on(best.points, e))
        && let Some(middle) = middle_of_level(|t| from(t).gradient().dot(e), e.norm(), t)
    {
        return Nearest { is_parallel: true, ..from(middle) };
    }
    match pierces {
        true if t > 0.0 && t < 1.0 => from(t).between_features(e, t, from),
        true => from(t),
        false => best,
    }
}

/// The nearest points of two surfaces; `place` moves points of the second into the frame of the first. Where they
/// overlap the distance is 0.
pub(super) fn surfaces(a: View<'_>, b: View<'_>, place: Pose) -> Nearest {
    let mut best = found([Feature::Vertex(0); 2], [Vec3::ZERO; 2], f64::INFINITY);
    let mut overlap = None;
    let mut each = |s: usize, t: usize| {
        let ((p, ids), (q, others)) = (a.triangle(s), b.triangle(t));
        let q = number::each(&q, |q| place.point(q));
        let [near, other] = best.points;
        if is_behind(&p, q, near - other, best.distance) || is_beyond(p, q, best.distance) {
            return best.distance;
        }
        for k in 0..3 {
            let (own, other) = ([p[k], p[(k + 1) % 3]], [q[k], q[(k + 1) % 3]]);
            if is_pierced(own, q) || is_pierced(other, p) {
                overlap = Some(own[0]);
                return 0.0;
            }
        }
        // Of edges, and of corners over faces.
        let edges = |k: usize| {
            nearer(number::each(&[0, 1, 2], |n| {
                let near = segment_and_edge([p[k], p[(k + 1) % 3]], [q[n], q[(n + 1) % 3]]);
                let [own, other] = near.features;
                let features = [
                    of_edge(own, [ids[k], ids[(k + 1) % 3]]),
                    of_edge(other, [others[n], others[(n + 1) % 3]]),
                ];
                Nearest { features, ..near }
            }))
        };
        let corner = |p: Vec3, id: u32, corners: [Vec3; 3], ids: [u32; 3]| {
            let (q, part) = nearest_of_triangle(p, corners, ids);
            found([Feature::Vertex(id), of_part(part)], [p, q], (q - p).norm())
        };
        let near = nearer([
            nearer([0, 1, 2].map(edges)),
            nearer(number::each(&[0, 1, 2], |k| corner(p[k], ids[k], q, others))),
            nearer(number::each(&[0, 1, 2], |k| corner(q[k], others[k], p, ids))).reversed(),
        ]);
        if near.distance < best.distance {
            best = near;
        }
        near.distance
    };
    match (a, b) {
        (View::Mesh(p), View::Mesh(q)) => p.search_pairs(q, &|x| place.point(x), &mut each),
        (View::Mesh(p), View::Hull { .. } | View::Facet { .. }) => {
            let (centre, radius) = b.ball();
            let centre = place.point(centre);
            p.search(f64::INFINITY, &|x| (x - centre).norm() - radius, &mut |s| {
                b.triangles().map(|t| each(s, t)).fold(f64::INFINITY, f64::min)
            });
        }
        (View::Hull { .. } | View::Facet { .. }, View::Mesh(q)) => {
            let (centre, radius) = a.ball();
            q.search(f64::INFINITY, &|x| (place.point(x) - centre).norm() - radius, &mut |t| {
                a.triangles().map(|s| each(s, t)).fold(f64::INFINITY, f64::min)
            });
        }
        (View::Hull { .. } | View::Facet { .. }, View::Hull { .. } | View::Facet { .. }) => {
            for s in a.triangles() {
                for t in b.triangles() {
                    each(s, t);
                }
            }
        }
    }
    if let Some(p) = overlap {
        return best.overlapping(p);
    }
    // One within the other.
    let is_inside = |view: View<'_>, p: Option<Vec3>| {
        view.is_closed() && p.is_some_and(|p| view.nearest_to(p).distance < 0.0)
    };
    let back = place.inverse();
    let first = a.corners().next().map(|(_, p)| back.point(p));
    if is_inside(a, b.corners().next().map(|(_, p)| place.point(p))) || is_inside(b, first) {
        return best.overlapping(best.points[0]);
    }
    if best.distance.is_infinite() { Nearest { distance: f64::NAN, ..best } } else { best }
}

/// A core in another frame.
pub(super) fn moved<T: Real>(core: &Core<T>, pose: Pose<T>) -> Core<T> {
    let circle = |c: &Circle<T>| Circle { centre: pose.point(c.centre), axis: pose.rot * c.axis, ..*c };
    match core {
        Core::Point(p) => Core::Point(pose.point(*p)),
        Core::Segment(ends) => Core::Segment(number::both(*ends, |p| pose.point(p))),
        Core::Circle(c) => Core::Circle(circle(c)),
        Core::Cylinder { middle, half_width } => {
            Core::Cylinder { middle: circle(middle), half_width: *half_width }
        }
        Core::HalfSpace { point, normal } => {
            Core::HalfSpace { point: pose.point(*point), normal: pose.rot * *normal }
        }
    }
}

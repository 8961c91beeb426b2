//! Shapes of a model at poses of its bodies, and the nearest pair of a clearance.

use crate::design::{BodyFixed, ShapeGeometry};
use crate::model::{BodyId, ClearanceId, Model, PointId, ShapeId, ShapeKind, with_core};
use crate::number::{self, Rates};
use crate::space::{Pose, Real, Vec3};

use super::bodies::{Bodies, MovingSegment, leave_their_plane};
use super::circle::Circle;
use super::core::Core;
use super::feature::{CORRECTIONS, Feature, Placed, distance, nearest_points};
use super::nearest::{Nearest, nearest};
use super::surface::{View, core_and_surface, moved, surfaces};
use super::through_ring::PlaceOnSegment;

/// The pair of a clearance whose shapes are nearest, and where they are; `None` if the clearance has no pairs.
pub(crate) type NearestPair = Option<(usize, Nearest)>;

/// Distance of two points that coincide, as a fraction of the mechanism's size: round-off of solved positions.
const MEETS: f64 = 1e-10;

/// The shapes of a model where its bodies are.
pub(crate) struct PlacedShapes<'a, T, B: ?Sized = [Pose<T>]> {
    pub model: &'a Model,
    pub fixed: &'a BodyFixed<T>,
    /// Those that carry shapes count.
    pub bodies: &'a B,
}

impl<T: Real, B: Bodies<T> + ?Sized> PlacedShapes<'_, T, B> {
    /// A point, in global coordinates.
    pub(super) fn point(&self, p: PointId) -> Vec3<T> {
        self.bodies.point(self.model.points[p.0].body, self.fixed.points[p.0])
    }

    /// The same in plain numbers.
    fn place(&self, p: PointId) -> Vec3 {
        self.bodies.place(self.model.points[p.0].body, self.fixed.points[p.0].value())
    }

    /// Core of a shape, in global coordinates; `None` for a surface.
    pub fn core(&self, shape: ShapeId) -> Option<Core<T>> {
        let direction = |body, e| self.bodies.direction(body, e);
        core_of(self.model, shape, self.fixed.shapes[shape.0], &|p| self.point(p), &direction)
    }

    /// The same in plain numbers.
    pub fn plain_core(&self, shape: ShapeId) -> Option<Core> {
        let heading = |body, e| self.bodies.heading(body, e);
        let numbers = self.fixed.shapes[shape.0].map(T::value);
        core_of(self.model, shape, numbers, &|p| self.place(p), &heading)
    }

    /// Radii around the cores of two shapes.
    pub fn rounds(&self, shapes: [ShapeId; 2]) -> T {
        let [a, b] = number::both(shapes, |s| self.fixed.shapes[s.0].round);
        a + b
    }

    /// A feature of a shape, and the distance by which the core extends beyond it. A facet of an open surface, which
    /// has no inside, is seen from this point.
    fn feature(&self, shape: ShapeId, feature: Feature, seen_from: Vec3) -> (Placed<T>, T) {
        let vertex = |k: u32| match &self.model.shapes[shape.0].kind {
            ShapeKind::Hull { points, .. } => self.point(points[k as usize]),
            ShapeKind::Mesh { body, surface } => {
                self.bodies.point(*body, surface.vertices()[k as usize].spread())
            }
            with_core!() => unreachable!("only surfaces have vertices"),
        };
        let placed = match feature {
            Feature::Vertex(k) => Placed::Point(vertex(k)),
            Feature::Edge([a, b]) => Placed::Line { from: vertex(a), along: vertex(b) - vertex(a) },
            Feature::EdgePoint([a, b], at) => {
                let from = vertex(a);
                Placed::Point((vertex(b) - from).times_plus(T::constant(at), from))
            }
            Feature::Facet(corners) => {
                let [a, b, c] = number::each(&corners, vertex);
                let normal = (b - a).cross(c - a);
                let is_behind = normal.value().dot(seen_from - a.value()) < 0.0;
                let sense = if is_behind && !self.has_inside(shape) { -1.0 } else { 1.0 };
                Placed::Face { point: a, normal: normal * (T::constant(sense) / normal.norm()) }
            }
            Feature::Point(_) | Feature::Line | Feature::Circle(_) | Feature::Face(_) => {
                let core = self.core(shape).expect("a surface has vertices, edges and facets");
                return core.feature(feature);
            }
        };
        (placed, T::zero())
    }

    /// A ball around a shape: centre and radius.
    pub fn ball(&self, shape: ShapeId) -> (Vec3, f64) {
        let round = self.fixed.shapes[shape.0].round.value();
        let (centre, radius) = match &self.model.shapes[shape.0].kind {
            ShapeKind::Mesh { body, surface } => {
                let (centre, radius) = surface.ball();
                (self.bodies.pose(*body).point(centre), radius)
            }
            ShapeKind::Hull { points, facets } => {
                let points = self.points(points);
                View::Hull { points: &points, facets, block: None }.ball()
            }
            with_core!() => self.plain_core(shape).expect("it is no surface").ball(),
        };
        (centre, radius + round)
    }

    /// Corners of a hull or of a triangle of a mesh, in global coordinates; none of another shape.
    pub fn corners(&self, shape: ShapeId, triangle: Option<usize>) -> Vec<Vec3<T>> {
        match &self.model.shapes[shape.0].kind {
            ShapeKind::Hull { points, .. } => points.iter().map(|p| self.point(*p)).collect(),
            ShapeKind::Mesh { body, surface } => triangle.map_or_else(Vec::new, |t| {
                number::each(&surface.corners(t), |p| self.bodies.point(*body, p.spread())).to_vec()
            }),
            with_core!() => Vec::new(),
        }
    }

    /// Points in global coordinates.
    pub fn points(&self, points: &[PointId]) -> Vec<Vec3> {
        points.iter().map(|p| self.place(*p)).collect()
    }

    /// The nearest points of two shapes, with the distance of the shapes.
    pub fn nearest(&self, shapes: [ShapeId; 2]) -> Nearest {
        let near = self.nearest_of_cores(shapes);
        Nearest { distance: near.distance - self.rounds(shapes).value(), ..near }
    }

    /// The nearest points of the cores of two shapes, with the distance of the cores.
    pub fn nearest_of_cores(&self, shapes: [ShapeId; 2]) -> Nearest {
        self.nearest_of_parts(shapes, [None; 2])
    }

    /// The same, of one triangle of a mesh if its number is given.
    pub fn nearest_of_parts(&self, shapes: [ShapeId; 2], triangles: [Option<usize>; 2]) -> Nearest {
        let kinds = number::both(shapes, |s| &self.model.shapes[s.0].kind);
        let cores = number::both(shapes, |s| self.plain_core(s));
        let corners = number::both(kinds, |kind| match kind {
            ShapeKind::Hull { points, .. } => self.points(points),
            ShapeKind::Mesh { .. } | with_core!() => Vec::new(),
        });
        // Surfaces in the frame in which their points are known, and that frame.
        let views = number::both([0, 1], |k| match kinds[k] {
            ShapeKind::Mesh { body, surface } => {
                let one = triangles[k].map(|triangle| View::Facet { surface, triangle });
                Some((one.unwrap_or(View::Mesh(surface)), self.bodies.pose(*body)))
            }
            ShapeKind::Hull { facets, .. } => Some((View::hull(&corners[k], facets), Pose::IDENTITY)),
            with_core!() => None,
        });
        let (near, frame) = match (cores, views) {
            ([Some(a), Some(b)], _) => {
                let near = nearest(&a, &b);
                let passes =
                    near.is_way_out_in_plane() && self.leave_their_plane(shapes, [&a, &b], near.points[0]);
                return if passes { near.passing() } else { near };
            }
            ([Some(core), _], [_, Some((view, frame))]) => {
                (core_and_surface(&moved(&core, frame.inverse()), view), frame)
            }
            ([_, Some(core)], [Some((view, frame)), _]) => {
                (core_and_surface(&moved(&core, frame.inverse()), view).reversed(), frame)
            }
            (_, [Some((a, frame)), Some((b, other))]) => {
                (surfaces(a, b, frame.inverse().compose(other)), frame)
            }
            _ => unreachable!("a shape has a core or is a surface"),
        };
        let near = Nearest { points: number::both(near.points, |p| frame.point(p)), ..near };
        let plain = |k: usize| {
            let (placed, less) = self.feature(shapes[k], near.features[k], near.points[1 - k]);
            (placed.value(), less.value())
        };
        near.signed([plain(0), plain(1)])
    }

    /// Triangles of mesh `of` of two shapes that are no farther than `reach` from the core of the other one, or a
    /// few that are a little farther; `None` if there are more than `most` of them, or the other one is a mesh.
    pub fn triangles_within(
        &self,
        shapes: [ShapeId; 2],
        of: usize,
        reach: f64,
        most: usize,
    ) -> Option<Vec<usize>> {
        let [mesh, other] = [shapes[of], shapes[1 - of]].map(|s| &self.model.shapes[s.0].kind);
        let ShapeKind::Mesh { body, surface } = mesh else { return None };
        let into = self.bodies.pose(*body).inverse();
        let core = self.plain_core(shapes[1 - of]).map(|core| moved(&core, into));
        let points: Vec<Vec3>;
        let hull = match other {
            ShapeKind::Hull { points: of_hull, facets } => {
                points = self.points(of_hull).into_iter().map(|p| into.point(p)).collect();
                Some(View::hull(&points, facets))
            }
            ShapeKind::Mesh { .. } | with_core!() => None,
        };
        let apart = |q: Vec3| match (&core, &hull) {
            (Some(core), _) => core.distance_from(q),
            (None, Some(hull)) => hull.distance_from(q),
            (None, None) => f64::NEG_INFINITY,
        };
        let mut found = Vec::new();
        surface.search(reach, &apart, &mut |t| {
            let [a, b, c] = surface.corners(t);
            let centre = (a + b + c) * (1.0 / 3.0);
            let radius = [a, b, c].iter().map(|p| (*p - centre).norm()).fold(0.0, f64::max);
            // More than that are not gathered.
            if found.len() > most {
                return f64::NEG_INFINITY;
            }
            if apart(centre) - radius <= reach {
                found.push(t);
            }
            f64::INFINITY
        });
        (found.len() <= most).then_some(found)
    }

    /// True if two segments that cross leave the plane that they are in; false where nothing has rates.
    fn leave_their_plane(&self, shapes: [ShapeId; 2], cores: [&Core; 2], at: Vec3) -> bool {
        let segment = |k: usize| {
            let Core::Segment(ends) = *cores[k] else { return None };
            let carriers = self.model.shapes[shapes[k].0].bodies(self.model);
            let (first, last) = (*carriers.first()?, *carriers.last()?);
            let states = [self.bodies.state(first)?, self.bodies.state(last)?];
            Some(MovingSegment { ends, carriers: states, is_rigid: first == last })
        };
        segment(0).zip(segment(1)).is_some_and(|(a, b)| leave_their_plane([&a, &b], at))
    }

    /// Distance of two shapes between these features: that of their cores minus both radii.
    pub fn distance(&self, shapes: [ShapeId; 2], near: &Nearest) -> T {
        if !near.distance.is_finite() {
            return T::constant(f64::NAN);
        }
        if near.is_tied {
            // The deepest features change with any motion: the formula of one of them is stationary elsewhere.
            let distance = self.changes(shapes) - self.rounds(shapes);
            return distance + T::constant(near.distance - distance.value());
        }
        if let Some(second) = near.between {
            let distance = self.depth_between(shapes, near, second) - self.rounds(shapes);
            return distance + T::constant(near.distance - distance.value());
        }
        let apart = near.distance_between(self.features(shapes, near));
        // No direction leads from one of two points that coincide to the other.
        let apart = if self.is_without_direction(shapes, near) { apart.without_derivatives() } else { apart };
        apart - self.rounds(shapes)
    }

    /// Depth of the point of a segment, or of an edge, that is between two features of a solid: it moves so that both
    /// remain as near.
    ///
    /// With d and e the distances from the features at a place u along the segment, `u <- u - (d - e) / (d_u - e_u)`
    /// completes one order of the derivatives per step, the slopes in plain numbers.
    fn depth_between(&self, shapes: [ShapeId; 2], near: &Nearest, second: Feature) -> T {
        let own = usize::from(!matches!(near.features[0], Feature::Point(_) | Feature::EdgePoint(..)));
        let at = near.points[own];
        let line = if let Feature::EdgePoint(ends, _) = near.features[own] {
            Feature::Edge(ends)
        } else {
            Feature::Line
        };
        let (Placed::Line { from: a, along }, _) = self.feature(shapes[own], line, at) else {
            unreachable!("a segment has a line")
        };
        let to = number::both([near.features[1 - own], second], |f| self.feature(shapes[1 - own], f, at));
        let of_point = |k: usize, p: Vec3<T>, sign: f64| {
            let (placed, less) = &to[k];
            distance(&Placed::Point(p), placed, [at; 2]) * sign - *less
        };
        // A length is the depth below a corner or an edge.
        let signs =
            number::both([0, 1], |k| if of_point(k, at.spread(), 1.0).value() > 0.0 { -1.0 } else { 1.0 });
        let slope = |k: usize| {
            let n = nearest_points([&Placed::Point(at), &to[k].0.value()], [at; 2]).map(|(_, n)| n);
            n.map_or(f64::NAN, |n| -signs[k] * n.dot(along.value()))
        };
        let (e, slopes) = (along.value(), slope(0) - slope(1));
        let mut u = T::constant(e.dot(at - a.value()) / e.dot(e));
        for _ in 0..CORRECTIONS {
            let [d, e] = number::both([0, 1], |k| of_point(k, along.times_plus(u, a), signs[k]));
            u -= (d - e) * (1.0 / slopes);
        }
        of_point(0, along.times_plus(u, a), signs[0])
    }

    /// True if the nearest points of two cores coincide, and their distance is a length that is nowhere negative.
    pub fn is_without_direction(&self, shapes: [ShapeId; 2], near: &Nearest) -> bool {
        let extends = |(_, by): &(Placed<T>, T)| by.value() != 0.0;
        near.is_length()
            && near.cores_meet(MEETS * self.fixed.size)
            && !self.features(shapes, near).iter().any(extends)
    }

    /// A number whose derivatives are zero where the cores of two shapes have the same place and form relative to each
    /// other, and undefined where they do not.
    fn changes(&self, shapes: [ShapeId; 2]) -> T {
        let [first, second] = number::both(shapes, |shape| self.markers(shape));
        let mut sum = T::zero();
        for q in &second {
            for p in &first {
                let Vec3 { x, y, z } = *q - *p;
                sum += x.without_derivatives() + y.without_derivatives() + z.without_derivatives();
            }
        }
        for s in shapes {
            let ShapeGeometry { size, round, .. } = self.fixed.shapes[s.0];
            sum += size.without_derivatives();
            // Only cores of cylinders depend on the radius around them.
            if matches!(self.model.shapes[s.0].kind, ShapeKind::Cylinder { .. } | ShapeKind::Tyre { .. }) {
                sum += round.without_derivatives();
            }
        }
        sum
    }

    /// Points that determine the place of a core, and its form but for its radius.
    fn markers(&self, shape: ShapeId) -> Vec<Vec3<T>> {
        let kind = &self.model.shapes[shape.0].kind;
        let mut points: Vec<Vec3<T>> = match kind {
            ShapeKind::Sphere { centre: p }
            | ShapeKind::Ring { centre: p, .. }
            | ShapeKind::Plane { point: p, .. } => {
                vec![self.point(*p)]
            }
            ShapeKind::Tyre { wheel, .. } => vec![self.point(self.model.wheels[wheel.0].centre)],
            ShapeKind::Capsule { ends } | ShapeKind::Cylinder { ends, .. } => {
                number::both(*ends, |p| self.point(p)).to_vec()
            }
            ShapeKind::Hull { points, .. } => points.iter().map(|p| self.point(*p)).collect(),
            ShapeKind::Mesh { body, .. } => {
                let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
                number::each(&corners.map(Vec3::from), |s| self.bodies.point(*body, s.spread())).to_vec()
            }
        };
        let axis = self.model.shapes[shape.0].axis(self.model).zip(self.fixed.shapes[shape.0].axis);
        if let Some(((body, _), axis)) = axis {
            points.push(points[0] + self.bodies.direction(body, axis));
        }
        points
    }

    /// Unit vector from the nearest point of the first core to that of the second: `D' = n . (Q' - P')`. `None` where
    /// the cores meet.
    pub fn direction(&self, shapes: [ShapeId; 2], near: &Nearest) -> Option<Vec3<T>> {
        if !(near.distance > 0.0) {
            return None;
        }
        let features = self.features(shapes, near);
        let (_, n) = nearest_points(number::both(features.each_ref(), |(placed, _)| placed), near.points)?;
        Some(n * T::constant(near.sign)).filter(|n| n.value().is_finite())
    }

    /// The features that hold the nearest points.
    pub(super) fn features(&self, shapes: [ShapeId; 2], near: &Nearest) -> [(Placed<T>, T); 2] {
        number::both([0, 1], |k| self.feature(shapes[k], near.features[k], near.points[1 - k]))
    }

    /// False for the surface of an open mesh.
    fn has_inside(&self, shape: ShapeId) -> bool {
        match &self.model.shapes[shape.0].kind {
            ShapeKind::Mesh { surface, .. } => surface.is_closed(),
            ShapeKind::Hull { .. } | with_core!() => true,
        }
    }

    /// The pair of a clearance whose shapes are nearest, and where they are; `None` if it has no pairs.
    pub fn nearest_pair(&self, clearance: ClearanceId) -> NearestPair {
        let pairs = &self.model.clearances[clearance.0].pairs;
        if let [only] = &pairs[..] {
            return Some((0, self.nearest(only.shapes)));
        }
        // By balls around both shapes, the nearest first: those farther apart than a distance that is known do not
        // count.
        let mut bounds: Vec<(f64, usize)> = pairs
            .iter()
            .enumerate()
            .map(|(k, pair)| {
                let [(p, r), (q, s)] = number::both(pair.shapes, |shape| self.ball(shape));
                ((q - p).norm() - r - s, k)
            })
            .collect();
        sort(&mut bounds);
        let mut least: Option<(usize, Nearest)> = None;
        for (bound, k) in bounds {
            if least.as_ref().is_some_and(|(_, found)| bound > found.distance) {
                break;
            }
            let near = self.nearest(pairs[k].shapes);
            if least.as_ref().is_none_or(|(_, found)| near.distance < found.distance) {
                least = Some((k, near));
            }
        }
        least
    }

    /// The distance of the nearest pair of a clearance; NaN if it has none. `known` has the nearest pair of each
    /// clearance, or nothing.
    pub fn clearance(&self, clearance: ClearanceId, known: &[NearestPair]) -> T {
        let pairs = &self.model.clearances[clearance.0].pairs;
        let nearest = known.get(clearance.0).copied().unwrap_or_else(|| self.nearest_pair(clearance));
        nearest.map_or_else(|| T::constant(f64::NAN), |(k, near)| self.distance(pairs[k].shapes, &near))
    }
}

impl<B: Bodies<Rates> + ?Sized> PlacedShapes<'_, Rates, B> {
    /// Place of a segment at which it is nearest to a circle; `None` of other cores.
    pub fn place_on_segment(&self, shapes: [ShapeId; 2], near: &Nearest) -> Option<PlaceOnSegment> {
        let [a, b] = number::both(shapes, |s| self.core(s));
        let (segment, circle, of) = match (a?, b?) {
            (Core::Segment(segment), Core::Circle(circle)) => (segment, circle, 0),
            (Core::Circle(circle), Core::Segment(segment)) => (segment, circle, 1),
            (
                Core::Point(_)
                | Core::Segment(_)
                | Core::Circle(_)
                | Core::Cylinder { .. }
                | Core::HalfSpace { .. },
                _,
            ) => return None,
        };
        if let Feature::Point(end) = near.features[of] {
            return Some(PlaceOnSegment::End(end));
        }
        let [from, to] = number::both(segment, |p| p.value());
        let along = to - from;
        let u = along.dot(near.points[of] - from) / along.dot(along);
        Some(PlaceOnSegment::near(u, &segment, &circle))
    }
}

/// Sorts pairs by a lower bound of their distance, once for all kinds of numbers.
fn sort(bounds: &mut [(f64, usize)]) {
    bounds.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
}

/// Core of a shape from its numbers, its points and directions of its bodies; `None` for a surface.
fn core_of<T: Real>(
    model: &Model,
    shape: ShapeId,
    ShapeGeometry { axis, size, round }: ShapeGeometry<T>,
    point: &dyn Fn(PointId) -> Vec3<T>,
    direction: &dyn Fn(BodyId, Vec3<T>) -> Vec3<T>,
) -> Option<Core<T>> {
    let body = |p: PointId| model.points[p.0].body;
    let axis = |body: BodyId| direction(body, axis.expect("a shape with an axis"));
    Some(match &model.shapes[shape.0].kind {
        ShapeKind::Sphere { centre } => Core::Point(point(*centre)),
        ShapeKind::Capsule { ends } => Core::Segment(number::both(*ends, point)),
        ShapeKind::Ring { centre, .. } => {
            Core::Circle(Circle { centre: point(*centre), axis: axis(body(*centre)), radius: size })
        }
        ShapeKind::Cylinder { ends, .. } => {
            let [a, b] = number::both(*ends, point);
            let length = (b - a).norm();
            let middle = Circle {
                centre: (a + b) * T::constant(0.5),
                axis: (b - a) * (T::one() / length),
                radius: size - round,
            };
            Core::Cylinder { middle, half_width: length * 0.5 - round }
        }
        ShapeKind::Tyre { wheel, .. } => {
            let wheel = &model.wheels[wheel.0];
            let middle = Circle {
                centre: point(wheel.centre),
                axis: axis(wheel.body),
                radius: T::constant(wheel.radius) - round,
            };
            Core::Cylinder { middle, half_width: size * 0.5 - round }
        }
        ShapeKind::Plane { point: p, .. } => Core::HalfSpace { point: point(*p), normal: axis(body(*p)) },
        ShapeKind::Hull { .. } | ShapeKind::Mesh { .. } => return None,
    })
}

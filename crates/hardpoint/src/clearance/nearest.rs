//! Nearest points of two cores, for plain numbers, and the features that hold them.

use crate::number;
use crate::space::{Real, Vec3};

use super::circle::Circle;
use super::core::Core;
use super::feature::{Feature, PARALLEL, Placed, distance};
use super::least::{
    Part, Path, Surroundings, least_along, least_of_convex, least_of_segment, middle_of_level,
};

/// The nearest points of two cores.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// The features of both cores.
    pub features: [Feature; 2],
    /// The nearest points of both cores.
    pub points: [Vec3; 2],
    /// Distance of the cores; negative where they overlap and the way out is known.
    pub distance: f64,
    /// -1 where segments cross in a plane, and the distance is the way out of each other; 0 where the cores overlap and
    /// no way out is known, so that the distance is 0 whatever the features; otherwise 1.
    pub(super) sign: f64,
    /// True if more than one pair of points is nearest, since lines or faces are parallel.
    pub is_parallel: bool,
    /// True if other features are as deep: those that are deepest change with any motion, and the distance has no
    /// derivatives.
    pub is_tied: bool,
    /// The second feature of the other core, if the deepest point of a segment is between two that are as near.
    pub between: Option<Feature>,
}

impl Nearest {
    /// The distance of the cores by the formula of these features, each placed and with the distance by which its core
    /// extends beyond it.
    pub fn distance_between<T: Real>(&self, [(a, less), (b, as_well)]: [(Placed<T>, T); 2]) -> T {
        if self.sign == 0.0 {
            return T::zero();
        }
        distance(&a, &b, self.points) * self.sign - less - as_well
    }

    /// With the sign by which the formula gives this distance: a formula between points or lines is never negative,
    /// one of a facet is negative behind it.
    pub fn signed(mut self, features: [(Placed<f64>, f64); 2]) -> Self {
        if self.sign == 0.0 {
            return self;
        }
        self.sign = 1.0;
        self.sign = if self.distance_between(features) * self.distance < 0.0 { -1.0 } else { 1.0 };
        self
    }

    /// True if the cores meet, so that their distance does not say how deep they are in each other.
    pub fn cores_meet(&self, within: f64) -> bool {
        self.sign >= 0.0 && (self.points[1] - self.points[0]).norm() <= within
    }

    /// True if the distance is a length between points, lines or circles, which is zero where they meet and greater on
    /// both sides; false of solids and surfaces, into which it goes on.
    pub fn is_length(&self) -> bool {
        let is_of_core = |feature: &Feature| match feature {
            Feature::Point(_) | Feature::Line | Feature::Circle(_) => true,
            Feature::Face(_)
            | Feature::Vertex(_)
            | Feature::Edge(_)
            | Feature::EdgePoint(..)
            | Feature::Facet(_) => false,
        };
        self.sign > 0.0 && self.features.iter().all(is_of_core)
    }

    /// Cores that overlap at a point, with no known way out.
    pub(super) fn overlapping(self, at: Vec3) -> Self {
        Self { points: [at; 2], distance: 0.0, sign: 0.0, between: None, ..self }
    }

    /// True if two segments cross, and the distance is the way out of each other within their plane.
    pub fn is_way_out_in_plane(&self) -> bool {
        self.sign < 0.0
    }

    /// Segments that cross for a moment, on their way through each other: there is no way out within a plane that they
    /// leave.
    pub fn passing(self) -> Self {
        let at = self.points[0];
        Self { is_tied: true, ..found([Feature::Line; 2], [at; 2], 0.0) }
    }

    /// With the mark of a tie if the deepest point is inside another core, and could move deeper along this tangent of
    /// its own core: another feature of the other core is as near there.
    pub(super) fn tied_along(self, tangent: Vec3) -> Self {
        let [p, q] = self.points;
        let slope = (q - p).dot(tangent).abs();
        let is_tied = self.distance < 0.0 && slope > TIED * (q - p).norm() * tangent.norm();
        Self { is_tied, ..self }
    }

    /// The deepest point of a segment, at this place of it, by what is nearest to its places: where it could move
    /// deeper, it is between the features that are nearest on both sides. They are those next to it: a third one may be
    /// the nearest a little farther off.
    pub(super) fn between_features(self, along: Vec3, t: f64, from: impl Fn(f64) -> Self) -> Self {
        let slope = |near: &Self| near.gradient().dot(along);
        let is_deepest = |[before, after]: &[Self; 2]| slope(before) < 0.0 && slope(after) > 0.0;
        let mut beside = BESIDE.into_iter().map(|by| number::both([-by, by], |by| from(t + by)));
        let Some(around) = beside.find(is_deepest).filter(|_| self.distance < 0.0) else {
            return self.tied_along(along);
        };
        let [before, after] = around.map(|near| near.features[1]);
        Self { features: [Feature::Point(t), before], between: Some(after), ..self }
    }

    /// Gradient of the distance by the point from which it is measured; zero where both points are the same.
    pub(super) fn gradient(&self) -> Vec3 {
        let [p, q] = self.points;
        if self.distance == 0.0 { Vec3::ZERO } else { (p - q) * (1.0 / self.distance) }
    }

    pub(super) fn reversed(self) -> Self {
        let ([a, b], [p, q]) = (self.features, self.points);
        Self { features: [b, a], points: [q, p], ..self }
    }
}

/// A place nearer to an end of a segment than this fraction of it is the end: a search stops short of it by round-off.
const AT_END: f64 = 1e-10;
/// Distances of places from the deepest one, as fractions of a segment, at the least of which one feature alone is the
/// nearest: above the round-off of the place, which a search without a change of the slope finds less exactly.
const BESIDE: [f64; 3] = [1e-14, 1e-11, 1e-7];
/// Cosine between a core and the way out of another one above which the way out is not the shortest: searches find the
/// deepest point to the square root of the resolution of its depth.
const TIED: f64 = 1e-6;
/// Depths that differ by less than this fraction of the size are the same: round-off.
const SAME_DEPTH: f64 = 1e-11;
/// Distance of two lines below which they lie in one plane, as a fraction of their size: round-off.
const COPLANAR: f64 = 1e-11;

impl Core {
    /// Distance of a point; negative within a cylinder and behind a plane.
    pub fn distance_from(&self, p: Vec3) -> f64 {
        match self {
            Self::Point(_) | Self::Segment(_) | Self::Circle(_) | Self::HalfSpace { .. } => {
                from_point(p, self).distance
            }
            Self::Cylinder { middle, half_width } => around_drum(middle, *half_width).distance(p),
        }
    }
}

/// The nearest points of two cores.
pub(crate) fn nearest(a: &Core, b: &Core) -> Nearest {
    match (a, b) {
        (Core::HalfSpace { point, normal }, other) => above_plane(other, *point, *normal).reversed(),
        (other, Core::HalfSpace { point, normal }) => above_plane(other, *point, *normal),
        (Core::Point(p), other) => from_point(*p, other),
        (other, Core::Point(p)) => from_point(*p, other).reversed(),
        (Core::Segment(a), Core::Segment(b)) => segments(*a, *b),
        (Core::Segment(ends), Core::Circle(circle)) => segment_and_circle(*ends, circle),
        (Core::Circle(circle), Core::Segment(ends)) => segment_and_circle(*ends, circle).reversed(),
        (Core::Segment(ends), Core::Cylinder { middle, half_width }) => {
            segment_and_cylinder(*ends, &Drum { middle: *middle, half_width: *half_width })
        }
        (Core::Cylinder { middle, half_width }, Core::Segment(ends)) => {
            segment_and_cylinder(*ends, &Drum { middle: *middle, half_width: *half_width }).reversed()
        }
        (Core::Circle(circle), Core::Circle(other)) => {
            along_circle(circle, Feature::Circle(0.0), &AroundCircle(other), |p| from_point(p, b))
        }
        (Core::Circle(circle), Core::Cylinder { .. }) => {
            along_circle(circle, Feature::Circle(0.0), &AroundConvex(b), |p| from_point(p, b))
        }
        (Core::Cylinder { .. }, Core::Circle(circle)) => {
            along_circle(circle, Feature::Circle(0.0), &AroundConvex(a), |p| from_point(p, a)).reversed()
        }
        (Core::Cylinder { middle: p, half_width: w }, Core::Cylinder { middle: q, half_width: v }) => {
            cylinders([&Drum { middle: *p, half_width: *w }, &Drum { middle: *q, half_width: *v }])
        }
    }
}

pub(super) fn found(features: [Feature; 2], points: [Vec3; 2], distance: f64) -> Nearest {
    Nearest { features, points, distance, sign: 1.0, is_parallel: false, is_tied: false, between: None }
}

/// The point of a core that is nearest to a plane: the one that is farthest against its normal.
fn above_plane(core: &Core, point: Vec3, normal: Vec3) -> Nearest {
    let height = |p: Vec3| normal.dot(p - point);
    let face = Feature::Face(1.0);
    let at = |feature, p: Vec3| found([feature, face], [p, p - normal * height(p)], height(p));
    match core {
        Core::Point(p) => at(Feature::Point(0.0), *p),
        Core::Segment([a, b]) => {
            let (lower, upper) = (height(*a), height(*b));
            let is_parallel = (upper - lower).abs() <= PARALLEL * (*b - *a).norm();
            let near = if is_parallel {
                at(Feature::Point(0.5), (*a + *b) * 0.5)
            } else if lower < upper {
                at(Feature::Point(0.0), *a)
            } else {
                at(Feature::Point(1.0), *b)
            };
            Nearest { is_parallel, ..near }
        }
        Core::Circle(circle) => {
            lowest_of_circle(circle, normal, Feature::Circle(0.0), Feature::Point(0.0), at)
        }
        Core::Cylinder { middle, half_width } => {
            let side = if normal.dot(middle.axis) > 0.0 { -1.0 } else { 1.0 };
            let rim = middle.moved(half_width * side);
            lowest_of_circle(&rim, normal, Feature::Circle(side), Feature::Point(side), at)
        }
        Core::HalfSpace { .. } => {
            Nearest { is_parallel: true, ..found([face, face], [point, point], f64::NAN) }
        }
    }
}

/// The same for a circle; where all of it is at one height, its centre instead.
fn lowest_of_circle(
    circle: &Circle,
    normal: Vec3,
    itself: Feature,
    centre: Feature,
    at: impl Fn(Feature, Vec3) -> Nearest,
) -> Nearest {
    // The part of the normal in the circle's plane.
    let down = circle.axis * normal.dot(circle.axis) - normal;
    let slope = down.norm();
    if slope <= PARALLEL {
        return Nearest { is_parallel: true, ..at(centre, circle.centre) };
    }
    at(itself, circle.centre + down * (circle.radius / slope))
}

/// The nearest point of a core to a point.
pub(super) fn from_point(p: Vec3, core: &Core) -> Nearest {
    let own = Feature::Point(0.0);
    match core {
        Core::Point(q) => found([own, own], [p, *q], (*q - p).norm()),
        Core::Segment([a, b]) => {
            let e = *b - *a;
            let t = (e.dot(p - *a) / e.dot(e)).clamp(0.0, 1.0);
            let q = *a + e * t;
            let feature = if t > 0.0 && t < 1.0 { Feature::Line } else { Feature::Point(t) };
            found([own, feature], [p, q], (q - p).norm())
        }
        Core::Circle(circle) => {
            let q = of_circle(circle, p);
            found([own, Feature::Circle(0.0)], [p, q], (q - p).norm())
        }
        Core::Cylinder { middle, half_width } => {
            from_drum(p, &Drum { middle: *middle, half_width: *half_width })
        }
        Core::HalfSpace { point, normal } => {
            let height = normal.dot(p - *point);
            found([own, Feature::Face(1.0)], [p, p - *normal * height], height)
        }
    }
}

fn from_drum(p: Vec3, drum: &Drum) -> Nearest {
    let (feature, q, distance) = drum.nearest(p);
    found([Feature::Point(0.0), feature], [p, q], distance)
}

/// The point of a circle that is nearest to a point; any of them for a point of the axis.
fn of_circle(circle: &Circle, p: Vec3) -> Vec3 {
    let v = p - circle.centre;
    let out = v - circle.axis * circle.axis.dot(v);
    let rho = out.norm();
    let out = if rho > 0.0 { out * (1.0 / rho) } else { circle.axis.any_perpendicular() };
    circle.centre + out * circle.radius
}

/// The nearest points of two segments.
fn segments([a, b]: [Vec3; 2], [c, d]: [Vec3; 2]) -> Nearest {
    let (e, f, from) = (b - a, d - c, c - a);
    let (ee, ff) = (e.dot(e), f.dot(f));
    let across = e.cross(f);
    let det = across.dot(across);
    if det > PARALLEL * PARALLEL * ee * ff {
        // Along e and along f, from the ends of the common perpendicular of the lines.
        let s = from.cross(f).dot(across) / det;
        let t = from.cross(e).dot(across) / det;
        if 0.0 < s && s < 1.0 && 0.0 < t && t < 1.0 {
            let points = [a + e * s, c + f * t];
            let apart = (points[1] - points[0]).norm();
            if apart <= COPLANAR * (e.norm() + f.norm()) {
                return crossing([a, b], [c, d], points);
            }
            return found([Feature::Line; 2], points, apart);
        }
    } else if let Some(near) = parallel_segments([a, b], [c, d]) {
        return near;
    }
    let own = |t: f64, near: Nearest| Nearest { features: [Feature::Point(t), near.features[1]], ..near };
    let (first, second) = (Core::Segment([a, b]), Core::Segment([c, d]));
    let ends = [
        own(0.0, from_point(a, &second)),
        own(1.0, from_point(b, &second)),
        own(0.0, from_point(c, &first)).reversed(),
        own(1.0, from_point(d, &first)).reversed(),
    ];
    nearer(ends)
}

/// The nearest points of two segments of which one is an edge of a surface: where they cross in a plane, the way out
/// within that plane is no depth of the surface.
pub(super) fn segment_and_edge(segment: [Vec3; 2], edge: [Vec3; 2]) -> Nearest {
    let near = segments(segment, edge);
    if near.is_way_out_in_plane() {
        let [p, q] = near.points;
        return found([Feature::Line; 2], near.points, (q - p).norm());
    }
    near
}

/// The nearest of several.
pub(super) fn nearer<const N: usize>(all: [Nearest; N]) -> Nearest {
    all.into_iter().reduce(|a, b| if b.distance < a.distance { b } else { a }).expect("there is one")
}

/// Segments in one plane that cross there: how far they must be moved within the plane until an end of one is on the
/// line of the other.
fn crossing([a, b]: [Vec3; 2], [c, d]: [Vec3; 2], points: [Vec3; 2]) -> Nearest {
    let (e, f) = (b - a, d - c);
    let from_first = |p: Vec3| (p - a).cross(e).norm() / e.norm();
    let from_second = |p: Vec3| (p - c).cross(f).norm() / f.norm();
    let ends = [
        ([Feature::Point(0.0), Feature::Line], from_second(a)),
        ([Feature::Point(1.0), Feature::Line], from_second(b)),
        ([Feature::Line, Feature::Point(0.0)], from_first(c)),
        ([Feature::Line, Feature::Point(1.0)], from_first(d)),
    ];
    let (features, depth) = ends.into_iter().reduce(|a, b| if b.1 < a.1 { b } else { a }).expect("four ends");
    let within = depth + SAME_DEPTH * (e.norm() + f.norm());
    let is_tied = ends.iter().filter(|(_, other)| *other <= within).count() > 1;
    Nearest { sign: -1.0, is_tied, ..found(features, points, -depth) }
}

/// Parallel segments that are beside each other: the middle of what they have in common.
fn parallel_segments([a, b]: [Vec3; 2], [c, d]: [Vec3; 2]) -> Option<Nearest> {
    let e = b - a;
    let along = |p: Vec3| e.dot(p - a) / e.dot(e);
    let (from, to) = (along(c).min(along(d)).max(0.0), along(c).max(along(d)).min(1.0));
    if from >= to {
        return None;
    }
    let middle = 0.5 * (from + to);
    let p = a + e * middle;
    let near = from_point(p, &Core::Segment([c, d]));
    Some(Nearest { features: [Feature::Point(middle), near.features[1]], is_parallel: true, ..near })
}

/// The nearest points of a segment and a circle.
pub(super) fn segment_and_circle([a, b]: [Vec3; 2], circle: &Circle) -> Nearest {
    let at = |t: f64| a + (b - a) * t;
    let t = least_of_segment([a, b], circle);
    let feature = if t > 0.0 && t < 1.0 { Feature::Line } else { Feature::Point(t) };
    let points = [at(t), of_circle(circle, at(t))];
    found([feature, Feature::Circle(0.0)], points, (points[1] - points[0]).norm())
}

/// A solid cylinder, halfway between whose caps is this circle.
pub(super) fn around_drum(middle: &Circle, half_width: f64) -> Drum {
    Drum { middle: *middle, half_width }
}

/// A solid cylinder.
pub(super) struct Drum {
    middle: Circle,
    half_width: f64,
}

impl Drum {
    /// Height above the plane halfway between the caps, and distance from the axis.
    fn cylindrical(&self, p: Vec3) -> (f64, f64, Vec3) {
        let v = p - self.middle.centre;
        let z = self.middle.axis.dot(v);
        let out = v - self.middle.axis * z;
        (z, out.norm(), out)
    }

    /// Ends of the axis, on the caps.
    pub fn axis(&self) -> [Vec3; 2] {
        number::both([-1.0, 1.0], |side| self.middle.moved(self.half_width * side).centre)
    }

    /// Distance of a point, negative inside: a convex function of the point.
    pub fn distance(&self, p: Vec3) -> f64 {
        let (z, rho, _) = self.cylindrical(p);
        Self::apart(z.abs() - self.half_width, rho - self.middle.radius)
    }

    /// Distance of a point at these distances outside the cap and outside the side.
    fn apart(above: f64, beyond: f64) -> f64 {
        if above > 0.0 && beyond > 0.0 { above.hypot(beyond) } else { above.max(beyond) }
    }

    /// Rate of the distance of a point that moves along e.
    fn slope(&self, p: Vec3, e: Vec3) -> f64 {
        let (z, rho, out) = self.cylindrical(p);
        let (above, beyond) = (z.abs() - self.half_width, rho - self.middle.radius);
        let along = self.middle.axis.dot(e);
        let rises = if z < 0.0 { -along } else { along };
        // On the axis all ways lead away from it.
        let recedes = if rho > 0.0 { out.dot(e) / rho } else { (e - self.middle.axis * along).norm() };
        if above > 0.0 && beyond > 0.0 {
            (above * rises + beyond * recedes) / above.hypot(beyond)
        } else if above >= beyond {
            rises
        } else {
            recedes
        }
    }

    /// True if a direction is parallel to the caps or to the axis, or nearly so.
    fn is_level(&self, e: Vec3) -> bool {
        let (along, square) = (self.middle.axis.dot(e), e.dot(e));
        along * along <= PARALLEL * PARALLEL * square || along * along >= (1.0 - PARALLEL) * square
    }

    /// Middle of the part of a segment, from 0 to 1, all of whose points are nearest to the side, as that at t is, or
    /// deepest within it; `None` if the segment is not parallel to the axis.
    fn middle_beside(&self, [a, b]: [Vec3; 2], t: f64) -> Option<f64> {
        let e = b - a;
        let across = self.middle.axis.cross(e);
        if across.dot(across) > PARALLEL * PARALLEL * e.dot(e) {
            return None;
        }
        let (height, rho, _) = self.cylindrical(a);
        // Within the cylinder, a point near a cap is less deep.
        let reach = self.half_width + (rho - self.middle.radius).min(0.0);
        let [u, v] = number::both([-reach, reach], |z| (z - height) / self.middle.axis.dot(e));
        let (from, to) = (u.min(v).max(0.0), u.max(v).min(1.0));
        Some(if reach > 0.0 && from < to { 0.5 * (from + to) } else { t })
    }

    /// The feature that a point is nearest to, the nearest point there, and the distance.
    fn nearest(&self, p: Vec3) -> (Feature, Vec3, f64) {
        let (z, rho, out) = self.cylindrical(p);
        let Self { middle, half_width } = self;
        let side = if z < 0.0 { -1.0 } else { 1.0 };
        let (above, beyond) = (z.abs() - half_width, rho - middle.radius);
        let out = if rho > 0.0 { out * (1.0 / rho) } else { middle.axis.any_perpendicular() };
        let (feature, q) = if above > 0.0 && beyond > 0.0 {
            (Feature::Circle(side), middle.moved(half_width * side).centre + out * middle.radius)
        } else if above >= beyond {
            (Feature::Face(side), p - middle.axis * (side * above))
        } else {
            (Feature::Line, p - out * beyond)
        };
        (feature, q, Self::apart(above, beyond))
    }
}

/// The nearest points of a segment and a solid cylinder; of overlapping ones, the deepest point of the segment.
pub(super) fn segment_and_cylinder([a, b]: [Vec3; 2], drum: &Drum) -> Nearest {
    let at = |t: f64| a + (b - a) * t;
    let depth = |t: f64| drum.distance(at(t));
    let mut t = least_of_convex(|t| drum.slope(at(t), b - a), [0.0, 1.0]);
    let is_end = |end: f64, best: f64| depth(end) <= depth(best) || (end - best).abs() < AT_END;
    t = [0.0, 1.0].into_iter().fold(t, |best, end| if is_end(end, best) { end } else { best });
    // Over a cap, and along a side, all points of a parallel segment are nearest: the middle of them.
    let mut is_parallel = [0.0, 0.25, 0.75, 1.0]
        .into_iter()
        .all(|t| (depth(t) - depth(0.5)).abs() <= PARALLEL * (b - a).norm());
    if is_parallel {
        t = 0.5;
    }
    let mut near = drum.nearest(at(t));
    let mut is_inside = t > 0.0 && t < 1.0 && !is_parallel;
    // The segment goes on beyond a cap, or beyond the rim of a cap that it is parallel to.
    let beyond_cap = (is_inside && near.0 == Feature::Line).then(|| drum.middle_beside([a, b], t)).flatten();
    let middle = beyond_cap.or_else(|| {
        let is_level = !is_parallel && drum.is_level(b - a);
        is_level.then(|| middle_of_level(|t| drum.slope(at(t), b - a), (b - a).norm(), t)).flatten()
    });
    if let Some(middle) = middle {
        t = middle;
        near = drum.nearest(at(t));
        (is_parallel, is_inside) = (true, false);
    }
    let (feature, q, distance) = near;
    // Over a cap, beside a parallel side, and at the edge between both within the cylinder, the point stays where it
    // is.
    let slides = is_inside
        && match feature {
            Feature::Line => is_stationary([a, b], drum, t),
            Feature::Circle(_) => true,
            Feature::Face(_)
            | Feature::Point(_)
            | Feature::Vertex(_)
            | Feature::Edge(_)
            | Feature::EdgePoint(..)
            | Feature::Facet(_) => false,
        };
    let own = if slides { Feature::Line } else { Feature::Point(t) };
    let near = Nearest { is_parallel, ..found([own, feature], [at(t), q], distance) };
    if !is_inside || slides {
        return near;
    }
    near.between_features(b - a, t, |t| from_drum(at(t), drum))
}

/// True if the distance from the axis has its minimum at a place along a segment.
fn is_stationary([a, b]: [Vec3; 2], drum: &Drum, t: f64) -> bool {
    let e = b - a;
    let (_, rho, out) = drum.cylindrical(a + e * t);
    // Golden section finds the place of a minimum to the square root of the resolution of its values.
    out.dot(e).abs() <= f64::EPSILON.sqrt() * 10.0 * rho.max(e.norm()) * e.norm()
}

/// A convex solid around a path.
struct AroundConvex<'a>(&'a Core);

impl Surroundings for AroundConvex<'_> {
    const IS_PLAIN: bool = true;

    fn distance(&self, p: Vec3) -> (f64, Vec3) {
        let near = from_point(p, self.0);
        (near.distance, near.gradient())
    }

    /// The tangent plane of a convex function is below it.
    fn bounded(&self, part: &Part) -> [f64; 2] {
        let (distance, slope) = self.distance(part.middle);
        [distance, distance + part.lowest_along(slope)]
    }
}

/// A circle around a path.
struct AroundCircle<'a>(&'a Circle);

impl Surroundings for AroundCircle<'_> {
    const IS_PLAIN: bool = true;

    fn distance(&self, p: Vec3) -> (f64, Vec3) {
        let q = of_circle(self.0, p);
        let near = found([Feature::Point(0.0), Feature::Circle(0.0)], [p, q], (q - p).norm());
        (near.distance, near.gradient())
    }

    /// With rho the distance from the axis, the squared distance is `v . v + R R - 2 R rho`. Along a circle `v . v` is
    /// that of a linear function, which is less by the square of the tangents where these meet; -rho is concave, so
    /// that a corner is the lowest.
    fn bounded(&self, part: &Part) -> [f64; 2] {
        let square = |p: Vec3| {
            let v = p - self.0.centre;
            let (z, rho) = (self.0.axis.dot(v), self.0.axis.cross(v).norm());
            z * z + (rho - self.0.radius) * (rho - self.0.radius)
        };
        let [from, corner, to] = part.hull.map(square);
        let corner = corner - part.out.dot(part.out) * part.tan * part.tan;
        [square(part.middle).sqrt(), from.min(to).min(corner).max(0.0).sqrt()]
    }
}

/// The nearest points of a circle, which is this feature of its shape, and something around it, of which `from` is the
/// nearest point to a given one.
pub(super) fn along_circle(
    circle: &Circle,
    itself: Feature,
    around: &impl Surroundings,
    from: impl Fn(Vec3) -> Nearest,
) -> Nearest {
    let path = Path::around(circle);
    let turn = least_along(&path, around);
    let near = from(path.at(turn)).tied_along(path.tangent(turn));
    // Parallel circles and faces: all points of the circle are nearest.
    let apart = |turn: f64| from(path.at(turn)).distance;
    let is_level = |k: u8| (apart(f64::from(k) * 0.25) - near.distance).abs() <= PARALLEL * circle.radius;
    let is_parallel = (0..4).all(is_level);
    let is_tied = near.is_tied && !is_parallel;
    Nearest { features: [itself, near.features[1]], is_parallel, is_tied, ..near }
}

/// The nearest points of two solid cylinders: of a rim of one and the other, or of both sides.
fn cylinders(drums: [&Drum; 2]) -> Nearest {
    let rims = |of: usize| {
        let other = drums[1 - of];
        let core = Core::Cylinder { middle: other.middle, half_width: other.half_width };
        number::both([-1.0, 1.0], |side| {
            let rim = drums[of].middle.moved(drums[of].half_width * side);
            along_circle(&rim, Feature::Circle(side), &AroundConvex(&core), |p| from_point(p, &core))
        })
    };
    let ([a, b], [c, d]) = (rims(0), rims(1));
    let near = nearer([a, b, c.reversed(), d.reversed()]);
    let sides = segments(drums[0].axis(), drums[1].axis());
    let apart = sides.distance - drums[0].middle.radius - drums[1].middle.radius;
    // The sides are nearest where the common perpendicular of the axes meets both within their widths.
    if sides.features == [Feature::Line; 2]
        && !sides.is_parallel
        && sides.distance > 0.0
        && apart < near.distance
    {
        let n = (sides.points[1] - sides.points[0]) * (1.0 / sides.distance);
        let [p, q] = sides.points;
        let points = [p + n * drums[0].middle.radius, q - n * drums[1].middle.radius];
        return found([Feature::Line; 2], points, apart);
    }
    // A disc whose rims are all around the other cylinder is pierced by its axis, which then is within its radius.
    let is_near = |k: &usize| near.distance > 0.0 && sides.distance <= drums[1 - k].middle.radius;
    let of_axis = |k: usize| segment_and_cylinder(drums[k].axis(), drums[1 - k]);
    let mut pierced = [0, 1].into_iter().filter(is_near).map(of_axis).filter(|axis| axis.distance <= 0.0);
    pierced.next().map_or(near, |axis| near.overlapping(axis.points[0]))
}

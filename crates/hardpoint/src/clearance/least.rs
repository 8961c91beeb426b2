//! The global minimum of a distance along a segment or a circle.
//!
//! Samples alone overlook what is narrower than their spacing. A part of the path is left out only if a lower bound of
//! the distance over it is not below the best place so far; all others are halved. The bounds use that a part lies in a
//! triangle: between its ends and the point at which the tangents there meet.

use std::f64::consts::TAU;

use crate::number;
use crate::space::Vec3;

use super::circle::Circle;
use super::feature::PARALLEL;

/// Parts into which a path is divided first.
const PARTS: usize = 16;
/// Places at which a distance is evaluated at most: many are needed where it is nearly constant along the path, and
/// then no minimum is narrow.
const MOST_PLACES: usize = 800;
/// Difference of distances, as a fraction of their size, that is not resolved: some times the round-off.
const RESOLUTION: f64 = 1e-13;
/// Length, as a fraction of a segment, of the shortest stretch over which a distance is level: that of a far point is
/// level about its minimum.
pub(super) const SHORTEST_LEVEL: f64 = 1e-4;
/// Halvings of an interval until it is below the resolution of its ends.
const HALVINGS: usize = 60;
/// Halves of a part around its middle within which the minimum is: parts next to it are left out by bounds which are
/// less accurate than the values.
const AROUND: f64 = 4.0;

/// A path along which a distance is minimised; its parameter runs from 0 to 1.
#[derive(Clone, Copy)]
pub(super) enum Path {
    /// Between two ends.
    Segment([Vec3; 2]),
    /// Around a circle, from `x` towards `y`, vectors to its points.
    Circle { circle: Circle, x: Vec3, y: Vec3 },
}

impl Path {
    /// Around a circle.
    pub fn around(circle: &Circle) -> Self {
        let x = circle.axis.any_perpendicular();
        let y = circle.axis.cross(x);
        Self::Circle { circle: *circle, x: x * circle.radius, y: y * circle.radius }
    }

    /// Point at a parameter.
    pub fn at(&self, t: f64) -> Vec3 {
        match self {
            Self::Segment([a, b]) => *a + (*b - *a) * t,
            Self::Circle { circle, x, y } => {
                let (sin, cos) = (t * TAU).sin_cos();
                circle.centre + *x * cos + *y * sin
            }
        }
    }

    /// Derivative of the point by the parameter.
    pub fn tangent(&self, t: f64) -> Vec3 {
        match self {
            Self::Segment([a, b]) => *b - *a,
            Self::Circle { x, y, .. } => {
                let (sin, cos) = (t * TAU).sin_cos();
                (*y * cos - *x * sin) * TAU
            }
        }
    }

    fn length(&self) -> f64 {
        match self {
            Self::Segment([a, b]) => (*b - *a).norm(),
            Self::Circle { circle, .. } => circle.radius * TAU,
        }
    }

    /// Size of the coordinates of its points.
    fn size(&self) -> f64 {
        match self {
            Self::Segment([a, b]) => a.norm() + b.norm(),
            Self::Circle { circle, .. } => circle.centre.norm() + circle.radius,
        }
    }

    /// The part within `half` of a parameter, less than a quarter of a circle; with sine and cosine of that angle.
    fn part(&self, middle: f64, half: f64, (sin, cos): (f64, f64)) -> Part {
        let length = half * self.length();
        let at = self.at(middle);
        match self {
            Self::Segment([a, b]) => {
                let along = (*b - *a) * half;
                let hull = [at - along, at, at + along];
                Part { middle: at, hull, out: Vec3::ZERO, along: Vec3::ZERO, tan: 0.0, length }
            }
            Self::Circle { circle, .. } => {
                let out = at - circle.centre;
                let along = circle.axis.cross(out);
                let inner = circle.centre + out * cos;
                let corner = circle.centre + out * (1.0 / cos);
                let hull = [inner - along * sin, corner, inner + along * sin];
                Part { middle: at, hull, out, along, tan: sin / cos, length }
            }
        }
    }
}

/// Part of a path.
pub(super) struct Part {
    pub middle: Vec3,
    /// Both ends, and between them the point where the tangents there meet: corners of a triangle that it lies in.
    pub hull: [Vec3; 3],
    /// From the centre of a circle to its middle, and the same vector a quarter turn on; otherwise zero.
    pub out: Vec3,
    along: Vec3,
    /// Length of both tangents as a fraction of the radius.
    pub tan: f64,
    /// Length from its middle to its ends.
    pub length: f64,
}

impl Part {
    /// Least value of a function at the corners of its triangle: of one that is concave there, over all of the part.
    pub fn lowest_corner(&self, of: impl Fn(Vec3) -> f64) -> f64 {
        self.hull.iter().map(|p| of(*p)).fold(f64::INFINITY, f64::min)
    }

    /// The least of `n . (p - m)` over its points p, with m its middle.
    pub fn lowest_along(&self, n: Vec3) -> f64 {
        // `a (cos(angle) - 1) + b sin(angle)`, lowest at `tan(angle) = b / a`, or at an end.
        let (a, b) = (n.dot(self.out), n.dot(self.along));
        if a < 0.0 && b.abs() <= -a * self.tan {
            return -b * b / (a.hypot(b) - a);
        }
        let [from, _, to] = self.hull;
        n.dot(from - self.middle).min(n.dot(to - self.middle))
    }
}

/// Something around a path, from which distances are measured: negative ones inside.
pub(super) trait Surroundings {
    /// True if a distance that is the same at the first places is constant: it has few minima.
    const IS_PLAIN: bool;

    /// Distance of a point, and its gradient; zero where that is not known.
    fn distance(&self, p: Vec3) -> (f64, Vec3);

    /// Distance of the middle of a part, and a lower bound over the part.
    fn bounded(&self, part: &Part) -> [f64; 2];
}

/// A part that may hold the minimum.
struct Open {
    middle: f64,
    value: f64,
    bound: f64,
}

/// Parameter of a path at which it is nearest to something, or deepest in it.
pub(super) fn least_along<S: Surroundings>(path: &Path, around: &S) -> f64 {
    let open_at = |middle: f64, half: f64, turn: (f64, f64)| {
        let part = path.part(middle, half, turn);
        let [value, bound] = around.bounded(&part);
        // No distance changes by more than its point moves.
        Open { middle, value, bound: bound.max(value - part.length) }
    };
    let mut half = 0.5 / PARTS as f64;
    let turn = |half: f64| (half * TAU).sin_cos();
    let first = turn(half);
    let mut open: Vec<Open> = (0..PARTS).map(|k| open_at((2 * k + 1) as f64 * half, half, first)).collect();
    let lowest = |best: [f64; 2], open: &[Open]| {
        open.iter().fold(best, |best, o| if o.value < best[0] { [o.value, o.middle] } else { best })
    };
    let mut best = lowest([open[0].value, open[0].middle], &open);
    let (size, mut places) = (path.size(), PARTS);
    let within = |best: f64| RESOLUTION * (size + best.abs());
    if S::IS_PLAIN && open.iter().all(|o| o.value <= best[0] + within(best[0])) {
        return best[1];
    }
    while places < MOST_PLACES {
        open.retain(|o| o.bound < best[0] - within(best[0]));
        if open.is_empty() {
            break;
        }
        half *= 0.5;
        places += 2 * open.len();
        let turn = turn(half);
        let halves = |o: &Open| number::both([-half, half], |by| open_at(o.middle + by, half, turn));
        open = open.iter().flat_map(halves).collect();
        best = lowest(best, &open);
    }
    // The values are those of a minimum to their resolution; the place is, where the slope changes its sign.
    let slope = |t: f64| around.distance(path.at(t)).1.dot(path.tangent(t));
    let value = |t: f64| around.distance(path.at(t)).0;
    let beside = number::both([-AROUND, AROUND], |by| best[1] + by * half);
    let t = match path {
        Path::Segment(_) => least_of_convex(slope, number::both(beside, |t| t.clamp(0.0, 1.0))),
        Path::Circle { .. } => least_of_convex(slope, beside),
    };
    if value(t) <= best[0] + within(best[0]) { t } else { best[1] }
}

/// The place in an interval of the least of a convex function, whose slope never decreases.
///
/// The zero of the slope by the Illinois method; every third step halves the interval, since the slope may jump.
pub(super) fn least_of_convex(slope: impl Fn(f64) -> f64, [from, to]: [f64; 2]) -> f64 {
    let (mut low, mut high) = ((from, slope(from)), (to, slope(to)));
    if !(low.1 < 0.0) {
        return from;
    }
    if !(high.1 > 0.0) {
        return to;
    }
    // True if the lower end was moved last.
    let mut raised = None;
    for k in 0..HALVINGS {
        let width: f64 = high.0 - low.0;
        let resolution = 2.0 * f64::EPSILON * high.0.abs().max(low.0.abs());
        if width <= resolution {
            break;
        }
        let halves = k % 3 == 2;
        let part = if halves { 0.5 } else { low.1 / (low.1 - high.1) };
        let t = low.0 + part * width;
        let at = slope(t);
        // The end from which nothing is left to go is the zero, however far the other one is.
        let is_at_end = !halves && width * part.min(1.0 - part) <= resolution;
        if at == 0.0 || is_at_end {
            return t;
        }
        // An end that stays twice counts half.
        if at < 0.0 {
            low = (t, at);
            high.1 *= if raised == Some(true) { 0.5 } else { 1.0 };
        } else {
            high = (t, at);
            low.1 *= if raised == Some(false) { 0.5 } else { 1.0 };
        }
        raised = Some(at < 0.0);
    }
    0.5 * (low.0 + high.0)
}

/// Middle of the stretch around a place of a segment of this length over which a distance does not change, as along a
/// face that is parallel to it; `None` if there is none. `slope` is that of the distance, by the parameter.
pub(super) fn middle_of_level(slope: impl Fn(f64) -> f64, length: f64, t: f64) -> Option<f64> {
    let is_level = |t: f64| slope(t).abs() <= PARALLEL * length;
    // The place may be an end of the stretch.
    let beside = number::both([-0.5, 0.5], |by| (t + by * SHORTEST_LEVEL).clamp(0.0, 1.0));
    let inner = beside.into_iter().find(|t| is_level(*t))?;
    let reach = |end: f64| {
        if is_level(end) {
            return end;
        }
        let (mut inside, mut outside) = (inner, end);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            *(if is_level(middle) { &mut inside } else { &mut outside }) = middle;
        }
        inside
    };
    let (from, to) = (reach(0.0), reach(1.0));
    let middle = 0.5 * (from + to);
    // Of a surface with hollows, places between two stretches may be farther.
    (to - from > SHORTEST_LEVEL && is_level(middle)).then_some(middle)
}

/// Part of a segment, from 0 to 1, at which it is nearest to a circle.
///
/// With `v = p - c`, z its part along the circle's axis and rho the rest, the squared distance along the line is
///
/// ```text
/// f  =  v.v + R R - 2 R rho,    rho^2 = rho1^2 + k (t - t1)^2,    f..  =  2 e.e - 2 R rho1^2 k / rho^3
/// ```
///
/// so that f is convex on both sides of an interval around t1, and concave within it: one minimum per side.
pub(super) fn least_of_segment([a, b]: [Vec3; 2], circle: &Circle) -> f64 {
    let (e, v) = (b - a, a - circle.centre);
    let (along, height) = (circle.axis.dot(e), circle.axis.dot(v));
    let (across, out) = (e - circle.axis * along, v - circle.axis * height);
    let k = across.dot(across);
    // Half of f., per side of t1: where the line meets the axis the rate of rho has the sign of that side.
    let t1 = -out.dot(across) / k;
    let slope = |t: f64, side: f64| {
        let rho = (out + across * t).norm();
        let recedes = if rho > 0.0 { k * (t - t1) / rho } else { k.sqrt() * side };
        (height + along * t) * along + (rho - circle.radius) * recedes
    };
    let distance = |t: f64| {
        let rho = (out + across * t).norm();
        (height + along * t).hypot(rho - circle.radius)
    };
    if !t1.is_finite() {
        // Parallel to the axis.
        return (-height / along).clamp(0.0, 1.0);
    }
    let nearest = (out + across * t1).norm();
    let square = nearest * nearest;
    let edge = (circle.radius * square * k / e.dot(e)).cbrt().powi(2);
    // Half of the concave interval.
    let (w, is_convex) = (((edge - square).max(0.0) / k).sqrt(), edge < square);
    let sides: &[[f64; 3]] = if is_convex {
        &[[f64::NEG_INFINITY, f64::INFINITY, 1.0]]
    } else {
        &[[f64::NEG_INFINITY, t1 - w, -1.0], [t1 + w, f64::INFINITY, 1.0]]
    };
    let places = sides.iter().map(|[from, to, side]| {
        let t = least_of_convex(|t| slope(t, *side), number::both([from, to], |t| t.clamp(0.0, 1.0)));
        [t, distance(t)]
    });
    places.reduce(|a, b| if b[1] < a[1] { b } else { a }).map_or(0.0, |[t, _]| t)
}

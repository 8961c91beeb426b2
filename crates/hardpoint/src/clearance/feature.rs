//! Distances between features of cores, over any number type.
//!
//! With `z = e . v`, `rho = sqrt(v . v - z z)`, `v = p - c`:
//!
//! | features | distance |
//! |---|---|
//! | point p, point q | `abs(q - p)` |
//! | point p, line of e from a | `abs((p - a) x e) / abs(e)` |
//! | lines of e from a, of f from c | `abs((c - a) . (e x f)) / abs(e x f)` |
//! | point p, face through a with normal n | `n . (p - a)`, negative behind it |
//! | point p, circle of radius R about c | `sqrt(z z + (rho - R)^2)` |
//! | circle of axis e about c, face | `n . (c - a) - R sqrt(1 - (n . e)^2)` |
//! | line or circle, circle | least over both parameters, by Newton's method |

use crate::number;
use crate::space::{Real, Vec3};

use super::circle::Circle;

/// Part of a core that holds one of the two nearest points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Feature {
    /// A point: of a segment at this fraction of it, of a cylinder's axis at this part of its half width, the centre of
    /// a circle.
    Point(f64),
    /// The line of a segment, or the side of a cylinder by its axis.
    Line,
    /// A circle, or the rim of the cap of a cylinder on this side: -1 or 1.
    Circle(f64),
    /// The cap of a cylinder on this side, or the plane of a half-space.
    Face(f64),
    /// A corner of a surface.
    Vertex(u32),
    /// The line of an edge of a surface, between two corners.
    Edge([u32; 2]),
    /// The point at this fraction of an edge of a surface, between two corners: one of many that are equally near.
    EdgePoint([u32; 2], f64),
    /// The plane of a facet of a surface.
    Facet([u32; 3]),
}

/// A feature in global coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Placed<T> {
    Point(Vec3<T>),
    Line { from: Vec3<T>, along: Vec3<T> },
    Circle(Circle<T>),
    Face { point: Vec3<T>, normal: Vec3<T> },
}

impl<T: Real> Placed<T> {
    /// The plain numbers.
    pub fn value(&self) -> Placed<f64> {
        match self {
            Self::Point(p) => Placed::Point(p.value()),
            Self::Line { from, along } => Placed::Line { from: from.value(), along: along.value() },
            Self::Circle(circle) => Placed::Circle(circle.value()),
            Self::Face { point, normal } => Placed::Face { point: point.value(), normal: normal.value() },
        }
    }
}

/// Distance between two features; the nearest points are near `near`, which parameters are counted from.
///
/// Two faces have none: their cores are half-spaces.
pub(super) fn distance<T: Real>(a: &Placed<T>, b: &Placed<T>, near: [Vec3; 2]) -> T {
    match (a, b) {
        (Placed::Point(p), Placed::Point(q)) => (*q - *p).norm(),
        (Placed::Point(p), Placed::Line { from, along })
        | (Placed::Line { from, along }, Placed::Point(p)) => {
            (*p - *from).cross(*along).norm() / along.norm()
        }
        (Placed::Line { from: a, along: e }, Placed::Line { from: c, along: f }) => {
            let across = e.cross(*f);
            (*c - *a).dot(across).abs() / across.norm()
        }
        (Placed::Point(p), Placed::Face { point, normal })
        | (Placed::Face { point, normal }, Placed::Point(p)) => normal.dot(*p - *point),
        (Placed::Point(p), Placed::Circle(circle)) | (Placed::Circle(circle), Placed::Point(p)) => {
            let v = *p - circle.centre;
            let (z, rho) = (circle.axis.dot(v), circle.axis.cross(v).norm());
            (z * z + (rho - circle.radius) * (rho - circle.radius)).sqrt()
        }
        (Placed::Circle(circle), Placed::Face { point, normal })
        | (Placed::Face { point, normal }, Placed::Circle(circle)) => {
            normal.dot(circle.centre - *point) - circle.radius * normal.cross(circle.axis).norm()
        }
        (Placed::Line { .. } | Placed::Circle(_), Placed::Line { .. } | Placed::Circle(_)) => {
            let [p, q] = stationary(&Curve::of(a, near[0]), &Curve::of(b, near[1]));
            (q - p).norm()
        }
        // The place on the line is one of many that are equally near, and stays.
        (line @ Placed::Line { .. }, Placed::Face { point, normal }) => {
            normal.dot(Curve::of(line, near[0]).at(T::zero())[0] - *point)
        }
        (Placed::Face { point, normal }, line @ Placed::Line { .. }) => {
            normal.dot(Curve::of(line, near[1]).at(T::zero())[0] - *point)
        }
        (Placed::Face { .. }, Placed::Face { .. }) => T::constant(f64::NAN),
    }
}

/// The nearest points of two features, and the unit vector n by which their distance changes with the points, as in
/// `n . (Q' - P')`; `None` for two faces.
pub(super) fn nearest_points<T: Real>(
    [a, b]: [&Placed<T>; 2],
    near: [Vec3; 2],
) -> Option<([Vec3<T>; 2], Vec3<T>)> {
    let unit = |v: Vec3<T>| v * (T::one() / v.norm());
    let along_points = |p: Vec3<T>, q: Vec3<T>| Some(([p, q], unit(q - p)));
    match (a, b) {
        (Placed::Point(p), Placed::Point(q)) => along_points(*p, *q),
        (Placed::Point(p), Placed::Line { from, along }) => along_points(*p, foot(*p, *from, *along)),
        (Placed::Point(p), Placed::Circle(circle)) => along_points(*p, beside(*p, circle)),
        (Placed::Line { from: a, along: e }, Placed::Line { from: c, along: f }) => {
            let (across, from) = (e.cross(*f), *c - *a);
            let det = across.dot(across);
            let p = e.times_plus(from.cross(*f).dot(across) / det, *a);
            let q = f.times_plus(from.cross(*e).dot(across) / det, *c);
            let side = if from.value().dot(across.value()) < 0.0 { -1.0 } else { 1.0 };
            Some(([p, q], unit(across) * T::constant(side)))
        }
        (Placed::Line { .. } | Placed::Circle(_), Placed::Line { .. } | Placed::Circle(_)) => {
            let [p, q] = stationary(&Curve::of(a, near[0]), &Curve::of(b, near[1]));
            along_points(p, q)
        }
        (other, Placed::Face { point, normal }) => {
            let p = match other {
                Placed::Point(p) => *p,
                Placed::Line { .. } => Curve::of(other, near[0]).at(T::zero())[0],
                // The lowest point.
                Placed::Circle(circle) => {
                    let down = circle.axis * normal.dot(circle.axis) - *normal;
                    unit(down).times_plus(circle.radius, circle.centre)
                }
                Placed::Face { .. } => return None,
            };
            Some(([p, p - *normal * normal.dot(p - *point)], -*normal))
        }
        (Placed::Line { .. } | Placed::Circle(_) | Placed::Face { .. }, _) => {
            let ([q, p], n) = nearest_points([b, a], [near[1], near[0]])?;
            Some(([p, q], -n))
        }
    }
}

/// The point of a line that is nearest to a point.
fn foot<T: Real>(p: Vec3<T>, from: Vec3<T>, along: Vec3<T>) -> Vec3<T> {
    along.times_plus(along.dot(p - from) / along.dot(along), from)
}

/// The point of a circle that is nearest to a point.
fn beside<T: Real>(p: Vec3<T>, circle: &Circle<T>) -> Vec3<T> {
    let v = p - circle.centre;
    let out = v - circle.axis * circle.axis.dot(v);
    out.times_plus(circle.radius / out.norm(), circle.centre)
}

/// A line or a circle, with a parameter that is 0 near the nearest point.
#[derive(Clone, Copy)]
enum Curve<T> {
    Line { from: Vec3<T>, along: Vec3<T> },
    Circle { circle: Circle<T>, x: Vec3<T>, y: Vec3<T> },
}

impl<T: Real> Curve<T> {
    fn of(feature: &Placed<T>, near: Vec3) -> Self {
        match feature {
            Placed::Point(p) | Placed::Face { point: p, .. } => Self::Line { from: *p, along: Vec3::zero() },
            Placed::Line { from, along } => {
                let (a, e) = (from.value(), along.value());
                let at = e.dot(near - a) / e.dot(e);
                Self::Line { from: along.times_plus(T::constant(at), *from), along: *along }
            }
            Placed::Circle(circle) => {
                // A direction from the centre to the nearest point, perpendicular to the axis for any design and time.
                let to = (near - circle.centre.value()).spread::<T>();
                let to = to - circle.axis * circle.axis.dot(to);
                let x = to * (T::one() / to.norm());
                Self::Circle { circle: *circle, x, y: circle.axis.cross(x) }
            }
        }
    }

    /// The point at a parameter, and the first two derivatives by the parameter.
    fn at(&self, u: T) -> [Vec3<T>; 3] {
        match self {
            Self::Line { from, along } => [along.times_plus(u, *from), *along, Vec3::zero()],
            Self::Circle { circle, x, y } => {
                let (sin, cos) = u.sin_cos();
                let out = (*x * cos + *y * sin) * circle.radius;
                let along = (*y * cos - *x * sin) * circle.radius;
                [circle.centre + out, along, -out]
            }
        }
    }

    fn value(&self) -> Curve<f64> {
        match self {
            Self::Line { from, along } => Curve::Line { from: from.value(), along: along.value() },
            Self::Circle { circle, x, y } => {
                Curve::Circle { circle: circle.value(), x: x.value(), y: y.value() }
            }
        }
    }
}

/// Steps of Newton's method for plain numbers: the start is within 1e-6 of the curves' size.
const PLAIN_STEPS: usize = 4;
/// Corrections that follow for numbers with derivatives: each completes one further order.
pub(super) const CORRECTIONS: usize = 5;

/// The nearest points of two curves near their points of parameter 0.
///
/// With `G = Q(v) - P(u)` it is `abs(G)` where `g = (-G . P_u, G . Q_v) = 0`. Newton's method with the matrix
/// `K = [P_u.P_u - G.P_uu, -P_u.Q_v; -P_u.Q_v, Q_v.Q_v + G.Q_vv]` of plain numbers completes one order of the
/// derivatives per step.
fn stationary<T: Real>(p: &Curve<T>, q: &Curve<T>) -> [Vec3<T>; 2] {
    let mut plain = [0.0; 2];
    let (a, b) = (p.value(), q.value());
    let mut inverse = inverse_curvature(&a, &b, plain);
    for _ in 0..PLAIN_STEPS {
        let step = correction(&a, &b, plain, inverse);
        plain = number::both([0, 1], |k| plain[k] - step[k]);
        inverse = inverse_curvature(&a, &b, plain);
    }
    let mut at = plain.map(T::constant);
    for _ in 0..CORRECTIONS {
        let step = correction(p, q, at, inverse);
        at = number::both([0, 1], |k| at[k] - step[k]);
    }
    [p.at(at[0])[0], q.at(at[1])[0]]
}

/// `K^-1 g`.
fn correction<T: Real>(p: &Curve<T>, q: &Curve<T>, at: [T; 2], inverse: [f64; 3]) -> [T; 2] {
    let ([p, p_u, _], [q, q_v, _]) = (p.at(at[0]), q.at(at[1]));
    let apart = q - p;
    let (g, h) = (-(apart.dot(p_u)), apart.dot(q_v));
    let [a, b, c] = inverse;
    [g * a + h * b, g * b + h * c]
}

/// `K^-1`, symmetric: entries 11, 12, 22. For curves that no single pair of points is nearest on, 0: the points stay.
fn inverse_curvature(p: &Curve<f64>, q: &Curve<f64>, at: [f64; 2]) -> [f64; 3] {
    let ([p, p_u, p_uu], [q, q_v, q_vv]) = (p.at(at[0]), q.at(at[1]));
    let apart = q - p;
    let (a, b, c) = (p_u.dot(p_u) - apart.dot(p_uu), -p_u.dot(q_v), q_v.dot(q_v) + apart.dot(q_vv));
    let det = a * c - b * b;
    if det > PARALLEL * PARALLEL * a * c { [c / det, -b / det, a / det] } else { [0.0; 3] }
}

/// Sine of the angle below which two lines are parallel: of their common perpendicular then half of the digits are
/// lost.
pub(super) const PARALLEL: f64 = 1e-8;

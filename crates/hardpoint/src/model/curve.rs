//! The curve that a point follows: a smooth line in the x-y plane of a marker.

use crate::law::{Law, LawError, SplineDegree, SplineEnds, Table, polynomial};
use crate::number;
use crate::space::{Mat3, Pose, Real, Vec3};

/// Newton for the nearest point from a near start takes a few steps; more than this and it is lost.
const MAX_STEPS: usize = 50;
/// A step below this part of the curve's length leaves an error of round-off.
const CONVERGED: f64 = 1e-15;
/// ... and the last step, where round-off keeps steps above that, may be this part: its square is round-off.
const WANDERS: f64 = 1e-9;
/// Number of samples between two points of the curve from which the search for the contact starts.
const TRIED: usize = 8;

/// Tangents that are compared between two points of the curve, whose splines bend between them once or twice at most;
/// and of a long way.
const SAMPLES: f64 = 16.0;
const MOST_SAMPLES: f64 = 1024.0;

/// Length of a [`CurvePiece`].
pub const CURVE_PIECE: usize = 13;

/// Polynomial piece of a curve: the parameter at which it begins, then the coefficients of x, and of y, by powers of
/// the parameter from there.
pub type CurvePiece<T = f64> = [T; CURVE_PIECE];

/// A planar curve through points, in the frame of the marker that carries it: the quintic spline over the length of the
/// chords between the points, so that the acceleration of what follows it changes without kinks.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    x: Law,
    y: Law,
    /// Parameters of the points, m.
    knots: Vec<f64>,
    /// Length of the chords, m: the parameter u runs from 0 to it.
    length: f64,
    points: usize,
    closed: bool,
    /// The parameter next to the point that follows, in the design configuration.
    start: f64,
}

/// Point of contact with a curve, in the frame of the marker that carries the curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact<T = f64> {
    /// The parameter.
    pub u: T,
    /// The curve's point there, and its derivatives by u.
    c: [Vec3<T>; 4],
}

impl<T: Real> Contact<T> {
    /// The curve's place u.
    pub fn at(curve: &Curve, u: T) -> Self {
        let vector = |[x, y]: [f64; 2]| Vec3::new(x, y, 0.0).spread();
        Self { u, c: number::each(&curve.at(u.value()), vector) }
    }

    /// The place next to p.
    pub fn nearest(curve: &Curve, p: Vec3<T>, near: T) -> Self {
        let u = T::constant(curve.nearest([p.x.value(), p.y.value()], near.value()));
        Self::at(curve, u)
    }

    /// The place u of a piece.
    pub fn on_piece(piece: &CurvePiece<T>, u: T) -> Self {
        let [x, y] = number::both([1, 7], |first| polynomial(u - piece[0], 6, |power| piece[first + power]));
        Self { u, c: std::array::from_fn(|k| Vec3::new(x[k], y[k], T::zero())) }
    }

    /// The place of a piece after one step of Newton's method to the foot of the perpendicular from p.
    pub fn corrected(&self, piece: &CurvePiece<T>, p: Vec3<T>) -> Self {
        Self::on_piece(piece, self.u + self.step(p))
    }

    /// Distance of p from the curve, positive on its left, for the foot of the perpendicular or a place near it.
    ///
    /// With its first and second derivatives where p has some: n away from the nearest point, the distance is
    /// `n - k t^2 / (2 (1 - k n))`, t along the curve and k its curvature.
    pub fn distance(&self, p: Vec3<T>) -> T {
        let (frame, e) = (self.frame(), p - self.c[0]);
        let (t, n) = (frame.rot.cols[0].dot(e), frame.rot.cols[1].dot(e));
        let [_, d, dd, _] = self.c;
        // k = C' x C'' / abs(C')^3, of the parallel curve through p: k / (1 - k n)
        let k = (d.x * dd.y - d.y * dd.x) / (d.dot(d) * d.norm());
        let flat = k / (T::one() - k * n);
        n - T::constant(0.5) * flat * t * t
    }

    /// Step of Newton's method to the foot of the perpendicular from p: (p - C) . C' / (C'^2 - (p - C) . C'').
    fn step(&self, p: Vec3<T>) -> T {
        let [c, d, dd, _] = self.c;
        let e = p - c;
        e.dot(d) / (d.dot(d) - e.dot(dd))
    }

    /// The place next to p, which moves with p to first order: u' = p' . C' / (C'^2 - (p - C) . C'').
    pub fn follow(curve: &Curve, p: Vec3<T>, near: T) -> Self {
        let mut contact = Self::nearest(curve, p, near);
        let step = contact.step(p);
        let slide = step - T::constant(step.value());
        if !slide.vanishes() {
            contact.u += slide;
            for n in 0..3 {
                contact.c[n] += contact.c[n + 1] * slide;
            }
        }
        contact
    }

    /// The frame that walks along: x along the curve, y to its left.
    #[inline(always)]
    pub fn frame(&self) -> Pose<T> {
        let d = self.c[1];
        // x = C' / abs(C'),  y = z x x
        let x = d * (T::one() / d.norm());
        let z = Vec3::new(T::zero(), T::zero(), T::one());
        Pose { rot: Mat3 { cols: [x, z.cross(x), z] }, r: self.c[0] }
    }

    /// Rate at which that frame turns about z, and the rate of that, for the first two time derivatives of p, the point
    /// that follows, in the marker's frame: the foot of the perpendicular stays one, `(p - C) . C' = 0`.
    #[inline(always)]
    pub fn turning(&self, p: [Vec3<T>; 3]) -> [T; 2] {
        let [_, d, dd, ddd] = self.c;
        let two = T::constant(2.0);
        let [u1, u2] = self.sliding(p);
        // The tangent turns by k = C' x C'' / C'^2 per u.
        let square = d.dot(d);
        let cross = |a: Vec3<T>, b: Vec3<T>| a.x * b.y - a.y * b.x;
        let k = cross(d, dd) / square;
        // k' = C' x C''' / C'^2 - 2 k C' . C'' / C'^2
        let k1 = cross(d, ddd) / square - two * k * d.dot(dd) / square;
        // (k u.) and (k u.). = k' u.^2 + k u..
        [k * u1, k1 * u1 * u1 + k * u2]
    }

    /// First two time derivatives of the parameter, for those of p as in [`turning`](Self::turning).
    #[inline(always)]
    pub fn sliding(&self, p: [Vec3<T>; 3]) -> [T; 2] {
        let [c, d, dd, ddd] = self.c;
        let two = T::constant(2.0);
        let e = p[0] - c;
        // (p. - C' u.) . C' + (p - C) . C'' u. = 0, and its derivative.
        // u. = p. . C' / g,    g = C'^2 - (p - C) . C''
        let g = d.dot(d) - e.dot(dd);
        let u1 = p[1].dot(d) / g;
        // g. = 2 C' . C'' u. - (p. - C' u.) . C'' - (p - C) . C''' u.
        let g1 = two * d.dot(dd) * u1 - (p[1] - d * u1).dot(dd) - e.dot(ddd) * u1;
        // u.. = (p.. . C' + p. . C'' u. - g. u.) / g
        let u2 = (p[2].dot(d) + p[1].dot(dd) * u1 - g1 * u1) / g;
        [u1, u2]
    }
}

/// A place on a curve: its point, and the first three derivatives by u, each x and y in the marker's frame.
pub type CurvePoint = [[f64; 2]; 4];

impl Curve {
    /// The curve through points in a marker's x-y plane, for a follower that is drawn at `follower`.
    pub(crate) fn through(points: &[[f64; 2]], closed: bool, follower: [f64; 2]) -> Result<Self, LawError> {
        let mut points = points.to_vec();
        if closed {
            points.push(points[0]);
        }
        let mut times = vec![0.0];
        for pair in points.windows(2) {
            let chord = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
            times.push(times[times.len() - 1] + chord);
        }
        let ends = if closed { SplineEnds::Periodic } else { SplineEnds::Natural };
        let law = |axis: usize| {
            let values = points.iter().map(|p| p[axis]).collect();
            Law::table(&Table { times: times.clone(), values, degree: SplineDegree::Quintic, ends })
        };
        let length = times[times.len() - 1];
        let (x, y, points) = (law(0)?, law(1)?, points.len());
        let mut curve = Self { x, y, knots: times, length, points, closed, start: 0.0 };
        curve.start = curve.search(follower);
        Ok(curve)
    }

    /// The curve at u; not finite beyond the ends of an open one.
    pub fn at(&self, u: f64) -> CurvePoint {
        let (x, y) = (self.x.at(u).derivatives(), self.y.at(u).derivatives());
        std::array::from_fn(|k| [x[k], y[k]])
    }

    /// True if its end is its beginning.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Upper end of the curve parameter, m (the lower end is 0): the sum of the chord lengths.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Polynomial pieces between the points, in order.
    pub fn pieces(&self) -> impl Iterator<Item = CurvePiece> + '_ {
        (0..self.knots.len() - 1).map(|k| self.piece_between(k))
    }

    /// Polynomial piece between the points k and k + 1.
    fn piece_between(&self, k: usize) -> CurvePiece {
        let [x, y] = [&self.x, &self.y].map(|law| law.segments()[k]);
        let mut numbers = [self.knots[k]; CURVE_PIECE];
        numbers[1..7].copy_from_slice(&x);
        numbers[7..].copy_from_slice(&y);
        numbers
    }

    /// Polynomial piece at u, whole lengths away if the curve is closed; NaN beyond the ends of an open one.
    pub fn piece(&self, u: f64) -> CurvePiece {
        let turns = if self.closed { self.length * (u / self.length).floor() } else { 0.0 };
        let slack = 1e-12 * self.length;
        let within = u - turns;
        // NaN is beyond the ends, too.
        if !(within >= -slack && within <= self.length + slack) {
            return [f64::NAN; CURVE_PIECE];
        }
        let last = self.knots.len() - 2;
        let k = self.knots.partition_point(|knot| *knot <= within).saturating_sub(1).min(last);
        let mut piece = self.piece_between(k);
        piece[0] += turns;
        piece
    }

    /// Length of the parameter over which the tangent turns by about a radian where the curve bends most, m; not more
    /// than the whole length.
    pub(crate) fn turning_length(&self) -> f64 {
        let of = |ends: &[f64]| (ends[1] - ends[0]) / self.bend(ends[0], ends[1]);
        self.knots.windows(2).map(of).fold(self.length, f64::min)
    }

    /// Length of the parameter over which the curve may bend anew, m: that between two of its points.
    pub(crate) fn grain(&self) -> f64 {
        self.length / self.points as f64
    }

    /// Angle by which the tangent turns, to and fro, from one parameter to another, rad; NaN beyond the ends of an open
    /// curve.
    pub(crate) fn bend(&self, from: f64, to: f64) -> f64 {
        let parts = (SAMPLES * (to - from).abs() / self.grain()).ceil().clamp(0.5 * SAMPLES, MOST_SAMPLES);
        let tangent = |k: f64| self.at(from + (to - from) * (k / parts))[1];
        let (mut before, mut sum, mut k) = (tangent(0.0), 0.0, 0.0);
        while k < parts {
            k += 1.0;
            let now = tangent(k);
            sum += (before[0] * now[1] - before[1] * now[0]).atan2(dot(before, now)).abs();
            before = now;
        }
        sum
    }

    /// The parameter next to the follower in the design configuration.
    pub fn start(&self) -> f64 {
        self.start
    }

    /// The curve for a follower in another design configuration, unless that is beyond its ends.
    pub(crate) fn followed_at(&self, follower: [f64; 2]) -> Self {
        let start = self.search(follower);
        let has_contact = self.at(start)[0][0].is_finite();
        Self { start: if has_contact { start } else { self.start }, ..self.clone() }
    }

    /// The parameter of the point of the curve that is next to p, from a near one.
    ///
    /// The foot of the perpendicular, `(p - C) . C' = 0`; NaN where an open curve has none, and where none is found
    /// from there, as at the centre of a tight bend.
    pub fn nearest(&self, p: [f64; 2], near: f64) -> f64 {
        let (mut u, mut last) = (near, f64::INFINITY);
        for _ in 0..MAX_STEPS {
            let [c, d, dd, _] = self.at(u);
            let e = [p[0] - c[0], p[1] - c[1]];
            // Newton on g(u) = (p - C) . C':  g' = (p - C) . C'' - C'^2
            let slope = dot(d, d) - dot(e, dd);
            let step = dot(e, d) / slope;
            u += step;
            last = step.abs();
            if !(last > CONVERGED * self.length) {
                break;
            }
        }
        // Where it wanders about, u is no foot, and the tangent there would pass for the curve.
        if last <= WANDERS * self.length { u } else { f64::NAN }
    }

    /// The parameter next to p, from anywhere.
    fn search(&self, p: [f64; 2]) -> f64 {
        let n = TRIED * self.points;
        let distance = |k: &usize| {
            let [c, ..] = self.at(self.length * *k as f64 / n as f64);
            (p[0] - c[0]).hypot(p[1] - c[1])
        };
        let k = (0..=n).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
        let near = self.length * k as f64 / n as f64;
        let u = self.nearest(p, near);
        // A closed curve has a nearest point to every point; the first steps find it better from there.
        if u.is_nan() && self.closed { near } else { u }
    }

    /// The parameter at which p has this distance from the curve, positive on its left, within `near`; the parameter
    /// next to p if there is none. Both from anywhere: the nearest point need not be the contact, as where a roller
    /// passes between two flanks.
    pub(crate) fn contact(&self, p: [f64; 2], distance: f64, near: f64) -> f64 {
        let n = TRIED * self.points;
        let sample = |k: usize| self.length * k as f64 / n as f64;
        // g(u) = (p - C) . C', which changes its sign at each foot of a perpendicular
        let g = |u: f64| {
            let [c, d, ..] = self.at(u);
            dot([p[0] - c[0], p[1] - c[1]], d)
        };
        let off = |u: f64| {
            let [c, d, ..] = self.at(u);
            let left = [-d[1], d[0]];
            (dot(left, [p[0] - c[0], p[1] - c[1]]) / dot(d, d).sqrt() - distance).abs()
        };
        let signed: Vec<f64> = (0..=n).map(|k| g(sample(k))).collect();
        let changes = (0..n).filter(|k| signed[*k] * signed[k + 1] <= 0.0);
        let feet = changes.map(|k| self.nearest(p, 0.5 * (sample(k) + sample(k + 1))));
        let feet = feet.filter(|u| off(*u) <= near);
        feet.min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or_else(|| self.search(p))
    }

    /// Distance of p from the curve, positive on its left, with its first and second derivatives where p has some.
    pub(crate) fn distance<T: Real>(&self, p: Vec3<T>) -> T {
        Contact::nearest(self, p, T::constant(self.start)).distance(p)
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Dual;

    #[test]
    fn a_curve_through_points_of_a_circle_is_that_circle() {
        let points: Vec<[f64; 2]> = (0..24)
            .map(|k| (k as f64 / 24.0 * std::f64::consts::TAU).sin_cos())
            .map(|(s, c)| [2.0 * c, 2.0 * s])
            .collect();
        let curve = Curve::through(&points, true, [3.0, 0.1]).unwrap();
        for angle in [0.03_f64, 1.0, 3.1, 5.9] {
            let p = Vec3::new(3.0 * angle.cos(), 3.0 * angle.sin(), 7.0);
            let start = curve.search([p.x, p.y]);
            let at = Curve { start, ..curve.clone() };
            // The unit circle's distance is 2 - |p| on its left, with the derivatives of that.
            let moving = |direction: Vec3| {
                let by = Dual { v: Dual::variable(0.0), d: Dual::constant(1.0) };
                at.distance(p.spread() + direction.spread() * by)
            };
            let (out, along) = (p * (1.0 / 3.0), Vec3::new(-p.y, p.x, 0.0) * (1.0 / 3.0));
            let (out, along) = (Vec3::new(out.x, out.y, 0.0), along);
            let (outward, sideways) = (moving(out), moving(along));
            assert!((outward.v.v + 1.0).abs() < 1e-6, "{outward:?}");
            assert!((outward.d.v + 1.0).abs() < 1e-5 && outward.d.d.abs() < 1e-4, "{outward:?}");
            assert!(sideways.d.v.abs() < 1e-5 && (sideways.d.d + 1.0 / 3.0).abs() < 1e-3, "{sideways:?}");
        }
    }

    #[test]
    fn beyond_the_end_of_an_open_curve_there_is_no_nearest_point() {
        let curve = Curve::through(&[[0.0, 0.0], [1.0, 0.2], [2.0, 0.0]], false, [1.0, 0.0]).unwrap();
        assert!(curve.nearest([1.5, 0.3], curve.start()).is_finite());
        assert!(!curve.at(curve.nearest([3.0, 0.0], curve.start()))[0][0].is_finite());
    }
}

//! Proven lower bound of the distance of a segment that goes through a circle, which it is nearest to from the inside.
//!
//! With v from the centre of the circle to the point at u of the segment, from 0 to 1, z its height above the plane of
//! the circle, rho its distance from the axis and R the radius,
//!
//! ```text
//! D  =  sqrt(2 h),    h  =  (z^2 + (rho - R)^2) / 2
//! ```
//!
//! If `h_uu >= m > 0` over a part of the segment, each of its points is at least as far as
//! `h(u0) - h_u(u0)^2 / (2 m)`, for any u0 in it, or `h(u0)` at an end of the segment from which h rises. u0 goes
//! with the nearest point, where `h_u = 0` and nothing is lost. The other parts are at least as far as their middle,
//! less half of their length.

use crate::law::TimeJet;
use crate::number::{Interval, Jet, Rates};
use crate::space::{Real, Vec3};

use super::circle::Circle;

/// Parts into which a segment is divided.
const PARTS: usize = 32;

/// A segment and a circle over an interval of time.
pub(super) type EnclosedPair<'a> = (&'a [Vec3<TimeJet<Interval>>; 2], &'a Circle<TimeJet<Interval>>);

/// Place on a segment, from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PlaceOnSegment {
    /// An end: 0 or 1.
    End(f64),
    /// A place at which the distance is stationary, and its rate.
    Inside([f64; 2]),
}

impl PlaceOnSegment {
    /// The stationary place of a moving segment that is near this one.
    pub fn near(u: f64, segment: &[Vec3<Rates>; 2], circle: &Circle<Rates>) -> Self {
        let [_, slope, bend] = half_square(segment, circle, Rates::constant(u));
        let Jet([error, rate, _]) = slope;
        let bend = bend.0[0];
        Self::Inside([u - error / bend, -rate / bend])
    }

    fn with_rate(self) -> [f64; 2] {
        match self {
            Self::End(u) => [u, 0.0],
            Self::Inside(place) => place,
        }
    }
}

/// Place on a segment over time.
#[derive(Clone, Copy, Debug)]
enum PlaceOverTime {
    /// An end from which the distance rises.
    End(f64),
    /// A cubic polynomial: its coefficients by the time since an instant.
    Along { coefficients: [f64; 4], since: f64 },
}

/// Bound of the distance of a segment and a circle over an interval of time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RingBound {
    /// Index of the core that is the circle.
    circle: usize,
    /// Parts of the segment over which h is convex, from the first to before the last.
    convex: [usize; 2],
    /// Lower bound of `h_uu` there.
    bend: f64,
    /// True if h rises from this end of the segment at all times.
    rises_from: Option<f64>,
    place: PlaceOverTime,
}

impl RingBound {
    /// Parts of the segment that are convex around its nearest place; `None` if it is in none.
    pub(super) fn of(circle: usize, (segment, ring): EnclosedPair<'_>, near: PlaceOnSegment) -> Option<Self> {
        let value = |x: TimeJet<Interval>| x.value();
        let (ends, ring) = (
            [segment[0].map(value), segment[1].map(value)],
            Circle {
                centre: ring.centre.map(value),
                axis: ring.axis.map(value),
                radius: ring.radius.value(),
            },
        );
        let at = |u: Interval| half_square(&ends, &ring, u);
        let bend = |k: usize| {
            let [from, to] = [k, k + 1].map(|k| k as f64 / PARTS as f64);
            Some(at(Interval::between(from, to))[2].low).filter(|bend| *bend > 0.0 && bend.is_finite())
        };
        let [u, _] = near.with_rate();
        let nearest = ((u * PARTS as f64) as usize).min(PARTS - 1);
        let mut least = bend(nearest)?;
        let [mut first, mut last] = [nearest, nearest + 1];
        while let Some(bend) = first.checked_sub(1).and_then(bend) {
            (first, least) = (first - 1, least.min(bend));
        }
        while let Some(bend) = Some(last).filter(|k| *k < PARTS).and_then(bend) {
            (last, least) = (last + 1, least.min(bend));
        }
        let rises_from = match near {
            PlaceOnSegment::End(end) => {
                let slope = at(Interval::constant(end))[1];
                (if end == 0.0 { slope.low >= 0.0 } else { slope.high <= 0.0 }).then_some(end)
            }
            PlaceOnSegment::Inside(_) => None,
        };
        let place = PlaceOverTime::Along { coefficients: [u, 0.0, 0.0, 0.0], since: 0.0 };
        Some(Self { circle, convex: [first, last], bend: least, rises_from, place })
    }

    /// Through a place at an instant.
    pub fn through(self, place: PlaceOnSegment, since: f64) -> Self {
        let [u, rate] = place.with_rate();
        self.along(&[place], [u, rate, 0.0, 0.0], since)
    }

    /// Through places at two times.
    pub fn between(self, places: [PlaceOnSegment; 2], [from, to]: [f64; 2]) -> Self {
        let [[u, d], [v, e]] = places.map(PlaceOnSegment::with_rate);
        let per = 1.0 / (to - from);
        let rise = (v - u) * per;
        // Hermite's cubic.
        let coefficients = [u, d, (rise * 3.0 - d * 2.0 - e) * per, (d + e - rise * 2.0) * per * per];
        self.along(&places, coefficients, from)
    }

    fn along(self, places: &[PlaceOnSegment], coefficients: [f64; 4], since: f64) -> Self {
        let is_end = |place: &PlaceOnSegment, end: f64| matches!(place, PlaceOnSegment::End(u) if *u == end);
        let end = self.rises_from.filter(|end| places.iter().all(|place| is_end(place, *end)));
        let place = end.map_or(PlaceOverTime::Along { coefficients, since }, PlaceOverTime::End);
        Self { place, ..self }
    }

    /// Index of the core that is the circle.
    pub(super) fn circle(&self) -> usize {
        self.circle
    }

    /// Functions of which the least is at most the distance; `None` if its place leaves the parts that are convex.
    pub(super) fn functions(
        &self,
        (segment, circle): EnclosedPair<'_>,
        over: Interval,
    ) -> Option<Vec<TimeJet<Interval>>> {
        let constant = |x: f64| Jet::constant(Interval::constant(x));
        let part = |k: usize| k as f64 / PARTS as f64;
        let nearest = match self.place {
            PlaceOverTime::End(end) => half_square(segment, circle, constant(end))[0],
            PlaceOverTime::Along { coefficients, since } => {
                let time = Jet::time(over - Interval::constant(since));
                let [a, b, c, d] = coefficients.map(constant);
                let u = a + time * (b + time * (c + time * d));
                if !Interval::between(part(self.convex[0]), part(self.convex[1])).encloses(u.value()) {
                    return None;
                }
                let [h, slope, _] = half_square(segment, circle, u);
                h - slope * slope / constant(2.0 * self.bend)
            }
        };
        let mut functions = vec![(nearest * constant(2.0)).sqrt()];
        let half = (segment[1] - segment[0]).norm() * constant(0.5 / PARTS as f64);
        let others = (0..PARTS).filter(|k| *k < self.convex[0] || *k >= self.convex[1]);
        functions.extend(others.map(|k| {
            let [h, ..] = half_square(segment, circle, constant(part(k) + 0.5 / PARTS as f64));
            (h * constant(2.0)).sqrt() - half
        }));
        Some(functions)
    }
}

/// h at a place of a segment, with its first two derivatives by the place.
fn half_square<T: Real>([a, b]: &[Vec3<T>; 2], circle: &Circle<T>, u: T) -> [T; 3] {
    let e = *b - *a;
    let v = e.times_plus(u, *a) - circle.centre;
    let (z, rises) = (circle.axis.dot(v), circle.axis.dot(e));
    let (out, across) = (v - circle.axis * z, e - circle.axis * rises);
    let rho = out.norm();
    let (beyond, recedes) = (rho - circle.radius, out.dot(across) / rho);
    [
        (z * z + beyond * beyond) * T::constant(0.5),
        z * rises + beyond * recedes,
        rises * rises + recedes * recedes + beyond * (across.dot(across) - recedes * recedes) / rho,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_within_a_ring_are_below_the_distance_and_exact_at_the_nearest_point() {
        let circle = Circle { centre: Vec3::new(0.1, -0.2, 0.3), axis: Vec3::AXES[1], radius: 1.2 };
        let rods: [[[f64; 3]; 2]; 3] = [
            [[0.5, -3.0, 0.6], [0.9, 0.5, 0.4]],
            // Its end is nearest.
            [[0.2, -3.0, 0.1], [0.9, -0.3, 0.8]],
            // It goes out of the ring's hole to beside it.
            [[3.5, -0.9, 0.5], [0.2, 0.2, 0.2]],
        ];
        for ends in rods {
            let ends = ends.map(Vec3::from);
            let apart = |u: f64| (2.0 * half_square(&ends, &circle, u)[0]).sqrt();
            let sample = |k: i32| apart(f64::from(k) / 100_000.0);
            let k = (0..=100_000).min_by(|a, b| sample(*a).total_cmp(&sample(*b))).unwrap();
            let u = f64::from(k) / 100_000.0;
            let near = if k == 0 || k == 100_000 {
                PlaceOnSegment::End(u)
            } else {
                let [_, slope, bend] = half_square(&ends, &circle, u);
                PlaceOnSegment::Inside([u - slope / bend, 0.0])
            };
            let exact = |x: f64| Jet::constant(Interval::constant(x));
            let enclosed = ends.map(|p| p.map(exact));
            let ring = Circle {
                centre: circle.centre.map(exact),
                axis: circle.axis.map(exact),
                radius: exact(circle.radius),
            };
            let bound = RingBound::of(1, (&enclosed, &ring), near).unwrap().through(near, 0.0);
            let all = bound.functions((&enclosed, &ring), Interval::constant(0.0)).unwrap();
            let least = all.iter().map(|f| f.value().low).fold(f64::INFINITY, f64::min);
            // Between samples it is nearer by their spacing squared.
            let nearest = apart(near.with_rate()[0]);
            assert!(least <= sample(k) && least > nearest - 1e-13, "{ends:?}: {least} {nearest}");
        }
    }
}

//! Proven lower bounds of the distance of two convex solids over an interval of time: of cores, and of hulls of points.
//!
//! For any unit vector n, two convex solids are at least `min n . Q - max n . P` apart, Q in the second and P in the
//! first; with n along the nearest points it is their distance. n may turn in any way: over an interval of time every
//! `n(t) . (Q(t) - P(t))` of the points at which the extrema can be (ends of a segment, points of two rims) is a smooth
//! function, and the distance is never less than the least of these. So no bound depends on which features are nearest.
//!
//! | direction | n(t) | no slack |
//! |---|---|---|
//! | fixed | constant | at one time, to first order |
//! | turning | along a vector that is a polynomial in time | at an instant and its rates, or at both ends |
//! | normal | of a plane, of the cap of a cylinder, or of a facet of a hull | while that is nearest |
//!
//! A circle has the bound of its disc, and from a point its own: the distance by the formula of `feature.rs`, always.
//! From a segment that goes through it, it has that of `through_ring.rs`.

use crate::law::TimeJet;
use crate::number::{self, Interval, Jet};
use crate::space::{Pose, Real, Vec3};

use super::circle::Circle;
use super::core::Core;
use super::feature::Feature;
use super::nearest::Nearest;
use super::surface::moved;
use super::through_ring::{EnclosedPair, PlaceOnSegment, RingBound};

/// A convex solid with bounds of its place and rates.
#[expect(clippy::large_enum_variant, reason = "there are two, made for one interval")]
pub(crate) enum EnclosedSolid {
    /// A core.
    Core(Core<TimeJet<Interval>>),
    /// The hull of points.
    Hull(Vec<Vec3<TimeJet<Interval>>>),
}

impl EnclosedSolid {
    /// The solid in another frame.
    pub fn moved(&self, pose: Pose<TimeJet<Interval>>) -> Self {
        match self {
            Self::Core(core) => Self::Core(moved(core, pose)),
            Self::Hull(points) => Self::Hull(points.iter().map(|p| pose.point(*p)).collect()),
        }
    }

    /// Corners of a facet, in order as seen from the side to which a vector points: a triangle has two of them.
    fn facet(&self, corners: [u32; 3], towards: Vec3) -> [u32; 3] {
        let Self::Hull(points) = self else { return corners };
        let [a, b, c] = points[..] else { return corners };
        let [a, b, c] = [a, b, c].map(|p| p.map(|x| x.value().middle()));
        if (b - a).cross(c - a).dot(towards) < 0.0 { [0, 2, 1] } else { [0, 1, 2] }
    }

    /// Greatest distance of a point of the solid, over an interval of time, from its place at a time within it, in
    /// plain numbers. `narrow` has the bounds at that time, and `since` is the time since then. A half-space is used up
    /// to the distance `size` from its point.
    pub fn displacement(&self, narrow: &Self, since: Interval, size: f64) -> f64 {
        let by = |x: TimeJet<Interval>, narrow: TimeJet<Interval>| {
            x.narrowed(narrow, since).value() - Interval::constant(narrow.value().middle())
        };
        let moves = |v: Vec3<TimeJet<Interval>>, narrow: Vec3<TimeJet<Interval>>| {
            let square = |k: usize| by(v[k], narrow[k]).square();
            (square(0) + square(1) + square(2)).sqrt()
        };
        let farthest = |all: &mut dyn Iterator<Item = Interval>| {
            Interval::constant(all.map(|moved| moved.high).fold(0.0, f64::max))
        };
        // A direction that turns moves what is `reach` from its foot by at most `reach` times its change.
        let along = |foot: Interval, axis: Interval, reach: Interval| foot + axis * reach;
        let most = match (self, narrow) {
            (Self::Core(Core::Point(p)), Self::Core(Core::Point(q))) => moves(*p, *q),
            (Self::Core(Core::Segment([a, b])), Self::Core(Core::Segment([c, d]))) => {
                farthest(&mut [moves(*a, *c), moves(*b, *d)].into_iter())
            }
            (Self::Core(Core::Circle(p)), Self::Core(Core::Circle(q))) => {
                along(moves(p.centre, q.centre), moves(p.axis, q.axis), p.radius.value())
            }
            (
                Self::Core(Core::Cylinder { middle: p, half_width: w }),
                Self::Core(Core::Cylinder { middle: q, half_width: v }),
            ) => {
                // One between points of two bodies grows longer.
                let longer = Real::abs(by(*w, *v));
                let reach = p.radius.value() + w.value();
                along(moves(p.centre, q.centre) + longer, moves(p.axis, q.axis), reach)
            }
            (
                Self::Core(Core::HalfSpace { point: p, normal: n }),
                Self::Core(Core::HalfSpace { point: q, normal: m }),
            ) => along(moves(*p, *q), moves(*n, *m), Interval::constant(size)),
            (Self::Hull(p), Self::Hull(q)) => farthest(&mut p.iter().zip(q).map(|(p, q)| moves(*p, *q))),
            (Self::Core(_) | Self::Hull(_), _) => Interval::ENTIRE,
        };
        most.high
    }
}

/// Unit vector from the first core to the second one, over time.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Direction {
    /// Along a cubic polynomial: its coefficients by the time since an instant.
    Turning { coefficients: [Vec3; 4], since: f64 },
    /// Normal of the plane or cap of core k, on this side.
    Normal { of: usize, side: f64 },
    /// Normal of the facet of hull k between these corners, which are in order if they are seen from outside.
    Facet { of: usize, corners: [u32; 3] },
    /// From a point to the nearest point of a circle.
    ToCircle,
    /// From a segment to a circle around it.
    ThroughRing(RingBound),
}

impl Direction {
    /// A fixed direction.
    pub fn fixed(n: Vec3) -> Self {
        Self::Turning { coefficients: [n, Vec3::ZERO, Vec3::ZERO, Vec3::ZERO], since: 0.0 }
    }

    /// The direction that has this value and these rates at an instant.
    pub fn through([n, d, dd]: [Vec3; 3], since: f64) -> Self {
        Self::Turning { coefficients: [n, d, dd * 0.5, Vec3::ZERO], since }
    }

    /// The direction that has these values and rates at two times.
    pub fn between([[n, d, _], [m, e, _]]: [[Vec3; 3]; 2], [from, to]: [f64; 2]) -> Self {
        let per = 1.0 / (to - from);
        let rise = (m - n) * per;
        // Hermite's cubic.
        let square = (rise * 3.0 - d * 2.0 - e) * per;
        let cube = (d + e - rise * 2.0) * (per * per);
        Self::Turning { coefficients: [n, d, square, cube], since: from }
    }

    /// The direction that goes with the features that are nearest, if one of them has it.
    pub fn of_features(solids: [&EnclosedSolid; 2], near: &Nearest) -> Option<Self> {
        let is_circle = |k: usize| matches!(solids[k], EnclosedSolid::Core(Core::Circle(_)));
        let is_point = |k: usize| matches!(solids[k], EnclosedSolid::Core(Core::Point(_)));
        if is_circle(0) && is_point(1) || is_point(0) && is_circle(1) {
            return Some(Self::ToCircle);
        }
        (0..2).find_map(|of| match near.features[of] {
            Feature::Face(side) => Some(Self::Normal { of, side }),
            Feature::Facet(corners) => {
                let towards = near.points[1 - of] - near.points[of];
                Some(Self::Facet { of, corners: solids[of].facet(corners, towards) })
            }
            Feature::Point(_)
            | Feature::Line
            | Feature::Circle(_)
            | Feature::Vertex(_)
            | Feature::Edge(_)
            | Feature::EdgePoint(..) => None,
        })
    }
}

/// A bound of the distance of a segment and a circle around it, near this place of the segment; `None` of other solids.
pub(crate) fn ring_bound(solids: [&EnclosedSolid; 2], near: PlaceOnSegment) -> Option<RingBound> {
    (0..2).find_map(|circle| RingBound::of(circle, segment_and_circle(solids, circle)?, near))
}

/// The other solid, which is a segment, and this one, which is a circle.
fn segment_and_circle(solids: [&EnclosedSolid; 2], circle: usize) -> Option<EnclosedPair<'_>> {
    let EnclosedSolid::Core(Core::Segment(ends)) = solids[1 - circle] else { return None };
    let EnclosedSolid::Core(Core::Circle(circle)) = solids[circle] else { return None };
    Some((ends, circle))
}

/// Bounds, over an interval of time, of functions of which the least is at most the distance of two cores; `None` if a
/// direction bounds nothing. Their number and order depend on the direction and the kinds of the cores only.
pub(crate) fn separations(
    solids: [&EnclosedSolid; 2],
    direction: Direction,
    over: Interval,
) -> Option<Vec<TimeJet<Interval>>> {
    let n = match direction {
        Direction::Turning { coefficients: [a, b, c, d], since } => {
            let time = Jet::time(over - Interval::constant(since));
            let component = |of: [f64; 4]| {
                let [a, b, c, d] = number::each(&of, |x| Jet::constant(Interval::constant(x)));
                a + time * (b + time * (c + time * d))
            };
            Vec3::new(
                component([a.x, b.x, c.x, d.x]),
                component([a.y, b.y, c.y, d.y]),
                component([a.z, b.z, c.z, d.z]),
            )
        }
        Direction::Normal { of, side } => {
            let outwards = if of == 0 { side } else { -side };
            let EnclosedSolid::Core(core) = solids[of] else { return None };
            match core {
                Core::Cylinder { middle, .. } => middle.axis * Jet::constant(Interval::constant(outwards)),
                Core::HalfSpace { normal, .. } if of == 0 => *normal,
                Core::HalfSpace { normal, .. } => -*normal,
                Core::Point(_) | Core::Segment(_) | Core::Circle(_) => return None,
            }
        }
        Direction::Facet { of, corners } => {
            let EnclosedSolid::Hull(points) = solids[of] else { return None };
            let [a, b, c] = number::each(&corners, |k| points[k as usize]);
            let outward = (b - a).cross(c - a);
            if of == 0 { outward } else { -outward }
        }
        Direction::ToCircle => {
            let [EnclosedSolid::Core(a), EnclosedSolid::Core(b)] = solids else { return None };
            let (Core::Point(p), Core::Circle(circle)) = (a, b) else {
                let (Core::Circle(circle), Core::Point(p)) = (a, b) else { return None };
                return Some(vec![to_circle(*p, circle)]);
            };
            return Some(vec![to_circle(*p, circle)]);
        }
        Direction::ThroughRing(bound) => {
            return bound.functions(segment_and_circle(solids, bound.circle())?, over);
        }
    };
    let n = n * (Jet::constant(Interval::one()) / n.norm());
    let [of_first, of_second] = number::both([0, 1], |k| {
        let side = match direction {
            Direction::Normal { of, side } if of == k => Some(side),
            Direction::Normal { .. }
            | Direction::Facet { .. }
            | Direction::Turning { .. }
            | Direction::ToCircle
            | Direction::ThroughRing(_) => None,
        };
        match solids[k] {
            EnclosedSolid::Core(core) => supports(core, n, side),
            EnclosedSolid::Hull(points) => Some(points.iter().map(|p| (*p, TimeJet::zero())).collect()),
        }
    });
    let (of_first, of_second) = (of_first?, of_second?);
    let gap = |(p, r): &Support, (q, s): &Support| n.dot(*q - *p) - *r - *s;
    Some(of_second.iter().flat_map(|b| of_first.iter().map(|a| gap(a, b))).collect())
}

/// A point, and how far the core extends beyond it along a direction.
type Support = (Vec3<TimeJet<Interval>>, TimeJet<Interval>);

/// The points of a core one of which is the farthest along n or against it. `side` is that of its own plane or cap, if
/// n is its normal.
fn supports(
    core: &Core<TimeJet<Interval>>,
    n: Vec3<TimeJet<Interval>>,
    side: Option<f64>,
) -> Option<Vec<Support>> {
    let zero = TimeJet::zero();
    Some(match (core, side) {
        (Core::Point(p), _) => vec![(*p, zero)],
        (Core::Segment(ends), _) => ends.iter().map(|p| (*p, zero)).collect(),
        (Core::Circle(circle), _) => vec![(circle.centre, rim(circle, n))],
        // All of a cap is at the same height along its normal.
        (Core::Cylinder { middle, half_width }, Some(side)) => {
            vec![(middle.moved(*half_width * side).centre, zero)]
        }
        (Core::Cylinder { middle, half_width }, None) => {
            let beyond = rim(middle, n);
            number::both([-1.0, 1.0], |side| (middle.moved(*half_width * side).centre, beyond)).to_vec()
        }
        (Core::HalfSpace { point, .. }, Some(_)) => vec![(*point, zero)],
        (Core::HalfSpace { .. }, None) => return None,
    })
}

/// Extent of a circle from its centre along n: `R abs(n x e)`.
fn rim(circle: &Circle<TimeJet<Interval>>, n: Vec3<TimeJet<Interval>>) -> TimeJet<Interval> {
    let across = n.cross(circle.axis);
    let length = across.norm();
    if length.value().is_bounded() {
        return circle.radius * length;
    }
    // Where n is along the axis the length has no rates.
    let square = |x: TimeJet<Interval>| x.value().square();
    let size = (square(across.x) + square(across.y) + square(across.z)).sqrt();
    let unknown = Interval::ENTIRE;
    Jet([circle.radius.value() * size, unknown, unknown, unknown])
}

/// `sqrt(z z + (rho - R)^2)`
fn to_circle(p: Vec3<TimeJet<Interval>>, circle: &Circle<TimeJet<Interval>>) -> TimeJet<Interval> {
    let v = p - circle.centre;
    let (z, rho) = (circle.axis.dot(v), circle.axis.cross(v).norm());
    Real::hypot(z, rho - circle.radius)
}

/// Proven lower bound of a function over an interval of time. `over` are bounds over all of it, `ends` narrow ones at
/// both ends, and `inside` those at a time within it, with the time since then.
///
/// The greatest of: the lower bound itself; with `f.. <= A` the chord less `A s (h - s) / 2`; with `f.. >= c` the
/// parabola of that curvature through value and rate at a time inside; and where the rate does not change its sign, the
/// value at an end.
pub(crate) fn lower_bound(
    over: TimeJet<Interval>,
    ends: [Interval; 2],
    inside: (TimeJet<Interval>, Interval),
    length: Interval,
) -> f64 {
    let Jet([value, rate, second, _]) = over;
    let mut best = value.low;
    let [start, end] = ends;
    // Up to the kink of a law the rate is bounded on either side, but not inside.
    if !rate.is_bounded() {
        return best;
    }
    if rate.low >= 0.0 {
        best = best.max(start.low);
    } else if rate.high <= 0.0 {
        best = best.max(end.low);
    }
    if second.high.is_finite() {
        let lowest = start.low.min(end.low);
        let (bend, rise) = (Interval::constant(second.high.max(0.0)), end - start);
        let square = length.square();
        let sag = bend * square * 0.125;
        // The lowest point of chord and parabola is inside unless abs(rise) >= A h^2 / 2.
        let is_inside = !(Real::abs(rise).low >= (sag * 4.0).high);
        best = best.max(if bend.high == 0.0 || !is_inside {
            lowest
        } else {
            let curve = (start + end) * 0.5 - rise.square() / (bend * square * 2.0) - sag;
            curve.low.max((Interval::constant(lowest) - sag).low)
        });
    }
    let (Jet([at, slope, ..]), since) = inside;
    if second.low.is_finite() && at.is_bounded() && slope.is_bounded() {
        let bend = Interval::constant(second.low);
        best = best.max(if second.low > 0.0 {
            (at - slope.square() / (bend * 2.0)).low
        } else {
            (at + slope * since + bend * since.square() * 0.5).low
        });
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Functions of a time with their first two rates.
    type Curve = fn(f64) -> [f64; 3];

    #[test]
    fn bounds_are_below_the_function_and_exact_where_it_falls_or_is_convex() {
        let curves: [(&str, Curve); 4] = [
            ("falling", |t| [(-t).exp(), -(-t).exp(), (-t).exp()]),
            ("sine", |t| [(3.0 * t).sin(), 3.0 * (3.0 * t).cos(), -9.0 * (3.0 * t).sin()]),
            ("convex", |t| [t.cosh() - 1.0, t.sinh(), t.cosh()]),
            ("cubic", |t| [t * t * t - t, 3.0 * t * t - 1.0, 6.0 * t]),
        ];
        let exact = |x: f64| Interval::between(x - 1e-15 * x.abs(), x + 1e-15 * x.abs());
        let with_rates = |[f, d, dd]: [f64; 3]| Jet([exact(f), exact(d), exact(dd), Interval::ENTIRE]);
        for (name, f) in curves {
            for (from, to) in [(-1.0, 1.0), (-0.3, 0.5), (0.2, 0.25), (0.5, 0.6), (-0.02, 0.01)] {
                let samples: Vec<[f64; 3]> =
                    (0..=1000).map(|k| f(from + (to - from) * f64::from(k) / 1000.0)).collect();
                let range = |n: usize| {
                    let hull = samples.iter().map(|s| exact(s[n])).reduce(Interval::or).unwrap();
                    // Of second order in the spacing of the samples.
                    let hair = 30.0 * (to - from) * (to - from) * 1e-6;
                    hull + Interval::symmetric(hair)
                };
                let over = Jet([range(0) + Interval::symmetric(10.0), range(1), range(2), Interval::ENTIRE]);
                let least = samples.iter().map(|s| s[0]).fold(f64::INFINITY, f64::min);
                let ends = [from, to].map(|t| exact(f(t)[0]));
                for s in [0.0, 0.31, 0.5, 1.0] {
                    let t = from + s * (to - from);
                    let inside = (with_rates(f(t)), Interval::between(from, to) - Interval::constant(t));
                    let length = Interval::constant(to) - Interval::constant(from);
                    let bound = lower_bound(over, ends, inside, length);
                    assert!(bound <= least + 1e-15, "{name} from {from} to {to}: {bound} > {least}");
                    let h = to - from;
                    assert!(bound >= least - 5.0 * h * h, "{name} from {from} to {to}: {bound} < {least}");
                    if over.d().low > 0.0 || over.d().high < 0.0 {
                        assert!(bound >= least - 1e-14, "{name} is monotone: {bound} < {least}");
                    }
                }
                // At the minimum of a convex function nothing is left.
                if name == "convex" && from < 0.0 {
                    let inside = (with_rates(f(0.0)), Interval::between(from, to));
                    let bound =
                        lower_bound(over, ends, inside, Interval::constant(to) - Interval::constant(from));
                    assert!((-1e-300..=0.0).contains(&bound), "{bound}");
                }
            }
        }
    }
}

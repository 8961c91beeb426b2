//! Elementary constraints, by their formulas.

use super::lowest_point::Radius;
use super::marker_pair::{MarkerPair, MarkerPairRates};
use super::{angle, convel, distance, dot1, dot2, lowest_point, spherical};
use crate::number;
use crate::space::{Real, Wrench};

/// One elementary constraint equation between two markers. Axes are 0, 1, 2 for x, y, z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row {
    /// One component, along a world axis, of the spherical constraint `d = 0` (paper Eq. 4.7).
    Point(usize),
    /// One component of `d = 0` along an axis of the loop's base, for loops on a moving body.
    PointOnBase(usize),
    /// `a_i . b_j = 0`: axis a of marker i perpendicular to axis b of marker j (paper Eq. 4.1).
    Dot1(usize, usize),
    /// `a_i . d = f`: displacement of marker j along axis a of marker i (paper Eq. 4.4).
    Dot2(usize),
    /// `|d| = L + f` (paper Eq. 4.10, unsquared so that its residual is a length).
    Distance,
    /// Angle of marker j about z_i equals f, rad; x_j must be perpendicular to z_i (z_i parallel to z_j, or a universal
    /// joint).
    Angle,
    /// Angle of marker j about its own x axis equals f, rad; x_j must be perpendicular to z_i (a universal joint).
    AngleOnJ,
    /// Angle of marker j about its own x axis, seen along it, equals f, rad, for axes of any direction.
    HeadingOnJ,
    /// The last of the Cardan angles of marker j relative to marker i, about z_j, equals f, rad: the angle of a joint
    /// whose axis tilts.
    CardanAngle,
    /// Angle of x_j about z_i, seen along z_i, equals f, rad, for axes of any direction.
    Heading,
    /// Angle of z_j about z_i, seen along z_i, equals its design value plus f, rad, for axes of any direction.
    Course,
    /// `z_i . z_j` has its design value: an angle between two axes (paper Eq. 4.1 with a constant).
    Cosine,
    /// `z_i . d` has its design value (paper Eq. 4.4 with a constant).
    Offset,
    /// `y_i . d` has its design value, where marker i moves along a curve of its body to the point nearest to P_j: x_i
    /// along the curve, y_i perpendicular to it.
    Contact,
    /// No relative rotation of the markers about the bisector of z_i and z_j.
    ConstantVelocity,
    /// Height along z_i of the lowest point of a disc about z_j equals its design value plus f.
    LowestPoint(Radius),
}

/// d = 0.
pub(crate) const COINCIDE: [Row; 3] = [Row::Point(0), Row::Point(1), Row::Point(2)];

/// z_j parallel to z_i.
pub(crate) const PARALLEL_Z: [Row; 2] = [Row::Dot1(2, 0), Row::Dot1(2, 1)];

/// No relative rotation.
pub(crate) const PARALLEL_FRAMES: [Row; 3] = [Row::Dot1(2, 0), Row::Dot1(2, 1), Row::Dot1(0, 1)];

/// P_j on the line through P_i along z_i.
pub(crate) const ON_LINE: [Row; 2] = [Row::Dot2(0), Row::Dot2(1)];

/// Rows as joint coordinates: their values, for couplers and for design values of joints.
impl Row {
    /// True if the constrained quantity has its design value as a target, rather than zero.
    pub fn keeps_design_value(self) -> bool {
        matches!(
            self,
            Self::Distance
                | Self::Course
                | Self::Cosine
                | Self::Offset
                | Self::Contact
                | Self::LowestPoint(_)
        )
    }

    /// Value of the row for a target of zero; angles are unwrapped to within half a turn of `near`.
    #[inline(never)]
    pub fn value<T: Real>(self, ends: &MarkerPair<T>, near: T) -> T {
        match self {
            Self::Angle | Self::Heading => angle::value(ends, near),
            Self::AngleOnJ | Self::HeadingOnJ => angle::value_on_j(ends, near),
            Self::CardanAngle => angle::cardan(ends, near),
            Self::Course => angle::course(ends, near),
            _ => self.residual(ends, T::zero()),
        }
    }
}

impl Row {
    /// Row with the same geometry among the common ones.
    ///
    /// Their formulas are inlined into the hot path; the others are function calls, to keep it small.
    #[inline(always)]
    fn common(self) -> Self {
        match self {
            Self::Cosine => Self::Dot1(2, 2),
            Self::Offset => Self::Dot2(2),
            Self::Contact => Self::Dot2(1),
            _ => self,
        }
    }

    /// Residual of the constraint, m or rad (or a cosine); `target` is the design value of the constrained quantity
    /// (the length of a rod), or the value of the driver.
    #[inline(always)]
    pub fn residual<T: Real>(self, ends: &MarkerPair<T>, target: T) -> T {
        match self.common() {
            Self::Point(k) => spherical::residual(k, ends),
            Self::PointOnBase(k) => spherical::residual_on_base(k, ends),
            Self::Dot1(a, b) => dot1::residual(a, b, ends, target),
            Self::Dot2(a) => dot2::residual(a, ends, target),
            Self::Distance => distance::residual(ends, target),
            Self::Angle => angle::residual(ends, target),
            _ => self.rare_residual(ends, target),
        }
    }

    #[inline(never)]
    fn rare_residual<T: Real>(self, ends: &MarkerPair<T>, target: T) -> T {
        match self {
            Self::AngleOnJ => angle::residual_on_j(ends, target),
            Self::HeadingOnJ => angle::heading_on_j_residual(ends, target),
            Self::CardanAngle => angle::cardan_residual(ends, target),
            Self::Heading => angle::heading_residual(ends, target),
            Self::Course => angle::course_residual(ends, target),
            Self::ConstantVelocity => convel::residual(ends, target),
            Self::LowestPoint(radius) => lowest_point::residual(radius, ends, target),
            _ => unreachable!("a common row"),
        }
    }

    /// Wrench l, in world components about the world origin.
    #[inline(always)]
    pub fn wrench<T: Real>(self, ends: &MarkerPair<T>) -> Wrench<T> {
        match self.common() {
            Self::Point(k) => spherical::wrench(k, ends),
            Self::PointOnBase(k) => spherical::wrench_on_base(k, ends),
            Self::Dot1(a, b) => dot1::wrench(a, b, ends),
            Self::Dot2(a) => dot2::wrench(a, ends),
            Self::Distance => distance::wrench(ends),
            Self::Angle => angle::wrench(ends),
            _ => self.rare_wrench(ends),
        }
    }

    #[inline(never)]
    fn rare_wrench<T: Real>(self, ends: &MarkerPair<T>) -> Wrench<T> {
        match self {
            Self::AngleOnJ => angle::wrench_on_j(ends),
            Self::HeadingOnJ => angle::heading_on_j_wrench(ends),
            Self::CardanAngle => angle::cardan_wrench(ends),
            Self::Heading => angle::heading_wrench(ends),
            Self::Course => angle::course_wrench(ends),
            Self::ConstantVelocity => convel::wrench(ends),
            Self::LowestPoint(radius) => lowest_point::wrench(radius, ends),
            _ => unreachable!("a common row"),
        }
    }

    /// First and second time derivatives of the wrench.
    #[inline(always)]
    pub fn wrench_rates<T: Real>(self, ends: &MarkerPair<T>, rates: &MarkerPairRates<T>) -> [Wrench<T>; 2] {
        match self.common() {
            Self::Point(k) => spherical::wrench_rates(k, ends, rates),
            Self::PointOnBase(k) => spherical::wrench_rates_on_base(k, ends, rates),
            Self::Dot1(a, b) => dot1::wrench_rates(a, b, ends, rates),
            Self::Dot2(a) => dot2::wrench_rates(a, ends, rates),
            Self::Distance => distance::wrench_rates(ends, rates),
            Self::Angle => angle::wrench_rates(ends, rates),
            _ => self.rare_wrench_rates(ends, rates),
        }
    }

    /// Evaluates the wrench on markers with their time derivatives. (The common rows have explicit formulas, which take
    /// fewer instructions.)
    #[inline(never)]
    fn rare_wrench_rates<T: Real>(self, ends: &MarkerPair<T>, rates: &MarkerPairRates<T>) -> [Wrench<T>; 2] {
        let Wrench { m, f } = self.rare_wrench(&ends.moving(rates));
        number::both([1, 2], |n| Wrench { m: m.map(|x| x.0[n]), f: f.map(|x| x.0[n]) })
    }

    /// True if it depends on the axes of the markers, not only on their origins.
    pub(crate) fn has_axes(self) -> bool {
        !matches!(self, Self::Point(_) | Self::PointOnBase(_) | Self::Distance)
    }

    /// Row for a loop on a moving body, independent of the motion of its base.
    pub(crate) fn on_base(self) -> Self {
        match self {
            Self::Point(k) => Self::PointOnBase(k),
            _ => self,
        }
    }

    /// True if the residual is a length, m; otherwise it is an angle or a cosine.
    pub fn is_length(self) -> bool {
        matches!(
            self,
            Self::Point(_)
                | Self::PointOnBase(_)
                | Self::Dot2(_)
                | Self::Distance
                | Self::Offset
                | Self::Contact
                | Self::LowestPoint(_)
        )
    }

    /// Description of the row in words.
    pub fn describe(self) -> String {
        const AXIS: [&str; 3] = ["x", "y", "z"];
        match self {
            Self::Point(k) => format!("points coincide along global {}", AXIS[k]),
            Self::PointOnBase(k) => format!("points coincide along {} of the loop's base", AXIS[k]),
            Self::Dot1(a, b) => format!("Dot-1: {}_i perpendicular to {}_j", AXIS[a], AXIS[b]),
            Self::Dot2(a) => format!("Dot-2: d perpendicular to {}_i", AXIS[a]),
            Self::Distance => "distance".into(),
            Self::Angle => "angle about z_i".into(),
            Self::AngleOnJ => "angle about x_j".into(),
            Self::HeadingOnJ => "angle seen along x_j".into(),
            Self::CardanAngle => "last Cardan angle, about z_j".into(),
            Self::Heading => "angle seen along z_i".into(),
            Self::Course => "angle of z_j seen along z_i".into(),
            Self::Cosine => "Dot-1: angle between z_i and z_j".into(),
            Self::Offset => "Dot-2: displacement along z_i".into(),
            Self::Contact => "distance from the curve".into(),
            Self::ConstantVelocity => "constant velocity: no turn about the halving line".into(),
            Self::LowestPoint(_) => "height of the lowest point along z_i".into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::marker_pair::point_rates;
    use super::*;
    use crate::space::{Mat3, Pose, Twist, Vec3};

    /// All kinds of rows; add new constraints here.
    const BATTERY: [Row; 25] = [
        Row::Point(0),
        Row::Point(1),
        Row::Point(2),
        Row::Dot1(2, 0),
        Row::Dot1(2, 1),
        Row::Dot1(0, 1),
        Row::Dot1(1, 1),
        Row::Dot2(0),
        Row::Dot2(1),
        Row::Dot2(2),
        Row::Distance,
        Row::Angle,
        Row::AngleOnJ,
        Row::Heading,
        Row::Course,
        Row::Cosine,
        Row::Offset,
        Row::Contact,
        Row::ConstantVelocity,
        Row::LowestPoint(Radius::of(0.3)),
        Row::PointOnBase(0),
        Row::PointOnBase(1),
        Row::PointOnBase(2),
        Row::HeadingOnJ,
        Row::CardanAngle,
    ];

    /// Deterministic generator of numbers in (-1, 1).
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    fn moved(pose: Pose, v: Twist, a: Twist, t: f64) -> Pose {
        // X(t) with twist v and twist rate a at t = 0: the error of exp(v t + a t^2 / 2) is of order t^3.
        let turn = Mat3::from_rotation_vector(v.w * t + a.w * (0.5 * t * t));
        let p = point_rates(pose.r, v, a);
        Pose { rot: turn * pose.rot, r: p[0] + p[1] * t + p[2] * (0.5 * t * t) }
    }

    fn random_ends(row: Row, next: &mut impl FnMut() -> f64) -> MarkerPair<f64> {
        let mut v = || Vec3::new(next(), next(), next());
        let i = Pose { rot: Mat3::from_rotation_vector(v() * 2.0), r: v() };
        let mut j = Pose { rot: Mat3::from_rotation_vector(v() * 2.0), r: v() };
        match row {
            // These wrenches are valid on the constraint manifold: markers coincide, or z axes are parallel.
            Row::Point(_) | Row::PointOnBase(_) => j.r = i.r,
            Row::Angle => {
                let (s, c) = 0.7_f64.sin_cos();
                j.rot = i.rot.turned(2, s, c);
            }
            // If the axes are nearly parallel, the angle changes too fast for differences.
            Row::AngleOnJ | Row::Course => {
                let (s, c) = 0.7_f64.sin_cos();
                j.rot = i.rot.turned(2, -0.6, 0.8).turned(0, s, c);
            }
            // The same, with axes that tilt.
            Row::HeadingOnJ | Row::CardanAngle => {
                let (s, c) = 0.7_f64.sin_cos();
                j.rot = i.rot.turned(1, 0.28, 0.96).turned(2, -0.6, 0.8).turned(0, s, c);
            }
            _ => {}
        }
        MarkerPair { i, j, axes: Mat3::from_rotation_vector(Vec3::new(0.4, -0.7, 0.2)) }
    }

    #[test]
    fn wrench_is_the_gradient_of_the_residual_for_every_row() {
        let mut next = numbers(3);
        for row in BATTERY {
            for _ in 0..20 {
                let ends = random_ends(row, &mut next);
                let mut twist =
                    || Twist { w: Vec3::new(next(), next(), next()), v: Vec3::new(next(), next(), next()) };
                let (mut wi, mut wj) = (twist(), twist());
                if row == Row::Angle {
                    // Only motions that keep the z axes parallel are motions of this coordinate.
                    (wi.w, wj.w) = (ends.i.rot.cols[2] * 0.3, ends.i.rot.cols[2] * -0.9);
                }
                if row == Row::AngleOnJ {
                    // Likewise, those that keep x_j perpendicular to z_i.
                    wi.w = wj.w + ends.j.rot.cols[0] * 0.4 + ends.i.rot.cols[2] * 0.2;
                }
                let target = match row {
                    Row::Angle | Row::AngleOnJ => 0.7,
                    Row::HeadingOnJ | Row::CardanAngle | Row::Heading | Row::Course => row.value(&ends, 0.0),
                    _ => 0.1,
                };
                let rate = row.wrench(&ends).on(wj - wi);
                let error = |h: f64| {
                    let at = |h: f64| {
                        let e = MarkerPair {
                            i: moved(ends.i, wi, Twist::ZERO, h),
                            j: moved(ends.j, wj, Twist::ZERO, h),
                            ..ends
                        };
                        row.residual(&e, target)
                    };
                    ((at(h) - at(-h)) / (2.0 * h) - rate).abs()
                };
                // Central differences: the error falls by four when h halves, until round-off.
                let (coarse, fine, best) = (error(2e-3), error(1e-3), error(1e-5));
                assert!(best < 1e-9, "{row:?}: {best}");
                assert!(coarse < 1e-9 || (coarse / fine - 4.0).abs() < 0.2, "{row:?}: {coarse} {fine}");
                assert!(row.wrench(&ends).f.norm() + row.wrench(&ends).m.norm() > 1e-3, "{row:?}");
            }
        }
    }

    #[test]
    fn angles_are_measured_over_many_turns_and_differ_from_targets_by_their_residual() {
        let mut next = numbers(5);
        use Row::{Angle, AngleOnJ, CardanAngle, Course, Heading, HeadingOnJ};
        for row in [Angle, AngleOnJ, HeadingOnJ, CardanAngle, Heading, Course] {
            for turns in [-3.0, 0.0, 7.0] {
                let ends = random_ends(row, &mut next);
                let whole = 2.0 * std::f64::consts::PI * turns;
                let value = row.value(&ends, whole + 0.5);
                assert!((value - whole - 0.5).abs() <= std::f64::consts::PI);
                assert!(row.residual(&ends, value).abs() < 1e-12, "{row:?}");
                assert!((row.residual(&ends, value - 0.1) - 0.1_f64.sin()).abs() < 1e-12, "{row:?}");
            }
        }
    }

    #[test]
    fn wrench_rates_match_differences_for_every_row() {
        let mut next = numbers(11);
        for row in BATTERY {
            for _ in 0..20 {
                let ends = random_ends(row, &mut next);
                let mut twist =
                    || Twist { w: Vec3::new(next(), next(), next()), v: Vec3::new(next(), next(), next()) };
                let rates = MarkerPairRates { v_i: twist(), v_j: twist(), a_i: twist(), a_j: twist() };
                let l = |t: f64| {
                    row.wrench(&MarkerPair {
                        i: moved(ends.i, rates.v_i, rates.a_i, t),
                        j: moved(ends.j, rates.v_j, rates.a_j, t),
                        ..ends
                    })
                };
                let [l1, l2] = row.wrench_rates(&ends, &rates);
                let h = 1e-4;
                let (p, o, m) = (l(h), l(0.0), l(-h));
                let d1 = |p: Vec3, m: Vec3| (p - m) * (0.5 / h);
                let d2 = |p: Vec3, o: Vec3, m: Vec3| (p + m - o * 2.0) * (1.0 / (h * h));
                let scale = 1.0 + o.m.norm() + l1.m.norm() + l2.m.norm() + l2.f.norm();
                for (got, want, tolerance) in [
                    (l1.m, d1(p.m, m.m), 1e-6),
                    (l1.f, d1(p.f, m.f), 1e-6),
                    (l2.m, d2(p.m, o.m, m.m), 1e-5),
                    (l2.f, d2(p.f, o.f, m.f), 1e-5),
                ] {
                    assert!((got - want).norm() < tolerance * scale.powi(3), "{row:?}: {got:?} {want:?}");
                }
            }
        }
    }
}

//! Distances of all pairs of cores against samples of both, and their rates against differences.

use std::f64::consts::TAU;

use proptest::prelude::*;

use crate::number::{Jet, Rates};
use crate::space::{Mat3, Pose, Real, Vec3};

use super::circle::Circle;
use super::core::Core;
use super::nearest::{Nearest, nearest};

/// Kinds of cores that are paired with each other.
const KINDS: usize = 5;
/// Round-off of distances of about 1.
const EXACT: f64 = 1e-9;

/// A core of each kind from random numbers.
fn core_of(kind: usize, numbers: [f64; 8]) -> Core {
    let [x, y, z, u, v, w, r, s] = numbers;
    let centre = Vec3::new(x, y, z) * 2.0;
    let axis = Vec3::new(u, v, w + 1.5).unit().unwrap();
    let circle = Circle { centre, axis, radius: 0.3 + r.abs() };
    match kind {
        0 => Core::Point(centre),
        1 => Core::Segment([centre, centre + Vec3::new(u, v, w + 1.1)]),
        2 => Core::Circle(circle),
        3 => Core::Cylinder { middle: circle, half_width: 0.1 + s.abs() },
        _ => Core::HalfSpace { point: centre, normal: axis },
    }
}

/// Points of a core, surface points of a cylinder.
fn samples(core: &Core) -> Vec<Vec3> {
    let ring = |circle: &Circle, count: usize| -> Vec<Vec3> {
        let x = circle.axis.any_perpendicular();
        let y = circle.axis.cross(x);
        let at = |k: usize| {
            let (sin, cos) = (TAU * k as f64 / count as f64).sin_cos();
            circle.centre + (x * cos + y * sin) * circle.radius
        };
        (0..count).map(at).collect()
    };
    match core {
        Core::Point(p) => vec![*p],
        Core::Segment([a, b]) => (0..=100).map(|k| *a + (*b - *a) * (f64::from(k) / 100.0)).collect(),
        Core::Circle(circle) => ring(circle, 200),
        Core::Cylinder { middle, half_width } => {
            let side = (-8..=8).flat_map(|k| ring(&middle.moved(half_width * f64::from(k) / 8.0), 60));
            let caps = [-1.0, 1.0].into_iter().flat_map(|side| {
                (1..8).flat_map(move |k| {
                    let smaller = Circle { radius: middle.radius * f64::from(k) / 8.0, ..*middle };
                    ring(&smaller.moved(half_width * side), 60)
                })
            });
            side.chain(caps).collect()
        }
        Core::HalfSpace { .. } => Vec::new(),
    }
}

/// The motion that the second core makes, as a pose at a time.
fn pose_at<T: Real>(t: T) -> Pose<T> {
    let axis = Vec3::new(0.3, -0.5, 0.8).unit().unwrap();
    let r: Vec3<T> = Vec3::new(0.4, -0.3, 0.2).spread() * t + Vec3::new(-0.2, 0.5, 0.1).spread() * (t * t);
    Pose { rot: Mat3::about(axis, t * T::constant(0.7)), r }
}

fn moved<T: Real>(core: &Core, pose: Pose<T>) -> Core<T> {
    let point = |p: &Vec3| pose.point(p.spread());
    let circle = |c: &Circle| Circle {
        centre: point(&c.centre),
        axis: pose.rot * c.axis.spread(),
        radius: T::constant(c.radius),
    };
    match core {
        Core::Point(p) => Core::Point(point(p)),
        Core::Segment(ends) => Core::Segment([point(&ends[0]), point(&ends[1])]),
        Core::Circle(c) => Core::Circle(circle(c)),
        Core::Cylinder { middle, half_width } => {
            Core::Cylinder { middle: circle(middle), half_width: T::constant(*half_width) }
        }
        Core::HalfSpace { point: p, normal } => {
            Core::HalfSpace { point: point(p), normal: pose.rot * normal.spread() }
        }
    }
}

fn numbers() -> impl Strategy<Value = [f64; 8]> {
    prop::array::uniform8(-1.0..1.0)
}

/// The distance by the formula of the features that are nearest.
fn distance_of<T: Real>(near: &Nearest, cores: &[Core<T>; 2]) -> T {
    near.distance_between([0, 1].map(|k| cores[k].feature(near.features[k])))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_sample_is_nearer(a in 0..KINDS, b in 0..KINDS, p in numbers(), q in numbers()) {
        prop_assume!(a != 4 || b != 4);
        let cores = [core_of(a, p), core_of(b, q)];
        let near = nearest(&cores[0], &cores[1]);
        let back = nearest(&cores[1], &cores[0]);
        prop_assert!((near.distance - back.distance).abs() < EXACT, "{cores:?}: {near:?} {back:?}");
        let formula = distance_of(&near, &cores);
        if near.distance > 1e-3 {
            prop_assert!((formula - near.distance).abs() < EXACT, "{cores:?}: {near:?}, by formula {formula}");
            let points = (near.points[1] - near.points[0]).norm();
            prop_assert!((points - near.distance).abs() < EXACT, "{cores:?}: {near:?}");
        }
        let least = match (&cores[0], &cores[1]) {
            (Core::HalfSpace { point, normal }, other) | (other, Core::HalfSpace { point, normal }) => {
                samples(other).iter().map(|p| normal.dot(*p - *point)).fold(f64::INFINITY, f64::min)
            }
            (a, b) => {
                let others = samples(b);
                let to = |p: &Vec3| others.iter().map(|q| (*q - *p).norm()).fold(f64::INFINITY, f64::min);
                samples(a).iter().map(to).fold(f64::INFINITY, f64::min)
            }
        };
        prop_assert!(near.distance <= least + EXACT, "{cores:?}: {near:?}, sampled {least}");
        // Samples are at most so far apart; a cylinder's inside has none.
        prop_assert!(near.distance >= least - 0.35 || near.distance <= 0.0, "{cores:?}: {near:?}, sampled {least}");
    }

    #[test]
    fn rates_are_those_of_differences(a in 0..KINDS, b in 0..KINDS, p in numbers(), q in numbers()) {
        prop_assume!(a != 4 || b != 4);
        let (first, second) = (core_of(a, p), core_of(b, q));
        let at = |t: f64| nearest(&first, &moved(&second, pose_at(t)));
        let h = 1e-3;
        let near = at(0.0);
        let around: Vec<_> = [-2.0, -1.0, 1.0, 2.0].into_iter().map(|k| at(k * h)).collect();
        // Where the features change, the acceleration jumps.
        let kind = |near: &Nearest| near.features.map(|f| std::mem::discriminant(&f));
        prop_assume!(around.iter().all(|n| kind(n) == kind(&near)) && near.distance > 0.05 && !near.is_parallel);
        // Near a position in which lines or faces are parallel, higher derivatives are large.
        let axes = [direction(&first), direction(&second)];
        if let [Some(a), Some(b)] = axes {
            prop_assume!(a.cross(b).norm() > 0.2);
        }
        let side = |near: &Nearest| near.features;
        prop_assume!(around.iter().all(|n| same_place(&side(n), &side(&near))));
        let time: Rates = Jet([0.0, 1.0, 0.0]);
        let cores = [moved(&first, Pose::IDENTITY.spread()), moved(&second, pose_at(time))];
        let Jet([value, rate, acceleration]) = distance_of(&near, &cores);
        prop_assert!((value - near.distance).abs() < EXACT);
        let d: Vec<f64> = around.iter().map(|n| n.distance).collect();
        let slope = (d[0] - 8.0 * d[1] + 8.0 * d[2] - d[3]) / (12.0 * h);
        // Where two curves are nearly parallel, the fourth derivative is large, and differences are not accurate.
        let coarse = (d[0] - 2.0 * near.distance + d[3]) / (4.0 * h * h);
        let fine = (d[1] - 2.0 * near.distance + d[2]) / (h * h);
        prop_assume!((coarse - fine).abs() < 1e-4 * (1.0 + fine.abs()));
        let curve = (-d[0] + 16.0 * d[1] - 30.0 * near.distance + 16.0 * d[2] - d[3]) / (12.0 * h * h);
        // Higher derivatives of a distance grow with powers of its inverse.
        let small = near.distance.min(1.0);
        let tolerance = 1e-7 * (1.0 + rate.abs()) / small;
        prop_assert!((rate - slope).abs() < tolerance, "{first:?} {second:?} {near:?}: {rate} {slope}");
        let tolerance = 1e-6 * (1.0 + acceleration.abs()) / (small * small);
        prop_assert!((acceleration - curve).abs() < tolerance, "{first:?} {second:?} {near:?}: {acceleration} {curve}");
    }
}

/// Direction of a core that has one.
fn direction(core: &Core) -> Option<Vec3> {
    match core {
        Core::Point(_) => None,
        Core::Segment([a, b]) => (*b - *a).unit(),
        Core::Circle(circle) | Core::Cylinder { middle: circle, .. } => Some(circle.axis),
        Core::HalfSpace { normal, .. } => Some(*normal),
    }
}

/// True if both features are on the same ends and sides.
fn same_place(a: &[super::feature::Feature; 2], b: &[super::feature::Feature; 2]) -> bool {
    use super::feature::Feature::{Circle, Face, Line, Point};
    a.iter().zip(b).all(|(a, b)| match (a, b) {
        (Point(a), Point(b)) | (Circle(a), Circle(b)) | (Face(a), Face(b)) => (a - b).abs() < EXACT,
        (Line, Line) => true,
        _ => false,
    })
}

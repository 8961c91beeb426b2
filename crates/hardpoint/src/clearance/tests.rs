//! Distances of all pairs of cores against samples of both, and their rates against differences.

use std::f64::consts::TAU;

use proptest::prelude::*;

use crate::number::{Jet, Rates};
use crate::space::{Mat3, Pose, Real, Surface, Vec3};

use super::circle::Circle;
use super::core::Core;
use super::nearest::{Nearest, nearest};
use super::surface::{View, core_and_surface};

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
            (a, b) => least_distance(&samples(a), &samples(b)),
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

/// Least distance of two sets of points: millions of pairs, in tests without optimisation.
fn least_distance(a: &[Vec3], b: &[Vec3]) -> f64 {
    let mut least = f64::INFINITY;
    for p in a {
        for q in b {
            let [x, y, z] = [q.x - p.x, q.y - p.y, q.z - p.z];
            let square = x * x + y * y + z * z;
            if square < least {
                least = square;
            }
        }
    }
    least.sqrt()
}

/// A circle, and a segment, circle or cylinder that passes it nearly along its tangent, of any other size: dips of the
/// distance may be much narrower than either is long.
fn tangent_pair(kind: usize, [a, b, c, d, e, f, g, h]: [f64; 8]) -> [Core; 2] {
    // From 10^-most to 10^most.
    let power = |x: f64, most: f64| 10.0_f64.powf(x * most);
    let circle = Circle {
        centre: Vec3::new(a, b, c) * 0.5,
        axis: Vec3::new(d, e, 1.3).unit().unwrap(),
        radius: power(f, 1.0),
    };
    let out = circle.axis.any_perpendicular();
    let along = circle.axis.cross(out) + Vec3::new(g, h, a) * power(b - 1.0, 2.0);
    let near =
        circle.centre + out * circle.radius + Vec3::new(c, d, e) * (circle.radius * power(f - 1.0, 1.5));
    let (axis, size) = (along.unit().unwrap(), circle.radius * power(g, 2.0));
    let other = match kind {
        0 => Core::Segment([near - axis * (size * (1.0 + h)), near + axis * size]),
        1 => Core::Circle(Circle { centre: near - axis.any_perpendicular() * size, axis, radius: size }),
        _ => Core::Cylinder {
            middle: Circle { centre: near, axis, radius: 0.1 * circle.radius * power(h, 1.5) },
            half_width: size,
        },
    };
    [Core::Circle(circle), other]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn no_place_along_a_curve_is_nearer(kind in 0..3_usize, p in numbers(), back in any::<bool>()) {
        const PLACES: usize = 2000;
        let [circle, other] = tangent_pair(kind, p);
        let near = if back { nearest(&other, &circle) } else { nearest(&circle, &other) };
        let of = |curve: &Core, from: &Core| {
            let at = |k: usize| k as f64 / PLACES as f64;
            let place = |t: f64| match curve {
                Core::Segment([a, b]) => *a + (*b - *a) * t,
                Core::Circle(c) => {
                    let (x, (sin, cos)) = (c.axis.any_perpendicular(), (t * TAU).sin_cos());
                    c.centre + (x * cos + c.axis.cross(x) * sin) * c.radius
                }
                Core::Point(p) => *p,
                Core::Cylinder { middle, .. } => middle.centre,
                Core::HalfSpace { point, .. } => *point,
            };
            (0..=PLACES).map(|k| from.distance_from(place(at(k)))).fold(f64::INFINITY, f64::min)
        };
        let mut least = of(&circle, &other);
        if kind < 2 {
            least = least.min(of(&other, &circle));
        }
        prop_assert!(near.distance <= least + EXACT, "{circle:?} {other:?}: {near:?}, sampled {least}");
    }
}

/// Distance of a point of a plane from a line through two others.
fn beside([x, y]: [f64; 2], [[a, b], [c, d]]: [[f64; 2]; 2]) -> f64 {
    ((c - a) * (y - b) - (d - b) * (x - a)).abs() / (c - a).hypot(d - b)
}

#[test]
fn a_long_rod_over_a_small_ring_is_nearest_to_its_lower_lip() {
    let circle = Circle { centre: Vec3::new(0.0, 0.0, -3.0), axis: Vec3::new(0.0, 0.0, 1.0), radius: 10.0 };
    let ends = [Vec3::new(-480.0, 0.0, 25.0), Vec3::new(520.0, 0.0, -25.0)];
    // The rod is in a plane with the axis of the ring, whose lips are points there.
    let lips = [-10.0, 10.0].map(|x| beside([x, -3.0], ends.map(|p| [p.x, p.z])));
    for ends in [ends, [ends[1], ends[0]]] {
        let near = nearest(&Core::Segment(ends), &Core::Circle(circle));
        assert!((near.distance - lips[1]).abs() < EXACT && lips[1] < lips[0] - 0.5, "{near:?} {lips:?}");
    }
}

#[test]
fn a_rod_near_a_rim_is_as_far_as_a_capsule_and_as_a_cylinder() {
    // Nearly along the tangent of the rim.
    let ends = [Vec3::new(-1039.58694, -1117.07814, 13.38923), Vec3::new(1393.85205, 637.41957, 2.78489)];
    let disc = Circle { centre: Vec3::new(0.0, 0.0, 1.0), axis: Vec3::new(0.0, 0.0, 1.0), radius: 300.0 };
    let disc = Core::Cylinder { middle: disc, half_width: 5.0 };
    let radius = 0.5;
    let middle =
        Circle { centre: (ends[0] + ends[1]) * 0.5, axis: (ends[1] - ends[0]).unit().unwrap(), radius };
    let rod = Core::Cylinder { middle, half_width: 0.5 * (ends[1] - ends[0]).norm() };
    let as_capsule = nearest(&Core::Segment(ends), &disc).distance - radius;
    // Of samples along the rod.
    assert!((as_capsule - 1.479997).abs() < 1e-6, "{as_capsule}");
    for near in [nearest(&rod, &disc), nearest(&disc, &rod)] {
        assert!((near.distance - as_capsule).abs() < EXACT, "{near:?} {as_capsule}");
    }
}

/// A plate whose top is at z = 0, with a pin on it: a pyramid of height `tip` on a square base of half width 1.
fn plate_with_pin([x, y]: [f64; 2], tip: f64) -> Surface {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let mut points: Vec<Vec3> = [-10.0, 0.0]
        .into_iter()
        .flat_map(|z| corners.map(|[u, v]| Vec3::new(200.0 * u, 200.0 * v, z)))
        .collect();
    points.extend(corners.map(|[u, v]| Vec3::new(x + u, y + v, 0.001)));
    points.push(Vec3::new(x, y, tip));
    let mut quads = vec![[0, 3, 2, 1], [4, 5, 6, 7], [8, 11, 10, 9]];
    quads.extend((0..4).map(|k| [k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k]));
    let mut triangles: Vec<[u32; 3]> =
        quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    triangles.extend((0..4).map(|k| [8 + k, 8 + (k + 1) % 4, 12]));
    Surface::new(points, triangles)
}

#[test]
fn a_ring_over_a_plate_is_nearest_to_a_thin_pin_and_goes_through_it() {
    let ring = Circle { centre: Vec3::new(0.0, 0.0, 6.0), axis: Vec3::new(0.0, 0.0, 1.0), radius: 150.0 };
    let to_pin = |angle: f64, tip: f64| {
        let surface = plate_with_pin([150.0 * angle.cos(), 150.0 * angle.sin()], tip);
        assert!(surface.is_closed());
        core_and_surface(&Core::Circle(ring), View::Mesh(&surface)).distance
    };
    // The ring passes over the tip of each pin.
    for k in 0..40 {
        let angle = 0.157 * f64::from(k);
        let over = to_pin(angle, 5.5);
        assert!((over - 0.5).abs() < EXACT, "{angle}: {over}");
        // The axis of the pin is deepest: its faces recede by 1 over their height.
        let height = 12.0 - 0.001;
        let depth = (12.0 - 6.0) / height * height / height.hypot(1.0);
        let through = to_pin(angle, 12.0);
        assert!((through + depth).abs() < EXACT, "{angle}: {through}, -{depth}");
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

//! Tests of the synthesis: identities of its dyads, hidden linkages, invariances, defects, and a nine-point path.

use std::f64::consts::TAU;
use std::sync::atomic::{AtomicUsize, Ordering};

use proptest::prelude::*;

use super::defects::{Defect, passage};
use super::dyads::Dyad;
use super::linkage::{Guide, Linkage, LinkageType};
use super::plane::{Complex, Displacement, Pose};
use super::{Aim, Answer, Rejection, Synthesis, Task, TaskError, synthesize};

/// Lengths of cranks at all poses, relative to the size of the task: Newton's method ends at round-off.
const SAME_LENGTH: f64 = 1e-10;
/// Joints of a hidden linkage that was found, relative to its size: the condition of five poses takes some digits.
const FOUND: f64 = 1e-6;

fn at(x: f64, y: f64) -> Complex {
    Complex::new(x, y)
}

fn pose(x: f64, y: f64, degrees: f64) -> Pose {
    Pose { at: at(x, y), angle: degrees.to_radians() }
}

fn of(task: &Task) -> Synthesis {
    synthesize(task, &|| true).unwrap_or_else(|e| panic!("{e:?}"))
}

fn poses_of(poses: Vec<Pose>) -> Task {
    Task::new(Aim::Poses(poses))
}

fn path_of(points: Vec<Complex>) -> Task {
    Task::new(Aim::Path { points, is_closed: false, turns: None })
}

/// A crank-rocker whose coupler has a frame at its point P.
fn crank_rocker() -> Linkage {
    Linkage {
        a: at(0.0, 0.0),
        b: at(0.3, 0.8),
        c: at(3.1, 2.9),
        guide: Guide::Rocker(at(4.0, 0.2)),
        p: at(1.4, 3.3),
    }
}

/// Poses of the coupler at turns of the crank, as a body whose angle was 0 at first.
fn poses_at(linkage: &Linkage, turns: &[f64]) -> Vec<Pose> {
    let moved = |t: &f64| {
        let m = linkage.displacement(*t);
        Pose { at: m.of(linkage.p), angle: m.turn.angle() }
    };
    turns.iter().map(moved).collect()
}

/// Distance of the joints from those of a linkage, whichever side drives.
fn distance(found: &Linkage, hidden: &Linkage) -> f64 {
    let (a, b) = (found.joints(), hidden.joints());
    let far = |order: &[usize]| order.iter().zip(&b).map(|(k, q)| (a[*k] - *q).norm()).fold(0.0, f64::max);
    match (a.len(), b.len()) {
        (4, 4) => far(&[0, 1, 2, 3]).min(far(&[3, 2, 1, 0])),
        (3, 3) => far(&[0, 1, 2]),
        _ => f64::INFINITY,
    }
}

fn misfit(dyad: &Dyad, poses: &[Pose]) -> f64 {
    let moves: Vec<Displacement> = poses.iter().map(|p| Displacement::between(poses[0], *p)).collect();
    dyad.misfit(&moves)
}

/// Links and turns of random linkages, which may or may not assemble.
fn linkages() -> impl Strategy<Value = (Linkage, [f64; 4])> {
    let place = || (-3.0..3.0_f64, -3.0..3.0_f64).prop_map(|(x, y)| at(x, y));
    let steps = proptest::array::uniform4(0.15..0.5_f64);
    (place(), place(), place(), place(), place(), steps)
        .prop_map(|(a, b, c, d, p, steps)| (Linkage { a, b, c, guide: Guide::Rocker(d), p }, steps))
}

/// Five turns of the crank at which a linkage assembles away from its dead points.
fn five_turns(linkage: &Linkage, steps: [f64; 4]) -> Option<Vec<f64>> {
    let mut turns = vec![0.0];
    steps.iter().for_each(|s| turns.push(turns[turns.len() - 1] + s));
    let lengths = linkage.lengths();
    let links = [lengths.ground, lengths.crank, lengths.coupler, lengths.rocker?];
    let good = |t: &f64| {
        let m = linkage.displacement(*t);
        m.shift.is_finite() && linkage.branch([m.of(linkage.b), m.of(linkage.c)]).abs() > 0.15
    };
    (links.iter().all(|l| *l > 0.5) && turns.iter().all(good)).then_some(turns)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn a_hidden_four_bar_is_found_from_five_of_its_poses((hidden, steps) in linkages()) {
        let Some(turns) = five_turns(&hidden, steps) else { return Ok(()) };
        let poses = poses_at(&hidden, &turns);
        let found = of(&poses_of(poses.clone()));
        // Real dyads come in pairs.
        prop_assert!(matches!(found.cranks.len(), 2 | 4), "{}", found.cranks.len());
        for dyad in &found.cranks {
            prop_assert!(misfit(dyad, &poses) <= SAME_LENGTH * found.size.max(dyad.pin().norm()));
        }
        let Guide::Rocker(d) = hidden.guide else { unreachable!() };
        for (pivot, pin) in [(hidden.a, hidden.b), (d, hidden.c)] {
            let near = found.cranks.iter().any(|dyad| match dyad {
                Dyad::Crank { pivot: g, pin: z } => (*g - pivot).norm() + (*z - pin).norm() < FOUND * 10.0,
                Dyad::Slider { .. } => false,
            });
            prop_assert!(near, "{hidden:?} {:?}", found.cranks);
        }
        // The hidden linkage passes its poses, so that it is an answer, by either side.
        if passage(&hidden, &moves_of(&poses), false).is_ok() {
            let near = found.answers.iter().map(|a| distance(&a.linkage, &hidden)).fold(f64::INFINITY, f64::min);
            prop_assert!(near < FOUND * 10.0, "{near:e}");
        }
    }
}

fn moves_of(poses: &[Pose]) -> Vec<Displacement> {
    poses.iter().map(|p| Displacement::between(poses[0], *p)).collect()
}

/// Number of real dyads by another way: where the circle through the first three places of z passes the fourth and the
/// fifth too. Newton's method from a grid of starts finds the common zeros of the two determinants.
fn counted(poses: &[Pose]) -> usize {
    let moves = moves_of(poses);
    // Three of |w - w0|^2, w - w0 are dependent where four places are on a circle.
    let misfits = |z: Complex| {
        let w: Vec<Complex> = moves[1..].iter().map(|m| m.of(z) - z).collect();
        let on_circle = |c: Complex| {
            let [a, b] = [w[0], w[1]];
            a.square() * b.cross(c) + b.square() * c.cross(a) + c.square() * a.cross(b)
        };
        [on_circle(w[2]), on_circle(w[3])]
    };
    let mut found: Vec<Complex> = Vec::new();
    for k in 0..3600 {
        let mut z = at(f64::from(k % 60) - 29.7, f64::from(k / 60) - 29.3).times(0.35);
        let mut last = f64::INFINITY;
        for _ in 0..60 {
            const H: f64 = 1e-6;
            let [f, fx, fy] = [z, z + at(H, 0.0), z + at(0.0, H)].map(misfits);
            let [a, b] = [0, 1].map(|i| [(fx[i] - f[i]) / H, (fy[i] - f[i]) / H]);
            let det = a[0] * b[1] - a[1] * b[0];
            let step = at(f[0] * b[1] - f[1] * a[1], a[0] * f[1] - b[0] * f[0]).times(1.0 / det);
            z = z - step;
            last = step.norm();
            if !(z.norm() < 1e3) || last < 1e-10 {
                break;
            }
        }
        // Where the first three places are not apart, the circle is any: a pole, and no dyad.
        let places: Vec<Complex> = moves[..3].iter().map(|m| m.of(z)).collect();
        let is_pole = [(0, 1), (1, 2), (2, 0)].iter().any(|(i, j)| (places[*i] - places[*j]).norm() < 1e-4);
        if last < 1e-8 && z.norm() < 1e3 && !is_pole && !found.iter().any(|w| (*w - z).norm() < 1e-4) {
            found.push(z);
        }
    }
    found.len()
}

/// Five poses scattered without order.
fn scattered(number: u32) -> Vec<Pose> {
    let r = |d: u32| f64::from(sobol_burley::sample(number, d, 5));
    (0..5).map(|k| pose(4.0 * r(3 * k), 4.0 * r(3 * k + 1), 180.0 * r(3 * k + 2))).collect()
}

#[test]
fn five_poses_have_the_dyads_that_the_circles_through_them_say() {
    // Starts of the count are within 10.5 of the origin.
    const SEARCHED: f64 = 9.0;
    let mut seen = [0; 3];
    for number in 0..40 {
        let poses = scattered(number);
        let found = of(&poses_of(poses.clone()));
        for dyad in &found.cranks {
            assert!(misfit(dyad, &poses) <= SAME_LENGTH * (found.size + dyad.pin().norm()), "{dyad:?}");
        }
        // None, two or four of the four dyads are real.
        assert!(found.cranks.len().is_multiple_of(2), "{:?}", found.cranks);
        seen[found.cranks.len() / 2] += 1;
        let near = found.cranks.iter().filter(|d| d.pin().norm() < SEARCHED).count();
        let other = counted(&poses);
        assert!(near <= other && other <= found.cranks.len(), "{number}: {near} {other} {:?}", found.cranks);
    }
    assert!(seen.iter().all(|n| *n >= 5), "{seen:?}");
}

#[test]
fn a_hidden_slider_crank_is_found_from_five_of_its_poses() {
    let hidden = Linkage {
        a: at(0.5, -0.2),
        b: at(0.9, 0.7),
        c: at(3.0, 1.0),
        guide: Guide::Slider(Complex::unit(0.3)),
        p: at(2.0, 2.5),
    };
    let poses = poses_at(&hidden, &[0.0, 0.8, 1.7, 2.6, 4.0]);
    let found = of(&poses_of(poses.clone()));
    assert_eq!(found.sliders.len(), 1, "{:?}", found.sliders);
    assert!(misfit(&found.sliders[0], &poses) < SAME_LENGTH * found.size);
    let best = found.answers.iter().find(|a| distance(&a.linkage, &hidden) < FOUND).unwrap();
    assert_eq!(best.kind, LinkageType::SliderCrank);
    let Guide::Slider(along) = best.linkage.guide else { panic!("{best:?}") };
    assert!(along.cross(Complex::unit(0.3)).abs() < FOUND);
}

#[test]
fn four_poses_have_one_slider_and_a_curve_of_cranks() {
    let poses = scattered(3)[..4].to_vec();
    let found = of(&poses_of(poses.clone()));
    assert_eq!(found.sliders.len(), 1);
    assert!(found.cranks.len() > 40, "{}", found.cranks.len());
    for dyad in found.cranks.iter().chain(&found.sliders) {
        assert!(misfit(dyad, &poses) <= SAME_LENGTH * (found.size + dyad.pin().norm()), "{dyad:?}");
    }
}

#[test]
fn pivots_of_three_poses_may_be_given() {
    let poses = vec![pose(0.0, 0.0, 0.0), pose(2.0, 0.5, 30.0), pose(3.0, 2.0, 70.0)];
    let pivots = [at(1.0, -1.0), at(2.5, -0.5)];
    let found = of(&Task { fixed_pivots: pivots.to_vec(), slider_cranks: false, ..poses_of(poses.clone()) });
    assert_eq!(found.cranks.len(), 2);
    for (dyad, given) in found.cranks.iter().zip(pivots) {
        let Dyad::Crank { pivot, .. } = dyad else { panic!("{dyad:?}") };
        assert!((*pivot - given).norm() < 1e-12 && misfit(dyad, &poses) < SAME_LENGTH * found.size);
    }
    assert_eq!(found.four_bars.made, 1);
}

#[test]
fn three_poses_have_the_same_answers_in_every_unit_and_place() {
    let given = [(0.0, 0.0, 0.0), (60.0, 90.0, 25.0), (70.0, 190.0, 60.0)];
    let found = |by: f64, shift: Complex, turns: [f64; 3]| {
        let poses = given.iter().zip(turns);
        let poses = poses.map(|((x, y, a), t)| pose(by * x + shift.x, by * y + shift.y, a + 360.0 * t));
        of(&poses_of(poses.collect()))
    };
    let base = found(1e-3, Complex::ZERO, [0.0; 3]);
    assert!(base.sliders.len() > 10 && base.slider_cranks.good > 100, "{:?}", base.slider_cranks);
    let (none, moved) = (Complex::ZERO, at(0.31, -0.17));
    for (by, shift, turns) in [
        // Inches
        (1e-3 / 25.4, none, [0.0; 3]),
        (2e-3, none, [0.0; 3]),
        (1.0 / 3.0, none, [0.0; 3]),
        (1e-3, moved, [0.0; 3]),
        (1e-3, none, [0.0, 1.0, -2.0]),
    ] {
        let other = found(by, shift, turns);
        let counted = |of: &Synthesis| (of.four_bars, of.slider_cranks, of.sliders.len());
        assert_eq!(counted(&base), counted(&other), "{by} {shift:?} {turns:?}");
        let back = |p: Complex| (p - shift).times(1e-3 / by);
        for (a, b) in base.sliders.iter().zip(&other.sliders) {
            let apart = (a.pin() - back(b.pin())).norm();
            assert!(apart < FOUND * base.size, "{by} {shift:?} {turns:?}: {a:?} {b:?}");
        }
        for (a, b) in base.answers.iter().zip(&other.answers) {
            assert!((a.score - b.score).abs() < FOUND, "{by} {shift:?} {turns:?}: {} {}", a.score, b.score);
        }
    }
}

#[test]
fn dyads_move_with_their_poses() {
    let poses = scattered(4);
    let sorted = |poses: Vec<Pose>, back: &dyn Fn(Complex) -> Complex| {
        let found = of(&poses_of(poses));
        let mut all: Vec<[f64; 2]> = found
            .cranks
            .iter()
            .map(|d| match d {
                Dyad::Crank { pivot, .. } => [back(*pivot).x, back(*pivot).y],
                Dyad::Slider { .. } => unreachable!(),
            })
            .collect();
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        all
    };
    let expected = sorted(poses.clone(), &|z| z);
    assert!(!expected.is_empty());
    let same = |found: Vec<[f64; 2]>| {
        assert_eq!(found.len(), expected.len());
        let near = |(a, b): (&[f64; 2], &[f64; 2])| {
            (a[0] - b[0]).hypot(a[1] - b[1]) < FOUND * (1.0 + b[0].hypot(b[1]))
        };
        assert!(found.iter().zip(&expected).all(near), "{found:?} {expected:?}");
    };
    let unit = Complex::unit(2.1);
    let moved = |p: &Pose| Pose { at: (unit * p.at).times(25.4) + at(310.0, -70.0), angle: p.angle + 2.1 };
    same(sorted(poses.iter().map(moved).collect(), &|z| (z - at(310.0, -70.0)).over(unit).times(1.0 / 25.4)));
    same(sorted(poses.iter().rev().copied().collect(), &|z| z));
    // Another point of the body is its origin.
    let other = |p: &Pose| Pose { at: p.at + Complex::unit(p.angle) * at(1.3, -0.4), angle: p.angle };
    same(sorted(poses.iter().map(other).collect(), &|z| z));
    // The angles are counted through whole turns.
    let turned = |p: &Pose| Pose { at: p.at, angle: p.angle + TAU };
    same(sorted(
        poses.iter().enumerate().map(|(k, p)| if k == 2 { turned(p) } else { *p }).collect(),
        &|z| z,
    ));
}

/// The linkage assembled on its other branch at the same angle of the crank.
fn other_branch(of: &Linkage) -> Displacement {
    let Guide::Rocker(d) = of.guide else { panic!("a four-bar") };
    let across = d - of.b;
    let mirrored = (of.c - of.b).over(across).conjugate() * across;
    let turn = mirrored.over(of.c - of.b);
    Displacement { turn, shift: of.b - turn * of.b }
}

#[test]
fn defects_are_distinguished() {
    let with =
        |links: &Linkage, turns: &[f64]| turns.iter().map(|t| links.displacement(*t)).collect::<Vec<_>>();
    let grashof = crank_rocker();
    assert_eq!(grashof.kind(), LinkageType::CrankRocker);
    let forward = [0.0, 0.9, 1.9, 3.0, 4.4];
    let passed = passage(&grashof, &with(&grashof, &forward), false).unwrap();
    assert!(passed.is_full);
    passed.turns.iter().zip(forward).for_each(|(a, b)| assert!((a - b).abs() < 1e-12));
    // Backwards, and with a pose a turn later.
    let backward = passage(&grashof, &with(&grashof, &[0.0, -1.0, -2.5, -6.0]), false).unwrap();
    assert!((backward.turns[3] + 6.0).abs() < 1e-12);
    let around = passage(&grashof, &with(&grashof, &[0.0, 2.0, 4.0, TAU]), false).unwrap();
    assert!((around.turns[3] - TAU).abs() < 1e-9);
    let mixed = with(&grashof, &[0.0, 3.0, 0.9, 4.4, 1.9]);
    assert_eq!(passage(&grashof, &mixed, false), Err(Defect::Order));
    assert!(passage(&grashof, &mixed, true).is_ok());
    // The other branch of a crank that turns fully is another circuit, that of a rocking crank is not.
    let mut apart = with(&grashof, &[0.0, 0.5]);
    apart.push(other_branch(&grashof));
    assert_eq!(passage(&grashof, &apart, false), Err(Defect::Circuit));
    let rocking = Linkage { b: at(1.0, 2.0), c: at(2.6, 2.3), ..crank_rocker() };
    assert_eq!(rocking.kind(), LinkageType::TripleRocker);
    let mut apart = with(&rocking, &[0.0, 0.2]);
    assert!(passage(&rocking, &apart, false).is_ok());
    apart.push(other_branch(&rocking));
    assert_eq!(passage(&rocking, &apart, false), Err(Defect::Branch));
    // Crank and coupler of one length, in line with the rocker: a dead point.
    let dead = Linkage {
        a: at(0.0, 0.0),
        b: at(0.0, 1.0),
        c: at(1.0, 2.0),
        guide: Guide::Rocker(at(2.0, 3.0)),
        p: at(0.0, 0.0),
    };
    assert_eq!(passage(&dead, &[dead.displacement(0.0)], false), Err(Defect::Singular));
}

#[test]
fn ranges_and_transmission_angles_are_those_of_positions() {
    let mut seen = std::collections::BTreeSet::new();
    for number in 0..200 {
        let r = |d: u32| 4.0 * f64::from(sobol_burley::sample(number, d, 11)) - 2.0;
        let guide =
            if number % 2 == 0 { Guide::Rocker(at(r(6), r(7))) } else { Guide::Slider(Complex::unit(r(6))) };
        let linkage =
            Linkage { a: at(r(0), r(1)), b: at(r(2), r(3)), c: at(r(4), r(5)), guide, p: at(1.0, 1.0) };
        seen.insert(linkage.kind().name());
        let arcs = linkage.arcs();
        // Between output angles the end of an arc lies anywhere.
        const STEPS: usize = 720;
        let step = TAU / STEPS as f64;
        let inside = |t: f64| {
            arcs.as_ref().is_none_or(|arcs| {
                let ahead = |low: f64| (t - low).rem_euclid(TAU);
                arcs.iter().any(|[low, high]| ahead(*low) < high - low)
            })
        };
        let mut least = f64::INFINITY;
        for k in 0..STEPS {
            let turn = step * (k as f64 + 0.5);
            let m = linkage.displacement(turn);
            let ends = arcs.iter().flatten().flatten();
            let near_end = ends.clone().any(|e| (0.5 * (turn - e)).sin().abs() < 1e-6);
            assert_eq!(m.shift.is_finite(), inside(turn) || near_end, "{linkage:?} {turn}");
            if arcs.is_none() {
                let sine = linkage.branch([m.of(linkage.b), m.of(linkage.c)]);
                assert_eq!(sine.signum(), linkage.branch([linkage.b, linkage.c]).signum());
                least = least.min(sine.abs().asin());
            }
        }
        if arcs.is_none() {
            let found = linkage.transmission([0.0, TAU]);
            // The angle is smooth near its minimum, but for a corner at 0.
            assert!(found <= least + 1e-12 && least - found < 3.0 * step, "{found} {least}");
        }
    }
    assert_eq!(seen.len(), 7, "{seen:?}");
}

#[test]
fn a_hidden_path_is_found_from_nine_of_its_points() {
    let hidden = crank_rocker();
    let points = |turns: &[f64]| turns.iter().map(|t| hidden.point(*t)).collect::<Vec<_>>();
    for turns in
        [[0.0, 0.5, 1.0, 1.5, 2.2, 2.9, 3.5, 4.1, 4.6], [0.0, -0.3, -0.6, -0.9, -1.2, -1.5, -1.8, -2.1, -2.4]]
    {
        let found = of(&Task { slider_cranks: false, ..path_of(points(&turns)) });
        let best = found.answers.iter().find(|a| distance(&a.linkage, &hidden) < FOUND).expect("it is found");
        assert!(best.largest < 1e-9 * found.size, "{:e}", best.largest);
        best.passage.turns.iter().zip(turns).for_each(|(a, b)| assert!((a - b).abs() < FOUND, "{a} {b}"));
        // Its cognates have the same curve.
        let exact = found.answers.iter().filter(|a| a.largest < 1e-9 * found.size).count();
        assert!(exact >= 2, "{exact}");
    }
}

#[test]
fn a_hidden_closed_path_is_found_with_its_timing() {
    let hidden = crank_rocker();
    let turns: Vec<f64> = (0..16).map(|k| -TAU * f64::from(k) / 16.0).collect();
    let points: Vec<Complex> = turns.iter().map(|t| hidden.point(*t)).collect();
    for turns in [Some(turns.clone()), None] {
        let aim = Aim::Path { points: points.clone(), is_closed: true, turns };
        let found = of(&Task { slider_cranks: false, ..Task::new(aim) });
        let best = found.answers.iter().find(|a| distance(&a.linkage, &hidden) < FOUND).expect("it is found");
        assert!(best.passage.is_full && best.largest < 1e-9 * found.size, "{:e}", best.largest);
    }
}

/// Nine points in the documentation of HomotopyContinuation.jl (`content/examples/9point.md` of its site), which solves
/// them after Wampler, Morgan and Sommese (J. Mech. Des. 114 (1992) 153).
const NINE_POINTS: [[f64; 2]; 9] = [
    [0.8961867, -0.09802917],
    [1.2156535, -1.18749100],
    [1.5151435, -0.85449808],
    [1.6754775, -0.48768058],
    [1.7138690, -0.30099232],
    [1.7215236, 0.03269953],
    [1.6642029, 0.33241088],
    [1.4984171, 0.74435576],
    [1.3011834, 0.92153806],
];

#[test]
fn cognates_have_the_same_path() {
    let linkage = crank_rocker();
    let moves: Vec<Displacement> = (0..12).map(|k| linkage.displacement(0.5 * f64::from(k))).collect();
    let cognates = linkage.cognates(&moves);
    assert_eq!(cognates.len(), 2);
    for (cognate, own) in &cognates {
        assert!(distance(cognate, &linkage) > 0.5);
        for (m, n) in moves.iter().zip(own) {
            assert!((m.of(linkage.p) - n.of(cognate.p)).norm() < 1e-12);
        }
        // Its dyads keep their lengths.
        let Guide::Rocker(d) = cognate.guide else { panic!("a four-bar") };
        for (pivot, pin) in [(cognate.a, cognate.b), (d, cognate.c)] {
            assert!(Dyad::Crank { pivot, pin }.misfit(own) < 1e-12);
        }
    }
    // Both have the third pivot.
    let Guide::Rocker(one) = cognates[0].0.guide else { unreachable!() };
    let Guide::Rocker(other) = cognates[1].0.guide else { unreachable!() };
    assert!((one - other).norm() < 1e-12);
}

/// Smallest change of the coupler's length with which a four-bar has its guided point at a place: the circles of each
/// dyad about the fixed pivot and the place meet twice.
fn coupler_change(linkage: &Linkage, at: Complex) -> f64 {
    let Guide::Rocker(d) = linkage.guide else { panic!("a four-bar") };
    let meet = |pivot: Complex, pin: Complex| {
        let (one, other) = ((pin - pivot).norm(), (pin - linkage.p).norm());
        let f = at - pivot;
        let u = (one * one + f.square() - other * other) / (2.0 * f.square());
        let v = (one * one / f.square() - u * u).max(0.0).sqrt();
        [v, -v].map(|v| pivot + f * Complex::new(u, v))
    };
    let length = (linkage.c - linkage.b).norm();
    let (b, c) = (meet(linkage.a, linkage.b), meet(d, linkage.c));
    let pairs = b.iter().flat_map(|b| c.iter().map(move |c| ((*c - *b).norm() - length).abs()));
    pairs.fold(f64::INFINITY, f64::min)
}

#[test]
fn nine_published_points_are_met_by_four_bars_that_change_branch() {
    let points: Vec<Complex> = NINE_POINTS.iter().map(|[x, y]| at(*x, *y)).collect();
    let found = of(&Task { slider_cranks: false, ..path_of(points.clone()) });
    // A four-bar and its two cognates (Roberts)
    assert!(found.rejections.len() >= 3, "{:?}", found.rejections);
    for Rejection { linkage, defect } in &found.rejections {
        assert_eq!(*defect, Defect::Branch);
        for point in &points {
            let change = coupler_change(linkage, *point);
            assert!(change < 1e-9 * found.size, "{change:e} {linkage:?}");
        }
    }
    // Those that pass all nine in order come within 1e-5 of the path's size.
    let best = &found.answers[0];
    assert!(best.rms < 1e-5 * found.size, "{:e}", best.rms / found.size);
    let turns = &best.passage.turns;
    assert!(turns.windows(2).all(|p| p[0] < p[1]) || turns.windows(2).all(|p| p[0] > p[1]));
}

#[test]
fn tasks_without_a_synthesis_are_refused() {
    let refused = |task: &Task| synthesize(task, &|| true).expect_err("refused");
    let three = vec![pose(0.0, 0.0, 0.0), pose(2.0, 0.5, 30.0), pose(3.0, 2.0, 70.0)];
    assert_eq!(refused(&poses_of(three[..2].to_vec())), TaskError::Count(2));
    assert_eq!(
        refused(&poses_of(scattered(1).into_iter().chain(scattered(2)).collect())),
        TaskError::Count(10)
    );
    let again = vec![three[0], three[1], Pose { angle: three[0].angle + TAU, ..three[0] }];
    assert_eq!(refused(&poses_of(again)), TaskError::Coincide([0, 2]));
    let shifted = three.iter().map(|p| Pose { angle: 0.4, ..*p }).collect();
    assert_eq!(refused(&poses_of(shifted)), TaskError::Translation);
    let about = at(3.0, 1.0);
    let turned = [0.0, 0.4, 1.0].map(|t| Pose { at: about + Complex::unit(t) * at(1.0, 2.0), angle: t });
    let TaskError::OnePole(pole) = refused(&poses_of(turned.to_vec())) else { panic!("one pole") };
    assert!((pole - about).norm() < 1e-12);
    let in_place = [0.0, 0.4, 1.0].map(|t| Pose { at: about, angle: t });
    assert!(
        matches!(refused(&poses_of(in_place.to_vec())), TaskError::OnePole(at) if (at - about).norm() < 1e-12)
    );
    let line = (0..6).map(|k| at(f64::from(k), 2.0 * f64::from(k))).collect();
    assert_eq!(refused(&path_of(line)), TaskError::Line);
    assert_eq!(
        refused(&path_of(vec![at(0.0, 0.0), at(0.0, 0.0), at(1.0, 3.0)])),
        TaskError::Coincide([0, 1])
    );
    let timed = |turns: Vec<f64>| {
        let points = vec![at(0.0, 0.0), at(1.0, 0.5), at(1.0, 3.0)];
        refused(&Task::new(Aim::Path { points, is_closed: false, turns: Some(turns) }))
    };
    assert_eq!(timed(vec![0.0, 1.0]), TaskError::Turns(2));
    assert_eq!(timed(vec![0.0, 1.0, 0.5]), TaskError::TurnOrder(2));
    assert_eq!(timed(vec![0.0, 1.0, 7.0]), TaskError::TurnOrder(2));
    let none = Task { four_bars: false, slider_cranks: false, ..poses_of(three.clone()) };
    assert_eq!(refused(&none), TaskError::NoType);
    let given = Task { fixed_pivots: vec![at(0.0, 0.0)], ..poses_of(scattered(1)) };
    assert_eq!(refused(&given), TaskError::FixedPivots);
    let twice = Task { fixed_pivots: vec![at(1.0, -1.0), at(1.0, -1.0)], ..poses_of(three) };
    assert_eq!(refused(&twice), TaskError::SamePivots([0, 1]));
}

#[test]
fn an_interrupted_synthesis_has_the_answers_so_far() {
    let three = poses_of(vec![pose(0.0, 0.0, 0.0), pose(2.0, 0.5, 30.0), pose(3.0, 2.0, 70.0)]);
    let path = path_of(vec![at(0.0, 0.0), at(1.0, 0.6), at(2.0, 0.8), at(3.0, 0.4)]);
    for task in [three, path] {
        let whole = of(&task);
        let none = synthesize(&task, &|| false).unwrap_or_else(|e| panic!("{e:?}"));
        assert!(!whole.is_interrupted && none.is_interrupted && none.answers.is_empty());
        let calls = AtomicUsize::new(0);
        let until = |last: usize| synthesize(&task, &|| calls.fetch_add(1, Ordering::Relaxed) < last);
        until(usize::MAX).expect("as before");
        let part = until(calls.swap(0, Ordering::Relaxed) * 3 / 4).expect("as before");
        let made = |of: &Synthesis| of.four_bars.made + of.slider_cranks.made;
        assert!(
            part.is_interrupted && !part.answers.is_empty(),
            "{:?} {:?}",
            part.four_bars,
            part.slider_cranks
        );
        assert!(made(&part) <= made(&whole), "{} {}", made(&part), made(&whole));
    }
}

#[test]
fn regions_and_full_turns_are_respected_and_counted() {
    let poses = vec![pose(0.0, 0.0, 0.0), pose(2.0, 0.5, 30.0), pose(3.0, 2.0, 70.0)];
    let region = super::Region { x: [-1.0, 4.0], y: [-3.0, 3.0] };
    let found = of(&Task { fixed_region: Some(region), full_turn: true, ..poses_of(poses) });
    let count = |t: &super::Tally| t.defects.iter().sum::<usize>() + t.outside + t.rocking + t.good;
    assert_eq!(count(&found.four_bars), found.four_bars.made);
    assert_eq!(count(&found.slider_cranks), found.slider_cranks.made);
    assert!(!found.answers.is_empty() && found.four_bars.rocking > 0);
    let inside = |p: Complex| -1.0 <= p.x && p.x <= 4.0 && -3.0 <= p.y && p.y <= 3.0;
    for Answer { linkage, passage, .. } in &found.answers {
        assert!(passage.is_full && inside(linkage.a), "{linkage:?}");
        assert!(!matches!(linkage.guide, Guide::Rocker(d) if !inside(d)), "{linkage:?}");
    }
}

#[test]
fn regions_far_from_the_poses_have_pivots_in_them() {
    // Three and four poses; the region is ten sizes away.
    let three = vec![pose(0.0, 0.0, 0.0), pose(10.0, 0.0, 20.0), pose(20.0, 5.0, 45.0)];
    let region = super::Region { x: [95.0, 115.0], y: [95.0, 115.0] };
    let task = Task { fixed_region: Some(region), slider_cranks: false, ..poses_of(three.clone()) };
    let found = of(&task);
    assert!(!found.answers.is_empty(), "{:?}", found.four_bars);
    for answer in &found.answers {
        let Guide::Rocker(d) = answer.linkage.guide else { panic!("a four-bar") };
        assert!(region.has(answer.linkage.a) && region.has(d), "{:?}", answer.linkage);
        // Pins are where the cranks about these pivots have them, as with given pivots.
        let given =
            Task { fixed_pivots: vec![answer.linkage.a, d], slider_cranks: false, ..poses_of(three.clone()) };
        let same = of(&given);
        let near = same.answers.iter().any(|a| distance(&a.linkage, &answer.linkage) < FOUND);
        assert!(near, "{:?}", answer.linkage);
    }
    // Of four poses of a crank-rocker seen from far away, a region around its pivots has cranks.
    let hidden = crank_rocker();
    let four = poses_at(&hidden, &[0.0, 0.02, 0.05, 0.09]);
    let size = (four[3].at - four[0].at).norm();
    let near = |x: f64| [x - 0.1, x + 0.1];
    assert!((hidden.a - four[0].at).norm() > 5.0 * size, "{size}");
    let task = |region| Task { fixed_region: region, slider_cranks: false, ..poses_of(four.clone()) };
    let around = super::Region { x: near(hidden.a.x), y: near(hidden.a.y) };
    assert!(!of(&task(Some(around))).cranks.is_empty());
}

//! Independent loops are solved one after another.

use hardpoint::motion::Execution;
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run};
use hardpoint::{draft::*, model::*};
use hardpoint_study::Comparison;
use hardpoint_study::difference::{DifferenceScheme, finite_differences};

use crate::workbench::*;

/// Relative to 1: a position, an orientation, a speed; accelerations divide by squares of times.
const ROUND_OFF: f64 = 1e-10;

/// N parallelograms side by side: upright unit bars on pivots at (i, 0), unit couplers on top; the first bar
/// swings by 0.5 sin(2 pi t).
fn chain(n: usize) -> Draft {
    let z = Some([0.0, 0.0, 1.0]);
    let bar = |k: usize| format!("bar{k}");
    let coupler = |k: usize| format!("coupler{k}");
    let mut joints = Vec::new();
    for k in 0..=n {
        let x = k as f64;
        joints.push(joint(&format!("pivot{k}"), "revolute", ["ground", &bar(k)], &[[x, 0.0, 0.0]], z));
        if k < n {
            let ends = [x, x + 1.0].map(|x| [x, 1.0, 0.0]);
            joints.push(joint(&format!("left{k}"), "revolute", [&bar(k), &coupler(k)], &[ends[0]], z));
            joints.push(joint(&format!("right{k}"), "revolute", [&coupler(k), &bar(k + 1)], &[ends[1]], z));
        }
    }
    Draft {
        name: "chain".into(),
        bodies: (0..=n).map(bar).chain((0..n).map(coupler)).map(|name| body(&name)).collect(),
        joints,
        drivers: vec![driver("motor", "pivot0", "0.5*sin(2*pi*t)")],
        times: times(1.0, 20),
        ..Draft::default()
    }
}

#[test]
fn a_chain_of_four_bars_is_solved_loop_by_loop_and_matches_its_closed_form() {
    let n = 100;
    let model = Model::from_draft(&chain(n)).unwrap();
    let analysis = Analysis::new(&model).unwrap();
    let topology = analysis.topology();
    assert_eq!(topology.blocks.len(), n);
    assert!(topology.blocks.iter().all(|b| b.unknowns.len() == 2));
    assert_eq!(topology.redundant().count(), 3 * n);
    let solution = analysis.run();
    assert!(solution.stop.is_none());
    for (k, &t) in solution.motion.times.iter().enumerate() {
        let w = 2.0 * std::f64::consts::PI;
        let (angle, rate) = (0.5 * (w * t).sin(), 0.5 * w * (w * t).cos());
        let acceleration = -0.5 * w * w * (w * t).sin();
        let (s, c) = angle.sin_cos();
        for i in 0..=n {
            // A bar's frame is in its middle; its ends carry two joints on top, so weigh those.
            let state = solution.motion.at(k).body(1 + i);
            let middle = model.bodies[1 + i].frame.r - Vec3::new(i as f64, 0.0, 0.0);
            let want = Vec3::new(i as f64 - s * middle.y, c * middle.y, 0.0);
            assert!(apart(state.r, want) < 1e-12, "bar {i} at {t}");
            let want =
                Vec3::new(-c * acceleration + s * rate * rate, -s * acceleration - c * rate * rate, 0.0);
            assert!(apart(state.a, want * middle.y) < 1e-9, "bar {i} at {t}");
        }
        for i in 0..n {
            let state = solution.motion.at(k).body(2 + n + i);
            assert!(state.omega.norm() < 1e-11 && state.alpha.norm() < 1e-9, "coupler {i} at {t}");
        }
    }
}

#[test]
fn loops_that_share_their_code_move_as_the_kernel_moves_them() {
    // Bars of slightly different heights (each loop transmits a little more or less of the swing) on scattered pivots,
    // in two orders of the bodies; long enough for a program in pieces.
    let n = 80;
    let mut draft = chain(n);
    for joint in &mut draft.joints {
        let number: usize = joint.name.trim_matches(char::is_alphabetic).parse().unwrap();
        for place in &mut joint.at {
            let LocationDraft::At(at) = place else { unreachable!() };
            let next = number + usize::from(joint.name.starts_with("right"));
            at.x += 0.1 * (next as f64).sin();
            at.y *= 1.0 + 1e-3 * (2.0 * next as f64).cos();
        }
    }
    draft.times = times(1.0, 160);
    let mut shuffled = draft.clone();
    shuffled.bodies.sort_by_key(|b| b.name.trim_matches(char::is_alphabetic).parse::<usize>().unwrap());
    for draft in [draft, shuffled] {
        let model = Model::from_draft(&draft).unwrap();
        let run = |execution| {
            Analysis::new(&model)
                .unwrap()
                .executed(execution)
                .solve(Run::new().without_sensitivities().without_measures())
        };
        let right = run(Execution::Kernel);
        assert!(right.stop.is_none());
        for execution in [Execution::Interpreted, Execution::Compiled] {
            let found = run(execution);
            assert!(found.motion.effort.by_program > 100, "{}", found.motion.effort.by_program);
            for (a, b) in found.motion.states().zip(right.motion.states()) {
                assert!(apart(a.r, b.r) < ROUND_OFF && apart(a.v, b.v) < ROUND_OFF);
                assert!(apart(a.a, b.a) < 100.0 * ROUND_OFF && apart(a.alpha, b.alpha) < 100.0 * ROUND_OFF);
            }
        }
    }
}

#[test]
fn absolute_coordinates_of_a_chain_give_the_same() {
    let model = Model::from_draft(&chain(4)).unwrap();
    let relative = Analysis::new(&model).unwrap().run();
    let absolute = Analysis::with(&model, Formulation::Absolute).unwrap().run();
    for (a, b) in relative.motion.states().zip(absolute.motion.states()) {
        assert!(apart(a.r, b.r) < 1e-12 && apart(a.a, b.a) < 1e-10);
    }
}

/// A strip of n nodes, each tied by rods to the two before, that turns about node 0 (on ground) as one rigid
/// body while a leg of length 1 pushes at its last node: none of the unknowns can be found before the others.
pub fn truss(n: usize) -> (Draft, impl Fn(usize) -> [f64; 2]) {
    let at = |k: usize| [0.5 * k as f64, 0.8 * (k % 2) as f64];
    let place = move |k: usize| [at(k)[0], at(k)[1], 0.0];
    let node = |k: usize| if k == 0 { "ground".to_owned() } else { format!("node{k}") };
    let (mut bodies, mut joints) = (Vec::new(), Vec::new());
    for k in 1..n {
        let (slider, this) = (format!("slider{k}"), node(k));
        bodies.extend([body(&slider), body(&this)]);
        let (x, y) = (Some([1.0, 0.0, 0.0]), Some([0.0, 1.0, 0.0]));
        joints.push(joint(&format!("x{k}"), "translational", ["ground", &slider], &[place(k)], x));
        joints.push(joint(&format!("y{k}"), "translational", [&slider, &this], &[place(k)], y));
        for other in k.saturating_sub(2)..k {
            let ends = [place(other), place(k)];
            joints.push(joint(&format!("rod{other}_{k}"), "distance", [&node(other), &this], &ends, None));
        }
    }
    let tip = place(n - 1);
    let foot = [tip[0], tip[1] - 1.0, 0.0];
    joints.push(joint("push", "leg", ["ground", &node(n - 1)], &[foot, tip], None));
    let draft = Draft {
        name: "truss".into(),
        bodies,
        joints,
        drivers: vec![driver("motor", "push", "0.1*sin(2*pi*t)")],
        design: [("tip", n - 1, 1.0), ("middle", n / 2, -1.0)].map(|(name, k, y)| moves(name, k, y)).into(),
        times: times(0.3, 3),
        ..Draft::default()
    };
    (with_hardpoints(draft, n, &place), at)
}

/// The variable that moves node k up by y.
fn moves(name: &str, k: usize, y: f64) -> VariableDraft {
    let velocity = Vec3::new(0.0, y, 0.0);
    let changes = vec![ChangeDraft::Move { hardpoint: format!("p{k}"), velocity }];
    VariableDraft::new(name, changes)
}

/// The same with the places of nodes as hardpoints `p0`, `p1`, ..., so that variables may move them.
fn with_hardpoints(mut draft: Draft, n: usize, place: &dyn Fn(usize) -> [f64; 3]) -> Draft {
    draft.hardpoints = (0..n).map(|k| HardpointDraft::new(format!("p{k}"), place(k))).collect();
    for at in draft.joints.iter_mut().flat_map(|j| &mut j.at) {
        let LocationDraft::At(p) = *at else { continue };
        if let Some(k) = (0..n).find(|&k| Vec3::from(place(k)) == p) {
            *at = LocationDraft::Hardpoint(format!("p{k}"));
        }
    }
    draft
}

/// The angle by which the truss has turned while its leg is longer by f: the tip is on a circle about node 0, and
/// 1 + f away from the foot of the leg.
fn turned(tip: [f64; 2], f: f64) -> f64 {
    let (radius, foot) = (tip[0].hypot(tip[1]), [tip[0], tip[1] - 1.0]);
    let base = foot[0].hypot(foot[1]);
    let between = ((radius * radius + base * base - (1.0 + f).powi(2)) / (2.0 * radius * base)).acos();
    foot[1].atan2(foot[0]) + between - tip[1].atan2(tip[0])
}

#[test]
fn a_coupled_truss_of_any_size_turns_as_one_body() {
    // 18 unknowns are factored densely, 198 sparsely.
    for n in [10, 100] {
        let (draft, at) = truss(n);
        let model = Model::from_draft(&draft).unwrap();
        let analysis = Analysis::new(&model).unwrap();
        let blocks = &analysis.topology().blocks;
        assert_eq!(blocks.iter().map(|b| b.unknowns.len()).collect::<Vec<_>>(), [2 * (n - 1)]);
        let solution = analysis.run();
        assert!(solution.stop.is_none(), "{:?}", solution.stop);
        for (step, &t) in solution.motion.times.iter().enumerate() {
            let (s, c) = turned(at(n - 1), 0.1 * (2.0 * std::f64::consts::PI * t).sin()).sin_cos();
            for k in 1..n {
                let state = solution.motion.at(step).body(2 * k);
                let moved = state.r - model.bodies[2 * k].frame.r;
                let [x, y] = at(k);
                let want = Vec3::new(c * x - s * y - x, s * x + c * y - y, 0.0);
                assert!(apart(moved, want) < 1e-10, "{n} nodes, node {k} at {t}: {moved:?}, {want:?}");
            }
        }
        let steps = [(VariableId(0), 1e-4), (VariableId(1), 1e-4)];
        for difference in finite_differences(&analysis, &solution, DifferenceScheme::Central, &steps) {
            let difference = difference.unwrap();
            let comparison = Comparison::of(&model, &solution, &difference);
            let worst = comparison.worst().unwrap();
            assert!(worst.error < 1e-5, "{n} nodes, variable {}: {worst:?}", difference.variable.0);
        }
    }
}

#[test]
fn ten_thousand_loops_are_planned_in_proportion_and_move_like_one() {
    let plan = |n: usize| {
        let mut draft = chain(n);
        draft.times = times(0.1, 2);
        let model = Model::from_draft(&draft).unwrap();
        let analysis = Analysis::new(&model).unwrap();
        let t = analysis.topology();
        let entries: usize = t.closures.iter().map(|c| c.entries.len() + c.links.len()).sum();
        let largest = t.blocks.iter().map(|b| b.unknowns.len()).max().unwrap();
        let counts = [t.blocks.len(), t.unknowns(), t.rows.len(), t.redundant().count(), entries];
        let motion = analysis.solve(Run::new().without_sensitivities().without_measures());
        assert!(motion.stop.is_none());
        // What is one bar's motion is every bar's; the couplers stay level.
        let states = motion.motion.at(2);
        (counts, largest, [1, n, 1 + n].map(|b| states.body(b)).map(|s| (s.omega, s.alpha)))
    };
    let (one, two, many) = (plan(1), plan(2), plan(10_000));
    assert_eq!(many.1, one.1, "the largest block");
    for k in 0..5 {
        let per_loop = two.0[k] - one.0[k];
        assert_eq!(many.0[k], one.0[k] + 9_999 * per_loop, "count {k}");
    }
    for bar in many.2 {
        assert!(
            apart(bar.0, one.2[0].0) < 1e-9 && apart(bar.1, one.2[0].1) < 1e-7,
            "{bar:?}, {:?}",
            one.2[0]
        );
    }
}

/// Blocks that are factored sparsely are recorded as others are.
#[test]
fn large_blocks_run_as_programs_that_agree_with_the_kernel() {
    for (name, draft, end) in [
        ("30 nodes", truss(30).0, 0.3),
        ("100 nodes", truss(100).0, 0.3),
        ("scissors", scissors(8, 8, [7, 7]), 0.05),
    ] {
        let model = Model::from_draft(&Draft { times: times(end, 80), ..draft }).unwrap();
        let solve = |execution| {
            Analysis::new(&model).unwrap().executed(execution).solve(Run::new().without_measures()).motion
        };
        let right = solve(Execution::Kernel);
        assert_eq!((right.len(), right.effort.by_program), (81, 0));
        for execution in [Execution::Interpreted, Execution::Compiled] {
            let again = solve(execution);
            assert!(again.effort.by_program >= 64, "{name}, {execution:?}: {:?}", again.effort);
            for (found, want) in again.states().zip(right.states()) {
                let apart = [apart(found.r, want.r), apart(found.v, want.v), apart(found.a, want.a)];
                // Lengths are up to 50, speeds 30, accelerations 200.
                assert!(apart[0] < 1e-10 && apart[1] < 1e-9 && apart[2] < 1e-8, "{name}: {apart:?}");
            }
        }
    }
}

/// n x m scissors of unit cells, pinned to each other at their corners; the first one is on the ground, and the one at
/// `at` is driven open.
fn scissors(n: usize, m: usize, at: [usize; 2]) -> Draft {
    let z = Some([0.0, 0.0, 1.0]);
    let (mut bodies, mut joints) = (Vec::new(), Vec::new());
    let mut at_corner: std::collections::BTreeMap<(usize, usize), Vec<String>> = Default::default();
    for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))) {
        let (up, down) = (format!("up{i}_{j}"), format!("down{i}_{j}"));
        for (corner, bar) in [((i, j), &up), ((i + 1, j + 1), &up), ((i, j + 1), &down), ((i + 1, j), &down)]
        {
            at_corner.entry(corner).or_default().push(bar.clone());
        }
        let centre = [i as f64 + 0.5, j as f64 + 0.5, 0.0];
        joints.push(joint(&format!("cross{i}_{j}"), "revolute", [&up, &down], &[centre], z));
        bodies.extend([body(&up), body(&down)]);
    }
    joints.push(joint("base", "fixed", ["ground", "up0_0"], &[[0.0; 3]], None));
    for ((i, j), bars) in at_corner {
        for (k, bar) in bars.iter().enumerate().skip(1) {
            let at = [i as f64, j as f64, 0.0];
            joints.push(joint(&format!("pin{i}_{j}_{k}"), "revolute", [&bars[0], bar], &[at], z));
        }
    }
    Draft {
        name: "scissors".into(),
        bodies,
        joints,
        drivers: vec![driver("motor", &format!("cross{}_{}", at[0], at[1]), "0.3*sin(2*pi*t)")],
        times: times(0.3, 3),
        ..Draft::default()
    }
}

#[test]
fn a_grid_of_scissors_opens_as_lazy_tongs_do() {
    let largest = opens_as_lazy_tongs_do(12, [0, 0], 1e-10);
    assert_eq!(largest, 2, "driven where it is");
}

#[test]
fn a_grid_of_scissors_that_is_driven_at_its_other_end_is_one_block() {
    for n in [3, 8, 20] {
        // Every loop is on others that follow from it.
        let largest = opens_as_lazy_tongs_do(n, [n - 1, n - 1], 1e-10);
        assert_eq!(largest, 2 * n * n - 2);
    }
}

/// Solves n x n scissors and compares with their closed form; the size of the largest block.
fn opens_as_lazy_tongs_do(n: usize, at: [usize; 2], tolerance: f64) -> usize {
    let model = Model::from_draft(&scissors(n, n, at)).unwrap();
    let analysis = Analysis::new(&model).unwrap();
    let solution = analysis.run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    for (step, &t) in solution.motion.times.iter().enumerate() {
        // The rising bars are parallel to the first, which is fixed; the falling ones are all turned by f. The
        // crossing of unit (i, j) is (i + j + 1) halves of the one and (i - j) halves of the other from the corner.
        let f = 0.3 * (2.0 * std::f64::consts::PI * t).sin();
        let (s, c) = f.sin_cos();
        for i in 0..n {
            for j in 0..n {
                let (rise, fall) = (0.5 * (i + j + 1) as f64, 0.5 * (i as f64 - j as f64));
                let centre = Vec3::new(rise + fall * (c + s), rise + fall * (s - c), 0.0);
                let body = 1 + 2 * (i * n + j);
                let (up, down) =
                    (solution.motion.at(step).body(body), solution.motion.at(step).body(body + 1));
                assert!(
                    apart(up.rotation.cols[0], Vec3::new(1.0, 0.0, 0.0)) < tolerance,
                    "up {i} {j} at {t}"
                );
                assert!(
                    apart(down.rotation.cols[0], Vec3::new(c, s, 0.0)) < tolerance,
                    "down {i} {j} at {t}"
                );
                // f turns the falling bars alone, and their acceleration is that of f.
                let w = 2.0 * std::f64::consts::PI;
                let z = Vec3::new(0.0, 0.0, 1.0);
                let turns = [(w * (w * t).cos(), down.omega), (-w * w * (w * t).sin(), down.alpha)];
                for (rate, found) in turns {
                    assert!(apart(found, z * (0.3 * rate)) < 100.0 * tolerance, "{i} {j} at {t}: {found:?}");
                }
                assert!(apart(up.alpha, Vec3::ZERO) < 100.0 * tolerance, "{i} {j} at {t}: {:?}", up.alpha);
                for state in [up, down].iter().zip(body..) {
                    let offset =
                        Vec3::new(i as f64 + 0.5, j as f64 + 0.5, 0.0) - model.bodies[state.1].frame.r;
                    let crossing = state.0.r + state.0.rotation * offset;
                    assert!(
                        apart(crossing, centre) < tolerance,
                        "crossing {i} {j} at {t}: {crossing:?}, {centre:?}"
                    );
                }
            }
        }
    }
    analysis.topology().blocks.iter().map(|b| b.unknowns.len()).max().unwrap()
}

#[test]
fn a_loop_on_a_body_that_depends_on_it_is_solved() {
    // A telescope turns about the origin; a ram sets its length, and a rod from ground to its tip then sets its angle.
    let z = Some([0.0, 0.0, 1.0]);
    let mut draft = Draft {
        name: "telescope".into(),
        bodies: ["base", "arm"].map(body).into(),
        joints: vec![
            joint("pivot", "revolute", ["ground", "base"], &[[0.0; 3]], z),
            joint("slide", "translational", ["base", "arm"], &[[0.1, 0.0, 0.0]], Some([1.0, 0.0, 0.0])),
            joint("ram", "leg", ["base", "arm"], &[[0.0, 0.1, 0.0], [0.4, 0.1, 0.0]], None),
            joint("rod", "distance", ["ground", "arm"], &[[0.5, -0.3, 0.0], [0.5, 0.0, 0.0]], None),
        ],
        drivers: vec![driver("ram", "ram", "0.1*sin(t)")],
        times: times(1.0, 5),
        ..Draft::default()
    };
    draft.points.push(PointDraft::new("tip", "arm", [0.5, 0.0, 0.0]));
    let model = Model::from_draft(&draft).unwrap();
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let solution = Analysis::with(&model, formulation).unwrap().run();
        assert!(solution.stop.is_none(), "{formulation:?}: {:?}", solution.stop);
        let [x, y] = ["tip.x", "tip.y"].map(|m| solution.measured.index(m).unwrap());
        for (k, t) in solution.motion.times.iter().enumerate() {
            let [[x, vx, _], [y, vy, _]] = [x, y].map(|m| solution.measured.value(k, m));
            let length = 0.5 + 0.1 * t.sin();
            assert!((x.hypot(y) - length).abs() < 1e-12 && ((x - 0.5).hypot(y + 0.3) - 0.3).abs() < 1e-12);
            assert!(((x * vx + y * vy) / length - 0.1 * t.cos()).abs() < 1e-12);
        }
    }
}

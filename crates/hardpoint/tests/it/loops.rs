//! Independent loops are solved one after another.

use hardpoint::Analysis;
use hardpoint::model::*;
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;

use crate::workbench::*;

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
            let state = solution.motion.at(k)[1 + i];
            let middle = model.bodies[1 + i].frame.r - Vec3::new(i as f64, 0.0, 0.0);
            let want = Vec3::new(i as f64 - s * middle.y, c * middle.y, 0.0);
            assert!(apart(state.r, want) < 1e-12, "bar {i} at {t}");
            let want =
                Vec3::new(-c * acceleration + s * rate * rate, -s * acceleration - c * rate * rate, 0.0);
            assert!(apart(state.a, want * middle.y) < 1e-9, "bar {i} at {t}");
        }
        for i in 0..n {
            let state = solution.motion.at(k)[2 + n + i];
            assert!(state.omega.norm() < 1e-11 && state.alpha.norm() < 1e-9, "coupler {i} at {t}");
        }
    }
}

#[test]
fn absolute_coordinates_of_a_chain_give_the_same() {
    let model = Model::from_draft(&chain(4)).unwrap();
    let relative = Analysis::new(&model).unwrap().run();
    let absolute = Analysis::with(&model, Formulation::Absolute).unwrap().run();
    for (a, b) in relative.motion.states.iter().zip(&absolute.motion.states) {
        assert!(apart(a.r, b.r) < 1e-12 && apart(a.a, b.a) < 1e-10);
    }
}

#[test]
fn a_loop_that_rides_on_a_body_which_depends_on_it_is_solved_where_it_stands() {
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
    draft.points.push(PointDraft {
        name: "tip".into(),
        body: "arm".into(),
        at: Place::At([0.5, 0.0, 0.0].into()),
    });
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

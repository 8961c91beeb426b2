//! Identities: formulations, lanes, moved and rotated mechanisms, swapped bodies.

use hardpoint::space::{Mat3, Pose, Vec3};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run, Solution};
use hardpoint::{draft::*, model::*};

use crate::workbench::*;

/// Largest relative difference of all body states and sensitivities of two solutions.
fn difference(a: &Solution, b: &Solution) -> f64 {
    assert_eq!(a.motion.times, b.motion.times);
    let state = |s: &hardpoint::motion::BodyState| {
        [s.r, s.v, s.omega, s.a, s.alpha, s.rotation.cols[0], s.rotation.cols[1]]
    };
    let sensitivity =
        |s: &hardpoint::sensitivity::BodySensitivity| [s.dr, s.dpi, s.dv, s.domega, s.da, s.dalpha];
    let mut most = 0.0_f64;
    let mut compare = |x: &[Vec3], y: &[Vec3], scale: &mut [f64]| {
        for (k, (x, y)) in x.iter().zip(y).enumerate() {
            scale[k] = scale[k].max(x.norm());
            most = most.max((*x - *y).norm() / scale[k]);
        }
    };
    let mut scale = [1.0; 7];
    for (x, y) in a.motion.states().zip(b.motion.states()) {
        compare(&state(&x), &state(&y), &mut scale);
    }
    let mut scale = [1.0; 6];
    for k in 0..a.motion.len() {
        for v in 0..a.sensitivities.variables {
            if let (Some(x), Some(y)) = (a.sensitivities.at(k, v), b.sensitivities.at(k, v)) {
                for (x, y) in x.iter().zip(y.iter()) {
                    compare(&sensitivity(&x), &sensitivity(&y), &mut scale);
                }
            }
        }
    }
    most
}

#[test]
fn absolute_and_relative_coordinates_agree_on_every_mechanism() {
    for name in REFERENCES {
        let model = reference(name);
        let relative = Analysis::new(&model).unwrap().run();
        let absolute = Analysis::with(&model, Formulation::Absolute).unwrap().run();
        assert!(relative.stop.is_none() && absolute.stop.is_none(), "{name}");
        let d = difference(&relative, &absolute);
        assert!(d < 1e-10, "{name}: {d:e}");
        for (r, a) in relative.sensitivities.admissibility.iter().zip(&absolute.sensitivities.admissibility) {
            assert_eq!(std::mem::discriminant(r), std::mem::discriminant(a), "{name}: {r:?} {a:?}");
        }
    }
}

/// Bit by bit: positions, velocities and accelerations.
fn bits(s: &Solution) -> Vec<u64> {
    let vectors = s.motion.states().flat_map(|s| [s.r, s.rotation.cols[0], s.v, s.omega, s.a, s.alpha]);
    vectors.flat_map(|v| v.to_array().map(f64::to_bits)).collect()
}

#[test]
fn threads_used_memory_and_streams_change_no_bit() {
    let model = Model::from_draft(&reference_draft("macpherson")).unwrap();
    let analysis = Analysis::new(&model).unwrap();
    let designs: Vec<Vec<f64>> = (0..21).map(|k| vec![1e-4 * f64::from(k), -2e-5 * f64::from(k)]).collect();
    let motions = || Run::new().without_sensitivities().without_measures();
    let mut one_by_one = Vec::new();
    analysis.solve_designs(motions(), &designs, |k, s| {
        assert_eq!(k, one_by_one.len());
        one_by_one.push(bits(s));
    });
    assert_eq!(one_by_one.len(), designs.len());
    for threads in [1, 3] {
        let mut seen = vec![Vec::new(); designs.len()];
        let threads = std::num::NonZero::new(threads).unwrap();
        // What is taken away is not missed.
        analysis
            .solve_designs(motions().threads(threads), &designs, |k, s| seen[k] = bits(&std::mem::take(s)));
        assert_eq!(seen, one_by_one);
    }

    // Memory of another mechanism's solution.
    let other = Model::from_draft(&reference_draft("slider_crank")).unwrap();
    let mut used = Analysis::new(&other).unwrap().run();
    let fresh = analysis.solve(Run::new().without_measures());
    for _ in 0..2 {
        used = analysis.solve(Run::new().without_measures().reusing(used));
        assert_eq!(bits(&used), bits(&fresh));
        assert!(used.motion.states().eq(fresh.motion.states()));
        let derivatives = |s: &Solution| -> Vec<_> {
            let all = (0..s.motion.len()).flat_map(|k| (0..s.sensitivities.variables).map(move |v| (k, v)));
            all.flat_map(|(k, v)| s.sensitivities.at(k, v).into_iter().flat_map(|d| d.iter())).collect()
        };
        assert_eq!(derivatives(&used), derivatives(&fresh));
        assert_eq!(used.motion.at(0).body(0), hardpoint::motion::BodyState::at_design(&model, GROUND));
    }

    struct Compare<'s>(&'s Solution, usize);
    impl hardpoint::Sink for Compare<'_> {
        fn wants(&self, body: BodyId) -> bool {
            body.0 != 2
        }
        fn state(&mut self, k: usize, body: BodyId, state: &hardpoint::motion::BodyState) {
            assert_eq!(&self.0.body(k, body), state);
            assert!(body.0 != 2);
            self.1 += 1;
        }
        fn sensitivity(
            &mut self,
            k: usize,
            variable: VariableId,
            body: BodyId,
            d: &hardpoint::sensitivity::BodySensitivity,
        ) {
            assert_eq!(&self.0.sensitivities.at(k, variable.0).unwrap().body(body.0), d);
            assert!(body.0 != 2);
        }
    }
    let mut compare = Compare(&fresh, 0);
    let streamed = analysis.stream(Run::new(), &mut compare);
    assert_eq!(compare.1, model.times.len() * (model.bodies.len() - 2));
    assert_eq!((streamed.steps, streamed.stop), (model.times.len(), None));
    assert_eq!(streamed.admissibility, fresh.sensitivities.admissibility);
}

/// Counts what it gets of some output times.
#[derive(Default)]
struct Count {
    states: usize,
    sensitivities: usize,
}

impl hardpoint::Sink for Count {
    fn state(&mut self, _: usize, _: BodyId, _: &hardpoint::motion::BodyState) {
        self.states += 1;
    }
    fn sensitivity(
        &mut self,
        _: usize,
        _: VariableId,
        _: BodyId,
        _: &hardpoint::sensitivity::BodySensitivity,
    ) {
        self.sensitivities += 1;
    }
}

#[test]
fn a_request_has_the_same_results_in_all_run_modes() {
    let model = Model::from_draft(&reference_draft("macpherson")).unwrap();
    let analysis = Analysis::new(&model).unwrap();
    let design = [1e-3, -5e-4, 2e-4];
    let whole = analysis.solve(Run::new().at(&design));
    let (steps, moving, variables) = (model.times.len(), model.bodies.len() - 1, model.variables.len());
    assert!(difference(&whole, &analysis.run()) > 1e-6, "another design");

    // Window by window.
    let mut seen = Vec::new();
    analysis.solve_in_windows(Run::new().at(&design), 1, |_, window| seen.extend(bits(window)));
    assert_eq!(seen, bits(&whole));

    // Among other designs, with the request.
    let designs = [vec![], design.to_vec(), vec![0.0; variables]];
    let mut visited = Vec::new();
    analysis.solve_designs(Run::new(), &designs, |k, solution| {
        visited.push(k);
        assert_eq!(solution.measured.outputs.len(), whole.measured.outputs.len());
        if k == 1 {
            assert!(difference(solution, &whole) < 1e-10);
            let at_end = |s: &Solution| s.measured.d(steps - 1, VariableId(0), 0);
            assert!((at_end(solution)[0] - at_end(&whole)[0]).abs() < 1e-10);
        }
    });
    assert_eq!(visited, [0, 1, 2]);
    analysis.solve_designs(Run::new().without_sensitivities().without_measures(), &designs, |k, solution| {
        assert!(solution.measured.outputs.is_empty() && solution.sensitivities.variables == 0);
        assert!(k != 1 || difference(solution, &whole) < 1e-11);
    });

    // Into sinks, one design or many.
    let mut count = Count::default();
    let streamed = analysis.stream(Run::new().at(&design).without_sensitivities(), &mut count);
    assert_eq!((count.states, count.sensitivities), (steps * moving, 0));
    assert!(streamed.admissibility.is_empty() && streamed.stop.is_none());
    for (run, per_step) in [(Run::new(), true), (Run::new().without_sensitivities(), false)] {
        let all: usize = (0..variables)
            .map(|v| (1..=moving).filter(|b| whole.sensitivities.moves(VariableId(v), BodyId(*b))).count())
            .sum();
        let mut ended = 0;
        analysis.stream_designs(
            run,
            &designs,
            |_| Count::default(),
            |_, count, streamed| {
                assert_eq!(
                    (count.states, count.sensitivities),
                    (steps * moving, if per_step { steps * all } else { 0 })
                );
                assert_eq!(streamed.admissibility.len(), if per_step { variables } else { 0 });
                ended += 1;
            },
        );
        assert_eq!(ended, designs.len());
    }

    // Each of them can be interrupted.
    let stop_at_three = |p: hardpoint::Progress| {
        if p.done == 3 { std::ops::ControlFlow::Break(()) } else { std::ops::ControlFlow::Continue(()) }
    };
    let windowed = analysis.solve_in_windows(Run::new().progress(stop_at_three), 1, |_, _| ());
    let streamed = analysis.stream(Run::new().progress(stop_at_three), &mut Count::default());
    for stop in [windowed.stop, streamed.stop] {
        assert_eq!(stop.unwrap().kind, hardpoint::motion::StopKind::Interrupted);
    }
    assert_eq!(streamed.steps, 3);
}

#[test]
fn batched_steps_are_the_same_as_single_steps() {
    // Times far apart are solved one by one, times close together in batches of eight: common ones must agree.
    for name in ["slider_crank", "macpherson", "rssr", "jansen", "double_wishbone", "elementary_chain"] {
        let mut draft = reference_draft(name);
        let end = draft.times[draft.times.len() - 1];
        let times = |n: usize| (0..=n).map(|k| end * k as f64 / n as f64).collect::<Vec<_>>();
        draft.times = times(10);
        let coarse = Model::from_draft(&draft).unwrap();
        draft.times = times(1000);
        let fine = Model::from_draft(&draft).unwrap();
        let [coarse, fine] = [coarse, fine].map(|m| Analysis::new(&m).unwrap().run());
        assert!(coarse.stop.is_none() && fine.stop.is_none(), "{name}");
        for k in 0..=10 {
            for (a, b) in coarse.motion.at(k).iter().zip(fine.motion.at(100 * k).iter()) {
                let accelerations = 1.0 + a.a.norm() + a.alpha.norm();
                assert!((a.r - b.r).norm() < 1e-12, "{name} at {k}");
                assert!((a.v - b.v).norm() + (a.omega - b.omega).norm() < 1e-11 * accelerations, "{name}");
                assert!((a.a - b.a).norm() + (a.alpha - b.alpha).norm() < 1e-11 * accelerations, "{name}");
            }
        }
    }
}

#[test]
fn eight_designs_in_lanes_are_the_same_as_one_by_one() {
    let mut side_by_side = Vec::new();
    for (name, late) in REFERENCES.into_iter().flat_map(|name| [(name, false), (name, true)]) {
        let mut draft = reference_draft(name);
        let end = draft.times[draft.times.len() - 1];
        // So close that they are steps; a late motion begins elsewhere than in the design configuration.
        draft.times = (if late { 70 } else { 0 }..=200).map(|k| end * f64::from(k) / 200.0).collect();
        let model = Model::from_draft(&draft).unwrap();
        let is_away = model.drivers.iter().any(|d| d.law.at(model.times[0]).value().abs() > 1e-3);
        let analysis = Analysis::new(&model).unwrap();
        let nominal = analysis.run();
        let followed: Vec<usize> =
            (0..model.variables.len()).filter(|&v| nominal.sensitivities.at(0, v).is_some()).collect();
        // Full groups of lanes and a part of one, and enough for programs.
        let designs: Vec<Vec<f64>> = (0..43)
            .map(|k| {
                let mut design = vec![0.0; model.variables.len()];
                design[followed[k % followed.len()]] = 1e-3 * ((k % 11) as f64 - 5.0);
                design
            })
            .collect();
        for (design, lane) in designs.iter().zip(designs_of(&analysis, &designs)) {
            let single = analysis.solve(Run::new().at(design).without_sensitivities());
            assert!(lane.stop.is_none() && single.stop.is_none());
            if is_away && lane.motion.effort.by_program == model.times.len() {
                side_by_side.push(name);
            }
            // Round-off differs only where lanes share a pivot order that one design alone would not choose.
            let d = difference(&lane, &single);
            assert!(d < 1e-11, "{name}, late: {late}: {d:e}");
        }
    }
    side_by_side.dedup();
    assert!(side_by_side.len() >= 5, "only {side_by_side:?} are solved side by side from elsewhere");
}

/// Keeps what a sink gets, in the layout of a solution.
struct Keep {
    states: Vec<hardpoint::motion::BodyState>,
    sensitivities: Vec<hardpoint::sensitivity::BodySensitivity>,
    bodies: usize,
    variables: usize,
}

impl hardpoint::Sink for Keep {
    fn state(&mut self, k: usize, body: BodyId, state: &hardpoint::motion::BodyState) {
        self.states[k * self.bodies + body.0] = *state;
    }
    fn sensitivity(
        &mut self,
        k: usize,
        variable: VariableId,
        body: BodyId,
        d: &hardpoint::sensitivity::BodySensitivity,
    ) {
        self.sensitivities[(k * self.variables + variable.0) * self.bodies + body.0] = *d;
    }
}

#[test]
fn sensitivities_of_changed_designs_are_the_same_in_lanes_and_match_resolved_neighbours() {
    for name in REFERENCES {
        let model = reference(name);
        let analysis = Analysis::new(&model).unwrap();
        let nominal = analysis.run();
        let followed: Vec<usize> =
            (0..model.variables.len()).filter(|&v| nominal.sensitivities.at(0, v).is_some()).collect();
        let design = |b: f64, v: usize, h: f64| {
            let mut design = vec![0.0; model.variables.len()];
            followed.iter().enumerate().for_each(|(k, v)| design[*v] = b * (1.0 - 0.3 * (k % 5) as f64));
            design[v] += h;
            design
        };
        // Ten designs: a full group of lanes and a part of one.
        let designs: Vec<Vec<f64>> = (0..10).map(|k| design(3e-4 * (k as f64 - 4.0), 0, 0.0)).collect();
        let (bodies, variables) = (model.bodies.len(), model.variables.len());
        let keep = |_| Keep {
            states: nominal.motion.states().collect(),
            sensitivities: vec![
                hardpoint::sensitivity::BodySensitivity::ZERO;
                nominal.motion.len() * variables * bodies
            ],
            bodies,
            variables,
        };
        let mut ended = 0;
        analysis.stream_designs(Run::new(), &designs, keep, |n, kept, streamed| {
            assert_eq!((n, streamed.steps), (ended, model.times.len()), "{name}: {:?}", streamed.stop);
            ended += 1;
            let single = analysis.solve(Run::new().at(&designs[n]));
            for (one, lane) in single.sensitivities.admissibility.iter().zip(&streamed.admissibility) {
                assert_eq!(std::mem::discriminant(one), std::mem::discriminant(lane), "{name}");
            }
            let mut lane = single.clone();
            for (k, b) in (0..model.times.len()).flat_map(|k| (1..bodies).map(move |b| (k, BodyId(b)))) {
                lane.motion.set(k, b, &kept.states[k * bodies + b.0]);
                for v in (0..variables).filter(|v| single.sensitivities.moves(VariableId(*v), b)) {
                    let d = &kept.sensitivities[(k * variables + v) * bodies + b.0];
                    lane.sensitivities.set(k, VariableId(v), b, d);
                }
            }
            let d = difference(&single, &lane);
            assert!(d < 1e-10, "{name}, design {n}: {d:e}");
            if n == 9 {
                // Measures, too, against designs a little before and behind.
                for &v in &followed {
                    let h = 1e-5;
                    let around: Vec<Vec<f64>> = [h, -h].map(|h| design(1.5e-3, v, h)).to_vec();
                    let around = designs_of(&analysis, &around);
                    for m in 0..single.measured.outputs.len() {
                        let (mut scale, mut worst) = (1e-2, 0.0_f64);
                        for k in 0..model.times.len() {
                            let [p, m0] = [0, 1].map(|i| around[i].measured.value(k, m)[0]);
                            let exact = single.measured.d(k, VariableId(v), m)[0];
                            scale = f64::max(scale, exact.abs());
                            worst = worst.max(((p - m0) / (2.0 * h) - exact).abs());
                        }
                        assert!(
                            worst < 1e-6 * scale,
                            "{name}: {} by {v}: {worst:e}",
                            single.measured.outputs[m].name
                        );
                    }
                }
            }
        });
        assert_eq!(ended, designs.len());
    }
}

#[test]
fn a_moved_and_turned_mechanism_has_the_same_measures_and_turned_motion() {
    let placed =
        Pose { rot: Mat3::from_rotation_vector(Vec3::new(0.4, -1.1, 0.7)), r: Vec3::new(3.0, -2.0, 0.5) };
    for name in REFERENCES {
        let draft = reference_draft(name);
        let moved = moved_draft(&draft, placed);
        let (a, b) = (Model::from_draft(&draft).unwrap(), Model::from_draft(&moved).unwrap());
        let (a, b) = (Analysis::new(&a).unwrap().run(), Analysis::new(&b).unwrap().run());
        for (k, (x, y)) in a.motion.states().zip(b.motion.states()).enumerate() {
            if k % a.motion.bodies != 0 {
                assert!(apart(placed.point(x.r), y.r) < 1e-11, "{name}");
                assert!(apart(placed.rot * x.alpha, y.alpha) < 1e-8 * (1.0 + x.alpha.norm()), "{name}");
            }
        }
        for k in 0..a.motion.len() {
            for (m, output) in a.measured.outputs.iter().enumerate() {
                // Toe, camber and global coordinates are meant to depend on where the mechanism is.
                if output.name.contains('.') || ["toe", "camber"].contains(&output.name.as_str()) {
                    continue;
                }
                let (x, y) = (a.measured.value(k, m), b.measured.value(k, m));
                for order in 0..3 {
                    assert!(
                        (x[order] - y[order]).abs() < 1e-9 * (1.0 + x[order].abs()),
                        "{name} {}",
                        output.name
                    );
                }
                for v in (0..a.sensitivities.variables).map(VariableId) {
                    if a.sensitivities.at(k, v.0).is_some() {
                        let (x, y) = (a.measured.d(k, v, m), b.measured.d(k, v, m));
                        let scale = 1.0 + x[2].abs();
                        assert!((0..3).all(|o| (x[o] - y[o]).abs() < 1e-8 * scale), "{name} {}", output.name);
                    }
                }
            }
        }
    }
}

fn moved_draft(draft: &Draft, to: Pose) -> Draft {
    let mut d = draft.clone();
    let place = |p: &mut LocationDraft| {
        if let LocationDraft::At(v) = p {
            *v = to.point(*v);
        }
    };
    let line = |l: &mut Option<DirectionDraft>| {
        if let Some(DirectionDraft::Along(v)) = l {
            *v = to.rot * *v;
        }
    };
    for b in &mut d.bodies {
        if let FrameDraft::Pose(p) = &mut b.frame {
            *p = to.compose(*p);
        }
    }
    for j in &mut d.joints {
        j.at.iter_mut().for_each(place);
        line(&mut j.axis);
        line(&mut j.axis2);
    }
    for v in &mut d.design {
        for c in &mut v.changes {
            if let ChangeDraft::Marker { position, rotation, .. } = c {
                (*position, *rotation) = (to.rot * *position, to.rot * *rotation);
            }
        }
    }
    for p in &mut d.points {
        place(&mut p.at);
    }
    for driver in &mut d.drivers {
        if let DrivenDraft::Position { point: PointRef::On { at, .. }, along: DirectionDraft::Along(along) } =
            &mut driver.drives
        {
            place(at);
            *along = to.rot * *along;
        }
    }
    for m in &mut d.measures {
        if let MeasureKindDraft::Distance {
            from: PointRef::On { at, .. },
            to: PointRef::On { at: other, .. },
        } = &mut m.kind
        {
            place(at);
            place(other);
        }
    }
    d
}

#[test]
fn swapping_the_bodies_of_every_joint_only_turns_the_signs_of_its_coordinates() {
    for name in REFERENCES {
        let draft = reference_draft(name);
        let mut swapped = draft.clone();
        for j in &mut swapped.joints {
            // What is a line or plane of body i is not one of body j.
            if ["inline", "inplane", "dot2"].contains(&j.kind.as_str()) {
                continue;
            }
            // A universal joint's two pins belong to body i and body j, so swap those too.
            j.bodies.swap(0, 1);
            j.at.reverse();
            if j.axis2.is_some() {
                std::mem::swap(&mut j.axis, &mut j.axis2);
            }
        }
        for d in &mut swapped.drivers {
            let DrivenDraft::Coordinate { joint, .. } = &d.drives else { continue };
            if draft.joints.iter().any(|j| j.name == *joint && j.kind != "leg") {
                d.law = d.law.clone().scaled(-1.0);
            }
        }
        for v in &mut swapped.design {
            for c in &mut v.changes {
                if let ChangeDraft::Marker { joint, end, .. } = c {
                    let kept = draft
                        .joints
                        .iter()
                        .zip(&swapped.joints)
                        .any(|(a, b)| a.name == *joint && a.bodies == b.bodies);
                    if kept {
                        continue;
                    }
                    *end = match end {
                        End::I => End::J,
                        End::J => End::I,
                        End::Both => End::Both,
                    };
                }
            }
        }
        let (a, b) = (Model::from_draft(&draft).unwrap(), Model::from_draft(&swapped).unwrap());
        let (a, b) = (Analysis::new(&a).unwrap().run(), Analysis::new(&b).unwrap().run());
        let d = difference(&a, &b);
        assert!(d < 1e-10, "{name}: {d:e}");
    }
}

#[test]
fn an_admissible_design_leaves_every_body_where_it_is_while_all_drivers_are_zero() {
    // The slider-crank's driver sin(2 pi t) is zero at t = 1.5 and 2, the strut's and rack's at t = 10.
    for (name, k) in [("slider_crank", 7), ("slider_crank", 8), ("macpherson", 8), ("macpherson", 0)] {
        let model = reference(name);
        let solution = Analysis::new(&model).unwrap().run();
        for v in 0..model.variables.len() {
            if solution.sensitivities.admissibility[v] == hardpoint::sensitivity::Admissibility::Admissible {
                for s in solution.sensitivities.at(k, v).unwrap().iter() {
                    assert!(
                        s.dr.norm() < 1e-12 && s.dpi.norm() < 1e-12,
                        "{name} {}",
                        model.variables[v].name
                    );
                }
            }
        }
    }
}

#[test]
fn null_variables_have_exactly_no_effect() {
    let model = reference("slider_crank");
    let solution = Analysis::new(&model).unwrap().run();
    for name in ["J2_z", "J4_x", "J4_y", "J4_rx"] {
        let v = model.variable(name).unwrap().0;
        for k in 0..solution.motion.len() {
            for s in solution.sensitivities.at(k, v).unwrap().iter() {
                assert!(s.da.norm() < 1e-11 && s.dalpha.norm() < 1e-11 && s.dr.norm() < 1e-14, "{name}");
            }
        }
    }
}

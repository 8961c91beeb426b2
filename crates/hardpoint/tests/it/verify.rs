//! Sensitivities against re-solved designs, on every reference mechanism.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use hardpoint::motion::{Stop, StopKind};
use hardpoint::run::GradientMethod;
use hardpoint::sensitivity::BodySensitivity;
use hardpoint::space::Vec3;
use hardpoint::{Analysis, Run, Solution};
use hardpoint::{
    draft::LocationDraft,
    model::{BodyId, Model, VariableId},
};
use hardpoint_study::Comparison;
use hardpoint_study::difference::{DifferenceScheme, finite_differences, finite_differences_each};
use hardpoint_study::verify::{self, CheckOutcome, Verification, verify};

use crate::workbench::*;

const SCHEMES: [DifferenceScheme; 3] =
    [DifferenceScheme::Central, DifferenceScheme::Forward, DifferenceScheme::Backward];

/// Two solved positions differ by this part from the exact ones, at the most: some times what Newton's last correction
/// leaves, where the motion magnifies it. A variable that moves nothing has only this, and by chance none of it at some
/// step.
const NOISE: f64 = 1e-12;

fn verified(analysis: &Analysis<'_>, solution: &Solution, scheme: DifferenceScheme) -> Verification {
    verify(analysis, solution, &verify::Options::new(scheme), |_| ControlFlow::Continue(()))
}

/// Two ways to one position differ by this part of it, which the step of a difference magnifies.
const TWO_WAYS: f64 = 1e-8;

#[test]
fn differences_at_some_output_times_are_those_at_all_of_them() {
    for (name, stride) in [("slider_crank", 7), ("macpherson", 13), ("jansen", 5)] {
        let model = reference(name);
        let (analysis, variables) = (Analysis::new(&model).unwrap(), model.variables.len());
        let solution = analysis.run();
        let follows = |b: &usize| solution.sensitivities.at(0, *b).is_some();
        let steps: Vec<_> = (0..variables)
            .filter(follows)
            .map(VariableId)
            .map(|b| (b, 1e-3 * model.natural_step(b)))
            .collect();
        for scheme in SCHEMES {
            let all = finite_differences(&analysis, &solution, scheme, &steps);
            let some = finite_differences_each(&analysis, &solution, scheme, &steps, stride);
            for (all, some) in all.iter().zip(&some).map(|(a, b)| (a.as_ref().unwrap(), b.as_ref().unwrap()))
            {
                let columns = solution.measured.outputs.len();
                assert_eq!(some.outputs.len(), solution.motion.len().div_ceil(stride) * columns);
                let largest = |order: usize, m: usize| {
                    let column = all.outputs.iter().skip(m).step_by(columns);
                    column.map(|x| x[order].abs()).fold(1.0, f64::max)
                };
                for (place, found) in some.outputs.iter().enumerate() {
                    let (row, m) = (place / columns, place % columns);
                    let expected = all.outputs[row * stride * columns + m];
                    for order in 0..solution.measured.outputs[m].known.orders {
                        let apart = (found[order] - expected[order]).abs();
                        assert!(
                            apart <= TWO_WAYS * largest(order, m),
                            "{name} {scheme:?} {row} {m} {order}: {apart}"
                        );
                    }
                }
                let worst = |d| Comparison::of(&model, &solution, d).worst().unwrap().error;
                assert!(worst(some) <= worst(all) + TWO_WAYS);
            }
        }
    }
}

/// With the square of the step for central differences, with the step for one-sided ones.
#[test]
fn sensitivities_match_resolved_designs_and_the_error_falls_as_it_must() {
    for scheme in SCHEMES {
        let a_decade = if scheme == DifferenceScheme::Central { 100.0 } else { 10.0 };
        let (mut falling, mut worst) = (0, 0.0_f64);
        for name in ["slider_crank", "macpherson", "rssr", "hooke", "double_wishbone", "jansen"] {
            let model = reference(name);
            let analysis = Analysis::new(&model).unwrap();
            let report = verified(&analysis, &analysis.run(), scheme);
            for check in &report.checks {
                let variable = &model.variables[check.variable.0].name;
                if check.outcome == CheckOutcome::CannotFollow {
                    continue;
                }
                assert_eq!(check.outcome, CheckOutcome::Passed, "{name} {variable}: {:?}", check.sweep);
                worst = worst.max(check.worst().unwrap().error);
                // Where truncation rules, well above the best agreement, a step 10 times finer errs that many times
                // less.
                let best = check.sweep.iter().min_by(|a, b| a.error.total_cmp(&b.error)).unwrap();
                let noise = |step: f64| f64::max(best.error, NOISE / step);
                let coarse = check
                    .sweep
                    .iter()
                    .take_while(|s| s.step > best.step && s.error > a_decade * noise(s.step))
                    .filter(|s| s.error < 1e-2);
                for pair in coarse.collect::<Vec<_>>().windows(3) {
                    let ratio = pair[0].error / pair[2].error / a_decade;
                    assert!((0.5..2.0).contains(&ratio), "{scheme:?} {name} {variable}: {pair:?}");
                    falling += 1;
                }
                // No quantity is judged worse than by a step for all of them.
                assert!(check.worst().unwrap().error <= best.error);
            }
            assert!(report.passed());
        }
        println!("{scheme:?}: worst {worst:.1e}, falling {falling}");
        assert!(falling > 100, "only {falling} places where the error could be seen to fall");
        // What the scheme can reach at best, and four digits more.
        let reach = f64::EPSILON.powf(if scheme == DifferenceScheme::Central { 2.0 / 3.0 } else { 0.5 });
        assert!(worst < 1e4 * reach && scheme.tolerance() < 3e4 * reach, "{scheme:?}: {worst:e}");
    }
}

/// Each quantity by itself, however small the part of the motion that it is: none hides behind another's error.
#[test]
fn a_wrong_sensitivity_fails_and_is_reported() {
    type Of = fn(&mut BodySensitivity) -> &mut Vec3;
    let kinds: [(&str, Of); 4] = [
        ("position", |s| &mut s.dr),
        ("orientation", |s| &mut s.dpi),
        ("velocity", |s| &mut s.dv),
        ("angular acceleration", |s| &mut s.dalpha),
    ];
    let model = reference("macpherson");
    let analysis = Analysis::new(&model).unwrap();
    let right = analysis.run();
    let (variable, n, steps) = (VariableId(0), right.sensitivities.bodies, right.motion.len());
    for scheme in SCHEMES {
        assert!(verified(&analysis, &right, scheme).passed());
        for (kind, of) in kinds {
            let mut wrong = right.clone();
            let at = |(k, i): (usize, usize)| right.sensitivities.at(k, variable.0).unwrap().body(i);
            let size = |place: &(usize, usize)| of(&mut at(*place)).norm();
            let all = (0..steps).flat_map(|k| (1..n).map(move |i| (k, i)));
            let (k, i) = all.max_by(|a, b| size(a).total_cmp(&size(b))).unwrap();
            // At one output time alone: by three times what is tolerated, and by half.
            for part in [3.0 * scheme.tolerance(), 0.5] {
                let (x, mut changed) = (*of(&mut at((k, i))), at((k, i)));
                *of(&mut changed) = x * (1.0 + part);
                wrong.sensitivities.set(k, variable, BodyId(i), &changed);
                let report = verified(&analysis, &wrong, scheme);
                let check = &report.checks[variable.0];
                let worst = check.worst().unwrap();
                assert_eq!(check.outcome, CheckOutcome::Failed, "{scheme:?} {kind}");
                assert_eq!(worst.quantity, format!("{} {kind}", model.bodies[i].name));
                // Of the small one the error of a coarse difference can hide a part, and the time with it.
                assert!(worst.error < 1.1 * part, "{scheme:?} {kind}: {worst:?}");
                if part == 0.5 {
                    // A half more, of what is a half larger.
                    assert!((worst.error - 0.5 / 1.5).abs() < 0.01, "{kind}: {worst:?}");
                    assert_eq!(worst.time, right.motion.times[k]);
                }
                assert!(!report.passed());
                assert!(report.checks[1..].iter().all(|c| c.outcome != CheckOutcome::Failed));
            }
        }
        // Those of another design.
        let mut other = reference_draft("macpherson");
        for place in &mut other.joints[1].at {
            let LocationDraft::At(place) = place else { panic!("coordinates") };
            place.z += 0.02;
        }
        let other = Model::from_draft(&other).unwrap();
        let solution = Analysis::new(&other).unwrap().run();
        assert_eq!(solution.motion.len(), steps);
        let report = verified(&analysis, &solution, scheme);
        // What moves nothing in either design agrees.
        let failed = report.checks.iter().filter(|c| c.outcome == CheckOutcome::Failed).count();
        assert!(2 * failed > report.checks.len(), "{scheme:?}: {failed} of {}", report.checks.len());
    }
}

/// A comparison is asked by body and by output, and knows which of its errors those are.
#[test]
fn errors_are_found_by_body_and_by_output() {
    let model = reference("macpherson");
    let analysis = Analysis::new(&model).unwrap();
    let solution = analysis.run();
    let step = (VariableId(0), 1e-3 * model.natural_step(VariableId(0)));
    let difference =
        finite_differences(&analysis, &solution, DifferenceScheme::Central, &[step]).remove(0).unwrap();
    let comparison = Comparison::of(&model, &solution, &difference);
    let error = |name: String| {
        let found = comparison.errors().iter().find(|e| e.quantity == name);
        found.unwrap_or_else(|| panic!("no error of {name}")).error
    };
    let mut count = 0;
    for (b, body) in model.bodies.iter().enumerate().skip(1) {
        let kinds = ["position", "velocity", "acceleration"];
        let want = kinds.map(|kind| error(format!("{} {kind}", body.name)));
        assert_eq!(comparison.of_origin(BodyId(b)), want, "{}", body.name);
        count += 6;
    }
    for (m, output) in solution.measured.outputs.iter().enumerate() {
        let want = [0, 1, 2].map(|order| match order {
            0 => error(format!("{} value", output.name)),
            _ if order < output.known.orders => error(output.order_name(order)),
            _ => 0.0,
        });
        assert_eq!(comparison.of_output(m), want, "{}", output.name);
        count += output.known.orders;
    }
    assert_eq!(comparison.errors().len(), count);
    assert!(comparison.worst().unwrap().error > 0.0);
}

/// Everything that goes over the output times ends at the next one when the analysis is asked to end, and says so.
#[test]
fn an_interrupted_analysis_ends_at_the_next_output_time() {
    let mut draft = reference_draft("macpherson");
    let last = draft.times.last().copied().unwrap();
    draft.times = (0..=100).map(|k| last * f64::from(k) / 100.0).collect();
    let model = Model::from_draft(&draft).unwrap();
    let variables = model.variables.len();
    assert!(variables > 0);
    let along: Vec<f64> = (0..variables).map(|k| if k == 0 { 1.0 } else { 0.0 }).collect();
    let flag = Arc::new(AtomicBool::new(false));
    let whole = Analysis::new(&model).unwrap();
    let nominal = whole.run();
    assert!(nominal.stop.is_none());
    let analysis = whole.ended_by(Arc::clone(&flag));

    // Asked to end after ten output times: at most what programs solve at once is solved besides.
    let solution = analysis.solve(Run::new().progress(|p| {
        flag.store(p.done >= 10, Ordering::Relaxed);
        ControlFlow::Continue(())
    }));
    assert!((10..30).contains(&solution.motion.len()), "{}", solution.motion.len());
    assert_eq!(solution.stop.unwrap().kind, StopKind::Interrupted);

    // Asked before: nothing is solved.
    flag.store(true, Ordering::Relaxed);
    let interrupted = |stop: Option<Stop>| assert_eq!(stop.map(|s| s.kind), Some(StopKind::Interrupted));
    let solution = analysis.run();
    assert_eq!(solution.motion.len(), 0);
    interrupted(solution.stop);
    for run in [Run::new(), Run::new().without_sensitivities()] {
        let mut seen = 0;
        analysis.solve_designs(run, &vec![vec![0.0; variables]; 20], |_, solution| {
            seen += 1;
            interrupted(solution.stop.take());
        });
        assert_eq!(seen, 20);
    }
    interrupted(analysis.jerks(&[]).stop);
    interrupted(analysis.second(&[], std::slice::from_ref(&along), &[[0, 0]]).stop);
    for method in [GradientMethod::Direct, GradientMethod::Adjoint] {
        interrupted(analysis.gradients(&[], &[0], method).stop);
    }
    let found = verify(&analysis, &nominal, &verify::Options::default(), |_| ControlFlow::Continue(()));
    assert!(found.interrupted && !found.passed() && found.checks.is_empty());

    // And not asked any more, it solves everything.
    flag.store(false, Ordering::Relaxed);
    let found = verify(&analysis, &nominal, &verify::Options::default(), |_| ControlFlow::Continue(()));
    assert!(!found.interrupted && found.checks.len() == variables);
}

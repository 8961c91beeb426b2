//! Jerk against differences of accelerations, closed forms, and itself in the other coordinates.

use hardpoint::law::Law;
use hardpoint::number::{Dual, Jet, Rates, Real};
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run};
use hardpoint::{draft::*, model::*};

use crate::workbench::*;

/// Differences over time with the best of some steps: h^2 of the fifth derivative, and round-off over h.
const DIFFERENCE: f64 = 1e-6;
/// Two ways to the same third derivatives, each three solutions with the Jacobian away from the position.
const AGREE: f64 = 1e-9;

const BOTH: [Formulation; 2] = [Formulation::Relative, Formulation::Absolute];

#[test]
fn jerks_are_the_rates_of_accelerations_on_every_mechanism() {
    for mut draft in crate::joints::mechanisms() {
        let (first, last) = (draft.times[0], draft.times[draft.times.len() - 1]);
        let middle: Vec<f64> =
            (1..10).map(|k| first + (last - first) * (f64::from(k) + 0.3) / 10.5).collect();
        let error = |draft: &Draft, h: f64, formulation: Formulation| {
            let model = Model::from_draft(draft).unwrap();
            let analysis = Analysis::with(&model, formulation).unwrap();
            let (motion, jerks) =
                (analysis.solve(Run::new().without_sensitivities()).motion, analysis.jerks(&[]));
            assert_eq!(jerks.times, draft.times, "{}: {:?}", draft.name, jerks.stop);
            let (mut worst, mut scale) = ([0.0_f64; 2], [0.0_f64; 2]);
            for k in (1..jerks.times.len()).step_by(3) {
                for b in 0..jerks.bodies {
                    let (before, after, exact) =
                        (&motion.at(k - 1).body(b), &motion.at(k + 1).body(b), jerks.at(k)[b]);
                    let pairs =
                        [(after.a - before.a, exact.jerk), (after.alpha - before.alpha, exact.angular)];
                    for (n, (difference, exact)) in pairs.into_iter().enumerate() {
                        worst[n] = worst[n].max(apart(difference * (0.5 / h), exact));
                        scale[n] = scale[n].max(exact.norm());
                    }
                }
            }
            // Bodies that turn about their own origins have no other jerk than round-off.
            let least = 1e-3 * scale[0].max(scale[1]);
            (0..2).map(|n| worst[n] / scale[n].max(least)).fold(0.0, f64::max)
        };
        for formulation in BOTH {
            let errors = [4e-4, 2e-4, 2e-5].map(|part| {
                let h = part * (last - first);
                draft.times = middle.iter().flat_map(|t| [t - h, *t, t + h]).collect();
                error(&draft, h, formulation)
            });
            let least = errors.into_iter().fold(f64::INFINITY, f64::min);
            assert!(least < DIFFERENCE, "{}, {formulation:?}: {errors:?}", draft.name);
            // The error falls by four when the step halves, until round-off.
            let falls = (errors[0] / errors[1] - 4.0).abs() < 0.5;
            assert!(errors[1] < DIFFERENCE || falls, "{}, {formulation:?}: {errors:?}", draft.name);
        }
    }
}

#[test]
fn both_formulations_have_the_same_jerks_at_changed_designs_too() {
    for draft in crate::joints::mechanisms() {
        let model = Model::from_draft(&draft).unwrap();
        // Redundant joints hold a finite change to first order only: which of them are solved with makes a difference.
        let redundant = Analysis::new(&model).unwrap().topology().redundant().next().is_some();
        let design = vec![1e-3; model.variables.len()];
        let [a, b] = BOTH.map(|f| {
            let analysis = Analysis::with(&model, f).unwrap();
            analysis.jerks(if redundant { &[] } else { &design })
        });
        assert_eq!(a.times, b.times);
        let scale = a.states.iter().map(|s| s.jerk.norm().max(s.angular.norm())).fold(1.0, f64::max);
        for (a, b) in a.states.iter().zip(&b.states) {
            let difference = apart(a.jerk, b.jerk).max(apart(a.angular, b.angular));
            assert!(difference < AGREE * scale, "{}: {difference:e} of {scale:e}", draft.name);
        }
    }
}

/// A number with three time derivatives: the third is the derivative of the second.
fn time(t: f64) -> Rates<Dual> {
    Jet([Dual::variable(t), Dual::constant(1.0), Dual::constant(0.0)])
}

#[test]
fn a_crank_and_a_four_bar_have_the_jerks_of_their_closed_forms() {
    let [a, b, c, d] = [[0.0, 0.0], [0.0, 0.1], [0.3, 0.25], [0.35, 0.0]];
    let mut draft = four_bar([a, b, c, d], "t", &times(1.0, 20));
    draft.drivers[0].law = Law::parse("2*t + 0.5*sin(3*t)").unwrap();
    let model = Model::from_draft(&draft).unwrap();
    let length = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
    let (crank, coupler, rocker, drawn) =
        (length(a, b), length(b, c), length(c, d), (b[1] - a[1]).atan2(b[0] - a[0]));
    // Of the crank's angle, and of the rocker's: the angle of D to B, less that at D in the triangle B C D.
    let closed = |t: f64| -> [f64; 2] {
        let t = time(t);
        let k = <Jet<Dual, 3> as Real>::constant;
        let crank_angle = k(2.0) * t + k(0.5) * (k(3.0) * t).sin_cos().0;
        let (sin, cos) = (crank_angle + k(drawn)).sin_cos();
        let (x, y) = (k(crank) * cos - k(d[0]), k(crank) * sin - k(d[1]));
        let e = (x * x + y * y).sqrt();
        let cosine = (k(rocker * rocker - coupler * coupler) + e * e) / (k(2.0 * rocker) * e);
        let rocker_angle = y.atan2(x) - (k(1.0) - cosine * cosine).sqrt().atan2(cosine);
        [crank_angle, rocker_angle].map(|x| x.0[2].d)
    };
    for formulation in BOTH {
        let jerks = Analysis::with(&model, formulation).unwrap().jerks(&[]);
        for (k, &t) in jerks.times.iter().enumerate() {
            for (body, want) in [1, 3].into_iter().zip(closed(t)) {
                let got = jerks.at(k)[body].angular;
                let error = apart(got, Vec3::new(0.0, 0.0, want));
                assert!(
                    error < 1e-10 * (1.0 + want.abs()),
                    "{formulation:?}, t = {t}, body {body}: {got:?} {want}"
                );
            }
        }
    }
}

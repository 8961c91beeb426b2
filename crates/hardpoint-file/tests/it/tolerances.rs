//! Tolerance studies: compared with closed forms, with Monte Carlo designs, and with each other.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::model::{AllocationRule, AllocationSettings, Limit, LimitTarget, Model, ToleranceSettings};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run};
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::tolerance::{
    AllocationError, Error, MetricSpread, MonteCarlo, Overrides, Request, ToleranceResult, tolerance,
};
use hardpoint_study::{Control, Motions, Progress, Step, StudyCost};

const THREADS: NonZero<usize> = NonZero::<usize>::MIN;

/// A slider-crank: the slider's place over the crank's angle is `x = r cos a + sqrt(l^2 - (r sin a - e)^2)`.
const CRANK: &str = r#"
name = "slider-crank"
units = { length = "mm", angle = "deg" }
parameters.rod = { value = 300, unit = "length" }
parameters.offset = { value = 20, unit = "length" }
parameters.radius = { value = 100, unit = "length" }
hardpoints = { O = [0, 0, 0], A = ["radius*cos(40*pi/180)", "radius*sin(40*pi/180)", 0], B = [300, "offset", 0] }
bodies = { crank = {}, slider = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = "B", axis = "x" }
joints.rod = { type = "distance", bodies = ["crank", "slider"], at = ["A", "B"], length = "rod" }
drivers.motor = { joint = "pivot", law = "20*t" }
measures.place = { type = "position", point = "B", along = "x" }
points.B = { body = "slider", at = "B" }
metrics.first = { of = "place", take = "value", at = 0 }
metrics.range = { of = "place", take = "range" }
time = { end = 1.0, steps = 10 }
"#;

fn model(text: &str) -> ModelFile {
    parse(text, "tolerances.toml").unwrap_or_else(|e| panic!("{e}"))
}

fn study(name: &str) -> ModelFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/studies").join(name);
    hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}"))
}

fn examined_on(threads: usize, model: &Model, asked: &ToleranceSettings) -> Result<ToleranceResult, Error> {
    let models = model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let numbers: Vec<usize> = (0..models.len()).collect();
    let control = Control {
        threads: NonZero::new(threads).unwrap(),
        progress: &mut |_| ControlFlow::Continue(()),
        more: &|| true,
    };
    tolerance(model, &motions, &numbers, &Request { settings: asked.clone() }, control)
}

fn examined(file: &ModelFile, change: impl FnOnce(&mut ToleranceSettings)) -> ToleranceResult {
    let mut asked = file.model.tolerancing.clone().expect("the file says what is off");
    change(&mut asked);
    examined_on(THREADS.get(), &file.model, &asked).unwrap_or_else(|e| panic!("{e:?}"))
}

fn spread<'e>(file: &ModelFile, found: &'e ToleranceResult, metric: &str) -> &'e MetricSpread {
    let name = |m: &MetricSpread| file.model.metrics[m.metric].name == metric;
    found.metrics.iter().find(|m| name(m)).expect("the metric is looked at")
}

fn near(a: f64, b: f64, relative: f64) {
    assert!((a - b).abs() <= relative * b.abs(), "{a:e} is not {b:e}: {:e}", a / b - 1.0);
}

/// Settings of the file, with other tolerances of the slider-crank.
fn crank(tolerance: &str) -> ModelFile {
    model(&format!("{CRANK}\n[tolerance]\nsamples = 20000\n{tolerance}\n"))
}

fn sampled(found: &ToleranceResult) -> &MonteCarlo {
    found.sampled.as_ref().expect("designs were drawn")
}

/// First and second derivatives of `x = r cos a + sqrt(l^2 - (r sin a - e)^2)` by l, e and r.
fn closed_form() -> ([f64; 3], [[f64; 3]; 3]) {
    let (l, e, r, a) = (0.3, 0.02, 0.1, 40_f64.to_radians());
    let u = r * a.sin() - e;
    let c = (l * l - u * u).sqrt();
    // c^2 = l^2 - u^2:  c c_i = (c^2)_i / 2,  c c_ij = (c^2)_ij / 2 - c_i c_j
    let first = [l / c, u / c, -u * a.sin() / c];
    let half = [[1.0, 0.0, 0.0], [0.0, -1.0, a.sin()], [0.0, a.sin(), -a.sin().powi(2)]];
    let second = |i: usize, j: usize| (half[i][j] - first[i] * first[j]) / c;
    let h = std::array::from_fn(|i| std::array::from_fn(|j| second(i, j)));
    ([first[0], first[1], a.cos() + first[2]], h)
}

/// Differences of gradients hold second derivatives to some 1e-8.
const DIFFERENCED: f64 = 1e-6;

#[test]
fn moments_of_a_slider_crank_are_those_of_its_closed_form() {
    let file = crank(
        "[tolerance.variables]\nrod = 6\noffset = { tolerance = 4, distribution = \"uniform\" }\nradius = { tolerance = 3, sigmas = 2 }",
    );
    let found = examined(&file, |asked| asked.samples = 0);
    let of = spread(&file, &found, "first");
    let (g, h) = closed_form();
    let s = [6e-3 / 3.0, 4e-3 / 3.0_f64.sqrt(), 3e-3 / 2.0];
    for k in 0..3 {
        near(of.d[k], g[k], 1e-10);
        near(found.variables[k].sigma, s[k], 1e-14);
    }
    let first: f64 = (0..3).map(|k| (g[k] * s[k]).powi(2)).sum();
    near(of.sigma, first.sqrt(), 1e-10);
    (0..3).for_each(|k| near(of.shares[k], (g[k] * s[k]).powi(2) / first, 1e-9));
    let pair = |i: usize, j: usize| 0.5 * (h[i][j] * s[i] * s[j]).powi(2);
    let pairs: f64 = (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| pair(i, j)).sum();
    // An even distribution has kurtosis 9/5.
    let bend = pairs + 0.25 * (1.8 - 3.0) * (h[1][1] * s[1] * s[1]).powi(2);
    let second = of.second.unwrap();
    near(second.shift, 0.5 * (0..3).map(|k| h[k][k] * s[k] * s[k]).sum::<f64>(), DIFFERENCED);
    near(second.bend, bend.sqrt(), DIFFERENCED);
    near(second.sigma, (first + bend).sqrt(), DIFFERENCED);
    let t = [6e-3, 4e-3, 3e-3];
    let reach: f64 = (0..3).map(|k| (g[k] * t[k]).abs()).sum();
    for (sign, extreme) in [-1.0, 1.0].into_iter().zip(&of.worst) {
        near(extreme.first, of.nominal + sign * reach, 1e-10);
        // Here the corner of the first order is that of the second as well.
        let d: Vec<f64> = (0..3).map(|k| sign * t[k] * g[k].signum()).collect();
        let bend: f64 =
            (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| 0.5 * h[i][j] * d[i] * d[j]).sum();
        near(extreme.second.unwrap() - extreme.first, bend, 1e-5);
        assert_eq!(extreme.deviations, d);
        // The third order is what is left.
        assert!((extreme.exact.unwrap() - extreme.second.unwrap()).abs() < 0.05 * bend.abs());
    }
}

/// Gradients are differenced for metrics, and solved exactly for curves: of the metric that is a point of a curve both
/// must agree.
#[test]
fn second_derivatives_of_metrics_are_those_of_their_curves() {
    let file = crank(
        "[tolerance.variables]\nrod = 6\noffset = { tolerance = 4, distribution = \"uniform\" }\nradius = 3",
    );
    let found = examined(&file, |asked| asked.samples = 0);
    let (of, band) = (spread(&file, &found, "first"), found.curves[0].bands[0]);
    near(band.sigma, of.sigma, 1e-12);
    let (a, b) = (band.second.unwrap(), of.second.unwrap());
    near(a.shift, b.shift, DIFFERENCED);
    near(a.bend, b.bend, DIFFERENCED);
    for ((first, worst), extreme) in band.first.into_iter().zip(band.worst).zip(&of.worst) {
        near(first, extreme.first, 1e-12);
        near(worst, extreme.exact.unwrap(), 1e-12);
    }
    assert!(band.solved);
}

/// Squares, worst case and moments against re-solved designs: differences with a sweep of steps.
#[test]
fn squares_and_moments_match_re_solved_designs() {
    let file = study("strut_tolerances.toml");
    let found = examined(&file, |asked| {
        (asked.samples, asked.allocation) = (0, None);
        asked.correlations.clear();
    });
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let value = |of: &MetricSpread, design: &[f64]| {
        let found = motions.evaluate(design, &mut StudyCost::default(), &|| true).unwrap();
        let name = &file.model.metrics[of.metric].name;
        let place = models[of.motion].metrics.iter().position(|m| m.name == *name).unwrap();
        found.metrics[of.motion][place].value.unwrap()
    };
    assert_eq!(found.metrics.len(), 4);
    for of in &found.metrics {
        assert!(of.sigma > 0.0 && of.second.unwrap().bend > 0.0);
        let mut best = [f64::INFINITY; 2];
        for step in [4.0, 2.0, 1.0, 0.5] {
            let moved = |k: usize, by: f64| {
                let v = found.variables[k];
                let mut design = vec![0.0; file.model.variables.len()];
                design[v.variable.0] = by * v.sigma;
                value(of, &design)
            };
            // Uncorrelated: the diagonal of what the sums go over.
            let (mut first, mut exact) = (0.0, 0.0);
            let mut curvature = 0.0;
            for k in 0..found.variables.len() {
                let [up, down] = [step, -step].map(|by| moved(k, by));
                first += ((up - down) / (2.0 * step)).powi(2);
                exact += (of.d[k] * found.variables[k].sigma).powi(2);
                curvature += 0.5 * (up - 2.0 * of.nominal + down) / (step * step);
            }
            best[0] = best[0].min((first / exact - 1.0).abs());
            best[1] = best[1].min((curvature / of.second.unwrap().shift - 1.0).abs());
        }
        assert!(best[0] < 1e-5, "{:?}", best);
        assert!(best[1] < 1e-3, "{:?} {:?}", best, of.second);
    }
}

/// Maximum deviation between derivatives and Monte Carlo designs in standard errors; no number of these tests exceeds
/// it, since the seeds are fixed.
const ERRORS: f64 = 4.0;
/// Tolerance of angles, rad.
const ROUND_OFF: f64 = 1e-12;

#[test]
fn rss_and_monte_carlo_agree_on_the_strut() {
    let file = study("strut_tolerances.toml");
    let found = examined(&file, |asked| (asked.samples, asked.allocation) = (4000, None));
    let drawn = sampled(&found);
    assert_eq!((drawn.failed, drawn.samples), (0, 4000), "{:?}", drawn.failures);
    for (of, drawn) in found.metrics.iter().zip(&drawn.metrics) {
        assert!(!of.is_nonlinear(), "{:?}", of.nonlinearity());
        assert!(
            (drawn.sigma[0] - of.sigma).abs() < ERRORS * drawn.sigma[1],
            "{:?} {}",
            drawn.sigma,
            of.sigma
        );
        assert!((drawn.mean[0] - of.mean()).abs() < ERRORS * drawn.mean[1], "{:?} {}", drawn.mean, of.mean());
        assert!(of.worst[0].first < drawn.quantiles[1] && drawn.quantiles[3] < of.worst[1].first);
        near(of.shares.iter().sum(), 1.0, 1e-12);
    }
    for (limit, drawn) in found.limits.iter().zip(&drawn.limits) {
        let by_moments = limit.by_moments.unwrap();
        assert!((by_moments - drawn.part()).abs() < ERRORS * drawn.error(), "{limit:?}");
        assert!(by_moments > 0.5 && by_moments < 1.0, "{limit:?}");
    }
    for (curve, drawn) in found.curves.iter().zip(&drawn.curves) {
        for k in 0..curve.bands.len() {
            let [mean, sigma] = curve.moments(k);
            // Where the wheel is in the design configuration nothing moves it: what is left is round-off.
            let error = sigma / 4000_f64.sqrt() + ROUND_OFF;
            assert!((drawn.mean[k] - mean).abs() < ERRORS * error);
            assert!((drawn.sigma[k] - sigma).abs() < ERRORS * error);
        }
    }
}

/// Driven by its slider, which is 0.5 mm short of where the crank and the rod are in line.
fn near_dead_point(tolerance: f64) -> ModelFile {
    driven_near_dead_point(tolerance, "-t")
}

fn driven_near_dead_point(tolerance: f64, law: &str) -> ModelFile {
    let slider = format!("drivers.motor = {{ joint = \"slide\", law = \"{law}\" }}");
    let text = CRANK
        .replace("hardpoints = { O = [0, 0, 0], A = [\"radius*cos(40*pi/180)\", \"radius*sin(40*pi/180)\", 0], B = [300, \"offset\", 0] }",
            "hardpoints = { O = [0, 0, 0], A = [99.6249, 8.6547, 0], B = [399.5, 0, 0] }")
        .replace("parameters.offset = { value = 20, unit = \"length\" }\nparameters.radius = { value = 100, unit = \"length\" }\n", "")
        .replace("drivers.motor = { joint = \"pivot\", law = \"20*t\" }", &slider)
        .replace("type = \"position\", point = \"B\", along = \"x\"", "type = \"coordinate\", joint = \"pivot\"");
    model(&format!("{text}\n[tolerance]\nsamples = 20000\n[tolerance.variables]\nrod = {tolerance}\n"))
}

#[test]
fn near_a_dead_point_rss_fails_and_second_derivatives_detect_it() {
    let file = near_dead_point(0.6);
    let found = examined(&file, |asked| asked.samples = 100_000);
    let of = spread(&file, &found, "first");
    let drawn = &sampled(&found).metrics[0];
    // cos a = (r^2 + x^2 - l^2) / 2 r x:  a is about sqrt of what is left to the dead point.
    assert!(of.is_nonlinear() && of.nonlinearity().unwrap() > 0.1, "{:?}", of.nonlinearity());
    let off = |sigma: f64| (sigma - drawn.sigma[0]).abs() / drawn.sigma[1];
    assert!(off(of.sigma) > ERRORS, "{} {:?}", of.sigma, drawn.sigma);
    assert!(off(of.best_sigma()) < off(of.sigma), "{:?} {:?}", of.second, drawn.sigma);
    let shift = |mean: f64| (mean - drawn.mean[0]).abs();
    assert!(shift(of.mean()) < 0.3 * shift(of.nominal), "{} {} {:?}", of.mean(), of.nominal, drawn.mean);
    assert!(drawn.skewness.abs() > 0.2, "{}", drawn.skewness);
}

#[test]
fn designs_beyond_the_dead_point_are_counted_with_their_reason() {
    let file = near_dead_point(0.9);
    let found = examined(&file, |_| ());
    let drawn = sampled(&found);
    // The rod must not be shorter by more than 0.5 mm: 0.5 / 0.3 standard deviations.
    let expected = 0.5 * 20_000.0 * (1.0 - 0.904_419);
    assert!((drawn.failed as f64 - expected).abs() < ERRORS * expected.sqrt(), "{}", drawn.failed);
    assert_eq!(drawn.failures.iter().map(|f| f.count).sum::<usize>(), drawn.failed);
    assert!(drawn.failures.iter().all(|f| !f.why.is_empty() && f.first < 20_000));
    assert_eq!(drawn.metrics[0].known + drawn.failed, 20_000);
    let lowest = &spread(&file, &found, "first").worst[0];
    assert!(found.metrics.iter().any(|m| m.worst.iter().any(|e| e.why.is_some())), "{lowest:?}");
}

#[test]
fn designs_whose_expressions_have_no_value_fail() {
    let file = model(
        r#"
name = "tracer"
units = { length = "mm", angle = "deg" }
parameters.a = { value = 0, unit = "length", tolerance = 0.1 }
hardpoints.O = [0, 0, 0]
bodies.slider = {}
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = "O", axis = "x" }
drivers.motor = { joint = "slide", law = "t" }
points.Q = { body = "slider", at = ["10 + sqrt(0.05 - a)", "a", 0] }
measures.x = { type = "position", point = "Q", along = "x" }
metrics.x = { of = "x", take = "value", at = 0 }
time = { end = 1.0, steps = 1 }
[tolerance]
"#,
    );
    let analysis = Analysis::new(&file.model).unwrap();
    // The root vanishes at 0.05 mm: one of eight designs is beyond it.
    let designs: Vec<Vec<f64>> = (0..8).map(|k| vec![0.9e-5 * f64::from(k) - 1e-5]).collect();
    analysis.solve_designs(Run::new().without_sensitivities(), &designs, |k, solution| {
        let expected = 1e-2 + 1e-3 * (0.05 - 1e3 * designs[k][0]).max(0.0).sqrt();
        match (k, &solution.stop) {
            (7, Some(stop)) => {
                assert_eq!(stop.code(), "HP0412");
                let headline = "the expression for `Q.x` has no finite value in this design";
                assert_eq!(stop.headline(&file.model), headline);
                assert_eq!(solution.motion.len(), 0);
            }
            (_, Some(stop)) => panic!("{k}: {stop:?}"),
            (_, None) => assert!((solution.measured.value(0, 0)[0] - expected).abs() < 1e-12, "{k}"),
        }
    });
    let found = examined(&file, |_| ());
    let drawn = sampled(&found);
    // One and a half standard deviations
    let expected = 0.066_807_2 * drawn.samples as f64;
    assert!((drawn.failed as f64 - expected).abs() < ERRORS * expected.sqrt(), "{} {expected}", drawn.failed);
    assert!(drawn.failures.len() == 1 && drawn.failures[0].why.contains("`Q.x`"), "{:?}", drawn.failures);
}

#[test]
fn designs_that_fail_at_the_start_and_on_the_way_are_counted_apart() {
    let file = driven_near_dead_point(0.3, "0.2 + 0.2*t");
    let found = examined(&file, |_| ());
    let drawn = sampled(&found);
    // Rods that are shorter by 0.3 mm do not reach the start, and by 0.1 mm not the end: 0.1 mm is one sigma.
    let [start, end] = [0.001_349_9, 0.158_655].map(|part| 20_000.0 * part);
    let count = |words: &str| {
        let of = drawn.failures.iter().filter(|f| f.why.contains(words));
        of.map(|f| f.count as f64).sum::<f64>()
    };
    assert_eq!(drawn.failures.len(), 2, "{:?}", drawn.failures);
    let [at_start, on_the_way] = ["does not reach its start position", "cannot move beyond"].map(count);
    assert!((at_start - start).abs() < ERRORS * start.sqrt(), "{at_start} {start}");
    assert!((on_the_way - (end - start)).abs() < ERRORS * (end - start).sqrt(), "{on_the_way} {end}");
}

#[test]
fn correlated_tolerances_are_those_of_the_closed_form() {
    let (g, h) = closed_form();
    let s = [2e-3, 1e-3];
    for r in [0.8, -0.5, 1.0, -1.0] {
        let file = crank(&format!(
            "[tolerance.variables]\nrod = 6\noffset = 3\n[tolerance.correlations]\njig = {{ between = [\"offset\", \"rod\"], coefficient = {r} }}"
        ));
        let found = examined(&file, |_| ());
        let of = spread(&file, &found, "first");
        let parts = [g[0] * s[0], g[1] * s[1]];
        let variance = parts[0].powi(2) + parts[1].powi(2) + 2.0 * r * parts[0] * parts[1];
        near(of.sigma, variance.sqrt(), 1e-8);
        near(of.shares[0], (parts[0].powi(2) + r * parts[0] * parts[1]) / variance, 1e-7);
        // tr(H S) / 2 and tr(H S H S) / 2
        let [a, b, c] = [h[0][0] * s[0] * s[0], h[1][1] * s[1] * s[1], h[0][1] * s[0] * s[1]];
        let second = of.second.unwrap();
        near(second.shift, 0.5 * (a + b + 2.0 * r * c), DIFFERENCED);
        let square =
            a * a + b * b + 2.0 * c * c * (1.0 + r * r) + 4.0 * r * c * (a + b) + 2.0 * r * r * a * b;
        near(second.bend, (0.5 * square).sqrt(), 1e-4);
        let drawn = &sampled(&found).metrics[0];
        assert!((drawn.sigma[0] - of.best_sigma()).abs() < ERRORS * drawn.sigma[1], "{r}: {:?}", drawn.sigma);
        // However they go together, each may be at its worst.
        near(of.worst[1].first - of.nominal, 6e-3 * g[0].abs() + 3e-3 * g[1].abs(), 1e-9);
    }
}

#[test]
fn a_point_lies_in_a_sphere() {
    let file = study("strut_tolerances.toml");
    let found = examined(&file, |asked| {
        asked.tolerances.retain(|t| t.name == "ball_joint");
        asked.correlations.clear();
        asked.tolerances[0].scatter = hardpoint::model::Scatter::Uniform;
        (asked.samples, asked.allocation) = (4000, None);
    });
    assert_eq!(found.variables.len(), 3);
    let of = spread(&file, &found, "toe_range");
    let norm = of.d.iter().map(|x| x * x).sum::<f64>().sqrt();
    near(of.worst[1].first - of.nominal, 0.3e-3 * norm, 1e-9);
    // Evenly in a sphere a coordinate has variance t^2 / 5.
    near(of.sigma, 0.3e-3 * norm / 5.0_f64.sqrt(), 1e-12);
    let farthest = of.worst[1].deviations.iter().map(|x| x * x).sum::<f64>().sqrt();
    near(farthest, 0.3e-3, 1e-12);
    let place = found.metrics.iter().position(|m| std::ptr::eq(m, of)).unwrap();
    let drawn = &sampled(&found).metrics[place];
    assert!((drawn.sigma[0] - of.sigma).abs() < ERRORS * drawn.sigma[1]);
}

fn limits(asked: &mut ToleranceSettings, rule: AllocationRule, most: &[(usize, f64)]) {
    asked.allocation = Some(AllocationSettings { rule });
    let limit = |(metric, most): &(usize, f64)| Limit {
        name: format!("limit {metric}"),
        of: LimitTarget::Metric(*metric),
        least: None,
        most: Some(*most),
    };
    asked.limits = most.iter().map(limit).collect();
}

/// The barrier leaves some 1e-8 of the costs.
const BARRIER: f64 = 1e-6;

const COSTS: &str = "[tolerance.variables]\nrod = { tolerance = 0.6, cost = 2 }\noffset = { tolerance = 0.4, cost = 1 }\nradius = { tolerance = 0.3, cost = 5 }";

#[test]
fn the_allocation_to_one_limit_equals_the_closed_form() {
    let (g, _) = closed_form();
    let costs = [2.0, 1.0, 5.0];
    for (rule, power) in [(AllocationRule::Rss { sigmas: 3.0 }, 3.0), (AllocationRule::Worst, 2.0)] {
        let file = crank(COSTS);
        let found = examined(&file, |asked| {
            asked.samples = 0;
            limits(asked, rule, &[(0, 0.374)]);
        });
        let of = spread(&file, &found, "first");
        let room = 0.374 - of.nominal;
        // t = (c / g^2)^(1/3) or (c / |g|)^(1/2), all by one factor.
        let shape: Vec<f64> = (0..3)
            .map(|k| {
                if power == 3.0 { (costs[k] / (g[k] * g[k])).cbrt() } else { (costs[k] / g[k].abs()).sqrt() }
            })
            .collect();
        let used = match rule {
            AllocationRule::Rss { .. } => (0..3).map(|k| (g[k] * shape[k]).powi(2)).sum::<f64>().sqrt(),
            AllocationRule::Worst => (0..3).map(|k| (g[k] * shape[k]).abs()).sum::<f64>(),
        };
        let allocation = found.allocation.unwrap();
        assert!(allocation.error.is_none() && allocation.residual < 1e-6, "{:e}", allocation.residual);
        for k in 0..3 {
            near(allocation.tolerances[k].after.unwrap(), shape[k] * room / used, BARRIER);
        }
        // The costs go with 1 / room, so that a unit of room is worth costs / room.
        near(allocation.worth[0], allocation.cost[1] / room, BARRIER);
    }
}

#[test]
fn several_limits_are_allocated_optimally() {
    for rule in [AllocationRule::Rss { sigmas: 3.0 }, AllocationRule::Worst] {
        let file = crank(&format!(
            "{COSTS}\n[tolerance.correlations]\njig = {{ between = [\"rod\", \"radius\"], coefficient = 0.5 }}"
        ));
        let file = &file;
        let found = examined(file, |asked| {
            asked.samples = 0;
            limits(asked, rule, &[(0, 0.374), (1, 0.030_9)]);
        });
        let allocation = found.allocation.clone().unwrap();
        assert!(allocation.residual < 1e-6, "{:e}", allocation.residual);
        assert!(allocation.worth.iter().all(|w| *w >= 0.0) && allocation.worth.iter().any(|w| *w > 0.0));
        let best: Vec<f64> = allocation.tolerances.iter().map(|t| t.after.unwrap()).collect();
        let (costs, correlated) = ([2.0, 1.0, 5.0], 0.5);
        let cost = |t: &[f64]| (0..3).map(|k| costs[k] / t[k]).sum::<f64>();
        let used = |t: &[f64], of: &MetricSpread| match rule {
            AllocationRule::Worst => (0..3).map(|k| (of.d[k] * t[k]).abs()).sum::<f64>(),
            AllocationRule::Rss { .. } => {
                let [a, b, c] = [0, 1, 2].map(|k| of.d[k] * t[k]);
                (a * a + b * b + c * c + 2.0 * correlated * a * c).sqrt()
            }
        };
        let rooms = [0.374 - found.metrics[0].nominal, 0.030_9 - found.metrics[1].nominal];
        let kept = |t: &[f64]| (0..2).all(|j| used(t, &found.metrics[j]) <= rooms[j] * (1.0 + 1e-9));
        assert!(kept(&best));
        // No other way to use the same rooms costs less.
        let mut tried = 0;
        for i in -4..=4 {
            for j in -4..=4 {
                let mut other = [best[0] * 1.03_f64.powi(i), best[1], best[2] * 1.03_f64.powi(j)];
                let room = |t: &[f64]| {
                    (0..2).map(|l| rooms[l] / used(t, &found.metrics[l])).fold(f64::INFINITY, f64::min)
                };
                let by = room(&other);
                other.iter_mut().for_each(|t| *t *= by);
                assert!(kept(&other) && cost(&other) >= cost(&best) * (1.0 - BARRIER), "{other:?} {best:?}");
                tried += 1;
            }
        }
        assert_eq!(tried, 81);
    }
}

#[test]
fn the_tolerances_found_keep_the_limits_of_the_strut() {
    let file = study("strut_tolerances.toml");
    let found = examined(&file, |asked| asked.samples = 4000);
    let allocation = found.allocation.as_ref().unwrap();
    assert!(allocation.error.is_none() && allocation.residual < 1e-6, "{:e}", allocation.residual);
    let all = allocation.sampled.as_ref().unwrap().all.unwrap();
    // Three standard deviations to the nearer end of the limit that binds most.
    assert!(all.part() > 0.99 && all.part() > sampled(&found).all.unwrap().part(), "{all:?}");
    // What has no cost stays.
    assert!(
        allocation
            .tolerances
            .iter()
            .all(|t| file.model.tolerancing.as_ref().unwrap().tolerances[t.tolerance].cost.is_some())
    );
}

#[test]
fn impossible_allocations_are_reported() {
    let error_of = |text: &str, most: f64| {
        let file = crank(text);
        let found = examined(&file, |asked| {
            asked.samples = 0;
            limits(asked, AllocationRule::Worst, &[(0, most)]);
        });
        found.allocation.unwrap().error
    };
    assert_eq!(error_of(COSTS, 0.37), Some(AllocationError::NominalExceeds(0)));
    assert_eq!(
        error_of(&COSTS.replace("rod = { tolerance = 0.6, cost = 2 }", "rod = 6"), 0.374),
        Some(AllocationError::Fixed(0))
    );
    assert_eq!(error_of("[tolerance.variables]\nrod = 6", 0.374), Some(AllocationError::NoCosts));
    assert_eq!(error_of(COSTS, 0.374), None);
}

#[test]
fn results_do_not_depend_on_threads_or_on_the_number_of_samples() {
    let file = near_dead_point(0.9);
    let asked = |samples: usize| ToleranceSettings { samples, ..file.model.tolerancing.clone().unwrap() };
    let drawn = |threads: usize, samples: usize| {
        examined_on(threads, &file.model, &asked(samples)).unwrap().sampled.unwrap()
    };
    let bits = |found: &MonteCarlo| -> Vec<u64> {
        let of = |m: &hardpoint_study::tolerance::SampledMetric| {
            m.values.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
        };
        found.metrics.iter().flat_map(of).chain(found.curves[0].mean.iter().map(|x| x.to_bits())).collect()
    };
    let one = drawn(1, 2500);
    assert!(one.failed > 0);
    for threads in [2, 3, 7] {
        let several = drawn(threads, 2500);
        assert_eq!(bits(&one), bits(&several));
        assert_eq!(one.failures, several.failures);
    }
    let few = drawn(2, 1301);
    assert_eq!(few.samples, 1301);
    for (few, many) in few.metrics.iter().zip(&one.metrics) {
        let first: Vec<u64> = many.values[..1301].iter().map(|x| x.to_bits()).collect();
        assert_eq!(few.values.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), first);
    }
}

#[test]
fn samples_before_an_interruption_are_kept() {
    let file = crank("[tolerance.variables]\nrod = 6");
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let mut progress = |Progress { step, done, .. }: Progress<'_>| {
        let is_enough = matches!(step, Step::Designs) && done >= 1000;
        if is_enough { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let request = Request::of(&file.model, &Overrides::default()).unwrap();
    let control = Control { threads: THREADS, progress: &mut progress, more: &|| true };
    let found = tolerance(&file.model, &motions, &[0], &request, control).unwrap();
    assert!(found.interrupted);
    assert_eq!(sampled(&found).samples, 1024);
    assert_eq!(sampled(&found).metrics[0].values.len(), 1024);
}

#[test]
fn settings_are_read_in_si() {
    let file = study("strut_tolerances.toml");
    let model = &file.model;
    let asked = model.tolerancing.as_ref().unwrap();
    let names: Vec<&str> = asked.tolerances.iter().map(|t| t.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "ball_joint",
            "lca_front_z",
            "lca_rear_z",
            "tie_rod_outer_y",
            "tie_rod_outer_z",
            "tie_rod_inner_z",
            "strut_top_x",
            "strut_top_y"
        ]
    );
    assert_eq!(asked.tolerances[0].variables.len(), 3);
    near(asked.tolerances[0].reach, 0.3e-3, 1e-12);
    assert_eq!(asked.tolerances[0].scatter, hardpoint::model::Scatter::Truncated { sigmas: 2.0 });
    near(asked.limits[0].most.unwrap(), 1.85_f64.to_radians(), 1e-12);
    assert_eq!((asked.samples, asked.seed, asked.curves.len()), (10_000, 1, 2));
    assert!(model.motions().iter().all(|m| m.tolerancing.is_none()));
    // Without a table, the variables' own tolerances are requested.
    let own = ToleranceSettings::of_variables(model).unwrap();
    assert_eq!((own.tolerances.len(), own.metrics.len()), (model.variables.len(), model.metrics.len()));
}

const TOLERANCES: &str = "\n[metrics.top]\nof = \"height\"\ntake = \"max\"\n\n[tolerance]\nsigmas = 3\n[tolerance.variables]\nB_x = 0.1\nB_y = { tolerance = 0.2, cost = 2 }\nlean = 0.05\n[tolerance.correlations]\njig = { between = [\"B_x\", \"B_y\"], coefficient = 0.9 }\nother = { between = [\"B_y\", \"lean\"], coefficient = 0.2 }\n[tolerance.limits]\ntop = { max = 300 }\n";

#[test]
fn broken_tolerances() {
    let whole = |text: &str| format!("{}{text}", crate::diagnostics::VALID);
    parse(&whole(TOLERANCES), "four-bar.toml").unwrap_or_else(|e| panic!("{e}"));
    let broken = |name: &str, old: &str, new: &str| {
        assert!(TOLERANCES.contains(old), "{old}");
        crate::diagnostics::snapshot(name, &whole(&TOLERANCES.replacen(old, new, 1)));
    };
    broken("tolerance_of_unknown_variable", "B_x = 0.1", "C_x = 0.1");
    broken("tolerance_of_zero", "B_x = 0.1", "B_x = 0");
    broken("tolerance_that_is_a_text", "B_x = 0.1", "B_x = \"wide\"");
    broken("tolerance_without_a_size", "tolerance = 0.2, ", "");
    broken("tolerance_of_a_point_and_of_its_coordinate", "lean = 0.05", "lean = 0.05\nB = 0.3");
    broken("tolerance_of_unknown_distribution", "cost = 2", "distribution = \"gauss\"");
    broken("tolerance_uniform_with_sigmas", "cost = 2", "distribution = \"uniform\", sigmas = 2");
    broken("tolerance_of_negative_cost", "cost = 2", "cost = -2");
    broken("tolerance_with_no_sigmas", "sigmas = 3", "sigmas = 0");
    broken("tolerance_with_misspelt_key", "sigmas = 3", "sigma = 3");
    broken("tolerance_of_no_samples", "sigmas = 3", "samples = 0");
    broken("tolerance_of_unknown_curve", "sigmas = 3", "curves = [\"hight\"]");
    let without = TOLERANCES
        .replace("[tolerance.limits]\ntop = { max = 300 }\n", "")
        .replace("sigmas = 3", "allocate = \"rss\"");
    crate::diagnostics::snapshot("tolerance_allocated_without_limits", &whole(&without));
    broken(
        "tolerance_allocated_without_costs",
        "sigmas = 3\n[tolerance.variables]\nB_x = 0.1\nB_y = { tolerance = 0.2, cost = 2 }",
        "allocate = \"worst_case\"\n[tolerance.variables]\nB_x = 0.1\nB_y = 0.2",
    );
    broken("tolerance_with_sigmas_kept_of_nothing", "sigmas = 3", "required_sigmas = 4");
    broken("correlation_beyond_one", "coefficient = 0.9", "coefficient = 1.1");
    broken("correlation_with_itself", "\"B_x\", \"B_y\"", "\"B_x\", \"B_x\"");
    broken("correlation_twice", "between = [\"B_y\", \"lean\"]", "between = [\"B_y\", \"B_x\"]");
    broken("correlation_of_what_is_exact", "lean = 0.05\n", "");
    broken(
        "correlation_of_what_is_uniform",
        "lean = 0.05",
        "lean = { tolerance = 0.05, distribution = \"uniform\" }",
    );
    broken(
        "correlations_that_contradict",
        "coefficient = 0.2 }",
        "coefficient = 0.9 }\nthird = { between = [\"B_x\", \"lean\"], coefficient = -0.9 }",
    );
    broken("tolerance_limit_of_a_measure", "top = { max = 300 }", "height = { max = 300 }");
    broken("tolerance_limit_of_nothing", "top = { max = 300 }", "top = {}");
    broken("tolerance_limit_upside_down", "top = { max = 300 }", "top = { min = 400, max = 300 }");
    crate::diagnostics::snapshot("tolerance_of_nothing", &whole("\n[tolerance]\nsamples = 100\n"));
    crate::diagnostics::snapshot(
        "tolerance_as_a_number",
        &format!("tolerance = 0.1\n{}", crate::diagnostics::VALID),
    );
}

/// Slider-crank with play in its three pins, and one with a ball at the end of its rod.
const LOOSE_CRANK: &str = r#"
name = "loose slider-crank"
units = { length = "mm", angle = "deg" }
hardpoints = { O = [0, 0, 0], A = [80, 60, 0], B = [371.8089506, 0, 0] }
bodies = { crank = {}, rod = {}, slider = {} }
joints.main = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
joints.crank_pin = { type = "revolute", bodies = ["crank", "rod"], at = "A", axis = "z" }
joints.wrist_pin = { type = "spherical", bodies = ["rod", "slider"], at = "B" }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = "B", axis = "x" }
drivers.motor = { joint = "main", law = "300*t" }
points.B = { body = "slider", at = "B" }
measures.place = { type = "position", point = "B", along = "x" }
design.main = { play = "main", tolerance = 0.02 }
design.crank_pin = { play = "crank_pin", tolerance = 0.03 }
design.wrist_pin = { play = "wrist_pin", tolerance = 0.04 }
time = { end = 1.0, steps = 30 }
"#;

/// Places in holes of a radius, evenly distributed.
fn places_in_holes() -> impl FnMut(f64) -> [f64; 2] {
    let mut random = 1_u64;
    let mut draw = move || {
        // A plain generator: places in the holes need no more.
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 11) as f64 / (1_u64 << 53) as f64
    };
    move |c| {
        let (turn, far) = (std::f64::consts::TAU * draw(), c * draw().sqrt());
        [far * turn.cos(), far * turn.sin()]
    }
}

/// An offset e of any pin moves the slider by e along the rod over the cosine of the rod's angle: the band is the sum
/// of all plays over that, and holds whatever places the pins have in their holes.
#[test]
fn the_play_of_a_slider_crank_has_its_closed_form() {
    let file = model(LOOSE_CRANK);
    let found = examined(&file, |asked| asked.samples = 0);
    // The plane of the linkage holds the ball: it has no play across it.
    let left_out: Vec<&str> =
        found.left_out.iter().map(|v| file.model.variables[v.0].name.as_str()).collect();
    assert_eq!(left_out, ["wrist_pin_z"]);
    let names: Vec<&str> = file.model.variables.iter().map(|v| v.name.as_str()).collect();
    let all = ["main_x", "main_y", "crank_pin_x", "crank_pin_y", "wrist_pin_x", "wrist_pin_y", "wrist_pin_z"];
    assert_eq!(names, all);
    let plays = [0.02e-3, 0.03e-3, 0.04e-3];
    let r = 0.1_f64;
    let b = 0.371_808_950_6_f64;
    let rod = ((b - 0.08).powi(2) + 0.06 * 0.06).sqrt();
    let curve = &found.curves[0];
    let mut in_hole = places_in_holes();
    for (t, band) in curve.times.iter().zip(&curve.bands) {
        let angle = 0.6_f64.atan2(0.8) + (300.0 * t).to_radians();
        let (sin, cos) = angle.sin_cos();
        let tilt = (r * sin / rod).asin();
        let reach = plays.iter().sum::<f64>() / tilt.cos();
        let half = 0.5 * (band.first[1] - band.first[0]);
        assert!((half - reach).abs() < 1e-9 * reach, "t = {t}: {half} instead of {reach}");
        // Evenly in a disc: a quarter of the square of the radius per coordinate.
        let squares: f64 = plays.iter().map(|c| 0.25 * c * c).sum();
        let sigma = squares.sqrt() / tilt.cos();
        assert!((band.sigma - sigma).abs() < 1e-9 * sigma, "t = {t}: {} instead of {sigma}", band.sigma);
        // Places in all holes, solved exactly; beyond first order the error is e^2 / l.
        let second = plays.iter().sum::<f64>().powi(2) / rod / tilt.cos().powi(3);
        let mut widest = 0.0_f64;
        for _ in 0..100_000 / curve.times.len() {
            let [o, a, w] = plays.map(&mut in_hole);
            let [x, y] = [0, 1].map(|k| o[k] + a[k] + w[k] + r * [cos, sin][k]);
            let place = x + (rod * rod - y * y).sqrt();
            widest = widest.max((place - band.nominal).abs());
            assert!((place - band.nominal).abs() <= reach + second, "t = {t}");
            let [least, greatest] = band.worst;
            assert!(least <= place && place <= greatest, "t = {t}: {place} beyond {least} to {greatest}");
        }
        assert!(band.solved && (band.worst[1] - band.worst[0] - 2.0 * reach).abs() < second, "t = {t}");
        assert!(widest > 0.7 * reach, "t = {t}: the samples fill the band");
    }
}

/// The follower of a four-bar turns by the offset along the coupler over the arm `b sin(mu)`, for each of four pins.
/// The band holds whatever places the pins have in their holes.
#[test]
fn the_play_of_a_four_bar_has_its_closed_form() {
    let text = r#"
name = "loose four-bar"
units = { length = "mm", angle = "rad" }
planar = "xy"
hardpoints = { A = [0, 0], B = [0, 100], C = [300, 250], D = [300, 0] }
bodies = { crank = {}, coupler = {}, rocker = {} }
joints.A = { type = "revolute", bodies = ["ground", "crank"], at = "A" }
joints.B = { type = "revolute", bodies = ["crank", "coupler"], at = "B" }
joints.C = { type = "revolute", bodies = ["coupler", "rocker"], at = "C" }
joints.D = { type = "revolute", bodies = ["ground", "rocker"], at = "D" }
drivers.motor = { joint = "A", law = "2*t" }
measures.output = { type = "coordinate", joint = "D" }
points.B = { body = "coupler", at = "B" }
points.C = { body = "coupler", at = "C" }
measures.mu = { type = "transmission_angle", from = ["B", "C"], to = [{ body = "rocker", at = "D" }, "C"] }
design.A_play = { play = "A", tolerance = 0.01 }
design.B_play = { play = "B", tolerance = 0.01 }
design.C_play = { play = "C", tolerance = 0.01 }
design.D_play = { play = "D", tolerance = 0.01 }
time = { end = 1.0, steps = 20 }
"#;
    let file = model(text);
    let found = examined(&file, |asked| asked.samples = 0);
    let curve = found.curves.iter().find(|c| file.model.measures[c.measure].name == "output").unwrap();
    let angle = found.curves.iter().find(|c| file.model.measures[c.measure].name == "mu").unwrap();
    let (crank, coupler, rocker, play) = (100.0_f64, 300.0_f64.hypot(150.0), 250.0_f64, 0.01_f64);
    let mut in_hole = places_in_holes();
    for ((t, band), mu) in curve.times.iter().zip(&curve.bands).zip(&angle.bands) {
        let half = 0.5 * (band.first[1] - band.first[0]);
        let sin = mu.nominal.sin();
        let expected = 4.0 * play / (rocker * sin);
        assert!((half - expected).abs() < 1e-9 * expected, "{half} instead of {expected}");
        // Angle of the rocker where the pins have offsets of this sum, from its position in the design configuration.
        let quarter = std::f64::consts::FRAC_PI_2;
        let output = |[x, y]: [f64; 2]| {
            let (turn_sin, turn_cos) = (quarter + 2.0 * t).sin_cos();
            let [dx, dy] = [crank * turn_cos + x - 300.0, crank * turn_sin + y];
            let far = dx.hypot(dy);
            let cos = (rocker * rocker + far * far - coupler * coupler) / (2.0 * rocker * far);
            dy.atan2(dx).rem_euclid(std::f64::consts::TAU) - cos.acos() - quarter
        };
        assert!((output([0.0; 2]) - band.nominal).abs() < 1e-9, "t = {t}: {}", band.nominal);
        // e^2 times the largest second derivative by an offset e: twice the error beyond first order.
        let second = (1.0 + 2.0 / sin + (1.0 + coupler / rocker) / (sin * sin)) * (4.0 * play).powi(2)
            / (rocker * coupler * sin);
        let mut widest = 0.0_f64;
        for _ in 0..100_000 / curve.times.len() {
            let offsets = [play; 4].map(&mut in_hole);
            let value = output([0, 1].map(|k| offsets.iter().map(|o| o[k]).sum()));
            widest = widest.max((value - band.nominal).abs());
            assert!((value - band.nominal).abs() <= half + second, "t = {t}");
            let [least, greatest] = band.worst;
            assert!(least <= value && value <= greatest, "t = {t}: {value} beyond {least} to {greatest}");
        }
        assert!(band.solved && (band.worst[1] - band.worst[0] - 2.0 * half).abs() < second, "t = {t}");
        assert!(widest > 0.65 * half, "t = {t}: the samples fill the band");
    }
    // In a joint without a pin there is no play.
    let message = parse(&text.replace("play = \"D\"", "play = \"E\""), "t.toml").unwrap_err().to_string();
    assert!(message.contains("HP0204") && message.contains("`E`"), "{message}");
    let message =
        parse(&LOOSE_CRANK.replace("play = \"main\"", "play = \"slide\""), "t.toml").unwrap_err().to_string();
    assert!(message.contains("HP0275") && message.contains("joint `slide` of design variable"), "{message}");
}

/// A force that pushes the slider back holds all pins of the massless linkage on one side of their holes, a pull on
/// the other: the slider is at the edges of the band, and jumps where the force reverses.
#[test]
fn pins_lie_on_the_side_of_the_force() {
    let text = LOOSE_CRANK.to_owned()
        + r#"
[forces.push]
type = "force"
at = "B"
force = 100
along = "-x"
law = "cos(pi*t/0.8)"
"#;
    let file = model(&text);
    let found = examined(&file, |asked| asked.samples = 0);
    let curve = &found.curves[0];
    for (t, band) in curve.times.iter().zip(&curve.bands) {
        let expected = if *t < 0.4 { band.first[0] } else { band.first[1] };
        // At 0.4 s there is no force.
        let Some(loaded) = band.loaded else {
            assert_eq!(*t, 0.4);
            continue;
        };
        assert!((loaded - expected).abs() < 1e-9 * (band.first[1] - band.first[0]), "t = {t}: {loaded}");
    }
    assert_eq!(found.side_changes.len(), 3, "{:?}", found.side_changes);
    for change in &found.side_changes {
        let [time] = change.times[..] else { panic!("{change:?}") };
        // The force vanishes at an output time but for round-off, and is the same for all pins.
        assert!((time - 0.4).abs() < 1e-12, "{change:?}");
    }
    // Without loads nothing is known.
    let found = examined(&model(LOOSE_CRANK), |asked| asked.samples = 0);
    assert!(found.curves[0].bands.iter().all(|band| band.loaded.is_none()) && found.side_changes.is_empty());
}

/// Forces that hold the ram of a slider-crank in balance leave its pins without a force but for round-off: they lie on
/// no side.
#[test]
fn round_off_pushes_a_pin_to_no_side() {
    let text = LOOSE_CRANK.to_owned()
        + r#"
forces.push = { type = "force", at = "B", force = -100, along = "x" }
forces.pull = { type = "force", at = "B", force = 33.3, along = "x" }
forces.rest = { type = "force", at = "B", force = 66.7, along = "x" }
"#;
    let found = examined(&model(&text), |asked| asked.samples = 0);
    assert!(found.side_changes.is_empty(), "{:?}", found.side_changes);
    assert!(found.curves[0].bands.iter().all(|band| band.loaded.is_none()));
}

/// A constant force on the ram never leaves the rod, which only turns: with three intervals in a turn of the crank, by
/// more than a right angle between output times as seen from the crank.
#[test]
fn a_force_that_turns_between_output_times_changes_no_sides() {
    let text = LOOSE_CRANK.replace("300*t", "10 + 360*t").replace("steps = 30", "steps = 3")
        + "forces.push = { type = \"force\", at = \"B\", force = -1000, along = \"x\" }\n";
    let found = examined(&model(&text), |asked| asked.samples = 0);
    assert!(found.side_changes.is_empty(), "{:?}", found.side_changes);
    // The same with a force that vanishes between output times.
    let reversed = text.replace("force = -1000,", "force = -1000, law = \"1 - t/0.9\",");
    let found = examined(&model(&reversed), |asked| asked.samples = 0);
    // The crank, which turns by a third of a turn in between, does not see it at its main pin.
    let joints: Vec<usize> = found.side_changes.iter().map(|change| change.joint.0).collect();
    assert_eq!(joints, [1, 2], "{:?}", found.side_changes);
    for change in &found.side_changes {
        let [time] = change.times[..] else { panic!("{change:?}") };
        assert!((time - 0.9).abs() < 1e-4, "{change:?}");
    }
}

/// The rocker of a four-bar whose pin C is anywhere within 0.1 mm of its place: its angle is between those of circles
/// about B and D whose radii differ by the play. To first order the maximum is short of the samples.
#[test]
fn a_band_contains_the_sampled_designs() {
    let text = r#"
name = "band"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { A = [0, 0], B = [0, 40], C = [68.26354704916238, 61.26824262290596], D = [100, 0] }
bodies = { ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C"], rocker = ["C", "D"] }
drivers.motor = { joint = "A", law = "360*t" }
design.pC = { play = "C", tolerance = 0.1 }
measures.phi = { type = "coordinate", joint = "D" }
time = { end = 1.0, steps = 24 }
"#;
    let file = model(text);
    // Enough that first-order bands, which are short by 5 % of their half width, do not contain them.
    let found = examined(&file, |asked| asked.samples = 2000);
    let (curve, drawn) = (&found.curves[0], &found.sampled.as_ref().unwrap().curves[0]);
    let mut beyond_first = 0;
    for (k, band) in curve.bands.iter().enumerate() {
        let ([least, greatest], samples) = (band.worst, [drawn.least[k], drawn.greatest[k]]);
        assert!(band.solved && least <= samples[0] && samples[1] <= greatest, "{band:?} {samples:?}");
        let [least, greatest] = band.first;
        beyond_first += usize::from(samples[0] < least || greatest < samples[1]);
    }
    assert!(beyond_first > 0, "samples are beyond first-order bands");
    // Closed form at 0.25 s, from the circles about B and D.
    let k = curve.times.iter().position(|t| *t == 0.25).unwrap();
    for (side, expected) in [57.2220_f64, 58.2155].into_iter().enumerate() {
        let angle = curve.bands[k].worst[side].to_degrees();
        assert!((angle - expected).abs() < 1e-4, "{angle} instead of {expected}");
    }
}

/// A slider with a point whose coordinates in mm are functions of a and b, each of tolerance 0.1.
fn curved(x: &str, y: &str, more: &str) -> ModelFile {
    model(&format!(
        r#"
name = "curved"
units = {{ length = "mm", angle = "deg" }}
planar = "xy"
parameters = {{ a = {{ value = 0, tolerance = 0.1 }}, b = {{ value = 0, tolerance = 0.1 }} }}
hardpoints.A = [0, 0]
bodies.slider = {{}}
joints.slide = {{ type = "translational", bodies = ["ground", "slider"], at = "A", axis = "x" }}
drivers.motor = {{ joint = "slide", law = "t" }}
points.Q = {{ body = "slider", at = ["{x}", "{y}"] }}
metrics.x = {{ of = "Q.x", take = "value", at = 0 }}
metrics.y = {{ of = "Q.y", take = "value", at = 0 }}
time = {{ end = 1, steps = 1 }}
[tolerance]
{more}
"#
    ))
}

/// Contributions to a metric, and the part that is due to interactions.
fn contributions(file: &ModelFile, found: &ToleranceResult, metric: &str) -> (Vec<f64>, Option<f64>) {
    let k = found.metrics.iter().position(|m| file.model.metrics[m.metric].name == metric).unwrap();
    (found.contributions[k].shares.clone(), found.contributions[k].together)
}

fn has_no_spread(file: &ModelFile, found: &ToleranceResult, metric: &str) {
    let k = found.metrics.iter().position(|m| file.model.metrics[m.metric].name == metric).unwrap();
    let (of, drawn) = (&found.metrics[k], &sampled(found).metrics[k]);
    assert_eq!((of.sigma, of.second.unwrap().sigma, drawn.sigma), (0.0, 0.0, [0.0; 2]), "{metric}");
    assert!(!found.is_nonlinear(k) && !found.differs_from_samples(k), "{metric}");
    let (shares, together) = contributions(file, found, metric);
    assert!(shares.iter().all(|share| *share == 0.0) && together.is_none(), "{metric}: {shares:?}");
}

#[test]
fn metrics_that_do_not_depend_on_the_design_have_no_spread() {
    // A tracer point varies, and with it nothing of the rocker.
    let file = model(
        r#"
name = "tracer"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { A = [0, 0], B = [30, 10], C = [95, 58], D = [110, -5], P = [60, 60] }
bodies = { ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C", "P"], rocker = ["C", "D"] }
drivers.motor = { joint = "A", law = "360*t" }
design.P = { move = "P", along = "xy", tolerance = 0.2 }
measures.y = { type = "position", point = "P", along = "y" }
measures.psi = { type = "coordinate", joint = "D" }
metrics.height = { of = "y", take = "range" }
metrics.greatest = { of = "psi", take = "max" }
metrics.swing = { of = "psi", take = "range" }
metrics.angle = { of = "psi", take = "value", at = 0.3 }
tolerance.samples = 1500
time = { end = 1, steps = 12 }
"#,
    );
    let found = examined(&file, |_| ());
    for metric in ["greatest", "swing", "angle"] {
        has_no_spread(&file, &found, metric);
    }
    let shares: f64 = contributions(&file, &found, "height").0.iter().sum();
    near(shares, 1.0, 1e-9);
    // A sum of two variables with the correlation -1 is constant.
    let pair = "samples = 1500\ncorrelations.ab = { between = [\"a\", \"b\"], coefficient = -1 }";
    let file = curved("10 + a + b", "a - b", pair);
    let found = examined(&file, |_| ());
    has_no_spread(&file, &found, "x");
    near(spread(&file, &found, "y").sigma, 2.0 * 0.1e-3 / 3.0, 1e-9);
}

#[test]
fn one_variable_has_no_interactions() {
    let file = curved("10 + a^2", "a^3 + 1e-3*a", "");
    for samples in [1000, 4000] {
        let found = examined(&file, |asked| asked.samples = samples);
        // The RSS of a square is 0, and the second derivatives are known.
        assert_eq!(spread(&file, &found, "x").nonlinearity(), Some(f64::INFINITY));
        for metric in ["x", "y"] {
            let (shares, together) = contributions(&file, &found, metric);
            assert!(
                shares[0] > 0.999 && together.unwrap() < 1e-3,
                "{samples} {metric}: {shares:?} {together:?}"
            );
        }
    }
}

#[test]
fn a_worst_case_without_first_and_second_derivatives_is_in_order() {
    // The gradients at the first corners lead to the others.
    for (function, expected) in [
        ("b^3", [-1e-6, 1e-6]),
        ("-b^3", [-1e-6, 1e-6]),
        ("b^4", [0.0, 1e-7]),
        ("-b^4", [-1e-7, 0.0]),
        ("a^3 - b^3", [-2e-6, 2e-6]),
        ("8*b^3 - a^3", [-9e-6, 9e-6]),
    ] {
        let file = curved("10 + a", function, "");
        let found = examined(&file, |asked| asked.samples = 0);
        for (extreme, expected) in spread(&file, &found, "y").worst.iter().zip(expected) {
            assert!((extreme.exact.unwrap() - expected).abs() < 1e-15, "{function}: {extreme:?}");
        }
        // The nominal design, two for each second derivative, and at most two for each of the four worst cases.
        assert!(found.cost.designs <= 1 + 2 * 2 + 4 * 2, "{function}: {:?}", found.cost);
    }
}

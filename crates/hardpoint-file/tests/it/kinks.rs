//! Magnitudes and angles between directions where the vector that they measure vanishes: the value is right, rates and
//! derivatives are unknown, and metrics of the curve are those of closed forms.

use hardpoint::model::{OutputSource, VariableId};
use hardpoint::run::{MetricValue, metrics};
use hardpoint::{Analysis, Run};
use hardpoint_file::{ModelFile, parse};

fn parsed(text: &str) -> ModelFile {
    parse(text, "kinks.toml").unwrap_or_else(|e| panic!("{e}"))
}

/// A body on a universal joint with inclined axes, so that nothing is parallel, at rest or together but for round-off.
/// It passes the design configuration at 0, 0.5 and 1 s, and is at rest at 0.25 and 0.75 s.
const SWINGING: &str = r#"
name = "swinging"
units = { length = "mm", angle = "deg" }
hardpoints = { O = [0, 0, 0], P = [100.3, 20.7, 33.1] }
bodies = { a = {} }
joints.u = { type = "universal", bodies = ["ground", "a"], at = "O", axis = [0.3, 0, 1], axis2 = [1, 0.2, -0.3] }
drivers.d1 = { joint = "u", coordinate = "angle", law = "10*sin(2*pi*t)" }
drivers.d2 = { joint = "u", coordinate = "angle2", law = "20*sin(2*pi*t)" }
points.P = { body = "a", at = "P" }
design.p = { move = "P", along = "xyz" }
design.o = { move = "O", along = "z" }
time = { end = 1.0, steps = 40 }
"#;

/// Measures with their singular times: those of the design configuration, or those at rest.
const SINGULAR: [(&str, bool); 10] = [
    (r#"{ type = "articulation", joint = "u" }"#, true),
    (r#"{ type = "articulation", joint = "u", axis = [0.3, 0.7, 0.2] }"#, true),
    (r#"{ type = "angle", from = [0.3, 0.7, 0.2], to = { body = "a", axis = [0.3, 0.7, 0.2] } }"#, true),
    (r#"{ type = "angle", from = [-0.3, -0.7, -0.2], to = { body = "a", axis = [0.3, 0.7, 0.2] } }"#, true),
    (
        r#"{ type = "angle", from = [1, 0, 0], to = { body = "a", axis = [0.3, 0.7, 0.2] }, about = [3, 7, 2] }"#,
        true,
    ),
    (
        r#"{ type = "transmission_angle", from = [0.3, 0.7, 0.2], to = { body = "a", axis = [0.3, 0.7, 0.2] } }"#,
        true,
    ),
    (
        r#"{ type = "transmission_angle", from = [0.7, -0.3, 0], to = { body = "a", axis = [0.3, 0.7, 0.2] } }"#,
        true,
    ),
    (r#"{ type = "velocity", point = "P" }"#, false),
    (r#"{ type = "angular_velocity", body = "a" }"#, false),
    (r#"{ type = "curvature", point = "P" }"#, false),
];

/// Rates next to a singular time may be smaller than at it by this factor: the interval is a 40th of the period.
const NEXT: f64 = 1.1;

#[test]
fn no_measure_exceeds_its_neighbours_at_a_singular_value() {
    let measures = SINGULAR.iter().enumerate().map(|(k, (m, _))| format!("measures.m{k} = {m}\n"));
    let file = parsed(&(SWINGING.to_owned() + &measures.collect::<String>()));
    let solution = Analysis::new(&file.model).unwrap().run();
    let measured = &solution.measured;
    for (m, (text, in_design)) in SINGULAR.iter().enumerate() {
        assert_eq!(measured.outputs[m].source, OutputSource::Measure(m));
        let orders = measured.outputs[m].known.orders;
        let numbers = |k: usize| {
            let by = (0..file.model.variables.len()).map(|v| measured.d(k, VariableId(v), m)[0]);
            let of = measured.value(k, m);
            (of[0], of[1..orders].iter().copied().chain(by).map(f64::abs).collect::<Vec<f64>>())
        };
        let mut unknown = 0;
        for k in (if *in_design { 0 } else { 10 }..=40).step_by(20) {
            let (value, rest) = numbers(k);
            let around: Vec<_> = [
                k.checked_sub(1),
                Some(k + 1).filter(|k| *k <= 40),
                k.checked_sub(2),
                Some(k + 2).filter(|k| *k <= 40),
            ]
            .into_iter()
            .flatten()
            .map(numbers)
            .collect();
            let low = around.iter().map(|a| a.0).fold(f64::INFINITY, f64::min);
            let high = around.iter().map(|a| a.0).fold(0.0, f64::max);
            let span = high - low;
            let near = value.is_nan() || (low - 2.0 * span <= value && value <= high + 2.0 * span);
            assert!(near, "{text} at time {k}: {value} between {low} and {high}");
            for (n, x) in rest.iter().enumerate() {
                let most = around.iter().map(|a| a.1[n]).fold(0.0, f64::max);
                assert!(
                    x.is_nan() || *x <= NEXT * most + 1e-12,
                    "{text} at time {k}, number {n}: {x} {most}"
                );
            }
            unknown += usize::from(rest.iter().any(|x| x.is_nan()));
        }
        assert!(unknown > 0, "{text} is not singular");
    }
}

/// A body that swings by 20 degrees about an inclined axis n = (1, 2, 2) / 3, with u = (2, 1, -2) / 3 and
/// w = (2, -2, 1) / 3 perpendicular to it: its angles and distances are closed forms in `abs(sin)`.
fn pendulum(steps: usize, metrics: &str) -> ModelFile {
    parsed(&format!(
        r#"
name = "pendulum"
units = {{ length = "mm", angle = "deg" }}
parameters = {{ r = {{ value = 90, unit = "length" }} }}
hardpoints.O = [0, 0, 0]
hardpoints.P = ["2*r/3", "r/3", "-2*r/3"]
hardpoints.G = ["2*r/3", "r/3", "-2*r/3+1e-7"]
hardpoints.N = ["2*r/3+1e-5", "r/3+2e-5", "-2*r/3+2e-5"]
bodies = {{ a = {{}} }}
joints.p = {{ type = "revolute", bodies = ["ground", "a"], at = "O", axis = [1, 2, 2] }}
drivers.d = {{ joint = "p", law = "20*sin(2*pi*t)" }}
points.P = {{ body = "a", at = "P" }}
points.G = {{ body = "ground", at = "G" }}
points.N = {{ body = "ground", at = "N" }}
measures.angle = {{ type = "angle", from = [2, 1, -2], to = {{ body = "a", axis = [2, 1, -2] }} }}
measures.joint = {{ type = "articulation", joint = "p", axis = [2, 1, -2] }}
measures.line = {{ type = "transmission_angle", from = [2, -2, 1], to = {{ body = "a", axis = [2, 1, -2] }} }}
measures.far = {{ type = "distance", from = "P", to = "G" }}
measures.near_miss = {{ type = "distance", from = "P", to = "N" }}
time = {{ end = 1.0, steps = {steps} }}
{metrics}"#
    ))
}

/// Mean over a period of a function of the angle, rad, by the midpoint rule on a quarter, over which it is smooth.
fn mean(f: impl Fn(f64) -> f64) -> f64 {
    let n = 20_000;
    let phi = |k: u32| {
        20_f64.to_radians() * ((f64::from(k) + 0.5) / f64::from(n) * std::f64::consts::FRAC_PI_2).sin()
    };
    (0..n).map(|k| f(phi(k))).sum::<f64>() / f64::from(n)
}

/// Error of a metric beyond its own estimate, as a fraction of the curve's range: the error is estimated, not bounded.
const BEYOND: f64 = 2e-7;

#[test]
fn metrics_of_curves_with_kinks_are_those_of_closed_forms() {
    let (r, top) = (0.09, 20_f64.to_radians());
    let chord = |phi: f64| 2.0 * r * (0.5 * phi).sin();
    // Points that coincide are no distance in a model: G is 1e-7 mm from P, and N 3e-5 mm, along the axis.
    let miss = |phi: f64| chord(phi).hypot(3e-8);
    let right = std::f64::consts::FRAC_PI_2;
    type Curve<'a> = (&'a str, &'a dyn Fn(f64) -> f64);
    let curves: [Curve<'_>; 5] = [
        ("angle", &|phi| phi),
        ("joint", &|phi| phi),
        ("line", &|phi| right - phi),
        ("far", &chord),
        ("near_miss", &miss),
    ];
    let takes = ["max", "min", "mean", "rms", "range"];
    let lines = curves.iter().flat_map(|(name, _)| {
        takes
            .iter()
            .map(move |take| format!("metrics.{name}_{take} = {{ of = \"{name}\", take = \"{take}\" }}\n"))
    });
    let lines: String = lines.collect();
    // Kinks at output times, and between them.
    for steps in [4, 5, 7, 20, 33] {
        let file = pendulum(steps, &lines);
        for run in [Run::new(), Run::new().without_sensitivities()] {
            let solution = Analysis::new(&file.model).unwrap().solve(run);
            let found = metrics(&file.model, &solution);
            let of = |name: &str| -> &MetricValue {
                &found[file.model.metrics.iter().position(|m| m.name == name).expect(name)]
            };
            for (name, f) in curves {
                let [a, b] = [f(0.0), f(top)];
                let (most, least) = (a.max(b), a.min(b));
                let expected = [most, least, mean(f), mean(|phi| f(phi).powi(2)).sqrt(), most - least];
                for (take, expected) in takes.iter().zip(expected) {
                    let m = of(&format!("{name}_{take}"));
                    let (value, error) = (m.value.expect("a value"), m.error.unwrap_or(0.0));
                    let apart = (value - expected).abs();
                    assert!(
                        apart <= error + BEYOND * (most - least) && error <= 1e-3 * (most - least),
                        "{steps} steps, {name} {take}: {value} {expected}, estimate {error:e}"
                    );
                }
            }
        }
        // By the radius, all distances are proportional to it.
        let solution = Analysis::new(&file.model).unwrap().run();
        let found = metrics(&file.model, &solution);
        for (name, expected) in [("far_max", chord(top) / r), ("far_mean", mean(chord) / r)] {
            let k = file.model.metrics.iter().position(|m| m.name == name).expect(name);
            let d = found[k].d[0];
            assert!((d - expected).abs() < 1e-6 * expected, "{steps} steps, {name}: {d} {expected}");
        }
    }
}

/// A point on two slides that returns to its place at the end, but for round-off.
#[test]
fn roots_of_sums_of_squares_have_no_false_extrema_where_they_vanish_but_for_round_off() {
    const SAMPLES: u32 = 200_000;
    for (p, q) in [(1.0_f64, 2.0_f64), (0.3, 2.5), (0.7, 2.0)] {
        let at = |k: u32| {
            let place = |phase: f64| {
                let angle = 2.0 * std::f64::consts::PI * f64::from(k) / f64::from(SAMPLES) + phase;
                0.2 * angle.sin() - 0.2 * phase.sin()
            };
            place(p).hypot(place(q))
        };
        let greatest = (0..SAMPLES).map(at).fold(0.0, f64::max);
        let mean = (0..SAMPLES).map(at).sum::<f64>() / f64::from(SAMPLES);
        for steps in [30, 60, 121] {
            let file = parsed(&format!(
                r#"
name = "reach"
units = {{ length = "m", angle = "rad" }}
planar = "xy"
hardpoints = {{ A = [0, 0], T = [0, 0] }}
bodies = {{ s = {{}}, q = {{}} }}
joints.a = {{ type = "translational", bodies = ["ground", "q"], at = "A", axis = "x" }}
joints.b = {{ type = "translational", bodies = ["q", "s"], at = "A", axis = "y" }}
drivers.x = {{ joint = "a", law = "0.2*sin(2*pi*t + {p}) - 0.2*sin({p})" }}
drivers.y = {{ joint = "b", law = "0.2*sin(2*pi*t + {q}) - 0.2*sin({q})" }}
points.tool = {{ body = "s", at = "T" }}
measures.reach = {{ type = "expression", expression = "hypot(tool.x, tool.y)" }}
measures.root = {{ type = "expression", expression = "sqrt(tool.x^2 + tool.y^2)" }}
measures.beyond = {{ type = "expression", expression = "1 + hypot(tool.x, tool.y)" }}
metrics.most = {{ of = "reach", take = "max" }}
metrics.most_of_root = {{ of = "root", take = "max" }}
metrics.mean = {{ of = "reach", take = "mean" }}
metrics.most_beyond = {{ of = "beyond", take = "max" }}
time = {{ end = 1, steps = {steps} }}
"#
            ));
            let found = metrics(&file.model, &Analysis::new(&file.model).unwrap().run());
            for (metric, expected) in found.iter().zip([greatest, greatest, mean, 1.0 + greatest]) {
                // Samples miss the extremum by the square of their distance.
                let apart = metric.value.map(|value| (value - expected).abs());
                assert!(apart.is_some_and(|d| d < 1e-8), "{p} {q} {steps}: {metric:?} {expected}");
            }
        }
    }
}

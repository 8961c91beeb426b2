//! Metrics: values by closed forms, derivatives against designs that are solved anew.

use std::path::Path;

use hardpoint::model::VariableId;
use hardpoint::run::metrics;
use hardpoint::{Analysis, Run};
use hardpoint_file::{ModelFile, Texts, parse, parse_with};
use hardpoint_study::validity;

fn parsed(text: &str) -> ModelFile {
    parse(text, "metrics.toml").unwrap_or_else(|e| panic!("{e}"))
}

/// A point that a crank of length a carries around: x = a cos t, y = a sin t.
const CRANK: &str = r#"
name = "crank"
units = { length = "mm", angle = "deg" }
parameters = { a = { value = 100, unit = "length" } }
hardpoints = { O = [0, 0, 0], A = ["a", 0, 0] }
bodies = { crank = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
drivers.motor = { joint = "pivot", law = "t*180/pi" }
points.A = { body = "crank", at = "A" }
measures.vx = { type = "velocity", point = "A", along = "x" }
metrics.top = { of = "A.y", take = "max" }
metrics.left = { of = "A.x", take = "min" }
metrics.span = { of = "A.y", take = "range" }
metrics.top_near_start = { of = "A.y", over = "A.x", take = "max", window = [50, 1000] }
metrics.span_near_start = { of = "A.y", over = "A.x", take = "range", window = [50, 1000] }
metrics.height = { of = "A.y", over = "A.x", take = "value", at = 30 }
metrics.slope = { of = "A.y", over = "A.x", take = "slope", at = 30 }
metrics.at_one = { of = "A.y", take = "value", at = 1 }
metrics.speed = { of = "A.y", take = "slope", at = 1 }
metrics.mean = { of = "A.y", take = "mean" }
metrics.integral = { of = "A.y", take = "integral" }
metrics.area = { of = "A.y", over = "A.x", take = "integral" }
metrics.rms = { of = "A.x", take = "rms" }
metrics.off_line = { of = "A.y", over = "A.x", take = "rms", target = [[-100, 50], [100, 50]] }
metrics.fastest = { of = "vx", take = "min" }
metrics.never = { of = "A.y", over = "A.x", take = "value", at = 200 }
time = { end = 3.0, steps = 120 }
"#;

#[test]
fn values_and_derivatives_on_a_circle_are_those_of_the_formulas() {
    let file = parsed(CRANK);
    let solution = Analysis::new(&file.model).unwrap().run();
    let found = metrics(&file.model, &solution);
    let a = 0.1_f64;
    let (x, y) = (0.03, (a * a - 0.03_f64 * 0.03).sqrt());
    let end = 3.0_f64;
    // Name, value, derivative by a, time, and how far off the interpolation may be.
    let mean = (1.0 - end.cos()) / end;
    let rms = (0.5 + (2.0 * end).sin() / (4.0 * end)).sqrt();
    let cut = (a * a - 0.0025).sqrt();
    // The integral of sin(t) d(cos(t)).
    let area = (2.0 * end).sin() / 4.0 - end / 2.0;
    let expected = [
        ("top", a, 1.0, Some(std::f64::consts::FRAC_PI_2), 1e-12),
        ("left", a * end.cos(), end.cos(), Some(end), 1e-12),
        ("span", a, 1.0, None, 1e-12),
        ("top_near_start", cut, a / cut, Some((0.05 / a).acos()), 1e-10),
        ("height", y, a / y, Some((x / a).acos()), 1e-10),
        ("slope", -x / y, x * a / (y * y * y), Some((x / a).acos()), 1e-9),
        ("at_one", a * 1.0_f64.sin(), 1.0_f64.sin(), Some(1.0), 1e-12),
        ("speed", a * 1.0_f64.cos(), 1.0_f64.cos(), Some(1.0), 1e-12),
        ("mean", a * mean, mean, None, 1e-11),
        ("integral", a * mean * end, mean * end, None, 1e-11),
        // Its abscissa goes back all the time: less the area below the circle.
        ("area", a * a * area, 2.0 * a * area, None, 1e-11),
        ("rms", a * rms, rms, None, 1e-11),
        ("fastest", -a, -1.0, Some(std::f64::consts::FRAC_PI_2), 1e-8),
    ];
    for (name, value, d, time, error) in expected {
        let k = file.model.metrics.iter().position(|m| m.name == name).unwrap();
        let m = &found[k];
        let apart = (m.value.unwrap() - value).abs();
        assert!(apart <= error * (1.0 + value.abs()), "{name}: {:?} {value}", m.value);
        assert!((m.d[0] - d).abs() <= 20.0 * error * (1.0 + d.abs()), "{name}: derivative {} {d}", m.d[0]);
        match (m.time, time) {
            (Some(t), Some(expected)) => assert!((t - expected).abs() < 1e-6, "{name}: {t} {expected}"),
            (found, expected) => assert_eq!(found, expected, "{name}"),
        }
    }
    let never = file.model.metrics.iter().position(|m| m.name == "never").unwrap();
    assert_eq!(found[never].value, None);
}

/// On real suspensions and on the crank, with windows, targets and measures over measures.
#[test]
fn derivatives_are_those_of_designs_solved_anew() {
    let gallery = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.toml"));
        std::fs::read_to_string(path).unwrap()
    };
    let more = r#"
        [metrics.slope]
        of = "left.toe"
        over = "left.wheel_travel"
        take = "slope"
        at = 20
        [metrics.error]
        of = "left.camber"
        over = "left.contact_z"
        take = "rms"
        target = [[-340, 2], [-280, 0], [-220, -3]]
        [metrics.mean]
        of = "left.toe"
        over = "left.contact_y"
        take = "mean"
        [metrics.caster]
        of = "left.caster"
        over = "left.contact_x"
        take = "value"
        at = 5
    "#;
    let strut = r#"
        [metrics.slope]
        of = "toe"
        over = "wheel_travel"
        take = "slope"
        at = -10
        [metrics.most]
        of = "toe"
        over = "wheel_travel"
        take = "max"
        window = [-20, 20]
        [metrics.rms]
        of = "camber"
        over = "wheel_travel"
        take = "rms"
        target = [[-40, 1], [40, -1]]
    "#;
    for text in [gallery("front_axle") + more, gallery("macpherson") + strut, CRANK.to_owned()] {
        let file = parsed(&text);
        let analysis = Analysis::new(&file.model).unwrap();
        let now = metrics(&file.model, &analysis.run());
        for v in 0..file.model.variables.len() {
            let at = |h: f64| {
                let mut design = vec![0.0; file.model.variables.len()];
                design[v] = h;
                metrics(&file.model, &analysis.solve(Run::new().at(&design).without_sensitivities()))
            };
            // The error of a central difference is the square of the step.
            let h = 1e-5;
            let (plus, minus) = (at(h), at(-h));
            for (k, metric) in file.model.metrics.iter().enumerate() {
                let (Some(a), Some(b)) = (plus[k].value, minus[k].value) else { continue };
                let (found, expected) = (now[k].d[v], (a - b) / (2.0 * h));
                let name = &file.model.variables[VariableId(v).0].name;
                assert!(
                    (found - expected).abs() < 2e-5 * (1.0 + expected.abs()),
                    "{} of {} by {name}: {found} {expected}",
                    metric.name,
                    file.model.name
                );
            }
        }
    }
}

/// The greatest height of a crank's end is its radius, at a quarter of a turn; the curve is a sine.
#[test]
fn metrics_of_coarse_curves_are_those_of_the_curve() {
    for steps in [1, 2, 3, 5, 8, 12, 20, 40, 400] {
        let text = CRANK.replace("end = 3.0, steps = 120", &format!("end = 6.0, steps = {steps}"));
        let file = parsed(&text);
        let solution = Analysis::new(&file.model).unwrap().run();
        let found = metrics(&file.model, &solution);
        let a = 0.1;
        for (name, exact) in [("top", a), ("left", -a), ("span", 2.0 * a), ("at_one", a * 1.0_f64.sin())] {
            let m = &found[file.model.metrics.iter().position(|m| m.name == name).unwrap()];
            let off = (m.value.unwrap() - exact).abs();
            // Curves that the output times show well enough are interpolated to 1e-7 of their range.
            assert!(off <= 1e-7 * 2.0 * a, "{steps} steps, {name}: off by {off:e}");
            // If the motion was solved at the metric's own time there is no error, else approximately the actual one.
            if let Some(stated) = m.error {
                assert!(off <= 3.0 * stated + 1e-14, "{steps} steps, {name}: {off:e} {stated:e}");
            }
        }
        // The window is left at 60 deg and entered again at 300 deg: y = sqrt(a^2 - x^2) there, and its opposite.
        {
            let m = &found[file.model.metrics.iter().position(|m| m.name == "span_near_start").unwrap()];
            let (exact, d) = (3.0_f64.sqrt() * a, 4.0 / 3.0_f64.sqrt());
            assert!((m.value.unwrap() - exact).abs() <= 1e-7 * 2.0 * a, "{steps} steps: {:?}", m.value);
            assert!((m.d[0] - d).abs() <= 1e-5, "{steps} steps: {}", m.d[0]);
        }
    }
}

/// Integral of a smooth function by Simpson's rule.
fn simpson(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    const PARTS: usize = 400;
    let h = (to - from) / (2 * PARTS) as f64;
    let at = |k: usize| f(from + h * k as f64);
    let pair = |k: usize| at(2 * k) + 4.0 * at(2 * k + 1) + at(2 * k + 2);
    (0..PARTS).map(pair).sum::<f64>() * h / 3.0
}

/// Angle and speed of a crank at a time; at corners of the law, as `inside` of it.
type Turn = fn(t: f64, inside: f64) -> [f64; 2];

/// The integral of `f(x, y, dx/dt)` over time along the path of the end of a crank of radius a, between cuts; only the
/// parts whose middle is at `x > least`.
fn over_path(turn: Turn, cuts: &[f64], a: f64, least: f64, f: &dyn Fn(f64, f64, f64) -> f64) -> f64 {
    let part = |ends: &[f64]| {
        let middle = 0.5 * (ends[0] + ends[1]);
        let at = |t: f64| {
            let [angle, speed] = turn(t, middle);
            let (sin, cos) = angle.sin_cos();
            f(a * cos, a * sin, -a * sin * speed)
        };
        let counts = a * turn(middle, middle)[0].cos() > least;
        if counts { simpson(at, ends[0], ends[1]) } else { 0.0 }
    };
    cuts.windows(2).map(part).sum()
}

/// Means, integrals and root mean squares are those of the path, however it goes to and fro and whatever the output
/// times are, and so are their derivatives, also by where the window cuts the path.
#[test]
fn integrals_are_those_of_the_path_for_any_number_of_steps() {
    let pi = std::f64::consts::PI;
    let metrics_of = r#"
metrics.mean = { of = "A.y", take = "mean" }
metrics.integral = { of = "A.y", take = "integral" }
metrics.rms = { of = "A.y", take = "rms", target = [[0, 0], [0.7, 70], [6, -20]] }
metrics.mean_over = { of = "A.y", over = "A.x", take = "mean" }
metrics.area = { of = "A.y", over = "A.x", take = "integral" }
metrics.rms_over = { of = "A.y", over = "A.x", take = "rms", target = [[-100, 0], [20, 60], [100, 0]] }
metrics.mean_near = { of = "A.y", over = "A.x", take = "mean", window = [50, 1000] }
metrics.area_near = { of = "A.y", over = "A.x", take = "integral", window = [50, 1000] }
metrics.rms_near = { of = "A.y", over = "A.x", take = "rms", window = [50, 1000] }
metrics.points = { of = "A.y", over = "A.x", take = "rms_at_points", target = [[60, 30], [80, 10]] }
"#;
    let head = &CRANK[..CRANK.find("metrics.top").unwrap()];
    // Law as written and as a function; times at which x turns or the law has a kink.
    let motions: [(&str, Turn, Vec<f64>); 3] = [
        ("t", |t, _| [t, 1.0], vec![pi]),
        (
            "if(t < 1.1, t, 1.1 + 0.4*(t - 1.1))",
            |t, inside| if inside < 1.1 { [t, 1.0] } else { [1.1 + 0.4 * (t - 1.1), 0.4] },
            vec![1.1],
        ),
        ("1.3*sin(t)", |t, _| [1.3 * t.sin(), 1.3 * t.cos()], vec![0.5 * pi, pi, 1.5 * pi]),
    ];
    let end = 6.0;
    for (written, turn, turns) in motions {
        let law = |t: f64| turn(t, t)[0];
        let at = |angle: f64| -> Vec<f64> {
            // All times at which the law has this value, between which it rises or falls
            let mut ends = vec![0.0];
            ends.extend(&turns);
            ends.push(end);
            let miss = |t: f64| law(t).cos() - angle.cos();
            let crossing = |pair: &[f64]| {
                let [mut low, mut high] = [pair[0], pair[1]];
                let rising = miss(high) > miss(low);
                if miss(low) * miss(high) > 0.0 {
                    return None;
                }
                for _ in 0..80 {
                    let middle = 0.5 * (low + high);
                    if (miss(middle) < 0.0) == rising { low = middle } else { high = middle }
                }
                Some(low)
            };
            ends.windows(2).filter_map(crossing).collect()
        };
        let reference = |a: f64| -> Vec<f64> {
            let with = |more: Vec<f64>| {
                let mut cuts = [vec![0.0, end], turns.clone(), more].concat();
                cuts.sort_by(f64::total_cmp);
                cuts.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
                cuts
            };
            let all = |f: &dyn Fn(f64, f64, f64) -> f64| over_path(turn, &with(vec![]), a, -9.0, f);
            let near =
                |f: &dyn Fn(f64, f64, f64) -> f64| over_path(turn, &with(at((0.05 / a).acos())), a, 0.05, f);
            let bent =
                |f: &dyn Fn(f64, f64, f64) -> f64| over_path(turn, &with(at((0.02 / a).acos())), a, -9.0, f);
            let time_target = |t: f64| if t < 0.7 { 0.1 * t } else { 0.07 - 0.09 * (t - 0.7) / 5.3 };
            let square = |t: f64| (a * law(t).sin() - time_target(t)).powi(2);
            let cuts = with(vec![0.7]);
            let rms: f64 = cuts.windows(2).map(|p| simpson(square, p[0], p[1])).sum();
            let place = |x: f64| if x < 0.02 { 0.06 * (x + 0.1) / 0.12 } else { 0.06 * (0.1 - x) / 0.08 };
            let travel = all(&|_, _, dx| dx.abs());
            let travel_near = near(&|_, _, dx| dx.abs());
            let first = |x: f64| law(at((x / a).acos())[0]).sin() * a;
            vec![
                all(&|_, y, _| y) / end,
                all(&|_, y, _| y),
                (rms / end).sqrt(),
                all(&|_, y, dx| y * dx.abs()) / travel,
                all(&|_, y, dx| y * dx),
                (bent(&|x, y, dx| (y - place(x)).powi(2) * dx.abs()) / travel).sqrt(),
                near(&|_, y, dx| y * dx.abs()) / travel_near,
                near(&|_, y, dx| y * dx),
                (near(&|_, y, dx| y * y * dx.abs()) / travel_near).sqrt(),
                (0.5 * ((first(0.08) - 0.01).powi(2) + (first(0.06) - 0.03).powi(2))).sqrt(),
            ]
        };
        let a = 0.1;
        let exact = reference(a);
        let h = 1e-6;
        let (more, less) = (reference(a + h), reference(a - h));
        for steps in [2, 3, 5, 8, 12, 20, 40, 61, 400, 5000] {
            let text = format!("{head}{metrics_of}time = {{ end = 6.0, steps = {steps} }}\n");
            let text = text.replace("\"t*180/pi\"", &format!("\"({written})*180/pi\""));
            let file = parsed(&text);
            let found = metrics(&file.model, &Analysis::new(&file.model).unwrap().run());
            for (k, m) in found.iter().enumerate() {
                let name = &file.model.metrics[k].name;
                let at = format!("{written}, {steps} steps, {name}");
                let off = (m.value.unwrap() - exact[k]).abs();
                println!("{at}: {off:e} {:?}", m.error);
                assert!(off <= 1e-7 * m.range, "{at}: off by {off:e}");
                // Round-off of the value; what is solved at its own time is exact to 1e-10 of the range.
                let within = m.error.map_or(1e-10 * m.range, |error| error + 1e-12 * m.range);
                assert!(off <= within, "{at}: {off:e} {:?}", m.error);
                let d = (more[k] - less[k]) / (2.0 * h);
                assert!((m.d[0] - d).abs() <= 1e-6 * (1.0 + d.abs()), "{at}: derivative {} {d}", m.d[0]);
            }
        }
    }
}

/// The rate of an acceleration is not known, of a velocity only the rate: the stated error of an integral is not below
/// the true one.
#[test]
fn the_error_of_integrals_without_rates_is_stated() {
    let head = &CRANK[..CRANK.find("metrics.top").unwrap()];
    let more = r#"
measures.ay = { type = "acceleration", point = "A", along = "y" }
metrics.ay_mean = { of = "ay", take = "mean" }
metrics.ay_rms = { of = "ay", take = "rms" }
metrics.ay_over = { of = "ay", over = "A.x", take = "integral" }
metrics.vx_mean = { of = "vx", take = "mean", window = [0.5, 2.2] }
metrics.vx_rms = { of = "vx", take = "rms" }
"#;
    let (a, end) = (0.1, 2.5_f64);
    let exact = [
        a * (end.cos() - 1.0) / end,
        a * (0.5 - (2.0 * end).sin() / (4.0 * end)).sqrt(),
        a * a * (end / 2.0 - (2.0 * end).sin() / 4.0),
        a * (2.2_f64.cos() - 0.5_f64.cos()) / 1.7,
        a * (0.5 - (2.0 * end).sin() / (4.0 * end)).sqrt(),
    ];
    for steps in [2, 3, 5, 9, 20, 100, 1000] {
        let file = parsed(&format!("{head}{more}time = {{ end = 2.5, steps = {steps} }}\n"));
        let found = metrics(&file.model, &Analysis::new(&file.model).unwrap().run());
        for (k, m) in found.iter().enumerate() {
            let (off, error) = ((m.value.unwrap() - exact[k]).abs(), m.error.unwrap());
            let at = format!("{steps} steps, {}: {off:e} {error:e}", file.model.metrics[k].name);
            assert!(off <= 1.05 * error + 1e-12 * m.range, "{at}");
            // Rates are known of the last two only.
            assert!(error <= if k < 3 { 2e-3 } else { 1e-7 } * m.range, "{at}");
            assert!((m.d[0] - if k == 2 { 2.0 } else { 1.0 } * m.value.unwrap() / a).abs() <= 1e-9, "{at}");
        }
    }
}

/// Ackermann's error has a kink where the axle steers across straight ahead: in bump somewhere on its way, while the
/// axle only steers at its least value.
#[test]
fn ackermann_extremes_and_means_do_not_depend_on_output_times() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/front_axle.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let more = r#"
        [metrics.ackermann_most]
        of = "front.ackermann_error"
        take = "max"
        [metrics.ackermann_least]
        of = "front.ackermann_error"
        take = "min"
        [metrics.ackermann_mean]
        of = "front.ackermann_error"
        take = "mean"
        [metrics.least_ahead]
        of = "front.ackermann_error"
        take = "min"
        window = [0.4, 0.46]
    "#;
    let laws = ["15*sin(2*pi*t)", "60*sin(4*pi*t)", "60*sin(6*pi*t)"];
    let steers = ["15*sin(2*pi*t + 0.5)", "0*t", "0*t"];
    for with in [laws, steers] {
        let text =
            laws.iter().zip(with).fold(text.clone() + more, |text, (law, with)| text.replace(law, with));
        let of = |steps: usize| {
            let file = parsed(&text.replace("steps = 200", &format!("steps = {steps}")));
            let solution = Analysis::new(&file.model).unwrap().run();
            let found = metrics(&file.model, &solution).into_iter().zip(file.model.metrics);
            found.map(|(value, metric)| (metric.name, value)).collect::<Vec<_>>()
        };
        let exact = of(2000);
        for steps in [7, 10, 33, 100, 200, 501] {
            for ((name, m), (_, exact)) in of(steps).iter().zip(&exact) {
                let off = (m.value.unwrap() - exact.value.unwrap()).abs();
                // The wheels have one travel all the time where the axle only steers.
                if name.contains("ackermann") || name == "least_ahead" {
                    let at = format!("{steps} steps, {name}: {off:e} {:?}", m.error);
                    // Round-off of the headings, which are some tenths of a radian
                    assert!(off <= m.error.unwrap_or(1e-9 * m.range) + 1e-13, "{at}");
                    assert!(off <= 1e-7 * m.range, "{at}");
                }
            }
        }
    }
}

/// The end of a crank goes with its radius in proportion; that of a rod between a crank and a slide does not.
#[test]
fn round_off_does_not_limit_the_range_of_linear_measures() {
    let reach = |text: &str, output: &str, variable: &str| {
        let file = parsed(text);
        let analysis = Analysis::new(&file.model).unwrap();
        let solution = analysis.run();
        let found = validity(&analysis, &solution, |_| true);
        found[file.model.variable(variable).unwrap().0].linear_up_to[solution.measured.index(output).unwrap()]
    };
    for output in ["A.x", "A.y"] {
        assert_eq!(reach(CRANK, output, "a"), Some(f64::INFINITY), "{output}");
    }
    let gallery = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.toml"));
        std::fs::read_to_string(path).unwrap()
    };
    assert_eq!(reach(&gallery("sarrus"), "height", "x_knee_x"), Some(f64::INFINITY));
    let bends = reach(&gallery("slider_crank"), "stroke", "J1_x").unwrap();
    assert!((0.01..0.1).contains(&bends), "{bends}");
}

/// Metrics over an abscissa at the places where it turns or rests: `A.y` depends on the design, `q` does not.
const TURNING: &str = r#"
name = "turning"
units = { length = "mm", angle = "deg" }
parameters = { a = { value = 100, unit = "length" } }
hardpoints = { O = [0, 0, 0], A = ["a", 0, 0] }
bodies = { crank = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
drivers.motor = { joint = "pivot", law = LAW }
points.A = { body = "crank", at = "A" }
measures.q = { type = "coordinate", joint = "pivot" }
metrics.high = { of = "A.x", over = "A.y", take = "value", at = 86.60254037844386 }
metrics.low = { of = "A.x", over = "A.y", take = "value", at = -86.60254037844386 }
metrics.window = { of = "A.x", over = "A.y", take = "min", window = [-86.60254037844386, 86.60254037844386] }
metrics.points = { of = "A.x", over = "A.y", take = "rms_at_points", target = [[-86.60254037844386, 0], [86.60254037844386, 0]] }
metrics.slope = { of = "A.x", over = "A.y", take = "slope", at = 86.60254037844386 }
metrics.turn = { of = "A.x", over = "q", take = "value", at = 60 }
metrics.rate = { of = "A.x", over = "q", take = "slope", at = 60 }
time = { end = 1.0, steps = STEPS }
"#;

#[test]
fn metrics_where_the_abscissa_turns_are_those_of_the_curve() {
    let (sine, root) = (0.75_f64.sqrt(), 3.0_f64.sqrt());
    // x = sqrt(a^2 - y^2): value, and derivative by a at constant y
    let at_end = (0.05, 2.0);
    let expected = [
        ("high", at_end),
        ("low", at_end),
        ("window", at_end),
        ("points", at_end),
        // dx/dy = -y / x; its derivative would need derivatives of the motion that are not solved.
        ("slope", (-root, f64::NAN)),
        ("turn", (0.05, 0.5)),
        ("rate", (-0.1 * sine, -sine)),
    ];
    for (law, steps) in [
        ("\"60*sin(2*pi*t)\"", 8),
        ("\"60*sin(2*pi*t)\"", 40),
        ("\"60*sin(2*pi*t)\"", 7),
        ("\"60*sin(2*pi*t)\"", 3),
        ("\"60*sin(2*pi*t)\"", 5),
        ("\"60*sin(2*pi*t)\"", 101),
        ("\"60*sin(2*pi*t)\"", 1001),
        ("\"-60*cos(pi*t)\"", 20),
        ("{ type = \"smooth_step\", from = -60, to = 60, start = 0, end = 1 }", 33),
    ] {
        let file = parsed(&TURNING.replace("LAW", law).replace("STEPS", &steps.to_string()));
        let solution = Analysis::new(&file.model).unwrap().run();
        let found = metrics(&file.model, &solution);
        for (name, (value, by_a)) in expected {
            let metric = &found[file.model.metrics.iter().position(|m| m.name == name).unwrap()];
            // The polynomials of an abscissa that rests with its acceleration are less accurate.
            let tolerance = if law.contains("smooth") { 1e-5 } else { 1e-9 };
            let at = || format!("{name} of {law} with {steps} steps: {metric:?}");
            assert!(metric.value.is_some_and(|found| (found - value).abs() <= tolerance), "{}", at());
            // The time of a turn between output times is known to 1e-9 s, and with it the slope there.
            let of_slope = 10.0 * tolerance;
            let apart = (metric.d[0] - by_a).abs();
            // The ends of the window are the turns: a larger crank reaches the end, a smaller one turns before it.
            let either = name == "window" && (metric.d[0] - 0.5).abs() <= of_slope;
            assert!(apart <= of_slope || either || metric.d[0].is_nan() && by_a.is_nan(), "{}", at());
            assert!(metric.time.is_none_or(|t| (0.0..=1.0).contains(&t)), "{}", at());
        }
    }
}

#[test]
fn where_a_curve_is_vertical_its_value_has_no_derivative() {
    let text = TURNING.replace("LAW", "\"180*t\"").replace("STEPS", "20").replace("86.60254037844386", "100");
    let file = parsed(&text);
    let found = metrics(&file.model, &Analysis::new(&file.model).unwrap().run());
    assert!(found[0].value.is_some_and(|x| x.abs() < 1e-9) && found[0].d[0].is_nan(), "{:?}", found[0]);
    assert!(found[4].value.is_none(), "{:?}", found[4]);
}

/// A crank with a mass at C, driven through a turn.
const WEIGHT: &str = r#"
name = "crank with a mass"
units = { length = "mm", angle = "deg" }
loads = "static"
parameters = { height = { value = 37, unit = "length" } }
hardpoints = { O = [0, 0, 0], C = [100, 0, "height"] }
bodies = { crank = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "y" }
drivers.motor = { joint = "pivot", law = "360*t + 20*sin(2*pi*t)" }
gravity = { along = "-z" }
masses.m = { type = "rigid", centre = { body = "crank", at = "C" }, mass = 10 }
points.C = { body = "crank", at = "C" }
measures.torque = { type = "driver_force", driver = "motor" }
measures.lift = { type = "slope", of = "C.z", over = "angle", driver = "motor" }
measures.angle = { type = "coordinate", joint = "pivot" }
metrics.most = { of = "torque", take = "max" }
metrics.least = { of = "torque", take = "min" }
metrics.span = { of = "torque", take = "range" }
metrics.steepest = { of = "lift", take = "max" }
metrics.early = { of = "torque", take = "min", window = [0, 0.4] }
time = { end = 1, steps = 10 }
"#;

/// The same mass on a spring between crank and arm, as an equilibrium.
const HANGING: &str = r#"
name = "arm with a mass on a spring"
units = { length = "mm", angle = "deg" }
parameters = { height = { value = 37, unit = "length" } }
hardpoints = { O = [0, 0, 0], C = [100, 0, "height"] }
bodies = { crank = {}, arm = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "y" }
joints.hinge = { type = "revolute", bodies = ["crank", "arm"], at = "O", axis = "y", axis2 = "z" }
drivers.motor = { joint = "pivot", law = "90*t - 60" }
gravity = { along = "-z" }
masses.m = { type = "rigid", centre = { body = "arm", at = "C" }, mass = 10 }
points.C = { body = "arm", at = "C" }
forces.spring = { type = "torsion_spring", joint = "hinge", stiffness = 2 }
equilibrium = {}
measures.torque = { type = "driver_force", driver = "motor" }
metrics.least = { of = "torque", take = "min" }
metrics.reach = { of = "C.x", take = "max" }
time = { end = 1, steps = 10 }
"#;

#[test]
fn extrema_without_rates_are_those_of_the_curve_at_any_output_times() {
    let (r, weight) = (0.1_f64.hypot(0.037), 10.0 * 9.80665);
    // Of each, the amplitude is r times this, which grows with the height by height / r of it.
    let turned =
        [("most", weight), ("least", -weight), ("span", 2.0 * weight), ("steepest", 1.0), ("early", -weight)];
    let of_arm = [("least", -weight), ("reach", 1.0)];
    // The least torque is 2.3 degrees after the start.
    let near_the_end = WEIGHT.replace("360*t + 20*sin(2*pi*t)", "360*t + 18");
    for (text, expected) in [(WEIGHT, &turned[..]), (&near_the_end, &turned), (HANGING, &of_arm)] {
        for steps in [7, 10, 11, 30, 100] {
            let file = parsed(&text.replace("steps = 10", &format!("steps = {steps}")));
            let solution = Analysis::new(&file.model).unwrap().run();
            assert!(solution.stop.is_none(), "{:?}", solution.stop);
            for (metric, found) in file.model.metrics.iter().zip(metrics(&file.model, &solution)) {
                let (_, per_radius) = expected.iter().find(|(name, _)| *name == metric.name).unwrap();
                let (value, d) = (per_radius * r, per_radius * 0.037 / r);
                let name = format!("{} of {steps} steps: {found:?}", metric.name);
                assert!((found.value.unwrap() - value).abs() <= 1e-9 * value.abs(), "{name} {value}");
                assert!((found.d[0] - d).abs() <= 3e-7 * d.abs(), "{name} {d}");
                assert!(found.error.is_none_or(|error| error <= 1e-9 * found.range), "{name}");
            }
        }
    }
}

#[test]
fn the_least_size_of_a_vector_that_nearly_vanishes_is_that_of_the_curve() {
    // Two forces at the tip of a crank that turns: 100 N sin(3 t - 1.234) along x, and e along y.
    let text = r#"
name = "crank with two forces"
units = { length = "mm", angle = "deg" }
planar = "xy"
loads = "static"
parameters = { e = 1 }
hardpoints = { A = [0, 0], B = [100, 0] }
bodies = { ground = ["A"], crank = ["A", "B"] }
drivers.motor = { joint = "A", law = "100*t" }
forces.swing = { type = "force", at = { body = "crank", at = "B" }, force = 100, along = "x", law = "sin(3*t - 1.234)" }
forces.side = { type = "force", at = { body = "crank", at = "B" }, force = "e", along = "y" }
measures.size = { type = "reaction", joint = "A", part = "radial" }
metrics.least = { of = "size", take = "min" }
metrics.span = { of = "size", take = "range" }
time = { end = 1, steps = 10 }
"#;
    for least in [10.0, 0.1, 0.001] {
        for steps in [7, 10, 40, 200] {
            let text = text.replace("e = 1 }", &format!("e = {least:?} }}"));
            let file = parsed(&text.replace("steps = 10", &format!("steps = {steps}")));
            let solution = Analysis::new(&file.model).unwrap().run();
            let found = &metrics(&file.model, &solution)[0];
            let name = format!("{least} N, {steps} steps: {found:?}");
            assert!((found.value.unwrap() - least).abs() <= 1e-6 * least, "{name}");
            assert!((found.d[0] - 1.0).abs() <= 1e-6, "{name}");
        }
    }
    // Without the second force it vanishes, whatever the first force is.
    let text = text.replace("e = 1 }", "e = 0, swing = 100 }").replace("force = 100", "force = \"swing\"");
    for steps in [7, 10, 40, 200] {
        let file = parsed(&text.replace("steps = 10", &format!("steps = {steps}")));
        let found = metrics(&file.model, &Analysis::new(&file.model).unwrap().run());
        let [(least, by_swing), (span, span_by_swing)] =
            [0, 1].map(|m| (found[m].value.unwrap(), found[m].d[1]));
        assert_eq!([least, by_swing], [0.0; 2], "{steps} steps");
        assert!((span_by_swing - span / 100.0).abs() <= 3e-7 * span / 100.0, "{steps} steps: {:?}", found[1]);
    }
}

#[test]
fn derivatives_at_the_end_of_a_window_without_rates_are_those_of_solved_designs() {
    let text = r#"
name = "four-bar with a spring"
units = { length = "mm", angle = "deg" }
planar = "xy"
loads = "static"
hardpoints = { A = [3, -2], B = [25, 78], C = [190, 163], D = [230, 11], P = [120, 170] }
bodies = { ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C", "P"], rocker = ["C", "D"] }
drivers.motor = { joint = "A", law = "50*t" }
measures.rock = { type = "coordinate", joint = "D" }
measures.torque = { type = "driver_force" }
metrics.least = { of = "torque", over = "rock", take = "min", window = [5, 15] }
design.C = { move = "C", along = "y" }
time = { end = 1, steps = 30 }
[forces.spring]
type = "spring"
from = { body = "ground", at = [60, -50] }
to = { body = "coupler", at = "P" }
stiffness = 2
preload = 30
"#;
    let mut first = None;
    for steps in [7, 40, 200] {
        let file = parsed(&text.replace("steps = 30", &format!("steps = {steps}")));
        let analysis = Analysis::new(&file.model).unwrap();
        let d = metrics(&file.model, &analysis.run())[0].d[0];
        let value = |by: f64| metrics(&file.model, &analysis.solve(Run::new().at(&[by])))[0].value.unwrap();
        let difference = (value(1e-5) - value(-1e-5)) / 2e-5;
        assert!((d - difference).abs() <= 1e-6 * d.abs(), "{steps} steps: {d} {difference}");
        let first = *first.get_or_insert(d);
        assert!((d - first).abs() <= 1e-6 * d.abs(), "{steps} steps: {d} {first}");
    }
}

#[test]
fn units_of_targets_in_files_are_those_of_the_measure_and_its_abscissa() {
    let read = |keys: &str, csv: &str| {
        let metric =
            format!("metrics.off = {{ take = \"rms\", target = \"target.csv\", {keys} }}\ntime = {{");
        let files: Texts = [("target.csv".to_owned(), csv.to_owned())].into();
        parse_with(&CRANK.replace("time = {", &metric), "crank.toml", &files).map_err(|e| e.to_string())
    };
    let (over, in_time) = ("of = \"A.y\", over = \"A.x\"", "of = \"A.y\"");
    let value = |keys: &str, csv: &str| {
        let file = read(keys, csv).unwrap_or_else(|e| panic!("{e}"));
        let solution = Analysis::new(&file.model).unwrap().run();
        let off = file.model.metrics.iter().position(|m| m.name == "off").unwrap();
        metrics(&file.model, &solution)[off].value.unwrap()
    };
    // The same numbers in other units.
    let plain = value(over, "x,y\n-100,50\n100,50\n");
    for csv in ["x [cm],y [m]\n-10,0.05\n10,0.05\n", "x,y [mm]\n-100,50\n100,50\n"] {
        assert!((value(over, csv) - plain).abs() < 1e-12, "{csv}");
    }
    let plain = value(in_time, "t,y\n0,0\n3,20\n");
    assert!((value(in_time, "t [ms],y [cm]\n0,0\n3000,2\n") - plain).abs() < 1e-12);
    for (keys, csv, expected) in [
        (over, "x,y [deg]\n0,0\n1,1\n", "`y` of the target is in `deg`, and `A.y` is in mm"),
        (over, "x [s],y\n0,0\n1,1\n", "`x` of the target is in `s`, and `A.x` is in mm"),
        (in_time, "t [mm],y\n0,0\n1,1\n", "`t` of the target is in `mm`, and the abscissa is in s"),
        ("of = \"vx\"", "t,v [m]\n0,0\n1,1\n", "`v` of the target is in `m`, and `vx` is in mm/s"),
    ] {
        let found = read(keys, csv).err().unwrap_or_default();
        assert!(found.contains("HP0112") && found.contains(expected), "{csv}: {found}");
    }
}

/// A crank and a follower that turn by more than three turns.
const DOUBLE_CRANK: &str = r#"
name = "double crank"
units = { length = "mm", angle = "deg" }
hardpoints = { A = [0, 0, 0], B = [0, 100, 0], C = [85, 125, 0], D = [30, 0, 0] }
bodies = { crank = {}, coupler = {}, follower = {} }
joints.A = { type = "revolute", bodies = ["ground", "crank"], at = "A", axis = "z" }
joints.B = { type = "revolute", bodies = ["crank", "coupler"], at = "B", axis = "z" }
joints.C = { type = "revolute", bodies = ["coupler", "follower"], at = "C", axis = "z" }
joints.D = { type = "revolute", bodies = ["ground", "follower"], at = "D", axis = "z" }
drivers.motor = { joint = "A", law = "t*180/pi" }
design.D = { move = "D", along = "x" }
points.C = { body = "follower", at = "C" }
measures.speed = { type = "velocity", point = "C", along = "x" }
metrics.fastest = { of = "speed", take = "max" }
metrics.turned = { of = "turn", take = "integral" }
time = { end = 20, steps = 150 }

[measures.turn]
type = "angle"
from = [{ body = "ground", at = "D" }, { body = "ground", at = "C" }]
to = [{ body = "follower", at = "D" }, { body = "follower", at = "C" }]
about = "z"
"#;

/// The extremum of the speed adds times, which are inserted into the curve of the angle with all of its turns.
#[test]
fn angles_at_inserted_times_have_the_turns_of_the_motion() {
    let of = |steps: &str| {
        let file = parsed(&DOUBLE_CRANK.replace("steps = 150", steps));
        metrics(&file.model, &Analysis::new(&file.model).unwrap().run())
    };
    for (found, exact) in of("steps = 150").iter().zip(of("steps = 2400")) {
        let (value, expected) = (found.value.unwrap(), exact.value.unwrap());
        assert!((value - expected).abs() <= 1e-7 * expected.abs(), "{value} {expected}");
        assert!((found.d[0] - exact.d[0]).abs() <= 1e-4 * exact.d[0].abs(), "{:?} {:?}", found.d, exact.d);
    }
}

/// Metrics at wheel travels between the output times add a few times, and not the whole motion once more.
#[test]
fn times_that_metrics_add_are_solved_by_themselves() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/front_axle.toml");
    let model = parsed(&std::fs::read_to_string(path).unwrap()).model;
    let analysis = Analysis::new(&model).unwrap();
    for run in [Run::new(), Run::new().without_sensitivities()] {
        let mut solved = 0;
        let counting = |_| {
            solved += 1;
            std::ops::ControlFlow::Continue(())
        };
        let solution = analysis.solve(run.progress(counting));
        assert!(metrics(&model, &solution).iter().all(|metric| metric.value.is_some()));
        let outputs = model.times.len();
        assert!((outputs..outputs + outputs / 2).contains(&solved), "{solved} of {outputs}");
    }
}

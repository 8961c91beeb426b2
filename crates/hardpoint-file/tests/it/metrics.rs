//! Metrics: values by closed forms, derivatives against designs that are solved anew.

use std::path::Path;

use hardpoint::model::VariableId;
use hardpoint::study::{metrics, validity};
use hardpoint::{Analysis, Run};
use hardpoint_file::{ModelFile, parse};

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
    // Name, value, derivative by a, time, and how far off a quadrature or an interpolation may be.
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
        ("mean", a * mean, mean, None, 1e-4),
        ("integral", a * mean * end, mean * end, None, 2e-4),
        // Its abscissa goes back all the time: less the area below the circle.
        ("area", a * a * area, 2.0 * a * area, None, 2e-4),
        ("rms", a * rms, rms, None, 1e-4),
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
            // Where the motion was solved at the metric's own time there is no error to speak of, else about what it is.
            if let Some(told) = m.error {
                assert!(off <= 3.0 * told + 1e-14, "{steps} steps, {name}: {off:e} {told:e}");
            }
        }
        let mean = file.model.metrics.iter().position(|m| m.name == "mean").unwrap();
        assert_eq!(found[mean].error, None);
        // The window is left at 60 deg and entered again at 300 deg: y = sqrt(a^2 - x^2) there, and its opposite.
        {
            let m = &found[file.model.metrics.iter().position(|m| m.name == "span_near_start").unwrap()];
            let (exact, d) = (3.0_f64.sqrt() * a, 4.0 / 3.0_f64.sqrt());
            assert!((m.value.unwrap() - exact).abs() <= 1e-7 * 2.0 * a, "{steps} steps: {:?}", m.value);
            assert!((m.d[0] - d).abs() <= 1e-5, "{steps} steps: {}", m.d[0]);
        }
    }
}

/// The end of a crank goes with its radius in proportion; that of a rod between a crank and a slide does not.
#[test]
fn what_is_exactly_linear_is_not_given_a_limit_by_its_round_off() {
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

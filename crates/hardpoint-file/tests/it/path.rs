//! Results do not depend on the spacing of the output times: the path is followed, not sampled.

use std::path::Path;

use hardpoint::model::{BodyId, Model};
use hardpoint::motion::StopKind;
use hardpoint::run::{MetricValue, metrics};
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::{parse, read};

/// Numbers of steps in which a run is requested.
const COUNTS: [usize; 12] = [1, 2, 3, 5, 7, 10, 20, 50, 100, 200, 1_200, 5_000];
/// Times at which runs of different spacing stop agree to this part of the run.
const SAME_TIME: f64 = 1e-6;
/// Numbers at common times agree to this part of the largest of their kind.
const SAME: f64 = 1e-9;
/// Next to a singular position, where a run stops, velocities and accelerations lose digits: there they are not
/// compared.
const NEAR_THE_END: f64 = 1e-2;

/// End of a run: time and reason; `None` at the last output time.
type Verdict = Option<(f64, StopKind)>;

fn model(text: &str) -> Model {
    parse(text, "path.toml").unwrap_or_else(|e| panic!("{}", e.render(false))).model
}

fn run(model: &Model, times: Vec<f64>) -> Solution {
    let model = Model { times, variables: Vec::new(), metrics: Vec::new(), ..model.clone() };
    Analysis::new(&model).unwrap().solve(Run::new().without_sensitivities())
}

fn spaced(model: &Model, n: usize) -> Vec<f64> {
    let (start, end) = (model.times[0], model.times[model.times.len() - 1]);
    (0..=n).map(|k| start + (end - start) * (k as f64 / n as f64)).collect()
}

fn verdict(solution: &Solution) -> Verdict {
    solution.stop.as_ref().map(|stop| (stop.failed_time, stop.kind))
}

/// The largest component of everything that is known at time k, by kind, and the differences to another solution's time
/// j.
fn compare(
    name: &str,
    n: usize,
    model: &Model,
    (a, k): (&Solution, usize),
    (b, j): (&Solution, usize),
    scales: &Scales,
    rates: bool,
) {
    for body in 1..model.bodies.len() {
        let (x, y) = (a.motion.at(k).body(body), b.motion.at(j).body(body));
        let apart = |p: Vec3, q: Vec3| (p - q).norm();
        let turned = (0..3).map(|c| apart(x.rotation.cols[c], y.rotation.cols[c])).fold(0.0, f64::max);
        let mut pairs = vec![("position", apart(x.r, y.r), scales.r), ("orientation", turned, 1.0)];
        if rates {
            pairs.extend([
                ("velocity", apart(x.v, y.v), scales.v),
                ("angular velocity", apart(x.omega, y.omega), scales.omega),
                ("acceleration", apart(x.a, y.a), scales.a),
                ("angular acceleration", apart(x.alpha, y.alpha), scales.alpha),
            ]);
        }
        for (what, difference, scale) in pairs {
            assert!(
                difference <= SAME * scale,
                "{name} in {n} steps: {what} of `{}` differs by {difference} of {scale} at t = {}",
                model.bodies[body].name,
                a.motion.times[k]
            );
        }
    }
    for (m, output) in a.measured.outputs.iter().enumerate() {
        let (x, y) = (a.measured.value(k, m)[0], b.measured.value(j, m)[0]);
        let same = (x - y).abs() <= SAME * scales.outputs[m] || x.is_nan() && y.is_nan();
        assert!(same, "{name} in {n} steps: `{}` is {x}, not {y}, at t = {}", output.name, a.motion.times[k]);
    }
}

struct Scales {
    r: f64,
    v: f64,
    omega: f64,
    a: f64,
    alpha: f64,
    outputs: Vec<f64>,
}

impl Scales {
    fn of(model: &Model, s: &Solution) -> Self {
        let most = |of: fn(&hardpoint::motion::BodyState) -> Vec3| {
            s.motion.states().map(|s| of(&s).norm()).fold(0.0, f64::max)
        };
        let size = model.size();
        let (v, omega) = (most(|s| s.v), most(|s| s.omega));
        let (speed, twirl) = (v.max(omega * size), omega.max(v / size));
        let (a, alpha) = (most(|s| s.a), most(|s| s.alpha));
        let outputs = (0..s.measured.outputs.len()).map(|m| {
            (0..s.measured.len())
                .map(|k| s.measured.value(k, m)[0].abs())
                .filter(|x| x.is_finite())
                .fold(size.min(1.0), f64::max)
        });
        Self {
            r: most(|s| s.r).max(size),
            v: speed,
            omega: twirl,
            a: a.max(alpha * size).max(twirl * speed),
            alpha: alpha.max(a / size).max(twirl * twirl),
            outputs: outputs.collect(),
        }
    }
}

/// Runs a model in all numbers of steps and holds every run to one that has all of their output times. Returns how it
/// ended.
fn same_in_any_number_of_steps(name: &str, model: &Model) -> Verdict {
    let (start, end) = (model.times[0], model.times[model.times.len() - 1]);
    let mut all: Vec<f64> = COUNTS.iter().flat_map(|&n| spaced(model, n)).collect();
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| *a - *b <= 1e-12 * (end - start));
    let reference = run(model, all.clone());
    let expected = verdict(&reference);
    let scales = Scales::of(model, &reference);
    for n in COUNTS {
        let solution = run(model, spaced(model, n));
        let found = verdict(&solution);
        let same = match (found, expected) {
            (None, None) => true,
            (Some((t, kind)), Some((at, why))) => {
                std::mem::discriminant(&kind) == std::mem::discriminant(&why)
                    && (t - at).abs() <= SAME_TIME * (end - start)
            }
            _ => false,
        };
        assert!(same, "{name} in {n} steps: {found:?}, but {expected:?}");
        for (k, t) in solution.motion.times.iter().enumerate() {
            let j = reference.motion.times.partition_point(|x| *x < t - 1e-12 * (end - start));
            if j == reference.motion.len() {
                continue; // next to where it stops
            }
            let rates = expected.is_none_or(|(at, _)| t + NEAR_THE_END * (end - start) < at);
            compare(name, n, model, (&solution, k), (&reference, j), &scales, rates);
        }
    }
    expected
}

fn gallery() -> Vec<(String, Model)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let mut names: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    names.retain(|p| p.extension().is_some_and(|e| e == "toml"));
    names.sort();
    let read = |path: &std::path::PathBuf| {
        let file = read(path).unwrap_or_else(|e| panic!("{e}"));
        (path.file_stem().unwrap().to_str().unwrap().to_owned(), file.model)
    };
    names.iter().map(read).collect()
}

#[test]
fn every_model_of_the_gallery_moves_the_same_in_any_number_of_steps() {
    for (name, model) in gallery() {
        let verdict = same_in_any_number_of_steps(&name, &model);
        assert_eq!(verdict, None, "{name}");
    }
}

/// A Hooke joint between shafts at an angle, turned at a speed for a second.
fn hooke(angle: f64, speed: f64, end: f64) -> Model {
    let (sin, cos) = angle.to_radians().sin_cos();
    model(&format!(
        r#"name = "Hooke"
        units = {{ length = "mm", angle = "deg" }}
        [hardpoints]
        a = [-300, 0, 0]
        o = [0, 0, 0]
        [bodies]
        input = {{}}
        output = {{}}
        [joints]
        in = {{ type = "revolute", bodies = ["ground", "input"], at = "a", axis = "x" }}
        cross = {{ type = "universal", bodies = ["input", "output"], at = "o", axis = "y", axis2 = "z" }}
        out = {{ type = "revolute", bodies = ["ground", "output"], at = "o", axis = [{cos}, {sin}, 0] }}
        [drivers]
        motor = {{ joint = "in", law = "{speed}*t" }}
        [measures]
        input = {{ type = "coordinate", joint = "in" }}
        output = {{ type = "coordinate", joint = "out" }}
        [time]
        end = {end}
        steps = 10"#
    ))
}

/// A planar four-bar with links a (crank), b, c and base d, drawn with the crank at an angle.
fn four_bar(links: [f64; 4], angle: f64, law: &str, end: f64) -> Model {
    model(&four_bar_text(links, angle, law, end))
}

fn four_bar_text([a, b, c, d]: [f64; 4], angle: f64, law: &str, end: f64) -> String {
    let (sin, cos) = angle.to_radians().sin_cos();
    let (bx, by) = (a * cos, a * sin);
    // C lies on two circles; the upper one of the two places.
    let (ex, ey) = (d - bx, -by);
    let l = ex.hypot(ey);
    let x = (b * b - c * c + l * l) / (2.0 * l);
    let y = (b * b - x * x).sqrt();
    let (cx, cy) = (bx + (x * ex - y * ey) / l, by + (x * ey + y * ex) / l);
    format!(
        r#"name = "four-bar"
        units = {{ length = "m", angle = "rad" }}
        [hardpoints]
        A = [0, 0, 0]
        B = [{bx}, {by}, 0]
        C = [{cx}, {cy}, 0]
        D = [{d}, 0, 0]
        [bodies]
        crank = {{}}
        coupler = {{}}
        rocker = {{}}
        [joints]
        a = {{ type = "revolute", bodies = ["ground", "crank"], at = "A", axis = "z" }}
        b = {{ type = "revolute", bodies = ["crank", "coupler"], at = "B", axis = "z" }}
        c = {{ type = "revolute", bodies = ["coupler", "rocker"], at = "C", axis = "z" }}
        d = {{ type = "revolute", bodies = ["ground", "rocker"], at = "D", axis = "z" }}
        [drivers]
        motor = {{ joint = "a", law = "{law}" }}
        [measures]
        crank = {{ type = "coordinate", joint = "a" }}
        rocker = {{ type = "coordinate", joint = "d" }}
        pin = {{ type = "coordinate", joint = "c" }}
        [time]
        end = {end}
        steps = 10"#
    )
}

#[test]
fn hooke_joints_turn_as_often_as_they_are_driven() {
    for (angle, speed, end) in [
        (30.0, 1080.0, 1.0),
        (30.0, 36_000.0, 1.0),
        (80.0, 720.0, 1.0),
        (30.0, 1e6, 0.01),
        (30.0, 72_000.0, 0.1),
    ] {
        let hooke = hooke(angle, speed, end);
        let name = format!("Hooke joint at {angle} deg, {speed} deg/s");
        assert_eq!(same_in_any_number_of_steps(&name, &hooke), None, "{name}");
        let turned = (speed * end).to_radians();
        let solution = run(&hooke, spaced(&hooke, 1));
        let out = solution.measured.index("output").unwrap();
        // tan q2 = tan q1 / cos alpha (or cos alpha tan q1, as the pins stand), in the same quarter turn.
        let within = turned % std::f64::consts::TAU;
        let q2 = solution.measured.value(1, out)[0] - (turned - within);
        assert!((q2 - within).abs() < std::f64::consts::FRAC_PI_2, "{name}: {q2} {within}");
    }
}

#[test]
fn whole_turns_of_an_output_are_counted() {
    let hooke = hooke(30.0, 72_000.0, 1.0);
    let solution = run(&hooke, vec![0.0, 1.0]);
    let out = solution.measured.index("output").unwrap();
    assert!((solution.measured.value(1, out)[0] / std::f64::consts::TAU - 200.0).abs() < 1e-9);
}

#[test]
fn four_bars_with_gaps_stop_at_the_same_place() {
    // The crank passes the base line, where the coupler and rocker cannot reach: gaps of these parts of the angle
    // driven.
    for gap in [1e-2, 1e-3, 1e-5] {
        // At the crank angle pi the pins B and D are a + d apart; b + c falls short of it by what makes the gap's half
        // width.
        let (a, d) = (1.0, 2.5);
        let half: f64 = 0.5 * gap * std::f64::consts::TAU;
        // |BD|^2 = a^2 + d^2 + 2 a d cos(x) at x from there.
        let reach = (a * a + d * d + 2.0 * a * d * half.cos()).sqrt();
        let four_bar = four_bar([a, 0.55 * reach, 0.45 * reach, d], 40.0, "t", std::f64::consts::TAU);
        let name = format!("four-bar with a gap of {gap}");
        let (at, kind) = same_in_any_number_of_steps(&name, &four_bar).expect("there is a gap");
        let expected = std::f64::consts::PI - 40_f64.to_radians() - half;
        assert!((at - expected).abs() < 1e-6 * std::f64::consts::TAU, "{name}: {at} {expected}");
        assert_eq!(kind, StopKind::Limit, "{name}");
    }
}

#[test]
fn grashof_cranks_rotate_at_any_speed() {
    for speed in [10.0, 1e4, 1e6] {
        let law = format!("{}*t", f64::to_radians(speed));
        let four_bar = four_bar([0.3, 1.1, 0.9, 1.2], 60.0, &law, 3.3 * 360.0 / speed);
        let name = format!("crank-rocker at {speed} deg/s");
        assert_eq!(same_in_any_number_of_steps(&name, &four_bar), None, "{name}");
    }
}

#[test]
fn a_parallelogram_ends_where_two_motions_meet() {
    let four_bar = four_bar([1.0, 2.0, 1.0, 2.0], 50.0, "t", 6.0);
    let (at, kind) = same_in_any_number_of_steps("parallelogram", &four_bar).expect("a change point");
    assert_eq!(kind, StopKind::BranchChange);
    assert!((at - 130_f64.to_radians()).abs() < 6e-6, "{at}");
}

#[test]
fn a_delta_robot_driven_too_far_stops_at_the_same_place() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/delta.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let text = text.replace("20*sin", "80*sin").replace("- 5\"", "- 20\"").replace("+ 5\"", "+ 20\"");
    let (at, kind) = same_in_any_number_of_steps("delta", &model(&text)).expect("it cannot go there");
    assert_eq!(kind, StopKind::BranchChange);
    // A walk many times finer, in another program.
    assert!((at - 0.403_021_4).abs() < 1e-6, "{at}");
}

#[test]
fn a_law_that_pulses_between_rests_is_followed() {
    // The pulse of a millisecond goes beyond the limit and back; no output time but those of the finest runs meets it.
    let law = "3*(step(t, 0.5003, 0, 0.5008, 1) - step(t, 0.5008, 0, 0.5013, 1))";
    let four_bar = four_bar([1.0, 1.2, 1.0, 2.0], 60.0, law, 1.0);
    let (at, _) = same_in_any_number_of_steps("pulse", &four_bar).expect("out of reach");
    assert!(at > 0.5003 && at < 0.5008, "{at}");
}

/// The same four-bar built without redundancy: a ball at the crank's pin, a universal joint at the rocker's.
fn rsur(text: &str) -> String {
    text.replace(
        r#"b = { type = "revolute", bodies = ["crank", "coupler"], at = "B", axis = "z" }"#,
        r#"b = { type = "spherical", bodies = ["crank", "coupler"], at = "B" }"#,
    )
    .replace(
        r#"c = { type = "revolute", bodies = ["coupler", "rocker"], at = "C", axis = "z" }"#,
        r#"c = { type = "universal", bodies = ["coupler", "rocker"], at = "C", axis = "z", axis2 = { through = ["C", "D"] } }"#,
    )
    .replace("pin = { type = \"coordinate\", joint = \"c\" }", "")
}

/// Coupler as a rod.
fn with_a_rod(text: &str) -> String {
    text.replace("coupler = {}", "")
        .replace(
            r#"b = { type = "revolute", bodies = ["crank", "coupler"], at = "B", axis = "z" }"#,
            r#"rod = { type = "distance", bodies = ["crank", "rocker"], at = ["B", "C"] }"#,
        )
        .replace(r#"c = { type = "revolute", bodies = ["coupler", "rocker"], at = "C", axis = "z" }"#, "")
        .replace("pin = { type = \"coordinate\", joint = \"c\" }", "")
}

#[test]
fn spatial_and_rod_four_bars_with_gaps_stop_there_too() {
    for gap in [1e-2, 1e-3, 1e-5] {
        let half: f64 = 0.5 * gap * std::f64::consts::TAU;
        let reach = (1.0 + 2.5 * 2.5 + 5.0 * half.cos()).sqrt();
        let links = [1.0, 0.55 * reach, 0.45 * reach, 2.5];
        for (what, variant) in [("RSUR", rsur as fn(&str) -> String), ("rod", with_a_rod)] {
            let text = variant(&four_bar_text(links, 40.0, "t", std::f64::consts::TAU));
            let name = format!("{what} four-bar with a gap of {gap}");
            let (at, kind) = same_in_any_number_of_steps(&name, &model(&text)).expect("there is a gap");
            let expected = std::f64::consts::PI - 40_f64.to_radians() - half;
            assert!((at - expected).abs() < 1e-6 * std::f64::consts::TAU, "{name}: {at} {expected}");
            assert_eq!(kind, StopKind::Limit, "{name}");
        }
    }
}

/// Three wheels of a locomotive coupled by one rod each, the third crank's pin off by a part of its radius.
fn locomotive(off: f64) -> Model {
    model(&locomotive_text(off))
}

fn locomotive_text(off: f64) -> String {
    let (sin, cos) = 0.6_f64.sin_cos();
    let r = 0.3 * (1.0 + off);
    let [x1, y1, x2, y2, x3, y3] = [0.3 * cos, 0.3 * sin, 2.0 + 0.3 * cos, 0.3 * sin, 4.0 + r * cos, r * sin];
    format!(
        r#"name = "locomotive"
        units = {{ length = "m", angle = "rad" }}
        [hardpoints]
        A1 = [0, 0, 0]
        A2 = [2, 0, 0]
        A3 = [4, 0, 0]
        P1 = [{x1}, {y1}, 0]
        P2 = [{x2}, {y2}, 0]
        P3 = [{x3}, {y3}, 0]
        [bodies]
        w1 = {{}}
        w2 = {{}}
        w3 = {{}}
        rod = {{}}
        [joints]
        a1 = {{ type = "revolute", bodies = ["ground", "w1"], at = "A1", axis = "z" }}
        a2 = {{ type = "revolute", bodies = ["ground", "w2"], at = "A2", axis = "z" }}
        a3 = {{ type = "revolute", bodies = ["ground", "w3"], at = "A3", axis = "z" }}
        p1 = {{ type = "revolute", bodies = ["w1", "rod"], at = "P1", axis = "z" }}
        p2 = {{ type = "revolute", bodies = ["w2", "rod"], at = "P2", axis = "z" }}
        p3 = {{ type = "revolute", bodies = ["w3", "rod"], at = "P3", axis = "z" }}
        [drivers]
        motor = {{ joint = "a1", law = "2*pi*t" }}
        [time]
        end = 1.0
        steps = 10"#
    )
}

#[test]
fn a_locomotive_with_unequal_cranks_locks_at_the_same_place() {
    for off in [1e-2, 1e-4] {
        let name = format!("locomotive, third crank longer by {off}");
        let (_, kind) = same_in_any_number_of_steps(&name, &locomotive(off)).expect("it locks");
        assert!(matches!(kind, StopKind::Locked { .. }), "{name}: {kind:?}");
    }
}

/// Outcome of a run, for comparison with the same mechanism elsewhere: its end, and all measures at all output times.
fn outcome(text: &str) -> (Verdict, Vec<f64>, Vec<f64>) {
    let model = model(text);
    let solution = run(&model, spaced(&model, 60));
    let outputs = 0..solution.measured.outputs.len();
    let values = (0..solution.measured.len()).flat_map(|k| outputs.clone().map(move |m| (k, m)));
    let values = values.map(|(k, m)| solution.measured.value(k, m)[0]).collect();
    let margins = solution.motion.margins.iter().map(|m| m.value).collect();
    (verdict(&solution), values, margins)
}

fn assert_same(what: &str, one: &(Verdict, Vec<f64>, Vec<f64>), other: &(Verdict, Vec<f64>, Vec<f64>)) {
    match (one.0, other.0) {
        (None, None) => {}
        (Some((t, a)), Some((u, b))) => {
            let same = std::mem::discriminant(&a) == std::mem::discriminant(&b);
            assert!(same && (t - u).abs() < 1e-6, "{what}: {:?} {:?}", one.0, other.0);
        }
        _ => panic!("{what}: {:?} {:?}", one.0, other.0),
    }
    assert_eq!(one.1.len(), other.1.len(), "{what}");
    for (kind, one, other) in [("measure", &one.1, &other.1), ("margin", &one.2, &other.2)] {
        for (k, (x, y)) in one.iter().zip(other).enumerate() {
            assert!((x - y).abs() < SAME * x.abs().max(1.0), "{what}: {kind} {k} is {y}, not {x}");
        }
    }
}

/// A four-bar that turns, one that stops at a gap in three builds, and a locomotive that locks; angles in rad.
fn specimens() -> Vec<(&'static str, String)> {
    let links = [0.3, 1.1, 0.9, 1.2];
    let turns = four_bar_text(links, 60.0, "6*t", 1.0);
    let stops = four_bar_text([1.0, 1.2, 1.0, 2.5], 40.0, "6*t", 1.0);
    vec![
        ("crank-rocker", turns),
        ("locomotive", locomotive_text(1e-3)),
        ("gap", stops.clone()),
        ("rod", with_a_rod(&stops)),
        ("RSUR", rsur(&stops)),
    ]
}

#[test]
fn places_that_nothing_uses_have_no_say() {
    for (name, text) in specimens() {
        let expected = outcome(&text);
        for place in ["[1e4, 0, 0]", "[-3e7, 2e7, 1e8]", "[0.1, 0.1, 0.1]"] {
            let more = text.replace("[bodies]", &format!("far = {place}\n[bodies]"));
            assert_same(&format!("{name} with a hardpoint at {place}"), &expected, &outcome(&more));
        }
    }
}

/// The same mechanism with all places scaled and moved.
fn placed(text: &str, scale: f64, shift: [f64; 3]) -> String {
    let place = |line: &str| {
        let (name, rest) = line.split_once('=')?;
        let name = name.trim();
        let list = rest.trim().strip_prefix('[')?.strip_suffix(']')?;
        let numbers: Vec<f64> = list.split(',').map(|x| x.trim().parse().ok()).collect::<Option<_>>()?;
        let [x, y, z] = std::array::from_fn(|k| numbers[k] * scale + shift[k]);
        (name.len() <= 2).then(|| format!("{name} = [{x}, {y}, {z}]"))
    };
    text.lines().map(|line| place(line).unwrap_or_else(|| line.to_owned())).collect::<Vec<_>>().join("\n")
}

#[test]
fn size_and_place_do_not_matter() {
    for (name, text) in specimens() {
        let expected = outcome(&text);
        for scale in [1e-6, 1e6] {
            assert_same(
                &format!("{name} scaled by {scale}"),
                &expected,
                &outcome(&placed(&text, scale, [0.0; 3])),
            );
        }
        // So far away the file's numbers themselves have eleven digits left.
        let (at, values, _) = outcome(&placed(&text, 1.0, [1e5, -2e5, 3e4]));
        assert_eq!(
            at.map(|a| std::mem::discriminant(&a.1)),
            expected.0.map(|a| std::mem::discriminant(&a.1)),
            "{name}"
        );
        for (x, y) in expected.1.iter().zip(&values) {
            assert!((x - y).abs() < 1e-8 * x.abs().max(1.0), "{name} far away: {y}, not {x}");
        }
    }
}

#[test]
fn a_base_in_motion_does_not_matter() {
    for (name, text) in specimens() {
        let expected = outcome(&text);
        // The base turns about an axis across everything, and so do all measures with it.
        let moving = text
            .replace("\"ground\"", "\"base\"")
            .replace("[bodies]", "[bodies]\nbase = {}")
            .replace(
                "[joints]",
                "[joints]\nturntable = { type = \"revolute\", bodies = [\"ground\", \"base\"], at = [0, 0, 0], axis = [1, 0.3, 0.2] }",
            )
            .replace("[drivers]", "[drivers]\nturn = { joint = \"turntable\", law = \"2.5*sin(7*t)\" }");
        assert_same(&format!("{name} on a base in motion"), &expected, &outcome(&moving));
    }
}

#[test]
fn a_lock_is_judged_in_the_size_of_its_loop() {
    // A crank of 300 mm that is 12 mm too long locks, wherever else a point may be.
    let text = locomotive_text(0.04);
    let far = text.replace("[bodies]", "far = [1e4, 0, 0]\n[bodies]");
    for text in [text, far] {
        assert!(matches!(outcome(&text).0, Some((_, StopKind::Locked { .. }))), "{:?}", outcome(&text).0);
    }
}

/// Numbers of steps in which turns and metrics are requested.
const FEW_COUNTS: [usize; 8] = [1, 2, 3, 5, 8, 49, 499, 5_000];
/// Laws that hurry, rest, jump, pulse or turn round between output times, whatever these are; deg.
const LAWS: [&str; 11] = [
    "720*if(t < 1, 0, 1)",
    "-2000*if(t < 0.5, 0, 1)",
    "1000*exp(-((t - 0.333)/0.0001)^2) + 360*t",
    "step(t, 0.45, 0, 0.55, 1080)",
    "44*sin(6*pi*t)",
    "900*abs(t - 0.3) - 270",
    "500*min(t, 0.4) - 2000*max(0, t - 0.7)",
    "1000 + 360*t",
    "-725 + 1440*step(t, 0.2, 0, 0.3, 1)",
    "3600*sin(2*pi*t)",
    "sqrt(t + 1e-9)*3000",
];
/// Angles that are counted through turns agree with the law to this, rad.
const SAME_ANGLE: f64 = 1e-9;

/// A crank-rocker with angles that only the path counts, and a torsion spring on its pin, which is cut.
fn turning(law: &str) -> Model {
    model(&format!(
        r#"name = "turns"
        units = {{ length = "mm", angle = "deg" }}
        [hardpoints]
        O = [0, 0, 0]
        A = [40, 0, 0]
        B = [190, 60, 0]
        D = [180, 0, 0]
        [bodies]
        crank = {{}}
        coupler = {{}}
        rocker = {{}}
        [joints]
        O = {{ type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }}
        A = {{ type = "revolute", bodies = ["crank", "coupler"], at = "A", axis = "z", cut = true }}
        B = {{ type = "revolute", bodies = ["coupler", "rocker"], at = "B", axis = "z" }}
        D = {{ type = "revolute", bodies = ["ground", "rocker"], at = "D", axis = "z" }}
        [drivers]
        motor = {{ joint = "O", law = "{law}" }}
        [forces]
        s = {{ type = "torsion_spring", joint = "A", stiffness = 0.01 }}
        [points]
        tip = {{ body = "crank", at = "A" }}
        centre = {{ body = "ground", at = "O" }}
        [measures]
        crank = {{ type = "coordinate", joint = "O" }}
        angle = {{ type = "angle", from = [1, 0, 0], to = ["centre", "tip"], about = "z" }}
        yaw = {{ type = "orientation", body = "crank", angle = "yaw" }}
        pin = {{ type = "coordinate", joint = "A" }}
        rocker = {{ type = "coordinate", joint = "D" }}
        formula = {{ type = "expression", expression = "3*angle - 2*yaw" }}
        moment = {{ type = "spring_force", force = "s" }}
        [time]
        end = 1
        steps = 10"#
    ))
}

#[test]
fn turns_are_those_of_the_path_in_any_number_of_steps() {
    for law in LAWS {
        let model = turning(law);
        for (n, formulation) in FEW_COUNTS
            .into_iter()
            .flat_map(|n| [Formulation::Relative, Formulation::Absolute].map(|formulation| (n, formulation)))
        {
            // Loads are solved step by step: that many only where the law is least even.
            if n > 499 && (formulation == Formulation::Absolute || law != LAWS[2]) {
                continue;
            }
            let model = Model { times: spaced(&model, n), ..model.clone() };
            let analysis = Analysis::with(&model, formulation).unwrap();
            let solution = analysis.solve(Run::new().without_sensitivities());
            let name = format!("{law} in {n} steps, {formulation:?}");
            assert!(solution.stop.is_none(), "{name}: {:?}", solution.stop);
            let value = |k: usize, what: &str| {
                let m = solution.measured.index(what).unwrap();
                solution.measured.value(k, m)[0]
            };
            for (k, t) in solution.motion.times.iter().enumerate() {
                let turned = model.drivers[0].law.at(*t).value();
                for what in ["crank", "angle", "yaw", "formula"] {
                    let found = value(k, what);
                    assert!(
                        (found - turned).abs() < SAME_ANGLE * (1.0 + turned.abs()),
                        "{name}: {what} {found}, not {turned} at {t}"
                    );
                }
                // 0.01 N m/deg, in the unit of the drawing
                let (pin, moment) = (value(k, "pin"), value(k, "moment"));
                let stiffness = 0.01 * 180.0 / std::f64::consts::PI;
                assert!(
                    (moment + stiffness * pin).abs() < 1e-7 * (1.0 + pin.abs()),
                    "{name}: {moment} of {pin} at {t}"
                );
                // The coupler of a crank-rocker swings by less than half a turn: the pin turns back by what the crank
                // turns.
                assert!((pin + turned).abs() < std::f64::consts::PI, "{name}: {pin} of {turned} at {t}");
            }
        }
    }
}

#[test]
fn a_jump_at_an_output_time_is_followed_as_between_them() {
    let jump = four_bar([0.3, 1.1, 0.9, 1.2], 60.0, "2*if(t < 0.5, 0, 1) + 0.1*t", 1.0);
    assert_eq!(same_in_any_number_of_steps("a jump", &jump), None);
}

#[test]
fn laws_without_end_are_refused_in_time() {
    for law in [
        "50*sin(1e15*t)",
        "50*sin(1e18*t)",
        "50*sin(1e9*sin(1e12*t))",
        "3*if(sin(1e7*t) > 0, 1, 0)",
        "1e16*t",
    ] {
        let endless = four_bar([0.3, 1.1, 0.9, 1.2], 60.0, law, 1.0);
        let solution = run(&endless, spaced(&endless, 10));
        let stop = solution.stop.unwrap_or_else(|| panic!("{law} was followed"));
        assert!(matches!(stop.kind, StopKind::TooFar { .. }), "{law}: {:?}", stop.kind);
    }
}

#[test]
fn the_time_at_which_a_motion_of_microseconds_ends_has_its_digits() {
    let slow = four_bar([0.5, 0.5, 0.3, 0.6], 60.0, "300*t", 1.0);
    let fast = four_bar([0.5, 0.5, 0.3, 0.6], 60.0, "300e6*t", 1e-6);
    let [slow, fast] = [&slow, &fast].map(|model| {
        let stop = run(model, spaced(model, 10)).stop.expect("the crank cannot turn fully");
        (stop.failed_time, stop.headline(model))
    });
    let time = format!("{:.6e}", fast.0).parse::<f64>().unwrap();
    assert!((fast.0 / slow.0 - 1e-6).abs() < 1e-12 && time > 0.0, "{slow:?} {fast:?}");
    assert_eq!(fast.1, format!("the mechanism cannot move beyond t = {time:e} s"));
}

#[test]
fn a_law_may_turn_back_next_to_a_limit() {
    // The crank reaches a limit; a law turns back before it, or just beyond.
    let limit = |law: &str| four_bar([1.0, 1.3, 1.0, 2.5], 40.0, law, 2.0);
    let (at, kind) = same_in_any_number_of_steps("to the limit", &limit("t")).expect("a limit");
    assert_eq!(kind, StopKind::Limit);
    for (short, stops) in [(1e-3, false), (4e-6, false), (2e-6, false), (-1e-3, true)] {
        let law = format!("{:?}*(1 - (t - 1)^2)", at - short);
        let verdict = same_in_any_number_of_steps(&format!("{short} before the limit"), &limit(&law));
        assert_eq!(verdict.is_some(), stops, "{short} before the limit: {verdict:?}");
    }
    // Where a law barely reaches the limit its time is known to the root of what the angle is known to.
    let beyond = limit(&format!("{:?}*(1 - (t - 1)^2)", at + 4e-6));
    for n in COUNTS {
        let (time, kind) = verdict(&run(&beyond, spaced(&beyond, n))).expect("it reaches the limit");
        assert_eq!(kind, StopKind::Limit, "{n} steps");
        assert!((time - 0.997).abs() < 1e-3, "{n} steps: {time}");
    }
}

/// Metrics of a crank-rocker in a number of steps.
fn crank_rocker_metrics(law: &str, n: usize, formulation: Formulation, moved: f64) -> Vec<MetricValue> {
    let text = four_bar_text([0.5, 1.2, 0.8, 1.0], 60.0, law, 1.0);
    let text = text.replace("steps = 10", &format!("steps = {n}"));
    let text = text.replace("[drivers]", "[design]\nlength = { move = \"C\", along = \"x\" }\n[drivers]");
    let text = format!(
        r#"{text}
        [metrics]
        most = {{ of = "rocker", take = "max" }}
        least = {{ of = "rocker", take = "min" }}
        range = {{ of = "rocker", take = "range" }}
        inside = {{ of = "rocker", take = "max", window = [0.2, 0.3] }}
        there = {{ of = "rocker", over = "crank", take = "value", at = 0.7 }}
        slope = {{ of = "rocker", over = "crank", take = "slope", at = 0.7 }}"#
    );
    let model = model(&text);
    let solution = Analysis::with(&model, formulation).unwrap().solve(Run::new().at(&[moved]));
    assert!(solution.stop.is_none(), "{law}: {:?}", solution.stop);
    metrics(&model, &solution)
}

#[test]
fn metrics_are_those_of_the_curve_in_any_number_of_steps() {
    for law in ["2*pi*t", "1.2*sin(2*pi*t) + t", "2*abs(t - 0.3)", "step(t, 0.4, 0, 0.5, 20)"] {
        let find = |n, formulation, moved| crank_rocker_metrics(law, n, formulation, moved);
        let expected = find(1_000, Formulation::Relative, 0.0);
        // Of what is solved again, the derivative is that of the value.
        let step = 1e-5;
        let [more, less] = [step, -step].map(|by| find(2, Formulation::Relative, by));
        for (n, formulation) in [1, 2, 3, 5, 8, 50]
            .into_iter()
            .flat_map(|n| [Formulation::Relative, Formulation::Absolute].map(|formulation| (n, formulation)))
        {
            let found = find(n, formulation, 0.0);
            for (m, (found, expected)) in found.iter().zip(&expected).enumerate() {
                let name = format!("{law}: metric {m} in {n} steps, {formulation:?}");
                let [value, known] = [found, expected].map(|metric| metric.value.unwrap_or(f64::NAN));
                let same = (value - known).abs() < 1e-7 || value.is_nan() && known.is_nan();
                assert!(same, "{name}: {value}, not {known}");
                if let (Some(more), Some(less)) = (more[m].value, less[m].value) {
                    let d = (more - less) / (2.0 * step);
                    assert!(
                        (found.d[0] - d).abs() < 1e-5 * (1.0 + d.abs()),
                        "{name}: {}, not {d}",
                        found.d[0]
                    );
                }
            }
        }
    }
}

/// Mechanisms with a constraint more than they need, which keeps them where those of the others become dependent.
const HELD_BY_REDUNDANT: [(&str, &str); 3] = [
    (
        "a drag link with two couplers",
        r#"
hardpoints = { A = [0, 0, 0], D = [20, 0, 0], B = [32.418138352088384, 50.48825908847379, 0], C = [-16.67145957394343, 40.990292176521905, 0] }
bodies = { k = {}, one = {}, r = {}, two = {} }
[joints]
A = { type = "revolute", bodies = ["ground", "k"], at = "A", axis = "z" }
B = { type = "revolute", bodies = ["k", "one"], at = "B", axis = "z" }
C = { type = "revolute", bodies = ["one", "r"], at = "C", axis = "z" }
D = { type = "revolute", bodies = ["ground", "r"], at = "D", axis = "z" }
B_two = { type = "revolute", bodies = ["k", "two"], at = "B", axis = "z" }
C_two = { type = "revolute", bodies = ["two", "r"], at = "C", axis = "z" }
"#,
    ),
    (
        "an elliptic trammel with a crank",
        r#"
hardpoints = { A = [0, 0, 0], M = [40.95760221444959, 28.678821817552304, 0], P = [81.91520442889917, 0, 0], Q = [0, 57.35764363510461, 0] }
bodies = { k = {}, rod = {} }
[joints]
A = { type = "revolute", bodies = ["ground", "k"], at = "A", axis = "z" }
M = { type = "revolute", bodies = ["k", "rod"], at = "M", axis = "z" }
P = { type = "inline", bodies = ["ground", "rod"], at = "P", axis = "x" }
Q = { type = "inline", bodies = ["ground", "rod"], at = "Q", axis = "y" }
"#,
    ),
    (
        "three parallel cranks",
        r#"
hardpoints = { A = [0, 0, 0], B = [100, 0, 0], C = [60, -50, 0], a = [20, 10, 0], b = [120, 10, 0], c = [80, -40, 0] }
bodies = { k = {}, second = {}, third = {}, rod = {} }
[joints]
A = { type = "revolute", bodies = ["ground", "k"], at = "A", axis = "z" }
B = { type = "revolute", bodies = ["ground", "second"], at = "B", axis = "z" }
C = { type = "revolute", bodies = ["ground", "third"], at = "C", axis = "z" }
a = { type = "revolute", bodies = ["k", "rod"], at = "a", axis = "z" }
b = { type = "revolute", bodies = ["second", "rod"], at = "b", axis = "z" }
c = { type = "revolute", bodies = ["third", "rod"], at = "c", axis = "z" }
"#,
    ),
];

#[test]
fn mechanisms_that_a_redundant_constraint_holds_turn_as_often_as_they_are_driven() {
    for (name, text) in HELD_BY_REDUNDANT {
        let head = "name = \"held\"\nunits = { length = \"mm\", angle = \"deg\" }\n";
        let tail = "[drivers]\nm = { joint = \"A\", law = \"360*t\" }\n[time]\nend = 3\nsteps = 100\n";
        let model = model(&format!("{head}{text}{tail}"));
        let of = |formulation| {
            let run = Run::new().without_sensitivities();
            Analysis::with(&model, formulation).unwrap_or_else(|e| panic!("{name}: {e}")).solve(run)
        };
        let relative = of(Formulation::Relative);
        assert!(relative.stop.is_none(), "{name}: {:?}", relative.stop);
        let steps = 0..relative.motion.len();
        if name == "three parallel cranks" {
            // The rod does not turn. With every joint cut, its block does not have the rows of the third crank.
            for k in steps {
                let turned = relative.body(k, BodyId(4)).rotation.cols[0] - Vec3::new(1.0, 0.0, 0.0);
                assert!(turned.norm() < 1e-12, "{name} at step {k}: {turned:?}");
            }
            continue;
        }
        let absolute = of(Formulation::Absolute);
        assert!(absolute.stop.is_none(), "{name}: {:?}", absolute.stop);
        for k in steps {
            for b in 0..model.bodies.len() {
                let [one, other] = [&relative, &absolute].map(|solution| solution.body(k, BodyId(b)).r);
                assert!((one - other).norm() < 1e-12, "{name} at step {k}: {one:?} {other:?}");
            }
        }
    }
}

#[test]
fn a_stage_moves_wherever_its_joints_coincide() {
    for place in ["[5.1, 3.3, 7.7]", "[0, 0, 0]", "[5, 0, 0]", "[1000.3, -7.77, 0.1]"] {
        let joint = |axis: &str| {
            format!(
                "{axis} = {{ type = \"travel\", bodies = [\"ground\", \"k\"], at = \"B\", axis = \"{axis}\" }}\n"
            )
        };
        let text = format!(
            "name = \"stage\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\nhardpoints = {{ B = {place} }}\n\
             bodies = {{ k = {{}} }}\n[joints]\nO = {{ type = \"orientation\", bodies = [\"ground\", \"k\"] }}\n{}{}{}\
             [drivers]\nx = {{ joint = \"x\", law = \"10*t\" }}\ny = {{ joint = \"y\", law = \"20*t\" }}\n\
             z = {{ joint = \"z\", law = \"-30*t\" }}\n[time]\nat = [0, 1]\n",
            joint("x"),
            joint("y"),
            joint("z")
        );
        let model = model(&text);
        let solution = run(&model, vec![0.0, 1.0]);
        assert!(solution.stop.is_none(), "{place}: {:?}", solution.stop);
        let [before, after] = [0, 1].map(|k| solution.body(k, BodyId(1)).r);
        let moved = after - before - Vec3::new(0.01, 0.02, -0.03);
        assert!(moved.norm() < 1e-15, "{place}: {moved:?}");
    }
}

#[test]
fn a_law_with_a_branch_that_is_undefined_elsewhere_is_followed() {
    for law in ["-25*if(t<0.3,0,(t-0.3)^2.5)", "if(t >= 0.3, sqrt(t - 0.3)*(t - 0.3)^2, 0)"] {
        let text = format!(
            "name = \"slide\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\nbodies = {{ s = {{}} }}\n\
             joints.j = {{ type = \"translational\", bodies = [\"ground\", \"s\"], at = [0, 0, 0], axis = \"x\" }}\n\
             drivers.d = {{ joint = \"j\", law = \"{law}\" }}\n[time]\nend = 1\nsteps = 7\n"
        );
        let model = model(&text);
        let solution = run(&model, model.times.clone());
        assert!(solution.stop.is_none(), "{law}: {:?}", solution.stop);
    }
}

/// A motion that ends early has no metrics of its whole curve, for any output times.
#[test]
fn a_motion_that_ends_early_has_no_extremum() {
    for steps in [3, 10, 50] {
        let text = four_bar_text([3.0, 1.2, 3.5, 5.0], 60.0, "6*t", 1.0)
            .replace("steps = 10", &format!("steps = {steps}"))
            + "\n[metrics]\nmost = { of = \"rocker\", take = \"max\" }\n\
               change = { of = \"rocker\", take = \"change\" }\n\
               early = { of = \"rocker\", over = \"crank\", take = \"value\", at = 0 }\n";
        let file = model(&text);
        let solution = Analysis::new(&file).unwrap().run();
        assert!(solution.stop.is_some());
        let found: Vec<Option<f64>> = metrics(&file, &solution).into_iter().map(|m| m.value).collect();
        assert!(found[0].is_none() && found[1].is_none() && found[2].is_some(), "{steps}: {found:?}");
    }
}

//! Envelopes of shapes: closed surfaces, volumes with closed forms, and random positions between those of the envelope.

use std::cell::Cell;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

use hardpoint::model::Model;
use hardpoint::run::{Analysis, Run};
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint_file::parse;
use hardpoint_study::envelope::{Envelope, EnvelopeError, Overrides, Request, Triangles, envelope};

/// A slider with a ball and a drum, and an arm on it.
const SLIDER: &str = r#"
name = "slider"
units = { length = "mm", angle = "deg" }
hardpoints = { origin = [10, 20, 30], elbow = [10, 20, 60] }
bodies = { slider = {}, arm = {} }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = "origin", axis = [1, 2, 2] }
joints.hinge = { type = "revolute", bodies = ["slider", "arm"], at = "elbow", axis = [1, 2, 2] }
drivers.push = { joint = "slide", law = "90*t" }
drivers.turn = { joint = "hinge", law = "360*t" }
time = { end = 1.0, steps = 3 }
[shapes]
ball = { body = "slider", sphere = "origin", radius = 15 }
drum = { body = "slider", cylinder = [[10, 20, 30], [16, 32, 42]], radius = 25, round = 6 }
stick = { body = "arm", capsule = [[10, 20, 60], [50, 0, 60]], radius = 5 }
[cases.along]
other_drivers = "as_in_model"
[cases.both]
grid = { push = { from = -40, to = 50, steps = 3 }, turn = { from = -60, to = 60, steps = 3 } }
"#;

fn slider() -> Model {
    parse(SLIDER, "slider.toml").unwrap_or_else(|e| panic!("{e}")).model
}

fn envelope_of(model: &Model, overrides: Overrides) -> Envelope {
    let request = Request::of(model, overrides).unwrap_or_else(|e| panic!("{e}"));
    envelope(model, Formulation::Relative, &[], &request, &|| true).unwrap_or_else(|e| panic!("{e:?}"))
}

fn overrides(shape: &str, case: &str, error: f64) -> Overrides {
    Overrides { shape: shape.into(), case: Some(case.into()), error: Some(error), ..Overrides::default() }
}

#[test]
fn an_interrupted_envelope_is_the_last_surface() {
    let model = slider();
    let request = Request::of(&model, overrides("ball", "along", 2e-5)).unwrap();
    let calls = Cell::new(0_usize);
    let until = |most: usize| {
        let count = AtomicUsize::new(0);
        let more = || count.fetch_add(1, Ordering::Relaxed) < most;
        let found = envelope(&model, Formulation::Relative, &[], &request, &more);
        calls.set(count.into_inner());
        found
    };
    let whole = until(usize::MAX).unwrap();
    let all = calls.get();
    assert!(!whole.interrupted && whole.is_within_error);
    assert!(matches!(until(0), Err(EnvelopeError::Interrupted)));
    // The last surface takes most of the calls.
    let part = until(all - all / 8).unwrap();
    assert!(part.interrupted && !part.is_within_error && calls.get() <= all);
    assert_closed(&part.surface);
    assert!(part.surface.triangles.len() < whole.surface.triangles.len());
    let volumes = [&part, &whole].map(|found| found.surface.volume());
    assert!((volumes[0] / volumes[1] - 1.0).abs() < 0.02, "{volumes:?}");
}

/// Every edge of a closed surface belongs to two triangles, which pass it in opposite directions.
fn assert_closed(surface: &Triangles) {
    let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
    for &[a, b, c] in &surface.triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            assert_ne!(from, to);
            *edges.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
        }
    }
    assert!(!edges.is_empty() && edges.values().all(|sum| *sum == 0));
}

/// Volume of a capsule.
fn capsule(radius: f64, length: f64) -> f64 {
    PI * radius * radius * (length + 4.0 / 3.0 * radius)
}

#[test]
fn the_envelope_of_a_ball_on_a_line_is_a_capsule() {
    let model = slider();
    for (case, margin) in [("along", 0.0), ("both", 0.0), ("along", 0.004)] {
        let found = envelope_of(&model, Overrides { margin: Some(margin), ..overrides("ball", case, 4e-4) });
        assert!(found.is_within_error && found.stops.is_empty());
        assert_closed(&found.surface);
        // The slide is 90 mm in both.
        let exact = capsule(0.015 + margin, 0.09);
        let within = found.surface.area() * found.error;
        let volume = found.surface.volume();
        assert!((volume - exact).abs() < within, "{case}: {volume} {exact} {within}");
        // A ball's own positions have concave notches between them: the volume is below, by far less than permitted.
        assert!(volume > 0.99 * exact && volume < 1.001 * exact, "{case}: {volume} {exact}");
    }
}

#[test]
fn a_shape_does_not_move_in_the_frame_of_its_own_body() {
    let model = slider();
    let found = envelope_of(
        &model,
        Overrides { relative_to: Some("slider".into()), ..overrides("drum", "along", 2e-4) },
    );
    assert_closed(&found.surface);
    assert!(found.between_poses < 1e-9, "{}", found.between_poses);
    // A cylinder of radius 25 and width 18 with edges rounded by 6: a core, a ring around it by Pappus, and caps.
    let (core, half, round) = (0.019, 0.003, 0.006);
    let ring = PI * round * round / 2.0 * 2.0 * PI * (core + 4.0 * round / (3.0 * PI));
    let exact = PI * core * core * (2.0 * half + 2.0 * round)
        + ring
        + 2.0 * half * PI * ((core + round) * (core + round) - core * core);
    let volume = found.surface.volume();
    assert!((volume - exact).abs() < 2e-3 * exact, "{volume} {exact}");
}

#[test]
fn all_positions_of_a_shape_are_within_its_envelope_and_its_error() {
    let model = slider();
    let found = envelope_of(&model, overrides("stick", "along", 2e-3));
    assert_closed(&found.surface);
    let own = model.in_case(model.case("along").unwrap());
    // Times that are none of the envelope's.
    let times: Vec<f64> = (0..37).map(|k| (f64::from(k) + 0.377) / 37.5).collect();
    let moved = Model { times, ..own };
    let analysis = Analysis::with(&moved, Formulation::Relative).unwrap();
    let solution = analysis.solve(Run::new());
    let arm = model.bodies.iter().position(|b| b.name == "arm").unwrap();
    let triangles: Vec<[Vec3; 3]> = found.surface.corners().collect();
    let longest = |[a, b, c]: &[Vec3; 3]| f64::max((*b - *a).norm(), (*c - *a).norm());
    let reach = triangles.iter().map(longest).fold(0.0, f64::max);
    let mut beyond = 0.0_f64;
    for k in 0..solution.motion.len() {
        let state = solution.motion.at(k).body(arm);
        for n in 0..=10 {
            // Middle line of the stick.
            let s = f64::from(n) / 10.0;
            let p = state.r + state.rotation * Vec3::new(0.01 + 0.04 * s, 0.02 - 0.02 * s, 0.06);
            // No triangle is nearer to a point than its first corner by more than its longest side.
            let corner = |t: &&[Vec3; 3]| (p - t[0]).dot(p - t[0]);
            let nearest = triangles.iter().map(|t| corner(&t)).fold(f64::INFINITY, f64::min).sqrt();
            let far = (nearest + reach) * (nearest + reach);
            let candidates = triangles.iter().filter(|t| corner(t) <= far);
            let near = candidates.map(|t| distance_from_triangle(p, *t)).fold(f64::INFINITY, f64::min);
            // The surface is at least its radius away.
            beyond = beyond.max(0.005 - near);
        }
    }
    assert!(beyond < found.error, "{beyond} {}", found.error);
}

/// Distance of a point from a triangle, by its own formula: the plane, or the edges.
fn distance_from_triangle(p: Vec3, [a, b, c]: [Vec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let inside = [[a, b], [b, c], [c, a]].iter().all(|[q, r]| (*r - *q).cross(p - *q).dot(normal) >= 0.0);
    if inside {
        return (normal.dot(p - a) / normal.norm()).abs();
    }
    let from_edge = |q: Vec3, r: Vec3| {
        let e = r - q;
        let t = (e.dot(p - q) / e.dot(e)).clamp(0.0, 1.0);
        (p - q - e * t).norm()
    };
    from_edge(a, b).min(from_edge(b, c)).min(from_edge(c, a))
}

#[test]
fn requests_without_an_envelope_are_refused_with_a_remedy() {
    let text = SLIDER
        .replace("ball = {", "wall = { body = \"ground\", plane = [0, 0, 0], normal = \"z\" }\nball = {");
    let model = parse(&text, "slider.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let refused = |overrides: Overrides| Request::of(&model, overrides).unwrap_err().to_string();
    assert!(refused(overrides("wall", "along", 1e-3)).contains("plane"));
    assert!(refused(overrides("bal", "along", 1e-3)).contains("`ball`"));
    assert!(refused(overrides("ball", "alon", 1e-3)).contains("`along`"));
    assert!(refused(overrides("ball", "along", 0.0)).contains("not positive"));
    let unknown = Overrides { relative_to: Some("rim".into()), ..overrides("ball", "along", 1e-3) };
    assert!(refused(unknown).contains("rim"));
}

/// A block of 30 mm with a fin of 40 mm on it, 1 mm thick: the same profile in x and z over 10 mm of y.
fn fin() -> String {
    let profile = [
        [0.0, 0.0],
        [30.0, 0.0],
        [30.0, 14.5],
        [70.0, 14.5],
        [70.0, 15.5],
        [30.0, 15.5],
        [30.0, 30.0],
        [0.0, 30.0],
    ];
    let line = |y: f64| profile.map(|[x, z]| format!("v {x} {y} {z}\n")).concat();
    let ends = [[1, 2, 3], [1, 3, 6], [3, 4, 5], [3, 5, 6], [1, 6, 8], [6, 7, 8]];
    let ends = ends.map(|[a, b, c]| format!("f {a} {b} {c}\nf {} {} {}\n", a + 8, c + 8, b + 8)).concat();
    let side = |k: usize| {
        let next = k % 8 + 1;
        format!("f {k} {} {next}\nf {k} {} {}\n", next + 8, k + 8, next + 8)
    };
    format!("{}{}{ends}{}", line(0.0), line(10.0), (1..=8).map(side).collect::<String>())
}

#[test]
fn a_fin_that_is_thinner_than_the_first_cells_is_part_of_the_envelope() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("fin.obj"), fin()).unwrap();
    let path = folder.path().join("fin.toml");
    let text = r#"
name = "fin"
units = { length = "mm", angle = "deg" }
time = { end = 1.0, steps = 4 }
bodies = { slider = {} }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = [0, 0, 0], axis = "y" }
drivers.push = { joint = "slide", law = "3*t" }
shapes.block = { body = "slider", mesh = "fin.obj" }
"#;
    std::fs::write(&path, text).unwrap();
    let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
    // The first cells are 3.5 mm wide, and their triangles deviate by less than half of this error.
    let request = Overrides { shape: "block".into(), error: Some(4e-3), ..Overrides::default() };
    let found = envelope_of(&model, request);
    assert_closed(&found.surface);
    assert!(found.is_within_error, "{} {}", found.surface.deviation, found.error);
    let end = found.surface.vertices.iter().map(|p| p.x).fold(0.0, f64::max);
    assert!((end - 0.07).abs() < found.error, "{end}");
    let exact = (30.0 * 30.0 + 40.0 * 1.0) * (10.0 + 3.0) * 1e-9;
    let volume = found.surface.volume();
    assert!((volume - exact).abs() < 0.02 * exact, "{volume} {exact}");
}

#[test]
fn a_rod_that_is_thinner_than_the_first_cells_has_an_envelope() {
    let text = r#"
name = "thin"
units = { length = "mm", angle = "deg" }
time = { end = 1.0, steps = 3 }
bodies = { slider = {} }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = [0, 0, 0], axis = "y" }
drivers.push = { joint = "slide", law = "20*t" }
shapes.thin = { body = "slider", capsule = [[50, 0, 0], [80, 0, 0]], radius = 0.2 }
shapes.wire = { body = "slider", ring = [50, 0, 0], axis = "y", radius = 10, round = 0 }
"#;
    let model = parse(text, "thin.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let of = |shape: &str| Overrides { shape: shape.into(), ..Overrides::default() };
    let found = envelope_of(&model, Overrides { error: Some(1.2e-3), ..of("thin") });
    assert_closed(&found.surface);
    assert!(found.is_within_error, "{} {} {}", found.surface.deviation, found.between_poses, found.error);
    // Less than all points within the radius of a rectangle: there are gaps between the positions.
    let (a, b, r) = (30.0, 20.0, 0.2);
    let exact = (a * b * 2.0 * r + (a + b) * PI * r * r + 4.0 / 3.0 * PI * r * r * r) * 1e-9;
    let volume = found.surface.volume();
    assert!(volume > 0.0 && volume < exact, "{volume} {exact}");
    // The rod at both ends of its path.
    for (end, sign) in [(-r, -1.0), (b + r, 1.0)] {
        let beyond = found.surface.vertices.iter().map(|p| sign * (p.y * 1e3 - end)).fold(f64::MIN, f64::max);
        assert!(beyond.abs() < found.error * 1e3, "{end}: {beyond}");
    }
    // A wire has no volume, unless a distance is added around it.
    let refused = Request::of(&model, of("wire")).unwrap_err();
    assert!(refused.message.contains("`wire`") && refused.message.contains("volume"), "{refused}");
    assert!(Request::of(&model, Overrides { margin: Some(1e-3), ..of("wire") }).is_ok());
}

/// An arm that turns about the z axis of the ground.
fn turning(law: &str, steps: usize, shape: &str) -> Model {
    let text = format!(
        r#"
name = "turning"
units = {{ length = "mm", angle = "deg" }}
time = {{ end = 1, steps = {steps} }}
bodies = {{ arm = {{}} }}
joints.pivot = {{ type = "revolute", bodies = ["ground", "arm"], at = [0, 0, 0], axis = "z" }}
drivers.motor = {{ joint = "pivot", law = "{law}" }}
shapes.s = {{ body = "arm", {shape} }}
"#
    );
    parse(&text, "turning.toml").unwrap_or_else(|e| panic!("{e}")).model
}

#[test]
fn motions_that_repeat_themselves_between_output_times_are_swept() {
    let ball = "sphere = [40, 0, 7], radius = 10";
    // Solids of revolution by Pappus: a torus, a part of it with round ends, and a disc with a round rim.
    let torus = 2.0 * PI * PI * 40.0 * 100.0;
    let arc = torus * 60.0 / 360.0 + 4.0 / 3.0 * PI * 1000.0;
    let disc = PI * 1600.0 * 6.0 + PI * 9.0 / 2.0 * 2.0 * PI * (40.0 + 4.0 * 3.0 / (3.0 * PI));
    let cases = [
        ("720*t", 1, ball, torus),
        ("30*sin(16*pi*t)", 4, ball, arc),
        ("30*(1 - cos(16*pi*t))", 4, ball, arc),
        ("360*t", 7, "capsule = [[-40, 0, 0], [40, 0, 0]], radius = 3", disc),
    ];
    for (law, steps, shape, exact) in cases {
        let model = turning(law, steps, shape);
        let request = Overrides { shape: "s".into(), error: Some(1e-3), ..Overrides::default() };
        let found = envelope_of(&model, request);
        assert!(found.is_within_error, "{law}: {} {}", found.between_poses, found.surface.deviation);
        let within = found.surface.area() * found.error * 1e9;
        let volume = found.surface.volume() * 1e9;
        assert!((volume - exact).abs() < within && volume > 0.9 * exact, "{law}: {volume} {exact} {within}");
    }
}

#[test]
fn the_error_of_a_turning_box_includes_what_its_corners_leave_out() {
    // A full turn sweeps a cylinder of the radius of its corners.
    let radius = 10.0_f64.hypot(15.0) * 1e-3;
    for steps in [1, 7] {
        let model = turning("360*t", steps, "box = [20, 30, 10], frame = { position = [0, 0, 3] }");
        let request = Overrides { shape: "s".into(), error: Some(2.5e-3), ..Overrides::default() };
        let found = envelope_of(&model, request);
        assert!(found.is_within_error, "{steps}: {} {}", found.between_poses, found.surface.deviation);
        let side = found.surface.vertices.iter().filter(|p| (p.z - 0.003).abs() < 0.003);
        let least = side.map(|p| p.x.hypot(p.y)).fold(f64::INFINITY, f64::min);
        let stated = found.between_poses + found.surface.deviation;
        assert!(radius - least <= stated, "{steps}: {} {stated}", radius - least);
        let (volume, exact) = (found.surface.volume(), PI * radius * radius * 0.01);
        assert!((volume - exact).abs() < found.surface.area() * found.error, "{steps}: {volume} {exact}");
    }
}

/// A ball of radius 5 mm on a slide whose displacement ends at 17.3 mm.
fn stopped_slide(steps: usize, more: &str) -> Model {
    let text = format!(
        r#"
name = "slide"
units = {{ length = "mm", angle = "deg" }}
time = {{ end = 1, steps = {steps} }}
bodies = {{ slider = {{}}, arm = {{}} }}
joints.slide = {{ type = "translational", bodies = ["ground", "slider"], axis = "x", at = [0, 0, 0], limits.displacement = {{ max = 17.3, stop = true }} }}
joints.hinge = {{ type = "revolute", bodies = ["slider", "arm"], axis = "x", at = [0, 0, 0] }}
drivers.push = {{ joint = "slide", law = "40*t" }}
drivers.turn = {{ joint = "hinge", law = "0*t" }}
shapes.ball = {{ body = "slider", sphere = [0, 0, 0], radius = 5 }}
{more}"#
    );
    parse(&text, "slide.toml").unwrap_or_else(|e| panic!("{e}")).model
}

#[test]
fn the_envelope_of_a_motion_that_a_limit_ends_reaches_the_limit_at_any_output_times() {
    let grid = "[cases.both]\ngrid = { push = { from = 0, to = 40, steps = 3 }, turn = { from = -10, to = 10, steps = 2 } }\n";
    let exact = capsule(0.005, 0.0173);
    let request = || Overrides { shape: "ball".into(), error: Some(2e-4), ..Overrides::default() };
    for (steps, more) in [(1, ""), (3, ""), (400, ""), (5, grid)] {
        let found = envelope_of(&stopped_slide(steps, more), request());
        assert!(found.is_within_error && !found.stops.is_empty(), "{steps} steps: {:?}", found.stops);
        let volume = found.surface.volume();
        assert!(volume > 0.985 * exact && volume < 1.001 * exact, "{steps} steps {more}: {volume} {exact}");
        let highest = found.surface.vertices.iter().map(|p| p.x).fold(0.0, f64::max);
        assert!((highest - 0.0223).abs() < 2e-4, "{steps} steps {more}: {highest}");
        for stop in &found.stops {
            let end = stop.end.map(|end| (end - 17.3 / 40.0).abs() < 1e-9);
            assert_eq!(end, more.is_empty().then_some(true), "{stop:?}");
        }
    }
}

#[test]
fn the_envelope_of_a_motion_that_ends_at_a_dead_point_reaches_its_last_position() {
    // The rod and the crank are in line when the slider has gone 30 mm.
    let text = r#"
name = "stretched"
units = { length = "mm", angle = "deg" }
time = { end = 1, steps = 2 }
hardpoints = { A = [0, 0, 0], B = [18.75, 46.351240544347896, 0], C = [120, 0, 0] }
bodies = { crank = {}, rod = {}, slider = {} }
joints.A = { type = "revolute", bodies = ["ground", "crank"], at = "A", axis = "z" }
joints.B = { type = "revolute", bodies = ["crank", "rod"], at = "B", axis = "z" }
joints.C = { type = "revolute", bodies = ["rod", "slider"], at = "C", axis = "z" }
joints.slide = { type = "translational", bodies = ["ground", "slider"], axis = "x", at = "C" }
drivers.push = { joint = "slide", law = "80*t" }
shapes.ball = { body = "slider", sphere = "C", radius = 5 }
"#;
    let model = parse(text, "stretched.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let found =
        envelope_of(&model, Overrides { shape: "ball".into(), error: Some(2e-4), ..Overrides::default() });
    let reach = 46.351240544347896_f64.hypot(18.75) + 46.351240544347896_f64.hypot(101.25) - 120.0;
    let [stop] = &found.stops[..] else { panic!("{:?}", found.stops) };
    assert!((stop.end.unwrap() - reach / 80.0).abs() < 1e-4, "{stop:?} {reach}");
    let exact = capsule(0.005, reach * 1e-3);
    let volume = found.surface.volume();
    assert!(found.is_within_error && volume > 0.985 * exact && volume < 1.001 * exact, "{volume} {exact}");
}

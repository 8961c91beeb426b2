//! Changes of a model that do not change the answer: output times, order of tables, units, size, position, unused
//! points, a moving base, threads; over models with every joint type, law, driver, coupler, element and measure, and
//! their mirror images.
//!
//! The models are those of `sides.rs`, whose lists are those of the declarations.

use std::collections::HashMap;
use std::num::NonZero;

use hardpoint::model::Model;
use hardpoint::space::{Mat3, Vec3};
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::parse;

use crate::sides;

/// Answers agree to this part of the largest of their kind.
const SAME: f64 = 1e-9;
/// Loads and slopes have the round-off of what they are solved from.
const SAME_LOADS: f64 = 1e-7;
/// Numbers of steps, the first of which is the one that others are held to; the last one for some models only.
const COUNTS: [usize; 6] = [20, 1, 2, 4, 10, 5_000];

/// All results of a run, by name: measures, and positions and orientations of bodies relative to one of them.
struct Answer {
    times: Vec<f64>,
    measures: HashMap<String, Vec<f64>>,
    poses: HashMap<String, Vec<(Vec3, Mat3)>>,
}

impl Answer {
    fn of(model: &Model, solution: &Solution, base: &str) -> Self {
        let steps = 0..solution.motion.len();
        let base = model.bodies.iter().position(|b| b.name == base).unwrap();
        let seen = |body: usize, k: usize| {
            let (from, to) = (solution.motion.at(k).body(base), solution.motion.at(k).body(body));
            let turned_back = |v: Vec3| {
                Vec3::new(
                    from.rotation.cols[0].dot(v),
                    from.rotation.cols[1].dot(v),
                    from.rotation.cols[2].dot(v),
                )
            };
            let rotation = Mat3 { cols: [0, 1, 2].map(|c| turned_back(to.rotation.cols[c])) };
            (turned_back(to.r - from.r), rotation)
        };
        let outputs = solution.measured.outputs.iter().enumerate();
        Self {
            times: solution.motion.times.clone(),
            measures: outputs
                .map(|(m, o)| {
                    let values = steps.clone().map(|k| solution.measured.value(k, m)[0]);
                    (o.name.clone(), values.collect())
                })
                .collect(),
            poses: (1..model.bodies.len())
                .filter(|b| *b != base)
                .map(|b| (model.bodies[b].name.clone(), steps.clone().map(|k| seen(b, k)).collect()))
                .collect(),
        }
    }
}

/// A model, and the settings of its run.
struct Asked<'a> {
    text: &'a str,
    steps: usize,
    threads: usize,
    base: &'a str,
}

fn answer(what: &str, asked: &Asked<'_>) -> Answer {
    let Asked { text, steps, threads, base } = *asked;
    let model = parse(text, "same.toml").unwrap_or_else(|e| panic!("{what}: {e}\n{text}")).model;
    let (start, end) = (model.times[0], model.times[model.times.len() - 1]);
    let times = (0..=steps).map(|k| start + (end - start) * (k as f64 / steps as f64)).collect();
    // Values only: derivatives are compared elsewhere.
    let model = Model { times, variables: Vec::new(), metrics: Vec::new(), ..model };
    let analysis = Analysis::new(&model).unwrap_or_else(|e| panic!("{what}: {e:?}\n{text}"));
    let solution = analysis.solve(Run::new().threads(NonZero::new(threads).unwrap()));
    assert!(solution.stop.is_none(), "{what}: {:?}\n{text}", solution.stop);
    Answer::of(&model, &solution, base)
}

/// Holds an answer to another one at all output times that both have. Places are `scale` times as large.
fn hold_same(
    what: &str,
    text: &str,
    one: &Answer,
    other: &Answer,
    scale: f64,
    measures: impl Fn(&str) -> Option<f64>,
) {
    let mut common = 0;
    for (k, t) in other.times.iter().enumerate() {
        let Some(j) = one.times.iter().position(|x| (x - t).abs() < 1e-12) else { continue };
        common += 1;
        for (name, poses) in &one.poses {
            let ((r, a), (q, b)) = (poses[j], other.poses[name][k]);
            let size = poses.iter().map(|p| p.0.norm()).fold(1e-3, f64::max);
            assert!(
                (r * scale - q).norm() <= SAME * size * scale,
                "{what}: `{name}` is at {q:?}, not {r:?} by {scale}, t = {t}\n{text}"
            );
            let turned = (0..3).map(|c| (a.cols[c] - b.cols[c]).norm()).fold(0.0, f64::max);
            assert!(turned <= SAME, "{what}: `{name}` is turned by {turned}, t = {t}\n{text}");
        }
        for (name, values) in &one.measures {
            let Some(by) = measures(name) else { continue };
            let (x, y) =
                (values[j] * by, other.measures.get(name).unwrap_or_else(|| panic!("{what}: {name}"))[k]);
            let size = values.iter().filter(|x| x.is_finite()).fold(1e-3, |s: f64, x| s.max(x.abs())) * by;
            let same = (x - y).abs() <= SAME_LOADS * size || x.is_nan() && y.is_nan();
            assert!(same, "{what}: `{name}` is {y}, not {x}, t = {t}\n{text}");
        }
    }
    assert!(common >= 2, "{what}: {common} common output times");
}

/// The same tables in the opposite order, each with its lines in the opposite order.
fn reordered(text: &str) -> String {
    let mut tables: Vec<Vec<&str>> = vec![Vec::new()];
    for line in text.lines() {
        if line.starts_with('[') {
            tables.push(Vec::new());
        }
        tables.last_mut().unwrap().push(line);
    }
    let head = tables.remove(0).join("\n");
    let turned = tables.iter().rev().map(|table| {
        let (first, lines) = table.split_first().unwrap();
        let lines: Vec<&str> = lines.iter().rev().copied().collect();
        format!("{first}\n{}", lines.join("\n"))
    });
    format!("{head}\n{}\n", turned.collect::<Vec<_>>().join("\n"))
}

/// The same mechanism on a base in place of ground, which is carried by a joint to ground.
fn on_base(text: &str, carried: &str, drivers: &str) -> String {
    text.replace("\"ground\"", "\"base\"")
        .replace("[bodies]\n", "[bodies]\nbase = { frame = { position = [0, 0, 0] } }\n")
        .replace("[joints]\n", &format!("[joints]\n{carried}\n"))
        .replace("[drivers]\n", &format!("[drivers]\n{drivers}\n"))
}

fn all(_: &str) -> Option<f64> {
    Some(1.0)
}

fn none(_: &str) -> Option<f64> {
    None
}

/// Models across the middle of a vehicle, each with what is changed of it.
fn for_each_model(of: fn(sides::Hold<'_>), mut then: impl FnMut(usize, &str, &str)) {
    let mut count = 0;
    of(&mut |what, text, across, _| {
        if across == 1 {
            then(count, what, text);
            count += 1;
        }
    });
    assert!(count > 0);
}

/// Output times, order, unused points and threads, of any model.
fn hold_to_itself(of: fn(sides::Hold<'_>)) {
    for_each_model(of, |k, what, text| {
        let with = |text: &str, steps: usize, threads: usize| {
            answer(what, &Asked { text, steps, threads, base: "ground" })
        };
        let expected = with(text, COUNTS[0], 1);
        let counts = &COUNTS[1..if k.is_multiple_of(40) { COUNTS.len() } else { COUNTS.len() - 1 }];
        for n in counts {
            hold_same(&format!("{what} in {n} steps"), text, &expected, &with(text, *n, 1), 1.0, all);
        }
        let other = reordered(text);
        hold_same(
            &format!("{what} in another order"),
            &other,
            &expected,
            &with(&other, COUNTS[0], 1),
            1.0,
            all,
        );
        let point = "far = [1e7, -3e7, 1e8]\nnear = [0.1, 0.1, 0.1]\n";
        let more = match text.contains("[hardpoints]\n") {
            true => text.replace("[hardpoints]\n", &format!("[hardpoints]\n{point}")),
            false => text.replace("[bodies]\n", &format!("[hardpoints]\n{point}[bodies]\n")),
        };
        assert!(more.contains("far"), "{what}");
        hold_same(
            &format!("{what} with unused points"),
            &more,
            &expected,
            &with(&more, COUNTS[0], 1),
            1.0,
            all,
        );
        hold_same(&format!("{what} on three threads"), text, &expected, &with(text, COUNTS[0], 3), 1.0, all);
    });
}

/// The front axle with all measures of wheels and axles, whose lists go over several lines: its tables are not moved.
#[test]
fn wheels_and_axles_in_any_times_and_threads() {
    for_each_model(sides::wheels_and_axles, |_, what, text| {
        let with =
            |steps: usize, threads: usize| answer(what, &Asked { text, steps, threads, base: "ground" });
        let expected = with(24, 1);
        for (steps, threads) in [(1, 1), (2, 1), (3, 2), (12, 3)] {
            let how = format!("{what} in {steps} steps on {threads} threads");
            hold_same(&how, text, &expected, &with(steps, threads), 1.0, all);
        }
    });
}

#[test]
fn joint_types_in_any_times_order_and_threads() {
    hold_to_itself(sides::joint_types);
}

#[test]
fn laws_and_drivers_in_any_times_order_and_threads() {
    hold_to_itself(sides::laws);
    hold_to_itself(sides::forms_of_drivers);
}

#[test]
fn couplers_in_any_times_order_and_threads() {
    hold_to_itself(sides::couplers);
}

#[test]
fn masses_and_forces_in_any_times_order_and_threads() {
    hold_to_itself(sides::masses_and_forces);
}

#[test]
fn measures_in_any_times_order_and_threads() {
    hold_to_itself(sides::measures);
}

/// The same numbers in another unit are another size; angles in rad are the same.
#[test]
fn units_and_size_do_not_matter_to_motion() {
    for of in [sides::joint_types as fn(sides::Hold<'_>), sides::laws, sides::couplers] {
        for_each_model(of, |_, what, text| {
            let with = |text: &str| answer(what, &Asked { text, steps: 20, threads: 1, base: "ground" });
            let expected = with(text);
            for (unit, scale) in [("m", 1e3), ("in", 25.4), ("cm", 10.0)] {
                let other = text.replace("length = \"mm\"", &format!("length = \"{unit}\""));
                hold_same(&format!("{what} in {unit}"), &other, &expected, &with(&other), scale, none);
            }
        });
    }
    for_each_model(sides::joint_types, |_, what, text| {
        let rad = text
            .replace("angle = \"deg\"", "angle = \"rad\"")
            .replace("\"3*t\"", "\"3*t*pi/180\"")
            .replace("\"9*t - 4*t^2\"", "\"(9*t - 4*t^2)*pi/180\"");
        let with = |text: &str| answer(what, &Asked { text, steps: 20, threads: 1, base: "ground" });
        hold_same(&format!("{what} in rad"), &rad, &with(text), &with(&rad), 1.0, all);
    });
}

/// A base that moves, and one that is elsewhere and turned, carry the same motion.
#[test]
fn place_and_motion_of_the_base_do_not_matter() {
    let moving = |text: &str| {
        on_base(
            text,
            "turntable = { type = \"revolute\", bodies = [\"ground\", \"base\"], at = [30, 0, -70], axis = [1, 0.3, 0.2] }",
            "turn = { joint = \"turntable\", law = \"40*sin(7*t)\" }",
        )
    };
    let elsewhere = |text: &str, axis: &str| {
        on_base(
            text,
            &format!(
                "stand = {{ type = \"cylindrical\", bodies = [\"ground\", \"base\"], at = [30, 0, -70], axis = {axis} }}"
            ),
            "stand_turn = { joint = \"stand\", coordinate = \"angle\", law = 137 }\nstand_rise = { joint = \"stand\", coordinate = \"displacement\", law = 12340 }",
        )
    };
    for of in [sides::joint_types as fn(sides::Hold<'_>), sides::laws, sides::couplers] {
        for_each_model(of, |_, what, text| {
            let with = |text: &str, base: &str| answer(what, &Asked { text, steps: 20, threads: 1, base });
            let expected = with(text, "ground");
            let coordinates = |name: &str| name.contains("q_").then_some(1.0);
            for (how, other) in
                [("moving base", moving(text)), ("base elsewhere", elsewhere(text, "[1, 0.3, 0.2]"))]
            {
                hold_same(
                    &format!("{what}, {how}"),
                    &other,
                    &expected,
                    &with(&other, "base"),
                    1.0,
                    coordinates,
                );
            }
        });
    }
    // Turned about the direction of gravity and lifted, loads between bodies are the same.
    let unchanged = ["swing_moment", "turned_moment", "push", "power"];
    for_each_model(sides::masses_and_forces, |_, what, text| {
        // These act along global directions, on the spherical joint, or on wheels, which have the directions of a
        // vehicle.
        if ["axes = \"global\"", "left_ball", "wheel_force", "tyre"].iter().any(|w| what.contains(w)) {
            return;
        }
        // The body on the spherical joint, which drivers turn about global directions, is fixed.
        let lines = text
            .lines()
            .filter(|line| !["left_c1", "left_c2", "left_c3"].iter().any(|d| line.starts_with(d)));
        let fixed = lines.map(|line| match line.starts_with("left_ball = ") {
            true => "left_ball = { type = \"fixed\", bodies = [\"left_a\", \"left_c\"], at = \"left_B\" }",
            false => line,
        });
        let text = fixed.collect::<Vec<_>>().join("\n") + "\n";
        let with = |text: &str, base: &str| answer(what, &Asked { text, steps: 20, threads: 1, base });
        let other = elsewhere(&text, "\"z\"");
        let loads = |name: &str| unchanged.iter().any(|u| name.ends_with(u)).then_some(1.0);
        let how = format!("{what}, turned and lifted");
        hold_same(&how, &other, &with(&text, "ground"), &with(&other, "base"), 1.0, loads);
    });
}

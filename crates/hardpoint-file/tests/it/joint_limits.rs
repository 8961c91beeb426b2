//! Limits of joints: times against closed forms, ranges, end stops, both sides of a mirror, studies.

use std::f64::consts::{FRAC_PI_2, PI};

use hardpoint::law::Law;
use hardpoint::model::{LimitEnd, LimitTarget, Model};
use hardpoint::motion::StopKind;
use hardpoint::run::{LimitRange, metrics};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run};
use hardpoint_file::parse;

/// Round-off of times in s and of values in m or rad, at values near 1.
const EXACT: f64 = 1e-12;
/// Step of central differences, m: 5e-5 of the crank.
const STEP: f64 = 2e-6;
/// Their relative truncation, `(STEP / CRANK)^2 = 3e-9` times some derivatives of order 1, and round-off.
const DIFFERENCE: f64 = 1e-7;

fn model_of(text: &str) -> Model {
    parse(text, "limits.toml").unwrap_or_else(|e| panic!("{e}\n{text}")).model
}

fn codes(text: &str) -> Vec<(&'static str, String, Option<String>)> {
    let found = parse(text, "limits.toml").err().map_or(Vec::new(), |all| all.list().to_vec());
    found.into_iter().map(|d| (d.code, d.message, d.help)).collect()
}

fn assert_near(found: f64, expected: f64, within: f64, what: &str) {
    assert!((found - expected).abs() <= within, "{what}: {found} instead of {expected}");
}

/// Crank and rod of a slider-crank, m.
const CRANK: f64 = 0.04;
const ROD: f64 = 0.1;

/// A slider-crank whose crank begins upright and turns clockwise by half a turn per second, in units of `per_metre` and
/// `per_radian`.
fn press(length: &str, angle: &str, limits: &str, steps: usize) -> String {
    let per_metre = [("mm", 1e3), ("m", 1.0), ("in", 1.0 / 0.0254)].iter().find(|u| u.0 == length).unwrap().1;
    let per_radian = if angle == "deg" { 180.0 / PI } else { 1.0 };
    let (a, x) = (CRANK * per_metre, (ROD * ROD - CRANK * CRANK).sqrt() * per_metre);
    format!(
        "name = \"press\"\nplanar = \"xy\"\nunits = {{ length = \"{length}\", angle = \"{angle}\" }}\n\
         [hardpoints]\nO = [0, 0]\nA = [0, {a}]\nB = [{x}, 0]\n\
         [bodies]\ncrank = {{}}\nrod = {{}}\nram = {{}}\n\
         [joints]\ncrank = {{ type = \"revolute\", bodies = [\"ground\", \"crank\"], at = \"O\" }}\n\
         pin = {{ type = \"revolute\", bodies = [\"crank\", \"rod\"], at = \"A\" }}\n\
         wrist = {{ type = \"revolute\", bodies = [\"rod\", \"ram\"], at = \"B\" }}\n\
         [joints.slide]\ntype = \"translational\"\nbodies = [\"ground\", \"ram\"]\nat = \"B\"\naxis = \"x\"\n{limits}\n\
         [drivers]\ncrank = {{ joint = \"crank\", law = \"{}*t\" }}\n\
         [design]\nradius = {{ move = \"A\", along = \"y\" }}\n\
         [time]\nend = 2.0\nsteps = {steps}\n",
        -PI * per_radian
    )
}

/// Times at which the ram of a crank of this radius is displaced by `by`, m, forwards and back.
fn times_of(radius: f64, by: f64) -> [f64; 2] {
    // The rod is as long as it is with the nominal ram and the crank upright at the start.
    let start = (ROD * ROD - CRANK * CRANK).sqrt();
    let rod = (start * start + radius * radius).sqrt();
    let x = start + by;
    // rod^2 = x^2 + r^2 - 2 r x cos(angle)
    let angle = ((x * x + radius * radius - rod * rod) / (2.0 * radius * x)).acos();
    [(FRAC_PI_2 - angle) / PI, (FRAC_PI_2 + angle) / PI]
}

fn ranges(model: &Model, formulation: Formulation) -> Vec<LimitRange> {
    Analysis::with(model, formulation).unwrap().joint_limits(&[])
}

#[test]
fn a_limit_is_reached_at_the_times_of_the_closed_form_for_any_units_and_output_times() {
    let [leaves, returns] = times_of(CRANK, 0.03);
    for (length, angle, max) in [("mm", "deg", 30.0), ("m", "rad", 0.03), ("in", "deg", 0.03 / 0.0254)] {
        for steps in [3, 20, 333] {
            let limits = format!("limits.displacement = {{ min = {}, max = {max} }}", -2.0 * max);
            let model = model_of(&press(length, angle, &limits, steps));
            for formulation in [Formulation::Relative, Formulation::Absolute] {
                let [found] = &ranges(&model, formulation)[..] else { panic!("one limit") };
                let what = format!("{length} {angle}, {steps} steps, {formulation:?}");
                let times: Vec<_> = found.crossings.iter().map(|c| (c.end, c.leaves)).collect();
                assert_eq!(times, [(LimitEnd::Max, true), (LimitEnd::Max, false)], "{what}");
                assert_near(found.crossings[0].time, leaves, EXACT, &what);
                assert_near(found.crossings[1].time, returns, EXACT, &what);
                let start = (ROD * ROD - CRANK * CRANK).sqrt();
                assert_near(found.greatest.value, ROD + CRANK - start, EXACT, &what);
                assert_near(found.least.value, ROD - CRANK - start, EXACT, &what);
                assert_near(found.greatest.time, 0.5, 1e-6, &what);
                assert_near(found.least.time, 1.5, 1e-6, &what);
                assert_eq!(found.begins_beyond, None);
            }
        }
    }
}

#[test]
fn derivatives_of_times_and_extrema_agree_with_those_of_re_solved_designs() {
    let model = model_of(&press("mm", "deg", "limits.displacement = { min = -25, max = 30 }", 20));
    let analysis = Analysis::new(&model).unwrap();
    let [found] = &analysis.joint_limits(&[])[..] else { panic!("one limit") };
    let [before, after] = [-STEP, STEP].map(|b| analysis.joint_limits(&[b]).remove(0));
    let difference = |of: &dyn Fn(&LimitRange) -> f64| (of(&after) - of(&before)) / (2.0 * STEP);
    assert_eq!(found.crossings.len(), 4);
    for (k, crossing) in found.crossings.iter().enumerate() {
        let expected = difference(&|r| r.crossings[k].time);
        assert!(expected.abs() > 1.0);
        assert_near(crossing.d[0], expected, DIFFERENCE * expected.abs(), "time");
        // And against the closed form.
        let by = if crossing.end == LimitEnd::Max { 0.03 } else { -0.025 };
        let time = |b: f64| {
            let [out, back] = times_of(CRANK + b, by);
            if crossing.leaves == (crossing.end == LimitEnd::Max) { out } else { back }
        };
        let wrapped = |t: f64| (t - crossing.time).rem_euclid(1.0).min((crossing.time - t).rem_euclid(1.0));
        assert!(wrapped(time(0.0)) < EXACT || wrapped(-time(0.0)) < EXACT, "{} {}", time(0.0), crossing.time);
    }
    for (of, d) in [
        ((|r: &LimitRange| r.least.value) as fn(&LimitRange) -> f64, found.least.d[0]),
        (|r: &LimitRange| r.greatest.value, found.greatest.d[0]),
    ] {
        let expected = difference(&of);
        assert_near(d, expected, DIFFERENCE * expected.abs(), "value");
    }
}

/// A crank-rocker with ground, crank, coupler and rocker of 4, 1, 3.5 and 2.5, whose crank begins along the ground.
const FOUR_BAR: &str = "name = \"rocker\"\nplanar = \"xy\"\nunits = { length = \"m\", angle = \"rad\" }\n\
    [hardpoints]\nA = [0, 0]\nB = [1, 0]\nC = [3.5, 2.449489742783178]\nD = [4, 0]\n\
    [bodies]\ncrank = {}\ncoupler = {}\nrocker = {}\n\
    [joints]\nA = { type = \"revolute\", bodies = [\"ground\", \"crank\"], at = \"A\" }\n\
    B = { type = \"revolute\", bodies = [\"crank\", \"coupler\"], at = \"B\" }\n\
    C = { type = \"PIN\", bodies = [\"coupler\", \"rocker\"], at = \"C\"LIMIT_C }\n\
    D = { type = \"revolute\", bodies = [\"ground\", \"rocker\"], at = \"D\"LIMIT_D }\n\
    [drivers]\nturn = { joint = \"A\", law = \"2*pi*t\" }\n[design]\nc = { move = \"C\", along = \"y\" }\n[time]\nend = 1.0\nsteps = 12\n";

fn four_bar(pin: &str, of_c: &str, of_d: &str) -> Model {
    model_of(&FOUR_BAR.replace("PIN", pin).replace("LIMIT_C", of_c).replace("LIMIT_D", of_d))
}

#[test]
fn the_rocker_of_a_four_bar_reaches_its_limit_where_the_closed_form_says() {
    let by: f64 = 0.3;
    let model = four_bar("revolute", "", &format!(", limits = {{ angle = {{ max = {by} }} }}"));
    let [found] = &ranges(&model, Formulation::Relative)[..] else { panic!("one limit") };
    // C for the rocker's angle; then the crank closes the triangle A B C.
    let c = [4.0 - 3.5, -2.449489742783178_f64].map(|x| -x);
    let (sin, cos) = by.sin_cos();
    let c = [4.0 + c[0] * cos - c[1] * sin, c[0] * sin + c[1] * cos];
    let (apart, direction) = (c[0].hypot(c[1]), c[1].atan2(c[0]));
    let coupler = (2.5_f64 * 2.5 + 6.0).sqrt();
    let inner = ((1.0 + apart * apart - coupler * coupler) / (2.0 * apart)).acos();
    let mut expected = [direction - inner, direction + inner].map(|a| a.rem_euclid(2.0 * PI) / (2.0 * PI));
    expected.sort_by(f64::total_cmp);
    assert_eq!(found.crossings.len(), 2);
    for (crossing, expected) in found.crossings.iter().zip(expected) {
        assert_near(crossing.time, expected, EXACT, "time");
    }
}

#[test]
fn the_articulation_of_a_ball_in_a_plane_is_the_angle_of_a_pin() {
    let of_pin = four_bar("revolute", ", limits = { angle = { min = -0.7, max = 0.7 } }", "");
    let of_ball = four_bar("spherical", ", limits = { articulation = { max = 0.7 } }", "");
    // A direction in the plane tilts with the body; its normal does not.
    let in_plane = four_bar("spherical", ", limits = { articulation = { max = 0.7, axis = \"x\" } }", "");
    let [pin] = &ranges(&of_pin, Formulation::Relative)[..] else { panic!("one limit") };
    assert!(pin.crossings.len() > 1);
    for model in [&of_ball, &in_plane] {
        let [ball] = &ranges(model, Formulation::Relative)[..] else { panic!("one limit") };
        assert_eq!(ball.crossings.len(), pin.crossings.len());
        for (a, b) in ball.crossings.iter().zip(&pin.crossings) {
            assert_eq!(a.leaves, b.leaves);
            assert_near(a.time, b.time, EXACT, "time");
            assert!(b.d[0].abs() > 1e-3);
            assert_near(a.d[0], b.d[0], 1e-9, "its derivative");
        }
    }
    let across = four_bar("spherical", ", limits = { articulation = { max = 0.7, axis = \"z\" } }", "");
    let [across] = &ranges(&across, Formulation::Relative)[..] else { panic!("one limit") };
    assert!(across.crossings.is_empty() && across.greatest.value < EXACT, "{across:?}");
}

#[test]
fn the_articulation_of_a_cross_is_the_angle_between_its_shafts() {
    let text = "name = \"cross\"\nunits = { length = \"mm\", angle = \"deg\" }\n[hardpoints]\nA = [0, 0, 0]\n\
        [bodies]\nb = {}\n[joints.cross]\ntype = \"universal\"\nbodies = [\"ground\", \"b\"]\nat = \"A\"\naxis = \"z\"\n\
        axis2 = \"x\"\nlimits.articulation = { max = 25 }\n\
        [drivers]\none = { joint = \"cross\", coordinate = \"angle\", law = \"30*t\" }\n\
        two = { joint = \"cross\", coordinate = \"angle2\", law = \"20*t\" }\n[time]\nend = 1.0\nsteps = 10\n";
    let model = model_of(text);
    let [found] = &ranges(&model, Formulation::Relative)[..] else { panic!("one limit") };
    // cos(articulation) = cos(angle) cos(angle2)
    let at = |t: f64| ((30.0 * t).to_radians().cos() * (20.0 * t).to_radians().cos()).acos();
    let [crossing] = &found.crossings[..] else { panic!("{found:?}") };
    assert_near(at(crossing.time), 25_f64.to_radians(), EXACT, "articulation");
    assert_near(found.greatest.value, at(1.0), EXACT, "greatest");
    assert_near(found.least.value, 0.0, EXACT, "least");
}

#[test]
fn an_end_stop_ends_the_motion_whatever_the_output_times_and_keeps_what_is_before_it() {
    let [time, _] = times_of(CRANK, 0.03);
    for steps in [3, 20, 333] {
        let one = press("mm", "deg", "limits.displacement = { max = 30, stop = true }", steps);
        // A stop that is reached later does not matter, although it is the first in the file.
        let two = one.replace(
            "at = \"A\" }",
            "at = \"A\", limits = { angle = { min = -170, max = 170, stop = true } } }",
        );
        for text in [one, two] {
            let model = model_of(&text);
            for formulation in [Formulation::Relative, Formulation::Absolute] {
                let analysis = Analysis::with(&model, formulation).unwrap();
                let solution = analysis.run();
                let stop = solution.stop.as_ref().unwrap();
                let StopKind::JointLimit { limit, end, begins_beyond } = stop.kind else {
                    panic!("{stop:?}")
                };
                assert_eq!(model.joint_limits[limit].name, "slide.displacement");
                assert_eq!((end, begins_beyond), (LimitEnd::Max, false));
                assert_near(stop.failed_time, time, EXACT, "time");
                let before = model.times.iter().filter(|t| **t <= time).count();
                assert_eq!(solution.motion.len(), before);
                assert_near(stop.last_time.unwrap(), time, EXACT, "end of the motion");
                let free = Model { joint_limits: Vec::new(), ..model.clone() };
                let free = Analysis::with(&free, formulation).unwrap().run();
                for k in 0..before {
                    let [stopped, free] = [&solution, &free].map(|s| s.measured.value(k, 0));
                    for (a, b) in stopped.into_iter().zip(free) {
                        assert_near(a, b, EXACT, "before the stop");
                    }
                }
                // The range ends there as well.
                let found = analysis.joint_limits(&[]);
                assert_near(found[limit].greatest.value, 0.03, EXACT, "greatest");
                assert_near(found[limit].greatest.time, time, EXACT, "its time");
            }
        }
    }
}

#[test]
fn derivatives_at_an_end_stop_follow_the_time_at_which_it_is_reached() {
    let text = press("mm", "deg", "limits.displacement = { max = 30, stop = true }", 20);
    let limits = "limits = { angle = { min = -170 } } }\npin";
    let model = model_of(&text.replace("at = \"O\" }\npin", &format!("at = \"O\", {limits}")));
    let analysis = Analysis::new(&model).unwrap();
    let of = |design: &[f64], name: &str| {
        let k = model.joint_limits.iter().position(|limit| limit.name == name).unwrap();
        analysis.joint_limits(design).remove(k)
    };
    // The stop itself is where it is for all designs.
    assert_eq!(of(&[0.0], "slide.displacement").greatest.d, [0.0]);
    // The crank turns by -pi per second up to there.
    let crank = of(&[0.0], "crank.angle");
    assert_near(crank.least.value, -PI * times_of(CRANK, 0.03)[0], EXACT, "angle at the end");
    let end = |b: f64| -PI * times_of(CRANK + b, 0.03)[0];
    let re_solved = |b: f64| of(&[b], "crank.angle").least.value;
    for (after, before) in [(end(STEP), end(-STEP)), (re_solved(STEP), re_solved(-STEP))] {
        let expected = (after - before) / (2.0 * STEP);
        assert!(expected.abs() > 1.0);
        assert_near(crank.least.d[0], expected, DIFFERENCE * expected.abs(), "angle at the end");
    }
    assert_near(crank.greatest.d[0], 0.0, EXACT, "angle at the start");
    // Metrics are those of the output times, which are fixed.
    let metric = model.metrics.iter().position(|m| m.name == "slide.displacement.max").unwrap();
    let value = |b: f64| metrics(&model, &analysis.solve(Run::new().at(&[b]))).remove(metric);
    let expected = (value(STEP).value.unwrap() - value(-STEP).value.unwrap()) / (2.0 * STEP);
    assert_near(value(0.0).d[0], expected, DIFFERENCE, "metric");
}

#[test]
fn derivatives_at_the_end_of_a_motion_that_is_left_early_are_unknown() {
    // The crank is too long: it is blocked just after a quarter of a turn.
    let text = press("mm", "deg", "limits.displacement = { max = 300 }", 20);
    let limits = "limits = { angle = { min = -170 } } }\npin";
    let text = text.replace("at = \"O\" }\npin", &format!("at = \"O\", {limits}"));
    let model = model_of(&text.replace("O = [0, 0]", "O = [0, -90]"));
    let found = Analysis::new(&model).unwrap().joint_limits(&[]);
    let k = model.joint_limits.iter().position(|limit| limit.name == "crank.angle").unwrap();
    assert!(found[k].least.time > 0.4 && found[k].least.time < 0.6, "{:?}", found[k].least);
    assert!(found[k].least.d[0].is_nan(), "{:?}", found[k].least);
    assert!(found[k].greatest.d[0].is_finite(), "{:?}", found[k].greatest);

    // At an equilibrium, nothing has a rate; but the stop is where it is.
    let model = model_of(
        "name = \"slider\"\nunits = { length = \"mm\", angle = \"deg\" }\nparameters.k = 5\n\
         bodies = { ram = {}, arm = {} }\n[joints]\n\
         slide = { type = \"translational\", bodies = [\"ground\", \"ram\"], at = [0, 0, 0], axis = \"x\", \
         limits = { displacement = { max = 8, stop = true } } }\n\
         arm = { type = \"revolute\", bodies = [\"ground\", \"arm\"], at = [0, 50, 0], axis = \"z\", \
         limits = { angle = { max = 80 } } }\n[drivers]\narm = { joint = \"arm\", law = \"100*t\" }\n\
         [forces]\nspring = { type = \"joint_spring\", joint = \"slide\", stiffness = \"k\" }\n\
         load = { type = \"force\", at = { body = \"ram\", at = [0, 0, 0] }, force = 50, along = \"x\", law = \"t\" }\n\
         [equilibrium]\n[time]\nend = 1\nsteps = 7\n",
    );
    let [slide, arm] = &Analysis::new(&model).unwrap().joint_limits(&[])[..] else { panic!("two limits") };
    assert_near(slide.greatest.time, 0.8, 1e-10, "stop");
    assert_eq!(slide.greatest.d, [0.0]);
    assert_near(arm.greatest.time, 0.8, 1e-10, "stop");
    assert!(arm.greatest.d[0].is_nan(), "{:?}", arm.greatest);
}

#[test]
fn each_of_many_designs_ends_at_its_own_stop() {
    let model = model_of(&press("mm", "deg", "limits.displacement = { max = 30, stop = true }", 50));
    let designs: Vec<Vec<f64>> = (0..20).map(|k| vec![1.5e-3 * (f64::from(k) - 12.0)]).collect();
    let mut ends = vec![None; designs.len()];
    let run = Run::new().without_sensitivities();
    Analysis::new(&model).unwrap().solve_designs(run, &designs, |k, solution| {
        ends[k] = solution.stop.as_ref().map(|stop| stop.failed_time);
    });
    for (design, end) in designs.iter().zip(ends) {
        let radius = CRANK + design[0];
        let start = (ROD * ROD - CRANK * CRANK).sqrt();
        let reach = (start * start + radius * radius).sqrt() + radius - start;
        match end {
            Some(end) => assert_near(end, times_of(radius, 0.03)[0], EXACT, "time"),
            None => assert!(reach < 0.03, "{radius} reaches {reach}"),
        }
    }
    assert!(ends_and_rests(&model, &designs), "some designs reach the limit, and some do not");
}

/// True if some designs have a stop and others have none.
fn ends_and_rests(model: &Model, designs: &[Vec<f64>]) -> bool {
    let analysis = Analysis::new(model).unwrap();
    let stops = designs.iter().map(|d| analysis.solve(Run::new().at(d)).stop.is_some());
    let stops: Vec<bool> = stops.collect();
    stops.contains(&true) && stops.contains(&false)
}

#[test]
fn a_motion_that_begins_beyond_its_stop_solves_nothing_and_reports_the_limit() {
    let model = model_of(&press("mm", "deg", "limits.displacement = { min = 5, max = 30, stop = true }", 20));
    let solution = Analysis::new(&model).unwrap().run();
    let stop = solution.stop.unwrap();
    assert_eq!(stop.kind, StopKind::JointLimit { limit: 0, end: LimitEnd::Min, begins_beyond: true });
    assert_eq!((solution.motion.len(), stop.last_time, stop.code()), (0, None, "HP0267"));
    let text = stop.headline(&model);
    assert_eq!(text, "`slide.displacement` is beyond its minimum at t = 0 s");
}

#[test]
fn a_driver_that_leads_exactly_to_a_limit_does_not_exceed_it() {
    let model = model_of(&press("mm", "deg", "", 20).replace(
        "crank = { type = \"revolute\", bodies = [\"ground\", \"crank\"], at = \"O\" }",
        "crank = { type = \"revolute\", bodies = [\"ground\", \"crank\"], at = \"O\", limits = { angle = { min = -60, max = 60, stop = true } } }",
    ));
    for law in ["pi/3*sin(2*pi*t)", "pi/3*sin(7*t)", "-pi/6*t"] {
        let mut model = model.clone();
        model.drivers[0].law = Law::parse(law).unwrap();
        let analysis = Analysis::new(&model).unwrap();
        let solution = analysis.run();
        assert!(solution.stop.is_none(), "{law}: {:?}", solution.stop);
        let found = analysis.joint_limits(&[]).remove(0);
        assert!(found.crossings.is_empty(), "{law}: {found:?}");
        assert_near(found.least.value, -PI / 3.0, EXACT, law);
    }
}

#[test]
fn a_limit_has_a_measure_and_a_metric_for_each_end() {
    let model = model_of(&press("mm", "deg", "limits.displacement = { min = -25, max = 30 }", 7));
    let limit = &model.joint_limits[0];
    assert_eq!(model.measures[limit.measure].name, "slide.displacement");
    let solution = Analysis::new(&model).unwrap().run();
    let values = metrics(&model, &solution);
    let found = Analysis::new(&model).unwrap().joint_limits(&[]).remove(0);
    for (name, extremum) in [("min", &found.least), ("max", &found.greatest)] {
        let k = model.metrics.iter().position(|m| m.name == format!("slide.displacement.{name}")).unwrap();
        assert_near(values[k].value.unwrap(), extremum.value, 1e-9, name);
        assert_near(values[k].d[0], extremum.d[0], 1e-6, name);
    }
    let one = model_of(&press("mm", "deg", "limits.displacement = { max = 30 }", 7));
    assert_eq!(one.metrics.len(), 1);
}

#[test]
fn limits_of_studies_keep_the_limit_of_a_joint() {
    let text = press("mm", "deg", "limits.displacement = { min = -25, max = 30 }", 7)
        .replace("along = \"y\" }", "along = \"y\", bounds = [-20, 20], tolerance = 0.1 }");
    let text = text
        + "[optimize.goals.stroke]\nmetric = \"slide.displacement.max\"\ntarget = 60\n\
           [optimize.limits.ram]\njoint = \"slide.displacement\"\n\
           [tolerance.limits.ram]\njoint = \"slide.displacement\"\n";
    let file = parse(&text, "limits.toml").unwrap_or_else(|e| panic!("{e}"));
    let model = &file.model;
    let metric = |name: &str| LimitTarget::Metric(model.metrics.iter().position(|m| m.name == name).unwrap());
    for limits in [&model.optimization.as_ref().unwrap().limits, &model.tolerancing.as_ref().unwrap().limits]
    {
        let [min, max] = &limits[..] else { panic!("{limits:?}") };
        assert_eq!((min.name.as_str(), min.of), ("ram.min", metric("slide.displacement.min")));
        assert_eq!((max.name.as_str(), max.of), ("ram.max", metric("slide.displacement.max")));
        assert_near(min.least.unwrap(), -0.025, EXACT, "min");
        assert_near(max.most.unwrap(), 0.03, EXACT, "max");
        assert_eq!((min.most, max.least), (None, None));
    }
    // The largest crank that keeps both: the ram moves by r + l - x and by x + r - l.
    let found = crate::searches::searched(&file, model.optimization.as_ref().unwrap());
    let best = crate::searches::best(&found).found.as_ref().unwrap();
    let found = Analysis::new(model).unwrap().joint_limits(&best.design).remove(0);
    let within = 1e-7;
    assert!(found.greatest.value <= 0.03 + within && found.least.value >= -0.025 - within, "{found:?}");
    assert!(found.greatest.value > 0.03 - within || found.least.value < -0.025 + within, "{found:?}");
}

#[test]
fn the_other_side_of_a_mirror_has_the_image_of_a_limit() {
    let text = "name = \"sides\"\nunits = { length = \"mm\", angle = \"deg\" }\n[mirror]\nacross = \"y\"\n\
        [hardpoints]\nleft_A = [0, 100, 0]\n[bodies]\nleft_b = {}\nleft_c = {}\n\
        [joints.left_tube]\ntype = \"cylindrical\"\nbodies = [\"ground\", \"left_b\"]\nat = \"left_A\"\naxis = \"x\"\n\
        limits = { angle = { min = -10, max = 20, stop = true }, displacement = { min = -3, max = \"2+3\" } }\n\
        [joints.left_hinge]\ntype = \"revolute\"\nbodies = [\"left_b\", \"left_c\"]\nat = \"left_A\"\naxis = \"y\"\n\
        limits.angle = { max = 7 }\n\
        [drivers]\nleft_turn = { joint = \"left_tube\", coordinate = \"angle\", law = \"5*t\" }\n\
        left_slide = { joint = \"left_tube\", coordinate = \"displacement\", law = \"5*t\" }\n\
        left_fold = { joint = \"left_hinge\", law = \"5*t\" }\n[time]\nend = 1.0\nsteps = 4\n";
    let model = model_of(text);
    let of = |name: &str| {
        let limit = model.joint_limits.iter().find(|limit| limit.name == name).unwrap();
        let is_angle = name.ends_with("angle");
        let shown = |x: f64| (if is_angle { x.to_degrees() } else { x * 1e3 } * 1e9).round() / 1e9;
        (limit.min.map(shown), limit.max.map(shown), limit.stop)
    };
    // An angle about what it slides along is the opposite in the mirror; an angle about a hinge is not.
    assert_eq!(of("left_tube.angle"), (Some(-10.0), Some(20.0), true));
    assert_eq!(of("right_tube.angle"), (Some(-20.0), Some(10.0), true));
    assert_eq!(of("right_tube.displacement"), (Some(-3.0), Some(5.0), false));
    assert_eq!(of("right_hinge.angle"), (None, Some(7.0), false));
    let solution = Analysis::new(&model).unwrap().run();
    assert!(solution.stop.is_none());
    let value = |name: &str| solution.measured.value(4, solution.measured.index(name).unwrap())[0];
    assert_near(value("right_tube.angle"), -value("left_tube.angle"), EXACT, "angle");
}

#[test]
fn an_included_part_has_the_limits_of_its_joints() {
    let folder = tempfile::tempdir().unwrap();
    let part = "units = { length = \"mm\", angle = \"deg\" }\n[bodies]\nangle = {}\n[joints.hinge]\ntype = \"revolute\"\n\
        bodies = [\"ground\", \"angle\"]\nat = [0, 0, 0]\naxis = \"z\"\nlimits.angle = { max = 30 }\n\
        [drivers]\nturn = { joint = \"hinge\", law = \"40*t\" }\n";
    std::fs::write(folder.path().join("part.toml"), part).unwrap();
    let text = "name = \"whole\"\ninclude = [{ file = \"part.toml\", prefix = \"a_\" }, { file = \"part.toml\", prefix = \"b_\" }]\n\
        units = { length = \"mm\", angle = \"deg\" }\n[time]\nend = 1.0\nsteps = 4\n";
    let path = folder.path().join("whole.toml");
    std::fs::write(&path, text).unwrap();
    let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
    let names: Vec<&str> = model.joint_limits.iter().map(|limit| limit.name.as_str()).collect();
    assert_eq!(names, ["a_hinge.angle", "b_hinge.angle"]);
    for found in ranges(&model, Formulation::Relative) {
        assert_near(found.crossings[0].time, 0.75, EXACT, "time");
    }
}

#[test]
fn faults_of_limits_are_reported_with_a_remedy() {
    let of = |limits: &str| {
        let found = codes(&press("mm", "deg", limits, 5));
        assert_eq!(found.len(), 1, "{limits}: {found:?}");
        found.into_iter().next().unwrap()
    };
    let (code, message, help) = of("limits.travel = { max = 3 }");
    assert_eq!((code, message.as_str()), ("HP0265", "joint `slide` has no coordinate `travel` to limit"));
    assert_eq!(help.unwrap(), "limit `displacement`");
    let (_, _, help) = of("limits.displacment = { max = 3 }");
    assert_eq!(help.unwrap(), "did you mean `displacement`?");
    let (code, message, _) = of("limits.articulation = { max = 3 }");
    assert_eq!(
        (code, message.as_str()),
        ("HP0265", "the axis of joint `slide` does not tilt: it has no articulation")
    );
    assert_eq!(of("limits.displacement = { min = 3, max = 2 }").0, "HP0266");
    assert_eq!(of("limits.displacement = { min = 3, max = 3 }").0, "HP0266");
    assert_eq!(of("limits.displacement = {}").0, "HP0266");
    let ball = FOUR_BAR.replace("PIN", "spherical").replace("LIMIT_D", "");
    let ball =
        |limit: &str| codes(&ball.replace("LIMIT_C", &format!(", limits = {{ articulation = {limit} }}")));
    assert!(ball("{ max = 0.1 }").is_empty());
    assert_eq!(
        (ball("{ max = -0.1 }")[0].0, ball("{ max = -0.1 }")[0].1.as_str()),
        ("HP0266", "limit `C.articulation` has no range: an articulation is never below zero")
    );
    assert_eq!(of("limits.displacement = { max = \"far\" }").0, "HP0105");
    assert_eq!(of("limits.displacement = { max = nan }").0, "HP0109");
    assert_eq!(of("limits.displacement = 30").0, "HP0105");
    assert_eq!(of("limits.displacement = { max = 3, axis = \"x\" }").0, "HP0107");
    assert_eq!(of("limits.displacement = { maximum = 3 }").0, "HP0103");
    // A limit of a study that no joint has.
    let text = press("mm", "deg", "limits.displacement = { max = 3 }", 5)
        .replace("along = \"y\" }", "along = \"y\", bounds = [-20, 20] }");
    let text = text
        + "[optimize.goals.g]\nmetric = \"slide.displacement.max\"\n[optimize.limits.a]\njoint = \"slide.displacment\"\n";
    let found = codes(&text);
    assert_eq!((found.len(), found[0].0), (1, "HP0204"), "{found:?}");
    assert_eq!(found[0].2.as_deref(), Some("did you mean `slide.displacement`?"));
}

#[test]
fn a_spring_in_equilibrium_reaches_its_limit_where_the_moments_balance() {
    let text = "name = \"sag\"\nunits = { length = \"mm\", angle = \"deg\" }\n[hardpoints]\nA = [0, 0, 0]\n[bodies]\narm = {}\n\
        [joints.hinge]\ntype = \"revolute\"\nbodies = [\"ground\", \"arm\"]\nat = \"A\"\naxis = \"y\"\n\
        limits.angle = { max = 12 }\n[drivers]\nturn = { joint = \"hinge\", law = 0 }\n\
        [forces]\nspring = { type = \"torsion_spring\", joint = \"hinge\", stiffness = 1 }\n\
        pull = { type = \"force\", at = { body = \"arm\", at = [100, 0, 0] }, force = 200, along = \"-z\", law = \"t\" }\n\
        [equilibrium]\nreleased = [\"turn\"]\n[time]\nend = 1\nsteps = 5\n";
    // k angle = F t L cos(angle); an equilibrium has no rates, so that the time is narrowed by bisection.
    let time = 12.0 / (200.0 * 0.1 * 12_f64.to_radians().cos());
    let [found] = &ranges(&model_of(text), Formulation::Relative)[..] else { panic!("one limit") };
    let [crossing] = &found.crossings[..] else { panic!("{found:?}") };
    assert_near(crossing.time, time, 1e-10, "time");
    let stops = model_of(&text.replace("max = 12", "max = 12, stop = true"));
    let solution = Analysis::new(&stops).unwrap().run();
    assert_near(solution.stop.unwrap().failed_time, time, 1e-10, "stop");
    assert_eq!(solution.motion.len(), 4);
}

/// A slider in equilibrium that is displaced by `10 sin(pi t)` mm, by a driver or by a force on a spring, with a limit
/// at 8 mm.
fn slider_at_rest(by_force: bool, stop: bool, times: &str) -> Model {
    let moved = if by_force {
        "spring = { type = \"joint_spring\", joint = \"slide\", stiffness = 5 }\n\
         load = { type = \"force\", at = { body = \"ram\", at = [0, 0, 0] }, force = 50, along = \"x\", law = \"sin(pi*t)\" }"
    } else {
        "end = { type = \"elastic_joint\", joint = \"end\", x = 10 }\n\
         [drivers]\nram = { joint = \"slide\", law = \"10*sin(pi*t)\" }"
    };
    model_of(&format!(
        "name = \"slider\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\n\
         [bodies]\nram = {{}}\ntip = {{}}\n\
         [joints]\nslide = {{ type = \"translational\", bodies = [\"ground\", \"ram\"], at = [0, 0, 0], axis = \"x\", \
         limits = {{ displacement = {{ max = 8, stop = {stop} }} }} }}\n\
         end = {{ type = \"fixed\", bodies = [\"ram\", \"tip\"], at = [0, 0, 0] }}\n\
         [forces]\n{moved}\n[equilibrium]\n[time]\n{times}\n"
    ))
}

#[test]
fn limits_of_equilibria_are_located_between_output_times() {
    let leaves = 0.8_f64.asin() / PI;
    // Without rates a crossing is as exact as the motion is near it, and an extremum to the square of that.
    let (time, value) = (2e-11, 1e-13);
    for by_force in [true, false] {
        for times in ["at = [0, 1]", "at = [0, 0.5, 1]", "at = [0, 0.1, 0.9, 1]", "end = 1\nsteps = 7"] {
            let what = format!("force: {by_force}, {times}");
            let model = slider_at_rest(by_force, false, times);
            let analysis = Analysis::new(&model).unwrap();
            let [found] = &analysis.joint_limits(&[])[..] else { panic!("one limit") };
            let crossings: Vec<_> = found.crossings.iter().map(|c| (c.end, c.leaves)).collect();
            assert_eq!(crossings, [(LimitEnd::Max, true), (LimitEnd::Max, false)], "{what}");
            assert_near(found.crossings[0].time, leaves, time, &what);
            assert_near(found.crossings[1].time, 1.0 - leaves, time, &what);
            assert_near(found.greatest.value, 0.01, value, &what);
            assert_near(found.greatest.time, 0.5, 1e-6, &what);
            let solution = analysis.run();
            assert!(solution.stop.is_none());
            let metric = &metrics(&model, &solution)[0];
            let error = metric.error.unwrap_or(value);
            assert_near(metric.value.unwrap(), 0.01, error, &format!("metric, {what}"));

            let model = slider_at_rest(by_force, true, times);
            let analysis = Analysis::new(&model).unwrap();
            let stop = analysis.run().stop.unwrap_or_else(|| panic!("{what}"));
            let kind = StopKind::JointLimit { limit: 0, end: LimitEnd::Max, begins_beyond: false };
            assert_eq!(stop.kind, kind, "{what}");
            assert_near(stop.failed_time, leaves, time, &what);
            let [found] = &analysis.joint_limits(&[])[..] else { panic!("one limit") };
            assert_near(found.greatest.value, 0.008, 1e-12, &what);
        }
    }
}

#[test]
fn a_limit_of_an_equilibrium_that_is_hardly_exceeded_is_found() {
    // The peak of 10 mm is 1e-4 mm beyond the limit, at a time that no division of the motion meets.
    let text = |max: f64| {
        format!(
            "name = \"slider\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\n[bodies]\nram = {{}}\n\
             [joints]\nslide = {{ type = \"translational\", bodies = [\"ground\", \"ram\"], at = [0, 0, 0], axis = \"x\", \
             limits = {{ displacement = {{ max = {max} }} }} }}\n\
             [forces]\nspring = {{ type = \"joint_spring\", joint = \"slide\", stiffness = 5 }}\n\
             load = {{ type = \"force\", at = {{ body = \"ram\", at = [0, 0, 0] }}, force = 50, along = \"x\", \
             law = \"sin(pi*t/0.77)\" }}\n[equilibrium]\n[time]\nat = [0, 1]\n"
        )
    };
    let ratio = 0.99999_f64;
    let leaves = 0.77 * ratio.asin() / PI;
    let model = model_of(&text(10.0 * ratio));
    let [found] = &ranges(&model, Formulation::Relative)[..] else { panic!("one limit") };
    let times: Vec<f64> = found.crossings.iter().map(|c| c.time).collect();
    assert_eq!(times.len(), 2, "{found:?}");
    // The rate is small there.
    assert_near(times[0], leaves, 1e-9, "leaves");
    assert_near(times[1], 0.77 - leaves, 1e-9, "returns");
    let model = model_of(&text(10.0001));
    let [found] = &ranges(&model, Formulation::Relative)[..] else { panic!("one limit") };
    assert_eq!(found.crossings, []);
}

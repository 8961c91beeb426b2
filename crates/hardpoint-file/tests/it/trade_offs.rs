//! Trade-offs: fronts with closed forms, and the first-order condition of every point.

use std::num::NonZero;
use std::ops::ControlFlow;

use hardpoint::topology::Formulation;
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::optimize::{self, optimize};
use hardpoint_study::trade_off::{FrontPoint, ON_FRONT, Outcome, Overrides, Request, TradeOff, trade_off};
use hardpoint_study::{Control, Motions};

/// A point on a plate that turns, moved in the plane by two variables, at distances from points above the plane.
const PLATE: &str = r#"
name = "plate"
units = { length = "mm", angle = "deg" }
hardpoints = { O = [0, 0, 0], P = [30, 60, 0], A = [0, 0, 20], B = [100, 0, 20], C = [0, 80, 20] }
bodies = { plate = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "plate"], at = "O", axis = "z" }
drivers.motor = { joint = "pivot", law = "10*t" }
design.P_x = { move = "P", along = "x", bounds = [-200, 200] }
design.P_y = { move = "P", along = "y", bounds = [-200, 200] }
points.P = { body = "plate", at = "P" }
points.A = { body = "ground", at = "A" }
points.B = { body = "ground", at = "B" }
points.C = { body = "ground", at = "C" }
measures.a = { type = "distance", from = "A", to = "P" }
measures.b = { type = "distance", from = "B", to = "P" }
measures.c = { type = "distance", from = "C", to = "P" }
metrics.to_a = { of = "a", take = "value", at = 0 }
metrics.to_b = { of = "b", take = "value", at = 0 }
metrics.to_c = { of = "c", take = "value", at = 0 }
metrics.most_a = { of = "a", take = "max" }
metrics.most_b = { of = "b", take = "max" }
metrics.far = { of = "b", take = "rms" }
metrics.x = { of = "P.x", take = "value", at = 0 }
metrics.y = { of = "P.y", take = "value", at = 0 }
time = { end = 1, steps = 2 }
"#;

/// Height of A, B and C above the plate, m.
const HEIGHT: f64 = 0.02;
/// Distance of A and B, m.
const APART: f64 = 0.1;
/// Closed forms hold to this distance, m: goals are found to the square root of their residual at most.
const EXACT: f64 = 1e-7;
/// Ends of fronts of different numbers of points are the same to this part of their ranges.
const SAME_END: f64 = 1e-5;
/// Radius of the circle outside which the point must be, m.
const RADIUS: f64 = 0.05;

fn file(text: &str) -> ModelFile {
    parse(text, "plate.toml").unwrap_or_else(|e| panic!("{e}"))
}

fn traded(file: &ModelFile, points: Option<usize>) -> TradeOff {
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let request = Request::of(&file.model, Overrides { points, ..Overrides::default() }).unwrap();
    let control = Control {
        threads: NonZero::<usize>::MIN,
        progress: &mut |_| ControlFlow::Continue(()),
        more: &|| true,
    };
    trade_off(&file.model, &motions, &request, control)
}

pub(crate) fn plate(optimize: &str) -> ModelFile {
    file(&format!("{PLATE}[optimize]\n{optimize}\n"))
}

/// Checks what every front must have: points in order, none dominated, all with the first-order condition and limits.
fn check(found: &TradeOff) {
    assert_eq!((found.outcome, found.failed), (Outcome::Front, 0));
    for p in &found.points {
        assert!(p.residual < ON_FRONT, "{:?}: {:e}", p.values, p.residual);
        assert!(p.assessment.violation <= optimize::LIMIT_KEPT, "{:?}", p.assessment);
        assert!((p.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{:?}", p.weights);
        let better = |q: &FrontPoint| p.values.iter().zip(&q.values).all(|(a, b)| *b < *a);
        assert!(!found.points.iter().any(better), "{:?} is dominated", p.values);
    }
    assert!(found.points.windows(2).all(|w| w[0].values[0] <= w[1].values[0]));
}

/// Largest gap between neighbours, relative to the smallest.
fn unevenness(found: &TradeOff) -> f64 {
    let gap = |w: &[FrontPoint]| (w[0].values[0] - w[1].values[0]).hypot(w[0].values[1] - w[1].values[1]);
    let gaps: Vec<f64> = found.points.windows(2).map(gap).collect();
    gaps.iter().copied().fold(0.0, f64::max) / gaps.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Area that points dominate, below a reference.
fn dominated_area(mut points: Vec<[f64; 2]>, [x, y]: [f64; 2]) -> f64 {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let ends = points.iter().skip(1).map(|p| p[0]).chain([x]);
    points.iter().zip(ends).map(|(p, end)| (end - p[0]) * (y - p[1])).sum()
}

#[test]
fn the_compromises_between_two_distances_are_a_segment() {
    let found = traded(&plate("goals = { to_a = {}, to_b = {} }"), None);
    check(&found);
    assert_eq!(found.points.len(), Request::POINTS_OF_TWO);
    // In the plane the distances from both ends of the segment add up to its length.
    let in_plane = |d: f64| (d * d - HEIGHT * HEIGHT).max(0.0).sqrt();
    for p in &found.points {
        let sum: f64 = p.values.iter().map(|d| in_plane(*d)).sum();
        assert!((sum - APART).abs() < EXACT, "{:?}: {sum}", p.values);
        // d b / d a of the closed form, at all points but the ends.
        if p.anchor.is_none() {
            let [s, r] = [in_plane(p.values[0]), in_plane(p.values[1])];
            let rate = -(r / p.values[1]) / (s / p.values[0]);
            assert!((p.rates[1].unwrap() / rate - 1.0).abs() < 1e-5, "{:?} {rate}", p.rates);
        }
    }
    assert_eq!([&found.points[0], &found.points[14]].map(|p| p.anchor), [Some(0), Some(1)]);
    // The widest gaps are halved first.
    assert!(unevenness(&found) < 2.5, "{}", unevenness(&found));
    // The balanced compromise is in the middle.
    let balanced = &found.points[found.balanced().unwrap()];
    assert!((balanced.values[0] - balanced.values[1]).abs() < 1e-6, "{:?}", balanced.values);
}

#[test]
fn more_points_dominate_what_a_dense_front_does() {
    let found = traded(&plate("goals = { to_a = {}, to_b = {} }"), Some(60));
    let at = |s: f64| [s.hypot(HEIGHT), (APART - s).hypot(HEIGHT)];
    let corner = [at(APART)[0], at(0.0)[1]];
    let dense = dominated_area((0..=10_000).map(|k| at(APART * f64::from(k) / 1e4)).collect(), corner);
    let area = dominated_area(found.points.iter().map(|p| [p.values[0], p.values[1]]).collect(), corner);
    // Of a staircase under a line a part of 1 / N is lost.
    assert!(area <= dense && area > (1.0 - 2.0 / 60.0) * dense, "{area} of {dense}");
    // Interpolated starts are nearly exact.
    assert!(found.cost.designs - found.anchor_designs < 3 * 60, "{:?}", found.cost);
}

/// Designs of a front of 15 points with 10 variables and two limits: 1 % of the 10,500 with which NSGA-II has the same
/// hypervolume (`docs/trade-off.md`).
const FEW: usize = 105;

#[test]
fn a_front_of_fifteen_points_takes_few_designs() {
    let text = include_str!("../../../../models/studies/wishbone_trade_off.toml");
    let model = parse(text, "wishbone_trade_off.toml").unwrap_or_else(|e| panic!("{e}"));
    let found = traded(&model, Some(15));
    check(&found);
    assert_eq!(found.points.len(), 15);
    assert!(found.cost.designs < FEW, "{} designs", found.cost.designs);
}

/// Designs for the optima of two goals with one iteration each: a step, a design that is tried, and one search.
const ONE_ITERATION: usize = 20;

#[test]
fn the_optima_of_single_goals_take_no_more_than_the_iterations() {
    let text = include_str!("../../../../models/studies/wishbone_trade_off.toml");
    let mut model = parse(text, "wishbone_trade_off.toml").unwrap_or_else(|e| panic!("{e}"));
    model.model.optimization.as_mut().expect("the model has goals").iterations = 1;
    let found = traded(&model, Some(3));
    assert!(found.anchor_designs < ONE_ITERATION, "{} designs", found.anchor_designs);
}

#[test]
fn a_front_that_bulges_towards_worse_designs_is_found_where_weighted_sums_find_its_ends_only() {
    let limits = r#"limits.away = { between = ["O", "P"], min = 50 }
limits.box = { hardpoint = "P", x = [0, 100], y = [0, 100] }"#;
    let found = traded(&plate(&format!("goals = {{ x = {{}}, y = {{}} }}\n{limits}")), None);
    check(&found);
    assert_eq!(found.points.len(), Request::POINTS_OF_TWO);
    let sum = |p: &FrontPoint, weights: &[f64]| p.values.iter().zip(weights).map(|(x, w)| x * w).sum::<f64>();
    for p in &found.points {
        assert!((p.values[0].hypot(p.values[1]) - RADIUS).abs() < EXACT, "{:?}", p.values);
        // With the weights for which the point is stationary, an end is better.
        let ends = [&found.points[0], &found.points[14]].map(|end| sum(end, &p.weights));
        let is_end = p.values.iter().any(|x| *x < 1e-4);
        assert!(
            is_end || ends.into_iter().fold(f64::INFINITY, f64::min) < sum(p, &p.weights),
            "{:?}",
            p.values
        );
    }
    // The optimum of x alone is any y; the front ends where y is smallest.
    let [first, last] = [&found.points[0], &found.points[14]].map(|p| [p.values[0], p.values[1]]);
    for (end, expected) in [(first, [0.0, RADIUS]), (last, [RADIUS, 0.0])] {
        assert!(end.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4), "{end:?}");
    }
}

#[test]
fn a_jump_of_a_front_is_reported_and_dominated_points_are_removed() {
    // A disc on the circle hides a part of it; what lies behind the disc is worse than the circle beside it.
    let text =
        PLATE.replace("P = [30, 60, 0]", "P = [60, 60, 0], Q = [35.35533905932738, 35.35533905932738, 0]");
    let limits = r#"limits.away = { between = ["O", "P"], min = 50 }
limits.off = { between = ["Q", "P"], min = 10 }
limits.box = { hardpoint = "P", x = [0, 100], y = [0, 100] }"#;
    let found =
        traded(&file(&format!("{text}[optimize]\ngoals = {{ x = {{}}, y = {{}} }}\n{limits}\n")), Some(20));
    check(&found);
    let [[a, b]] = found.jumps[..] else { panic!("{:?}", found.jumps) };
    assert_eq!(b, a + 1);
    for p in &found.points {
        assert!((p.values[0].hypot(p.values[1]) - RADIUS).abs() < EXACT, "{:?}", p.values);
    }
    // The circles meet where the chord is the radius of the disc.
    let half = 2.0 * (0.01 / (2.0 * RADIUS)).asin();
    let angle = |p: &FrontPoint| p.values[0].atan2(p.values[1]);
    let [left, right] = [a, b].map(|k| angle(&found.points[k]) - std::f64::consts::FRAC_PI_4);
    assert!(left <= -half + 1e-6 && right >= half - 1e-6, "{left} {right} {half}");
    assert!(right - left < 2.5 * half, "{left} {right} {half}");
}

#[test]
fn the_compromises_between_three_distances_are_a_triangle() {
    let found = traded(&plate("goals = { to_a = {}, to_b = {}, to_c = {} }"), None);
    check(&found);
    assert_eq!(found.points.len(), Request::POINTS_OF_THREE);
    let mut inside = 0;
    for p in &found.points {
        // P is at (30, 60) mm plus the design; A, B and C are at (0, 0), (100, 0) and (0, 80) mm.
        let [x, y] = [0.03 + p.assessment.design[0], 0.06 + p.assessment.design[1]];
        let parts = [x / 0.1, y / 0.08, 1.0 - x / 0.1 - y / 0.08];
        assert!(parts.iter().all(|part| *part > -1e-6), "{parts:?}");
        inside += usize::from(parts.iter().all(|part| *part > 1e-3));
    }
    assert_eq!(inside, 21, "points inside a triangle of 9 along each side");
}

#[test]
fn units_weights_and_the_order_of_goals_do_not_matter() {
    let designs = |found: &TradeOff| -> Vec<Vec<f64>> {
        found.points.iter().map(|p| p.assessment.design.clone()).collect()
    };
    let goals = "trade_off = [\"to_a\", \"far\"]\ngoals = { to_a = {}, far = {} }";
    let plain = traded(&plate(goals), None);
    check(&plain);
    let plain = designs(&plain);
    let close = |other: &[Vec<f64>]| {
        assert_eq!(plain.len(), other.len());
        for (a, b) in plain.iter().zip(other) {
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6), "{a:?} {b:?}");
        }
    };
    let weighted = "goals = { to_a = { weight = 1000 }, far = { weight = 0.01 } }";
    close(&designs(&traded(&plate(weighted), None)));
    let mut swapped =
        designs(&traded(&plate(&goals.replace("[\"to_a\", \"far\"]", "[\"far\", \"to_a\"]")), None));
    swapped.reverse();
    close(&swapped);
    let metres = "goals = { to_a = {}, far = {} }";
    let metres = format!("{PLATE}[optimize]\n{metres}\n")
        .replace("\"mm\"", "\"cm\"")
        .replace("[30, 60, 0]", "[3, 6, 0]")
        .replace("[0, 0, 20]", "[0, 0, 2]")
        .replace("[100, 0, 20]", "[10, 0, 2]")
        .replace("[0, 80, 20]", "[0, 8, 2]")
        .replace("[-200, 200]", "[-20, 20]");
    close(&designs(&traded(&file(&metres), None)));
}

#[test]
fn goals_on_maxima_have_the_front_that_an_optimisation_under_a_limit_finds() {
    let found = traded(&plate("goals = { most_a = {}, most_b = {} }"), Some(7));
    check(&found);
    for p in &found.points[1..6] {
        let limit = format!(
            "goals = {{ most_a = {{}} }}\nlimits.b = {{ metric = \"most_b\", max = {} }}",
            1000.0 * p.values[1]
        );
        let file = plate(&limit);
        let models = file.model.motions();
        let motions = Motions::of(&models, Formulation::Relative).unwrap();
        let request = optimize::Request::of(&file.model, optimize::Overrides::default()).unwrap();
        let control = Control {
            threads: NonZero::<usize>::MIN,
            progress: &mut |_| ControlFlow::Continue(()),
            more: &|| true,
        };
        let best = optimize(&file.model, &motions, &request, control);
        let least = best.searches[0].found.as_ref().unwrap().goals[0].2;
        assert!((least - p.values[0]).abs() < EXACT, "{least} {:?}", p.values);
    }
}

#[test]
fn goals_with_one_optimum_do_not_conflict() {
    let text = PLATE.replace("time =", "metrics.near_a = { of = \"a\", take = \"rms\" }\ntime =");
    // The distance from a point on the axis is the same at all times.
    let found = traded(&file(&format!("{text}[optimize]\ngoals = {{ to_a = {{}}, near_a = {{}} }}\n")), None);
    assert_eq!(found.outcome, Outcome::NoConflict);
    assert_eq!(found.points.len(), 1);
    assert!((found.points[0].values[0] - HEIGHT).abs() < EXACT, "{:?}", found.points[0].values);
}

#[test]
fn limits_that_no_design_keeps_are_an_outcome() {
    let limits = r#"limits.near = { between = ["O", "P"], max = 10 }
limits.box = { hardpoint = "P", x = [50, 100], y = [0, 100] }"#;
    let found = traded(&plate(&format!("goals = {{ to_a = {{}}, to_b = {{}} }}\n{limits}")), None);
    assert!(
        matches!(found.outcome, Outcome::NoAnchor(0, optimize::Status::LimitsNotKept)),
        "{:?}",
        found.outcome
    );
    assert!(found.points.is_empty());
}

#[test]
fn a_front_reaches_an_optimum_without_gradient() {
    // B is in the plane of the plate: the distance from it has a kink where it vanishes.
    let text = PLATE.replace("B = [100, 0, 20]", "B = [100, 0, 0]");
    let found = traded(&file(&format!("{text}[optimize]\ngoals = {{ to_a = {{}}, to_b = {{}} }}\n")), None);
    check(&found);
    let end = found.points.last().unwrap();
    let loss = end.values[1] / found.points[0].values[1];
    // Zero to round-off is recognised as the least value of a distance.
    assert!(end.anchor == Some(1) && loss < 1e-9, "{loss}");
}

#[test]
fn an_interrupted_study_keeps_its_points() {
    let file = plate("goals = { to_a = {}, to_b = {} }");
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let request = Request::of(&file.model, Overrides::default()).unwrap();
    let mut progress = |p: hardpoint_study::Progress<'_>| match p.done {
        5 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    let control = Control { threads: NonZero::<usize>::MIN, progress: &mut progress, more: &|| true };
    let found = trade_off(&file.model, &motions, &request, control);
    assert_eq!((found.outcome, found.points.len()), (Outcome::Interrupted, 5));
}

/// Two goals, mm, that are formulas of `u` and `v` from 0 to 1.
fn curve(goals: &str) -> ModelFile {
    file(&format!(
        r#"
name = "curve"
units = {{ length = "mm", angle = "rad" }}
parameters.u = {{ value = 0.5, bounds = [0, 1] }}
parameters.v = {{ value = 0.5, bounds = [0, 1] }}
hardpoints = {{ O = [0, 0, 0], F = [{goals}, 0] }}
bodies = {{ plate = {{}} }}
joints.pivot = {{ type = "revolute", bodies = ["ground", "plate"], at = "O", axis = "z" }}
drivers.motor = {{ joint = "pivot", law = "0.001*t" }}
points.F = {{ body = "plate", at = "F" }}
metrics.first = {{ of = "F.x", take = "value", at = 0 }}
metrics.second = {{ of = "F.y", take = "value", at = 0 }}
time = {{ end = 1, steps = 2 }}
[optimize]
goals = {{ first = {{}}, second = {{}} }}
"#
    ))
}

/// Near the optimum of the second goal the first one gains much for next to nothing. A front once ended at this
/// optimum, unless it had enough points for one to be sought near it.
#[test]
fn the_ends_of_a_front_do_not_depend_on_the_number_of_points() {
    let model = curve("\"u + v\", \"(1 - u)^8 + v\"");
    // The second goal is the eighth power of one less the first: it ends with a loss of a thousandth.
    let ends = [[0.0, 1.0], [1.0 - 1e-3_f64.powf(0.125), 1e-3]];
    for points in [3, 5, 15, 60] {
        let found = traded(&model, Some(points));
        check(&found);
        for (p, end) in [&found.points[0], found.points.last().unwrap()].into_iter().zip(ends) {
            let off =
                p.values.iter().zip(end).map(|(value, end)| (1e3 * value - end).abs()).fold(0.0, f64::max);
            assert!(off < SAME_END, "{points} points: {:?} {end:?}", p.values);
        }
    }
}

/// A root at the end of its domain has an infinite slope, which says nothing about the range of the goal: the goals
/// once did "not conflict" because of it.
#[test]
fn a_goal_with_an_infinite_slope_at_an_end_of_the_front_has_its_range() {
    let found = traded(&curve("\"u + v\", \"(1 + 9*v)*(1 - sqrt(u/(1 + 9*v)))\""), None);
    check(&found);
    assert_eq!(found.points.len(), Request::POINTS_OF_TWO);
    for p in &found.points {
        // v = 0: the second goal is one less the root of the first, mm.
        let [first, second] = [p.values[0] * 1e3, p.values[1] * 1e3];
        assert!((second - (1.0 - first.max(0.0).sqrt())).abs() < 1e3 * EXACT, "{first} {second}");
    }
}

#[test]
fn requests_name_two_or_three_known_goals() {
    let file = plate("goals = { to_a = {}, to_b = {}, to_c = {}, far = {} }");
    let refused = |goals: &[&str], points: Option<usize>| {
        let goals = goals.iter().map(|g| (*g).to_owned()).collect();
        let overrides = Overrides { goals, points, ..Overrides::default() };
        Request::of(&file.model, overrides).unwrap_err().to_string()
    };
    for (goals, points, words) in [
        (&[][..], None, "`[optimize]` has 4; name those to trade"),
        (&["to_a", "to_d"][..], None, "there is no goal named `to_d`; did you mean `to_a`?"),
        (&["to_a"][..], None, "1 goal is named"),
        (&["to_a", "to_a"][..], None, "goal `to_a` is named twice"),
        (&["to_a", "to_b"][..], Some(2), "2 designs are too few for a front of 2 goals; give at least 3"),
        (&["to_a", "to_b", "far"][..], Some(5), "give at least 6"),
        (&["to_a", "to_b"][..], Some(100_000), "100000 designs of a front are too many"),
    ] {
        let text = refused(goals, points);
        assert!(text.contains(words), "{text}");
    }
    let of_file = plate("trade_off = [\"far\", \"to_a\"]\ngoals = { to_a = {}, to_b = {}, far = {} }");
    let request = Request::of(&of_file.model, Overrides::default()).unwrap();
    let names: Vec<&str> = request.settings.goals.iter().map(|g| g.name.as_str()).collect();
    assert_eq!((names, request.points), (vec!["far", "to_a"], Request::POINTS_OF_TWO));
}

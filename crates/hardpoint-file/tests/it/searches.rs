//! Optimisations: known designs are found, and every result is an optimum.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::model::{Limit, LimitTarget, OptimizationSettings};
use hardpoint::topology::Formulation;
use hardpoint_file::ModelFile;
use hardpoint_study::optimize::{ActiveConstraint, Optimization, Request, SearchResult, Status, optimize};
use hardpoint_study::{Control, Motions, Progress, StudyCost};

/// Remainder of the gradient at an optimum, relative to that at the start.
const OPTIMAL: f64 = 1e-8;

fn model(name: &str) -> ModelFile {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    hardpoint_file::read(&models.join(name)).unwrap_or_else(|e| panic!("{e}"))
}

fn searched_on(threads: usize, file: &ModelFile, asked: &OptimizationSettings) -> Optimization {
    searched_from(0, threads, file, asked)
}

/// Searches from the starts of these numbers on.
fn searched_from(
    first: usize,
    threads: usize,
    file: &ModelFile,
    asked: &OptimizationSettings,
) -> Optimization {
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let request = Request { settings: asked.clone(), first };
    let control = Control {
        threads: NonZero::new(threads).unwrap(),
        progress: &mut |_| ControlFlow::Continue(()),
        more: &|| true,
    };
    optimize(&file.model, &motions, &request, control)
}

pub(crate) fn searched(file: &ModelFile, asked: &OptimizationSettings) -> Optimization {
    searched_on(1, file, asked)
}

fn asked(file: &ModelFile) -> OptimizationSettings {
    file.model.optimization.clone().expect("the file says what is wanted")
}

pub(crate) fn best(found: &Optimization) -> &SearchResult {
    &found.searches[found.best.expect("something is found")]
}

/// The hardpoints of the four-bar whose motion is given, and how near they are found: parts of the crank's length.
const KNOWN: [[f64; 2]; 4] = [[0.0, 0.0], [0.04, 0.2], [0.36, 0.6], [0.4, 0.0]];
const FOUND: f64 = 1e-6 * 0.204;
/// Number of iterations of the published search, each with at least a motion and its derivatives; its error is 47 mm.
const PUBLISHED: usize = 16;

fn is_known(file: &ModelFile, search: &SearchResult) -> bool {
    let Some(found) = &search.found else { return false };
    let places = file.model.hardpoint_places(&found.design);
    KNOWN.iter().zip(&places).all(|([x, y], p)| (p.x - x).abs() <= FOUND && (p.y - y).abs() <= FOUND)
}

#[test]
fn the_four_bar_of_a_known_motion_is_found() {
    let file = model("four_bar_inverse.toml");
    let found = searched(&file, &asked(&file));
    let search = best(&found);
    assert_eq!(search.status, Status::Optimal);
    assert!(is_known(&file, search), "{:?}", search.found);
    assert!(search.cost.designs < PUBLISHED, "{} designs", search.cost.designs);
    assert!(search.optimality.left_of_start <= OPTIMAL, "{:e}", search.optimality.left_of_start);
    assert!(search.optimality.binding.is_empty(), "{:?}", search.optimality.binding);
    // The work of all variables is the whole change, except for the curvature of the path.
    let objective = |k: usize| search.iterations[k].objective;
    let change = objective(search.iterations.len() - 1) - objective(0);
    assert!((search.work.iter().sum::<f64>() / change - 1.0).abs() < 0.5, "{:?} of {change}", search.work);
}

#[test]
fn it_is_found_from_everywhere_within_the_bounds_on_any_number_of_threads() {
    let file = model("four_bar_inverse.toml");
    let many = OptimizationSettings { starts: 13, ..asked(&file) };
    let found = searched(&file, &many);
    for (k, search) in found.searches.iter().enumerate() {
        assert!(is_known(&file, search), "start {k}: {:?}, {:?}", search.status, search.found);
    }
    // Most linkages within these bounds cannot turn: their starts are drawn nearer until they do.
    assert!(found.searches.iter().any(|s| !s.refused.is_empty()));
    let again = searched_on(3, &file, &many);
    let ends =
        |o: &Optimization| o.searches.iter().map(|s| s.found.clone().unwrap().design).collect::<Vec<_>>();
    assert_eq!(ends(&found), ends(&again));
}

#[test]
fn a_search_that_is_interrupted_keeps_the_best_so_far() {
    let file = model("four_bar_inverse.toml");
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let mut told = 0;
    let mut progress = |_: Progress<'_>| {
        told += 1;
        if told < 4 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let threads = NonZero::<usize>::MIN;
    let control = Control { threads, progress: &mut progress, more: &|| true };
    let request = Request { settings: OptimizationSettings { starts: 3, ..asked(&file) }, first: 0 };
    let found = optimize(&file.model, &motions, &request, control);
    assert!(found.searches.iter().all(|s| s.status == Status::Interrupted));
    let judged = best(&found).found.as_ref().unwrap();
    assert!(judged.objective < 0.1 * found.nominal.unwrap().objective);
}

/// Tolerance between result and target over the whole travel, rad.
const WITHIN: f64 = 0.02 * std::f64::consts::PI / 180.0;

#[test]
fn the_strut_gets_its_toe_curve_and_steers_no_worse() {
    let file = model("studies/strut_toe.toml");
    let asked = asked(&file);
    let found = searched(&file, &asked);
    let search = best(&found);
    assert_eq!(search.status, Status::Optimal);
    assert!(search.cost.designs < 20, "{} designs", search.cost.designs);
    assert!(search.optimality.left_of_start <= OPTIMAL, "{:e}", search.optimality.left_of_start);
    let judged = search.found.as_ref().unwrap();
    assert_eq!(judged.violation, 0.0);
    let drawn = found.nominal.as_ref().unwrap();
    assert!(judged.limits[0].2 > drawn.limits[0].2, "the inner wheel steers no less");
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let solved = motions.evaluate(&judged.design, &mut StudyCost::default(), &|| true).unwrap();
    let (measured, bump) = (&solved.solutions[0].measured, &models[0]);
    let [toe, travel] = ["toe", "wheel_travel"].map(|name| measured.index(name).unwrap());
    for k in 0..measured.len() {
        let wanted = bump.metrics[0].target_at(measured.value(k, travel)[0]).unwrap();
        let off = measured.value(k, toe)[0] - wanted;
        assert!(off.abs() <= WITHIN, "{off} rad at step {k}");
    }
}

/// Maximum numbers of designs for an optimum of a wishbone with ten variables under two limits: of the sum of two
/// norms, and of one that nearly vanishes. Sequential programming takes 18 and 94.
const FEW: [usize; 2] = [12, 50];

#[test]
fn an_optimum_under_limits_takes_few_designs() {
    let file = model("studies/wishbone_trade_off.toml");
    let both = asked(&file);
    let camber = OptimizationSettings { goals: both.goals[1..].to_vec(), ..both.clone() };
    for (settings, few) in [both, camber].iter().zip(FEW) {
        let found = searched(&file, settings);
        let search = best(&found);
        assert_eq!(search.status, Status::Optimal);
        assert!(search.cost.designs < few, "{} designs", search.cost.designs);
    }
}

/// Maximum deviation from the published toe curve, 0.77 deg to either side: root mean square, rad.
const FOLLOWED: f64 = 0.003 * std::f64::consts::PI / 180.0;

#[test]
fn the_front_axle_gets_the_toe_curve_of_a_published_example() {
    let file = model("studies/front_axle_toe.toml");
    let found = searched(&file, &asked(&file));
    let search = best(&found);
    assert_eq!(search.status, Status::Optimal);
    assert!(search.optimality.left_of_start <= OPTIMAL, "{:e}", search.optimality.left_of_start);
    let [drawn, left] = [found.nominal.as_ref(), search.found.as_ref()].map(|j| j.unwrap().goals[0].2);
    assert!(drawn > 500.0 * FOLLOWED && left < FOLLOWED, "{drawn} {left}");
}

/// A limit on the metric of a goal of the strut, in SI.
fn limit(of: LimitTarget, least: Option<f64>, most: Option<f64>) -> Limit {
    Limit { name: "limit".into(), of, least, most }
}

#[test]
fn multipliers_of_active_constraints_are_the_gain_of_relaxing_them() {
    // The multiplier of a limit against two searches with the limit moved either way.
    const MOVED: f64 = 1e-5;
    const AGREES: f64 = 1e-3;
    let file = model("studies/strut_toe.toml");
    let at = |least: f64| {
        let limits = vec![limit(LimitTarget::Metric(1), Some(least), None)];
        searched(&file, &OptimizationSettings { limits, ..asked(&file) })
    };
    let deg = std::f64::consts::PI / 180.0;
    let least = 0.145 * deg;
    let middle = at(least);
    let search = best(&middle);
    assert_eq!(search.status, Status::Optimal, "{:?}", search.iterations);
    let binding = &search.optimality.binding;
    let worth = binding
        .iter()
        .find(|(what, _)| matches!(what, ActiveConstraint::Least(0, Some(1))))
        .expect("it binds")
        .1;
    let objective = |found: &Optimization| best(found).found.as_ref().unwrap().objective;
    let gained =
        (objective(&at(least + MOVED * deg)) - objective(&at(least - MOVED * deg))) / (2.0 * MOVED * deg);
    assert!((gained / worth - 1.0).abs() < AGREES, "{gained} and {worth}");
}

/// The second limit says the same as the first: together they were once called contradictory.
#[test]
fn limits_that_repeat_one_another_are_kept() {
    let file = crate::trade_offs::plate(
        r#"
goals = { x = {}, y = { weight = 3 } }
[optimize.limits]
near = { between = ["O", "P"], equal = 50 }
again = { between = ["P", "O"], equal = 50 }
"#,
    );
    let found = searched(&file, &asked(&file));
    let search = best(&found);
    assert_eq!(search.status, Status::Optimal);
    // Against the direction (1, 3), at 50 mm from the origin.
    let p = file.model.hardpoint_places(&search.found.as_ref().unwrap().design)[1];
    let expected = [-0.05 / 10.0_f64.sqrt(), -0.15 / 10.0_f64.sqrt()];
    assert!((p.x - expected[0]).hypot(p.y - expected[1]) < 1e-7, "{p:?}");
}

/// A four-bar whose rocker is to swing far, which brings it near to its dead points.
fn swinging(margin: f64) -> ModelFile {
    let text = Swinging::default().text(margin);
    hardpoint_file::parse(&text, "rocker.toml").unwrap_or_else(|e| panic!("{e}"))
}

/// Properties of the four-bar that do not matter to its optimum.
#[derive(Debug)]
struct Swinging {
    /// Name of the unit of lengths, and its number in a millimetre.
    length: (&'static str, f64),
    /// Name of the unit of angles, and its number in a degree.
    angle: (&'static str, f64),
    size: f64,
    /// Position of the mechanism along x, mm.
    at: f64,
    steps: usize,
    reversed: bool,
}

impl Default for Swinging {
    fn default() -> Self {
        Self { length: ("mm", 1.0), angle: ("deg", 1.0), size: 1.0, at: 0.0, steps: 72, reversed: false }
    }
}

impl Swinging {
    fn text(&self, margin: f64) -> String {
        let Self { length: (length, mm), angle: (angle, deg), size, at, steps, reversed } = *self;
        let by = |mm_of_base: f64| mm_of_base * size * mm;
        let point = |x: f64, y: f64| format!("[{:?}, {:?}]", by(x) + at * mm, by(y));
        let variable = |name: &str, of: &str, along: &str, [low, high]: [f64; 2]| {
            let bounds = [by(low), by(high)];
            format!("{name} = {{ move = \"{of}\", along = \"{along}\", bounds = {bounds:?} }}\n")
        };
        let mut variables = [
            variable("B_x", "B", "x", [-15.0, 40.0]),
            variable("C_x", "C", "x", [-40.0, 40.0]),
            variable("C_y", "C", "y", [-40.0, 40.0]),
        ];
        if reversed {
            variables.reverse();
        }
        format!(
            r#"
name = "rocker"
units = {{ length = "{length}", angle = "{angle}" }}
planar = "xy"
hardpoints = {{ A = {}, B = {}, C = {}, D = {} }}
bodies = {{ ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C"], rocker = ["C", "D"] }}
drivers.motor = {{ joint = "A", law = "{:?}*t" }}
points.c = {{ body = "rocker", at = "C" }}
measures.rocker = {{ type = "coordinate", joint = "D" }}
time = {{ end = 1, steps = {steps} }}

[design]
{}
[metrics]
swing = {{ of = "rocker", take = "range" }}
height = {{ of = "c.y", take = "value", at = 0 }}

[optimize]
min_margin = {margin}

[optimize.goals]
swing = {{ target = {:?}, weight = {:?} }}
height = {{ target = {:?}, weight = {:?} }}
"#,
            point(0.0, 0.0),
            point(30.0, 0.0),
            point(60.0, 80.0),
            point(100.0, 0.0),
            360.0 * deg,
            variables.concat(),
            110.0 * deg,
            1.0 / deg,
            by(60.0),
            0.5 / by(1.0),
        )
    }
}

/// The margin as a limit: kept to round-off, with the multiplier of two searches with the limit moved either way.
#[test]
fn a_search_moves_along_the_margin_to_its_optimum() {
    const MOVED: f64 = 1e-4;
    const AGREES: f64 = 1e-4;
    let at = |margin: f64| {
        let file = swinging(margin);
        searched(&file, &asked(&file))
    };
    let [less, middle, more] = [0.15 - MOVED, 0.15, 0.15 + MOVED].map(at);
    let search = best(&middle);
    assert_eq!(search.status, Status::Optimal, "{:?}", search.iterations);
    let margin = search.found.as_ref().unwrap().margin.unwrap();
    assert!((margin - 0.15).abs() < 1e-8, "{margin}");
    let binding = &search.optimality.binding;
    let is_margin = |what: &ActiveConstraint| matches!(what, ActiveConstraint::Least(0, Some(0)));
    let worth = binding.iter().find(|(what, _)| is_margin(what)).expect("the margin binds").1;
    let objective = |found: &Optimization| best(found).found.as_ref().unwrap().objective;
    let gained = (objective(&more) - objective(&less)) / (2.0 * MOVED);
    assert!((gained / worth - 1.0).abs() < AGREES, "{gained} and {worth}");
}

/// Units, size, position, order and twice the output times do not matter to an optimum along the margin.
#[test]
fn an_optimum_along_the_margin_is_that_of_the_mechanism() {
    // Of the size: the optimum is flat along the limit. The least margin is at an output time of all variants.
    const SAME: f64 = 1e-7;
    let of = || Swinging::default();
    let variants = [
        of(),
        Swinging { length: ("m", 1e-3), ..of() },
        Swinging { angle: ("rad", 1.0_f64.to_radians()), ..of() },
        Swinging { size: 1000.0, ..of() },
        Swinging { size: 1e-3, ..of() },
        Swinging { at: 1000.0, ..of() },
        Swinging { reversed: true, ..of() },
        Swinging { steps: 144, ..of() },
    ];
    let mut first: Option<Vec<f64>> = None;
    for variant in variants {
        let file =
            hardpoint_file::parse(&variant.text(0.15), "rocker.toml").unwrap_or_else(|e| panic!("{e}"));
        let found = searched(&file, &asked(&file));
        let search = best(&found);
        assert_eq!(search.status, Status::Optimal);
        let design = &search.found.as_ref().unwrap().design;
        let value = |name: &str| design[file.model.variable(name).unwrap().0] / (0.001 * variant.size);
        let design: Vec<f64> = ["B_x", "C_x", "C_y"].map(value).into();
        let expected = first.get_or_insert_with(|| design.clone());
        for (a, b) in design.iter().zip(expected) {
            assert!((a - *b).abs() < SAME * 100.0, "{design:?} {variant:?}");
        }
    }
}

#[test]
fn contradictory_limits_and_designs_that_lock_are_reported() {
    let file = model("studies/strut_toe.toml");
    let far =
        OptimizationSettings { limits: vec![limit(LimitTarget::Metric(1), Some(0.5), None)], ..asked(&file) };
    let found = searched(&file, &far);
    assert_eq!(best(&found).status, Status::LimitsNotKept);
    assert!(best(&found).found.as_ref().unwrap().violation > 0.0);
    // No design keeps so far from singular positions.
    let file = model("four_bar_inverse.toml");
    let limits = vec![limit(LimitTarget::Margin, Some(0.99), None)];
    let found = searched(&file, &OptimizationSettings { limits, ..asked(&file) });
    assert_eq!(best(&found).status, Status::LimitsNotKept);
}

/// A restart from an optimum gains less than this part of the objective.
const GAINED: f64 = 1e-3;

#[test]
fn a_restart_from_a_claimed_optimum_gains_nothing() {
    for name in ["synthesis/arc_five_points.toml", "four_bar_inverse.toml"] {
        let file = model(name);
        let wanted = OptimizationSettings { starts: 1, ..asked(&file) };
        let found = searched(&file, &wanted);
        let search = best(&found);
        assert_eq!(search.status, Status::Optimal, "{name}");
        let judged = search.found.as_ref().unwrap();
        let again = hardpoint_file::parse(&file.edit(&judged.design).unwrap(), name);
        // Files beside the model are not there: only what needs none is searched again.
        let Ok(again) = again else { continue };
        let restarted = searched(&again, &OptimizationSettings { starts: 1, ..asked(&again) });
        let after = best(&restarted).found.as_ref().unwrap().objective;
        let is_met = search.optimality.met || judged.objective - after <= GAINED * judged.objective;
        assert!(is_met, "{name}: {:e} {after:e}", judged.objective);
    }
    let known = model("four_bar_inverse.toml");
    let found = searched(&known, &asked(&known));
    assert!(best(&found).optimality.met, "the known four-bar leaves no misfit");
}

#[test]
fn no_start_of_a_published_problem_ends_at_a_false_optimum() {
    // These two starts lead into a long valley in which the error falls from 8e-5 to 7e-7: the gradient along it is
    // 1e-9 of that at the start of the search.
    let file = model("synthesis/arc_five_points.toml");
    let found = searched_from(5, 1, &file, &OptimizationSettings { starts: 2, ..asked(&file) });
    for search in found.searches.iter().filter(|s| s.status == Status::Optimal) {
        let judged = search.found.as_ref().unwrap();
        let again = hardpoint_file::parse(&file.edit(&judged.design).unwrap(), "again.toml").unwrap();
        let restarted = searched(&again, &OptimizationSettings { starts: 1, ..asked(&again) });
        let after = best(&restarted).found.as_ref().unwrap().objective;
        assert!(judged.objective - after <= GAINED * judged.objective, "{:e} {after:e}", judged.objective);
    }
    // With enough iterations, the end of the valley is reached.
    let least = best(&found).found.as_ref().unwrap().objective;
    assert!(best(&found).status == Status::Optimal && least < 1e-6, "{least:e}");
}

/// Misfits of a path of 25 mm that are round-off, mm^2.
const MET: f64 = 1e-18;

#[test]
fn goals_that_can_all_be_met_are_met_along_limits() {
    // Five angles of the crank are free: the coupler point passes through six points of a line exactly, with Grashof's
    // condition as a limit. The misfits lie in a valley whose width is 1e-6 of its length.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models/line_six_points.toml");
    let file = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}"));
    let found = searched(&file, &asked(&file));
    let search = best(&found);
    let judged = search.found.as_ref().unwrap();
    assert_eq!(search.status, Status::Optimal);
    assert!(search.optimality.met && judged.objective < MET, "{:e}", judged.objective);
    assert!(judged.violation <= 1e-8, "{:e}", judged.violation);
    assert!(search.cost.designs < 300, "{} designs", search.cost.designs);
    // A search with fewer iterations does not claim an optimum.
    let early = searched(&file, &OptimizationSettings { iterations: 60, ..asked(&file) });
    assert_eq!(best(&early).status, Status::IterationLimit, "{:?}", best(&early).found);
}

#[test]
fn a_metric_at_a_single_output_time_has_its_value_and_is_searched() {
    let text = r#"
name = "crank at one time"
units = { length = "mm", angle = "deg" }
planar = "xy"
parameters = { reach = { value = 20, unit = "length", bounds = [10, 40] } }
hardpoints = { O = [0, 0], A = ["reach", 0] }
bodies = { crank = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O" }
drivers.motor = { joint = "pivot", law = "30 + 10*t" }
points.A = { body = "crank", at = "A" }
measures.turn = { type = "coordinate", joint = "pivot" }
time = { at = [0] }
[metrics]
high = { of = "A.y", take = "value", at = 0 }
high_over = { of = "A.y", over = "turn", take = "value", at = 30 }
rise = { of = "A.y", over = "turn", take = "slope", at = 30 }
elsewhere = { of = "A.y", take = "value", at = 1 }
[optimize.goals]
high = { target = 15 }
"#;
    let file = hardpoint_file::parse(text, "single.toml").unwrap_or_else(|e| panic!("{e}"));
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let values = motions.evaluate(&[], &mut StudyCost::default(), &|| true).unwrap().metrics.swap_remove(0);
    let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12, "{a} {b}");
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    near(values[0].value.unwrap(), 0.02 * sin);
    near(values[0].d[0], sin);
    near(values[1].value.unwrap(), 0.02 * sin);
    near(values[1].d[0], sin);
    // dy/dangle = r cos, in m per rad
    near(values[2].value.unwrap(), 0.02 * cos);
    assert!(values[3].value.is_none(), "there is no output time at 1 s");
    let found = searched(&file, &asked(&file));
    let judged = best(&found).found.as_ref().unwrap();
    assert_eq!(best(&found).status, Status::Optimal);
    near(judged.design[0], 0.03 - 0.02);
}

/// Goals whose gradient jumps at their optimum; a narrow valley, whose gradients only change fast, has none.
#[test]
fn optima_at_corners_of_goals_are_recognised() {
    let text = r#"
name = "corner"
units = { length = "m", angle = "deg" }
planar = "xy"
hardpoints = { O = [0, 0], C = [0.4, 0.7] }
bodies.arm = ["C"]
joints.pivot = { type = "revolute", bodies = ["ground", "arm"], at = "O" }
drivers.motor = { joint = "pivot", law = "0" }
points.C = { body = "arm", at = "C" }
measures.f = { type = "expression", expression = "GOAL" }
metrics.goal = { of = "f", take = "value", at = 0 }
design.x = { move = "C", along = "x", bounds = [-1, 4] }
design.y = { move = "C", along = "y", bounds = [-2, 2] }
optimize = { starts = 4, goals = { goal = {} } }
time = { end = 1, steps = 2 }
"#;
    // 2 (x - 1) = 3 - x
    let sharp = ("max(2*(C.x - 1), 3 - C.x) + abs(C.y - 0.25) + 1.5", [5.0 / 3.0, 0.25], true);
    // A corner in one direction alone.
    let edge = ("abs(C.x - 1) + (C.y - C.x)^2 + 0.5", [1.0, 1.0], true);
    let valley = ("1e4*(C.y - C.x^2)^2 + (C.x - 0.5)^2 + 1", [0.5, 0.25], false);
    for (goal, place, is_corner) in [sharp, edge, valley] {
        let file = hardpoint_file::parse(&text.replace("GOAL", goal), "corner.toml")
            .unwrap_or_else(|e| panic!("{e}"));
        for search in searched(&file, &asked(&file)).searches {
            assert_eq!(search.optimality.is_corner, is_corner, "{goal}");
            // One search makes no further progress in the valley.
            assert!(
                search.status == Status::Optimal || !is_corner && search.status == Status::Stuck,
                "{goal}"
            );
            if search.status == Status::Stuck {
                continue;
            }
            let design = search.found.unwrap().design;
            for (k, nominal) in [0.4, 0.7].into_iter().enumerate() {
                let found = nominal + design[k];
                assert!((found - place[k]).abs() < 1e-6, "{goal}: {found} instead of {}", place[k]);
            }
        }
    }
}

/// A point that may be at either side of an axis: two optima, each with the starts that ended in it.
#[test]
fn searches_that_end_in_two_optima_are_gathered() {
    let text = r#"
name = "two sides"
units = { length = "mm", angle = "deg" }
parameters.a = { value = 10, bounds = [-100, 100] }
hardpoints = { O = [0, 0, 0], P = ["a", 20, 0] }
bodies.crank = {}
joints.pin = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
drivers.motor = { joint = "pin", law = "t" }
points.p = { body = "crank", at = "P" }
measures.x = { type = "position", point = "p", along = "x" }
measures.square = { type = "expression", expression = "x*x/100" }
metrics.far = { of = "square", take = "value", at = 0 }
optimize = { starts = 9, goals = { far = { target = 25 } } }
time = { end = 1, steps = 2 }
"#;
    let file = hardpoint_file::parse(text, "two_sides.toml").unwrap_or_else(|e| panic!("{e}"));
    let settings = asked(&file);
    let found = searched(&file, &settings);
    let optima = found.optima(&file.model, &settings);
    let place = |optimum: &Vec<usize>| 10.0 + found.searches[optimum[0]].found.as_ref().unwrap().design[0];
    let mut places: Vec<f64> = optima.iter().map(place).collect();
    places.sort_by(f64::total_cmp);
    assert_eq!(places.len(), 2, "{places:?}");
    for (place, expected) in places.iter().zip([-50.0, 50.0]) {
        assert!((place - expected).abs() < 1e-6, "{place}");
    }
    let mut starts = optima.concat();
    starts.sort_unstable();
    assert_eq!(starts, (0..9).collect::<Vec<_>>(), "each start is in one optimum");
    // Fewer starts, in any number of threads, end in the same ones.
    let again = searched_on(2, &file, &settings).optima(&file.model, &settings);
    assert_eq!(again, optima);
}

/// A goal without a target whose minimum is zero: below round-off there is nothing to improve.
#[test]
fn a_goal_that_vanishes_at_its_minimum_is_optimal() {
    let text = r#"
name = "vanishing"
units = { length = "mm", angle = "deg" }
hardpoints = { O = [0, 0, 0], P = ["exp(u-1.2)+exp(1.2-u)-2 + (v-u)^2", 0, 0] }
bodies.b = {}
joints.s = { type = "translational", bodies = ["ground", "b"], at = "O", axis = "z" }
drivers.m = { joint = "s", law = "t" }
points.p = { body = "b", at = "P" }
measures.f = { type = "position", point = "p", along = "x" }
metrics.f = { of = "f", take = "max" }
optimize.goals.f = {}
time = { end = 1.0, steps = 4 }
[parameters]
u = { value = 1, unit = "number", bounds = [-2, 3] }
v = { value = 1, unit = "number", bounds = [-2, 3] }
"#;
    let file = hardpoint_file::parse(text, "vanishing.toml").unwrap_or_else(|e| panic!("{e}"));
    let found = searched(&file, &asked(&file));
    let search = best(&found);
    assert_eq!(search.status, Status::Optimal);
    assert!(search.cost.designs < 100, "{} designs", search.cost.designs);
    let design = &search.found.as_ref().unwrap().design;
    assert!(design.iter().all(|change| (change - 0.2).abs() < 1e-5), "{design:?}");
}

/// A slider-crank with a hardpoint that nothing uses, and these goals.
fn slider_crank(optimize: &str) -> ModelFile {
    let text = format!(
        r#"
name = "slider-crank"
units = {{ length = "mm", angle = "deg" }}
planar = "xy"
hardpoints = {{ A = [0, 0], B = [0, "r"], C = ["sqrt(l^2-(r-e)^2)", "e"], Z = ["unused", 50] }}
bodies = {{ ground = ["A"], crank = ["A", "B"], rod = ["B", "C"], slider = {{}} }}
joints.wrist = {{ type = "revolute", bodies = ["rod", "slider"], at = "C" }}
joints.slide = {{ type = "translational", bodies = ["ground", "slider"], at = "C", axis = "x" }}
drivers.motor = {{ joint = "A", law = "-360*t" }}
points.S = {{ body = "slider", at = "C" }}
measures.x = {{ type = "position", point = "S", along = "x" }}
metrics.stroke = {{ of = "x", take = "range" }}
metrics.change = {{ of = "x", take = "change" }}
time = {{ end = 1, steps = 36 }}
[parameters]
r = {{ value = 40, unit = "length", bounds = [20, 60] }}
l = {{ value = 120, unit = "length", bounds = [90, 160] }}
e = {{ value = 8, unit = "length", bounds = [-20, 20] }}
unused = {{ value = 1, unit = "length", bounds = [0, 10] }}
[optimize]
{optimize}
"#
    );
    hardpoint_file::parse(&text, "slider_crank.toml").unwrap_or_else(|e| panic!("{e}"))
}

/// Over a whole turn the slider returns to its place, so that the change is zero up to round-off in every design.
#[test]
fn a_goal_that_is_constant_up_to_round_off_moves_nothing() {
    for (goal, starts, status) in [
        ("{}", 1, Status::NoEffect),
        ("{}", 6, Status::NoEffect),
        ("{ target = 5 }", 1, Status::NoEffect),
        ("{ target = 0 }", 6, Status::Optimal),
    ] {
        let file = slider_crank(&format!("starts = {starts}\ngoals.change = {goal}"));
        let settings = asked(&file);
        let found = searched(&file, &settings);
        let search = best(&found);
        assert_eq!((search.status, found.best), (status, Some(0)), "{goal} {starts}");
        assert_eq!(search.optimality.met, status == Status::Optimal, "{goal} {starts}");
        assert!(search.optimality.binding.is_empty(), "{goal} {starts}");
        let mut design = search.found.as_ref().unwrap().design.iter();
        assert!(design.all(|change| change.abs() < 1e-15), "{goal} {starts}");
        let optima = found.optima(&file.model, &settings).len();
        assert_eq!(optima, usize::from(status == Status::Optimal), "{goal} {starts}");
    }
    // Limits are kept nevertheless.
    let file = slider_crank("goals.change = {}\nlimits.stroke = { metric = \"stroke\", max = 60 }");
    let search = searched(&file, &asked(&file)).searches.swap_remove(0);
    assert_eq!(search.status, Status::NoEffect);
    assert!(search.found.unwrap().limits[0].2 < 60e-3 * (1.0 + 1e-6));
}

/// Variables that no goal depends on keep their nominal values in every optimum, and do not distinguish optima.
#[test]
fn variables_without_effect_make_no_optima() {
    let file = slider_crank("starts = 8\nvariables = [\"r\", \"unused\"]\ngoals.stroke = { target = 90 }");
    let settings = asked(&file);
    let found = searched(&file, &settings);
    let optima = found.optima(&file.model, &settings);
    assert_eq!((optima.len(), optima.concat().len()), (1, 8), "{optima:?}");
    for search in &found.searches {
        assert_eq!(search.idle, [false, true]);
        assert!(search.found.as_ref().unwrap().design[3].abs() < 1e-15);
    }
}

/// A goal that does not change to first order with two of three variables: searches from the start move the third
/// alone, to 1 at x = z = 0. Its minimum is 7/8 at x = -z = 1/2 or -1/2, in a direction along which neither of the two
/// alone is better: f = 1 + x^4 + z^4 + 3 x z + x^2 + z^2 + (y - 0.1)^2.
#[test]
fn a_design_that_is_symmetric_in_its_variables_is_left_where_it_is_a_saddle() {
    let text = |x: &str| {
        format!(
            r#"
name = "saddle"
units = {{ length = "m", angle = "rad" }}
time = {{ at = [0] }}
hardpoints = {{ O = [0, 0, 0], P = [{x}, 0.3, 0] }}
bodies.arm = {{}}
joints.O = {{ type = "revolute", bodies = ["ground", "arm"], at = "O", axis = "z" }}
drivers.O = {{ joint = "O", law = "0" }}
points.p = {{ body = "ground", at = "P" }}
design = {{ p = {{ move = "P", along = "xyz", bounds = [-1, 1] }} }}
optimize = {{ goals = {{ f = {{}} }} }}
[measures]
x = {{ type = "position", point = "p", along = "x" }}
y = {{ type = "position", point = "p", along = "y" }}
z = {{ type = "position", point = "p", along = "z" }}
sum = {{ type = "expression", expression = "1 + x^4 + z^4 + 3*x*z + x^2 + z^2 + (y - 0.1)^2" }}
[metrics]
f = {{ of = "sum", take = "max" }}
"#
        )
    };
    // At the saddle, and beside it.
    for x in ["0", "1e-3"] {
        let file = hardpoint_file::parse(&text(x), "saddle.toml").unwrap_or_else(|e| panic!("{e}"));
        let found = searched(&file, &asked(&file));
        let best = best(&found);
        assert_eq!(best.status, Status::Optimal);
        let [x0, y, z] = best.found.as_ref().unwrap().design[..] else { panic!() };
        let x = x0 + x.parse::<f64>().unwrap();
        assert!(
            (x.abs() - 0.5).abs() < 1e-5 && (x + z).abs() < 1e-5 && (y + 0.2).abs() < 1e-5,
            "{x} {y} {z}"
        );
    }
}

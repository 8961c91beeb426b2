//! Designs that are searched for: those that are known are found, and what is found is an optimum.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::model::{Limit, Limited, Optimization};
use hardpoint::study::{Binding, Cost, Motions, Optimized, Progress, Search, Searching, Status, optimize};
use hardpoint::topology::Formulation;
use hardpoint_file::ModelFile;

/// What is left of the gradient at an optimum, as a part of that at the start.
const OPTIMAL: f64 = 1e-8;

fn model(name: &str) -> ModelFile {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    hardpoint_file::read(&models.join(name)).unwrap_or_else(|e| panic!("{e}"))
}

fn searched_on(threads: usize, file: &ModelFile, asked: &Optimization) -> Optimized {
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let mut progress = |_: usize, _: Progress<'_>| ControlFlow::Continue(());
    let threads = NonZero::new(threads).unwrap();
    optimize(
        &file.model,
        &motions,
        asked,
        Searching { progress: &mut progress, more: &|| true, threads, first: 0 },
    )
}

fn searched(file: &ModelFile, asked: &Optimization) -> Optimized {
    searched_on(1, file, asked)
}

fn asked(file: &ModelFile) -> Optimization {
    file.model.optimization.clone().expect("the file says what is wanted")
}

fn best(found: &Optimized) -> &Search {
    &found.searches[found.best.expect("something is found")]
}

/// The hardpoints of the four-bar whose motion is given, and how near they are found: parts of the crank's length.
const KNOWN: [[f64; 2]; 4] = [[0.0, 0.0], [0.04, 0.2], [0.36, 0.6], [0.4, 0.0]];
const FOUND: f64 = 1e-6 * 0.204;
/// The published search ends after so many iterations, each with a motion and its derivatives at least, and is 47 mm off.
const PUBLISHED: usize = 16;

fn is_known(file: &ModelFile, search: &Search) -> bool {
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
    assert!(search.optimality.residual <= OPTIMAL, "{:e}", search.optimality.residual);
    assert!(search.optimality.binding.is_empty(), "{:?}", search.optimality.binding);
    // The work of all variables is the whole change, but for the bend of the way.
    let objective = |k: usize| search.iterations[k].objective;
    let change = objective(search.iterations.len() - 1) - objective(0);
    assert!((search.work.iter().sum::<f64>() / change - 1.0).abs() < 0.5, "{:?} of {change}", search.work);
}

#[test]
fn it_is_found_from_everywhere_within_the_bounds_on_any_number_of_threads() {
    let file = model("four_bar_inverse.toml");
    let many = Optimization { starts: 13, ..asked(&file) };
    let found = searched(&file, &many);
    for (k, search) in found.searches.iter().enumerate() {
        assert!(is_known(&file, search), "start {k}: {:?}, {:?}", search.status, search.found);
    }
    // Most linkages within these bounds cannot turn: their starts are drawn nearer until they do.
    assert!(found.searches.iter().any(|s| !s.refused.is_empty()));
    let again = searched_on(3, &file, &many);
    let ends = |o: &Optimized| o.searches.iter().map(|s| s.found.clone().unwrap().design).collect::<Vec<_>>();
    assert_eq!(ends(&found), ends(&again));
}

#[test]
fn a_search_that_is_interrupted_keeps_the_best_so_far() {
    let file = model("four_bar_inverse.toml");
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let mut told = 0;
    let mut progress = |_: usize, _: Progress<'_>| {
        told += 1;
        if told < 4 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let threads = NonZero::<usize>::MIN;
    let searching = Searching { progress: &mut progress, more: &|| true, threads, first: 0 };
    let asked = Optimization { starts: 3, ..asked(&file) };
    let found = optimize(&file.model, &motions, &asked, searching);
    assert!(found.searches.iter().all(|s| s.status == Status::Interrupted));
    let judged = best(&found).found.as_ref().unwrap();
    assert!(judged.objective < 0.1 * found.drawn.unwrap().objective);
}

/// Between what is found and the target, over the whole travel, rad.
const WITHIN: f64 = 0.02 * std::f64::consts::PI / 180.0;

#[test]
fn the_strut_gets_its_toe_curve_and_steers_no_worse() {
    let file = model("studies/strut_toe.toml");
    let asked = asked(&file);
    let found = searched(&file, &asked);
    let search = best(&found);
    assert_eq!(search.status, Status::Optimal);
    assert!(search.cost.designs < 20, "{} designs", search.cost.designs);
    assert!(search.optimality.residual <= OPTIMAL, "{:e}", search.optimality.residual);
    let judged = search.found.as_ref().unwrap();
    assert_eq!(judged.violation, 0.0);
    let drawn = found.drawn.as_ref().unwrap();
    assert!(judged.limits[0].2 > drawn.limits[0].2, "the inner wheel steers no less");
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let solved = motions.evaluate(&judged.design, &mut Cost::default(), &|| true).unwrap();
    let (measured, bump) = (&solved.solutions[0].measured, &models[0]);
    let [toe, travel] = ["toe", "wheel_travel"].map(|name| measured.index(name).unwrap());
    for k in 0..measured.len() {
        let wanted = bump.metrics[0].target_at(measured.value(k, travel)[0]).unwrap();
        let off = measured.value(k, toe)[0] - wanted;
        assert!(off.abs() <= WITHIN, "{off} rad at step {k}");
    }
}

/// What is left of the published toe curve, 0.77 deg to either side, at most: root mean square, rad.
const FOLLOWED: f64 = 0.003 * std::f64::consts::PI / 180.0;

#[test]
fn the_front_axle_gets_the_toe_curve_of_a_published_example() {
    let file = model("studies/front_axle_toe.toml");
    let found = searched(&file, &asked(&file));
    let search = best(&found);
    assert_eq!(search.status, Status::Optimal);
    assert!(search.optimality.residual <= OPTIMAL, "{:e}", search.optimality.residual);
    let [drawn, left] = [found.drawn.as_ref(), search.found.as_ref()].map(|j| j.unwrap().goals[0].2);
    assert!(drawn > 500.0 * FOLLOWED && left < FOLLOWED, "{drawn} {left}");
}

/// A limit on what a goal of the strut is taken of, in SI.
fn limit(of: Limited, least: Option<f64>, most: Option<f64>) -> Limit {
    Limit { name: "limit".into(), of, least, most }
}

#[test]
fn what_binds_is_worth_what_giving_way_gains() {
    // The multiplier of a limit against two searches with the limit moved either way.
    const MOVED: f64 = 1e-5;
    const AGREES: f64 = 1e-3;
    let file = model("studies/strut_toe.toml");
    let at = |least: f64| {
        let limits = vec![limit(Limited::Metric(1), Some(least), None)];
        searched(&file, &Optimization { limits, ..asked(&file) })
    };
    let deg = std::f64::consts::PI / 180.0;
    let least = 0.145 * deg;
    let middle = at(least);
    let search = best(&middle);
    assert_eq!(search.status, Status::Optimal, "{:?}", search.iterations);
    let binding = &search.optimality.binding;
    let worth =
        binding.iter().find(|(what, _)| matches!(what, Binding::Least(0, Some(1)))).expect("it binds").1;
    let objective = |found: &Optimized| best(found).found.as_ref().unwrap().objective;
    let gained =
        (objective(&at(least + MOVED * deg)) - objective(&at(least - MOVED * deg))) / (2.0 * MOVED * deg);
    assert!((gained / worth - 1.0).abs() < AGREES, "{gained} and {worth}");
}

#[test]
fn limits_that_contradict_each_other_and_designs_that_lock_are_told() {
    let file = model("studies/strut_toe.toml");
    let far = Optimization { limits: vec![limit(Limited::Metric(1), Some(0.5), None)], ..asked(&file) };
    let found = searched(&file, &far);
    assert_eq!(best(&found).status, Status::LimitsNotKept);
    assert!(best(&found).found.as_ref().unwrap().violation > 0.0);
    // No design keeps so far from singular positions: none can be judged, and each says why.
    let file = model("four_bar_inverse.toml");
    let found = searched(&file, &Optimization { margin: Some(0.99), ..asked(&file) });
    assert_eq!((found.best, found.searches[0].status), (None, Status::NoStart));
    assert!(found.drawn_refused.unwrap().why.contains("margin"));
}

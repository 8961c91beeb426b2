//! Published path syntheses of linkages: the optimised designs are no worse than the best published ones.
//!
//! The problems are `models/synthesis/`; each file says where its numbers come from. The error is computed from the
//! points that the found design reaches, not from what was minimised.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use hardpoint::model::{OptimizationSettings, Reduction};
use hardpoint::topology::Formulation;
use hardpoint_file::{ModelFile, read, schema};
use hardpoint_study::optimize::{Optimization, Request, SearchResult, Status, optimize};
use hardpoint_study::{Control, Motions};

/// Remainder of the gradient at an optimum, relative to that at the start.
const STATIONARY: f64 = 1e-8;
/// ... and as a part of the gradient of the goals themselves, which misfits far below those of the start make much
/// smaller.
const SCALED: f64 = 1e-6;
/// Tolerance of bounds, relative to their width.
const ROUND_OFF: f64 = 1e-12;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/synthesis")
}

fn problem(name: &str) -> ModelFile {
    read(&folder().join(format!("{name}.toml"))).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn every_problem_names_its_schema_and_fits_it() {
    let validator = jsonschema::validator_for(&serde_json::from_str(&schema()).unwrap()).unwrap();
    let files: Vec<PathBuf> = std::fs::read_dir(folder()).unwrap().map(|e| e.unwrap().path()).collect();
    assert_eq!(files.len(), 4, "{files:?}");
    for path in files {
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("#:schema ../hardpoint.schema.json\n"), "{}", path.display());
        let value: serde_json::Value = toml::from_str(&text).unwrap();
        let errors: Vec<String> = validator.iter_errors(&value).map(|e| e.to_string()).collect();
        assert!(errors.is_empty(), "{}: {errors:#?}", path.display());
    }
}

fn search(file: &ModelFile, asked: &OptimizationSettings) -> Optimization {
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let control = Control {
        threads: NonZero::<usize>::MIN,
        progress: &mut |_| ControlFlow::Continue(()),
        more: &|| true,
    };
    optimize(&file.model, &motions, &Request { settings: asked.clone(), first: 0 }, control)
}

/// The sum of the squared distances from the published points, in the file's unit, of a design; the points are the
/// targets of the metrics `x` and `y`.
fn published_error(file: &ModelFile, design: &[f64], points: usize) -> f64 {
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let found = motions.evaluate(design, &mut Default::default(), &|| true).unwrap();
    let measured = &found.solutions[0].measured;
    assert!(measured.len() >= points);
    let square = |name: &str| {
        let Reduction::RmsAtPoints(target) =
            &file.model.metrics.iter().find(|m| m.name == name).unwrap().take
        else {
            panic!("{name} has a target");
        };
        let m = measured.index(name).unwrap();
        let apart = |k: usize| 1e3 * (measured.value(k, m)[0] - target[k][1]);
        (0..points).map(|k| apart(k).powi(2)).sum::<f64>()
    };
    square("x") + square("y")
}

/// The lengths of ground, crank, coupler and rocker of a design, in the file's unit.
fn links(file: &ModelFile, design: &[f64]) -> [f64; 4] {
    let places = file.model.hardpoint_places(design);
    let place = |name: &str| places[file.model.hardpoints.iter().position(|h| h.name == name).unwrap()];
    [["A", "D"], ["A", "B"], ["B", "C"], ["C", "D"]].map(|[a, b]| 1e3 * (place(a) - place(b)).norm())
}

/// Searches, and holds what is found against the published error, the bounds, Grashof's condition and the conditions of
/// an optimum.
fn reaches(name: &str, points: usize, published: f64) -> (ModelFile, SearchResult) {
    let file = problem(name);
    let asked = file.model.optimization.clone().unwrap();
    let found = search(&file, &asked);
    for (k, s) in found.searches.iter().enumerate() {
        let objective = s.found.as_ref().map(|f| f.objective);
        println!(
            "{name} {k}: {:?} {objective:?}, residual {:.1e}, {} iterations, {} designs, {} refused: {:?}",
            s.status,
            s.optimality.residual,
            s.iterations.len(),
            s.cost.designs,
            s.refused.len(),
            s.refused.first().map(|r| &r.why),
        );
    }
    println!("{:?}", found.cost);
    let search = found.searches[found.best.expect("some search starts")].clone();
    let best = search.found.as_ref().unwrap();
    let error = published_error(&file, &best.design, points);
    println!("{name}: {error:.9e} of {published:e}, residual {:.1e}", search.optimality.residual);
    assert!(error <= published, "{error:e} {published:e}");
    // What was minimised is what is published.
    assert!((best.objective - error).abs() <= 1e-9 * error, "{} {error}", best.objective);
    assert_eq!(search.status, Status::Optimal);
    assert!(search.optimality.left_of_start <= STATIONARY, "{:e}", search.optimality.left_of_start);
    assert!(search.optimality.residual <= SCALED, "{:e}", search.optimality.residual);
    for v in &asked.variables {
        let [low, high] = file.model.variables[v.0].bounds.unwrap();
        let (value, slack) = (best.design[v.0], ROUND_OFF * (high - low));
        assert!(low - slack <= value && value <= high + slack, "{low} {value} {high}");
    }
    let [ground, crank, coupler, rocker] = links(&file, &best.design);
    println!("{ground} {crank} {coupler} {rocker}");
    for [with, one, other] in
        [[ground, coupler, rocker], [coupler, ground, rocker], [rocker, ground, coupler]]
    {
        // A limit is kept to 1e-8 of its scale, which is the width of the bounds of a length.
        assert!(crank + with <= one + other + 1e-6, "the crank turns all round");
    }
    (file, search)
}

#[test]
fn an_arc_through_five_points() {
    reaches("arc_five_points", 5, 1.284e-6);
}

#[test]
fn a_loop_through_eighteen_points() {
    reaches("loop_eighteen_points", 18, 1.6077e-2);
}

#[test]
fn half_a_circle_through_six_points() {
    reaches("half_circle_six_points", 6, 1.216_212_2);
}

#[test]
fn a_circle_through_ten_points() {
    let (file, search) = reaches("circle_ten_points", 10, 4.019_922e-4);
    // The points are reached in their order.
    let design = &search.found.unwrap().design;
    let angle = |k: usize| {
        let freed = (1..9).contains(&k).then(|| file.model.variable(&format!("angle_{}", k + 1)).unwrap());
        40.0 * k as f64 + freed.map_or(0.0, |v| design[v.0].to_degrees())
    };
    for k in 1..10 {
        assert!(angle(k - 1) < angle(k), "{k}: {} {}", angle(k - 1), angle(k));
    }
}

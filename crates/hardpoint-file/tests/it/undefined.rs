//! Studies of outputs that have a value and no derivative: a ring in a box, whose deepest point is between two faces.
//! That of a rod has derivatives.

use std::num::NonZero;
use std::ops::ControlFlow;

use hardpoint::Analysis;
use hardpoint::model::{AllocationRule, AllocationSettings, VariableId};
use hardpoint::topology::Formulation;
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::difference::{DifferenceScheme, finite_differences};
use hardpoint_study::tolerance::{self, AllocationError, ToleranceResult, tolerance};
use hardpoint_study::verify::{self, CheckOutcome, verify};
use hardpoint_study::{Comparison, Control, Motions, map, optimize};

/// A ring that turns in a box.
const RING: &str = r#"
name = "ring in a box"
units = { length = "mm", angle = "deg" }
hardpoints = { A = [0, 0, 0], B = [100, 0, 0] }
bodies.arm = {}
joints.A = { type = "revolute", bodies = ["ground", "arm"], at = "A", axis = "z" }
drivers.motor = { joint = "A", law = "10*t" }
points.tip = { body = "arm", at = "B" }
shapes.box = { body = "ground", box = [40, 60, 60], frame = { position = [80, 0, 0] }, round = 2 }
shapes.ring = { body = "arm", ring = "B", axis = "z", radius = 35, round = 5 }
clearances.gap = { between = ["ring", "box"] }
measures.half = { type = "expression", expression = "gap/2" }
measures.lean = { type = "angle", from = "x", to = [{ body = "arm", at = "A" }, { body = "arm", at = "B" }] }
metrics.end = { of = "gap", take = "value", at = 1 }
design.B_x = { move = "B", along = "x", tolerance = 1, bounds = [-20, 20] }
design.B_y = { move = "B", along = "y", tolerance = 1, bounds = [-20, 20] }
tolerance.limits.end = { min = -30 }
optimize.goals.end = { target = -22 }
time = { end = 1.0, steps = 10 }
"#;

/// Elastic supports of the arm, which make its motion an equilibrium.
const ELASTIC: &str = r#"
equilibrium = {}
masses.m = { type = "rigid", centre = { body = "arm", at = "B" }, mass = 1 }
gravity.along = "-y"
forces.el = { type = "elastic_joint", joint = "A", x = 100, y = 100, z = 100 }
"#;

fn file(text: &str) -> ModelFile {
    parse(text, "undefined.toml").unwrap_or_else(|e| panic!("{e}"))
}

fn control<T>(work: impl FnOnce(Control<'_>) -> T) -> T {
    work(Control {
        threads: NonZero::<usize>::MIN,
        progress: &mut |_| ControlFlow::Continue(()),
        more: &|| true,
    })
}

/// Outcomes of a verification of a solution with other derivatives of an output by the first variable.
fn outcomes(text: &str, fault: Option<(&str, [f64; 3])>) -> Vec<CheckOutcome> {
    let file = file(text);
    let analysis = Analysis::new(&file.model).unwrap();
    let mut solution = analysis.run();
    if let Some((output, d)) = fault {
        let m = solution.measured.index(output).unwrap();
        solution.measured.set_d(5, VariableId(0), m, d);
    }
    let options = verify::Options::new(DifferenceScheme::Central);
    let found = verify(&analysis, &solution, &options, |_| ControlFlow::Continue(()));
    found.checks.into_iter().map(|check| check.outcome).collect()
}

#[test]
fn a_depth_without_derivatives_is_not_compared_with_differences_at_an_equilibrium_either() {
    use CheckOutcome::{Failed, Passed};
    let elastic = format!("{RING}{ELASTIC}");
    for text in [RING, &elastic] {
        assert_eq!(outcomes(text, None), [Passed, Passed]);
        // Other outputs have derivatives at these times.
        assert_eq!(outcomes(text, Some(("tip.y", [f64::NAN; 3]))), [Failed, Passed]);
        // A distance has derivatives, and a lack of them is a fault.
        let apart = text.replace("position = [80, 0, 0]", "position = [90, 110, 0]");
        assert_eq!(outcomes(&apart, None), [Passed, Passed]);
        assert_eq!(outcomes(&apart, Some(("gap", [f64::NAN; 3]))), [Failed, Passed]);
    }
    // The page compares with single differences.
    let model = file(&elastic).model;
    let analysis = Analysis::new(&model).unwrap();
    let solution = analysis.run();
    let step = (VariableId(0), 1e-3 * model.natural_step(VariableId(0)));
    let difference = finite_differences(&analysis, &solution, DifferenceScheme::Central, &[step]).remove(0);
    let comparison = Comparison::of(&model, &solution, &difference.unwrap());
    for output in ["gap", "half"] {
        let m = solution.measured.index(output).unwrap();
        assert!(
            solution.measured.value(5, m)[0] < 0.0 && solution.measured.d(5, VariableId(0), m)[0].is_nan()
        );
        assert_eq!(comparison.of_output(m), [0.0; 3], "{output}");
    }
}

fn toleranced(text: &str) -> ToleranceResult {
    let file = file(text);
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let mut settings = file.model.tolerancing.clone().unwrap();
    (settings.samples, settings.allocation) = (100, Some(AllocationSettings { rule: AllocationRule::Worst }));
    settings.tolerances.iter_mut().for_each(|t| t.cost = Some(1.0));
    control(|c| tolerance(&file.model, &motions, &[0], &tolerance::Request { settings }, c)).unwrap()
}

#[test]
fn a_metric_without_derivatives_has_no_yield_by_moments_and_no_worst_case() {
    let found = toleranced(RING);
    let (metric, limit) = (&found.metrics[0], &found.limits[0]);
    assert!(metric.nominal.is_finite() && metric.sigma.is_nan());
    assert_eq!(limit.by_moments, None);
    assert_eq!(limit.sampled.unwrap().part(), 1.0);
    // Designs at some corners would be within the sampled ones.
    assert!(metric.worst.iter().all(|worst| worst.exact.is_none()), "{:?}", metric.worst);
    assert_eq!(found.allocation.unwrap().error, Some(AllocationError::NoDerivatives(0)));
    // A distance has all of them.
    let apart =
        RING.replace("position = [80, 0, 0]", "position = [90, 110, 0]").replace("min = -30", "min = 2");
    let found = toleranced(&apart);
    assert!(found.limits[0].by_moments.unwrap() > 0.99);
    assert!(found.metrics[0].worst.iter().all(|worst| worst.exact.is_some()));
}

#[test]
fn an_optimisation_names_the_measure_that_has_no_derivatives() {
    let file = file(RING);
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let request = optimize::Request::of(&file.model, optimize::Overrides::default()).unwrap();
    let found = control(|c| optimize::optimize(&file.model, &motions, &request, c));
    let why = found.nominal_failure.unwrap().why;
    assert_eq!(why, "metric `end` has no derivative by `B_x`, since `gap` has none there");
}

#[test]
fn a_table_of_a_clearance_is_rejected() {
    let model = file(RING).model;
    for name in ["gap", "half"] {
        let error = map::Request::outputs(&model, &[name.to_owned()]).unwrap_err();
        let expected = format!("`{name}` cannot be mapped: it is a clearance, or computed from one");
        assert_eq!(error.message, expected);
    }
    let all = map::Request::outputs(&model, &[]).unwrap();
    assert_eq!(all.iter().map(|(name, ..)| name.as_str()).collect::<Vec<_>>(), ["lean"]);
}

#[test]
fn rates_that_jump_where_a_rod_is_parallel_to_a_face_are_not_compared_with_differences() {
    // The stretch that both have in common ends at the tip, or at an edge of the box.
    for depth in [2.0, -8.0] {
        let text = format!(
            "name = \"c\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\nbodies.arm = {{}}\n\
             hardpoints = {{ A = [0, 0, 0], Q = [51, 0, 0], S = [50, {}, 0] }}\n\
             joints.A = {{ type = \"revolute\", bodies = [\"ground\", \"arm\"], at = \"A\", axis = \"z\" }}\n\
             drivers.m = {{ joint = \"A\", law = \"10*t\" }}\ndesign.s = {{ move = \"S\", along = \"x\" }}\n\
             shapes.rod = {{ body = \"arm\", capsule = [\"A\", \"Q\"], radius = 4 }}\n\
             shapes.block = {{ body = \"ground\", box = [10, 30, 10], frame = {{ position = \"S\" }} }}\n\
             clearances.c = {{ between = [\"rod\", \"block\"] }}\ntime = {{ end = 1, steps = 4 }}\n",
            depth - 15.0
        );
        assert_eq!(outcomes(&text, None), [CheckOutcome::Passed], "{depth}");
    }
}

/// A rod that begins its turn in a solid, along a face of it or nearly so, or through two faces at an edge of it: the
/// solid is moved away as far as necessary.
#[test]
fn an_optimisation_separates_a_rod_from_a_solid_that_it_begins_in() {
    let block = "box = [10, 30, 10], frame = { position = \"S\" }";
    for (end, solid, from, to, exact) in [
        (0.0, block, -13.0, -21.0, 1e-6),
        (0.001, block, -13.0, -21.0 + 0.001 * 45.0 / 60.0, 1e-6),
        // The edge at (35, y + 6) is 6 mm from the rod, whose slope is 5/12.
        (25.0, "box = [30, 12, 20], frame = { position = \"S\" }", 12.0, 35.0 * 5.0 / 12.0 - 6.5 - 6.0, 1e-5),
        (0.0, "cylinder = [\"S\", [50, -30, 5]], radius = 6", 2.0, 2.0 - 8.1302, 1e-4),
    ] {
        let text = format!(
            "name = \"deep\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\nbodies.arm = {{}}\n\
             hardpoints = {{ A = [0, 0, 0], Q = [60, {end}, 0], S = [50, {from}, 0] }}\n\
             joints.A = {{ type = \"revolute\", bodies = [\"ground\", \"arm\"], at = \"A\", axis = \"z\" }}\n\
             drivers.m = {{ joint = \"A\", law = \"10*t\" }}\n\
             design.s = {{ move = \"S\", along = \"y\", bounds = [-60, 5] }}\n\
             shapes.rod = {{ body = \"arm\", capsule = [\"A\", \"Q\"], radius = 4 }}\n\
             shapes.solid = {{ body = \"ground\", {solid} }}\n\
             clearances.c = {{ between = [\"rod\", \"solid\"], min = 2 }}\n\
             points.S = {{ body = \"ground\", at = \"S\" }}\nmetrics.y = {{ of = \"S.y\", take = \"max\" }}\n\
             optimize.goals.y = {{ target = {from} }}\noptimize.limits.c = {{ clearance = \"c\" }}\n\
             time = {{ end = 1, steps = 4 }}\n"
        );
        let model = file(&text).model;
        let models = model.motions();
        let motions = Motions::of(&models, Formulation::Relative).unwrap();
        let request = optimize::Request::of(&model, optimize::Overrides::default()).unwrap();
        let found = control(|c| optimize::optimize(&model, &motions, &request, c));
        let best = &found.searches[found.best.unwrap()];
        assert_eq!(best.status, optimize::Status::Optimal, "{solid}, {end}");
        let y = from + 1e3 * best.found.as_ref().unwrap().design[0];
        assert!((y - to).abs() < exact, "{solid}, {end}: {y} instead of {to}");
    }
}

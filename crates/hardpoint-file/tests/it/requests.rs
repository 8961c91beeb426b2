//! Requests of studies: the settings of the file with overrides, and the errors of those that cannot be done.

use hardpoint::model::{
    AllocationRule, AllocationSettings, Goal, Measurements, Model, OptimizationSettings, SweepMethod,
    SweepSettings, ToleranceSettings, VariableId,
};
use hardpoint_file::parse;
use hardpoint_study::request::Fault;
use hardpoint_study::{RequestError, calibrate, optimize, sweep, tolerance};

/// A slider-crank with settings of every study.
const WHOLE: &str = r#"
name = "slider-crank"
units = { length = "mm", angle = "deg" }
parameters.rod = { value = 300, unit = "length", bounds = [250, 350], tolerance = 0.1 }
parameters.radius = { value = 100, unit = "length", bounds = [90, 110] }
hardpoints = { O = [0, 0, 0], A = ["radius*cos(40*pi/180)", "radius*sin(40*pi/180)", 0], B = [300, 20, 0] }
bodies = { crank = {}, slider = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = "B", axis = "x" }
joints.rod = { type = "distance", bodies = ["crank", "slider"], at = ["A", "B"], length = "rod" }
drivers.motor = { joint = "pivot", law = "20*t" }
measures.place = { type = "position", point = "B", along = "x" }
points.B = { body = "slider", at = "B" }
metrics.first = { of = "place", take = "value", at = 0 }
metrics.fit = { of = "place", take = "rms", target = [[0, 300], [1, 310]] }
time = { end = 1.0, steps = 10 }
"#;
const OPTIMIZE: &str = "[optimize]\nvariables = [\"rod\"]\nstarts = 3\ngoals.first = { target = 290 }\n";
const TOLERANCE: &str = "[tolerance]\nsamples = 70\nallocate = \"rss\"\nrequired_sigmas = 4.5\n\
     limits.first = { metric = \"first\", max = 500 }\nvariables.rod = { tolerance = 0.2, cost = 1 }\n";
const SWEEP: &str = "[sweep]\nsamples = 12\nlevels = 5\n";

fn model(text: &str) -> Model {
    parse(text, "slider.toml").unwrap_or_else(|e| panic!("{e}")).model
}

/// The model with settings of every study.
fn whole() -> Model {
    model(&[WHOLE, OPTIMIZE, TOLERANCE, SWEEP].concat())
}

/// The model without any settings, tolerances, metrics and measures.
fn bare() -> Model {
    let text: Vec<&str> =
        WHOLE.lines().filter(|l| !l.starts_with("me") && !l.starts_with("points")).collect();
    model(&text.join("\n").replace(", tolerance = 0.1", ""))
}

fn expect<T: std::fmt::Debug>(found: Result<T, RequestError>, fault: Fault, message: &str) {
    let error = found.expect_err(message);
    assert!(error.message.contains(message), "{error}");
    assert_eq!(error.fault, fault, "{error}");
    assert!(!error.help.is_empty());
}

#[test]
fn an_optimisation_is_that_of_the_file_with_overrides() {
    use optimize::{Overrides, Request, Selection};
    let model = whole();
    let of = |overrides: Overrides| Request::of(&model, overrides);
    let settings = model.optimization.clone().unwrap();
    assert_eq!(of(Overrides::default()), Ok(Request { settings: settings.clone(), first: 0 }));
    let [starts, iterations] = [Some(5), Some(7)];
    let overridden = of(Overrides { starts, iterations, first: 2, ..Overrides::default() });
    let expected = OptimizationSettings { starts: 5, iterations: 7, ..settings.clone() };
    assert_eq!(overridden, Ok(Request { settings: expected, first: 2 }));

    let most = OptimizationSettings::MOST as usize;
    for (n, message) in [(0, "the number of starts is 0"), (most + 1, "100001 starts are too many")] {
        expect(of(Overrides { starts: Some(n), ..Overrides::default() }), Fault::Override, message);
    }
    expect(
        of(Overrides { iterations: Some(0), ..Overrides::default() }),
        Fault::Override,
        "the number of iterations is 0",
    );
    expect(Request::of(&bare(), Overrides::default()), Fault::Model, "the model has no `[optimize]` table");
    let mut of_no_case = model.clone();
    of_no_case.optimization.as_mut().unwrap().goals.clear();
    expect(
        Request::of(&of_no_case, Overrides::default()),
        Fault::Override,
        "`[optimize]` has no goal in this case",
    );

    // Variables and goals of a page, with or without settings in the file.
    let goal = |metric: usize, weight: f64, target: Option<f64>| Goal {
        name: "goal".into(),
        metric,
        target,
        weight,
    };
    let selected = |model: &Model, goal: Goal| {
        let selection = Selection { variables: vec![VariableId(0)], goals: vec![goal] };
        Request::of(model, Overrides { selection: Some(selection), ..Overrides::default() })
    };
    let plain = selected(&self::model(WHOLE), goal(0, 1.0, None)).unwrap().settings;
    let OptimizationSettings { starts, iterations, .. } = OptimizationSettings::default();
    assert_eq!((plain.starts, plain.iterations, plain.goals.len()), (starts, iterations, 1));
    assert_eq!(selected(&model, goal(1, 2.0, None)).unwrap().settings.starts, settings.starts);
    for (wrong, message) in [
        (goal(0, 0.0, None), "invalid weight of goal `goal`"),
        (goal(0, f64::NAN, None), "invalid weight of goal `goal`"),
        (goal(0, 1.0, Some(f64::INFINITY)), "the target of goal `goal` is not a finite number"),
        (goal(1, 1.0, Some(0.3)), "its metric is an `rms`"),
    ] {
        expect(selected(&model, wrong), Fault::Override, message);
    }
    for (bounds, message) in [
        (None, "the bounds of design variable `rod` are missing"),
        (Some([0.1, -0.1]), "are not in ascending order"),
        (Some([f64::NAN, 0.1]), "are not in ascending order"),
        (Some([0.01, 0.1]), "do not enclose the nominal design"),
    ] {
        let mut model = model.clone();
        model.variables[0].bounds = bounds;
        expect(selected(&model, goal(0, 1.0, None)), Fault::Override, message);
    }
    // Round-off of units is no deviation from the nominal design.
    let mut at_bound = model.clone();
    at_bound.variables[0].bounds = Some([1e-17, 0.1]);
    assert!(selected(&at_bound, goal(0, 1.0, None)).is_ok());
    expect(
        of(Overrides { selection: Some(Selection::default()), ..Overrides::default() }),
        Fault::Override,
        "requires at least one variable and one goal",
    );
}

#[test]
fn a_tolerance_study_is_that_of_the_file_with_overrides() {
    use tolerance::{Overrides, Request};
    let model = whole();
    let settings = model.tolerancing.clone().unwrap();
    let of = |overrides: &Overrides| Request::of(&model, overrides);
    assert_eq!(of(&Overrides::default()), Ok(Request { settings: settings.clone() }));
    let overrides = Overrides { samples: Some(0), seed: Some(9), allocate: None };
    assert_eq!(
        of(&overrides),
        Ok(Request { settings: ToleranceSettings { samples: 0, seed: 9, ..settings } })
    );

    let rule = |model: &Model, name: &str| {
        let allocate = Some(tolerance::allocation_rule(name)?);
        let overrides = Overrides { allocate, ..Overrides::default() };
        Request::of(model, &overrides).map(|request| request.settings.allocation)
    };
    let allocation = |rule| Ok(Some(AllocationSettings { rule }));
    let without = self::model(WHOLE);
    assert_eq!(rule(&model, "rss"), allocation(AllocationRule::Rss { sigmas: 4.5 }));
    assert_eq!(rule(&without, "rss"), allocation(AllocationRule::Rss { sigmas: ToleranceSettings::SIGMAS }));
    assert_eq!(rule(&model, "worst_case"), allocation(AllocationRule::Worst));
    expect(rule(&model, "rsss"), Fault::Override, "there is no allocation rule named `rsss`");

    let many = Overrides { samples: Some(ToleranceSettings::MOST as usize + 1), ..Overrides::default() };
    expect(of(&many), Fault::Override, "10000001 samples are too many");
    expect(Request::of(&bare(), &Overrides::default()), Fault::Model, "no design variable has a tolerance");
    let mut silent = bare();
    silent.variables[0].tolerance = Some(1e-4);
    expect(Request::of(&silent, &Overrides::default()), Fault::Model, "no metrics or measures");
}

#[test]
fn a_calibration_is_of_all_variables_or_of_those_that_are_named() {
    use calibrate::{Loss, Overrides, Request};
    let (model, measured) = (whole(), Measurements::default());
    let of = |overrides: &Overrides<'static>| Request::of(&model, &measured, overrides);
    let all = of(&Overrides::default()).unwrap();
    assert_eq!((all.variables.len(), all.loss, all.iterations), (2, Loss::Squares, Request::ITERATIONS));
    let named = |names: &[&str]| {
        let variables = names.iter().map(|name| (*name).to_owned()).collect();
        of(&Overrides { variables, ..Overrides::default() }).map(|request| request.variables)
    };
    assert_eq!(named(&["radius", "rod", "radius"]), Ok(vec![VariableId(1), VariableId(0)]));
    expect(named(&["rods"]), Fault::Override, "there is no design variable named `rods`");
    expect(
        of(&Overrides { iterations: Some(0), ..Overrides::default() }),
        Fault::Override,
        "the number of iterations is 0",
    );
    let mut fixed = bare();
    fixed.variables.clear();
    expect(
        Request::of(&fixed, &measured, &Overrides::default()),
        Fault::Model,
        "the model has no design variables to fit",
    );
    let losses = Loss::NAMES.map(|name| Loss::named(name).unwrap());
    assert_eq!(losses, [Loss::Squares, Loss::Huber, Loss::Cauchy]);
    expect(Loss::named("hubert"), Fault::Override, "there is no loss function named `hubert`");
}

#[test]
fn a_sweep_is_that_of_the_file_with_overrides() {
    use sweep::{Overrides, Request};
    let model = whole();
    let settings = model.sweeping.clone().unwrap();
    let of = |overrides: Overrides| Request::of(&model, overrides).map(|request| request.settings);
    assert_eq!(of(Overrides::default()), Ok(settings.clone()));
    let found = of(Overrides {
        method: Some(SweepMethod::Factorial),
        levels: Some(4),
        ranges: vec![(VariableId(0), [-0.1, 0.2])],
        curves: vec!["place".into(), "place".into()],
        ..Overrides::default()
    });
    let mut expected = SweepSettings { method: SweepMethod::Factorial, curves: vec![0], ..settings };
    expected.ranges.iter_mut().for_each(|range| range.levels = 4);
    (expected.ranges[0].low, expected.ranges[0].high) = (-0.1, 0.2);
    assert_eq!(found, Ok(expected));
    // A variable without bounds takes the levels of the others.
    let mut unbounded = model.clone();
    unbounded.sweeping.as_mut().unwrap().ranges.remove(0);
    let ranges = vec![(VariableId(0), [-0.1, 0.2])];
    let added = Request::of(&unbounded, Overrides { ranges, ..Overrides::default() }).unwrap().settings;
    assert_eq!((added.ranges[1].variable, added.ranges[1].levels), (VariableId(0), 5));

    let list = || Some((SweepSettings::spanned(&[VariableId(0)], &[vec![0.0]]), vec![vec![0.0]]));
    let range = |ends: [f64; 2]| Overrides { ranges: vec![(VariableId(0), ends)], ..Overrides::default() };
    for (overrides, message) in [
        (
            Overrides { designs: list(), method: Some(SweepMethod::Sobol), ..Overrides::default() },
            "has no method",
        ),
        (Overrides { designs: list(), levels: Some(3), ..Overrides::default() }, "has no number of levels"),
        (Overrides { designs: list(), ..range([-0.1, 0.1]) }, "a list of designs has no range"),
        (range([0.1, 0.1]), "the range of `rod` is not in ascending order"),
        (range([f64::NEG_INFINITY, 0.1]), "is not in ascending order"),
        (Overrides { levels: Some(1), ..Overrides::default() }, "1 levels are too few"),
        (Overrides { samples: Some(0), ..Overrides::default() }, "the sweep has no designs"),
        (
            Overrides { samples: Some(SweepSettings::MOST + 1), ..Overrides::default() },
            "the sweep has more than 1000000000 designs",
        ),
        (
            Overrides { curves: vec!["plaice".into()], ..Overrides::default() },
            "there is no measure named `plaice`",
        ),
    ] {
        expect(of(overrides), Fault::Override, message);
    }
    expect(Request::of(&bare(), Overrides::default()), Fault::Model, "the model has no metrics");
    let mut fixed = self::model(WHOLE);
    fixed.variables.iter_mut().for_each(|variable| variable.bounds = None);
    expect(Request::of(&fixed, Overrides::default()), Fault::Model, "no design variable has a range");
    assert_eq!(sweep::method("latin_hypercube"), Ok(SweepMethod::LatinHypercube));
    expect(sweep::method("grid"), Fault::Override, "there is no method named `grid`");
}

#[test]
fn an_unknown_name_has_the_closest_one_or_all() {
    let model = whole();
    let error = hardpoint_study::request::variable(&model, "radios").unwrap_err();
    assert_eq!(error.to_string(), "there is no design variable named `radios`; did you mean `radius`?");
    let error = hardpoint_study::request::variable(&model, "length").unwrap_err();
    assert_eq!(error.help, "there are rod, radius");
}

//! The page of a changed design: its curves are the solver's numbers, and round-off is no change.

use std::collections::HashSet;
use std::fs;
use std::path::Path;

use hardpoint::model::{Dimension, VariableId};
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::{ModelFile, Units};
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::page::{Curve, Design, DesignKind, Payload, Table, html};
use hardpoint_report::payload::{ChangedDesign, Request, payload};
use hardpoint_report::summary::Summary;
use hardpoint_report::whatif::WhatIfFacts;
use hardpoint_study::Magnitude;
use hardpoint_study::whatif::{WhatIf, add_coordinates, what_if};

fn gallery(name: &str) -> ModelFile {
    hardpoint_file::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name)).unwrap()
}

/// A change of these variables, in the file's units.
fn change(file: &ModelFile, of: &[(&str, f64)]) -> Vec<f64> {
    let mut change = vec![0.0; file.model.variables.len()];
    for (name, by) in of {
        let VariableId(v) = file.model.variable(name).unwrap();
        change[v] = file.units.to_si(file.model.variables[v].quantity, *by);
    }
    change
}

/// Page of a changed design, as made by the command, with its inputs.
struct WhatIfPage<'f> {
    analysis: Analysis<'f>,
    found: WhatIf,
    facts: WhatIfFacts,
    page: Payload,
}

fn changed<'f>(file: &'f ModelFile, of: &[(&str, f64)]) -> WhatIfPage<'f> {
    let analysis = Analysis::new(&file.model).unwrap();
    let today = analysis.run();
    let course = Course::of(&file.model, &today);
    let summary = Summary::new(file, &analysis, &course);
    let facts = WhatIfFacts::of_today(file, analysis.topology(), &today);
    let found = what_if(&analysis, today, &change(file, of));
    let facts = facts.changed(file, analysis.topology(), &found);
    let changed = Some(ChangedDesign::of(&file.model, &found));
    let page = payload(&Request { changed, ..Request::of(file, &analysis, &course, &summary) });
    WhatIfPage { analysis, found, facts, page }
}

/// All digits that the page holds of a curve.
fn text(curve: &Curve) -> String {
    format!("{:?}", curve.values())
}

fn design(page: &Payload, kind: DesignKind) -> &Design {
    page.designs.iter().find(|d| d.kind == kind).unwrap()
}

/// The output times that the page shows: every that many of those that were solved.
fn shown_steps(page: &Payload, today: &Solution) -> impl Iterator<Item = usize> + use<> {
    let times = &today.motion.times;
    let shown = |stride: &usize| {
        text(&times.iter().copied().step_by(*stride).collect::<Curve>()) == text(&page.times)
    };
    let stride = (1..times.len()).find(shown).unwrap();
    (0..times.len()).step_by(stride)
}

/// A curve of a changed design: in the user's units, today's number where the two differ by round-off, and 0 where it
/// is no more.
fn expected(
    (units, of, order): (Units, Dimension, usize),
    magnitude: Magnitude,
    pairs: impl Iterator<Item = [f64; 2]>,
) -> String {
    let settled = |[now, other]: [f64; 2]| {
        let round_off = magnitude.round_off(of, order);
        let settled = if (now - other).abs() <= round_off { now } else { other };
        units.from_si(of, if settled.abs() <= round_off { 0.0 } else { settled })
    };
    text(&pairs.map(settled).collect::<Curve>())
}

#[test]
fn curves_of_the_changed_design_are_those_of_the_solver() {
    let file = gallery("macpherson.toml");
    let (model, units) = (&file.model, file.units);
    let WhatIfPage { analysis, found, page, .. } =
        changed(&file, &[("tie_rod_inner_z", 20.0), ("lca_tilt", -0.5)]);
    let today: &Solution = &found.today;
    let exact = analysis.solve(Run::new().at(&found.change).without_sensitivities());
    let magnitude = Magnitude::of_motion(model, &today.motion);
    let steps = || shown_steps(&page, today);
    let kinds: Vec<DesignKind> = page.designs.iter().map(|d| d.kind).collect();
    assert_eq!(kinds, [DesignKind::Exact, DesignKind::FirstOrder, DesignKind::SecondOrder]);
    assert!(page.designs.iter().all(|d| d.quantities.len() == page.quantities.len()));

    for (m, output) in today.measured.outputs.iter().enumerate() {
        let curves = |kind| design(&page, kind).quantities[m].as_ref();
        let now = |k: usize, order: usize| today.measured.value(k, m)[order];
        let prediction = |k: usize, order: usize| {
            let changes = found.change.iter().enumerate().filter(|(_, by)| **by != 0.0);
            now(k, order)
                + changes.map(|(v, by)| by * today.measured.d(k, VariableId(v), m)[order]).sum::<f64>()
        };
        let [anew, first] = [DesignKind::Exact, DesignKind::FirstOrder].map(|kind| curves(kind).unwrap());
        for (order, [anew, first]) in
            [[&anew.value, &first.value], [&anew.rate, &first.rate], [&anew.accel, &first.accel]]
                .into_iter()
                .enumerate()
                .take(output.known.orders)
        {
            let as_is = (units, output.dimension, order);
            let solved = steps().map(|k| [now(k, order), exact.measured.value(k, m)[order]]);
            assert_eq!(text(anew), expected(as_is, magnitude, solved), "{} {order}", output.name);
            // The value comes along the whole change at once, the rates variable by variable.
            let linear = steps().map(|k| {
                [now(k, order), if order == 0 { found.predicted(k, m)[0] } else { prediction(k, order) }]
            });
            assert_eq!(text(first), expected(as_is, magnitude, linear), "{} {order}", output.name);
        }
        let second = curves(DesignKind::SecondOrder);
        assert_eq!(second.is_some(), output.known.by_position, "{}", output.name);
        if let Some(second) = second {
            let bent = steps().map(|k| [now(k, 0), found.predicted(k, m)[1]]);
            assert_eq!(text(&second.value), expected((units, output.dimension, 0), magnitude, bent));
            assert_eq!(text(&second.rate), text(&Curve::default()));
        }
        let shown = &page.quantities[m];
        assert_eq!(
            text(&shown.value),
            expected((units, output.dimension, 0), magnitude, steps().map(|k| [now(k, 0); 2]))
        );
        let moves = output.name != "lca_angle" || text(&anew.value) != text(&shown.value);
        assert!(moves, "the comparison is not of a curve with itself");
    }
}

#[test]
fn outputs_that_a_change_does_not_affect_have_todays_numbers() {
    let file = gallery("macpherson.toml");
    let WhatIfPage { page, .. } = changed(&file, &[("tie_rod_inner_z", 20.0)]);
    let body = |name: &str| page.bodies.iter().position(|b| b.name == name).unwrap();
    let angle = page.quantities.iter().position(|q| q.name == "lca_angle").unwrap();
    for design in &page.designs {
        let curves = design.quantities[angle].as_ref().unwrap();
        assert_eq!(text(&curves.value), text(&page.quantities[angle].value), "{}", design.name);
    }
    let exact = design(&page, DesignKind::Exact);
    for name in ["ground", "lca", "rack"] {
        assert_eq!(text(&exact.poses[body(name)]), text(&page.bodies[body(name)].poses), "{name}");
    }
    assert_ne!(text(&exact.poses[body("knuckle")]), text(&page.bodies[body("knuckle")].poses));

    // Of all hardpoints, the inner end of the tie rod moves, 20 mm up.
    for (b, (track, changed)) in page.bodies.iter().zip(&exact.skeletons).enumerate() {
        for ((label, now), other) in track.labels.iter().zip(&track.skeleton).zip(changed) {
            let up = if b == body("rack") && label == "tie_rod_inner" { 20.0 } else { 0.0 };
            let apart = (0..3).map(|axis| other[axis] - now[axis] - [0.0, 0.0, up][axis]);
            assert!(apart.map(f64::abs).fold(0.0, f64::max) < 1e-9, "{} {label}", track.name);
        }
    }
}

#[test]
fn a_measure_that_a_driver_prescribes_has_no_change() {
    let file = gallery("wheel_clearance.toml");
    let WhatIfPage { facts, found, .. } = changed(&file, &[("tie_rod_inner_z", 2.0)]);
    let measure = |name: &str| facts.measures.iter().find(|m| m.measure == name).unwrap();
    let travel = measure("front_left.wheel_travel");
    // The re-solved curve differs by round-off.
    let m = found.today.measured.outputs.iter().position(|o| o.name == "front_left.wheel_travel").unwrap();
    let off = |k: usize| (found.exact(k, m) - found.today.measured.value(k, m)[0]).abs();
    assert!((0..found.len()).map(off).fold(0.0, f64::max) < 1e-12);
    assert_eq!((travel.change, travel.linear_up_to, travel.exactly_linear), (Some(0.0), None, false));
    assert_eq!(travel.errors, Some([Some(0.0); 2]));
    let toe = measure("front_left.toe");
    assert!(toe.change.is_some_and(|x| x.abs() > 1e-3) && toe.linear_up_to.is_some_and(|x| x > 1.0));
}

/// Metrics, and measures at one time: exact, and predicted from the nominal derivatives.
#[test]
fn values_of_the_changed_design_are_those_of_its_curves() {
    let file = gallery("macpherson.toml");
    let WhatIfPage { found, page, .. } = changed(&file, &[("tie_rod_inner_z", 20.0), ("lca_tilt", -0.5)]);
    assert!(page.designs.iter().all(|d| d.values.len() == page.values.len()));
    let exact = design(&page, DesignKind::Exact);
    for (value, found_value) in page.values.iter().zip(&exact.values).skip(file.model.metrics.len()) {
        let (m, t) = (value.quantity.unwrap(), value.time.unwrap());
        let k = found.today.motion.times.iter().position(|time| *time == t).unwrap();
        let solved = file.units.from_si(found.today.measured.outputs[m].dimension, found.exact(k, m));
        assert!((found_value.unwrap() - solved).abs() < 1e-6, "{}", value.name);
        for kind in [DesignKind::FirstOrder, DesignKind::SecondOrder] {
            let at = page.values.iter().position(|v| v.name == value.name && v.what == value.what).unwrap();
            let Some(prediction) = design(&page, kind).values[at] else { continue };
            let order = usize::from(kind == DesignKind::SecondOrder);
            let linear =
                file.units.from_si(found.today.measured.outputs[m].dimension, found.predicted(k, m)[order]);
            assert!((prediction - linear).abs() < 1e-6, "{} {kind:?}", value.name);
        }
    }
}

#[test]
fn inadmissible_variables_have_no_prediction() {
    let file = gallery("four_bar.toml");
    let file = {
        let mut file = file;
        hardpoint_study::whatif::add_tilts(&mut file.model);
        file
    };
    let tilt = file.model.variables.iter().map(|v| v.name.clone()).find(|v| v.ends_with(".tilt_x")).unwrap();
    let WhatIfPage { found, page, .. } = changed(&file, &[(&tilt, 1.0)]);
    let prediction = page.designs.iter().filter(|d| d.kind != DesignKind::Exact).count();
    assert_eq!(prediction == 0, !found.cannot_follow.is_empty(), "{tilt}");
}

#[test]
fn the_page_opens_on_the_requested_outputs_and_ranks_each_variable_once() {
    let mut file = gallery("macpherson.toml");
    add_coordinates(&mut file.model);
    let WhatIfPage { facts, page, .. } = changed(&file, &[("tie_rod_inner_z", 20.0)]);
    let asked = ["camber", "toe"].map(String::from);
    let page = facts.page(page, &asked, Some("wheel_travel"), &|name| asked.iter().any(|a| a == name));
    let quantity = |name: &str| page.quantities.iter().position(|q| q.name == name);
    assert_eq!((page.first, page.over), (quantity("camber"), quantity("wheel_travel")));
    let study = page.study.unwrap();
    let titles: Vec<&str> = study.tables.iter().map(|t| t.title.as_str()).collect();
    let expected = [
        "The change",
        "What if tie_rod_inner_z by 20 mm",
        "Most influential variables of toe",
        "Most influential variables of camber",
    ];
    assert_eq!(titles, expected);
    let measures: Vec<&str> = study.tables[1].rows.iter().map(|row| row[0].as_str()).collect();
    assert_eq!(measures, ["toe", "camber"]);

    let mut seen = HashSet::new();
    assert!(facts.influence.iter().all(|i| seen.insert((&i.measure, &i.variable))));
    // A coordinate that is already a variable of the model is not ranked twice.
    assert!(!facts.influence.iter().any(|i| i.variable == "tie_rod_inner.z"));
    // Variables without effect are not ranked.
    let ranked = facts.ranking("lca_angle", usize::MAX);
    assert!(ranked.rows.len() > 3 && !ranked.rows.iter().any(|row| row[1].starts_with("tie_rod")));
}

#[test]
fn without_a_change_it_is_the_page_of_today_with_the_ranking() {
    let file = gallery("four_bar.toml");
    let analysis = Analysis::new(&file.model).unwrap();
    let today = analysis.run();
    let course = Course::of(&file.model, &today);
    let summary = Summary::new(&file, &analysis, &course);
    let of_run = payload(&Request::of(&file, &analysis, &course, &summary));
    let facts = WhatIfFacts::of_today(&file, analysis.topology(), &today);
    let page = facts.page(of_run.clone(), &[], None, &|_| true);
    assert!(page.designs.is_empty() && page.over.is_none() && page.first == of_run.first);
    let measures = file.model.measures.len();
    let tables = |checks: &[Table]| serde_json::to_string(checks).unwrap();
    assert_eq!(tables(&page.checks), tables(&of_run.checks));
    let ranked = page.study.unwrap().tables;
    assert_eq!(ranked.len(), measures);
    assert_eq!(ranked[2].note, "No variable moves it.", "{}", ranked[2].title);
}

/// The four-bar with a metric of each sort: of the whole curve, and at one place of it.
fn four_bar_with_metrics() -> ModelFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/four_bar.toml");
    let metrics = "
[metrics.swing]
of = \"rocker_angle\"
take = \"range\"
[metrics.quarter]
of = \"rocker_angle\"
over = \"crank_angle\"
take = \"value\"
at = 90
";
    let text = fs::read_to_string(path).unwrap() + metrics;
    hardpoint_file::parse(&text, "four_bar.toml").unwrap_or_else(|e| panic!("{}", e.render(false)))
}

/// Known values of a curve, with this number of values per step.
fn known(curve: &Curve, parts: usize) -> Vec<bool> {
    curve.values().chunks(parts).map(|step| step.iter().all(|x| x.is_finite())).collect()
}

#[test]
fn a_changed_design_that_locks_has_gaps_and_the_page_has_the_reason() {
    let file = four_bar_with_metrics();
    // With its pivots 250 mm apart, the crank no longer turns round.
    let WhatIfPage { found, facts, page, .. } = changed(&file, &[("D_x", -150.0)]);
    let (solved, all) = (found.exact.motion.len(), found.today.motion.len());
    assert!(0 < solved && solved < all && page.times.values().len() == all, "{solved} of {all}");
    let there: Vec<bool> = (0..all).map(|k| k < solved).collect();
    assert_eq!(page.designs.len(), 3);
    for design in &page.designs {
        for (curves, quantity) in design.quantities.iter().zip(&page.quantities) {
            let Some(curves) = curves else { continue };
            for curve in [&curves.value, &curves.rate, &curves.accel] {
                assert!(
                    curve.values().is_empty() || known(curve, 1) == there,
                    "{} {}",
                    design.name,
                    quantity.name
                );
            }
            assert_eq!(known(&quantity.value, 1), vec![true; all], "{}", quantity.name);
        }
        assert!(design.poses.iter().all(|poses| known(poses, 7) == there));
        assert!(design.margin.iter().all(|margin| known(margin, 1) == there));
    }
    assert!(!page.status.complete);
    let expected = format!(
        "The changed design was solved for {solved} of {all} steps: the mechanism cannot move beyond t = 0.7202652 s, with `motor` at 259.3 deg (HP0401). Today's design: all {all} steps were solved."
    );
    assert_eq!(page.status.message, expected);

    // The range of a part of the curve is not that of the whole; where the crank is at 90 deg, both designs were
    // solved.
    let exact = design(&page, DesignKind::Exact);
    let value = |name: &str| exact.values[page.values.iter().position(|v| v.name == name).unwrap()];
    assert_eq!(value("swing"), None);
    let quarter = value("quarter").unwrap();
    let metric = |name: &str| facts.metrics.iter().find(|m| m.name == name).unwrap();
    assert_eq!((metric("swing").exact, metric("quarter").exact), (None, Some(quarter)));
    assert!(metric("swing").today.is_some() && (quarter - metric("quarter").today.unwrap()).abs() > 1.0);
}

#[test]
fn a_changed_design_that_does_not_assemble_has_only_the_reason_on_its_page() {
    let file = gallery("double_wishbone.toml");
    let WhatIfPage { found, facts, page, .. } = changed(&file, &[("tie_rod_outer_y_fixed_length", 1000.0)]);
    assert!(found.exact.motion.is_empty() && found.is_empty());
    let [exact] = &page.designs[..] else { panic!("nothing is predicted of what is not there") };
    let nothing = |curve: &Curve, parts: usize| !known(curve, parts).contains(&true);
    assert!(exact.poses.iter().all(|poses| nothing(poses, 7)));
    assert!(exact.quantities.iter().flatten().all(|q| nothing(&q.value, 1) && nothing(&q.rate, 1)));
    assert!(exact.values.iter().all(Option::is_none));
    assert!(!page.status.complete);
    let why = "The changed design could not be solved: the mechanism does not assemble: joint `tie_rod` stays open (HP0406).";
    assert!(page.status.message.starts_with(why), "{}", page.status.message);
    let page = facts.page(page, &[], None, &|_| true);
    assert!(html(&page).is_ok());

    // The nominal design is written anyway.
    let stop = found.exact.stop.as_ref().unwrap();
    let diagnostic = diagnose::stop_of_changed(&file, stop, 0);
    assert!(
        diagnostic.message.starts_with("the changed design: the mechanism does not assemble"),
        "{diagnostic:?}"
    );
    assert!(
        diagnostic.notes.contains(&"0 of 401 steps of the changed design were solved".to_owned()),
        "{diagnostic:?}"
    );
}

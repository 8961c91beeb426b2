//! Elastic joints in equilibrium: the rigid mechanism alongside, and deflections.

use std::fs;
use std::path::Path;

use hardpoint::model::Model;
use hardpoint::{Analysis, Run};
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::deflection::DeflectionFact;
use hardpoint_report::page::{DesignKind, Payload};
use hardpoint_report::payload::{Request, payload};
use hardpoint_report::summary::Summary;

/// Template of a front axle on bushings, with some text replaced, in a case.
fn axle(case: &str, replaced: &[[&str; 2]]) -> ModelFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hardpoint-cli/templates/k-and-c.toml");
    let mut text = fs::read_to_string(path).unwrap();
    for [from, to] in replaced {
        assert!(text.contains(from));
        text = text.replacen(from, to, 1);
    }
    let file = hardpoint_file::parse(&text, "axle.toml").unwrap_or_else(|e| panic!("{e}"));
    let case = file.model.cases.iter().position(|c| c.name == case).unwrap();
    file.in_case(hardpoint::model::CaseId(case))
}

fn page(file: &ModelFile) -> Payload {
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let course = Course::of(&file.model, &solution);
    let summary = Summary::new(file, &analysis, &course);
    payload(&Request::of(file, &analysis, &course, &summary))
}

#[test]
fn page_of_an_elastic_mechanism_has_the_rigid_one_with_the_same_drivers() {
    let file = axle("parallel_travel", &[]);
    let page = page(&file);
    let [rigid] = &page.designs[..] else { panic!("{} designs", page.designs.len()) };
    assert_eq!((rigid.kind, rigid.name.as_str()), (DesignKind::Rigid, "rigid"));
    assert_eq!(rigid.change, vec![0.0; page.variables.len()]);
    assert!(rigid.loads.is_empty() && rigid.poses.len() == page.bodies.len());

    let without = Model { equilibrium: None, ..file.model.clone() };
    let solved = Analysis::new(&without).unwrap().solve(Run::new().without_sensitivities());
    let toe = solved.measured.index("left.toe").unwrap();
    let curve = rigid.quantities[toe].as_ref().unwrap().value.values();
    assert_eq!(curve.len(), 41);
    for (k, shown) in curve.iter().enumerate() {
        let exact = solved.measured.value(k, toe)[0].to_degrees();
        assert!((f64::from(*shown) - exact).abs() < 1e-5, "{shown} instead of {exact} at {k}");
    }
    // What a rigid mechanism has no meaning for, or another one.
    for name in ["left_toe_per_side", "left_wheel_load"] {
        let index = page.quantities.iter().position(|q| q.name == name).unwrap();
        assert!(rigid.quantities[index].is_none(), "{name}");
    }
    let value = |name: &str| page.values.iter().position(|v| v.name == name).unwrap();
    let [elastic, as_rigid] =
        [page.values[value("toe_over_travel")].value, rigid.values[value("toe_over_travel")]];
    assert!((elastic.unwrap() - as_rigid.unwrap()).abs() > 0.1);
}

#[test]
fn deflections_are_curves_and_the_largest_of_each_direction_is_in_a_table() {
    let file = axle("braking", &[]);
    let analysis = Analysis::new(&file.model).unwrap();
    let loads = analysis.loads(&[]);
    let facts = DeflectionFact::all(&file.model, file.units, &loads);
    // Eight bushings in six directions.
    assert_eq!(facts.len(), 48);
    let of = |direction: &str| {
        facts.iter().find(|d| d.element == "left_lca_front" && d.direction == direction).unwrap()
    };
    // Stiffnesses of the template, N/mm and N m/deg; there is no preload.
    let stiffnesses =
        [("along x", 9000.0), ("along y", 8000.0), ("along z", 1200.0), ("about x", 60.0), ("about z", 1.4)];
    for (direction, stiffness) in stiffnesses {
        let fact = of(direction);
        let (way, force) = (fact.deflection.unwrap(), fact.force.unwrap());
        assert!((force + stiffness * way).abs() <= 1e-9 * force.abs(), "{direction}: {way} and {force}");
    }
    // Braking pulls the arm to the rear, and most at the full force.
    let [along, across] = ["along z", "along x"].map(of);
    assert_eq!((along.time, along.unit.as_str(), along.force_unit.as_str()), (Some(1.0), "mm", "N"));
    assert_eq!(of("about x").unit, "deg");
    assert!(along.deflection.unwrap().abs() > across.deflection.unwrap().abs());

    let page = page(&file);
    let curve = page.quantities.iter().find(|q| q.name == "left_lca_front along z").unwrap();
    assert_eq!((curve.group.as_str(), curve.unit.as_str()), ("deflection", "mm"));
    let last = *curve.value.values().last().unwrap();
    assert!((f64::from(last) - along.deflection.unwrap()).abs() < 1e-6);
    assert!(page.checks.iter().any(|table| table.title == "Deflections" && table.rows.len() == 48));
}

#[test]
fn rigid_mechanism_under_forces_alone_has_positions_but_no_metrics() {
    let file = axle("lateral_in_phase", &[]);
    let page = page(&file);
    let rigid = &page.designs[0];
    let toe = page.quantities.iter().position(|q| q.name == "left.toe").unwrap();
    let curve = rigid.quantities[toe].as_ref().unwrap().value.values();
    assert!(curve.iter().all(|x| x.abs() < 1e-6), "{curve:?}");
    let metrics = file.model.metrics.len();
    assert!(metrics >= 4 && rigid.values[..metrics].iter().all(Option::is_none));
    assert!(page.values[..metrics].iter().all(|v| v.value.is_some()));
}

#[test]
fn forces_that_vary_are_quantities_with_the_sign_of_their_laws() {
    let file = axle("lateral_in_phase", &[]);
    let page = page(&file);
    let forces: Vec<_> = page.quantities.iter().enumerate().filter(|(_, q)| q.group == "force").collect();
    let shown: Vec<(&str, &str, f32)> = forces
        .iter()
        .map(|(_, q)| (q.name.as_str(), q.unit.as_str(), *q.value.values().last().unwrap()))
        .collect();
    // The others have no law here.
    assert_eq!(shown, [("left_side", "N", 1000.0), ("right_side", "N", -1000.0)]);
    // The curves of the rigid mechanism can be drawn over them.
    for (k, force) in forces {
        let of_rigid = &page.designs[0].quantities[k].as_ref().unwrap().value;
        assert_eq!(of_rigid.values(), force.value.values());
    }
}

#[test]
fn rigid_mechanism_is_left_out_with_a_sentence_if_only_forces_hold_it() {
    let released = "[equilibrium]\nreleased = [\"left_bump\"]\n";
    // Slopes over a released driver have no meaning.
    let without = [
        ["[equilibrium]\n", released],
        [", \"bump_steer\", \"bump_camber\"]", "]"],
        ["\nbump_steer = {", "\n# {"],
        ["\nroll_steer = {", "\n# {"],
        ["\nleft_steer_in_bump = {", "\n# {"],
        ["\nleft_steer_in_roll = {", "\n# {"],
    ];
    let page = page(&axle("braking", &without));
    assert!(page.designs.is_empty());
    let notes: Vec<&String> = page.notes.iter().filter(|n| n.contains("rigid mechanism")).collect();
    let [note] = notes[..] else { panic!("{:?}", page.notes) };
    assert!(note.starts_with("The rigid mechanism is not shown: ") && note.contains("`left_bump`"), "{note}");
}

#[test]
fn a_compliance_per_a_force_of_size_zero_reports_why_it_has_no_value() {
    let zero = [
        "left_align = { type = \"wheel_force\", wheel = \"left\", about_up = 1",
        "left_align = { type = \"wheel_force\", wheel = \"left\", about_up = 0",
    ];
    let notes = |file: &ModelFile| {
        let analysis = Analysis::new(&file.model).unwrap();
        let course = Course::of(&file.model, &analysis.run());
        let summary = Summary::new(file, &analysis, &course);
        let found = hardpoint_report::diagnose::all(file, &summary, &course, None);
        let text = |d: &hardpoint_file::Diagnostic| format!("{} {} {}", d.code, d.message, d.notes.join(" "));
        found.iter().map(text).collect::<Vec<_>>().join("\n")
    };
    let with_size = axle("steer", &[]);
    let shown = notes(&with_size);
    assert!(!shown.contains("HP0409"), "{shown}");
    // Moments are in N m, whatever the unit of length.
    let page = page(&with_size);
    let found = page.quantities.iter().find(|q| q.name == "left_toe_per_align").unwrap();
    assert_eq!(found.unit, "deg/(N*m)");
    let shown = notes(&axle("steer", &[zero]));
    assert!(shown.contains("HP0409") && shown.contains("the size of `left_align` is zero"), "{shown}");
}

/// A subframe on bushings, with both halves of a bar on it: the solved mechanism has a joint more than the file.
#[test]
fn redundant_constraints_on_a_body_that_only_forces_hold_are_named() {
    let bushing = "x = 1000, y = 1000, z = 1000, about_x = 100, about_y = 100, about_z = 100 }";
    let text = format!(
        r#"
name = "bar on a floating frame"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ a = [0, -300, 0], b = [0, 300, 0], m = [0, 0, 0], p = [100, 200, 0], q = [100, -200, 0] }}
bodies = {{ frame = {{}}, left = {{}}, right = {{}} }}
[joints]
left_hinge = {{ type = "revolute", bodies = ["frame", "left"], at = "m", axis = "y" }}
right_hinge = {{ type = "revolute", bodies = ["frame", "right"], at = "m", axis = "y" }}
twist = {{ type = "revolute", bodies = ["left", "right"], at = "m", axis = "y" }}
[points]
p = {{ body = "left", at = "p" }}
[drivers]
up = {{ point = "p", along = "z", law = "10*t" }}
[forces]
ba = {{ type = "bushing", from = {{ body = "ground", at = "a" }}, to = {{ body = "frame", at = "a" }}, {bushing}
bb = {{ type = "bushing", from = {{ body = "ground", at = "b" }}, to = {{ body = "frame", at = "b" }}, {bushing}
s = {{ type = "spring", from = {{ body = "ground", at = [100, -200, 200] }}, to = {{ body = "right", at = "q" }}, stiffness = 10 }}
bar = {{ type = "torsion_spring", joint = "twist", stiffness = 12 }}
[equilibrium]
[time]
end = 1
steps = 4
"#
    );
    let file = hardpoint_file::parse(&text, "bar.toml").unwrap_or_else(|e| panic!("{e}"));
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    let summary = Summary::new(&file, &analysis, &Course::of(&file.model, &solution));
    let [redundancy] = &summary.model.redundancy[..] else { panic!("{:?}", summary.model.redundancy) };
    assert_eq!(redundancy.count, 5);
    assert_eq!(redundancy.joints, ["left_hinge", "right_hinge", "twist"]);
}

/// A body that is pushed along x beyond the curves of its bushing and its springs.
#[test]
fn curves_that_end_before_the_largest_deflection_are_named_with_it() {
    let text = r#"
name = "pushed"
units = { length = "mm", angle = "deg" }
bodies = { b = {} }
points = { p = { body = "b", at = [100, 0, 0] } }
equilibrium = {}
time = { end = 1, steps = 4 }
[joints]
j = { type = "fixed", bodies = ["ground", "b"], at = [0, 0, 0] }
[forces]
push = { type = "force", at = "p", force = 1, along = "x", law = "100*t" }
soft = { type = "elastic_joint", joint = "j", curve_x = [[-1, -40], [0, 0], [1, 40]] }
pulled = { type = "spring", from = { body = "ground", at = [0, 0, 0] }, to = "p", extension = [[-1, 0], [0, 0], [1, 10], [2, 10]] }
pressed = { type = "spring", from = { body = "ground", at = [200, 0, 0] }, to = "p", compression = [[-1, 0], [0, 0], [1.5, 5]] }
"#;
    let file = hardpoint_file::parse(text, "pushed.toml").unwrap_or_else(|e| panic!("{e}"));
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let x = solution.measured.index("p.x").unwrap();
    let largest = 1e3 * solution.measured.value(4, x)[0] - 100.0;
    assert!(largest > 2.0, "{largest}");
    let course = Course::of(&file.model, &solution);
    let summary = Summary::new(&file, &analysis, &course);
    let found = hardpoint_report::diagnose::all(&file, &summary, &course, None);
    let ends: Vec<&str> = found.iter().filter(|d| d.code == "HP0414").map(|d| d.message.as_str()).collect();
    // The curve of `pulled` is constant at both ends.
    let there = hardpoint_report::figures::with_unit(largest, "mm");
    assert_eq!(
        ends,
        [
            format!("`curve_x` of `soft` ends at 1 mm, and its deflection is {there} at t = 1 s"),
            format!("`compression` of `pressed` ends at 1.5 mm, and its deflection is {there} at t = 1 s"),
        ]
    );
}

#[test]
fn a_motion_that_ends_before_its_first_output_time_has_a_summary() {
    const SNAPPED: &str = r#"
        name = "hinge pulled over by a spring"
        units = { length = "mm", angle = "deg" }
        hardpoints = { A = [0, 0, 0], B = [100, 0, 0] }
        bodies = { arm = {} }
        joints.A = { type = "revolute", bodies = ["ground", "arm"], at = "A", axis = "y", axis2 = "x" }
        points.B = { body = "arm", at = "B" }
        drivers.turn = { joint = "A", law = "10 + t" }
        forces.hinge = { type = "elastic_joint", joint = "A", x = 100, about_x = 1, about_z = 2 }
        forces.pull = { type = "spring", from = { body = "ground", at = [0, 0, 100] }, to = "B", stiffness = 1, preload = 1e7 }
        equilibrium = {}
        metrics.low = { of = "B.z", take = "min" }
        time = { end = 1, steps = 2 }
    "#;
    let file = hardpoint_file::parse(SNAPPED, "snapped.toml").unwrap_or_else(|e| panic!("{e}"));
    let analysis = Analysis::new(&file.model).unwrap();
    let course = Course::of(&file.model, &analysis.run());
    let summary = Summary::new(&file, &analysis, &course);
    assert_eq!((summary.steps.solved, summary.metrics[0].value), (0, None));
    assert!(summary.stop.is_some());
}

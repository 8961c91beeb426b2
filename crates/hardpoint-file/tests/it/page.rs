//! Plots of the page and named designs: resolved names, values in SI, and errors in files.

use hardpoint::model::{OutputSource, VariableId};
use hardpoint_file::parse;

use crate::diagnostics::{VALID, snapshot};

const KEPT: &str = "\n[measures.swing]\ntype = \"coordinate\"\njoint = \"J1\"\n\n[designs.leaning]\nlean = -2\nB_x = 1.5\n\n[designs.\"long way\"]\nB_y = 4\n\n\
    [page]\nplots = [{ y = [\"height\"], over = \"P.x\" }, { y = [\"P.x\", \"P.y\"] }, { y = [\"P.z\"], over = \"time\" }]\n";

fn whole(text: &str) -> String {
    format!("{VALID}{text}")
}

#[test]
fn plots_are_outputs_over_time_or_another_output() {
    let model = parse(&whole(KEPT), "four-bar.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let point = |axis| OutputSource::Point(hardpoint::model::PointId(0), axis);
    let height = model.measures.iter().position(|m| m.name == "height").unwrap();
    let found: Vec<_> = model.plots.iter().map(|plot| (plot.y.clone(), plot.over)).collect();
    assert_eq!(
        found,
        [
            (vec![OutputSource::Measure(height)], Some(point(0))),
            (vec![point(0), point(1)], None),
            (vec![point(2)], None),
        ]
    );
}

#[test]
fn designs_are_changes_in_si_of_the_variables_that_they_name() {
    let model = parse(&whole(KEPT), "four-bar.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let of = |name: &str| model.variables.iter().position(|v| v.name == name).map(VariableId).unwrap();
    let [leaning, long] = &model.designs[..] else { panic!("{:?}", model.designs) };
    assert_eq!((leaning.name.as_str(), long.name.as_str()), ("leaning", "long way"));
    let mut changes = leaning.changes.clone();
    changes.sort_by_key(|(variable, _)| variable.0);
    assert_eq!(changes, [(of("B_x"), 1.5e-3), (of("lean"), (-2.0_f64).to_radians())]);
    assert_eq!(long.changes, [(of("B_y"), 4e-3)]);
}

#[test]
fn a_parameter_has_its_value_in_a_design() {
    let text = VALID.replacen(
        "[hardpoints]",
        "[parameters]\nL = { value = 100, unit = \"length\" }\n\n[hardpoints]",
        1,
    );
    let text = text.replacen("B = [100, 50, 0]", "B = [\"L\", 50, 0]", 1) + "\n[designs.long]\nL = 110\n";
    let model = parse(&text, "four-bar.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let [(_, by)] = model.designs[0].changes[..] else { panic!("{:?}", model.designs) };
    assert!((by - 10e-3).abs() < 1e-15, "{by}");
}

#[test]
fn broken_pages_and_designs() {
    let broken = |name: &str, old: &str, new: &str| {
        assert!(KEPT.contains(old), "{old}");
        snapshot(name, &whole(&KEPT.replacen(old, new, 1)));
    };
    broken("plot_of_unknown_measure", "[\"height\"]", "[\"hight\"]");
    broken("plot_over_unknown_measure", "over = \"P.x\"", "over = \"P.w\"");
    broken("plot_over_a_driver", "over = \"P.x\"", "over = \"turn\"");
    broken("plot_over_itself", "y = [\"height\"]", "y = [\"P.x\"]");
    broken("plot_of_one_measure_twice", "[\"P.x\", \"P.y\"]", "[\"P.x\", \"P.x\"]");
    broken("plot_of_nothing", "y = [\"height\"]", "y = []");
    broken("plot_without_ordinate", "y = [\"height\"], ", "");
    broken("plot_of_different_units", "[\"P.x\", \"P.y\"]", "[\"P.x\", \"swing\"]");
    broken("plot_with_misspelt_key", "over = \"P.x\"", "ovre = \"P.x\"");
    broken("plot_as_a_name", "{ y = [\"height\"], over = \"P.x\" }", "\"height\"");
    broken("page_with_misspelt_key", "plots =", "plot =");
    broken("design_of_unknown_variable", "lean = -2", "laen = -2");
    broken("design_of_a_point", "B_x = 1.5", "B = 1.5");
    broken("design_of_a_text", "lean = -2", "lean = \"-2 deg\"");
    broken("design_of_nothing", "B_y = 4\n", "");
    broken("design_that_is_not_finite", "B_y = 4", "B_y = inf");
    snapshot("design_as_a_number", &format!("designs.long = 3\n{VALID}"));
    snapshot("page_as_a_text", &format!("page = \"toe\"\n{VALID}"));
}

#[test]
fn names_of_what_could_not_be_read_are_not_reported_again() {
    let text = whole(KEPT).replacen("type = \"position\"", "type = \"positron\"", 1);
    let found = parse(&text, "four-bar.toml").unwrap_err();
    assert_eq!(found.list().len(), 1, "{found}");
}

//! Diagnostics for mistakes in cases, targets and optimisations: the full texts are in `tests/snapshots`.

use hardpoint_file::{parse, read};

use crate::diagnostics::{VALID, diagnosed, snapshot};

/// Appended to the valid model, whose rod and variables are there for it.
const STUDIES: &str = r#"
[joints.rod]
type = "leg"
bodies = ["crank", "rocker"]
at = ["B", "D"]

[drivers.slide]
joint = "J4"
coordinate = "displacement"
law = 0

[design.C]
move = "C"
along = "xyz"
bounds = [-10, 10]

[design.D_x]
move = "D"
along = "x"

[metrics.error]
of = "height"
take = "rms"
target = [[0, 150], [1, 160]]

[metrics.top]
of = "height"
take = "max"
case = "fast"

[cases.slow]
laws = { turn = "36*t", slide = 5 }
other_drivers = "fixed"

[cases.fast]
laws = { turn = "720*t" }
time = { end = 0.5, steps = 20 }

[optimize]
variables = ["C_x", "C_y"]
starts = 4
min_margin = 0.02

[optimize.goals]
error = { weight = 10 }
high = { metric = "top", target = 180 }

[optimize.limits]
room = { hardpoint = "C", x = [290, 310], y = { min = 190 } }
apart = { between = ["A", "C"], min = 100 }
top = { metric = "top", max = 300 }
"#;

fn with(old: &str, new: &str) -> String {
    assert!(STUDIES.contains(old), "{old}");
    VALID.to_owned() + &STUDIES.replacen(old, new, 1)
}

fn broken(name: &str, old: &str, new: &str) {
    snapshot(name, &with(old, new));
}

#[test]
fn the_valid_studies_are_valid() {
    parse(&with("", ""), "four-bar.toml").unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn cases() {
    let laws = "laws = { turn = \"720*t\" }";
    broken("case_of_unknown_driver", laws, "laws = { turm = \"720*t\" }");
    broken("case_with_law_that_cannot_be_read", laws, "laws = { turn = \"720*tt\" }");
    broken("case_with_law_not_finite", laws, "laws = { turn = \"1/t\" }");
    broken("case_with_laws_of_a_text", laws, "laws = \"turn\"");
    broken("case_where_nothing_moves", laws, "laws = { turn = 30 }");
    broken("case_with_unknown_rest", "other_drivers = \"fixed\"", "other_drivers = \"free\"");
    broken("case_without_steps", "time = { end = 0.5, steps = 20 }", "time = { end = 0.5 }");
    broken("case_with_misspelt_key", "other_drivers = \"fixed\"", "law = \"t\"");
    broken(
        "case_with_law_in_a_missing_file",
        laws,
        "laws = { turn = { type = \"table\", file = \"turn.csv\" } }",
    );
    broken(
        "case_that_leaves_a_driver_without_law",
        "law = 0\n",
        "\n[cases.all]\nlaws.turn = \"t\"\nother_drivers = \"as_in_model\"\n",
    );
    broken("metric_of_unknown_case", "case = \"fast\"", "case = \"fats\"");
    snapshot(
        "metric_of_a_case_where_there_is_none",
        &format!("{VALID}\n[metrics.m]\nof = \"height\"\ntake = \"max\"\ncase = \"bump\"\n"),
    );
}

#[test]
fn goals() {
    let error = "error = { weight = 10 }";
    broken("goal_of_unknown_metric", error, "eror = { weight = 10 }");
    broken("goal_of_a_measure", error, "height = { weight = 10 }");
    broken("goal_of_negative_weight", error, "error = { weight = -10 }");
    broken("goal_of_an_rms_with_target", error, "error = { target = 0.1 }");
    broken("goal_that_is_a_number", error, "error = 10");
    broken("goal_with_misspelt_key", error, "error = { wieght = 10 }");
    broken(
        "optimize_without_goals",
        "[optimize.goals]\nerror = { weight = 10 }\nhigh = { metric = \"top\", target = 180 }\n",
        "",
    );
    broken(
        "optimize_with_empty_goals",
        "[optimize.goals]\nerror = { weight = 10 }\nhigh = { metric = \"top\", target = 180 }\n",
        "goals = {}\n",
    );
    broken(
        "optimize_with_goals_in_a_list",
        "[optimize.goals]\nerror = { weight = 10 }\nhigh = { metric = \"top\", target = 180 }\n",
        "goals = [\"error\"]\n",
    );
}

#[test]
fn variables() {
    let names = "variables = [\"C_x\", \"C_y\"]";
    broken("optimize_of_unknown_variable", names, "variables = [\"C_x\", \"C_w\"]");
    broken("optimize_of_a_variable_that_is_several", names, "variables = [\"C\"]");
    broken("optimize_of_a_variable_without_bounds", names, "variables = [\"C_x\", \"C_y\", \"D_x\"]");
    broken("optimize_of_a_variable_twice", names, "variables = [\"C_x\", \"C_y\", \"C_x\"]");
    broken("optimize_of_no_variables", names, "variables = []");
    broken("optimize_of_one_variable_as_text", names, "variables = \"C_x\"");
    snapshot("optimize_where_nothing_has_bounds", &with(names, "").replace("bounds = [-10, 10]\n", ""));
    broken("optimize_with_margin_above_one", "min_margin = 0.02", "min_margin = 2");
    broken("optimize_with_no_starts", "starts = 4", "starts = 0");
    broken("optimize_with_half_a_start", "starts = 4", "starts = 1.5");
    broken("optimize_with_misspelt_key", "starts = 4", "start = 4");
    snapshot("optimize_that_is_a_list", &format!("{VALID}\n[[optimize]]\ngoals = {{}}\n"));
}

#[test]
fn limits() {
    let (apart, top) =
        ("apart = { between = [\"A\", \"C\"], min = 100 }", "top = { metric = \"top\", max = 300 }");
    broken("limit_of_two_kinds", apart, "apart = { between = [\"A\", \"C\"], hardpoint = \"C\", min = 100 }");
    broken("limit_of_nothing", apart, "apart = { min = 100 }");
    broken("limit_without_bounds", apart, "apart = { between = [\"A\", \"C\"] }");
    broken("limit_that_falls", apart, "apart = { between = [\"A\", \"C\"], min = 500, max = 100 }");
    broken("limit_of_a_distance_below_zero", apart, "apart = { between = [\"A\", \"C\"], max = -1 }");
    broken("limit_of_a_point_from_itself", apart, "apart = { between = [\"C\", \"C\"], min = 1 }");
    broken("limit_of_unknown_hardpoint", apart, "apart = { between = [\"A\", \"CC\"], min = 100 }");
    broken(
        "limits_that_contradict",
        top,
        "top = { metric = \"top\", max = 100 }\nalso = { metric = \"top\", min = 120 }",
    );
    broken("limit_that_no_variable_changes", apart, "apart = { between = [\"A\", \"D\"], min = 100 }");
    broken("box_that_no_variable_moves", "y = { min = 190 }", "z = [-5, 5]");
    broken("box_that_falls", "x = [290, 310]", "x = [310, 290]");
    broken(
        "box_without_axis",
        "room = { hardpoint = \"C\", x = [290, 310], y = { min = 190 } }",
        "room = { hardpoint = \"C\", min = 3 }",
    );
    broken("box_of_a_number", "x = [290, 310]", "x = 300");
    broken("limit_equal_and_more", top, "top = { metric = \"top\", equal = 3, max = 300 }");
    broken("limit_of_a_joint_without_length", top, "top = { length = \"J1\", max = 300 }");
    broken("limit_of_a_rod_that_no_variable_changes", top, "top = { length = \"rod\", max = 300 }");
    broken("limit_of_unknown_joint", top, "top = { length = \"rodd\", max = 300 }");
}

/// Files of targets, what the model says of them, and what is in them.
const FILES: [(&str, &str, &str); 11] = [
    ("target_in_a_missing_file", "\"wantd.csv\"", "0, 150\n1, 160\n"),
    ("target_outside_of_the_folder", "\"../wanted.csv\"", "0, 150\n"),
    ("target_file_that_falls", "\"wanted.csv\"", "x, y\n0, 150\n1, 160\n0.5, 155\n"),
    ("target_file_with_a_word", "\"wanted.csv\"", "0, 150\n1, high\n"),
    ("target_file_with_a_gap", "\"wanted.csv\"", "0, 150\n1,\n"),
    ("target_file_without_rows", "\"wanted.csv\"", "x, y\n"),
    ("target_file_of_one_column", "\"wanted.csv\"", "0\n1\n"),
    (
        "target_file_without_that_column",
        "{ file = \"wanted.csv\", columns = [\"travel\", \"heigth\"] }",
        "travel,height\n0,150\n",
    ),
    ("target_file_with_one_column_for_both", "{ file = \"wanted.csv\", columns = [1, 1] }", "0,150\n"),
    ("target_table_without_file", "{ columns = [1, 2] }", "0,150\n"),
    ("target_of_a_number", "150", "0,150\n"),
];

#[test]
fn targets_in_files() {
    for (name, target, data) in FILES {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("wanted.csv"), data).unwrap();
        let path = folder.path().join("four-bar.toml");
        std::fs::write(&path, with("[[0, 150], [1, 160]]", target)).unwrap();
        let error = read(&path).expect_err(name);
        let shown = error.to_string().replace(&folder.path().display().to_string(), "DIR");
        diagnosed(name, error.diagnostics(), shown);
    }
    broken("target_in_a_file_of_a_text", "[[0, 150], [1, 160]]", "\"wanted.csv\"");
    broken("target_that_falls", "[[0, 150], [1, 160]]", "[[0, 150], [0, 160]]");
}

/// Consequences of errors elsewhere are not reported.
#[test]
fn consequences_for_studies_are_not_reported() {
    let fast = "[cases.fast]\nlaws = { turn = \"720*t\" }\ntime = { end = 0.5, steps = 20 }\n";
    for (old, new) in [
        ("along = \"xyz\"", "along = 3"),
        ("bounds = [-10, 10]", "bounds = 3"),
        ("take = \"rms\"", "take = \"rmss\""),
        ("of = \"height\"\ntake = \"max\"", "of = \"hight\"\ntake = \"max\""),
        ("case = \"fast\"", "case = 3"),
        ("case = \"fast\"", "case = \"fats\""),
        (fast, "[cases]\nfast = 3\n"),
        ("turn = \"720*t\"", "turn = true"),
        ("laws = { turn = \"720*t\" }", "laws = 3"),
        ("time = { end = 0.5, steps = 20 }", "time = 3"),
        ("other_drivers = \"fixed\"", "rest = 3"),
        ("joint = \"J4\"", "joint = \"J5\""),
        ("[optimize.limits]", "[[optimize.limits]]"),
        ("[optimize.goals]", "[[optimize.goals]]"),
        ("weight = 10", "weight = true"),
        ("metric = \"top\", target", "metric = 3, target"),
        ("hardpoint = \"C\"", "hardpoint = 3"),
        ("hardpoint = \"C\", x = [290, 310]", "hardpoint = \"C\", x = true"),
        ("at = [\"B\", \"D\"]", "at = [\"B\", 3]"),
    ] {
        let error = parse(&with(old, new), "x.toml").unwrap_err();
        assert_eq!(error.list().len(), 1, "{new}: {error}");
    }
}

#[test]
fn trade_offs() {
    let starts = "starts = 4";
    broken("trade_off_of_unknown_goal", starts, "trade_off = [\"error\", \"hihg\"]");
    broken("trade_off_with_a_goal_twice", starts, "trade_off = [\"error\", \"high\", \"error\"]");
    broken("trade_off_of_one_goal", starts, "trade_off = [\"error\"]");
    parse(&with(starts, "trade_off = [\"error\", \"high\"]"), "four-bar.toml")
        .unwrap_or_else(|e| panic!("{e}"));
}

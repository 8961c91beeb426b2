//! `hardpoint optimize`, saving, and commands over the cases of a file.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::topology::Formulation;
use hardpoint_report::optimize::{OptimizeFacts, to_save};
use hardpoint_study::optimize::{Overrides, Request, judge, optimize};
use hardpoint_study::{Control, Motions, Progress};

use crate::bench::Bench;

fn root() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Creates a folder with these files of `models`.
fn bench(names: &[&str]) -> Bench {
    let bench = Bench::with(&[]);
    for name in names {
        let path = ["models", "models/studies"].map(|folder| root().join(folder).join(name));
        let text = path.iter().find_map(|path| std::fs::read_to_string(path).ok());
        bench.put(name, &text.unwrap_or_else(|| panic!("there is no {name}")));
    }
    bench
}

#[test]
fn the_tutorial_finds_the_toe_curve_as_it_prints_it() {
    let bench = bench(&["strut_toe.toml"]);
    let output = bench.run(&["optimize", "strut_toe.toml", "-o", "out", "--save", "found.toml"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{text}{}", String::from_utf8_lossy(&output.stderr));
    let written =
        "\nreport: out/report-bump.html\nreport: out/report-steer.html\nwritten: out/summary.json\nsaved:";
    assert!(text.contains(written), "{text}");
    let tutorial = std::fs::read_to_string(root().join("docs/tutorial.md")).unwrap();
    // Durations depend on the machine; the remaining gradient and the last iterations depend on round-off.
    let iteration = |line: &str| line.trim_start().chars().next().is_some_and(|c| ('2'..='9').contains(&c));
    let varies = ["time taken", "optimality", "evaluated", "saved ", "out/", "saved:"];
    let is_fixed = |line: &&str| !varies.iter().any(|word| line.contains(word)) && !iteration(line);
    let lines: Vec<&str> = text.lines().filter(is_fixed).collect();
    assert!(lines.len() > 25, "{text}");
    for line in lines {
        assert!(tutorial.contains(line.trim_end()), "the tutorial does not have this line: {line}");
    }

    assert_eq!(bench.list("out"), ["report-bump.html", "report-steer.html", "summary.json"]);
    let summary = bench.json("out/summary.json");
    assert_eq!(summary["status"], "optimal");
    assert!(summary["evaluations"]["designs"].as_u64().unwrap() < 20, "{}", summary["evaluations"]);
    // Relative to the gradient of the goals, which is a hundredth of that at the start.
    assert!(summary["kkt"].as_f64().unwrap() <= 1e-6);
    let variables = summary["variables"].as_array().unwrap();
    assert_eq!(variables.len(), 5);
    assert!(variables.iter().all(|v| v["start"] == 0.0 && v["end"].as_f64().unwrap().abs() <= 15.0 + 1e-9));

    // The page opens on toe over travel, with the optimised design and its target.
    let page = bench.page("out/report-bump.html");
    let quantity =
        |name: &str| page["quantities"].as_array().unwrap().iter().position(|q| q["name"] == name).unwrap();
    assert_eq!((&page["first"], &page["over"]), (&quantity("toe").into(), &quantity("wheel_travel").into()));
    assert_eq!(page["designs"][0]["name"], "found");
    assert!(!page["quantities"][quantity("toe")]["wanted"].as_array().unwrap().is_empty());

    // The saved file has the optimised design: a new search finds no improvement.
    let saved = bench.text("found.toml");
    assert!(saved.contains("tie_rod_inner = [-200, 215, -35]                # D"), "{saved}");
    let again = bench.run(&["optimize", "found.toml", "--json"]);
    let again: serde_json::Value = serde_json::from_slice(&again.stdout).unwrap();
    let [before, found] =
        [&again["objective"]["before"], &summary["objective"]["after"]].map(|x| x.as_f64().unwrap());
    assert!((before / found - 1.0).abs() < 1e-6, "{before} {found}");
}

#[test]
fn the_known_four_bar_is_found_and_saved_in_plain_numbers() {
    let bench = bench(&["four_bar_inverse.toml", "four_bar_inverse.csv"]);
    let output =
        bench.run(&["optimize", "four_bar_inverse.toml", "--save", "found.toml", "--starts", "3", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["starts"].as_array().unwrap().len(), 3);
    let saved = bench.text("found.toml");
    for line in ["A = [0, 0, 0]", "B = [40, 200, 0]", "C = [360, 600, 0]", "D = [400, 0, 0]"] {
        assert!(saved.contains(line), "{saved}");
    }
    // Everything but the hardpoints and the bounds of the variables is unchanged.
    let drawn = bench.text("four_bar_inverse.toml");
    let kept = drawn.lines().zip(saved.lines()).filter(|(a, b)| a == b).count();
    assert_eq!((drawn.lines().count(), kept), (saved.lines().count(), saved.lines().count() - 12));

    // The table begins at the design in the file, wherever the best search began.
    assert_ne!(summary["best_start"], 0, "{summary}");
    let text = bench.run(&["optimize", "four_bar_inverse.toml", "--starts", "3"]).stdout;
    let text = String::from_utf8(text).unwrap();
    let line = text.lines().find(|line| line.trim_start().starts_with("A_x ")).unwrap();
    let words: Vec<&str> = line.split_whitespace().collect();
    assert_eq!(words[1..7], ["-45", "mm", "0", "mm", "+45", "mm"], "{line}");
}

#[test]
fn invalid_searches_are_rejected() {
    let bench = bench(&["four_bar.toml", "four_bar_inverse.toml", "four_bar_inverse.csv"]);
    let refused = |arguments: &[&str], code: i32, words: &[&str]| {
        let output = bench.run(arguments);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{text}");
        assert!(words.iter().all(|w| text.contains(w)), "{text}");
    };
    refused(&["optimize", "four_bar.toml"], 2, &["`four_bar.toml`", "[optimize.goals]", "bounds"]);
    let onto_itself = ["optimize", "four_bar_inverse.toml", "--save", "four_bar_inverse.toml"];
    refused(&onto_itself, 2, &["the model file itself", "another name"]);
    refused(
        &["run", "four_bar.toml", "--case", "bump"],
        2,
        &["there is no case named `bump`", "has no cases"],
    );
    let few = bench.run(&["optimize", "four_bar_inverse.toml", "--iterations", "2"]);
    assert_eq!(few.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&few.stdout).contains("increase `max_iterations`"));
}

#[test]
fn commands_run_all_cases_or_the_requested_one() {
    let bench = bench(&["strut_toe.toml"]);
    let output = bench.run(&["run", "strut_toe.toml", "-o", "out", "--no-compare"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(bench.list("out"), ["bump", "metrics.csv", "report.html", "steer", "summary.json"]);
    let files = ["motion.csv", "report.html", "sensitivity.csv", "summary.json"];
    assert_eq!(
        (bench.list("out/bump"), bench.list("out/steer")),
        (files.map(String::from).to_vec(), files.map(String::from).to_vec())
    );
    assert_eq!(bench.json("out/summary.json")["cases"][1]["folder"], "steer");
    // 81 and 61 output times, and a head.
    let rows = |case: &str| bench.text(&format!("out/{case}/motion.csv")).lines().count();
    assert_eq!((rows("bump"), rows("steer")), (82, 62));
    let one = bench.run(&["run", "strut_toe.toml", "--case", "steer", "-o", "one", "--no-compare"]);
    assert_eq!(one.status.code(), Some(0));
    assert_eq!(bench.text("one/motion.csv"), bench.text("out/steer/motion.csv"));
    let json = bench.run(&["check", "strut_toe.toml", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let cases = json["cases"].as_array().unwrap();
    let of = |k: usize| (&cases[k]["case"], &cases[k]["result"]["status"]);
    assert_eq!(
        (cases.len(), of(0), of(1)),
        (2, (&"bump".into(), &"complete".into()), (&"steer".into(), &"complete".into()))
    );
    let near = bench.run(&["check", "strut_toe.toml", "--case", "ster"]);
    assert!(String::from_utf8_lossy(&near.stderr).contains("did you mean `steer`?"));
    let changed = ["whatif", "strut_toe.toml", "--set", "rack_z=+2mm", "--save", "higher.toml"];
    assert_eq!(bench.run(&changed).status.code(), Some(0));
    assert!(bench.text("higher.toml").contains("rack_centre = [-200, 0, -48]"));
}

#[test]
fn diagnostics_of_a_case_have_its_name() {
    let bench = bench(&["strut_toe.toml", "strut_tolerances.toml"]);
    let beyond = |name: &str| {
        let text = bench.text(name);
        let text = text.replace("strut_drive = \"40 - 80*t\"", "strut_drive = \"4000 - 80*t\"");
        bench.put(name, &text);
        text.contains("4000")
    };
    assert!(beyond("strut_toe.toml") && beyond("strut_tolerances.toml"));
    let output_of = |command: &str, name: &str| {
        let output = bench.run(&[command, name]);
        assert_ne!(output.status.code(), Some(0));
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat()
    };
    for (command, name) in
        [("check", "strut_toe.toml"), ("optimize", "strut_toe.toml"), ("tolerance", "strut_tolerances.toml")]
    {
        let text = output_of(command, name);
        assert!(text.contains("case `bump`: the mechanism"), "{text}");
        assert!(!text.contains("case `steer`: "), "{text}");
    }
}

#[test]
fn one_case_is_searched_by_itself_with_its_own_goals_and_limits() {
    let bench = bench(&["strut_toe.toml"]);
    let output = bench.run(&["optimize", "strut_toe.toml", "--case", "bump", "-o", "out", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(bench.list("out"), ["report-bump.html", "summary.json"]);
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    // The Ackermann goal belongs to the other case and is ignored.
    assert!(!summary.to_string().contains("ackermann"), "{summary}");
    let alone = summary["objective"]["after"].as_f64().unwrap();
    let both = bench.run(&["optimize", "strut_toe.toml", "--json"]);
    let both: serde_json::Value = serde_json::from_slice(&both.stdout).unwrap();
    assert!(alone <= both["objective"]["after"].as_f64().unwrap() * (1.0 + 1e-9));
    let none = bench.run(&["optimize", "strut_toe.toml", "--case", "steer"]);
    assert_eq!(none.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&none.stderr).contains("`[optimize]` has no goal in this case"));
}

#[test]
fn a_grid_is_solved_by_itself_and_every_page_of_the_file_has_it() {
    let bench = bench(&["strut_toe.toml"]);
    let grid =
        "grid = { strut_drive = { from = -30, to = 30, steps = 3 }, rack_drive = { at = [-10, 0, 10] } }";
    let text = bench.text("strut_toe.toml");
    bench.put("mapped.toml", &format!("{text}\n[cases.map]\n{grid}\n"));
    let output = bench.run(&["run", "mapped.toml", "--case", "map", "-o", "map"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(bench.list("map"), ["map_sensitivity.csv", "maps.csv", "maps.json", "report.html"]);
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        printed.contains("Map `map` over strut_drive and rack_drive") && printed.contains("maps.csv"),
        "{printed}"
    );
    assert_eq!(bench.run(&["run", "mapped.toml", "-o", "all", "--no-compare"]).status.code(), Some(0));
    assert_eq!(bench.text("all/maps.csv"), bench.text("map/maps.csv"));
    for page in ["all/bump", "all/steer", "map"] {
        let page = bench.page(&format!("{page}/report.html"));
        assert_eq!((page["maps"].as_array().unwrap().len(), &page["maps"][0]["name"]), (1, &"map".into()));
        let places = page["maps"][0]["drivers"][0]["places"].as_array().unwrap();
        for (place, expected) in places.iter().zip([-30.0, -10.0, 10.0, 30.0]) {
            assert!((place.as_f64().unwrap() - expected).abs() < 1e-12, "{places:?}");
        }
        let toe = &page["maps"][0]["quantities"].as_array().unwrap()[1];
        assert_eq!(
            (&toe["name"], &toe["unit"], toe["sensitivities"].as_array().unwrap().len()),
            (&"toe".into(), &"deg".into(), 5)
        );
    }
    // A single motion has no map.
    assert_eq!(
        bench.run(&["run", "mapped.toml", "--case", "bump", "-o", "one", "--no-compare"]).status.code(),
        Some(0)
    );
    assert!(!bench.list("one").contains(&"maps.csv".to_string()));
    let check = bench.run(&["check", "mapped.toml", "--case", "map"]);
    assert_eq!(check.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&check.stderr).contains("a grid of positions, not a motion"));
    // Commands that take grids name them as well.
    let unknown = bench.run(&["run", "mapped.toml", "--case", "mapp", "-o", "none"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&unknown.stderr).contains("did you mean `map`?"));
}

#[test]
fn two_files_are_compared_in_every_case_that_both_have() {
    let bench = bench(&["strut_toe.toml", "four_bar.toml"]);
    let changed = [
        "whatif",
        "strut_toe.toml",
        "--set",
        "rack_z=+2mm",
        "--case",
        "bump",
        "-o",
        "whatif",
        "--save",
        "higher.toml",
    ];
    assert_eq!(bench.run(&changed).status.code(), Some(0));
    let output = bench.run(&["compare", "strut_toe.toml", "higher.toml", "-o", "out"]);
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0), "{printed}{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(bench.list("out/bump"), ["compare.csv", "compare.html", "compare.json"]);
    for line in ["rack_centre.z", "tie_rod_inner.z", "ackermann", "toe_error", "wheel_travel"] {
        assert!(printed.contains(line), "{line}: {printed}");
    }
    // The second file is the design of the what-if.
    let (compared, solved) = (bench.json("out/bump/compare.json"), bench.json("whatif/whatif.json"));
    let measure = |document: &serde_json::Value, name: &str| {
        document["measures"].as_array().unwrap().iter().find(|m| m["measure"] == name).unwrap().clone()
    };
    for name in ["toe", "camber", "half_track"] {
        let (a, b) = (measure(&compared, name), measure(&solved, name));
        let [a, b] = [&a["curves"][1], &b["exact"]].map(|c| c.as_array().unwrap().clone());
        assert!(
            a.len() == 81
                && a.iter().zip(&b).all(|(x, y)| (x.as_f64().unwrap() - y.as_f64().unwrap()).abs() < 1e-9)
        );
    }
    let page = bench.page("out/bump/compare.html");
    assert_eq!(page["designs"][0]["name"], "higher.toml");
    assert!(page["study"]["tables"][0]["title"] == "Hardpoints that differ");

    let same = bench.run(&["compare", "strut_toe.toml", "strut_toe.toml", "--case", "steer"]);
    assert!(
        String::from_utf8_lossy(&same.stdout).contains("the hardpoints and parameters of both are the same")
    );
    let unlike = bench.run(&["compare", "four_bar.toml", "strut_toe.toml"]);
    assert_eq!(unlike.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&unlike.stderr).contains("there is no motion to compare"));
    let no_measure =
        bench.run(&["compare", "strut_toe.toml", "higher.toml", "--case", "bump", "--measure", "to"]);
    assert!(String::from_utf8_lossy(&no_measure.stderr).contains("did you mean `toe`?"));
}

/// A crank whose tip is to reach a height.
const CRANK: &str = r#"
name = "crank"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { O = [0, 0], A = [20, 5] }
bodies = { crank = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O" }
drivers.motor = { joint = "pivot", law = "30*t" }
points.A = { body = "crank", at = "A" }
metrics.high = { of = "A.y", take = "value", at = 1 }
metrics.far = { of = "A.x", take = "value", at = 1 }
optimize.goals = { high = { target = 15 }, far = { target = 20 } }
time = { end = 1, steps = 4 }
"#;

#[test]
fn a_design_that_cannot_be_saved_is_rejected_before_the_search() {
    let bench = Bench::with(&[]);
    bench.put(
        "one.toml",
        &format!(
            "{CRANK}design.x = {{ markers = [{{ joint = \"pivot\", on = \"j\", move = [1, 0, 0] }}], bounds = [-9, 9] }}\n\
             design.y = {{ markers = [{{ joint = \"pivot\", on = \"j\", move = [0, 1, 0] }}], bounds = [-9, 9] }}\n"
        ),
    );
    let output = bench.run(&["optimize", "one.toml", "--save", "found.toml"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("HP0505") && text.contains("away from its hardpoint"), "{text}");
    assert!(!text.contains("objective"), "the search has not started: {text}");
    assert!(!bench.path("found.toml").exists());
    // Without saving it is searched.
    assert_eq!(bench.run(&["optimize", "one.toml"]).status.code(), Some(0));
}

#[test]
fn the_saved_design_is_read_and_solved_again_and_tables_show_values() {
    let bench = Bench::with(&[]);
    let variables = "design.A_x = { move = \"A\", along = \"x\", bounds = [-9, 9] }\ndesign.A_y = { move = \"A\", along = \"y\", bounds = [-9, 9] }\n";
    bench.put("two.toml", &format!("{CRANK}{variables}"));
    let output = bench.run(&["optimize", "two.toml", "--save", "found.toml"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{text}{}", String::from_utf8_lossy(&output.stderr));
    assert!(text.contains("`found.toml` was read and solved again"), "{text}");
    assert!(text.contains("all goals are met"), "{text}");
    // 20 cos 30 deg + 15 sin 30 deg, from 20: the value, its change, and bounds of the value.
    let line = text.lines().find(|l| l.trim_start().starts_with("A_x")).unwrap();
    for word in ["20 mm", "24.821 mm", "+4.8205 mm", "11 to 29"] {
        assert!(line.contains(word), "{line}");
    }
    let output = bench.run(&["optimize", "two.toml", "--save", "found.toml", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&json["saved"]["why"], &json["status"]), (&serde_json::Value::Null, &"optimal".into()));
    assert!(json["saved"]["margin"].as_f64().unwrap() > 0.0);
    assert!(json["variables"][0]["nominal"].as_f64().unwrap() == 20.0);
}

#[test]
fn an_entry_of_two_variables_is_split_where_they_move_differently() {
    let bench = Bench::with(&[]);
    let template = root().join("crates/hardpoint-cli/templates/four-bar.toml");
    bench.put("four-bar.toml", &std::fs::read_to_string(template).unwrap());
    let output = bench.run(&["optimize", "four-bar.toml", "--save", "found.toml", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["saved"]["why"], serde_json::Value::Null, "{json}");
    let text = bench.text("found.toml");
    assert!(text.contains("\nB_x = { move = \"B\", along = \"x\", bounds = ["), "{text}");
    // The saved design meets the goal.
    assert_eq!(bench.run(&["run", "found.toml", "--case", "turn", "-o", "run"]).status.code(), Some(0));
    let metrics = bench.json("run/summary.json")["metrics"].clone();
    let swing = metrics.as_array().unwrap().iter().find(|m| m["name"] == "swing").unwrap()["value"].clone();
    assert!((swing.as_f64().unwrap() - 50.0).abs() < 1e-6, "{swing}");
    let output = bench.run(&["whatif", "four-bar.toml", "--set", "B.x=1", "--save", "moved.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(bench.text("moved.toml").contains("\nB = [36, 60] "), "{}", bench.text("moved.toml"));
}

#[test]
fn a_result_that_cannot_be_written_is_still_shown() {
    let bench = Bench::with(&[]);
    let variables = "design.A_y = { move = \"A\", along = \"y\", bounds = [-9, 9] }\n";
    bench.put("two.toml", &format!("{CRANK}{variables}"));
    // A file where the folder should be.
    bench.put("file", "");
    let output = bench.run(&["optimize", "two.toml", "--save", "file/found.toml"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(6), "{text}");
    assert!(text.contains("could not be saved") && text.contains("A_y"), "{text}");
}

/// A slider-crank driven by its slider, with a law from a file next to the model; the rod and the crank are in line
/// after 10.6 mm.
const PULLED: &str = r#"
name = "pulled"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { O = [0, 0], A = [12, 16], B = [59.37, 0], P = [30, 20] }
bodies = { ground = ["O"], crank = ["O", "A"], rod = ["A", "B", "P"], slider = ["B"] }
joints.guide = { type = "translational", bodies = ["ground", "slider"], at = "B", axis = [1, 0] }
drivers.pull = { joint = "guide", law = { type = "table", file = "travel.csv", columns = [1, 2] } }
points.P = { body = "rod", at = "P" }
design.P_y = { move = "P", along = "y", bounds = [-9, 9] }
metrics.high = { of = "P.y", take = "value", at = 1 }
optimize.goals.high = { target = 15 }
time = { end = 1, steps = 10 }
"#;

fn table(travel: f64) -> String {
    format!("time,travel\n0,0\n0.5,{}\n1,{travel}\n", 0.5 * travel)
}

#[test]
fn a_saved_design_that_stops_or_comes_too_near_to_a_singular_position_is_no_optimum() {
    // The saved text is read again with another table than the one of the search.
    let saved = |margin: &str, travel: f64| {
        let bench = Bench::with(&[]);
        bench.put("pulled.toml", &format!("{PULLED}{margin}"));
        bench.put("travel.csv", &table(5.0));
        let file = hardpoint_file::read(&bench.path("pulled.toml")).unwrap();
        let settings = Request::of(&file.model, Overrides::default()).unwrap();
        let asked = &settings.settings;
        let models = file.model.motions();
        let motions = Motions::of(&models, Formulation::Relative).unwrap();
        let mut progress = |_: Progress<'_>| ControlFlow::Continue(());
        let control = Control { threads: NonZero::<usize>::MIN, progress: &mut progress, more: &|| true };
        let found = optimize(&file.model, &motions, &settings, control);
        let mut facts = OptimizeFacts::of(&file, asked, &found);
        let best = found.best.and_then(|k| found.searches[k].found.as_ref()).unwrap();
        let text = file.edit(&to_save(&file, &motions, asked, &best.design)).unwrap();

        bench.put("travel.csv", &table(travel));
        bench.put("found.toml", &text);
        let again = hardpoint_file::read(&bench.path("found.toml")).unwrap().model;
        let models = again.motions();
        let motions = Motions::of(&models, Formulation::Relative).unwrap();
        let judged = judge(&again, &motions, again.optimization.as_ref().unwrap(), &[]);
        facts.check_saved("found.toml", judged.map_err(|failed| failed.why), asked);
        serde_json::to_value(&facts).unwrap()
    };
    for (margin, travel, why) in [
        ("", 12.0, "cannot move beyond"),
        ("optimize.min_margin = 0.15\n", 12.0, "cannot move beyond"),
        ("optimize.min_margin = 0.15\n", 10.0, "less than 0.15"),
        // The nominal design exceeds this margin; the saved one does not.
        ("optimize.min_margin = 0.15\n", 5.1, ""),
    ] {
        let json = saved(margin, travel);
        if why.is_empty() {
            assert_eq!(json["status"], "optimal", "{json}");
            assert!(json["saved"]["margin"].as_f64() < json["margin"]["after"].as_f64(), "{json}");
            continue;
        }
        assert_eq!(json["status"], "not_reproduced", "{travel}: {json}");
        assert!(json["saved"]["why"].as_str().unwrap().contains(why), "{}", json["saved"]);
        let message = json["message"].as_str().unwrap();
        assert!(message.contains(why) && !message.contains("an optimum"), "{message}");
        let asks = message.contains("set `min_margin`");
        assert_eq!(asks, margin.is_empty(), "advice for who has given a margin: {message}");
    }
}

#[test]
fn a_model_saved_in_another_folder_names_its_data_from_there() {
    let bench = Bench::with(&[]);
    std::fs::create_dir_all(bench.path("models/copies")).unwrap();
    bench.put("models/pulled.toml", PULLED);
    bench.put("models/travel.csv", &table(5.0));
    let optimize = |to: &str| {
        let output = bench.run(&["optimize", "models/pulled.toml", "--save", to]);
        let texts = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        (output.status.code(), texts.concat())
    };
    // Above the model: `found.toml` was read and solved again, and has the optimum.
    let (code, text) = optimize("found.toml");
    assert!(code == Some(0) && text.contains("`found.toml` was read and solved again"), "{text}");
    assert!(bench.text("found.toml").contains("file = \"models/travel.csv\", columns"), "{text}");
    let change = ["whatif", "models/pulled.toml", "--set", "P_y=2", "--save"];
    assert_eq!(bench.run(&[&change[..], &["moved.toml"]].concat()).status.code(), Some(0));
    assert!(bench.text("moved.toml").contains("file = \"models/travel.csv\""));
    // Below it, the table is out of reach: before the search, with a suggestion.
    let (code, text) = optimize("models/copies/found.toml");
    assert!(code == Some(2) && text.contains("HP0505") && !text.contains("objective"), "{text}");
    assert!(
        text.contains("it reads `travel.csv`, which is not there") && text.contains("or copy `travel.csv`"),
        "{text}"
    );
    let output = bench.run(&[&change[..], &["models/copies/moved.toml"]].concat());
    assert_eq!((output.status.code(), bench.list("models/copies")), (Some(2), vec![]));
    // Another table of that name does not serve, a copy does.
    bench.put("models/copies/travel.csv", &table(4.0));
    let (code, text) = optimize("models/copies/found.toml");
    assert!(code == Some(2) && text.contains("has other contents"), "{text}");
    bench.put("models/copies/travel.csv", &table(5.0));
    let (code, text) = optimize("models/copies/found.toml");
    assert_eq!(code, Some(0), "{text}");
    assert_eq!(bench.text("models/copies/found.toml").matches("file = \"travel.csv\"").count(), 1);
}

#[test]
fn a_point_of_a_front_is_saved_and_its_goals_are_those_of_the_saved_model() {
    let bench = bench(&["wishbone_trade_off.toml"]);
    let arguments = ["--points", "4", "--point", "1", "--save", "chosen.toml", "-o", "out", "--json"];
    let output = bench.run(&[&["trade-off", "wishbone_trade_off.toml"], &arguments[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(bench.list("out"), ["front.csv", "report.html", "summary.json"]);
    let summary = bench.json("out/summary.json");
    let point = &summary["points"][1];
    assert_eq!((&summary["saved"]["point"], &summary["saved"]["why"]), (&1.into(), &serde_json::Value::Null));
    assert!(point["kkt"].as_f64().unwrap() < 1e-6, "{point}");
    let row = bench.text("out/front.csv").lines().nth(2).unwrap().to_owned();
    assert_eq!(row.split(',').nth(1).unwrap().parse::<f64>().ok(), point["goals"][0].as_f64());
    // The first variable moves two hardpoints, the third one along z: its value is a coordinate.
    let table = bench.text("out/front.csv");
    let mut cells = table.lines().next().unwrap().split(',').zip(row.split(','));
    let mut cell = |title: &str| cells.find(|(t, _)| *t == title).unwrap().1.parse::<f64>().ok();
    assert_eq!((cell("value lca_y [mm]"), cell("change lca_y [mm]")), (None, point["variables"][0].as_f64()));
    let (value, change) = (cell("value lca_front_z [mm]").unwrap(), cell("change lca_front_z [mm]").unwrap());
    assert_eq!(Some(change), point["variables"][2].as_f64());
    assert!((value - change - 124.89).abs() < 1e-9, "{value} {change}");
    bench.run(&["run", "chosen.toml", "-o", "run"]);
    let metrics = bench.text("run/metrics.csv");
    for (k, name) in ["track", "camber"].iter().enumerate() {
        let line = metrics.lines().find(|line| line.split(',').any(|cell| cell == *name)).unwrap();
        let goal = point["goals"][k].as_f64().unwrap();
        let is_goal = |cell: &str| cell.parse::<f64>().is_ok_and(|x| (x / goal - 1.0).abs() < 1e-6);
        assert!(line.split(',').any(is_goal), "{line}: {goal}");
    }
}

/// Runs a study of a model of these tests with further tables; returns the exit code and the summary.
fn studied(model: &str, tables: &str, arguments: &[&str]) -> (Option<i32>, serde_json::Value) {
    let bench = Bench::with(&[model]);
    let text = bench.text(model);
    bench.put(model, &format!("{text}{tables}"));
    let output = bench.run(&[&[arguments[0], model], &arguments[1..], &["--json"]].concat());
    (output.status.code(), serde_json::from_slice(&output.stdout).unwrap_or_default())
}

/// Goals of the points of a front.
fn front(summary: &serde_json::Value) -> Vec<Vec<f64>> {
    let goals = |point: &serde_json::Value| {
        point["goals"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
    };
    summary["points"].as_array().unwrap().iter().map(goals).collect()
}

#[test]
fn targets_that_one_design_meets_do_not_conflict() {
    // stroke = 2 r and x_max = r + l without offset: r = 60 and l = 170.
    for trade_off in ["trade_off = [\"stroke\", \"x_max\"]", "trade_off = [\"x_max\", \"stroke\"]"] {
        let model = "slider_crank_of_studies.toml";
        let bench = Bench::with(&[model]);
        let text = bench.text(model).replace("value = 20", "value = 0");
        let goals = "goals = { stroke = { target = 120 }, x_max = { target = 230 } }";
        bench.put(model, &format!("{text}\n[optimize]\n{trade_off}\n{goals}\n"));
        let output = bench.run(&["trade-off", model, "--json"]);
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!((output.status.code(), &summary["status"]), (Some(0), &"no_conflict".into()), "{summary}");
        let variables = summary["points"][0]["variables"].as_array().unwrap();
        for (found, expected) in variables.iter().zip([60.0, 170.0]) {
            assert!((found.as_f64().unwrap() - expected).abs() < 0.02, "{variables:?}");
        }
    }
}

#[test]
fn a_front_ends_where_a_target_is_met_with_the_least_of_the_other_goal() {
    let model = "four_bar_of_studies.toml";
    // The least maximum of y at the target, as a limit.
    let limited = "\n[optimize.goals]\npy_max = {}\n[optimize.limits]\npx = { metric = \"px\", equal = 30 }\n\
                   mu = { metric = \"mu_min\", min = 40 }\n";
    let (code, least) = studied(model, limited, &["optimize"]);
    assert_eq!(code, Some(0), "{least}");
    let least = least["goals"][0]["after"].as_f64().unwrap();
    let goals = "\ngoals = { px = { target = 30 }, py_max = {} }\nlimits = { mu = { metric = \"mu_min\", min = 40 } }\n";
    let ends = [["px", "py_max"], ["py_max", "px"]].map(|[a, b]| {
        let tables = format!("\n[optimize]\ntrade_off = [\"{a}\", \"{b}\"]{goals}");
        let (code, summary) = studied(model, &tables, &["trade-off", "--points", "5"]);
        assert_eq!((code, summary["failed"].as_u64()), (Some(0), Some(0)), "{summary}");
        let points = front(&summary);
        let (first, last) = (points[0].clone(), points[points.len() - 1].clone());
        if a == "px" { [first, last] } else { [last, first].map(|p| vec![p[1], p[0]]) }
    });
    let [[end, other], [end_again, other_again]] = ends;
    // A thousandth of the range, at the rate of exchange of the front.
    assert!(end[0] <= 1.01e-3 * other[0] && (end[1] - least).abs() < 1e-2, "{end:?} {least}");
    for (a, b) in [(end, end_again), (other, other_again)] {
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-4), "{a:?} {b:?}");
    }
}

#[test]
fn no_point_of_three_goals_is_worse_than_a_design_that_meets_two() {
    let model = "four_bar_of_studies.toml";
    let tables = "\n[optimize]\ngoals = { py_range = {}, psi_range = { target = 80 }, px = { target = 30 } }\n\
                  limits = { mu = { metric = \"mu_min\", min = 35 } }\n";
    let (code, summary) = studied(model, tables, &["trade-off", "--points", "10"]);
    assert_eq!(code, Some(0), "{summary}");
    // Both targets as limits.
    let limited = "\n[optimize.goals]\npy_range = {}\n[optimize.limits]\npx = { metric = \"px\", equal = 30 }\n\
                   psi_range = { metric = \"psi_range\", equal = 80 }\nmu = { metric = \"mu_min\", min = 35 }\n";
    let (code, least) = studied(model, limited, &["optimize"]);
    assert_eq!(code, Some(0), "{least}");
    let least = least["goals"][0]["after"].as_f64().unwrap();
    let points = front(&summary);
    assert!(points.len() > 5 && points.iter().all(|p| p[0] <= least + 1e-6), "{least} {points:?}");
    assert!(
        points.iter().any(|p| (p[0] - least).abs() < 0.2 && p[1] < 0.1 && p[2] < 0.1),
        "{least} {points:?}"
    );
}

#[test]
fn a_minimum_is_maximised_by_a_target_out_of_reach() {
    // The transmission angle is extreme where crank and ground are in line; at the optimum b = c, and both extremes are
    // equally far from 90 deg.
    let tables = "\n[optimize.goals]\nmu_min = { target = 90 }\n";
    let (code, summary) = studied("four_bar_of_studies.toml", tables, &["optimize"]);
    assert_eq!((code, &summary["status"]), (Some(0), &"optimal".into()), "{summary}");
    let end = |k: usize| {
        let of = |key: &str| summary["variables"][k][key].as_f64().unwrap();
        of("nominal") + of("end")
    };
    // a and d at their bounds; 2 b^2 (1 - cos mu) = (d - a)^2 and 2 b^2 (1 + cos mu) = (d + a)^2.
    let (a, d) = (20.0_f64, 170.0_f64);
    let b = ((a * a + d * d) / 2.0).sqrt();
    let mu = (2.0 * a * d / (2.0 * b * b)).acos().to_degrees();
    let found = [end(0), end(1), end(2), end(3), summary["goals"][0]["after"].as_f64().unwrap()];
    for (found, expected) in found.into_iter().zip([a, b, b, d, mu]) {
        assert!((found - expected).abs() < 1e-4, "{found} {expected}: {summary}");
    }
}

#[test]
fn weights_without_a_square_are_refused() {
    for weight in ["1e300", "1e-170"] {
        let tables = format!("\n[optimize.goals]\npsi = {{ target = 120, weight = {weight} }}\n");
        let (code, _) = studied("four_bar_of_studies.toml", &tables, &["optimize"]);
        assert_eq!(code, Some(3), "{weight}");
    }
}

#[test]
fn goals_that_depend_on_no_variable_are_reported() {
    // The angle of the crank is given by the driver.
    let model = "slider_crank_of_studies.toml";
    let metrics = "\n[measures]\nphi = { type = \"coordinate\", joint = \"A\" }\n\
                   [metrics.turn]\nof = \"phi\"\ntake = \"max\"\n[metrics.mean]\nof = \"phi\"\ntake = \"mean\"\n";
    let tables = format!("{metrics}[optimize.goals]\nturn = {{}}\nmean = {{ target = 3 }}\n");
    let (code, summary) = studied(model, &tables, &["optimize"]);
    assert_eq!((code, &summary["status"]), (Some(1), &"no_effect".into()), "{summary}");
    let message = summary["message"].as_str().unwrap();
    assert!(["`turn`", "`mean`", "`r`", "`l`"].iter().all(|name| message.contains(name)), "{message}");
    let (code, summary) = studied(model, &tables, &["trade-off"]);
    assert_eq!((code, &summary["status"]), (Some(1), &"no_optimum".into()), "{summary}");
}

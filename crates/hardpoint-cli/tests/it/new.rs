//! New models from templates.

use std::path::Path;

use hardpoint::Analysis;
use hardpoint::model::{Hardpoint, Model, Side};
use rust_xlsxwriter::Workbook;

use crate::bench::Bench;

fn templates() -> Vec<String> {
    let output = Bench::with(&[]).run(&["new", "--list"]);
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().filter_map(|l| Some(l.split_whitespace().next()?.to_owned())).collect()
}

/// Exit code and error output, without the name of the folder.
fn output_of(bench: &Bench, arguments: &[&str]) -> (Option<i32>, String) {
    let output = bench.run(arguments);
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn every_template_is_a_model_with_everything_that_checks_and_runs_at_once() {
    let all = templates();
    assert_eq!(all.len(), 9, "{all:?}");
    for template in &all {
        let bench = Bench::with(&[]);
        assert_eq!(bench.run(&["new", "mine", "--template", template]).status.code(), Some(0), "{template}");
        let text = bench.text("mine.toml");
        assert!(text.contains("\nname = \"mine\"") && text.starts_with("# "), "{template}");
        let file =
            hardpoint_file::read(&bench.path("mine.toml")).unwrap_or_else(|e| panic!("{template}: {e}"));
        let model = &file.model;
        assert!(
            model.cases.len() >= 2 && !model.measures.is_empty() && !model.metrics.is_empty(),
            "{template}"
        );
        assert!(model.variables.len() >= 4 && model.optimization.is_some(), "{template}");
        let output = bench.run(&["check", "mine.toml"]);
        assert_eq!(output.status.code(), Some(0), "{template}");
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(!message.contains("warning"), "{template}: {message}");
        // Pins of a planar mechanism have redundant rows perpendicular to the plane; other models have none.
        let redundant = Analysis::new(model).unwrap().topology().redundant().count();
        assert!(redundant == 0 || text.contains("\nplanar = "), "{template}");
        let output = bench.run(&["run", "mine.toml", "-o", "results"]);
        assert_eq!(output.status.code(), Some(0), "{template}");
        for case in &model.cases {
            assert!(
                bench.list(&format!("results/{}", case.name)).contains(&"report.html".to_owned()),
                "{template}"
            );
        }
    }
}

#[cfg(not(windows))]
#[test]
fn commands_for_a_name_with_spaces_can_be_pasted_into_a_shell() {
    let bench = Bench::with(&[]);
    let found = |name: &str| {
        let output = bench.run(&["new", name, "--template", "four-bar"]);
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(found("f b").contains("\n  hardpoint run 'f b.toml'\n  hardpoint studio 'f b.toml'\n"));
    assert!(found("l'arm").contains("\n  hardpoint run 'l'\\''arm.toml'\n"));
    assert!(found("a-b_2").contains("\n  hardpoint run a-b_2.toml\n"));
}

#[test]
fn the_goals_of_every_template_can_be_reached() {
    for template in templates() {
        let bench = Bench::with(&[]);
        bench.run(&["new", "mine", "-t", &template]);
        let (code, message) = output_of(&bench, &["optimize", "mine.toml"]);
        assert_eq!(code, Some(0), "{template}: {message}");
    }
}

#[test]
fn a_table_places_the_hardpoints_in_its_units_and_axes() {
    let bench = Bench::with(&[]);
    // The template itself, in inches, with x back, y right and z up.
    bench.run(&["new", "plain", "-t", "macpherson"]);
    let plain = hardpoint_file::read(&bench.path("plain.toml")).unwrap();
    let mut csv = "Name; X [in]; Y [in]; Z [in]\n".to_owned();
    let mut book = Workbook::new();
    let sheet = book.add_worksheet();
    for (row, hardpoint) in (0..).zip(plain.model.hardpoints.iter().filter(|h| !h.unnamed)) {
        let p = hardpoint.position;
        let place = [-p.x, -p.y, p.z].map(|x| x / 0.0254);
        let name = hardpoint.name.replace('_', "-").to_uppercase();
        csv += &format!("{name}; {}; {}; {}\n", place[0], place[1], place[2]);
        sheet.write(row + 2, 0, name).unwrap();
        for (column, x) in (1..).zip(place) {
            sheet.write(row + 2, column, x).unwrap();
        }
    }
    bench.put("points.csv", &csv);
    book.save(bench.path("points.xlsx")).unwrap();
    for (table, axes) in [("points.csv", "adams"), ("points.xlsx", "x back, z up, y right")] {
        let name = table.replace('.', "_");
        let message = output_of(
            &bench,
            &["new", &name, "-t", "macpherson", "--hardpoints", table, "--units", "in", "--axes", axes],
        );
        assert_eq!(message, (Some(0), String::new()));
        let placed = bench.text(&format!("{name}.toml"));
        assert_eq!(placed, bench.text("plain.toml").replace("\"plain\"", &format!("\"{name}\"")));
    }
    // A plane has two coordinates.
    bench.put("bar.csv", "A,0,0,0\nB,35,61,0\nC,250,190,0\nD,300,0,0\nP,130,200,0\n");
    let message =
        output_of(&bench, &["new", "bar", "-t", "four-bar", "--hardpoints", "bar.csv", "--units", "mm"]);
    assert_eq!(message, (Some(0), String::new()));
    assert!(bench.text("bar.toml").contains("B = [35, 61] "));
    // The same without the third coordinate, with the unit in the column names and with decimal commas as in a
    // spreadsheet.
    bench.put("flat.csv", "Name;x [cm];y [cm]\nA;0;0\nB;3,5;6,1\nC;25;19\nD;30;0\nP;13;20\n");
    let message = output_of(&bench, &["new", "flat", "-t", "four-bar", "--hardpoints", "flat.csv"]);
    assert_eq!(message, (Some(0), String::new()));
    assert_eq!(bench.text("flat.toml"), bench.text("bar.toml").replace("\"bar\"", "\"flat\""));
    // A plane parallel to that of the template is accepted and reported.
    bench.put("above.csv", "A,0,0,7\nB,35,61,7\nC,250,190,7\nD,300,0,7\nP,130,200,7\n");
    let (code, message) =
        output_of(&bench, &["new", "above", "-t", "four-bar", "--hardpoints", "above.csv", "--units", "mm"]);
    assert!(code == Some(0) && message.contains("at z = 7 mm: the model has them at z = 0"), "{message}");
}

#[test]
fn a_table_of_the_right_side_makes_a_right_wheel() {
    let bench = Bench::with(&[]);
    bench.run(&["new", "left", "-t", "double-wishbone"]);
    let left = hardpoint_file::read(&bench.path("left.toml")).unwrap().model;
    let place = |h: &Hardpoint| [h.position.x, -h.position.y, h.position.z].map(|x| x * 1e3);
    let line = |h: &Hardpoint| format!("{},{}\n", h.name, place(h).map(|x| x.to_string()).join(","));
    bench.put("right.csv", &left.hardpoints.iter().filter(|h| !h.unnamed).map(line).collect::<String>());
    let table = ["--hardpoints", "right.csv", "--units", "mm", "--axes", "iso"];
    let message = output_of(&bench, &[&["new", "right", "-t", "double-wishbone"], &table[..]].concat());
    assert_eq!(message, (Some(0), String::new()));
    let right = hardpoint_file::read(&bench.path("right.toml")).unwrap().model;
    assert_eq!([&left, &right].map(|m| m.wheels[0].side), [Side::Left, Side::Right]);
    let camber = |m: &Model| {
        let solution = Analysis::new(m).unwrap().run();
        solution.measured.value(0, solution.measured.index("wheel.camber").unwrap())[0]
    };
    assert!((camber(&left) - camber(&right)).abs() < 1e-9 && camber(&left).abs() > 1e-3);
}

/// A corner that is smaller than the template's, on a lower wheel, in mm.
const SMALL: &str = "name,x,y,z\nuca_front,-100,-400,350\nuca_rear,100,-400,350\nupper_ball,0,-600,416.6666666666667\n\
    lca_front,-100,-400,150\nlca_rear,100,-400,150\nlower_ball,0,-600,83.33333333333333\ntie_rod_inner,50,-400,250\n\
    tie_rod_outer,50,-570,230\nwheel_centre,0,-650,250\n";

#[test]
fn values_of_a_template_that_contradict_the_hardpoints_are_derived_and_reported() {
    let bench = Bench::with(&[]);
    bench.put("small.csv", &format!("{SMALL}spindle,0,-600,250\n"));
    bench.put("hash.csv", &SMALL.replacen("name", "#name", 1).replacen("\nuca", "\n-,mm,mm,mm\nuca", 1));
    bench.put("metres.csv", "upper_ball,0,-0.6,0.4166666666666667\n");
    let begin = |name: &str, table: &str, units: &[&str]| {
        let arguments = ["new", name, "-t", "double-wishbone", "--hardpoints", table, "--axes", "iso"];
        output_of(&bench, &[&arguments[..], units].concat())
    };
    let (code, message) = begin("small", "small.csv", &["--units", "mm"]);
    assert_eq!(code, Some(0), "{message}");
    assert!(message.contains("the radius of `wheel` is 250 mm"), "{message}");
    assert!(message.contains("the travel of case `steer` is beyond this linkage"), "{message}");
    let text = bench.text("small.toml");
    for part in ["[0, -600, 83.33333333333333]", "416.6666666666667]", "\nradius = 250\n"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    // All cases reach their last output time.
    assert_eq!(output_of(&bench, &["run", "small.toml", "-o", "results"]).0, Some(0));
    // Its header after a `#`, units in a line, and no point of the axis.
    let (code, message) = begin("hash", "hash.csv", &[]);
    assert!(
        code == Some(0) && message.contains("the table has no `spindle`: it is placed 70 mm inboard"),
        "{message}"
    );
    assert!(bench.text("hash.toml").contains("spindle = [0, -580, 250]"));
    // Heights with another origin.
    let high: String = SMALL.replace(",250\n", ",-20\n");
    bench.put("high.csv", &high);
    let (_, message) = begin("high", "high.csv", &["--units", "mm"]);
    assert!(message.contains("the radius of `wheel` remains 310 mm"), "{message}");
    bench.put("bare.csv", "x,y,z\n1,2,3\n");
    let (code, message) = begin("bare", "bare.csv", &["--units", "mm"]);
    assert!(code == Some(2) && message.contains("without a column for the names of hardpoints"), "{message}");
}

#[test]
fn tables_of_hardpoints_import_again() {
    /// Coordinates are written with the fewest digits that restore them; half a turn only changes signs.
    const SAME: f64 = 1e-12;
    for model in ["double_wishbone", "macpherson", "five_link", "front_axle"] {
        let file = format!("{model}.toml");
        let bench = Bench::with(&[]);
        let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
        bench.put(&file, &std::fs::read_to_string(gallery.join(&file)).unwrap());
        assert_eq!(output_of(&bench, &["export", &file, "-o", "points.sub"]).0, Some(0), "{model}");
        let (code, message) = output_of(&bench, &["import", "points.sub", "-o", "back.toml"]);
        assert_eq!(code, Some(0), "{model}: {message}");
        let [out, back] =
            [file.as_str(), "back.toml"].map(|f| hardpoint_file::read(&bench.path(f)).unwrap().model);
        for own in out.hardpoints.iter().filter(|h| !h.unnamed) {
            let again = back.hardpoints.iter().find(|h| h.name == own.name);
            let again = again.unwrap_or_else(|| panic!("{model}: `{}` is lost", own.name));
            assert!((again.position - own.position).norm() < SAME, "{model}: `{}`", own.name);
        }
        assert!(!back.joints.is_empty(), "{model}");
    }
}

#[test]
fn the_commands_of_its_document_work() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/new.md");
    let page = std::fs::read_to_string(page).unwrap();
    let bench = Bench::with(&[]);
    bench.put("points.csv", page.split("```csv\n").nth(1).unwrap().split("```").next().unwrap());
    let commands: Vec<&str> = page.lines().filter_map(|l| l.strip_prefix("    hardpoint ")).collect();
    assert_eq!(commands.len(), 4, "{commands:?}");
    for command in commands {
        let message = output_of(&bench, &command.split(' ').collect::<Vec<_>>());
        assert_eq!(message.0, Some(0), "{command}: {}", message.1);
    }
    assert!(bench.text("press.toml").contains("C = [228.6, 12.7] "));
    let output = bench.run(&["new", "--list"]);
    for line in String::from_utf8(output.stdout).unwrap().lines() {
        let (name, what) = line.trim().split_once("  ").unwrap();
        assert!(page.contains(&format!("| `{name}` | {} |", what.trim())), "{line}");
    }
}

#[test]
fn invalid_requests_are_rejected_and_leave_no_file() {
    let bench = Bench::with(&[]);
    bench.put("mine.toml", "there\n");
    bench.put("points.csv", "A,0,0,0\nB,35,60,0\nC,250,190,0\nE,300,0,0\nPP,130,200,0\n");
    bench.put("slip.csv", "A,0,0,0\nB,30,40,0\nC,200,10,0\nrial,300,10,0\n");
    bench.put("twice.csv", "A,0,0,0\na,30,40,0\n");
    bench.put("words.csv", "A,0,0,0\nB,35,sixty,0\n");
    bench.put("bent.csv", "A,0,0,0\nB,35,60,0\nC,250,190,4\nD,300,0,0\nP,130,200,0\n");
    bench.put("feet.csv", "name,x [ft],y [ft]\nA,0,0\n");
    bench.put("inches.csv", "name,x [in],y [in]\nA,0,0\n");
    let table = ["-t", "four-bar", "--hardpoints"];
    for (arguments, code, parts) in [
        (vec!["new", "mine", "-t", "four-bar"], 2, vec!["the file `mine.toml` exists already"]),
        (vec!["new", "mine.toml", "-t", "four-bar"], 2, vec!["the file `mine.toml` exists already"]),
        (vec!["new", "other", "-t", "fourbar2"], 2, vec!["did you mean `four-bar`?", "slider-crank"]),
        (vec!["new", "other"], 2, vec!["--template", "--list"]),
        (
            vec!["new", "other", "-t", "delta", "--hardpoints", "points.csv"],
            2,
            vec!["does not accept hardpoints"],
        ),
        ([&["new", "other"], &table[..], &["points.csv"]].concat(), 2, vec!["--units"]),
        (
            [&["new", "other"], &table[..], &["points.csv", "--units", "ft"]].concat(),
            2,
            vec!["mm, cm, m or in"],
        ),
        (
            [&["new", "other"], &table[..], &["points.csv", "--units", "mm"]].concat(),
            2,
            vec!["no hardpoint `E`", "no hardpoint `PP`: it is not used", "lacks the hardpoint `D`, `P`"],
        ),
        (
            vec!["new", "other", "-t", "slider-crank", "--hardpoints", "slip.csv", "--units", "mm"],
            2,
            vec!["no hardpoint `rial`: it is not used; did you mean `rail`?", "lacks the hardpoint `rail`"],
        ),
        (
            vec!["new", "other", "-t", "slider-crank", "--hardpoints", "twice.csv", "--units", "mm"],
            2,
            vec!["has the hardpoint `A` twice", "line 2"],
        ),
        (
            [&["new", "other"], &table[..], &["words.csv", "--units", "mm"]].concat(),
            2,
            vec!["line 2: `sixty` is not a number for y"],
        ),
        ([&["new", "other"], &table[..], &["none.csv", "--units", "mm"]].concat(), 2, vec!["`none.csv`"]),
        (
            [&["new", "other"], &table[..], &["bent.csv", "--units", "mm"]].concat(),
            2,
            vec!["do not lie in the plane", "`A` is at z = 0 mm, `C` at z = 4 mm", "--axes"],
        ),
        ([&["new", "other"], &table[..], &["feet.csv"]].concat(), 2, vec!["are in `ft`", "mm, cm, m or in"]),
        (
            [&["new", "other"], &table[..], &["inches.csv", "--units", "mm"]].concat(),
            2,
            vec!["are in `in`", "`--units` says `mm`"],
        ),
        (
            vec![
                "new",
                "other",
                "-t",
                "stewart",
                "--hardpoints",
                "points.csv",
                "--units",
                "mm",
                "--axes",
                "x up",
            ],
            2,
            vec!["--axes", "three axes"],
        ),
        (
            vec!["new", "other", "-t", "macpherson", "--hardpoints", "points.csv", "--units", "mm"],
            2,
            vec!["--axes"],
        ),
    ] {
        let (found, message) = output_of(&bench, &arguments);
        assert_eq!(found, Some(code), "{arguments:?}: {message}");
        for part in parts {
            assert!(message.contains(part), "{arguments:?}: {message}");
        }
        assert_eq!(
            bench.list("."),
            [
                "bent.csv",
                "feet.csv",
                "inches.csv",
                "mine.toml",
                "points.csv",
                "slip.csv",
                "twice.csv",
                "words.csv"
            ],
            "{arguments:?}"
        );
    }
    assert_eq!(bench.text("mine.toml"), "there\n");
}

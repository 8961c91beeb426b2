//! Snapshots of the output; only durations and round-off are hidden.

use crate::bench::Bench;

macro_rules! assert_shown {
    ($name:expr, $text:expr) => {
        insta::with_settings!({
            filters => vec![
                (r"time taken .*", "time taken [durations]"),
                (r"took .*", "took [duration]"),
                (r"worst residual( +)\S+", "worst residual$1[round-off]"),
                (r"smallest pivot there is \S+", "smallest pivot there is [ratio]"),
                (r"\(os error \d+\)", "(os error)"),
            ],
            omit_expression => true,
            prepend_module_to_snapshot => false,
            snapshot_path => "../snapshots",
        }, { insta::assert_snapshot!($name, $text) });
    };
}

#[test]
fn help_has_examples_and_exit_codes() {
    let bench = Bench::with(&[]);
    for command in [
        "",
        "new",
        "synthesize",
        "run",
        "check",
        "import",
        "export",
        "verify",
        "optimize",
        "trade-off",
        "tolerance",
        "sweep",
        "studio",
        "site",
        "mcp",
        "lsp",
        "schema",
        "completions",
    ] {
        let arguments: Vec<&str> = [command, "--help"].into_iter().filter(|a| !a.is_empty()).collect();
        let name = if command.is_empty() { "help".into() } else { format!("help_{command}") };
        assert_shown!(name, bench.shown(&arguments));
    }
}

#[test]
fn run_prints_a_summary_and_names_the_report() {
    let bench = Bench::with(&["slider.toml"]);
    assert_shown!("run", bench.shown(&["run", "slider.toml"]));
    assert_eq!(
        bench.list("results/slider"),
        ["motion.csv", "report.html", "sensitivity.csv", "summary.json"]
    );
}

#[test]
fn check_prints_all_facts() {
    let bench = Bench::with(&["slider.toml"]);
    assert_shown!("check", bench.shown(&["check", "slider.toml"]));
    assert_shown!("check_absolute", bench.shown(&["check", "slider.toml", "--absolute"]));
}

#[test]
fn a_model_with_errors_ends_with_3() {
    let bench = Bench::with(&["slider.toml"]);
    bench.put("broken.toml", &bench.text("slider.toml").replace("at = \"B\"", "at = \"BB\""));
    assert_shown!("bad_model", bench.shown(&["run", "broken.toml"]));
    assert_shown!("bad_model_json", bench.shown(&["run", "broken.toml", "--json"]));
    assert_shown!("no_model", bench.shown(&["check", "slidr.toml"]));
    assert!(bench.list("results").is_empty());
}

#[test]
fn a_mechanism_that_cannot_be_driven_ends_with_4() {
    let bench = Bench::with(&["slider.toml"]);
    let text = bench.text("slider.toml");
    let free: String = text.lines().filter(|l| !l.starts_with("motor")).map(|l| format!("{l}\n")).collect();
    bench.put("free.toml", &free);
    assert_shown!("under_driven", bench.shown(&["run", "free.toml"]));
    let second = "[drivers]\npush = { joint = \"guide\", law = \"t\" }";
    bench.put("over.toml", &text.replace("[drivers]", second));
    assert_shown!("over_driven", bench.shown(&["check", "over.toml"]));
    assert!(bench.list("results").is_empty());
}

#[test]
fn a_motion_past_its_limit_ends_with_5() {
    let bench = Bench::with(&["short_rod.toml"]);
    assert_shown!("limit", bench.shown(&["run", "short_rod.toml"]));
    assert_shown!("limit_verify", bench.shown(&["verify", "short_rod.toml"]));
    // The start is out of reach: the path to it from the design configuration ends.
    bench.put("far.toml", &bench.text("short_rod.toml").replace("360*t", "90 + 360*t"));
    assert_shown!("limit_at_start", bench.shown(&["run", "far.toml"]));
}

#[test]
fn a_folder_that_cannot_be_written_ends_with_6() {
    let bench = Bench::with(&["slider.toml"]);
    bench.put("file", "in the way");
    assert_shown!("not_written", bench.shown(&["run", "slider.toml", "-o", "file/results"]));
    let json = bench.run(&["verify", "slider.toml", "-o", "file/results", "--json"]);
    assert_eq!(json.status.code(), Some(6));
    let document: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(document["status"], "error");
    assert_eq!(document["diagnostics"][0]["code"], "HP0601");
}

#[test]
fn a_command_line_that_makes_no_sense_ends_with_2() {
    let bench = Bench::with(&["slider.toml"]);
    for arguments in [&["walk"][..], &["run"], &["verify", "slider.toml", "--steps", "2"]] {
        let output = bench.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{arguments:?}");
    }
}

#[test]
fn schema_is_that_of_the_reader_and_completions_know_the_commands() {
    let bench = Bench::with(&[]);
    let schema = bench.run(&["schema"]);
    assert_eq!(String::from_utf8(schema.stdout).unwrap(), hardpoint_file::schema());
    let bash = bench.run(&["completions", "bash"]);
    assert!(String::from_utf8(bash.stdout).unwrap().contains("verify"));
}

#[test]
fn no_colour_where_there_is_no_terminal() {
    let bench = Bench::with(&["slider.toml"]);
    let output = bench.run(&["run", "slider.toml"]);
    assert!(!output.stdout.contains(&0x1b) && !output.stderr.contains(&0x1b));
}

//! Examples of `--help`: every one of them runs.

use std::path::Path;

use hardpoint::model::OptimizationSettings;

use crate::bench::Bench;

/// Examples that take minutes, or need a server or a compiler.
const LEFT_OUT: [&str; 8] = [
    "studio",
    "site",
    "--samples 100000",
    "--points 60",
    "--starts 100",
    "sobol-indices",
    "strut_tolerances.toml",
    "corner.fmu",
];
/// Options whose file is written.
const WRITES: [&str; 3] = ["-o", "--output", "--save"];

/// Columns of the narrowest terminal in which examples are whole.
const TERMINAL: usize = 80;

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap().path();
        let to = to.join(entry.file_name().unwrap());
        if entry.is_dir() {
            copy(&entry, &to);
        } else {
            std::fs::copy(&entry, &to).unwrap();
        }
    }
}

/// Words of a command line; quotes keep spaces.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut is_quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match (c, is_quoted) {
            ('"', _) => is_quoted = !is_quoted,
            (' ', false) => words.push(String::new()),
            _ => words.last_mut().unwrap().push(c),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Examples of a command's help, without the programs that read their output.
fn examples(bench: &Bench, command: &str) -> Vec<String> {
    let arguments: Vec<&str> = [command, "--help"].into_iter().filter(|a| !a.is_empty()).collect();
    let help = String::from_utf8(bench.run(&arguments).stdout).unwrap();
    let Some((_, all)) = help.split_once("\nExample") else { panic!("`{command} --help` has no examples") };
    let mut found: Vec<String> = Vec::new();
    for line in all.lines().skip(1).take_while(|line| !line.is_empty()) {
        // A longer one is broken where a terminal ends, and no longer whole when it is copied.
        assert!(line.len() < TERMINAL, "`{command} --help`: {line}");
        let continued = found.last().and_then(|last| last.strip_suffix(" \\").map(str::to_owned));
        match (continued, line.trim_start().strip_prefix("hardpoint ")) {
            (Some(first), _) => {
                found.pop();
                found.push(format!("{first} {}", line.trim_start()));
            }
            (None, Some(example)) => found.push(example.into()),
            // Of another program.
            (None, None) => {}
        }
    }
    let alone = |line: &String| {
        let end = [" | ", " > "].iter().filter_map(|to| line.find(to)).min();
        line[..end.unwrap_or(line.len())].to_owned()
    };
    found.iter().map(alone).collect()
}

#[test]
fn the_default_number_of_iterations_is_that_of_the_file() {
    let bench = Bench::with(&[]);
    let default = OptimizationSettings::default().iterations;
    for command in ["optimize", "trade-off"] {
        let help = String::from_utf8(bench.run(&[command, "--help"]).stdout).unwrap();
        let words = help.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(&format!("that of the file, or {default}]")), "{help}");
    }
}

#[test]
fn a_negative_number_after_an_option_is_its_value() {
    let bench = Bench::with(&[]);
    for (arguments, expected) in [
        (["sweep", "four_bar.toml", "--samples", "-5"], "'-5' for '--samples <N>': -5 is not in "),
        (
            ["optimize", "four_bar.toml", "--starts", "-1"],
            "'-1' for '--starts <N>': -1 is not a whole number from 1",
        ),
    ] {
        let output = bench.run(&arguments);
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains(expected) && output.status.code() == Some(2), "{text}");
    }
}

#[test]
fn every_example_of_every_help_runs() {
    let bench = Bench::with(&[]);
    copy(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models"), &bench.path("models"));
    let help = String::from_utf8(bench.run(&["--help"]).stdout).unwrap();
    let (_, commands) = help.split_once("\nCommands:\n").unwrap();
    let commands = commands.lines().take_while(|line| !line.is_empty());
    let commands = commands.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let commands =
        commands.map(|line| line.split_whitespace().next().unwrap()).filter(|name| *name != "help");
    let (mut run, mut of_users, mut failed) = (0, 0, Vec::new());
    for example in [""].into_iter().chain(commands).flat_map(|command| examples(&bench, command)) {
        if LEFT_OUT.iter().any(|part| example.contains(part)) {
            continue;
        }
        let words = words(&example);
        let is_file = |k: usize| {
            let is_named =
                [".toml", ".csv", ".xlsx", ".asmt", ".adm", ".xml"].iter().any(|end| words[k].ends_with(end));
            is_named && !WRITES.contains(&words[k - 1].as_str())
        };
        // A file of the user; those of `models` exist.
        let mut files = (1..words.len()).filter(|k| is_file(*k));
        if files.any(|k| !words[k].starts_with("models/") && words[k] != "strut_2.toml") {
            of_users += 1;
            continue;
        }
        run += 1;
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let output = bench.run(&words);
        let code = output.status.code();
        // The knee of the gallery is nearer to its limit than permitted.
        if code != Some(i32::from(words[0] == "clearance")) {
            failed
                .push(format!("hardpoint {example}: {code:?}\n{}", String::from_utf8_lossy(&output.stderr)));
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    assert!(run > 40 && of_users < run / 2, "{run} {of_users}");
}

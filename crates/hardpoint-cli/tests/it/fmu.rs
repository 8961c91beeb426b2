//! FMUs: contents of the archive, with and without a C compiler. The Python tests run them in an importer.

use std::fs::File;
use std::io::Read;
use std::process::Command;

use crate::bench::Bench;

/// Paths and contents of an archive, in order.
fn contents(bench: &Bench, name: &str) -> Vec<(String, Vec<u8>)> {
    let mut zip = zip::ZipArchive::new(File::open(bench.path(name)).unwrap()).unwrap();
    let count = zip.len();
    let file = |k: usize| {
        let mut file = zip.by_index(k).unwrap();
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        (file.name().unwrap().into_owned(), bytes)
    };
    (0..count).map(file).collect()
}

fn text(contents: &[(String, Vec<u8>)], path: &str) -> String {
    let file = contents.iter().find(|(name, _)| name == path).unwrap_or_else(|| panic!("no {path}"));
    String::from_utf8(file.1.clone()).unwrap()
}

const FILES: [&str; 7] = [
    "modelDescription.xml",
    "sources/buildDescription.xml",
    "sources/slider.h",
    "sources/slider.c",
    "sources/fmi3.h",
    "sources/fmi3.c",
    "documentation/index.html",
];

#[test]
fn a_unit_contains_its_sources_and_a_library() {
    let bench = Bench::with(&["slider.toml"]);
    let shown = bench.shown(&["export", "slider.toml", "-o", "slider.fmu"]);
    assert!(shown.ends_with("exit 0\n"), "{shown}");
    let all = contents(&bench, "slider.fmu");
    let names: Vec<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names[..FILES.len()], FILES);
    // The tests of Rust need a C compiler to link.
    assert_eq!(names.len(), FILES.len() + 1);
    let library = names[FILES.len()];
    assert!(library.starts_with("binaries/") && library.contains("/slider."), "{library}");
    assert!(shown.contains("compiled for"), "{shown}");

    let description = text(&all, "modelDescription.xml");
    let source = text(&all, "sources/fmi3.c");
    let (_, token) = description.split_once("instantiationToken=\"").unwrap();
    let token = &token[..38];
    assert!(source.contains(&format!("#define TOKEN \"{token}\"")));
    // Value references are the indices of the table in the source.
    let references: Vec<usize> = description
        .lines()
        .filter(|line| line.contains("<Float64"))
        .map(|line| {
            line.split_once("valueReference=\"").unwrap().1.split('"').next().unwrap().parse().unwrap()
        })
        .collect();
    assert_eq!(references, (0..references.len()).collect::<Vec<_>>());
    let (_, table) = source.split_once("variables[] = {\n").unwrap();
    let (table, _) = table.split_once("\n};").unwrap();
    assert_eq!(table.lines().count(), references.len());
    // No place of a template is left.
    for (name, _) in &all[..FILES.len()] {
        let text = text(&all, name);
        assert!(!text.contains("@name@") && !text.contains("@NAME@"), "{name}");
    }

    // The same model gives the same unit.
    std::fs::rename(bench.path("slider.fmu"), bench.path("first.fmu")).unwrap();
    bench.run(&["export", "slider.toml", "-o", "slider.fmu"]);
    assert_eq!(text(&contents(&bench, "slider.fmu"), "modelDescription.xml"), description);

    // The name of the file need not be an identifier.
    let shown = bench.shown(&["export", "slider.toml", "-o", "my slider-2.fmu"]);
    assert!(shown.contains("compiled for"), "{shown}");
    let named = contents(&bench, "my slider-2.fmu");
    assert!(text(&named, "sources/my_slider_2.c").contains("#include \"my_slider_2.h\""));

    // A variable that would jam the mechanism is no parameter.
    assert!(
        shown.contains("design variable `guide_jam`: nominal: the mechanism cannot follow it"),
        "{shown}"
    );
    assert!(description.contains("design.guide_turn") && !description.contains("guide_jam"));
    assert!(text(&all, "documentation/index.html").contains("<code>guide_jam</code>"));
}

#[test]
fn without_a_compiler_a_unit_contains_sources_only() {
    let bench = Bench::with(&["slider.toml"]);
    let run = |set: &dyn Fn(&mut Command), more: &[&str]| {
        let mut command = bench.command(&[&["export", "slider.toml", "-o", "slider.fmu"], more].concat());
        set(&mut command);
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let names = || contents(&bench, "slider.fmu").into_iter().map(|(name, _)| name).collect::<Vec<_>>();
    let missing = |command: &mut Command| _ = command.env_remove("CC").env("PATH", "");
    let shown = run(&missing, &[]);
    assert!(
        shown.contains("sources only, which the importer compiles: there is no C compiler `cc`"),
        "{shown}"
    );
    assert_eq!(names(), FILES);
    let shown = run(&missing, &["--json"]);
    let shown: serde_json::Value = serde_json::from_str(&shown).unwrap();
    assert!(shown["platform"].is_null());
    let failing = |command: &mut Command| _ = command.env("CC", "false");
    let shown = run(&failing, &[]);
    assert!(shown.contains("the C compiler `false` failed"), "{shown}");
    assert_eq!(names(), FILES);
}

#[test]
fn the_design_is_an_argument_only_where_there_is_motion() {
    let bench = Bench::with(&["slider.toml"]);
    let shown = bench.shown(&["export", "slider.toml", "-o", "slider.urdf", "--design"]);
    assert!(shown.contains("`--design`: the format urdf does not contain the motion"), "{shown}");
    assert!(shown.ends_with("exit 2\n"), "{shown}");
}

#[test]
fn names_outside_ascii_are_unique_in_a_unit_and_reported() {
    let bench = Bench::with(&[]);
    let model = r#"
name = "crank"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { O = [0, 0], A = [20, 5] }
bodies = { ground = ["O"], crank = ["O", "A"] }
drivers.motor = { joint = "O", law = "30*t" }
points.A = { body = "crank", at = "A" }
measures."α" = { type = "coordinate", joint = "O" }
measures."β" = { type = "position", point = "A", along = "x" }
time = { end = 1, steps = 4 }
"#;
    bench.put("greek.toml", model);
    let shown = bench.shown(&["export", "greek.toml", "-o", "greek.fmu"]);
    assert!(shown.ends_with("exit 0\n"), "{shown}");
    assert!(shown.contains("name `β`: named __2 in the unit"), "{shown}");
    let description = text(&contents(&bench, "greek.fmu"), "modelDescription.xml");
    let names: Vec<&str> = description
        .lines()
        .filter(|line| line.contains("<Float64"))
        .map(|line| line.split_once(" name=\"").unwrap().1.split('"').next().unwrap())
        .collect();
    let different: std::collections::HashSet<&str> = names.iter().copied().collect();
    assert_eq!(different.len(), names.len(), "{names:?}");
    assert!(names.iter().all(|name| name.is_ascii()), "{names:?}");
    assert!(description.contains("Measure β"), "{description}");
}

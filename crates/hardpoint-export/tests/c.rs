//! Motions exported as C, compiled, and compared with those of the engine.
//!
//! The compiler is `cc`, which Rust itself links with; where `clang` is installed, it compiles derivatives by the
//! design, for which it takes less time.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use hardpoint::joint::Quantity;
use hardpoint::law::Law;
use hardpoint::model::VariableId;
use hardpoint::space::Vec3;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_export::{ExportError, ExportOptions, Format};
use hardpoint_file::ModelFile;

/// Largest difference from the engine, relative to the largest number of its kind in the motion: the formulas are those
/// of the engine, but their Newton iterations begin elsewhere, and products are not fused with sums.
const SAME: f64 = 1e-12;
/// The same where the motion passes near singular positions, which magnify round-off.
const NEAR_SINGULAR: f64 = 1e-11;

/// The same for measures of changed designs, which are farther from round numbers.
const CHANGED: f64 = 2e-12;
/// The same for derivatives by the design: those of accelerations divide by the Jacobian three times, and each division
/// magnifies round-off by the condition of the mechanism.
const DERIVATIVE: f64 = 1e-11;

/// Models that have no formulas, with the reason.
const REFUSED: [(&str, &str); 0] = [];
/// Models whose motion the formulas do not follow to the end, and the reported time.
const ENDS: [(&str, &str); 1] = [("bricard", "from t =")];

/// Measures that are undefined or have a kink at some output times.
const PARTIAL: [&str; 2] = ["front_axle: front.ackermann_error", "front_axle: front.ackermann"];

fn model(name: &str) -> ModelFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.toml"));
    hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}"))
}

fn gallery() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let models = files.filter(|p: &PathBuf| p.extension().is_some_and(|e| e == "toml"));
    let mut names: Vec<String> =
        models.map(|p| p.file_stem().unwrap().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// A compiled step.
struct Compiled {
    folder: tempfile::TempDir,
    /// Names that the export reported.
    unsupported: Vec<String>,
    /// Names in the comments of the measures, in order.
    measures: Vec<String>,
    /// Measures that are reported as undefined at some output times.
    partial: Vec<String>,
    /// Design variables that are arguments, in order.
    design: Vec<String>,
}

/// Motion of every driver at a step: value, rate and acceleration.
type Drivers = Vec<[f64; 3]>;

/// Result of a step.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    result: i32,
    moves: usize,
    /// 24 numbers of every body: by component, r, the columns of A, v, omega, a, alpha.
    bodies: Vec<f64>,
    /// Value, rate and acceleration of every measure.
    measures: Vec<[f64; 3]>,
    /// Per measure and driver.
    jacobian: Vec<f64>,
}

fn is_there(compiler: &str) -> bool {
    Command::new(compiler).arg("--version").output().is_ok()
}

impl Compiled {
    /// Compiles with all warnings as errors.
    fn new(file: &ModelFile, stem: &str, optimise: &str) -> Result<Self, ExportError> {
        Self::of(file, stem, optimise, ExportOptions::default(), include_str!("main.c"))
    }

    fn of(
        file: &ModelFile,
        stem: &str,
        optimise: &str,
        options: ExportOptions,
        main: &str,
    ) -> Result<Self, ExportError> {
        let exported = Format::named("c").unwrap().export_with(file, stem, options)?;
        let header = exported.companion.expect("a header");
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        write(&format!("{stem}.c"), &exported.text);
        write(&format!("{stem}.{}", header.ending), &header.text);
        let main = main.replace("@name@", stem);
        write("main.c", &main.replace("@NAME@", &stem.to_ascii_uppercase()));
        let compiler = if options.design && is_there("clang") { "clang" } else { "cc" };
        let compiled = Command::new(compiler)
            .current_dir(folder.path())
            .args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", optimise])
            .args(["main.c", &format!("{stem}.c"), "-o", "main", "-lm"])
            .output()
            .expect("a C compiler, `cc`");
        assert!(compiled.status.success(), "{stem}: {}", String::from_utf8_lossy(&compiled.stderr));
        let name = |line: &str| line.split_once("/* ").unwrap().1.split(", ").next().unwrap().to_owned();
        let enumerated = |kind: &str| -> Vec<String> {
            let marker = format!("    {}_{kind}_", stem.to_ascii_uppercase());
            header.text.lines().filter(|l| l.starts_with(&marker)).map(name).collect()
        };
        let (measures, design) = (enumerated("MEASURE"), enumerated("DESIGN"));
        let partial = exported.unsupported.iter().filter(|u| u.why.starts_with("NaN at"));
        let partial = partial.map(|u| u.name.clone()).collect();
        let unsupported = exported.unsupported.into_iter().map(|u| u.name).collect();
        Ok(Self { folder, unsupported, measures, partial, design })
    }

    /// Output of the program for these numbers.
    fn answer(&self, numbers: impl Iterator<Item = f64>) -> String {
        let mut child = Command::new(self.folder.path().join("main"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let input: String = numbers.map(|x| format!("{x:e} ")).collect();
        let mut stdin = child.stdin.take().unwrap();
        let writer = std::thread::spawn(move || stdin.write_all(input.as_bytes()).unwrap());
        let output = child.wait_with_output().unwrap();
        writer.join().unwrap();
        assert!(output.status.success());
        String::from_utf8(output.stdout).unwrap()
    }

    /// Steps through these motions of the drivers.
    fn run(&self, steps: &[Drivers], bodies: usize) -> Vec<Row> {
        let row = |line: &str| {
            let numbers: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
            let (head, rest) = numbers.split_at(2);
            let solved = head[0] == 0.0;
            let (bodies, rest) = rest.split_at(if solved { 24 * (bodies - 1) } else { 0 });
            let (measures, jacobian) = rest.split_at(if solved { 3 * self.measures.len() } else { 0 });
            Row {
                result: head[0] as i32,
                moves: head[1] as usize,
                bodies: bodies.to_vec(),
                measures: measures.as_chunks().0.to_vec(),
                jacobian: jacobian.to_vec(),
            }
        };
        self.answer(steps.iter().flatten().flatten().copied()).lines().map(row).collect()
    }
}

/// The drivers' motion at all output times.
fn drivers(analysis: &Analysis<'_>, solution: &Solution) -> Vec<Drivers> {
    let of = |law: &Law, t: f64| {
        let [value, rate, acceleration, _] = law.at(t).derivatives();
        [value, rate, acceleration]
    };
    let at = |t: &f64| analysis.model().drivers.iter().map(|d| of(&d.law, *t)).collect();
    solution.motion.times.iter().map(at).collect()
}

/// Largest difference between two lists, relative to the largest number, or to one. Both may be undefined.
fn difference(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let size = expected.iter().filter(|x| x.is_finite()).fold(1.0_f64, |most, x| most.max(x.abs()));
    let apart = |(a, b): (&f64, &f64)| if a.is_nan() && b.is_nan() { 0.0 } else { (a - b).abs() };
    // NaN is the largest.
    found.iter().zip(expected).map(apart).fold(0.0, |most, x| if most >= x { most } else { x }) / size
}

/// Compares a step with the engine at all output times that it reaches.
fn compare(
    name: &str,
    c: &Compiled,
    analysis: &Analysis<'_>,
    solution: &Solution,
    rows: &[Row],
    tolerance: f64,
) {
    let bodies = analysis.model().bodies.len();
    let expected = |k: usize| -> Vec<f64> {
        let of_body = |b: usize| {
            let s = solution.motion.at(k).body(b);
            let [x, y, z] = s.rotation.cols;
            let all = [s.r, x, y, z, s.v, s.omega, s.a, s.alpha].map(Vec3::to_array);
            (0..3).flat_map(move |i| all.map(|v| v[i]))
        };
        (1..bodies).flat_map(of_body).collect()
    };
    // Positions, axes, velocities, ... each by their own size.
    let all: Vec<Vec<f64>> = (0..rows.len()).map(expected).collect();
    for kind in 0..8 {
        let of_kind = |numbers: &[f64]| numbers.iter().skip(kind).step_by(8).copied().collect::<Vec<f64>>();
        let found: Vec<f64> = rows.iter().flat_map(|row| of_kind(&row.bodies)).collect();
        let expected: Vec<f64> = all.iter().flat_map(|numbers| of_kind(numbers)).collect();
        let apart = difference(&found, &expected);
        assert!(apart < tolerance, "{name}: numbers {kind} of the bodies differ by {apart:e}");
    }
    for (m, measure) in c.measures.iter().enumerate() {
        let column =
            solution.measured.index(measure).unwrap_or_else(|| panic!("{name}: no measure {measure}"));
        for order in 0..3 {
            let at = |k: usize| solution.measured.value(k, column)[order];
            let mut expected: Vec<f64> = (0..rows.len()).map(at).collect();
            let found: Vec<f64> = rows.iter().map(|row| row.measures[m][order]).collect();
            if c.partial.contains(measure) {
                assert!(
                    order > 0 || found.iter().any(|x| x.is_finite()),
                    "{name}: {measure} is nowhere defined"
                );
                expected.iter_mut().zip(&found).filter(|(_, x)| x.is_nan()).for_each(|(x, _)| *x = f64::NAN);
            }
            let apart = difference(&found, &expected);
            assert!(apart < tolerance, "{name}: {measure}, order {order}, differs by {apart:e}");
        }
    }
    // The rate is the sum of the derivatives by the drivers, times their rates.
    let motions = drivers(analysis, solution);
    let count = analysis.model().drivers.len();
    let along = |(row, drivers): (&Row, &Drivers)| -> Vec<f64> {
        let product = |line: &[f64]| line.iter().zip(drivers).map(|(d, [_, rate, _])| d * rate).sum();
        row.jacobian.chunks(count).map(product).collect()
    };
    let sums: Vec<f64> = rows.iter().zip(&motions).flat_map(along).collect();
    let rates: Vec<f64> = rows.iter().flat_map(|row| row.measures.iter().map(|m| m[1])).collect();
    let apart = difference(&sums, &rates);
    assert!(apart < tolerance, "{name}: rates differ from those of the Jacobian by {apart:e}");
}

#[test]
fn the_gallery_in_c_moves_as_in_the_engine() {
    let (mut refused, mut partial) = (Vec::new(), Vec::new());
    for name in gallery() {
        let file = model(&name);
        let c = match Compiled::new(&file, &name, "-O0") {
            Ok(c) => c,
            Err(ExportError::NotRecorded { why }) => {
                refused.push((name, why));
                continue;
            }
            Err(error) => panic!("{name}: {error:?}"),
        };
        partial.extend(c.partial.iter().map(|measure| format!("{name}: {measure}")));
        let analysis = Analysis::new(&file.model).unwrap();
        let solution = analysis.run();
        let rows = c.run(&drivers(&analysis, &solution), file.model.bodies.len());
        let reached = rows.iter().take_while(|row| row.result == 0).count();
        let reported = c.unsupported.iter().any(|u| u.starts_with("from t ="));
        let ends = ENDS.iter().any(|(other, _)| *other == name);
        assert_eq!(reported, ends, "{name}: {:?}", c.unsupported);
        assert_eq!(reached < rows.len(), ends, "{name}: {reached} of {} steps", rows.len());
        let tolerance = if ends { NEAR_SINGULAR } else { SAME };
        compare(&name, &c, &analysis, &solution, &rows[..reached], tolerance);
    }
    let expected = REFUSED.map(|(name, why)| (name.to_owned(), why.to_owned()));
    assert_eq!(refused, expected);
    assert_eq!(partial, PARTIAL);
}

/// The inputs of a reversed driver are values of its laws, as are those of the derivatives.
#[test]
fn a_reversed_driver_in_c_counts_like_its_laws() {
    let text = std::fs::read_to_string("../../models/four_bar.toml").unwrap();
    let text = text.replace("law = \"360*t\"", "law = \"20 + 360*t^2\", reversed = true");
    let file = hardpoint_file::parse(&text, "reversed.toml").unwrap_or_else(|e| panic!("{e}"));
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let crank = solution.measured.index("crank_angle").unwrap();
    assert!((solution.measured.value(0, crank)[0] + 20_f64.to_radians()).abs() < SAME);
    let steps = drivers(&analysis, &solution);
    assert!((steps[0][0][0] - 20_f64.to_radians()).abs() < SAME);
    let c = Compiled::new(&file, "reversed", "-O0").unwrap();
    let rows = c.run(&steps, file.model.bodies.len());
    assert!(rows.iter().all(|row| row.result == 0));
    compare("reversed", &c, &analysis, &solution, &rows, SAME);
}

/// A four-bar linkage turns by two radians in a single step, and by a hundred small ones: the path is divided until
/// both lead to the same position.
#[test]
fn a_long_step_is_divided() {
    let file = model("four_bar");
    // Optimised, the compiler sees more to warn about.
    let c = Compiled::new(&file, "four_bar", "-O2").unwrap();
    let bodies = file.model.bodies.len();
    let start = file.model.drivers[0].law.at(file.model.times[0]).value();
    let at = |part: f64| vec![[start + 2.0 * part, 3.0, 4.0]];
    let small: Vec<Drivers> = (0..=100).map(|k| at(f64::from(k) / 100.0)).collect();
    let small = c.run(&small, bodies);
    let [long] = &c.run(&[at(1.0)], bodies)[..] else { panic!("one row") };
    assert_eq!(long.result, 0);
    assert!(long.moves > 3, "{} moves", long.moves);
    let last = small.last().unwrap();
    assert_eq!((last.result, last.moves), (0, 1));
    assert!(difference(&long.bodies, &last.bodies) < SAME);
}

/// A platform one leg of which is asked to become ten metres longer than the others, or no number, stays where it was.
#[test]
fn a_step_that_fails_leaves_the_state() {
    let file = model("stewart");
    let c = Compiled::new(&file, "stewart", "-O0").unwrap();
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let good = drivers(&analysis, &solution)[..3].to_vec();
    let with = |x: f64| -> Drivers {
        let mut drivers = good[1].clone();
        drivers[0][0] += x;
        drivers
    };
    let steps = [good[0].clone(), good[1].clone(), with(10.0), with(f64::NAN), good[2].clone()];
    let bodies = file.model.bodies.len();
    let rows = c.run(&steps, bodies);
    let undisturbed = c.run(&good, bodies);
    let results: Vec<bool> = rows.iter().map(|row| row.result == 0).collect();
    assert_eq!(results, [true, true, false, false, true]);
    assert_eq!(rows[3].result, 1, "not finite");
    assert_ne!(rows[2].result, 1);
    assert_eq!(rows[4], undisturbed[2]);
}

/// A file whose header would hide `math.h`, or which no `#include` can name, is refused with another name; a name that
/// is no identifier has a prefix that is one, which is reported. Keywords of C are prefixes like other names.
#[test]
fn the_name_of_a_file_is_that_of_a_header() {
    let file = model("four_bar");
    let export = |name: &str, stem: &str| Format::named(name).unwrap().export(&file, stem);
    for (format, stem, why, name) in [
        ("c", "math", "would hide", "`math_motion`"),
        ("c", "Stdio", "would hide", "`Stdio_motion`"),
        ("fmu", "string", "would hide", "`string_motion`"),
        ("c", "a\"b", "cannot be part of", "`a_b`"),
        ("c", "corner@2", "cannot be part of", "`corner_2`"),
    ] {
        match export(format, stem) {
            Err(ExportError::UnfitName { why: found, help }) => {
                assert!(found.contains(why) && help.contains(name), "{stem}: {found}; {help}");
            }
            other => panic!("{stem}: {other:?}"),
        }
    }
    let exported = export("c", "my corner-2").unwrap();
    let prefix = exported.unsupported.iter().find(|u| u.kind == "name" && u.name == "my corner-2").unwrap();
    assert!(prefix.why.contains("`my_corner_2`"), "{}", prefix.why);
    assert!(
        exported.text.contains("#include \"my corner-2.h\"") && exported.text.contains("my_corner_2_step(")
    );
    let keyword = Compiled::new(&file, "int", "-O0").unwrap();
    assert!(!keyword.unsupported.contains(&"int".to_owned()));
}

/// Measures of loads and those found by iterations are reported, not written.
#[test]
fn what_is_not_written_is_reported() {
    let file = model("press");
    let exported = Format::named("c").unwrap().export(&file, "press").unwrap();
    let loads = file.model.measures.iter().filter(|m| m.kind.is_load());
    let mut count = 0;
    for measure in loads {
        assert!(exported.unsupported.iter().any(|u| u.name == measure.name), "{}", measure.name);
        count += 1;
    }
    assert!(count > 0);
    let variables = exported.unsupported.iter().find(|u| u.kind == "design variables");
    let expected = (!file.model.variables.is_empty()).then(|| file.model.variables.len().to_string());
    assert_eq!(variables.map(|u| u.name.clone()), expected);
}

/// The articulation of a ball joint has no rate where it is zero, which is at the first of the output times.
#[test]
fn a_measure_with_a_kink_at_an_output_time_is_reported_with_that_reason() {
    let text = r#"name = "kink"
units = { length = "mm", angle = "deg" }
hardpoints.A = [0, 0, 0]
bodies.arm = {}
joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "A", axis = "z" }
joints.ball = { type = "spherical", bodies = ["ground", "arm"], at = "A" }
drivers.motor = { joint = "hinge", law = "10 * t" }
measures.angle = { type = "articulation", joint = "ball" }
time = { end = 1, steps = 4 }
"#;
    let file = hardpoint_file::parse(text, "kink.toml").unwrap_or_else(|e| panic!("{e}"));
    let exported = Format::named("c").unwrap().export(&file, "kink").unwrap();
    let why: Vec<&str> =
        exported.unsupported.iter().filter(|u| u.name == "angle").map(|u| u.why.as_str()).collect();
    assert_eq!(why, ["NaN at 1 of 5 output times, where it is undefined or has a kink"]);
}

/// Models with design variables that are not arguments, with the reason.
const FIXED_DESIGN: [(&str, &str); 0] = [];

/// Variables without derivatives at the changed design: its redundant constraints contradict each other. The engine
/// still has derivatives by `y_knee_y`, which opens none of them.
const JAMMED: [&str; 5] =
    ["sarrus: x_knee_x", "sarrus: x_knee_z", "sarrus: x_base_x", "sarrus: y_knee_y", "sarrus: x_knee_skew"];

/// A changed design moves as in the engine, and the derivatives by the design are the engine's sensitivities.
#[test]
fn a_changed_design_in_c_is_that_of_the_engine() {
    let (mut fixed, mut differ, mut jammed) = (Vec::new(), Vec::new(), Vec::new());
    let mut compared = 0;
    for name in gallery() {
        let file = model(&name);
        let model = &file.model;
        if model.variables.is_empty() || REFUSED.iter().any(|(other, _)| *other == name) {
            continue;
        }
        let options = ExportOptions { design: true };
        let c = match Compiled::of(&file, &name, "-O0", options, include_str!("design.c")) {
            Ok(c) => c,
            Err(ExportError::NotRecorded { why }) => {
                fixed.push((name, why));
                continue;
            }
            Err(error) => panic!("{name}: {error:?}"),
        };
        let analysis = Analysis::new(model).unwrap();
        let arguments: Vec<usize> =
            c.design.iter().map(|d| model.variables.iter().position(|v| v.name == *d).unwrap()).collect();
        // Every variable changes by about a hundredth of the mechanism, in either direction.
        let change = |(at, k): (usize, &usize)| {
            let size = match model.variables[*k].quantity {
                Quantity::Length => 0.005 * model.size(),
                Quantity::Angle | Quantity::Number => 0.01,
            };
            if at % 2 == 0 { size } else { -size }
        };
        let changes: Vec<f64> = arguments.iter().enumerate().map(change).collect();
        let mut design = vec![0.0; model.variables.len()];
        arguments.iter().zip(&changes).for_each(|(k, x)| design[*k] = *x);
        let solution = analysis.solve(Run::new().at(&design));
        let steps = drivers(&analysis, &solution);
        let answer = c.answer(changes.iter().copied().chain(steps.iter().flatten().flatten().copied()));
        let mut lines = answer.lines();
        assert_eq!(lines.next(), Some("0"), "{name}: the design is not reached");
        let rows: Vec<Vec<f64>> =
            lines.map(|line| line.split(' ').map(|x| x.parse().unwrap()).collect()).collect();
        assert_eq!(rows.len(), steps.len());
        let reached = rows.iter().take_while(|row| row[0] == 0.0).count();
        let ends = ENDS.iter().any(|(other, _)| *other == name);
        assert_eq!(reached < rows.len(), ends, "{name}: {reached} of {} steps", rows.len());
        let (rows, tolerance) = (&rows[..reached], if ends { NEAR_SINGULAR } else { CHANGED });
        let numbers = |at: usize| -> Vec<f64> { rows.iter().map(|row| row[1 + at]).collect() };
        for (m, measure) in c.measures.iter().enumerate() {
            if PARTIAL.contains(&format!("{name}: {measure}").as_str()) {
                continue;
            }
            let column = solution.measured.index(measure).unwrap();
            for order in 0..3 {
                let value = |k: usize| solution.measured.value(k, column)[order];
                let expected: Vec<f64> = (0..rows.len()).map(value).collect();
                let apart = difference(&numbers(3 * m + order), &expected);
                if !(apart < tolerance) {
                    differ.push(format!("{name}: {measure}, order {order}, by {apart:e}"));
                }
                for (b, variable) in arguments.iter().enumerate() {
                    let d = |k: usize| solution.measured.d(k, VariableId(*variable), column)[order];
                    let expected: Vec<f64> = (0..rows.len()).map(d).collect();
                    let at = 3 * c.measures.len() + 3 * (m * arguments.len() + b) + order;
                    // Redundant constraints of the changed design may contradict each other, somewhere in the motion.
                    let found = numbers(at);
                    let is_defined = !solution.measured.value(0, column)[order].is_nan();
                    let is_jammed = is_defined && expected.iter().all(|x| x.is_nan());
                    if is_jammed || found.iter().zip(&expected).any(|(x, y)| x.is_nan() && !y.is_nan()) {
                        let variable = format!("{name}: {}", c.design[b]);
                        assert!(found.iter().any(|x| x.is_nan()), "{variable}: {measure} has derivatives");
                        if !jammed.contains(&variable) {
                            jammed.push(variable);
                        }
                        continue;
                    }
                    let apart = difference(&found, &expected);
                    let by = &c.design[b];
                    if !(apart < DERIVATIVE) {
                        differ.push(format!("{name}: d {measure} / d {by}, order {order}, by {apart:e}"));
                    }
                    compared += 1;
                }
            }
        }
    }
    let expected = FIXED_DESIGN.map(|(name, why)| (name.to_owned(), why.to_owned()));
    assert_eq!(fixed, expected);
    assert_eq!(differ, Vec::<String>::new());
    assert_eq!(jammed, JAMMED);
    assert!(compared > 1000, "{compared} derivatives");
}

/// A closed cam whose roller has a given distance from the curve, moved by its hardpoints.
const ROLLER: &str = r#"
name = "roller"
units = { length = "mm", angle = "deg" }
hardpoints = { shaft = [0, 0, 0], roller = [2, 42, 10], guide = [0, 80, 0] }
bodies = { cam = {}, slide = {} }
drivers.motor = { joint = "shaft", law = "800*t" }
design.shaft_x = { move = "shaft", along = "x" }
measures.lift = { type = "coordinate", joint = "guide" }
time = { end = 1, steps = 400 }
[joints]
shaft = { type = "revolute", bodies = ["ground", "cam"], at = "shaft", axis = "z" }
guide = { type = "translational", bodies = ["ground", "slide"], at = "guide", axis = "y" }
[joints.follower]
type = "point_on_curve"
bodies = ["cam", "slide"]
at = ["shaft", "roller"]
axis = "z"
length = 12
curve = { closed = true, points = [
    [0, 30, 0], [-21, 21, 0], [-28, 0, 0], [-22, -20, 0], [0, -26, 0], [23, -22, 0], [28, 0, 0], [21, 20, 0]
] }
"#;

/// Exports a model whose design variables are all arguments, and compares its motion and the derivatives of all
/// measures with those of the engine at this design.
fn compare_design(name: &str, text: &str, change: &[f64]) {
    let file = hardpoint_file::parse(text, name).unwrap_or_else(|e| panic!("{e}"));
    let options = ExportOptions { design: true };
    let c = Compiled::of(&file, name, "-O0", options, include_str!("design.c")).unwrap();
    assert_eq!(c.design.len(), change.len(), "{name}: {:?}", c.design);
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.solve(Run::new().at(change));
    let steps = drivers(&analysis, &solution);
    assert_eq!(steps.len(), file.model.times.len(), "{name}: {:?}", solution.stop);
    let answer = c.answer(change.iter().chain(steps.iter().flatten().flatten()).copied());
    let mut lines = answer.lines();
    assert_eq!(lines.next(), Some("0"), "{name}: the design is not reached");
    let rows: Vec<Vec<f64>> = lines.map(|l| l.split(' ').map(|x| x.parse().unwrap()).collect()).collect();
    assert!(rows.len() == steps.len() && rows.iter().all(|row| row[0] == 0.0), "{name}");
    for (m, measure) in c.measures.iter().enumerate() {
        let column = solution.measured.index(measure).unwrap();
        for order in 0..3 {
            let of = |first: usize| rows.iter().map(|row| row[1 + first + order]).collect::<Vec<f64>>();
            let value = |k: usize| solution.measured.value(k, column)[order];
            let values: Vec<f64> = (0..rows.len()).map(value).collect();
            let apart = difference(&of(3 * m), &values);
            assert!(apart < CHANGED, "{name}: {measure}, order {order} by {apart:e}");
            for (b, variable) in c.design.iter().enumerate() {
                let d = |k: usize| solution.measured.d(k, VariableId(b), column)[order];
                let by: Vec<f64> = (0..rows.len()).map(d).collect();
                let apart = difference(&of(3 * (c.measures.len() + m * change.len() + b)), &by);
                assert!(apart < DERIVATIVE, "{name}: {measure} by {variable}, order {order} by {apart:e}");
            }
        }
    }
}

#[test]
fn a_cam_with_a_given_distance_has_its_hardpoints_as_arguments() {
    compare_design("roller", ROLLER, &[2e-3]);
}

/// The distance of a roller from its curve is that in the design configuration, from the foot of the perpendicular,
/// which moves over several pieces of the curve; a follower in a slot has none until the design moves it off the curve.
#[test]
fn a_cam_whose_distance_is_that_of_the_design_has_its_hardpoints_as_arguments() {
    let moves = "design.roller_x = { move = \"roller\", along = \"x\" }\n\
                 design.roller_y = { move = \"roller\", along = \"y\" }\n\
                 design.turn = { tilt = \"follower\", about = \"z\" }\n\
                 design.shaft_x";
    let text = ROLLER.replace("length = 12\n", "").replace("design.shaft_x", moves);
    assert_eq!(text.matches("length").count(), 1);
    compare_design("measured_roller", &text, &[15e-3, -4e-3, 0.1, 2e-3]);
    let text = std::fs::read_to_string("../../models/cam.toml").unwrap();
    let text = text.replace(", fixed_length = true", "").replace("motor_speed = {", "# motor_speed = {");
    compare_design("cam", &text, &[1e-4, 2e-4, 0.01, 1e-3]);
}

/// The examples of `docs/export-c.md`, as one file.
#[test]
fn the_examples_of_the_page_compile() {
    let page = include_str!("../../../docs/export-c.md");
    let blocks = page.split("```c\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    let main = "int main(void)\n{\n    static double zero[CORNER_DRIVERS], camber;\n    start();\n    \
                return cycle(zero, zero, zero, &camber) + tune(zero, zero, zero);\n}\n";
    let text: String = blocks.chain([main]).collect();
    let options = ExportOptions { design: true };
    let c = Compiled::of(&model("double_wishbone"), "corner", "-O1", options, &text).unwrap();
    let run = Command::new(c.folder.path().join("main")).status().unwrap();
    assert!(run.success(), "the examples end with {run}");
}

/// Functions that code for a controller may call: those of `math.h`, and what compilers insert to copy structures.
const OF_A_CONTROLLER: [&str; 17] = [
    "acos", "asin", "atan", "atan2", "cos", "exp", "fabs", "fmod", "log", "pow", "rint", "round", "sin",
    "sqrt", "tan", "memcpy", "memset",
];

#[test]
fn the_example_compiles_for_a_controller_without_an_operating_system() {
    let document = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/export-c.md");
    let document = std::fs::read_to_string(document).unwrap();
    let example = document.split("```c\n").nth(1).unwrap().split("```").next().unwrap();
    let options = ExportOptions { design: true };
    let exported =
        Format::named("c").unwrap().export_with(&model("double_wishbone"), "corner", options).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("corner.c", &exported.text);
    write("corner.h", &exported.companion.unwrap().text);
    write("cycle.c", example);
    for compiler in ["cc", "clang"].into_iter().filter(|compiler| *compiler == "cc" || is_there(compiler)) {
        let mut run = Command::new(compiler);
        let compiled = run
            .current_dir(folder.path())
            .args(["-std=c99", "-ffreestanding", "-Wall", "-Wextra", "-pedantic", "-Werror", "-O1", "-c"])
            .args(["corner.c", "cycle.c"])
            .output()
            .unwrap();
        assert!(compiled.status.success(), "{compiler}: {}", String::from_utf8_lossy(&compiled.stderr));
        let mut list = Command::new("nm");
        let names = list.current_dir(folder.path()).args(["-u", "corner.o", "cycle.o"]).output().unwrap();
        let names = String::from_utf8(names.stdout).unwrap();
        let called: Vec<&str> = names.lines().filter_map(|line| line.trim().strip_prefix("U ")).collect();
        assert!(called.contains(&"sqrt") || called.contains(&"rint"), "{compiler}: {names}");
        let is_known = |name: &&str| OF_A_CONTROLLER.contains(name) || name.starts_with("corner_");
        assert!(called.iter().all(is_known), "{compiler}: {called:?}");
    }
}

/// A four-bar without a link that turns fully: its crank reaches a limit position.
const ROCKER: &str = r#"
name = "rocker"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { A = [0, 0], B = [0, 60], C = [80, 70], D = [100, 0] }
bodies = { ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C"], rocker = ["C", "D"] }
drivers.motor = { joint = "A", law = "200*t" }
measures.angle = { type = "coordinate", joint = "D" }
time = { end = 1, steps = 50 }
"#;

#[test]
fn a_motion_that_ends_by_itself_is_reported_with_its_reason() {
    let file = hardpoint_file::parse(ROCKER, "rocker.toml").unwrap_or_else(|e| panic!("{e}"));
    let stop = Analysis::new(&file.model).unwrap().run().stop.unwrap();
    let reported = |name: &str| {
        let exported =
            Format::named("c").unwrap().export_with(&file, name, ExportOptions::default()).unwrap();
        exported.unsupported.into_iter().find(|u| u.kind == "motion").unwrap()
    };
    let motion = reported("rocker");
    assert_eq!(stop.code(), "HP0401");
    assert!(motion.name.starts_with("from t = "), "{}", motion.name);
    assert!(motion.why.contains("HP0401") && !motion.why.contains("redundant"), "{}", motion.why);
}

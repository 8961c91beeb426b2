//! Other assemblies of a mechanism, and drivers in the opposite sense: found, written, read, and searched from.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::model::{BodyId, OptimizationSettings, StartPlacement, VariableId};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::optimize::{Optimization, Overrides, Request, Status, optimize};
use hardpoint_study::{Control, Motions};

/// Two motions of the same assembly, in sizes: round-off of both solutions, of placements with ten digits none, since
/// the assembly closes them.
const SAME: f64 = 1e-9;
/// Derivatives against differences of central steps: the square of the step, and round-off over it.
const AGREE: f64 = 1e-6;
const STEP: f64 = 1e-5;

fn gallery(name: &str) -> ModelFile {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    hardpoint_file::read(&models.join(name)).unwrap_or_else(|e| panic!("{e}"))
}

fn others(file: &ModelFile) -> Vec<Vec<StartPlacement>> {
    Analysis::new(&file.model).unwrap().other_assemblies(&|| true)
}

/// Largest distance between the same points of all bodies in two motions, in sizes.
fn apart(file: &ModelFile, a: &Solution, b: &Solution) -> f64 {
    assert_eq!(a.motion.len(), b.motion.len(), "{:?} {:?}", a.stop, b.stop);
    let size = file.model.size();
    let mut most = 0.0_f64;
    for k in 0..a.motion.len() {
        for body in 1..file.model.bodies.len() {
            let [p, q] = [a, b].map(|solution| solution.body(k, BodyId(body)).pose());
            for s in hardpoint::space::Vec3::AXES {
                most = most.max((p.point(s * size) - q.point(s * size)).norm() / size);
            }
        }
    }
    most
}

#[test]
fn every_assembly_moves_alike_in_both_formulations_and_from_its_file() {
    // A slider-crank has its slider on either side of the crank. The second dyad of the six-bar has two sides; with the
    // first one on its other side, the bell pin is 204 mm from the lever's pivot, which link and lever of 85 and 50 mm
    // do not reach. The coupler of the four-bar, with a ball and a universal joint, can also be turned over about its
    // line: 2 x 2.
    for (name, expected) in [("slider_crank.toml", 1), ("watt_six_bar.toml", 1), ("four_bar.toml", 3)] {
        let file = gallery(name);
        let found = others(&file);
        assert_eq!(found.len(), expected, "{name}: {found:?}");
        let own = Analysis::new(&file.model).unwrap().run();
        for placements in &found {
            let model = file.model.starting_at(placements);
            let [relative, absolute] = [Formulation::Relative, Formulation::Absolute].map(|formulation| {
                Analysis::with(&model, formulation).unwrap().solve(Run::new().without_sensitivities())
            });
            assert!(relative.motion.len() > 1, "{name}: {:?}", relative.stop);
            let difference = apart(&file, &relative, &absolute);
            assert!(difference < SAME, "{name}: {difference:e}");
            let written = file.in_assembly(placements, false).unwrap_or_else(|e| panic!("{e}"));
            let read = Analysis::new(&written.model).unwrap().solve(Run::new().without_sensitivities());
            let difference = apart(&file, &relative, &read);
            assert!(difference < SAME, "{name}: {difference:e}\n{}", written.text());
            // It is another one, and from there the model's own is found again.
            let k = own.motion.len().min(relative.motion.len()) - 1;
            let turned = (1..file.model.bodies.len()).any(|b| {
                let [a, b] = [&own, &relative].map(|s| s.body(k, BodyId(b)).rotation);
                a.angle_to(b) > 0.1
            });
            assert!(turned, "{name} is assembled as before");
            let back = others(&written);
            assert!(back.iter().any(Vec::is_empty), "{name}: {back:?}");
        }
    }
}

#[test]
fn sensitivities_in_another_assembly_are_those_of_designs_assembled_there() {
    let file = gallery("watt_six_bar.toml");
    for placements in others(&file) {
        let model = file.model.starting_at(&placements);
        let analysis = Analysis::new(&model).unwrap();
        let nominal = analysis.run();
        let mut largest = 0.0_f64;
        for v in 0..model.variables.len() {
            let [more, less] = [STEP, -STEP].map(|h| {
                let mut design = vec![0.0; model.variables.len()];
                design[v] = h * model.size();
                analysis.solve(Run::new().at(&design).without_sensitivities())
            });
            assert_eq!([more.motion.len(), less.motion.len()], [nominal.motion.len(); 2]);
            for m in 0..nominal.measured.outputs.len() {
                for k in 0..nominal.motion.len() {
                    let d = nominal.measured.d(k, VariableId(v), m)[0] * model.size();
                    let difference =
                        (more.measured.value(k, m)[0] - less.measured.value(k, m)[0]) / (2.0 * STEP);
                    largest = largest.max(d.abs());
                    assert!(
                        (d - difference).abs() < AGREE * d.abs().max(1.0),
                        "{v} {m} {k}: {d} {difference}"
                    );
                }
            }
        }
        assert!(largest > 0.1, "{largest}");
    }
}

/// A four-bar whose coupler point is to pass through points at angles of the crank, which the linkage in the text
/// cannot: `targets` are those of another design in another assembly with the other sense.
fn path_task(targets: [&str; 2]) -> String {
    let [x, y] = targets;
    format!(
        r#"
name = "path of another assembly"
units = {{ length = "mm", angle = "deg" }}
planar = "xy"
[parameters]
crank = {{ value = 40, unit = "length", bounds = [30, 50] }}
coupler = {{ value = 110, unit = "length", bounds = [90, 130] }}
rocker = {{ value = 90, unit = "length", bounds = [75, 110] }}
p = {{ value = 50, unit = "length", bounds = [20, 80] }}
q = {{ value = 30, unit = "length", bounds = [10, 60] }}
diagonal = {{ value = "hypot(D.x - B.x, D.y - B.y)", unit = "length" }}
along = {{ value = "atan2(D.y - B.y, D.x - B.x) + acos((coupler^2 + diagonal^2 - rocker^2)/(2*coupler*diagonal))", unit = "angle" }}
[hardpoints]
A = [0, 0]
B = ["crank*cos(pi/5)", "crank*sin(pi/5)"]
C = ["B.x + coupler*cos(along)", "B.y + coupler*sin(along)"]
D = [120, 0]
P = ["B.x + p*cos(along) - q*sin(along)", "B.y + p*sin(along) + q*cos(along)"]
[bodies]
crank = {{}}
coupler = {{}}
rocker = {{}}
[joints]
bearing = {{ type = "revolute", bodies = ["ground", "crank"], at = "A" }}
pin = {{ type = "revolute", bodies = ["crank", "coupler"], at = "B" }}
knee = {{ type = "revolute", bodies = ["coupler", "rocker"], at = "C" }}
pivot = {{ type = "revolute", bodies = ["ground", "rocker"], at = "D" }}
[drivers]
motor = {{ joint = "bearing", law = "30*t" }}
[points]
tracer = {{ body = "coupler", at = "P" }}
[metrics]
x = {{ of = "tracer.x", take = "rms_at_points", target = [{x}] }}
y = {{ of = "tracer.y", take = "rms_at_points", target = [{y}] }}
[optimize]
goals = {{ x = {{}}, y = {{}} }}
[time]
end = 8
steps = 8
"#
    )
}

/// The design of the targets, as changes of the five variables, m.
const HIDDEN: [f64; 5] = [0.004, -0.007, 0.006, 0.012, -0.008];

fn task() -> ModelFile {
    let zero = (0..=8).map(|k| format!("[{k}, 0]")).collect::<Vec<_>>().join(", ");
    let blank = parse(&path_task([&zero, &zero]), "task.toml").unwrap_or_else(|e| panic!("{e}"));
    let found = others(&blank);
    assert_eq!(found.len(), 1, "{found:?}");
    let model = blank.model.starting_at(&found[0]).reversed();
    let run = Analysis::new(&model).unwrap().solve(Run::new().at(&HIDDEN).without_sensitivities());
    let column = |name: &str| {
        let m = run.measured.index(name).unwrap();
        let value = |k: usize| format!("[{k}, {}]", run.measured.value(k, m)[0] * 1e3);
        (0..=8).map(value).collect::<Vec<_>>().join(", ")
    };
    parse(&path_task([&column("tracer.x"), &column("tracer.y")]), "task.toml")
        .unwrap_or_else(|e| panic!("{e}"))
}

fn searched(file: &ModelFile, overrides: Overrides, threads: usize) -> (Optimization, OptimizationSettings) {
    let request = Request::of(&file.model, overrides).unwrap();
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let control = Control {
        threads: NonZero::new(threads).unwrap(),
        progress: &mut |_| ControlFlow::Continue(()),
        more: &|| true,
    };
    (optimize(&file.model, &motions, &request, control), request.settings)
}

/// Misfits of paths of 100 mm that are round-off, as a fraction of those of the nominal design.
const MET: f64 = 1e-9;

#[test]
fn a_path_of_another_assembly_in_the_other_sense_is_found_and_its_file_reproduces_it() {
    let file = task();
    let own = Overrides { starts: Some(3), ..Overrides::default() };
    let (found, _) = searched(&file, own.clone(), 1);
    let objective =
        |found: &Optimization| found.searches[found.best.unwrap()].found.as_ref().unwrap().objective;
    let least = objective(&found);
    assert_eq!(found.variants.len(), 1);
    assert!(least > 1e-6, "the model's own assembly comes near: {least:e}");
    let all = Overrides { other_assemblies: Some(true), both_senses: Some(true), ..own };
    let (found, settings) = searched(&file, all.clone(), 1);
    let variants: Vec<_> = found.variants.iter().map(|v| (v.assembly, v.reversed)).collect();
    assert_eq!(variants, [(0, false), (0, true), (1, false), (1, true)]);
    assert_eq!(found.searches.len(), 12);
    let best = &found.searches[found.best.unwrap()];
    assert_eq!((best.variant, best.status), (3, Status::Optimal));
    assert!(objective(&found) < MET * MET * least, "{:e}", objective(&found));
    let design = &best.found.as_ref().unwrap().design;
    for (found, hidden) in design.iter().zip(HIDDEN) {
        assert!((found - hidden).abs() < 1e-8, "{design:?}");
    }
    // Optima of different assemblies are different ones, and the numbers of threads do not matter.
    let optima = found.optima(&file.model, &settings);
    assert!(
        optima
            .iter()
            .all(|all| all.iter().all(|k| found.searches[*k].variant == found.searches[all[0]].variant))
    );
    let ends = |found: &Optimization| {
        found.searches.iter().map(|s| s.found.as_ref().map(|f| f.design.clone())).collect::<Vec<_>>()
    };
    assert_eq!(ends(&found), ends(&searched(&file, all, 3).0));
    // The file of the optimum has the placements of that design, and nothing else to assemble it by.
    let variant = &found.variants[best.variant];
    let analysis = Analysis::new(std::sync::Arc::new(variant.model(&file.model))).unwrap();
    let start = analysis.start_placements(design).unwrap();
    let text = file.in_assembly(&start, variant.reversed).unwrap().edit(design).unwrap();
    let saved = parse(&text, "saved.toml").unwrap_or_else(|e| panic!("{e}"));
    let again = searched(&saved, Overrides { iterations: Some(1), ..Overrides::default() }, 1).0;
    let nominal = again.nominal.unwrap().objective;
    assert!(nominal < 1e-14 * least, "{nominal:e}\n{text}");
    // A second change of sense and the first assembly again are the file as it was.
    let back = file.in_assembly(&start, true).unwrap().in_assembly(&[], true).unwrap();
    assert!(back.model.start.is_empty() && !back.model.drivers[0].is_reversed, "{}", back.text());
}

#[test]
fn a_start_of_an_unknown_body_or_twice_of_one_is_reported() {
    let file = task();
    for (entry, code) in [
        ("[start.lever]\nturn = [0, 0, 10]\n", "HP0204"),
        ("[start.ground]\nturn = [0, 0, 10]\n", "HP0276"),
        ("[start.rocker]\nturn = [0, 10]\n", "HP0105"),
        ("[start.rocker]\nangle = 10\n", "HP0103"),
    ] {
        let text = format!("{}\n{entry}", file.text());
        let found = parse(&text, "start.toml").unwrap_err();
        let codes: Vec<&str> = found.list().iter().map(|d| d.code).collect();
        assert_eq!(codes, [code], "{entry}: {found}");
    }
}

#[test]
fn a_reversed_driver_follows_the_negative_of_its_laws_in_all_cases() {
    let text = task().text().replace("law = \"30*t\"", "reversed = true, law = \"30*t\"");
    let text = text
        .replace("[time]", "[cases.slow]\nlaws = { motor = \"10*t\" }\n[time]")
        .replace("[optimize]\ngoals = { x = {}, y = {} }", "");
    let file = parse(&text, "reversed.toml").unwrap_or_else(|e| panic!("{e}"));
    let slow = file.model.motions().swap_remove(0);
    let degree = std::f64::consts::PI / 180.0;
    for (law, speed) in
        [(file.model.drivers[0].coordinate_law(), -30.0), (slow.drivers[0].coordinate_law(), -10.0)]
    {
        assert!((law.at(2.0).value() - 2.0 * speed * degree).abs() < 1e-14, "{law}");
        assert!((law.at(2.0).d() - speed * degree).abs() < 1e-14);
    }
    assert_eq!(file.model.drivers[0].coordinate_law().to_string(), "-(30*t)");
}

#[test]
fn a_published_half_circle_is_met_better_by_a_crank_that_turns_the_other_way() {
    // Best published sum of squares, and that of the model's own sense: 1.2162.
    let file = gallery("synthesis/half_circle_six_points.toml");
    let (found, _) = searched(&file, Overrides { both_senses: Some(true), ..Overrides::default() }, 2);
    let best = &found.searches[found.best.unwrap()];
    let judged = best.found.as_ref().unwrap();
    assert_eq!((best.status, found.variants[best.variant].reversed), (Status::Optimal, true));
    assert!((judged.objective - 0.552_664).abs() < 1e-5 && judged.violation < 1e-8, "{judged:?}");
}

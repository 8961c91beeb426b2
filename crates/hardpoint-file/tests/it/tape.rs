//! Steps as straight-line programs against the kernel that they were recorded of, on the whole gallery.

use hardpoint::model::{
    Axes, DriverId, JointId, Measure, MeasureKind, Model, ReactionPart, VariableId, VehicleEnd, WheelMeasure,
};
use hardpoint::motion::{BodyState, Execution};
use hardpoint::sensitivity::BodySensitivity;
use hardpoint::{Analysis, Run, Solution};

/// A program fuses and leaves out what the kernel rounds; where a position is ill-conditioned, that is magnified.
const ROUND_OFF: f64 = 1e-10;

/// Accelerations of measures divide by speeds, and their derivatives once more.
const MEASURED: f64 = 1e-8;

/// The same where the motion is the kernel's on every path, so that only the measures themselves differ by round-off:
/// an acceleration that is none is a difference of squares of speeds.
const OF_ONE_MOTION: f64 = 1e-10;

/// Mechanisms that no program is recorded of: their couplers count angles by their predicted turns, or a point
/// follows a curve.
const BY_THE_KERNEL: [&str; 2] = ["cam", "gear_train"];

/// Mechanisms with a variable that changes the law of a driver, so that no program knows their sensitivities.
const BY_LAWS: [&str; 2] = ["drive_shaft", "four_bar_by_lengths"];

fn gallery() -> Vec<(String, Model)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "toml"));
    files.sort();
    assert!(files.len() > 25, "{files:?}");
    let name = |f: &std::path::Path| f.file_stem().unwrap().to_str().unwrap().to_owned();
    files.iter().map(|f| (name(f), hardpoint_file::read(f).unwrap().model)).collect()
}

/// Output times that follow each other closely.
fn resolved(model: &Model) -> Model {
    let (first, last) = (model.times[0], model.times[model.times.len() - 1]);
    let steps = usize::max(model.times.len(), 400);
    let times = (0..=steps).map(|k| first + (last - first) * k as f64 / steps as f64).collect();
    Model { times, ..model.clone() }
}

fn state(s: &BodyState) -> [f64; 24] {
    let [x, y, z] = s.rotation.cols;
    let all = [s.r, x, y, z, s.v, s.omega, s.a, s.alpha];
    std::array::from_fn(|k| [all[k / 3].x, all[k / 3].y, all[k / 3].z][k % 3])
}

fn derivatives(s: &BodySensitivity) -> [f64; 18] {
    let all = [s.dr, s.dpi, s.dv, s.domega, s.da, s.dalpha];
    std::array::from_fn(|k| [all[k / 3].x, all[k / 3].y, all[k / 3].z][k % 3])
}

/// The largest difference of two tables, column by column as a part of the largest number of its kind (six of them, of
/// three columns each, or eight).
fn apart<const N: usize>(a: &[[f64; N]], b: &[[f64; N]]) -> f64 {
    assert_eq!(a.len(), b.len());
    let (mut largest, mut differs) = (vec![0.0_f64; N / 3], vec![0.0_f64; N / 3]);
    for (a, b) in a.iter().zip(b) {
        for k in 0..N {
            largest[k / 3] = largest[k / 3].max(b[k].abs());
            // NaN is as far apart as can be.
            let d = (a[k] - b[k]).abs();
            differs[k / 3] = differs[k / 3].max(if d.is_nan() && !(a[k].is_nan() && b[k].is_nan()) {
                f64::MAX
            } else {
                d
            });
        }
    }
    differs.iter().zip(&largest).map(|(d, l)| d / l.max(1e-3)).fold(0.0, f64::max)
}

fn states(solution: &Solution) -> Vec<[f64; 24]> {
    solution.motion.states().map(|s| state(&s)).collect()
}

fn sensitivities(solution: &Solution) -> Vec<[f64; 18]> {
    let s = &solution.sensitivities;
    let all = (0..solution.motion.len()).flat_map(|k| (0..s.variables).map(move |v| (k, v)));
    all.flat_map(|(k, v)| s.at(k, v).into_iter().flat_map(|d| d.iter())).map(|d| derivatives(&d)).collect()
}

#[test]
fn output_times_by_programs_are_those_of_the_kernel() {
    let mut by_kernel = Vec::new();
    for (name, model) in gallery() {
        let model = resolved(&model);
        let solve = |execution| {
            let analysis = Analysis::new(&model).unwrap().executed(execution);
            (
                analysis.solve(Run::new().without_measures().without_sensitivities()),
                analysis.solve(Run::new().without_measures()),
            )
        };
        let (motion, whole) = solve(Execution::Kernel);
        assert_eq!((motion.motion.effort.by_program, whole.motion.effort.by_program), (0, 0));
        for execution in [Execution::Interpreted, Execution::Compiled] {
            let (again, with_sensitivities) = solve(execution);
            assert_eq!(again.motion.len(), motion.motion.len(), "{name}");
            if again.motion.effort.by_program == 0 {
                by_kernel.push(name.clone());
            }
            let found = [
                apart(&states(&again), &states(&motion)),
                apart(&states(&with_sensitivities), &states(&whole)),
                apart(&sensitivities(&with_sensitivities), &sensitivities(&whole)),
            ];
            println!(
                "{name} {execution:?}: {} and {} of {} steps, {found:?}",
                again.motion.effort.by_program,
                with_sensitivities.motion.effort.by_program,
                motion.motion.len()
            );
            assert!(found.iter().all(|d| *d < ROUND_OFF), "{name} {execution:?}: {found:?}");
        }
    }
    by_kernel.dedup();
    assert_eq!(by_kernel, BY_THE_KERNEL);
}

#[test]
fn measures_and_margins_by_programs_are_those_of_the_kernel() {
    let (mut by_programs, mut of_one_motion, mut by_formulas) = (0, 0, [0; 2]);
    let mut by_kernel = Vec::new();
    for (name, model) in gallery() {
        let model = resolved(&model);
        let solve = |execution| Analysis::new(&model).unwrap().executed(execution).run();
        let right = solve(Execution::Kernel);
        for execution in [Execution::Interpreted, Execution::Compiled] {
            let again = solve(execution);
            by_programs += usize::from(again.motion.effort.by_program > 0);
            if again.motion.effort.by_program == 0 {
                by_kernel.push(name.clone());
            }
            let is_one_motion =
                states(&again) == states(&right) && sensitivities(&again) == sensitivities(&right);
            of_one_motion += usize::from(is_one_motion);
            // Values, rates and accelerations of every output; then their derivatives.
            let outputs = 0..right.measured.outputs.len();
            let values = |s: &Solution, m: usize| -> Vec<[f64; 3]> {
                (0..s.motion.len()).map(|k| s.measured.value(k, m)).collect()
            };
            let slopes = |s: &Solution, m: usize| -> Vec<[f64; 3]> {
                let all = (0..s.motion.len()).flat_map(|k| (0..s.measured.variables).map(move |v| (k, v)));
                all.map(|(k, v)| s.measured.d(k, VariableId(v), m)).collect()
            };
            let margins = |s: &Solution| -> Vec<[f64; 3]> {
                s.motion.margins.iter().map(|m| [m.value, 0.0, 0.0]).collect()
            };
            for m in outputs {
                let found =
                    [values, slopes].map(|of| apart(&columns(&of(&again, m)), &columns(&of(&right, m))));
                let output = &right.measured.outputs[m].name;
                let limit = if is_one_motion { OF_ONE_MOTION } else { MEASURED };
                assert!(found.iter().all(|d| *d < limit), "{name} {output} {execution:?}: {found:?}");
            }
            let all = again.measured.len() * again.measured.outputs.len();
            println!("{name} {execution:?}: {} of {all} by formulas", again.measured.by_formula());
            by_formulas = [by_formulas[0] + again.measured.by_formula(), by_formulas[1] + all];
            let found = apart(&margins(&again), &margins(&right));
            assert!(found < ROUND_OFF, "{name}: margins by {found:e}");
            let admissibility = |s: &Solution| {
                let all = s.sensitivities.admissibility.iter();
                all.map(|a| format!("{a:?}").split('{').next().map(str::to_owned)).collect::<Vec<_>>()
            };
            assert_eq!(admissibility(&again), admissibility(&right), "{name}");
        }
    }
    assert!(by_programs > 30 && of_one_motion > 5, "{by_programs} {of_one_motion}");
    by_kernel.dedup();
    by_kernel.retain(|name| !BY_LAWS.contains(&name.as_str()));
    assert_eq!(by_kernel, BY_THE_KERNEL);
    // Those that depend on a driver that moves alone, and few others.
    println!("{by_formulas:?}");
    assert!(8 * by_formulas[0] < by_formulas[1], "{by_formulas:?}");
}

/// Value, rate and acceleration, each a kind of its own.
fn columns(rows: &[[f64; 3]]) -> Vec<[f64; 9]> {
    rows.iter().map(|[x, y, z]| [*x, 0.0, 0.0, *y, 0.0, 0.0, *z, 0.0, 0.0]).collect()
}

#[test]
fn designs_by_programs_are_those_of_the_kernel() {
    let mut solved = 0;
    for (name, model) in gallery().into_iter().filter(|(_, m)| !m.variables.is_empty()) {
        let model = resolved(&model);
        // More groups of lanes than one; in some all lanes have one design, in others none are equal.
        let mut designs: Vec<Vec<f64>> = vec![vec![0.0; model.variables.len()]; 8];
        for k in 0..20 {
            let step = |b: usize| 1e-3 * model.natural_step(VariableId(b));
            let sign = |b: usize| if (k * 7 + b * 3) % 5 < 2 { -1.0 } else { 1.0 };
            designs.push((0..model.variables.len()).map(|b| sign(b) * step(b) * k as f64 / 20.0).collect());
        }
        let solve = |execution| {
            let analysis = Analysis::new(&model).unwrap().executed(execution);
            let mut all = vec![Solution::default(); designs.len()];
            let run = Run::new().without_sensitivities().without_measures();
            analysis.solve_designs(run, &designs, |k, solution| all[k] = std::mem::take(solution));
            all
        };
        let right = solve(Execution::Kernel);
        for execution in [Execution::Interpreted, Execution::Compiled] {
            let again = solve(execution);
            let worst =
                again.iter().zip(&right).map(|(a, b)| apart(&states(a), &states(b))).fold(0.0, f64::max);
            let steps: usize = again.iter().map(|s| s.motion.effort.by_program).sum();
            println!(
                "{name} {execution:?}: {steps} of {} steps, {worst:.1e}",
                designs.len() * model.times.len()
            );
            assert!(worst < ROUND_OFF, "{name} {execution:?}: {worst:e}");
            solved += usize::from(steps > 0);
        }
    }
    assert!(solved > 30, "{solved}");
}

#[test]
fn all_that_wheels_do_as_one_driver_moves_is_by_programs_that_of_the_kernel() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models");
    let axle = std::fs::read_to_string(format!("{folder}/front_axle.toml")).unwrap();
    let (before, after) = axle.split_once("measures = [\n").unwrap();
    let (_, after) = after.split_once("]\n").unwrap();
    let before = before.replace("end = \"front\"", "");
    for (end, other, reacted) in [
        ("front", VehicleEnd::Rear, "drive = \"outboard\"\nbrakes = \"inboard\""),
        ("rear", VehicleEnd::Front, "drive = \"inboard\"\nbrakes = \"outboard\""),
    ] {
        let asked = WheelMeasure::ALL.iter().filter(|m| m.needs().depends_on_driver());
        let asked = asked.filter(|m| m.needs().end() != Some(other)).map(|m| format!("\"{}\"", m.name()));
        let measures = asked.chain(["\"wheel_travel\"".to_owned()]).collect::<Vec<_>>().join(", ");
        let spring = "[{ body = \"ground\", at = \"left_damper_top\" }, { body = \"left_lca\", at = \"left_damper_foot\" }]";
        let text = format!(
            "{before}end = \"{end}\"\nsteer = \"steering\"\n{reacted}\nspring = {spring}\n\
             measures = [{measures}]\n{after}"
        );
        let (text, _) = text.split_once("[metrics]").unwrap();
        // An expression asks for a toe that is not among these.
        let text = text.replace("left.toe - right.toe", "left.wheel_travel - right.wheel_travel")
            + "\n[time]\nend = 1.0\nsteps = 400\n";
        let file = hardpoint_file::parse(&text, "axle.toml").unwrap_or_else(|e| panic!("{e}"));
        for execution in [Execution::Interpreted, Execution::Compiled] {
            let (worst, steps) = loads_apart(&file.model, execution);
            println!("{end} {execution:?}: {worst:e}, {steps} of {} by program", file.model.times.len());
            assert!(worst < CARRIED && steps > 300, "{end} {execution:?}: {worst:e}, {steps} steps");
        }
    }
}

/// Loads divide by pivots as accelerations do.
const CARRIED: f64 = 1e-8;

/// Difference of all measures of a model between program and kernel; and the number of output times by program.
fn loads_apart(model: &Model, execution: Execution) -> (f64, usize) {
    let solve = |execution| Analysis::new(model).unwrap().executed(execution).run();
    let (right, again) = (solve(Execution::Kernel), solve(execution));
    let mut worst = 0.0_f64;
    for m in 0..model.measures.len() {
        let values = |s: &Solution| -> Vec<[f64; 3]> {
            (0..s.motion.len()).map(|k| [s.measured.value(k, m)[0], 0.0, 0.0]).collect()
        };
        let slopes = |v: usize, s: &Solution| -> Vec<[f64; 3]> {
            (0..s.motion.len()).map(|k| [s.measured.d(k, VariableId(v), m)[0], 0.0, 0.0]).collect()
        };
        worst = worst.max(apart(&values(&again), &values(&right)));
        for v in 0..right.measured.variables {
            worst = worst.max(apart(&slopes(v, &again), &slopes(v, &right)));
        }
    }
    (worst, again.motion.effort.by_program)
}

/// A model that asks for what drives it and what all its joints carry.
fn asking_for_loads(model: &Model) -> Model {
    let measure = |(k, kind): (usize, MeasureKind)| Measure { name: format!("load {k}"), kind };
    let drivers = (0..model.drivers.len())
        .map(DriverId)
        .flat_map(|driver| [MeasureKind::DriverForce { driver }, MeasureKind::DriverPower { driver }]);
    let joints = (0..model.joints.len()).map(JointId).flat_map(|joint| {
        let parts = [
            (ReactionPart::Radial, Axes::Joint),
            (ReactionPart::ForceAlong(0), Axes::Body),
            (ReactionPart::MomentAbout(1), Axes::Global),
        ];
        parts.map(|(part, axes)| MeasureKind::Reaction { joint, part, on: None, axes: Some(axes) })
    });
    let of_all = [MeasureKind::KineticEnergy { body: None }, MeasureKind::ShakingForce { along: None }];
    let measures = drivers.chain(joints).chain(of_all).enumerate().map(measure).collect();
    Model { measures, metrics: Vec::new(), optimization: None, ..resolved(model) }
}

#[test]
fn loads_by_programs_are_those_of_the_kernel() {
    let mut by_programs = 0;
    for (name, file) in crate::loads::heavy_gallery() {
        let model = asking_for_loads(&file.model);
        let bare = Model { measures: Vec::new(), ..model.clone() };
        for execution in [Execution::Interpreted, Execution::Compiled] {
            let bare = Analysis::new(&bare).unwrap().executed(execution).run();
            let (worst, steps) = loads_apart(&model, execution);
            // Loads send no step to the kernel that goes without it.
            assert_eq!(steps, bare.motion.effort.by_program, "{name} {execution:?}");
            by_programs += usize::from(steps > 0);
            assert!(worst < CARRIED, "{name} {execution:?}: {worst:e}");
        }
    }
    assert!(by_programs > 50, "{by_programs}");
}

#[test]
fn all_kinds_of_forces_that_programs_know_are_those_of_the_kernel() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models");
    let wishbone = std::fs::read_to_string(format!("{folder}/double_wishbone_4x4.toml")).unwrap();
    let (bare, _) = wishbone.split_once("[measures.lca_angle]").unwrap();
    let text = bare.replace("measures = \"all\"\n", "")
        + r#"
[gravity]
along = "-z"

[masses]
knuckle = { type = "rigid", centre = { body = "knuckle", at = "wheel_centre" }, about = { body = "knuckle", at = "lower_ball" }, mass = 25, ixx = 2, iyy = 3, izz = 2.5, iyz = 0.2 }
lca = { type = "bar", from = { body = "lca", at = "lca_front" }, to = { body = "lca", at = "lower_ball" }, diameter = 40, bore = 30, density = 7850 }
uca = { type = "block", centre = { body = "uca", at = "upper_ball" }, x = 60, y = 40, z = 20, density = 2700 }

[forces]
road = { type = "wheel_force", wheel = "front_left", up = 4000, outboard = 900, forward = -300, law = "1 + 0.3*sin(3*t)" }
coil = { type = "spring", from = { body = "ground", at = [0, 330, 330] }, to = { body = "lca", at = [0, 450, -20] }, stiffness = 40, cubic = 0.002, preload = -3000, damping = 2 }
rubber = { type = "bushing", from = { body = "lca", at = [0, 400, 80] }, to = { body = "uca", at = [0, 400, 80] }, x = 5, y = 7, z = 2, damping = 0.1 }
sleeve = { type = "bushing", from = { body = "lca", at = [0, 380, 70] }, to = { body = "uca", at = [0, 390, 80] }, axis = { through = ["lca_front", "lower_ball"] }, axis2 = "x", x = 5, y = 7, z = 2, about_x = 0.3, cubic_x = 0.001, preload_about_y = 4, matrix = [[1, 0.2, 0, 0, 3, 0], [0.2, 2, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [3, 0, 0, 0, 0.5, 0], [0, 0, 0, 0, 0, 0]] }
tyre = { type = "tyre", wheel = "front_left", stiffness = 200, preload = 3000, height = 12, law = "sin(4*t)" }
stiff = { type = "torsion_spring", joint = "lca_pivot", stiffness = 2, damping = 0.1 }
slip = { type = "joint_spring", joint = "rack_slide", stiffness = 1, damping = 0.2 }
push = { type = "force", at = { body = "knuckle", at = "tie_rod_outer" }, force = 100, along = [1, 2, 0], axes = "body" }
twist = { type = "moment", body = "knuckle", moment = 20, about = "x", law = "cos(5*t)" }

[measures]
lift = { type = "driver_force", driver = "bump" }
rack = { type = "driver_power", driver = "rack_drive" }
ball = { type = "reaction", joint = "lower_ball", part = "force" }
bush = { type = "reaction", joint = "lca_pivot", part = "bending", on = "ground" }
rod = { type = "reaction", joint = "tie_rod", part = "force_y", axes = "body" }
coil = { type = "spring_force", force = "coil" }
rubber = { type = "spring_force", force = "rubber" }
sleeve = { type = "spring_force", force = "sleeve" }
tyre = { type = "spring_force", force = "tyre" }
road = { type = "spring_force", force = "road" }
energy = { type = "kinetic_energy" }
rocking = { type = "shaking_moment", about = { body = "ground", at = "rack_centre" }, along = "x" }

[time]
end = 1.0
steps = 200
"#;
    // Also on the pad of a test rig, where the force of the tyre does not depend on the design.
    let on_pad = text
        .replace("point = \"wheel_centre\"\nalong = \"z\"\nlaw", "wheel = \"front_left\"\nlaw")
        .replace("tyre = { type = \"spring_force\", force = \"tyre\" }\n", "");
    assert!(on_pad.contains("wheel = \"front_left\"\nlaw"));
    for text in [text, on_pad] {
        let file = hardpoint_file::parse(&text, "wishbone.toml").unwrap_or_else(|e| panic!("{e}"));
        for execution in [Execution::Interpreted, Execution::Compiled] {
            let (worst, steps) = loads_apart(&file.model, execution);
            println!("{execution:?}: {worst:e}, {steps} of {} by program", file.model.times.len());
            assert!(worst < CARRIED && steps > 150, "{execution:?}: {worst:e}, {steps} steps");
        }
    }
}

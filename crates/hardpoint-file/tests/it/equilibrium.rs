//! Equilibria of mechanisms with elastic joints: published data of a double wishbone on four bushings and of a lever in
//! closed form, limits, identities, and what must not matter.

use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::load::LargestDeflection;
use hardpoint::model::{ElasticDirection, ElementId, Model, Reduction, VariableId};
use hardpoint::motion::StopKind;
use hardpoint::run::{MetricUse, metrics, misfits, peaks};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::verify::{Options, verify};
use serde_json::Value;

use crate::diagnostics::snapshot;

/// The data have 13 digits.
const VALUES: f64 = 1e-10;
const FORCES: f64 = 1e-9;
/// Sensitivities and compliances, relative to the largest of their row.
const DERIVATIVES: f64 = 1e-8;
/// Times of limits, s: the shortest part of the way that is tried, and the distance at which its stiffness vanishes.
const TIME_OF_LIMIT: f64 = 1e-8;
/// Gradients of compliances, each relative to itself.
const SECOND_DERIVATIVES: f64 = 1e-7;

fn file(text: &str) -> ModelFile {
    parse(text, "equilibrium.toml").unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn solved(text: &str) -> Solution {
    let solution = Analysis::new(&file(text).model).unwrap().run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    solution
}

fn value(solution: &Solution, k: usize, name: &str) -> f64 {
    let m = solution.measured.index(name).unwrap_or_else(|| panic!("{name}"));
    solution.measured.value(k, m)[0]
}

fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found} instead of {expected}");
}

/// Loads and position of the double wishbone.
#[derive(Clone, Copy)]
struct State {
    bump: f64,
    /// Outboard and forward, N.
    road: [f64; 2],
    align: f64,
    rack: f64,
}

/// Form in which the double wishbone is written.
#[derive(Clone)]
struct Written {
    /// Factor of all stiffnesses but those about the axes.
    scale: f64,
    /// With cubic stiffnesses and preload.
    complete: bool,
    /// Bodies of the upper front bushing, exchanged with its axes.
    cut: &'static str,
    forces: bool,
    equilibrium: &'static str,
    times: &'static str,
    bump_law: Option<&'static str>,
}

const AS_PUBLISHED: Written = Written {
    scale: 1.0,
    complete: true,
    cut: "",
    forces: true,
    equilibrium: "[equilibrium]",
    times: "[time]\nat = [0]",
    bump_law: None,
};

/// The double wishbone of the data, in m and rad.
fn wishbone(at: State, how: &Written) -> String {
    let State { bump, road: [side, forward], align, rack } = at;
    let s = how.scale;
    let bushing = |name: &str, joint: &str, k: [f64; 5], about: &str, more: &str| {
        let [x, y, z, a, b] = k.map(|k| k * s);
        format!(
            "{name} = {{ type = \"elastic_joint\", joint = \"{joint}\", x = {x:?}, y = {y:?}, z = {z:?}, about_x = {a:?}, \
             about_y = {b:?}, about_z = {about}{more} }}\n"
        )
    };
    let (cubic, preload) = if how.complete {
        (", cubic_x = 4e11, cubic_y = 4e11, cubic_z = 2e9", ", preload_z = \"preload\"")
    } else {
        ("", "")
    };
    let k_front = 9.0e6 * s;
    let k_upper = 5.0e6 * s;
    let front = bushing("lca_front_bush", "lca_front", [0.0, 8.0e6, 1.2e6, 3500.0, 3000.0], "80.0", "");
    let front = front.replace("x = 0.0, y", "x = \"k_front\", y");
    let rear = bushing(
        "lca_rear_bush",
        "lca_rear",
        [4.0e6, 3.0e6, 3.0e5, 2000.0, 2000.0],
        "\"k_rear_about\"",
        cubic,
    );
    let upper_front =
        bushing("uca_front_bush", "uca_front", [5.0e6, 5.0e6, 4.0e5, 1500.0, 1500.0], "40.0", "");
    let upper_rear =
        bushing("uca_rear_bush", "uca_rear", [5.0e6, 0.0, 4.0e5, 1500.0, 1500.0], "40.0", preload);
    let upper_rear = upper_rear.replace("y = 0.0, z", "y = \"k_upper\", z");
    let loads = if how.forces {
        "spring = { type = \"spring\", from = { body = \"ground\", at = \"spring_top\" }, to = { body = \"lca\", at = \
         \"spring_foot\" }, stiffness = \"k_spring\", preload = -5200.0 }\n\
         side = { type = \"wheel_force\", wheel = \"left\", outboard = \"side\" }\n\
         brake = { type = \"wheel_force\", wheel = \"left\", forward = \"forward\" }\n\
         align = { type = \"wheel_force\", wheel = \"left\", about_up = \"align\" }\n"
    } else {
        ""
    };
    let law = how.bump_law.map_or(format!("{bump:?}"), |law| format!("\"{law}\""));
    let cut = |name: &str| if how.cut == name { ", cut = true" } else { "" };
    let per_force = if how.forces && !how.equilibrium.is_empty() {
        let of = |name: &str, of: &str, force: &str| {
            format!("{name} = {{ type = \"compliance\", of = \"{of}\", force = \"{force}\" }}\n")
        };
        ["toe", "camber", "contact_x", "contact_y"]
            .iter()
            .flat_map(|m| {
                [("side", 0), ("brake", 1), ("align", 2)]
                    .map(|(force, _)| of(&format!("{m}_per_{force}"), &format!("left.{m}"), force))
            })
            .collect::<String>()
    } else {
        String::new()
    };
    let slopes: String = ["toe", "camber", "contact_x", "contact_y"]
        .iter()
        .flat_map(|m| {
            [("bump", "centre.z"), ("steer", "rack")].map(|(driver, over)| {
                format!(
                    "{m}_over_{driver} = {{ type = \"slope\", of = \"left.{m}\", over = \"{over}\", driver = \"{driver}\" }}\n"
                )
            })
        })
        .collect();
    let slopes = if how.equilibrium.is_empty() { String::new() } else { slopes };
    let force = if how.forces { "bump_force = { type = \"driver_force\", driver = \"bump\" }" } else { "" };
    format!(
        r#"
name = "double wishbone"
units = {{ length = "m", angle = "rad" }}

[parameters]
side = {side:?}
forward = {forward:?}
align = {align:?}
k_front = {k_front:?}
k_rear_about = 60.0
k_upper = {k_upper:?}
preload = 150.0
k_spring = 45000.0

[hardpoints]
lca_front = [0.106, 0.24, 0.2654]
lca_rear = [-0.116, 0.24, 0.2256]
lower_ball = [0.0125, 0.5622, 0.14]
uca_front = [0.184, 0.24, 0.4063]
uca_rear = [-0.1674, 0.24, 0.335]
upper_ball = [-0.0283, 0.5381, 0.28]
tie_inner = [-0.075, 0.2302, 0.3089]
tie_outer = [-0.058, 0.5268, 0.2118]
wheel_centre = [0.0, 0.65, 0.2]
spring_top = [0.01, 0.33, 0.53]
spring_foot = [0.01, 0.45, 0.18]

[bodies]
lca = {{}}
uca = {{}}
knuckle = {{}}
rack = {{}}

[joints]
lca_front = {{ type = "revolute", bodies = ["ground", "lca"], at = "lca_front", axis = [0.98430677050583, 0.0, 0.1764658084060003], axis2 = "y"{cut_front} }}
lca_rear = {{ type = "revolute", bodies = ["ground", "lca"], at = "lca_rear", axis = [0.98430677050583, 0.0, 0.1764658084060003], axis2 = "y" }}
uca_front = {{ type = "revolute", bodies = ["ground", "uca"], at = "uca_front", axis = [0.9800298014418598, 0.0, 0.19885066830621678], axis2 = "y"{cut_upper} }}
uca_rear = {{ type = "revolute", bodies = ["ground", "uca"], at = "uca_rear", axis = [0.9800298014418598, 0.0, 0.19885066830621678], axis2 = "y" }}
lower_ball = {{ type = "spherical", bodies = ["lca", "knuckle"], at = "lower_ball"{cut_ball} }}
upper_ball = {{ type = "spherical", bodies = ["uca", "knuckle"], at = "upper_ball" }}
tie_rod = {{ type = "distance", bodies = ["rack", "knuckle"], at = ["tie_inner", "tie_outer"] }}
rack = {{ type = "translational", bodies = ["ground", "rack"], at = "tie_inner", axis = "y" }}

[drivers]
bump = {{ point = "centre", along = "z", law = {law} }}
steer = {{ joint = "rack", law = {rack:?} }}

[points]
centre = {{ body = "knuckle", at = "wheel_centre" }}

[wheels.left]
body = "knuckle"
centre = "wheel_centre"
spin_axis = [0.0026, 1.0, 0.0218]
radius = 0.2794
side = "left"
measures = ["toe", "camber", "contact_x", "contact_y", "contact_z"]

[forces]
{front}{rear}{upper_front}{upper_rear}{loads}
{equilibrium}

[design]
lower_ball_y = {{ move = "lower_ball", along = "y" }}
upper_ball_z = {{ move = "upper_ball", along = "z" }}
tie_inner_z = {{ move = "tie_inner", along = "z" }}
lca_rear_z = {{ move = "lca_rear", along = "z" }}
spring_foot_y = {{ move = "spring_foot", along = "y" }}

[measures]
rack = {{ type = "coordinate", joint = "rack" }}
{force}
{per_force}{slopes}
{times}
"#,
        cut_front = cut("lca_front"),
        cut_upper = cut("uca_front"),
        cut_ball = cut("lower_ball"),
        equilibrium = how.equilibrium,
        times = how.times,
    )
}

fn data() -> Value {
    serde_json::from_str(include_str!("double_wishbone_on_bushings.json")).unwrap()
}

fn number(of: &Value) -> f64 {
    of.as_f64().unwrap_or_else(|| panic!("{of} is no number"))
}

fn state_of(case: &Value) -> State {
    State {
        bump: number(&case["bump"]),
        road: [0, 1].map(|k| number(&case["F"][k])),
        align: number(&case["Mz"]),
        rack: case["rack"].as_f64().unwrap_or(0.0),
    }
}

/// Compares values with those of a case.
fn compare_values(solution: &Solution, k: usize, values: &Value, tolerance: f64) {
    for (name, expected) in values.as_object().unwrap() {
        let Some(expected) = expected.as_f64().filter(|_| name != "scale") else { continue };
        let name = match name.strip_prefix("centre_") {
            Some(axis) => format!("centre.{axis}"),
            None => format!("left.{name}"),
        };
        near(value(solution, k, &name), expected, tolerance, &name);
    }
}

#[test]
fn positions_forces_and_sensitivities_are_those_published() {
    let of_variable = [
        ("lower_ball_y", "hp.lower_ball.1"),
        ("upper_ball_z", "hp.upper_ball.2"),
        ("tie_inner_z", "hp.tie_inner.2"),
        ("lca_rear_z", "hp.lca_rear.2"),
        ("spring_foot_y", "hp.spring_foot.1"),
        ("k_front", "lca_front_bush.k.0"),
        ("k_rear_about", "lca_rear_bush.k.5"),
        ("k_upper", "uca_rear_bush.k.1"),
        ("preload", "uca_rear_bush.preload.2"),
        ("k_spring", "spring.k"),
    ];
    let data = data();
    for (name, case) in data["cases"].as_object().unwrap() {
        let text = wishbone(state_of(case), &AS_PUBLISHED);
        let model = file(&text).model;
        let solution = Analysis::new(&model).unwrap().run();
        assert!(solution.stop.is_none(), "{name}: {:?}", solution.stop);
        compare_values(&solution, 0, &case["values"], VALUES);
        let force = number(&case["reaction_of_driver"]);
        near(value(&solution, 0, "bump_force"), force, FORCES * force.abs(), name);
        assert!(solution.motion.effort.equilibrium_iterations <= 8, "{name}");
        for (variable, published) in of_variable {
            let of = &case["sensitivities"][published];
            let v = model.variable(variable).unwrap_or_else(|| panic!("{variable}"));
            let largest = of.as_object().unwrap().values().map(|x| number(x).abs()).fold(0.0, f64::max);
            for (measure, expected) in of.as_object().unwrap() {
                let m = solution.measured.index(&format!("left.{measure}")).unwrap();
                let found = solution.measured.d(0, v, m)[0];
                let what = format!("{name}: d {measure} / d {variable}");
                near(found, number(expected), DERIVATIVES * largest, &what);
            }
        }
        for (driver, published) in [("bump", "bump.value"), ("steer", "rack")] {
            for (measure, expected) in case["sensitivities"][published].as_object().unwrap() {
                let expected = number(expected);
                let found = value(&solution, 0, &format!("{measure}_over_{driver}"));
                near(
                    found,
                    expected,
                    DERIVATIVES * (1.0 + expected.abs()),
                    &format!("{name}: {measure} over {driver}"),
                );
            }
        }
        for (force, variable, published) in
            [("side", "side", "road.F.0"), ("brake", "forward", "road.F.1"), ("align", "align", "road.Mz")]
        {
            let of = &case["compliances"][published];
            let v = model.variable(variable).unwrap();
            let largest = of.as_object().unwrap().values().map(|x| number(x).abs()).fold(0.0, f64::max);
            for (measure, expected) in of.as_object().unwrap() {
                let m = solution.measured.index(&format!("left.{measure}")).unwrap();
                let what = format!("{name}: {measure} per {force}");
                near(solution.measured.d(0, v, m)[0], number(expected), DERIVATIVES * largest, &what);
                let state = state_of(case);
                let size = [state.road[0], state.road[1], state.align]
                    [["side", "brake", "align"].iter().position(|f| *f == force).unwrap()];
                // A force of zero has no direction.
                if size != 0.0 {
                    let found = value(&solution, 0, &format!("{measure}_per_{force}"));
                    near(found, number(expected) * size.signum(), DERIVATIVES * largest, &what);
                }
            }
        }
        gradients_of_compliances_are_those_published(name, case, &solution, &model, &of_variable);
    }
}

/// Compares the gradients of compliances with those of a case.
fn gradients_of_compliances_are_those_published(
    name: &str,
    case: &Value,
    solution: &Solution,
    model: &Model,
    of_variable: &[(&str, &str)],
) {
    let state = state_of(case);
    let loads = [("side", "road.F.0", "side", state.road[0]), ("align", "road.Mz", "align", state.align)];
    let loads = loads.into_iter().chain([("brake", "road.F.1", "forward", state.road[1])]);
    for (force, published, own, size) in loads.filter(|(.., size)| *size != 0.0) {
        for measure in ["toe", "camber", "contact_x", "contact_y"] {
            let Some(of) = case["compliance_sensitivities"].get(format!("d {measure} / d {published}"))
            else {
                continue;
            };
            let m = solution.measured.index(&format!("{measure}_per_{force}")).unwrap();
            for (variable, key) in of_variable.iter().chain(&[(own, published)]) {
                let expected = number(&of[key]) * size.signum();
                let found = solution.measured.d(0, model.variable(variable).unwrap(), m)[0];
                let what = format!("{name}: d2 {measure} / d {force} d {variable}");
                near(found, expected, SECOND_DERIVATIVES * expected.abs(), &what);
            }
        }
    }
}

#[test]
fn stiff_joints_are_rigid_to_first_order() {
    let data = data();
    let series = &data["stiffness_series"];
    let at = state_of(series);
    let soft = Written { complete: false, ..AS_PUBLISHED };
    for row in series["values"].as_array().unwrap() {
        let scale = number(&row["scale"]);
        let solution = solved(&wishbone(at, &Written { scale, ..soft.clone() }));
        compare_values(&solution, 0, row, VALUES);
    }
}

#[test]
fn the_motion_along_travel_takes_few_iterations_and_does_not_depend_on_output_times() {
    let at = State { bump: 0.0, road: [1500.0, -900.0], align: 30.0, rack: 0.0 };
    let travel = |times: &'static str| {
        let how = Written { times, bump_law: Some("0.06*sin(2*pi*t)"), ..AS_PUBLISHED };
        solved(&wishbone(at, &how))
    };
    let coarse = travel("[time]\nend = 1.0\nsteps = 20");
    let fine = travel("[time]\nend = 1.0\nsteps = 100");
    for k in 0..=20 {
        for name in ["left.toe", "left.camber", "left.contact_y", "bump_force"] {
            let (a, b) = (value(&coarse, k, name), value(&fine, 5 * k, name));
            near(a, b, 1e-11 * (1.0 + a.abs()), name);
        }
    }
    let per_step = fine.motion.effort.equilibrium_iterations as f64 / 101.0;
    assert!(per_step <= 4.0, "{per_step} iterations per step");
}

#[test]
fn the_answer_does_not_depend_on_the_cut_joints() {
    let at = State { bump: 0.02, road: [1500.0, -900.0], align: 30.0, rack: 0.004 };
    let first = solved(&wishbone(at, &AS_PUBLISHED));
    for cut in ["lca_front", "uca_front", "lower_ball"] {
        let other = solved(&wishbone(at, &Written { cut, ..AS_PUBLISHED }));
        for (m, output) in first.measured.outputs.iter().enumerate() {
            let (a, b) = (first.measured.value(0, m)[0], other.measured.value(0, m)[0]);
            near(b, a, 1e-10 * (1.0 + a.abs()), &format!("{} with {cut} cut", output.name));
            for v in 0..first.measured.variables {
                let v = VariableId(v);
                let (a, b) = (first.measured.d(0, v, m)[0], other.measured.d(0, v, m)[0]);
                if a.is_finite() {
                    near(b, a, 1e-8 * (1.0 + a.abs()), &format!("d {} with {cut} cut", output.name));
                }
            }
        }
    }
}

#[test]
fn both_formulations_agree() {
    let at = State { bump: -0.05, road: [2000.0, -2500.0], align: -40.0, rack: 0.0 };
    let model = file(&wishbone(at, &AS_PUBLISHED)).model;
    let [a, b] = [Formulation::Relative, Formulation::Absolute].map(|formulation| {
        let solution = Analysis::with(&model, formulation).unwrap().run();
        assert!(solution.stop.is_none(), "{formulation:?}: {:?}", solution.stop);
        solution
    });
    for (m, output) in a.measured.outputs.iter().enumerate() {
        let [x, y] = [&a, &b].map(|s| s.measured.value(0, m)[0]);
        near(y, x, 1e-9 * (1.0 + x.abs()), &output.name);
    }
}

#[test]
fn sensitivities_are_those_of_solved_designs() {
    let at = State { bump: 0.03, road: [1500.0, -900.0], align: 30.0, rack: 0.002 };
    let model = file(&wishbone(at, &AS_PUBLISHED)).model;
    let analysis = Analysis::new(&model).unwrap();
    let here = analysis.run();
    for v in 0..model.variables.len() {
        let v = VariableId(v);
        let step = 5e-4 * model.natural_step(v);
        let designs =
            Beside::new(v, step, |design| analysis.solve(Run::new().at(design).without_sensitivities()));
        for (m, output) in here.measured.outputs.iter().enumerate() {
            let a = here.measured.value(0, m)[0];
            let difference = designs.difference(|run| run.measured.value(0, m)[0]);
            let exact = here.measured.d(0, v, m)[0];
            let what = format!("d {} / d {}", output.name, model.variables[v.0].name);
            // Round-off of the values over the step; that of positions is in proportion to the mechanism's size, 1 m.
            let size = if output.name.contains("_per_") { 1e-12 * a.abs() } else { 1e-14 * (1.0 + a.abs()) };
            near(exact, difference, 1e-7 * difference.abs() + size / step, &what);
        }
    }
}

/// Loads of a model of one output time, with sensitivities, whose deflections are all known.
fn deflections(model: &Model, formulation: Formulation) -> Vec<LargestDeflection> {
    let loads = Analysis::with(model, formulation).unwrap().loads_with_sensitivities(&[]);
    assert!(loads.stop.is_none(), "{:?}", loads.stop);
    loads.largest_deflections.into_iter().map(Option::unwrap).collect()
}

#[test]
fn sensitivities_of_deflections_are_those_of_solved_designs_in_both_formulations() {
    let at = State { bump: 0.03, road: [1500.0, -900.0], align: 30.0, rack: 0.002 };
    // With joints alone, and with bushings in the place of some.
    for text in [wishbone(at, &AS_PUBLISHED), wishbone_on_axes_through_hardpoints(true)] {
        let model = file(&text).model;
        let analysis = Analysis::new(&model).unwrap();
        let here = deflections(&model, Formulation::Relative);
        let other = deflections(&model, Formulation::Absolute);
        assert_eq!(here.len(), model.elastic_directions().len());
        for v in 0..model.variables.len() {
            let step = 5e-4 * model.natural_step(VariableId(v));
            let beside = |h: f64| {
                let mut design = vec![0.0; v + 1];
                design[v] = h;
                analysis.loads(&design).deflections
            };
            let [a, b, c, d] = [step, -step, 2.0 * step, -2.0 * step].map(beside);
            let mut largest = 0.0_f64;
            for (i, (here, other)) in here.iter().zip(&other).enumerate() {
                let [a, b, c, d] = [&a, &b, &c, &d].map(|found| found[i].displacement);
                let difference = (8.0 * (a - b) - (c - d)) / (12.0 * step);
                let what = format!("d deflection {i} / d {}", model.variables[v].name);
                // Round-off of the displacements, in proportion to the mechanism's size, over the step.
                let size = 1e-14 / step;
                near(here.d[v], difference, 1e-7 * difference.abs() + size, &what);
                near(other.d[v], here.d[v], 1e-8 * here.d[v].abs() + size, &what);
                largest = largest.max(here.d[v].abs());
            }
            assert!(largest > 0.0, "{}", model.variables[v].name);
        }
    }
}

#[test]
fn deflections_are_measures_with_the_values_and_derivatives_of_the_loads() {
    let at = State { bump: 0.03, road: [1500.0, -900.0], align: 30.0, rack: 0.002 };
    for text in [wishbone(at, &AS_PUBLISHED), wishbone_on_axes_through_hardpoints(true)] {
        let plain = file(&text).model;
        let directions = plain.elastic_directions();
        let name = |(e, k): (ElementId, usize)| format!("{}_{k}", plain.elements[e.0].name);
        let measure = |at: &(ElementId, usize)| {
            let (element, direction) = (&plain.elements[at.0.0].name, ElasticDirection(at.1).name());
            format!(
                "{} = {{ type = \"deflection\", force = \"{element}\", direction = \"{direction}\" }}\n",
                name(*at)
            )
        };
        let mut measures: String = directions.iter().map(measure).collect();
        let first = name(directions[0]);
        measures += &format!("per_side = {{ type = \"compliance\", of = \"{first}\", force = \"side\" }}\n");
        let model = file(&text.replace("[measures]\n", &format!("[measures]\n{measures}"))).model;
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            let solution = Analysis::with(&model, formulation).unwrap().run();
            for (at, largest) in directions.iter().zip(deflections(&model, formulation)) {
                let m = solution.measured.index(&name(*at)).unwrap();
                // Round-off of positions, in proportion to the mechanism's size.
                let displacement = largest.deflection.displacement;
                near(solution.measured.value(0, m)[0], displacement, 1e-14, &name(*at));
                for (v, d) in largest.d.iter().enumerate() {
                    let found = solution.measured.d(0, VariableId(v), m)[0];
                    near(found, *d, 1e-8 * d.abs() + 1e-11, &format!("d {}", name(*at)));
                }
            }
        }
        verify_all(&model);
    }
}

#[test]
fn deflections_that_do_not_exist_are_reported() {
    let at = State { bump: 0.03, road: [1500.0, -900.0], align: 30.0, rack: 0.002 };
    let text = wishbone(at, &AS_PUBLISHED);
    for (measure, change, words) in [
        ("force = \"spring\", direction = \"x\"", None, "`spring` has no deflections along and about axes"),
        ("force = \"lca_front_bush\", direction = \"y\"", Some(", y = 8000000.0"), "is rigid there"),
        ("force = \"lca_front_bush\", direction = \"along\"", None, "cannot be `along`"),
    ] {
        let measures = format!("[measures]\nown = {{ type = \"deflection\", {measure} }}\n");
        let mut text = text.replace("[measures]\n", &measures);
        if let Some(stiffness) = change {
            assert!(text.contains(stiffness));
            text = text.replacen(stiffness, "", 1);
        }
        let error = parse(&text, "wishbone.toml").unwrap_err().render(false);
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn sensitivities_of_deflections_hold_at_the_time_of_the_largest() {
    let at = State { bump: 0.0, road: [1500.0, -900.0], align: 30.0, rack: 0.0 };
    let how = Written {
        times: "[time]\nend = 1.0\nsteps = 20",
        bump_law: Some("0.06*sin(2*pi*t)"),
        ..AS_PUBLISHED
    };
    let model = file(&wishbone(at, &how)).model;
    let loads = Analysis::new(&model).unwrap().loads_with_sensitivities(&[]);
    let steps: Vec<usize> = loads.largest_deflections.iter().flatten().map(|largest| largest.step).collect();
    assert!(steps.iter().any(|step| *step != steps[0]), "{steps:?}");
    for (i, largest) in loads.largest_deflections.iter().enumerate() {
        let LargestDeflection { step, deflection, d } = largest.as_ref().unwrap();
        assert_eq!(loads.deflections_at(*step)[i], *deflection);
        let sizes = (0..loads.times.len()).map(|k| loads.deflections_at(k)[i].displacement.abs());
        assert_eq!(sizes.fold(0.0, f64::max), deflection.displacement.abs());
        let bump = 0.06 * (std::f64::consts::TAU * loads.times[*step]).sin();
        let alone = file(&wishbone(State { bump, ..at }, &AS_PUBLISHED)).model;
        let alone = &deflections(&alone, Formulation::Relative)[i];
        for (a, b) in d.iter().zip(&alone.d) {
            near(*a, *b, 1e-9 * (b.abs() + 1e-6), &format!("deflection {i}"));
        }
    }
}

/// Asserts that all sensitivities of a model agree with differences of re-solved designs.
pub(crate) fn verify_all(model: &Model) {
    let analysis = Analysis::new(model).unwrap();
    let options = Options::default();
    let found = verify(&analysis, &analysis.run(), &options, |_| ControlFlow::Continue(()));
    let worst: Vec<_> = found.checks.iter().map(|check| check.worst().cloned()).collect();
    assert!(found.passed() && found.checks.len() == model.variables.len(), "{worst:?}");
}

/// Solutions beside a design, for differences whose error is of the fourth order in the step.
pub(crate) struct Beside {
    /// At one step forward and back, and at two.
    pub runs: [Solution; 4],
    step: f64,
}

impl Beside {
    /// Solutions at steps of a variable.
    pub fn new(variable: VariableId, step: f64, solve: impl Fn(&[f64]) -> Solution) -> Self {
        let at = |h: f64| {
            let mut design = vec![0.0; variable.0 + 1];
            design[variable.0] = h;
            solve(&design)
        };
        Self { runs: [step, -step, 2.0 * step, -2.0 * step].map(at), step }
    }

    /// Derivative of a value by the variable.
    pub fn difference(&self, of: impl Fn(&Solution) -> f64) -> f64 {
        let [a, b, c, d] = self.runs.each_ref().map(of);
        (8.0 * (a - b) - (c - d)) / (12.0 * self.step)
    }
}

#[test]
fn sensitivities_are_verified() {
    let at = State { bump: 0.03, road: [1500.0, -900.0], align: 30.0, rack: 0.002 };
    verify_all(&file(&wishbone(at, &AS_PUBLISHED)).model);
}

/// The double wishbone with axes of its arms through hardpoints; as joints, or with bushings in the place of those that
/// close loops.
pub(crate) fn wishbone_on_axes_through_hardpoints(bushings: bool) -> String {
    let at = State { bump: 0.03, road: [1500.0, -900.0], align: 30.0, rack: 0.002 };
    let axes = [
        ("lca", "[0.98430677050583, 0.0, 0.1764658084060003]"),
        ("uca", "[0.9800298014418598, 0.0, 0.19885066830621678]"),
    ];
    let mut text = wishbone(at, &AS_PUBLISHED)
        .replace("[design]", "[design]\nuca_front_y = { move = \"uca_front\", along = \"y\" }");
    for (arm, axis) in axes {
        text = text.replace(axis, &format!("{{ through = [\"{arm}_rear\", \"{arm}_front\"] }}"));
        if bushings {
            let joint = format!("joint = \"{arm}_rear\"");
            let bushing = format!(
                "from = {{ body = \"ground\", at = \"{arm}_rear\" }}, to = {{ body = \"{arm}\", at = \"{arm}_rear\" }}, \
                 axis = {{ through = [\"{arm}_rear\", \"{arm}_front\"] }}, axis2 = \"y\""
            );
            let lines = text.lines().filter(|l| !l.starts_with(&format!("{arm}_rear = {{ type")));
            let change = |l: &str| match l.contains(&joint) {
                true => l.replace("elastic_joint", "bushing").replace(&joint, &bushing),
                false => l.to_owned(),
            };
            text = lines.map(change).collect::<Vec<_>>().join("\n");
        }
    }
    text
}

#[test]
fn a_bushing_with_axes_is_the_elastic_joint_that_closes_a_loop() {
    let [joints, bushings] =
        [false, true].map(|bushings| solved(&wishbone_on_axes_through_hardpoints(bushings)));
    assert_eq!(bushings.measured.variables, joints.measured.variables);
    for (m, output) in joints.measured.outputs.iter().enumerate() {
        let same = bushings.measured.index(&output.name).unwrap();
        let (a, b) = (joints.measured.value(0, m)[0], bushings.measured.value(0, same)[0]);
        near(b, a, 1e-10 * (1.0 + a.abs()), &output.name);
        for v in (0..joints.measured.variables).map(VariableId) {
            let (a, b) = (joints.measured.d(0, v, m)[0], bushings.measured.d(0, v, same)[0]);
            if a.is_finite() {
                near(b, a, 1e-8 * (1.0 + a.abs()), &format!("d {}", output.name));
            }
        }
    }
}

#[test]
fn sensitivities_of_bushings_with_axes_are_verified() {
    verify_all(&file(&wishbone_on_axes_through_hardpoints(true)).model);
}

/// The double wishbone with a tie rod that is elastic along itself.
fn wishbone_on_elastic_tie_rod(stiffness: f64) -> String {
    let at = State { bump: 0.03, road: [1500.0, -900.0], align: 30.0, rack: 0.002 };
    let text = wishbone(at, &AS_PUBLISHED);
    let lines = text.lines().filter(|l| !l.starts_with("tie_rod = "));
    let spring = "[forces]\ntie_rod = { type = \"spring\", from = { body = \"rack\", at = \"tie_inner\" }, to = { body = \
         \"knuckle\", at = \"tie_outer\" }, stiffness = \"k_tie\" }\n";
    lines
        .collect::<Vec<_>>()
        .join("\n")
        .replace("[forces]", spring)
        .replace("k_spring = 45000.0", &format!("k_spring = 45000.0\nk_tie = {stiffness:?}"))
        .replace("[measures]", "[measures]\ntension = { type = \"spring_force\", force = \"tie_rod\" }")
}

#[test]
fn a_spring_between_its_ends_is_a_rod_that_is_elastic_along_itself() {
    let at = State { bump: 0.03, road: [1500.0, -900.0], align: 30.0, rack: 0.002 };
    let measure = "[measures]\ntension = { type = \"reaction\", joint = \"tie_rod\", part = \"force\" }";
    let rigid = solved(&wishbone(at, &AS_PUBLISHED).replace("[measures]", measure));
    let toe = value(&rigid, 0, "left.toe");
    let [soft, hard] = [8e6, 8e8].map(|k| solved(&wishbone_on_elastic_tie_rod(k)));
    let [a, b] = [&soft, &hard].map(|s| value(s, 0, "left.toe") - toe);
    // The deflection is the force over the stiffness, to first order.
    assert!(a.abs() > 1e-4 && (a / b - 100.0).abs() < 1.0, "{a} {b}");
    near(
        value(&hard, 0, "tension").abs(),
        value(&rigid, 0, "tension"),
        1e-3 * value(&rigid, 0, "tension"),
        "tension",
    );
    let model = file(&wishbone_on_elastic_tie_rod(8e6)).model;
    let analysis = Analysis::new(&model).unwrap();
    let found = verify(&analysis, &analysis.run(), &Options::default(), |_| ControlFlow::Continue(()));
    let worst: Vec<_> = found.checks.iter().map(|check| check.worst().cloned()).collect();
    assert!(found.passed() && found.checks.len() == model.variables.len(), "{worst:?}");
}

#[test]
fn without_loads_compliances_are_those_of_the_rigid_mechanism() {
    let at = State { bump: 0.02, road: [0.0; 2], align: 0.0, rack: 0.0 };
    let measure = "\nsoft = { type = \"compliance\", of = \"left.toe\", wheel = \"left\", along = \"y\" }\n";
    let free = Written { forces: false, complete: false, ..AS_PUBLISHED };
    // One arm on one joint, so that the rigid mechanism is determined.
    let single = |equilibrium: &'static str| {
        let text = wishbone(at, &Written { equilibrium, ..free.clone() });
        let kept = |line: &&str| {
            !["lca_rear =", "uca_rear =", "lca_rear_bush", "uca_rear_bush"]
                .iter()
                .any(|x| line.starts_with(x) && (line.contains("revolute") || line.contains("elastic_joint")))
        };
        // Without torsion about the hinges, no force remains in the position of the rigid mechanism.
        let text: Vec<String> = text
            .lines()
            .filter(kept)
            .map(|l| l.replace(", about_z = 80.0", "").replace(", about_z = 40.0", ""))
            .collect();
        text.join("\n").replace("[measures]", &format!("[measures]{measure}"))
    };
    let [rigid, open] = ["", "[equilibrium]"].map(|e| value(&solved(&single(e)), 0, "soft"));
    near(open, rigid, 1e-12 * rigid.abs(), "compliance");
}

/// A lever on one bushing: `k t = F L cos t, z = -F / k_z`.
fn lever(force: f64) -> String {
    format!(
        r#"
name = "lever"
units = {{ length = "m", angle = "rad" }}
[parameters]
down = {force}
k_turn = 700
[hardpoints]
o = [0, 0, 0]
tip = [0.4, 0, 0]
[bodies]
arm = {{}}
[joints]
bush = {{ type = "fixed", bodies = ["ground", "arm"], at = "o" }}
[points]
tip = {{ body = "arm", at = "tip" }}
[forces]
elastic = {{ type = "elastic_joint", joint = "bush", x = 2e6, y = 3e6, z = 1e6, about_x = 900, about_y = "k_turn", about_z = 250 }}
load = {{ type = "force", at = "tip", force = "down", along = "-z" }}
[equilibrium]
[design]
length = {{ move = "tip", along = "x" }}
[measures]
soft = {{ type = "compliance", of = "tip.z", force = "load" }}
[time]
at = [0]
"#
    )
}

#[test]
fn a_lever_has_its_closed_form() {
    for (force, turn, tip, by_stiffness, by_load, by_length, soft) in [
        (
            800.0,
            0.4178178551059,
            [0.3655906232177, -0.1631067965777],
            -0.0005034887659133,
            0.0004405526701741,
            0.8811053403482,
            0.0001620619252492,
        ),
        (
            3000.0,
            0.9696209092603,
            [0.2262448788274, -0.3328685417016],
            -0.0005738741010643,
            0.000133903956915,
            1.004279676863,
            3.129508450675e-05,
        ),
    ] {
        let model = file(&lever(force)).model;
        let solution = Analysis::new(&model).unwrap().run();
        assert!(solution.stop.is_none(), "{:?}", solution.stop);
        let [x, z] = ["tip.x", "tip.z"].map(|name| value(&solution, 0, name));
        near(x, tip[0], VALUES, "x");
        near(z, tip[1], VALUES, "z");
        near((-(z + force / 1e6)).atan2(x), turn, VALUES, "turn");
        near(value(&solution, 0, "soft"), -soft, 1e-8 * soft, "compliance");
        // x = L cos t
        let m = solution.measured.index("tip.x").unwrap();
        let d = |name: &str| solution.measured.d(0, model.variable(name).unwrap(), m)[0];
        near(d("k_turn"), -0.4 * turn.sin() * by_stiffness, 1e-9, "by stiffness");
        near(d("down"), -0.4 * turn.sin() * by_load, 1e-9, "by load");
        near(d("length"), turn.cos() - 0.4 * turn.sin() * by_length, 1e-9, "by length");
    }
}

/// Two bars of length 1 at this slope between guides, whose ends give along them: the truss of von Mises.
fn truss(force: f64) -> String {
    format!(
        r#"
name = "truss"
units = {{ length = "m", angle = "rad" }}
[bodies]
block = {{}}
[joints]
guide = {{ type = "translational", bodies = ["ground", "block"], at = [0, 0, 0.3], axis = "z" }}
[drivers]
sink = {{ joint = "guide", law = 0 }}
[points]
top = {{ body = "block", at = [0, 0, 0.3] }}
[forces]
bar = {{ type = "spring", from = {{ body = "ground", at = [1, 0, 0] }}, to = {{ body = "block", at = [0, 0, 0.3] }}, stiffness = 1e5 }}
load = {{ type = "force", at = "top", force = {force}, along = "-z" }}
[equilibrium]
released = ["sink"]
[time]
at = [0]
"#
    )
}

#[test]
fn a_truss_snaps_through_at_its_limit_load() {
    // F(z) = k (L - L_o) z / L has its greatest value where (L / L_o)^3 = 1 / L_o^2 with a base of 1.
    let drawn = 1.09_f64.sqrt();
    let long = drawn.cbrt();
    let limit = 1e5 * (drawn - long) * (long * long - 1.0).sqrt() / long;
    let half = solved(&truss(0.5 * limit));
    let z = value(&half, 0, "top.z");
    let l = (1.0 + z * z).sqrt();
    near(1e5 * (drawn - l) * z / l, 0.5 * limit, 1e-8, "force");
    let model = file(&truss(1.2 * limit)).model;
    let stop = Analysis::new(&model).unwrap().run().stop.unwrap();
    let StopKind::LimitLoad { part } = stop.kind else { panic!("{stop:?}") };
    near(part, 1.0 / 1.2, 1e-6, "limit load");
    assert!(stop.headline(&model).ends_with("the mechanism snaps through"), "{}", stop.headline(&model));
}

#[test]
fn a_limit_load_is_at_its_time_whatever_the_law_and_the_drivers_are_those_of_the_last_output_time() {
    // The force of the closed form above, which grows like t^2: 1.3 t^2 = 1.
    let drawn = 1.09_f64.sqrt();
    let long = drawn.cbrt();
    let limit = 1e5 * (drawn - long) * (long * long - 1.0).sqrt() / long;
    for times in ["at = [0, 1]", "end = 1\nsteps = 7", "at = [0, 0.1, 0.8, 2]"] {
        let text = truss(limit)
            .replace("along = \"-z\"", "along = \"-z\", law = \"1.3*t^2\"")
            .replace("at = [0]", times);
        let solution = Analysis::new(&file(&text).model).unwrap().run();
        let stop = solution.stop.as_ref().unwrap();
        assert_eq!(stop.kind, StopKind::NoEquilibrium, "{times}");
        near(stop.failed_time, (1.0 / 1.3_f64).sqrt(), TIME_OF_LIMIT, times);
        assert!(stop.snaps_through, "{times}");
        // The block begins at 0.3 m, where `sink` is zero.
        let last = solution.measured.len() - 1;
        assert_eq!(stop.last_time, Some(solution.motion.times[last]), "{times}");
        near(stop.drivers[0], value(&solution, last, "top.z") - 0.3, VALUES, times);
    }
}

/// An upright pendulum of 2 m on a torsion spring of 100 N m/deg, under a force down by this law in N, and a force
/// across.
fn upright(law: &str, across: f64, times: &str, size: f64) -> String {
    let [length, stiffness] = [2.0 * size, 100.0 * size];
    format!(
        r#"
name = "upright"
units = {{ length = "m", angle = "deg" }}
[bodies]
b = {{}}
[joints]
j = {{ type = "revolute", bodies = ["ground", "b"], at = [0, 0, 0], axis = "y" }}
[drivers]
d = {{ joint = "j", law = 0 }}
[points]
top = {{ body = "b", at = [0, 0, {length:?}] }}
[forces]
spring = {{ type = "torsion_spring", joint = "j", stiffness = {stiffness:?} }}
down = {{ type = "force", at = "top", force = 1, along = "-z", law = "{law}" }}
across = {{ type = "force", at = "top", force = {across:?}, along = "x" }}
[equilibrium]
released = ["d"]
[measures]
angle = {{ type = "coordinate", joint = "j" }}
[time]
{times}
"#
    )
}

/// Angle of that pendulum in rad, on the side of the force across: `k a = 2 F sin a + 2 H cos a`, whose largest root is
/// the equilibrium that continues the one without loads.
fn angle_of_upright(down: f64, across: f64) -> f64 {
    let spring = 100.0_f64.to_degrees();
    let rest = |a: f64| spring * a - 2.0 * down * a.sin() - 2.0 * across.abs() * a.cos();
    // Below its largest root, which is beyond that of the pendulum without imperfection, the rest is negative.
    let [mut below, mut above] = [0.0, std::f64::consts::PI];
    if 2.0 * down > spring {
        below = (1.0 - spring / (2.0 * down)).sqrt();
        assert!(rest(below) < 0.0);
    }
    for _ in 0..100 {
        let middle = 0.5 * (below + above);
        if rest(middle) < 0.0 { below = middle } else { above = middle }
    }
    0.5 * (below + above) * across.signum()
}

#[test]
fn the_equilibrium_continues_the_one_without_loads_for_any_output_times() {
    // The load passes that at which the perfect pendulum becomes unstable, 0.572958 of the last.
    let uniform = [1, 2, 3, 5, 7, 8, 9, 10, 11, 15, 19, 20, 21, 22, 40, 100, 200];
    let uniform = uniform.map(|steps| format!("end = 1\nsteps = {steps}"));
    let irregular = [
        "at = [0, 0.2, 0.4, 0.5, 0.57, 0.58, 0.6, 0.8, 1]",
        "at = [0, 0.572, 0.573, 0.574, 1]",
        "at = [0, 0.5729, 0.57295, 0.572955, 0.9, 1]",
        "at = [0, 0.001, 1]",
        "at = [1]",
    ];
    for times in uniform.iter().map(String::as_str).chain(irregular) {
        for (across, size) in [(1e-3, 1.0), (0.1, 1e3), (-1.0, 1.0), (1.0, 1e-3), (10.0, 1.0), (-10.0, 1.0)] {
            let solution = solved(&upright("5000*t", across, times, size));
            for (k, t) in solution.motion.times.iter().enumerate() {
                let found = value(&solution, k, "angle");
                let expected = angle_of_upright(5000.0 * t, across);
                near(found, expected, VALUES, &format!("{across} N, size {size}, t = {t}, {times}"));
            }
        }
    }
}

#[test]
fn an_equilibrium_becomes_unstable_at_its_time_whatever_the_law() {
    let spring = 100.0_f64.to_degrees();
    for times in ["at = [0, 1]", "end = 1\nsteps = 10", "end = 1\nsteps = 11"] {
        let solution = Analysis::new(&file(&upright("5000*t^2", 0.0, times, 1.0)).model).unwrap().run();
        let stop = solution.stop.unwrap();
        assert!(matches!(stop.kind, StopKind::Unstable { .. }), "{stop:?}");
        // 2 m * 5000 N t^2 = k
        near(stop.failed_time, (spring / 10000.0).sqrt(), TIME_OF_LIMIT, times);
    }
    // The stiffness vanishes at an output time: the direction was held before.
    for times in ["at = [0, 1]", "end = 1\nsteps = 2", "end = 1\nsteps = 7"] {
        let law = format!("{}*t", 0.5 * spring);
        let solution = Analysis::new(&file(&upright(&law, 0.0, times, 1.0)).model).unwrap().run();
        let stop = solution.stop.unwrap();
        assert!(matches!(stop.kind, StopKind::Unstable { .. }), "{stop:?}");
        near(stop.failed_time, 1.0, TIME_OF_LIMIT, times);
    }
}

/// Two pendulums that stand upright on torsion springs of this stiffness: 1 kg at 1 m each.
fn pendulums(stiffness: f64) -> String {
    let one = |y: i32| {
        let joints = format!(
            "p{y} = {{ type = \"revolute\", bodies = [\"ground\", \"b{y}\"], at = [0, {y}, 0], axis = \"y\" }}"
        );
        let mass = format!(
            "m{y} = {{ type = \"rigid\", centre = {{ body = \"b{y}\", at = [0, {y}, 1] }}, mass = 1 }}"
        );
        let spring =
            format!("s{y} = {{ type = \"torsion_spring\", joint = \"p{y}\", stiffness = {stiffness} }}");
        (joints, mass, spring)
    };
    let (left, right) = (one(0), one(1));
    format!(
        r#"
name = "pendulums"
units = {{ length = "m", angle = "rad" }}
[bodies]
b0 = {{}}
b1 = {{}}
[joints]
{}
{}
[drivers]
d0 = {{ joint = "p0", law = 0 }}
d1 = {{ joint = "p1", law = 0 }}
[gravity]
along = "-z"
[masses]
{}
{}
[forces]
{}
{}
[equilibrium]
released = ["d0", "d1"]
[time]
at = [0]
"#,
        left.0, right.0, left.1, right.1, left.2, right.2
    )
}

#[test]
fn an_unstable_equilibrium_is_an_end_even_if_two_directions_are_unstable() {
    // Upright is stable if k > m g h = 9.80665 N m.
    let stop = |stiffness: f64| {
        let model = file(&pendulums(stiffness)).model;
        Analysis::new(&model).unwrap().run().stop.map(|stop| stop.kind)
    };
    assert!(stop(9.81).is_none(), "{:?}", stop(9.81));
    assert!(matches!(stop(9.80), Some(StopKind::Unstable { .. })), "{:?}", stop(9.80));
}

#[test]
fn the_limit_load_and_the_stability_of_the_wishbone_are_those_published() {
    let at = |bump: f64, factor: f64| {
        let road = [2000.0 * factor, -1500.0 * factor];
        let text = wishbone(State { bump, road, align: 50.0 * factor, rack: 0.0 }, &AS_PUBLISHED);
        let model = file(&text.replace("preload = 150.0", "preload = 0.0")).model;
        Analysis::new(&model).unwrap().run()
    };
    // At 50 mm there is no equilibrium beyond 11.387338753 times these loads.
    let stop = |factor: f64| at(0.05, factor).stop.map(|stop| stop.kind);
    assert!(stop(11.3873).is_none(), "{:?}", stop(11.3873));
    assert!(matches!(stop(11.3874), Some(StopKind::LimitLoad { .. })), "{:?}", stop(11.3874));
    // At -50 mm the symmetric part of the stiffness is indefinite from 13.09065 times these loads on, just below the
    // limit load.
    let uncertain = |factor: f64| {
        let solution = at(-0.05, factor);
        assert!(solution.stop.is_none(), "{factor}: {:?}", solution.stop);
        solution.motion.effort.uncertain_stability
    };
    assert_eq!([13.09064, 13.09067].map(uncertain), [None, Some(0.0)]);
}

#[test]
fn what_nothing_holds_is_named() {
    let loose = lever(0.0)
        .replace(", about_z = 250", "")
        .replace("\"fixed\"", "\"revolute\", axis = \"z\", axis2 = \"x\"");
    let model = file(&loose).model;
    let stop = Analysis::new(&model).unwrap().run().stop.unwrap();
    assert!(matches!(stop.kind, StopKind::NothingHolds { .. }), "{stop:?}");
    assert_eq!(stop.headline(&model), "nothing holds the angle of joint `bush`");
}

/// An arm on bushings at these places, mm, with these stiffnesses each. Its first point is far from both.
fn on_bushings(places: &[[f64; 3]], stiffnesses: &str, far: [f64; 3], [unit, factor]: [&str; 2]) -> String {
    let factor: f64 = factor.parse().unwrap();
    let at = |k: usize| -> [f64; 3] { std::array::from_fn(|c| factor * (places[k][c] + far[c])) };
    let (hardpoints, bushings): (String, String) = (0..places.len())
        .map(|k| {
            let ends = format!(
                "from = {{ body = \"ground\", at = \"P{k}\" }}, to = {{ body = \"arm\", at = \"P{k}\" }}"
            );
            let bushing = format!("b{k} = {{ type = \"bushing\", {ends}, {stiffnesses} }}\n");
            (format!("P{k} = {:?}\n", at(k)), bushing)
        })
        .unzip();
    let tip: [f64; 3] = std::array::from_fn(|c| factor * (far[c] + [300.0, 40.0, 0.0][c]));
    format!(
        r#"
name = "held"
units = {{ length = "{unit}", angle = "deg" }}
bodies = {{ arm = {{}} }}
points = {{ tip = {{ body = "arm", at = {tip:?} }} }}
time = {{ at = [0, 1] }}
[hardpoints]
{hardpoints}[forces]
{bushings}[equilibrium]
"#
    )
}

#[test]
fn a_motion_that_nothing_holds_is_named_by_its_axis() {
    // A bushing leaves the motion of the stiffness that it does not have, about or along its own axes; two without
    // torsional stiffness leave the rotation about the line through both.
    let (one, two): (&[_], &[_]) = (&[[0.0; 3]], &[[0.0; 3], [300.0, 400.0, 0.0]]);
    let cases = [
        (one, "x = 100, y = 200, z = 300, about_x = 5, about_z = 7", "about y through `P0`"),
        (one, "x = 100, y = 200, z = 300, about_y = 5, about_z = 7", "about x through `P0`"),
        (one, "x = 100, y = 200, z = 300, about_x = 5, about_y = 7", "about z through `P0`"),
        (one, "x = 100, y = 0, z = 300, about_x = 5, about_y = 6, about_z = 7", "along y"),
        (two, "x = 100, y = 200, z = 300", "about direction [0.6, 0.8, 0] through `P0`"),
    ];
    for (places, stiffnesses, expected) in cases {
        for far in [[0.0; 3], [500.0, 700.0, -300.0], [-12000.0, 3.0, 900.0]] {
            for unit in [["mm", "1"], ["m", "1e-3"]] {
                let model = file(&on_bushings(places, stiffnesses, far, unit)).model;
                for formulation in [Formulation::Relative, Formulation::Absolute] {
                    let stop = Analysis::with(&model, formulation).unwrap().run().stop.unwrap();
                    let expected = format!("nothing holds body `arm` {expected}");
                    assert_eq!(stop.headline(&model), expected, "{far:?} {unit:?} {formulation:?}");
                }
            }
        }
    }
}

/// An arm of 300 mm on an elastic hinge, loaded at its end in N by this law; x is a stiffness in N/mm.
fn elastic_hinge(x: &str, far: [f64; 3], law: &str) -> String {
    let tip = [far[0] + 300.0, far[1], far[2]];
    format!(
        r#"
name = "hinge"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = {far:?}, B = {tip:?} }}
bodies = {{ arm = {{}} }}
points = {{ tip = {{ body = "arm", at = "B" }} }}
time = {{ at = [0, 0.5, 1] }}
masses = {{ m = {{ type = "rigid", centre = {{ body = "arm", at = "B" }}, mass = 1 }} }}
[joints]
j = {{ type = "revolute", bodies = ["ground", "arm"], at = "A", axis = "y", axis2 = "x" }}
[forces]
e = {{ type = "elastic_joint", joint = "j", x = {x}, y = 100, about_z = 5 }}
load = {{ type = "force", at = "tip", force = 100, along = "-z", law = "{law}" }}
[equilibrium]
"#
    )
}

#[test]
fn a_stiffness_that_hides_the_others_is_named() {
    for (x, far) in [
        ("1e18", [0.0; 3]),
        ("1e21", [0.0; 3]),
        ("1e60", [0.0; 3]),
        ("1e300", [0.0; 3]),
        ("1e15", [500.0, 700.0, -300.0]),
        ("1e18", [500.0, 700.0, -300.0]),
    ] {
        let model = file(&elastic_hinge(x, far, "t")).model;
        let stop = Analysis::new(&model).unwrap().run().stop.unwrap();
        assert_eq!(stop.code(), "HP0425", "{x}: {stop:?}");
        assert!(stop.headline(&model).contains("the stiffness of joint `j` along x is too large"), "{x}");
    }
    solved(&elastic_hinge("1e9", [500.0, 700.0, -300.0], "t"));
}

#[test]
fn a_load_without_a_value_between_output_times_is_named_with_its_time() {
    // Poles; and no value between 0.3 and 0.4, where the other load turns.
    for (law, other, time) in [
        ("1/(t - 0.3)", "1", 0.3),
        ("1/(0.3 - t)^2", "1", 0.3),
        ("tan(pi*t/0.7)", "1", 0.35),
        ("sqrt((t - 0.3)*(t - 0.4))", "abs(t - 0.35)", 0.3),
    ] {
        let other = format!(
            "other = {{ type = \"force\", at = \"tip\", force = 1, along = \"x\", law = \"{other}\" }}\n[equilibrium]"
        );
        let text = elastic_hinge("100", [0.0; 3], law).replace("[equilibrium]", &other);
        let model = file(&text).model;
        let stop = Analysis::new(&model).unwrap().run().stop.expect(law);
        let expected = format!("the law of force `load` has no finite value at t = {time} s");
        assert_eq!((stop.code(), stop.headline(&model)), ("HP0404", expected), "{law}");
        assert_eq!(stop.last_time, Some(0.0), "{law}");
    }
}

/// A crank next to its dead centre, which a small force turns by 50 deg against next to nothing, while the rubber at
/// the other end of the rod is a million times as stiff: the rubber is not cut, and few steps are enough.
#[test]
fn a_soft_motion_beside_stiff_rubber_takes_few_steps() {
    let text = r#"
name = "crank on rubber"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { A = [0, 0], B = [100, 1e-6], C = [300, 10] }
bodies = { crank = {}, rod = {}, slider = {} }
[joints]
A = { type = "revolute", bodies = ["ground", "crank"], at = "A" }
B = { type = "revolute", bodies = ["crank", "rod"], at = "B" }
C = { type = "revolute", bodies = ["rod", "slider"], at = "C", axis2 = "x" }
guide = { type = "translational", bodies = ["ground", "slider"], at = "C", axis = "x" }
[drivers]
m = { joint = "A", law = "0" }
[forces]
rubber = { type = "elastic_joint", joint = "C", x = 2817, y = 19.41 }
twist = { type = "torsion_spring", joint = "C", stiffness = 2.433e-05 }
side = { type = "force", at = { body = "crank", at = "B" }, force = 0.01412, along = [-0.606, 1], law = "t" }
[equilibrium]
released = ["m"]
[measures]
turn = { type = "coordinate", joint = "A" }
[time]
at = [0, 0.138]
"#;
    let solution = solved(text);
    near(value(&solution, 1, "turn").to_degrees(), 49.778, 1e-3, "turn");
    let iterations = solution.motion.effort.equilibrium_iterations;
    assert!(iterations < 300, "{iterations} iterations");
}

#[test]
fn a_released_driver_without_motion_is_named_beside_those_that_are_held() {
    let text = |released: &str| {
        format!(
            r#"
name = "four-bar on bushings"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0], B = [40, 200, 0], C = [360, 600, 0], D = [400, 0, 0] }}
bodies = {{ crank = {{}}, coupler = {{}}, rocker = {{}} }}
[joints]
A = {{ type = "revolute", bodies = ["ground", "crank"], at = "A", axis = "z", axis2 = "x" }}
B = {{ type = "revolute", bodies = ["crank", "coupler"], at = "B", axis = "z" }}
C = {{ type = "revolute", bodies = ["coupler", "rocker"], at = "C", axis = "z" }}
D = {{ type = "revolute", bodies = ["ground", "rocker"], at = "D", axis = "z" }}
[drivers]
a = {{ joint = "A", law = "t" }}
b = {{ joint = "B", law = "t" }}
c = {{ joint = "C", law = "t" }}
d = {{ joint = "D", law = "t" }}
[forces]
a = {{ type = "elastic_joint", joint = "A", x = 100, y = 200 }}
[equilibrium]
{released}
[time]
at = [0, 1]
"#
        )
    };
    let error = |released: &str| {
        Analysis::new(&file(&text(released)).model).err().unwrap_or_else(|| panic!("`{released}` is solved"))
    };
    let all = error("");
    assert_eq!(all.to_string(), "the mechanism is over-driven: 4 drivers prescribe 3 degrees of freedom");
    let one = error("released = [\"a\"]");
    assert_eq!(
        one.to_string(),
        "the mechanism is over-driven: 3 drivers prescribe 3 degrees of freedom, which leaves none to the released `a`"
    );
    assert_eq!(one.notes()[0], "contradicting drivers: `b`, `c`, `d`, `a`");
    assert_eq!(one.help(), "remove any one of these drivers, or use a joint with more freedom");
}

#[test]
fn an_elastic_joint_that_cannot_be_cut_is_reported_with_the_reason() {
    let held = "t = { type = \"bushing\", from = { body = \"ground\", at = \"B\" }, to = { body = \"arm\", at = \"B\" }, \
                x = 100, y = 200, z = 300, about_x = 5, about_y = 6, about_z = 7 }\n[equilibrium]";
    let alone = elastic_hinge("100", [0.0; 3], "t")
        .replace("revolute", "universal")
        .replace(", about_z = 5", "")
        .replace("[equilibrium]", held);
    let requested = alone.replace("axis2 = \"x\"", "axis2 = \"x\", cut = true");
    let fault = |text: &str, formulation| {
        let error = Analysis::with(&file(text).model, formulation).err().unwrap();
        assert_eq!(error.code(), "HP0306");
        error.help()
    };
    assert!(Analysis::new(&file(&alone).model).unwrap().run().stop.is_none());
    let help = fault(&alone, Formulation::Absolute);
    assert!(help.contains("leave out the option `--absolute`") && !help.contains("stiffness"), "{help}");
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let help = fault(&requested, formulation);
        assert!(help.contains("remove `cut = true` from `j`"), "{help}");
    }
    // Without the request or the option it would be cut too.
    let second = "k = { type = \"universal\", bodies = [\"ground\", \"arm\"], at = \"B\", axis = \"y\", axis2 = \"x\" }\n[forces]\n\
                  f = { type = \"elastic_joint\", joint = \"k\", x = 100, y = 100 }";
    let twice = requested.replace("[forces]", second);
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let help = fault(&twice, formulation);
        assert!(help.contains("make another joint of the loop rigid"), "{help}");
    }
}

#[test]
fn faults_are_reported() {
    let texts = [
        lever(800.0).replace("[equilibrium]", "[equilibrium]\nreleased = [\"bump\"]"),
        lever(800.0).replace("[measures]", "[measures]\nspeed = { type = \"velocity\", point = \"tip\" }"),
        lever(800.0).replace("[equilibrium]", ""),
        wishbone(State { bump: 0.0, road: [0.0; 2], align: 0.0, rack: 0.0 }, &AS_PUBLISHED).replace(
            "[forces]",
            "[forces]\nthrust = { type = \"elastic_joint\", joint = \"tie_rod\", x = 8e6 }",
        ),
        lever(800.0).replace("force = \"load\"", "force = \"elastic\""),
        lever(800.0)
            + "[metrics]\nsoft = { of = \"soft\", take = \"max\" }\n[optimize]\nvariables = [\"length\"]\ngoals = { soft = {} }\n",
    ];
    let found: Vec<String> = texts
        .iter()
        .map(|text| parse(text, "lever.toml").err().map_or("none".into(), |e| e.to_string()))
        .collect();
    snapshot("equilibrium_faults", &found.join("\n\n"));
}

/// A lever on a torsion spring: its mean height at equilibrium is that of straight lines between the output times. A
/// metric over a measure is solved at a time of its own, which moves with the design and changes the mean by nothing.
#[test]
fn another_metric_does_not_change_a_mean_at_equilibrium() {
    let model = |more: &str| {
        file(&format!(
            r#"
name = "lever"
units = {{ length = "mm", angle = "deg" }}
parameters = {{ k = {{ value = 1, design = true }} }}
hardpoints = {{ O = [0, 0, 0], P = [0, -100, 0] }}
bodies.lever = {{}}
joints.pin = {{ type = "revolute", bodies = ["ground", "lever"], at = "O", axis = "z" }}
drivers.d = {{ joint = "pin", law = "0" }}
forces.spring = {{ type = "torsion_spring", joint = "pin", stiffness = "k" }}
forces.m = {{ type = "moment", body = "lever", moment = 1, about = "z", law = "0" }}
measures.x = {{ type = "position", point = {{ body = "lever", at = "P" }}, along = "x" }}
measures.y = {{ type = "position", point = {{ body = "lever", at = "P" }}, along = "y" }}
metrics.mean = {{ of = "y", take = "mean" }}
{more}
equilibrium.released = ["d"]
cases.load.laws.m = "-20 + 80*t"
time = {{ end = 1, steps = 8 }}
"#
        ))
        .model
    };
    let mean = |more: &str, design: &[f64]| {
        let motion = model(more).motions().remove(0);
        let solution = Analysis::new(&motion).unwrap().solve(Run::new().at(design));
        let found = metrics(&motion, &solution).remove(0);
        (found.value.unwrap(), found.d[0])
    };
    let more = "metrics.v = { of = \"y\", take = \"value\", over = \"x\", at = 50 }";
    let (alone, beside) = (mean("", &[]), mean(more, &[]));
    assert_eq!(alone, beside);
    let h = 1e-4;
    let difference = (mean(more, &[h]).0 - mean(more, &[-h]).0) / (2.0 * h);
    near(beside.1, difference, 1e-7 * difference.abs(), "d mean / dk");
}

/// The template of a K&C rig with further metrics.
fn rig(metrics: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hardpoint-cli/templates/k-and-c.toml");
    let text = std::fs::read_to_string(path).unwrap();
    file(&text.replace("[metrics]", &format!("[metrics]\n{metrics}"))).model
}

#[test]
fn a_run_for_metrics_has_the_same_metrics_to_the_last_bit() {
    let model = rig(
        "soft = { case = \"lateral_in_phase\", of = \"left_toe_per_side\", take = \"change\" }\n\
         softest = { case = \"braking\", of = \"left_toe_per_brake\", take = \"max\" }\n\
         halfway = { case = \"driving\", of = \"left.toe\", take = \"value\", at = 0.45 }\n\
         load = { case = \"steer\", of = \"left_wheel_load\", take = \"rms\", target = [[0, 1000], [1, 2000]] }\n\
         middle = { case = \"opposite_travel\", of = \"left.toe\", over = \"left.wheel_travel\", take = \"mean\" }\n",
    );
    // NaN is the same as NaN.
    let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let mut left_out = 0;
    for motion in model.motions() {
        let analysis = Analysis::new(&motion).unwrap();
        let all = analysis.run();
        let few = analysis.solve(Run::new().for_metrics(&[]));
        let candidates = vec![MetricUse::Candidates; motion.metrics.len()];
        let more = analysis.solve(Run::new().for_metrics(&candidates));
        assert!(all.stop.is_none() && few.stop.is_none());
        let pairs = metrics(&motion, &all).into_iter().zip(metrics(&motion, &few));
        for (metric, (a, b)) in motion.metrics.iter().zip(pairs) {
            assert!(a.d.iter().any(|d| *d != 0.0), "{}", metric.name);
            assert_eq!(bits(&b.d), bits(&a.d), "{}", metric.name);
            assert_eq!([b.value, b.time, b.error], [a.value, a.time, a.error], "{}", metric.name);
            if let Reduction::Rms(_) = metric.take {
                assert_eq!(misfits(&motion, &few, metric), misfits(&motion, &all, metric), "{}", metric.name);
            }
            if let Reduction::Greatest | Reduction::Range = metric.take {
                let [a, b] = [&all, &more].map(|found| peaks(&motion, found, metric, 1.0));
                assert_eq!(b, a, "{}", metric.name);
            }
        }
        let toe = few.measured.index("left.toe").unwrap();
        let unknown =
            |k: &usize| few.measured.variables == 0 || few.measured.d(*k, VariableId(0), toe)[0].is_nan();
        left_out += (0..few.measured.len()).filter(unknown).count();
    }
    assert!(left_out > 50, "{left_out}");
}

#[test]
fn second_derivatives_are_symmetric_and_those_of_solved_designs() {
    let at = State { bump: 0.03, road: [1500.0, -900.0], align: 30.0, rack: 0.002 };
    // A law that follows a variable has second derivatives of its own.
    let how = Written { bump_law: Some("0.03*sin(k_spring/40000)"), ..AS_PUBLISHED };
    let text = wishbone(at, &how);
    let model = file(&text).model;
    let analysis = Analysis::new(&model).unwrap();
    let count = model.variables.len();
    let natural = |v: usize| model.natural_step(VariableId(v));
    let unit = |v: usize| -> Vec<f64> { (0..count).map(|k| if k == v { natural(v) } else { 0.0 }).collect() };
    let directions: Vec<Vec<f64>> = (0..count).map(unit).collect();
    let pairs: Vec<[usize; 2]> = (0..count).flat_map(|u| (0..count).map(move |w| [u, w])).collect();
    let second = analysis.second(&[], &directions, &pairs);
    assert!(second.stop.is_none(), "{:?}", second.stop);
    let step = 6e-4;
    for w in 0..count {
        let of = |design: &[f64]| {
            let design: Vec<f64> = design.iter().map(|x| x * natural(w)).collect();
            analysis.solve(Run::new().at(&design))
        };
        let designs = Beside::new(VariableId(w), step, of);
        for u in 0..count {
            for (m, output) in second.outputs.iter().enumerate() {
                let here = second.value(0, u * count + w, m);
                // Loads, slopes and compliances have none.
                if here.is_nan() {
                    continue;
                }
                let [of_u, of_w] = [u, w].map(|v| &model.variables[v].name);
                let what = format!("d2 {} / d {of_u} d {of_w}", output.name);
                let first = |run: &Solution| run.measured.d(0, VariableId(u), m)[0] * natural(u);
                // The error is of the fourth order in the step, and round-off over it.
                let (difference, a) = (designs.difference(first), first(&designs.runs[0]));
                near(here, difference, 1e-6 * difference.abs() + 1e-9 * a.abs() + 1e-12, &what);
                near(here, second.value(0, w * count + u, m), 1e-9 * here.abs() + 1e-14, &what);
            }
        }
    }
}

/// A slider-crank, whose slider is displaced by 200 mm at 0.5 s, with an elastic joint that no load opens.
fn slider_crank(times: &str) -> String {
    format!(
        r#"
name = "crank"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0], B = [0, 100, 0], C = [150, 0, 0] }}
bodies = {{ crank = {{}}, slider = {{}}, mass = {{}} }}
[joints]
A = {{ type = "revolute", bodies = ["ground", "crank"], at = "A", axis = "z" }}
rod = {{ type = "distance", bodies = ["crank", "slider"], at = ["B", "C"] }}
slider = {{ type = "translational", bodies = ["ground", "slider"], at = "C", axis = "x" }}
mass = {{ type = "fixed", bodies = ["crank", "mass"], at = "B" }}
[forces]
mass = {{ type = "elastic_joint", joint = "mass", about_z = 1 }}
[equilibrium]
[drivers]
d = {{ joint = "slider", law = "200*sin(pi*t)" }}
[measures]
angle = {{ type = "coordinate", joint = "A" }}
[metrics]
middle = {{ of = "angle", take = "value", at = 0.5 }}
[time]
{times}
"#
    )
}

/// A truss of von Mises on two springs of 50 N/mm, 600 mm wide and 80 mm high, under these laws of loads down in N.
fn shallow_truss(laws: &[&str], times: &str) -> String {
    let load = |(k, law): (usize, &&str)| {
        format!("load{k} = {{ type = \"force\", at = \"P\", force = 1, along = \"-z\", law = \"{law}\" }}\n")
    };
    let loads: String = laws.iter().enumerate().map(load).collect();
    format!(
        r#"
name = "truss"
units = {{ length = "mm", angle = "deg" }}
[hardpoints]
A = [-300, 0, 0]
B = [300, 0, 0]
P = [0, 0, 80]
[bodies]
apex = {{}}
[joints]
plane = {{ type = "planar", bodies = ["ground", "apex"], at = "P", axis = "y" }}
upright = {{ type = "orientation", bodies = ["ground", "apex"] }}
[points]
P = {{ body = "apex", at = "P" }}
[forces]
left = {{ type = "spring", from = {{ body = "ground", at = "A" }}, to = {{ body = "apex", at = "P" }}, stiffness = 50 }}
right = {{ type = "spring", from = {{ body = "ground", at = "B" }}, to = {{ body = "apex", at = "P" }}, stiffness = 50 }}
{loads}[equilibrium]
[metrics]
middle = {{ of = "P.z", take = "value", at = 0.5 }}
lowest = {{ of = "P.z", take = "min" }}
[time]
{times}
"#
    )
}

/// Force in N that holds that truss at this height in mm; and its limit load, at `L^3 = L_o w^2`.
fn load_of_shallow_truss(z: f64) -> f64 {
    let [long, short] = [80.0_f64, z].map(|z| z.hypot(300.0));
    2.0 * 50.0 * (long - short) * z / short
}

fn limit_of_shallow_truss() -> f64 {
    let length = (80.0_f64.hypot(300.0) * 300.0 * 300.0).cbrt();
    load_of_shallow_truss((length * length - 300.0 * 300.0).sqrt())
}

/// Output times that a half sine leads beyond between them, and others.
const ROUND_A_TURN: [&str; 7] = [
    "at = [0, 1]",
    "at = [0, 0.5, 1]",
    "at = [0, 0.1, 0.9]",
    "at = [0, 0.1, 0.2, 0.3, 0.5, 0.9]",
    "at = [0, 0.05, 0.1, 0.15, 0.85, 0.9, 0.95, 1]",
    "end = 1\nsteps = 7",
    "end = 1\nsteps = 41",
];

#[test]
fn a_driver_that_turns_between_output_times_ends_the_run_where_it_cannot_be_reached() {
    // Crank and rod are in line at sqrt(100^2 + 150^2) + 100 mm.
    let reach = 100.0_f64.hypot(150.0) + 100.0 - 150.0;
    let expected = (reach / 200.0).asin() / std::f64::consts::PI;
    for times in ROUND_A_TURN {
        let stop = Analysis::new(&file(&slider_crank(times)).model).unwrap().run().stop.expect(times);
        assert_eq!(stop.kind, StopKind::Limit, "{times}");
        near(stop.failed_time, expected, TIME_OF_LIMIT, times);
    }
}

/// An arm of 100 mm on one hinge, elastic in directions that the driver of its tip does not feel; or tilted by a force
/// across, so that it reaches less.
#[test]
fn a_driver_beyond_the_reach_of_an_arm_ends_at_a_limit() {
    let reach = |below: f64| 100.0_f64.hypot(below) - below;
    // 100 N at 100 mm against 10 N m/deg: a = cos a in deg.
    let mut tilt = 1.0_f64;
    (0..20).for_each(|_| tilt = tilt.to_radians().cos());
    // The tilted arm stops following the driver where its stiffness against the driver jumps.
    for (below, elastic, across, reach, time) in [
        (0.0, "z = 100", 0, reach(0.0), TIME_OF_LIMIT),
        (5.0, "z = 100", 0, reach(5.0), TIME_OF_LIMIT),
        (0.0, "about_z = 1", 0, reach(0.0), TIME_OF_LIMIT),
        (0.0, "z = 100, about_x = 10", 100, 100.0 * tilt.to_radians().cos(), 1e-6),
    ] {
        let text = format!(
            r#"
name = "arm"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ o = [0, 0, 0], tip = [100, 0, {below}] }}
bodies = {{ arm = {{}} }}
joints = {{ h = {{ type = "revolute", bodies = ["ground", "arm"], at = "o", axis = "y", axis2 = "x" }} }}
points = {{ tip = {{ body = "arm", at = "tip" }} }}
drivers = {{ d = {{ point = "tip", along = "z", law = "150*t" }} }}
equilibrium = {{}}
time = {{ end = 1, steps = 10 }}
[forces]
b = {{ type = "elastic_joint", joint = "h", {elastic} }}
across = {{ type = "force", at = "tip", force = {across}, along = "y" }}
"#
        );
        let stop = Analysis::new(&file(&text).model).unwrap().run().stop.expect(elastic);
        assert_eq!(stop.kind, StopKind::Limit, "{elastic}");
        near(stop.failed_time, reach / 150.0, time, elastic);
    }
}

#[test]
fn a_load_that_turns_between_output_times_ends_the_run_at_the_limit_load() {
    let limit = limit_of_shallow_truss();
    near(limit, 105.758297, 1e-6, "limit load");
    let expected = (limit / 200.0).asin() / std::f64::consts::PI;
    for times in ROUND_A_TURN {
        let model = file(&shallow_truss(&["200*sin(pi*t)"], times)).model;
        let stop = Analysis::new(&model).unwrap().run().stop.expect(times);
        assert_eq!(stop.kind, StopKind::NoEquilibrium, "{times}");
        near(stop.failed_time, expected, TIME_OF_LIMIT, times);
    }
    // None of these loads turns, but their sum does: 450 (t - t^2).
    let expected = 0.5 - (0.25 - limit / 450.0).sqrt();
    for times in ["at = [0, 1]", "at = [0, 0.2, 1]", "end = 1\nsteps = 7"] {
        let model = file(&shallow_truss(&["450*t", "-450*t^2"], times)).model;
        let stop = Analysis::new(&model).unwrap().run().stop.expect(times);
        assert_eq!(stop.kind, StopKind::NoEquilibrium, "{times}");
        near(stop.failed_time, expected, TIME_OF_LIMIT, times);
    }
}

#[test]
fn below_the_limit_load_output_times_and_metrics_do_not_depend_on_each_other() {
    let half_sine = |t: f64| 100.0 * (std::f64::consts::PI * t).sin();
    let parabola = |t: f64| 400.0 * (t - t * t);
    type Load = fn(f64) -> f64;
    let cases: [(&[&str], Load); 2] = [(&["100*sin(pi*t)"], half_sine), (&["400*t", "-400*t^2"], parabola)];
    for (laws, load) in cases {
        for times in ROUND_A_TURN {
            let model = file(&shallow_truss(laws, times)).model;
            let solution = Analysis::new(&model).unwrap().run();
            assert!(solution.stop.is_none(), "{times}: {:?}", solution.stop);
            for (k, t) in solution.motion.times.iter().enumerate() {
                let z = 1e3 * value(&solution, k, "P.z");
                assert!(z > 45.0, "the stable branch");
                near(load_of_shallow_truss(z), load(*t), 1e-7, &format!("{laws:?}, t = {t}, {times}"));
            }
            let [middle, lowest] = &metrics(&model, &solution)[..] else { panic!("two metrics") };
            let [z, least] = [middle, lowest].map(|metric| 1e3 * metric.value.unwrap());
            // The last output time may be before the middle.
            if *solution.motion.times.last().unwrap() >= 0.5 {
                near(load_of_shallow_truss(z), 100.0, 1e-7, times);
                let error = lowest.error.map_or(1e-9, |error| 1e3 * error + 1e-9);
                near(least, z, error, times);
            }
        }
    }
}

#[test]
fn a_value_over_a_measure_has_its_derivative_for_any_output_times() {
    const LEVER: &str = r#"
name = "lever"
units = { length = "mm", angle = "deg" }
hardpoints = { A = [0, 0, 0], B = [300, 0, 0] }
bodies = { arm = {} }
points.tip = { body = "arm", at = "B" }
joints.j = { type = "revolute", bodies = ["ground", "arm"], at = "A", axis = "y", axis2 = "x" }
equilibrium = {}
metrics.z = { of = "tip.z", over = "tip.x", take = "value", at = 299 }
design.B = { move = "B", along = "x" }
[forces]
e = { type = "elastic_joint", joint = "j", x = 100, y = 80, about_z = 2 }
load = { type = "force", at = "tip", force = 100, along = "-z", law = "sin(pi*t)" }
[time]
"#;
    for times in ["at = [0, 1]", "at = [0, 0.3, 1]", "end = 1\nsteps = 100"] {
        let model = file(&format!("{LEVER}{times}\n")).model;
        let analysis = Analysis::new(&model).unwrap();
        let at = |b: f64| metrics(&model, &analysis.solve(Run::new().at(&[b])))[0].clone();
        // The curve is steep: its scale is the millimetre by which the tip moves.
        let step = 3e-7;
        let [more, less] = [step, -step].map(|b| at(b).value.unwrap());
        let (found, expected) = (at(0.0).d[0], (more - less) / (2.0 * step));
        // The slope there is a central difference of solved positions.
        assert!((found - expected).abs() < 1e-5 * expected.abs(), "{times}: {found} {expected}");
    }
}

/// A lever OB on an elastic pin, held by a rigid rod to G. A force at its end turns it until O, B and G are in line,
/// and beyond.
fn lever_in_line(joint: &str, height: f64) -> String {
    format!(
        r#"
name = "lever"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ O = [0, 0, 0], B = [100, 0, 0], G = [250, {height}, 0] }}
bodies.lever = {{}}
joints.pin = {{ type = "{joint}", bodies = ["ground", "lever"], at = "O", axis = "z", axis2 = "x" }}
joints.rod = {{ type = "distance", bodies = ["ground", "lever"], at = ["G", "B"] }}
measures.by = {{ type = "position", point = {{ body = "lever", at = "B" }}, along = "y" }}
equilibrium = {{}}
time = {{ end = 1, steps = 10 }}
[forces]
bush = {{ type = "elastic_joint", joint = "pin", x = 100, y = 100, z = 100, about_x = 10, about_y = 10, about_z = 1 }}
push = {{ type = "force", at = {{ body = "lever", at = "B" }}, force = 1, along = "y", law = "1000*t" }}
"#
    )
}

/// The rod stops holding the angle of the pin where all is in line; what it holds there is the rubber along the rod.
#[test]
fn a_rod_passes_the_line_through_an_elastic_hinge() {
    for height in [30.0, 5.0, 0.0, -5.0] {
        let of = |joint: &str, formulation| {
            let model = file(&lever_in_line(joint, height)).model;
            let solution = Analysis::with(&model, formulation).unwrap().run();
            assert!(solution.stop.is_none(), "{joint} {height}: {:?}", solution.stop);
            (0..=10).map(|k| value(&solution, k, "by")).collect::<Vec<_>>()
        };
        let expected = of("fixed", Formulation::Relative);
        if height == 30.0 {
            // Least energy with the rod as a condition, by Newton's method on both.
            near(expected[10], 54.349503130e-3, 1e-11, "energy");
        }
        for joint in ["revolute", "spherical", "cylindrical", "universal"] {
            for formulation in [Formulation::Relative, Formulation::Absolute] {
                for (k, (found, expected)) in of(joint, formulation).into_iter().zip(&expected).enumerate() {
                    near(found, *expected, 1e-12, &format!("{joint} {height} {formulation:?}, {k}"));
                }
            }
        }
    }
}

/// A crank-rocker that a spring and a moment on its crank turn beyond the position in which the rocker turns back: the
/// angle of the crank is the moment by the stiffness, whichever joint has the driver that is released.
#[test]
fn it_does_not_matter_which_driver_is_released() {
    for (driven, reversed) in [("a", false), ("b", false), ("d", false), ("d", true)] {
        let text = format!(
            r#"
name = "four-bar"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0], B = [21.21320343559643, 21.21320343559643, 0], C = [130, 95, 0], D = [120, 0, 0] }}
bodies = {{ crank = {{}}, coupler = {{}}, rocker = {{}} }}
equilibrium = {{ released = ["free"] }}
time = {{ end = 1, steps = 12 }}
[joints]
a = {{ type = "revolute", bodies = ["ground", "crank"], at = "A", axis = "z" }}
b = {{ type = "revolute", bodies = ["crank", "coupler"], at = "B", axis = "z" }}
c = {{ type = "spherical", bodies = ["coupler", "rocker"], at = "C" }}
d = {{ type = "revolute", bodies = ["ground", "rocker"], at = "D", axis = "z" }}
[drivers]
free = {{ joint = "{driven}", law = "0", reversed = {reversed} }}
[forces]
bar = {{ type = "torsion_spring", joint = "a", stiffness = 1 }}
turn = {{ type = "moment", body = "crank", moment = 1, about = "z", law = "-170*t" }}
[measures]
crank = {{ type = "coordinate", joint = "a" }}
own = {{ type = "coordinate", joint = "{driven}" }}
"#
        );
        let solution = solved(&text);
        for k in 0..=12 {
            let expected = -170.0_f64.to_radians() * k as f64 / 12.0;
            near(value(&solution, k, "crank"), expected, 1e-11, &format!("{driven}, {k}"));
        }
        // An interrupted run states the driver that the user released.
        let model = file(&text).model;
        let run = Run::new().progress(|progress| match progress.done {
            7 => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        });
        let stopped = Analysis::new(&model).unwrap().solve(run);
        let stop = stopped.stop.unwrap();
        let own = value(&solution, 6, "own");
        assert_eq!(stop.kind, StopKind::Interrupted);
        near(stop.drivers[0], if reversed { -own } else { own }, 1e-12, driven);
    }
}

/// A five-bar linkage in a plane, whose crank turns once. Springs, given as `(joint, N m/deg)`, and a force along y at
/// C hold what is free.
fn five_bar(places: [[f64; 2]; 4], released: &str, springs: &[(&str, f64)], force: f64) -> String {
    let [b, c, d, e] = places.map(|[x, y]| format!("[{x}, {y}, 0]"));
    let springs: String = springs
        .iter()
        .map(|(joint, k)| {
            format!("s_{joint} = {{ type = \"torsion_spring\", joint = \"{joint}\", stiffness = {k} }}\n")
        })
        .collect();
    format!(
        r#"
name = "five-bar"
planar = "xy"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0], B = {b}, C = {c}, D = {d}, E = {e} }}
bodies = {{ crank = {{}}, first = {{}}, second = {{}}, arm = {{}} }}
equilibrium = {{ released = ["free"] }}
points = {{ knee = {{ body = "first", at = "C" }} }}
time = {{ end = 1, steps = 100 }}
design = {{ D_x = {{ move = "D", along = "x" }}, B_x = {{ move = "B", along = "x" }} }}
[joints]
a = {{ type = "revolute", bodies = ["ground", "crank"], at = "A" }}
b = {{ type = "revolute", bodies = ["crank", "first"], at = "B" }}
c = {{ type = "revolute", bodies = ["first", "second"], at = "C" }}
d = {{ type = "revolute", bodies = ["second", "arm"], at = "D" }}
e = {{ type = "revolute", bodies = ["ground", "arm"], at = "E" }}
[drivers]
motor = {{ joint = "a", law = "360*t" }}
free = {{ joint = "{released}", law = "0" }}
[measures]
arm = {{ type = "coordinate", joint = "e" }}
x = {{ type = "position", point = "knee", along = "x" }}
motor = {{ type = "driver_force", driver = "motor" }}
pin = {{ type = "reaction", joint = "d", part = "radial" }}
turned = {{ type = "coordinate", joint = "a" }}
ratio = {{ type = "slope", of = "x", over = "turned", driver = "motor" }}
soft = {{ type = "compliance", of = "x", at = "knee", along = "x" }}
[metrics]
mean = {{ of = "x", take = "mean" }}
[forces]
push = {{ type = "force", at = "knee", force = {force}, along = "y" }}
{springs}"#
    )
}

/// A linkage that cannot follow its crank, with all of its links in line: the distance from B to E is their sum.
#[test]
fn a_linkage_on_springs_that_is_stretched_ends_at_a_limit() {
    let places = [[43.6, -2.7], [135.1, 4.5], [291.4, 3.5], [349.2, -26.0]];
    let [b, c, d, e] = places;
    let between = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
    let reach = between(b, c) + between(c, d) + between(d, e);
    // |B(t)|^2 + |E|^2 - 2 |B| |E| cos(angle of E - angle of B(t)) = reach^2
    let [(rb, tb), (re, te)] = [b, e].map(|[x, y]: [f64; 2]| (x.hypot(y), y.atan2(x)));
    let apart = ((rb * rb + re * re - reach * reach) / (2.0 * rb * re)).acos();
    let time = (te - tb + apart) / std::f64::consts::TAU;
    let text = five_bar(places, "b", &[("b", 1.0), ("c", 0.01), ("e", 0.1)], 5.0);
    let stop = Analysis::new(&file(&text).model).unwrap().run().stop.unwrap();
    assert_eq!(stop.kind, StopKind::Limit);
    near(stop.failed_time, time, TIME_OF_LIMIT, "time");
}

/// Linkages of which no two coordinates determine the others in the whole turn: an arm turns back, or two links are
/// stretched, while springs hold the rest. Angles of the arm, deg, and places of the knee, mm, are those of Newton's
/// method on the angles of all links with multipliers for the loop, without independent coordinates.
#[test]
fn springs_carry_a_linkage_through_a_whole_turn() {
    const MOST_ITERATIONS: usize = 20_000;
    let cases = [
        (
            five_bar([[31.1, -5.4], [115.5, 16.0], [329.4, 114.5], [260.9, 82.6]], "c", &[("d", 0.1)], 0.1),
            [
                (20, 13.158722299, 99.721512998),
                (50, 73.569348256, 53.060736712),
                (100, -7.308696666, 108.205917757),
            ],
        ),
        (
            five_bar(
                [[45.4, -23.6], [91.2, -104.7], [483.6, -43.6], [392.8, -23.5]],
                "c",
                &[("c", 0.01), ("d", 1.0), ("e", 0.01)],
                5.0,
            ),
            [
                (20, -10.724328336, 81.408271875),
                (50, -57.510038294, 47.033536619),
                (100, 0.131735987, 91.272173612),
            ],
        ),
        (
            five_bar(
                [[-16.7, -19.0], [88.5, 0.9], [220.7, 167.2], [222.7, 58.4]],
                "d",
                &[("b", 1.0), ("c", 0.01)],
                1.0,
            ),
            [
                (20, -1.730159712, 28.439665735),
                (50, 85.759582029, -89.006819848),
                (100, 6.602733392, 90.010105575),
            ],
        ),
    ];
    for (n, (text, expected)) in cases.iter().enumerate() {
        // Other coordinates are chosen before ever shorter steps follow these: within the third one it was 600,000.
        let coarse = file(&text.replace("steps = 100", "steps = 20")).model;
        let run = Analysis::new(&coarse).unwrap().solve(Run::new().without_sensitivities());
        let iterations = run.motion.effort.equilibrium_iterations;
        assert!(run.stop.is_none() && iterations < MOST_ITERATIONS, "{n}: {:?}, {iterations}", run.stop);
        for (k, arm, x) in *expected {
            near(value(&run, k / 5, "arm").to_degrees(), arm, 2e-9, &format!("{n} arm, coarse {k}"));
            near(1e3 * value(&run, k / 5, "x"), x, 2e-9, &format!("{n} x, coarse {k}"));
        }
        let model = file(text).model;
        let mut runs = Vec::new();
        // The first one ends in absolute coordinates where its arm turns fastest.
        let formulations = [Formulation::Relative, Formulation::Absolute];
        for formulation in formulations.into_iter().take(if n == 0 { 1 } else { 2 }) {
            let run = Analysis::with(&model, formulation).unwrap().run();
            assert!(run.stop.is_none(), "{n} {formulation:?}: {:?}", run.stop);
            for (k, arm, x) in *expected {
                // Nine decimals are stated.
                near(value(&run, k, "arm").to_degrees(), arm, 2e-9, &format!("{n} {formulation:?} arm, {k}"));
                near(1e3 * value(&run, k, "x"), x, 2e-9, &format!("{n} {formulation:?} x, {k}"));
            }
            runs.push(run);
        }
        // Loads, slopes, compliances and derivatives as well are those of the other formulation.
        if n == 1 {
            verify_all(&model);
        }
        let [here, other] = &runs[..] else { continue };
        for m in 0..here.measured.outputs.len() {
            let largest = (0..101).map(|k| here.measured.value(k, m)[0].abs()).fold(0.0, f64::max);
            let slopes = (0..101).flat_map(|k| (0..2).map(move |v| (k, VariableId(v))));
            let steepest = slopes.clone().map(|(k, v)| here.measured.d(k, v, m)[0].abs()).fold(0.0, f64::max);
            let what = format!("{n} {}", here.measured.outputs[m].name);
            for (k, v) in slopes {
                near(here.measured.value(k, m)[0], other.measured.value(k, m)[0], 1e-8 * largest, &what);
                let [d, other] = [here, other].map(|run| run.measured.d(k, v, m)[0]);
                near(d, other, 1e-7 * steepest, &what);
            }
        }
    }
}

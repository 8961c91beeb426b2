//! Loads: closed forms, power balance, the sum of all wrenches, sensitivities against re-solving.

use hardpoint::law::Law;
use hardpoint::measure::outputs;
use hardpoint::motion::Execution;
use hardpoint::run::{GradientMethod, Gradients};
use hardpoint::sensitivity::Admissibility;
use hardpoint::space::{Mat3, Vec3};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run, Solution};
use hardpoint::{draft::*, model::*};

use crate::workbench::*;

/// Two ways to the same number agree to this part of the largest that is in it.
const SAME: f64 = 1e-11;

pub fn on(body: &str, at: impl Into<LocationDraft>) -> PointRef {
    PointRef::On { body: body.into(), at: at.into() }
}

/// A point mass.
pub fn point_mass(name: &str, body: &str, at: impl Into<LocationDraft>, mass: f64) -> ElementDraft {
    rigid(name, body, at, mass, [0.0; 6])
}

/// A rigid mass, with moments and products of inertia about its centre.
pub fn rigid(
    name: &str,
    body: &str,
    at: impl Into<LocationDraft>,
    mass: f64,
    inertia: [f64; 6],
) -> ElementDraft {
    let [ixx, iyy, izz, ixy, iyz, izx] = inertia.map(|i| Some(i.into()));
    let kind = ElementKindDraft::Rigid {
        centre: on(body, at),
        mass: mass.into(),
        ixx,
        iyy,
        izz,
        ixy,
        iyz,
        izx,
        about: None,
    };
    ElementDraft::new(name, kind)
}

pub fn driver_force(driver: &str) -> MeasureKindDraft {
    MeasureKindDraft::DriverForce { driver: Some(driver.into()) }
}

pub fn reaction(joint: &str, part: ReactionPart) -> MeasureKindDraft {
    MeasureKindDraft::Reaction { joint: joint.into(), part, on: None, axes: None }
}

/// Values of a measure over a motion.
pub fn values(solution: &Solution, name: &str) -> Vec<f64> {
    let m = solution.measured.index(name).unwrap();
    (0..solution.motion.len()).map(|k| solution.measured.value(k, m)[0]).collect()
}

pub fn run(draft: &Draft, formulation: Formulation) -> Solution {
    let model = Model::from_draft(draft).unwrap_or_else(|f| panic!("{f:?}"));
    let solution = Analysis::with(&model, formulation).unwrap().run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    solution
}

/// A body of unit-like mass, turned about z at the origin by this law.
pub fn rotor(law: &str) -> Draft {
    Draft::new("rotor")
        .body("rotor")
        .revolute("pivot", ["ground", "rotor"], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0])
        .driver("motor", "pivot", Law::parse(law).unwrap())
        .times([0.0, 0.1, 0.35])
}

#[test]
fn an_unbalanced_rotor_pulls_with_m_r_omega_squared_and_a_balanced_one_does_not() {
    let (mass, radius, speed) = (2.0, 0.3, 7.0);
    for balanced in [false, true] {
        let mut draft = rotor("7*t")
            .measure("pull", reaction("pivot", ReactionPart::Radial))
            .measure("motor", driver_force("motor"))
            .measure("shaking", MeasureKindDraft::ShakingForce { along: None });
        draft.masses.push(point_mass("eccentric", "rotor", [radius, 0.0, 0.0], mass));
        if balanced {
            draft.masses.push(point_mass("weight", "rotor", [-radius / 2.0, 0.0, 0.0], 2.0 * mass));
        }
        let solution = run(&draft, Formulation::Relative);
        let expected = if balanced { 0.0 } else { mass * radius * speed * speed };
        for name in ["pull", "shaking"] {
            for x in values(&solution, name) {
                assert!(
                    (x - expected).abs() < 1e-12 * mass * radius * speed * speed,
                    "{name} {x} {expected}"
                );
            }
        }
        values(&solution, "motor").iter().for_each(|x| assert!(x.abs() < 1e-12));
    }
}

#[test]
fn a_pendulum_needs_its_weight_and_its_inertia() {
    let (mass, radius, own) = (1.7, 0.4, 0.02);
    let mut draft = rotor("0.3 + 2*t^2").measure("motor", driver_force("motor"));
    draft.masses.push(rigid("bob", "rotor", [radius, 0.0, 0.0], mass, [own, own, own, 0.0, 0.0, 0.0]));
    draft.gravity = Vec3::new(0.0, -9.81, 0.0);
    let solution = run(&draft, Formulation::Relative);
    for (t, torque) in solution.motion.times.iter().zip(values(&solution, "motor")) {
        let angle = 0.3 + 2.0 * t * t;
        // (I + m r^2) alpha + m g r cos(angle)
        let expected = (own + mass * radius * radius) * 4.0 + mass * 9.81 * radius * angle.cos();
        assert!((torque - expected).abs() < 1e-13 * 30.0, "{torque} {expected}");
    }
}

/// A slider-crank in the plane with everything that can push, in tilted and offset places.
pub fn press() -> Draft {
    let z = [0.0, 0.0, 1.0];
    let mut draft = Draft::new("press")
        .hardpoint("A", [0.0, 0.0, 0.0])
        .hardpoint("B", [0.06, 0.02, 0.0])
        .hardpoint("C", [0.29, -0.01, 0.0])
        .bodies(["crank", "rod", "ram"])
        .revolute("A", ["ground", "crank"], "A", z)
        .revolute("B", ["crank", "rod"], "B", z)
        .revolute("C", ["rod", "ram"], "C", z)
        .translational("guide", ["ground", "ram"], "C", [1.0, 0.0, 0.0])
        .driver("motor", "A", Law::parse("5*t + 3*t^2").unwrap())
        .variable_moving("crank pin up", "B", [0.0, 1.0, 0.0])
        .variable_moving("wrist pin along", "C", [1.0, 0.0, 0.0])
        .times([0.0, 0.07, 0.2, 0.41, 0.8]);
    draft.gravity = Vec3::new(0.0, -9.81, 0.0);
    draft.masses = vec![
        rigid("crank", "crank", [0.02, 0.01, 0.0], 3.0, [0.01, 0.012, 0.02, 0.001, 0.0, 0.0]),
        ElementDraft::new(
            "rod",
            ElementKindDraft::Bar {
                from: on("rod", "B"),
                to: on("rod", "C"),
                diameter: 0.03.into(),
                bore: Some(0.01.into()),
                density: 7850.0.into(),
            },
        ),
        point_mass("ram", "ram", "C", 5.0),
    ];
    draft.forces = vec![
        ElementDraft::new(
            "work",
            ElementKindDraft::PointForce {
                at: on("ram", "C"),
                force: (-300.0).into(),
                along: Vec3::new(1.0, 0.1, 0.0),
                axes: None,
                law: Some(Law::parse("1 + sin(3*t)").unwrap()),
            },
        ),
        ElementDraft::new(
            "spring",
            ElementKindDraft::Spring {
                from: on("ground", [0.5, 0.1, 0.0]),
                to: on("ram", "C"),
                stiffness: Some(2000.0.into()),
                cubic: Some(30000.0.into()),
                compression: None,
                extension: None,
                scale: None,
                free_length: None,
                preload: Some((-40.0).into()),
                damping: Some(25.0.into()),
            },
        ),
        ElementDraft::new(
            "return",
            ElementKindDraft::TorsionSpring {
                joint: "B".into(),
                coordinate: None,
                stiffness: 3.0.into(),
                equilibrium: Some(0.2.into()),
                curve: None,
                scale: None,
                damping: Some(0.1.into()),
            },
        ),
    ];
    draft
        .measure("torque", driver_force("motor"))
        .measure("power", MeasureKindDraft::DriverPower { driver: None })
        .measure("energy", MeasureKindDraft::KineticEnergy { body: None })
        .measure("spring", MeasureKindDraft::SpringForce { force: "spring".into() })
        .measure("A", reaction("A", ReactionPart::Radial))
        .measure("B", reaction("B", ReactionPart::Radial))
        .measure("C.x", reaction("C", ReactionPart::ForceAlong(0)))
        .measure("guide", reaction("guide", ReactionPart::ForceAlong(1)))
        .measure("shaking", MeasureKindDraft::ShakingForce { along: None })
        .measure(
            "rocking",
            MeasureKindDraft::ShakingMoment { about: on("ground", "A"), along: Some(Vec3::AXES[2]) },
        )
}

const LOADS: [&str; 10] =
    ["torque", "power", "energy", "spring", "A", "B", "C.x", "guide", "shaking", "rocking"];

#[test]
fn both_formulations_carry_the_same_loads_with_the_same_sensitivities() {
    let draft = press();
    let [a, b] = [Formulation::Relative, Formulation::Absolute].map(|f| run(&draft, f));
    for name in LOADS {
        let (x, y) = (values(&a, name), values(&b, name));
        let scale = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(scale > 0.0, "{name}");
        for (x, y) in x.iter().zip(&y) {
            assert!((x - y).abs() < SAME * scale, "{name}: {x} {y}");
        }
        let m = a.measured.index(name).unwrap();
        for v in [0, 1].map(VariableId) {
            let d = |s: &Solution, k: usize| s.measured.d(k, v, m)[0];
            let scale = (0..5).fold(0.0_f64, |most, k| most.max(d(&a, k).abs()));
            for k in 0..5 {
                assert!((d(&a, k) - d(&b, k)).abs() <= SAME * scale, "{name} {k}: {} {}", d(&a, k), d(&b, k));
            }
        }
    }
}

/// Sensitivities of the loads of a draft against differences between solved designs.
pub fn compare_with_solved(draft: &Draft, names: &[&str]) {
    compare_with_solved_above(draft, names, 0.0);
}

/// The same for loads that are made of others of this size, whose round-off they have.
fn compare_with_solved_above(draft: &Draft, names: &[&str], size: f64) {
    let model = Model::from_draft(draft).unwrap_or_else(|f| panic!("{f:?}"));
    let analysis = Analysis::new(&model).unwrap();
    let nominal = analysis.run();
    let followed =
        |v: &usize| !matches!(nominal.sensitivities.admissibility[*v], Admissibility::CannotFollow { .. });
    for v in (0..model.variables.len()).filter(followed) {
        let at = |h: f64| analysis.solve(Run::new().at(&model_design(&model, v, h)).without_sensitivities());
        // Differences of fourth order: their error is some 1e-9 of the derivatives at this step.
        let h = 5e-5 * model.natural_step(VariableId(v));
        let [far_below, below, above, far_above] = [-2.0 * h, -h, h, 2.0 * h].map(at);
        for name in names {
            let m = nominal.measured.index(name).unwrap();
            let of = |s: &Solution, k: usize| s.measured.value(k, m)[0];
            let exact = |k: usize| nominal.measured.d(k, VariableId(v), m)[0];
            let scale = (0..nominal.motion.len()).fold(0.0_f64, |most, k| most.max(exact(k).abs()));
            for k in 0..nominal.motion.len() {
                let difference = (8.0 * (of(&above, k) - of(&below, k))
                    - (of(&far_above, k) - of(&far_below, k)))
                    / (12.0 * h);
                let largest = (0..nominal.motion.len()).fold(size, |most, k| most.max(of(&nominal, k).abs()));
                assert!(
                    (difference - exact(k)).abs() <= RESOLVED * scale + ROUND_OFF * largest / h,
                    "{name} {v} {k}: {difference} {}",
                    exact(k)
                );
            }
        }
    }
}

fn model_design(model: &Model, v: usize, h: f64) -> Vec<f64> {
    (0..model.variables.len()).map(|k| if k == v { h } else { 0.0 }).collect()
}

/// Differences of fourth order agree with derivatives to this part.
const RESOLVED: f64 = 2e-7;
/// Loads are good to this part of the largest, which differences divide by their step.
const ROUND_OFF: f64 = 1e-12;

#[test]
fn forces_that_go_by_laws_and_speeds_are_the_same_by_program() {
    let mut draft = press();
    for force in &mut draft.forces {
        // Turns of the cut joint would be counted along the path, which no program does.
        if let ElementKindDraft::TorsionSpring { joint, .. } = &mut force.kind {
            *joint = "A".into();
        }
    }
    draft.times = (0..=160).map(|k| 0.8 * f64::from(k) / 160.0).collect();
    let model = Model::from_draft(&draft).unwrap();
    let solve = |execution| Analysis::new(&model).unwrap().executed(execution).run();
    let [right, again] = [Execution::Kernel, Execution::Compiled].map(solve);
    // All but the first output time, and the last, which is alone in its group of eight.
    assert_eq!([right.motion.effort.by_program, again.motion.effort.by_program], [0, 159]);
    for name in LOADS {
        let m = right.measured.index(name).unwrap();
        for v in [None].into_iter().chain((0..model.variables.len()).map(|v| Some(VariableId(v)))) {
            let of = |s: &Solution, k: usize| match v {
                None => s.measured.value(k, m)[0],
                Some(v) => s.measured.d(k, v, m)[0],
            };
            let [x, y] =
                [&right, &again].map(|s| (0..s.motion.len()).map(|k| of(s, k)).collect::<Vec<f64>>());
            let size = x.iter().fold(1e-3_f64, |most, x| most.max(x.abs()));
            let apart = x.iter().zip(&y).fold(0.0_f64, |most, (x, y)| most.max((x - y).abs()));
            assert!(apart < SAME * size, "{name}: {apart:e} of {size}");
        }
    }
}

#[test]
fn laws_beyond_the_range_of_their_program_are_those_of_the_kernel() {
    let mut draft = press();
    // Without loads the steps need no laws of forces.
    draft.measures.clear();
    draft.drivers[0].law = Law::parse("sin(10*t)").unwrap();
    // An argument of some 1e6 is beyond the range of a recorded sine.
    draft.times = (0..=64).map(|k| 1e5 + 0.01 * f64::from(k)).collect();
    let model = Model::from_draft(&draft).unwrap();
    let solve = |execution| Analysis::new(&model).unwrap().executed(execution).run();
    let [right, again] = [Execution::Kernel, Execution::Compiled].map(solve);
    assert_eq!(right.motion.len(), 65);
    for k in 0..65 {
        for (x, y) in right.motion.coordinates(k).zip(again.motion.coordinates(k)) {
            assert!((x - y).abs() < SAME, "{k}: {x} {y}");
        }
    }
}

#[test]
fn sensitivities_of_loads_are_those_of_solved_designs() {
    compare_with_solved(&press(), &LOADS);
}

/// Loads of a draft that are determined at all times, and whose derivatives are above round-off; and the largest value.
fn determined_loads(draft: &Draft) -> (Vec<String>, f64) {
    let model = Model::from_draft(draft).unwrap();
    let solution = Analysis::new(&model).unwrap().run();
    let steps = || 0..solution.motion.len();
    let largest = |m: usize| {
        let by = |v: usize| steps().map(move |k| (k, VariableId(v)));
        let all = (0..model.variables.len()).flat_map(by);
        all.fold(0.0_f64, |most, (k, v)| most.max(solution.measured.d(k, v, m)[0].abs()))
    };
    let of_all = (0..model.measures.len()).map(largest).fold(0.0, f64::max);
    let is_determined = |m: &usize| steps().all(|k| !solution.measured.value(k, *m)[0].is_nan());
    let determined: Vec<usize> = (0..model.measures.len()).filter(is_determined).collect();
    let values = determined.iter().flat_map(|&m| steps().map(move |k| (k, m)));
    let size = values.fold(0.0_f64, |most, (k, m)| most.max(solution.measured.value(k, m)[0].abs()));
    let all = determined.iter().filter(|m| largest(**m) > LITTLE * of_all);
    (all.map(|m| model.measures[*m].name.clone()).collect(), size)
}

/// Checks the virtual motions, from which all derivatives of loads follow, against a formulation without them.
#[test]
fn sensitivities_of_all_loads_at_all_joints_are_those_of_solved_designs() {
    let all = crate::joints::mechanisms().into_iter().map(made_heavy);
    for draft in [press(), press_with_friction()].into_iter().chain(all) {
        let mut draft = asking_for_all(draft);
        draft.times = draft.times.iter().copied().step_by(usize::max(draft.times.len() / 2, 1)).collect();
        let (names, size) = determined_loads(&draft);
        assert!(!names.is_empty(), "{}", draft.name);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        compare_with_solved_above(&draft, &names, LITTLE * size);
    }
}

/// The work of a driver is the gain of kinetic energy plus the work of forces and weight: by differences of the energy
/// over time.
#[test]
fn power_is_balanced() {
    let mut draft = press();
    draft.forces.clear();
    draft.measures.retain(|m| m.name == "power" || m.name == "energy");
    let h = 1e-4;
    draft.gravity = Vec3::ZERO;
    for t in [0.1, 0.3, 0.7] {
        draft.times = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k: f64| t + k * h).to_vec();
        let solution = run(&draft, Formulation::Relative);
        let e = values(&solution, "energy");
        let gained = (8.0 * (e[3] - e[1]) - (e[4] - e[0])) / (12.0 * h);
        let power = values(&solution, "power")[2];
        assert!((gained - power).abs() < 1e-8 * power.abs().max(1.0), "{gained} {power}");
    }
}

/// A reference mechanism whose bodies have masses, made up but each another one, off their origins and unevenly spread.
pub fn heavy(name: &str) -> Draft {
    made_heavy(reference_draft(name))
}

/// Masses on all bodies of a draft.
fn made_heavy(mut draft: Draft) -> Draft {
    let model = Model::from_draft(&draft).unwrap();
    draft.gravity = Vec3::new(0.4, -1.3, -9.7);
    for (k, body) in model.bodies.iter().enumerate().skip(1) {
        let x = k as f64;
        let size = 0.1 * model.size();
        let centre = body.frame.r + Vec3::new(size * x.sin(), size * (2.0 * x).cos(), 0.3 * size);
        let mass = 1.0 + 0.3 * (3.0 * x).sin();
        let i = mass * size * size;
        let inertia = [0.9 * i, 1.1 * i, 1.3 * i, 0.1 * i, -0.2 * i, 0.15 * i];
        draft.masses.push(rigid(&body.name, &body.name, centre.to_array(), mass, inertia));
    }
    draft.measures.clear();
    draft.metrics.clear();
    for driver in draft.drivers.clone() {
        let kind = driver_force(&driver.name);
        draft.measures.push(MeasureDraft::new(format!("force of {}", driver.name), kind));
    }
    draft
}

/// Newton and Euler for a body of [`heavy`], classically, about its own centre: the force and the moment that it needs
/// besides its weight.
fn newton_euler(
    draft: &Draft,
    model: &Model,
    k: usize,
    s: &hardpoint::motion::BodyState,
) -> (Vec3, Vec3, Vec3) {
    let ElementKindDraft::Rigid {
        centre: PointRef::On { at: LocationDraft::At(drawn), .. },
        mass,
        ixx,
        iyy,
        izz,
        ixy,
        iyz,
        izx,
        about: None,
    } = draft.masses[k - 1].kind.clone()
    else {
        unreachable!("made so")
    };
    let of = |n: Option<NumberDraft>| n.unwrap().value;
    let [a, b, c, d, e, f] = [ixx, iyy, izz, ixy, iyz, izx].map(of);
    let turn = s.rotation * model.bodies[k].frame.rot.transpose();
    let arm = turn * (drawn - model.bodies[k].frame.r);
    let inertia = |w: Vec3| {
        let w = turn.transpose() * w;
        turn * Vec3::new(
            a * w.x - d * w.y - f * w.z,
            b * w.y - d * w.x - e * w.z,
            c * w.z - f * w.x - e * w.y,
        )
    };
    let acceleration = s.a + s.alpha.cross(arm) + s.omega.cross(s.omega.cross(arm));
    let force = (acceleration - draft.gravity) * mass.value;
    (s.r + arm, force, inertia(s.alpha) + s.omega.cross(inertia(s.omega)))
}

/// Wrenches on a body balance to this part of the largest that acts on it.
const BALANCED: f64 = 1e-11;

#[test]
fn reactions_balance_every_body_in_both_formulations() {
    for name in REFERENCES {
        let draft = heavy(name);
        let model = Model::from_draft(&draft).unwrap();
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            let analysis = Analysis::with(&model, formulation).unwrap();
            let (motion, loads) = (analysis.run().motion, analysis.loads(&[]));
            assert_eq!(loads.times.len(), model.times.len(), "{name}");
            for k in 0..loads.times.len() {
                let state = |b: BodyId| motion.at(k).body(b.0);
                let power: f64 = loads.drivers_at(k).iter().map(|d| d.force * d.speed).sum();
                let (mut needed, mut largest_power) = (0.0, 1e-9_f64);
                for body in (1..model.bodies.len()).map(BodyId) {
                    let s = state(body);
                    let (centre, force, moment) = newton_euler(&draft, &model, body.0, &s);
                    let velocity = s.v + s.omega.cross(centre - s.r);
                    let terms = [force.dot(velocity), moment.dot(s.omega)];
                    needed += terms[0] + terms[1];
                    largest_power = largest_power.max(terms[0].abs()).max(terms[1].abs());
                    if !model.couplers.is_empty() {
                        continue;
                    }
                    let (mut f, mut m, mut largest) = (-force, -moment, force.norm());
                    for (joint, load) in model.joints.iter().zip(loads.joints_at(k)) {
                        let sign = [(joint.bodies[1], 1.0), (joint.bodies[0], -1.0)];
                        for (_, sign) in sign.into_iter().filter(|(b, _)| *b == body) {
                            f += load.force * sign;
                            m += (load.moment + (load.place - centre).cross(load.force)) * sign;
                            largest = largest.max(load.force.norm());
                        }
                    }
                    let size = model.size();
                    assert!(
                        f.norm() < BALANCED * largest && m.norm() < BALANCED * largest * size,
                        "{name} {formulation:?} {}: {f:?} {m:?} of {largest}",
                        model.bodies[body.0].name
                    );
                }
                assert!(
                    (power - needed).abs() < 1e-11 * largest_power,
                    "{name} {formulation:?}: {power} {needed} of {largest_power}"
                );
            }
        }
    }
}

#[test]
fn driver_forces_of_every_reference_follow_the_design() {
    for name in REFERENCES {
        let mut draft = heavy(name);
        draft.times = draft.times.iter().copied().step_by(usize::max(draft.times.len() / 4, 1)).collect();
        let names: Vec<String> = draft.measures.iter().map(|m| m.name.clone()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        println!("{name}");
        compare_with_solved(&draft, &names);
    }
}

fn compliance(of: &str, at: PointRef, along: [f64; 3]) -> MeasureKindDraft {
    MeasureKindDraft::Compliance {
        of: of.into(),
        at: Some(at),
        wheel: None,
        force: None,
        along: Some(along.into()),
        released: None,
    }
}

/// The same with a driver released.
fn released(of: &str, at: PointRef, along: [f64; 3], driver: &str) -> MeasureKindDraft {
    let mut kind = compliance(of, at, along);
    if let MeasureKindDraft::Compliance { released, .. } = &mut kind {
        *released = Some(driver.into());
    }
    kind
}

fn elastic(name: &str, joint: &str, stiffness: [f64; 3], about_z: Option<f64>) -> ElementDraft {
    let mut element = Draft::default().elastic_joint(name, joint, stiffness).forces.remove(0);
    if let ElementKindDraft::ElasticJoint { about_z: about, .. } = &mut element.kind {
        *about = about_z.map(NumberDraft::from);
    }
    element
}

#[test]
fn a_lever_in_a_bushing_deflects_by_force_over_stiffness_times_arm_squared() {
    let (arm, k, about) = (0.5, [2e5, 4e5, 8e5], 3e3);
    let mut draft = rotor("0.4*t").point("tip", "rotor", [arm, 0.0, 0.0]);
    draft.joints[0].axis2 = Some([1.0, 0.0, 0.0].into());
    draft.forces.push(elastic("bushing", "pivot", k, Some(about)));
    let tip = || on("rotor", [arm, 0.0, 0.0]);
    let draft = draft
        .measure("along", compliance("tip.x", tip(), [1.0, 0.0, 0.0]))
        .measure("across", compliance("tip.y", tip(), [0.0, 2.0, 0.0]))
        .measure("up", compliance("tip.z", tip(), [0.0, 0.0, 1.0]))
        .measure("released", released("tip.y", tip(), [0.0, 2.0, 0.0], "motor"));
    let solution = run(&draft, Formulation::Relative);
    // The joint turns freely: its stiffness about the axis is a spring against that, which the motor holds.
    let expected = [
        ("along", 1.0 / k[0]),
        ("across", 1.0 / k[1]),
        ("up", 1.0 / k[2]),
        ("released", 1.0 / k[1] + arm * arm / about),
    ];
    for (name, expected) in expected {
        let found = values(&solution, name)[0];
        assert!((found - expected).abs() < 1e-14 * expected.abs().max(1e-5), "{name} {found} {expected}");
    }
}

/// A suspension with rubber bushings at its ball joints and hinges, loaded at a point of its last body.
pub fn soft(name: &str) -> (Draft, Vec<String>) {
    let mut draft = reference_draft(name);
    let model = Model::from_draft(&draft).unwrap();
    draft.measures.clear();
    draft.metrics.clear();
    draft.times = draft.times.iter().copied().step_by(usize::max(draft.times.len() / 3, 1)).collect();
    let has_point = |j: &&Joint| j.kind.places == 1 && !j.kind.is_rod();
    let joints: Vec<String> = model.joints.iter().filter(has_point).map(|j| j.name.clone()).collect();
    for (k, joint) in joints.iter().enumerate() {
        let stiffness = 1e6 * (1.0 + k as f64);
        draft.forces.push(elastic(&format!("rubber {k}"), joint, [stiffness; 3], None));
    }
    // The body that most joints hold, which is the wheel's.
    let holds = |b: &BodyId| model.joints.iter().filter(|j| j.bodies.contains(b)).count();
    let knuckle = (1..model.bodies.len()).map(BodyId).max_by_key(holds).unwrap();
    let knuckle = &model.bodies[knuckle.0];
    let place = knuckle.frame.r + Vec3::new(0.02, 0.1, -0.05);
    draft = draft.point("pushed", &knuckle.name, place.to_array());
    (draft, joints)
}

#[test]
fn elastic_joints_store_half_the_work_of_a_force() {
    for name in ["macpherson", "double_wishbone"] {
        let (mut draft, joints) = soft(name);
        let pushed = || PointRef::Named("pushed".into());
        let along = [0.3, 0.8, -0.4];
        let unit = Vec3::from(along).unit().unwrap();
        for component in ["x", "y", "z"] {
            let name = format!("to {component}");
            draft = draft.measure(name, compliance(&format!("pushed.{component}"), pushed(), along));
        }
        draft = draft
            .measure("x by y", compliance("pushed.x", pushed(), [0.0, 1.0, 0.0]))
            .measure("y by x", compliance("pushed.y", pushed(), [1.0, 0.0, 0.0]));
        draft.forces.push(ElementDraft::new(
            "push",
            ElementKindDraft::PointForce {
                at: pushed(),
                force: 1.0.into(),
                along: along.into(),
                axes: None,
                law: None,
            },
        ));
        let solution = run(&draft, Formulation::Relative);
        let model = Model::from_draft(&draft).unwrap();
        let loads = Analysis::new(&model).unwrap().loads(&[]);
        let of = |name: &str, k: usize| values(&solution, name)[k];
        // Along a slide a joint moves freely, and stores nothing.
        let rigid_part = |j: usize, k: usize| {
            let Joint { kind, axis, bodies, .. } = &model.joints[j];
            let force = loads.joints_at(k)[j].force;
            let at = |h: HardpointId| model.hardpoints[h.0].position;
            let n = match axis {
                Some(Direction::Along(n)) if kind.name == "translational" => *n,
                Some(Direction::Through(a, b)) if kind.name == "translational" => {
                    (at(*b) - at(*a)).unit().unwrap()
                }
                _ => return force,
            };
            let turn = match bodies[0] {
                GROUND => Mat3::IDENTITY,
                b => solution.body(k, b).rotation * model.bodies[b.0].frame.rot.transpose(),
            };
            force - turn * n * force.dot(turn * n)
        };
        for k in 0..solution.motion.len() {
            let deflection = Vec3::new(of("to x", k), of("to y", k), of("to z", k)).dot(unit);
            let stored: f64 = joints
                .iter()
                .enumerate()
                .map(|(n, joint)| {
                    let j = model.joints.iter().position(|j| j.name == *joint).unwrap();
                    rigid_part(j, k).norm().powi(2) / (1e6 * (1.0 + n as f64))
                })
                .sum();
            assert!((deflection - stored).abs() < 1e-10 * stored, "{name} {k}: {deflection} {stored}");
            // Maxwell and Betti
            let (a, b) = (of("x by y", k), of("y by x", k));
            assert!((a - b).abs() < 1e-11 * stored.max(a.abs()), "{name} {k}: {a} {b}");
        }
        compare_with_solved(&draft, &["to x", "to y", "to z", "x by y"]);
    }
}

#[test]
fn with_its_driver_released_a_strut_deflects_against_its_spring() {
    // A lever on a hinge, held by a spring across its tip: F/k of the spring by the square of the arms' ratio.
    let (arm, k) = (0.5, 3e4);
    let mut draft = rotor("0*t").point("tip", "rotor", [arm, 0.0, 0.0]);
    draft.forces.push(ElementDraft::new(
        "spring",
        ElementKindDraft::Spring {
            from: on("ground", [0.2, -0.3, 0.0]),
            to: on("rotor", [0.2, 0.0, 0.0]),
            stiffness: Some(k.into()),
            cubic: None,
            compression: None,
            extension: None,
            scale: None,
            free_length: None,
            preload: None,
            damping: None,
        },
    ));
    let kind = MeasureKindDraft::Compliance {
        of: "tip.y".into(),
        at: Some(on("rotor", [arm, 0.0, 0.0])),
        wheel: None,
        force: None,
        along: Some([0.0, 1.0, 0.0].into()),
        released: Some("motor".into()),
    };
    let solution = run(&draft.measure("give", kind), Formulation::Relative);
    let expected = (arm / 0.2_f64).powi(2) / k;
    assert!((values(&solution, "give")[0] - expected).abs() < 1e-12 * expected);
}

pub fn friction(name: &str, joint: &str, coefficient: f64, radius: f64) -> ElementDraft {
    let kind = ElementKindDraft::Friction {
        joint: joint.into(),
        coefficient: coefficient.into(),
        radius: radius.into(),
        length: None,
        viscous: None,
        transition_velocity: None,
    };
    ElementDraft::new(name, kind)
}

/// Relative deviation from full friction: the transition velocity is 0.01 rad/s, the speed some rad/s.
const WHOLE: f64 = 1e-5;

#[test]
fn friction_of_a_loaded_shaft_follows_its_weight_and_the_radius_of_its_pin() {
    let mut draft = rotor("7*t").measure("motor", driver_force("motor"));
    draft.masses.push(point_mass("disc", "rotor", [0.0, 0.0, 0.0], 40.0));
    draft.gravity = Vec3::new(0.0, -9.81, 0.0);
    draft.forces.push(friction("pin", "pivot", 0.15, 0.02));
    let solution = run(&draft, Formulation::Relative);
    let expected = 0.15 * 0.02 * 40.0 * 9.81;
    for torque in values(&solution, "motor") {
        assert!((torque - expected).abs() < WHOLE * expected, "{torque} {expected}");
    }
}

#[test]
fn friction_depends_on_reactions_that_it_changes() {
    let mut draft = press();
    let pins = [("A", 0.3, 0.03), ("B", 0.2, 0.06), ("C", 0.15, 0.02)];
    for (joint, coefficient, radius) in pins {
        draft.forces.push(friction(&format!("has friction at {joint}"), joint, coefficient, radius));
        let force = MeasureKindDraft::SpringForce { force: format!("has friction at {joint}") };
        draft = draft.measure(format!("moment at {joint}"), force);
        draft = draft.measure(format!("force at {joint}"), reaction(joint, ReactionPart::Radial));
        draft = draft.measure(format!("angle at {joint}"), joint);
    }
    let [a, b] = [Formulation::Relative, Formulation::Absolute].map(|f| run(&draft, f));
    for (joint, coefficient, radius) in pins {
        let [moments, forces] = ["moment", "force"].map(|what| values(&a, &format!("{what} at {joint}")));
        let angle = a.measured.index(&format!("angle at {joint}")).unwrap();
        for k in 0..moments.len() {
            let speed = a.measured.value(k, angle)[1];
            let expected = -coefficient * radius * forces[k] * speed / speed.hypot(0.01);
            assert!((moments[k] - expected).abs() < 1e-12 * expected.abs().max(1.0), "{joint} {k}");
        }
    }
    let names = ["torque", "moment at A", "moment at B", "moment at C", "force at B", "guide"];
    for name in names {
        let (x, y) = (values(&a, name), values(&b, name));
        let scale = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        x.iter().zip(&y).for_each(|(x, y)| assert!((x - y).abs() < SAME * scale, "{name} {x} {y}"));
    }
    compare_with_solved(&draft, &names);
}

#[test]
fn hinges_that_jam_have_no_moment() {
    // A pin so thick that its friction is above all that turns it.
    let mut draft = press();
    draft.forces.push(friction("jams", "C", 3.0, 0.3));
    let model = Model::from_draft(&draft).unwrap();
    let solution = Analysis::new(&model).unwrap().run();
    let torque = values(&solution, "torque");
    assert!(torque.iter().any(|x| x.is_nan()), "{torque:?}");
}

/// A door of this mass in two hinges on one line.
pub fn door(leaf: ElementDraft) -> Draft {
    let z = [0.0, 0.0, 1.0];
    let mut draft = Draft::new("door")
        .body("door")
        .revolute("lower", ["ground", "door"], [0.0, 0.0, 0.0], z)
        .revolute("upper", ["ground", "door"], [0.0, 0.0, 2.0], z)
        .driver("hand", "lower", Law::parse("t").unwrap())
        .times([0.0, 0.5]);
    draft.masses.push(leaf);
    draft.gravity = Vec3::new(0.0, 0.0, -10.0);
    draft
}

#[test]
fn only_reactions_shared_by_redundant_constraints_are_undetermined() {
    // Two hinges on one line hold a door: the weight along the line is shared, the rest is not.
    let draft = door(rigid("leaf", "door", [0.5, 0.0, 1.0], 20.0, [1.0, 1.2, 0.3, 0.0, 0.0, 0.0]))
        .measure("axial", reaction("upper", ReactionPart::Axial))
        .measure("radial", reaction("upper", ReactionPart::Radial))
        .measure("hand", driver_force("hand"));
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let solution = run(&draft, formulation);
        assert!(values(&solution, "axial").iter().all(|x| x.is_nan()));
        assert!(values(&solution, "radial").iter().all(|x| x.is_nan()));
        // The hinges' moments across their line are shared with the pair of forces, the torque about it is not.
        assert!(values(&solution, "hand").iter().all(|x| x.abs() < 1e-12));
    }
}

/// Agreement with numbers that another program printed with all their digits.
const PRINTED: f64 = 1e-13;

#[test]
fn driver_torques_of_an_open_arm_agree_with_pinocchio() {
    let joints = [
        ([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        ([0.1, 0.05, 0.4], [0.0, 1.0, 0.2]),
        ([0.5, -0.1, 0.6], [1.0, 0.3, -0.4]),
        ([0.7, 0.2, 0.3], [-0.2, 1.0, 0.5]),
    ];
    let bodies = [
        (3.0, [0.02, 0.01, 0.2], [0.05, 0.06, 0.03, 0.004, -0.002, 0.003]),
        (2.2, [0.3, 0.0, 0.55], [0.02, 0.05, 0.04, 0.001, 0.003, -0.004]),
        (1.4, [0.6, 0.1, 0.45], [0.01, 0.012, 0.009, -0.001, 0.0005, 0.0008]),
        (0.8, [0.8, 0.3, 0.2], [0.004, 0.005, 0.006, 0.0003, -0.0002, 0.0004]),
    ];
    let (q, v, a) = ([0.3, -0.5, 0.8, 1.1], [0.7, -1.2, 0.4, 2.0], [-0.4, 0.9, 3.0, -1.7]);
    // pin.rnea of Pinocchio 4.1.0, for the same arm with JointModelRevoluteUnaligned; forces and moments of its data.f,
    // in the frames of the joints, which have turned with the bodies.
    let torques = [0.5100432235584015, -11.271463484049534, 5.865749606420835, -0.1845078411636732];
    let forces = [
        [-0.8392773862206552, 5.024043280193802, 69.55019617992994],
        [18.18015566421266, 2.507629924875192, 36.432869955974475],
        [2.790057970373301, 14.550209080214154, 14.277665332472392],
        [-2.491384227839314, 4.313388321005873, 5.872855998860486],
    ];
    let moments = [
        [2.308711205337853, -16.55211474333175, 0.5100432235584015],
        [2.3555781305026793, -11.35961979621618, -0.6753132708361922],
        [7.560636119204133, -2.2839673489025527, 0.7933462126463886],
        [1.026892566965237, -0.34380076191837283, 0.6792373030028505],
    ];
    let mut draft = Draft::new("arm").times([0.0]);
    draft.gravity = Vec3::new(0.3, -1.1, -9.6);
    let mut before = "ground".to_owned();
    for (k, ((at, axis), (mass, centre, inertia))) in joints.into_iter().zip(bodies).enumerate() {
        let (body, joint) = (format!("link {k}"), format!("joint {k}"));
        draft = draft.body(body.as_str()).revolute(&joint, [before, body.clone()], at, axis);
        let law = format!("{} + {}*t + {}*t^2", q[k], v[k], 0.5 * a[k]);
        draft = draft.driver(format!("motor {k}"), joint.as_str(), Law::parse(&law).unwrap());
        draft.masses.push(rigid(&body, &body, centre, mass, inertia));
        before = body;
    }
    let model = Model::from_draft(&draft).unwrap_or_else(|f| panic!("{f:?}"));
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let loads = Analysis::with(&model, formulation).unwrap().loads(&[]);
        for k in 0..4 {
            let (joint, driver) = (loads.joints_at(0)[k], loads.drivers_at(0)[k]);
            assert!((driver.force - torques[k]).abs() < PRINTED * 12.0, "{k}: {}", driver.force);
            let [force, moment] = joint.in_body;
            assert!((force - forces[k].into()).norm() < PRINTED * 70.0, "{k}: {force:?}");
            assert!((moment - moments[k].into()).norm() < PRINTED * 17.0, "{k}: {moment:?}");
        }
    }
}

#[test]
fn driver_torques_of_a_balance_and_a_governor() {
    // A balance: equal arms, unequal weights, held by the driver with the difference of their moments.
    let mut draft = rotor("0*t").measure("hand", driver_force("motor"));
    draft.masses = vec![
        point_mass("left pan", "rotor", [-0.4, 0.0, 0.0], 2.0),
        point_mass("right pan", "rotor", [0.4, 0.0, 0.0], 3.0),
    ];
    draft.gravity = Vec3::new(0.0, -10.0, 0.0);
    let held = values(&run(&draft, Formulation::Relative), "hand");
    held.iter().for_each(|x| assert!((x - 10.0 * 0.4).abs() < 1e-13, "{x}"));

    // A conical pendulum, an arm of a flyball governor: at omega^2 = g / (l cos a) nothing has to hold its angle a.
    let (l, angle, g) = (0.3, 0.7_f64, 9.81);
    let omega = (g / (l * angle.cos())).sqrt();
    let mut draft = Draft::new("governor")
        .bodies(["spindle", "arm"])
        .revolute("spindle", ["ground", "spindle"], [0.0; 3], [0.0, 0.0, 1.0])
        .revolute("arm", ["spindle", "arm"], [0.0; 3], [0.0, 1.0, 0.0])
        .driver("speed", "spindle", Law::parse(&format!("{omega}*t")).unwrap())
        .driver("lift", "arm", Law::parse("0*t").unwrap())
        .measure("lift", driver_force("lift"))
        .measure("speed", driver_force("speed"))
        .times([0.0, 0.2, 0.5]);
    draft.gravity = Vec3::new(0.0, 0.0, -g);
    let ball = [l * angle.sin(), 0.0, -l * angle.cos()];
    draft.masses.push(point_mass("ball", "arm", ball, 1.5));
    let solution = run(&draft, Formulation::Relative);
    for name in ["lift", "speed"] {
        values(&solution, name).iter().for_each(|x| assert!(x.abs() < 1e-12 * 1.5 * g * l, "{name} {x}"));
    }
}

/// The single-cylinder engine of every textbook on machines (Shigley and Uicker, *Theory of Machines and Mechanisms*,
/// "Dynamics of reciprocating engines"): of a piston of mass m at x = r cos(theta) + l cos(phi), sin(phi) = (r/l)
/// sin(theta), the cylinder's wall takes `m x.. tan(phi)`, the rod `m x.. / cos(phi)`, and the crank needs
/// `-m x.. x tan(phi)`; exactly, with x.. not of a series.
#[test]
fn a_piston_pushes_its_wall_its_rod_and_its_crank_as_in_the_textbooks() {
    let (r, l, mass, speed) = (0.05, 0.18, 0.9, 120.0);
    let z = [0.0, 0.0, 1.0];
    let mut draft = Draft::new("engine")
        .hardpoint("O", [0.0, 0.0, 0.0])
        .hardpoint("A", [r, 0.0, 0.0])
        .hardpoint("B", [r + l, 0.0, 0.0])
        .bodies(["crank", "rod", "piston"])
        .revolute("main bearing", ["ground", "crank"], "O", z)
        .revolute("crank pin", ["crank", "rod"], "A", z)
        .revolute("wrist pin", ["rod", "piston"], "B", z)
        .translational("cylinder", ["ground", "piston"], "B", [1.0, 0.0, 0.0])
        .driver("shaft", "main bearing", Law::parse(&format!("{speed}*t")).unwrap())
        .times((1..8).map(|k| 0.007 * f64::from(k)))
        .measure("torque", driver_force("shaft"))
        .measure("wall", reaction("cylinder", ReactionPart::ForceAlong(1)))
        .measure("rod", reaction("wrist pin", ReactionPart::Radial))
        .measure("bearing", reaction("main bearing", ReactionPart::Radial));
    draft.masses.push(point_mass("piston", "piston", "B", mass));
    let solution = run(&draft, Formulation::Relative);
    for (k, t) in solution.motion.times.iter().enumerate() {
        let (sin, cos) = (speed * t).sin_cos();
        let (sin_phi, phi_rate) = (r / l * sin, r / l * cos * speed);
        let cos_phi = (1.0 - sin_phi * sin_phi).sqrt();
        let x = r * cos + l * cos_phi;
        // x' = -r s - l tan(phi) (sin phi)',  once more for x''
        let acceleration = -r * speed * speed * cos
            - l * (phi_rate * phi_rate / cos_phi.powi(3) - sin_phi * sin_phi / cos_phi * speed * speed);
        let (force, tan) = (mass * acceleration, sin_phi / cos_phi);
        let scale = mass * r * speed * speed;
        let expected = [
            // What the driver gives, and what the wall puts on the piston: theirs is what the crank takes from the gas.
            ("torque", -force * x * tan, scale * l),
            ("wall", force * tan, scale),
            ("rod", force.abs() / cos_phi, scale),
            ("bearing", force.abs() / cos_phi, scale),
        ];
        for (name, expected, scale) in expected {
            let found = values(&solution, name)[k];
            assert!((found - expected).abs() < 1e-12 * scale, "{name} at {t}: {found} {expected}");
        }
    }
}

/// A four-bar whose rocker is held back by a moment: its coupler, which has no mass, pulls along itself with M/(c
/// sin(gamma)), and the crank needs `M a sin(beta)/(c sin(gamma))`, with beta between coupler and crank and gamma the
/// transmission angle (Shigley and Uicker, "Mechanical advantage").
#[test]
fn a_four_bar_has_the_mechanical_advantage_of_the_textbooks() {
    let z = [0.0, 0.0, 1.0];
    let (moment, c) = (7.0, 0.30);
    let mut draft = Draft::new("four-bar")
        .hardpoint("O", [0.0, 0.0, 0.0])
        .hardpoint("A", [0.06, 0.08, 0.0])
        .hardpoint("B", [0.38, 0.30, 0.0])
        .hardpoint("C", [0.38, 0.0, 0.0])
        .bodies(["crank", "coupler", "rocker"])
        .revolute("O", ["ground", "crank"], "O", z)
        .revolute("A", ["crank", "coupler"], "A", z)
        .revolute("B", ["coupler", "rocker"], "B", z)
        .revolute("C", ["ground", "rocker"], "C", z)
        .driver("motor", "O", Law::parse("2*t").unwrap())
        .times((0..7).map(|k| 0.4 * f64::from(k)))
        .measure("torque", driver_force("motor"))
        .measure("coupler", reaction("A", ReactionPart::Radial));
    draft.forces.push(ElementDraft::new(
        "load",
        ElementKindDraft::BodyMoment {
            body: "rocker".into(),
            moment: moment.into(),
            about: Vec3::AXES[2],
            axes: None,
            law: None,
        },
    ));
    let model = Model::from_draft(&draft).unwrap();
    let solution = run(&draft, Formulation::Relative);
    let coupler = model.bodies.iter().position(|b| b.name == "coupler").unwrap();
    for k in 0..solution.motion.len() {
        let s = solution.motion.at(k).body(coupler);
        let turn = s.rotation * model.bodies[coupler].frame.rot.transpose();
        let at = |drawn: [f64; 3]| s.r + turn * (Vec3::from(drawn) - model.bodies[coupler].frame.r);
        let (a, b) = (at([0.06, 0.08, 0.0]), at([0.38, 0.30, 0.0]));
        let (along, rocker) = ((b - a).unit().unwrap(), b - Vec3::new(0.38, 0.0, 0.0));
        let [sin_beta, sin_gamma] = [a * (1.0 / a.norm()), rocker * (1.0 / c)].map(|v| v.cross(along).z);
        let expected = [
            ("torque", -moment * a.norm() * sin_beta / (c * sin_gamma)),
            ("coupler", (moment / (c * sin_gamma)).abs()),
        ];
        for (name, expected) in expected {
            let found = values(&solution, name)[k];
            assert!((found - expected).abs() < 1e-12 * moment / c, "{name} {k}: {found} {expected}");
        }
    }
}

/// Gradients of all loads of a draft, the adjoint way and the direct one, as a part of the largest of each load.
pub fn compare_both_ways(draft: &Draft, formulation: Formulation) -> usize {
    let model = Model::from_draft(draft).unwrap_or_else(|f| panic!("{f:?}"));
    let analysis = Analysis::with(&model, formulation).unwrap();
    let all = outputs(&model);
    let is_load =
        |m: &usize| matches!(all[*m].source, OutputSource::Measure(k) if model.measures[k].kind.is_load());
    let asked: Vec<usize> = (0..all.len()).filter(is_load).collect();
    let design: Vec<f64> = vec![0.0; model.variables.len()];
    let [direct, adjoint] =
        [GradientMethod::Direct, GradientMethod::Adjoint].map(|way| analysis.gradients(&design, &asked, way));
    assert_eq!([direct.method, adjoint.method], [GradientMethod::Direct, GradientMethod::Adjoint]);
    assert_eq!(direct.times, adjoint.times);
    let numbers = |g: &Gradients, m: usize| -> Vec<f64> {
        (0..g.times.len()).flat_map(|k| g.at(k, m).iter().map(|d| d[0]).collect::<Vec<_>>()).collect()
    };
    let largest = |x: &[f64]| x.iter().filter(|x| x.is_finite()).fold(0.0_f64, |most, x| most.max(x.abs()));
    let of_all = (0..asked.len()).fold(0.0_f64, |most, m| most.max(largest(&numbers(&direct, m))));
    let mut compared = 0;
    for m in 0..asked.len() {
        let (a, b) = (numbers(&direct, m), numbers(&adjoint, m));
        let scale = largest(&a).max(LITTLE * of_all);
        for (n, (a, b)) in a.iter().zip(&b).enumerate() {
            let what =
                format!("{} {formulation:?} {} {n}: {a} {b} of {scale}", draft.name, all[asked[m]].name);
            assert_eq!(a.is_nan(), b.is_nan(), "{what}");
            assert!(a.is_nan() || (a - b).abs() <= BOTH_WAYS * scale, "{what}");
            compared += usize::from(a.abs() > LITTLE * scale);
        }
    }
    compared
}

/// Change relative to the largest one below which it is round-off, like all loads of a planar mechanism across its
/// plane.
const LITTLE: f64 = 1e-3;
/// Two ways to the same gradient, as a part of the largest over the motion.
const BOTH_WAYS: f64 = 1e-10;

/// With a measure of every kind of load.
pub fn asking_for_all(mut draft: Draft) -> Draft {
    let model = Model::from_draft(&draft).unwrap();
    draft.measures.clear();
    draft.metrics.clear();
    let mut kinds: Vec<MeasureKindDraft> = Vec::new();
    for driver in &model.drivers {
        kinds.push(driver_force(&driver.name));
        kinds.push(MeasureKindDraft::DriverPower { driver: Some(driver.name.clone()) });
    }
    for joint in model.joints.iter().filter(|j| !j.unnamed) {
        let axes = [None, Some(Axes::Body), Some(Axes::Joint)];
        let parts = [ReactionPart::ForceAlong(1), ReactionPart::MomentAbout(0), ReactionPart::MomentAbout(2)];
        for (part, axes) in parts.into_iter().zip(axes) {
            kinds.push(MeasureKindDraft::Reaction { joint: joint.name.clone(), part, on: None, axes });
        }
        let on = Some(model.bodies[joint.bodies[0].0].name.clone());
        kinds.push(MeasureKindDraft::Reaction {
            joint: joint.name.clone(),
            part: ReactionPart::Force,
            on,
            axes: None,
        });
    }
    for element in model.elements.iter().filter(|e| e.kind.mass_on(&model).is_none()) {
        kinds.push(MeasureKindDraft::SpringForce { force: element.name.clone() });
    }
    kinds.push(MeasureKindDraft::KineticEnergy { body: None });
    kinds.push(MeasureKindDraft::ShakingForce { along: None });
    let last = model.bodies.last().unwrap();
    let about = on(&last.name, (last.frame.r + Vec3::new(0.1, 0.2, 0.3)).to_array());
    kinds.push(MeasureKindDraft::ShakingMoment { about, along: Some(Vec3::AXES[1]) });
    draft.measures =
        kinds.into_iter().enumerate().map(|(k, kind)| MeasureDraft::new(format!("load {k}"), kind)).collect();
    draft
}

/// [`press`] with friction in its hinges.
fn press_with_friction() -> Draft {
    let mut draft = press();
    for (joint, coefficient, radius) in [("A", 0.3, 0.03), ("B", 0.2, 0.06), ("C", 0.15, 0.02)] {
        draft.forces.push(friction(&format!("has friction at {joint}"), joint, coefficient, radius));
    }
    draft
}

#[test]
fn adjoint_gradients_of_loads_are_the_direct_ones() {
    let heavies = REFERENCES.map(heavy);
    // Every type of joint, and laws that change
    let all = crate::joints::mechanisms().into_iter().map(made_heavy);
    for draft in [press(), press_with_friction()].into_iter().chain(heavies).chain(all) {
        let mut draft = asking_for_all(draft);
        draft.times = draft.times.iter().copied().step_by(usize::max(draft.times.len() / 4, 1)).collect();
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            let compared = compare_both_ways(&draft, formulation);
            assert!(compared > 0, "{}", draft.name);
        }
    }
}

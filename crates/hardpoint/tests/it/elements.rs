//! Masses and forces, type by type: closed forms, the same said in two ways, sensitivities against re-solving.

use hardpoint::expression::Expression;
use hardpoint::joint::Quantity;
use hardpoint::law::Law;
use hardpoint::space::{Mat3, Pose, Vec3};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Solution};
use hardpoint::{draft::*, model::*};

use crate::loads::{
    asking_for_all, compare_both_ways, compare_with_solved, door, driver_force, friction, heavy, on,
    point_mass, press, rotor, run, values,
};
use crate::workbench::*;

/// Two ways to the same number agree to this part of the largest that is in it.
const SAME: f64 = 1e-11;

/// A draft with a parameter, a design variable of the same name.
fn with_parameter(mut draft: Draft, name: &str, value: f64) -> Draft {
    draft.parameters.push(ParameterDraft { name: name.into(), value, quantity: Quantity::Number });
    let change = ChangeDraft::Parameter { parameter: name.into(), rate: 1.0 };
    draft.variable(VariableDraft::new(name, [change]))
}

/// A number that an expression gives.
fn given(expression: &str) -> NumberDraft {
    NumberDraft { value: 0.0, expression: Some(Expression::parse(expression).unwrap()), per_unit: 1.0 }
}

fn same(a: &Solution, b: &Solution, names: &[&str]) {
    for name in names {
        let (x, y) = (values(a, name), values(b, name));
        let scale = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(scale > 0.0, "{name}");
        x.iter().zip(&y).for_each(|(x, y)| assert!((x - y).abs() < SAME * scale, "{name}: {x} {y}"));
    }
}

/// Gradients agree both ways in both formulations, and with re-solving.
fn differentiated(draft: &Draft, names: &[&str]) {
    compare_with_solved(draft, names);
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        assert!(compare_both_ways(draft, formulation) > 0, "{}", draft.name);
    }
}

const LOADS: [&str; 6] = ["torque", "power", "spring", "B", "guide", "shaking"];

/// The press with a spring of its own in the place of the other one.
fn press_with(spring: impl Fn(&mut ElementKindDraft)) -> Draft {
    let mut draft = press();
    let place = draft.forces.iter().position(|f| f.name == "spring").unwrap();
    spring(&mut draft.forces[place].kind);
    draft
}

/// Without what a linear spring has.
fn only_table(kind: &mut ElementKindDraft, table: Vec<[f64; 2]>, pushes: bool, free: Option<NumberDraft>) {
    let ElementKindDraft::Spring { stiffness, cubic, preload, compression, extension, free_length, .. } =
        kind
    else {
        unreachable!("the press has a spring")
    };
    (*stiffness, *cubic, *preload, *free_length) = (None, None, None, free);
    *if pushes { compression } else { extension } = Some(table.into_iter().map(Into::into).collect());
}

#[test]
fn a_table_on_a_line_is_a_stiffness_whichever_way_it_is_said() {
    let free = || Some(0.3.into());
    let plain = press_with(|kind| {
        let ElementKindDraft::Spring { stiffness, cubic, preload, free_length, .. } = kind else { return };
        (*stiffness, *cubic, *preload, *free_length) = (Some(2000.0.into()), None, None, free());
    });
    // Far too short a table: beyond it the line goes on.
    let points = [-0.01, 0.0, 0.02, 0.05].map(|x| [x, 2000.0 * x]).to_vec();
    for pushes in [false, true] {
        let tabled = press_with(|kind| only_table(kind, points.clone(), pushes, free()));
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            same(&run(&plain, formulation), &run(&tabled, formulation), &LOADS);
        }
    }
}

#[test]
fn a_progressive_spring_follows_its_free_length_and_its_scale() {
    let table = vec![[-0.02, -40.0], [0.0, 0.0], [0.06, 90.0], [0.11, 330.0], [0.2, 1500.0]];
    let draft = press_with(|kind| {
        only_table(kind, table.clone(), false, Some(given("free")));
        let ElementKindDraft::Spring { scale, .. } = kind else { return };
        *scale = Some(given("1 + harder"));
    });
    let draft = with_parameter(with_parameter(draft, "free", 0.2), "harder", 0.1);
    // Over the motion the spring is from 0.12 to 0.36 m long: within the table, and beyond it on either side.
    let solution = run(&draft, Formulation::Relative);
    let pulls = values(&solution, "spring");
    assert!(pulls.iter().any(|s| *s > 100.0) && pulls.iter().any(|s| *s < 100.0), "{pulls:?}");
    differentiated(&draft, &LOADS);
    // In compression, counted from the drawing.
    let draft = press_with(|kind| only_table(kind, table.clone(), true, None));
    differentiated(&draft, &LOADS);
}

#[test]
fn a_curve_about_a_joint_follows_its_factor_and_is_a_stiffness_on_a_line() {
    let with = |points: Vec<[f64; 2]>, k: f64, factor: NumberDraft| {
        let mut draft = press();
        for force in &mut draft.forces {
            if let ElementKindDraft::TorsionSpring { stiffness, curve, scale, .. } = &mut force.kind {
                (*stiffness, *curve, *scale) =
                    (k.into(), Some(points.iter().map(|p| (*p).into()).collect()), Some(factor.clone()));
            }
        }
        draft
    };
    // 1 + 2.5 * 0.8 is the stiffness of the press.
    let line = with(vec![[-0.1, -0.08], [0.0, 0.0], [0.3, 0.24]], 1.0, 2.5.into());
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        same(&run(&press(), formulation), &run(&line, formulation), &LOADS);
    }
    let points = vec![[-2.0, -9.0], [-0.6, -0.7], [0.2, 0.3], [1.0, 4.0], [3.0, 30.0]];
    let draft = with_parameter(with(points, 1.0, given("harder")), "harder", 0.9);
    differentiated(&draft, &LOADS);
}

/// Points of a table with forces by expressions.
fn points(of: &[(f64, &str)]) -> Option<Vec<TablePointDraft>> {
    Some(of.iter().map(|(at, force)| TablePointDraft { deflection: *at, force: given(force) }).collect())
}

#[test]
fn points_of_tables_follow_parameters() {
    let stretched = [(-0.02, "-soft"), (0.0, "0"), (0.06, "90"), (0.11, "90 + 2*hard"), (0.2, "12*hard")];
    let pushed: Vec<_> = stretched.iter().rev().map(|(at, force)| (-at, format!("-({force})"))).collect();
    let pushed: Vec<_> = pushed.iter().map(|(at, force)| (*at, force.as_str())).collect();
    let coiled = [(-2.0, "-9"), (-0.6, "-0.1*soft"), (0.2, "0.3"), (1.0, "4"), (3.0, "0.25*hard")];
    let with = |pushes: bool| {
        let mut draft = press();
        for force in &mut draft.forces {
            match &mut force.kind {
                kind @ ElementKindDraft::Spring { .. } => {
                    only_table(kind, Vec::new(), pushes, Some(0.2.into()));
                    let ElementKindDraft::Spring { compression, extension, .. } = kind else { continue };
                    *if pushes { compression } else { extension } =
                        points(if pushes { &pushed } else { &stretched });
                }
                ElementKindDraft::TorsionSpring { curve, .. } => *curve = points(&coiled),
                _ => {}
            }
        }
        with_parameter(with_parameter(draft, "soft", 40.0), "hard", 120.0)
    };
    let [pulls, pushes] = [false, true].map(with);
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        same(&run(&pulls, formulation), &run(&pushes, formulation), &LOADS);
    }
    for draft in [pulls, pushes] {
        differentiated(&draft, &LOADS);
    }
}

#[test]
fn a_point_of_a_spring_table_has_its_force() {
    // The lever's spring, 0.3 m long in the design configuration, becomes 0.05 m shorter: its force is that of the
    // table.
    let mut draft = Draft::new("bump stop")
        .body("piston")
        .translational("slide", ["ground", "piston"], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0])
        .driver("ram", "slide", Law::parse("t").unwrap())
        .measure("ram", driver_force("ram"))
        .times([0.0, 0.01, 0.03, 0.05, 0.06]);
    let table = vec![[-0.1, 0.0], [0.02, 0.0], [0.03, 200.0], [0.05, 1700.0]];
    draft.forces.push(ElementDraft::new(
        "stop",
        ElementKindDraft::Spring {
            from: on("piston", [0.0, 0.0, 0.0]),
            to: on("ground", [0.0, 0.0, 0.3]),
            stiffness: None,
            cubic: None,
            compression: Some(table.into_iter().map(Into::into).collect()),
            extension: None,
            scale: None,
            free_length: None,
            preload: None,
            damping: None,
        },
    ));
    let forces = values(&run(&draft, Formulation::Relative), "ram");
    for (force, expected) in forces.iter().zip([0.0, 0.0, 200.0, 1700.0]) {
        assert!((force - expected).abs() < SAME * 1700.0, "{forces:?}");
    }
    assert!(forces[4] > 1700.0);
}

#[test]
fn deflection_against_a_spring_table_follows_its_slope() {
    let (arm, k) = (0.5, 3e4);
    let give = |kind: ElementKindDraft| {
        let mut draft = rotor("0*t").point("tip", "rotor", [arm, 0.0, 0.0]);
        draft.forces.push(ElementDraft::new("spring", kind));
        let kind = MeasureKindDraft::Compliance {
            of: "tip.y".into(),
            at: Some(on("rotor", [arm, 0.0, 0.0])),
            wheel: None,
            force: None,
            along: Some([0.0, 1.0, 0.0].into()),
            released: Some("motor".into()),
        };
        values(&run(&draft.measure("give", kind), Formulation::Relative), "give")[0]
    };
    let spring = |table: Vec<[f64; 2]>| ElementKindDraft::Spring {
        from: on("ground", [0.2, -0.3, 0.0]),
        to: on("rotor", [0.2, 0.0, 0.0]),
        stiffness: Some((0.25 * k).into()),
        cubic: None,
        compression: Some(table.into_iter().map(Into::into).collect()),
        extension: None,
        scale: Some(1.5.into()),
        free_length: None,
        preload: None,
        damping: None,
    };
    // Symmetric about the drawing: the slope there is that of the chords beside it.
    let found =
        give(spring(vec![[-0.02, -2.0 * k], [-0.01, -0.005 * k], [0.01, 0.005 * k], [0.02, 2.0 * k]]));
    let h = 1e-6;
    let at = |x: f64| {
        let mut draft =
            rotor("0*t").measure("spring", MeasureKindDraft::SpringForce { force: "spring".into() });
        let table = vec![[-0.02, -2.0 * k], [-0.01, -0.005 * k], [0.01, 0.005 * k], [0.02, 2.0 * k]];
        let mut kind = spring(table);
        let ElementKindDraft::Spring { free_length, .. } = &mut kind else { unreachable!() };
        *free_length = Some((0.3 - x).into());
        draft.forces.push(ElementDraft::new("spring", kind));
        values(&run(&draft, Formulation::Relative), "spring")[0]
    };
    let slope = (at(h) - at(-h)) / (2.0 * h);
    // Central differences of a cubic piece: their error is the square of the step.
    let expected = (arm / 0.2_f64).powi(2) / slope;
    assert!((found - expected).abs() < 1e-6 * expected, "{found} {expected}");
}

/// Two points of 1 kg and 3 kg, 4 m apart along x: their centre is 3 m and 1 m away, `I = 1 * 3^2 + 3 * 1^2` about y
/// and z. The frame of the body has no effect.
#[test]
fn masses_of_a_body_add_up_about_their_common_centre() {
    let mut draft = rotor("t").point_mass("one", "rotor", [0.0, 2.0, 0.0], 1.0);
    draft = draft.point_mass("three", "rotor", [4.0, 2.0, 0.0], 3.0);
    let frame = Pose { rot: Mat3::about(Vec3::new(0.6, 0.0, 0.8), 0.7), r: Vec3::new(1.0, 2.0, 3.0) };
    draft.bodies[0].frame = FrameDraft::Pose(frame);
    let model = Model::from_draft(&draft).unwrap();
    let masses = hardpoint::load::body_masses(&model);
    assert!(masses[0].is_none());
    let found = masses[1].unwrap();
    assert!((found.mass - 4.0).abs() < SAME);
    assert!((found.centre - Vec3::new(3.0, 2.0, 0.0)).norm() < SAME);
    let expected = [Vec3::ZERO, Vec3::new(0.0, 12.0, 0.0), Vec3::new(0.0, 0.0, 12.0)];
    for (a, b) in found.inertia.cols.iter().zip(expected) {
        assert!((*a - b).norm() < SAME * 12.0, "{found:?}");
    }
}

/// Moments of inertia of a body about its centre, and about another point.
#[test]
fn moments_about_another_point_are_those_of_the_parallel_axis_theorem() {
    let (mass, way) = (3.0, Vec3::new(0.1, -0.2, 0.15));
    let inertia = [0.5, 0.6, 0.45, 0.05, -0.02, 0.03];
    let moved = {
        let Vec3 { x, y, z } = way;
        let more = [y * y + z * z, z * z + x * x, x * x + y * y, x * y, y * z, z * x];
        std::array::from_fn(|k| inertia[k] + mass * more[k])
    };
    let draft = |inertia: [f64; 6], about: Option<[f64; 3]>| {
        let mut draft = heavy("macpherson");
        let body = draft.bodies.last().unwrap().name.clone();
        draft = draft.hardpoint("C", [0.3, 0.6, 0.1]).variable_moving("centre", "C", [0.3, 1.0, -0.5]);
        let [ixx, iyy, izz, ixy, iyz, izx] = inertia.map(|i| Some(i.into()));
        let about = about.map(|at| on(&body, at));
        let (centre, mass) = (on(&body, "C"), mass.into());
        let kind = ElementKindDraft::Rigid { centre, mass, ixx, iyy, izz, ixy, iyz, izx, about };
        draft.masses.push(ElementDraft::new("tumbles", kind));
        draft
    };
    let about = (Vec3::new(0.3, 0.6, 0.1) - way).to_array();
    let [a, b] = [draft(inertia, None), draft(moved, Some(about))].map(asking_for_all);
    let [x, y] = [&a, &b].map(|draft| run(draft, Formulation::Relative));
    for measure in &a.measures {
        let (x, y) = (values(&x, &measure.name), values(&y, &measure.name));
        let scale = x.iter().filter(|x| x.is_finite()).fold(0.0_f64, |most, x| most.max(x.abs()));
        for (x, y) in x.iter().zip(&y).filter(|(x, _)| x.is_finite()) {
            assert!((x - y).abs() <= SAME * scale.max(1.0), "{}: {x} {y}", measure.name);
        }
    }
    // Of a centre that moves: the moments about the point stay.
    let mut few = b;
    few.times.truncate(3);
    few.measures.truncate(2);
    differentiated(&few, &["load 0"]);
    // In a plane the one that counts is enough.
    let turned = |izz: f64, about: Option<PointRef>| {
        let mut draft = rotor("2*t^2").measure("motor", driver_force("motor"));
        let (centre, mass) = (on("rotor", [0.4, 0.0, 0.0]), 2.0.into());
        let (ixx, iyy, izz, ixy, iyz, izx) = (None, None, Some(izz.into()), None, None, None);
        let kind = ElementKindDraft::Rigid { centre, mass, ixx, iyy, izz, ixy, iyz, izx, about };
        draft.masses.push(ElementDraft::new("arm", kind));
        values(&run(&draft, Formulation::Relative), "motor")
    };
    let expected = (0.1 + 2.0 * 0.4 * 0.4) * 4.0;
    for torque in turned(0.1, None).into_iter().chain(turned(0.1 + 2.0 * 0.16, Some(on("rotor", [0.0; 3])))) {
        assert!((torque - expected).abs() < SAME * expected, "{torque} {expected}");
    }
}

/// The corners and triangles of a box.
fn box_of(centre: Vec3, [x, y, z]: [f64; 3]) -> Solid {
    let corners: Vec<Vec3> = (0..8)
        .map(|k| {
            let side = |bit: u32, size: f64| if k & bit == 0 { -0.5 * size } else { 0.5 * size };
            centre + Vec3::new(side(1, x), side(2, y), side(4, z))
        })
        .collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> =
        faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Solid::of(&corners, &triangles).unwrap()
}

#[test]
fn a_box_mesh_has_the_mass_properties_of_a_block() {
    let draft = |kind: fn(&str, Vec3, Pose) -> ElementKindDraft| {
        let mut draft = heavy("macpherson");
        let frame = Pose { rot: Mat3::IDENTITY, r: Vec3::new(0.1, 0.3, 0.2) };
        // A frame that is turned: the mesh may count in it.
        let turned = Pose { rot: Mat3 { cols: [Vec3::AXES[1], Vec3::AXES[2], Vec3::AXES[0]] }, ..frame };
        let body = draft.bodies.last_mut().unwrap();
        body.frame = FrameDraft::Pose(turned);
        let kind = kind(&body.name.clone(), Vec3::new(0.25, 0.5, 0.2), turned);
        draft.masses.push(ElementDraft::new("box", kind));
        asking_for_all(draft)
    };
    let block = draft(|body, centre, _| {
        let [x, y, z] = [0.1, 0.2, 0.3].map(NumberDraft::from);
        ElementKindDraft::Block { centre: on(body, centre.to_array()), x, y, z, density: 700.0.into() }
    });
    let world = draft(|body, centre, _| {
        let mesh = box_of(centre, [0.1, 0.2, 0.3]);
        ElementKindDraft::Mesh { body: body.into(), mesh, density: 700.0.into() }
    });
    let own = draft(|body, centre, frame| {
        // Global x, y, z are the frame's z, x, y.
        let mesh = Solid { in_body: true, ..box_of(frame.inverse().point(centre), [0.2, 0.3, 0.1]) };
        ElementKindDraft::Mesh { body: body.into(), mesh, density: 700.0.into() }
    });
    let solutions = [&block, &world, &own].map(|draft| run(draft, Formulation::Relative));
    let mut compared = 0;
    for measure in &block.measures {
        let [x, y, z] = solutions.each_ref().map(|s| values(s, &measure.name));
        let scale = x.iter().filter(|x| x.is_finite()).fold(0.0_f64, |most, x| most.max(x.abs()));
        for k in (0..x.len()).filter(|k| x[*k].is_finite()) {
            let most = (x[k] - y[k]).abs().max((x[k] - z[k]).abs());
            assert!(most <= SAME * scale.max(1.0), "{} {} {} {}", measure.name, x[k], y[k], z[k]);
            compared += 1;
        }
    }
    assert!(compared > 0);
    let mass = [&block, &world].map(|draft| Model::from_draft(draft).unwrap().mass());
    assert!((mass[0] - mass[1]).abs() < SAME * mass[0]);
}

/// The strut with a wheel on its knuckle, toed in and leaning, and nothing else that pushes.
fn strut_on_its_wheel(push: [Option<NumberDraft>; 3]) -> Draft {
    let mut draft = heavy("macpherson");
    draft.masses.clear();
    draft.gravity = Vec3::ZERO;
    draft =
        draft.hardpoint("wheel", [0.01, 0.75, 0.02]).variable_moving("wheel out", "wheel", [0.2, 1.0, 0.3]);
    draft.wheels.push(WheelDraft {
        name: "fl".into(),
        body: "knuckle".into(),
        centre: "wheel".into(),
        spin: WheelSpinDraft::Axis(DirectionDraft::from([0.05, 1.0, -0.08])),
        radius: 0.31,
        side: None,
        kingpin: None,
        bump: draft.drivers.first().map(|d| d.name.clone()),
        steer: None,
        planes: None,
        spring: None,
        end: None,
        drive: None,
        brakes: None,
    });
    let [outboard, forward, up] = push;
    let (at, about_up) = (None, None);
    let kind =
        ElementKindDraft::WheelForce { wheel: "fl".into(), at, outboard, forward, up, about_up, law: None };
    draft.forces.push(ElementDraft::new("road", kind));
    for what in [WheelMeasure::ContactX, WheelMeasure::ContactY, WheelMeasure::ContactZ, WheelMeasure::Toe] {
        draft = draft.measure(what.name(), MeasureKindDraft::Wheel { wheel: "fl".into(), what });
    }
    draft
}

#[test]
fn the_road_does_work_on_the_contact_point_of_the_wheel() {
    let [outboard, forward, up] = [-1500.0, 700.0, 4000.0];
    let draft = strut_on_its_wheel([outboard, forward, up].map(|x| Some(x.into())));
    let mut draft = draft.measure("road", MeasureKindDraft::SpringForce { force: "road".into() });
    for driver in draft.drivers.clone() {
        let power = MeasureKindDraft::DriverPower { driver: Some(driver.name.clone()) };
        draft = draft.measure(format!("power of {}", driver.name), power);
    }
    let model = Model::from_draft(&draft).unwrap();
    let knuckle = model.bodies.iter().position(|b| b.name == "knuckle").unwrap();
    let solution = run(&draft, Formulation::Relative);
    let mut worked = 0.0_f64;
    for k in 0..solution.motion.len() {
        let of = |name: &str| values(&solution, name)[k];
        let contact = Vec3::new(of("contact_x"), of("contact_y"), of("contact_z"));
        // Of a left wheel: toe is atan2(e_x, e_y), outboard (sin, cos, 0), forward (cos, -sin, 0).
        let (sin, cos) = of("toe").sin_cos();
        let push = Vec3::new(sin, cos, 0.0) * outboard + Vec3::new(cos, -sin, 0.0) * forward;
        let push = push + Vec3::AXES[2] * up;
        let s = solution.motion.at(k).body(knuckle);
        let velocity = s.v + s.omega.cross(contact - s.r);
        let given: f64 = draft.drivers.iter().map(|d| of(&format!("power of {}", d.name))).sum();
        assert!((given + push.dot(velocity)).abs() < 1e-10 * 4000.0 * velocity.norm().max(1e-3), "{k}");
        assert!((of("road") - push.norm()).abs() < SAME * push.norm());
        worked = worked.max(given.abs());
    }
    assert!(worked > 1.0);
}

#[test]
fn loads_of_the_road_follow_the_wheel_and_its_forces() {
    let draft = strut_on_its_wheel([Some(given("0 - side")), None, Some(4000.0.into())]);
    let mut draft = asking_for_all(with_parameter(draft, "side", 1500.0));
    draft.times = draft.times.iter().copied().step_by(usize::max(draft.times.len() / 3, 1)).collect();
    let names: Vec<String> = draft.measures.iter().map(|m| m.name.clone()).take(4).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    differentiated(&draft, &names);
}

#[test]
fn a_wheel_is_compliant_like_its_point_of_the_knuckle() {
    let (mut draft, _) = crate::loads::soft("macpherson");
    let wheel = strut_on_its_wheel([None, None, Some(1.0.into())]);
    draft.wheels = wheel.wheels;
    draft =
        draft.hardpoint("wheel", [0.01, 0.75, 0.02]).variable_moving("wheel out", "wheel", [0.2, 1.0, 0.3]);
    for what in [WheelMeasure::ContactX, WheelMeasure::ContactY, WheelMeasure::ContactZ, WheelMeasure::Toe] {
        draft = draft.measure(what.name(), MeasureKindDraft::Wheel { wheel: "fl".into(), what });
    }
    let give = |at: Option<PointRef>, wheel: Option<String>| MeasureKindDraft::Compliance {
        of: "toe".into(),
        at,
        wheel,
        force: None,
        along: Some([0.0, 1.0, 0.0].into()),
        released: None,
    };
    draft = draft.measure("gives", give(None, Some("fl".into())));
    let solution = run(&draft, Formulation::Relative);
    let last = solution.motion.len() - 1;
    // The same point, where it was in the drawing, at one output time.
    let of = |name: &str| values(&solution, name)[last];
    let model = Model::from_draft(&draft).unwrap();
    let knuckle = model.bodies.iter().position(|b| b.name == "knuckle").unwrap();
    let s = solution.motion.at(last).body(knuckle);
    let contact = Vec3::new(of("contact_x"), of("contact_y"), of("contact_z"));
    let drawn = model.bodies[knuckle].frame.point(s.rotation.transpose() * (contact - s.r));
    let fixed = draft.clone().measure("fixed", give(Some(on("knuckle", drawn.to_array())), None));
    let fixed = values(&run(&fixed, Formulation::Relative), "fixed")[last];
    assert!(
        of("gives").abs() > 0.0 && (of("gives") - fixed).abs() < SAME * fixed.abs(),
        "{} {fixed}",
        of("gives")
    );
    compare_with_solved(&draft, &["gives"]);
}

fn slide_friction(joint: &str, coefficient: f64, length: Option<f64>, viscous: Option<f64>) -> ElementDraft {
    let kind = ElementKindDraft::SlideFriction {
        joint: joint.into(),
        coefficient: coefficient.into(),
        length: length.map(NumberDraft::from),
        ignored_direction: None,
        viscous: viscous.map(NumberDraft::from),
        transition_velocity: None,
    };
    ElementDraft::new(format!("has friction at {joint}"), kind)
}

/// A block that slides along x at a steady speed, pushed down off its guide's middle.
fn sledge(length: Option<f64>, viscous: Option<f64>) -> Draft {
    let mut draft = Draft::new("sledge")
        .body("block")
        .translational("slide", ["ground", "block"], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0])
        .driver("rope", "slide", Law::parse("0.5*t").unwrap())
        .measure("rope", driver_force("rope"))
        .times([0.0, 1.0]);
    // Down at 0.3 m behind the middle, and aside at 0.1 m before it.
    draft.masses.push(point_mass("load", "block", [-0.3, 0.0, 0.0], 10.0));
    draft.masses.push(point_mass("other", "block", [0.1, 0.0, 0.0], 5.0));
    draft.gravity = Vec3::new(0.0, 0.0, -10.0);
    draft.forces.push(slide_friction("slide", 0.2, length, viscous));
    draft
}

/// Relative deviation from full friction: the transition velocity of slides is 1 mm/s, the speed half a metre per
/// second.
const WHOLE: f64 = 1e-5;

#[test]
fn friction_of_a_slide_follows_the_normal_forces_of_its_guide() {
    // 150 N down; its moment about the middle is 100 * 0.3 - 50 * 0.1 = 25 N m.
    let normal = |length: f64| (75.0 + 25.0 / length).abs() + (75.0 - 25.0 / length).abs();
    let cases = [
        (None, None, 0.2 * 150.0),
        // The normal forces of both ends have the same direction: their sum is the weight.
        (Some(0.5), None, 0.2 * 150.0),
        // The guide is so short that the couple lifts one end.
        (Some(0.2), None, 0.2 * normal(0.2)),
        (None, Some(8.0), 0.2 * 150.0 + 8.0 * 0.5),
    ];
    assert!((normal(0.2) - 250.0).abs() < 1e-12);
    for (length, viscous, expected) in cases {
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            for pull in values(&run(&sledge(length, viscous), formulation), "rope") {
                assert!(
                    (pull - expected).abs() < WHOLE * expected,
                    "{length:?} {viscous:?}: {pull} {expected}"
                );
            }
        }
    }
}

#[test]
fn friction_of_a_ball_joint_follows_its_load_and_radius() {
    let mut draft = Draft::new("top")
        .body("top")
        .spherical("ball", ["ground", "top"], [0.0, 0.0, 0.0])
        .joint(joint("upright", "parallel", ["ground", "top"], &[], Some([0.0, 0.0, 1.0])))
        .joint(joint("spins", "heading", ["ground", "top"], &[], Some([0.0, 0.0, 1.0])))
        .driver("motor", "spins", Law::parse("9*t").unwrap())
        .measure("motor", driver_force("motor"))
        .measure("friction", MeasureKindDraft::SpringForce { force: "ball".into() })
        .times([0.0, 0.7]);
    draft.masses.push(point_mass("disc", "top", [0.0, 0.0, 0.4], 12.0));
    draft.gravity = Vec3::new(0.0, 0.0, -10.0);
    let mut ball = friction("ball", "ball", 0.1, 0.015);
    let ElementKindDraft::Friction { viscous, .. } = &mut ball.kind else { unreachable!() };
    *viscous = Some(0.003.into());
    draft.forces.push(ball);
    let expected = 0.1 * 0.015 * 120.0 + 0.003 * 9.0;
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let solution = run(&draft, formulation);
        for (torque, friction) in values(&solution, "motor").into_iter().zip(values(&solution, "friction")) {
            assert!((torque - expected).abs() < WHOLE * expected, "{torque} {expected}");
            assert!((friction + expected).abs() < WHOLE * expected, "{friction} {expected}");
        }
    }
}

#[test]
fn friction_of_all_kinds_follows_the_design() {
    // A strut whose balls, slide and hinges rub together.
    let mut draft = heavy("macpherson");
    let model = Model::from_draft(&draft).unwrap();
    let mut kinds = Vec::new();
    for joint in &model.joints {
        let mut element = match joint.kind.name {
            "revolute" | "spherical" => {
                friction(&format!("has friction at {}", joint.name), &joint.name, 0.15, 0.02)
            }
            "cylindrical" | "translational" => slide_friction(&joint.name, 0.1, Some(0.2), Some(30.0)),
            _ => continue,
        };
        if let ElementKindDraft::Friction { length, viscous, .. } = &mut element.kind {
            *length = (joint.kind.name == "revolute").then(|| 0.3.into());
            *viscous = Some(0.5.into());
        }
        kinds.push(joint.kind.name);
        draft.forces.push(element);
    }
    assert!(kinds.contains(&"spherical") && kinds.contains(&"revolute"), "{kinds:?}");
    let mut draft = asking_for_all(draft);
    draft.times = draft.times.iter().copied().step_by(usize::max(draft.times.len() / 3, 1)).collect();
    let solution = run(&draft, Formulation::Relative);
    let known = |name: &&str| values(&solution, name).iter().all(|x| x.is_finite());
    let names: Vec<String> = draft.measures.iter().map(|m| m.name.clone()).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).filter(known).collect();
    assert!(names.len() > 10, "{names:?}");
    differentiated(&draft, &names[..6]);
    // And the guide of a press, pressed at its ends: in the plane, as its constraints out of it are redundant.
    let mut press = press();
    press.forces.push(friction("has friction at B", "B", 0.2, 0.04));
    press.forces.push(slide_friction("guide", 0.1, Some(0.3), Some(20.0)));
    let open = Model::from_draft(&press).unwrap();
    let shared = Analysis::new(&open).unwrap().loads(&[]).shared_friction;
    assert_eq!(shared, [open.element("has friction at guide").unwrap()]);
    let ElementKindDraft::SlideFriction { ignored_direction, transition_velocity, .. } =
        &mut press.forces.last_mut().unwrap().kind
    else {
        unreachable!()
    };
    // Near its dead centre the ram is as slow as friction goes smoothly to zero; differences see only what goes more
    // slowly.
    (*ignored_direction, *transition_velocity) = (Some(Vec3::AXES[2]), Some(0.2.into()));
    differentiated(&press, &["torque", "guide", "B"]);
}

#[test]
fn undetermined_normal_forces_are_reported() {
    // A door in two hinges: the force across either is shared with the moment of the other.
    let leaf = point_mass("leaf", "door", [0.5, 0.0, 1.0], 20.0);
    let mut draft = door(leaf).measure("hand", driver_force("hand"));
    draft.forces.push(friction("squeaks", "upper", 0.1, 0.01));
    let model = Model::from_draft(&draft).unwrap();
    let analysis = Analysis::new(&model).unwrap();
    assert!(values(&analysis.run(), "hand").iter().all(|x| x.is_nan()));
    assert_eq!(analysis.loads(&[]).shared_friction, [model.element("squeaks").unwrap()]);
}

#[test]
fn axes_of_a_bushing_follow_their_hardpoints() {
    let mut draft = press().bushing(
        "rubber",
        ["rod", "ground"],
        [[0.1, 0.02, 0.01], [0.11, 0.02, 0.0]],
        [2000.0, 5000.0, 800.0],
    );
    let Some(ElementDraft {
        kind: ElementKindDraft::Bushing { axis, axis2, about_x, preload_y, .. }, ..
    }) = draft.forces.last_mut()
    else {
        unreachable!("it was added last")
    };
    *axis = Some(DirectionDraft::Through("B".into(), "C".into()));
    *axis2 = Some(DirectionDraft::Along([0.2, 0.1, 1.0].into()));
    (*about_x, *preload_y) = (Some(20.0.into()), Some(30.0.into()));
    differentiated(&draft, &LOADS);
}

#[test]
fn the_builder_adds_every_type_of_mass_and_force() {
    let no_wheel_forces = [0.0; 3].map(|f: f64| Some(f.into()));
    let mut draft = strut_on_its_wheel(no_wheel_forces);
    draft.forces.clear();
    let solid = box_of(Vec3::new(0.2, 0.5, 0.1), [0.1, 0.2, 0.3]);
    let [a, b] = [[0.1, 0.5, 0.3], [0.2, 0.6, 0.4]];
    let draft = draft
        .bodies(["arm", "block"])
        .revolute("pin", ["ground", "arm"], a, [1.0, 0.0, 0.0])
        .translational("slide", ["ground", "block"], b, [0.0, 0.0, 1.0])
        .driver("turn", "pin", Law::constant(0.0))
        .driver("move", "slide", Law::constant(0.0))
        .point_mass("point mass", "arm", a, 2.0)
        .rigid("rigid", "arm", b, 2.0, [0.1, 0.2, 0.15])
        .bar("bar", "arm", [a, b], 0.02, 7850.0)
        .block("block", "block", b, [0.1, 0.2, 0.3], 2700.0)
        .mesh("mesh", "arm", solid, 1000.0)
        .spring("spring", ["ground", "arm"], [a, b], 1e4)
        .joint_spring("joint spring", "slide", 1e4)
        .torsion_spring("torsion spring", "pin", 10.0)
        .friction("friction", "pin", 0.1, 0.01)
        .slide_friction("slide friction", "slide", 0.1)
        .force("force", "block", b, 100.0, [0.0, 1.0, 0.0])
        .moment("moment", "arm", 5.0, [1.0, 0.0, 0.0])
        .wheel_force("road", "fl", [100.0, 200.0, 4000.0])
        .tyre("tyre", "fl", 2e5)
        .bushing("bushing", ["arm", "block"], [a, b], [1e5, 2e5, 3e5])
        .elastic_joint("elastic", "pin", [1e6, 1e6, 3e6]);
    let model = Model::from_draft(&draft).unwrap();
    for kind in ElementType::ALL {
        let element = model.elements.iter().find(|e| e.kind.type_name() == kind.name);
        let element = element.unwrap_or_else(|| panic!("the builder has no method for `{}`", kind.name));
        assert_eq!(element.kind.has_mass(), kind.table == "masses");
        assert_eq!(element.kind.force(&model).is_none(), element.kind.mass_on(&model).is_some());
    }
    let block = model.element("block").unwrap();
    let mass = Model { elements: vec![model.elements[block.0].clone()], ..model.clone() }.mass();
    assert!((mass - 0.1 * 0.2 * 0.3 * 2700.0).abs() < SAME * mass, "{mass}");
    let road = model.element("road").unwrap();
    assert_eq!(model.elements[road.0].kind.given_force(&model), 4000.0);
}

//! Parameters and formulas: positions, lengths and laws that follow the design by expressions.

use std::ops::ControlFlow;

use hardpoint::joint::Quantity;
use hardpoint::sensitivity::Admissibility;
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run};
use hardpoint::{design::DesignVelocity, draft::*, model::*};
use hardpoint::{expression::Expression, law::Law};
use hardpoint_study::verify::{self, verify};

use crate::workbench::*;

fn formula(of: FormulaOf, text: &str) -> FormulaDraft {
    FormulaDraft { of, expression: Expression::parse(text).unwrap() }
}

fn coordinates(hardpoint: &str, texts: [&str; 3]) -> Vec<FormulaDraft> {
    (0..3).map(|axis| formula(FormulaOf::Coordinate(hardpoint.into(), axis), texts[axis])).collect()
}

fn parameter(draft: &mut Draft, name: &str, value: f64, quantity: Quantity) {
    draft.parameters.push(ParameterDraft { name: name.into(), value, quantity });
    draft
        .design
        .push(VariableDraft::new(name, [ChangeDraft::Parameter { parameter: name.into(), rate: 1.0 }]));
}

/// A crank-rocker with a rod as coupler, given by its lengths and angles; a point of the rocker is written as an
/// expression, the rod may have a length of its own, and the law names a parameter. Everything depends on something in
/// a nonlinear way.
fn crank_rocker(own_length: bool) -> Draft {
    let law = Law::parse_with("swing*sin(2*t)", &[("swing", 0.5)]).unwrap();
    let mut draft = Draft { times: times(1.0, 8), ..Draft::default() };
    for name in ["A", "B", "C", "D"] {
        draft.hardpoints.push(HardpointDraft::new(name, Vec3::ZERO));
    }
    for (name, value, quantity) in [
        ("ground", 0.4, Quantity::Length),
        ("crank", 0.1, Quantity::Length),
        ("rocker", 0.3, Quantity::Length),
        ("phi", 1.1, Quantity::Angle),
        ("psi", 1.9, Quantity::Angle),
        ("stretch", 0.9, Quantity::Number),
        ("swing", 0.5, Quantity::Number),
    ] {
        parameter(&mut draft, name, value, quantity);
    }
    draft.parameters.push(ParameterDraft { name: "reach".into(), value: 0.0, quantity: Quantity::Length });
    draft.formulas.push(formula(FormulaOf::Parameter("reach".into()), "rocker*sqrt(stretch)"));
    draft
        .formulas
        .extend(coordinates("C", ["D.x + reach*cos(psi)", "D.y + reach*sin(psi)", "exp(stretch)/100"]));
    draft.formulas.extend(coordinates("B", ["crank*cos(phi)", "crank*sin(phi)", "0"]));
    draft.formulas.push(formula(FormulaOf::Coordinate("D".into(), 0), "A.x + hypot(ground, 0.1)"));
    draft.formulas.push(formula(FormulaOf::Law("motor".into(), "swing".into()), "swing^3 + 0.375"));
    draft.bodies = ["crank", "rocker"].map(BodyDraft::new).into();
    draft.joints = vec![
        JointDraft::new("bearing", "revolute", ["ground", "crank"]).at("A").axis(Vec3::AXES[2]),
        JointDraft::new("pivot", "revolute", ["ground", "rocker"]).at("D").axis(Vec3::AXES[2]),
        JointDraft::new("rod", "rod", ["crank", "rocker"]).at("B").at("C"),
    ];
    if own_length {
        draft.joints[2].length = Some(1.0);
        draft.formulas.push(formula(FormulaOf::Length("rod".into()), "1.01*hypot(C.x - B.x, C.y - B.y)"));
    }
    draft.drivers.push(DriverDraft::new("motor", "bearing", law));
    let place =
        ["C.x/2", "0.02*tanh(stretch)", "max(0.01, C.z)"].map(|text| Expression::parse(text).unwrap());
    draft.points.push(PointDraft::new("P", "rocker", LocationDraft::Formula(Box::new(place))));
    draft.measures.push(MeasureDraft::new("angle", "pivot"));
    // A hardpoint that formulas use may be moved as well.
    draft.design.push(VariableDraft::moving("A_x", "A", Vec3::AXES[0]));
    draft
}

#[test]
fn formulas_result_in_the_positions_of_their_expressions() {
    let model = Model::from_draft(&crank_rocker(false)).unwrap_or_else(|f| panic!("{f:?}"));
    let at = |name: &str| model.hardpoints.iter().find(|h| h.name == name).unwrap().position;
    let d = 0.17_f64.sqrt();
    let reach = 0.3 * 0.9_f64.sqrt();
    let c = Vec3::new(d + reach * 1.9_f64.cos(), reach * 1.9_f64.sin(), 0.9_f64.exp() / 100.0);
    for (found, expected) in [
        (at("B"), Vec3::new(0.1 * 1.1_f64.cos(), 0.1 * 1.1_f64.sin(), 0.0)),
        (at("C"), c),
        (at("D"), Vec3::new(d, 0.0, 0.0)),
        (at("P"), Vec3::new(c.x / 2.0, 0.02 * 0.9_f64.tanh(), c.z)),
    ] {
        assert!((found - expected).norm() < 1e-15, "{found:?} {expected:?}");
    }
    assert_eq!(model.drivers[0].law.parameters()[0].value, 0.5);
    assert_eq!(model.parameters[model.parameter("reach").unwrap().0].value, reach);
}

#[test]
fn fields_of_formulas_are_the_derivatives_of_the_geometry_at_every_design() {
    for own_length in [false, true] {
        let model = Model::from_draft(&crank_rocker(own_length)).unwrap();
        let n = model.variables.len();
        let moved: Vec<f64> = (0..n).map(|k| [0.01, -0.02, 0.015, 0.3, -0.2, 0.1, 0.2, 0.03][k]).collect();
        for base in [vec![0.0; n], moved] {
            let fields = model.fields(&base);
            for (v, field) in fields.iter().enumerate() {
                let name = &model.variables[v].name;
                let error = |h: f64| {
                    let at = |b: f64| {
                        let mut design = base.clone();
                        design[v] += b;
                        (model.geometry(&design), model.laws(&design)[0].parameters()[0].value)
                    };
                    let (p, m) = (at(h), at(-h));
                    let mut worst = 0.0_f64;
                    for j in 0..model.joints.len() {
                        for end in 0..2 {
                            let (a, b) = (p.0.markers[j][end], m.0.markers[j][end]);
                            let nominal = model.geometry(&base).markers[j][end];
                            let twist = field.twist_of(JointId(j), end);
                            let speed = twist.map_or(Vec3::ZERO, |t| t.at(nominal.r));
                            worst = worst.max(((a.r - b.r) * (0.5 / h) - speed).norm());
                        }
                        let rate = field.kept_rate(JointId(j)).unwrap_or_default().distance;
                        let found = (p.0.kept[j].distance - m.0.kept[j].distance) / (2.0 * h);
                        worst = worst.max((found - rate).abs());
                    }
                    let point = field.points.first().map_or(Vec3::ZERO, |p| p.1);
                    worst = worst.max(((p.0.points[0] - m.0.points[0]) * (0.5 / h) - point).norm());
                    let law: f64 = field.laws.iter().map(|l| l.2).sum();
                    worst.max(((p.1 - m.1) / (2.0 * h) - law).abs())
                };
                assert_ne!(*field, DesignVelocity::default(), "{name}: no field");
                let (coarse, fine, best) = (error(2e-2), error(1e-2), error(1e-6));
                assert!(best < 1e-8, "{name} at {base:?}: {best:e}");
                assert!(
                    coarse < 1e-11 || (3.5..4.5).contains(&(coarse / fine)),
                    "{name}: {coarse:e} {fine:e}"
                );
            }
        }
    }
}

#[test]
fn sensitivities_by_nonlinear_parameters_match_designs_that_are_solved_anew() {
    for own_length in [false, true] {
        let model = Model::from_draft(&crank_rocker(own_length)).unwrap();
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            let analysis = Analysis::with(&model, formulation).unwrap();
            let solution = analysis.run();
            assert!(solution.stop.is_none(), "{:?}", solution.stop);
            for (v, a) in model.variables.iter().zip(&solution.sensitivities.admissibility) {
                assert!(!matches!(a, Admissibility::CannotFollow { .. }), "{}", v.name);
            }
            let checks =
                verify(&analysis, &solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
            assert!(checks.passed(), "{:?}", checks.checks);
        }
    }
}

#[test]
fn designs_side_by_side_are_those_one_by_one() {
    let model = Model::from_draft(&crank_rocker(true)).unwrap();
    let analysis = Analysis::new(&model).unwrap();
    let design = |k: usize| (0..model.variables.len()).map(|v| 1e-3 * (v + k) as f64).collect::<Vec<f64>>();
    let designs: Vec<_> = (0..8).map(design).collect();
    let together = designs_of(&analysis, &designs);
    for (k, (design, together)) in designs.iter().zip(&together).enumerate() {
        let alone = analysis.solve(Run::new().at(design).without_sensitivities());
        let angle = alone.measured.index("angle").unwrap();
        for step in 0..alone.motion.len() {
            let (a, b) = (alone.measured.value(step, angle)[0], together.measured.value(step, angle)[0]);
            assert!((a - b).abs() < 1e-13, "design {k}, step {step}: {a} {b}");
        }
    }
}

#[test]
fn parameters_without_effect_are_distinguished() {
    let mut draft = crank_rocker(false);
    parameter(&mut draft, "nothing", 1.0, Quantity::Number);
    parameter(&mut draft, "dead_end", 1.0, Quantity::Number);
    draft.parameters.push(ParameterDraft { name: "twice".into(), value: 0.0, quantity: Quantity::Number });
    draft.formulas.push(formula(FormulaOf::Parameter("twice".into()), "2*dead_end"));
    let model = Model::from_draft(&draft).unwrap();
    let idle: Vec<_> = model.without_effect().iter().map(|v| model.variables[v.0].name.as_str()).collect();
    assert_eq!(idle, ["nothing", "dead_end"]);
}

#[test]
fn a_model_whose_formulas_follow_no_variable_keeps_none() {
    let mut draft = crank_rocker(true);
    draft.design.clear();
    let model = Model::from_draft(&draft).unwrap();
    assert!(model.formulas.is_empty());
    let with = Model::from_draft(&crank_rocker(true)).unwrap();
    assert_eq!(model.geometry(&[]), with.geometry(&[]));
}

//! Gradients by the adjoint way against the direct one.

use hardpoint::measure::outputs;
use hardpoint::run::{GradientMethod, Gradients};
use hardpoint::sensitivity::Admissibility;
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run};
use hardpoint::{draft::*, model::*};

use crate::workbench::*;

/// Two ways to the same gradient, as a part of the largest such gradient over the motion.
const AGREE: f64 = 1e-11;
/// Gradients smaller than this part of the largest of all outputs are compared with that part of it: what a plane
/// mechanism does across its plane is round-off.
const SMALL: f64 = 1e-2;
/// If no variable moves any output, only round-off can be compared: mechanisms are about 1 m large.
const NOTHING: f64 = 1e-3;

const BOTH: [Formulation; 2] = [Formulation::Relative, Formulation::Absolute];

/// Largest deviation, as a part of the size of the output's gradient over the motion.
fn deviation(a: &Gradients, b: &Gradients) -> f64 {
    let (outputs, steps) = (a.outputs.len(), a.times.len());
    let numbers = |g: &Gradients, m: usize, n: usize| -> Vec<f64> {
        (0..steps).flat_map(|k| g.at(k, m).iter().map(move |d| d[n])).collect()
    };
    let most = |x: &[f64]| x.iter().filter(|x| !x.is_nan()).fold(0.0_f64, |most, x| most.max(x.abs()));
    let mut worst = 0.0_f64;
    for n in 0..3 {
        let sizes: Vec<f64> = (0..outputs).map(|m| most(&numbers(a, m, n))).collect();
        for (m, size) in sizes.iter().enumerate() {
            let scale = size.max(SMALL * most(&sizes)).max(NOTHING);
            for (x, y) in numbers(a, m, n).into_iter().zip(numbers(b, m, n)) {
                assert_eq!(x.is_nan(), y.is_nan(), "{}: {x} {y}", a.outputs[m].name);
                worst = worst.max((x - y).abs() / scale);
            }
        }
    }
    worst
}

/// The same answer with the same largest defect. Of defects that tie, round-off says which is noted first.
fn assert_same_answer(a: &Admissibility, b: &Admissibility, what: &str) {
    use Admissibility::CannotFollow;
    let (CannotFollow { joints: x, .. }, CannotFollow { joints: y, .. }) = (a, b) else {
        return assert_eq!(a, b, "{what}");
    };
    let [x, y] = [x, y].map(|joints| joints.iter().map(|j| j.value).fold(0.0, f64::max));
    assert!((x - y).abs() < 1e-9 * x, "{what}: {a:?} {b:?}");
}

/// Deviation of the adjoint way from the direct one over all outputs, after comparing all else that they say.
fn compare(analysis: &Analysis<'_>, design: &[f64], what: &str) -> f64 {
    let all = outputs(analysis.model());
    // What is no matter of positions has no load.
    let all: Vec<usize> = (0..all.len()).filter(|&m| all[m].known.by_position).collect();
    let [direct, adjoint] =
        [GradientMethod::Direct, GradientMethod::Adjoint].map(|m| analysis.gradients(design, &all, m));
    assert_eq!([direct.method, adjoint.method], [GradientMethod::Direct, GradientMethod::Adjoint]);
    assert_eq!(direct.times, adjoint.times, "{what}");
    assert_eq!(direct.stop.is_some(), adjoint.stop.is_some(), "{what}");
    for (v, (a, b)) in direct.admissibility.iter().zip(&adjoint.admissibility).enumerate() {
        assert_same_answer(a, b, &format!("{what}, variable {v}"));
    }
    deviation(&direct, &adjoint)
}

/// A point on every body, with the measures that a draft has: no body's motion goes unseen.
fn with_points(mut draft: Draft) -> Draft {
    for (k, b) in draft.bodies.iter().enumerate() {
        let at = LocationDraft::At([0.1 + 0.01 * k as f64, -0.2, 0.3].into());
        draft.points.push(PointDraft::new(format!("point on body {k}"), b.name.clone(), at));
    }
    draft
}

#[test]
fn adjoint_and_direct_gradients_agree_on_every_mechanism_at_any_design() {
    for draft in crate::joints::mechanisms() {
        let model = Model::from_draft(&with_points(draft)).unwrap();
        let nominal = Analysis::new(&model).unwrap().run();
        let follows = |v: usize| nominal.sensitivities.at(0, v).is_some();
        let changed: Vec<f64> = (0..model.variables.len())
            .map(|v| if follows(v) { 1e-3 - 1e-4 * v as f64 } else { 0.0 })
            .collect();
        for formulation in BOTH {
            let analysis = Analysis::with(&model, formulation).unwrap();
            for design in [&[][..], &changed] {
                let worst = compare(&analysis, design, &model.name);
                assert!(worst < AGREE, "{}, {formulation:?}: {worst:e}", model.name);
            }
        }
    }
}

#[test]
fn all_measures_of_a_wheel_have_the_same_gradients_where_variables_move_its_own_points_too() {
    let mut draft = reference_draft("double_wishbone");
    let places =
        [("hub", [0.0, 0.6, 0.2324]), ("low", [0.009, 0.561, 0.141]), ("up", [-0.016, 0.545, 0.324])];
    for (k, (name, position)) in places.into_iter().enumerate() {
        draft.hardpoints.push(HardpointDraft::new(name, position));
        let velocity = [[0.3, 1.0, 0.2], [1.0, 0.1, 0.4], [0.2, -0.4, 1.0]][k].into();
        let changes = vec![ChangeDraft::Move { hardpoint: name.into(), velocity }];
        draft.design.push(VariableDraft::new(name, changes));
    }
    let at = |name: &str| LocationDraft::Hardpoint(name.into());
    let on_knuckle = |name: &str| PointRef::On { body: "knuckle".into(), at: at(name) };
    draft.wheels.push(WheelDraft {
        name: "wheel".into(),
        body: "knuckle".into(),
        centre: at("hub"),
        spin: WheelSpinDraft::Angles { toe: 0.01, camber: -0.02 },
        radius: 0.2324,
        side: None,
        kingpin: Some([on_knuckle("low"), on_knuckle("up")]),
        bump: None,
        steer: None,
        planes: Some([
            ["hub", "low", "up"].map(on_knuckle).to_vec(),
            vec![
                PointRef::On { body: "uca".into(), at: at("up") },
                PointRef::On { body: "uca".into(), at: at("hub") },
            ],
        ]),
        spring: None,
        end: None,
        drive: None,
        brakes: None,
    });
    let of_wheel = |&what: &WheelMeasure| {
        MeasureDraft::new(
            format!("wheel {}", what.name()),
            MeasureKindDraft::Wheel { wheel: "wheel".into(), what },
        )
    };
    let plain = WheelMeasure::ALL.iter().filter(|m| !m.needs().depends_on_driver());
    draft.measures.extend(plain.map(of_wheel));
    let kind = MeasureKindDraft::Distance {
        from: on_knuckle("hub"),
        to: PointRef::On { body: "uca".into(), at: at("up") },
    };
    draft.measures.push(MeasureDraft::new("hub to arm", kind));
    let model = Model::from_draft(&draft).unwrap();
    for formulation in BOTH {
        let analysis = Analysis::with(&model, formulation).unwrap();
        let worst = compare(&analysis, &vec![1e-3; model.variables.len()], "wheel");
        assert!(worst < AGREE, "{formulation:?}: {worst:e}");
    }
}

/// Velocities, slopes and formulas have no load: they are taken from a whole run.
#[test]
fn gradients_of_other_measures_are_those_of_a_run() {
    let mut draft = reference_draft("double_wishbone");
    let point = || PointRef::On { body: "knuckle".into(), at: LocationDraft::At([0.0, 0.6, 0.2].into()) };
    let along: Vec3 = [0.0, 0.0, 1.0].into();
    let mut add = |name: &str, kind| draft.measures.push(MeasureDraft::new(name, kind));
    add("height", MeasureKindDraft::Coordinates { point: point(), along });
    add("aside", MeasureKindDraft::Coordinates { point: point(), along: [0.0, 1.0, 0.0].into() });
    add("speed", MeasureKindDraft::Velocity { point: point(), along: Some(along) });
    let driver = Some(draft.drivers[0].name.clone());
    let (of, over) = ("aside".to_owned(), "height".to_owned());
    let mut add = |name: &str, kind| draft.measures.push(MeasureDraft::new(name, kind));
    let (points, drivers) = (vec![point()], driver.clone().map(|driver| vec![driver]));
    add("slope", MeasureKindDraft::Slope { of, over, driver, together: None, opposed: None });
    add("gain", MeasureKindDraft::Dexterity { points, drivers, value: Some(JacobianValue::GreatestGain) });
    let expression = hardpoint::expression::Expression::parse("height*aside").unwrap();
    add("product", MeasureKindDraft::Combination { expression });
    let model = Model::from_draft(&draft).unwrap();
    let analysis = Analysis::new(&model).unwrap();
    let run = analysis.run();
    let asked: Vec<usize> =
        ["speed", "slope", "gain", "product"].iter().map(|n| run.measured.index(n).unwrap()).collect();
    let found = analysis.gradients(&[], &asked, GradientMethod::Adjoint);
    assert_eq!(found.method, GradientMethod::Direct);
    let same = |a: f64, b: f64| a == b || a.is_nan() && b.is_nan();
    for k in 0..run.motion.len() {
        for (at, m) in asked.iter().enumerate() {
            for (v, d) in found.at(k, at).iter().enumerate() {
                let expected = run.measured.d(k, VariableId(v), *m);
                assert!((0..3).all(|order| same(d[order], expected[order])), "{d:?} {expected:?}");
            }
        }
    }
}

#[test]
fn inadmissible_variables_are_found_by_the_adjoint_method_too() {
    // Three redundant rows watch the planar four-bar: its law may change, one pivot may not tilt.
    let mut draft = four_bar([[0.0, 0.0], [0.0, 0.1], [0.3, 0.25], [0.3, 0.0]], "t", &times(3.0, 30));
    draft.drivers[0].law = hardpoint::law::Law::parse_with("a*sin(3*t)", &[("a", 0.7)]).unwrap();
    let tilt = ChangeDraft::Marker {
        joint: "D".into(),
        end: End::Both,
        position: [0.0; 3].into(),
        rotation: [1.0, 0.0, 0.0].into(),
    };
    let law = ChangeDraft::Law { driver: "motor".into(), parameter: "a".into(), rate: 1.0 };
    draft.design = [tilt, law]
        .into_iter()
        .enumerate()
        .map(|(k, change)| VariableDraft::new(format!("change {k}"), [change]))
        .collect();
    let model = Model::from_draft(&draft).unwrap();
    for formulation in BOTH {
        let analysis = Analysis::with(&model, formulation).unwrap();
        let worst = compare(&analysis, &[], "four-bar");
        assert!(worst < AGREE, "{formulation:?}: {worst:e}");
        let gradients = analysis.gradients(&[], &[0], GradientMethod::Adjoint);
        assert!(matches!(gradients.admissibility[0], Admissibility::CannotFollow { .. }));
        assert_eq!(gradients.admissibility[1], Admissibility::Admissible);
        for k in 0..gradients.times.len() {
            let [tilted, faster] = gradients.at(k, 0) else { panic!("two variables") };
            assert!(tilted.iter().all(|d| d.is_nan()) && faster.iter().all(|d| d.is_finite()));
        }
    }
}

#[test]
fn large_blocks_are_solved_transposed_by_their_sparse_factors() {
    let (draft, _) = crate::loops::truss(40);
    let model = Model::from_draft(&with_points(draft)).unwrap();
    for formulation in BOTH {
        let analysis = Analysis::with(&model, formulation).unwrap();
        assert!(analysis.topology().blocks.iter().any(|b| b.unknowns.len() > 40));
        let worst = compare(&analysis, &[1e-3, 2e-3], "truss");
        assert!(worst < AGREE, "{formulation:?}: {worst:e}");
    }
}

#[test]
fn adjoint_and_direct_gradients_agree_on_random_mechanisms() {
    /// Nearer to singular than this each order loses digits, more than the tolerance allows.
    const LEAST_MARGIN: f64 = 1e-2;
    let mut compared = 0;
    for (name, draft) in crate::random::drafts(40) {
        let model = Model::from_draft(&with_points(draft)).unwrap();
        for formulation in BOTH {
            let Ok(analysis) = Analysis::with(&model, formulation) else { continue };
            let motion = analysis.solve(Run::new().without_sensitivities()).motion;
            if motion.least_margin().is_some_and(|(_, m)| m.value > LEAST_MARGIN) {
                let worst = compare(&analysis, &[], &name);
                assert!(worst < 100.0 * AGREE, "{name}, {formulation:?}: {worst:e}");
                compared += 1;
            }
        }
    }
    assert!(compared > 40, "only {compared} were compared");
}

#[test]
fn few_outputs_of_many_variables_go_the_adjoint_way_by_themselves() {
    let model = reference("macpherson");
    let analysis = Analysis::new(&model).unwrap();
    let method = |outputs: &[usize]| analysis.gradients(&[], outputs, GradientMethod::Auto).method;
    assert!(model.variables.len() > 30);
    assert_eq!(method(&[0]), GradientMethod::Adjoint);
    let all: Vec<usize> = (0..outputs(&model).len()).cycle().take(20).collect();
    assert_eq!(method(&all), GradientMethod::Direct);
}

#[test]
fn gradients_of_a_motion_that_stops_are_those_up_to_there() {
    // The crank is longer than the rocker, which stops it.
    let mut draft = four_bar([[0.0, 0.0], [0.0, 0.3], [0.3, 0.25], [0.3, 0.0]], "t", &times(6.0, 60));
    let change = ChangeDraft::Marker {
        joint: "D".into(),
        end: End::Both,
        position: [1.0, 0.0, 0.0].into(),
        rotation: [0.0; 3].into(),
    };
    draft.design = vec![VariableDraft::new("D", [change])];
    let model = Model::from_draft(&draft).unwrap();
    let analysis = Analysis::new(&model).unwrap();
    let gradients = analysis.gradients(&[], &[0], GradientMethod::Adjoint);
    assert!(gradients.stop.is_some() && !gradients.times.is_empty() && gradients.times.len() < 61);
    let worst = compare(&analysis, &[], "four-bar that stops");
    assert!(worst < 100.0 * AGREE, "{worst:e}");
}

#[test]
fn no_step_of_an_adjoint_run_allocates() {
    for name in ["slider_crank", "macpherson", "double_wishbone"] {
        let [few, many] = [50, 500].map(|steps| {
            let mut draft = reference_draft(name);
            draft.times = (0..steps).map(|k| k as f64 * 1e-3).collect();
            let model = Model::from_draft(&draft).unwrap();
            let analysis = Analysis::new(&model).unwrap();
            let run = || drop(analysis.gradients(&[], &[0, 1], GradientMethod::Adjoint));
            allocation_counter::measure(run).count_total
        });
        // The list of times grows by doubling.
        assert!(many - few <= 4, "{name}: {} allocations in 450 steps", many - few);
    }
}

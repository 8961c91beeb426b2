//! Second design derivatives against differences of first ones.

use hardpoint::law::Law;
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run};
use hardpoint::{draft::*, model::*};

use crate::workbench::*;

/// Differences of exact first derivatives: their error is the square of the step, and round-off over it.
const AGREE: f64 = 2e-7;

/// Largest deviation of bodies and outputs from differences, each as a part of the largest such number.
fn deviation(
    model: &Model,
    formulation: Formulation,
    design: &[f64],
    directions: &[Vec<f64>],
    h: f64,
) -> f64 {
    let analysis = Analysis::with(model, formulation).unwrap();
    let n = directions.len();
    let pairs: Vec<[usize; 2]> = (0..n).flat_map(|u| (0..n).map(move |w| [u, w])).collect();
    let second = analysis.second(design, directions, &pairs);
    assert!(second.stop.is_none());
    assert_eq!(second.times, model.times);
    let variables = model.variables.len();
    let mut worst = 0.0_f64;
    for (p, &[u, w]) in pairs.iter().enumerate() {
        let moved = |h: f64| -> Vec<f64> {
            let value = |k: usize| design.get(k).copied().unwrap_or(0.0) + h * directions[w][k];
            (0..variables).map(value).collect()
        };
        let [ahead, behind] = [h, -h].map(|h| analysis.solve(Run::new().at(&moved(h))));
        assert!(ahead.stop.is_none() && behind.stop.is_none());
        // Lengths in metres, angles in radians: a mechanism of some 0.1 to 1 m.
        let (mut scale, mut most) = (1e-2, 0.0_f64);
        let mut compare = |exact: f64, difference: f64| {
            scale = f64::max(scale, exact.abs());
            most = most.max((exact - difference).abs());
        };
        for k in 0..model.times.len() {
            let along = |s: &hardpoint::Solution, b: usize| {
                let mut sum = [Vec3::ZERO; 2];
                for v in (0..variables).filter(|v| directions[u][*v] != 0.0) {
                    let d = s.sensitivities.at(k, v).expect("followed").body(b);
                    sum[0] += d.dr * directions[u][v];
                    sum[1] += d.dpi * directions[u][v];
                }
                sum
            };
            for b in 0..model.bodies.len() {
                let ([r1, t1], [r0, t0]) = (along(&ahead, b), along(&behind, b));
                let exact = second.body(k, p, BodyId(b));
                for (exact, d) in [(exact.d2r, r1 - r0), (exact.ddpi, t1 - t0)] {
                    (0..3).for_each(|c| compare(exact[c], d[c] / (2.0 * h)));
                }
            }
            for m in 0..second.outputs.len() {
                let along = |s: &hardpoint::Solution| -> f64 {
                    let followed = (0..variables).filter(|v| directions[u][*v] != 0.0);
                    followed.map(|v| s.measured.d(k, VariableId(v), m)[0] * directions[u][v]).sum()
                };
                compare(second.value(k, p, m), (along(&ahead) - along(&behind)) / (2.0 * h));
            }
        }
        worst = worst.max(most / scale);
    }
    worst
}

fn unit(variables: usize, v: usize) -> Vec<f64> {
    (0..variables).map(|k| f64::from(u8::from(k == v))).collect()
}

#[test]
fn second_derivatives_match_differences_of_first_ones_on_every_mechanism() {
    for name in REFERENCES {
        let model = reference(name);
        let nominal = Analysis::new(&model).unwrap().run();
        let followed: Vec<usize> =
            (0..model.variables.len()).filter(|&v| nominal.sensitivities.at(0, v).is_some()).collect();
        // Five variables spread over all of them, and a direction that mixes them.
        let chosen: Vec<usize> = (0..5).map(|k| followed[k * followed.len() / 5]).collect();
        let mut directions: Vec<Vec<f64>> = chosen.iter().map(|&v| unit(model.variables.len(), v)).collect();
        let mut mixed = vec![0.0; model.variables.len()];
        chosen.iter().enumerate().for_each(|(k, &v)| mixed[v] = 0.4 - 0.3 * k as f64);
        directions.push(mixed.clone());
        let design: Vec<f64> = mixed.iter().map(|d| 2e-3 * d).collect();
        for (formulation, at) in [(Formulation::Relative, &design[..]), (Formulation::Absolute, &[])] {
            let [coarse, fine, finest] =
                [1e-4, 1e-5, 1e-6].map(|h| deviation(&model, formulation, at, &directions, h));
            let best = fine.min(finest);
            assert!(best < AGREE, "{name}, {formulation:?}: {coarse:e} {fine:e} {finest:e}");
            // A hundred times less for a tenth of the step, as far as round-off allows.
            assert!(fine < AGREE || fine < coarse / 50.0, "{name}, {formulation:?}: {coarse:e} {fine:e}");
        }
    }
}

#[test]
fn parameters_of_laws_have_second_derivatives_too() {
    let mut draft = four_bar([[0.0, 0.0], [0.0, 0.1], [0.3, 0.25], [0.3, 0.0]], "t", &times(3.0, 30));
    draft.drivers[0].law = Law::parse_with("a*sin(w*t)", &[("a", 0.7), ("w", 3.0)]).unwrap();
    for parameter in ["a", "w"] {
        let change = ChangeDraft::Law { driver: "motor".into(), parameter: parameter.into(), rate: 1.0 };
        draft.design.push(VariableDraft::new(parameter, [change]));
    }
    let model = Model::from_draft(&draft).unwrap();
    let directions: Vec<Vec<f64>> = (0..2).map(|v| unit(2, v)).collect();
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let worst = deviation(&model, formulation, &[0.01, 0.02], &directions, 1e-5);
        assert!(worst < AGREE, "{formulation:?}: {worst:e}");
    }
}

#[test]
fn a_cam_and_a_slot_have_second_derivatives_too() {
    let model = Model::from_draft(&crate::joints::cam_and_slot()).unwrap();
    let nominal = Analysis::new(&model).unwrap().run();
    let n = model.variables.len();
    let followed = (0..n).filter(|&v| nominal.sensitivities.at(0, v).is_some());
    let directions: Vec<Vec<f64>> = followed.take(4).map(|v| unit(n, v)).collect();
    assert!(directions.len() > 1);
    for formulation in [Formulation::Relative, Formulation::Absolute] {
        let best = [1e-5, 1e-6].map(|h| deviation(&model, formulation, &[], &directions, h));
        assert!(best[0].min(best[1]) < 1e-5, "{formulation:?}: {best:?}");
    }
}

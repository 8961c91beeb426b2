//! Mechanisms to test with, written as a user of the library would write them.

use hardpoint::law::Law;
use hardpoint::space::Vec3;
use hardpoint::{Analysis, Run, Solution};
use hardpoint::{draft::*, model::*};

use crate::reference_case::Case;

/// A reference mechanism as a model.
pub fn reference(name: &str) -> Model {
    Model::from_draft(&reference_draft(name)).unwrap()
}

/// A reference mechanism as a draft, to be changed.
pub fn reference_draft(name: &str) -> Draft {
    let file = format!("{}/tests/reference/{name}.json", env!("CARGO_MANIFEST_DIR"));
    Case::read(file.as_ref()).unwrap().draft
}

/// All reference mechanisms that the library ships.
pub const REFERENCES: [&str; 8] = [
    "slider_crank",
    "macpherson",
    "rssr",
    "hooke",
    "double_wishbone",
    "jansen",
    "drivetrain",
    "elementary_chain",
];

pub fn body(name: &str) -> BodyDraft {
    BodyDraft { name: name.into(), frame: FrameDraft::Default }
}

pub fn joint(
    name: &str,
    kind: &str,
    bodies: [&str; 2],
    at: &[[f64; 3]],
    axis: Option<[f64; 3]>,
) -> JointDraft {
    JointDraft {
        name: name.into(),
        kind: kind.into(),
        bodies: bodies.map(Into::into),
        at: at.iter().map(|&p| Place::At(p.into())).collect(),
        axis: axis.map(|a| Line::Along(a.into())),
        ..JointDraft::default()
    }
}

pub fn driver(name: &str, joint: &str, law: &str) -> DriverDraft {
    let drives = DrivenDraft::Coordinate { joint: joint.into(), coordinate: None };
    DriverDraft { name: name.into(), drives, law: Law::parse(law).unwrap() }
}

/// A planar four-bar of 3D revolutes about z through the points A, B, C, D; the crank A-B is driven.
pub fn four_bar(points: [[f64; 2]; 4], law: &str, times: &[f64]) -> Draft {
    let z = Some([0.0, 0.0, 1.0]);
    let p = points.map(|[x, y]| [x, y, 0.0]);
    Draft {
        name: "four-bar".into(),
        bodies: ["crank", "coupler", "rocker"].map(body).into(),
        joints: vec![
            joint("A", "revolute", ["ground", "crank"], &[p[0]], z),
            joint("B", "revolute", ["crank", "coupler"], &[p[1]], z),
            joint("C", "revolute", ["coupler", "rocker"], &[p[2]], z),
            joint("D", "revolute", ["ground", "rocker"], &[p[3]], z),
        ],
        drivers: vec![driver("motor", "A", law)],
        measures: vec![MeasureDraft {
            name: "rocker".into(),
            kind: MeasureKindDraft::Coordinate { joint: "D".into(), coordinate: None },
        }],
        times: times.to_vec(),
        ..Draft::default()
    }
}

/// Motions of designs, with their measures.
pub fn designs_of(analysis: &Analysis<'_>, designs: &[Vec<f64>]) -> Vec<Solution> {
    let mut all = vec![Solution::default(); designs.len()];
    let run = Run::new().without_sensitivities();
    analysis.solve_designs(run, designs, |k, solution| all[k] = std::mem::take(solution));
    all
}

/// Times 0 to `end` in n steps.
pub fn times(end: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| end * k as f64 / n as f64).collect()
}

/// Largest component of a difference.
pub fn apart(a: Vec3, b: Vec3) -> f64 {
    (a - b).to_array().into_iter().map(f64::abs).fold(0.0, f64::max)
}

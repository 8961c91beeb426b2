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
    BodyDraft::new(name)
}

pub fn joint(
    name: &str,
    kind: &str,
    bodies: [&str; 2],
    at: &[[f64; 3]],
    axis: Option<[f64; 3]>,
) -> JointDraft {
    let joint = JointDraft { axis: axis.map(DirectionDraft::from), ..JointDraft::new(name, kind, bodies) };
    at.iter().fold(joint, |joint, place| joint.at(*place))
}

pub fn driver(name: &str, joint: &str, law: &str) -> DriverDraft {
    let drives = DrivenDraft::Coordinate { joint: joint.into(), coordinate: None };
    DriverDraft::new(name, drives, Law::parse(law).unwrap())
}

/// A planar four-bar of 3D revolutes about z through the points A, B, C, D; the crank A-B is driven.
pub fn four_bar(points: [[f64; 2]; 4], law: &str, times: &[f64]) -> Draft {
    let z = [0.0, 0.0, 1.0];
    let [a, b, c, d] = points.map(|[x, y]| [x, y, 0.0]);
    Draft::new("four-bar")
        .bodies(["crank", "coupler", "rocker"])
        .revolute("A", ["ground", "crank"], a, z)
        .revolute("B", ["crank", "coupler"], b, z)
        .revolute("C", ["coupler", "rocker"], c, z)
        .revolute("D", ["ground", "rocker"], d, z)
        .driver("motor", "A", Law::parse(law).unwrap())
        .measure("rocker", "D")
        .times(times.iter().copied())
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

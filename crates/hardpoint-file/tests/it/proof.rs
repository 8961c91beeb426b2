//! Proofs that clearances are kept between the output times.

use hardpoint::Analysis;
use hardpoint::model::Model;
use hardpoint::run::{ClearanceProof, ProofFailure};
use hardpoint_file::parse;

/// Allowance for round-off, as a fraction of the mechanism's size.
const ROUND_OFF: f64 = 1e-12;

fn model_of(text: &str) -> Model {
    parse(text, "proof.toml").unwrap_or_else(|e| panic!("{e}\n{text}")).model
}

#[test]
fn the_least_distances_of_the_knee_are_proved_and_greater_ones_are_not() {
    let model = model_of(include_str!("knee.toml"));
    let analysis = Analysis::new(&model).unwrap();
    let found = analysis.clearances(&[]);
    let mut prover = analysis.clearance_prover(&[]).unwrap();
    for pair in &found.pairs {
        let least = pair.least().unwrap().at.distance[0];
        let proof = prover.prove(pair.shapes, least - ROUND_OFF * model.size());
        println!("{:?} {least} {proof:?} {}", pair.shapes, prover.enclosures());
        let proof = prover.prove(pair.shapes, least + 1e-9);
        println!("{:?} {least} {proof:?} {}", pair.shapes, prover.enclosures());
    }
}

//! Every number of the high-precision cases in `tests/reference`, in both formulations.
//!
//! The folder's README defines the cases. `HARDPOINT_REFERENCE=DIR cargo test reference` runs the cases
//! of another folder. A case that needs a joint type, driver or measure that does not exist is a failure
//! that names it.

use crate::reference_case::{Case, Comparison};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, model::Model};
use std::path::PathBuf;

/// Largest deviation, as a part of a quantity's largest magnitude in the case (at least 1).
///
/// The data are good to half a unit in the last place; what is left is our own round-off, amplified by
/// the conditioning of the mechanism (up to 30 in these cases) and by two differentiations.
const TOLERANCE: f64 = 1e-9;

fn cases() -> Vec<PathBuf> {
    let folder = std::env::var_os("HARDPOINT_REFERENCE")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/reference"), PathBuf::from);
    let mut files: Vec<PathBuf> = std::fs::read_dir(&folder)
        .unwrap_or_else(|e| panic!("cannot read the folder of cases {}: {e}", folder.display()))
        .map(|f| f.expect("a directory entry").path())
        .filter(|p| p.extension().is_some_and(|e| e == "json"))
        .collect();
    files.sort();
    assert!(!files.is_empty(), "no cases in {}", folder.display());
    files
}

#[test]
fn every_number_of_every_case_holds_in_both_formulations() {
    let mut failures = Vec::new();
    for file in cases() {
        let name = file.file_stem().unwrap().to_string_lossy().into_owned();
        let case = match Case::read(&file) {
            Ok(case) => case,
            Err(e) => {
                failures.push(format!("{name}: {e}"));
                continue;
            }
        };
        let model = match Model::from_draft(&case.draft) {
            Ok(model) => model,
            Err(faults) => {
                failures.push(format!("{name}: not a model: {}", faults[0].message));
                continue;
            }
        };
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            match compare(&case, &model, formulation) {
                Ok(c) => println!(
                    "{name} ({formulation:?}): {} numbers, worst deviation {:.1e} in {}",
                    c.count, c.worst, c.worst_name
                ),
                Err(e) => failures.push(format!("{name} ({formulation:?}): {e}")),
            }
        }
    }
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

fn compare(case: &Case, model: &Model, formulation: Formulation) -> Result<Comparison, String> {
    let analysis = Analysis::with(model, formulation).map_err(|e| format!("{e}: {:?}", e.notes()))?;
    let topology = analysis.topology();
    let solution = analysis.run();
    if let Some(stop) = &solution.stop {
        return Err(format!("{} {:?}", stop.headline(model), stop));
    }
    let redundant = topology.redundant().count();
    if formulation == Formulation::Absolute && redundant != case.redundant {
        return Err(format!("{redundant} redundant constraints, {} expected", case.redundant));
    }
    case.check_admissibility(model, &solution)?;
    let comparison = case.compare(model, &solution)?;
    if comparison.worst > TOLERANCE {
        return Err(format!("{} deviates by {:.2e}", comparison.worst_name, comparison.worst));
    }
    Ok(comparison)
}

//! Every number of the high-precision cases in `tests/reference`, in both formulations.
//!
//! The folder's README defines the cases. `HARDPOINT_REFERENCE=DIR cargo test reference` runs the cases
//! of another folder. A case that needs a joint type, driver or measure that does not exist is a failure
//! that names it.

use crate::reference_case::{Case, Comparison};
use hardpoint::motion::Execution;
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
    let (mut failures, mut by_programs) = (Vec::new(), 0);
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
            // As the case has its output times; and with many between them, on every path that steps can take.
            let close = refined(&model);
            let ways = [(&model, Execution::Fastest)].into_iter().chain(EXECUTIONS.map(|by| (&close, by)));
            for (model, execution) in ways {
                let every = (model.times.len() - 1) / (case.draft.times.len() - 1).max(1);
                match compare(&case, model, formulation, execution, every.max(1)) {
                    Ok((c, steps)) => {
                        by_programs += usize::from(steps > 0);
                        println!(
                            "{name} ({formulation:?}, {execution:?}): {} numbers, worst deviation {:.1e} in {}; \
                             {steps} steps by programs",
                            c.count, c.worst, c.worst_name
                        );
                    }
                    Err(e) => failures.push(format!("{name} ({formulation:?}, {execution:?}): {e}")),
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
    assert!(by_programs > 10, "{by_programs} by programs");
}

const EXECUTIONS: [Execution; 3] = [Execution::Kernel, Execution::Interpreted, Execution::Compiled];

/// With that many steps from one output time to the next.
const BETWEEN: usize = 64;

fn refined(model: &Model) -> Model {
    let step = |w: &[f64], n: usize| w[0] + (w[1] - w[0]) * n as f64 / BETWEEN as f64;
    let mut times: Vec<f64> =
        model.times.windows(2).flat_map(|w| (0..BETWEEN).map(move |n| step(w, n))).collect();
    times.extend(model.times.last());
    Model { times, ..model.clone() }
}

fn compare(
    case: &Case,
    model: &Model,
    formulation: Formulation,
    execution: Execution,
    every: usize,
) -> Result<(Comparison, usize), String> {
    let analysis = Analysis::with(model, formulation).map_err(|e| format!("{e}: {:?}", e.notes()))?;
    let analysis = analysis.executed(execution);
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
    let comparison = case.compare(model, &solution, every)?;
    if comparison.worst > TOLERANCE {
        return Err(format!("{} deviates by {:.2e}", comparison.worst_name, comparison.worst));
    }
    Ok((comparison, solution.motion.effort.by_program))
}

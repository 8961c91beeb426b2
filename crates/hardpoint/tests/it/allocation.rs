//! The hot path allocates nothing per step: ten times the steps take exactly the same number of allocations.

use hardpoint::model::Model;
use hardpoint::motion::Execution;
use hardpoint::{Analysis, Run};

use crate::workbench::reference_draft;

/// Those of a run into fresh memory, and into that of the run before.
fn allocations(name: &str, execution: Execution, steps: usize, run: fn() -> Run<'static>) -> [u64; 2] {
    let mut draft = reference_draft(name);
    draft.times = (0..steps).map(|k| k as f64 * 1e-3).collect();
    let model = Model::from_draft(&draft).unwrap();
    let analysis = Analysis::new(&model).unwrap().executed(execution);
    // Programs are recorded once.
    let solution = analysis.solve(run());
    let reused = allocation_counter::measure(|| drop(analysis.solve(run().reusing(solution)))).count_total;
    let fresh = allocation_counter::measure(|| drop(analysis.solve(run()))).count_total;
    [fresh, reused]
}

#[test]
fn no_step_of_a_motion_or_of_its_sensitivities_allocates() {
    for name in ["slider_crank", "macpherson", "double_wishbone"] {
        let runs: [fn() -> Run<'static>; 2] =
            [|| Run::new().without_measures().without_sensitivities(), || Run::new().without_measures()];
        for run in runs {
            for execution in [Execution::Kernel, Execution::Interpreted, Execution::Compiled] {
                let [few, many] = [50, 500].map(|steps| allocations(name, execution, steps, run));
                // What a variable that cannot be followed resists with is noted once, at the first step that shows it.
                assert_eq!(
                    few, many,
                    "{name} {execution:?}: {few:?} allocations, {many:?} with 450 steps more"
                );
                let [fresh, reused] = few;
                assert!(
                    reused < fresh,
                    "{name} {execution:?}: {reused} allocations in used memory, {fresh} in fresh"
                );
            }
        }
    }
}

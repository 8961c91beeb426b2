//! The hot path allocates nothing per step: ten times the steps take exactly as many allocations.

use hardpoint::Analysis;
use hardpoint::model::Model;
use hardpoint::motion::Execution;

use crate::workbench::reference_draft;

fn allocations(name: &str, execution: Execution, steps: usize, run: impl Fn(&Analysis<'_>)) -> u64 {
    let mut draft = reference_draft(name);
    draft.times = (0..steps).map(|k| k as f64 * 1e-3).collect();
    let model = Model::from_draft(&draft).unwrap();
    let analysis = Analysis::new(&model).unwrap().bodies_only().executed(execution);
    // Programs are recorded once.
    run(&analysis);
    allocation_counter::measure(|| run(&analysis)).count_total
}

#[test]
fn no_step_of_a_motion_or_of_its_sensitivities_allocates() {
    for name in ["slider_crank", "macpherson", "double_wishbone"] {
        for run in [|a: &Analysis<'_>| drop(a.run_motion()), |a: &Analysis<'_>| drop(a.run())] {
            for execution in [Execution::Kernel, Execution::Interpreted, Execution::Compiled] {
                let [few, many] = [50, 500].map(|steps| allocations(name, execution, steps, run));
                // What a variable that cannot be followed resists with is noted once, at the first step that shows it.
                assert_eq!(few, many, "{name} {execution:?}: {few} allocations, {many} with 450 steps more");
            }
        }
    }
}

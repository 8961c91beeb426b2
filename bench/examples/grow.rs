//! Cost of a generated mechanism, stage by stage: `grow chain|truss|scissors|far_scissors SIZE STEPS`; with `text` in
//! place of the steps, its model file.
//!
//! Scissors are driven where they stand on the ground, far ones at the other end.

use std::time::Instant;

use hardpoint::model::Model;
use hardpoint::{Analysis, Run};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [kind, size, steps] = arguments.as_slice() else {
        panic!("usage: grow chain|truss|scissors|far_scissors SIZE STEPS|text");
    };
    let size: usize = size.parse().expect("a size");
    let is_text = steps == "text";
    let steps = if is_text { 10 } else { steps.parse().expect("a number of steps") };
    let draft = match kind.as_str() {
        "chain" => hardpoint_bench::chain(size, steps),
        "truss" => hardpoint_bench::truss(size, steps),
        "far_scissors" => hardpoint_bench::scissors(size, size, [size - 1; 2], steps),
        _ => hardpoint_bench::scissors(size, size, [0; 2], steps),
    };
    if is_text {
        print!("{}", hardpoint_bench::text(&draft));
        return;
    }
    let before = Instant::now();
    let model = Model::from_draft(&draft).expect("a valid model");
    let checked = before.elapsed();
    let before = Instant::now();
    let analysis = Analysis::new(&model).unwrap_or_else(|e| panic!("{e}"));
    let planned = before.elapsed();
    let topology = analysis.topology();
    let largest = topology.blocks.iter().map(|b| b.unknowns.len()).max().unwrap_or(0);
    println!(
        "{} blocks, {} unknowns, largest {largest}, {} rows, {} of them redundant",
        topology.blocks.len(),
        topology.unknowns(),
        topology.rows.len(),
        topology.redundant().count()
    );
    let before = Instant::now();
    let solution = analysis.solve(Run::new().without_sensitivities().without_measures());
    let ran = before.elapsed();
    let per_step = 1e6 * ran.as_secs_f64() / solution.motion.len().max(1) as f64;
    println!("checked {checked:.1?}, planned {planned:.1?}, ran {ran:.1?}: {per_step:.1} us per step");
    println!("{:?} {:?}", solution.motion.effort, solution.stop);
}

//! The paper's two examples: motion only, motion with all sensitivities, eight designs in lanes; and a double wishbone
//! with rigid joints and in equilibrium on four bushings.
//!
//! Figures are per run; `docs/performance.md` has them per step, as ratios within one run.

use divan::Bencher;
use divan::counter::ItemsCount;
use hardpoint::motion::Execution;
use hardpoint::{Analysis, Run, Solution};

const MODELS: [&str; 2] = ["slider_crank", "macpherson"];

fn main() {
    divan::main();
}

/// The bodies alone, without measures.
fn bodies() -> Run<'static> {
    Run::new().without_measures()
}

/// Position, velocity and acceleration of all bodies at all output times.
#[divan::bench(args = MODELS)]
fn motion(bencher: Bencher, name: &str) {
    let model = hardpoint_bench::model(name);
    let analysis = Analysis::new(&model).unwrap();
    bencher
        .counter(ItemsCount::new(model.times.len()))
        .bench(|| analysis.solve(bodies().without_sensitivities()));
}

/// The same with all sensitivities of all bodies by all design variables.
#[divan::bench(args = MODELS)]
fn all_sensitivities(bencher: Bencher, name: &str) {
    let model = hardpoint_bench::model(name);
    let analysis = Analysis::new(&model).unwrap();
    bencher.counter(ItemsCount::new(model.times.len())).bench(|| analysis.solve(bodies()));
}

/// The same with all measures and points, and their sensitivities.
#[divan::bench(args = MODELS)]
fn all_sensitivities_and_measures(bencher: Bencher, name: &str) {
    let model = hardpoint_bench::model(name);
    let analysis = Analysis::new(&model).unwrap();
    bencher.counter(ItemsCount::new(model.times.len())).bench(|| analysis.run());
}

/// All sensitivities of all bodies by 24 coordinates: the kernel with rigid joints, and equilibria on four bushings with
/// six directions each under load, which the kernel solves as well.
#[divan::bench(args = ["rigid", "elastic"])]
fn equilibrium(bencher: Bencher, name: &str) {
    let model = hardpoint_bench::model(name);
    let analysis = Analysis::new(&model).unwrap().executed(Execution::Kernel);
    bencher.counter(ItemsCount::new(model.times.len())).bench(|| analysis.solve(bodies()));
}

/// Motions of eight designs side by side in SIMD lanes.
#[divan::bench(args = MODELS)]
fn eight_designs(bencher: Bencher, name: &str) {
    let model = hardpoint_bench::model(name);
    let analysis = Analysis::new(&model).unwrap();
    let designs: Vec<Vec<f64>> = (0..8).map(|k| vec![1e-5 * f64::from(k); 1]).collect();
    bencher.counter(ItemsCount::new(8 * model.times.len())).bench(|| {
        let mut all = vec![Solution::default(); designs.len()];
        let run = bodies().without_sensitivities();
        analysis.solve_designs(run, &designs, |k, solution| all[k] = std::mem::take(solution));
        all
    });
}

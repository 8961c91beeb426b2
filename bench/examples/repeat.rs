//! Runs one model again and again, for profilers and instruction counters:
//! `repeat MODEL motion|sensitivities|designs|values|all|sweep|metrics TIMES`. The first three are of bodies alone, the
//! others of measures too: their values, all their sensitivities as well, the values of 1,000 designs, and the metrics
//! of all cases with their gradients, where each case counts as a step.

use hardpoint::model::Model;
use hardpoint::{Analysis, Run, Solution};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, what, times] = arguments.as_slice() else {
        panic!("usage: repeat MODEL motion|sensitivities|designs|values|all|sweep|metrics TIMES");
    };
    let model = hardpoint_bench::model(name);
    if what == "metrics" {
        return metrics(&model, times);
    }
    let analysis = hardpoint_bench::analysis(&model);
    let bodies = || Run::new().without_measures();
    let designs = vec![vec![1e-5]; 8];
    let many: Vec<Vec<f64>> = (0..1000).map(|k| vec![1e-6 * f64::from(k)]).collect();
    let mut steps = 0;
    let mut solution = Solution::default();
    let before = std::time::Instant::now();
    for _ in 0..times.parse().expect("a number of times") {
        steps += match what.as_str() {
            "motion" => {
                solution = analysis.solve(bodies().without_sensitivities().reusing(solution));
                solution.motion.len()
            }
            "sensitivities" => {
                solution = analysis.solve(bodies().reusing(solution));
                solution.motion.len()
            }
            // Cost of one call from Python: nothing is reused.
            "values" => analysis.solve(Run::new().without_sensitivities()).motion.len(),
            "all" => analysis.run().motion.len(),
            "sweep" => {
                let mut solved = 0;
                let run = Run::new().without_sensitivities();
                analysis.solve_designs(run, &many, |_, solution| solved += solution.motion.len());
                solved
            }
            _ => {
                let mut solved = 0;
                let run = bodies().without_sensitivities();
                analysis.solve_designs(run, &designs, |_, solution| solved += solution.motion.len());
                solved
            }
        };
    }
    let seconds = before.elapsed().as_secs_f64();
    let iterations = analysis.solve(bodies().without_sensitivities()).motion.effort;
    println!("{steps} steps, {:.3} us each; {iterations:?}", 1e6 * seconds / steps as f64);
}

/// Metrics of all cases of a model with their gradients, as studies ask for them.
fn metrics(model: &Model, times: &str) {
    let motions = model.motions();
    let analyses: Vec<Analysis<'_>> = motions.iter().map(hardpoint_bench::analysis).collect();
    let before = std::time::Instant::now();
    let times: u32 = times.parse().expect("a number of times");
    let mut found = 0;
    for _ in 0..times {
        for analysis in &analyses {
            let solution = analysis.solve(Run::new().for_metrics(&[]));
            found += hardpoint::run::metrics(analysis.model(), &solution).len();
        }
    }
    let (cases, seconds) = (analyses.len() * times as usize, before.elapsed().as_secs_f64());
    println!("{cases} steps, {:.3} us each; {found} metrics", 1e6 * seconds / cases as f64);
}

//! W1 to W4s of the comparison (`docs/performance.md`): CPU time per step, and agreement with closed forms to 1e-10.
//!
//!     cargo bench -p hardpoint-bench --bench workloads [-- W2s W3-100]
//!
//! The closed forms of W1, W2 and W4 are the floor of `peers/`, in C++: without g++ only the chains are compared.

use std::path::Path;

use hardpoint_bench::floor;
use hardpoint_bench::workloads::{Workload, measure};

/// Largest deviation of any number, SI units. Sensitivities of accelerations go up to some hundreds.
const TOLERANCE: f64 = 1e-10;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    // Cargo says what it wants: without `--bench`, as in `cargo test --benches`, one run of each is enough.
    let once = !arguments.iter().any(|a| a == "--bench");
    let named: Vec<Workload> = arguments
        .iter()
        .filter(|a| !a.starts_with('-'))
        .map(|a| a.parse().unwrap_or_else(|e| panic!("{e}")))
        .collect();
    let workloads = if named.is_empty() { Workload::ALL.to_vec() } else { named };

    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("floor");
    let reference = match floor::run(&folder, 1) {
        Ok(_) => Some(folder.as_path()),
        Err(e) => {
            println!("NOT compared with the floor, but for chains: {e}");
            None
        }
    };
    println!(
        "workload    us per step    largest deviation of position, velocity, acceleration (or sensitivities)"
    );
    for workload in workloads {
        let figures = measure(workload, reference, once).unwrap_or_else(|e| panic!("{e}"));
        let errors =
            figures.errors.map_or("not compared".into(), |e| e.map(|x| format!("{x:.1e}")).join("  "));
        println!("{:<9} {:>13.3}    {errors}", workload.to_string(), figures.us_per_step);
        for error in figures.errors.into_iter().flatten() {
            assert!(error <= TOLERANCE, "{workload} is off by {error:e}");
        }
    }
}

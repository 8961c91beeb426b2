//! Hardpoint as a peer of the comparison: runs workloads on one thread and prints a JSON line for each.
//!
//!     workloads [W1 W2s W3-100 ...] [--reference DIR]    errors against the floor's files in DIR
//!     workloads --floor DIR                              the floor itself: leaves its files in DIR, prints its lines
//!     workloads --plan LOOPS                             reads and plans the file of a chain

use std::path::PathBuf;
use std::process::ExitCode;

use hardpoint_bench::floor;
use hardpoint_bench::workloads::{Workload, measure, plan_chain};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("workloads: {e}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), String> {
    let mut reference = None;
    let mut workloads = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--reference" => reference = Some(folder(arguments.next())?),
            "--floor" => {
                let lines = floor::run(&folder(arguments.next())?, 41).map_err(|e| e.to_string())?;
                print!("{lines}");
                return Ok(());
            }
            "--plan" => {
                let loops =
                    arguments.next().and_then(|n| n.parse().ok()).ok_or("--plan needs a number of loops")?;
                let [read, plan] = plan_chain(loops);
                println!(
                    r#"{{"peer": "hardpoint", "workload": "plan-{loops}", "read_ms": {read:.4}, "plan_ms": {plan:.4}}}"#
                );
                return Ok(());
            }
            name => workloads.push(name.parse()?),
        }
    }
    if workloads.is_empty() {
        workloads.extend(Workload::ALL);
    }
    for workload in workloads {
        let figures = measure(workload, reference.as_deref(), false).map_err(|e| e.to_string())?;
        println!("{}", figures.json(workload));
    }
    Ok(())
}

fn folder(argument: Option<String>) -> Result<PathBuf, String> {
    argument.map(PathBuf::from).ok_or_else(|| "a folder is missing after the last option".into())
}

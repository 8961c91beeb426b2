//! Time per step against the size of generated mechanisms: chains of loops, and trusses that are one block.
//!
//! Figures are per run of eleven steps; `docs/performance.md` has them per step.

use divan::Bencher;
use divan::counter::ItemsCount;
use hardpoint::{Analysis, Run};
use hardpoint::{draft::Draft, model::Model};

/// Steps after the first output time.
const STEPS: usize = 10;

fn main() {
    divan::main();
}

fn motion(bencher: Bencher<'_, '_>, draft: &Draft) {
    let model = Model::from_draft(draft).unwrap();
    let analysis = Analysis::new(&model).unwrap();
    bencher
        .counter(ItemsCount::new(model.times.len()))
        .bench(|| analysis.solve(Run::new().without_sensitivities().without_measures()));
}

fn check_and_plan(bencher: Bencher<'_, '_>, draft: &Draft) {
    bencher.bench(|| {
        let model = Model::from_draft(draft).unwrap();
        Analysis::new(&model).unwrap().topology().unknowns()
    });
}

/// N loops of two unknowns, one after another.
#[divan::bench(args = [1, 10, 100, 1000, 10_000], max_time = 3)]
fn chain_motion(bencher: Bencher, n: usize) {
    motion(bencher, &hardpoint_bench::chain(n, STEPS));
}

/// Checking and planning them.
#[divan::bench(args = [1, 10, 100, 1000, 10_000], max_time = 3)]
fn chain_check_and_plan(bencher: Bencher, n: usize) {
    check_and_plan(bencher, &hardpoint_bench::chain(n, STEPS));
}

/// Reading and checking their files.
#[divan::bench(args = [1, 10, 100, 1000, 10_000], max_time = 3)]
fn chain_read(bencher: Bencher, n: usize) {
    let text = hardpoint_bench::text(&hardpoint_bench::chain(n, 10));
    bencher.bench(|| hardpoint_file::parse(&text, "chain.toml").unwrap());
}

/// n x n scissors that are driven where they stand, which fall into many small blocks.
#[divan::bench(args = [2, 5, 10, 20], max_time = 3)]
fn scissors_motion(bencher: Bencher, n: usize) {
    motion(bencher, &hardpoint_bench::scissors(n, n, [0; 2], STEPS));
}

/// The same, driven at the other end: one block of 2 n^2 - 2 unknowns, which loses digits with its size.
#[divan::bench(args = [2, 5, 10, 20], max_time = 3)]
fn far_scissors_motion(bencher: Bencher, n: usize) {
    motion(bencher, &hardpoint_bench::scissors(n, n, [n - 1; 2], STEPS));
}

/// One block of 2 (n - 1) unknowns.
#[divan::bench(args = [10, 30, 100, 300, 1000], max_time = 3)]
fn truss_motion(bencher: Bencher, n: usize) {
    motion(bencher, &hardpoint_bench::truss(n, STEPS));
}

/// Checking and planning it.
#[divan::bench(args = [10, 30, 100, 300, 1000], max_time = 3)]
fn truss_check_and_plan(bencher: Bencher, n: usize) {
    check_and_plan(bencher, &hardpoint_bench::truss(n, STEPS));
}

//! One search from one start.

use super::assessment::failed_design;
use super::descent::Descent;
use super::optimality::Optimality;
use super::problem::Problem;
use super::result::{Iteration, SearchResult, Status};
use super::solver::Memory;
use super::starts::nearest_start;
use crate::evaluation::StudyCost;

/// Runs one search from one start.
pub(super) fn search(
    problem: &Problem<'_>,
    variant: usize,
    start: &[f64],
    tell: &mut dyn FnMut(&Iteration),
    more: &(dyn Fn() -> bool + Sync),
) -> SearchResult {
    let memory = Memory::new(problem, more);
    let n = start.len();
    let point = nearest_start(problem, &memory, start);
    let mut search = SearchResult {
        variant,
        start: problem.design(point.as_ref().map_or(start, |(start, _)| start)),
        status: if memory.interrupted() { Status::Interrupted } else { Status::NoStart },
        found: None,
        optimality: Optimality { residual: f64::INFINITY, ..Optimality::default() },
        iterations: Vec::new(),
        work: vec![0.0; n],
        idle: vec![true; n],
        refused: Vec::new(),
        cost: StudyCost::default(),
    };
    if let Some((start, point)) = point {
        Descent::new(problem, &memory, &start, point).run(&mut search, tell);
    }
    search.refused =
        memory.refused.take().into_iter().map(|(design, why)| failed_design(design, why)).collect();
    search.cost = memory.cost.take();
    search
}

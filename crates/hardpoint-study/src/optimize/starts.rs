//! Starts of the searches: designs within the bounds, as fractions of these.

use sobol_burley::sample;

use super::problem::{Point, Problem};
use super::solver::Memory;

/// Maximum number of trials for a start that cannot be evaluated; each is half as far from the nominal design as the
/// one before.
const HALVINGS: i32 = 8;
/// Maximum dimension of the low-discrepancy points; further variables start at their nominal values.
const MOST_DIMENSIONS: usize = 256;

/// Start k, as fractions of the bounds: the nominal design, then low-discrepancy points.
pub(super) fn start(problem: &Problem<'_>, k: usize) -> Vec<f64> {
    let nominal = problem.parts(&vec![0.0; problem.model.variables.len()]);
    let dimension = |(d, nominal): (usize, f64)| match k {
        0 => nominal,
        _ if d >= MOST_DIMENSIONS => nominal,
        _ => f64::from(sample(k as u32, d as u32, 0)),
    };
    nominal.into_iter().enumerate().map(dimension).collect()
}

/// A start moved towards the nominal design until it can be evaluated: half of the way each time.
pub(super) fn nearest_start(
    problem: &Problem<'_>,
    memory: &Memory<'_>,
    start: &[f64],
) -> Option<(Vec<f64>, Point)> {
    let nominal = problem.parts(&vec![0.0; problem.model.variables.len()]);
    let nearer = |halvings: i32| -> Vec<f64> {
        let part = 0.5_f64.powi(halvings);
        nominal.iter().zip(start).map(|(nominal, start)| nominal + part * (start - nominal)).collect()
    };
    let tries = if start == nominal { 1 } else { HALVINGS };
    let mut starts = (0..tries).map(nearer).take_while(|_| !memory.interrupted());
    starts
        .find_map(|start| memory.at(&start, |found| found.as_ref().ok().cloned()).map(|point| (start, point)))
}

/// True if no goal depends on any variable: all derivatives are round-off, and not at the start only, which may be a
/// symmetric design.
pub(super) fn has_no_effect(problem: &Problem<'_>, memory: &Memory<'_>, point: &Point) -> bool {
    if !point.is_constant(problem) {
        return false;
    }
    let here = problem.parts(&point.design);
    let Some(other) = [1, 2].map(|k| start(problem, k)).into_iter().find(|other| *other != here) else {
        return true;
    };
    let is_constant = |halvings: i32| {
        let parts = other.iter().zip(&here);
        let parts: Vec<f64> = parts.map(|(a, b)| b + 0.5_f64.powi(halvings) * (a - b)).collect();
        memory.at(&parts, |found| found.as_ref().ok().map(|point| point.is_constant(problem)))
    };
    (0..HALVINGS).find_map(is_constant).unwrap_or(false)
}

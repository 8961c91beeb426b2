//! Degrees of freedom, and whether the drivers agree with the constraints, at the design configuration.

use super::blocks::{RANK_TOLERANCE, design_jacobian};
use super::*;
use crate::space::{Elimination, FullPivot};

/// Counts the degrees of freedom; every unknown is already known to be determined.
///
/// Each driver in turn gets unit speed and the blocks are solved for the motion that follows. Where a
/// row that was left out then fails, the drivers and constraints that meet there contradict each other:
/// the mechanism has fewer freedoms than drivers.
pub(super) fn examine(model: &Model, topology: &mut Topology) -> Result<(), TopologyFault> {
    let jacobian = design_jacobian(model, topology);
    let drivers = model.drivers.len();
    // speeds[c][d]: speed of coordinate c per unit speed of driver d, lengths in units of the size.
    let mut speeds = vec![vec![0.0; drivers]; topology.coordinates.len()];
    for (c, coordinate) in topology.coordinates.iter().enumerate() {
        if let Source::Driven(d) = coordinate.source {
            speeds[c][d.0] = 1.0;
        }
    }
    // Unit speed of a driven length is one size per second, so the scaled demand is 1 for every driver.
    let demand = |row: &RowPlace, d: usize| {
        let driven = topology.closures[row.closure].driver == Some(DriverId(d));
        f64::from(u8::from(driven))
    };
    for (b, block) in topology.blocks.iter().enumerate() {
        let mut factors = Elimination::new(block.unknowns.len(), 0.0);
        for (k, &r) in block.selected.iter().enumerate() {
            factors.row_mut(k).fill(0.0);
            for &(c, x) in &jacobian[r] {
                if let Source::Unknown { block, column } = topology.coordinates[c].source
                    && block == b
                {
                    factors.row_mut(k)[column] += x;
                }
            }
        }
        factors.factor();
        for d in 0..drivers {
            let mut rhs: Vec<f64> = block
                .selected
                .iter()
                .map(|&r| {
                    let known: f64 = jacobian[r].iter().map(|&(c, x)| x * speeds[c][d]).sum();
                    demand(&topology.rows[r], d) - known
                })
                .collect();
            factors.solve(&mut rhs);
            for (column, &c) in block.unknowns.iter().enumerate() {
                speeds[c][d] = rhs[column];
            }
        }
    }
    // A contradiction is a left-out row that fails under some driver's motion; by how much, per driver.
    let mut contradictions: Vec<(usize, Vec<f64>)> = Vec::new();
    for (r, row) in topology.rows.iter().enumerate().filter(|(_, r)| !r.selected && !r.is_term) {
        let fails: Vec<f64> = (0..drivers)
            .map(|d| {
                let sum: f64 = jacobian[r].iter().map(|&(c, x)| x * speeds[c][d]).sum();
                let scale =
                    1.0 + jacobian[r].iter().map(|&(c, x)| (x * speeds[c][d]).abs()).fold(0.0, f64::max);
                let failure = (sum - demand(row, d)) / scale;
                if failure.abs() > RANK_TOLERANCE.sqrt() { failure } else { 0.0 }
            })
            .collect();
        if fails.iter().any(|f| *f != 0.0) {
            contradictions.push((r, fails));
        }
    }
    // Each independent contradiction forbids one combination of the drivers' speeds.
    let rows = contradictions.iter().map(|(_, fails)| fails.clone()).collect();
    topology.mobility = drivers - FullPivot::of(rows, drivers, RANK_TOLERANCE.sqrt()).rows.len();
    if contradictions.is_empty() {
        Ok(())
    } else {
        Err(fault::contradicted(model, topology, &contradictions))
    }
}

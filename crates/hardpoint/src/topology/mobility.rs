//! Degrees of freedom, and contradictions of drivers and constraints, in the design configuration.

use std::collections::BTreeMap;

use crate::linalg::{Factors, FullPivot, LARGEST_DENSE};
use crate::model::Model;

use super::blocks::{RANK_TOLERANCE, columns_in_block, design_jacobian};
use super::error::TopologyError;
use super::plan::SparseRow;
use super::{BlockId, RowId, Topology, error};

/// Counts the degrees of freedom. Every unknown is already determined.
///
/// Solves the blocks for the motion at unit speed of each driver. If a redundant row fails, drivers and constraints
/// contradict each other there: the mechanism has fewer degrees of freedom than drivers.
pub(super) fn examine(model: &Model, topology: &mut Topology) -> Result<(), TopologyError> {
    let jacobian = design_jacobian(model, topology);
    let drivers = model.drivers.len();
    // Per coordinate: speed per unit speed of each driver that moves it, lengths relative to the sizes of their loops.
    let mut speeds: Vec<Vec<(usize, f64)>> = vec![Vec::new(); topology.coordinates.len()];
    for (c, d) in topology.driven_coordinates() {
        speeds[c.0].push((d.0, 1.0));
    }
    let mut multiplications = Vec::new();
    for (b, block) in BlockId::each(&topology.blocks) {
        let row = |k: usize| columns_in_block(topology, &jacobian[block.selected[k].0], b);
        let columns = |k: usize| row(k).map(|(column, _)| column).collect();
        let mut factors = Factors::new(block.unknowns.len(), columns, LARGEST_DENSE);
        for k in 0..block.selected.len() {
            factors.set_row(k, row(k), 0.0);
        }
        factors.factor();
        multiplications.push(factors.multiplications());
        // Per driver that acts on the block: right-hand side of its rows.
        let mut lacking: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        for (k, &r) in block.selected.iter().enumerate() {
            for (d, [sum, _, demand]) in row_rates(topology, &jacobian, &speeds, r) {
                // J q. = f. - (terms of earlier blocks and of driven coordinates), f. = 1 of driver d alone   (9)
                lacking.entry(d).or_insert_with(|| vec![0.0; block.selected.len()])[k] = demand - sum;
            }
        }
        for (d, mut rhs) in lacking {
            factors.solve(&mut rhs);
            for (column, &c) in block.unknowns.iter().enumerate().filter(|(column, _)| rhs[*column] != 0.0) {
                speeds[c.0].push((d, rhs[column]));
            }
        }
    }
    topology.blocks.iter_mut().zip(multiplications).for_each(|(block, n)| block.multiplications = n);
    // A contradiction is a redundant row that fails under the motion of a driver, with its failure per driver.
    let mut contradictions: Vec<(RowId, Vec<f64>)> = Vec::new();
    for r in topology.redundant() {
        let rates = row_rates(topology, &jacobian, &speeds, r).into_iter();
        // abs(sum J q. - f.) / (1 + largest term): a redundant row at unit speed of driver d
        let failures = rates.map(|(d, [sum, largest, demand])| (d, (sum - demand) / (1.0 + largest)));
        let failures: Vec<(usize, f64)> = failures.filter(|(_, f)| f.abs() > RANK_TOLERANCE.sqrt()).collect();
        if !failures.is_empty() {
            let mut fails = vec![0.0; drivers];
            failures.into_iter().for_each(|(d, f)| fails[d] = f);
            contradictions.push((r, fails));
        }
    }
    // Each independent contradiction forbids one combination of the drivers' speeds.
    let rows = contradictions.iter().map(|(_, fails)| fails.clone()).collect();
    // Degrees of freedom = drivers - rank(violations by their speeds)
    topology.mobility = drivers - FullPivot::of(rows, drivers, RANK_TOLERANCE.sqrt()).rows.len();
    if contradictions.is_empty() {
        Ok(())
    } else {
        Err(error::contradiction(model, topology, &contradictions))
    }
}

/// Returns, for each driver that moves a row: the rate of the row, its largest term, and the rate that the driver
/// prescribes. Unit speed of a driven length is one size per second, so this rate is 1 for every driver.
fn row_rates(
    topology: &Topology,
    jacobian: &[SparseRow],
    speeds: &[Vec<(usize, f64)>],
    r: RowId,
) -> BTreeMap<usize, [f64; 3]> {
    let mut rates: BTreeMap<usize, [f64; 3]> = BTreeMap::new();
    for &(c, x) in &jacobian[r.0] {
        for &(d, speed) in &speeds[c.0] {
            let [sum, largest, _] = rates.entry(d).or_default();
            *sum += x * speed;
            *largest = largest.max((x * speed).abs());
        }
    }
    if let Some(d) = topology.closure_of(r).driver {
        rates.entry(d.0).or_default()[2] = 1.0;
    }
    rates
}

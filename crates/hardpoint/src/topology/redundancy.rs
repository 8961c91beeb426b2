//! Which constraints say the same: for every redundant one, those that imply it.

use super::blocks::{SparseRow, design_jacobian};
use super::*;
use crate::space::Elimination;

/// A constraint whose part in a combination is smaller than this has no part in it.
const PART: f64 = 1e-7;
/// Blocks with more unknowns than this are not taken apart: the search is cubic in them.
const MOST_UNKNOWNS: usize = 300;

/// A redundant constraint and the constraints that imply it in the design configuration. Any one of all of them could be
/// left out, and the others would still say the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Redundancy {
    /// The redundant row, an index into [`Topology::rows`].
    pub row: usize,
    /// The rows that imply it; empty where they were not searched for.
    pub implied_by: Vec<usize>,
}

impl Topology {
    /// All redundant constraints, each with those that imply it.
    pub fn redundancies(&self, model: &Model) -> Vec<Redundancy> {
        let jacobian = design_jacobian(model, self);
        let mut factors: Vec<Option<Elimination<f64>>> = vec![None; self.blocks.len()];
        let rows = self.rows.iter().enumerate().filter(|(_, p)| !p.selected && !p.is_term);
        rows.map(|(row, _)| Redundancy { row, implied_by: self.implied_by(row, &jacobian, &mut factors) })
            .collect()
    }

    /// The selected rows of which a row is a combination: block by block from the last, what is left of the row over the
    /// block's unknowns is a combination of the block's own rows.
    fn implied_by(
        &self,
        row: usize,
        jacobian: &[SparseRow],
        factors: &mut [Option<Elimination<f64>>],
    ) -> Vec<usize> {
        let mut left = vec![0.0; self.coordinates.len()];
        for &(c, x) in &jacobian[row] {
            left[c] += x;
        }
        let mut implied_by = Vec::new();
        for (b, block) in self.blocks.iter().enumerate().rev() {
            if block.unknowns.iter().all(|&c| left[c].abs() <= PART) {
                continue;
            }
            let n = block.unknowns.len();
            if n > MOST_UNKNOWNS {
                return Vec::new();
            }
            // J^T c = left
            let transposed = factors[b].get_or_insert_with(|| {
                let mut transposed = Elimination::new(n, 0.0);
                for k in 0..n {
                    transposed.row_mut(k).fill(0.0);
                }
                for (k, &r) in block.selected.iter().enumerate() {
                    for &(c, x) in &jacobian[r] {
                        if let Source::Unknown { block, column } = self.coordinates[c].source
                            && block == b
                        {
                            transposed.row_mut(column)[k] += x;
                        }
                    }
                }
                transposed.factor();
                transposed
            });
            let mut parts: Vec<f64> = block.unknowns.iter().map(|&c| left[c]).collect();
            transposed.solve(&mut parts);
            for (k, &r) in block.selected.iter().enumerate().filter(|(k, _)| parts[*k].abs() > PART) {
                implied_by.push(r);
                for &(c, x) in &jacobian[r] {
                    left[c] -= parts[k] * x;
                }
            }
        }
        implied_by.sort_unstable();
        implied_by
    }

    /// A row in messages: its joint, coupler or driver, with the constraint.
    pub fn name_of_row(&self, model: &Model, row: usize) -> String {
        self.row_name(model, row)
    }
}

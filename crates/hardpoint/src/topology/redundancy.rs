//! Redundant constraints, each with the constraints that imply it.

use std::collections::BTreeMap;

use crate::linalg::Elimination;
use crate::model::Model;

use super::blocks::{columns_in_block, design_jacobian};
use super::plan::SparseRow;
use super::{CoordinateId, RowId, SetBy, Topology};

/// Coefficient of a constraint in a combination below which it is zero.
const PART: f64 = 1e-7;
/// Maximum number of unknowns of a block that is searched; the search is cubic in them.
const MOST_UNKNOWNS: usize = 300;

/// Redundant constraint, with the constraints that imply it in the design configuration. Any one of them can be removed
/// without an effect on the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Redundancy {
    /// The redundant row.
    pub row: RowId,
    /// Rows that imply it; empty if they were not searched.
    pub implied_by: Vec<RowId>,
}

impl Topology {
    /// Returns all redundant constraints, each with those that imply it.
    pub fn redundancies(&self, model: &Model) -> Vec<Redundancy> {
        let jacobian = design_jacobian(model, self);
        let mut factors: Vec<Option<Elimination<f64>>> = vec![None; self.blocks.len()];
        self.redundant()
            .map(|row| Redundancy { row, implied_by: self.implied_by(row, &jacobian, &mut factors) })
            .collect()
    }

    /// Returns the selected rows of which a row is a linear combination. Block by block from the last, the remainder of
    /// the row over the block's unknowns is a combination of the block's own rows.
    fn implied_by(
        &self,
        row: RowId,
        jacobian: &[SparseRow],
        factors: &mut [Option<Elimination<f64>>],
    ) -> Vec<RowId> {
        let mut left: BTreeMap<CoordinateId, f64> = jacobian[row.0].iter().copied().collect();
        let mut implied_by = Vec::new();
        loop {
            let block_of = |(c, x): (&CoordinateId, &f64)| match self[*c].set_by {
                SetBy::Block { block, .. } if x.abs() > PART => Some(block),
                _ => None,
            };
            let Some(b) = left.iter().filter_map(block_of).max() else { break };
            let block = &self[b];
            let n = block.unknowns.len();
            if n > MOST_UNKNOWNS {
                return Vec::new();
            }
            // J^T c = left
            let transposed = factors[b.0].get_or_insert_with(|| {
                let mut transposed = Elimination::new(n);
                for k in 0..n {
                    transposed.row_mut(k).fill(0.0);
                }
                for (k, &r) in block.selected.iter().enumerate() {
                    for (column, x) in columns_in_block(self, &jacobian[r.0], b) {
                        transposed.row_mut(column)[k] += x;
                    }
                }
                transposed.factor();
                transposed
            });
            let mut parts: Vec<f64> =
                block.unknowns.iter().map(|c| left.get(c).copied().unwrap_or(0.0)).collect();
            transposed.solve(&mut parts);
            for (k, &r) in block.selected.iter().enumerate().filter(|(k, _)| parts[*k].abs() > PART) {
                implied_by.push(r);
                for &(c, x) in &jacobian[r.0] {
                    // left <- left - c_k row_k, which also changes it over the unknowns of earlier blocks
                    *left.entry(c).or_insert(0.0) -= parts[k] * x;
                }
            }
            // The remainder is round-off.
            for c in &block.unknowns {
                left.remove(c);
            }
        }
        implied_by.sort_unstable();
        implied_by
    }
}

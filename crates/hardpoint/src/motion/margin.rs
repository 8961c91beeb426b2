//! How far from a singular position: the conditioning of the Jacobian over time.

use crate::space::Elimination;
use crate::topology::Topology;

use super::kinematics::State;

/// Blocks with more unknowns than this are judged by their pivots alone.
const MOST_UNKNOWNS: usize = 200;

/// How far from singular the Jacobian is: the least relative change, in the 1-norm, that makes it singular. That is the
/// reciprocal of its condition number; lengths are in sizes of the mechanism. 1 is best, 0 is a singular position, and
/// about log10(1 / margin) digits of a velocity are lost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Margin {
    /// The least of all blocks.
    pub value: f64,
    /// The block that has it.
    pub block: usize,
}

/// Works out margins; keeps its room from step to step.
pub(crate) struct Margins {
    blocks: Vec<Elimination<f64>>,
    row: Vec<f64>,
    column_sums: Vec<f64>,
}

impl Margins {
    pub fn new(topology: &Topology) -> Self {
        let widths = topology.blocks.iter().map(|b| b.unknowns.len());
        let dense = |n: usize| if n <= MOST_UNKNOWNS { n } else { 0 };
        let widest = widths.clone().max().unwrap_or(0);
        Self {
            blocks: widths.map(|n| Elimination::new(dense(n), 0.0)).collect(),
            row: vec![0.0; widest],
            column_sums: vec![0.0; widest],
        }
    }

    /// The margin where `state` stands.
    pub fn at(&mut self, topology: &Topology, state: &State<f64>) -> Margin {
        let mut least = Margin { value: 1.0, block: 0 };
        for (b, block) in topology.blocks.iter().enumerate() {
            let n = block.unknowns.len();
            let value =
                if n <= MOST_UNKNOWNS { self.of_block(topology, state, b) } else { state.pivots[b].0 };
            // Written so that NaN is the least of all.
            if !(value >= least.value) {
                least = Margin { value: if value.is_nan() { 0.0 } else { value }, block: b };
            }
        }
        least
    }

    /// 1 / (|J| |J^-1|) in the 1-norm, the inverse column by column.
    fn of_block(&mut self, topology: &Topology, state: &State<f64>, b: usize) -> f64 {
        let block = &topology.blocks[b];
        let n = block.unknowns.len();
        let factors = &mut self.blocks[b];
        let (row, sums) = (&mut self.row[..n], &mut self.column_sums[..n]);
        sums.fill(0.0);
        for (k, &r) in block.selected.iter().enumerate() {
            state.scaled_row(topology, r, 0, row);
            factors.row_mut(k).copy_from_slice(row);
            for (sum, x) in sums.iter_mut().zip(row.iter()) {
                *sum += x.abs();
            }
        }
        let norm = sums.iter().copied().fold(0.0, f64::max);
        if !(factors.factor().pivot_ratio > 0.0) {
            return 0.0;
        }
        let mut inverse_norm = 0.0_f64;
        for k in 0..n {
            row.fill(0.0);
            row[k] = 1.0;
            factors.solve(row);
            inverse_norm = inverse_norm.max(row.iter().map(|x| x.abs()).sum());
        }
        1.0 / (norm * inverse_norm)
    }
}

//! Statistics of a recording.

use crate::program::{Instruction, Program};

/// Statistics of the recorded operations. A recorded `a b + c` is two: a product and a sum. Constants, inputs and
/// uniforms are none.
///
/// Every operation has one end: `recorded = folded + common + dead + fused + left - negations`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// All that were recorded.
    pub recorded: usize,
    /// Done with constants, or a change of sign: nothing is left to compute.
    pub folded: usize,
    /// The same as an earlier one.
    pub common: usize,
    /// Computed for nothing: no output needs them.
    pub dead: usize,
    /// Products that are computed within sums.
    pub fused: usize,
    /// Instructions that are needed where a sign is not free: before outputs and functions.
    pub negations: usize,
    /// The instructions of the program.
    pub left: usize,
}

/// The instructions of a program by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Kinds {
    /// Sums and differences.
    pub sums: usize,
    /// Products.
    pub products: usize,
    /// Products fused with sums.
    pub fused: usize,
    /// Quotients.
    pub quotients: usize,
    /// Square roots.
    pub roots: usize,
    /// Functions of the standard library.
    pub calls: usize,
    /// Changes of sign, magnitudes, nearest integers, larger ones of two.
    pub others: usize,
}

impl Kinds {
    /// All of them.
    pub fn total(&self) -> usize {
        self.sums + self.products + self.fused + self.quotients + self.roots + self.calls + self.others
    }
}

impl Program {
    /// Number of instructions it has of each kind.
    pub fn kinds(&self) -> Kinds {
        use Instruction::*;
        let mut kinds = Kinds::default();
        for instruction in &self.instructions {
            *match instruction {
                Add(..) | Sub(..) => &mut kinds.sums,
                Mul(..) => &mut kinds.products,
                Div(..) => &mut kinds.quotients,
                MulAdd(..) | MulSub(..) | NegMulAdd(..) | NegMulSub(..) => &mut kinds.fused,
                Sqrt(_) => &mut kinds.roots,
                Call(..) => &mut kinds.calls,
                Neg(_) | Abs(_) | Round(_) | Larger(..) => &mut kinds.others,
            } += 1;
        }
        kinds
    }
}

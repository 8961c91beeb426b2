//! Statistics of a recording.

use crate::program::{Instruction, Program};

/// Statistics of the recorded operations. A recorded `a b + c` counts as two: a product and a sum. Constants, inputs
/// and uniforms do not count.
///
/// Every operation is counted in one category: `recorded = folded + common + dead + fused + left - negations`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Recorded operations.
    pub recorded: usize,
    /// Folded operations: of constants, or changes of sign, which need no instruction.
    pub folded: usize,
    /// Operations equal to an earlier one (common subexpressions).
    pub common: usize,
    /// Dead operations: no output depends on them.
    pub dead: usize,
    /// Products fused with sums.
    pub fused: usize,
    /// Additional negations for outputs and functions, where a sign is not free.
    pub negations: usize,
    /// Instructions of the program.
    pub left: usize,
}

/// Numbers of instructions of a program, by kind.
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
    /// Negations, magnitudes, nearest integers, maxima.
    pub others: usize,
}

impl Kinds {
    /// Returns the total number of instructions.
    pub fn total(&self) -> usize {
        self.sums + self.products + self.fused + self.quotients + self.roots + self.calls + self.others
    }
}

impl Program {
    /// Returns the number of instructions of each kind.
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

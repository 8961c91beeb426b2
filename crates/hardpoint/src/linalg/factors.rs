//! Factors of one block: dense for the small blocks that most mechanisms have, sparse for large ones.

use crate::number::{Function, Real};

use super::matrix::{Elimination, Factored};
use super::sparse::SparseLu;

/// Blocks with more unknowns than this are factored by [`SparseLu`].
///
/// With four entries per row, sparse factors are three times as fast as dense ones at 16 unknowns and seven times at
/// 40; with full rows they are as fast up to 16. But margins of sparse blocks are not recorded
/// (`motion/step_program.rs`), so the common block sizes stay dense.
pub(crate) const LARGEST_DENSE: usize = 40;

/// LU factors of the Jacobian of one block, stored for all right-hand sides of a step.
#[derive(Clone, Debug)]
pub(crate) enum Factors<T> {
    Dense(Elimination<T>),
    Sparse(Box<SparseLu<T>>),
}

impl<T: Real> Factors<T> {
    /// Factors of the n x n matrix whose row k may have entries in the columns `row(k)`.
    pub fn new(n: usize, row: impl Fn(usize) -> Vec<usize>, largest_dense: usize) -> Self {
        if n <= largest_dense {
            return Self::Dense(Elimination::new(n));
        }
        let rows: Vec<Vec<usize>> = (0..n).map(row).collect();
        Self::Sparse(Box::new(SparseLu::new(&rows)))
    }

    /// Fills row k with entries at columns, in the order of the columns given to [`Factors::new`].
    #[inline(always)]
    pub fn set_row(&mut self, k: usize, entries: impl Iterator<Item = (usize, T)>, zero: T) {
        match self {
            Self::Dense(lu) => {
                let row = lu.row_mut(k);
                for x in &mut *row {
                    *x = zero;
                }
                for (column, x) in entries {
                    row[column] = x;
                }
            }
            Self::Sparse(lu) => {
                lu.set_row(k, entries.map(|(_, x)| x));
            }
        }
    }

    #[inline(always)]
    pub fn factor(&mut self) -> Factored<T> {
        match self {
            Self::Dense(lu) => lu.factor(),
            Self::Sparse(lu) => lu.factor(),
        }
    }

    /// Number of multiplications of a sparse factorisation in the present pivot order; 0 for dense factors, which are
    /// small.
    pub fn multiplications(&self) -> usize {
        match self {
            Self::Dense(_) => 0,
            Self::Sparse(lu) => lu.multiplications(),
        }
    }

    /// Ratio of two determinants found by [`Factors::factor`].
    #[inline(always)]
    pub fn ratio(&self, now: T, before: T) -> T {
        match self {
            Self::Dense(_) => now / before,
            Self::Sparse(_) => ratio_of_logarithms(now, before),
        }
    }

    /// Replaces the right-hand side by the solution.
    #[inline(always)]
    pub fn solve(&mut self, b: &mut [T]) {
        match self {
            Self::Dense(lu) => lu.solve(b),
            Self::Sparse(lu) => lu.solve(b),
        }
    }

    /// Replaces the right-hand side by the solution with the transposed matrix.
    #[inline(always)]
    pub fn solve_transposed(&mut self, b: &mut [T]) {
        match self {
            Self::Dense(lu) => lu.solve_transposed(b),
            Self::Sparse(lu) => lu.solve_transposed(b),
        }
    }
}

/// `exp(ln abs(det) - ln abs(det before))`. It is not inlined: where dense factors are compared, the exponential would
/// be computed in advance and discarded.
#[inline(never)]
fn ratio_of_logarithms<T: Real>(now: T, before: T) -> T {
    (now - before).map(Function::Exp)
}

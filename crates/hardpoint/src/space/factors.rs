//! Factors of one block: dense for the small blocks that most mechanisms have, sparse for large ones.

use super::matrix::{Elimination, Factored};
use super::sparse::SparseLu;
use crate::number::{Function, Real};

/// Blocks with more unknowns than this are factored by [`SparseLu`].
///
/// Measured on trusses with four entries a row (`bench`, `truss`): sparse steps are as fast as dense ones at about
/// 35 unknowns, twice as fast at 60, and the fuller the rows, the later.
pub(crate) const LARGEST_DENSE: usize = 40;

/// LU factors of one block's Jacobian, kept for every right-hand side of a step.
#[derive(Clone, Debug)]
pub(crate) enum Factors<T> {
    Dense(Elimination<T>),
    Sparse(Box<SparseLu<T>>),
}

impl<T: Real> Factors<T> {
    /// Of the n x n matrix whose row k may have entries in the columns `row(k)`.
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
                row.fill(zero);
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

    /// One determinant that [`Factors::factor`] found over another.
    #[inline(always)]
    pub fn ratio(&self, now: T, before: T) -> T {
        match self {
            Self::Dense(_) => now / before,
            Self::Sparse(_) => (now - before).map(Function::Exp),
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

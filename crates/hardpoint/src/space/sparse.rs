//! Sparse factors of a large block, by faer.

use std::marker::PhantomData;

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::lu::simplicial::{
    SimplicialLu, factorize_simplicial_numeric_lu, factorize_simplicial_numeric_lu_scratch,
    solve_in_place_scratch, solve_transpose_in_place_scratch,
};
use faer::sparse::linalg::lu::{LuSymbolicParams, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par};

use super::matrix::{Factored, Watched};
use crate::number::Real;

/// LU factors of a sparse square matrix whose pattern does not change.
///
/// Rows are what the caller fills, and columns what faer wants, so the transpose is factored and solved with.
/// The order that keeps fill small is worked out once; every factorisation pivots anew for stability. After the
/// first, factoring and solving allocate nothing unless other pivots bring more fill.
#[derive(Clone, Debug)]
pub(crate) struct SparseLu<T> {
    numbers: PhantomData<T>,
    /// Of the transpose: its columns are the rows of the matrix.
    pattern: SymbolicSparseColMat<usize>,
    /// Row after row, in the order of the pattern.
    values: Vec<f64>,
    /// Row after row, in the order in which they are filled: where an entry stands in `values`.
    place: Vec<usize>,
    /// Order of elimination, and its inverse.
    order: [Vec<usize>; 2],
    /// Whether that order is an odd permutation.
    odd: bool,
    lu: SimplicialLu<usize, f64>,
    pivots: [Vec<usize>; 2],
    rhs: Vec<f64>,
    /// Scratch of [`is_odd`].
    seen: Vec<bool>,
    memory: Memory,
}

/// One of faer's two ways to solve with the factors.
type Solve = fn(
    &SimplicialLu<usize, f64>,
    PermRef<'_, usize>,
    PermRef<'_, usize>,
    Conj,
    MatMut<'_, f64>,
    Par,
    &mut MemStack,
);

/// What faer works in.
struct Memory {
    need: StackReq,
    buffer: MemBuffer,
}

impl Clone for Memory {
    fn clone(&self) -> Self {
        Self { need: self.need, buffer: MemBuffer::new(self.need) }
    }
}

impl std::fmt::Debug for Memory {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?}", self.need)
    }
}

impl<T: Real> SparseLu<T> {
    /// Factors of the n x n matrix that may have entries in these columns of its rows.
    pub fn new(rows: &[Vec<usize>]) -> Self {
        let n = rows.len();
        // faer 0.24 orders unsorted patterns wrongly (it panics), so entries get their sorted places here.
        let (mut starts, mut columns, mut place) = (vec![0], Vec::new(), Vec::new());
        for row in rows {
            let mut slots: Vec<usize> = (0..row.len()).collect();
            slots.sort_unstable_by_key(|&slot| row[slot]);
            place.resize(columns.len() + row.len(), 0);
            for slot in slots {
                place[starts[starts.len() - 1] + slot] = columns.len();
                columns.push(row[slot]);
            }
            starts.push(columns.len());
        }
        let pattern = SymbolicSparseColMat::new_checked(n, n, starts, None, columns);
        let params = LuSymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
            ..LuSymbolicParams::default()
        };
        let symbolic = factorize_symbolic_lu(pattern.as_ref(), params).expect("memory for the pattern");
        let (forward, inverse) = symbolic.col_perm().arrays();
        let order = [forward.to_vec(), inverse.to_vec()];
        let entries = pattern.row_idx().len();
        let need = factorize_simplicial_numeric_lu_scratch::<usize, f64>(n, n)
            .or(solve_transpose_in_place_scratch::<usize, f64>(n, 1, Par::Seq))
            .or(solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq));
        Self {
            numbers: PhantomData,
            odd: is_odd(&order[0], &mut vec![false; n]),
            seen: vec![false; n],
            values: vec![0.0; entries],
            lu: SimplicialLu::new(),
            pivots: [vec![0; n], vec![0; n]],
            rhs: vec![0.0; n],
            memory: Memory { need, buffer: MemBuffer::new(need) },
            pattern,
            place,
            order,
        }
    }

    fn n(&self) -> usize {
        self.order[0].len()
    }

    /// Fills row r with its entries, in the order of the columns given to [`SparseLu::new`].
    #[inline(always)]
    pub fn set_row(&mut self, r: usize, entries: impl Iterator<Item = T>) {
        let starts = self.pattern.col_ptr();
        for (&at, x) in self.place[starts[r]..starts[r + 1]].iter().zip(entries) {
            self.values[at] = x.value();
        }
    }

    /// Factors what the rows were filled with.
    #[inline(never)]
    pub fn factor(&mut self) -> Factored<T> {
        let n = self.n();
        let found = |pivot_ratio, positive, determinant: f64| Factored {
            pivot_ratio,
            positive,
            determinant: T::constant(determinant),
            watched: Watched::zero(),
        };
        let Self { lu, pivots: [forward, inverse], .. } = self;
        let factored = factorize_simplicial_numeric_lu(
            forward,
            inverse,
            lu,
            SparseColMatRef::new(self.pattern.as_ref(), &self.values),
            PermRef::new_checked(&self.order[0], &self.order[1], n),
            MemStack::new(&mut self.memory.buffer),
        );
        if factored.is_err() {
            return found(0.0, true, 0.0);
        }
        // The determinant is that of U, up to the signs of the two permutations.
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        let (mut logarithm, mut product) = (0.0, 1.0_f64);
        let mut positive = self.odd == is_odd(forward, &mut self.seen);
        let upper = lu.u_factor_unsorted();
        for column in 0..n {
            let Some(pivot) = upper.val_of_col(column).last() else { continue };
            let size = pivot.abs();
            // Written so that a NaN pivot makes the ratio zero, never a good number.
            if !(size > 0.0) {
                return found(0.0, positive, 0.0);
            }
            // The product of thousands of pivots leaves the range of numbers.
            product *= size;
            if !(1e-100..1e100).contains(&product) {
                (logarithm, product) = (logarithm + product.ln(), 1.0);
            }
            least = least.min(size);
            most = most.max(size);
            positive ^= *pivot < 0.0;
        }
        found(if n == 0 { 1.0 } else { least / most }, positive, logarithm + product.ln())
    }

    /// Replaces the right-hand side by the solution.
    #[inline(never)]
    pub fn solve(&mut self, b: &mut [T]) {
        self.solve_with(b, SimplicialLu::solve_transpose_in_place_with_conj);
    }

    /// Replaces the right-hand side by the solution with the transposed matrix, which is the one that was factored.
    #[inline(never)]
    pub fn solve_transposed(&mut self, b: &mut [T]) {
        self.solve_with(b, SimplicialLu::solve_in_place_with_conj);
    }

    fn solve_with(&mut self, b: &mut [T], solve: Solve) {
        let n = self.n();
        for (to, x) in self.rhs.iter_mut().zip(&b[..n]) {
            *to = x.value();
        }
        let [forward, inverse] = &self.pivots;
        solve(
            &self.lu,
            PermRef::new_checked(forward, inverse, n),
            PermRef::new_checked(&self.order[0], &self.order[1], n),
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut self.rhs, n, 1),
            Par::Seq,
            MemStack::new(&mut self.memory.buffer),
        );
        for (x, found) in b[..n].iter_mut().zip(&self.rhs) {
            *x = T::constant(*found);
        }
    }
}

/// Whether a permutation is odd: each cycle of even length turns that over.
fn is_odd(permutation: &[usize], seen: &mut [bool]) -> bool {
    seen.fill(false);
    let mut odd = false;
    for start in 0..permutation.len() {
        let mut at = start;
        while !seen[at] {
            seen[at] = true;
            at = permutation[at];
            // Going back to the start is no exchange.
            odd ^= at != start;
        }
    }
    odd
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Elimination;

    /// Column and value of the entries of row r: a band, two far entries, and a weak diagonal.
    fn row(r: usize, n: usize, seed: f64) -> Vec<(usize, f64)> {
        let x = |c: usize| (1.0 + seed + (r * 7 + c * 13) as f64).sin();
        let mut columns = vec![(r + 1) % n, r, (r + 5) % n, (r * r + 3) % n];
        columns.sort_unstable();
        columns.dedup();
        columns.rotate_left(1); // rows need not be sorted
        columns.into_iter().map(|c| (c, if c == r { 1e-3 * x(c) } else { 2.0 * x(c) })).collect()
    }

    #[test]
    fn sparse_and_dense_factors_agree_in_solution_and_sign_of_the_determinant() {
        for n in [1, 2, 3, 10, 41, 42, 43, 44, 120] {
            let columns: Vec<Vec<usize>> =
                (0..n).map(|r| row(r, n, 0.0).into_iter().map(|(c, _)| c).collect()).collect();
            for seed in [0.0, 1.0, 5.0] {
                let (mut sparse, mut dense) = (SparseLu::new(&columns), Elimination::new(n));
                for r in 0..n {
                    sparse.set_row(r, row(r, n, seed).into_iter().map(|e| e.1));
                    row(r, n, seed).into_iter().for_each(|(c, x)| dense.row_mut(r)[c] = x);
                }
                assert_eq!(sparse.factor().positive, dense.factor().positive, "n {n}, seed {seed}");
                let b: Vec<f64> = (0..n).map(|r| (r as f64).cos()).collect();
                let same = |a: &[f64], b: &[f64]| {
                    let scale = b.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9 * scale)
                };
                let (mut found, mut want) = (b.clone(), b.clone());
                sparse.solve(&mut found);
                dense.solve(&mut want);
                assert!(same(&found, &want), "n {n}, seed {seed}");
                let (mut found, mut want) = (b.clone(), b);
                sparse.solve_transposed(&mut found);
                dense.solve_transposed(&mut want);
                assert!(same(&found, &want), "n {n}, seed {seed}, transposed");
            }
        }
    }

    #[test]
    fn singular_and_not_finite_matrices_are_found_out() {
        let columns = vec![vec![0, 1], vec![0, 1]];
        let mut lu = SparseLu::new(&columns);
        for (values, good) in
            [([1.0, 2.0, 2.0, 4.0], false), ([1.0, 2.0, 2.0, 5.0], true), ([f64::NAN; 4], false)]
        {
            lu.set_row(0, values[..2].iter().copied());
            lu.set_row(1, values[2..].iter().copied());
            assert_eq!(lu.factor().pivot_ratio > 1e-12, good, "{values:?}");
        }
    }
}

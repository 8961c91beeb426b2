//! Independent rows of a matrix, for set-up, where redundancy is normal.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::order::sort_by_index;

/// Largest number of columns for which the pivot is searched in the whole matrix. The search takes n^3 operations: 10
/// ms at this size, seconds with a thousand columns, where threshold pivots in sparse rows take milliseconds.
const LARGEST_COMPLETE: usize = 100;
/// Sparse pivots are first taken from entries above this fraction of the largest entry, then above this fraction of
/// that, and so on. This is nearly complete pivoting: a small pivot never represents an independent row while a large
/// one is left.
const STAGE: f64 = 1e-2;
/// Minimum size of a sparse pivot relative to the largest entry in its row, which bounds the growth of round-off.
const THRESHOLD: f64 = 0.1;
/// Minimum size of a sparse pivot relative to the largest entry in its column. The choice of rows is final, and a row
/// with a small entry in a column is a bad choice if another has a larger one. Loops that depend on each other in
/// series amplify the error: without this limit, the rows chosen for a 20 x 20 grid of scissors have a minimum singular
/// value of 4e-9 (5e-7 with a third of it), with it 3e-3; all rows together have 1e-2.
const CHOICE: f64 = 0.9;
/// Remainders of the elimination below this fraction of the tolerance are set to zero, so that rounded redundancy does
/// not fill the rows.
const DUST: f64 = 1e-4;

/// Elimination of an m x n matrix for its rank: an independent set of rows, and the free motions that remain.
#[derive(Clone, Debug)]
pub(crate) struct FullPivot {
    /// Independent rows, best pivot first; their number is the rank.
    pub rows: Vec<usize>,
    /// A basis of the columns' null space: the non-zero entries of each vector, as (column, value).
    pub free: Vec<Vec<(usize, f64)>>,
}

impl FullPivot {
    /// Complete pivoting over the rows of the matrix in `a`. A pivot below `tolerance`, or below `tolerance` times the
    /// largest pivot, counts as zero.
    pub fn of(mut a: Vec<Vec<f64>>, n: usize, tolerance: f64) -> Self {
        let m = a.len();
        let mut rows: Vec<usize> = (0..m).collect();
        let mut columns: Vec<usize> = Vec::new();
        let mut used = vec![false; n];
        let mut largest = 0.0;
        for k in 0..m.min(n) {
            let mut best = (k, 0, 0.0);
            for r in k..m {
                for c in (0..n).filter(|&c| !used[c]) {
                    // Ties within round-off go to the earlier row and column, so that the choice is reproducible.
                    if a[r][c].abs() > best.2 * (1.0 + 1e-9) {
                        best = (r, c, a[r][c].abs());
                    }
                }
            }
            let (r, c, size) = best;
            largest = f64::max(largest, size);
            if !(size > tolerance * largest) || size < tolerance {
                break;
            }
            a.swap(r, k);
            rows.swap(r, k);
            used[c] = true;
            columns.push(c);
            // Gauss-Jordan: the pivot becomes 1, and column c is eliminated from all other rows, including those of
            // earlier pivots.
            let inverse = 1.0 / a[k][c];
            for x in &mut a[k] {
                *x *= inverse;
            }
            for r in (0..m).filter(|&r| r != k) {
                let f = a[r][c];
                if f != 0.0 {
                    for j in 0..n {
                        let x = a[k][j];
                        a[r][j] -= f * x;
                    }
                }
            }
        }
        let free = (0..n)
            .filter(|&c| !used[c])
            .map(|c| {
                // x_c = 1 and x_p = -a_kc, p the column of pivot k: the null vector that moves only c and the pivots'
                // columns
                let others = columns.iter().enumerate().map(|(k, &p)| (p, -a[k][c]));
                others.chain([(c, 1.0)]).filter(|(_, x)| *x != 0.0).collect()
            })
            .collect();
        rows.truncate(columns.len());
        Self { rows, free }
    }

    /// Elimination of sparse rows of (column, entry), each column at most once; with few columns, identical to
    /// [`of`](Self::of).
    ///
    /// With many columns, rows with few entries are eliminated first, in columns with few entries (Markowitz's rule,
    /// with threshold pivots). The cost for a block of loops is then little more than proportional to its entries.
    pub fn of_sparse(rows: Vec<Vec<(usize, f64)>>, n: usize, tolerance: f64) -> Self {
        if n > LARGEST_COMPLETE {
            return Sparse::new(rows, n).reveal(tolerance);
        }
        let dense = |row: &Vec<(usize, f64)>| {
            let mut out = vec![0.0; n];
            row.iter().for_each(|&(c, x)| out[c] = x);
            out
        };
        Self::of(rows.iter().map(dense).collect(), n, tolerance)
    }
}

/// A matrix under elimination.
struct Sparse {
    /// Entries by row, in column order; for a pivot row, the entries above the diagonal.
    rows: Vec<Vec<(usize, f64)>>,
    /// By column: rows that have, or had, an entry in it.
    rows_of: Vec<Vec<usize>>,
    /// By column: number of remaining rows with an entry in it.
    counts: Vec<usize>,
    /// By row: true if it is a pivot row.
    done: Vec<bool>,
    /// Rows to try, those with the fewest entries first; some counts may be out of date.
    queue: BinaryHeap<Reverse<(usize, usize)>>,
    /// (row, column) of each pivot.
    pivots: Vec<(usize, usize)>,
}

impl Sparse {
    fn new(mut rows: Vec<Vec<(usize, f64)>>, n: usize) -> Self {
        let (mut rows_of, mut counts) = (vec![Vec::new(); n], vec![0; n]);
        for (r, row) in rows.iter_mut().enumerate() {
            row.retain(|(_, x)| *x != 0.0);
            sort_by_index(row, |(c, _)| *c);
            for &(c, _) in row.iter() {
                rows_of[c].push(r);
                counts[c] += 1;
            }
        }
        let done = vec![false; rows.len()];
        Self { rows, rows_of, counts, done, queue: BinaryHeap::new(), pivots: Vec::new() }
    }

    fn reveal(mut self, tolerance: f64) -> FullPivot {
        let n = self.counts.len();
        let largest = self.rows.iter().flatten().map(|(_, x)| x.abs()).fold(0.0, f64::max);
        let least = f64::max(tolerance, tolerance * largest);
        // Pivots of at least 1e-2 of the largest entry first, then of 1e-4 of it, and so on down to the tolerance.
        let mut stage = f64::max(STAGE * largest, least);
        while self.pivots.len() < n && largest > 0.0 {
            let waiting = (0..self.rows.len()).filter(|&r| !self.done[r] && !self.rows[r].is_empty());
            self.queue = waiting.map(|r| Reverse((self.rows[r].len(), r))).collect();
            while let Some(Reverse((count, r))) = self.queue.pop() {
                if self.done[r] || self.rows[r].len() != count {
                    continue;
                }
                if let Some(c) = self.pivot_of(r, stage) {
                    self.eliminate(r, c, DUST * least);
                    self.ask_again(r);
                }
            }
            if !(stage > least) {
                break;
            }
            stage = f64::max(STAGE * stage, least);
        }
        let free = self.free();
        FullPivot { rows: self.pivots.into_iter().map(|(r, _)| r).collect(), free }
    }

    /// Column of row r to eliminate, if an entry is large enough in its row and column: the column with the fewest
    /// entries.
    fn pivot_of(&self, r: usize, stage: f64) -> Option<usize> {
        let most = self.rows[r].iter().map(|(_, x)| x.abs()).fold(0.0, f64::max);
        let enough = f64::max(THRESHOLD * most, stage);
        let mut large: Vec<_> = self.rows[r].iter().filter(|(_, x)| x.abs() >= enough).collect();
        sort_by_index(&mut large, |(c, _)| self.counts[*c]);
        let is_chosen = |(c, x): &&&(usize, f64)| {
            let others = self.rows_of[*c].iter().filter(|&&r| !self.done[r]);
            others.into_iter().all(|&other| self.entry(other, *c).abs() * CHOICE <= x.abs())
        };
        large.iter().find(is_chosen).map(|(c, _)| *c)
    }

    fn entry(&self, r: usize, c: usize) -> f64 {
        self.rows[r].binary_search_by_key(&c, |e| e.0).map_or(0.0, |at| self.rows[r][at].1)
    }

    /// Queues the rows that may have become eligible for a pivot because row r is now a pivot row.
    fn ask_again(&mut self, r: usize) {
        for &(column, _) in &self.rows[r] {
            for &other in self.rows_of[column].iter().filter(|&&other| !self.done[other]) {
                self.queue.push(Reverse((self.rows[other].len(), other)));
            }
        }
    }

    /// Eliminates column c from all remaining rows, with row r.
    fn eliminate(&mut self, r: usize, c: usize, dust: f64) {
        let pivot_row = std::mem::take(&mut self.rows[r]);
        let at = pivot_row.binary_search_by_key(&c, |e| e.0).expect("the pivot is an entry of its row");
        let inverse = 1.0 / pivot_row[at].1;
        self.done[r] = true;
        self.pivots.push((r, c));
        for &(column, _) in &pivot_row {
            self.counts[column] -= 1;
        }
        for other in std::mem::take(&mut self.rows_of[c]) {
            if self.done[other] {
                continue;
            }
            let Ok(at) = self.rows[other].binary_search_by_key(&c, |e| e.0) else { continue };
            // row <- row - (a_ic / a_rc) pivot row
            let factor = self.rows[other][at].1 * inverse;
            let row = std::mem::take(&mut self.rows[other]);
            self.rows[other] = self.combined(other, &row, &pivot_row, c, factor, dust);
            self.queue.push(Reverse((self.rows[other].len(), other)));
        }
        self.rows[r] = pivot_row;
    }

    /// `row - factor * pivot_row` without column c, with the counts updated.
    fn combined(
        &mut self,
        r: usize,
        row: &[(usize, f64)],
        pivot_row: &[(usize, f64)],
        c: usize,
        factor: f64,
        dust: f64,
    ) -> Vec<(usize, f64)> {
        let mut out = Vec::with_capacity(row.len() + pivot_row.len());
        let (mut a, mut b) = (row.iter().peekable(), pivot_row.iter().peekable());
        loop {
            let next = |e: Option<&&(usize, f64)>| e.map_or(usize::MAX, |e| e.0);
            let (in_row, in_pivot) = (next(a.peek()), next(b.peek()));
            let column = usize::min(in_row, in_pivot);
            if column == usize::MAX {
                return out;
            }
            let before = if in_row == column { a.next().map_or(0.0, |e| e.1) } else { 0.0 };
            let change = if in_pivot == column { b.next().map_or(0.0, |e| factor * e.1) } else { 0.0 };
            let x = before - change;
            let stays = column != c && (change == 0.0 || !(x.abs() <= dust));
            match (in_row == column, stays) {
                (true, false) => self.counts[column] -= 1,
                (false, true) => {
                    self.counts[column] += 1;
                    self.rows_of[column].push(r);
                }
                _ => {}
            }
            if stays {
                out.push((column, x));
            }
        }
    }

    /// Null vectors: one for each column without a pivot, with the resulting entries of the others.
    fn free(&self) -> Vec<Vec<(usize, f64)>> {
        let n = self.counts.len();
        let mut bound = vec![false; n];
        for &(_, c) in &self.pivots {
            bound[c] = true;
        }
        let mut v = vec![0.0; n];
        (0..n)
            .filter(|&c| !bound[c])
            .map(|free| {
                v.fill(0.0);
                v[free] = 1.0;
                for &(r, c) in self.pivots.iter().rev() {
                    let (mut sum, mut pivot) = (0.0, 1.0);
                    for &(column, x) in &self.rows[r] {
                        if column == c {
                            pivot = x;
                        } else {
                            sum += x * v[column];
                        }
                    }
                    // Back substitution from the last pivot: u_cc v_c + sum_{j != c} u_cj v_j = 0
                    v[c] = -sum / pivot;
                }
                (0..n).filter(|&c| v[c] != 0.0).map(|c| (c, v[c])).collect()
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_pivot_finds_rank_and_free_motions() {
        let a = vec![vec![1.0, 2.0, 3.0], vec![2.0, 4.0, 6.0], vec![0.0, 1.0, 1.0], vec![1.0, 3.0, 4.0]];
        let p = FullPivot::of(a.clone(), 3, 1e-10);
        assert_eq!(p.rows.len(), 2);
        assert_eq!(p.free.len(), 1);
        for row in &a {
            let s: f64 = p.free[0].iter().map(|&(c, x)| row[c] * x).sum();
            assert!(s.abs() < 1e-12);
        }
    }

    /// Loops along a strip: rows over three neighbouring columns, every third row the sum of the two before.
    fn strip(n: usize, rows: usize) -> Vec<Vec<(usize, f64)>> {
        let mut out: Vec<Vec<(usize, f64)>> = Vec::new();
        for r in 0..rows {
            let row = if r % 3 == 2 {
                let mut sum = std::collections::BTreeMap::new();
                for &(c, x) in out[r - 1].iter().chain(&out[r - 2]) {
                    *sum.entry(c).or_insert(0.0) += x;
                }
                sum.into_iter().collect()
            } else {
                let first = 2 * r / 3;
                (first..n.min(first + 3)).map(|c| (c, (1.0 + (r * 31 + c * 17) as f64).sin())).collect()
            };
            out.push(row);
        }
        out
    }

    #[test]
    fn sparse_and_complete_pivoting_agree_on_rank_and_free_motions() {
        for (n, rows) in [(150, 225), (150, 200), (150, 60), (130, 195)] {
            let matrix = strip(n, rows);
            let dense: Vec<Vec<f64>> = matrix
                .iter()
                .map(|row| {
                    let mut out = vec![0.0; n];
                    row.iter().for_each(|&(c, x)| out[c] = x);
                    out
                })
                .collect();
            let complete = FullPivot::of(dense, n, 1e-8);
            let sparse = FullPivot::of_sparse(matrix.clone(), n, 1e-8);
            assert_eq!(sparse.rows.len(), complete.rows.len(), "{rows} rows");
            assert_eq!(sparse.free.len(), n - sparse.rows.len());
            for v in &sparse.free {
                let mut speeds = vec![0.0; n];
                v.iter().for_each(|&(c, x)| speeds[c] = x);
                for row in &matrix {
                    let s: f64 = row.iter().map(|&(c, x)| x * speeds[c]).sum();
                    assert!(s.abs() < 1e-9 * v.iter().map(|e| e.1.abs()).fold(1.0, f64::max));
                }
            }
        }
    }
}

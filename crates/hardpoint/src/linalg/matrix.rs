//! Small dense systems: the Gaussian elimination of the hot path.

use crate::number::Real;

/// Growth factor of the elimination above which another order of the rows is chosen, to keep more digits.
pub(crate) const MOST_GROWTH: f64 = 4.0;

/// LU factors of the Jacobian of one block, stored for all right-hand sides of a step.
///
/// The pivot order is chosen once and monitored: it hardly ever changes from one step to the next.
#[derive(Clone, Debug)]
pub(crate) struct Elimination<T> {
    n: usize,
    /// The matrix, n x n, row-major.
    rows: Vec<T>,
    /// Factors, with rows in pivot order and the diagonal inverted.
    ///
    /// `P A = L U`, l_ii = 1: below the diagonal l_rk, above it u_kc, on it 1 / u_kk.
    a: Vec<T>,
    order: Vec<usize>,
    /// True if the pivot order is an even permutation.
    even: bool,
    /// Largest growth factor before another order is chosen.
    most_growth: f64,
    scratch: Vec<T>,
}

/// Result of a factorisation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factored<T> {
    /// Smallest pivot over the largest, a single one over at least 1; 0 if the matrix is singular or not finite.
    pub pivot_ratio: f64,
    /// True if the determinant is positive.
    pub positive: bool,
    /// Magnitude of the determinant; for a sparse matrix, its logarithm.
    pub determinant: T,
    /// Monitored quantities that the result depends on.
    pub watched: Watched<T>,
}

/// Monitored quantities of an elimination in a pivot order that was chosen before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Watched<T> {
    /// Product of the pivots; for a sparse matrix, only its sign.
    pub product: T,
    /// Largest pivot magnitude.
    pub most: T,
    /// Largest inverse of a pivot, in magnitude.
    pub least: T,
    /// Largest entry of the factor L.
    pub growth: T,
}

impl<T: Real> Watched<T> {
    pub fn zero() -> Self {
        let zero = T::zero();
        Self { product: zero, most: zero, least: zero, growth: zero }
    }

    /// Returns the ratio of the smallest to the largest pivot (0 if any is not finite), and true if the product of the
    /// pivots is positive.
    #[inline(always)]
    pub fn verdict(&self) -> (f64, bool) {
        let product = self.product.decisive();
        // NaN, which a pivot of zero produces, has no sign either.
        let regular = product.abs() > 0.0;
        // min abs(u_kk) / max abs(u_kk) = 1 / (max abs(u_kk) max abs(1 / u_kk))
        let ratio = if regular { 1.0 / (self.most.decisive() * self.least.decisive()) } else { 0.0 };
        (ratio, product > 0.0)
    }
}

impl<T: Real> Elimination<T> {
    pub fn new(n: usize) -> Self {
        let matrix = vec![T::zero(); n * n];
        Self {
            n,
            rows: matrix.clone(),
            a: matrix,
            order: (0..n).collect(),
            even: true,
            most_growth: MOST_GROWTH,
            scratch: vec![T::zero(); n],
        }
    }

    /// Row `r`, to be filled before [`Elimination::factor`].
    #[inline(always)]
    pub fn row_mut(&mut self, r: usize) -> &mut [T] {
        &mut self.rows[r * self.n..(r + 1) * self.n]
    }

    #[inline(always)]
    pub fn factor(&mut self) -> Factored<T> {
        if self.n == 0 {
            let one = T::one();
            let watched = Watched { product: one, most: one, least: one, growth: one };
            return Factored { pivot_ratio: 1.0, positive: true, determinant: one, watched };
        }
        // NaN also selects the order again.
        let (found, growth) = self.eliminate();
        if growth <= self.most_growth {
            return found;
        }
        self.choose_order();
        let (found, growth) = self.eliminate();
        // If no order is better, the limit is raised: otherwise the search would repeat at every step.
        self.most_growth = f64::max(MOST_GROWTH, 2.0 * growth);
        found
    }

    /// Eliminates in the present order; also returns the largest factor.
    #[inline(always)]
    fn eliminate(&mut self) -> (Factored<T>, f64) {
        let n = self.n;
        let (rows, a) = (&self.rows[..n * n], &mut self.a[..n * n]);
        for k in 0..n {
            let (to, from) = (&mut a[k * n..(k + 1) * n], &rows[self.order[k] * n..][..n]);
            for c in 0..n {
                to[c] = from[c];
            }
        }
        let (zero, one) = (T::zero(), T::one());
        // Largest pivot, largest inverse of a pivot, product of the pivots, and largest factor. A single pivot is
        // compared with the unit of its equation.
        let (mut most, mut least, mut determinant, mut growth) =
            (if n == 1 { one } else { zero }, zero, one, zero);
        for k in 0..n {
            let pivot = a[k * n + k];
            let inverse = one / pivot;
            a[k * n + k] = inverse;
            most = most.larger(pivot.abs());
            least = least.larger(inverse.abs());
            determinant = determinant * pivot;
            for r in k + 1..n {
                // l_rk = a_rk / u_kk,    a_rc <- a_rc - l_rk u_kc
                let m = a[r * n + k] * inverse;
                a[r * n + k] = m;
                growth = growth.larger(m.abs());
                for c in k + 1..n {
                    a[r * n + c] = (-m).times_plus(a[k * n + c], a[r * n + c]);
                }
            }
        }
        let watched = Watched { product: determinant, most, least, growth };
        let (pivot_ratio, positive) = watched.verdict();
        // det A = sign(P) prod u_kk
        let positive = positive == self.even;
        (Factored { pivot_ratio, positive, determinant: determinant.abs(), watched }, growth.decisive())
    }

    /// Chooses the pivot order by the sizes of the entries.
    #[inline(never)]
    fn choose_order(&mut self) {
        let n = self.n;
        let (a, order) = (&mut self.a[..n * n], &mut self.order[..n]);
        a.copy_from_slice(&self.rows);
        self.even = true;
        for (r, o) in order.iter_mut().enumerate() {
            *o = r;
        }
        for k in 0..n {
            let (mut best, mut size) = (k, a[k * n + k].abs().decisive());
            for r in k + 1..n {
                let s = a[r * n + k].abs().decisive();
                if s > size {
                    (best, size) = (r, s);
                }
            }
            if best != k {
                order.swap(best, k);
                for c in 0..n {
                    a.swap(best * n + c, k * n + c);
                }
                self.even = !self.even;
            }
            let inverse = T::one() / a[k * n + k];
            for r in k + 1..n {
                let m = a[r * n + k] * inverse;
                for c in k + 1..n {
                    let x = a[k * n + c];
                    a[r * n + c] -= m * x;
                }
            }
        }
    }

    /// Replaces the right-hand side by the solution.
    #[inline(always)]
    pub fn solve(&mut self, b: &mut [T]) {
        let n = self.n;
        let a = &self.a[..n * n];
        let x = &mut self.scratch[..n];
        for k in 0..n {
            // L y = P b:  y_k = b_k - sum_{c<k} l_kc y_c
            let mut s = b[self.order[k]];
            for c in 0..k {
                s = (-a[k * n + c]).times_plus(x[c], s);
            }
            x[k] = s;
        }
        for k in (0..n).rev() {
            // U x = y:  x_k = (y_k - sum_{c>k} u_kc x_c) / u_kk
            let mut s = x[k];
            for c in k + 1..n {
                s = (-a[k * n + c]).times_plus(x[c], s);
            }
            x[k] = s * a[k * n + k];
        }
        let b = &mut b[..n];
        for k in 0..n {
            b[k] = x[k];
        }
    }

    /// Replaces the right-hand side by the solution with the transposed matrix.
    ///
    /// With `P A = L U`: `U^T y = b`, `L^T z = y`, `P x = z`.
    #[inline(always)]
    pub fn solve_transposed(&mut self, b: &mut [T]) {
        let n = self.n;
        let a = &self.a[..n * n];
        let x = &mut self.scratch[..n];
        let from = &b[..n];
        for k in 0..n {
            x[k] = from[k];
        }
        for k in 0..n {
            // U^T y = b, column by column: y_k = b_k / u_kk, then subtracted from all later ones
            x[k] = x[k] * a[k * n + k];
            for c in k + 1..n {
                x[c] = (-a[k * n + c]).times_plus(x[k], x[c]);
            }
        }
        for k in (0..n).rev() {
            for c in 0..k {
                x[c] = (-a[k * n + c]).times_plus(x[k], x[c]);
            }
        }
        for k in 0..n {
            b[self.order[k]] = x[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_solve_the_system_they_were_made_from() {
        let a = [[0.0, 2.0, -1.0], [1.0, 0.5, 3.0], [4.0, -1.0, 0.2]];
        let x = [1.5, -2.0, 0.25];
        let mut lu = Elimination::new(3);
        for r in 0..3 {
            lu.row_mut(r).copy_from_slice(&a[r]);
        }
        let found = lu.factor();
        let mut b: Vec<f64> = a.iter().map(|row| row.iter().zip(x).map(|(p, q)| p * q).sum()).collect();
        lu.solve(&mut b);
        for k in 0..3 {
            assert!((b[k] - x[k]).abs() < 1e-14);
        }
        let mut b: Vec<f64> = (0..3).map(|c| (0..3).map(|r| a[r][c] * x[r]).sum()).collect();
        lu.solve_transposed(&mut b);
        for k in 0..3 {
            assert!((b[k] - x[k]).abs() < 1e-14);
        }
        let det = -2.0 * (1.0 * 0.2 - 3.0 * 4.0) - (-1.0 - 0.5 * 4.0);
        assert_eq!(found.positive, det > 0.0);
    }
}

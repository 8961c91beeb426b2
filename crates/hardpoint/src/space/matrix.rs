//! Small dense systems: the elimination of the hot path.

use super::Real;

/// LU factors of one block's Jacobian, kept for every right-hand side of a step.
///
/// Rows are pivoted by the smallest lane of their candidates, so that one order serves all lanes.
#[derive(Clone, Debug)]
pub(crate) struct Elimination<T> {
    n: usize,
    /// Row-major n x n: the matrix on entry, its factors after [`Elimination::factor`].
    a: Vec<T>,
    order: Vec<usize>,
    scratch: Vec<T>,
}

/// What a factorisation found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factored {
    /// Smallest pivot over the largest, over all lanes; 0 where singular, NaN where not finite.
    pub pivot_ratio: f64,
    /// Whether the determinant is positive (lane 0 speaks; lanes that disagree make the ratio 0).
    pub positive: bool,
}

impl<T: Real> Elimination<T> {
    pub fn new(n: usize, witness: T) -> Self {
        let o = witness.zero();
        Self { n, a: vec![o; n * n], order: (0..n).collect(), scratch: vec![o; n] }
    }

    /// Row `r`, to be filled before [`Elimination::factor`].
    #[inline(always)]
    pub fn row_mut(&mut self, r: usize) -> &mut [T] {
        &mut self.a[r * self.n..(r + 1) * self.n]
    }

    #[inline(always)]
    pub fn factor(&mut self) -> Factored {
        let n = self.n;
        let a = &mut self.a[..n * n];
        let order = &mut self.order[..n];
        for (r, o) in order.iter_mut().enumerate() {
            *o = r;
        }
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        let mut positive = true;
        let mut split = false;
        for k in 0..n {
            let (mut best, mut size) = (k, a[k * n + k].abs().smallest());
            for r in k + 1..n {
                let s = a[r * n + k].abs().smallest();
                if s > size {
                    (best, size) = (r, s);
                }
            }
            if best != k {
                order.swap(best, k);
                for c in 0..n {
                    a.swap(best * n + c, k * n + c);
                }
                positive = !positive;
            }
            let pivot = a[k * n + k];
            // Written so that a NaN pivot makes the ratio NaN or zero, never a good number.
            if !(size > 0.0) {
                return Factored { pivot_ratio: 0.0, positive };
            }
            least = least.min(size);
            most = most.max(pivot.abs().largest());
            let (low, high) = (pivot.smallest(), pivot.largest());
            split |= low < 0.0 && high > 0.0;
            positive ^= low < 0.0;
            let inverse = pivot.like(1.0) / pivot;
            a[k * n + k] = inverse;
            for r in k + 1..n {
                let m = a[r * n + k] * inverse;
                a[r * n + k] = m;
                for c in k + 1..n {
                    let x = a[k * n + c];
                    a[r * n + c] -= m * x;
                }
            }
        }
        let pivot_ratio = if n == 0 {
            1.0
        } else if split {
            0.0
        } else {
            least / most
        };
        Factored { pivot_ratio, positive }
    }

    /// Takes over the factors of a scalar system, the same in every lane.
    pub fn spread(&mut self, from: &Elimination<f64>, witness: T) {
        for (to, x) in self.a.iter_mut().zip(&from.a) {
            *to = witness.like(*x);
        }
        self.order.copy_from_slice(&from.order);
    }

    /// Replaces the right-hand side by the solution.
    #[inline(always)]
    pub fn solve(&mut self, b: &mut [T]) {
        let n = self.n;
        let a = &self.a[..n * n];
        let x = &mut self.scratch[..n];
        for k in 0..n {
            let mut s = b[self.order[k]];
            for c in 0..k {
                s -= a[k * n + c] * x[c];
            }
            x[k] = s;
        }
        for k in (0..n).rev() {
            let mut s = x[k];
            for c in k + 1..n {
                s -= a[k * n + c] * x[c];
            }
            x[k] = s * a[k * n + k];
        }
        b[..n].copy_from_slice(x);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_solve_the_system_they_were_made_from() {
        let a = [[0.0, 2.0, -1.0], [1.0, 0.5, 3.0], [4.0, -1.0, 0.2]];
        let x = [1.5, -2.0, 0.25];
        let mut lu = Elimination::new(3, 0.0);
        for r in 0..3 {
            lu.row_mut(r).copy_from_slice(&a[r]);
        }
        let found = lu.factor();
        let mut b: Vec<f64> = a.iter().map(|row| row.iter().zip(x).map(|(p, q)| p * q).sum()).collect();
        lu.solve(&mut b);
        for k in 0..3 {
            assert!((b[k] - x[k]).abs() < 1e-14);
        }
        let det = -2.0 * (1.0 * 0.2 - 3.0 * 4.0) - (-1.0 - 0.5 * 4.0);
        assert_eq!(found.positive, det > 0.0);
    }
}

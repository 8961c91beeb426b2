//! Eigenvectors of symmetric matrices.

/// Rotations of Jacobi's method stop where the entries beside the diagonal are below this fraction of it.
const DIAGONAL: f64 = 1e-16;
/// Maximum number of sweeps of Jacobi's method: it converges quadratically, mostly in six.
const SWEEPS: usize = 30;

/// Turns a symmetric matrix into the diagonal one of its eigenvalues, by Jacobi's method: its first n rows and columns.
/// The rows of `vectors` are turned along; those of the unit matrix become the unit eigenvectors.
pub(crate) fn diagonalise<R: AsRef<[f64]> + AsMut<[f64]>>(a: &mut [R], vectors: &mut [R], n: usize) {
    for _ in 0..SWEEPS {
        let mut is_diagonal = true;
        for (p, q) in (0..n).flat_map(|p| (p + 1..n).map(move |q| (p, q))) {
            let [pp, pq, qq] = [(p, p), (p, q), (q, q)].map(|(j, k): (usize, usize)| a[j].as_ref()[k]);
            if pq.abs() <= DIAGONAL * (pp * qq).abs().sqrt() {
                continue;
            }
            is_diagonal = false;
            let theta = (qq - pp) / (2.0 * pq);
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let cos = 1.0 / t.hypot(1.0);
            let sin = t * cos;
            let turned = |x: f64, y: f64| [cos * x - sin * y, sin * x + cos * y];
            for row in a.iter_mut().map(AsMut::as_mut) {
                [row[p], row[q]] = turned(row[p], row[q]);
            }
            turn_rows(a, [p, q], turned);
            turn_rows(vectors, [p, q], turned);
        }
        if is_diagonal {
            break;
        }
    }
}

/// Turns two rows into each other.
fn turn_rows<R: AsMut<[f64]>>(rows: &mut [R], [p, q]: [usize; 2], turned: impl Fn(f64, f64) -> [f64; 2]) {
    let (before, from_q) = rows.split_at_mut(q);
    let pairs = before[p].as_mut().iter_mut().zip(from_q[0].as_mut());
    pairs.for_each(|(x, y)| [*x, *y] = turned(*x, *y));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvectors_of_a_singular_and_of_an_indefinite_matrix() {
        let u = [[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]].map(|u| u.map(|x: f64| x / 3.0));
        for values in [[0.0, 4.0, 4.0 + 1e-3], [-2.0, 1.0, 2.0], [1.0, 1.0, 0.0]] {
            let entry = |j: usize, k: usize| (0..3).map(|n| values[n] * u[n][j] * u[n][k]).sum();
            let mut a: Vec<Vec<f64>> = (0..3).map(|j| (0..3).map(|k| entry(j, k)).collect()).collect();
            let unit = |j: usize| (0..3).map(|k| f64::from(u8::from(j == k))).collect();
            let mut vectors: Vec<Vec<f64>> = (0..3).map(unit).collect();
            diagonalise(&mut a, &mut vectors, 3);
            for (j, vector) in vectors.iter().enumerate() {
                let along: Vec<f64> =
                    u.iter().map(|u| u.iter().zip(vector).map(|(x, y)| x * y).sum()).collect();
                let value: f64 = (0..3).map(|n| values[n] * along[n] * along[n]).sum();
                assert!((a[j][j] - value).abs() < 1e-14, "{values:?}: {} {value}", a[j][j]);
                // A x = lambda x, along each of the known eigenvectors
                let rests = (0..3).map(|n| (values[n] - a[j][j]) * along[n]);
                assert!(rests.into_iter().all(|rest| rest.abs() < 1e-14), "{values:?}");
            }
        }
    }
}

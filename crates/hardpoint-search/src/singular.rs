//! Singular values by one-sided Jacobi rotations: small ones have the same relative accuracy as large ones.

use crate::vector::norm;

/// Columns count as perpendicular if their cosine is below this.
const PERPENDICULAR: f64 = 1e-15;
/// Maximum number of sweeps over all pairs of columns; a handful suffices.
const MOST_SWEEPS: usize = 60;

/// Singular values, largest first, and the right singular vector of each.
#[derive(Clone, Debug, Default)]
pub struct Singular {
    /// Singular values.
    pub values: Vec<f64>,
    /// Unit vectors, in the same order.
    pub directions: Vec<Vec<f64>>,
    /// Products of the matrix with the unit vectors, perpendicular to each other, as long as their singular values.
    pub images: Vec<Vec<f64>>,
}

/// Singular values of a matrix given by its rows of n numbers.
pub fn singular(rows: &[Vec<f64>], n: usize) -> Singular {
    let mut columns: Vec<Vec<f64>> = (0..n).map(|j| rows.iter().map(|row| row[j]).collect()).collect();
    let mut v: Vec<Vec<f64>> =
        (0..n).map(|j| (0..n).map(|i| f64::from(u8::from(i == j))).collect()).collect();
    for _ in 0..MOST_SWEEPS {
        let mut turned = false;
        for p in 0..n {
            for q in p + 1..n {
                // A rotation of columns p and q that makes them perpendicular
                let [a, b, c] = products(&columns[p], &columns[q]);
                if c.abs() <= PERPENDICULAR * (a * b).sqrt() {
                    continue;
                }
                turned = true;
                let zeta = (b - a) / (2.0 * c);
                let t = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
                let cos = 1.0 / (1.0 + t * t).sqrt();
                rotate(&mut columns, [p, q], cos, cos * t);
                rotate(&mut v, [p, q], cos, cos * t);
            }
        }
        if !turned {
            break;
        }
    }
    let sizes: Vec<f64> = columns.iter().map(|c| norm(c)).collect();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| sizes[*b].total_cmp(&sizes[*a]));
    Singular {
        values: order.iter().map(|k| sizes[*k]).collect(),
        directions: order.iter().map(|k| v[*k].clone()).collect(),
        images: order.iter().map(|k| columns[*k].clone()).collect(),
    }
}

/// Squares and dot product of two columns, in one pass.
fn products(a: &[f64], b: &[f64]) -> [f64; 3] {
    let n = a.len();
    let (a, b) = (&a[..n], &b[..n]);
    let mut sums = [0.0; 3];
    for k in 0..n {
        sums[0] += a[k] * a[k];
        sums[1] += b[k] * b[k];
        sums[2] += a[k] * b[k];
    }
    sums
}

/// Rotates columns p and q > p.
fn rotate(columns: &mut [Vec<f64>], [p, q]: [usize; 2], cos: f64, sin: f64) {
    let (before, after) = columns.split_at_mut(q);
    let n = after[0].len();
    let (a, b) = (&mut before[p][..n], &mut after[0][..n]);
    for k in 0..n {
        (a[k], b[k]) = (cos * a[k] - sin * b[k], sin * a[k] + cos * b[k]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_singular_values_are_as_exact_as_large_ones() {
        // Columns along perpendicular directions of sizes 3, 1e-9 and 0, turned by a rotation.
        let (c, s) = (0.6, 0.8);
        let rows =
            vec![vec![3.0 * c, 3.0 * s, 0.0], vec![-1e-9 * s, 1e-9 * c, 0.0], vec![0.0; 3], vec![0.0; 3]];
        let found = singular(&rows, 3);
        assert!((found.values[0] - 3.0).abs() < 1e-14 && (found.values[1] - 1e-9).abs() < 1e-22);
        assert!(found.values[2] == 0.0 && found.directions[2][2].abs() == 1.0);
        assert!((found.directions[0][0].abs() - c).abs() < 1e-15, "{found:?}");
        // Images of the directions are along the rows' own axes.
        let images = found.images.iter().map(|image| norm(image)).zip(&found.values);
        assert!(images.into_iter().all(|(length, value)| length == *value), "{found:?}");
    }
}

//! Symmetric positive semidefinite matrices: correlations, and the curvature of convex functions.

/// Pivots below this fraction of the largest diagonal entry count as zero: a matrix of correlations has ones on its
/// diagonal, and its coefficients are written with few digits.
const NOTHING: f64 = 1e-12;
/// Largest entry allowed in the column of a zero pivot: the square root of the rounding error.
const LEFT: f64 = 1e-6;

/// The lower triangle L with L L^T = A, row by row; columns without a pivot are zero. `None` if A is not positive
/// semidefinite.
pub fn root(a: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let n = a.len();
    let largest = (0..n).map(|k| a[k][k]).fold(0.0, f64::max);
    let mut l = vec![vec![0.0; n]; n];
    for k in 0..n {
        // d = a_kk - sum l_kj^2,  l_ik = (a_ik - sum l_ij l_kj) / sqrt(d)
        let rest = |i: usize, l: &[Vec<f64>]| {
            let (row, of_pivot) = (&l[i][..k], &l[k][..k]);
            let mut sum = 0.0;
            for j in 0..k {
                sum += row[j] * of_pivot[j];
            }
            a[i][k] - sum
        };
        let pivot = rest(k, &l);
        if !(pivot > NOTHING * largest) {
            let left = (k..n).map(|i| rest(i, &l).abs()).fold(0.0, f64::max);
            if !(pivot >= -NOTHING * largest && left <= LEFT * largest) {
                return None;
            }
            continue;
        }
        for i in k..n {
            l[i][k] = rest(i, &l) / pivot.sqrt();
        }
    }
    Some(l)
}

/// True if A is positive semidefinite, whatever the units of its rows; a row of zeros counts as such.
pub fn is_semidefinite(a: &[Vec<f64>]) -> bool {
    let rows: Vec<usize> = (0..a.len()).filter(|&r| a[r].iter().any(|x| *x != 0.0)).collect();
    // NaN is not positive.
    if !rows.iter().all(|&k| a[k][k] > 0.0) {
        return false;
    }
    let scaled = |r: usize, k: usize| a[r][k] / (a[r][r].sqrt() * a[k][k].sqrt());
    let scaled: Vec<Vec<f64>> = rows.iter().map(|&r| rows.iter().map(|&k| scaled(r, k)).collect()).collect();
    root(&scaled).is_some()
}

/// True if A is positive definite, whatever the units of its rows: scaled to ones on its diagonal, its root has all its
/// pivots.
pub fn is_definite(a: &[Vec<f64>]) -> bool {
    let n = a.len();
    let units: Vec<f64> = (0..n).map(|k| a[k][k].sqrt()).collect();
    let scaled = |r: usize, k: usize| a[r][k] / (units[r] * units[k]);
    let scaled: Vec<Vec<f64>> = (0..n).map(|r| (0..n).map(|k| scaled(r, k)).collect()).collect();
    // NaN is not positive.
    (0..n).all(|k| a[k][k] > 0.0) && root(&scaled).is_some_and(|l| (0..n).all(|k| l[k][k] > 0.0))
}

/// Solves `A x = b` in place by the root of A, which must have all its pivots.
pub fn solve(root: &[Vec<f64>], b: &mut [f64]) {
    let n = b.len();
    for k in 0..n {
        b[k] = (b[k] - (0..k).map(|j| root[k][j] * b[j]).sum::<f64>()) / root[k][k];
    }
    for k in (0..n).rev() {
        b[k] = (b[k] - (k + 1..n).map(|j| root[j][k] * b[j]).sum::<f64>()) / root[k][k];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_squares_to_its_matrix_also_where_two_go_as_one() {
        let a = vec![vec![1.0, 1.0, 0.5], vec![1.0, 1.0, 0.5], vec![0.5, 0.5, 1.0]];
        let l = root(&a).unwrap();
        for i in 0..3 {
            for j in 0..3 {
                let square: f64 = (0..3).map(|k| l[i][k] * l[j][k]).sum();
                assert!((square - a[i][j]).abs() < 1e-15, "{i} {j}: {square}");
            }
        }
        assert_eq!(l[1][1], 0.0);
    }

    #[test]
    fn incompatible_correlations_have_no_root() {
        // Two variables that are each correlated with a third, but against each other.
        assert!(
            root(&[vec![1.0, 0.9, 0.9], vec![0.9, 1.0, -0.9], vec![0.9, -0.9, 1.0]].map(|r| r)).is_none()
        );
        assert!(root(&[vec![1.0, 1.01], vec![1.01, 1.0]]).is_none());
        assert!(root(&[vec![f64::NAN]]).is_none());
    }

    #[test]
    fn definite_matrices_are_recognised_in_any_units() {
        let definite = |a: f64, b: f64, c: f64| is_definite(&[vec![a, b], vec![b, c]]);
        // Eigenvalues 3 and 1, 3 and -1, 2 and 0, -1 twice; then rows in other units.
        assert!(definite(2.0, 1.0, 2.0));
        assert!(!definite(1.0, 2.0, 1.0) && !definite(1.0, 1.0, 1.0) && !definite(-1.0, 0.0, -1.0));
        assert!(definite(2e9, 1.0, 2e-9) && !definite(1e9, 2.0, 1e-9));
        assert!(!definite(f64::NAN, 0.0, 1.0) && is_definite(&[]));
    }

    #[test]
    fn a_system_is_solved_by_the_root() {
        let a = vec![vec![4.0, 2.0], vec![2.0, 5.0]];
        let mut x = vec![8.0, 16.0];
        solve(&root(&a).unwrap(), &mut x);
        assert!((x[0] - 0.5).abs() < 1e-15 && (x[1] - 3.0).abs() < 1e-15, "{x:?}");
    }
}

//! Minimum-norm least-squares solutions of small dense systems of any rank.

/// A column is independent of the preceding ones if its remainder exceeds this, times the larger of the numbers of rows
/// and columns, relative to the largest entry: round-off leaves less.
const ROUND_OFF: f64 = f64::EPSILON;

/// The shortest `x` of those that minimise `|A x - b|`, `x = A^+ b`, for each right-hand side `b`.
///
/// `A` has m rows and n columns. With orthogonal `Q` and `V`, and column permutations `P` and `N` (a complete
/// orthogonal decomposition),
///
/// ```text
/// A P = Q (R)      R has one row per independent column;      R^T N = V (S)      S square and triangular
///         (0)                                                             (0)
///
/// x = P V (S^-T N^T c)      c: the first rows of Q^T b
///         (     0    )
/// ```
pub fn least_squares(
    [m, n]: [usize; 2],
    entry: impl Fn(usize, usize) -> f64,
    right: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let mut columns: Vec<Vec<f64>> = (0..n).map(|c| (0..m).map(|r| entry(r, c)).collect()).collect();
    // Scaling prevents squares of entries from overflowing.
    let largest =
        columns.iter().flatten().fold(0.0, |most: f64, x| if x.abs() <= most { most } else { x.abs() });
    if largest == 0.0 {
        return vec![vec![0.0; n]; right.len()];
    }
    columns.iter_mut().flatten().for_each(|x| *x /= largest);
    // Q^T A P = (R over 0), R with one row per independent column
    let q = Triangular::of(columns, ROUND_OFF * m.max(n) as f64);
    let rank = q.reflections.len();
    let row = |i: usize| (0..n).map(|j| if j < i { 0.0 } else { q.columns[j][i] }).collect();
    // V^T R^T N = (S over 0)
    let v = Triangular::of((0..rank).map(row).collect(), 0.0);
    let solution = |b: &Vec<f64>| {
        // c = Q^T b
        let mut c = b.clone();
        q.reflections.iter().for_each(|h| reflect(h, &mut c));
        let mut y = vec![0.0; n];
        for i in 0..rank {
            // S^T y = N^T c by forward substitution, since S^T is lower triangular; the rest of y is 0, which makes x
            // the shortest
            let known: f64 = (0..i).map(|k| v.columns[i][k] * y[k]).sum();
            y[i] = (c[v.order[i]] - known) / v.columns[i][i];
        }
        // x = P V y
        v.reflections.iter().rev().for_each(|h| reflect(h, &mut y));
        let mut x = vec![0.0; n];
        q.order.iter().zip(y).for_each(|(&c, y)| x[c] = y / largest);
        x
    };
    right.iter().map(solution).collect()
}

/// Square matrix with the same products of columns as a matrix with any number of rows: the factor R of `A P = Q R`,
/// its columns in their original order.
pub fn folded_rows(columns: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = columns.len();
    let mut rows = vec![vec![0.0; n]; n];
    let q = Triangular::of(columns, 0.0);
    for (column, &place) in q.columns.iter().zip(&q.order) {
        rows.iter_mut().zip(column).for_each(|(row, entry)| row[place] = *entry);
    }
    // Entries below the diagonal are meaningless.
    for (k, &place) in q.order.iter().enumerate() {
        rows[k + 1..].iter_mut().for_each(|row| row[place] = 0.0);
    }
    rows
}

/// A matrix made upper triangular by Householder reflections, with column exchanges: the longest remaining column is
/// next.
struct Triangular {
    /// Meaningless below the diagonal.
    columns: Vec<Vec<f64>>,
    /// Permutation of the columns.
    order: Vec<usize>,
    /// Unit normals of the reflections, without leading zeros; one per independent column.
    reflections: Vec<Vec<f64>>,
}

impl Triangular {
    /// Triangularises `columns`. Columns with a remainder of at most `least` count as zero.
    fn of(mut columns: Vec<Vec<f64>>, least: f64) -> Self {
        let (n, m) = (columns.len(), columns.first().map_or(0, Vec::len));
        let mut order: Vec<usize> = (0..n).collect();
        let mut reflections = Vec::new();
        for k in 0..m.min(n) {
            let longer = |a: (usize, f64), b: (usize, f64)| if b.1 > a.1 { b } else { a };
            let lengths = (k..n).map(|c| (c, norm(&columns[c][k..])));
            let (longest, length) = lengths.reduce(longer).expect("a column is left");
            // NaN propagates into all solutions.
            if length <= least {
                break;
            }
            columns.swap(k, longest);
            order.swap(k, longest);
            let mut normal = columns[k][k..].to_vec();
            // Householder: u = (a + sign(a_0) abs(a) e_0) / abs(..) mirrors a to -sign(a_0) abs(a) e_0; the sum loses
            // no digits
            normal[0] += length.copysign(normal[0]);
            let size = norm(&normal);
            normal.iter_mut().for_each(|x| *x /= size);
            columns[k..].iter_mut().for_each(|column| reflect(&normal, column));
            reflections.push(normal);
        }
        Self { columns, order, reflections }
    }
}

/// Reflects the last entries of x.
fn reflect(normal: &[f64], x: &mut [f64]) {
    let last = x.len() - normal.len();
    let twice: f64 = 2.0 * normal.iter().zip(&x[last..]).map(|(a, b)| a * b).sum::<f64>();
    // x <- x - 2 u (u . x)
    x[last..].iter_mut().zip(normal).for_each(|(x, u)| *x -= twice * u);
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    type Matrix = Vec<Vec<f64>>;

    fn product(a: &Matrix, b: &Matrix) -> Matrix {
        let columns = b.first().map_or(0, Vec::len);
        let entry = |row: &Vec<f64>, c: usize| row.iter().zip(b).map(|(x, other)| x * other[c]).sum();
        a.iter().map(|row| (0..columns).map(|c| entry(row, c)).collect()).collect()
    }

    fn transposed(a: &Matrix, n: usize) -> Matrix {
        (0..n).map(|c| a.iter().map(|row| row[c]).collect()).collect()
    }

    /// The pseudo-inverse, stored as the columns of its transpose.
    fn inverse(a: &Matrix, n: usize) -> Matrix {
        let m = a.len();
        let units: Matrix = (0..m).map(|k| (0..m).map(|r| f64::from(u8::from(r == k))).collect()).collect();
        transposed(&least_squares([m, n], |r, c| a[r][c], &units), n)
    }

    fn apart(a: &Matrix, b: &Matrix) -> f64 {
        a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    fn largest(a: &Matrix) -> f64 {
        a.iter().flatten().map(|x| x.abs()).fold(0.0, f64::max)
    }

    /// Violation of Penrose's four conditions, each relative to the compared quantities.
    fn failure(a: &Matrix, n: usize) -> f64 {
        let x = inverse(a, n);
        let (ax, xa) = (product(a, &x), product(&x, a));
        let (size, back) = (largest(a), largest(&x));
        let both = size * back + f64::MIN_POSITIVE;
        [
            apart(&product(&ax, a), a) / (size * (1.0 + both)),
            apart(&product(&xa, &x), &x) / (back * (1.0 + both) + f64::MIN_POSITIVE),
            apart(&ax, &transposed(&ax, a.len())) / both,
            apart(&xa, &transposed(&xa, n)) / both,
        ]
        .into_iter()
        .fold(0.0, f64::max)
    }

    proptest! {
        /// More rows than columns, and fewer.
        #[test]
        fn folded_rows_have_the_same_products_of_columns(
            a in (1_usize..9, 1_usize..6).prop_flat_map(|(m, n)| {
                prop::collection::vec(prop::collection::vec(-1.0..1.0_f64, n), m)
            }),
        ) {
            let n = a[0].len();
            let folded = folded_rows(transposed(&a, n));
            prop_assert_eq!([folded.len(), folded[0].len()], [n, n]);
            let gram = |a: &Matrix| product(&transposed(a, n), a);
            prop_assert!(apart(&gram(&a), &gram(&folded)) <= 1e-14 * a.len() as f64);
        }

        /// A product of an m x rank and a rank x n matrix, over the whole range of magnitudes.
        #[test]
        fn the_result_is_the_pseudo_inverse_for_all_ranks_and_sizes(
            (left, right) in (1_usize..9, 0_usize..6, 1_usize..9).prop_flat_map(|(m, rank, n)| {
                let row = |n| prop::collection::vec(-1.0..1.0_f64, n);
                (prop::collection::vec(row(rank), m), prop::collection::vec(row(n), rank))
            }),
            exponent in -200..200_i32,
        ) {
            let n = right.first().map_or(3, Vec::len);
            let mut a = if right.is_empty() { vec![vec![0.0; n]; left.len()] } else { product(&left, &right) };
            let scale = 10_f64.powi(exponent);
            // Factors that are nearly dependent have no definite rank.
            let rank = right.len().min(left.len()).min(n);
            prop_assume!(Triangular::of(transposed(&a, n), 1e-3).reflections.len() == rank);
            prop_assert!(failure(&a, n) < 1e-11, "{:e}", failure(&a, n));
            let before = inverse(&a, n);
            a.iter_mut().flatten().for_each(|x| *x *= scale);
            let mut after = inverse(&a, n);
            after.iter_mut().flatten().for_each(|x| *x *= scale);
            prop_assert!(apart(&before, &after) <= 1e-9 * largest(&before));
        }
    }

    #[test]
    fn of_many_solutions_it_is_the_shortest_and_of_none_the_nearest() {
        let solve = |rows: &[&[f64]], b: &[f64]| {
            let n = rows[0].len();
            least_squares([rows.len(), n], |r, c| rows[r][c], &[b.to_vec()]).remove(0)
        };
        let close = |found: Vec<f64>, want: &[f64]| {
            assert_eq!(found.len(), want.len());
            let apart = found.iter().zip(want).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-14, "{found:?} {want:?}");
        };
        close(solve(&[&[1.0, 2.0, 2.0]], &[9.0]), &[1.0, 2.0, 2.0]);
        close(solve(&[&[1.0], &[1.0], &[1.0]], &[1.0, 2.0, 6.0]), &[3.0]);
        close(solve(&[&[1.0, 1.0], &[1.0, 1.0]], &[1.0, 3.0]), &[1.0, 1.0]);
        close(solve(&[&[0.0, 2.0], &[0.5, 0.0]], &[4.0, 1.0]), &[2.0, 2.0]);
        close(solve(&[&[0.0, 0.0]], &[1.0]), &[0.0, 0.0]);
        assert!(solve(&[&[f64::NAN, 1.0], &[1.0, 1.0]], &[1.0, 1.0]).iter().all(|x| x.is_nan()));
    }

    #[test]
    fn nothing_has_no_solution_and_no_side_none() {
        assert_eq!(least_squares([0, 0], |_, _| 1.0, &[vec![]]), [Vec::<f64>::new()]);
        assert_eq!(least_squares([0, 2], |_, _| 1.0, &[vec![]]), [vec![0.0, 0.0]]);
        assert_eq!(least_squares([2, 0], |_, _| 1.0, &[vec![1.0, 2.0]]), [Vec::<f64>::new()]);
        assert!(least_squares([2, 2], |_, _| 1.0, &[]).is_empty());
    }
}

//! Interpolating splines of degree 3 and 5.
//!
//! The spline of degree 2m - 1 through given points is the curve that minimises ∫ (f⁽ᵐ⁾)² dt. Between two knots it is
//! the Hermite polynomial of the values and the m - 1 derivatives at both, so the integral is a quadratic form in the
//! derivatives at the knots. The matrix of this form is positive definite and couples neighbouring knots only:
//! Cholesky's method needs no pivots, and time and memory are proportional to the number of knots. Free ends are
//! natural, the derivatives at clamped ends are not unknowns, and in a periodic spline the last knot *is* the first.

use std::sync::OnceLock;

/// Coefficients between two knots: of 1, s, s², ... with s the time since the first of the two.
pub(crate) type Segment = [f64; 6];

/// Kind of boundary condition at the ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EndKind {
    Natural,
    Clamped,
    Periodic,
}

/// Gradient of h^(2m-1)/2 ∫ (f⁽ᵐ⁾)² dt by the scaled derivatives h d, h² dd at both ends. Rows and columns are in the
/// order value, derivatives, value, derivatives; the rows of the values are not needed.
///
/// This is K of `∫ (f⁽ᵐ⁾)² dt = y^T K y / h^(2m-1)`, y = (f, h d, h² dd) at both ends (`docs/theory.md` (33)).
const CUBIC: [[f64; 4]; 4] = [[0.0; 4], [6.0, 4.0, -6.0, 2.0], [0.0; 4], [6.0, 2.0, -6.0, 4.0]];
const QUINTIC: [[f64; 6]; 6] = [
    [0.0; 6],
    [360.0, 192.0, 36.0, -360.0, 168.0, -24.0],
    [60.0, 36.0, 9.0, -60.0, 24.0, -3.0],
    [0.0; 6],
    [360.0, 168.0, 24.0, -360.0, 192.0, -36.0],
    [-60.0, -24.0, -3.0, 60.0, -36.0, 9.0],
];

/// Source of the value or of a derivative at a knot.
enum Datum {
    /// Datum of the spline, by number.
    Data(usize),
    /// Unknown of the equations, by number.
    Unknown(usize),
}

/// All splines with the same knots and the same kind of ends. They are linear in their data: the values at the knots
/// (without the last, if periodic), then, if clamped, the derivatives at the start and those at the end.
#[derive(Debug)]
pub(crate) struct Basis {
    times: Vec<f64>,
    /// Number of derivatives per knot: 1 for cubics, 2 for quintics.
    rates: usize,
    ends: EndKind,
    /// The Cholesky factor L: the entries of each row from its first non-zero column to the diagonal.
    factor: Vec<Vec<f64>>,
    /// For every datum, the spline for which this datum is one and all others are zero.
    cardinals: Vec<OnceLock<Vec<Segment>>>,
}

impl Basis {
    /// Splines with these knots, strictly increasing: at least two, or three if periodic or if natural and quintic.
    pub(crate) fn new(times: &[f64], rates: usize, ends: EndKind) -> Self {
        let times = times.to_vec();
        let mut basis = Self { times, rates, ends, factor: Vec::new(), cardinals: Vec::new() };
        let data = match ends {
            EndKind::Natural => basis.times.len(),
            EndKind::Clamped => basis.times.len() + 2 * rates,
            EndKind::Periodic => basis.times.len() - 1,
        };
        basis.cardinals.resize_with(data, OnceLock::new);
        basis.factor = basis.factorised();
        basis
    }

    /// Number of data.
    pub(crate) fn len(&self) -> usize {
        self.cardinals.len()
    }

    /// The spline with these data, segment by segment.
    pub(crate) fn segments(&self, data: &[f64]) -> Vec<Segment> {
        let mut unknowns = vec![0.0; self.factor.len()];
        self.for_entries(|row, column, entry| {
            if let Datum::Data(datum) = column {
                // dE/d(unknown) = 0:  A unknowns = - sum of entry data
                unknowns[row] -= entry * data[datum];
            }
        });
        self.solve(&mut unknowns);

        let at = |knot: usize, order: usize| match self.source(knot, order) {
            Datum::Data(datum) => data[datum],
            Datum::Unknown(unknown) => unknowns[unknown],
        };
        let pairs = self.times.windows(2).enumerate();
        pairs.map(|(k, t)| hermite(t[1] - t[0], self.rates, |end, order| at(k + end, order))).collect()
    }

    /// Derivative of [`segments`](Self::segments) with respect to one of the data, itself a spline.
    pub(crate) fn cardinal(&self, datum: usize) -> &[Segment] {
        self.cardinals[datum].get_or_init(|| {
            let mut data = vec![0.0; self.len()];
            data[datum] = 1.0;
            self.segments(&data)
        })
    }

    fn source(&self, knot: usize, order: usize) -> Datum {
        let last = self.times.len() - 1;
        let knot = if self.ends == EndKind::Periodic { knot % last } else { knot };
        let is_clamped = self.ends == EndKind::Clamped;
        if order == 0 {
            Datum::Data(knot)
        } else if is_clamped && knot == 0 {
            Datum::Data(last + order)
        } else if is_clamped && knot == last {
            Datum::Data(last + self.rates + order)
        } else {
            Datum::Unknown((knot - usize::from(is_clamped)) * self.rates + order - 1)
        }
    }

    /// Calls `add` with the row of an unknown, a column, and the contribution of a segment to the matrix there.
    fn for_entries(&self, mut add: impl FnMut(usize, Datum, f64)) {
        let m = self.rates + 1;
        for (k, t) in self.times.windows(2).enumerate() {
            let h = t[1] - t[0];
            for row in 0..2 * m {
                let Datum::Unknown(unknown) = self.source(k + row / m, row % m) else {
                    continue;
                };
                for column in 0..2 * m {
                    let scaled = if m == 2 { CUBIC[row][column] } else { QUINTIC[row][column] };
                    // dE/d d_r / 2 = sum_c K_rc h^(r + c + 1 - 2m) d_c, r and c counting the derivatives 0, 1, 2   (33)
                    let power = (row % m + column % m + 1) as i32 - 2 * m as i32;
                    add(unknown, self.source(k + column / m, column % m), scaled * h.powi(power));
                }
            }
        }
    }

    /// Cholesky factor L of the matrix L L^T.
    fn factorised(&self) -> Vec<Vec<f64>> {
        let mut entries = Vec::new();
        self.for_entries(|row, column, entry| match column {
            Datum::Unknown(column) if column <= row => entries.push((row, column, entry)),
            _ => {}
        });
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for &(row, column, _) in &entries {
            rows.resize_with(rows.len().max(row + 1), Vec::new);
            let room = rows[row].len().max(row + 1 - column);
            rows[row].resize(room, 0.0);
        }
        for (row, column, entry) in entries {
            let first = row + 1 - rows[row].len();
            rows[row][column - first] += entry;
        }
        for i in 0..rows.len() {
            let (above, rest) = rows.split_at_mut(i);
            let row = &mut rest[0];
            let first = i + 1 - row.len();
            for j in first..i {
                // L_ij = (a_ij - Σ_k L_ik L_jk) / L_jj
                let other = &above[j];
                let other_first = j + 1 - other.len();
                let from = first.max(other_first);
                let sum: f64 = (from..j).map(|k| row[k - first] * other[k - other_first]).sum();
                row[j - first] = (row[j - first] - sum) / other[j - other_first];
            }
            let (diagonal, left) = row.split_last_mut().expect("a row reaches to its diagonal");
            // L_ii = sqrt(a_ii - sum_k L_ik^2)
            *diagonal = (*diagonal - left.iter().map(|entry| entry * entry).sum::<f64>()).sqrt();
        }
        rows
    }

    /// Solves L L^T x = b in place.
    fn solve(&self, b: &mut [f64]) {
        let parts = |i: usize| {
            let (diagonal, left) = self.factor[i].split_last().expect("a row reaches to its diagonal");
            (*diagonal, left, i - left.len())
        };
        for i in 0..b.len() {
            let (diagonal, left, first) = parts(i);
            let sum: f64 = left.iter().zip(&b[first..i]).map(|(l, x)| l * x).sum();
            // L y = b
            b[i] = (b[i] - sum) / diagonal;
        }
        for i in (0..b.len()).rev() {
            let (diagonal, left, first) = parts(i);
            // L^T x = y, column by column
            b[i] /= diagonal;
            for (k, l) in left.iter().enumerate() {
                b[first + k] -= l * b[i];
            }
        }
    }
}

/// Value and first two derivatives of a segment, at time s after its first knot.
pub(crate) fn segment_at(c: &Segment, s: f64) -> [f64; 3] {
    let value = c.iter().rev().fold(0.0, |sum, c| sum * s + c);
    let first = (1..6).rev().fold(0.0, |sum, k| sum * s + k as f64 * c[k]);
    let second = (2..6).rev().fold(0.0, |sum, k| sum * s + (k * (k - 1)) as f64 * c[k]);
    [value, first, second]
}

/// The polynomial over a duration h with the values and derivatives `at(end, order)` at its ends.
pub(crate) fn hermite(h: f64, rates: usize, at: impl Fn(usize, usize) -> f64) -> Segment {
    // In u = s/h, with v = h d and a = h² dd.
    let rise = at(1, 0) - at(0, 0);
    let [v0, v1] = [at(0, 1) * h, at(1, 1) * h];
    let scaled = if rates == 1 {
        [at(0, 0), v0, 3.0 * rise - 2.0 * v0 - v1, v0 + v1 - 2.0 * rise, 0.0, 0.0]
    } else {
        let [a0, a1] = [at(0, 2) * h * h, at(1, 2) * h * h];
        [
            at(0, 0),
            v0,
            0.5 * a0,
            10.0 * rise - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1,
            -15.0 * rise + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1,
            6.0 * rise - 3.0 * (v0 + v1) + 0.5 * (a1 - a0),
        ]
    };
    // sum c_k u^k = sum (c_k / h^k) s^k
    std::array::from_fn(|k| scaled[k] / h.powi(k as i32))
}

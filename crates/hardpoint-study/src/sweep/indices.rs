//! Sobol indices: the part of a metric's variance over the ranges that is due to each variable, alone and including its
//! interactions with the others.

/// Sobol indices of one metric with respect to one variable.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SobolIndex {
    /// First-order index and its standard error: part of the variance that vanishes if the variable is known.
    pub first: [f64; 2],
    /// Total index and its standard error: part of the variance that remains if all other variables are known.
    pub total: [f64; 2],
    /// Number of pairs of designs used: all designs of a pair must have the metric.
    pub pairs: usize,
}

/// Indices of a metric with respect to each variable, from its values in the designs of
/// [`SweepMethod::Indices`](hardpoint::model::SweepMethod::Indices), NaN for designs without a value. `None` if the
/// metric does not vary by more than `round_off`, or fewer than two pairs have it.
///
/// ```text
/// f0 = mean of f_A and f_B,   V = mean of ((f_A - f0)^2 + (f_B - f0)^2) / 2
/// S_i = mean of (f_B - f0) (f_ABi - f_A) / V                  (Saltelli et al. 2010)
/// T_i = mean of (f_A - f_ABi)^2 / 2 / V                       (Jansen 1999)
/// ```
///
/// A, B: independent designs; ABi: A with variable i of B. A pair with a failed design is left out for the variables
/// that need it: the indices then describe the part of the ranges where the mechanism moves. Standard errors are those
/// of quotients of means over independent pairs; evenly spread pairs are more accurate.
pub fn sobol_indices(values: &[f64], variables: usize, round_off: f64) -> Vec<Option<SobolIndex>> {
    let width = variables + 2;
    let of = |i: usize| {
        let pairs = || values.chunks_exact(width).map(move |row| [row[0], row[1], row[i + 2]]);
        let known = || pairs().filter(|p| p.iter().all(|f| f.is_finite()));
        let n = known().count() as f64;
        if n < 2.0 {
            return None;
        }
        let f0 = known().map(|[a, b, _]| 0.5 * (a + b)).sum::<f64>() / n;
        let terms = known().map(|[a, b, ab]| {
            let [a0, b0] = [a - f0, b - f0];
            [b0 * (ab - a), 0.5 * (a - ab).powi(2), 0.5 * (a0 * a0 + b0 * b0)]
        });
        let mut sums = [0.0; 3];
        terms.clone().for_each(|t| sums.iter_mut().zip(t).for_each(|(sum, t)| *sum += t));
        let [first, total, variance] = sums.map(|sum| sum / n);
        if !(variance.sqrt() > round_off) {
            return None;
        }
        let (first, total) = (first / variance, total / variance);
        // d(x/v) = (dx - (x/v) dv) / v
        let mut squares = [0.0; 2];
        for [x, y, v] in terms {
            squares[0] += (x - first * v).powi(2);
            squares[1] += (y - total * v).powi(2);
        }
        let [error, total_error] = squares.map(|s| (s / (n * (n - 1.0))).sqrt() / variance);
        Some(SobolIndex { first: [first, error], total: [total, total_error], pairs: n as usize })
    };
    (0..variables).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::Plan;
    use hardpoint::model::{SweepMethod, SweepRange, SweepSettings, VariableId};

    /// Values of a function in the designs of Sobol indices.
    fn values(pairs: usize, ranges: &[[f64; 2]], f: impl Fn(&[f64]) -> f64) -> Vec<f64> {
        let range = |(k, [low, high]): (usize, &[f64; 2])| SweepRange {
            variable: VariableId(k),
            low: *low,
            high: *high,
            levels: 2,
        };
        let settings = SweepSettings {
            method: SweepMethod::Indices,
            ranges: ranges.iter().enumerate().map(range).collect(),
            listed: Vec::new(),
            samples: pairs,
            seed: 5,
            metrics: Vec::new(),
            curves: Vec::new(),
        };
        let plan = Plan::of(&settings, ranges.len()).expect("a plan");
        (0..plan.count()).map(|k| f(&plan.swept(k))).collect()
    }

    fn close(found: &[Option<SobolIndex>], first: &[f64], total: &[f64], within: f64) {
        for (i, index) in found.iter().enumerate() {
            let index = index.expect("it varies");
            for ([x, error], exact) in [(index.first, first[i]), (index.total, total[i])] {
                assert!((x - exact).abs() < within, "variable {i}: {x} instead of {exact}");
                // Evenly spread points are at least as accurate as random ones, and no error estimate is zero.
                assert!((x - exact).abs() < 4.0 * error + 1e-12, "variable {i}: {x} +- {error}, {exact}");
            }
        }
    }

    #[test]
    fn indices_of_ishigami_are_the_closed_ones() {
        // f = sin x + 7 sin^2 y + 0.1 z^4 sin x on [-pi, pi]^3 (Ishigami and Homma 1990); V = a^2/8 + b pi^4/5 + b^2
        // pi^8/18 + 1/2.
        let (a, b, pi) = (7.0, 0.1, std::f64::consts::PI);
        let v = a * a / 8.0 + b * pi.powi(4) / 5.0 + b * b * pi.powi(8) / 18.0 + 0.5;
        let alone = [0.5 * (1.0 + b * pi.powi(4) / 5.0).powi(2), a * a / 8.0, 0.0];
        let both = 8.0 * b * b * pi.powi(8) / 225.0;
        let total = [alone[0] + both, alone[1], both];
        let f = |x: &[f64]| x[0].sin() + a * x[1].sin().powi(2) + b * x[2].powi(4) * x[0].sin();
        let found = sobol_indices(&values(1 << 13, &[[-pi, pi]; 3], f), 3, 0.0);
        close(&found, &alone.map(|x| x / v), &total.map(|x| x / v), 0.01);
    }

    #[test]
    fn indices_of_a_sum_are_its_parts_and_those_of_a_product_are_not() {
        // A sum with an idle variable: the indices are c_i^2 w_i^2 / sum, and 0.
        let ranges = [[-1.0, 1.0], [0.0, 4.0], [2.0, 3.0]];
        let parts = [4.0 * 4.0, 1.0 * 16.0, 0.0];
        let exact = parts.map(|p| p / 32.0);
        let found = sobol_indices(&values(4096, &ranges, |x| 1e3 + 2.0 * x[0] - x[1]), 3, 0.0);
        close(&found[..2], &exact[..2], &exact[..2], 2e-3);
        let idle = found[2].expect("others vary");
        assert_eq!((idle.first, idle.total), ([0.0; 2], [0.0; 2]));
        // x y on [-1, 1]^2 has no first-order effects.
        let found = sobol_indices(&values(4096, &[[-1.0, 1.0]; 2], |x| x[0] * x[1]), 2, 0.0);
        close(&found, &[0.0; 2], &[1.0; 2], 0.02);
    }

    #[test]
    fn designs_that_fail_leave_their_pairs_out() {
        let whole = values(4096, &[[0.0, 1.0]; 2], |x| 3.0 * x[0] + x[1]);
        let mut some = whole.clone();
        // Every 16th pair loses one of its designs in turn.
        some.iter_mut()
            .enumerate()
            .filter(|(k, _)| k / 4 % 16 == 0 && k % 4 == k / 64 % 4)
            .for_each(|(_, x)| *x = f64::NAN);
        let (all, found) = (sobol_indices(&whole, 2, 0.0), sobol_indices(&some, 2, 0.0));
        for (a, b) in all.iter().zip(&found) {
            let (a, b) = (a.expect("varies"), b.expect("varies"));
            assert!(b.pairs < a.pairs && b.pairs >= a.pairs * 15 / 16, "{} {}", a.pairs, b.pairs);
            assert!((a.first[0] - b.first[0]).abs() < 0.02 && (a.total[0] - b.total[0]).abs() < 0.02);
        }
        assert_eq!(sobol_indices(&[5.0; 4000], 2, 0.0), [None, None]);
        assert_eq!(sobol_indices(&[f64::NAN; 4000], 2, 0.0), [None, None]);
        // A constant with round-off, also one of about zero
        let noise: Vec<f64> = (0..4000).map(|k| 1e-15 * f64::from(k % 7 - 3)).collect();
        assert_eq!(sobol_indices(&noise, 2, 1e-12), [None, None]);
    }
}

//! Statistics of a metric over many designs, and rank correlation.

/// Distribution of a metric over the designs that have it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Distribution {
    /// Number of designs with a value.
    pub known: usize,
    /// Mean value.
    pub mean: f64,
    /// Standard deviation; 0 for a single design, and if it is round-off.
    pub sigma: f64,
    /// Quantiles at the fractions [`Distribution::PARTS`].
    pub quantiles: [f64; 5],
    /// Design with the minimum value, and that value; the first of several.
    pub least: (usize, f64),
    /// Design with the maximum value, and that value; the first of several.
    pub greatest: (usize, f64),
}

impl Distribution {
    /// Fractions of the quantiles.
    pub const PARTS: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];

    /// Distribution of a metric over all designs, with NaN for designs without a value; `None` if no design has it. A
    /// standard deviation up to `round_off` is zero.
    pub fn of(values: &[f64], round_off: f64) -> Option<Self> {
        let known = || values.iter().copied().enumerate().filter(|(_, x)| x.is_finite());
        let mut sorted: Vec<f64> = known().map(|(_, x)| x).collect();
        let first = known().next()?;
        let n = sorted.len() as f64;
        let mean = sorted.iter().sum::<f64>() / n;
        let squares: f64 = sorted.iter().map(|x| (x - mean).powi(2)).sum();
        let sigma = (squares / (n - 1.0).max(1.0)).sqrt();
        sorted.sort_by(f64::total_cmp);
        Some(Self {
            known: sorted.len(),
            mean,
            sigma: if sigma > round_off { sigma } else { 0.0 },
            quantiles: Self::PARTS.map(|part| quantile(&sorted, part)),
            least: known().fold(first, |least, one| if one.1 < least.1 { one } else { least }),
            greatest: known().fold(first, |most, one| if one.1 > most.1 { one } else { most }),
        })
    }
}

/// Quantile of sorted values at a fraction, by linear interpolation.
pub(crate) fn quantile(sorted: &[f64], part: f64) -> f64 {
    let at = part * (sorted.len() - 1) as f64;
    let (k, rest) = (at.floor() as usize, at.fract());
    sorted[k] + rest * (sorted[usize::min(k + 1, sorted.len() - 1)] - sorted[k])
}

/// Spearman's rank correlation of two series, over entries that are known in both: 1 if one always rises with the
/// other, -1 if it always falls. `None` if one of them does not vary. Entries of `b` within `round_off` are equal.
pub fn rank_correlation(a: &[f64], b: &[f64], round_off: f64) -> Option<f64> {
    let both: Vec<[f64; 2]> =
        a.iter().zip(b).map(|(a, b)| [*a, *b]).filter(|p| p.iter().all(|x| x.is_finite())).collect();
    let [a, b] = [(0, 0.0), (1, round_off)]
        .map(|(k, round_off)| ranks(both.iter().map(|p| p[k]).collect(), round_off));
    let mean = 0.5 * (both.len() as f64 - 1.0);
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| (x - mean) * (y - mean)).sum::<f64>();
    let of_both = (product(&a, &a) * product(&b, &b)).sqrt();
    (of_both > 0.0).then(|| product(&a, &b) / of_both)
}

/// Rank of every value; equal values share their mean rank, and so do those within `round_off` of the least of them.
fn ranks(values: Vec<f64>, round_off: f64) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|i, j| values[*i].total_cmp(&values[*j]));
    let mut ranks = vec![0.0; values.len()];
    let mut rest = &order[..];
    let mut rank = 0;
    while let Some(first) = rest.first() {
        let alike = rest.iter().take_while(|k| values[**k] - values[*first] <= round_off).count().max(1);
        let (these, others) = rest.split_at(alike);
        these.iter().for_each(|k| ranks[*k] = rank as f64 + 0.5 * (alike - 1) as f64);
        (rank, rest) = (rank + alike, others);
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distribution_can_be_counted_by_hand() {
        let of = Distribution::of(&[f64::NAN, 4.0, 0.0, 3.0, f64::NAN, 1.0, 2.0, 0.0], 0.0).expect("known");
        assert_eq!((of.known, of.least, of.greatest), (6, (2, 0.0), (1, 4.0)));
        assert!((of.mean - 10.0 / 6.0).abs() < 1e-15);
        assert!((of.sigma.powi(2) - (30.0 - 100.0 / 6.0) / 5.0).abs() < 1e-14);
        assert_eq!(of.quantiles, [0.0, 0.25, 1.5, 2.75, 3.75]);
        assert_eq!(Distribution::of(&[f64::NAN; 3], 0.0), None);
        assert_eq!(Distribution::of(&[1.0, 1.0 + 1e-15, 1.0], 1e-12).expect("known").sigma, 0.0);
    }

    #[test]
    fn rank_correlation_knows_order_only() {
        let x: Vec<f64> = (0..50).map(f64::from).collect();
        let cubes: Vec<f64> = x.iter().map(|x| (x - 20.0).powi(3)).collect();
        assert!((rank_correlation(&x, &cubes, 0.0).expect("varies") - 1.0).abs() < 1e-14);
        let falls: Vec<f64> = x.iter().map(|x| -x).collect();
        assert!((rank_correlation(&falls, &cubes, 0.0).expect("varies") + 1.0).abs() < 1e-14);
        assert_eq!(rank_correlation(&x, &[1.0; 50], 0.0), None);
        let constant: Vec<f64> = x.iter().map(|x| 1.0 + 1e-15 * x).collect();
        assert_eq!(rank_correlation(&x, &constant, 1e-12), None);
        // 1 - 6 sum d^2 / (n (n^2 - 1)) = 1 - 6 * 4 / (4 * 15), without ties; the fifth is not known.
        let r = rank_correlation(&[1.0, 2.0, 3.0, 4.0, 9.0], &[20.0, 10.0, 40.0, 30.0, f64::NAN], 0.0);
        assert!((r.expect("varies") - 0.6).abs() < 1e-14);
        // Ties share their rank.
        assert_eq!(ranks(vec![5.0, 1.0, 5.0, 0.0], 0.0), [2.5, 1.0, 2.5, 0.0]);
        assert_eq!(ranks(vec![5.0, 1.0, 5.0 + 1e-15, 0.0], 1e-12), [2.5, 1.0, 2.5, 0.0]);
    }
}

//! Contribution of each variable to the variance of a metric, from the model of its spread.

use super::monte_carlo::SampledMetric;
use super::spread::MetricSpread;
use hardpoint_search::dot;

/// Minimum number of sampled designs for contributions: fewer have errors of whole percents.
const ENOUGH: usize = 1000;
/// Groups of sampled designs with neighbouring deviations of a variable: minimum number of designs in each, and maximum
/// number of groups.
const PER_GROUP: usize = 200;
const MOST_GROUPS: usize = 20;
/// Number of terms of the polynomial of a group: a parabola, since few metrics are linear within an outer group.
const TERMS: i32 = 3;
/// A term is independent of the ones before if more than this fraction of it is.
const INDEPENDENT: f64 = 1e-6;

/// Model of the spread of a metric.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SpreadModel {
    /// First derivatives.
    #[default]
    Linear,
    /// First and second derivatives.
    SecondOrder,
    /// Sampled designs.
    Sampled,
}

/// Contributions to the variance of a metric.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contributions {
    /// Model that they are computed from.
    pub model: SpreadModel,
    /// Contribution of each toleranced variable as a fraction of the variance. For sampled designs these are main
    /// effects: the variance of the mean at given deviations of the variable.
    pub shares: Vec<f64>,
    /// Fraction due to interactions of several variables; `None` if it is distributed among them.
    pub together: Option<f64>,
}

impl Contributions {
    /// Contributions to the spread of a metric; `samples` are its sampled values, with the deviations of each design.
    pub(super) fn of(
        of: &MetricSpread,
        is_nonlinear: bool,
        is_correlated: bool,
        samples: Option<(&SampledMetric, &[Vec<f64>])>,
    ) -> Self {
        let samples = samples.filter(|(samples, _)| samples.known >= ENOUGH && samples.sigma[0] > 0.0);
        match (is_nonlinear, samples, &of.second_shares) {
            (true, Some((samples, deviations)), _) => {
                let effect = |v: usize| main_effect(&samples.values, |n| deviations[n][v]);
                let shares: Vec<f64> = (0..of.d.len()).map(effect).collect();
                let rest = (1.0 - shares.iter().sum::<f64>()).max(0.0);
                let together = (!is_correlated).then_some(rest);
                Self { model: SpreadModel::Sampled, shares, together }
            }
            (true, None, Some(shares)) => {
                Self { model: SpreadModel::SecondOrder, shares: shares.clone(), together: None }
            }
            (true, None, None) | (false, ..) => Self { shares: of.shares.clone(), ..Self::default() },
        }
    }
}

/// Variance of the mean at given deviations of a variable, as a fraction of the total. The mean is a parabola in each
/// group of neighbouring deviations; the scatter about it is corrected for the K coefficients of all of them.
///
/// ```text
/// S_i = 1 - (R / (n - K)) / (T / (n - 1))        R: sum of squares about the parabolas,  T: about the mean of all
/// ```
fn main_effect(values: &[f64], deviation: impl Fn(usize) -> f64) -> f64 {
    let mut known: Vec<(f64, f64)> = values
        .iter()
        .enumerate()
        .filter(|(_, x)| x.is_finite())
        .map(|(number, x)| (deviation(number), *x))
        .collect();
    known.sort_by(|a, b| a.0.total_cmp(&b.0));
    let n = known.len() as f64;
    let mean = known.iter().map(|(_, x)| x).sum::<f64>() / n;
    let all: f64 = known.iter().map(|(_, x)| (x - mean).powi(2)).sum();
    let groups = (known.len() / PER_GROUP).clamp(1, MOST_GROUPS);
    let (mut about, mut count) = (0.0, 0.0);
    for group in known.chunks(known.len().div_ceil(groups).max(1)) {
        let (squares, terms) = about_parabola(group);
        about += squares;
        count += terms as f64;
    }
    if all > 0.0 && n > count { (1.0 - about / (n - count) * (n - 1.0) / all).clamp(0.0, 1.0) } else { 0.0 }
}

/// Sum of squares of points about their parabola, and its number of coefficients. The points are in ascending order.
fn about_parabola(points: &[(f64, f64)]) -> (f64, usize) {
    let [low, high] = [points.first(), points.last()].map(|end| end.map_or(0.0, |(x, _)| *x));
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let mut rest: Vec<f64> = points.iter().map(|(_, y)| *y).collect();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let subtract = |from: &mut Vec<f64>, unit: &[f64]| {
        let by = dot(from, unit);
        from.iter_mut().zip(unit).for_each(|(x, u)| *x -= by * u);
    };
    for power in 0..TERMS {
        let scaled = |x: f64| if half > 0.0 { (x - middle) / half } else { 0.0 };
        let mut term: Vec<f64> = points.iter().map(|(x, _)| scaled(*x).powi(power)).collect();
        let whole = dot(&term, &term).sqrt();
        basis.iter().for_each(|unit| subtract(&mut term, unit));
        let own = dot(&term, &term).sqrt();
        if own > INDEPENDENT * whole {
            term.iter_mut().for_each(|x| *x /= own);
            subtract(&mut rest, &term);
            basis.push(term);
        }
    }
    (dot(&rest, &rest), basis.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::design_stream;

    /// Statistical error with 20,000 designs, as a fraction.
    const CHANCE: f64 = 0.02;

    #[test]
    fn main_effects_of_a_sum_of_squares_and_products_are_those_of_theory() {
        // y = 2 a + b^2 + c d of independent uniform deviations between -1 and 1: variances 4/3, 4/45 and 1/9. The last
        // is an interaction of c and d.
        let sample = |number: usize| {
            let mut stream = design_stream(5, number as u64);
            let mut d = [0.0; 4];
            d.iter_mut().for_each(|x| {
                let mut one = [0.0];
                crate::random::draw(hardpoint::model::Scatter::Uniform, 1.0, &mut stream, &mut one);
                *x = one[0];
            });
            d
        };
        let all: Vec<[f64; 4]> = (0..20_000).map(sample).collect();
        let values: Vec<f64> = all.iter().map(|[a, b, c, d]| 2.0 * a + b * b + c * d).collect();
        let total = 4.0 / 3.0 + 4.0 / 45.0 + 1.0 / 9.0;
        for (v, expected) in [4.0 / 3.0 / total, 4.0 / 45.0 / total, 0.0, 0.0].into_iter().enumerate() {
            let found = main_effect(&values, |n| all[n][v]);
            assert!((found - expected).abs() < CHANCE, "{v}: {found} {expected}");
        }
    }

    #[test]
    fn a_function_of_one_variable_is_its_main_effect_also_in_the_tails() {
        // x^2 and x^3 of a normal deviation have most of their variance in the outer groups.
        let draws = |number: usize| {
            let mut stream = design_stream(3, number as u64);
            let mut one = [0.0; 2];
            one.iter_mut().for_each(|x| {
                let mut y = [0.0];
                crate::random::draw(
                    hardpoint::model::Scatter::Normal { sigmas: 3.0 },
                    3.0,
                    &mut stream,
                    &mut y,
                );
                [*x] = y;
            });
            one
        };
        for count in [1000_usize, 10_000] {
            let all: Vec<[f64; 2]> = (0..count).map(draws).collect();
            for power in [2, 3] {
                let values: Vec<f64> = all.iter().map(|d| d[0].powi(power)).collect();
                let [own, other] = [0, 1].map(|v| main_effect(&values, |n| all[n][v]));
                // Means of groups, without parabolas, find 0.76 to 0.93 of x^2.
                assert!(own > 0.995, "{count} {power}: {own}");
                let chance = CHANCE * (20_000.0 / count as f64).sqrt();
                assert!(other < chance, "{count} {power}: {other}");
            }
        }
    }
}

//! Accuracy of the fitted variables: covariance, and changes that cannot be identified.

use super::fit::{FitWorkspace, SearchResult, weighed};

/// A direction whose standard deviation is more natural steps than this, about the mechanism's size, is not reported.
const VAGUE: f64 = 1.0;
/// A variable with no more than this part in what is not reported is not touched by it.
const PART: f64 = 1e-6;

/// Accuracy of the variables, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Certainty {
    /// Standard deviation of each variable that was sought; `None` where the readings do not tell it.
    pub sigmas: Vec<Option<f64>>,
    /// Their covariance, over the directions that are reported.
    pub covariance: Vec<Vec<f64>>,
    /// Changes that the readings do not determine.
    pub untold: Vec<UnidentifiableChange>,
    /// Readings that were compared, less the directions that they tell.
    pub freedom: usize,
    /// The standard deviation of the residuals: in the standard deviations that were given, where 1 is expected; in SI
    /// where none were given. `None` where there are no more readings than directions.
    pub scatter: Option<f64>,
    /// Sum of squared residuals, in standard deviations, each by what it counts.
    pub chi_square: f64,
}

/// A change of the design that changes nothing that was read, or next to nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct UnidentifiableChange {
    /// Change of each variable; the largest one is a natural step.
    pub direction: Vec<f64>,
    /// Standard deviation as a multiple of that; `None` where the readings tell nothing of it.
    pub sigma: Option<f64>,
}

/// The same in natural steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Known {
    /// Directions that are reported, with their standard deviations.
    pub told: Vec<(Vec<f64>, f64)>,
    /// Those that are not, and theirs where they have any.
    pub untold: Vec<(Vec<f64>, Option<f64>)>,
}

impl Known {
    pub fn covariance(&self, n: usize) -> Vec<Vec<f64>> {
        let entry = |i: usize, j: usize| self.told.iter().map(|(v, s)| v[i] * v[j] * s * s).sum();
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
    }
}

impl FitWorkspace<'_> {
    /// Accuracy of each direction at the end of a search.
    pub(super) fn known(&self, search: &SearchResult) -> Known {
        let (found, told) = weighed(&search.at.d, &search.weights, self.variables.len());
        let mut known = Known::default();
        let mut nothing = Vec::new();
        for (k, (s, v)) in found.values.into_iter().zip(found.directions).enumerate() {
            let sigma = search.scale / s;
            if k >= told {
                nothing.push(v);
            } else if self.has_sigmas && sigma > VAGUE {
                known.untold.push((v, Some(sigma)));
            } else {
                known.told.push((v, sigma));
            }
        }
        known.untold.extend(few_at_a_time(nothing).into_iter().map(|v| (v, None)));
        known
    }

    /// Accuracy of the variables at the end of a search.
    pub(super) fn certainty(&self, search: &SearchResult, known: &Known) -> Certainty {
        let n = self.variables.len();
        let untold_part = |k: usize| known.untold.iter().map(|(v, _)| v[k].abs()).fold(0.0, f64::max);
        let in_steps = known.covariance(n);
        let covariance = (0..n)
            .map(|i| (0..n).map(|j| in_steps[i][j] * self.steps[i] * self.steps[j]).collect::<Vec<f64>>())
            .collect::<Vec<_>>();
        let sigma = |k: usize| (untold_part(k) <= PART).then(|| covariance[k][k].sqrt());
        let sigmas = (0..n).map(sigma).collect();
        let untold = |(v, sigma): &(Vec<f64>, Option<f64>)| {
            let most = v.iter().map(|x| x.abs()).fold(0.0, f64::max);
            let direction = v.iter().zip(&self.steps).map(|(x, step)| x / most * step).collect();
            UnidentifiableChange { direction, sigma: sigma.map(|s| s * most) }
        };
        let told = known.told.len();
        let freedom = search.at.r.len().saturating_sub(told);
        let rows = search.at.r.iter().zip(&search.weights);
        let chi_square = rows.map(|(r, w)| w * (r / search.scale).powi(2)).sum::<f64>();
        let own = if self.has_sigmas { 1.0 } else { search.scale };
        let scatter = (freedom > 0).then(|| own * (chi_square / freedom as f64).sqrt());
        Certainty {
            sigmas,
            untold: known.untold.iter().map(untold).collect(),
            covariance,
            freedom,
            scatter,
            chi_square,
        }
    }
}

/// Other vectors that span the same, each with as few variables as can be: reduced row by row.
fn few_at_a_time(mut rows: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut pivots: Vec<usize> = Vec::new();
    for k in 0..rows.len() {
        let free = (0..rows[k].len()).filter(|j| !pivots.contains(j));
        let Some((row, pivot)) = free
            .flat_map(|j| (k..rows.len()).map(move |i| (i, j)))
            .max_by(|a, b| rows[a.0][a.1].abs().total_cmp(&rows[b.0][b.1].abs()))
        else {
            break;
        };
        rows.swap(k, row);
        pivots.push(pivot);
        let by = rows[k][pivot];
        rows[k].iter_mut().for_each(|x| *x /= by);
        let own = rows[k].clone();
        for (_, other) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let by = other[pivot];
            other.iter_mut().zip(&own).for_each(|(x, y)| *x -= by * y);
        }
    }
    for row in &mut rows {
        let size = row.iter().map(|x| x * x).sum::<f64>().sqrt();
        row.iter_mut().for_each(|x| *x = if x.abs() < PART * size { 0.0 } else { *x / size });
    }
    rows
}

//! Accuracy of the fitted variables: covariance, and changes that cannot be identified.

use super::fit::{FitWorkspace, SearchResult, weighed};

/// A direction with a standard deviation of more natural steps than this (about the mechanism's size) is not reported.
const VAGUE: f64 = 1.0;
/// Largest component of a variable in unreported directions at which its accuracy is still reported.
const PART: f64 = 1e-6;

/// Accuracy of the variables, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Certainty {
    /// Standard deviation of each fitted variable; `None` if the readings do not determine it.
    pub sigmas: Vec<Option<f64>>,
    /// Covariance of the fitted variables over the reported directions.
    pub covariance: Vec<Vec<f64>>,
    /// Changes that the readings do not determine.
    pub unidentifiable: Vec<UnidentifiableChange>,
    /// Degrees of freedom: number of compared readings minus number of reported directions.
    pub freedom: usize,
    /// Standard deviation of the residuals, relative to the given standard deviations, where 1 is expected; in SI if
    /// none are given. `None` if there are no more readings than directions.
    pub scatter: Option<f64>,
    /// Sum of squared residuals, in standard deviations, weighted by the loss.
    pub chi_square: f64,
}

/// Change of the design that affects no reading, or hardly any.
#[derive(Clone, Debug, PartialEq)]
pub struct UnidentifiableChange {
    /// Change of each variable, scaled so that the largest is one natural step.
    pub direction: Vec<f64>,
    /// Standard deviation as a multiple of that change; `None` if the readings do not determine it at all.
    pub sigma: Option<f64>,
}

/// Determined and undetermined directions, in natural steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Directions {
    /// Reported directions, with their standard deviations.
    pub reported: Vec<(Vec<f64>, f64)>,
    /// Unreported directions, with their standard deviations if they have any.
    pub unidentifiable: Vec<(Vec<f64>, Option<f64>)>,
}

impl Directions {
    pub fn covariance(&self, n: usize) -> Vec<Vec<f64>> {
        let entry = |i: usize, j: usize| self.reported.iter().map(|(v, s)| v[i] * v[j] * s * s).sum();
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
    }
}

impl FitWorkspace<'_> {
    /// Splits the directions at the end of a search by their accuracy.
    pub(super) fn directions(&self, search: &SearchResult) -> Directions {
        let (found, reported) = weighed(&search.at.d, &search.weights, self.variables.len());
        let mut directions = Directions::default();
        let mut nothing = Vec::new();
        for (k, (s, v)) in found.values.into_iter().zip(found.directions).enumerate() {
            let sigma = search.scale / s;
            if k >= reported {
                nothing.push(v);
            } else if self.has_sigmas && sigma > VAGUE {
                directions.unidentifiable.push((v, Some(sigma)));
            } else {
                directions.reported.push((v, sigma));
            }
        }
        directions.unidentifiable.extend(few_at_a_time(nothing).into_iter().map(|v| (v, None)));
        directions
    }

    /// Accuracy of the variables at the end of a search.
    pub(super) fn certainty(&self, search: &SearchResult, directions: &Directions) -> Certainty {
        let n = self.variables.len();
        let unidentifiable_part =
            |k: usize| directions.unidentifiable.iter().map(|(v, _)| v[k].abs()).fold(0.0, f64::max);
        let in_steps = directions.covariance(n);
        let covariance = (0..n)
            .map(|i| (0..n).map(|j| in_steps[i][j] * self.steps[i] * self.steps[j]).collect::<Vec<f64>>())
            .collect::<Vec<_>>();
        let sigma = |k: usize| (unidentifiable_part(k) <= PART).then(|| covariance[k][k].sqrt());
        let sigmas = (0..n).map(sigma).collect();
        let unidentifiable = |(v, sigma): &(Vec<f64>, Option<f64>)| {
            let most = v.iter().map(|x| x.abs()).fold(0.0, f64::max);
            let direction = v.iter().zip(&self.steps).map(|(x, step)| x / most * step).collect();
            UnidentifiableChange { direction, sigma: sigma.map(|s| s * most) }
        };
        let reported = directions.reported.len();
        let freedom = search.at.r.len().saturating_sub(reported);
        let rows = search.at.r.iter().zip(&search.weights);
        let chi_square = rows.map(|(r, w)| w * (r / search.scale).powi(2)).sum::<f64>();
        let own = if self.has_sigmas { 1.0 } else { search.scale };
        let scatter = (freedom > 0).then(|| own * (chi_square / freedom as f64).sqrt());
        Certainty {
            sigmas,
            unidentifiable: directions.unidentifiable.iter().map(unidentifiable).collect(),
            covariance,
            freedom,
            scatter,
            chi_square,
        }
    }
}

/// Basis of the same space with as few variables per vector as possible, by row reduction.
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

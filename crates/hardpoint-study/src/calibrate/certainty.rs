//! Accuracy of the fitted variables: covariance, and changes that cannot be identified.

use super::fit::{FitWorkspace, SearchResult, VAGUE, free, information};
use super::parameter::BoundSide;
use hardpoint_search::{dot, independent};

/// Largest component of a variable in directions without a standard deviation at which its accuracy is still reported.
const PART: f64 = 1e-6;

/// The readings determine a direction if at least this part of the information about it is theirs, otherwise the
/// priors do: the larger of the two.
const OF_READINGS: f64 = 0.5;

/// Accuracy of the fitted parameters, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Certainty {
    /// Standard deviation of each fitted parameter; `None` if it is not determined, or at a bound, or the search got
    /// stuck: the formula is that of an optimum.
    pub sigmas: Vec<Option<f64>>,
    /// Standard deviation of each fitted parameter by the priors alone; `None` without a prior.
    pub prior_sigmas: Vec<Option<f64>>,
    /// Mean of the own prior of each fitted parameter, as a change from the nominal design; `None` without one.
    pub prior_means: Vec<Option<f64>>,
    /// Bounds that the fitted parameters are at.
    pub bounds: Vec<Option<BoundSide>>,
    /// Covariance of the fitted variables over the directions that have a standard deviation; NaN where the search got
    /// stuck.
    pub covariance: Vec<Vec<f64>>,
    /// Changes that the readings do not determine.
    pub unidentifiable: Vec<UnidentifiableChange>,
    /// Changes that the priors determine rather than the readings.
    pub by_prior: Vec<UnidentifiableChange>,
    /// Degrees of freedom: number of compared readings and of independent priors minus number of reported directions.
    pub freedom: usize,
    /// Standard deviation of the residuals, relative to the given standard deviations, where 1 is expected; in SI if
    /// none are given. `None` if there are no more readings than directions.
    pub scatter: Option<f64>,
    /// Sum of squared residuals of readings, weighted by the loss, and of priors, in standard deviations.
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
    /// Directions that the priors determine, with their standard deviations.
    pub by_prior: Vec<(Vec<f64>, f64)>,
}

impl Directions {
    /// True if a quantity with these derivatives does not depend on unreported directions.
    pub fn determine(&self, g: &[f64]) -> bool {
        let size = dot(g, g).sqrt();
        self.unidentifiable.iter().all(|(v, _)| dot(g, v).abs() <= PART * size)
    }

    /// Covariance over all directions that have a standard deviation.
    pub fn covariance(&self, n: usize) -> Vec<Vec<f64>> {
        let vague = self.unidentifiable.iter().filter_map(|(v, s)| Some((v, (*s)?)));
        let all: Vec<_> = self.reported.iter().map(|(v, s)| (v, *s)).chain(vague).collect();
        let entry = |i: usize, j: usize| all.iter().map(|(v, s)| v[i] * v[j] * s * s).sum();
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
    }
}

impl FitWorkspace<'_> {
    /// Splits the directions at the end of a search by their accuracy.
    pub(super) fn directions(&self, search: &SearchResult) -> Directions {
        let found = self.determined(&search.at, &search.weights, search.scale, &free(&search.active));
        let mut directions = Directions::default();
        let mut by_prior = Vec::new();
        for (v, s) in found.directions {
            let (sigma, length) = (search.scale / s, self.length(&v));
            let direction = (v, s);
            let vague = self.vague_sigma(&direction, search.scale);
            let (v, s) = direction;
            if vague.is_some() {
                directions.unidentifiable.push((v.iter().map(|x| x / length).collect(), vague));
                continue;
            }
            if !self.priors.is_empty() && information(&search.at, &search.weights, &v) < OF_READINGS * s * s {
                by_prior.push((v.iter().map(|x| x / length).collect::<Vec<f64>>(), sigma * length));
            }
            directions.reported.push((v, sigma));
        }
        let with_sigma = |(w, pivot): (Vec<f64>, usize)| {
            // The part of w in a change of this space is that of the pivot, where the others are zero.
            let variance: f64 = by_prior.iter().map(|(v, s)| (v[pivot] * s).powi(2)).sum();
            let sigma = variance.sqrt() / w[pivot].abs();
            (w, sigma)
        };
        let few = few_at_a_time(by_prior.iter().map(|(v, _)| v.clone()).collect());
        directions.by_prior = few.into_iter().map(with_sigma).collect();
        let nothing = few_at_a_time(found.nothing);
        directions.unidentifiable.extend(nothing.into_iter().map(|(v, _)| (v, None)));
        directions
    }

    /// Accuracy of the parameters at the end of a search.
    pub(super) fn certainty(&self, search: &SearchResult, directions: &Directions) -> Certainty {
        let n = self.parameters.len();
        // Along a change that is not determined, a variable with a small part in it is known nevertheless.
        let is_determined = |k: usize| {
            let part = |(v, sigma): &(Vec<f64>, Option<f64>)| match sigma {
                Some(sigma) => v[k].abs() * sigma / VAGUE,
                None => v[k].abs() / PART,
            };
            directions.unidentifiable.iter().all(|of| part(of) <= 1.0)
        };
        let is_off = !search.status.has_covariance();
        let in_steps = match is_off {
            true => vec![vec![f64::NAN; n]; n],
            false => directions.covariance(n),
        };
        let covariance = (0..n)
            .map(|i| (0..n).map(|j| in_steps[i][j] * self.steps[i] * self.steps[j]).collect::<Vec<f64>>())
            .collect::<Vec<_>>();
        let is_known = |k: usize| !is_off && is_determined(k) && search.active[k].is_none();
        let sigma = |k: usize| is_known(k).then(|| covariance[k][k].sqrt());
        let sigmas = (0..n).map(sigma).collect();
        let unidentifiable = |(v, sigma): &(Vec<f64>, Option<f64>)| {
            let most = v.iter().map(|x| x.abs()).fold(0.0, f64::max);
            let direction = v.iter().zip(&self.steps).map(|(x, step)| x / most * step).collect();
            UnidentifiableChange { direction, sigma: sigma.map(|s| s * most) }
        };
        let reported = directions.reported.len();
        // The differences of a group say nothing new of members that have priors of their own.
        let priors = independent(self.priors.a.clone()).into_iter().filter(|is_new| *is_new).count();
        let freedom = (search.at.r.len() + priors).saturating_sub(reported);
        let rows = search.at.r.iter().zip(&search.weights);
        let of_readings = rows.map(|(r, w)| w * (r / search.scale).powi(2)).sum::<f64>();
        let chi_square = of_readings + search.at.priors.iter().map(|r| r * r).sum::<f64>();
        let own = if self.has_sigmas { 1.0 } else { search.scale };
        let scatter = (freedom > 0).then(|| own * (chi_square / freedom as f64).sqrt());
        // Estimated from the residuals of the readings alone
        let scatter =
            scatter.map(|s| if self.has_sigmas || self.priors.is_empty() { s } else { search.scale });
        let by_prior = directions
            .by_prior
            .iter()
            .map(|(v, sigma)| unidentifiable(&(v.clone(), (!is_off).then_some(*sigma))));
        let prior_sigmas =
            self.priors.sigmas(n).into_iter().zip(&self.steps).map(|(s, step)| Some(s? * step));
        Certainty {
            sigmas,
            prior_sigmas: prior_sigmas.collect(),
            prior_means: self.parameters.iter().map(|p| self.request.prior_mean(self.model, *p)).collect(),
            bounds: search.active.clone(),
            by_prior: by_prior.collect(),
            unidentifiable: directions.unidentifiable.iter().map(unidentifiable).collect(),
            covariance,
            freedom,
            scatter,
            chi_square,
        }
    }
}

/// Basis of the same space with as few variables per vector as possible, by row reduction: each vector with its pivot,
/// a variable that no other vector has.
fn few_at_a_time(mut rows: Vec<Vec<f64>>) -> Vec<(Vec<f64>, usize)> {
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
    rows.into_iter().zip(pivots).collect()
}

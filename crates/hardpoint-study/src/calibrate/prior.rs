//! Prior knowledge about the fitted parameters: Gaussian rows that are appended to the readings.
//!
//! A prior of a parameter with mean m and standard deviation s is the row `(b - m) / s`. A group of n variables with an
//! unknown common deviation c and `b_i = c + e_i`, `e_i ~ N(0, w^2)`, has after integration over c the exponent
//! `sum (b_i - mean)^2 / w^2`, which is that of the n - 1 orthonormal contrasts of Helmert.

use hardpoint::measure::outputs;
use hardpoint::model::{Model, Offset, OffsetSource, PriorGroup, VariableId, VariablePrior};

use super::parameter::FittedParameter;
use hardpoint_search::{dot, singular};

/// A singular value of the priors below this fraction of the largest is round-off.
const ROUND_OFF: f64 = 1e-13;
/// Largest component of a parameter in directions without a prior at which it has a prior standard deviation.
const PART: f64 = 1e-6;

/// Prior knowledge, and the offsets that are fitted in addition to the variables.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prior {
    /// Gaussian priors of variables.
    pub variables: Vec<VariablePrior>,
    /// Groups of variables with a common deviation.
    pub groups: Vec<PriorGroup>,
    /// Fitted offsets.
    pub offsets: Vec<Offset>,
}

impl Prior {
    /// True if there is no prior: only readings determine the parameters.
    pub fn is_empty(&self) -> bool {
        self.variables.is_empty() && self.groups.is_empty() && self.offsets.iter().all(|o| o.sigma.is_none())
    }
}

/// Fitted parameters of the offsets.
pub(super) fn parameters_of(model: &Model, offsets: &[Offset]) -> Vec<FittedParameter> {
    let outputs = outputs(model);
    let of = |offset: &Offset| match offset.of {
        OffsetSource::Driver(driver) => Some(FittedParameter::Driver(driver)),
        OffsetSource::Output(source) => {
            outputs.iter().position(|o| o.source == source).map(FittedParameter::Output)
        }
    };
    offsets.iter().filter_map(of).collect()
}

/// Rows of the priors: `r = A x - b` with x in natural steps.
#[derive(Clone, Debug, Default)]
pub(super) struct PriorRows {
    pub a: Vec<Vec<f64>>,
    b: Vec<f64>,
}

impl PriorRows {
    /// Rows of the fitted parameters with their natural steps.
    pub fn of(model: &Model, prior: &Prior, parameters: &[FittedParameter], steps: &[f64]) -> Self {
        let mut rows = Self::default();
        let n = parameters.len();
        let place = |of: &FittedParameter| parameters.iter().position(|p| p == of);
        let one = |k: usize, by: f64| {
            let mut row = vec![0.0; n];
            row[k] = by;
            row
        };
        for prior in &prior.variables {
            let Some(k) = place(&FittedParameter::Variable(prior.variable)) else { continue };
            rows.push(one(k, steps[k] / prior.sigma), prior.mean / prior.sigma);
        }
        for offset in &prior.offsets {
            let of = parameters_of(model, std::slice::from_ref(offset));
            if let (Some(k), Some(sigma)) = (of.first().and_then(place), offset.sigma) {
                rows.push(one(k, steps[k] / sigma), 0.0);
            }
        }
        for group in &prior.groups {
            let member = |v: &VariableId| place(&FittedParameter::Variable(*v));
            let members: Vec<usize> = group.variables.iter().filter_map(member).collect();
            for j in 1..members.len() {
                // (b_0 + ... + b_(j-1) - j b_j) / sqrt(j (j + 1))
                let scale = 1.0 / ((j * (j + 1)) as f64).sqrt() / group.within;
                let mut row = vec![0.0; n];
                members[..j].iter().for_each(|k| row[*k] = scale * steps[*k]);
                row[members[j]] = -(j as f64) * scale * steps[members[j]];
                rows.push(row, 0.0);
            }
        }
        rows
    }

    fn push(&mut self, row: Vec<f64>, right: f64) {
        self.a.push(row);
        self.b.push(right);
    }

    pub fn is_empty(&self) -> bool {
        self.a.is_empty()
    }

    /// Residuals at a point.
    pub fn residuals(&self, x: &[f64]) -> Vec<f64> {
        self.a.iter().zip(&self.b).map(|(a, b)| dot(a, x) - b).collect()
    }

    /// Coordinates in which the priors are of order one: columns `v / max(1, s)` with the singular values s and the
    /// directions v of A over some parameters; all others are zero.
    ///
    /// A narrow prior therefore does not make the directions that only readings determine look like round-off.
    pub fn whitening(&self, free: &[usize], n: usize) -> Vec<Vec<f64>> {
        let rows: Vec<Vec<f64>> = self.a.iter().map(|a| free.iter().map(|k| a[*k]).collect()).collect();
        let found = singular(&rows, free.len());
        let column = |(s, v): (&f64, &Vec<f64>)| {
            let mut column = vec![0.0; n];
            free.iter().zip(v).for_each(|(k, v)| column[*k] = v / s.max(1.0));
            column
        };
        found.values.iter().zip(&found.directions).map(column).collect()
    }

    /// Largest singular value, at least 1.
    pub fn strongest(&self, n: usize) -> f64 {
        singular(&self.a, n).values.first().copied().unwrap_or_default().max(1.0)
    }

    /// Standard deviation of each parameter by the priors alone, in natural steps; `None` if they do not determine it.
    pub fn sigmas(&self, n: usize) -> Vec<Option<f64>> {
        let found = singular(&self.a, n);
        let least = ROUND_OFF * found.values.first().copied().unwrap_or_default();
        let known: Vec<(&f64, &Vec<f64>)> =
            found.values.iter().zip(&found.directions).filter(|(s, _)| **s > least).collect();
        let unknown = |k: usize| {
            let parts = found.values.iter().zip(&found.directions).filter(|(s, _)| !(**s > least));
            parts.map(|(_, v)| v[k] * v[k]).sum::<f64>().sqrt()
        };
        let sigma = |k: usize| known.iter().map(|(s, v)| (v[k] / *s).powi(2)).sum::<f64>().sqrt();
        (0..n).map(|k| (!known.is_empty() && unknown(k) <= PART).then(|| sigma(k))).collect()
    }
}

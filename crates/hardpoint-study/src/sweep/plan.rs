//! Plan of a sweep: its designs by number.

use hardpoint::model::{Model, SweepMethod, SweepSettings};

use crate::request::RequestError;

use super::sobol::{Sobol, mixed};

/// Designs of a sweep. A design depends only on its number.
#[derive(Clone, Debug)]
pub struct Plan<'a> {
    settings: &'a SweepSettings,
    variables: usize,
    count: usize,
    sobol: Option<Sobol>,
}

impl<'a> Plan<'a> {
    /// Plans the requested designs.
    ///
    /// # Errors
    /// A [`RequestError`] if the designs cannot be chosen.
    pub fn new(settings: &'a SweepSettings, model: &Model) -> Result<Self, RequestError> {
        Self::of(settings, model.variables.len())
    }

    /// Plans the designs of a model with a number of variables.
    pub(super) fn of(settings: &'a SweepSettings, variables: usize) -> Result<Self, RequestError> {
        let count = settings.count().ok_or_else(|| {
            RequestError::invalid(
                format!("the sweep has more than {} designs", SweepSettings::MOST),
                "give fewer levels or variables, or choose the method `sobol` with a number of samples",
            )
        })?;
        if settings.ranges.is_empty() {
            return Err(RequestError::model(
                "no design variable has a range",
                "give them `bounds` in `[design]` or `[parameters]`, ranges in `[sweep.variables]`, or ranges in the request \
                 (docs/sweep.md)",
            ));
        }
        if count == 0 {
            return Err(RequestError::invalid("the sweep has no designs", "give at least one sample"));
        }
        let dimensions = match settings.method {
            SweepMethod::Sobol => settings.ranges.len(),
            SweepMethod::Indices => 2 * settings.ranges.len(),
            SweepMethod::Factorial | SweepMethod::LatinHypercube | SweepMethod::Listed => 0,
        };
        if dimensions > Sobol::MOST {
            let most = Sobol::MOST;
            return Err(RequestError::invalid(
                format!("a Sobol sequence has at most {most} variables, and {} for indices", most / 2),
                "sweep over fewer, or choose the method `latin_hypercube`",
            ));
        }
        let sobol = (dimensions > 0).then(|| Sobol::new(dimensions, settings.seed));
        Ok(Self { settings, variables, count, sobol })
    }

    /// Number of designs.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Changes of the swept variables of a design, in the order of the ranges.
    pub fn swept(&self, number: usize) -> Vec<f64> {
        // The last batch is filled up with the last design.
        let number = number.min(self.count - 1);
        let ranges = &self.settings.ranges;
        if self.settings.method == SweepMethod::Listed {
            return self.settings.listed[number].clone();
        }
        let mut stride = self.count;
        let mut rest = number;
        let value = |(d, range): (usize, &hardpoint::model::SweepRange)| {
            let part = match self.settings.method {
                SweepMethod::Factorial => {
                    stride /= range.levels;
                    let level = rest / stride;
                    rest %= stride;
                    level as f64 / (range.levels - 1).max(1) as f64
                }
                _ => self.part(number, d),
            };
            // The ends of the range are exact.
            range.low * (1.0 - part) + range.high * part
        };
        ranges.iter().enumerate().map(value).collect()
    }

    /// Values of all variables of a design.
    pub fn design(&self, number: usize) -> Vec<f64> {
        let mut design = vec![0.0; self.variables];
        for (range, x) in self.settings.ranges.iter().zip(self.swept(number)) {
            design[range.variable.0] = x;
        }
        design
    }

    /// Position of a design's variable in its range, from 0 to 1.
    fn part(&self, number: usize, d: usize) -> f64 {
        let (seed, variables) = (self.settings.seed, self.settings.ranges.len());
        match (self.settings.method, &self.sobol) {
            (SweepMethod::Sobol, Some(sobol)) => sobol.at(number, d),
            (SweepMethod::Indices, Some(sobol)) => {
                let (pair, role) = (number / (variables + 2), number % (variables + 2));
                // Roles within a pair: A, B, then A with each variable of B.
                let second = role == 1 || role == d + 2;
                sobol.at(pair, if second { variables + d } else { d })
            }
            _ => {
                let slice = permuted(number, self.count, mixed(&[seed, d as u64, 0]));
                let inside = mixed(&[seed, d as u64, 1, number as u64]);
                (slice as f64 + (inside >> 11) as f64 / 2.0_f64.powi(53)) / self.count as f64
            }
        }
    }
}

/// Image of a number under a permutation of `count` numbers: a Feistel network over the next power of 4, repeated until
/// the result is below `count`.
fn permuted(number: usize, count: usize, key: u64) -> usize {
    const ROUNDS: u64 = 6;
    let mut half = 1;
    while 1_usize << (2 * half) < count {
        half += 1;
    }
    let mask = (1_u64 << half) - 1;
    let mut x = number as u64;
    loop {
        let [mut left, mut right] = [x >> half, x & mask];
        for round in 0..ROUNDS {
            (left, right) = (right, left ^ mixed(&[key, round, right]) & mask);
        }
        x = left << half | right;
        if x < count as u64 {
            return x as usize;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_permutation_takes_every_number_to_another_one() {
        for count in [1, 2, 3, 10, 64, 65, 1000] {
            for key in 0..5 {
                let mut found: Vec<usize> = (0..count).map(|k| permuted(k, count, key)).collect();
                let moved = (0..count).filter(|k| found[*k] != *k).count();
                assert!(count < 10 || moved > count / 2, "{count} {key}");
                found.sort_unstable();
                assert!(found.into_iter().eq(0..count), "{count} {key}");
            }
        }
    }
}

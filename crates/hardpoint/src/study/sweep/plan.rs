//! The designs of a sweep, each by its number.

use crate::model::{Model, SweepMethod, SweepSettings};

use super::sobol::{Sobol, mixed};

/// The designs of a sweep. Each follows from its number alone, and from nothing that came before it.
#[derive(Clone, Debug)]
pub struct SweepPlan<'a> {
    asked: &'a SweepSettings,
    variables: usize,
    count: usize,
    sobol: Option<Sobol>,
}

/// Reason why designs cannot be chosen so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SweepPlanError {
    /// No variable changes.
    NoRanges,
    /// There are none.
    NoDesigns,
    /// There are more than [`SweepSettings::MOST`].
    TooMany,
    /// There are no Sobol sequences of that many dimensions, but of that many.
    TooManyDimensions(usize),
}

impl<'a> SweepPlan<'a> {
    /// The designs that are requested.
    ///
    /// # Errors
    /// Where they cannot be chosen.
    pub fn new(asked: &'a SweepSettings, model: &Model) -> Result<Self, SweepPlanError> {
        Self::of(asked, model.variables.len())
    }

    /// The same of a model with that many variables.
    pub(super) fn of(asked: &'a SweepSettings, variables: usize) -> Result<Self, SweepPlanError> {
        let count = asked.count().ok_or(SweepPlanError::TooMany)?;
        if asked.ranges.is_empty() {
            return Err(SweepPlanError::NoRanges);
        }
        if count == 0 {
            return Err(SweepPlanError::NoDesigns);
        }
        let dimensions = match asked.method {
            SweepMethod::Sobol => asked.ranges.len(),
            SweepMethod::Indices => 2 * asked.ranges.len(),
            _ => 0,
        };
        if dimensions > Sobol::MOST {
            return Err(SweepPlanError::TooManyDimensions(Sobol::MOST));
        }
        let sobol = (dimensions > 0).then(|| Sobol::new(dimensions, asked.seed));
        Ok(Self { asked, variables, count, sobol })
    }

    /// Total number.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The swept variables of a design, in the order of the ranges, as changes.
    pub fn swept(&self, number: usize) -> Vec<f64> {
        // What fills up the last eight: the last design once more.
        let number = number.min(self.count - 1);
        let ranges = &self.asked.ranges;
        if self.asked.method == SweepMethod::Listed {
            return self.asked.listed[number].clone();
        }
        let mut stride = self.count;
        let mut rest = number;
        let value = |(d, range): (usize, &crate::model::SweepRange)| {
            let part = match self.asked.method {
                SweepMethod::Factorial => {
                    stride /= range.levels;
                    let level = rest / stride;
                    rest %= stride;
                    level as f64 / (range.levels - 1).max(1) as f64
                }
                _ => self.part(number, d),
            };
            // The ends are met exactly.
            range.low * (1.0 - part) + range.high * part
        };
        ranges.iter().enumerate().map(value).collect()
    }

    /// The values of all variables of a design.
    pub fn design(&self, number: usize) -> Vec<f64> {
        let mut design = vec![0.0; self.variables];
        for (range, x) in self.asked.ranges.iter().zip(self.swept(number)) {
            design[range.variable.0] = x;
        }
        design
    }

    /// Position of a design's variable in its range, from 0 to 1.
    fn part(&self, number: usize, d: usize) -> f64 {
        let (seed, variables) = (self.asked.seed, self.asked.ranges.len());
        match (self.asked.method, &self.sobol) {
            (SweepMethod::Sobol, Some(sobol)) => sobol.at(number, d),
            (SweepMethod::Indices, Some(sobol)) => {
                let (pair, role) = (number / (variables + 2), number % (variables + 2));
                // A, B, then A with each variable of B.
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

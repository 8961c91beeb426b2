//! Settings of a sweep: the designs, and the results that are stored.

use super::{Change, Model, VariableId};

/// Sweep of many designs, with the stored results of each.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepSettings {
    /// Method that chooses designs within the ranges.
    pub method: SweepMethod,
    /// The variables that change, and how far. All others stay in the design configuration. Of a list, the variables
    /// that it has.
    pub ranges: Vec<SweepRange>,
    /// The designs of a list: per design, the values of the variables of `ranges`, as changes.
    pub listed: Vec<Vec<f64>>,
    /// Number of designs; for Sobol indices the number of pairs of designs. Grids and lists define their own number.
    pub samples: usize,
    /// Seed of the random numbers; the same seed gives the same designs.
    pub seed: u64,
    /// The metrics that are kept, by their places in [`Model::metrics`]. One that names no case counts in each of them.
    pub metrics: Vec<usize>,
    /// The measures whose whole curves are kept, by their places in [`Model::measures`].
    pub curves: Vec<usize>,
}

/// Method that chooses the designs of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SweepMethod {
    /// Every combination of evenly spaced values.
    Factorial,
    /// Latin hypercube: every range is divided into N slices for N designs, and each slice has one design at random.
    LatinHypercube,
    /// Points that fill the ranges uniformly for any number of designs: a scrambled Sobol sequence.
    Sobol,
    /// Pairs of such points, and for every variable the first of a pair with that variable of the second, for
    /// estimating Sobol indices.
    Indices,
    /// The listed designs.
    Listed,
}

/// Range of a variable in a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepRange {
    /// The variable.
    pub variable: VariableId,
    /// From this change of it, in its unit.
    pub low: f64,
    /// To this one.
    pub high: f64,
    /// In a factorial, that many values, both ends among them.
    pub levels: usize,
}

impl SweepMethod {
    /// Names of the methods that a file can select by name, in the order of the variants.
    pub const NAMES: [&str; 4] = ["factorial", "latin_hypercube", "sobol", "sobol_indices"];

    /// Methods with these names.
    pub const NAMED: [Self; 4] = [Self::Factorial, Self::LatinHypercube, Self::Sobol, Self::Indices];

    /// As model files and summaries write it.
    pub fn name(self) -> &'static str {
        Self::NAMED.iter().position(|m| *m == self).map_or("listed", |k| Self::NAMES[k])
    }
}

impl SweepSettings {
    /// Default number of designs.
    pub const SAMPLES: usize = 1000;
    /// Default seed.
    pub const SEED: u64 = 1;
    /// A factorial has that many values of a variable where nothing else is said.
    pub const LEVELS: usize = 3;
    /// More designs than these are surely a slip.
    pub const MOST: usize = 1_000_000_000;

    /// Default settings: Sobol designs of all variables that have bounds, and every metric.
    pub fn of_bounds(model: &Model) -> Self {
        let ranges = model.variables.iter().enumerate().filter_map(|(k, variable)| {
            let [low, high] = variable.bounds?;
            Some(SweepRange { variable: VariableId(k), low, high, levels: Self::LEVELS })
        });
        Self {
            method: SweepMethod::Sobol,
            ranges: ranges.collect(),
            listed: Vec::new(),
            samples: Self::SAMPLES,
            seed: Self::SEED,
            metrics: (0..model.metrics.len()).collect(),
            curves: Vec::new(),
        }
    }

    /// Ranges that the columns of a list of designs span.
    pub fn spanned(variables: &[VariableId], rows: &[Vec<f64>]) -> Vec<SweepRange> {
        let of = |(k, variable): (usize, &VariableId)| {
            let column = || rows.iter().map(move |row| row[k]);
            let (low, high) =
                (column().fold(f64::INFINITY, f64::min), column().fold(f64::NEG_INFINITY, f64::max));
            SweepRange { variable: *variable, low, high, levels: Self::LEVELS }
        };
        variables.iter().enumerate().map(of).collect()
    }

    /// Number of designs; `None` above [`MOST`](Self::MOST).
    pub fn count(&self) -> Option<usize> {
        let count = match self.method {
            SweepMethod::Factorial => self.ranges.iter().try_fold(1_usize, |n, r| n.checked_mul(r.levels)),
            SweepMethod::LatinHypercube | SweepMethod::Sobol => Some(self.samples),
            SweepMethod::Indices => self.samples.checked_mul(self.ranges.len() + 2),
            SweepMethod::Listed => Some(self.listed.len()),
        };
        count.filter(|n| *n <= Self::MOST)
    }
}

impl Model {
    /// Value of a variable in the nominal design, in its unit, from which its bounds and ranges count: a parameter's
    /// own value, and 0 for all variables that describe a change.
    pub fn nominal_value(&self, variable: VariableId) -> f64 {
        let variable = &self.variables[variable.0];
        let own = variable.changes.iter().find_map(Change::parameter);
        own.map(|(p, _)| &self.parameters[p.0]).filter(|p| p.name == variable.name).map_or(0.0, |p| p.value)
    }
}

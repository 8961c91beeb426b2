//! Settings of a sweep as written.

use crate::model::{SweepMethod, SweepSettings};

/// Settings of a sweep; see [`SweepSettings`].
#[derive(Clone, Debug)]
pub struct SweepSettingsDraft {
    /// Method that chooses the designs, if given.
    pub method: Option<SweepMethod>,
    /// Ranges of the variables; if `None`, the bounds of all variables that have bounds.
    pub ranges: Option<Vec<SweepRangeDraft>>,
    /// List of designs, which replaces the method and the ranges.
    pub designs: Option<DesignListDraft>,
    /// Number of levels of a factorial for variables without their own.
    pub levels: usize,
    /// Number of designs.
    pub samples: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Names of the metrics; all if `None`.
    pub metrics: Option<Vec<String>>,
    /// Names of the measures whose curves are stored.
    pub curves: Vec<String>,
}

impl Default for SweepSettingsDraft {
    fn default() -> Self {
        Self {
            method: None,
            ranges: None,
            designs: None,
            levels: SweepSettings::LEVELS,
            samples: SweepSettings::SAMPLES,
            seed: SweepSettings::SEED,
            metrics: None,
            curves: Vec::new(),
        }
    }
}

/// A range of a variable; see [`SweepRange`](crate::model::SweepRange). Its ends are in user units; those of a
/// parameter are values of the parameter.
#[derive(Clone, Debug)]
pub struct SweepRangeDraft {
    /// The variable's name.
    pub name: String,
    /// Lower end; the variable's lower bound if left out.
    pub low: Option<f64>,
    /// Upper end; the variable's upper bound if left out.
    pub high: Option<f64>,
    /// Number of levels in a factorial.
    pub levels: Option<usize>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// Designs listed in a file, with values as in a range.
#[derive(Clone, Debug)]
pub struct DesignListDraft {
    /// Name of the file.
    pub file: String,
    /// Name of the variable of each column.
    pub names: Vec<String>,
    /// Values of each design.
    pub rows: Vec<Vec<f64>>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

//! Metrics as written.

use crate::model::Reduction;

/// A metric; see [`Metric`](crate::model::Metric). Its numbers are in user units, because their dimension follows from
/// the measures.
#[derive(Clone, Debug)]
pub struct MetricDraft {
    /// Name.
    pub name: String,
    /// Name of a measure, or of a component of a point.
    pub of: String,
    /// Name of the abscissa, likewise; time if `None`.
    pub over: Option<String>,
    /// Reduction of the curve.
    pub take: Reduction,
    /// Range of the abscissa that is evaluated.
    pub window: Option<[f64; 2]>,
    /// Name of the case that is evaluated; all cases if `None`.
    pub case: Option<String>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

//! Settings of a calibration as written.

/// Settings of a calibration; see [`CalibrationSettings`](crate::model::CalibrationSettings).
#[derive(Clone, Debug, Default)]
pub struct CalibrationSettingsDraft {
    /// Names of the fitted variables; all if `None`.
    pub fitted: Option<Vec<String>>,
    /// Priors of variables.
    pub priors: Vec<PriorDraft>,
    /// True if the tolerances of variables are the priors of all others.
    pub tolerance_priors: bool,
    /// Groups of variables with a common deviation.
    pub groups: Vec<PriorGroupDraft>,
    /// Fitted offsets.
    pub offsets: Vec<OffsetDraft>,
}

/// Gaussian prior of a variable; see [`VariablePrior`](crate::model::VariablePrior). In user units.
#[derive(Clone, Debug)]
pub struct PriorDraft {
    /// Name of the design variable.
    pub name: String,
    /// Standard deviation.
    pub sigma: f64,
    /// Mean of its value; the nominal value if `None`.
    pub mean: Option<f64>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// Group of variables with a common deviation; see [`PriorGroup`](crate::model::PriorGroup). In user units.
#[derive(Clone, Debug)]
pub struct PriorGroupDraft {
    /// Name.
    pub name: String,
    /// Names of its members.
    pub variables: Vec<String>,
    /// Standard deviation of a member from the common deviation.
    pub within: f64,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// Offset of a driver or an output; see [`Offset`](crate::model::Offset). In user units.
#[derive(Clone, Debug)]
pub struct OffsetDraft {
    /// Name of the driver or output.
    pub name: String,
    /// Standard deviation of its prior about 0; `None` without a prior.
    pub sigma: Option<f64>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

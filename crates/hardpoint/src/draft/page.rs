//! Plots and named designs as written.

/// A plot; see [`Plot`](crate::model::Plot).
#[derive(Clone, Debug)]
pub struct PlotDraft {
    /// Names of the outputs on the ordinate.
    pub y: Vec<String>,
    /// Name of the output on the abscissa, or [`TIME`](Self::TIME).
    pub over: String,
}

impl PlotDraft {
    /// Abscissa of a plot over time, unless a measure has that name.
    pub const TIME: &'static str = "time";
}

/// A named design; see [`NamedDesign`](crate::model::NamedDesign).
#[derive(Clone, Debug)]
pub struct NamedDesignDraft {
    /// Name.
    pub name: String,
    /// Names of variables with their values in user units; those of a parameter are values of the parameter.
    pub values: Vec<(String, f64)>,
    /// Length units of the file per metre.
    pub per_metre: f64,
    /// Angle units of the file per radian.
    pub per_radian: f64,
}

//! Errors of a draft, with their location and remedy.

use std::fmt;

/// Error of a draft. The check reports all errors of a draft at once.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct DraftError {
    /// Stable code, `HP02..`; documented in `docs/diagnostics.md`.
    pub code: &'static str,
    /// Location in the draft.
    pub at: DraftLocation,
    /// Headline that is complete by itself: the fault, subject first.
    pub message: String,
    /// Facts, with units.
    pub notes: Vec<String>,
    /// Instruction that corrects the error.
    pub help: Option<String>,
}

impl DraftError {
    pub(crate) fn note(&mut self, note: impl Into<String>) -> &mut Self {
        self.notes.push(note.into());
        self
    }

    pub(crate) fn help(&mut self, help: impl Into<String>) -> &mut Self {
        self.help = Some(help.into());
        self
    }
}

/// List of the draft, with the table of the model file that it comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Section {
    /// The draft as a whole.
    Model,
    /// [`super::Draft::parameters`].
    Parameters,
    /// [`super::Draft::hardpoints`].
    Hardpoints,
    /// [`super::Draft::bodies`].
    Bodies,
    /// [`super::Draft::joints`].
    Joints,
    /// [`super::Draft::couplers`].
    Couplers,
    /// [`super::Draft::drivers`].
    Drivers,
    /// [`super::Draft::start`].
    Start,
    /// [`super::Draft::design`].
    Design,
    /// [`super::Draft::points`].
    Points,
    /// [`super::Draft::vehicle`].
    Vehicle,
    /// [`super::Draft::wheels`].
    Wheels,
    /// [`super::Draft::axles`].
    Axles,
    /// [`super::Draft::shapes`].
    Shapes,
    /// [`super::Draft::clearances`].
    Clearances,
    /// [`super::Draft::masses`].
    Masses,
    /// [`super::Draft::forces`].
    Forces,
    /// [`super::Draft::equilibrium`].
    Equilibrium,
    /// [`super::Draft::measures`].
    Measures,
    /// [`super::Draft::joint_limits`].
    JointLimits,
    /// [`super::Draft::metrics`].
    Metrics,
    /// [`super::Draft::times`].
    Time,
    /// [`super::Draft::cases`].
    Cases,
    /// [`super::Draft::grids`].
    Grids,
    /// [`super::Draft::optimization`].
    Optimize,
    /// [`super::OptimizationSettingsDraft::goals`].
    Goals,
    /// [`super::OptimizationSettingsDraft::limits`].
    Limits,
    /// [`super::Draft::tolerancing`].
    Tolerance,
    /// [`super::ToleranceSettingsDraft::tolerances`].
    Tolerances,
    /// [`super::ToleranceSettingsDraft::correlations`].
    Correlations,
    /// [`super::ToleranceSettingsDraft::limits`].
    ToleranceLimits,
    /// [`super::Draft::sweeping`].
    Sweep,
    /// [`super::SweepSettingsDraft::ranges`].
    SweepRanges,
    /// [`super::Draft::calibrating`].
    Calibrate,
    /// [`super::CalibrationSettingsDraft::priors`].
    Priors,
    /// [`super::CalibrationSettingsDraft::groups`].
    PriorGroups,
    /// [`super::CalibrationSettingsDraft::offsets`].
    Offsets,
    /// [`super::Draft::plots`].
    Plots,
    /// [`super::Draft::designs`].
    Designs,
}

/// Location in a draft.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct DraftLocation {
    /// List that contains the entry.
    pub section: Section,
    /// Index of the entry.
    pub index: usize,
    /// Field of the entry, by its name in model files (`axis`, `bodies`, `name`, ...).
    pub key: &'static str,
    /// Element of the field, if it is a list (`at`, `bodies`, `changes`, `through`).
    pub item: Option<usize>,
}

impl fmt::Display for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Model => "model",
            Self::Parameters => "parameters",
            Self::Hardpoints => "hardpoints",
            Self::Bodies => "bodies",
            Self::Joints => "joints",
            Self::Couplers => "couplers",
            Self::Drivers => "drivers",
            Self::Start => "start",
            Self::Design => "design",
            Self::Points => "points",
            Self::Vehicle => "vehicle",
            Self::Wheels => "wheels",
            Self::Axles => "axles",
            Self::Shapes => "shapes",
            Self::Clearances => "clearances",
            Self::Masses => "masses",
            Self::Forces => "forces",
            Self::Equilibrium => "equilibrium",
            Self::Measures => "measures",
            Self::Metrics => "metrics",
            Self::Time => "time",
            Self::Cases | Self::Grids => "cases",
            Self::Optimize => "optimize",
            Self::Goals => "goals",
            Self::JointLimits | Self::Limits | Self::ToleranceLimits => "limits",
            Self::Tolerance => "tolerance",
            Self::Tolerances | Self::SweepRanges | Self::Priors => "variables",
            Self::Correlations => "correlations",
            Self::Sweep => "sweep",
            Self::Calibrate => "calibrate",
            Self::PriorGroups => "groups",
            Self::Offsets => "offsets",
            Self::Plots => "plots",
            Self::Designs => "designs",
        })
    }
}

/// Number of a message: short also if it is very large or small.
pub(crate) fn short(x: f64) -> String {
    let is_plain = x == 0.0 || !x.is_finite() || (1e-4..1e9).contains(&x.abs());
    if is_plain { x.to_string() } else { format!("{x:e}") }
}

/// Number of a message with that many significant digits at most.
pub(crate) fn with_digits(x: f64, digits: usize) -> String {
    short(format!("{x:.*e}", digits - 1).parse().unwrap_or(x))
}

/// Joins items with a separator. A longer list is cut after `most` items, with the number of the others.
pub fn some_of(items: &[impl AsRef<str>], separator: &str, most: usize) -> String {
    let shown: Vec<&str> = items.iter().take(most).map(AsRef::as_ref).collect();
    match items.len().saturating_sub(most) {
        0 => shown.join(separator),
        more => format!("{} and {more} more", shown.join(separator)),
    }
}

/// Returns the candidate closest to a misspelt name, if at most a third of the letters differ.
pub fn did_you_mean<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    closest(name, &mut candidates.into_iter())
}

fn closest<'a>(name: &str, candidates: &mut dyn Iterator<Item = &'a str>) -> Option<&'a str> {
    let lower = name.to_lowercase();
    let length = name.chars().count();
    candidates
        .filter_map(|c| {
            let other = c.chars().count();
            let allowed = (usize::min(length, other) + 1) / 3;
            // The edit distance is at least the difference in length, which excludes most candidates.
            let distance = (length.abs_diff(other) <= allowed)
                .then(|| strsim::damerau_levenshtein(&lower, &c.to_lowercase()))?;
            (distance <= allowed).then_some((distance, c))
        })
        .min_by_key(|(d, _)| *d)
        .map(|(_, c)| c)
}

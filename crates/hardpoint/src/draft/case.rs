//! Cases and grids as written.

use crate::law::Law;
use crate::model::LoadMode;

/// One of several motions; see [`Case`](crate::model::Case).
#[derive(Clone, Debug, Default)]
pub struct CaseDraft {
    /// Name.
    pub name: String,
    /// Names of drivers, and their laws in this case, m or rad.
    pub laws: Vec<(String, Law)>,
    /// Motion of all other drivers.
    pub rest: OtherDrivers,
    /// Output times, s; those of the draft if `None`.
    pub times: Option<Vec<f64>>,
    /// Loads with or without inertia; the mode of the draft if `None`.
    pub load_mode: Option<LoadMode>,
}

/// Motion of the drivers that a case does not name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OtherDrivers {
    /// Fixed in the design configuration.
    #[default]
    Held,
    /// Own laws, as in the model.
    AsAbove,
}

/// A case that sweeps two drivers over a grid; see [`Grid`](crate::model::Grid).
#[derive(Clone, Debug, Default)]
pub struct GridDraft {
    /// Name.
    pub name: String,
    /// Names of two drivers, and the positions of each, from the design configuration, m or rad.
    pub sweeps: Vec<(String, Vec<f64>)>,
}

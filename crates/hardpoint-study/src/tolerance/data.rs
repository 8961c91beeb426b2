//! Data of a tolerance study: its motions, the nominal design, and the deviations of the variables.

use hardpoint::model::{Model, ToleranceSettings, VariableId};
use hardpoint::run::Solution;
use hardpoint::sensitivity::Admissibility;

use super::deviations::Deviations;
use crate::evaluation::{DesignEvaluation, Motions};

/// Data of a tolerance study.
pub(super) struct StudyData<'s> {
    pub model: &'s Model,
    pub motions: &'s Motions<'s>,
    /// Number of each motion among those of the model.
    pub numbers: &'s [usize],
    pub settings: &'s ToleranceSettings,
    pub deviations: &'s Deviations,
    pub nominal: &'s DesignEvaluation,
}

/// Toleranced variables, and those of them that the mechanism cannot follow.
pub(super) fn deviations(
    model: &Model,
    nominal: &DesignEvaluation,
    settings: &ToleranceSettings,
) -> (Deviations, Vec<VariableId>) {
    let cannot = |v: VariableId| {
        let known = |s: &Solution| {
            matches!(s.sensitivities.admissibility.get(v.0), Some(Admissibility::CannotFollow { .. }))
        };
        nominal.solutions.iter().any(known)
    };
    let of_all = settings.tolerances.iter().flat_map(|t| t.variables.iter().copied());
    let left_out: Vec<VariableId> = of_all.filter(|v| cannot(*v)).collect();
    (Deviations::new(model, settings, &left_out), left_out)
}

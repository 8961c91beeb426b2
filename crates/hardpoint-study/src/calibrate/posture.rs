//! Postures of measurements: the drivers are at rest, and every posture is reached separately from the design
//! configuration.

use crate::evaluation::StudyCost;
use crate::grid::{PHASE_ENDS, law_of};
use hardpoint::model::{Case, CaseId, DriverId, LoadMode, Model, VariableId};
use hardpoint::motion::Stop;
use hardpoint::run::{Analysis, Run, Solution};
use hardpoint::topology::{Formulation, TopologyError};

/// Reached posture: the last output time of its motion.
#[derive(Clone, Debug)]
pub(super) struct ReachedPosture(Solution);

impl ReachedPosture {
    fn last(&self) -> usize {
        self.0.motion.len() - 1
    }

    /// Value of an output, SI.
    pub fn value(&self, output: usize) -> f64 {
        self.0.measured.value(self.last(), output)[0]
    }

    /// True if the mechanism follows a variable in this posture.
    pub fn follows(&self, variable: VariableId) -> bool {
        self.0.sensitivities.at(self.last(), variable.0).is_some()
    }

    /// Derivative of an output by a variable that the mechanism follows.
    pub fn d(&self, output: usize, variable: VariableId) -> f64 {
        derivative(&self.0, self.last(), output, variable)
    }
}

/// Derivative of an output at an output time; NaN if the mechanism cannot follow the variable.
pub(super) fn derivative(solution: &Solution, k: usize, output: usize, variable: VariableId) -> f64 {
    let followed = solution.sensitivities.at(k, variable.0).is_some();
    if followed { solution.measured.d(k, variable, output)[0] } else { f64::NAN }
}

/// Model in which every driver moves from the design configuration to its position in a posture.
pub(super) fn posture_model(model: &Model, places: &[f64]) -> Model {
    let [begin, end] = PHASE_ENDS;
    let mut laws = Vec::new();
    let mut formulas = Vec::new();
    for (d, place) in places.iter().enumerate() {
        let by = place - model.as_drawn(DriverId(d));
        let (law, formula) = law_of(model, DriverId(d), format!("({by:?})*min(t, {end:?})"));
        laws.push(Some(law));
        formulas.extend(formula);
    }
    let case = Case {
        name: "posture".into(),
        laws,
        force_laws: Vec::new(),
        formulas,
        times: vec![begin, end],
        load_mode: Some(LoadMode::Static),
    };
    Model { cases: vec![case], ..model.clone() }.in_case(CaseId(0))
}

/// Solves a posture of a design.
///
/// # Errors
/// The [`Stop`] that prevents the posture.
pub(super) fn solve_posture(
    analysis: &Analysis<'_>,
    design: &[f64],
    cost: &mut StudyCost,
) -> Result<ReachedPosture, Box<Stop>> {
    let solution = analysis.solve(Run::new().at(design));
    cost.motions += 1;
    cost.steps += solution.motion.len();
    match solution.stop {
        Some(stop) => Err(Box::new(stop)),
        None => Ok(ReachedPosture(solution)),
    }
}

/// Analyses of several models.
pub(super) fn planned(
    models: &[Model],
    formulation: Formulation,
) -> Result<Vec<Analysis<'_>>, TopologyError> {
    models.iter().map(|model| Analysis::with(model, formulation)).collect()
}

//! Where a mechanism was measured: its drivers stand, and every posture is reached from the drawing by itself.

use crate::measure::Output;
use crate::model::{Case, CaseId, DriverId, Model, VariableId};
use crate::motion::Stop;
use crate::run::{Analysis, Run};
use crate::study::evaluation::Cost;
use crate::study::grid::{STANDS, law_of};
use crate::topology::{Formulation, TopologyFault};

/// Values and derivatives of all outputs in one posture.
#[derive(Clone, Debug)]
pub(super) struct Stand {
    /// Per output.
    pub values: Vec<f64>,
    /// Per output, by each of the variables asked for; zero where the mechanism cannot follow one.
    pub d: Vec<Vec<f64>>,
}

/// The model in which every driver goes from where it is drawn to where it stood.
pub(super) fn standing(model: &Model, places: &[f64]) -> Model {
    let [begin, end] = STANDS;
    let mut laws = Vec::new();
    let mut formulas = Vec::new();
    for (d, place) in places.iter().enumerate() {
        let by = place - model.as_drawn(DriverId(d));
        let (law, formula) = law_of(model, DriverId(d), format!("({by:?})*min(t, {end:?})"));
        laws.push(Some(law));
        formulas.extend(formula);
    }
    let case = Case { name: String::new(), laws, formulas, times: vec![begin, end] };
    let mut model = Model { cases: vec![case], ..model.clone() }.in_case(CaseId(0));
    model.name.truncate(model.name.len() - ", ".len());
    model
}

/// What the outputs are in one posture of a design, with derivatives by some variables.
///
/// # Errors
/// What kept the mechanism from it.
pub(super) fn stand(
    analysis: &Analysis<'_>,
    design: &[f64],
    variables: &[VariableId],
    cost: &mut Cost,
) -> Result<Stand, Box<Stop>> {
    let solution = analysis.solve(Run::new().at(design));
    cost.motions += 1;
    cost.steps += solution.motion.len();
    if let Some(stop) = solution.stop {
        return Err(Box::new(stop));
    }
    let last = solution.motion.len() - 1;
    let measured = &solution.measured;
    let outputs = 0..measured.outputs.len();
    let by = |m: usize, v: &VariableId| {
        if solution.sensitivities.at(last, v.0).is_some() { measured.d(last, *v, m)[0] } else { 0.0 }
    };
    Ok(Stand {
        values: outputs.clone().map(|m| measured.value(last, m)[0]).collect(),
        d: outputs.map(|m| variables.iter().map(|v| by(m, v)).collect()).collect(),
    })
}

/// Analyses of several models.
pub(super) fn planned(
    models: &[Model],
    formulation: Formulation,
) -> Result<Vec<Analysis<'_>>, TopologyFault> {
    models.iter().map(|model| Analysis::with(model, formulation)).collect()
}

/// Whether an output can be compared with what was measured of a mechanism that stands still.
pub(super) fn is_still(model: &Model, output: &Output) -> bool {
    let by_driver =
        matches!(output.source, crate::model::OutputSource::Measure(k) if model.goes_by_driver(k));
    output.known.by_position || by_driver
}

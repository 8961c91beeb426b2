//! Postures of measurements: the drivers are at rest, and every posture is reached separately from the design
//! configuration.

use std::collections::BTreeSet;

use crate::evaluation::StudyCost;
use crate::grid::{PHASE_ENDS, law_of};
use hardpoint::law::Law;
use hardpoint::measure::outputs;
use hardpoint::model::{
    Case, CaseId, DriverId, ElementId, LoadMode, Measurements, Model, OutputSource, VariableId,
};
use hardpoint::motion::{Stop, StopKind};
use hardpoint::run::{Analysis, Run, Solution};
use hardpoint::topology::{Formulation, TopologyError};

/// Parameter of a law: the offset of its driver.
const OFFSET: &str = "offset";

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

/// Model in which every driver moves from the design configuration to its position in a posture, and forces grow to
/// their values there. Drivers with an offset have a further variable each, after those of the model.
pub(crate) fn posture_model(
    model: &Model,
    places: &[f64],
    forces: &[(ElementId, f64)],
    offsets: &[DriverId],
) -> Model {
    let [begin, end] = PHASE_ENDS;
    let mut laws = Vec::new();
    let mut formulas = Vec::new();
    for (d, place) in places.iter().enumerate() {
        let driver = DriverId(d);
        let by = place - model.as_drawn(driver);
        let offset = offsets.contains(&driver);
        let by = if offset { format!("({by:?} + {OFFSET})") } else { format!("({by:?})") };
        let own: &[(&str, f64)] = if offset { &[(OFFSET, 0.0)] } else { &[] };
        let (law, formula) = law_of(model, driver, format!("{by}*min(t, {end:?})"), own);
        laws.push(Some(law));
        formulas.extend(formula);
    }
    let force_law = |(force, value): &(ElementId, f64)| {
        let law = Law::parse(&format!("({value:?})*min(t, {end:?})")).expect("a law that is written here");
        (*force, law)
    };
    let case = Case {
        name: "posture".into(),
        laws,
        force_laws: forces.iter().map(force_law).collect(),
        formulas,
        times: vec![begin, end],
        load_mode: Some(LoadMode::Static),
    };
    let mut posture = Model { cases: vec![case], ..model.clone() }.in_case(CaseId(0));
    for driver in offsets {
        let parameters = posture.drivers[driver.0].law.parameters();
        let place = parameters.iter().position(|p| p.name == OFFSET).expect("a law with an offset");
        let name = format!("offset of {}", posture.drivers[driver.0].name);
        posture.add_law_variable(&name, *driver, place);
    }
    posture
}

/// Models of all postures of measurements.
pub(super) fn posture_models(model: &Model, measured: &Measurements, offsets: &[DriverId]) -> Vec<Model> {
    let of = |(k, places): (usize, &Vec<f64>)| posture_model(model, places, measured.forces_in(k), offsets);
    measured.postures.iter().enumerate().map(of).collect()
}

/// Outputs with readings.
pub(super) fn read_outputs(model: &Model, data: &Measurements) -> Vec<OutputSource> {
    let all = outputs(model);
    let columns: BTreeSet<usize> = data.readings.iter().map(|reading| reading.output).collect();
    columns.into_iter().map(|column| all[column].source).collect()
}

/// Posture that the nominal design does not reach. Its readings are left out.
#[derive(Clone, Debug, PartialEq)]
pub struct UnreachedPosture {
    /// Index of the posture.
    pub posture: usize,
    /// Description of the event.
    pub why: String,
    /// Positions of the drivers at the last solved position on the path to the posture, counted like those of
    /// [`Measurements`](hardpoint::model::Measurements); `None` if the path has none.
    pub last: Option<Vec<f64>>,
}

impl UnreachedPosture {
    /// Posture that a motion ends before.
    pub(super) fn of(posture: usize, stop: &Stop, model: &Model) -> Self {
        let position = |(d, by): (usize, &f64)| model.as_drawn(DriverId(d)) + by;
        let drivers = || stop.drivers.iter().take(model.drivers.len()).enumerate().map(position).collect();
        Self { posture, why: path_end(stop, model), last: stop.last_time.map(|_| drivers()) }
    }
}

/// Description of the end of a path to a posture. Its times are not those of a motion.
fn path_end(stop: &Stop, model: &Model) -> String {
    match stop.kind {
        StopKind::Limit | StopKind::CurveEnd { .. } | StopKind::BranchChange if stop.last_time.is_none() => {
            "the mechanism does not reach the design configuration of its drivers".into()
        }
        StopKind::Limit
        | StopKind::CurveEnd { .. }
        | StopKind::BranchChange
        | StopKind::DoesNotAssemble
        | StopKind::Locked { .. }
        | StopKind::LawNotFinite { .. }
        | StopKind::LoadNotFinite { .. }
        | StopKind::FormulaNotFinite { .. }
        | StopKind::TooFar { .. }
        | StopKind::JointLimit { .. }
        | StopKind::Interrupted
        | StopKind::NothingHolds { .. }
        | StopKind::LimitLoad { .. }
        | StopKind::NoEquilibrium
        | StopKind::Unstable { .. }
        | StopKind::TooStiff { .. } => stop.happened(model),
    }
}

/// Solves a posture of a design, with these outputs and their derivatives.
///
/// # Errors
/// The [`Stop`] that prevents the posture.
pub(super) fn solve_posture(
    analysis: &Analysis<'_>,
    design: &[f64],
    outputs: &[OutputSource],
    cost: &mut StudyCost,
) -> Result<ReachedPosture, Box<Stop>> {
    let solution = analysis.solve(Run::new().at(design).for_outputs(outputs));
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

/// Values of all outputs of a design in postures of the drivers, SI; the reason for each posture that is not reached.
/// Postures are given as in [`Measurements`](hardpoint::model::Measurements).
///
/// # Errors
/// A [`TopologyError`] if the mechanism cannot be driven.
pub fn values_in_postures(
    model: &Model,
    design: &[f64],
    postures: &[Vec<f64>],
    formulation: Formulation,
) -> Result<Vec<Result<Vec<f64>, String>>, TopologyError> {
    let models: Vec<Model> = postures.iter().map(|p| posture_model(model, p, &[], &[])).collect();
    let sources: Vec<OutputSource> = outputs(model).into_iter().map(|output| output.source).collect();
    let values = |analysis: &Analysis<'_>| {
        let solved = solve_posture(analysis, design, &sources, &mut StudyCost::default());
        let values = |posture: ReachedPosture| (0..sources.len()).map(|m| posture.value(m)).collect();
        solved.map(values).map_err(|stop| path_end(&stop, analysis.model()))
    };
    Ok(planned(&models, formulation)?.iter().map(values).collect())
}

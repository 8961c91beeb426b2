//! Loads as part of a step's program: reactions and driver loads are recorded with the position and its factors.
//!
//! The kernel evaluates the others: models with joint friction (iterative), springs with tables, bushings with
//! torsional stiffness, and elements on angles that are counted along the path. Whether a reaction is determined is a
//! result like others, because it depends on the position.

use hardpoint_tape::Number;

use crate::design::DesignMap;
use crate::measure::{RecordedValue, RecordedValues};
use crate::model::{ElementId, Model};
use crate::motion::step_program::RecordedStep;
use crate::number::record as recording;
use crate::sensitivity::Differentiated;
use crate::topology::Topology;

use super::derivatives::LoadDerivatives;
use super::equilibrium::Equilibrium;
use super::solver::{asks_for_reactions, geometry_along, load_measures};
use super::turns::Turns;

/// Maximum number of pairs of a body or element with a variable for which loads are recorded. Each pair takes some
/// hundred operations.
const MOST_PAIRS: usize = 10_000;

/// Reason why the loads of a model are not recorded, if they are not.
pub(crate) fn hindrance(model: &Model, topology: &Topology) -> Option<&'static str> {
    if (model.bodies.len() + model.elements.len()) * (1 + model.variables.len()) > MOST_PAIRS {
        return Some("the program of its loads would be too long");
    }
    let forces = || model.elements.iter().filter_map(|e| e.kind.force(model));
    if forces().any(|force| force.friction.is_some()) {
        return Some("joints have friction, which is solved iteratively");
    }
    if !forces().all(|force| force.is_arithmetic) {
        return Some("a spring has a table, or a bushing a torsional stiffness");
    }
    let counted = (0..model.elements.len())
        .any(|e| matches!(Turns::of(model, topology, ElementId(e)), Turns::Path(_) | Turns::Length));
    counted.then_some("a force acts on an angle that is counted along the path")
}

/// Loads during recording.
pub(crate) struct RecordedLoads<'a> {
    equilibrium: Equilibrium<'a, Number>,
    measures: Vec<usize>,
    /// `None` if no sensitivities are requested.
    derivatives: Option<LoadDerivatives<'a, Number>>,
    /// Per load: its value, followed by the derivatives by the variables so far.
    numbers: Vec<Vec<Number>>,
}

impl<'a> RecordedLoads<'a> {
    /// Loads at a recorded step; with derivatives by all variables, if requested.
    pub fn new(design_map: &'a DesignMap<'_>, step: &mut RecordedStep<'_>, sensitivities: bool) -> Self {
        let RecordedStep { topology, state, values, drivers, laws } = step;
        let model = design_map.model();
        let geometry = recording::strictly(|| design_map.geometry(values));
        let mut equilibrium = Equilibrium::new(model, topology, geometry);
        equilibrium.set_motion(state, |d| drivers[d][1]);
        let with_law = (0..model.elements.len()).filter(|e| model.elements[*e].kind.law(model).is_some());
        with_law.zip(*laws).for_each(|(e, law)| equilibrium.position.laws[e] = *law);
        for e in 0..model.elements.len() {
            if let Turns::Coordinate(c) = Turns::of(model, topology, ElementId(e)) {
                equilibrium.position.near[e] = state.q[c.0];
            }
        }
        equilibrium.solve(topology, state);
        if asks_for_reactions(model) {
            equilibrium.solve_stresses(topology, state);
        }
        let measures = load_measures(model);
        let applied = equilibrium.applied();
        let value = |m: &usize| vec![equilibrium.measures(&applied).measure(&model.measures[*m].kind)];
        let numbers = measures.iter().map(value).collect();
        let derivatives = sensitivities.then(|| {
            let kinds = measures.iter().map(|m| &model.measures[*m].kind);
            let along = |v| recording::strictly(|| geometry_along(design_map, values, v));
            let by_variables = (0..model.variables.len()).map(|v| along(Some(v)));
            let mut derivatives =
                LoadDerivatives::new(&equilibrium, topology, kinds, by_variables, along(None));
            derivatives.set_equilibrium(&equilibrium, topology, state, |_| {});
            derivatives
        });
        Self { equilibrium, measures, derivatives, numbers }
    }

    /// Records the derivatives by the next variable.
    pub fn differentiate(&mut self, by: &Differentiated<'_, Number>) {
        if let Some(derivatives) = &mut self.derivatives {
            derivatives.differentiate(&self.equilibrium, by, |n, slope| self.numbers[n].push(slope));
        }
    }

    /// Recorded loads, each with its excess due to self-stress.
    pub fn values(self) -> RecordedValues {
        let Self { equilibrium, measures, numbers, .. } = self;
        let value = |(measure, numbers): (usize, Vec<Number>)| RecordedValue {
            measure,
            excess: equilibrium.excess(&equilibrium.model.measures[measure].kind),
            numbers,
        };
        RecordedValues(measures.into_iter().zip(numbers).map(value).collect())
    }
}

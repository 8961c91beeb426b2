//! Loads as part of a step's program: what joints and drivers carry is recorded where the position is, with its factors.
//!
//! Not recorded are hinges that rub, whose moments are iterated, and elements on angles that are counted along the path: these go by the
//! kernel. Which reactions are known is a result like others: in some positions redundant constraints share what they do not in others.

use hardpoint_tape::Number;

use crate::design::DesignMap;
use crate::model::{ElementId, ElementKind, Model};
use crate::motion::kinematics::State;
use crate::number::record as recording;
use crate::sensitivity::Differentiated;
use crate::topology::Topology;

use super::carry::{Equilibrium, excess};
use super::inertia::Changed;
use super::measures::Instant;
use super::solver::{asked, asks_for_reactions, geometry_along};
use super::turns::Turns;

/// Of more bodies and elements, times variables, no loads are recorded: each takes some hundred operations.
const MOST_PAIRS: usize = 10_000;

/// Why the loads of a model are not recorded, if they are not.
pub(crate) fn hindrance(model: &Model, topology: &Topology) -> Option<&'static str> {
    if (model.bodies.len() + model.elements.len()) * (1 + model.variables.len()) > MOST_PAIRS {
        return Some("the program of its loads would be too long");
    }
    let kinds = || model.elements.iter().map(|e| &e.kind);
    if kinds().any(|kind| matches!(kind, ElementKind::Friction { .. })) {
        return Some("hinges rub, whose moments are iterated");
    }
    let counted =
        (0..model.elements.len()).any(|e| matches!(Turns::of(model, topology, ElementId(e)), Turns::Path(_)));
    counted.then_some("a force acts on an angle that is counted along the path")
}

/// Loads while they are recorded.
pub(crate) struct RecordedLoads<'a> {
    model: &'a Model,
    asked: Vec<usize>,
    bodies: Equilibrium<Number>,
    /// As it goes with each variable.
    changed: Vec<Changed<Number>>,
    /// Per measure: how much redundant constraints make of it, its value, and its derivatives by the variables so far.
    found: Vec<Vec<Number>>,
}

impl<'a> RecordedLoads<'a> {
    /// Where a state stands in the design with these values: with drivers of these speeds, and these values of the laws of those elements
    /// that have any. With derivatives by all variables, if they are wanted.
    pub fn new(
        design_map: &'a DesignMap<'_>,
        topology: &Topology,
        state: &mut State<Number>,
        (values, (drivers, laws)): (&[Number], (&[[Number; 3]], &[Number])),
        sensitivities: bool,
    ) -> Self {
        let model = design_map.model();
        let geometry = recording::strictly(|| design_map.geometry(values));
        let variables = if sensitivities { model.variables.len() } else { 0 };
        let along = |v| recording::strictly(|| geometry_along(design_map, values, Some(v)));
        let changed = (0..variables).map(|v| Changed::new(model, along(v))).collect();
        let mut bodies = Equilibrium::new(model, topology);
        bodies.stand(state, |d| drivers[d][1]);
        let with_law = (0..model.elements.len()).filter(|e| model.elements[*e].kind.law().is_some());
        with_law.zip(laws).for_each(|(e, law)| bodies.now.laws[e] = *law);
        for e in 0..model.elements.len() {
            if let Turns::Coordinate(c) = Turns::of(model, topology, ElementId(e)) {
                bodies.now.near[e] = state.q[c.0];
            }
        }
        bodies.carry(topology, state, (model, &geometry));
        let stresses = match asks_for_reactions(model) {
            true => bodies.stresses(model, topology, state),
            false => Vec::new(),
        };
        bodies.begin_changes((model, &geometry));
        let asked = asked(model);
        let acting = bodies.now.acting(model, &geometry);
        let instant = Instant { acting: &acting, carried: &bodies.now.found };
        let kinds = || asked.iter().map(|m| &model.measures[*m].kind);
        let found = vec![
            kinds().map(|kind| excess(kind, &acting, &stresses)).collect(),
            kinds().map(|kind| instant.measure(kind)).collect(),
        ];
        Self { model, asked, bodies, changed, found }
    }

    /// Their derivatives by the next variable.
    pub fn differentiate(&mut self, by: Differentiated<'_, Number>) {
        let Self { model, asked, bodies, changed, found } = self;
        let changed = (*model, &changed[by.variable.0]);
        let Differentiated { variable, topology, state, field, flow } = by;
        bodies.change(model, Differentiated { variable, topology, state: &mut *state, field, flow });
        bodies.carry_changed(topology, state, changed);
        let acting = bodies.along.acting(model, &changed.1.geometry);
        let instant = Instant { acting: &acting, carried: &bodies.along.found };
        found.push(asked.iter().map(|m| instant.measure(&model.measures[*m].kind).d).collect());
    }

    /// All of them: how much redundant constraints make of each measure, values, then derivatives variable by variable.
    pub fn numbers(self) -> Vec<Number> {
        self.found.concat()
    }
}

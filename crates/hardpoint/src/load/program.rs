//! Loads as part of a step's program: reactions and driver loads are recorded with the position and its factors.
//!
//! The kernel evaluates the others: models with joint friction (iterative), springs with tables, bushings with
//! torsional stiffness, and elements on angles that are counted along the path. Whether a reaction is determined is a
//! result like others, because it depends on the position.

use hardpoint_tape::Number;

use crate::design::DesignMap;
use crate::measure::{RecordedValue, RecordedValues};
use crate::model::{ElementId, MeasureKind, Model};
use crate::motion::kinematics::State;
use crate::motion::step_program::RecordedStep;
use crate::number::{Dual, record as recording};
use crate::sensitivity::{Differentiated, Turning};
use crate::space::{Twist, Wrench};
use crate::topology::Topology;

use super::acting::AppliedLoads;
use super::carry::{Carried, Equilibrium, excess};
use super::inertia::Changed;
use super::measures::Instant;
use super::solver::{asked, asks_for_reactions, geometry_along};
use super::turns::Turns;
use super::virtual_motion::{VirtualMotion, Weights};

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
///
/// Their derivatives use the virtual motion of each load (`virtual_motion.rs`): the coefficients of W, W. and W.. of
/// every body are computed once, and each variable takes a few products. For fewer than a few dozen loads this is
/// cheaper than the reactions to F' of every variable.
pub(crate) struct RecordedLoads<'a> {
    model: &'a Model,
    bodies: Equilibrium<Number>,
    /// Geometry with the derivative by each variable; the last entry has none.
    changed: Vec<Changed<Number>>,
    loads: Vec<RecordedLoad<'a>>,
    /// Per load: the excess due to self-stress.
    excess: Vec<Number>,
    /// Values per load, followed by the derivatives by the variables so far.
    found: Vec<Vec<Number>>,
}

/// A load with its derivatives by required wrenches, by design twists, and by the twists of the joint frames.
struct RecordedLoad<'a> {
    kind: &'a MeasureKind,
    /// Per body: Y, and the coefficients of W, W., W...
    moves: Vec<Twist<Number>>,
    loads: Vec<[Wrench<Number>; 3]>,
    turning: Turning<Number>,
}

impl<'a> RecordedLoads<'a> {
    /// Loads at a recorded step; with derivatives by all variables, if requested.
    pub fn new(design_map: &'a DesignMap<'_>, step: &mut RecordedStep<'_>, sensitivities: bool) -> Self {
        let RecordedStep { topology, state, values, drivers, laws } = step;
        let model = design_map.model();
        let geometry = recording::strictly(|| design_map.geometry(values));
        let along = |v| recording::strictly(|| geometry_along(design_map, values, v));
        let mut bodies = Equilibrium::new(model, topology);
        bodies.stand(state, |d| drivers[d][1]);
        let with_law = (0..model.elements.len()).filter(|e| model.elements[*e].kind.law(model).is_some());
        with_law.zip(*laws).for_each(|(e, law)| bodies.now.laws[e] = *law);
        for e in 0..model.elements.len() {
            if let Turns::Coordinate(c) = Turns::of(model, topology, ElementId(e)) {
                bodies.now.near[e] = state.q[c.0];
            }
        }
        bodies.carry(topology, state, (model, &geometry));
        let stresses = match asks_for_reactions(model) {
            true => bodies.stresses(topology, state, (model, &geometry)),
            false => Vec::new(),
        };
        let kinds: Vec<&MeasureKind> = asked(model).into_iter().map(|m| &model.measures[m].kind).collect();
        let acting = bodies.now.acting(model, &geometry);
        let instant = Instant { acting: &acting, carried: &bodies.now.found };
        let excess = kinds.iter().map(|kind| excess(kind, &acting, &stresses)).collect();
        let found = vec![kinds.iter().map(|kind| instant.measure(kind)).collect()];
        let mut recorded = Self { model, bodies, changed: Vec::new(), loads: Vec::new(), excess, found };
        if sensitivities {
            let variables = (0..model.variables.len()).map(Some).chain([None]);
            recorded.changed = variables.map(|v| Changed::new(model, along(v))).collect();
            recorded.bodies.begin_changes((model, &geometry));
            recorded.loads = kinds.iter().map(|kind| recorded.load(kind, topology, state)).collect();
        }
        recorded
    }

    /// Derivatives of a load by all quantities that a variable may change.
    fn load(
        &mut self,
        kind: &'a MeasureKind,
        topology: &Topology,
        state: &mut State<Number>,
    ) -> RecordedLoad<'a> {
        let Self { model, bodies, changed, .. } = self;
        let (constant, count) = (&changed[changed.len() - 1].geometry, model.bodies.len());
        let mut carried = bodies.along.found.clone();
        let acting = AppliedLoads { bodies: &bodies.still, ..bodies.along.acting(model, constant) };
        let objective =
            |carried: &Carried<Dual<Number>>| Instant { acting: &acting, carried }.measure(kind).d;
        let weights = Weights::of(kind, std::iter::empty(), &mut carried, objective);
        let mut virtual_motion = VirtualMotion::new(topology, count);
        virtual_motion.go(&bodies.places, topology, state, &weights);
        // The wrench on ground is -sum F.
        let moves: Vec<_> = virtual_motion.twists().iter().map(|y| *y - weights.ground).collect();
        let of_masses = |b: usize| bodies.inertia[b].weights(model, &bodies.now.bodies[b], moves[b]);
        let mut loads: Vec<_> = (0..count).map(of_masses).collect();
        let of = (&bodies.places, &bodies.transmission);
        virtual_motion.turn(of, topology, state, &weights, |body, load| loads[body.0][0] += load);
        RecordedLoad { kind, moves, loads, turning: virtual_motion.turning }
    }

    /// Records the derivatives by the next variable.
    pub fn differentiate(&mut self, by: Differentiated<'_, Number>) {
        let Self { model, bodies, changed, loads, found, .. } = self;
        let Changed { geometry, masses } = &changed[by.variable.0];
        let Differentiated { topology, state, field, flow, .. } = by;
        bodies.go_along(field, flow);
        bodies.act(model, geometry, masses);
        let acting = bodies.along.acting(model, geometry);
        let instant = Instant { acting: &acting, carried: &bodies.along.found };
        let derivative = |load: &RecordedLoad<'_>| {
            // y' = sum (P2 . W.. + P1 . W. + P0 . W) + turning of frames + sum F' . Y of force elements + dy/db    (48)
            let mut sum = field.work((topology, state), flow, &load.loads, &load.turning);
            for (needed, y) in bodies.along.needed.iter().zip(&load.moves) {
                sum += Wrench { m: needed.m.map(|x| x.d), f: needed.f.map(|x| x.d) }.on(*y);
            }
            sum + instant.measure(load.kind).d
        };
        let derivatives = loads.iter().map(derivative).collect();
        found.push(derivatives);
    }

    /// Recorded loads, each with its excess due to self-stress.
    pub fn values(self) -> RecordedValues {
        let Self { excess, found, .. } = self;
        let value = |(n, measure): (usize, usize)| RecordedValue {
            measure,
            excess: excess[n],
            numbers: found.iter().map(|found| found[n]).collect(),
        };
        RecordedValues(asked(self.model).into_iter().enumerate().map(value).collect())
    }
}

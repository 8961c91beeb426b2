//! Forces that hold the openings of a mechanism, and their derivatives, at a position at rest.

use crate::design::{DesignMap, DesignVelocity};
use crate::model::{DriverId, Element, MeasureKind, Model, UnitForce, VariableId};
use crate::motion::stepper::Stepper;
use crate::sensitivity::{Differentiated, DirectDifferentiation, PlanVelocity};
use crate::space::{Twist, Wrench};
use crate::topology::Topology;

use super::derivatives::LoadDerivatives;
use super::equilibrium::Equilibrium;
use super::solver::geometry_along;
use super::turns::Turns;

/// Loads along the way to an equilibrium.
#[derive(Clone, Debug)]
pub(crate) struct GivenLoads {
    /// Per element: the value of its law.
    pub laws: Vec<f64>,
    /// Part of weights and preloads that acts.
    pub share: f64,
}

impl GivenLoads {
    /// All loads of a model at time t.
    pub fn at(model: &Model, t: f64) -> Self {
        let law = |element: &Element| element.kind.law(model).map_or(1.0, |law| law.at(t).value());
        Self { laws: model.elements.iter().map(law).collect(), share: 1.0 }
    }

    /// No loads.
    pub fn none(model: &Model) -> Self {
        Self { laws: vec![0.0; model.elements.len()], share: 0.0 }
    }

    /// Loads on the straight way from these to others.
    pub fn towards(&self, to: &Self, part: f64) -> Self {
        let between = |a: f64, b: f64| if part == 1.0 { b } else { a + (b - a) * part };
        Self {
            laws: self.laws.iter().zip(&to.laws).map(|(a, b)| between(*a, *b)).collect(),
            share: between(self.share, to.share),
        }
    }
}

/// Forces of the openings as drivers, and their derivatives by openings and variables.
pub(crate) struct OpeningLoads<'a> {
    statics: Equilibrium<'a, f64>,
    derivatives: LoadDerivatives<'a, f64>,
    turns: Vec<Turns>,
    openings: Vec<DriverId>,
    /// Unit motion of each opening, then other directions while the openings stand.
    columns: Vec<PlanVelocity<f64>>,
    direct: DirectDifferentiation<f64>,
}

impl<'a> OpeningLoads<'a> {
    /// Loads of these openings, with derivatives by the openings, the variables with these fields and the other
    /// drivers; `kinds` are the loads of the openings as measures.
    pub fn new(
        design_map: &'a DesignMap<'a>,
        topology: &Topology,
        values: &[f64],
        (openings, kinds): (&[DriverId], &'a [MeasureKind]),
        fields: &[DesignVelocity],
        held: &[DriverId],
    ) -> Self {
        let model = design_map.model();
        let statics = Equilibrium::new(model, topology, design_map.geometry(values));
        let constant = || geometry_along(design_map, values, None);
        let by_openings = openings.iter().map(|_| constant());
        let by_variables = (0..fields.len()).map(|v| geometry_along(design_map, values, Some(v)));
        let by_drivers = held.iter().map(|_| constant());
        let geometries = by_openings.chain(by_variables).chain(by_drivers);
        let derivatives = LoadDerivatives::new(&statics, topology, kinds, geometries, constant());
        let unit = |d: &DriverId| DesignVelocity::of_driver(*d);
        let fields = openings.iter().map(unit).chain(fields.iter().cloned()).chain(held.iter().map(unit));
        Self {
            statics,
            derivatives,
            turns: Turns::of_all(model, topology),
            openings: openings.to_vec(),
            columns: fields.map(|field| PlanVelocity::new(topology, &field)).collect(),
            direct: DirectDifferentiation::new(model, topology),
        }
    }

    /// Solves the forces at the position of a stepper, whose bodies are at rest, under these loads. Writes the force
    /// that each opening needs as a driver.
    pub fn forces(&mut self, one: &mut Stepper<'_>, given: &GivenLoads, out: &mut [f64]) {
        let Self { statics, turns, .. } = self;
        let Stepper { mechanism, turns: counted, .. } = one;
        let (topology, state) = (&mechanism.topology, &mut mechanism.state);
        statics.set_motion(state, |_| 0.0);
        let position = &mut statics.position;
        for body in &mut position.bodies {
            (body.v, body.a) = (Twist::zero(), Twist::zero());
        }
        position.laws.copy_from_slice(&given.laws);
        position.share = given.share;
        let counted = counted.as_ref().map(|turns| &turns.values[..]);
        Turns::write(turns, state, counted, &mut position.near);
        statics.solve(topology, state);
        for (d, to) in self.openings.iter().zip(out) {
            *to = statics.transmitted.drivers[d.0];
        }
    }

    /// Prepares derivatives of the forces that were solved last.
    pub fn prepare(&mut self, one: &mut Stepper<'_>) {
        let (topology, state) = (&one.mechanism.topology, &mut one.mechanism.state);
        self.derivatives.set_equilibrium(&self.statics, topology, state, |_| ());
    }

    /// Derivatives of the forces by opening k, or along another direction while all openings stand. `moved` receives
    /// the twists of the bodies.
    pub fn derivatives(
        &mut self,
        one: &mut Stepper<'_>,
        k: usize,
        t: f64,
        out: &mut [f64],
        moved: &mut dyn FnMut(&[Twist<f64>]),
    ) {
        let Self { statics, derivatives, columns, direct, .. } = self;
        let mechanism = &mut one.mechanism;
        let (topology, state, parts) = (&mechanism.topology, &mut mechanism.state, &mechanism.parts);
        let field = &mut columns[k];
        field.set_time(|d: DriverId| parts.law_of(d.0), t);
        direct.solve_position(topology, state, field);
        moved(&direct.flow.twists[0]);
        let by = Differentiated { variable: VariableId(k), topology, state, field, flow: &direct.flow };
        derivatives.differentiate(statics, &by, |n, slope| out[n] = slope);
    }

    /// Wrenches of a unit force on the bodies, at the position that was solved last.
    pub fn unit_force(&mut self, force: UnitForce) -> Vec<(usize, Wrench<f64>)> {
        match force {
            UnitForce::Point(point, along) => {
                let applied = self.statics.applied();
                vec![(applied.body(point), Wrench::force(along, applied.point(point)))]
            }
            UnitForce::Wheel(wheel, along) => {
                let applied = self.statics.applied();
                let contact = applied.wheel(wheel).contact();
                vec![(applied.model.wheels[wheel.0].body.0, Wrench::force(along, contact))]
            }
            UnitForce::Element(e) => {
                let law = std::mem::replace(&mut self.statics.position.laws[e.0], 1.0);
                let mut out = vec![Wrench::zero(); self.statics.position.bodies.len()];
                let applied = self.statics.applied();
                applied.add(e, &mut out);
                // Per unit of its size, opposite to the required wrenches.
                let per = -1.0 / applied.size(e);
                self.statics.position.laws[e.0] = law;
                out.into_iter().map(|w| w.times_plus(per, Wrench::zero())).enumerate().collect()
            }
        }
    }
}

//! Forces that hold the openings of a mechanism, and their derivatives, at a position at rest; for any number type.

use crate::design::{DesignMap, DesignVelocity};
use crate::model::{DriverId, Element, MeasureKind, Model, UnitForce, VariableId};
use crate::motion::kinematics::State;
use crate::motion::stepper::Stepper;
use crate::number::Real;
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

    /// This part of the loads.
    pub fn times(mut self, part: f64) -> Self {
        self.laws.iter_mut().for_each(|law| *law *= part);
        self.share *= part;
        self
    }
}

/// Whole turns of the coordinates that elements act on, at the position of a stepper.
pub(crate) struct ElementTurns(Vec<Turns>);

impl ElementTurns {
    /// Sources of the turns of all elements.
    pub fn new(model: &Model, topology: &Topology) -> Self {
        Self(Turns::of_all(model, topology))
    }

    /// Approximate coordinates of the elements at the position at rest that was solved last.
    pub fn at(&self, one: &Stepper<'_>) -> Vec<f64> {
        let mut near = vec![0.0; self.0.len()];
        let counted = one.turns.as_ref().map(|turns| &turns.ahead[..]);
        Turns::write(&self.0, &one.mechanism.state, counted, &mut near);
        near
    }
}

/// Forces of the openings as drivers, and their derivatives by openings and variables.
pub(crate) struct OpeningLoads<'a, T> {
    statics: Equilibrium<'a, T>,
    derivatives: LoadDerivatives<'a, T>,
    openings: Vec<DriverId>,
    /// Directions in which the openings stand: the variables, then the other drivers.
    columns: Vec<PlanVelocity<T>>,
    direct: DirectDifferentiation<T>,
}

impl<'a, T: Real> OpeningLoads<'a, T> {
    /// Loads of these openings, with derivatives by the openings, the variables with these fields and the other
    /// drivers; `kinds` are the loads of the openings as measures.
    pub fn new(
        design_map: &'a DesignMap<'a>,
        topology: &Topology,
        values: &[T],
        (openings, kinds): (&[DriverId], &'a [MeasureKind]),
        fields: &[DesignVelocity<T>],
        held: &[DriverId],
    ) -> Self {
        let model = design_map.model();
        let statics = Equilibrium::new(model, topology, design_map.geometry(values));
        let constant = || geometry_along(design_map, values, None);
        let by_variables = (0..fields.len()).map(|v| geometry_along(design_map, values, Some(v)));
        let by_drivers = held.iter().map(|_| constant());
        let geometries = by_variables.chain(by_drivers);
        let derivatives = LoadDerivatives::new(&statics, topology, kinds, geometries, constant());
        let fields = fields.iter().cloned().chain(held.iter().map(|d| DesignVelocity::of_driver(*d)));
        Self {
            statics,
            derivatives,
            openings: openings.to_vec(),
            columns: fields.map(|field| PlanVelocity::new(topology, &field)).collect(),
            direct: DirectDifferentiation::new(model, topology),
        }
    }

    /// Sets a further force, which acts besides the loads of the model, and its size.
    pub fn set_further(&mut self, further: Option<(UnitForce, T)>) {
        self.statics.position.further = further;
        match further {
            Some((UnitForce::Point(point, _), _)) => {
                self.derivatives.act_on(self.statics.applied().body(point))
            }
            Some((UnitForce::Wheel(wheel, _), _)) => {
                self.derivatives.act_on(self.statics.model.wheels[wheel.0].body.0);
            }
            Some((UnitForce::Element(_), _)) | None => {}
        }
    }

    /// Solves the forces at a state, whose bodies are at rest, under these loads. Writes the force that each opening
    /// needs as a driver; `near` are approximate coordinates of the elements.
    pub fn forces(
        &mut self,
        (topology, state): (&Topology, &mut State<T>),
        near: &[f64],
        given: &GivenLoads,
        mut each: impl FnMut(usize, T),
    ) {
        let Self { statics, .. } = self;
        statics.set_motion(state, |_| T::zero());
        let position = &mut statics.position;
        for body in &mut position.bodies {
            (body.v, body.a) = (Twist::zero(), Twist::zero());
        }
        position.laws.iter_mut().zip(&given.laws).for_each(|(to, law)| *to = T::constant(*law));
        position.near.iter_mut().zip(near).for_each(|(to, near)| *to = T::constant(*near));
        position.share = given.share;
        statics.solve(topology, state);
        self.openings.iter().enumerate().for_each(|(k, d)| each(k, statics.transmitted.drivers[d.0]));
    }

    /// Prepares derivatives of the forces that were solved last.
    pub fn prepare(&mut self, topology: &Topology, state: &mut State<T>) {
        self.derivatives.set_equilibrium(&self.statics, topology, state, |_| ());
        self.derivatives.add_force_coefficients(&self.statics);
    }

    /// Derivatives of the forces by the openings, at the position that was prepared last; `each` receives the numbers
    /// of force and opening.
    pub fn stiffness(&mut self, each: impl FnMut(usize, usize, T)) {
        self.derivatives.differentiate_by_drivers(each);
    }

    /// Per opening: a bound of the terms of the derivative of its force by itself.
    pub fn terms_of_own_stiffness(&self) -> &[f64] {
        self.derivatives.terms_by_own_driver()
    }

    /// Per opening: twists of the bodies while it moves alone.
    pub fn unit_twists(&self) -> impl Iterator<Item = &[Twist<T>]> + Clone {
        self.derivatives.virtual_twists()
    }

    /// Derivatives of the forces along direction k while all openings stand. `set_time` sets the contributions of the
    /// drivers' laws; `moved` receives the twists of the bodies.
    pub fn derivatives(
        &mut self,
        (topology, state): (&Topology, &mut State<T>),
        k: usize,
        set_time: impl FnOnce(&mut PlanVelocity<T>),
        out: &mut [T],
        moved: impl FnOnce(&[Twist<T>]),
    ) {
        let Self { derivatives, columns, direct, .. } = self;
        let field = &mut columns[k];
        set_time(field);
        direct.solve_position(topology, state, field);
        moved(&direct.flow.twists[0]);
        let by = Differentiated { variable: VariableId(k), topology, state, field, flow: &direct.flow };
        derivatives.differentiate_at_rest(&by, |n, slope| out[n] = slope);
    }

    /// Wrenches of a unit force on the bodies, at the position that was solved last.
    pub fn unit_force(&self, force: UnitForce) -> Vec<(usize, Wrench<T>)> {
        let mut wrenches = Vec::new();
        self.statics.applied().unit_force(force, |body, wrench| wrenches.push((body, wrench)));
        wrenches
    }
}

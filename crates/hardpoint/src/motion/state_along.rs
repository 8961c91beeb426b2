//! Position of a mechanism with its derivative along one direction of design, drivers and forces.

use crate::design::Geometry;
use crate::model::{Contact, Model};
use crate::number::Dual;
use crate::topology::Topology;

use super::kinematics::State;
use super::mechanism::Mechanism;
use super::parts::PlanGeometry;

/// State in numbers that carry the derivative along a direction.
pub(crate) struct StateAlong {
    parts: PlanGeometry<Dual>,
    pub state: State<Dual>,
    /// Number of selections of rows that the state was made for.
    selections: usize,
    drivers: Vec<[Dual; 3]>,
}

impl StateAlong {
    /// Workspace for a direction along which the geometry of the design changes like this.
    pub fn new(model: &Model, topology: &Topology, geometry: &Geometry<Dual>) -> Self {
        Self {
            parts: PlanGeometry::of(model, topology, geometry),
            state: State::new(model, topology),
            selections: 0,
            drivers: vec![[Dual::constant(0.0); 3]; model.drivers.len()],
        }
    }

    /// Sets the state at the position of a mechanism whose coordinates have these derivatives along the direction, with
    /// the wrenches of all rows and the factors of all blocks.
    pub fn set(&mut self, model: &Model, mechanism: &Mechanism<'_>, speeds: &[f64]) {
        let (topology, from) = (&mechanism.topology, &mechanism.state);
        if std::mem::replace(&mut self.selections, mechanism.selections) != mechanism.selections {
            self.state = State::new(model, topology);
        }
        let state = &mut self.state;
        for ((q, x), d) in state.q.iter_mut().zip(&from.q).zip(speeds) {
            *q = Dual { v: *x, d: *d };
        }
        state.balls.iter_mut().zip(&from.balls).for_each(|(to, ball)| *to = ball.spread());
        state.turn_balls(topology, topology.link_ids());
        state.contacts.clear();
        let contacts = self.parts.curves.iter().zip(&from.contacts);
        state.contacts.extend(contacts.map(|(curve, contact)| Contact::at(curve, Dual::constant(contact.u))));
        state.near.iter_mut().zip(&from.near).for_each(|(to, near)| *to = Dual::constant(*near));
        state.stand_with_factors(topology, &self.parts, &self.drivers);
    }
}

//! How large a motion is: what its sensitivities, and their errors, are compared with.

use crate::model::{Dimension, Model};
use crate::motion::Motion;

/// What counts as no change at all: a natural step of the design
/// ([`natural_step`](crate::model::Model::natural_step)) would change the quantity by less than this part of the whole motion.
const NOTHING: f64 = 1e-10;

/// The magnitude of a motion at orders 0, 1 and 2. Of itself a mechanism has that of its size, turns of 1 rad, and no rates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Magnitude {
    /// Size of the mechanism, m.
    size: f64,
    /// Of orders 0, 1 and 2: lengths in sizes, angles in rad, per s to the power of the order.
    orders: [f64; 3],
    /// Mass, kg, and what pushes it besides, N: weights, given forces, and preloads.
    mass: f64,
    pushed: f64,
}

impl Magnitude {
    /// That of a mechanism which is at rest.
    pub fn at_rest(model: &Model) -> Self {
        let mass = model.mass();
        let given: f64 = model.elements.iter().map(|e| e.kind.push(model)).sum();
        let pushed = mass * model.gravity.norm() + given;
        Self { size: model.size(), orders: [1.0, 0.0, 0.0], mass, pushed }
    }

    /// That of a motion, where the whole of it is there.
    pub fn of_motion(model: &Model, motion: &Motion) -> Self {
        let mut magnitude = Self::at_rest(model);
        magnitude.add(motion);
        magnitude
    }

    /// Takes in a further part of the motion.
    pub fn add(&mut self, motion: &Motion) {
        let [_, rate, acceleration] = &mut self.orders;
        for s in motion.states() {
            *rate = rate.max(s.omega.norm()).max(s.v.norm() / self.size);
            *acceleration = acceleration.max(s.alpha.norm()).max(s.a.norm() / self.size);
        }
    }

    /// The same, but for orders that are round-off: where a motion is at rest or runs at a steady speed all the `span`, s, the next order
    /// counts as if the one before were gone through once in that time.
    #[must_use]
    pub fn or_once_in(mut self, span: f64) -> Self {
        /// An order that changes the one before it by less than this part during the run is round-off.
        const STEADY: f64 = 1e-12;
        for order in 1..3 {
            if self.orders[order] * span < STEADY * self.orders[order - 1] {
                self.orders[order] = self.orders[order - 1] / span;
            }
        }
        self
    }

    /// How large a quantity's time derivative of that order is in the motion, SI. Orders above 2 in all, those of the quantity itself
    /// included, count as 2.
    pub fn of(&self, quantity: Dimension, order: usize) -> f64 {
        let order = (order as i8 - quantity.time).clamp(0, 2) as usize;
        let order = self.orders[order] * self.size.powi(quantity.length.into());
        if quantity.force == 0 {
            return order;
        }
        let force = self.pushed + self.mass * self.orders[2] * self.size;
        // Without any it is 1 N.
        order * if force > 0.0 { force } else { 1.0 }.powi(quantity.force.into())
    }

    /// The largest change of a quantity's time derivative of that order over a natural step that is round-off, SI.
    pub fn round_off(&self, quantity: Dimension, order: usize) -> f64 {
        NOTHING * self.of(quantity, order)
    }
}

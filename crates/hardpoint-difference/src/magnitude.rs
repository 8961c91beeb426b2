//! Magnitude of a motion: the reference for its sensitivities and their errors.

use hardpoint::model::{Dimension, Metric, Model};
use hardpoint::motion::Motion;

/// Threshold of a zero change: a natural step of the design ([`natural_step`](hardpoint::model::Model::natural_step))
/// changes the quantity by less than this fraction of the whole motion.
const NOTHING: f64 = 1e-10;
/// Round-off of a value as a fraction of it, which may be much greater than the motion suggests.
const VALUE: f64 = 1e-12;

/// Magnitude of a motion at orders 0, 1 and 2. A mechanism at rest has the magnitude of its size, rotations of 1 rad,
/// and no rates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Magnitude {
    /// Size of the mechanism, m.
    size: f64,
    /// Magnitudes at orders 0, 1 and 2: lengths relative to the size, angles in rad, per s to the power of the order.
    orders: [f64; 3],
    /// Mass, kg, and applied forces, N: weights, given forces, and preloads.
    mass: f64,
    pushed: f64,
}

impl Magnitude {
    /// Magnitude of a mechanism at rest.
    pub fn at_rest(model: &Model) -> Self {
        let mass = model.mass();
        let given: f64 = model.elements.iter().map(|e| e.kind.given_force(model)).sum();
        let pushed = mass * model.gravity.norm() + given;
        Self { size: model.size(), orders: [1.0, 0.0, 0.0], mass, pushed }
    }

    /// Magnitude of a complete motion.
    pub fn of_motion(model: &Model, motion: &Motion) -> Self {
        let mut magnitude = Self::at_rest(model);
        magnitude.add(motion);
        magnitude
    }

    /// Adds a further part of the motion.
    pub fn add(&mut self, motion: &Motion) {
        let [_, rate, acceleration] = &mut self.orders;
        for s in motion.states() {
            *rate = rate.max(s.omega.norm()).max(s.v.norm() / self.size);
            *acceleration = acceleration.max(s.alpha.norm()).max(s.a.norm() / self.size);
        }
    }

    /// Replaces orders that are round-off. If a motion is at rest or runs at constant speed over the whole `span`, s,
    /// the next order becomes the one before divided by the span.
    #[must_use]
    fn or_once_in(mut self, span: f64) -> Self {
        /// An order is round-off if it changes the one before it by less than this fraction over the span.
        const STEADY: f64 = 1e-12;
        for order in 1..3 {
            if self.orders[order] * span < STEADY * self.orders[order - 1] {
                self.orders[order] = self.orders[order - 1] / span;
            }
        }
        self
    }

    /// Magnitude of the given time derivative of a quantity in the motion, SI. Total orders above 2, including those of
    /// the quantity itself, count as 2.
    pub fn of(&self, quantity: Dimension, order: usize) -> f64 {
        let order = (order as i8 - quantity.time).clamp(0, 2) as usize;
        let order = self.orders[order] * self.size.powi(quantity.length.into());
        if quantity.force == 0 {
            return order;
        }
        let force = self.pushed + self.mass * self.orders[2] * self.size;
        // 1 N if there are no forces.
        order * if force > 0.0 { force } else { 1.0 }.powi(quantity.force.into())
    }

    /// Magnitude of a complete motion, without orders that are round-off: see [`or_once_in`](Self::or_once_in).
    pub fn of_settled_motion(model: &Model, motion: &Motion) -> Self {
        let span = match &motion.times[..] {
            [first, .., last] => last - first,
            _ => 1.0,
        };
        Self::of_motion(model, motion).or_once_in(span)
    }

    /// Largest change of a metric over several designs that is still round-off, SI, from the value of one of them.
    pub fn metric_round_off(&self, model: &Model, metric: &Metric, value: Option<f64>) -> f64 {
        let of_motion = self.round_off(model.metric_dimension(metric), 0);
        of_motion.max(VALUE * value.unwrap_or_default().abs())
    }

    /// Largest difference of two solved values of a quantity that is still round-off, SI, from one of them.
    pub fn value_round_off(&self, quantity: Dimension, value: f64) -> f64 {
        VALUE * self.of(quantity, 0).max(value.abs())
    }

    /// Largest change of the given time derivative of a quantity over a natural step that is still round-off, SI.
    pub fn round_off(&self, quantity: Dimension, order: usize) -> f64 {
        NOTHING * self.of(quantity, order)
    }
}

//! Loads that joints, drivers and ground transmit.

use crate::model::Model;
use crate::number::Dual;
use crate::space::{Real, Wrench};

/// Loads that joints, drivers and ground transmit at a position.
#[derive(Clone, Debug)]
pub(crate) struct TransmittedLoads<T> {
    /// Per joint: its reaction wrench on body j, about the world origin.
    pub joints: Vec<Wrench<T>>,
    /// Per driver: its force or moment.
    pub drivers: Vec<T>,
    /// Per driver: the speed that it prescribes.
    pub speeds: Vec<T>,
    /// Wrench of the mechanism on ground, about the world origin.
    pub shaking: Wrench<T>,
}

impl<T: Real> TransmittedLoads<T> {
    pub fn new(model: &Model) -> Self {
        Self {
            joints: vec![Wrench::zero(); model.joints.len()],
            drivers: vec![T::zero(); model.drivers.len()],
            speeds: vec![T::zero(); model.drivers.len()],
            shaking: Wrench::zero(),
        }
    }
}

impl<T: Real> TransmittedLoads<Dual<T>> {
    /// Copies the values of `of`, without derivatives.
    pub fn set_constant(&mut self, of: &TransmittedLoads<T>) {
        self.joints.iter_mut().zip(&of.joints).for_each(|(to, from)| *to = from.constant());
        self.shaking = of.shaking.constant();
        set_constants(&mut self.drivers, &of.drivers);
        set_constants(&mut self.speeds, &of.speeds);
    }
}

/// Copies numbers, without derivatives.
pub(super) fn set_constants<T: Real>(to: &mut [Dual<T>], from: &[T]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = Dual::constant(*from));
}

/// Self-stress: wrenches on the joints due to a unit force of a redundant constraint.
pub(super) struct SelfStress<T> {
    pub loads: TransmittedLoads<T>,
    /// Largest joint reaction; moments are divided by the size of the mechanism.
    pub largest: T,
}

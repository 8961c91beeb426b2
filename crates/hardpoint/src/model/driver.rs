//! Drivers, and those that an equilibrium releases.

use super::id::{DriverId, JointId};
use crate::law::Law;
use crate::space::Real;

/// A prescribed motion of one joint coordinate, measured from the design configuration.
#[derive(Clone, Debug)]
pub struct Driver {
    /// Name.
    pub name: String,
    /// The joint that it drives.
    pub joint: JointId,
    /// Index of the coordinate in the joint's type.
    pub coordinate: usize,
    /// The driver's value over time, m or rad: the coordinate, or its opposite if the driver is reversed.
    pub law: Law,
    /// True if the coordinate moves in the opposite sense of the driver's values.
    pub is_reversed: bool,
}

impl Driver {
    /// Turns a change of the coordinate into that of the driver's value, and back: both count from the design
    /// configuration, and are opposite if the driver is reversed.
    pub fn with_sense<T: Real>(&self, change: T) -> T {
        if self.is_reversed { -change } else { change }
    }

    /// Law of the coordinate, m or rad; that of the driver's values is [`law`](Self::law).
    pub fn coordinate_law(&self) -> Law {
        if self.is_reversed { self.law.clone().reversed() } else { self.law.clone() }
    }
}

/// Static equilibrium at every output time: elastic joints open and some drivers move, until no force remains.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Equilibrium {
    /// Drivers that are not held: the forces on the mechanism determine their values.
    pub released: Vec<DriverId>,
}

//! Dimensions of numbers.

use crate::joint::Quantity;

/// Dimension of a number as powers of length, angle, time and force. The user's units follow from it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Dimension {
    /// Power of length.
    pub length: i8,
    /// Power of angle.
    pub angle: i8,
    /// Power of time.
    pub time: i8,
    /// Power of force.
    pub force: i8,
}

impl Dimension {
    /// A plain number.
    pub const NUMBER: Self = Self { length: 0, angle: 0, time: 0, force: 0 };
    /// A length.
    pub const LENGTH: Self = Self { length: 1, ..Self::NUMBER };
    /// An angle.
    pub const ANGLE: Self = Self { angle: 1, ..Self::NUMBER };
    /// A force.
    pub const FORCE: Self = Self { force: 1, ..Self::NUMBER };
    /// A moment, or an energy.
    pub const MOMENT: Self = Self { force: 1, ..Self::LENGTH };

    /// Exponent of the user's unit of length: moments, energies and powers are in N m, J and W for any unit of length,
    /// and what is given per moment is per N m.
    pub const fn length_in_units(self) -> i8 {
        let of_moment = self.force > 0 && self.length > 0;
        let per_moment = self.force < 0 && self.length < 0;
        if of_moment || per_moment { 0 } else { self.length }
    }

    /// That of the time derivative of this order; of -1 that of an integral over time.
    #[must_use]
    pub const fn rate(self, order: i8) -> Self {
        Self { time: self.time - order, ..self }
    }

    /// That of a quotient.
    #[must_use]
    pub const fn over(self, o: Self) -> Self {
        Self {
            length: self.length - o.length,
            angle: self.angle - o.angle,
            time: self.time - o.time,
            force: self.force - o.force,
        }
    }

    /// That of a product; of a moment and an angle that of a work.
    #[must_use]
    pub const fn times(self, o: Self) -> Self {
        let product = self.over(Self::NUMBER.over(o));
        let is_work = product.force == 1 && product.length == 1 && product.angle == 1;
        Self { angle: if is_work { 0 } else { product.angle }, ..product }
    }
}

impl From<Quantity> for Dimension {
    fn from(quantity: Quantity) -> Self {
        match quantity {
            Quantity::Length => Self::LENGTH,
            Quantity::Angle => Self::ANGLE,
            Quantity::Number => Self::NUMBER,
        }
    }
}

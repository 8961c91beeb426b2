//! Units of the user, converted here and nowhere else.
//!
//! All internal numbers are in metres, radians and seconds. A file declares its units once; results are shown in the
//! same units. Time is always in seconds.

use hardpoint::joint::Quantity;
use hardpoint::model::{Dimension, ElementUnit};
use serde::Serialize;

/// A unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub enum LengthUnit {
    /// Millimetre.
    #[serde(rename = "mm")]
    Millimetre,
    /// Centimetre.
    #[serde(rename = "cm")]
    Centimetre,
    /// Metre.
    #[default]
    #[serde(rename = "m")]
    Metre,
    /// Inch, 25.4 mm.
    #[serde(rename = "in")]
    Inch,
}

impl LengthUnit {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Millimetre, Self::Centimetre, Self::Metre, Self::Inch];

    /// Symbol in files and results.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
            Self::Inch => "in",
        }
    }

    /// The unit with this symbol.
    pub fn of_symbol(symbol: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.symbol() == symbol)
    }

    /// Number of units per metre.
    pub const fn per_metre(self) -> f64 {
        match self {
            Self::Millimetre => 1000.0,
            Self::Centimetre => 100.0,
            Self::Metre => 1.0,
            Self::Inch => 1.0 / 0.0254,
        }
    }

    /// Converts a length to m.
    pub fn metres(self, length: f64) -> f64 {
        // Multiplying by 1e-3 would round twice: 345.44 mm must be the double nearest to 0.34544 m.
        match self {
            Self::Inch => length * 0.0254,
            unit => length / unit.per_metre(),
        }
    }
}

/// A unit of angle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub enum AngleUnit {
    /// Degree.
    #[serde(rename = "deg")]
    Degree,
    /// Radian.
    #[default]
    #[serde(rename = "rad")]
    Radian,
}

impl AngleUnit {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Degree, Self::Radian];

    /// Symbol in files and results.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Degree => "deg",
            Self::Radian => "rad",
        }
    }

    /// The unit with this symbol.
    pub fn of_symbol(symbol: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.symbol() == symbol)
    }

    /// Number of units per radian.
    pub const fn per_radian(self) -> f64 {
        match self {
            Self::Degree => 180.0 / std::f64::consts::PI,
            Self::Radian => 1.0,
        }
    }

    /// Converts an angle to rad.
    pub fn radians(self, angle: f64) -> f64 {
        match self {
            Self::Degree => angle.to_radians(),
            Self::Radian => angle,
        }
    }
}

/// Units of a file; metres and radians by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Units {
    /// Unit of every length.
    pub length: LengthUnit,
    /// Unit of every angle.
    pub angle: AngleUnit,
}

impl Units {
    /// Symbol of the unit, and the number of units per SI unit.
    ///
    /// ```
    /// use hardpoint::joint::Quantity;
    /// use hardpoint_table::{AngleUnit, LengthUnit, Units};
    ///
    /// let units = Units { length: LengthUnit::Millimetre, angle: AngleUnit::Degree };
    /// assert_eq!(units.of(Quantity::Length), ("mm", 1000.0));
    /// assert_eq!(units.of(Quantity::Number), ("", 1.0));
    /// ```
    pub const fn of(self, quantity: Quantity) -> (&'static str, f64) {
        match quantity {
            Quantity::Length => (self.length.symbol(), self.length.per_metre()),
            Quantity::Angle => (self.angle.symbol(), self.angle.per_radian()),
            Quantity::Number => ("", 1.0),
        }
    }

    /// Converts a value in the user's unit to SI.
    pub fn to_si(self, quantity: Quantity, value: f64) -> f64 {
        match quantity {
            Quantity::Length => self.length.metres(value),
            Quantity::Angle => self.angle.radians(value),
            Quantity::Number => value,
        }
    }

    /// Number of the user's units per SI unit.
    pub fn per_si(self, of: impl Into<Dimension>) -> f64 {
        let of = of.into();
        // Moments, energies and powers are in N m, J and W.
        power(self.length.per_metre(), of.length_in_units()) * power(self.angle.per_radian(), of.angle)
    }

    /// Number of the user's units per SI unit, for numbers of masses and forces: kg, N and N m, per the user's unit of
    /// length or angle.
    pub fn per_si_of(self, unit: ElementUnit) -> f64 {
        let (length, angle) = (self.length.per_metre(), self.angle.per_radian());
        match unit {
            ElementUnit::Length => length,
            ElementUnit::Angle => angle,
            ElementUnit::Stiffness | ElementUnit::Damping => 1.0 / length,
            ElementUnit::CubicStiffness => 1.0 / (length * length * length),
            ElementUnit::CubicTorsionalStiffness => 1.0 / (angle * angle * angle),
            ElementUnit::TorsionalStiffness | ElementUnit::TorsionalDamping | ElementUnit::Coupling => {
                1.0 / angle
            }
            ElementUnit::Mass
            | ElementUnit::Inertia
            | ElementUnit::Density
            | ElementUnit::Force
            | ElementUnit::Moment
            | ElementUnit::Plain => 1.0,
        }
    }

    /// Converts a number of a mass or force to SI.
    pub fn to_si_of(self, unit: ElementUnit, value: f64) -> f64 {
        match unit {
            ElementUnit::Length => self.length.metres(value),
            ElementUnit::Angle => self.angle.radians(value),
            unit => value / self.per_si_of(unit),
        }
    }

    /// Converts a value in SI to the user's unit.
    pub fn from_si(self, of: impl Into<Dimension>, value: f64) -> f64 {
        value * self.per_si(of)
    }

    /// Converts a value in SI to the number of the user's unit with the fewest digits that is read as this value: a
    /// number of the user comes back as it was written.
    ///
    /// ```
    /// use hardpoint::joint::Quantity;
    /// use hardpoint_table::{AngleUnit, Units};
    ///
    /// let units = Units { angle: AngleUnit::Degree, ..Units::default() };
    /// let angle = units.to_si(Quantity::Angle, -30.0);
    /// assert_eq!(units.from_si(Quantity::Angle, angle), -29.999999999999996);
    /// assert_eq!(units.shortest_from_si(Quantity::Angle, angle), -30.0);
    /// ```
    pub fn shortest_from_si(self, quantity: Quantity, value: f64) -> f64 {
        let exact = self.from_si(quantity, value);
        let rounded = |digits: usize| format!("{exact:.digits$e}").parse::<f64>().unwrap_or(exact);
        (0..17).map(rounded).find(|x| self.to_si(quantity, *x) == value).unwrap_or(exact)
    }

    /// Converts a derivative "`of` per `by`" from SI to the user's units.
    ///
    /// ```
    /// use hardpoint::joint::Quantity;
    /// use hardpoint_table::{AngleUnit, LengthUnit, Units};
    ///
    /// // A toe that changes by 1 rad per metre changes by 0.0573 deg per millimetre.
    /// let units = Units { length: LengthUnit::Millimetre, angle: AngleUnit::Degree };
    /// let slope = units.derivative_from_si(Quantity::Angle, Quantity::Length, 1.0);
    /// assert!((slope - 0.0572958).abs() < 1e-7);
    /// ```
    pub fn derivative_from_si(self, of: impl Into<Dimension>, by: Quantity, value: f64) -> f64 {
        value * (self.per_si(of) / self.per_si(by))
    }
}

/// Integer power of `x`. It is called for every number that is written, so common powers avoid the library function.
fn power(x: f64, exponent: i8) -> f64 {
    match exponent {
        0 => 1.0,
        1 => x,
        -1 => 1.0 / x,
        other => x.powi(other.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_converts_there_and_back() {
        for length in LengthUnit::ALL {
            for angle in AngleUnit::ALL {
                let units = Units { length, angle };
                for q in [Quantity::Length, Quantity::Angle, Quantity::Number] {
                    let back = units.from_si(q, units.to_si(q, 12.34));
                    assert!((back - 12.34).abs() < 1e-14, "{units:?} {q:?}");
                }
            }
        }
    }

    #[test]
    fn decimal_millimetres_are_the_nearest_double_in_metres() {
        for (mm, m) in [(345.44, 0.34544), (-59.69, -0.05969), (0.1, 0.0001), (574.803759, 0.574803759)] {
            assert_eq!(LengthUnit::Millimetre.metres(mm), m);
        }
        assert_eq!(LengthUnit::Inch.metres(10.0), 0.254);
        assert_eq!(AngleUnit::Degree.radians(180.0), std::f64::consts::PI);
    }
}

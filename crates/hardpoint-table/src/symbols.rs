//! Units of data by their symbols, such as `kN`, `deg/(N*m)` or `mm/s^2`.

use std::f64::consts::TAU;

use hardpoint::model::Dimension;

use crate::{AngleUnit, LengthUnit};

/// Weight of one pound, N.
const POUND_FORCE: f64 = 0.45359237 * KILOGRAM_FORCE;
/// Weight of one kilogram, N.
const KILOGRAM_FORCE: f64 = 9.80665;

/// A unit of data: its size and what it measures.
///
/// ```
/// use hardpoint::model::Dimension;
/// use hardpoint_table::Unit;
///
/// let unit = Unit::of_symbol("deg/(kN*m)").unwrap();
/// assert_eq!(unit.dimension, Dimension::ANGLE.over(Dimension::MOMENT));
/// assert!((unit.size - 1f64.to_radians() / 1000.0).abs() < 1e-18);
/// assert_eq!(Unit::of_symbol("N mm").map(|unit| unit.size), Some(1e-3));
/// assert_eq!(Unit::of_symbol("furlong"), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Size in m, rad, s and N.
    pub size: f64,
    /// Dimension.
    pub dimension: Dimension,
}

impl Unit {
    const ONE: Self = Self { size: 1.0, dimension: Dimension::NUMBER };

    /// The unit that a symbol denotes: factors after `*`, `·` or a blank, with exponents, and divisors after `/`, in
    /// brackets if there are several. A letter's case counts: `mN` is not `MN`.
    pub fn of_symbol(symbol: &str) -> Option<Self> {
        let symbol = symbol.replace('²', "^2").replace('³', "^3");
        let mut unit = Self::ONE;
        for (k, part) in symbol.split('/').enumerate() {
            let part = part.trim();
            let divisors = part.strip_prefix('(').and_then(|part| part.strip_suffix(')')).filter(|_| k > 0);
            let is_gap = |c: char| c.is_whitespace() || c == '*' || c == '·';
            let mut factors = divisors.unwrap_or(part).split(is_gap).filter(|f| !f.is_empty()).peekable();
            factors.peek()?;
            for (place, factor) in factors.enumerate() {
                let (name, exponent) = factor.split_once('^').unwrap_or((factor, "1"));
                let exponent: i8 = exponent.parse().ok().filter(|power: &i8| power.abs() <= MOST)?;
                let is_divisor = k > 0 && (place == 0 || divisors.is_some());
                unit = unit.times(Self::named(name)?, if is_divisor { -exponent } else { exponent });
            }
        }
        Some(unit)
    }

    /// Product with a power of another unit.
    fn times(self, other: Self, exponent: i8) -> Self {
        let Dimension { length, angle, time, force } = other.dimension;
        let [length, angle, time, force] = [length, angle, time, force].map(|power| power * exponent);
        let of = self.dimension;
        let dimension = Dimension {
            length: of.length + length,
            angle: of.angle + angle,
            time: of.time + time,
            force: of.force + force,
        };
        Self { size: self.size * other.size.powi(exponent.into()), dimension }
    }

    /// The unit of a name without factors.
    fn named(name: &str) -> Option<Self> {
        const TIME: Dimension = Dimension::NUMBER.rate(-1);
        let (dimension, size) = match (LengthUnit::of_symbol(name), AngleUnit::of_symbol(name)) {
            (Some(length), _) => (Dimension::LENGTH, length.metres(1.0)),
            (None, Some(angle)) => (Dimension::ANGLE, angle.radians(1.0)),
            (None, None) => match name {
                "1" => (Dimension::NUMBER, 1.0),
                "%" => (Dimension::NUMBER, 0.01),
                "um" | "µm" => (Dimension::LENGTH, 1e-6),
                "km" => (Dimension::LENGTH, 1e3),
                "ft" => (Dimension::LENGTH, 0.3048),
                "°" => (Dimension::ANGLE, 1f64.to_radians()),
                "mrad" => (Dimension::ANGLE, 1e-3),
                "rev" => (Dimension::ANGLE, TAU),
                "s" => (TIME, 1.0),
                "ms" => (TIME, 1e-3),
                "min" => (TIME, 60.0),
                "h" => (TIME, 3600.0),
                "rpm" => (Dimension::ANGLE.rate(1), TAU / 60.0),
                "N" => (Dimension::FORCE, 1.0),
                "mN" => (Dimension::FORCE, 1e-3),
                "kN" => (Dimension::FORCE, 1e3),
                "MN" => (Dimension::FORCE, 1e6),
                "kgf" => (Dimension::FORCE, KILOGRAM_FORCE),
                "lbf" => (Dimension::FORCE, POUND_FORCE),
                "Nm" | "J" => (Dimension::MOMENT, 1.0),
                "Nmm" => (Dimension::MOMENT, 1e-3),
                "kNm" | "kJ" => (Dimension::MOMENT, 1e3),
                "W" => (Dimension::MOMENT.rate(1), 1.0),
                "kW" => (Dimension::MOMENT.rate(1), 1e3),
                _ => return None,
            },
        };
        Some(Self { size, dimension })
    }
}

/// Largest exponent of a factor.
const MOST: i8 = 9;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Units;
    use crate::figures::unit;

    #[test]
    fn every_unit_of_results_is_read_with_its_size() {
        let dimensions = [
            Dimension::NUMBER,
            Dimension::LENGTH.rate(2),
            Dimension::ANGLE.over(Dimension::LENGTH).rate(1),
            Dimension::ANGLE.over(Dimension::FORCE),
            Dimension::ANGLE.over(Dimension::MOMENT),
            Dimension::LENGTH.over(Dimension::MOMENT),
            Dimension::NUMBER.over(Dimension::LENGTH),
            Dimension::MOMENT,
            Dimension::MOMENT.rate(1),
            Dimension::FORCE.over(Dimension::LENGTH),
        ];
        for length in LengthUnit::ALL {
            for angle in AngleUnit::ALL {
                let units = Units { length, angle };
                for of in dimensions {
                    let symbol = unit(units, of);
                    let found = Unit::of_symbol(&symbol).unwrap_or_else(|| panic!("{symbol}"));
                    assert_eq!(found.dimension, of, "{symbol}");
                    assert!((found.size * units.per_si(of) - 1.0).abs() < 1e-14, "{symbol}: {found:?}");
                }
            }
        }
        for unknown in ["", "N/", "(N)", "N^x", "kn", "N/()"] {
            assert_eq!(Unit::of_symbol(unknown), None, "{unknown}");
        }
    }
}

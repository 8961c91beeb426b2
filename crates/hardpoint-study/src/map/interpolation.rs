//! Interpolations of a table, with bounds of their error.

use hardpoint::number::{Exponents, Interval, Real};

/// Interpolation in a cell, driver by driver (tensor product).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Cubic, from values and derivatives at both ends.
    #[default]
    Hermite,
    /// Linear between the values.
    Linear,
}

/// `|f - H f| <= h^4 / 384 max |f''''|`, by the remainder `f''''(x) s^2 (h - s)^2 / 24`.
const HERMITE: f64 = 1.0 / 384.0;
/// `|f - L f| <= h^2 / 8 max |f''|`.
const LINEAR: f64 = 1.0 / 8.0;
/// Largest sum of the weights of the derivatives at both ends, in units of h: s (1 - s) <= 1/4.
const SLOPES: f64 = 1.0 / 4.0;

impl Interpolation {
    /// Name in files and arguments.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hermite => "hermite",
            Self::Linear => "linear",
        }
    }

    /// Orders of the derivatives that a table has at each position: the value first.
    pub fn orders(self, drivers: usize) -> Vec<Exponents> {
        let all = (0..1_usize << drivers).map(|bits| [0, 1, 2].map(|n| (bits >> n & 1) as u8));
        match self {
            Self::Hermite => all.collect(),
            Self::Linear => vec![[0; 3]],
        }
    }

    /// Orders of the derivatives that bound its error: per driver, that of the remainder along this driver and, for the
    /// drivers before it, those with a first derivative by any of them.
    pub(super) fn remainders(self, drivers: usize) -> Vec<(usize, Exponents)> {
        let mut all = Vec::new();
        for n in 0..drivers {
            match self {
                Self::Hermite => {
                    for bits in 0..1_usize << n {
                        let mut order = [0, 1, 2].map(|k| u8::from(k < n && bits >> k & 1 == 1));
                        order[n] = 4;
                        all.push((n, order));
                    }
                }
                Self::Linear => {
                    let mut order = [0; 3];
                    order[n] = 2;
                    all.push((n, order));
                }
            }
        }
        all
    }

    /// Factor of the largest magnitude of the derivative of one of [`remainders`](Self::remainders) in the bound, in a
    /// cell of these widths.
    ///
    /// `f - H_1 H_2 H_3 f = (1 - H_1) f + H_1 (1 - H_2) f + H_1 H_2 (1 - H_3) f`, and
    /// `|H_k g| <= max |g| + h_k / 4 max |dg/dx_k|`.
    pub(super) fn factor(self, (n, order): (usize, Exponents), widths: &[f64]) -> Interval {
        let exact = Interval::constant;
        match self {
            Self::Hermite => {
                let slopes = (0..n).filter(|k| order[*k] == 1);
                let remainder = exact(widths[n]).powi(4) * exact(HERMITE);
                slopes.fold(remainder, |factor, k| factor * exact(widths[k]) * exact(SLOPES))
            }
            Self::Linear => exact(widths[n]).powi(2) * exact(LINEAR),
        }
    }

    /// Factor of the error of a number of the table in that of the interpolation.
    pub(super) fn data_factor(self, order: Exponents, widths: &[f64]) -> Interval {
        let exact = Interval::constant;
        let with_slope = (0..widths.len()).filter(|k| order[*k] == 1);
        with_slope.fold(exact(1.0), |factor, k| factor * exact(widths[k]) * exact(SLOPES))
    }

    /// Weights of the value and the derivative at the start and the end of an interval of width h, at its fraction s.
    pub(super) fn weights(self, s: f64, h: f64) -> [[f64; 2]; 2] {
        let r = 1.0 - s;
        match self {
            Self::Hermite => {
                [[r * r * (1.0 + 2.0 * s), h * s * r * r], [s * s * (1.0 + 2.0 * r), -h * s * s * r]]
            }
            Self::Linear => [[r, 0.0], [s, 0.0]],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_reached_by_the_polynomials_of_the_remainder() {
        // f = x^4 / 24 over [0, h]: the error is s^2 (h - s)^2 / 24, largest in the middle: h^4 / 384.
        let h = 0.7_f64;
        let [[a, da], [b, db]] = Interpolation::Hermite.weights(0.5, h);
        let (value, slope) = (h.powi(4) / 24.0, h.powi(3) / 6.0);
        let error = (h / 2.0).powi(4) / 24.0 - (a * 0.0 + da * 0.0 + b * value + db * slope);
        let bound = Interpolation::Hermite.factor((0, [4, 0, 0]), &[h]);
        assert!((error - bound.middle()).abs() < 1e-15 && error > 0.0);
        // f = x^2 / 2: h^2 / 8
        let [[_, _], [b, _]] = Interpolation::Linear.weights(0.5, h);
        let error = b * h * h / 2.0 - h * h / 8.0;
        assert!((error - Interpolation::Linear.factor((0, [2, 0, 0]), &[h]).middle()).abs() < 1e-15);
    }

    #[test]
    fn remainders_of_three_drivers_have_first_derivatives_by_the_drivers_before() {
        let of = Interpolation::Hermite.remainders(3);
        let orders: Vec<Exponents> = of.iter().map(|(_, order)| *order).collect();
        assert_eq!(orders, [[4, 0, 0], [0, 4, 0], [1, 4, 0], [0, 0, 4], [1, 0, 4], [0, 1, 4], [1, 1, 4]]);
    }
}

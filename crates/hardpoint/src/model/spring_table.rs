//! Forces and moments of springs by tables.

use std::ops::{Add, Mul};

use crate::linalg::{Cubic, monotone};
use crate::model::NumberId;
use crate::number::Real;

/// A force over a deflection, as a curve through points: monotone where these are, with a continuous slope; beyond the
/// last point on either side it continues with the slope there.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringTable {
    /// Deflections of the points, m or rad, the same in every design.
    deflections: Vec<f64>,
    /// Forces of the points in the nominal design, N, or moments, N m; both grow in tension.
    forces: Vec<f64>,
    /// Pieces between the points in the nominal design.
    pieces: Vec<Cubic<f64>>,
    /// Numbers of these forces; empty if they are the same in every design.
    numbers: Vec<NumberId>,
}

impl SpringTable {
    /// Table through these points: at least two, all finite, with increasing deflections.
    ///
    /// # Errors
    /// The end of a sentence, such as "has 1 point".
    pub fn new(points: &[[f64; 2]]) -> Result<Self, String> {
        if points.len() < 2 {
            return Err(format!("has {} of at least 2 points", points.len()));
        }
        if points.iter().flatten().any(|x| !x.is_finite()) {
            return Err("has a number that is not finite".into());
        }
        if points.windows(2).any(|p| p[1][0] <= p[0][0]) {
            return Err("does not increase from point to point".into());
        }
        let [deflections, forces] = [0, 1].map(|k| points.iter().map(|p| p[k]).collect::<Vec<f64>>());
        let pieces = (1..points.len()).map(|k| monotone(&deflections, |k| forces[k], k - 1)).collect();
        Ok(Self { deflections, forces, pieces, numbers: Vec::new() })
    }

    /// The same table with forces that depend on the design: the numbers of all points.
    pub(crate) fn with_numbers(self, numbers: Vec<NumberId>) -> Self {
        Self { numbers, ..self }
    }

    /// Points in the nominal design: deflection and force, or angle and moment, in SI units.
    pub fn points(&self) -> impl DoubleEndedIterator<Item = [f64; 2]> + ExactSizeIterator {
        self.deflections.iter().zip(&self.forces).map(|(x, y)| [*x, *y])
    }

    /// Adjacent points in the nominal design.
    pub(crate) fn chords(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        self.points().zip(self.points().skip(1)).map(|(from, to)| [from, to])
    }

    /// Numbers of the forces of the points; empty if the forces are the same in every design.
    pub fn numbers(&self) -> &[NumberId] {
        &self.numbers
    }

    /// Deflection at the first point, or at the last point if `last`; and true if two points there have the same force,
    /// which continues beyond them.
    pub fn end(&self, last: bool) -> (f64, bool) {
        let n = self.forces.len();
        let [end, beside] = if last { [n - 1, n - 2] } else { [0, 1] };
        (self.deflections[end], self.forces[end] == self.forces[beside])
    }

    /// Force at a deflection in the nominal design.
    pub fn force(&self, deflection: f64) -> f64 {
        self.nominal(deflection)[0]
    }

    /// The force at a deflection in the nominal design, and its slope there.
    pub(crate) fn nominal<T: Real>(&self, deflection: T) -> [T; 2] {
        let k = self.piece(deflection.value());
        self.on_piece(k, &self.pieces[k], deflection)
    }

    /// The force at a deflection, and its slope there, with the values of numbers in a design.
    pub(crate) fn at<T: Real>(&self, deflection: T, number: impl Fn(NumberId) -> T) -> [T; 2] {
        if self.numbers.is_empty() {
            return self.nominal(deflection);
        }
        let k = self.piece(deflection.value());
        let piece = monotone(&self.deflections, |k| number(self.numbers[k]), k);
        self.on_piece(k, &piece, deflection)
    }

    /// Piece of a deflection: the first or last one beyond the table.
    fn piece(&self, x: f64) -> usize {
        self.deflections.partition_point(|start| *start <= x).saturating_sub(1).min(self.pieces.len() - 1)
    }

    /// Value and slope on a piece, or on the line that continues it beyond the table.
    fn on_piece<T, C>(&self, k: usize, c: &Cubic<C>, deflection: T) -> [T; 2]
    where
        T: Real + Add<C, Output = T> + Mul<C, Output = T>,
        C: Copy + Mul<f64, Output = C>,
    {
        let start = self.deflections[k];
        let end = self.deflections[k + 1] - start;
        let s = deflection + -start;
        let line = |from: f64| {
            let [value, slope] = cubic(c, T::constant(from));
            [(s + -from) * slope + value, slope]
        };
        if k == 0 && s.value() < 0.0 {
            line(0.0)
        } else if k + 1 == self.pieces.len() && s.value() > end {
            line(end)
        } else {
            cubic(c, s)
        }
    }
}

impl AsRef<Self> for SpringTable {
    fn as_ref(&self) -> &Self {
        self
    }
}

/// A moment over an angle, as a curve through points: angle, rad, and moment, N m.
#[derive(Clone, Debug, PartialEq)]
pub struct MomentTable(pub SpringTable);

impl AsRef<SpringTable> for MomentTable {
    fn as_ref(&self) -> &SpringTable {
        &self.0
    }
}

/// Value and slope of a cubic.
fn cubic<T, C>(c: &Cubic<C>, s: T) -> [T; 2]
where
    T: Real + Add<C, Output = T> + Mul<C, Output = T>,
    C: Copy + Mul<f64, Output = C>,
{
    let value = ((s * c[3] + c[2]) * s + c[1]) * s + c[0];
    let slope = (s * (c[3] * 3.0) + c[2] * 2.0) * s + c[1];
    [value, slope]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Dual;

    #[test]
    fn slopes_are_derivatives_inside_and_beyond_the_table() {
        let table = SpringTable::new(&[[-0.02, -300.0], [0.0, 0.0], [0.01, 50.0], [0.03, 900.0]]).unwrap();
        for x in [-0.05, -0.02, -0.013, 0.0, 0.004, 0.029, 0.03, 0.06] {
            let [force, slope] = table.nominal(Dual::variable(x));
            assert!((force.d - slope.v).abs() < 1e-9 * (1.0 + slope.v.abs()), "{x}: {force:?} {slope:?}");
        }
        // A straight line beyond either end, without a jump.
        let [a, b, c] = [0.03, 0.04, 0.05].map(|x| table.nominal(x)[0]);
        assert!((a - 900.0).abs() < 1e-12 * 900.0 && (c - 2.0 * b + a).abs() < 1e-9);
        let [a, b, c] = [-0.02, -0.03, -0.04].map(|x| table.nominal(x)[0]);
        assert!((a + 300.0).abs() < 1e-12 * 300.0 && (c - 2.0 * b + a).abs() < 1e-9);
    }

    #[test]
    fn forces_of_points_as_numbers_make_the_same_curve_with_derivatives_by_them() {
        let points = [[-0.02, -300.0], [0.0, 10.0], [0.01, 50.0], [0.03, 900.0]];
        let table = SpringTable::new(&points).unwrap();
        let follows = table.clone().with_numbers((0..4).map(NumberId).collect());
        for x in [-0.05, -0.02, -0.013, 0.0, 0.004, 0.029, 0.03, 0.06] {
            for by in 0..4 {
                let rate = |k: usize| if k == by { 1.0 } else { 0.0 };
                let number = |n: NumberId| Dual { v: points[n.0][1], d: rate(n.0) };
                let found = follows.at(Dual { v: x, d: 0.0 }, number);
                let h = 1e-3;
                let [below, above] = [-h, h].map(|h| {
                    let moved: Vec<_> = (0..4).map(|k| [points[k][0], points[k][1] + h * rate(k)]).collect();
                    SpringTable::new(&moved).unwrap().nominal(x)
                });
                for (k, [value, expected]) in [0, 1].map(|k| (k, [found[k].v, table.nominal(x)[k]])) {
                    assert!(
                        (value - expected).abs() < 1e-12 * (1.0 + expected.abs()),
                        "{x}: {value} {expected}"
                    );
                    let difference = (above[k] - below[k]) / (2.0 * h);
                    assert!(
                        (found[k].d - difference).abs() < 1e-6 * (1.0 + difference.abs()),
                        "{x} {by} {k}"
                    );
                }
            }
        }
    }
}

//! Forces and moments of springs by tables.

use crate::linalg::{Segment, monotone};
use crate::number::Real;

/// A force over a deflection, as a curve through points: monotone where these are, with a continuous slope; beyond the
/// last point on either side it continues with the slope there.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringTable {
    /// Deflection, m, and force, N, or angle, rad, and moment, N m; both grow in tension.
    points: Vec<[f64; 2]>,
    segments: Vec<Segment>,
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
        Ok(Self { points: points.to_vec(), segments: monotone(points) })
    }

    /// The same force where it is given over the way that the ends have come nearer, as a push.
    #[must_use]
    pub(crate) fn turned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
        points.iter().rev().map(|p| p.map(|x| 0.0 - x)).collect()
    }

    /// Points: deflection and force, or angle and moment, in SI units.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Deflection at the first point, or at the last point if `last`; and true if two points there have the same force,
    /// which continues beyond them.
    pub fn end(&self, last: bool) -> (f64, bool) {
        let n = self.points.len();
        let [end, beside] = if last { [n - 1, n - 2] } else { [0, 1] }.map(|k| self.points[k]);
        (end[0], end[1] == beside[1])
    }

    /// Force at a deflection.
    pub fn force(&self, deflection: f64) -> f64 {
        self.at(deflection)[0]
    }

    /// The force at a deflection, and its slope there.
    pub(crate) fn at<T: Real>(&self, deflection: T) -> [T; 2] {
        let x = deflection.value();
        let last = self.segments.len() - 1;
        let k = self.points.partition_point(|p| p[0] <= x).saturating_sub(1).min(last);
        let c = &self.segments[k];
        let start = self.points[k][0];
        let end = self.points[k + 1][0] - start;
        let s = deflection + -start;
        let line = |value: f64, slope: f64, from: f64| [(s + -from) * slope + value, T::constant(slope)];
        if k == 0 && x < start {
            line(c[0], c[1], 0.0)
        } else if k == last && x - start > end {
            let [value, slope] = cubic(c, end);
            line(value, slope, end)
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
fn cubic<T: Real>(c: &Segment, s: T) -> [T; 2] {
    let value = ((s * c[3] + c[2]) * s + c[1]) * s + c[0];
    let slope = (s * (3.0 * c[3]) + 2.0 * c[2]) * s + c[1];
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
            let [force, slope] = table.at(Dual::variable(x));
            assert!((force.d - slope.v).abs() < 1e-9 * (1.0 + slope.v.abs()), "{x}: {force:?} {slope:?}");
        }
        // A straight line beyond either end, without a jump.
        let [a, b, c] = [0.03, 0.04, 0.05].map(|x| table.at(x)[0]);
        assert!((a - 900.0).abs() < 1e-12 * 900.0 && (c - 2.0 * b + a).abs() < 1e-9);
        let [a, b, c] = [-0.02, -0.03, -0.04].map(|x| table.at(x)[0]);
        assert!((a + 300.0).abs() < 1e-12 * 300.0 && (c - 2.0 * b + a).abs() < 1e-9);
    }
}

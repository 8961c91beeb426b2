//! Sensitivities of all bodies over a motion, stored.

use hardpoint_tape::Lanes;

use crate::blocks::{Blocks, ResultRow};
use crate::model::{BodyId, VariableId};
use crate::space::Vec3;

use super::Admissibility;

/// Derivatives by one design variable b of one body's state, global components, per unit of b at fixed t.
///
/// | field | derivative of | unit (per unit of b) |
/// |---|---|---|
/// | `dr`, `dv`, `da` | position, velocity, acceleration of the frame's origin | m, m/s, m/s^2 |
/// | `dpi` | orientation: dA/db = skew(dpi) A | rad |
/// | `domega`, `dalpha` | angular velocity and acceleration | rad/s, rad/s^2 |
///
/// All are plain derivatives; in particular domega = d(dpi)/dt + dpi x omega.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodySensitivity {
    /// Derivative of the position.
    pub dr: Vec3,
    /// Derivative of the orientation, as a rotation vector.
    pub dpi: Vec3,
    /// Derivative of the velocity.
    pub dv: Vec3,
    /// Derivative of the angular velocity.
    pub domega: Vec3,
    /// Derivative of the acceleration.
    pub da: Vec3,
    /// Derivative of the angular acceleration.
    pub dalpha: Vec3,
}

impl BodySensitivity {
    /// Number of values.
    pub(crate) const NUMBERS: usize = 18;

    /// From them, in the order of the fields.
    #[inline(always)]
    pub(crate) fn from(number: impl Fn(usize) -> f64) -> Self {
        let vector = |k: usize| Vec3::new(number(3 * k), number(3 * k + 1), number(3 * k + 2));
        Self {
            dr: vector(0),
            dpi: vector(1),
            dv: vector(2),
            domega: vector(3),
            da: vector(4),
            dalpha: vector(5),
        }
    }

    /// All of them, in the order of the fields.
    #[inline(always)]
    pub(crate) fn numbers(&self) -> impl Iterator<Item = f64> {
        let all = [self.dr, self.dpi, self.dv, self.domega, self.da, self.dalpha];
        all.into_iter().flat_map(Vec3::to_array)
    }

    /// No change.
    pub const ZERO: Self = Self {
        dr: Vec3::ZERO,
        dpi: Vec3::ZERO,
        dv: Vec3::ZERO,
        domega: Vec3::ZERO,
        da: Vec3::ZERO,
        dalpha: Vec3::ZERO,
    };
}

/// Sensitivities of all bodies over a solved motion.
#[derive(Clone, Debug, Default)]
pub struct Sensitivities {
    /// Number of variables.
    pub variables: usize,
    /// Number of bodies, ground included.
    pub bodies: usize,
    /// Admissibility per variable.
    pub admissibility: Vec<Admissibility>,
    /// Derivatives of every body by every variable that moves it.
    pub(crate) derivatives: Blocks,
    /// `places[b * bodies + i]`: where the numbers of body i by variable b begin, if b moves it.
    places: Vec<Option<usize>>,
}

impl Sensitivities {
    /// Sensitivities of all bodies at output time k by variable b; `None` if the variable is not admissible.
    pub fn at(&self, k: usize, b: usize) -> Option<Derivatives<'_>> {
        if matches!(self.admissibility[b], Admissibility::CannotFollow { .. }) {
            return None;
        }
        let places = &self.places[b * self.bodies..(b + 1) * self.bodies];
        Some(Derivatives { row: self.derivatives.row(k), places })
    }

    /// Largest norms over all bodies and the first `steps` output times by variable b, in the order of the fields of
    /// [`BodySensitivity`]; zero if the variable is not admissible.
    pub fn largest(&self, steps: usize, b: usize) -> [f64; 6] {
        let mut largest = [0.0; 6];
        for derivatives in (0..steps).filter_map(|k| self.at(k, b)) {
            for BodySensitivity { dr, dpi, dv, domega, da, dalpha } in derivatives.iter() {
                let sizes = [dr, dpi, dv, domega, da, dalpha];
                for (largest, size) in largest.iter_mut().zip(sizes) {
                    *largest = f64::max(*largest, size.norm());
                }
            }
        }
        largest
    }

    /// True if a variable moves a body at all.
    pub fn moves(&self, variable: VariableId, body: BodyId) -> bool {
        self.places[variable.0 * self.bodies + body.0].is_some()
    }

    /// Copies the sensitivities of a body by a variable that moves it, for the block of eight output times that
    /// contains k, in the order of the fields.
    #[inline(always)]
    pub(crate) fn gather(&self, k: usize, variable: usize, body: usize, to: &mut [Lanes]) {
        let place = self.places[variable * self.bodies + body].expect("the variable moves the body");
        self.derivatives.gather(k, place, to);
    }

    /// Writes the sensitivity of a body by a variable at output time k.
    ///
    /// # Panics
    /// Panics if the variable does not move the body.
    #[inline(always)]
    pub fn set(&mut self, k: usize, variable: VariableId, body: BodyId, derivatives: &BodySensitivity) {
        let place = self.places[variable.0 * self.bodies + body.0];
        self.derivatives.set(k, place.expect("the variable moves the body"), derivatives.numbers());
    }

    /// Copies output time j of another one to output time k.
    pub(crate) fn copy(&mut self, k: usize, from: &Self, j: usize) {
        if self.bodies == 0 {
            self.bodies = from.bodies;
            self.places.clone_from(&from.places);
        }
        self.derivatives.copy(k, &from.derivatives, j);
    }

    /// Resizes for this number of output times, within the memory at hand. `moved` are the pairs of a variable and a
    /// body that it moves.
    pub(crate) fn shape(
        &mut self,
        bodies: usize,
        variables: usize,
        moved: impl Iterator<Item = (VariableId, BodyId)>,
        steps: usize,
    ) {
        (self.bodies, self.variables) = (bodies, variables);
        self.admissibility.clear();
        self.places.clear();
        self.places.resize(variables * bodies, None);
        let mut width = 0;
        for (variable, body) in moved {
            self.places[variable.0 * bodies + body.0] = Some(width);
            width += BodySensitivity::NUMBERS;
        }
        self.derivatives.shape(width, steps);
    }
}

/// Sensitivities of all bodies by one variable at one output time.
#[derive(Clone, Copy, Debug)]
pub struct Derivatives<'s> {
    row: ResultRow<'s>,
    places: &'s [Option<usize>],
}

impl<'s> Derivatives<'s> {
    /// Sensitivity of body i; zero if the variable does not move it.
    ///
    /// # Panics
    /// Panics if there is no such body.
    #[inline]
    pub fn body(self, i: usize) -> BodySensitivity {
        let Some(first) = self.places[i] else { return BodySensitivity::ZERO };
        BodySensitivity::from(|k| self.row.get(first + k))
    }

    /// All of them, body by body.
    pub fn iter(self) -> impl Iterator<Item = BodySensitivity> + 's {
        (0..self.places.len()).map(move |i| self.body(i))
    }
}

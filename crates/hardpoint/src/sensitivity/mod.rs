//! Exact design sensitivities by direct differentiation, from the factors that the motion leaves.
//!
//! Every row must stay satisfied along the motion of the changed design. Differentiated by the design
//! variable b and then in time, that gives three linear systems with the Jacobian of the position
//! (`docs/theory.md` (11) to (13), paper Eq. 5.6): all variables are right-hand sides of one factorisation.

mod adjoint;
mod admissible;
mod direct;
mod second;
mod sensing;

pub(crate) use adjoint::{Adjoint, Load, Support, Watch};
pub use admissible::{Admissibility, Condition, JointDefect, admissibility_at_design, conditions_at_design};
pub(crate) use direct::{Direct, FieldParts};
pub use second::{BodyCurvature, Way};
pub(crate) use second::{Seconds, along};
pub(crate) use sensing::{Resisting, Sensing, SensingDesigns, admissibility, record_derivatives};

use crate::space::Vec3;

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
#[repr(C)] // filled in the order of the fields
pub struct BodySensitivity {
    /// Of position.
    pub dr: Vec3,
    /// Of orientation, as a rotation vector.
    pub dpi: Vec3,
    /// Of velocity.
    pub dv: Vec3,
    /// Of angular velocity.
    pub domega: Vec3,
    /// Of acceleration.
    pub da: Vec3,
    /// Of angular acceleration.
    pub dalpha: Vec3,
}

impl BodySensitivity {
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
    /// `bodies[(k * variables + b) * n + i]`: at time k, by variable b, of body i; NaN for variables that
    /// the mechanism cannot follow.
    pub states: Vec<BodySensitivity>,
    /// How many variables there are.
    pub variables: usize,
    /// How many bodies, ground included.
    pub bodies: usize,
    /// Per variable: whether and how the mechanism follows the change.
    pub admissibility: Vec<Admissibility>,
    /// Per variable and body: whether it was written to.
    moved: Vec<bool>,
}

impl Sensitivities {
    /// Sensitivities of all bodies at output time k by variable b; `None` where the mechanism cannot
    /// follow that variable, for then there is no such number.
    pub fn at(&self, k: usize, b: usize) -> Option<&[BodySensitivity]> {
        if matches!(self.admissibility[b], Admissibility::CannotFollow { .. }) {
            return None;
        }
        let first = (k * self.variables + b) * self.bodies;
        Some(&self.states[first..first + self.bodies])
    }
}

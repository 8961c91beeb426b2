//! Exact design sensitivities by direct differentiation, with the factors of the motion.
//!
//! Every row must stay satisfied along the motion of the changed design. Differentiated by the design
//! variable b and then in time, that gives three linear systems with the Jacobian of the position
//! (`docs/theory.md` (11) to (13), paper Eq. 5.6): all variables are right-hand sides of one factorisation.

mod adjoint;
mod admissible;
mod direct;
mod second;
mod solver;
mod storage;
mod transmission;
mod turning;

pub(crate) use adjoint::{Adjoint, DefectWatch, Load, Support};
pub use admissible::{Admissibility, Condition, JointDefect, admissibility_at_design, conditions_at_design};
pub(crate) use direct::{DirectDifferentiation, PlanVelocity};
pub use second::{BodyCurvature, PairDirection};
pub(crate) use second::{Seconds, along, laws_beside, pair_with_variables, values_along_variable};
pub(crate) use solver::{
    Differentiated, Resistance, SensitivitySolver, admissibility, note_defects, record_derivatives,
};
pub use storage::{BodySensitivity, Derivatives, Sensitivities};
pub(crate) use transmission::{Transmission, Transposed, Way};
pub(crate) use turning::Turning;

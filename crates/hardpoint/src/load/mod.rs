//! Loads: inverse dynamics and statics of the mechanism, with driver loads and joint reactions.
//!
//! A mechanism whose motion is prescribed needs no time integration (`docs/theory.md`, section 14): the required
//! wrenches of its bodies follow from pose, velocity and acceleration. Joint reactions and driver loads solve the
//! transposed equation of order n, with the factors that the motion has computed.
//!
//! [`Analysis::loads`](crate::Analysis::loads) returns [`Loads`]; measures of loads have sensitivities as all others.
//!
//! | here | theory | meaning |
//! |---|---|---|
//! | `acting` | F = f - g | per body, required wrench minus applied wrench |
//! | `body_mass` | m, c, I | mass properties of whole bodies in the nominal design |
//! | `equilibrium` | T, mu, nu | reactions of joints and driver loads |
//! | `derivatives` | y' | derivatives of loads by the design, by virtual motion |
//! | `solver` | | loads step after step |
//! | `program` | | loads as part of a step's program |
//! | `inertia` | M | spatial inertia per body, and derivatives of the inertial wrench |
//! | `compliance` | C = Y K^-1 Y^T | deflections with elastic joints |
//! | `gradient` | dy/db | gradients of loads by all variables, adjoint |
//! | `virtual_motion` | Y | virtual motion of a load |
//! | `friction` | M = -c N(T) | Coulomb friction in joints |
//! | `measures` | | evaluation of load measures |
//! | `opening_loads` | r, K | forces that hold the openings of a mechanism |
//!
//! `acting`, `equilibrium`, `derivatives`, `virtual_motion` and `measures` are generic over the number type.

mod acting;
mod body_mass;
mod compliance;
mod derivatives;
mod equilibrium;
mod friction;
mod gradient;
mod inertia;
mod measures;
mod opening_loads;
mod program;
mod results;
mod solver;
mod transmitted;
mod turns;
mod virtual_motion;

pub(crate) use acting::{AppliedLoads, ForceFormula, MassFormula, Solid, Spread};
pub use body_mass::{BodyMass, body_masses};
pub(crate) use compliance::Compliances;
pub(crate) use gradient::LoadGradients;
pub(crate) use opening_loads::{ElementTurns, GivenLoads, OpeningLoads};
pub(crate) use program::{RecordedLoads, hindrance};
pub use results::{CurveRange, Deflection, DriverLoad, JointLoad, LargestDeflection, Loads};
pub(crate) use solver::{LoadSolver, load_measures};

//! Static equilibrium of a mechanism with elastic joints, along its prescribed motion.
//!
//! Every elastic direction is a driver whose value is unknown, an *opening*: the mechanism is solved for any values of
//! the openings, and they are in equilibrium where no force is needed to hold them (`docs/theory.md`, section 15).
//! Elastic forces, springs and given loads are loads like all others, so that forces at the openings, their derivatives
//! and all sensitivities follow from what the rooms before this one compute.
//!
//! | here | theory | meaning |
//! |---|---|---|
//! | `release` | p | the mechanism with its elastic joints open and their openings as drivers |
//! | `solver` | r, K | Newton's method on the openings, and their derivatives by the design |
//! | `waypoints` | c | times between output times at which laws turn |
//! | `direction` | | names of directions that nothing holds, or that become unstable |
//! | `second` | | second derivatives by the design and along a force, a driver or the design |

mod direction;
mod release;
mod second;
mod solver;
mod waypoints;

pub(crate) use release::{OpenPosition, Released, release, release_at};
pub(crate) use second::{Along, Curvatures};
pub(crate) use solver::EquilibriumSolver;

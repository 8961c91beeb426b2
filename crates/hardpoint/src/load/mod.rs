//! Loads: what drives the mechanism, and what its joints carry.
//!
//! A mechanism whose motion is prescribed needs no integration for that (`docs/theory.md`, section 14): what its bodies
//! need is known from where they are and how they move, and what of it comes through which joint is the response to a
//! load, the equation of order n transposed, with the factors that the motion left.
//!
//! | here | theory | what |
//! |---|---|---|
//! | [`acting`] | F = f - g | per body, what it needs less what already acts on it; over any number |
//! | [`carry`] | T, mu, nu | what joints and drivers put on the bodies, and how that changes with the design; over any number |
//! | [`solver`] | | loads step after step |
//! | [`program`] | | the same as part of a step's program |
//! | [`inertia`] | M | what masses need, as one matrix of each body, and how that changes |
//! | [`compliance`] | C = Y K^-1 Y^T | how elastic joints deflect |
//! | [`gradient`] | dy/db | one load by all variables |
//! | [`virtual_motion`] | Y | what a load moves, and what of it turns with the design |
//! | [`friction`] | M = -c N(T) | what has friction, from the forces that it changes itself |
//! | [`measures`] | | the measures of loads, over any number |

mod acting;
mod carry;
mod compliance;
mod friction;
mod gradient;
mod inertia;
mod measures;
mod program;
mod solver;
mod turns;
mod virtual_motion;

pub(crate) use compliance::Compliances;
pub(crate) use gradient::LoadGradients;
pub(crate) use program::{RecordedLoads, hindrance};
pub(crate) use solver::LoadSolver;

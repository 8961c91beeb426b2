//! Exact sensitivities against differences of re-solved designs.
//!
//! - [`Difference`]: quotients of two re-solved designs, over a whole motion.
//! - [`Comparison`]: deviations of the exact sensitivities from them, quantity by quantity.
//! - [`Magnitude`]: of a motion; errors and changes that are round-off are relative to it.
//!
//! This is a crate of its own because these loops over all states of a motion are optimised in every build, and the
//! studies are not (`[profile.release.package]`).

mod comparison;
mod difference;
mod magnitude;

pub use comparison::{Comparison, NonsmoothClearances, StepError, UndecidedOutputs};
pub use difference::{Difference, DifferenceScheme, finite_differences, finite_differences_each};
pub use magnitude::Magnitude;

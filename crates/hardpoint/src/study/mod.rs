//! Studies: questions that take many solutions.

mod difference;
mod gradient;
mod jerk;
mod metric;
mod nearest;
mod second;
mod validity;
mod verify;
mod whatif;

pub use difference::{Difference, Scheme, finite_differences, natural_step};
pub use gradient::{Gradients, Method};
pub use jerk::Jerks;
pub use metric::{MetricValue, metrics};
pub use nearest::{Nearest, nearest_admissible};
pub use second::SecondDerivatives;
pub use validity::{Validity, validity};
pub use verify::{
    Check, CheckOutcome, PASS, PASS_ONE_SIDED, StepError, Verification, VerifyOptions,
    compare_with_difference, verify,
};
pub use whatif::{
    Foresight, WhatIf, add_coordinates, add_tilts, repeats_coordinate, variable_named, variable_names,
    what_if,
};

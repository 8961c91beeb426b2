//! The numbers that everything is written over: plain ones, and ones that carry something besides.
//!
//! | number | what it carries |
//! |---|---|
//! | `f64` | itself |
//! | [`Dual`] | the derivative by one variable; nested, second ones |
//! | [`Jet`] | up to three time derivatives |
//! | [`hardpoint_tape::Number`] | how it came about: kernels are recorded with it |
//!
//! All of them are [`Real`], and so are they of each other: a `Dual<Jet<f64, 3>>` is a measure with its rates, and the
//! derivatives of all three by a design variable. What is written once over [`Real`] runs on each. A [`Function`] of
//! one number is written down once, with its name and its derivatives.

mod dual;
mod function;
mod jet;
mod real;
pub(crate) mod record;

pub use dual::Dual;
pub use function::Function;
pub use jet::{Jet, Rates};
pub use real::Real;

//! Scalar types: plain numbers, and numbers that carry derivatives or record their arithmetic.
//!
//! | number | carries |
//! |---|---|
//! | `f64` | the value only |
//! | [`Dual`] | the derivative with respect to one variable; nested: second derivatives |
//! | [`Jet`] | up to three time derivatives |
//! | [`Taylor`] | mixed partial derivatives by up to three variables |
//! | [`Interval`] | bounds: all numbers that the value may be |
//! | [`hardpoint_tape::Number`] | its recorded arithmetic: kernels are recorded with it |
//!
//! All of them implement [`Real`], and they nest: a `Dual<Jet<f64, 3>>` is a measure with its rates, and the
//! derivatives of all three with respect to a design variable. Code written once over [`Real`] runs on each of them. A
//! [`Function`] of one number is defined once, with its name and its derivatives.

mod array;
mod dual;
mod function;
mod interval;
mod jet;
mod real;
pub(crate) mod record;
mod taylor;

pub(crate) use array::{array, both, each};
pub use dual::Dual;
pub use function::Function;
pub use interval::Interval;
pub use jet::{Jet, Rates};
pub use real::Real;
pub(crate) use taylor::degrees;
pub use taylor::{Exponents, Taylor};

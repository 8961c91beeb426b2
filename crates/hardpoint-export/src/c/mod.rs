//! The step of a mechanism as C99: a function of its drivers, without allocation.
//!
//! The formulas are the straight-line programs that the engine records of its own kernel; the iteration around them is
//! `control.c`. Templates have places as in `@name@`.

mod curves;
mod emit;
mod format;
mod header;
mod measures;
mod replay;
mod source;

pub use emit::comment;
pub use format::FORMAT;
pub(crate) use header::identifier;
pub use source::{MotionSource, Parts, generate};

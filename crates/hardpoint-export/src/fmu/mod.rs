//! FMI 3.0: the step of a mechanism as a functional mock-up unit, for Model Exchange and Co-Simulation.
//!
//! The unit contains the C source of the step (`c`), the interface to it (`fmi3.c`), and the description of its
//! variables. A variable's value reference is its index in the list of `variable.rs`.

mod description;
mod names;
mod unit;
mod variable;

pub use unit::FORMAT;

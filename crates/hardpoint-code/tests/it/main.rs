//! Code computes the results of its program.

mod limits;
mod meaning;
mod plain;
mod random;

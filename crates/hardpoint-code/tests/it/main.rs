//! What code computes is what its program says.

mod limits;
mod meaning;
mod plain;
mod random;

//! Linear algebra: factors of the loop equations, rank, least squares, splines. Code that kernels are recorded from is
//! written over any [`Real`](crate::number::Real).

mod factors;
mod least_squares;
mod matrix;
mod monotone;
mod rank;
pub mod semidefinite;
mod sparse;
mod spline;
mod symmetric;

pub(crate) use factors::{Factors, LARGEST_DENSE};
pub use least_squares::{folded_rows, least_squares};
pub(crate) use matrix::{Elimination, MOST_GROWTH, Watched};
pub(crate) use monotone::{Cubic, monotone};
pub(crate) use rank::FullPivot;
pub(crate) use spline::{Basis, EndKind, Segment, hermite, segment_at};
pub(crate) use symmetric::diagonalise;

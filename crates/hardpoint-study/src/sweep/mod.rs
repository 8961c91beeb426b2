//! Sweep: exact metrics of many designs over the ranges of the variables.
//!
//! Input: a [`Request`] with ranges (changes in m, rad or plain) and a method, or a list of designs. Output: a
//! [`Block`] of metrics and curves in SI per 512 designs; from these [`sobol_indices`] (Saltelli et al. 2010; Jansen
//! 1999), [`Distribution`] and [`rank_correlation`].

mod indices;
mod plan;
mod request;
mod result;
mod sobol;
mod statistics;
mod study;

pub use indices::{SobolIndex, sobol_indices};
pub use plan::Plan;
pub use request::{Overrides, Request, method};
pub use result::{Block, Curves, Failure};
pub(super) use statistics::quantile;
pub use statistics::{Distribution, rank_correlation};
pub use study::{Metric, Sweep};

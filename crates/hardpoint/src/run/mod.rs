//! Runs of one model: plan, motion, sensitivities, measures.
//!
//! A [`Run`] is a request, and an [`Analysis`] solves it: at once, in windows, into a [`Sink`], or for many designs.

mod analysis;
mod between;
mod curve;
mod designs;
pub(crate) mod metric;
mod quadrature;
mod request;
mod sink;
mod solution;
mod walk;
mod window;

pub use analysis::Analysis;
pub use request::{Progress, Run};
pub use sink::Sink;
pub use solution::{Solution, StreamSummary};
pub(crate) use walk::{PreparedDesign, Walk};
pub use window::{Footprint, SampledResults, Sampling};

//! The whole walk for one model: plan, motion, sensitivities, measures.
//!
//! A [`Run`] says the request, an [`Analysis`] answers it: at once, window by window, into a [`Sink`], or for many
//! designs.

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

//! Runs of one model: plan, motion, sensitivities, measures.
//!
//! A [`Run`] is a request, and an [`Analysis`] solves it: at once, in windows, into a [`Sink`], or for many designs.

mod analysis;
mod between;
mod clearance;
mod curve;
mod designs;
mod driver_map;
mod driver_rates;
mod gradient;
mod jerk;
mod joint_limits;
mod loads;
mod margins;
mod metric;
mod nearest;
mod needed;
mod proof;
mod quadrature;
mod request;
mod second;
mod sink;
mod solution;
mod swept;
mod walk;
mod window;

pub use analysis::Analysis;
pub use clearance::{
    ClearanceMinimum, Clearances, Contact, MinimumPlace, PairClearance, PairCurve, ShapeDistance,
    ShapeOnBodies, jumping_clearances, tied_clearances,
};
pub use driver_map::{BoundsOfOutputs, DriverMap};
pub use driver_rates::DriverRates;
pub use gradient::{GradientMethod, Gradients};
pub use jerk::Jerks;
pub use joint_limits::{LimitCrossing, LimitExtremum, LimitRange};
pub use margins::MarginDerivatives;
pub use metric::{
    MetricParts, MetricValue, metric_number, metric_numbers, metrics, metrics_beside, misfits, peaks,
    place_of,
};
pub use nearest::{NearestAdmissible, nearest_admissible};
pub use needed::MetricUse;
pub use proof::{ClearanceProof, ClearanceProver, ProofFailure};
pub use request::{Progress, Run};
pub use second::SecondDerivatives;
pub use sink::Sink;
pub use solution::{Solution, StreamSummary};
pub use swept::SweptShape;
pub(crate) use walk::{PreparedDesign, Walk};
pub use window::{Footprint, SampledResults, Sampling};

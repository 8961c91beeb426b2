//! Optimisation: which design minimises weighted goals within bounds and limits?
//!
//! Input: a [`Request`] with bounded variables (m, rad or plain), goals and limits on metrics in SI. Output: an
//! [`Optimization`] with the best design of every start, its active constraints and multipliers.
//!
//! ```text
//! minimise sum of weight value, or (weight (value - target))^2,    subject to least <= limit <= most
//! ```
//!
//! Goals and limits are metrics of the motions, with exact derivatives. If all goals are squares (a curve fitted, a
//! target met) and only bounds limit the design, bounded least squares are used, otherwise steps of local models, or
//! sequential programming where these do not describe the problem. For goals on a maximum (`max` metrics) the search
//! minimises `t` with every part of the curve below `t`, so minimax problems need no reformulation. If the motion of a
//! design does not assemble, locks, or reaches a singular position, the step is rejected: the search steps back and
//! continues.
//!
//! The searches may also start from the other assemblies of the mechanism and with its drivers in the opposite sense:
//! each [`Variant`] is a model of its own with the same variables, goals and limits.

mod assessment;
mod descent;
mod gauss_newton;
mod local;
mod optima;
mod optimality;
mod problem;
mod request;
mod result;
mod search;
mod solver;
mod starts;
mod study;
mod variants;

pub use assessment::{DesignAssessment, FailedDesign, LIMIT_KEPT, judge};
pub(crate) use assessment::{assess, failed_design, limit_scales};
pub(crate) use local::{
    Criticality, Curvatures, Reference, SHARP, SHARP_BETWEEN, STEPS, Scalarization, Scale, Solved, State,
};
pub(crate) use optimality::BINDS;
pub use optimality::{ActiveConstraint, Optimality};
pub(crate) use problem::{MET, Problem};
pub use request::{Overrides, Request, Selection};
pub use result::{Iteration, Optimization, SearchResult, Status};
pub(crate) use solver::Memory;
pub use study::optimize;
pub use variants::Variant;

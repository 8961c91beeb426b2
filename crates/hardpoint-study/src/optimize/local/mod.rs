//! Local models: steps to the minimum of a model of all goals and limits near a design, which costs no design.
//!
//! A [`State`] lists goals and limits of a design as differentiable functions. The model ([`local_model`]) has norms of
//! linear residuals and secants of all else, and a [`Scalarization`] minimises it within a trust region: for the points
//! of a trade-off, and for the optimum of a weighted sum of goals ([`steps`]).

mod functions;
mod local_model;
mod scalarization;
mod steps;

pub(crate) use functions::{Criticality, Scale, State};
pub(crate) use scalarization::{Curvatures, Reference, SHARP, SHARP_BETWEEN, STEPS, Scalarization, Solved};
pub(super) use steps::LocalSteps;

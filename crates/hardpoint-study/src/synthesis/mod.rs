//! Synthesis from nothing: four-bars and slider-cranks that guide a body through poses, or a point along a path.
//!
//! The geometry of the linkages is in `hardpoint-planar`: [`dyads`], [`linkage`], [`defects`], coupler curves.
//!
//! [`synthesize`] returns [`Answer`]s, best first. An answer is geometry; its model is written and followed by the
//! engine elsewhere (`hardpoint-report`), and [`deviation_of_engine`] compares that motion with the answer.

mod driven;
mod follow;
mod frame;
mod path;
mod poses;
mod result;
mod study;
mod task;

pub use hardpoint_planar::{defects, dyads, linkage, plane};

pub use follow::{EngineDeviation, deviation_of_engine};
pub use result::{Answer, Rejection, Synthesis, Tally};
pub use study::synthesize;
pub use task::{Aim, Region, Task, TaskError};

#[cfg(test)]
mod tests;

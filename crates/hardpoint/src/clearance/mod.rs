//! Distances between shapes: the gaps between bodies.
//!
//! A shape is a core with a radius: all points within the radius of the core (`shape.rs`). The distance of two shapes
//! is that of their cores minus both radii. The nearest points lie on one feature of each core: a point, a line, a
//! circle or a face. `nearest.rs` selects the features for plain numbers; `feature.rs` evaluates the distance between
//! them over any number type, so that a clearance is a measure like all others.
//!
//! `docs/theory.md`, section 16.

mod block;
mod bodies;
mod circle;
mod core;
mod feature;
mod gradient;
mod least;
mod nearest;
mod placed;
mod separation;
mod surface;
mod swept;
#[cfg(test)]
mod tests;
mod through_ring;

pub(crate) use bodies::{ChangingBodies, MovingBodies};
pub(crate) use core::Core;
pub(crate) use feature::Feature;
pub(crate) use gradient::{DistanceGradient, GradientBatch, moves_points_only};
pub(crate) use nearest::Nearest;
pub(crate) use placed::{NearestPair, PlacedShapes};
pub(crate) use separation::{Direction, EnclosedSolid, lower_bound, ring_bound, separations};
pub(crate) use swept::ShapeAtPose;
pub(crate) use through_ring::PlaceOnSegment;

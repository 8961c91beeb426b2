//! The other side of a symmetric mechanism, created from the written one.
//!
//! Images are created from the values of the text before they are read: they have names of their own, and the locations
//! of their originals. A mirror image has the same joint coordinates and measures as its original: directions of
//! translation are mirrored as vectors, and axes of rotation as pseudovectors.

mod both_sides;
mod origins;
mod rule;
mod side;

pub(crate) use both_sides::MIRROR;
pub(super) use both_sides::both_sides;
pub(crate) use origins::{Origins, deduplicated, with_origin};
pub(super) use rule::images;
pub(crate) use rule::{Opposites, opposites};

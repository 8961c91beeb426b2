//! Planar four-bars and slider-cranks in closed form, on the complex plane.
//!
//! - [`dyads`]: all cranks and sliders through three to five poses (Burmester).
//! - [`linkage`]: a linkage, its range, type and transmission angle.
//! - [`defects`]: passage through the poses in order, or the defect that prevents it.
//! - [`atlas`] and [`path`]: coupler curves that resemble a path, and their exact least squares.
//!
//! This is a crate of its own because these loops are optimised in every build, and the studies are not
//! (`[profile.release.package]`).

pub mod atlas;
pub mod defects;
pub mod dyads;
pub mod linkage;
pub mod path;
pub mod plane;
mod polynomial;

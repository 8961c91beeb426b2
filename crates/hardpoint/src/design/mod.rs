//! Designs: the geometry for any values of the design variables, and its rate of change by each (section 3 of the
//! paper).
//!
//! A model never changes. A design is a list of values, one per variable. [`Geometry`] has the resulting markers,
//! points and lengths. A [`DesignVelocity`] is the rate of change of the geometry by one variable, or along a direction
//! in the space of all variables: the paper's design velocity field.

mod change;
mod designs;
mod field;
mod formulas;
mod geometry;
mod map;
mod shape;

pub use field::{DesignVelocity, MarkerVelocity};
pub(crate) use geometry::{BodyFixed, ShapeGeometry};
pub use geometry::{Geometry, JointConstants};
pub use map::DesignMap;
pub(crate) use shape::{Interpolation, ShapeField};

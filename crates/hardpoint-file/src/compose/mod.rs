//! One table from the texts of a model: included files, planar shorthand and mirror images, resolved on the values of
//! the texts before these are read.

mod entries;
mod include;
mod mirror;
mod planar;
pub mod side_names;

pub use planar::Plane;

pub(crate) use entries::SECTIONS;
#[cfg(test)]
pub(crate) use include::INCLUDE_TABLE;
pub(crate) use include::{Files, INCLUDE, IncludeError, Part, parts_of, shifted, texts_of, whole};
pub(crate) use mirror::{MIRROR, Origins, deduplicated, opposites, with_origin};
pub(crate) use planar::PLANAR;

//! Joint types, one file each.
//!
//! A joint is data. As a *tree* joint it is a chain of [`Freedom`]s that positions body j relative to body i; as a
//! *cut* joint it is a list of elementary constraints ([`Row`](crate::constraint::Row)) between its two markers. The
//! solver uses freedoms and rows only: to add a joint, add a file to `types/` and list it in `types.rs`.
//!
//! # Frames, signs and units
//!
//! A joint connects body i, the first of its `bodies`, with body j, the second. It has a marker on each: an origin P
//! and right-handed axes x, y, z fixed in the body. In the design configuration both origins are at the joint's
//! hardpoint (or each at its own, for joints with two), z points along `axis`, and x along `axis2` if the type has one.
//! If only z matters, x is along the part of `axis2` perpendicular to z; without `axis2`, x is any perpendicular
//! direction, the same for both markers. If no direction matters and none is given, the axes are the global ones. If
//! `axis2` belongs to body j ([`Need::OnBodyJ`]), it is the z axis of marker j.
//!
//! ```text
//!          z_i   z_j                       d = P_j - P_i, from marker i to marker j
//!           |   /
//!           |  /    angle of j relative to i: about z_i, positive by the right-hand rule,
//!     i ----P_i        from x_i to x_j, counted in whole turns along the motion
//!            \ d
//!             P_j ---- j    displacement of j relative to i: d . z_i, positive along z_i
//! ```
//!
//! Angles are in rad and displacements in m. Angles and displacements are zero in the design configuration. A length is
//! the distance |d|; a driver prescribes its change from the design length. Reactions are the force (N) and the moment
//! (N m) that the joint applies to body j.

mod course;
mod elastic;
mod joint_type;
mod pad;
mod types;

pub(crate) use course::COURSE;
pub use elastic::DIRECTION_NAMES;
pub(crate) use elastic::{
    DIRECTIONS, elastic, free_directions, sprung_directions, tied_directions, with_turns,
};
pub use joint_type::{CoordinateAxis, CoordinateType, Freedom, JointType, Need, Quantity, Slide, VectorKind};
pub(crate) use joint_type::{LENGTH, angle, displacement, displacement_along};
pub(crate) use pad::pad;
pub use types::*;

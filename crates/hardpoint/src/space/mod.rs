//! Points, rotations, poses, twists and wrenches, generic over the scalar type.
//!
//! Everything here is written once over [`Real`]. A [`Twist`] describes a motion, a [`Wrench`] a constraint or force;
//! their product is the rate of a constraint residual, or a power (`docs/theory.md`, section 1).

mod euler;
mod mat3;
mod opening;
mod pose;
mod quat;
mod surface;
mod twist;
mod vec3;

pub use euler::{Angles, euler_313_from_rotation, euler_rates, rotation_from_euler_313};
pub use mat3::Mat3;
pub(crate) use opening::Opening;
pub use pose::Pose;
pub use quat::Quat;
pub(crate) use surface::{NearestTriangle, distinct, is_behind, is_pierced};
pub use surface::{Surface, TrianglePart, hull, nearest_of_triangle, open_edges, overlap_of_parts};
pub use twist::{Twist, Wrench};
pub use vec3::Vec3;

pub use crate::number::Real;
